// SPDX-License-Identifier: BSD-3-Clause
// Motions over time of Warp Mesh on processes: each keeps its piece, and the points equal the
// result of one process, from the first time step or from the one before, whatever the order of the
// requests.
#include "MovingPieces.h"
#include "Registry.h"
#include "vtkCommand.h"
#include "vtkPassThrough.h"

using namespace tautline;

namespace
{
constexpr double Same = 1e-10;
constexpr double PlanarMiddle = 3.5, VolumeMiddle = 2.5;

/// A filter and the source of its pieces, on this process.
struct Run
{
  vtkNew<MovingPieces> source;
  vtkNew<vtkMeshWarp> filter;

  Run(const RankPart& part, double middle, int motion, int start)
  {
    this->source->PartAt = [part](double) { return part; };
    this->source->Middle = middle;
    this->source->Flat = middle == PlanarMiddle;
    this->source->Moves = motion != vtkMeshWarp::DISPLACEMENT;
    this->filter->SetMotion(motion);
    this->filter->SetStartFrom(start);
    this->filter->SetMethod(vtkMeshWarp::FEMWARP);
    this->filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "d");
    const bool target = motion == vtkMeshWarp::TARGET;
    if (target)
    {
      this->filter->SetInputData(gridOf(part));
    }
    this->filter->SetInputConnection(target ? 1 : 0, this->source->GetOutputPort());
  }

  std::vector<double> at(double time, const MeshData& whole, const RankPart& part)
  {
    this->filter->UpdateTimeStep(time);
    return spreadOf(whole, part, meshOf(this->filter));
  }
};

/// The result of one process at a time, without the others.
template <class Set>
std::vector<double> aloneAt(double time, vtkMPIController* controller, const MeshData& whole,
  double middle, int motion, int start, const Set& set, int* rows = nullptr)
{
  vtkMultiProcessController::SetGlobalController(nullptr);
  const RankPart part = partOf(whole, 0, [](Index) { return 0; });
  Run run(part, middle, motion, start);
  set(run);
  const std::vector<double> points = run.at(time, whole, part);
  if (rows)
  {
    *rows = static_cast<int>(run.filter->GetHistory()->GetNumberOfRows());
  }
  vtkMultiProcessController::SetGlobalController(controller);
  return points;
}

/// The points of one process, however the mesh is cut and whichever times come first.
void testSame(
  vtkMPIController* controller, const MeshData& whole, double middle, int motion, int start)
{
  const Context context("motion " + std::to_string(motion) + " start " + std::to_string(start));
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const auto nothing = [](Run&) {};
  std::map<double, std::vector<double>> expected;
  for (const double time : { 0.0, 2.0, 3.0 })
  {
    expected[time] = aloneAt(time, controller, whole, middle, motion, start, nothing);
    TAUTLINE_CHECK(time == 0 || farthest(expected[time], whole.points) > 0.1);
  }
  double far = 0;
  const auto check = [&](const RankPart& part, const auto& set)
  {
    Run run(part, middle, motion, start);
    set(run);
    Messages messages(run.filter);
    for (const double time : { 3.0, 0.0, 2.5, 3.0, 2.0 })
    {
      const std::vector<double> here = run.at(time, whole, part);
      TAUTLINE_CHECK(messages.empty());
      far = std::max(far, farthest(here, expected[std::floor(time)]));
      TAUTLINE_CHECK(far <= Same);
      TAUTLINE_CHECK(motion == vtkMeshWarp::TARGET ||
        !contains(run.filter->GetSummary(), wording("put-together")));
      TAUTLINE_CHECK_EQUAL(run.filter->GetInverted(), 0);
      TAUTLINE_CHECK_EQUAL(run.filter->GetHistory()->GetNumberOfRows(), rank == 0 ? 1 : 0);
    }
    // Time steps in between are read once, and the first one is kept.
    const int before = run.source->Executions;
    run.at(3.0, whole, part);
    TAUTLINE_CHECK_EQUAL(run.source->Executions, before + 1);
  };
  const auto plain = [](Run&) {};
  check(partOf(whole, rank, cutBy(whole, Cut::Random, size)), plain);
  if (middle == PlanarMiddle) // other cuts of the volume take long
  {
    check(partOf(whole, rank, cutBy(whole, Cut::Slabs, size), true), plain);
    // More processes than pieces: the first has none.
    check(
      partOf(whole, rank, [&](Index cell) { return size > 2 && cell % 2 ? size - 1 : 1; }), plain);
    check(partOf(whole, rank, [](Index) { return 0; }),
      [](Run& run) { run.filter->SetRedistribute(vtkMeshWarp::KD_TREE); });
  }
  if (rank == 0)
  {
    std::cout << "motion " << motion << ", start " << start << ": farthest " << far << "\n";
  }
}

