// SPDX-License-Identifier: BSD-3-Clause
#include "BlockJacobiMultigrid.h"

#include "GridRows.h"
#include "SmallBlocks.h"

#include "tautline/Core/Memory.h"
#include "tautline/Core/Parallel.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace tautline
{
using namespace multigrid;

namespace
{
constexpr double atOnce = 1 << 30; // bytes that ranks gather; MPI takes twice as many

/// The distinct numbers of a list, ascending; replaces the list by their positions.
std::vector<std::int32_t> compress(std::vector<std::int32_t>& list)
{
  std::vector<std::int32_t> distinct = list;
  std::sort(distinct.begin(), distinct.end());
  distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
  for (std::int32_t& number : list)
  {
    number = static_cast<std::int32_t>(
      std::lower_bound(distinct.begin(), distinct.end(), number) - distinct.begin());
  }
  return distinct;
}

/// Gathers the rows of a graph from all ranks: the number of each row, its number of columns, the
/// columns, and their strengths.
Graph gathered(const Ranks& ranks, const std::vector<std::int32_t>& numbers,
  const std::vector<std::int32_t>& lengths, const std::vector<std::int32_t>& columns,
  const std::vector<float>& strengths)
{
  RankGroup& group = ranks.mesh().group();
  const Index rows = group.sum(static_cast<Index>(numbers.size()));
  const Index total = group.sum(static_cast<Index>(columns.size()));
  ranks.inMemory(
    [total]
    {
      // The graph, the data from the ranks, and the graphs of pairs.
      constexpr double copies = 4;
      const auto entries = static_cast<double>(total);
      // MPI counts are 32-bit: above 2 GiB a gather is not possible at any amount of memory.
      const double bytes = sizeof(float) * entries > 2 * atOnce
        ? HUGE_VAL
        : copies * (sizeof(std::int32_t) + sizeof(float)) * entries;
      requireMemory(bytes, "the graph of Newton's method", "choose Local Newton");
    },
    "The mesh is too large for Newton's method: choose Local Newton or L-BFGS.");
  // Assemble the rows of all ranks, so that each rank has the whole graph.
  const auto rowsOf = group.gatherItems(numbers), lengthsOf = group.gatherItems(lengths);
  Graph graph;
  graph.starts.assign(rows + 1, 0);
  // Rows are placed by their global numbers, so that the graph does not depend on the distribution
  // over the ranks.
  for (std::size_t r = 0; r < rowsOf.size(); ++r)
  {
    for (std::size_t i = 0; i < rowsOf[r].size(); ++i)
    {
      graph.starts[rowsOf[r][i] + 1] = lengthsOf[r][i];
    }
  }
  std::partial_sum(graph.starts.begin(), graph.starts.end(), graph.starts.begin());
  graph.columns.resize(total);
  graph.strengths.resize(total);
  const auto fill = [&](const auto& parts, auto& all)
  {
    for (std::size_t r = 0; r < parts.size(); ++r)
    {
      auto from = parts[r].begin();
      for (std::size_t i = 0; i < rowsOf[r].size(); ++i)
      {
        std::copy_n(from, lengthsOf[r][i], all.begin() + graph.starts[rowsOf[r][i]]);
        from += lengthsOf[r][i];
      }
    }
  };
  fill(group.gatherItems(columns), graph.columns);
  fill(group.gatherItems(strengths), graph.strengths);
  return graph;
}
}

//------------------------------------------------------------------------------
BlockJacobiMultigrid::BlockJacobiMultigrid(const MatrixRows& rows, int threads)
  : Rows(rows)
  , Threads(threads)
{
}

//------------------------------------------------------------------------------
template <int Dim>
void BlockJacobiMultigrid::invertDiagonals()
{
  const BlockMatrixView& a = this->Matrix;
  const std::vector<std::int32_t>& owned = this->Rows.owned();
  const std::size_t count = owned.size();
  std::vector<double> own(Dim * count);
  const auto blockOf = [&](Index place) { return a.blocks + Dim * Dim * place; };
  for (std::size_t i = 0; i < count; ++i)
  {
    for (int c = 0; c < Dim; ++c)
    {
      own[Dim * i + c] = blockOf(a.diagonals[owned[i]])[(Dim + 1) * c];
    }
  }
  // addOutside() also needs the diagonals of rows of other ranks.
  this->Rows.spread(own.data(), this->Diagonal, Dim);
  this->Inverse.resize(Dim * Dim * count);
  forEachChunk(static_cast<Index>(count), this->Threads,
    [&](Index, Index begin, Index end)
    {
      for (Index i = begin; i < end; ++i)
      {
        const std::int32_t row = owned[i];
        double block[Dim * Dim];
        std::copy_n(blockOf(a.diagonals[row]), Dim * Dim, block);
        double added[Dim];
        // With a range of one row, all couplings to other rows count as outside: this is an l1
        // Jacobi smoother.
        addOutside<Dim>(a, row, row, row + 1, this->diagonals<Dim>(), added);
        for (int c = 0; c < Dim; ++c)
        {
          block[(Dim + 1) * c] += added[c];
        }
        invert<Dim>(block, this->Inverse.data() + Dim * Dim * i);
      }
    });
}

//------------------------------------------------------------------------------
/// See isFloating() in Multigrid.cxx. Uses the diagonals of all rows.
template <int Dim>
bool BlockJacobiMultigrid::isFloating() const
{
  const BlockMatrixView& a = this->Matrix;
  const std::vector<std::int32_t>& owned = this->Rows.owned();
  // A single held row removes the translations from the null space; ranks without rows do not
  // decide.
  const bool held = std::any_of(owned.begin(), owned.end(),
    [&](std::int32_t row) { return !isFloatingRow<Dim>(a, row, this->diagonals<Dim>()); });
  RankGroup& group = this->Rows.group();
  return !group.any(held) && group.any(!owned.empty());
}

template <int Dim>
void BlockJacobiMultigrid::removeTranslation(double* z)
{
  RankGroup& group = this->Rows.group();
  const std::size_t count = this->Rows.numberOfOwned();
  const auto total = static_cast<double>(group.sum(static_cast<Index>(count)));
  this->Component.resize(count);
  for (int c = 0; c < Dim; ++c)
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      this->Component[i] = z[Dim * i + c];
    }
    // An orderless sum makes the mean independent of the distribution of the rows.
    const double mean = group.orderlessSum(this->Component) / total;
    for (std::size_t i = 0; i < count; ++i)
    {
      z[Dim * i + c] -= mean;
    }
  }
}

