// Warp Mesh: motions of the boundary, what is exact, what is kept between executions, what comes out.
#include "WarpingMeshes.h"

#include "tautline/PointMotion.h"
#include "tautline/Warp.h"

#include "vtkCellData.h"
#include "vtkIdTypeArray.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkSelection.h"
#include "vtkSelectionNode.h"
#include "vtkTransform.h"

using namespace tautline;

namespace
{
constexpr double Pi = 3.14159265358979323846;
constexpr CellType warpedTypes[] = { CellType::Triangle, CellType::Quadrilateral,
  CellType::Tetrahedron, CellType::Hexahedron };

/// An affine motion in the plane of the mesh, if it has one.
Vec3 affine(const Vec3& p, bool flat)
{
  return { 1.3 * p[0] + 0.2 * p[1] - 1, -0.4 * p[0] + 0.8 * p[1] + 2,
    flat ? 0.0 : 0.1 * p[0] + 1.1 * p[2] + 0.5 };
}

/// Where all points are after an affine motion; the hole of a mesh moves along.
MeshData affinely(const MeshData& data)
{
  const bool flat = topology(CellType(data.types[0])).dimension == 2;
  MeshData moved = data;
  moved.transform([flat](const Vec3& p) { return affine(p, flat); });
  return moved;
}

vtkSmartPointer<vtkDoubleArray> motionTo(const char* name, const MeshData& from, const MeshData& to)
{
  return arrayOf(name, from.numberOfPoints(), 3,
    [&](Index i, int k) { return to.point(i)[k] - from.point(i)[k]; });
}

/// Proposition 4: every method that solves equations, every choice of coefficients.
void testAffine()
{
  for (CellType type : warpedTypes)
  {
    const Context context(topology(type).name);
    const MeshData data = shuffled(movedBlock(type, topology(type).dimension == 2 ? 6 : 4, 0.2), 3);
    const MeshData expected = affinely(data);
    auto grid = toGrid(data);
    grid->GetPointData()->AddArray(motionTo("d", data, expected));
    grid->GetCellData()->AddArray(arrayOf("c", data.numberOfCells(), 6,
      [](Index i, int k) { return k < 3 ? 1.0 + double((7 * i + k) % 5) : 0.3; }));
    grid->GetCellData()->AddArray(
      arrayOf("region", data.numberOfCells(), 1, [](Index i, int) { return double(i % 3); }));
    vtkNew<vtkMeshWarp> filter;
    Messages messages(filter);
    filter->SetInputData(grid);
    filter->SetMotion(vtkMeshWarp::DISPLACEMENT);
    filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "d");
    filter->SetInputArrayToProcess(3, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "c");
    filter->SetInputArrayToProcess(4, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "region");
    filter->SetTensor(2, 1, 4, 0.5, 0, 0.1);
    filter->AddRegion(0, 1, 5, 2);
    filter->AddRegion(2, 3, 1, 1);
    const auto check = [&](const std::string& what, double tolerance)
    {
      const Context inner(what);
      filter->Update();
      TAUTLINE_CHECK(messages.empty());
      TAUTLINE_CHECK(distance(withPointsOf(data, meshOf(filter)), expected) < tolerance);
      TAUTLINE_CHECK_EQUAL(filter->GetInverted(), 0);
    };
    for (int method = vtkMeshWarp::HYBRID; method <= vtkMeshWarp::WEIGHTED_LAPLACIAN; ++method)
    {
      filter->SetMethod(method);
      // The second step of Hybrid goes on from an affine motion that changes shapes; a material that is not uniform
      // does not follow it.
      if (method != vtkMeshWarp::HYBRID && method != vtkMeshWarp::JACOBIAN_STIFFENING)
      {
        check("method " + std::to_string(method), 1e-10);
      }
    }
    filter->SetMethod(vtkMeshWarp::ANISOTROPIC_FEMWARP);
    for (int choice = 0; choice <= vtkMeshWarp::PER_REGION; ++choice)
    {
      filter->SetCoefficients(choice);
      check("coefficients " + std::to_string(choice), 1e-10);
    }
  }
}

