// SPDX-License-Identifier: BSD-3-Clause
#include "ReconnectableMesh.h"

#include "CellKinds.h"
#include "PointMerge.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Reconnection/DegenerateCells.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace tautline
{
namespace
{
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
}

//------------------------------------------------------------------------------
ReconnectableMesh::ReconnectableMesh(vtkDataSet* input, bool mergePoints, int threads)
  : Input(meshOf(input))
  , Taken(this->Input)
  , Threads(threads)
{
  refuseGhosts(this->Input);
  this->findKind();
  this->Adapter = std::make_unique<MeshAdapter>(this->Taken, threads);
  this->Fixed.assign(this->mesh().view().numberOfPoints, 0);
  if (mergePoints)
  {
    const JoinedCopies copies =
      this->Adapter->joinCopies(this->Input->GetPointData()->GetGlobalIds());
    this->Adapter->mergeCoincidentPoints(threads);
    const CoincidentPoints& coincident = this->Adapter->coincident();
    this->Notice = describeMerged(coincident, this->Adapter->given());
    if (coincident.merged > 0)
    {
      this->Notice += " The output has one point in place of each group.";
    }
    const std::string joined = describeJoined(copies);
    this->Notice += (this->Notice.empty() || joined.empty() ? "" : " ") + joined;
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
  this->Representative = this->Adapter->coincident().representative;
  this->takeLines();
  this->takeFacets();
}

//------------------------------------------------------------------------------
/// Finds whether the mesh is of tetrahedra or triangles, and leaves out cells of lower dimension.
void ReconnectableMesh::findKind()
{
  const CellKinds kinds(countCells(this->Input, true));
  const int type = kinds.dimension == 3 ? VTK_TETRA : VTK_TRIANGLE;
  this->Corners = kinds.dimension + 1;
  this->LeftOut = kinds.leftOut;
  if (this->LeftOut.empty())
  {
    return;
  }
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(this->Input->GetPoints());
  grid->AllocateExact(kinds.taken, this->Corners * kinds.taken);
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
    const std::vector<Index>& one = this->Representative;
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
  const std::vector<Index>& one = this->Representative;
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
  unite(this->Fixed, this->Representative);
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
  unite(this->Fixed, this->Representative);
}

//------------------------------------------------------------------------------
void requireNumbers(vtkDataArray* regions)
{
  if (regions && regions->GetNumberOfComponents() != 1)
  {
    throw Error(std::string("The array of regions, ") + regions->GetName() + ", has " +
      std::to_string(regions->GetNumberOfComponents()) +
      " components: choose one with a number per cell.");
  }
}

//------------------------------------------------------------------------------
double regionAt(vtkDataArray* regions, Index cell)
{
  const double value = regions->GetComponent(cell, 0);
  if (!std::isfinite(value))
  {
    throw Error(std::string("The array of regions, ") + regions->GetName() + ", is " +
      (std::isnan(value) ? "NaN" : "infinite") + " in cell " + std::to_string(cell) +
      ": give every cell the number of its region.");
  }
  return value;
}

//------------------------------------------------------------------------------
void ReconnectableMesh::setRegions(vtkDataArray* ofCells)
{
  if (!ofCells)
  {
    return;
  }
  requireNumbers(ofCells);
  const Index count = this->mesh().view().numberOfCells;
  std::map<double, Index> numbers;
  for (Index cell = 0; cell < count; ++cell)
  {
    pollInterruption(cell);
    const double value = regionAt(ofCells, this->inputCell(cell));
    this->Regions.push_back(
      numbers.emplace(value, static_cast<Index>(numbers.size())).first->second);
  }
}

//------------------------------------------------------------------------------
void ReconnectableMesh::removeDegenerate()
{
  DegenerateOptions options;
  options.fixed = this->Fixed.data();
  options.edges = this->Lines;
  options.facets = this->Facets;
  const DegenerateRemoval removal = removeDegenerateCells(this->mesh(), options);
  if (removal.cells.empty())
  {
    return;
  }
  const auto count = static_cast<vtkIdType>(removal.originalCells.size());
  vtkNew<vtkUnstructuredGrid> grid;
  const MeshView& view = this->mesh().view();
  grid->SetPoints(
    makePoints(std::vector<double>(view.points, view.points + 3 * view.numberOfPoints), nullptr));
  grid->AllocateExact(count, this->Corners * count);
  std::vector<Index> cells, regions;
  for (vtkIdType cell = 0; cell < count; ++cell)
  {
    std::array<vtkIdType, 4> nodes = {};
    std::copy_n(removal.cells.begin() + this->Corners * cell, this->Corners, nodes.begin());
    grid->InsertNextCell(
      this->isTriangles() ? VTK_TRIANGLE : VTK_TETRA, this->Corners, nodes.data());
    const Index original = removal.originalCells[cell];
    cells.push_back(this->inputCell(original));
    if (!this->Regions.empty())
    {
      regions.push_back(this->Regions[original]);
    }
  }
  const bool mirrored = this->mesh().mirrored();
  this->Taken = grid;
  this->Adapter = std::make_unique<MeshAdapter>(grid, this->Threads);
  this->Adapter->mesh().setMirrored(mirrored);
  this->Cells = std::move(cells);
  this->Regions = std::move(regions);
  this->Lines = removal.edges;
  this->Facets = removal.facets;
  if (this->Representative.empty())
  {
    this->Representative = removal.mergedInto;
  }
  else
  {
    for (Index& point : this->Representative)
    {
      point = removal.mergedInto[point];
    }
  }
  const Index gone = removal.degenerate - removal.left;
  if (gone > 0)
  {
    const bool one = gone == 1;
    this->Notice += (this->Notice.empty() ? "" : " ") + std::to_string(gone) + " degenerate " +
      (this->isTriangles() ? (one ? "triangle was" : "triangles were")
                           : (one ? "tetrahedron was" : "tetrahedra were")) +
      " removed first.";
  }
}
}
