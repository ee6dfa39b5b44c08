// SPDX-License-Identifier: BSD-3-Clause
#include "LayerMesh.h"

#include "FaceMeshAdapter.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Mesh/CellTopology.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataSet.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkStringArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tautline
{
namespace
{
/// The largest distance of points from the planes, as a fraction of the diagonal.
constexpr double PlaneTolerance = 1e-9;

bool isVolume(int type)
{
  return type == VTK_HEXAHEDRON || type == VTK_WEDGE;
}

bool isFacet(int type)
{
  return type == VTK_TRIANGLE || type == VTK_QUAD || type == VTK_POLYGON;
}

/// The numbers of the "empty" patches.
std::vector<int> emptyPatches(vtkDataSet* input)
{
  auto* types = vtkStringArray::SafeDownCast(
    input->GetFieldData()->GetAbstractArray(FaceMeshAdapter::PatchTypes));
  std::vector<int> numbers;
  for (vtkIdType i = 0; types && i < types->GetNumberOfValues(); ++i)
  {
    if (types->GetValue(i) == "empty")
    {
      numbers.push_back(static_cast<int>(i));
    }
  }
  return numbers;
}

/// The coordinate axis across an "empty" patch, along which all points of its first face have the
/// same coordinate; -1 if there is none.
int emptyAxis(vtkDataSet* input)
{
  const std::vector<int> empty = emptyPatches(input);
  vtkDataArray* patches = input->GetCellData()->GetArray(FaceMeshAdapter::PatchArray);
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; patches && !empty.empty() && cell < input->GetNumberOfCells(); ++cell)
  {
    const int patch = static_cast<int>(patches->GetComponent(cell, 0));
    if (!isFacet(input->GetCellType(cell)) ||
      std::find(empty.begin(), empty.end(), patch) == empty.end())
    {
      continue;
    }
    input->GetCellPoints(cell, ids);
    double low[3], high[3];
    input->GetPoint(ids->GetId(0), low);
    std::copy(low, low + 3, high);
    for (vtkIdType i = 1; i < ids->GetNumberOfIds(); ++i)
    {
      double p[3];
      input->GetPoint(ids->GetId(i), p);
      for (int c = 0; c < 3; ++c)
      {
        low[c] = std::min(low[c], p[c]);
        high[c] = std::max(high[c], p[c]);
      }
    }
    for (int c = 0; c < 3; ++c)
    {
      if (high[c] - low[c] <= PlaneTolerance * input->GetLength())
      {
        return c;
      }
    }
  }
  return -1;
}

/// Copies to a grid the point and cell data of a data set at these indices.
void takeArrays(vtkDataSet* from, const std::vector<vtkIdType>& points,
  const std::vector<vtkIdType>& cells, vtkUnstructuredGrid* grid)
{
  grid->GetPointData()->CopyAllOn();
  grid->GetPointData()->CopyAllocate(from->GetPointData(), static_cast<vtkIdType>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    grid->GetPointData()->CopyData(from->GetPointData(), points[i], static_cast<vtkIdType>(i));
  }
  grid->GetCellData()->CopyAllOn();
  grid->GetCellData()->CopyAllocate(from->GetCellData(), static_cast<vtkIdType>(cells.size()));
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    grid->GetCellData()->CopyData(from->GetCellData(), cells[i], static_cast<vtkIdType>(i));
  }
}

/// Adds the arrays of `made` that `given` lacks, with zeros where there is no source.
/// @param sources the tuple of `made` for each tuple of the output, or -1
void giveNewArrays(vtkDataSetAttributes* made, vtkDataSetAttributes* given,
  const std::vector<vtkIdType>& sources, vtkDataSetAttributes* output)
{
  for (int k = 0; k < made->GetNumberOfArrays(); ++k)
  {
    vtkDataArray* array = made->GetArray(k);
    if (!array || !array->GetName() || given->GetArray(array->GetName()) == array)
    {
      continue;
    }
    const auto wide = vtkSmartPointer<vtkDataArray>::Take(array->NewInstance());
    wide->SetName(array->GetName());
    wide->SetNumberOfComponents(array->GetNumberOfComponents());
    wide->SetNumberOfTuples(static_cast<vtkIdType>(sources.size()));
    wide->Fill(0);
    for (std::size_t i = 0; i < sources.size(); ++i)
    {
      if (sources[i] >= 0)
      {
        wide->SetTuple(static_cast<vtkIdType>(i), sources[i], array);
      }
    }
    output->AddArray(wide);
  }
  if (vtkDataArray* active = made->GetScalars())
  {
    output->SetActiveScalars(active->GetName());
  }
}
}

