// SPDX-License-Identifier: BSD-3-Clause
// One layer of cells is optimized as the planar mesh of its side.
#include "Blocks.h"
#include "LayerMesh.h"
#include "Registry.h"
#include "Set.h"
#include "VtkMeshes.h"

#include "vtkMeshOptimizer.h"

#include "tautline/Core/Iteration.h"

#include "vtkCell.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkIntArray.h"
#include "vtkPointData.h"

using namespace tautline;

namespace
{
/// Sweeps go through the cells from other points, and end there.
constexpr double converged = 1e-4;

/// A block of one layer, or its side, with inner points moved by the same.
MeshData movedBlock(CellType type, Index layers)
{
  MeshData data = blockMesh(type, 5, 5, layers);
  Random random(2);
  const Index perSide = 36;
  for (Index i = 0; i < perSide; ++i)
  {
    const double* p = &data.points[3 * i];
    const bool inner = p[0] > 0.5 && p[0] < 4.5 && p[1] > 0.5 && p[1] < 4.5;
    for (int c = 0; c < 2 && inner; ++c)
    {
      data.points[3 * i + c] += random.uniform(-0.4, 0.4);
      if (layers > 0)
      {
        data.points[3 * (i + perSide) + c] = data.points[3 * i + c];
      }
    }
  }
  return data;
}
}

TAUTLINE_PART(testFind)
{
  const auto grid = toGrid(movedBlock(CellType::Hexahedron, 1));
  const auto layer = LayerMesh::find(grid);
  TAUTLINE_CHECK(layer != nullptr && layer->axis() == 2);
  const auto planar = layer->planar();
  TAUTLINE_CHECK_EQUAL(planar->GetNumberOfPoints(), 36);
  TAUTLINE_CHECK_EQUAL(planar->GetNumberOfCells(), 25);
  const MeshData side = toMesh(planar);
  const Mesh mesh(side.view());
  TAUTLINE_CHECK(mesh.dimension() == Dimension::Planar);
  TAUTLINE_EACH_OF(signed char v, validityOf(mesh), TAUTLINE_CHECK_EQUAL(int(v), int(Valid)));
  // Facets across the layer are lines, with their arrays; facets of the sides are left out.
  MeshData faced = movedBlock(CellType::Hexahedron, 1);
  faced.addCell(CellType::Quadrilateral, std::vector<Index>{ 0, 1, 7, 6 });
  faced.addCell(CellType::Quadrilateral, std::vector<Index>{ 0, 1, 37, 36 });
  const auto facedGrid = toGrid(faced);
  const auto withLine = LayerMesh::find(facedGrid)->planar();
  TAUTLINE_CHECK_EQUAL(withLine->GetNumberOfCells(), 26);
  TAUTLINE_CHECK_EQUAL(withLine->GetCellType(25), VTK_LINE);
  const double* ends = withLine->GetCell(25)->GetBounds();
  TAUTLINE_CHECK(ends[0] == 0 && ends[1] == 1 && ends[2] == 0 && ends[3] == 0);
  TAUTLINE_CHECK(LayerMesh::find(toGrid(movedBlock(CellType::Wedge, 1))) != nullptr);
  // Two layers, a row of cells, other cells and surfaces are none.
  TAUTLINE_CHECK(!LayerMesh::find(toGrid(blockMesh(CellType::Hexahedron, 3, 3, 2))));
  TAUTLINE_CHECK(!LayerMesh::find(toGrid(blockMesh(CellType::Hexahedron, 3, 1, 1))));
  TAUTLINE_CHECK(!LayerMesh::find(toGrid(blockMesh(CellType::Tetrahedron, 3, 3, 1))));
  TAUTLINE_CHECK(!LayerMesh::find(toGrid(blockMesh(CellType::Quadrilateral, 3, 3, 0))));
}

