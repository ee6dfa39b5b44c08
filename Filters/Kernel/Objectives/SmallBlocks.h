// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SmallBlocks.h
 * @brief Arithmetic of the small blocks of a matrix, row by row.
 * Internal: not installed.
 */
#ifndef tautline_SmallBlocks_h
#define tautline_SmallBlocks_h

#include <algorithm>
#include <cmath>

namespace tautline
{
/// The smallest pivot of a factorization, relative to the largest diagonal entry of its block.
constexpr double flattestPivot = 1e-14;

/// y += block x.
template <int Dim>
void multiplyAdd(const double* block, const double* x, double* y)
{
  for (int r = 0; r < Dim; ++r)
  {
    for (int c = 0; c < Dim; ++c)
    {
      y[r] += block[Dim * r + c] * x[c];
    }
  }
}

/// The inverse of a symmetric positive semidefinite block, by a Cholesky factorization after
/// scaling to a unit diagonal, with pivots bounded away from 0.
template <int Dim>
void invert(const double* block, double* inverse)
{
  double scale[Dim], lower[Dim][Dim] = {}, w[Dim][Dim] = {};
  for (int r = 0; r < Dim; ++r)
  {
    const double d = block[Dim * r + r];
    scale[r] = d > 0 ? 1 / std::sqrt(d) : 0.0;
    scale[r] = std::isfinite(scale[r]) ? scale[r] : 0.0;
  }
  for (int r = 0; r < Dim; ++r)
  {
    for (int c = 0; c <= r; ++c)
    {
      double sum = r == c ? 1.0 : scale[r] * scale[c] * block[Dim * r + c];
      for (int k = 0; k < c; ++k)
      {
        sum -= lower[r][k] * lower[c][k];
      }
      lower[r][c] = r == c ? std::sqrt(std::max(sum, flattestPivot)) : sum / lower[c][c];
    }
  }
  // The inverse of the factor.
  for (int c = 0; c < Dim; ++c)
  {
    w[c][c] = 1 / lower[c][c];
    for (int r = c + 1; r < Dim; ++r)
    {
      double sum = 0;
      for (int k = c; k < r; ++k)
      {
        sum -= lower[r][k] * w[k][c];
      }
      w[r][c] = sum / lower[r][r];
    }
  }
  for (int r = 0; r < Dim; ++r)
  {
    for (int c = 0; c < Dim; ++c)
    {
      double sum = 0;
      for (int k = std::max(r, c); k < Dim; ++k)
      {
        sum += w[k][r] * w[k][c];
      }
      inverse[Dim * r + c] = scale[r] * scale[c] * sum;
    }
  }
}
}
#endif
