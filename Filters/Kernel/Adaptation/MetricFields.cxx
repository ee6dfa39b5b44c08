// SPDX-License-Identifier: BSD-3-Clause
#include "MetricFields.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Core/Parallel.h"

#include <algorithm>

namespace tautline
{
namespace
{
double integralOf(const AdaptationMesh& mesh, const std::vector<double>& weights,
  const std::vector<MetricTensor>& metrics)
{
  std::vector<double> roots(metrics.size());
  parallelFor(mesh.numberOfPoints(), ChunkSize, mesh.threads(),
    [&](Index p)
    {
      const MetricAxes axes = principalAxes(metrics[p]);
      roots[p] = std::sqrt(metricDeterminant(axes.values, mesh.dimension()));
    });
  double sum = 0.0;
  for (std::size_t p = 0; p < roots.size(); ++p)
  {
    sum += weights[p] * roots[p];
  }
  return sum;
}

/**
 * Gradation in rounds. In each, points next to those that changed in the round before use the
 * metrics from the end of that round, so that their order does not matter.
 */
class Gradation
{
public:
  Gradation(const AdaptationMesh& mesh, double rate, std::vector<MetricTensor>& metrics)
    : TheMesh(mesh)
    , Rate(rate)
    , Metrics(metrics)
    , Axes(metrics.size())
    , Changed(metrics.size(), 1)
    , Found(metrics.size(), 0)
  {
  }

  GradationResult run()
  {
    GradationResult result;
    std::vector<Index> active(this->Metrics.size());
    for (std::size_t p = 0; p < active.size(); ++p)
    {
      active[p] = static_cast<Index>(p);
    }
    std::vector<Index> changed = active;
    this->findAxes(active);
    for (const MetricAxes& axes : this->Axes)
    {
      this->Highest = std::max(this->Highest, axes.values[2] / (smallestShare * smallestShare));
    }
    while (!changed.empty() && result.rounds < MaximumGradationRounds)
    {
      this->findAxes(changed);
      std::vector<MetricTensor> next = this->gradedOf(active);
      // All neighbors have used the changes of the previous round.
      for (const Index p : changed)
      {
        this->Changed[p] = 0;
      }
      changed.clear();
      for (std::size_t i = 0; i < active.size(); ++i)
      {
        pollInterruption(static_cast<Index>(i));
        const Index p = active[i];
        if (next[i] != this->Metrics[p])
        {
          this->Metrics[p] = next[i];
          this->Changed[p] = 1;
          changed.push_back(p);
        }
      }
      result.rounds += changed.empty() ? 0 : 1;
      // Only the neighbors of changed points can change in the next round.
      active = this->pointsNextTo(changed);
    }
    result.complete = changed.empty();
    return result;
  }

private:
  static constexpr double tolerance = 1e-7;
  /// of the smallest size: the lower bound on its reduction
  static constexpr double smallestShare = 0.9;
  static constexpr Index pointsPerChunk = 512;

  void findAxes(const std::vector<Index>& points)
  {
    parallelFor(static_cast<Index>(points.size()), ChunkSize, this->TheMesh.threads(),
      [&](Index i) { this->Axes[points[i]] = principalAxes(this->Metrics[points[i]]); });
  }

  std::vector<MetricTensor> gradedOf(const std::vector<Index>& points) const
  {
    std::vector<MetricTensor> next(points.size());
    parallelFor(static_cast<Index>(points.size()), pointsPerChunk, this->TheMesh.threads(),
      [&](Index i) { next[i] = this->graded(points[i]); });
    return next;
  }

  /// The metric of a point intersected with the grown metrics of its neighbors.
  MetricTensor graded(Index p) const
  {
    const bool flat = this->TheMesh.dimension() == 2;
    MetricTensor m = this->Metrics[p];
    for (const Index q : this->TheMesh.neighbors(p))
    {
      if (!this->Changed[q])
      {
        continue; // its metric was already used
      }
      MetricTensor grown =
        grownMetric(this->Axes[q], this->TheMesh.point(p) - this->TheMesh.point(q), this->Rate);
      grown = flat ? flattened(grown, this->TheMesh.normals()[p]) : grown;
      // A cheap test that avoids intersections without effect.
      if (!exceeds(grown, m))
      {
        continue;
      }
      const MetricTensor own = this->raised(m);
      const MetricTensor both = intersection(own, this->raised(grown), tolerance);
      if (both != own)
      {
        m = this->lowered(both);
        m = flat ? flattened(m, this->TheMesh.normals()[p]) : m;
      }
    }
    return m;
  }

