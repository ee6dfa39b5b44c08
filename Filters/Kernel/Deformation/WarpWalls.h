// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpWalls.h
 * @brief The height of the cells at prescribed points, and the rotation of the wall there.
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
/// The properties of the wall at a prescribed point, computed from the surrounding cells.
struct WallPoint
{
  /// The smallest height of a cell at the point: the height of a corner above its largest side.
  double height = std::numeric_limits<double>::infinity();
  /// Its share of the wall: of the faces (in the plane, the edges) between prescribed points.
  double area = 0;
  /// The columns of the rotation that best fits the edges and normals of these faces.
  std::array<Vec3, 3> turn = { Vec3{ 1, 0, 0 }, Vec3{ 0, 1, 0 }, Vec3{ 0, 0, 1 } };
};

/**
 * @brief One item per point of the mesh; empty for points that are not prescribed.
 *
 * A point without a face of prescribed points has a share estimated from the lengths of the
 * surrounding edges, and the rotation of its edges to prescribed points; without such an edge, it
 * does not turn.
 * @param displacement 3 per point, read where the flag is set
 */
TAUTLINE_SOLVERS_EXPORT std::vector<WallPoint> wallPoints(
  const Mesh& mesh, const std::vector<unsigned char>& prescribed, const double* displacement);
}
#endif
