// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MeshPart.h
 * @brief The part of a mesh file that is kept by one of several ranks.
 *
 * The ranks of an MPI job read the same file and each keeps its own part, so that no mesh data are
 * sent. The parts are compact, because cells are divided by position: into the boxes of recursive
 * bisection along the longest side. All ranks find the same division without communication.
 */
#ifndef tautline_MeshPart_h
#define tautline_MeshPart_h

#include "MeshFile.h"

namespace tautline
{
/// Index of a point in the file, from 0 (int64, a point array).
constexpr const char* PartPointIds = "GlobalPointIds";
/// Index of a cell in the file, from 0 (int64, a cell array).
constexpr const char* PartCellIds = "GlobalCellIds";
/// VTK's name for ghost flags, 1 if a point or cell belongs to another part (uint8).
constexpr const char* PartGhosts = "vtkGhostType";

/// The part of a mesh requested by a process.
struct PartRequest
{
  int part = 0;        ///< from 0
  int parts = 1;       ///< at least 1
  int ghostLayers = 0; ///< layers of cells of other parts around this one; at least 0
};

/**
 * @brief The cells of one part with their points, all arrays, and the arrays above.
 *
 * The numbers of cells of two parts differ by at most one. Each cell is in one part; a point is in
 * each part with one of its cells, and is a ghost only if all its cells there are ghosts. Points
 * without a cell are in the first part. Owned cells come first, then ghost cells, both in the order
 * of the file. Takes O(cells log parts) time and 16 bytes per cell in addition to the mesh.
 */
TAUTLINEREADERS_EXPORT MeshFile partOf(const MeshFile& mesh, const PartRequest& request);

/// The part of each cell, from 0, in the same division.
std::vector<int> partsOfCells(const MeshFile& mesh, int parts);
}
#endif
