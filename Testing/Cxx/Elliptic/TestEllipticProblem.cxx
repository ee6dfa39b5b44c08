// SPDX-License-Identifier: BSD-3-Clause
// Boundary value problems: orders of convergence against manufactured solutions, exactness for
// linear fields, plane strain and plane stress against a known solution, stresses, parts left free,
// threads, whatever is rejected.
#include "Blocks.h"
#include "Registry.h"
#include "tautline/Elliptic/EllipticSystem.h"
#include "tautline/Elliptic/ErrorNorms.h"

using namespace tautline;

namespace
{
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

/// A product of sines, one factor per direction, with all its derivatives.
struct Product
{
  Vec3 k, shift;
  double derivative(const Vec3& p, std::array<int, 3> order) const
  {
    double value = 1;
    for (int d = 0; d < 3; ++d)
    {
      value *= std::pow(this->k[d], order[d]) *
        std::sin(this->k[d] * p[d] + this->shift[d] + order[d] * M_PI / 2);
    }
    return value;
  }
  double value(const Vec3& p) const { return this->derivative(p, { 0, 0, 0 }); }
  Vec3 gradient(const Vec3& p) const
  {
    return { this->derivative(p, { 1, 0, 0 }), this->derivative(p, { 0, 1, 0 }),
      this->derivative(p, { 0, 0, 1 }) };
  }
  double second(const Vec3& p, int i, int j) const
  {
    std::array<int, 3> order = { 0, 0, 0 };
    ++order[i];
    ++order[j];
    return this->derivative(p, order);
  }
};

/// Known solutions; in the plane nothing depends on z.
std::array<Product, 3> knownSolution(int dimension)
{
  std::array<Product, 3> u = { Product{ { 2, 3, 1.5 }, { 1, 0.3, 0.7 } },
    Product{ { 1.5, 2, 1 }, { 0.2, 1, 0.4 } }, Product{ { 1, 2, 2.5 }, { 0.5, 0.1, 1 } } };
  for (Product& product : u)
  {
    if (dimension == 2)
    {
      TAUTLINE_SET(product, k[2] = 0, shift[2] = M_PI / 2);
    }
  }
  if (dimension == 2)
  {
    u[2] = { { 0, 0, 0 }, { 0, 0, 0 } };
  }
  return u;
}

/// A unit block of n^dimension cubes cut into cells of a type, bent smoothly inside.
MeshData bentBlock(CellType type, Index n)
{
  const bool flat = topology(type).dimension == 2;
  MeshData data = blockMesh(type, n, n, flat ? 0 : n);
  data.transform(
    [&](Vec3 p)
    {
      p = (1.0 / static_cast<double>(n)) * p;
      const double bend =
        0.08 * std::sin(M_PI * p[0]) * std::sin(M_PI * p[1]) * (flat ? 1 : std::sin(M_PI * p[2]));
      return p + bend * Vec3{ 1, -0.7, flat ? 0 : 0.5 };
    });
  return data;
}

struct Given
{
  EllipticProblem problem;
  std::vector<double> sources, values;
};

/// Sources and boundary values that make the known functions the solution.
Given manufactured(const MeshData& data, int dimension, Pde pde, PlaneState plane)
{
  const std::array<Product, 3> u = knownSolution(dimension);
  Given given;
  EllipticProblem& problem = given.problem;
  problem.pde = pde;
  problem.diffusion.tensor = { 2, 1, 3, 0.5, 0, 0 };
  TAUTLINE_SET(problem, diffusion.reaction = 10, elastic.youngsModulus = 3,
    elastic.poissonRatio = 0.3, elastic.plane = plane);
  const double e = 3, nu = 0.3, mu = e / (2 * (1 + nu));
  const double lambda = dimension == 2 && plane == PlaneState::Stress
    ? e * nu / (1 - nu * nu)
    : e * nu / ((1 + nu) * (1 - 2 * nu));
  const SymmetricTensor c = pde == Pde::Poisson ? IdentityTensor : problem.diffusion.tensor;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 p = data.point(i);
    if (pde != Pde::Elasticity)
    {
      given.values.push_back(u[0].value(p));
      given.sources.push_back(-c[0] * u[0].second(p, 0, 0) - c[1] * u[0].second(p, 1, 1) -
        c[2] * u[0].second(p, 2, 2) - 2 * c[3] * u[0].second(p, 0, 1) +
        (pde == Pde::Elliptic ? 10 * u[0].value(p) : 0.0));
      continue;
    }
    for (int k = 0; k < 3; ++k)
    {
      given.values.push_back(u[k].value(p));
      double f = 0;
      for (int j = 0; j < 3; ++j)
      {
        f -= (lambda + mu) * u[j].second(p, j, k) + mu * u[k].second(p, j, j);
      }
      given.sources.push_back(k < dimension ? f : 0.0);
    }
  }
  TAUTLINE_SET(problem, sources = given.sources.data(), fixedValues = given.values.data());
  return given;
}

