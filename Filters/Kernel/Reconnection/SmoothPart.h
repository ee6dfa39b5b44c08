// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SmoothPart.h
 * @brief A patch or curve of a surface that changing triangles stay close to.
 * Internal: not installed.
 */
#ifndef tautline_SmoothPart_h
#define tautline_SmoothPart_h

#include "tautline/Boundary/SurfaceProjection.h"
#include "tautline/ReconnectionKernelExport.h"

namespace tautline
{
/**
 * @brief The facets (edges) of a part of the input, and the smooth ones through the same points.
 *
 * Points are put on the smooth pieces, the distance of triangles is measured from the facets. Not
 * changed after construction: threads share it.
 */
class TAUTLINE_RECONNECTIONKERNEL_EXPORT SmoothPart
{
public:
  /// How much of the distance that triangles may have their points may use: what the triangles
  /// between these cut off needs the rest.
  static constexpr double shareOfPoints = 0.5;

  /// @param part with smooth pieces that are at most the share of the distance from the facets
  /// @param distance the largest distance of triangles from the facets
  SmoothPart(const SurfacePart& part, double distance);

  /// Where a point near x goes.
  Vec3 closest(const Vec3& x) const { return this->Smooth.closest(x); }
  /// The unit normal of the smooth surface at the place closest to x, of a curve the unit tangent.
  Vec3 direction(const Vec3& x) const { return this->Smooth.direction(x); }
  /// Of a point from the facets.
  double distanceOf(const Vec3& x) const { return norm(this->Facets.closest(x) - x); }
  /**
   * @brief Whether a triangle is close to the facets at its centre and the middles of its edges,
   * and turned as they are there on average.
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
