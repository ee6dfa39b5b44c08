#include "ReconnectableMesh.h"

#include "PointMerge.h"

#include "tautline/Core/Interruption.h"
#include "vtkCell.h"
#include "vtkCellType.h"
#include "vtkCellTypes.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkGenericCell.h"
#include "vtkIdList.h"
#include "vtkNew.h"
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
constexpr int TetrahedronPoints = 4;

vtkUnstructuredGrid* gridOf(vtkDataSet* input)
{
  auto* grid = vtkUnstructuredGrid::SafeDownCast(input);
  if (!grid)
  {
    throw Error(std::string("The mesh is a ") + input->GetClassName() +
      ", not an unstructured grid of tetrahedra: run " +
      (vtkPolyData::SafeDownCast(input) ? "a mesher (or Delaunay 3D)" : "Tetrahedralize") +
      " first.");
  }
  return grid;
}

void refuseGhosts(vtkUnstructuredGrid* grid)
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
  return found != names.end()
    ? found->second
    : std::string("cells of type ") + vtkCellTypes::GetClassNameFromTypeId(type);
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
  : Input(gridOf(input))
  , Tetrahedra(this->Input)
{
  refuseGhosts(this->Input);
  this->takeTetrahedra();
  this->Adapter = std::make_unique<MeshAdapter>(this->Tetrahedra, threads);
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
      this->Notice += " The facets there are treated as boundary.";
    }
  }
  for (const std::string& more : { this->Adapter->orient(), this->Adapter->notice() })
  {
    this->Notice += (this->Notice.empty() || more.empty() ? "" : " ") + more;
  }
}

//------------------------------------------------------------------------------
void ReconnectableMesh::takeTetrahedra()
{
  std::map<int, Index> counts;
  for (vtkIdType cell = 0; cell < this->Input->GetNumberOfCells(); ++cell)
  {
    pollInterruption(cell);
    ++counts[this->Input->GetCellType(cell)];
  }
  const Index tetrahedra = counts[VTK_TETRA];
  counts.erase(VTK_TETRA);
  std::map<int, Index> solids;
  bool curved = false;
  constexpr int Volume = 3;
  vtkNew<vtkGenericCell> any;
  for (const auto& [type, count] : counts)
  {
    any->SetCellType(type);
    if (any->GetCellDimension() == Volume)
    {
      solids[type] = count;
      curved = curved || !any->IsLinear();
    }
  }
  if (!solids.empty())
  {
    throw Error(listOf(solids) + ": Improve Mesh takes linear tetrahedra only; run " +
      (curved ? "Tessellate" : "Tetrahedralize") + " first.");
  }
  if (tetrahedra == 0)
  {
    throw Error(listOf(counts) +
      ", but no tetrahedron: Improve Mesh takes tetrahedra; run a mesher (or Delaunay 3D) first.");
  }
  if (counts.empty())
  {
    return;
  }
  this->LeftOut = listOf(counts) +
    " beside the tetrahedra are left out of the output. To keep facets inside the mesh, choose a "
    "region array of the tetrahedra.";
  this->Tetrahedra = vtkSmartPointer<vtkUnstructuredGrid>::New();
  this->Tetrahedra->SetPoints(this->Input->GetPoints());
  this->Tetrahedra->AllocateExact(tetrahedra, TetrahedronPoints * tetrahedra);
  vtkNew<vtkIdList> points;
  for (vtkIdType cell = 0; cell < this->Input->GetNumberOfCells(); ++cell)
  {
    pollInterruption(cell);
    if (this->Input->GetCellType(cell) == VTK_TETRA)
    {
      this->Input->GetCellPoints(cell, points);
      this->Tetrahedra->InsertNextCell(VTK_TETRA, points);
      this->Cells.push_back(cell);
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
