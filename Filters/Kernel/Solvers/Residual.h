// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Residual.h
 * @brief The residual of a vector in a linear system.
 * Internal: not installed.
 */
#ifndef tautline_Residual_h
#define tautline_Residual_h

#include "SparseMatrix.h"

#include <vector>

namespace tautline
{
/// Norms of b and b - A x; infinite if an entry is not finite.
struct Residual
{
  double before = 0.0, after = 0.0;
  /// |b - A x| / |b|; 0 if b is 0 or a value is not finite.
  double relative() const;
};

/// The 2-norm without overflow; infinite if an entry is not finite.
double norm2(const std::vector<double>& vector);

/// b - A x.
std::vector<double> remainder(
  const SparseMatrix& matrix, const double* b, const double* x, int threads);

/// On one rank, with Tautline's own matrix-vector product.
Residual residualOf(const SparseMatrix& matrix, const double* b, const double* x, int threads);
}
#endif
