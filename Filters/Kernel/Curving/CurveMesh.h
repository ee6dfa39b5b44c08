// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurveMesh.h
 * @brief Converts the cells of a mesh to curved cells of order 2 to 4, with the boundary nodes on a
 * geometry or on the smooth surface through its points, or back to linear cells.
 *
 * Example: quadratic tetrahedra.
 *
 *     tautline::CurvingOptions options;
 *     options.order = 2;
 *     tautline::CurvingResult curved = tautline::curveMesh(mesh, mesh.view(), {}, options);
 *     // curved.validity has a certified verdict for each whole cell
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
  /// For order 2: cells without nodes on quadrilateral faces and inside.
  bool serendipity = false;
  /**
   * @brief Whether the boundary is the smooth surface through its points (SurfaceModel.h), with
   * sharp edges as smooth curves; if off, all cells become straight-sided, including curved ones.
   * If on, curved cells keep their shape.
   */
  bool smooth = true;
  /// Edges at which facets meet at a larger angle are sharp; 0 to 180 degrees.
  double featureAngle = 40.0;
  /// One per cell, or null: boundaries between regions are also curved.
  const double* regions = nullptr;
  /**
   * @brief The surface, or for a planar mesh the outline, onto which the boundary is moved:
   * triangles and quadrilaterals, or lines; in the coordinates of the mesh; null: none. Needs
   * smooth.
   */
  const Mesh* geometry = nullptr;
  /// One per point of the mesh, or null: the point with which it is merged, see
  /// findCoincidentPoints().
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
  /// For the points after these: the input points whose data they interpolate, from starts[i] to
  /// starts[i + 1], with their weights.
  std::vector<Index> starts, sources;
  std::vector<double> weights;
  /// One flag per point: a node on the boundary (on a surface: any node) or between regions.
  std::vector<unsigned char> onBoundary;
  std::vector<signed char> validity; ///< of each cell, see certifyCurvedCells()

  Index corners = 0, curves = 0, patches = 0; ///< the features
  Index curvedBefore = 0;                     ///< cells of the input that are curved
  /// of boundary nodes from their positions in the input cells
  double largestOffset = 0, meanOffset = 0;
  /// The largest distances of the boundary from the geometry: of the facets before, and of the
  /// curved boundary after; 0 without a geometry.
  double distanceBefore = 0, distanceAfter = 0;
};

/**
 * @brief Curves a mesh, or converts it to linear cells.
 *
 * New nodes are shared by all cells at their edge or face. Interior nodes of edges, faces, and
 * cells follow the boundary nodes by transfinite interpolation (CurvedNodes.h). Points that are
 * nodes of curved cells but not corners are dropped. Lines and other lower-dimensional cells get
 * the nodes of their edges and faces; vertices stay unchanged.
 *
 * @param mesh the corners of all cells, consistently ordered, with coincident points merged: the
 * features are determined from this mesh
 * @param cells the same cells with all their nodes, in file order except as stated in facts
 * @param facts of `cells`: degrees, and whether Lagrange wedges are turned (in the result they
 * follow VTK's order); reversed cells have the opposite order in `mesh`
 *
 * Throws Error for options out of range, cells that cannot be curved (polygons, polyhedra, strips),
 * rational cells, pyramids of order 3 and above, and geometries that do not fit.
 */
TAUTLINE_KERNEL_EXPORT CurvingResult curveMesh(const Mesh& mesh, const MeshView& cells,
  const CurvedCellFacts& facts, const CurvingOptions& options);
}
#endif
