// SPDX-License-Identifier: BSD-3-Clause
#include "HessianMatrix.h"

#include "tautline/Core/Memory.h"

#include "ElementHessianBatches.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Mesh/MeshElements.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
/// The topology of the elements of a surface.
const CellTopology& topologyWith(int nodes)
{
  return topology(nodes == 3 ? CellType::Triangle : CellType::Quadrilateral);
}

/// y += A x for one block.
template <int Dim>
void addProduct(const double* block, const double* x, double* y)
{
  for (int r = 0; r < Dim; ++r)
  {
    double sum = 0;
    for (int c = 0; c < Dim; ++c)
    {
      sum += block[Dim * r + c] * x[c];
    }
    y[r] += sum;
  }
}
}

std::array<Vec3, 3> coordinateAxes(const Mesh& mesh)
{
  return hessianAxes(mesh);
}

//------------------------------------------------------------------------------
HessianMatrix::HessianMatrix(
  const Mesh& mesh, std::vector<std::int32_t> rowOfPoint, Index rows, Pattern pattern, int threads)
  : TheMesh(mesh)
  , RowOfPoint(std::move(rowOfPoint))
  , Rows(rows)
  , ThePattern(pattern)
  , Threads(threads)
  , Size(mesh.dimension() == Dimension::Planar ? 2 : 3)
{
  this->findPattern();
  const std::size_t numbers = static_cast<std::size_t>(this->Size) * this->Size;
  this->Blocks.assign(numbers * this->Columns.size(), 0.0);
  this->Inverse.assign(numbers * this->Rows, 0.0);
}

/// Throws if the matrix with this many blocks and its solver do not fit into memory.
void HessianMatrix::require(Index blocks) const
{
  constexpr double coarseGrids = 1; // of multigrid, relative to the matrix
  const double numbers = this->Size * this->Size * static_cast<double>(sizeof(double));
  const double matrix = numbers * static_cast<double>(blocks + this->Rows);
  const double indices = static_cast<double>(sizeof(std::int32_t)) *
    static_cast<double>(blocks + this->PlaceStarts.back());
  const bool full = this->ThePattern == Pattern::Full;
  requireMemory(matrix * (full ? 1 + coarseGrids : 1) + indices, "the matrix of Newton's method",
    "choose another optimizer, such as Local Newton");
}

std::int32_t HessianMatrix::place(std::int32_t row, std::int32_t column) const
{
  const auto begin = this->Columns.begin() + this->Starts[row],
             end = this->Columns.begin() + this->Starts[row + 1];
  const auto found = std::lower_bound(begin, end, column);
  return found != end && *found == column ? static_cast<std::int32_t>(found - this->Columns.begin())
                                          : -1;
}

/// The cells at the point of each row, with the offsets of each row.
std::pair<std::vector<Index>, std::vector<Index>> HessianMatrix::cellsOfRows() const
{
  const MeshView& view = this->TheMesh.view();
  std::vector<Index> cellStarts(this->Rows + 1, 0);
  std::vector<Index> cells;
  const auto forEachNode = [&](const auto& visit)
  {
    for (const CellBlock& block : this->TheMesh.blocks())
    {
      if (!isElement(this->TheMesh, block.type))
      {
        continue;
      }
      const int nodes = topology(block.type).nodes;
      for (Index i = 0; i < block.count; ++i)
      {
        const Index cell = block.cell(i);
        for (int k = 0; k < nodes; ++k)
        {
          const std::int32_t row = this->RowOfPoint[view.connectivity[view.offsets[cell] + k]];
          if (row >= 0)
          {
            visit(row, cell);
          }
        }
      }
    }
  };
  forEachNode([&](std::int32_t row, Index) { ++cellStarts[row + 1]; });
  for (Index row = 0; row < this->Rows; ++row)
  {
    cellStarts[row + 1] += cellStarts[row];
  }
  cells.resize(cellStarts[this->Rows]);
  std::vector<Index> next(cellStarts.begin(), cellStarts.end() - 1);
  forEachNode([&](std::int32_t row, Index cell) { cells[next[row]++] = cell; });
  return { std::move(cellStarts), std::move(cells) };
}

