// SPDX-License-Identifier: BSD-3-Clause
#include "GeometrySurface.h"

#include "vtkDataSet.h"

namespace tautline
{
//------------------------------------------------------------------------------
GeometrySurface::GeometrySurface(
  vtkDataSet* geometry, const CoordinateFrame& frame, bool outline, int threads)
{
  if (!geometry || geometry->GetNumberOfCells() == 0)
  {
    throw Error("The Geometry is empty: give a surface of triangles or quadrilaterals.");
  }
  this->Adapter = std::make_unique<MeshAdapter>(geometry, threads);
  this->Adapter->mergeCoincidentPoints(threads);
  MeshView view = this->Adapter->mesh().view();
  this->Points.assign(view.points, view.points + 3 * view.numberOfPoints);
  frame.enter(this->Points);
  view.points = this->Points.data();
  this->Surface = std::make_unique<Mesh>(view, threads);
  const Dimension dimension = this->Surface->dimension();
  if (outline && dimension == Dimension::Surface)
  {
    throw Error("The Geometry of a planar mesh is its outline: give lines, or a mesh in the same "
                "plane.");
  }
  if (dimension == Dimension::Volume || (dimension == Dimension::None && !outline))
  {
    throw Error(dimension == Dimension::Volume
        ? "The Geometry has volume cells: run Extract Surface on it first."
        : "The Geometry has no triangles or quadrilaterals: give a surface, for example an STL "
          "file, or run Tetrahedralize on it first to cut polygons into triangles.");
  }
}
}
