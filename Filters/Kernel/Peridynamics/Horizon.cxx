// SPDX-License-Identifier: BSD-3-Clause
#include "Horizon.h"

#include "tautline/Core/Parallel.h"
#include "tautline/Geometry/SegmentDistance.h"

#include <algorithm>
#include <map>

namespace tautline
{
namespace
{
/// The fraction of its length at which the segment from a (inside) to b (outside) leaves the
/// circle.
double exitParameter(Vec2 a, Vec2 b, double radius)
{
  const Vec2 e = b - a;
  const double alpha = dot(e, e), beta = dot(e, a), gamma = dot(a, a) - radius * radius;
  // For a point on the circle, rounding may make the discriminant slightly negative.
  return (-beta + std::sqrt(std::max(0.0, beta * beta - alpha * gamma))) / alpha;
}

/// The signed area of the intersection of the disk around 0 with the triangle of 0 and the directed
/// segment from a to b.
double sectorArea(Vec2 a, Vec2 b, double radius)
{
  const auto arc = [&](Vec2 p, Vec2 q)
  { return 0.5 * radius * radius * std::atan2(cross(p, q), dot(p, q)); };
  const Vec2 e = b - a;
  const double alpha = dot(e, e), beta = dot(e, a), gamma = dot(a, a) - radius * radius;
  // The line meets the circle at t0 and t1: sector, triangle, sector.
  const double root = beta * beta - alpha * gamma;
  if (!(alpha > 0.0) || root <= 0.0)
  {
    return arc(a, b);
  }
  const double t0 = (-beta - std::sqrt(root)) / alpha, t1 = (-beta + std::sqrt(root)) / alpha;
  // The line meets the circle only beyond the ends of the segment.
  if (t1 <= 0.0 || t0 >= 1.0)
  {
    return arc(a, b);
  }
  const Vec2 p = t0 > 0.0 ? a + t0 * e : a, q = t1 < 1.0 ? a + t1 * e : b;
  return (t0 > 0.0 ? arc(a, p) : 0.0) + 0.5 * cross(p, q) + (t1 < 1.0 ? arc(q, b) : 0.0);
}
}

//------------------------------------------------------------------------------
double layerDeficit(const HorizonMesh& mesh, double horizon, int threads)
{
  // Edges by their two points: the numbers of all triangles and of domain triangles that use them.
  struct Use
  {
    int all = 0, domain = 0;
  };
  std::map<std::pair<Index, Index>, Use> edges;
  for (Index t = 0; t < mesh.numberOfTriangles(); ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Index a = mesh.triangles[3 * t + k], b = mesh.triangles[3 * t + (k + 1) % 3];
      Use& use = edges[{ std::min(a, b), std::max(a, b) }];
      ++use.all;
      use.domain += mesh.layer[t] == 0;
    }
  }
  const auto point = [&](Index i) { return Vec2{ mesh.points[2 * i], mesh.points[2 * i + 1] }; };
  std::vector<std::array<Vec2, 2>> outer, domain;
  for (const auto& [ends, use] : edges)
  {
    const std::array<Vec2, 2> edge = { point(ends.first), point(ends.second) };
    if (use.all == 1)
    {
      outer.push_back(edge);
    }
    if (use.domain == 1)
    {
      domain.push_back(edge);
    }
  }
  // The distance from the boundary of the domain to the outer boundary of the mesh.
  std::vector<double> nearest(domain.size(), horizon * horizon);
  constexpr Index pairsPerChunk = 10000;
  const Index grain = 1 + pairsPerChunk / (1 + static_cast<Index>(outer.size()));
  parallelFor(static_cast<Index>(domain.size()), grain, threads,
    [&](Index i)
    {
      for (const auto& edge : outer)
      {
        nearest[i] = std::min(
          nearest[i], squaredSegmentDistance(domain[i][0], domain[i][1], edge[0], edge[1]));
      }
    });
  const double reach =
    domain.empty() ? horizon : std::sqrt(*std::min_element(nearest.begin(), nearest.end()));
  const double deficit = horizon - reach;
  return deficit > 1e-9 * horizon ? deficit : 0.0;
}

