// SPDX-License-Identifier: BSD-3-Clause
// Optimize Mesh and Untangle Mesh on processes: points, tables and summaries equal the results of
// one process, however the mesh is cut.
#include "CollapsedMeshes.h"
#include "MotionRanks.h"
#include "Registry.h"
#include "tautline/Optimization/Optimize.h"
#include "vtkMeshOptimizer.h"
#include "vtkMeshUntangler.h"
#include "vtkStreamingDemandDrivenPipeline.h"

using namespace tautline;

namespace
{
std::string divided(int size, int how)
{
  return std::string("\nThe mesh was ") + wording("redistributed") + " among " +
    std::to_string(size) + " processes" +
    (how == vtkMeshMotionAlgorithm::PT_SCOTCH ? " by PT-Scotch." : ".");
}

/// On all processes with the mesh cut, and on the first alone with all of it.
template <class Filter, class Set, class Check>
void testFilter(const char* name, vtkMPIController* controller, const MeshData& whole,
  const Set& set, const Check& check)
{
  const Context context(name);
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const auto all = [](Index) { return 0; };
  TAUTLINE_NEW(Filter, serial, ReproducibleOrderOn());
  // Every process computes what one would, without the others.
  vtkMultiProcessController::SetGlobalController(nullptr);
  const std::vector<double> expected = pointsOf(whole, partOf(whole, 0, all), set, serial.Get());
  vtkMultiProcessController::SetGlobalController(controller);
  for (const Cut cut : { Cut::Slabs, Cut::Random })
  {
    const Context inner("cut " + std::to_string(static_cast<int>(cut)));
    const auto rankOf = cutBy(whole, cut, size);
    const RankPart part = partOf(whole, rank, rankOf, cut == Cut::Slabs);
    vtkNew<Filter> filter;
    checkSame(pointsOf(whole, part, set, filter.Get()), expected);
    check(serial.Get(), filter.Get(), rank);
    // More processes than pieces.
    const RankPart few =
      partOf(whole, rank, [&](Index cell) { return size > 2 && rankOf(cell) == 0 ? size - 1 : 1; });
    vtkNew<Filter> other;
    checkSame(pointsOf(whole, few, set, other.Get()), expected);
    check(serial.Get(), other.Get(), rank);
  }
  // All of it on the first process, redistributed.
  for (const int how : { vtkMeshMotionAlgorithm::KD_TREE, vtkMeshMotionAlgorithm::PT_SCOTCH })
  {
    const Context inner("redistributed " + std::to_string(how));
    const RankPart part = partOf(whole, rank, all);
    TAUTLINE_NEW(Filter, filter, SetRedistribute(how));
    checkSame(pointsOf(whole, part, set, filter.Get()), expected);
    check(serial.Get(), filter.Get(), rank);
    const std::string summary = filter->GetSummary();
    TAUTLINE_CHECK(contains(summary, divided(size, how)));
  }
}

/// Tables of a run are on the first process, with the numbers of one up to rounding.
void checkTables(vtkTable* serial, vtkTable* ranks, int rank, const char* column)
{
  TAUTLINE_CHECK_EQUAL(ranks->GetNumberOfRows(), rank == 0 ? serial->GetNumberOfRows() : 0);
  TAUTLINE_EACH(vtkIdType, row, ranks->GetNumberOfRows(),
    TAUTLINE_CHECK_RELATIVE(ranks->GetValueByName(row, column).ToDouble(),
      serial->GetValueByName(row, column).ToDouble(), 1e-12));
}

void checkOptimizer(vtkMeshOptimizer* serial, vtkMeshOptimizer* ranks, int rank)
{
  TAUTLINE_CHECK_EQUAL(ranks->GetIterations(), serial->GetIterations());
  TAUTLINE_CHECK_EQUAL(ranks->GetFreePoints(), serial->GetFreePoints());
  TAUTLINE_CHECK_EQUAL(ranks->GetInvertedBefore(), serial->GetInvertedBefore());
  TAUTLINE_CHECK_EQUAL(ranks->GetInvertedAfter(), serial->GetInvertedAfter());
  TAUTLINE_CHECK_EQUAL(ranks->GetStopReason(), serial->GetStopReason());
  checkTables(serial->GetHistory(), ranks->GetHistory(), rank, "Objective");
  for (const char* column :
    { "MeanBefore", "MeanAfter", "WorstAfter", "RMSAfter", "InvertedAfter" })
  {
    checkTables(serial->GetStatistics(), ranks->GetStatistics(), rank, column);
  }
}

void testOptimizer(vtkMPIController* controller)
{
  const MeshData tets = jittered(CellType::Tetrahedron, 4, 0.25);
  testFilter<vtkMeshOptimizer>(
    "fixed", controller, tets, [](vtkMeshOptimizer*) {}, checkOptimizer);
  testFilter<vtkMeshOptimizer>(
    "sliding", controller, jittered(CellType::Hexahedron, 4, 0.25),
    [](vtkMeshOptimizer* filter) { filter->SetBoundary(vtkMeshOptimizer::SLIDING); },
    checkOptimizer);
  testFilter<vtkMeshOptimizer>(
    "arrays", controller, jittered(CellType::Triangle, 8, 0.25),
    [](vtkMeshOptimizer* filter)
    {
      filter->SetInputArrayToProcess(2, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "fixed");
      filter->SetInputArrayToProcess(3, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "limits");
    },
    checkOptimizer);
  // Inverted elements everywhere: the largest values of the parts differ.
  testFilter<vtkMeshOptimizer>(
    "rescaled untangling", controller, jittered(CellType::Tetrahedron, 5, 0.5),
    [](vtkMeshOptimizer* filter)
    {
      TAUTLINE_SET(
        filter, AddObjectiveByName("untangle_beta"), AddObjectiveByName("imr"), SetBeta(0.01));
    },
    [](vtkMeshOptimizer* serial, vtkMeshOptimizer* ranks, int rank)
    {
      TAUTLINE_CHECK(serial->GetInvertedBefore() > 10);
      TAUTLINE_CHECK(serial->GetInvertedAfter() < serial->GetInvertedBefore());
      checkOptimizer(serial, ranks, rank);
    });
  testFilter<vtkMeshOptimizer>(
    "two objectives, tangled", controller, jittered(CellType::Tetrahedron, 5, 0.42),
    [](vtkMeshOptimizer* filter) { filter->SetPreset(vtkMeshOptimizer::UNIFORM_SIZE); },
    checkOptimizer);
}

/// Equal sizes at the cost of the shape of single elements: these are improved, no points put back.
void testGuard(vtkMPIController* controller)
{
  const MeshData whole = jittered(CellType::Tetrahedron, 5, 0.25);
  const auto worstOf = [](const MeshData& data)
  {
    const std::vector<double> q = valuesOf(data, Metric::ScaledJacobian);
    return *std::min_element(q.begin(), q.end());
  };
  testFilter<vtkMeshOptimizer>(
    "guard", controller, whole,
    [](vtkMeshOptimizer* filter)
    {
      filter->AddObjective(static_cast<int>(Metric::SizeNonBarrier));
      filter->SetWorstMetric(static_cast<int>(Metric::ScaledJacobian));
    },
    [&](vtkMeshOptimizer* serial, vtkMeshOptimizer* ranks, int rank)
    {
      for (vtkMeshOptimizer* filter : { serial, ranks })
      {
        const std::string summary = filter->GetSummary();
        TAUTLINE_CHECK(!contains(summary, wording("put-back")));
      }
      const MeshData after = toMesh(outputOf<vtkUnstructuredGrid>(serial));
      TAUTLINE_CHECK(worstOf(after) >= worstOf(whole) - 1e-9);
      checkOptimizer(serial, ranks, rank);
    });
}

/// The value of the worst element, and the sum of the squares, of the inverse mean ratio.
std::pair<double, double> shapeOf(const MeshData& data)
{
  const std::vector<double> q = valuesOf(data, Metric::InverseMeanRatio);
  return { *std::max_element(q.begin(), q.end()),
    std::inner_product(q.begin(), q.end(), q.begin(), 0.0) };
}

/// Moves the coordinates of inner points to their neighbors in single precision as long as the sum
/// gets smaller: better than what is best, rounded.
void improveInSingle(MeshData& data)
{
  const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
  double best = shapeOf(data).second;
  for (bool again = true; again;)
  {
    again = false;
    for (std::size_t i = 0; i < data.points.size(); ++i)
    {
      for (const float towards : { -HUGE_VALF, HUGE_VALF })
      {
        if (boundary[i / 3])
        {
          continue;
        }
        const double before = data.points[i];
        data.points[i] = static_cast<double>(std::nextafter(static_cast<float>(before), towards));
        const double sum = shapeOf(data).second;
        const bool better = sum < best * (1 - 1e-11);
        best = better ? sum : best;
        data.points[i] = better ? data.points[i] : before;
        again = again || better;
      }
    }
  }
}

/// Far from the origin single precision has few digits, and a mesh that is as good as it gets with
/// these is better than the best one, rounded: what is written is never worse.
void testSingle(vtkMPIController* controller)
{
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  constexpr double far = 1000, rounding = 1e-9;
  int single = 0, doubled = 0;
  for (const double amplitude : { 0.1, 0.2, 0.3 })
  {
    const bool best = amplitude > 0.1;
    MeshData whole = jittered(CellType::Tetrahedron, 4, amplitude);
    whole.points = best ? optimize(Mesh(whole.view()), OptimizeOptions()).points : whole.points;
    whole.transform([](const Vec3& p) { return p + Vec3{ far, far, far }; });
    for (double& x : whole.points)
    {
      x = static_cast<double>(static_cast<float>(x));
    }
    if (best && rank == 0) // it takes long
    {
      improveInSingle(whole);
    }
    controller->Broadcast(whole.points.data(), static_cast<vtkIdType>(whole.points.size()), 0);
    for (const int type : { VTK_FLOAT, VTK_DOUBLE })
    {
      const Context context(
        "type " + std::to_string(type) + ", amplitude " + std::to_string(amplitude));
      const auto run = [&](const RankPart& part, vtkMeshOptimizer* filter)
      {
        auto grid = TAUTLINE_CHANGED(gridOf(part), SetPoints(toPoints(part.data, type)));
        filter->ReproducibleOrderOn();
        return moved(
          whole, part, grid.Get(), [](vtkMeshOptimizer*) {}, filter);
      };
      const auto typeOf = [](vtkMeshOptimizer* filter)
      { return outputOf<vtkUnstructuredGrid>(filter)->GetPoints()->GetDataType(); };
      const auto note = [](vtkMeshOptimizer* filter)
      {
        const std::string summary = filter->GetSummary();
        const std::size_t at = summary.find("The points are given in double precision");
        return at == std::string::npos ? std::string()
                                       : summary.substr(at, summary.find('\n', at) - at);
      };
      vtkNew<vtkMeshOptimizer> serial;
      vtkMultiProcessController::SetGlobalController(nullptr);
      const std::vector<double> expected =
        run(partOf(whole, 0, [](Index) { return 0; }), serial.Get());
      vtkMultiProcessController::SetGlobalController(controller);
      MeshData after = TAUTLINE_CHANGED(whole, points = expected);
      const auto [worst, sum] = shapeOf(whole);
      const auto [worstNow, sumNow] = shapeOf(after);
      TAUTLINE_CHECK(worstNow <= worst * (1 + rounding));
      TAUTLINE_CHECK(sumNow <= sum * (1 + 1e-12));
      TAUTLINE_CHECK_EQUAL(note(serial).empty(), typeOf(serial) == type);
      single += typeOf(serial) == VTK_FLOAT;
      doubled += type == VTK_FLOAT && typeOf(serial) == VTK_DOUBLE;
      for (const Cut cut : { Cut::Slabs, Cut::Random })
      {
        const Context inner("cut " + std::to_string(static_cast<int>(cut)));
        const RankPart part = partOf(whole, rank, cutBy(whole, cut, size), cut == Cut::Slabs);
        vtkNew<vtkMeshOptimizer> filter;
        checkSame(run(part, filter.Get()), expected);
        TAUTLINE_CHECK_EQUAL(typeOf(filter), typeOf(serial));
        TAUTLINE_CHECK_EQUAL(note(filter), note(serial));
        checkOptimizer(serial, filter, rank);
      }
    }
  }
  if (rank == 0)
  {
    std::cout << single << " meshes in single precision, " << doubled << " in double instead\n";
  }
  TAUTLINE_CHECK(single > 0);
  TAUTLINE_CHECK(doubled > 0);
}

/// Weights and targets belong to cells: each process has the values of its own cells.
void testElementArrays(vtkMPIController* controller)
{
  const MeshData tets = jittered(CellType::Tetrahedron, 4, 0.25);
  constexpr int weights = 4, sizes = 0, tensors = 1; // indices of the arrays
  const auto choose = [](vtkMeshOptimizer* filter, int index, const char* name)
  { filter->SetInputArrayToProcess(index, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, name); };
  testFilter<vtkMeshOptimizer>(
    "weights", controller, tets,
    [&](vtkMeshOptimizer* filter) { choose(filter, weights, "weights"); }, checkOptimizer);
  testFilter<vtkMeshOptimizer>(
    "sizes", controller, tets,
    [&](vtkMeshOptimizer* filter)
    {
      filter->AddObjective(
        static_cast<int>(Metric::ShapeSizeBarrier), -1, 1.0, vtkMeshOptimizer::SIZE);
      choose(filter, sizes, "sizes");
    },
    checkOptimizer);
  testFilter<vtkMeshOptimizer>(
    "tensors", controller, jittered(CellType::Hexahedron, 4, 0.2),
    [&](vtkMeshOptimizer* filter)
    {
      filter->AddObjective(
        static_cast<int>(Metric::ShapeCondition), -1, 1.0, vtkMeshOptimizer::TENSOR);
      choose(filter, tensors, "tensors");
    },
    checkOptimizer);
  testFilter<vtkMeshOptimizer>(
    "mean size", controller, tets,
    [&](vtkMeshOptimizer* filter)
    {
      filter->SetPreset(vtkMeshOptimizer::UNIFORM_SIZE);
      filter->SetBoundary(vtkMeshOptimizer::FREE);
    },
    checkOptimizer);
}

/// Operations that gather the mesh, with the result of one process.
void testWholeMeshes(vtkMPIController* controller)
{
  const MeshData tets = jittered(CellType::Tetrahedron, 4, 0.25);
  testGathered<vtkMeshOptimizer>("worst element", controller, tets,
    "steps that improve the worst element need the whole mesh",
    [](vtkMeshOptimizer* filter, const RankPart&)
    { filter->SetPreset(vtkMeshOptimizer::WORST_ELEMENT); });
  for (const int objectiveTemplate : { vtkMeshOptimizer::P_MEAN, vtkMeshOptimizer::MAXIMUM })
  {
    testGathered<vtkMeshOptimizer>("p-mean or maximum", controller, tets,
      "the templates p-Mean and Maximum need the whole mesh",
      [=](vtkMeshOptimizer* filter, const RankPart&)
      { filter->AddObjectiveByName("imr", objectiveTemplate); });
  }
  MeshData ball = tets;
  ball.transform(
    [](const Vec3& p)
    {
      const Vec3 d = p - Vec3{ 2, 2, 2 };
      const double longest = std::max({ std::abs(d[0]), std::abs(d[1]), std::abs(d[2]) });
      return longest > 0 ? (longest / norm(d)) * d : d;
    });
  testGathered<vtkMeshOptimizer>("curved boundary", controller, ball,
    "points that slide on curved surfaces and geometries need the whole mesh",
    [](vtkMeshOptimizer* filter, const RankPart&)
    { filter->SetBoundary(vtkMeshOptimizer::ON_SURFACE); });
  testGathered<vtkMeshOptimizer>("features", controller, tets,
    "features that are shown need the whole mesh",
    [](vtkMeshOptimizer* filter, const RankPart&) { filter->ShowFeaturesOn(); });
  testGathered<vtkMeshOptimizer>("reference", controller, tets,
    "targets of a reference mesh need the whole mesh",
    [](vtkMeshOptimizer* filter, const RankPart& part)
    {
      RankPart reference = part;
      reference.data.transform(TAUTLINE_PLACE(p[0], p[1] + 0.3 * p[1] * p[1], p[2]));
      filter->SetPreset(vtkMeshOptimizer::PRESERVE_SHAPE);
      filter->SetInputDataObject(1, numberedGridOf(reference));
    });
  MeshData wave = jittered(CellType::Triangle, 8, 0.25);
  wave.transform(TAUTLINE_PLACE(p[0], p[1], 0.3 * std::sin(p[0])));
  const char* inSpace =
    "it is a surface in space, or in a plane that is not perpendicular to an axis";
  testGathered<vtkMeshOptimizer>(
    "surface", controller, wave, inSpace, [](vtkMeshOptimizer*, const RankPart&) {});
  MeshData turned = jittered(CellType::Triangle, 8, 0.8);
  turned.transform(TAUTLINE_PLACE(0.6 * p[0], p[1], 0.8 * p[0]));
  testGathered<vtkMeshUntangler>(
    "inclined plane", controller, turned, inSpace, [](vtkMeshUntangler*, const RankPart&) {});
}

void testUntangler(vtkMPIController* controller)
{
  testFilter<vtkMeshUntangler>(
    "untangle", controller, jittered(CellType::Tetrahedron, 6, 0.45), [](vtkMeshUntangler*) {},
    [controller](vtkMeshUntangler* serial, vtkMeshUntangler* ranks, int rank)
    {
      const std::string remark =
        ranks->GetRedistribute() == vtkMeshMotionAlgorithm::NO_REDISTRIBUTION
        ? ""
        : divided(controller->GetNumberOfProcesses(), ranks->GetRedistribute());
      TAUTLINE_CHECK(ranks->GetInvertedBefore() > 0);
      TAUTLINE_CHECK(ranks->GetInvertedAfter() < ranks->GetInvertedBefore());
      TAUTLINE_CHECK_EQUAL(ranks->GetInvertedBefore(), serial->GetInvertedBefore());
      TAUTLINE_CHECK_EQUAL(ranks->GetInvertedAfter(), serial->GetInvertedAfter());
      TAUTLINE_CHECK_EQUAL(std::string(ranks->GetSummary()), serial->GetSummary() + remark);
      checkTables(serial->GetHistory(), ranks->GetHistory(), rank, "Inverted");
    });
}

/// Hexahedra that list points twice are wedges on all processes, which are counted together.
void testCollapsed(vtkMPIController* controller)
{
  const auto check = [](auto* serial, auto* ranks, int)
  {
    const std::string sentence = "12 hexahedra that list points twice are measured as wedges.";
    TAUTLINE_CHECK(contains(serial->GetSummary(), sentence));
    TAUTLINE_CHECK(contains(ranks->GetSummary(), sentence));
    TAUTLINE_CHECK_EQUAL(ranks->GetInvertedBefore(), serial->GetInvertedBefore());
    TAUTLINE_CHECK_EQUAL(ranks->GetInvertedAfter(), 0);
  };
  testFilter<vtkMeshOptimizer>(
    "optimize collapsed", controller, wheel(true, 0.2),
    [](vtkMeshOptimizer* filter) { filter->AddObjectiveByName("imr"); }, check);
  testFilter<vtkMeshUntangler>(
    "untangle collapsed", controller, wheel(true, 0.9), [](vtkMeshUntangler*) {}, check);
}

/// A mesh with more inverted elements than others is not reversed by that, on processes either.
void testMostlyInverted(vtkMPIController* controller)
{
  MeshData inverted = jittered(CellType::Hexahedron, 4, 1.1);
  MeshData reversed = jittered(CellType::Hexahedron, 4, 0.2);
  reversed.transform(TAUTLINE_PLACE(-p[0], p[1], p[2]));
  for (const MeshData* whole : { &inverted, &reversed })
  {
    const Context context(whole == &reversed ? "reversed" : "mostly inverted");
    vtkNew<vtkMeshUntangler> serial, ranks;
    vtkMultiProcessController::SetGlobalController(nullptr);
    serial->SetInputData(gridOf(partOf(*whole, 0, [](Index) { return 0; })));
    serial->Update();
    vtkMultiProcessController::SetGlobalController(controller);
    TAUTLINE_SET(ranks,
      SetInputData(gridOf(partOf(*whole, controller->GetLocalProcessId(),
        cutBy(*whole, Cut::Random, controller->GetNumberOfProcesses())))),
      Update());
    const Index before = ranks->GetInvertedBefore();
    TAUTLINE_CHECK_EQUAL(before, serial->GetInvertedBefore());
    TAUTLINE_CHECK(whole == &reversed ? before == 0 : 2 * before > whole->numberOfCells());
    constexpr char remark[] = "The mesh is reversed: its cells list their points in the opposite "
                              "order, 64 of 64 being negative. It is treated as if its cells were "
                              "flipped.";
    for (vtkMeshUntangler* filter : { serial.Get(), ranks.Get() })
    {
      const bool remarked = contains(filter->GetSummary(), remark);
      TAUTLINE_CHECK_EQUAL(remarked, whole == &reversed);
    }
  }
}

/// Keeps the texts of a filter's progress, and stops it on the first process at one that begins so.
struct ProgressTexts
{
  ProgressTexts(vtkAlgorithm* filter, std::string stopAt, bool stops)
    : stopAt(std::move(stopAt))
    , stops(stops)
  {
    TAUTLINE_NEW(vtkCallbackCommand, command, SetClientData(this));
    command->SetCallback(
      [](vtkObject* caller, unsigned long, void* data, void*)
      {
        auto* filter = static_cast<vtkAlgorithm*>(caller);
        auto* self = static_cast<ProgressTexts*>(data);
        const std::string text = filter->GetProgressText() ? filter->GetProgressText() : "";
        self->found = self->found || text.rfind(self->stopAt, 0) == 0;
        filter->SetAbortExecute(self->found && self->stops ? 1 : 0);
      });
    filter->AddObserver(vtkCommand::ProgressEvent, command);
  }

