// SPDX-License-Identifier: BSD-3-Clause
// Meshes and composite data on several processes: the numbers of Element Quality equal the numbers
// of the whole mesh on one process, also where pieces are inverted; a block that is wrong on one
// process is an error on all, and none waits for another; blocks with a seam between them are one
// mesh of the solvers, whichever process has them.
#include "Registry.h"
#include "ThreadRanks.h"
#include "VtkMeshes.h"
#include "tautline/Mesh/CellOrder.h"
#include "vtkConditionEstimator.h"
#include "vtkElementQuality.h"
#include "vtkEllipticSolver.h"
#include "vtkMPIController.h"
#include "vtkSolverStudy.h"

using namespace tautline;

namespace
{
constexpr double Rounding = 1e-13; // of sums in another order

/// The rank that has a cell: `ranks - 1` of more than two ranks has none.
using Owner = std::function<int(Index cell, int takers)>;

int scattered(Index cell, int takers)
{
  return static_cast<int>(cell % takers);
}

/// All points, and the cells of one rank, with global ids.
vtkSmartPointer<vtkUnstructuredGrid> pieceOf(
  const MeshData& whole, const Owner& owner, int rank, int ranks)
{
  const int takers = ranks > 2 ? ranks - 1 : ranks;
  TAUTLINE_LET(MeshData, data, points = whole.points);
  TAUTLINE_NEW(vtkIdTypeArray, ids, SetName("ids"));
  for (Index cell = 0; cell < whole.numberOfCells(); ++cell)
  {
    if (owner(cell, takers) == rank)
    {
      data.addCell(static_cast<int>(whole.types[cell]), whole.nodes(cell));
      ids->InsertNextValue(cell);
    }
  }
  if (data.numberOfCells() == 0)
  {
    return vtkSmartPointer<vtkUnstructuredGrid>::New();
  }
  return TAUTLINE_CHANGED(toGrid(data), GetCellData()->SetGlobalIds(ids));
}

void setUp(vtkElementQuality* filter)
{
  for (const char* metric : { "imr", "mean_ratio", "scaled_jacobian" })
  {
    filter->AddMetricByName(metric);
  }
  TAUTLINE_SET(filter, SetCriteria("fem"), SetExtractBad(true));
}

/// Two values of tables or arrays of all types.
void compareArrays(vtkAbstractArray* found, vtkAbstractArray* expected)
{
  const Context context(expected->GetName() ? expected->GetName() : "");
  if (!TAUTLINE_CHECK(found && found->GetNumberOfValues() == expected->GetNumberOfValues()))
  {
    return;
  }
  for (vtkIdType i = 0; i < expected->GetNumberOfValues(); ++i)
  {
    const vtkVariant a = found->GetVariantValue(i), b = expected->GetVariantValue(i);
    if (b.IsString())
    {
      TAUTLINE_CHECK_EQUAL(a.ToString(), b.ToString());
    }
    else if (!std::isnan(b.ToDouble()) || !std::isnan(a.ToDouble()))
    {
      TAUTLINE_CHECK_RELATIVE(a.ToDouble(), b.ToDouble(), Rounding);
    }
  }
}

void compareTables(vtkAlgorithm* found, vtkAlgorithm* expected)
{
  int tables = 0;
  for (int port = 1; port < expected->GetNumberOfOutputPorts(); ++port)
  {
    auto* table = vtkTable::SafeDownCast(expected->GetOutputDataObject(port));
    auto* other = vtkTable::SafeDownCast(found->GetOutputDataObject(port));
    for (vtkIdType c = 0; table && c < table->GetNumberOfColumns(); ++c)
    {
      compareArrays(other->GetColumnByName(table->GetColumnName(c)), table->GetColumn(c));
    }
    tables += table && table->GetNumberOfRows() > 0;
  }
  TAUTLINE_CHECK_EQUAL(tables, 5);
}

/// The arrays of the cells of a piece are those in the whole mesh.
void compareCells(vtkDataSet* piece, vtkDataSet* whole)
{
  for (const char* name : { "imr", "scaled_jacobian", "Validity", "Grade", "QualityIndex" })
  {
    const Context context(name);
    for (vtkIdType cell = 0; cell < piece->GetNumberOfCells(); ++cell)
    {
      const auto id = static_cast<vtkIdType>(piece->GetCellData()->GetGlobalIds()->GetTuple1(cell));
      const double a = component(piece->GetCellData(), name, cell);
      const double b = component(whole->GetCellData(), name, id);
      TAUTLINE_CHECK(a == b || (std::isnan(a) && std::isnan(b)));
    }
  }
}

/// @param inverted the number of inverted cells that there are at least
void compareQuality(
  const char* name, const MeshData& mesh, const Owner& owner, Index inverted, int rank, int ranks)
{
  const Context context(name);
  vtkNew<vtkElementQuality> whole, part;
  setUp(whole);
  setUp(part);
  whole->SetController(nullptr);
  const auto grid = pieceOf(
    mesh, [](Index, int) { return 0; }, 0, 1);
  whole->SetInputData(grid);
  part->SetInputData(pieceOf(mesh, owner, rank, ranks));
  whole->Update();
  part->Update();
  TAUTLINE_CHECK(whole->GetStatistics()->GetValueByName(0, "Inverted").ToInt() >= inverted);
  compareCells(outputOf(part), outputOf(whole));
  TAUTLINE_CHECK_EQUAL(std::string(part->GetVerdict()), std::string(whole->GetVerdict()));
  TAUTLINE_CHECK_RELATIVE(part->GetQualityIndex(), whole->GetQualityIndex(), Rounding);
  if (rank == 0)
  {
    compareTables(part, whole);
    compareArrays(part->GetWorst()->GetPointData()->GetArray("CellId"),
      whole->GetWorst()->GetPointData()->GetArray("CellId"));
    compareArrays(
      part->GetWorst()->GetPoints()->GetData(), whole->GetWorst()->GetPoints()->GetData());
    TAUTLINE_CHECK_EQUAL(std::string(part->GetSummary()), std::string(whole->GetSummary()));
  }
}

void testQuality(int rank, int ranks)
{
  constexpr Index n = 5;
  const MeshData moved = movedBlock(CellType::Tetrahedron, n, 0.15);
  compareQuality("valid", moved, scattered, 0, rank, ranks);
  const MeshData tangled = movedBlock(CellType::Tetrahedron, n, 0.4);
  compareQuality("tangled", tangled, scattered, 10, rank, ranks);
  // The inverted cells by themselves on one rank, as if they were listed in the opposite order.
  const auto grid = toGrid(tangled);
  vtkNew<vtkElementQuality> measured;
  setUp(measured);
  TAUTLINE_SET(measured, SetController(nullptr), SetInputData(grid), Update());
  auto* of = outputOf(measured);
  compareQuality(
    "inverted apart", tangled,
    [of](Index cell, int takers)
    { return component(of->GetCellData(), "Validity", cell) < 0 ? takers - 1 : 0; },
    10, rank, ranks);
  // All reversed on all ranks: the mesh is treated as if flipped.
  MeshData reversed = TAUTLINE_CHANGED(moved, swapNodes(0, 1));
  compareQuality("reversed", reversed, scattered, 0, rank, ranks);
}

//------------------------------------------------------------------------------
/// A way in which a block can be wrong, and what the message has besides the block.
using Change = std::function<void(vtkUnstructuredGrid*)>;
struct Spoil
{
  Change change;
  const char* text;
};

void cutConnectivity(vtkUnstructuredGrid* grid)
{
  grid->GetCells()->GetConnectivityArray()->SetComponent(0, 0, 1e6);
}

void addQuadraticCell(vtkUnstructuredGrid* grid)
{
  grid->GetCellData()->Initialize();
  const vtkIdType ids[] = { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9 };
  grid->InsertNextCell(VTK_QUADRATIC_TETRA, 10, ids);
}

void repeatCell(vtkUnstructuredGrid* grid)
{
  grid->GetCellData()->Initialize();
  vtkNew<vtkIdList> ids;
  TAUTLINE_SET(grid, GetCellPoints(0, ids), InsertNextCell(grid->GetCellType(0), ids));
}

void moveToNaN(vtkUnstructuredGrid* grid)
{
  grid->GetPoints()->SetPoint(0, std::numeric_limits<double>::quiet_NaN(), 0, 0);
}

void removeSizes(vtkUnstructuredGrid* grid)
{
  grid->GetCellData()->RemoveArray("sizes");
}

vtkSmartPointer<vtkUnstructuredGrid> blockWithSizes(Index n)
{
  auto grid = toGrid(blockMesh(CellType::Tetrahedron, n, n, n));
  TAUTLINE_NEW(vtkDoubleArray, sizes, SetName("sizes"), SetNumberOfValues(grid->GetNumberOfCells()),
    Fill(0.2));
  grid->GetCellData()->AddArray(sizes);
  return grid;
}

/// A block of each rank's own and one with a part on each rank; then one that is wrong on the last
/// rank only, and right again.
template <class Filter>
void testSpoiled(const char* name, int rank, int ranks, const std::vector<Spoil>& ways,
  const std::function<void(Filter*)>& choose)
{
  const Context context(name);
  vtkNew<Filter> filter;
  Messages messages(filter);
  choose(filter);
  // Blocks of their own are far apart.
  const auto update = [&](const Change& change)
  {
    vtkNew<vtkMultiBlockDataSet> blocks;
    for (int i = 0; i < ranks; ++i)
    {
      auto grid = blockWithSizes(3);
      for (vtkIdType p = 0; p < grid->GetNumberOfPoints(); ++p)
      {
        double x[3];
        TAUTLINE_SET(grid, GetPoint(p, x), GetPoints()->SetPoint(p, x[0] + 10.0 * i, x[1], x[2]));
      }
      if (change && i == ranks - 1)
      {
        change(grid);
      }
      blocks->SetBlock(i, i == rank ? grid.Get() : nullptr);
    }
    messages.clear();
    TAUTLINE_SET(filter, SetInputDataObject(0, blocks), Update());
    auto* output = outputOf<vtkMultiBlockDataSet>(filter);
    return output->GetNumberOfCells();
  };
  TAUTLINE_CHECK(update({}) > 0);
  TAUTLINE_CHECK(messages.empty());
  for (const Spoil& way : ways)
  {
    const Context which(way.text);
    TAUTLINE_CHECK_EQUAL(update(way.change), 0);
    TAUTLINE_CHECK(messages.has(way.text));
    TAUTLINE_CHECK(messages.has("block " + std::to_string(ranks)));
  }
  TAUTLINE_CHECK(update({}) > 0);
  TAUTLINE_CHECK(messages.empty());
}

void testWrongBlocks(int rank, int ranks)
{
  const Spoil ids = { cutConnectivity, "point 1000000" };
  testSpoiled<vtkElementQuality>("Element Quality", rank, ranks, { ids, { removeSizes, "size" } },
    [](vtkElementQuality* filter)
    {
      TAUTLINE_SET(filter, AddMetricByName("imr"), SetTargetType(vtkElementQuality::SIZE),
        SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "sizes"));
    });
  const std::vector<Spoil> ways = { ids, { addQuadraticCell, "Tessellate" },
    { repeatCell, "the same points" }, { moveToNaN, "finite" } };
  testSpoiled<vtkEllipticSolver>("Solve PDE", rank, ranks, ways, [](vtkEllipticSolver*) {});
  // The others take their input as this one does.
  testSpoiled<vtkConditionEstimator>(
    "Condition", rank, ranks, { ids }, [](vtkConditionEstimator*) {});
  testSpoiled<vtkSolverStudy>("Solver Study", rank, ranks, { ways.back() },
    [](vtkSolverStudy* filter) { filter->AddCombination(1); });
}

