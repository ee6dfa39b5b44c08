// SPDX-License-Identifier: BSD-3-Clause
// Finite elements on quadratic triangles and tetrahedra: known matrices, an independent quadrature
// with the shape functions of ElementType, patch tests, convergence on bent blocks, disk and ball,
// boundary nodes, and whatever is rejected.
#include "QuadraticMeshes.h"
#include "Registry.h"
#include "tautline/Elements/ElementType.h"
#include "tautline/Elliptic/ElementContributions.h"
#include "tautline/Elliptic/ErrorNorms.h"
#include "tautline/Elliptic/FiniteElements.h"
#include "tautline/Elliptic/TimeStepping.h"

using namespace tautline;

namespace
{
/// An element, and the linear cells of which its meshes are made.
struct Kind
{
  const char* name;
  CellType type;
  bool center;

  int dimension() const { return topology(this->type).dimension; }
  int vtkType() const
  {
    return this->dimension() == 3 ? QuadraticTetrahedron
      : this->center              ? SevenNodeTriangle
                                  : QuadraticTriangle;
  }
};

constexpr Kind kinds[] = { { "6-node triangles", CellType::Triangle, false },
  { "7-node triangles", CellType::Triangle, true },
  { "10-node tetrahedra", CellType::Tetrahedron, false } };

/// A straight block of n^dimension cubes, then bent if asked: all edges inside are curved.
MeshData block(const Kind& kind, Index n, bool bent)
{
  const bool flat = kind.dimension() == 2;
  MeshData data = quadraticOf(blockMesh(kind.type, n, n, flat ? 0 : n), kind.center);
  data.transform(
    [&](Vec3 p)
    {
      p = (1.0 / static_cast<double>(n)) * p;
      const double bend =
        0.08 * std::sin(M_PI * p[0]) * std::sin(M_PI * p[1]) * (flat ? 1 : std::sin(M_PI * p[2]));
      return bent ? p + bend * Vec3{ 1, -0.7, flat ? 0 : 0.5 } : p;
    });
  return data;
}

/// One cell with nodes moved at random: by a little, so that it is valid.
MeshData curvedCell(const Kind& kind, double size)
{
  MeshData data = quadraticOf(singleCell(kind.type, idealCell(kind.type)), kind.center);
  Random random(7);
  data.transform(
    [&](Vec3 p)
    {
      for (int c = 0; c < kind.dimension(); ++c)
      {
        p[c] += random.uniform(-0.5 * size, 0.5 * size);
      }
      return p;
    });
  return data;
}

/// Plane waves sin(a . x + k): their derivatives are simple.
struct Wave
{
  Vec3 a;
  int dimension;

  double value(const Vec3& p, int k) const { return std::sin(dot(this->a, p) + k); }
  Vec3 gradient(const Vec3& p, int k) const { return std::cos(dot(this->a, p) + k) * this->a; }
  double second(const Vec3& p, int k, int i, int j) const
  {
    return -this->a[i] * this->a[j] * this->value(p, k);
  }
};

Wave waveOf(const Kind& kind)
{
  return { kind.dimension() == 3 ? Vec3{ 1.3, 2.1, -1.6 } : Vec3{ 1.3, 2.1, 0 }, kind.dimension() };
}

struct Given
{
  EllipticProblem problem;
  std::vector<double> sources, values;
};

Given manufactured(const MeshData& data, const Wave& u, Pde pde)
{
  Given given;
  EllipticProblem& problem = given.problem;
  problem.pde = pde;
  problem.diffusion.tensor = { 2, 1, 3, 0.5, 0, 0 };
  TAUTLINE_SET(
    problem, diffusion.reaction = 10, elastic.youngsModulus = 3, elastic.poissonRatio = 0.3);
  const double e = 3, nu = 0.3, mu = e / (2 * (1 + nu));
  const double lambda = e * nu / ((1 + nu) * (1 - 2 * nu));
  const SymmetricTensor c = pde == Pde::Poisson ? IdentityTensor : problem.diffusion.tensor;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 p = data.point(i);
    if (pde != Pde::Elasticity)
    {
      given.values.push_back(u.value(p, 0));
      given.sources.push_back(-c[0] * u.second(p, 0, 0, 0) - c[1] * u.second(p, 0, 1, 1) -
        c[2] * u.second(p, 0, 2, 2) - 2 * c[3] * u.second(p, 0, 0, 1) +
        (pde == Pde::Elliptic ? 10 * u.value(p, 0) : 0.0));
      continue;
    }
    for (int k = 0; k < 3; ++k)
    {
      double f = 0;
      for (int j = 0; j < u.dimension; ++j)
      {
        f -= (lambda + mu) * u.second(p, j, j, k) + mu * u.second(p, k, j, j);
      }
      given.values.push_back(k < u.dimension ? u.value(p, k) : 0.0);
      given.sources.push_back(k < u.dimension ? f : 0.0);
    }
  }
  TAUTLINE_SET(problem, sources = given.sources.data(), fixedValues = given.values.data());
  return given;
}

