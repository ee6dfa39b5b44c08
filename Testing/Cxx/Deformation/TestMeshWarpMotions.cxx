// SPDX-License-Identifier: BSD-3-Clause
// Warp Mesh: the paths of transforms, steps along them, and which part of the boundary they move.
#include "Registry.h"
#include "WarpingMeshes.h"
#include "tautline/Deformation/PointMotion.h"
#include "tautline/Mesh/BoundaryParts.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTransform.h"

using namespace tautline;

namespace
{
/// The point where another takes it, over the paths of all kinds of transforms.
TAUTLINE_PART(testPaths)
{
  const Index n = 5;
  const MeshData data = holedBlock(CellType::Triangle, n);
  const std::vector<int> parts = partsOf(data, n);
  const Vec3 middle = { 2.5, 2.5, 0 };
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);
  TAUTLINE_SET(filter, SetInputData(toGrid(data)), SetMethod(vtkMeshWarp::FEMWARP));
  const auto check = [&](const std::function<Vec3(const Vec3&)>& where)
  {
    filter->Update();
    TAUTLINE_CHECK(messages.empty());
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      const Vec3 p = data.point(i);
      if (parts[i])
      {
        const Vec3 expected = parts[i] == 2 ? where(p) : p;
        TAUTLINE_CHECK_NEAR(norm(pointOf(meshOf(filter), i) - expected), 0, 1e-13);
      }
    }
  };
  const auto turned = [](const Vec3& p, const Vec3& c, double degrees)
  {
    const double s = std::sin(degrees * Pi / 180), t = std::cos(degrees * Pi / 180);
    const Vec3 d = p - c;
    return Vec3{ c[0] + t * d[0] - s * d[1], c[1] + s * d[0] + t * d[1], p[2] };
  };
  for (double amount : { 0.25, 0.5, 1.0, 1.5 })
  {
    const Context context("amount " + std::to_string(amount));
    TAUTLINE_SET(filter, SetAmount(amount), SetTransformKind(vtkMeshWarp::ROTATION), SetAngle(40));
    check([&](const Vec3& p) { return turned(p, middle, 40 * amount); });
    TAUTLINE_SET(filter, SetTransformKind(vtkMeshWarp::TRANSLATION), SetTranslation(0.5, -0.25, 0));
    check([&](const Vec3& p) { return p + amount * Vec3{ 0.5, -0.25, 0 }; });
    TAUTLINE_SET(filter, SetTransformKind(vtkMeshWarp::SCALING), SetScaleFactors(1.5, 0.75, 1));
    check(TAUTLINE_PLACE(
      2.5 + (1 + 0.5 * amount) * (p[0] - 2.5), 2.5 + (1 - 0.25 * amount) * (p[1] - 2.5), 0));
    // The same turn about a point outside by a matrix: the way is an arc, not a chord.
    filter->SetTransformKind(vtkMeshWarp::MATRIX);
    TAUTLINE_NEW(vtkTransform, transform, Translate(2, 3, 0), RotateZ(30), Translate(-2, -3, 0));
    filter->SetTransform(transform);
    check([&](const Vec3& p) { return turned(p, { 2, 3, 0 }, 30 * amount); });
    // Changing the transform runs the filter again.
    TAUTLINE_SET(transform, Identity(), Translate(0.25, 0, 0));
    check([&](const Vec3& p) { return p + amount * Vec3{ 0.25, 0, 0 }; });
  }

  // Across a plane nothing counts: an interactive box around a flat mesh scales by 0 there.
  for (double across : { 0.0, -1.0, 1e-9 })
  {
    TAUTLINE_NEW(vtkTransform, transform, RotateZ(40), Scale(1, 1, across));
    TAUTLINE_SET(filter, SetAmount(0.5), SetTransform(transform));
    check([&](const Vec3& p) { return turned(p, { 0, 0, 0 }, 20); });
  }

  // All kinds of matrices arrive where they should.
  const MeshData solid = holedBlock(CellType::Tetrahedron, 3);
  std::vector<unsigned char> all(solid.numberOfPoints(), 1);
  Random random(5);
  for (int round = 0; round < 50; ++round)
  {
    TAUTLINE_NEW(vtkTransform, transform, Translate(random.vector(-3, 3).data()),
      RotateWXYZ(random.uniform(-180, 180), random.vector(-1, 1).data()),
      Scale(random.vector(0.1, 3).data()));
    PointMotion motion;
    std::copy_n(transform->GetMatrix()->GetData(), 16, motion.matrix.begin());
    const auto d =
      displacements(motion, 1, solid.numberOfPoints(), solid.points.data(), all.data());
    double largest = 0;
    for (Index i = 0; i < solid.numberOfPoints(); ++i)
    {
      Vec3 x = solid.point(i);
      transform->TransformPoint(x.data(), x.data());
      largest =
        std::max(largest, norm(x - solid.point(i) - Vec3{ d[3 * i], d[3 * i + 1], d[3 * i + 2] }));
    }
    TAUTLINE_CHECK(largest < 1e-12);
  }
}

