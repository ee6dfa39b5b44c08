// SPDX-License-Identifier: BSD-3-Clause
// Core: disjoint sets, Cholesky factors, sums of vectors, the memory of L-BFGS, the stopwatch.
#include "Meshes.h"
#include "Registry.h"
#include "tautline/Core/LimitedMemory.h"
#include "tautline/Core/SmallCholesky.h"
#include "tautline/Core/Stopwatch.h"
#include "tautline/Core/UnionFind.h"

using namespace tautline;

namespace
{
/// The root is the smallest member, whatever the order of the joins.
TAUTLINE_PART(testUnionFind)
{
  constexpr Index n = 60, step = 7;
  UnionFind up(n), down(n);
  for (Index i = 0; i + step < n; ++i)
  {
    up.join(i, i + step);
    down.join(n - 1 - i, n - 1 - i - step);
  }
  for (Index i = 0; i < n; ++i)
  {
    TAUTLINE_CHECK_EQUAL(up.find(i), i % step);
    TAUTLINE_CHECK_EQUAL(down.find(i), i % step);
  }
  UnionFind apart(n);
  apart.join(5, 5);
  TAUTLINE_CHECK_EQUAL(apart.find(5), Index(5));
  TAUTLINE_CHECK_EQUAL(apart.find(6), Index(6));
}

/// L L^T is the shifted matrix, and solve() inverts it; indefinite matrices are rejected.
template <int N, CholeskyDiagonal Diagonal>
void testCholesky()
{
  using Factor = SmallCholesky<N, Diagonal>;
  Random random(N);
  constexpr double shift = 0.25;
  double B[N][N], A[N][N], x[N], b[N], L[Factor::Entries];
  for (auto& row : B)
  {
    for (double& entry : row)
    {
      entry = random.uniform(-1, 1);
    }
  }
  for (int r = 0; r < N; ++r)
  {
    x[r] = random.uniform(-1, 1);
    for (int c = 0; c < N; ++c)
    {
      A[r][c] = 0;
      for (int k = 0; k < N; ++k)
      {
        A[r][c] += B[r][k] * B[c][k];
      }
    }
  }
  for (int r = 0; r < N; ++r)
  {
    b[r] = shift * x[r];
    for (int c = 0; c < N; ++c)
    {
      b[r] += A[r][c] * x[c];
    }
  }
  TAUTLINE_CHECK(Factor::factor(A, shift, 0.0, L));
  Factor::solve(L, b);
  TAUTLINE_EACH(int, r, N, TAUTLINE_CHECK_NEAR(b[r], x[r], 1e-12));
  double trace = sumOf<double>(0, N, [&](int r) { return A[r][r]; });
  TAUTLINE_CHECK(!Factor::factor(A, -trace, 0.0, L));
  TAUTLINE_CHECK(!Factor::factor(A, shift, trace + shift, L));
}

/// Both orders sum all entries, in one pass with an update or in two, on any number of threads.
TAUTLINE_PART(testSums)
{
  constexpr std::size_t size = 3 * ChunkSize + 5; // not a multiple of the lanes
  Random random(1);
  std::vector<double> a(size), b(size);
  double expected = 0, doubled = 0;
  for (std::size_t i = 0; i < size; ++i)
  {
    a[i] = random.uniform(-1, 1);
    b[i] = random.uniform(-1, 1);
    expected += a[i] * b[i];
    doubled += 2 * a[i] * b[i];
  }
  for (LaneOrder order : { LaneOrder::Sequential, LaneOrder::Halves })
  {
    const VectorAlgebra one(size, 1, order), four(size, 4, order);
    TAUTLINE_CHECK_NEAR(one.dot(a.data(), b.data()), expected, 1e-10);
    TAUTLINE_CHECK_EQUAL(one.dot(a.data(), b.data()), four.dot(a.data(), b.data()));
    std::vector<double> c = a;
    const auto twice = [](double x, Index) { return 2 * x; };
    TAUTLINE_CHECK_NEAR(one.updateAndDot(twice, c.data(), b.data()), doubled, 1e-10);
    TAUTLINE_CHECK_EQUAL(c[size - 1], 2 * a[size - 1]);
    one.addScaled(a.data(), -0.5, c.data(), c.data());
    TAUTLINE_CHECK_EQUAL(c[size / 2], 0.0);
  }
}

/// The secant equation: the approximate inverse takes y of the newest pair to s. Pairs along which
/// the function curves downwards are not kept.
TAUTLINE_PART(testLimitedMemory)
{
  constexpr std::size_t size = 12;
  const VectorAlgebra algebra(size, 1);
  LimitedMemory memory(algebra);
  const auto identity = [](std::vector<double>&) { return 1.0; };
  Random random(4);
  std::vector<double> before(size, 0.0), after(size), d(size), step(size);
  TAUTLINE_CHECK(memory.empty());
  // For the quadratic function with the Hessian diag(1, 2, ..., n); more steps than are kept.
  constexpr int steps = 11;
  for (int k = 0; k < steps; ++k)
  {
    for (std::size_t i = 0; i < size; ++i)
    {
      step[i] = random.uniform(-1, 1);
      after[i] = before[i] + 0.5 * static_cast<double>(i + 1) * step[i];
    }
    memory.add(0.5, step.data(), before.data(), after.data());
    const std::vector<double> y = memory.newest().y;
    const double slope = memory.direction(y, d, identity);
    double expected = 0;
    for (std::size_t i = 0; i < size; ++i)
    {
      TAUTLINE_CHECK_NEAR(d[i], -0.5 * step[i], 1e-12);
      expected += d[i] * y[i];
    }
    TAUTLINE_CHECK_NEAR(slope, expected, 1e-10);
    before = after;
  }
  memory.clear();
  TAUTLINE_CHECK(memory.empty());
  auto opposite = collect<double>(size, [&](std::size_t i) { return -step[i]; });
  memory.add(1.0, step.data(), std::vector<double>(size, 0.0).data(), opposite.data());
  TAUTLINE_CHECK(memory.empty());
  // Without pairs, the direction is the preconditioned gradient, downwards.
  const double slope = memory.direction(step, d,
    [](std::vector<double>& q)
    {
      for (double& x : q)
      {
        x *= 3;
      }
      return 0.5;
    });
  TAUTLINE_CHECK_NEAR(d[3], -1.5 * step[3], 1e-14);
  TAUTLINE_CHECK_NEAR(slope, -1.5 * algebra.dot(step.data(), step.data()), 1e-12);
}

/// Copies run from the same start; 0 is no limit.
TAUTLINE_PART(testStopwatch)
{
  const Stopwatch clock;
  while (!clock.reached(1e-3))
  {
  }
  const Stopwatch copy = clock;
  TAUTLINE_CHECK(copy.seconds() >= 1e-3);
  TAUTLINE_CHECK(copy.reached(1e-3));
  TAUTLINE_CHECK(!copy.reached(0) && !copy.reached(-1));
  TAUTLINE_CHECK(!copy.reached(1e9));
}
}

TAUTLINE_TEST(TestAlgebra)
{
  TAUTLINE_RUN(testCholesky<1, CholeskyDiagonal::Root>());
  TAUTLINE_RUN(testCholesky<3, CholeskyDiagonal::Root>());
  TAUTLINE_RUN(testCholesky<2, CholeskyDiagonal::InverseRoot>());
  TAUTLINE_RUN(testCholesky<3, CholeskyDiagonal::InverseRoot>());
  TAUTLINE_RUN(testCholesky<6, CholeskyDiagonal::InverseRoot>());
}
