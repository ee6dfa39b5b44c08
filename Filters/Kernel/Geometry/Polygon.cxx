// SPDX-License-Identifier: BSD-3-Clause
#include "Polygon.h"

#include "Predicates.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Core/LoopProgress.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace tautline
{
namespace
{
using Triangle = std::array<Index, 3>;

/// Whether p lies in the closed triangle abc, which is counterclockwise.
bool contains(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& p)
{
  return orientation(a, b, p) >= 0 && orientation(b, c, p) >= 0 && orientation(c, a, p) >= 0;
}

/// Repeatedly cuts off a strictly convex corner that contains no other vertices.
std::vector<Triangle> clipEars(const std::vector<Vec2>& points)
{
  std::vector<Index> left(points.size());
  std::iota(left.begin(), left.end(), 0);
  std::vector<Triangle> triangles;
  std::size_t start = 0;
  while (left.size() > 3)
  {
    throwIfInterrupted();
    LoopProgress::atPass(
      static_cast<Index>(points.size() - left.size()), static_cast<Index>(points.size()));
    const std::size_t n = left.size();
    bool found = false;
    for (std::size_t step = 0; step < n && !found; ++step)
    {
      const std::size_t i = (start + step) % n;
      const Triangle t = { left[(i + n - 1) % n], left[i], left[(i + 1) % n] };
      const Vec2 &a = points[t[0]], &b = points[t[1]], &c = points[t[2]];
      if (orientation(a, b, c) <= 0)
      {
        continue;
      }
      // A vertex on the boundary of the ear also counts, because it would leave a degenerate
      // polygon.
      found = std::none_of(left.begin(), left.end(),
        [&](Index v)
        { return v != t[0] && v != t[1] && v != t[2] && contains(a, b, c, points[v]); });
      if (found)
      {
        triangles.push_back(t);
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
        start = i; // continue next to the ear, so that ears are distributed around the polygon
      }
    }
    if (!found)
    {
      throw Error("The polygon cannot be triangulated: its vertices lie on a line.");
    }
  }
  if (orientation(points[left[0]], points[left[1]], points[left[2]]) <= 0)
  {
    throw Error("The polygon cannot be triangulated: its vertices lie on a line.");
  }
  triangles.push_back({ left[0], left[1], left[2] });
  return triangles;
}

/// For each triangle, the triangles across the edges opposite its corners, -1 at the boundary.
std::vector<Triangle> findNeighbours(const std::vector<Triangle>& triangles)
{
  std::map<std::pair<Index, Index>, std::pair<Index, int>> edges;
  std::vector<Triangle> neighbours(triangles.size(), { -1, -1, -1 });
  for (std::size_t t = 0; t < triangles.size(); ++t)
  {
    for (int c = 0; c < 3; ++c)
    {
      const Index a = triangles[t][(c + 1) % 3], b = triangles[t][(c + 2) % 3];
      const auto inserted = edges.insert({ std::minmax(a, b), { static_cast<Index>(t), c } });
      if (!inserted.second)
      {
        const auto [other, corner] = inserted.first->second;
        neighbours[t][c] = other;
        neighbours[static_cast<std::size_t>(other)][corner] = static_cast<Index>(t);
      }
    }
  }
  return neighbours;
}

int cornerOf(const Triangle& triangle, Index what)
{
  return triangle[0] == what ? 0 : triangle[1] == what ? 1 : 2;
}

/// Lawson's flips until every diagonal is locally Delaunay; they terminate, because the signs are
/// exact.
void flipToDelaunay(PolygonMesh& mesh)
{
  std::vector<Index> pending(mesh.triangles.size());
  // In reverse, so that triangle 0 is on top of the stack.
  std::iota(pending.rbegin(), pending.rend(), 0);
  while (!pending.empty())
  {
    const Index t = pending.back();
    pending.pop_back();
    for (int c = 0; c < 3; ++c)
    {
      const Index u = mesh.neighbours[t][c];
      if (u < 0)
      {
        continue;
      }
      const int d = cornerOf(mesh.neighbours[u], t);
      const Index a = mesh.triangles[t][c], b = mesh.triangles[t][(c + 1) % 3];
      const Index e = mesh.triangles[t][(c + 2) % 3], o = mesh.triangles[u][d];
      const std::vector<Vec2>& x = mesh.points;
      // If the point is inside the circle, the quadrilateral is convex.
      if (inCircle(x[a], x[b], x[e], x[o]) <= 0)
      {
        continue;
      }
      // The diagonal b-e of the quadrilateral a b o e becomes a-o.
      const Index beside[4] = { mesh.neighbours[t][(c + 2) % 3], mesh.neighbours[u][(d + 1) % 3],
        mesh.neighbours[u][(d + 2) % 3], mesh.neighbours[t][(c + 1) % 3] }; // ab, bo, oe, ea
      mesh.triangles[t] = { a, b, o };
      mesh.neighbours[t] = { beside[1], u, beside[0] };
      mesh.triangles[u] = { a, o, e };
      mesh.neighbours[u] = { beside[2], beside[3], t };
      if (beside[1] >= 0)
      {
        mesh.neighbours[beside[1]][cornerOf(mesh.neighbours[beside[1]], u)] = t;
      }
      if (beside[3] >= 0)
      {
        mesh.neighbours[beside[3]][cornerOf(mesh.neighbours[beside[3]], t)] = u;
      }
      pending.push_back(u);
      pending.push_back(t);
      break;
    }
  }
}

/// Eliminates leaves of the tree first, by lowest triangle number, so that the order is unique.
std::vector<EliminationStep> eliminate(const PolygonMesh& mesh)
{
  const std::size_t n = mesh.triangles.size();
  // The dual graph of a triangulated simple polygon is a tree, so there is always a leaf.
  std::vector<int> degree(n);
  std::vector<Index> leaves;
  for (std::size_t t = 0; t < n; ++t)
  {
    for (Index neighbour : mesh.neighbours[t])
    {
      degree[t] += neighbour >= 0;
    }
    if (degree[t] <= 1)
    {
      leaves.push_back(static_cast<Index>(t));
    }
  }
  std::vector<bool> gone(n, false);
  std::vector<EliminationStep> steps;
  for (std::size_t i = 0; i < leaves.size(); ++i)
  {
    const Index t = leaves[i];
    int corner = 0; // for the last triangle, any vertex
    for (int c = 0; c < 3; ++c)
    {
      const Index neighbour = mesh.neighbours[t][c];
      if (neighbour >= 0 && !gone[neighbour])
      {
        corner = c;
        if (--degree[neighbour] == 1)
        {
          leaves.push_back(neighbour);
        }
      }
    }
    gone[t] = true;
    const Triangle& triangle = mesh.triangles[t];
    steps.push_back(
      { t, triangle[corner], { triangle[(corner + 1) % 3], triangle[(corner + 2) % 3] } });
  }
  return steps;
}
}

/// Relative to the first vertex, to preserve precision for polygons far from the origin.
double signedArea(const std::vector<Vec2>& polygon)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const Vec2 &o = polygon[0], &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    sum += (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
  }
  return 0.5 * sum;
}

