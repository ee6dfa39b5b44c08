// SPDX-License-Identifier: BSD-3-Clause
#include "Domains.h"

#include "tautline/Core/LoopProgress.h"

#include <algorithm>

namespace tautline
{
namespace
{
/// A grid of nx x ny rectangles from (x0, y0), each cut into two triangles.
struct Grid
{
  Index nx, ny;
  double x0, y0, dx, dy;
  bool alternate; ///< diagonals change from rectangle to rectangle
};

Index nodeAt(const Grid& grid, Index i, Index j)
{
  return j * (grid.nx + 1) + i;
}

void addTriangles(const Grid& grid, StructuredMesh& mesh)
{
  for (Index j = 0; j < grid.ny; ++j)
  {
    LoopProgress::at(static_cast<double>(j) / static_cast<double>(grid.ny));
    for (Index i = 0; i < grid.nx; ++i)
    {
      const Index a = nodeAt(grid, i, j), b = nodeAt(grid, i + 1, j);
      const Index c = nodeAt(grid, i + 1, j + 1), d = nodeAt(grid, i, j + 1);
      // Alternating diagonals avoid a preferred direction of the mesh.
      const bool other = grid.alternate && (i + j) % 2 == 1;
      const Index cut[] = { a, b, c, a, c, d };
      const Index otherCut[] = { a, b, d, b, c, d };
      mesh.triangles.insert(
        mesh.triangles.end(), other ? otherCut : cut, (other ? otherCut : cut) + 6);
    }
  }
}

/// Markers 1 bottom, 2 right, 3 top, 4 left; corners belong to bottom and top.
StructuredMesh makeGrid(const Grid& grid)
{
  StructuredMesh mesh;
  for (Index j = 0; j <= grid.ny; ++j)
  {
    LoopProgress::at(static_cast<double>(j) / static_cast<double>(grid.ny + 1));
    for (Index i = 0; i <= grid.nx; ++i)
    {
      mesh.points.push_back(grid.x0 + static_cast<double>(i) * grid.dx);
      mesh.points.push_back(grid.y0 + static_cast<double>(j) * grid.dy);
      mesh.points.push_back(0.0);
      mesh.pointMarkers.push_back(j == 0 ? 1
          : j == grid.ny                 ? 3
          : i == grid.nx                 ? 2
          : i == 0                       ? 4
                                         : 0);
    }
  }
  addTriangles(grid, mesh);
  mesh.cellReferences.assign(mesh.triangles.size() / 3, 1);
  return mesh;
}

Index wholeNumber(double value, const char* what)
{
  const double nearest = std::round(value);
  if (!(value > 0.0) || std::abs(value - nearest) > 1e-9 * value || nearest < 1.0 || nearest > 1e5)
  {
    throw Error(std::string("the square cannot be cut into whole elements: ") + what + " is " +
      std::to_string(value) +
      "; with aspect ratio r choose h so that 1/(h sqrt(r)) and sqrt(r)/h are "
      "whole numbers (h = 0.1 and r = 1 or 4, for example)");
  }
  return static_cast<Index>(nearest);
}
}

//------------------------------------------------------------------------------
StructuredMesh structuredRectangle(Index cells)
{
  checkDomainSize(static_cast<double>(cells), DomainKind::Structured);
  // A rectangle of 2 n x n squares has 4 n^2 triangles.
  const auto n = std::max<Index>(
    1, static_cast<Index>(std::llround(std::sqrt(static_cast<double>(cells) / 4.0))));
  const double h = 1.0 / static_cast<double>(n);
  return makeGrid({ 2 * n, n, 0.0, 0.0, h, h, true });
}

//------------------------------------------------------------------------------
StructuredMesh structuredSquare(double h, double aspectRatio, double layer)
{
  if (!(aspectRatio >= 1.0) || !(layer >= 0.0) || !(layer <= 10.0))
  {
    throw Error("the aspect ratio must be at least 1 and the interaction layer from 0 to 10 wide");
  }
  // The legs are h sqrt(r) and h / sqrt(r), so that the area of an element does not depend on the
  // aspect ratio r.
  const double root = std::sqrt(aspectRatio);
  const Index nx = wholeNumber(1.0 / (h * root), "1/(h sqrt(r))");
  const Index ny = wholeNumber(root / h, "sqrt(r)/h");
  const double dx = 1.0 / static_cast<double>(nx), dy = 1.0 / static_cast<double>(ny);
  // The tolerance prevents an additional row of elements if the layer is a whole number of elements
  // wide.
  const auto layersX = static_cast<Index>(std::ceil(layer / dx - 1e-9));
  const auto layersY = static_cast<Index>(std::ceil(layer / dy - 1e-9));
  const Grid grid = { nx + 2 * layersX, ny + 2 * layersY, -static_cast<double>(layersX) * dx,
    -static_cast<double>(layersY) * dy, dx, dy, false };
  checkDomainSize(
    2.0 * static_cast<double>(grid.nx) * static_cast<double>(grid.ny), DomainKind::Structured);
  StructuredMesh mesh = makeGrid(grid);
  // whole numbers, not sums of steps, on the sides of the square
  for (Index j = 0; j <= grid.ny; ++j)
  {
    for (Index i = 0; i <= grid.nx; ++i)
    {
      double* p = mesh.points.data() + 3 * nodeAt(grid, i, j);
      p[0] = static_cast<double>(i - layersX) / static_cast<double>(nx);
      p[1] = static_cast<double>(j - layersY) / static_cast<double>(ny);
    }
  }
  for (Index cell = 0; cell < static_cast<Index>(mesh.cellReferences.size()); ++cell)
  {
    const Index i = cell / 2 % grid.nx - layersX, j = cell / 2 / grid.nx - layersY;
    const bool inside = i >= 0 && i < nx && j >= 0 && j < ny;
    mesh.cellReferences[static_cast<std::size_t>(cell)] = inside ? 1 : 2;
  }
  return mesh;
}
}
