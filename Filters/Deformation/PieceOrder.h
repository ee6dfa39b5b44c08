// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PieceOrder.h
 * @brief The order of points of a data set in pieces, as one that is put together of them has it.
 */
#ifndef tautline_PieceOrder_h
#define tautline_PieceOrder_h

#include "MovedBoundary.h"
#include "PointOrder.h"
#include "tautline/Core/RankGroup.h"

#include <vector>

namespace tautline
{
/// What points are known by on all processes.
struct PieceIds
{
  PointOrder order = PointOrder::Coordinates; ///< Given: all points are on one process
  bool increase = false;                      ///< Given: the global ids, in this order
  std::vector<Index> ids; ///< per point of the piece; global ones if there are any, else none
};

/// Collective. @param piece of this process, or null
PieceIds idsOfPieces(RankGroup& group, vtkDataSet* piece);

/**
 * @brief The positions of points among the chosen ones of all processes, in the order of the ids;
 * per point of the piece, -1 where no process has chosen the id. Each process sorts a range of the
 * ids. Collective.
 * @param ids one per point; those below 0 are none
 * @param chosen one flag per point
 * @param count gets the number of ids that are chosen
 */
std::vector<Index> positionsOf(
  RankGroup& group, const std::vector<Index>& ids, const PointFlags& chosen, Index& count);

/**
 * @brief Whether each edge of the cells of a target is one of the mesh, by the positions of its
 * points (-1: none). Each process compares a part of them. Collective.
 */
bool edgesFit(RankGroup& group, const MeshView& mesh, const std::vector<Index>& ofMesh,
  const MeshView& target, const std::vector<Index>& ofTarget);

/**
 * @brief The number of points that pieces without global ids have when they are put together:
 * points at one place are one, but for those of which a piece has several. Collective.
 * @param piece or null @param flags one per point: the others do not count
 */
Index countByPlace(RankGroup& group, vtkDataSet* piece, const PointFlags& flags);
}
#endif
