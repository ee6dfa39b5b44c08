// SPDX-License-Identifier: BSD-3-Clause
#include "LinearSolverState.h"

#include "PetscOptionRules.h"
#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <limits>
#include <sstream>

namespace tautline
{
namespace
{
/// A direct solve must leave a residual below this, relative to b; a singular matrix does not.
constexpr double DirectTolerance = 1e-6;

/// A solution with a residual above this fraction of the right-hand side is hardly better than 0.
constexpr double FalseResidual = 0.5;

/// How often a method continues if its own test was met but the residual is not small.
constexpr int Rounds = 4;

/// A residual is rounding if it is below this many units in the last place of |A| |x| + |b|.
constexpr double RoundingUnits = 16.0;

KSPType typeOf(KrylovMethod method)
{
  switch (method)
  {
    case KrylovMethod::ConjugateGradient:
      return KSPCG;
    case KrylovMethod::GMRES:
      return KSPGMRES;
    case KrylovMethod::MINRES:
      return KSPMINRES;
    case KrylovMethod::BiCGStab:
      return KSPBCGS;
    case KrylovMethod::Direct:
      return KSPPREONLY;
  }
  throw Error("Unknown solver number " + std::to_string(static_cast<int>(method)) + ".");
}

SolveReason translate(KSPConvergedReason reason, bool direct)
{
  switch (reason)
  {
    case KSP_CONVERGED_RTOL:
    case ConvergedRelativeNormal:
      return SolveReason::RelativeTolerance;
    case KSP_CONVERGED_ATOL:
    case ConvergedAbsoluteNormal:
      return SolveReason::AbsoluteTolerance;
    case KSP_CONVERGED_HAPPY_BREAKDOWN:
      return SolveReason::Exact;
    case KSP_DIVERGED_ITS:
      return SolveReason::IterationLimit;
    case KSP_DIVERGED_DTOL:
      return SolveReason::Diverged;
    case KSP_DIVERGED_BREAKDOWN:
    case KSP_DIVERGED_BREAKDOWN_BICG:
      return SolveReason::Breakdown;
    case KSP_DIVERGED_INDEFINITE_PC:
      return SolveReason::IndefinitePreconditioner;
    case KSP_DIVERGED_INDEFINITE_MAT:
      return SolveReason::IndefiniteMatrix;
    case KSP_DIVERGED_NANORINF:
      return SolveReason::NotANumber;
    case KSP_DIVERGED_PC_FAILED:
      return SolveReason::PreconditionerFailed;
    case KSP_CONVERGED_ITS: // a method from the PETSc options without a test, or a factorization
      return direct ? SolveReason::Exact : SolveReason::OtherConvergence;
    // Other positive reasons end a trust-region step; the system is not solved.
    default:
      return SolveReason::OtherFailure;
  }
}

/// The reason why a preconditioner could not be set up.
const char* explain(PCFailedReason reason)
{
  switch (reason)
  {
    case PC_FACTOR_STRUCT_ZEROPIVOT:
      return "A pivot is zero: the matrix has an empty row.";
    case PC_FACTOR_NUMERIC_ZEROPIVOT:
      return "A pivot is zero: the matrix is singular, or not definite enough for this "
             "preconditioner; choose Preconditioner = Jacobi or BoomerAMG.";
    case PC_FACTOR_OUTMEMORY:
      return "Insufficient memory for the factors; choose Solver = CG with "
             "Preconditioner = BoomerAMG.";
    case PC_SUBPC_ERROR:
      return "An inner solver failed: a pivot is zero; choose Preconditioner = Jacobi or "
             "BoomerAMG.";
    default:
      return "The preconditioner or factorization failed; choose another one.";
  }
}

bool finite(const double* x, Index n)
{
  return std::all_of(x, x + n, [](double value) { return std::isfinite(value); });
}

void check(const SolverOptions& options)
{
  const auto positive = [](double value) { return std::isfinite(value) && value >= 0.0; };
  if (!positive(options.relativeTolerance) || options.relativeTolerance >= 1.0 ||
    !positive(options.absoluteTolerance))
  {
    throw Error("The relative tolerance of a linear solver must be at least 0 and below 1, the "
                "absolute one at least 0.");
  }
  if (options.maximumIterations < 0 || options.restart < 1)
  {
    throw Error(
      "The iterations of a linear solver must be at least 0, the restart of GMRES at least 1.");
  }
  if (!(options.omega > 0.0 && options.omega < 2.0))
  {
    throw Error("The relaxation factor of SSOR must be between 0 and 2, exclusive.");
  }
  if (!positive(options.maximumSeconds))
  {
    throw Error("The time limit of a linear solver must be at least 0.");
  }
}
}

//------------------------------------------------------------------------------
LinearSolverState::LinearSolverState(const LinearSystem& system, const SolverOptions& options)
  : System(system)
  , Options(options)
  , OptionSet(options.petscOptions)
  , Objects(system, this->OptionSet.changesMatrix())
{
  check(options);
  const PetscScope own(this->OptionSet.database());
  this->configure();
}

LinearSolverState::~LinearSolverState()
{
  // Since the test was taken, PETSc may have been finalized and initialized again.
  if (this->DestroyTest && petscUsable() && this->Generation == petscGeneration())
  {
    destroyContext(this->DestroyTest, this->TestContext);
  }
}

void LinearSolverState::requireAlive() const
{
  if (!petscUsable() || this->Generation != petscGeneration())
  {
    throw Error("Other code in this process has shut down PETSc since this linear solver was "
                "created: create a new one.");
  }
}

/// The user's choice, for messages.
std::string LinearSolverState::subject() const
{
  return this->Options.method == KrylovMethod::Direct
    ? "Solver = direct"
    : std::string("Preconditioner = ") + nameOf(this->Options.preconditioner);
}

void LinearSolverState::configure()
{
  const bool direct = this->Options.method == KrylovMethod::Direct;
  PC pc = nullptr;
  petsc(KSPCreate(this->Objects.communicator(), this->Solver.out()));
  petsc(KSPSetOperators(this->Solver, this->Objects.matrix(), this->Objects.matrix()));
  petsc(KSPSetType(this->Solver, typeOf(this->Options.method)));
  petsc(KSPGetPC(this->Solver, &pc));
  if (this->Options.method == KrylovMethod::GMRES)
  {
    petsc(KSPGMRESSetRestart(this->Solver, this->Options.restart));
  }
  petsc(
    liftMinresRadius(this->Solver)); // also for other methods: the PETSc options may select MINRES
  // ILU and ICC work on one rank; on several ranks, they become the solvers of the blocks.
  const bool parallel = this->Objects.ranks() > 1;
  switch (direct ? Preconditioner::None : this->Options.preconditioner)
  {
    case Preconditioner::Jacobi:
      petsc(PCSetType(pc, PCJACOBI));
      break;
    case Preconditioner::SSOR:
      petsc(PCSetType(pc, PCSOR));
      petsc(PCSORSetSymmetric(pc, SOR_LOCAL_SYMMETRIC_SWEEP));
      petsc(PCSORSetOmega(pc, this->Options.omega));
      break;
    case Preconditioner::ILU:
    case Preconditioner::ICC:
    {
      const char* type = this->Options.preconditioner == Preconditioner::ILU ? PCILU : PCICC;
      petsc(PCSetType(pc, parallel ? PCBJACOBI : type));
      if (parallel)
      {
        this->OptionSet.setDefault("-sub_pc_type", type);
      }
      break;
    }
    case Preconditioner::BoomerAMG:
      petsc(PCSetType(pc, PCHYPRE));
      petsc(PCHYPRESetType(pc, "boomeramg"));
      break;
    case Preconditioner::GAMG:
      petsc(PCSetType(pc, PCGAMG));
      break;
    case Preconditioner::None:
      petsc(PCSetType(pc, PCNONE));
      break;
    default:
      throw Error("Unknown preconditioner number " +
        std::to_string(static_cast<int>(this->Options.preconditioner)) + ".");
  }
  if (direct)
  {
    chooseFactorization(pc, this->System, this->Objects.ranks(), this->OptionSet);
  }
  if (this->Options.ritzValues)
  {
    petsc(KSPSetComputeSingularValues(this->Solver, PETSC_TRUE));
  }
  // Defaults apply only where the user's options have no value.
  for (const PetscOption& option : parsePetscOptions(this->Options.defaultPetscOptions))
  {
    this->OptionSet.setDefault(option.name, option.value);
  }
  this->applyTolerances();
  this->OptionSet.read([&]() { petsc(KSPSetFromOptions(this->Solver)); });
  PetscBool split = PETSC_FALSE;
  petsc(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(pc), PCFIELDSPLIT, &split));
  if (split && this->System.blockSize < 2)
  {
    throw Error(
      "PETSc option -pc_type fieldsplit: it splits the unknowns by components (for example, of "
      "a displacement), but this system has one unknown per point. Remove the option.");
  }
  this->OptionSet.rejectUnused(false);
  // The function test(), called in each iteration, calls the currently selected test.
  petsc(KSPGetAndClearConvergenceTest(
    this->Solver, &this->Test, &this->TestContext, &this->DestroyTest));
  petsc(KSPSetConvergenceTest(this->Solver, test, this, nullptr));
}