  std::string stopAt;
  bool stops, found = false;
};

/// Shows iterations, can be stopped, and states why no point is free, as one process does.
void testAsOneProcess(vtkMPIController* controller)
{
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const MeshData tangled = jittered(CellType::Tetrahedron, 5, 0.45);
  const auto pieceOf = [&](const MeshData& whole)
  { return gridOf(partOf(whole, rank, cutBy(whole, Cut::Slabs, size))); };
  {
    const Context context("iterations");
    TAUTLINE_NEW(vtkMeshUntangler, filter, SetInputData(pieceOf(tangled)));
    const ProgressTexts texts(filter, "Untangle Mesh: iteration 1, objective ", false);
    filter->Update();
    TAUTLINE_CHECK(texts.found);
  }
  {
    const Context context("stopped while it untangles first");
    TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputData(pieceOf(tangled)));
    const ProgressTexts texts(filter, "Optimize Mesh: iteration 0", rank == 0);
    Messages messages(filter);
    filter->Update();
    TAUTLINE_CHECK(texts.found);
    TAUTLINE_CHECK_EQUAL(filter->GetStopReason(), static_cast<int>(StopReason::Aborted));
    TAUTLINE_CHECK(filter->GetInvertedBefore() > 0);
    TAUTLINE_CHECK_EQUAL(filter->GetHistory()->GetNumberOfRows(), 0); // no optimization began
    TAUTLINE_CHECK_EQUAL(filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL),
      filter->GetInputDataObject(0, 0)->GetNumberOfElements(vtkDataObject::CELL));
  }
  const MeshData small = jittered(CellType::Tetrahedron, 1, 0.0);
  const auto summaryOf = [&](bool alone, const std::function<void(vtkMeshOptimizer*)>& set)
  {
    vtkNew<vtkMeshOptimizer> filter;
    vtkMultiProcessController::SetGlobalController(alone ? nullptr : controller);
    const auto grid = alone ? gridOf(partOf(small, 0, [](Index) { return 0; })) : pieceOf(small);
    TAUTLINE_NEW(
      vtkDoubleArray, all, SetName("all"), SetNumberOfTuples(grid->GetNumberOfPoints()), Fill(1.0));
    grid->GetPointData()->AddArray(all);
    filter->SetInputData(grid);
    set(filter);
    filter->Update();
    vtkMultiProcessController::SetGlobalController(controller);
    const std::string text = filter->GetSummary();
    const std::size_t begin = text.find(wording("every-point-is"));
    return begin == std::string::npos ? "" : text.substr(begin, text.find('\n', begin) - begin);
  };
  std::set<std::string> reasons;
  for (const int boundary :
    { vtkMeshOptimizer::FIXED, vtkMeshOptimizer::SLIDING, vtkMeshOptimizer::FREE })
  {
    const Context context("boundary " + std::to_string(boundary));
    const auto set = [boundary](vtkMeshOptimizer* filter)
    {
      filter->SetBoundary(boundary);
      if (boundary == vtkMeshOptimizer::FREE)
      {
        constexpr int fixedPoints = 2; // index of the array
        filter->SetInputArrayToProcess(
          fixedPoints, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "all");
      }
    };
    const std::string expected = summaryOf(true, set);
    TAUTLINE_CHECK(!expected.empty());
    TAUTLINE_CHECK_EQUAL(summaryOf(false, set), expected);
    reasons.insert(expected);
  }
  TAUTLINE_CHECK_EQUAL(reasons.size(), std::size_t(3));
}

