// SPDX-License-Identifier: BSD-3-Clause
// Checks of solvers on curved and linear elements: known values of moved middle nodes and of
// determinants at few places.
#include "Elements/CurvedElements.h"
#include "Registry.h"
#include "VtkMeshes.h"

#include "tautline/Quality/ElementChecks.h"

#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkElementQuality.h"

#include <map>

using namespace tautline;

namespace
{
using Values = std::map<std::string, double>;

/// All checks of one cell.
Values checksOf(int vtkType, const std::vector<Vec3>& points)
{
  MeshData data;
  data.addPoints(points);
  data.types = { static_cast<unsigned char>(vtkType) };
  data.offsets = { 0, static_cast<Index>(points.size()) };
  data.connectivity.resize(points.size());
  std::iota(data.connectivity.begin(), data.connectivity.end(), Index(0));
  const Mesh mesh(data.view());
  Values values;
  for (std::size_t check = 0; check < elementChecks().size(); ++check)
  {
    double value = -1;
    evaluateElementCheck(mesh, {}, static_cast<int>(check), &value, 1);
    values[elementChecks()[check].name] = value;
  }
  return values;
}

std::vector<Vec3> straight(int vtkType, int nodes)
{
  return straightElement(ElementType::ofVtk(vtkType, nodes));
}

/// A quadratic tetrahedron whose edge 1 2 has its middle node at (c, c).
std::vector<Vec3> slanted(double c)
{
  std::vector<Vec3> points = straight(VTK_QUADRATIC_TETRA, 10);
  points[5] = { c, c, 0 };
  return points;
}
}

/// Straight elements, and linear ones, have the ideal values.
TAUTLINE_PART(testIdealValues)
{
  for (const auto& [vtkType, nodes] :
    { std::pair<int, int>(VTK_QUADRATIC_TRIANGLE, 6), { VTK_BIQUADRATIC_QUAD, 9 },
      { VTK_QUADRATIC_QUAD, 8 }, { VTK_QUADRATIC_TETRA, 10 }, { VTK_QUADRATIC_HEXAHEDRON, 20 },
      { VTK_TRIQUADRATIC_HEXAHEDRON, 27 }, { VTK_QUADRATIC_WEDGE, 15 },
      { VTK_QUADRATIC_PYRAMID, 13 }, { VTK_TETRA, 4 }, { VTK_HEXAHEDRON, 8 }, { VTK_WEDGE, 6 },
      { VTK_TRIANGLE, 3 }, { VTK_LAGRANGE_TETRAHEDRON, 20 } })
  {
    const Context context("VTK type " + std::to_string(vtkType));
    const Values values = checksOf(vtkType, straight(vtkType, nodes));
    for (const ElementCheckInfo& info : elementChecks())
    {
      const Context name(info.name);
      TAUTLINE_CHECK(*info.label && *info.formula && *info.source);
      const double expected =
        info.name == std::string("calculix_jacobian") ? 1 : info.ideal; // det of the reference
      TAUTLINE_CHECK_NEAR(values.at(info.name), expected, 1e-9);
    }
  }
}

/// det = 1 + 4 (c - 1/2)(u + v): the places of each check.
TAUTLINE_PART(testDeterminants)
{
  for (double c : { 0.4, 0.3, 0.26, 0.2 })
  {
    const Values values = checksOf(VTK_QUADRATIC_TETRA, slanted(c));
    const auto det = [c](double sum) { return 1 + 4 * (c - 0.5) * sum; };
    const double least = det(1); // and 1 where u + v vanishes
    TAUTLINE_CHECK_NEAR(values.at("jacobian_ratio"), least, 1e-6);
    TAUTLINE_CHECK_NEAR(values.at("jacobian_corners"), least, 1e-12);
    TAUTLINE_CHECK_NEAR(values.at("jacobian_nodes"), least, 1e-12);
    // The 4 points have u and v of b and a, or a twice.
    const double a = 0.13819660112501051518, b = 1 - 3 * a;
    TAUTLINE_CHECK_NEAR(values.at("jacobian_integration"), det(a + b) / det(2 * a), 1e-12);
    TAUTLINE_CHECK_NEAR(values.at("calculix_jacobian"), det(a + b), 1e-12);
    TAUTLINE_CHECK_NEAR(values.at("distortion"), det(a + b) / det(0.5), 1e-12);
    TAUTLINE_CHECK_NEAR(values.at("ansys_jacobian_ratio"), least > 0 ? 1 / least : -100, 1e-9);
    TAUTLINE_CHECK(values.at("jacobian_high_order") > least);
    TAUTLINE_CHECK(values.at("jacobian_high_order") < values.at("jacobian_integration"));
  }
  // Folded, but not for the integration points.
  TAUTLINE_CHECK(checksOf(VTK_QUADRATIC_TETRA, slanted(0.24)).at("calculix_jacobian") > 0);
}

