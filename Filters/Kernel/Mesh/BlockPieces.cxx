// SPDX-License-Identifier: BSD-3-Clause
#include "BlockPieces.h"

#include "SeamFacets.h"
#include "tautline/Core/UnionFind.h"

#include <algorithm>
#include <utility>

namespace tautline
{
namespace
{
/// A facet on the boundary of a piece.
struct BlockFacet : SeamFacet
{
  int block;
};

/// The box of a piece.
struct BlockBox
{
  int block;
  Vec3 low, high;

  bool contains(const Vec3& x) const
  {
    bool inside = true;
    for (int c = 0; c < 3; ++c)
    {
      inside = inside && this->low[c] <= x[c] && x[c] <= this->high[c];
    }
    return inside;
  }
};

BlockBox boxOf(const BlockPiece& piece)
{
  BlockBox box = { piece.block, { HUGE_VAL, HUGE_VAL, HUGE_VAL },
    { -HUGE_VAL, -HUGE_VAL, -HUGE_VAL } };
  const MeshView& view = piece.piece.mesh->view();
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    const Vec3 x = pointOf(view, p);
    for (int c = 0; c < 3; ++c)
    {
      box.low[c] = std::min(box.low[c], x[c]);
      box.high[c] = std::max(box.high[c], x[c]);
    }
  }
  return box;
}

/// The boundary facets that another block may also have, grouped by home rank.
std::vector<std::vector<BlockFacet>> facetsToSend(
  const RankGroup& group, const std::vector<BlockPiece>& pieces, const std::vector<BlockBox>& boxes)
{
  std::vector<std::vector<BlockFacet>> sent(static_cast<std::size_t>(group.size()));
  for (const BlockPiece& piece : pieces)
  {
    const Mesh& mesh = *piece.piece.mesh;
    const RankPiece places = { &mesh, nullptr, nullptr };
    const auto meetsOther = [&](Index point)
    {
      const Vec3 x = pointOf(mesh.view(), point); // nonfinite points are outside every box
      return std::any_of(boxes.begin(), boxes.end(),
        [&](const BlockBox& box) { return box.block != piece.block && box.contains(x); });
    };
    FacetTable(mesh, piece.piece.ghosts)
      .forEachFacet(
        [&](Index smallest, const FacetUse* uses, Index count)
        {
          if (count == 1 && meetsOther(smallest))
          {
            BlockFacet facet = { seamFacetOf(places, smallest, *uses), piece.block };
            facet.forward = facet.forward != piece.reversed;
            sent[homeOf(facet.hash, group)].push_back(facet);
          }
        });
  }
  return sent;
}
}

//------------------------------------------------------------------------------
std::vector<int> connectedBlocks(
  RankGroup& group, const std::vector<BlockPiece>& pieces, int blocks)
{
  std::vector<BlockBox> boxes;
  std::transform(pieces.begin(), pieces.end(), std::back_inserter(boxes), boxOf);
  const std::vector<std::vector<BlockFacet>> facets =
    group.exchangeItems(facetsToSend(group, pieces, group.gatherJoined(boxes)));

  using Pair = std::array<int, 2>;
  std::vector<Pair> pairs;
  // The blocks of a surface may be oriented differently: only other meshes compare the sides.
  const bool sided = group.any(std::any_of(pieces.begin(), pieces.end(),
    [](const BlockPiece& piece) { return piece.piece.mesh->dimension() != Dimension::Surface; }));
  forEachSeamPair(facets,
    [&](const SeamPlace& one, const SeamPlace& other)
    {
      const BlockFacet &a = facets[one.rank][one.number], &b = facets[other.rank][other.number];
      // Cells on the two sides traverse it in opposite directions.
      if (a.block != b.block && (!sided || a.forward != b.forward))
      {
        pairs.push_back({ std::min(a.block, b.block), std::max(a.block, b.block) });
      }
    });
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  UnionFind sets(blocks);
  for (const Pair& pair : group.gatherJoined(pairs))
  {
    sets.join(pair[0], pair[1]);
  }
  std::vector<int> connected;
  for (int block = 0; block < blocks; ++block)
  {
    connected.push_back(static_cast<int>(sets.find(block)));
  }
  return connected;
}
}