/// Blocks are gathered: one with a part on each process, and one on the last process only.
void testBlocks(vtkMPIController* controller)
{
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const MeshData whole = jittered(CellType::Tetrahedron, 3, 0.2);
  const RankPart part = partOf(whole, rank, cutBy(whole, Cut::Slabs, size));
  const RankPart all = partOf(whole, 0, [](Index) { return 0; });
  const auto blocksOf = [](const RankPart& first, const RankPart* second)
  {
    auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
    TAUTLINE_SET(blocks, SetNumberOfBlocks(2), SetBlock(0, numberedGridOf(first)),
      SetBlock(1, second ? numberedGridOf(*second).Get() : nullptr));
    return blocks;
  };
  vtkNew<vtkMeshOptimizer> serial, optimizer;
  vtkMultiProcessController::SetGlobalController(nullptr);
  TAUTLINE_SET(serial, SetInputDataObject(0, blocksOf(all, &all)), Update());
  vtkMultiProcessController::SetGlobalController(controller);
  optimizer->SetInputDataObject(0, blocksOf(part, rank == size - 1 ? &all : nullptr));
  Messages messages(optimizer);
  optimizer->Update();
  TAUTLINE_CHECK(!messages.has("ERROR: "));
  TAUTLINE_CHECK(
    contains(optimizer->GetSummary(), wording("put-together-on-the-first-process-it")));
  TAUTLINE_CHECK_EQUAL(optimizer->GetFreePoints(), serial->GetFreePoints());
  TAUTLINE_CHECK_EQUAL(optimizer->GetIterations(), serial->GetIterations());
  const auto block = [](vtkMeshOptimizer* filter, unsigned int i) {
    return vtkUnstructuredGrid::SafeDownCast(outputOf<vtkMultiBlockDataSet>(filter)->GetBlock(i));
  };
  std::vector<Vec3> expected(whole.numberOfPoints());
  for (std::size_t p = 0; p < all.pointOf.size(); ++p)
  {
    block(serial, 0)->GetPoint(static_cast<vtkIdType>(p), expected[all.pointOf[p]].data());
  }
  for (std::size_t p = 0; p < part.pointOf.size(); ++p)
  {
    Vec3 found;
    block(optimizer, 0)->GetPoint(static_cast<vtkIdType>(p), found.data());
    TAUTLINE_CHECK(norm(found - expected[part.pointOf[p]]) <= 1e-10);
  }
}

