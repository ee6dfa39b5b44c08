// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TriangleInput.h
 * @brief Checks and converts the input of the reconnection of triangles.
 * Internal: not installed.
 */
#ifndef tautline_TriangleInput_h
#define tautline_TriangleInput_h

#include "EdgeMetric.h"
#include "ReconnectionResult.h"
#include "StarSmoothing.h"
#include "TriangleMesh.h"
#include "TriangleOptions.h"
#include "TriangleSurface.h"

namespace tautline
{
/**
 * @brief The arrays of a TriangleMesh: coordinates times a power of two, so that the largest is
 * about 1; for a planar mesh, in its plane with z = 0.
 */
struct TriangleInput
{
  std::vector<Vec3> points;
  std::vector<Corners> cells;              ///< positive in a plane, even for a mirrored mesh
  std::vector<std::int32_t> regions;       ///< renumbered from 0; empty: one region
  std::vector<std::array<Index, 2>> walls; ///< edges that are kept
  std::int32_t markedEdges = 0;            ///< the number of the first ones, which are marked
  std::vector<char> corners;               ///< points that are kept; empty: none
  std::vector<int> patches;                ///< per cell; empty: planar
  TriangleSurface surface;
  std::vector<EdgeMetric> metrics; ///< per point, of target lengths; empty: any length
  bool planar = true;
  int exponent = 0; ///< point = input point times 2^-exponent, in the frame
  Vec3 origin = { 0, 0, 0 };

  /// Converts a point to the coordinates of the mesh.
  Vec3 leave(const Mesh& mesh, const Vec3& x) const;
};

/// Throws Error for options out of range.
void checkTriangleOptions(const TriangleOptions& options);

/// Converts the input. Throws Error for cells and points that reconnection does not support.
TAUTLINE_RECONNECTIONKERNEL_EXPORT TriangleInput convertTriangles(
  const Mesh& mesh, const TriangleOptions& options);

/// The freedom of the points: Free is within the plane or patch. Points of walls and nonmanifold
/// points are fixed; with FlatParts, points within straight walls move along them.
TAUTLINE_RECONNECTIONKERNEL_EXPORT std::vector<PointFreedom> findFreedoms(
  const TriangleMesh& mesh, const TriangleInput& input, const TriangleOptions& options);

/// The quality above which triangles are not processed: the sine of the target angle or, with
/// adaptation, a mean ratio.
double targetQuality(const TriangleOptions& options);

/// Finds the output cells below the target, the reasons, and the bounds forced by the walls.
void findObstacles(const TriangleMesh& mesh, const std::vector<char>& fixedPoints,
  const TriangleOptions& options, ReconnectionResult& result);

/// Whether a triangle is an input triangle with unmoved points.
bool isUnchanged(const TriangleInput& input, const TriangleMesh& changed, TriId t);

/// Sets ReconnectionResult::overlaps, and the original cells to those with the largest overlap.
void computeOverlaps(const TriangleInput& input, const TriangleMesh& before,
  const TriangleMesh& changed, int threads, ReconnectionResult& result);

/// Writes points, triangles, and their relation to the input.
void convertOutput(const Mesh& mesh, const TriangleInput& input, const TriangleMesh& before,
  const TriangleMesh& changed, ReconnectionResult& result);
}
#endif
