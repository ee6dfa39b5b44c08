// SPDX-License-Identifier: BSD-3-Clause
#include "SparseMatrix.h"

#include "tautline/Core/Parallel.h"

#include <algorithm>

namespace tautline
{
namespace
{
/// Calls work(begin, end) for ranges of rows with about the same number of entries.
template <class Work>
void forEachRowRange(const SparseMatrix& matrix, int threads, const Work& work)
{
  constexpr Index entries = 1 << 15; // large enough to hide the scheduling overhead
  const Index ranges = std::max<Index>(1, std::min(matrix.size, matrix.nonzeros() / entries));
  runChunks(ranges, threads,
    [&](Index range) { work(range * matrix.size / ranges, (range + 1) * matrix.size / ranges); });
}

/// The position of an entry; -1 if it is not stored.
Index find(const SparseMatrix& matrix, Index row, Index column)
{
  const auto begin = matrix.columns.begin() + matrix.offsets[row];
  const auto end = matrix.columns.begin() + matrix.offsets[row + 1];
  const auto found = std::lower_bound(begin, end, column);
  return found != end && *found == column ? found - matrix.columns.begin() : -1;
}
}

//------------------------------------------------------------------------------
double SparseMatrix::at(Index row, Index column) const
{
  const Index k = find(*this, row, column);
  return k < 0 ? 0.0 : this->values[k];
}

//------------------------------------------------------------------------------
void SparseMatrix::multiply(const double* x, double* y, int threads) const
{
  forEachRowRange(*this, threads,
    [&](Index begin, Index end)
    {
      for (Index row = begin; row < end; ++row)
      {
        // Eight independent sums, so that additions do not wait for each other; their order is
        // fixed.
        double sums[8] = {};
        Index k = this->offsets[row];
        const Index last = this->offsets[row + 1];
        for (; k + 8 <= last; k += 8)
        {
          for (int l = 0; l < 8; ++l)
          {
            sums[l] += this->values[k + l] * x[this->columns[k + l]];
          }
        }
        for (; k < last; ++k)
        {
          sums[0] += this->values[k] * x[this->columns[k]];
        }
        y[row] =
          ((sums[0] + sums[4]) + (sums[1] + sums[5])) + ((sums[2] + sums[6]) + (sums[3] + sums[7]));
      }
    });
}

//------------------------------------------------------------------------------
double symmetrize(SparseMatrix& matrix, int threads)
{
  std::vector<double> difference(matrix.size, 0.0), all(matrix.size, 0.0);
  std::vector<double> mirrored(matrix.values.size());
  // Rows are visited in ascending order, hence the entries of a column from top to bottom: one
  // cursor per row finds each transposed entry.
  std::vector<Index> cursor(matrix.offsets.begin(), matrix.offsets.end() - 1);
  for (Index row = 0; row < matrix.size; ++row)
  {
    for (Index k = matrix.offsets[row]; k < matrix.offsets[row + 1]; ++k)
    {
      const Index column = matrix.columns[k];
      const Index mirror = cursor[column]++;
      if (mirror >= matrix.offsets[column + 1] || matrix.columns[mirror] != row)
      {
        throw Error("the pattern of the matrix is not symmetric");
      }
      mirrored[k] = matrix.values[mirror];
    }
  }
  forEachRowRange(matrix, threads,
    [&](Index begin, Index end)
    {
      for (Index row = begin; row < end; ++row)
      {
        for (Index k = matrix.offsets[row]; k < matrix.offsets[row + 1]; ++k)
        {
          const double a = matrix.values[k], b = mirrored[k];
          difference[row] += 0.25 * (a - b) * (a - b);
          all[row] += a * a;
          matrix.values[k] = 0.5 * (a + b);
        }
      }
    });
  double unsymmetric = 0.0, total = 0.0;
  for (Index row = 0; row < matrix.size; ++row)
  {
    unsymmetric += difference[row];
    total += all[row];
  }
  return total > 0.0 ? std::sqrt(unsymmetric / total) : 0.0;
}

//------------------------------------------------------------------------------
void dropZeros(SparseMatrix& matrix)
{
  Index kept = 0, begin = 0;
  for (Index row = 0; row < matrix.size; ++row)
  {
    const Index end = matrix.offsets[row + 1];
    for (Index k = begin; k < end; ++k)
    {
      if (matrix.values[k] != 0.0 || matrix.columns[k] == row)
      {
        matrix.columns[kept] = matrix.columns[k];
        matrix.values[kept++] = matrix.values[k];
      }
    }
    begin = end;
    matrix.offsets[row + 1] = kept;
  }
  matrix.columns.resize(kept);
  matrix.values.resize(kept);
}
}