//------------------------------------------------------------------------------
std::unique_ptr<LayerMesh> LayerMesh::find(vtkDataSet* input)
{
  if (!vtkPointSet::SafeDownCast(input) || input->GetNumberOfCells() == 0)
  {
    return nullptr;
  }
  for (vtkIdType cell = 0; cell < input->GetNumberOfCells(); ++cell)
  {
    pollInterruption(cell);
    const int type = input->GetCellType(cell);
    if (!isVolume(type) && !isFacet(type))
    {
      return nullptr;
    }
  }
  const int empty = emptyAxis(input);
  std::unique_ptr<LayerMesh> found;
  for (int axis = 0; axis < 3; ++axis)
  {
    std::unique_ptr<LayerMesh> layer(new LayerMesh);
    if ((empty < 0 || axis == empty) && layer->lies(input, axis))
    {
      if (found)
      {
        return nullptr; // a row of cells
      }
      found = std::move(layer);
    }
  }
  return found;
}

//------------------------------------------------------------------------------
/// Tests whether the mesh is a layer across an axis, and finds the planar mesh.
bool LayerMesh::lies(vtkDataSet* input, int axis)
{
  this->Input = input;
  this->Axis = axis;
  double bounds[6];
  input->GetBounds(bounds);
  const double low = bounds[2 * axis], high = bounds[2 * axis + 1];
  const double tolerance = PlaneTolerance * input->GetLength();
  if (!(high - low > 2 * tolerance))
  {
    return false;
  }
  enum Side : signed char
  {
    Between,
    Low,
    High
  };
  std::vector<signed char> sides(input->GetNumberOfPoints(), Between);
  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    pollInterruption(i);
    double p[3];
    input->GetPoint(i, p);
    sides[i] = p[axis] <= low + tolerance ? Low : p[axis] >= high - tolerance ? High : Between;
    if (sides[i] == Between)
    {
      return false;
    }
  }
  std::vector<vtkIdType> mates(input->GetNumberOfPoints(), -1);
  std::vector<vtkIdType> numbers(input->GetNumberOfPoints(), -1);
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < input->GetNumberOfCells(); ++cell)
  {
    pollInterruption(cell);
    const int vtkType = input->GetCellType(cell);
    if (!isVolume(vtkType))
    {
      continue;
    }
    input->GetCellPoints(cell, ids);
    const CellTopology& t = topology(static_cast<CellType>(vtkType));
    const auto side = [&](int node) { return sides[ids->GetId(node)]; };
    // The edges across the layer define the pairs of points.
    int across = 0;
    for (int e = 0; e < t.edges; ++e)
    {
      const int first = t.edgeNodes[e][0], second = t.edgeNodes[e][1];
      if (side(first) == side(second))
      {
        continue;
      }
      ++across;
      const vtkIdType below = ids->GetId(side(first) == Low ? first : second);
      const vtkIdType above = ids->GetId(side(first) == Low ? second : first);
      if ((mates[below] >= 0 && mates[below] != above) ||
        (mates[above] >= 0 && mates[above] != below))
      {
        return false;
      }
      mates[below] = above;
      mates[above] = below;
    }
    int face = 0;
    const auto isLow = [&](int f)
    {
      return std::all_of(t.faceNodes[f].begin(), t.faceNodes[f].begin() + t.faceSizes[f],
        [&](int node) { return side(node) == Low; });
    };
    while (face < t.faces && !isLow(face))
    {
      ++face;
    }
    if (face == t.faces || across != t.faceSizes[face] || 2 * across != t.nodes)
    {
      return false;
    }
    // Faces run counter-clockwise seen from outside, from below.
    for (int k = t.faceSizes[face]; k-- > 0;)
    {
      const vtkIdType point = ids->GetId(t.faceNodes[face][k]);
      if (numbers[point] < 0)
      {
        numbers[point] = static_cast<vtkIdType>(this->Points.size());
        this->Points.push_back(point);
      }
      this->Nodes.push_back(numbers[point]);
    }
    this->Types.push_back(t.faceSizes[face] == 3 ? VTK_TRIANGLE : VTK_QUAD);
    this->Offsets.push_back(static_cast<vtkIdType>(this->Nodes.size()));
    this->Cells.push_back(cell);
  }
  for (vtkIdType point : this->Points)
  {
    this->Mates.push_back(mates[point]);
  }
  this->addLines(numbers);
  return !this->Cells.empty();
}

