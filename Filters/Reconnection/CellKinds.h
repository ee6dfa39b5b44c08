// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CellKinds.h
 * @brief Checks which data sets and cells Improve Mesh supports.
 */
#ifndef tautline_CellKinds_h
#define tautline_CellKinds_h

#include "tautline/Core/Types.h"

#include <map>
#include <string>

class vtkDataSet;
class vtkPointSet;

namespace tautline
{
/// The data set, if it can be a mesh of tetrahedra or triangles. Throws Error otherwise.
vtkPointSet* meshOf(vtkDataSet* input);

/// The number of cells of each type. @param ghosts whether ghost cells count
std::map<int, Index> countCells(vtkDataSet* input, bool ghosts);

/// The kinds of cells in a mesh. Throws Error, with the remedy, for cells that are not supported.
struct CellKinds
{
  explicit CellKinds(std::map<int, Index> counts);

  int dimension = 3;   ///< 3: tetrahedra, 2: triangles
  Index taken = 0;     ///< their number
  std::string leftOut; ///< a sentence on cells of lower dimension, or ""
  /// The same if lines beside triangles, and triangles beside tetrahedra, are in the output.
  std::string leftOutBesideMarks;
};
}
#endif