Vec2 centreOfMass(const std::vector<Vec2>& polygon)
{
  if (polygon.empty())
  {
    return {};
  }
  const Vec2 o = polygon[0];
  double area = 0.0;
  Vec2 moment = {}, mean = {};
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const Vec2 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const Vec2 a = { p[0] - o[0], p[1] - o[1] }, b = { q[0] - o[0], q[1] - o[1] };
    // Signed triangles from the first vertex add up to the polygon; the centroid of each is at (a +
    // b) / 3.
    const double twice = a[0] * b[1] - a[1] * b[0];
    area += twice;
    for (int x = 0; x < 2; ++x)
    {
      moment[x] += twice * (a[x] + b[x]) / 3.0;
      mean[x] += a[x] / static_cast<double>(polygon.size());
    }
  }
  return area != 0.0 ? Vec2{ o[0] + moment[0] / area, o[1] + moment[1] / area }
                     : Vec2{ o[0] + mean[0], o[1] + mean[1] };
}

bool isSimple(const std::vector<Vec2>& polygon)
{
  const std::size_t n = polygon.size();
  for (std::size_t i = 0; i < n; ++i)
  {
    throwIfInterrupted();
    LoopProgress::at(static_cast<double>(i) / static_cast<double>(n));
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % n];
    if (a == b)
    {
      return false;
    }
    for (std::size_t j = i + 1; j < n; ++j)
    {
      const Vec2 &c = polygon[j], &d = polygon[(j + 1) % n];
      if (j == i + 1 || (j + 1) % n == i)
      {
        // Adjacent edges share a vertex; they must not fold back onto each other.
        const Vec2 &before = j == i + 1 ? a : c, &shared = j == i + 1 ? b : d;
        const Vec2& after = j == i + 1 ? d : b;
        const double along = (before[0] - shared[0]) * (after[0] - shared[0]) +
          (before[1] - shared[1]) * (after[1] - shared[1]);
        if (along > 0.0 && orientation(before, shared, after) == 0)
        {
          return false;
        }
      }
      else if (segmentsMeet(a, b, c, d))
      {
        return false;
      }
    }
  }
  return n >= 3;
}

PolygonMesh triangulatePolygon(std::vector<Vec2> polygon)
{
  if (polygon.size() < 3)
  {
    throw Error(
      "A polygon needs at least 3 vertices; this one has " + std::to_string(polygon.size()) + ".");
  }
  for (const Vec2& p : polygon)
  {
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]))
    {
      throw Error("The polygon has a coordinate that is not finite.");
    }
  }
  if (!isSimple(polygon))
  {
    throw Error("The polygon intersects itself: only simple polygons can be triangulated.");
  }
  if (signedArea(polygon) < 0.0)
  {
    std::reverse(polygon.begin(), polygon.end());
  }
  PolygonMesh mesh;
  mesh.points = std::move(polygon);
  // Ears give any valid triangulation, and only need exact signs; the flips then make it Delaunay.
  mesh.triangles = clipEars(mesh.points);
  mesh.neighbours = findNeighbours(mesh.triangles);
  flipToDelaunay(mesh);
  mesh.elimination = eliminate(mesh);
  return mesh;
}
}
