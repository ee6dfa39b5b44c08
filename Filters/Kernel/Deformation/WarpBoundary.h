// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpBoundary.h
 * @brief Self-intersections of a moved boundary.
 * Internal: not installed.
 */
#ifndef tautline_WarpBoundary_h
#define tautline_WarpBoundary_h

#include "tautline/Mesh/Ranks.h"

namespace tautline
{
/**
 * @class tautline::WarpBoundary
 * @brief Finds self-intersections of the prescribed boundary of a mesh after a motion.
 */
class WarpBoundary
{
public:
  /// Finds the edges (2D) or faces (3D) of one cell alone whose points are all prescribed. On
  /// several ranks, each facet is on the rank that owns its first point.
  WarpBoundary(
    const Mesh& mesh, const std::vector<unsigned char>& prescribed, const Ranks& ranks = {});

  struct Crossing
  {
    Index pairs = 0;                       ///< of edges, or of triangles, that cross
    std::array<Index, 2> first = { 0, 0 }; ///< a point of each of the first pair
  };
  /**
   * @brief Counts intersecting pairs without a common point: edges that cross or touch, and
   * triangles pierced by an edge of the other. Collective: on several ranks, all facets are
   * gathered on one rank.
   * @param points 3 per point of the mesh
   */
  Crossing crossings(const double* points) const;

private:
  using FacetList = std::vector<std::array<Index, 3>>;
  Crossing crossingsAmong(const FacetList& facets, const double* points) const;

  const Mesh& Input;
  Ranks TheRanks;
  int Nodes; ///< of a facet: 2 or 3
  FacetList Facets;
};
}
#endif
