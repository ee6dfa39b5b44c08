// SPDX-License-Identifier: BSD-3-Clause
// Filters that gather their mesh on the first process: pieces of it on several processes, blocks,
// in partitions, on another process than the first; what is selected of them; results, summary and
// numbers on all processes; errors on all. Python-parallel-filters compares values.
#include "Registry.h"
#include "VtkMeshes.h"
#include "tautline/Shapes/ShapeRetrieval.h"
#include "vtkFieldTransfer.h"
#include "vtkHorizonNeighbors.h"
#include "vtkInteractionLayer.h"
#include "vtkMeshComparison.h"
#include "vtkMeshImprover.h"
#include "vtkMeshMetric.h"
#include "vtkMeshPerturbation.h"
#include "vtkMeshWarp.h"
#include "vtkMovingBoundary.h"
#include "vtkPeridynamicStiffness.h"
#include "vtkShapeMatcher.h"
#include "vtkShapeRetrieval.h"
#include "vtkSilhouetteMesher.h"

#ifdef TAUTLINE_MESHING
#include "vtkTetGenMesher.h"
#include "vtkTriangleMesher.h"
#endif

#include "vtkCleanPolyData.h"
#include "vtkCubeSource.h"
#include "vtkDataSet.h"
#include "vtkMPIController.h"
#include "vtkObjectFactory.h"
#include "vtkPartitionedDataSet.h"
#include "vtkRegularPolygonSource.h"
#include "vtkUnstructuredGridAlgorithm.h"

using namespace tautline;

namespace
{
vtkMultiProcessController* controller()
{
  return vtkMultiProcessController::GetGlobalController();
}
int rank()
{
  return controller()->GetLocalProcessId();
}
int ranks()
{
  return controller()->GetNumberOfProcesses();
}

vtkIdType sum(vtkIdType own)
{
  vtkIdType all = 0;
  controller()->AllReduce(&own, &all, 1, vtkCommunicator::SUM_OP);
  return all;
}

MeshData square()
{
  MeshData data = blockMesh(CellType::Triangle, 6, 6, 0);
  data.transform([](Vec3 p) { return (1.0 / 6) * p; });
  return data;
}

MeshData cube()
{
  return blockMesh(CellType::Tetrahedron, 2, 2, 2);
}

/// Every so-many-th cell, with the points of these.
vtkSmartPointer<vtkUnstructuredGrid> part(const MeshData& whole, Index number, Index count)
{
  MeshData data;
  std::vector<Index> numbers(whole.points.size() / 3, -1);
  for (Index cell = number; cell < whole.numberOfCells(); cell += count)
  {
    std::vector<Index> nodes;
    for (Index k = whole.offsets[cell]; k < whole.offsets[cell + 1]; ++k)
    {
      Index& id = numbers[whole.connectivity[k]];
      if (id < 0)
      {
        id = static_cast<Index>(data.points.size() / 3);
        const auto from = whole.points.begin() + 3 * whole.connectivity[k];
        data.points.insert(data.points.end(), from, from + 3);
      }
      nodes.push_back(id);
    }
    data.addCell(static_cast<int>(whole.types[cell]), nodes);
  }
  return toGrid(data);
}

vtkSmartPointer<vtkUnstructuredGrid> nothing()
{
  return vtkSmartPointer<vtkUnstructuredGrid>::New();
}

/// Over all processes.
vtkIdType cellsOf(vtkAlgorithm* filter)
{
  return sum(filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL));
}

