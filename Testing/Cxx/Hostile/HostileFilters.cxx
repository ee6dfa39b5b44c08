// SPDX-License-Identifier: BSD-3-Clause
#include "HostileFilters.h"
#include "Check.h"
#include "VtkMeshes.h"
#include "vtkConditionEstimator.h"
#include "vtkElementQuality.h"
#include "vtkEllipticSolver.h"
#include "vtkGmshWriter.h"
#include "vtkHorizonNeighbors.h"
#include "vtkInteractionLayer.h"
#include "vtkMeditWriter.h"
#include "vtkMeshComparison.h"
#include "vtkMeshImprover.h"
#include "vtkMeshOptimizer.h"
#include "vtkMeshPerturbation.h"
#include "vtkMeshUntangler.h"
#include "vtkMeshWarp.h"
#include "vtkMovingBoundary.h"
#include "vtkOffWriter.h"
#include "vtkPeridynamicStiffness.h"
#include "vtkShapeMatcher.h"
#include "vtkShapeRetrieval.h"
#include "vtkSilhouetteMesher.h"
#include "vtkSolverStudy.h"
#include "vtkTetGenWriter.h"

#ifdef TAUTLINE_MESHING
#include "vtkTetGenMesher.h"
#include "vtkTriangleMesher.h"
#endif

#include "vtkFloatArray.h"
#include "vtkTransform.h"

