// SPDX-License-Identifier: BSD-3-Clause
// Linear systems through PETSc: every method with every preconditioner against a direct solve, why
// a solve fails, options and their databases, limits, reuse, and whatever is rejected.
#include "Registry.h"
#include "Systems.h"
#include "tautline/Elliptic/EllipticSystem.h"

#include <limits>
#include <petscksp.h>
#include <thread>

using namespace tautline;

namespace
{
constexpr KrylovMethod methods[] = { KrylovMethod::ConjugateGradient, KrylovMethod::GMRES,
  KrylovMethod::MINRES, KrylovMethod::BiCGStab };
constexpr Preconditioner preconditioners[] = { Preconditioner::Jacobi, Preconditioner::SSOR,
  Preconditioner::ILU, Preconditioner::BoomerAMG, Preconditioner::ICC, Preconditioner::GAMG,
  Preconditioner::None };

struct Result
{
  LinearSolution solution;
  std::vector<double> x;
};

Result solved(
  const LinearSystem& system, const SolverOptions& options, const std::vector<double>& b)
{
  Result result;
  result.x.assign(b.size(), 0.0);
  LinearSolver solver(system, options);
  result.solution = solver.solve(b.data(), result.x.data());
  return result;
}

Result directly(const SparseMatrix& a, const std::vector<double>& b)
{
  TAUTLINE_LET(SolverOptions, options, method = KrylovMethod::Direct);
  return solved(systemOf(a), options, b);
}

std::string nameOf(const SolverOptions& options)
{
  return std::string(tautline::nameOf(options.method)) + " + " +
    tautline::nameOf(options.preconditioner);
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testAllPairs)
{
  const int n = 40;
  for (const double scale : { 1e-8, 1.0, 1e8 })
  {
    const SparseMatrix a = laplacian(n, scale);
    const std::vector<double> b = someVector(a.size);
    const Result exact = directly(a, b);
    TAUTLINE_CHECK(exact.solution.reason == SolveReason::Exact);
    TAUTLINE_CHECK(relativeResidual(a, exact.x, b) < 1e-13);
    for (const KrylovMethod method : methods)
    {
      for (const Preconditioner preconditioner : preconditioners)
      {
        TAUTLINE_LET(SolverOptions, options, method = method, preconditioner = preconditioner,
          relativeTolerance = 1e-11, absoluteTolerance = 0.0);
        const Context context(nameOf(options));
        const Result result = solved(systemOf(a), options, b);
        TAUTLINE_CHECK(result.solution.reason == SolveReason::RelativeTolerance);
        TAUTLINE_CHECK(relativeResidual(a, result.x, b) < 1e-8);
        TAUTLINE_CHECK(relativeDifference(result.x, exact.x) < 1e-7);
        const std::vector<double>& residuals = result.solution.residuals;
        TAUTLINE_CHECK_EQUAL(static_cast<int>(residuals.size()), result.solution.iterations + 1);
        TAUTLINE_CHECK(residuals.back() <= 1e-11 * residuals.front());
        TAUTLINE_CHECK(result.solution.message.empty());
      }
    }
  }
  TAUTLINE_CHECK_EQUAL(combinationNumber(KrylovMethod::GMRES, Preconditioner::ILU), 10);
  TAUTLINE_CHECK_EQUAL(
    combinationNumber(KrylovMethod::ConjugateGradient, Preconditioner::Jacobi), 1);
  TAUTLINE_CHECK_EQUAL(combinationNumber(KrylovMethod::BiCGStab, Preconditioner::BoomerAMG), 16);
  TAUTLINE_CHECK_EQUAL(combinationNumber(KrylovMethod::Direct, Preconditioner::BoomerAMG), 0);
  TAUTLINE_CHECK_EQUAL(combinationNumber(KrylovMethod::GMRES, Preconditioner::GAMG), 0);
}

/// Unsymmetric and symmetric indefinite matrices, directly and by the methods made for them.
TAUTLINE_PART(testOtherMatrices)
{
  const int n = 20;
  const SparseMatrix upwind = gridMatrix(n,
    [](int i, int j) {
      return i == j ? 4.0 : j == i + 1 ? -0.2 : j == i - 1 ? -1.8 : -1.0;
    });
  const std::vector<double> b = someVector(upwind.size);
  LinearSystem system = systemOf(upwind);
  system.symmetric = system.positiveDefinite = false;
  TAUTLINE_LET(SolverOptions, options, relativeTolerance = 1e-12);
  for (const KrylovMethod method :
    { KrylovMethod::Direct, KrylovMethod::GMRES, KrylovMethod::BiCGStab })
  {
    TAUTLINE_SET(options, method = method, preconditioner = Preconditioner::ILU);
    const Context context(nameOf(options));
    const Result result = solved(system, options, b);
    TAUTLINE_CHECK(converged(result.solution.reason));
    TAUTLINE_CHECK(relativeResidual(upwind, result.x, b) < 1e-9);
    TAUTLINE_CHECK_RELATIVE(result.solution.trueResidual, relativeResidual(upwind, result.x, b),
      method == KrylovMethod::Direct ? 1.0 : 1e-3);
  }

  // Eigenvalues from -2.05 on: CG notices; CHOLMOD does or solves it; MINRES and MUMPS do.
  const SparseMatrix shifted = laplacian(n, 1.0, -2.1);
  system = systemOf(shifted);
  options.preconditioner = Preconditioner::None;
  options.method = KrylovMethod::ConjugateGradient;
  options.ritzValues = true; // none, as what PETSc has recorded lacks the last iteration
  const LinearSolution broken = solved(system, options, b).solution;
  TAUTLINE_CHECK(broken.reason == SolveReason::IndefiniteMatrix && broken.iterations > 0);
  TAUTLINE_CHECK(broken.ritzSmallest == 0.0 && broken.ritzLargest == 0.0);
  TAUTLINE_SET(options, ritzValues = false, method = KrylovMethod::Direct);
  const Result claimed = solved(system, options, b);
  TAUTLINE_CHECK(claimed.solution.reason == SolveReason::IndefiniteMatrix ||
    relativeResidual(shifted, claimed.x, b) < 1e-10);
  system.positiveDefinite = false;
  for (const KrylovMethod method : { KrylovMethod::MINRES, KrylovMethod::Direct })
  {
    options.method = method;
    const Context context(nameOf(options));
    const Result result = solved(system, options, b);
    TAUTLINE_CHECK(converged(result.solution.reason));
    TAUTLINE_CHECK(relativeResidual(shifted, result.x, b) < 1e-8);
  }

  // ILU of it is indefinite, which CG and MINRES cannot take.
  options.preconditioner = Preconditioner::ILU;
  for (const KrylovMethod method : { KrylovMethod::MINRES, KrylovMethod::ConjugateGradient })
  {
    options.method = method;
    const Context context(nameOf(options));
    const LinearSolution failed = solved(system, options, b).solution;
    TAUTLINE_CHECK(!converged(failed.reason));
    TAUTLINE_CHECK(
      failed.reason == SolveReason::IndefinitePreconditioner || method == KrylovMethod::MINRES);
  }
}

/// Singular matrices: an empty row, and the Neumann problem.
TAUTLINE_PART(testSingular)
{
  const int n = 12;
  const std::vector<double> b = someVector(n * n);
  SparseMatrix empty = laplacian(n);
  std::fill(
    empty.values.begin() + empty.offsets[30], empty.values.begin() + empty.offsets[31], 0.0);
  for (Index k = 0; k < empty.nonzeros(); ++k)
  {
    empty.values[k] = empty.columns[k] == 30 ? 0.0 : empty.values[k];
  }
  SparseMatrix neumann = gridMatrix(n,
    [=](int i, int j)
    {
      const int neighbors = (i % n > 0) + (i % n < n - 1) + (i / n > 0) + (i / n < n - 1);
      return i == j ? neighbors : -1.0;
    });
  for (const SparseMatrix* matrix : { &empty, &neumann })
  {
    for (const bool definite : { true, false })
    {
      LinearSystem system = TAUTLINE_CHANGED(systemOf(*matrix), positiveDefinite = definite);
      TAUTLINE_LET(SolverOptions, options, method = KrylovMethod::Direct);
      const Result result = solved(system, options, b);
      TAUTLINE_CHECK(!converged(result.solution.reason));
      TAUTLINE_CHECK(!result.solution.message.empty());
      TAUTLINE_EACH_OF(const double value, result.x, TAUTLINE_CHECK(std::isfinite(value)));
    }
  }
  for (const Preconditioner preconditioner : preconditioners)
  {
    TAUTLINE_LET(SolverOptions, options, preconditioner = preconditioner, maximumIterations = 500);
    const Context context(nameOf(options));
    const Result result = solved(systemOf(empty), options, b);
    TAUTLINE_CHECK(!converged(result.solution.reason));
    TAUTLINE_CHECK(std::isfinite(result.x[0]));
  }
  TAUTLINE_LET(SolverOptions, options, preconditioner = Preconditioner::ILU);
  const LinearSolution pivot = solved(systemOf(empty), options, b).solution;
  TAUTLINE_CHECK(pivot.reason == SolveReason::PreconditionerFailed);
  TAUTLINE_CHECK(contains(pivot.message, "pivot"));
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testOptions)
{
  const SparseMatrix a = laplacian(40);
  const std::vector<double> b = someVector(a.size);
  TAUTLINE_LET(SolverOptions, options, preconditioner = Preconditioner::Jacobi);
  const int loose = solved(systemOf(a), options, b).solution.iterations;
  options.petscOptions = "-ksp_rtol 1e-12";
  const Result tight = solved(systemOf(a), options, b);
  TAUTLINE_CHECK(tight.solution.iterations > loose + 20);
  TAUTLINE_CHECK(relativeResidual(a, tight.x, b) < 1e-10);

  // The string takes precedence over the members.
  options.petscOptions = "-ksp_type gmres -pc_type lu -pc_factor_mat_solver_type mumps";
  TAUTLINE_CHECK_EQUAL(solved(systemOf(a), options, b).solution.iterations, 1);
  options.petscOptions = "-pc_type bjacobi -pc_bjacobi_blocks 4 -sub_pc_type icc";
  TAUTLINE_CHECK(converged(solved(systemOf(a), options, b).solution.reason));
  options.petscOptions = "-ksp_max_it 3";
  TAUTLINE_CHECK(solved(systemOf(a), options, b).solution.reason == SolveReason::IterationLimit);

  // Inner solvers and HYPRE read the same options.
  options.preconditioner = Preconditioner::BoomerAMG;
  options.petscOptions.clear();
  const int usual = solved(systemOf(a), options, b).solution.iterations;
  options.petscOptions =
    "-pc_hypre_boomeramg_max_levels 2 -pc_hypre_boomeramg_relax_type_all Jacobi";
  TAUTLINE_CHECK(solved(systemOf(a), options, b).solution.iterations != usual);
  options.preconditioner = Preconditioner::GAMG;
  options.petscOptions.clear();
  const int chebyshev = solved(systemOf(a), options, b).solution.iterations;
  options.petscOptions =
    "-mg_levels_ksp_type richardson -mg_levels_ksp_max_it 1 -mg_levels_pc_type jacobi "
    "-mg_levels_ksp_richardson_scale 0.3";
  TAUTLINE_CHECK(solved(systemOf(a), options, b).solution.iterations > chebyshev);

  struct Bad
  {
    const char* text;
    const char* named;
  };
  for (const Bad& bad : { Bad{ "-ksp_rtoll 1e-3", "-ksp_rtoll" }, Bad{ "-ksp_rtol many", "many" },
         Bad{ "ksp_rtol 1e-3", "ksp_rtol" }, Bad{ "-ksp_type fastest", "fastest" },
         Bad{ "-pc_type magic", "magic" }, Bad{ "-ksp_rtol 1e-3 1e-4", "1e-4" },
         Bad{ "-ksp_max_it 1.5", "1.5" }, Bad{ "-sub_pc_typ icc", "-sub_pc_typ" },
         Bad{ "-foo", "-foo" },
         Bad{ "-pc_hypre_boomeramg_max_levels 2", "-pc_hypre_boomeramg_max_levels" },
         Bad{ "-mg_levels_ksp_max_it 3", "-mg_levels_ksp_max_it" } })
  {
    TAUTLINE_LET(
      SolverOptions, wrong, preconditioner = Preconditioner::Jacobi, petscOptions = bad.text);
    const Context context(bad.text);
    TAUTLINE_CHECK_THROWS(solved(systemOf(a), wrong, b), bad.named);
  }
  // An error that only the set-up can detect is detected each time.
  TAUTLINE_LET(SolverOptions, late, preconditioner = Preconditioner::Jacobi,
    petscOptions = "-sub_pc_type icc");
  LinearSolver mistaken(systemOf(a), late);
  std::vector<double> x(b.size());
  TAUTLINE_CHECK_THROWS(mistaken.setUp(), "-sub_pc_type");
  TAUTLINE_CHECK_THROWS(mistaken.solve(b.data(), x.data()), "-sub_pc_type");

#define REJECTED(change, text) \
  TAUTLINE_CHECK_THROWS(solved(systemOf(a), TAUTLINE_CHANGED(SolverOptions(), change), b), text)
  REJECTED(omega = 2.0, wording("between-0-and-2"));
  REJECTED(relativeTolerance = -1.0, "tolerance");
  REJECTED(restart = 0, "restart");
  REJECTED(method = static_cast<KrylovMethod>(17), "number 17");
  REJECTED(preconditioner = static_cast<Preconditioner>(-2), "number -2");
}

/// Restart, relaxation, limits, the observer, the initial guess and Ritz values.
TAUTLINE_PART(testControls)
{
  const int n = 60;
  const SparseMatrix a = laplacian(n);
  const std::vector<double> b = someVector(a.size);
  TAUTLINE_LET(
    SolverOptions, options, method = KrylovMethod::GMRES, preconditioner = Preconditioner::Jacobi);
  int before = 100000;
  for (const int restart : { 5, 20, 80 })
  {
    options.restart = restart;
    const LinearSolution solution = solved(systemOf(a), options, b).solution;
    TAUTLINE_CHECK(solution.iterations < before);
    before = solution.iterations;
  }
  options.method = KrylovMethod::ConjugateGradient;
  options.preconditioner = Preconditioner::SSOR;
  const int plain = solved(systemOf(a), options, b).solution.iterations;
  options.omega = 1.8;
  TAUTLINE_CHECK(solved(systemOf(a), options, b).solution.iterations < 0.75 * plain);

  options = {};
  options.preconditioner = Preconditioner::None;
  int calls = 0;
  options.observer = [&](int iteration, double norm)
  {
    TAUTLINE_CHECK_EQUAL(iteration, calls);
    TAUTLINE_CHECK(norm > 0);
    ++calls;
    return iteration < 7;
  };
  Result stopped = solved(systemOf(a), options, b);
  TAUTLINE_CHECK(stopped.solution.reason == SolveReason::Aborted);
  TAUTLINE_CHECK_EQUAL(stopped.solution.iterations, 7);
  TAUTLINE_CHECK(relativeResidual(a, stopped.x, b) < 2.0);
  options.observer = [](int, double) -> bool { throw std::runtime_error("from the observer"); };
  TAUTLINE_CHECK_THROWS(solved(systemOf(a), options, b), wording("from-the-observer"));
  options.observer = [](int, double)
  {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return true;
  };
  options.maximumSeconds = 0.03;
  stopped = solved(systemOf(a), options, b);
  TAUTLINE_CHECK(stopped.solution.reason == SolveReason::TimeLimit);
  TAUTLINE_CHECK(stopped.solution.iterations <= 8); // fewer on a busy machine

  // From the solution on there is nothing to do; tolerances may change between solves.
  options = {};
  TAUTLINE_SET(options, preconditioner = Preconditioner::ILU, relativeTolerance = 1e-12);
  LinearSolver solver(systemOf(a), options);
  TAUTLINE_CHECK(solver.setUp() > 0.0);
  TAUTLINE_CHECK_EQUAL(solver.setUp(), 0.0);
  std::vector<double> x(b.size(), 7.0);
  const LinearSolution first = solver.solve(b.data(), x.data());
  TAUTLINE_CHECK_EQUAL(first.setupSeconds, 0.0);
  solver.options().initialGuess = true;
  solver.options().relativeTolerance = 1e-5;
  const LinearSolution again = solver.solve(b.data(), x.data());
  TAUTLINE_CHECK_EQUAL(again.iterations, 0);
  solver.options().initialGuess = false;
  const LinearSolution loose = solver.solve(b.data(), x.data());
  TAUTLINE_CHECK(loose.iterations > 5 && loose.iterations < first.iterations);

  // One set-up serves many right-hand sides.
  TAUTLINE_LET(SolverOptions, multigrid, relativeTolerance = 1e-10);
  LinearSolver reused(systemOf(a), multigrid);
  for (unsigned k = 0; k < 3; ++k)
  {
    const std::vector<double> side = someVector(a.size, 10 + k);
    const LinearSolution one = reused.solve(side.data(), x.data());
    TAUTLINE_CHECK(k == 0 ? one.setupSeconds > 0.0 : one.setupSeconds == 0.0);
    TAUTLINE_CHECK(relativeResidual(a, x, side) < 1e-8);
    TAUTLINE_CHECK(x == solved(systemOf(a), multigrid, side).x);
  }

  // Zero on the right-hand side: nothing to do; an infinite one: no number.
  std::vector<double> zero(b.size(), 0.0);
  const LinearSolution nothing = solver.solve(zero.data(), x.data());
  TAUTLINE_CHECK(converged(nothing.reason) && nothing.iterations == 0 && x[3] == 0.0);
  zero[5] = std::numeric_limits<double>::infinity();
  TAUTLINE_CHECK(solver.solve(zero.data(), x.data()).reason == SolveReason::NotANumber);

  options = {};
  TAUTLINE_SET(
    options, preconditioner = Preconditioner::None, ritzValues = true, relativeTolerance = 1e-10);
  const LinearSolution ritz = solved(systemOf(a), options, b).solution;
  TAUTLINE_CHECK_RELATIVE(ritz.ritzSmallest, laplacianEigenvalue(n, 1, 1), 1e-4);
  TAUTLINE_CHECK_RELATIVE(ritz.ritzLargest, laplacianEigenvalue(n, n, n), 1e-4);
  TAUTLINE_SET(options, method = KrylovMethod::GMRES, restart = 500);
  const LinearSolution singular = solved(systemOf(a), options, b).solution;
  TAUTLINE_CHECK_RELATIVE(singular.ritzSmallest, laplacianEigenvalue(n, 1, 1), 1e-2);
  TAUTLINE_CHECK_RELATIVE(singular.ritzLargest, laplacianEigenvalue(n, n, n), 1e-2);
  options.method = KrylovMethod::MINRES;
  TAUTLINE_CHECK_EQUAL(solved(systemOf(a), options, b).solution.ritzLargest, 0.0);
}

//------------------------------------------------------------------------------
/// Another user of PETSc, with options, an error handler and a solver of its own, notices nothing.
int strangersErrors = 0;
PetscErrorCode strangersHandler(
  MPI_Comm, int, const char*, const char*, PetscErrorCode code, PetscErrorType, const char*, void*)
{
  ++strangersErrors;
  return code;
}

TAUTLINE_PART(testStranger)
{
  const SparseMatrix a = laplacian(30);
  const std::vector<double> b = someVector(a.size);
  TAUTLINE_LET(SolverOptions, options, preconditioner = Preconditioner::Jacobi);
  const Result alone = solved(systemOf(a), options, b);

  PetscOptionsSetValue(nullptr, "-ksp_rtol", "0.5");
  PetscOptionsSetValue(nullptr, "-pc_type", "none");
  PetscOptionsSetValue(nullptr, "-mine", "7");
  char* before = nullptr;
  PetscOptionsGetAll(nullptr, &before);
  PetscPushErrorHandler(strangersHandler, nullptr);
  KSP stranger = nullptr;
  KSPCreate(PETSC_COMM_SELF, &stranger);
  KSPSetFromOptions(stranger);

  const Result beside = solved(systemOf(a), options, b);
  TAUTLINE_CHECK_EQUAL(beside.solution.iterations, alone.solution.iterations);
  TAUTLINE_CHECK(beside.x == alone.x);
  SolverOptions wrong = TAUTLINE_CHANGED(options, petscOptions = "-ksp_type nonsense");
  TAUTLINE_CHECK_THROWS(solved(systemOf(a), wrong, b), "nonsense");
  wrong.petscOptions = "-mine 3";
  TAUTLINE_CHECK_THROWS(solved(systemOf(a), wrong, b), "-mine");

  char* after = nullptr;
  PetscOptionsGetAll(nullptr, &after);
  TAUTLINE_CHECK_EQUAL(std::string(after), std::string(before));
  PetscFree(before);
  PetscFree(after);
  PetscReal tolerance = 0;
  KSPGetTolerances(stranger, &tolerance, nullptr, nullptr, nullptr);
  TAUTLINE_CHECK_EQUAL(tolerance, 0.5);
  TAUTLINE_CHECK_EQUAL(strangersErrors, 0);
  KSPSetType(stranger, "no such type");
  TAUTLINE_CHECK(strangersErrors > 0);
  KSPDestroy(&stranger);
  PetscPopErrorHandler();
  for (const char* name : { "-ksp_rtol", "-pc_type", "-mine" })
  {
    PetscOptionsClearValue(nullptr, name);
  }
}

/// Solvers do not disturb each other, be they interleaved, in threads, or called from an observer.
TAUTLINE_PART(testTogether)
{
  const SparseMatrix a = laplacian(30), c = laplacian(25, 2.0, 0.5);
  const std::vector<double> b = someVector(a.size), d = someVector(c.size, 2);
  SolverOptions jacobi, amg;
  TAUTLINE_SET(jacobi, preconditioner = Preconditioner::Jacobi, petscOptions = "-ksp_rtol 1e-9");
  const Result one = solved(systemOf(a), jacobi, b), two = solved(systemOf(c), amg, d);

  LinearSolver first(systemOf(a), jacobi), second(systemOf(c), amg);
  std::vector<double> x(b.size()), y(d.size());
  for (int k = 0; k < 2; ++k)
  {
    first.solve(b.data(), x.data());
    second.solve(d.data(), y.data());
    TAUTLINE_CHECK(x == one.x);
    TAUTLINE_CHECK(y == two.x);
  }
  std::vector<std::thread> threads;
  std::vector<std::vector<double>> results(4);
  for (std::size_t t = 0; t < results.size(); ++t)
  {
    threads.emplace_back(
      [&, t]()
      {
        for (int k = 0; k < 3; ++k)
        {
          results[t] = t % 2 ? solved(systemOf(a), jacobi, b).x : solved(systemOf(c), amg, d).x;
        }
      });
  }
  for (std::size_t t = 0; t < results.size(); ++t)
  {
    threads[t].join();
    TAUTLINE_CHECK(results[t] == (t % 2 ? one.x : two.x));
  }
  SolverOptions nested = jacobi;
  nested.observer = [&](int, double)
  {
    TAUTLINE_CHECK(solved(systemOf(c), amg, d).x == two.x);
    return true;
  };
  nested.maximumIterations = 5;
  nested.petscOptions.clear();
  TAUTLINE_CHECK_EQUAL(solved(systemOf(a), nested, b).solution.iterations, 5);
}

/// Borrowed data of PETSc stay as they are, even if an option scales or overwrites them.
TAUTLINE_PART(testUnchanged)
{
  const SparseMatrix a = laplacian(15, 3.0), copy = a;
  const std::vector<double> b = someVector(a.size);
  for (const char* text : { "-ksp_diagonal_scale", "-pc_factor_in_place", "" })
  {
    TAUTLINE_LET(SolverOptions, options, preconditioner = Preconditioner::ILU, petscOptions = text);
    const Context context(text);
    solved(systemOf(a), options, b);
    TAUTLINE_CHECK(a.values == copy.values && a.columns == copy.columns);
  }
  TAUTLINE_CHECK_EQUAL(std::string(nameOf(static_cast<KrylovMethod>(99))), std::string("unknown"));
}

/// A long elastic strip held at one end bends: smoothed aggregation needs its rigid body modes.
TAUTLINE_PART(testRigidBodyModes)
{
  const int columns = 120, rows = 8;
  std::vector<double> points;
  std::vector<Index> offsets = { 0 }, connectivity;
  std::vector<unsigned char> types, fixed;
  for (int p = 0; p < (columns + 1) * (rows + 1); ++p)
  {
    const int i = p % (columns + 1), j = p / (columns + 1);
    points.insert(points.end(), { double(i), double(j), 0.0 });
    fixed.push_back(i == 0);
    if (i < columns && j < rows)
    {
      for (const Index node : { p, p + 1, p + columns + 2, p + columns + 1 })
      {
        connectivity.push_back(node);
      }
      offsets.push_back(static_cast<Index>(connectivity.size()));
      types.push_back(static_cast<unsigned char>(CellType::Quadrilateral));
    }
  }
  TAUTLINE_LET(MeshView, view, numberOfPoints = static_cast<Index>(fixed.size()),
    points = points.data(), numberOfCells = static_cast<Index>(types.size()),
    cellTypes = types.data(), offsets = offsets.data(), connectivity = connectivity.data());
  const Mesh mesh(view);
  TAUTLINE_LET(EllipticProblem, problem, pde = Pde::Elasticity);
  problem.source = { 0, 1, 0 };
  problem.fixed = fixed.data();
  const EllipticSystem elastic(mesh, problem);
  LinearSystem system = elastic.linearSystem();
  TAUTLINE_LET(
    SolverOptions, options, preconditioner = Preconditioner::GAMG, relativeTolerance = 1e-8);
  const Result with = solved(system, options, elastic.rightHandSide());
  system.coordinates = nullptr;
  const Result without = solved(system, options, elastic.rightHandSide());
  TAUTLINE_CHECK(converged(with.solution.reason) && converged(without.solution.reason));
  TAUTLINE_CHECK(2 * with.solution.iterations < without.solution.iterations);
}

/// The cheap multigrid options: as accurate, in not many more iterations.
TAUTLINE_PART(testFastMultigrid)
{
  const int n = 28;
  TAUTLINE_LET(SparseMatrix, a, size = n * n * n);
  for (int i = 0; i < a.size; ++i)
  {
    const int x = i % n, y = i / n % n, z = i / n / n;
    for (const int k : { -n * n, -n, -1, 0, 1, n, n * n })
    {
      const int along = std::abs(k) == 1 ? x : std::abs(k) == n ? y : z;
      if (k == 0 || (along + (k > 0) > 0 && along + (k > 0) < n))
      {
        a.columns.push_back(i + k);
        a.values.push_back(k == 0 ? 6.0 : -1.0);
      }
    }
    a.offsets.push_back(a.nonzeros());
  }
  const std::vector<double> b = someVector(a.size);
  SolverOptions usual, fast;
  fast.petscOptions = fastMultigridOptions();
  const LinearSolution one = solved(systemOf(a), usual, b).solution;
  const LinearSolution two = solved(systemOf(a), fast, b).solution;
  TAUTLINE_CHECK(converged(one.reason) && converged(two.reason));
  TAUTLINE_CHECK(two.trueResidual < 1e-4);
  TAUTLINE_CHECK(two.iterations <= 3 * one.iterations);
}

TAUTLINE_PART(testRejected)
{
  const SparseMatrix none;
  TAUTLINE_CHECK_THROWS(LinearSolver(systemOf(none), {}), wording("no-unknowns"));
  TAUTLINE_CHECK_THROWS(LinearSolver(LinearSystem(), {}), wording("no-unknowns"));
  SparseMatrix a = laplacian(5);
  a.values[17] = std::numeric_limits<double>::quiet_NaN();
  TAUTLINE_CHECK_THROWS(LinearSolver(systemOf(a), {}), wording("not-finite"));
  a = laplacian(5);
  LinearSystem blocks = TAUTLINE_CHANGED(systemOf(a), blockSize = 3);
  TAUTLINE_CHECK_THROWS(LinearSolver(blocks, {}), wording("block-size-3"));
  a.values.pop_back();
  TAUTLINE_CHECK_THROWS(LinearSolver(systemOf(a), {}), wording("not-complete"));

  // One unknown.
  TAUTLINE_LET(SparseMatrix, one, size = 1);
  one.offsets = { 0, 1 };
  TAUTLINE_SET(one, columns = { 0 }, values = { 4.0 });
  const std::vector<double> b = { 2.0 };
  for (const KrylovMethod method : { KrylovMethod::ConjugateGradient, KrylovMethod::GMRES,
         KrylovMethod::MINRES, KrylovMethod::BiCGStab, KrylovMethod::Direct })
  {
    for (const Preconditioner preconditioner : preconditioners)
    {
      TAUTLINE_LET(SolverOptions, options, method = method, preconditioner = preconditioner);
      const Context context(nameOf(options));
      const Result result = solved(systemOf(one), options, b);
      TAUTLINE_CHECK(converged(result.solution.reason));
      TAUTLINE_CHECK_NEAR(result.x[0], 0.5, 1e-14);
    }
  }
}
}
