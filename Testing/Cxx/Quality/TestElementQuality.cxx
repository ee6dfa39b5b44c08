// SPDX-License-Identifier: BSD-3-Clause
// The filter: its arrays, tables and notices, on every kind of data set, in known numbers.
#include "Registry.h"
#include "VtkMeshes.h"
#include "vtkElementQuality.h"
#include "vtkRectilinearGrid.h"
#include "vtkStructuredGrid.h"
#include "vtkVersionMacros.h"

#include <cstring>

using namespace tautline;

namespace
{
const double height = std::sqrt(3.0) / 2;

/// Separate triangles with the base from (0, 0) to (1, 0), given the heights of their apexes at x =
/// 1/2.
MeshData triangles(const std::vector<double>& heights)
{
  MeshData data;
  for (double h : heights)
  {
    data.addCell(CellType::Triangle, std::vector<Vec3>{ { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, h, 0 } });
  }
  return data;
}

/// Inverse mean ratio of such a triangle: (l1^2 + l2^2 + l3^2) / (4 sqrt(3) A).
double imrOf(double h)
{
  return (1 + 2 * (0.25 + h * h)) / (2 * std::sqrt(3.0) * h);
}

vtkCellData* cellsOf(vtkElementQuality* filter)
{
  return outputOf(filter)->GetCellData();
}

double statistic(vtkElementQuality* filter, const char* column, vtkIdType row = 0)
{
  return filter->GetStatistics()->GetValueByName(row, column).ToDouble();
}

TAUTLINE_PART(testTables)
{
  TAUTLINE_NEW(vtkElementQuality, filter,
    SetInputData(toGrid(triangles({ height, 0.2, -0.3, 0.0, 0.1, 2.0 }))), AddMetricByName("imr"),
    AddMetricByName("MU_2"), AddMetric(static_cast<int>(Metric::Size)), SetHistogramBins(4),
    Update());
  TAUTLINE_CHECK_EQUAL(filter->GetNumberOfMetrics(), 3);
  const double expected[] = { 1, imrOf(0.2), imrOf(-0.3), 0, imrOf(0.1), imrOf(2.0) };
  const double validity[] = { 1, 1, -1, 0, 1, 1 };
  for (Index i = 0; i < 6; ++i)
  {
    TAUTLINE_CHECK_NEAR(component(cellsOf(filter), "imr", i), expected[i], 1e-14);
    TAUTLINE_CHECK_EQUAL(component(cellsOf(filter), "Validity", i), validity[i]);
  }
  TAUTLINE_CHECK_EQUAL(std::string(cellsOf(filter)->GetScalars()->GetName()), "imr");
  // The valid and the inverted triangles are measured, the degenerate one is left out.
  TAUTLINE_CHECK_EQUAL(statistic(filter, "Measured"), 5);
  TAUTLINE_CHECK_EQUAL(statistic(filter, "Inverted"), 1);
  TAUTLINE_CHECK_EQUAL(statistic(filter, "Degenerate"), 1);
  TAUTLINE_CHECK_NEAR(statistic(filter, "Minimum"), imrOf(-0.3), 1e-14);
  TAUTLINE_CHECK_NEAR(statistic(filter, "Worst"), imrOf(-0.3), 1e-14);
  TAUTLINE_CHECK_NEAR(statistic(filter, "Maximum"), imrOf(0.1), 1e-14);
  const double sum = 1 + imrOf(0.2) + imrOf(-0.3) + imrOf(0.1) + imrOf(2.0);
  TAUTLINE_CHECK_NEAR(statistic(filter, "Mean"), sum / 5, 1e-14);
  TAUTLINE_CHECK_NEAR(statistic(filter, "Quantile50"), std::min(imrOf(0.2), imrOf(2.0)), 1e-14);
  // The triangle of height 0.1 has an inverse mean ratio above 3, the inverted one below 1.
  TAUTLINE_CHECK_EQUAL(statistic(filter, "OutsideAcceptable"), 2);
  // mu_2 = IMR - 1 with the sign of the area; the mean of the five signed areas.
  TAUTLINE_CHECK_NEAR(statistic(filter, "Mean", 2), 0.1 * (height + 0.2 - 0.3 + 0.1 + 2.0), 1e-14);
  TAUTLINE_CHECK_NEAR(statistic(filter, "Worst", 2), -0.15, 1e-14);

  // Inverted first, then degenerate, then by value; none beyond the six.
  auto* worst =
    vtkIdTypeArray::SafeDownCast(filter->GetStatistics()->GetColumnByName("WorstCells"));
  const vtkIdType order[] = { 2, 3, 4, 1, 5, 0, -1, -1, -1, -1 };
  TAUTLINE_EACH(int, k, 10, TAUTLINE_CHECK_EQUAL(worst->GetTypedComponent(0, k), order[k]));
  auto* at =
    vtkDoubleArray::SafeDownCast(filter->GetStatistics()->GetColumnByName("WorstPositions"));
  TAUTLINE_CHECK_NEAR(at->GetTypedComponent(0, 0), 0.5, 1e-15);
  TAUTLINE_CHECK_NEAR(at->GetTypedComponent(0, 1), -0.1, 1e-15);
  TAUTLINE_CHECK_EQUAL(filter->GetWorst()->GetNumberOfPoints(), 18);
  TAUTLINE_CHECK_EQUAL(filter->GetWorst()->GetNumberOfVerts(), 18);

  TAUTLINE_CHECK_EQUAL(filter->GetDistribution()->GetNumberOfRows(), 4);
  const double width = (imrOf(0.1) - imrOf(-0.3)) / 4;
  TAUTLINE_CHECK_NEAR(filter->GetDistribution()->GetValueByName(0, "imr value").ToDouble(),
    imrOf(-0.3) + width / 2, 1e-14);
  TAUTLINE_CHECK_EQUAL(filter->GetDistribution()->GetValueByName(0, "imr count").ToInt(), 1);
  TAUTLINE_CHECK_EQUAL(filter->GetDistribution()->GetValueByName(3, "imr count").ToInt(), 1);
  TAUTLINE_CHECK(
    std::string(filter->GetSummary()).find("4 valid elements, 1 inverted, 1 degenerate") == 0);
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("worst-element-2")));

  // Bins over the acceptable range 1 to 3 between a row of what is below and one of what is above.
  vtkTable* histogram = filter->GetHistogram();
  TAUTLINE_CHECK_EQUAL(histogram->GetNumberOfRows(), 6);
  TAUTLINE_CHECK_EQUAL(histogram->GetValueByName(1, "imr from").ToDouble(), 1);
  TAUTLINE_CHECK_EQUAL(histogram->GetValueByName(4, "imr to").ToDouble(), 3);
  const int counts[] = { 0, 2, 0, 1, 0, 1 };
  TAUTLINE_EACH(int, row, 6,
    TAUTLINE_CHECK_EQUAL(histogram->GetValueByName(row, "imr count").ToInt(), counts[row]));
  TAUTLINE_CHECK_NEAR(histogram->GetValueByName(5, "imr to").ToDouble(), imrOf(0.1), 1e-14);
}

