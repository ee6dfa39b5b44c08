// SPDX-License-Identifier: BSD-3-Clause
// The meshers: bounds kept, sizes exact, markers and regions, failures as errors.

#include "Registry.h"
#include "VtkMeshes.h"
#include "vtkCommand.h"
#include "vtkFieldData.h"
#include "vtkSphereSource.h"
#include "vtkTestErrorObserver.h"
#include "vtkTetGenMesher.h"
#include "vtkTetGenReader.h"
#include "vtkTransform.h"
#include "vtkTransformFilter.h"
#include "vtkTriangleMesher.h"

#include <filesystem>

using namespace tautline;

namespace
{

std::string data;

struct Facts
{
  double size = 0.0, smallestAngle = 180.0, longestEdge = 0.0, largestCell = 0.0;
};

Facts measure(vtkUnstructuredGrid* mesh)
{
  Facts facts;
  for (vtkIdType i = 0; i < mesh->GetNumberOfCells(); ++i)
  {
    vtkIdType size;
    const vtkIdType* ids;
    mesh->GetCellPoints(i, size, ids);
    Vec3 p[4];
    for (vtkIdType c = 0; c < size; ++c)
    {
      mesh->GetPoint(ids[c], p[c].data());
    }
    const Vec3 normal = cross(p[1] - p[0], p[2] - p[0]);
    const double cell = size == 3 ? 0.5 * normal[2] : dot(normal, p[3] - p[0]) / 6.0;
    TAUTLINE_CHECK(cell > 0.0);
    facts.size += cell;
    facts.largestCell = std::max(facts.largestCell, cell);
    for (int c = 0; size == 3 && c < 3; ++c)
    {
      const Vec3 a = p[(c + 1) % 3] - p[c], b = p[(c + 2) % 3] - p[c];
      const double angle = std::acos(dot(a, b) / (norm(a) * norm(b)));
      facts.smallestAngle = std::min(facts.smallestAngle, angle * 180.0 / std::acos(-1.0));
      facts.longestEdge = std::max(facts.longestEdge, norm(a));
    }
  }
  return facts;
}

vtkSmartPointer<vtkUnstructuredGrid> read(const char* name)
{
  TAUTLINE_NEW(vtkTetGenReader, reader, SetFileName((data + "/" + name).c_str()), Update());
  return outputOf<vtkUnstructuredGrid>(reader);
}

/// A closed polygon as lines.
vtkSmartPointer<vtkPolyData> outline(const std::vector<std::array<double, 2>>& corners)
{
  auto lines = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  for (const auto& [x, y] : corners)
  {
    points->InsertNextPoint(x, y, 2.5);
  }
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    cells->InsertNextCell({ i, (i + 1) % points->GetNumberOfPoints() });
  }
  TAUTLINE_SET(lines, SetPoints(points), SetLines(cells));
  return lines;
}

std::string failure(vtkAlgorithm* mesher, vtkDataObject* input)
{
  mesher->SetInputDataObject(input);
  const std::string error = errorOf(mesher);
  TAUTLINE_CHECK(outputOf(mesher)->GetNumberOfCells() == 0);
  return error;
}

