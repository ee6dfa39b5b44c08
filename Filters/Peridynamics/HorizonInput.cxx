// SPDX-License-Identifier: BSD-3-Clause
#include "HorizonInput.h"

#include "Blocks.h"
#include "MeshAdapter.h"
#include "PointMerge.h"

#include "vtkAppendFilter.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkUnstructuredGrid.h"

#include <string>

namespace tautline
{
//------------------------------------------------------------------------------
HorizonInput::HorizonInput(
  vtkDataSet* input, vtkDataArray* region, double layerValue, bool mergePoints, int threads)
{
  MeshAdapter adapter(input, threads);
  if (mergePoints)
  {
    adapter.mergeCoincidentPoints(threads);
    this->Representative = adapter.coincident().representative;
    this->Notice = describeMerged(adapter.coincident(), adapter.given());
  }
  const std::string oriented = adapter.orient();
  this->Notice += (this->Notice.empty() || oriented.empty() ? "" : " ") + oriented;
  const class Mesh& mesh = adapter.mesh();
  const MeshView& view = mesh.view();
  const CellBlock* triangles = nullptr;
  for (const CellBlock& block : mesh.blocks())
  {
    if (block.type != CellType::Triangle && block.count > 0)
    {
      throw Error("the mesh has " + std::to_string(block.count) +
        " cells that are not triangles (" + topology(block.type).name +
        "): run Tetrahedralize first to cut them into triangles; for a volume, use a slice or its "
        "surface");
    }
    triangles = block.type == CellType::Triangle ? &block : triangles;
  }
  if (mesh.higherOrderCells() > 0)
  {
    throw Error("the mesh has " + std::to_string(mesh.higherOrderCells()) +
      " curved cells: nonlocal models require linear triangles. Run Curve Mesh with order 1 first, "
      "or Tessellate to follow the curves");
  }
  if (!triangles || triangles->count == 0)
  {
    throw Error("the mesh has no triangles. " + adapter.notice());
  }
  if (mesh.dimension() != Dimension::Planar)
  {
    throw Error("the triangles do not lie in a plane: nonlocal models require planar meshes");
  }
  const unsigned char* ghosts = adapter.ghostCells(); // copies, if all pieces are here
  if (ghosts && countForeignCells(mesh, ghosts) > 0)
  {
    throw Error(
      "the mesh has ghost cells, and a nonlocal matrix needs the whole mesh: gather it on "
      "one process first");
  }
  requireDistinctCells(mesh, ghosts);
  requireOrdinaryScale(view, "A nonlocal model");
  const Vec3 first = pointOf(view, view.connectivity[view.offsets[triangles->cell(0)]]);
  static_cast<HorizonPlane&>(*this) = HorizonPlane(mesh.space(), first);
  this->Mesh.points.resize(static_cast<std::size_t>(2 * view.numberOfPoints));
  for (Index i = 0; i < view.numberOfPoints; ++i)
  {
    const auto p = this->project(pointOf(view, i));
    this->Mesh.points[static_cast<std::size_t>(2 * i)] = p[0];
    this->Mesh.points[static_cast<std::size_t>(2 * i + 1)] = p[1];
  }
  for (Index i = 0; i < triangles->count; ++i)
  {
    const Index cell = triangles->cell(i);
    if (ghosts && ghosts[cell])
    {
      continue;
    }
    this->Cells.push_back(static_cast<vtkIdType>(cell));
    for (int k = 0; k < 3; ++k)
    {
      this->Mesh.triangles.push_back(view.connectivity[view.offsets[cell] + k]);
    }
    this->Mesh.layer.push_back(
      region && region->GetComponent(static_cast<vtkIdType>(cell), 0) == layerValue);
  }
}

//------------------------------------------------------------------------------
void HorizonInput::setGivenPoints(vtkDataArray* array)
{
  this->Mesh.givenPoints.clear();
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
  {
    this->Mesh.givenPoints.push_back(array->GetComponent(i, 0) != 0.0);
  }
  unite(this->Mesh.givenPoints, this->Representative);
}

//------------------------------------------------------------------------------
void HorizonInput::spread(vtkDataArray* ofPoints) const
{
  for (std::size_t p = 0; p < this->Representative.size(); ++p)
  {
    const auto to = static_cast<vtkIdType>(p),
               from = static_cast<vtkIdType>(this->Representative[p]);
    if (from != to)
    {
      ofPoints->SetTuple(to, from, ofPoints);
    }
  }
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkDataSet> wholeMesh(vtkDataObject* input)
{
  std::vector<vtkDataSet*> parts;
  forEachLeaf(input,
    [&parts](unsigned int, vtkDataSet* data)
    {
      if (data->GetNumberOfCells() > 0)
      {
        parts.push_back(data);
      }
    });
  if (auto* single = vtkDataSet::SafeDownCast(input))
  {
    return single;
  }
  if (parts.empty())
  {
    return vtkSmartPointer<vtkUnstructuredGrid>::New();
  }
  vtkNew<vtkAppendFilter> append;
  for (vtkDataSet* part : parts)
  {
    append->AddInputData(part);
  }
  append->Update();
  return append->GetOutput();
}

//------------------------------------------------------------------------------
vtkDataArray* chosenArray(
  vtkInformation* choice, vtkDataSet* input, const char* purpose, bool& onPoints)
{
  onPoints = false;
  const char* name = choice ? choice->Get(vtkDataObject::FIELD_NAME()) : nullptr;
  if (!name || !*name || std::string(name) == "None")
  {
    return nullptr;
  }
  vtkDataArray* array = nullptr;
  if (choice->Get(vtkDataObject::FIELD_ASSOCIATION()) == vtkDataObject::FIELD_ASSOCIATION_POINTS)
  {
    array = input->GetPointData()->GetArray(name);
    onPoints = array != nullptr;
  }
  array = array ? array : input->GetCellData()->GetArray(name);
  vtkDataSetAttributes* data[] = { input->GetPointData(), input->GetCellData() };
  for (vtkDataSetAttributes* attributes : data)
  {
    if (!array && attributes->GetAbstractArray(name) && !attributes->GetArray(name))
    {
      throw Error(std::string("the array '") + name + "' to take the " + purpose +
        " from holds text, not numbers: choose another one, or None");
    }
  }
  if (!array)
  {
    throw Error(std::string("there is no array '") + name + "' to take the " + purpose +
      " from: choose another one, or None");
  }
  return array;
}
}
