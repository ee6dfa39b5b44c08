// SPDX-License-Identifier: BSD-3-Clause
#include "Outline.h"

#include "tautline/Core/UnionFind.h"

#include <map>

namespace tautline
{
namespace
{
constexpr int vtkLine = 3, vtkPolyLine = 4;
}

//------------------------------------------------------------------------------
Features outlineFeatures(const MeshView& view, double angle)
{
  Features found;
  const auto n = static_cast<std::size_t>(view.numberOfPoints);
  found.kind.assign(n, PatchPoint);
  found.curveOf.assign(n, -1);
  found.patchOf.assign(n, -1);
  std::vector<std::vector<Index>> at(n); // the edges at each point
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const int type = view.cellTypes[cell];
    for (Index k = view.offsets[cell]; k + 1 < view.offsets[cell + 1]; ++k)
    {
      const Index a = view.connectivity[k], b = view.connectivity[k + 1];
      if ((type == vtkLine || type == vtkPolyLine) && a != b)
      {
        for (Index p : { a, b })
        {
          at[p].push_back(static_cast<Index>(found.edges.size()));
        }
        found.edges.push_back({ a, b, -1, false });
      }
    }
  }
  const double limit = std::cos(angle / DegreesPerRadian);
  UnionFind curves(static_cast<Index>(found.edges.size()));
  for (std::size_t p = 0; p < n; ++p)
  {
    if (at[p].empty())
    {
      continue;
    }
    const auto from = [&](Index e)
    {
      const Features::Edge& edge = found.edges[e];
      const auto point = static_cast<Index>(p);
      const Index other = edge.first == point ? edge.second : edge.first;
      return pointOf(view, other) - pointOf(view, point);
    };
    const Vec3 d = from(at[p].front()), e = from(at[p].back());
    const bool smooth = at[p].size() == 2 && -dot(d, e) >= limit * norm(d) * norm(e);
    found.kind[p] = smooth ? CurvePoint : CornerPoint;
    (smooth ? found.curvePoints : found.corners) += 1;
    if (smooth)
    {
      curves.join(at[p][0], at[p][1]);
    }
  }
  std::map<Index, int> numbers;
  for (std::size_t e = 0; e < found.edges.size(); ++e)
  {
    Features::Edge& edge = found.edges[e];
    const Index root = curves.find(static_cast<Index>(e));
    edge.curve = numbers.emplace(root, static_cast<int>(numbers.size())).first->second;
    for (Index p : { edge.first, edge.second })
    {
      found.curveOf[p] = found.kind[p] == CurvePoint ? edge.curve : -1;
    }
  }
  found.curves = static_cast<int>(numbers.size());
  return found;
}
}
