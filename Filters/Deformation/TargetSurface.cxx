// SPDX-License-Identifier: BSD-3-Clause
#include "TargetSurface.h"

#include "TargetMatch.h"
#include "WholeMesh.h"
#include "tautline/Core/RankGroup.h"

#include "vtkCellData.h"
#include "vtkDataSet.h"
#include "vtkDataSetSurfaceFilter.h"
#include "vtkDoubleArray.h"
#include "vtkGenericCell.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>

namespace tautline
{
namespace
{
constexpr const char* KeyArray = "tautline keys";
constexpr int Unknown = -1;

/// Compares numbers bit by bit, so that those that are NaN have a place in the order, too.
int compareBits(const double* a, const double* b, std::size_t count)
{
  return std::memcmp(a, b, count * sizeof(double));
}

/// Cells of a process, to be sent.
struct CellList
{
  std::vector<double> places, keys; ///< 3 per point; points with the same key are one
  std::vector<unsigned char> types;
  std::vector<Index> sizes, nodes;
  Index facets = 0; ///< the first cells are facets of others: two of two processes are none

  void add(vtkDataSet* cells)
  {
    const auto first = static_cast<Index>(this->places.size() / 3);
    vtkDataArray* given = cells->GetPointData()->GetArray(KeyArray);
    for (vtkIdType p = 0; p < cells->GetNumberOfPoints(); ++p)
    {
      Vec3 place, key;
      cells->GetPoint(p, place.data());
      key = place;
      if (given)
      {
        given->GetTuple(p, key.data());
      }
      key = key + Vec3{ 0, 0, 0 }; // -0 becomes 0
      this->places.insert(this->places.end(), place.begin(), place.end());
      this->keys.insert(this->keys.end(), key.begin(), key.end());
    }
    vtkNew<vtkIdList> ids;
    for (vtkIdType cell = 0; cell < cells->GetNumberOfCells(); ++cell)
    {
      cells->GetCellPoints(cell, ids);
      this->types.push_back(static_cast<unsigned char>(cells->GetCellType(cell)));
      this->sizes.push_back(ids->GetNumberOfIds());
      for (const vtkIdType id : *ids)
      {
        this->nodes.push_back(first + id);
      }
    }
  }
};

/// Per cell of a piece its dimension; of ghost cells Unknown.
std::vector<int> dimensionsOf(vtkDataSet* piece)
{
  std::array<int, VTK_NUMBER_OF_CELL_TYPES> known;
  known.fill(Unknown);
  vtkUnsignedCharArray* ghosts = piece->GetCellGhostArray();
  std::vector<int> dimensions(piece->GetNumberOfCells(), Unknown);
  for (vtkIdType cell = 0; cell < piece->GetNumberOfCells(); ++cell)
  {
    if (ghosts && (ghosts->GetValue(cell) & vtkDataSetAttributes::DUPLICATECELL) != 0)
    {
      continue;
    }
    int& dimension = known[static_cast<std::size_t>(piece->GetCellType(cell))];
    dimension = dimension == Unknown ? piece->GetCell(cell)->GetCellDimension() : dimension;
    dimensions[cell] = dimension;
  }
  return dimensions;
}

/// The points and cells of a piece with the keys of its points.
vtkSmartPointer<vtkDataSet> keyed(vtkDataSet* piece, bool byIds)
{
  auto copy = vtkSmartPointer<vtkDataSet>::Take(piece->NewInstance());
  copy->CopyStructure(piece);
  if (byIds)
  {
    vtkNew<vtkDoubleArray> keys;
    keys->SetName(KeyArray);
    keys->SetNumberOfComponents(3);
    for (vtkIdType p = 0; p < piece->GetNumberOfPoints(); ++p)
    {
      keys->InsertNextTuple3(piece->GetPointData()->GetGlobalIds()->GetComponent(p, 0), 0, 0);
    }
    copy->GetPointData()->AddArray(keys);
  }
  return copy;
}

/// What a piece has of the surface; facets at seams, too.
CellList cellsOf(
  vtkDataSet* piece, const std::vector<int>& dimensions, int dimension, int expected, bool byIds)
{
  CellList list;
  const auto source = keyed(piece, byIds);
  std::vector<char> top(dimensions.size()), rest(dimensions.size());
  for (std::size_t cell = 0; cell < dimensions.size(); ++cell)
  {
    top[cell] = dimensions[cell] == dimension;
    rest[cell] = dimensions[cell] != Unknown && !top[cell];
  }
  const auto has = [](const std::vector<char>& flags)
  { return std::find(flags.begin(), flags.end(), 1) != flags.end(); };
  if (dimension == expected)
  {
    std::transform(top.begin(), top.end(), rest.begin(), top.begin(), std::logical_or<>());
    list.add(extractCells(source, top, false));
    return list;
  }
  const bool edges = dimension == 2;
  if (has(top))
  {
    const auto skin = skinOf(extractCells(source, top, false));
    list.add(edges ? rimOf(skin) : skin);
    list.facets = static_cast<Index>(list.types.size());
  }
  if (!edges && has(rest)) // the surface of the whole has these cells, too
  {
    list.add(skinOf(extractCells(source, rest, false)));
  }
  return list;
}

/// Cells of all processes.
class CellsOfAll
{
public:
  CellsOfAll(RankGroup& group, CellList own)
  {
    this->collect(group, own.places, this->All.places);
    this->collect(group, own.keys, this->All.keys);
    this->collect(group, own.types, this->All.types);
    this->collect(group, own.sizes, this->All.sizes);
    const std::vector<std::vector<Index>> facets =
      group.gatherItems(std::vector<Index>{ own.facets });
    const std::vector<std::vector<Index>> counts = group.gatherItems(std::vector<Index>{
      static_cast<Index>(own.types.size()), static_cast<Index>(own.places.size() / 3) });
    Index points = 0;
    for (std::size_t rank = 0; rank < counts.size(); ++rank)
    {
      for (Index cell = 0; cell < counts[rank][0]; ++cell)
      {
        this->RankOf.push_back(cell < facets[rank][0] ? static_cast<int>(rank) : Unknown);
      }
      this->FirstPoint.push_back(points);
      points += counts[rank][1];
    }
    const std::vector<std::vector<Index>> nodes = group.gatherItems(own.nodes);
    for (std::size_t rank = 0; rank < nodes.size(); ++rank)
    {
      for (const Index node : nodes[rank])
      {
        this->All.nodes.push_back(this->FirstPoint[rank] + node);
      }
    }
  }

