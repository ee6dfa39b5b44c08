// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpPieces.h
 * @brief Warp Mesh on a parallel server where each process works on its piece of the mesh.
 */
#ifndef tautline_WarpPieces_h
#define tautline_WarpPieces_h

#include "WarpSession.h"

namespace tautline
{
/**
 * @brief Warps the mesh and gives each piece its points and arrays, as addWarpOutput() does; rows
 * of the tables are added on the first process only. Throws Error, on all processes, as
 * WarpSession::visit() does. Matrices are not kept for the next execution. Collective.
 *
 * For a motion over time, does the work of this time step: each process keeps its piece at the
 * first time step and, if steps start from the previous one, its points at these steps. If the
 * points or cells of the pieces change over time, the session starts over with a gathered mesh.
 * @param mesh in pieces, at the first time step: from session.ownPiece(), otherwise from the input
 * @param moved the input with the array of markSelected() for the selection that moves; or null
 */
void warpPieces(WarpSession& session, MovableMesh& mesh, const InputBlock& block,
  vtkDataObject* moved, TableRows& history, TableRows& statistics, WarpTotals& totals);
}
#endif
