// SPDX-License-Identifier: BSD-3-Clause
// Warp Mesh: targets and which of their points belong to which, time steps, and what is refused, by
// name.
#include "WarpingMeshes.h"

#include "vtkCellData.h"
#include "vtkDataSetSurfaceFilter.h"
#include "vtkFeatureEdges.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkLineSource.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkObjectFactory.h"
#include "vtkSphereSource.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTransform.h"
#include "vtkTransformFilter.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGridAlgorithm.h"

#include <limits>

using namespace tautline;

namespace
{
constexpr auto OnPoints = vtkDataObject::FIELD_ASSOCIATION_POINTS;

/// A mesh whose points move with time: the hole turns, and inner points jump about; displacements
/// from time 0.
class MovingMesh : public vtkUnstructuredGridAlgorithm
{
public:
  static MovingMesh* New();
  vtkTypeMacro(MovingMesh, vtkUnstructuredGridAlgorithm);

  MeshData Data;
  std::vector<int> Parts;
  std::vector<double> Times = { 0, 1, 2, 3, 4 };
  double Degrees = 12; ///< per unit of time
  bool Moves = true;   ///< or only its array of displacements does
  bool Grows = false;  ///< from time 2 on it has another cell
  int Executions = 0;

protected:
  MovingMesh() { this->SetNumberOfInputPorts(0); }

  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override
  {
    using Pipeline = vtkStreamingDemandDrivenPipeline;
    vtkInformation* info = outputVector->GetInformationObject(0);
    const double range[2] = { this->Times.front(), this->Times.back() };
    info->Set(Pipeline::TIME_STEPS(), this->Times.data(), static_cast<int>(this->Times.size()));
    info->Set(Pipeline::TIME_RANGE(), range, 2);
    return 1;
  }

