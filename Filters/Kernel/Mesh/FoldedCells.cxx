// SPDX-License-Identifier: BSD-3-Clause
#include "FoldedCells.h"

#include "FacetTable.h"
#include "tautline/Core/UnionFind.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
constexpr double FoldCosine = -0.866; // of normals 150 degrees apart
constexpr Index FewCells = 10;        // a group of more is not folded
constexpr Index ManyTimes = 4;        // minimum size ratio of the surrounding groups

/// Two elements at an edge.
struct Neighbors
{
  Index a, b;
};

struct Group
{
  Index cells = 0;
  bool open = false;         ///< whether it has a border, or an edge of more than two elements
  Index smallestAround = -1; ///< number of elements of the smallest group beyond a fold
};
}

//------------------------------------------------------------------------------
Index markFolded(const Mesh& mesh, signed char* validity)
{
  if (mesh.dimension() != Dimension::Surface)
  {
    return 0;
  }
  const MeshView& view = mesh.view();
  std::vector<Vec3> normals(view.numberOfCells, Vec3{ 0, 0, 0 });
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; i < block.count; ++i)
    {
      const Index cell = block.cell(i);
      Vec3 p[MaxNodes];
      for (int k = 0; k < t.nodes; ++k)
      {
        p[k] = pointOf(view, view.connectivity[view.offsets[cell] + k]);
      }
      const Vec3 area = vectorArea(t, p);
      const double length = norm(area);
      normals[cell] = length > 0 && std::isfinite(length) ? (1 / length) * area : normals[cell];
    }
  }
  UnionFind sets(view.numberOfCells);
  std::vector<Neighbors> folds;
  std::vector<Index> open;
  FacetTable(mesh).forEachFacet(
    [&](Index, const FacetUse* uses, Index count)
    {
      if (count != 2)
      {
        std::for_each(
          uses, uses + count, [&open](const FacetUse& use) { open.push_back(use.cell); });
        return;
      }
      const double sign = uses[0].forward != uses[1].forward ? 1.0 : -1.0;
      const double cosine = sign * dot(normals[uses[0].cell], normals[uses[1].cell]);
      if (cosine < FoldCosine)
      {
        folds.push_back({ uses[0].cell, uses[1].cell });
      }
      else
      {
        sets.join(uses[0].cell, uses[1].cell);
      }
    });
  if (folds.empty())
  {
    return 0;
  }
  std::vector<Group> groups(view.numberOfCells);
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    ++groups[sets.find(cell)].cells;
  }
  for (const Index cell : open)
  {
    groups[sets.find(cell)].open = true;
  }
  for (const Neighbors& fold : folds)
  {
    const Index a = sets.find(fold.a), b = sets.find(fold.b);
    for (const auto& [own, other] : { std::pair(a, b), std::pair(b, a) })
    {
      Index& smallest = groups[own].smallestAround;
      smallest = smallest < 0 ? groups[other].cells : std::min(smallest, groups[other].cells);
    }
  }
  Index marked = 0;
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const Group& group = groups[sets.find(cell)];
    if (validity[cell] == Valid && !group.open && group.cells < FewCells &&
      group.smallestAround >= std::max(FewCells, ManyTimes * group.cells))
    {
      validity[cell] = Inverted;
      ++marked;
    }
  }
  return marked;
}
}
