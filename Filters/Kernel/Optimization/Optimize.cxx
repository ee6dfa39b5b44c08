// SPDX-License-Identifier: BSD-3-Clause
#include "Optimize.h"

#include "AutomaticMethod.h"
#include "HoldingSweeps.h"
#include "ImproveWorst.h"
#include "LeaveSurface.h"
#include "OptionChecks.h"
#include "QualityGuard.h"
#include "SlideWorst.h"
#include "SurfaceSlides.h"
#include "tautline/Mesh/CoordinateFrame.h"
#include "tautline/Quality/JudgedValues.h"
#include "tautline/Untangling/Untangle.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace tautline
{
namespace
{
/// Restores points if a later step has made the objective larger than at the start, or an element
/// worse than the worst one.
bool goesBack(OptimizationSteps& steps, const IterationRecord& first, const QualityGuard& guard,
  const std::vector<double>& points)
{
  OptimizationProblem& problem = steps.problem();
  const bool larger = guard.holdsObjective() &&
    isLarger(problem.options().scalarization, problem.scalarizer(), problem.record(0), first);
  const bool back = larger || guard.violated(problem);
  if (back)
  {
    problem.restart(points);
    steps.report(problem.record(steps.next()));
  }
  return back;
}

/// Lets points leave the surface, see leaveSurface(), unless the result is worse than the input,
/// which is then restored.
void leaveNearWorst(const Mesh& mesh, OptimizationSteps& steps, const IterationRecord& first,
  const QualityGuard& guard, const WorstLimits& limits, const Stopwatch& clock, bool worstFirst,
  LeavingResult& left)
{
  OptimizationProblem& problem = steps.problem();
  problem.store();
  const std::vector<double> slid = problem.points();
  left = leaveSurface(mesh, problem, guard, limits, clock,
    [&](OptimizationProblem& now, IterationRecord record)
    {
      record.iteration = steps.next();
      if (problem.objectives() > 1)
      {
        record.objective = problem.scalarizer().value(record.objectives);
      }
      return steps.report(now, record);
    });
  if (!worstFirst && goesBack(steps, first, guard, slid))
  {
    left.points.clear();
  }
}

/// The change of the worst element between two values, as a fraction of the distance to the ideal.
double wayToIdeal(OptimizationProblem& problem, const Objective& judged, double from, double to)
{
  const int dimension = problem.moving().dimension() == Dimension::Planar ? 2 : 3;
  const double ideal = metricInfo(judged.metric).ideal(dimension);
  return std::abs(from - ideal) > 0 ? 1 - std::abs(to - ideal) / std::abs(from - ideal) : 0.0;
}

/**
 * @brief Improves the worst element by moving all points together from the start of the
 * optimization, then reduces the objective with sweeps that preserve this improvement. This cannot
 * start from the result of sweeps alone, because they skew stretched cells.
 * @param start points at which all elements are valid
 * @param limits contain the allowance of the mean; if the result is used, the rest of the allowance
 * is relative to it
 * @return whether the result is used; otherwise the previous points are kept, which are better, or
 * equally good at lower cost
 */
bool raiseWorst(const Mesh& mesh, OptimizationSteps& steps, const IterationRecord& first,
  const QualityGuard& guard, const std::vector<double>& start, WorstLimits& limits,
  const StoppingTest& watch, const std::function<bool(const IterationRecord&)>& report,
  bool& outOfTime)
{
  OptimizationProblem& problem = steps.problem();
  problem.store();
  const std::vector<double> swept = problem.points();
  const auto worst = [&]
  { return problem.worstMovable(guard.judged(), problem.measure(guard.judged())); };
  const double before = worst();
  problem.restart(std::vector<double>(start));
  const double atStart = worst();
  constexpr double anyMean = std::numeric_limits<double>::max();
  outOfTime = slideWorst(mesh, problem, guard, { anyMean }, report);
  problem.store();
  const std::vector<double> raised = problem.points();
  const double after = worst();
  const auto way = [&](double from) { return wayToIdeal(problem, guard.judged(), from, after); };
  // If the result is about as good as the sweeps' result, moving single points improves it further
  // at lower cost to the mean.
  constexpr double littleWay = 0.02, littleGain = 0.02; // gain relative to all sweeps
  bool better = way(before) > littleWay;
  if (better)
  {
    const Mesh there = mesh.at(raised.data());
    const QualityGuard held(there, problem.options());
    std::vector<IterationRecord> history = { problem.record(steps.next()) };
    history.front().objective = scalarized(problem.scalarizer(), history.front());
    const double atFirst = history.front().objective;
    sweepHoldingWorst(
      problem, held, watch,
      [&](const IterationRecord& record)
      {
        const double gain = history.back().objective - record.objective;
        history.push_back(record);
        return report(record) && gain > littleGain * (atFirst - record.objective);
      },
      history);
    const Metric metric = problem.options().objectives[0].metric;
    const double sign = metricInfo(metric).direction == Direction::LargerIsBetter ? -1 : 1;
    const double bound = first.mean[0] +
      sign * (limits.allowance + std::max(way(atStart), 0.0)) * std::abs(first.mean[0]);
    const double mean = problem.record(0).mean[0];
    better = sign * (mean - bound) <= 0;
    if (better)
    {
      limits = { mean != 0 ? sign * (bound - mean) / std::abs(mean) : 0.0, false, mean };
    }
  }
  if (!better)
  {
    problem.restart(swept);
    steps.report(problem.record(steps.next()));
  }
  return better;
}

/// Improves the worst element as requested, and at least to the worst of the input. Stores the
/// points and measures the elements there.
QualityGuard::State settleWorst(const Mesh& mesh, OptimizationSteps& steps,
  const IterationRecord& first, const QualityGuard& guard, const std::vector<double>& start,
  const StoppingTest& watch, const Stopwatch& clock, OptimizeResult& result)
{
  OptimizationProblem& problem = steps.problem();
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
    if (wanted)
    {
      limits.mean = problem.record(0).mean[0]; // shared by several successive methods
    }
    bool stopped = false;
    const auto report = [&](IterationRecord record)
    {
      record.iteration = steps.next();
      stopped = !steps.report(record);
      return !stopped;
    };
    // If moving points of cells with several corners one by one stalls, moving all of them together
    // may continue; points on a model then leave it slightly.
    const bool mayLeave = !options.model || options.leaving || options.onGeometry;
    const bool together = wanted && mayLeave && steps.hasManyCorners() && first.inverted == 0 &&
      canSlideWorst(problem, guard.judged());
    bool outOfTime = false;
    result.worstFirst =
      together && raiseWorst(mesh, steps, first, guard, start, limits, watch, report, outOfTime);
    const bool sweeps = !needDifferences(options);
    const auto proceeds = [&] { return sweeps && !result.worstFirst && !stopped && !outOfTime; };
    if (proceeds())
    {
      outOfTime = improveWorst(problem, guard, limits, report);
    }
    if (leaves && !stopped && !outOfTime)
    {
      leaveNearWorst(mesh, steps, first, guard, limits, clock, result.worstFirst, left);
      stopped = left.stopped;
      outOfTime = left.outOfTime;
    }
    if (together && proceeds())
    {
      problem.store();
      const std::vector<double> slid = problem.points();
      outOfTime = slideWorst(mesh, problem, guard, limits, report);
      goesBack(steps, first, guard, slid);
    }
    result.reason = stopped ? StopReason::Aborted
      : outOfTime           ? StopReason::TimeLimit
                            : result.reason;
  }
  QualityGuard::State state = guard.check(problem);
  if (state.violated)
  {
    result.restored = guard.restore(problem);
    steps.report(problem.record(steps.next()));
    state = guard.check(problem);
  }
  result.leftSurface = left.count(problem.points());
  return state;
}

/**
 * @brief Restores the input if the result, evaluated again at its points, has an invalid element, a
 * worse worst element or a larger objective, or if restored points have moved the surface beyond
 * the tolerance.
 * @param state of the elements at the stored points, which become the points of the result
 */
void verify(const Mesh& mesh, OptimizationProblem& problem, const IterationRecord& first,
  const QualityGuard& guard, QualityGuard::State& state, OptimizeResult& result)
{
  const auto isLargerThere = [&](const IterationRecord& now)
  { return isLarger(problem.options().scalarization, problem.scalarizer(), now, first); };
  bool larger = guard.holdsObjective() && !result.worstFirst;
  const auto cells = static_cast<std::size_t>(mesh.view().numberOfCells);
  if (larger && state.values.size() == cells && problem.isSumOfSquaresOf(guard.judged()))
  {
    // The values of all elements at the points are available.
    IterationRecord now = first;
    now.objective = sumOfSquares(state.values, problem.options().threads);
    larger = isLargerThere(now);
  }
  if (larger)
  {
    problem.restart(std::vector<double>(result.points));
    larger = isLargerThere(problem.record(0));
  }
  // Restored points lie between others that have moved.
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
    result.worstFirst = false;
    result.restored = result.leftSurface = 0;
    problem.moving().classifyCells(state.validity.data(), problem.options().threads);
    state.values = guard.values();
  }
}

