// SPDX-License-Identifier: BSD-3-Clause
// Warp Mesh: what is exact, what is kept between executions, what comes out.
#include "Registry.h"
#include "WarpingMeshes.h"
#include "tautline/Deformation/PointMotion.h"
#include "tautline/Deformation/Warp.h"
#include "tautline/Deformation/WarpQuality.h"
#include "vtkTransform.h"

using namespace tautline;

namespace
{
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
TAUTLINE_PART(testAffine)
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
    TAUTLINE_SET(filter, SetInputData(grid), SetMotion(vtkMeshWarp::DISPLACEMENT),
      SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "d"),
      SetInputArrayToProcess(3, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "c"),
      SetInputArrayToProcess(4, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "region"),
      SetTensor(2, 1, 4, 0.5, 0, 0.1), AddRegion(0, 1, 5, 2), AddRegion(2, 3, 1, 1));
    const auto check = [&](const std::string& what, double tolerance)
    {
      const Context inner(what);
      filter->Update();
      TAUTLINE_CHECK(messages.empty());
      TAUTLINE_CHECK(distance(withPointsOf(data, meshOf(filter)), expected) < tolerance);
      TAUTLINE_CHECK_EQUAL(filter->GetInverted(), 0);
    };
    for (int method = vtkMeshWarp::HYBRID; method <= vtkMeshWarp::AUTOMATIC; ++method)
    {
      filter->SetMethod(method);
      // The second step of Hybrid goes on from an affine motion that changes shapes; a material
      // that is not uniform does not follow it, nor do rigid motions of the wall.
      if (method != vtkMeshWarp::HYBRID && method != vtkMeshWarp::JACOBIAN_STIFFENING &&
        method != vtkMeshWarp::INVERSE_DISTANCE_ROTATIONS)
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

/// 0 is the input, bit by bit; also in single precision, and with errors for what is wrong.
TAUTLINE_PART(testAmountZero)
{
  for (int precision : { VTK_DOUBLE, VTK_FLOAT })
  {
    const MeshData data = movedBlock(CellType::Tetrahedron, 3, 0.2);
    auto grid = toGrid(data, precision);
    TAUTLINE_NEW(vtkMeshWarp, filter, SetInputData(grid), SetAmount(0),
      SetTransformKind(vtkMeshWarp::ROTATION), SetAngle(77), Update());
    TAUTLINE_CHECK(
      withPointsOf(data, meshOf(filter)).points == withPointsOf(data, grid.Get()).points);
    TAUTLINE_CHECK_EQUAL(meshOf(filter)->GetPoints()->GetDataType(), precision);
    TAUTLINE_CHECK_EQUAL(component(meshOf(filter)->GetPointData(), "Displacement", 5, 2), 0);
    TAUTLINE_CHECK(meshOf(filter)->GetCellData()->GetArray("TMP shape")->GetRange()[1] < 1e-12);
    TAUTLINE_CHECK_EQUAL(filter->GetHistory()->GetNumberOfRows(), 1);
    TAUTLINE_SET(filter, SetAmount(1), Update());
    TAUTLINE_CHECK_EQUAL(meshOf(filter)->GetPoints()->GetDataType(), precision);
    TAUTLINE_CHECK(component(meshOf(filter)->GetPointData(), "Displacement", 5, 1) != 0);
  }
}

/// The arrays and tables agree with the kernel.
TAUTLINE_PART(testOutputs)
{
  const MeshData data = holedBlock(CellType::Tetrahedron, 5);
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);
  auto grid = toGrid(data);
  grid->GetPointData()->AddArray(
    arrayOf("kept", data.numberOfPoints(), 1, [](Index i, int) { return double(i); }));
  TAUTLINE_SET(filter, SetInputData(grid), SetTransformKind(vtkMeshWarp::ROTATION),
    SetAxis(1, 1, 1), SetAngle(50), Update());
  TAUTLINE_CHECK(messages.empty());
  const MeshData after = withPointsOf(data, meshOf(filter));
  const Mesh rest(data.view());

  const auto boundary = rest.boundary().isBoundaryPoint;
  const std::vector<unsigned char> prescribed(boundary.begin(), boundary.end());
  const std::vector<int> parts = partsOf(data, 5);
  std::vector<unsigned char> hole(parts.size());
  std::transform(parts.begin(), parts.end(), hole.begin(), [](int part) { return part == 2; });
  TAUTLINE_LET(PointMotion, motion, kind = MotionKind::Rotation);
  motion.axis = { 1, 1, 1 };
  motion.angle = 50;
  const auto d = displacements(motion, 1, data.numberOfPoints(), data.points.data(), hole.data());
  TAUTLINE_CHECK_EQUAL(
    filter->GetMaximumIterations(), hybridOptimization().stopping.maximumIterations);
  TAUTLINE_LET(WarpOptions, options, prescribed = prescribed.data());
  const WarpResult expected = Warper(rest, options).warp(d.data());
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
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("elements-are-valid")));

  std::vector<double> first;
  for (int threads : { 1, 2, 3 })
  {
    TAUTLINE_SET(filter, SetThreads(threads), Update());
    TAUTLINE_CHECK(withPointsOf(data, meshOf(filter)).points == after.points);
  }
}

