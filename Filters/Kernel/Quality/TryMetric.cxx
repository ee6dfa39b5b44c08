// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TryMetric.cxx
 * @brief Tests a user metric before it is registered: its values, derivatives and declared
 * properties.
 */
#include "RegisteredMetrics.h"
#include "UserMetric.h"

#include <algorithm>
#include <vector>

namespace tautline
{
namespace
{
/// Numbers between -1 and 1 without a pattern, so that sums are not accidentally equal.
double irregular(int i)
{
  // The finalizer of MurmurHash3.
  std::uint32_t h = static_cast<std::uint32_t>(i) + 0x9e3779b9u;
  h = (h ^ (h >> 16)) * 0x85ebca6bu;
  h = (h ^ (h >> 13)) * 0xc2b2ae35u;
  h ^= h >> 16;
  return h / 2147483648.0 - 1;
}

constexpr int Samples = 2;

/// Valid cells near the ideal one, x y z of each corner.
std::vector<double> cellsNear(CellType type)
{
  // Base and apex or lid; the ideal shapes.
  const double root3 = std::sqrt(3.0), root2 = std::sqrt(2.0);
  const std::vector<Vec3> triangle = { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, root3 / 2, 0 } };
  const std::vector<Vec3> square = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } };
  const bool threeSided =
    type == CellType::Triangle || type == CellType::Tetrahedron || type == CellType::Wedge;
  std::vector<Vec3> corners = threeSided ? triangle : square;
  const std::size_t base = corners.size();
  const CellTopology& t = topology(type);
  if (type == CellType::Tetrahedron)
  {
    corners.push_back({ 0.5, root3 / 6, root2 / root3 });
  }
  else if (type == CellType::Pyramid)
  {
    corners.push_back({ 0.5, 0.5, root2 / 2 });
  }
  else if (t.dimension == 3)
  {
    for (std::size_t k = 0; k < base; ++k)
    {
      corners.push_back(corners[k] + Vec3{ 0, 0, 1 });
    }
  }
  // VTK's wedge is numbered the other way around: cells with a negative corner are reflected in z.
  const auto& first = t.cornerNodes[0];
  const Vec3 a = corners[first[1]] - corners[first[0]], b = corners[first[2]] - corners[first[0]];
  const bool mirrored =
    t.dimension == 3 && dot(cross(a, b), corners[first[3]] - corners[first[0]]) < 0;

  constexpr double amplitude = 0.08;
  std::vector<double> points;
  for (int i = 0; i < Samples; ++i)
  {
    for (const Vec3& p : corners)
    {
      for (int c = 0; c < 3; ++c)
      {
        const double moved = p[c] + amplitude * irregular(static_cast<int>(points.size()));
        points.push_back(c < 2 ? moved : t.dimension == 2 ? 0.0 : mirrored ? -moved : moved);
      }
    }
  }
  return points;
}

/// Matrices near I.
std::vector<double> matricesNear(int n)
{
  constexpr double amplitude = 0.15;
  std::vector<double> t;
  for (int i = 0; i < Samples * n * n; ++i)
  {
    const int entry = i % (n * n);
    t.push_back((entry / n == entry % n ? 1.0 : 0.0) + amplitude * irregular(i));
  }
  return t;
}

/// Rotates the rows (or points) of n coordinates by a matrix; for T, the columns are rotated.
std::vector<double> turned(const std::vector<double>& x, int n, bool matrix)
{
  // About z in 2D, about all axes in 3D.
  const double c1 = std::cos(0.7), s1 = std::sin(0.7);
  const double c2 = n == 3 && x.size() % 3 == 0 ? std::cos(1.1) : 1, s2 = std::sqrt(1 - c2 * c2);
  const double q[3][3] = { { c1, -s1 * c2, s1 * s2 }, { s1, c1 * c2, -c1 * s2 }, { 0, s2, c2 } };
  std::vector<double> result(x.size(), 0.0);
  const std::size_t step = matrix ? n * n : n;
  for (std::size_t start = 0; start < x.size(); start += step)
  {
    for (std::size_t k = 0; k < step / n; ++k)
    {
      for (int r = 0; r < n; ++r)
      {
        for (int c = 0; c < n; ++c)
        {
          const std::size_t to = matrix ? r * n + k : r, from = matrix ? c * n + k : c;
          result[start + to] += q[r][c] * x[start + from];
        }
      }
    }
  }
  return result;
}

/// A user metric on elements of one type.
class Trial
{
public:
  Trial(const MetricDescription& description, const UserMetric& metric, CellType type)
    : Description(description)
    , Metric(metric)
    , Type(type)
    , Matrices(metric.argument() == MetricArgument::Jacobian)
    , N(topology(type).dimension)
    , Size(this->Matrices ? this->N * this->N : 3 * topology(type).nodes)
    , Arguments(this->Matrices ? matricesNear(this->N) : cellsNear(type))
  {
  }