//------------------------------------------------------------------------------
/// The coupling strengths of all rows on all ranks, by their numbers.
template <int Dim>
Graph BlockJacobiMultigrid::couplings(const std::vector<std::int32_t>& numbers) const
{
  const BlockMatrixView& a = this->Matrix;
  // Relative to the diagonals, couplings are comparable between rows of elements of very different
  // sizes.
  std::vector<double> units(this->Rows.rows());
  for (std::size_t row = 0; row < units.size(); ++row)
  {
    units[row] = unitOf<Dim>(static_cast<Index>(row), this->diagonals<Dim>());
  }
  std::vector<std::int32_t> own, lengths, columns;
  std::vector<float> strengths;
  for (const std::int32_t row : this->Rows.owned())
  {
    own.push_back(numbers[row]);
    lengths.push_back(a.starts[row + 1] - a.starts[row]);
    for (std::int32_t k = a.starts[row]; k < a.starts[row + 1]; ++k)
    {
      columns.push_back(numbers[a.columns[k]]);
      strengths.push_back(couplingOf<Dim>(
        a.blocks + static_cast<Index>(Dim * Dim) * k, units[row], units[a.columns[k]]));
    }
  }
  return gathered(this->Rows.ranks(), own, lengths, columns, strengths);
}

/// Finds the aggregates, and the pattern of the coarse matrix.
template <int Dim>
void BlockJacobiMultigrid::aggregate()
{
  const BlockMatrixView& a = this->Matrix;
  const std::vector<std::int32_t>& owned = this->Rows.owned();
  RankGroup& group = this->Rows.group();
  const std::vector<std::int32_t> numbers = this->Rows.numbers();
  Graph graph = this->couplings<Dim>(numbers);
  // The graph is consumed below, but its row starts are needed to find the blocks of each row.
  const std::vector<std::int32_t> fineStarts = graph.starts;
  Aggregates found = tautline::aggregate(std::move(graph), pairings);
  const auto count = static_cast<Index>(found.diagonals.size());
  this->Coarse.reset();
  // If aggregation hardly reduces the number of rows, a coarse level does not pay off.
  if (static_cast<double>(count) > slowCoarsening * static_cast<double>(found.ofRow.size()))
  {
    return;
  }
  // Store for each owned row its aggregate, and for each of its blocks the position in the coarse
  // matrix.
  this->Aggregate.resize(this->Rows.rows());
  for (std::size_t row = 0; row < this->Aggregate.size(); ++row)
  {
    this->Aggregate[row] = found.ofRow[numbers[row]];
  }
  this->AggregateOf.clear();
  this->PlaceOf.clear();
  this->PlaceStarts.clear();
  for (const std::int32_t row : owned)
  {
    this->AggregateOf.push_back(this->Aggregate[row]);
    const auto begin = found.places.begin() + fineStarts[numbers[row]];
    this->PlaceStarts.push_back(static_cast<Index>(this->PlaceOf.size()));
    this->PlaceOf.insert(this->PlaceOf.end(), begin, begin + a.starts[row + 1] - a.starts[row]);
  }
  // Each rank sends only its own aggregates and positions; AggregateOf and PlaceOf then index these
  // compressed lists.
  this->RankAggregates = group.gatherItems(compress(this->AggregateOf));
  this->RankPlaces = group.gatherItems(compress(this->PlaceOf));
  this->Starts = std::move(found.graph.starts);
  this->Columns = std::move(found.graph.columns);
  this->Diagonals = std::move(found.diagonals);
  this->Blocks.resize(static_cast<std::size_t>(Dim * Dim) * this->Columns.size());
  this->R.resize(static_cast<std::size_t>(Dim) * count);
  this->Z.resize(this->R.size());
  this->CoarseMatrix = { Dim, count, this->Starts.data(), this->Columns.data(),
    this->Diagonals.data(), this->Blocks.data() };
  this->Coarse = std::make_unique<Multigrid>(this->Threads);
}