  int RequestData(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputVector) override
  {
    vtkInformation* info = outputVector->GetInformationObject(0);
    const double asked = info->Get(vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP());
    const double time =
      *std::prev(std::upper_bound(this->Times.begin() + 1, this->Times.end(), asked));
    const double angle = time * this->Degrees * 3.14159265358979323846 / 180;
    MeshData now = this->Data;
    for (Index i = 0; i < now.numberOfPoints(); ++i)
    {
      const Vec3 d = this->Data.point(i) - Vec3{ 3.5, 3.5, 0 };
      const Vec3 turned = { 3.5 + std::cos(angle) * d[0] - std::sin(angle) * d[1],
        3.5 + std::sin(angle) * d[0] + std::cos(angle) * d[1], 0 };
      now.setPoint(i,
        this->Parts[i] == 2     ? turned
          : this->Parts[i] == 0 ? this->Data.point(i) + Vec3{ 0.2 * time, 0, 0 }
                                : this->Data.point(i));
    }
    if (this->Grows && time >= 2)
    {
      now.addCell(CellType::Triangle, std::vector<Index>{ 0, 1, 2 });
    }
    auto grid = toGrid(this->Moves ? now : this->Data);
    grid->GetPointData()->AddArray(arrayOf("d", now.numberOfPoints(), 3,
      [&](Index i, int k) { return now.point(i)[k] - this->Data.point(i)[k]; }));
    vtkUnstructuredGrid::GetData(outputVector)->ShallowCopy(grid);
    ++this->Executions;
    return 1;
  }
};
vtkStandardNewMacro(MovingMesh);

vtkSmartPointer<MovingMesh> movingMesh()
{
  auto source = vtkSmartPointer<MovingMesh>::New();
  source->Data = holedBlock(CellType::Triangle, 7);
  source->Parts = partsOf(source->Data, 7);
  return source;
}

/// Any order of times gives the same meshes, from the first or from the one before; the latter
/// differ from the former.
void testTimeSteps()
{
  for (int motion : { vtkMeshWarp::TIME_STEPS, vtkMeshWarp::DISPLACEMENT, vtkMeshWarp::TARGET })
  {
    const Context context("motion " + std::to_string(motion));
    std::map<int, std::map<double, std::vector<double>>> found; // by start and time
    for (int start : { vtkMeshWarp::FIRST_STEP, vtkMeshWarp::PREVIOUS_STEP })
    {
      auto source = movingMesh();
      source->Moves = motion != vtkMeshWarp::DISPLACEMENT;
      vtkNew<vtkMeshWarp> filter;
      Messages messages(filter);
      filter->SetMotion(motion);
      filter->SetStartFrom(start);
      filter->SetMethod(vtkMeshWarp::FEMWARP);
      filter->SetInputArrayToProcess(0, 0, 0, OnPoints, "d");
      if (motion == vtkMeshWarp::TARGET)
      {
        filter->SetInputData(0, toGrid(source->Data));
        filter->SetInputConnection(1, source->GetOutputPort());
      }
      else
      {
        filter->SetInputConnection(source->GetOutputPort());
      }
      for (double time : { 3.0, 0.0, 1.0, 4.0, 2.5, 3.0, 1.0, 4.0 })
      {
        filter->UpdateTimeStep(time);
        TAUTLINE_CHECK(messages.empty());
        const auto points = withPointsOf(source->Data, meshOf(filter)).points;
        TAUTLINE_CHECK_EQUAL(filter->GetInverted(), 0);
        auto& known = found[start][std::floor(time)];
        TAUTLINE_CHECK(known.empty() || known == points);
        known = points;
        const double angle = std::floor(time) * source->Degrees * 3.14159265358979323846 / 180;
        for (Index i = 0; i < source->Data.numberOfPoints(); ++i)
        {
          const Vec3 p = source->Data.point(i), d = p - Vec3{ 3.5, 3.5, 0 };
          const Vec3 turned = { 3.5 + std::cos(angle) * d[0] - std::sin(angle) * d[1],
            3.5 + std::sin(angle) * d[0] + std::cos(angle) * d[1], 0 };
          const Vec3 expected = source->Parts[i] == 2 ? turned : p;
          TAUTLINE_CHECK(
            source->Parts[i] == 0 || norm(pointOf(meshOf(filter), i) - expected) < 1e-12);
        }
      }
      if (start == vtkMeshWarp::PREVIOUS_STEP)
      {
        TAUTLINE_CHECK_EQUAL(component(meshOf(filter)->GetPointData(), "Displacement", 0), 0);
        // Another amount begins again; and all of that is what fresh filters find.
        filter->SetAmount(0.5);
        filter->UpdateTimeStep(2.0);
        vtkNew<vtkMeshWarp> fresh;
        fresh->SetMotion(motion);
        fresh->SetStartFrom(start);
        fresh->SetMethod(vtkMeshWarp::FEMWARP);
        fresh->SetAmount(0.5);
        fresh->SetInputArrayToProcess(0, 0, 0, OnPoints, "d");
        for (int port : { 0, 1 })
        {
          if (filter->GetNumberOfInputConnections(port) > 0)
          {
            fresh->SetInputConnection(port, filter->GetInputConnection(port, 0));
          }
        }
        fresh->UpdateTimeStep(2.0);
        TAUTLINE_CHECK(withPointsOf(source->Data, meshOf(filter)).points ==
          withPointsOf(source->Data, meshOf(fresh)).points);
        // Another motion upstream does, too.
        source->Degrees = 5;
        source->Modified();
        filter->SetAmount(1);
        filter->UpdateTimeStep(2.0);
        fresh->SetAmount(1);
        fresh->UpdateTimeStep(2.0);
        TAUTLINE_CHECK(withPointsOf(source->Data, meshOf(filter)).points ==
          withPointsOf(source->Data, meshOf(fresh)).points);
      }
    }
    double difference = 0;
    for (std::size_t i = 0; i < found[0][4].size(); ++i)
    {
      difference = std::max(difference, std::abs(found[0][4][i] - found[1][4][i]));
    }
    TAUTLINE_CHECK(difference > 1e-3 && difference < 1);
    TAUTLINE_CHECK(found[0][0] == found[1][0]);
    double step = 0;
    for (std::size_t i = 0; i < found[0][1].size(); ++i)
    {
      step = std::max(step, std::abs(found[0][1][i] - found[1][1][i]));
    }
    TAUTLINE_CHECK(step < 1e-13); // the first step is the same
  }
}

/// Matrices are kept over time; times in between are read once; a mesh that changes its cells is
/// refused.
void testTimeCosts()
{
  auto source = movingMesh();
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);
  filter->SetInputConnection(source->GetOutputPort());
  filter->SetMotion(vtkMeshWarp::TIME_STEPS);
  filter->SetMethod(vtkMeshWarp::FEMWARP);
  filter->UpdateTimeStep(1);
  TAUTLINE_CHECK_EQUAL(source->Executions, 2); // the first, and this
  filter->UpdateTimeStep(2);
  TAUTLINE_CHECK_EQUAL(source->Executions, 3);
  TAUTLINE_CHECK_EQUAL(filter->GetReused(), 1);
  filter->SetStartFrom(vtkMeshWarp::PREVIOUS_STEP);
  filter->UpdateTimeStep(4);
  const int after = source->Executions;
  filter->UpdateTimeStep(2);
  TAUTLINE_CHECK_EQUAL(source->Executions, after + 1);
  TAUTLINE_CHECK(messages.empty());
  source->Grows = true;
  source->Modified();
  filter->UpdateTimeStep(1);
  TAUTLINE_CHECK(messages.empty());
  filter->UpdateTimeStep(4);
  TAUTLINE_CHECK(messages.has("only its points may change over time"));
  messages.clear();
  source->Grows = false;
  source->Modified();
  filter->UpdateTimeStep(4);
  TAUTLINE_CHECK(messages.empty());

