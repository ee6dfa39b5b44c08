// Filters that do not support several processes reject a mesh that is not on the first one, on all
// processes and by name; a mesh on the first process alone is taken there.
#include "Check.h"
#include "VtkMeshes.h"

#include "vtkHorizonNeighbors.h"
#include "vtkInteractionLayer.h"
#include "vtkMeshComparison.h"
#include "vtkMeshImprover.h"
#include "vtkMeshPerturbation.h"
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
#include "vtkImageData.h"
#include "vtkMPIController.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPolyData.h"
#include "vtkRegularPolygonSource.h"

#include <cmath>

using namespace tautline;

namespace
{
vtkSmartPointer<vtkUnstructuredGrid> square()
{
  MeshData data = blockMesh(CellType::Triangle, 6, 6, 0);
  data.transform([](Vec3 p) { return (1.0 / 6) * p; });
  return toGrid(data);
}

vtkSmartPointer<vtkUnstructuredGrid> cube()
{
  return toGrid(blockMesh(CellType::Tetrahedron, 2, 2, 2));
}

vtkIdType cellsOf(vtkAlgorithm* filter)
{
  vtkDataObject* output = filter->GetOutputDataObject(0);
  return output->GetNumberOfElements(vtkDataObject::CELL);
}

/// @param input sets the input of the filter
/// @param mesh makes it
template <class Filter, class Input>
void testFilter(const char* name, int rank, const Input& input,
  vtkSmartPointer<vtkUnstructuredGrid> (*mesh)() = square)
{
  const Context context(name);
  vtkNew<Filter> filter;
  Messages messages(filter);
  const std::string refusal = std::string(name) + " does not support meshes on several processes";
  const auto run = [&](bool here)
  {
    messages.clear();
    // A new one each time, so that all processes execute.
    input(filter.Get(), here ? mesh() : vtkSmartPointer<vtkUnstructuredGrid>::New());
    filter->Update();
  };
  run(true); // a part on each
  TAUTLINE_CHECK(messages.has(refusal));
  TAUTLINE_CHECK(messages.has("Aggregate Dataset"));
  TAUTLINE_CHECK_EQUAL(cellsOf(filter), 0);
  run(rank == 1); // whole, but not where the tables and the summary are taken from
  TAUTLINE_CHECK(messages.has(refusal));
  TAUTLINE_CHECK_EQUAL(cellsOf(filter), 0);
  run(rank == 0);
  TAUTLINE_CHECK(messages.empty());
  TAUTLINE_CHECK_EQUAL(cellsOf(filter) > 0, rank == 0);
  // Blocks: how many a process has differs, and none waits for another.
  vtkNew<vtkMultiBlockDataSet> blocks;
  for (int i = 0; i <= rank; ++i)
  {
    blocks->SetBlock(static_cast<unsigned int>(i), mesh());
  }
  messages.clear();
  input(filter.Get(), blocks.Get());
  filter->Update();
  TAUTLINE_CHECK(messages.has(refusal));
}

/// The same for a filter with other inputs, which `input` makes, or empty ones.
template <class Filter, class Input>
void testOtherFilter(const char* name, int rank, const Input& input)
{
  const Context context(name);
  vtkNew<Filter> filter;
  Messages messages(filter);
  const std::string refusal = std::string(name) + " does not support meshes on several processes";
  for (const bool everywhere : { true, false })
  {
    messages.clear();
    input(filter.Get(), everywhere || rank == 0);
    filter->Update();
    TAUTLINE_CHECK_EQUAL(messages.has(refusal), everywhere);
    vtkDataObject* output = filter->GetOutputDataObject(0);
    const vtkIdType size = output->GetNumberOfElements(vtkDataObject::CELL) +
      output->GetNumberOfElements(vtkDataObject::ROW);
    TAUTLINE_CHECK_EQUAL(size > 0, !everywhere && rank == 0);
  }
}

/// A white disc on black.
vtkSmartPointer<vtkImageData> disc(double radius)
{
  constexpr int side = 24;
  vtkNew<vtkImageData> image;
  image->SetDimensions(side, side, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 1);
  for (int y = 0; y < side; ++y)
  {
    for (int x = 0; x < side; ++x)
    {
      const double distance = std::hypot(x - 0.5 * side, y - 0.4 * side);
      image->SetScalarComponentFromDouble(x, y, 0, 0, distance < radius ? 255 : 0);
    }
  }
  return image;
}

void testShapes(int rank)
{
  const auto image = [](bool here, double radius)
  { return here ? disc(radius) : vtkSmartPointer<vtkImageData>::New(); };
  testOtherFilter<vtkSilhouetteMesher>("Silhouette to Mesh", rank,
    [&](vtkSilhouetteMesher* filter, bool here) { filter->SetInputData(image(here, 8)); });
  testOtherFilter<vtkShapeMatcher>("Match Shape", rank,
    [&](vtkShapeMatcher* filter, bool here)
    {
      filter->SetInputDataObject(0, image(here, 8));
      filter->SetInputDataObject(1, image(here, 9));
    });
  testOtherFilter<vtkShapeRetrieval>("Shape Retrieval", rank,
    [&](vtkShapeRetrieval* filter, bool here)
    {
      vtkNew<vtkMultiBlockDataSet> blocks;
      for (unsigned int i = 0; here && i < 3; ++i)
      {
        blocks->SetBlock(i, disc(7 + i));
      }
      filter->SetInputDataObject(0, blocks);
    });
}

#ifdef TAUTLINE_MESHING
/// Each process with a part of the boundary would mesh that.
void testMeshers(int rank)
{
  const auto cube = [](bool here)
  {
    vtkNew<vtkCubeSource> source;
    vtkNew<vtkCleanPolyData> clean;
    clean->SetInputConnection(source->GetOutputPort());
    clean->Update();
    return here ? vtkSmartPointer<vtkPolyData>(clean->GetOutput())
                : vtkSmartPointer<vtkPolyData>::New();
  };
  testOtherFilter<vtkTetGenMesher>("TetGen Mesher", rank,
    [&](vtkTetGenMesher* filter, bool here) { filter->SetInputData(cube(here)); });
  const auto triangle = [](bool here)
  {
    vtkNew<vtkRegularPolygonSource> source;
    source->SetNumberOfSides(3);
    source->Update();
    return here ? vtkSmartPointer<vtkPolyData>(source->GetOutput())
                : vtkSmartPointer<vtkPolyData>::New();
  };
  testOtherFilter<vtkTriangleMesher>("Triangle Mesher", rank,
    [&](vtkTriangleMesher* filter, bool here) { filter->SetInputData(triangle(here)); });
}
#endif
}

