// SPDX-License-Identifier: BSD-3-Clause
// Warp Mesh: what is rejected, by name; boundaries that intersect themselves, and other cells.
#include "Registry.h"
#include "WarpingMeshes.h"
#include "vtkDataSetSurfaceFilter.h"
#include "vtkSphereSource.h"
#include "vtkTransform.h"

using namespace tautline;

namespace
{
constexpr auto OnPoints = vtkDataObject::FIELD_ASSOCIATION_POINTS;

/// Wedges, and surfaces in space whose hole moves out of its plane; a motion of nothing is stated.
TAUTLINE_PART(testAllKinds)
{
  for (const CellType type : { CellType::Wedge, CellType::Triangle, CellType::Quadrilateral })
  {
    const Context context(topology(type).name);
    MeshData data = holedBlock(type, 5);
    if (type != CellType::Wedge)
    {
      data.transform(TAUTLINE_PLACE(p[0], p[1], 0.1 * p[0] * p[1]));
    }
    for (const int method : { vtkMeshWarp::HYBRID, vtkMeshWarp::FEMWARP, vtkMeshWarp::AUTOMATIC,
           vtkMeshWarp::INVERSE_DISTANCE_ROTATIONS, vtkMeshWarp::JACOBIAN_STIFFENING })
    {
      vtkNew<vtkMeshWarp> filter;
      Messages messages(filter);
      TAUTLINE_SET(filter, SetInputData(toGrid(data)), SetMethod(method),
        SetTransformKind(vtkMeshWarp::TRANSLATION), SetTranslation(0.1, 0.05, 0.1), Update());
      TAUTLINE_CHECK(messages.empty());
      TAUTLINE_CHECK_EQUAL(filter->GetInverted(), 0);
      TAUTLINE_CHECK_EQUAL(value(filter->GetStatistics(), "Elements"), data.numberOfCells());
      TAUTLINE_CHECK(value(filter->GetStatistics(), "Moved points") > 0);
      TAUTLINE_SET(filter, SetTranslation(0, 0, 0), Update());
      TAUTLINE_CHECK(messages.empty());
      TAUTLINE_CHECK(contains(filter->GetSummary(), wording("no-point-of-the-boundary-moves")));
    }
  }
}

/// Unsupported inputs, with the reason.
TAUTLINE_PART(testRejections)
{
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);
  TAUTLINE_SET(filter, SetTransformKind(vtkMeshWarp::TRANSLATION), SetTranslation(0.1, 0, 0));
  const auto rejected = [&](vtkDataObject* input, const char* text)
  {
    const Context context(text);
    messages.clear();
    TAUTLINE_SET(filter, SetInputData(input), Update());
    TAUTLINE_CHECK(messages.has(text));
    auto* output = outputOf(filter);
    TAUTLINE_CHECK(!output || output->GetNumberOfPoints() == 0);
    TAUTLINE_CHECK(std::string(filter->GetSummary()).empty());
  };
  const MeshData data = blockMesh(CellType::Triangle, 4, 4, 0);
  TAUTLINE_NEW(vtkImageData, image, SetDimensions(3, 3, 3));
  rejected(image, wording("image-data-to-point-set"));
  MeshData wrong = TAUTLINE_CHANGED(data, setPoint(6, { 2.5, 2.6, 0 }));
  rejected(toGrid(wrong), wording("run-untangle-mesh-first"));
  wrong = TAUTLINE_CHANGED(data, points[7] = std::numeric_limits<double>::quiet_NaN());
  rejected(toGrid(wrong), wording("1-points-have-a-coordinate-that-is"));
  wrong = TAUTLINE_CHANGED(data, addCell(VTK_POLYGON, { 0, 1, 2, 3, 4 }));
  rejected(toGrid(wrong), wording("1-polygons-polyhedra-or-other-cells-that"));
  wrong = TAUTLINE_CHANGED(MeshData(), points = data.points);
  wrong.addCell(VTK_LAGRANGE_TRIANGLE, { 0, 2, 10, 1 });
  rejected(toGrid(wrong), wording("the-vtk-type-69-with-4-nodes"));
  wrong = TAUTLINE_CHANGED(MeshData(), points = data.points);
  wrong.addCell(VTK_VERTEX, { 0 });
  rejected(toGrid(wrong), wording("there-is-no-element"));
  TAUTLINE_NEW(vtkSphereSource, sphere, Update());
  rejected(sphere->GetOutput(), wording("no-boundary"));
  filter->SetTranslation(0.1, 0, 0.1);
  rejected(toGrid(data), wording("lead-out-of-its-plane"));
  TAUTLINE_SET(filter, SetTransformKind(vtkMeshWarp::ROTATION), SetAxis(0, 0, 0));
  rejected(toGrid(data), wording("the-axis-of-the-motion-has-no"));
  TAUTLINE_SET(filter, SetTransformKind(vtkMeshWarp::SCALING), SetScaleFactors(1, 0, 1));
  rejected(toGrid(data), wording("a-scale-factor-is-not-positive"));
  TAUTLINE_SET(filter, SetTransformKind(vtkMeshWarp::BENDING), SetAxis(1, 0, 0));
  rejected(toGrid(data), wording("lies-along-the-axis"));
  filter->SetTransformKind(vtkMeshWarp::MATRIX);
  TAUTLINE_NEW(vtkTransform, mirror, Scale(-1, 1, 1));
  filter->SetTransform(mirror);
  rejected(toGrid(data), wording("mirrors-or-flattens"));