namespace tautline
{

namespace
{
constexpr double Seconds = 2.0; // the time limit of the filters that have one
using Data = vtkSmartPointer<vtkDataObject>;

/** Arrays of several types: V with three components, text, numbers of points and cells. */
void addArrays(vtkDataSet* mesh)
{
  TAUTLINE_NEW(vtkDoubleArray, scalars, SetName("T"));
  TAUTLINE_NEW(vtkFloatArray, vectors, SetName("V"), SetNumberOfComponents(3));
  vtkNew<vtkStringArray> texts, cellTexts;
  texts->SetName("Names");
  cellTexts->SetName("Names");
  for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
  {
    scalars->InsertNextValue(1.0 + 0.25 * static_cast<double>(i));
    vectors->InsertNextTuple3(0.005 * static_cast<double>(i), 0, 0);
    texts->InsertNextValue("p" + std::to_string(i));
  }
  TAUTLINE_NEW(vtkIntArray, material, SetName("Material"));
  for (vtkIdType i = 0; i < mesh->GetNumberOfCells(); ++i)
  {
    material->InsertNextValue(static_cast<int>(i % 3));
    cellTexts->InsertNextValue("c" + std::to_string(i));
  }
  TAUTLINE_SET(mesh, GetPointData()->AddArray(scalars), GetPointData()->AddArray(vectors),
    GetPointData()->AddArray(texts), GetCellData()->AddArray(material),
    GetCellData()->AddArray(cellTexts));
}

/** A planar mesh of triangles with its inner points moved. */
Data triangles()
{
  MeshData data = blockMesh(CellType::Triangle, 4, 4, 0);
  Random random(3);
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    Vec3 p = data.point(i);
    if (p[0] > 0 && p[0] < 4 && p[1] > 0 && p[1] < 4)
    {
      const Vec3 d = random.vector(-0.2, 0.2);
      data.setPoint(i, { p[0] + d[0], p[1] + d[1], 0 });
    }
  }
  const auto grid = toGrid(data);
  addArrays(grid);
  // An interaction layer of width 1, of the cells whose square is on the boundary.
  TAUTLINE_NEW(vtkIntArray, reference, SetName("Reference"));
  for (int cell = 0; cell < 32; ++cell)
  {
    const int x = cell / 2 % 4, y = cell / 8;
    reference->InsertNextValue(x == 0 || y == 0 || x == 3 || y == 3 ? 2 : 1);
  }
  grid->GetCellData()->AddArray(reference);
  return grid;
}

/** A solid of tetrahedra. */
Data tetrahedra()
{
  const auto grid = toGrid(blockMesh(CellType::Tetrahedron, 3, 3, 3));
  addArrays(grid);
  return grid;
}

#ifdef TAUTLINE_MESHING
/** The surface of a cube, of squares. */
Data closedSurface()
{
  MeshData cube = blockMesh(CellType::Hexahedron, 1, 1, 1);
  TAUTLINE_LET(MeshData, surface, points = cube.points);
  for (const std::vector<Index>& face : std::vector<std::vector<Index>>{ { 0, 2, 3, 1 },
         { 4, 5, 7, 6 }, { 0, 1, 5, 4 }, { 2, 6, 7, 3 }, { 0, 4, 6, 2 }, { 1, 3, 7, 5 } })
  {
    surface.addCell(CellType::Quadrilateral, face);
  }
  const auto poly = toPolyData(surface);
  addArrays(poly);
  return poly;
}

/** A square within a square, as lines. */
Data outlines()
{
  auto poly = vtkSmartPointer<vtkPolyData>::New();
  TAUTLINE_NEW(vtkPoints, points, SetDataType(VTK_DOUBLE));
  vtkNew<vtkCellArray> lines;
  for (const double half : { 2.0, 1.0 })
  {
    const vtkIdType first = points->InsertNextPoint(-half, -half, 0);
    TAUTLINE_SET(points, InsertNextPoint(half, -half, 0), InsertNextPoint(half, half, 0),
      InsertNextPoint(-half, half, 0));
    for (vtkIdType k = 0; k < 4; ++k)
    {
      const vtkIdType ids[] = { first + k, first + (k + 1) % 4 };
      lines->InsertNextCell(2, ids);
    }
  }
  TAUTLINE_SET(poly, SetPoints(points), SetLines(lines));
  addArrays(poly);
  return poly;
}
#endif

/** A black L on white. @param shift makes images that differ */
vtkSmartPointer<vtkImageData> silhouette(int shift = 0)
{
  constexpr int Size = 24;
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(Size, Size, 1);
  TAUTLINE_NEW(vtkUnsignedCharArray, grey, SetName("Grey"));
  for (int y = 0; y < Size; ++y)
  {
    for (int x = 0; x < Size; ++x)
    {
      const bool inside =
        x >= 4 && y >= 4 && x < 19 + shift && y < 19 && (x < 10 || y < 10 + shift);
      grey->InsertNextValue(inside ? 0 : 255);
    }
  }
  image->GetPointData()->SetScalars(grey);
  return image;
}

Data image()
{
  return silhouette();
}

Data images()
{
  auto blocks = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  for (unsigned int i = 0; i < 3; ++i)
  {
    blocks->SetBlock(i, silhouette(static_cast<int>(i)));
  }
  return blocks;
}

/** A triangulated polygon. */
Data polygon()
{
  TAUTLINE_NEW(
    vtkSilhouetteMesher, mesher, SetInputDataObject(silhouette()), SetSpacing(5), Update());
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->DeepCopy(mesher->GetOutput());
  addArrays(grid);
  return grid;
}

//------------------------------------------------------------------------------
template <class T>
vtkSmartPointer<T> made()
{
  return vtkSmartPointer<T>::New();
}

vtkSmartPointer<vtkAlgorithm> optimizer()
{
  auto filter = made<vtkMeshOptimizer>();
  filter->SetTimeLimit(Seconds);
  return filter;
}

/// Slides on the boundary, with all arrays and inputs of features.
vtkSmartPointer<vtkAlgorithm> slidingOptimizer()
{
  auto filter = made<vtkMeshOptimizer>();
  TAUTLINE_SET(
    filter, SetTimeLimit(Seconds), SetBoundary(vtkMeshOptimizer::ON_SURFACE), ShowFeaturesOn());
  return filter;
}

/// The input is the geometry that a tetrahedral mesh slides on.
vtkSmartPointer<vtkAlgorithm> geometryOptimizer()
{
  auto filter = slidingOptimizer();
  filter->SetInputDataObject(0, tetrahedra());
  return filter;
}

vtkSmartPointer<vtkMeshImprover> improver()
{
  auto filter = made<vtkMeshImprover>();
  filter->SetTimeLimit(Seconds);
  return filter;
}

vtkSmartPointer<vtkAlgorithm> untangler()
{
  auto filter = made<vtkMeshUntangler>();
  filter->SetTimeLimit(Seconds);
  return filter;
}

vtkSmartPointer<vtkMeshWarp> warp()
{
  auto filter = made<vtkMeshWarp>();
  filter->SetTimeLimit(Seconds);
  TAUTLINE_NEW(vtkTransform, transform, RotateZ(5));
  filter->SetTransform(transform);
  return filter;
}

template <class T>
vtkSmartPointer<T> elliptic()
{
  auto filter = made<T>();
  filter->SetTimeLimit(Seconds);
  return filter;
}

vtkSmartPointer<vtkPeridynamicStiffness> peridynamics()
{
  auto filter = made<vtkPeridynamicStiffness>();
  TAUTLINE_SET(filter, SetTimeLimit(Seconds), SetHorizon(1.0), SetConstrained(false));
  return filter;
}

template <class T>
vtkSmartPointer<T> shapes()
{
  auto filter = made<T>();
  TAUTLINE_SET(filter, SetTimeLimit(Seconds), SetSpacing(5), SetGridSize(8, 8));
  return filter;
}

void addFilters(std::vector<HostileFilter>& list)
{
  using Maker = std::function<vtkSmartPointer<vtkAlgorithm>()>;
  using Source = std::function<Data()>;
  const auto add = [&list](const char* module, const char* name, const char* variant,
                     const Maker& make, const Source& suitable, int port = 0, bool keeps = true,
                     int selectionPort = -1) {
    list.push_back({ module, name, variant, make, suitable, port, keeps, selectionPort });
  };
  add(
    "Quality", "vtkElementQuality", "", [] { return made<vtkElementQuality>(); }, triangles);
  add(
    "Quality", "vtkElementQuality", "solid", [] { return made<vtkElementQuality>(); }, tetrahedra);
  add(
    "Quality", "vtkElementQuality", "flip",
    []
    {
      auto filter = made<vtkElementQuality>();
      filter->SetReversedMesh(vtkElementQuality::FLIP_OUTPUT);
      return filter;
    },
    triangles);
  add(
    "Quality", "vtkElementQuality", "reference",
    []
    {
      auto filter = made<vtkElementQuality>();
      filter->SetTargetType(vtkElementQuality::REFERENCE);
      filter->SetInputDataObject(0, triangles());
      return filter;
    },
    triangles, 1, false);
  add(
    "Quality", "vtkElementQuality", "size",
    []
    {
      auto filter = made<vtkElementQuality>();
      filter->SetTargetType(vtkElementQuality::SIZE);
      filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "T");
      return filter;
    },
    triangles);
  add(
    "Quality", "vtkMeshComparison", "before",
    []
    {
      auto filter = made<vtkMeshComparison>();
      filter->SetInputDataObject(1, triangles());
      return filter;
    },
    triangles, 0, false);
  add(
    "Quality", "vtkMeshComparison", "after",
    []
    {
      auto filter = made<vtkMeshComparison>();
      filter->SetInputDataObject(0, triangles());
      return filter;
    },
    triangles, 1);
  add(
    "Perturbation", "vtkMeshPerturbation", "", [] { return made<vtkMeshPerturbation>(); },
    triangles);
  add(
    "Perturbation", "vtkMeshPerturbation", "solid", [] { return made<vtkMeshPerturbation>(); },
    tetrahedra);
  add("Optimization", "vtkMeshOptimizer", "", optimizer, triangles, 0, true, 2);
  add("Optimization", "vtkMeshOptimizer", "solid", optimizer, tetrahedra);
  add("Optimization", "vtkMeshOptimizer", "sliding", slidingOptimizer, tetrahedra);
  add("Optimization", "vtkMeshOptimizer", "geometry", geometryOptimizer, triangles, 3, false);
  add("Untangling", "vtkMeshUntangler", "", untangler, triangles, 0, true, 1);
  add("Untangling", "vtkMeshUntangler", "solid", untangler, tetrahedra);
  add("Reconnection", "vtkMeshImprover", "", improver, tetrahedra, 0, false, 1);
  add(
    "Reconnection", "vtkMeshImprover", "flat",
    []
    {
      auto filter = improver();
      filter->SetPreset(vtkMeshImprover::AGGRESSIVE);
      filter->SetBoundary(vtkMeshImprover::SLIDING);
      filter->SetInputArrayToProcess(1, 0, 0, vtkDataObject::FIELD_ASSOCIATION_CELLS, "Material");
      return filter;
    },
    tetrahedra, 0, false);
  add(
    "Deformation", "vtkMeshWarp", "", [] { return warp(); }, triangles, 0, true, 2);
  add(
    "Deformation", "vtkMeshWarp", "solid", [] { return warp(); }, tetrahedra);
  add(
    "Deformation", "vtkMeshWarp", "displacement",
    []
    {
      auto filter = warp();
      filter->SetMotion(vtkMeshWarp::DISPLACEMENT);
      filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "V");
      return filter;
    },
    triangles);
  add(
    "Deformation", "vtkMeshWarp", "target",
    []
    {
      auto filter = warp();
      TAUTLINE_SET(filter, SetMotion(vtkMeshWarp::TARGET), SetInputDataObject(0, triangles()));
      return filter;
    },
    triangles, 1, false);
  add(
    "Deformation", "vtkMovingBoundary", "", [] { return made<vtkMovingBoundary>(); }, triangles, 0,
    false);
  add(
    "Elliptic", "vtkEllipticSolver", "", [] { return elliptic<vtkEllipticSolver>(); }, triangles, 0,
    true, 1);
  add(
    "Elliptic", "vtkEllipticSolver", "elasticity",
    []
    {
      auto filter = elliptic<vtkEllipticSolver>();
      filter->SetEquation(vtkEllipticSolver::ELASTICITY);
      return filter;
    },
    tetrahedra);
  add(
    "Elliptic", "vtkConditionEstimator", "", [] { return elliptic<vtkConditionEstimator>(); },
    triangles);
  add(
    "Elliptic", "vtkSolverStudy", "", [] { return elliptic<vtkSolverStudy>(); }, triangles);
  add(
    "Peridynamics", "vtkPeridynamicStiffness", "", [] { return peridynamics(); }, triangles);
  add(
    "Peridynamics", "vtkPeridynamicStiffness", "solve",
    []
    {
      auto filter = peridynamics();
      TAUTLINE_SET(filter, SetConstrained(true), SetAllowThinLayer(true), SetSolve(true),
        SetBasis(vtkPeridynamicStiffness::PIECEWISE_LINEAR));
      return filter;
    },
    triangles);
  add(
    "Peridynamics", "vtkPeridynamicStiffness", "state-based",
    []
    {
      auto filter = peridynamics();
      TAUTLINE_SET(filter, SetConstrained(true), SetAllowThinLayer(true),
        SetDiscretization(vtkPeridynamicStiffness::EXACT), SetElastic(true), SetStateBased(true),
        SetSolve(true));
      return filter;
    },
    triangles);
  const auto preconditioned = [](int preconditioner)
  {
    auto filter = peridynamics();
    TAUTLINE_SET(filter, SetConstrained(true), SetAllowThinLayer(true), SetSolve(true),
      SetPreconditioner(preconditioner));
    return filter;
  };
  add(
    "Peridynamics", "vtkPeridynamicStiffness", "local AMG",
    [=] { return preconditioned(vtkPeridynamicStiffness::LOCAL_AMG); }, triangles);
  add(
    "Peridynamics", "vtkPeridynamicStiffness", "two-level",
    [=] { return preconditioned(vtkPeridynamicStiffness::TWO_LEVEL); }, triangles);
  add(
    "Peridynamics", "vtkInteractionLayer", "",
    []
    {
      auto filter = made<vtkInteractionLayer>();
      TAUTLINE_SET(filter, SetWidth(1.0), SetElementSize(1.0));
      return filter;
    },
    triangles, 0, false);
  add(
    "Peridynamics", "vtkHorizonNeighbors", "",
    []
    {
      auto filter = made<vtkHorizonNeighbors>();
      TAUTLINE_SET(filter, SetCenter(2, 2, 0), SetHorizon(1.0));
      return filter;
    },
    triangles, 0, false);
  add(
    "Shapes", "vtkSilhouetteMesher", "",
    []
    {
      auto filter = made<vtkSilhouetteMesher>();
      filter->SetSpacing(5);
      return filter;
    },
    image, 0, false);
  add(
    "Shapes", "vtkShapeMatcher", "source",
    []
    {
      auto filter = shapes<vtkShapeMatcher>();
      filter->SetInputDataObject(1, silhouette());
      return filter;
    },
    polygon, 0, false);
  add(
    "Shapes", "vtkShapeMatcher", "target",
    []
    {
      auto filter = shapes<vtkShapeMatcher>();
      filter->SetInputDataObject(0, polygon());
      return filter;
    },
    image, 1, false);
  add(
    "Shapes", "vtkShapeRetrieval", "", [] { return shapes<vtkShapeRetrieval>(); }, images, 0,
    false);
