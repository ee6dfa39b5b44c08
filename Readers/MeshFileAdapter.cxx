// SPDX-License-Identifier: BSD-3-Clause
#include "MeshFileAdapter.h"

#include "MeshPart.h"
#include "VtkCompatibility.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace tautline
{
namespace
{
/// A VTK array with the values of a vector; tuple i is tuple order[i], if there is an order.
template <class ArrayT, class Values>
vtkSmartPointer<vtkDataArray> copyValues(
  const Values& values, int components, const std::vector<Index>& order = {})
{
  auto array = vtkSmartPointer<ArrayT>::New();
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()) / components);
  auto* to = array->GetPointer(0);
  if (order.empty())
  {
    std::copy(values.begin(), values.end(), to);
    return array;
  }
  for (const Index tuple : order)
  {
    to = std::copy_n(values.begin() + tuple * components, components, to);
  }
  return array;
}

vtkSmartPointer<vtkDataArray> toArray(const MeshArray& array, const std::vector<Index>& order = {})
{
  vtkSmartPointer<vtkDataArray> result;
  if (const auto* doubles = std::get_if<MeshArray::Doubles>(&array.values))
  {
    result = copyValues<vtkDoubleArray>(*doubles, array.components, order);
  }
  else if (const auto* integers = std::get_if<MeshArray::Integers>(&array.values))
  {
    result = copyValues<vtkTypeInt64Array>(*integers, array.components, order);
  }
  else
  {
    result = copyValues<vtkUnsignedCharArray>(
      std::get<MeshArray::Bytes>(array.values), array.components, order);
  }
  result->SetName(array.name.c_str());
  return result;
}

/// Adds an array to the points or cells; the point or cell numbers of a part become global ids.
void addArray(vtkDataSetAttributes* to, const MeshArray& array, const char* ids,
  const std::vector<Index>& order = {})
{
  const auto* numbers = std::get_if<MeshArray::Integers>(&array.values);
  if (array.name == ids && numbers && array.components == 1)
  {
    const auto globalIds = copyValues<vtkIdTypeArray>(*numbers, 1, order);
    globalIds->SetName(ids);
    to->SetGlobalIds(globalIds);
    return;
  }
  to->AddArray(toArray(array, order));
}

/// Points, point arrays and field arrays.
void setPoints(MeshFile& mesh, vtkPointSet* output)
{
  vtkNew<vtkPoints> points;
  points->SetDataType(VTK_DOUBLE);
  points->SetData(takeValues<vtkDoubleArray>(std::move(mesh.points), 3));
  output->SetPoints(points);
  for (const MeshArray& array : mesh.pointArrays)
  {
    addArray(output->GetPointData(), array, PartPointIds);
    if (array.name == "Normals" && array.components == 3)
    {
      output->GetPointData()->SetActiveNormals("Normals");
    }
  }
  for (const MeshArray& array : mesh.fieldArrays)
  {
    output->GetFieldData()->AddArray(toArray(array));
  }
  for (const MeshStrings& strings : mesh.fieldStrings)
  {
    vtkNew<vtkStringArray> array;
    array->SetName(strings.name.c_str());
    for (const std::string& value : strings.values)
    {
      array->InsertNextValue(value);
    }
    output->GetFieldData()->AddArray(array);
  }
}

MeshArray fromArray(vtkDataArray* array)
{
  const auto size = static_cast<std::size_t>(array->GetNumberOfValues());
  const int type = array->GetDataType();
  const bool bytes = type == VTK_UNSIGNED_CHAR;
  const bool doubles = type == VTK_DOUBLE || type == VTK_FLOAT;
  MeshArray result =
    MeshArray::make(array->GetName() ? array->GetName() : "Unnamed", array->GetNumberOfComponents(),
      bytes       ? 'u'
        : doubles ? 'f'
                  : 'i',
      size);
  std::visit(
    [&](auto& values)
    {
      using Value = typename std::decay_t<decltype(values)>::value_type;
      for (std::size_t i = 0; i < size; ++i)
      {
        values[i] =
          static_cast<Value>(array->GetVariantValue(static_cast<vtkIdType>(i)).ToDouble());
      }
    },
    result.values);
  return result;
}

