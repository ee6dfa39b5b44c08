// SPDX-License-Identifier: BSD-3-Clause
// Element Quality on curved cells: their validity and smallest determinant hold for the whole cell,
// though the corners are those of a valid one.
#include "Elements/CurvedElements.h"
#include "Registry.h"
#include "VtkMeshes.h"

#include "tautline/Mesh/CurvedCells.h"

#include "vtkCellTypeSource.h"
#include "vtkElementQuality.h"

#include <map>

using namespace tautline;

namespace
{
/// Cells of one type, each with points of its own.
vtkSmartPointer<vtkUnstructuredGrid> gridOf(
  int vtkType, const std::vector<std::vector<Vec3>>& elements)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  grid->Allocate();
  for (const std::vector<Vec3>& element : elements)
  {
    vtkNew<vtkIdList> ids;
    for (const Vec3& p : element)
    {
      ids->InsertNextId(points->InsertNextPoint(p.data()));
    }
    grid->InsertNextCell(vtkType, ids);
  }
  grid->SetPoints(points);
  return grid;
}

struct Measured
{
  std::vector<double> validity, minimum;
  std::string notice;
};

Measured measure(vtkUnstructuredGrid* grid, bool minimum = true)
{
  TAUTLINE_NEW(vtkElementQuality, filter, SetInputData(grid),
    AddMetricByName(minimum ? "min_jacobian" : "imr"), Update());
  vtkCellData* arrays = vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0))->GetCellData();
  Measured result;
  result.notice = filter->GetNotice();
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c)
  {
    result.validity.push_back(arrays->GetArray("Validity")->GetTuple1(c));
    if (minimum)
    {
      result.minimum.push_back(arrays->GetArray("min_jacobian")->GetTuple1(c));
    }
  }
  return result;
}
}

/// The middle node of a slanted edge at (c, c): the smallest determinant is 4 c - 1.
TAUTLINE_PART(testFoldedTetrahedron)
{
  std::vector<std::vector<Vec3>> elements;
  const std::vector<double> places = { 0.5, 0.3, 0.25, 0.2, 0.1 };
  for (double c : places)
  {
    elements.push_back(straightElement(ElementType::ofVtk(VTK_QUADRATIC_TETRA, 10)));
    elements.back()[5] = { c, c, 0 };
  }
  const auto grid = gridOf(VTK_QUADRATIC_TETRA, elements);
  const Measured measured = measure(grid);
  const std::vector<double> expected = { Valid, Valid, Degenerate, Inverted, Inverted };
  for (std::size_t e = 0; e < places.size(); ++e)
  {
    TAUTLINE_CHECK_EQUAL(measured.validity[e], expected[e]);
    TAUTLINE_CHECK_NEAR(measured.minimum[e], 4 * places[e] - 1, 1e-7);
  }
  TAUTLINE_CHECK(contains(measured.notice, "5 curved cells hold for the whole cell"));
  // The same verdict without the metric.
  TAUTLINE_CHECK(measure(grid, false).validity == expected);
}

/// The same of a mesh that is its own mirror image: it is measured as if it were not.
TAUTLINE_PART(testMirroredMesh)
{
  std::vector<std::vector<Vec3>> elements;
  for (double c : { 0.5, 0.4, 0.2 })
  {
    elements.push_back(straightElement(ElementType::ofVtk(VTK_QUADRATIC_TETRA, 10)));
    elements.back()[5] = { c, c, 0 };
    for (Vec3& p : elements.back())
    {
      p[2] = -p[2];
    }
  }
  const Measured measured = measure(gridOf(VTK_QUADRATIC_TETRA, elements));
  const std::vector<double> expected = { Valid, Valid, Inverted };
  TAUTLINE_CHECK(measured.validity == expected);
  TAUTLINE_CHECK_NEAR(measured.minimum[2], -0.2, 1e-7);
}

/// A triangle on a slope: its plane is found.
TAUTLINE_PART(testFoldedTriangle)
{
  std::vector<std::vector<Vec3>> elements;
  for (double c : { 0.5, 0.2 })
  {
    elements.push_back(straightElement(ElementType::ofVtk(VTK_QUADRATIC_TRIANGLE, 6)));
    elements.back()[4] = { c, c, 0 };
    for (Vec3& p : elements.back())
    {
      p = { p[0], 0.6 * p[1], 0.8 * p[1] };
    }
  }
  const Measured measured = measure(gridOf(VTK_QUADRATIC_TRIANGLE, elements));
  const std::vector<double> expected = { Valid, Inverted };
  TAUTLINE_CHECK(measured.validity == expected);
  TAUTLINE_CHECK_NEAR(measured.minimum[0], 1.0, 1e-7);
  TAUTLINE_CHECK_NEAR(measured.minimum[1], -0.2, 1e-7);
}

