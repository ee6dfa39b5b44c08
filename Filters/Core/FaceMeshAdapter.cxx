// SPDX-License-Identifier: BSD-3-Clause
#include "FaceMeshAdapter.h"

#include "tautline/Core/Interruption.h"
#include "tautline/FiniteVolume/ListFaces.h"
#include "tautline/Mesh/RankPieces.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
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

/// The faces of a polyhedron.
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
FaceMeshAdapter::FaceMeshAdapter(vtkDataSet* input, MeshAdapter& adapter, int threads)
{
  SingleRank alone;
  find(alone, { { input, &adapter } }, { this }, threads);
}

//------------------------------------------------------------------------------
std::vector<std::unique_ptr<FaceMeshAdapter>> FaceMeshAdapter::ofPieces(
  RankGroup& group, const std::vector<FaceInput>& pieces, int threads)
{
  std::vector<std::unique_ptr<FaceMeshAdapter>> made;
  std::vector<FaceMeshAdapter*> adapters;
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    made.push_back(std::unique_ptr<FaceMeshAdapter>(new FaceMeshAdapter));
    adapters.push_back(made.back().get());
  }
  find(group, pieces, adapters, threads);
  std::vector<std::vector<Index>> ids;
  bool lacking = false;
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    FaceMesh& mesh = adapters[i]->Faces;
    if (const unsigned char* ghosts = pieces[i].adapter->ghostCells())
    {
      for (const Index cell : adapters[i]->Cells)
      {
        mesh.foreignCells.push_back(ghosts[cell] != 0);
      }
    }
    ids.push_back(idsOf(pieces[i].data->GetPointData()->GetGlobalIds()));
    lacking = lacking || ids.back().empty() || adapters[i]->extruded();
  }
  lacking = group.any(lacking);
  std::vector<FacePiece> faces;
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    // A piece without facets needs no facet ids.
    const std::vector<Index>& facets = adapters[i]->FacetIds;
    const bool bare = adapters[i]->Faces.facet.end() ==
      std::find_if(adapters[i]->Faces.facet.begin(), adapters[i]->Faces.facet.end(),
        [](Index facet) { return facet >= 0; });
    static const Index none = 0;
    faces.push_back({ &adapters[i]->Faces, adapters[i]->points(), lacking ? nullptr : ids[i].data(),
      !facets.empty() ? facets.data()
        : bare        ? &none
                      : nullptr });
  }
  const std::vector<std::vector<double>> added = joinPieces(group, faces);
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    std::vector<double>& points = adapters[i]->Points;
    if (!added[i].empty() && points.empty())
    {
      const double* own = adapters[i]->View.points;
      points.assign(own, own + 3 * adapters[i]->View.numberOfPoints);
    }
    points.insert(points.end(), added[i].begin(), added[i].end());
  }
  return made;
}

//------------------------------------------------------------------------------
void FaceMeshAdapter::find(RankGroup& group, const std::vector<FaceInput>& pieces,
  const std::vector<FaceMeshAdapter*>& adapters, int threads)
{
  // A planar mesh becomes a layer as thick as a cell is wide.
  FaceExtent extent;
  Index cells = 0;
  for (const FaceInput& piece : pieces)
  {
    const MeshView& view = piece.adapter->mesh().view();
    const unsigned char* ghosts = piece.adapter->ghostCells();
    cells += view.numberOfCells -
      (ghosts ? view.numberOfCells - std::count(ghosts, ghosts + view.numberOfCells, 0) : 0);
    for (Index point = 0; point < view.numberOfPoints; ++point)
    {
      extent.add(pointOf(view, point));
    }
  }
  extent = unite(group, extent);
  const double height = norm(extent.high - extent.low) /
    std::sqrt(std::max(1.0, static_cast<double>(group.sum(cells))));
  std::vector<FacePiece> faces;
  bool known = false;
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    adapters[i]->list(pieces[i].data, *pieces[i].adapter, height, threads);
    known = known || !adapters[i]->Faces.patches.empty();
    faces.push_back({ &adapters[i]->Faces, adapters[i]->points() });
  }
  const int axis = group.any(known) ? -1 : markLayer(group, faces);
  if (axis >= 0 && !adapters.empty())
  {
    std::string& notice = adapters.front()->Notice;
    notice += std::string(notice.empty() ? "" : " ") +
      "The mesh is one layer of cells and is measured as planar, perpendicular to " + "xyz"[axis] +
      ".";
  }
}

//------------------------------------------------------------------------------
void FaceMeshAdapter::list(
  vtkDataSet* input, const MeshAdapter& adapter, double height, int threads)
{
  this->View = adapter.inputView();
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
    this->Extruded = true;
    this->listPolygons(mesh, height);
    patches.resize(2);
    for (std::size_t i = 0; i < patches.size(); ++i)
    {
      patches[i].name = i == 0 ? "below" : "above";
      patches[i].type = "empty";
    }
  }
  else if (mesh.view().numberOfCells > 0)
  {
    throw Error("Finite-volume metrics are defined for volume meshes and planar meshes, not for "
                "surfaces in space. Choose element metrics.");
  }
  const Index points = this->extruded() ? 2 * this->View.numberOfPoints : this->View.numberOfPoints;
  this->Faces = findFaces(points, this->List, this->Facets, std::move(patches), threads);
  this->List = ListedFaces();
  this->Facets = ListedFacets();
}