void LinearSolverState::applyTolerances()
{
  check(this->Options);
  // Tolerances in the PETSc options take precedence.
  const auto unlessGiven = [&](const char* name, double value, double kept)
  { return this->OptionSet.has(name) ? kept : value; };
  PetscReal relative = 0, absolute = 0, divergence = 0;
  PetscInt iterations = 0;
  petsc(KSPGetTolerances(this->Solver, &relative, &absolute, &divergence, &iterations));
  petsc(KSPSetTolerances(this->Solver,
    unlessGiven("-ksp_rtol", this->Options.relativeTolerance, relative),
    unlessGiven("-ksp_atol", this->Options.absoluteTolerance, absolute), divergence,
    this->OptionSet.has("-ksp_max_it") ? iterations : this->Options.maximumIterations));
  petsc(KSPGetTolerances(this->Solver, &this->Relative, &this->Absolute, nullptr, nullptr));
}

//------------------------------------------------------------------------------
PetscErrorCode LinearSolverState::test(
  KSP solver, PetscInt iteration, PetscReal norm, KSPConvergedReason* reason, void* context)
{
  auto& self = *static_cast<LinearSolverState*>(context);
  // GMRES reports the residual at a restart twice.
  iteration += self.Before;
  self.Residuals.resize(static_cast<std::size_t>(iteration));
  self.Residuals.push_back(norm);
  const PetscErrorCode code =
    self.Test(solver, iteration - self.Before, norm, reason, self.TestContext);
  // PETSc has no reason for an abort, so the iteration limit stands for it; shouldStop() records
  // the actual reason.
  if (code == 0 && *reason == KSP_CONVERGED_ITERATING && self.shouldStop(iteration, norm))
  {
    *reason = KSP_DIVERGED_ITS;
  }
  return code;
}

