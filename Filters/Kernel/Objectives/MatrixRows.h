// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MatrixRows.h
 * @brief The free points of a mesh as rows of a matrix.
 * Internal: not installed.
 */
#ifndef tautline_MatrixRows_h
#define tautline_MatrixRows_h

#include "tautline/Mesh/Ranks.h"

#include <cstdint>
#include <vector>

namespace tautline
{
/**
 * @class tautline::MatrixRows
 * @brief A row for each free local point. Vectors have one entry, or a few, for each row that this
 * process owns.
 *
 * On one process, it owns all rows: vectors are used in place. On several ranks, the rows are in
 * the order of the global numbers of the owned points and of the points around them; sums along a
 * row in the order of its columns are independent of the ranks.
 */
class TAUTLINE_KERNEL_EXPORT MatrixRows
{
public:
  /// @param points the free points, on one process in the order of the rows; on several ranks, the
  /// flags of the owners are used. Collective.
  MatrixRows(
    const std::vector<std::int32_t>& points, Index numberOfPoints, const Ranks& ranks = {});

  const Ranks& ranks() const { return this->TheRanks; }
  RankGroup& group() const { return this->TheRanks.mesh().group(); }
  Index rows() const { return static_cast<Index>(this->Points.size()); }
  /// The row of each local point; -1 if it is not free.
  const std::vector<std::int32_t>& rowOfPoint() const { return this->RowOfPoint; }
  /// Local point of each row.
  const std::vector<std::int32_t>& points() const { return this->Points; }
  /// The rows that this rank owns, ascending; only on several ranks.
  const std::vector<std::int32_t>& owned() const { return this->Owned; }
  std::size_t numberOfOwned() const
  {
    return this->TheRanks.several() ? this->Owned.size() : this->Points.size();
  }

  /**
   * @brief Extends values of owned rows, `components` each, to all rows; the values of other rows
   * are received from other ranks. Collective.
   * @param all work space for them
   * @return their address: on one process `own`
   */
  const double* spread(const double* own, std::vector<double>& all, int components) const;
  /// The same without communication; the values of rows of other ranks are undefined.
  const double* place(const double* own, std::vector<double>& all, int components) const;
  /// The memory for writing values of all rows, for pick().
  double* target(double* own, std::vector<double>& all, int components) const;
  void pick(const std::vector<double>& all, double* own, int components) const;

  /// Per row: its number among the rows of all ranks. Collective.
  std::vector<std::int32_t> numbers() const;

private:
  Ranks TheRanks;
  std::vector<std::int32_t> RowOfPoint, Points, Owned;
  DistributedMesh::Subset Halo; ///< of rows, not points
};
}
#endif
