// SPDX-License-Identifier: BSD-3-Clause
// The points of a mesh are placed on the geometry before the first iteration, except points of
// elements that this would invert.
#include "Registry.h"
#include "Surfaces.h"
#include "VtkMeshes.h"
#include "vtkMeshOptimizer.h"

using namespace tautline;

namespace
{
constexpr Index Cells = 4;
constexpr double Top = 3.8; // of the geometry; the mesh is as high as it has cells

/// A block of unit cubes with one inner point of the layer below the top at another height.
MeshData blockWith(Index i, Index j, double height)
{
  MeshData data = blockMesh(CellType::Hexahedron, Cells, Cells, Cells);
  const Index inner = i + (Cells + 1) * (j + (Cells + 1) * (Cells - 1));
  const Vec3 p = data.point(inner);
  TAUTLINE_CHECK_EQUAL(p[2], static_cast<double>(Cells - 1));
  data.setPoint(inner, { p[0], p[1], height });
  return data;
}

/// The points where the optimization starts.
std::vector<double> placed(const MeshData& data)
{
  MeshData geometry = cubeSurface(CellType::Quadrilateral, Cells);
  geometry.transform(TAUTLINE_PLACE(Cells * p[0], Cells * p[1], Top * p[2]));
  TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputData(toGrid(data)),
    SetInputDataObject(3, toGrid(geometry)), SetBoundary(vtkMeshOptimizer::ON_SURFACE),
    SetMaximumIterations(0), Update());
  auto* output = outputOf<vtkUnstructuredGrid>(filter);
  return toMesh(output).points;
}

/// @param stays whether a point of the top, given by x and y, is to be where it was
template <class Stays>
void checkTop(const MeshData& data, const std::vector<double>& points, const Stays& stays)
{
  TAUTLINE_CHECK_EQUAL(points.size(), data.points.size());
  int on = 0, held = 0;
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    const Vec3 from = data.point(p);
    if (from[2] == Cells)
    {
      const bool stay = stays(from[0], from[1]);
      TAUTLINE_CHECK_NEAR(points[3 * p + 2], stay ? static_cast<double>(Cells) : Top, 1e-12);
      (stay ? held : on) += 1;
    }
    else if (from[2] == 0)
    {
      TAUTLINE_CHECK_NEAR(points[3 * p + 2], 0.0, 1e-12);
    }
  }
  std::cout << on << " points of the top are on the geometry, " << held << " stay\n";
}

Index invalid(const MeshData& like, const std::vector<double>& points)
{
  MeshData moved = TAUTLINE_CHANGED(like, points = points);
  const std::vector<signed char> v = validityOf(moved);
  return std::count_if(v.begin(), v.end(), [](signed char s) { return s != Valid; });
}
}

TAUTLINE_TEST(TestGeometryPlacement)
{
  {
    const Context context("room for all");
    const MeshData data = blockWith(2, 2, 3.5);
    TAUTLINE_RUN(checkTop(data, placed(data), [](double, double) { return false; }));
  }
  {
    // The point under the middle of the top is higher than the geometry: the four cells above it
    // keep their points, and no others.
    const Context context("an element would be inverted");
    const MeshData data = blockWith(2, 2, 3.9);
    const std::vector<double> points = placed(data);
    TAUTLINE_RUN(checkTop(data, points,
      [](double x, double y) { return std::abs(x - 2) < 1.5 && std::abs(y - 2) < 1.5; }));
    TAUTLINE_CHECK_EQUAL(invalid(data, points), Index(0));
  }
  {
    // Cells that are inverted in the input hold no point.
    const Context context("an inverted element");
    const MeshData data = blockWith(2, 2, 4.5);
    TAUTLINE_CHECK(invalid(data, data.points) > 0);
    TAUTLINE_RUN(checkTop(data, placed(data), [](double, double) { return false; }));
  }
}