/// Whether the observer or the user stops the solve. No exception may propagate through PETSc.
bool LinearSolverState::userStops(int iteration, double norm)
{
  try
  {
    if (this->Work && this->Work->abandoned())
    {
      return true;
    }
    if (!this->Work && this->Objects.ranks() == 1)
    {
      throwIfInterrupted();
    }
    if (!this->Work && this->Options.cancelled && this->SinceAsked.reached(WatchInterval))
    {
      this->SinceAsked = Stopwatch();
      if (this->Options.cancelled())
      {
        return true;
      }
    }
    const double interval = this->Options.observerSeconds;
    if (!this->Options.observer ||
      (iteration > 0 && interval > 0.0 && !this->SinceObserved.reached(interval)))
    {
      return false;
    }
    this->SinceObserved = Stopwatch();
    bool proceed = true;
    const auto observe = [&]() { proceed = this->Options.observer(iteration, norm); };
    if (this->Work)
    {
      proceed = this->Work->inCaller(observe) && proceed;
    }
    else
    {
      observe();
    }
    return !proceed;
  }
  catch (...)
  {
    this->Thrown = std::current_exception();
    return true;
  }
}

bool LinearSolverState::shouldStop(int iteration, double norm)
{
  bool aborted = this->userStops(iteration, norm);
  const bool limited = this->Options.maximumSeconds > 0.0;
  bool late = this->Time.reached(this->Options.maximumSeconds);
  // The ranks stop together.
  if (this->Objects.ranks() > 1)
  {
    const bool asked = this->Options.observer || this->Options.cancelled;
    aborted = asked && this->Objects.anywhere(aborted);
  }
  late = limited && this->Objects.anywhere(late);
  if (aborted || late)
  {
    this->Stopped = aborted ? SolveReason::Aborted : SolveReason::TimeLimit;
  }
  return aborted || late;
}

