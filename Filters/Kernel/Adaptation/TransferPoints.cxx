// SPDX-License-Identifier: BSD-3-Clause
#include "TransferPoints.h"

#include "tautline/Core/Parallel.h"
#include "tautline/Core/VectorAlgebra.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
constexpr Index SimplicesPerProjection = 64, RowsPerChunk = 1024;
/// Points with less than this fraction of their simplices covered have no value.
constexpr double LeastCommon = 1e-10;
/// The residual of the projection, relative to its right side. The mass matrix is well conditioned.
constexpr double ProjectionResidual = 1e-14;
constexpr int ProjectionIterations = 500;
/// The number of passes in which the remaining fluxes are limited again.
constexpr int FluxPasses = 3;

/// Integrals of products of barycentric coordinates of two simplices over their intersection.
template <int N>
struct SharedMoments
{
  std::array<std::array<double, N>, N> masses = {}; ///< of the target with itself
  std::array<std::array<double, N>, N> mixed = {};  ///< of the target with the source

  template <class Target, class Source>
  void add(const Target& inTarget, const Source& inSource, double size)
  {
    // For linear functions f and g: size / (N (N + 1)) (sum f sum g + sum f g) over the corners;
    // the last row has the sums.
    double t[N + 1][N] = {}, s[N + 1][N] = {};
    for (int i = 0; i < N; ++i)
    {
      for (int k = 0; k < N; ++k)
      {
        // Rounding may make coordinates at the border of a simplex slightly negative.
        t[i][k] = std::max(0.0, inTarget(i, k));
        s[i][k] = std::max(0.0, inSource(i, k));
        t[N][k] += t[i][k];
        s[N][k] += s[i][k];
      }
    }
    const double factor = size / (N * (N + 1));
    for (int i = 0; i <= N; ++i)
    {
      for (int k = 0; k < N; ++k)
      {
        const double weight = factor * t[i][k];
        for (int l = 0; l < N; ++l)
        {
          this->masses[k][l] += weight * t[i][l];
          this->mixed[k][l] += weight * s[i][l];
        }
      }
    }
  }
};
}

//------------------------------------------------------------------------------
PointProjection::PointProjection(const TransferMesh& target, const TransferMesh& source,
  const TransferOverlaps& overlaps, const std::vector<std::vector<double>>& fields, int threads)
  : Target(target)
  , Source(source)
  , Overlaps(overlaps)
  , Fields(fields)
  , Threads(threads)
{
  const auto simplices = static_cast<std::size_t>(target.numberOfSimplices());
  const auto n = static_cast<std::size_t>(target.corners());
  constexpr double infinity = std::numeric_limits<double>::infinity();
  this->Masses.assign(simplices * n * n, 0.0);
  this->Sides.assign(simplices * n * fields.size(), 0.0);
  this->Lows.assign(simplices * fields.size(), infinity);
  this->Highs.assign(simplices * fields.size(), -infinity);
  parallelFor(target.numberOfSimplices(), SimplicesPerProjection, threads,
    [&](Index t) { target.dimension() == 3 ? this->integrate<4>(t) : this->integrate<3>(t); });
  this->assemble();
}

//------------------------------------------------------------------------------
template <int N>
void PointProjection::integrate(Index simplex)
{
  const TransferView<N> view(this->Target, simplex, this->Overlaps.space);
  const std::size_t fields = this->Fields.size();
  double* masses = this->Masses.data() + N * N * simplex;
  double* sides = this->Sides.data() + static_cast<std::size_t>(simplex) * N * fields;
  double* lows = this->Lows.data() + static_cast<std::size_t>(simplex) * fields;
  double* highs = this->Highs.data() + static_cast<std::size_t>(simplex) * fields;
  for (Index k = this->Overlaps.starts[simplex]; k < this->Overlaps.starts[simplex + 1]; ++k)
  {
    pollInterruption(k);
    const Index other = this->Overlaps.overlaps[k].simplex;
    SharedMoments<N> moments;
    view.with(this->Source, other)
      .forEachPiece([&](const auto& inTarget, const auto& inSource, double size)
        { moments.add(inTarget, inSource, size); });
    // The scales make the overlaps of a covered source simplex add up to its size.
    const double scale = this->Overlaps.scales[other];
    for (int i = 0; i < N; ++i)
    {
      for (int j = 0; j < N; ++j)
      {
        // Bitwise symmetric, so that fluxes cancel exactly.
        masses[N * i + j] += scale * (i <= j ? moments.masses[i][j] : moments.masses[j][i]);
      }
    }
    const TransferMesh::Simplex& nodes = this->Source.simplices()[other];
    for (std::size_t f = 0; f < fields; ++f)
    {
      for (int j = 0; j < N; ++j)
      {
        const double value = this->Fields[f][nodes[j]];
        lows[f] = std::min(lows[f], value);
        highs[f] = std::max(highs[f], value);
        for (int i = 0; i < N; ++i)
        {
          sides[N * f + i] += scale * moments.mixed[i][j] * value;
        }
      }
    }
  }
}

