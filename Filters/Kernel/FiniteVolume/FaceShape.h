// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FaceShape.h
 * @brief The area vector and the center of one face.
 * Internal: not installed.
 */
#ifndef tautline_FaceShape_h
#define tautline_FaceShape_h

#include "FaceConvention.h"
#include "tautline/Core/Types.h"

namespace tautline
{
struct FaceShape
{
  Vec3 area, center;
};

inline Vec3 pointAt(const double* points, Index id)
{
  return { points[3 * id], points[3 * id + 1], points[3 * id + 2] };
}

/// The mean of the points of a face, the apex of its fan.
inline Vec3 meanOf(const Index* nodes, Index size, const double* points)
{
  Vec3 mean = { 0, 0, 0 };
  for (Index i = 0; i < size; ++i)
  {
    mean += pointAt(points, nodes[i]);
  }
  return (1.0 / static_cast<double>(size)) * mean;
}

/// Calls visit(a, b) for the points of each edge of a face.
template <class Visit>
void forEachEdge(const Index* nodes, Index size, const double* points, const Visit& visit)
{
  Vec3 a = pointAt(points, nodes[0]);
  const Vec3 first = a;
  for (Index i = 1; i < size; ++i)
  {
    const Vec3 b = pointAt(points, nodes[i]);
    visit(a, b);
    a = b;
  }
  visit(a, first);
}

inline FaceShape faceShape(
  const Index* nodes, Index size, const double* points, FaceConvention convention)
{
  // Faces whose triangles have a smaller total area are treated as having none.
  constexpr double noArea = 1e-150;
  const Vec3 mean = meanOf(nodes, size, points);
  if (size == 3)
  {
    const Vec3 a = pointAt(points, nodes[0]);
    return { 0.5 * cross(pointAt(points, nodes[1]) - a, pointAt(points, nodes[2]) - a), mean };
  }
  Vec3 twice = { 0, 0, 0 };
  forEachEdge(
    nodes, size, points, [&](const Vec3& a, const Vec3& b) { twice += cross(b - a, mean - a); });
  double sum = 0;
  Vec3 moment = { 0, 0, 0 };
  const double size2 = norm(twice);
  const Vec3 normal = size2 > 0 ? (1 / size2) * twice : twice;
  forEachEdge(nodes, size, points,
    [&](const Vec3& a, const Vec3& b)
    {
      const Vec3 triangle = cross(b - a, mean - a);
      const double weight =
        convention == FaceConvention::Esi ? norm(triangle) : dot(triangle, normal);
      sum += weight;
      moment += weight * (a + b + mean);
    });
  if (!(std::abs(sum) > noArea))
  {
    return { { 0, 0, 0 }, mean };
  }
  return { 0.5 * twice, (1 / (3 * sum)) * moment };
}
}
#endif
