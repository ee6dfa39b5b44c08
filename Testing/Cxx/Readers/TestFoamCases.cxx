// SPDX-License-Identifier: BSD-3-Clause
// Cases of OpenFOAM: whole, decomposed and in pieces, as data sets of VTK, and their points written
// back.

#include "FoamCase.h"
#include "Readers/FoamSamples.h"
#include "Registry.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkFieldData.h"
#include "vtkFoamMeshReader.h"
#include "vtkFoamPointsWriter.h"
#include "vtkIdTypeArray.h"
#include "vtkImageData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkObject.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkSmartPointer.h"
#include "vtkStringArray.h"
#include "vtkUnstructuredGrid.h"

#include <set>

using namespace tautline;

namespace
{
std::string output;

std::string folder()
{
  return output + "/foam-case";
}

std::string meshFolder()
{
  return folder() + "/constant/polyMesh";
}

void begin()
{
  std::filesystem::remove_all(folder());
  std::filesystem::create_directories(folder());
  writeText(folder() + "/case.foam", "");
}

void makeWhole(const FoamForm& form = FoamForm())
{
  begin();
  writeFoam(meshFolder(), twoCubes(), form);
}

std::string processorFolder(int part)
{
  return folder() + "/processor" + std::to_string(part) + "/constant/polyMesh";
}

void makeDecomposed(bool addressed)
{
  begin();
  for (const int part : { 0, 1 })
  {
    writeFoam(processorFolder(part), addressed ? addressedHalf(part) : halfOfTwoCubes(part));
  }
}

using Grid = vtkSmartPointer<vtkUnstructuredGrid>;

/// The output of a reader, and its error.
struct Reading
{
  Grid grid;
  std::string error;
};

Reading read(vtkFoamMeshReader* reader, int piece = 0, int pieces = 1)
{
  reader->UpdateInformation();
  reader->UpdatePiece(piece, pieces, 0);
  Reading result;
  result.grid = vtkUnstructuredGrid::SafeDownCast(reader->GetOutput());
  result.error = reader->GetErrorText();
  return result;
}

Reading read(const std::string& name, int piece = 0, int pieces = 1)
{
  vtkNew<vtkFoamMeshReader> reader;
  reader->SetFileName(name.c_str());
  return read(reader, piece, pieces);
}

template <class ArrayT>
std::vector<Index> values(vtkDataArray* array)
{
  auto* typed = ArrayT::SafeDownCast(array);
  TAUTLINE_CHECK(typed != nullptr);
  std::vector<Index> result;
  for (vtkIdType i = 0; typed && i < typed->GetNumberOfValues(); ++i)
  {
    result.push_back(typed->GetValue(i));
  }
  return result;
}

std::vector<std::string> strings(vtkDataObject* data, const char* name)
{
  auto* array = vtkStringArray::SafeDownCast(data->GetFieldData()->GetAbstractArray(name));
  std::vector<std::string> result;
  for (vtkIdType i = 0; array && i < array->GetNumberOfValues(); ++i)
  {
    result.push_back(array->GetValue(i));
  }
  return result;
}

std::vector<Index> cellPoints(vtkUnstructuredGrid* grid, vtkIdType cell)
{
  vtkNew<vtkIdList> ids;
  grid->GetCellPoints(cell, ids);
  return std::vector<Index>(ids->begin(), ids->end());
}

std::vector<double> coordinates(vtkDataSet* grid)
{
  std::vector<double> points(static_cast<std::size_t>(3 * grid->GetNumberOfPoints()));
  TAUTLINE_EACH(vtkIdType, i, grid->GetNumberOfPoints(), grid->GetPoint(i, points.data() + 3 * i));
  return points;
}

/// Points, cells and arrays of two meshes are the same.
void checkSame(vtkUnstructuredGrid* a, vtkUnstructuredGrid* b)
{
  TAUTLINE_CHECK(same(coordinates(a), coordinates(b)));
  TAUTLINE_CHECK_EQUAL(a->GetNumberOfCells(), b->GetNumberOfCells());
  TAUTLINE_EACH(vtkIdType, cell, a->GetNumberOfCells(),
                TAUTLINE_CHECK_EQUAL(a->GetCellType(cell), b->GetCellType(cell));
                TAUTLINE_CHECK(cellPoints(a, cell) == cellPoints(b, cell)));
  const auto array = [](vtkUnstructuredGrid* of, const char* name)
  { return of->GetCellData()->GetArray(name); };
  TAUTLINE_CHECK(values<vtkIntArray>(array(a, "Patch")) == values<vtkIntArray>(array(b, "Patch")));
  TAUTLINE_CHECK(
    values<vtkIdTypeArray>(array(a, "Face")) == values<vtkIdTypeArray>(array(b, "Face")));
  for (const char* name : { "PatchNames", "PatchTypes" })
  {
    TAUTLINE_CHECK(strings(a, name) == strings(b, name));
  }
}

TAUTLINE_PART(testOutput)
{
  makeWhole();
  const Grid grid = read(folder() + "/case.foam").grid;
  TAUTLINE_CHECK_EQUAL(grid->GetNumberOfPoints(), 12);
  TAUTLINE_CHECK_EQUAL(grid->GetNumberOfCells(), 12);
  TAUTLINE_CHECK_EQUAL(grid->GetCellType(1), int(FileHexahedron));
  TAUTLINE_CHECK_EQUAL(grid->GetCellType(2), int(FileQuadrilateral));
  TAUTLINE_CHECK(cellPoints(grid, 2) == CubeBottom);
  TAUTLINE_CHECK_EQUAL(grid->GetPoints()->GetDataType(), VTK_DOUBLE);
  using Ids = std::vector<Index>;
  vtkCellData* cells = grid->GetCellData();
  TAUTLINE_CHECK(
    (values<vtkIntArray>(cells->GetArray("Patch")) == Ids{ -1, -1, 0, 1, 2, 2, 2, 2, 2, 2, 2, 2 }));
  TAUTLINE_CHECK((values<vtkIdTypeArray>(cells->GetArray("Face")) ==
    Ids{ -1, -1, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10 }));
  TAUTLINE_CHECK(cells->GetArray("CellZone") == nullptr && cells->GetGlobalIds() == nullptr);
  vtkFieldData* fields = grid->GetFieldData();
  TAUTLINE_CHECK(
    (strings(grid, "PatchNames") == std::vector<std::string>{ "low", "high", "sides" }));
  TAUTLINE_CHECK(
    (strings(grid, "PatchTypes") == std::vector<std::string>{ "cyclic", "cyclic", "wall" }));
  TAUTLINE_CHECK((values<vtkIntArray>(fields->GetArray("NeighbourPatch")) == Ids{ 1, 0, -1 }));
  TAUTLINE_CHECK((values<vtkIdTypeArray>(fields->GetArray("FacesOutOfOrder")) == Ids{ 0 }));
  TAUTLINE_CHECK(strings(grid, "FoamCase") == std::vector<std::string>{ meshFolder() });
  TAUTLINE_CHECK(fields->GetArray("ProcessorNumbers") == nullptr);

  vtkNew<vtkFoamMeshReader> reader;
  reader->SetFileName((folder() + "/case.foam").c_str());
  reader->PatchFacesOff();
  const Grid volume = read(reader).grid;
  TAUTLINE_CHECK_EQUAL(volume->GetNumberOfCells(), 2);
  TAUTLINE_CHECK((values<vtkIntArray>(volume->GetCellData()->GetArray("Patch")) == Ids{ -1, -1 }));
}

TAUTLINE_PART(testZoneArrays)
{
  begin();
  FoamSample sample = twoCubes();
  const FoamFormatter format{ FoamForm() };
  sample.others["cellZones"] = format.header("regIOobject") +
    "( a { cellLabels List<label> 1(1); } b { cellLabels List<label> 2(0 1); } )";
  sample.others["faceZones"] =
    format.header("regIOobject") + "( f { faceLabels List<label> 2(3 0); } )";
  writeFoam(meshFolder(), sample);
  const Grid grid = read(folder()).grid;
  const auto zones = values<vtkIntArray>(grid->GetCellData()->GetArray("CellZone"));
  TAUTLINE_CHECK_EQUAL(zones.size(), 12u);
  TAUTLINE_CHECK(zones[0] == 1 && zones[1] == 0 && zones[2] == -1);
  TAUTLINE_CHECK((strings(grid, "CellZoneNames") == std::vector<std::string>{ "a", "b" }));
  TAUTLINE_CHECK(strings(grid, "FaceZoneNames") == std::vector<std::string>{ "f" });
  TAUTLINE_CHECK((values<vtkIdTypeArray>(grid->GetFieldData()->GetArray("FaceZone f")) ==
    std::vector<Index>{ 3, 0 }));
}

TAUTLINE_PART(testNames)
{
  makeWhole();
  std::filesystem::create_directories(folder() + "/system");
  writeText(folder() + "/system/controlDict", "");
  writeText(folder() + "/case.OpenFOAM", "");
  vtkNew<vtkFoamMeshReader> reader;
  for (const std::string name :
    { "", "/", "/case.foam", "/case.OpenFOAM", "/system/controlDict", "/constant/polyMesh" })
  {
    TAUTLINE_CHECK_EQUAL(read(folder() + name).error, "");
  }
  for (const std::string name : { "/case.foam", "/case.OpenFOAM", "/system/controlDict" })
  {
    TAUTLINE_CHECK_EQUAL(reader->CanReadFile((folder() + name).c_str()), 1);
  }
  // a link to the mesh of another case
  std::filesystem::rename(meshFolder(), output + "/foam-files-linked");
  std::filesystem::create_directory_symlink(output + "/foam-files-linked", meshFolder());
  TAUTLINE_CHECK_EQUAL(read(folder()).error, "");
  std::filesystem::remove(meshFolder());
  std::filesystem::remove_all(output + "/foam-files-linked");
  TAUTLINE_CHECK(contains(read(folder()).error, wording("foam-there-is-no-mesh")));
  TAUTLINE_CHECK_EQUAL(reader->CanReadFile((folder() + "/case.foam").c_str()), 0);
  TAUTLINE_CHECK(contains(read(folder() + "/no.foam").error, wording("foam-no-such-file")));
  // a region
  writeFoam(folder() + "/constant/air/polyMesh", twoCubes());
  reader->SetFileName((folder() + "/case.foam").c_str());
  reader->SetRegionName("air");
  TAUTLINE_CHECK_EQUAL(read(reader).error, "");
  reader->SetRegionName("water");
  TAUTLINE_CHECK(contains(read(reader).error, "water"));
  std::filesystem::create_directories(folder() + "/processors2");
  TAUTLINE_CHECK(contains(read(folder()).error, wording("foam-collated")));
}

TAUTLINE_PART(testDecomposed)
{
  makeWhole();
  const Grid whole = read(folder()).grid;
  for (const bool addressed : { true, false })
  {
    const Context context(addressed ? "addressed" : "joined");
    makeDecomposed(addressed);
    const Reading reading = read(folder());
    TAUTLINE_CHECK_EQUAL(reading.error, "");
    checkSame(reading.grid, whole);
    TAUTLINE_CHECK((strings(reading.grid, "FoamCase") ==
      std::vector<std::string>{ processorFolder(0), processorFolder(1) }));
  }
  // both are there: the whole one is read unless the other is asked for
  writeFoam(meshFolder(), oneCell(towerPoints(0, 1), FoamRows{ CubeBottom, CubeTop } + CubeSides));
  vtkNew<vtkFoamMeshReader> reader;
  reader->SetFileName(folder().c_str());
  TAUTLINE_CHECK_EQUAL(read(reader).grid->GetNumberOfPoints(), 8);
  reader->SetCaseType(vtkFoamMeshReader::DECOMPOSED);
  TAUTLINE_CHECK_EQUAL(read(reader).grid->GetNumberOfPoints(), 12);
  reader->SetCaseType(vtkFoamMeshReader::RECONSTRUCTED);
  TAUTLINE_CHECK_EQUAL(read(reader).grid->GetNumberOfPoints(), 8);
}

TAUTLINE_PART(testUnusableAddresses)
{
  makeWhole();
  const Grid whole = read(folder()).grid;
  const FoamFormatter format{ FoamForm() };
  using Labels = std::vector<Index>;
  const std::vector<std::pair<std::string, Labels>> changes = {
    { "pointProcAddressing", { 0, 1, 2, 3, 4, 5, 6 } },
    { "pointProcAddressing", { 0, 1, 2, 3, 4, 5, 6, 700000 } },
    { "pointProcAddressing", { 0, 1, 2, 3, 4, 5, 6, -7 } },
    { "cellProcAddressing", { 1 } },
    { "faceProcAddressing", { 0, 4, 5, 6, 7, 1 } },
    { "faceProcAddressing", { 2, 4, 5, 6, 6, 1 } },
    { "boundaryProcAddressing", { 0, 1, 5, -1 } },
  };
  for (const auto& [name, labels] : changes)
  {
    makeDecomposed(true);
    writeText(processorFolder(0) + "/" + name, format.header("labelList") + format.labels(labels));
    FoamRequest request;
    request.name = folder();
    const FoamPiece piece = readFoamCase(request);
    TAUTLINE_CHECK_EQUAL(piece.warnings.size(), 1u);
    TAUTLINE_CHECK(same(piece.mesh.points, coordinates(whole)));
  }
}

TAUTLINE_PART(testSeamErrors)
{
  const auto rejected = [](const char* file, const char* from, const char* to, const char* problem)
  {
    makeDecomposed(false);
    const std::string name = processorFolder(1) + "/" + file;
    std::string text = readText(name);
    const std::size_t place = text.rfind(from);
    TAUTLINE_CHECK(place != text.npos);
    writeText(name, text.replace(place, std::string(from).size(), to));
    TAUTLINE_CHECK(contains(read(folder()).error, problem));
  };
  rejected("boundary", "neighbProcNo 0", "neighbProcNo 7", wording("foam-needs-a-processor-patch"));
  rejected("boundary", "myProcNo 1", "myProcNo 0", wording("foam-this-is-processor"));
  rejected("points", "(0 0 1)", "(0 0 1.01)", wording("foam-have-other-points"));
  rejected("faces", "0\n2\n3\n1", "2\n3\n1\n0", wording("foam-have-other-points"));
  makeDecomposed(false);
  std::filesystem::remove_all(folder() + "/processor0");
  TAUTLINE_CHECK(contains(read(folder()).error, wording("foam-later-processors")));
}

/// The global ids of some pieces, which must be disjoint.
std::set<vtkIdType> allIds(const std::vector<Reading>& pieces)
{
  std::set<vtkIdType> ids;
  for (const Reading& piece : pieces)
  {
    TAUTLINE_CHECK_EQUAL(piece.error, "");
    for (const Index id : values<vtkIdTypeArray>(piece.grid->GetCellData()->GetGlobalIds()))
    {
      TAUTLINE_CHECK(ids.insert(id).second);
    }
  }
  return ids;
}

TAUTLINE_PART(testPieces)
{
  makeWhole();
  const Grid whole = read(folder()).grid;
  // 2 cells, 10 faces of patches with numbers from 2 + 1 on, and both sides of face 0
  std::set<vtkIdType> expected = { 0, 1, 2, 2 + 11 };
  TAUTLINE_EACH(vtkIdType, face, 10, expected.insert(2 + 1 + face));
  for (const int kind : { 0, 1, 2 }) // divided, by addresses, by seams
  {
    const Context context("kind " + std::to_string(kind));
    if (kind > 0)
    {
      makeDecomposed(kind == 1);
    }
    std::vector<Reading> pieces = { read(folder(), 0, 2), read(folder(), 1, 2) };
    TAUTLINE_CHECK(allIds(pieces) == expected);
    for (int i = 0; i < 2; ++i)
    {
      const Grid& grid = pieces[static_cast<std::size_t>(i)].grid;
      TAUTLINE_CHECK_EQUAL(grid->GetNumberOfPoints(), 8);
      TAUTLINE_CHECK_EQUAL(grid->GetNumberOfCells(), 1 + 6);
      const std::vector<std::string> types = strings(grid, "PatchTypes");
      TAUTLINE_CHECK(types.size() == 4 && types.back() == "processor");
      const auto numbers = values<vtkIntArray>(grid->GetFieldData()->GetArray("ProcessorNumbers"));
      TAUTLINE_CHECK((numbers == std::vector<Index>{ -1, -1, -1, -1, -1, -1, i, 1 - i }));
      const auto ids = values<vtkIdTypeArray>(grid->GetPointData()->GetGlobalIds());
      for (std::size_t point = 0; point < ids.size(); ++point)
      {
        double a[3], b[3];
        grid->GetPoint(static_cast<vtkIdType>(point), a);
        whole->GetPoint(ids[point], b);
        TAUTLINE_CHECK(std::equal(a, a + 3, b));
      }
    }
    // the two sides of the seam are reversed, and begin at the same point
    const auto seam = [&](int i)
    {
      const Grid& grid = pieces[static_cast<std::size_t>(i)].grid;
      std::vector<Index> points = cellPoints(grid, 6);
      const auto ids = values<vtkIdTypeArray>(grid->GetPointData()->GetGlobalIds());
      std::for_each(points.begin(), points.end(),
        [&](Index& point) { point = ids[static_cast<std::size_t>(point)]; });
      return points;
    };
    std::vector<Index> other = seam(1);
    std::reverse(other.begin() + 1, other.end());
    TAUTLINE_CHECK(seam(0) == other);
    // a piece without a processor is empty
    TAUTLINE_CHECK(kind == 0 || read(folder(), 2, 3).grid->GetNumberOfCells() == 0);
    TAUTLINE_CHECK_EQUAL(read(folder(), 2, 3).error, "");
    // several processors of one piece follow each other
    TAUTLINE_CHECK(kind == 0 || read(folder(), 0, 1).grid->GetNumberOfCells() == 12);
  }
}

TAUTLINE_PART(testDividedTower)
{
  // a tower of cubes in three pieces: cells, points and faces of the whole
  constexpr int height = 7;
  FoamSample tower{ towerPoints(0, height), {}, {}, {}, "", {} };
  const auto moved = [](std::vector<Index> face, Index level)
  {
    std::for_each(face.begin(), face.end(), [level](Index& point) { point += 4 * level; });
    return face;
  };
  for (Index level = 0; level + 1 < height; ++level)
  {
    tower.faces.push_back(moved(CubeTop, level));
    tower.owner.push_back(level);
    tower.neighbor.push_back(level + 1);
  }
  for (Index level = 0; level < height; ++level)
  {
    for (const std::vector<Index>& side : CubeSides)
    {
      tower.faces.push_back(moved(side, level));
      tower.owner.push_back(level);
    }
  }
  tower.faces.push_back(CubeBottom);
  tower.owner.push_back(0);
  tower.faces.push_back(moved(CubeTop, height - 1));
  tower.owner.push_back(height - 1);
  tower.boundary = "1(all { type wall; nFaces 30; startFace 6; })";
  begin();
  writeFoam(meshFolder(), tower);
  std::vector<Reading> pieces;
  TAUTLINE_EACH(int, i, 3, pieces.push_back(read(folder(), i, 3)));
  TAUTLINE_CHECK_EQUAL(allIds(pieces).size(), std::size_t(height + 30 + 2 * 2));
}

/// Writes a mesh into a case and returns the error.
std::string write(vtkDataObject* mesh, const std::string& name, vtkFoamPointsWriter* writer)
{
  writer->SetInputDataObject(mesh);
  writer->SetFileName(name.empty() ? nullptr : name.c_str());
  const int written = writer->Write();
  const std::string error = writer->GetErrorText();
  TAUTLINE_CHECK_EQUAL(written, int(error.empty()));
  return error;
}

std::string write(vtkDataObject* mesh, const std::string& name)
{
  vtkNew<vtkFoamPointsWriter> writer;
  return write(mesh, name, writer);
}

TAUTLINE_PART(testWriter)
{
  for (const bool compressed : { false, true })
  {
    makeWhole(FoamForm{ false, false, compressed, false, 4, 8 });
    const std::string points = meshFolder() + (compressed ? "/points.gz" : "/points");
    const std::string original = readText(points);
    const Grid grid = read(folder()).grid;
    std::map<std::string, std::string> others;
    for (const auto& entry : std::filesystem::directory_iterator(meshFolder()))
    {
      others[entry.path().string()] = readText(entry.path().string());
    }
    others.erase(points);
    vtkNew<vtkFoamPointsWriter> writer;
    writer->KeepOriginalOn();
    grid->GetPoints()->SetPoint(5, 1.0, 0.0, 1.0625);
    TAUTLINE_CHECK_EQUAL(write(grid, "", writer), "");
    TAUTLINE_CHECK_EQUAL(writer->GetNumberOfFilesWritten(), 1);
    TAUTLINE_CHECK_EQUAL(std::string(writer->GetFileWritten(0)), points);
    TAUTLINE_CHECK_EQUAL(writer->GetRounding(), 0.0);
    TAUTLINE_CHECK(same(coordinates(read(folder()).grid), coordinates(grid)));
    for (const auto& [name, content] : others)
    {
      TAUTLINE_CHECK(readText(name) == content);
    }
    TAUTLINE_CHECK(
      readText(meshFolder() + (compressed ? "/points.orig.gz" : "/points.orig")) == original);
  }
}

TAUTLINE_PART(testWriterTargets)
{
  makeWhole();
  const Grid grid = read(folder()).grid;
  grid->GetPoints()->SetPoint(5, 1.0, 0.0, 1.0625);
  // a copy of the case, named by a file that does not exist yet
  const std::string copy = output + "/foam-copy";
  std::filesystem::remove_all(copy);
  std::filesystem::copy(folder(), copy, std::filesystem::copy_options::recursive);
  const std::string before = readText(meshFolder() + "/points");
  TAUTLINE_CHECK_EQUAL(write(grid, copy + "/new.foam"), "");
  TAUTLINE_CHECK(std::filesystem::exists(copy + "/new.foam"));
  TAUTLINE_CHECK(readText(meshFolder() + "/points") == before);
  TAUTLINE_CHECK(same(coordinates(read(copy).grid), coordinates(grid)));
  // without the field array, by the name alone
  const Grid bare = Grid::New();
  bare->CopyStructure(grid);
  bare->GetFieldData()->Initialize();
  TAUTLINE_CHECK(contains(write(bare, ""), wording("foam-no-file-name")));
  TAUTLINE_CHECK_EQUAL(write(bare, folder() + "/case.foam"), "");
  TAUTLINE_CHECK(same(coordinates(read(folder()).grid), coordinates(grid)));
  // decomposed: the points of both processors
  makeDecomposed(true);
  const Grid both = read(folder()).grid;
  both->GetPoints()->SetPoint(5, 1.0, 0.0, 1.25);
  vtkNew<vtkFoamPointsWriter> writer;
  TAUTLINE_CHECK_EQUAL(write(both, folder() + "/case.foam", writer), "");
  TAUTLINE_CHECK_EQUAL(writer->GetNumberOfFilesWritten(), 2);
  TAUTLINE_CHECK(same(coordinates(read(folder()).grid), coordinates(both)));
}

TAUTLINE_PART(testSinglePrecision)
{
  // points of single precision that have not moved keep all their digits
  begin();
  FoamSample sample = twoCubes();
  sample.points[6] = 0.1;
  writeFoam(meshFolder(), sample);
  const std::string before = readText(meshFolder() + "/points");
  const Grid grid = read(folder()).grid;
  vtkNew<vtkPoints> single;
  single->SetDataTypeToFloat();
  single->DeepCopy(grid->GetPoints());
  grid->SetPoints(single);
  TAUTLINE_CHECK_EQUAL(grid->GetPoints()->GetDataType(), VTK_FLOAT);
  TAUTLINE_CHECK_EQUAL(write(grid, ""), "");
  TAUTLINE_CHECK(readText(meshFolder() + "/points") == before);
}

TAUTLINE_PART(testWriterErrors)
{
  makeWhole();
  const std::string before = readText(meshFolder() + "/points");
  const Grid grid = read(folder()).grid;
  const auto changed = [&](const auto& change)
  {
    const Grid copy = Grid::New();
    copy->DeepCopy(grid);
    change(copy.Get());
    return write(copy, folder() + "/case.foam");
  };
  const double nan = std::nan("");
  TAUTLINE_CHECK(contains(changed([&](auto* mesh) { mesh->GetPoints()->SetPoint(3, 0, nan, 0); }),
    wording("foam-not-finite")));
  TAUTLINE_CHECK(contains(changed([](auto* mesh) { mesh->GetPoints()->InsertNextPoint(0, 0, 0); }),
    wording("foam-mesh-has-13-points")));
  TAUTLINE_CHECK(contains(changed(
                            [](auto* mesh)
                            {
                              const vtkIdType other[] = { 0, 1, 3, 2, 8, 9, 11, 10 };
                              mesh->GetCells()->ReplaceCellAtId(1, 8, other);
                            }),
    wording("foam-cell-1-has-other-points")));
  TAUTLINE_CHECK(contains(changed(
                            [](auto* mesh)
                            {
                              mesh->Allocate(1);
                              const vtkIdType ids[] = { 0, 1, 3, 2, 4, 5, 7, 6 };
                              mesh->InsertNextCell(int(FileHexahedron), 8, ids);
                              mesh->GetCellData()->Initialize();
                            }),
    wording("foam-has-1-cells")));
  vtkNew<vtkImageData> image;
  image->SetDimensions(3, 2, 2);
  TAUTLINE_CHECK(contains(write(image, folder()), wording("foam-mesh-has-12-points-of-image")));
  TAUTLINE_CHECK(contains(write(grid, output + "/nowhere/case.foam"), "nowhere"));
  // the points of a time step would hold instead
  std::filesystem::create_directories(folder() + "/0.5/polyMesh");
  writeText(folder() + "/0.5/polyMesh/points", before);
  TAUTLINE_CHECK(contains(write(grid, ""), wording("foam-the-mesh-moves")));
  FoamRequest request;
  request.name = folder();
  TAUTLINE_CHECK_EQUAL(readFoamCase(request).warnings.size(), 1u);
  TAUTLINE_CHECK(readText(meshFolder() + "/points") == before);
}
}

TAUTLINE_TEST(TestFoamCases)
{
  output = argv[2];
  vtkObject::GlobalWarningDisplayOff();
}
