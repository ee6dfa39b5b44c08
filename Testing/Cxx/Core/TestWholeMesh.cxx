// SPDX-License-Identifier: BSD-3-Clause
// One mesh of its pieces: the same whatever the pieces; with ghost cells, global ids, cracks and
// points that only ghost cells have; images, surfaces; what cannot be put together.
#include "PointOrder.h"
#include "Registry.h"
#include "VtkMeshes.h"
#include "WholeMesh.h"

using namespace tautline;

namespace
{
using Grid = vtkSmartPointer<vtkUnstructuredGrid>;
using Owner = std::function<int(Index)>;

struct Cut
{
  bool ids, ghosts;
};

/// The piece of a mesh with the cells of an owner, with ghosts also those that touch them; points
/// and cells in reverse order if `owner` is odd.
Grid piece(const MeshData& whole, const Owner& ownerOf, int owner, const Cut& cut)
{
  std::vector<char> touched(whole.points.size() / 3, 0);
  const auto nodesOf = [&whole](Index cell) { return whole.nodes(cell); };
  for (Index cell = 0; cell < whole.numberOfCells(); ++cell)
  {
    for (const Index node : nodesOf(cell))
    {
      touched[node] |= ownerOf(cell) == owner;
    }
  }
  MeshData data;
  std::vector<Index> numbers(touched.size(), -1);
  vtkNew<vtkIdTypeArray> pointIds, cellIds;
  vtkNew<vtkUnsignedCharArray> ghosts;
  vtkNew<vtkDoubleArray> place;
  vtkNew<vtkStringArray> names;
  for (Index k = 0; k < whole.numberOfCells(); ++k)
  {
    const Index cell = owner % 2 ? whole.numberOfCells() - 1 - k : k;
    std::vector<Index> nodes = nodesOf(cell);
    const bool own = ownerOf(cell) == owner;
    const bool near =
      std::any_of(nodes.begin(), nodes.end(), [&](Index node) { return touched[node]; });
    if (!own && !(cut.ghosts && near))
    {
      continue;
    }
    for (Index& node : nodes)
    {
      if (numbers[node] < 0)
      {
        numbers[node] = static_cast<Index>(data.points.size() / 3);
        data.points.insert(
          data.points.end(), whole.points.begin() + 3 * node, whole.points.begin() + 3 * node + 3);
        pointIds->InsertNextValue(node);
        place->InsertNextValue(whole.points[3 * node] + 10 * whole.points[3 * node + 1]);
      }
      node = numbers[node];
    }
    data.addCell(static_cast<int>(whole.types[cell]), nodes);
    cellIds->InsertNextValue(cell);
    names->InsertNextValue("cell " + std::to_string(cell));
    ghosts->InsertNextValue(own ? 0 : 1);
  }
  Grid grid = toGrid(data);
  pointIds->SetName("ids");
  cellIds->SetName("ids");
  place->SetName("place");
  names->SetName("name");
  ghosts->SetName("vtkGhostType");
  TAUTLINE_SET(grid, GetPointData()->AddArray(place), GetCellData()->AddArray(names));
  if (cut.ghosts)
  {
    grid->GetCellData()->AddArray(ghosts);
  }
  if (cut.ids)
  {
    grid->GetPointData()->SetGlobalIds(pointIds);
    grid->GetCellData()->SetGlobalIds(cellIds);
  }
  return grid;
}

std::vector<vtkDataSet*> plain(const std::vector<Grid>& grids)
{
  return std::vector<vtkDataSet*>(grids.begin(), grids.end());
}

/// The same points, cells and arrays.
void checkEqual(vtkDataSet* found, vtkDataSet* expected)
{
  if (!TAUTLINE_CHECK(found->GetNumberOfPoints() == expected->GetNumberOfPoints() &&
        found->GetNumberOfCells() == expected->GetNumberOfCells()))
  {
    return;
  }
  for (vtkIdType i = 0; i < found->GetNumberOfPoints(); ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      TAUTLINE_CHECK_EQUAL(found->GetPoint(i)[k], expected->GetPoint(i)[k]);
    }
  }
  vtkNew<vtkIdList> a, b;
  for (vtkIdType c = 0; c < found->GetNumberOfCells(); ++c)
  {
    found->GetCellPoints(c, a);
    expected->GetCellPoints(c, b);
    TAUTLINE_CHECK_EQUAL(found->GetCellType(c), expected->GetCellType(c));
    TAUTLINE_CHECK(a->GetNumberOfIds() == b->GetNumberOfIds() &&
      std::equal(a->GetPointer(0), a->GetPointer(0) + a->GetNumberOfIds(), b->GetPointer(0)));
  }
}

