// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Warping.h
 * @brief Meshes and boundaries that move, for the tests of warping.
 */
#ifndef tautline_Warping_h
#define tautline_Warping_h

#include "../Optimization/Optimizing.h"

#include "tautline/Deformation/Warp.h"
#include "tautline/Deformation/WarpQuality.h"

namespace tautline
{
using Field = std::function<Vec3(const Vec3&)>;

/// A displacement at every point; only displacements of prescribed points may count.
inline std::vector<double> displacements(const MeshData& data, const Field& motion)
{
  std::vector<double> result(data.points.size());
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 d = motion(data.point(i));
    std::copy(d.begin(), d.end(), &result[3 * i]);
  }
  return result;
}

inline WarpResult warped(const MeshData& data, const Field& motion, const WarpOptions& options)
{
  const Mesh mesh(data.view());
  return Warper(mesh, options).warp(displacements(data, motion).data());
}

inline WarpOptions withMethod(WarpMethod method)
{
  return TAUTLINE_CHANGED(WarpOptions(), method = method, threads = 1);
}

/// Anisotropic FEMWARP with coefficients by hand.
inline WarpOptions manual(double alpha, double beta, double gamma = 0)
{
  WarpOptions options = withMethod(WarpMethod::AnisotropicFemwarp);
  options.coefficients = WarpCoefficients::Manual;
  options.tensor = { alpha, beta, gamma, 0, 0, 0 };
  return options;
}

/// The largest distance between points of two meshes.
inline double distance(const std::vector<double>& a, const std::vector<double>& b)
{
  return largestOf<double>(a.size() == b.size() ? 0.0 : 1e300, std::min(a.size(), b.size()),
    [&](std::size_t i) { return std::isfinite(a[i]) ? std::abs(a[i] - b[i]) : 1e300; });
}

/**
 * The unit cube (square, with flat cells) of n^3 cubes cut into cells, without the cubes in its
 * middle, `inner` along each edge; the points inside at random about their places.
 */
inline MeshData boxInBox(CellType type, Index n, Index inner, double amplitude = 0.2)
{
  const bool flat = topology(type).dimension == 2;
  const MeshData full = blockMesh(type, n, n, flat ? 0 : n);
  const double low = 0.5 * (n - inner), high = n - low;
  MeshData data;
  std::vector<Index> id(full.numberOfPoints(), -1);
  for (Index c = 0; c < full.numberOfCells(); ++c)
  {
    const Index *begin = &full.connectivity[full.offsets[c]],
                *end = begin + (full.offsets[c + 1] - full.offsets[c]);
    Vec3 center = { 0, 0, 0 };
    for (const Index* p = begin; p != end; ++p)
    {
      center += (1.0 / double(end - begin)) * full.point(*p);
    }
    const auto between = [&](double x) { return x > low && x < high; };
    if (between(center[0]) && between(center[1]) && (flat || between(center[2])))
    {
      continue;
    }
    std::vector<Index> nodes;
    for (const Index* p = begin; p != end; ++p)
    {
      if (id[*p] < 0)
      {
        id[*p] = data.addPoint((1.0 / double(n)) * full.point(*p));
      }
      nodes.push_back(id[*p]);
    }
    data.addCell(type, nodes);
  }
  const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
  Random random(3);
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 d = random.vector(-amplitude, amplitude);
    if (!boundary[i])
    {
      data.setPoint(i, data.point(i) + (1.0 / double(n)) * Vec3{ d[0], d[1], flat ? 0.0 : d[2] });
    }
  }
  return data;
}

/// The points on the inner box: all prescribed points well inside the outer one.
inline bool onInnerBox(const Vec3& p, bool flat)
{
  constexpr double near = 0.4;
  return std::abs(p[0] - 0.5) < near && std::abs(p[1] - 0.5) < near &&
    (flat || std::abs(p[2] - 0.5) < near);
}

/// The inner box turned about the vertical axis through the middle, by an angle in degrees.
inline Field turnedBox(double degrees, bool flat)
{
  const Columns turn = rotation({ 0, 0, 1 }, degrees * std::acos(-1.0) / 180);
  const Vec3 middle = { 0.5, 0.5, flat ? 0.0 : 0.5 };
  return [=](const Vec3& p) {
    return onInnerBox(p, flat) ? turn * (p - middle) + middle - p : Vec3{ 0, 0, 0 };
  };
}
}
#endif
