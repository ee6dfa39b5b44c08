// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PieceFindings.h
 * @brief The remarks of Element Quality on a mesh besides its values, also for pieces on several
 * processes.
 */
#ifndef tautline_PieceFindings_h
#define tautline_PieceFindings_h

#include "MeshAdapter.h"
#include "tautline/Core/RankGroup.h"

#include <string>

namespace tautline
{
/// The remarks on a mesh, or on a piece of it.
struct PieceFindings
{
  Dimension dimension = Dimension::None;
  MeshRemarks remarks;
  CoincidentPoints seams; ///< without representatives
  Index near = 0, duplicates = 0;
  std::string firstApart, firstNear; ///< places
  std::string text;                  ///< the remark if there are no other pieces
};

/**
 * @brief Collects the findings.
 * @param reversed one flag per cell of mesh(), set if it lists its points in the opposite order; or
 * null
 * @param skip one flag per cell, set if it does not count; or null
 * @param curved the number of higher-order cells that are not measured only at their corners
 * @param elements whether only elements are measured, so that other cells deserve a remark
 */
PieceFindings findingsOf(const MeshAdapter& adapter, const unsigned char* reversed,
  const unsigned char* skip, Index curved, bool elements);

/**
 * @brief The remarks on the whole mesh, in sentences, on the first rank; "" on the others.
 * Collective.
 *
 * For a mesh in one piece, these are the remarks on the mesh. Otherwise numbers cover all pieces,
 * and points on seams are not mentioned, because pieces have copies of points.
 * @param own findings on the pieces of this rank that have cells
 */
std::string describeFindings(RankGroup& group, const std::vector<PieceFindings>& own);
}
#endif
