// SPDX-License-Identifier: BSD-3-Clause
#include "MeshPart.h"

#include <algorithm>
#include <array>
#include <limits>

namespace tautline
{
namespace
{
/// A cell and its centre along an axis; cells at the same place are ordered by their numbers.
using PlacedCell = std::pair<double, Index>;

/// The mean of a cell's nodes along an axis.
double centre(const MeshFile& mesh, Index cell, int axis)
{
  const Index* nodes = mesh.connectivity.data();
  return cellCentre(
    mesh.points, nodes + mesh.offsets[at(cell)], nodes + mesh.offsets[at(cell) + 1], axis);
}

/// The axis along which the centres of the cells are spread farthest.
int widestAxis(const MeshFile& mesh, const std::vector<PlacedCell>& cells)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::array<double, 3> low{ infinity, infinity, infinity };
  std::array<double, 3> high{ -infinity, -infinity, -infinity };
  for (const PlacedCell& cell : cells)
  {
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      const double place = centre(mesh, cell.second, static_cast<int>(axis));
      low[axis] = std::min(low[axis], place);
      high[axis] = std::max(high[axis], place);
    }
  }
  return longestAxis(low, high);
}

/// The cells of a part, in the order of the file. Only the halves that contain the part are divided
/// further.
std::vector<Index> ownCells(const MeshFile& mesh, int part, int parts)
{
  std::vector<PlacedCell> cells(mesh.cellTypes.size());
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    cells[i].second = static_cast<Index>(i);
  }
  while (parts > 1)
  {
    const int axis = widestAxis(mesh, cells);
    for (PlacedCell& cell : cells)
    {
      cell.first = centre(mesh, cell.second, axis);
    }
    const auto [lowParts, cut] = PartHalves(parts, static_cast<Index>(cells.size()));
    std::nth_element(cells.begin(), cells.begin() + cut, cells.end());
    if (part < lowParts)
    {
      cells.erase(cells.begin() + cut, cells.end());
      parts = lowParts;
    }
    else
    {
      cells.erase(cells.begin(), cells.begin() + cut);
      part -= lowParts;
      parts -= lowParts;
    }
  }
  std::vector<Index> result(cells.size());
  std::transform(
    cells.begin(), cells.end(), result.begin(), [](const PlacedCell& cell) { return cell.second; });
  std::sort(result.begin(), result.end());
  return result;
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

/// The cells of other parts within some layers, in the order of the file.
std::vector<Index> cellsAround(
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
}

//------------------------------------------------------------------------------
int longestAxis(const std::array<double, 3>& low, const std::array<double, 3>& high)
{
  std::size_t longest = 0;
  for (std::size_t axis = 1; axis < 3; ++axis)
  {
    longest = high[axis] - low[axis] > high[longest] - low[longest] ? axis : longest;
  }
  return static_cast<int>(longest);
}

//------------------------------------------------------------------------------
MeshArray gatherTuples(const MeshArray& array, const std::vector<Index>& ids)
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

//------------------------------------------------------------------------------
void addPartArrays(std::vector<MeshArray>& arrays, const char* idName, std::vector<Index> ids,
  std::optional<MeshArray::Bytes> ghosts)
{
  const auto set = [&](MeshArray array)
  {
    arrays.erase(std::remove_if(arrays.begin(), arrays.end(),
                   [&](const MeshArray& other) { return other.name == array.name; }),
      arrays.end());
    arrays.push_back(std::move(array));
  };
  set({ idName, 1, MeshArray::Integers(std::move(ids)) });
  if (ghosts)
  {
    set({ PartGhosts, 1, std::move(*ghosts) });
  }
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
    const std::vector<Index> ghosts = cellsAround(mesh, cells, ownPoint, request.ghostLayers);
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
  std::optional<MeshArray::Bytes> ghostPoints, ghostCells;
  if (request.ghostLayers > 0)
  {
    ghostPoints.emplace();
    for (const Index point : points)
    {
      ghostPoints->push_back(ghostFlag(!ownPoint[at(point)]));
    }
    ghostCells.emplace(cells.size(), ghostFlag(true));
    std::fill_n(ghostCells->begin(), owned, ghostFlag(false));
  }
  for (const MeshArray& array : mesh.pointArrays)
  {
    part.pointArrays.push_back(gatherTuples(array, points));
  }
  for (const MeshArray& array : mesh.cellArrays)
  {
    part.cellArrays.push_back(gatherTuples(array, cells));
  }
  addPartArrays(part.pointArrays, PartPointIds, std::move(points), std::move(ghostPoints));
  addPartArrays(part.cellArrays, PartCellIds, std::move(cells), std::move(ghostCells));
  part.fieldArrays = mesh.fieldArrays;
  part.fieldStrings = mesh.fieldStrings;
  part.warnings = mesh.warnings;
  return part;
}
}
