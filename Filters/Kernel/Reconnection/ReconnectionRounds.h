// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReconnectionRounds.h
 * @brief improveConnectivity() for tetrahedra that are spread over ranks.
 *
 * In each round a tree of planes divides the mesh among the ranks, and each of them improves its
 * part, with the tetrahedra beyond the seams around it, which stay (ReconnectionOptions::outside):
 *
 *        round 1: rank 0 | rank 1       round 2: rank 0 / rank 1       round 3: rank 0
 *                        |                             /                        ----------
 *                        |                            /                         rank 1
 *
 * The planes of a round cross those of the round before, and work starts at the seams of that one
 * (ReconnectionOptions::starts). From the second round on they are away from the worst of the
 * tetrahedra that are below the target and have been near a seam in all rounds; there are rounds as
 * long as there are such. At seams, what changes the number of points is left to later
 * rounds (ReconnectionOptions::postponed), and of the number of tetrahedra that may come or go the
 * first rounds use a part only: beside facets that stay it would be used up with little gain.
 */
#ifndef tautline_ReconnectionRounds_h
#define tautline_ReconnectionRounds_h

#include "Reconnection.h"
#include "tautline/Core/RankGroup.h"
#include "tautline/ReconnectionKernelExport.h"

#include <string>
#include <vector>

namespace tautline
{
/// What a rank has of the mesh; may be empty.
struct RankTetrahedra
{
  std::vector<Index> numbers;       ///< per point, from 0: the same on all ranks for the same point
  std::vector<double> points;       ///< x y z per point
  std::vector<unsigned char> fixed; ///< per point, the same on all ranks
  std::vector<Index> tetrahedra;    ///< four points each, of this rank; each on one rank only
  std::vector<Index> regions;       ///< per tetrahedron; empty: one region, on all ranks
  /// Numbers of points: ReconnectionOptions::markedFacets, each on any of the ranks.
  std::vector<std::array<Index, 3>> markedFacets;
  bool mirrored = false; ///< see Mesh::setMirrored(); the same on all ranks
};

/**
 * @brief What a rank gets: the tetrahedra that have one of its own as original cell, which are in
 * increasing order of these. What is of cells is of the last round, the history of the whole mesh:
 * the input, then a record per round. There are no interpolations, but shares.
 */
struct RankReconnection : ReconnectionResult
{
  std::vector<Index> numbers; ///< per point; inserted ones follow those of the input
  Index firstInserted = 0;    ///< the number of the first point that was inserted
  /// A point of the input, and its part in an inserted one.
  struct Share
  {
    Index number;
    double weight;
  };
  std::vector<Index> shareOffsets; ///< points + 1
  std::vector<Share> shares;       ///< of inserted points; their sum is 1. Of others none.
};

/**
 * @brief Improves the connectivity in rounds. Collective. The result depends on the number of ranks
 * but not on which of them has what; it is never worse than the input. New points of a later round
 * follow from those of former ones, original cells too.
 *
 * Throws Error on all ranks where improveConnectivity() would on any, and for options that need the
 * whole mesh: BoundaryMotion::OnSurface, ReconnectionObjective::Metric, improveMean, overlaps,
 * sizes per point.
 * @param mesh moved from, so that its memory can be freed
 * @param options fixed, regions, markedFacets, outside and starts have no effect. `observer` is
 * called on all ranks, and returns false on any to stop.
 * @param rounds the largest number of rounds, at least 1
 */
TAUTLINE_RECONNECTIONKERNEL_EXPORT RankReconnection improveConnectivity(
  RankGroup& group, RankTetrahedra mesh, const ReconnectionOptions& options, int rounds);

/// Why a mesh has to be on one rank with these options: "a metric as objective"; "" if it has not.
TAUTLINE_RECONNECTIONKERNEL_EXPORT std::string needsOneRank(const ReconnectionOptions& options);
}
#endif
