// SPDX-License-Identifier: BSD-3-Clause
#include "ShapeAdapter.h"

#include "vtkCell.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace tautline
{
namespace
{
/// Pixels are square if their sides differ by at most this fraction.
constexpr double SquareTolerance = 1e-4;
/// A mesh is planar if its thickness is at most this fraction of its extent.
constexpr double PlaneTolerance = 1e-6;

Error stray()
{
  return Error("The source mesh has points inside, holes or several parts: a polygon triangulated "
               "between its own "
               "vertices is needed. Silhouette to Mesh makes one.");
}
}

GreyImage::GreyImage(vtkImageData* image, vtkDataArray* array)
  : Image(image)
{
  int dimensions[3];
  image->GetDimensions(dimensions);
  if (dimensions[0] < 1 || dimensions[1] < 1 || dimensions[2] < 1)
  {
    throw Error("The image is empty.");
  }
  const int flat = static_cast<int>(std::min_element(dimensions, dimensions + 3) - dimensions);
  const int normal = dimensions[2] == 1 ? 2 : flat;
  if (dimensions[normal] != 1)
  {
    throw Error("The image is a volume; extract one slice of it first.");
  }
  this->AxisU = normal == 0 ? 1 : 0;
  this->AxisV = normal == 2 ? 1 : 2;
  this->Width = dimensions[this->AxisU];
  this->Height = dimensions[this->AxisV];
  const double* spacing = image->GetSpacing();
  this->Size = std::abs(spacing[this->AxisU]);
  if (std::abs(this->Size - std::abs(spacing[this->AxisV])) > SquareTolerance * this->Size)
  {
    throw Error("The pixels of the image are not square (" + std::to_string(spacing[this->AxisU]) +
      " by " + std::to_string(spacing[this->AxisV]) + "): resample it first.");
  }
  const auto firstOf = [](vtkDataSetAttributes* data)
  {
    return data->GetScalars() || data->GetNumberOfArrays() == 0 ? data->GetScalars()
                                                                : data->GetArray(0);
  };
  array = array ? array : firstOf(image->GetPointData());
  if (!array)
  {
    // Cell values are also accepted as pixels, because readers of geographic images produce them.
    array = firstOf(image->GetCellData());
    this->Shift = 0.5;
    --this->Width;
    --this->Height;
  }
  if (!array)
  {
    throw Error("The image has no array of numbers.");
  }
  const vtkIdType count = array->GetNumberOfTuples();
  if (count < 1 || count != this->Width * this->Height)
  {
    throw Error("The array of the image does not have one value per pixel.");
  }
  const int components = array->GetNumberOfComponents();
  bool useAlpha = false;
  if (components == 2 || components == 4)
  {
    double range[2];
    array->GetRange(range, components - 1);
    useAlpha = range[0] < range[1];
  }
  this->Values.resize(static_cast<std::size_t>(count));
  for (vtkIdType i = 0; i < count; ++i)
  {
    double value = array->GetComponent(i, useAlpha ? components - 1 : 0);
    if (components >= 3 && !useAlpha)
    {
      // Luminance of ITU-R BT.601, as in vtkImageLuminance.
      value = 0.30 * value + 0.59 * array->GetComponent(i, 1) + 0.11 * array->GetComponent(i, 2);
    }
    this->Values[i] = static_cast<float>(value);
  }
}

void GreyImage::toSpace(const Vec2& pixel, double x[3]) const
{
  int extent[6];
  this->Image->GetExtent(extent);
  double index[3] = { static_cast<double>(extent[0]), static_cast<double>(extent[2]),
    static_cast<double>(extent[4]) };
  index[this->AxisU] += pixel[0] + this->Shift;
  index[this->AxisV] += pixel[1] + this->Shift;
  this->Image->TransformContinuousIndexToPhysicalPoint(index, x);
}

SourceMesh takeSourceMesh(vtkDataSet* mesh)
{
  double bounds[6];
  mesh->GetBounds(bounds);
  const double extent = std::max(bounds[1] - bounds[0], bounds[3] - bounds[2]);
  if (bounds[5] - bounds[4] > PlaneTolerance * extent)
  {
    throw Error("The source mesh does not lie in a plane z = constant.");
  }
  // Each edge of exactly one triangle leads from a boundary vertex to the next.
  std::map<std::pair<vtkIdType, vtkIdType>, int> edges;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    if (mesh->GetCellType(cell) != VTK_TRIANGLE)
    {
      throw Error("Cell " + std::to_string(cell) +
        " of the source mesh is not a triangle: run Tetrahedralize first to cut all cells of a "
        "planar mesh into triangles.");
    }
    vtkIdList* ids = mesh->GetCell(cell)->GetPointIds();
    double x[3][3];
    for (int c = 0; c < 3; ++c)
    {
      mesh->GetPoint(ids->GetId(c), x[c]);
    }
    const double area =
      (x[1][0] - x[0][0]) * (x[2][1] - x[0][1]) - (x[1][1] - x[0][1]) * (x[2][0] - x[0][0]);
    for (int c = 0; c < 3; ++c)
    {
      const vtkIdType a = ids->GetId(c), b = ids->GetId((c + 1) % 3);
      ++edges[area > 0.0 ? std::make_pair(a, b) : std::make_pair(b, a)];
    }
  }
  std::map<vtkIdType, vtkIdType> next;
  for (const auto& [edge, times] : edges)
  {
    if (edges.count({ edge.second, edge.first }) == 0 && !next.insert(edge).second)
    {
      throw stray();
    }
  }
  if (next.empty())
  {
    throw Error("The source has no triangles.");
  }
  SourceMesh result;
  std::vector<Vec2> polygon;
  vtkIdType at = next.begin()->first;
  do
  {
    const double* p = mesh->GetPoint(at);
    polygon.push_back({ p[0], p[1] });
    result.pointIds.push_back(at);
    const auto found = next.find(at);
    if (found == next.end())
    {
      throw stray();
    }
    at = found->second;
  } while (at != next.begin()->first && polygon.size() <= next.size());
  if (polygon.size() != next.size() ||
    static_cast<vtkIdType>(polygon.size()) != mesh->GetNumberOfPoints())
  {
    throw stray();
  }
  result.source = makeShapeSource(polygon);
  vtkDataArray* centre = mesh->GetFieldData()->GetArray("CentreOfMass");
  vtkDataArray* farthest = mesh->GetFieldData()->GetArray("MaximumDistance");
  if (centre && farthest && centre->GetNumberOfTuples() > 0 &&
    centre->GetNumberOfComponents() > 1 && farthest->GetNumberOfTuples() > 0 &&
    farthest->GetComponent(0, 0) > 0.0)
  {
    result.source.centre = { centre->GetComponent(0, 0), centre->GetComponent(0, 1) };
    result.source.maxDistance = farthest->GetComponent(0, 0);
  }
  return result;
}

