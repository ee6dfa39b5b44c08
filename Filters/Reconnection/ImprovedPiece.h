// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ImprovedPiece.h
 * @brief Writes the output of Improve Mesh on several processes: the piece of each, with the data
 * of the input.
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
 * Points of the piece come first, in their order, including points of no tetrahedron. The data of
 * points of other pieces, and the data interpolated at inserted points, are fetched; therefore only
 * point arrays of all pieces with points are kept. `OriginalCellId` numbers the cells of all
 * pieces, one process after the other. Points are in double precision on all processes, or on none
 * of those with single-precision input.
 */
ImprovedCells writePiece(RankGroup& group, const ReconnectablePiece& piece,
  const RankReconnection& result, int threads, vtkPointSet* output);
}
#endif
