// SPDX-License-Identifier: BSD-3-Clause
// Optimize Mesh and Untangle Mesh on processes: points, tables and summaries are those of one
// process, however the mesh is cut.
#include "Check.h"
#include "ThreadRanks.h"
#include "VtkMeshes.h"

#include "vtkMeshOptimizer.h"
#include "vtkMeshUntangler.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkMPIController.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkTable.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

using namespace tautline;

namespace
{
vtkSmartPointer<vtkUnstructuredGrid> gridOf(const RankPart& part)
{
  auto grid = toGrid(part.data);
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  for (const unsigned char ghost : part.ghosts)
  {
    ghosts->InsertNextValue(ghost ? vtkDataSetAttributes::DUPLICATECELL : 0);
  }
  grid->GetCellData()->AddArray(ghosts);
  // Fixed points and limits, by the points of the whole mesh.
  vtkNew<vtkDoubleArray> fixed, limits;
  fixed->SetName("fixed");
  limits->SetName("limits");
  for (const Index p : part.pointOf)
  {
    fixed->InsertNextValue(p % 11 == 0);
    limits->InsertNextValue(p % 3 == 0 ? 0.05 : -1);
  }
  grid->GetPointData()->AddArray(fixed);
  grid->GetPointData()->AddArray(limits);
  return grid;
}

/// What a filter gives: points by those of the whole mesh (0 elsewhere), and numbers.
template <class Filter, class Set>
std::vector<double> pointsOf(
  const MeshData& whole, const RankPart& part, const Set& set, Filter* filter)
{
  const auto grid = gridOf(part);
  filter->SetInputData(grid);
  set(filter);
  Messages messages(filter);
  filter->Update();
  TAUTLINE_CHECK(!messages.has("ERROR: "));
  std::vector<double> points(whole.points.size(), HUGE_VAL);
  auto* output = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
  TAUTLINE_CHECK_EQUAL(output->GetNumberOfPoints(), grid->GetNumberOfPoints());
  TAUTLINE_CHECK_EQUAL(output->GetNumberOfCells(), grid->GetNumberOfCells());
  for (vtkIdType p = 0; p < output->GetNumberOfPoints(); ++p)
  {
    output->GetPoint(p, &points[3 * part.pointOf[p]]);
    double moved[3];
    output->GetPointData()->GetArray("Displacement")->GetTuple(p, moved);
    TAUTLINE_CHECK(std::abs(grid->GetPoint(p)[0] + moved[0] - output->GetPoint(p)[0]) <= 1e-14);
  }
  return points;
}

void checkSame(const std::vector<double>& here, const std::vector<double>& expected)
{
  double farthest = 0;
  for (std::size_t i = 0; i < here.size(); ++i)
  {
    farthest = std::max(farthest, here[i] == HUGE_VAL ? 0.0 : std::abs(here[i] - expected[i]));
  }
  TAUTLINE_CHECK(farthest <= 1e-10);
}

/// On all processes with the mesh cut, and on the first alone with all of it.
template <class Filter, class Set, class Check>
void testFilter(const char* name, vtkMPIController* controller, const MeshData& whole,
  const Set& set, const Check& check)
{
  const Context context(name);
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const auto all = [](Index) { return 0; };
  vtkNew<Filter> serial;
  serial->ReproducibleOrderOn();
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
}

/// Tables of a run are on the first process, with the numbers of one up to rounding.
void checkTables(vtkTable* serial, vtkTable* ranks, int rank, const char* column)
{
  TAUTLINE_CHECK_EQUAL(ranks->GetNumberOfRows(), rank == 0 ? serial->GetNumberOfRows() : 0);
  for (vtkIdType row = 0; row < ranks->GetNumberOfRows(); ++row)
  {
    TAUTLINE_CHECK_RELATIVE(ranks->GetValueByName(row, column).ToDouble(),
      serial->GetValueByName(row, column).ToDouble(), 1e-12);
  }
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
  testFilter<vtkMeshOptimizer>(
    "two objectives, tangled", controller, jittered(CellType::Tetrahedron, 5, 0.42),
    [](vtkMeshOptimizer* filter) { filter->SetPreset(vtkMeshOptimizer::UNIFORM_SIZE); },
    checkOptimizer);
}

void testUntangler(vtkMPIController* controller)
{
  testFilter<vtkMeshUntangler>(
    "untangle", controller, jittered(CellType::Tetrahedron, 6, 0.45), [](vtkMeshUntangler*) {},
    [](vtkMeshUntangler* serial, vtkMeshUntangler* ranks, int rank)
    {
      TAUTLINE_CHECK(ranks->GetInvertedBefore() > 0);
      TAUTLINE_CHECK(ranks->GetInvertedAfter() < ranks->GetInvertedBefore());
      TAUTLINE_CHECK_EQUAL(ranks->GetInvertedBefore(), serial->GetInvertedBefore());
      TAUTLINE_CHECK_EQUAL(ranks->GetInvertedAfter(), serial->GetInvertedAfter());
      TAUTLINE_CHECK_EQUAL(std::string(ranks->GetSummary()), std::string(serial->GetSummary()));
      checkTables(serial->GetHistory(), ranks->GetHistory(), rank, "Inverted");
    });
}

/// Blocks may be on different processes: a mesh in these is refused on all.
void testBlocks()
{
  const MeshData whole = jittered(CellType::Tetrahedron, 3, 0.2);
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, toGrid(whole));
  vtkNew<vtkMeshOptimizer> optimizer;
  vtkNew<vtkMeshUntangler> untangler;
  for (vtkMeshMotionAlgorithm* filter : { static_cast<vtkMeshMotionAlgorithm*>(optimizer),
         static_cast<vtkMeshMotionAlgorithm*>(untangler) })
  {
    filter->SetInputDataObject(0, blocks);
    Messages messages(filter);
    filter->Update();
    TAUTLINE_CHECK(messages.has("does not support meshes on several processes"));
  }
}