/// One meaning for all statistics: of larger-is-better metrics the minimum is the worst, also where
/// it is of an inverted element; a degenerate element is listed but no statistic has its value.
TAUTLINE_PART(testWorst)
{
  vtkNew<vtkElementQuality> filter;
  const auto measure = [&](const std::vector<double>& heights)
  { TAUTLINE_SET(filter, SetInputData(toGrid(triangles(heights))), Update()); };
  TAUTLINE_SET(filter, AddMetricByName("scaled_jacobian"), AddMetricByName("imr"));
  measure({ height, 0.1, -0.05, 0.0 });
  TAUTLINE_CHECK(statistic(filter, "Minimum") < 0);
  TAUTLINE_CHECK_EQUAL(statistic(filter, "Worst"), statistic(filter, "Minimum"));
  TAUTLINE_CHECK_EQUAL(
    statistic(filter, "Worst"), component(cellsOf(filter), "scaled_jacobian", 2));
  TAUTLINE_CHECK_NEAR(statistic(filter, "Worst", 1), imrOf(-0.05), 1e-13);
  measure({ height, 0.1, 0.0 });
  TAUTLINE_CHECK_EQUAL(statistic(filter, "Worst"), statistic(filter, "Minimum"));
  TAUTLINE_CHECK(statistic(filter, "Worst") > 0.05);
  TAUTLINE_CHECK_NEAR(statistic(filter, "Worst", 1), imrOf(0.1), 1e-13);
  TAUTLINE_CHECK_EQUAL(statistic(filter, "Worst", 1), statistic(filter, "Maximum", 1));
  auto* listed =
    vtkIdTypeArray::SafeDownCast(filter->GetStatistics()->GetColumnByName("WorstCells"));
  TAUTLINE_CHECK_EQUAL(listed->GetTypedComponent(0, 0), 2);
  measure({ 0.0, 0.0 });
  TAUTLINE_CHECK_EQUAL(statistic(filter, "Measured"), 0);
  TAUTLINE_CHECK_EQUAL(statistic(filter, "Worst"), 0);
}

