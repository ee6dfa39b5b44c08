// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Tridiagonal.h
 * @brief Extreme eigenvalues of symmetric tridiagonal matrices, for Lanczos methods.
 * Internal: not installed.
 */
#ifndef tautline_Tridiagonal_h
#define tautline_Tridiagonal_h

#include "tautline/Core/Types.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace tautline
{
/// A symmetric tridiagonal matrix.
struct Tridiagonal
{
  std::vector<double> diagonal, beside; ///< beside[i] couples i and i + 1

  /// The number of eigenvalues below x (Sturm).
  Index below(double x) const
  {
    Index count = 0;
    double q = 1.0;
    for (std::size_t i = 0; i < this->diagonal.size(); ++i)
    {
      const double b = i > 0 ? this->beside[i - 1] : 0.0;
      q = this->diagonal[i] - x - (i > 0 ? b * b / q : 0.0);
      if (std::abs(q) < std::numeric_limits<double>::min() * 1e20)
      {
        q = -std::numeric_limits<double>::min() * 1e20;
      }
      count += q < 0.0;
    }
    return count;
  }

  /// The eigenvalue with `index` smaller eigenvalues, by bisection between Gershgorin's bounds.
  double eigenvalue(Index index) const
  {
    double low = 1e300, high = -1e300;
    for (std::size_t i = 0; i < this->diagonal.size(); ++i)
    {
      const double r = (i > 0 ? std::abs(this->beside[i - 1]) : 0.0) +
        (i + 1 < this->diagonal.size() ? std::abs(this->beside[i]) : 0.0);
      low = std::min(low, this->diagonal[i] - r);
      high = std::max(high, this->diagonal[i] + r);
    }
    for (int step = 0; step < 200 && high - low > 1e-15 * std::max(std::abs(low), std::abs(high));
         ++step)
    {
      const double middle = 0.5 * (low + high);
      (this->below(middle) > index ? high : low) = middle;
    }
    return 0.5 * (low + high);
  }

  /// The eigenvector, with norm 1, of an eigenvalue, by inverse iteration with pivoting.
  std::vector<double> eigenvector(double value) const
  {
    const std::size_t n = this->diagonal.size();
    std::vector<double> x(n);
    for (std::size_t i = 0; i < n; ++i)
    {
      x[i] = 1.0 + 0.3 * std::cos(1.7 * static_cast<double>(i)); // avoids symmetry
    }
    const double tiny = std::max(1e-300, 1e-15 * std::abs(value));
    for (int turn = 0; turn < 3; ++turn)
    {
      // Gaussian elimination of the band matrix; rows are exchanged if the entry below is larger.
      std::vector<double> a(n), b(n, 0.0), c(n, 0.0);
      double current = this->diagonal[0] - value, next = n > 1 ? this->beside[0] : 0.0;
      for (std::size_t i = 0; i + 1 < n; ++i)
      {
        const double under = this->beside[i], diagonal = this->diagonal[i + 1] - value;
        const double far = i + 2 < n ? this->beside[i + 1] : 0.0;
        if (std::abs(under) > std::abs(current))
        {
          const double factor = current / under;
          a[i] = under;
          b[i] = diagonal;
          c[i] = far;
          std::swap(x[i], x[i + 1]);
          x[i + 1] -= factor * x[i];
          current = next - factor * diagonal;
          next = -factor * far;
        }
        else
        {
          a[i] = std::abs(current) < tiny ? tiny : current;
          b[i] = next;
          const double factor = under / a[i];
          x[i + 1] -= factor * x[i];
          current = diagonal - factor * next;
          next = far;
        }
      }
      a[n - 1] = std::abs(current) < tiny ? tiny : current;
      double length = 0.0;
      for (std::size_t i = n; i-- > 0;)
      {
        const double right =
          x[i] - (i + 1 < n ? b[i] * x[i + 1] : 0.0) - (i + 2 < n ? c[i] * x[i + 2] : 0.0);
        x[i] = right / a[i];
        length = std::max(length, std::abs(x[i]));
      }
      double square = 0.0;
      for (double& v : x)
      {
        v /= length;
        square += v * v;
      }
      for (double& v : x)
      {
        v /= std::sqrt(square);
      }
    }
    return x;
  }
};

/// One end of the spectrum of the tridiagonal matrix, with the bound described in Lanczos.h.
struct RitzPair
{
  double value = 0.0, bound = 0.0;
  std::vector<double> vector;
};

/// @param residual the next off-diagonal entry
inline RitzPair ritzPair(const Tridiagonal& t, bool smallest, double residual)
{
  const auto n = static_cast<Index>(t.diagonal.size());
  RitzPair pair;
  pair.value = t.eigenvalue(smallest ? 0 : n - 1);
  pair.vector = t.eigenvector(pair.value);
  const double r = residual * std::abs(pair.vector.back());
  pair.bound = r;
  if (n > 1)
  {
    const double gap = std::abs(t.eigenvalue(smallest ? 1 : n - 2) - pair.value);
    pair.bound = gap > r ? std::min(r, r * r / gap) : r;
  }
  return pair;
}
}
#endif
