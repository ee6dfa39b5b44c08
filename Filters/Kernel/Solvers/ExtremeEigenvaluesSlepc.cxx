// SPDX-License-Identifier: BSD-3-Clause
#include "ExtremeEigenvalues.h"

#include <slepceps.h>

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
using PetscEigensolver = PetscHandle<EPS, EPSDestroy>;

/// The number of unknowns up to which a factorization is cheaper than an iterative method: for
/// planar problems, with few neighbors, and for others.
constexpr PetscInt PlanarFactorLimit = 400000, SpatialFactorLimit = 30000;
/// A problem is treated as planar up to this mean number of neighbors of a point, including itself.
constexpr double PlanarNeighbours = 11.0;

// number of vectors that Krylov-Schur keeps for the largest eigenvalue
constexpr PetscInt LargestBasis = 40;
constexpr PetscInt Block = 4; // number of vectors in LOBPCG iterations

/// With a factorization, iterations are cheap, but the error bound uses the residual of A x, which
/// is larger than the residual of A^-1 x: use the tolerance times this, but at least the minimum.
constexpr double FactoredTolerance = 1e-4, LeastTolerance = 1e-12;

bool isFactorAffordable(Mat matrix, int blockSize)
{
  PetscInt rows = 0;
  MatInfo info;
  petsc(MatGetSize(matrix, &rows, nullptr));
  petsc(MatGetInfo(matrix, MAT_GLOBAL_SUM, &info));
  const double neighbours = info.nz_used / rows / blockSize;
  return rows <= (neighbours <= PlanarNeighbours ? PlanarFactorLimit : SpatialFactorLimit);
}

/// Between restarts: SLEPc's own test, then the limits of the options.
PetscErrorCode testStopping(EPS solver, PetscInt iteration, PetscInt maximum, PetscInt found,
  PetscInt requested, EPSConvergedReason* reason, void* context)
{
  auto& test = *static_cast<EigensolverStoppingTest*>(context);
  const PetscErrorCode code =
    EPSStoppingBasic(solver, iteration, maximum, found, requested, reason, nullptr);
  if (code == 0 && *reason == EPS_CONVERGED_ITERATING &&
    test.stop(static_cast<double>(iteration) / (iteration + 20.0)))
  {
    *reason = EPS_CONVERGED_USER;
  }
  return code;
}

void create(Mat matrix, const ConditionOptions& options, EigensolverStoppingTest& test,
  PetscInt requested, PetscEigensolver& solver)
{
  MPI_Comm comm = MPI_COMM_NULL;
  PetscVector start;
  petsc(PetscObjectGetComm(reinterpret_cast<PetscObject>(matrix), &comm));
  petsc(EPSCreate(comm, solver.out()));
  petsc(EPSSetOperators(solver, matrix, nullptr));
  petsc(EPSSetProblemType(solver, EPS_HEP));
  petsc(EPSSetDimensions(solver, requested, PETSC_DEFAULT, PETSC_DEFAULT));
  petsc(EPSSetTolerances(solver, options.tolerance, options.maximumIterations));
  petsc(EPSSetStoppingTestFunction(solver, testStopping, &test, nullptr));
  petsc(MatCreateVecs(matrix, start.out(), nullptr));
  fillStartVector(start);
  Vec list[] = { start };
  petsc(EPSSetInitialSpace(solver, 1, list));
}

/**
 * @brief The extreme eigenpair, with the error bound from its residual. In addition to the smallest
 * eigenvalue, the next one has also converged, and the distance between them sharpens the bound
 * (Kato-Temple): otherwise, rounding would hide a small eigenvalue next to a large one.
 */
void collect(Mat matrix, EPS solver, bool smallest, ExtremeEigenvalue& extreme)
{
  PetscInt found = 0, iterations = 0;
  petsc(EPSGetConverged(solver, &found));
  petsc(EPSGetIterationNumber(solver, &iterations));
  extreme.iterations = static_cast<int>(iterations);
  if (found == 0)
  {
    extreme.message = "Not converged after " + std::to_string(iterations) + " iterations.";
    return;
  }
  PetscVector x, r;
  petsc(MatCreateVecs(matrix, x.out(), r.out()));
  PetscInt best = 0;
  std::vector<double> values(static_cast<std::size_t>(found));
  for (PetscInt i = 0; i < found; ++i)
  {
    petsc(EPSGetEigenvalue(solver, i, &values[i], nullptr));
    best = (smallest ? values[i] < values[best] : values[i] > values[best]) ? i : best;
  }
  PetscReal length = 0.0;
  petsc(EPSGetEigenvector(solver, best, x, nullptr));
  // The Rayleigh quotient and its residual refer to the matrix itself, also after a spectral
  // transformation.
  petsc(VecNormalize(x, nullptr));
  petsc(MatMult(matrix, x, r));
  petsc(VecDot(x, r, &extreme.value));
  petsc(VecAXPY(r, -extreme.value, x));
  petsc(VecNorm(r, NORM_2, &length));
  double gap = std::numeric_limits<double>::infinity();
  for (PetscInt i = 0; i < found; ++i)
  {
    gap = i == best ? gap : std::min(gap, std::abs(values[i] - extreme.value));
  }
  extreme.bound = smallest && found > 1 && gap > length ? length * length / gap : length;
  extreme.found = std::isfinite(extreme.value) && std::isfinite(extreme.bound);
  extreme.vector = std::move(x);
}