/// The errors in L2 and of the gradient.
std::array<double, 2> errorOf(const Kind& kind, const MeshData& data, Pde pde)
{
  const Mesh mesh(data.view());
  const Wave u = waveOf(kind);
  const Given given = manufactured(data, u, pde);
  const EllipticSystem system(mesh, given.problem);
  TAUTLINE_LET(
    SolverOptions, options, relativeTolerance = 1e-11, preconditioner = Preconditioner::ICC);
  const EllipticSolution solution = system.solve(options);
  TAUTLINE_CHECK(converged(solution.linear.reason));
  return errorNorms(system, solution,
    [&](const Vec3& p, double* value, double* gradient)
    {
      for (int k = 0; k < solution.components; ++k)
      {
        const bool inside = k < u.dimension;
        value[k] = inside ? u.value(p, k) : 0.0;
        const Vec3 slope = inside ? u.gradient(p, k) : Vec3{ 0, 0, 0 };
        std::copy(slope.begin(), slope.end(), gradient + 3 * k);
      }
    });
}

void checkOrders(
  const char* name, const std::array<double, 2>& coarse, const std::array<double, 2>& fine)
{
  const double order = std::log2(coarse[0] / fine[0]), slope = std::log2(coarse[1] / fine[1]);
  std::cout << name << ": order " << order << " in L2, " << slope << " in H1\n";
  TAUTLINE_CHECK(order >= 2.8 && order < 3.5);
  TAUTLINE_CHECK(slope >= 1.85 && slope < 2.5);
}

//------------------------------------------------------------------------------
/// The shape functions of an element at a place, and their derivatives: five-point differences are
/// exact for polynomials up to degree 4.
struct Shapes
{
  std::vector<double> value;
  std::array<std::vector<double>, 3> derivative;

  Shapes(const ElementType& type, const Vec3& at)
    : value(type.shapeFunctions(at))
  {
    constexpr double h = 0.125;
    for (int d = 0; d < type.dimension(); ++d)
    {
      const auto beside = [&](double steps)
      {
        Vec3 place = at;
        place[d] += steps * h;
        return type.shapeFunctions(place);
      };
      const auto a = beside(-2), b = beside(-1), c = beside(1), e = beside(2);
      for (std::size_t k = 0; k < a.size(); ++k)
      {
        this->derivative[d].push_back((a[k] - 8 * b[k] + 8 * c[k] - e[k]) / (12 * h));
      }
    }
  }
};

/// Integrals over a cell by many points: K_ij + M_ij, by other code than the product's.
std::vector<double> independentMatrix(const MeshData& data, const Kind& kind)
{
  const ElementType& type =
    ElementType::ofVtk(kind.vtkType(), static_cast<int>(data.connectivity.size()));
  const int n = type.nodes(), dimension = kind.dimension(), points = 24;
  std::vector<double> matrix(n * n, 0.0);
  // Two Gauss points in each of many intervals, per direction of a cube that is collapsed.
  std::vector<double> place;
  for (int i = 0; i < points; ++i)
  {
    for (double sign : { -1.0, 1.0 })
    {
      place.push_back((i + 0.5 + sign * 0.5 / std::sqrt(3.0)) / points);
    }
  }
  const double weight = std::pow(0.5 / points, dimension);
  const auto add = [&](const Vec3& at, double w)
  {
    const Shapes shapes(type, at);
    Vec3 column[3] = { { 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, dimension == 2 ? 1.0 : 0.0 } };
    for (int d = 0; d < dimension; ++d)
    {
      for (int k = 0; k < n; ++k)
      {
        column[d] += shapes.derivative[d][k] * data.point(data.connectivity[k]);
      }
    }
    const double det = dot(column[0], cross(column[1], column[2]));
    const Vec3 row[3] = { (1 / det) * cross(column[1], column[2]),
      (1 / det) * cross(column[2], column[0]), (1 / det) * cross(column[0], column[1]) };
    std::vector<Vec3> gradient(n, Vec3{ 0, 0, 0 });
    for (int k = 0; k < n; ++k)
    {
      for (int d = 0; d < dimension; ++d)
      {
        gradient[k] += shapes.derivative[d][k] * row[d];
      }
    }
    for (int i = 0; i < n * n; ++i)
    {
      matrix[i] += w * std::abs(det) *
        (dot(gradient[i / n], gradient[i % n]) + shapes.value[i / n] * shapes.value[i % n]);
    }
  };
  for (double x : place)
  {
    for (double y : place)
    {
      if (dimension == 2)
      {
        add({ x * (1 - y), y, 0 }, weight * (1 - y));
        continue;
      }
      for (double z : place)
      {
        add({ x * (1 - y) * (1 - z), y * (1 - z), z }, weight * (1 - y) * (1 - z) * (1 - z));
      }
    }
  }
  return matrix;
}