/**
 * @brief After verify() has restored the input: if the objective had been reduced by more than the
 * convergence criterion, sweeps from the input, preserving the worst element in each sweep. Sliding
 * points cannot be moved far back one by one: the points between them would be squeezed. Otherwise
 * the input has converged, and the reason is `ended`.
 */
void holdWorst(const Mesh& mesh, OptimizationSteps& steps, const IterationRecord& first,
  const QualityGuard& guard, const StoppingTest& watch, StopReason ended,
  QualityGuard::State& state, OptimizeResult& result)
{
  OptimizationProblem& problem = steps.problem();
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
    problem, guard, watch, [&](const IterationRecord& record) { return steps.report(record); },
    result.history);
  state = guard.check(problem);
  verify(mesh, problem, first, guard, state, result);
  result.unchanged = std::equal(result.points.begin(), result.points.end(), mesh.view().points);
}

/// Optimizes starting from result.points; returns whether to continue with elements that have
/// become valid.
bool optimizeStage(const Mesh& mesh, const OptimizeOptions& options, const QualityGuard& guard,
  const Stopwatch& clock, const Ranks& ranks, OptimizeResult& result)
{
  const std::vector<double> start = result.points;
  OptimizationProblem problem(mesh, options, result.points, clock, ranks);
  result.freeVertices = problem.freePoints();
  const StoppingTest watch(options, [&problem] { return problem.outOfTime(); });
  OptimizationSteps steps(problem, watch, result.history);
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
  else if (!steps.report(first))
  {
    result.reason = StopReason::Aborted;
    return false;
  }
  if (result.freeVertices == 0)
  {
    result.reason = StopReason::NoFreeVertices;
    return false;
  }
  // Valid elements keep sliding points in their part of the surface.
  const bool mayCross =
    steps.slidesOnSurface() && (first.inverted > 0 || mesh.nonFinitePoints() > 0);
  const bool onlyLocal =
    mayCross || (mesh.dimension() == Dimension::Surface && !keepsSurface(problem));
  const bool repaired = movePoints(steps, options, onlyLocal, first, result.history, result.reason);
  QualityGuard::State state;
  if (repaired)
  {
    problem.store();
    state.validity = cellValidity(problem.moving(), options.threads);
  }
  else
  {
    state = settleWorst(mesh, steps, first, guard, start, watch, clock, result);
    const StopReason ended = result.reason;
    verify(mesh, problem, first, guard, state, result);
    if (result.unchanged && steps.slidesOnSurface())
    {
      holdWorst(mesh, steps, first, guard, watch, ended, state, result);
    }
  }
  result.iterations = result.history.back().iteration;
  result.invertedAfter = ranks.countInvalid(problem.moving(), state.validity);
  result.elements.validity = std::move(state.validity);
  result.elements.after = std::move(state.values);
  result.surfaceError = problem.surfaceError();
  result.heldOnSurface = problem.heldOnSurface();
  result.heldOnInterfaces = problem.heldOnInterfaces();
  return repaired;
}