/// Matrices are kept as long as mesh, given points and options are the same in any object.
TAUTLINE_PART(testReuse)
{
  const MeshData data = holedBlock(CellType::Tetrahedron, 7);
  const std::vector<int> parts = partsOf(data, 7);
  const Index inner = std::find(parts.begin(), parts.end(), 0) - parts.begin();
  auto grid = toGrid(data);
  grid->GetPointData()->AddArray(arrayOf(
    "stay", data.numberOfPoints(), 1, [inner](Index i, int) { return double(i == inner); }));
  vtkNew<vtkMeshWarp> filter;
  const Messages warnings(filter); // FEMWARP inverts some, which is not checked here
  TAUTLINE_SET(filter, SetInputData(grid), SetMethod(vtkMeshWarp::FEMWARP),
    SetTransformKind(vtkMeshWarp::ROTATION), SetAngle(60));
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
  TAUTLINE_NEW(vtkMeshWarp, fresh, SetInputData(grid), SetMethod(vtkMeshWarp::FEMWARP),
    SetTransformKind(vtkMeshWarp::ROTATION), SetAngle(60), SetAmount(0.8), Update());
  TAUTLINE_CHECK(
    distance(withPointsOf(data, meshOf(fresh)), withPointsOf(data, meshOf(filter))) < 1e-13);

  TAUTLINE_SET(filter, SetTransformKind(vtkMeshWarp::TRANSLATION), SetTranslation(0.5, 0, 0));
  TAUTLINE_CHECK_EQUAL(run(), 1); // another motion of the same points
  filter->SetInputData(toGrid(data));
  TAUTLINE_CHECK_EQUAL(run(), 1); // another object with the same mesh
  auto mine = toGrid(data);
  auto d = arrayOf("d", data.numberOfPoints(), 3, [](Index, int) { return 0.1; });
  mine->GetPointData()->AddArray(d);
  TAUTLINE_SET(filter, SetInputData(mine), SetMotion(vtkMeshWarp::DISPLACEMENT),
    SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "d"));
  TAUTLINE_CHECK_EQUAL(run(), 1);
  d->FillComponent(1, 0.2); // in place, as a solver that moves its boundary does
  d->Modified();
  mine->Modified();
  TAUTLINE_CHECK_EQUAL(run(), 1);
  TAUTLINE_CHECK_NEAR(pointOf(meshOf(filter), inner)[1] - data.point(inner)[1], 0.16, 1e-12);
  TAUTLINE_SET(filter, SetMotion(vtkMeshWarp::TRANSFORM), SetMethod(vtkMeshWarp::BIHARMONIC));
  TAUTLINE_CHECK_EQUAL(run(), 0);
  TAUTLINE_SET(filter, SetMethod(vtkMeshWarp::FEMWARP), SetInputData(grid));
  TAUTLINE_CHECK_EQUAL(run(), 0);
  filter->SetInputArrayToProcess(2, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "stay");
  TAUTLINE_CHECK_EQUAL(run(), 0); // another point is given
  TAUTLINE_SET(grid, GetPoints()->SetPoint(0, -1e-3, 0, 0), GetPoints()->Modified(), Modified());
  TAUTLINE_CHECK_EQUAL(run(), 0); // the same object with other points
  filter->SetAmount(0.5);
  TAUTLINE_CHECK_EQUAL(run(), 1);
}