//------------------------------------------------------------------------------
/// The blocks of a test, and which cells of a block a rank has.
using BlockOwner = std::function<bool(int block, Index cell)>;

/// Some cells of the blocks, with the points of these.
vtkSmartPointer<vtkMultiBlockDataSet> blocksOf(
  const std::vector<MeshData>& meshes, const BlockOwner& owns, bool ids)
{
  auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  std::map<Vec3, vtkIdType> known; // of all blocks
  for (std::size_t i = 0; i < meshes.size(); ++i)
  {
    const RankPart part =
      partOf(meshes[i], 0, [&](Index cell) { return owns(static_cast<int>(i), cell) ? 0 : 1; });
    for (Index p = 0; p < meshes[i].numberOfPoints(); ++p)
    {
      known.emplace(meshes[i].point(p), static_cast<vtkIdType>(known.size()));
    }
    blocks->SetBlock(static_cast<unsigned int>(i), nullptr);
    if (part.cellOf.empty())
    {
      continue;
    }
    auto grid = toGrid(part.data);
    const auto numbers = filledArray<vtkIdTypeArray>(
      "numbers", part.pointOf, [&](const Index p) { return ids ? known[meshes[i].point(p)] : p; });
    if (ids)
    {
      grid->GetPointData()->SetGlobalIds(numbers);
    }
    blocks->SetBlock(static_cast<unsigned int>(i), grid);
  }
  return blocks;
}