/// Other settings, other data and data of one process alone begin again on all.
void testBeginsAgain(vtkMPIController* controller, const MeshData& whole, double middle)
{
  const Context context("begins again");
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const RankPart part = partOf(whole, rank, cutBy(whole, Cut::Random, size));
  const int motion = vtkMeshWarp::TIME_STEPS, start = vtkMeshWarp::PREVIOUS_STEP;
  Run run(part, middle, motion, start);
  const auto half = [](Run& one) { one.filter->SetAmount(0.5); };
  const auto slow = [](Run& one) { one.source->Degrees = 5; };
  const auto plain = [](Run&) {};
  const auto check = [&](const auto& set)
  {
    const auto expected = aloneAt(3.0, controller, whole, middle, motion, start, set);
    TAUTLINE_CHECK(farthest(run.at(3.0, whole, part), expected) <= Same);
  };
  check(plain);
  half(run);
  check(half);
  run.filter->SetAmount(1.0);
  slow(run);
  run.source->Modified();
  check(slow);
  // The source of one process alone has changed when another time is requested.
  if (rank == size - 1)
  {
    run.source->Modified();
  }
  const auto second = aloneAt(2.0, controller, whole, middle, motion, start, slow);
  TAUTLINE_CHECK(farthest(run.at(2.0, whole, part), second) <= Same);
  check(slow);
  // From a motion over time to another one and back.
  run.filter->SetMotion(vtkMeshWarp::TRANSFORM);
  turn(run.filter, 20);
  run.at(0.0, whole, part);
  TAUTLINE_CHECK(!contains(run.filter->GetSummary(), wording("put-together")));
  run.filter->SetMotion(motion);
  check(slow);
}

/// Pieces that are cut differently at a time step are put together; their points need ids.
void testOtherPieces(vtkMPIController* controller, const MeshData& whole, double middle)
{
  const Context context("other pieces");
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const RankPart slabs = partOf(whole, rank, cutBy(whole, Cut::Slabs, size));
  const RankPart random = partOf(whole, rank, cutBy(whole, Cut::Random, size));
  for (const bool numbered : { true, false })
  {
    for (const int start : { vtkMeshWarp::FIRST_STEP, vtkMeshWarp::PREVIOUS_STEP })
    {
      const int motion = vtkMeshWarp::TIME_STEPS;
      const auto expected = aloneAt(3.0, controller, whole, middle, motion, start, [](Run&) {});
      Run run(slabs, middle, motion, start);
      run.source->Numbered = numbered;
      run.source->PartAt = [&](double time) { return time < 2 ? slabs : random; };
      Messages messages(run.filter);
      run.filter->UpdateTimeStep(1.0);
      TAUTLINE_CHECK(messages.empty());
      TAUTLINE_CHECK(!contains(run.filter->GetSummary(), wording("put-together")));
      run.filter->UpdateTimeStep(3.0);
      TAUTLINE_CHECK_EQUAL(messages.has(wording("so-that-their-order-is-not-known-2")), !numbered);
      if (!numbered)
      {
        TAUTLINE_CHECK_EQUAL(meshOf(run.filter)->GetNumberOfPoints(), 0);
        continue;
      }
      TAUTLINE_CHECK(messages.empty());
      TAUTLINE_CHECK(
        contains(run.filter->GetSummary(), wording("the-mesh-was-put-together-on-the")));
      TAUTLINE_CHECK(farthest(spreadOf(whole, random, meshOf(run.filter)), expected) <= Same);
      // It stays so, until the source changes.
      const auto first = aloneAt(1.0, controller, whole, middle, motion, start, [](Run&) {});
      TAUTLINE_CHECK(farthest(run.at(1.0, whole, slabs), first) <= Same);
      TAUTLINE_CHECK(contains(run.filter->GetSummary(), wording("put-together")));
      run.source->PartAt = [&](double) { return random; };
      run.source->Modified();
      TAUTLINE_CHECK(farthest(run.at(3.0, whole, random), expected) <= Same);
      TAUTLINE_CHECK(!contains(run.filter->GetSummary(), wording("put-together")));
      TAUTLINE_CHECK(messages.empty());
    }
  }
}

