// SPDX-License-Identifier: BSD-3-Clause
// Hexahedra and wedges stay valid between their corners when a mesh is optimized, and become so
// when it is untangled.
#include "Optimizing.h"
#include "Registry.h"
#include "tautline/Untangling/Untangle.h"

using namespace tautline;

namespace
{
constexpr CellType types[] = { CellType::Hexahedron, CellType::Wedge };

/// Elements with valid corners that are folded inside.
std::vector<std::vector<Vec3>> foldedCells(CellType type, int count)
{
  Random random(29);
  std::vector<std::vector<Vec3>> cells;
  while (static_cast<int>(cells.size()) < count)
  {
    const std::vector<Vec3> p = perturbedCell(type, 0.6, random);
    const std::vector<double> sines = cornerSines(type, p);
    if (*std::min_element(sines.begin(), sines.end()) > 0 &&
      valueOf(type, p, Metric::MinimumJacobian) < -1e-3)
    {
      cells.push_back(p);
    }
  }
  return cells;
}

/// The cells that were valid and are not.
Index lost(const MeshData& data, const std::vector<double>& points)
{
  MeshData moved = TAUTLINE_CHANGED(data, points = points);
  const std::vector<signed char> before = validityOf(data), after = validityOf(moved);
  return sumOf<Index>(
    0, before.size(), [&](std::size_t i) { return before[i] == Valid && after[i] != Valid; });
}

//------------------------------------------------------------------------------
/// No optimizer folds an element, whatever the boundary.
TAUTLINE_PART(testKeepsValid)
{
  for (CellType type : types)
  {
    const Context context(topology(type).name);
    for (unsigned seed = 1; seed <= 12; ++seed)
    {
      const Context which("seed " + std::to_string(seed));
      const MeshData data = movedBlock(type, 3, 0.3, seed);
      for (Optimizer optimizer : { Optimizer::Automatic, Optimizer::LocalNewton,
             Optimizer::LimitedMemoryBFGS, Optimizer::NewtonConjugateGradient })
      {
        TAUTLINE_LET(
          OptimizeOptions, options, optimizer = optimizer, stopping.maximumIterations = 30);
        const OptimizeResult result = run(data, options);
        TAUTLINE_CHECK_EQUAL(result.invertedAfter, invalid(data, result.points));
        TAUTLINE_CHECK(result.invertedAfter <= result.invertedBefore);
        if (result.invertedBefore == 0)
        {
          TAUTLINE_CHECK_EQUAL(lost(data, result.points), Index(0));
        }
      }
    }
  }
}

/// An objective that pulls towards folded elements: the target of each is itself, folded.
TAUTLINE_PART(testFoldedTargets)
{
  for (CellType type : types)
  {
    const Context context(topology(type).name);
    int without = 0;
    for (const std::vector<Vec3>& folded : foldedCells(type, 10))
    {
      const MeshData wanted = singleCell(type, folded);
      const MeshData data = singleCell(type, idealCell(type));
      const Targets targets = referenceTargets(Mesh(data.view()), Mesh(wanted.view()));
      const std::vector<unsigned char> fixed(data.numberOfPoints(), 0);
      for (Optimizer optimizer : { Optimizer::LocalNewton, Optimizer::LimitedMemoryBFGS })
      {
        TAUTLINE_LET(OptimizeOptions, options, optimizer = optimizer, fixed = fixed.data(),
          objectives[0].evaluation.targets = &targets, stopping.maximumIterations = 60);
        // After each iteration, before what became worse goes back at the end.
        Index onTheWay = 0;
        options.observer = [&](const IterationState& state)
        {
          std::vector<double> points(data.points.size());
          state.points(points.data());
          onTheWay += lost(data, points);
          return true;
        };
        const OptimizeResult result = run(data, options);
        TAUTLINE_CHECK_EQUAL(onTheWay, Index(0));
        TAUTLINE_CHECK_EQUAL(lost(data, result.points), Index(0));
        TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
        without += result.history.size() < 2;
      }
    }
    TAUTLINE_CHECK_EQUAL(without, 0);
  }
}

/// Untangling unfolds elements by themselves and in a block whose boundary is fixed.
TAUTLINE_PART(testUnfolds)
{
  for (CellType type : types)
  {
    const Context context(topology(type).name);
    for (const std::vector<Vec3>& folded : foldedCells(type, 20))
    {
      const MeshData data = singleCell(type, folded);
      const std::vector<unsigned char> fixed(data.numberOfPoints(), 0);
      TAUTLINE_LET(UntangleOptions, options, fixed = fixed.data());
      const UntangleResult result = untangle(Mesh(data.view()), options);
      TAUTLINE_CHECK_EQUAL(result.invertedBefore, Index(1));
      TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
      TAUTLINE_CHECK_EQUAL(invalid(data, result.points), Index(0));
      TAUTLINE_CHECK_EQUAL(result.history.back().inverted, Index(0));
      TAUTLINE_CHECK(result.reason == StopReason::AllValid);
    }
    Index left = 0;
    for (unsigned seed = 1; seed <= 10; ++seed)
    {
      const MeshData data = perturbedBlock(type, 4, 0.7, seed);
      const UntangleResult result = untangle(Mesh(data.view()), {});
      TAUTLINE_CHECK_EQUAL(result.invertedAfter, invalid(data, result.points));
      left += result.invertedAfter;
    }
    TAUTLINE_CHECK_EQUAL(left, Index(0));
  }
}

/// Folded elements that nothing can repair end the run, and are counted.
TAUTLINE_PART(testEnds)
{
  for (CellType type : types)
  {
    const Context context(topology(type).name);
    for (const std::vector<Vec3>& folded : foldedCells(type, 5))
    {
      MeshData data = singleCell(type, folded);
      std::vector<Vec3> beside = idealCell(type);
      for (Vec3& p : beside)
      {
        p[0] += 5;
      }
      data.addCell(type, beside);
      std::vector<unsigned char> fixed(data.numberOfPoints(), 0);
      std::fill(fixed.begin(), fixed.begin() + topology(type).nodes, 1);
      TAUTLINE_LET(OptimizeOptions, options, fixed = fixed.data(), stopping.maximumSeconds = 60);
      const OptimizeResult result = run(data, options);
      TAUTLINE_CHECK_EQUAL(result.invertedBefore, Index(1));
      TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(1));
      TAUTLINE_CHECK(result.reason != StopReason::TimeLimit);
    }
  }
}
}