/// A bar bends into an arc: its axis keeps its length, its sections stay straight, its end is held.
TAUTLINE_PART(testBending)
{
  MeshData data = blockMesh(CellType::Quadrilateral, 20, 2, 0);
  data.transform(TAUTLINE_PLACE(p[0], p[1] - 1, 0));
  const double radius = 20 / (Pi / 2);
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);
  TAUTLINE_SET(
    filter, SetInputData(toGrid(data)), SetTransformKind(vtkMeshWarp::BENDING), SetAngle(180));
  for (double amount : { 0.5, 1e-7 })
  {
    TAUTLINE_SET(filter, SetAmount(amount), Update());
    TAUTLINE_CHECK(messages.empty());
    TAUTLINE_CHECK_EQUAL(filter->GetInverted(), 0);
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      const Vec3 p = data.point(i), q = pointOf(meshOf(filter), i);
      if (std::abs(p[1]) == 1 && amount == 0.5)
      {
        const double t = p[0] / radius, r = radius - p[1];
        TAUTLINE_CHECK_NEAR(
          norm(q - Vec3{ r * std::sin(t), radius - r * std::cos(t), 0 }), 0, 1e-12);
      }
      TAUTLINE_CHECK(p[0] > 0 || norm(q - p) < 1e-14 || std::abs(p[1]) < 1);
      TAUTLINE_CHECK(amount > 1e-3 || norm(q - p) < 1e-4);
    }
  }
  // Held at a point on the way, what is before stays; a full turn and more is ordinary.
  TAUTLINE_LET(PointMotion, motion, kind = MotionKind::Bending, angle = 720, ownCenter = false);
  motion.center = { 8, 0, 0 };
  const std::vector<unsigned char> all(data.numberOfPoints(), 1);
  const auto d = displacements(motion, 1, data.numberOfPoints(), data.points.data(), all.data());
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 p = data.point(i), v = { d[3 * i], d[3 * i + 1], d[3 * i + 2] };
    TAUTLINE_CHECK(p[0] > 8 || norm(v) == 0);
    TAUTLINE_CHECK(p[0] < 20 || p[1] != 0 || norm(p + v - Vec3{ 8, 0, 0 }) < 1e-12);
  }
}

