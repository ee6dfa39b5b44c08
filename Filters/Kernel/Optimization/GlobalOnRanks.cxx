// SPDX-License-Identifier: BSD-3-Clause
// Steps of all vertices of a mesh on several ranks at once; see Optimize.cxx for the same on one
// process, and AutomaticMethod.h for when they are taken.
#include "GlobalFunctionOnRanks.h"
#include "HarmonicStart.h"
#include "OptimizationOnRanks.h"

namespace tautline
{
//------------------------------------------------------------------------------
const MatrixRows& OptimizationOnRanks::rows()
{
  if (!this->Rows)
  {
    this->Rows = std::make_unique<MatrixRows>(this->TheMesh, this->Free);
  }
  return *this->Rows;
}

//------------------------------------------------------------------------------
/// See optimizeGlobally() in Optimize.cxx.
StopReason OptimizationOnRanks::minimizeAll(Optimizer method)
{
  StopReason reason = StopReason::NoProgress;
  // The caller goes on where memory lacks on all ranks, and on all alike.
  this->Group.together([&] { reason = this->minimizeTogether(method); });
  return reason;
}

//------------------------------------------------------------------------------
StopReason OptimizationOnRanks::minimizeTogether(Optimizer method)
{
  const StoppingCriteria& stop = this->Options.stopping;
  std::vector<IterationRecord>& history = this->Result.history;
  StopReason reason = StopReason::NoProgress;
  if (this->Watch.ends(history, reason))
  {
    return reason;
  }
  const bool alone = isGlobal(this->Options.optimizer);
  GlobalFunctionOnRanks function(this->TheMesh, this->rows(), this->Problem.get(),
    *this->TheScalarizer, this->Options.objectives.size(), method, this->Coordinates,
    this->Options.threads);
  std::vector<double> x(function.size(), 0.0);
  const auto put = [&](const double* at)
  {
    function.put(at);
    // Points of the piece without a cell here.
    this->TheMesh.exchange(this->Points.data(), 3);
  };
  for (;;)
  {
    const int before = history.back().iteration;
    MinimizeOptions options = minimizeOptions(stop, method, alone);
    options.maximumIterations -= before;
    options.outOfTime = [&] { return this->outOfTime(); };
    options.threads = this->Options.threads;
    options.group = &this->Group;
    bool ended = false;
    options.observer = [&](int iteration, double, double gradientNorm, const double* now)
    {
      put(now);
      IterationRecord record = this->record(before + iteration);
      record.gradientNorm = gradientNorm;
      if (!this->report(record))
      {
        reason = StopReason::Aborted;
        ended = true;
      }
      else
      {
        ended = this->Watch.ends(history, reason);
      }
      return !ended;
    };
    const MinimizeResult found = minimize(function, x.data(), options);
    put(x.data());
    if (ended)
    {
      return reason;
    }
    if (!this->TheScalarizer->next(this->record(0).objectives))
    {
      return found.reason;
    }
  }
}

//------------------------------------------------------------------------------
bool OptimizationOnRanks::hasManyCorners() const
{
  Index simplices = 0, others = 0;
  const MeshView& view = this->TheMesh.view();
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const CellTopology& t = topology(cornerType(view.cellTypes[cell]));
    if (this->TheMesh.ownedCells()[cell] && t.dimension == this->Coordinates)
    {
      ++(t.samples > 1 ? others : simplices);
    }
  }
  return static_cast<double>(this->Group.sum(others)) >
    manyCorners * static_cast<double>(this->Group.sum(simplices));
}

//------------------------------------------------------------------------------
bool OptimizationOnRanks::hasConvexPart()
{
  const bool convex = !this->Problem || HessianMatrix::hasConvexPart(this->Problem->resolved()[0]);
  return !this->Group.any(!convex);
}

//------------------------------------------------------------------------------
bool OptimizationOnRanks::hasConstraintsOrTargets() const
{
  const OptimizeOptions& options = this->Options;
  return this->Group.any(options.slidePlanes || options.slideLines || options.limits ||
    options.objectives[0].evaluation.targets);
}

//------------------------------------------------------------------------------
bool OptimizationOnRanks::findHarmonicPoints(std::vector<double>& points)
{
  return harmonicPointsOnRanks(
    this->TheMesh, this->rows(), this->Problem.get(), this->Options.threads, points);
}

//------------------------------------------------------------------------------
void OptimizationOnRanks::shiftPoints(double part, std::vector<double>& points)
{
  if (this->Problem)
  {
    shiftFreePoints(
      this->Problem->moving(), this->Free, this->TheMesh.numbers().data(), part, points);
  }
  this->TheMesh.exchange(points.data(), 3); // a copy of a point may miss edges
}
}
