// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReconnectablePiece.h
 * @brief The input of Improve Mesh on several processes: the piece of each as the kernel takes it.
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

/// What the mesh is made of on all processes together. Collective.
CellKinds kindsOnRanks(RankGroup& group, vtkDataSet* input);

/// What a process has of a mesh of tetrahedra.
struct ReconnectablePiece
{
  vtkDataSet* input = nullptr;
  RankTetrahedra mesh;
  std::vector<Index> cells;   ///< of the input, per tetrahedron
  std::vector<Index> numbers; ///< per point of the input; -1: no tetrahedron of any process has it
  Index firstCell = 0;        ///< the cells that the processes before have
  bool mirrored = false;
};

/**
 * @brief Collective; throws Error on all processes for values that are no regions.
 * @param mesh of the input, with what is fixed
 * @param regions one value per cell, on all processes with cells or on none; or null
 */
ReconnectablePiece takePiece(
  RankGroup& group, const MovableMesh& mesh, vtkDataSet* input, vtkDataArray* regions);
}
#endif
