// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SmoothPart.h
 * @brief A patch or curve of a surface to which changing triangles stay close.
 * Internal: not installed.
 */
#ifndef tautline_SmoothPart_h
#define tautline_SmoothPart_h

#include "tautline/Boundary/SurfaceProjection.h"
#include "tautline/ReconnectionKernelExport.h"

namespace tautline
{
/**
 * @brief The facets (edges) of a part of the input, and the smooth pieces through the same points.
 *
 * Points are placed on the smooth pieces; the distance of triangles is measured from the facets.
 * Immutable after construction, so that threads can share it.
 */
class TAUTLINE_RECONNECTIONKERNEL_EXPORT SmoothPart
{
public:
  /// The fraction of the distance limit of triangles that their points may use: the rest is needed
  /// for the parts that the triangles cut off.
  static constexpr double shareOfPoints = 0.5;

  /// @param part with smooth pieces that are at most the share of the distance from the facets
  /// @param distance the largest distance of triangles from the facets
  SmoothPart(const SurfacePart& part, double distance);

  /// The position on the part for a point near x.
  Vec3 closest(const Vec3& x) const { return this->Smooth.closest(x); }
  /// The unit normal of the smooth surface at the position closest to x; for a curve, the unit
  /// tangent.
  Vec3 direction(const Vec3& x) const { return this->Smooth.direction(x); }
  /// The distance of a point from the facets.
  double distanceOf(const Vec3& x) const { return norm(this->Facets.closest(x) - x); }
  /**
   * @brief Whether a triangle is close to the facets at its center and at the middles of its edges,
   * and has their mean orientation there.
   * @param normal of any length
   * @param cosine of the largest angle between the two
   */
  bool accepts(const std::array<Vec3, 3>& corner, const Vec3& normal, double cosine) const;

private:
  SurfaceProjection Facets, Smooth;
  double Distance;
};
}
#endif
