// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TargetPieces.h
 * @brief Motions to a target on processes that each have a piece of the mesh and of the target.
 */
#ifndef tautline_TargetPieces_h
#define tautline_TargetPieces_h

#include "PieceMotion.h"
#include "WarpPieces.h"

namespace tautline
{
/// Whether a piece has as many points as another and the same cells; null is empty. Not collective.
bool haveSameCells(vtkDataSet* piece, vtkDataSet* other);

/// Whether a piece has as many points as another and the same global ids, or both have none. Not
/// collective.
bool haveSameIds(vtkDataSet* piece, vtkDataSet* other);

/// Throws Error if the target is missing or empty on all processes. Collective.
void requireTarget(RankGroup& group, vtkDataSet* piece);

/**
 * @brief The displacements to the places of a target, as placesOf() finds them of the whole of
 * both. Collective; throws Error on all processes.
 * @param moved one flag per local point: those that are projected to the closest point
 * @param matched those that move otherwise, where the target has a place
 */
PieceMotion moveToTarget(const WarpSettings& settings, RankGroup& group, RankMesh& mesh,
  const WarpPiece& piece, const PointFlags& moved, const PointFlags& matched);
}
#endif
