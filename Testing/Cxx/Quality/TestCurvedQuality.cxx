// SPDX-License-Identifier: BSD-3-Clause
// Element Quality on curved cells: their validity and smallest determinant hold for the whole cell,
// though the corners form a valid one.
#include "Elements/CurvedElements.h"
#include "Registry.h"
#include "VtkMeshes.h"

#include "tautline/Mesh/CurvedCells.h"
#include "tautline/Quality/CurvedQuality.h"

#include "vtkCellTypeSource.h"
#include "vtkElementQuality.h"
#include "vtkTable.h"

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

/// The values of some metrics and the statistics.
struct AllMeasured
{
  vtkSmartPointer<vtkDataSet> mesh;
  vtkSmartPointer<vtkTable> statistics;
  std::string notice, summary;

  double value(const char* array, vtkIdType cell, int component = 0) const
  {
    return this->mesh->GetCellData()->GetArray(array)->GetComponent(cell, component);
  }
  double fact(const char* column) const
  {
    return this->statistics->GetValueByName(0, column).ToDouble();
  }
};

AllMeasured measureAll(vtkDataSet* grid, const std::vector<const char*>& metrics,
  int combination = vtkElementQuality::MEAN)
{
  vtkNew<vtkElementQuality> filter;
  filter->SetInputData(grid);
  filter->SetCombination(combination);
  for (const char* metric : metrics)
  {
    filter->AddMetricByName(metric);
  }
  filter->Update();
  AllMeasured all;
  all.mesh = vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  all.statistics = filter->GetStatistics();
  all.notice = filter->GetNotice();
  all.summary = filter->GetSummary();
  return all;
}

/// A quadrilateral with x = u + u^2 and y = v: x_u = 1 + 2 u.
vtkSmartPointer<vtkUnstructuredGrid> stretchedQuadrilateral()
{
  std::vector<Vec3> points = ElementType::ofVtk(VTK_BIQUADRATIC_QUAD, 9).coordinates();
  for (Vec3& p : points)
  {
    p[0] += p[0] * p[0];
  }
  return gridOf(VTK_BIQUADRATIC_QUAD, { points });
}

constexpr int combinations[] = { vtkElementQuality::MEAN, vtkElementQuality::WORST,
  vtkElementQuality::POWER_MEAN };
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
  // The second of two tetrahedra that share a face is listed in the opposite order.
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

/// Unsupported cells keep the verdict of their corners.
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

/// Cells with straight edges have the metrics of linear cells: of T, which is the same everywhere.
TAUTLINE_PART(testStraightCells)
{
  struct Pair
  {
    int curved, nodes, linear, corners;
  };
  for (const Pair& pair :
    { Pair{ VTK_QUADRATIC_TRIANGLE, 6, VTK_TRIANGLE, 3 },
      Pair{ VTK_BIQUADRATIC_QUAD, 9, VTK_QUAD, 4 }, Pair{ VTK_QUADRATIC_TETRA, 10, VTK_TETRA, 4 },
      Pair{ VTK_QUADRATIC_HEXAHEDRON, 20, VTK_HEXAHEDRON, 8 },
      Pair{ VTK_TRIQUADRATIC_HEXAHEDRON, 27, VTK_HEXAHEDRON, 8 },
      Pair{ VTK_LAGRANGE_TETRAHEDRON, 20, VTK_TETRA, 4 } })
  {
    const Context context("VTK type " + std::to_string(pair.curved));
    std::vector<Vec3> points = straightElement(ElementType::ofVtk(pair.curved, pair.nodes));
    for (Vec3& p : points)
    {
      // An affine map, in the plane z = 0 for flat cells.
      p = { 1.3 * p[0] + 0.4 * p[1] + 0.2 * p[2], 0.1 * p[0] + 0.9 * p[1] - 0.3 * p[2],
        1.7 * p[2] };
    }
    const auto curved = gridOf(pair.curved, { points });
    points.resize(pair.corners);
    const auto linear = gridOf(pair.linear, { points });
    std::vector<const char*> metrics;
    for (const MetricInfo& info : elementMetrics())
    {
      const bool here = topology(cornerType(static_cast<unsigned char>(pair.linear))).dimension == 2
        ? info.in2D
        : info.in3D;
      const bool wholly = (info.family == MetricFamily::Target && !info.user) ||
        info.metric == Metric::Size || info.metric == Metric::ScaledJacobian ||
        info.metric == Metric::MinimumJacobian;
      if (here && wholly)
      {
        metrics.push_back(info.name);
      }
    }
    for (int combination : combinations)
    {
      const AllMeasured a = measureAll(curved, metrics, combination);
      const AllMeasured b = measureAll(linear, metrics, combination);
      for (const char* metric : metrics)
      {
        const Context name(metric);
        TAUTLINE_CHECK_NEAR(a.value(metric, 0), b.value(metric, 0),
          1e-6 * std::max(1.0, std::abs(b.value(metric, 0))));
      }
    }
  }
}