//------------------------------------------------------------------------------
/// Runs untangle() with the remaining time; false if the observer stopped it, on any rank.
bool untangleFirst(const Mesh& mesh, const OptimizeOptions& options, const Stopwatch& clock,
  const Ranks& ranks, OptimizeResult& result)
{
  const bool slides = slidesInUntangling(mesh, options, ranks);
  std::vector<unsigned char> held = heldInUntangling(options, mesh.view().numberOfPoints, slides);
  if (!options.fixed && slides)
  {
    held.clear(); // the boundary, without sliding points
  }
  else if (!options.fixed && !held.empty())
  {
    const std::vector<unsigned char> boundary = ranks.boundary(mesh);
    std::transform(held.begin(), held.end(), boundary.begin(), held.begin(), std::bit_or<>());
  }
  bool proceed = true;
  const UntangleOptions untangling = untanglingFirst(options, held, slides, clock, proceed);
  UntangleResult untangled = untangle(mesh, untangling, ranks);
  result.points = std::move(untangled.points);
  result.invertedAfter = untangled.invertedAfter;
  result.untangled = true;
  result.newlyInvalid = untangled.newlyInvalid;
  if (ranks.any(!proceed))
  {
    return false;
  }
  requireWithinLimits(options, mesh.view().points, result.points, ranks);
  return true;
}