/// Runs a solver; a failure of SLEPc, or of a library below, becomes a message.
template <class Call>
void attempt(ExtremeEigenvalue& extreme, const PetscOptionSet& options, const Call& call)
{
  try
  {
    call();
  }
  catch (const PetscError& error)
  {
    extreme.message = options.explain(error, "Method = accurate");
  }
}
}

//------------------------------------------------------------------------------
ExtremeEigenvalue slepcLargestEigenvalue(Mat matrix, const ConditionOptions& options,
  PetscOptionSet& optionSet, EigensolverStoppingTest& test)
{
  ensureSlepc();
  ExtremeEigenvalue extreme;
  extreme.method = "Krylov-Schur";
  PetscInt rows = 0;
  petsc(MatGetSize(matrix, &rows, nullptr));
  attempt(extreme, optionSet,
    [&]()
    {
      PetscEigensolver solver;
      create(matrix, options, test, 1, solver);
      petsc(EPSSetType(solver, EPSKRYLOVSCHUR));
      petsc(EPSSetWhichEigenpairs(solver, EPS_LARGEST_REAL));
      petsc(EPSSetDimensions(solver, 1, std::min(LargestBasis, rows), PETSC_DEFAULT));
      optionSet.read([&]() { petsc(EPSSetFromOptions(solver)); });
      petsc(EPSSolve(solver));
      collect(matrix, solver, false, extreme);
    });
  return extreme;
}

ExtremeEigenvalues slepcExtremeEigenvalues(Mat matrix, const LinearSystem& system, int ranks,
  const ConditionOptions& options, PetscOptionSet& optionSet, EigensolverStoppingTest& test)
{
  ExtremeEigenvalues extremes;
  PetscInt rows = 0;
  petsc(MatGetSize(matrix, &rows, nullptr));
  test.stage(0.0, 0.4);
  extremes.largest = slepcLargestEigenvalue(matrix, options, optionSet, test);

  ExtremeEigenvalue& low = extremes.smallest;
  const bool factorize = isFactorAffordable(matrix, system.blockSize);
  PetscInt negative = 0;
  test.stage(0.4, 1.0);
  attempt(low, optionSet,
    [&]()
    {
      PetscEigensolver solver;
      ST transformation = nullptr;
      KSP inner = nullptr;
      PC pc = nullptr;
      // Two eigenvalues are requested, because the distance between them sharpens the error bound.
      create(matrix, options, test, std::min<PetscInt>(2, rows), solver);
      petsc(EPSGetST(solver, &transformation));
      if (factorize)
      {
        // MUMPS counts negative pivots (Sylvester): if there are none, the smallest eigenvalue is
        // the one nearest to 0.
        LinearSystem symmetric = system;
        symmetric.symmetric = true;
        symmetric.positiveDefinite = false;
        // The eigenvalues of A nearest to 0 are the largest of A^-1.
        petsc(EPSSetType(solver, EPSKRYLOVSCHUR));
        petsc(STSetType(transformation, STSINVERT));
        petsc(EPSSetTarget(solver, 0.0));
        petsc(EPSSetWhichEigenpairs(solver, EPS_TARGET_MAGNITUDE));
        petsc(STGetKSP(transformation, &inner));
        petsc(KSPSetType(inner, KSPPREONLY));
        petsc(KSPGetPC(inner, &pc));
        petsc(
          EPSSetTolerances(solver, std::max(FactoredTolerance * options.tolerance, LeastTolerance),
            options.maximumIterations));
        const std::string package = chooseFactorization(pc, symmetric, ranks, optionSet, "st_");
        // otherwise, several ranks do not count pivots
        optionSet.setDefault("-st_mat_mumps_icntl_13", "1");
        low.method = "Krylov-Schur, shift-invert (Cholesky by " + package + ")";
      }
      else
      {
        // A matrix that is too large to factorize: LOBPCG only needs products and a preconditioner.
        petsc(EPSSetType(solver, EPSLOBPCG));
        petsc(EPSLOBPCGSetBlockSize(solver, std::min(Block, rows)));
        petsc(EPSSetWhichEigenpairs(solver, EPS_SMALLEST_REAL));
        petsc(STSetType(transformation, STPRECOND));
        petsc(STGetKSP(transformation, &inner));
        petsc(KSPSetType(inner, KSPPREONLY));
        petsc(KSPGetPC(inner, &pc));
        petsc(PCSetType(pc, PCHYPRE));
        petsc(PCHYPRESetType(pc, "boomeramg"));
        low.method = "LOBPCG, preconditioned by BoomerAMG";
      }
      optionSet.read([&]() { petsc(EPSSetFromOptions(solver)); });
      petsc(EPSSetUp(solver));
      // Inner solvers read their options during the setup.
      optionSet.rejectUnused(true);
      petsc(EPSSolve(solver));
      if (factorize)
      {
        Mat factor = nullptr;
        petsc(PCFactorGetMatrix(pc, &factor));
        petsc(MatGetInertia(factor, &negative, nullptr, nullptr));
      }
      collect(matrix, solver, true, low);
    });
  if (negative > 0)
  {
    low.found = false;
    low.message = "The matrix is not positive definite: " + std::to_string(negative) +
      " of its eigenvalues are negative.";
  }
  return extremes;
}
}