/// The layer gets the points and the values of its side; both of its sides are the same bit by bit.
TAUTLINE_PART(testOptimize)
{
  for (CellType type : { CellType::Hexahedron, CellType::Wedge })
  {
    const CellType flat = type == CellType::Wedge ? CellType::Triangle : CellType::Quadrilateral;
    const auto grid = toGrid(movedBlock(type, 1)), side = toGrid(movedBlock(flat, 0));
    TAUTLINE_NEW(vtkMeshOptimizer, ofLayer, SetInputData(grid), Update());
    TAUTLINE_NEW(vtkMeshOptimizer, ofSide, SetInputData(side), Update());
    vtkPointSet *layer = meshOf(ofLayer), *planar = meshOf(ofSide);
    double largest = 0;
    for (vtkIdType i = 0; i < planar->GetNumberOfPoints(); ++i)
    {
      double expected[3], low[3], high[3], was[3];
      planar->GetPoint(i, expected);
      layer->GetPoint(i, low);
      layer->GetPoint(i + 36, high);
      side->GetPoint(i, was);
      TAUTLINE_CHECK_NEAR(low[0], expected[0], converged);
      TAUTLINE_CHECK_NEAR(low[1], expected[1], converged);
      TAUTLINE_CHECK(low[0] == high[0] && low[1] == high[1] && low[2] == 0 && high[2] == 1);
      largest = std::max(largest, std::abs(low[0] - was[0]));
      TAUTLINE_CHECK_EQUAL(component(layer->GetPointData(), "Displacement", i + 36),
        component(layer->GetPointData(), "Displacement", i));
    }
    TAUTLINE_CHECK(largest > 0.1);
    TAUTLINE_CHECK_NEAR(component(layer->GetCellData(), "imr", 7),
      component(planar->GetCellData(), "imr", 7), converged);
    // As a mesh of volumes, all points are of the boundary and stay.
    TAUTLINE_NEW(vtkMeshOptimizer, ofVolume, SetInputData(grid), PlanarLayersOff(), Update());
    TAUTLINE_CHECK_EQUAL(ofVolume->GetFreePoints(), 0);
  }
}

/// The preset Finite volumes in the filter: fixed points stay, checks and arrays describe the
/// output.
TAUTLINE_PART(testFiniteVolumes)
{
  MeshData data = blockMesh(CellType::Hexahedron, 4, 4, 4);
  const Index middle = 2 + 5 * (2 + 5 * 2);
  data.setPoint(middle, { 3.3, 3.2, 2.9 });
  const auto grid = toGrid(data);
  TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputData(grid),
    SetPreset(vtkMeshOptimizer::FINITE_VOLUMES), Update());
  TAUTLINE_CHECK_EQUAL(filter->GetStopReason(), static_cast<int>(StopReason::AllValid));
  TAUTLINE_CHECK_EQUAL(filter->GetInvertedAfter(), 0);
  TAUTLINE_CHECK(filter->GetInvertedBefore() > 0);
  vtkPointSet* output = meshOf(filter);
  TAUTLINE_CHECK(component(output->GetPointData(), "Displacement", middle) < 0);
  for (Index corner : { Index(0), data.view().numberOfPoints - 1 })
  {
    TAUTLINE_CHECK_EQUAL(component(output->GetPointData(), "Displacement", corner), 0.0);
  }
  for (vtkIdType cell = 0; cell < output->GetNumberOfCells(); ++cell)
  {
    TAUTLINE_CHECK_EQUAL(component(output->GetCellData(), "Validity", cell), double(Valid));
    TAUTLINE_CHECK(component(output->GetCellData(), "non_orthogonality", cell) <= 65);
  }
  // All points given as fixed.
  vtkNew<vtkIntArray> fixed;
  fixed->SetName("stays");
  fixed->SetNumberOfValues(grid->GetNumberOfPoints());
  fixed->FillValue(1);
  grid->GetPointData()->AddArray(fixed);
  filter->SetInputArrayToProcess(2, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "stays");
  filter->Update();
  TAUTLINE_CHECK_EQUAL(filter->GetStopReason(), static_cast<int>(StopReason::NoFreeVertices));
  TAUTLINE_CHECK_EQUAL(component(meshOf(filter)->GetPointData(), "Displacement", middle), 0.0);
}