/// The pieces of all processes make the same as the whole on the first or the second process.
/// @param stays whether the result stays on the first process
template <class Filter, class Input>
void testFilter(const char* name, const MeshData& whole, bool stays, const Input& input)
{
  const Context context(name);
  vtkNew<Filter> filter;
  Messages messages(filter);
  vtkIdType expected = 0;
  for (const int owner : { 0, 1 })
  {
    input(filter.Get(), rank() == owner ? part(whole, 0, 1) : nothing());
    filter->Update();
    TAUTLINE_CHECK(messages.empty());
    const vtkIdType cells = cellsOf(filter);
    expected = owner == 0 ? cells : expected;
    TAUTLINE_CHECK(cells > 0);
    TAUTLINE_CHECK_EQUAL(cells, expected);
    const vtkIdType own = filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::CELL);
    TAUTLINE_CHECK_EQUAL(own, rank() == (stays ? 0 : owner) ? cells : 0);
  }
  input(filter.Get(), part(whole, rank(), ranks()));
  filter->Update();
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK_EQUAL(cellsOf(filter), expected);
  // Several pieces on each process, some empty.
  vtkNew<vtkPartitionedDataSet> parts;
  for (int i = 0; i < 3; ++i)
  {
    parts->SetPartition(static_cast<unsigned int>(i),
      i == 1 ? nothing() : part(whole, 2 * rank() + i / 2, 2 * ranks()));
  }
  input(filter.Get(), parts.Get());
  filter->Update();
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK_EQUAL(cellsOf(filter), expected);
  // One piece is corrupt: all report it.
  auto wrong = part(whole, rank(), ranks());
  if (rank() == 1)
  {
    wrong->GetPoints()->SetPoint(0, NAN, 0, 0);
    vtkNew<vtkIdTypeArray> nodes;
    wrong->GetCells()->GetConnectivityArray()->SetComponent(0, 0, 1000);
  }
  input(filter.Get(), wrong.Get());
  filter->Update();
  TAUTLINE_CHECK(messages.has(wording("in-process-1")));
  TAUTLINE_CHECK_EQUAL(cellsOf(filter), 0);
  messages.clear();
  input(filter.Get(), part(whole, rank(), ranks()));
  filter->Update();
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK_EQUAL(cellsOf(filter), expected);
}

void testMeshes()
{
  const auto one = [](auto* filter, vtkDataObject* data) { filter->SetInputDataObject(0, data); };
  const auto warp = [](vtkMeshWarp* filter, vtkDataObject* data)
  {
    TAUTLINE_SET(filter, SetTransformKind(vtkMeshWarp::TRANSLATION),
      SetMovedPart(vtkMeshWarp::WHOLE_BOUNDARY), SetInputDataObject(0, data));
  };
  testFilter<vtkMeshWarp>("Warp Mesh", square(), false, warp);
  testFilter<vtkMeshPerturbation>("Perturb Mesh", square(), false, one);
  testFilter<vtkMeshImprover>("Improve Mesh", cube(), false, one);
  testFilter<vtkMeshMetric>("Metric Tensor", cube(), false, one);
  testFilter<vtkFieldTransfer>("Transfer", cube(), false,
    [](vtkFieldTransfer* filter, vtkDataObject* data)
    {
      const auto source = part(cube(), rank(), ranks());
      source->GetPointData()->AddArray(filledArray<vtkDoubleArray>(
        "x", source->GetNumberOfPoints(), [&](vtkIdType i) { return source->GetPoint(i)[0]; }));
      TAUTLINE_SET(filter, SetInputDataObject(0, data), SetInputDataObject(1, source));
    });
  testFilter<vtkInteractionLayer>("Interaction Layer", square(), false, one);
  testFilter<vtkHorizonNeighbors>("Horizon Neighbors", square(), true,
    [](vtkHorizonNeighbors* filter, vtkDataObject* data)
    { TAUTLINE_SET(filter, SetCenter(0.5, 0.5, 0), SetInputDataObject(0, data)); });
  testFilter<vtkPeridynamicStiffness>("Peridynamic Condition", square(), false,
    [](vtkPeridynamicStiffness* filter, vtkDataObject* data)
    { TAUTLINE_SET(filter, SetConstrained(false), SetInputDataObject(0, data)); });
  testFilter<vtkMeshComparison>("Compare Meshes", square(), false,
    [](vtkMeshComparison* filter, vtkDataObject* data)
    { TAUTLINE_SET(filter, SetInputDataObject(0, data), SetInputDataObject(1, data)); });
}

