// SPDX-License-Identifier: BSD-3-Clause
// Optimize Mesh gathers on the first process: the points equal the result of one process, the
// summary states the reason on all processes, and an error of one process is an error of all.
#include "MotionRanks.h"
#include "MovableMesh.h"
#include "Registry.h"
#include "Surfaces.h"
#include "vtkMeshOptimizer.h"

using namespace tautline;

namespace
{
constexpr int SizeOfBlock = 4;               // cubes along each edge
constexpr int FeatureKinds = 5, Regions = 6; // indices of arrays
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();

MeshData block()
{
  return jittered(CellType::Tetrahedron, SizeOfBlock, 0.25);
}

/// Every cell with its first point below the middle lists its points in the opposite order: the cut
/// in two slabs has them in one piece.
MeshData halfTurned()
{
  MeshData data = block();
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    const auto begin = data.connectivity.begin() + data.offsets[cell];
    if (data.point(*begin)[0] < 0.5 * SizeOfBlock)
    {
      std::swap(begin[2], begin[3]);
    }
  }
  return data;
}

/// Geometries, arrays of the features, and objectives that need the whole mesh.
void testSettings(vtkMPIController* controller)
{
  // A cube made round, and the surface it is to lie on, a little larger.
  const Vec3 middle = { 2, 2, 2 };
  MeshData ball = block();
  ball.transform(
    [&](const Vec3& p)
    {
      const Vec3 d = p - middle;
      const double longest = std::max({ std::abs(d[0]), std::abs(d[1]), std::abs(d[2]) });
      return longest > 0 ? middle + (longest / norm(d)) * d : p;
    });
  MeshData sphere = sphereSurface(CellType::Quadrilateral, 8);
  sphere.transform([&](const Vec3& p) { return middle + 2.05 * p; });
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  testGathered<vtkMeshOptimizer>("geometry", controller, ball,
    "points that slide on curved surfaces and geometries need the whole mesh",
    [&](vtkMeshOptimizer* filter, const RankPart&)
    {
      // The geometry is also in pieces.
      const bool alone = !vtkMultiProcessController::GetGlobalController();
      const RankPart here = partOf(sphere, rank,
        alone ? std::function<int(Index)>([=](Index) { return rank; })
              : cutBy(sphere, Cut::Slabs, size));
      filter->SetBoundary(vtkMeshOptimizer::ON_SURFACE);
      filter->SetInputDataObject(3, numberedGridOf(here));
    });
  testGathered<vtkMeshOptimizer>("regions", controller, block(),
    "regions and feature kinds need the whole mesh",
    [](vtkMeshOptimizer* filter, const RankPart&)
    {
      filter->SetInputArrayToProcess(
        Regions, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "regions");
    });
  testGathered<vtkMeshOptimizer>("feature kinds", controller, block(),
    "regions and feature kinds need the whole mesh",
    [](vtkMeshOptimizer* filter, const RankPart&)
    {
      filter->SetInputArrayToProcess(
        FeatureKinds, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "kinds");
    });
}

/// Pieces that do not fit, and what one process can do.
void testPieces(vtkMPIController* controller)
{
  const auto none = [](vtkMeshOptimizer*, const RankPart&) {};
  testGathered<vtkMeshOptimizer>("opposite orders", controller, halfTurned(), oppositeOrders, none);
  MeshData huge = block();
  huge.transform([](const Vec3& p) { return 1e200 * p; });
  testGathered<vtkMeshOptimizer>(
    "size", controller, huge, "its coordinates are of extreme size", none);
}

/// The change of a part before it becomes an input.
using Change = std::function<vtkSmartPointer<vtkDataObject>(const RankPart&)>;

/// The outcome of a run of the filter: its error, or the summary.
struct Outcome
{
  bool rejected = false, named = false; ///< there is an error, with the text
  bool image = false;
  vtkIdType cells = 0;
  std::string summary;
};