//------------------------------------------------------------------------------
double LinearSolverState::setUp()
{
  if (this->Ready)
  {
    return 0.0;
  }
  const Stopwatch time;
  try
  {
    this->findEmptyRows();
    // Without this call, PETSc would defer the factorizations of blocks to the first solve, where
    // they would be timed.
    petsc(KSPSetUp(this->Solver));
    petsc(KSPSetUpOnBlocks(this->Solver));
  }
  catch (const PetscError& error)
  {
    // PETSc's error code does not distinguish this case, so its message is searched.
    const bool indefinite =
      std::string(error.what()).find("not positive definite") != std::string::npos;
    this->Failure = indefinite ? SolveReason::IndefiniteMatrix : SolveReason::PreconditionerFailed;
    this->FailureText = indefinite ? "A pivot of the factorization is not positive."
                                   : this->OptionSet.explain(error, this->subject());
    this->Ready = true;
    return time.seconds();
  }
  const double elapsed = time.seconds();
  this->OptionSet.rejectUnused(true);
  this->Ready = true;
  return elapsed;
}

/// In a semidefinite matrix, a zero on the diagonal implies an empty row, which Jacobi would not
/// detect.
void LinearSolverState::findEmptyRows()
{
  if (!this->System.symmetric || !this->System.positiveDefinite)
  {
    return;
  }
  PetscVector diagonal = this->Objects.createVector();
  PetscReal smallest = 0.0;
  PetscInt row = 0;
  petsc(MatGetDiagonal(this->Objects.matrix(), diagonal));
  petsc(VecAbs(diagonal));
  petsc(VecMin(diagonal, &row, &smallest));
  if (smallest == 0.0)
  {
    throw PetscError(OwnError,
      "The matrix is singular: the diagonal entry of row " + std::to_string(row) +
        ", a pivot, is 0.");
  }
}

//------------------------------------------------------------------------------
/// Runs PETSc's solver; an error of PETSc becomes a message.
void LinearSolverState::runSolver(Vec b, Vec x, LinearSolution& solution)
{
  try
  {
    petsc(KSPSolve(this->Solver, b, x));
    KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
    PetscInt iterations = 0;
    petsc(KSPGetConvergedReason(this->Solver, &reason));
    petsc(KSPGetIterationNumber(this->Solver, &iterations));
    solution.reason = this->Stopped != SolveReason::Exact
      ? this->Stopped
      : translate(reason, this->Options.method == KrylovMethod::Direct);
    solution.iterations = this->Before + iterations;
    solution.residuals = this->Residuals;
    if (solution.reason == SolveReason::PreconditionerFailed)
    {
      PC pc = nullptr;
      PCFailedReason why = PC_NOERROR;
      petsc(KSPGetPC(this->Solver, &pc));
      petsc(PCGetFailedReason(pc, &why));
      solution.message = explain(why);
    }
    // If conjugate gradients break down, the last iteration is missing from PETSc's record, and its
    // loop over the uninitialized entries may not terminate.
    if (this->Options.ritzValues && (reason > 0 || reason == KSP_DIVERGED_ITS))
    {
      this->ritzValues(solution);
    }
  }
  catch (const PetscError& error)
  {
    solution.reason = SolveReason::OtherFailure;
    solution.message = this->OptionSet.explain(error, this->subject());
    // After a failure during a solve, PETSc leaves the solver in a state that cannot be destroyed.
    this->Failure = solution.reason;
    this->FailureText = solution.message;
    this->Solver.leak();
  }
}

//------------------------------------------------------------------------------
LinearSolution LinearSolverState::solve(const double* b, double* x)
{
  this->Verified = false;
  LinearSolution solution = this->attempt(b, x);
  if (!this->Verified)
  {
    solution.trueResidual = this->residual(b, x).relative();
  }
  return solution;
}