/// The iterations are time steps, the same on all processes, with the points of one process.
void testAnimation(vtkMPIController* controller)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  const Context context("animation");
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const MeshData whole = jittered(CellType::Tetrahedron, 4, 0.3);
  const RankPart part = partOf(whole, rank, cutBy(whole, Cut::Random, size));
  const RankPart all = partOf(whole, 0, [](Index) { return 0; });
  vtkNew<vtkMeshOptimizer> serial, optimizer;
  serial->SetInputData(numberedGridOf(all));
  optimizer->SetInputData(numberedGridOf(part));
  Messages messages(optimizer);
  serial->AnimationOn();
  optimizer->AnimationOn();
  std::vector<Vec3> before(whole.numberOfPoints());
  for (const double time : { 2.0, 0.0, 1.0 })
  {
    vtkMultiProcessController::SetGlobalController(nullptr);
    serial->UpdateTimeStep(time);
    vtkMultiProcessController::SetGlobalController(controller);
    optimizer->UpdateTimeStep(time);
    const auto steps = [](vtkAlgorithm* filter)
    { return filter->GetOutputInformation(0)->Length(Pipeline::TIME_STEPS()); };
    TAUTLINE_CHECK_EQUAL(steps(optimizer), steps(serial));
    TAUTLINE_CHECK(steps(serial) > 3 && steps(serial) < 50);
    std::vector<Vec3> expected(whole.numberOfPoints());
    for (std::size_t p = 0; p < all.pointOf.size(); ++p)
    {
      outputOf<vtkPointSet>(serial)->GetPoint(
        static_cast<vtkIdType>(p), expected[all.pointOf[p]].data());
    }
    for (std::size_t p = 0; p < part.pointOf.size(); ++p)
    {
      Vec3 found;
      outputOf<vtkPointSet>(optimizer)->GetPoint(static_cast<vtkIdType>(p), found.data());
      TAUTLINE_CHECK(norm(found - expected[part.pointOf[p]]) <= 1e-10);
    }
    TAUTLINE_CHECK(expected != before);
    before = expected;
  }
  TAUTLINE_CHECK(messages.empty());
}

