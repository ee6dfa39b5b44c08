// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpingMeshes.h
 * @brief Blocks with a hole, and checks of the output of Warp Mesh.
 */
#ifndef tautline_WarpingMeshes_h
#define tautline_WarpingMeshes_h

#include "VtkMeshes.h"

#include "vtkMeshWarp.h"

#include <array>

namespace tautline
{
/// A block of n x n (x n) cubes, cut into cells, without the cube in its middle; n is odd. No point
/// is without a cell.
inline MeshData holedBlock(CellType type, Index n)
{
  const bool flat = topology(type).dimension == 2;
  const MeshData whole = blockMesh(type, n, n, flat ? 0 : n);
  const Mesh mesh(whole.view());
  MeshData data;
  std::map<Index, Index> numbers;
  for (Index cell = 0; cell < whole.numberOfCells(); ++cell)
  {
    const Vec3 d = mesh.center(cell, type) - Vec3{ n / 2.0, n / 2.0, flat ? 0 : n / 2.0 };
    if (std::max({ std::abs(d[0]), std::abs(d[1]), std::abs(d[2]) }) < 0.5)
    {
      continue;
    }
    std::vector<Index> nodes;
    for (Index k = whole.offsets[cell]; k < whole.offsets[cell + 1]; ++k)
    {
      const Index point = whole.connectivity[k];
      const auto added = numbers.emplace(point, data.numberOfPoints());
      if (added.second)
      {
        data.addPoint(whole.point(point));
      }
      nodes.push_back(added.first->second);
    }
    data.addCell(type, nodes);
  }
  return data;
}

/// 0 inside, 1 on the outer boundary, 2 on the hole of holedBlock().
inline std::vector<int> partsOf(const MeshData& data, Index n)
{
  const auto boundary = Mesh(data.view()).boundary().isBoundaryPoint;
  std::vector<int> parts(data.numberOfPoints());
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 p = data.point(i);
    const bool outer = std::min(p[0], p[1]) == 0 || std::max(p[0], p[1]) == double(n) ||
      p[2] == double(n) || (p[2] == 0 && topology(CellType(data.types[0])).dimension == 3);
    parts[i] = !boundary[i] ? 0 : outer ? 1 : 2;
  }
  return parts;
}

template <class F>
vtkSmartPointer<vtkDoubleArray> arrayOf(const char* name, Index size, int components, const F& f)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  TAUTLINE_SET(array, SetName(name), SetNumberOfComponents(components), SetNumberOfTuples(size));
  for (Index i = 0; i < size; ++i)
  {
    for (int k = 0; k < components; ++k)
    {
      array->SetComponent(i, k, f(i, k));
    }
  }
  return array;
}

inline Vec3 pointOf(vtkDataSet* data, Index i)
{
  Vec3 p;
  data->GetPoint(i, p.data());
  return p;
}

inline double value(vtkTable* table, const char* column, Index row = 0)
{
  return table->GetValueByName(row, column).ToDouble();
}

/// The largest distance between two sets of points.
inline double distance(const MeshData& a, const MeshData& b)
{
  return largestOf<double>(
    0, a.numberOfPoints(), [&](Index i) { return norm(a.point(i) - b.point(i)); });
}
}
#endif
