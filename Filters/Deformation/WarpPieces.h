// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpPieces.h
 * @brief Warp Mesh where each process of a parallel server takes its piece of the mesh.
 */
#ifndef tautline_WarpPieces_h
#define tautline_WarpPieces_h

#include "WarpSession.h"

namespace tautline
{
/**
 * @brief Warps the mesh and gives each piece its points and arrays, as addWarpOutput() does; rows
 * of the tables are for the first process only. Throws Error, on all processes, as
 * WarpSession::visit() does. Matrices are not kept for the next execution. Collective.
 *
 * Of a motion over time, does what this time step needs: each process keeps its piece at the first
 * time step and, where steps start from the one before, its points at those. Where the pieces have
 * other points or cells than at the first time step, the session begins again with the mesh
 * gathered.
 * @param mesh in pieces, at the first time step: of session.ownPiece(); else of the input
 * @param moved the input with the array of markSelected(), what is selected to move; or null
 */
void warpPieces(WarpSession& session, MovableMesh& mesh, const InputBlock& block,
  vtkDataObject* moved, TableRows& history, TableRows& statistics, WarpTotals& totals);
}
#endif
