// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file AtomicFile.h
 * @brief Files that are replaced atomically: after a failure, either the old or the new file
 * exists.
 */
#ifndef tautline_AtomicFile_h
#define tautline_AtomicFile_h

#include "MeshFile.h"

#include <cstddef>

namespace tautline
{
/**
 * A new file that gets its name only when it is complete.
 *
 * The content is written under a temporary name, `.tautline-....part` with a random part, in the
 * directory of the file. This file is always newly created, and an existing link is never followed.
 * finish() flushes the content to the disk, replace() renames the temporary file. Without replace()
 * the old file stays. The temporary file is left behind only if the process is killed.
 *
 * If the name is a link, the file it points to is replaced and the link stays. A link of another
 * user in a world-writable directory, such as /tmp, is rejected, as on Linux.
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

  /// Throws FileError if not all bytes could be written.
  void write(const char* bytes, std::size_t count);
  /// Flushes the content to the disk; throws FileError if that fails. No write() may follow.
  void finish();
  /// Gives the file its name, after finish(); throws FileError if that fails.
  void replace();
  /// Flushes the new name to the disk, after replace(), if the file system supports it.
  void syncName() const;

  const std::string& name() const { return this->Name; }

private:
  [[noreturn]] void fail(int error) const;

  std::string Name;      ///< as given, for messages
  std::string Target;    ///< after following all links
  std::string Temporary; ///< empty if there is no such file
  int Descriptor = -1;
};

/**
 * @brief Replaces several files that belong together, after all of them were finished; the first
 * one, to which the others belong, is replaced last.
 *
 * If any of them cannot be written, all old files stay. If the process is killed between two
 * renames, which follow each other immediately, all files are complete, but some of them are old.
 */
TAUTLINEREADERS_EXPORT void replaceAll(std::vector<AtomicFile>& files);
}
#endif