/// Throws Error if the parts of a mesh on several ranks do not have one dimension or, if planar,
/// one plane perpendicular to an axis.
void requireDivisible(const Mesh& mesh, const Ranks& ranks)
{
  const Dimension whole = ranks.dimension(mesh);
  const bool differ = ranks.any(mesh.dimension() != whole);
  const auto& box = ranks.mesh().bounds();
  const bool planar = whole == Dimension::Planar && !differ &&
    (box[0] == box[3] || box[1] == box[4] || box[2] == box[5]);
  if (whole != Dimension::None && !(whole == Dimension::Volume && !differ) && !planar)
  {
    throw Error("A mesh on several processes, or in the reproducible order, must be a volume "
                "mesh or lie in a plane perpendicular to an axis, but this one does not: "
                "gather it on one process (in ParaView, with Aggregate Dataset) and turn "
                "Reproducible Order off.");
  }
}

/// The options for a mesh on several ranks, with the directions and point flags of the owners.
struct AgreedOptions
{
  AgreedOptions(const OptimizeOptions& given, Index points, const Ranks& ranks)
    : options(given)
  {
    if (!given.fixed && points > 0)
    {
      throw Error("The fixed points of a mesh on several ranks must be given, see rankBoundary().");
    }
    this->fixed.assign(given.fixed, given.fixed + points);
    this->fixed.reserve(1); // avoid a null pointer, which means the boundary
    ranks.exchange(this->fixed.data());
    this->options.fixed = this->fixed.data();
    agreeOn(this->options.slidePlanes, this->planes, points, ranks);
    agreeOn(this->options.slideLines, this->lines, points, ranks);
  }

  OptimizeOptions options;
  std::vector<unsigned char> fixed;
  std::vector<double> planes, lines;

private:
  static void agreeOn(
    const double*& given, std::vector<double>& directions, Index points, const Ranks& ranks)
  {
    if (ranks.any(given != nullptr))
    {
      directions.assign(3 * points, 0.0);
      std::copy_n(given, given ? directions.size() : 0, directions.begin());
      ranks.exchange(directions.data(), 3);
      directions.reserve(1);
      given = directions.data();
    }
  }
};
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
namespace
{
/// Flags the points of elements without a normal on a surface in space; counts these elements.
Index flagWithoutNormal(
  const Mesh& mesh, const std::vector<signed char>& validity, std::vector<unsigned char>& flags)
{
  const MeshView& view = mesh.view();
  Index count = 0;
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; i < block.count; ++i)
    {
      const Index cell = block.cell(i);
      if (validity[cell] != Degenerate)
      {
        continue;
      }
      const Index* node = view.connectivity + view.offsets[cell];
      Vec3 p[MaxNodes];
      double length2 = 0;
      for (int k = 0; k < t.nodes; ++k)
      {
        p[k] = pointOf(view, node[k]);
        length2 = std::max(length2, dot(p[k] - p[0], p[k] - p[0]));
      }
      if (t.nodes == 3 || norm(vectorArea(t, p)) <= Mesh::degenerateTolerance() * length2)
      {
        ++count;
        std::for_each(node, node + t.nodes, [&flags](Index point) { flags[point] = 1; });
      }
    }
  }
  return count;
}

