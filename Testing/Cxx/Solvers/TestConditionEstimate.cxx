// SPDX-License-Identifier: BSD-3-Clause
// Extreme eigenvalues and condition numbers of A and of P^-1 A: known values, dense eigenvalues,
// bounds that hold, limits and matrices that have no condition number.
#include "Registry.h"
#include "Systems.h"
#include "tautline/Elliptic/ElementContributions.h"
#include "tautline/Solvers/ConditionEstimate.h"

#include <Eigen/Dense>
#include <limits>
#include <petscksp.h>

using namespace tautline;

namespace
{
using Dense = Eigen::MatrixXd;

constexpr Preconditioner preconditioners[] = { Preconditioner::None, Preconditioner::Jacobi,
  Preconditioner::SSOR, Preconditioner::ILU, Preconditioner::ICC, Preconditioner::BoomerAMG,
  Preconditioner::GAMG };

Dense denseOf(const SparseMatrix& a)
{
  Dense dense = Dense::Zero(a.size, a.size);
  for (Index i = 0; i < a.size; ++i)
  {
    for (Index k = a.offsets[i]; k < a.offsets[i + 1]; ++k)
    {
      dense(i, a.columns[k]) = a.values[k];
    }
  }
  return dense;
}

/// P^-1 column by column, by PETSc's own preconditioner.
Dense inverseOf(Preconditioner preconditioner, const Dense& a, int blockSize)
{
  const auto n = static_cast<PetscInt>(a.rows());
  const char* types[] = { PCJACOBI, PCSOR, PCILU, PCHYPRE, PCICC, PCGAMG, PCNONE };
  Mat matrix = nullptr;
  PC pc = nullptr;
  Vec e = nullptr, z = nullptr;
  MatCreateSeqAIJ(PETSC_COMM_SELF, n, n, n, nullptr, &matrix);
  MatSetBlockSize(matrix, blockSize);
  for (PetscInt i = 0; i < n; ++i)
  {
    for (PetscInt j = 0; j < n; ++j)
    {
      if (a(i, j) != 0.0 || i == j)
      {
        MatSetValue(matrix, i, j, a(i, j), INSERT_VALUES);
      }
    }
  }
  MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY);
  MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY);
  MatSetOption(matrix, MAT_SPD, PETSC_TRUE);
  PCCreate(PETSC_COMM_SELF, &pc);
  PCSetOperators(pc, matrix, matrix);
  PCSetType(pc, types[static_cast<int>(preconditioner)]);
  PCSetFromOptions(pc);
  PCSetUp(pc);
  MatCreateVecs(matrix, &e, &z);
  Dense inverse(n, n);
  for (PetscInt j = 0; j < n; ++j)
  {
    const double* values = nullptr;
    VecSet(e, 0.0);
    VecSetValue(e, j, 1.0, INSERT_VALUES);
    VecAssemblyBegin(e);
    VecAssemblyEnd(e);
    PCApply(pc, e, z);
    VecGetArrayRead(z, &values);
    for (PetscInt i = 0; i < n; ++i)
    {
      inverse(i, j) = values[i];
    }
    VecRestoreArrayRead(z, &values);
  }
  VecDestroy(&e);
  VecDestroy(&z);
  PCDestroy(&pc);
  MatDestroy(&matrix);
  return inverse;
}

/// Smallest and largest eigenvalue of P^-1 A, dense.
std::array<double, 2> denseEnds(const Dense& a, const Dense& inverse)
{
  // L^T P^-1 L with A = L L^T has the same eigenvalues.
  const Dense lower = a.llt().matrixL();
  const Dense product = lower.transpose() * (0.5 * (inverse + inverse.transpose())) * lower;
  const Eigen::SelfAdjointEigenSolver<Dense> solver(product, Eigen::EigenvaluesOnly);
  return { solver.eigenvalues()(0), solver.eigenvalues()(a.rows() - 1) };
}

/// Both values to the requested tolerance, with bounds that hold.
void checkEnds(const ConditionEstimate& estimate, double smallest, double largest, double tolerance)
{
  TAUTLINE_CHECK(estimate.converged);
  TAUTLINE_CHECK_EQUAL(estimate.message, std::string());
  TAUTLINE_CHECK(estimate.smallestError <= tolerance && estimate.largestError <= tolerance);
  constexpr double rounding = 1e-10;
  TAUTLINE_CHECK_RELATIVE(estimate.smallest, smallest, estimate.smallestError + rounding);
  TAUTLINE_CHECK_RELATIVE(estimate.largest, largest, estimate.largestError + rounding);
  TAUTLINE_CHECK_RELATIVE(estimate.condition, largest / smallest, 2.1 * tolerance);
  TAUTLINE_CHECK(!estimate.method.empty() && estimate.iterations > 0);
}

