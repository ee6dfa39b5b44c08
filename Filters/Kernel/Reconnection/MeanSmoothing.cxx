// SPDX-License-Identifier: BSD-3-Clause
// Motion of a vertex that improves the mean of the inverse mean ratios around.
#include "CavityOperations.h"

#include "Constants.h"
#include "NewtonStep.h"

#include <limits>

namespace tautline
{
namespace
{
/// The inverse mean ratio is S / (12 (d / 2)^(2/3)), with the sum S of the squared edges and six
/// times the volume d.
constexpr double RatioFactor = 12.0;
/// The minimum decrease of the sum by an operation, if the sum is the objective.
constexpr double LeastSumDecrease = 1e-3;

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Sum of the inverse mean ratios with its derivatives; infinite if a volume is not positive.
struct RatioSum
{
  double value = 0;
  Vector3d gradient = Vector3d::Zero();
  Matrix3d hessian = Matrix3d::Zero();

  void add(const Vec3& p, const std::array<Vec3, 3>& f, bool derivatives)
  {
    const Vec3 u = f[0] - p, v = f[1] - p, w = f[2] - p;
    const Vec3 ab = f[1] - f[0], bc = f[2] - f[1], ca = f[0] - f[2];
    const double d = dot(u, cross(v, w));
    if (!(d > 0.0))
    {
      this->value = std::numeric_limits<double>::infinity();
      return;
    }
    const double s = dot(u, u) + dot(v, v) + dot(w, w) + dot(ab, ab) + dot(bc, bc) + dot(ca, ca);
    const double scale = 1.0 / (RatioFactor * std::cbrt(0.25 * d * d));
    this->value += scale * s;
    if (derivatives)
    {
      // d is linear in p, S quadratic.
      const Vector3d gs = -2.0 * toEigen(u + v + w);
      const Vector3d gd = (-1.0 / d) * toEigen(cross(f[1] - f[0], f[2] - f[0]));
      this->gradient += scale * (gs - (2.0 / 3.0) * s * gd);
      this->hessian += scale *
        (6.0 * Matrix3d::Identity() - (2.0 / 3.0) * (gs * gd.transpose() + gd * gs.transpose()) +
          (10.0 / 9.0) * s * gd * gd.transpose());
    }
  }
};
}

double CavityOperations::improveMean(PointId v, double least)
{
  if (this->freedoms[v].kind == PointFreedom::Fixed || !this->Mesh.used(v))
  {
    return 0.0;
  }
  const PointFreedom freedom = this->freedomAt(v);
  this->Mesh.star(v, this->Star);
  std::vector<std::array<Vec3, 3>> faces;
  for (TetId t : this->Star)
  {
    const TriangleVertices f = this->Mesh.face(t, this->Mesh.tet(t).indexOf(v));
    faces.push_back({ this->Mesh.point(f[0]), this->Mesh.point(f[1]), this->Mesh.point(f[2]) });
  }
  const auto evaluate = [&](const Vec3& p, bool derivatives)
  {
    RatioSum sum;
    for (const auto& f : faces)
    {
      sum.add(p, f, derivatives);
    }
    return sum;
  };
  const Vec3 start = this->Mesh.point(v);
  const RatioSum before = evaluate(start, true);
  if (!std::isfinite(before.value))
  {
    return 0.0;
  }
  Vec3 step = newtonStep(before.gradient, before.hessian, freedom);
  for (int k = 0; k < Halvings; ++k, step = 0.5 * step)
  {
    const Vec3 p =
      freedom.isCurved() ? this->surface->closest(start + step, freedom) : start + step;
    const double decrease = before.value - evaluate(p, false).value;
    const bool kept = decrease > std::max(LeastDecrease * before.value, least) &&
      std::all_of(faces.begin(), faces.end(),
        [&](const std::array<Vec3, 3>& f)
        {
          const double q = exactQuality(p, f[0], f[1], f[2]);
          const MetricQuality* metric = this->Mesh.weights().metric;
          return q > CertainQuality && this->aboveFloor(p, f[0], f[1], f[2], q) &&
            (!metric || metric->quality(p, f[0], f[1], f[2]) >= this->floor.quality);
        }) &&
      (!freedom.isCurved() || this->keepsSurface(v, p));
    if (kept)
    {
      this->Mesh.movePoint(v, p, this->Star, nullptr);
      ++this->Counts.moves;
      return decrease;
    }
  }
  return 0.0;
}

//------------------------------------------------------------------------------
/// The excess of the inverse mean ratio of a tetrahedron over 1; infinite unless it is positive.
double CavityOperations::excess(const TetVertices& v) const
{
  const auto x = [&](int k) { return this->Mesh.point(v[k]); };
  const double ratio = measure(x(0), x(1), x(2), x(3)).meanRatio;
  return ratio > 0.0 ? std::pow(ratio, -2.0 / 3.0) - 1.0 : std::numeric_limits<double>::infinity();
}

/// Whether the replacement decreases the sum.
bool CavityOperations::decreasesSum() const
{
  // The change must be below minus the minimum decrease.
  double change = LeastSumDecrease;
  for (const TetVertices& v : this->Change.after)
  {
    change += this->excess(v);
  }
  for (TetId t : this->Change.before)
  {
    change -= this->excess(this->Mesh.tet(t).vertices);
  }
  return change < 0.0;
}

/// Like triangulate(), but with the smallest sum; false if that is not smaller than the sum of the
/// ring.
bool CavityOperations::canTriangulateForSum(const EdgeRing& ring)
{
  const int n = ring.vertices;
  const auto& r = ring.ring;
  double before = 0.0;
  for (int i = 0; i < ring.size; ++i)
  {
    before += this->excess(this->Mesh.tet(ring.tets[i]).vertices);
  }
  for (int i = 0; i + 1 < n; ++i)
  {
    this->Best[i][i + 1] = 0.0;
  }
  // Dynamic programming over intervals of increasing length finds the best triangulation of the
  // ring (G. T. Klincsek, 1980).
  for (int length = 2; length < n; ++length)
  {
    for (int i = 0; i + length < n; ++i)
    {
      const int j = i + length;
      double best = before - LeastSumDecrease;
      this->Middle[i][j] = NoId;
      for (int k = i + 1; k < j; ++k)
      {
        double sum = this->Best[i][k] + this->Best[k][j];
        // The evaluation ends as soon as the sum exceeds the best one.
        sum += sum < best ? this->excess({ r[i], r[k], r[j], ring.b }) : 0.0;
        sum += sum < best ? this->excess({ r[k], r[i], r[j], ring.a }) : 0.0;
        if (sum < best)
        {
          best = sum;
          this->Middle[i][j] = k;
        }
      }
      this->Best[i][j] =
        this->Middle[i][j] == NoId ? std::numeric_limits<double>::infinity() : best;
    }
  }
  return std::isfinite(this->Best[0][n - 1]);
}

/// Moves a point for the sum.
bool CavityOperations::improveSum(PointId v)
{
  this->prepareStamps();
  if (!(this->improveMean(v, LeastSumDecrease) > 0.0))
  {
    this->SmoothedAt[v] = this->Clock + 1;
    return false;
  }
  this->Created = this->Star;
  this->touch(this->Created);
  return true;
}
}
