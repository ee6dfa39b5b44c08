// SPDX-License-Identifier: BSD-3-Clause
#include "WholeMesh.h"

#include "ImageParts.h"
#include "PieceCopies.h"
#include "PointOrder.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Core/Types.h"

#include "vtkAbstractArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <string>

namespace tautline
{
namespace
{
using Origin = PieceItem;
using Origins = std::vector<PieceItem>;
using Pieces = std::vector<vtkDataSet*>;

bool isGhost(vtkDataSet* piece, vtkIdType cell)
{
  vtkUnsignedCharArray* ghosts = piece->GetCellGhostArray();
  return ghosts && (ghosts->GetValue(cell) & vtkDataSetAttributes::DUPLICATECELL) != 0;
}

//------------------------------------------------------------------------------
// Arrays

/// The array with the same name, if it can be joined with the given one.
vtkAbstractArray* counterpart(vtkDataSetAttributes* data, vtkAbstractArray* array)
{
  vtkAbstractArray* other = data->GetAbstractArray(array->GetName());
  const bool alike = other && other->GetNumberOfComponents() == array->GetNumberOfComponents() &&
    (other->GetDataType() == array->GetDataType() ||
      (vtkDataArray::SafeDownCast(other) && vtkDataArray::SafeDownCast(array)));
  return alike ? other : nullptr;
}

/// Clears the flags of copies, which have become originals, and drops a ghost array without ghosts.
void clearGhosts(vtkDataSetAttributes* data, unsigned char copies)
{
  const char* name = vtkDataSetAttributes::GhostArrayName();
  auto* ghosts = vtkUnsignedCharArray::SafeDownCast(data->GetAbstractArray(name));
  bool any = false;
  for (vtkIdType i = 0; ghosts && i < ghosts->GetNumberOfTuples(); ++i)
  {
    ghosts->SetValue(i, static_cast<unsigned char>(ghosts->GetValue(i) & ~copies));
    any = any || ghosts->GetValue(i) != 0;
  }
  if (!any)
  {
    data->RemoveArray(name);
  }
}

/// Joins the arrays that all sources have.
void joinArrays(const std::vector<vtkDataSetAttributes*>& sources, const Origins& origins,
  unsigned char copies, vtkDataSetAttributes* result)
{
  vtkDataSetAttributes* first = sources[static_cast<std::size_t>(origins.front().piece)];
  for (int i = 0; i < first->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = first->GetAbstractArray(i);
    std::vector<vtkAbstractArray*> parts;
    for (vtkDataSetAttributes* source : sources)
    {
      parts.push_back(source && array->GetName() ? counterpart(source, array) : nullptr);
    }
    const bool common = std::all_of(origins.begin(), origins.end(),
      [&parts](const Origin& origin) { return parts[static_cast<std::size_t>(origin.piece)]; });
    if (!common)
    {
      continue;
    }
    auto joined = vtkSmartPointer<vtkAbstractArray>::Take(array->NewInstance());
    joined->SetName(array->GetName());
    joined->SetNumberOfComponents(array->GetNumberOfComponents());
    joined->CopyComponentNames(array);
    joined->SetNumberOfTuples(static_cast<vtkIdType>(origins.size()));
    for (std::size_t k = 0; k < origins.size(); ++k)
    {
      joined->SetTuple(static_cast<vtkIdType>(k), origins[k].id,
        parts[static_cast<std::size_t>(origins[k].piece)]);
    }
    result->AddArray(joined);
    for (int attribute = 0; attribute < vtkDataSetAttributes::NUM_ATTRIBUTES; ++attribute)
    {
      if (first->GetAbstractAttribute(attribute) == array)
      {
        result->SetActiveAttribute(array->GetName(), attribute);
      }
    }
  }
  clearGhosts(result, copies);
}

/// Joins the point and cell arrays.
void joinData(
  const Pieces& sources, const Origins& points, const Origins& cells, vtkDataSet* result)
{
  std::vector<vtkDataSetAttributes*> ofPoints, ofCells;
  for (vtkDataSet* source : sources)
  {
    ofPoints.push_back(source->GetPointData());
    ofCells.push_back(source->GetCellData());
  }
  if (!points.empty())
  {
    joinArrays(ofPoints, points, vtkDataSetAttributes::DUPLICATEPOINT, result->GetPointData());
    result->GetFieldData()->ShallowCopy(
      sources[static_cast<std::size_t>(points.front().piece)]->GetFieldData());
  }
  if (!cells.empty())
  {
    joinArrays(ofCells, cells, vtkDataSetAttributes::DUPLICATECELL, result->GetCellData());
  }
}

//------------------------------------------------------------------------------
// Meshes

vtkSmartPointer<vtkPoints> joinPoints(const Pieces& sources, const Origins& origins)
{
  bool isDouble = false;
  for (vtkDataSet* source : sources)
  {
    auto* set = vtkPointSet::SafeDownCast(source);
    isDouble = isDouble || !set ||
      (set->GetNumberOfPoints() > 0 && set->GetPoints()->GetDataType() == VTK_DOUBLE);
  }
  auto points = vtkSmartPointer<vtkPoints>::New();
  points->SetDataType(isDouble ? VTK_DOUBLE : VTK_FLOAT);
  points->SetNumberOfPoints(static_cast<vtkIdType>(origins.size()));
  for (std::size_t k = 0; k < origins.size(); ++k)
  {
    double p[3];
    sources[static_cast<std::size_t>(origins[k].piece)]->GetPoint(origins[k].id, p);
    points->SetPoint(static_cast<vtkIdType>(k), p);
  }
  return points;
}

/// The renumbered points of a cell in the format of InsertNextCell(); for a polyhedron, the faces.
void renumberedCell(
  vtkDataSet* source, vtkIdType cell, const std::vector<vtkIdType>& numbers, vtkIdList* ids)
{
  const auto renumber = [&](vtkIdType i)
  { ids->SetId(i, numbers[static_cast<std::size_t>(ids->GetId(i))]); };
  auto* grid = vtkUnstructuredGrid::SafeDownCast(source);
  if (!grid || source->GetCellType(cell) != VTK_POLYHEDRON)
  {
    source->GetCellPoints(cell, ids);
    for (vtkIdType i = 0; i < ids->GetNumberOfIds(); ++i)
    {
      renumber(i);
    }
    return;
  }
  grid->GetFaceStream(cell, ids);
  for (vtkIdType at = 1; at < ids->GetNumberOfIds();)
  {
    const vtkIdType end = at + 1 + ids->GetId(at);
    while (++at < end)
    {
      renumber(at);
    }
  }
}

/// @param numbers of the points of each source in the result
vtkSmartPointer<vtkDataSet> buildMesh(const Pieces& sources, const Origins& points,
  const Origins& cells, const std::vector<const std::vector<vtkIdType>*>& numbers)
{
  const bool poly = std::all_of(sources.begin(), sources.end(),
    [](vtkDataSet* source) { return source->IsA("vtkPolyData") != 0; });
  vtkSmartPointer<vtkPointSet> result;
  const auto fill = [&](auto grid)
  {
    grid->SetPoints(joinPoints(sources, points));
    grid->Allocate(static_cast<vtkIdType>(cells.size()));
    vtkNew<vtkIdList> ids;
    for (std::size_t c = 0; c < cells.size(); ++c)
    {
      pollInterruption(static_cast<Index>(c));
      const auto piece = static_cast<std::size_t>(cells[c].piece);
      renumberedCell(sources[piece], cells[c].id, *numbers[piece], ids);
      grid->InsertNextCell(sources[piece]->GetCellType(cells[c].id), ids);
    }
    result = grid;
  };
  poly ? fill(vtkSmartPointer<vtkPolyData>::New())
       : fill(vtkSmartPointer<vtkUnstructuredGrid>::New());
  joinData(sources, points, cells, result);
  return result;
}

//------------------------------------------------------------------------------
// Numbers of points

/// One flag per point of a piece, set if it belongs to a cell that is not a ghost, or to no cell.
std::vector<char> ownPoints(vtkDataSet* piece)
{
  std::vector<char> own(static_cast<std::size_t>(piece->GetNumberOfPoints()), 1);
  if (!piece->GetCellGhostArray())
  {
    return own;
  }
  vtkNew<vtkIdList> ids;
  for (const bool ghosts : { true, false })
  {
    for (vtkIdType cell = 0; cell < piece->GetNumberOfCells(); ++cell)
    {
      if (isGhost(piece, cell) != ghosts)
      {
        continue;
      }
      piece->GetCellPoints(cell, ids);
      for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k)
      {
        own[static_cast<std::size_t>(ids->GetId(k))] = !ghosts;
      }
    }
  }
  return own;
}

/// A point to be numbered by its key: a position or a global id.
struct Keyed
{
  Vec3 key, place;
  vtkIdType globalId;
  int piece;
  vtkIdType id;
  char own;