/// The numbers of the pieces lead to their own points and values.
void checkNumbers(const WholeMesh& whole, const std::vector<Grid>& pieces)
{
  auto* place = whole.mesh->GetPointData()->GetArray("place");
  auto* names = vtkStringArray::SafeDownCast(whole.mesh->GetCellData()->GetAbstractArray("name"));
  if (!TAUTLINE_CHECK(place && names))
  {
    return;
  }
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    for (vtkIdType k = 0; k < pieces[i]->GetNumberOfPoints(); ++k)
    {
      const vtkIdType number = whole.pieces[i].points[k];
      TAUTLINE_CHECK_EQUAL(place->GetComponent(number, 0),
        pieces[i]->GetPointData()->GetArray("place")->GetComponent(k, 0));
    }
    for (vtkIdType k = 0; k < pieces[i]->GetNumberOfCells(); ++k)
    {
      const vtkIdType number = whole.pieces[i].cells[k];
      auto* own = vtkStringArray::SafeDownCast(pieces[i]->GetCellData()->GetAbstractArray("name"));
      TAUTLINE_CHECK(number >= 0 && names->GetValue(number) == own->GetValue(k));
    }
  }
}

TAUTLINE_PART(testPartitions)
{
  MeshData data = blockMesh(CellType::Tetrahedron, 3, 2, 2);
  const Index cells = data.numberOfCells();
  const Owner halves = [cells](Index cell) { return 2 * cell < cells ? 0 : 1; };
  const Owner scattered = [](Index cell) { return static_cast<int>((7 * cell) % 5); };
  for (const bool ids : { true, false })
  {
    vtkSmartPointer<vtkDataSet> first;
    for (const bool ghosts : { false, true })
    {
      for (const auto& [owner, count] :
        { std::pair<Owner, int>{ halves, 2 }, { scattered, 5 }, { scattered, 7 } })
      {
        const Context context(
          (ids ? "ids " : "places ") + std::to_string(count) + (ghosts ? " ghosts" : ""));
        auto pieces = collect<Grid>(count,
          [&](int i) {
            return piece(data, owner, i, { ids, ghosts });
          });
        const WholeMesh whole = assemble(plain(pieces));
        checkNumbers(whole, pieces);
        TAUTLINE_CHECK(!whole.mesh->GetCellData()->GetArray("vtkGhostType"));
        first = first ? first : whole.mesh;
        checkEqual(whole.mesh, first);
        if (ids)
        {
          checkEqual(whole.mesh, toGrid(data));
          TAUTLINE_CHECK(whole.mesh->GetPointData()->GetGlobalIds() != nullptr);
        }
        // Another mesh on the same pieces gets the same numbers.
        std::vector<Grid> moved;
        for (const Grid& grid : pieces)
        {
          moved.push_back(Grid::New());
          moved.back()->DeepCopy(grid);
          moved.back()->GetPointData()->SetGlobalIds(nullptr);
          for (vtkIdType k = 0; k < grid->GetNumberOfPoints(); ++k)
          {
            const double* p = grid->GetPoint(k);
            moved.back()->GetPoints()->SetPoint(k, -p[0], p[2], p[1]);
          }
        }
        TAUTLINE_CHECK(matches(plain(moved), whole));
        const WholeMesh other = assemble(plain(moved), &whole);
        checkNumbers(other, moved);
        TAUTLINE_CHECK_EQUAL(other.mesh->GetPoint(1)[0], -whole.mesh->GetPoint(1)[0]);
        // The facts about the order of points that were put together.
        const WholeMesh alone = assemble(plain(moved));
        const auto given = toGrid(data);
        const PointOrder order = ids ? PointOrder::ById : PointOrder::Coordinates;
        TAUTLINE_CHECK(pointOrder(whole.mesh) == order);
        TAUTLINE_CHECK(pointOrder(other.mesh) == PointOrder::Shared);
        TAUTLINE_CHECK(commonOrder(whole.mesh, first) == order);
        TAUTLINE_CHECK(commonOrder(whole.mesh, other.mesh) == PointOrder::ById);
        TAUTLINE_CHECK(commonOrder(whole.mesh, alone.mesh) == PointOrder::Coordinates);
        TAUTLINE_CHECK(commonOrder(given, whole.mesh) == PointOrder::Coordinates);
        TAUTLINE_CHECK(commonOrder(given, given) == PointOrder::Given);
        given->GetPointData()->SetGlobalIds(whole.mesh->GetPointData()->GetGlobalIds());
        TAUTLINE_CHECK(commonOrder(given, given) == PointOrder::Given);
        TAUTLINE_CHECK(commonOrder(given, whole.mesh) == order);
        TAUTLINE_CHECK(commonOrder(whole.mesh, given) == order);
        TAUTLINE_CHECK(pieces.size() < 3 || !matches({ moved[1], moved[0] }, whole));
      }
    }
  }
}

