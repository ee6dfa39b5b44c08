// SPDX-License-Identifier: BSD-3-Clause
// The comparison of two meshes: what is better, worse and equal, in numbers known beforehand.
#include "Registry.h"
#include "VtkMeshes.h"
#include "vtkMeshComparison.h"
#include "vtkMeshPerturbation.h"

using namespace tautline;

namespace
{
/// Four separate triangles with the base from (0, 0) to (1, 0), given their apexes.
MeshData triangles(const std::vector<Vec3>& apexes)
{
  MeshData data;
  for (const Vec3& apex : apexes)
  {
    data.addCell(CellType::Triangle, std::vector<Vec3>{ { 0, 0, 0 }, { 1, 0, 0 }, apex });
  }
  return data;
}

const double height = std::sqrt(3.0) / 2;
const Vec3 ideal = { 0.5, height, 0 }, flat = { 0.5, 0.3, 0 }, inverted = { 0.5, -0.3, 0 },
           tall = { 0.5, 2, 0 };

vtkTable* tableOf(vtkMeshComparison* filter)
{
  return vtkTable::SafeDownCast(filter->GetOutputDataObject(1));
}

double cellOf(vtkMeshComparison* filter, const char* column, vtkIdType row = 0)
{
  return tableOf(filter)->GetValueByName(row, column).ToDouble();
}

vtkCellData* cellsOf(vtkMeshComparison* filter)
{
  return outputOf(filter)->GetCellData();
}

TAUTLINE_PART(testKnownChanges)
{
  const MeshData before = triangles({ flat, ideal, inverted, ideal, flat, inverted });
  const MeshData after = triangles({ ideal, flat, flat, ideal, inverted, inverted });
  TAUTLINE_NEW(
    vtkMeshComparison, filter, SetInputData(0, toGrid(before)), SetInputData(1, toGrid(after)));
  for (const char* name : { "imr", "mean_ratio", "size", "untangle_beta" })
  {
    filter->AddMetricByName(name);
  }
  filter->Update();
  const double expected[] = { 1, -1, 1, 0, -1, 0 };
  vtkCellData* cells = cellsOf(filter);
  const auto was = valuesOf(before, Metric::InverseMeanRatio);
  const auto is = valuesOf(after, Metric::InverseMeanRatio);
  for (Index i = 0; i < before.numberOfCells(); ++i)
  {
    TAUTLINE_CHECK_EQUAL(component(cells, "Change", i), expected[i]);
    TAUTLINE_CHECK_EQUAL(component(cells, "imr_before", i), was[i]);
    TAUTLINE_CHECK_EQUAL(component(cells, "imr_after", i), is[i]);
    TAUTLINE_CHECK_EQUAL(component(cells, "imr_difference", i), is[i] - was[i]);
    TAUTLINE_CHECK_EQUAL(component(cells, "Validity_before", i), i == 2 || i == 5 ? -1 : 1);
    TAUTLINE_CHECK_EQUAL(component(cells, "Validity_after", i), i >= 4 ? -1 : 1);
  }
  // Neutral: only validity makes the size better or worse. Untangling: all valid ones are equal.
  const double counts[4][3] = { { 2, 2, 2 }, { 2, 2, 2 }, { 1, 1, 4 }, { 1, 1, 4 } };
  for (int row = 0; row < 4; ++row)
  {
    const Context context(tableOf(filter)->GetValueByName(row, "Metric").ToString());
    TAUTLINE_CHECK_EQUAL(cellOf(filter, "Better", row), counts[row][0]);
    TAUTLINE_CHECK_EQUAL(cellOf(filter, "Worse", row), counts[row][1]);
    TAUTLINE_CHECK_EQUAL(cellOf(filter, "Equal", row), counts[row][2]);
    TAUTLINE_CHECK_EQUAL(cellOf(filter, "InvertedBefore", row), 2);
    TAUTLINE_CHECK_EQUAL(cellOf(filter, "InvertedAfter", row), 2);
    TAUTLINE_CHECK_NEAR(cellOf(filter, "LargestDisplacement", row), 0.6, 1e-15);
  }
  TAUTLINE_CHECK_EQUAL(tableOf(filter)->GetValueByName(0, "Metric").ToString(), "imr");
  // Inverted elements count.
  const auto meanOf = [](const auto& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  };
  TAUTLINE_CHECK_EQUAL(cellOf(filter, "MinimumBefore"), *std::min_element(was.begin(), was.end()));
  TAUTLINE_CHECK(cellOf(filter, "MinimumBefore") < 0);
  TAUTLINE_CHECK_EQUAL(cellOf(filter, "MaximumBefore"), was[0]);
  TAUTLINE_CHECK_NEAR(cellOf(filter, "MeanBefore"), meanOf(was), 1e-15);
  TAUTLINE_CHECK_NEAR(cellOf(filter, "MaximumAfter"), was[0], 1e-15);
  TAUTLINE_CHECK_NEAR(cellOf(filter, "MeanAfter"), meanOf(is), 1e-15);
  TAUTLINE_CHECK_NEAR(cellOf(filter, "MaximumBefore", 3), 0.15, 1e-15);
  vtkPointData* points = outputOf(filter)->GetPointData();
  TAUTLINE_CHECK_EQUAL(component(points, "Displacement", 8, 1), 0.6);
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("2-better-2-worse-2-equal")));
}