/// The mean by quadrature, the certified worst value, and which side of it the reciprocal has.
TAUTLINE_PART(testCombinations)
{
  const auto grid = stretchedQuadrilateral();
  const std::vector<const char*> metrics = { "mean_ratio", "imr", "condition_number",
    "scaled_jacobian", "size", "mu_shape" };
  const AllMeasured mean = measureAll(grid, metrics);
  // The mean of 2 x / (x^2 + 1) over x from 1 to 3, and of its reciprocal.
  TAUTLINE_CHECK_NEAR(mean.value("mean_ratio", 0), 0.5 * std::log(5.0), 1e-5);
  TAUTLINE_CHECK_NEAR(mean.value("imr", 0), 1 + std::log(3.0) / 4, 2e-5);
  TAUTLINE_CHECK_NEAR(mean.value("mu_shape", 0), std::log(3.0) / 4, 2e-5);
  TAUTLINE_CHECK_NEAR(mean.value("scaled_jacobian", 0), 1.0, 2e-3);
  TAUTLINE_CHECK_NEAR(mean.value("size", 0), 2.0, 1e-12);
  const AllMeasured worst = measureAll(grid, metrics, vtkElementQuality::WORST);
  TAUTLINE_CHECK_NEAR(worst.value("mean_ratio", 0), 0.6, 1e-9);
  TAUTLINE_CHECK_NEAR(worst.value("imr", 0), 1 / 0.6, 1e-8);
  TAUTLINE_CHECK_NEAR(worst.value("condition_number", 0), 1 / 0.6, 1e-8);
  // The minimum of the samples, which are inside.
  TAUTLINE_CHECK(worst.value("mu_shape", 0) < 1 / 0.6 - 1 && worst.value("mu_shape", 0) > 0.5);
  const AllMeasured power = measureAll(grid, metrics, vtkElementQuality::POWER_MEAN);
  TAUTLINE_CHECK(power.value("imr", 0) > mean.value("imr", 0));
  TAUTLINE_CHECK(power.value("imr", 0) < worst.value("imr", 0));
  TAUTLINE_CHECK(power.value("mean_ratio", 0) < mean.value("mean_ratio", 0));
}

/// A folded cell has negative metrics, though no sample is in the fold; the area is the curved
/// cell's, the place of the minimum is on the folded edge.
TAUTLINE_PART(testFoldOfNoSample)
{
  const double c = 0.2499;
  std::vector<Vec3> points = straightElement(ElementType::ofVtk(VTK_QUADRATIC_TRIANGLE, 6));
  points[4] = { c, c, 0 };
  const auto grid = gridOf(VTK_QUADRATIC_TRIANGLE, { points });
  for (int combination : combinations)
  {
    const AllMeasured all = measureAll(grid,
      { "imr", "mean_ratio", "condition_number", "scaled_jacobian", "mu_shape_nb", "size" },
      combination);
    for (const char* metric : { "imr", "mean_ratio", "condition_number", "scaled_jacobian" })
    {
      TAUTLINE_CHECK(all.value(metric, 0) < 0);
    }
    TAUTLINE_CHECK(all.value("mu_shape_nb", 0) > 0);
    // Less two thirds of the height of the parabola over the edge.
    TAUTLINE_CHECK_NEAR(all.value("size", 0), 0.5 + 4.0 / 3 * (c - 0.5), 1e-12);
    TAUTLINE_CHECK_EQUAL(all.fact("Curved"), 1);
    TAUTLINE_CHECK_EQUAL(all.fact("MissedAtCorners"), 0);
    TAUTLINE_CHECK_EQUAL(all.fact("MissedAtIntegrationPoints"), 1);
    const double u = all.value("MinimumCoordinates", 0), v = all.value("MinimumCoordinates", 0, 1);
    TAUTLINE_CHECK_NEAR(u + v, 1, 1e-12);
    // At a corner, where the parabola begins.
    const Vec3 at = pointAt(ElementType::ofVtk(VTK_QUADRATIC_TRIANGLE, 6), points, { u, v, 0 });
    for (int k = 0; k < 3; ++k)
    {
      TAUTLINE_CHECK_NEAR(all.value("MinimumPoint", 0, k), at[k], 1e-12);
    }
  }
}

