// SPDX-License-Identifier: BSD-3-Clause
#include "TransferCells.h"

#include "tautline/Core/Parallel.h"

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace tautline
{
namespace
{
constexpr Index CellsPerChunk = 256;

/// A source cell and its share of a target cell.
struct CellShare
{
  Index cell;
  double size;
  Vec3 moment;
};

/// The integral of the position over the intersection of two simplices, scaled.
template <int N>
Vec3 momentOf(const TransferView<N>& view, const TransferMesh& source, const TransferOverlap& each)
{
  std::array<double, N> sums;
  sums.fill(0.0);
  double size = 0.0;
  view.with(source, each.simplex)
    .forEachPiece(
      [&](const auto&, const auto& inSource, double piece)
      {
        size += piece;
        for (int i = 0; i < N; ++i)
        {
          for (int k = 0; k < N; ++k)
          {
            sums[k] += piece * inSource(i, k) / N;
          }
        }
      });
  Vec3 moment = { 0, 0, 0 };
  // Scaled to the stored size of the overlap, so that sizes and moments are consistent.
  for (int k = 0; k < N; ++k)
  {
    moment += (each.size * sums[k] / size) * source.points()[source.simplices()[each.simplex][k]];
  }
  return moment;
}

Vec3 momentOf(const TransferMesh& target, Index simplex, const TransferMesh& source,
  TransferSpace space, const TransferOverlap& each)
{
  return space == TransferSpace::Volume
    ? momentOf<4>(TransferView<4>(target, simplex, space), source, each)
    : momentOf<3>(TransferView<3>(target, simplex, space), source, each);
}

/// The shares of the simplices of a cell, one for each cell of the source, in increasing order.
std::vector<CellShare> joined(std::vector<CellShare> shares)
{
  std::stable_sort(shares.begin(), shares.end(),
    [](const CellShare& a, const CellShare& b) { return a.cell < b.cell; });
  std::vector<CellShare> result;
  for (const CellShare& share : shares)
  {
    if (!result.empty() && result.back().cell == share.cell)
    {
      result.back().size += share.size;
      result.back().moment += share.moment;
    }
    else
    {
      result.push_back(share);
    }
  }
  return result;
}
}

//------------------------------------------------------------------------------
CellShares cellShares(const TransferMesh& target, const TransferMesh& source,
  const TransferOverlaps& overlaps, bool centers, int threads)
{
  const Index count = target.numberOfCells();
  std::vector<std::vector<CellShare>> rows(count);
  parallelFor(count, CellsPerChunk, threads,
    [&](Index cell)
    {
      std::vector<CellShare> shares;
      for (Index t = target.starts()[cell]; t < target.starts()[cell + 1]; ++t)
      {
        for (Index k = overlaps.starts[t]; k < overlaps.starts[t + 1]; ++k)
        {
          pollInterruption(k);
          const TransferOverlap& each = overlaps.overlaps[k];
          const Vec3 moment =
            centers ? momentOf(target, t, source, overlaps.space, each) : Vec3{ 0, 0, 0 };
          shares.push_back({ source.cells()[each.simplex], each.size, moment });
        }
      }
      rows[cell] = joined(std::move(shares));
    });
  CellShares result;
  result.starts = { 0 };
  for (const std::vector<CellShare>& row : rows)
  {
    double sum = 0.0;
    for (const CellShare& share : row)
    {
      sum += share.size;
    }
    for (const CellShare& share : row)
    {
      result.cells.push_back(share.cell);
      result.parts.push_back(share.size / sum);
      if (centers)
      {
        result.centers.push_back((1.0 / share.size) * share.moment);
      }
    }
    result.starts.push_back(static_cast<Index>(result.cells.size()));
  }
  return result;
}

//------------------------------------------------------------------------------
std::vector<Index> largestShares(const CellShares& shares)
{
  std::vector<Index> largest(shares.starts.size() - 1, -1);
  for (std::size_t cell = 0; cell < largest.size(); ++cell)
  {
    double most = 0.0;
    for (Index k = shares.starts[cell]; k < shares.starts[cell + 1]; ++k)
    {
      if (shares.parts[k] > most)
      {
        most = shares.parts[k];
        largest[cell] = shares.cells[k];
      }
    }
  }
  return largest;
}

//------------------------------------------------------------------------------
CellTransfer::CellTransfer(const TransferMesh& target, const TransferMesh& source,
  const CellShares& shares, const std::vector<Index>& others, int threads)
  : Target(target)
  , Source(source)
  , Shares(shares)
  , Others(others)
  , Threads(threads)
{
  if (shares.centers.empty())
  {
    return;
  }
  // Each cell once per point: `last` is the last cell counted for a point.
  const auto forEachUse = [&](const auto& use)
  {
    std::vector<Index> last(source.points().size(), -1);
    for (Index s = 0; s < source.numberOfSimplices(); ++s)
    {
      for (int k = 0; k < source.corners(); ++k)
      {
        const Index p = source.simplices()[s][k], cell = source.cells()[s];
        if (last[p] != cell)
        {
          last[p] = cell;
          use(p, cell);
        }
      }
    }
  };
  this->AroundStarts.assign(source.points().size() + 1, 0);
  forEachUse([&](Index p, Index) { ++this->AroundStarts[p + 1]; });
  for (std::size_t p = 0; p < source.points().size(); ++p)
  {
    this->AroundStarts[p + 1] += this->AroundStarts[p];
  }
  std::vector<Index> next(this->AroundStarts.begin(), this->AroundStarts.end() - 1);
  this->Around.resize(this->AroundStarts.back());
  forEachUse([&](Index p, Index cell) { this->Around[next[p]++] = cell; });
}

//------------------------------------------------------------------------------
/// The limited gradient in a cell of the source, and the extremes of it and its neighbors.
void CellTransfer::reconstruct(
  Index cell, const std::vector<double>& field, Vec3& gradient, double& low, double& high) const
{
  std::vector<Index> points, neighbors;
  for (Index s = this->Source.starts()[cell]; s < this->Source.starts()[cell + 1]; ++s)
  {
    const TransferMesh::Simplex& simplex = this->Source.simplices()[s];
    points.insert(points.end(), simplex.begin(), simplex.begin() + this->Source.corners());
  }
  const auto unique = [](std::vector<Index>& list)
  {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  };
  unique(points);
  for (const Index p : points)
  {
    neighbors.insert(neighbors.end(), this->Around.begin() + this->AroundStarts[p],
      this->Around.begin() + this->AroundStarts[p + 1]);
  }
  unique(neighbors);
  // Least squares, with weights independent of the unit of length.
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d side = Eigen::Vector3d::Zero();
  low = high = field[cell];
  for (const Index other : neighbors)
  {
    low = std::min(low, field[other]);
    high = std::max(high, field[other]);
    const Vec3 d = this->Source.center(other) - this->Source.center(cell);
    const double square = dot(d, d);
    if (square > 0.0)
    {
      const Eigen::Vector3d offset(d[0], d[1], d[2]);
      matrix += (1.0 / square) * offset * offset.transpose();
      side += ((field[other] - field[cell]) / square) * offset;
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(matrix);
  constexpr double undetermined = 1e-6;
  Eigen::Vector3d found = Eigen::Vector3d::Zero();
  // Directions in which the neighbors hardly extend, such as the normal of a surface, get no
  // gradient.
  for (int k = 0; k < 3; ++k)
  {
    if (solver.eigenvalues()[k] > undetermined * solver.eigenvalues()[2])
    {
      const Eigen::Vector3d axis = solver.eigenvectors().col(k);
      found += (axis.dot(side) / solver.eigenvalues()[k]) * axis;
    }
  }
  gradient = { found[0], found[1], found[2] };
  // The limiter of T. Barth and D. Jespersen (1989): at all points of the cell, the linear function
  // stays between the values of the neighbors.
  double limit = 1.0;
  for (const Index p : points)
  {
    const double change = dot(gradient, this->Source.points()[p] - this->Source.center(cell));
    const double room = change > 0.0 ? high - field[cell] : low - field[cell];
    limit = change != 0.0 ? std::min(limit, room / change) : limit;
  }
  gradient = std::max(0.0, limit) * gradient;
}

//------------------------------------------------------------------------------
BoundedValues CellTransfer::apply(const std::vector<double>& field) const
{
  const bool linear = !this->Shares.centers.empty();
  std::vector<Vec3> gradients(linear ? field.size() : 0);
  std::vector<double> lows(field), highs(field);
  parallelFor(static_cast<Index>(gradients.size()), CellsPerChunk, this->Threads,
    [&](Index cell) { this->reconstruct(cell, field, gradients[cell], lows[cell], highs[cell]); });
  const Index count = this->Target.numberOfCells();
  BoundedValues result;
  result.values.resize(count);
  result.low.resize(count);
  result.high.resize(count);
  parallelFor(count, CellsPerChunk, this->Threads,
    [&](Index cell)
    {
      const Index begin = this->Shares.starts[cell], end = this->Shares.starts[cell + 1];
      // A target cell outside the source has the value of the nearest source cell.
      const Index first = begin < end ? this->Shares.cells[begin] : this->Others[cell];
      double value = begin < end ? 0.0 : field[first];
      double low = lows[first], high = highs[first];
      for (Index k = begin; k < end; ++k)
      {
        const Index s = this->Shares.cells[k];
        // The mean of a linear function over a share is its value at the center of the share.
        const double there = linear
          ? field[s] + dot(gradients[s], this->Shares.centers[k] - this->Source.center(s))
          : field[s];
        value += this->Shares.parts[k] * there;
        low = std::min(low, lows[s]);
        high = std::max(high, highs[s]);
      }
      result.low[cell] = low;
      result.high[cell] = high;
      result.values[cell] = std::clamp(value, low, high);
    });
  return result;
}
}
