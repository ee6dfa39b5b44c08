// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Systems.h
 * @brief Sparse matrices with known properties for the tests of solvers.
 */
#ifndef tautline_Systems_h
#define tautline_Systems_h

#include "tautline/Solvers/LinearSolver.h"
#include "tautline/Solvers/SparseMatrix.h"

#include <cmath>
#include <functional>
#include <vector>

namespace tautline
{
/// Rows by rows: entry(row, column) for the columns of the 5-point stencil on an n x n grid, those
/// that are 0 too.
inline SparseMatrix gridMatrix(int n, const std::function<double(int, int)>& entry)
{
  SparseMatrix a;
  a.size = static_cast<Index>(n) * n;
  for (int i = 0; i < n * n; ++i)
  {
    for (const int j : { i - n, i - 1, i, i + 1, i + n }) // n > 1: in increasing order
    {
      const bool neighbour = j >= 0 && j < n * n && (i / n == j / n || i % n == j % n);
      if (neighbour)
      {
        a.columns.push_back(j);
        a.values.push_back(entry(i, j));
      }
    }
    a.offsets.push_back(a.nonzeros());
  }
  return a;
}

/// The 5-point Laplacian on n x n inner points of a square, times `scale`, plus `shift` on the
/// diagonal.
inline SparseMatrix laplacian(int n, double scale = 1.0, double shift = 0.0)
{
  return gridMatrix(n, [=](int i, int j) { return i == j ? 4.0 * scale + shift : -scale; });
}

/// The eigenvalue i, j (1 to n) of the 5-point Laplacian.
inline double laplacianEigenvalue(int n, int i, int j)
{
  const auto part = [=](int k)
  {
    const double s = std::sin(k * std::acos(-1.0) / (2.0 * (n + 1)));
    return 4.0 * s * s;
  };
  return part(i) + part(j);
}

/// Pseudo-random numbers from -1 to 1, the same everywhere.
inline std::vector<double> someVector(Index n, unsigned seed = 1)
{
  std::vector<double> x(static_cast<std::size_t>(n));
  std::uint64_t state = seed;
  for (double& value : x)
  {
    state = state * 6364136223846793005u + 1442695040888963407u;
    value = static_cast<double>(state >> 11) / 4503599627370496.0 - 1.0;
  }
  return x;
}

inline LinearSystem systemOf(const SparseMatrix& matrix)
{
  LinearSystem system;
  system.matrix = &matrix;
  return system;
}

/// |b - A x| / |b|
inline double relativeResidual(
  const SparseMatrix& a, const std::vector<double>& x, const std::vector<double>& b)
{
  std::vector<double> product(x.size());
  a.multiply(x.data(), product.data());
  double residual = 0.0, whole = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    residual += (b[i] - product[i]) * (b[i] - product[i]);
    whole += b[i] * b[i];
  }
  return std::sqrt(residual / whole);
}

/// The largest |x - y| over the largest |y|.
inline double relativeDifference(const std::vector<double>& x, const std::vector<double>& y)
{
  double difference = 0.0, size = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    difference = std::max(difference, std::abs(x[i] - y[i]));
    size = std::max(size, std::abs(y[i]));
  }
  return difference / size;
}
}
#endif