TAUTLINE_PART(testSeveralMetrics)
{
  // Larger by size-dependent metrics but a worse shape: neither better nor worse on the whole.
  TAUTLINE_NEW(vtkMeshComparison, filter, SetInputData(0, toGrid(triangles({ flat, flat }))),
    SetInputData(1, toGrid(triangles({ { 0.9, 0.3, 0 }, ideal }))), AddMetricByName("imr"),
    AddMetricByName("edge_ratio"), Update());
  TAUTLINE_CHECK(component(cellsOf(filter), "edge_ratio_difference", 0) > 0);
  TAUTLINE_CHECK_EQUAL(component(cellsOf(filter), "Change", 0), -1);
  TAUTLINE_CHECK_EQUAL(component(cellsOf(filter), "Change", 1), 1);
  // A longer base angle but shorter edges: one metric up, the other down.
  TAUTLINE_SET(filter, SetInputData(0, toGrid(triangles({ tall, flat }))),
    SetInputData(1, toGrid(triangles({ { 0.9, 1.2, 0 }, ideal }))), ClearMetrics(),
    AddMetricByName("edge_ratio"), AddMetricByName("max_angle"), Update());
  TAUTLINE_CHECK(component(cellsOf(filter), "edge_ratio_difference", 0) < 0);
  TAUTLINE_CHECK(component(cellsOf(filter), "max_angle_difference", 0) > 0);
  TAUTLINE_CHECK_EQUAL(component(cellsOf(filter), "Change", 0), 0);
}

TAUTLINE_PART(testTolerance)
{
  TAUTLINE_NEW(vtkMeshComparison, filter, SetInputData(0, toGrid(triangles({ flat }))),
    SetInputData(1, toGrid(triangles({ { 0.5, 0.3 * (1 + 1e-5), 0 } }))), Update());
  TAUTLINE_CHECK_EQUAL(cellOf(filter, "Better"), 1);
  TAUTLINE_SET(filter, SetTolerance(1e-4), Update());
  TAUTLINE_CHECK_EQUAL(cellOf(filter, "Better"), 0);
  TAUTLINE_CHECK_EQUAL(cellOf(filter, "Equal"), 1);
  // Rounding about an ideal of 0 is no change.
  TAUTLINE_SET(filter, SetTolerance(1e-6), ClearMetrics(), AddMetricByName("mu_shape"),
    SetInputData(0, toGrid(triangles({ { 0.5, height, 0 } }))),
    SetInputData(1, toGrid(triangles({ { 0.5, height + 1e-6, 0 } }))), Update());
  TAUTLINE_CHECK_EQUAL(cellOf(filter, "Equal"), 1);
}

