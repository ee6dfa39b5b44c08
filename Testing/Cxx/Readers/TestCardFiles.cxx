// SPDX-License-Identifier: BSD-3-Clause
// Abaqus and Nastran: small files with known places, volumes, orders of nodes and errors.

#include "AbaqusFile.h"
#include "MeshFileChecks.h"
#include "NastranFile.h"
#include "Registry.h"

#include "tautline/Mesh/Mesh.h"

#include "vtkAbaqusReader.h"
#include "vtkCell.h"
#include "vtkNastranReader.h"
#include "vtkNew.h"
#include "vtkPointSet.h"

#include <algorithm>
#include <array>
#include <cmath>

using namespace tautline;

namespace
{
std::string output;

using Read = MeshFile (*)(const std::string&, bool);

MeshFile readText(Read read, const std::string& text, bool lowerCells = true)
{
  const std::string name = output + (read == readAbaqus ? "/cards.inp" : "/cards.bdf");
  writeText(name, text);
  return read(name, lowerCells);
}

/// Whether reading fails in that line with a message that contains the text.
bool fails(Read read, const std::string& text, int line, const std::string& expected)
{
  try
  {
    readText(read, text);
  }
  catch (const FileError& error)
  {
    const std::string message = error.what();
    const bool right = message.find(":" + std::to_string(line) + ": ") != message.npos &&
      message.find(expected) != message.npos;
    if (!right)
    {
      std::cerr << message << "\n";
    }
    return right;
  }
  std::cerr << "no error: " << expected << "\n";
  return false;
}

Vec3 point(const MeshFile& mesh, Index id)
{
  const auto i = static_cast<std::size_t>(3 * id);
  return { mesh.points[i], mesh.points[i + 1], mesh.points[i + 2] };
}

bool near(const Vec3& a, const Vec3& b)
{
  return norm(a - b) < 1e-12;
}

/// The values of an array of 0 and 1 as a text.
std::string flags(const std::vector<MeshArray>& arrays, const char* name)
{
  const MeshArray* array = findArray(arrays, name);
  std::string result;
  for (std::size_t i = 0; array && i < array->size(); ++i)
  {
    result += array->at(i) == 0.0 ? '0' : '1';
  }
  return result;
}

// --- Abaqus -----------------------------------------------------------------------------------

const char* const Square = "*Node\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n"
                           "*Element, type=CPS4R, elset=All\n1, 1, 2, 3, 4\n";

void testInstances()
{
  const std::string text = std::string("** a comment\n*Heading\n 1, 2, 3\n*Part, name=A\n") +
    Square +
    "*Nset, nset=Low\n1, 2\n*End Part\n*PART, NAME=\"b 2\"\n*NODE\n1, 0, 0, 0\n7, 3, 0, 0\n9, 3, "
    "3, 0\n"
    "12, 0, 3, 0\n*ELEMENT, TYPE=CPS4\n5, 1, 7, 9, 12\n*END PART\n*Assembly, name=Assembly\n"
    "*Instance, name=A-1, part=A\n*End Instance\n*Instance, name=A-2, part=a\n10., 0., 0.\n"
    "*End Instance\n*Instance, name=B-1, part=\"b 2\"\n 1., 2., 3.\n0., 0., 0., 0., 0., 1., 90.\n"
    "*End Instance\n*Node\n1, 5., 5., 5.\n*Nset, nset=Corner, instance=A-2\n 3,\n"
    "*Elset, elset=Second, instance=A-2, generate\n1, 1, 1\n*Nset, nset=_Picked, internal\n 1,\n"
    "*End Assembly\n*Step\n*Static\n1, 1\n*End Step\n";
  const MeshFile mesh = readText(readAbaqus, text);
  TAUTLINE_CHECK(mesh.numberOfPoints() == 13 && mesh.numberOfCells() == 3);
  TAUTLINE_CHECK(near(point(mesh, 2), { 1, 1, 0 }) && near(point(mesh, 6), { 11, 1, 0 }));
  // translated by 1 2 3, then turned by 90 degrees about the z axis
  TAUTLINE_CHECK(near(point(mesh, 8), { -2, 1, 3 }) && near(point(mesh, 10), { -5, 4, 3 }));
  TAUTLINE_CHECK(near(point(mesh, 12), { 5, 5, 5 }));
  TAUTLINE_CHECK(flags(mesh.cellArrays, "All") == "110");
  TAUTLINE_CHECK(flags(mesh.pointArrays, "Low") == "1100110000000");
  TAUTLINE_CHECK(flags(mesh.pointArrays, "Corner") == "0000001000000");
  TAUTLINE_CHECK(flags(mesh.cellArrays, "Second") == "010");
  TAUTLINE_CHECK(!findArray(mesh.pointArrays, "_Picked"));
  const MeshArray* instance = findArray(mesh.cellArrays, "Instance");
  TAUTLINE_CHECK(instance && instance->at(0) == 0.0 && instance->at(2) == 2.0);
  TAUTLINE_CHECK(mesh.fieldStrings.size() == 1 && mesh.fieldStrings[0].values[2] == "B-1");
}

void testRotationAboutAnAxis()
{
  const std::string text = std::string("*Part, name=A\n") + Square +
    "*End Part\n*Assembly\n*Instance, name=A-1, part=A\n0., 0., 0.\n1., 0., 0., 1., 0., 2., 180.\n"
    "*End Instance\n*End Assembly\n";
  const MeshFile mesh = readText(readAbaqus, text);
  TAUTLINE_CHECK(near(point(mesh, 0), { 2, 0, 0 }) && near(point(mesh, 2), { 1, -1, 0 }));
}

void testAbaqusSets()
{
  const std::string text = std::string(Square) +
    "*element, type = S3,\nelset=Tri\n2, 1,\n2, 3\n*ELEMENT, TYPE=MASS, ELSET=M\n9, 1\n"
    "*ELSET, ELSET=Both\nall, Tri\n*NSET, NSET=Odd, GENERATE\n1, 4, 2\n*NSET,NSET=More\nOdd, "
    "2,\n4\n"
    "*ELEMENT, TYPE=B31\n3, 1, 2\n*BOUNDARY\nOdd, 1, 3\n";
  const MeshFile mesh = readText(readAbaqus, text);
  TAUTLINE_CHECK(mesh.numberOfCells() == 3 && countCells(mesh, FileLine) == 1);
  TAUTLINE_CHECK(flags(mesh.cellArrays, "Both") == "110" && flags(mesh.cellArrays, "Tri") == "010");
  TAUTLINE_CHECK(flags(mesh.pointArrays, "Odd") == "1010");
  TAUTLINE_CHECK(flags(mesh.pointArrays, "More") == "1111");
  TAUTLINE_CHECK(mesh.warnings.size() == 1 && mesh.warnings[0].find("MASS") != std::string::npos);
  TAUTLINE_CHECK(readText(readAbaqus, text, false).numberOfCells() == 2);
}

void testAbaqusFiles()
{
  writeText(output + "/part.nodes", "1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n");
  writeText(output + "/part.inc", "*ELEMENT, TYPE=CPE4\n1, 1, 2, 3, 4\n");
  const MeshFile mesh =
    readText(readAbaqus, "*NODE, INPUT=part.nodes\n*INCLUDE, INPUT=part.inc\n*MATERIAL, NAME=X\n");
  TAUTLINE_CHECK(mesh.numberOfPoints() == 4 && mesh.numberOfCells() == 1);
  TAUTLINE_CHECK(fails(readAbaqus, "*NODE\n1, 0., 0.\n*INCLUDE, INPUT=cards.inp\n", 3, "included"));
  vtkNew<vtkAbaqusReader> reader;
  writeText(output + "/ucd.inp", "4 1 0 0 0\n");
  TAUTLINE_CHECK(reader->CanReadFile((output + "/cards.inp").c_str()) == 1);
  TAUTLINE_CHECK(reader->CanReadFile((output + "/ucd.inp").c_str()) == 0);
  writeText(output + "/square.inp", Square);
  reader->SetFileName((output + "/square.inp").c_str());
  reader->Update();
  TAUTLINE_CHECK(reader->GetOutput()->GetNumberOfCells() == 1);
}

void testAbaqusErrors()
{
  const std::string square = Square; // of 7 lines
  TAUTLINE_CHECK(fails(readAbaqus, square + "*NGEN\n1, 2\n", 8, "*NGEN"));
  TAUTLINE_CHECK(fails(readAbaqus, square + "*ELEMENT, TYPE=U1\n1, 2\n", 8, "'U1'"));
  TAUTLINE_CHECK(fails(readAbaqus, square + "*ELEMENT, TYPE=S3\n2, 1, 2\n", 9, "3 nodes"));
  TAUTLINE_CHECK(fails(readAbaqus, square + "*ELEMENT, TYPE=S3\n2, 1, 2, 9\n", 9, "node 9"));
  TAUTLINE_CHECK(fails(readAbaqus, square + "*ELEMENT, TYPE=S3\n1, 1, 2, 3\n", 9, "element 1"));
  TAUTLINE_CHECK(fails(readAbaqus, square + "*NODE\n4, 0., 1.5\n", 9, "node 4"));
  TAUTLINE_CHECK(fails(readAbaqus, square + "*NODE\n5, 0., x\n", 9, "'x'"));
  TAUTLINE_CHECK(fails(readAbaqus, square + "*NODE\n5, 0., nan\n", 9, "'nan'"));
  TAUTLINE_CHECK(fails(readAbaqus, square + "*NODE, SYSTEM=C\n5, 1., 90.\n", 8, "cylindrical"));
  TAUTLINE_CHECK(fails(readAbaqus, square + "*PART, NAME=A\n*NODE\n1, 0.\n", 10, "a part"));
  TAUTLINE_CHECK(fails(readAbaqus, "*INSTANCE, NAME=A-1, PART=A\n", 1, "part 'A'"));
  TAUTLINE_CHECK(fails(readAbaqus, square + "*NSET, NSET=A, GENERATE\n1, 9, 0\n", 9, "by 0"));
  TAUTLINE_CHECK(fails(readAbaqus, "4 1 0 0 0\n", 1, "keyword"));
}

void testElementTable()
{
  const std::pair<const char*, unsigned char> known[] = { { "C3D8R", FileHexahedron },
    { "C3D8RH", FileHexahedron }, { "C3D10M", FileTetrahedron10 }, { "C3D4", FileTetrahedron },
    { "C3D6", FileWedge }, { "C3D15", FileWedge15 }, { "C3D20RT", FileHexahedron20 },
    { "C3D27", FileHexahedron27 }, { "SC8R", FileHexahedron }, { "SC6R", FileWedge },
    { "COH3D8", FileHexahedron }, { "DC3D20", FileHexahedron20 }, { "AC3D10", FileTetrahedron10 },
    { "CPS3", FileTriangle }, { "CPS4R", FileQuadrilateral }, { "CPS8R", FileQuadrilateral8 },
    { "CPE6M", FileTriangle6 }, { "CPEG4", FileQuadrilateral }, { "CAX4RT", FileQuadrilateral },
    { "S3", FileTriangle }, { "S3R", FileTriangle }, { "S4R5", FileQuadrilateral },
    { "S8R5", FileQuadrilateral8 }, { "S9R5", FileQuadrilateral9 }, { "STRI3", FileTriangle },
    { "STRI65", FileTriangle6 }, { "M3D4R", FileQuadrilateral }, { "R3D3", FileTriangle },
    { "SFM3D8R", FileQuadrilateral8 }, { "DC2D4", FileQuadrilateral }, { "T3D2", FileLine },
    { "T2D3", FileLine3 }, { "B31", FileLine }, { "B31OS", FileLine }, { "B32H", FileLine3 },
    { "B33", FileLine }, { "PIPE22", FileLine3 }, { "SAX1", FileLine }, { "SAX2", FileLine3 },
    { "RAX2", FileLine } };
  for (const auto& [name, type] : known)
  {
    const AbaqusElement element = abaqusElement(name);
    TAUTLINE_CHECK(element.kind == AbaqusElement::Cell && element.type == type);
  }
  for (const char* name : { "MASS", "SPRINGA", "CONN3D2", "DASHPOT1", "ROTARYI", "GAPUNI" })
  {
    TAUTLINE_CHECK(abaqusElement(name).kind == AbaqusElement::NoCell);
  }
  for (const char* name : { "", "U1", "C3D", "C3D9", "8", "CPS5", "XYZ4", "B41", "C3D88" })
  {
    TAUTLINE_CHECK(abaqusElement(name).kind == AbaqusElement::Unknown);
  }
}

// --- elements of second order -----------------------------------------------------------------

using Groups = std::vector<std::vector<int>>; ///< corners whose mean a further node is

struct Shape
{
  const char* abaqus;
  const char* nastran;
  std::vector<Vec3> corners;
  Groups inAbaqus, inNastran;
};

const std::vector<Vec3> Cube = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 },
  { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 } };
