// SPDX-License-Identifier: BSD-3-Clause
#include "FollowingNodes.h"

#include "FacetTable.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Elements/ElementType.h"

#include <algorithm>
#include <functional>
#include <map>
#include <tuple>

namespace tautline
{
namespace
{
using Columns = std::array<Vec3, 3>;

/// Shape functions below this are 0 up to rounding.
constexpr double Nothing = 1e-9;

/// An element with the corners of another one.
ElementType straightElement(const ElementType& curved, int corners)
{
  const std::vector<Vec3>& all = curved.coordinates();
  return ElementType(
    curved.shape(), { 1, 1, 1 }, std::vector<Vec3>(all.begin(), all.begin() + corners));
}

/// Derivatives with respect to the reference coordinates; for a surface, the third is the unit
/// normal.
double complete(Columns& columns, int dimension)
{
  if (dimension == 2)
  {
    const Vec3 normal = cross(columns[0], columns[1]);
    const double size = norm(normal);
    columns[2] = (size > 0 ? 1 / size : 0.0) * normal;
    return size;
  }
  return std::abs(dot(columns[0], cross(columns[1], columns[2])));
}

/// B A^-1 v
Vec3 mapped(const Columns& a, const Columns& b, const Vec3& v)
{
  // Cramer's rule.
  const double det = dot(a[0], cross(a[1], a[2]));
  return (dot(cross(a[1], a[2]), v) / det) * b[0] + (dot(cross(a[2], a[0]), v) / det) * b[1] +
    (dot(cross(a[0], a[1]), v) / det) * b[2];
}

Vec3 at(const double* points, Index point)
{
  return { points[3 * point], points[3 * point + 1], points[3 * point + 2] };
}
}

//------------------------------------------------------------------------------
FollowingNodes::FollowingNodes(
  const Mesh& mesh, const double* degrees, const std::vector<Index>& representative)
  : KindOfCell(static_cast<std::size_t>(mesh.view().numberOfCells), -1)
  , Offsets(mesh.view().offsets, mesh.view().offsets + mesh.view().numberOfCells + 1)
  , Boundary(static_cast<std::size_t>(mesh.view().numberOfPoints), 0)
{
  const MeshView& view = mesh.view();
  this->Connectivity.assign(
    view.connectivity, view.connectivity + view.offsets[view.numberOfCells]);
  this->findKinds(mesh, degrees);
  this->mergeNodes(mesh, representative);
  MeshView merged = view;
  merged.offsets = this->Offsets.data();
  merged.connectivity = this->Connectivity.data();
  const Mesh one(merged);
  this->findUses(one);
  this->findBoundary(one);
}

//------------------------------------------------------------------------------
void FollowingNodes::findKinds(const Mesh& mesh, const double* degrees)
{
  const MeshView& view = mesh.view();
  std::map<std::tuple<int, Index, ElementOrders>, int> known;
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    pollInterruption(cell);
    const int vtkType = view.cellTypes[cell];
    const Index nodes = view.offsets[cell + 1] - view.offsets[cell];
    if (!isHigherOrder(vtkType))
    {
      continue;
    }
    const CellTopology& t = topology(cornerType(vtkType));
    ElementOrders orders = { 0, 0, 0 };
    for (std::size_t axis = 0; degrees && axis < orders.size(); ++axis)
    {
      const double degree = degrees[3 * cell + static_cast<Index>(axis)];
      orders[axis] = degree >= 1 && degree <= MaxElementOrder ? static_cast<int>(degree) : 0;
    }
    const auto [entry, added] =
      known.try_emplace({ vtkType, nodes, orders }, static_cast<int>(this->Kinds.size()));
    this->KindOfCell[cell] = entry->second;
    if (!added)
    {
      continue;
    }
    // Orders that do not match the number of nodes are ignored, as for special node counts.
    const ElementType* type = nullptr;
    try
    {
      type = &ElementType::ofVtk(vtkType, static_cast<int>(nodes), orders);
    }
    catch (const Error&)
    {
      type = &ElementType::ofVtk(vtkType, static_cast<int>(nodes));
    }
    const ElementType straight = straightElement(*type, t.nodes);
    Kind kind;
    kind.dimension = t.dimension;
    kind.corners = t.nodes;
    for (int node = t.nodes; node < type->nodes(); ++node)
    {
      const Vec3 where = type->coordinates()[node];
      Place place;
      place.value = straight.shapeFunctions(where);
      for (int d = 0; d < t.dimension; ++d)
      {
        // The functions are linear in each coordinate, so differences are exact.
        Vec3 low = where, high = where;
        low[d] -= 0.5;
        high[d] += 0.5;
        const std::vector<double> less = straight.shapeFunctions(low);
        place.derivative[d] = straight.shapeFunctions(high);
        std::transform(place.derivative[d].begin(), place.derivative[d].end(), less.begin(),
          place.derivative[d].begin(), std::minus<>());
      }
      kind.places.push_back(std::move(place));
    }
    this->Kinds.push_back(std::move(kind));
  }
}