/// What is wrong on one process is an error on all, and what cannot be done is refused by name.
void testRefusals(vtkMPIController* controller)
{
  const int rank = controller->GetLocalProcessId(), size = controller->GetNumberOfProcesses();
  const MeshData whole = jittered(CellType::Tetrahedron, 3, 0.2);
  const auto refused = [&](const char* text, const std::function<void(vtkMeshOptimizer*)>& set,
                         const std::function<void(RankPart&)>& change)
  {
    const Context context(text);
    RankPart part = partOf(whole, rank, cutBy(whole, Cut::Random, size));
    change(part);
    vtkNew<vtkMeshOptimizer> filter;
    filter->SetInputData(gridOf(part));
    set(filter);
    Messages messages(filter);
    filter->Update();
    TAUTLINE_CHECK(messages.has(text));
    TAUTLINE_CHECK_EQUAL(
      filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL), 0);
  };
  const auto none = [](auto&&) {};
  refused(
    "Steps that improve the worst element",
    [](vtkMeshOptimizer* filter) { filter->SetPreset(vtkMeshOptimizer::WORST_ELEMENT); }, none);
  refused(
    "Points slide on curved surfaces",
    [](vtkMeshOptimizer* filter) { filter->SetBoundary(vtkMeshOptimizer::ON_SURFACE); }, none);
  refused(
    "switch Animation off", [](vtkMeshOptimizer* filter) { filter->AnimationOn(); }, none);
  refused("not finite", none,
    [&](RankPart& part)
    {
      if (rank == 1)
      {
        part.data.points[0] = HUGE_VAL;
      }
    });
  refused("opposite orders", none,
    [&](RankPart& part)
    {
      for (Index cell = 0; rank == 1 && cell < part.data.numberOfCells(); ++cell)
      {
        std::swap(part.data.connectivity[4 * cell], part.data.connectivity[4 * cell + 1]);
      }
    });
}
}

//------------------------------------------------------------------------------
int TestMotionRanks(int argc, char* argv[])
{
  vtkNew<vtkMPIController> controller;
  controller->Initialize(&argc, &argv);
  vtkMultiProcessController::SetGlobalController(controller);
  testOptimizer(controller);
  testUntangler(controller);
  testRefusals(controller);
  testBlocks();
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
  return exitCode();
}