//------------------------------------------------------------------------------
void testKnownValues()
{
  for (const int n : { 1, 2, 3, 30 })
  {
    for (const double scale : { 1e-8, 1.0, 1e8 })
    {
      const Context context(std::to_string(n) + " scale " + std::to_string(scale));
      const SparseMatrix a = laplacian(n, scale);
      ConditionOptions options;
      const ConditionEstimate plain = estimateCondition(systemOf(a), options);
      checkEnds(plain, scale * laplacianEigenvalue(n, 1, 1), scale * laplacianEigenvalue(n, n, n),
        options.tolerance);
      TAUTLINE_CHECK(contains(plain.method, "shift-invert"));
      // The diagonal is 4 throughout.
      options.preconditioner = Preconditioner::Jacobi;
      checkEnds(estimateCondition(systemOf(a), options), laplacianEigenvalue(n, 1, 1) / 4,
        laplacianEigenvalue(n, n, n) / 4, options.tolerance);
      // The eigenvector of the smallest eigenvalue is the first mode.
      const std::vector<double>& x = plain.smallestVector;
      double along = 0.0, mode = 0.0, whole = 0.0;
      for (int i = 0; i < n * n; ++i)
      {
        const double pi = std::acos(-1.0),
                     m =
                       std::sin(pi * (i % n + 1) / (n + 1)) * std::sin(pi * (i / n + 1) / (n + 1));
        along += m * x[i];
        mode += m * m;
        whole += x[i] * x[i];
      }
      TAUTLINE_CHECK_NEAR(along * along / mode / whole, 1.0, 1e-5);
    }
  }
}

/// Every preconditioner, against dense eigenvalues.
void testDense(const LinearSystem& system, double tolerance)
{
  const Dense a = denseOf(*system.matrix);
  for (const Preconditioner preconditioner : preconditioners)
  {
    const Context context(nameOf(preconditioner));
    TAUTLINE_LET(ConditionOptions, options, preconditioner = preconditioner, tolerance = tolerance);
    const std::array<double, 2> expected =
      denseEnds(a, inverseOf(preconditioner, a, system.blockSize));
    const ConditionEstimate estimate = estimateCondition(system, options);
    checkEnds(estimate, expected[0], expected[1], tolerance);

    // Ritz values lie inside.
    options.method = SpectrumMethod::RitzValues;
    const ConditionEstimate ritz = estimateCondition(system, options);
    TAUTLINE_CHECK(
      ritz.smallest >= expected[0] * (1 - 1e-9) && ritz.largest <= expected[1] * (1 + 1e-9));
    TAUTLINE_CHECK(ritz.largest >= 0.7 * expected[1]);
    TAUTLINE_CHECK(!ritz.converged && std::isinf(ritz.smallestError) && !ritz.message.empty());
  }
}

TAUTLINE_PART(testFormulas)
{
  // SSOR: P = (D/w + L) ((2 - w)/w D)^-1 ... of an omega that is not 1.
  const SparseMatrix a = laplacian(10);
  const Dense dense = denseOf(a);
  const double omega = 1.5;
  const Dense diagonal = dense.diagonal().asDiagonal();
  const Dense lower = Dense(dense.triangularView<Eigen::StrictlyLower>()) + diagonal / omega;
  const Dense p = omega / (2 - omega) * lower * diagonal.inverse() * lower.transpose();
  const std::array<double, 2> expected = denseEnds(dense, p.inverse());
  TAUTLINE_LET(ConditionOptions, options, preconditioner = Preconditioner::SSOR, omega = omega);
  checkEnds(estimateCondition(systemOf(a), options), expected[0], expected[1], options.tolerance);
  // Options reach the preconditioner.
  TAUTLINE_SET(options, omega = 1.0, petscOptions = "-pc_sor_omega 1.5");
  checkEnds(estimateCondition(systemOf(a), options), expected[0], expected[1], options.tolerance);
}

/// A mesh of one cell type on the unit square or cube, its points moved.
struct BoxMesh
{
  std::vector<double> points;
  std::vector<Index> offsets = { 0 }, connectivity;
  std::vector<unsigned char> types;

