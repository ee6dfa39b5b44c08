// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DegenerateCells.h
 * @brief Removes triangles without area and tetrahedra without volume from a mesh, which stays
 * conforming and in place.
 *
 * An edge that is tiny compared with the longest edge of its cell is contracted to one point. A
 * point that lies on an edge or a face of its cell divides the other cells there, and the cell
 * vanishes. A flat tetrahedron with two boundary facets at one edge is dropped. Other flat
 * tetrahedra, whose opposite edges cross, are kept: improveConnectivity() removes them.
 */
#ifndef tautline_DegenerateCells_h
#define tautline_DegenerateCells_h

#include "tautline/Mesh/Mesh.h"
#include "tautline/ReconnectionKernelExport.h"

#include <vector>

namespace tautline
{
/// The constraints of removeDegenerateCells(), and marks that follow the cells.
struct DegenerateOptions
{
  /// one flag per point: nonzero if it must not be merged into another one
  const unsigned char* fixed = nullptr;
  std::vector<std::array<Index, 2>> edges;  ///< marked edges
  std::vector<std::array<Index, 3>> facets; ///< marked facets of tetrahedra
};

/// The cells that remain.
struct DegenerateRemoval
{
  Index degenerate = 0; ///< degenerate cells of the input
  Index left = 0;       ///< degenerate cells that remain
  /// The points of each cell, three or four. Empty if nothing was done.
  std::vector<Index> cells;
  std::vector<Index> originalCells; ///< per cell: the input cell that it is, or is a part of
  /// Per point: the point into which it was merged, or itself. Empty if nothing was done.
  std::vector<Index> mergedInto;
  std::vector<std::array<Index, 2>> edges;  ///< the marked edges, divided like the cells
  std::vector<std::array<Index, 3>> facets; ///< the marked facets, likewise
  /// Per marked edge or facet: the one of the options that it is, or is a part of.
  std::vector<Index> originalEdges, originalFacets;
};

/**
 * @brief Removes degenerate cells. Nondegenerate cells keep their orientation, and points their
 * positions. Meshes with other cells or nonfinite points are not changed.
 * @param mesh of linear triangles or tetrahedra
 */
TAUTLINE_RECONNECTIONKERNEL_EXPORT DegenerateRemoval removeDegenerateCells(
  const Mesh& mesh, const DegenerateOptions& options);
}
#endif
