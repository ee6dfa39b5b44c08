// SPDX-License-Identifier: BSD-3-Clause
// The directions in which the local optimizers move a vertex.
#include "Optimizing.h"
#include "Registry.h"

using namespace tautline;

namespace
{
/// Conjugate directions reach the minimum of an elongated patch in a few steps; steepest descent
/// goes to and fro and is far from it after as many.
TAUTLINE_PART(testConjugateSteps)
{
  const double stretch = 12;
  for (bool flat : { true, false })
  {
    const Context context(flat ? "triangles" : "tetrahedra");
    MeshData data =
      blockMesh(flat ? CellType::Triangle : CellType::Tetrahedron, 2, 2, flat ? 0 : 2);
    const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
    data.transform(TAUTLINE_PLACE(stretch * p[0], p[1], p[2]));
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      if (!boundary[i])
      {
        data.setPoint(i,
          data.point(i) +
            (flat ? Vec3{ 0.5 * stretch, 0.4, 0 } : Vec3{ 0.2 * stretch, 0.15, 0.1 }));
      }
    }
    const auto objective = [&](Optimizer optimizer, int steps, int sweeps)
    {
      TAUTLINE_LET(OptimizeOptions, options, optimizer = optimizer, patchIterations = steps,
        stopping.maximumIterations = sweeps, stopping.relativeChange = 0,
        stopping.gradientNorm = 0);
      return run(data, options).history.back().objective;
    };
    const double least = objective(Optimizer::LocalNewton, 20, 20);
    // Without conjugacy 0.26 of triangles and 0.0045 of tetrahedra are left.
    constexpr int steps = 10;
    const double left = objective(Optimizer::LocalConjugateGradient, steps, 1) / least - 1;
    std::cout << (flat ? "triangles" : "tetrahedra") << ": " << left << " above the minimum\n";
    TAUTLINE_CHECK(objective(Optimizer::LocalConjugateGradient, 1, 1) / least - 1 > 1e-3);
    TAUTLINE_CHECK(left < 1e-4);
  }
}
}
