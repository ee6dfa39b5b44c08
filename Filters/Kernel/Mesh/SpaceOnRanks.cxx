// SPDX-License-Identifier: BSD-3-Clause
// The plane of a mesh in pieces on ranks.
#include "RankPieces.h"

#include "PlaneSearch.h"

#include <algorithm>

namespace tautline
{
namespace
{
/// Sums and maxima over the ranks.
struct RankTotals
{
  RankGroup& group;
  double sum(double value) { return this->group.orderlessSum({ value }); }
  double maximum(double value) { return this->group.maximum(value); }
};
}

//------------------------------------------------------------------------------
MeshSpace spaceOnRanks(RankGroup& group, const std::vector<RankPiece>& pieces)
{
  int dimension = 0;
  for (const RankPiece& piece : pieces)
  {
    for (const CellBlock& block : piece.mesh->blocks())
    {
      dimension = std::max(dimension, topology(block.type).dimension);
    }
  }
  dimension = static_cast<int>(group.maximum(static_cast<Index>(dimension)));
  MeshSpace space;
  space.dimension = dimension == 3 ? Dimension::Volume
    : dimension == 2               ? Dimension::Surface
                                   : Dimension::None;
  if (space.dimension == Dimension::Surface)
  {
    const auto corners = [&pieces](const auto& visit)
    {
      for (const RankPiece& piece : pieces)
      {
        forEachFiniteCorner(piece.mesh->view(), piece.mesh->blocks(), piece.ghosts, visit);
      }
    };
    RankTotals totals = { group };
    PlaneSearch(corners, totals).run(space);
  }
  return space;
}
}
