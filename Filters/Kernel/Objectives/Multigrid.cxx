// SPDX-License-Identifier: BSD-3-Clause
#include "Multigrid.h"

#include "Aggregation.h"
#include "GridRows.h"
#include "SmallBlocks.h"

#include "tautline/Core/Parallel.h"
#include "tautline/Core/VectorAlgebra.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tautline
{
using namespace multigrid;

namespace
{
constexpr Index coarsest = 60; // number of rows that are solved by a dense factorization
constexpr int maxLevels = 30;
constexpr double enough =
  0.25; // reduction in the first step on a coarse level that makes a second unnecessary
constexpr double heldPivot = 1e-10; // relative pivot size below which a pivot is 0 up to rounding
}

//------------------------------------------------------------------------------
struct Multigrid::Level
{
  BlockMatrixView matrix; ///< of this level; except on the finest, it uses the arrays below
  std::vector<std::int32_t> starts, columns, diagonals;
  std::vector<double> blocks;
  std::vector<double> added;           ///< to the diagonals, for the smoother
  std::vector<double> inverse;         ///< of the diagonal blocks including `added`
  std::vector<std::int32_t> aggregate; ///< of each row, on the next level
  std::vector<std::int32_t> places;    ///< of each block, on the next level
  std::vector<double> r, z;            ///< right-hand side and solution, of coarse levels
  std::vector<double> rest, step;      ///< work space
  std::vector<double> q, p, ap, aq;    ///< work space of solveCoarse()
  std::vector<double> dense;           ///< factor of the coarsest matrix, row by row
};

Multigrid::Multigrid(int threads)
  : Threads(threads)
{
}

Multigrid::~Multigrid() = default;

//------------------------------------------------------------------------------
namespace
{
using Level = Multigrid::Level;

/// See GridRows.h.
template <int Dim>
auto diagonalsOf(const BlockMatrixView& a)
{
  return [&a](Index row, int c)
  { return a.blocks[static_cast<Index>(Dim * Dim) * a.diagonals[row] + (Dim + 1) * c]; };
}

template <int Dim>
void invertDiagonals(Level& level, int threads)
{
  const BlockMatrixView& a = level.matrix;
  level.inverse.resize(static_cast<std::size_t>(Dim * Dim) * a.rows);
  level.added.resize(static_cast<std::size_t>(Dim) * a.rows);
  forEachChunk(a.rows, threads,
    [&](Index, Index begin, Index end)
    {
      for (Index row = begin; row < end; ++row)
      {
        double* added = level.added.data() + Dim * row;
        // The range is the chunk of a sweep: couplings to other chunks are ignored there and
        // compensated on the diagonal.
        addOutside<Dim>(a, row, begin, end, diagonalsOf<Dim>(a), added);
        double block[Dim * Dim];
        std::copy_n(a.blocks + static_cast<Index>(Dim * Dim) * a.diagonals[row], Dim * Dim, block);
        for (int c = 0; c < Dim; ++c)
        {
          block[(Dim + 1) * c] += added[c];
        }
        invert<Dim>(block, level.inverse.data() + Dim * Dim * row);
      }
    });
}

template <int Dim>
Graph graphOf(const BlockMatrixView& a, int threads)
{
  Graph graph;
  graph.starts.assign(a.starts, a.starts + a.rows + 1);
  graph.columns.assign(a.columns, a.columns + a.starts[a.rows]);
  graph.strengths.resize(graph.columns.size());
  std::vector<double> units(a.rows);
  for (Index row = 0; row < a.rows; ++row)
  {
    units[row] = unitOf<Dim>(row, diagonalsOf<Dim>(a));
  }
  forEachChunk(a.rows, threads,
    [&](Index, Index begin, Index end)
    {
      for (Index row = begin; row < end; ++row)
      {
        for (std::int32_t i = a.starts[row]; i < a.starts[row + 1]; ++i)
        {
          graph.strengths[i] = couplingOf<Dim>(
            a.blocks + static_cast<Index>(Dim * Dim) * i, units[row], units[a.columns[i]]);
        }
      }
    });
  return graph;
}

/// Adds up the blocks of the next level.
template <int Dim>
void addBlocks(const Level& fine, Level& coarse)
{
  std::fill(coarse.blocks.begin(), coarse.blocks.end(), 0.0);
  for (std::size_t i = 0; i < fine.places.size(); ++i)
  {
    const double* from = fine.matrix.blocks + static_cast<std::size_t>(Dim * Dim) * i;
    double* to = coarse.blocks.data() + static_cast<std::size_t>(Dim * Dim) * fine.places[i];
    for (int k = 0; k < Dim * Dim; ++k)
    {
      to[k] += from[k];
    }
  }
}

/// Finds the aggregates of a level and creates the next level; null if rows hardly couple.
template <int Dim>
std::unique_ptr<Level> coarsened(Level& fine, int threads)
{
  const BlockMatrixView& a = fine.matrix;
  Aggregates found = aggregate(graphOf<Dim>(a, threads), pairings);
  fine.aggregate = std::move(found.ofRow);
  fine.places = std::move(found.places);
  const auto count = static_cast<Index>(found.diagonals.size());
  if (static_cast<double>(count) > slowCoarsening * static_cast<double>(a.rows))
  {
    return nullptr;
  }
  auto coarse = std::make_unique<Level>();
  coarse->starts = std::move(found.graph.starts);
  coarse->columns = std::move(found.graph.columns);
  coarse->diagonals = std::move(found.diagonals);
  coarse->blocks.resize(static_cast<std::size_t>(Dim * Dim) * coarse->columns.size());
  addBlocks<Dim>(fine, *coarse);
  coarse->matrix = { Dim, count, coarse->starts.data(), coarse->columns.data(),
    coarse->diagonals.data(), coarse->blocks.data() };
  return coarse;
}

/// The Cholesky factor of the coarsest matrix; unknowns whose pivot is 0 up to rounding stay 0.
template <int Dim>
void factorizeDense(Level& level)
{
  const BlockMatrixView& a = level.matrix;
  const std::size_t n = static_cast<std::size_t>(Dim) * a.rows;
  level.dense.assign(n * n, 0.0);
  for (Index row = 0; row < a.rows; ++row)
  {
    for (std::int32_t i = a.starts[row]; i < a.starts[row + 1]; ++i)
    {
      for (int k = 0; k < Dim * Dim; ++k)
      {
        level.dense[(Dim * row + k / Dim) * n + Dim * a.columns[i] + k % Dim] =
          a.blocks[static_cast<Index>(Dim * Dim) * i + k];
      }
    }
  }
  // Cholesky factorization by rows; the factor replaces the lower triangle.
  for (std::size_t r = 0; r < n; ++r)
  {
    double* row = level.dense.data() + r * n;
    const double diagonal = row[r];
    for (std::size_t c = 0; c <= r; ++c)
    {
      const double* other = level.dense.data() + c * n;
      double sum = row[c];
      for (std::size_t k = 0; k < c; ++k)
      {
        sum -= row[k] * other[k];
      }
      if (c < r)
      {
        row[c] = sum / other[c];
      }
      else
      {
        // Division by infinity removes contributions that are only rounding errors.
        const bool held = !(sum > heldPivot * diagonal && std::isfinite(sum));
        row[c] = held ? std::numeric_limits<double>::infinity() : std::sqrt(sum);
      }
    }
  }
}

void solveDense(const std::vector<double>& factor, std::size_t n, const double* b, double* x)
{
  // Forward substitution with the factor L, then backward substitution with its transpose.
  for (std::size_t r = 0; r < n; ++r)
  {
    double sum = b[r];
    for (std::size_t k = 0; k < r; ++k)
    {
      sum -= factor[r * n + k] * x[k];
    }
    x[r] = sum / factor[r * n + r];
  }
  for (std::size_t r = n; r-- > 0;)
  {
    x[r] /= factor[r * n + r];
    for (std::size_t k = 0; k < r; ++k)
    {
      x[k] -= factor[r * n + k] * x[r];
    }
  }
}

/// Whether the matrix maps translations of all rows to 0: no point is held.
template <int Dim>
bool isFloating(const BlockMatrixView& a)
{
  Index row = 0;
  while (row < a.rows && isFloatingRow<Dim>(a, row, diagonalsOf<Dim>(a)))
  {
    ++row;
  }
  return row == a.rows && a.rows > 0;
}

/// Removes the mean of each component.
template <int Dim>
void removeTranslation(Index rows, double* z)
{
  double mean[Dim] = {};
  for (Index row = 0; row < rows; ++row)
  {
    for (int c = 0; c < Dim; ++c)
    {
      mean[c] += z[Dim * row + c] / static_cast<double>(rows);
    }
  }
  for (Index row = 0; row < rows; ++row)
  {
    for (int c = 0; c < Dim; ++c)
    {
      z[Dim * row + c] -= mean[c];
    }
  }
}

template <int Dim>
void multiply(const BlockMatrixView& a, int threads, const double* x, double* y)
{
  forEachChunk(a.rows, threads,
    [=](Index, Index begin, Index end)
    {
      for (Index row = begin; row < end; ++row)
      {
        double sum[Dim] = {};
        for (std::int32_t i = a.starts[row]; i < a.starts[row + 1]; ++i)
        {
          multiplyAdd<Dim>(a.blocks + static_cast<Index>(Dim * Dim) * i,
            x + static_cast<Index>(Dim) * a.columns[i], sum);
        }
        std::copy_n(sum, Dim, y + Dim * row);
      }
    });
}

/// z = (L + D)^-1 r inside each range of rows, and rest = r - A z.
template <int Dim>
void forward(const Level& level, int threads, const double* r, double* z, double* rest)
{
  const BlockMatrixView& a = level.matrix;
  forEachChunk(a.rows, threads,
    [&](Index, Index begin, Index end)
    {
      for (Index row = begin; row < end; ++row)
      {
        double sum[Dim] = {}, own[Dim] = {};
        for (std::int32_t i = a.starts[row]; i < a.diagonals[row]; ++i)
        {
          if (a.columns[i] >= begin)
          {
            multiplyAdd<Dim>(a.blocks + static_cast<Index>(Dim * Dim) * i,
              z + static_cast<Index>(Dim) * a.columns[i], sum);
          }
        }
        for (int c = 0; c < Dim; ++c)
        {
          sum[c] = r[Dim * row + c] - sum[c];
        }
        multiplyAdd<Dim>(level.inverse.data() + Dim * Dim * row, sum, own);
        std::copy_n(own, Dim, z + Dim * row);
      }
    });
  // The residual consists only of the couplings to later rows and between ranges.
  forEachChunk(a.rows, threads,
    [&](Index, Index begin, Index end)
    {
      for (Index row = begin; row < end; ++row)
      {
        double sum[Dim] = {};
        const auto add = [&](std::int32_t i)
        {
          multiplyAdd<Dim>(a.blocks + static_cast<Index>(Dim * Dim) * i,
            z + static_cast<Index>(Dim) * a.columns[i], sum);
        };
        for (std::int32_t i = a.starts[row]; i < a.starts[row + 1] && a.columns[i] < begin; ++i)
        {
          add(i);
        }
        for (std::int32_t i = a.diagonals[row] + 1; i < a.starts[row + 1]; ++i)
        {
          add(i);
        }
        // z solves (L + D + added) z = r within its range, so `added` z returns to the residual r -
        // A z.
        for (int c = 0; c < Dim; ++c)
        {
          rest[Dim * row + c] = level.added[Dim * row + c] * z[Dim * row + c] - sum[c];
        }
      }
    });
}

/// z += (D + U)^-1 rest inside each range of rows.
template <int Dim>
void backward(const Level& level, int threads, const double* rest, double* step, double* z)
{
  const BlockMatrixView& a = level.matrix;
  forEachChunk(a.rows, threads,
    [&](Index, Index begin, Index end)
    {
      for (Index row = end - 1; row >= begin; --row)
      {
        double sum[Dim] = {}, own[Dim] = {};
        for (std::int32_t i = a.diagonals[row] + 1; i < a.starts[row + 1]; ++i)
        {
          if (a.columns[i] < end)
          {
            multiplyAdd<Dim>(a.blocks + static_cast<Index>(Dim * Dim) * i,
              step + static_cast<Index>(Dim) * a.columns[i], sum);
          }
        }
        for (int c = 0; c < Dim; ++c)
        {
          sum[c] = rest[Dim * row + c] - sum[c];
        }
        multiplyAdd<Dim>(level.inverse.data() + Dim * Dim * row, sum, own);
        for (int c = 0; c < Dim; ++c)
        {
          step[Dim * row + c] = own[c];
          z[Dim * row + c] += own[c];
        }
      }
    });
}
}

//------------------------------------------------------------------------------
template <int Dim>
void Multigrid::buildLevels()
{
  for (;;)
  {
    Level& level = *this->Levels.back();
    const std::size_t entries = static_cast<std::size_t>(Dim) * level.matrix.rows;
    for (std::vector<double>* work : { &level.rest, &level.step })
    {
      work->resize(entries);
    }
    if (this->Levels.size() > 1)
    {
      for (std::vector<double>* work :
        { &level.r, &level.z, &level.q, &level.p, &level.ap, &level.aq })
      {
        work->resize(entries);
      }
    }
    if (level.matrix.rows <= coarsest)
    {
      factorizeDense<Dim>(level);
      return;
    }
    invertDiagonals<Dim>(level, this->Threads);
    std::unique_ptr<Level> next =
      this->Levels.size() < maxLevels ? coarsened<Dim>(level, this->Threads) : nullptr;
    if (!next)
    {
      return; // a smoother alone
    }
    this->Levels.push_back(std::move(next));
  }
}

/// Updates the numbers in the existing levels.
template <int Dim>
void Multigrid::refill()
{
  for (std::size_t i = 0; i < this->Levels.size(); ++i)
  {
    Level& level = *this->Levels[i];
    if (!level.dense.empty())
    {
      factorizeDense<Dim>(level);
      return;
    }
    invertDiagonals<Dim>(level, this->Threads);
    if (i + 1 < this->Levels.size())
    {
      addBlocks<Dim>(level, *this->Levels[i + 1]);
    }
  }
}

void Multigrid::build(const BlockMatrixView& matrix)
{
  this->Floating = matrix.size == 2 ? isFloating<2>(matrix) : isFloating<3>(matrix);
  // With the same pattern only the values have changed, so the aggregates are kept for several
  // matrices.
  const bool same = !this->Levels.empty() && this->Size == matrix.size &&
    this->Levels[0]->matrix.rows == matrix.rows &&
    this->Levels[0]->matrix.columns == matrix.columns;
  if (same && ++this->Reused < rebuildAfter)
  {
    this->Levels[0]->matrix = matrix;
    this->Size == 2 ? this->refill<2>() : this->refill<3>();
    return;
  }
  this->Reused = 0;
  this->Size = matrix.size;
  this->Levels.clear();
  this->Levels.push_back(std::make_unique<Level>());
  this->Levels[0]->matrix = matrix;
  this->Size == 2 ? this->buildLevels<2>() : this->buildLevels<3>();
}

//------------------------------------------------------------------------------
template <int Dim>
void Multigrid::cycle(std::size_t i, const double* r, double* z)
{
  Level& level = *this->Levels[i];
  const Index n = Dim * level.matrix.rows;
  if (!level.dense.empty())
  {
    solveDense(level.dense, n, r, z);
    this->settle<Dim>(level, z);
    return;
  }
  forward<Dim>(level, this->Threads, r, z, level.rest.data());
  if (i + 1 < this->Levels.size())
  {
    Level& coarse = *this->Levels[i + 1];
    // The coarse right-hand side is the residual restricted by the transposed piecewise constant
    // prolongation.
    std::fill(coarse.r.begin(), coarse.r.end(), 0.0);
    for (Index row = 0; row < level.matrix.rows; ++row)
    {
      for (int c = 0; c < Dim; ++c)
      {
        coarse.r[static_cast<Index>(Dim) * level.aggregate[row] + c] += level.rest[Dim * row + c];
      }
    }
    this->solveCoarse<Dim>(i + 1);
    for (Index row = 0; row < level.matrix.rows; ++row)
    {
      for (int c = 0; c < Dim; ++c)
      {
        const double correction = coarse.z[static_cast<Index>(Dim) * level.aggregate[row] + c];
        level.step[Dim * row + c] = correction;
        z[Dim * row + c] += correction;
      }
    }
    // `step` is used below, so store the product in a free array.
    std::vector<double>& product = level.rest;
    const BlockMatrixView& a = level.matrix;
    forEachChunk(a.rows, this->Threads,
      [&](Index, Index begin, Index end)
      {
        for (Index row = begin; row < end; ++row)
        {
          double sum[Dim] = {};
          for (std::int32_t k = a.starts[row]; k < a.starts[row + 1]; ++k)
          {
            multiplyAdd<Dim>(a.blocks + static_cast<Index>(Dim * Dim) * k,
              level.step.data() + static_cast<Index>(Dim) * a.columns[k], sum);
          }
          for (int c = 0; c < Dim; ++c)
          {
            product[Dim * row + c] -= sum[c];
          }
        }
      });
  }
  backward<Dim>(level, this->Threads, level.rest.data(), level.step.data(), z);
  this->settle<Dim>(level, z);
}

/// If no point is held, removes the rigid translations introduced by rounding: they would grow.
template <int Dim>
void Multigrid::settle(const Level& level, double* z) const
{
  if (this->Floating)
  {
    removeTranslation<Dim>(level.matrix.rows, z);
  }
}

/// One or two steps of flexible conjugate gradients from 0.
template <int Dim>
void Multigrid::solveCoarse(std::size_t i)
{
  Level& level = *this->Levels[i];
  const std::size_t n = static_cast<std::size_t>(Dim) * level.matrix.rows;
  if (!level.dense.empty())
  {
    this->cycle<Dim>(i, level.r.data(), level.z.data());
    return;
  }
  const VectorAlgebra algebra(n, this->Threads);
  // A K-cycle (Y. Notay, "An aggregation-based algebraic multigrid method", ETNA 37, 2010): without
  // these inner iterations, plain aggregation slows down with the number of levels.
  this->cycle<Dim>(i, level.r.data(), level.p.data());
  multiply<Dim>(level.matrix, this->Threads, level.p.data(), level.ap.data());
  const double pap = algebra.dot(level.p.data(), level.ap.data());
  const double pr = algebra.dot(level.p.data(), level.r.data());
  const double before = algebra.dot(level.r.data(), level.r.data());
  // Along a direction of the null space, p^T A p is 0 up to rounding: no step is taken.
  const double alpha = pap > 0 && std::isfinite(pr / pap) ? pr / pap : 0.0;
  algebra.each(
    [&](Index k)
    {
      level.z[k] = alpha * level.p[k];
      level.r[k] -= alpha * level.ap[k];
    });
  const double after = algebra.dot(level.r.data(), level.r.data());
  if (alpha == 0 || !(after > enough * enough * before))
  {
    return;
  }
  this->cycle<Dim>(i, level.r.data(), level.q.data());
  multiply<Dim>(level.matrix, this->Threads, level.q.data(), level.aq.data());
  // q is made conjugate to p.
  const double overlap = algebra.dot(level.q.data(), level.ap.data()) / pap;
  const double qaq = algebra.dot(level.q.data(), level.aq.data()) - overlap * overlap * pap;
  const double qr = algebra.dot(level.q.data(), level.r.data());
  const double beta = qaq > 0 && std::isfinite(qr / qaq) ? qr / qaq : 0.0;
  algebra.each([&](Index k) { level.z[k] += beta * (level.q[k] - overlap * level.p[k]); });
}

//------------------------------------------------------------------------------
void multiply(const BlockMatrixView& a, int threads, const double* x, double* y)
{
  a.size == 2 ? multiply<2>(a, threads, x, y) : multiply<3>(a, threads, x, y);
}

void Multigrid::apply(const double* r, double* z)
{
  this->Size == 2 ? this->cycle<2>(0, r, z) : this->cycle<3>(0, r, z);
}

void Multigrid::solve(const double* r, double* z)
{
  Level& level = *this->Levels[0];
  const Index entries = this->Size * level.matrix.rows;
  for (std::vector<double>* work : { &level.r, &level.z, &level.q, &level.p, &level.ap, &level.aq })
  {
    work->resize(entries);
  }
  std::copy_n(r, entries, level.r.begin());
  this->Size == 2 ? this->solveCoarse<2>(0) : this->solveCoarse<3>(0);
  std::copy_n(level.z.begin(), entries, z);
}
}