  // Another source, made before: its first step counts, not that of the one before.
  auto older = movingMesh();
  older->Degrees = -20;
  auto newer = movingMesh();
  vtkNew<vtkMeshWarp> switched, direct;
  for (vtkMeshWarp* each : { switched.Get(), direct.Get() })
  {
    each->SetMotion(vtkMeshWarp::TIME_STEPS);
    each->SetMethod(vtkMeshWarp::FEMWARP);
  }
  newer->Data.points[0] -= 0.25;
  newer->Modified();
  switched->SetInputConnection(newer->GetOutputPort());
  switched->UpdateTimeStep(3);
  switched->SetInputConnection(older->GetOutputPort());
  direct->SetInputConnection(older->GetOutputPort());
  switched->UpdateTimeStep(2);
  direct->UpdateTimeStep(2);
  TAUTLINE_CHECK(withPointsOf(older->Data, meshOf(switched)).points ==
    withPointsOf(older->Data, meshOf(direct)).points);

  vtkNew<vtkMeshWarp> without;
  Messages others(without);
  without->SetInputData(toGrid(source->Data));
  without->SetMotion(vtkMeshWarp::TIME_STEPS);
  without->Update();
  TAUTLINE_CHECK(others.has("The input has no time steps"));
}

/// The boundary turned and shifted, given in every possible way: the same result, and the summary
/// names the way.
void testTargets()
{
  for (CellType type : { CellType::Triangle, CellType::Tetrahedron })
  {
    const Context context(topology(type).name);
    const bool flat = type == CellType::Triangle;
    const MeshData data = shuffled(holedBlock(type, 5), 11);
    auto grid = toGrid(data);
    grid->GetPointData()->AddArray(arrayOf(
      "id", data.numberOfPoints(), 1, [](Index i, int) { return 1000.0 - 3.0 * double(i); }));
    vtkNew<vtkTransform> transform;
    transform->Translate(0.25, 0.125, flat ? 0 : 0.5);
    transform->Scale(1.25, 0.75, 1);
    const auto moved = [&transform](vtkDataSet* what)
    {
      vtkNew<vtkTransformFilter> filter;
      filter->SetInputData(what);
      filter->SetTransform(transform);
      filter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
      filter->Update();
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
    filter->SetInputData(grid);
    filter->SetMotion(vtkMeshWarp::TARGET);
    filter->SetMethod(vtkMeshWarp::FEMWARP);
    const auto check = [&](vtkDataSet* target, const char* how)
    {
      const Context inner(how);
      filter->SetInputData(1, target);
      filter->Update();
      TAUTLINE_CHECK(messages.empty());
      messages.clear();
      TAUTLINE_CHECK(contains(filter->GetSummary(), how));
      TAUTLINE_CHECK(distance(withPointsOf(data, meshOf(filter)), expected) < 1e-10);
    };
    check(moved(grid), "as the same mesh");
    vtkNew<vtkDataSetSurfaceFilter> surface;
    surface->SetInputData(grid);
    surface->PassThroughPointIdsOn();
    surface->Update();
    check(moved(surface->GetOutput()), "as the boundary extracted from the mesh");
    vtkNew<vtkFeatureEdges> edges;
    if (flat)
    {
      edges->SetInputConnection(surface->GetOutputPort());
      edges->Update();
      check(moved(edges->GetOutput()), "as the boundary extracted from the mesh");
    }

    // The points alone, of those that move; and the boundary's cells among all points.
    const auto boundary = Mesh(data.view()).boundary().isBoundaryPoint;
    vtkNew<vtkPolyData> cloud, inMesh;
    vtkNew<vtkPoints> places;
    places->SetDataTypeToDouble();
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
    TAUTLINE_CHECK(messages.has("choose another Correspondence"));
    messages.clear();
    filter->SetCorrespondence(vtkMeshWarp::AUTOMATIC_MATCH);

    // By ids: numbers of points, or values of the array of the same name.
    vtkPolyData* skin = surface->GetOutput();
    filter->SetTargetIds("vtkOriginalPointIds");
    check(moved(skin), "by point ids");
    filter->SetTargetIds("id");
    check(moved(skin), "by point ids");
    skin->GetPointData()->GetArray("id")->SetComponent(3, 0, -7);
    filter->SetInputData(1, moved(skin));
    filter->Update();
    TAUTLINE_CHECK(
      messages.has("has 1 values that are no values of the mesh's array of that name"));
    filter->SetTargetIds("missing");
    filter->Update();
    TAUTLINE_CHECK(messages.has("The target has no point array 'missing'"));
    messages.clear();
    filter->SetTargetIds("None");
    filter->SetCorrespondence(vtkMeshWarp::POINT_IDS);
    filter->Update();
    TAUTLINE_CHECK(messages.has("No array of point ids is chosen"));
    filter->SetCorrespondence(vtkMeshWarp::SAME_MESH);
    filter->Update();
    TAUTLINE_CHECK(flat || messages.has("it is not the same mesh"));
  }
}

/// The boundary goes to the closest point; the summary has the maximum distance.
void testProjection()
{
  const Index n = 5;
  const MeshData data = holedBlock(CellType::Tetrahedron, n);
  const std::vector<int> parts = partsOf(data, n);
  vtkNew<vtkSphereSource> sphere;
  sphere->SetCenter(2.5, 2.5, 2.5);
  sphere->SetRadius(1);
  sphere->SetThetaResolution(60);
  sphere->SetPhiResolution(60);
  sphere->Update();
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);
  filter->SetInputData(toGrid(data));
  filter->SetMotion(vtkMeshWarp::TARGET);
  filter->SetInputConnection(1, sphere->GetOutputPort());
  filter->Update();
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK_EQUAL(filter->GetInverted(), 0);
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 p = pointOf(meshOf(filter), i), c = { 2.5, 2.5, 2.5 };
    TAUTLINE_CHECK(parts[i] != 2 || std::abs(norm(p - c) - 1) < 3e-3);
    TAUTLINE_CHECK(parts[i] != 1 || p == data.point(i));
  }
  TAUTLINE_CHECK(contains(filter->GetSummary(), "by projection: 8 points"));
  TAUTLINE_CHECK(contains(filter->GetSummary(), "the farthest of them 0.13")); // 1 - sqrt(3) / 2
  TAUTLINE_CHECK_NEAR(
    value(filter->GetStatistics(), "Largest displacement"), 1 - std::sqrt(0.75), 3e-3);

  // A block of one data set is that data set; a volume stands for its surface.
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(1, toGrid(movedBlock(CellType::Hexahedron, 5, 0)));
  filter->SetInputConnection(1, nullptr);
  filter->SetInputData(1, blocks);
  filter->SetCorrespondence(vtkMeshWarp::CLOSEST_POINT);
  filter->SetMovedPart(vtkMeshWarp::WHOLE_BOUNDARY);
  filter->SetAmount(0.25);
  filter->Update();
  TAUTLINE_CHECK(contains(filter->GetSummary(), "the farthest of them 2.0"));
  TAUTLINE_CHECK_NEAR(value(filter->GetStatistics(), "Largest displacement"), 0.5, 1e-12);
  blocks->SetBlock(2, toGrid(data));
  filter->Update();
  TAUTLINE_CHECK(messages.has("The target has several blocks and the mesh has none"));
  messages.clear();

  // In the plane it is a curve.
  const MeshData square = blockMesh(CellType::Triangle, 4, 4, 0);
  vtkNew<vtkLineSource> line;
  line->SetPoint1(4.5, -1, 0);
  line->SetPoint2(4.5, 5, 0);
  line->Update();
  vtkNew<vtkMeshWarp> planar;
  Messages others(planar);
  auto grid = toGrid(square);
  grid->GetPointData()->AddArray(arrayOf("right", square.numberOfPoints(), 1,
    [&](Index i, int) { return double(square.point(i)[0] == 4); }));
  planar->SetInputData(grid);
  planar->SetMotion(vtkMeshWarp::TARGET);
  planar->SetMethod(vtkMeshWarp::FEMWARP);
  planar->SetMovedPart(vtkMeshWarp::ARRAY_VALUES);
  planar->SetInputArrayToProcess(1, 0, 0, OnPoints, "right");
  planar->SetInputData(1, line->GetOutput());
  planar->Update();
  TAUTLINE_CHECK(others.empty());
  for (Index i = 0; i < square.numberOfPoints(); ++i)
  {
    const Vec3 p = square.point(i), q = pointOf(meshOf(planar), i);
    TAUTLINE_CHECK(p[0] < 4 || norm(q - p - Vec3{ 0.5, 0, 0 }) < 1e-7);
    TAUTLINE_CHECK(p[0] > 0 || q == p);
  }
  vtkNew<vtkPolyData> cloud;
  vtkNew<vtkPoints> one;
  one->InsertNextPoint(0, 0, 0);
  cloud->SetPoints(one);
  planar->SetInputData(1, cloud);
  planar->Update();
  TAUTLINE_CHECK(others.has("The target has no curve the boundary could be moved to"));
  others.clear();
  vtkNew<vtkPolyData> nothing;
  planar->SetInputData(1, nothing);
  planar->Update();
  TAUTLINE_CHECK(others.has("The target is empty"));
  others.clear();
  planar->SetInputData(1, nullptr);
  planar->Update();
  TAUTLINE_CHECK(others.has("There is no Target"));
}

