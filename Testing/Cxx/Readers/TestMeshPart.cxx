// SPDX-License-Identifier: BSD-3-Clause
// The parts that processes keep of a file make up the file, with the ghost cells around them.

#include "MeshFileChecks.h"
#include "MeshPart.h"
#include "Registry.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkGmshReader.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkMeshFileReader.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkOffReader.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnstructuredGrid.h"

#include <new>
#include <set>

using namespace tautline;

namespace
{
const std::vector<Index>& integers(const std::vector<MeshArray>& arrays, const char* name)
{
  static const std::vector<Index> none;
  const MeshArray* array = findArray(arrays, name);
  const auto* values = array ? std::get_if<MeshArray::Integers>(&array->values) : nullptr;
  TAUTLINE_CHECK(values != nullptr);
  return values ? *values : none;
}

/// Whether a point or cell of a part belongs to another part.
bool isGhost(const std::vector<MeshArray>& arrays, std::size_t i)
{
  const MeshArray* array = findArray(arrays, PartGhosts);
  return array && array->at(i) != 0.0;
}

/// The nodes of a cell as numbers of the file.
std::vector<Index> nodesInFile(
  const MeshFile& mesh, std::size_t cell, const std::vector<Index>* ids)
{
  std::vector<Index> nodes;
  for (Index i = mesh.offsets[cell]; i < mesh.offsets[cell + 1]; ++i)
  {
    const Index node = mesh.connectivity[static_cast<std::size_t>(i)];
    nodes.push_back(ids ? (*ids)[static_cast<std::size_t>(node)] : node);
  }
  return nodes;
}

/// The values of the whole mesh's arrays, found in the part's.
void checkArrays(const std::vector<MeshArray>& whole, const std::vector<MeshArray>& part,
  const std::vector<Index>& ids)
{
  for (const MeshArray& expected : whole)
  {
    const MeshArray* found = findArray(part, expected.name);
    const auto width = static_cast<std::size_t>(expected.components);
    TAUTLINE_CHECK(
      found && found->code() == expected.code() && found->size() == width * ids.size());
    for (std::size_t i = 0; found && i < found->size(); ++i)
    {
      const double a = found->at(i);
      const double b = expected.at(width * static_cast<std::size_t>(ids[i / width]) + i % width);
      TAUTLINE_CHECK(a == b || (std::isnan(a) && std::isnan(b)));
    }
  }
}

/// The ghost cells within some layers, found by asking each cell about each layer's points.
std::set<Index> expectedGhosts(const MeshFile& whole, std::set<Index> cells, int layers)
{
  std::set<Index> ghosts;
  for (int layer = 0; layer < layers; ++layer)
  {
    std::set<Index> points;
    for (const Index cell : cells)
    {
      const auto nodes = nodesInFile(whole, static_cast<std::size_t>(cell), nullptr);
      points.insert(nodes.begin(), nodes.end());
    }
    for (std::size_t cell = 0; cell < whole.cellTypes.size(); ++cell)
    {
      const auto nodes = nodesInFile(whole, cell, nullptr);
      const auto id = static_cast<Index>(cell);
      if (!cells.count(id) &&
        std::any_of(nodes.begin(), nodes.end(), [&](Index p) { return points.count(p) > 0; }))
      {
        ghosts.insert(id);
      }
    }
    cells.insert(ghosts.begin(), ghosts.end());
  }
  return ghosts;
}

/// One part; returns its own cells, and adds its points.
std::set<Index> checkPart(
  const MeshFile& whole, const PartRequest& request, std::set<Index>& points)
{
  const MeshFile part = partOf(whole, request);
  const std::vector<Index>& cellIds = integers(part.cellArrays, PartCellIds);
  const std::vector<Index>& pointIds = integers(part.pointArrays, PartPointIds);
  TAUTLINE_CHECK(cellIds.size() == part.cellTypes.size());
  TAUTLINE_CHECK(3 * pointIds.size() == part.points.size());
  checkArrays(whole.pointArrays, part.pointArrays, pointIds);
  checkArrays(whole.cellArrays, part.cellArrays, cellIds);
  TAUTLINE_CHECK(part.fieldArrays.size() == whole.fieldArrays.size());

  std::set<Index> own, ghosts, ownPoints;
  for (std::size_t cell = 0; cell < cellIds.size(); ++cell)
  {
    const auto id = static_cast<std::size_t>(cellIds[cell]);
    TAUTLINE_CHECK(part.cellTypes[cell] == whole.cellTypes[id]);
    const std::vector<Index> nodes = nodesInFile(part, cell, &pointIds);
    TAUTLINE_CHECK(nodes == nodesInFile(whole, id, nullptr));
    const bool ghost = isGhost(part.cellArrays, cell);
    TAUTLINE_CHECK((ghost ? ghosts : own).insert(cellIds[cell]).second);
    if (!ghost)
    {
      ownPoints.insert(nodes.begin(), nodes.end());
    }
  }
  TAUTLINE_CHECK(ghosts == expectedGhosts(whole, own, request.ghostLayers));
  std::set<Index> inCells(whole.connectivity.begin(), whole.connectivity.end());
  for (std::size_t point = 0; point < pointIds.size(); ++point)
  {
    TAUTLINE_EACH(std::size_t, c, 3,
      TAUTLINE_CHECK(part.points[3 * point + c] ==
        whole.points[3 * static_cast<std::size_t>(pointIds[point]) + c]));
    const bool loose = inCells.count(pointIds[point]) == 0;
    TAUTLINE_CHECK(!loose || request.part == 0);
    TAUTLINE_CHECK(
      isGhost(part.pointArrays, point) == (!loose && ownPoints.count(pointIds[point]) == 0));
  }
  points.insert(pointIds.begin(), pointIds.end());
  return own;
}

void checkParts(const MeshFile& whole, int parts, int ghostLayers)
{
  std::set<Index> all, points;
  std::size_t fewest = whole.cellTypes.size(), most = 0;
  for (int part = 0; part < parts; ++part)
  {
    const std::set<Index> own = checkPart(whole, { part, parts, ghostLayers }, points);
    fewest = std::min(fewest, own.size());
    most = std::max(most, own.size());
    TAUTLINE_EACH_OF(const Index cell, own, TAUTLINE_CHECK(all.insert(cell).second));
  }
  TAUTLINE_CHECK(all.size() == whole.cellTypes.size());
  TAUTLINE_CHECK(static_cast<Index>(points.size()) == whole.numberOfPoints());
  TAUTLINE_CHECK(most - fewest <= 1);
}

/// A box of n x n x 2n voxels as hexahedra: its halves meet at one layer of points.
TAUTLINE_PART(testCompact)
{
  constexpr Index n = 6, depth = 2 * n;
  MeshFile box;
  for (Index i = 0; i < (n + 1) * (n + 1) * (depth + 1); ++i)
  {
    for (const Index c : { i % (n + 1), i / (n + 1) % (n + 1), i / ((n + 1) * (n + 1)) })
    {
      box.points.push_back(static_cast<double>(c));
    }
  }
  for (Index i = 0; i < n * n * depth; ++i)
  {
    const Index a = i % n + (n + 1) * (i / n % n + (n + 1) * (i / (n * n)));
    const Index up = (n + 1) * (n + 1);
    const Index ids[] = { a, a + 1, a + n + 2, a + n + 1, a + up, a + up + 1, a + up + n + 2,
      a + up + n + 1 };
    box.addCell(FileHexahedron, ids, 8);
  }
  Index points = 0;
  for (int part = 0; part < 2; ++part)
  {
    points += partOf(box, { part, 2, 0 }).numberOfPoints();
  }
  TAUTLINE_CHECK(points == box.numberOfPoints() + (n + 1) * (n + 1));
  checkParts(box, 5, 1);
}

/// The output of a reader when a piece is requested.
template <class Reader, class Output>
void testReader(const std::string& name, vtkIdType cells)
{
  constexpr int pieces = 3;
  TAUTLINE_NEW(Reader, reader, SetFileName(name.c_str()), Update());
  TAUTLINE_CHECK(reader->GetOutput()->GetNumberOfCells() == cells);
  TAUTLINE_CHECK(reader->GetOutput()->GetCellData()->GetGlobalIds() == nullptr);
  std::set<vtkIdType> all;
  for (int piece = 0; piece < pieces; ++piece)
  {
    using Executive = vtkStreamingDemandDrivenPipeline;
    TAUTLINE_NEW(vtkInformation, request, Set(Executive::UPDATE_PIECE_NUMBER(), piece),
      Set(Executive::UPDATE_NUMBER_OF_PIECES(), pieces),
      Set(Executive::UPDATE_NUMBER_OF_GHOST_LEVELS(), 1));
    reader->Update(request);
    vtkPointSet* part = reader->GetOutput();
    TAUTLINE_CHECK(part->IsA("vtkPolyData") == (std::is_same_v<Output, vtkPolyData>));
    auto* ids = vtkIdTypeArray::SafeDownCast(part->GetCellData()->GetGlobalIds());
    auto* ghosts = part->GetCellGhostArray();
    TAUTLINE_CHECK(ids && ghosts && part->GetPointData()->GetGlobalIds());
    TAUTLINE_CHECK(part->GetPointGhostArray() != nullptr);
    for (vtkIdType cell = 0; ids && ghosts && cell < part->GetNumberOfCells(); ++cell)
    {
      TAUTLINE_CHECK(ghosts->GetValue(cell) || all.insert(ids->GetValue(cell)).second);
    }
  }
  TAUTLINE_CHECK(static_cast<vtkIdType>(all.size()) == cells);
}

/// A reader without memory for its file.
class ReaderWithoutMemory : public vtkMeshFileReader
{
public:
  static ReaderWithoutMemory* New() { VTK_STANDARD_NEW_BODY(ReaderWithoutMemory); }
  int CanReadFile(const char*) override { return 1; }

protected:
  MeshFile ReadMesh() override { throw std::bad_alloc(); }
};

TAUTLINE_PART(testMemory)
{
  TAUTLINE_NEW(ReaderWithoutMemory, reader, SetFileName("some.mesh"));
  vtkObject::GlobalWarningDisplayOff();
  reader->UpdatePiece(1, 3, 1);
  vtkObject::GlobalWarningDisplayOn();
  const std::string message = reader->GetErrorText();
  TAUTLINE_CHECK(message.find("some.mesh") == 0);
  TAUTLINE_CHECK(message.find(wording("not-enough-memory")) != message.npos);
}
}

TAUTLINE_TEST(TestMeshPart)
{
  const std::string data = argv[1];
  for (const char* name : { "/cube.1.ele", "/zoo.mesh", "/wedges.msh", "/cylinder.msh",
         "/house.off", "/box.poly", "/part22-binary.msh" })
  {
    const Context context(name);
    const MeshFile whole = readByName(data + name, true);
    TAUTLINE_CHECK(whole.numberOfCells() > 0);
    for (const int parts : { 1, 2, 3, 7, 16 })
    {
      for (const int layers : { 0, 1, 2 })
      {
        const Context division(std::to_string(parts) + " parts, " + std::to_string(layers));
        TAUTLINE_RUN(checkParts(whole, parts, layers));
      }
    }
  }
  TAUTLINE_RUN(checkParts(MeshFile(), 3, 1));
  TAUTLINE_RUN(testReader<vtkGmshReader, vtkUnstructuredGrid>(data + "/cylinder.msh", 487));
  TAUTLINE_RUN(testReader<vtkOffReader, vtkPolyData>(data + "/house.off", 7));
}