/// An error on one process is an error on all, and unsupported operations are rejected by name.
void testRejections(vtkMPIController* controller)
{
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const MeshData whole = jittered(CellType::Tetrahedron, 3, 0.2);
  const auto rejected = [&](const char* text, const std::function<void(vtkMeshOptimizer*)>& set,
                          const std::function<void(RankPart&)>& change)
  {
    const Context context(text);
    RankPart part = partOf(whole, rank, cutBy(whole, Cut::Random, size));
    change(part);
    TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputData(gridOf(part)));
    set(filter);
    Messages messages(filter);
    filter->Update();
    TAUTLINE_CHECK(messages.has(text));
    TAUTLINE_CHECK_EQUAL(
      filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL), 0);
  };
  const auto none = [](auto&&) {};
  rejected(
    wording("switch-animation-off"),
    [](vtkMeshOptimizer* filter) { TAUTLINE_SET(filter, AnimationOn(), ReproducibleOrderOn()); },
    none);
  rejected(
    "'none'",
    [](vtkMeshOptimizer* filter)
    { filter->SetInputArrayToProcess(4, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "none"); },
    none);
  rejected(
    wording("weights-must-be-finite-and-at-least"),
    [](vtkMeshOptimizer* filter)
    { filter->SetInputArrayToProcess(4, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "wrong"); },
    none);
}

