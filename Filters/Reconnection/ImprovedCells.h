// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImprovedCells.h
 * @brief The cells that Improve Mesh makes: how they are measured, and their arrays.
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

/// What was measured and found of an output.
struct ImprovedCells
{
  std::vector<double> smallestAngles;    ///< dihedral of tetrahedra, in degrees, per cell
  std::vector<double> inverseMeanRatios; ///< per cell
  std::vector<Vec3> centers;             ///< per cell
  std::string note;                      ///< a sentence if single precision did not do, else ""
};

/// Triangles or tetrahedra.
struct Simplices
{
  std::vector<Index> connectivity;
  int corners = 0; ///< of a cell
  std::size_t cells() const { return this->connectivity.size() / this->corners; }
};

/**
 * @brief Gives the output points and measures its cells. The points are in single precision where
 * those of the input are, unless a cell would not be valid or the worst one worse than before.
 * @param group of a mesh in pieces, where the points of all are in double precision if a cell of
 * any needs it; collective. Or null.
 * @param before the record of the input
 */
ImprovedCells writePoints(RankGroup* group, const Simplices& simplices,
  const std::vector<double>& coordinates, bool mirrored, const ReconnectionRecord& before,
  int threads, vtkPointSet* input, vtkPointSet* output);
/// Measures triangles in space, or gives lines the ideal values: 60 degrees and 1.
ImprovedCells measureMarks(
  const Simplices& marks, const std::vector<double>& coordinates, int threads);
/// Gives each cell of an output the data of the cell of the input that it comes from.
void copyCellData(vtkCellData* from, const std::vector<Index>& originals, vtkCellData* to);
/// Gives the cells of an output their numbers in the input, `min_angle` and `imr`.
/// @param first the number of the input's first cell here
void addCellArrays(vtkPointSet* output, const std::vector<Index>& originals, Index first,
  const ImprovedCells& improved);
}
#endif
