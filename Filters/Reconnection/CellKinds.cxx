// SPDX-License-Identifier: BSD-3-Clause
#include "CellKinds.h"

#include "VtkCompatibility.h"
#include "tautline/Core/Interruption.h"

#include "vtkCellType.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkGenericCell.h"
#include "vtkNew.h"
#include "vtkPointSet.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

namespace tautline
{
namespace
{
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

//------------------------------------------------------------------------------
std::map<int, Index> countCells(vtkDataSet* input, bool ghosts)
{
  vtkUnsignedCharArray* flags = ghosts ? nullptr : input->GetCellGhostArray();
  std::map<int, Index> counts;
  for (vtkIdType cell = 0; cell < input->GetNumberOfCells(); ++cell)
  {
    pollInterruption(cell);
    constexpr int Ghost = vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL;
    if (!flags || (flags->GetValue(cell) & Ghost) == 0)
    {
      ++counts[input->GetCellType(cell)];
    }
  }
  return counts;
}

//------------------------------------------------------------------------------
CellKinds::CellKinds(std::map<int, Index> counts)
{
  std::map<int, Index> ofDimension[4], curved[4];
  vtkNew<vtkGenericCell> any;
  for (const auto& [type, count] : counts)
  {
    any->SetCellType(type);
    const int itsDimension = any->GetCellDimension();
    ofDimension[itsDimension][type] = count;
    if (!any->IsLinear())
    {
      curved[itsDimension][type] = count;
    }
  }
  this->dimension = ofDimension[3].empty() && !ofDimension[2].empty() ? 2 : 3;
  const int type = this->dimension == 3 ? VTK_TETRA : VTK_TRIANGLE;
  const std::string cells = this->dimension == 3 ? "tetrahedra" : "triangles";
  this->taken = counts[type];
  counts.erase(type);
  ofDimension[this->dimension].erase(type);
  if (!ofDimension[this->dimension].empty())
  {
    const char* remedy = this->dimension == 3 ? "Tetrahedralize" : "Triangulate";
    const bool straight = curved[this->dimension].empty();
    throw Error(listOf(ofDimension[this->dimension]) + ": Improve Mesh takes linear " + cells +
      " only; run " +
      (straight ? remedy + std::string(" first.")
                : "Curve Mesh with order 1 first to keep only the corners, and with the order of "
                  "these cells on the result."));
  }
  if (this->taken == 0)
  {
    throw Error(listOf(counts) +
      ", but no tetrahedron or triangle: Improve Mesh takes one of these; run a mesher (or "
      "Delaunay 2D or 3D) first.");
  }
  if (counts.empty())
  {
    return;
  }
  const std::string besides = " beside the " + cells + " are left out of the output.";
  this->leftOut = listOf(counts) + besides +
    (this->dimension == 2 ? " Edges of the mesh that lines join are kept."
                          : " Facets inside the mesh that triangles mark are kept.");
  for (const int mark : this->dimension == 2 ? std::vector<int>{ VTK_LINE, VTK_POLY_LINE }
                                             : std::vector<int>{ VTK_TRIANGLE })
  {
    counts.erase(mark);
  }
  this->leftOutBesideMarks = counts.empty() ? "" : listOf(counts) + besides;
}
}
