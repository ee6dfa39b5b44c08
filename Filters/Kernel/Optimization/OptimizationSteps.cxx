// SPDX-License-Identifier: BSD-3-Clause
#include "OptimizationSteps.h"

#include "GlobalFunction.h"
#include "HarmonicStart.h"
#include "tautline/Core/Memory.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <type_traits>

namespace tautline
{
namespace
{
/// Returns the result of work(). @throws MemoryError if it does not fit, so that the sweeps
/// continue, unless the user has chosen a global optimizer
template <class Work>
std::invoke_result_t<Work> inMemory(const OptimizeOptions& options, const Work& work)
{
  try
  {
    return work();
  }
  catch (const std::bad_alloc&)
  {
    if (isGlobal(options.optimizer))
    {
      throw;
    }
    throw MemoryError("The matrix does not fit into memory.");
  }
}

std::vector<double> coordinatesOf(SimplexMesh& simplices)
{
  const double* x = simplices.coordinates();
  return { x, x + VertexStride * static_cast<std::size_t>(simplices.freeVertices()) };
}

/// The decrease of the mesh objective by a sweep. On patches, steps may increase it: then the
/// absolute change.
double loweredBy(
  const Scalarizer& scalarizer, const IterationRecord& before, const IterationRecord& now)
{
  const double lowered = scalarized(scalarizer, before) - now.objective;
  return now.objectives.size() > 1 && scalarizer.onPatches() ? std::abs(lowered) : lowered;
}

/// Restores the coordinates before a sweep.
void takeBack(OptimizationProblem& problem, const std::vector<double>& coordinates)
{
  std::copy(coordinates.begin(), coordinates.end(), problem.simplices().coordinates());
  problem.coordinatesChanged();
  problem.store();
}

/// Limits further sweeps to one step per vertex; returns whether they made several.
bool makeSingleSteps(LocalSweeper& sweeper, int& patchIterations)
{
  const bool several = patchIterations > 1;
  patchIterations = 1;
  sweeper.setPatchIterations(patchIterations);
  sweeper.wakeAll();
  return several;
}
}

//------------------------------------------------------------------------------
bool OptimizationSteps::report(OptimizationProblem& problem, const IterationRecord& record)
{
  this->History.push_back(presentable(problem.scalarizer(), record));
  const auto& observer = problem.options().observer;
  const auto points = [&](double* p)
  {
    if (!problem.ranks().several()) // storing them is collective
    {
      problem.store();
    }
    std::copy(problem.points().begin(), problem.points().end(), p);
  };
  const bool proceed =
    !observer || observer({ this->History.back(), this->Watch.progress(record), points });
  return !problem.ranks().any(!proceed);
}

//------------------------------------------------------------------------------
StopReason OptimizationSteps::sweep(Slowness* slow, bool& failed, bool& repaired)
{
  OptimizationProblem& problem = this->Problem;
  const StoppingTest& watch = this->Watch;
  const std::vector<IterationRecord>& history = this->History;
  const StoppingCriteria& stop = problem.options().stopping;
  SimplexMesh& simplices = problem.simplices();
  LocalSweeper sweeper(simplices, problem.moving(), problem.points().data(), problem.localTerms(),
    problem.localOptions(), &problem.order());
  std::vector<double> best = coordinatesOf(simplices);
  // One objective in closed form needs neither the mesh points during sweeps nor a backup: each
  // step reduces it. Records of several ranks use stored points.
  const bool costly = problem.ranks().any(!problem.isSimple());
  const bool simple = !costly && !problem.ranks().several();
  StopReason reason = StopReason::NoProgress;
  int patchIterations = problem.options().patchIterations;
  double firstGradient = 0;
  bool all = true;          // whether the next sweep visits every vertex
  SweepGains gains(costly); // hexahedra have no closed form
  for (int iteration = this->next();; ++iteration)
  {
    if (watch.ends(history, reason))
    {
      return reason;
    }
    const IterationRecord before = history.back();
    std::vector<double> values = before.objectives;
    const SweepResult sweep = sweeper.sweep(problem.scalarizer(), values);
    if (!simple)
    {
      problem.store();
    }
    IterationRecord now = problem.record(iteration);
    now.gradientNorm = sweep.gradientNorm;
    now.moving = sweep.moved;
    const double lowered = loweredBy(problem.scalarizer(), before, now);
    const double size = std::abs(now.objective);
    if (!simple && !(std::isfinite(size) && lowered >= -roundingOfSums * size))
    {
      // Blocks of one color ignore each other's changes of a composite objective, which may then
      // increase or leave its domain (a product with a negative factor), mostly with several steps.
      takeBack(problem, best);
      if (makeSingleSteps(sweeper, patchIterations))
      {
        all = true;
        --iteration;
        continue;
      }
      failed = true;
      return StopReason::NoProgress;
    }
    if (!simple)
    {
      std::copy_n(simplices.coordinates(), best.size(), best.begin());
    }
    firstGradient = firstGradient > 0 ? firstGradient : sweep.gradientNorm;
    if (!this->report(now))
    {
      return StopReason::Aborted;
    }
    if (problem.someRepaired() && !watch.ends(history, reason))
    {
      repaired = true;
      return StopReason::NoProgress;
    }

    gains.add(lowered);
    // Each sweep moves points of a surface slightly off the input: avoid unnecessary sweeps.
    const double remaining = problem.surface() ? lowered : gains.remaining();
    if (slow && (gains.stiff(size) || gains.slow(size, stop.relativeChange)))
    {
      *slow = gains.stiff(size) ? Slowness::Far : Slowness::Near;
      return StopReason::NoProgress;
    }

    // Convergence is only accepted after a sweep over all vertices.
    if (!converged(
          stop, sweep, all, firstGradient, lowered, remaining, gains.remaining(), size, reason))
    {
      all = sweep.moved == 0;
      if (all)
      {
        sweeper.wakeAll();
      }
      continue;
    }
    if (!all)
    {
      sweeper.wakeAll();
      all = true;
    }
    else if (problem.scalarizer().next(history.back().objectives))
    {
      sweeper.wakeAll();
      gains.clear();
      firstGradient = 0;
    }
    else
    {
      return reason;
    }
  }
}

//------------------------------------------------------------------------------
StopReason OptimizationSteps::minimizeAll(Optimizer method)
{
  StopReason reason = StopReason::NoProgress;
  const auto minimize = [&] { reason = this->minimizeTogether(method); };
  // If memory is insufficient, the caller continues, on all ranks alike.
  this->Problem.ranks().together(
    [&]
    {
      method == Optimizer::NewtonConjugateGradient ? inMemory(this->Problem.options(), minimize)
                                                   : minimize();
    });
  return reason;
}

//------------------------------------------------------------------------------
StopReason OptimizationSteps::minimizeTogether(Optimizer method)
{
  OptimizationProblem& problem = this->Problem;
  const std::vector<IterationRecord>& history = this->History;
  const StoppingCriteria& stop = problem.options().stopping;
  StopReason reason = StopReason::NoProgress;
  if (this->Watch.ends(history, reason))
  {
    return reason;
  }
  const bool alone = isGlobal(problem.options().optimizer);
  GlobalFunction function(problem, method);
  std::vector<double> x(function.size(), 0.0);
  for (;;)
  {
    const int before = history.back().iteration;
    MinimizeOptions options = minimizeOptions(stop, method, alone);
    options.maximumIterations -= before;
    options.outOfTime = [&] { return problem.outOfTime(); };
    options.threads = problem.options().threads;
    options.group = problem.ranks().group();
    bool ended = false;
    options.observer = [&](int iteration, double, double gradientNorm, const double* now)
    {
      function.put(now);
      IterationRecord record = problem.record(before + iteration);
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
    function.put(x.data());
    if (ended)
    {
      return reason;
    }
    if (!problem.scalarizer().next(problem.record(0).objectives))
    {
      return found.reason;
    }
  }
}

//------------------------------------------------------------------------------
std::vector<double> OptimizationSteps::harmonic(const std::vector<double>& points)
{
  return inMemory(this->Problem.options(), [&] { return harmonicPoints(this->Problem, points); });
}

//------------------------------------------------------------------------------
bool OptimizationSteps::hasManyCorners() const
{
  const Mesh& mesh = this->Problem.moving();
  const Ranks& ranks = this->Problem.ranks();
  const int dimension = mesh.dimension() == Dimension::Volume ? 3 : 2;
  Index simplices = 0, others = 0;
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; t.dimension == dimension && i < block.count; ++i)
    {
      (t.samples > 1 ? others : simplices) += ranks.ownsCell(block.cell(i));
    }
  }
  return static_cast<double>(ranks.sum(others)) >
    manyCorners * static_cast<double>(ranks.sum(simplices));
}

bool OptimizationSteps::hasConvexPart() const
{
  return !this->Problem.ranks().any(!HessianMatrix::hasConvexPart(this->Problem.resolved()[0]));
}

//------------------------------------------------------------------------------
bool OptimizationSteps::hasConstraintsOrTargets() const
{
  const OptimizeOptions& options = this->Problem.options();
  return this->Problem.ranks().any(options.slidePlanes || options.slideLines || options.limits ||
    options.objectives[0].evaluation.targets ||
    this->Problem.moving().dimension() == Dimension::Surface);
}

bool OptimizationSteps::slidesOnSurface() const
{
  const OptimizeOptions& options = this->Problem.options();
  return this->Problem.moving().dimension() != Dimension::Surface &&
    (options.model || options.slideSurface);
}

bool OptimizationSteps::holdsPoints()
{
  const std::vector<unsigned char>& held = this->Problem.slides().held;
  return this->Problem.someAtLimit() ||
    this->Problem.ranks().any(
      std::any_of(held.begin(), held.end(), [](unsigned char h) { return h != 0; }));
}
}
