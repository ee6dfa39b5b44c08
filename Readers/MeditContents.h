// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeditContents.h
 * @brief The sections of a Medit file, shared by the parsers of its two formats.
 */
#ifndef tautline_MeditContents_h
#define tautline_MeditContents_h

#include "MeditFile.h"
#include "TextCursor.h"

#include <map>
#include <string>
#include <vector>

namespace tautline
{
/// The sections of a file in order. Numbers of points and cells begin with 0.
struct MeditContents
{
  int dimension = 0;               ///< 2 or 3; 0 before the section
  Index points = -1;               ///< -1 before the section
  std::vector<double> coordinates; ///< x y z each
  std::vector<Index> pointReferences;
  std::map<unsigned char, std::vector<Index>> nodes;      ///< by type of cell
  std::map<unsigned char, std::vector<Index>> references; ///< by type of cell
  std::map<std::string, std::vector<Index>> lists;        ///< Corners, Ridges, ... as ids
  std::vector<std::string> warnings;

  /// Whether a nonempty section of cells was read.
  bool hasCells() const;
};

/// Converts the last six nodes between Medit's wedges, whose triangles are counterclockwise as seen
/// from inside, and VTK's, as seen from outside.
void turnMeditWedge(std::vector<Index>& nodes, std::size_t end);

/// Whether a section has cells that are not read: curved ones, polygons, polyhedra.
bool isMeditCellSection(const std::string& section);

/// The sections of a binary file. Throws FileError if it is damaged.
MeditContents readMeditBinary(const FileContent& file);

/// The warning for a file ("the file", "its .sol") without the keyword End that is otherwise
/// complete.
std::string meditWithoutEnd(const char* what);
}
#endif
