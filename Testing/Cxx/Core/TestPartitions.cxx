// SPDX-License-Identifier: BSD-3-Clause
// On one process the partitions of a partitioned or multipiece data set are one mesh: filters find
// what they find in it as one data set, and the results go back to the partitions. The names of
// blocks and partitions in messages. Python-partitions-on-ranks has several processes.
#include "Registry.h"
#include "Seams.h"
#include "vtkCompositeDataIterator.h"
#include "vtkElementQuality.h"
#include "vtkMeshComparison.h"
#include "vtkMeshImprover.h"
#include "vtkMeshOptimizer.h"
#include "vtkMeshPerturbation.h"
#include "vtkMeshUntangler.h"
#include "vtkMeshWarp.h"
#include "vtkMultiPieceDataSet.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"

using namespace tautline;

namespace
{
constexpr Index Parts = 3;

void addIds(vtkDataSetAttributes* data, const std::vector<Index>& values)
{
  const auto ids =
    filledArray<vtkIdTypeArray>("ids", values, [&](const Index value) { return value; });
  data->SetGlobalIds(ids);
}

/// A mesh whose points and cells have their numbers as global ids.
vtkSmartPointer<vtkUnstructuredGrid> numbered(const MeshData& mesh)
{
  auto grid = toGrid(mesh);
  std::vector<Index> points(mesh.numberOfPoints()), cells(mesh.numberOfCells());
  std::iota(points.begin(), points.end(), 0);
  std::iota(cells.begin(), cells.end(), 0);
  addIds(grid->GetPointData(), points);
  addIds(grid->GetCellData(), cells);
  return grid;
}

/// Every third cell, with points of its own.
vtkSmartPointer<vtkUnstructuredGrid> part(const MeshData& whole, Index number, bool ids = true)
{
  MeshData data;
  std::vector<Index> numbers(whole.numberOfPoints(), -1), points, cells;
  for (Index cell = number; cell < whole.numberOfCells(); cell += Parts)
  {
    std::vector<Index> nodes;
    for (Index k = whole.offsets[cell]; k < whole.offsets[cell + 1]; ++k)
    {
      const Index from = whole.connectivity[k];
      if (numbers[from] < 0)
      {
        numbers[from] = data.addPoint(whole.point(from));
        points.push_back(from);
      }
      nodes.push_back(numbers[from]);
    }
    data.addCell(static_cast<int>(whole.types[cell]), nodes);
    cells.push_back(cell);
  }
  auto grid = toGrid(data);
  if (ids)
  {
    addIds(grid->GetPointData(), points);
    addIds(grid->GetCellData(), cells);
  }
  return grid;
}

template <class Set>
vtkSmartPointer<Set> partitioned(const MeshData& whole, bool ids = true)
{
  auto set = vtkSmartPointer<Set>::New();
  for (Index i = 0; i < Parts; ++i)
  {
    set->SetPartition(static_cast<unsigned int>(i), part(whole, i, ids));
  }
  return set;
}

/// The largest distance of a point of a partition from that with its id in the whole.
double farthestOf(vtkDataObject* parts, vtkPointSet* whole)
{
  double distance = 0;
  Index points = 0;
  auto* set = vtkCompositeDataSet::SafeDownCast(parts);
  auto walk = vtkSmartPointer<vtkCompositeDataIterator>::Take(set->NewIterator());
  for (walk->InitTraversal(); !walk->IsDoneWithTraversal(); walk->GoToNextItem())
  {
    auto* leaf = vtkDataSet::SafeDownCast(walk->GetCurrentDataObject());
    vtkDataArray* ids = leaf->GetPointData()->GetGlobalIds();
    for (vtkIdType p = 0; ids && p < leaf->GetNumberOfPoints(); ++p)
    {
      double a[3], b[3];
      leaf->GetPoint(p, a);
      whole->GetPoint(static_cast<vtkIdType>(ids->GetTuple1(p)), b);
      for (int c = 0; c < 3; ++c)
      {
        distance = std::max(distance, std::abs(a[c] - b[c]));
      }
    }
    points += leaf->GetNumberOfPoints();
  }
  TAUTLINE_CHECK(points > whole->GetNumberOfPoints());
  return distance;
}

/// A filter finds in partitions what it finds in the whole mesh, and warns of nothing.
template <class Filter>
void testFilter(const char* name, const MeshData& mesh, const std::function<void(Filter*)>& choose)
{
  const Context context(name);
  vtkNew<Filter> whole, parts, pieces;
  for (Filter* filter : { whole.Get(), parts.Get(), pieces.Get() })
  {
    choose(filter);
  }
  Messages messages(parts);
  TAUTLINE_SET(whole, SetInputDataObject(0, numbered(mesh)), Update());
  TAUTLINE_SET(parts, SetInputDataObject(0, partitioned<vtkPartitionedDataSet>(mesh)), Update());
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK_EQUAL(farthestOf(parts->GetOutputDataObject(0), pointsOf(whole)), 0.0);
  TAUTLINE_CHECK(!contains(parts->GetSummary(), "block"));
  auto* output = outputOf<vtkPartitionedDataSet>(parts);
  TAUTLINE_CHECK(output && output->GetNumberOfPartitions() == Parts);
  // As a block among others, in pieces.
  vtkNew<vtkMultiBlockDataSet> blocks;
  MeshData far = mesh;
  far.transform([](Vec3 p) { return p + Vec3{ 100, 0, 0 }; });
  blocks->SetBlock(0, toGrid(far));
  blocks->SetBlock(1, partitioned<vtkMultiPieceDataSet>(mesh));
  TAUTLINE_SET(pieces, SetInputDataObject(0, blocks), Update());
  auto* two = outputOf<vtkMultiBlockDataSet>(pieces);
  if (TAUTLINE_CHECK(two && two->GetNumberOfBlocks() == 2))
  {
    TAUTLINE_CHECK_EQUAL(farthestOf(two->GetBlock(1), pointsOf(whole)), 0.0);
  }
}

TAUTLINE_PART(testMotions)
{
  const MeshData moved = rough(CellType::Tetrahedron, 4);
  for (const int boundary : { vtkMeshOptimizer::FIXED, vtkMeshOptimizer::SLIDING })
  {
    testFilter<vtkMeshOptimizer>(
      "optimize", moved, [boundary](vtkMeshOptimizer* filter) { filter->SetBoundary(boundary); });
  }
  testFilter<vtkMeshPerturbation>("perturb", moved, [](vtkMeshPerturbation*) {});
  testFilter<vtkMeshUntangler>(
    "untangle", rough(CellType::Tetrahedron, 4, 0.9), [](vtkMeshUntangler*) {});
  testFilter<vtkMeshWarp>("warp", moved,
    [](vtkMeshWarp* filter)
    { TAUTLINE_SET(filter, SetTransformKind(vtkMeshWarp::ROTATION), SetAngle(10)); });
}

/// Without ids by coordinates; kept apart where the user wants it.
TAUTLINE_PART(testSeams)
{
  const MeshData moved = rough(CellType::Tetrahedron, 4);
  vtkNew<vtkMeshOptimizer> whole, joined, apart;
  whole->SetInputDataObject(0, toGrid(moved));
  joined->SetInputDataObject(0, partitioned<vtkPartitionedDataSet>(moved, false));
  apart->SetInputDataObject(0, partitioned<vtkPartitionedDataSet>(moved, false));
  apart->MergeCoincidentPointsOff();
  whole->Update();
  joined->Update();
  apart->Update();
  TAUTLINE_CHECK(whole->GetFreePoints() > 0);
  TAUTLINE_CHECK_EQUAL(joined->GetFreePoints(), whole->GetFreePoints());
  TAUTLINE_CHECK(apart->GetFreePoints() < whole->GetFreePoints());
  TAUTLINE_CHECK(contains(apart->GetSummary(), wording("in-partition-2")));
  // Two of the partitions have no array of fixed points.
  vtkNew<vtkMeshOptimizer> lacking;
  Messages messages(lacking);
  const auto set = partitioned<vtkPartitionedDataSet>(moved, false);
  auto* first = set->GetPartition(0);
  TAUTLINE_NEW(vtkIdTypeArray, marks, SetName("marks"),
    SetNumberOfValues(first->GetNumberOfPoints()), Fill(0));
  first->GetPointData()->AddArray(marks);
  TAUTLINE_SET(lacking, SetInputDataObject(0, set),
    SetInputArrayToProcess(2, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "marks"), Update());
  TAUTLINE_CHECK(messages.has(wording("marks-of-fixed-points-in-partition-2")));
}

TAUTLINE_PART(testOthers)
{
  const MeshData moved = rough(CellType::Tetrahedron, 4);
  vtkNew<vtkMeshComparison> compared;
  Messages messages(compared);
  compared->SetInputDataObject(0, partitioned<vtkPartitionedDataSet>(moved));
  TAUTLINE_NEW(vtkPartitionedDataSet, other, SetPartition(0, numbered(moved)));
  TAUTLINE_SET(compared, SetInputDataObject(1, other), Update());
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK(
    contains(compared->GetSummary(), std::to_string(moved.numberOfCells()) + " equal"));
  vtkNew<vtkMeshImprover> whole, parts;
  whole->SetInputDataObject(0, numbered(moved));
  parts->SetInputDataObject(0, partitioned<vtkPartitionedDataSet>(moved));
  whole->Update();
  parts->Update();
  TAUTLINE_CHECK(whole->GetElementsAfter() > 0);
  TAUTLINE_CHECK_EQUAL(parts->GetElementsAfter(), whole->GetElementsAfter());
  TAUTLINE_CHECK_EQUAL(parts->GetSmallestAngleAfter(), whole->GetSmallestAngleAfter());
}

/// A part of a mesh whose cells list their points in the other order, as its neighbors have not.
TAUTLINE_PART(testQuality)
{
  MeshData mesh = TAUTLINE_CHANGED(rough(CellType::Tetrahedron, 4), swapNodes(0, 1, 0, Parts));
  vtkNew<vtkElementQuality> whole, parts;
  whole->AddMetricByName("imr");
  parts->AddMetricByName("imr");
  whole->SetInputDataObject(0, toGrid(mesh));
  parts->SetInputDataObject(0, partitioned<vtkPartitionedDataSet>(mesh, false));
  whole->Update();
  parts->Update();
  TAUTLINE_CHECK(contains(whole->GetNotice(), wording("cells-are-treated-as-if-listed")));
  TAUTLINE_CHECK_EQUAL(std::string(parts->GetNotice()), std::string(whole->GetNotice()));
  const auto worst = [](vtkElementQuality* filter)
  { return filter->GetStatistics()->GetValueByName(0, "Worst").ToDouble(); };
  TAUTLINE_CHECK_EQUAL(worst(parts), worst(whole));
  TAUTLINE_CHECK(contains(parts->GetSummary(), wording("of-partition")));
  vtkPointData* points = parts->GetWorst()->GetPointData();
  for (vtkIdType i = 0; i < parts->GetWorst()->GetNumberOfPoints(); ++i)
  {
    const auto of = [points, i](const char* name)
    { return static_cast<Index>(points->GetArray(name)->GetTuple1(i)); };
    // The cell is found by its numbers.
    const Index cell = Parts * of("Cell") + of("Partition") - 1;
    const Mesh view(mesh.view());
    const Vec3 center = view.center(cell, CellType::Tetrahedron);
    double p[3];
    parts->GetWorst()->GetPoint(i, p);
    TAUTLINE_CHECK_NEAR(center[0], p[0], 1e-12);
    TAUTLINE_CHECK_NEAR(center[1], p[1], 1e-12);
    TAUTLINE_CHECK_EQUAL(of("Process"), 0);
    TAUTLINE_CHECK_EQUAL(of("Block"), 0);
  }
  TAUTLINE_NEW(vtkElementQuality, global, AddMetricByName("imr"),
    SetInputDataObject(0, numbered(mesh)), Update());
  TAUTLINE_CHECK(contains(global->GetSummary(), wording("worst-element-with-global-id")));
}

/// The place that is named for a data set with a wrong cell.
void expectName(vtkDataObject* data, vtkUnstructuredGrid* wrong, const std::string& name)
{
  const Context context(name.c_str());
  vtkDataArray* nodes = wrong->GetCells()->GetConnectivityArray();
  const double right = nodes->GetComponent(0, 0);
  nodes->SetComponent(0, 0, 1e6);
  vtkNew<vtkMeshOptimizer> filter;
  Messages messages(filter);
  TAUTLINE_SET(filter, SetInputDataObject(0, data), Update());
  TAUTLINE_CHECK(messages.has("In " + name + ": "));
  nodes->SetComponent(0, 0, right);
}

/// Numbers of blocks do not depend on how many partitions there are.
TAUTLINE_PART(testNames)
{
  const auto make = [] { return toGrid(rough(CellType::Tetrahedron, 2)); };
  const auto grid = make();
  for (const unsigned int partitions : { 1U, 3U })
  {
    vtkNew<vtkPartitionedDataSetCollection> collection;
    const auto first = make();
    for (unsigned int i = 0; i < partitions; ++i)
    {
      collection->SetPartition(0, i, i == 0 ? first : make());
    }
    collection->SetPartition(1, 0, grid);
    expectName(collection, grid, "block 2");
    expectName(collection, first, partitions > 1 ? "partition 1 of block 1" : "block 1");
    vtkNew<vtkMultiBlockDataSet> blocks, inner;
    vtkNew<vtkMultiPieceDataSet> pieces;
    for (unsigned int i = 0; i < partitions; ++i)
    {
      pieces->SetPartition(i, make());
    }
    TAUTLINE_SET(inner, SetBlock(0, pieces), SetBlock(1, grid));
    blocks->SetBlock(0, inner);
    expectName(blocks, grid, "block 3");
  }
}
}
