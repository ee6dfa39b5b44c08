// SPDX-License-Identifier: BSD-3-Clause
// Warp Mesh to a target: which of its points belong to which, and the closest ones.
#include "Registry.h"
#include "WarpingMeshes.h"
#include "vtkDataSetSurfaceFilter.h"
#include "vtkFeatureEdges.h"
#include "vtkLineSource.h"
#include "vtkSphereSource.h"
#include "vtkTransform.h"
#include "vtkTransformFilter.h"

using namespace tautline;

namespace
{
constexpr auto OnPoints = vtkDataObject::FIELD_ASSOCIATION_POINTS;

/// The boundary turned and shifted, given in every way: the same result; the summary names the way.
TAUTLINE_PART(testTargets)
{
  for (CellType type : { CellType::Triangle, CellType::Tetrahedron })
  {
    const Context context(topology(type).name);
    const bool flat = type == CellType::Triangle;
    const MeshData data = shuffled(holedBlock(type, 5), 11);
    auto grid = toGrid(data);
    grid->GetPointData()->AddArray(arrayOf(
      "id", data.numberOfPoints(), 1, [](Index i, int) { return 1000.0 - 3.0 * double(i); }));
    TAUTLINE_NEW(
      vtkTransform, transform, Translate(0.25, 0.125, flat ? 0 : 0.5), Scale(1.25, 0.75, 1));
    const auto moved = [&transform](vtkDataSet* what)
    {
      TAUTLINE_NEW(vtkTransformFilter, filter, SetInputData(what), SetTransform(transform),
        SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION), Update());
      return vtkSmartPointer<vtkPointSet>(filter->GetOutput());
    };
    MeshData expected = data;
    expected.transform(
      [&transform](Vec3 p)
      {
        transform->TransformPoint(p.data(), p.data());
        return p;
      });
    vtkNew<vtkMeshWarp> filter;
    Messages messages(filter);
    TAUTLINE_SET(
      filter, SetInputData(grid), SetMotion(vtkMeshWarp::TARGET), SetMethod(vtkMeshWarp::FEMWARP));
    const auto check = [&](vtkDataSet* target, const char* how)
    {
      const Context inner(how);
      TAUTLINE_SET(filter, SetInputData(1, target), Update());
      TAUTLINE_CHECK(messages.empty());
      messages.clear();
      TAUTLINE_CHECK(contains(filter->GetSummary(), how));
      TAUTLINE_CHECK(distance(withPointsOf(data, meshOf(filter)), expected) < 1e-10);
    };
    check(moved(grid), "as the same mesh");
    TAUTLINE_NEW(
      vtkDataSetSurfaceFilter, surface, SetInputData(grid), PassThroughPointIdsOn(), Update());
    check(moved(surface->GetOutput()), "as the boundary extracted from the mesh");
    vtkNew<vtkFeatureEdges> edges;
    if (flat)
    {
      TAUTLINE_SET(edges, SetInputConnection(surface->GetOutputPort()), Update());
      check(moved(edges->GetOutput()), "as the boundary extracted from the mesh");
    }

    // The points alone, of those that move; and the boundary's cells among all points.
    const auto boundary = Mesh(data.view()).boundary().isBoundaryPoint;
    vtkNew<vtkPolyData> cloud, inMesh;
    TAUTLINE_NEW(vtkPoints, places, SetDataTypeToDouble());
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      if (boundary[i])
      {
        places->InsertNextPoint(data.point(i).data());
      }
    }
    cloud->SetPoints(places);
    filter->SetMovedPart(vtkMeshWarp::WHOLE_BOUNDARY);
    check(moved(cloud), "by the order of the points that move");
    filter->SetCorrespondence(vtkMeshWarp::SAME_BOUNDARY);
    check(moved(cloud), "by the order of the points that move");
    filter->SetMovedPart(vtkMeshWarp::AUTOMATIC_PART);
    filter->Update(); // that is the hole where nothing else distinguishes the parts
    TAUTLINE_CHECK(messages.has(wording("choose-another-correspondence")));
    messages.clear();
    filter->SetCorrespondence(vtkMeshWarp::AUTOMATIC_MATCH);

    // By ids: numbers of points, or values of the array of the same name.
    vtkPolyData* skin = surface->GetOutput();
    filter->SetTargetIds("vtkOriginalPointIds");
    check(moved(skin), "by point ids");
    filter->SetTargetIds("id");
    check(moved(skin), "by point ids");
    skin->GetPointData()->GetArray("id")->SetComponent(3, 0, -7);
    TAUTLINE_SET(filter, SetInputData(1, moved(skin)), Update());
    TAUTLINE_CHECK(messages.has(wording("has-1-values-that-are-no-values")));
    TAUTLINE_SET(filter, SetTargetIds("missing"), Update());
    TAUTLINE_CHECK(messages.has(wording("the-target-has-no-point-array-missing")));
    messages.clear();
    TAUTLINE_SET(filter, SetTargetIds("None"), SetCorrespondence(vtkMeshWarp::POINT_IDS), Update());
    TAUTLINE_CHECK(messages.has(wording("no-array-of-point-ids-is-chosen")));
    TAUTLINE_SET(filter, SetCorrespondence(vtkMeshWarp::SAME_MESH), Update());
    TAUTLINE_CHECK(flat || messages.has(wording("it-is-not-the-same-mesh")));
  }
}

