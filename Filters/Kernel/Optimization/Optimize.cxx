// SPDX-License-Identifier: BSD-3-Clause
#include "Optimize.h"

#include "AutomaticMethod.h"
#include "GlobalFunction.h"
#include "HarmonicStart.h"
#include "HoldingSweeps.h"
#include "tautline/Core/Memory.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Mesh/BoundaryPoints.h"
#include "tautline/Mesh/CoordinateFrame.h"
#include "ImproveWorst.h"
#include "LeaveSurface.h"
#include "Minimize.h"
#include "OptionChecks.h"
#include "QualityGuard.h"
#include "tautline/Quality/JudgedValues.h"
#include "SurfaceSlides.h"
#include "tautline/Untangling/Untangle.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <numeric>
#include <type_traits>

namespace tautline
{
namespace
{
/// Adds a record to the history and calls the observer; false if that stops the run.
bool report(OptimizationProblem& problem, const StoppingTest& watch, OptimizeResult& result,
  const IterationRecord& record)
{
  result.history.push_back(presentable(problem.scalarizer(), record));
  const auto& observer = problem.options().observer;
  if (!observer)
  {
    return true;
  }
  const auto points = [&](double* p)
  {
    problem.store();
    std::copy(problem.points().begin(), problem.points().end(), p);
  };
  return observer({ result.history.back(), watch.progress(record), points });
}

//------------------------------------------------------------------------------
/**
 * @brief Sweeps to convergence.
 * @param failed set where a sweep raised the objective, as those of several objectives can
 * @param repaired set where an element that was left out has become valid
 * @param slow set, if not null, where they converge too slowly
 */
StopReason optimizeLocally(OptimizationProblem& problem, const StoppingTest& watch,
  OptimizeResult& result, bool& failed, bool& repaired, Slowness* slow)
{
  const StoppingCriteria& stop = problem.options().stopping;
  SimplexMesh& simplices = problem.simplices();
  LocalSweeper sweeper(simplices, problem.moving(), problem.points().data(), problem.localTerms(),
    problem.localOptions());
  std::vector<double> best(simplices.coordinates(),
    simplices.coordinates() + VertexStride * static_cast<std::size_t>(simplices.freeVertices()));
  // One objective in closed form needs neither the mesh's own points on the way nor a way back:
  // each step reduces it.
  const bool simple = problem.isSimple();
  StopReason reason = StopReason::NoProgress;
  double firstGradient = 0;
  bool all = true;           // whether the next sweep visits every vertex
  SweepGains gains(!simple); // hexahedra have no closed form
  for (int iteration = result.history.back().iteration + 1;; ++iteration)
  {
    if (watch.ends(result.history, reason))
    {
      return reason;
    }
    const IterationRecord& before = result.history.back();
    std::vector<double> values = before.objectives;
    const SweepResult sweep = sweeper.sweep(problem.scalarizer(), values);
    if (!simple)
    {
      problem.store();
    }
    IterationRecord now = problem.record(iteration);
    now.gradientNorm = sweep.gradientNorm;
    now.moving = sweep.moved;
    const double lowered = scalarized(problem.scalarizer(), before) - now.objective;
    const double size = std::abs(now.objective);
    if (!simple && !(std::isfinite(size) && lowered >= -roundingOfSums * size))
    {
      // Blocks of one colour do not use each other's changes of a composite objective, which may
      // rise or leave its domain, as a product with a factor below 0.
      std::copy(best.begin(), best.end(), simplices.coordinates());
      problem.store();
      failed = true;
      return StopReason::NoProgress;
    }
    if (!simple)
    {
      std::copy_n(simplices.coordinates(), best.size(), best.begin());
    }
    firstGradient = firstGradient > 0 ? firstGradient : sweep.gradientNorm;
    if (!report(problem, watch, result, now))
    {
      return StopReason::Aborted;
    }
    if (problem.someRepaired() && !watch.ends(result.history, reason))
    {
      repaired = true;
      return StopReason::NoProgress;
    }

    gains.add(lowered);
    // On a surface each sweep moves the points a little off the input: no more of them than needed.
    const double remaining = problem.surface() ? lowered : gains.remaining();
    if (slow && (gains.stiff(size) || gains.slow(size, stop.relativeChange)))
    {
      *slow = gains.stiff(size) ? Slowness::Far : Slowness::Near;
      return StopReason::NoProgress;
    }

    // Convergence is only believed of a sweep over all vertices.
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
    else if (problem.scalarizer().next(result.history.back().objectives))
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
StopReason optimizeGlobally(
  OptimizationProblem& problem, const StoppingTest& watch, Optimizer method, OptimizeResult& result)
{
  const StoppingCriteria& stop = problem.options().stopping;
  StopReason reason = StopReason::NoProgress;
  if (watch.ends(result.history, reason))
  {
    return reason;
  }
  const bool alone = isGlobal(problem.options().optimizer);
  GlobalFunction function(problem, method);
  std::vector<double> x(function.size(), 0.0);
  for (;;)
  {
    const int before = result.history.back().iteration;
    MinimizeOptions options = minimizeOptions(stop, method, alone);
    options.maximumIterations -= before;
    options.outOfTime = [&] { return problem.outOfTime(); };
    options.threads = problem.options().threads;
    bool ended = false;
    options.observer = [&](int iteration, double, double gradientNorm, const double* now)
    {
      if (iteration == 0)
      {
        return true;
      }
      function.put(now);
      IterationRecord record = problem.record(before + iteration);
      record.gradientNorm = gradientNorm;
      if (!report(problem, watch, result, record))
      {
        reason = StopReason::Aborted;
        ended = true;
      }
      else
      {
        ended = watch.ends(result.history, reason);
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

std::vector<signed char> validityOf(const Mesh& mesh, int threads)
{
  std::vector<signed char> validity(mesh.view().numberOfCells);
  mesh.classifyCells(validity.data(), threads);
  return validity;
}

Index countInvalid(const std::vector<signed char>& validity)
{
  return std::count_if(validity.begin(), validity.end(), isInvalid);
}

//------------------------------------------------------------------------------
/// The steps of a stage on one process.
class StepsOfProblem : public OptimizationSteps
{
public:
  StepsOfProblem(OptimizationProblem& problem, const StoppingTest& watch, OptimizeResult& result)
    : Problem(problem)
    , Watch(watch)
    , Result(result)
  {
  }

  StopReason sweep(Slowness* slow, bool& failed, bool& repaired) override
  {
    return optimizeLocally(this->Problem, this->Watch, this->Result, failed, repaired, slow);
  }

  StopReason minimizeAll(Optimizer method) override
  {
    const auto minimize = [&]
    { return optimizeGlobally(this->Problem, this->Watch, method, this->Result); };
    return method == Optimizer::NewtonConjugateGradient ? this->inMemory(minimize) : minimize();
  }

  bool hasManyCorners() const override
  {
    const Mesh& mesh = this->Problem.moving();
    const int dimension = mesh.dimension() == Dimension::Volume ? 3 : 2;
    Index simplices = 0, others = 0;
    for (const CellBlock& block : mesh.blocks())
    {
      const CellTopology& t = topology(block.type);
      (t.samples > 1 ? others : simplices) += t.dimension == dimension ? block.count : 0;
    }
    return static_cast<double>(others) > manyCorners * static_cast<double>(simplices);
  }

  bool hasConvexPart() override { return HessianMatrix::hasConvexPart(this->Problem.sum(0)); }
  bool hasConstraintsOrTargets() const override
  {
    const OptimizeOptions& options = this->Problem.options();
    return options.slidePlanes || options.slideLines || options.limits ||
      options.objectives[0].evaluation.targets ||
      this->Problem.moving().dimension() == Dimension::Surface;
  }
  bool slidesOnSurface() const override
  {
    const OptimizeOptions& options = this->Problem.options();
    return this->Problem.moving().dimension() != Dimension::Surface &&
      (options.model || options.slideSurface);
  }
  bool holdsPoints() override
  {
    const std::vector<unsigned char>& held = this->Problem.slides().held;
    return this->Problem.someAtLimit() ||
      std::any_of(held.begin(), held.end(), [](unsigned char h) { return h != 0; });
  }
  bool outOfTime() const override { return this->Problem.outOfTime(); }

  const std::vector<double>& stored() const override { return this->Result.points; }
  void store() override { this->Problem.store(); }
  void restart(const std::vector<double>& points) override { this->Problem.restart(points); }
  bool findHarmonicPoints(std::vector<double>& points) override
  {
    points = this->inMemory([&] { return harmonicPoints(this->Problem, points); });
    return !points.empty();
  }
  void shiftPoints(double part, std::vector<double>& points) override
  {
    const SimplexMesh& simplices = this->Problem.simplices();
    std::vector<unsigned char> free(points.size() / 3, 0);
    for (std::int32_t v = 0; v < simplices.freeVertices(); ++v)
    {
      free[simplices.point(v)] = 1;
    }
    shiftFreePoints(this->Problem.moving(), free, nullptr, part, points);
  }
  IterationRecord record(int iteration) override { return this->Problem.record(iteration); }

private:
  /// What work() returns. @throws MemoryError if it does not fit, so that the sweeps go on, unless
  /// the user has chosen a global optimizer
  template <class Work>
  std::invoke_result_t<Work> inMemory(const Work& work) const
  {
    try
    {
      return work();
    }
    catch (const std::bad_alloc&)
    {
      if (isGlobal(this->Problem.options().optimizer))
      {
        throw;
      }
      throw MemoryError("The matrix does not fit into memory.");
    }
  }

  OptimizationProblem& Problem;
  const StoppingTest& Watch;
  OptimizeResult& Result; ///< whose points are those of the problem
};

/// Lets points leave the surface, see leaveSurface(), unless the result is worse than the input,
/// which is better already where they are.
void leaveNearWorst(const Mesh& mesh, OptimizationProblem& problem, const StoppingTest& watch,
  const IterationRecord& first, const QualityGuard& guard, const WorstLimits& limits,
  const Stopwatch& clock, OptimizeResult& result, LeavingResult& left)
{
  problem.store();
  const std::vector<double> slid = problem.points();
  left = leaveSurface(mesh, problem, guard, limits, clock,
    [&](OptimizationProblem& now, IterationRecord record)
    {
      record.iteration = result.history.back().iteration + 1;
      if (problem.objectives() > 1)
      {
        record.objective = problem.scalarizer().value(record.objectives);
      }
      return report(now, watch, result, record);
    });
  const bool larger = guard.holdsObjective() &&
    isLarger(problem.options().scalarization, problem.scalarizer(), problem.record(0), first);
  if (larger || guard.violated(problem))
  {
    problem.restart(slid);
    left.points.clear();
    IterationRecord record = problem.record(result.history.back().iteration + 1);
    report(problem, watch, result, record);
  }
}

/// Improves the worst element as far as wanted, and at least to that of the input. Stores the
/// points and measures the elements there.
QualityGuard::State settleWorst(const Mesh& mesh, OptimizationProblem& problem,
  const StoppingTest& watch, const IterationRecord& first, const QualityGuard& guard,
  const Stopwatch& clock, OptimizeResult& result)
{
  // The metrics of the mean and of the worst element disagree on stretched hexahedra.
  constexpr double ofAnotherMetric = 5;
  const OptimizeOptions& options = problem.options();
  const bool same = worstMetric(problem.moving(), options) == options.objectives[0].metric;
  const double allowance = options.improveWorst * (same ? 1.0 : ofAnotherMetric);
  const bool going = result.reason != StopReason::Aborted && result.reason != StopReason::TimeLimit;
  const bool wanted = going && allowance > 0;
  if (!wanted)
  {
    QualityGuard::State state = guard.check(problem);
    if (!state.violated)
    {
      return state;
    }
  }
  LeavingResult left;
  if (going)
  {
    problem.store();
    const bool leaves = wanted && options.leaving && options.surfaceTolerance > 0;
    WorstLimits limits{ allowance, !wanted };
    if (leaves)
    {
      limits.mean = problem.record(0).mean[0];
    }
    bool stopped = false;
    bool outOfTime = improveWorst(problem, guard, limits,
      [&](IterationRecord record)
      {
        record.iteration = result.history.back().iteration + 1;
        stopped = !report(problem, watch, result, record);
        return !stopped;
      });
    if (leaves && !stopped && !outOfTime)
    {
      leaveNearWorst(mesh, problem, watch, first, guard, limits, clock, result, left);
      stopped = left.stopped;
      outOfTime = left.outOfTime;
    }
    result.reason = stopped ? StopReason::Aborted
      : outOfTime           ? StopReason::TimeLimit
                            : result.reason;
  }
  QualityGuard::State state = guard.check(problem);
  if (state.violated)
  {
    result.restored = guard.restore(problem);
    IterationRecord record = problem.record(result.history.back().iteration + 1);
    report(problem, watch, result, record);
    state = guard.check(problem);
  }
  result.leftSurface = left.count(problem.points());
  return state;
}

/**
 * @brief Goes back to the input if the result, computed anew from its points, has an invalid
 * element, a worse worst element or a larger objective, or if points that were put back have taken
 * the surface farther than the tolerance.
 * @param state of the elements at the stored points, which become those of the result
 */
void verify(const Mesh& mesh, OptimizationProblem& problem, const IterationRecord& first,
  const QualityGuard& guard, QualityGuard::State& state, OptimizeResult& result)
{
  const auto isLargerThere = [&](const IterationRecord& now)
  { return isLarger(problem.options().scalarization, problem.scalarizer(), now, first); };
  bool larger = guard.holdsObjective();
  const auto cells = static_cast<std::size_t>(mesh.view().numberOfCells);
  if (larger && state.values.size() == cells && problem.isSumOfSquaresOf(guard.judged()))
  {
    // The values of all elements are there, measured on the points.
    IterationRecord now = first;
    now.objective = sumOfSquares(state.values, problem.options().threads);
    larger = isLargerThere(now);
  }
  if (larger)
  {
    problem.restart(std::vector<double>(result.points));
    larger = isLargerThere(problem.record(0));
  }
  // Points put back are between others that have moved on.
  const bool far = result.restored > 0 && !problem.isWithinTolerance();
  if (larger || state.violated || far)
  {
    const double* start = mesh.view().points;
    problem.restart(std::vector<double>(start, start + result.points.size()));
    IterationRecord record = problem.record(result.history.back().iteration);
    record.objective = first.objective;
    result.history.back() = record;
    if (result.reason != StopReason::Aborted && result.reason != StopReason::TimeLimit)
    {
      result.reason = StopReason::NoProgress;
    }
    result.unchanged = true;
    result.restored = result.leftSurface = 0;
    problem.moving().classifyCells(state.validity.data(), problem.options().threads);
    state.values = guard.values();
  }
}

/**
 * @brief After verify() has gone back to the input: where the objective had been reduced by more
 * than the criterion of convergence, sweeps from the input on, each of which keeps the worst
 * element. Points that slide cannot go far back one by one: those between them would be squeezed.
 * Otherwise the input has converged, and the reason is the one it `ended` for.
 */
void holdWorst(const Mesh& mesh, OptimizationProblem& problem, const IterationRecord& first,
  const QualityGuard& guard, const StoppingTest& watch, StopReason ended,
  QualityGuard::State& state, OptimizeResult& result)
{
  if (ended == StopReason::Aborted || ended == StopReason::TimeLimit)
  {
    return;
  }
  double least = first.objective;
  for (const IterationRecord& record : result.history)
  {
    least = record.iteration > first.iteration ? std::min(least, record.objective) : least;
  }
  const double size = std::abs(first.objective);
  if (first.objective - least <= problem.options().stopping.relativeChange * size)
  {
    result.reason = ended;
    return;
  }
  result.unchanged = false;
  result.reason = sweepHoldingWorst(
    problem, guard, watch,
    [&](const IterationRecord& record) { return report(problem, watch, result, record); },
    result.history);
  state = guard.check(problem);
  verify(mesh, problem, first, guard, state, result);
  result.unchanged = std::equal(result.points.begin(), result.points.end(), mesh.view().points);
}

/// Optimizes from result.points on; returns whether there is more to do, with elements that have
/// become valid.
bool optimizeStage(const Mesh& mesh, const OptimizeOptions& options, const QualityGuard& guard,
  const Stopwatch& clock, OptimizeResult& result)
{
  OptimizationProblem problem(mesh, options, result.points, clock);
  result.freeVertices = problem.simplices().freeVertices();
  const StoppingTest watch(options, [&problem] { return problem.outOfTime(); });
  const bool again = !result.history.empty();
  IterationRecord first = problem.firstRecord(again ? result.history.back().iteration : 0);
  if (!again)
  {
    requireValues(options.objectives, first.objectives);
  }
  problem.start(first);
  first.objective =
    problem.objectives() > 1 ? problem.scalarizer().value(first.objectives) : first.objectives[0];
  if (again)
  {
    result.history.back().objective = first.objective;
    result.history.back().objectives = first.objectives;
  }
  else if (!report(problem, watch, result, first))
  {
    result.reason = StopReason::Aborted;
    return false;
  }
  if (result.freeVertices == 0)
  {
    result.reason = StopReason::NoFreeVertices;
    return false;
  }
  StepsOfProblem steps(problem, watch, result);
  // Elements that are valid keep points that slide in the part of the surface that they are on.
  const bool mayCross =
    steps.slidesOnSurface() && (first.inverted > 0 || mesh.nonFinitePoints() > 0);
  const bool onlyLocal =
    mayCross || (mesh.dimension() == Dimension::Surface && !keepsSurface(problem));
  const bool repaired = movePoints(steps, options, onlyLocal, first, result.history, result.reason);
  QualityGuard::State state;
  if (repaired)
  {
    problem.store();
    state.validity = validityOf(problem.moving(), options.threads);
  }
  else
  {
    state = settleWorst(mesh, problem, watch, first, guard, clock, result);
    const StopReason ended = result.reason;
    verify(mesh, problem, first, guard, state, result);
    if (result.unchanged && steps.slidesOnSurface())
    {
      holdWorst(mesh, problem, first, guard, watch, ended, state, result);
    }
  }
  result.iterations = result.history.back().iteration;
  result.invertedAfter = countInvalid(state.validity);
  result.elements.validity = std::move(state.validity);
  result.elements.after = std::move(state.values);
  result.surfaceError = problem.surfaceError();
  result.heldOnSurface = problem.heldOnSurface();
  result.heldOnInterfaces = problem.heldOnInterfaces();
  return repaired;
}

//------------------------------------------------------------------------------
/// Runs untangle() with the time that is left; false if the observer stopped it.
bool untangleFirst(
  const Mesh& mesh, const OptimizeOptions& options, const Stopwatch& clock, OptimizeResult& result)
{
  std::vector<unsigned char> held = heldInUntangling(options, mesh.view().numberOfPoints);
  if (!options.fixed && !held.empty())
  {
    const std::vector<char> boundary = boundaryPoints(mesh);
    std::transform(held.begin(), held.end(), boundary.begin(), held.begin(),
      [](unsigned char h, char b) { return static_cast<unsigned char>(h || b); });
  }
  bool proceed = true;
  const UntangleOptions untangling = untanglingFirst(options, held, clock, proceed);
  UntangleResult untangled = untangle(mesh, untangling);
  result.points = std::move(untangled.points);
  result.invertedAfter = untangled.invertedAfter;
  result.untangled = true;
  result.newlyInvalid = untangled.newlyInvalid;
  if (proceed)
  {
    requireWithinLimits(
      beyondLimits(options, mesh.view().points, result.points, [](Index) { return true; }));
  }
  return proceed;
}
}

//------------------------------------------------------------------------------
void OptimizeResult::keepStart(std::vector<double> start, Index inverted)
{
  this->points = std::move(start);
  this->elements = {};
  this->invertedAfter = inverted;
  this->unchanged = true;
  this->restored = this->leftSurface = this->heldOnSurface = this->heldOnInterfaces = 0;
  this->surfaceError = 0;
  if (!this->history.empty())
  {
    IterationRecord last = this->history.front();
    last.iteration = this->history.back().iteration;
    last.seconds = this->history.back().seconds;
    last.inverted = inverted;
    this->history.back() = last;
  }
  if (this->reason != StopReason::Aborted && this->reason != StopReason::TimeLimit)
  {
    this->reason = StopReason::NoProgress;
  }
}

//------------------------------------------------------------------------------
OptimizeResult optimize(
  const Mesh& mesh, const OptimizeOptions& options, const std::vector<signed char>& known)
{
  const Stopwatch clock;
  OptimizeResult result;
  const MeshView& view = mesh.view();
  result.points.assign(view.points, view.points + 3 * view.numberOfPoints);
  if (mesh.dimension() == Dimension::None)
  {
    result.reason = StopReason::NoFreeVertices;
    return result;
  }
  requireOrdinaryScale(view, "Optimization");
  checkOptions(mesh, options);
  const std::vector<signed char> validity =
    known.empty() ? validityOf(mesh, options.threads) : known;
  result.invertedBefore = result.invertedAfter = countInvalid(validity);
  const bool repairs =
    std::any_of(options.objectives.begin(), options.objectives.end(), canUntangle);
  if (result.invertedBefore > 0 && !repairs && mesh.dimension() != Dimension::Surface)
  {
    if (!options.untangleFirst)
    {
      throw Error(std::to_string(result.invertedBefore) +
        " elements are inverted or degenerate, and no objective repairs them: untangle first, or "
        "add the untangling metric.");
    }
    if (!untangleFirst(mesh, options, clock, result))
    {
      result.reason = StopReason::Aborted;
      return result;
    }
  }

  QualityGuard guard(mesh, validity, options);
  // Elements left out join the objective as soon as they are valid: another stage.
  const Index invalid = result.invertedAfter;
  const std::vector<double> untangled = result.untangled ? result.points : std::vector<double>();
  while (optimizeStage(mesh, options, guard, clock, result))
  {
  }
  // Verified on the points themselves: the optimizers measure simplices, in units of the mean edge,
  // where others may vanish.
  if (result.invertedAfter > invalid && !options.allowInversion &&
    mesh.dimension() != Dimension::Surface)
  {
    // Coordinates of too different magnitudes.
    result.keepStart(result.untangled
        ? untangled
        : std::vector<double>(view.points, view.points + 3 * view.numberOfPoints),
      invalid);
  }
  if (guard.judged().metric == options.objectives[0].metric && !result.elements.after.empty())
  {
    result.elements.before = guard.takeValues();
  }
  else
  {
    result.elements.after.clear();
  }
  asMeasured(result.elements.before);
  asMeasured(result.elements.after);
  return result;
}
}
