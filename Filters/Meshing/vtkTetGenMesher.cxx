// SPDX-License-Identifier: BSD-3-Clause
#include "vtkTetGenMesher.h"

#include "MeshOutput.h"
#include "ProgressStep.h"
#include "SolidMesher.h"

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

#include <map>

vtkStandardNewMacro(vtkTetGenMesher);

namespace
{
using tautline::Error;

/// All values of a field array with `components` components; empty without one.
std::vector<double> fieldValues(vtkPointSet* input, const char* name, int components)
{
  vtkDataArray* array = input->GetFieldData()->GetArray(name);
  std::vector<double> values;
  if (!array)
  {
    return values;
  }
  if (array->GetNumberOfComponents() != components)
  {
    throw Error(std::string("the field array ") + name + " has " +
      std::to_string(array->GetNumberOfComponents()) + " components, " +
      std::to_string(components) + " are expected");
  }
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    for (int c = 0; c < components; ++c)
    {
      values.push_back(array->GetComponent(i, c));
    }
  }
  return values;
}

tautline::SolidBoundary takeSurface(vtkPointSet* input)
{
  tautline::SolidBoundary boundary;
  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    const double* x = input->GetPoint(i);
    boundary.points.insert(boundary.points.end(), x, x + 3);
  }
  vtkDataArray* markers = input->GetCellData()->GetArray("BoundaryMarker");
  vtkDataArray* groups = input->GetCellData()->GetArray("Facet");
  std::map<double, std::size_t> facetOfGroup;
  vtkNew<vtkIdList> ids;
  vtkIdType others = 0;
  for (vtkIdType cell = 0; cell < input->GetNumberOfCells(); ++cell)
  {
    const int type = input->GetCellType(cell);
    if (type != VTK_TRIANGLE && type != VTK_QUAD && type != VTK_POLYGON && !groups)
    {
      ++others;
      continue;
    }
    const std::size_t next = boundary.facets.size();
    const std::size_t facet =
      groups ? facetOfGroup.insert({ groups->GetComponent(cell, 0), next }).first->second : next;
    boundary.facets.resize(std::max(next, facet + 1));
    boundary.facets[facet].marker = markers ? tautline::markerAt(markers, cell) : 1;
    input->GetCellPoints(cell, ids);
    boundary.facets[facet].polygons.emplace_back(ids->begin(), ids->end());
  }
  if (others > 0)
  {
    throw Error(std::to_string(others) +
      " cells are not triangles, quadrilaterals or polygons; run Extract Surface first");
  }
  boundary.holes = fieldValues(input, "Holes", 3);
  const std::vector<double> facetHoles = fieldValues(input, "FacetHoles", 4);
  for (std::size_t i = 0; i < facetHoles.size(); i += 4)
  {
    const auto facet =
      facetHoles[i] >= 0 ? static_cast<std::size_t>(facetHoles[i]) : boundary.facets.size();
    if (facet >= boundary.facets.size())
    {
      throw Error("FacetHoles names a facet that does not exist");
    }
    boundary.facets[facet].holes.push_back(
      { facetHoles[i + 1], facetHoles[i + 2], facetHoles[i + 3] });
  }
  return boundary;
}
}

//------------------------------------------------------------------------------
void vtkTetGenMesher::Generate(
  vtkPointSet* input, vtkUnstructuredGrid* output, vtkPolyData* boundary)
{
  this->SetProgressText("TetGen Mesher");
  this->UpdateProgress(0.05);
  tautline::SolidOptions options;
  options.radiusEdgeRatio = this->RadiusEdgeRatio;
  options.minimumDihedralAngle = this->MinimumDihedralAngle;
  options.volume = this->Volume;
  options.preserveSurface = this->PreserveSurface;
  options.timeLimit = this->TimeLimit;
  options.regions = fieldValues(input, "Regions", 5);
  options.progress = [this, calls = 0.0]() mutable
  {
    constexpr double callsForHalf = 10.0, share = 0.9;
    calls += 1.0;
    tautline::advance(this, 0.05 + share * tautline::openEnded(calls, callsForHalf));
    return this->GetAbortExecute() == 0;
  };
  if (this->UseSizeArray)
  {
    options.pointSizes = this->TakeSizes(input);
  }
  const tautline::SolidMesh mesh = tautline::meshSolid(takeSurface(input), options);
  this->UpdateProgress(0.95);
  const auto points = tautline::makePoints(mesh.points, 3);
  output->SetPoints(points);
  output->SetCells(VTK_TETRA, tautline::makeCells(mesh.tetrahedra, 4));
  output->GetPointData()->AddArray(tautline::makeMarkers("BoundaryMarker", mesh.pointMarkers));
  if (!options.regions.empty())
  {
    output->GetCellData()->AddArray(tautline::makeMarkers("Reference", mesh.references));
  }
  boundary->SetPoints(points);
  boundary->SetPolys(tautline::makeCells(mesh.faces, 3));
  boundary->GetCellData()->AddArray(tautline::makeMarkers("BoundaryMarker", mesh.faceMarkers));
}

//------------------------------------------------------------------------------
void vtkTetGenMesher::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "RadiusEdgeRatio: " << this->RadiusEdgeRatio << "\n";
  os << indent << "MinimumDihedralAngle: " << this->MinimumDihedralAngle << "\n";
  os << indent << "Volume: " << this->Volume << "\n";
  os << indent << "PreserveSurface: " << this->PreserveSurface << "\n";
}
