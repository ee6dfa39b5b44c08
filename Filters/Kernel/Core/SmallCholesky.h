// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SmallCholesky.h
 * @brief Cholesky factors of small dense matrices, with a shift that makes them positive definite.
 * Internal: not installed.
 */
#ifndef tautline_SmallCholesky_h
#define tautline_SmallCholesky_h

#include <cmath>

namespace tautline
{
/// The contents of the diagonal of a factor.
enum class CholeskyDiagonal
{
  Root,       ///< the diagonal of L; solving divides by it: for one right-hand side
  InverseRoot ///< its inverse; solving multiplies by it: for many right-hand sides
};

/**
 * @brief The lower triangle of L with L L^T = A + shift I, by rows: L00, L10, L11, L20, ...
 * @tparam N rows of A, 1 to about 8
 */
template <int N, CholeskyDiagonal Diagonal>
struct SmallCholesky
{
  static constexpr int Entries = N * (N + 1) / 2;

  /**
   * @brief Factors A + shift I.
   * @param A symmetric, only the lower triangle is read
   * @param smallestPivot the pivots (before the square root) must exceed it
   * @param L array of `Entries` numbers; incomplete if the result is false
   * @return whether the matrix is positive definite, judged by these pivots
   */
  static bool factor(const double (&A)[N][N], double shift, double smallestPivot, double* L)
  {
    bool definite = true;
    double* row = L;
    for (int r = 0; r < N && definite; row += ++r)
    {
      const double* column = L;
      for (int c = 0; c <= r; column += ++c)
      {
        double x = A[r][c] + (r == c ? shift : 0.0);
        for (int k = 0; k < c; ++k)
        {
          x -= row[k] * column[k];
        }
        if (r == c)
        {
          definite = x > smallestPivot;
          row[c] = Diagonal == CholeskyDiagonal::Root ? std::sqrt(x) : 1.0 / std::sqrt(x);
        }
        else
        {
          row[c] = overDiagonal(x, column[c]);
        }
      }
    }
    return definite;
  }

  /// Replaces x, N numbers, by the solution of L L^T y = x.
  static void solve(const double* L, double* x)
  {
    const double* row = L;
    for (int r = 0; r < N; row += ++r)
    {
      for (int k = 0; k < r; ++k)
      {
        x[r] -= row[k] * x[k];
      }
      x[r] = overDiagonal(x[r], row[r]);
    }
    for (int r = N - 1; r >= 0; --r)
    {
      // A single solve sums along the column of L, many solves read L by rows.
      if constexpr (Diagonal == CholeskyDiagonal::Root)
      {
        for (int k = r + 1; k < N; ++k)
        {
          x[r] -= L[k * (k + 1) / 2 + r] * x[k];
        }
      }
      row = L + r * (r + 1) / 2;
      x[r] = overDiagonal(x[r], row[r]);
      if constexpr (Diagonal == CholeskyDiagonal::InverseRoot)
      {
        for (int k = 0; k < r; ++k)
        {
          x[k] -= row[k] * x[r];
        }
      }
    }
  }

private:
  static double overDiagonal(double x, double diagonal)
  {
    return Diagonal == CholeskyDiagonal::Root ? x / diagonal : x * diagonal;
  }
};
}
#endif
