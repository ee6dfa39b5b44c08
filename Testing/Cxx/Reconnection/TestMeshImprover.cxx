// SPDX-License-Identifier: BSD-3-Clause
// Improve Mesh: the kernel's result as a data set, data of points and cells, tables, rejections.
#include "Reconnecting.h"
#include "Registry.h"
#include "VtkMeshes.h"
#include "vtkMeshImprover.h"

using namespace tautline;

namespace
{
constexpr Index Cubes = 5;

vtkUnstructuredGrid* meshOf(vtkMeshImprover* filter)
{
  return outputOf<vtkUnstructuredGrid>(filter);
}

MeshData dataOf(vtkUnstructuredGrid* grid)
{
  MeshData data;
  for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
  {
    data.points.insert(data.points.end(), grid->GetPoint(i), grid->GetPoint(i) + 3);
  }
  for (vtkIdType i = 0; i < grid->GetNumberOfCells(); ++i)
  {
    const vtkIdType* ids = nullptr;
    vtkIdType size = 0;
    grid->GetCells()->GetCellAtId(i, size, ids);
    data.addCell(CellType::Tetrahedron, { ids[0], ids[1], ids[2], ids[3] });
  }
  return data;
}

double linear(const Vec3& p)
{
  return 3.0 + 2.0 * p[0] - p[1] + 0.5 * p[2];
}

/// Data of every kind; two regions with a plane between them.
vtkSmartPointer<vtkUnstructuredGrid> withArrays(const MeshData& data, int type = VTK_DOUBLE)
{
  auto grid = toGrid(data, type);
  TAUTLINE_NEW(vtkDoubleArray, field, SetName("field"));
  TAUTLINE_NEW(vtkIdTypeArray, point, SetName("point"));
  TAUTLINE_NEW(vtkIntArray, region, SetName("region"));
  TAUTLINE_NEW(vtkStringArray, text, SetName("text"));
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    field->InsertNextValue(linear(data.point(i)));
    point->InsertNextValue(i);
  }
  for (Index i = 0; i < data.numberOfCells(); ++i)
  {
    region->InsertNextValue(i < data.numberOfCells() / 2 ? 7 : -2);
    text->InsertNextValue("c" + std::to_string(i));
  }
  TAUTLINE_SET(grid, GetPointData()->AddArray(field), GetPointData()->SetGlobalIds(point),
    GetCellData()->AddArray(region), GetCellData()->AddArray(text));
  return grid;
}