/// A mesh that is put together at all times: in the order of ids, or rejected.
void testPutTogether(vtkMPIController* controller)
{
  const Context context("put together");
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  MeshData whole = TAUTLINE_CHANGED(blockWithHole(CellType::Triangle), swapNodes(0, 1, 0, 2));
  const RankPart part = partOf(whole, rank, cutBy(whole, Cut::Random, size));
  for (const int start : { vtkMeshWarp::FIRST_STEP, vtkMeshWarp::PREVIOUS_STEP })
  {
    const int motion = vtkMeshWarp::TIME_STEPS;
    const auto expected = aloneAt(3.0, controller, whole, PlanarMiddle, motion, start, [](Run&) {});
    Run run(part, PlanarMiddle, motion, start);
    run.source->Numbered = true;
    TAUTLINE_CHECK(farthest(run.at(3.0, whole, part), expected) <= Same);
    TAUTLINE_CHECK(farthest(run.at(3.0, whole, part), whole.points) > 0.1);
    const char* sentence = "The mesh was put together on the first process: neighboring cells list "
                           "their points in opposite orders";
    TAUTLINE_CHECK(contains(run.filter->GetSummary(), sentence));
    // Its summary stays when nothing but the time changes.
    run.at(2.0, whole, part);
    TAUTLINE_CHECK(contains(run.filter->GetSummary(), sentence));
    run.source->Numbered = false;
    run.source->Modified();
    Messages messages(run.filter);
    run.filter->UpdateTimeStep(3.0);
    TAUTLINE_CHECK(messages.has(wording("so-that-their-order-is-not-known")));
  }
}

/// An error on one process at a later time is an error on all, which then continue.
void testWrong(vtkMPIController* controller, const MeshData& whole, double middle)
{
  const Context context("wrong");
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const RankPart part = partOf(whole, rank, cutBy(whole, Cut::Slabs, size));
  const bool last = rank == size - 1;
  for (const int start : { vtkMeshWarp::FIRST_STEP, vtkMeshWarp::PREVIOUS_STEP })
  {
    Run run(part, middle, vtkMeshWarp::TIME_STEPS, start);
    Messages messages(run.filter), upstream(run.source);
    const auto fails = [&](const char* message)
    {
      const Context inner(message);
      run.source->Modified();
      run.filter->UpdateTimeStep(3.0);
      TAUTLINE_CHECK(messages.has(message));
      TAUTLINE_CHECK_EQUAL(meshOf(run.filter)->GetNumberOfPoints(), 0);
      messages.clear();
    };
    const double when = start == vtkMeshWarp::FIRST_STEP ? 3 : 2;
    run.source->BrokenAt = last ? when : -1;
    fails(wording("prescribed-points-are-nan-or-infinite"));
    run.source->BrokenAt = -1;
    run.source->FailsAt = last ? when : -1;
    fails(wording("an-input-could-not-be-computed"));
    run.source->FailsAt = -1;
    run.source->Modified();
    run.filter->UpdateTimeStep(3.0);
    TAUTLINE_CHECK(messages.empty());
    TAUTLINE_CHECK_EQUAL(meshOf(run.filter)->GetNumberOfPoints(), part.data.numberOfPoints());
  }
  TAUTLINE_NEW(
    vtkMeshWarp, without, SetInputData(gridOf(part)), SetMotion(vtkMeshWarp::TIME_STEPS));
  Messages messages(without);
  without->Update();
  TAUTLINE_CHECK(messages.has(wording("the-input-has-no-time-steps")));
}