/// The solution by block and place.
std::map<std::pair<int, Vec3>, double> solutionOf(vtkEllipticSolver* filter)
{
  std::map<std::pair<int, Vec3>, double> values;
  auto* output = outputOf<vtkMultiBlockDataSet>(filter);
  for (unsigned int i = 0; i < output->GetNumberOfBlocks(); ++i)
  {
    auto* block = vtkDataSet::SafeDownCast(output->GetBlock(i));
    for (vtkIdType p = 0; block && p < block->GetNumberOfPoints(); ++p)
    {
      Vec3 x;
      block->GetPoint(p, x.data());
      values[{ static_cast<int>(i), x }] = component(block->GetPointData(), "Solution", p);
    }
  }
  return values;
}

/// Blocks are solved as on one process, whichever rank has which cells of them.
void compareBlocks(const char* name, const std::vector<MeshData>& meshes, bool joined, bool merge,
  bool ids, vtkMultiProcessController* controller)
{
  const Context context(name);
  const int rank = controller->GetLocalProcessId(), ranks = controller->GetNumberOfProcesses();
  const auto update = [&](vtkEllipticSolver* filter, const BlockOwner& owns)
  {
    TAUTLINE_SET(filter, SetSourceType(vtkEllipticSolver::EXPRESSION),
      SetSourceExpression("x + y*z"), SetRelativeTolerance(1e-12), SetMergeCoincidentPoints(merge),
      SetInputDataObject(0, blocksOf(meshes, owns, ids)), Update());
  };
  vtkNew<vtkEllipticSolver> serial;
  vtkMultiProcessController::SetGlobalController(nullptr);
  update(serial, [](int, Index) { return true; });
  vtkMultiProcessController::SetGlobalController(controller);
  const auto expected = solutionOf(serial);
  const bool one = contains(serial->GetSummary(), wording("are-one-mesh"));
  TAUTLINE_CHECK_EQUAL(one, joined);
  double largest = 0;
  for (const auto& [place, value] : expected)
  {
    largest = std::max(largest, std::abs(value));
  }
  const BlockOwner whole = [&](int block, Index) { return block % ranks == rank; };
  const BlockOwner cut = [&](int block, Index cell)
  { return (7 * cell / 3 + block) % ranks == rank; };
  const BlockOwner first = [&](int, Index) { return rank == 0; };
  for (const BlockOwner& owns : { whole, cut, first })
  {
    for (const int how : { vtkEllipticSolver::NO_REDISTRIBUTION, vtkEllipticSolver::KD_TREE,
           vtkEllipticSolver::PT_SCOTCH })
    {
      const Context inner("divided " + std::to_string(how));
      vtkNew<vtkEllipticSolver> filter;
      Messages messages(filter);
      filter->SetRedistribute(how);
      update(filter, owns);
      TAUTLINE_CHECK(messages.empty());
      TAUTLINE_CHECK_EQUAL(filter->GetUnknowns(), serial->GetUnknowns());
      for (const auto& [place, value] : solutionOf(filter))
      {
        TAUTLINE_CHECK_NEAR(value, expected.at(place), 1e-8 * largest);
      }
      const std::string summary = filter->GetSummary();
      TAUTLINE_CHECK_EQUAL(contains(summary, wording("are-one-mesh")), joined);
    }
  }
}