//------------------------------------------------------------------------------
/// Calls visit(corner, value of its function) for the corners that determine the position of a
/// node.
template <class Visit>
void FollowingNodes::forEachCorner(const Use& use, const Visit& visit) const
{
  const std::vector<double>& value = this->placeOf(use).value;
  for (std::size_t k = 0; k < value.size(); ++k)
  {
    if (std::abs(value[k]) > Nothing)
    {
      visit(this->Connectivity[this->Offsets[use.cell] + static_cast<Index>(k)], value[k]);
    }
  }
}

//------------------------------------------------------------------------------
void FollowingNodes::mergeNodes(const Mesh& mesh, const std::vector<Index>& representative)
{
  if (representative.empty())
  {
    return;
  }
  const MeshView& view = mesh.view();
  // Corners first: nodes are merged if the corners between which they lie are merged.
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const int kind = this->KindOfCell[cell];
    const Index end =
      kind < 0 ? this->Offsets[cell + 1] : this->Offsets[cell] + this->Kinds[kind].corners;
    for (Index k = this->Offsets[cell]; k < end; ++k)
    {
      this->Connectivity[k] = representative[this->Connectivity[k]];
    }
  }
  std::map<std::pair<Vec3, std::vector<Index>>, Index> first;
  std::vector<Index> one(static_cast<std::size_t>(view.numberOfPoints), -1);
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    pollInterruption(cell);
    const int kind = this->KindOfCell[cell];
    const int nodes = kind < 0 ? 0 : static_cast<int>(this->Kinds[kind].places.size());
    for (int node = 0; node < nodes; ++node)
    {
      Index& point = this->Connectivity[this->Offsets[cell] + this->Kinds[kind].corners + node];
      if (one[point] < 0)
      {
        std::vector<Index> corners;
        this->forEachCorner(
          { cell, node }, [&](Index corner, double) { corners.push_back(corner); });
        std::sort(corners.begin(), corners.end());
        one[point] = first.emplace(std::pair(pointOf(view, point), corners), point).first->second;
        if (one[point] != point)
        {
          this->Copies.push_back({ point, one[point] });
        }
      }
      point = one[point];
    }
  }
}

//------------------------------------------------------------------------------
void FollowingNodes::findUses(const Mesh& mesh)
{
  const MeshView& view = mesh.view();
  // 0: no cell; -1: a corner of a cell, even if it is the middle of an edge in other cells;
  // otherwise the highest dimension of its cells.
  std::vector<signed char> dimension(static_cast<std::size_t>(view.numberOfPoints), 0);
  const auto forEachNode = [&](const auto& visit)
  {
    for (Index cell = 0; cell < view.numberOfCells; ++cell)
    {
      pollInterruption(cell);
      const int kind = this->KindOfCell[cell];
      const int nodes = kind < 0 ? 0 : static_cast<int>(this->Kinds[kind].places.size());
      for (int node = 0; node < nodes; ++node)
      {
        visit(this->Connectivity[this->Offsets[cell] + this->Kinds[kind].corners + node],
          Use{ cell, node }, this->Kinds[kind].dimension);
      }
    }
  };
  forEachNode([&](Index point, const Use&, int cells)
    { dimension[point] = std::max(dimension[point], static_cast<signed char>(cells)); });
  for (const CellBlock& block : mesh.blocks())
  {
    const int corners = topology(block.type).nodes;
    for (Index i = 0; i < block.count; ++i)
    {
      const Index first = view.offsets[block.cell(i)];
      for (Index k = first; k < first + corners; ++k)
      {
        dimension[view.connectivity[k]] = -1;
      }
    }
  }
  std::vector<Index> place(dimension.size(), -1);
  for (std::size_t point = 0; point < dimension.size(); ++point)
  {
    if (dimension[point] > 0)
    {
      place[point] = static_cast<Index>(this->Points.size());
      this->Points.push_back(static_cast<Index>(point));
    }
  }
  this->UseOffsets.assign(this->Points.size() + 1, 0);
  const auto counts = [&](Index point, int cells)
  { return place[point] >= 0 && dimension[point] == cells; };
  forEachNode(
    [&](Index point, const Use&, int cells)
    {
      if (counts(point, cells))
      {
        ++this->UseOffsets[place[point] + 1];
      }
    });
  std::partial_sum(this->UseOffsets.begin(), this->UseOffsets.end(), this->UseOffsets.begin());
  std::vector<Index> next(this->UseOffsets.begin(), this->UseOffsets.end() - 1);
  this->Uses.resize(static_cast<std::size_t>(this->UseOffsets.back()));
  forEachNode(
    [&](Index point, const Use& use, int cells)
    {
      if (counts(point, cells))
      {
        this->Uses[next[place[point]]++] = use;
      }
    });
}

