// SPDX-License-Identifier: BSD-3-Clause
// Solve PDE: the sections of volume meshes, by their areas and the values on them.
#include "Registry.h"
#include "VtkMeshes.h"
#include "vtkEllipticSolver.h"
#include "vtkPolygon.h"

#include <array>

using namespace tautline;

namespace
{
constexpr double Tight = 1e-12; // relative tolerance of the solver

/// The cube, moved along x.
MeshData cube(CellType type, Index n, double x = 0)
{
  MeshData data = blockMesh(type, n, n, n);
  for (std::size_t i = 0; i < data.points.size(); i += 3)
  {
    data.points[i] += x;
  }
  return data;
}

/// A linear solution, which the elements have exactly.
double exact(const std::array<double, 3>& p)
{
  return 1 + 2 * p[0] - 3 * p[1] + 5 * p[2];
}

void solve(vtkEllipticSolver* filter, vtkDataObject* mesh, bool sections)
{
  TAUTLINE_SET(filter, SetInputDataObject(mesh), SetSourceValue(0),
    SetGivenType(vtkEllipticAlgorithm::EXPRESSION), SetGivenExpression("1+2*x-3*y+5*z"),
    SetRelativeTolerance(Tight), SetComputeSections(sections), Update());
}

/// Checks the values, and that each polygon is in a plane near the place. @return the area
double areaOf(vtkPolyData* sections, const std::array<double, 3>& place, double tolerance)
{
  double area = 0;
  const char* name = "Solution";
  vtkDataArray* values = sections->GetPointData()->GetArray(name);
  TAUTLINE_CHECK(values && values == sections->GetPointData()->GetScalars());
  TAUTLINE_CHECK(sections->GetCellData()->GetArray("Gradient"));
  for (vtkIdType cell = 0; values && cell < sections->GetNumberOfCells(); ++cell)
  {
    vtkCell* polygon = sections->GetCell(cell);
    std::array<bool, 3> inPlane = { true, true, true };
    for (vtkIdType i = 0; i < polygon->GetNumberOfPoints(); ++i)
    {
      std::array<double, 3> p{};
      polygon->GetPoints()->GetPoint(i, p.data());
      TAUTLINE_CHECK_NEAR(values->GetTuple1(polygon->GetPointId(i)), exact(p), 1e-6);
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        inPlane[axis] = inPlane[axis] && std::abs(p[axis] - place[axis]) <= tolerance;
      }
    }
    TAUTLINE_CHECK(inPlane[0] || inPlane[1] || inPlane[2]);
    vtkNew<vtkIdList> corners;
    for (vtkIdType i = 0; i < polygon->GetNumberOfPoints(); ++i)
    {
      corners->InsertNextId(i);
    }
    double normal[3];
    area += vtkPolygon::ComputeArea(
      polygon->GetPoints(), corners->GetNumberOfIds(), corners->GetPointer(0), normal);
  }
  return area;
}

TAUTLINE_PART(testCube)
{
  // The planes pass through elements (3 layers), or between them (4).
  for (const CellType type :
    { CellType::Tetrahedron, CellType::Hexahedron, CellType::Wedge, CellType::Pyramid })
  {
    for (const Index layers : { 3, 4 })
    {
      const Context context(std::to_string(layers) + " layers of " + topology(type).name);
      vtkNew<vtkEllipticSolver> filter;
      Messages messages(filter);
      const auto mesh = toGrid(cube(type, layers));
      double bounds[6];
      mesh->GetBounds(bounds);
      const std::array<double, 3> size = { bounds[1] - bounds[0], bounds[3] - bounds[2],
        bounds[5] - bounds[4] };
      const std::array<double, 3> center = { (bounds[0] + bounds[1]) / 2,
        (bounds[2] + bounds[3]) / 2, (bounds[4] + bounds[5]) / 2 };
      solve(filter, mesh, true);
      TAUTLINE_CHECK_NEAR(areaOf(filter->GetSections(), center, 1e-6),
        size[0] * size[1] + size[1] * size[2] + size[2] * size[0], 1e-6);
      TAUTLINE_CHECK(messages.empty());
      solve(filter, mesh, false);
      TAUTLINE_CHECK_EQUAL(filter->GetSections()->GetNumberOfCells(), 0);
    }
  }
}

TAUTLINE_PART(testBlocks)
{
  // Two cubes with a gap: the plane normal to x is in the middle of one, the other two are in both.
  vtkNew<vtkMultiBlockDataSet> blocks;
  const auto first = toGrid(cube(CellType::Tetrahedron, 4));
  const double length = first->GetBounds()[1] - first->GetBounds()[0];
  blocks->SetBlock(0, first);
  blocks->SetBlock(1, toGrid(cube(CellType::Tetrahedron, 4, 2 * length)));
  vtkNew<vtkEllipticSolver> filter;
  solve(filter, blocks, true);
  const double middle = length / 2, slab = 3 * length / 64;
  TAUTLINE_CHECK_NEAR(
    areaOf(filter->GetSections(), { middle, middle, middle }, slab), 5 * length * length, 1e-6);

  // A plate with a rib: the plane normal to z is in the plate, at an eighth of the height and not
  // in the middle of the bounds.
  MeshData plate = cube(CellType::Hexahedron, 4);
  const Index height = 4;
  for (std::size_t i = 2; i < plate.points.size(); i += 3)
  {
    plate.points[i] /= height;
  }
  TAUTLINE_NEW(vtkMultiBlockDataSet, parts, SetBlock(0, toGrid(plate)));
  MeshData rib = cube(CellType::Hexahedron, 4);
  for (std::size_t i = 0; i < rib.points.size(); i += 3)
  {
    rib.points[i] = rib.points[i] / height - 0.5 * length; // beside the plate
  }
  parts->SetBlock(1, toGrid(rib));
  solve(filter, parts, true);
  bool inPlate = false;
  for (vtkIdType i = 0; i < filter->GetSections()->GetNumberOfPoints(); ++i)
  {
    const double* p = filter->GetSections()->GetPoint(i);
    inPlate = inPlate || (p[0] > 0.9 * length && std::abs(p[2] - length / 8) < length / 64);
  }
  TAUTLINE_CHECK(inPlate);

  // Nothing is cut on a planar mesh.
  vtkNew<vtkEllipticSolver> planar;
  solve(planar, toGrid(blockMesh(CellType::Triangle, 4, 4, 0)), true);
  TAUTLINE_CHECK_EQUAL(planar->GetSections()->GetNumberOfPoints(), 0);
  TAUTLINE_CHECK(planar->GetConverged());
}
}