/// A process without cells may have no time steps: it takes part in the time steps of the others,
/// also behind another filter. Others have to have the same.
void testTimes(vtkMPIController* controller, const MeshData& whole, double middle)
{
  const Context context("times");
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const int start = vtkMeshWarp::PREVIOUS_STEP;
  for (const int motion : { vtkMeshWarp::TIME_STEPS, vtkMeshWarp::DISPLACEMENT })
  {
    std::map<double, std::vector<double>> expected;
    for (const double time : { 0.0, 2.0, 3.0 })
    {
      expected[time] = aloneAt(time, controller, whole, middle, motion, start, [](Run&) {});
    }
    for (const int idle : { 0, size - 1 })
    {
      const Context inner("idle " + std::to_string(idle));
      const RankPart part = partOf(whole, rank,
        [idle, size](Index cell)
        {
          const int taker = static_cast<int>(cell % (size - 1));
          return taker < idle ? taker : taker + 1;
        });
      Run run(part, middle, motion, start);
      TAUTLINE_NEW(vtkPassThrough, after, SetInputConnection(run.filter->GetOutputPort()));
      if (rank == idle)
      {
        run.source->Times.clear();
      }
      Messages messages(run.filter);
      for (const double time : { 3.0, 0.0, 2.5 })
      {
        const double step = std::floor(time);
        TAUTLINE_CHECK(farthest(run.at(time, whole, part), expected[step]) <= Same);
      }
      run.source->Modified();
      for (const double time : { 2.0, 3.0, 0.0 })
      {
        after->UpdateTimeStep(time);
        auto* output = outputOf(after);
        TAUTLINE_CHECK(farthest(spreadOf(whole, part, output), expected[time]) <= Same);
      }
      TAUTLINE_CHECK(messages.empty());
      TAUTLINE_CHECK(!contains(run.filter->GetSummary(), wording("put-together")));
    }
  }
  const RankPart part = partOf(whole, rank, cutBy(whole, Cut::Random, size));
  Run run(part, middle, vtkMeshWarp::TIME_STEPS, start);
  const std::vector<double> common = run.source->Times;
  if (rank == size - 1)
  {
    run.source->Times.push_back(5);
  }
  Messages messages(run.filter);
  run.filter->UpdateTimeStep(3.0);
  TAUTLINE_CHECK(messages.has("The time steps of process " + std::to_string(size - 1) +
    wording("from-the-time-steps-of-process") + "0"));
  TAUTLINE_CHECK_EQUAL(meshOf(run.filter)->GetNumberOfPoints(), 0);
  messages.clear();
  run.source->Times = common;
  run.source->Modified();
  run.filter->UpdateTimeStep(3.0);
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK_EQUAL(meshOf(run.filter)->GetNumberOfPoints(), part.data.numberOfPoints());
}

/// A stop on one process, or the time limit, ends all of them with the mesh so far.
void testStop(vtkMPIController* controller, const MeshData& whole, double middle)
{
  const Context context("stop");
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const RankPart part = partOf(whole, rank, cutBy(whole, Cut::Random, size));
  Run run(part, middle, vtkMeshWarp::TIME_STEPS, vtkMeshWarp::PREVIOUS_STEP);
  TAUTLINE_NEW(vtkCallbackCommand, stop, SetClientData(run.source.Get()));
  stop->SetCallback(
    [](vtkObject* caller, unsigned long, void* source, void*)
    {
      if (static_cast<MovingPieces*>(source)->Executions == 3) // the time step in between
      {
        static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(1);
      }
    });
  const unsigned long tag =
    rank == size - 1 ? run.filter->AddObserver(vtkCommand::ProgressEvent, stop) : 0;
  Messages messages(run.filter);
  run.filter->UpdateTimeStep(3.0);
  TAUTLINE_CHECK(contains(run.filter->GetSummary(), wording("stopped-on-request")));
  TAUTLINE_CHECK_EQUAL(meshOf(run.filter)->GetNumberOfPoints(), part.data.numberOfPoints());
  if (rank == size - 1)
  {
    run.filter->RemoveObserver(tag);
  }
  run.filter->SetAbortExecute(0);
  run.filter->Modified();
  const auto expected = aloneAt(3.0, controller, whole, middle, vtkMeshWarp::TIME_STEPS,
    vtkMeshWarp::PREVIOUS_STEP, [](Run&) {});
  TAUTLINE_CHECK(farthest(run.at(3.0, whole, part), expected) <= Same);
  TAUTLINE_CHECK(!contains(run.filter->GetSummary(), "Stopped"));
  run.filter->SetTimeLimit(1e-9);
  run.filter->UpdateTimeStep(2.0);
  TAUTLINE_CHECK(contains(run.filter->GetSummary(), wording("the-time-limit-was-reached")));
  // The steps after a limited one report it, also if they are not limited themselves.
  Run slow(part, middle, vtkMeshWarp::TIME_STEPS, vtkMeshWarp::PREVIOUS_STEP);
  slow.filter->SetTimeLimit(1e-9);
  const char* sentence = "An earlier time step reached the time limit";
  slow.filter->UpdateTimeStep(1.0);
  TAUTLINE_CHECK(!contains(slow.filter->GetSummary(), sentence));
  for (const double time : { 2.0, 3.0 })
  {
    slow.filter->UpdateTimeStep(time);
    TAUTLINE_CHECK(contains(slow.filter->GetSummary(), sentence));
  }
  slow.filter->SetTimeLimit(0);
  TAUTLINE_CHECK(farthest(slow.at(3.0, whole, part), expected) <= Same);
  TAUTLINE_CHECK(!contains(slow.filter->GetSummary(), sentence));
}

