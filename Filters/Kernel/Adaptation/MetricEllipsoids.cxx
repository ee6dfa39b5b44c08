// SPDX-License-Identifier: BSD-3-Clause
#include "MetricEllipsoids.h"

#include "tautline/Elements/ElementPlacement.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace tautline
{
namespace
{
constexpr int latitudes = 6, longitudes = 12; // of the triangles of a sphere
constexpr double thickness = 0.1;             // across a plane or surface

/// The points of candidates that are the first in their cell of a grid; at most `most` + 1.
std::vector<Index> firstOfCells(const double* places, const std::vector<Index>& candidates,
  const Vec3& low, double width, Index most)
{
  std::set<std::array<Index, 3>> cells;
  std::vector<Index> found;
  for (const Index p : candidates)
  {
    std::array<Index, 3> cell;
    for (int c = 0; c < 3; ++c)
    {
      cell[c] = static_cast<Index>((places[3 * p + c] - low[c]) / width);
    }
    if (cells.insert(cell).second)
    {
      found.push_back(p);
    }
    if (static_cast<Index>(found.size()) > most)
    {
      break;
    }
  }
  return found;
}

/// The points of a unit sphere: a pole, circles, the other pole.
std::vector<Vec3> spherePoints()
{
  std::vector<Vec3> points = { { 0, 0, 1 } };
  for (int i = 1; i < latitudes; ++i)
  {
    const double polar = Pi * i / latitudes;
    for (int k = 0; k < longitudes; ++k)
    {
      const double angle = 2.0 * Pi * k / longitudes;
      points.push_back(
        { std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle), std::cos(polar) });
    }
  }
  points.push_back({ 0, 0, -1 });
  return points;
}

void addSphereTriangles(Index first, std::vector<Index>& triangles)
{
  const Index last = first + 1 + (latitudes - 1) * longitudes;
  const auto at = [first](int circle, int k)
  { return first + 1 + circle * longitudes + k % longitudes; };
  for (int k = 0; k < longitudes; ++k)
  {
    triangles.insert(triangles.end(), { first, at(0, k), at(0, k + 1) });
    for (int circle = 0; circle + 2 < latitudes; ++circle)
    {
      const Index a = at(circle, k), b = at(circle, k + 1), c = at(circle + 1, k),
                  d = at(circle + 1, k + 1);
      triangles.insert(triangles.end(), { a, c, d, a, d, b });
    }
    triangles.insert(triangles.end(), { at(latitudes - 2, k), last, at(latitudes - 2, k + 1) });
  }
}
}

//------------------------------------------------------------------------------
std::vector<Index> spreadPoints(
  const double* places, const std::vector<Index>& candidates, Index most)
{
  if (static_cast<Index>(candidates.size()) <= most || most <= 0)
  {
    return most <= 0 ? std::vector<Index>() : candidates;
  }
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Vec3 low = { infinity, infinity, infinity }, high = -1.0 * low;
  for (const Index p : candidates)
  {
    for (int c = 0; c < 3; ++c)
    {
      low[c] = std::min(low[c], places[3 * p + c]);
      high[c] = std::max(high[c], places[3 * p + c]);
    }
  }
  const Vec3 extent = high - low;
  const double longest = std::max({ extent[0], extent[1], extent[2] });
  const auto divided = [&](int cells)
  { return firstOfCells(places, candidates, low, longest / cells, most); };
  const auto fits = [most](const std::vector<Index>& found)
  { return static_cast<Index>(found.size()) <= most; };
  std::vector<Index> best = { candidates[0] };
  if (!(longest > 0.0) || !std::isfinite(longest))
  {
    return best;
  }
  constexpr int finest = 4096;
  int coarse = 0, fine = 1;
  // Double the resolution until there are too many points, then bisect.
  for (std::vector<Index> found = divided(fine); fine <= finest && fits(found);)
  {
    best = std::move(found);
    coarse = fine;
    fine *= 2;
    found = divided(fine);
  }
  while (fine - coarse > 1)
  {
    const int middle = (coarse + fine) / 2;
    std::vector<Index> found = divided(middle);
    const bool fit = fits(found);
    (fit ? coarse : fine) = middle;
    best = fit ? std::move(found) : std::move(best);
  }
  return best;
}

//------------------------------------------------------------------------------
void addEllipsoid(Index point, const Vec3& center, const MetricTensor& metric, const Vec3* normal,
  double scale, MetricEllipsoids& ellipsoids)
{
  MetricAxes axes = principalAxes(metric);
  std::array<double, 3> sizes;
  std::transform(axes.values.begin(), axes.values.end(), sizes.begin(),
    [](double value) { return 1.0 / std::sqrt(value); });
  ellipsoids.centers.push_back(point);
  // Take roots first: products of extreme sizes would overflow.
  ellipsoids.sizes.push_back(normal
      ? std::sqrt(sizes[0]) * std::sqrt(sizes[2])
      : std::cbrt(sizes[0]) * std::cbrt(sizes[1]) * std::cbrt(sizes[2]));
  ellipsoids.ratios.push_back(sizes[0] / sizes[2]);
  if (normal)
  {
    // The larger size is also along the normal, so the in-plane axis is perpendicular to the other
    // one.
    const Vec3 along = cross(*normal, axes.axes[2]);
    const double length = norm(along);
    const auto [t1, t2] = frameOfPlane(*normal);
    const bool round = !(length > 0.5); // all sizes are equal, and the axes are any
    axes.axes = { round ? t1 : (1.0 / length) * along, *normal, round ? t2 : axes.axes[2] };
    sizes[1] = thickness * sizes[2];
  }
  const auto first = static_cast<Index>(ellipsoids.points.size() / 3);
  static const std::vector<Vec3> sphere = spherePoints();
  for (const Vec3& s : sphere)
  {
    Vec3 x = center;
    for (int k = 0; k < 3; ++k)
    {
      x += scale * sizes[k] * s[k] * axes.axes[k];
    }
    ellipsoids.points.insert(ellipsoids.points.end(), x.begin(), x.end());
  }
  addSphereTriangles(first, ellipsoids.triangles);
}
}
