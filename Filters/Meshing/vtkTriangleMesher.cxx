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
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStaticPointLocator.h"
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
    throw Error("the outlines are not in a plane z = constant (z is from " +
      std::to_string(bounds[4]) + " to " + std::to_string(bounds[5]) +
      "); use Transform to lay them there");
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

/// The allowed edge at a place: that of the nearest input point, growing with the distance.
std::function<double(double, double)> makeSizeField(
  vtkPointSet* input, vtkDataArray* sizes, double gradation)
{
  if (!sizes || sizes->GetNumberOfComponents() != 1 ||
    sizes->GetNumberOfTuples() != input->GetNumberOfPoints())
  {
    throw Error("choose a point array with one component for the sizes");
  }
  for (vtkIdType i = 0; i < sizes->GetNumberOfTuples(); ++i)
  {
    const double size = sizes->GetComponent(i, 0);
    if (!(size > 0.0) || !std::isfinite(size))
    {
      throw Error("sizes must be positive and finite; that of point " + std::to_string(i) + " is " +
        std::to_string(size));
    }
  }
  // The locator computes squares: it searches at a scale where they neither overflow nor vanish.
  double bounds[6];
  input->GetBounds(bounds);
  int exponent = 0;
  std::frexp(std::max({ -bounds[0], bounds[1], -bounds[2], bounds[3] }), &exponent);
  auto scaled = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  points->SetDataType(VTK_DOUBLE);
  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    const double* p = input->GetPoint(i);
    points->InsertNextPoint(std::ldexp(p[0], -exponent), std::ldexp(p[1], -exponent), 0.0);
  }
  scaled->SetPoints(points);
  auto locator = vtkSmartPointer<vtkStaticPointLocator>::New();
  locator->SetDataSet(scaled);
  locator->BuildLocator();
  return [=](double x, double y)
  {
    const double place[] = { std::ldexp(x, -exponent), std::ldexp(y, -exponent), 0.0 };
    const vtkIdType nearest = std::max<vtkIdType>(0, locator->FindClosestPoint(place));
    double p[3];
    input->GetPoint(nearest, p);
    return sizes->GetComponent(nearest, 0) + gradation * std::hypot(p[0] - x, p[1] - y);
  };
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
        " components, 3 are expected");
    }
    for (vtkIdType i = 0; i < holes->GetNumberOfTuples(); ++i)
    {
      outline.holes.insert(
        outline.holes.end(), { holes->GetComponent(i, 0), holes->GetComponent(i, 1) });
    }
  }
  if (this->UseSizeArray)
  {
    options.sizeField =
      makeSizeField(input, this->GetInputArrayToProcess(0, input), this->Gradation);
  }
  options.progress = [this](tautline::Index points)
  {
    const auto done = static_cast<double>(points);
    constexpr double pointsForHalf = 2e4; // their number is not known beforehand
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
