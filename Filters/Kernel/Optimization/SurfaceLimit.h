// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceLimit.h
 * @brief Keeps a surface with sliding vertices near its original position.
 * Internal: not installed.
 */
#ifndef tautline_SurfaceLimit_h
#define tautline_SurfaceLimit_h

#include "tautline/Boundary/SurfaceProjection.h"
#include "tautline/Geometry/PointTree.h"

#include <limits>
#include <memory>

namespace tautline
{
/**
 * @class tautline::SurfaceLimit
 * @brief Checks for a step of one vertex whether its facets stay within a distance of a surface,
 * and the surface within that distance of its facets.
 *
 * Even if vertices are on the surface, the facets between them may cut off its bends, so distances
 * are measured at samples of both. A surface sample is assigned to the facets of a vertex if it was
 * within the distance of them: since each step keeps these samples near, all samples that are near
 * at the start stay near.
 *
 * An upper bound of the distance is stored with each facet. A step increases it by at most the
 * motion of the facets of the vertex along their mean normal, and by at most the step length: as
 * long as the sum is within the distance, no measurement is needed. Nothing is added if a vertex
 * slides on a flat part, or along a straight edge between two: its facets still cover the same
 * region.
 */
class TAUTLINE_KERNEL_EXPORT SurfaceLimit
{
public:
  /// The number of parts into which edges are divided for the sample points.
  static constexpr int divisions = 4;

  /**
   * @param facets of the mesh
   * @param surface the surface near which the facets are kept; must outlive the limit
   * @param distance in the coordinates of `simplices`, above 0; positions between samples may be
   * slightly farther
   * @param bothWays whether the surface must also stay near the facets
   */
  SurfaceLimit(const Mesh& mesh, const std::vector<SurfaceFacet>& facets,
    const SimplexMesh& simplices, const SurfaceProjection& surface, double distance, bool bothWays);

  /**
   * @brief Whether free vertex v of the simplices may move from `before` to its current position.
   * Concurrent calls only for vertices without a common facet.
   */
  bool allows(std::int32_t v, const Vec3& before);
  /// Uses a share of the distance, 0 to 1, from now on. It must not shrink.
  void setShare(double share);
  /// Must be called after vertices have moved without allows().
  void forget();
  /// The same for one vertex that has moved back after allows().
  void forget(std::int32_t v);
  /// One flag per free vertex: nonzero if its last step was rejected.
  const std::vector<unsigned char>& held() const { return this->Refused; }

private:
  using Triangle = std::array<Vec3, 3>;
  /// The vertices of a facet, -1 after the last.
  struct Facet
  {
    std::array<std::int32_t, MaxFaceNodes> vertices;
    std::array<double, 2> far = { unknown, unknown }; ///< see Way: upper bounds of the distances
  };
  /// From the facets to the surface, and from the surface to the facets.
  enum Way
  {
    There,
    Back
  };
  static constexpr double unknown = std::numeric_limits<double>::infinity();
  Vec3 at(std::int32_t v) const
  {
    const double* p = this->Simplices.coordinates() + VertexStride * static_cast<std::size_t>(v);
    return { p[0], p[1], p[2] };
  }
  void findFacets(const Mesh& mesh, const std::vector<SurfaceFacet>& facets);
  bool isAsIn(const Mesh& mesh) const;
  bool coversSame(std::int32_t v, const Vec3& before, const std::vector<Triangle>& triangles) const;
  bool staysNear(std::int32_t v, const Vec3& before);
  double farOf(std::int32_t v, Way way) const;
  void setFar(std::int32_t v, Way way, double far);
  std::vector<Triangle> trianglesAt(std::int32_t v, const Vec3& place) const;
  double farthest(const std::vector<Triangle>& triangles, double most) const;
  double farthestPlace(const Vec3& center, const std::vector<Triangle>& before,
    const std::vector<Triangle>& after) const;

  const SimplexMesh& Simplices;
  const SurfaceProjection& Surface;
  double Whole, Distance; ///< as given, and the share in use
  std::vector<Facet> Facets;
  std::vector<std::int32_t> Starts, FacetsAt; ///< of each free vertex
  /// per free vertex: whether its last step was rejected
  std::vector<unsigned char> Refused;
  std::vector<Vec3> Places;        ///< of the surface
  std::unique_ptr<PointTree> Tree; ///< of these samples, if they must stay near
};
}
#endif
