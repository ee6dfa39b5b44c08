// SPDX-License-Identifier: BSD-3-Clause
// One sweep over the vertices: it returns the objective of the mesh, and the gradient of the
// objective; after it only the vertices that moved and their neighbors are visited.
#include "Optimizing.h"
#include "Registry.h"
#include "tautline/Optimization/LocalSweep.h"
#include "tautline/Patches/SimplexMesh.h"

#include <utility>

using namespace tautline;

namespace
{
constexpr int Squared = 2; // the power of the inverse mean ratio

std::vector<LocalTerm> squaredRatio()
{
  TAUTLINE_LET(LocalTerm, term, shapePower = Squared);
  return { term };
}

Scalarizer theSum(double value)
{
  return Scalarizer(ScalarizationOptions(), { 1.0 }, { value });
}

double objectiveOf(const MeshData& data, const SimplexMesh& simplices)
{
  std::vector<double> points = data.points;
  simplices.store(points.data(), 1);
  return sumOfSquares(data, points, Metric::InverseMeanRatio);
}

//------------------------------------------------------------------------------
/// Many blocks of vertices, of several colors; points of one side slide on it, or none.
void testValues(CellType type, bool slides)
{
  const Context context(std::string(topology(type).name) + (slides ? ", sliding" : ""));
  const int up = topology(type).dimension - 1;
  const Index n = up == 1 ? 40 : 12;
  const auto side = static_cast<double>(n);
  MeshData data = perturbedBlock(type, n, 0.15);
  const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
  std::vector<unsigned char> fixed(boundary.begin(), boundary.end());
  Random random(3);
  for (Index i = 0; slides && i < data.numberOfPoints(); ++i)
  {
    Vec3 p = data.point(i);
    const bool inner = p[0] > 0 && p[0] < side && (up == 1 || (p[1] > 0 && p[1] < side));
    if (inner && p[up] == side)
    {
      fixed[i] = 0;
      p[0] += random.uniform(-0.3, 0.3);
      data.setPoint(i, p);
    }
  }
  const Mesh mesh(data.view());
  SimplexMesh simplices(mesh, fixed.data(), nullptr, 1);
  const SurfaceProjection surface(mesh, simplices);
  LocalOptions options;
  for (std::int32_t v = 0; slides && v < simplices.freeVertices(); ++v)
  {
    options.surfaces.push_back(boundary[simplices.point(v)] ? &surface : nullptr);
  }
  TAUTLINE_CHECK(simplices.blocks().byColour.size() > 2);
  TAUTLINE_CHECK(simplices.blocks().colourStarts.size() > 2);
  std::vector<double> points = data.points;
  LocalSweeper sweeper(simplices, mesh, points.data(), squaredRatio(), options);
  std::vector<double> values = { objectiveOf(data, simplices) };
  const Scalarizer sum = theSum(values[0]);
  for (int i = 0; i < 4; ++i)
  {
    const double before = values[0];
    const SweepResult result = sweeper.sweep(sum, values);
    TAUTLINE_CHECK_EQUAL(result.visited, Index(simplices.freeVertices()));
    TAUTLINE_CHECK(values[0] < before);
    TAUTLINE_CHECK_RELATIVE(values[0], objectiveOf(data, simplices), 1e-11);
  }
}

//------------------------------------------------------------------------------
/// For a vertex that no other one influences, by differences.
TAUTLINE_PART(testGradient)
{
  for (CellType type : { CellType::Triangle, CellType::Tetrahedron })
  {
    const Context context(topology(type).name);
    MeshData data = perturbedBlock(type, 2, 0.3);
    data.transform([](const Vec3& p) { return 7.0 * p; });
    const Mesh mesh(data.view());
    SimplexMesh simplices(mesh, nullptr, nullptr, 1);
    TAUTLINE_CHECK_EQUAL(simplices.freeVertices(), 1);
    const Index point = simplices.point(0);
    double norm2 = 0;
    for (int c = 0; c < topology(type).dimension; ++c)
    {
      constexpr double h = 1e-5;
      const auto moved = [&](double step)
      {
        std::vector<double> points = data.points;
        points[3 * point + c] += step;
        return sumOfSquares(data, points, Metric::InverseMeanRatio);
      };
      const double slope = (moved(h) - moved(-h)) / (2 * h);
      norm2 += slope * slope;
    }
    std::vector<double> points = data.points;
    LocalSweeper sweeper(simplices, mesh, points.data(), squaredRatio(), LocalOptions());
    std::vector<double> values = { objectiveOf(data, simplices) };
    const SweepResult result = sweeper.sweep(theSum(values[0]), values);
    TAUTLINE_CHECK(norm2 > 1e-4);
    TAUTLINE_CHECK_RELATIVE(result.gradientNorm, std::sqrt(norm2), 1e-6);
  }
}

/// The relaxation is the part of Newton's step that is made; steps that short are all taken.
TAUTLINE_PART(testRelaxation)
{
  for (CellType type : { CellType::Triangle, CellType::Tetrahedron })
  {
    const Context context(topology(type).name);
    const MeshData data = perturbedBlock(type, 2, 0.05);
    const Mesh mesh(data.view());
    const auto step = [&](double relaxation)
    {
      SimplexMesh simplices(mesh, nullptr, nullptr, 1);
      const double* x = simplices.coordinates();
      const Vec3 before = { x[0], x[1], x[2] };
      TAUTLINE_LET(LocalOptions, options, relaxation = relaxation);
      std::vector<double> points = data.points;
      LocalSweeper sweeper(simplices, mesh, points.data(), squaredRatio(), options);
      std::vector<double> values = { objectiveOf(data, simplices) };
      sweeper.sweep(theSum(values[0]), values);
      return Vec3{ x[0], x[1], x[2] } - before;
    };
    const Vec3 whole = step(1);
    TAUTLINE_CHECK(norm(whole) > 1e-3);
    for (const double relaxation : { 0.3, 0.7 })
    {
      TAUTLINE_CHECK(norm(step(relaxation) - relaxation * whole) < 1e-12 * norm(whole));
    }
  }
}

//------------------------------------------------------------------------------
/// Regular except for one vertex: with culling, sweeps stay near it.
TAUTLINE_PART(testCulling)
{
  constexpr Index n = 24;
  MeshData data = blockMesh(CellType::Triangle, n, n, 0);
  // Equilateral: no vertex but the one has anything to gain.
  data.transform(TAUTLINE_PLACE(p[0] - 0.5 * p[1], std::sqrt(0.75) * p[1], 0));
  const Index middle = (n / 2) * (n + 1) + n / 2;
  data.setPoint(middle, data.point(middle) + Vec3{ 0.3, 0.1, 0 });
  const Mesh mesh(data.view());
  for (const double culling : { 0.0, 1e-3 })
  {
    const Context context("culling " + std::to_string(culling));
    SimplexMesh simplices(mesh, nullptr, nullptr, 1);
    const auto all = static_cast<Index>(simplices.freeVertices());
    TAUTLINE_LET(LocalOptions, options, culling = culling);
    std::vector<double> points = data.points;
    LocalSweeper sweeper(simplices, mesh, points.data(), squaredRatio(), options);
    std::vector<double> values = { objectiveOf(data, simplices) };
    const Scalarizer sum = theSum(values[0]);
    SweepResult result = sweeper.sweep(sum, values);
    TAUTLINE_CHECK_EQUAL(result.visited, all);
    const Index moved = result.moved;
    TAUTLINE_CHECK(moved >= 1);
    result = sweeper.sweep(sum, values);
    if (culling > 0)
    {
      constexpr Index neighbours = 6;
      TAUTLINE_CHECK(moved < all / 10);
      TAUTLINE_CHECK(result.visited >= moved + 1 && result.visited <= (neighbours + 1) * moved);
      TAUTLINE_CHECK(result.visited >= neighbours + 1);
    }
    else
    {
      TAUTLINE_CHECK_EQUAL(result.visited, all);
    }
    sweeper.wakeAll();
    TAUTLINE_CHECK_EQUAL(sweeper.sweep(sum, values).visited, all);
  }
}

/// A sweep that culling has kept to a few vertices does not show that the others have converged.
TAUTLINE_PART(testConvergenceOfAll)
{
  constexpr double tolerance = 1e-3;
  const MeshData data = waveAndQuickVertex();
  TAUTLINE_LET(OptimizeOptions, options, optimizer = Optimizer::LocalNewton, culling = QuickCulling,
    relaxation = 1, stopping.relativeChange = tolerance);
  const OptimizeResult result = run(data, options);
  TAUTLINE_CHECK(result.reason == StopReason::RelativeChange);
  const std::vector<IterationRecord>& history = result.history;
  std::cout << "gains";
  for (std::size_t i = 1; i < history.size(); ++i)
  {
    std::cout << " " << 1 - history[i].objective / history[i - 1].objective;
  }
  std::cout << ", then " << nextGain(data, result.points) << "\n";
  TAUTLINE_CHECK(wentOn(history, tolerance));
  TAUTLINE_CHECK(nextGain(data, result.points) <= tolerance);
}

//------------------------------------------------------------------------------
/// The worst element is improved as long as the mean does not rise by more than is allowed; the
/// result is the last round that keeps to it.
TAUTLINE_PART(testAllowance)
{
  MeshData data = perturbedBlock(CellType::Tetrahedron, 5, 0.25);
  data.transform(TAUTLINE_PLACE(p[0] * (1 + 0.15 * p[1]), p[1], p[2]));
  const auto with = [&data](double allowance)
  {
    TAUTLINE_LET(OptimizeOptions, options,
      stopping.relativeChange = options.stopping.gradientNorm = 1e-9, improveWorst = allowance);
    const OptimizeResult result = run(data, options);
    MeshData moved = TAUTLINE_CHANGED(data, points = result.points);
    const std::vector<double> q = valuesOf(moved, Metric::InverseMeanRatio);
    const double mean =
      std::accumulate(q.begin(), q.end(), 0.0) / static_cast<double>(data.numberOfCells());
    TAUTLINE_CHECK_RELATIVE(result.history.back().mean[0], mean, 1e-12);
    const double worst = worstMovable(data, result.points);
    std::cout << std::setprecision(9) << "allowance " << allowance << ": mean " << mean
              << ", worst " << worst << "\n";
    return std::make_pair(mean, worst);
  };
  const auto none = with(0), tight = with(1e-4), wide = with(0.5);
  TAUTLINE_CHECK(tight.first <= none.first * (1 + 1e-4));
  TAUTLINE_CHECK(wide.first > none.first * (1 + 1e-3)); // the bound is in the way of the other
  TAUTLINE_CHECK(wide.second < tight.second * (1 - 1e-3));
  TAUTLINE_CHECK(tight.second <= none.second);
}
}

TAUTLINE_TEST(TestLocalSweep)
{
  for (const bool slides : { false, true })
  {
    TAUTLINE_RUN(testValues(CellType::Triangle, slides));
    TAUTLINE_RUN(testValues(CellType::Tetrahedron, slides));
  }
}