Outcome outcomeOf(const char* text, const RankPart& part, const Change& change, bool merge)
{
  TAUTLINE_NEW(
    vtkMeshOptimizer, filter, SetMergeCoincidentPoints(merge), SetInputDataObject(0, change(part)));
  Messages messages(filter);
  filter->Update();
  return TAUTLINE_CHANGED(Outcome(), rejected = messages.has("ERROR: "), named = messages.has(text),
    image = outputOf<vtkImageData>(filter),
    cells = filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL),
    summary = filter->GetSummary() ? filter->GetSummary() : "");
}

/// The same error on each process, also on those that have nothing wrong.
void testRejected(const char* text, vtkMPIController* controller, const Change& change, bool merge)
{
  const Context context(text);
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const MeshData whole = block();
  for (const Cut cut : { Cut::Slabs, Cut::Random })
  {
    const RankPart part = partOf(whole, rank, cutBy(whole, cut, size));
    const Outcome outcome = outcomeOf(text, part, change, merge);
    TAUTLINE_CHECK(outcome.rejected && outcome.named);
    TAUTLINE_CHECK(outcome.cells == 0 || outcome.image); // which keeps its extent
    TAUTLINE_CHECK_EQUAL(outcome.summary, std::string());
  }
}

/// The same text in the summaries of all processes.
bool isShared(vtkMPIController* controller, const std::string& text)
{
  int length = static_cast<int>(text.size());
  controller->Broadcast(&length, 1, 0);
  std::string first = text;
  first.resize(length);
  controller->Broadcast(first.data(), length, 0);
  return first == text;
}

/// A message of the pieces that does not keep the filter from its work in one place; the summary
/// has it on all processes.
void testStated(const char* text, vtkMPIController* controller, const Change& change, bool merge)
{
  const Context context(text);
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const MeshData whole = block();
  for (const Cut cut : { Cut::Slabs, Cut::Random })
  {
    const RankPart part = partOf(whole, rank, cutBy(whole, cut, size));
    const Outcome outcome = outcomeOf(text, part, change, merge);
    TAUTLINE_CHECK(!outcome.rejected);
    TAUTLINE_CHECK_EQUAL(outcome.cells, static_cast<vtkIdType>(part.cellOf.size()));
    const std::string sentence =
      "\nThe mesh was put together on the first process: its pieces could not be joined. ";
    const std::size_t at = outcome.summary.find(sentence);
    TAUTLINE_CHECK(at != std::string::npos && outcome.summary.find(text, at) != std::string::npos);
    TAUTLINE_CHECK(!contains(outcome.summary, ".."));
    TAUTLINE_CHECK(isShared(controller, outcome.summary));
  }
}

/// A point inside that is not finite: its cells are left out, as on one process.
void testNotFinite(vtkMPIController* controller)
{
  const Context context("not finite");
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  constexpr Index inside = 62; // the middle of 5 x 5 x 5 points
  const Change change = [](const RankPart& part)
  {
    auto grid = numberedGridOf(part);
    for (std::size_t p = 0; p < part.pointOf.size(); ++p)
    {
      if (part.pointOf[p] == inside)
      {
        grid->GetPoints()->SetPoint(static_cast<vtkIdType>(p), NaN, 0, 0);
      }
    }
    return grid;
  };
  testStated(wording("has-a-coordinate-that-is-not-finite"), controller, change, true);
  const MeshData whole = block();
  const auto pointsOf = [&](const RankPart& part)
  {
    TAUTLINE_NEW(vtkMeshOptimizer, filter, SetInputDataObject(0, change(part)), Update());
    TAUTLINE_CHECK(contains(filter->GetSummary(), wording("1-points-have-a-nan")));
    TAUTLINE_CHECK_EQUAL(filter->GetFreePoints(), 26); // of 3 x 3 x 3
    std::vector<double> points(whole.points.size(), HUGE_VAL);
    auto* output = outputOf<vtkUnstructuredGrid>(filter);
    for (std::size_t p = 0; p < part.pointOf.size(); ++p)
    {
      double* x = &points[3 * part.pointOf[p]];
      output->GetPoint(static_cast<vtkIdType>(p), x);
      if (part.pointOf[p] == inside)
      {
        TAUTLINE_CHECK(std::isnan(x[0]));
        x[0] = 0;
      }
    }
    return points;
  };
  vtkMultiProcessController::SetGlobalController(nullptr);
  const std::vector<double> expected = pointsOf(partOf(whole, 0, [](Index) { return 0; }));
  vtkMultiProcessController::SetGlobalController(controller);
  for (const Cut cut : { Cut::Slabs, Cut::Random })
  {
    checkSame(pointsOf(partOf(whole, rank, cutBy(whole, cut, size))), expected);
  }
}