std::array<double, 2> errorOf(CellType type, Index n, Pde pde, PlaneState plane)
{
  const int dimension = topology(type).dimension;
  const MeshData data = bentBlock(type, n);
  const Mesh mesh(data.view());
  const Given given = manufactured(data, dimension, pde, plane);
  const EllipticSystem system(mesh, given.problem);
  TAUTLINE_LET(SolverOptions, options, relativeTolerance = 1e-9,
    preconditioner = dimension == 2 ? Preconditioner::BoomerAMG : Preconditioner::ICC);
  const EllipticSolution solution = system.solve(options);
  TAUTLINE_CHECK(converged(solution.linear.reason));
  const std::array<Product, 3> u = knownSolution(dimension);
  return errorNorms(system, solution,
    [&](const Vec3& p, double* value, double* gradient)
    {
      for (int k = 0; k < solution.components; ++k)
      {
        value[k] = u[k].value(p);
        const Vec3 slope = u[k].gradient(p);
        std::copy(slope.begin(), slope.end(), gradient + 3 * k);
      }
    });
}

TAUTLINE_PART(testConvergence)
{
  for (CellType type : allTypes)
  {
    const Index n = topology(type).dimension == 2 ? 20 : 7;
    for (Pde pde : { Pde::Poisson, Pde::Elliptic, Pde::Elasticity })
    {
      for (PlaneState plane : { PlaneState::Strain, PlaneState::Stress })
      {
        if (plane == PlaneState::Stress && (pde != Pde::Elasticity || n < 10))
        {
          continue;
        }
        const Context context(std::string(topology(type).plural) + ", problem " +
          std::to_string(static_cast<int>(pde)) + (plane == PlaneState::Stress ? " stress" : ""));
        const std::array<double, 2> coarse = errorOf(type, n, pde, plane),
                                    fine = errorOf(type, 2 * n, pde, plane);
        TAUTLINE_CHECK_NEAR(std::log2(coarse[0] / fine[0]), 2.0, 0.1);
        TAUTLINE_CHECK_NEAR(std::log2(coarse[1] / fine[1]), 1.0, 0.1);
        TAUTLINE_CHECK(fine[1] < 0.3);
      }
    }
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testLinearFields)
{
  TAUTLINE_LET(SolverOptions, direct, method = KrylovMethod::Direct);
  Random random(3);
  const Columns turn = randomRotation(random);
  for (CellType type : allTypes)
  {
    const Context context(topology(type).plural);
    const bool flat = topology(type).dimension == 2;
    MeshData data = shuffled(movedBlock(type, 4, 0.1), 8);
    if (flat)
    {
      data.transform([&](const Vec3& p) { return turn * p; }); // in a plane of no axis
    }
    const Mesh mesh(data.view());
    const Vec3 slope = flat ? turn * Vec3{ 1, -2, 0 } : Vec3{ 1, -2, 0.5 };
    auto linear = collect<double>(
      data.numberOfPoints(), [&](Index i) { return 5 + dot(slope, data.point(i)); });
    EllipticProblem problem;
    problem.source = { 0, 0, 0 };
    problem.fixedValues = linear.data();
    for (Pde pde : { Pde::Poisson, Pde::Elliptic })
    {
      problem.pde = pde;
      problem.diffusion.tensor = { 2, 1, 3, 0.5, 0.2, 0 };
      const EllipticSystem system(mesh, problem);
      TAUTLINE_CHECK_EQUAL(system.blockSize(), 1);
      TAUTLINE_CHECK_EQUAL(system.unknowns(), static_cast<Index>(system.freePoints().size()));
      const EllipticSolution solution = system.solve(direct);
      TAUTLINE_EACH(
        std::size_t, i, linear.size(), TAUTLINE_CHECK_NEAR(solution.values[i], linear[i], 1e-10));
      TAUTLINE_EACH(std::size_t, i, solution.gradients.size(),
        TAUTLINE_CHECK_NEAR(solution.gradients[i], slope[i % 3], 1e-10));
    }

    // Displacement G p, in the frame of the mesh for planar ones; its stress is known.
    const Columns strain = { Vec3{ 0.01, 0.03, 0 }, Vec3{ -0.02, 0.04, flat ? 0 : 0.01 },
      Vec3{ 0, flat ? 0 : 0.02, flat ? 0 : -0.03 } };
    const Columns back = { Vec3{ turn[0][0], turn[1][0], turn[2][0] },
      Vec3{ turn[0][1], turn[1][1], turn[2][1] }, Vec3{ turn[0][2], turn[1][2], turn[2][2] } };
    std::vector<double> displacement;
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      const Vec3 p = data.point(i), u = flat ? turn * (strain * (back * p)) : strain * p;
      displacement.insert(displacement.end(), u.begin(), u.end());
    }
    for (PlaneState plane : { PlaneState::Strain, PlaneState::Stress })
    {
      TAUTLINE_SET(problem, pde = Pde::Elasticity, elastic.plane = plane, elastic.youngsModulus = 2,
        elastic.poissonRatio = 0.25, fixedValues = displacement.data());
      const EllipticSystem system(mesh, problem);
      TAUTLINE_CHECK_EQUAL(system.blockSize(), flat ? 2 : 3);
      const EllipticSolution solution = system.solve(direct);
      TAUTLINE_CHECK_EQUAL(solution.components, 3);
      TAUTLINE_EACH(std::size_t, i, displacement.size(),
        TAUTLINE_CHECK_NEAR(solution.values[i], displacement[i], 1e-10));
      // E = 2, nu = 1/4: lambda = mu = 4/5, and lambda = 8/15 in plane stress.
      const double lambda = flat && plane == PlaneState::Stress ? 8.0 / 15 : 0.8, mu = 0.8;
      const double trace = strain[0][0] + strain[1][1] + strain[2][2];
      Columns stress;
      for (int i = 0; i < 3; ++i)
      {
        for (int j = 0; j < 3; ++j)
        {
          stress[j][i] = mu * (strain[i][j] + strain[j][i]) + (i == j ? lambda * trace : 0.0);
        }
      }
      if (flat && plane == PlaneState::Stress)
      {
        stress[2][2] = 0; // nothing holds it across; in plane strain lambda tr eps does
      }
      const auto at = [&](int i, int j)
      {
        const Vec3 row = back * Vec3{ i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0 };
        return flat ? (turn * (stress * row))[j] : stress[i][j];
      };
      const double expected[6] = { at(0, 0), at(1, 1), at(2, 2), at(0, 1), at(1, 2), at(0, 2) };
      TAUTLINE_CHECK_EQUAL(static_cast<Index>(solution.gradients.size()), 6 * data.numberOfCells());
      TAUTLINE_EACH(std::size_t, i, solution.gradients.size(),
        TAUTLINE_CHECK_NEAR(solution.gradients[i], expected[i % 6], 1e-10));
    }
  }
}