/// An error of any one process, in a mesh to untangle.
void testUntanglerFailures(vtkMPIController* controller)
{
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const MeshData whole = jittered(CellType::Tetrahedron, 5, 0.45);
  for (int wrong = 0; wrong < size; ++wrong)
  {
    const Context context("process " + std::to_string(wrong));
    // It has not the array of the fixed points: an error on all.
    RankPart part = partOf(whole, rank, cutBy(whole, Cut::Random, size));
    const auto grid = gridOf(part);
    if (rank == wrong)
    {
      grid->GetPointData()->RemoveArray("fixed");
    }
    TAUTLINE_NEW(vtkMeshUntangler, filter, SetInputData(grid),
      SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "fixed"));
    Messages messages(filter);
    filter->Update();
    TAUTLINE_CHECK(messages.has("In process " + std::to_string(wrong) + ": "));
    TAUTLINE_CHECK(messages.has("'fixed'"));
    TAUTLINE_CHECK_EQUAL(
      filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL), 0);
    // A point of it is not finite: the mesh is gathered, and all say why.
    part.data.points[7] = rank == wrong ? std::nan("") : part.data.points[7];
    TAUTLINE_NEW(
      vtkMeshUntangler, gathered, SetInputData(gridOf(part)), SetBoundary(vtkMeshUntangler::FIXED));
    Messages others(gathered);
    gathered->Update();
    TAUTLINE_CHECK(!others.has("ERROR: "));
    const std::string why = "its pieces could not be joined. In process " + std::to_string(wrong) +
      ": Point 2 has a coordinate that is not finite";
    TAUTLINE_CHECK(contains(gathered->GetSummary(), why));
    TAUTLINE_CHECK(gathered->GetInvertedAfter() > 0);
    TAUTLINE_CHECK(gathered->GetInvertedAfter() < gathered->GetInvertedBefore());
    TAUTLINE_CHECK_EQUAL(gathered->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL),
      part.data.numberOfCells());
  }
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestMotionRanks)
{
  TAUTLINE_NEW(vtkMPIController, controller, Initialize(&argc, &argv));
  vtkMultiProcessController::SetGlobalController(controller);
  TAUTLINE_RUN(testOptimizer(controller));
  TAUTLINE_RUN(testGuard(controller));
  TAUTLINE_RUN(testSingle(controller));
  TAUTLINE_RUN(testElementArrays(controller));
  TAUTLINE_RUN(testWholeMeshes(controller));
  TAUTLINE_RUN(testUntangler(controller));
  TAUTLINE_RUN(testAsOneProcess(controller));
  TAUTLINE_RUN(testCollapsed(controller));
  TAUTLINE_RUN(testMostlyInverted(controller));
  TAUTLINE_RUN(testAnimation(controller));
  TAUTLINE_RUN(testRejections(controller));
  TAUTLINE_RUN(testUntanglerFailures(controller));
  TAUTLINE_RUN(testBlocks(controller));
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
}
