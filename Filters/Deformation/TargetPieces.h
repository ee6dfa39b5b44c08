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

/**
 * @brief Whether a process can find the places of its points: by ids that it has, by the closest
 * points, or since the piece of the target has the points and cells of that of the mesh. Else the
 * points of the whole boundary have to be matched. Not collective.
 * @param target of this process, or null
 */
bool findsPlaces(const WarpSettings& settings, vtkDataSet* input, vtkDataSet* target);

/// Throws Error if the target is missing or empty on all processes. Collective.
void requireTarget(RankGroup& group, vtkDataSet* piece);

/**
 * @brief The displacements to the places of a target, where all processes find them. Collective;
 * throws Error on all processes.
 * @param moved one flag per local point: those that are projected to the closest point
 * @param matched those that move otherwise, where the target has a place
 */
PieceMotion moveToTarget(const WarpSettings& settings, RankGroup& group, RankMesh& mesh,
  const WarpPiece& piece, const PointFlags& moved, const PointFlags& matched);
}
#endif
