// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file KuhnMesh.h
 * @brief Cubes of tetrahedra for the benchmarks.
 */
#ifndef tautline_KuhnMesh_h
#define tautline_KuhnMesh_h

#include "../Cxx/Blocks.h"

#include <utility>

namespace tautline
{
/// Cuts the unit cubes of a block of n x n x n hexahedra into six tetrahedra round a diagonal
/// (Kuhn).
inline MeshData cutIntoTetrahedra(MeshData data, Index n)
{
  const std::vector<Index> cubes = std::move(data.connectivity);
  data.types.clear();
  data.offsets = { 0 };
  data.connectivity.clear();
  data.connectivity.reserve(3 * cubes.size());
  const Index m = n + 1, step[3] = { 1, m, m * m };
  for (std::size_t cube = 0; cube < cubes.size(); cube += 8)
  {
    const Index a = cubes[cube], d = a + step[0] + step[1] + step[2];
    for (int i = 0; i < 3; ++i)
    {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      data.addCell(CellType::Tetrahedron, { a, a + step[i], a + step[i] + step[j], d });
      data.addCell(CellType::Tetrahedron, { a, a + step[i] + step[k], a + step[i], d });
    }
  }
  return data;
}
}
#endif