  bool before(const Keyed& other) const
  {
    return this->globalId != other.globalId ? this->globalId < other.globalId
                                            : this->key < other.key;
  }
  bool operator<(const Keyed& other) const
  {
    const bool less = this->before(other), greater = other.before(*this);
    // The owner comes first, because its values are used.
    return less || greater         ? less
      : this->own != other.own     ? this->own > other.own
      : this->piece != other.piece ? this->piece < other.piece
                                   : this->id < other.id;
  }
};

bool haveIds(const Pieces& pieces, bool ofPoints)
{
  return std::all_of(pieces.begin(), pieces.end(),
    [ofPoints](vtkDataSet* piece)
    {
      const bool empty =
        ofPoints ? piece->GetNumberOfPoints() == 0 : piece->GetNumberOfCells() == 0;
      return empty ||
        (ofPoints ? piece->GetPointData()->GetGlobalIds() : piece->GetCellData()->GetGlobalIds());
    });
}

/// Gives copies of a point the same number, and records their origins.
/// @return per point of the whole mesh, a number shared by all points at one position or with one
/// id
std::vector<vtkIdType> numberPoints(const Pieces& pieces, WholeMesh& whole, Origins& origins)
{
  std::vector<vtkIdType> places;
  const bool byId = haveIds(pieces, true);
  std::vector<Keyed> all, odd; // odd ones have no position
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    vtkDataSet* piece = pieces[i];
    const std::vector<char> own = ownPoints(piece);
    whole.pieces[i].points.assign(own.size(), -1);
    vtkDataArray* ids = byId ? piece->GetPointData()->GetGlobalIds() : nullptr;
    for (vtkIdType k = 0; k < piece->GetNumberOfPoints(); ++k)
    {
      Vec3 p = { 0, 0, 0 };
      piece->GetPoint(k, p.data());
      const bool finite = std::isfinite(p[0] + p[1] + p[2]);
      p = p + Vec3{ 0, 0, 0 }; // -0 becomes 0
      const auto id = ids ? static_cast<vtkIdType>(ids->GetComponent(k, 0)) : 0;
      (ids || finite ? all : odd)
        .push_back({ ids ? Vec3{ 0, 0, 0 } : p, p, id, static_cast<int>(i), k,
          own[static_cast<std::size_t>(k)] });
    }
  }
  std::sort(all.begin(), all.end());
  PieceCopies copies(pieces);
  for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end)
  {
    std::vector<int> counts(pieces.size(), 0);
    int highest = 0;
    std::size_t origin = begin;
    for (end = begin; end < all.size() && !all[begin].before(all[end]); ++end)
    {
      highest = std::max(highest, all[end].own && !byId ? ++counts[all[end].piece] : 0);
      if (byId && all[end].place != all[begin].place)
      {
        copies.require({ all[begin].piece, all[begin].id }, { all[end].piece, all[end].id });
        // A point with a nonfinite copy is not finite, even if other copies are.
        const Vec3& first = all[origin].place;
        const Vec3& other = all[end].place;
        const bool finite = std::isfinite(first[0] + first[1] + first[2]);
        origin = finite && !std::isfinite(other[0] + other[1] + other[2]) ? end : origin;
      }
    }
    for (std::size_t k = begin; k < end; ++k)
    {
      const bool separate = k == begin || (highest > 1 && all[k].own);
      if (separate)
      {
        const Keyed& from = all[k == begin ? origin : k];
        origins.push_back({ from.piece, from.id });
        places.push_back(static_cast<vtkIdType>(begin));
      }
      const auto number = static_cast<vtkIdType>(origins.size()) - 1;
      whole.pieces[static_cast<std::size_t>(all[k].piece)].points[all[k].id] = number;
    }
  }
  for (const Keyed& point : odd)
  {
    whole.pieces[static_cast<std::size_t>(point.piece)].points[point.id] =
      static_cast<vtkIdType>(origins.size());
    places.push_back(static_cast<vtkIdType>(all.size() + origins.size()));
    origins.push_back({ point.piece, point.id });
  }
  return places;
}

