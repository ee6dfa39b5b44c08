// SPDX-License-Identifier: BSD-3-Clause
#include "RoundedResult.h"

#include "QualityGuard.h"
#include "RankGuard.h"
#include "SweepControl.h"
#include "tautline/Objectives/ObjectiveSum.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace tautline
{
namespace
{
/// What the values of an objective's metric are on a mesh.
struct Values
{
  double objective = 0, mean = 0, worst = 0;
};

/// @param q the values of the metric, or empty: then they are measured
Values valuesOf(const Mesh& mesh, const Objective& given, int threads, std::vector<double>& q)
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
  Index count = 0;
  double squares = 0;
  for (const CellBlock& block : mesh.blocks())
  {
    const bool counts =
      topology(block.type).dimension == (mesh.dimension() == Dimension::Volume ? 3 : 2);
    for (Index i = 0; counts && i < block.count; ++i)
    {
      const double value = q[block.cell(i)];
      values.mean += value;
      squares += value * value;
      values.worst = count == 0 ? value
        : larger                ? std::min(values.worst, value)
                                : std::max(values.worst, value);
      ++count;
    }
  }
  values.mean /= static_cast<double>(std::max<Index>(count, 1));
  const ObjectiveTemplate made = objective.objectiveTemplate == ObjectiveTemplate::Default
    ? defaultTemplate(objective.metric)
    : objective.objectiveTemplate;
  const bool ofValues = made == ObjectiveTemplate::SumOfSquares && !objective.elementWeights;
  values.objective = ofValues ? squares : ObjectiveSum(mesh, objective, threads).value();
  return values;
}

/// Scalarizes the objectives of the record, and compares them with those of the start.
void compareObjectives(
  const OptimizeOptions& options, const std::vector<double>& start, RoundedResult& found)
{
  // In the lexicographic method the first objective counts, which may rise by the tolerance.
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
  const OptimizeOptions& options, OptimizeResult& result, const Mesh& rounded)
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
    found.lost += there[cell] == Valid && now[cell] != Valid;
    found.inverted += isInvalid(now[cell]);
  }
  const QualityGuard guard(mesh, validity, options);
  if (!guard.holdsObjective() || found.lost > 0)
  {
    return found;
  }
  std::vector<double> judged;
  found.worseWorst = guard.violatedAt(rounded, now, judged);
  // The first objective's metric judges as a rule.
  const Objective& first = options.objectives[0];
  const bool same = guard.judged().metric == first.metric;
  std::vector<double> start;
  for (const Objective& objective : options.objectives)
  {
    const bool known = same && &objective == &first;
    std::vector<double> before = known ? guard.values() : std::vector<double>();
    std::vector<double> after = known ? judged : std::vector<double>();
    start.push_back(valuesOf(mesh, objective, threads, before).objective);
    const Values values = valuesOf(rounded, objective, threads, after);
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
  return found;
}

//------------------------------------------------------------------------------
RoundedResult measureRoundedOnRanks(const DistributedMesh& mesh, bool mirrored,
  const OptimizeOptions& options, const OptimizeResult& result, const std::vector<double>& rounded)
{
  RankGroup& group = mesh.group();
  RoundedResult found;
  std::unique_ptr<Mesh> input, moved; // null on a rank without cells
  std::vector<signed char> before, after;
  std::vector<Objective> objectives;
  objectives = options.objectives;
  for (Objective& objective : objectives)
  {
    objective.evaluation.threads = options.threads;
    objective.objectiveTemplate = objective.objectiveTemplate == ObjectiveTemplate::Default
      ? defaultTemplate(objective.metric)
      : objective.objectiveTemplate;
  }
  if (mesh.view().numberOfCells > 0)
  {
    const auto at = [&](const std::vector<double>& points)
    { return movedMesh(mesh, mirrored, points, options.threads); };
    input = std::make_unique<Mesh>(at(mesh.points()));
    moved = std::make_unique<Mesh>(at(rounded));
    before = cellValidity(*input, options.threads);
    after = cellValidity(*moved, options.threads);
    const std::vector<signed char> there = cellValidity(at(result.points), options.threads);
    for (std::size_t cell = 0; cell < after.size(); ++cell)
    {
      const bool owned = mesh.ownedCells()[cell] != 0;
      found.lost += owned && there[cell] == Valid && after[cell] != Valid;
      found.inverted += owned && isInvalid(after[cell]);
    }
  }
  found.lost = group.sum(found.lost);
  found.inverted = group.sum(found.inverted);
  found.record.inverted = found.inverted;
  const RankGuard guard(mesh, mirrored, options, result.invertedBefore == 0);
  if (!guard.active() || found.lost > 0)
  {
    return found;
  }
  found.worseWorst = guard.violatedAt(guard.measure(rounded));
  IterationRecord start;
  for (const Objective& objective : objectives)
  {
    addObjectiveOnRanks(mesh, objective, input.get(), before, start);
    addObjectiveOnRanks(mesh, objective, moved.get(), after, found.record);
  }
  compareObjectives(options, start.objectives, found);
  return found;
}
}
