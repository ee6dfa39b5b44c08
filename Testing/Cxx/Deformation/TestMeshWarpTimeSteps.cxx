// SPDX-License-Identifier: BSD-3-Clause
// Warp Mesh over time steps: from the first or from the one before, and what is kept.
#include "QuadraticMeshes.h"
#include "Registry.h"
#include "WarpingMeshes.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnstructuredGridAlgorithm.h"

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
  double FailsAt = -1; ///< the time at which it cannot be computed
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
    if (time == this->FailsAt)
    {
      vtkErrorMacro("The time step cannot be computed.");
      return 0;
    }
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

/// @param curved of quadratic triangles, which are straight at first
vtkSmartPointer<MovingMesh> movingMesh(bool curved = false)
{
  auto source = vtkSmartPointer<MovingMesh>::New();
  source->Data = holedBlock(CellType::Triangle, 7);
  source->Parts = partsOf(source->Data, 7);
  if (curved)
  {
    source->Data = quadraticOf(source->Data);
    for (Index i = static_cast<Index>(source->Parts.size()); i < source->Data.numberOfPoints(); ++i)
    {
      const Vec3 p = source->Data.point(i) - Vec3{ 3.5, 3.5, 0 };
      const double far = std::max(std::abs(p[0]), std::abs(p[1]));
      source->Parts.push_back(far == 3.5 ? 1 : far == 0.5 ? 2 : 0);
    }
  }
  return source;
}

/// Any order of times gives the same meshes, from the first or, other ones, from the one before.
void testTimeSteps(bool curved)
{
  for (int motion : { vtkMeshWarp::TIME_STEPS, vtkMeshWarp::DISPLACEMENT, vtkMeshWarp::TARGET })
  {
    const Context context("motion " + std::to_string(motion));
    std::map<int, std::map<double, std::vector<double>>> found; // by start and time
    for (int start : { vtkMeshWarp::FIRST_STEP, vtkMeshWarp::PREVIOUS_STEP })
    {
      auto source = movingMesh(curved);
      source->Moves = motion != vtkMeshWarp::DISPLACEMENT;
      vtkNew<vtkMeshWarp> filter;
      Messages messages(filter);
      TAUTLINE_SET(filter, SetMotion(motion), SetStartFrom(start), SetMethod(vtkMeshWarp::FEMWARP),
        SetInputArrayToProcess(0, 0, 0, OnPoints, "d"));
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
        TAUTLINE_SET(filter, SetAmount(0.5), UpdateTimeStep(2.0));
        TAUTLINE_NEW(vtkMeshWarp, fresh, SetMotion(motion), SetStartFrom(start),
          SetMethod(vtkMeshWarp::FEMWARP), SetAmount(0.5),
          SetInputArrayToProcess(0, 0, 0, OnPoints, "d"));
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
        // So does another motion upstream.
        source->Degrees = 5;
        source->Modified();
        TAUTLINE_SET(filter, SetAmount(1), UpdateTimeStep(2.0));
        TAUTLINE_SET(fresh, SetAmount(1), UpdateTimeStep(2.0));
        TAUTLINE_CHECK(withPointsOf(source->Data, meshOf(filter)).points ==
          withPointsOf(source->Data, meshOf(fresh)).points);
      }
    }
    double difference = largestOf<double>(0, found[0][4].size(),
      [&](std::size_t i) { return std::abs(found[0][4][i] - found[1][4][i]); });
    TAUTLINE_CHECK(difference > 1e-3 && difference < 1);
    TAUTLINE_CHECK(found[0][0] == found[1][0]);
    double step = largestOf<double>(0, found[0][1].size(),
      [&](std::size_t i) { return std::abs(found[0][1][i] - found[1][1][i]); });
    TAUTLINE_CHECK(step < 1e-13); // the first step is the same
  }
}

TAUTLINE_PART(testLinearTimeSteps)
{
  testTimeSteps(false);
}

TAUTLINE_PART(testCurvedTimeSteps)
{
  testTimeSteps(true);
}