/// The output is what the kernel returns, with its tables.
TAUTLINE_PART(testKernel)
{
  const MeshData data = sliverBlock(Cubes);
  for (int preset = vtkMeshImprover::REMOVE_SLIVERS; preset <= vtkMeshImprover::AGGRESSIVE;
       ++preset)
  {
    const Context context("preset " + std::to_string(preset));
    const ReconnectionResult expected =
      reconnect(data, optionsOf(static_cast<ReconnectionPreset>(preset)));
    vtkNew<vtkMeshImprover> filter;
    Messages messages(filter);
    TAUTLINE_SET(filter, SetInputData(toGrid(data)), SetPreset(preset), Update());
    TAUTLINE_CHECK(messages.empty());
    const MeshData after = dataOf(meshOf(filter));
    TAUTLINE_CHECK(after.points == expected.points);
    TAUTLINE_CHECK(after.connectivity == expected.tetrahedra);
    TAUTLINE_CHECK_EQUAL(filter->GetElementsBefore(), data.numberOfCells());
    TAUTLINE_CHECK_EQUAL(filter->GetElementsAfter(), after.numberOfCells());
    const ReconnectionRecord& last = expected.history.back();
    TAUTLINE_CHECK_EQUAL(filter->GetSmallestAngleAfter(), last.smallestAngle);
    TAUTLINE_CHECK_EQUAL(filter->GetWorstAfter(), last.worstInverseMeanRatio);
    TAUTLINE_CHECK(filter->GetSmallestAngleAfter() > filter->GetSmallestAngleBefore());
    TAUTLINE_CHECK(filter->GetWorstAfter() < filter->GetWorstBefore());
    TAUTLINE_CHECK_EQUAL(
      filter->GetHistory()->GetNumberOfRows(), static_cast<Index>(expected.history.size()));
    double range[2];
    meshOf(filter)->GetCellData()->GetArray("min_angle")->GetRange(range);
    TAUTLINE_CHECK_NEAR(range[0], last.smallestAngle, 1e-8);
    meshOf(filter)->GetCellData()->GetArray("imr")->GetRange(range);
    TAUTLINE_CHECK_RELATIVE(range[1], last.worstInverseMeanRatio, 1e-9);
    // The remaining elements, the worst first.
    TAUTLINE_CHECK_EQUAL(filter->GetRemaining(), last.belowTarget);
    vtkTable* remaining = filter->GetRemainingTable();
    TAUTLINE_CHECK_EQUAL(remaining->GetNumberOfRows(), last.belowTarget);
    for (vtkIdType row = 0; row < remaining->GetNumberOfRows(); ++row)
    {
      const Index cell = remaining->GetValueByName(row, "Cell").ToTypeInt64();
      TAUTLINE_CHECK(expected.obstacles[cell] != 0);
      TAUTLINE_CHECK(!remaining->GetValueByName(row, "Reason").ToString().empty());
      TAUTLINE_CHECK(row == 0 ||
        remaining->GetValueByName(row, "Smallest angle").ToDouble() >=
          remaining->GetValueByName(row - 1, "Smallest angle").ToDouble());
    }
    TAUTLINE_CHECK(contains(filter->GetSummary(), "Tetrahedra: "));
    TAUTLINE_CHECK(contains(filter->GetSummary(),
      last.belowTarget > 0 ? "below the target of" : "No tetrahedron remains below the target of"));
  }
}

/// No remedy is what the boundary does already.
TAUTLINE_PART(testRemedies)
{
  constexpr double highest = 60; // degrees; no mesh of the cube reaches it
  for (const int boundary :
    { vtkMeshImprover::FIXED, vtkMeshImprover::SLIDING, vtkMeshImprover::ON_SURFACE })
  {
    const Context context("boundary " + std::to_string(boundary));
    TAUTLINE_NEW(vtkMeshImprover, filter, SetInputData(toGrid(sliverBlock(Cubes))),
      SetBoundary(boundary), SetTargetAngle(highest), Update());
    const std::string text = filter->GetSummary();
    TAUTLINE_CHECK(filter->GetRemaining() > 0);
    TAUTLINE_CHECK(contains(text, wording("it-has-a-point-on-the-boundary")));
    TAUTLINE_CHECK_EQUAL(
      contains(text, wording("slide-on-flat-parts")), boundary == vtkMeshImprover::FIXED);
    TAUTLINE_CHECK_EQUAL(
      contains(text, wording("on-the-surface")), boundary != vtkMeshImprover::ON_SURFACE);
  }
}