  /// The cells but for facets that two processes have. Not collective.
  vtkSmartPointer<vtkUnstructuredGrid> unite()
  {
    this->number();
    const std::vector<char> inside = this->inside();
    auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    std::vector<vtkIdType> numbers(this->Numbers.size(), -1); // of those that are used
    vtkNew<vtkIdList> ids;
    Index at = 0;
    for (std::size_t cell = 0; cell < this->All.sizes.size(); ++cell)
    {
      const Index size = this->All.sizes[cell];
      ids->Reset();
      for (Index k = 0; k < size && !inside[cell]; ++k)
      {
        const Index node = this->All.nodes[at + k];
        vtkIdType& number = numbers[this->Numbers[node]];
        number = number < 0 ? points->InsertNextPoint(&this->All.places[3 * node]) : number;
        ids->InsertNextId(number);
      }
      at += size;
      if (!inside[cell])
      {
        grid->InsertNextCell(this->All.types[cell], ids);
      }
    }
    grid->SetPoints(points);
    return grid;
  }

private:
  template <class Item>
  static void collect(RankGroup& group, std::vector<Item>& own, std::vector<Item>& all)
  {
    for (const std::vector<Item>& list : group.gatherItems(own))
    {
      all.insert(all.end(), list.begin(), list.end());
    }
  }

  /// Gives points with the same key one number.
  void number()
  {
    std::vector<Index> order(this->All.keys.size() / 3);
    std::iota(order.begin(), order.end(), Index(0));
    const double* keys = this->All.keys.data();
    const auto compare = [keys](Index a, Index b)
    { return compareBits(keys + 3 * a, keys + 3 * b, 3); };
    std::sort(order.begin(), order.end(),
      [&compare](Index a, Index b)
      {
        const int result = compare(a, b);
        return result != 0 ? result < 0 : a < b;
      });
    this->Numbers.resize(order.size());
    for (std::size_t k = 0; k < order.size(); ++k)
    {
      const bool same = k > 0 && compare(order[k - 1], order[k]) == 0;
      this->Numbers[order[k]] = same ? this->Numbers[order[k - 1]] : order[k];
    }
  }

  /// One flag per cell: a facet between cells of two processes.
  std::vector<char> inside() const
  {
    std::vector<Index> begin, nodes, facets;
    Index at = 0;
    for (std::size_t cell = 0; cell < this->All.sizes.size(); ++cell)
    {
      begin.push_back(at);
      for (Index k = 0; k < this->All.sizes[cell]; ++k, ++at)
      {
        nodes.push_back(this->Numbers[this->All.nodes[at]]);
      }
      std::sort(nodes.begin() + begin.back(), nodes.end());
      if (this->RankOf[cell] != Unknown)
      {
        facets.push_back(static_cast<Index>(cell));
      }
    }
    begin.push_back(at);
    const auto less = [&](Index a, Index b)
    {
      return std::lexicographical_compare(nodes.begin() + begin[a], nodes.begin() + begin[a + 1],
        nodes.begin() + begin[b], nodes.begin() + begin[b + 1]);
    };
    std::sort(facets.begin(), facets.end(), less);
    std::vector<char> result(this->All.sizes.size(), 0);
    for (std::size_t from = 0, to = 0; from < facets.size(); from = to)
    {
      for (to = from + 1; to < facets.size() && !less(facets[from], facets[to]); ++to)
      {
      }
      // Two of one process are a crack in its piece.
      if (to == from + 2 && this->RankOf[facets[from]] != this->RankOf[facets[from + 1]])
      {
        result[facets[from]] = result[facets[from + 1]] = 1;
      }
    }
    return result;
  }

  CellList All;
  std::vector<int> RankOf; ///< per cell, of a facet; else Unknown
  std::vector<Index> FirstPoint;
  std::vector<Index> Numbers; ///< per point, of the first with its key
};
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkDataSet> targetSurfaceOnAll(RankGroup& group, vtkDataSet* piece, bool ofVolume)
{
  const bool here = piece && piece->GetNumberOfPoints() > 0;
  const bool byIds = !group.any(here && !piece->GetPointData()->GetGlobalIds());
  std::vector<int> dimensions;
  int dimension = Unknown;
  group.together(
    [&]
    {
      dimensions = here ? dimensionsOf(piece) : std::vector<int>();
      for (const int one : dimensions)
      {
        dimension = std::max(dimension, one);
      }
    });
  dimension = static_cast<int>(group.maximum(static_cast<Index>(dimension)));
  requireSurface(dimension, ofVolume);
  CellList own;
  group.together(
    [&]
    {
      if (here)
      {
        own = cellsOf(piece, dimensions, dimension, ofVolume ? 2 : 1, byIds);
      }
      dimensions = {};
    });
  CellsOfAll all(group, std::move(own));
  vtkSmartPointer<vtkDataSet> result;
  group.together(
    [&]
    {
      result = all.unite();
      if (!ofVolume && dimension == 3)
      {
        result = rimOf(skinOf(result));
      }
    });
  return result;
}
}
