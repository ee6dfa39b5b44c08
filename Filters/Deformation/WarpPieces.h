// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpPieces.h
 * @brief Warp Mesh where each process of a parallel server takes its piece of the mesh.
 */
#ifndef tautline_WarpPieces_h
#define tautline_WarpPieces_h

#include "WarpSession.h"

class vtkDataSet;
class vtkSelection;

namespace tautline
{
class RankMesh;

/// What a process has of the inputs and outputs.
struct WarpPiece
{
  vtkDataSet* input;
  vtkDataSet* rest;    ///< what the mesh is made of: the input, at the first time step
  vtkSelection* moved; ///< what is selected to move, or null
  vtkSelection* fixed; ///< to stay, or null
  vtkDataSet* output;
};

/**
 * @brief Warps the mesh and gives each piece its points and arrays, as addWarpOutput() does; rows
 * of the tables on the first process only. Throws Error, on all processes, as WarpSession::visit()
 * does. Matrices are not kept for the next execution. Collective.
 *
 * Of a motion over time, does what this time step needs: each process keeps its piece at the first
 * time step and, where steps start from the one before, its points at those. Where the pieces have
 * other points or cells than at the first time step, the session begins again with the mesh
 * gathered.
 * @param mesh at the first time step: of session.ownPiece(); else of the input
 */
void warpPieces(WarpSession& session, RankGroup& group, RankMesh& mesh, const WarpPiece& piece,
  TableRows& history, TableRows& statistics, WarpTotals& totals);
}
#endif