//------------------------------------------------------------------------------
void FaceMeshAdapter::listVolumes(vtkDataSet* input, const MeshAdapter& adapter, int threads)
{
  const MeshView& view = adapter.mesh().view();
  auto* grid = vtkUnstructuredGrid::SafeDownCast(input);
  vtkNew<vtkIdList> stream;
  std::vector<char> isPolyhedron;
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
    isPolyhedron.push_back(polyhedron);
    this->Cells.push_back(cell);
  }
  if (adapter.mesh().mirrored())
  {
    reverseFaces(this->List);
  }
  // Lists from an OpenFOAM file are kept as given, so that reversed faces are found.
  const bool polyhedra =
    std::find(isPolyhedron.begin(), isPolyhedron.end(), 1) != isPolyhedron.end();
  if (polyhedra && !input->GetFieldData()->GetAbstractArray(FoamCase))
  {
    const TurnedCells found = turnFaces(this->List, 0, this->View.points, threads);
    if (found.open > 0)
    {
      this->Notice = std::to_string(found.open) +
        (found.open == 1 ? " cell is open: it has" : " cells are open: they have") +
        " an edge that is not shared by exactly two faces.";
    }
    // If most lists have no orientation, the orientation of the others is meaningless.
    const bool senseless =
      2 * found.turned > std::count(isPolyhedron.begin(), isPolyhedron.end(), 1);
    const Index turned = turnInsideOut(this->List, isPolyhedron, this->View.points, senseless);
    if (turned > 0)
    {
      this->Notice += std::string(this->Notice.empty() ? "" : " ") +
        "The faces of the polyhedra are listed as seen from inside; they are treated as if seen "
        "from outside.";
    }
  }
}

//------------------------------------------------------------------------------
/// Makes a planar mesh one layer, in the frame of its plane.
void FaceMeshAdapter::listPolygons(const Mesh& mesh, double height)
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
    turnPolygons(cells, this->Points.data()); // no orientation was found
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
  vtkDataArray* ids = input->GetCellData()->GetGlobalIds();
  for (Index cell = 0; cell < this->View.numberOfCells; ++cell)
  {
    pollInterruption(cell);
    if (!isFacet(this->View.cellTypes[cell]))
    {
      continue;
    }
    const int number = numbers ? static_cast<int>(numbers->GetComponent(cell, 0)) : -1;
    if (patches > 0 && number >= patches)
    {
      continue; // on a "processor" patch of another piece that was joined with this one
    }
    const Index first = this->View.offsets[cell];
    appendFacet(this->Facets, this->View.connectivity + first, this->View.offsets[cell + 1] - first,
      patches > 0 ? number : -1);
    if (ids)
    {
      this->FacetIds.push_back(static_cast<Index>(ids->GetComponent(cell, 0)));
    }
  }
}

namespace
{
/// The polygons of a mesh, divided into triangles.
struct PolygonTriangles
{
  std::vector<Index> offsets = { 0 }, connectivity;
  std::vector<unsigned char> types;
  std::unique_ptr<Mesh> mesh;

  explicit PolygonTriangles(const MeshView& view)
  {
    for (Index cell = 0; cell < view.numberOfCells; ++cell)
    {
      pollInterruption(cell);
      const Index first = view.offsets[cell];
      for (Index i = first + 1; isFacet(view.cellTypes[cell]) && i + 1 < view.offsets[cell + 1];
           ++i)
      {
        for (Index at : { first, i, i + 1 })
        {
          this->connectivity.push_back(view.connectivity[at]);
        }
        this->offsets.push_back(static_cast<Index>(this->connectivity.size()));
      }
    }
    MeshView triangles = view;
    triangles.numberOfCells = static_cast<Index>(this->offsets.size()) - 1;
    this->types.assign(triangles.numberOfCells, VTK_TRIANGLE);
    triangles.cellTypes = this->types.data();
    triangles.offsets = this->offsets.data();
    triangles.connectivity = this->connectivity.data();
    this->mesh = std::make_unique<Mesh>(triangles);
  }
};
}

//------------------------------------------------------------------------------
void setSpaceWithPolygons(RankGroup& group, const std::vector<FaceInput>& pieces)
{
  std::vector<std::unique_ptr<PolygonTriangles>> triangles;
  std::vector<RankPiece> list;
  Index number = 0;
  for (const FaceInput& piece : pieces)
  {
    triangles.push_back(std::make_unique<PolygonTriangles>(piece.adapter->mesh().view()));
    list.push_back({ triangles.back()->mesh.get() });
    number += triangles.back()->mesh->view().numberOfCells;
  }
  if (group.sum(number) > 0)
  {
    const MeshSpace space = spaceOf(group, list);
    for (const FaceInput& piece : pieces)
    {
      piece.adapter->mesh().setSpace(space);
    }
  }
}
}
