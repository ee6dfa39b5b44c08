// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file UntangleOnRanks.h
 * @brief untangle() for a mesh on several ranks, with a result that does not depend on how the mesh
 * is cut, nor on how many ranks there are.
 */
#ifndef tautline_UntangleOnRanks_h
#define tautline_UntangleOnRanks_h

#include "UntangleOptions.h"
#include "tautline/Mesh/DistributedMesh.h"

#include <map>

namespace tautline
{
/// An element of the whole mesh that is still not valid.
struct RemainingElement
{
  Obstacle obstacle = Obstacle::Unknown;
  unsigned char type = 0;
  Vec3 center = { 0, 0, 0 };
};

struct RankUntangleResult
{
  /// The points are those of the local points; obstacles is empty; all else is of the whole mesh.
  UntangleResult result;
  /// The whole mesh, which would have been next, does not fit into the memory of the first rank.
  bool exceededMemory = false;
  /// The invalid elements of the whole mesh, by the global numbers of their points in increasing
  /// order; the same on all ranks.
  std::map<std::vector<Index>, RemainingElement> remaining;
};

/**
 * @brief Untangles. The cells within some rings of the invalid elements are gathered, in the order
 * of their global numbers; their connected parts are untangled by untangle(), each on one rank,
 * with the points around held. Where elements stay invalid, wider rings follow, and, but for
 * Effort::Local, the whole mesh on the first rank, if it fits into the memory there: Error if it
 * does not and nothing was repaired before, else exceededMemory. The method
 * UntangleMethod::Simultaneous, which moves all points, takes the whole mesh. Collective.
 * @param mesh volume meshes and planar ones; its points are where it starts; not changed
 * @param mirrored see Mesh::setMirrored(); the same on all ranks
 * @param options fixed: of local points, the owner's flag counts; not null. The observer is called
 * on all ranks after each width of the rings.
 */
TAUTLINE_KERNEL_EXPORT RankUntangleResult untangleOnRanks(
  DistributedMesh& mesh, bool mirrored, const UntangleOptions& options);
}
#endif