/// The boundary goes to the closest point; the summary has the maximum distance.
TAUTLINE_PART(testProjection)
{
  const Index n = 5;
  const MeshData data = holedBlock(CellType::Tetrahedron, n);
  const std::vector<int> parts = partsOf(data, n);
  TAUTLINE_NEW(vtkSphereSource, sphere, SetCenter(2.5, 2.5, 2.5), SetRadius(1),
    SetThetaResolution(60), SetPhiResolution(60), Update());
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);
  TAUTLINE_SET(filter, SetInputData(toGrid(data)), SetMotion(vtkMeshWarp::TARGET),
    SetInputConnection(1, sphere->GetOutputPort()), Update());
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK_EQUAL(filter->GetInverted(), 0);
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 p = pointOf(meshOf(filter), i), c = { 2.5, 2.5, 2.5 };
    TAUTLINE_CHECK(parts[i] != 2 || std::abs(norm(p - c) - 1) < 3e-3);
    TAUTLINE_CHECK(parts[i] != 1 || p == data.point(i));
  }
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("by-projection-8-points")));
  TAUTLINE_CHECK(
    contains(filter->GetSummary(), wording("the-farthest-of-them-0-13"))); // 1 - sqrt(3) / 2
  TAUTLINE_CHECK_NEAR(
    value(filter->GetStatistics(), "Largest displacement"), 1 - std::sqrt(0.75), 3e-3);

  // A block of one data set is that data set; a volume stands for its surface.
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(1, toGrid(movedBlock(CellType::Hexahedron, 5, 0)));
  TAUTLINE_SET(filter, SetInputConnection(1, nullptr), SetInputData(1, blocks),
    SetCorrespondence(vtkMeshWarp::CLOSEST_POINT), SetMovedPart(vtkMeshWarp::WHOLE_BOUNDARY),
    SetAmount(0.25), Update());
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("the-farthest-of-them-2-0")));
  TAUTLINE_CHECK_NEAR(value(filter->GetStatistics(), "Largest displacement"), 0.5, 1e-12);
  blocks->SetBlock(2, toGrid(data));
  filter->Update();
  TAUTLINE_CHECK(messages.has(wording("the-target-has-several-blocks-and-the")));
  messages.clear();

  // In the plane it is a curve.
  const MeshData square = blockMesh(CellType::Triangle, 4, 4, 0);
  TAUTLINE_NEW(vtkLineSource, line, SetPoint1(4.5, -1, 0), SetPoint2(4.5, 5, 0), Update());
  vtkNew<vtkMeshWarp> planar;
  Messages others(planar);
  auto grid = toGrid(square);
  grid->GetPointData()->AddArray(arrayOf("right", square.numberOfPoints(), 1,
    [&](Index i, int) { return double(square.point(i)[0] == 4); }));
  TAUTLINE_SET(planar, SetInputData(grid), SetMotion(vtkMeshWarp::TARGET),
    SetMethod(vtkMeshWarp::FEMWARP), SetMovedPart(vtkMeshWarp::ARRAY_VALUES),
    SetInputArrayToProcess(1, 0, 0, OnPoints, "right"), SetInputData(1, line->GetOutput()),
    Update());
  TAUTLINE_CHECK(others.empty());
  for (Index i = 0; i < square.numberOfPoints(); ++i)
  {
    const Vec3 p = square.point(i), q = pointOf(meshOf(planar), i);
    TAUTLINE_CHECK(p[0] < 4 || norm(q - p - Vec3{ 0.5, 0, 0 }) < 1e-7);
    TAUTLINE_CHECK(p[0] > 0 || q == p);
  }
  vtkNew<vtkPolyData> cloud;
  TAUTLINE_NEW(vtkPoints, one, InsertNextPoint(0, 0, 0));
  cloud->SetPoints(one);
  TAUTLINE_SET(planar, SetInputData(1, cloud), Update());
  TAUTLINE_CHECK(others.has(wording("the-target-has-no-curve-the-boundary")));
  others.clear();
  vtkNew<vtkPolyData> nothing;
  TAUTLINE_SET(planar, SetInputData(1, nothing), Update());
  TAUTLINE_CHECK(others.has(wording("the-target-is-empty")));
  others.clear();
  TAUTLINE_SET(planar, SetInputData(1, nullptr), Update());
  TAUTLINE_CHECK(others.has(wording("there-is-no-target")));
}
}