/// Hybrid keeps shapes: a motion that changes none of them comes out exactly.
TAUTLINE_PART(testSimilarity)
{
  for (CellType type : warpedTypes)
  {
    const Context context(topology(type).name);
    const bool flat = topology(type).dimension == 2;
    const MeshData data = shuffled(movedBlock(type, flat ? 8 : 4, 0.2), 3);
    TAUTLINE_NEW(vtkTransform, transform, Translate(3, -2, flat ? 0 : 1), RotateWXYZ(170, 0, 0, 1),
      Scale(2, 2, 2));
    vtkNew<vtkMeshWarp> filter;
    Messages messages(filter);
    TAUTLINE_SET(filter, SetInputData(toGrid(data)), SetTransform(transform), Update());
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

/// In any unit of length the same.
TAUTLINE_PART(testScales)
{
  std::vector<double> first;
  for (double scale : { 1.0, 1e-8, 1e8 })
  {
    for (int method : { vtkMeshWarp::HYBRID, vtkMeshWarp::FEMWARP })
    {
      const Context context("scale " + std::to_string(scale));
      MeshData data = holedBlock(CellType::Tetrahedron, 5);
      for (double& x : data.points)
      {
        x *= scale;
      }
      TAUTLINE_NEW(vtkMeshWarp, filter, SetInputData(toGrid(data)), SetMethod(method),
        SetTransformKind(vtkMeshWarp::ROTATION), SetAxis(1, 2, 3), SetAngle(35), Update());
      std::vector<double> points = withPointsOf(data, meshOf(filter)).points;
      double largest = 0;
      const std::size_t offset = method == vtkMeshWarp::HYBRID ? 0 : points.size();
      for (std::size_t i = 0; i < points.size(); ++i)
      {
        points[i] /= scale;
        largest = scale == 1 ? 0 : std::max(largest, std::abs(points[i] - first[offset + i]));
      }
      TAUTLINE_CHECK(largest < 1e-9);
      if (scale == 1)
      {
        first.insert(first.end(), points.begin(), points.end());
      }
    }
  }
}

/// A mesh reversed throughout warps as its mirror image; blocks on their own.
TAUTLINE_PART(testBlocks)
{
  const MeshData data = holedBlock(CellType::Tetrahedron, 5);
  TAUTLINE_NEW(vtkMultiBlockDataSet, blocks, SetBlock(0, toGrid(data)),
    SetBlock(2, toGrid(TAUTLINE_CHANGED(data, swapNodes(0, 1)), VTK_FLOAT)));
  vtkNew<vtkUnstructuredGrid> empty;
  blocks->SetBlock(3, empty);
  vtkNew<vtkMeshWarp> filter, single;
  Messages messages(filter);
  for (vtkMeshWarp* each : { filter.Get(), single.Get() })
  {
    TAUTLINE_SET(
      each, SetTransformKind(vtkMeshWarp::ROTATION), SetAngle(40), SetMethod(vtkMeshWarp::FEMWARP));
  }
  filter->SetInputData(blocks);
  TAUTLINE_SET(single, SetInputData(toGrid(data)), Update());
  filter->Update();
  TAUTLINE_CHECK(messages.empty());
  auto* output = outputOf<vtkMultiBlockDataSet>(filter);
  const MeshData expected = withPointsOf(data, meshOf(single));
  const auto at = [&](unsigned int i) { return vtkPointSet::SafeDownCast(output->GetBlock(i)); };
  TAUTLINE_CHECK(withPointsOf(data, at(0)).points == expected.points);
  TAUTLINE_CHECK(distance(withPointsOf(data, at(2)), expected) < 1e-6);
  TAUTLINE_CHECK_EQUAL(at(2)->GetPoints()->GetDataType(), VTK_FLOAT);
  TAUTLINE_CHECK_EQUAL(at(3)->GetNumberOfPoints(), 0);
  TAUTLINE_CHECK_EQUAL(filter->GetStatistics()->GetNumberOfRows(), 2);
  TAUTLINE_CHECK_EQUAL(filter->GetStatistics()->GetValueByName(1, "Block").ToString(), "block 3");
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("in-block-1-femwarp-all")));
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("it-is-treated-as-if-its-cells")));
  TAUTLINE_SET(filter, SetAmount(0.5), Update());
  TAUTLINE_CHECK_EQUAL(filter->GetReused(), 2);
}
}
