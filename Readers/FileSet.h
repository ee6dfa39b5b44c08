// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FileSet.h
 * @brief Files that belong together: the same mark in each shows that they were written together.
 *
 * The files of a set are renamed one after the other. If the process is killed in between, the
 * files are from two different writes. Each file of a set therefore ends with the comment
 *
 *     # Tautline set 0123456789abcdef
 *
 * with a checksum of the contents of all files; other programs skip the comment. Files with
 * different marks are rejected; files without a mark, from other programs, are not compared. An
 * edited file keeps its mark.
 */
#ifndef tautline_FileSet_h
#define tautline_FileSet_h

#include "TextCursor.h"
#include "TextOutput.h"

namespace tautline
{
/**
 * @brief Marks the files, if there are several, flushes all of them to the disk and then replaces
 * the old ones; the first one, to which the others belong, is replaced last. Throws FileError.
 * @return the names of the files
 */
std::vector<std::string> replaceSet(std::vector<TextOutput>& files);

/// Compares the marks of the files that a reader opens, one after the other.
class SetCheck
{
public:
  /// Throws FileError if this file and an earlier one have different marks.
  const FileContent& add(const FileContent& file);

private:
  std::string Mark; ///< the first found
  std::string Name; ///< the name of its file
};
}
#endif
