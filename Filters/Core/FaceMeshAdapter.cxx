// SPDX-License-Identifier: BSD-3-Clause
#include "FaceMeshAdapter.h"

#include "tautline/Core/Interruption.h"
#include "tautline/FiniteVolume/ListFaces.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkStringArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>

namespace tautline
{
namespace
{
bool isFacet(unsigned char type)
{
  return type == VTK_TRIANGLE || type == VTK_QUAD || type == VTK_POLYGON;
}

void appendFacet(ListedFacets& facets, const Index* nodes, Index size, int patch)
{
  facets.nodes.insert(facets.nodes.end(), nodes, nodes + size);
  facets.offsets.push_back(static_cast<Index>(facets.nodes.size()));
  facets.patch.push_back(patch);
}

/// The faces of a polyhedron; false if the grid has none.
void listPolyhedron(ListedFaces& list, vtkUnstructuredGrid* grid, vtkIdType cell, vtkIdList* stream)
{
  grid->GetFaceStream(cell, stream);
  const vtkIdType faces = stream->GetNumberOfIds() > 0 ? stream->GetId(0) : 0;
  vtkIdType at = 1;
  for (vtkIdType face = 0; face < faces; ++face)
  {
    const vtkIdType size = stream->GetId(at++);
    for (vtkIdType i = 0; i < size; ++i)
    {
      list.nodes.push_back(stream->GetId(at++));
    }
    list.faceOffsets.push_back(static_cast<Index>(list.nodes.size()));
  }
  list.cellOffsets.push_back(static_cast<Index>(list.faceOffsets.size()) - 1);
}

std::string textAt(vtkFieldData* fields, const char* name, int i, const std::string& otherwise)
{
  auto* texts = vtkStringArray::SafeDownCast(fields->GetAbstractArray(name));
  return texts && i < texts->GetNumberOfValues() ? std::string(texts->GetValue(i)) : otherwise;
}
}

//------------------------------------------------------------------------------
FaceMeshAdapter::FaceMeshAdapter(vtkDataSet* input, const MeshAdapter& adapter, int threads)
  : View(adapter.inputView())
{
  const Mesh& mesh = adapter.mesh();
  std::vector<FacePatch> patches;
  if (mesh.dimension() == Dimension::Volume)
  {
    this->listVolumes(input, adapter, threads);
    patches = this->listPatches(input);
    this->listFacets(input, static_cast<int>(patches.size()));
  }
  else if (mesh.dimension() == Dimension::Planar)
  {
    this->listPolygons(mesh);
    patches.resize(2);
    for (std::size_t i = 0; i < patches.size(); ++i)
    {
      patches[i].name = i == 0 ? "below" : "above";
      patches[i].type = "empty";
    }
  }
  else if (mesh.view().numberOfCells > 0)
  {
    throw Error("Metrics of finite volumes are defined for meshes of volumes and for plane meshes, "
                "not for surfaces in space. Choose metrics of elements.");
  }
  const Index points = this->extruded() ? 2 * this->View.numberOfPoints : this->View.numberOfPoints;
  const bool known = !patches.empty();
  this->Faces = findFaces(points, this->List, this->Facets, std::move(patches), threads);
  const int axis = known ? -1 : markLayer(this->Faces, this->points());
  if (axis >= 0)
  {
    this->Notice += std::string(this->Notice.empty() ? "" : " ") +
      "The mesh is one layer of cells and is measured as planar, at right angles to " +
      "xyz"[axis] + ".";
  }
}

//------------------------------------------------------------------------------
void FaceMeshAdapter::listVolumes(vtkDataSet* input, const MeshAdapter& adapter, int threads)
{
  const MeshView& view = adapter.mesh().view();
  auto* grid = vtkUnstructuredGrid::SafeDownCast(input);
  vtkNew<vtkIdList> stream;
  bool polyhedra = false;
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    pollInterruption(cell);
    const CellType type = cornerType(view.cellTypes[cell]);
    const bool polyhedron = view.cellTypes[cell] == VTK_POLYHEDRON && grid;
    if (polyhedron)
    {
      listPolyhedron(this->List, grid, cell, stream);
    }
    else if (type != CellType::Unsupported && topology(type).dimension == 3)
    {
      listLinearCell(this->List, type, view.connectivity + view.offsets[cell]);
    }
    else
    {
      continue;
    }
    polyhedra = polyhedra || polyhedron;
    this->Cells.push_back(cell);
  }
  if (adapter.mesh().mirrored())
  {
    reverseFaces(this->List);
  }
  // Lists of a file of OpenFOAM are as they are: faces that are turned are to be found.
  if (polyhedra && !input->GetFieldData()->GetAbstractArray(FoamCase))
  {
    const Index open = turnFaces(this->List, 0, this->View.points, threads);
    if (open > 0)
    {
      this->Notice = std::to_string(open) +
        (open == 1 ? " cell is open: it has" : " cells are open: they have") +
        " an edge that is not one of two of the faces.";
    }
  }
}

