// SPDX-License-Identifier: BSD-3-Clause
#include "HostileFilters.h"
#include "Readers/FoamSamples.h"
#include "VtkMeshes.h"
#include "vtkConditionEstimator.h"
#include "vtkElementQuality.h"
#include "vtkEllipticSolver.h"
#include "vtkFieldTransfer.h"
#include "vtkFoamMeshReader.h"
#include "vtkFoamPointsWriter.h"
#include "vtkGmshWriter.h"
#include "vtkHorizonNeighbors.h"
#include "vtkInteractionLayer.h"
#include "vtkMeditWriter.h"
#include "vtkMeshComparison.h"
#include "vtkMeshCurving.h"
#include "vtkMeshImprover.h"
#include "vtkMeshMetric.h"
#include "vtkMeshOptimizer.h"
#include "vtkMeshPerturbation.h"
#include "vtkMeshUntangler.h"
#include "vtkMeshWarp.h"
#include "vtkMfemWriter.h"
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

/** The same with other names of arrays. */
Data renamed(const Data& data)
{
  auto* mesh = vtkDataSet::SafeDownCast(data);
  for (vtkDataSetAttributes* arrays : { static_cast<vtkDataSetAttributes*>(mesh->GetPointData()),
         static_cast<vtkDataSetAttributes*>(mesh->GetCellData()) })
  {
    for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
    {
      vtkAbstractArray* array = arrays->GetAbstractArray(i);
      array->SetName((std::string("other ") + array->GetName()).c_str());
    }
  }
  return data;
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
  auto image = TAUTLINE_CHANGED(vtkSmartPointer<vtkImageData>::New(), SetDimensions(Size, Size, 1));
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
vtkSmartPointer<vtkTransform> turn()
{
  return TAUTLINE_CHANGED(vtkSmartPointer<vtkTransform>::New(), RotateZ(5));
}

/// The name of a class and a function that makes its object, for the list below.
#define MADE(type, ...) #type, TAUTLINE_MAKER(type, __VA_ARGS__)
#define TIMED(type, ...) MADE(type, SetTimeLimit(Seconds), __VA_ARGS__)
#define PLAIN(type) #type, [] { return vtkSmartPointer<type>::New(); }
#define WARP(...) TIMED(vtkMeshWarp, SetTransform(turn()), __VA_ARGS__)
#define SOLVED(...)                                                                              \
  TIMED(vtkPeridynamicStiffness, SetHorizon(1.0), SetConstrained(true), SetAllowThinLayer(true), \
    SetSolve(true), __VA_ARGS__)
#define SHAPES(type, ...) TIMED(type, SetSpacing(5), SetGridSize(8, 8), __VA_ARGS__)

void addFilters(std::vector<HostileFilter>& list)
{
  using Maker = std::function<vtkSmartPointer<vtkAlgorithm>()>;
  using Source = std::function<Data()>;
  constexpr int points = vtkDataObject::FIELD_ASSOCIATION_POINTS,
                cells = vtkDataObject::FIELD_ASSOCIATION_CELLS;
  const char* module = "Quality";
  const auto add = [&](const char* variant, const Source& suitable, const char* name,
                     const Maker& make, int port = 0, bool keeps = true, int selectionPort = -1) {
    list.push_back({ module, name, variant, make, suitable, port, keeps, selectionPort });
  };
  using Quality = vtkElementQuality;
  add("", triangles, PLAIN(vtkElementQuality));
  add("solid", tetrahedra, PLAIN(vtkElementQuality));
  add("flip", triangles, MADE(vtkElementQuality, SetReversedMesh(Quality::FLIP_OUTPUT)));
  add("reference", triangles,
    MADE(vtkElementQuality, SetTargetType(Quality::REFERENCE), SetInputDataObject(0, triangles())),
    1, false);
  add("size", triangles,
    MADE(vtkElementQuality, SetTargetType(Quality::SIZE),
      SetInputArrayToProcess(0, 0, 0, points, "T")));
  add("before", triangles, MADE(vtkMeshComparison, SetInputDataObject(1, triangles())), 0, false);
  add("after", triangles, MADE(vtkMeshComparison, SetInputDataObject(0, triangles())), 1);
  module = "Perturbation";
  add("", triangles, PLAIN(vtkMeshPerturbation));
  add("solid", tetrahedra, PLAIN(vtkMeshPerturbation));
  module = "Optimization";
  add("", triangles, MADE(vtkMeshOptimizer, SetTimeLimit(Seconds)), 0, true, 2);
  add("solid", tetrahedra, MADE(vtkMeshOptimizer, SetTimeLimit(Seconds)));
  // Slides on the boundary, with all arrays and inputs of features.
  add("sliding", tetrahedra,
    TIMED(vtkMeshOptimizer, SetBoundary(vtkMeshOptimizer::ON_SURFACE), ShowFeaturesOn()));
  // The input is the geometry that a tetrahedral mesh slides on.
  add("geometry", triangles,
    TIMED(vtkMeshOptimizer, SetBoundary(vtkMeshOptimizer::ON_SURFACE), ShowFeaturesOn(),
      SetInputDataObject(0, tetrahedra())),
    3, false);
  module = "Untangling";
  add("", triangles, MADE(vtkMeshUntangler, SetTimeLimit(Seconds)), 0, true, 1);
  add("solid", tetrahedra, MADE(vtkMeshUntangler, SetTimeLimit(Seconds)));
  module = "Curving";
  add("", triangles, PLAIN(vtkMeshCurving), 0, false);
  add("cubic", tetrahedra,
    MADE(vtkMeshCurving, SetOrder(3), SetInputArrayToProcess(0, 0, 0, cells, "Material")), 0,
    false);
  // The input is the geometry of a tetrahedral mesh.
  add("geometry", triangles, MADE(vtkMeshCurving, SetInputDataObject(0, tetrahedra())), 1, false);
  module = "Adaptation";
  using Tensors = vtkMeshMetric;
  add("", triangles, MADE(vtkMeshMetric, SetTimeLimit(Seconds)));
  add("hessian", tetrahedra,
    TIMED(
      vtkMeshMetric, SetSource(Tensors::HESSIAN), SetInputArrayToProcess(1, 0, 0, points, "V")));
  add("projection", triangles,
    TIMED(vtkMeshMetric, SetSource(Tensors::HESSIAN), SetRecovery(Tensors::DOUBLE_PROJECTION),
      SetInputArrayToProcess(1, 0, 0, points, "T"), SetTarget(Tensors::INTERPOLATION_ERROR)));
  add("sizes", triangles,
    TIMED(vtkMeshMetric, SetSource(Tensors::SIZES), SetInputArrayToProcess(0, 0, 0, points, "T"),
      SetInputArrayToProcess(4, 0, 0, points, "T")));
  add("distance", tetrahedra, TIMED(vtkMeshMetric, SetSource(Tensors::DISTANCE)));
  add("curvature", tetrahedra, TIMED(vtkMeshMetric, SetFeatureAngle(180)));
  using Transfer = vtkFieldTransfer;
  add("", triangles, TIMED(vtkFieldTransfer, SetInputDataObject(1, renamed(triangles()))));
  add("solid", tetrahedra,
    TIMED(vtkFieldTransfer, SetCellOrder(Transfer::LINEAR),
      SetInputDataObject(1, renamed(tetrahedra()))));
  add("source", triangles,
    TIMED(vtkFieldTransfer, SetCellOrder(Transfer::LINEAR), SetInputDataObject(0, triangles())), 1,
    false);
  add("interpolate", triangles,
    TIMED(vtkFieldTransfer, SetMethod(Transfer::INTERPOLATE), SetInputDataObject(0, triangles())),
    1, false);
  module = "Reconnection";
  add("", tetrahedra, MADE(vtkMeshImprover, SetTimeLimit(Seconds)), 0, false, 1);
  add("flat", tetrahedra,
    TIMED(vtkMeshImprover, SetPreset(vtkMeshImprover::AGGRESSIVE),
      SetBoundary(vtkMeshImprover::SLIDING), SetInputArrayToProcess(1, 0, 0, cells, "Material")),
    0, false);
  module = "Deformation";
  add("", triangles, TIMED(vtkMeshWarp, SetTransform(turn())), 0, true, 2);
  add("solid", tetrahedra, TIMED(vtkMeshWarp, SetTransform(turn())));
  add("displacement", triangles,
    WARP(SetMotion(vtkMeshWarp::DISPLACEMENT), SetInputArrayToProcess(0, 0, 0, points, "V")));
  add("target", triangles, WARP(SetMotion(vtkMeshWarp::TARGET), SetInputDataObject(0, triangles())),
    1, false);
  add("", triangles, PLAIN(vtkMovingBoundary), 0, false);
  module = "Elliptic";
  add("", triangles, MADE(vtkEllipticSolver, SetTimeLimit(Seconds)), 0, true, 1);
  add(
    "elasticity", tetrahedra, TIMED(vtkEllipticSolver, SetEquation(vtkEllipticSolver::ELASTICITY)));
  add("", triangles, MADE(vtkConditionEstimator, SetTimeLimit(Seconds)));
  add("", triangles, MADE(vtkSolverStudy, SetTimeLimit(Seconds)));
  module = "Peridynamics";
  using Stiffness = vtkPeridynamicStiffness;
  add("", triangles, TIMED(vtkPeridynamicStiffness, SetHorizon(1.0), SetConstrained(false)));
  add("solve", triangles, SOLVED(SetBasis(Stiffness::PIECEWISE_LINEAR)));
  add("state-based", triangles,
    SOLVED(SetDiscretization(Stiffness::EXACT), SetElastic(true), SetStateBased(true)));
  add("local AMG", triangles, SOLVED(SetPreconditioner(Stiffness::LOCAL_AMG)));
  add("two-level", triangles, SOLVED(SetPreconditioner(Stiffness::TWO_LEVEL)));
  add("", triangles, MADE(vtkInteractionLayer, SetWidth(1.0), SetElementSize(1.0)), 0, false);
  add("", triangles, MADE(vtkHorizonNeighbors, SetCenter(2, 2, 0), SetHorizon(1.0)), 0, false);
  module = "Shapes";
  add("", image, MADE(vtkSilhouetteMesher, SetSpacing(5)), 0, false);
  add("source", polygon, SHAPES(vtkShapeMatcher, SetInputDataObject(1, silhouette())), 0, false);
  add("target", image, SHAPES(vtkShapeMatcher, SetInputDataObject(0, polygon())), 1, false);
  add("", images, TIMED(vtkShapeRetrieval, SetSpacing(5), SetGridSize(8, 8)), 0, false);
#ifdef TAUTLINE_MESHING
  module = "Meshing";
  add("", closedSurface, MADE(vtkTetGenMesher, SetTimeLimit(Seconds)), 0, false);
  add("", outlines, PLAIN(vtkTriangleMesher), 0, false);
  add("sizes", outlines,
    MADE(vtkTriangleMesher, SetUseSizeArray(true), SetInputArrayToProcess(0, 0, 0, points, "T")), 0,
    false);
#endif
}

template <class Writer>
void addWriter(std::vector<HostileFilter>& list, const char* name, const std::string& file,
  const std::function<Data()>& suitable)
{
  TAUTLINE_LET(HostileFilter, entry, module = "Readers", name = name);
  entry.make = [file]
  { return TAUTLINE_CHANGED(vtkSmartPointer<Writer>::New(), SetFileName(file.c_str())); };
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
  addWriter<vtkMfemWriter>(list, "vtkMfemWriter", name + "-mfem.mesh", triangles);
  addWriter<vtkOffWriter>(list, "vtkOffWriter", name + ".off", triangles);
  addWriter<vtkTetGenWriter>(list, "vtkTetGenWriter", name + ".node", tetrahedra);
  addWriter<vtkFoamPointsWriter>(list, "vtkFoamPointsWriter", name + "-case/hostile.foam",
    [folder = name + "-case"]
    {
      writeFoam(folder + "/constant/polyMesh", oneTetrahedron());
      vtkNew<vtkFoamMeshReader> reader;
      reader->SetFileName(folder.c_str());
      reader->Update();
      return Data(reader->GetOutput());
    });
  return list;
}

//------------------------------------------------------------------------------
const std::vector<std::string>& classesWithoutInput()
{
  static const std::vector<std::string> names = { "vtkTautlineAlgorithm",
    "vtkTautlineTimedAlgorithm", "vtkMeshBoundaryAlgorithm", "vtkMeshMotionAlgorithm",
    "vtkMetricAlgorithm", "vtkEllipticAlgorithm", "vtkKrylovAlgorithm", "vtkShapeAlgorithm",
    "vtkBoundaryMesher", "vtkMeshFileReader", "vtkMeshFileWriter", "vtkMetricField",
    "vtkDomainSource", "vtkGmshReader", "vtkAbaqusReader", "vtkNastranReader", "vtkMeditReader",
    "vtkMfemReader", "vtkFluentMeshReader", "vtkFoamMeshReader", "vtkOffReader", "vtkTetGenReader",
    "vtkSilhouetteSetReader", "vtkHtmlReport", "vtkImageFileReader", "vtkInterruption",
    "vtkMeshDecomposition", "vtkTautlineSetRange", "vtkUpdateGuard", "vtkUserMetric" };
  return names;
}

} // namespace tautline