TAUTLINE_PART(testMatrices)
{
  TAUTLINE_LET(DiffusionOperator, pde, reaction = 1);
  for (const Kind& kind : kinds)
  {
    const Context context(kind.name);
    // Straight cells: exact up to the error of the comparison. Curved ones: the integrand is no
    // polynomial.
    for (const auto& [size, tolerance] :
      { std::pair<double, double>{ 0, 1e-5 }, std::pair<double, double>{ 0.05, 1e-3 } })
    {
      const MeshData data = curvedCell(kind, size);
      const SparseMatrix a = stiffnessMatrix(Mesh(data.view()), pde);
      const std::vector<double> expected = independentMatrix(data, kind);
      const auto n = static_cast<Index>(data.connectivity.size());
      const double largest = largestOf<double>(0, expected, [](double v) { return std::abs(v); });
      for (Index i = 0; i < n * n; ++i)
      {
        const Index row = data.connectivity[i / n], column = data.connectivity[i % n];
        TAUTLINE_CHECK_NEAR(a.at(row, column), expected[i], tolerance * largest);
      }
    }
  }
  // The mass matrix of a tetrahedron, times 420 over its volume (O. C. Zienkiewicz, R. L. Taylor,
  // The Finite Element Method): corners, then edges 01 12 20 03 13 23.
  pde.tensor = { 0, 0, 0, 0, 0, 0 };
  const MeshData data = curvedCell(kinds[2], 0);
  const SparseMatrix mass = stiffnessMatrix(Mesh(data.view()), pde);
  const double unit = sumOf<double>(0, mass.values, [](double v) { return v; }) / 420;
  const auto at = [&](Index i, Index j)
  { return mass.at(data.connectivity[i], data.connectivity[j]) / unit; };
  TAUTLINE_CHECK_NEAR(at(0, 0), 6, 1e-11);
  TAUTLINE_CHECK_NEAR(at(0, 1), 1, 1e-11);
  TAUTLINE_CHECK_NEAR(at(0, 4), -4, 1e-11);
  TAUTLINE_CHECK_NEAR(at(0, 5), -6, 1e-11);
  TAUTLINE_CHECK_NEAR(at(4, 4), 32, 1e-11);
  TAUTLINE_CHECK_NEAR(at(4, 5), 16, 1e-11);
  TAUTLINE_CHECK_NEAR(at(4, 9), 8, 1e-11);
  TAUTLINE_CHECK_NEAR(unit * 420,
    valuesOf(singleCell(CellType::Tetrahedron, idealCell(CellType::Tetrahedron)), Metric::Size)[0],
    1e-14);
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testSymmetryAndThreads)
{
  for (const Kind& kind : kinds)
  {
    const Context context(kind.name);
    const MeshData data = shuffled(block(kind, 3, true), 5);
    const Mesh mesh(data.view());
    TAUTLINE_LET(DiffusionOperator, pde, reaction = 2);
    for (bool elastic : { false, true })
    {
      const auto assemble = [&](int threads)
      {
        TAUTLINE_LET(AssemblyOptions, options, threads = threads);
        return elastic ? stiffnessMatrix(mesh, ElasticOperator(), options)
                       : stiffnessMatrix(mesh, pde, options);
      };
      SparseMatrix one = assemble(1);
      const SparseMatrix four = assemble(4);
      TAUTLINE_CHECK(one.values == four.values && one.columns == four.columns);
      const std::vector<double> before = one.values;
      TAUTLINE_CHECK(symmetrize(one) == 0.0 && one.values == before);
    }
    // Rigid motions have no energy, also on curved elements.
    const SparseMatrix a = stiffnessMatrix(mesh, ElasticOperator());
    const int d = kind.dimension();
    std::vector<double> turn(a.size), y(a.size);
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      turn[d * i] = -data.point(i)[1] + 3;
      turn[d * i + 1] = data.point(i)[0] - 2;
    }
    a.multiply(turn.data(), y.data());
    TAUTLINE_CHECK(largestOf<double>(0, y, [](double v) { return std::abs(v); }) < 1e-12);
  }
}

