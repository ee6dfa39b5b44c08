// SPDX-License-Identifier: BSD-3-Clause
// Where no point is held, neither the shape of the elements nor the objective depends on where the
// mesh is: it stays where it was, by each method.
#include "Registry.h"
#include "Optimizing.h"

#include <cstdio>

using namespace tautline;

namespace
{
/// @return by how many elements the center of the mesh has moved
double drift(const MeshData& data, Optimizer optimizer)
{
  const std::vector<unsigned char> fixed(data.numberOfPoints(), 0);
  OptimizeOptions options;
  options.fixed = fixed.data();
  options.optimizer = optimizer;
  options.threads = 1;
  const OptimizeResult result = run(data, options);
  TAUTLINE_CHECK_EQUAL(result.freeVertices, data.numberOfPoints());
  TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
  TAUTLINE_CHECK(result.history.back().objective < 0.99 * result.history.front().objective);
  return norm(centerOf(result.points) - centerOf(data.points));
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestOptimizeFree)
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
