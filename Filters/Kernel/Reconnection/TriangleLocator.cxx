// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleLocator.h"

#include "Constants.h"

#include <limits>

namespace tautline
{
namespace
{
/// The number of triangles passed on the path to a point before the search continues around it.
constexpr int MaxPassed = 10000;
}

TrianglePlace closestInTriangle(const std::array<Vec3, 3>& p, const Vec3& x)
{
  const Vec3 u = p[1] - p[0], v = p[2] - p[0], w = x - p[0];
  const Vec3 n = cross(u, v);
  const double n2 = dot(n, n);
  TrianglePlace place;
  // Barycentric coordinates of the projection onto the plane; if one is negative, the closest point
  // is on an edge.
  place.weights[1] = dot(cross(w, v), n) / n2;
  place.weights[2] = dot(cross(u, w), n) / n2;
  place.weights[0] = 1.0 - place.weights[1] - place.weights[2];
  if (std::min({ place.weights[0], place.weights[1], place.weights[2] }) < 0.0)
  {
    place.distance2 = std::numeric_limits<double>::max();
    for (int i = 0; i < 3; ++i)
    {
      const Vec3 edge = p[Next[i]] - p[i];
      const double s = std::clamp(dot(x - p[i], edge) / dot(edge, edge), 0.0, 1.0);
      const Vec3 d = x - (p[i] + s * edge);
      if (dot(d, d) < place.distance2)
      {
        place.distance2 = dot(d, d);
        place.weights = { 0, 0, 0 };
        place.weights[i] = 1.0 - s;
        place.weights[Next[i]] = s;
      }
    }
    return place;
  }
  const Vec3 d = dot(w, n) / n2 * n;
  place.distance2 = dot(d, d);
  return place;
}

TrianglePlace TriangleLocator::placeIn(TriId t, const Vec3& x) const
{
  const Corners& v = this->Input.cells[t];
  const std::vector<Vec3>& p = this->Input.points;
  return closestInTriangle({ p[v[0]], p[v[1]], p[v[2]] }, x);
}

TriId TriangleLocator::nearest(const Vec3& x, TriId start, TrianglePlace& best, int patience) const
{
  // Best-first search across neighbors; it ends after `patience` triangles without improvement.
  std::vector<Candidate>& queue = this->Queue;
  ++this->Search;
  this->Marks[start] = this->Search;
  best = this->placeIn(start, x);
  TriId nearest = start;
  queue.assign(1, { best.distance2, start });
  int visited = 0;
  for (int vain = 0; !queue.empty() && vain < patience && visited < MaxVisited; ++visited, ++vain)
  {
    std::pop_heap(queue.begin(), queue.end(), std::greater<>());
    const TriId t = queue.back().second;
    queue.pop_back();
    const TrianglePlace place = this->placeIn(t, x);
    if (place.distance2 < best.distance2 || (place.distance2 == best.distance2 && t < nearest))
    {
      vain = place.distance2 < best.distance2 ? 0 : vain;
      best = place;
      nearest = t;
    }
    if (this->Input.planar && best.distance2 == 0.0)
    {
      break;
    }
    for (int i = 0; i < 3; ++i)
    {
      const TriId n = this->Mesh.triangle(t).neighbors[i] >> 2;
      if (!this->Mesh.isWall(t, i) && this->Marks[n] != this->Search)
      {
        this->Marks[n] = this->Search;
        queue.push_back({ this->placeIn(n, x).distance2, n });
        std::push_heap(queue.begin(), queue.end(), std::greater<>());
      }
    }
  }
  return nearest;
}

TriId TriangleLocator::walk(const Vec3& x, TriId start, TrianglePlace& place) const
{
  const std::vector<Vec3>& p = this->Input.points;
  TriId t = start, from = NoNumber;
  for (int step = 0; this->Input.planar && step < MaxPassed; ++step)
  {
    const Corners& v = this->Input.cells[t];
    double sum = 0.0;
    std::array<double, 3> areas;
    for (int i = 0; i < 3; ++i)
    {
      areas[i] = cross(p[v[Next[i]]] - x, p[v[Previous[i]]] - x)[2];
      sum += areas[i];
    }
    // Leave through the edge that x is farthest beyond, but do not go back.
    int out = -1;
    for (int i = 0; i < 3; ++i)
    {
      const std::int32_t n = this->Mesh.triangle(t).neighbors[i];
      if (areas[i] < -RoundingFraction * sum && n != NoNumber && n >> 2 != from &&
        (out < 0 || areas[i] < areas[out]))
      {
        out = i;
      }
    }
    if (*std::min_element(areas.begin(), areas.end()) >= -RoundingFraction * sum)
    {
      place.distance2 = 0.0;
      for (int i = 0; i < 3; ++i)
      {
        place.weights[i] = areas[i] / sum;
      }
      return t;
    }
    if (out < 0)
    {
      break;
    }
    from = t;
    t = this->Mesh.triangle(t).neighbors[out] >> 2;
  }
  return this->nearest(x, t, place, Patience);
}
}
