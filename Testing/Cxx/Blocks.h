// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Blocks.h
 * @brief Blocks of cells that fit each other, of any type, and meshes in a random order.
 */

#ifndef tautline_Blocks_h
#define tautline_Blocks_h

#include "Meshes.h"

namespace tautline
{

/**
 * A block of nx x ny x nz unit cubes, each cut into cells of one type: itself; two wedges; five
 * tetrahedra, mirrored in every other cube so that the faces fit; six pyramids round its center.
 * With nz = 0 a rectangle of squares or of triangles, two to a square.
 */
inline MeshData blockMesh(CellType type, Index nx, Index ny, Index nz)
{
  MeshData data;
  const bool flat = nz == 0;
  for (Index k = 0; k <= nz; ++k)
  {
    for (Index j = 0; j <= ny; ++j)
    {
      for (Index i = 0; i <= nx; ++i)
      {
        data.addPoint({ double(i), double(j), double(k) });
      }
    }
  }
  for (Index k = 0; k < (flat ? 1 : nz); ++k)
  {
    for (Index j = 0; j < ny; ++j)
    {
      for (Index i = 0; i < nx; ++i)
      {
        auto id = [&](int a, int b, int c)
        { return i + a + (nx + 1) * (j + b + (ny + 1) * (k + c)); };
        const Index p0 = id(0, 0, 0), p1 = id(1, 0, 0), p2 = id(1, 1, 0), p3 = id(0, 1, 0);
        if (type == CellType::Quadrilateral)
        {
          data.addCell(type, { p0, p1, p2, p3 });
          continue;
        }
        if (type == CellType::Triangle)
        {
          data.addCell(type, { p0, p1, p2 });
          data.addCell(type, { p0, p2, p3 });
          continue;
        }
        const Index p4 = id(0, 0, 1), p5 = id(1, 0, 1), p6 = id(1, 1, 1), p7 = id(0, 1, 1);
        if (type == CellType::Hexahedron)
        {
          data.addCell(type, { p0, p1, p2, p3, p4, p5, p6, p7 });
        }
        else if (type == CellType::Wedge)
        {
          data.addCell(type, { p0, p2, p1, p4, p6, p5 });
          data.addCell(type, { p0, p3, p2, p4, p7, p6 });
        }
        else if (type == CellType::Pyramid)
        {
          const Index c = data.addPoint({ i + 0.5, j + 0.5, k + 0.5 });
          data.addCell(type, { p0, p1, p2, p3, c });
          data.addCell(type, { p4, p7, p6, p5, c });
          data.addCell(type, { p0, p4, p5, p1, c });
          data.addCell(type, { p1, p5, p6, p2, c });
          data.addCell(type, { p2, p6, p7, p3, c });
          data.addCell(type, { p3, p7, p4, p0, c });
        }
        else if ((i + j + k) % 2 == 0)
        {
          data.addCell(type, { p0, p1, p2, p5 });
          data.addCell(type, { p0, p2, p3, p7 });
          data.addCell(type, { p0, p5, p7, p4 });
          data.addCell(type, { p2, p7, p5, p6 });
          data.addCell(type, { p0, p2, p7, p5 });
        }
        else
        {
          data.addCell(type, { p1, p3, p0, p4 });
          data.addCell(type, { p1, p2, p3, p6 });
          data.addCell(type, { p1, p6, p4, p5 });
          data.addCell(type, { p3, p4, p6, p7 });
          data.addCell(type, { p1, p3, p4, p6 });
        }
      }
    }
  }
  return data;
}

/** The same mesh with its points and cells listed in a random order. */
inline MeshData shuffled(const MeshData& mesh, unsigned seed)
{
  Random random(seed);
  const std::vector<Index> newId = random.permutation(mesh.numberOfPoints());
  MeshData result;
  result.points.resize(mesh.points.size());
  for (Index i = 0; i < mesh.numberOfPoints(); ++i)
  {
    result.setPoint(newId[i], mesh.point(i));
  }
  for (const Index cell : random.permutation(mesh.numberOfCells()))
  {
    std::vector<Index> nodes;
    for (Index n = mesh.offsets[cell]; n < mesh.offsets[cell + 1]; ++n)
    {
      nodes.push_back(newId[mesh.connectivity[n]]);
    }
    result.addCell(static_cast<int>(mesh.types[cell]), nodes);
  }
  return result;
}

/** A block with all its points, the boundary's too, moved by up to `amplitude` in each direction it
 * has. */
inline MeshData movedBlock(CellType type, Index n, double amplitude, unsigned seed = 31)
{
  const bool flat = topology(type).dimension == 2;
  MeshData data = blockMesh(type, n, n, flat ? 0 : n);
  Random random(seed);
  data.transform(
    [&](Vec3 p)
    {
      const Vec3 d = random.vector(-amplitude, amplitude);
      return p + Vec3{ d[0], d[1], flat ? 0 : d[2] };
    });
  return data;
}

/** A Moebius band of this many quadrilaterals: a surface without a consistent orientation. */
inline MeshData moebiusBand(Index count)
{
  constexpr double half = 0.3; // of its width
  MeshData band;
  for (Index i = 0; i < count; ++i)
  {
    const double a = 2 * M_PI * static_cast<double>(i) / static_cast<double>(count);
    const Vec3 out = { std::cos(a), std::sin(a), 0 };
    const Vec3 across = half * (std::cos(a / 2) * out + Vec3{ 0, 0, std::sin(a / 2) });
    band.addPoint(out - across);
    band.addPoint(out + across);
  }
  for (Index i = 0; i + 1 < count; ++i)
  {
    band.addCell(CellType::Quadrilateral, { 2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2 });
  }
  band.addCell(CellType::Quadrilateral, { 2 * count - 2, 2 * count - 1, 0, 1 });
  return band;
}

} // namespace tautline

#endif