//------------------------------------------------------------------------------
void FollowingNodes::findBoundary(const Mesh& mesh)
{
  std::vector<unsigned char> follows(this->Boundary.size(), 0);
  for (Index point : this->Points)
  {
    follows[point] = 1;
  }
  FacetTable(mesh).forEachFacet(
    [&](Index smallest, const FacetUse* uses, Index count)
    {
      const int kind = this->KindOfCell[uses->cell];
      if (count == 2 || kind < 0)
      {
        return;
      }
      const auto onFacet = [&](Index corner)
      {
        return corner == smallest ||
          std::find(uses->others.begin(), uses->others.end(), corner) != uses->others.end();
      };
      const int nodes = static_cast<int>(this->Kinds[kind].places.size());
      for (int node = 0; node < nodes; ++node)
      {
        bool on = true;
        this->forEachCorner(
          { uses->cell, node }, [&](Index corner, double) { on = on && onFacet(corner); });
        const Index point =
          this->Connectivity[this->Offsets[uses->cell] + this->Kinds[kind].corners + node];
        this->Boundary[point] |= static_cast<unsigned char>(on && follows[point]);
      }
    });
}

//------------------------------------------------------------------------------
bool FollowingNodes::allCorners(std::size_t i, const std::vector<unsigned char>& flags) const
{
  bool all = true;
  this->forEachCorner(this->Uses[this->UseOffsets[i]],
    [&](Index corner, double) { all = all && flags[corner] != 0; });
  return all;
}

//------------------------------------------------------------------------------
bool FollowingNodes::anyCorner(std::size_t i, const std::vector<unsigned char>& flags) const
{
  bool any = false;
  this->forEachCorner(this->Uses[this->UseOffsets[i]],
    [&](Index corner, double) { any = any || flags[corner] != 0; });
  return any;
}

//------------------------------------------------------------------------------
void FollowingNodes::place(const double* before, std::vector<double>& points, int threads) const
{
  const auto moved = [&](const Use& use)
  {
    const Index first = this->Offsets[use.cell];
    const int corners = this->Kinds[this->KindOfCell[use.cell]].corners;
    return std::any_of(&this->Connectivity[first], &this->Connectivity[first] + corners,
      [&](Index corner)
      { return !std::equal(before + 3 * corner, before + 3 * corner + 3, &points[3 * corner]); });
  };
  const auto derivatives = [&](const Use& use, const double* at, Columns& columns)
  {
    const Place& place = this->placeOf(use);
    columns = { Vec3{ 0, 0, 0 }, Vec3{ 0, 0, 0 }, Vec3{ 0, 0, 0 } };
    for (std::size_t d = 0; d < columns.size(); ++d)
    {
      for (std::size_t k = 0; k < place.derivative[d].size(); ++k)
      {
        const Index corner = this->Connectivity[this->Offsets[use.cell] + static_cast<Index>(k)];
        columns[d] += place.derivative[d][k] * tautline::at(at, corner);
      }
    }
    return complete(columns, this->Kinds[this->KindOfCell[use.cell]].dimension);
  };
  forEachChunk(static_cast<Index>(this->Points.size()), threads,
    [&](Index, Index begin, Index end)
    {
      for (Index i = begin; i < end; ++i)
      {
        const Index point = this->Points[i];
        const Use* uses = &this->Uses[this->UseOffsets[i]];
        const Use* last = &this->Uses[0] + this->UseOffsets[i + 1];
        if (std::none_of(uses, last, moved))
        {
          std::copy_n(before + 3 * point, 3, &points[3 * point]);
          continue;
        }
        Vec3 straight = { 0, 0, 0 }, now = { 0, 0, 0 }, turned = { 0, 0, 0 };
        this->forEachCorner(*uses,
          [&](Index corner, double value)
          {
            straight += value * tautline::at(before, corner);
            now += value * tautline::at(points.data(), corner);
          });
        const Vec3 offset = tautline::at(before, point) - straight;
        double sum = 0;
        for (const Use* use = uses; use != last; ++use)
        {
          Columns a, b;
          const double size = derivatives(*use, before, a);
          derivatives(*use, points.data(), b);
          if (size > 0 && std::isfinite(size))
          {
            turned += size * mapped(a, b, offset);
            sum += size;
          }
        }
        const Vec3 result = now + (sum > 0 ? (1 / sum) * turned : offset);
        std::copy(result.begin(), result.end(), &points[3 * point]);
      }
    });
  this->unite(points);
}

//------------------------------------------------------------------------------
void FollowingNodes::unite(std::vector<double>& points) const
{
  for (const auto& [copy, first] : this->Copies)
  {
    std::copy_n(&points[3 * first], 3, &points[3 * copy]);
  }
}
}
