// SPDX-License-Identifier: BSD-3-Clause
// The positive semidefinite part of Hessians, and multigrid as a preconditioner for it.

#include "Blocks.h"
#include "Registry.h"
#include "tautline/Objectives/HessianMatrix.h"

using namespace tautline;

namespace
{
using Vector = std::vector<double>;

double dot(const Vector& a, const Vector& b)
{
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

double norm(const Vector& a)
{
  return std::sqrt(dot(a, a));
}

Vector randomVector(std::size_t n, unsigned seed)
{
  std::mt19937 random(seed);
  Vector v(n);
  for (double& x : v)
  {
    x = random() / 4294967296.0 - 0.5;
  }
  return v;
}

/// The unit square or cube in n cells a side; of the inner points y is raised to a power.
MeshData stretched(CellType type, Index n, double power)
{
  MeshData data = blockMesh(type, n, n, topology(type).dimension == 3 ? n : 0);
  const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 p = (1.0 / static_cast<double>(n)) * data.point(i);
    data.setPoint(i, boundary[i] ? p : Vec3{ p[0], std::pow(p[1], power), p[2] });
  }
  return data;
}

/// The rows of the points inside, or of all.
HessianMatrix matrixOf(const Mesh& mesh, bool inside, int threads = 1)
{
  const std::vector<char> boundary = mesh.boundary().isBoundaryPoint;
  std::vector<std::int32_t> rows(boundary.size(), -1);
  std::int32_t count = 0;
  for (std::size_t p = 0; p < rows.size(); ++p)
  {
    rows[p] = inside && boundary[p] ? -1 : count++;
  }
  return HessianMatrix(mesh, rows, count, HessianMatrix::Pattern::Full, threads);
}

Vector times(const HessianMatrix& matrix, const Vector& d)
{
  Vector product(d.size());
  matrix.times(d.data(), product.data());
  return product;
}

//------------------------------------------------------------------------------
/// No direction curves downwards, also where the whole Hessian has such.
TAUTLINE_PART(testSemidefinite)
{
  for (CellType type : { CellType::Triangle, CellType::Quadrilateral, CellType::Tetrahedron,
         CellType::Hexahedron, CellType::Wedge })
  {
    const Context name(topology(type).plural);
    const MeshData data = stretched(type, 4, 3);
    const Mesh mesh(data.view());
    const ObjectiveSum sum(mesh, Objective());
    TAUTLINE_CHECK(HessianMatrix::hasConvexPart(sum));
    HessianMatrix whole = matrixOf(mesh, false), convex = matrixOf(mesh, false);
    whole.add(sum, 1);
    convex.addConvexPart(sum, 1);
    for (unsigned seed = 0; seed < 20; ++seed)
    {
      const Vector d = randomVector(convex.size(), seed);
      TAUTLINE_CHECK(dot(d, times(convex, d)) > 0);
    }
    // The objective does not depend on the scale: H x = -g and x . H x = -x . g = 0, so that the
    // Hessian is not definite; its positive part is more than the rest here.
    Vector x;
    const int size = convex.blockSize();
    for (Index p = 0; p < data.numberOfPoints(); ++p)
    {
      const Vec3 axes[3] = { coordinateAxes(mesh)[0], coordinateAxes(mesh)[1],
        coordinateAxes(mesh)[2] };
      for (int a = 0; a < size; ++a)
      {
        x.push_back(tautline::dot(data.point(p), axes[a]));
      }
    }
    const double curvature = dot(x, times(convex, x));
    TAUTLINE_CHECK(std::abs(dot(x, times(whole, x))) < 1e-9 * curvature);
  }
}

/// The omitted terms cancel in a grid of equal cells: both Hessians have the same rows inside.
TAUTLINE_PART(testCancellation)
{
  for (CellType type : { CellType::Triangle, CellType::Quadrilateral, CellType::Hexahedron })
  {
    const Context name(topology(type).plural);
    for (double power : { 1.0, 2.0 })
    {
      const MeshData data = stretched(type, 6, power);
      const Mesh mesh(data.view());
      const ObjectiveSum sum(mesh, Objective());
      HessianMatrix whole = matrixOf(mesh, true), convex = matrixOf(mesh, true);
      whole.add(sum, 1);
      convex.addConvexPart(sum, 1);
      const Vector d = randomVector(whole.size(), 7);
      Vector difference = times(whole, d);
      const Vector product = times(convex, d);
      for (std::size_t i = 0; i < difference.size(); ++i)
      {
        difference[i] -= product[i];
      }
      const bool equal = norm(difference) < 1e-10 * norm(product);
      TAUTLINE_CHECK(equal == (power == 1.0));
    }
  }
}

//------------------------------------------------------------------------------
/// Flexible conjugate gradients; the iterations to a relative residual of 1e-8.
int solve(HessianMatrix& matrix, const Vector& b, Vector& x)
{
  constexpr int most = 200;
  Vector r = b, z(b.size()), d;
  x.assign(b.size(), 0.0);
  matrix.precondition(r.data(), z.data());
  d = z;
  double rz = dot(r, z);
  for (int i = 1; i <= most; ++i)
  {
    const Vector product = times(matrix, d), old = r;
    const double a = rz / dot(d, product);
    for (std::size_t k = 0; k < r.size(); ++k)
    {
      x[k] += a * d[k];
      r[k] -= a * product[k];
    }
    if (norm(r) <= 1e-8 * norm(b))
    {
      return i;
    }
    matrix.precondition(r.data(), z.data());
    TAUTLINE_CHECK(dot(r, z) > 0);
    const double beta = (dot(r, z) - dot(old, z)) / rz;
    rz = dot(r, z);
    for (std::size_t k = 0; k < r.size(); ++k)
    {
      d[k] = z[k] + beta * d[k];
    }
  }
  return most;
}

/// A solution is found again, in few iterations whatever the size of the grid and its stretching.
TAUTLINE_PART(testSolve)
{
  struct Case
  {
    CellType type;
    Index cells;
    double power;
    int iterations;
  };
  for (const Case& c :
    { Case{ CellType::Quadrilateral, 6, 1, 2 }, Case{ CellType::Quadrilateral, 32, 1, 20 },
      Case{ CellType::Quadrilateral, 128, 1, 24 }, Case{ CellType::Quadrilateral, 128, 1.5, 90 },
      Case{ CellType::Triangle, 64, 1.5, 40 }, Case{ CellType::Hexahedron, 20, 1, 20 },
      Case{ CellType::Hexahedron, 20, 1.5, 40 }, Case{ CellType::Tetrahedron, 12, 1.5, 40 } })
  {
    const Context name(std::string(topology(c.type).plural) + ", " + std::to_string(c.cells) +
      " a side, power " + std::to_string(c.power));
    const MeshData data = stretched(c.type, c.cells, c.power);
    const Mesh mesh(data.view());
    const ObjectiveSum sum(mesh, Objective());
    HessianMatrix matrix = matrixOf(mesh, true);
    matrix.addConvexPart(sum, 1);
    matrix.factorizeByMultigrid();
    const Vector expected = randomVector(matrix.size(), 3), b = times(matrix, expected);
    Vector x;
    const int iterations = solve(matrix, b, x);
    TAUTLINE_CHECK(iterations <= c.iterations);
    if (iterations > c.iterations)
    {
      std::cerr << iterations << " iterations\n";
    }
    Vector error = times(matrix, x);
    for (std::size_t i = 0; i < error.size(); ++i)
    {
      error[i] -= b[i];
    }
    TAUTLINE_CHECK(norm(error) <= 2e-8 * norm(b));
  }
}

/// Where no point is held, translations are no part of what it gives, whatever is in the residual.
TAUTLINE_PART(testFloating)
{
  for (const auto& [type, n] :
    { std::pair(CellType::Quadrilateral, Index(5)), std::pair(CellType::Quadrilateral, Index(24)),
      std::pair(CellType::Hexahedron, Index(3)), std::pair(CellType::Hexahedron, Index(7)) })
  {
    const Context name(std::to_string(n) + ", " + topology(type).plural);
    const MeshData data = stretched(type, n, 2);
    const Mesh mesh(data.view());
    const ObjectiveSum sum(mesh, Objective());
    HessianMatrix matrix = matrixOf(mesh, false);
    matrix.addConvexPart(sum, 1);
    matrix.factorizeByMultigrid();
    const auto size = static_cast<std::size_t>(matrix.blockSize());
    Vector z(matrix.size());
    matrix.precondition(randomVector(z.size(), 4).data(), z.data());
    for (std::size_t c = 0; c < size; ++c)
    {
      double total = 0;
      for (std::size_t i = c; i < z.size(); i += size)
      {
        total += z[i];
      }
      TAUTLINE_CHECK(std::abs(total) <= 1e-10 * norm(z));
    }
  }
}

/// The same numbers for any number of threads, and with the aggregates of an earlier matrix.
TAUTLINE_PART(testThreads)
{
  const MeshData data = stretched(CellType::Quadrilateral, 150, 1.5);
  const Mesh mesh(data.view());
  Vector first[2];
  for (int threads : { 1, 2, 4 })
  {
    const ObjectiveSum sum(mesh, Objective(), threads);
    HessianMatrix matrix = matrixOf(mesh, true, threads);
    const Vector r = randomVector(matrix.size(), 5);
    for (Vector& expected : first)
    {
      matrix.addConvexPart(sum, 1);
      matrix.factorizeByMultigrid();
      Vector z(r.size());
      matrix.precondition(r.data(), z.data());
      expected = threads == 1 ? z : expected;
      TAUTLINE_CHECK(z == expected && norm(z) > 0);
    }
    // The second matrix is twice the first.
    double difference = largestOf<double>(
      0, r.size(), [&](std::size_t i) { return std::abs(2 * first[1][i] - first[0][i]); });
    TAUTLINE_CHECK(difference <= 1e-12 * norm(first[0]));
  }
}

/// A point without elements, and a mesh of one free point.
TAUTLINE_PART(testSmall)
{
  const MeshData data = stretched(CellType::Quadrilateral, 2, 1);
  const Mesh mesh(data.view());
  const ObjectiveSum sum(mesh, Objective());
  HessianMatrix matrix = matrixOf(mesh, true);
  TAUTLINE_CHECK(matrix.size() == 2);
  matrix.addConvexPart(sum, 1);
  matrix.factorizeByMultigrid();
  Vector z(2);
  const Vector r = { 1, -2 };
  matrix.precondition(r.data(), z.data());
  const Vector back = times(matrix, z);
  TAUTLINE_CHECK_NEAR(back[0], 1, 1e-12);
  TAUTLINE_CHECK_NEAR(back[1], -2, 1e-12);
  matrix.clear();
  matrix.factorizeByMultigrid();
  matrix.precondition(r.data(), z.data());
  TAUTLINE_CHECK(std::isfinite(z[0]) && std::isfinite(z[1]));
}
}
