// SPDX-License-Identifier: BSD-3-Clause
// Optimizers that move all points at once, on ranks: the result does not depend on how the mesh is
// cut, and is as good as the result of one process in its own order.
#include "OptimizingRanks.h"
#include "Registry.h"
#include "StretchedMeshes.h"
#include "tautline/Core/Memory.h"
#include "tautline/Untangling/Untangle.h"

using namespace tautline;

namespace
{
constexpr std::pair<const char*, Optimizer> optimizers[] = {
  { "Fletcher-Reeves", Optimizer::ConjugateGradientFletcherReeves },
  { "Polak-Ribiere", Optimizer::ConjugateGradientPolakRibiere },
  { "L-BFGS", Optimizer::LimitedMemoryBFGS },
  { "Newton-CG", Optimizer::NewtonConjugateGradient },
};

std::vector<int> numbersOfRanks = { 2, 3, 4 };

/// Runs on one rank and on several, and compares; returns the run on one.
Run testCuts(const MeshData& whole, const OptimizeOptions& options,
  Constraint constraint = Constraint::FixedBoundary)
{
  constexpr double close = 1e-10;
  const Run one = runOn(whole, Cut::FirstOnly, 1, options, constraint);
  const std::vector<IterationRecord>& expected = one.result.history;
  TAUTLINE_CHECK(expected.back().objective <= expected.front().objective);
  forEachCut(numbersOfRanks,
    [&](Cut cut, int ranks)
    {
      if (cut == Cut::FirstOnly && ranks != numbersOfRanks[numbersOfRanks.size() / 2])
      {
        return;
      }
      const Run run = runOn(whole, cut, ranks, options, constraint);
      TAUTLINE_CHECK(farthest(run.points, one.points) <= close);
      TAUTLINE_CHECK_EQUAL(run.result.history.size(), expected.size());
      TAUTLINE_CHECK_RELATIVE(
        run.result.history.back().objective, expected.back().objective, close);
      TAUTLINE_CHECK_EQUAL(
        static_cast<int>(run.result.reason), static_cast<int>(one.result.reason));
      TAUTLINE_CHECK_EQUAL(run.result.freeVertices, one.result.freeVertices);
      TAUTLINE_CHECK_EQUAL(run.result.invertedAfter, one.result.invertedAfter);
      TAUTLINE_CHECK_EQUAL(run.result.restored, one.result.restored);
    });
  return one;
}

/// The same on one process without ranks: converged objectives agree to 1e-6, validity is equal.
Run testAgainstOne(const std::string& name, const MeshData& whole, OptimizeOptions options,
  Constraint constraint = Constraint::FixedBoundary)
{
  const Context context(name);
  const Run run = testCuts(whole, options, constraint);
  const Mesh mesh(whole.view());
  BoundaryShape shape;
  if (constraint == Constraint::Sliding)
  {
    shape = boundaryShape(mesh, 1.0);
    options.fixed = shape.fixed.data();
    options.slidePlanes = shape.planes.data();
    options.slideLines = shape.lines.data();
  }
  const OptimizeResult usual = optimize(mesh, options);
  const double now = run.result.history.back().objective, then = usual.history.back().objective;
  TAUTLINE_CHECK(std::abs(now - then) <= 1e-6 * std::abs(then));
  TAUTLINE_CHECK(run.result.reason == usual.reason);
  TAUTLINE_CHECK_EQUAL(run.result.invertedAfter, usual.invertedAfter);
  TAUTLINE_CHECK_EQUAL(run.result.freeVertices, usual.freeVertices);
  std::cout << name << ": " << run.result.iterations << " and " << usual.iterations
            << " iterations, objectives differ by " << now / then - 1 << ", points by "
            << farthest(run.points, usual.points) << "\n";
  return run;
}

OptimizeOptions converging(OptimizeOptions options, Optimizer optimizer)
{
  options.optimizer = optimizer;
  options.stopping.relativeChange = 1e-9;
  options.stopping.gradientNorm = 1e-7;
  options.stopping.maximumIterations = 1000;
  return options;
}

void testOptimizers()
{
  const MeshData tets = jittered(CellType::Tetrahedron, 5, 0.2);
  const MeshData hexes = jittered(CellType::Hexahedron, 5, 0.2);
  const MeshData triangles = jittered(CellType::Triangle, 9, 0.25);
  for (const auto& [name, optimizer] : optimizers)
  {
    const std::string by(name);
    const OptimizeOptions options = converging(with({ Metric::InverseMeanRatio }), optimizer);
    const Run tetrahedra = testAgainstOne(by + ", tetrahedra", tets, options);
    TAUTLINE_CHECK(tetrahedra.result.history.back().objective <
      0.95 * tetrahedra.result.history.front().objective);
    testAgainstOne(by + ", hexahedra", hexes, options);
    testAgainstOne(by + ", triangles", triangles, options);
    const Run slid =
      testAgainstOne(by + ", tetrahedra that slide", tets, options, Constraint::Sliding);
    // Points of the sides are still in them.
    double off = 0;
    Index moved = 0;
    for (std::size_t i = 0; i < tets.points.size(); ++i)
    {
      const double x = tets.points[i], side = 5;
      const bool onSide = x == 0 || x == side;
      off = std::max(off, onSide ? std::abs(slid.points[i] - x) : 0.0);
      const std::size_t other = i - i % 3 + (i + 1) % 3;
      moved += onSide && std::abs(slid.points[other] - tets.points[other]) > 0.01;
    }
    TAUTLINE_CHECK(off <= 1e-14);
    TAUTLINE_CHECK(moved > 20);
  }
}

/// Points also slide in planes that are not at right angles to an axis, though coarse grids mix the
/// coordinates.
void testSlantedPlanes()
{
  constexpr Index cells = 8;
  constexpr double slant = 0.4;
  MeshData tets = jittered(CellType::Tetrahedron, cells, 0.15);
  tets.transform([](const Vec3& p) { return Vec3{ p[0] + slant * (p[1] + p[2]), p[1], p[2] }; });
  const OptimizeOptions options =
    converging(with({ Metric::InverseMeanRatio }), Optimizer::NewtonConjugateGradient);
  const Run slid =
    testAgainstOne("tetrahedra that slide in slanted planes", tets, options, Constraint::Sliding);
  double off = 0;
  Index moved = 0;
  for (std::size_t i = 0; i < tets.points.size(); i += 3)
  {
    const double *p = &tets.points[i], *q = &slid.points[i];
    const auto across = [](const double* x) { return x[0] - slant * (x[1] + x[2]); };
    if (std::abs(across(p)) < 1e-9 || std::abs(across(p) - cells) < 1e-9)
    {
      off = std::max(off, std::abs(across(q) - across(p)));
      moved += std::abs(q[1] - p[1]) > 0.01;
    }
  }
  TAUTLINE_CHECK(off <= 1e-13);
  TAUTLINE_CHECK(moved > 20);
}

void testObjectives()
{
  const MeshData tets = jittered(CellType::Tetrahedron, 5, 0.2);
  OptimizeOptions product = with({ Metric::InverseMeanRatio, Metric::Size });
  product.scalarization.method = Scalarization::ObjectiveProduct;
  OptimizeOptions ordered = product;
  ordered.scalarization.method = Scalarization::Lexicographic;
  // Without a positive semidefinite part, so that diagonal blocks precondition.
  OptimizeOptions ratio = with({ Metric::MeanRatio });
  ratio.objectives[0].objectiveTemplate = ObjectiveTemplate::SumOfSquaredReciprocals;
  for (const Optimizer optimizer :
    { Optimizer::LimitedMemoryBFGS, Optimizer::NewtonConjugateGradient })
  {
    const std::string by = optimizer == Optimizer::LimitedMemoryBFGS ? ", L-BFGS" : ", Newton-CG";
    testAgainstOne("product" + by, tets, converging(product, optimizer));
    testAgainstOne("other metric" + by, tets, converging(ratio, optimizer));
  }
  testAgainstOne("one after the other", tets, converging(ordered, Optimizer::LimitedMemoryBFGS));
}

/// Elements that stay invalid are left out, whatever parts they are in.
void testTangled()
{
  // Points of the boundary are also moved: not all elements can become valid.
  const MeshData tangled = jittered(CellType::Tetrahedron, 6, 0.45);
  for (const Optimizer optimizer :
    { Optimizer::LimitedMemoryBFGS, Optimizer::NewtonConjugateGradient })
  {
    const Context context("tangled " + std::to_string(static_cast<int>(optimizer)));
    OptimizeOptions options = with({ Metric::InverseMeanRatio });
    options.optimizer = optimizer;
    const Run run = testCuts(tangled, options);
    TAUTLINE_CHECK(run.result.untangled && run.result.invertedAfter > 0);
    TAUTLINE_CHECK(run.result.invertedAfter < run.result.invertedBefore / 2);
  }
}

/// Meshes on which sweeps take thousands of iterations: the default goes over to Newton's method,
/// as on one process, and reaches the minimum.
void testStiff()
{
  const auto cubed = [](const Vec3& p) { return Vec3{ p[0], p[1] * p[1] * p[1], p[2] }; };
  MeshData ring = stretched(CellType::Quadrilateral, 40, cubed);
  ring.transform(
    [](const Vec3& p)
    {
      const double angle = 1.5 * Pi * p[0], radius = 0.2 + p[1];
      return Vec3{ radius * std::sin(angle), radius * std::cos(angle), 0 };
    });
  const std::pair<const char*, MeshData> cases[] = {
    { "sheared", stretched(CellType::Quadrilateral, 64, sheared) },
    { "power", stretched(CellType::Quadrilateral, 64, fourthPower) },
    { "power of triangles", stretched(CellType::Triangle, 32, fourthPower) },
    { "power of hexahedra", stretched(CellType::Hexahedron, 12, cubed) },
    { "power of tetrahedra", stretched(CellType::Tetrahedron, 8, cubed) },
    { "ring", ring },
  };
  for (const auto& [name, data] : cases)
  {
    const Run run = testAgainstOne(name, data, with({ Metric::InverseMeanRatio }));
    if (data.types[0] == blockMesh(CellType::Quadrilateral, 1, 1, 0).types[0] && name[0] != 'r')
    {
      TAUTLINE_CHECK(run.result.history.back().objective <= 1.001 * 4096);
    }
    TAUTLINE_CHECK(run.result.iterations <= 30);
  }
  // From the sheared start itself, not from its harmonic map, which is the minimum.
  OptimizeOptions newton = with({ Metric::InverseMeanRatio });
  newton.optimizer = Optimizer::NewtonConjugateGradient;
  const Run run = testAgainstOne("Newton-CG, sheared", cases[0].second, newton);
  TAUTLINE_CHECK(run.result.history.back().objective <= 1.000001 * 4096);
  TAUTLINE_CHECK(run.result.iterations <= 12);
}

/// One rank that has no memory for the matrix: all take other ways, or report it.
void testMemory()
{
  constexpr int ranks = 3;
  constexpr double tooFew = 1000; // bytes
  const auto cubed = [](const Vec3& p) { return Vec3{ p[0], p[1] * p[1] * p[1], p[2] }; };
  const MeshData data = stretched(CellType::Quadrilateral, 24, cubed);
  OptimizeOptions options = with({ Metric::InverseMeanRatio });
  options.stopping.maximumIterations = 40;
  const auto run = [&](Optimizer optimizer, bool lacks)
  {
    return moveOnRanks<Found>(data, Cut::Slabs, ranks,
      [&](DistributedMesh& mesh, Found& result)
      {
        std::unique_ptr<AllowedMemory> allowed;
        if (lacks && mesh.group().rank() == 1)
        {
          allowed = std::make_unique<AllowedMemory>(tooFew);
        }
        OptimizeOptions own = options;
        const std::vector<unsigned char> fixed = rankBoundary(mesh);
        own.fixed = fixed.data();
        own.optimizer = optimizer;
        static_cast<OptimizeResult&>(result) = optimize(localMesh(mesh), own, {}, Ranks(mesh));
      });
  };
  const Run sweeps = run(Optimizer::LocalNewton, false);
  const Run newton = run(Optimizer::Automatic, false);
  const Run without = run(Optimizer::Automatic, true);
  const double reached = newton.result.history.back().objective;
  // Points are stored in between, and patches of quadrilaterals have Hessians by differences, which
  // multiply the rounding.
  TAUTLINE_CHECK(farthest(without.points, sweeps.points) <= 1e-5);
  TAUTLINE_CHECK_EQUAL(without.result.iterations, sweeps.result.iterations);
  TAUTLINE_CHECK(without.result.reason == sweeps.result.reason);
  TAUTLINE_CHECK(farthest(newton.points, sweeps.points) > 1e-3);
  TAUTLINE_CHECK(reached < without.result.history.back().objective);
  int errors = 0;
  std::mutex mutex;
  const auto rankOf = cutBy(data, Cut::Random, ranks);
  onRanks(ranks,
    [&](RankGroup& group)
    {
      const RankPart part = partOf(data, group.rank(), rankOf);
      DistributedMesh mesh(group, { part.data.view(), nullptr, nullptr });
      const AllowedMemory allowed(group.rank() == 0 ? tooFew : HUGE_VAL);
      const std::vector<unsigned char> fixed = rankBoundary(mesh);
      OptimizeOptions own = options;
      own.fixed = fixed.data();
      own.optimizer = Optimizer::NewtonConjugateGradient;
      try
      {
        optimize(localMesh(mesh), own, {}, Ranks(mesh));
      }
      catch (const MemoryError& error)
      {
        const std::lock_guard<std::mutex> lock(mutex);
        errors +=
          std::string(error.what()).find(wording("choose-another-optimizer")) != std::string::npos;
      }
    });
  TAUTLINE_CHECK_EQUAL(errors, ranks);
}

/// More cells than a chunk has: parts then add to a point in different orders. Many iterations
/// multiply what rounding makes of that.
void testLarge()
{
  const MeshData data = stretched(CellType::Quadrilateral, 96, sheared);
  OptimizeOptions options = with({ Metric::InverseMeanRatio });
  options.stopping.maximumIterations = 60;
  for (const Optimizer optimizer :
    { Optimizer::LimitedMemoryBFGS, Optimizer::ConjugateGradientPolakRibiere })
  {
    const Context context("large " + std::to_string(static_cast<int>(optimizer)));
    options.optimizer = optimizer;
    const Run one = runOn(data, Cut::FirstOnly, 1, options);
    for (const auto& [cut, ranks] : { std::pair(Cut::Slabs, 2), std::pair(Cut::Random, 2) })
    {
      const Run run = runOn(data, cut, ranks, options);
      TAUTLINE_CHECK(farthest(run.points, one.points) <= 1e-10);
      TAUTLINE_CHECK_EQUAL(run.result.iterations, one.result.iterations);
    }
    TAUTLINE_CHECK(one.result.history.back().objective < 0.3 * one.result.history[0].objective);
  }
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestGlobalRanks)
{
  constexpr int most = 3; // the argument that is another number of ranks
  if (argc > most)
  {
    numbersOfRanks = { std::stoi(argv[most]) };
  }
  TAUTLINE_RUN(testOptimizers());
  TAUTLINE_RUN(testSlantedPlanes());
  TAUTLINE_RUN(testObjectives());
  TAUTLINE_RUN(testTangled());
  TAUTLINE_RUN_SLOW(testStiff());
  TAUTLINE_RUN(testMemory());
  TAUTLINE_RUN_SLOW(testLarge());
}
