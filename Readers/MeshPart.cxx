// SPDX-License-Identifier: BSD-3-Clause
#include "MeshPart.h"

#include "ArrayIndex.h"

#include <algorithm>
#include <array>
#include <limits>

namespace tautline
{
namespace
{
constexpr unsigned char Duplicate = 1; // vtkDataSetAttributes::DUPLICATECELL and DUPLICATEPOINT

/// A cell and its center along an axis; cells at the same position are ordered by their numbers.
using PlacedCell = std::pair<double, Index>;

/// The mean of a cell's nodes along an axis.
double centre(const MeshFile& mesh, Index cell, int axis)
{
  double sum = 0.0;
  const Index begin = mesh.offsets[at(cell)], end = mesh.offsets[at(cell) + 1];
  for (Index i = begin; i < end; ++i)
  {
    sum += mesh.points[at(3 * mesh.connectivity[at(i)] + axis)];
  }
  return sum / static_cast<double>(std::max<Index>(end - begin, 1));
}

using PlacedCells = std::vector<PlacedCell>::iterator;

/// The axis with the largest extent of the cell centers.
int longestAxis(const MeshFile& mesh, PlacedCells begin, PlacedCells end)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::array<double, 3> low{ infinity, infinity, infinity };
  std::array<double, 3> high{ -infinity, -infinity, -infinity };
  for (auto cell = begin; cell != end; ++cell)
  {
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      const double place = centre(mesh, cell->second, static_cast<int>(axis));
      low[axis] = std::min(low[axis], place);
      high[axis] = std::max(high[axis], place);
    }
  }
  int longest = 0;
  for (int axis = 1; axis < 3; ++axis)
  {
    const auto a = static_cast<std::size_t>(axis), l = static_cast<std::size_t>(longest);
    longest = high[a] - low[a] > high[l] - low[l] ? axis : longest;
  }
  return longest;
}

/// Divides the cells of `parts` parts into the cells of the first parts / 2 parts and the others,
/// which begin at the result.
PlacedCells halve(const MeshFile& mesh, PlacedCells begin, PlacedCells end, int parts)
{
  const int axis = longestAxis(mesh, begin, end);
  for (auto cell = begin; cell != end; ++cell)
  {
    cell->first = centre(mesh, cell->second, axis);
  }
  const auto cells = static_cast<std::size_t>(end - begin);
  const auto cut = begin +
    static_cast<std::ptrdiff_t>(
      cells * static_cast<std::size_t>(parts / 2) / static_cast<std::size_t>(parts));
  std::nth_element(begin, cut, end);
  return cut;
}

std::vector<PlacedCell> allCells(const MeshFile& mesh)
{
  std::vector<PlacedCell> cells(mesh.cellTypes.size());
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    cells[i].second = static_cast<Index>(i);
  }
  return cells;
}

/// The cells of a part, in the order of the file. Only the halves that contain the part are divided
/// further.
std::vector<Index> ownCells(const MeshFile& mesh, int part, int parts)
{
  std::vector<PlacedCell> cells = allCells(mesh);
  auto begin = cells.begin(), end = cells.end();
  while (parts > 1)
  {
    const auto cut = halve(mesh, begin, end, parts);
    const int lowParts = parts / 2;
    const bool low = part < lowParts;
    (low ? end : begin) = cut;
    part -= low ? 0 : lowParts;
    parts = low ? lowParts : parts - lowParts;
  }
  std::vector<Index> result(static_cast<std::size_t>(end - begin));
  std::transform(begin, end, result.begin(), [](const PlacedCell& cell) { return cell.second; });
  std::sort(result.begin(), result.end());
  return result;
}

/// Assigns parts, numbered from `first`, to the cells.
void divide(const MeshFile& mesh, PlacedCells begin, PlacedCells end, int first, int parts,
  std::vector<int>& partOfCell)
{
  if (parts == 1)
  {
    std::for_each(begin, end, [&](const PlacedCell& cell) { partOfCell[at(cell.second)] = first; });
    return;
  }
  const auto cut = halve(mesh, begin, end, parts);
  divide(mesh, begin, cut, first, parts / 2, partOfCell);
  divide(mesh, cut, end, first + parts / 2, parts - parts / 2, partOfCell);
}

/// Sets the flag of each node of some cells.
void markNodes(const MeshFile& mesh, const std::vector<Index>& cells, std::vector<char>& marked)
{
  for (const Index cell : cells)
  {
    for (Index i = mesh.offsets[at(cell)]; i < mesh.offsets[at(cell) + 1]; ++i)
    {
      marked[at(mesh.connectivity[at(i)])] = 1;
    }
  }
}

