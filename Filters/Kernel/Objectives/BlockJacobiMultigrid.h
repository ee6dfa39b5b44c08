// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BlockJacobiMultigrid.h
 * @brief Multigrid for a matrix whose rows are distributed over ranks.
 *
 * The aggregates and the coarse matrices are independent of the distribution of the rows, up to
 * rounding: all ranks have the graph of all rows while aggregates are found, and all coarse levels,
 * on which they perform the same work. Only the finest level is distributed. There, the smoother is
 * block Jacobi, with half of the sizes of the couplings added to the diagonals (A. Baker et al.,
 * "Multigrid smoothers for ultraparallel computing", SIAM J. Sci. Comput. 33, 2011), instead of
 * Gauss-Seidel, which depends on the order of the rows. A cycle needs one halo exchange and one sum
 * of a coarse vector over the ranks. The memory of a rank therefore has a part that does not shrink
 * with more ranks: 8 bytes per coupling of two free points, and about an eighth of the whole
 * matrix.
 * Internal: not installed.
 */
#ifndef tautline_BlockJacobiMultigrid_h
#define tautline_BlockJacobiMultigrid_h

#include "Aggregation.h"
#include "MatrixRows.h"
#include "Multigrid.h"

namespace tautline
{
class TAUTLINE_KERNEL_EXPORT BlockJacobiMultigrid : public GridHierarchy
{
public:
  /// @param rows must outlive this @param threads 0: all cores. The result does not depend on it.
  BlockJacobiMultigrid(const MatrixRows& rows, int threads);

  /**
   * @brief See GridHierarchy. Collective, like apply().
   * @param matrix a row for each of rows(); rows of other ranks are not used
   */
  void build(const BlockMatrixView& matrix) override;
  void apply(const double* r, double* z) override;

private:
  /// See GridRows.h; for all local rows.
  template <int Dim>
  auto diagonals() const
  {
    return [this](Index row, int c) { return this->Diagonal[Dim * row + c]; };
  }
  template <int Dim>
  void invertDiagonals();
  /// Whether the matrix maps translations of all rows of all ranks to 0: no point is held.
  template <int Dim>
  bool isFloating() const;
  /// Removes the mean of each component, over the rows of all ranks.
  template <int Dim>
  void removeTranslation(double* z);
  template <int Dim>
  Graph couplings(const std::vector<std::int32_t>& numbers) const;
  template <int Dim>
  void aggregate();
  template <int Dim>
  void fillCoarse();
  template <int Dim>
  void cycle(const double* r, double* z);
  /// rest -= A x for owned rows; x has all rows.
  template <int Dim>
  void subtractProduct(const double* x, double* rest) const;
  /// Sums over the ranks at the listed positions, `components` numbers each.
  void addUp(const std::vector<std::vector<std::int32_t>>& places, const std::vector<double>& own,
    int components, std::vector<double>& to) const;

  const MatrixRows& Rows;
  int Threads, Reused = 0;
  bool Floating = false; ///< see isFloating()
  BlockMatrixView Matrix;
  std::vector<double> Diagonal; ///< entries, for all rows
  std::vector<double> Inverse;  ///< blocks, for owned rows
  /// work space: for all rows, for owned rows, for owned aggregates
  std::vector<double> All, Rest, Own;
  std::vector<double> Component; ///< for owned rows, if the matrix is floating

  // The next level, on all ranks.
  std::unique_ptr<Multigrid> Coarse; ///< null if rows hardly couple
  BlockMatrixView CoarseMatrix;
  std::vector<std::int32_t> Starts, Columns, Diagonals;
  std::vector<double> Blocks, R, Z;
  std::vector<std::int32_t> Aggregate;   ///< for each local row
  std::vector<std::int32_t> AggregateOf; ///< for each owned row: in the list of this rank
  std::vector<std::int32_t> PlaceOf;     ///< for each block of owned rows: in the list of this rank
  std::vector<Index> PlaceStarts;        ///< for each owned row
  /// Per rank: the aggregates and the coarse blocks to which its rows contribute.
  std::vector<std::vector<std::int32_t>> RankAggregates, RankPlaces;
};

/// The hierarchy for rows: Multigrid on one process, BlockJacobiMultigrid on several ranks.
TAUTLINE_KERNEL_EXPORT std::unique_ptr<GridHierarchy> makeGrids(
  const MatrixRows& rows, int threads);
}
#endif
