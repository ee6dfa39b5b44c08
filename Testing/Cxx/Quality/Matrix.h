// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Matrix.h
 * @brief 2 x 2 and 3 x 3 matrices for the second evaluation of the metrics: plain and slow on
 * purpose.
 */

#ifndef tautline_Matrix_h
#define tautline_Matrix_h

#include "Loops.h"

#include <array>
#include <cmath>
#include <utility>

namespace tautline
{

struct Matrix
{
  int n;
  std::array<std::array<double, 3>, 3> m{};

  double& operator()(int r, int c) { return this->m[r][c]; }
  double operator()(int r, int c) const { return this->m[r][c]; }
};

/** The matrix whose entries are f(row, column). */
template <class Function>
Matrix makeMatrix(int n, const Function& f)
{
  Matrix result{ n };
  for (int r = 0; r < n; ++r)
  {
    for (int c = 0; c < n; ++c)
    {
      result(r, c) = f(r, c);
    }
  }
  return result;
}

inline Matrix identity(int n)
{
  return makeMatrix(n, [](int r, int c) { return r == c ? 1.0 : 0.0; });
}

inline Matrix operator*(const Matrix& a, const Matrix& b)
{
  return makeMatrix(a.n,
    [&](int r, int c) { return sumOf<double>(0, a.n, [&](int k) { return a(r, k) * b(k, c); }); });
}

inline Matrix operator*(double s, const Matrix& a)
{
  return makeMatrix(a.n, [&](int r, int c) { return s * a(r, c); });
}

inline Matrix operator-(const Matrix& a, const Matrix& b)
{
  return makeMatrix(a.n, [&](int r, int c) { return a(r, c) - b(r, c); });
}

inline Matrix transpose(const Matrix& a)
{
  return makeMatrix(a.n, [&](int r, int c) { return a(c, r); });
}

inline double trace(const Matrix& a)
{
  return a(0, 0) + a(1, 1) + (a.n == 3 ? a(2, 2) : 0.0);
}

/** Frobenius norm. */
inline double norm(const Matrix& a)
{
  return std::sqrt(trace(transpose(a) * a));
}

/** Gauss-Jordan elimination with pivoting: the inverse and the determinant. */
inline Matrix inverse(Matrix a, double* determinant = nullptr)
{
  Matrix result = identity(a.n);
  double det = 1;
  for (int k = 0; k < a.n; ++k)
  {
    int pivot = k;
    for (int r = k + 1; r < a.n; ++r)
    {
      pivot = std::abs(a(r, k)) > std::abs(a(pivot, k)) ? r : pivot;
    }
    std::swap(a.m[k], a.m[pivot]);
    std::swap(result.m[k], result.m[pivot]);
    det *= pivot == k ? a(k, k) : -a(k, k);
    const double scale = 1 / a(k, k);
    for (int c = 0; c < a.n; ++c)
    {
      a(k, c) *= scale;
      result(k, c) *= scale;
    }
    for (int r = 0; r < a.n; ++r)
    {
      const double factor = r == k ? 0.0 : a(r, k);
      for (int c = 0; c < a.n; ++c)
      {
        a(r, c) -= factor * a(k, c);
        result(r, c) -= factor * result(k, c);
      }
    }
  }
  if (determinant)
  {
    *determinant = det;
  }
  return result;
}

inline double determinant(const Matrix& a)
{
  double det = 0;
  inverse(a, &det);
  return det;
}

/** adj(T) = det(T) T^-1. */
inline Matrix adjugate(const Matrix& a)
{
  double det = 0;
  const Matrix result = inverse(a, &det);
  return det * result;
}

} // namespace tautline

#endif
