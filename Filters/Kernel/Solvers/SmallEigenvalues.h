// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SmallEigenvalues.h
 * @brief Eigenvalues of small matrices such as element matrices.
 * Internal: not installed.
 */
#ifndef tautline_SmallEigenvalues_h
#define tautline_SmallEigenvalues_h

#include <algorithm>
#include <cmath>

namespace tautline
{
/**
 * @brief The largest eigenvalue of a symmetric matrix with n rows, by Jacobi's method; overwrites
 * the matrix.
 *
 * Source: G. H. Golub, C. F. Van Loan, Matrix Computations, 4th ed., section 8.5.
 */
inline double largestEigenvalue(double* a, int n)
{
  constexpr int sweeps = 30;
  constexpr double small = 1e-16;
  for (int sweep = 0; sweep < sweeps; ++sweep)
  {
    bool rotated = false;
    for (int p = 0; p < n; ++p)
    {
      for (int q = p + 1; q < n; ++q)
      {
        const double apq = a[n * p + q];
        // The diagonal of a semidefinite matrix bounds the off-diagonal entries; an indefinite
        // matrix takes a few more sweeps.
        if (std::abs(apq) <= small * (std::abs(a[n * p + p]) + std::abs(a[n * q + q])))
        {
          continue;
        }
        rotated = true;
        const double tau = (a[n * q + q] - a[n * p + p]) / (2.0 * apq);
        const double t = (tau >= 0.0 ? 1.0 : -1.0) / (std::abs(tau) + std::sqrt(1.0 + tau * tau));
        const double c = 1.0 / std::sqrt(1.0 + t * t), s = t * c;
        for (int k = 0; k < n; ++k)
        {
          const double akp = a[n * k + p], akq = a[n * k + q];
          a[n * k + p] = c * akp - s * akq;
          a[n * k + q] = s * akp + c * akq;
        }
        for (int k = 0; k < n; ++k)
        {
          const double apk = a[n * p + k], aqk = a[n * q + k];
          a[n * p + k] = c * apk - s * aqk;
          a[n * q + k] = s * apk + c * aqk;
        }
      }
    }
    if (!rotated)
    {
      break;
    }
  }
  double largest = a[0];
  for (int p = 1; p < n; ++p)
  {
    largest = std::max(largest, a[n * p + p]);
  }
  return largest;
}
}
#endif