//------------------------------------------------------------------------------
/// Quadratic functions are exact on straight elements, linear ones on curved ones.
TAUTLINE_PART(testPatch)
{
  for (const Kind& kind : kinds)
  {
    for (bool bent : { false, true })
    {
      const Context context(std::string(kind.name) + (bent ? ", curved" : ""));
      const MeshData data = shuffled(block(kind, 3, bent), 11);
      const bool solid = kind.dimension() == 3;
      const auto u = [&](const Vec3& p)
      {
        const double linear = 1 + p[0] - 2 * p[1] + (solid ? 3 * p[2] : 0.0);
        return linear +
          (bent ? 0.0
                : p[0] * p[0] + 2 * p[0] * p[1] - 3 * p[1] * p[1] + (solid ? p[1] * p[2] : 0.0));
      };
      std::vector<double> values;
      TAUTLINE_EACH(Index, i, data.numberOfPoints(), values.push_back(u(data.point(i))));
      TAUTLINE_LET(EllipticProblem, problem, source = Vec3({ bent ? 0.0 : 4.0, 0, 0 }),
        fixedValues = values.data());
      const Mesh mesh(data.view());
      const EllipticSystem system(mesh, problem);
      TAUTLINE_LET(SolverOptions, options, method = KrylovMethod::Direct);
      const EllipticSolution solution = system.solve(options);
      TAUTLINE_EACH(
        std::size_t, i, values.size(), TAUTLINE_CHECK_NEAR(solution.values[i], values[i], 1e-11));
      // The gradient of the quadratic function at the center of each cell.
      for (Index cell = 0; !bent && cell < data.numberOfCells(); ++cell)
      {
        Vec3 p = { 0, 0, 0 };
        const int corners = kind.dimension() + 1;
        TAUTLINE_EACH(int, k, corners, p += (1.0 / corners) * data.point(data.nodes(cell)[k]));
        TAUTLINE_CHECK_NEAR(solution.gradients[3 * cell], 1 + 2 * p[0] + 2 * p[1], 1e-9);
        TAUTLINE_CHECK_NEAR(
          solution.gradients[3 * cell + 1], -2 + 2 * p[0] - 6 * p[1] + (solid ? p[2] : 0.0), 1e-9);
      }
    }
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testConvergenceInBlocks)
{
  for (const Kind& kind : kinds)
  {
    const Index n = kind.dimension() == 2 ? 12 : 4;
    for (Pde pde : { Pde::Poisson, Pde::Elliptic, Pde::Elasticity })
    {
      for (bool bent : { false, true })
      {
        const std::string name = std::string(kind.name) + (bent ? ", curved" : ", straight") +
          ", problem " + std::to_string(static_cast<int>(pde));
        const Context context(name);
        checkOrders(name.c_str(), errorOf(kind, block(kind, n, bent), pde),
          errorOf(kind, block(kind, 2 * n, bent), pde));
      }
    }
  }
}

/// A disk and a ball, whose boundary is interpolated by the elements.
TAUTLINE_PART(testConvergenceInBalls)
{
  for (const Kind& kind : kinds)
  {
    const int refinements = kind.dimension() == 2 ? 4 : 3;
    const std::string name = std::string(kind.name) + ", ball";
    const Context context(name);
    checkOrders(name.c_str(),
      errorOf(kind, quadraticBall(kind.type, refinements, kind.center), Pde::Poisson),
      errorOf(kind, quadraticBall(kind.type, refinements + 1, kind.center), Pde::Poisson));
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testBoundary)
{
  // The points of a block of n cubes and half steps: all inside are free.
  for (const Kind& kind : kinds)
  {
    const Context context(kind.name);
    for (Index n : { 2, 3 })
    {
      const MeshData data = block(kind, n, true);
      const Index inside = 2 * n - 1, square = inside * inside;
      const Index centers = kind.center ? data.numberOfCells() : 0;
      const Mesh mesh(data.view());
      // A tetrahedron has no node at the center of a cube that has one in the middle of its edge:
      // the five tetrahedra of a cube leave its center without one.
      Index expected = square + centers;
      if (kind.dimension() == 3)
      {
        expected = square * inside - n * n * n;
      }
      TAUTLINE_CHECK_EQUAL(EllipticSystem(mesh, EllipticProblem()).unknowns(), expected);
    }
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testContributions)
{
  for (const Kind& kind : kinds)
  {
    const Context context(kind.name);
    const MeshData data = block(kind, 2, true);
    const Mesh mesh(data.view());
    for (Pde pde : { Pde::Poisson, Pde::Elasticity })
    {
      TAUTLINE_LET(EllipticProblem, problem, pde = pde, source = Vec3({ 1, 0, 0 }));
      const EllipticSystem system(mesh, problem);
      const ElementContributions found = elementContributions(system, true);
      TAUTLINE_CHECK(found.lowerBound > 0 && found.lowerBound <= found.bound);
      TAUTLINE_CHECK_NEAR(sumOf<double>(0, found.share, [](double v) { return v; }), 1, 1e-10);
    }
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testRejections)
{
  const auto solve = [](const MeshData& data)
  {
    const Mesh mesh(data.view());
    const EllipticSystem system(mesh, EllipticProblem());
  };
  // A linear cell beside quadratic ones.
  MeshData data = block(kinds[0], 2, false);
  data.addPoints({ { 2, 0, 0 }, { 2, 1, 0 } });
  data.addCell(CellType::Triangle, { 2, data.numberOfPoints() - 2, data.numberOfPoints() - 1 });
  TAUTLINE_CHECK_THROWS(solve(data), wording("1-linear-and-8-quadratic-elements"));

  // Other curved cells.
  constexpr int biquadratic = 28;
  MeshData square;
  square.addPoints({ { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0.5, 0, 0 },
    { 1, 0.5, 0 }, { 0.5, 1, 0 }, { 0, 0.5, 0 }, { 0.5, 0.5, 0 } });
  square.addCell(biquadratic, { 0, 1, 2, 3, 4, 5, 6, 7, 8 });
  TAUTLINE_CHECK_THROWS(solve(square), wording("1-cells-are-of-higher-order"));

  // Two nodes in the middle of an edge.
  data = block(kinds[0], 2, false);
  const Index node = data.connectivity[5];
  data.connectivity[5] = data.addPoint(data.point(node));
  TAUTLINE_CHECK_THROWS(solve(data), wording("1-edge-has-several-nodes"));

  // Folded between valid corners: the node of the edge from (1, 0) to (0, 1) near the corner.
  MeshData folded =
    quadraticOf(singleCell(CellType::Triangle, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } }));
  MeshData other = block(kinds[0], 2, false);
  const Index first = other.numberOfPoints();
  std::vector<Index> nodes;
  for (Index i = 0; i < folded.numberOfPoints(); ++i)
  {
    other.addPoint(folded.point(i) + Vec3{ 3, 0, 0 });
  }
  TAUTLINE_EACH(
    std::size_t, k, folded.connectivity.size(), nodes.push_back(first + folded.connectivity[k]));
  other.addCell(QuadraticTriangle, nodes);
  solve(other);
  other.setPoint(nodes[4], { 3.2, 0.2, 0 }); // valid above 1/4
  TAUTLINE_CHECK_THROWS(solve(other), wording("1-element-the-first-is-cell-8-inverted"));
  other.setPoint(nodes[4], { 3.3, 0.3, 0 });
  solve(other);

  // The sums of the rows of the mass matrix are 0 at corners.
  const MeshData good = block(kinds[0], 2, true);
  const Mesh mesh(good.view());
  const EllipticSystem system(mesh, EllipticProblem());
  TAUTLINE_CHECK_THROWS(
    massMatrix(system, MassMatrix::Lumped), wording("choose-the-consistent-mass-matrix"));
  TAUTLINE_CHECK(massMatrix(system, MassMatrix::Consistent).size > 0);
}

//------------------------------------------------------------------------------
/// Lagrange cells of the same nodes have the same matrix.
TAUTLINE_PART(testLagrangeCells)
{
  constexpr int lagrangeTriangle = 69, lagrangeTetrahedron = 71;
  for (const Kind& kind : kinds)
  {
    const Context context(kind.name);
    const MeshData data = block(kind, 2, true);
    MeshData lagrange = data;
    std::fill(lagrange.types.begin(), lagrange.types.end(),
      static_cast<unsigned char>(kind.dimension() == 3 ? lagrangeTetrahedron : lagrangeTriangle));
    const SparseMatrix a = stiffnessMatrix(Mesh(data.view()), DiffusionOperator()),
                       b = stiffnessMatrix(Mesh(lagrange.view()), DiffusionOperator());
    TAUTLINE_CHECK(a.values == b.values && a.columns == b.columns);
  }
}
}