/// solve() without verification; x is unchanged if the solution is returned unverified.
LinearSolution LinearSolverState::attempt(const double* b, double* x)
{
  LinearSolution solution;
  this->Residuals.clear();
  this->Stopped = SolveReason::Exact;
  this->Thrown = nullptr;
  const Index n = this->Objects.localSize();
  if (!this->Options.initialGuess)
  {
    std::fill_n(x, n, 0.0);
  }
  // If the setup of the preconditioner fails, every solve fails.
  solution.setupSeconds = this->setUp();
  if (this->Failure != SolveReason::Exact)
  {
    solution.reason = this->Failure;
    solution.message = this->FailureText;
    return solution;
  }
  if (this->Objects.anywhere(!finite(b, n) || !finite(x, n)))
  {
    solution.reason = SolveReason::NotANumber;
    solution.message = "The right-hand side or the initial guess has an entry that is not finite.";
    std::fill_n(x, n, 0.0);
    return solution;
  }

  PetscVector rightHandSide = this->Objects.createVector(), unknowns = this->Objects.createVector();
  // The right-hand side consists of contributions of all ranks, the guess of values.
  this->Objects.add(b, rightHandSide);
  this->Objects.copyIn(x, unknowns);
  this->applyTolerances();
  const Stopwatch time;
  const bool direct = this->Options.method == KrylovMethod::Direct;
  // A direct solve starts from 0, because KSPPREONLY rejects a nonzero initial guess.
  petsc(KSPSetInitialGuessNonzero(
    this->Solver, this->Options.initialGuess && !direct ? PETSC_TRUE : PETSC_FALSE));
  PetscInt most = 0;
  petsc(KSPGetTolerances(this->Solver, nullptr, nullptr, nullptr, &most));
  this->Before = 0;
  bool again = true;
  for (int round = 0; again; ++round)
  {
    solution.message.clear();
    this->runSolver(rightHandSide, unknowns, solution);
    if (this->Thrown)
    {
      std::rethrow_exception(this->Thrown);
    }
    const bool relative = solution.reason == SolveReason::RelativeTolerance;
    this->takeSolution(b, unknowns, x, solution);
    // If the method's own test was met too early, the method continues from here.
    again = solution.reason == SolveReason::FalseConvergence && relative && round < Rounds &&
      !this->Options.ritzValues && solution.iterations < most && solution.trueResidual > 0.0 &&
      this->tighten(solution, most);
  }
  // The next solve starts with the original tolerances.
  if (this->Failure == SolveReason::Exact)
  {
    petsc(KSPSetTolerances(this->Solver, this->Relative, this->Absolute, PETSC_DEFAULT, most));
  }
  solution.solveSeconds = time.seconds();
  return solution;
}

/// Sets tolerances for another round to reach the allowed residual; false if there are none.
bool LinearSolverState::tighten(const LinearSolution& solution, int most)
{
  constexpr double margin = 0.1;
  PetscReal relative = 0.0;
  petsc(KSPGetTolerances(this->Solver, &relative, nullptr, nullptr, nullptr));
  // The norm of the method and the true residual are assumed to be proportional.
  relative *= margin * this->allowedResidual() / solution.trueResidual;
  if (!(relative > std::numeric_limits<double>::epsilon()))
  {
    return false;
  }
  // Iterations of earlier rounds count toward the limit.
  this->Before = solution.iterations;
  petsc(KSPSetTolerances(
    this->Solver, relative, this->Absolute, PETSC_DEFAULT, most - solution.iterations));
  petsc(KSPSetInitialGuessNonzero(this->Solver, PETSC_TRUE));
  return true;
}

/// Copies the solution to x and verifies it. x is unchanged unless both are finite.
void LinearSolverState::takeSolution(
  const double* b, Vec unknowns, double* x, LinearSolution& solution)
{
  const Index n = this->Objects.localSize();
  std::vector<double> values(static_cast<std::size_t>(n));
  this->Objects.copyOut(unknowns, values.data());
  Residual residual;
  // Ranks decide together, because the norms below are collective.
  const bool valid = !this->Objects.anywhere(!finite(values.data(), n));
  if (valid)
  {
    residual = this->residual(b, values.data());
  }
  if (valid && std::isfinite(residual.after))
  {
    std::copy(values.begin(), values.end(), x);
    this->verify(b, x, residual, solution);
  }
  else if (converged(solution.reason))
  {
    solution.reason = SolveReason::NotANumber;
  }
}

