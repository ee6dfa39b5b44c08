// SPDX-License-Identifier: BSD-3-Clause
#include "ConditionEstimate.h"

#include "ExtremeEigenvalues.h"
#include "LinearSolver.h"
#include "LinearSolverState.h"

#include <array>
#include <atomic>
#include <limits>

namespace tautline
{
namespace
{
/// A smallest eigenvalue below this times the largest is 0 up to rounding.
constexpr double SingularTolerance = 1e-13;

void check(const ConditionOptions& options)
{
  if (!(options.tolerance > 0.0 && options.tolerance < 1.0))
  {
    throw Error("The tolerance of eigenvalues must be between 0 and 1, exclusive.");
  }
  if (options.maximumIterations < 1 || !(options.maximumSeconds >= 0.0))
  {
    throw Error(
      "The iterations of an eigenvalue solver must be at least 1, its time limit at least 0.");
  }
}

double relative(const ExtremeEigenvalue& extreme)
{
  return extreme.value != 0.0 ? extreme.bound / std::abs(extreme.value)
                              : std::numeric_limits<double>::infinity();
}

/// D^-1/2 A D^-1/2, which has the eigenvalues of D^-1 A; and D^-1/2. False if D is not positive.
bool scaledByDiagonal(Mat matrix, PetscMatrix& scaled, PetscVector& roots)
{
  PetscReal smallest = 0.0;
  petsc(MatCreateVecs(matrix, roots.out(), nullptr));
  petsc(MatGetDiagonal(matrix, roots));
  petsc(VecMin(roots, nullptr, &smallest));
  if (!(smallest > 0.0))
  {
    return false;
  }
  petsc(VecSqrtAbs(roots));
  petsc(VecReciprocal(roots));
  petsc(MatDuplicate(matrix, MAT_COPY_VALUES, scaled.out()));
  petsc(MatDiagonalScale(scaled, roots, roots));
  return true;
}

std::vector<double> valuesOf(const PetscSystem& system, Vec vector)
{
  std::vector<double> values;
  if (vector)
  {
    values.resize(static_cast<std::size_t>(system.localSize()));
    system.copyOut(vector, values.data());
  }
  return values;
}

/// Fills the result with both eigenvalues. Rounding changes eigenvalues by about the last digit of
/// the largest, regardless of the residuals.
void fill(ExtremeEigenvalues& extremes, const PetscSystem& system, const ConditionOptions& options,
  const EigensolverStoppingTest& test, ConditionEstimate& result)
{
  ExtremeEigenvalue &low = extremes.smallest, &high = extremes.largest;
  low.bound = std::max(low.bound, std::numeric_limits<double>::epsilon() * std::abs(high.value));
  result.smallest = low.found ? low.value : 0.0;
  result.largest = high.found ? high.value : 0.0;
  result.smallestError = low.found ? relative(low) : std::numeric_limits<double>::infinity();
  result.largestError = high.found ? relative(high) : std::numeric_limits<double>::infinity();
  result.iterations = low.iterations + high.iterations;
  result.method = low.method == high.method || low.method.empty() ? high.method
    : high.method.empty()                                         ? low.method
                          : high.method + " (largest); " + low.method + " (smallest)";
  result.message = low.message.empty() ? high.message : low.message;
  result.smallestVector = valuesOf(system, low.vector);
  result.largestVector = valuesOf(system, high.vector);
  result.converged = low.found && high.found && result.smallestError <= options.tolerance &&
    result.largestError <= options.tolerance;
  const bool zero =
    low.found && high.found && std::abs(low.value) <= std::max(SingularTolerance * high.value, 0.0);
  if (zero)
  {
    result.converged = false;
    result.message = "The matrix is singular to working precision: its smallest eigenvalue is "
                     "0 relative to the largest.";
  }
  else if (low.found && low.value < 0.0)
  {
    result.message = "The matrix is not positive definite: its smallest eigenvalue is negative.";
  }
  else if (low.found && high.found)
  {
    result.condition = high.value / low.value;
  }
  if (test.stopped())
  {
    result.converged = false;
    result.message = test.message();
  }
  else if (!result.converged && result.message.empty())
  {
    result.message = "The tolerance was not reached; see the error bounds.";
  }
}

/// The Ritz values of conjugate gradients: from inside the spectrum.
void ritzValues(const LinearSystem& system, const ConditionOptions& options,
  EigensolverStoppingTest& test, ConditionEstimate& result)
{
  SolverOptions solverOptions;
  solverOptions.preconditioner = options.preconditioner;
  solverOptions.omega = options.omega;
  solverOptions.maximumIterations = options.maximumIterations;
  solverOptions.maximumSeconds = options.maximumSeconds;
  solverOptions.petscOptions = options.petscOptions;
  solverOptions.ritzValues = true;
  // The number of iterations is unknown in advance, so the reported progress approaches 1.
  solverOptions.observer = [&](int iteration, double)
  { return !test.stop(iteration / (iteration + 100.0)); };
  LinearSolver solver(system, solverOptions);
  const PetscSystem& objects = solver.state().Objects;
  // The right-hand side is random: it has components in the whole spectrum.
  PetscVector start = objects.createVector();
  fillStartVector(start);
  std::vector<double> b = valuesOf(objects, start), x(b.size());
  const LinearSolution solution = solver.solve(b.data(), x.data());
  result.method = "Ritz values of CG";
  result.iterations = solution.iterations;
  result.smallest = solution.ritzSmallest;
  result.largest = solution.ritzLargest;
  result.smallestError = result.largestError = std::numeric_limits<double>::infinity();
  result.condition = result.smallest > 0.0 ? result.largest / result.smallest : 0.0;
  result.converged = false;
  result.message = test.stopped() ? test.message()
    : converged(solution.reason)
    ? "Ritz values lie inside the spectrum: the condition number is at least this."
    : "CG " + std::string(describe(solution.reason)) +
      (solution.message.empty() ? "" : ": " + solution.message);
}

/// The spectrum of P^-1 A for any PETSc preconditioner P.
ExtremeEigenvalues preconditionedExtremeEigenvalues(const LinearSystem& system,
  const ConditionOptions& options, Preconditioner preconditioner, const std::string& petscOptions,
  EigensolverStoppingTest& test)
{
  SolverOptions solverOptions;
  solverOptions.preconditioner = preconditioner;
  solverOptions.omega = options.omega;
  solverOptions.petscOptions = petscOptions;
  LinearSolver solver(system, solverOptions);
  solver.setUp();
  LinearSolverState& own = solver.state();
  const PetscScope scope(own.OptionSet.database());
  ExtremeEigenvalues extremes;
  // `Exact` is the initial value, which means that nothing has failed.
  if (own.Failure != SolveReason::Exact)
  {
    extremes.smallest.message = extremes.largest.message = own.FailureText;
    return extremes;
  }
  PC pc = nullptr;
  petsc(KSPGetPC(own.Solver, &pc));
  PCFailedReason why = PC_NOERROR;
  petsc(PCGetFailedReason(pc, &why));
  if (why != PC_NOERROR)
  {
    extremes.smallest.message = extremes.largest.message =
      "The preconditioner could not be built: a pivot is zero.";
    return extremes;
  }
  return lanczosExtremeEigenvalues(own.Objects.matrix(), pc, options, test);
}

/// The spectrum of A, or of D^-1 A.
ExtremeEigenvalues plainExtremeEigenvalues(const LinearSystem& system, const PetscSystem& objects,
  const ConditionOptions& options, PetscOptionSet& optionSet, EigensolverStoppingTest& test)
{
  ExtremeEigenvalues extremes;
  Mat matrix = objects.matrix();
  PetscMatrix scaled;
  PetscVector roots;
  if (options.preconditioner == Preconditioner::Jacobi)
  {
    if (!scaledByDiagonal(matrix, scaled, roots))
    {
      extremes.smallest.message = extremes.largest.message =
        "The preconditioner is not positive definite: a diagonal entry is not positive.";
      return extremes;
    }
    matrix = scaled;
  }
  extremes = slepcExtremeEigenvalues(matrix, system, objects.ranks(), options, optionSet, test);
  // If y is an eigenvector of the scaled matrix, D^-1/2 y is one of D^-1 A.
  if (roots)
  {
    for (ExtremeEigenvalue* extreme : { &extremes.smallest, &extremes.largest })
    {
      if (extreme->vector)
      {
        petsc(VecPointwiseMult(extreme->vector, extreme->vector, roots));
      }
    }
  }
  // The Lanczos method handles cases in which shift-invert and LOBPCG fail: a singular or an
  // indefinite matrix.
  if ((!extremes.smallest.found || !extremes.largest.found) && !test.stopped())
  {
    ExtremeEigenvalues other =
      preconditionedExtremeEigenvalues(system, options, options.preconditioner, "", test);
    const std::array pairs = { std::make_pair(&extremes.smallest, &other.smallest),
      std::make_pair(&extremes.largest, &other.largest) };
    for (const auto& [extreme, second] : pairs)
    {
      if (!extreme->found)
      {
        *extreme = std::move(*second);
      }
    }
  }
  return extremes;
}

/// Runs in the working thread.
ConditionEstimate estimate(
  const LinearSystem& system, const ConditionOptions& options, WatchedWork* work)
{
  const PetscScope scope;
  PetscOptionSet optionSet(options.petscOptions);
  const PetscScope own(optionSet.database());
  const PetscSystem objects(system);
  EigensolverStoppingTest test(objects, options, work);
  ConditionEstimate result;
  try
  {
    // Without a preconditioner or with Jacobi, the matrix can be made symmetric explicitly, so that
    // the methods of SLEPc apply.
    const bool plain = options.preconditioner == Preconditioner::None ||
      (options.preconditioner == Preconditioner::Jacobi &&
        options.petscOptions.find("-pc_") == std::string::npos);
    if (options.method == SpectrumMethod::RitzValues)
    {
      ritzValues(system, options, test, result);
    }
    else
    {
      ExtremeEigenvalues extremes = plain
        ? plainExtremeEigenvalues(system, objects, options, optionSet, test)
        : preconditionedExtremeEigenvalues(
            system, options, options.preconditioner, options.petscOptions, test);
      fill(extremes, objects, options, test, result);
    }
  }
  catch (const PetscError& error)
  {
    result = ConditionEstimate();
    result.smallestError = result.largestError = std::numeric_limits<double>::infinity();
    result.message = optionSet.explain(error,
      options.method == SpectrumMethod::RitzValues ? "Method = Ritz values" : "Method = accurate");
  }
  test.rethrow();
  result.seconds = test.seconds();
  return result;
}
}

//------------------------------------------------------------------------------
ConditionEstimate estimateCondition(const LinearSystem& system, const ConditionOptions& options)
{
  check(options);
  if (!system.symmetric)
  {
    throw Error("Condition numbers are only available for symmetric matrices.");
  }
  const WatchLimits limits = hardLimits(options.maximumSeconds, options.cancelled, system);
  struct Job
  {
    LinearSystem system;
    ConditionOptions options;
    std::atomic<bool> begun{ false };
    ConditionEstimate result;
  };
  // Watched work may continue after this function has returned, so it owns its data.
  const auto job = std::make_shared<Job>();
  job->system = petscWatchable(limits) ? owned(system) : system;
  job->options = options;
  const Stopwatch time;
  const WatchResult end = watchPetsc(limits,
    [job, time](WatchedWork* work)
    {
      const PetscScope scope;
      job->begun = true;
      // Other work may have used a part of the time.
      double& seconds = job->options.maximumSeconds;
      constexpr double smallest = 1e-3; // 0 would mean no limit
      seconds = seconds > 0.0 ? std::max(smallest, seconds - time.seconds()) : 0.0;
      job->result = estimate(job->system, job->options, work);
    });
  if (end == WatchResult::Finished)
  {
    return job->result;
  }
  ConditionEstimate result;
  result.smallestError = result.largestError = std::numeric_limits<double>::infinity();
  result.seconds = time.seconds();
  result.message = end == WatchResult::Cancelled ? "Stopped by the user."
    : job->begun ? "The time limit was reached before a result was found: choose the method Ritz "
                   "values, a coarser mesh or a longer time limit."
                 : BusyMessage;
  return result;
}
}