//------------------------------------------------------------------------------
/// A ring pushed outwards at its inner circle, its outer circle free: u_r = A r + B / r (Lame).
TAUTLINE_PART(testRing)
{
  const Index around = 96, layers = 24;
  const double inner = 1, outer = 2, push = 0.1;
  MeshData data;
  for (Index layer = 0; layer <= layers; ++layer)
  {
    for (Index i = 0; i < around; ++i)
    {
      const double r = inner + (outer - inner) * static_cast<double>(layer) / layers;
      const double angle = 2 * M_PI * static_cast<double>(i) / around;
      data.addPoint({ r * std::cos(angle), r * std::sin(angle), 0 });
      if (layer > 0)
      {
        const Index next = (i + 1) % around, below = (layer - 1) * around, here = layer * around;
        data.addCell(CellType::Quadrilateral, { below + i, here + i, here + next, below + next });
      }
    }
  }
  const Mesh mesh(data.view());
  std::vector<unsigned char> fixed(data.numberOfPoints(), 0);
  std::vector<double> values(data.points);
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    fixed[i] = i < around;
    for (int k = 0; k < 3; ++k)
    {
      values[3 * i + k] = fixed[i] ? push * data.points[3 * i + k] : NaN; // not read
    }
  }
  for (PlaneState plane : { PlaneState::Strain, PlaneState::Stress })
  {
    TAUTLINE_LET(EllipticProblem, problem, pde = Pde::Elasticity, elastic.plane = plane,
      elastic.youngsModulus = 5, elastic.poissonRatio = 0.35);
    problem.source = { 0, 0, 0 };
    TAUTLINE_SET(problem, fixed = fixed.data(), fixedValues = values.data());
    const EllipticSystem system(mesh, problem);
    TAUTLINE_LET(SolverOptions, options, method = KrylovMethod::Direct);
    const EllipticSolution solution = system.solve(options);
    const double nu = 0.35, e = 5, mu = e / (2 * (1 + nu));
    const double lambda =
      plane == PlaneState::Strain ? e * nu / ((1 + nu) * (1 - 2 * nu)) : e * nu / (1 - nu * nu);
    // No traction outside: (lambda + mu) A = mu B / outer^2; u_r(inner) = push.
    const double b = push / (mu / ((lambda + mu) * outer * outer) * inner + 1 / inner);
    const double a = mu * b / ((lambda + mu) * outer * outer);
    for (Index i = layers * around; i < data.numberOfPoints(); ++i)
    {
      const double u = std::hypot(solution.values[3 * i], solution.values[3 * i + 1]);
      TAUTLINE_CHECK_RELATIVE(u, a * outer + b / outer, 1e-3);
      TAUTLINE_CHECK_EQUAL(solution.values[3 * i + 2], 0.0);
    }
    // The hoop stress half-way, at a cell on the x axis.
    const Index cell = layers / 2 * around;
    const double r = norm(mesh.center(cell, CellType::Quadrilateral));
    const double hoop = 2 * (lambda + mu) * a + 2 * mu * b / (r * r);
    TAUTLINE_CHECK_RELATIVE(solution.gradients[6 * cell + 1], hoop, 5e-3);
    const double across = plane == PlaneState::Strain ? lambda * 2 * a : 0.0;
    TAUTLINE_CHECK_NEAR(solution.gradients[6 * cell + 2], across, 5e-3 * hoop);
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testSystem)
{
  // The five-point matrix: 4 on the diagonal, -1 beside, h^2 on the right.
  const Index n = 5;
  MeshData data = blockMesh(CellType::Triangle, n, n, 0);
  data.addPoint({ 0.5, 0.25, 0 }); // in no cell
  const Mesh mesh(data.view());
  const EllipticSystem system(mesh, {});
  const SparseMatrix& a = system.matrix();
  TAUTLINE_CHECK_EQUAL(system.unknowns(), (n - 1) * (n - 1));
  TAUTLINE_CHECK_EQUAL(a.size, system.unknowns());
  for (Index i = 0; i < a.size; ++i)
  {
    TAUTLINE_CHECK_EQUAL(system.freePoints()[i], (i / (n - 1) + 1) * (n + 1) + i % (n - 1) + 1);
    TAUTLINE_CHECK_NEAR(a.at(i, i), 4, 1e-14);
    TAUTLINE_CHECK_NEAR(system.rightHandSide()[i], 1, 1e-14);
    if (i % (n - 1) > 0)
    {
      TAUTLINE_CHECK_NEAR(a.at(i, i - 1), -1, 1e-14);
    }
  }
  const EllipticSolution solution = system.solve({});
  TAUTLINE_CHECK(converged(solution.linear.reason));
  TAUTLINE_CHECK(std::isnan(solution.values.back()));
  TAUTLINE_CHECK_EQUAL(solution.values[0], 0.0);
  const LinearSystem linear = system.linearSystem();
  TAUTLINE_CHECK(linear.symmetric && linear.positiveDefinite && linear.blockSize == 1);

  // A reversed mesh and one left alone in part give the same; a skipped cell has no gradient.
  MeshData reversed = TAUTLINE_CHANGED(data, swapNodes(0, 1));
  const Mesh other(reversed.view());
  TAUTLINE_CHECK_NEAR(
    EllipticSystem(other, {}).solve({}).values[n + 2], solution.values[n + 2], 1e-12);
  std::vector<unsigned char> skip(data.numberOfCells(), 0);
  skip[0] = skip[1] = 1; // the square at the origin
  TAUTLINE_LET(MeshPart, part, skip = skip.data());
  const EllipticSystem less(mesh, {}, part);
  TAUTLINE_CHECK_EQUAL(less.unknowns(), (n - 1) * (n - 1) - 1); // its inner corner is boundary now
  const EllipticSolution hole = less.solve({});
  TAUTLINE_CHECK(std::isnan(hole.gradients[0]) && std::isnan(hole.values[0]));
  TAUTLINE_CHECK(std::isfinite(hole.gradients[3 * 2]));

  // Threads: bitwise the same.
  const MeshData large = movedBlock(CellType::Triangle, 90, 0.1);
  const Mesh big(large.view());
  TAUTLINE_LET(EllipticProblem, elastic, pde = Pde::Elasticity);
  const EllipticSystem one(big, elastic, {}, 1), three(big, elastic, {}, 3);
  TAUTLINE_CHECK(one.matrix().values == three.matrix().values);
  TAUTLINE_CHECK(one.matrix().columns == three.matrix().columns);
  TAUTLINE_CHECK(one.rightHandSide() == three.rightHandSide());

  // All boundary natural, a > 0: the solution is f / a.
  std::vector<unsigned char> none(data.numberOfPoints(), 0);
  TAUTLINE_LET(EllipticProblem, natural, pde = Pde::Elliptic, fixed = none.data());
  natural.source = { 6, 0, 0 };
  natural.diffusion.reaction = 3;
  TAUTLINE_LET(SolverOptions, options, relativeTolerance = 1e-12);
  const EllipticSolution constant = EllipticSystem(mesh, natural).solve(options);
  TAUTLINE_CHECK_NEAR(constant.values[7], 2, 1e-10);
  natural.diffusion.reaction = -3;
  TAUTLINE_CHECK(!EllipticSystem(mesh, natural).linearSystem().positiveDefinite);
  TAUTLINE_CHECK_THROWS(
    EllipticSystem(mesh, {}).fields(std::vector<double>(3)), wording("3-numbers-for-16-unknowns"));
}

