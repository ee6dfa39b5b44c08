// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurveMesh.h
 * @brief Makes the cells of a mesh curved: of order 2 to 4, with the nodes of the boundary on a
 * geometry or on the smooth surface through its points; and linear again.
 *
 * Example: quadratic tetrahedra.
 *
 *     tautline::CurvingOptions options;
 *     options.order = 2;
 *     tautline::CurvingResult curved = tautline::curveMesh(mesh, mesh.view(), {}, options);
 *     // curved.validity has a verdict on each cell, proved for the whole cell
 */
#ifndef tautline_CurveMesh_h
#define tautline_CurveMesh_h

#include "tautline/Mesh/CurvedCells.h"
#include "tautline/Mesh/Features.h"

#include <functional>
#include <vector>

namespace tautline
{
struct CurvingOptions
{
  /// 1 to 4; pyramids 1 or 2. VTK's quadratic cells for 2, Lagrange cells for 3 and 4.
  int order = 2;
  /// Of order 2: cells without nodes on quadrilateral faces and inside.
  bool serendipity = false;
  /**
   * @brief Whether the boundary is the smooth surface through its points (SurfaceModel.h), with
   * sharp edges as smooth curves; else the cells are straight-sided, also those that were curved.
   * Cells that are curved keep their shape if it is on.
   */
  bool smooth = true;
  /// Edges at which facets meet at more degrees are sharp; 0 to 180.
  double featureAngle = 40.0;
  /// One per cell, or null: boundaries between regions are curved, too.
  const double* regions = nullptr;
  /**
   * @brief The surface, or for a planar mesh the outline, that the boundary is placed on: triangles
   * and quadrilaterals, or lines; in the coordinates of the mesh; null: none. Needs smooth.
   */
  const Mesh* geometry = nullptr;
  /// One per point of the mesh, or null: the point it is one with, see findCoincidentPoints().
  const Index* representative = nullptr;
  int threads = 0;
  /// Called with the fraction done; false ends the work with Error. May be empty.
  std::function<bool(double)> progress;
};

struct CurvingResult
{
  std::vector<double> points; ///< 3 each
  std::vector<unsigned char> types;
  std::vector<Index> offsets, connectivity; ///< cells in the order of the input
  /// The points of the input that are the first points here, in increasing order.
  std::vector<Index> kept;
  /// Of the points after these: the points of the input whose data they interpolate, from starts[i]
  /// to starts[i + 1], with their weights.
  std::vector<Index> starts, sources;
  std::vector<double> weights;
  /// One flag per point: a node of the boundary (of a surface: any) or between regions.
  std::vector<unsigned char> onBoundary;
  std::vector<signed char> validity; ///< of each cell, see certifyCurvedCells()

  Index corners = 0, curves = 0, patches = 0; ///< the features
  Index curvedBefore = 0;                     ///< cells of the input that are curved
  double largestOffset = 0, meanOffset = 0;   ///< of boundary nodes from those of the input's cells
  /// The largest distances of the boundary from the geometry: before, of the facets, and now; 0
  /// without one.
  double distanceBefore = 0, distanceAfter = 0;
};

/**
 * @brief Curves a mesh, or makes it linear.
 *
 * New nodes are shared by all cells at their edge or face. Nodes of edges and faces inside, and
 * inside cells, follow those of the boundary by transfinite interpolation (CurvedNodes.h). Points
 * that are nodes of curved cells and no corners are dropped. Lines and cells of lower dimension
 * beside others get the nodes of their edges and faces; vertices stay.
 *
 * @param mesh the corners of all cells, consistently ordered, with coincident points merged: the
 * features are those of this mesh
 * @param cells the same cells with all their nodes, in the order of the file, but for facts
 * @param facts of `cells`: degrees, and whether Lagrange wedges are turned (in the result they are
 * as VTK has them); reversed cells are those that `mesh` has in the opposite order
 *
 * Throws Error for options out of range, cells that cannot be curved (polygons, polyhedra, strips),
 * rational cells, pyramids of order 3 and above, and geometries that do not fit.
 */
TAUTLINE_KERNEL_EXPORT CurvingResult curveMesh(const Mesh& mesh, const MeshView& cells,
  const CurvedCellFacts& facts, const CurvingOptions& options);
}
#endif