/// What cannot be warped, and why.
void testRefusals()
{
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);
  filter->SetTransformKind(vtkMeshWarp::TRANSLATION);
  filter->SetTranslation(0.1, 0, 0);
  const auto refused = [&](vtkDataObject* input, const char* text)
  {
    const Context context(text);
    messages.clear();
    filter->SetInputData(input);
    filter->Update();
    TAUTLINE_CHECK(messages.has(text));
    auto* output = vtkDataSet::SafeDownCast(filter->GetOutputDataObject(0));
    TAUTLINE_CHECK(!output || output->GetNumberOfPoints() == 0);
    TAUTLINE_CHECK(std::string(filter->GetSummary()).empty());
  };
  const MeshData data = blockMesh(CellType::Triangle, 4, 4, 0);
  vtkNew<vtkImageData> image;
  image->SetDimensions(3, 3, 3);
  refused(image, "Image Data to Point Set");
  MeshData wrong = data;
  wrong.setPoint(6, { 2.5, 2.6, 0 });
  refused(toGrid(wrong), "run Untangle Mesh first");
  wrong = data;
  wrong.points[7] = std::numeric_limits<double>::quiet_NaN();
  refused(toGrid(wrong), "1 points have a coordinate that is NaN");
  wrong = data;
  wrong.addCell(VTK_POLYGON, { 0, 1, 2, 3, 4 });
  refused(toGrid(wrong), "1 polygons, polyhedra or other cells that cannot be warped");
  wrong = MeshData();
  wrong.points = data.points;
  wrong.addCell(VTK_QUADRATIC_TRIANGLE, { 0, 2, 10, 1, 6, 5 });
  refused(toGrid(wrong), "Tessellate");
  wrong = MeshData();
  wrong.points = data.points;
  wrong.addCell(VTK_VERTEX, { 0 });
  refused(toGrid(wrong), "There is no element");
  refused(toGrid(blockMesh(CellType::Wedge, 2, 2, 2)), "wedges");
  vtkNew<vtkSphereSource> sphere;
  sphere->Update();
  refused(sphere->GetOutput(), "no boundary");
  wrong = data;
  wrong.transform([](const Vec3& p) { return Vec3{ p[0], p[1], 0.1 * p[0] * p[0] }; });
  refused(toGrid(wrong), "a surface in space");
  filter->SetTranslation(0.1, 0, 0.1);
  refused(toGrid(data), "lead out of its plane");
  filter->SetTransformKind(vtkMeshWarp::ROTATION);
  filter->SetAxis(0, 0, 0);
  refused(toGrid(data), "The axis of the motion has no length");
  filter->SetTransformKind(vtkMeshWarp::SCALING);
  filter->SetScaleFactors(1, 0, 1);
  refused(toGrid(data), "A scale factor is not positive");
  filter->SetTransformKind(vtkMeshWarp::BENDING);
  filter->SetAxis(1, 0, 0);
  refused(toGrid(data), "lies along the axis");
  filter->SetTransformKind(vtkMeshWarp::MATRIX);
  vtkNew<vtkTransform> mirror;
  mirror->Scale(-1, 1, 1);
  filter->SetTransform(mirror);
  refused(toGrid(data), "mirrors or flattens");

  // Arrays of displacements.
  filter->SetMotion(vtkMeshWarp::DISPLACEMENT);
  auto grid = toGrid(data);
  refused(grid, "No array of displacements is chosen");
  filter->SetInputArrayToProcess(0, 0, 0, OnPoints, "d");
  refused(grid, "There is no point array 'd' of displacements");
  grid->GetPointData()->AddArray(
    arrayOf("d", data.numberOfPoints(), 1, [](Index, int) { return 0; }));
  refused(grid, "The array 'd' has 1 components");
  auto d = arrayOf("d", data.numberOfPoints(), 3,
    [](Index i, int) { return i == 2 || i == 6 || i == 24 ? std::nan("") : 0.01; });
  for (int k = 2; k < 3 * data.numberOfPoints(); k += 3)
  {
    d->SetValue(k, 0);
  }
  grid->GetPointData()->AddArray(d);
  refused(grid,
    "The array 'd' is NaN or infinite at 2 of 16 points of the boundary, the first is point 2");
  d->SetComponent(2, 0, 0.01);
  d->SetComponent(2, 1, 0.01);
  d->SetComponent(24, 0, 0.01);
  d->SetComponent(24, 1, 0.01);
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
  refused(grid, "No array of coefficients is chosen");
  filter->SetInputArrayToProcess(3, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "c");
  grid->GetCellData()->AddArray(
    arrayOf("c", data.numberOfCells(), 2, [](Index, int) { return 1; }));
  refused(grid, "The array 'c' has 2 components");
  grid->GetCellData()->AddArray(
    arrayOf("c", data.numberOfCells(), 3, [](Index, int) { return -1; }));
  refused(grid, "cell 0 of the mesh are not finite or not positive semidefinite: correct");
  // The cell of the input, with a vertex, too.
  MeshData more = data;
  more.types.insert(more.types.begin(), VTK_VERTEX);
  more.connectivity.insert(more.connectivity.begin(), 0);
  std::for_each(more.offsets.begin(), more.offsets.end(), [](Index& at) { ++at; });
  more.offsets.insert(more.offsets.begin(), 0);
  const auto withVertex = toGrid(more);
  withVertex->GetPointData()->ShallowCopy(grid->GetPointData());
  const auto values = [](Index i, int) { return i == 0 || i == 4 ? -1 : 1; };
  withVertex->GetCellData()->AddArray(arrayOf("c", more.numberOfCells(), 3, values));
  refused(withVertex, "The coefficients of cell 4 of the mesh");
  filter->SetCoefficients(vtkMeshWarp::PER_REGION);
  refused(grid, "No array of regions is chosen");

  vtkNew<vtkUnstructuredGrid> empty;
  messages.clear();
  filter->SetInputData(empty);
  filter->Update();
  TAUTLINE_CHECK(messages.has("The input has no cells"));
}