TAUTLINE_PART(testReversed)
{
  // Both clockwise throughout: compared as mirror images.
  auto reversed = [](std::vector<Vec3> apexes)
  {
    MeshData data = triangles(apexes);
    data.transform(TAUTLINE_PLACE(p[0], -p[1], p[2]));
    return data;
  };
  TAUTLINE_NEW(vtkMeshComparison, filter, SetInputData(0, toGrid(reversed({ flat, ideal }))),
    SetInputData(1, toGrid(reversed({ ideal, tall }))), Update());
  TAUTLINE_CHECK_EQUAL(cellOf(filter, "Better"), 1);
  TAUTLINE_CHECK_EQUAL(cellOf(filter, "Worse"), 1);
  TAUTLINE_CHECK_EQUAL(cellOf(filter, "InvertedAfter"), 0);
  // One of them only: it is inverted.
  TAUTLINE_SET(filter, SetInputData(1, toGrid(triangles({ ideal, ideal }))), Update());
  TAUTLINE_CHECK_EQUAL(cellOf(filter, "InvertedBefore"), 2);
  TAUTLINE_CHECK_EQUAL(cellOf(filter, "Better"), 2);
}

TAUTLINE_PART(testEveryCellAndMetric)
{
  // Nothing moved: everything is equal, for every cell and metric, perturbed or not.
  for (CellType type : allTypes)
  {
    const Context context(topology(type).name);
    const bool planar = topology(type).dimension == 2;
    auto grid = toGrid(blockMesh(type, 5, 5, planar ? 0 : 5), VTK_FLOAT);
    vtkNew<vtkMeshComparison> filter;
    for (const MetricInfo& info : metricRegistry())
    {
      filter->AddMetric(static_cast<int>(info.metric));
    }
    TAUTLINE_SET(filter, SetInputData(0, grid), SetInputData(1, grid), Update());
    for (vtkIdType row = 0; row < tableOf(filter)->GetNumberOfRows(); ++row)
    {
      const bool defined = metricRegistry()[row].definedOn(type);
      TAUTLINE_CHECK_EQUAL(cellOf(filter, "Equal", row), defined ? grid->GetNumberOfCells() : 0);
    }
    TAUTLINE_NEW(vtkMeshPerturbation, perturbation, SetInputData(grid), SetTangledFraction(0.1));
    TAUTLINE_SET(filter, SetInputConnection(1, perturbation->GetOutputPort()), Update());
    TAUTLINE_CHECK_EQUAL(cellOf(filter, "InvertedAfter"), double(perturbation->GetInvertedAfter()));
    TAUTLINE_CHECK_EQUAL(
      cellOf(filter, "LargestDisplacement"), perturbation->GetLargestDisplacement());
    TAUTLINE_CHECK(cellOf(filter, "Worse") > cellOf(filter, "Better"));
    for (const char* column : { "MinimumAfter", "MeanAfter", "MaximumAfter" })
    {
      TAUTLINE_EACH(vtkIdType, row, tableOf(filter)->GetNumberOfRows(),
        TAUTLINE_CHECK(std::isfinite(cellOf(filter, column, row))));
    }
  }
}

