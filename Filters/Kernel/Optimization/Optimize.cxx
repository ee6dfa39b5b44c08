#include "Optimize.h"

#include "tautline/Mesh/CoordinateFrame.h"
#include "tautline/Objectives/ElementHessian.h"
#include "ImproveWorst.h"
#include "Minimize.h"
#include "OptimizationProblem.h"
#include "tautline/Untangling/Untangle.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
/// Sums of element values differ in the last digits from sums of patches; so much is no loss.
constexpr double roundingOfSums = 1e-12;

/// The stopping criteria.
class StoppingTest
{
public:
  StoppingTest(const OptimizationProblem& problem)
    : Problem(problem)
    , Stop(problem.options().stopping)
  {
  }

  /// Whether the last record of the history is one to stop at.
  bool ends(const std::vector<IterationRecord>& history, StopReason& reason) const
  {
    const IterationRecord& now = history.back();
    const double lowered = history.front().objective - now.objective;
    if (this->Stop.allValid && now.inverted == 0)
    {
      reason = StopReason::AllValid;
    }
    else if (this->Stop.reduction < 1 && history.size() > 1 &&
      lowered >= this->Stop.reduction * this->possibleReduction(history))
    {
      reason = StopReason::Reduction;
    }
    else if (this->Stop.twoDigits && history.size() > 1 && this->sameDigits(history))
    {
      reason = StopReason::TwoDigits;
    }
    else if (now.iteration >= this->Stop.maximumIterations)
    {
      reason = StopReason::IterationLimit;
    }
    else if (this->Problem.outOfTime())
    {
      reason = StopReason::TimeLimit;
    }
    else
    {
      return false;
    }
    return true;
  }

  double progress(const IterationRecord& record) const
  {
    const double byCount =
      static_cast<double>(record.iteration) / std::max(1, this->Stop.maximumIterations);
    const double byTime =
      this->Stop.maximumSeconds > 0 ? record.seconds / this->Stop.maximumSeconds : 0.0;
    return std::min(1.0, std::max(byCount, byTime));
  }

private:
  /// To the best known objective, or to the limit of a geometric series of the last decreases.
  double possibleReduction(const std::vector<IterationRecord>& history) const
  {
    if (std::isfinite(this->Stop.bestKnown))
    {
      return history.front().objective - this->Stop.bestKnown;
    }
    const std::size_t n = history.size();
    if (n < 3)
    {
      return std::numeric_limits<double>::infinity();
    }
    const double last = history[n - 2].objective - history[n - 1].objective;
    const double before = history[n - 3].objective - history[n - 2].objective;
    constexpr double slowest = 0.9; // a ratio above this gives no estimate of the limit
    const double ratio = before > 0 ? std::clamp(last / before, 0.0, slowest) : 0.0;
    return history.front().objective - history.back().objective + last * ratio / (1.0 - ratio);
  }

  static bool sameDigits(const std::vector<IterationRecord>& history)
  {
    constexpr double hundredths = 100;
    const std::vector<double>&now = history.back().mean, &before = history[history.size() - 2].mean;
    for (std::size_t i = 0; i < now.size(); ++i)
    {
      if (std::round(hundredths * now[i]) != std::round(hundredths * before[i]))
      {
        return false;
      }
    }
    return true;
  }

  const OptimizationProblem& Problem;
  const StoppingCriteria& Stop;
};

/// Adds a record to the history and calls the observer; false if that stops the run.
bool report(OptimizationProblem& problem, const StoppingTest& watch, OptimizeResult& result,
  const IterationRecord& record)
{
  result.history.push_back(record);
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
/// Whether the sweeps have converged, and why; `all`: it visited every vertex.
bool converged(const StoppingCriteria& stop, const SweepResult& sweep, bool all,
  double firstGradient, double lowered, double size, StopReason& reason)
{
  if (all && sweep.gradientNorm <= stop.gradientNorm * firstGradient)
  {
    reason = StopReason::GradientNorm;
    return true;
  }
  if (lowered <= stop.relativeChange * size)
  {
    reason = StopReason::RelativeChange;
    return true;
  }
  if (lowered == 0)
  {
    reason = StopReason::NoProgress;
    return true;
  }
  return false;
}

//------------------------------------------------------------------------------
/**
 * @brief Sweeps to convergence.
 * @param failed set where a sweep raised the objective, as those of several objectives can
 * @param repaired set where an element that was left out has become valid
 */
StopReason optimizeLocally(OptimizationProblem& problem, const StoppingTest& watch,
  OptimizeResult& result, bool& failed, bool& repaired)
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
  bool all = true; // whether the next sweep visits every vertex
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
    const double lowered = before.objective - now.objective;
    const double size = std::abs(now.objective);
    if (!simple && !(lowered >= -roundingOfSums * size))
    {
      // Blocks of one colour do not use each other's changes of a composite objective.
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

    // Convergence is only believed of a sweep over all vertices.
    if (!converged(stop, sweep, all, firstGradient, lowered, size, reason))
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
    }
    else
    {
      return reason;
    }
  }
}

