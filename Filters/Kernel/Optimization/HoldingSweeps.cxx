// SPDX-License-Identifier: BSD-3-Clause
#include "HoldingSweeps.h"

#include "LocalSweep.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
class HoldingSweeps
{
public:
  HoldingSweeps(OptimizationProblem& problem, const QualityGuard& guard)
    : Problem(problem)
    , Guard(guard)
    , Active(problem.simplices().freeVertices(), 1)
  {
  }

  StopReason run(const StoppingTest& watch,
    const std::function<bool(const IterationRecord&)>& report,
    const std::vector<IterationRecord>& history)
  {
    StopReason reason = StopReason::NoProgress;
    int failures = 0;
    while (!watch.ends(history, reason))
    {
      const IterationRecord& before = history.back(); // until report() adds another one
      this->Problem.store();
      const std::vector<double> points = this->Problem.points();
      const IterationRecord now = this->sweep(before, points);
      const double lowered = scalarized(this->Problem.scalarizer(), before) - now.objective,
                   size = std::abs(now.objective);
      const bool restored = !this->Restored.empty();
      if (!(lowered > roundingOfSums * size) || (restored && !this->Problem.isWithinTolerance()))
      {
        this->Problem.restart(points);
        if (!restored || ++failures == maxFailures)
        {
          return StopReason::NoProgress;
        }
        for (std::int32_t v : this->Restored)
        {
          this->Active[v] = 0;
        }
        continue;
      }
      if (!report(now))
      {
        return StopReason::Aborted;
      }
      if (lowered <= this->Problem.options().stopping.relativeChange * size)
      {
        return StopReason::RelativeChange;
      }
    }
    return reason;
  }

private:
  static constexpr int maxFailures = 20;

  /// One sweep from `points`, undone where the worst element gets worse.
  IterationRecord sweep(const IterationRecord& before, const std::vector<double>& points)
  {
    OptimizationProblem& problem = this->Problem;
    LocalSweeper sweeper(problem.simplices(), problem.moving(), problem.points().data(),
      problem.localTerms(), problem.localOptions(), &problem.order());
    sweeper.wakeOnly(this->Active);
    std::vector<double> values = before.objectives;
    const SweepResult swept = sweeper.sweep(problem.scalarizer(), values);
    problem.store();
    const std::vector<double> reached = problem.points();
    this->Guard.restore(problem, points.data());
    this->Restored.clear();
    for (std::int32_t v = 0; v < problem.simplices().freeVertices(); ++v)
    {
      const auto p = 3 * static_cast<std::size_t>(problem.simplices().point(v));
      if (!std::equal(&reached[p], &reached[p] + 3, &problem.points()[p]))
      {
        this->Restored.push_back(v);
      }
    }
    IterationRecord now = problem.record(before.iteration + 1);
    now.gradientNorm = swept.gradientNorm;
    now.moving = swept.moved;
    return now;
  }

  OptimizationProblem& Problem;
  const QualityGuard& Guard;
  std::vector<unsigned char> Active;  ///< one flag per free vertex
  std::vector<std::int32_t> Restored; ///< vertices put back after the last sweep
};
}

//------------------------------------------------------------------------------
StopReason sweepHoldingWorst(OptimizationProblem& problem, const QualityGuard& guard,
  const StoppingTest& watch, const std::function<bool(const IterationRecord&)>& report,
  const std::vector<IterationRecord>& history)
{
  return HoldingSweeps(problem, guard).run(watch, report, history);
}
}