TAUTLINE_PART(testAngles)
{
  vtkNew<vtkElementQuality> filter;
  // Angles 60 60 60, and 90 45 45.
  TAUTLINE_SET(filter, SetInputData(toGrid(triangles({ height, 0.5 }))), Update());
  const double percent[] = { 0, 0, 500.0 / 6, 0, 0 };
  double sum = 0;
  for (vtkIdType row = 0; row < 5; ++row)
  {
    const double share = filter->GetAngles()->GetValueByName(row, "Percent").ToDouble();
    sum += share;
    if (row < 2 || row == 4)
    {
      TAUTLINE_CHECK_NEAR(share, percent[row], 1e-12);
    }
  }
  TAUTLINE_CHECK_NEAR(sum, 100, 1e-12);
  TAUTLINE_CHECK_NEAR(
    filter->GetAngles()->GetValueByName(3, "Percent").ToDouble(), 100.0 / 6, 1e-12);
  TAUTLINE_CHECK_EQUAL(filter->GetAngles()->GetValueByName(2, "To").ToDouble(), 80);
}

/// Every kind of data set of unit squares or cubes: mean ratio 1 everywhere, sizes 1.
TAUTLINE_PART(testDataSets)
{
  vtkNew<vtkImageData> image, layer;
  image->SetDimensions(3, 4, 5);
  layer->SetDimensions(3, 1, 4);
  TAUTLINE_NEW(vtkStructuredGrid, structured, SetDimensions(3, 4, 1));
  vtkNew<vtkPoints> points;
  vtkNew<vtkRectilinearGrid> rectilinear;
  vtkNew<vtkDoubleArray> axis;
  for (int i = 0; i < 4; ++i)
  {
    axis->InsertNextValue(i);
    for (int j = 0; j < 3; ++j)
    {
      points->InsertNextPoint(j, i, 7);
    }
  }
  structured->SetPoints(points);
  TAUTLINE_SET(rectilinear, SetDimensions(4, 4, 4), SetXCoordinates(axis), SetYCoordinates(axis),
    SetZCoordinates(axis));
  const MeshData quads = blockMesh(CellType::Quadrilateral, 3, 3, 1);
  struct
  {
    vtkSmartPointer<vtkDataSet> data;
    Index cells;
  } cases[] = { { image.Get(), 24 }, { layer.Get(), 6 }, { structured.Get(), 6 },
    { rectilinear.Get(), 27 }, { toGrid(quads), 9 }, { toGrid(quads, VTK_FLOAT), 9 },
    { toPolyData(quads), 9 }, { toPolyData(quads, VTK_FLOAT), 9 } };
  for (const auto& c : cases)
  {
    const Context context(c.data->GetClassName());
    TAUTLINE_NEW(vtkElementQuality, filter, SetInputData(c.data));
    for (const char* name : { "mean_ratio", "size", "scaled_jacobian" })
    {
      filter->AddMetricByName(name);
    }
    filter->Update();
    auto* output = outputOf(filter);
    TAUTLINE_CHECK(output->IsA(c.data->GetClassName()));
    TAUTLINE_CHECK_EQUAL(output->GetNumberOfCells(), c.cells);
    TAUTLINE_CHECK_EQUAL(statistic(filter, "Measured"), c.cells);
    TAUTLINE_CHECK_EQUAL(std::string(filter->GetNotice()), "");
    for (vtkIdType row = 0; row < 3; ++row)
    {
      const double side = c.cells == 9 ? quads.point(1)[0] - quads.point(0)[0] : 1;
      TAUTLINE_CHECK_NEAR(statistic(filter, "Minimum", row), row == 1 ? side * side : 1, 1e-6);
      TAUTLINE_CHECK_NEAR(statistic(filter, "Maximum", row), row == 1 ? side * side : 1, 1e-6);
    }
  }
}