void HessianMatrix::findPattern()
{
  const MeshView& view = this->TheMesh.view();
  const bool full = this->ThePattern == Pattern::Full;
  const std::pair<std::vector<Index>, std::vector<Index>> ofRows = this->cellsOfRows();
  const std::vector<Index>&cellStarts = ofRows.first, &cells = ofRows.second;
  this->PlaceStarts.assign(view.numberOfCells + 1, 0);
  for (const CellBlock& block : this->TheMesh.blocks())
  {
    const int nodes = topology(block.type).nodes;
    for (Index i = 0; i < block.count && isElement(this->TheMesh, block.type); ++i)
    {
      this->PlaceStarts[block.cell(i) + 1] = full ? nodes * nodes : nodes;
    }
  }
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    this->PlaceStarts[cell + 1] += this->PlaceStarts[cell];
  }

  // The neighbors of each row, chunk by chunk.
  std::vector<std::vector<std::int32_t>> columns(numberOfChunks(this->Rows));
  std::vector<std::int32_t> lengths(this->Rows, 0);
  forEachChunk(this->Rows, this->Threads,
    [&](Index chunk, Index begin, Index end)
    {
      std::vector<std::int32_t> own;
      for (Index row = begin; row < end; ++row)
      {
        own.assign(1, static_cast<std::int32_t>(row));
        for (Index i = cellStarts[row]; full && i < cellStarts[row + 1]; ++i)
        {
          const Index first = view.offsets[cells[i]], last = view.offsets[cells[i] + 1];
          const int nodes = topology(cornerType(view.cellTypes[cells[i]])).nodes;
          for (Index k = first; k < std::min(last, first + nodes); ++k)
          {
            const std::int32_t column = this->RowOfPoint[view.connectivity[k]];
            if (column >= 0)
            {
              own.push_back(column);
            }
          }
        }
        std::sort(own.begin(), own.end());
        own.erase(std::unique(own.begin(), own.end()), own.end());
        lengths[row] = static_cast<std::int32_t>(own.size());
        columns[chunk].insert(columns[chunk].end(), own.begin(), own.end());
      }
    });
  Index total = 0;
  for (const auto& part : columns)
  {
    total += static_cast<Index>(part.size());
  }
  if (total > std::numeric_limits<std::int32_t>::max())
  {
    throw MemoryError(
      "The mesh has too many points for Newton's method: choose Local Newton or L-BFGS.");
  }
  this->require(total);
  this->Columns.reserve(total);
  for (const auto& part : columns)
  {
    this->Columns.insert(this->Columns.end(), part.begin(), part.end());
  }
  this->Starts.assign(this->Rows + 1, 0);
  std::partial_sum(lengths.begin(), lengths.end(), this->Starts.begin() + 1);
  this->Diagonal.resize(this->Rows);

  // The positions of the blocks of each cell.
  this->Places.assign(this->PlaceStarts.back(), -1);
  forEachChunk(this->Rows, this->Threads,
    [&](Index, Index begin, Index end)
    {
      for (Index row = begin; row < end; ++row)
      {
        const auto r = static_cast<std::int32_t>(row);
        this->Diagonal[row] = this->place(r, r);
        for (Index i = cellStarts[row]; i < cellStarts[row + 1]; ++i)
        {
          const Index* points = view.connectivity + view.offsets[cells[i]];
          const int nodes = topology(cornerType(view.cellTypes[cells[i]])).nodes;
          std::int32_t* places = this->Places.data() + this->PlaceStarts[cells[i]];
          for (int k = 0; k < nodes; ++k)
          {
            if (this->RowOfPoint[points[k]] != r)
            {
              continue;
            }
            for (int m = 0; full && m < nodes; ++m)
            {
              const std::int32_t column = this->RowOfPoint[points[m]];
              places[nodes * k + m] = column >= 0 ? this->place(r, column) : -1;
            }
            if (!full)
            {
              places[k] = this->Diagonal[row];
            }
          }
        }
      }
    });
}

std::size_t HessianMatrix::memory() const
{
  const auto bytes = [](const auto& v) { return v.size() * sizeof(v[0]); };
  return bytes(this->RowOfPoint) + bytes(this->Starts) + bytes(this->Columns) +
    bytes(this->Diagonal) + bytes(this->Places) + bytes(this->PlaceStarts) + bytes(this->Blocks) +
    bytes(this->Inverse);
}

void HessianMatrix::clear()
{
  std::fill(this->Blocks.begin(), this->Blocks.end(), 0.0);
}