/// An element that is inverted everywhere, and a hexahedron folded in part.
TAUTLINE_PART(testInverted)
{
  std::vector<Vec3> points = straight(VTK_QUADRATIC_TETRA, 10);
  for (Vec3& p : points)
  {
    p[2] = -p[2];
  }
  const Values inverted = checksOf(VTK_QUADRATIC_TETRA, points);
  TAUTLINE_CHECK_NEAR(inverted.at("jacobian_ratio"), -1, 1e-9);
  TAUTLINE_CHECK_NEAR(inverted.at("jacobian_integration"), -1, 1e-9);
  TAUTLINE_CHECK_NEAR(inverted.at("distortion"), -1, 1e-9);
  TAUTLINE_CHECK_NEAR(inverted.at("ansys_jacobian_ratio"), 1, 1e-9); // the signs are equal
}

/// The middle node of the edge from (0, 0) to (1, 0) at (s, h).
TAUTLINE_PART(testMiddleNodes)
{
  for (const auto& [vtkType, nodes] :
    { std::pair<int, int>(VTK_QUADRATIC_TRIANGLE, 6), { VTK_QUADRATIC_QUAD, 8 },
      { VTK_BIQUADRATIC_QUAD, 9 }, { VTK_LAGRANGE_QUADRILATERAL, 9 } })
  {
    const double s = 0.4, h = 0.1;
    std::vector<Vec3> points = straight(vtkType, nodes);
    points[vtkType == VTK_QUADRATIC_TRIANGLE ? 3 : 4] = { s, h, 0 };
    const Values values = checksOf(vtkType, points);
    const double first = std::hypot(s, h), second = std::hypot(1 - s, h);
    TAUTLINE_CHECK_NEAR(values.at("midnode_tangent_offset"), 0.1, 1e-12);
    TAUTLINE_CHECK_NEAR(values.at("midnode_normal_offset"), h, 1e-12);
    TAUTLINE_CHECK_NEAR(
      values.at("midnode_angle"), (std::atan2(h, s) + std::atan2(h, 1 - s)) * 180 / Pi, 1e-9);
    TAUTLINE_CHECK_NEAR(values.at("midnode_ratio"), first / second, 1e-12);
    TAUTLINE_CHECK_NEAR(values.at("midnode_chord"), first + second, 1e-12);
  }
}

TAUTLINE_PART(testNames)
{
  TAUTLINE_CHECK(parseElementChecks("").empty());
  TAUTLINE_CHECK(
    parseElementChecks(" distortion , jacobian_ratio,distortion") == (std::vector<int>{ 7, 0 }));
  TAUTLINE_CHECK_EQUAL(parseElementChecks("all").size(), elementChecks().size());
  TAUTLINE_CHECK_THROWS(
    parseElementChecks("distortion,jacobi"), wording("there-is-no-check-jacobi"));
}

/// The filter has the checks as cell arrays, and their ranges in the summary.
TAUTLINE_PART(testFilter)
{
  MeshData data;
  data.addPoints(slanted(0.3));
  data.types = { VTK_QUADRATIC_TETRA };
  data.offsets = { 0, 10 };
  data.connectivity = { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9 };
  TAUTLINE_NEW(vtkElementQuality, filter, SetInputData(toGrid(data)), AddMetricByName("imr"),
    SetChecks("midnode_angle,jacobian_ratio"), Update());
  auto* mesh = vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  TAUTLINE_CHECK_NEAR(mesh->GetCellData()->GetArray("jacobian_ratio")->GetTuple1(0), 0.2, 1e-6);
  TAUTLINE_CHECK(mesh->GetCellData()->GetArray("midnode_angle")->GetTuple1(0) > 30);
  TAUTLINE_CHECK(!mesh->GetCellData()->GetArray("distortion"));
  TAUTLINE_CHECK(contains(filter->GetSummary(), elementChecks()[0].label));
  // A preset also measures its checks: the bend of 2 atan(0.8 / 2) has a warning.
  TAUTLINE_SET(*filter, SetChecks(""), SetCriteria("nastran_solids"), Update());
  mesh = vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  TAUTLINE_CHECK(mesh->GetCellData()->GetArray("midnode_angle"));
  TAUTLINE_CHECK_EQUAL(mesh->GetCellData()->GetArray("Grade")->GetTuple1(0), 1);
  TAUTLINE_CHECK_EQUAL(vtkElementQuality::GetNumberOfKnownChecks(), 13);
  TAUTLINE_CHECK(vtkElementQuality::GetKnownCheck(13).empty());
}