/// Two blocks count as one data set, in the order of the blocks.
TAUTLINE_PART(testBlocks)
{
  TAUTLINE_NEW(vtkMultiBlockDataSet, blocks, SetBlock(0, toGrid(triangles({ height, 0.2 }))),
    SetBlock(2, toPolyData(triangles({ 0.1, height }))));
  TAUTLINE_NEW(vtkElementQuality, filter, SetInputData(blocks), Update());
  auto* output = outputOf<vtkMultiBlockDataSet>(filter);
  TAUTLINE_CHECK_EQUAL(statistic(filter, "Measured"), 4);
  TAUTLINE_CHECK_NEAR(statistic(filter, "Maximum"), imrOf(0.1), 1e-14);
  auto* worst =
    vtkIdTypeArray::SafeDownCast(filter->GetStatistics()->GetColumnByName("WorstCells"));
  TAUTLINE_CHECK_EQUAL(worst->GetTypedComponent(0, 0), 2);
  auto* last = vtkDataSet::SafeDownCast(output->GetBlock(2));
  TAUTLINE_CHECK_NEAR(component(last->GetCellData(), "imr", 0), imrOf(0.1), 1e-14);
}

TAUTLINE_PART(testSpecialCells)
{
  // Nothing, one unused point, a NaN, and ghosts.
  TAUTLINE_NEW(vtkElementQuality, filter, SetInputData(vtkNew<vtkUnstructuredGrid>()));
  Messages messages(filter);
  filter->Update();
  TAUTLINE_CHECK(messages.has(wording("the-input-has-no-cells")));
  messages.clear();
  TAUTLINE_CHECK_EQUAL(statistic(filter, "Measured"), 0);

  MeshData data = TAUTLINE_CHANGED(triangles({ height, 0.2, 0.5 }), addPoint({ 1e6, -1e6, 0 }),
    points[3 * 5] = std::numeric_limits<double>::quiet_NaN());
  TAUTLINE_SET(filter, SetInputData(toGrid(data)), Update());
  TAUTLINE_CHECK_EQUAL(statistic(filter, "Measured"), 2);
  TAUTLINE_CHECK_EQUAL(statistic(filter, "NonFinite"), 1);
  TAUTLINE_CHECK_EQUAL(component(cellsOf(filter), "Validity", 1), -3);
  TAUTLINE_CHECK_EQUAL(component(cellsOf(filter), "imr", 1), 0);
  TAUTLINE_CHECK(messages.has(wording("1-points-have-a-nan")));

  auto grid = TAUTLINE_CHANGED(toGrid(triangles({ height, 0.1 })), AllocateCellGhostArray(),
    GetCellGhostArray()->SetValue(1, vtkDataSetAttributes::DUPLICATECELL));
  TAUTLINE_SET(filter, SetInputData(grid), Update());
  TAUTLINE_CHECK_EQUAL(statistic(filter, "Measured"), 1);
  TAUTLINE_CHECK_NEAR(component(cellsOf(filter), "imr", 1), imrOf(0.1), 1e-14);

  // The triangles of a volume mesh are measured, but not counted.
  TAUTLINE_LET(MeshData, mixed, addCell(CellType::Tetrahedron, idealCell(CellType::Tetrahedron)),
    addCell(CellType::Triangle, std::vector<Index>{ 0, 1, 2 }), addCell(VTK_LINE, { 0, 1 }));
  messages.clear();
  TAUTLINE_SET(filter, SetInputData(toGrid(mixed)), Update());
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK_EQUAL(statistic(filter, "Measured"), 1);
  TAUTLINE_CHECK_NEAR(component(cellsOf(filter), "imr", 1), 1, 1e-14);
  TAUTLINE_CHECK_EQUAL(component(cellsOf(filter), "Validity", 2), -2);
}

