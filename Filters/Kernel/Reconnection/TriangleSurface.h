// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TriangleSurface.h
 * @brief The input surface, on which a changing triangle mesh stays.
 * Internal: not installed.
 */
#ifndef tautline_TriangleSurface_h
#define tautline_TriangleSurface_h

#include "SmoothPart.h"

namespace tautline
{
/**
 * @brief The patches of a surface; without patches, the plane of a planar mesh.
 *
 * Points move to the smooth surface through the input points (Boundary/SurfaceModel.h), or as close
 * to it as the distance limit allows; the distance of triangles is measured from the input facets.
 */
class TriangleSurface
{
public:
  TriangleSurface() = default;
  /**
   * @param distance the largest distance of changed triangles from their patch
   * @param angle degrees, the largest angle between their normals and the patch normal
   */
  TriangleSurface(const Mesh& mesh, const Features& features, double distance, double angle);

  bool isPlane() const { return this->Patches.empty(); }
  Vec3 closest(const Vec3& x, int patch) const { return this->Patches[patch].closest(x); }
  /// Whether a triangle is close to its patch at its center and at the middles of its edges, and
  /// has the mean orientation of the patch there.
  bool accepts(const Vec3& a, const Vec3& b, const Vec3& c, int patch) const;

private:
  std::vector<SmoothPart> Patches;
  double Cosine = 0;
};
}
#endif