  // Arrays of displacements.
  filter->SetMotion(vtkMeshWarp::DISPLACEMENT);
  auto grid = toGrid(data);
  rejected(grid, wording("no-array-of-displacements-is-chosen"));
  filter->SetInputArrayToProcess(0, 0, 0, OnPoints, "d");
  rejected(grid, wording("there-is-no-point-array-d-of"));
  grid->GetPointData()->AddArray(
    arrayOf("d", data.numberOfPoints(), 1, [](Index, int) { return 0; }));
  rejected(grid, wording("the-array-d-has-1-components"));
  auto d = arrayOf("d", data.numberOfPoints(), 3,
    [](Index i, int) { return i == 2 || i == 6 || i == 24 ? std::nan("") : 0.01; });
  for (int k = 2; k < 3 * data.numberOfPoints(); k += 3)
  {
    d->SetValue(k, 0);
  }
  grid->GetPointData()->AddArray(d);
  rejected(grid, wording("the-array-d-is-nan-or-infinite"));
  TAUTLINE_SET(d, SetComponent(2, 0, 0.01), SetComponent(2, 1, 0.01), SetComponent(24, 0, 0.01),
    SetComponent(24, 1, 0.01));
  messages.clear();
  d->Modified();
  filter->Update(); // what is inside is not read
  TAUTLINE_CHECK(messages.empty());
  grid->GetPointData()->AddArray(
    arrayOf("d", data.numberOfPoints(), 2, [](Index, int k) { return k ? 0.25 : 0.5; }));
  filter->Update();
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK(norm(pointOf(meshOf(filter), 6) - data.point(6) - Vec3{ 0.5, 0.25, 0 }) < 1e-12);

  // Coefficients.
  filter->SetCoefficients(vtkMeshWarp::PER_CELL);
  rejected(grid, wording("no-array-of-coefficients-is-chosen"));
  filter->SetInputArrayToProcess(3, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "c");
  grid->GetCellData()->AddArray(
    arrayOf("c", data.numberOfCells(), 2, [](Index, int) { return 1; }));
  rejected(grid, wording("the-array-c-has-2-components"));
  grid->GetCellData()->AddArray(
    arrayOf("c", data.numberOfCells(), 3, [](Index, int) { return -1; }));
  rejected(grid, wording("cell-0-of-the-mesh-are-not"));
  // The cell of the input, also with a vertex.
  MeshData more = data;
  more.types.insert(more.types.begin(), VTK_VERTEX);
  more.connectivity.insert(more.connectivity.begin(), 0);
  std::for_each(more.offsets.begin(), more.offsets.end(), [](Index& at) { ++at; });
  more.offsets.insert(more.offsets.begin(), 0);
  const auto withVertex = toGrid(more);
  withVertex->GetPointData()->ShallowCopy(grid->GetPointData());
  const auto values = [](Index i, int) { return i == 0 || i == 4 ? -1 : 1; };
  withVertex->GetCellData()->AddArray(arrayOf("c", more.numberOfCells(), 3, values));
  rejected(withVertex, wording("the-coefficients-of-cell-4-of-the"));
  filter->SetCoefficients(vtkMeshWarp::PER_REGION);
  rejected(grid, wording("no-array-of-regions-is-chosen"));

  vtkNew<vtkUnstructuredGrid> empty;
  messages.clear();
  TAUTLINE_SET(filter, SetInputData(empty), Update());
  TAUTLINE_CHECK(messages.has(wording("the-input-has-no-cells")));
}

