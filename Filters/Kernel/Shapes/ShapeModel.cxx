// SPDX-License-Identifier: BSD-3-Clause
#include "ShapeModel.h"

#include "PlaneDistance.h"
#include "ShapeDescriptors.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Mesh/CoordinateFrame.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
Vec2 turned(const Vec2& p, double angle, bool mirrored)
{
  const double x = mirrored ? -p[0] : p[0], c = std::cos(angle), s = std::sin(angle);
  return { c * x - s * p[1], s * x + c * p[1] };
}
}

ShapeSource transformSource(const ShapeSource& source, double angle, bool mirrored)
{
  ShapeSource result = source;
  result.centre = turned(source.centre, angle, mirrored);
  for (Vec2& p : result.mesh.points)
  {
    p = turned(p, angle, mirrored);
  }
  if (!mirrored)
  {
    return result;
  }
  // A mirror image is clockwise: reversing the order of the vertices restores the orientation.
  const Index n = static_cast<Index>(source.mesh.points.size());
  const auto flip = [n](Index v) { return n - 1 - v; };
  std::reverse(result.mesh.points.begin(), result.mesh.points.end());
  std::reverse(result.descriptors.begin(), result.descriptors.end());
  std::reverse(result.arc.begin(), result.arc.end());
  for (double& s : result.arc)
  {
    s = 1.0 - s;
  }
  for (std::size_t t = 0; t < result.mesh.triangles.size(); ++t)
  {
    auto& triangle = result.mesh.triangles[t];
    auto& neighbours = result.mesh.neighbours[t];
    triangle = { flip(triangle[0]), flip(triangle[2]), flip(triangle[1]) };
    std::swap(neighbours[1], neighbours[2]);
  }
  for (EliminationStep& step : result.mesh.elimination)
  {
    step.vertex = flip(step.vertex);
    step.parents[0] = flip(step.parents[0]);
    step.parents[1] = flip(step.parents[1]);
    std::swap(step.parents[0], step.parents[1]);
  }
  return result;
}

ShapeSource makeShapeSource(const Silhouette& shape, double spacing)
{
  ShapeSource source;
  const std::vector<Vec2> polygon = approximateOutline(shape.outline, spacing);
  source.mesh = triangulatePolygon(polygon);
  source.centre = shape.centre;
  source.maxDistance = shape.maxDistance;
  source.perimeter = shape.perimeter;
  source.descriptors = describe(shape, source.mesh.points);
  // Find the positions of the vertices along the outline, in its order.
  double walked = 0.0;
  std::vector<double> along;
  for (std::size_t i = 0; i < shape.outline.size(); ++i)
  {
    along.push_back(walked / shape.perimeter);
    walked += distance(shape.outline[i], shape.outline[(i + 1) % shape.outline.size()]);
  }
  for (const Vec2& p : source.mesh.points)
  {
    throwIfInterrupted();
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < shape.outline.size(); ++i)
    {
      nearest = distance(shape.outline[i], p) < distance(shape.outline[nearest], p) ? i : nearest;
    }
    source.arc.push_back(along[nearest]);
  }
  return source;
}

ShapeSource makeShapeSource(std::vector<Vec2> polygon)
{
  double extent = 0.0;
  for (const Vec2& p : polygon)
  {
    extent = std::max({ extent, std::abs(p[0] - polygon[0][0]), std::abs(p[1] - polygon[0][1]) });
  }
  if (unitOfExtent(extent) != 1.0)
  {
    throw Error("The polygon is of extreme size: the supported range is 5e-20 to 2e19. Scale it "
                "first (filter Transform).");
  }
  ShapeSource source;
  source.mesh = triangulatePolygon(std::move(polygon));
  source.centre = centreOfMass(source.mesh.points);
  const std::vector<Vec2>& points = source.mesh.points;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    source.maxDistance = std::max(source.maxDistance, distance(points[i], source.centre));
    source.arc.push_back(source.perimeter);
    source.perimeter += distance(points[i], points[(i + 1) % points.size()]);
  }
  for (double& s : source.arc)
  {
    s /= source.perimeter;
  }
  return source;
}

TriangleEnergy triangleEnergy(const std::array<Vec2, 3>& source, const std::array<Vec2, 3>& target,
  double delta, const ShapeEnergy& energy)
{
  double s[4], t[4], lengthS = 0.0, lengthT = 0.0;
  for (int x = 0; x < 2; ++x)
  {
    for (int c = 0; c < 2; ++c)
    {
      s[2 * x + c] = source[c + 1][x] - source[0][x];
      t[2 * x + c] = target[c + 1][x] - target[0][x];
    }
  }
  for (int c = 0; c < 3; ++c)
  {
    lengthS += distance(source[c], source[(c + 1) % 3]);
    lengthT += distance(target[c], target[(c + 1) % 3]);
  }
  const double detS = s[0] * s[3] - s[1] * s[2], detT = t[0] * t[3] - t[1] * t[2];
  // A = T S^-1
  const double a[4] = { (t[0] * s[3] - t[1] * s[2]) / detS, (t[1] * s[0] - t[0] * s[1]) / detS,
    (t[2] * s[3] - t[3] * s[2]) / detS, (t[3] * s[0] - t[2] * s[1]) / detS };
  // Its singular values are half the sum and the difference of these two lengths.
  const double u = std::hypot(a[0] + a[3], a[2] - a[1]), v = std::hypot(a[0] - a[3], a[2] + a[1]);
  const double large = u + v, small = std::abs(u - v);
  TriangleEnergy terms;
  const double size = energy.reflection == Reflection::Free ? std::abs(detT) : detT;
  const double longest = std::max(lengthT, static_cast<double>(MinLength));
  // k = (s1 / s2 + s2 / s1) / 2 for the singular values s1 and s2; flat triangles have the same
  // value as in the tables.
  double k = FlatAnisotropy;
  if (size > FlatArea * longest * longest && small > 0.0)
  {
    k = std::min<double>(0.5 * (large / small + small / large), FlatAnisotropy);
  }
  const double logRatio = std::acosh(std::max(1.0, k));
  terms.deformation = logRatio * logRatio;
  const double growth = std::log(longest / lengthS);
  terms.distortion = energy.signedDistortion
    ? std::abs(growth + std::log(delta))
    : std::abs(std::abs(growth) - std::abs(std::log(delta)));
  // (a0 + a3) / u is the cosine of the angle of the rotation in the polar decomposition of A.
  terms.rotation = u > 0.0 ? 1.0 - (a[0] + a[3]) / u : 1.0;
  return terms;
}
}