//------------------------------------------------------------------------------
// Numbers of cells

/// The lists that vtkPolyData keeps, in this order; other data sets have one list.
int listOf(int type, bool poly)
{
  switch (type)
  {
    case VTK_VERTEX:
    case VTK_POLY_VERTEX:
      return 0;
    case VTK_LINE:
    case VTK_POLY_LINE:
      return poly ? 1 : 0;
    case VTK_TRIANGLE_STRIP:
      return poly ? 3 : 0;
    default:
      return poly ? 2 : 0;
  }
}

/// The points of all cells in the whole mesh, sorted within each cell; or their positions.
class CellKeys
{
public:
  /// @param places per point of the whole mesh; if null, point numbers are used
  CellKeys(const Pieces& pieces, const WholeMesh& whole, const std::vector<vtkIdType>* places)
  {
    vtkNew<vtkIdList> ids;
    for (std::size_t i = 0; i < pieces.size(); ++i)
    {
      this->First.push_back(this->Begin.size());
      for (vtkIdType cell = 0; cell < pieces[i]->GetNumberOfCells(); ++cell)
      {
        pieces[i]->GetCellPoints(cell, ids);
        this->Begin.push_back(this->Points.size());
        for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k)
        {
          const vtkIdType p = whole.pieces[i].points[static_cast<std::size_t>(ids->GetId(k))];
          this->Points.push_back(places ? (*places)[static_cast<std::size_t>(p)] : p);
        }
        std::sort(this->Points.begin() + static_cast<std::ptrdiff_t>(this->Begin.back()),
          this->Points.end());
      }
    }
    this->Begin.push_back(this->Points.size());
  }

  bool less(const Origin& a, const Origin& b) const
  {
    const auto [from, to] = this->range(a);
    const auto [otherFrom, otherTo] = this->range(b);
    return std::lexicographical_compare(from, to, otherFrom, otherTo);
  }

