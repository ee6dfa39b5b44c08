// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Surfaces.h
 * @brief Closed surfaces of triangles or quadrilaterals for the tests of the kernel.
 */
#ifndef tautline_Surfaces_h
#define tautline_Surfaces_h

#include "Blocks.h"

#include <cmath>

namespace tautline
{
/// The outer faces of the unit cells of a block for which keep(i, j, k) holds, scaled by 1 / n.
template <class Keep>
MeshData cellSurface(CellType type, int n, const Keep& keep)
{
  MeshData data;
  std::map<std::array<int, 3>, Index> ids;
  const auto id = [&](const std::array<int, 3>& p)
  {
    const auto [found, added] = ids.emplace(p, data.numberOfPoints());
    if (added)
    {
      data.addPoint({ double(p[0]) / n, double(p[1]) / n, double(p[2]) / n });
    }
    return found->second;
  };
  const auto inside = [&](const std::array<int, 3>& c)
  {
    return std::all_of(c.begin(), c.end(), [n](int x) { return x >= 0 && x < n; }) &&
      keep(c[0], c[1], c[2]);
  };
  for (int cell = 0; cell < n * n * n; ++cell)
  {
    const std::array<int, 3> at = { cell % n, cell / n % n, cell / (n * n) };
    for (int face = 0; inside(at) && face < 6; ++face)
    {
      const int axis = face / 2, up = face % 2;
      std::array<int, 3> next = at;
      next[axis] += 2 * up - 1;
      if (inside(next))
      {
        continue;
      }
      std::vector<Index> nodes;
      for (const auto& [u, v] :
        { std::pair(0, 0), std::pair(1, 0), std::pair(1, 1), std::pair(0, 1) })
      {
        std::array<int, 3> p = at;
        p[axis] += up;
        p[(axis + 1) % 3] += up ? u : v;
        p[(axis + 2) % 3] += up ? v : u;
        nodes.push_back(id(p));
      }
      if (type == CellType::Quadrilateral)
      {
        data.addCell(type, nodes);
      }
      else
      {
        data.addCell(type, { nodes[0], nodes[1], nodes[2] });
        data.addCell(type, { nodes[0], nodes[2], nodes[3] });
      }
    }
  }
  return data;
}

/// The surface of the unit cube.
inline MeshData cubeSurface(CellType type, int n)
{
  return cellSurface(type, n, [](int, int, int) { return true; });
}

/// The surface of an L: the cube without a quarter; n is even.
inline MeshData lSurface(CellType type, int n)
{
  return cellSurface(type, n, [n](int i, int j, int) { return 2 * i < n || 2 * j < n; });
}

/// The cube projected to the unit sphere.
inline MeshData sphereSurface(CellType type, int n)
{
  MeshData data = cubeSurface(type, n);
  data.transform(
    [](Vec3 p)
    {
      const Vec3 q = 2.0 * p - Vec3{ 1, 1, 1 };
      return (1 / norm(q)) * q;
    });
  return data;
}

/**
 * @brief A closed bar as CAD programs triangulate it: a square of side 2 whose edges are rounded by
 * a radius of 0.5, in `steps` flat strips each; the flat sides have one strip.
 * @param length of a section along z
 * @param shift of inner points along z at random, as a fraction of that
 */
inline MeshData roundedBar(int sections, double length, int steps, double shift, unsigned seed)
{
  MeshData data;
  Random random(seed);
  std::vector<Vec3> profile;
  constexpr double radius = 0.5;
  for (int corner = 0; corner < 4; ++corner)
  {
    for (int k = 0; k <= steps; ++k)
    {
      const double quarter = std::acos(0.0), angle = quarter * (corner + double(k) / steps),
                   middle = quarter * (corner + 0.5);
      const double away = (1 - radius) * std::sqrt(2.0);
      profile.push_back({ away * std::cos(middle) + radius * std::cos(angle),
        away * std::sin(middle) + radius * std::sin(angle), 0 });
    }
  }
  const auto around = static_cast<Index>(profile.size());
  for (int s = 0; s <= sections; ++s)
  {
    for (const Vec3& p : profile)
    {
      const bool inner = s > 0 && s < sections;
      const double z = s + (inner ? random.uniform(-shift, shift) : 0.0);
      data.addPoint({ p[0], p[1], length * z });
    }
  }
  for (Index s = 0; s < sections; ++s)
  {
    for (Index i = 0; i < around; ++i)
    {
      const Index a = s * around + i, b = s * around + (i + 1) % around;
      data.addCell(CellType::Triangle, { a, b, b + around });
      data.addCell(CellType::Triangle, { a, b + around, a + around });
    }
  }
  for (const bool top : { false, true })
  {
    const Index center = data.numberOfPoints(), first = top ? sections * around : 0;
    data.addPoint({ 0, 0, top ? sections * length : 0.0 });
    for (Index i = 0; i < around; ++i)
    {
      const Index a = first + i, b = first + (i + 1) % around;
      data.addCell(CellType::Triangle, { top ? a : b, top ? b : a, center });
    }
  }
  return data;
}

/// A closed cylinder of radius 1 and height 2 with `around` points on each rim; triangles.
inline MeshData cylinderSurface(int around, int up)
{
  MeshData data;
  const int rings = 4;
  const auto ring = [&](double radius, double z)
  {
    const Index first = data.numberOfPoints();
    for (int i = 0; i < around; ++i)
    {
      const double angle = 2 * std::acos(-1.0) * i / around;
      data.addPoint({ radius * std::cos(angle), radius * std::sin(angle), z });
    }
    return first;
  };
  const auto band = [&](Index low, Index high, bool flipped)
  {
    for (int i = 0; i < around; ++i)
    {
      const int j = (i + 1) % around;
      std::vector<std::vector<Index>> cells = { { low + i, low + j, high + j },
        { low + i, high + j, high + i } };
      for (std::vector<Index>& cell : cells)
      {
        flipped ? std::swap(cell[0], cell[1]) : void();
        data.addCell(CellType::Triangle, cell);
      }
    }
  };
  std::vector<Index> side;
  for (int k = 0; k <= up; ++k)
  {
    side.push_back(ring(1, 2.0 * k / up));
    if (k > 0)
    {
      band(side[k - 1], side[k], false);
    }
  }
  for (bool top : { false, true })
  {
    Index outer = side[top ? up : 0];
    for (int r = rings - 1; r > 0; --r)
    {
      const Index inner = ring(double(r) / rings, top ? 2 : 0);
      band(outer, inner, !top);
      outer = inner;
    }
    const Index center = data.addPoint({ 0, 0, top ? 2.0 : 0.0 });
    for (int i = 0; i < around; ++i)
    {
      const Index a = outer + i, b = outer + (i + 1) % around;
      data.addCell(CellType::Triangle, { top ? a : b, top ? b : a, center });
    }
  }
  return data;
}

/// The volume within a closed surface; of quadrilaterals, the mean of both ways to divide them.
inline double volumeWithin(const MeshData& data, const std::vector<double>& points)
{
  double volume = 0;
  const auto at = [&](Index p) {
    return Vec3{ points[3 * p], points[3 * p + 1], points[3 * p + 2] };
  };
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    const Index* n = &data.connectivity[data.offsets[c]];
    const auto triangle = [&](Index i, Index j, Index k)
    { return dot(at(n[i]), cross(at(n[j]), at(n[k]))) / 6; };
    volume += data.offsets[c + 1] - data.offsets[c] == 3
      ? triangle(0, 1, 2)
      : 0.5 * (triangle(0, 1, 2) + triangle(0, 2, 3) + triangle(0, 1, 3) + triangle(1, 2, 3));
  }
  return volume;
}
}
#endif