/// The meshes that VTK itself makes, in both orders of wedges: each cell is valid.
TAUTLINE_PART(testCellsOfVtk)
{
  for (int vtkType :
    { VTK_QUADRATIC_TRIANGLE, VTK_QUADRATIC_QUAD, VTK_QUADRATIC_TETRA, VTK_QUADRATIC_HEXAHEDRON,
      VTK_QUADRATIC_WEDGE, VTK_QUADRATIC_PYRAMID, VTK_TRIQUADRATIC_PYRAMID, VTK_LAGRANGE_TRIANGLE,
      VTK_LAGRANGE_QUADRILATERAL, VTK_LAGRANGE_TETRAHEDRON, VTK_LAGRANGE_HEXAHEDRON,
      VTK_LAGRANGE_WEDGE, VTK_BEZIER_TRIANGLE, VTK_BEZIER_QUADRILATERAL, VTK_BEZIER_TETRAHEDRON,
      VTK_BEZIER_HEXAHEDRON, VTK_BEZIER_WEDGE })
  {
    const Context context("VTK type " + std::to_string(vtkType));
    TAUTLINE_NEW(vtkCellTypeSource, source, SetCellType(vtkType), SetBlocksDimensions(2, 2, 2),
      SetCellOrder(2), Update());
    const Measured measured = measure(source->GetOutput());
    TAUTLINE_EACH_OF(double v, measured.validity, TAUTLINE_CHECK_EQUAL(v, double(Valid)));
    TAUTLINE_EACH_OF(double m, measured.minimum, TAUTLINE_CHECK(m > 0));
  }
}

/// A folded wedge between valid ones of its type, and one cell of a mesh listed in the opposite
/// order.
TAUTLINE_PART(testWedgesAndReversedCells)
{
  const std::pair<int, int> wedges[] = { { VTK_BIQUADRATIC_QUADRATIC_WEDGE, 18 },
    { VTK_LAGRANGE_WEDGE, 18 }, { VTK_QUADRATIC_WEDGE, 15 }, { VTK_BEZIER_WEDGE, 18 } };
  for (const auto& [vtkType, nodes] : wedges)
  {
    const Context context("VTK type " + std::to_string(vtkType));
    const ElementType& type = ElementType::ofVtk(vtkType, nodes);
    for (double side : { 1.0, -1.0 })
    {
      std::vector<std::vector<Vec3>> elements(3, straightElement(type));
      elements[1][6] = { 0.9, 0, 0 }; // the middle of an edge
      for (std::vector<Vec3>& element : elements)
      {
        for (Vec3& p : element)
        {
          p[2] *= side;
        }
      }
      const Measured measured = measure(gridOf(vtkType, elements));
      const bool folds = vtkType != VTK_BEZIER_WEDGE; // there, it is a control point
      const std::vector<double> expected = { Valid, folds ? double(Inverted) : double(Valid),
        Valid };
      TAUTLINE_CHECK(measured.validity == expected);
      TAUTLINE_CHECK_NEAR(measured.minimum[0], 1.0, 1e-7);
    }
  }
  // Of two tetrahedra that share a face, the second is listed in the opposite order.
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  const Vec3 corners[] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 0, 0, -1 } };
  const vtkIdType cells[2][4] = { { 0, 1, 2, 3 }, { 0, 1, 2, 4 } };
  std::map<std::pair<vtkIdType, vtkIdType>, vtkIdType> middles;
  for (const Vec3& p : corners)
  {
    points->InsertNextPoint(p.data());
  }
  for (const auto& cell : cells)
  {
    vtkNew<vtkIdList> ids;
    for (vtkIdType id : cell)
    {
      ids->InsertNextId(id);
    }
    constexpr int edges[6][2] = { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 0, 3 }, { 1, 3 }, { 2, 3 } };
    for (const auto& e : edges)
    {
      const auto key = std::minmax(cell[e[0]], cell[e[1]]);
      const auto [found, fresh] = middles.emplace(key, points->GetNumberOfPoints());
      if (fresh)
      {
        const Vec3 middle = 0.5 * (corners[key.first] + corners[key.second]);
        points->InsertNextPoint(middle.data());
      }
      ids->InsertNextId(found->second);
    }
    grid->InsertNextCell(VTK_QUADRATIC_TETRA, ids);
  }
  grid->SetPoints(points);
  const Measured measured = measure(grid);
  const std::vector<double> expected = { Valid, Valid };
  TAUTLINE_CHECK(measured.validity == expected);
  TAUTLINE_CHECK_NEAR(measured.minimum[0], 1.0, 1e-7);
  TAUTLINE_CHECK_NEAR(measured.minimum[1], 1.0, 1e-7);
}

/// What is not supported keeps the verdict of its corners.
TAUTLINE_PART(testUnsupported)
{
  MeshData data;
  data.addPoints({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } });
  data.addPoints(std::vector<Vec3>(4, Vec3{ 0.4, 0.3, 0 }));
  data.types = { VTK_BEZIER_TRIANGLE }; // of 7 nodes
  data.offsets = { 0, 7 };
  data.connectivity = { 0, 1, 2, 3, 4, 5, 6 };
  const Mesh mesh(data.view());
  signed char validity = Valid;
  TAUTLINE_CHECK_EQUAL(certifyCurvedCells(mesh, {}, &validity, nullptr), 0);
  TAUTLINE_CHECK_EQUAL(int(validity), int(Valid));
}
