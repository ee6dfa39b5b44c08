// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeditRecords.h
 * @brief Headers and records of Medit's files, for those who read all of them or a range.
 */
#ifndef tautline_MeditRecords_h
#define tautline_MeditRecords_h

#include "MeditFile.h"
#include "TextCursor.h"

#include <limits>
#include <map>

namespace tautline
{
namespace medit
{
constexpr char Comment = '#';
constexpr Index Largest = std::numeric_limits<Index>::max();

/// The sections of a file as they come.
struct Contents
{
  int dimension = 0;
  Index points = -1;
  std::vector<double> coordinates;
  std::vector<Index> pointReferences;
  std::map<unsigned char, std::vector<Index>> nodes;      ///< by type of cell
  std::map<unsigned char, std::vector<Index>> references; ///< by type of cell
  std::map<std::string, std::vector<Index>> lists;        ///< Corners, Ridges, ... as ids
};

/// One field of a .sol section.
struct Field
{
  Index type; ///< 1 scalar, 2 vector, 3 symmetric tensor
  int values(int dimension) const
  {
    return type == 1 ? 1 : type == 2 ? dimension : dimension * (dimension + 1) / 2;
  }
};

/// The arrays of a section's fields: named in a comment that Tautline wrote, or Solution1, ...
struct SolutionArrays
{
  std::vector<MeshArray> arrays;
  std::vector<std::pair<std::size_t, int>> places; ///< array and component of each field
};

/// A number in any line.
Index nextInteger(TextCursor& cursor, const char* what, Index low, Index high);
/// MeshVersionFormatted and the version.
void readHeader(TextCursor& cursor);
/// Everything up to the next keyword.
void skipSection(TextCursor& cursor);
/// The section of cells with that name, or null.
const MeditSection* findCells(const std::string& name);
/// The section of cells whose values a section of a .sol has, or null.
const MeditSection* findSolution(const std::string& name);
/// Whether a section is a list of numbers of points or cells.
bool isList(const std::string& name);

/// As many vertices, the only ones of the contents.
void readVertexRecords(TextCursor& cursor, Index count, Contents& contents);
/// As many cells, after those of the same section before.
void readCellRecords(
  TextCursor& cursor, const MeditSection& section, std::size_t count, Contents& contents);
/// A number of a list, from 0.
Index readListRecord(TextCursor& cursor, const std::string& section);
/// @param empty whether arrays without a value are kept, as a rank's share may have none
MeshFile assemble(const TextCursor& cursor, Contents contents, bool empty);

std::vector<Field> readFields(TextCursor& cursor);
/// The comment in which Tautline leaves the names of arrays.
const char* arrayTitle(bool points);
SolutionArrays solutionArrays(
  const FileContent& file, const std::vector<Field>& fields, const char* title, std::size_t tuples);
/// Takes the arrays that another section has begun out of `to`.
void continueArrays(SolutionArrays& result, std::vector<MeshArray>& to);
/// As many values, for the tuples from `begin` on.
void readSolutionRecords(TextCursor& cursor, const std::vector<Field>& fields, int dimension,
  std::size_t begin, Index count, SolutionArrays& to);
/// Whether an array marks ridges or required cells and there are none.
bool isUnused(const MeshArray& array);
}
}
#endif
