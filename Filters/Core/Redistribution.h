// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Redistribution.h
 * @brief Whether and how a mesh is divided anew among the processes.
 */
#ifndef tautline_Redistribution_h
#define tautline_Redistribution_h

#include "TautlineCoreModule.h" // for export macro

#include "tautline/Mesh/DistributedMesh.h"

#include <string>
#include <vector>

namespace tautline
{
/// See vtkMeshMotionAlgorithm::SetRedistribute(); the numbers are those of the property.
enum class Redistribution
{
  None,
  KdTree,
  PtScotch
};

/**
 * @brief The process that shall own each point of a piece, by PT-Scotch. Where it cannot divide the
 * mesh, by a k-d tree: then `how` becomes that, and `why` gets the message, behind a blank.
 * Collective. Throws Error if the processes do not communicate by MPI, and as DistributedMesh does.
 * @return per point; -1 for one that no cell has but ghosts
 */
TAUTLINECORE_EXPORT std::vector<int> ownersByGraph(
  RankGroup& group, const MeshPiece& piece, Redistribution& how, std::string& why);

/// "The mesh was divided anew among 3 processes by PT-Scotch.", and why it was not; "" for None.
TAUTLINECORE_EXPORT std::string dividedSentence(
  const RankGroup& group, Redistribution how, const std::string& why);
}
#endif