/// Reversed cells, wedges of both orders and mirrored meshes have the metrics of valid ones.
TAUTLINE_PART(testSigns)
{
  for (const auto& [vtkType, nodes] : { std::pair<int, int>(VTK_BIQUADRATIC_QUADRATIC_WEDGE, 18),
         { VTK_LAGRANGE_WEDGE, 18 }, { VTK_QUADRATIC_TETRA, 10 }, { VTK_QUADRATIC_PYRAMID, 13 } })
  {
    const Context context("VTK type " + std::to_string(vtkType));
    std::map<std::string, double> before;
    for (double side : { 1.0, -1.0 })
    {
      SplitMix random(7, 2, nodes);
      std::vector<Vec3> points = randomElement(ElementType::ofVtk(vtkType, nodes), 0.03, random);
      for (Vec3& p : points)
      {
        p[2] *= side;
      }
      const std::vector<const char*> metrics = { "imr", "condition_number", "mu_shape", "size",
        "mu_shape_size" };
      for (int combination : combinations)
      {
        const AllMeasured all = measureAll(gridOf(vtkType, { points }), metrics, combination);
        for (const char* metric : metrics)
        {
          const std::string key = metric + std::to_string(combination);
          TAUTLINE_CHECK(all.value(metric, 0) > 0);
          TAUTLINE_CHECK(side > 0 || std::abs(before[key] - all.value(metric, 0)) < 1e-9);
          before[key] = all.value(metric, 0);
        }
      }
    }
  }
}

/// Metrics that are left at the corners, and other targets.
TAUTLINE_PART(testMeasuredAtCorners)
{
  const auto grid = stretchedQuadrilateral();
  const AllMeasured all = measureAll(grid, { "edge_ratio", "imr" });
  TAUTLINE_CHECK_NEAR(all.value("edge_ratio", 0), 2.0, 1e-12);
  TAUTLINE_CHECK(contains(all.notice, "imr"));
  TAUTLINE_CHECK(contains(all.notice, "edge_ratio"));
  const Mesh mesh(MeshData().view());
  const CurvedQuality none(mesh, {});
  TAUTLINE_CHECK(!none.measures(Metric::MeanRatio, {}));
}

/// Known numbers of the mesh of MFEM: 4 integration points find 109 of 219 invalid cells.
TAUTLINE_PART(testCubeHoles)
{
  const auto elements =
    elementsOf(readMfem(externalData("curved") + "/cube-holes-inv.mesh", false), FileTetrahedron10);
  const auto grid = gridOf(VTK_QUADRATIC_TETRA, elements);
  const AllMeasured all = measureAll(
    grid, { "mean_ratio", "imr", "condition_number", "scaled_jacobian" }, vtkElementQuality::WORST);
  double sums[3] = {};
  const vtkIdType cells = all.mesh->GetNumberOfCells();
  for (vtkIdType cell = 0; cell < cells; ++cell)
  {
    const bool valid = all.value("Validity", cell) == double(Valid);
    for (const char* metric : { "mean_ratio", "imr", "condition_number", "scaled_jacobian" })
    {
      TAUTLINE_CHECK_EQUAL(all.value(metric, cell) > 0, valid);
    }
    sums[0] += valid ? all.value("mean_ratio", cell) : 0;
    sums[1] += valid ? 1 / all.value("condition_number", cell) : 0;
    sums[2] += valid ? all.value("scaled_jacobian", cell) : 0;
  }
  TAUTLINE_CHECK_NEAR(sums[0] / static_cast<double>(cells), 0.65723, 1e-5);
  TAUTLINE_CHECK_NEAR(sums[1] / static_cast<double>(cells), 0.63933, 1e-5);
  TAUTLINE_CHECK_NEAR(sums[2] / static_cast<double>(cells), 0.43193, 1e-5);
  TAUTLINE_CHECK_EQUAL(all.fact("Inverted") + all.fact("Degenerate"), 219);
  TAUTLINE_CHECK_EQUAL(all.fact("MissedAtIntegrationPoints"), 219 - 109);
  TAUTLINE_CHECK_EQUAL(all.fact("MissedAtCorners"), 0);
}
