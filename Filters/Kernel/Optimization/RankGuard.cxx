// SPDX-License-Identifier: BSD-3-Clause
#include "RankGuard.h"

#include "QualityGuard.h"
#include "tautline/Quality/JudgedValues.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace tautline
{
namespace
{
/// What an element of value q adds to an objective.
double termOf(const Objective& objective, double q)
{
  switch (objective.objectiveTemplate)
  {
    case ObjectiveTemplate::SumOfSquares:
      return q * q;
    case ObjectiveTemplate::SumOfSquaredReciprocals:
      return 1.0 / (q * q);
    case ObjectiveTemplate::SumOfReciprocals:
      return 1.0 / q;
    default:
      return metricInfo(objective.metric).direction == Direction::LargerIsBetter ? -q : q;
  }
}
}

//------------------------------------------------------------------------------
RankGuard::RankGuard(
  const DistributedMesh& mesh, bool mirrored, const OptimizeOptions& options, bool valid)
  : TheMesh(mesh)
  , Mirrored(mirrored)
  , Threads(options.threads)
  , Judged(judgedBy(options.worstMetric.value_or(options.objectives[0].metric), options))
  , Active(valid && !options.allowInversion)
{
  const MetricInfo& info = metricInfo(this->Judged.metric);
  this->Larger = info.direction == Direction::LargerIsBetter;
  const Elements start = this->measure(mesh.points());
  if (!options.allowInversion && (options.holdWorst || options.improveWorst > 0))
  {
    this->requireValues(start);
  }
  this->Worst = start.worst;
  this->HoldsWorst =
    options.holdWorst && std::isfinite(this->Worst) && info.direction != Direction::Neutral;
}

//------------------------------------------------------------------------------
/// Throws Error on all ranks if a valid element of the input has no finite value.
void RankGuard::requireValues(const Elements& start) const
{
  const MeshView& view = this->TheMesh.view();
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    if (start.validity[cell] == Valid && start.values[cell] == HUGE_VAL)
    {
      // The numbers of cells are those of a part: where it is does not depend on the ranks.
      std::ostringstream place;
      const Vec3 p = pointOf(view, view.connectivity[view.offsets[cell]]);
      place << "a cell at the point (" << p[0] << ", " << p[1] << ", " << p[2] << ")";
      throw Error(noValueToJudge(metricInfo(this->Judged.metric), place.str()));
    }
  }
}

//------------------------------------------------------------------------------
bool RankGuard::isWorse(double value) const
{
  return this->HoldsWorst && !(value <= this->Worst + guardRounding * std::abs(this->Worst));
}

//------------------------------------------------------------------------------
RankGuard::Elements RankGuard::measure(const std::vector<double>& points) const
{
  Elements found;
  found.worst = -HUGE_VAL;
  const Index cells = this->TheMesh.view().numberOfCells;
  found.values.assign(cells, -HUGE_VAL);
  found.validity.assign(cells, Valid);
  if (cells > 0)
  {
    const Mesh moved = movedMesh(this->TheMesh, this->Mirrored, points, this->Threads);
    moved.classifyCells(found.validity.data(), this->Threads);
    std::vector<double> q(cells);
    evaluateJudged(moved, this->Judged.metric, this->Judged.evaluation, q.data());
    const MetricInfo& info = metricInfo(this->Judged.metric);
    for (const CellBlock& block : moved.blocks())
    {
      for (Index i = 0; info.definedOn(block.type) && i < block.count; ++i)
      {
        const Index cell = block.cell(i);
        found.values[cell] = this->Larger ? -q[cell] : q[cell];
        found.worst = std::max(found.worst, found.values[cell]);
      }
    }
  }
  found.worst = this->TheMesh.group().maximum(found.worst);
  return found;
}

//------------------------------------------------------------------------------
bool RankGuard::violatedAt(const Elements& elements) const
{
  bool violated = false;
  for (Index cell = 0; this->Active && cell < this->TheMesh.view().numberOfCells; ++cell)
  {
    violated = violated || this->offends(elements, cell);
  }
  return this->TheMesh.group().any(violated);
}

//------------------------------------------------------------------------------
void addObjectiveOnRanks(const DistributedMesh& mesh, const Objective& objective, const Mesh* moved,
  const std::vector<signed char>& validity, IterationRecord& record)
{
  RankGroup& group = mesh.group();
  std::vector<double> terms, values;
  double worst = -HUGE_VAL;
  const MetricInfo& info = metricInfo(objective.metric);
  const bool larger = info.direction == Direction::LargerIsBetter;
  if (moved)
  {
    std::vector<double> q(moved->view().numberOfCells);
    evaluateJudged(*moved, objective.metric, objective.evaluation, q.data());
    for (const CellBlock& block : moved->blocks())
    {
      for (Index k = 0; info.definedOn(block.type) && k < block.count; ++k)
      {
        const Index cell = block.cell(k);
        const double weight = objective.elementWeights ? objective.elementWeights[cell] : 1.0;
        if (!mesh.ownedCells()[cell])
        {
          continue;
        }
        const bool fault = info.barrier && validity[cell] != Valid && weight > 0 &&
          cornerValidity(*moved, cell) != Valid;
        if (weight > 0)
        {
          const bool undefined = fault || !std::isfinite(q[cell]);
          terms.push_back(undefined ? HUGE_VAL : weight * termOf(objective, q[cell]));
        }
        if (validity[cell] == Valid)
        {
          values.push_back(std::isfinite(q[cell]) ? q[cell] : 0.0);
          worst = std::max(worst, larger ? -q[cell] : q[cell]);
        }
      }
    }
  }
  const double sum = group.orderlessSum(terms);
  record.objectives.push_back(std::isnan(sum) ? HUGE_VAL : sum);
  const Index count = group.sum(static_cast<Index>(values.size()));
  const double total = group.orderlessSum(values);
  worst = group.maximum(worst);
  record.mean.push_back(count > 0 ? total / static_cast<double>(count) : 0.0);
  record.worst.push_back(count == 0 ? 0.0 : larger ? -worst : worst);
}
}