/// Matrices are kept over time; each time is read once; other cells are rejected.
TAUTLINE_PART(testTimeCosts)
{
  auto source = movingMesh();
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);
  TAUTLINE_SET(filter, SetInputConnection(source->GetOutputPort()),
    SetMotion(vtkMeshWarp::TIME_STEPS), SetMethod(vtkMeshWarp::FEMWARP), UpdateTimeStep(1));
  TAUTLINE_CHECK_EQUAL(source->Executions, 2); // the first, and this
  filter->UpdateTimeStep(2);
  TAUTLINE_CHECK_EQUAL(source->Executions, 3);
  TAUTLINE_CHECK_EQUAL(filter->GetReused(), 1);
  TAUTLINE_SET(filter, SetStartFrom(vtkMeshWarp::PREVIOUS_STEP), UpdateTimeStep(4));
  const int after = source->Executions;
  filter->UpdateTimeStep(2);
  TAUTLINE_CHECK_EQUAL(source->Executions, after + 1);
  TAUTLINE_CHECK(messages.empty());
  source->Grows = true;
  source->Modified();
  filter->UpdateTimeStep(1);
  TAUTLINE_CHECK(messages.empty());
  filter->UpdateTimeStep(4);
  TAUTLINE_CHECK(messages.has(wording("only-its-points-may-change-over-time")));
  messages.clear();
  source->Grows = false;
  source->Modified();
  filter->UpdateTimeStep(4);
  TAUTLINE_CHECK(messages.empty());

  // A time step in between that fails ends the execution; VTK would go on forever.
  {
    TAUTLINE_NEW(vtkMeshWarp, stepwise, SetInputConnection(source->GetOutputPort()),
      SetMotion(vtkMeshWarp::TIME_STEPS), SetStartFrom(vtkMeshWarp::PREVIOUS_STEP),
      SetMethod(vtkMeshWarp::FEMWARP));
    Messages all(stepwise), upstream(source);
    source->FailsAt = 2;
    source->Modified();
    stepwise->UpdateTimeStep(4);
    TAUTLINE_CHECK(upstream.has(wording("the-time-step-cannot-be-computed")));
    TAUTLINE_CHECK(all.has(wording("an-input-could-not-be-computed")));
    TAUTLINE_CHECK_EQUAL(meshOf(stepwise)->GetNumberOfPoints(), 0);
    source->FailsAt = -1;
    source->Modified();
    all.clear();
    stepwise->UpdateTimeStep(4);
    TAUTLINE_CHECK(all.empty());
    TAUTLINE_CHECK(meshOf(stepwise)->GetNumberOfPoints() > 0);
  }

  // Another source, made before: its first step counts, not the first step of the previous one.
  auto older = movingMesh();
  older->Degrees = -20;
  auto newer = movingMesh();
  vtkNew<vtkMeshWarp> switched, direct;
  for (vtkMeshWarp* each : { switched.Get(), direct.Get() })
  {
    TAUTLINE_SET(each, SetMotion(vtkMeshWarp::TIME_STEPS), SetMethod(vtkMeshWarp::FEMWARP));
  }
  newer->Data.points[0] -= 0.25;
  newer->Modified();
  TAUTLINE_SET(switched, SetInputConnection(newer->GetOutputPort()), UpdateTimeStep(3),
    SetInputConnection(older->GetOutputPort()));
  direct->SetInputConnection(older->GetOutputPort());
  switched->UpdateTimeStep(2);
  direct->UpdateTimeStep(2);
  TAUTLINE_CHECK(withPointsOf(older->Data, meshOf(switched)).points ==
    withPointsOf(older->Data, meshOf(direct)).points);

  vtkNew<vtkMeshWarp> without;
  Messages others(without);
  TAUTLINE_SET(
    without, SetInputData(toGrid(source->Data)), SetMotion(vtkMeshWarp::TIME_STEPS), Update());
  TAUTLINE_CHECK(others.has(wording("the-input-has-no-time-steps")));
}
}