TAUTLINE_PART(testReversed)
{
  MeshData mesh = blockMesh(CellType::Tetrahedron, 2, 2, 2);
  const std::vector<double> values = valuesOf(Mesh(mesh.view()), Metric::InverseMeanRatio);
  mesh.swapNodes(1, 2);
  const Index cells = mesh.numberOfCells();
  for (int mode : { vtkElementQuality::MEASURE_AS_GIVEN, vtkElementQuality::MEASURE_FLIPPED,
         vtkElementQuality::FLIP_OUTPUT })
  {
    const Context context("mode " + std::to_string(mode));
    TAUTLINE_NEW(vtkElementQuality, filter, SetReversedMesh(mode));
    const auto input = toGrid(mesh);
    filter->SetInputData(input);
    Messages messages(filter);
    filter->Update();
    TAUTLINE_CHECK(messages.has(wording("the-mesh-is-reversed")));
    TAUTLINE_CHECK_EQUAL(
      statistic(filter, "Inverted"), mode == vtkElementQuality::MEASURE_AS_GIVEN ? cells : 0);
    const double sign = mode == vtkElementQuality::MEASURE_AS_GIVEN ? -1 : 1;
    TAUTLINE_CHECK_NEAR(component(cellsOf(filter), "imr", 3), sign * values[3], 1e-13);

    // A second measurement of a flipped output reports nothing; the input stays.
    TAUTLINE_NEW(vtkElementQuality, again, SetInputData(filter->GetOutputDataObject(0)));
    Messages second(again);
    again->Update();
    TAUTLINE_CHECK_EQUAL(second.empty(), mode == vtkElementQuality::FLIP_OUTPUT);
    TAUTLINE_CHECK_EQUAL(input->GetCell(0)->GetPointId(1), mesh.connectivity[1]);
  }
  // One flipped cell in a consistent mesh.
  mesh.swapNodes(1, 2, 1);
  TAUTLINE_NEW(vtkElementQuality, filter, SetInputData(toGrid(mesh)));
  Messages messages(filter);
  filter->Update();
  TAUTLINE_CHECK(messages.has(wording("orientation-of-the-mesh-is-mixed")));
  TAUTLINE_CHECK(messages.has("1 of the " + std::to_string(cells) + " cells is treated as if"));
  TAUTLINE_CHECK_EQUAL(statistic(filter, "Inverted"), 0);
  TAUTLINE_EACH(Index, cell, cells,
    TAUTLINE_CHECK_NEAR(component(cellsOf(filter), "imr", cell), values[cell], 1e-13));
  TAUTLINE_SET(filter, SetReversedMesh(vtkElementQuality::MEASURE_AS_GIVEN), Update());
  TAUTLINE_CHECK_EQUAL(statistic(filter, "Inverted"), 1);
  TAUTLINE_SET(filter, SetReversedMesh(vtkElementQuality::FLIP_OUTPUT), Update());
  TAUTLINE_NEW(vtkElementQuality, again, SetReversedMesh(vtkElementQuality::MEASURE_AS_GIVEN),
    SetInputData(filter->GetOutputDataObject(0)));
  Messages second(again);
  again->Update();
  TAUTLINE_CHECK(second.empty());
  TAUTLINE_CHECK_EQUAL(statistic(again, "Inverted"), 0);
}

