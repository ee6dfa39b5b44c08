// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file AtomicFile.h
 * @brief Files that are replaced whole: after a failure there is the older file or the new one.
 */
#ifndef tautline_AtomicFile_h
#define tautline_AtomicFile_h

#include "MeshFile.h"

#include <cstddef>

namespace tautline
{
/**
 * A new file that gets its name when it is complete.
 *
 * The content is written under a temporary name, `.tautline-....part` with a random part, in the
 * directory of the file. That name is created anew and never followed if it is a link. finish()
 * forces the content to the disk, replace() renames the temporary file. Without replace() the older
 * file stays. Only a process that is killed leaves the temporary file behind.
 *
 * If the name is a link, the file it points to is replaced and the link stays. A link of another
 * user in a directory where everybody may write, such as /tmp, is refused, as Linux does.
 */
class TAUTLINEREADERS_EXPORT AtomicFile
{
public:
  /// Creates the temporary file. Throws FileError if the file cannot be written.
  explicit AtomicFile(const std::string& name);
  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  /// Removes the temporary file, unless replace() was called.
  ~AtomicFile();

  /// Throws FileError when a byte could not be written.
  void write(const char* bytes, std::size_t count);
  /// Forces the content to the disk; throws FileError if that fails. No write() after it.
  void finish();
  /// Gives the file its name, after finish(); throws FileError if that fails.
  void replace();
  /// Forces the new name to the disk, after replace(), where the file system can.
  void syncName() const;

  const std::string& name() const { return this->Name; }

private:
  [[noreturn]] void fail(int error) const;

  std::string Name;      ///< as it was given, for messages
  std::string Target;    ///< behind all links
  std::string Temporary; ///< empty when there is no such file
  int Descriptor = -1;
};

/**
 * @brief Replaces several files that belong together, after all of them were finished; the first,
 * to which the others belong, is the last.
 *
 * A failure to write any of them leaves all older files. A process that is killed between two
 * renames, which follow each other at once, leaves complete files, some of them older.
 */
TAUTLINEREADERS_EXPORT void replaceAll(std::vector<AtomicFile>& files);
}
#endif
