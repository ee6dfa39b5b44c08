// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ElementPlacement.h
 * @brief The local coordinates of an element: relative to its first node, in a plane, as its mirror
 * image.
 * Internal: not installed.
 */
#ifndef tautline_ElementPlacement_h
#define tautline_ElementPlacement_h

#include "DeterminantWork.h"

namespace tautline
{
/// Extents beyond these are divided by a power of two: products of six lengths would overflow.
constexpr double SmallExtent = 0x1p-64, LargeExtent = 0x1p64;

/// 1, or the power of two that brings an extreme extent to about 1.
inline double unitOfElement(double extent)
{
  constexpr int farthest = 1022; // so that its reciprocal is normal
  const bool usual = extent > SmallExtent && extent < LargeExtent;
  return usual || !(extent > 0) || !std::isfinite(extent)
    ? 1.0
    : std::ldexp(1.0, std::clamp(std::ilogb(extent), -farthest, farthest));
}

/// Two unit vectors whose cross product is the given unit normal; x and y for z.
inline std::array<Vec3, 2> frameOfPlane(const Vec3& normal)
{
  if (normal[2] == 1)
  {
    return { Vec3{ 1, 0, 0 }, Vec3{ 0, 1, 0 } };
  }
  int least = 0;
  for (int c = 1; c < 3; ++c)
  {
    least = std::abs(normal[c]) < std::abs(normal[least]) ? c : least;
  }
  Vec3 axis = { 0, 0, 0 };
  axis[least] = 1;
  Vec3 first = cross(axis, normal);
  first = (1 / norm(first)) * first;
  return { first, cross(normal, first) };
}

/// Loads the elements of one type.
struct ElementPlacement
{
  /// The same arguments as for JacobianCertifier.
  ElementPlacement(const ElementType& type, const Vec3& normal, bool mirror)
    : plane(type.dimension() == 2 && norm(normal) > 0)
    , surface(type.dimension() == 2 && !plane)
    , mirrored(mirror && !surface)
    , frame(frameOfPlane(plane ? normal : Vec3{ 0, 0, 1 }))
  {
  }

  /// Moves the first node to the origin, and planar elements into x y.
  template <class T>
  void place(DeterminantWork<T>& work) const
  {
    const typename DeterminantWork<T>::Vector first = work.nodes[0];
    for (auto& node : work.nodes)
    {
      for (int c = 0; c < 3; ++c)
      {
        node.c[c] -= first.c[c];
      }
      if (this->plane)
      {
        const auto along = [&](const Vec3& e)
        { return e[0] * node.c[0] + e[1] * node.c[1] + e[2] * node.c[2]; };
        const T x = along(this->frame[0]), y = along(this->frame[1]);
        node.c[0] = x;
        node.c[1] = y;
        node.c[2] = T{};
      }
      if (this->mirrored)
      {
        node.c[0] = -node.c[0];
      }
    }
  }

  /// Loads one element; returns the unit of its coordinates.
  double load(DeterminantWork<double>& work, const double* points, const Index* nodes) const
  {
    double extent = 0;
    for (std::size_t k = 0; k < work.nodes.size(); ++k)
    {
      for (int c = 0; c < 3; ++c)
      {
        const double x = points[3 * nodes[k] + c];
        work.nodes[k].c[c] = x;
        extent = std::max(extent, std::abs(x - points[3 * nodes[0] + c]));
      }
    }
    const double unit = unitOfElement(extent);
    for (auto& node : work.nodes)
    {
      for (double& x : node.c)
      {
        x *= 1 / unit;
      }
    }
    this->place(work);
    return unit;
  }

  bool plane;   ///< planar elements; in x y after loading
  bool surface; ///< elements of a surface in space
  bool mirrored;
  std::array<Vec3, 2> frame;
};
}
#endif