/// A surface without a consistent orientation can be measured.
TAUTLINE_PART(testMoebius)
{
  constexpr int count = 12;
  TAUTLINE_NEW(vtkElementQuality, filter, SetInputData(toGrid(moebiusBand(count))));
  Messages messages(filter);
  filter->Update();
  TAUTLINE_CHECK(messages.has(wording("like-those-of-a-moebius-band")));
  TAUTLINE_CHECK_EQUAL(statistic(filter, "Measured"), count);
}

TAUTLINE_PART(testTargets)
{
  const MeshData data = triangles({ 0.3, 2.0 });
  TAUTLINE_NEW(vtkElementQuality, filter, AddMetricByName("mu_7"), AddMetricByName("mu_size_nb"));
  const auto grid = toGrid(data);
  filter->SetInputData(grid);

  // Against itself every element has its target shape.
  TAUTLINE_SET(
    filter, SetTargetType(vtkElementQuality::REFERENCE), SetInputData(1, grid), Update());
  TAUTLINE_CHECK_NEAR(statistic(filter, "Maximum"), 0, 1e-12);

  // A size from a cell array, and from a point array that is its constant.
  filter->SetTargetType(vtkElementQuality::SIZE);
  vtkNew<vtkDoubleArray> sizes, pointSizes;
  TAUTLINE_SET(sizes, SetName("sizes"), InsertNextValue(0.15), InsertNextValue(0.5));
  grid->GetCellData()->AddArray(sizes);
  TAUTLINE_SET(pointSizes, SetName("sizes"), SetNumberOfValues(6), Fill(0.5));
  grid->GetPointData()->AddArray(pointSizes);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "sizes");
  filter->Update();
  TAUTLINE_CHECK_NEAR(component(cellsOf(filter), "mu_size_nb", 0), 0, 1e-13);
  TAUTLINE_CHECK_NEAR(component(cellsOf(filter), "mu_size_nb", 1), 1, 1e-13);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "sizes");
  filter->Update();
  TAUTLINE_CHECK_NEAR(component(cellsOf(filter), "mu_size_nb", 0), 0.7 * 0.7, 1e-13);

  // The tensor in which the second triangle is equilateral with unit edges.
  TAUTLINE_NEW(vtkDoubleArray, tensors, SetName("tensors"), SetNumberOfComponents(6));
  for (int i = 0; i < 2; ++i)
  {
    tensors->InsertNextTuple6(1, height * height / 4, 1, 0, 0, 0);
  }
  grid->GetCellData()->AddArray(tensors);
  TAUTLINE_SET(filter, SetTargetType(vtkElementQuality::TENSOR),
    SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "tensors"), Update());
  TAUTLINE_CHECK_NEAR(component(cellsOf(filter), "mu_shape_size", 1), 0, 1e-12);
  TAUTLINE_CHECK(component(cellsOf(filter), "mu_shape_size", 0) > 1);
}