/// Summary and numbers are the same on all processes, the table is on the first one.
void testNumbers()
{
  const Context context("numbers");
  TAUTLINE_NEW(
    vtkMeshPerturbation, filter, SetInputData(part(square(), rank(), ranks())), Update());
  TAUTLINE_CHECK_EQUAL(filter->GetNumberOfMovablePoints(), 25);
  TAUTLINE_CHECK(contains(filter->GetSummary(), wording("of-25-movable")));
  TAUTLINE_NEW(vtkMeshImprover, improver, SetInputData(part(cube(), rank(), ranks())), Update());
  TAUTLINE_CHECK(improver->GetWorstBefore() > 1);
  TAUTLINE_CHECK_EQUAL(improver->GetHistory()->GetNumberOfRows() > 0, rank() == 0);
  // An error of the whole mesh is one on all processes.
  vtkNew<vtkMeshImprover> rejected;
  Messages messages(rejected);
  rejected->SetInputData(part(blockMesh(CellType::Hexahedron, 2, 2, 2), rank(), ranks()));
  rejected->Update();
  TAUTLINE_CHECK(!messages.empty() && std::string(rejected->GetSummary()).empty());
  TAUTLINE_CHECK_EQUAL(cellsOf(rejected), 0);
}

/// Blocks: how many a process has differs.
void testBlocks()
{
  const Context context("blocks");
  vtkNew<vtkMeshPerturbation> filter;
  Messages messages(filter);
  vtkNew<vtkMultiBlockDataSet> blocks;
  MeshData far = square();
  far.transform([](Vec3 p) { return p + Vec3{ 3, 0, 0 }; });
  blocks->SetBlock(0, part(square(), rank(), ranks()));
  if (rank() == 1)
  {
    blocks->SetBlock(2, part(far, 0, 1));
  }
  TAUTLINE_SET(filter, SetInputData(blocks), Update());
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK_EQUAL(filter->GetNumberOfMovablePoints(), 50);
  auto* output = outputOf<vtkMultiBlockDataSet>(filter);
  TAUTLINE_CHECK_EQUAL(sum(output->GetBlock(0)->GetNumberOfElements(vtkDataObject::CELL)), 72);
  TAUTLINE_CHECK_EQUAL(output->GetNumberOfBlocks(), rank() == 1 ? 3U : 1U);
  TAUTLINE_CHECK(rank() != 1 ||
    vtkDataSet::SafeDownCast(output->GetBlock(2))->GetPointData()->GetArray("Displacement"));
}

/// A selection of a process in its piece is a selection in the mesh.
void testSelection()
{
  const Context context("selection");
  vtkNew<vtkMeshWarp> filter;
  Messages messages(filter);
  auto mesh = part(square(), rank(), ranks());
  vtkNew<vtkIdTypeArray> ids;
  vtkIdType chosen = 0;
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    if (mesh->GetPoint(i)[0] == 0 && rank() == 1)
    {
      ids->InsertNextValue(i);
      ++chosen;
    }
  }
  const auto selection = pointSelection(ids);
  TAUTLINE_SET(filter, SetInputData(mesh), SetInputDataObject(2, selection),
    SetMovedPart(vtkMeshWarp::SELECTION), SetTransformKind(vtkMeshWarp::TRANSLATION),
    SetTranslation(-0.1, 0, 0), Update());
  TAUTLINE_CHECK(messages.empty());
  // Exactly the points chosen on process 1 are moved as far, wherever they are.
  auto* result = outputOf<vtkUnstructuredGrid>(filter);
  TAUTLINE_CHECK_EQUAL(result->GetNumberOfPoints(), mesh->GetNumberOfPoints());
  TAUTLINE_CHECK(!result->GetPointData()->GetArray("Tautline selected by input 2"));
  vtkIdType moved = sumOf<vtkIdType>(0, mesh->GetNumberOfPoints(),
    [&](vtkIdType i)
    { return mesh->GetPoint(i)[0] == 0 && std::abs(result->GetPoint(i)[0] + 0.1) < 1e-12; });
  TAUTLINE_CHECK(rank() != 1 || (chosen > 0 && moved == chosen));

  // The preview of what moves is on the first process.
  vtkNew<vtkMovingBoundary> preview;
  Messages said(preview);
  TAUTLINE_SET(preview, SetInputData(mesh), SetInputDataObject(2, selection),
    SetMovedPart(vtkMeshWarp::SELECTION), Update());
  TAUTLINE_CHECK(said.empty());
  auto* seen = outputOf<vtkPolyData>(preview);
  const auto all = sum(chosen);
  TAUTLINE_CHECK_EQUAL(seen->GetNumberOfPoints(), rank() == 0 ? all : 0);

  // A new mesh has nothing of what the selection was gathered by.
  TAUTLINE_NEW(
    vtkMeshImprover, improver, SetInputData(mesh), SetInputDataObject(1, selection), Update());
  auto* improved = outputOf(improver);
  TAUTLINE_CHECK(improved->GetNumberOfCells() > 0);
  TAUTLINE_CHECK(!improved->GetPointData()->GetArray("Tautline selected by input 1"));
  TAUTLINE_CHECK(!improved->GetCellData()->GetArray("Tautline selected by input 1"));
}

