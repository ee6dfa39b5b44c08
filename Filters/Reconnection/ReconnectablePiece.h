// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReconnectablePiece.h
 * @brief Converts the input of Improve Mesh on several processes for the kernel: the piece of each
 * process.
 */
#ifndef tautline_ReconnectablePiece_h
#define tautline_ReconnectablePiece_h

#include "CellKinds.h"
#include "tautline/Reconnection/ReconnectionRounds.h"

#include <string>
#include <vector>

class vtkDataArray;
class vtkDataSet;

namespace tautline
{
class MovableMesh;

/// The sum of the values of the ranks before this one. Collective.
Index sumBefore(RankGroup& group, Index value);

/// The kinds of cells in the whole mesh on all processes. Collective.
CellKinds kindsOnRanks(RankGroup& group, vtkDataSet* input);

/// The part of a tetrahedral mesh on a process.
struct ReconnectablePiece
{
  vtkDataSet* input = nullptr;
  RankTetrahedra mesh;
  std::vector<Index> cells;   ///< of the input, per tetrahedron
  std::vector<Index> numbers; ///< per point of the input; -1 if in no tetrahedron
  Index firstCell = 0;        ///< the number of cells on earlier processes
  bool mirrored = false;
};

/**
 * @brief Collective; throws Error on all processes for values that are not region numbers.
 * @param mesh of the input, with its fixed points
 * @param regions one value per cell, on all processes with cells or on none; or null
 */
ReconnectablePiece takePiece(
  RankGroup& group, const MovableMesh& mesh, vtkDataSet* input, vtkDataArray* regions);
}
#endif
