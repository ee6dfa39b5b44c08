// SPDX-License-Identifier: BSD-3-Clause
#include "PeridynamicSolve.h"

#include "LocalLimit.h"
#include "MassSmoother.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Core/Memory.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Solvers/InnerSolver.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tautline
{
namespace
{
/// The number of coarse grid cells per horizon, and the minimum number of elements per cell: with a
/// horizon of two elements, cells must be narrower than the horizon, or the grid misses volume
/// changes.
constexpr double CellsPerHorizon = 2.0, LeastElements = 1.5;

/// The allowed growth of the form of a singular kernel on waves that are treated by the diagonal.
constexpr double DiagonalGrowth = 3.0;

/// The fraction of the diagonal added to the coarse matrix: grid functions that are linearly
/// dependent on the unknowns make it singular.
constexpr double CoarseShift = 1e-10;

/// The position of an unknown function: its vertex, or the centroid of its triangle.
Vec2 placeOf(const HorizonMesh& mesh, PeridynamicBasis basis, Index function)
{
  const auto point = [&](Index i) { return Vec2{ mesh.points[2 * i], mesh.points[2 * i + 1] }; };
  if (basis != PeridynamicBasis::Constant)
  {
    return point(basis == PeridynamicBasis::Linear ? function : mesh.triangles[function]);
  }
  Vec2 centre = {};
  for (int k = 0; k < 3; ++k)
  {
    const Vec2 p = point(mesh.triangles[3 * function + k]);
    centre = { centre[0] + p[0] / 3.0, centre[1] + p[1] / 3.0 };
  }
  return centre;
}

/// The side of the square formed by two triangles of mean area.
double elementSize(const HorizonMesh& mesh)
{
  double area = 0.0;
  Index count = 0;
  for (Index t = 0; t < mesh.numberOfTriangles(); ++t)
  {
    if (mesh.layer.empty() || !mesh.layer[t])
    {
      const Index* ids = &mesh.triangles[3 * t];
      const double* a = &mesh.points[2 * ids[0]];
      const double* b = &mesh.points[2 * ids[1]];
      const double* c = &mesh.points[2 * ids[2]];
      area += 0.5 * std::abs((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]));
      ++count;
    }
  }
  return std::sqrt(2.0 * area / static_cast<double>(std::max<Index>(count, 1)));
}

/// The cells of the coarse grid.
double gridSpacing(const HorizonMesh& mesh, const PeridynamicOptions& options)
{
  const double h = elementSize(mesh);
  double spacing = options.horizon / CellsPerHorizon;
  const double order = formOrder(options);
  if (order > 0.0)
  {
    spacing = std::min(spacing, h * std::pow(DiagonalGrowth, 1.0 / order));
  }
  return std::max(spacing, LeastElements * h);
}

/// Bilinear interpolation from a grid over the unknown functions; grid points without unknown
/// functions are left out.
Prolongation fromGrid(
  const HorizonMesh& mesh, const PeridynamicOptions& options, const PeridynamicSystem& system)
{
  const double spacing = gridSpacing(mesh, options);
  std::vector<Vec2> places;
  Vec2 low = { INFINITY, INFINITY }, high = { -INFINITY, -INFINITY };
  for (const Index f : system.functionOf)
  {
    places.push_back(placeOf(mesh, options.basis, f));
    for (int i = 0; i < 2; ++i)
    {
      low[i] = std::min(low[i], places.back()[i]);
      high[i] = std::max(high[i], places.back()[i]);
    }
  }
  double cells[2], size[2];
  for (int i = 0; i < 2; ++i)
  {
    cells[i] = std::max(1.0, std::ceil((high[i] - low[i]) / spacing));
    // The lower limit avoids cells of width 0 if all unknowns have the same coordinate.
    size[i] = std::max((high[i] - low[i]) / cells[i], spacing / LeastElements);
  }
  // The four corners of the cell of each function; corners of weight 0 are ignored.
  std::vector<std::pair<std::int64_t, double>> found;
  std::vector<std::int64_t> keys;
  Prolongation map;
  const auto columns = static_cast<std::int64_t>(cells[0]) + 2;
  for (std::size_t u = 0; u < places.size(); ++u)
  {
    pollInterruption(static_cast<Index>(u));
    double from[2], part[2];
    for (int i = 0; i < 2; ++i)
    {
      const double at = (places[u][i] - low[i]) / size[i];
      // A point on the upper side belongs to the last cell.
      from[i] = std::min(std::floor(at), cells[i] - 1.0);
      part[i] = at - from[i];
    }
    for (int corner = 0; corner < 4; ++corner)
    {
      const int right = corner % 2, up = corner / 2;
      const double weight = (right ? part[0] : 1.0 - part[0]) * (up ? part[1] : 1.0 - part[1]);
      if (weight > 0.0)
      {
        found.emplace_back((static_cast<std::int64_t>(from[1]) + up) * columns +
            static_cast<std::int64_t>(from[0]) + right,
          weight);
        keys.push_back(found.back().first);
      }
    }
    map.offsets.push_back(static_cast<Index>(found.size()));
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  for (const auto& [key, weight] : found)
  {
    const auto place = std::lower_bound(keys.begin(), keys.end(), key) - keys.begin();
    map.columns.push_back(static_cast<std::int32_t>(place));
    map.weights.push_back(weight);
  }
  map.coarse = static_cast<Index>(keys.size());
  return map;
}

/// The rows and columns of P exchanged.
Prolongation transposed(const Prolongation& map)
{
  Prolongation result;
  result.coarse = map.fine();
  result.offsets.assign(map.coarse + 1, 0);
  for (const std::int32_t column : map.columns)
  {
    ++result.offsets[column + 1];
  }
  for (Index i = 0; i < map.coarse; ++i)
  {
    result.offsets[i + 1] += result.offsets[i];
  }
  result.columns.resize(map.columns.size());
  result.weights.resize(map.columns.size());
  std::vector<Index> next(result.offsets.begin(), result.offsets.end() - 1);
  for (Index u = 0; u < map.fine(); ++u)
  {
    for (Index k = map.offsets[u]; k < map.offsets[u + 1]; ++k)
    {
      const Index to = next[map.columns[k]]++;
      result.columns[to] = static_cast<std::int32_t>(u);
      result.weights[to] = map.weights[k];
    }
  }
  return result;
}

/// Sums by column, with a list of the columns that have one.
struct SparseRow
{
  std::vector<double> sums;
  std::vector<char> marked;
  std::vector<std::int32_t> touched;

  explicit SparseRow(Index size)
    : sums(size, 0.0)
    , marked(size, 0)
  {
  }
  void add(Index column, double value)
  {
    if (!this->marked[column])
    {
      this->marked[column] = 1;
      this->touched.push_back(static_cast<std::int32_t>(column));
    }
    this->sums[column] += value;
  }
  /// Returns the sums by increasing column and clears them.
  std::vector<std::pair<std::int32_t, double>> take()
  {
    std::sort(this->touched.begin(), this->touched.end());
    std::vector<std::pair<std::int32_t, double>> row;
    row.reserve(this->touched.size());
    for (const std::int32_t column : this->touched)
    {
      row.emplace_back(column, this->sums[column]);
      this->sums[column] = 0.0;
      this->marked[column] = 0;
    }
    this->touched.clear();
    return row;
  }
};

/// P^T A with a row per coarse function, separately for each component.
struct CoarseRows
{
  std::vector<Index> offsets = { 0 };
  std::vector<std::int32_t> columns;
  std::vector<double> values;

  Index size() const { return static_cast<Index>(this->offsets.size()) - 1; }

  /// y = P^T A x.
  void multiply(const std::vector<double>& x, std::vector<double>& y) const
  {
    for (Index row = 0; row < this->size(); ++row)
    {
      double sum = 0.0;
      for (Index k = this->offsets[row]; k < this->offsets[row + 1]; ++k)
      {
        sum += this->values[k] * x[this->columns[k]];
      }
      y[row] = sum;
    }
  }
  /// y -= A P x.
  void subtractTransposed(const std::vector<double>& x, std::vector<double>& y) const
  {
    for (Index row = 0; row < this->size(); ++row)
    {
      for (Index k = this->offsets[row]; k < this->offsets[row + 1]; ++k)
      {
        y[this->columns[k]] -= this->values[k] * x[row];
      }
    }
  }
};

/// Collects rows of sums, one after the other.
template <class Rows>
void append(const std::vector<std::pair<std::int32_t, double>>& row, Rows& rows)
{
  for (const auto& [column, value] : row)
  {
    rows.columns.push_back(column);
    rows.values.push_back(value);
  }
  rows.offsets.push_back(static_cast<Index>(rows.columns.size()));
}

/// P^T A P, separately for each component, and P^T A.
SparseMatrix galerkin(const SparseMatrix& matrix, const Prolongation& map,
  const Prolongation& transpose, Index c, int threads, CoarseRows& coarseRows)
{
  using Row = std::vector<std::pair<std::int32_t, double>>;
  const Index rows = c * map.coarse;
  // P^T A has fewer entries than A: 0.7 times as many with a horizon of two elements, fewer with a
  // larger one. They are stored twice while the rows are joined.
  constexpr double bytesPerEntry = 2 * (sizeof(double) + sizeof(std::int32_t)) + sizeof(double);
  requireMemory(bytesPerEntry * static_cast<double>(matrix.values.size()),
    "the coarse grid of the preconditioner", "choose Jacobi or AMG of the local limit");
  std::vector<Row> half(rows), made(rows);
  struct Scratch
  {
    SparseRow fine, coarse;
  };
  ScratchPool<Scratch> pool([&] { return Scratch{ SparseRow(matrix.size), SparseRow(rows) }; });
  constexpr Index grain = 1;
  parallelFor(rows, grain, threads, pool,
    [&](Scratch& scratch, Index row)
    {
      const Index function = row / c, i = row % c;
      for (Index k = transpose.offsets[function]; k < transpose.offsets[function + 1]; ++k)
      {
        const Index from = c * transpose.columns[k] + i;
        for (Index m = matrix.offsets[from]; m < matrix.offsets[from + 1]; ++m)
        {
          scratch.fine.add(matrix.columns[m], transpose.weights[k] * matrix.values[m]);
        }
      }
      // The list of columns has to be used before take() clears it.
      for (const std::int32_t column : scratch.fine.touched)
      {
        const Index u = column / c;
        for (Index k = map.offsets[u]; k < map.offsets[u + 1]; ++k)
        {
          scratch.coarse.add(
            c * map.columns[k] + column % c, map.weights[k] * scratch.fine.sums[column]);
        }
      }
      half[row] = scratch.fine.take();
      made[row] = scratch.coarse.take();
    });
  SparseMatrix coarse;
  coarse.size = rows;
  const std::size_t entries = std::accumulate(half.begin(), half.end(), std::size_t(0),
    [](std::size_t sum, const Row& row) { return sum + row.size(); });
  coarseRows.columns.reserve(entries);
  coarseRows.values.reserve(entries);
  for (Index row = 0; row < rows; ++row)
  {
    for (auto& [column, value] : made[row])
    {
      value = column == row ? (1.0 + CoarseShift) * value : value;
    }
    append(made[row], coarse);
    append(half[row], coarseRows);
    Row().swap(half[row]);
  }
  symmetrize(coarse, threads); // removes rounding errors
  return coarse;
}
}

//------------------------------------------------------------------------------
const char* nameOf(NonlocalPreconditioner preconditioner)
{
  switch (preconditioner)
  {
    case NonlocalPreconditioner::Jacobi:
      return "Jacobi";
    case NonlocalPreconditioner::LocalMultigrid:
      return "AMG of the local limit";
    case NonlocalPreconditioner::TwoLevel:
      return "two-level";
  }
  return "unknown";
}

//------------------------------------------------------------------------------
struct PeridynamicPreconditioner::State
{
  Index components = 1;
  std::vector<double> inverse;            // of the diagonal
  std::unique_ptr<MassSmoother> smoother; // used instead, unless Jacobi is selected
  Prolongation map;
  std::unique_ptr<InnerSolver> inner; // S; null: the coarse space is empty
  CoarseRows rows;                    // of TwoLevel
  std::vector<double> coarse, correction;
  std::vector<double> residual, smoothed, image; // of TwoLevel

  bool isMultiplicative() const { return this->rows.size() > 0; }

  /// Calls use(fine row, coarse row, weight) for all entries of P.
  template <class Use>
  void forEachWeight(const Use& use) const
  {
    const Index c = this->components;
    for (Index u = 0; u < this->map.fine(); ++u)
    {
      for (Index k = this->map.offsets[u]; k < this->map.offsets[u + 1]; ++k)
      {
        for (Index i = 0; i < c; ++i)
        {
          use(c * u + i, c * this->map.columns[k] + i, this->map.weights[k]);
        }
      }
    }
  }
  /// correction = S P^T r.
  void restrictAndSolve(const double* r)
  {
    std::fill(this->coarse.begin(), this->coarse.end(), 0.0);
    this->forEachWeight(
      [&](Index fine, Index row, double weight) { this->coarse[row] += weight * r[fine]; });
    this->inner->apply(this->coarse.data(), this->correction.data());
  }
  /// z += P correction.
  void prolongate(double* z) const
  {
    this->forEachWeight(
      [&](Index fine, Index row, double weight) { z[fine] += weight * this->correction[row]; });
  }
  void additive(const double* r, double* z)
  {
    this->smoother->apply(r, z);
    if (this->inner)
    {
      this->restrictAndSolve(r);
      this->prolongate(z);
    }
  }
  void multiplicative(const double* r, double* z);
};

/// y = P S P^T r, x = Q (r - A y), z = y + x - P S P^T A x.
void PeridynamicPreconditioner::State::multiplicative(const double* r, double* z)
{
  this->restrictAndSolve(r);
  this->residual.assign(r, r + this->residual.size());
  this->rows.subtractTransposed(this->correction, this->residual);
  this->smoother->apply(this->residual.data(), this->smoothed.data());
  this->rows.multiply(this->smoothed, this->coarse);
  this->inner->apply(this->coarse.data(), this->image.data());
  for (std::size_t i = 0; i < this->correction.size(); ++i)
  {
    this->correction[i] -= this->image[i];
  }
  std::copy(this->smoothed.begin(), this->smoothed.end(), z);
  this->prolongate(z);
}

PeridynamicPreconditioner::PeridynamicPreconditioner(const HorizonMesh& mesh,
  const PeridynamicOptions& options, const PeridynamicSystem& system,
  NonlocalPreconditioner preconditioner)
  : Impl(std::make_unique<State>())
{
  State& own = *this->Impl;
  own.components = system.components;
  own.inverse = inverseDiagonal(system.matrix);
  if (preconditioner == NonlocalPreconditioner::Jacobi)
  {
    return;
  }
  constexpr Index given = -1;
  if (std::find(system.unknownOf.begin(), system.unknownOf.end(), given) == system.unknownOf.end())
  {
    throw Error("the preconditioner " + std::string(nameOf(preconditioner)) +
      " needs given values in an interaction layer: choose Jacobi, or constrain the "
      "solution");
  }
  own.smoother = std::make_unique<MassSmoother>(mesh, options, system);
  SparseMatrix matrix;
  const bool local = preconditioner == NonlocalPreconditioner::LocalMultigrid;
  if (local)
  {
    LocalLimit limit = localLimit(mesh, options, system);
    matrix = std::move(limit.matrix);
    own.map = std::move(limit.prolongation);
  }
  else
  {
    own.map = fromGrid(mesh, options, system);
    matrix = galerkin(
      system.matrix, own.map, transposed(own.map), own.components, options.threads, own.rows);
    own.residual.resize(system.matrix.size);
    own.smoothed.resize(system.matrix.size);
    own.image.resize(matrix.size);
  }
  own.coarse.resize(matrix.size);
  own.correction.resize(matrix.size);
  if (matrix.size > 0)
  {
    own.inner = std::make_unique<InnerSolver>(std::move(matrix), static_cast<int>(own.components),
      local ? InnerSolver::Kind::Multigrid : InnerSolver::Kind::Factorization);
  }
}

PeridynamicPreconditioner::~PeridynamicPreconditioner() = default;

Index PeridynamicPreconditioner::coarseRows() const
{
  return static_cast<Index>(this->Impl->coarse.size());
}

//------------------------------------------------------------------------------
void PeridynamicPreconditioner::apply(const double* r, double* z)
{
  State& own = *this->Impl;
  if (own.isMultiplicative())
  {
    own.multiplicative(r, z);
  }
  else if (own.smoother)
  {
    own.additive(r, z);
  }
  else
  {
    for (std::size_t i = 0; i < own.inverse.size(); ++i)
    {
      z[i] = own.inverse[i] * r[i];
    }
  }
}

//------------------------------------------------------------------------------
SolveReport solvePeridynamics(const HorizonMesh& mesh, const PeridynamicOptions& options,
  const PeridynamicSystem& system, NonlocalPreconditioner preconditioner,
  const std::vector<double>& load, std::vector<double>& x, double tolerance,
  const LanczosOptions& limits)
{
  PeridynamicPreconditioner own(mesh, options, system, preconditioner);
  return solveConjugateGradients(system.matrix, load, x, tolerance, limits,
    [&](const double* r, double* z) { own.apply(r, z); });
}
}
