// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PieceFindings.h
 * @brief What Element Quality remarks on a mesh besides its values, also in pieces on processes.
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
  std::string text;                  ///< what there is to say if there are no other pieces
};

/**
 * @brief What there is to remark.
 * @param reversed one flag per cell of mesh(): it lists its points in the opposite order; or null
 * @param skip one flag per cell: it does not count; or null
 * @param curved how many cells of higher order are not measured at their corners only
 * @param elements whether elements alone are measured, so that other cells are worth a remark
 */
PieceFindings findingsOf(const MeshAdapter& adapter, const unsigned char* reversed,
  const unsigned char* skip, Index curved, bool elements);

/**
 * @brief The remarks on the whole mesh, in sentences, on the first rank; "" on the others.
 * Collective.
 *
 * Of a mesh in one piece they are those on the mesh. Else numbers are those of all pieces, and
 * points on seams are not worth a remark: pieces have copies of points.
 * @param own of the pieces of this rank with cells
 */
std::string describeFindings(RankGroup& group, const std::vector<PieceFindings>& own);
}
#endif
