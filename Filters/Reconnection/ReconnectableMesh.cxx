// SPDX-License-Identifier: BSD-3-Clause
#include "ReconnectableMesh.h"

#include "CellKinds.h"
#include "ImprovedCells.h"
#include "PointMerge.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Reconnection/DegenerateCells.h"
#include "vtkCellData.h"
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
#include <set>

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
      " ghost or hidden cells: the connectivity of a part of a mesh cannot be changed separately; "
      "gather the mesh on one process and run Remove Ghost Information first.");
  }
}
}

namespace
{
/// Numbers the combinations of values that some arrays have on each cell, from 0 in order of
/// occurrence.
std::vector<Index> numbersOf(
  const std::vector<vtkDataArray*>& arrays, const std::vector<Index>& cells)
{
  std::map<std::vector<double>, Index> numbers;
  std::vector<Index> result;
  std::vector<double> values(arrays.size());
  for (Index cell : cells)
  {
    pollInterruption(cell);
    std::transform(arrays.begin(), arrays.end(), values.begin(),
      [cell](vtkDataArray* array) { return array->GetComponent(cell, 0); });
    result.push_back(numbers.emplace(values, static_cast<Index>(numbers.size())).first->second);
  }
  return result;
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
/// Finds whether the mesh consists of tetrahedra or triangles, and leaves out cells of lower
/// dimension.
void ReconnectableMesh::findKind()
{
  const CellKinds kinds(countCells(this->Input, true));
  const int type = kinds.dimension == 3 ? VTK_TETRA : VTK_TRIANGLE;
  this->Corners = kinds.dimension + 1;
  this->LeftOut = kinds.leftOut;
  this->LeftOutBesideMarks = kinds.leftOutBesideMarks;
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
      this->MarkCells.push_back(cell);
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
      this->MarkCells.push_back(cell);
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
void ReconnectableMesh::keepOthers(vtkDataArray* ofCells)
{
  const Index count = this->mesh().view().numberOfCells;
  const bool any = !this->Outside.empty();
  this->Outside.resize(ofCells ? count : this->Outside.size(), 0);
  for (Index cell = 0; ofCells && cell < count; ++cell)
  {
    const bool stays = ofCells->GetComponent(this->inputCell(cell), 0) == 0.0;
    this->Outside[cell] = any ? this->Outside[cell] || stays : stays;
  }
}

//------------------------------------------------------------------------------
std::vector<vtkDataArray*> ReconnectableMesh::tagArrays(
  const std::vector<Index>& cells, std::size_t repeats) const
{
  std::vector<vtkDataArray*> found;
  vtkCellData* data = this->Input->GetCellData();
  for (int a = 0; a < data->GetNumberOfArrays(); ++a)
  {
    vtkDataArray* array = data->GetArray(a);
    // Cell numbers of an earlier input, which several cells may share, are not tags.
    const bool ids = array &&
      (array == data->GetGlobalIds() || array == data->GetPedigreeIds() ||
        (array->GetName() && std::string(array->GetName()) == OriginalCellArray));
    if (!array || ids || array->GetNumberOfComponents() != 1 ||
      array == this->Input->GetCellGhostArray() || array->GetDataType() == VTK_DOUBLE ||
      array->GetDataType() == VTK_FLOAT)
    {
      continue;
    }
    std::set<double> values;
    for (std::size_t i = 0; i < cells.size() && repeats * values.size() <= cells.size(); ++i)
    {
      pollInterruption(static_cast<Index>(i));
      values.insert(array->GetComponent(cells[i], 0));
    }
    if (repeats * values.size() <= cells.size())
    {
      found.push_back(array);
    }
  }
  return found;
}

//------------------------------------------------------------------------------
std::vector<std::int32_t> ReconnectableMesh::facetClasses() const
{
  constexpr std::size_t facetsPerValue = 2;
  const std::vector<vtkDataArray*> arrays = this->tagArrays(this->MarkCells, facetsPerValue);
  std::vector<std::int32_t> classes;
  for (Index number : numbersOf(arrays, this->MarkCells))
  {
    classes.push_back(static_cast<std::int32_t>(number + 1));
  }
  return classes;
}

//------------------------------------------------------------------------------
void ReconnectableMesh::fixLineBorders()
{
  constexpr std::size_t linesPerValue = 2;
  const std::vector<Index> classes =
    numbersOf(this->tagArrays(this->MarkCells, linesPerValue), this->MarkCells);
  std::vector<Index> ofPoint(this->Fixed.size(), -1);
  for (std::size_t i = 0; i < this->Lines.size(); ++i)
  {
    for (Index p : this->Lines[i])
    {
      this->Fixed[p] |= ofPoint[p] >= 0 && ofPoint[p] != classes[i];
      ofPoint[p] = classes[i];
    }
  }
}

//------------------------------------------------------------------------------
std::string ReconnectableMesh::setRegionsByTags()
{
  constexpr std::size_t cellsPerValue = 4;
  std::vector<Index> cells(this->mesh().view().numberOfCells);
  for (std::size_t c = 0; c < cells.size(); ++c)
  {
    cells[c] = this->inputCell(static_cast<Index>(c));
  }
  const std::vector<vtkDataArray*> arrays = this->tagArrays(cells, cellsPerValue);
  std::vector<Index> regions = numbersOf(arrays, cells);
  if (std::all_of(regions.begin(), regions.end(), [](Index region) { return region == 0; }))
  {
    return "";
  }
  this->Regions = std::move(regions);
  std::string names;
  for (vtkDataArray* array : arrays)
  {
    names += (names.empty() ? "" : ", ") + std::string(array->GetName() ? array->GetName() : "");
  }
  return "The regions that are kept are defined by the tags " + names +
    ": choose an array under Regions for others.";
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
  std::vector<Index> cells, regions, marks;
  std::vector<unsigned char> outside;
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
    if (!this->Outside.empty())
    {
      outside.push_back(this->Outside[original]);
    }
  }
  const bool mirrored = this->mesh().mirrored();
  this->Taken = grid;
  this->Adapter = std::make_unique<MeshAdapter>(grid, this->Threads);
  this->Adapter->mesh().setMirrored(mirrored);
  this->Cells = std::move(cells);
  this->Regions = std::move(regions);
  this->Outside = std::move(outside);
  for (Index mark : this->isTriangles() ? removal.originalEdges : removal.originalFacets)
  {
    marks.push_back(this->MarkCells[mark]);
  }
  this->MarkCells = std::move(marks);
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
