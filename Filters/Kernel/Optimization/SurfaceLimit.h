// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceLimit.h
 * @brief Keeps a surface whose vertices slide near to where it was.
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
 * @brief Tells of a step of one vertex whether its facets stay within a distance of a surface, and
 * the surface within that distance of its facets.
 *
 * Vertices may be on the surface and the facets between them cut off its bends. So distances are
 * measured at places all over both. A place of the surface counts to the facets of a vertex if it
 * was within the distance of them: as each step keeps these places near, all that are near at the
 * start stay near.
 *
 * How far a facet may be is kept with it. A step adds to that at most by how much the facets of the
 * vertex move along their mean normal, and by its own length: as long as the sum is within the
 * distance, nothing needs to be measured again. Nothing is added where a vertex slides on a flat
 * part, or along a straight edge between two: its facets cover what they covered.
 */
class TAUTLINE_KERNEL_EXPORT SurfaceLimit
{
public:
  /// Edges are divided into so many parts for the places at which distances are measured.
  static constexpr int divisions = 4;

  /**
   * @param facets of the mesh
   * @param surface that the facets are kept near to; must outlive the limit
   * @param distance in the coordinates of `simplices`, above 0; places between those at which it is
   * measured may be somewhat farther
   * @param bothWays whether the surface is to stay near to the facets, too
   */
  SurfaceLimit(const Mesh& mesh, const std::vector<SurfaceFacet>& facets,
    const SimplexMesh& simplices, const SurfaceProjection& surface, double distance, bool bothWays);

  /**
   * @brief Whether free vertex v of the simplices may be where it is, if it was at `before`. At the
   * same time only for vertices without a common facet.
   */
  bool allows(std::int32_t v, const Vec3& before);
  /// Uses a share of the distance, 0 to 1, from now on. It must not shrink.
  void setShare(double share);
  /// To be called where vertices have moved without allows().
  void forget();
  /// The same for one vertex, which has gone back after allows().
  void forget(std::int32_t v);
  /// One flag per free vertex: its last step was refused.
  const std::vector<unsigned char>& held() const { return this->Refused; }

private:
  using Triangle = std::array<Vec3, 3>;
  /// A facet by its vertices, -1 after the last.
  struct Facet
  {
    std::array<std::int32_t, MaxFaceNodes> vertices;
    std::array<double, 2> far = { unknown, unknown }; ///< see Way: not farther than this
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
  std::vector<unsigned char> Refused;         ///< of each free vertex: its last step
  std::vector<Vec3> Places;                   ///< of the surface
  std::unique_ptr<PointTree> Tree;            ///< of these, if they are to stay near
};
}
#endif
