// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTriangleMesher.h"

#include "MeshOutput.h"
#include "PlanarMesher.h"
#include "ProgressStep.h"

#include "vtkCell.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>

vtkStandardNewMacro(vtkTriangleMesher);

namespace
{
using tautline::Error;

/// The edges of lines and polygons, with the marker of their cell.
tautline::PlanarBoundary takeBoundary(vtkPointSet* input)
{
  tautline::PlanarBoundary boundary;
  double bounds[6];
  input->GetBounds(bounds);
  const double extent = std::max(bounds[1] - bounds[0], bounds[3] - bounds[2]);
  if (bounds[5] - bounds[4] > 1e-9 * extent)
  {
    throw Error("the outlines are not in a plane z = constant (z ranges from " +
      std::to_string(bounds[4]) + " to " + std::to_string(bounds[5]) +
      "); use Transform to move them there");
  }
  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    const double* x = input->GetPoint(i);
    boundary.points.insert(boundary.points.end(), { x[0], x[1] });
  }
  vtkDataArray* markers = input->GetCellData()->GetArray("BoundaryMarker");
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < input->GetNumberOfCells(); ++cell)
  {
    const int type = input->GetCellType(cell);
    const bool closed = type == VTK_TRIANGLE || type == VTK_QUAD || type == VTK_POLYGON;
    if (!closed && type != VTK_LINE && type != VTK_POLY_LINE && type != VTK_VERTEX &&
      type != VTK_POLY_VERTEX)
    {
      throw Error("cell " + std::to_string(cell) + " is neither a line nor a polygon");
    }
    input->GetCellPoints(cell, ids);
    const vtkIdType size = ids->GetNumberOfIds();
    const bool points = type == VTK_VERTEX || type == VTK_POLY_VERTEX;
    for (vtkIdType i = 0; !points && i < size - (closed ? 0 : 1); ++i)
    {
      boundary.segments.insert(
        boundary.segments.end(), { ids->GetId(i), ids->GetId((i + 1) % size) });
      boundary.markers.push_back(markers ? tautline::markerAt(markers, cell) : 1);
    }
  }
  return boundary;
}
}

//------------------------------------------------------------------------------
void vtkTriangleMesher::Generate(
  vtkPointSet* input, vtkUnstructuredGrid* output, vtkPolyData* boundary)
{
  tautline::PlanarBoundary outline = takeBoundary(input);
  tautline::PlanarOptions options;
  options.minimumAngle = this->MinimumAngle;
  options.size = this->Size;
  if (vtkDataArray* holes = input->GetFieldData()->GetArray("Holes"))
  {
    options.holesGiven = true;
    if (holes->GetNumberOfComponents() != 3)
    {
      throw Error("the field array Holes has " + std::to_string(holes->GetNumberOfComponents()) +
        " components; 3 are expected");
    }
    for (vtkIdType i = 0; i < holes->GetNumberOfTuples(); ++i)
    {
      outline.holes.insert(
        outline.holes.end(), { holes->GetComponent(i, 0), holes->GetComponent(i, 1) });
    }
  }
  if (this->UseSizeArray)
  {
    options.pointSizes = this->TakeSizes(input);
    options.gradation = this->Gradation;
  }
  options.progress = [this](tautline::Index points)
  {
    const auto done = static_cast<double>(points);
    constexpr double pointsForHalf = 2e4; // their number is not known in advance
    tautline::advance(this, tautline::openEnded(done, pointsForHalf));
    return this->GetAbortExecute() == 0;
  };
  const tautline::PlanarMesh mesh = tautline::meshPlane(outline, options);
  const auto points = tautline::makePoints(mesh.points, 2, input->GetBounds()[4]);
  output->SetPoints(points);
  output->SetCells(VTK_TRIANGLE, tautline::makeCells(mesh.triangles, 3));
  output->GetPointData()->AddArray(tautline::makeMarkers("BoundaryMarker", mesh.pointMarkers));
  boundary->SetPoints(points);
  boundary->SetLines(tautline::makeCells(mesh.edges, 2));
  boundary->GetCellData()->AddArray(tautline::makeMarkers("BoundaryMarker", mesh.edgeMarkers));
}

//------------------------------------------------------------------------------
void vtkTriangleMesher::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MinimumAngle: " << this->MinimumAngle << "\n";
  os << indent << "Size: " << this->Size << "\n";
  os << indent << "Gradation: " << this->Gradation << "\n";
}