  /**
   * Intersections of metrics with different axes have smaller sizes than both, and after many
   * rounds sizes would become ever smaller. Between these two functions, which preserve the order
   * of metrics, an intersection stays below the highest eigenvalue allowed.
   */
  MetricTensor raised(const MetricTensor& m) const
  {
    constexpr double least = 1e-6; // at the highest eigenvalue, up to rounding
    return functionOf(
      m, [&](double value) { return value / std::max(1.0 - value / this->Highest, least); });
  }
  MetricTensor lowered(const MetricTensor& m) const
  {
    return functionOf(m, [&](double value) { return value / (1.0 + value / this->Highest); });
  }

  /// Whether an edge may be longer in a metric than in another, by more than the tolerance.
  static bool exceeds(const MetricTensor& grown, const MetricTensor& m)
  {
    MetricTensor difference;
    for (std::size_t k = 0; k < m.size(); ++k)
    {
      difference[k] = (1.0 + tolerance) * m[k] - grown[k];
    }
    return !isPositiveDefinite(difference);
  }

  std::vector<Index> pointsNextTo(const std::vector<Index>& points)
  {
    std::vector<Index> next;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      pollInterruption(static_cast<Index>(i));
      for (const Index q : this->TheMesh.neighbors(points[i]))
      {
        if (!this->Found[q])
        {
          this->Found[q] = 1;
          next.push_back(q);
        }
      }
    }
    for (const Index q : next)
    {
      this->Found[q] = 0;
    }
    return next;
  }

  const AdaptationMesh& TheMesh;
  double Rate;
  double Highest = 0.0; ///< eigenvalue, which all metrics are below
  std::vector<MetricTensor>& Metrics;
  std::vector<MetricAxes> Axes;
  std::vector<unsigned char> Changed, Found;
};
} // namespace

//------------------------------------------------------------------------------
double complexity(const AdaptationMesh& mesh, const std::vector<MetricTensor>& metrics)
{
  return integralOf(mesh, mesh.volumes(), metrics);
}

//------------------------------------------------------------------------------
double expectedElements(const AdaptationMesh& mesh, const std::vector<MetricTensor>& metrics)
{
  return integralOf(mesh, mesh.idealVolumes(), metrics);
}

//------------------------------------------------------------------------------
MetricExtremes extremesOf(const AdaptationMesh& mesh, const std::vector<MetricTensor>& metrics)
{
  std::vector<std::array<double, 3>> values(metrics.size());
  parallelFor(mesh.numberOfPoints(), ChunkSize, mesh.threads(),
    [&](Index p) { values[p] = principalAxes(metrics[p]).values; });
  MetricExtremes result;
  double least = std::numeric_limits<double>::max(), most = 0.0;
  for (const std::array<double, 3>& v : values)
  {
    least = std::min(least, v[0]);
    most = std::max(most, v[2]);
    result.ratio = std::max(result.ratio, std::sqrt(v[2] / v[0]));
  }
  result.smallest = 1.0 / std::sqrt(most);
  result.largest = 1.0 / std::sqrt(least);
  return result;
}

//------------------------------------------------------------------------------
void limitMetrics(
  const AdaptationMesh& mesh, const MetricLimits& limits, std::vector<MetricTensor>& metrics)
{
  parallelFor(mesh.numberOfPoints(), ChunkSize, mesh.threads(),
    [&](Index p)
    {
      MetricTensor& m = metrics[p];
      m = mesh.dimension() == 2 ? flattened(m, mesh.normals()[p]) : m;
      m = limited(m, limits);
    });
}

//------------------------------------------------------------------------------
void intersectMetrics(const AdaptationMesh& mesh, const std::vector<MetricTensor>& others,
  std::vector<MetricTensor>& metrics)
{
  parallelFor(mesh.numberOfPoints(), ChunkSize, mesh.threads(),
    [&](Index p)
    {
      MetricTensor& m = metrics[p];
      m = intersection(m, others[p]);
      m = mesh.dimension() == 2 ? flattened(m, mesh.normals()[p]) : m;
    });
}

//------------------------------------------------------------------------------
GradationResult gradeMetrics(
  const AdaptationMesh& mesh, double growth, std::vector<MetricTensor>& metrics)
{
  if (!(growth > 1.0) || !std::isfinite(growth))
  {
    throw Error("The growth factor of the gradation is " + std::to_string(growth) +
      ": use a number above 1, such as 1.5.");
  }
  return Gradation(mesh, std::log(growth), metrics).run();
}
} // namespace tautline
