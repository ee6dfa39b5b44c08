// SPDX-License-Identifier: BSD-3-Clause
#include "ReconnectableMesh.h"

#include "PointMerge.h"
#include "VtkCompatibility.h"

#include "tautline/Core/Interruption.h"
#include "vtkCell.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkGenericCell.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace tautline
{
namespace
{
vtkPointSet* meshOf(vtkDataSet* input)
{
  auto* mesh = vtkPointSet::SafeDownCast(input);
  if (!vtkUnstructuredGrid::SafeDownCast(mesh) && !vtkPolyData::SafeDownCast(mesh))
  {
    throw Error(std::string("The mesh is a ") + input->GetClassName() +
      ", not an unstructured grid of tetrahedra or triangles: run Tetrahedralize first.");
  }
  return mesh;
}

void refuseGhosts(vtkDataSet* grid)
{
  vtkUnsignedCharArray* flags = grid->GetCellGhostArray();
  Index ghosts = 0;
  for (vtkIdType i = 0; flags && i < flags->GetNumberOfValues(); ++i)
  {
    constexpr int Ghost = vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL;
    ghosts += (flags->GetValue(i) & Ghost) != 0;
  }
  if (ghosts > 0)
  {
    throw Error(std::to_string(ghosts) +
      " ghost or hidden cells: the connectivity of a part of a mesh cannot change on its own; "
      "gather the mesh in one process and run Remove Ghost Information first.");
  }
}

std::string pluralOf(int type)
{
  static const std::map<int, std::string> names = { { VTK_VERTEX, "vertices" },
    { VTK_POLY_VERTEX, "poly-vertices" }, { VTK_LINE, "lines" }, { VTK_POLY_LINE, "polylines" },
    { VTK_TRIANGLE, "triangles" }, { VTK_QUAD, "quadrilaterals" }, { VTK_POLYGON, "polygons" },
    { VTK_HEXAHEDRON, "hexahedra" }, { VTK_VOXEL, "voxels" }, { VTK_WEDGE, "wedges" },
    { VTK_PYRAMID, "pyramids" }, { VTK_POLYHEDRON, "polyhedra" },
    { VTK_QUADRATIC_TETRA, "quadratic tetrahedra" } };
  const auto found = names.find(type);
  return found != names.end() ? found->second : std::string("cells of type ") + cellClassName(type);
}

/// "8 hexahedra and 3 wedges"
std::string listOf(const std::map<int, Index>& counts)
{
  std::string text;
  std::size_t left = counts.size();
  for (const auto& [type, count] : counts)
  {
    --left;
    text += std::to_string(count) + " " + pluralOf(type) +
      (left == 0      ? ""
          : left == 1 ? " and "
                      : ", ");
  }
  return text;
}
}

//------------------------------------------------------------------------------
ReconnectableMesh::ReconnectableMesh(vtkDataSet* input, bool mergePoints, int threads)
  : Input(meshOf(input))
  , Taken(this->Input)
{
  refuseGhosts(this->Input);
  this->findKind();
  this->Adapter = std::make_unique<MeshAdapter>(this->Taken, threads);
  this->Fixed.assign(this->mesh().view().numberOfPoints, 0);
  if (mergePoints)
  {
    this->Adapter->mergeCoincidentPoints(threads);
    const CoincidentPoints& coincident = this->Adapter->coincident();
    this->Notice = describeMerged(coincident, this->Adapter->given());
    if (coincident.merged > 0)
    {
      this->Notice += " The output has one point in place of each group.";
    }
  }
  else
  {
    const CoincidentPoints seams = findCoincidentPoints(this->mesh());
    this->Notice = describeSeams(seams, this->mesh());
    if (seams.merged > 0)
    {
      this->Notice += this->isTriangles() ? " The edges there are treated as border."
                                          : " The facets there are treated as boundary.";
    }
  }
  for (const std::string& more :
    { this->Adapter->orient(nullptr, !this->isTriangles()), this->Adapter->notice() })
  {
    this->Notice += (this->Notice.empty() || more.empty() ? "" : " ") + more;
  }
  this->takeLines();
  this->takeFacets();
}

//------------------------------------------------------------------------------
/// Finds whether the mesh is of tetrahedra or triangles, and leaves out cells of lower dimension.
void ReconnectableMesh::findKind()
{
  std::map<int, Index> counts;
  for (vtkIdType cell = 0; cell < this->Input->GetNumberOfCells(); ++cell)
  {
    pollInterruption(cell);
    ++counts[this->Input->GetCellType(cell)];
  }
  std::map<int, Index> ofDimension[4], curved[4];
  vtkNew<vtkGenericCell> any;
  for (const auto& [type, count] : counts)
  {
    any->SetCellType(type);
    const int dimension = any->GetCellDimension();
    ofDimension[dimension][type] = count;
    if (!any->IsLinear())
    {
      curved[dimension][type] = count;
    }
  }
  const int dimension = ofDimension[3].empty() && !ofDimension[2].empty() ? 2 : 3;
  const int type = dimension == 3 ? VTK_TETRA : VTK_TRIANGLE;
  const char* cells = dimension == 3 ? "tetrahedra" : "triangles";
  this->Corners = dimension + 1;
  const Index taken = counts[type];
  counts.erase(type);
  ofDimension[dimension].erase(type);
  if (!ofDimension[dimension].empty())
  {
    const char* remedy = dimension == 3 ? "Tetrahedralize" : "Triangulate";
    throw Error(listOf(ofDimension[dimension]) + ": Improve Mesh takes linear " + cells +
      " only; run " + (curved[dimension].empty() ? remedy : "Tessellate") + " first.");
  }
  if (taken == 0)
  {
    throw Error(listOf(counts) +
      ", but no tetrahedron or triangle: Improve Mesh takes one of these; run a mesher (or "
      "Delaunay 2D or 3D) first.");
  }
  if (counts.empty())
  {
    return;
  }
  this->LeftOut = listOf(counts) + " beside the " + cells + " are left out of the output. " +
    (this->isTriangles() ? "Edges of the mesh that lines join are kept."
                         : "Facets inside the mesh that triangles mark are kept.");
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(this->Input->GetPoints());
  grid->AllocateExact(taken, this->Corners * taken);
  vtkNew<vtkIdList> points;
  for (vtkIdType cell = 0; cell < this->Input->GetNumberOfCells(); ++cell)
  {
    pollInterruption(cell);
    if (this->Input->GetCellType(cell) == type)
    {
      this->Input->GetCellPoints(cell, points);
      grid->InsertNextCell(type, points);
      this->Cells.push_back(cell);
    }
  }
  this->Taken = grid;
}

//------------------------------------------------------------------------------
/// The edges that lines beside triangles mark.
void ReconnectableMesh::takeLines()
{
  vtkNew<vtkIdList> points;
  for (vtkIdType cell = 0; this->isTriangles() && cell < this->Input->GetNumberOfCells(); ++cell)
  {
    const int type = this->Input->GetCellType(cell);
    if (type != VTK_LINE && type != VTK_POLY_LINE)
    {
      continue;
    }
    this->Input->GetCellPoints(cell, points);
    const std::vector<Index>& one = this->Adapter->coincident().representative;
    const auto id = [&](vtkIdType i)
    { return one.empty() ? points->GetId(i) : one[points->GetId(i)]; };
    for (vtkIdType i = 0; i + 1 < points->GetNumberOfIds(); ++i)
    {
      this->Lines.push_back({ id(i), id(i + 1) });
    }
  }
}

//------------------------------------------------------------------------------
/// The facets that triangles beside tetrahedra mark.
void ReconnectableMesh::takeFacets()
{
  vtkNew<vtkIdList> points;
  const std::vector<Index>& one = this->Adapter->coincident().representative;
  for (vtkIdType cell = 0;
       !this->isTriangles() && !this->Cells.empty() && cell < this->Input->GetNumberOfCells();
       ++cell)
  {
    pollInterruption(cell);
    if (this->Input->GetCellType(cell) == VTK_TRIANGLE)
    {
      this->Input->GetCellPoints(cell, points);
      const auto id = [&](vtkIdType i)
      { return one.empty() ? points->GetId(i) : one[points->GetId(i)]; };
      this->Facets.push_back({ id(0), id(1), id(2) });
    }
  }
}

//------------------------------------------------------------------------------
void ReconnectableMesh::fixPoints(vtkDataArray* ofPoints)
{
  for (std::size_t i = 0; ofPoints && i < this->Fixed.size(); ++i)
  {
    this->Fixed[i] |= ofPoints->GetComponent(static_cast<vtkIdType>(i), 0) != 0;
  }
  unite(this->Fixed, this->Adapter->coincident().representative);
}

//------------------------------------------------------------------------------
void ReconnectableMesh::fixCells(vtkDataArray* ofCells)
{
  vtkNew<vtkIdList> points;
  for (vtkIdType cell = 0; ofCells && cell < this->Input->GetNumberOfCells(); ++cell)
  {
    if (ofCells->GetComponent(cell, 0) != 0)
    {
      this->Input->GetCellPoints(cell, points);
      std::for_each(points->begin(), points->end(), [this](vtkIdType p) { this->Fixed[p] = 1; });
    }
  }
  unite(this->Fixed, this->Adapter->coincident().representative);
}

//------------------------------------------------------------------------------
void ReconnectableMesh::setRegions(vtkDataArray* ofCells)
{
  if (!ofCells)
  {
    return;
  }
  if (ofCells->GetNumberOfComponents() != 1)
  {
    throw Error(std::string("The array of regions, ") + ofCells->GetName() + ", has " +
      std::to_string(ofCells->GetNumberOfComponents()) +
      " components: choose one with a number per cell.");
  }
  const Index count = this->mesh().view().numberOfCells;
  std::map<double, Index> numbers;
  for (Index cell = 0; cell < count; ++cell)
  {
    pollInterruption(cell);
    const double value = ofCells->GetComponent(this->inputCell(cell), 0);
    if (!std::isfinite(value))
    {
      throw Error(std::string("The array of regions, ") + ofCells->GetName() + ", is " +
        (std::isnan(value) ? "NaN" : "infinite") + " in cell " +
        std::to_string(this->inputCell(cell)) + ": give every cell the number of its region.");
    }
    this->Regions.push_back(
      numbers.emplace(value, static_cast<Index>(numbers.size())).first->second);
  }
}
}
