// SPDX-License-Identifier: BSD-3-Clause
#include "Residual.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tautline
{
double norm2(const std::vector<double>& vector)
{
  if (!std::all_of(vector.begin(), vector.end(), [](double value) { return std::isfinite(value); }))
  {
    return std::numeric_limits<double>::infinity();
  }
  double largest = 0.0;
  for (const double value : vector)
  {
    largest = std::max(largest, std::abs(value));
  }
  double sum = 0.0;
  for (const double value : vector)
  {
    const double scaled = largest > 0.0 ? value / largest : 0.0;
    sum += scaled * scaled;
  }
  return largest * std::sqrt(sum);
}

double Residual::relative() const
{
  const bool defined = this->before > 0.0 && std::isfinite(this->after);
  return defined ? this->after / this->before : 0.0;
}

std::vector<double> remainder(
  const SparseMatrix& matrix, const double* b, const double* x, int threads)
{
  std::vector<double> result(static_cast<std::size_t>(matrix.size));
  matrix.multiply(x, result.data(), threads);
  for (double& value : result)
  {
    value = *b++ - value;
  }
  return result;
}

Residual residualOf(const SparseMatrix& matrix, const double* b, const double* x, int threads)
{
  const std::vector<double> whole(b, b + matrix.size);
  return { norm2(whole), norm2(remainder(matrix, b, x, threads)) };
}
}