/// Steps of a transform follow its path; and so do displacements that turn a part.
TAUTLINE_PART(testSteps)
{
  const MeshData data = holedBlock(CellType::Triangle, 15);
  const std::vector<int> parts = partsOf(data, 15);
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);
  auto grid = toGrid(data);
  grid->GetPointData()->AddArray(arrayOf("d", data.numberOfPoints(), 3,
    [&](Index i, int k) { return parts[i] == 2 && k < 2 ? 15 - 2 * data.point(i)[k] : 0.0; }));
  TAUTLINE_SET(filter, SetInputData(grid), SetMethod(vtkMeshWarp::SMALL_STEP_FEMWARP), SetSteps(20),
    SetTransformKind(vtkMeshWarp::ROTATION), SetAngle(180), Update());
  const MeshData turned = withPointsOf(data, meshOf(filter));
  const vtkIdType byArc = filter->GetInverted();
  TAUTLINE_SET(filter, SetMotion(vtkMeshWarp::DISPLACEMENT),
    SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "d"), Update());
  TAUTLINE_CHECK_EQUAL(filter->GetInverted(), byArc);
  TAUTLINE_CHECK(distance(turned, withPointsOf(data, meshOf(filter))) < 1e-10);

  // Two turns in steps end where none does, for the boundary; the interior is wound up.
  const MeshData wound = [&]
  {
    TAUTLINE_SET(filter, SetMotion(vtkMeshWarp::TRANSFORM), SetSteps(100), SetAngle(720), Update());
    return withPointsOf(data, meshOf(filter));
  }();
  double inside = 0, boundary = 0;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    double& largest = parts[i] ? boundary : inside;
    largest = std::max(largest, norm(wound.point(i) - data.point(i)));
  }
  TAUTLINE_CHECK(boundary < 1e-12 && inside > 0.1);
  filter->SetAngle(180);

  // As many steps as it takes, and no further than it goes: a warning, and numbers in the tables.
  filter->SetSteps(0);
  messages.clear();
  filter->Update();
  const double amount = value(filter->GetStatistics(), "Amount");
  TAUTLINE_CHECK_EQUAL(filter->GetInverted(), 0);
  TAUTLINE_CHECK(amount > 0.1 && amount < 1);
  TAUTLINE_CHECK(messages.has(wording("of-the-motion")));
  filter->SetAmount(0.5 * amount);
  messages.clear();
  filter->Update();
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK_NEAR(value(filter->GetStatistics(), "Amount"), 0.5 * amount, 1e-12);
}

vtkSmartPointer<vtkSelection> select(int field, const std::vector<Index>& ids)
{
  vtkNew<vtkIdTypeArray> list;
  for (Index id : ids)
  {
    list->InsertNextValue(id);
  }
  TAUTLINE_NEW(vtkSelectionNode, node, SetContentType(vtkSelectionNode::INDICES),
    SetFieldType(field), SetSelectionList(list));
  return TAUTLINE_CHANGED(vtkSmartPointer<vtkSelection>::New(), AddNode(node));
}

