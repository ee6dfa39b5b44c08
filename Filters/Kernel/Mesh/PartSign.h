// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PartSign.h
 * @brief The sign of the area or volume of connected cells.
 * Internal: not installed.
 */
#ifndef tautline_PartSign_h
#define tautline_PartSign_h

#include "Mesh.h"

#include <cmath>

namespace tautline
{
/**
 * The signed area or volume of a cell with its faces divided into triangles around their centers,
 * so that the sum over a mesh with consistent cells only depends on its boundary, even if its
 * interior is tangled. With one origin for all cells, the contributions of an inner edge or face
 * cancel exactly.
 */
inline double signedSize(
  const Mesh& mesh, const CellTopology& t, const Index* node, const Vec3& origin)
{
  const MeshView& view = mesh.view();
  Vec3 p[MaxNodes];
  for (int k = 0; k < t.nodes; ++k)
  {
    p[k] = pointOf(view, node[k]) - origin;
  }
  if (t.dimension == 2)
  {
    Vec3 area = { 0, 0, 0 };
    for (int k = 0; k < t.nodes; ++k)
    {
      area += cross(p[k], p[(k + 1) % t.nodes]);
    }
    return 0.5 * dot(mesh.normal(), area);
  }
  double sum = 0;
  for (int f = 0; f < t.faces; ++f)
  {
    const int size = t.faceSizes[f];
    Vec3 center = { 0, 0, 0 };
    for (int k = 0; k < size; ++k)
    {
      center += (1.0 / size) * p[t.faceNodes[f][k]];
    }
    for (int k = 0; k < size; ++k)
    {
      sum += dot(center, cross(p[t.faceNodes[f][k]], p[t.faceNodes[f][(k + 1) % size]])) / 6;
    }
  }
  return sum;
}

/// A finite point used as the origin for sizes, to avoid rounding errors from a distant origin.
inline Vec3 finitePoint(const MeshView& view)
{
  Vec3 point = { 0, 0, 0 };
  for (Index i = 0; i < view.numberOfPoints; ++i)
  {
    point = pointOf(view, i);
    if (std::isfinite(dot(point, point)))
    {
      break;
    }
  }
  return point;
}

/// The data that decide the orientation of a connected part.
struct PartSign
{
  double sum = 0, magnitude = 0;
  Index majority = 0; // number of positive minus inverted cells

  void add(double size, int validity)
  {
    this->sum += size;
    this->magnitude += std::abs(size);
    this->majority += validity; // 1, 0 or -1
  }
  bool reversed(double sign) const
  {
    constexpr double rounding = 1e-9;
    return std::abs(this->sum) > rounding * this->magnitude ? sign * this->sum < 0
                                                            : this->majority < 0;
  }
};
}
#endif