//------------------------------------------------------------------------------
/// The scalarized objective as a function of the coordinates of the free points.
class GlobalFunction : public SmoothFunction
{
public:
  explicit GlobalFunction(OptimizationProblem& problem)
    : Problem(problem)
    , Validity(problem.moving().view().numberOfCells)
    , Gradient(3 * problem.moving().view().numberOfPoints)
    , Objectives(problem.objectives())
    , Slopes(problem.objectives(), 1.0)
  {
    problem.moving().classifyCells(this->Validity.data(), problem.options().threads);
    this->Start = this->Validity;
  }

  std::size_t size() const override
  {
    return 3 * static_cast<std::size_t>(this->Problem.simplices().freeVertices());
  }

  void load(double* x) const
  {
    this->forEachFree([&](std::size_t i, std::size_t p)
      { std::copy_n(this->Problem.points().data() + 3 * p, 3, x + 3 * i); });
  }

  void put(const double* x)
  {
    this->forEachFree([&](std::size_t i, std::size_t p)
      { std::copy_n(x + 3 * i, 3, this->Problem.points().data() + 3 * p); });
    this->Problem.simplices().load(this->Problem.points().data(), this->Problem.options().threads);
  }

  double valueAndGradient(const double* x, double* gradient) override
  {
    this->forEachFree([&](std::size_t i, std::size_t p)
      { std::copy_n(x + 3 * i, 3, this->Problem.points().data() + 3 * p); });
    const double infinity = std::numeric_limits<double>::infinity();
    if (!this->allowed())
    {
      return infinity;
    }
    const std::size_t n = this->Objectives.size();
    double value = 0;
    if (n > 1)
    {
      for (std::size_t i = 0; i < n; ++i)
      {
        this->Objectives[i] = this->Problem.sum(i).value();
      }
      value = this->Problem.scalarizer().value(this->Objectives, this->Slopes);
      if (!std::isfinite(value))
      {
        return infinity;
      }
    }
    std::fill(this->Gradient.begin(), this->Gradient.end(), 0.0);
    for (std::size_t i = 0; i < n; ++i)
    {
      const double own = this->Problem.sum(i).addGradient(this->Slopes[i], this->Gradient.data());
      value = n == 1 ? own : value;
    }
    this->forEachFree(
      [&](std::size_t i, std::size_t p)
      {
        Vec3 g = { this->Gradient[3 * p], this->Gradient[3 * p + 1], this->Gradient[3 * p + 2] };
        g = this->project(p, g);
        std::copy(g.begin(), g.end(), gradient + 3 * i);
      });
    return std::isnan(value) ? infinity : value;
  }

  /// Newton takes the Hessians of the elements, the others their diagonal blocks.
  void linearize(const double*) override
  {
    const Index points = this->Problem.moving().view().numberOfPoints;
    const bool newton = this->Problem.options().optimizer == Optimizer::NewtonConjugateGradient;
    this->Blocks.assign(6 * points, 0.0);
    this->Hessians.resize(newton ? this->Objectives.size() : 0);
    for (std::size_t i = 0; i < this->Objectives.size(); ++i)
    {
      if (!newton)
      {
        addDiagonalBlocks(this->Problem.sum(i), this->Slopes[i], this->Blocks.data());
        continue;
      }
      if (!this->Hessians[i])
      {
        this->Hessians[i] = std::make_unique<ElementHessian>(this->Problem.sum(i));
      }
      this->Hessians[i]->assemble();
      this->Hessians[i]->addDiagonal(this->Slopes[i], this->Blocks.data());
    }
    this->SlopesThere = this->Slopes;
    invertBlocks(this->Blocks.data(), points, this->Problem.options().threads);
  }

  bool precondition(const double* r, double* z) override
  {
    this->inAllPoints(r, z,
      [&](const double* from, double* to)
      {
        applyBlocks(this->Blocks.data(), this->Problem.moving().view().numberOfPoints,
          this->Problem.options().threads, from, to);
      });
    return true;
  }