TAUTLINE_PART(testTriangles)
{
  // a plate of 9 with a hole of 1
  TAUTLINE_NEW(vtkTriangleMesher, mesher, SetInputData(read("plate.poly")), SetSize(0.2),
    SetMinimumAngle(25.0), Update());
  Facts facts = measure(mesher->GetOutput());
  TAUTLINE_CHECK(std::abs(facts.size - 8.0) < 1e-12);
  TAUTLINE_CHECK(facts.longestEdge <= 0.2 && facts.smallestAngle >= 25.0);
  vtkDataArray* markers = mesher->GetOutput()->GetPointData()->GetArray("BoundaryMarker");
  for (vtkIdType i = 0; i < mesher->GetOutput()->GetNumberOfPoints(); ++i)
  {
    const double* x = mesher->GetOutput()->GetPoint(i);
    const bool outer = x[0] == 0.0 || x[0] == 3.0 || x[1] == 0.0 || x[1] == 3.0;
    const bool onHole = std::max(std::abs(x[0] - 1.5), std::abs(x[1] - 1.5)) == 0.5;
    TAUTLINE_CHECK(markers->GetTuple1(i) == (outer ? 1 : onHole ? 2 : 0));
  }
  auto* boundary = vtkPolyData::SafeDownCast(mesher->GetOutputDataObject(1));
  TAUTLINE_CHECK(
    boundary->GetNumberOfLines() > 16 / 0.2 && boundary->GetCellData()->GetArray("BoundaryMarker"));

  // without the field Holes the inner square is a hole by parity; whatever the line to it
  vtkSmartPointer<vtkUnstructuredGrid> plate = read("plate.poly");
  plate->GetFieldData()->Initialize();
  TAUTLINE_SET(mesher, SetInputData(plate), Update());
  TAUTLINE_CHECK(std::abs(measure(mesher->GetOutput()).size - 8.0) < 1e-12);

  // sizes from an array: small at one corner; z is kept
  vtkSmartPointer<vtkPolyData> square = outline({ { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } });
  const auto sizes = filledArray<vtkDoubleArray>(
    "size", std::vector<double>{ 0.01, 0.5, 0.5, 0.5 }, [&](const double size) { return size; });
  square->GetPointData()->AddArray(sizes);
  TAUTLINE_SET(mesher, SetInputData(square), SetSize(0.0), UseSizeArrayOn(),
    SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "size"), Update());
  vtkUnstructuredGrid* graded = mesher->GetOutput();
  vtkIdType near = 0;
  for (vtkIdType i = 0; i < graded->GetNumberOfPoints(); ++i)
  {
    const double* x = graded->GetPoint(i);
    TAUTLINE_CHECK(x[2] == 2.5);
    near += std::hypot(x[0], x[1]) < 0.1;
  }
  TAUTLINE_CHECK(near > 20 && near < graded->GetNumberOfPoints() / 2);
  TAUTLINE_CHECK(std::abs(measure(graded).size - 1.0) < 1e-12);
}

/// Coordinates of any magnitude: the mesh is the same, times a power of two even bit by bit.
TAUTLINE_PART(testTriangleScales)
{
  const auto meshed = [](double scale, bool sizes)
  {
    const auto square =
      outline({ { 0, 0 }, { 3 * scale, 0 }, { 3 * scale, 2 * scale }, { 0, 2 * scale } });
    TAUTLINE_NEW(vtkPoints, points, SetDataType(VTK_DOUBLE));
    for (const auto& [x, y] : { std::array<double, 2>{ 0, 0 }, { 3 * scale, 0 },
           { 3 * scale, 2 * scale }, { 0, 2 * scale } })
    {
      points->InsertNextPoint(x, y, 0);
    }
    square->SetPoints(points);
    const auto array = filledArray<vtkDoubleArray>("size",
      std::vector<double>{ 0.1, 1.0, 1.0, 1.0 }, [&](const double size) { return size * scale; });
    square->GetPointData()->AddArray(array);
    TAUTLINE_NEW(vtkTriangleMesher, mesher, SetInputData(square),
      SetSize(sizes ? 0.0 : 0.3 * scale), SetUseSizeArray(sizes),
      SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "size"), Update());
    vtkSmartPointer<vtkUnstructuredGrid> mesh = mesher->GetOutput();
    return mesh;
  };
  for (const bool sizes : { false, true })
  {
    const auto unit = meshed(1.0, sizes);
    TAUTLINE_CHECK(unit->GetNumberOfCells() > 100);
    for (const int exponent : { -1000, -660, -3, 530, 980 })
    {
      const auto other = meshed(std::ldexp(1.0, exponent), sizes);
      TAUTLINE_CHECK_EQUAL(other->GetNumberOfCells(), unit->GetNumberOfCells());
      bool same = other->GetNumberOfPoints() == unit->GetNumberOfPoints();
      for (vtkIdType i = 0; same && i < unit->GetNumberOfPoints(); ++i)
      {
        for (int c = 0; c < 2; ++c)
        {
          same = same && other->GetPoint(i)[c] == std::ldexp(unit->GetPoint(i)[c], exponent);
        }
      }
      TAUTLINE_CHECK(same);
    }
    for (const double scale : { 1e160, 1e-200 })
    {
      TAUTLINE_CHECK(meshed(scale, sizes)->GetNumberOfCells() > 100);
    }
  }
}

