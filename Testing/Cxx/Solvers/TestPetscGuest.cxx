// SPDX-License-Identifier: BSD-3-Clause
// Linear solvers as guests of a program that uses PETSc itself: it initializes PETSc first, with
// arguments, options and an error handler, ends it while solvers exist, and ends MPI.
#include "Registry.h"
#include "Sanitized.h"
#include "Systems.h"
#include "tautline/Solvers/ConditionEstimate.h"

#include <memory>
#include <petscksp.h>

using namespace tautline;

namespace
{
const SparseMatrix matrix = laplacian(20);

LinearSystem theSystem()
{
  return TAUTLINE_CHANGED(LinearSystem(), matrix = &matrix);
}

std::vector<double> solved()
{
  const std::vector<double> b = someVector(matrix.size);
  std::vector<double> x(b.size());
  LinearSolver solver(theSystem(), {});
  TAUTLINE_CHECK(converged(solver.solve(b.data(), x.data()).reason));
  return x;
}

void checkCondition()
{
  TAUTLINE_CHECK_RELATIVE(estimateCondition(theSystem(), {}).condition,
    laplacianEigenvalue(20, 20, 20) / laplacianEigenvalue(20, 1, 1), 1e-3);
}

int errors = 0;
PetscErrorCode hostsHandler(
  MPI_Comm, int, const char*, const char*, PetscErrorCode code, PetscErrorType, const char*, void*)
{
  ++errors;
  return code;
}
}

TAUTLINE_TEST(TestPetscGuest)
{
  MPI_Init(nullptr, nullptr);
  char name[] = "host", option[] = "-ksp_type", value[] = "gmres", other[] = "-pc_type",
       none[] = "none";
  char* list[] = { name, option, value, other, none, nullptr };
  char** arguments = list;
  int count = 5;
  PetscInitialize(&count, &arguments, nullptr, nullptr);
  PetscPushErrorHandler(hostsHandler, nullptr);
  KSP before = nullptr, after = nullptr;
  KSPCreate(PETSC_COMM_WORLD, &before);

  const std::vector<double> x = solved();
  TAUTLINE_RUN(checkCondition());
  TAUTLINE_LET(SolverOptions, wrong, petscOptions = "-ksp_type none of these");
  TAUTLINE_CHECK_THROWS(LinearSolver(theSystem(), wrong), wording("none-of-these"));
  TAUTLINE_CHECK_EQUAL(errors, 0);

  // The host's solvers keep their options.
  KSPCreate(PETSC_COMM_WORLD, &after);
  for (KSP solver : { before, after })
  {
    KSPType type = nullptr;
    KSPSetFromOptions(solver);
    KSPGetType(solver, &type);
    TAUTLINE_CHECK_EQUAL(std::string(type), std::string(KSPGMRES));
  }
  KSPDestroy(&before);
  KSPDestroy(&after);
  KSPCreate(PETSC_COMM_WORLD, &after);
  KSPSetType(after, "no such type");
  TAUTLINE_CHECK(errors > 0);
  KSPDestroy(&after);

  // The host ends PETSc: an older solver reports an error, a new one starts PETSc again.
  // Nothing can free what the older solver has in PETSc.
  std::unique_ptr<LinearSolver> old;
  {
    const LeakAllowed beyondPetsc;
    old = std::make_unique<LinearSolver>(theSystem(), SolverOptions());
    old->setUp();
  }
  PetscPopErrorHandler();
  PetscFinalize();
  std::vector<double> y(x.size());
  TAUTLINE_CHECK_THROWS(old->solve(x.data(), y.data()), wording("shut-down-petsc"));
  TAUTLINE_CHECK(solved() == x);
  TAUTLINE_RUN(checkCondition());
  TAUTLINE_CHECK_THROWS(old->setUp(), wording("shut-down-petsc"));
  old.reset();
  TAUTLINE_CHECK(solved() == x);

  // The host ends MPI.
  std::unique_ptr<LinearSolver> last;
  {
    const LeakAllowed beyondMpi;
    last = std::make_unique<LinearSolver>(theSystem(), SolverOptions());
  }
  MPI_Finalize();
  TAUTLINE_CHECK_THROWS(solved(), wording("mpi-has-been-shut-down"));
  TAUTLINE_CHECK_THROWS(estimateCondition(theSystem(), {}), wording("mpi-has-been-shut-down"));
  last.reset();
}
