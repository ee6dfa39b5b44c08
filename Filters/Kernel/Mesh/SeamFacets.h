// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SeamFacets.h
 * @brief The key that identifies a facet on the boundary of a piece on all ranks.
 * Internal: not installed.
 */
#ifndef tautline_SeamFacets_h
#define tautline_SeamFacets_h

#include "FacetTable.h"
#include "PartSign.h"
#include "PointKey.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <vector>

namespace tautline
{
/// A common origin for sizes on all ranks. Collective.
inline Vec3 commonOrigin(RankGroup& group, const std::vector<RankPiece>& pieces)
{
  std::vector<Vec3> own;
  for (const RankPiece& piece : pieces)
  {
    if (own.empty() && piece.mesh->view().numberOfPoints > 0)
    {
      own.push_back(finitePoint(piece.mesh->view()));
    }
  }
  for (const Vec3& point : group.gatherJoined(own))
  {
    if (std::isfinite(dot(point, point)))
    {
      return point;
    }
  }
  return { 0, 0, 0 };
}

/// A facet on the boundary of a piece.
struct SeamFacet
{
  PointKey key;       ///< of the point with the smallest key
  std::uint64_t hash; ///< of all points
  bool forward;       ///< the direction in which its cell traverses it

  bool operator<(const SeamFacet& other) const
  {
    return this->key != other.key ? this->key < other.key : this->hash < other.hash;
  }
};

/// A facet of one cell of a piece.
inline SeamFacet seamFacetOf(const RankPiece& piece, Index smallest, const FacetUse& use)
{
  // The points in the order in which the cell traverses the facet.
  std::array<Index, MaxFaceNodes> nodes = { smallest, use.others[0], -1, -1 };
  int size = 2;
  if (use.others[1] >= 0)
  {
    const Index next = use.others[use.forward ? 0 : 1], previous = use.others[use.forward ? 1 : 0];
    size = use.others[2] >= 0 ? 4 : 3;
    nodes = { smallest, next, size == 4 ? use.others[2] : previous, size == 4 ? previous : -1 };
  }
  else if (!use.forward)
  {
    std::swap(nodes[0], nodes[1]);
  }
  std::array<PointKey, MaxFaceNodes> keys;
  int first = 0;
  for (int k = 0; k < size; ++k)
  {
    keys[k] = keyOfPoint(piece, nodes[k]);
    first = keys[k] < keys[first] ? k : first;
  }
  SeamFacet facet = { keys[first], 0, first == 0 };
  if (size > 2)
  {
    facet.forward = keys[(first + 1) % size] < keys[(first + size - 1) % size];
  }
  std::sort(keys.begin(), keys.begin() + size);
  for (int k = 0; k < size; ++k)
  {
    facet.hash = addToHash(facet.hash, hashOf(keys[k]));
  }
  return facet;
}

/// A seam facet that a rank has sent: its position in the list.
struct SeamPlace
{
  std::size_t rank, number;
};

/// Calls visit(a, b) with two positions for each facet of exactly two cells: cells that meet at a
/// facet with more cells are not neighbors there.
template <class Facet, class Visit>
void forEachSeamPair(const std::vector<std::vector<Facet>>& received, const Visit& visit)
{
  std::vector<SeamPlace> places;
  for (std::size_t rank = 0; rank < received.size(); ++rank)
  {
    for (std::size_t i = 0; i < received[rank].size(); ++i)
    {
      places.push_back({ rank, i });
    }
  }
  const auto facetAt = [&](const SeamPlace& at) -> const SeamFacet&
  { return received[at.rank][at.number]; };
  std::sort(places.begin(), places.end(),
    [&](const SeamPlace& a, const SeamPlace& b)
    {
      const SeamFacet &one = facetAt(a), &other = facetAt(b);
      return one < other ||
        (!(other < one) && std::tie(a.rank, a.number) < std::tie(b.rank, b.number));
    });
  for (std::size_t begin = 0, end = 0; begin < places.size(); begin = end)
  {
    while (end < places.size() && !(facetAt(places[begin]) < facetAt(places[end])))
    {
      ++end;
    }
    if (end - begin == 2)
    {
      visit(places[begin], places[begin + 1]);
    }
  }
}
}
#endif