//------------------------------------------------------------------------------
/// The 2-norm of a vector of this rank's contributions.
double LinearSolverState::norm(const std::vector<double>& contributions) const
{
  if (this->Objects.ranks() > 1)
  {
    PetscReal norm = 0.0;
    PetscVector rows = this->Objects.createVector();
    this->Objects.add(contributions.data(), rows);
    petsc(VecNorm(rows, NORM_2, &norm));
    return norm;
  }
  return norm2(contributions);
}

/// Relative to the right-hand side.
double LinearSolverState::allowedResidual() const
{
  return this->Options.method == KrylovMethod::Direct
    ? DirectTolerance
    : std::min(ResidualFactor * this->Relative, std::max(FalseResidual, this->Relative));
}

/// The part of b - A x that may be due to rounding.
double LinearSolverState::roundingLevel(const double* b, const double* x) const
{
  const SparseMatrix& matrix = *this->System.matrix;
  std::vector<double> sizes(static_cast<std::size_t>(matrix.size));
  for (Index row = 0; row < matrix.size; ++row)
  {
    sizes[row] = std::abs(b[row]);
    for (Index k = matrix.offsets[row]; k < matrix.offsets[row + 1]; ++k)
    {
      sizes[row] += std::abs(matrix.values[k] * x[matrix.columns[k]]);
    }
  }
  return RoundingUnits * std::numeric_limits<double>::epsilon() * this->norm(sizes);
}

/// Uses Tautline's own matrix-vector product.
Residual LinearSolverState::residual(const double* b, const double* x) const
{
  const SparseMatrix& matrix = *this->System.matrix;
  if (this->Objects.ranks() == 1)
  {
    return residualOf(matrix, b, x, this->Options.threads);
  }
  const std::vector<double> whole(b, b + matrix.size);
  return { this->norm(whole), this->norm(remainder(matrix, b, x, this->Options.threads)) };
}

/**
 * @brief Checks the true residual: a preconditioner may hide a large residual, a factorization does
 * not detect a singular matrix, and some methods report success without any work.
 */
void LinearSolverState::verify(
  const double* b, const double* x, const Residual& residual, LinearSolution& solution)
{
  const double before = residual.before, after = residual.after;
  this->Verified = true;
  solution.trueResidual = residual.relative();
  const bool direct = this->Options.method == KrylovMethod::Direct;
  if (direct)
  {
    solution.residuals = { before, after };
  }
  if (!converged(solution.reason))
  {
    return;
  }
  const double allowed = this->allowedResidual();
  // For a badly scaled matrix, rounding alone may exceed the tolerance; this residual is also
  // accepted.
  if (after <= std::max(allowed * before, ResidualFactor * this->Absolute) ||
    (after <= DirectTolerance * before && after <= this->roundingLevel(b, x)))
  {
    return;
  }
  std::ostringstream text;
  text.precision(2);
  const char* unit = before > 0.0 ? " times the right-hand side" : "";
  text << (direct ? "The matrix is singular or nearly so: the residual of a direct solve is "
                  : "The residual is ")
       << (before > 0.0 ? after / before : after) << unit;
  if (!direct)
  {
    text << "; the allowed value is " << (before > 0.0 ? allowed : ResidualFactor * this->Absolute);
  }
  solution.reason = direct ? SolveReason::PreconditionerFailed : SolveReason::FalseConvergence;
  solution.message = text.str() + ".";
}

void LinearSolverState::ritzValues(LinearSolution& solution)
{
  const bool available = this->Options.method == KrylovMethod::ConjugateGradient ||
    this->Options.method == KrylovMethod::GMRES;
  PetscReal largest = 0.0, smallest = 0.0;
  if (available && solution.iterations > 0 &&
    KSPComputeExtremeSingularValues(this->Solver, &largest, &smallest) == 0 && largest > 0.0)
  {
    solution.ritzSmallest = smallest;
    solution.ritzLargest = largest;
  }
}
}
