// SPDX-License-Identifier: BSD-3-Clause
// Read-write-read is the identity, arrays and their types included, directly and through VTK.

#include "MeshFileAdapter.h"
#include "MeshFileChecks.h"
#include "Registry.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkFloatArray.h"
#include "vtkGmshWriter.h"
#include "vtkImageData.h"
#include "vtkMeditWriter.h"
#include "vtkNew.h"
#include "vtkOffWriter.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkTestErrorObserver.h"
#include "vtkTetGenWriter.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <iterator>

using namespace tautline;

namespace
{
std::string data;
std::string output;

std::vector<std::string> writeByName(
  const MeshFile& mesh, const std::string& name, bool binary = false)
{
  const std::string extension = splitExtension(name).second;
  return extension == "mesh" ? writeMedit(mesh, name)
    : extension == "msh"     ? writeGmsh(mesh, name, binary)
    : extension == "off"     ? writeOff(mesh, name)
                             : writeTetGen(mesh, name);
}

MeshFile throughVtk(const MeshFile& mesh, bool surface)
{
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPolyData> polygons;
  toGrid(mesh, grid);
  toSurface(surface ? mesh : MeshFile(), polygons);
  return fromDataSet(surface ? static_cast<vtkDataSet*>(polygons) : grid);
}

/// The file, what is written of it, and what is read of that are the same mesh.
void checkIdentity(const std::string& name, const std::string& copy, bool binary = false)
{
  for (const bool lowerCells : { false, true })
  {
    const MeshFile first = readByName(data + "/" + name, lowerCells);
    const std::string target = output + "/copy-" + copy;
    writeByName(throughVtk(first, splitExtension(name).second == "off"), target, binary);
    const MeshFile second = readByName(target, lowerCells);
    if (!same(first, second))
    {
      std::cerr << name << " is not " << target << "\n";
      TAUTLINE_CHECK(!"identity");
    }
  }
}

/// A mesh of another format keeps points, cells and the arrays both formats can hold.
TAUTLINE_PART(checkConversion)
{
  const MeshFile cube = readByName(data + "/cube.1.ele", true);
  writeByName(cube, output + "/cube.mesh");
  const MeshFile medit = readByName(output + "/cube.mesh", true);
  TAUTLINE_CHECK(same(cube.points, medit.points) && cube.connectivity == medit.connectivity);
  const MeshArray* reference = findArray(medit.cellArrays, "Reference");
  TAUTLINE_CHECK(reference && reference->at(0) == 1.0 && reference->at(171) == 4.0);
  writeByName(medit, output + "/cube.msh");
  const MeshFile gmsh = readByName(output + "/cube.msh", true);
  TAUTLINE_CHECK(same(cube.points, gmsh.points) && cube.connectivity == gmsh.connectivity);
  TAUTLINE_CHECK(findArray(gmsh.cellArrays, "Reference")->values == reference->values);
}

/// Arrays of every kind, with unusual names and values, are kept where a format has room for them.
TAUTLINE_PART(checkArrays)
{
  MeshFile mesh = readByName(data + "/cube.1.ele", false);
  const auto points = static_cast<std::size_t>(mesh.numberOfPoints());
  const auto cells = static_cast<std::size_t>(mesh.numberOfCells());
  TAUTLINE_SET(mesh, points[0] = 0.1 + 0.2, points[1] = 4.9406564584124654e-324,
    points[2] = -1.7976931348623157e308);
  mesh.pointArrays.push_back(MeshArray::make("heat flux, %", 3, 'f', 3 * points));
  std::get<MeshArray::Doubles>(mesh.pointArrays.back().values)[4] = 1.0 / 3.0;
  std::get<MeshArray::Doubles>(mesh.pointArrays.back().values)[5] = std::nan("");
  std::get<MeshArray::Doubles>(mesh.pointArrays.back().values)[6] = -INFINITY;
  mesh.pointArrays.push_back(MeshArray::make("pair", 2, 'f', 2 * points));
  mesh.cellArrays.push_back(MeshArray::make("tensor", 9, 'f', 9 * cells));
  std::get<MeshArray::Doubles>(mesh.cellArrays.back().values)[1] = 7.25; // not symmetric
  for (const char* name : { "/arrays.node", "/arrays.mesh", "/arrays.msh" })
  {
    writeByName(mesh, output + name);
    const MeshFile again = readByName(output + name, false);
    TAUTLINE_CHECK(contains(again.pointArrays, mesh.pointArrays));
    TAUTLINE_CHECK(same(mesh.points, again.points));
    const MeshArray* tensor = findArray(again.cellArrays, "tensor");
    TAUTLINE_CHECK(tensor && tensor->components == 9 && tensor->at(1) == 7.25);
  }
  // whole numbers and bytes keep their types in the formats that store types
  mesh.pointArrays.push_back(MeshArray::make("count", 1, 'i', points));
  mesh.cellArrays.push_back(MeshArray::make("flag", 1, 'u', cells));
  std::get<MeshArray::Bytes>(mesh.cellArrays.back().values)[3] = 255;
  for (const char* name : { "/arrays.node", "/arrays.mesh" })
  {
    writeByName(mesh, output + name);
    const MeshFile again = readByName(output + name, false);
    TAUTLINE_CHECK(findArray(again.pointArrays, "count")->code() == 'i');
    TAUTLINE_CHECK(findArray(again.cellArrays, "flag")->code() == 'u');
    TAUTLINE_CHECK(findArray(again.cellArrays, "flag")->at(3) == 255.0);
  }
}

/// Rewriting a smaller mesh leaves no companion of the larger one behind.
TAUTLINE_PART(checkStaleCompanions)
{
  const std::string stem = output + "/stale";
  writeByName(readByName(data + "/cube.1.ele", true), stem + ".node");
  TAUTLINE_CHECK(fileExists(stem + ".face") && fileExists(stem + ".edge"));
  writeByName(readByName(data + "/cube.1.ele", false), stem + ".node");
  TAUTLINE_CHECK(!fileExists(stem + ".face") && !fileExists(stem + ".edge"));
  TAUTLINE_CHECK(readByName(stem + ".ele", true).numberOfCells() == 171);
  writeByName(readByName(data + "/zoo.mesh", true), stem + ".mesh");
  TAUTLINE_CHECK(fileExists(stem + ".sol"));
  writeByName(readByName(data + "/cube.1.ele", true), stem + ".mesh");
  TAUTLINE_CHECK(!fileExists(stem + ".sol"));
}

/// Views of .pos: values at corners and of cells, wedges in Gmsh's order, components, no NaN.
TAUTLINE_PART(checkViews)
{
  MeshFile mesh;
  mesh.points = { 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 2, 1, 0, 2, 0, 1, 2, 0.5, 0, 0, 0.5, 0.5, 0, 0,
    0.5, 0 };
  mesh.addCells(FileWedge, { 0, 1, 2, 3, 4, 5 });
  mesh.addCells(FileTriangle6, { 0, 1, 2, 6, 7, 8 });
  MeshArray& heat =
    mesh.pointArrays.emplace_back(MeshArray::make("a \"heat\"", 1, 'f', mesh.points.size() / 3));
  std::get<MeshArray::Doubles>(heat.values) = { 0, 1, 2, 3, 4, 5, 6, 7, 8 };
  MeshArray& pair = mesh.cellArrays.emplace_back(MeshArray::make("pair", 2, 'f', 4));
  std::get<MeshArray::Doubles>(pair.values) = { std::nan(""), 1.5, 2.5, -3 };
  const std::string name = output + "/views.pos";
  std::vector<std::string> warnings;
  writeGmshViews(mesh, name, &warnings);
  TAUTLINE_CHECK(warnings ==
    std::vector<std::string>{
      "view \"pair_0\": 1 of 2 elements are left out, because Gmsh cannot read "
      "values that are not finite (the first is cell 0)" });
  std::ifstream file(name);
  const std::string text{ std::istreambuf_iterator<char>(file), {} };
  const std::string wedge = "SI(0,0,0,0,1,0,1,0,0,0,0,2,0,1,2,1,0,2)";
  const std::string triangle = "ST(0,0,0,1,0,0,0,1,0)";
  TAUTLINE_CHECK(text ==
    "View \"a 'heat'\" {\n" + wedge + "{0,2,1,3,5,4};\n" + triangle + "{0,1,2};\n};\n" +
      "View \"pair_0\" {\n" + triangle + "{2.5,2.5,2.5};\n};\n" + "View \"pair_1\" {\n" + wedge +
      "{1.5,1.5,1.5,1.5,1.5,1.5};\n" + triangle + "{-3,-3,-3};\n};\n");
  mesh.pointArrays.clear();
  mesh.cellArrays.clear();
  TAUTLINE_CHECK_THROWS(writeGmshViews(mesh, name), "no");
}

/// Writers take any data set, reject by name, and report when a file cannot be written.
TAUTLINE_PART(checkWriterClasses)
{
  TAUTLINE_NEW(vtkImageData, image, SetDimensions(3, 3, 2));
  TAUTLINE_NEW(vtkFloatArray, heat, SetName("heat"), SetNumberOfTuples(18), Fill(0.1f));
  image->GetPointData()->AddArray(heat);
  TAUTLINE_NEW(vtkUnsignedCharArray, ghosts, SetName(vtkDataSetAttributes::GhostArrayName()),
    SetNumberOfTuples(4), Fill(0), SetValue(2, vtkDataSetAttributes::DUPLICATECELL));
  image->GetCellData()->AddArray(ghosts);

  TAUTLINE_NEW(vtkGmshWriter, gmsh, SetInputData(image),
    SetFileName((output + "/image.msh").c_str()), BinaryOn());
  TAUTLINE_CHECK(gmsh->Write() == 1 && gmsh->GetNumberOfFilesWritten() == 1);
  const MeshFile read = readByName(output + "/image.msh", false);
  TAUTLINE_CHECK(countCells(read, FileHexahedron) == 3); // one of four is a ghost
  TAUTLINE_CHECK(findArray(read.pointArrays, "heat")->at(5) == static_cast<double>(0.1f));
  const Index first[] = { 0, 1, 4, 3, 9, 10, 13, 12 };
  TAUTLINE_EACH(std::size_t, i, 8, TAUTLINE_CHECK(read.connectivity[i] == first[i]));

  TAUTLINE_SET(gmsh, SetFileName((output + "/image.pos").c_str()), BinaryOff());
  TAUTLINE_CHECK(gmsh->Write() == 1 && fileExists(output + "/image.pos"));

  const auto rejection = [&](vtkMeshFileWriter* writer, const std::string& name)
  {
    vtkNew<vtkTest::ErrorObserver> errors;
    TAUTLINE_SET(writer, AddObserver(vtkCommand::ErrorEvent, errors), SetInputData(image),
      SetFileName(name.c_str()));
    TAUTLINE_CHECK(writer->Write() == 0 && errors->GetError());
    return std::string(writer->GetErrorText());
  };
  vtkNew<vtkTetGenWriter> tetgen;
  TAUTLINE_CHECK(contains(rejection(tetgen, output + "/image.node"), "3 hexahedra"));
  TAUTLINE_CHECK(!fileExists(output + "/image.node"));
  vtkNew<vtkOffWriter> off;
  TAUTLINE_CHECK(contains(rejection(off, output + "/image.off"), "hexahedra"));
  vtkNew<vtkMeditWriter> medit;
  TAUTLINE_CHECK(
    contains(rejection(medit, output + "/none/image.mesh"), wording("cannot-be-written")));
  TAUTLINE_CHECK(contains(rejection(medit, output + "/image.txt"), wording("mesh-is-expected")));
}
}

TAUTLINE_TEST(TestReadWriteRead)
{
  data = argv[1];
  output = argv[2];
  TAUTLINE_RUN(checkIdentity("cube.1.node", "cube.node"));
  TAUTLINE_RUN(checkIdentity("quadratic.1.ele", "quadratic.ele"));
  TAUTLINE_RUN(checkIdentity("cube.smesh", "cube.smesh"));
  TAUTLINE_RUN(checkIdentity("box.poly", "box.poly"));
  TAUTLINE_RUN(checkIdentity("plate.poly", "plate.poly"));
  TAUTLINE_RUN(checkIdentity("zoo.mesh", "zoo.mesh"));
  TAUTLINE_RUN(checkIdentity("part.msh", "part.msh"));
  TAUTLINE_RUN(checkIdentity("part22-binary.msh", "part-binary.msh", true));
  TAUTLINE_RUN(checkIdentity("wedges.msh", "wedges.msh"));
  TAUTLINE_RUN(checkIdentity("tent.msh", "tent.mesh"));
  TAUTLINE_RUN(checkIdentity("house.off", "house.off"));
}