/// The point where another takes it, over the paths of all kinds of transforms.
void testPaths()
{
  const Index n = 5;
  const MeshData data = holedBlock(CellType::Triangle, n);
  const std::vector<int> parts = partsOf(data, n);
  const Vec3 middle = { 2.5, 2.5, 0 };
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);
  filter->SetInputData(toGrid(data));
  filter->SetMethod(vtkMeshWarp::FEMWARP);
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
    filter->SetAmount(amount);
    filter->SetTransformKind(vtkMeshWarp::ROTATION);
    filter->SetAngle(40);
    check([&](const Vec3& p) { return turned(p, middle, 40 * amount); });
    filter->SetTransformKind(vtkMeshWarp::TRANSLATION);
    filter->SetTranslation(0.5, -0.25, 0);
    check([&](const Vec3& p) { return p + amount * Vec3{ 0.5, -0.25, 0 }; });
    filter->SetTransformKind(vtkMeshWarp::SCALING);
    filter->SetScaleFactors(1.5, 0.75, 1);
    check(
      [&](const Vec3& p)
      {
        return Vec3{ 2.5 + (1 + 0.5 * amount) * (p[0] - 2.5),
          2.5 + (1 - 0.25 * amount) * (p[1] - 2.5), 0 };
      });
    // The same turn about a point outside by a matrix: the way is an arc about that point, not a chord.
    filter->SetTransformKind(vtkMeshWarp::MATRIX);
    vtkNew<vtkTransform> transform;
    transform->Translate(2, 3, 0);
    transform->RotateZ(30);
    transform->Translate(-2, -3, 0);
    filter->SetTransform(transform);
    check([&](const Vec3& p) { return turned(p, { 2, 3, 0 }, 30 * amount); });
    // Changing the transform runs the filter again.
    transform->Identity();
    transform->Translate(0.25, 0, 0);
    check([&](const Vec3& p) { return p + amount * Vec3{ 0.25, 0, 0 }; });
  }

  // Across a plane nothing counts: an interactive box around a flat mesh scales by 0 there.
  for (double across : { 0.0, -1.0, 1e-9 })
  {
    vtkNew<vtkTransform> transform;
    transform->RotateZ(40);
    transform->Scale(1, 1, across);
    filter->SetAmount(0.5);
    filter->SetTransform(transform);
    check([&](const Vec3& p) { return turned(p, { 0, 0, 0 }, 20); });
  }

  // All kinds of matrices arrive where they should.
  const MeshData solid = holedBlock(CellType::Tetrahedron, 3);
  std::vector<unsigned char> all(solid.numberOfPoints(), 1);
  Random random(5);
  for (int round = 0; round < 50; ++round)
  {
    vtkNew<vtkTransform> transform;
    transform->Translate(random.vector(-3, 3).data());
    transform->RotateWXYZ(random.uniform(-180, 180), random.vector(-1, 1).data());
    transform->Scale(random.vector(0.1, 3).data());
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
void testBending()
{
  MeshData data = blockMesh(CellType::Quadrilateral, 20, 2, 0);
  data.transform([](const Vec3& p) { return Vec3{ p[0], p[1] - 1, 0 }; });
  const double radius = 20 / (Pi / 2);
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);
  filter->SetInputData(toGrid(data));
  filter->SetTransformKind(vtkMeshWarp::BENDING);
  filter->SetAngle(180);
  for (double amount : { 0.5, 1e-7 })
  {
    filter->SetAmount(amount);
    filter->Update();
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
  // Held at a point on the way, what is before does not move; a full turn and more is a motion like any other.
  PointMotion motion;
  motion.kind = MotionKind::Bending;
  motion.angle = 720;
  motion.ownCenter = false;
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

/// 0 is the input, bit by bit; also in single precision, and with errors for what is wrong.
void testAmountZero()
{
  for (int precision : { VTK_DOUBLE, VTK_FLOAT })
  {
    const MeshData data = movedBlock(CellType::Tetrahedron, 3, 0.2);
    auto grid = toGrid(data, precision);
    vtkNew<vtkMeshWarp> filter;
    filter->SetInputData(grid);
    filter->SetAmount(0);
    filter->SetTransformKind(vtkMeshWarp::ROTATION);
    filter->SetAngle(77);
    filter->Update();
    TAUTLINE_CHECK(
      withPointsOf(data, meshOf(filter)).points == withPointsOf(data, grid.Get()).points);
    TAUTLINE_CHECK_EQUAL(meshOf(filter)->GetPoints()->GetDataType(), precision);
    TAUTLINE_CHECK_EQUAL(component(meshOf(filter)->GetPointData(), "Displacement", 5, 2), 0);
    TAUTLINE_CHECK(meshOf(filter)->GetCellData()->GetArray("TMP shape")->GetRange()[1] < 1e-12);
    TAUTLINE_CHECK_EQUAL(filter->GetHistory()->GetNumberOfRows(), 1);
    filter->SetAmount(1);
    filter->Update();
    TAUTLINE_CHECK_EQUAL(meshOf(filter)->GetPoints()->GetDataType(), precision);
    TAUTLINE_CHECK(component(meshOf(filter)->GetPointData(), "Displacement", 5, 1) != 0);
  }
}

/// The arrays and tables say what the kernel says.
void testOutputs()
{
  const MeshData data = holedBlock(CellType::Tetrahedron, 5);
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);
  auto grid = toGrid(data);
  grid->GetPointData()->AddArray(
    arrayOf("kept", data.numberOfPoints(), 1, [](Index i, int) { return double(i); }));
  filter->SetInputData(grid);
  filter->SetTransformKind(vtkMeshWarp::ROTATION);
  filter->SetAxis(1, 1, 1);
  filter->SetAngle(50);
  filter->Update();
  TAUTLINE_CHECK(messages.empty());
  const MeshData after = withPointsOf(data, meshOf(filter));
  const Mesh rest(data.view());

  const auto boundary = rest.boundary().isBoundaryPoint;
  const std::vector<unsigned char> prescribed(boundary.begin(), boundary.end());
  const std::vector<int> parts = partsOf(data, 5);
  std::vector<unsigned char> hole(parts.size());
  std::transform(parts.begin(), parts.end(), hole.begin(), [](int part) { return part == 2; });
  PointMotion motion;
  motion.kind = MotionKind::Rotation;
  motion.axis = { 1, 1, 1 };
  motion.angle = 50;
  const auto d = displacements(motion, 1, data.numberOfPoints(), data.points.data(), hole.data());
  WarpOptions options;
  options.prescribed = prescribed.data();
  const Warping expected = Warper(rest, options).warp(d.data());
  TAUTLINE_CHECK(after.points == expected.points);

  const std::vector<double> shape = shapeSimilarity(rest, after.points.data());
  const auto validity = validityOf(after);
  double worst = 0;
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    TAUTLINE_CHECK_EQUAL(
      component(meshOf(filter)->GetCellData(), "Validity", cell), validity[cell]);
    TAUTLINE_CHECK_NEAR(
      component(meshOf(filter)->GetCellData(), "TMP shape", cell), shape[cell], 1e-12);
    worst = std::max(worst, shape[cell]);
  }
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    TAUTLINE_CHECK_EQUAL(component(meshOf(filter)->GetPointData(), "Displacement", i, 1),
      after.point(i)[1] - data.point(i)[1]);
    TAUTLINE_CHECK_EQUAL(component(meshOf(filter)->GetPointData(), "kept", i), i);
  }
  TAUTLINE_CHECK_NEAR(filter->GetWorstShape(), worst, 1e-12);
  vtkTable* statistics = filter->GetStatistics();
  TAUTLINE_CHECK_EQUAL(statistics->GetNumberOfRows(), 1);
  TAUTLINE_CHECK_EQUAL(value(statistics, "Elements"), data.numberOfCells());
  TAUTLINE_CHECK_EQUAL(
    value(statistics, "Boundary points"), std::count(boundary.begin(), boundary.end(), 1));
  TAUTLINE_CHECK_EQUAL(
    value(statistics, "Moved points"), 6); // of the corners of a cube; two are on the axis
  TAUTLINE_CHECK_NEAR(value(statistics, "Worst shape"), worst, 1e-12);
  const auto imr = valuesOf(after, Metric::InverseMeanRatio);
  TAUTLINE_CHECK_NEAR(
    value(statistics, "Worst IMR"), *std::max_element(imr.begin(), imr.end()), 1e-12);
  TAUTLINE_CHECK_EQUAL(value(statistics, "Cxx"), expected.tensor[0]);
  vtkTable* history = filter->GetHistory();
  TAUTLINE_CHECK_EQUAL(history->GetNumberOfRows(), Index(expected.history.size()));
  for (Index row = 0; row < history->GetNumberOfRows(); ++row)
  {
    TAUTLINE_CHECK_EQUAL(
      history->GetValueByName(row, "Stage").ToString(), expected.history[row].stage);
    TAUTLINE_CHECK_EQUAL(value(history, "Inverted", row), expected.history[row].inverted);
  }
  TAUTLINE_CHECK(contains(filter->GetSummary(), "elements are valid"));

  std::vector<double> first;
  for (int threads : { 1, 2, 3 })
  {
    filter->SetThreads(threads);
    filter->Update();
    TAUTLINE_CHECK(withPointsOf(data, meshOf(filter)).points == after.points);
  }
}