TAUTLINE_PART(testErrors)
{
  vtkNew<vtkElementQuality> filter;
  Messages messages(filter);
  filter->AddMetricByName("beauty");
  TAUTLINE_CHECK(messages.has(wording("there-is-no-metric-beauty")));
  filter->AddMetric(1000);
  TAUTLINE_CHECK(messages.has(wording("no-metric-number-1000")));
  TAUTLINE_CHECK_EQUAL(filter->GetNumberOfMetrics(), 0);

  const auto grid = toGrid(triangles({ height }));
  filter->SetInputData(grid);
  const auto rejected = [&](const char* part)
  {
    messages.clear();
    TAUTLINE_SET(filter, Modified(), Update());
    TAUTLINE_CHECK(messages.has(part));
    auto* output = outputOf(filter);
    TAUTLINE_CHECK_EQUAL(output->GetNumberOfCells(), 0);
  };
  filter->SetTargetType(vtkElementQuality::REFERENCE);
  rejected(wording("there-is-none"));
  filter->SetInputData(1, toGrid(triangles({ height, height })));
  rejected(wording("the-reference-mesh-has-6-points"));
  filter->SetInputData(1, toGrid(triangles({ 0.0 })));
  rejected(wording("inverted-or-degenerate-in-the-reference-mesh"));
  filter->SetTargetType(vtkElementQuality::SIZE);
  rejected(wording("needs-a-size"));
  TAUTLINE_NEW(vtkDoubleArray, sizes, SetName("sizes"), InsertNextValue(-1));
  grid->GetCellData()->AddArray(sizes);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "sizes");
  rejected(wording("sizes-must-be-positive"));
  TAUTLINE_SET(filter, SetTargetType(vtkElementQuality::IDEAL), SetEpsilon(0));
  rejected(wording("epsilon-positive"));
}

TAUTLINE_PART(testThreads)
{
  MeshData mesh = shuffled(blockMesh(CellType::Tetrahedron, 12, 12, 12), 3);
  Random random(5);
  mesh.transform([&](const Vec3& p) { return p + random.vector(-0.02, 0.02); });
  std::vector<double> first;
  for (int threads : { 1, 2, 4 })
  {
    TAUTLINE_NEW(
      vtkElementQuality, filter, SetThreads(threads), SetInputData(toGrid(mesh)), Update());
    auto* values = vtkDoubleArray::SafeDownCast(cellsOf(filter)->GetArray("imr"));
    std::vector<double> all(
      values->GetPointer(0), values->GetPointer(0) + values->GetNumberOfValues());
    all.push_back(statistic(filter, "Mean"));
    if (first.empty())
    {
      first = all;
    }
    TAUTLINE_CHECK(first.size() == all.size() &&
      std::memcmp(first.data(), all.data(), all.size() * sizeof(double)) == 0);
  }
}

/// The bad elements of a volume: one flat, one inverted of three; with criteria, those that fail. A
/// planar mesh has none inside.
TAUTLINE_PART(testBad)
{
  TAUTLINE_NEW(vtkPoints, points, SetDataTypeToDouble());
  vtkNew<vtkUnstructuredGrid> grid;
  const double regular = std::sqrt(2.0 / 3.0), flat = 0.05, inverted = -0.3;
  for (const double apex : { regular, flat, inverted })
  {
    const vtkIdType first = points->InsertNextPoint(0, 0, 0);
    TAUTLINE_SET(points, InsertNextPoint(1, 0, 0), InsertNextPoint(0.5, height, 0),
      InsertNextPoint(0.5, height / 3, apex));
    const vtkIdType ids[] = { first, first + 1, first + 2, first + 3 };
    grid->InsertNextCell(VTK_TETRA, 4, ids);
  }
  grid->SetPoints(points);
  TAUTLINE_NEW(vtkElementQuality, filter, SetInputData(grid), AddMetricByName("imr"), Update());
  TAUTLINE_CHECK_EQUAL(filter->GetBad()->GetNumberOfCells(), 0);
  TAUTLINE_SET(filter, ExtractBadOn(), Update());
  vtkUnstructuredGrid* bad = filter->GetBad();
  TAUTLINE_CHECK_EQUAL(bad->GetNumberOfCells(), 2);
  TAUTLINE_CHECK_EQUAL(bad->GetNumberOfPoints(), 8);
  TAUTLINE_CHECK_NEAR(bad->GetPoint(3)[2], flat, 1e-15);
  TAUTLINE_CHECK_NEAR(bad->GetPoint(7)[2], inverted, 1e-15);
  TAUTLINE_EACH(vtkIdType, i, 2,
    TAUTLINE_CHECK_EQUAL(bad->GetCellData()->GetArray("imr")->GetComponent(i, 0),
      component(cellsOf(filter), "imr", i + 1)));
  // A limit that the flat element keeps: only the inverted one fails.
  filter->SetCriteria(R"({ "criteria": [ { "metric": "imr",
    "limits": { "all": { "ideal": 1, "good": 2, "warn": 3, "fail": 1e6, "worst": 1e7 } } } ] })");
  filter->Update();
  TAUTLINE_CHECK_EQUAL(filter->GetBad()->GetNumberOfCells(), 1);
  TAUTLINE_SET(
    filter, SetCriteria(""), SetInputData(toGrid(triangles({ height, 0.01, -0.3 }))), Update());
  TAUTLINE_CHECK_EQUAL(filter->GetBad()->GetNumberOfCells(), 0);
}