TAUTLINE_PART(testTriangleFailures)
{
  const double half = 1e20;
  TAUTLINE_NEW(vtkTriangleMesher, fine, SetSize(1.0));
  TAUTLINE_CHECK(contains(
    failure(fine, outline({ { -half, -half }, { half, -half }, { half, half }, { -half, half } })),
    wording("a-size-is-1-less-than-coordinates")));
  fine->SetSize(1e-8);
  TAUTLINE_CHECK(contains(failure(fine, outline({ { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } })),
    wording("would-divide-the-outlines-into-more-than")));
  vtkNew<vtkTriangleMesher> crossing;
  const std::string said = failure(crossing, outline({ { 0, 0 }, { 1, 1 }, { 1, 0 }, { 0, 1 } }));
  TAUTLINE_CHECK(contains(said, wording("segment-2-points-2-and-3-crosses")));
  vtkNew<vtkTriangleMesher> open;
  vtkSmartPointer<vtkPolyData> line = outline({ { 0, 0 }, { 1, 0 }, { 1, 1 } });
  TAUTLINE_NEW(vtkCellArray, two, InsertNextCell({ 0, 1 }), InsertNextCell({ 1, 2 }));
  line->SetLines(two);
  TAUTLINE_CHECK(contains(failure(open, line), wording("is-an-outline-closed")));
  TAUTLINE_NEW(vtkSphereSource, sphere, Update());
  vtkNew<vtkTriangleMesher> solid;
  TAUTLINE_CHECK(
    contains(failure(solid, sphere->GetOutput()), wording("not-in-a-plane-z-constant")));
  vtkNew<vtkTriangleMesher> infinite;
  TAUTLINE_CHECK(contains(failure(infinite, outline({ { 0, 0 }, { 1, 0 }, { NAN, 1 } })),
    wording("not-a-finite-number")));

  // abort, as a user interface would ask for it
  TAUTLINE_NEW(vtkTriangleMesher, aborted, SetSize(0.002));
  stopAt(aborted, vtkCommand::ProgressEvent);
  TAUTLINE_CHECK_EQUAL(
    failure(aborted, outline({ { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } })), std::string());
  TAUTLINE_CHECK(aborted->GetAbortExecute() != 0);
}

TAUTLINE_PART(testTetrahedra)
{
  TAUTLINE_NEW(
    vtkTetGenMesher, mesher, SetInputData(read("cube.smesh")), SetVolume(0.005), Update());
  Facts facts = measure(mesher->GetOutput());
  TAUTLINE_CHECK(std::abs(facts.size - 1.0) < 1e-12 && facts.largestCell <= 0.005 * (1 + 1e-9));
  TAUTLINE_CHECK(mesher->GetOutput()->GetNumberOfCells() > 200);
  // cube.smesh: bottom 1, top 2, then the sides y = 0, x = 1, y = 1, x = 0
  auto* boundary = vtkPolyData::SafeDownCast(mesher->GetOutputDataObject(1));
  vtkDataArray* markers = boundary->GetCellData()->GetArray("BoundaryMarker");
  double areas[7] = {};
  for (vtkIdType i = 0; i < boundary->GetNumberOfCells(); ++i)
  {
    vtkIdType size;
    const vtkIdType* ids;
    boundary->GetCellPoints(i, size, ids);
    Vec3 p[3];
    for (int c = 0; c < 3; ++c)
    {
      boundary->GetPoint(ids[c], p[c].data());
    }
    areas[static_cast<int>(markers->GetTuple1(i))] += 0.5 * norm(cross(p[1] - p[0], p[2] - p[0]));
    TAUTLINE_CHECK(markers->GetTuple1(i) != 1 || p[0][2] == 0.0);
  }
  for (int m = 1; m <= 6; ++m)
  {
    TAUTLINE_CHECK(std::abs(areas[m] - 1.0) < 1e-12);
  }
  TAUTLINE_CHECK(areas[0] == 0.0);

  TAUTLINE_SET(mesher, PreserveSurfaceOn(), Update());
  TAUTLINE_CHECK(
    vtkPolyData::SafeDownCast(mesher->GetOutputDataObject(1))->GetNumberOfCells() == 12);
  TAUTLINE_CHECK(std::abs(measure(mesher->GetOutput()).size - 1.0) < 1e-12);
}