//------------------------------------------------------------------------------
/// With f = 1 solutions grow with the square of the size, gradients with the size.
TAUTLINE_PART(testScales)
{
  TAUTLINE_LET(SolverOptions, options, method = KrylovMethod::Direct);
  for (CellType type : { CellType::Triangle, CellType::Hexahedron })
  {
    const MeshData data = movedBlock(type, 5, 0.1);
    for (Pde pde : { Pde::Poisson, Pde::Elasticity })
    {
      TAUTLINE_LET(EllipticProblem, problem, pde = pde);
      const Mesh mesh(data.view());
      const EllipticSolution solution = EllipticSystem(mesh, problem).solve(options);
      for (double scale : { 1e-8, 1e8 })
      {
        MeshData other = data;
        other.transform([&](const Vec3& p) { return scale * p; });
        const Mesh scaled(other.view());
        const EllipticSolution there = EllipticSystem(scaled, problem).solve(options);
        TAUTLINE_CHECK(converged(there.linear.reason));
        TAUTLINE_EACH(std::size_t, i, solution.values.size(),
          TAUTLINE_CHECK_NEAR(there.values[i] / (scale * scale), solution.values[i], 1e-9));
        TAUTLINE_EACH(std::size_t, i, solution.gradients.size(),
          TAUTLINE_CHECK_NEAR(there.gradients[i] / scale, solution.gradients[i], 1e-9));
      }
    }
  }
}

