// SPDX-License-Identifier: BSD-3-Clause
#include "GeometryInput.h"

#include "MeshAdapter.h"

#include "vtkDataSet.h"

namespace tautline
{
//------------------------------------------------------------------------------
void withGeometry(vtkDataSet* surface, const CoordinateFrame& frame, int threads,
  const std::function<void(const Mesh&)>& use)
{
  if (!surface || surface->GetNumberOfCells() == 0)
  {
    throw Error("The Geometry is empty: give a surface of triangles or quadrilaterals.");
  }
  MeshAdapter adapter(surface, threads);
  adapter.mergeCoincidentPoints(threads);
  MeshView view = adapter.mesh().view();
  std::vector<double> points(view.points, view.points + 3 * view.numberOfPoints);
  frame.enter(points);
  view.points = points.data();
  const Mesh mesh(view, threads);
  if (mesh.dimension() == Dimension::Volume || mesh.dimension() == Dimension::None)
  {
    throw Error(mesh.dimension() == Dimension::Volume
        ? "The Geometry has volume cells: run Extract Surface on it first."
        : "The Geometry has no triangles or quadrilaterals: give a surface, for example an STL "
          "file, or run Tetrahedralize on it first, which cuts polygons into triangles.");
  }
  use(mesh);
}
}
