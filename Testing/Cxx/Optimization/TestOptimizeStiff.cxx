// SPDX-License-Identifier: BSD-3-Clause
// optimize() on sheared and strongly stretched meshes.
#include "Registry.h"
#include "Sanitized.h"
#include "StretchedMeshes.h"
#include "tautline/Core/Memory.h"

#include <sys/resource.h>

using namespace tautline;

namespace
{
/// Stiff meshes of some thousand points: the same result for any number of threads, and few
/// iterations from the harmonic map, which is the minimum here.
TAUTLINE_PART(testStiffThreads)
{
  const MeshData data =
    stretched(CellType::Quadrilateral, 96, TAUTLINE_PLACE(p[0], p[1] * p[1] * p[1] * p[1], p[2]));
  for (Optimizer optimizer : { Optimizer::Automatic, Optimizer::NewtonConjugateGradient })
  {
    const Context which("optimizer " + std::to_string(static_cast<int>(optimizer)));
    TAUTLINE_LET(OptimizeOptions, options, optimizer = optimizer);
    // Newton's method alone takes long: some of its iterations will do.
    options.stopping.maximumIterations = optimizer == Optimizer::Automatic ? 300 : 12;
    options.threads = 1;
    const OptimizeResult one = run(data, options);
    options.threads = 3;
    const OptimizeResult three = run(data, options);
    TAUTLINE_CHECK(one.points == three.points && one.iterations == three.iterations);
    if (optimizer == Optimizer::Automatic)
    {
      TAUTLINE_CHECK_RELATIVE(one.history.back().objective, 96.0 * 96.0, 1e-6);
      TAUTLINE_CHECK(one.iterations <= 12);
    }
  }
}

/// On three quarters of a ring the harmonic map is not the minimum.
TAUTLINE_PART(testStiffRing)
{
  MeshData data =
    stretched(CellType::Quadrilateral, 40, TAUTLINE_PLACE(p[0], p[1] * p[1] * p[1], p[2]));
  data.transform(
    [](const Vec3& p)
    {
      const double angle = 1.5 * Pi * p[0], radius = 0.2 + p[1];
      return Vec3{ radius * std::sin(angle), radius * std::cos(angle), 0 };
    });
  TAUTLINE_LET(OptimizeOptions, accurate, optimizer = Optimizer::NewtonConjugateGradient,
    stopping.relativeChange = 1e-10, stopping.maximumIterations = 1000);
  const double least = run(data, accurate).history.back().objective;
  const OptimizeResult result = run(data, OptimizeOptions());
  TAUTLINE_CHECK(result.invertedAfter == 0);
  TAUTLINE_CHECK(result.history.front().objective > 10 * least);
  TAUTLINE_CHECK(result.history.back().objective <= 1.0001 * least);
}

/// Sheared and strongly stretched meshes, on which sweeps take thousands of iterations: the default
/// and Newton's method reach the minimum, and stop there for the right reason.
TAUTLINE_PART(testStiff)
{
  const auto cubed = TAUTLINE_PLACE(p[0], p[1] * p[1] * p[1], p[2]);
  const std::pair<const char*, MeshData> cases[] = {
    { "sine", stretched(CellType::Quadrilateral, 64, sheared) },
    { "power", stretched(CellType::Quadrilateral, 64, fourthPower) },
    { "power of triangles", stretched(CellType::Triangle, 32, fourthPower) },
    { "power of hexahedra", stretched(CellType::Hexahedron, 12, cubed) },
    { "power of tetrahedra", stretched(CellType::Tetrahedron, 8, cubed) }
  };
  for (const auto& [name, data] : cases)
  {
    const Context context(name);
    const CellType type = static_cast<CellType>(data.view().cellTypes[0]);
    TAUTLINE_LET(OptimizeOptions, accurate, optimizer = Optimizer::NewtonConjugateGradient,
      stopping.relativeChange = 1e-10, stopping.maximumIterations = 1000);
    const OptimizeResult best = run(data, accurate);
    const double least = best.history.back().objective;
    if (type == CellType::Quadrilateral || type == CellType::Hexahedron)
    {
      // The uniform grid.
      TAUTLINE_CHECK_RELATIVE(least, static_cast<double>(data.numberOfCells()), 1e-8);
    }
    for (Optimizer optimizer : { Optimizer::Automatic, Optimizer::NewtonConjugateGradient })
    {
      const Context which("optimizer " + std::to_string(static_cast<int>(optimizer)));
      TAUTLINE_LET(OptimizeOptions, options, optimizer = optimizer);
      const OptimizeResult result = run(data, options);
      TAUTLINE_CHECK(result.history.back().objective <= 1.0001 * least);
      TAUTLINE_CHECK(result.reason == StopReason::RelativeChange);
      TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
      TAUTLINE_CHECK_EQUAL(static_cast<std::size_t>(result.iterations), result.history.size() - 1);
    }
    // Out of time, the best result so far is returned, by the sweeps or by Newton's method.
    TAUTLINE_LET(OptimizeOptions, few, stopping.maximumIterations = 5);
    const OptimizeResult stopped = run(data, few);
    OptimizeOptions sweeps = few;
    TAUTLINE_SET(sweeps, optimizer = Optimizer::LocalNewton, stopping.maximumIterations = 4);
    const OptimizeResult swept = run(data, sweeps);
    const double reached = sumOfSquares(data, stopped.points, Metric::InverseMeanRatio);
    TAUTLINE_CHECK(
      reached <= 1.000001 * sumOfSquares(data, swept.points, Metric::InverseMeanRatio));
    TAUTLINE_CHECK_RELATIVE(stopped.history.back().objective, reached, 1e-9);
    TAUTLINE_CHECK(stopped.reason == StopReason::IterationLimit || reached <= 1.0001 * least);
    // Quadrilaterals and hexahedra begin with it.
    TAUTLINE_CHECK((type != CellType::Quadrilateral && type != CellType::Hexahedron) ||
      reached < 0.9 * sumOfSquares(data, swept.points, Metric::InverseMeanRatio));
  }
}

/// Few quadrilaterals among triangles make sweeps slow, not Newton's method: it comes first.
TAUTLINE_PART(testFewQuadrilaterals)
{
  constexpr Index n = 30, every = 20;
  const MeshData quads = perturbedBlock(CellType::Quadrilateral, n, 0.2);
  TAUTLINE_LET(MeshData, data, points = quads.points);
  for (Index c = 0; c < quads.numberOfCells(); ++c)
  {
    const Index* q = &quads.connectivity[quads.offsets[c]];
    if (c % every == 0)
    {
      data.addCell(CellType::Quadrilateral, std::vector<Index>{ q[0], q[1], q[2], q[3] });
      continue;
    }
    const Index shift = c / 7 % 2;
    data.addCell(CellType::Triangle, std::vector<Index>{ q[shift], q[shift + 1], q[shift + 2] });
    data.addCell(
      CellType::Triangle, std::vector<Index>{ q[shift], q[shift + 2], q[(shift + 3) % 4] });
  }
  TAUTLINE_LET(OptimizeOptions, options, holdWorst = false);
  const OptimizeResult result = run(data, options);
  options.optimizer = Optimizer::LocalNewton;
  const OptimizeResult swept = run(data, options);
  TAUTLINE_CHECK(result.history.back().objective <= 1.0001 * swept.history.back().objective);
  TAUTLINE_CHECK(result.iterations <= 10);
  TAUTLINE_CHECK(swept.iterations > 20);
}

/// Where the matrix of Newton's method does not fit into memory, the sweeps go on, or begin.
/// @param beforeNewton sweeps before it is tried
/// @param mebibytes left for it: the sweeps need less, the matrix alone 11, its grids as much
void testMemory(CellType type, int beforeNewton, double mebibytes)
{
  const MeshData data = stretched(type, 200, TAUTLINE_PLACE(p[0], p[1] * p[1], p[2]));
  constexpr int sweeps = 12;
  TAUTLINE_LET(OptimizeOptions, options, threads = 1, stopping.maximumIterations = sweeps);
  OptimizeOptions local = TAUTLINE_CHANGED(options, optimizer = Optimizer::LocalNewton);
  const OptimizeResult expected = run(data, local);
  const OptimizeResult usual = run(data, options);
  TAUTLINE_CHECK(usual.history.back().objective < 0.9 * expected.history.back().objective);

  rlimit before{};
  getrlimit(RLIMIT_DATA, &before);
  options.observer = [=](const IterationState& state)
  {
    if (state.record.iteration == beforeNewton)
    {
      constexpr double mebibyte = 1048576;
      limitMemory(mebibytes * mebibyte);
    }
    return true;
  };
  const OptimizeResult result = run(data, options);
  setrlimit(RLIMIT_DATA, &before);
  TAUTLINE_CHECK_EQUAL(result.iterations, sweeps);
  TAUTLINE_CHECK(result.reason == StopReason::IterationLimit);
  // The first sweep after the way back visits all vertices again.
  TAUTLINE_CHECK_RELATIVE(result.history.back().objective, expected.history.back().objective, 0.01);
  TAUTLINE_CHECK(result.history.back().objective < result.history[beforeNewton].objective);
}
}

TAUTLINE_TEST(TestOptimizeStiff)
{
  if (!TAUTLINE_ADDRESS_SANITIZER)
  {
    // With less memory the harmonic map does not fit, either.
    for (const double mebibytes : { 2.0, 14.0 })
    {
      TAUTLINE_RUN(testMemory(CellType::Quadrilateral, 0, mebibytes));
      TAUTLINE_RUN(testMemory(CellType::Triangle, 6, mebibytes));
    }
  }
}