/// Points of the input keep their data, new ones interpolate a linear field exactly; cells have the
/// data of the original one; regions keep their volumes.
TAUTLINE_PART(testData)
{
  const MeshData data = sliverBlock(Cubes);
  const auto input = withArrays(data);
  vtkNew<vtkMeshImprover> filter;
  Messages messages(filter);
  TAUTLINE_SET(filter, SetInputData(input), SetPreset(vtkMeshImprover::AGGRESSIVE),
    SetTargetAngle(40),
    SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "region"), Update());
  TAUTLINE_CHECK(messages.empty());
  vtkUnstructuredGrid* output = meshOf(filter);
  const MeshData after = dataOf(output);
  const vtkIdType last = filter->GetHistory()->GetNumberOfRows() - 1;
  TAUTLINE_CHECK(filter->GetHistory()->GetValueByName(last, "N insertions").ToDouble() > 0);

  // The kernel's result states which point is which.
  ReconnectionOptions options = optionsOf(ReconnectionPreset::Aggressive);
  options.targetAngle = 40;
  auto regions = collect<Index>(
    data.numberOfCells(), [&](Index i) { return i < data.numberOfCells() / 2 ? 7 : -2; });
  options.regions = regions.data();
  const ReconnectionResult expected = reconnect(data, options);
  TAUTLINE_CHECK(after.points == expected.points);
  Index inserted = 0;
  for (Index i = 0; i < after.numberOfPoints(); ++i)
  {
    const Index original = expected.originalPoints[i];
    inserted += original < 0;
    TAUTLINE_CHECK_NEAR(component(output->GetPointData(), "field", i),
      linear(original < 0 ? after.point(i) : data.point(original)), 1e-12);
  }
  TAUTLINE_CHECK(inserted > 0);
  TAUTLINE_CHECK(!output->GetPointData()->GetGlobalIds());

  std::map<double, double> before, volumes;
  for (Index i = 0; i < data.numberOfCells(); ++i)
  {
    before[component(input->GetCellData(), "region", i)] += volumeOf(data, i);
  }
  auto* texts = vtkStringArray::SafeDownCast(output->GetCellData()->GetAbstractArray("text"));
  for (Index i = 0; i < after.numberOfCells(); ++i)
  {
    volumes[component(output->GetCellData(), "region", i)] += volumeOf(after, i);
    const Index original =
      static_cast<Index>(component(output->GetCellData(), "OriginalCellId", i));
    TAUTLINE_CHECK(original >= 0 && original < data.numberOfCells());
    TAUTLINE_CHECK_EQUAL(texts->GetValue(i), "c" + std::to_string(original));
  }
  TAUTLINE_CHECK_EQUAL(volumes.size(), 2u);
  for (const auto& [region, volume] : before)
  {
    TAUTLINE_CHECK_RELATIVE(volumes[region], volume, 1e-12);
  }
  TAUTLINE_CHECK(outerFacets(after) == outerFacets(data));
}

/// Points that an array or a selection fixes are where they were.
TAUTLINE_PART(testFixed)
{
  const MeshData data = sliverBlock(Cubes);
  const auto input = toGrid(data);
  TAUTLINE_NEW(
    vtkDoubleArray, all, SetName("all"), SetNumberOfValues(data.numberOfPoints()), Fill(1));
  input->GetPointData()->AddArray(all);
  TAUTLINE_NEW(vtkMeshImprover, filter, SetInputData(0, input),
    SetPreset(vtkMeshImprover::SWAP_AND_SMOOTH),
    SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "all"), Update());
  TAUTLINE_CHECK(dataOf(meshOf(filter)).points == data.points);
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("it-has-a-fixed-point-fix-fewer")));
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "None");
  filter->Update();
  TAUTLINE_CHECK(dataOf(meshOf(filter)).points != data.points);

  vtkNew<vtkIdTypeArray> ids;
  for (Index i = 0; i < data.numberOfCells(); ++i)
  {
    ids->InsertNextValue(i);
  }
  TAUTLINE_NEW(vtkSelectionNode, node, SetContentType(vtkSelectionNode::INDICES),
    SetFieldType(vtkSelectionNode::CELL), SetSelectionList(ids));
  TAUTLINE_NEW(vtkSelection, selection, AddNode(node));
  TAUTLINE_SET(filter, SetInputData(1, selection), Update());
  TAUTLINE_CHECK(dataOf(meshOf(filter)).points == data.points);
}

