// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshPart.h
 * @brief The part of a mesh file that one of several ranks keeps.
 *
 * The ranks of an MPI job read the same file and each keeps its own part, so that no mesh is sent.
 * The parts are compact, since cells are divided by their places: the boxes of recursive bisection
 * along the longest side. All ranks find the same division without a message.
 */
#ifndef tautline_MeshPart_h
#define tautline_MeshPart_h

#include "MeshFile.h"

namespace tautline
{
/// Number of a point in the file, from 0 (int64, in the arrays of the points).
constexpr const char* PartPointIds = "GlobalPointIds";
/// Number of a cell in the file, from 0 (int64, in the arrays of the cells).
constexpr const char* PartCellIds = "GlobalCellIds";
/// VTK's name for the flags of ghosts, 1 where a point or cell belongs to another part (uint8).
constexpr const char* PartGhosts = "vtkGhostType";

/// What a process wants of a mesh.
struct PartRequest
{
  int part = 0;        ///< from 0
  int parts = 1;       ///< at least 1
  int ghostLayers = 0; ///< layers of cells of other parts around this one; at least 0
};

/**
 * @brief The cells of one part with their points, all arrays, and the arrays named above.
 *
 * The numbers of cells of two parts differ by at most one. Each cell is in one part; a point is in
 * each part that has a cell with it, and a ghost only where none but ghost cells have it. Points
 * without a cell are in the first part. Own cells come first, then ghost cells, both in the order
 * of the file. Takes O(cells log parts) time and 16 bytes per cell beside the mesh.
 */
TAUTLINEREADERS_EXPORT MeshFile partOf(const MeshFile& mesh, const PartRequest& request);

/// The part of each cell, from 0, in the same division.
std::vector<int> partsOfCells(const MeshFile& mesh, int parts);
}
#endif