  BoxMesh(CellType type, int n)
  {
    const bool planar = topology(type).dimension == 2;
    const int layers = planar ? 0 : n, m = n + 1;
    const std::vector<double> moves = someVector(3 * m * m * m);
    for (int k = 0; k <= layers; ++k)
    {
      for (int j = 0; j <= n; ++j)
      {
        for (int i = 0; i <= n; ++i)
        {
          const double* move = &moves[this->points.size()];
          const double h = 0.15 / n;
          this->points.insert(this->points.end(),
            { double(i) / n + h * move[0], double(j) / n + h * move[1],
              planar ? 0.0 : double(k) / n + h * move[2] });
        }
      }
    }
    const auto at = [=](int i, int j, int k) { return Index((k * m + j) * m + i); };
    const auto add = [&](std::initializer_list<Index> nodes)
    {
      this->connectivity.insert(this->connectivity.end(), nodes);
      this->offsets.push_back(static_cast<Index>(this->connectivity.size()));
      this->types.push_back(static_cast<unsigned char>(type));
    };
    for (int k = 0; k < std::max(layers, 1); ++k)
    {
      for (int j = 0; j < n; ++j)
      {
        for (int i = 0; i < n; ++i)
        {
          const Index a = at(i, j, k), b = at(i + 1, j, k), c = at(i + 1, j + 1, k),
                      d = at(i, j + 1, k);
          const Index up = m * m;
          if (type == CellType::Triangle)
          {
            add({ a, b, c });
            add({ a, c, d });
          }
          else if (type == CellType::Quadrilateral)
          {
            add({ a, b, c, d });
          }
          else if (type == CellType::Hexahedron)
          {
            add({ a, b, c, d, a + up, b + up, c + up, d + up });
          }
          else
          {
            // Six around the diagonal from a to c + up.
            const Index ring[] = { b, c, d, d + up, a + up, b + up, b };
            const Index top = c + up;
            const Index around[] = { b, c, d, d + up, a + up, b + up };
            for (int s = 0; s < 6; ++s)
            {
              add({ a, around[s], ring[s + 1], top });
            }
          }
        }
      }
    }
  }

  Mesh mesh() const
  {
    TAUTLINE_LET(MeshView, view, numberOfPoints = static_cast<Index>(this->points.size()) / 3,
      points = this->points.data(), numberOfCells = static_cast<Index>(this->types.size()),
      cellTypes = this->types.data(), offsets = this->offsets.data(),
      connectivity = this->connectivity.data());
    return Mesh(view);
  }
};

/// The share of a triangle in Poisson's largest eigenvalue is its part of the energy
/// area |grad u|^2 of the eigenvector u, which is 0 at the boundary.
void checkShares(const EllipticSystem& system, const std::vector<double>& shares)
{
  const Dense a = denseOf(system.matrix());
  const Eigen::SelfAdjointEigenSolver<Dense> dense(a);
  const MeshView& view = system.mesh().view();
  std::vector<double> u(view.numberOfPoints, 0.0);
  for (std::size_t i = 0; i < system.freePoints().size(); ++i)
  {
    u[system.freePoints()[i]] = dense.eigenvectors()(static_cast<Index>(i), a.rows() - 1);
  }
  const double whole = dense.eigenvalues()(a.rows() - 1);
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const Index* node = view.connectivity + view.offsets[cell];
    const Vec3 p = pointOf(view, node[0]), e = pointOf(view, node[1]) - p,
               f = pointOf(view, node[2]) - p;
    const double twice = cross(e, f)[2], de = u[node[1]] - u[node[0]], df = u[node[2]] - u[node[0]];
    const double gx = (de * f[1] - df * e[1]) / twice, gy = (df * e[0] - de * f[0]) / twice;
    TAUTLINE_CHECK_NEAR(shares[cell], 0.5 * twice * (gx * gx + gy * gy) / whole, 1e-4);
  }
}

