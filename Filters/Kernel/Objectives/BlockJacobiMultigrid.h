// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BlockJacobiMultigrid.h
 * @brief Multigrid for a matrix whose rows are spread over ranks.
 * Internal: not installed.
 *
 * The aggregates and the coarse matrices are the same however the rows are spread, to rounding: all
 * ranks have the graph of all rows while aggregates are found, and all coarse levels, on which they
 * do the same work. Only the finest level is divided. There the smoother is block Jacobi, with half
 * of the sizes of the couplings added to the diagonals (A. Baker et al., "Multigrid smoothers for
 * ultraparallel computing", SIAM J. Sci. Comput. 33, 2011), instead of Gauss-Seidel, which depends
 * on the order of the rows. A cycle needs one exchange of values about the parts and one sum of a
 * coarse vector over the ranks. So the memory of a rank has a part that does not shrink with more
 * ranks: 8 bytes per coupling of two free points, and about an eighth of the whole matrix.
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
   * @brief See GridHierarchy. Collective, as apply().
   * @param matrix a row for each of rows(), of which those of other ranks are not used
   */
  void build(const BlockMatrixView& matrix) override;
  void apply(const double* r, double* z) override;

private:
  /// See GridRows.h: of all rows here.
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
  /// rest -= A x, of own rows; x of all rows.
  template <int Dim>
  void subtractProduct(const double* x, double* rest) const;
  /// Sums over the ranks of what each has at the places listed, `components` numbers each.
  void addUp(const std::vector<std::vector<std::int32_t>>& places, const std::vector<double>& own,
    int components, std::vector<double>& to) const;

  const MatrixRows& Rows;
  int Threads, Reused = 0;
  bool Floating = false; ///< see isFloating()
  BlockMatrixView Matrix;
  std::vector<double> Diagonal;       ///< entries, of all rows
  std::vector<double> Inverse;        ///< blocks, of own rows
  std::vector<double> All, Rest, Own; ///< work space: of all rows, of own rows, of own aggregates
  std::vector<double> Component;      ///< of own rows, where the matrix is floating

  // The next level, on all ranks.
  std::unique_ptr<Multigrid> Coarse; ///< null where rows hardly couple
  BlockMatrixView CoarseMatrix;
  std::vector<std::int32_t> Starts, Columns, Diagonals;
  std::vector<double> Blocks, R, Z;
  std::vector<std::int32_t> Aggregate;   ///< of each row here
  std::vector<std::int32_t> AggregateOf; ///< of each own row: in the list of this rank
  std::vector<std::int32_t> PlaceOf;     ///< of each block of own rows: in the list of this rank
  std::vector<Index> PlaceStarts;        ///< of each own row
  /// Of each rank: the aggregates and the coarse blocks that its rows add to.
  std::vector<std::vector<std::int32_t>> RankAggregates, RankPlaces;
};

/// The hierarchy for rows: Multigrid on one process, BlockJacobiMultigrid on several ranks.
TAUTLINE_KERNEL_EXPORT std::unique_ptr<GridHierarchy> makeGrids(
  const MatrixRows& rows, int threads);
}
#endif
