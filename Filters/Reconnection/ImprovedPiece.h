// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImprovedPiece.h
 * @brief The output of Improve Mesh on several processes: what each gets, with the data of the
 * input.
 */
#ifndef tautline_ImprovedPiece_h
#define tautline_ImprovedPiece_h

#include "ImprovedCells.h"
#include "ReconnectablePiece.h"

class vtkPointSet;

namespace tautline
{
/**
 * @brief writeImproved() for a piece. Collective; throws Error on all processes.
 *
 * Points of the piece come first, in their order, those that no tetrahedron has among them. The
 * data of points that other pieces have, and those that inserted ones interpolate, are fetched; so
 * point arrays are those that all pieces with points have. `OriginalCellId` counts through the
 * cells of the pieces, one process after the other. Points are in double precision on all
 * processes, or on none with points in single precision.
 */
ImprovedCells writePiece(RankGroup& group, const ReconnectablePiece& piece,
  const RankReconnection& result, int threads, vtkPointSet* output);
}
#endif
