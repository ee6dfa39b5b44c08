// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TriangleSurface.h
 * @brief The surface that a changing triangle mesh stays on: that of the input.
 * Internal: not installed.
 */
#ifndef tautline_TriangleSurface_h
#define tautline_TriangleSurface_h

#include "SmoothPart.h"

namespace tautline
{
/**
 * @brief The patches of a surface; without patches it is the plane of a planar mesh.
 *
 * Points go to the smooth surface through the points of the input (Boundary/SurfaceModel.h), or as
 * near to it as the distance allows; how far triangles are is measured from the facets of the
 * input.
 */
class TriangleSurface
{
public:
  TriangleSurface() = default;
  /**
   * @param distance the largest distance of changed triangles from their patch
   * @param angle degrees, the largest angle between their normals and that of the patch
   */
  TriangleSurface(const Mesh& mesh, const Features& features, double distance, double angle);

  bool isPlane() const { return this->Patches.empty(); }
  Vec3 closest(const Vec3& x, int patch) const { return this->Patches[patch].closest(x); }
  /// Whether a triangle is close to its patch at its centre and the middles of its edges, and
  /// turned as the patch is there on average.
  bool accepts(const Vec3& a, const Vec3& b, const Vec3& c, int patch) const;

private:
  std::vector<SmoothPart> Patches;
  double Cosine = 0;
};
}
#endif