//------------------------------------------------------------------------------
/// Facets across the layer are edges of the plane, so that patches can be chosen.
/// @param numbers per point of the input: its number in the planar mesh, or -1
void LayerMesh::addLines(const std::vector<vtkIdType>& numbers)
{
  vtkDataSet* input = this->Input;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < input->GetNumberOfCells(); ++cell)
  {
    pollInterruption(cell);
    if (!isFacet(input->GetCellType(cell)))
    {
      continue;
    }
    input->GetCellPoints(cell, ids);
    std::vector<vtkIdType> below;
    for (vtkIdType i = 0; i < ids->GetNumberOfIds(); ++i)
    {
      if (numbers[ids->GetId(i)] >= 0)
      {
        below.push_back(numbers[ids->GetId(i)]);
      }
    }
    constexpr std::size_t ends = 2;
    if (below.size() == ends && ids->GetNumberOfIds() > 3)
    {
      this->Nodes.insert(this->Nodes.end(), below.begin(), below.end());
      this->Types.push_back(VTK_LINE);
      this->Offsets.push_back(static_cast<vtkIdType>(this->Nodes.size()));
      this->Cells.push_back(cell);
    }
  }
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkUnstructuredGrid> LayerMesh::side(vtkDataSet* other) const
{
  if (!other)
  {
    return nullptr;
  }
  if (other->GetNumberOfPoints() != this->Input->GetNumberOfPoints() ||
    other->GetNumberOfCells() != this->Input->GetNumberOfCells())
  {
    throw Error("The mesh is one layer of cells and is treated as planar; another input does not "
                "have the same points and cells.");
  }
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataType(vtkPointSet::SafeDownCast(other)->GetPoints()->GetDataType());
  points->SetNumberOfPoints(static_cast<vtkIdType>(this->Points.size()));
  for (std::size_t i = 0; i < this->Points.size(); ++i)
  {
    double p[3];
    other->GetPoint(this->Points[i], p);
    points->SetPoint(static_cast<vtkIdType>(i), p);
  }
  grid->SetPoints(points);
  grid->Allocate(static_cast<vtkIdType>(this->Cells.size()));
  for (std::size_t i = 0; i < this->Cells.size(); ++i)
  {
    grid->InsertNextCell(this->Types[i], this->Offsets[i + 1] - this->Offsets[i],
      this->Nodes.data() + this->Offsets[i]);
  }
  takeArrays(other, this->Points, this->Cells, grid);
  return grid;
}

//------------------------------------------------------------------------------
void LayerMesh::expand(vtkPointSet* planar, vtkPointSet* made, vtkPointSet* output) const
{
  vtkNew<vtkPoints> points;
  points->SetDataType(made->GetPoints()->GetDataType());
  points->SetNumberOfPoints(this->Input->GetNumberOfPoints());
  for (vtkIdType i = 0; i < this->Input->GetNumberOfPoints(); ++i)
  {
    points->SetPoint(i, this->Input->GetPoint(i));
  }
  std::vector<vtkIdType> sources(this->Input->GetNumberOfPoints(), -1);
  for (std::size_t i = 0; i < this->Points.size(); ++i)
  {
    double was[3], is[3], mate[3];
    this->Input->GetPoint(this->Points[i], was);
    this->Input->GetPoint(this->Mates[i], mate);
    made->GetPoint(static_cast<vtkIdType>(i), is);
    is[this->Axis] = was[this->Axis];
    for (int c = 0; c < 3; ++c)
    {
      mate[c] = c == this->Axis ? mate[c] : mate[c] == was[c] ? is[c] : mate[c] + (is[c] - was[c]);
    }
    points->SetPoint(this->Points[i], is);
    points->SetPoint(this->Mates[i], mate);
    sources[this->Points[i]] = sources[this->Mates[i]] = static_cast<vtkIdType>(i);
  }
  output->SetPoints(points);
  giveNewArrays(made->GetPointData(), planar->GetPointData(), sources, output->GetPointData());
  std::vector<vtkIdType> cells(this->Input->GetNumberOfCells(), -1);
  for (std::size_t i = 0; i < this->Cells.size(); ++i)
  {
    cells[this->Cells[i]] = static_cast<vtkIdType>(i);
  }
  giveNewArrays(made->GetCellData(), planar->GetCellData(), cells, output->GetCellData());
}
}