/// Matrices are kept as long as mesh, given points and options are the same, whatever object holds them.
void testReuse()
{
  const MeshData data = holedBlock(CellType::Tetrahedron, 7);
  const std::vector<int> parts = partsOf(data, 7);
  const Index inner = std::find(parts.begin(), parts.end(), 0) - parts.begin();
  auto grid = toGrid(data);
  grid->GetPointData()->AddArray(arrayOf(
    "stay", data.numberOfPoints(), 1, [inner](Index i, int) { return double(i == inner); }));
  vtkNew<vtkMeshWarp> filter;
  const Messages warnings(filter); // FEMWARP inverts some, which is not what is asked here
  filter->SetInputData(grid);
  filter->SetMethod(vtkMeshWarp::FEMWARP);
  filter->SetTransformKind(vtkMeshWarp::ROTATION);
  filter->SetAngle(60);
  const auto run = [&]
  {
    filter->Update();
    return filter->GetReused();
  };
  TAUTLINE_CHECK_EQUAL(run(), 0);
  TAUTLINE_CHECK(value(filter->GetStatistics(), "Set-up (s)") > 0);
  for (double amount : { 0.2, 0.4, 0.6, 0.8 })
  {
    filter->SetAmount(amount);
    TAUTLINE_CHECK_EQUAL(run(), 1);
    TAUTLINE_CHECK_EQUAL(value(filter->GetStatistics(), "Reused"), 1);
    TAUTLINE_CHECK_EQUAL(value(filter->GetStatistics(), "Set-up (s)"), 0);
    TAUTLINE_CHECK_EQUAL(value(filter->GetStatistics(), "Assemble (s)"), 0);
  }
  vtkNew<vtkMeshWarp> fresh;
  fresh->SetInputData(grid);
  fresh->SetMethod(vtkMeshWarp::FEMWARP);
  fresh->SetTransformKind(vtkMeshWarp::ROTATION);
  fresh->SetAngle(60);
  fresh->SetAmount(0.8);
  fresh->Update();
  TAUTLINE_CHECK(
    distance(withPointsOf(data, meshOf(fresh)), withPointsOf(data, meshOf(filter))) < 1e-13);

  filter->SetTransformKind(vtkMeshWarp::TRANSLATION);
  filter->SetTranslation(0.5, 0, 0);
  TAUTLINE_CHECK_EQUAL(run(), 1); // another motion of the same points
  filter->SetInputData(toGrid(data));
  TAUTLINE_CHECK_EQUAL(run(), 1); // another object with the same mesh
  filter->SetMethod(vtkMeshWarp::BIHARMONIC);
  TAUTLINE_CHECK_EQUAL(run(), 0);
  filter->SetMethod(vtkMeshWarp::FEMWARP);
  filter->SetInputData(grid);
  TAUTLINE_CHECK_EQUAL(run(), 0);
  filter->SetInputArrayToProcess(2, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "stay");
  TAUTLINE_CHECK_EQUAL(run(), 0); // another point is given
  grid->GetPoints()->SetPoint(0, -1e-3, 0, 0);
  grid->GetPoints()->Modified();
  grid->Modified();
  TAUTLINE_CHECK_EQUAL(run(), 0); // the same object with other points
  filter->SetAmount(0.5);
  TAUTLINE_CHECK_EQUAL(run(), 1);
}

