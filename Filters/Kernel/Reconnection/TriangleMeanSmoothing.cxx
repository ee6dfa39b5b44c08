// SPDX-License-Identifier: BSD-3-Clause
// Motion of a vertex that improves the mean of the inverse mean ratios of the triangles around.
#include "TriangleOperations.h"

#include "Constants.h"

#include <limits>

namespace tautline
{
namespace
{

/// The sum of S / d over triangles, with the sum S of the squared edges and twice the area d, as a
/// function of the vertex in its tangent plane, with gradient and Hessian.
struct PlaneSum
{
  double g[2] = { 0, 0 };
  double h[3] = { 0, 0, 0 }; ///< xx xy yy

  /// @param a, b the corners relative to the vertex
  void add(const double (&a)[2], const double (&b)[2])
  {
    const double d = a[0] * b[1] - a[1] * b[0];
    const double e[2] = { b[0] - a[0], b[1] - a[1] };
    const double s =
      a[0] * a[0] + a[1] * a[1] + b[0] * b[0] + b[1] * b[1] + e[0] * e[0] + e[1] * e[1];
    const double gs[2] = { -2.0 * (a[0] + b[0]), -2.0 * (a[1] + b[1]) };
    const double gd[2] = { -e[1], e[0] };
    for (int i = 0; i < 2; ++i)
    {
      this->g[i] += gs[i] / d - s * gd[i] / (d * d);
      for (int j = i; j < 2; ++j)
      {
        this->h[i + j] += (i == j ? 4.0 / d : 0.0) - (gs[i] * gd[j] + gs[j] * gd[i]) / (d * d) +
          2.0 * s * gd[i] * gd[j] / (d * d * d);
      }
    }
  }

  /// Newton's step; along the gradient if that is not a descent direction. @param count 1: along x
  /// only
  std::array<double, 2> step(int count) const
  {
    const double trace = this->h[0] + this->h[2];
    if (count == 1)
    {
      return { -this->g[0] / (this->h[0] > 0.0 ? this->h[0] : trace), 0.0 };
    }
    const double determinant = this->h[0] * this->h[2] - this->h[1] * this->h[1];
    const std::array<double, 2> newton = { (this->h[1] * this->g[1] - this->h[2] * this->g[0]) /
        determinant,
      (this->h[1] * this->g[0] - this->h[0] * this->g[1]) / determinant };
    const double slope = newton[0] * this->g[0] + newton[1] * this->g[1];
    return determinant > 0.0 && slope < 0.0
      ? newton
      : std::array<double, 2>{ -this->g[0] / trace, -this->g[1] / trace };
  }
};
}

/// The sum of the inverse mean ratios of the triangles `Around`; infinite if one is not accepted or
/// has a smaller quality.
double TriangleOperations::sumAround(double leastQuality) const
{
  double sum = 0.0;
  for (TriId t : this->Around)
  {
    const Triangle& triangle = this->Mesh.triangle(t);
    const Corners& c = triangle.vertices;
    if (!(triangle.quality >= leastQuality) || !this->accepts(c, triangle.origin))
    {
      return std::numeric_limits<double>::infinity();
    }
    sum += 1.0 /
      measureTriangle(
        this->Mesh.point(c[0]), this->Mesh.point(c[1]), this->Mesh.point(c[2]), this->Input.planar)
        .meanRatio;
  }
  return sum;
}

double TriangleOperations::improveMean(VertexId v, double leastQuality)
{
  if (!this->Mesh.used(v) || this->freedoms[v].kind == PointFreedom::Fixed)
  {
    return 0.0;
  }
  this->Mesh.star(v, this->Around);
  const double before = this->sumAround(leastQuality);
  if (!std::isfinite(before))
  {
    return 0.0;
  }
  const TriangleStar::Directions directions = this->directionsAt(v, this->Around);
  const Vec3 start = this->Mesh.point(v);
  PlaneSum plane;
  for (TriId t : this->Around)
  {
    const Corners& c = this->Mesh.triangle(t).vertices;
    const int k = this->Mesh.indexOf(t, v);
    const Vec3 a = this->Mesh.point(c[Next[k]]) - start,
               b = this->Mesh.point(c[Previous[k]]) - start;
    plane.add({ dot(a, directions.first), dot(a, directions.second) },
      { dot(b, directions.first), dot(b, directions.second) });
  }
  const std::array<double, 2> step = plane.step(directions.count);
  double length = 1.0;
  for (int k = 0; k < Halvings; ++k, length *= 0.5)
  {
    Vec3 x = start + (length * step[0]) * directions.first + (length * step[1]) * directions.second;
    if (!this->Input.planar && this->freedoms[v].kind != PointFreedom::OnLine)
    {
      x = this->Input.surface.closest(x, this->patchOf(this->Around.front()));
    }
    this->Mesh.movePoint(v, x, this->Around);
    const double decrease = before - this->sumAround(leastQuality);
    if (decrease > LeastDecrease * before)
    {
      ++this->Count.moves;
      return decrease;
    }
  }
  this->Mesh.movePoint(v, start, this->Around);
  return 0.0;
}
}