#ifdef TAUTLINE_MESHING
  add(
    "Meshing", "vtkTetGenMesher", "",
    []
    {
      auto filter = made<vtkTetGenMesher>();
      filter->SetTimeLimit(Seconds);
      return filter;
    },
    closedSurface, 0, false);
  add(
    "Meshing", "vtkTriangleMesher", "", [] { return made<vtkTriangleMesher>(); }, outlines, 0,
    false);
  add(
    "Meshing", "vtkTriangleMesher", "sizes",
    []
    {
      auto filter = made<vtkTriangleMesher>();
      filter->SetUseSizeArray(true);
      filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "T");
      return filter;
    },
    outlines, 0, false);
#endif
}

template <class Writer>
void addWriter(std::vector<HostileFilter>& list, const char* name, const std::string& file,
  const std::function<Data()>& suitable)
{
  TAUTLINE_LET(HostileFilter, entry, module = "Readers", name = name);
  entry.make = [file]
  {
    auto writer = made<Writer>();
    writer->SetFileName(file.c_str());
    return writer;
  };
  TAUTLINE_SET(entry, suitable = suitable, keepsMesh = false, fileName = file);
  list.push_back(entry);
}
}

//------------------------------------------------------------------------------
std::vector<HostileFilter> hostileFilters(const std::string& directory)
{
  std::vector<HostileFilter> list;
  addFilters(list);
  const std::string name = directory + "/hostile";
  addWriter<vtkGmshWriter>(list, "vtkGmshWriter", name + ".msh", triangles);
  addWriter<vtkMeditWriter>(list, "vtkMeditWriter", name + ".mesh", triangles);
  addWriter<vtkOffWriter>(list, "vtkOffWriter", name + ".off", triangles);
  addWriter<vtkTetGenWriter>(list, "vtkTetGenWriter", name + ".node", tetrahedra);
  return list;
}

//------------------------------------------------------------------------------
const std::vector<std::string>& classesWithoutInput()
{
  static const std::vector<std::string> names = { "vtkTautlineAlgorithm",
    "vtkTautlineTimedAlgorithm", "vtkMeshMotionAlgorithm", "vtkMetricAlgorithm",
    "vtkEllipticAlgorithm", "vtkKrylovAlgorithm", "vtkShapeAlgorithm", "vtkBoundaryMesher",
    "vtkMeshFileReader", "vtkMeshFileWriter", "vtkMetricField", "vtkDomainSource", "vtkGmshReader",
    "vtkMeditReader", "vtkOffReader", "vtkTetGenReader", "vtkSilhouetteSetReader", "vtkHtmlReport",
    "vtkImageFileReader", "vtkInterruption", "vtkMeshDecomposition", "vtkTautlineSetRange",
    "vtkUpdateGuard", "vtkUserMetric" };
  return names;
}

} // namespace tautline