vtkSmartPointer<vtkSelection> select(int field, const std::vector<Index>& ids)
{
  vtkNew<vtkIdTypeArray> list;
  for (Index id : ids)
  {
    list->InsertNextValue(id);
  }
  vtkNew<vtkSelectionNode> node;
  node->SetContentType(vtkSelectionNode::INDICES);
  node->SetFieldType(field);
  node->SetSelectionList(list);
  auto selection = vtkSmartPointer<vtkSelection>::New();
  selection->AddNode(node);
  return selection;
}

/// Which points move by each choice, and which stay.
void testParts()
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
  filter->SetInputData(grid);
  filter->SetTransformKind(vtkMeshWarp::TRANSLATION);
  filter->SetTranslation(0.125, 0.0625, 0);
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
  filter->SetMovedPart(vtkMeshWarp::NUMBERED_PARTS);
  filter->AddPart(1);
  moves([&](Index i) { return parts[i] == 1; });
  filter->AddPart(2);
  moves([&](Index i) { return parts[i] != 0; });
  filter->AddPart(3);
  filter->Update();
  TAUTLINE_CHECK(messages.has("There is no boundary part 3: there are parts 1 to 2"));
  filter->RemoveAllParts();
  filter->Update();
  TAUTLINE_CHECK(messages.has("No boundary part is given"));
  messages.clear();

  filter->SetMovedPart(vtkMeshWarp::ARRAY_VALUES);
  filter->Update();
  TAUTLINE_CHECK(messages.has("No array is chosen that tells what moves"));
  messages.clear();
  const auto points = vtkDataObject::FIELD_ASSOCIATION_POINTS;
  filter->SetInputArrayToProcess(1, 0, 0, points, "marker");
  moves([&](Index i) { return parts[i] != 0; });
  filter->AddValue(2);
  moves([&](Index i) { return parts[i] == 2; });
  filter->RemoveAllValues();
  filter->SetInputArrayToProcess(1, 0, 0, points, "right");
  moves([&](Index i) { return data.point(i)[0] == double(n); });
  filter->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "cells");
  moves(
    [&](Index i) {
      return std::find(&data.connectivity[0], &data.connectivity[3], i) != &data.connectivity[3];
    });
  filter->SetInputArrayToProcess(1, 0, 0, points, "inner");
  filter->Update();
  TAUTLINE_CHECK(messages.has("points chosen to move none is on the boundary"));
  filter->SetInputArrayToProcess(1, 0, 0, points, "nothing");
  filter->Update();
  TAUTLINE_CHECK(messages.has("There is no point array 'nothing'"));
  messages.clear();

  filter->SetMovedPart(vtkMeshWarp::SELECTION);
  filter->Update();
  TAUTLINE_CHECK(messages.has("Nothing is selected that could move"));
  messages.clear();
  filter->SetInputData(2, select(vtkSelectionNode::POINT, { 3, 4, 30 }));
  moves([](Index i) { return i == 3 || i == 4 || i == 30; });
  filter->SetInputData(2, select(vtkSelectionNode::CELL, { 0 }));
  moves(
    [&](Index i) {
      return std::find(&data.connectivity[0], &data.connectivity[3], i) != &data.connectivity[3];
    });

  // What stays, stays: on the boundary and inside.
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

