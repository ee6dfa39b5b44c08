// SPDX-License-Identifier: BSD-3-Clause
#include "RoundedResult.h"

#include "QualityGuard.h"
#include "SweepControl.h"
#include "tautline/Mesh/MeshElements.h"
#include "tautline/Objectives/ObjectiveSum.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tautline
{
namespace
{
/// The metric values of an objective on a mesh.
struct Values
{
  double objective = 0, mean = 0, worst = 0;
};

/// @param q the values of the metric, or empty to compute them
Values valuesOf(
  const Mesh& mesh, const Objective& given, int threads, const Ranks& ranks, std::vector<double>& q)
{
  Objective objective = given;
  objective.evaluation.threads = threads;
  if (q.empty())
  {
    q.resize(mesh.view().numberOfCells);
    evaluateMetric(mesh, objective.metric, objective.evaluation, q.data());
  }
  const MetricInfo& info = metricInfo(objective.metric);
  const bool larger = info.direction == Direction::LargerIsBetter;
  Values values;
  std::vector<double> own;
  double squares = 0, worst = -std::numeric_limits<double>::infinity(); // larger is worse
  for (const CellBlock& block : mesh.blocks())
  {
    for (Index i = 0; isElement(mesh, block.type) && i < block.count; ++i)
    {
      if (ranks.ownsCell(block.cell(i)))
      {
        const double value = q[block.cell(i)];
        own.push_back(value);
        squares += value * value;
        worst = std::max(worst, larger ? -value : value);
      }
    }
  }
  const Index count = ranks.sum(static_cast<Index>(own.size()));
  values.mean = ranks.total(own) / static_cast<double>(std::max<Index>(count, 1));
  worst = ranks.maximum(worst);
  values.worst = count == 0 ? 0.0 : larger ? -worst : worst;
  const ObjectiveTemplate made = objective.objectiveTemplate == ObjectiveTemplate::Default
    ? defaultTemplate(objective.metric)
    : objective.objectiveTemplate;
  const bool ofValues = made == ObjectiveTemplate::SumOfSquares && !objective.elementWeights;
  values.objective =
    ofValues && !ranks.several() ? squares : ObjectiveSum(mesh, objective, threads, ranks).value();
  return values;
}

/// Scalarizes the objectives of the record, and compares them with the initial ones.
void compareObjectives(
  const OptimizeOptions& options, const std::vector<double>& start, RoundedResult& found)
{
  // In the lexicographic method, the first objective decides, and may increase by the tolerance.
  const bool lexicographic = options.scalarization.method == Scalarization::Lexicographic;
  std::vector<double> weights;
  for (const Objective& objective : options.objectives)
  {
    weights.push_back(objective.weight);
  }
  double then = start[0];
  found.record.objective = found.record.objectives[0];
  if (start.size() > 1 && !lexicographic)
  {
    const Scalarizer scalarizer(options.scalarization, weights, start);
    then = scalarizer.value(start);
    found.record.objective = scalarizer.value(found.record.objectives);
  }
  const double rise =
    roundingOfSums + (lexicographic && start.size() > 1 ? options.scalarization.tolerance : 0.0);
  found.largerObjective = !(found.record.objective <= then + rise * std::abs(then));
}
}

//------------------------------------------------------------------------------
RoundedResult measureRounded(const Mesh& mesh, const std::vector<signed char>& validity,
  const OptimizeOptions& options, OptimizeResult& result, const Mesh& rounded, const Ranks& ranks)
{
  const int threads = options.threads;
  RoundedResult found;
  std::vector<signed char> there = std::move(result.elements.validity);
  if (there.empty())
  {
    Mesh moved = mesh.at(result.points.data());
    moved.setSpace(mesh.space());
    there = cellValidity(moved, threads);
  }
  found.elements.validity = cellValidity(rounded, threads);
  const std::vector<signed char>& now = found.elements.validity;
  for (std::size_t cell = 0; cell < now.size(); ++cell)
  {
    found.lost +=
      ranks.ownsCell(static_cast<Index>(cell)) && there[cell] == Valid && now[cell] != Valid;
  }
  found.lost = ranks.sum(found.lost);
  found.inverted = ranks.countInvalid(mesh, now);
  const QualityGuard guard(mesh, validity, options, ranks);
  if (!guard.holdsObjective() || found.lost > 0)
  {
    return found;
  }
  std::vector<double> judged;
  found.worseWorst = guard.violatedAt(rounded, now, judged);
  // By default, the metric of the first objective is used.
  const Objective& first = options.objectives[0];
  const bool same = guard.judged().metric == first.metric;
  std::vector<double> start;
  for (const Objective& objective : options.objectives)
  {
    const bool known = same && &objective == &first;
    std::vector<double> before = known ? guard.values() : std::vector<double>();
    std::vector<double> after = known ? judged : std::vector<double>();
    start.push_back(valuesOf(mesh, objective, threads, ranks, before).objective);
    const Values values = valuesOf(rounded, objective, threads, ranks, after);
    found.record.objectives.push_back(values.objective);
    found.record.mean.push_back(values.mean);
    found.record.worst.push_back(values.worst);
    if (known)
    {
      found.elements.before = std::move(before);
      found.elements.after = std::move(after);
    }
  }
  compareObjectives(options, start, found);
  found.largerObjective = found.largerObjective && !result.worstFirst;
  return found;
}
}