  void run() const
  {
    const std::vector<double> values = this->evaluate(this->Arguments);
    if (!std::all_of(values.begin(), values.end(), [](double q) { return std::isfinite(q); }))
    {
      this->refuse("is not finite on a valid " + std::string(topology(this->Type).name));
    }
    if (this->Metric.hasDerivatives())
    {
      this->compareSlopes(values);
    }
    if (this->Description.scaleInvariant)
    {
      // A factor of 2 is exact, so that only the metric itself can cause a difference.
      std::vector<double> larger = this->Arguments;
      std::for_each(larger.begin(), larger.end(), [](double& x) { x *= 2; });
      this->compare(values, larger, "scale", "scaleInvariant");
    }
    if (this->Description.rotationInvariant)
    {
      // The arguments of a planar cell are rotated in its plane.
      std::vector<double> other = this->Arguments;
      const int n = this->Matrices ? this->N : 3;
      other =
        this->N == 2 && !this->Matrices ? this->turnedInPlane() : turned(other, n, this->Matrices);
      this->compare(values, other, "rotation", "rotationInvariant");
    }
  }

private:
  [[noreturn]] void refuse(const std::string& problem) const
  {
    throw Error(
      "The metric " + this->Description.name + " cannot be registered: it " + problem + ".");
  }

  /// Element by element, because the arguments are otherwise interleaved.
  std::vector<double> evaluate(const std::vector<double>& arguments) const
  {
    std::vector<double> values(Samples);
    if (!this->Metric.hasDerivatives())
    {
      this->Metric.evaluateElements(this->Type, Samples, arguments.data(), values.data());
      return values;
    }
    for (int i = 0; i < Samples; ++i)
    {
      this->Metric.evaluate(
        this->Type, 1, 1, arguments.data() + i * this->Size, values.data() + i, nullptr);
    }
    return values;
  }

  void compareSlopes(const std::vector<double>& values) const
  {
    constexpr double step = 1e-6, tolerance = 1e-5;
    for (int i = 0; i < Samples; ++i)
    {
      std::vector<double> x(
        this->Arguments.begin() + i * this->Size, this->Arguments.begin() + (i + 1) * this->Size);
      std::vector<double> slopes(this->Size);
      double value = 0;
      this->Metric.evaluate(this->Type, 1, 1, x.data(), &value, slopes.data());
      double largest = std::abs(values[i]);
      for (const double slope : slopes)
      {
        largest = std::max(largest, std::abs(slope));
      }
      for (int k = 0; k < this->Size; ++k)
      {
        const double at = x[k];
        double beyond = 0, before = 0;
        x[k] = at + step;
        this->Metric.evaluate(this->Type, 1, 1, x.data(), &beyond, nullptr);
        x[k] = at - step;
        this->Metric.evaluate(this->Type, 1, 1, x.data(), &before, nullptr);
        x[k] = at;
        // Deviations are relative to the largest derivative, because small ones may consist of
        // rounding.
        const double difference = (beyond - before) / (2 * step);
        if (!(std::abs(difference - slopes[k]) <= tolerance * largest) ||
          !(std::abs(value - values[i]) <= tolerance * largest))
        {
          this->refuse("has derivatives that differ from finite differences on a valid " +
            std::string(topology(this->Type).name) + " (" + std::to_string(slopes[k]) + " and " +
            std::to_string(difference) + " by argument " + std::to_string(k) + ")");
        }
      }
    }
  }

  std::vector<double> turnedInPlane() const
  {
    std::vector<double> plane;
    for (std::size_t i = 0; i < this->Arguments.size(); i += 3)
    {
      plane.insert(plane.end(), { this->Arguments[i], this->Arguments[i + 1] });
    }
    plane = turned(plane, 2, false);
    std::vector<double> result;
    for (std::size_t i = 0; i < plane.size(); i += 2)
    {
      result.insert(result.end(), { plane[i], plane[i + 1], 0.0 });
    }
    return result;
  }

  void compare(const std::vector<double>& values, const std::vector<double>& arguments,
    const char* what, const char* fact) const
  {
    constexpr double tolerance = 1e-7;
    const std::vector<double> others = this->evaluate(arguments);
    for (int i = 0; i < Samples; ++i)
    {
      if (!(std::abs(others[i] - values[i]) <= tolerance * (1 + std::abs(values[i]))))
      {
        this->refuse(std::string("depends on the ") + what + " of the " +
          topology(this->Type).name + ": set " + fact + " to false");
      }
    }
  }

  const MetricDescription& Description;
  const UserMetric& Metric;
  CellType Type;
  bool Matrices;
  int N, Size;
  std::vector<double> Arguments;
};
}

//------------------------------------------------------------------------------
void tryMetric(const MetricDescription& d, const UserMetric& metric)
{
  const auto refuse = [&](const std::string& problem)
  { throw Error("The metric " + d.name + " cannot be registered: " + problem + "."); };
  if (d.cellTypes == 0)
  {
    refuse("it is defined on no type of cell");
  }
  for (const Range& range : { d.full, d.acceptable })
  {
    if (!(range.low <= range.high))
    {
      refuse("the end of a range is below its start");
    }
  }
  if (d.barrier && d.direction != Direction::SmallerIsBetter)
  {
    refuse("a metric that tends to infinity as elements degenerate has smaller values for better "
           "elements");
  }
  for (const CellTopology& t : topologies())
  {
    if ((d.cellTypes >> topologyIndex(t.type)) & 1u)
    {
      Trial(d, metric, t.type).run();
    }
  }
}
}