/// A bound of the volume far below 1e-15: of a cube in meters whose edge is a few nanometers long.
TAUTLINE_PART(testTetrahedraScales)
{
  constexpr double scale = 1e-8;
  TAUTLINE_NEW(vtkTransform, shrink, Scale(scale, scale, scale));
  TAUTLINE_NEW(vtkTransformFilter, small, SetTransform(shrink), SetInputData(read("cube.smesh")));
  TAUTLINE_NEW(vtkTetGenMesher, mesher, SetInputConnection(small->GetOutputPort()));
  const double volume = 0.005 * scale * scale * scale;
  TAUTLINE_SET(mesher, SetVolume(volume), Update());
  const Facts facts = measure(mesher->GetOutput());
  TAUTLINE_CHECK_RELATIVE(facts.size, scale * scale * scale, 1e-9);
  TAUTLINE_CHECK(facts.largestCell <= volume * (1 + 1e-9));
  TAUTLINE_CHECK(mesher->GetOutput()->GetNumberOfCells() > 200);
}

/// Facets that are kept hold larger tetrahedra than requested: no smaller bound is tried then,
/// which would only make many more inside.
TAUTLINE_PART(testTetrahedraOfKeptSurface)
{
  constexpr int steps = 24; // around and between the poles
  TAUTLINE_NEW(vtkSphereSource, sphere, SetThetaResolution(steps), SetPhiResolution(steps));
  TAUTLINE_NEW(
    vtkTetGenMesher, mesher, SetInputConnection(sphere->GetOutputPort()), PreserveSurfaceOn());
  const double volume = 2e-5;
  TAUTLINE_SET(mesher, SetVolume(volume), Update());
  const Facts facts = measure(mesher->GetOutput());
  TAUTLINE_CHECK(facts.largestCell > volume);
  const auto cells = static_cast<double>(mesher->GetOutput()->GetNumberOfCells());
  const double least = facts.size / volume; // 1.5 times as many; with smaller bounds 3.6 times
  TAUTLINE_CHECK(cells > least && cells < 2 * least);
}

/// Two nested cubes: the inner one a region of its own, or a hole.
TAUTLINE_PART(testRegionsAndHoles)
{
  vtkSmartPointer<vtkUnstructuredGrid> cube = read("cube.smesh");
  vtkNew<vtkPolyData> nested;
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> polygons;
  for (const double scale : { 1.0, 0.5 })
  {
    const vtkIdType first = points->GetNumberOfPoints();
    for (vtkIdType i = 0; i < 8; ++i)
    {
      const double* x = cube->GetPoint(i);
      points->InsertNextPoint(
        0.5 + scale * (x[0] - 0.5), 0.5 + scale * (x[1] - 0.5), 0.5 + scale * (x[2] - 0.5));
    }
    for (vtkIdType i = 0; i < 6; ++i)
    {
      vtkIdType size;
      const vtkIdType* ids;
      cube->GetCellPoints(i, size, ids);
      polygons->InsertNextCell({ first + ids[0], first + ids[1], first + ids[2], first + ids[3] });
    }
  }
  TAUTLINE_SET(nested, SetPoints(points), SetPolys(polygons));
  TAUTLINE_NEW(vtkDoubleArray, regions, SetName("Regions"), SetNumberOfComponents(5));
  const double outside[] = { 0.1, 0.1, 0.1, 3, -1 }, inside[] = { 0.5, 0.5, 0.5, 8, 0.001 };
  TAUTLINE_SET(regions, InsertNextTuple(outside), InsertNextTuple(inside));
  nested->GetFieldData()->AddArray(regions);
  TAUTLINE_NEW(vtkTetGenMesher, mesher, SetInputData(nested), Update());
  vtkUnstructuredGrid* mesh = mesher->GetOutput();
  TAUTLINE_CHECK(std::abs(measure(mesh).size - 1.0) < 1e-12);
  vtkDataArray* references = mesh->GetCellData()->GetArray("Reference");
  vtkIdType inner = 0, outer = 0;
  for (vtkIdType i = 0; references && i < mesh->GetNumberOfCells(); ++i)
  {
    inner += references->GetTuple1(i) == 8;
    outer += references->GetTuple1(i) == 3;
  }
  TAUTLINE_CHECK(inner >= 125 && outer > 0 && inner + outer == mesh->GetNumberOfCells());

  nested->GetFieldData()->Initialize();
  TAUTLINE_NEW(vtkDoubleArray, holes, SetName("Holes"), SetNumberOfComponents(3),
    InsertNextTuple3(0.5, 0.5, 0.5));
  nested->GetFieldData()->AddArray(holes);
  mesher->Update();
  TAUTLINE_CHECK(std::abs(measure(mesher->GetOutput()).size - 0.875) < 1e-12);

  vtkNew<vtkTetGenMesher>
    box; // a facet of several polygons with a hole is no closed surface, but a good input
  box->SetInputData(read("box.poly"));
  box->GetInputDataObject(0, 0)->GetFieldData()->RemoveArray("Holes");
  vtkNew<vtkTest::ErrorObserver> errors, quiet;
  TAUTLINE_SET(box, AddObserver(vtkCommand::ErrorEvent, errors),
    GetExecutive()->AddObserver(vtkCommand::ErrorEvent, quiet), Update());
  TAUTLINE_CHECK(errors->GetError() || box->GetOutput()->GetNumberOfCells() > 0);
}

