// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CollapsedMeshes.h
 * @brief Meshes of hexahedra that list points twice, for tests.
 */
#ifndef tautline_CollapsedMeshes_h
#define tautline_CollapsedMeshes_h

#include "Blocks.h"

namespace tautline
{
/**
 * @brief A cylinder of 3 layers about z, each of 4 wedges at the axis and 4 hexahedra around.
 * @param collapsed whether the wedges are hexahedra that list both points on the axis twice
 * @param amplitude by which points not on the boundary are moved at random
 */
inline MeshData wheel(bool collapsed, double amplitude)
{
  constexpr Index layers = 3, sectors = 4, inLayer = 1 + 2 * sectors;
  Random random(11);
  MeshData data;
  for (Index k = 0; k <= layers; ++k)
  {
    for (Index i = 0; i < inLayer; ++i)
    {
      const double radius = i == 0 ? 0.0 : i <= sectors ? 1.0 : 2.0;
      const double angle = 1.5707963267948966 * static_cast<double>(i);
      const Vec3 away = random.vector(-amplitude, amplitude);
      const bool inside = k > 0 && k < layers && radius < 2;
      data.addPoint(
        Vec3{ radius * std::cos(angle), radius * std::sin(angle), static_cast<double>(k) } +
        (inside ? 1.0 : 0.0) * away);
    }
  }
  for (Index k = 0; k < layers; ++k)
  {
    const Index low = k * inLayer, high = low + inLayer;
    for (Index i = 0; i < sectors; ++i)
    {
      const Index a = 1 + i, b = 1 + (i + 1) % sectors;
      if (collapsed)
      {
        data.addCell(
          CellType::Hexahedron, { low, low + a, low + b, low, high, high + a, high + b, high });
      }
      else
      {
        data.addCell(CellType::Wedge, { low, low + b, low + a, high, high + b, high + a });
      }
      data.addCell(CellType::Hexahedron,
        { low + a, low + a + sectors, low + b + sectors, low + b, high + a, high + a + sectors,
          high + b + sectors, high + b });
    }
  }
  return data;
}
}
#endif
