// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceSlides.h
 * @brief Keeps the points of a surface in space on the surface while all are moved at once.
 * Internal: not installed.
 */
#ifndef tautline_SurfaceSlides_h
#define tautline_SurfaceSlides_h

#include "OptimizationProblem.h"

#include <vector>

namespace tautline
{
/// Whether Newton's method can satisfy the constraints of the points of a surface in space.
bool keepsSurface(const OptimizationProblem& problem);

/**
 * @class tautline::SurfaceSlides
 * @brief Steps follow the tangent planes (on curves, the tangents), and then move to the closest
 * position on the surface.
 */
class SurfaceSlides
{
public:
  /// @param problem of a surface mesh whose free points all slide on a surface or curve; must
  /// outlive this object
  explicit SurfaceSlides(OptimizationProblem& problem);

  /// Moves the free points of the problem back onto their surfaces or curves.
  void place();
  /// The component of a vector that a point may follow, based on its last position.
  Vec3 project(std::size_t p, const Vec3& g) const;
  /// Stores the current normals of the elements.
  void keepNormals();
  /// Whether a corner of an element has flipped since keepNormals(), or relative to the surface at
  /// the points of the element.
  bool turned() const;

private:
  /// The points of an element and the vector areas of its corners.
  struct Corners
  {
    std::array<Index, MaxFaceNodes> points;
    std::array<Vec3, MaxFaceNodes> areas;
    int count;
  };
  template <class Visit>
  void forEachElement(const Visit& visit) const;
  void findSides();

  OptimizationProblem& Problem;
  std::vector<const SurfaceProjection*> Surfaces; ///< per free vertex
  std::vector<std::int32_t> VertexOf;             ///< per point; -1: fixed
  std::vector<Vec3> Directions;                   ///< per free vertex: unit normals and tangents
  std::vector<Vec3> Normals;                      ///< per cell
  /// Per free vertex: 1 or -1 if the surrounding elements are on that side of its direction at the
  /// start, 0 if they are on both sides or the vertex is on a curve.
  std::vector<signed char> Sides;
};
}
#endif