/// Rejected inputs, by text; an error leaves all outputs empty.
TAUTLINE_PART(testRejections)
{
  vtkNew<vtkMeshImprover> filter;
  Messages messages(filter);
  const auto rejected = [&](vtkDataObject* input, const char* text)
  {
    const Context context(text);
    messages.clear();
    TAUTLINE_SET(filter, SetInputDataObject(0, input), Update());
    TAUTLINE_CHECK(messages.has(text));
    TAUTLINE_CHECK_EQUAL(filter->GetHistory()->GetNumberOfRows(), 0);
    TAUTLINE_CHECK(std::string(filter->GetSummary()).empty());
  };
  rejected(
    toGrid(blockMesh(CellType::Hexahedron, 2, 2, 2)), wording("8-hexahedra-improve-mesh-takes"));
  rejected(toGrid(blockMesh(CellType::Hexahedron, 2, 2, 2)), wording("run-tetrahedralize-first-2"));
  MeshData mixed = blockMesh(CellType::Triangle, 2, 2, 0);
  mixed.addCell(CellType::Quadrilateral, { 0, 1, 4, 3 });
  const char* triangulate =
    "1 quadrilaterals: Improve Mesh takes linear triangles only; run Triangulate first";
  rejected(toGrid(mixed), triangulate);
  rejected(toPolyData(mixed), triangulate);
  TAUTLINE_NEW(vtkImageData, image, SetDimensions(3, 3, 3));
  rejected(image, wording("run-tetrahedralize-first-2"));

  MeshData inverted = blockMesh(CellType::Tetrahedron, 2, 2, 2);
  inverted.setPoint(13, { 3, 3, 3 });
  rejected(toGrid(inverted), wording("run-untangle-mesh-first"));
  MeshData broken = blockMesh(CellType::Tetrahedron, 2, 2, 2);
  broken.points[0] = std::numeric_limits<double>::quiet_NaN();
  rejected(toGrid(broken), wording("nan-or-infinite"));

  const auto ghosts = toGrid(blockMesh(CellType::Tetrahedron, 2, 2, 2));
  TAUTLINE_NEW(vtkUnsignedCharArray, flags, SetName(vtkDataSetAttributes::GhostArrayName()),
    SetNumberOfValues(ghosts->GetNumberOfCells()), Fill(0),
    SetValue(3, vtkDataSetAttributes::DUPLICATECELL));
  ghosts->GetCellData()->AddArray(flags);
  rejected(ghosts, wording("1-ghost-or-hidden-cells"));

  const auto regions = withArrays(blockMesh(CellType::Tetrahedron, 2, 2, 2));
  filter->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "absent");
  rejected(regions, "absent");
  TAUTLINE_NEW(vtkDoubleArray, holes, SetName("holes"),
    SetNumberOfValues(regions->GetNumberOfCells()), Fill(std::numeric_limits<double>::quiet_NaN()));
  regions->GetCellData()->AddArray(holes);
  filter->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "holes");
  rejected(regions, wording("is-nan-in-cell-0"));
  filter->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "None");

  messages.clear();
  filter->SetTargetAngle(61);
  TAUTLINE_CHECK(messages.has(wording("targetangle-is-61")));
}

/// Triangles beside the tetrahedra are left out with a warning; ids refer to the input.
TAUTLINE_PART(testSurfaceCells)
{
  const MeshData data = sliverBlock(3);
  TAUTLINE_LET(MeshData, mixed, points = data.points);
  mixed.addCell(CellType::Triangle, { 0, 1, 4 });
  for (Index i = 0; i < data.numberOfCells(); ++i)
  {
    const Index* v = &data.connectivity[data.offsets[i]];
    mixed.addCell(CellType::Tetrahedron, { v[0], v[1], v[2], v[3] });
  }
  vtkNew<vtkMeshImprover> filter, plain;
  Messages messages(filter);
  TAUTLINE_SET(filter, SetInputData(toGrid(mixed)), Update());
  TAUTLINE_SET(plain, SetInputData(toGrid(data)), Update());
  TAUTLINE_CHECK(messages.has(wording("1-triangles-beside-the-tetrahedra-are-left")));
  TAUTLINE_CHECK(messages.has(wording("that-triangles-mark-are-kept")));
  TAUTLINE_CHECK(
    !contains(filter->GetSummary(), wording("that-triangles-mark-and"))); // of the boundary
  TAUTLINE_CHECK_EQUAL(meshOf(filter)->GetNumberOfCells(), meshOf(plain)->GetNumberOfCells());
  TAUTLINE_EACH(Index, i, meshOf(filter)->GetNumberOfCells(),
    TAUTLINE_CHECK_EQUAL(component(meshOf(filter)->GetCellData(), "OriginalCellId", i),
      component(meshOf(plain)->GetCellData(), "OriginalCellId", i) + 1));
}

