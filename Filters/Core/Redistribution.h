// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Redistribution.h
 * @brief Redistribution of a mesh among the processes.
 */
#ifndef tautline_Redistribution_h
#define tautline_Redistribution_h

#include "TautlineCoreModule.h" // for export macro

#include "tautline/Mesh/DistributedMesh.h"

#include <string>
#include <vector>

namespace tautline
{
/// See vtkMeshMotionAlgorithm::SetRedistribute(); the values equal the values of the property.
enum class Redistribution
{
  None,
  KdTree,
  PtScotch
};

/**
 * @brief The process that will own each point of a piece, by PT-Scotch. If PT-Scotch cannot divide
 * the mesh, a k-d tree is used: `how` is set accordingly, and `why` receives the message, after a
 * blank. Collective. Throws Error if the processes do not communicate by MPI, and as
 * DistributedMesh does.
 * @return one per point; -1 for points that only ghost cells have
 */
TAUTLINECORE_EXPORT std::vector<int> ownersByGraph(
  RankGroup& group, const MeshPiece& piece, Redistribution& how, std::string& why);

/// "The mesh was redistributed among 3 processes by PT-Scotch.", or why it was not; "" for None.
TAUTLINECORE_EXPORT std::string dividedSentence(
  const RankGroup& group, Redistribution how, const std::string& why);
}
#endif