/// Like the above for common types, without using variants.
MeshArray fromUsualArray(vtkDataArray* array)
{
  const auto take = [&](auto* typed, auto values)
  {
    values.assign(typed->GetPointer(0), typed->GetPointer(0) + typed->GetNumberOfValues());
    return MeshArray{ array->GetName() ? array->GetName() : "Unnamed",
      array->GetNumberOfComponents(), std::move(values) };
  };
  if (auto* doubles = vtkDoubleArray::FastDownCast(array))
  {
    return take(doubles, MeshArray::Doubles());
  }
  if (auto* bytes = vtkUnsignedCharArray::FastDownCast(array))
  {
    return take(bytes, MeshArray::Bytes());
  }
  if (auto* integers = vtkTypeInt64Array::FastDownCast(array))
  {
    return take(integers, MeshArray::Integers());
  }
  return fromArray(array);
}

std::vector<MeshArray> fromArrays(vtkFieldData* data)
{
  std::vector<MeshArray> arrays;
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = data->GetArray(i);
    const bool ghosts = array && array->GetName() &&
      std::string(array->GetName()) == vtkDataSetAttributes::GhostArrayName();
    if (array && !ghosts)
    {
      arrays.push_back(fromUsualArray(array));
    }
  }
  return arrays;
}

/// Adds one cell; false if no format supports its type.
bool addCell(MeshFile& mesh, int type, vtkIdType size, const vtkIdType* ids)
{
  if (type == VTK_PIXEL)
  {
    const Index quadrilateral[] = { ids[0], ids[1], ids[3], ids[2] };
    mesh.addCell(FileQuadrilateral, quadrilateral, 4);
    return true;
  }
  if (type == VTK_VOXEL)
  {
    const Index hexahedron[] = { ids[0], ids[1], ids[3], ids[2], ids[4], ids[5], ids[7], ids[6] };
    mesh.addCell(FileHexahedron, hexahedron, 8);
    return true;
  }
  const unsigned char polygons[] = { 0, 0, 0, FileTriangle, FileQuadrilateral };
  const bool small = type == VTK_POLYGON && size >= 3 && size <= 4;
  const auto code = small ? polygons[size] : static_cast<unsigned char>(type);
  const bool anySize = cellNodes(code) == 0 && code != FilePolygon;
  const bool known = cellDimension(code) >= 0 &&
    (code == FilePolygon ? size >= 3 : cellNodes(code) == size || anySize);
  if (known)
  {
    const std::vector<Index> nodes(ids, ids + size);
    mesh.addCell(code, nodes.data(), size);
  }
  return known;
}

void addCells(vtkDataSet* input, MeshFile& mesh)
{
  std::map<int, Index> unknown;
  vtkNew<vtkIdList> scratch;
  mesh.offsets.reserve(static_cast<std::size_t>(input->GetNumberOfCells() + 1));
  std::vector<char> keep;
  const auto* ghosts = input->GetCellGhostArray();
  for (vtkIdType cell = 0; cell < input->GetNumberOfCells(); ++cell)
  {
    vtkIdType size = 0;
    const vtkIdType* ids = nullptr;
    const bool ghost = ghosts && ghosts->GetValue(cell) != 0;
    if (ghosts)
    {
      keep.push_back(!ghost);
    }
    cellPoints(input, cell, size, ids, scratch);
    const int type = input->GetCellType(cell);
    if (!ghost && !addCell(mesh, type, size, ids))
    {
      ++unknown[type];
    }
  }
  if (!unknown.empty())
  {
    std::string list;
    for (const auto& [type, count] : unknown)
    {
      list += (list.empty() ? "" : ", ") + std::to_string(count) + " " + cellClassName(type);
    }
    throw Error("cells that cannot be written: " + list +
      "; run Tetrahedralize (or, on surfaces, Triangulate) first");
  }
  mesh.cellArrays = fromArrays(input->GetCellData());
  for (MeshArray& array : mesh.cellArrays)
  {
    if (ghosts)
    {
      std::visit(
        [&](auto& values)
        {
          const auto width = static_cast<std::size_t>(array.components);
          auto to = values.begin();
          for (std::size_t cell = 0; cell < keep.size(); ++cell)
          {
            to = keep[cell]
              ? std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(cell * width), width, to)
              : to;
          }
          values.erase(to, values.end());
        },
        array.values);
    }
  }
}
}

