// SPDX-License-Identifier: BSD-3-Clause
#include "CurvedMesh.h"

#include "Blocks.h"
#include "VtkCompatibility.h"
#include "tautline/Core/Interruption.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>

namespace tautline
{
namespace
{
/// The linear type with the corners of a curved one; other types are unchanged.
int straightType(int vtkType)
{
  switch (vtkType)
  {
    case VTK_QUADRATIC_EDGE:
    case VTK_CUBIC_LINE:
    case VTK_LAGRANGE_CURVE:
    case VTK_BEZIER_CURVE:
      return VTK_LINE;
    default:
      return isHigherOrder(vtkType) ? static_cast<int>(cornerType(vtkType)) : vtkType;
  }
}

Index cornersOf(int straight)
{
  return straight == VTK_LINE ? 2 : topology(static_cast<CellType>(straight)).nodes;
}
}

//------------------------------------------------------------------------------
bool hasCurvedCells(vtkDataObject* input)
{
  std::array<bool, 256> curved; // by type
  for (std::size_t type = 0; type < curved.size(); ++type)
  {
    curved[type] = isHigherOrder(static_cast<int>(type));
  }
  bool any = false;
  forEachLeaf(input,
    [&](unsigned int, vtkDataSet* data)
    {
      auto* grid = vtkUnstructuredGrid::SafeDownCast(data);
      const vtkSmartPointer<vtkUnsignedCharArray> types = grid ? cellTypesOf(grid) : nullptr;
      const unsigned char* first = types ? types->GetPointer(0) : nullptr;
      any = any ||
        (first &&
          std::any_of(first, first + types->GetNumberOfValues(),
            [&curved](unsigned char type) { return curved[type]; }));
    });
  return any;
}

//------------------------------------------------------------------------------
CurvedMesh::CurvedMesh(vtkDataSet* input, int threads)
  : Corners(vtkSmartPointer<vtkUnstructuredGrid>::New())
  , Threads(threads)
  , Adapter(input, threads)
{
  const vtkIdType cells = input->GetNumberOfCells();
  vtkNew<vtkIdList> ids;
  vtkNew<vtkCellArray> straight;
  vtkNew<vtkUnsignedCharArray> types;
  this->Offsets.push_back(0);
  for (vtkIdType cell = 0; cell < cells; ++cell)
  {
    pollInterruption(cell);
    const int type = input->GetCellType(cell), corner = straightType(type);
    input->GetCellPoints(cell, ids);
    this->Types.push_back(static_cast<unsigned char>(type));
    this->Connectivity.insert(
      this->Connectivity.end(), ids->GetPointer(0), ids->GetPointer(0) + ids->GetNumberOfIds());
    this->Offsets.push_back(static_cast<Index>(this->Connectivity.size()));
    if (corner != type)
    {
      ids->Resize(cornersOf(corner));
    }
    if (type == VTK_LAGRANGE_WEDGE || type == VTK_BEZIER_WEDGE)
    {
      // These list the points of their triangles as seen from inside, unlike linear wedges.
      std::swap(*ids->GetPointer(1), *ids->GetPointer(2));
      std::swap(*ids->GetPointer(4), *ids->GetPointer(5));
    }
    straight->InsertNextCell(ids);
    types->InsertNextValue(static_cast<unsigned char>(corner));
  }
  this->Connectivity.reserve(1); // so that data() is never null
  this->Corners->SetPoints(vtkPointSet::SafeDownCast(input)->GetPoints());
  this->Corners->SetCells(types, straight);
  this->Corners->GetPointData()->ShallowCopy(input->GetPointData());
  this->Corners->GetCellData()->ShallowCopy(input->GetCellData());

  std::vector<signed char> validity(static_cast<std::size_t>(cells));
  this->Adapter.orient(validity.data(), false);
  this->Facts = std::make_unique<CurvedFacts>(input, this->Adapter);
  this->join({});
}

//------------------------------------------------------------------------------
CurvedMesh::~CurvedMesh() = default;

//------------------------------------------------------------------------------
void CurvedMesh::join(const std::vector<Index>& representative)
{
  MeshView view = this->Adapter.inputView();
  view.cellTypes = this->Types.data();
  view.offsets = this->Offsets.data();
  view.connectivity = this->Connectivity.data();
  this->Nodes = std::make_unique<FollowingNodes>(
    Mesh(view, this->Threads), this->facts().degrees, representative);
}

//------------------------------------------------------------------------------
void CurvedMesh::certify(
  const std::vector<double>& points, std::vector<signed char>& validity) const
{
  const Mesh moved = this->Adapter.mesh().at(points.data());
  std::vector<signed char> certified(validity.size(), NotMeasured);
  certifyCurvedCells(moved, this->facts(), certified.data(), nullptr, this->Threads);
  for (std::size_t cell = 0; cell < validity.size(); ++cell)
  {
    const bool replaced = certified[cell] != NotMeasured && validity[cell] != NotMeasured;
    validity[cell] = replaced ? certified[cell] : validity[cell];
  }
}
}