TAUTLINE_PART(testTetrahedraFailures)
{
  // two spheres through each other
  vtkNew<vtkPolyData> both;
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> polygons;
  for (const double x : { 0.0, 0.31 })
  {
    TAUTLINE_NEW(vtkSphereSource, sphere, SetCenter(x, 0.013, 0.007), Update());
    const vtkIdType first = points->GetNumberOfPoints();
    for (vtkIdType i = 0; i < sphere->GetOutput()->GetNumberOfPoints(); ++i)
    {
      points->InsertNextPoint(sphere->GetOutput()->GetPoint(i));
    }
    for (vtkIdType i = 0; i < sphere->GetOutput()->GetNumberOfCells(); ++i)
    {
      vtkIdType size;
      const vtkIdType* ids;
      sphere->GetOutput()->GetCellPoints(i, size, ids);
      polygons->InsertNextCell({ first + ids[0], first + ids[1], first + ids[2] });
    }
  }
  TAUTLINE_SET(both, SetPoints(points), SetPolys(polygons));
  vtkNew<vtkTetGenMesher> crossing;
  TAUTLINE_CHECK(
    contains(failure(crossing, both), wording("the-surface-intersects-itself-facets")));
  // TetGen 1.6 writes files then.
  TAUTLINE_CHECK(!std::filesystem::exists("tetgen-tmpfile_skipped.face"));

  vtkNew<vtkTetGenMesher> open;
  TAUTLINE_NEW(vtkSphereSource, half, SetEndTheta(180.0), Update());
  TAUTLINE_CHECK(contains(failure(open, half->GetOutput()), wording("is-it-closed")));

  vtkNew<vtkTetGenMesher> flat;
  TAUTLINE_CHECK(contains(
    failure(flat, outline({ { 0, 0 }, { 1, 0 }, { 1, 1 } })), wording("3-cells-are-no-triangles")));
  vtkNew<vtkTetGenMesher> nan;
  TAUTLINE_NEW(vtkSphereSource, broken, Update(), GetOutput()->GetPoints()->SetPoint(3, 0, NAN, 0));
  TAUTLINE_CHECK(
    contains(failure(nan, broken->GetOutput()), wording("point-3-has-a-coordinate-that-is")));

  // abort ends TetGen in the midst of a million tetrahedra
  TAUTLINE_NEW(vtkTetGenMesher, aborted, SetVolume(1e-6));
  stopAt(aborted, vtkCommand::ProgressEvent);
  TAUTLINE_CHECK_EQUAL(failure(aborted, read("cube.smesh")), std::string());
  TAUTLINE_CHECK(aborted->GetAbortExecute() != 0);

  TAUTLINE_NEW(vtkTetGenMesher, slow, SetVolume(1e-7), SetTimeLimit(0.5));
  TAUTLINE_CHECK(contains(failure(slow, read("cube.smesh")), wording("the-time-limit-of-0-5-s")));

  // and after all these failures it works
  TAUTLINE_NEW(vtkTetGenMesher, works, SetInputData(read("cube.smesh")), Update());
  TAUTLINE_CHECK(works->GetOutput()->GetNumberOfCells() > 0);
  vtkNew<vtkPolyData> nothing;
  TAUTLINE_SET(works, SetInputData(nothing), Update());
  TAUTLINE_CHECK(works->GetOutput()->GetNumberOfCells() == 0);
}
}

TAUTLINE_TEST(TestMeshers)
{
  data = argv[1];
}
