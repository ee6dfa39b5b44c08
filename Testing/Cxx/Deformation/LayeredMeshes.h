// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LayeredMeshes.h
 * @brief Boundary layer meshes: layers of growing height around a body, for the tests of warping.
 */
#ifndef tautline_LayeredMeshes_h
#define tautline_LayeredMeshes_h

#include "Warping.h"

#include <complex>

namespace tautline
{
/// A mesh in layers; the points of the wall are its first ones, the far boundary has the last.
struct LayeredMesh
{
  MeshData data;
  Index wall = 0; ///< number of points on the wall, and on each layer around

  /// Moves the wall; the far boundary stays.
  std::vector<double> motion(const Field& field) const
  {
    std::vector<double> result(this->data.points.size(), 0.0);
    for (Index i = 0; i < this->wall; ++i)
    {
      const Vec3 d = field(this->data.point(i));
      std::copy(d.begin(), d.end(), &result[3 * i]);
    }
    return result;
  }
};

/// Distances from the wall, the last one 1: heights grow by a factor from the first.
inline std::vector<double> layerHeights(Index layers, double growth)
{
  std::vector<double> at = { 0 };
  double height = 1;
  for (Index i = 0; i < layers; ++i, height *= growth)
  {
    at.push_back(at.back() + height);
  }
  const double total = at.back();
  for (double& h : at)
  {
    h /= total;
  }
  return at;
}

/// The place of a point around a body at an angle, from the wall (0) to the far boundary (1).
using RingShape = std::function<Vec3(double angle, double distance)>;

/// A cylinder of radius 1 in a circle of radius `far`.
inline RingShape cylinderShape(double far)
{
  return [far](double angle, double distance)
  {
    const double r = 1 + (far - 1) * distance;
    return Vec3{ r * std::cos(angle), r * std::sin(angle), 0 };
  };
}

/// A Joukowski airfoil, rounded at its end, by the conformal map of a ring: no line is skewed.
inline RingShape airfoilShape(double far)
{
  return [far](double angle, double distance)
  {
    constexpr double radius = 1.12, bluntness = 0.02;
    const std::complex<double> center = { -(radius - 1) + bluntness, 0.1 };
    const std::complex<double> zeta =
      center + std::polar(radius + (far - radius) * distance, angle);
    const std::complex<double> z = zeta + 1.0 / zeta;
    return Vec3{ z.real(), z.imag(), 0 };
  };
}

/// Quadrilaterals, or triangles, two to each, in a ring.
inline LayeredMesh layeredRing(
  CellType type, Index around, Index layers, double growth, const RingShape& shape)
{
  LayeredMesh ring;
  ring.wall = around;
  for (const double distance : layerHeights(layers, growth))
  {
    for (Index i = 0; i < around; ++i)
    {
      ring.data.addPoint(shape(2 * Pi * double(i) / double(around), distance));
    }
  }
  for (Index k = 0; k < layers; ++k)
  {
    for (Index i = 0; i < around; ++i)
    {
      const Index a = k * around + i, b = k * around + (i + 1) % around;
      if (type == CellType::Quadrilateral)
      {
        ring.data.addCell(type, { a, a + around, b + around, b });
        continue;
      }
      ring.data.addCell(type, { a, a + around, b + around });
      ring.data.addCell(type, { a, b + around, b });
    }
  }
  return ring;
}

/// The surface of a cube of n^2 squares a side, seen from its center: equal angles along edges.
struct CubeDirections
{
  std::vector<Vec3> normals;
  std::vector<std::array<Index, 4>> squares; ///< counter-clockwise from outside