/// Hybrid keeps shapes: a motion that changes none of them comes out exactly.
void testSimilarity()
{
  for (CellType type : warpedTypes)
  {
    const Context context(topology(type).name);
    const bool flat = topology(type).dimension == 2;
    const MeshData data = shuffled(movedBlock(type, flat ? 8 : 4, 0.2), 3);
    vtkNew<vtkTransform> transform;
    transform->Translate(3, -2, flat ? 0 : 1);
    transform->RotateWXYZ(170, 0, 0, 1);
    transform->Scale(2, 2, 2);
    vtkNew<vtkMeshWarp> filter;
    Messages messages(filter);
    filter->SetInputData(toGrid(data));
    filter->SetTransform(transform);
    filter->Update();
    TAUTLINE_CHECK(messages.empty());
    MeshData expected = data;
    expected.transform(
      [&](Vec3 p)
      {
        transform->TransformPoint(p.data(), p.data());
        return Vec3{ p[0], p[1], flat ? 0 : p[2] };
      });
    TAUTLINE_CHECK(distance(withPointsOf(data, meshOf(filter)), expected) < 1e-10);
    TAUTLINE_CHECK(filter->GetWorstShape() < 1e-10);
  }
}

/// Steps of a transform follow its path; displacements that turn a part do so, too.
void testSteps()
{
  const MeshData data = holedBlock(CellType::Triangle, 15);
  const std::vector<int> parts = partsOf(data, 15);
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);
  auto grid = toGrid(data);
  grid->GetPointData()->AddArray(arrayOf("d", data.numberOfPoints(), 3,
    [&](Index i, int k) { return parts[i] == 2 && k < 2 ? 15 - 2 * data.point(i)[k] : 0.0; }));
  filter->SetInputData(grid);
  filter->SetMethod(vtkMeshWarp::SMALL_STEP_FEMWARP);
  filter->SetSteps(20);
  filter->SetTransformKind(vtkMeshWarp::ROTATION);
  filter->SetAngle(180);
  filter->Update();
  const MeshData turned = withPointsOf(data, meshOf(filter));
  const vtkIdType byArc = filter->GetInverted();
  filter->SetMotion(vtkMeshWarp::DISPLACEMENT);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "d");
  filter->Update();
  TAUTLINE_CHECK_EQUAL(filter->GetInverted(), byArc);
  TAUTLINE_CHECK(distance(turned, withPointsOf(data, meshOf(filter))) < 1e-10);

  // Two turns in steps end where none does, for the boundary; what is between is wound up.
  const MeshData wound = [&]
  {
    filter->SetMotion(vtkMeshWarp::TRANSFORM);
    filter->SetSteps(100);
    filter->SetAngle(720);
    filter->Update();
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

  // As many steps as it takes, and no further than it goes: a warning, and by how much in the tables.
  filter->SetSteps(0);
  messages.clear();
  filter->Update();
  const double amount = value(filter->GetStatistics(), "Amount");
  TAUTLINE_CHECK_EQUAL(filter->GetInverted(), 0);
  TAUTLINE_CHECK(amount > 0.1 && amount < 1);
  TAUTLINE_CHECK(messages.has("% of the motion"));
  filter->SetAmount(0.5 * amount);
  messages.clear();
  filter->Update();
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK_NEAR(value(filter->GetStatistics(), "Amount"), 0.5 * amount, 1e-12);
}

