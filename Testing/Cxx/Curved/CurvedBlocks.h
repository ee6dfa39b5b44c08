// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedBlocks.h
 * @brief Blocks of curved cells whose inner nodes were moved at random, for tests.
 */
#ifndef tautline_CurvedBlocks_h
#define tautline_CurvedBlocks_h

#include "Blocks.h"
#include "Set.h"
#include "tautline/Curving/CurveMesh.h"

namespace tautline
{
/** The same cells of a higher order, straight. */
inline MeshData raised(const MeshData& linear, int order)
{
  const Mesh mesh(linear.view());
  TAUTLINE_LET(CurvingOptions, options, order = order, smooth = false);
  const CurvingResult curved = curveMesh(mesh, linear.view(), {}, options);
  TAUTLINE_LET(MeshData, data, points = curved.points, types = curved.types,
    offsets = curved.offsets, connectivity = curved.connectivity);
  return data;
}

/** Flags of the points at the sides of a block from 0 to n. */
inline std::vector<unsigned char> sides(const MeshData& data, Index n, int dimension)
{
  std::vector<unsigned char> flags(data.numberOfPoints(), 0);
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    const Vec3 x = data.point(p);
    for (int c = 0; c < dimension; ++c)
    {
      flags[p] |= x[c] <= 1e-9 || x[c] >= static_cast<double>(n) - 1e-9;
    }
  }
  return flags;
}

/** A block of n x n (x n) cells with side 1 whose inner nodes were moved by up to an amplitude. */
inline MeshData movedCurvedBlock(CellType type, int order, Index n, double amplitude)
{
  const int dimension = topology(type).dimension;
  MeshData data = raised(blockMesh(type, n, n, dimension == 3 ? n : 0), order);
  const std::vector<unsigned char> fixed = sides(data, n, dimension);
  constexpr unsigned seed = 5;
  Random random(seed);
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    for (int c = 0; c < dimension; ++c)
    {
      const double by = amplitude * random.uniform(-1, 1);
      data.points[3 * p + c] += fixed[p] ? 0 : by;
    }
  }
  return data;
}

/** Cells that are not certified to be valid. */
inline Index invalidCells(const MeshData& data, const std::vector<double>& points)
{
  MeshView view = data.view();
  view.points = points.data();
  const Mesh mesh(view);
  std::vector<signed char> validity(view.numberOfCells);
  mesh.classifyCells(validity.data());
  certifyCurvedCells(mesh, {}, validity.data(), nullptr);
  return std::count_if(validity.begin(), validity.end(), isInvalid);
}
}
#endif