//------------------------------------------------------------------------------
void BlockJacobiMultigrid::addUp(const std::vector<std::vector<std::int32_t>>& places,
  const std::vector<double>& own, int components, std::vector<double>& to) const
{
  std::size_t total = 0;
  for (const auto& ofRank : places)
  {
    total += ofRank.size();
  }
  const double bytes =
    static_cast<double>(sizeof(double)) * static_cast<double>(total) * components;
  // Gathering all components at once needs memory for the contributions of all ranks.
  const int step = bytes > atOnce ? 1 : components; // number of components gathered together
  // All ranks add the contributions in the order of the ranks, so that their coarse data are
  // bitwise identical.
  std::fill(to.begin(), to.end(), 0.0);
  for (int first = 0; first < components; first += step)
  {
    std::vector<double> slice;
    for (std::size_t i = first; step < components && i < own.size(); i += components)
    {
      slice.push_back(own[i]);
    }
    const auto parts = this->Rows.group().gatherItems(step < components ? slice : own);
    for (std::size_t r = 0; r < parts.size(); ++r)
    {
      const double* from = parts[r].data();
      for (const std::int32_t place : places[r])
      {
        double* sum = to.data() + static_cast<std::size_t>(components) * place + first;
        for (int c = 0; c < step; ++c)
        {
          sum[c] += *from++;
        }
      }
    }
  }
}

//------------------------------------------------------------------------------
template <int Dim>
void BlockJacobiMultigrid::fillCoarse()
{
  const BlockMatrixView& a = this->Matrix;
  const std::vector<std::int32_t>& owned = this->Rows.owned();
  const int rank = this->Rows.group().rank();
  // The coarse matrix is the Galerkin product: sum the blocks of this rank by coarse position, then
  // over the ranks.
  std::vector<double> own(Dim * Dim * this->RankPlaces[rank].size(), 0.0);
  for (std::size_t i = 0; i < owned.size(); ++i)
  {
    const std::int32_t begin = a.starts[owned[i]], end = a.starts[owned[i] + 1];
    for (std::int32_t k = begin; k < end; ++k)
    {
      const double* from = a.blocks + static_cast<Index>(Dim * Dim) * k;
      double* to = own.data() +
        static_cast<Index>(Dim * Dim) * this->PlaceOf[this->PlaceStarts[i] + (k - begin)];
      for (int e = 0; e < Dim * Dim; ++e)
      {
        to[e] += from[e];
      }
    }
  }
  this->addUp(this->RankPlaces, own, Dim * Dim, this->Blocks);
  this->Coarse->build(this->CoarseMatrix);
}

