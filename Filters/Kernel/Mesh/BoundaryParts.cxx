#include "BoundaryParts.h"

#include "tautline/Core/UnionFind.h"
#include "FacetTable.h"

#include <limits>
#include <map>

namespace tautline
{
namespace
{
struct Box
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
  Index root;
  double size;
};
}

//------------------------------------------------------------------------------
BoundaryParts boundaryParts(const Mesh& mesh)
{
  const MeshView& view = mesh.view();
  BoundaryParts result;
  result.part.assign(view.numberOfPoints, 0);
  // Parts are points joined by boundary facets; components of the mesh, those joined by any facet.
  UnionFind facets(view.numberOfPoints), pieces(view.numberOfPoints);
  std::vector<char> onBoundary(view.numberOfPoints, 0);
  FacetTable table(mesh);
  table.forEachFacet(
    [&](Index first, const FacetUse* use, Index count)
    {
      for (Index other : use->others)
      {
        if (other >= 0)
        {
          pieces.join(first, other);
        }
        if (other >= 0 && count == 1)
        {
          facets.join(first, other);
          onBoundary[first] = onBoundary[other] = 1;
        }
      }
    });

  // Parts are numbered by the diagonal of their boxes, the largest first.
  std::map<Index, Box> boxes;
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    if (onBoundary[p])
    {
      boxes[facets.find(p)].add(pointOf(view, p));
    }
  }
  std::vector<Part> parts;
  for (const auto& [root, box] : boxes)
  {
    parts.push_back({ root, box.diagonal() });
  }
  std::stable_sort(
    parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.size > b.size; });

  // The first part of a component is its outer one.
  std::map<Index, int> number;
  std::map<Index, bool> seen; // components of the mesh whose largest part has been met
  for (const Part& part : parts)
  {
    number[part.root] = ++result.parts;
    bool& met = seen[pieces.find(part.root)];
    result.outer.push_back(!met);
    met = true;
  }
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    result.part[p] = onBoundary[p] ? number[facets.find(p)] : 0;
  }
  return result;
}
}