void fillGrid(vtkUnstructuredGrid* grid, const PolygonMesh& mesh, const std::vector<Vec2>& points,
  const GreyImage& image)
{
  vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  for (const Vec2& p : points)
  {
    double x[3];
    image.toSpace(p, x);
    places->InsertNextPoint(x);
  }
  vtkNew<vtkCellArray> cells;
  for (const auto& triangle : mesh.triangles)
  {
    const vtkIdType ids[3] = { triangle[0], triangle[1], triangle[2] };
    cells->InsertNextCell(3, ids);
  }
  grid->SetPoints(places);
  grid->SetCells(VTK_TRIANGLE, cells);
}

void addOrders(vtkUnstructuredGrid* grid, const PolygonMesh& mesh)
{
  const vtkIdType n = static_cast<vtkIdType>(mesh.points.size());
  vtkNew<vtkIntArray> boundary, elimination, steps;
  boundary->SetName("BoundaryOrder");
  elimination->SetName("EliminationOrder");
  steps->SetName("EliminationStep");
  boundary->SetNumberOfTuples(n);
  elimination->SetNumberOfTuples(n);
  steps->SetNumberOfTuples(static_cast<vtkIdType>(mesh.triangles.size()));
  for (vtkIdType i = 0; i < n; ++i)
  {
    boundary->SetValue(i, static_cast<int>(i));
  }
  int number = 0;
  for (const EliminationStep& step : mesh.elimination)
  {
    steps->SetValue(step.triangle, number);
    elimination->SetValue(step.vertex, number++);
  }
  // The two remaining vertices are the last.
  const EliminationStep& last = mesh.elimination.back();
  elimination->SetValue(last.parents[0], number);
  elimination->SetValue(last.parents[1], number + 1);
  grid->GetPointData()->AddArray(boundary);
  grid->GetPointData()->AddArray(elimination);
  grid->GetCellData()->AddArray(steps);
}
}