const std::vector<Vec3> Prism = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 },
  { 0, 1, 1 } };
const std::vector<Vec3> Corner = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
const std::vector<Vec3> Pyramid = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 },
  { .5, .5, 1 } };
const Groups Bottom4 = { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 } };
const Groups Top4 = { { 4, 5 }, { 5, 6 }, { 6, 7 }, { 7, 4 } };
const Groups Upright4 = { { 0, 4 }, { 1, 5 }, { 2, 6 }, { 3, 7 } };
const Groups Bottom3 = { { 0, 1 }, { 1, 2 }, { 2, 0 } };
const Groups Top3 = { { 3, 4 }, { 4, 5 }, { 5, 3 } };
const Groups Upright3 = { { 0, 3 }, { 1, 4 }, { 2, 5 } };
// the center, then the faces 1 2 3 4, 5 8 7 6, 1 5 6 2, 2 6 7 3, 3 7 8 4, 4 8 5 1
const Groups Faces = { { 0, 1, 2, 3, 4, 5, 6, 7 }, { 0, 1, 2, 3 }, { 4, 7, 6, 5 }, { 0, 4, 5, 1 },
  { 1, 5, 6, 2 }, { 2, 6, 7, 3 }, { 3, 7, 4, 0 } };

Groups joined(std::initializer_list<Groups> parts)
{
  Groups all;
  for (const Groups& part : parts)
  {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

std::vector<Vec3> nodes(const Shape& shape, const Groups& groups)
{
  std::vector<Vec3> all = shape.corners;
  for (const std::vector<int>& group : groups)
  {
    Vec3 sum{ 0, 0, 0 };
    for (const int corner : group)
    {
      sum = sum + shape.corners[static_cast<std::size_t>(corner)];
    }
    all.push_back((1.0 / static_cast<double>(group.size())) * sum);
  }
  return all;
}

std::string text(double value)
{
  char buffer[32];
  std::snprintf(buffer, sizeof(buffer), "%.6f", value);
  return std::string(buffer).substr(0, 8);
}

/// In VTK's own view, nodes are in the middle of edges and faces, and of the cell.
void checkOrder(vtkMeshFileReader* reader, const std::string& name, std::size_t count)
{
  reader->SetFileName(name.c_str());
  reader->Update();
  vtkPointSet* grid = reader->GetOutput();
  const bool read =
    grid->GetNumberOfCells() == 1 && grid->GetNumberOfPoints() == static_cast<vtkIdType>(count);
  TAUTLINE_CHECK(read);
  if (!read)
  {
    std::cerr << name << ": " << reader->GetErrorText() << "\n";
    return;
  }
  vtkCell* cell = grid->GetCell(0);
  for (int e = 0; e < cell->GetNumberOfEdges(); ++e)
  {
    double p[3][3];
    for (int k = 0; k < 3; ++k)
    {
      cell->GetEdge(e)->GetPoints()->GetPoint(k, p[k]);
    }
    for (int c = 0; c < 3; ++c)
    {
      TAUTLINE_CHECK(std::abs(0.5 * (p[0][c] + p[1][c]) - p[2][c]) < 1e-6);
    }
  }
  constexpr vtkIdType withCenter = 27;
  if (cell->GetNumberOfPoints() == withCenter)
  {
    for (int c = 0; c < 3; ++c)
    {
      TAUTLINE_CHECK(std::abs(cell->GetPoints()->GetPoint(withCenter - 1)[c] - 0.5) < 1e-6);
    }
  }
  for (int f = 0; f < cell->GetNumberOfFaces(); ++f)
  {
    vtkCell* face = cell->GetFace(f);
    if (face->GetNumberOfPoints() == 9) // its center
    {
      for (int c = 0; c < 3; ++c)
      {
        double mean = 0.0;
        for (int k = 0; k < 4; ++k)
        {
          mean += 0.25 * face->GetPoints()->GetPoint(k)[c];
        }
        TAUTLINE_CHECK(std::abs(mean - face->GetPoints()->GetPoint(8)[c]) < 1e-6);
      }
    }
  }
}

void testOrders()
{
  const Groups pyramid = joined({ Bottom4, { { 0, 4 }, { 1, 4 }, { 2, 4 }, { 3, 4 } } });
  const Groups tetrahedron = joined({ Bottom3, { { 0, 3 }, { 1, 3 }, { 2, 3 } } });
  const Shape shapes[] = {
    { "C3D20", "CHEXA", Cube, joined({ Bottom4, Top4, Upright4 }),
      joined({ Bottom4, Upright4, Top4 }) },
    { "C3D27", nullptr, Cube, joined({ Bottom4, Top4, Upright4, Faces }), {} },
    { "C3D15", "CPENTA", Prism, joined({ Bottom3, Top3, Upright3 }),
      joined({ Bottom3, Upright3, Top3 }) },
    { "C3D10", "CTETRA", Corner, tetrahedron, tetrahedron },
    { nullptr, "CPYRAM", Pyramid, {}, pyramid },
  };
  vtkNew<vtkAbaqusReader> abaqus;
  vtkNew<vtkNastranReader> nastran;
  for (const Shape& shape : shapes)
  {
    if (shape.abaqus)
    {
      const std::vector<Vec3> all = nodes(shape, shape.inAbaqus);
      std::string file = "*NODE\n", element = "1";
      for (std::size_t i = 0; i < all.size(); ++i)
      {
        file += std::to_string(i + 1) + ", " + text(all[i][0]) + ", " + text(all[i][1]) + ", " +
          text(all[i][2]) + "\n";
        element += (i % 15 == 14 ? ",\n" : ", ") + std::to_string(i + 1);
      }
      const std::string name = output + "/" + shape.abaqus + ".inp";
      writeText(name, file + "*ELEMENT, TYPE=" + shape.abaqus + "\n" + element + "\n");
      checkOrder(abaqus, name, all.size());
    }
    if (shape.nastran)
    {
      const std::vector<Vec3> all = nodes(shape, shape.inNastran);
      std::string file = "BEGIN BULK\n", element = std::string(shape.nastran) + ",1,1";
      for (std::size_t i = 0; i < all.size(); ++i)
      {
        file += "GRID," + std::to_string(i + 1) + ",," + text(all[i][0]) + "," + text(all[i][1]) +
          "," + text(all[i][2]) + "\n";
        element += (i % 8 == 6 ? "\n," : ",") + std::to_string(i + 1);
      }
      const std::string name = output + "/" + shape.nastran + ".bdf";
      writeText(name, file + element + "\nENDDATA\n");
      checkOrder(nastran, name, all.size());
    }
  }
}

/// Linear wedges and hexahedra are not inverted.
void testOrientation()
{
  const std::string corners = "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n5,1,0,1\n6,0,1,1\n";
  const MeshFile abaqus = readText(readAbaqus, corners + "*ELEMENT,TYPE=C3D6\n1,1,2,3,4,5,6\n");
  const MeshFile nastran = readText(readNastran,
    "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\nGRID,4,,0.,0.,1.\nGRID,5,,1.,0.,1.\n"
    "GRID,6,,0.,1.,1.\nCPENTA,1,7,1,2,3,4,5,6\n");
  const std::vector<Index> order = { 0, 2, 1, 3, 5, 4 }; // as of Gmsh's and Medit's wedges
  TAUTLINE_CHECK(abaqus.connectivity == order && nastran.connectivity == order);
}

// --- Nastran ----------------------------------------------------------------------------------

void testFields()
{
  const std::string text =
    "ID A,B\nSOL 101\nCEND\nTITLE = GRID, 1\nBEGIN BULK\n$ a comment\n"
    "GRID    1               0.0     0.      .0              123456\n"
    "GRID           2              1.      +0      -0.\n" // blanks before
    "GRID*                  3                           1.D+0           10.-1\n"
    "*                    0.0               0\n"
    "GRID,4,,,1.\n"
    "grid*,5,,0.,0.,+M5\n*M5,.1+1\n"
    "GRID\t6\t\t1.\t0.\t1.\n"
    "GRID,7,0,1.,1.,1.$ a comment\nGRID,8,,0.,1.,1.,,,,\n"
    "CHEXA   1       3       1       2       3       4       5       6\n"
    "        7       8\n"
    "CTETRA  2       4       1       2       4       5                       +E1\n+E1\n"
    "CTETRA* 3                              4               1               2\n"
    "*                      4               5\n"
    "CQUAD4, 4, 5, 1, 2, 3, 4, 0.5, 0.1\nCELAS2,9,1.,1,1\nCBUSHX,1\nCXYZ,1\n"
    "MAT1    1       2.1+5           0.3\nENDDATA\nGRID,1,,9.,9.,9.\n";
  const MeshFile mesh = readText(readNastran, text);
  TAUTLINE_CHECK(mesh.numberOfPoints() == 8 && mesh.numberOfCells() == 4);
  for (std::size_t i = 0; i < 8; ++i)
  {
    TAUTLINE_CHECK(near(point(mesh, static_cast<Index>(i)), Cube[i]));
  }
  const std::vector<unsigned char> types = { FileHexahedron, FileTetrahedron, FileTetrahedron,
    FileQuadrilateral };
  TAUTLINE_CHECK(mesh.cellTypes == types);
  const MeshArray* reference = findArray(mesh.cellArrays, "Reference");
  TAUTLINE_CHECK(reference && reference->at(0) == 3.0 && reference->at(3) == 5.0);
  TAUTLINE_CHECK(mesh.warnings.size() == 1 && mesh.warnings[0].find("CXYZ") != std::string::npos);
  TAUTLINE_CHECK(readText(readNastran, text, false).numberOfCells() == 3);
}

void testSystems()
{
  // 1: origin 1 0 0, z along y, x along z; 2: cylinder about z at 0 0 5 in the system 0; 3: sphere;
  // 4: as 1, in the system 1
  const std::string text = "GRDSET,,1\nGRID,1,,1.,2.,3.\nGRID,2,0,1.,2.,3.\nGRID,3,2,2.,90.,1.\n"
                           "GRID,4,3,2.,90.,90.\nGRID,5,4,0.,0.,1.\n"
                           "CORD2R,1,,1.,0.,0.,1.,1.,0.\n,1.,0.,1.\n"
                           "CORD2C,2,0,0.,0.,5.,0.,0.,6.\n,1.,0.,5.\n"
                           "CORD2S,3,0,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\n"
                           "CORD2R,4,1,0.,0.,1.,0.,0.,2.\n,1.,0.,1.\nCTRIA3,1,1,1,2,3\n";
  const MeshFile mesh = readText(readNastran, text);
  // the axes of system 1: x is z, y is x, z is y
  TAUTLINE_CHECK(near(point(mesh, 0), { 1 + 2, 3, 1 }) && near(point(mesh, 1), { 1, 2, 3 }));
  TAUTLINE_CHECK(near(point(mesh, 2), { 0, 2, 6 }) && near(point(mesh, 3), { 0, 2, 0 }));
  TAUTLINE_CHECK(near(point(mesh, 4), { 1, 2, 0 }));
}

void testNastranErrors()
{
  const std::string grids = "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\n"
                            "GRID,4,,.5,.0,.0\n";
  TAUTLINE_CHECK(fails(readNastran, grids + "CTRIA3,1,1,1,2\n", 5, "CTRIA3"));
  TAUTLINE_CHECK(fails(readNastran, grids + "CTRIA3,1,1,1,2,9\n", 5, "node 9"));
  TAUTLINE_CHECK(fails(readNastran, grids + "CTRIA6,1,1,1,2,3,4\n", 5, "1 of its 3 midside"));
  TAUTLINE_CHECK(fails(readNastran, grids + "CTRIA3,1,1,1,2,3\nCTRIA3,1,1,1,2,3\n", 6, "twice"));
  TAUTLINE_CHECK(fails(readNastran, grids + "GRID,4,,0.,1.,1.\n", 5, "node 4"));
  TAUTLINE_CHECK(fails(readNastran, grids + "GRID,5,,0.,x,1.\n", 5, "'x'"));
  TAUTLINE_CHECK(fails(readNastran, grids + "GRID,5,7,0.,1.,1.\n", 5, "7 is not given"));
  TAUTLINE_CHECK(fails(readNastran, grids + "INCLUDE 'cards\n", 5, "quotes"));
  TAUTLINE_CHECK(fails(readNastran,
    grids + "GRID,5,1,,,\nCORD2R,1,2,,,,,,1.\n,1.\nCORD2R,2,1,,,,,,1.\n,1.\n", 6, "circle"));
  TAUTLINE_CHECK(fails(readNastran, grids + "GRID,5,1,,,\nCORD2R,1\n", 6, "on a line"));
  TAUTLINE_CHECK(fails(readNastran, "$ nothing\n", 1, "no GRID"));
  writeText(output + "/mesh.inc", grids);
  const MeshFile mesh =
    readText(readNastran, "BEGIN BULK\nINCLUDE 'mesh.inc'\nCTRIA6,1,1,1,2,3\nENDDATA\n");
  TAUTLINE_CHECK(mesh.numberOfPoints() == 4 && countCells(mesh, FileTriangle) == 1);
  vtkNew<vtkNastranReader> reader;
  TAUTLINE_CHECK(reader->CanReadFile((output + "/cards.bdf").c_str()) == 1);
  TAUTLINE_CHECK(reader->CanReadFile((output + "/none.bdf").c_str()) == 0);
}
}

TAUTLINE_TEST(TestCardFiles)
{
  output = argv[2];
  TAUTLINE_RUN(testInstances());
  TAUTLINE_RUN(testRotationAboutAnAxis());
  TAUTLINE_RUN(testAbaqusSets());
  TAUTLINE_RUN(testAbaqusFiles());
  TAUTLINE_RUN(testAbaqusErrors());
  TAUTLINE_RUN(testElementTable());
  TAUTLINE_RUN(testOrders());
  TAUTLINE_RUN(testOrientation());
  TAUTLINE_RUN(testFields());
  TAUTLINE_RUN(testSystems());
  TAUTLINE_RUN(testNastranErrors());
}