/// The cells of other parts within several layers, in the order of the file.
std::vector<Index> ghostCells(
  const MeshFile& mesh, const std::vector<Index>& own, std::vector<char> reached, int layers)
{
  std::vector<char> taken(mesh.cellTypes.size());
  for (const Index cell : own)
  {
    taken[at(cell)] = 1;
  }
  std::vector<Index> ghosts;
  for (int layer = 0; layer < layers; ++layer)
  {
    std::vector<Index> found;
    for (std::size_t cell = 0; cell < taken.size(); ++cell)
    {
      const auto begin = mesh.connectivity.begin() + mesh.offsets[cell];
      const auto end = mesh.connectivity.begin() + mesh.offsets[cell + 1];
      if (!taken[cell] && std::any_of(begin, end, [&](Index p) { return reached[at(p)] != 0; }))
      {
        found.push_back(static_cast<Index>(cell));
        taken[cell] = 1;
      }
    }
    markNodes(mesh, found, reached);
    ghosts.insert(ghosts.end(), found.begin(), found.end());
  }
  std::sort(ghosts.begin(), ghosts.end());
  return ghosts;
}

/// The tuples of an array in the order of `ids`.
MeshArray gather(const MeshArray& array, const std::vector<Index>& ids)
{
  MeshArray result{ array.name, array.components, {} };
  std::visit(
    [&](const auto& from)
    {
      std::decay_t<decltype(from)> to;
      const auto width = static_cast<std::ptrdiff_t>(array.components);
      to.reserve(ids.size() * static_cast<std::size_t>(width));
      for (const Index id : ids)
      {
        to.insert(to.end(), from.begin() + id * width, from.begin() + (id + 1) * width);
      }
      result.values = std::move(to);
    },
    array.values);
  return result;
}

/// Replaces the array of the same name, or appends it.
void setArray(std::vector<MeshArray>& arrays, MeshArray array)
{
  arrays.erase(std::remove_if(arrays.begin(), arrays.end(),
                 [&](const MeshArray& other) { return other.name == array.name; }),
    arrays.end());
  arrays.push_back(std::move(array));
}

/// The arrays of the chosen points or cells; `own` flags items that are not ghosts.
template <class Own>
std::vector<MeshArray> partArrays(const std::vector<MeshArray>& arrays,
  const std::vector<Index>& ids, const char* idName, bool withGhosts, const Own& own)
{
  std::vector<MeshArray> result;
  for (const MeshArray& array : arrays)
  {
    result.push_back(gather(array, ids));
  }
  setArray(result, { idName, 1, MeshArray::Integers(ids) });
  if (withGhosts)
  {
    MeshArray::Bytes flags(ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i)
    {
      flags[i] = own(i) ? 0 : Duplicate;
    }
    setArray(result, { PartGhosts, 1, std::move(flags) });
  }
  return result;
}
}

//------------------------------------------------------------------------------
std::vector<int> partsOfCells(const MeshFile& mesh, int parts)
{
  std::vector<int> result(mesh.cellTypes.size());
  std::vector<PlacedCell> cells = allCells(mesh);
  divide(mesh, cells.begin(), cells.end(), 0, parts, result);
  return result;
}

//------------------------------------------------------------------------------
MeshFile partOf(const MeshFile& mesh, const PartRequest& request)
{
  std::vector<Index> cells = ownCells(mesh, request.part, request.parts);
  const std::size_t owned = cells.size();
  std::vector<char> ownPoint(at(mesh.numberOfPoints()));
  markNodes(mesh, cells, ownPoint);
  std::vector<char> used = ownPoint;
  if (request.ghostLayers > 0)
  {
    const std::vector<Index> ghosts = ghostCells(mesh, cells, ownPoint, request.ghostLayers);
    markNodes(mesh, ghosts, used);
    cells.insert(cells.end(), ghosts.begin(), ghosts.end());
  }
  if (request.part == 0)
  {
    std::vector<char> anywhere(used.size());
    for (const Index point : mesh.connectivity)
    {
      anywhere[at(point)] = 1;
    }
    for (std::size_t point = 0; point < used.size(); ++point)
    {
      used[point] = used[point] || !anywhere[point];
      ownPoint[point] = ownPoint[point] || !anywhere[point];
    }
  }

  MeshFile part;
  std::vector<Index> points, place(used.size(), -1);
  for (std::size_t point = 0; point < used.size(); ++point)
  {
    if (used[point])
    {
      place[point] = static_cast<Index>(points.size());
      points.push_back(static_cast<Index>(point));
      part.points.insert(part.points.end(), &mesh.points[3 * point], &mesh.points[3 * point] + 3);
    }
  }
  for (const Index cell : cells)
  {
    part.cellTypes.push_back(mesh.cellTypes[at(cell)]);
    for (Index i = mesh.offsets[at(cell)]; i < mesh.offsets[at(cell) + 1]; ++i)
    {
      part.connectivity.push_back(place[at(mesh.connectivity[at(i)])]);
    }
    part.offsets.push_back(static_cast<Index>(part.connectivity.size()));
  }
  const bool withGhosts = request.ghostLayers > 0;
  part.pointArrays = partArrays(mesh.pointArrays, points, PartPointIds, withGhosts,
    [&](std::size_t i) { return ownPoint[at(points[i])] != 0; });
  part.cellArrays = partArrays(
    mesh.cellArrays, cells, PartCellIds, withGhosts, [&](std::size_t i) { return i < owned; });
  part.fieldArrays = mesh.fieldArrays;
  part.fieldStrings = mesh.fieldStrings;
  part.warnings = mesh.warnings;
  return part;
}
}
