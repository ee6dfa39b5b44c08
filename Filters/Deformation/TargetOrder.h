// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TargetOrder.h
 * @brief Which points of a target in pieces correspond to those of the mesh by their order.
 */
#ifndef tautline_TargetOrder_h
#define tautline_TargetOrder_h

#include "PieceOrder.h"
#include "WarpPieces.h"

namespace tautline
{
/// Points that correspond have the same number.
struct OrderMatch
{
  std::vector<Index> ofMesh;   ///< per point of the piece; -1: none
  std::vector<Index> ofTarget; ///< per point of the target's piece
  std::string how;             ///< in words; "" if there is no correspondence
};

/**
 * @brief As points of pieces that are put together correspond: as the same mesh, the boundary
 * extracted from it, or the points that move, in the order of global ids of both; or, where each
 * process has as many points and cells of both, in the order of the pieces. No process has the mesh
 * or its boundary. Collective; throws Error on all processes if the order is not known or the
 * target does not fit.
 * @param moved one flag per local point @param ofMesh, ofTarget what idsOfPieces() returns
 */
OrderMatch matchByOrder(const WarpSettings& settings, RankGroup& group, RankMesh& mesh,
  const WarpPiece& piece, const PointFlags& moved, const PieceIds& ofMesh,
  const PieceIds& ofTarget);
}
#endif