//------------------------------------------------------------------------------
HorizonMesh horizonSquare(double h, double aspectRatio, double delta, Index extraLayers)
{
  if (!(h > 0.0) || !(aspectRatio > 0.0) || !(delta >= 0.0) ||
    !std::isfinite(h + delta + aspectRatio))
  {
    throw Error(
      "the square needs an element size and an aspect ratio above 0 and an interaction layer of "
      "width 0 or more");
  }
  // Legs of the triangles along x and y.
  const double steps[] = { h * std::sqrt(aspectRatio), h / std::sqrt(aspectRatio) };
  Index cells[2];
  for (int c = 0; c < 2; ++c)
  {
    const double count = (1.0 + 2.0 * delta) / steps[c];
    if (std::abs(count - std::round(count)) > 1e-6 || count > 1e5)
    {
      throw Error("from -delta to 1 + delta, " + std::to_string(count) +
        (c == 0 ? " elements fit side by side" : " elements fit one above the other") +
        "; choose the element size, the aspect ratio and delta so that this is a whole number");
    }
    cells[c] = std::llround(count) + 2 * extraLayers;
  }
  HorizonMesh mesh;
  const auto inside = [](double x) { return x > 1e-9 && x < 1.0 - 1e-9; };
  for (Index j = 0; j <= cells[1]; ++j)
  {
    for (Index i = 0; i <= cells[0]; ++i)
    {
      const double x = -delta + static_cast<double>(i - extraLayers) * steps[0];
      const double y = -delta + static_cast<double>(j - extraLayers) * steps[1];
      mesh.points.push_back(x);
      mesh.points.push_back(y);
      mesh.givenPoints.push_back(!(inside(x) && inside(y)));
    }
  }
  for (Index j = 0; j < cells[1]; ++j)
  {
    for (Index i = 0; i < cells[0]; ++i)
    {
      const Index a = j * (cells[0] + 1) + i, d = a + cells[0] + 1;
      // Two triangles per rectangle; triangles with their centroid outside the square form the
      // layer.
      const Index both[2][3] = { { a, a + 1, d + 1 }, { a, d + 1, d } };
      for (const auto& t : both)
      {
        double x = 0.0, y = 0.0;
        for (const Index id : t)
        {
          mesh.triangles.push_back(id);
          x += mesh.points[2 * id] / 3.0;
          y += mesh.points[2 * id + 1] / 3.0;
        }
        mesh.layer.push_back(!(inside(x) && inside(y)));
      }
    }
  }
  return mesh;
}

//------------------------------------------------------------------------------
DiscIntersection intersectDisc(const double* corners, double x, double y, double radius)
{
  DiscIntersection result;
  Vec2 p[3] = {};
  bool in[3];
  for (int k = 0; k < 3; ++k)
  {
    p[k] = { corners[2 * k] - x, corners[2 * k + 1] - y };
    in[k] = dot(p[k], p[k]) <= radius * radius;
    result.corners += in[k];
  }
  // The signed areas of the three directed edges add up to the intersection for any position of the
  // center.
  for (int k = 0; k < 3; ++k)
  {
    result.exactArea += sectorArea(p[k], p[(k + 1) % 3], radius);
  }
  result.exactArea = std::abs(result.exactArea);
  // The rule of the dissertation (Figure 4.5) replaces the arcs of the circle by chords.
  const auto add = [&](Vec2 a, Vec2 b, Vec2 c)
  {
    result.chordArea += 0.5 * std::abs(cross(b - a, c - a));
    for (const Vec2 v : { a, b, c })
    {
      result.chords.push_back(v[0] + x);
      result.chords.push_back(v[1] + y);
    }
  };
  if (result.corners == 3)
  {
    add(p[0], p[1], p[2]);
  }
  else if (result.corners > 0)
  {
    // Rotated so that the odd corner is last (two inside) or first (one inside).
    int first = 0;
    while (result.corners == 1 ? !in[first] : in[(first + 2) % 3])
    {
      ++first;
    }
    const Vec2 a = p[first], b = p[(first + 1) % 3], c = p[(first + 2) % 3];
    const Vec2 onAC = a + exitParameter(a, c, radius) * (c - a);
    if (result.corners == 1)
    {
      add(a, a + exitParameter(a, b, radius) * (b - a), onAC);
    }
    else
    {
      add(a, b, onAC);
      add(b, b + exitParameter(b, c, radius) * (c - b), onAC);
    }
  }
  return result;
}
}