/// A facet inside the mesh that is lost without a mark stays where a triangle marks it.
TAUTLINE_PART(testMarkedFacet)
{
  const MeshData data = sliverBlock(3, 3, 1.0);
  const auto facetsOf = [](vtkUnstructuredGrid* mesh)
  {
    std::set<std::array<vtkIdType, 3>> facets;
    for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
    {
      const vtkIdType* v = nullptr;
      vtkIdType size = 0;
      mesh->GetCellPoints(cell, size, v);
      for (int k = 0; size == 4 && k < 4; ++k)
      {
        std::array<vtkIdType, 3> f = { v[(k + 1) % 4], v[(k + 2) % 4], v[(k + 3) % 4] };
        std::sort(f.begin(), f.end());
        facets.insert(f);
      }
    }
    return facets;
  };
  const auto improved = [&](const std::array<vtkIdType, 3>* marked, std::string* summary)
  {
    MeshData mixed = data;
    if (marked)
    {
      mixed.addCell(CellType::Triangle, { (*marked)[2], (*marked)[0], (*marked)[1] });
    }
    TAUTLINE_NEW(vtkMeshImprover, filter, SetInputData(toGrid(mixed)));
    filter->SetPreset(vtkMeshImprover::SWAP_ONLY); // the ids of points stay
    const Messages messages(filter);
    filter->Update();
    if (summary)
    {
      *summary = filter->GetSummary();
    }
    return facetsOf(vtkUnstructuredGrid::SafeDownCast(meshOf(filter)));
  };
  const auto before = facetsOf(toGrid(data)), after = improved(nullptr, nullptr);
  int lost = 0;
  for (const auto& facet : before)
  {
    if (after.count(facet) == 0)
    {
      ++lost;
      std::string summary;
      TAUTLINE_CHECK(improved(&facet, &summary).count(facet) == 1);
      TAUTLINE_CHECK(contains(summary, wording("that-triangles-mark-and-that-are-kept")));
    }
  }
  TAUTLINE_CHECK(lost > 5);
}

/// Each tetrahedron with points of its own: one mesh if merged, otherwise all facets are boundary.
TAUTLINE_PART(testSeams)
{
  const MeshData data = sliverBlock(3);
  MeshData pieces;
  for (Index i = 0; i < data.numberOfCells(); ++i)
  {
    const auto ids =
      collect<Index>(data.nodes(i), [&](Index node) { return pieces.addPoint(data.point(node)); });
    pieces.addCell(CellType::Tetrahedron, ids);
  }
  vtkNew<vtkMeshImprover> filter;
  Messages messages(filter);
  TAUTLINE_SET(filter, SetInputData(toGrid(pieces)), Update());
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK(filter->GetSmallestAngleAfter() > filter->GetSmallestAngleBefore());
  TAUTLINE_CHECK(meshOf(filter)->GetNumberOfPoints() < 2 * data.numberOfPoints());
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("one-point-in-place-of-each-group")));
  TAUTLINE_SET(filter, MergeCoincidentPointsOff(), Update());
  TAUTLINE_CHECK(dataOf(meshOf(filter)).points == pieces.points);
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("treated-as-boundary")));
}