/// All equations on all cell types: dense eigenvalues; and what elements contribute.
TAUTLINE_PART(testEquations)
{
  for (const CellType type :
    { CellType::Triangle, CellType::Quadrilateral, CellType::Tetrahedron, CellType::Hexahedron })
  {
    const BoxMesh box(type, topology(type).dimension == 2 ? 9 : 5);
    const Mesh mesh = box.mesh();
    for (const Pde pde : { Pde::Poisson, Pde::Elliptic, Pde::Elasticity })
    {
      const Context context(
        std::string(topology(type).name) + " pde " + std::to_string(static_cast<int>(pde)));
      TAUTLINE_LET(EllipticProblem, problem, pde = pde);
      problem.diffusion.tensor = { 2, 1, 5, 0.5, 0, 0 };
      problem.diffusion.reaction = 3;
      const EllipticSystem system(mesh, problem);
      LinearSystem linear = system.linearSystem();
      linear.coordinates = nullptr; // no rigid body modes: the other side has none
      testDense(linear, 1e-5);

      const Dense a = denseOf(system.matrix());
      const Eigen::SelfAdjointEigenSolver<Dense> dense(a);
      const double largest = dense.eigenvalues()(a.rows() - 1);
      const ElementContributions contributions = elementContributions(system, true);
      TAUTLINE_CHECK(contributions.bound >= largest && contributions.bound < 4 * largest);
      TAUTLINE_CHECK(
        contributions.lowerBound <= largest && contributions.lowerBound > largest / 20);
      double sum = 0.0, most = 0.0;
      for (std::size_t cell = 0; cell < contributions.share.size(); ++cell)
      {
        TAUTLINE_CHECK(contributions.share[cell] > -1e-9);
        sum += contributions.share[cell];
        most = std::max(most, contributions.largestEigenvalue[cell]);
      }
      TAUTLINE_CHECK_NEAR(sum, 1.0, 1e-12);
      TAUTLINE_CHECK(most >= contributions.lowerBound);
      TAUTLINE_CHECK(elementContributions(system, false).share.empty());
      TAUTLINE_CHECK(
        elementContributions(system, true, 2).share == elementContributions(system, true, 1).share);
    }
  }

  // A unit right triangle: its Poisson matrix has eigenvalues 0, 1/2 and 3/2. A needle dominates.
  BoxMesh box(CellType::Triangle, 6);
  for (std::size_t i = 0; i < box.points.size(); ++i)
  {
    box.points[i] = i % 3 == 2 ? 0.0 : std::round(6 * box.points[i]);
  }
  const Mesh regular = box.mesh();
  const EllipticSystem plain(regular, EllipticProblem());
  TAUTLINE_EACH_OF(const double value, elementContributions(plain, false).largestEigenvalue,
    TAUTLINE_CHECK_NEAR(value, 1.5, 1e-14));
  TAUTLINE_CHECK_NEAR(elementContributions(plain, false).bound, 9.0, 1e-13);
  box.points[3 * (3 * 7 + 3)] += 0.98; // an inner point close to its neighbor on the right
  box.points[3 * (3 * 7 + 3) + 1] += 0.005;
  const Mesh needle = box.mesh();
  const EllipticSystem bad(needle, EllipticProblem());
  const ElementContributions found = elementContributions(bad, true);
  checkShares(bad, found.share);
  std::vector<double> sorted = found.share;
  std::sort(sorted.rbegin(), sorted.rend());
  TAUTLINE_CHECK(sorted[0] + sorted[1] > 0.9);
  const auto worst = std::max_element(found.share.begin(), found.share.end()) - found.share.begin();
  const auto largest =
    std::max_element(found.largestEigenvalue.begin(), found.largestEigenvalue.end());
  TAUTLINE_CHECK(found.largestEigenvalue[worst] > 0.5 * *largest);
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testTrouble)
{
  const int n = 12;
  // Without boundary values: singular. Shifted: indefinite.
  const SparseMatrix neumann = gridMatrix(n,
    [=](int i, int j)
    {
      const int neighbors = (i % n > 0) + (i % n < n - 1) + (i / n > 0) + (i / n < n - 1);
      return i == j ? neighbors : -1.0;
    });
  const SparseMatrix shifted = laplacian(n, 1.0, -1.0);
  for (const Preconditioner preconditioner : { Preconditioner::None, Preconditioner::Jacobi })
  {
    const Context context(nameOf(preconditioner));
    TAUTLINE_LET(ConditionOptions, options, preconditioner = preconditioner);
    const ConditionEstimate singular = estimateCondition(systemOf(neumann), options);
    TAUTLINE_CHECK_EQUAL(singular.condition, 0.0);
    TAUTLINE_CHECK(!singular.converged);
    TAUTLINE_CHECK(contains(singular.message, "singular"));
    TAUTLINE_CHECK(singular.largest > 0.0);
    const ConditionEstimate indefinite = estimateCondition(systemOf(shifted), options);
    TAUTLINE_CHECK_EQUAL(indefinite.condition, 0.0);
    TAUTLINE_CHECK(contains(indefinite.message, wording("not-positive-definite")));
    const double by = preconditioner == Preconditioner::Jacobi ? 3.0 : 1.0;
    TAUTLINE_CHECK_RELATIVE(indefinite.smallest, (laplacianEigenvalue(n, 1, 1) - 1.0) / by, 1e-6);
    TAUTLINE_CHECK_RELATIVE(indefinite.largest, (laplacianEigenvalue(n, n, n) - 1.0) / by, 1e-6);
  }

  // Preconditioners that are not definite, not symmetric, or not there.
  ConditionOptions options;
  const SparseMatrix deep = laplacian(n, 1.0, -2.3);
  options.preconditioner = Preconditioner::ILU;
  TAUTLINE_CHECK(
    contains(estimateCondition(systemOf(deep), options).message, wording("not-positive-definite")));
  const SparseMatrix a = laplacian(40);
  options.preconditioner = Preconditioner::SSOR;
  options.petscOptions = "-pc_sor_local_forward";
  TAUTLINE_CHECK(
    contains(estimateCondition(systemOf(a), options).message, wording("not-symmetric")));
  SparseMatrix hole = laplacian(n);
  for (Index k = hole.offsets[30]; k < hole.offsets[31]; ++k)
  {
    hole.values[k] = 0.0;
  }
  options.petscOptions.clear();
  options.preconditioner = Preconditioner::ILU;
  const ConditionEstimate pivot = estimateCondition(systemOf(hole), options);
  TAUTLINE_CHECK(!pivot.converged && contains(pivot.message, "pivot"));

  // Limits.
  for (const Preconditioner preconditioner : preconditioners)
  {
    const Context context(nameOf(preconditioner));
    TAUTLINE_LET(ConditionOptions, limited, preconditioner = preconditioner);
    // The Lanczos method calls more often.
    const int limit = preconditioner == Preconditioner::SSOR ? 200 : 3;
    int calls = 0;
    double before = 0.0;
    limited.progress = [&](double fraction)
    {
      TAUTLINE_CHECK(fraction >= before && fraction <= 1.0);
      before = fraction;
      return ++calls < limit;
    };
    const SparseMatrix large = laplacian(120);
    const ConditionEstimate aborted = estimateCondition(systemOf(large), limited);
    TAUTLINE_CHECK_EQUAL(aborted.message, std::string("Stopped by the user."));
    TAUTLINE_CHECK(!aborted.converged);
    TAUTLINE_SET(limited, progress = {}, maximumSeconds = 1e-6);
    const ConditionEstimate late = estimateCondition(systemOf(large), limited);
    TAUTLINE_CHECK(contains(late.message, wording("time-limit")));
    TAUTLINE_CHECK(!late.converged);
    limited.maximumSeconds = 0.0;
    limited.progress = [](double) -> bool { throw std::runtime_error("from progress"); };
    TAUTLINE_CHECK_THROWS(estimateCondition(systemOf(large), limited), wording("from-progress"));
  }
  options = {};
  options.preconditioner = Preconditioner::Jacobi;
  options.petscOptions = "-pc_jacobi_type diagonal"; // by Lanczos
  options.maximumIterations = 10;
  const ConditionEstimate few = estimateCondition(systemOf(a), options);
  TAUTLINE_CHECK(!few.converged && contains(few.message, wording("not-converged")));
  TAUTLINE_CHECK(few.smallest >= laplacianEigenvalue(40, 1, 1) / 4 && few.smallestError > 1e-3);

  options = {};
  options.petscOptions = "-eps_nev_max 3";
  TAUTLINE_CHECK_THROWS(estimateCondition(systemOf(a), options), "-eps_nev_max");
  options = {};
  options.tolerance = 0.0;
  TAUTLINE_CHECK_THROWS(estimateCondition(systemOf(a), options), "tolerance");
  LinearSystem unsymmetric = TAUTLINE_CHANGED(systemOf(a), symmetric = false);
  TAUTLINE_CHECK_THROWS(estimateCondition(unsymmetric, {}), "symmetric");
  const SparseMatrix none;
  TAUTLINE_CHECK_THROWS(estimateCondition(systemOf(none), {}), wording("no-unknowns"));
}
}

TAUTLINE_TEST(TestConditionEstimate)
{
  TAUTLINE_RUN(testKnownValues()); // initializes PETSc, which testDense() calls itself
  const SparseMatrix a = laplacian(14);
  TAUTLINE_RUN(testDense(systemOf(a), 1e-6));
}