/// Which points move by each choice, and which stay.
TAUTLINE_PART(testParts)
{
  const Index n = 7;
  const MeshData data = holedBlock(CellType::Triangle, n);
  const std::vector<int> parts = partsOf(data, n);
  auto grid = toGrid(data);
  grid->GetPointData()->AddArray(
    arrayOf("marker", data.numberOfPoints(), 1, [&](Index i, int) { return double(parts[i]); }));
  grid->GetPointData()->AddArray(arrayOf("right", data.numberOfPoints(), 1,
    [&](Index i, int) { return double(data.point(i)[0] == double(n)); }));
  grid->GetPointData()->AddArray(arrayOf("inner", data.numberOfPoints(), 1,
    [&](Index i, int) { return double(parts[i] == 0 && data.point(i)[1] == 1); }));
  grid->GetCellData()->AddArray(
    arrayOf("cells", data.numberOfCells(), 1, [](Index i, int) { return double(i == 0 ? 5 : 0); }));
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);
  TAUTLINE_SET(filter, SetInputData(grid), SetTransformKind(vtkMeshWarp::TRANSLATION),
    SetTranslation(0.125, 0.0625, 0));
  const auto moves = [&](const std::function<bool(Index)>& which)
  {
    filter->Update();
    TAUTLINE_CHECK(messages.empty());
    messages.clear();
    Index wrong = 0;
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      const Vec3 d = pointOf(meshOf(filter), i) - data.point(i);
      const Vec3 expected = which(i) ? Vec3{ 0.125, 0.0625, 0 } : Vec3{ 0, 0, 0 };
      wrong += parts[i] && norm(d - expected) > 1e-14;
    }
    TAUTLINE_CHECK_EQUAL(wrong, 0);
  };
  moves([&](Index i) { return parts[i] == 2; });
  filter->SetMovedPart(vtkMeshWarp::INNER_BOUNDARIES);
  moves([&](Index i) { return parts[i] == 2; });
  filter->SetMovedPart(vtkMeshWarp::WHOLE_BOUNDARY);
  moves([&](Index i) { return parts[i] != 0; });
  TAUTLINE_SET(filter, SetMovedPart(vtkMeshWarp::NUMBERED_PARTS), AddPart(1));
  moves([&](Index i) { return parts[i] == 1; });
  filter->AddPart(2);
  moves([&](Index i) { return parts[i] != 0; });
  TAUTLINE_SET(filter, AddPart(3), Update());
  TAUTLINE_CHECK(messages.has(wording("there-is-no-boundary-part-3-there")));
  TAUTLINE_SET(filter, RemoveAllParts(), Update());
  TAUTLINE_CHECK(messages.has(wording("no-boundary-part-is-given")));
  messages.clear();

  TAUTLINE_SET(filter, SetMovedPart(vtkMeshWarp::ARRAY_VALUES), Update());
  TAUTLINE_CHECK(messages.has(wording("no-array-is-chosen-for-the-part")));
  messages.clear();
  const auto points = vtkDataObject::FIELD_ASSOCIATION_POINTS;
  filter->SetInputArrayToProcess(1, 0, 0, points, "marker");
  moves([&](Index i) { return parts[i] != 0; });
  filter->AddValue(2);
  moves([&](Index i) { return parts[i] == 2; });
  TAUTLINE_SET(filter, RemoveAllValues(), SetInputArrayToProcess(1, 0, 0, points, "right"));
  moves([&](Index i) { return data.point(i)[0] == double(n); });
  filter->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "cells");
  moves(
    [&](Index i) {
      return std::find(&data.connectivity[0], &data.connectivity[3], i) != &data.connectivity[3];
    });
  TAUTLINE_SET(filter, SetInputArrayToProcess(1, 0, 0, points, "inner"), Update());
  TAUTLINE_CHECK(messages.has(wording("points-chosen-to-move-none-is-on")));
  TAUTLINE_SET(filter, SetInputArrayToProcess(1, 0, 0, points, "nothing"), Update());
  TAUTLINE_CHECK(messages.has(wording("there-is-no-point-array-nothing")));
  messages.clear();

  TAUTLINE_SET(filter, SetMovedPart(vtkMeshWarp::SELECTION), Update());
  TAUTLINE_CHECK(messages.has(wording("nothing-is-selected-that-could-move")));
  messages.clear();
  filter->SetInputData(2, select(vtkSelectionNode::POINT, { 3, 4, 30 }));
  moves([](Index i) { return i == 3 || i == 4 || i == 30; });
  filter->SetInputData(2, select(vtkSelectionNode::CELL, { 0 }));
  moves(
    [&](Index i) {
      return std::find(&data.connectivity[0], &data.connectivity[3], i) != &data.connectivity[3];
    });

  // Fixed points stay: on the boundary and inside.
  filter->SetMovedPart(vtkMeshWarp::WHOLE_BOUNDARY);
  filter->SetInputArrayToProcess(2, 0, 0, points, "right");
  moves([&](Index i) { return parts[i] != 0 && data.point(i)[0] < double(n); });
  filter->SetInputArrayToProcess(2, 0, 0, points, "inner");
  filter->SetInputData(3, select(vtkSelectionNode::POINT, { 0 }));
  moves([&](Index i) { return parts[i] != 0 && i != 0; });
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    if (parts[i] == 0 && data.point(i)[1] == 1)
    {
      TAUTLINE_CHECK(pointOf(meshOf(filter), i) == data.point(i));
    }
  }
}