private:
  using Iterator = std::vector<vtkIdType>::const_iterator;
  std::pair<Iterator, Iterator> range(const Origin& cell) const
  {
    const std::size_t k =
      this->First[static_cast<std::size_t>(cell.piece)] + static_cast<std::size_t>(cell.id);
    return { this->Points.begin() + static_cast<std::ptrdiff_t>(this->Begin[k]),
      this->Points.begin() + static_cast<std::ptrdiff_t>(this->Begin[k + 1]) };
  }

  std::vector<vtkIdType> Points;
  std::vector<std::size_t> Begin, First;
};

/// Gives each ghost the number of the cell with its points, if there is one.
/// @return the other cells
Origins numberGhosts(
  const Origins& ghosts, const Origins& origins, const CellKeys& keys, WholeMesh& whole)
{
  Origins sorted = origins, left;
  std::stable_sort(sorted.begin(), sorted.end(),
    [&](const Origin& a, const Origin& b) { return keys.less(a, b); });
  for (const Origin& ghost : ghosts)
  {
    const auto found = std::lower_bound(sorted.begin(), sorted.end(), ghost,
      [&](const Origin& a, const Origin& b) { return keys.less(a, b); });
    if (found != sorted.end() && !keys.less(ghost, *found))
    {
      whole.pieces[static_cast<std::size_t>(ghost.piece)].cells[ghost.id] =
        whole.pieces[static_cast<std::size_t>(found->piece)].cells[found->id];
    }
    else
    {
      left.push_back(ghost);
    }
  }
  return left;
}

