// SPDX-License-Identifier: BSD-3-Clause
// Elements that became worse go back to where they were, one by one: those made worse in turn
// follows. After 20 rounds everything goes back.
#include "Optimizing.h"
#include "Registry.h"
#include "tautline/Core/Stopwatch.h"
#include "tautline/Optimization/QualityGuard.h"

using namespace tautline;

namespace
{
constexpr Index Few = 8, Many = 60; // less and more than the rounds
constexpr Index Apart = 2;          // cells of the block that goes nowhere

/// A row of cells along x, and a short one far away. @param firstApart the first point of that
MeshData twoRows(CellType type, Index cells, Index& firstApart)
{
  const Index up = topology(type).dimension == 3;
  MeshData data = blockMesh(type, cells, 1, up);
  const MeshData other = blockMesh(type, Apart, 1, up);
  firstApart = data.numberOfPoints();
  for (Index i = 0; i < other.numberOfPoints(); ++i)
  {
    data.addPoint(other.point(i) + Vec3{ 0, 100, 0 });
  }
  for (Index cell = 0; cell < other.numberOfCells(); ++cell)
  {
    std::vector<Index> nodes = other.nodes(cell);
    for (Index& node : nodes)
    {
      node += firstApart;
    }
    data.addCell(type, nodes);
  }
  return data;
}

/// All but the first points of the row go along it, and the row far away goes as a whole: only the
/// first cells of the row are distorted, and the next where those go back.
std::vector<double> shifted(const MeshData& data, Index firstApart, double shift)
{
  std::vector<double> points = data.points;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    points[3 * i] += i >= firstApart || data.point(i)[0] > 0 ? shift : 0;
  }
  return points;
}

/// @param restored what the guard returned
void check(const MeshData& data, Index firstApart, Index cells, double shift,
  const std::vector<double>& now, Index restored)
{
  const Context context(std::to_string(cells) + " cells");
  const bool all = cells == Many;
  Index moved = 0;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const double expected = !all && i >= firstApart ? shift : 0.0;
    TAUTLINE_CHECK_NEAR(now[3 * i] - data.points[3 * i], expected, 1e-12);
    moved += i >= firstApart || data.point(i)[0] > 0;
  }
  const Index apart = data.numberOfPoints() - firstApart;
  TAUTLINE_CHECK(restored >= moved - (all ? 0 : apart));
  TAUTLINE_CHECK(restored <= (all ? data.numberOfPoints() : firstApart));
}

OptimizeOptions allFree(const std::vector<unsigned char>& fixed)
{
  return TAUTLINE_CHANGED(OptimizeOptions(), fixed = fixed.data(), threads = 1);
}

/// Stretched triangles are worse than all of the input.
TAUTLINE_PART(testQuality)
{
  constexpr double shift = 3;
  for (const Index cells : { Few, Many })
  {
    Index firstApart = 0;
    const MeshData data = twoRows(CellType::Triangle, cells, firstApart);
    const std::vector<unsigned char> fixed(data.numberOfPoints(), 0);
    const OptimizeOptions options = allFree(fixed);
    const Mesh mesh(data.view());
    std::vector<double> points = data.points;
    OptimizationProblem problem(mesh, options, points, Stopwatch());
    const QualityGuard guard(mesh, options);
    TAUTLINE_CHECK(guard.active() && !guard.violated(problem));
    problem.restart(shifted(data, firstApart, shift));
    TAUTLINE_CHECK(guard.violated(problem));
    const Index restored = guard.restore(problem);
    TAUTLINE_CHECK(!guard.violated(problem));
    check(data, firstApart, cells, shift, points, restored);
  }
}

/// Hexahedra turned inside out.
TAUTLINE_PART(testValidity)
{
  constexpr double shift = -1.5;
  for (const Index cells : { Few, Many })
  {
    Index firstApart = 0;
    const MeshData data = twoRows(CellType::Hexahedron, cells, firstApart);
    const std::vector<unsigned char> fixed(data.numberOfPoints(), 0);
    const OptimizeOptions options = allFree(fixed);
    const Mesh mesh(data.view());
    std::vector<double> points = data.points;
    OptimizationProblem problem(mesh, options, points, Stopwatch());
    const QualityGuard guard(mesh, options);
    TAUTLINE_CHECK_EQUAL(guard.restore(problem), Index(0));
    problem.restart(shifted(data, firstApart, shift));
    TAUTLINE_CHECK(invalid(data, points) > 0);
    const Index restored = guard.restore(problem);
    TAUTLINE_CHECK_EQUAL(invalid(data, points), Index(0));
    check(data, firstApart, cells, shift, points, restored);
  }
}
}
