// SPDX-License-Identifier: BSD-3-Clause
// The contents of the sample files arrive, with the documented array names.

#include "MeshFileChecks.h"
#include "Registry.h"
#include "tautline/Elements/JacobianCertifier.h"
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
#include <set>

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

  // In 4.0, points of $Entities also have a box; the tag of an entity comes before its dimension.
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

/// The position of a place of the reference cell in a straight element, by its own corners.
Vec3 straightPosition(const ElementType& type, const MeshFile& mesh, const Index* nodes, Vec3 at)
{
  const auto corner = [&](int i)
  {
    return Vec3{ mesh.points[static_cast<std::size_t>(3 * nodes[i])],
      mesh.points[static_cast<std::size_t>(3 * nodes[i] + 1)],
      mesh.points[static_cast<std::size_t>(3 * nodes[i] + 2)] };
  };
  if (type.shape() == ElementShape::Pyramid) // of the collapsed cube
  {
    at = { at[0] * (1 - at[2]), at[1] * (1 - at[2]), at[2] };
  }
  const bool quadrilateral = type.shape() == ElementShape::Quadrilateral ||
    type.shape() == ElementShape::Hexahedron || type.shape() == ElementShape::Pyramid;
  const int second = quadrilateral ? 3 : 2;
  const int third =
    type.shape() == ElementShape::Tetrahedron || type.shape() == ElementShape::Wedge ? 3 : 4;
  Vec3 x = corner(0) + at[0] * (corner(1) - corner(0)) + at[1] * (corner(second) - corner(0));
  return type.dimension() == 2 ? x : x + at[2] * (corner(third) - corner(0));
}

/// Elements of orders 1 to 4: each node is where VTK has it in a straight element.
TAUTLINE_PART(testOrders)
{
  const MeshFile mesh = readGmsh(data + "/orders.msh", true);
  TAUTLINE_CHECK(mesh.numberOfCells() == 29 && mesh.warnings.empty());
  const std::pair<unsigned char, Index> kinds[] = { { FileLagrangeLine, 4 },
    { FileLagrangeLine, 5 }, { FileLagrangeTriangle, 10 }, { FileLagrangeTriangle, 15 },
    { FileQuadrilateral8, 8 }, { FileLagrangeQuadrilateral, 16 }, { FileLagrangeQuadrilateral, 25 },
    { FileLagrangeTetrahedron, 20 }, { FileLagrangeTetrahedron, 35 }, { FileHexahedron20, 20 },
    { FileLagrangeHexahedron, 64 }, { FileLagrangeHexahedron, 125 }, { FileWedge15, 15 },
    { FileLagrangeWedge, 40 }, { FileLagrangeWedge, 75 }, { FilePyramid13, 13 } };
  std::set<std::pair<unsigned char, Index>> found;
  for (std::size_t cell = 0; cell < mesh.cellTypes.size(); ++cell)
  {
    const Index* nodes = mesh.connectivity.data() + mesh.offsets[cell];
    const Index size = mesh.offsets[cell + 1] - mesh.offsets[cell];
    found.insert({ mesh.cellTypes[cell], size });
    if (cellDimension(mesh.cellTypes[cell]) < 2)
    {
      for (Index i = 0; i < size; ++i) // inner nodes of a line of length 1 come in order
      {
        const double x = mesh.points[static_cast<std::size_t>(3 * nodes[i])];
        const double start = mesh.points[static_cast<std::size_t>(3 * nodes[0])];
        const double share = i == 0 ? 0 : i == 1 ? 1 : (i - 1.0) / (static_cast<double>(size) - 1);
        TAUTLINE_CHECK(std::abs(x - start - share) < 1e-12);
      }
      continue;
    }
    const ElementType& type = ElementType::ofVtk(mesh.cellTypes[cell], static_cast<int>(size));
    for (Index i = 0; i < size; ++i)
    {
      const double* x = &mesh.points[static_cast<std::size_t>(3 * nodes[i])];
      const Vec3 expected =
        straightPosition(type, mesh, nodes, type.coordinates()[static_cast<std::size_t>(i)]);
      const Vec3 offset = Vec3{ x[0], x[1], x[2] } - expected;
      TAUTLINE_CHECK(dot(offset, offset) < 1e-24);
    }
    // Lagrange wedges have the sign of Gmsh's elements, VTK's other wedges the opposite one.
    const bool reversed =
      type.shape() == ElementShape::Wedge && mesh.cellTypes[cell] < FileLagrangeLine;
    const Index* const one[] = { nodes };
    if (type.dimension() == 3)
    {
      const ElementOrientation sign = orientationOf(type, mesh.points.data(), one, 1);
      TAUTLINE_CHECK((reversed ? sign.negative : sign.positive) == 1);
    }
  }
  TAUTLINE_EACH_OF(const auto& kind, kinds, TAUTLINE_CHECK(found.count(kind) == 1));
  for (const bool binary : { false, true })
  {
    const std::string copy = output + "/orders-copy.msh";
    writeGmsh(mesh, copy, binary);
    TAUTLINE_CHECK(same(readGmsh(copy, true), mesh));
  }
}

/// Elements without a VTK cell are rejected by name, with the remedy; a node left out is a warning.
TAUTLINE_PART(testRejectedElements)
{
  const std::string file = output + "/rejected.msh";
  const auto text = [](int code, int nodes)
  {
    std::ostringstream lines;
    lines << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" << nodes << "\n";
    for (int n = 1; n <= nodes; ++n)
    {
      lines << n << ' ' << n % 3 << ' ' << n % 5 << ' ' << n % 7 << '\n';
    }
    lines << "$EndNodes\n$Elements\n1\n1 " << code << " 2 1 1";
    for (int n = 1; n <= nodes; ++n)
    {
      lines << ' ' << n;
    }
    lines << "\n$EndElements\n";
    return lines.str();
  };
  const std::pair<int, int> rejected[] = { { 20, 9 }, { 39, 12 }, { 137, 16 }, { 99, 32 } };
  for (const auto& [code, nodes] : rejected)
  {
    writeText(file, text(code, nodes));
    TAUTLINE_CHECK(contains(complaint(file), wording("gmsh-set-second-order-incomplete")));
  }
  writeText(file, text(118, 30));
  TAUTLINE_CHECK(contains(complaint(file), wording("gmsh-order-2")));
  writeText(file, text(31, 56)); // tetrahedra of fifth order
  TAUTLINE_CHECK(contains(complaint(file), wording("gmsh-order-4")));
  writeText(file, text(14, 14));
  const MeshFile pyramid = readGmsh(file, true);
  TAUTLINE_CHECK(pyramid.cellTypes[0] == FilePyramid13 && pyramid.warnings.size() == 1);
  vtkNew<vtkGmshReader> reader;
  vtkNew<vtkTest::ErrorObserver> observer;
  TAUTLINE_SET(
    reader, AddObserver(vtkCommand::WarningEvent, observer), SetFileName(file.c_str()), Update());
  TAUTLINE_CHECK(observer->GetWarning());
  // Orders that differ by axis have no element in Gmsh.
  MeshFile plate;
  plate.points = { 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0.5, 0, 1, 0.5, 0 };
  const Index nodes[] = { 0, 1, 2, 3, 5, 4 };
  plate.addCell(FileLagrangeQuadrilateral, nodes, 6);
  TAUTLINE_CHECK_THROWS(writeGmsh(plate, file, false), wording("gmsh-orders-1-to-4"));
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
  TAUTLINE_CHECK(value(house.cellArrays, "Color", 3) == 170.0); // a face without color
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

  // Colors with and without an opacity, and none: opaque and gray.
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
