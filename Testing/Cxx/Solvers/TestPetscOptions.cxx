// SPDX-License-Identifier: BSD-3-Clause
// PETSc options given as text: what is permitted, what is rejected before PETSc sees it, files that
// nothing reads or writes, and every method and preconditioner that this PETSc has.
#include "Registry.h"
#include "Systems.h"
#include "tautline/Solvers/ConditionEstimate.h"

#include <cstdio>
#include <fstream>
#include <petscksp.h>
#include <unistd.h>

using namespace tautline;

namespace
{
std::string directory; // to write to

bool exists(const std::string& file)
{
  return std::ifstream(file).good();
}

/// The error of a solver with these options; "" if there is none.
std::string errorOf(const std::string& text, const SparseMatrix& matrix)
{
  TAUTLINE_LET(
    SolverOptions, options, preconditioner = Preconditioner::Jacobi, petscOptions = text);
  const std::vector<double> b = someVector(matrix.size);
  std::vector<double> x(b.size());
  try
  {
    LinearSolver solver(systemOf(matrix), options);
    solver.solve(b.data(), x.data());
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return "";
}

//------------------------------------------------------------------------------
void testRejected()
{
  const SparseMatrix a = laplacian(8);
  const std::string file = directory + "/petsc_wrote_this.txt";
  std::remove(file.c_str());
  const std::vector<std::string> rejected = { "-ksp_view ascii:" + file,
    "-ksp_view ascii:" + file + "::append", "-ksp_view binary:" + file, "-ksp_view hdf5:" + file,
    "-ksp_view_mat ascii:" + file, "-ksp_view_solution ascii:" + file,
    "-ksp_view_rhs ascii:" + file, "-ksp_view_pre ascii:" + file,
    "-ksp_view_eigenvalues ascii:" + file, "-ksp_monitor ascii:" + file,
    "-ksp_monitor_true_residual ascii:" + file, "-ksp_monitor_python " + file,
    "-ksp_converged_reason ascii:" + file, "-ksp_converged_rate ascii:" + file,
    "-ksp_error_if_not_converged", "-pc_view ascii:" + file, "-mat_view ascii:" + file,
    "-vec_view ascii:" + file, "-mat_view_info", "-eps_view ascii:" + file,
    "-eps_monitor ascii:" + file, "-st_pc_view ascii:" + file, "-mg_levels_ksp_view ascii:" + file,
    "-sub_ksp_monitor ascii:" + file, "-options_file " + file, "-options_file_yaml " + file,
    "-options_string_yaml {a:1}", "-prefix_push ksp_", "-options_left",
    "-options_view ascii:" + file, "-options_monitor", "-help", "-h", "-version", "-info " + file,
    "-log_view ascii:" + file, "-log_trace " + file, "-history " + file, "-malloc_dump",
    "-malloc_debug", "-memory_view", "-start_in_debugger", "-on_error_attach_debugger",
    "-on_error_abort", "-fp_trap", "-dll_prepend /tmp/lib.so", "-dll_append /tmp/lib.so",
    "-python /tmp/lib.so", "-pc_shell_name x", "-pc_python_type module.Class",
    "-ksp_python_type module.Class", "-mat_mumps_icntl_1 6", "-mat_mumps_icntl_3 6",
    "-mat_mumps_icntl_22 1", "-mat_mumps_ooc_tmpdir /tmp", "-pc_mg_dump_binary",
    "-pc_hypre_boomeramg_print_statistics", "-nox", "-on_error_malloc_dump", "-cuda_device 0",
    "-mpi_linear_solver_server", "-matload_block_size 2", "--ksp_rtol 1e-3",
    "-KSP_VIEW ascii:" + file };
  for (const std::string& option : rejected)
  {
    const Context context(option);
    const std::string error = errorOf(option, a);
    TAUTLINE_CHECK(contains(error, option.substr(0, option.find(' '))));
    TAUTLINE_CHECK(contains(error, wording("not-permitted")));
    TAUTLINE_CHECK(contains(error, "-ksp_..."));
    // The condition estimate reads the same options.
    TAUTLINE_LET(ConditionOptions, condition, petscOptions = option);
    TAUTLINE_CHECK_THROWS(estimateCondition(systemOf(a), condition), wording("not-permitted"));
  }
  TAUTLINE_CHECK(!exists(file));

  // Values cannot be files, programs or out of range.
  const std::vector<std::string> impossible = { "-ksp_type python", "-ksp_type lmvm",
    "-ksp_type chebyshev", "-ksp_type hpddm", "-ksp_type ./lib.so:create", "-pc_type python",
    "-pc_type shell", "-pc_type mg", "-pc_type lmvm", "-pc_type hpddm", "-pc_type", "-ksp_rtol",
    "-ksp_rtol nan", "-ksp_rtol inf", "-ksp_rtol 0x1p-3", "-ksp_rtol 2", "-ksp_max_it -3",
    "-ksp_max_it 1.5", "-ksp_max_it 99999999999", "-ksp_diagonal_scale /etc/passwd",
    "-pc_factor_mat_solver_type /tmp/lib.so", "-pc_jacobi_type ascii:" + file, "-sub_pc_type shell",
    "-mg_levels_2_pc_type python", "-mg_levels_ksp_max_it 1000000000", "-pc_sor_its 1000000000",
    "-ksp_chebyshev_eigenvalues 1,two", "-pc_hypre_boomeramg_coarsen_type nonsense" };
  for (const std::string& option : impossible)
  {
    const Context context(option);
    const std::string error = errorOf(option, a);
    TAUTLINE_CHECK(contains(error, option.substr(0, option.find(' '))));
    TAUTLINE_CHECK(contains(error, wording("possible-is")));
  }
  TAUTLINE_CHECK(contains(errorOf("-pc_type python", a), "jacobi"));
  TAUTLINE_CHECK(contains(errorOf("-ksp_rtoll 1e-3", a), wording("did-you-mean-ksp-rtol")));
  TAUTLINE_CHECK(contains(errorOf("-ksp_gmres_rstart 5", a), "-ksp_gmres_restart"));
  TAUTLINE_CHECK(contains(errorOf("-pc_sor_nonsense_at_all 1", a), "-pc_sor_omega"));

  // An options file is not even read: its content does not come back in the error.
  std::ofstream(file) << "thesecret content of a file\n";
  const std::string error = errorOf("-options_file " + file, a);
  TAUTLINE_CHECK(contains(error, "-options_file"));
  TAUTLINE_CHECK(!contains(error, "thesecret"));
  std::remove(file.c_str());
}

/// .petscrc of the working directory and options in the environment do not reach our solvers.
void testSurroundings()
{
  char before[4096];
  TAUTLINE_CHECK(getcwd(before, sizeof(before)) != nullptr);
  TAUTLINE_CHECK_EQUAL(chdir(directory.c_str()), 0);
  for (const char* name : { ".petscrc", "petscrc" })
  {
    std::ofstream(name) << "-ksp_max_it 1\n-fromfile 1\n";
  }
  setenv("PETSC_OPTIONS", "-ksp_max_it 2 -pc_type none", 1);
  const SparseMatrix a = laplacian(20);
  const std::vector<double> b = someVector(a.size);
  std::vector<double> x(b.size());
  LinearSolver solver(systemOf(a), {});
  const LinearSolution solution = solver.solve(b.data(), x.data());
  TAUTLINE_CHECK(converged(solution.reason));
  TAUTLINE_CHECK(solution.iterations > 2);
  TAUTLINE_CHECK(relativeResidual(a, x, b) < 1e-3);
  PetscBool found = PETSC_TRUE;
  PetscOptionsHasName(nullptr, nullptr, "-fromfile", &found);
  TAUTLINE_CHECK(!found);
  std::remove(".petscrc");
  std::remove("petscrc");
  unsetenv("PETSC_OPTIONS");
  TAUTLINE_CHECK_EQUAL(chdir(before), 0);
}

//------------------------------------------------------------------------------
std::vector<std::string> namesIn(PetscFunctionList list)
{
  const char** names = nullptr;
  int count = 0;
  PetscFunctionListGet(list, &names, &count);
  std::vector<std::string> all;
  for (int i = 0; i < count && names[i]; ++i)
  {
    all.emplace_back(names[i]);
  }
  PetscFree(names);
  return all;
}

/// The outcome of one choice.
enum class Outcome
{
  Rejected,
  Failed, // with a reason, or an error
  Solved
};

/// Solves; whatever claims to have converged has, by the test's own product.
Outcome attempt(
  const LinearSystem& system, const std::string& text, SolverOptions options, const std::string& of)
{
  const Context context(text);
  if (std::getenv("TAUTLINE_TEST_VERBOSE"))
  {
    std::cerr << text << std::endl; // a crash ends the test before anything else is printed
  }
  const SparseMatrix& a = *system.matrix;
  const std::vector<double> b = someVector(a.size);
  std::vector<double> x(b.size(), 0.0);
  TAUTLINE_SET(options, petscOptions = text, maximumIterations = 2000, maximumSeconds = 20.0);
  LinearSolution solution;
  try
  {
    LinearSolver solver(system, options);
    solution = solver.solve(b.data(), x.data());
  }
  catch (const Error& error)
  {
    TAUTLINE_CHECK(contains(error.what(), of));
    return contains(error.what(), wording("possible-is")) ? Outcome::Rejected : Outcome::Failed;
  }
  TAUTLINE_EACH_OF(const double value, x, TAUTLINE_CHECK(std::isfinite(value)));
  const double residual = relativeResidual(a, x, b);
  if (converged(solution.reason))
  {
    TAUTLINE_CHECK(residual <= ResidualFactor * options.relativeTolerance);
    TAUTLINE_CHECK_NEAR(solution.trueResidual, residual, 1e-12 + 1e-6 * residual);
    return Outcome::Solved;
  }
  TAUTLINE_CHECK(solution.reason != SolveReason::TimeLimit);
  return Outcome::Failed;
}

/// All registered ones, including those that a user may not choose.
void testEveryType()
{
  const SparseMatrix a = laplacian(12), indefinite = laplacian(12, 1.0, -2.1);
  LinearSystem shifted = TAUTLINE_CHANGED(systemOf(indefinite), positiveDefinite = false);
  int solved = 0, rejected = 0;
  for (const std::string& type : namesIn(KSPList))
  {
    bool any = false, none = true;
    for (const Preconditioner preconditioner :
      { Preconditioner::None, Preconditioner::Jacobi, Preconditioner::ILU, Preconditioner::GAMG })
    {
      TAUTLINE_LET(SolverOptions, options, preconditioner = preconditioner);
      const std::string text = "-ksp_type " + type;
      const Outcome outcome = attempt(systemOf(a), text, options, "-ksp_type");
      any = any || outcome == Outcome::Solved;
      none = none && outcome == Outcome::Rejected;
      attempt(shifted, text, options, "-ksp_type");
    }
    // A permitted method solves this with some preconditioner.
    TAUTLINE_CHECK_EQUAL(
      any || type == "preonly" ? "solves" : type, none ? type : std::string("solves"));
    solved += any;
    rejected += none;
  }
  TAUTLINE_CHECK(solved >= 25);
  TAUTLINE_CHECK(rejected >= 5);
  solved = rejected = 0;
  for (const std::string& type : namesIn(PCList))
  {
    bool any = false, none = true;
    for (const char* method : { "cg", "gmres", "preonly", "bcgs" })
    {
      for (const int block : { 1, 2 })
      {
        LinearSystem system = TAUTLINE_CHANGED(systemOf(a), blockSize = block);
        const std::string text = "-pc_type " + type + " -ksp_type " + method;
        const Outcome outcome = attempt(system, text, {}, "-pc_type");
        any = any || outcome == Outcome::Solved;
        none = none && outcome == Outcome::Rejected;
      }
    }
    TAUTLINE_CHECK_EQUAL(any ? "solves" : type, none ? type : std::string("solves"));
    solved += any;
    rejected += none;
  }
  TAUTLINE_CHECK(solved >= 15);
  TAUTLINE_CHECK(rejected >= 10);
}

/// Errors speak of the user's choice, not of options that nobody gave.
void testWording()
{
  const int n = 12;
  SparseMatrix empty = laplacian(n);
  for (Index row = 0; row < empty.size; ++row)
  {
    for (Index k = empty.offsets[row]; k < empty.offsets[row + 1]; ++k)
    {
      empty.values[k] = row == 30 || empty.columns[k] == 30 ? 0.0 : empty.values[k];
    }
  }
  const std::vector<double> b = someVector(empty.size);
  int failed = 0;
  for (const bool definite : { true, false })
  {
    for (int choice = 0; choice <= static_cast<int>(Preconditioner::None) + 1; ++choice)
    {
      LinearSystem system = TAUTLINE_CHANGED(systemOf(empty), positiveDefinite = definite);
      SolverOptions options;
      const bool direct = choice > static_cast<int>(Preconditioner::None);
      TAUTLINE_SET(options, method = direct ? KrylovMethod::Direct : KrylovMethod::GMRES,
        preconditioner = direct ? Preconditioner::None : static_cast<Preconditioner>(choice),
        maximumIterations = 200, defaultPetscOptions = fastMultigridOptions());
      std::vector<double> x(b.size());
      LinearSolver solver(system, options);
      const LinearSolution solution = solver.solve(b.data(), x.data());
      const Context context(std::string(nameOf(options.preconditioner)) + ": " + solution.message);
      TAUTLINE_CHECK(!converged(solution.reason));
      for (const char* foreign : { " -pc_", " -mat_", " -ksp_", "configure", "boomeramg" })
      {
        TAUTLINE_CHECK(!contains(solution.message, foreign));
      }
      failed += solution.reason == SolveReason::PreconditionerFailed;
    }
  }
  TAUTLINE_CHECK(failed >= 8);

  // With an option of the user, the error of PETSc is added.
  TAUTLINE_LET(SolverOptions, options, petscOptions = "-pc_type lu -pc_factor_mat_solver_type klu");
  LinearSystem system = TAUTLINE_CHANGED(systemOf(empty), positiveDefinite = false);
  std::vector<double> x(b.size());
  LinearSolver solver(system, options);
  const LinearSolution solution = solver.solve(b.data(), x.data());
  TAUTLINE_CHECK(!converged(solution.reason));
  TAUTLINE_CHECK(!solution.message.empty());
}

/// Split by component where each point has several unknowns, otherwise an error that states the
/// reason.
void testFieldSplit()
{
  const SparseMatrix a = laplacian(12);
  const std::string text = "-pc_type fieldsplit -pc_fieldsplit_type multiplicative "
                           "-fieldsplit_0_pc_type ilu -fieldsplit_1_ksp_type preonly "
                           "-fieldsplit_1_pc_type jacobi -ksp_type gmres";
  LinearSystem system = TAUTLINE_CHANGED(systemOf(a), blockSize = 2);
  TAUTLINE_CHECK(attempt(system, text, {}, "-pc_type") == Outcome::Solved);
  const std::string error = errorOf("-pc_type fieldsplit", a);
  TAUTLINE_CHECK(contains(error, wording("one-unknown-per-point")));
  TAUTLINE_CHECK(contains(error, wording("pc-type-fieldsplit")));
  for (const char* rejected : { "-fieldsplit_0_pc_view ascii:x", "-fieldsplit_0_pc_type python",
         "-pc_fieldsplit_block_size 3", "-pc_fieldsplit_type schur" })
  {
    const Context context(rejected);
    TAUTLINE_CHECK(attempt(system, rejected, {}, "The PETSc option") != Outcome::Solved);
  }
}

/// Methods that stop without a solution, though PETSc calls that convergence.
void testFalseConvergence()
{
  const SparseMatrix a = laplacian(40);
  for (const char* text :
    { "-ksp_type preonly", "-ksp_convergence_test skip -ksp_max_it 3",
      "-ksp_norm_type none -ksp_max_it 3", "-ksp_rtol 1e-7 -ksp_converged_maxits -ksp_max_it 5" })
  {
    const Context context(text);
    TAUTLINE_LET(
      SolverOptions, options, preconditioner = Preconditioner::Jacobi, petscOptions = text);
    const std::vector<double> b = someVector(a.size);
    std::vector<double> x(b.size());
    LinearSolver solver(systemOf(a), options);
    const LinearSolution solution = solver.solve(b.data(), x.data());
    // Without a norm, the limit of iterations is all that ends the method.
    const bool limited = contains(text, wording("norm-type-none"));
    TAUTLINE_CHECK(
      solution.reason == (limited ? SolveReason::IterationLimit : SolveReason::FalseConvergence));
    TAUTLINE_CHECK(limited || contains(solution.message, "residual"));
    TAUTLINE_CHECK_RELATIVE(solution.trueResidual, relativeResidual(a, x, b), 1e-10);
  }
  // A system scaled while it is solved is verified unscaled, and stays as it was.
  for (const char* text : { "-ksp_diagonal_scale", "-KSP_Diagonal_Scale" })
  {
    const Context context(text);
    SparseMatrix uneven = gridMatrix(40, [](int i, int j) { return i == j ? 4.0 + i % 7 : -1.0; });
    const std::vector<double> before = uneven.values;
    TAUTLINE_LET(
      SolverOptions, options, preconditioner = Preconditioner::Jacobi, petscOptions = text);
    const std::vector<double> b = someVector(uneven.size);
    std::vector<double> x(b.size());
    LinearSolver solver(systemOf(uneven), options);
    const LinearSolution solution = solver.solve(b.data(), x.data());
    TAUTLINE_CHECK_RELATIVE(solution.trueResidual, relativeResidual(uneven, x, b), 1e-10);
    TAUTLINE_CHECK(!converged(solution.reason) || relativeResidual(uneven, x, b) < 1e-2);
    TAUTLINE_CHECK(uneven.values == before);
  }
}

/// However a solve ends, the residual belongs to the returned solution.
void testResidualsOfFailures()
{
  struct Case
  {
    const char* text;
    double last; // diagonal entry of the last row
    SolveReason reason;
  };
  const Case cases[] = { { "", 0.0, SolveReason::PreconditionerFailed }, // set-up
    { "-pc_type ilu -pc_factor_shift_type none", 0.0, SolveReason::PreconditionerFailed },
    { "-ksp_type richardson -ksp_richardson_scale 1e200 -ksp_divtol 1e308", 4.0,
      SolveReason::NotANumber },
    { "-ksp_type richardson -ksp_richardson_scale 1e30", 4.0, SolveReason::Diverged },
    { "-ksp_max_it 2", 4.0, SolveReason::IterationLimit } };
  constexpr int size = 6;
  for (const Case& failure : cases)
  {
    for (const bool guess : { false, true })
    {
      const Context context(failure.text);
      const SparseMatrix a = gridMatrix(size,
        [&](int i, int j) { return i != j            ? -1.0
                              : i + 1 == size * size ? failure.last
                                                     : 4.0; });
      const std::vector<double> b = someVector(a.size);
      std::vector<double> x(b.size(), 1.0);
      TAUTLINE_LET(SolverOptions, options, preconditioner = Preconditioner::Jacobi,
        petscOptions = failure.text, initialGuess = guess);
      LinearSolver solver(systemOf(a), options);
      for (int i = 0; i < 2; ++i)
      {
        const LinearSolution solution = solver.solve(b.data(), x.data());
        TAUTLINE_CHECK(solution.reason == failure.reason);
        TAUTLINE_CHECK(solution.trueResidual > 0.0);
        TAUTLINE_CHECK_RELATIVE(solution.trueResidual, relativeResidual(a, x, b), 1e-10);
      }
    }
  }
}
}

TAUTLINE_TEST(TestPetscOptions)
{
  directory = argv[2];
  TAUTLINE_RUN(testSurroundings()); // before PETSc is initialized
  TAUTLINE_RUN(testRejected());
  TAUTLINE_RUN(testEveryType());
  TAUTLINE_RUN(testFieldSplit());
  TAUTLINE_RUN(testWording());
  TAUTLINE_RUN(testFalseConvergence());
  TAUTLINE_RUN(testResidualsOfFailures());
}
