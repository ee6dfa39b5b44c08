// SPDX-License-Identifier: BSD-3-Clause
#include "LeaveSurface.h"

#include "tautline/Quality/JudgedValues.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
constexpr int maxSurfaceRounds = 50;
/// Elements within this factor of the worst value belong to the worst.
constexpr double amongWorst = 1.05;
/// Points move within this many layers of elements around the worst ones.
constexpr int layers = 2;
/// A round that improves the worst value by less than this fraction of it is the last.
constexpr double worthwhileRise = 5e-3;

/// Flags the valid elements with a movable point whose values are near the worst one.
std::vector<char> worstElements(const OptimizationProblem& problem, const Objective& judged,
  const std::vector<unsigned char>& movable, double& worst)
{
  const Mesh& mesh = problem.moving();
  const MeshView& view = mesh.view();
  std::vector<signed char> validity(view.numberOfCells);
  mesh.classifyCells(validity.data(), problem.options().threads);
  std::vector<double> q(view.numberOfCells);
  evaluateJudged(mesh, judged.metric, judged.evaluation, q.data());
  const bool larger = metricInfo(judged.metric).direction == Direction::LargerIsBetter;
  const int dimension = mesh.dimension() == Dimension::Volume ? 3 : 2;
  std::vector<char> candidates(view.numberOfCells, 0);
  bool found = false;
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; t.dimension == dimension && i < block.count; ++i)
    {
      const Index cell = block.cell(i);
      const Index* node = view.connectivity + view.offsets[cell];
      if (validity[cell] == Valid && std::isfinite(q[cell]) &&
        std::any_of(node, node + t.nodes, [&](Index p) { return movable[p] != 0; }))
      {
        candidates[cell] = 1;
        worst = !found ? q[cell] : larger ? std::min(worst, q[cell]) : std::max(worst, q[cell]);
        found = true;
      }
    }
  }
  const double margin = (amongWorst - 1) * std::abs(worst);
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    candidates[cell] = candidates[cell] && std::abs(q[cell] - worst) <= margin;
  }
  return candidates;
}

/// Flags the points of flagged elements, or of elements with a flagged point.
void spread(const MeshView& view, std::vector<char>& elements, std::vector<unsigned char>& points)
{
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    for (Index n = view.offsets[cell]; elements[cell] && n < view.offsets[cell + 1]; ++n)
    {
      points[view.connectivity[n]] = 1;
    }
  }
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const Index* node = view.connectivity + view.offsets[cell];
    const Index* end = view.connectivity + view.offsets[cell + 1];
    elements[cell] = std::any_of(node, end, [&](Index p) { return points[p] != 0; });
  }
}
}

//------------------------------------------------------------------------------
Index LeavingResult::count(const std::vector<double>& coordinates) const
{
  Index count = 0;
  for (std::size_t i = 0; i < this->points.size(); ++i)
  {
    const double* was = &this->onSurface[3 * i];
    count += !std::equal(was, was + 3, &coordinates[3 * this->points[i]]);
  }
  return count;
}

//------------------------------------------------------------------------------
LeavingResult leaveSurface(const Mesh& mesh, OptimizationProblem& problem,
  const QualityGuard& guard, const WorstLimits& limits, const Stopwatch& clock,
  const std::function<bool(OptimizationProblem&, const IterationRecord&)>& report)
{
  const MeshView& view = mesh.view();
  OptimizeOptions options = problem.options();
  problem.store();
  LeavingResult result;
  const std::vector<unsigned char> fixed(options.fixed, options.fixed + view.numberOfPoints);
  std::vector<unsigned char> movable(view.numberOfPoints), loose(view.numberOfPoints, 0);
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    movable[p] = !fixed[p] || options.leaving[p];
  }
  const Objective& judged = guard.judged();
  double worst = 0;
  std::vector<char> elements = worstElements(problem, judged, movable, worst);
  const bool some = std::any_of(elements.begin(), elements.end(), [](char e) { return e != 0; });
  for (int round = 0; some && round < maxSurfaceRounds && !result.outOfTime && !result.stopped;
       ++round)
  {
    // Points that have left the surface stay loose, because there is nothing on which they could
    // slide.
    std::vector<unsigned char> near(view.numberOfPoints, 0), held(view.numberOfPoints);
    spread(view, elements, near);
    for (Index p = 0; p < view.numberOfPoints; ++p)
    {
      if (!loose[p] && near[p] && options.leaving[p])
      {
        loose[p] = 1;
        const double* at = &problem.points()[3 * p];
        result.points.push_back(p);
        result.onSurface.insert(result.onSurface.end(), at, at + 3);
      }
    }
    for (int layer = 0; layer < layers; ++layer)
    {
      spread(view, elements, near);
    }
    for (Index p = 0; p < view.numberOfPoints; ++p)
    {
      held[p] = !(near[p] && (loose[p] || !fixed[p]));
    }
    options.fixed = held.data();
    std::vector<double> points = problem.points();
    OptimizationProblem inner(mesh, options, points, clock);
    inner.loosen(loose);
    inner.start(inner.record(0));
    result.outOfTime = improveWorst(inner, guard, limits,
      [&](const IterationRecord& record)
      {
        result.stopped = !report(inner, record);
        return !result.stopped;
      });
    inner.store();
    const double before = worst;
    problem.restart(points);
    elements = worstElements(problem, judged, movable, worst);
    if (std::abs(worst - before) < worthwhileRise * std::abs(before))
    {
      break;
    }
  }
  return result;
}
}
