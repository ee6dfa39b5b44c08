// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Horizon.h
 * @brief Meshes with an interaction layer, and the geometry of the horizon: the disk of radius
 * delta around a point, within which a nonlocal model interacts.
 */
#ifndef tautline_Horizon_h
#define tautline_Horizon_h

#include "tautline/Core/Types.h"
#include "tautline/SolversExport.h"

#include <vector>

namespace tautline
{
/// A triangle mesh in the plane, with its interaction layer.
struct HorizonMesh
{
  std::vector<double> points;       ///< x y each
  std::vector<Index> triangles;     ///< three points each, all of one orientation
  std::vector<unsigned char> layer; ///< per triangle: nonzero where the solution is given
  /// Per point: nonzero where the continuous linear basis is given. Empty: at the points of
  /// interaction layer triangles, including the boundary of the domain.
  std::vector<unsigned char> givenPoints;

  Index numberOfPoints() const { return static_cast<Index>(this->points.size()) / 2; }
  Index numberOfTriangles() const { return static_cast<Index>(this->triangles.size()) / 3; }
};

/**
 * @brief The square (0,1)^2 of right triangles with legs h sqrt(r) and h / sqrt(r), where r is the
 * aspect ratio, with an interaction layer from -delta to 1 + delta, as in the tables of the
 * dissertation, chapter 4.
 *
 * The grid starts exactly at -delta, even if the sides of the square are then not mesh lines (r =
 * 4, h = 0.1, delta = 0.3; only evident from the numbers in the text): a triangle belongs to the
 * domain if its centroid does, and the linear basis is unknown at the points strictly inside. The
 * interaction layer is then too thin for points next to a side. See also structuredSquare(), whose
 * interaction layer has whole layers. Throws Error if the extent is not a whole number of elements.
 * @param h element size, above 0
 * @param aspectRatio r, above 0
 * @param delta horizon, 0 or more
 * @param extraLayers layers of elements added on each side, to make the interaction layer wide
 * enough
 */
TAUTLINE_SOLVERS_EXPORT HorizonMesh horizonSquare(
  double h, double aspectRatio, double delta, Index extraLayers = 0);

/**
 * @brief The amount by which the mesh fails to extend `horizon` beyond the domain, 0 if it extends
 * far enough; the domain excludes the interaction layer.
 * @param horizon above 0, in mesh units
 * @param threads 0: all cores; the result does not depend on it
 */
TAUTLINE_SOLVERS_EXPORT double layerDeficit(
  const HorizonMesh& mesh, double horizon, int threads = 0);

/// The intersection of a triangle and a disk; the cases follow Figure 4.4.
struct DiscIntersection
{
  int corners = 0;      ///< in the disk: 3 is case 1, 2 case 2, 1 case 3, 0 none
  double exactArea = 0; ///< of the intersection of triangle and disk
  double chordArea = 0; ///< the approximation of the dissertation
  /// The triangles that approximate it, x y of three corners each: none, one or two.
  std::vector<double> chords;
};

/**
 * @brief Intersects a triangle with the disk of a radius around (x, y).
 * @param corners x y of the three corners, of either orientation
 * @param radius above 0
 */
TAUTLINE_SOLVERS_EXPORT DiscIntersection intersectDisc(
  const double* corners, double x, double y, double radius);
}
#endif
