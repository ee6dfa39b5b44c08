// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MatrixRows.h
 * @brief The free points of a mesh on several ranks as rows of a matrix. Internal: not installed.
 */
#ifndef tautline_MatrixRows_h
#define tautline_MatrixRows_h

#include "tautline/Mesh/DistributedMesh.h"

#include <cstdint>
#include <vector>

namespace tautline
{
/**
 * @class tautline::MatrixRows
 * @brief A row for each free local point, in the order of the global numbers: of those that this
 * rank owns, and of those about them. Vectors have one entry, or a few, for each row that the rank
 * owns. What is summed along a row in the order of its columns does not depend on the ranks.
 */
class TAUTLINE_KERNEL_EXPORT MatrixRows
{
public:
  /// @param free one flag per local point, the owner's count. Collective.
  MatrixRows(const DistributedMesh& mesh, std::vector<unsigned char> free);

  RankGroup& group() const { return this->TheMesh.group(); }
  Index rows() const { return this->Rows; }
  /// Row of each local point, -1 for those that are not free.
  const std::vector<std::int32_t>& rowOfPoint() const { return this->RowOfPoint; }
  /// Local point of each row.
  const std::vector<std::int32_t>& points() const { return this->Points; }
  /// The rows that this rank owns, ascending.
  const std::vector<std::int32_t>& owned() const { return this->Owned; }
  std::size_t numberOfOwned() const { return this->Owned.size(); }

  /**
   * @brief Values of own rows, `components` each, as values of all rows, of which those of other
   * ranks are received. Collective.
   */
  void spread(const double* own, double* all, int components) const;
  /// Own rows only, without communication; the others keep their values.
  void place(const double* own, double* all, int components) const;
  void pick(const double* all, double* own, int components) const;

  /// Per row: its number among the rows of all ranks. Collective.
  std::vector<std::int32_t> numbers() const;

private:
  const DistributedMesh& TheMesh;
  Index Rows = 0;
  std::vector<std::int32_t> RowOfPoint, Points, Owned;
  DistributedMesh::Subset Halo; ///< of rows, not points
};
}
#endif