  bool hessianTimes(const double* d, double* product) override
  {
    if (this->Hessians.empty())
    {
      return false;
    }
    this->inAllPoints(d, product,
      [&](const double* from, double* to)
      {
        for (std::size_t i = 0; i < this->Hessians.size(); ++i)
        {
          this->Hessians[i]->addTimes(this->SlopesThere[i], from, to);
        }
      });
    return true;
  }

private:
  /// Applies a linear map of all points to free ones, with zeros at the others; to() starts at
  /// zero.
  template <class Map>
  void inAllPoints(const double* x, double* y, const Map& map)
  {
    this->From.assign(this->Gradient.size(), 0.0);
    this->To.assign(this->Gradient.size(), 0.0);
    this->forEachFree(
      [&](std::size_t i, std::size_t p)
      {
        const Vec3 free = this->project(p, { x[3 * i], x[3 * i + 1], x[3 * i + 2] });
        std::copy(free.begin(), free.end(), this->From.data() + 3 * p);
      });
    map(this->From.data(), this->To.data());
    this->forEachFree(
      [&](std::size_t i, std::size_t p)
      {
        const Vec3 free =
          this->project(p, { this->To[3 * p], this->To[3 * p + 1], this->To[3 * p + 2] });
        std::copy(free.begin(), free.end(), y + 3 * i);
      });
  }

  template <class Visit>
  void forEachFree(const Visit& visit) const
  {
    const SimplexMesh& s = this->Problem.simplices();
    for (std::int32_t v = 0; v < s.freeVertices(); ++v)
    {
      visit(static_cast<std::size_t>(v), static_cast<std::size_t>(s.point(v)));
    }
  }

  /// No element that was valid at the start has become invalid.
  bool allowed()
  {
    if (this->Problem.options().allowInversion)
    {
      return true;
    }
    this->Problem.moving().classifyCells(this->Validity.data(), this->Problem.options().threads);
    for (std::size_t i = 0; i < this->Validity.size(); ++i)
    {
      if (this->Start[i] == Valid && this->Validity[i] != Valid)
      {
        return false;
      }
    }
    return true;
  }

  /// The part of a vector a point may follow: in a planar mesh's plane, along its line or plane.
  Vec3 project(std::size_t p, Vec3 g) const
  {
    const OptimizeOptions& options = this->Problem.options();
    if (this->Problem.moving().dimension() == Dimension::Planar)
    {
      const Vec3& normal = this->Problem.moving().normal();
      g = g - dot(g, normal) * normal;
    }
    const auto along = [&](const double* u)
    {
      const Vec3 n = { u[3 * p], u[3 * p + 1], u[3 * p + 2] };
      const double n2 = dot(n, n);
      return n2 > 0 ? (dot(g, n) / n2) * n : Vec3{ 0, 0, 0 };
    };
    const auto given = [&](const double* u)
    { return u && (u[3 * p] != 0 || u[3 * p + 1] != 0 || u[3 * p + 2] != 0); };
    return given(options.slideLines) ? along(options.slideLines)
      : given(options.slidePlanes)   ? g - along(options.slidePlanes)
                                     : g;
  }

  OptimizationProblem& Problem;
  std::vector<signed char> Start, Validity;
  std::vector<double> Gradient;
  std::vector<double> Objectives, Slopes, SlopesThere;
  std::vector<std::unique_ptr<ElementHessian>> Hessians;
  std::vector<double> Blocks; ///< 6 per point: inverses of the diagonal blocks
  std::vector<double> From, To;
};