  explicit CubeDirections(Index n)
  {
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      for (Index k = 0; k < 2 * n * n; ++k)
      {
        const Index side = k % 2, i = k / 2 / n, j = k / 2 % n;
        const auto at = [&](Index a, Index b)
        {
          std::array<Index, 3> c = {};
          c[axis] = side * n;
          c[(axis + 1) % 3] = i + a;
          c[(axis + 2) % 3] = j + b;
          return this->corner(c, n);
        };
        this->squares.push_back({ at(0, 0), at(1, 0), at(1, 1), at(0, 1) });
        if (side == 0)
        {
          std::swap(this->squares.back()[1], this->squares.back()[3]);
        }
      }
    }
  }

private:
  Index corner(const std::array<Index, 3>& at, Index n)
  {
    const auto [place, fresh] = this->Known.emplace(at, static_cast<Index>(this->normals.size()));
    if (fresh)
    {
      Vec3 v = { 0, 0, 0 };
      for (std::size_t k = 0; k < 3; ++k)
      {
        v[k] = std::tan(0.25 * Pi * (2 * double(at[k]) / double(n) - 1));
      }
      this->normals.push_back((1 / norm(v)) * v);
    }
    return place->second;
  }

  std::map<std::array<Index, 3>, Index> Known;
};

/// Cells between a square of a layer and the same of the next one.
inline void addLayerCells(
  CellType type, Index low, Index high, const std::array<Index, 4>& s, MeshData& data)
{
  if (type == CellType::Hexahedron)
  {
    data.addCell(type,
      { low + s[0], low + s[1], low + s[2], low + s[3], high + s[0], high + s[1], high + s[2],
        high + s[3] });
    return;
  }
  for (std::array<Index, 3> t :
    { std::array<Index, 3>{ s[0], s[1], s[2] }, std::array<Index, 3>{ s[0], s[2], s[3] } })
  {
    if (type == CellType::Wedge)
    {
      // The first triangle of a wedge is counter-clockwise from outside of it.
      data.addCell(
        type, { low + t[0], low + t[2], low + t[1], high + t[0], high + t[2], high + t[1] });
      continue;
    }
    // The diagonals of the sides start at the smallest number, so that neighbors fit.
    std::sort(t.begin(), t.end());
    for (std::vector<Index> q :
      { std::vector<Index>{ low + t[0], low + t[1], low + t[2], high + t[2] },
        std::vector<Index>{ low + t[0], low + t[1], high + t[2], high + t[1] },
        std::vector<Index>{ low + t[0], high + t[1], high + t[2], high + t[0] } })
    {
      const Vec3 a = data.point(q[0]), b = data.point(q[1]) - a, c = data.point(q[2]) - a,
                 d = data.point(q[3]) - a;
      if (dot(cross(b, c), d) < 0)
      {
        std::swap(q[2], q[3]);
      }
      data.addCell(CellType::Tetrahedron, q);
    }
  }
}

/**
 * Layers between an ellipsoid and a sphere of radius `far`, around a cube of n^2 squares a side, as
 * hexahedra; wedges, two to each, or tetrahedra, three to a wedge.
 */
inline LayeredMesh layeredShell(
  CellType type, Index n, Index layers, double growth, const Vec3& axes, double far)
{
  const CubeDirections cube(n);
  LayeredMesh shell;
  shell.wall = static_cast<Index>(cube.normals.size());
  for (const double distance : layerHeights(layers, growth))
  {
    for (const Vec3& v : cube.normals)
    {
      Vec3 p = { 0, 0, 0 };
      for (std::size_t k = 0; k < 3; ++k)
      {
        p[k] = ((1 - distance) * axes[k] + distance * far) * v[k];
      }
      shell.data.addPoint(p);
    }
  }
  for (Index k = 0; k < layers; ++k)
  {
    for (const std::array<Index, 4>& square : cube.squares)
    {
      addLayerCells(type, k * shell.wall, (k + 1) * shell.wall, square, shell.data);
    }
  }
  return shell;
}

/// The wall turned about an axis through a center, by degrees.
inline Field turnedWall(
  double degrees, const Vec3& axis = { 0, 0, 1 }, const Vec3& center = { 0, 0, 0 })
{
  const Columns turn = rotation(axis, degrees * Pi / 180);
  return [=](const Vec3& p) { return turn * (p - center) + center - p; };
}
}
#endif
