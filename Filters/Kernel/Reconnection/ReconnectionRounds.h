// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReconnectionRounds.h
 * @brief improveConnectivity() for tetrahedra distributed over ranks.
 *
 * In each round a tree of planes divides the mesh among the ranks, and each rank improves its part,
 * with the fixed tetrahedra beyond the surrounding seams (ReconnectionOptions::outside):
 *
 *        round 1: rank 0 | rank 1       round 2: rank 0 / rank 1       round 3: rank 0
 *                        |                             /                        ----------
 *                        |                            /                         rank 1
 *
 * The planes of a round cross the planes of the previous round, and work starts at the seams of
 * that round (ReconnectionOptions::starts). From the second round on, planes avoid the worst
 * tetrahedra that are below the target and have been near a seam in all rounds; rounds continue as
 * long as there are such tetrahedra. At seams, operations that change the number of points are left
 * to later rounds (ReconnectionOptions::postponed), and the first rounds only use a part of the
 * allowed change in the number of tetrahedra: next to fixed facets, it would be used up with little
 * gain.
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
/// The part of the mesh on a rank; may be empty.
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
 * @brief The result on a rank: the tetrahedra whose original cell is one of its cells, in
 * increasing order of these. Cell data come from the last round; the history covers the whole mesh:
 * the input, then one record per round. Shares replace the interpolations.
 */
struct RankReconnection : ReconnectionResult
{
  std::vector<Index> numbers; ///< per point; inserted points follow input points
  Index firstInserted = 0;    ///< the number of the first point that was inserted
  /// An input point and its weight in an inserted one.
  struct Share
  {
    Index number;
    double weight;
  };
  std::vector<Index> shareOffsets; ///< points + 1
  std::vector<Share> shares;       ///< of inserted points; their sum is 1. Other points have none.
};

/**
 * @brief Improves the connectivity in rounds. Collective. The result depends on the number of ranks
 * but not on the distribution; it is never worse than the input. New points and original cells are
 * traced back through all rounds to the input.
 *
 * Throws Error on all ranks in the cases in which improveConnectivity() throws on any, and for
 * options that need the whole mesh: BoundaryMotion::OnSurface, ReconnectionObjective::Metric,
 * improveMean, overlaps, sizes per point.
 * @param mesh moved from, so that its memory can be freed
 * @param options fixed, regions, markedFacets, outside and starts have no effect. `observer` is
 * called on all ranks, and stops the run if it returns false on any.
 * @param rounds the largest number of rounds, at least 1
 */
TAUTLINE_RECONNECTIONKERNEL_EXPORT RankReconnection improveConnectivity(
  RankGroup& group, RankTetrahedra mesh, const ReconnectionOptions& options, int rounds);

/// The reason why a mesh must be on one rank with these options, for example "a metric as
/// objective"; "" if it need not be.
TAUTLINE_RECONNECTIONKERNEL_EXPORT std::string needsOneRank(const ReconnectionOptions& options);
}
#endif
