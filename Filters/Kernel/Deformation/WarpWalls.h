// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpWalls.h
 * @brief How thin the cells at prescribed points are, and how the wall turns there.
 * Internal: not installed.
 */
#ifndef tautline_WarpWalls_h
#define tautline_WarpWalls_h

#include "tautline/Mesh/Mesh.h"
#include "tautline/SolversExport.h"

#include <limits>
#include <vector>

namespace tautline
{
/// What the cells around a prescribed point state about the wall there.
struct WallPoint
{
  /// Smallest height of a cell at the point: of a corner, above the largest of its sides.
  double height = std::numeric_limits<double>::infinity();
  /// Its share of the wall: of the faces (in the plane, the edges) between prescribed points.
  double area = 0;
  /// Columns of the rotation that fits the edges and normals of these faces best.
  std::array<Vec3, 3> turn = { Vec3{ 1, 0, 0 }, Vec3{ 0, 1, 0 }, Vec3{ 0, 0, 1 } };
};

/**
 * @brief One item per point of the mesh; those of points that are not prescribed are empty.
 *
 * A point without a face of prescribed points has the share that faces as long as the edges around
 * would give it, and the rotation of its edges to prescribed points; without one it does not turn.
 * @param displacement 3 per point, read where the flag is set
 */
TAUTLINE_SOLVERS_EXPORT std::vector<WallPoint> wallPoints(
  const Mesh& mesh, const std::vector<unsigned char>& prescribed, const double* displacement);
}
#endif