/// A tetrahedron with a point on each edge.
MeshData quadratic()
{
  constexpr int edges[6][2] = { { 0, 1 }, { 1, 2 }, { 0, 2 }, { 0, 3 }, { 1, 3 }, { 2, 3 } };
  const std::vector<Vec3> corners = { { 9, 9, 9 }, { 10, 9, 9 }, { 9, 10, 9 }, { 9, 9, 10 } };
  TAUTLINE_LET(MeshData, data, addPoints(corners));
  for (const auto& edge : edges)
  {
    data.addPoint(0.5 * (corners[edge[0]] + corners[edge[1]]));
  }
  data.addCell(VTK_QUADRATIC_TETRA, { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9 });
  return data;
}

/// Curved cells, which one process only has, are optimized on the first one.
void testCurved(vtkMPIController* controller)
{
  const char* text = wording("curved-cells-need-the-whole-mesh");
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const bool last = rank == size - 1;
  const MeshData whole = block();
  const RankPart part = partOf(whole, rank, cutBy(whole, Cut::Slabs, size));
  const Outcome outcome = outcomeOf(
    text, part,
    [=](const RankPart& own) -> vtkSmartPointer<vtkDataObject>
    { return last ? toGrid(quadratic()) : numberedGridOf(own); },
    true);
  TAUTLINE_CHECK(!outcome.rejected);
  TAUTLINE_CHECK(contains(outcome.summary, text));
  TAUTLINE_CHECK_EQUAL(outcome.cells, last ? 1 : static_cast<vtkIdType>(part.cellOf.size()));
  TAUTLINE_CHECK(isShared(controller, outcome.summary));
}

/// Errors of the last process only.
void testErrors(vtkMPIController* controller)
{
  const bool last = controller->GetLocalProcessId() == controller->GetNumberOfProcesses() - 1;
  testStated(
    wording("there-are-none-run-generate-global-ids"), controller,
    [=](const RankPart& part)
    {
      auto grid = numberedGridOf(part);
      last ? static_cast<void>(grid->GetPointData()->SetGlobalIds(nullptr)) : void();
      return grid;
    },
    false);
  testRejected(
    wording("points-at-different-places-have-the-global"), controller,
    [=](const RankPart& part)
    {
      auto grid = numberedGridOf(part);
      vtkDataArray* ids = grid->GetPointData()->GetGlobalIds();
      ids->SetComponent(0, 0, ids->GetComponent(last ? 1 : 0, 0));
      return grid;
    },
    false);
  testRejected(
    wording("are-implicit-and-cannot-move"), controller,
    [=](const RankPart& part) -> vtkSmartPointer<vtkDataObject>
    {
      if (!last)
      {
        return numberedGridOf(part);
      }
      return TAUTLINE_CHANGED(vtkSmartPointer<vtkImageData>::New(), SetDimensions(3, 3, 3));
    },
    true);
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestGatheredMotion)
{
  TAUTLINE_NEW(vtkMPIController, controller, Initialize(&argc, &argv));
  vtkMultiProcessController::SetGlobalController(controller);
  TAUTLINE_RUN(testSettings(controller));
  TAUTLINE_RUN(testPieces(controller));
  TAUTLINE_RUN(testNotFinite(controller));
  TAUTLINE_RUN(testErrors(controller));
  TAUTLINE_RUN(testCurved(controller));
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
}
