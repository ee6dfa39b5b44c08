// SPDX-License-Identifier: BSD-3-Clause
// Meshes whose harmonic map, from which Automatic starts, is a saddle of the objective: the
// gradient vanishes there by symmetry, and methods that start elsewhere get lower.
#include "../Blocks.h"
#include "Optimizing.h"
#include "Registry.h"

using namespace tautline;

namespace
{
constexpr Index cells = 24;

/// A unit square whose rows are denser below. Its squares are cut by alternating diagonals, or
/// only every second is.
MeshData checkerboard(bool withSquares)
{
  MeshData data;
  const auto id = [](Index i, Index j) { return i + (cells + 1) * j; };
  for (Index j = 0; j <= cells; ++j)
  {
    for (Index i = 0; i <= cells; ++i)
    {
      const double x = static_cast<double>(i) / cells, y = static_cast<double>(j) / cells;
      const bool boundary = i == 0 || j == 0 || i == cells || j == cells;
      data.addPoint({ x, boundary ? y : y * y, 0.0 });
    }
  }
  for (Index j = 0; j < cells; ++j)
  {
    for (Index i = 0; i < cells; ++i)
    {
      const Index p[] = { id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1) };
      const bool odd = (i + j) % 2 != 0;
      if (odd && withSquares)
      {
        data.addCell(CellType::Quadrilateral, { p[0], p[1], p[2], p[3] });
        continue;
      }
      const int shift = odd ? 0 : 1; // the diagonal from the first corner, or from the second
      data.addCell(CellType::Triangle, { p[shift], p[shift + 1], p[(shift + 2) % 4] });
      data.addCell(CellType::Triangle, { p[shift], p[(shift + 2) % 4], p[(shift + 3) % 4] });
    }
  }
  return data;
}

/// How far above the lowest of other methods Automatic ends, relatively.
double aboveOthers(const MeshData& data)
{
  const auto reached = [&data](Optimizer optimizer)
  {
    TAUTLINE_LET(OptimizeOptions, options, optimizer = optimizer, stopping.maximumIterations = 1000,
      threads = 1);
    const OptimizeResult result = optimize(Mesh(data.view()), options);
    TAUTLINE_CHECK(
      result.reason == StopReason::RelativeChange || result.reason == StopReason::GradientNorm);
    return result.history.back().objective;
  };
  const double least =
    std::min(reached(Optimizer::LocalNewton), reached(Optimizer::NewtonConjugateGradient));
  return reached(Optimizer::Automatic) / least - 1;
}
}

TAUTLINE_TEST(TestHarmonicSaddle)
{
  // There are several minima. From the saddle itself it is 0.0076, 0.026 and 0.0271.
  for (const double shear : { 3.0, -3.0 })
  {
    MeshData data = checkerboard(false);
    data.transform(TAUTLINE_PLACE(p[0] + shear * p[1], p[1], p[2]));
    TAUTLINE_CHECK(aboveOthers(data) < 2e-3);
  }
  for (const double aspect : { 30.0, 300.0 })
  {
    MeshData data = checkerboard(true);
    data.transform(TAUTLINE_PLACE(aspect * p[0], p[1], p[2]));
    TAUTLINE_CHECK(aboveOthers(data) < 5e-3);
  }
}
