// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GridRows.h
 * @brief Definitions shared by grid hierarchies: the matrix, and functions of its rows.
 *
 * diagonal(row, c) is entry c of the diagonal of the diagonal block of a row, which may be on
 * another rank.
 * Internal: not installed.
 */
#ifndef tautline_GridRows_h
#define tautline_GridRows_h

#include "tautline/Core/Types.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tautline
{
/// The common part of the hierarchies of one process and of several ranks.
namespace multigrid
{
constexpr int pairings = 3;            ///< of rows, from a level to the next
constexpr double slowCoarsening = 0.8; ///< ratio of rows beyond which no coarser level is made
constexpr double floatingSum = 1e-10;  ///< of a row, relative to nearby diagonals: rounding
/// number of matrices of one pattern after which rows are aggregated again
constexpr int rebuildAfter = 4;
}

/// A sparse matrix of Size x Size blocks with a symmetric pattern, on arrays of the caller.
struct BlockMatrixView
{
  int size = 0;                            ///< of a block: 2 or 3
  Index rows = 0;                          ///< of blocks
  const std::int32_t* starts = nullptr;    ///< rows + 1 positions
  const std::int32_t* columns = nullptr;   ///< of each position, ascending within a row
  const std::int32_t* diagonals = nullptr; ///< position of the diagonal block of each row
  const double* blocks = nullptr;          ///< size x size numbers per position, row by row
};

/**
 * @brief The term added to the diagonal of a row for its couplings to rows outside a range, which
 * sweeps ignore: half of the sum of their sizes, in units of the diagonals. The smoother then
 * converges (A. Baker et al., "Multigrid smoothers for ultraparallel computing", SIAM J. Sci.
 * Comput. 33, 2011: l1 smoothers).
 */
template <int Dim, class Diagonal>
void addOutside(const BlockMatrixView& a, Index row, Index begin, Index end,
  const Diagonal& diagonal, double* added)
{
  std::fill_n(added, Dim, 0.0);
  for (std::int32_t i = a.starts[row]; i < a.starts[row + 1]; ++i)
  {
    const std::int32_t column = a.columns[i];
    if (column >= begin && column < end)
    {
      continue;
    }
    const double* block = a.blocks + static_cast<Index>(Dim * Dim) * i;
    for (int r = 0; r < Dim; ++r)
    {
      for (int c = 0; c < Dim; ++c)
      {
        const double ratio = diagonal(row, r) / diagonal(column, c);
        const double part = 0.5 * std::abs(block[Dim * r + c]) * std::sqrt(ratio);
        added[r] += std::isfinite(part) ? part : 0.0;
      }
    }
  }
}

/// The scale of the couplings of a row, in units of the diagonal, so that all numbers stay in the
/// range of float.
template <int Dim, class Diagonal>
double unitOf(Index row, const Diagonal& diagonal)
{
  double trace = 0;
  for (int c = 0; c < Dim; ++c)
  {
    trace += diagonal(row, c);
  }
  return trace > 0 ? 1 / std::sqrt(trace) : 0.0;
}

/// The coupling of rows: the size of the contribution of their block to the rigidity.
template <int Dim>
float couplingOf(const double* block, double unitOfRow, double unitOfColumn)
{
  double sum = 0;
  for (int c = 0; c < Dim; ++c)
  {
    sum -= block[(Dim + 1) * c];
  }
  return static_cast<float>(std::max(0.0, sum * unitOfRow * unitOfColumn));
}

/// Whether a row maps translations of all rows to 0.
template <int Dim, class Diagonal>
bool isFloatingRow(const BlockMatrixView& a, Index row, const Diagonal& diagonal)
{
  // The accuracy of entries is relative to the largest entry of an element, which may belong to a
  // neighbor. In a positive semidefinite block, the largest entry is on the diagonal.
  double sum[Dim * Dim] = {}, size = 0;
  for (std::int32_t i = a.starts[row]; i < a.starts[row + 1]; ++i)
  {
    for (int k = 0; k < Dim * Dim; ++k)
    {
      sum[k] += a.blocks[static_cast<Index>(Dim * Dim) * i + k];
    }
    for (int c = 0; c < Dim; ++c)
    {
      size = std::max(size, std::abs(diagonal(a.columns[i], c)));
    }
  }
  return std::all_of(sum, sum + Dim * Dim,
    [size](double x) { return std::abs(x) <= multigrid::floatingSum * size; });
}
}
#endif