/// @param places of the points, as returned by numberPoints()
void numberCells(
  const Pieces& pieces, const std::vector<vtkIdType>& places, WholeMesh& whole, Origins& origins)
{
  bool byId = haveIds(pieces, false);
  const bool poly = std::all_of(
    pieces.begin(), pieces.end(), [](vtkDataSet* piece) { return piece->IsA("vtkPolyData") != 0; });
  Origins ghosts;
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    whole.pieces[i].cells.assign(static_cast<std::size_t>(pieces[i]->GetNumberOfCells()), -1);
    for (vtkIdType cell = 0; cell < pieces[i]->GetNumberOfCells(); ++cell)
    {
      (isGhost(pieces[i], cell) ? ghosts : origins).push_back({ static_cast<int>(i), cell });
    }
  }
  const CellKeys keys(pieces, whole, nullptr);
  const auto idOf = [&](const Origin& cell)
  {
    return pieces[static_cast<std::size_t>(cell.piece)]
      ->GetCellData()
      ->GetGlobalIds()
      ->GetComponent(cell.id, 0);
  };
  const auto typeOf = [&](const Origin& cell)
  { return pieces[static_cast<std::size_t>(cell.piece)]->GetCellType(cell.id); };
  const auto inOrder = [&](const Origin& a, const Origin& b)
  {
    const int listA = listOf(typeOf(a), poly), listB = listOf(typeOf(b), poly);
    return listA != listB ? listA < listB : byId ? idOf(a) < idOf(b) : keys.less(a, b);
  };
  std::stable_sort(origins.begin(), origins.end(), inOrder);
  // Facets of an extracted surface have the ids of the cells inside.
  const auto ofOneCell = [&](const Origin& a, const Origin& b)
  { return idOf(a) == idOf(b) && (keys.less(a, b) || keys.less(b, a)); };
  if (byId && poly &&
    std::adjacent_find(origins.begin(), origins.end(), ofOneCell) != origins.end())
  {
    byId = false;
    std::stable_sort(origins.begin(), origins.end(), inOrder);
  }
  for (std::size_t c = 0; c < origins.size(); ++c)
  {
    const auto piece = static_cast<std::size_t>(origins[c].piece);
    whole.pieces[piece].cells[static_cast<std::size_t>(origins[c].id)] = static_cast<vtkIdType>(c);
    if (byId && c > 0 && idOf(origins[c]) == idOf(origins[c - 1]) &&
      listOf(typeOf(origins[c]), poly) == listOf(typeOf(origins[c - 1]), poly))
    {
      throw Error("Several cells have the global id " +
        std::to_string(static_cast<vtkIdType>(idOf(origins[c]))) +
        " and are not marked as ghost cells: run Generate Global Ids again.");
    }
  }
  if (!ghosts.empty())
  {
    ghosts = numberGhosts(ghosts, origins, keys, whole);
  }
  // If one process has several parts, points on the seam between them are not merged, and the ghost
  // of a cell uses the points of the other part.
  if (!ghosts.empty())
  {
    numberGhosts(ghosts, origins, CellKeys(pieces, whole, &places), whole);
  }
}

