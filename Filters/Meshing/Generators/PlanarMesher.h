// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PlanarMesher.h
 * @brief Quality triangulation of a planar region with CGAL (GPL), which is linked by the program
 * tautline-mesher, not by this library and its users.
 *
 * The constrained Delaunay triangulation of the segments is refined until no triangle has an angle
 * below a bound or an edge above a size (J. Shewchuk's and J. Ruppert's algorithms as implemented
 * in CGAL). The result depends only on the input. Coordinates may have any magnitude; points added
 * by the refinement are rounded to double precision.
 */
#ifndef tautline_PlanarMesher_h
#define tautline_PlanarMesher_h

#include "MeshGeneratorsExport.h"

#include "tautline/Domains/Domains.h"

#include <functional>
#include <vector>

namespace tautline
{
/// Requirements on the triangles.
struct PlanarOptions
{
  /// In degrees; up to 20.7 the refinement is guaranteed to terminate (except for inputs with sharp
  /// corners); above 33 it seldom does.
  double minimumAngle = 20.7;
  /// Upper bound on the edge length; 0 for no bound.
  double size = 0.0;
  /// Upper bound on the edge length at each point of the boundary, above 0; empty for none.
  /// Elsewhere it is the value of the nearest point plus gradation times the distance. Both bounds
  /// hold.
  std::vector<double> pointSizes;
  double gradation = 0.0;
  /// Whether the boundary's `holes` define the parts without triangles. Otherwise these are all
  /// parts that are not surrounded by an odd number of outlines.
  bool holesGiven = false;
  /// Throws Error beyond this number of points, to stop a refinement that does not terminate.
  Index pointLimit = 20000000;
  /// Called repeatedly with the number of points; returning false stops with an Error.
  std::function<bool(Index)> progress;
};

/// Triangles, counterclockwise; the points of the boundary come first, in their order.
struct PlanarMesh
{
  std::vector<double> points; ///< x y each
  std::vector<Index> triangles;
  std::vector<int> pointMarkers; ///< lowest marker of a point's segments, 0 off the segments
  std::vector<Index> edges;      ///< two points each: the segments, subdivided
  std::vector<int> edgeMarkers;
};

/// Runs the program tautline-mesher. Throws Error for crossing segments and points that are not
/// finite, and if the program is missing, with the name of its package.
TAUTLINE_MESH_GENERATORS_EXPORT PlanarMesh meshPlane(
  const PlanarBoundary& boundary, const PlanarOptions& options);
}
#endif