//------------------------------------------------------------------------------
/// @tparam Dim coordinates of the element Hessians. @tparam Size of the blocks: 3 for a surface
template <int Dim, int Size>
void HessianMatrix::addBlocks(const ObjectiveSum& objective, double scale, HessianForm form)
{
  const bool full = this->ThePattern == Pattern::Full;
  OrderlessSums sums(this->Blocks.data(), this->Orderless ? this->Blocks.size() : 0);
  forEachHessian<Dim>(objective, form,
    [&](auto nodesOfCell, const Batch& batch, const BatchNodes&, Packet* h)
    {
      constexpr int Nodes = decltype(nodesOfCell)::value;
      Packet axes[2][3];
      if constexpr (Size > Dim)
      {
        elementAxes(topologyWith(Nodes), batch, axes);
      }
      // The blocks of the first node are minus the sums of the other blocks.
      Packet block[Nodes][Nodes][Dim][Dim];
      for (int r = 0; r < Dim; ++r)
      {
        for (int c = 0; c < Dim; ++c)
        {
          block[0][0][r][c] = Packet{};
          for (int k = 1; k < Nodes; ++k)
          {
            Packet rowSum = {}, columnSum = {};
            for (int m = 1; m < Nodes; ++m)
            {
              block[k][m][r][c] = scale * h[triangleEntry(Dim * (k - 1) + r, Dim * (m - 1) + c)];
              rowSum += block[k][m][r][c];
              columnSum += scale * h[triangleEntry(Dim * (m - 1) + r, Dim * (k - 1) + c)];
            }
            block[k][0][r][c] = -rowSum;
            block[0][k][r][c] = -columnSum;
            block[0][0][r][c] += rowSum;
          }
        }
      }
      for (int l = 0; l < batch.count; ++l)
      {
        const std::int32_t* places = this->Places.data() + this->PlaceStarts[batch.cells[l]];
        for (int k = 0; k < Nodes; ++k)
        {
          for (int m = full ? 0 : k; m < (full ? Nodes : k + 1); ++m)
          {
            const std::int32_t place = full ? places[Nodes * k + m] : places[k];
            if (place < 0)
            {
              continue;
            }
            const Index first = static_cast<Index>(Size * Size) * place;
            double entries[Size * Size];
            for (int e = 0; e < Size * Size; ++e)
            {
              if constexpr (Size > Dim)
              {
                // On a surface, the 2 x 2 block B in the plane of the element becomes E^T B E in
                // space, with the axes E of the element as rows.
                const auto& b = block[k][m];
                const int r = e / Size, c = e % Size;
                entries[e] =
                  axes[0][r][l] * (b[0][0][l] * axes[0][c][l] + b[0][1][l] * axes[1][c][l]) +
                  axes[1][r][l] * (b[1][0][l] * axes[0][c][l] + b[1][1][l] * axes[1][c][l]);
              }
              else
              {
                entries[e] = block[k][m][e / Dim][e % Dim][l];
              }
            }
            // Collect the summands, so that the sum does not depend on the order of the cells.
            if (this->Orderless)
            {
              for (int e = 0; e < Size * Size; ++e)
              {
                sums.add(first + e, entries[e]);
              }
              continue;
            }
            double* to = this->Blocks.data() + first;
            for (int e = 0; e < Size * Size; ++e)
            {
              to[e] += entries[e];
            }
          }
        }
      }
    });
  sums.finish();
}

void HessianMatrix::addForm(const ObjectiveSum& objective, double scale, HessianForm form)
{
  const Dimension dimension = this->TheMesh.dimension();
  dimension == Dimension::Planar     ? this->addBlocks<2, 2>(objective, scale, form)
    : dimension == Dimension::Volume ? this->addBlocks<3, 3>(objective, scale, form)
                                     : this->addBlocks<2, 3>(objective, scale, form);
}

void HessianMatrix::add(const ObjectiveSum& objective, double scale)
{
  this->addForm(objective, scale, HessianForm::Exact);
}

void HessianMatrix::addConvexPart(const ObjectiveSum& objective, double scale)
{
  this->addForm(objective, scale, HessianForm::Convex);
}

bool HessianMatrix::hasConvexPart(const Objective& objective)
{
  return hasAnalyticHessian(objective);
}

bool HessianMatrix::hasConvexPart(const ObjectiveSum& objective)
{
  return hasConvexPart(objective.state().objective);
}

//------------------------------------------------------------------------------
void HessianMatrix::addToDiagonal(Index row, double value)
{
  double* block =
    this->Blocks.data() + static_cast<Index>(this->Size * this->Size) * this->Diagonal[row];
  for (int c = 0; c < this->Size; ++c)
  {
    block[(this->Size + 1) * c] += value;
  }
}