//------------------------------------------------------------------------------
// Images

WholeMesh assembleImage(const Pieces& pieces)
{
  int all[6];
  vtkImageData::SafeDownCast(pieces.front())->GetExtent(all);
  for (vtkDataSet* piece : pieces)
  {
    const int* part = vtkImageData::SafeDownCast(piece)->GetExtent();
    for (int a = 0; a < 3; ++a)
    {
      all[2 * a] = std::min(all[2 * a], part[2 * a]);
      all[2 * a + 1] = std::max(all[2 * a + 1], part[2 * a + 1]);
    }
  }
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->CopyStructure(pieces.front());
  image->SetExtent(all);
  WholeMesh whole;
  whole.mesh = image;
  Origins points(static_cast<std::size_t>(image->GetNumberOfPoints()), { -1, 0 });
  Origins cells(static_cast<std::size_t>(image->GetNumberOfCells()), { -1, 0 });
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    const int* part = vtkImageData::SafeDownCast(pieces[i])->GetExtent();
    whole.pieces.push_back({ idsOfPart(part, all, 0), idsOfPart(part, all, 1) });
    const auto take = [i](const std::vector<vtkIdType>& ids, Origins& origins, auto&& skip)
    {
      for (std::size_t k = 0; k < ids.size(); ++k)
      {
        Origin& origin = origins[static_cast<std::size_t>(ids[k])];
        origin = origin.piece >= 0 || skip(k)
          ? origin
          : Origin{ static_cast<int>(i), static_cast<vtkIdType>(k) };
      }
    };
    take(whole.pieces[i].points, points, [](std::size_t) { return false; });
    take(whole.pieces[i].cells, cells,
      [&](std::size_t k) { return isGhost(pieces[i], static_cast<vtkIdType>(k)); });
  }
  const auto missing = [](const Origin& origin) { return origin.piece < 0; };
  if (std::any_of(points.begin(), points.end(), missing) ||
    std::any_of(cells.begin(), cells.end(), missing))
  {
    throw Error("The pieces of the image leave gaps: gather it on one process first.");
  }
  joinData(pieces, points, cells, image);
  whole.points = std::move(points);
  whole.cells = std::move(cells);
  return whole;
}

//------------------------------------------------------------------------------
/// A single piece is the mesh.
WholeMesh takeSingle(const Pieces& pieces, std::size_t single)
{
  WholeMesh whole;
  whole.pieces.resize(pieces.size());
  whole.mesh = pieces[single];
  auto& [points, cells] = whole.pieces[single];
  points.resize(static_cast<std::size_t>(whole.mesh->GetNumberOfPoints()));
  cells.resize(static_cast<std::size_t>(whole.mesh->GetNumberOfCells()));
  std::iota(points.begin(), points.end(), vtkIdType(0));
  std::iota(cells.begin(), cells.end(), vtkIdType(0));
  for (const vtkIdType id : points)
  {
    whole.points.push_back({ static_cast<int>(single), id });
  }
  for (const vtkIdType id : cells)
  {
    whole.cells.push_back({ static_cast<int>(single), id });
  }
  return whole;
}
}