/// Makes a piece, but cannot on process 1.
class FailingSource : public vtkUnstructuredGridAlgorithm
{
public:
  static FailingSource* New();
  vtkTypeMacro(FailingSource, vtkUnstructuredGridAlgorithm);
  bool Fails = true;

protected:
  FailingSource() { this->SetNumberOfInputPorts(0); }
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override
  {
    vtkUnstructuredGrid::GetData(outputs)->ShallowCopy(part(square(), rank(), ranks()));
    return this->Fails && rank() == 1 ? 0 : 1;
  }
};
vtkStandardNewMacro(FailingSource);

/// If the filter before fails on one process, none computes with what the others have, also not the
/// second time, and none waits; until it works.
void testUpstream()
{
  const Context context("upstream");
  vtkNew<FailingSource> source;
  TAUTLINE_NEW(vtkMeshPerturbation, filter, SetInputConnection(source->GetOutputPort()));
  for (int time = 0; time < 2; ++time)
  {
    Messages messages(filter);
    filter->Update();
    TAUTLINE_CHECK(messages.has(wording("in-process-1-an-input-could-not")));
    TAUTLINE_CHECK_EQUAL(cellsOf(filter), 0);
  }
  source->Fails = false;
  source->Modified();
  filter->Update();
  TAUTLINE_CHECK_EQUAL(cellsOf(filter), 72);
}

/// A white ellipse on black, a disc by default.
vtkSmartPointer<vtkImageData> disc(double radius, double stretch = 1.0)
{
  constexpr int side = 24;
  TAUTLINE_NEW(
    vtkImageData, image, SetDimensions(side, side, 1), AllocateScalars(VTK_UNSIGNED_CHAR, 1));
  for (int y = 0; y < side; ++y)
  {
    for (int x = 0; x < side; ++x)
    {
      const double distance = std::hypot(x - 0.5 * side, stretch * (y - 0.4 * side));
      image->SetScalarComponentFromDouble(x, y, 0, 0, distance < radius ? 255 : 0);
    }
  }
  return image;
}

/// The upper or lower half of an image on two processes, the whole on others.
vtkSmartPointer<vtkImageData> half(vtkImageData* image)
{
  TAUTLINE_NEW(vtkImageData, copy, DeepCopy(image));
  int extent[6];
  image->GetExtent(extent);
  constexpr int middle = 11;
  extent[rank() == 0 ? 3 : 2] = rank() < 2 ? middle : extent[rank() == 0 ? 3 : 2];
  copy->Crop(extent);
  return copy;
}