//------------------------------------------------------------------------------
void HessianMatrix::restrict(Index row, const double* projector)
{
  const int n = this->Size;
  const auto multiply = [n](const double* a, const double* b, double* product)
  {
    for (int r = 0; r < n; ++r)
    {
      for (int c = 0; c < n; ++c)
      {
        product[n * r + c] = 0;
        for (int k = 0; k < n; ++k)
        {
          product[n * r + c] += a[n * r + k] * b[n * k + c];
        }
      }
    }
  };
  double product[9];
  // The matrix becomes P A P + s (I - P) in this row, with the projector P and the mean diagonal s:
  // it stays regular in the directions that are removed.
  for (std::int32_t place = this->Starts[row]; place < this->Starts[row + 1]; ++place)
  {
    double* block = this->Blocks.data() + static_cast<Index>(n * n) * place;
    multiply(projector, block, product);
    if (place != this->Diagonal[row])
    {
      std::copy_n(product, n * n, block);
      // P is symmetric, and so is the matrix.
      double* other = this->Blocks.data() +
        static_cast<Index>(n * n) *
          this->place(this->Columns[place], static_cast<std::int32_t>(row));
      for (int r = 0; r < n; ++r)
      {
        for (int c = 0; c < n; ++c)
        {
          other[n * c + r] = product[n * r + c];
        }
      }
      continue;
    }
    double trace = 0;
    for (int r = 0; r < n; ++r)
    {
      trace += std::abs(block[n * r + r]);
    }
    multiply(product, projector, block);
    const double elsewhere = trace > 0 ? trace / n : 1.0;
    for (int r = 0; r < n; ++r)
    {
      for (int c = 0; c < n; ++c)
      {
        block[n * r + c] += elsewhere * ((r == c ? 1.0 : 0.0) - projector[n * r + c]);
      }
    }
  }
}

//------------------------------------------------------------------------------
/// Positive definite inverses: of |eigenvalue|, but at least of a thousandth of the largest. Blocks
/// of zeros become the identity.
template <int Dim>
void HessianMatrix::invertDiagonal()
{
  constexpr double flattest = 1e-3; // smallest eigenvalue, relative to the largest
  constexpr int sweeps = 5;
  forEachChunk(this->Rows, this->Threads,
    [this](Index, Index begin, Index end)
    {
      for (Index first = begin; first < end; first += PacketWidth)
      {
        const int lanes = static_cast<int>(std::min<Index>(PacketWidth, end - first));
        Packet a[Dim][Dim] = {}, v[Dim][Dim] = {};
        for (int r = 0; r < Dim; ++r)
        {
          v[r][r] = broadcast(1.0);
          for (int c = 0; c < Dim; ++c)
          {
            for (int l = 0; l < lanes; ++l)
            {
              const double* block =
                this->Blocks.data() + static_cast<Index>(Dim * Dim) * this->Diagonal[first + l];
              // Jacobi rotations need an exactly symmetric block, which sums of rounded entries do
              // not guarantee.
              a[r][c][l] = 0.5 * (block[Dim * r + c] + block[Dim * c + r]);
            }
          }
        }
        // A fixed number of cyclic sweeps converges for blocks of size 3, and avoids different
        // branches in the lanes of a packet.
        for (int sweep = 0; sweep < sweeps; ++sweep)
        {
          for (int p = 0; p < Dim; ++p)
          {
            for (int q = p + 1; q < Dim; ++q)
            {
              rotate<Dim>(a, v, p, q);
            }
          }
        }
        Packet largest = {};
        for (int k = 0; k < Dim; ++k)
        {
          largest = max(largest, abs(a[k][k]));
        }
        Packet inverse[Dim];
        for (int k = 0; k < Dim; ++k)
        {
          inverse[k] = 1.0 / max(abs(a[k][k]), flattest * largest);
          // The identity for a point without elements or with overflow.
          inverse[k] =
            select((largest > 0.0) & (inverse[k] < HUGE_VAL), inverse[k], broadcast(1.0));
        }
        for (int r = 0; r < Dim; ++r)
        {
          for (int c = 0; c < Dim; ++c)
          {
            Packet sum = {};
            for (int k = 0; k < Dim; ++k)
            {
              sum += inverse[k] * v[r][k] * v[c][k];
            }
            for (int l = 0; l < lanes; ++l)
            {
              this->Inverse[Dim * Dim * (first + l) + Dim * r + c] = sum[l];
            }
          }
        }
      }
    });
}

