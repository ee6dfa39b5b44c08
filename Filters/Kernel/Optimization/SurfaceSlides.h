// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceSlides.h
 * @brief The points of a surface in space, moved all at once: kept on the surface.
 * Internal: not installed.
 */
#ifndef tautline_SurfaceSlides_h
#define tautline_SurfaceSlides_h

#include "OptimizationProblem.h"

#include <vector>

namespace tautline
{
/// Whether Newton's method keeps what holds the points of a surface in space.
bool keepsSurface(const OptimizationProblem& problem);

/**
 * @class tautline::SurfaceSlides
 * @brief Steps go along the tangent planes, on curves along the tangents, and from there to the
 * closest place of the surface.
 */
class SurfaceSlides
{
public:
  /// @param problem of a surface mesh whose free points all slide on a surface or curve; must
  /// outlive this
  explicit SurfaceSlides(OptimizationProblem& problem);

  /// Takes the free points of the problem back to what they slide on.
  void place();
  /// What a point may follow of a vector, by its last place.
  Vec3 project(std::size_t p, const Vec3& g) const;
  /// Keeps the normals of the elements as they are.
  void keepNormals();
  /// Whether a corner of an element has turned over since keepNormals(), or against the surface at
  /// the points of the element.
  bool turned() const;

private:
  /// Of an element: its points, and the vector areas of the corners there.
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
  /// Per free vertex: 1 or -1 where the elements around are on that side of its direction at the
  /// start, 0 where they are on both, or it is on a curve.
  std::vector<signed char> Sides;
};
}
#endif
