// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TriangleInput.h
 * @brief Checks the input of the reconnection of triangles, and converts it.
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
 * about 1; those of a planar mesh in its plane, with z = 0.
 */
struct TriangleInput
{
  std::vector<Vec3> points;
  std::vector<Corners> cells;              ///< positive in a plane, also those of a mirrored mesh
  std::vector<std::int32_t> regions;       ///< renumbered from 0; empty: one region
  std::vector<std::array<Index, 2>> walls; ///< edges that are kept
  std::int32_t markedEdges = 0;            ///< the first of these, which are marked
  std::vector<char> corners;               ///< points that are kept; empty: none
  std::vector<int> patches;                ///< per cell; empty: planar
  TriangleSurface surface;
  std::vector<EdgeMetric> metrics; ///< per point, of target lengths; empty: any length
  bool planar = true;
  int exponent = 0; ///< point = input's times 2^-exponent, in the frame
  Vec3 origin = { 0, 0, 0 };

  /// A point in the coordinates of the mesh.
  Vec3 leave(const Mesh& mesh, const Vec3& x) const;
};

/// Throws Error for options out of range.
void checkTriangleOptions(const TriangleOptions& options);

/// Converts. Throws Error for cells and points that reconnection cannot take.
TAUTLINE_RECONNECTIONKERNEL_EXPORT TriangleInput convertTriangles(
  const Mesh& mesh, const TriangleOptions& options);

/// What the points may do: Free is within the plane or patch. Points of walls and non-manifold ones
/// are fixed; with FlatParts, those within straight walls move along these.
TAUTLINE_RECONNECTIONKERNEL_EXPORT std::vector<PointFreedom> findFreedoms(
  const TriangleMesh& mesh, const TriangleInput& input, const TriangleOptions& options);

/// The quality of the triangles that are not worked on: the sine of the target angle, with
/// adaptation a mean ratio.
double targetQuality(const TriangleOptions& options);

/// Cells of the output that are below the target, why, and the bounds that the walls force.
void findObstacles(const TriangleMesh& mesh, const std::vector<char>& fixedPoints,
  const TriangleOptions& options, ReconnectionResult& result);

/// Whether a triangle is one of the input, its points where they were.
bool isUnchanged(const TriangleInput& input, const TriangleMesh& changed, TriId t);

/// Sets ReconnectionResult::overlaps, and the original cells to those that overlap most.
void computeOverlaps(const TriangleInput& input, const TriangleMesh& before,
  const TriangleMesh& changed, int threads, ReconnectionResult& result);

/// Writes points, triangles and how they follow from the input.
void convertOutput(const Mesh& mesh, const TriangleInput& input, const TriangleMesh& before,
  const TriangleMesh& changed, ReconnectionResult& result);
}
#endif