//------------------------------------------------------------------------------
/// A plane mesh as one layer, in the frame of its plane, as high as a cell is wide.
void FaceMeshAdapter::listPolygons(const Mesh& mesh)
{
  const MeshView& view = mesh.view();
  std::vector<std::vector<Index>> cells;
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    pollInterruption(cell);
    const CellType type = cornerType(view.cellTypes[cell]);
    const bool polygon = view.cellTypes[cell] == VTK_POLYGON;
    if (!polygon && type == CellType::Unsupported)
    {
      continue;
    }
    const Index* first = view.connectivity + view.offsets[cell];
    const Index size = polygon ? view.offsets[cell + 1] - view.offsets[cell] : topology(type).nodes;
    cells.emplace_back(first, first + size);
    if (mesh.mirrored())
    {
      std::reverse(cells.back().begin() + 1, cells.back().end());
    }
    this->Cells.push_back(cell);
  }
  const double height =
    diagonalOf(view) / std::sqrt(std::max(1.0, static_cast<double>(cells.size())));
  this->Points.resize(6 * view.numberOfPoints);
  for (Index i = 0; i < view.numberOfPoints; ++i)
  {
    const Vec3 p = pointOf(this->View, i);
    const double across[] = { dot(mesh.frame()[0], p), dot(mesh.frame()[1], p) };
    for (Index layer = 0; layer < 2; ++layer)
    {
      double* at = this->Points.data() + 3 * (i + layer * view.numberOfPoints);
      at[0] = across[0];
      at[1] = across[1];
      at[2] = static_cast<double>(layer) * height;
    }
  }
  if (mesh.blocks().empty())
  {
    turnPolygons(cells, this->Points.data()); // of which no orientation was found
  }
  this->List = extrude(view.numberOfPoints, cells, this->Facets);
}

//------------------------------------------------------------------------------
std::vector<FacePatch> FaceMeshAdapter::listPatches(vtkDataSet* input)
{
  vtkFieldData* fields = input->GetFieldData();
  auto* names = vtkStringArray::SafeDownCast(fields->GetAbstractArray(PatchNames));
  std::vector<FacePatch> patches(names ? names->GetNumberOfValues() : 0);
  vtkDataArray* partners = fields->GetArray(NeighborPatches);
  for (int i = 0; i < static_cast<int>(patches.size()); ++i)
  {
    patches[i].name = names->GetValue(i);
    patches[i].type = textAt(fields, PatchTypes, i, patches[i].type);
    patches[i].partner = partners && i < partners->GetNumberOfTuples() && patches[i].isCyclic()
      ? static_cast<int>(partners->GetComponent(i, 0))
      : -1;
  }
  vtkDataArray* order = fields->GetArray(FacesOutOfOrder);
  this->Facts.facesOutOfOrder =
    order && order->GetNumberOfTuples() > 0 ? static_cast<Index>(order->GetComponent(0, 0)) : 0;
  return patches;
}

//------------------------------------------------------------------------------
void FaceMeshAdapter::listFacets(vtkDataSet* input, int patches)
{
  vtkDataArray* numbers = input->GetCellData()->GetArray(PatchArray);
  for (Index cell = 0; cell < this->View.numberOfCells; ++cell)
  {
    pollInterruption(cell);
    if (!isFacet(this->View.cellTypes[cell]))
    {
      continue;
    }
    const int number = numbers ? static_cast<int>(numbers->GetComponent(cell, 0)) : -1;
    const Index first = this->View.offsets[cell];
    appendFacet(this->Facets, this->View.connectivity + first, this->View.offsets[cell + 1] - first,
      number < patches ? number : -1);
  }
}

//------------------------------------------------------------------------------
MeshSpace spaceWithPolygons(const Mesh& mesh)
{
  const MeshView& view = mesh.view();
  std::vector<Index> offsets = { 0 }, connectivity;
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    pollInterruption(cell);
    const Index first = view.offsets[cell];
    for (Index i = first + 1; isFacet(view.cellTypes[cell]) && i + 1 < view.offsets[cell + 1]; ++i)
    {
      for (Index at : { first, i, i + 1 })
      {
        connectivity.push_back(view.connectivity[at]);
      }
      offsets.push_back(static_cast<Index>(connectivity.size()));
    }
  }
  MeshView triangles = view;
  triangles.numberOfCells = static_cast<Index>(offsets.size()) - 1;
  const std::vector<unsigned char> types(triangles.numberOfCells, VTK_TRIANGLE);
  triangles.cellTypes = types.data();
  triangles.offsets = offsets.data();
  triangles.connectivity = connectivity.data();
  return triangles.numberOfCells > 0 ? Mesh(triangles).space() : mesh.space();
}
}
