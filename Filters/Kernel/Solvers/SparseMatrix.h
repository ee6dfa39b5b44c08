// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SparseMatrix.h
 * @brief A sparse square matrix in compressed row storage, and its product with a vector.
 */
#ifndef tautline_SparseMatrix_h
#define tautline_SparseMatrix_h

#include "tautline/Core/Types.h"
#include "tautline/SolversExport.h"

#include <cstdint>
#include <vector>

namespace tautline
{
/// Row i has the columns columns[offsets[i]] .. columns[offsets[i + 1] - 1], in increasing order.
struct SparseMatrix
{
  Index size = 0; ///< rows and columns
  std::vector<Index> offsets = { 0 };
  std::vector<std::int32_t> columns;
  std::vector<double> values;

  Index nonzeros() const { return static_cast<Index>(this->columns.size()); }
  /// The entry, 0 if it is not stored. Uses a binary search.
  TAUTLINE_SOLVERS_EXPORT double at(Index row, Index column) const;
  /// y = A x. Bitwise identical for any number of threads (0: all cores).
  TAUTLINE_SOLVERS_EXPORT void multiply(const double* x, double* y, int threads = 0) const;
};

/**
 * @brief Replaces A, whose pattern must be symmetric, by (A + A^T) / 2.
 * @return the asymmetry: the Frobenius norm of (A - A^T) / 2 over the Frobenius norm of A
 */
TAUTLINE_SOLVERS_EXPORT double symmetrize(SparseMatrix& matrix, int threads = 0);

/// Removes the off-diagonal entries that are exactly zero.
TAUTLINE_SOLVERS_EXPORT void dropZeros(SparseMatrix& matrix);
}
#endif
