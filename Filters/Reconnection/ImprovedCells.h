// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImprovedCells.h
 * @brief Measures the cells made by Improve Mesh, and adds their arrays.
 */
#ifndef tautline_ImprovedCells_h
#define tautline_ImprovedCells_h

#include "tautline/Core/RankGroup.h"
#include "tautline/Reconnection/ReconnectionOptions.h"

#include <string>
#include <vector>

class vtkCellData;
class vtkPointSet;

namespace tautline
{
constexpr const char* OriginalCellArray = "OriginalCellId";
constexpr const char* PrecisionNote =
  "The points are in double precision: rounded to the single precision of the input, an element "
  "would be worse than before.";

/// The measurements of an output.
struct ImprovedCells
{
  std::vector<double> smallestAngles;    ///< per cell, in degrees; dihedral for tetrahedra
  std::vector<double> inverseMeanRatios; ///< per cell
  std::vector<Vec3> centers;             ///< per cell
  std::string note;                      ///< a sentence on the precision, or ""
};

/// Triangles or tetrahedra.
struct Simplices
{
  std::vector<Index> connectivity;
  int corners = 0; ///< of a cell
  std::size_t cells() const { return this->connectivity.size() / this->corners; }
};

/**
 * @brief Gives the output its points and measures its cells. The points are in single precision if
 * the input's are, unless a cell would become invalid or the worst cell would be worse than before.
 * @param group for a mesh in pieces, where the points of all are in double precision if a cell of
 * any piece needs it; collective. Or null.
 * @param before the record of the input
 */
ImprovedCells writePoints(RankGroup* group, const Simplices& simplices,
  const std::vector<double>& coordinates, bool mirrored, const ReconnectionRecord& before,
  int threads, vtkPointSet* input, vtkPointSet* output);
/// Measures triangles in space, or sets the ideal values for lines: 60 degrees and 1.
ImprovedCells measureMarks(
  const Simplices& marks, const std::vector<double>& coordinates, int threads);
/// Gives each cell of an output the data of its original cell in the input.
void copyCellData(vtkCellData* from, const std::vector<Index>& originals, vtkCellData* to);
/// Gives the cells of an output their original cell ids, `min_angle` and `imr`.
/// @param first the number of the input's first cell on this process
void addCellArrays(vtkPointSet* output, const std::vector<Index>& originals, Index first,
  const ImprovedCells& improved);
}
#endif
