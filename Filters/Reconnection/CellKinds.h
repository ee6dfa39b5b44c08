// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CellKinds.h
 * @brief Which data sets and cells Improve Mesh takes.
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
/// The data set, if it can be a mesh of tetrahedra or triangles. Throws Error for others.
vtkPointSet* meshOf(vtkDataSet* input);

/// The number of cells of each type. @param ghosts whether copies of cells count
std::map<int, Index> countCells(vtkDataSet* input, bool ghosts);

/// What a mesh is made of. Throws Error, with the remedy, for cells that are not taken.
struct CellKinds
{
  explicit CellKinds(std::map<int, Index> counts);

  int dimension = 3;   ///< 3: tetrahedra, 2: triangles
  Index taken = 0;     ///< their number
  std::string leftOut; ///< a sentence on cells of lower dimension, or ""
  /// The same where lines beside triangles, and triangles beside tetrahedra, are in the output.
  std::string leftOutBesideMarks;
};
}
#endif
