// SPDX-License-Identifier: BSD-3-Clause
#include "LinearSolver.h"

#include "LinearSolverState.h"

#include "tautline/Ranks/PointNumbering.h"

#include <algorithm>
#include <atomic>

namespace tautline
{
namespace
{
/// The stage of work that can be abandoned.
enum class Stage
{
  Waiting, // waiting for other work that uses PETSc
  SetUp,
  Solve
};

/// The data owned by one piece of work, which may continue after the solver was destroyed.
struct Job
{
  std::shared_ptr<LinearSolverState> state;
  SolverOptions options;
  Stopwatch time; // since the caller began to wait
  std::atomic<Stage> stage{ Stage::Waiting };
  std::vector<double> b, x;
  double seconds = 0.0;
  LinearSolution solution;

  /// In the working thread: sets its limits and the thread of its callbacks.
  void begin(WatchedWork* work)
  {
    this->state->Options = this->options;
    this->state->Work = work;
    this->state->Time = this->time;
  }
};

const char* remedyFor(const SolverOptions& options)
{
  return options.method == KrylovMethod::Direct
    ? "choose CG with BoomerAMG, a coarser mesh or a longer time limit"
    : "choose a cheaper preconditioner such as Jacobi or SSOR, a coarser mesh or a longer time "
      "limit";
}
}

//------------------------------------------------------------------------------
LinearSystem owned(const LinearSystem& system)
{
  struct Copies
  {
    SparseMatrix matrix;
    std::vector<double> coordinates;
  };
  if (system.owner || !system.matrix)
  {
    return system;
  }
  // Without an owner, the caller may free the matrix while abandoned work still uses it.
  const auto copies = std::make_shared<Copies>();
  LinearSystem own = system;
  copies->matrix = *system.matrix;
  own.matrix = &copies->matrix;
  if (system.coordinates && system.blockSize > 0)
  {
    const Index points = system.matrix->size / system.blockSize;
    copies->coordinates.assign(system.coordinates, system.coordinates + 3 * points);
    own.coordinates = copies->coordinates.data();
  }
  own.owner = copies;
  return own;
}

WatchLimits hardLimits(
  double maximumSeconds, const std::function<bool()>& cancelled, const LinearSystem& system)
{
  // One rank cannot abandon a collective operation alone, so there are no hard limits on several
  // ranks.
  if (system.numbering && system.numbering->ranks() > 1)
  {
    return { 0.0, nullptr, false };
  }
  // The solver tests its own limit between iterations; the watchdog only ends a single step that
  // takes longer.
  constexpr double fraction = 0.1, least = 0.5, most = 5.0;
  const double grace = std::clamp(fraction * maximumSeconds, least, most);
  return { maximumSeconds > 0.0 ? maximumSeconds + grace : 0.0, cancelled };
}

//------------------------------------------------------------------------------
LinearSolver::LinearSolver(const LinearSystem& system, const SolverOptions& options)
  : System(system)
  , Options(options)
{
  const WatchLimits limits = hardLimits(options.maximumSeconds, options.cancelled, system);
  struct Making
  {
    LinearSystem system;
    SolverOptions options;
    std::shared_ptr<LinearSolverState> state;
  };
  const auto making = std::make_shared<Making>();
  making->system = petscWatchable(limits) ? owned(system) : system;
  making->options = options;
  const WatchResult result = watchPetsc(limits,
    [making](WatchedWork*)
    {
      const PetscScope scope;
      making->state = { new LinearSolverState(making->system, making->options),
        PetscDelete<LinearSolverState>() };
    });
  if (result != WatchResult::Finished)
  {
    throw Error(result == WatchResult::Cancelled ? "Stopped by the user." : BusyMessage);
  }
  this->Impl = std::move(making->state);
}

LinearSolver::~LinearSolver() = default;

//------------------------------------------------------------------------------
void LinearSolver::abandon(SolveReason reason, const std::string& stage)
{
  this->Lost = reason;
  this->LostMessage = stage;
  this->Impl.reset(); // the work owns it as long as it runs
}

namespace
{
/// The reason why a piece of work was abandoned.
std::string givenUp(WatchResult result, Stage stage, const SolverOptions& options)
{
  if (result == WatchResult::Cancelled)
  {
    return "";
  }
  std::string text = BusyMessage;
  if (stage != Stage::Waiting)
  {
    text = options.method == KrylovMethod::Direct
      ? "The factorization"
      : std::string(stage == Stage::SetUp ? "The setup of " : "An iteration with ") +
        nameOf(options.preconditioner);
    text += std::string(" was not finished in time: ") + remedyFor(options) + ".";
  }
  return text;
}

SolveReason reasonOf(WatchResult result)
{
  return result == WatchResult::Cancelled ? SolveReason::Aborted : SolveReason::TimeLimit;
}
}

//------------------------------------------------------------------------------
double LinearSolver::setUp()
{
  if (!this->Impl)
  {
    return 0.0;
  }
  this->Impl->requireAlive();
  const auto job = std::make_shared<Job>();
  job->state = this->Impl;
  job->options = this->Options;
  const WatchResult result = watchPetsc(
    hardLimits(this->Options.maximumSeconds, this->Options.cancelled, this->Impl->System),
    [job](WatchedWork* work)
    {
      const PetscScope scope(job->state->OptionSet.database());
      job->stage = Stage::SetUp;
      job->begin(work);
      job->seconds = job->state->setUp();
    });
  if (result != WatchResult::Finished)
  {
    this->abandon(reasonOf(result), givenUp(result, job->stage, this->Options));
    return job->time.seconds();
  }
  return job->seconds;
}

/// The result of a solve after the work was abandoned: x is its initial guess.
LinearSolution LinearSolver::lost(const double* b, double* x) const
{
  const SparseMatrix& matrix = *this->System.matrix;
  if (!this->Options.initialGuess)
  {
    std::fill_n(x, matrix.size, 0.0);
  }
  LinearSolution solution;
  solution.reason = this->Lost;
  solution.message = this->LostMessage;
  solution.trueResidual = residualOf(matrix, b, x, this->Options.threads).relative();
  return solution;
}

//------------------------------------------------------------------------------
LinearSolution LinearSolver::solve(const double* b, double* x)
{
  LinearSolution solution;
  if (!this->Impl)
  {
    return this->lost(b, x);
  }
  this->Impl->requireAlive();
  const std::shared_ptr<LinearSolverState> state = this->Impl;
  const auto job = std::make_shared<Job>();
  job->state = state;
  job->options = this->Options;
  const WatchLimits limits =
    hardLimits(this->Options.maximumSeconds, this->Options.cancelled, state->System);
  const Index n = state->Objects.localSize();
  const bool watched = petscWatchable(limits);
  const double* const given = b;
  // Watched work may outlive the arrays of the caller, so it gets copies.
  if (watched)
  {
    job->b.assign(b, b + n);
    job->x.assign(x, x + n);
    b = job->b.data();
  }
  double* target = watched ? job->x.data() : x;
  const WatchResult result = watchPetsc(limits,
    [job, b, target](WatchedWork* work)
    {
      const PetscScope scope(job->state->OptionSet.database());
      job->stage = Stage::SetUp;
      job->begin(work);
      job->seconds = job->state->setUp();
      job->stage = Stage::Solve;
      job->solution = job->state->solve(b, target);
      job->solution.setupSeconds += job->seconds;
    });
  if (result != WatchResult::Finished)
  {
    const double setUp = job->stage == Stage::SetUp ? job->time.seconds() : 0.0;
    this->abandon(reasonOf(result), givenUp(result, job->stage, this->Options));
    solution = this->lost(given, x);
    solution.setupSeconds = setUp;
    return solution;
  }
  if (watched)
  {
    std::copy(job->x.begin(), job->x.end(), x);
  }
  return job->solution;
}

SolverOptions& LinearSolver::options()
{
  return this->Options;
}
}
