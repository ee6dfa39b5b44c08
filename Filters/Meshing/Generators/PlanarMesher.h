// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PlanarMesher.h
 * @brief Quality triangulation of a planar region with CGAL (GPL), which the program
 * tautline-mesher links; this library and its users do not.
 *
 * The constrained Delaunay triangulation of the segments is refined until no triangle has an angle
 * below a bound or an edge above a size (J. Shewchuk's and J. Ruppert's algorithms as CGAL has
 * them). The result depends on nothing but the input. Coordinates may be of any magnitude; a point
 * that the refinement adds is rounded to double precision.
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
  /// Degrees; up to 20.7 the refinement ends for certain (inputs with sharp corners apart), beyond
  /// 33 it seldom does.
  double minimumAngle = 20.7;
  /// Longest edge allowed; 0 for no bound.
  double size = 0.0;
  /// Longest edge allowed at each point of the boundary, above 0; empty for none. Elsewhere it is
  /// the value of the nearest point plus gradation times the distance. Both bounds hold.
  std::vector<double> pointSizes;
  double gradation = 0.0;
  /// Whether there are no triangles where the boundary has `holes`. Otherwise there are none in
  /// every part that an odd number of outlines does not surround.
  bool holesGiven = false;
  /// Error beyond this number of points, which ends a refinement that does not terminate.
  Index pointLimit = 20000000;
  /// Called from time to time with the number of points; returning false stops with an Error.
  std::function<bool(Index)> progress;
};

/// Triangles, counter-clockwise; the points of the boundary come first, in their order.
struct PlanarMesh
{
  std::vector<double> points; ///< x y each
  std::vector<Index> triangles;
  std::vector<int> pointMarkers; ///< lowest marker of a point's segments, 0 off the segments
  std::vector<Index> edges;      ///< two points each: the segments, subdivided
  std::vector<int> edgeMarkers;
};

/// Runs the program tautline-mesher. Throws Error: crossing segments are named, as are points that
/// are not finite; where the program is missing, the package that has it.
TAUTLINE_MESH_GENERATORS_EXPORT PlanarMesh meshPlane(
  const PlanarBoundary& boundary, const PlanarOptions& options);
}
#endif