template <class Filter, class Input>
void testOtherFilter(const char* name, const Input& input)
{
  const Context context(name);
  vtkIdType sizes[2] = { 0, 0 };
  for (const bool everywhere : { true, false })
  {
    vtkNew<Filter> filter;
    Messages messages(filter);
    input(filter.Get(), everywhere);
    filter->Update();
    TAUTLINE_CHECK(messages.empty());
    vtkDataObject* output = filter->GetOutputDataObject(0);
    const vtkIdType size = output->GetNumberOfElements(vtkDataObject::CELL) +
      output->GetNumberOfElements(vtkDataObject::ROW);
    TAUTLINE_CHECK_EQUAL(size > 0, rank() == 0);
    sizes[everywhere] = size;
  }
  TAUTLINE_CHECK_EQUAL(sizes[0], sizes[1]);
}

void testShapes()
{
  const auto image = [](bool everywhere, double radius)
  {
    return everywhere ? half(disc(radius))
      : rank() == 0   ? disc(radius)
                      : vtkSmartPointer<vtkImageData>::New();
  };
  testOtherFilter<vtkSilhouetteMesher>("Silhouette to Mesh",
    [&](vtkSilhouetteMesher* filter, bool everywhere)
    { filter->SetInputData(image(everywhere, 8)); });
  testOtherFilter<vtkShapeMatcher>("Match Shape",
    [&](vtkShapeMatcher* filter, bool everywhere)
    {
      filter->SetInputDataObject(0, image(everywhere, 8));
      filter->SetInputDataObject(1, image(everywhere, 9));
    });
  testOtherFilter<vtkShapeRetrieval>("Shape Retrieval",
    [&](vtkShapeRetrieval* filter, bool everywhere)
    {
      vtkNew<vtkMultiBlockDataSet> blocks;
      for (unsigned int i = 0; (everywhere || rank() == 0) && i < 3; ++i)
      {
        blocks->SetBlock(i, disc(7 + i));
      }
      filter->SetInputDataObject(0, blocks);
    });
}

/// Pieces that cannot be joined are an error on all, also where the others would assist.
void testNotJoined()
{
  const Context context("pieces that cannot be joined");
  MeshData data;
  const double x = rank(); // the ids are at two places
  data.points = { x, 0, 0, x + 1, 0, 0, x, 1, 0 };
  data.addCell(CellType::Triangle, { 0, 1, 2 });
  auto grid = toGrid(data);
  const auto ids = filledArray<vtkIdTypeArray>(
    "ids", std::vector<vtkIdType>{ 0, 1, 2 }, [&](vtkIdType id) { return id; });
  grid->GetPointData()->SetGlobalIds(ids);
  vtkNew<vtkPeridynamicStiffness> filter;
  Messages messages(filter);
  TAUTLINE_SET(filter, SetInputData(grid), Update());
  TAUTLINE_CHECK(messages.has("ERROR: "));
  TAUTLINE_CHECK(messages.has("global"));
}