void HessianMatrix::factorizeByMultigrid()
{
  if (!this->Grids)
  {
    this->Grids = std::make_unique<Multigrid>(this->Threads);
  }
  this->Grids->build(this->view());
}

BlockMatrixView HessianMatrix::view() const
{
  return { this->Size, this->Rows, this->Starts.data(), this->Columns.data(), this->Diagonal.data(),
    this->Blocks.data() };
}

void HessianMatrix::factorize()
{
  this->Grids.reset();
  this->Size == 2 ? this->invertDiagonal<2>() : this->invertDiagonal<3>();
}

//------------------------------------------------------------------------------
template <int Dim>
void HessianMatrix::multiply(const double* d, double* product) const
{
  forEachChunk(this->Rows, this->Threads,
    [=](Index, Index begin, Index end)
    {
      for (Index row = begin; row < end; ++row)
      {
        double sum[Dim] = {};
        for (std::int32_t place = this->Starts[row]; place < this->Starts[row + 1]; ++place)
        {
          addProduct<Dim>(this->Blocks.data() + static_cast<Index>(Dim * Dim) * place,
            d + static_cast<Index>(Dim) * this->Columns[place], sum);
        }
        std::copy_n(sum, Dim, product + Dim * row);
      }
    });
}

void HessianMatrix::times(const double* d, double* product) const
{
  this->Size == 2 ? this->multiply<2>(d, product) : this->multiply<3>(d, product);
}

//------------------------------------------------------------------------------
template <int Dim>
void HessianMatrix::applyDiagonal(const double* r, double* z) const
{
  forEachChunk(this->Rows, this->Threads,
    [=](Index, Index begin, Index end)
    {
      for (Index row = begin; row < end; ++row)
      {
        double sum[Dim] = {};
        addProduct<Dim>(this->Inverse.data() + Dim * Dim * row, r + Dim * row, sum);
        std::copy_n(sum, Dim, z + Dim * row);
      }
    });
}

/// (L + D) D^-1 (D + U) z = r inside each range of rows.
template <int Dim>
void HessianMatrix::sweep(const double* r, double* z) const
{
  forEachChunk(this->Rows, this->Threads,
    [=](Index, Index begin, Index end)
    {
      for (Index row = begin; row < end; ++row)
      {
        double sum[Dim] = {};
        // Couplings to rows outside the range are skipped, so that ranges are independent and the
        // result is the same for any number of threads.
        for (std::int32_t place = this->Starts[row]; place < this->Diagonal[row]; ++place)
        {
          if (this->Columns[place] >= begin)
          {
            addProduct<Dim>(this->Blocks.data() + static_cast<Index>(Dim * Dim) * place,
              z + static_cast<Index>(Dim) * this->Columns[place], sum);
          }
        }
        double rest[Dim], own[Dim] = {};
        for (int c = 0; c < Dim; ++c)
        {
          rest[c] = r[Dim * row + c] - sum[c];
        }
        addProduct<Dim>(this->Inverse.data() + Dim * Dim * row, rest, own);
        std::copy_n(own, Dim, z + Dim * row);
      }
      // The backward sweep subtracts D^-1 U z from the result of the forward sweep.
      for (Index row = end - 1; row >= begin; --row)
      {
        double sum[Dim] = {};
        for (std::int32_t place = this->Diagonal[row] + 1; place < this->Starts[row + 1]; ++place)
        {
          if (this->Columns[place] < end)
          {
            addProduct<Dim>(this->Blocks.data() + static_cast<Index>(Dim * Dim) * place,
              z + static_cast<Index>(Dim) * this->Columns[place], sum);
          }
        }
        double own[Dim] = {};
        addProduct<Dim>(this->Inverse.data() + Dim * Dim * row, sum, own);
        for (int c = 0; c < Dim; ++c)
        {
          z[Dim * row + c] -= own[c];
        }
      }
    });
}

void HessianMatrix::precondition(const double* r, double* z)
{
  if (this->Grids)
  {
    this->Grids->apply(r, z);
  }
  else if (this->Size == 2)
  {
    this->applyDiagonal<2>(r, z);
  }
  else if (this->ThePattern == Pattern::Diagonal)
  {
    this->applyDiagonal<3>(r, z);
  }
  else
  {
    this->sweep<3>(r, z);
  }
}

void HessianMatrix::preconditionByDiagonal(const double* r, double* z) const
{
  this->Size == 2 ? this->applyDiagonal<2>(r, z) : this->applyDiagonal<3>(r, z);
}
}