//------------------------------------------------------------------------------
void toGrid(MeshFile mesh, vtkUnstructuredGrid* grid)
{
  setPoints(mesh, grid);
  vtkNew<vtkCellArray> cells;
  cells->SetData(takeValues<vtkTypeInt64Array>(std::move(mesh.offsets), 1),
    takeValues<vtkTypeInt64Array>(std::move(mesh.connectivity), 1));
  grid->SetCells(takeValues<vtkUnsignedCharArray>(std::move(mesh.cellTypes), 1), cells);
  for (const MeshArray& array : mesh.cellArrays)
  {
    addArray(grid->GetCellData(), array, PartCellIds);
  }
}

//------------------------------------------------------------------------------
void toSurface(MeshFile mesh, vtkPolyData* surface)
{
  setPoints(mesh, surface);
  std::vector<Index> order(mesh.cellTypes.size());
  std::iota(order.begin(), order.end(), Index{ 0 });
  std::stable_sort(order.begin(), order.end(),
    [&](Index a, Index b)
    {
      return cellDimension(mesh.cellTypes[static_cast<std::size_t>(a)]) <
        cellDimension(mesh.cellTypes[static_cast<std::size_t>(b)]);
    });
  vtkNew<vtkCellArray> cells[3];
  for (const Index cell : order)
  {
    const auto at = static_cast<std::size_t>(cell);
    const Index begin = mesh.offsets[at];
    const std::vector<vtkIdType> ids(
      mesh.connectivity.begin() + begin, mesh.connectivity.begin() + mesh.offsets[at + 1]);
    cells[cellDimension(mesh.cellTypes[at])]->InsertNextCell(
      static_cast<vtkIdType>(ids.size()), ids.data());
  }
  surface->SetVerts(cells[0]);
  surface->SetLines(cells[1]);
  surface->SetPolys(cells[2]);
  for (const MeshArray& array : mesh.cellArrays)
  {
    addArray(surface->GetCellData(), array, PartCellIds, order);
  }
}

//------------------------------------------------------------------------------
MeshFile fromDataSet(vtkDataSet* input)
{
  MeshFile mesh;
  mesh.points.resize(static_cast<std::size_t>(3 * input->GetNumberOfPoints()));
  for (vtkIdType i = 0; i < input->GetNumberOfPoints(); ++i)
  {
    input->GetPoint(i, mesh.points.data() + 3 * i);
  }
  addCells(input, mesh);
  mesh.pointArrays = fromArrays(input->GetPointData());
  mesh.fieldArrays = fromArrays(input->GetFieldData());
  for (int i = 0; i < input->GetFieldData()->GetNumberOfArrays(); ++i)
  {
    auto* strings = vtkStringArray::SafeDownCast(input->GetFieldData()->GetAbstractArray(i));
    if (strings && strings->GetName())
    {
      mesh.fieldStrings.push_back({ strings->GetName(), {} });
      for (vtkIdType s = 0; s < strings->GetNumberOfValues(); ++s)
      {
        mesh.fieldStrings.back().values.push_back(strings->GetValue(s));
      }
    }
  }
  return mesh;
}
}