#if VTK_VERSION_NUMBER < VTK_VERSION_CHECK(9, 4, 0)
/// Lists of faces as VTK's reader of .pvtu files leaves them are not passed on, and the input keeps
/// them; the faces of a polyhedron are.
TAUTLINE_PART(testStrayFaces)
{
  const auto grid = toGrid(blockMesh(CellType::Tetrahedron, 2, 2, 2));
  vtkNew<vtkIdTypeArray> faces, places;
  grid->SetCells(grid->GetCellTypesArray(), grid->GetCells(), places, faces);
  TAUTLINE_NEW(vtkMultiBlockDataSet, blocks, SetBlock(0, grid));
  for (vtkDataObject* input :
    { static_cast<vtkDataObject*>(grid), vtkDataObject::SafeDownCast(blocks) })
  {
    TAUTLINE_NEW(vtkElementQuality, filter, SetInputDataObject(input), Update());
    vtkDataObject* output = filter->GetOutputDataObject(0);
    auto* several = vtkMultiBlockDataSet::SafeDownCast(output);
    auto* measured = vtkUnstructuredGrid::SafeDownCast(several ? several->GetBlock(0) : output);
    TAUTLINE_CHECK_EQUAL(measured->GetNumberOfCells(), grid->GetNumberOfCells());
    TAUTLINE_CHECK_EQUAL(measured->GetCellType(5), VTK_TETRA);
    TAUTLINE_CHECK(measured->GetFaces() == nullptr && measured->GetFaceLocations() == nullptr);
    TAUTLINE_CHECK(component(measured->GetCellData(), "Validity", 5) == 1);
    TAUTLINE_CHECK(grid->GetFaces() == faces && grid->GetFaceLocations() == places);
  }
  TAUTLINE_NEW(vtkUnstructuredGrid, solid, SetPoints(grid->GetPoints()));
  const vtkIdType stream[] = { 3, 0, 1, 3, 3, 0, 1, 9, 3, 1, 3, 9, 3, 0, 3, 9 };
  solid->InsertNextCell(VTK_POLYHEDRON, 4, stream);
  TAUTLINE_NEW(vtkElementQuality, filter, SetInputData(solid), Update());
  auto* kept = outputOf<vtkUnstructuredGrid>(filter);
  TAUTLINE_CHECK(kept->GetFaces() && kept->GetFaces()->GetNumberOfValues() == 17);
}
#endif

/// An abort between metrics leaves the mesh with the metrics measured so far.
TAUTLINE_PART(testAbort)
{
  TAUTLINE_NEW(vtkElementQuality, filter, SetInputData(toGrid(triangles({ height, 0.2 }))),
    AddMetricByName("imr"), AddMetricByName("si"), AddMetricByName("rr"));
  stopAt(filter, vtkCommand::ProgressEvent, 0.3);
  filter->Update();
  TAUTLINE_CHECK(cellsOf(filter)->GetArray("imr") != nullptr);
  TAUTLINE_CHECK(cellsOf(filter)->GetArray("rr") == nullptr);
}
}
