// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file StretchedMeshes.h
 * @brief Sheared and strongly stretched meshes, for tests.
 */
#ifndef tautline_StretchedMeshes_h
#define tautline_StretchedMeshes_h

#include "Optimizing.h"

namespace tautline
{
/// The unit square or cube in n cells a side, whose inner points a function moves.
template <class Function>
inline MeshData stretched(CellType type, int n, const Function& function)
{
  MeshData data = blockMesh(type, n, n, topology(type).dimension == 3 ? n : 0);
  const Mesh mesh(data.view());
  const std::vector<char> boundary = mesh.boundary().isBoundaryPoint;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 p = (1.0 / n) * data.point(i);
    data.setPoint(i, boundary[i] ? p : function(p));
  }
  return data;
}

/// Functions for stretched(), which sweeps of the result take thousands of iterations to undo.
inline Vec3 sheared(const Vec3& p)
{
  const double s = 0.14 * std::sin(2 * Pi * p[0]) * std::sin(2 * Pi * p[1]);
  return Vec3{ p[0] + s, p[1] + s, p[2] };
}
inline Vec3 fourthPower(const Vec3& p)
{
  return Vec3{ p[0], p[1] * p[1] * p[1] * p[1], p[2] };
}
}
#endif