/// Points at one place in one piece stay apart, everywhere.
TAUTLINE_PART(testCrack)
{
  MeshData data;
  data.points = { 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 2, 0, 0, 2, 1, 0 };
  data.addCell(static_cast<int>(CellType::Quadrilateral), { 0, 1, 2, 3 });
  data.addCell(static_cast<int>(CellType::Quadrilateral), { 4, 6, 7, 5 });
  MeshData more;
  more.points = { 1, 1, 0, 2, 1, 0, 2, 2, 0, 1, 2, 0 };
  more.addCell(static_cast<int>(CellType::Quadrilateral), { 0, 1, 2, 3 });
  const WholeMesh whole = assemble({ toGrid(data), toGrid(more) });
  TAUTLINE_CHECK_EQUAL(whole.mesh->GetNumberOfPoints(), 8 + 3); // (2, 1) is one point
  const WholeMesh apart = assemble({ toGrid(data) });
  TAUTLINE_CHECK_EQUAL(apart.mesh->GetNumberOfPoints(), 8);
}

TAUTLINE_PART(testOtherTypes)
{
  // An image in two parts.
  TAUTLINE_NEW(vtkImageData, image, SetExtent(2, 5, 0, 3, 0, 0), AllocateScalars(VTK_DOUBLE, 1));
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
  {
    image->GetPointData()->GetScalars()->SetComponent(i, 0, static_cast<double>(i));
  }
  vtkNew<vtkImageData> low, high;
  low->DeepCopy(image);
  high->DeepCopy(image);
  const int lowExtent[6] = { 2, 5, 0, 1, 0, 0 }, highExtent[6] = { 2, 5, 1, 3, 0, 0 };
  low->Crop(lowExtent);
  high->Crop(highExtent);
  const WholeMesh whole = assemble({ high, low });
  auto* joined = vtkImageData::SafeDownCast(whole.mesh);
  if (TAUTLINE_CHECK(joined && joined->GetNumberOfPoints() == image->GetNumberOfPoints()))
  {
    TAUTLINE_EACH(vtkIdType, i, image->GetNumberOfPoints(),
      TAUTLINE_CHECK_EQUAL(joined->GetPointData()->GetScalars()->GetComponent(i, 0), i));
    TAUTLINE_CHECK_EQUAL(whole.pieces[0].cells.back(), 8);
    TAUTLINE_CHECK_EQUAL(whole.pieces[1].cells.front(), 0);
  }
  const int gap[6] = { 2, 5, 2, 3, 0, 0 };
  high->Crop(gap);
  TAUTLINE_CHECK_THROWS(assemble({ high, low }), wording("do-not-fill-it"));

  // A surface: lines before triangles, as vtkPolyData has them.
  const auto surface = [](double shift)
  {
    auto data = vtkSmartPointer<vtkPolyData>::New();
    TAUTLINE_NEW(vtkPoints, points, InsertNextPoint(shift, 0, 0), InsertNextPoint(shift + 1, 0, 0),
      InsertNextPoint(shift, 1, 0));
    TAUTLINE_SET(data, SetPoints(points), Allocate(2));
    const vtkIdType ids[3] = { 0, 1, 2 };
    TAUTLINE_SET(data, InsertNextCell(VTK_TRIANGLE, 3, ids), InsertNextCell(VTK_LINE, 2, ids));
    return data;
  };
  const WholeMesh poly = assemble({ surface(0), surface(1) });
  TAUTLINE_CHECK(poly.mesh->IsA("vtkPolyData"));
  TAUTLINE_CHECK_EQUAL(poly.mesh->GetNumberOfPoints(), 5);
  TAUTLINE_CHECK_EQUAL(poly.mesh->GetCellType(1), VTK_LINE);
  TAUTLINE_CHECK_EQUAL(poly.mesh->GetCellType(2), VTK_TRIANGLE);
}

TAUTLINE_PART(testErrors)
{
  const MeshData data = blockMesh(CellType::Triangle, 2, 2, 0);
  const Owner halves = [](Index cell) { return static_cast<int>(cell % 2); };
  Grid a = piece(data, halves, 0, { true, false }), b = piece(data, halves, 1, { true, false });
  a->GetPoints()->SetPoint(0, 0.123, 0, 0);
  TAUTLINE_CHECK_THROWS(assemble({ a, b }), wording("points-at-different-places-have-the-global"));
  a = piece(data, halves, 0, { true, false });
  TAUTLINE_CHECK_THROWS(assemble({ a, a }), wording("several-cells-have-the-global-id"));
  // Nothing at all, and nothing but one.
  Grid empty = Grid::New();
  TAUTLINE_CHECK_EQUAL(assemble({ empty, empty }).mesh->GetNumberOfPoints(), 0);
  TAUTLINE_CHECK(assemble({ empty, a }).mesh == a);
}

TAUTLINE_PART(testExtraction)
{
  const MeshData data = blockMesh(CellType::Triangle, 2, 1, 0);
  const Grid grid = piece(data, [](Index) { return 0; }, 0, { false, false });
  const auto part = extractCells(grid, { 1, 0, 0, 0 }, false);
  TAUTLINE_CHECK_EQUAL(part->GetNumberOfCells(), 1);
  TAUTLINE_CHECK_EQUAL(part->GetNumberOfPoints(), 3);
  TAUTLINE_CHECK(
    vtkStringArray::SafeDownCast(part->GetCellData()->GetAbstractArray("name"))->GetValue(0) ==
    "cell 0");
}
}