OptimizeResult run(const Mesh& mesh, const OptimizeOptions& given,
  const std::vector<signed char>& known, const Ranks& ranks)
{
  const Stopwatch clock;
  OptimizeOptions options = given;
  OptimizeResult result;
  const MeshView& view = mesh.view();
  result.points.assign(view.points, view.points + 3 * view.numberOfPoints);
  if (mesh.dimension() == Dimension::None)
  {
    result.reason = StopReason::NoFreeVertices;
    return result;
  }
  requireOrdinaryScale(view, "Optimization");
  checkOptions(mesh, options, ranks);
  const std::vector<signed char> validity =
    known.empty() ? cellValidity(mesh, options.threads) : known;
  result.invertedBefore = result.invertedAfter = ranks.countInvalid(mesh, validity);
  std::vector<unsigned char> held;
  if (mesh.dimension() == Dimension::Surface && result.invertedBefore > 0)
  {
    held.assign(view.numberOfPoints, 0);
    result.withoutNormal = flagWithoutNormal(mesh, validity, held);
    const std::vector<unsigned char> fixed = options.fixed
      ? std::vector<unsigned char>(options.fixed, options.fixed + view.numberOfPoints)
      : ranks.boundary(mesh);
    std::transform(held.begin(), held.end(), fixed.begin(), held.begin(), std::bit_or<>());
    options.fixed = held.data();
  }
  const bool repairs =
    std::any_of(options.objectives.begin(), options.objectives.end(), canUntangle);
  if (result.invertedBefore > 0 && !repairs && mesh.dimension() != Dimension::Surface)
  {
    if (!options.untangleFirst)
    {
      throw Error(std::to_string(result.invertedBefore) +
        " elements are inverted or degenerate, and no objective repairs them: untangle the "
        "mesh first, or add the untangling metric.");
    }
    if (!untangleFirst(mesh, options, clock, ranks, result))
    {
      result.reason = StopReason::Aborted;
      return result;
    }
  }

  QualityGuard guard(mesh, validity, options, ranks);
  // Excluded elements join the objective as soon as they are valid: start another stage.
  const Index invalid = result.invertedAfter;
  const std::vector<double> untangled = result.untangled ? result.points : std::vector<double>();
  while (optimizeStage(mesh, options, guard, clock, ranks, result))
  {
  }
  // Verify with the actual points: the optimizers measure simplices in units of the mean edge, in
  // which small elements may vanish.
  if (result.invertedAfter > invalid && !options.allowInversion &&
    mesh.dimension() != Dimension::Surface)
  {
    // The magnitudes of the coordinates differ too much.
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

//------------------------------------------------------------------------------
OptimizeResult optimize(const Mesh& mesh, const OptimizeOptions& options,
  const std::vector<signed char>& validity, const Ranks& ranks)
{
  if (!ranks.several())
  {
    return run(mesh, options, validity, ranks);
  }
  OptimizeResult result;
  ranks.together(
    [&]
    {
      requireLocalOptions(options);
      const AgreedOptions agreed(options, mesh.view().numberOfPoints, ranks);
      Mesh local = mesh;
      const MeshSpace space = ranks.space(mesh);
      if (mesh.view().numberOfCells == 0)
      {
        local.setSpace(space);
      }
      requireDivisible(local, ranks);
      result = run(local, agreed.options, validity, ranks);
    });
  return result;
}
}
