// SPDX-License-Identifier: BSD-3-Clause
#include "BoundaryParts.h"

#include "FacetTable.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
struct PartBox
{
  Vec3 low = { std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
    std::numeric_limits<double>::infinity() };
  Vec3 high = { -low[0], -low[1], -low[2] };
  void add(const Vec3& p)
  {
    for (int k = 0; k < 3; ++k)
    {
      this->low[k] = std::min(this->low[k], p[k]);
      this->high[k] = std::max(this->high[k], p[k]);
    }
  }
  double diagonal() const { return norm(this->high - this->low); }
};

struct Part
{
  Index set;
  double size;
};

/// Replaces the boxes of the parts by their union over all ranks.
void uniteBoxes(RankGroup& group, std::vector<PartBox>& boxes)
{
  for (const std::vector<PartBox>& list : group.gatherItems(boxes))
  {
    for (std::size_t i = 0; i < list.size(); ++i)
    {
      if (list[i].low[0] <= list[i].high[0]) // a rank may lack points of a part
      {
        boxes[i].add(list[i].low);
        boxes[i].add(list[i].high);
      }
    }
  }
}
}

//------------------------------------------------------------------------------
BoundaryParts boundaryParts(const Mesh& mesh, const Ranks& ranks)
{
  const MeshView& view = mesh.view();
  const Index n = view.numberOfPoints;
  // Parts are points joined by boundary facets; components of the mesh are points joined by any
  // facet.
  UnionFind facets(n), pieces(n);
  std::vector<unsigned char> onBoundary(n, 0), used(n, 0);
  FacetTable(mesh).forEachFacet(
    [&](Index first, const FacetUse* use, Index count)
    {
      // Only facets at an owned point have all their cells on this rank.
      bool own = ranks.owns(first);
      for (const Index other : use->others)
      {
        own = own || (other >= 0 && ranks.owns(other));
      }
      for (const Index other : use->others)
      {
        if (other >= 0)
        {
          pieces.join(first, other);
          used[first] = used[other] = 1;
        }
        if (other >= 0 && count == 1 && own)
        {
          facets.join(first, other);
          onBoundary[first] = onBoundary[other] = 1;
        }
      }
    });
  Index count = 0, components = 0;
  const std::vector<Index> setOf = ranks.numberSets(facets, onBoundary, count);
  const std::vector<Index> componentOf = ranks.numberSets(pieces, used, components);
  std::vector<PartBox> boxes(count);
  std::vector<Index> componentOfSet(count, 0);
  for (Index p = 0; p < n; ++p)
  {
    if (setOf[p] >= 0 && ranks.owns(p))
    {
      boxes[setOf[p]].add(pointOf(view, p));
      componentOfSet[setOf[p]] = componentOf[p];
    }
  }
  if (ranks.several())
  {
    RankGroup& group = ranks.mesh().group();
    uniteBoxes(group, boxes);
    for (const std::vector<Index>& list : group.gatherItems(componentOfSet))
    {
      std::transform(list.begin(), list.end(), componentOfSet.begin(), componentOfSet.begin(),
        [](Index a, Index b) { return std::max(a, b); });
    }
  }

  // Parts are numbered by the diagonal of their boxes, the largest first.
  std::vector<Part> parts;
  for (Index set = 0; set < count; ++set)
  {
    parts.push_back({ set, boxes[set].diagonal() });
  }
  std::stable_sort(
    parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.size > b.size; });
  BoundaryParts result;
  std::vector<char> seen(components, 0); // components whose largest part has been met
  std::vector<double> number(count, 0.0);
  for (const Part& part : parts)
  {
    number[part.set] = ++result.parts;
    // The largest part of each component is its outer boundary.
    char& met = seen[componentOfSet[part.set]];
    result.outer.push_back(!met);
    met = 1;
  }
  std::vector<double> local(n, 0.0);
  for (Index p = 0; p < n; ++p)
  {
    local[p] = setOf[p] >= 0 ? number[setOf[p]] : 0.0;
  }
  // Only the facets at owned points are complete: other points get their part from the owner.
  ranks.exchange(local.data(), 1);
  result.part.assign(local.begin(), local.end());
  return result;
}
}
