// SPDX-License-Identifier: BSD-3-Clause
#include "FoamFileAdapter.h"

#include "ArrayIndex.h"
#include "MeshFileAdapter.h"
#include "MeshPart.h"
#include "VtkCompatibility.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkStringArray.h"
#include "vtkTypeInt64Array.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>

namespace tautline
{
namespace
{
/// Appends the faces of the patches to the cells.
void appendPatchFaces(const FoamMesh& mesh, FoamCells& cells)
{
  const Index first = mesh.numberOfInternalFaces();
  const auto begin = mesh.faceOffsets[at(first)];
  const Index before = cells.offsets.back() - begin;
  cells.connectivity.insert(
    cells.connectivity.end(), mesh.facePoints.begin() + begin, mesh.facePoints.end());
  for (Index face = first; face < mesh.numberOfFaces(); ++face)
  {
    const Index points = mesh.faceOffsets[at(face) + 1] - mesh.faceOffsets[at(face)];
    cells.types.push_back(points == 2 ? FileLine
        : points == 3                 ? FileTriangle
        : points == 4                 ? FileQuadrilateral
                                      : FilePolygon);
    cells.offsets.push_back(before + mesh.faceOffsets[at(face) + 1]);
  }
  if (!cells.faceStarts.empty())
  {
    cells.faceStarts.resize(cells.types.size(), -1);
  }
}

template <class ArrayT>
vtkSmartPointer<ArrayT> named(const char* name, vtkIdType size)
{
  auto array = vtkSmartPointer<ArrayT>::New();
  array->SetName(name);
  array->SetNumberOfValues(size);
  return array;
}

vtkSmartPointer<vtkIdTypeArray> idArray(const std::string& name, const std::vector<Index>& values)
{
  auto array = named<vtkIdTypeArray>(name.c_str(), static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  return array;
}

template <class Values, class Get>
vtkSmartPointer<vtkStringArray> stringArray(const char* name, const Values& values, const Get& get)
{
  auto array = named<vtkStringArray>(name, 0);
  for (const auto& value : values)
  {
    array->InsertNextValue(get(value));
  }
  return array;
}

/// Names, types and pairs of the patches.
void addPatchFacts(const std::vector<FoamPatch>& patches, vtkFieldData* fields)
{
  const auto count = static_cast<vtkIdType>(patches.size());
  fields->AddArray(
    stringArray("PatchNames", patches, [](const FoamPatch& patch) { return patch.name; }));
  fields->AddArray(
    stringArray("PatchTypes", patches, [](const FoamPatch& patch) { return patch.type; }));
  const auto neighbors = named<vtkIntArray>("NeighbourPatch", count);
  const auto processors = vtkSmartPointer<vtkIntArray>::New();
  processors->SetName("ProcessorNumbers");
  processors->SetNumberOfComponents(2);
  processors->SetNumberOfTuples(count);
  bool ofProcessors = false;
  for (vtkIdType i = 0; i < count; ++i)
  {
    const FoamPatch& patch = patches[at(i)];
    const auto other = std::find_if(patches.begin(), patches.end(),
      [&patch](const FoamPatch& each) { return each.name == patch.neighbor; });
    neighbors->SetValue(i, other == patches.end() ? -1 : static_cast<int>(other - patches.begin()));
    processors->SetTypedComponent(i, 0, patch.processor);
    processors->SetTypedComponent(i, 1, patch.neighborProcessor);
    ofProcessors |= patch.ofProcessor();
  }
  fields->AddArray(neighbors);
  if (ofProcessors)
  {
    fields->AddArray(processors);
  }
}

void addZoneFacts(const FoamMesh& mesh, vtkFieldData* fields)
{
  const auto name = [](const FoamZone& zone) { return zone.name; };
  if (!mesh.cellZones.empty())
  {
    fields->AddArray(stringArray("CellZoneNames", mesh.cellZones, name));
  }
  if (!mesh.faceZones.empty())
  {
    fields->AddArray(stringArray("FaceZoneNames", mesh.faceZones, name));
  }
  for (const FoamZone& zone : mesh.faceZones)
  {
    fields->AddArray(idArray("FaceZone " + zone.name, zone.members));
  }
}

void addCellArrays(const FoamMesh& mesh, vtkUnstructuredGrid* grid)
{
  const vtkIdType cells = grid->GetNumberOfCells();
  const auto patches = named<vtkIntArray>("Patch", cells);
  const auto faces = named<vtkIdTypeArray>("Face", cells);
  patches->FillValue(-1);
  faces->FillValue(-1);
  // for face f of a patch, if there are cells for them
  const vtkIdType first = mesh.cells - mesh.numberOfInternalFaces();
  for (std::size_t i = 0; cells > mesh.cells && i < mesh.patches.size(); ++i)
  {
    const FoamPatch& patch = mesh.patches[i];
    for (Index face = patch.start; face < patch.start + patch.size; ++face)
    {
      patches->SetValue(first + face, static_cast<int>(i));
      faces->SetValue(first + face, face);
    }
  }
  grid->GetCellData()->AddArray(patches);
  grid->GetCellData()->AddArray(faces);
  if (!mesh.cellZones.empty())
  {
    const auto zones = named<vtkIntArray>("CellZone", cells);
    zones->FillValue(-1);
    for (std::size_t i = mesh.cellZones.size(); i-- > 0;) // the first of several takes precedence
    {
      for (const Index cell : mesh.cellZones[i].members)
      {
        zones->SetValue(cell, static_cast<int>(i));
      }
    }
    grid->GetCellData()->AddArray(zones);
  }
}

/// Global ids: cells, then faces; the faces on the second side of a seam get different ids.
void addGlobalIds(const FoamPiece& piece, vtkUnstructuredGrid* grid)
{
  const FoamMesh& mesh = piece.mesh;
  grid->GetPointData()->SetGlobalIds(idArray(PartPointIds, piece.pointIds));
  const vtkIdType count = grid->GetNumberOfCells();
  std::vector<Index> ids(piece.cellIds);
  if (count > mesh.cells)
  {
    ids.reserve(at(count));
    for (const FoamPatch& patch : mesh.patches)
    {
      const bool second = patch.betweenProcessors() && patch.processor > patch.neighborProcessor;
      for (Index face = patch.start; face < patch.start + patch.size; ++face)
      {
        ids.push_back(piece.allCells + piece.faceIds[at(face)] + (second ? piece.allFaces : 0));
      }
    }
  }
  grid->GetCellData()->SetGlobalIds(idArray(PartCellIds, ids));
}
}

//------------------------------------------------------------------------------
std::string patchList(const FoamMesh& mesh)
{
  std::string list;
  for (std::size_t i = 0; i < mesh.patches.size(); ++i)
  {
    const FoamPatch& patch = mesh.patches[i];
    list += (i > 0 ? "\n" : "") + std::to_string(i) + " " + patch.name + " (" + patch.type + ", " +
      std::to_string(patch.size) + " faces)";
  }
  return list;
}

//------------------------------------------------------------------------------
void toGrid(FoamPiece piece, bool patchFaces, vtkUnstructuredGrid* grid)
{
  FoamMesh& mesh = piece.mesh;
  FoamCells& cells = piece.cells;
  const auto outOfOrder = named<vtkIdTypeArray>("FacesOutOfOrder", 1);
  outOfOrder->SetValue(0, facesOutOfOrder(mesh, cells.cellFaces));
  if (patchFaces)
  {
    appendPatchFaces(mesh, cells);
  }
  vtkNew<vtkPoints> points;
  points->SetDataType(VTK_DOUBLE);
  points->SetData(takeValues<vtkDoubleArray>(std::move(mesh.points), 3));
  grid->SetPoints(points);
  vtkNew<vtkCellArray> list;
  list->SetData(takeValues<vtkTypeInt64Array>(std::move(cells.offsets), 1),
    takeValues<vtkTypeInt64Array>(std::move(cells.connectivity), 1));
  const auto types = takeValues<vtkUnsignedCharArray>(std::move(cells.types), 1);
  if (cells.faceStarts.empty())
  {
    grid->SetCells(types, list);
  }
  else
  {
    setPolyhedralCells(grid, types, list,
      takeValues<vtkIdTypeArray>(std::move(cells.faceStarts), 1),
      takeValues<vtkIdTypeArray>(std::move(cells.faceStreams), 1));
  }
  addCellArrays(mesh, grid);
  if (!piece.pointIds.empty() || !piece.cellIds.empty())
  {
    addGlobalIds(piece, grid);
  }
  vtkFieldData* fields = grid->GetFieldData();
  addPatchFacts(mesh.patches, fields);
  addZoneFacts(mesh, fields);
  fields->AddArray(outOfOrder);
  if (!piece.folders.empty())
  {
    fields->AddArray(
      stringArray(FoamCaseArray, piece.folders, [](const std::string& folder) { return folder; }));
  }
}
}