void testSeams(vtkMultiProcessController* controller)
{
  constexpr Index n = 3;
  constexpr double side = n;
  const auto block = [](CellType type, const Vec3& shift)
  {
    MeshData data = blockMesh(type, n, n, topology(type).dimension == 2 ? 0 : n);
    data.transform([&](const Vec3& p) { return p + shift; });
    return data;
  };
  const auto reversed = [](MeshData data)
  {
    for (Index cell = 0; cell < data.numberOfCells(); ++cell)
    {
      reverseCell(cornerType(data.types[cell]), data.connectivity.data() + data.offsets[cell]);
    }
    return data;
  };
  for (const CellType type : { CellType::Hexahedron, CellType::Quadrilateral })
  {
    const Context context(topology(type).plural);
    const MeshData at = block(type, { 0, 0, 0 }), right = block(type, { side, 0, 0 });
    const MeshData corner = block(type, { side, side, 0 });
    const MeshData far = block(type, { 10 * side, 0, 0 });
    compareBlocks("seam", { at, right }, true, true, false, controller);
    compareBlocks("with ids", { at, right }, true, true, true, controller);
    compareBlocks("merging off", { at, right }, false, false, false, controller);
    compareBlocks("chain", { far, at, corner, right }, true, true, false, controller);
    compareBlocks("edge or corner", { at, corner }, false, true, false, controller);
    compareBlocks("reversed", { at, reversed(right) }, true, true, false, controller);
    compareBlocks("on top of each other", { at, at }, false, true, false, controller);
  }
  MeshData bent = block(CellType::Quadrilateral, { 0, 0, 0 });
  bent.transform(TAUTLINE_PLACE(side, p[1], p[0]));
  compareBlocks("surface", { block(CellType::Quadrilateral, { 0, 0, 0 }), bent }, true, true, false,
    controller);
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestBlockRanks)
{
  TAUTLINE_NEW(vtkMPIController, controller, Initialize(&argc, &argv));
  vtkMultiProcessController::SetGlobalController(controller);
  const int rank = controller->GetLocalProcessId(), ranks = controller->GetNumberOfProcesses();
  TAUTLINE_RUN(testQuality(rank, ranks));
  TAUTLINE_RUN(testWrongBlocks(rank, ranks));
  TAUTLINE_RUN(testSeams(controller));
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
}