StopReason optimizeGlobally(
  OptimizationProblem& problem, const StoppingTest& watch, OptimizeResult& result)
{
  const StoppingCriteria& stop = problem.options().stopping;
  StopReason reason = StopReason::NoProgress;
  if (watch.ends(result.history, reason))
  {
    return reason;
  }
  GlobalFunction function(problem);
  std::vector<double> x(function.size());
  function.load(x.data());
  for (;;)
  {
    const int before = result.history.back().iteration;
    MinimizeOptions options;
    // After sweeps, an iteration may reduce the objective little at first.
    constexpr double afterSweeps = 0.1;
    const bool alone = isGlobal(problem.options().optimizer);
    options.method = alone ? problem.options().optimizer : Optimizer::LimitedMemoryBFGS;
    options.maximumIterations = stop.maximumIterations - before;
    options.gradientNorm = stop.gradientNorm;
    options.relativeChange = alone ? stop.relativeChange : afterSweeps * stop.relativeChange;
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

Index countInvalid(const Mesh& mesh, int threads)
{
  std::vector<signed char> validity(mesh.view().numberOfCells);
  mesh.classifyCells(validity.data(), threads);
  return std::count_if(validity.begin(), validity.end(),
    [](signed char v) { return v == Inverted || v == Degenerate; });
}

//------------------------------------------------------------------------------
/// Optimizes from result.points on; returns whether there is more to do, with elements that have
/// become valid.
bool optimizeStage(
  const Mesh& mesh, const OptimizeOptions& options, const Stopwatch& clock, OptimizeResult& result)
{
  OptimizationProblem problem(mesh, options, result.points, clock);
  result.freeVertices = problem.simplices().freeVertices();
  const StoppingTest watch(problem);
  const bool again = !result.history.empty();
  IterationRecord first = problem.record(again ? result.history.back().iteration : 0);
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
  bool failed = false, repaired = false;
  if (isGlobal(options.optimizer))
  {
    result.reason = optimizeGlobally(problem, watch, result);
  }
  else
  {
    const bool onlyLocal = isLocal(options.optimizer) || options.limits || options.slideSurface ||
      mesh.dimension() == Dimension::Surface;
    result.reason = optimizeLocally(problem, watch, result, failed, repaired);
    result.reason = failed && !onlyLocal ? optimizeGlobally(problem, watch, result) : result.reason;
  }
  const bool going =
    result.reason != StopReason::Aborted && result.reason != StopReason::TimeLimit && !repaired;
  if (options.improveWorst > 0 && going)
  {
    problem.store();
    improveWorst(problem, options.improveWorst,
      [&](IterationRecord record)
      {
        record.iteration = result.history.back().iteration + 1;
        return report(problem, watch, result, record);
      });
  }
  problem.store();
  result.iterations = result.history.back().iteration;
  result.invertedAfter = countInvalid(problem.moving(), options.threads);
  if (problem.surface() && mesh.dimension() == Dimension::Surface)
  {
    result.surfaceError =
      problem.surface()->distance(mesh, problem.simplices(), result.points.data(), options.threads);
  }
  else if (problem.surface())
  {
    const SurfaceProjection now =
      SurfaceProjection::ofBoundary(problem.moving(), problem.simplices());
    result.surfaceError = problem.simplices().scale() * now.distanceTo(*problem.surface());
  }
  return repaired;
}

//------------------------------------------------------------------------------
/// Runs untangle() with the time that is left; false if the observer stopped it.
bool untangleFirst(
  const Mesh& mesh, const OptimizeOptions& options, const Stopwatch& clock, OptimizeResult& result)
{
  UntangleOptions untangling;
  untangling.fixed = options.fixed;
  untangling.threads = options.threads;
  if (options.stopping.maximumSeconds > 0)
  {
    // 0 would be no limit.
    untangling.maximumSeconds = std::max(
      std::numeric_limits<double>::min(), options.stopping.maximumSeconds - clock.seconds());
  }
  bool proceed = true;
  untangling.observer = [&](const IterationState& state)
  {
    IterationRecord record = state.record;
    record.objectives.assign(options.objectives.size(), 0.0);
    record.mean = record.worst = record.objectives;
    return proceed = !options.observer || options.observer({ record, 0.0, state.points });
  };
  UntangleResult untangled = untangle(mesh, untangling);
  result.points = std::move(untangled.points);
  result.invertedAfter = untangled.invertedAfter;
  result.untangled = true;
  return proceed;
}
}

//------------------------------------------------------------------------------
OptimizeResult optimize(const Mesh& mesh, const OptimizeOptions& options)
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
  result.invertedBefore = result.invertedAfter = countInvalid(mesh, options.threads);
  const bool repairs =
    std::any_of(options.objectives.begin(), options.objectives.end(), canUntangle);
  if (result.invertedBefore > 0 && !repairs && mesh.dimension() != Dimension::Surface)
  {
    if (!options.untangleFirst)
    {
      throw Error(std::to_string(result.invertedBefore) +
        " elements are inverted or degenerate, and no objective repairs them: untangle first, or "
        "add the "
        "untangling metric.");
    }
    if (!untangleFirst(mesh, options, clock, result))
    {
      result.reason = StopReason::Aborted;
      return result;
    }
  }

  // Elements left out join the objective as soon as they are valid: another stage.
  while (optimizeStage(mesh, options, clock, result))
  {
  }
  return result;
}
}