/// A moved boundary that intersects itself: a warning with numbers, and the best mesh.
TAUTLINE_PART(testImpossible)
{
  const MeshData data = holedBlock(CellType::Triangle, 7);
  const std::vector<int> parts = partsOf(data, 7);
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);
  TAUTLINE_SET(filter, SetInputData(toGrid(data)), SetTransformKind(vtkMeshWarp::TRANSLATION));
  filter->SetTranslation(3.5, 0, 0); // the hole crosses the outer boundary
  filter->Update();
  TAUTLINE_CHECK(filter->GetInverted() > 0);
  TAUTLINE_CHECK(messages.has(std::to_string(filter->GetInverted()) + " of "));
  TAUTLINE_CHECK(value(filter->GetStatistics(), "Crossings") > 0);
  const MeshData after = withPointsOf(data, meshOf(filter));
  const auto validity = validityOf(after);
  TAUTLINE_CHECK_EQUAL(filter->GetInverted(),
    data.numberOfCells() - std::count(validity.begin(), validity.end(), Valid));
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    TAUTLINE_CHECK(
      parts[i] != 2 || norm(after.point(i) - data.point(i) - Vec3{ 3.5, 0, 0 }) < 1e-14);
    TAUTLINE_CHECK(std::isfinite(norm(after.point(i))));
  }
  TAUTLINE_CHECK(
    std::isfinite(meshOf(filter)->GetCellData()->GetArray("TMP shape")->GetRange()[1]));
}

/// Points of ghost cells stay, and cells that carry no shape go along.
TAUTLINE_PART(testOtherCells)
{
  MeshData data = blockMesh(CellType::Triangle, 6, 6, 0);
  TAUTLINE_SET(data, addCell(VTK_LINE, { 0, 1 }), addCell(VTK_VERTEX, { 24 }));
  const Index lonely = data.addPoint({ 9, 9, 0 });
  auto grid = toGrid(data);
  const auto ghosts = filledArray<vtkUnsignedCharArray>(vtkDataSetAttributes::GhostArrayName(),
    data.numberOfCells(),
    [&](Index cell) { return cell >= 60 && cell < 72 ? vtkDataSetAttributes::DUPLICATECELL : 0; });
  grid->GetCellData()->AddArray(ghosts);
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);

  TAUTLINE_SET(filter, SetInputData(grid), SetTransformKind(vtkMeshWarp::TRANSLATION),
    SetTranslation(0, -0.5, 0), Update());
  TAUTLINE_CHECK(messages.empty());
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 p = data.point(i), step = pointOf(meshOf(filter), i) - p;
    const bool stays = p[1] >= 5 || i == lonely;
    TAUTLINE_CHECK(!stays || norm(step) == 0);
    TAUTLINE_CHECK(p[1] > 0 || norm(step - Vec3{ 0, -0.5, 0 }) < 1e-14);
    TAUTLINE_CHECK(i != 24 || norm(step) > 0.1);
  }

  // A volume with the triangles of its surface, as mesh generators write them: as without.
  const MeshData solid = holedBlock(CellType::Tetrahedron, 5);
  TAUTLINE_NEW(vtkDataSetSurfaceFilter, surface, SetInputData(toGrid(solid)),
    PassThroughPointIdsOn(), Update());
  vtkDataArray* ids = surface->GetOutput()->GetPointData()->GetArray("vtkOriginalPointIds");
  TAUTLINE_LET(MeshData, both, points = solid.points);
  for (vtkIdType cell = 0; cell < surface->GetOutput()->GetNumberOfCells(); ++cell)
  {
    std::vector<Index> nodes;
    for (int k = 0; k < 3; ++k)
    {
      const vtkIdType point = surface->GetOutput()->GetCell(cell)->GetPointId(k);
      nodes.push_back(static_cast<Index>(ids->GetComponent(point, 0)));
    }
    both.addCell(CellType::Triangle, nodes);
  }
  const Index triangles = both.numberOfCells();
  for (Index cell = 0; cell < solid.numberOfCells(); ++cell)
  {
    both.addCell(CellType::Tetrahedron,
      std::vector<Index>(&solid.connectivity[4 * cell], &solid.connectivity[4 * cell] + 4));
  }
  vtkNew<vtkMeshWarp> mixed, plain;
  Messages more(mixed);
  for (vtkMeshWarp* each : { mixed.Get(), plain.Get() })
  {
    const bool withTriangles = each == mixed;
    auto input = toGrid(withTriangles ? both : solid);
    input->GetCellData()->AddArray(arrayOf("c", input->GetNumberOfCells(), 1,
      [&](Index i, int) { return 1.0 + double((withTriangles ? i - triangles : i) % 3); }));
    TAUTLINE_SET(each, SetInputData(input), SetTransformKind(vtkMeshWarp::ROTATION), SetAngle(30),
      SetCoefficients(vtkMeshWarp::PER_CELL),
      SetInputArrayToProcess(3, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "c"), Update());
  }
  TAUTLINE_CHECK(more.empty());
  TAUTLINE_CHECK(
    withPointsOf(solid, meshOf(mixed)).points == withPointsOf(solid, meshOf(plain)).points);
  TAUTLINE_CHECK_EQUAL(value(mixed->GetStatistics(), "Elements"), solid.numberOfCells());
}
}