/// A moved boundary that intersects itself: a warning with numbers, and the best mesh.
void testImpossible()
{
  const MeshData data = holedBlock(CellType::Triangle, 7);
  const std::vector<int> parts = partsOf(data, 7);
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);
  filter->SetInputData(toGrid(data));
  filter->SetTransformKind(vtkMeshWarp::TRANSLATION);
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
void testOtherCells()
{
  MeshData data = blockMesh(CellType::Triangle, 6, 6, 0);
  data.addCell(VTK_LINE, { 0, 1 });
  data.addCell(VTK_VERTEX, { 24 });
  const Index lonely = data.addPoint({ 9, 9, 0 });
  auto grid = toGrid(data);
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    ghosts->InsertNextValue(cell >= 60 && cell < 72 ? vtkDataSetAttributes::DUPLICATECELL : 0);
  }
  grid->GetCellData()->AddArray(ghosts);
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);

  filter->SetInputData(grid);
  filter->SetTransformKind(vtkMeshWarp::TRANSLATION);
  filter->SetTranslation(0, -0.5, 0);
  filter->Update();
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
  vtkNew<vtkDataSetSurfaceFilter> surface;
  surface->SetInputData(toGrid(solid));
  surface->PassThroughPointIdsOn();
  surface->Update();
  vtkDataArray* ids = surface->GetOutput()->GetPointData()->GetArray("vtkOriginalPointIds");
  MeshData both;
  both.points = solid.points;
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
    each->SetInputData(input);
    each->SetTransformKind(vtkMeshWarp::ROTATION);
    each->SetAngle(30);
    each->SetCoefficients(vtkMeshWarp::PER_CELL);
    each->SetInputArrayToProcess(3, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "c");
    each->Update();
  }
  TAUTLINE_CHECK(more.empty());
  TAUTLINE_CHECK(
    withPointsOf(solid, meshOf(mixed)).points == withPointsOf(solid, meshOf(plain)).points);
  TAUTLINE_CHECK_EQUAL(value(mixed->GetStatistics(), "Elements"), solid.numberOfCells());
}
}

//------------------------------------------------------------------------------
int TestMeshWarpInputs(int, char*[])
{
  testTimeSteps();
  testTimeCosts();
  testTargets();
  testProjection();
  testRefusals();
  testImpossible();
  testOtherCells();
  return exitCode();
}
