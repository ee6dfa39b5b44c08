// SPDX-License-Identifier: BSD-3-Clause
#include "BondCut.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
/// A boundary vertex this close to a bond, relative to the lengths of bond and edge, is on it.
constexpr double Touching = 1e-12;

Vec2 centroid(const PlanarTriangles& triangles, Index t)
{
  return (1.0 / 3.0) * (triangles.corner(t, 0) + triangles.corner(t, 1) + triangles.corner(t, 2));
}

bool shareVertex(const PlanarTriangles& triangles, Index t, Index other)
{
  for (const std::int32_t p : triangles.triangles[t])
  {
    for (const std::int32_t q : triangles.triangles[other])
    {
      if (p == q)
      {
        return true;
      }
    }
  }
  return false;
}

/// The closest points of two disjoint triangles.
double nearestPoints(
  const PlanarTriangles& triangles, Index t, Index other, Vec2& nearestOfT, Vec2& nearestOfOther)
{
  double nearest = 1e300; // of the squared distances
  const auto toSegment = [&](Vec2 p, Vec2 a, Vec2 b, Vec2& ofPoint, Vec2& ofSegment)
  {
    const Vec2 e = b - a;
    const Vec2 q = a + std::clamp(dot(p - a, e) / dot(e, e), 0.0, 1.0) * e;
    if (dot(q - p, q - p) < nearest)
    {
      nearest = dot(q - p, q - p);
      ofPoint = p;
      ofSegment = q;
    }
  };
  for (int i = 0; i < 3; ++i)
  {
    for (int k = 0; k < 3; ++k)
    {
      toSegment(triangles.corner(t, i), triangles.corner(other, k),
        triangles.corner(other, (k + 1) % 3), nearestOfT, nearestOfOther);
      toSegment(triangles.corner(other, i), triangles.corner(t, k),
        triangles.corner(t, (k + 1) % 3), nearestOfOther, nearestOfT);
    }
  }
  return std::sqrt(nearest);
}
}

//------------------------------------------------------------------------------
BondCut::BondCut(const PlanarTriangles& triangles, double horizon, bool cut)
  : Triangles(triangles)
  , Horizon(horizon)
{
  if (!cut)
  {
    return;
  }
  // Edges of exactly one triangle, sorted by their vertices.
  std::vector<std::array<std::int32_t, 2>> edges;
  for (const auto& triangle : triangles.triangles)
  {
    for (int k = 0; k < 3; ++k)
    {
      edges.push_back({ std::min(triangle[k], triangle[(k + 1) % 3]),
        std::max(triangle[k], triangle[(k + 1) % 3]) });
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t i = 0; i < edges.size();)
  {
    std::size_t next = i + 1;
    while (next < edges.size() && edges[next] == edges[i])
    {
      ++next;
    }
    if (next == i + 1)
    {
      Vec2 p = triangles.points[edges[i][0]], q = triangles.points[edges[i][1]];
      if (q < p)
      {
        std::swap(p, q); // the same arithmetic for any order of the points
      }
      this->Edges.push_back({ p, q });
      this->Low.push_back({ std::min(p[0], q[0]), std::min(p[1], q[1]) });
      this->High.push_back({ std::max(p[0], q[0]), std::max(p[1], q[1]) });
    }
    i = next;
  }
  if (!this->Edges.empty())
  {
    this->Grid = std::make_unique<BoxGrid>(this->Low, this->High);
  }
}

//------------------------------------------------------------------------------
bool BondCut::isCut(Index t, Index other, const std::vector<std::int32_t>& edges) const
{
  // The same arithmetic for both orders of a pair, so that the matrix is symmetric.
  const Index first = std::min(t, other), second = std::max(t, other);
  Vec2 a = centroid(this->Triangles, first), b = centroid(this->Triangles, second);
  const double apart = std::sqrt(dot(b - a, b - a));
  if (apart >= this->Horizon)
  {
    // Move from the closest points toward the centroids as far as the horizon allows: the distance
    // is convex along this path.
    Vec2 p = a, q = b;
    const double nearest = nearestPoints(this->Triangles, first, second, p, q);
    if (nearest >= this->Horizon)
    {
      return false; // they do not interact anyway
    }
    constexpr double within = 0.999;
    const double part = within * (this->Horizon - nearest) / (apart - nearest);
    a = p + part * (a - p);
    b = q + part * (b - q);
  }
  const Vec2 bond = b - a;
  const double length = std::sqrt(dot(bond, bond));
  const Vec2 low = { std::min(a[0], b[0]), std::min(a[1], b[1]) };
  const Vec2 high = { std::max(a[0], b[0]), std::max(a[1], b[1]) };
  for (const std::int32_t edge : edges)
  {
    if (this->Low[edge][0] > high[0] || this->High[edge][0] < low[0] ||
      this->Low[edge][1] > high[1] || this->High[edge][1] < low[1])
    {
      continue;
    }
    const Vec2 p = this->Edges[edge][0], q = this->Edges[edge][1];
    const Vec2 along = q - p;
    // Cross products are compared with the product of the lengths, so that the test does not depend
    // on the unit of length.
    const double touching = Touching * length * (length + std::sqrt(dot(along, along)));
    const double sideP = cross(bond, p - a), sideQ = cross(bond, q - a);
    const double sideA = cross(along, a - p), sideB = cross(along, b - p);
    // A bond through a boundary vertex counts as cut, so that it cannot pass between two edges.
    const bool beside =
      (sideP > touching && sideQ > touching) || (sideP < -touching && sideQ < -touching);
    if (!beside && sideA * sideB < 0.0)
    {
      return true;
    }
  }
  return false;
}

//------------------------------------------------------------------------------
void BondCut::keepVisible(Index t, std::vector<std::int32_t>& near) const
{
  if (!this->Grid)
  {
    return;
  }
  std::vector<std::int32_t> edges;
  this->Grid->near(this->Triangles.low[t], this->Triangles.high[t], this->Horizon, edges);
  if (edges.empty())
  {
    return;
  }
  near.erase(std::remove_if(near.begin(), near.end(),
               [&](std::int32_t other)
               { return !shareVertex(this->Triangles, t, other) && this->isCut(t, other, edges); }),
    near.end());
}
}
