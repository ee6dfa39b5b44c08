/**
 * @file SurfaceProjection.h
 * @brief The closest point of a surface mesh. Internal: not installed.
 */
#ifndef tautline_SurfaceProjection_h
#define tautline_SurfaceProjection_h

#include "tautline/Patches/SimplexMesh.h"

namespace tautline
{
/// Triangles in a bounding volume hierarchy. Quadrilaterals are two triangles, edges are flat ones.
class TAUTLINE_KERNEL_EXPORT SurfaceProjection
{
public:
  /// The 2D cells of a mesh, in the coordinates of `simplices` (see SimplexMesh::transform()).
  SurfaceProjection(const Mesh& mesh, const SimplexMesh& simplices);

  /// The boundary of a volume mesh (its faces) or of a planar one (its edges).
  static SurfaceProjection ofBoundary(const Mesh& mesh, const SimplexMesh& simplices);

  /// The point of the surface closest to x.
  Vec3 closest(const Vec3& x) const;
  /// The unit normal there; of an edge of a planar mesh, in the plane. Zero if there is none.
  Vec3 normal(const Vec3& x) const;

  /// The largest distance of the corners, edge midpoints and centres of the cells of `mesh` at
  /// these coordinates.
  double distance(
    const Mesh& mesh, const SimplexMesh& simplices, const double* points, int threads) const;

  /// The largest distance of the corners, edge midpoints and centres of these triangles from
  /// another surface.
  double distanceTo(const SurfaceProjection& other) const;

private:
  SurfaceProjection() = default;
  void build();
  std::int32_t nearest(const Vec3& x, Vec3& point) const;
  struct Node
  {
    Vec3 low, high;
    std::int32_t first, count; ///< count 0: children are first and first + 1
  };
  void build(std::int32_t node, std::int32_t first, std::int32_t count);
  Vec3 closestOf(std::int32_t triangle, const Vec3& x) const;

  std::vector<std::array<Vec3, 3>> Triangles;
  std::vector<Node> Nodes;
};
}
#endif