//------------------------------------------------------------------------------
/// Two squares, or cubes, that do not touch.
MeshData twoParts(CellType type)
{
  MeshData data = blockMesh(type, 3, 3, topology(type).dimension == 2 ? 0 : 3);
  const MeshData once = data;
  const Index points = data.numberOfPoints();
  for (Index i = 0; i < points; ++i)
  {
    data.addPoint(once.point(i) + Vec3{ 10, 0, 0 });
  }
  for (Index cell = 0; cell < once.numberOfCells(); ++cell)
  {
    std::vector<Index> nodes;
    for (Index k = once.offsets[cell]; k < once.offsets[cell + 1]; ++k)
    {
      nodes.push_back(points + once.connectivity[k]);
    }
    data.addCell(type, nodes);
  }
  return data;
}

TAUTLINE_PART(testRejections)
{
  const auto make = [](const MeshData& data, const EllipticProblem& problem)
  {
    const Mesh mesh(data.view());
    EllipticSystem(mesh, problem);
  };
  const MeshData good = blockMesh(CellType::Triangle, 4, 4, 0);
  TAUTLINE_CHECK_THROWS(make(MeshData(), {}), wording("no-cells"));
  MeshData data = TAUTLINE_CHANGED(good, addCell(3, { 0, 1 }));
  TAUTLINE_CHECK_THROWS(make(data, {}), wording("1-cells-are-not-triangles"));

  // Elements.
  data = good;
  data.setPoint(6, data.point(6) + Vec3{ 1.2, 1.1, 0 }); // across its neighbors
  TAUTLINE_CHECK_THROWS(make(data, {}), wording("inverted-against-the-rest"));
  data = good;
  std::swap(data.connectivity[3 * 5], data.connectivity[3 * 5 + 1]);
  TAUTLINE_CHECK_THROWS(make(data, {}), wording("1-element-the-first-is-cell-5"));
  data = TAUTLINE_CHANGED(good, addCell(CellType::Triangle, { 0, 1, 2 }));
  TAUTLINE_CHECK_THROWS(make(data, {}), wording("1-element-the-first-is-cell-32"));
  data = TAUTLINE_CHANGED(good, points[3 * 6] = NaN);
  TAUTLINE_CHECK_THROWS(make(data, {}), wording("not-finite"));

  // Data.
  TAUTLINE_LET(EllipticProblem, problem, source[0] = NaN);
  TAUTLINE_CHECK_THROWS(make(good, problem), wording("source-f-is-not-a-finite-number-2"));
  std::vector<double> values(3 * good.numberOfPoints(), 0.0);
  problem = {};
  problem.sources = values.data();
  values[7] = NaN;
  TAUTLINE_CHECK_THROWS(make(good, problem), wording("source-f-is-not-a-finite-number"));
  problem = {};
  problem.fixedValues = values.data();
  make(good, problem); // point 7 is free
  values[2] = NaN;
  TAUTLINE_CHECK_THROWS(make(good, problem), wording("given-value-is-not-a-finite-number"));
  problem = {};
  problem.pde = Pde::Elasticity;
  problem.source = { 0, 0, -1 };
  TAUTLINE_CHECK_THROWS(make(good, problem), wording("body-force-f-points-out-of-the"));
  problem.source = { 0, 1, 0 };
  std::fill(values.begin(), values.end(), 0.0);
  values[3 * 1 + 2] = 0.1;
  problem.fixedValues = values.data();
  TAUTLINE_CHECK_THROWS(make(good, problem), wording("given-displacement-points-out-of-the-plane"));
  problem = {};
  problem.pde = Pde::Elliptic;
  for (double beta : { 0.0, -1.0, NaN })
  {
    problem.diffusion.tensor = { 1, beta, 1, 0, 0, 0 };
    TAUTLINE_CHECK_THROWS(make(good, problem), wording("not-positive-definite"));
  }
  problem.diffusion.tensor = { 1, 1, 0, 0, 0, 0 }; // gamma does not matter in the plane
  make(good, problem);
  TAUTLINE_CHECK_THROWS(
    make(blockMesh(CellType::Hexahedron, 3, 3, 3), problem), wording("not-positive-definite"));
  std::vector<double> tensors(6 * good.numberOfCells(), 0.0);
  problem.diffusion.tensors = tensors.data();
  TAUTLINE_CHECK_THROWS(make(good, problem), wording("coefficient-matrix-of-cell-0"));

  // Nothing free, or too little fixed.
  problem = {};
  TAUTLINE_CHECK_THROWS(
    make(blockMesh(CellType::Quadrilateral, 1, 1, 0), problem), wording("no-point-is-free"));
  std::vector<unsigned char> fixed(good.numberOfPoints(), 0);
  problem.fixed = fixed.data();
  TAUTLINE_CHECK_THROWS(make(good, problem), wording("1-part-of-the-mesh-the-first-2"));
  fixed[3] = 1;
  make(good, problem);
  problem.pde = Pde::Elasticity;
  TAUTLINE_CHECK_THROWS(make(good, problem), wording("can-move-as-a-whole"));
  fixed[4] = 1;
  make(good, problem);

  const MeshData parts = twoParts(CellType::Triangle), blocks = twoParts(CellType::Tetrahedron);
  fixed.assign(parts.numberOfPoints(), 0);
  problem = {};
  problem.fixed = fixed.data();
  fixed[0] = fixed[1] = 1;
  TAUTLINE_CHECK_THROWS(make(parts, problem), wording("1-part-of-the-mesh-the-first"));
  fixed[20] = 1;
  make(parts, problem);
  fixed.assign(blocks.numberOfPoints(), 0);
  TAUTLINE_SET(problem, fixed = fixed.data(), pde = Pde::Elasticity);
  for (Index i : { 0, 1, 2, 4, 64, 65, 66 }) // three in a line hold nothing
  {
    fixed[i] = 1;
  }
  TAUTLINE_CHECK_THROWS(make(blocks, problem), wording("the-first-holds-point-67-can-move"));
  fixed[70] = 1;
  make(blocks, problem);
  // A closed surface has no boundary.
  MeshData sphere = blockMesh(CellType::Quadrilateral, 1, 1, 0);
  sphere.points = blockMesh(CellType::Hexahedron, 1, 1, 1).points;
  sphere.types.clear();
  sphere.offsets = { 0 };
  sphere.connectivity.clear();
  for (const std::vector<Index>& face : std::vector<std::vector<Index>>{ { 0, 2, 3, 1 },
         { 4, 5, 7, 6 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 }, { 0, 4, 6, 2 }, { 1, 3, 7, 5 } })
  {
    sphere.addCell(CellType::Quadrilateral, face);
  }
  TAUTLINE_CHECK_THROWS(make(sphere, {}), wording("without-a-fixed-point"));
  problem = {};
  problem.pde = Pde::Elasticity;
  TAUTLINE_CHECK_THROWS(make(sphere, problem), "");
}
}
