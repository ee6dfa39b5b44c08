// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file DegenerateCells.h
 * @brief Removes triangles without area and tetrahedra without volume from a mesh, which stays
 * conforming and where it is.
 *
 * A cell with an edge that is tiny against its longest one loses it: its ends become one point. A
 * point that lies on an edge or a face of its cell divides the other cells there, and the cell
 * vanishes. A flat tetrahedron two of whose facets, at one edge, are on the boundary is dropped.
 * Other flat tetrahedra, whose opposite edges cross, stay: improveConnectivity() removes them.
 */
#ifndef tautline_DegenerateCells_h
#define tautline_DegenerateCells_h

#include "tautline/Mesh/Mesh.h"
#include "tautline/ReconnectionKernelExport.h"

#include <vector>

namespace tautline
{
/// What removeDegenerateCells() keeps, and marks that follow the cells.
struct DegenerateOptions
{
  const unsigned char* fixed = nullptr; ///< one flag per point: it is not merged into another one
  std::vector<std::array<Index, 2>> edges;  ///< marked edges
  std::vector<std::array<Index, 3>> facets; ///< marked facets of tetrahedra
};

/// The cells that remain.
struct DegenerateRemoval
{
  Index degenerate = 0; ///< degenerate cells of the input
  Index left = 0;       ///< degenerate cells that remain
  /// Of each cell the points, three or four. Empty if nothing was done.
  std::vector<Index> cells;
  std::vector<Index> originalCells; ///< per cell the one of the input that it is, or is a part of
  /// Per point the one that it was merged into, or itself. Empty if nothing was done.
  std::vector<Index> mergedInto;
  std::vector<std::array<Index, 2>> edges;  ///< the marked edges, divided as the cells are
  std::vector<std::array<Index, 3>> facets; ///< the marked facets, likewise
  /// Per one of these the one of the options that it is, or is a part of.
  std::vector<Index> originalEdges, originalFacets;
};

/**
 * @brief Removes degenerate cells. Cells that are not degenerate keep their orientation, and points
 * their places. Nothing is done to meshes of other cells, or with points that are not finite.
 * @param mesh of linear triangles or tetrahedra
 */
TAUTLINE_RECONNECTIONKERNEL_EXPORT DegenerateRemoval removeDegenerateCells(
  const Mesh& mesh, const DegenerateOptions& options);
}
#endif