/// Shape Retrieval divides the pairs among the processes: the distances equal the distances of one,
/// bitwise; an image without a shape is left out, with a warning where it is.
void testRetrieval()
{
  const Context context("pairs of Shape Retrieval");
  vtkNew<vtkMultiBlockDataSet> blocks;
  std::vector<Silhouette> shapes;
  constexpr unsigned int count = 5;
  for (unsigned int i = 0; i < count; ++i)
  {
    const auto image = disc(7, 1.0 + 0.4 * i);
    auto values = collect<float>(image->GetNumberOfPoints(),
      [&](vtkIdType p)
      { return static_cast<float>(image->GetPointData()->GetScalars()->GetComponent(p, 0)); });
    const int* size = image->GetDimensions();
    shapes.push_back(traceSilhouette({ values.data(), size[0], size[1] }));
    if (rank() == 0)
    {
      blocks->SetBlock(i, image);
    }
  }
  RetrievalOptions options = RetrievalOptions::highest();
  const Retrieval one = retrieveShapes(shapes, std::vector<Index>(count, 0), options);
  TAUTLINE_NEW(vtkShapeRetrieval, filter, SetInputDataObject(0, blocks));
  for (int run = 0; run < 2; ++run)
  {
    TAUTLINE_SET(filter, Modified(), Update());
    TAUTLINE_CHECK_EQUAL(filter->GetRecognitionRate(), 100.0); // all are of one class
    TAUTLINE_CHECK(std::string(filter->GetSummary()).find("5 shapes of 1 classes") == 0);
    auto* distances = outputOf<vtkTable>(filter);
    for (unsigned int s = 0; rank() == 0 && s < count; ++s)
    {
      for (unsigned int t = 0; t < count; ++t)
      {
        constexpr int first = 2; // after the name and the label
        TAUTLINE_CHECK_EQUAL(
          distances->GetValue(s, first + t).ToDouble(), one.distances[s * count + t]);
      }
    }
  }
  TAUTLINE_CHECK(one.distances[count - 1] > 0.0);

  Messages messages(filter);
  if (rank() == 0)
  {
    blocks->SetBlock(count, disc(0));
  }
  blocks->Modified();
  filter->Update();
  TAUTLINE_CHECK_EQUAL(messages.has("shape 5"), rank() == 0);
  TAUTLINE_CHECK(!messages.has("ERROR: "));
  TAUTLINE_CHECK_EQUAL(filter->GetOutputDataObject(0)->GetNumberOfElements(vtkDataObject::ROW),
    rank() == 0 ? static_cast<vtkIdType>(count) : 0);
}

#ifdef TAUTLINE_MESHING
void testMeshers()
{
  const auto sides = [](bool everywhere)
  {
    vtkNew<vtkCubeSource> source;
    TAUTLINE_NEW(vtkCleanPolyData, clean, SetInputConnection(source->GetOutputPort()), Update());
    vtkPolyData* cube = clean->GetOutput();
    TAUTLINE_NEW(vtkPolyData, own, SetPoints(cube->GetPoints()), Allocate(6));
    for (vtkIdType i = 0; i < 6; ++i)
    {
      if (everywhere ? i % ranks() == rank() : rank() == 0)
      {
        vtkNew<vtkIdList> nodes;
        cube->GetCellPoints(i, nodes);
        own->InsertNextCell(cube->GetCellType(i), nodes);
      }
    }
    return own->GetNumberOfCells() > 0 ? vtkSmartPointer<vtkPolyData>(own)
                                       : vtkSmartPointer<vtkPolyData>::New();
  };
  testOtherFilter<vtkTetGenMesher>("TetGen Mesher",
    [&](vtkTetGenMesher* filter, bool everywhere) { filter->SetInputData(sides(everywhere)); });
  const auto triangle = [](bool everywhere)
  {
    TAUTLINE_NEW(
      vtkRegularPolygonSource, source, SetNumberOfSides(3), GeneratePolygonOff(), Update());
    return rank() == (everywhere ? 1 : 0) ? vtkSmartPointer<vtkPolyData>(source->GetOutput())
                                          : vtkSmartPointer<vtkPolyData>::New();
  };
  testOtherFilter<vtkTriangleMesher>("Triangle Mesher",
    [&](vtkTriangleMesher* filter, bool everywhere)
    { filter->SetInputData(triangle(everywhere)); });
}
#endif
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestGatheredRanks)
{
  TAUTLINE_NEW(vtkMPIController, mpi, Initialize(&argc, &argv));
  vtkMultiProcessController::SetGlobalController(mpi);
  if (ranks() > 1)
  {
    TAUTLINE_RUN(testMeshes());
    TAUTLINE_RUN(testNumbers());
    TAUTLINE_RUN(testBlocks());
    TAUTLINE_RUN(testSelection());
    TAUTLINE_RUN(testUpstream());
    TAUTLINE_RUN(testShapes());
    TAUTLINE_RUN(testRetrieval());
    TAUTLINE_RUN(testNotJoined());
#ifdef TAUTLINE_MESHING
    TAUTLINE_RUN(testMeshers());
#endif
  }
  vtkMultiProcessController::SetGlobalController(nullptr);
  mpi->Finalize();
}
