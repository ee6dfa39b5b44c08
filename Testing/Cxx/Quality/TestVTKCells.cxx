// SPDX-License-Identifier: BSD-3-Clause
// The cells VTK itself makes are valid in Tautline: local numbering, orientation and corners of
// every type, linear and of higher order. The wedge is the one to watch: in VTK's linear and
// quadratic wedges the corners 0 1 2 are counter-clockwise seen from outside, in its Lagrange and
// Bezier wedges from inside.
#include "MeshAdapter.h"
#include "Registry.h"
#include "VtkCompatibility.h"
#include "VtkMeshes.h"
#include "vtkCellSizeFilter.h"
#include "vtkCellTypeSource.h"
#include "vtkCellValidator.h"

using namespace tautline;

namespace
{
constexpr int linearTypes[] = { VTK_TRIANGLE, VTK_QUAD, VTK_TETRA, VTK_HEXAHEDRON, VTK_WEDGE,
  VTK_PYRAMID };

/// Higher types of which VTK's cell source makes cells.
constexpr int higherTypes[] = { VTK_QUADRATIC_TRIANGLE, VTK_QUADRATIC_QUAD, VTK_QUADRATIC_TETRA,
  VTK_QUADRATIC_HEXAHEDRON, VTK_QUADRATIC_WEDGE, VTK_QUADRATIC_PYRAMID, VTK_TRIQUADRATIC_PYRAMID,
  VTK_LAGRANGE_TRIANGLE, VTK_LAGRANGE_QUADRILATERAL, VTK_LAGRANGE_TETRAHEDRON,
  VTK_LAGRANGE_HEXAHEDRON, VTK_LAGRANGE_WEDGE, VTK_BEZIER_TRIANGLE, VTK_BEZIER_QUADRILATERAL,
  VTK_BEZIER_TETRAHEDRON, VTK_BEZIER_HEXAHEDRON, VTK_BEZIER_WEDGE };

constexpr int blockSize = 2; ///< unit cubes (squares) in each direction

void testSource(int vtkType, bool higher)
{
  const Context context(cellClassName(vtkType));
  TAUTLINE_NEW(vtkCellTypeSource, source, SetCellType(vtkType),
    SetBlocksDimensions(blockSize, blockSize, blockSize), SetCellOrder(2), Update());
  vtkUnstructuredGrid* grid = source->GetOutput();
  const MeshAdapter adapter(grid);
  const Mesh& mesh = adapter.mesh();
  TAUTLINE_CHECK_EQUAL(grid->GetCellType(0), vtkType);
  TAUTLINE_CHECK_EQUAL(mesh.higherOrderCells(), higher ? grid->GetNumberOfCells() : 0);
  TAUTLINE_CHECK_EQUAL(contains(adapter.notice(), wording("measured-on-their-corners")), higher);
  const std::vector<signed char> validity = validityOf(mesh);
  const auto valid = std::count(validity.begin(), validity.end(), Valid);
  TAUTLINE_CHECK_EQUAL(valid, grid->GetNumberOfCells());
  TAUTLINE_CHECK_EQUAL(mesh.orientation(validity.data()).state, Orientation::Consistent);
  const std::vector<double> sizes = valuesOf(mesh, Metric::Size);
  const bool flat = mesh.dimension() == Dimension::Planar;
  TAUTLINE_CHECK_NEAR(std::accumulate(sizes.begin(), sizes.end(), 0.0),
    std::pow(blockSize, flat ? 2 : 3), 1e-6); // the source works in single precision
  // The surface closes, corner to corner.
  TAUTLINE_CHECK_EQUAL(mesh.boundary().nonManifold, 0);
}

/// VTK's own measures of Tautline's ideal cells.
void testIdealCells(CellType type)
{
  const Context context(topology(type).name);
  const std::vector<Vec3> corners = idealCell(type);
  const auto grid = toGrid(singleCell(type, corners));
  TAUTLINE_NEW(vtkCellSizeFilter, size, SetInputData(grid), Update());
  vtkDataSetAttributes* sizes = vtkDataSet::SafeDownCast(size->GetOutput())->GetCellData();
  TAUTLINE_CHECK_NEAR(component(sizes, topology(type).dimension == 2 ? "Area" : "Volume", 0),
    valueOf(type, corners, Metric::Size), 1e-15);
  TAUTLINE_NEW(vtkCellValidator, validator, SetInputData(grid), Update());
  TAUTLINE_CHECK_EQUAL(component(validator->GetOutput()->GetCellData(), "ValidityState", 0), 0.0);
}
}

TAUTLINE_TEST(TestVTKCells)
{
  for (CellType type : allTypes)
  {
    TAUTLINE_RUN(testIdealCells(type));
  }
  for (int type : linearTypes)
  {
    TAUTLINE_RUN(testSource(type, false));
  }
  for (int type : higherTypes)
  {
    TAUTLINE_RUN(testSource(type, true));
  }
}