TAUTLINE_PART(testKindsOfInput)
{
  vtkNew<vtkMeshComparison> filter;
  Messages messages(filter);

  vtkNew<vtkUnstructuredGrid> nothing;
  TAUTLINE_SET(filter, SetInputData(0, nothing), SetInputData(1, nothing), Update());
  TAUTLINE_CHECK(messages.has(wording("the-input-has-no-cells")));
  messages.clear();
  TAUTLINE_CHECK_EQUAL(cellOf(filter, "Equal"), 0);

  auto pair = [&](const MeshData& a, const MeshData& b)
  {
    auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
    TAUTLINE_SET(blocks, SetBlock(0, toGrid(a)), SetBlock(2, toPolyData(b)));
    return blocks;
  };
  const auto before = pair(triangles({ flat, ideal }), triangles({ ideal }));
  TAUTLINE_SET(filter, SetInputData(0, before),
    SetInputData(1, pair(triangles({ ideal, ideal }), triangles({ tall }))), Update());
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK_EQUAL(cellOf(filter, "Better"), 1);
  TAUTLINE_CHECK_EQUAL(cellOf(filter, "Worse"), 1);
  TAUTLINE_CHECK_EQUAL(cellOf(filter, "Equal"), 1);
  auto* output = outputOf<vtkMultiBlockDataSet>(filter);
  TAUTLINE_CHECK(vtkPolyData::SafeDownCast(output->GetBlock(2)));
  TAUTLINE_CHECK_EQUAL(
    component(vtkDataSet::SafeDownCast(output->GetBlock(2))->GetCellData(), "Change", 0), -1);

  TAUTLINE_NEW(vtkImageData, image, SetDimensions(3, 3, 3));
  TAUTLINE_SET(filter, SetInputData(0, image), SetInputData(1, image), Update());
  TAUTLINE_CHECK_EQUAL(cellOf(filter, "Equal"), 8);
  TAUTLINE_CHECK(outputOf<vtkImageData>(filter));

  // Ghost cells are not counted.
  auto grid = toGrid(triangles({ flat, ideal }));
  TAUTLINE_NEW(
    vtkUnsignedCharArray, ghosts, SetName("vtkGhostType"), InsertNextValue(1), InsertNextValue(0));
  grid->GetCellData()->AddArray(ghosts);
  TAUTLINE_SET(
    filter, SetInputData(0, toGrid(triangles({ flat, flat }))), SetInputData(1, grid), Update());
  TAUTLINE_CHECK_EQUAL(cellOf(filter, "Better"), 1);
  TAUTLINE_CHECK_EQUAL(cellOf(filter, "Equal"), 0);
}

TAUTLINE_PART(testRejections)
{
  vtkNew<vtkMeshComparison> filter;
  Messages messages(filter);
  auto rejects = [&](vtkDataObject* before, vtkDataObject* after, const std::string& part)
  {
    const Context context(part);
    messages.clear();
    TAUTLINE_SET(filter, SetInputData(0, before), SetInputData(1, after), Update());
    TAUTLINE_CHECK(messages.has(part));
    TAUTLINE_CHECK_EQUAL(
      filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL), 0);
    TAUTLINE_CHECK_EQUAL(tableOf(filter)->GetNumberOfRows(), 0);
  };
  const MeshData mesh = blockMesh(CellType::Triangle, 2, 2, 0);
  auto grid = toGrid(mesh);
  rejects(grid, toGrid(blockMesh(CellType::Triangle, 3, 2, 0)),
    wording("the-first-mesh-has-9-points-the"));
  rejects(grid, toGrid(blockMesh(CellType::Quadrilateral, 2, 2, 0)),
    wording("the-first-mesh-has-8-cells-the"));
  MeshData other = mesh;
  std::swap(other.connectivity[3 * 5], other.connectivity[3 * 5 + 1]);
  rejects(grid, toGrid(other), wording("cell-5-has-the-points"));
  other = TAUTLINE_CHANGED(mesh, types[6] = VTK_POLYGON);
  rejects(grid, toGrid(MeshData(blockMesh(CellType::Tetrahedron, 1, 1, 1))), "points");
  vtkNew<vtkMultiBlockDataSet> one, two;
  one->SetBlock(0, grid);
  TAUTLINE_SET(two, SetBlock(0, grid), SetBlock(1, grid));
  rejects(one, two, wording("first-at-block-2"));
  rejects(grid, two, wording("extract-block"));
  filter->AddMetricByName("mu_98");
  MeshData surface = TAUTLINE_CHANGED(mesh, setPoint(4, { 1, 1, 1 }));
  rejects(toGrid(surface), toGrid(surface), wording("without-orientation"));
}

} // anonymous namespace
