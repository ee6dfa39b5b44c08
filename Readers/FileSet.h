// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FileSet.h
 * @brief Files that belong together: the same mark in each tells a reader that one write made them.
 *
 * The files of a set are renamed one after the other. A process that is killed in between leaves
 * files of two writes. Each file of a set therefore ends with the comment
 *
 *     # Tautline set 0123456789abcdef
 *
 * of a check sum of the contents of all files, which other programs skip. Files with different
 * marks are refused; files without a mark, of other programs, are not compared. A file that was
 * edited keeps its mark.
 */
#ifndef tautline_FileSet_h
#define tautline_FileSet_h

#include "TextCursor.h"
#include "TextOutput.h"

namespace tautline
{
/**
 * @brief Marks the files, if there are several, forces all of them to the disk and then replaces
 * the older ones; the first, to which the others belong, is the last. Throws FileError.
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
  std::string Name; ///< of its file
};
}
#endif
