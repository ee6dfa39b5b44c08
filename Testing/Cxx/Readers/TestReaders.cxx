// SPDX-License-Identifier: BSD-3-Clause
// What is in the sample files arrives, with the documented array names.

#include "Registry.h"
#include "MeshFileChecks.h"
#include "tautline/Mesh/Mesh.h"
#include "vtkCell.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkGmshReader.h"
#include "vtkMeditReader.h"
#include "vtkNew.h"
#include "vtkOffReader.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkTestErrorObserver.h"
#include "vtkTetGenReader.h"
#include "vtkUnstructuredGrid.h"

#include <cstdint>
#include <initializer_list>

using namespace tautline;

namespace
{
std::string data;
std::string output;

double value(const std::vector<MeshArray>& arrays, const char* name, std::size_t i)
{
  const MeshArray* array = findArray(arrays, name);
  TAUTLINE_CHECK(array && i < array->size());
  return array && i < array->size() ? array->at(i) : std::nan("");
}

/// Sum of the volumes of tetrahedra, corners only; each must be positive in VTK's order.
double volume(const MeshFile& mesh)
{
  double sum = 0.0;
  for (std::size_t cell = 0; cell < mesh.cellTypes.size(); ++cell)
  {
    if (mesh.cellTypes[cell] != FileTetrahedron && mesh.cellTypes[cell] != FileTetrahedron10)
    {
      continue;
    }
    Vec3 p[4];
    for (std::size_t c = 0; c < 4; ++c)
    {
      const Index id = mesh.connectivity[static_cast<std::size_t>(mesh.offsets[cell]) + c];
      p[c] = { mesh.points[3 * id], mesh.points[3 * id + 1], mesh.points[3 * id + 2] };
    }
    const double v = dot(cross(p[1] - p[0], p[2] - p[0]), p[3] - p[0]) / 6.0;
    TAUTLINE_CHECK(v > 0.0);
    sum += v;
  }
  return sum;
}

TAUTLINE_PART(testTetGen)
{
  const MeshFile tets = readTetGen(data + "/cube.1.node", false);
  TAUTLINE_CHECK(tets.numberOfPoints() == 73 && tets.numberOfCells() == 171);
  TAUTLINE_CHECK(countCells(tets, FileTetrahedron) == 171);
  TAUTLINE_CHECK(std::abs(volume(tets) - 1.0) < 1e-12);
  const MeshFile all = readTetGen(data + "/cube.1.edge", true);
  TAUTLINE_CHECK(countCells(all, FileTetrahedron) == 171 && countCells(all, FileTriangle) == 132);
  TAUTLINE_CHECK(countCells(all, FileLine) > 0);
  // the first face of cube.1.face has marker 4, tetrahedra have none
  TAUTLINE_CHECK(value(all.cellArrays, "BoundaryMarker", 0) == 0.0);
  TAUTLINE_CHECK(value(all.cellArrays, "BoundaryMarker", 171) == 4.0);
  TAUTLINE_CHECK(value(all.cellArrays, "Reference", 0) == 1.0);
  TAUTLINE_CHECK(same(all, readTetGen(data + "/cube.1.ele", true)));

  const MeshFile quadratic = readTetGen(data + "/quadratic.1.ele", true);
  TAUTLINE_CHECK(countCells(quadratic, FileTetrahedron10) == 6);
  TAUTLINE_CHECK(countCells(quadratic, FileTriangle6) == 18);
  TAUTLINE_CHECK(std::abs(volume(quadratic) - 1.0) < 1e-12);
}

TAUTLINE_PART(testComplexes)
{
  const MeshFile plate = readTetGen(data + "/plate.poly", false);
  TAUTLINE_CHECK(plate.numberOfPoints() == 8 && countCells(plate, FileLine) == 9);
  TAUTLINE_CHECK(value(plate.pointArrays, "Attribute1", 7) == 17.5);
  TAUTLINE_CHECK(value(plate.pointArrays, "BoundaryMarker", 4) == 2.0);
  TAUTLINE_CHECK(value(plate.cellArrays, "BoundaryMarker", 8) == 0.0);
  TAUTLINE_CHECK(value(plate.fieldArrays, "Holes", 1) == 1.5);
  TAUTLINE_CHECK(value(plate.fieldArrays, "Regions", 5 + 3) == 2.0);
  TAUTLINE_CHECK(value(plate.fieldArrays, "Regions", 4) == 0.1);

  const MeshFile box = readTetGen(data + "/box.poly", false);
  TAUTLINE_CHECK(box.numberOfPoints() == 12 && box.numberOfCells() == 7);
  TAUTLINE_CHECK(
    value(box.cellArrays, "Facet", 2) == 1.0 && value(box.cellArrays, "Facet", 3) == 2.0);
  TAUTLINE_CHECK(value(box.cellArrays, "BoundaryMarker", 2) == 2.0);
  TAUTLINE_CHECK(value(box.fieldArrays, "FacetHoles", 0) == 1.0);
  TAUTLINE_CHECK(value(box.fieldArrays, "FacetHoles", 3) == 2.0);
  TAUTLINE_CHECK(value(box.fieldArrays, "Regions", 3) == 7.0);

  const MeshFile cube = readTetGen(data + "/cube.smesh", false);
  TAUTLINE_CHECK(countCells(cube, FileQuadrilateral) == 6);
  TAUTLINE_CHECK(value(cube.cellArrays, "BoundaryMarker", 5) == 6.0);
}

TAUTLINE_PART(testMedit)
{
  const MeshFile zoo = readMedit(data + "/zoo.sol", true);
  TAUTLINE_CHECK(zoo.numberOfPoints() == 14 && zoo.numberOfCells() == 9);
  const std::vector<unsigned char> types = { FileTetrahedron, FileHexahedron, FileWedge,
    FilePyramid, FilePyramid, FileTriangle, FileQuadrilateral, FileLine, FileLine };
  TAUTLINE_CHECK(zoo.cellTypes == types);
  const double references[] = { 14, 11, 13, 12, 12, 21, 22, 31, 32 };
  TAUTLINE_EACH(
    std::size_t, i, 9, TAUTLINE_CHECK(value(zoo.cellArrays, "Reference", i) == references[i]));
  TAUTLINE_CHECK(value(zoo.pointArrays, "Reference", 13) == 6.0);
  TAUTLINE_CHECK(
    value(zoo.pointArrays, "Corner", 8) == 1.0 && value(zoo.pointArrays, "Corner", 12) == 0.0);
  TAUTLINE_CHECK(
    value(zoo.pointArrays, "Fixed", 8) == 1.0 && value(zoo.pointArrays, "Fixed", 12) == 1.0);
  TAUTLINE_CHECK(value(zoo.pointArrays, "Fixed", 1) == 0.0);
  TAUTLINE_CHECK(
    value(zoo.cellArrays, "Ridge", 7) == 0.0 && value(zoo.cellArrays, "Ridge", 8) == 1.0);
  TAUTLINE_CHECK(
    value(zoo.cellArrays, "Required", 7) == 1.0 && value(zoo.cellArrays, "Required", 5) == 1.0);
  TAUTLINE_CHECK(value(zoo.pointArrays, "Solution1", 3) == 1.5);
  TAUTLINE_CHECK(value(zoo.pointArrays, "Solution2", 3 * 2 + 1) == -2.0);
  // m11 m21 m22 m31 m32 m33 = 1 0.5 2 0.25 0.125 3 of vertex 0, as a matrix
  const double tensor[] = { 1, 0.5, 0.25, 0.5, 2, 0.125, 0.25, 0.125, 3 };
  TAUTLINE_EACH(
    std::size_t, i, 9, TAUTLINE_CHECK(value(zoo.pointArrays, "Solution3", i) == tensor[i]));
  // VTK's wedge has its first triangle counter-clockwise from outside
  const Index wedge[] = { 1, 2, 9, 5, 6, 10 };
  TAUTLINE_EACH(std::size_t, i, 6,
    TAUTLINE_CHECK(zoo.connectivity[static_cast<std::size_t>(zoo.offsets[2]) + i] == wedge[i]));
  TAUTLINE_CHECK(readMedit(data + "/zoo.mesh", false).numberOfCells() == 5);
}

TAUTLINE_PART(testGmsh)
{
  for (const char* name : { "/part.msh", "/part22-binary.msh" })
  {
    const MeshFile part = readGmsh(data + name, true);
    TAUTLINE_CHECK(part.numberOfPoints() == 99 && countCells(part, FileTetrahedron) == 243);
    TAUTLINE_CHECK(countCells(part, FileTriangle) == 52);
    TAUTLINE_CHECK(std::abs(volume(part) - 1.0) < 1e-12);
    TAUTLINE_CHECK(value(part.cellArrays, "Reference", 0) == 5.0);
    TAUTLINE_CHECK(value(part.cellArrays, "Reference", 294) == 20.0);
    TAUTLINE_CHECK(value(part.cellArrays, "Entity", 294) == 2.0);
    TAUTLINE_CHECK(part.fieldStrings.size() == 1 && part.fieldStrings[0].values.size() == 3);
    TAUTLINE_CHECK(value(part.fieldArrays, "PhysicalGroups", 1) == 5.0);
    TAUTLINE_CHECK(part.fieldStrings[0].values[0] == "bottom");
    TAUTLINE_CHECK(readGmsh(data + name, false).numberOfCells() == 243);
  }
}

/// A tetrahedron and the triangle below it, in group 5 "solid" and 20.
void checkSmall(const MeshFile& mesh)
{
  TAUTLINE_CHECK(mesh.numberOfPoints() == 4 && mesh.numberOfCells() == 2);
  TAUTLINE_CHECK(countCells(mesh, FileTetrahedron) == 1 && countCells(mesh, FileTriangle) == 1);
  TAUTLINE_CHECK_EQUAL(volume(mesh), 1.0 / 6);
  TAUTLINE_CHECK(value(mesh.cellArrays, "Reference", 0) == 20);
  TAUTLINE_CHECK(value(mesh.cellArrays, "Reference", 1) == 5);
  TAUTLINE_CHECK(value(mesh.cellArrays, "Entity", 0) == 2);
  TAUTLINE_CHECK(value(mesh.cellArrays, "Entity", 1) == 1);
  TAUTLINE_CHECK(mesh.warnings.empty());
}

/// Versions 1 and 4.0 of Gmsh's format, and names of groups without their dimension.
TAUTLINE_PART(testOldGmsh)
{
  const std::string file = output + "/old.msh";
  writeText(file,
    "$NOD\n4\n1 0 0 0\n2 1 0 0\n\n4 0 1 0\n7 0 0 1\n$ENDNOD\n$ELM\n2\n"
    "1 2 20 2 3 1 2 4\n2 4 5 1 4 1 2 4 7\n$ENDELM\n");
  checkSmall(readGmsh(file, true));
  vtkNew<vtkGmshReader> reader;
  TAUTLINE_CHECK(reader->CanReadFile(file.c_str()) == 1);

  // In 4.0, points of $Entities have a box, too; the tag of an entity comes before its dimension.
  writeText(file,
    "$MeshFormat\n4 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n\n 5 \"solid\"\n20 \"below\"\n"
    "$EndPhysicalNames\n$Entities\n1 0 1 1\n3 0 0 0 0 0 0 0\n2 0 0 0 1 1 0 1 20 0\n"
    "1 0 0 0 1 1 1 1 5 1 2\n$EndEntities\n$Nodes\n2 4\n3 0 0 1\n1 0 0 0\n2 2 1 3\n"
    "2 1 0 0 1 0\n4 0 1 0 0 1\n7 0 0 1 0.5 0.5\n$EndNodes\n$Elements\n2 2\n2 2 2 1\n1 1 2 4\n"
    "1 3 4 1\n2 1 2 4 7\n$EndElements\n$NodeData\n1\n\"height\"\n1\n0\n3\n0\n1\n1\n7 8.5\n"
    "$EndNodeData\n");
  const MeshFile mesh = readGmsh(file, true);
  checkSmall(mesh);
  TAUTLINE_CHECK_EQUAL(value(mesh.pointArrays, "height", 3), 8.5);
  TAUTLINE_CHECK(value(mesh.fieldArrays, "PhysicalGroups", 0) == 3);
  TAUTLINE_CHECK(value(mesh.fieldArrays, "PhysicalGroups", 1) == 5);
  TAUTLINE_CHECK(value(mesh.fieldArrays, "PhysicalGroups", 2) == 2);
  TAUTLINE_CHECK(mesh.fieldStrings[0].values[1] == "below");

  // The same in binary: numbers of nodes and elements have four bytes in 4.0.
  std::string bytes = "$MeshFormat\n4 1 8\n";
  const auto add = [&bytes](auto number)
  { bytes.append(reinterpret_cast<const char*>(&number), sizeof(number)); };
  const auto addInts = [&](std::initializer_list<std::int32_t> numbers)
  { std::for_each(numbers.begin(), numbers.end(), add); };
  using Size = std::uint64_t;
  const auto addNode = [&](std::int32_t number, double x, double y, double z)
  {
    add(number);
    add(x);
    add(y);
    add(z);
  };
  add(std::int32_t(1));
  bytes += "\n$EndMeshFormat\n$Entities\n";
  for (const Size count : { 0, 0, 1, 1 })
  {
    add(count);
  }
  for (const std::int32_t group : { 20, 5 })
  {
    add(std::int32_t(group == 20 ? 2 : 1));
    for (int c = 0; c < 6; ++c)
    {
      add(0.0);
    }
    add(Size(1));
    add(group);
    add(Size(0));
  }
  bytes += "\n$EndEntities\n$Nodes\n";
  add(Size(1));
  add(Size(4));
  addInts({ 1, 3, 0 });
  add(Size(4));
  addNode(1, 0, 0, 0);
  addNode(2, 1, 0, 0);
  addNode(4, 0, 1, 0);
  addNode(7, 0, 0, 1);
  bytes += "\n$EndNodes\n$Elements\n";
  add(Size(2));
  add(Size(2));
  addInts({ 2, 2, 2 });
  add(Size(1));
  addInts({ 1, 1, 2, 4 });
  addInts({ 1, 3, 4 });
  add(Size(1));
  addInts({ 2, 1, 2, 4, 7 });
  bytes += "\n$EndElements\n";
  writeText(file, bytes);
  checkSmall(readGmsh(file, true));
}

/// Elements of third order are read as their corners; the other nodes go, unless a cell has them.
TAUTLINE_PART(testHighOrder)
{
  const std::string file = output + "/cubic.msh";
  std::ostringstream text;
  text << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n20\n";
  const double corners[4][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
  for (int n = 20; n > 0; --n) // the corners come last
  {
    const double* x = corners[n <= 4 ? n - 1 : 0];
    text << n << ' ' << x[0] + (n > 4) * n << ' ' << x[1] << ' ' << x[2] << '\n';
  }
  text << "$EndNodes\n$Elements\n2\n1 29 2 5 1";
  for (int n = 1; n <= 20; ++n)
  {
    text << ' ' << n;
  }
  text << "\n2 2 2 20 2 1 2 11\n$EndElements\n$NodeData\n1\n\"number\"\n0\n3\n0\n1\n5\n"
          "1 1\n2 2\n11 11\n12 12\n4 4\n$EndNodeData\n";
  writeText(file, text.str());
  const MeshFile mesh = readGmsh(file, true);
  TAUTLINE_CHECK(mesh.numberOfPoints() == 5 && countCells(mesh, FileTetrahedron) == 1);
  TAUTLINE_CHECK_EQUAL(volume(mesh), 1.0 / 6);
  // In the order of the file: 11, 4, 3, 2, 1.
  TAUTLINE_CHECK_EQUAL(mesh.points[0], 11.0);
  const double numbers[] = { 11, 4, 0, 2, 1 };
  TAUTLINE_EACH(std::size_t, i, 5,
    TAUTLINE_CHECK(i == 2 || value(mesh.pointArrays, "number", i) == numbers[i]));
  const std::vector<Index> nodes = { 4, 3, 2, 1, 4, 3, 0 };
  TAUTLINE_CHECK(mesh.connectivity == nodes);
  TAUTLINE_CHECK(mesh.warnings.size() == 1 &&
    mesh.warnings[0] ==
      "1 elements of third or fourth order are read as linear ones; 15 nodes that are no corners "
      "are left out.");

  vtkNew<vtkGmshReader> reader;
  vtkNew<vtkTest::ErrorObserver> observer;
  TAUTLINE_SET(
    reader, AddObserver(vtkCommand::WarningEvent, observer), SetFileName(file.c_str()), Update());
  TAUTLINE_CHECK_EQUAL(observer->CheckWarningMessage("read as linear ones"), 0);
}

/// The kernel finds every cell valid: orders of nodes are those VTK and Tautline compute with.
TAUTLINE_PART(testValidity)
{
  for (const char* name :
    { "/zoo.mesh", "/wedges.msh", "/part.msh", "/cube.1.ele", "/quadratic.1.ele" })
  {
    const MeshFile file = readByName(data + name, false);
    const Mesh mesh({ file.numberOfPoints(), file.points.data(), file.numberOfCells(),
      file.cellTypes.data(), file.offsets.data(), file.connectivity.data() });
    std::vector<signed char> validity(file.cellTypes.size());
    mesh.classifyCells(validity.data());
    TAUTLINE_CHECK(mesh.unsupportedCells() == 0);
    TAUTLINE_EACH_OF(const signed char each, validity, TAUTLINE_CHECK(each == Valid));
  }
}

TAUTLINE_PART(testFreeFemAndOff)
{
  const MeshFile tent = readGmsh(data + "/tent.msh", true);
  TAUTLINE_CHECK(tent.numberOfPoints() == 5 && countCells(tent, FileTriangle) == 4);
  TAUTLINE_CHECK(countCells(tent, FileLine) == 4 && value(tent.cellArrays, "Reference", 7) == 4.0);
  TAUTLINE_CHECK(value(tent.pointArrays, "Reference", 2) == 2.0);

  const MeshFile house = readOff(data + "/house.off", false);
  TAUTLINE_CHECK(house.numberOfPoints() == 10 && house.numberOfCells() == 7);
  TAUTLINE_CHECK(countCells(house, FilePolygon) == 2 && countCells(house, FileQuadrilateral) == 5);
  TAUTLINE_CHECK(value(house.pointArrays, "Color", 4 * 5 + 3) == 128.0);
  TAUTLINE_CHECK(value(house.cellArrays, "Color", 1) == 20.0);
  TAUTLINE_CHECK(value(house.cellArrays, "Color", 3) == 170.0); // a face without colour
  writeText(output + "/normals.off",
    "\xef\xbb\xbfNOFF\r\n3 1\r\n0 0 0 0 0 1\r\n1 0 0 0 0 1\r\n0 1 0 0 0 1\r\n3 0 1 2 0.5 1.0 "
    "0\r\n");
  // A face over several lines.
  writeText(output + "/lines.off",
    "OFF\n5 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n-1 0.5 0\n5 0 1 2\n 3\n 4 255 0 0\n3 0 3 4\n");
  const MeshFile lines = readOff(output + "/lines.off", false);
  TAUTLINE_CHECK(countCells(lines, FilePolygon) == 1 && countCells(lines, FileTriangle) == 1);
  TAUTLINE_CHECK(lines.connectivity == std::vector<Index>({ 0, 1, 2, 3, 4, 0, 3, 4 }));
  TAUTLINE_CHECK(value(lines.cellArrays, "Color", 0) == 255.0);

  const MeshFile normals = readOff(output + "/normals.off", false);
  TAUTLINE_CHECK(value(normals.pointArrays, "Normals", 8) == 1.0);
  TAUTLINE_CHECK(value(normals.cellArrays, "Color", 0) == 0.5);

  // Colours with and without an opacity, and none: opaque and grey.
  writeText(output + "/colors.off",
    "OFF\n3 3 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 10 20 30 40\n3 0 1 2 1 2 3\n3 0 1 2\n");
  const MeshFile colors = readOff(output + "/colors.off", false);
  const double expected[] = { 10, 20, 30, 40, 1, 2, 3, 255, 170, 170, 170, 255 };
  TAUTLINE_EACH(std::size_t, i, std::size(expected),
    TAUTLINE_CHECK_EQUAL(value(colors.cellArrays, "Color", i), expected[i]));
  writeText(
    output + "/fractions.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 0.25 0.5 1.0\n3 0 1 2\n");
  const MeshFile fractions = readOff(output + "/fractions.off", false);
  TAUTLINE_CHECK_NEAR(value(fractions.cellArrays, "Color", 0), 0.25, 1e-6);
  TAUTLINE_CHECK_NEAR(value(fractions.cellArrays, "Color", 3), 170.0 / 255, 1e-6);
}

/// In VTK's own view, middle nodes are in the middle of edges: the node orders are right.
void testOrderOfMiddleNodes(vtkMeshFileReader* reader, const char* name, int points)
{
  TAUTLINE_SET(reader, SetFileName((data + name).c_str()), SetLowerCells(true), Update());
  auto* grid = outputOf<vtkUnstructuredGrid>(reader);
  TAUTLINE_CHECK(grid && grid->GetNumberOfPoints() == points);
  int middles = 0;
  for (vtkIdType i = 0; grid && i < grid->GetNumberOfCells(); ++i)
  {
    vtkCell* cell = grid->GetCell(i);
    for (int e = 0; e < cell->GetNumberOfEdges() && !cell->IsLinear(); ++e)
    {
      double p[3][3];
      for (int k = 0; k < 3; ++k)
      {
        cell->GetEdge(e)->GetPoints()->GetPoint(k, p[k]);
      }
      TAUTLINE_EACH(
        int, c, 3, TAUTLINE_CHECK(std::abs(0.5 * (p[0][c] + p[1][c]) - p[2][c]) < 1e-9));
      ++middles;
    }
  }
  TAUTLINE_CHECK(middles > 12);
}

/// The classes of VTK: outputs, errors with empty outputs, recovery, CanReadFile.
TAUTLINE_PART(testReaderClasses)
{
  vtkNew<vtkTetGenReader> reader;
  vtkNew<vtkTest::ErrorObserver> errors;
  TAUTLINE_SET(reader, AddObserver(vtkCommand::ErrorEvent, errors),
    SetFileName((data + "/cube.1.ele").c_str()), Update());
  TAUTLINE_CHECK(reader->GetOutput()->GetNumberOfCells() == 171 && !errors->GetError());
  TAUTLINE_CHECK(reader->GetOutput()->GetCellData()->GetArray("Reference") != nullptr);
  TAUTLINE_SET(reader, SetFileName((data + "/none.ele").c_str()), Update());
  TAUTLINE_CHECK(reader->GetOutput()->GetNumberOfPoints() == 0);
  TAUTLINE_CHECK(reader->GetOutput()->GetNumberOfCells() == 0);
  TAUTLINE_CHECK(contains(errors->GetErrorMessage(), wording("none-node-cannot-be-opened")));
  TAUTLINE_SET(reader, SetFileName((data + "/cube.1.ele").c_str()), Update());
  TAUTLINE_CHECK(reader->GetOutput()->GetNumberOfCells() == 171);

  TAUTLINE_NEW(vtkOffReader, off, SetFileName((data + "/house.off").c_str()), Update());
  TAUTLINE_CHECK(off->GetOutput()->IsA("vtkPolyData") && off->GetOutput()->GetNumberOfCells() == 7);
  vtkNew<vtkGmshReader> gmsh;
  vtkNew<vtkMeditReader> medit;
  TAUTLINE_CHECK(gmsh->CanReadFile((data + "/part.msh").c_str()) == 1);
  TAUTLINE_CHECK(gmsh->CanReadFile((data + "/tent.msh").c_str()) == 1);
  TAUTLINE_CHECK(gmsh->CanReadFile((data + "/zoo.mesh").c_str()) == 0);
  TAUTLINE_CHECK(medit->CanReadFile((data + "/zoo.mesh").c_str()) == 1);
  TAUTLINE_CHECK(medit->CanReadFile((data + "/none.mesh").c_str()) == 0);
}
}

TAUTLINE_TEST(TestReaders)
{
  data = argv[1];
  output = argv[2];
  vtkNew<vtkGmshReader> gmsh;
  TAUTLINE_RUN(testOrderOfMiddleNodes(gmsh, "/wedges.msh", 27));
  vtkNew<vtkTetGenReader> tetgen;
  TAUTLINE_RUN(testOrderOfMiddleNodes(tetgen, "/quadratic.1.ele", 27));
}