/// Blocks one by one; empty data; single precision; a mirrored mesh.
TAUTLINE_PART(testInputs)
{
  vtkNew<vtkMeshImprover> filter;
  Messages messages(filter);
  vtkNew<vtkUnstructuredGrid> empty;
  TAUTLINE_SET(filter, SetInputData(empty), Update());
  TAUTLINE_CHECK(messages.has(wording("the-input-has-no-cells")));
  messages.clear();
  TAUTLINE_CHECK_EQUAL(meshOf(filter)->GetNumberOfCells(), 0);

  MeshData data = sliverBlock(3), apart = sliverBlock(4, 5);
  apart.transform([](const Vec3& p) { return p + Vec3{ 10, 0, 0 }; });
  TAUTLINE_NEW(vtkMultiBlockDataSet, blocks, SetBlock(0, toGrid(data, VTK_FLOAT)),
    SetBlock(1, empty), SetBlock(2, toGrid(apart)));
  TAUTLINE_SET(filter, SetInputData(blocks), Update());
  TAUTLINE_CHECK(messages.empty());
  auto* output = outputOf<vtkMultiBlockDataSet>(filter);
  auto* first = vtkUnstructuredGrid::SafeDownCast(output->GetBlock(0));
  auto* third = vtkUnstructuredGrid::SafeDownCast(output->GetBlock(2));
  TAUTLINE_CHECK_EQUAL(first->GetPoints()->GetDataType(), VTK_FLOAT);
  TAUTLINE_CHECK_EQUAL(third->GetPoints()->GetDataType(), VTK_DOUBLE);
  TAUTLINE_EACH_OF(signed char v, validityOf(dataOf(first)),
    TAUTLINE_CHECK_EQUAL(static_cast<int>(v), static_cast<int>(Valid)));
  TAUTLINE_CHECK_EQUAL(
    filter->GetElementsAfter(), first->GetNumberOfCells() + third->GetNumberOfCells());
  TAUTLINE_CHECK_EQUAL(filter->GetHistory()->GetValueByName(0, "Block").ToString(), "block 1");
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("in-block-3")));
  blocks->SetBlock(1, toGrid(blockMesh(CellType::Hexahedron, 1, 1, 1)));
  filter->Update();
  TAUTLINE_CHECK(messages.has(wording("in-block-2-1-hexahedra")));

  // The mirror image, cells not renumbered: reversed throughout.
  data.transform(TAUTLINE_PLACE(-p[0], p[1], p[2]));
  messages.clear();
  TAUTLINE_SET(filter, SetInputData(withArrays(data)), Update());
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("as-if-its-cells-were-flipped")));
  const MeshData mirrored = dataOf(meshOf(filter));
  TAUTLINE_CHECK_RELATIVE(volumeOf(mirrored), volumeOf(data), 1e-12);
  TAUTLINE_EACH(Index, i, mirrored.numberOfCells(), TAUTLINE_CHECK(volumeOf(mirrored, i) < 0));
}

/// An abort and the time limit return the best mesh so far.
TAUTLINE_PART(testStops)
{
  const MeshData data = sliverBlock(12);
  vtkNew<vtkMeshImprover> filter;
  Messages messages(filter);
  TAUTLINE_SET(filter, SetInputData(toGrid(data)), SetPreset(vtkMeshImprover::AGGRESSIVE));
  const auto observer = stopAt(filter, vtkCommand::ProgressEvent);
  const auto check = [&]()
  {
    const MeshData after = dataOf(meshOf(filter));
    TAUTLINE_CHECK_RELATIVE(volumeOf(after), volumeOf(data), 1e-12);
    TAUTLINE_CHECK(filter->GetSmallestAngleAfter() >= filter->GetSmallestAngleBefore());
    TAUTLINE_CHECK(filter->GetWorstAfter() <= filter->GetWorstBefore());
  };
  filter->Update();
  check();
  TAUTLINE_CHECK(contains(filter->GetReason(), wording("stopped-on-request-2")));
  TAUTLINE_SET(filter, RemoveObserver(observer), SetAbortExecute(0));
  filter->SetTargetAngle(60); // not to be reached
  TAUTLINE_SET(filter, SetTimeLimit(0.001), Update());
  check();
  TAUTLINE_CHECK(contains(filter->GetReason(), wording("time-limit")));
}
}