/// A mesh reversed throughout warps as its mirror image; blocks on their own.
void testBlocks()
{
  const MeshData data = holedBlock(CellType::Tetrahedron, 5);
  MeshData reversed = data;
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    std::swap(reversed.connectivity[4 * cell], reversed.connectivity[4 * cell + 1]);
  }
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, toGrid(data));
  blocks->SetBlock(2, toGrid(reversed, VTK_FLOAT));
  vtkNew<vtkUnstructuredGrid> empty;
  blocks->SetBlock(3, empty);
  vtkNew<vtkMeshWarp> filter, single;
  Messages messages(filter);
  for (vtkMeshWarp* each : { filter.Get(), single.Get() })
  {
    each->SetTransformKind(vtkMeshWarp::ROTATION);
    each->SetAngle(40);
    each->SetMethod(vtkMeshWarp::FEMWARP);
  }
  filter->SetInputData(blocks);
  single->SetInputData(toGrid(data));
  single->Update();
  filter->Update();
  TAUTLINE_CHECK(messages.empty());
  auto* output = vtkMultiBlockDataSet::SafeDownCast(filter->GetOutputDataObject(0));
  const MeshData expected = withPointsOf(data, meshOf(single));
  const auto at = [&](unsigned int i) { return vtkPointSet::SafeDownCast(output->GetBlock(i)); };
  TAUTLINE_CHECK(withPointsOf(data, at(0)).points == expected.points);
  TAUTLINE_CHECK(distance(withPointsOf(data, at(2)), expected) < 1e-6);
  TAUTLINE_CHECK_EQUAL(at(2)->GetPoints()->GetDataType(), VTK_FLOAT);
  TAUTLINE_CHECK_EQUAL(at(3)->GetNumberOfPoints(), 0);
  TAUTLINE_CHECK_EQUAL(filter->GetStatistics()->GetNumberOfRows(), 2);
  TAUTLINE_CHECK_EQUAL(filter->GetStatistics()->GetValueByName(1, "Block").ToString(), "block 3");
  TAUTLINE_CHECK(contains(filter->GetSummary(), "In block 1: FEMWARP: all"));
  TAUTLINE_CHECK(contains(filter->GetSummary(), "It is treated as if its cells were flipped"));
  filter->SetAmount(0.5);
  filter->Update();
  TAUTLINE_CHECK_EQUAL(filter->GetReused(), 2);
}
}

//------------------------------------------------------------------------------
int TestMeshWarp(int, char*[])
{
  testAffine();
  testPaths();
  testBending();
  testAmountZero();
  testOutputs();
  testReuse();
  testParts();
  testSimilarity();
  testSteps();
  testBlocks();
  return exitCode();
}