//------------------------------------------------------------------------------
WholeMesh assemble(const std::vector<vtkDataSet*>& pieces, const WholeMesh* like)
{
  std::vector<std::size_t> filled;
  for (std::size_t i = 0; i < pieces.size(); ++i)
  {
    if (pieces[i]->GetNumberOfPoints() > 0)
    {
      filled.push_back(i);
    }
  }
  if (filled.empty())
  {
    WholeMesh whole;
    whole.pieces.resize(pieces.size());
    whole.mesh = pieces.empty()
      ? vtkSmartPointer<vtkDataSet>(vtkSmartPointer<vtkUnstructuredGrid>::New())
      : vtkSmartPointer<vtkDataSet>(pieces.front());
    return whole;
  }
  if (filled.size() == 1)
  {
    return takeSingle(pieces, filled.front());
  }
  WholeMesh whole;
  std::vector<vtkDataSet*> parts;
  for (const std::size_t i : filled)
  {
    parts.push_back(pieces[i]);
  }
  if (areOneImage(parts))
  {
    whole = assembleImage(parts);
  }
  else if (like)
  {
    whole.pieces = like->pieces;
    whole.points = like->points;
    whole.cells = like->cells;
    parts = pieces;
  }
  else
  {
    whole.pieces.resize(parts.size());
    const std::vector<vtkIdType> places = numberPoints(parts, whole, whole.points);
    numberCells(parts, places, whole, whole.cells);
  }
  if (!whole.mesh)
  {
    std::vector<const std::vector<vtkIdType>*> numbers;
    for (const PieceNumbers& piece : whole.pieces)
    {
      numbers.push_back(&piece.points);
    }
    whole.mesh = buildMesh(parts, whole.points, whole.cells, numbers);
    setPointOrder(whole.mesh, like != nullptr);
  }
  if (parts.size() == pieces.size())
  {
    return whole;
  }
  // Converts back to the numbers of the given pieces.
  std::vector<PieceNumbers> all(pieces.size());
  for (std::size_t k = 0; k < filled.size(); ++k)
  {
    all[filled[k]] = std::move(whole.pieces[k]);
  }
  whole.pieces = std::move(all);
  for (Origins* items : { &whole.points, &whole.cells })
  {
    for (Origin& item : *items)
    {
      item.piece = static_cast<int>(filled[static_cast<std::size_t>(item.piece)]);
    }
  }
  return whole;
}

//------------------------------------------------------------------------------
bool matches(const std::vector<vtkDataSet*>& pieces, const WholeMesh& mesh)
{
  vtkDataArray* wanted = mesh.mesh->GetPointData()->GetGlobalIds();
  bool match = pieces.size() == mesh.pieces.size();
  for (std::size_t i = 0; match && i < pieces.size(); ++i)
  {
    const std::vector<vtkIdType>& points = mesh.pieces[i].points;
    vtkDataArray* ids = pieces[i]->GetPointData()->GetGlobalIds();
    match = pieces[i]->GetNumberOfPoints() == static_cast<vtkIdType>(points.size()) &&
      pieces[i]->GetNumberOfCells() == static_cast<vtkIdType>(mesh.pieces[i].cells.size());
    for (std::size_t p = 0; match && wanted && ids && p < points.size(); ++p)
    {
      match = points[p] < 0 ||
        wanted->GetComponent(points[p], 0) == ids->GetComponent(static_cast<vtkIdType>(p), 0);
    }
  }
  return match;
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkDataSet> extractCells(
  vtkDataSet* mesh, const std::vector<char>& flags, bool loose)
{
  enum Use : char
  {
    Unused,
    Outside,
    Inside
  };
  std::vector<char> use(static_cast<std::size_t>(mesh->GetNumberOfPoints()), Unused);
  Origins points, cells;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < mesh->GetNumberOfCells(); ++cell)
  {
    const char state = flags[static_cast<std::size_t>(cell)] ? Inside : Outside;
    mesh->GetCellPoints(cell, ids);
    for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k)
    {
      char& point = use[static_cast<std::size_t>(ids->GetId(k))];
      point = std::max(point, state);
    }
    if (state == Inside)
    {
      cells.push_back({ 0, cell });
    }
  }
  std::vector<vtkIdType> numbers(use.size(), -1);
  for (std::size_t k = 0; k < use.size(); ++k)
  {
    if (use[k] == Inside || (loose && use[k] == Unused))
    {
      numbers[k] = static_cast<vtkIdType>(points.size());
      points.push_back({ 0, static_cast<vtkIdType>(k) });
    }
  }
  return buildMesh({ mesh }, points, cells, { &numbers });
}
}