/// Two components with a hole each: four parts, by size; each component has an outer part.
TAUTLINE_PART(testBoundaryParts)
{
  for (CellType type :
    { CellType::Triangle, CellType::Quadrilateral, CellType::Tetrahedron, CellType::Hexahedron })
  {
    const Context context(topology(type).name);
    const MeshData large = holedBlock(type, 7), small = holedBlock(type, 5);
    MeshData both = small;
    const Index shift = small.numberOfPoints();
    for (Index i = 0; i < large.numberOfPoints(); ++i)
    {
      both.addPoint(large.point(i) + Vec3{ 20, 0, 0 });
    }
    for (Index cell = 0; cell < large.numberOfCells(); ++cell)
    {
      std::vector<Index> nodes = large.nodes(cell);
      for (Index& node : nodes)
      {
        node += shift;
      }
      both.addCell(type, nodes);
    }
    const BoundaryParts parts = boundaryParts(Mesh(both.view()));
    TAUTLINE_CHECK_EQUAL(parts.parts, 4);
    TAUTLINE_CHECK((parts.outer == std::vector<char>{ 1, 1, 0, 0 }));
    const std::vector<int> ofSmall = partsOf(small, 5), ofLarge = partsOf(large, 7);
    // Two holes have one size; the hole of the smaller block, which is numbered first, is first.
    Index wrong = 0;
    for (Index i = 0; i < both.numberOfPoints(); ++i)
    {
      const bool first = i < shift;
      const int part = first ? ofSmall[i] : ofLarge[i - shift];
      const int expected = part == 0 ? 0 : part == 1 ? (first ? 2 : 1) : (first ? 3 : 4);
      wrong += parts.part[i] != expected;
    }
    TAUTLINE_CHECK_EQUAL(wrong, 0);
  }
}

/// The time steps of an animation are fractions of the way, of which all is gone without a request.
TAUTLINE_PART(testAnimation)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  const Index n = 5;
  const MeshData data = holedBlock(CellType::Triangle, n);
  const std::vector<int> parts = partsOf(data, n);
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);
  TAUTLINE_SET(filter, SetInputData(toGrid(data)), SetMethod(vtkMeshWarp::FEMWARP),
    SetTransformKind(vtkMeshWarp::ROTATION), SetAngle(40), SetAmount(0.5), UpdateInformation());
  TAUTLINE_CHECK(!filter->GetOutputInformation(0)->Has(Pipeline::TIME_STEPS()));
  TAUTLINE_SET(filter, SetAnimation(true), SetAnimationSteps(4), UpdateInformation());
  vtkInformation* info = filter->GetOutputInformation(0);
  TAUTLINE_CHECK_EQUAL(info->Length(Pipeline::TIME_STEPS()), 5);
  for (int i = 0; i <= 4; ++i)
  {
    TAUTLINE_CHECK_EQUAL(info->Get(Pipeline::TIME_STEPS())[i], 0.25 * i);
  }
  const auto check = [&](double degrees)
  {
    const double s = std::sin(degrees * Pi / 180), t = std::cos(degrees * Pi / 180);
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      const Vec3 d = data.point(i) - Vec3{ 2.5, 2.5, 0 };
      const Vec3 turned = { 2.5 + t * d[0] - s * d[1], 2.5 + s * d[0] + t * d[1], 0 };
      TAUTLINE_CHECK(parts[i] != 2 || norm(pointOf(meshOf(filter), i) - turned) < 1e-13);
    }
  };
  filter->Update();
  check(20);
  for (double time : { 0.25, 0.0, 1.0, 0.75 })
  {
    filter->UpdateTimeStep(time);
    check(20 * time);
    TAUTLINE_CHECK_EQUAL(
      meshOf(filter)->GetInformation()->Get(vtkDataObject::DATA_TIME_STEP()), time);
    TAUTLINE_CHECK_NEAR(value(filter->GetStatistics(), "Amount"), 0.5 * time, 1e-15);
    // The matrices come from the first execution; at rest none are needed.
    TAUTLINE_CHECK_EQUAL(filter->GetReused(), time > 0 ? 1 : 0);
  }
  TAUTLINE_CHECK(messages.empty());
}
}