//------------------------------------------------------------------------------
int TestFilterRanks(int argc, char* argv[])
{
  vtkNew<vtkMPIController> controller;
  controller->Initialize(&argc, &argv);
  vtkMultiProcessController::SetGlobalController(controller);
  const int rank = controller->GetLocalProcessId();
  const auto one = [](auto* filter, vtkDataObject* data) { filter->SetInputDataObject(0, data); };
  testFilter<vtkMeshImprover>("Improve Mesh", rank, one, cube);
  testFilter<vtkMeshPerturbation>("Perturb Mesh", rank, one);
  testFilter<vtkInteractionLayer>("Interaction Layer", rank, one);
  testFilter<vtkHorizonNeighbors>("Horizon Neighbors", rank, one);
  testFilter<vtkPeridynamicStiffness>("Peridynamic Condition", rank,
    [](vtkPeridynamicStiffness* filter, vtkDataObject* data)
    {
      filter->SetConstrained(false);
      filter->SetInputDataObject(0, data);
    });
  testFilter<vtkMeshComparison>("Compare Meshes", rank,
    [](vtkMeshComparison* filter, vtkDataObject* data)
    {
      filter->SetInputDataObject(0, data);
      filter->SetInputDataObject(1, data);
    });
  testShapes(rank);
#ifdef TAUTLINE_MESHING
  testMeshers(rank);
#endif
  vtkMultiProcessController::SetGlobalController(nullptr);
  controller->Finalize();
  return exitCode();
}