/// Hybrid optimizes in another order than one process: as valid, and the same for all cuts.
void testHybrid(vtkMPIController* controller, const MeshData& whole, double middle)
{
  const Context context("hybrid");
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const int motion = vtkMeshWarp::TIME_STEPS, start = vtkMeshWarp::PREVIOUS_STEP;
  const auto hybrid = [](Run& run)
  {
    run.filter->SetMethod(vtkMeshWarp::HYBRID);
    run.source->Degrees = 20;
  };
  const std::vector<double> one = aloneAt(3.0, controller, whole, middle, motion, start, hybrid);
  std::vector<double> expected;
  for (const Cut cut : { Cut::Random, Cut::Slabs })
  {
    const RankPart part = partOf(whole, rank, cutBy(whole, cut, size));
    Run run(part, middle, motion, start);
    hybrid(run);
    std::vector<double> here = run.at(3.0, whole, part), all(here.size());
    TAUTLINE_CHECK_EQUAL(run.filter->GetInverted(), 0);
    constexpr double similar = 0.3; // of the size of a cell
    TAUTLINE_CHECK(farthest(here, one) <= similar);
    std::replace(here.begin(), here.end(), HUGE_VAL, -HUGE_VAL);
    controller->AllReduce(
      here.data(), all.data(), static_cast<vtkIdType>(all.size()), vtkCommunicator::MAX_OP);
    expected = expected.empty() ? all : expected;
    TAUTLINE_CHECK(farthest(all, expected) <= Same);
  }
}

void testAll(vtkMPIController* controller)
{
  const MeshData planar = blockWithHole(CellType::Triangle);
  const MeshData volume = blockWithHole(CellType::Tetrahedron);
  for (const MeshData* mesh : { &planar, &volume })
  {
    const double middle = mesh == &planar ? PlanarMiddle : VolumeMiddle;
    const Context context(mesh == &planar ? "planar" : "volume");
    for (const int motion :
      { vtkMeshWarp::TIME_STEPS, vtkMeshWarp::DISPLACEMENT, vtkMeshWarp::TARGET })
    {
      for (const int start : { vtkMeshWarp::FIRST_STEP, vtkMeshWarp::PREVIOUS_STEP })
      {
        testSame(controller, *mesh, middle, motion, start);
      }
    }
    testHybrid(controller, *mesh, middle);
    testOtherPieces(controller, *mesh, middle);
  }
  testBeginsAgain(controller, planar, PlanarMiddle);
  testPutTogether(controller);
  testWrong(controller, planar, PlanarMiddle);
  testTimes(controller, planar, PlanarMiddle);
  testStop(controller, planar, PlanarMiddle);
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestMeshWarpTimePieces)
{
  TAUTLINE_NEW(vtkMPIController, controller, Initialize(&argc, &argv));
  vtkMultiProcessController::SetGlobalController(controller);
  TAUTLINE_RUN(testAll(controller));
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
}