//------------------------------------------------------------------------------
void BlockJacobiMultigrid::build(const BlockMatrixView& matrix)
{
  this->Matrix = matrix;
  const bool flat = matrix.size == 2;
  flat ? this->invertDiagonals<2>() : this->invertDiagonals<3>();
  this->Floating = flat ? this->isFloating<2>() : this->isFloating<3>();
  // The values change with each Newton iteration, but the aggregates remain good for several of
  // them.
  if (!this->Coarse || ++this->Reused >= rebuildAfter)
  {
    this->Reused = 0;
    flat ? this->aggregate<2>() : this->aggregate<3>();
  }
  if (this->Coarse)
  {
    flat ? this->fillCoarse<2>() : this->fillCoarse<3>();
  }
}

//------------------------------------------------------------------------------
template <int Dim>
void BlockJacobiMultigrid::subtractProduct(const double* x, double* rest) const
{
  const BlockMatrixView& a = this->Matrix;
  const std::vector<std::int32_t>& owned = this->Rows.owned();
  forEachChunk(static_cast<Index>(owned.size()), this->Threads,
    [&](Index, Index begin, Index end)
    {
      for (Index i = begin; i < end; ++i)
      {
        double sum[Dim] = {};
        for (std::int32_t k = a.starts[owned[i]]; k < a.starts[owned[i] + 1]; ++k)
        {
          multiplyAdd<Dim>(a.blocks + static_cast<Index>(Dim * Dim) * k,
            x + static_cast<Index>(Dim) * a.columns[k], sum);
        }
        for (int c = 0; c < Dim; ++c)
        {
          rest[Dim * i + c] -= sum[c];
        }
      }
    });
}

template <int Dim>
void BlockJacobiMultigrid::cycle(const double* r, double* z)
{
  const auto count = static_cast<Index>(this->Rows.numberOfOwned());
  const auto smooth = [&](const double* rest)
  {
    forEachChunk(count, this->Threads,
      [&](Index, Index begin, Index end)
      {
        for (Index i = begin; i < end; ++i)
        {
          multiplyAdd<Dim>(this->Inverse.data() + Dim * Dim * i, rest + Dim * i, z + Dim * i);
        }
      });
  };
  // Pre-smoothing starts at z = 0, where the residual is r itself and needs no product.
  std::fill_n(z, Dim * count, 0.0);
  smooth(r);
  this->Rows.spread(z, this->All, Dim);
  this->Rest.assign(r, r + Dim * count);
  this->subtractProduct<Dim>(this->All.data(), this->Rest.data());
  if (this->Coarse)
  {
    // With piecewise constant aggregates, restriction sums the residual over the rows of an
    // aggregate, and prolongation copies the correction to all of them.
    const int rank = this->Rows.group().rank();
    this->Own.assign(Dim * this->RankAggregates[rank].size(), 0.0);
    for (Index i = 0; i < Dim * count; ++i)
    {
      this->Own[static_cast<Index>(Dim) * this->AggregateOf[i / Dim] + i % Dim] += this->Rest[i];
    }
    this->addUp(this->RankAggregates, this->Own, Dim, this->R);
    // Each rank solves the same coarse problem, so that the correction needs no communication.
    this->Coarse->solve(this->R.data(), this->Z.data());
    for (std::size_t row = 0; row < this->Aggregate.size(); ++row)
    {
      std::copy_n(this->Z.data() + static_cast<Index>(Dim) * this->Aggregate[row], Dim,
        this->All.data() + Dim * row);
    }
    for (Index i = 0; i < Dim * count; ++i)
    {
      z[i] += this->All[static_cast<Index>(Dim) * this->Rows.owned()[i / Dim] + i % Dim];
    }
    // `All` now has only the coarse correction, which updates the residual for the post-smoothing.
    this->subtractProduct<Dim>(this->All.data(), this->Rest.data());
  }
  smooth(this->Rest.data());
  // If no point is held, remove the rigid translations that the smoother introduces: they would
  // grow.
  if (this->Floating)
  {
    this->removeTranslation<Dim>(z);
  }
}

void BlockJacobiMultigrid::apply(const double* r, double* z)
{
  this->Matrix.size == 2 ? this->cycle<2>(r, z) : this->cycle<3>(r, z);
}

//------------------------------------------------------------------------------
std::unique_ptr<GridHierarchy> makeGrids(const MatrixRows& rows, int threads)
{
  if (rows.ranks().several())
  {
    return std::make_unique<BlockJacobiMultigrid>(rows, threads);
  }
  return std::make_unique<Multigrid>(threads);
}
}
