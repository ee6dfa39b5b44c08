// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Pieces.h
 * @brief Meshes in pieces, with several points at each place of their seams, for tests.
 */
#ifndef tautline_Pieces_h
#define tautline_Pieces_h

#include "Blocks.h"

#include <utility>

namespace tautline
{
/** A mesh in pieces: the same cells in the same order, each with points of its piece. */
struct Pieces
{
  MeshData mesh;
  std::vector<Index> pointOf; ///< per point: its number in the whole mesh
  Index copies = 0;           ///< points that another one of a smaller id is at the place of
};

/** @param pieceOf the piece of a cell */
inline Pieces inPieces(const MeshData& whole, const std::function<Index(Index)>& pieceOf)
{
  Pieces result;
  std::map<std::pair<Index, Index>, Index> known;
  std::vector<char> seen(whole.numberOfPoints(), 0);
  for (Index cell = 0; cell < whole.numberOfCells(); ++cell)
  {
    std::vector<Index> nodes;
    for (Index n = whole.offsets[cell]; n < whole.offsets[cell + 1]; ++n)
    {
      const Index point = whole.connectivity[n];
      const auto [at, fresh] =
        known.emplace(std::make_pair(pieceOf(cell), point), result.mesh.numberOfPoints());
      if (fresh)
      {
        result.mesh.addPoint(whole.point(point));
        result.pointOf.push_back(point);
        result.copies += seen[point];
        seen[point] = 1;
      }
      nodes.push_back(at->second);
    }
    result.mesh.addCell(static_cast<int>(whole.types[cell]), nodes);
  }
  return result;
}

inline Vec3 centerOf(const MeshData& data, Index cell)
{
  Vec3 sum = { 0, 0, 0 };
  const Index begin = data.offsets[cell], end = data.offsets[cell + 1];
  for (Index n = begin; n < end; ++n)
  {
    sum += data.point(data.connectivity[n]);
  }
  return (1.0 / static_cast<double>(end - begin)) * sum;
}

/** Cut at x and y = `at`: four pieces. */
inline Pieces inQuarters(const MeshData& whole, double at)
{
  return inPieces(whole,
    [&](Index cell)
    {
      const Vec3 c = centerOf(whole, cell);
      return Index(c[0] > at) + 2 * Index(c[1] > at);
    });
}

/** Each cell with points of its own. */
inline Pieces exploded(const MeshData& whole)
{
  return inPieces(whole, [](Index cell) { return cell; });
}
}
#endif