//------------------------------------------------------------------------------
/// Assembles the rows of the mass matrix.
void PointProjection::assemble()
{
  const Index points = this->Target.numberOfPoints();
  const int n = this->Target.corners();
  this->UseStarts.assign(points + 1, 0);
  for (const TransferMesh::Simplex& s : this->Target.simplices())
  {
    for (int k = 0; k < n; ++k)
    {
      ++this->UseStarts[s[k] + 1];
    }
  }
  for (Index p = 0; p < points; ++p)
  {
    this->UseStarts[p + 1] += this->UseStarts[p];
  }
  this->Uses.resize(this->UseStarts.back());
  std::vector<Index> next(this->UseStarts.begin(), this->UseStarts.end() - 1);
  for (Index t = 0; t < this->Target.numberOfSimplices(); ++t)
  {
    for (int k = 0; k < n; ++k)
    {
      this->Uses[next[this->Target.simplices()[t][k]]++] = n * t + k;
    }
  }
  const std::vector<double> whole = sharesOfPoints(this->Target);
  this->Common.assign(points, 0.0);
  parallelFor(points, RowsPerChunk, this->Threads,
    [&](Index p)
    {
      // Row sums of the mass matrix are the lumped masses.
      double sum = 0.0;
      for (Index u = this->UseStarts[p]; u < this->UseStarts[p + 1]; ++u)
      {
        for (int k = 0; k < n; ++k)
        {
          sum += this->Masses[n * this->Uses[u] + k];
        }
      }
      this->Common[p] = sum > LeastCommon * whole[p] ? sum : 0.0;
    });
  std::vector<std::vector<std::pair<Index, double>>> rows(points);
  parallelFor(points, RowsPerChunk, this->Threads,
    [&](Index p)
    {
      if (!(this->Common[p] > 0.0))
      {
        return;
      }
      std::vector<std::pair<Index, double>> all;
      for (Index u = this->UseStarts[p]; u < this->UseStarts[p + 1]; ++u)
      {
        const TransferMesh::Simplex& s = this->Target.simplices()[this->Uses[u] / n];
        for (int k = 0; k < n; ++k)
        {
          const double mass = this->Masses[n * this->Uses[u] + k];
          if (mass > 0.0) // the share of a point without a value stays here
          {
            all.emplace_back(this->Common[s[k]] > 0.0 ? s[k] : p, mass);
          }
        }
      }
      // With a stable order, equal columns are summed in the order of the simplices.
      std::stable_sort(
        all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
      for (const auto& [column, mass] : all)
      {
        if (!rows[p].empty() && rows[p].back().first == column)
        {
          rows[p].back().second += mass;
        }
        else
        {
          rows[p].emplace_back(column, mass);
        }
      }
    });
  this->Starts = { 0 };
  for (const auto& row : rows)
  {
    for (const auto& [column, mass] : row)
    {
      this->Columns.push_back(column);
      this->Entries.push_back(mass);
    }
    this->Starts.push_back(static_cast<Index>(this->Columns.size()));
  }
}

//------------------------------------------------------------------------------
/// Conjugate gradients with the diagonal as preconditioner.
std::vector<double> PointProjection::solve(
  const std::vector<double>& side, std::vector<double> x) const
{
  const std::size_t n = side.size();
  const VectorAlgebra algebra(n, this->Threads);
  std::vector<double> inverse(n, 0.0), residual(n), z(n), direction(n, 0.0), image(n);
  const auto multiply = [&](const std::vector<double>& from, std::vector<double>& to)
  {
    algebra.each(
      [&](Index i)
      {
        double sum = 0.0;
        for (Index k = this->Starts[i]; k < this->Starts[i + 1]; ++k)
        {
          sum += this->Entries[k] * from[this->Columns[k]];
        }
        to[i] = sum;
      });
  };
  algebra.each(
    [&](Index i)
    {
      for (Index k = this->Starts[i]; k < this->Starts[i + 1]; ++k)
      {
        inverse[i] = this->Columns[k] == i ? 1.0 / this->Entries[k] : inverse[i];
      }
    });
  multiply(x, image);
  algebra.each([&](Index i) { residual[i] = side[i] - image[i]; });
  // The norm of the right side in which residuals are measured.
  const double size = algebra.sum([&](Index i) { return side[i] * inverse[i] * side[i]; });
  double before = 0.0;
  for (int iteration = 0; iteration < ProjectionIterations; ++iteration)
  {
    throwIfInterrupted();
    algebra.each([&](Index i) { z[i] = inverse[i] * residual[i]; });
    const double now = algebra.dot(residual.data(), z.data());
    if (!(now > ProjectionResidual * ProjectionResidual * size))
    {
      break;
    }
    const double beta = iteration > 0 ? now / before : 0.0;
    before = now;
    algebra.addScaled(z.data(), beta, direction.data(), direction.data());
    multiply(direction, image);
    const double step = now / algebra.dot(direction.data(), image.data());
    algebra.addScaled(x.data(), step, direction.data(), x.data());
    algebra.addScaled(residual.data(), -step, image.data(), residual.data());
  }
  return x;
}

//------------------------------------------------------------------------------
/// Adds the fluxes M_ij (u_i - u_j), as far as the bounds allow it. (Zalesak 1979)
void PointProjection::limit(const std::vector<double>& high, BoundedValues& field) const
{
  const auto points = static_cast<Index>(high.size());
  std::vector<double> fluxes(this->Entries.size()), up(points), down(points), change(points);
  const auto forEachRow = [&](const auto& work)
  {
    parallelFor(points, RowsPerChunk, this->Threads,
      [&](Index i)
      {
        if (this->Common[i] > 0.0)
        {
          work(i, this->Starts[i], this->Starts[i + 1]);
        }
      });
  };
  // For the consistent solution u and the lumped solution v, M_L (u - v) is the sum of the fluxes
  // M_ij (u_i - u_j).
  forEachRow(
    [&](Index i, Index begin, Index end)
    {
      for (Index k = begin; k < end; ++k)
      {
        fluxes[k] = this->Entries[k] * (high[i] - high[this->Columns[k]]);
      }
    });
  for (int pass = 0; pass < FluxPasses; ++pass)
  {
    forEachRow(
      [&](Index i, Index begin, Index end)
      {
        double more = 0.0, less = 0.0;
        for (Index k = begin; k < end; ++k)
        {
          (fluxes[k] > 0.0 ? more : less) += fluxes[k];
        }
        const double above = this->Common[i] * (field.high[i] - field.values[i]);
        const double below = this->Common[i] * (field.low[i] - field.values[i]);
        up[i] = more > above ? std::max(0.0, above / more) : 1.0;
        down[i] = less < below ? std::max(0.0, below / less) : 1.0;
      });
    forEachRow(
      [&](Index i, Index begin, Index end)
      {
        double sum = 0.0;
        for (Index k = begin; k < end; ++k)
        {
          // A flux is reduced by the stricter of both ends, equally on both sides, which preserves
          // the total.
          const Index j = this->Columns[k];
          const double part = fluxes[k] > 0.0 ? std::min(up[i], down[j]) : std::min(down[i], up[j]);
          sum += part * fluxes[k];
          fluxes[k] -= part * fluxes[k];
        }
        change[i] = sum / this->Common[i];
      });
    forEachRow([&](Index i, Index, Index)
      { field.values[i] = std::clamp(field.values[i] + change[i], field.low[i], field.high[i]); });
  }
}

//------------------------------------------------------------------------------
BoundedValues PointProjection::apply(std::size_t component) const
{
  const auto points = static_cast<Index>(this->Common.size());
  const int n = this->Target.corners();
  const std::size_t fields = this->Fields.size();
  BoundedValues result;
  result.values.assign(points, 0.0);
  result.low = result.high = result.values;
  std::vector<double> side(points, 0.0);
  parallelFor(points, RowsPerChunk, this->Threads,
    [&](Index p)
    {
      if (!(this->Common[p] > 0.0))
      {
        return;
      }
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (Index u = this->UseStarts[p]; u < this->UseStarts[p + 1]; ++u)
      {
        const auto t = static_cast<std::size_t>(this->Uses[u] / n);
        side[p] += this->Sides[n * (t * fields + component) + this->Uses[u] % n];
        low = std::min(low, this->Lows[t * fields + component]);
        high = std::max(high, this->Highs[t * fields + component]);
      }
      result.low[p] = low;
      result.high[p] = high;
      // The solution with the lumped mass matrix is a mean of source values, hence within the
      // bounds.
      result.values[p] = std::clamp(side[p] / this->Common[p], low, high);
    });
  this->limit(this->solve(side, result.values), result);
  return result;
}

//------------------------------------------------------------------------------
std::vector<double> sharesOfPoints(const TransferMesh& mesh)
{
  std::vector<double> shares(mesh.points().size(), 0.0);
  for (Index s = 0; s < mesh.numberOfSimplices(); ++s)
  {
    for (int k = 0; k < mesh.corners(); ++k)
    {
      shares[mesh.simplices()[s][k]] += mesh.sizes()[s] / mesh.corners();
    }
  }
  return shares;
}
}
