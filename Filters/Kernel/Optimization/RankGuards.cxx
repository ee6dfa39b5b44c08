// SPDX-License-Identifier: BSD-3-Clause
// What an optimization on ranks must not make worse: validity, the worst element, the objective.
#include "OptimizationOnRanks.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
//------------------------------------------------------------------------------
/// The metric that judges elements and the validity, of the local cells; the worst of the whole
/// mesh, which is larger the worse.
double OptimizationOnRanks::judge(const std::vector<double>& points, std::vector<double>& values,
  std::vector<signed char>& validity) const
{
  double worst = -infinity;
  this->Group.together(
    [&]
    {
      values.assign(this->TheMesh.view().numberOfCells, -infinity);
      validity.assign(values.size(), Valid);
      if (!this->Start)
      {
        return;
      }
      const Mesh moved = movedMesh(this->TheMesh, this->Mirrored, points, this->Options.threads);
      moved.classifyCells(validity.data(), this->Options.threads);
      std::vector<double> q(values.size());
      evaluateMetric(moved, this->Judged.metric, this->Judged.evaluation, q.data());
      const MetricInfo& info = metricInfo(this->Judged.metric);
      for (const CellBlock& block : moved.blocks())
      {
        for (Index i = 0; info.definedOn(block.type) && i < block.count; ++i)
        {
          const Index cell = block.cell(i);
          values[cell] = info.direction == Direction::LargerIsBetter ? -q[cell] : q[cell];
          worst = std::max(worst, values[cell]);
        }
      }
    });
  return this->Group.maximum(worst);
}

//------------------------------------------------------------------------------
/// Puts points back to where they were in the input, about the elements that are invalid or worse
/// than all of the input, until there is none.
Index OptimizationOnRanks::restoreWorst()
{
  constexpr double rounding = 1e-9;
  constexpr int maxRounds = 20; // then all points go back
  const MeshView& view = this->TheMesh.view();
  std::vector<unsigned char> restored(this->TheMesh.localPoints(), 0);
  for (int round = 0; this->ValidInput; ++round)
  {
    std::vector<double> values;
    std::vector<signed char> validity;
    this->judge(this->Points, values, validity);
    std::vector<unsigned char> back = restored;
    const double limit = this->Worst + rounding * std::abs(this->Worst);
    for (Index cell = 0; cell < view.numberOfCells; ++cell)
    {
      const bool offends = validity[cell] != Valid ||
        (this->HoldsWorst && !(values[cell] <= limit)) || round >= maxRounds;
      for (Index n = view.offsets[cell]; offends && n < view.offsets[cell + 1]; ++n)
      {
        back[view.connectivity[n]] = 1;
      }
    }
    this->TheMesh.exchange(back.data());
    if (!this->Group.any(back != restored))
    {
      break;
    }
    restored = back;
    std::vector<double> points = this->Points;
    for (Index p = 0; p < this->TheMesh.localPoints(); ++p)
    {
      if (restored[p])
      {
        std::copy_n(&this->TheMesh.points()[3 * p], 3, &points[3 * p]);
      }
    }
    this->restart(points);
  }
  Index count = 0;
  for (Index p = 0; p < this->TheMesh.localPoints(); ++p)
  {
    count += restored[p] && this->TheMesh.owned(p);
  }
  return this->Group.sum(count);
}

//------------------------------------------------------------------------------
/// Goes back to the input if its objective is smaller.
void OptimizationOnRanks::keepInput(const IterationRecord& first)
{
  IterationRecord now = this->record(this->Result.history.back().iteration);
  if (!this->ValidInput || !isLarger(this->Options.scalarization, *this->TheScalarizer, now, first))
  {
    return;
  }
  this->restart(this->TheMesh.points());
  now = this->record(now.iteration);
  now.objective = first.objective;
  this->Result.history.back() = now;
  if (this->Result.reason != StopReason::Aborted && this->Result.reason != StopReason::TimeLimit)
  {
    this->Result.reason = StopReason::NoProgress;
  }
  this->Result.unchanged = true;
  this->Result.restored = 0;
}
}
