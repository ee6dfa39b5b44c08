// SPDX-License-Identifier: BSD-3-Clause
#include "HostileParts.h"
#include "VtkCompatibility.h"
#include "VtkMeshes.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkTypeInt64Array.h"

#include <sstream>

namespace tautline
{

namespace
{
using Data = vtkSmartPointer<vtkDataObject>;
constexpr double NaN = std::numeric_limits<double>::quiet_NaN();
constexpr double Infinity = std::numeric_limits<double>::infinity();

//------------------------------------------------------------------------------
/** A deep copy, or null if it is not of a type. */
template <class T>
vtkSmartPointer<T> copyOf(vtkDataObject* suitable)
{
  T* typed = T::SafeDownCast(suitable);
  if (!typed)
  {
    return nullptr;
  }
  auto copy = vtkSmartPointer<T>::Take(T::SafeDownCast(typed->NewInstance()));
  copy->DeepCopy(typed);
  return copy;
}

/** The same with points in double precision that can be changed. */
vtkSmartPointer<vtkPointSet> movable(vtkDataObject* suitable)
{
  auto copy = copyOf<vtkPointSet>(suitable);
  if (copy)
  {
    TAUTLINE_NEW(vtkPoints, points, SetDataType(VTK_DOUBLE), DeepCopy(copy->GetPoints()));
    copy->SetPoints(points);
  }
  return copy;
}

Data withPoints(vtkDataObject* suitable, const std::function<Vec3(vtkIdType, Vec3)>& map)
{
  auto copy = movable(suitable);
  for (vtkIdType i = 0; copy && i < copy->GetNumberOfPoints(); ++i)
  {
    const double* p = copy->GetPoint(i);
    copy->GetPoints()->SetPoint(i, map(i, { p[0], p[1], p[2] }).data());
  }
  return copy;
}

/** The cells of a mesh that can be made corrupt; null if there are none. */
vtkCellArray* cellsOf(vtkDataObject* data)
{
  auto* grid = vtkUnstructuredGrid::SafeDownCast(data);
  auto* poly = vtkPolyData::SafeDownCast(data);
  return grid                                  ? grid->GetCells()
    : !poly                                    ? nullptr
    : poly->GetPolys()->GetNumberOfCells() > 0 ? poly->GetPolys()
                                               : poly->GetLines();
}

using Ids = std::vector<vtkTypeInt64>;

/** The mesh with changed offsets and ids. VTK's own methods would check or crash. */
Data withCells(vtkDataObject* suitable, const std::function<void(Ids&, Ids&)>& change)
{
  Data copy;
  if (vtkDataSet::SafeDownCast(suitable))
  {
    copy = copyOf<vtkDataSet>(suitable);
  }
  vtkCellArray* cells = cellsOf(copy);
  if (!cells)
  {
    return nullptr;
  }
  cells->ConvertTo64BitStorage();
  const auto values = [](vtkAOSDataArrayTemplate<vtkTypeInt64>* array)
  { return Ids(array->GetPointer(0), array->GetPointer(0) + array->GetNumberOfValues()); };
  Ids offsets = values(offsets64(cells)), ids = values(connectivity64(cells));
  change(offsets, ids);
  const auto array = [](const Ids& from)
  {
    auto result = vtkSmartPointer<vtkTypeInt64Array>::New();
    result->SetNumberOfValues(static_cast<vtkIdType>(from.size()));
    std::copy(from.begin(), from.end(), result->GetPointer(0));
    return result;
  };
  // In place: SetCells() of a grid would decompose polyhedra, which may be corrupt.
  cells->SetData(array(offsets), array(ids));
  return copy;
}

Data withTypes(vtkDataObject* suitable, const std::function<void(vtkUnsignedCharArray*)>& change)
{
  auto grid = copyOf<vtkUnstructuredGrid>(suitable);
  if (!grid)
  {
    return nullptr;
  }
  const vtkSmartPointer<vtkUnsignedCharArray> types = cellTypesOf(grid);
  if (types != storedCellTypes(grid))
  {
    grid->SetCells(types, grid->GetCells()); // they were computed
  }
  change(types);
  return grid;
}

/** With an array of points or cells more, of a length off by some. */
template <class ArrayT = vtkDoubleArray>
Data withArray(vtkDataObject* suitable, const char* name, bool ofCells, int off, int components = 1)
{
  auto copy = copyOf<vtkDataSet>(suitable);
  if (!copy)
  {
    return nullptr;
  }
  const vtkIdType count = ofCells ? copy->GetNumberOfCells() : copy->GetNumberOfPoints();
  auto array = makeArray<ArrayT>(name, std::max<vtkIdType>(0, count + off), components);
  (ofCells ? static_cast<vtkFieldData*>(copy->GetCellData()) : copy->GetPointData())
    ->AddArray(array);
  return copy;
}

//------------------------------------------------------------------------------
/** Blocks: the mesh, nothing, others. */
Data blocks(vtkDataObject* suitable, const std::vector<Data>& others)
{
  if (!vtkDataSet::SafeDownCast(suitable))
  {
    return nullptr;
  }
  auto result = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  TAUTLINE_SET(result, SetBlock(0, suitable), SetBlock(1, nullptr));
  for (const Data& other : others)
  {
    result->SetBlock(result->GetNumberOfBlocks(), other);
  }
  return result;
}

Data collection(vtkDataObject* suitable, bool withTable)
{
  if (!vtkDataSet::SafeDownCast(suitable))
  {
    return nullptr;
  }
  auto result = vtkSmartPointer<vtkPartitionedDataSetCollection>::New();
  vtkNew<vtkPartitionedDataSet> first, second, third;
  first->SetPartition(0, suitable);
  first->SetPartition(1, static_cast<vtkDataObject*>(nullptr));
  if (withTable)
  {
    second->SetPartition(0, makeTable().Get());
  }
  TAUTLINE_SET(result, SetPartitionedDataSet(0, first), SetPartitionedDataSet(1, second),
    SetPartitionedDataSet(2, third));
  return result;
}

Data scaled(vtkDataObject* suitable, double factor, double offset = 0)
{
  return withPoints(suitable,
    [=](vtkIdType, Vec3 p) {
      return Vec3{ factor * p[0] + offset, factor * p[1] + offset, factor * p[2] };
    });
}

Data withUnusedPoints(vtkDataObject* suitable)
{
  auto copy = movable(suitable);
  if (copy)
  {
    copy->GetPoints()->InsertNextPoint(100, 100, 0);
    copy->GetPoints()->InsertNextPoint(NaN, NaN, NaN);
    for (int i = copy->GetPointData()->GetNumberOfArrays(); i-- > 0;)
    {
      copy->GetPointData()->RemoveArray(i);
    }
  }
  return copy;
}

Data inFloats(vtkDataObject* suitable)
{
  auto copy = copyOf<vtkPointSet>(suitable);
  if (copy)
  {
    TAUTLINE_NEW(vtkPoints, points, SetDataType(VTK_FLOAT), DeepCopy(copy->GetPoints()));
    copy->SetPoints(points);
  }
  return copy;
}

Data inNarrowIds(vtkDataObject* suitable)
{
  Data copy = copyOf<vtkDataSet>(suitable);
  vtkCellArray* list = cellsOf(copy);
  if (!list)
  {
    return nullptr;
  }
  list->ConvertTo32BitStorage();
  return copy;
}

/** With a quarter of the cells, or points, as ghosts. */
Data withGhosts(vtkDataObject* suitable)
{
  auto copy = copyOf<vtkDataSet>(suitable);
  if (copy)
  {
    auto ghosts = makeArray<vtkUnsignedCharArray>(
      vtkDataSetAttributes::GhostArrayName(), copy->GetNumberOfCells());
    for (vtkIdType i = 0; i < copy->GetNumberOfCells(); ++i)
    {
      ghosts->SetValue(i, i % 4 == 3 ? vtkDataSetAttributes::DUPLICATECELL : 0);
    }
    copy->GetCellData()->AddArray(ghosts);
  }
  return copy;
}

//------------------------------------------------------------------------------
/** One random change, or several. */
Data mutated(vtkDataObject* suitable, unsigned seed)
{
  Random random(seed);
  Data data = suitable;
  const vtkTypeInt64 values[] = { -1, 0, 1, 7, 1000000, std::numeric_limits<vtkTypeInt64>::max(),
    std::numeric_limits<vtkTypeInt64>::min() };
  const double coordinates[] = { NaN, Infinity, -Infinity, 1e300, -1e300, 1e-300, 0, 1e30 };
  const int types[] = { 0, 1, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 22, 24, 42, 69, 200 };
  const auto pick = [&random](const auto& from) { return from[random.integer(std::size(from))]; };
  const auto place = [&random](const auto& from)
  { return static_cast<std::size_t>(random.integer(std::max<Index>(1, Index(from.size())))); };
  for (Index changes = 1 + random.integer(3); changes > 0; --changes)
  {
    Data changed;
    switch (random.integer(8))
    {
      case 0:
        changed = withCells(data,
          [&](Ids&, Ids& ids)
          {
            if (!ids.empty())
            {
              ids[place(ids)] = pick(values);
            }
          });
        break;
      case 1:
        changed =
          withCells(data, [&](Ids& offsets, Ids&) { offsets[place(offsets)] = pick(values); });
        break;
      case 2:
        changed = withCells(data, [&](Ids&, Ids& ids) { ids.resize(place(ids)); });
        break;
      case 3:
        changed = withTypes(data,
          [&](vtkUnsignedCharArray* list)
          {
            if (list->GetNumberOfValues() > 0)
            {
              list->SetValue(
                random.integer(list->GetNumberOfValues()), static_cast<unsigned char>(pick(types)));
            }
          });
        break;
      case 4:
      {
        const Index at = random.integer(25);
        const double value = pick(coordinates);
        const int axis = static_cast<int>(random.integer(3));
        changed = withPoints(data,
          [=](vtkIdType i, Vec3 p)
          {
            p[axis] = i == at ? value : p[axis];
            return p;
          });
        break;
      }
      case 5:
        changed = withArray(data, "more", random.integer(2) == 0, int(random.integer(3)) - 1);
        break;
      case 6:
      {
        auto copy = movable(data);
        if (copy)
        {
          copy->GetPoints()->SetNumberOfPoints(
            random.integer(std::max<Index>(1, copy->GetNumberOfPoints())));
        }
        changed = copy;
        break;
      }
      default:
        changed = withPoints(data,
          [&](vtkIdType, Vec3 p) {
            return random.integer(6) == 0 ? Vec3{ 0, 0, 0 } : p;
          });
        break;
    }
    data = changed ? changed : data;
  }
  return data == suitable ? nullptr : data;
}

/// A function that makes hostile data of suitable `data`; one that changes a point p, number i.
#define MAKES(...) [=](vtkDataObject* data) -> Data { return __VA_ARGS__; }
#define POINTS(...) \
  MAKES(withPoints( \
    data, []([[maybe_unused]] vtkIdType i, [[maybe_unused]] Vec3 p) { return __VA_ARGS__; }))

void addVariants(std::vector<HostileData>& list)
{
  const auto add = [&list](const char* name, const std::function<Data(vtkDataObject*)>& make,
                     Expected expected = Expected::Anything, bool extreme = false,
                     bool nonFinite = false) {
    list.push_back({ name, make, expected, extreme, nonFinite });
  };
  constexpr auto anything = Expected::Anything;
  add("suitable", MAKES(data), Expected::Result);
  add("suitable, in floats", inFloats);
  add("suitable, 32-bit ids", inNarrowIds, Expected::Result);
  add("no area", POINTS(Vec3{ p[0], 0, 0 }));
  add("all points equal", POINTS(Vec3{ 1, 1, 0 }));
  add("duplicate cells", MAKES(doubledMesh(data, 0, false)));
  add("doubled points", MAKES(doubledMesh(data, 0, true)));
  add("overlapping parts", MAKES(doubledMesh(data, 0.3, true)));
  add("disconnected parts", MAKES(doubledMesh(data, 100, true)));
  add("NaN", POINTS(i == 6 ? Vec3{ NaN, p[1], p[2] } : p), anything, false, true);
  add("infinite", POINTS(i == 6 ? Vec3{ p[0], -Infinity, p[2] } : p), anything, false, true);
  add("all NaN", POINTS(Vec3{ NaN, NaN, NaN }), anything, false, true);
  add("unused points", withUnusedPoints, anything, false, true);
  add("offset 1e8", MAKES(scaled(data, 1, 1e8)));
  add("scale 1e-12", MAKES(scaled(data, 1e-12)));
  add("scale 1e12", MAKES(scaled(data, 1e12)));
  add("scale 1e-200", MAKES(scaled(data, 1e-200)), anything, true);
  add("scale 1e160", MAKES(scaled(data, 1e160)), anything, true);
  add("scale 1e300", MAKES(scaled(data, 1e300)), anything, true);
  add("ghost cells", withGhosts);
  add("blocks with null", MAKES(blocks(data, {})));
  add("blocks with a table", MAKES(blocks(data, { makeTable() })));
  add("blocks with an empty mesh",
    MAKES(blocks(data, { vtkSmartPointer<vtkUnstructuredGrid>::New() })));
  add("blocks in blocks", MAKES(blocks(data, { makeBlocks({ data, nullptr, makeTable() }) })));
  add("partitioned collection", MAKES(collection(data, false)));
  add("partitioned collection with a table", MAKES(collection(data, true)));
  add("text arrays", MAKES(withArray<vtkStringArray>(data, "Names", true, 0)));
  add("unnamed array", MAKES(withArray(data, nullptr, false, 0)));
}

Data withFewPoints(vtkDataObject* data)
{
  auto copy = movable(data);
  if (copy)
  {
    TAUTLINE_SET(copy, GetPoints()->SetNumberOfPoints(2), GetPointData()->Initialize());
  }
  return copy;
}

void addCorrupt(std::vector<HostileData>& list)
{
  const auto add = [&list](const char* name, const std::function<Data(vtkDataObject*)>& make) {
    list.push_back({ name, make, Expected::Error });
  };
  const char* ghosts = vtkDataSetAttributes::GhostArrayName();
  add("short point array", MAKES(withArray(data, "short", false, -3)));
  add("short cell array", MAKES(withArray(data, "short", true, -1)));
  add("long point array", MAKES(withArray(data, "long", false, 1)));
  add("short text array", MAKES(withArray<vtkStringArray>(data, "Names", false, -1)));
  add("ghost array of integers", MAKES(withArray<vtkIntArray>(data, ghosts, true, 0)));
  add("ghost array too short", MAKES(withArray<vtkUnsignedCharArray>(data, ghosts, true, -1)));
  add("ghost array of points with two components",
    MAKES(withArray<vtkUnsignedCharArray>(data, ghosts, false, 0, 2)));
#define CELLS(change) \
  MAKES(withCells(data, []([[maybe_unused]] Ids& offsets, [[maybe_unused]] Ids& ids) { change; }))
  add("negative id", CELLS(ids[1] = -1));
  add("id too large", CELLS(ids[1] = 1000000000));
  add("huge id", CELLS(ids[1] = std::numeric_limits<vtkTypeInt64>::max()));
  add("descending offsets", CELLS(offsets[1] = 1000000));
  add("negative offset", CELLS(offsets[0] = -3));
  add("offsets beyond the connectivity", CELLS(offsets.back() += 1));
  add("short connectivity", CELLS(ids.pop_back()));
#define TYPES(...) MAKES(withTypes(data, [](vtkUnsignedCharArray* types) { types->__VA_ARGS__; }))
  add("too few types", TYPES(SetNumberOfValues(types->GetNumberOfValues() - 1)));
  add("hexahedron of too few points", TYPES(SetValue(0, VTK_HEXAHEDRON)));
  add("polyhedron without faces", TYPES(SetValue(0, VTK_POLYHEDRON)));
  add("unknown type", TYPES(SetValue(0, 200)));
  add("fewer points than ids", withFewPoints);
  add("blocks with a corrupt one",
    [](vtkDataObject* data)
    {
      const Data wrong = withCells(data, [](Ids&, Ids& ids) { ids[1] = 1000000; });
      return wrong ? blocks(data, { wrong }) : nullptr;
    });
}

/** Arrays that do not exist, or hold text, where numbers are chosen. */
void addChoices(std::vector<HostileData>& list)
{
  constexpr int Indices = 6;
  const auto choose = [&list](const char* name, int association, const char* array)
  {
    list.push_back({ name,
      [](vtkDataObject* data) { return vtkDataSet::SafeDownCast(data) ? Data(data) : nullptr; },
      Expected::Anything, false, false,
      [=](vtkAlgorithm* filter)
      {
        for (int i = 0; i < Indices; ++i)
        {
          filter->SetInputArrayToProcess(i, 0, 0, association, array);
        }
      } });
  };
  choose("chosen point array of text", vtkDataObject::FIELD_ASSOCIATION_POINTS, "Names");
  choose("chosen cell array of text", vtkDataObject::FIELD_ASSOCIATION_CELLS, "Names");
  choose("chosen point array that does not exist", vtkDataObject::FIELD_ASSOCIATION_POINTS, "gone");
  choose("chosen point array of a vector", vtkDataObject::FIELD_ASSOCIATION_POINTS, "V");
  choose("chosen cell array of cells", vtkDataObject::FIELD_ASSOCIATION_CELLS, "Material");
}

}

//------------------------------------------------------------------------------
Data doubledMesh(vtkDataObject* suitable, double shift, bool newPoints)
{
  auto copy = copyOf<vtkUnstructuredGrid>(suitable);
  if (!copy)
  {
    return nullptr;
  }
  auto result = vtkSmartPointer<vtkUnstructuredGrid>::New();
  TAUTLINE_NEW(vtkPoints, points, SetDataType(VTK_DOUBLE), DeepCopy(copy->GetPoints()));
  const vtkIdType n = points->GetNumberOfPoints();
  for (vtkIdType i = 0; newPoints && i < n; ++i)
  {
    const double* p = copy->GetPoint(i);
    points->InsertNextPoint(p[0] + shift, p[1], p[2]);
  }
  TAUTLINE_SET(result, SetPoints(points), Allocate(2 * copy->GetNumberOfCells()));
  for (int times = 0; times < 2; ++times)
  {
    for (vtkIdType cell = 0; cell < copy->GetNumberOfCells(); ++cell)
    {
      auto ids = collect<vtkIdType>(copy->GetCell(cell)->GetNumberOfPoints(),
        [&](vtkIdType k)
        { return copy->GetCell(cell)->GetPointId(k) + (newPoints ? times * n : 0); });
      result->InsertNextCell(
        copy->GetCellType(cell), static_cast<vtkIdType>(ids.size()), ids.data());
    }
  }
  return result;
}

//------------------------------------------------------------------------------
std::vector<HostileData> hostileData(int random)
{
  std::vector<HostileData> list;
  addVariants(list);
  addHostileMeshes(list);
  addCorrupt(list);
  addChoices(list);
  for (int seed = 1; seed <= random; ++seed)
  {
    const auto make = [seed](vtkDataObject* data)
    { return mutated(data, static_cast<unsigned>(seed)); };
    // Coordinates of any size may be among the mutations.
    list.push_back({ "random " + std::to_string(seed), make, Expected::Anything, true, true });
  }
  return list;
}

} // namespace tautline
