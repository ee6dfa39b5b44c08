// SPDX-License-Identifier: BSD-3-Clause
// Where no point is held, neither the shape of the elements nor the objective depends on where the
// mesh is: it stays where it was, by each method; and where it is does not depend on the number of
// ranks.
#include "OptimizingRanks.h"
#include "Registry.h"

#include <cstdio>

using namespace tautline;

namespace
{
/// @return by how many elements the center of the mesh has moved
double drift(const MeshData& data, Optimizer optimizer)
{
  const std::vector<unsigned char> fixed(data.numberOfPoints(), 0);
  TAUTLINE_LET(OptimizeOptions, options, fixed = fixed.data(), optimizer = optimizer, threads = 1);
  const OptimizeResult result = run(data, options);
  TAUTLINE_CHECK_EQUAL(result.freeVertices, data.numberOfPoints());
  TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
  TAUTLINE_CHECK(result.history.back().objective < 0.99 * result.history.front().objective);
  return norm(centerOf(result.points) - centerOf(data.points));
}

void testMethods()
{
  constexpr double little = 1; // of elements
  for (const CellType type : { CellType::Triangle, CellType::Quadrilateral, CellType::Tetrahedron,
         CellType::Hexahedron, CellType::Wedge, CellType::Pyramid })
  {
    // The smallest matrix is solved at once, the others on several levels.
    const bool flat = topology(type).dimension == 2;
    const std::vector<Index> sizes =
      flat ? std::vector<Index>{ 6, 24, 48 } : std::vector<Index>{ 3, 6 };
    for (const Index n : sizes)
    {
      double most[2] = { 0, 0 };
      for (unsigned seed = 1; seed <= 3; ++seed)
      {
        const Context context(
          std::to_string(n) + ", " + topology(type).plural + ", seed " + std::to_string(seed));
        MeshData data = perturbedBlock(type, n, flat ? 0.25 : 0.12, seed);
        data.transform([](const Vec3& p) { return p + Vec3{ 10, 10, 0 }; });
        TAUTLINE_CHECK_EQUAL(invalid(data, data.points), Index(0));
        for (const bool newton : { false, true })
        {
          const double moved =
            drift(data, newton ? Optimizer::NewtonConjugateGradient : Optimizer::Automatic);
          TAUTLINE_CHECK(moved < little);
          most[newton] = std::max(most[newton], moved);
        }
      }
      std::printf("%d, %s: center moved by %.2g elements, by Newton's method %.2g\n",
        static_cast<int>(n), topology(type).plural, most[0], most[1]);
    }
  }
}

Run runFree(const MeshData& data, Cut cut, int ranks, const OptimizeOptions& given)
{
  return moveOnRanks<Found>(data, cut, ranks,
    [&](DistributedMesh& mesh, Found& result)
    {
      OptimizeOptions options = given;
      // Not null, also without points.
      const std::vector<unsigned char> fixed(std::max<Index>(1, mesh.localPoints()), 0);
      options.fixed = fixed.data();
      static_cast<OptimizeResult&>(result) = optimize(localMesh(mesh), options, {}, Ranks(mesh));
    });
}

/// How far the center has moved on ranks, and from where one process has it.
struct Drift
{
  double far = 0, fromOne = 0;
};

Drift driftOnRanks(const MeshData& data, Optimizer optimizer)
{
  OptimizeOptions options;
  options.optimizer = optimizer;
  options.threads = 1;
  const Vec3 before = centerOf(data.points);
  const std::vector<unsigned char> fixed(data.numberOfPoints(), 0);
  OptimizeOptions ofOne = options;
  ofOne.fixed = fixed.data();
  const OptimizeResult usual = optimize(Mesh(data.view()), ofOne);
  const Run one = runFree(data, Cut::FirstOnly, 1, options);
  TAUTLINE_CHECK_EQUAL(one.result.freeVertices, data.numberOfPoints());
  TAUTLINE_CHECK_EQUAL(one.result.invertedAfter, Index(0));
  TAUTLINE_CHECK(one.result.history.back().objective < 0.99 * one.result.history.front().objective);
  TAUTLINE_CHECK_RELATIVE(
    one.result.history.back().objective, usual.history.back().objective, 1e-4);
  const Vec3 center = centerOf(one.points);
  for (const int ranks : { 2, 3 })
  {
    const Context context(std::to_string(ranks) + " ranks");
    const Run run = runFree(data, Cut::Slabs, ranks, options);
    TAUTLINE_CHECK_EQUAL(run.result.iterations, one.result.iterations);
    TAUTLINE_CHECK(norm(centerOf(run.points) - center) <= 1e-10);
  }
  return { norm(center - before), norm(center - centerOf(usual.points)) };
}

/// However the mesh is cut, and as on one process.
void testRanks()
{
  constexpr double little = 1; // of elements, by sweeps over simplices
  constexpr double rounding = 1e-10;
  for (const CellType type : { CellType::Triangle, CellType::Quadrilateral, CellType::Tetrahedron,
         CellType::Hexahedron, CellType::Wedge, CellType::Pyramid })
  {
    const bool flat = topology(type).dimension == 2;
    for (const Index n : flat ? std::vector<Index>{ 6, 24 } : std::vector<Index>{ 3, 6 })
    {
      for (const bool newton : { false, true })
      {
        const Context context(std::to_string(n) + ", " + topology(type).plural +
          (newton ? ", Newton's method" : ", Automatic"));
        MeshData data = perturbedBlock(type, n, flat ? 0.25 : 0.12, 1);
        data.transform([](const Vec3& p) { return p + Vec3{ 10, 10, 0 }; });
        const Drift found =
          driftOnRanks(data, newton ? Optimizer::NewtonConjugateGradient : Optimizer::Automatic);
        // Automatic also leaves elements other than simplices to Newton's method.
        const bool sweeps = !newton && topology(type).samples == 1;
        TAUTLINE_CHECK(found.far <= (sweeps ? little : rounding));
        TAUTLINE_CHECK(found.fromOne <= (sweeps ? little : rounding));
        std::printf("%d, %s%s: center moved by %.2g elements, is %.2g from one process's\n",
          static_cast<int>(n), topology(type).plural, newton ? ", Newton's method" : "", found.far,
          found.fromOne);
      }
    }
  }
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestOptimizeFree)
{
  TAUTLINE_RUN(testMethods());
  TAUTLINE_RUN(testRanks());
}
