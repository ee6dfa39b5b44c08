// SPDX-License-Identifier: BSD-3-Clause
#include "HarmonicStart.h"

#include "tautline/Core/Memory.h"
#include "tautline/Core/Random.h"
#include "tautline/Core/VectorAlgebra.h"
#include "tautline/Objectives/BlockJacobiMultigrid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tautline
{
namespace
{
constexpr int size = 3;            // of a block: coordinates are treated alike
constexpr int maxIterations = 100; // of conjugate gradients
constexpr double residual = 1e-7;  // relative to the first

/// The Laplacian of the edges over the free points.
struct Laplacian
{
  std::vector<std::int32_t> starts, columns, diagonals;
  std::vector<double> blocks;
  std::vector<double> right; ///< the contributions of fixed neighbors
};

Laplacian assemble(const OptimizationProblem& problem, const std::vector<std::int32_t>& rows,
  Index count, const std::vector<double>& points)
{
  const MeshView& view = problem.moving().view();
  Laplacian a;
  a.right.assign(static_cast<std::size_t>(size * count), 0.0);
  std::vector<double> degree(count, 0.0);
  // List each edge once for each element that has it.
  std::vector<std::pair<std::int32_t, std::int32_t>> entries;
  const auto add = [&](Index p, Index q)
  {
    if (rows[p] < 0)
    {
      return;
    }
    degree[rows[p]] += 1;
    if (rows[q] >= 0)
    {
      entries.emplace_back(rows[p], rows[q]);
      return;
    }
    for (int c = 0; c < size; ++c)
    {
      a.right[static_cast<std::size_t>(size) * rows[p] + c] += points[3 * q + c];
    }
  };
  const int dimension = problem.moving().dimension() == Dimension::Volume ? 3 : 2;
  for (const CellBlock& block : problem.moving().blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; t.dimension == dimension && i < block.count; ++i)
    {
      const Index* nodes = view.connectivity + view.offsets[block.cell(i)];
      for (int e = 0; e < t.edges; ++e)
      {
        add(nodes[t.edgeNodes[e][0]], nodes[t.edgeNodes[e][1]]);
        add(nodes[t.edgeNodes[e][1]], nodes[t.edgeNodes[e][0]]);
      }
    }
  }
  for (Index row = 0; row < count; ++row)
  {
    entries.emplace_back(static_cast<std::int32_t>(row), static_cast<std::int32_t>(row));
  }
  std::sort(entries.begin(), entries.end());
  a.starts.assign(count + 1, 0);
  a.diagonals.resize(count);
  const auto addToDiagonal = [&](double value)
  {
    for (int c = 0; c < size; ++c)
    {
      a.blocks[a.blocks.size() - size * size + (size + 1) * c] += value;
    }
  };
  for (std::size_t i = 0; i < entries.size(); ++i)
  {
    const auto [row, column] = entries[i];
    if (i == 0 || entries[i] != entries[i - 1])
    {
      a.columns.push_back(column);
      a.blocks.resize(a.blocks.size() + size * size, 0.0);
      ++a.starts[row + 1];
    }
    if (row == column)
    {
      a.diagonals[row] = static_cast<std::int32_t>(a.columns.size()) - 1;
      addToDiagonal(degree[row]);
    }
    else
    {
      addToDiagonal(-1);
    }
  }
  for (Index row = 0; row < count; ++row)
  {
    a.starts[row + 1] += a.starts[row];
  }
  return a;
}

/// Throws MemoryError if there is no memory for the matrix, its grids and the vectors.
void requireMemoryFor(const OptimizationProblem& problem)
{
  const MeshView& view = problem.moving().view();
  double edges = 0; // once for each element that has them
  for (const CellBlock& block : problem.moving().blocks())
  {
    edges += static_cast<double>(block.count) * topology(block.type).edges;
  }
  // Pairs of rows in both directions, before equal ones are joined: in a plane, every second one
  // remains; in a volume, every fourth or fifth. Lists grow by doubling; the grids need as much as
  // the matrix.
  constexpr double pair = 2 * sizeof(std::int32_t), growth = 2, directions = 2, grids = 2;
  constexpr double block = size * size * sizeof(double) + sizeof(std::int32_t);
  const double left = problem.moving().dimension() == Dimension::Volume ? 0.25 : 0.5;
  const double ofEdge = directions * (growth * pair + growth * left * block) + grids * left * block;
  constexpr double vectors = 10;
  requireMemory(
    ofEdge * edges + vectors * size * sizeof(double) * static_cast<double>(view.numberOfPoints),
    "The harmonic map", "sweeps continue instead");
}

BlockMatrixView viewOf(const Laplacian& a, Index count)
{
  return { size, count, a.starts.data(), a.columns.data(), a.diagonals.data(), a.blocks.data() };
}

/**
 * @brief Flexible conjugate gradients; false if they do not converge.
 * @param times product of the matrix and a vector
 * @param precondition solves roughly
 */
template <class Times, class Precondition>
bool solve(const VectorAlgebra& algebra, const std::vector<double>& right, const Times& times,
  const Precondition& precondition, std::vector<double>& x)
{
  std::vector<double> r(x.size()), z(x.size()), d(x.size()), product(x.size());
  times(x.data(), product.data());
  algebra.each([&](Index i) { r[i] = right[i] - product[i]; });
  const double wanted = residual * residual * algebra.dot(r.data(), r.data());
  if (wanted == 0)
  {
    return true;
  }
  precondition(r.data(), z.data());
  d = z;
  double rz = algebra.dot(r.data(), z.data());
  for (int i = 0; i < maxIterations && rz > 0; ++i)
  {
    times(d.data(), product.data());
    const double step = rz / algebra.dot(d.data(), product.data());
    algebra.each(
      [&](Index k)
      {
        x[k] += step * d[k];
        r[k] -= step * product[k];
      });
    const double rest = algebra.dot(r.data(), r.data());
    if (!(rest > wanted))
    {
      return std::isfinite(rest);
    }
    precondition(r.data(), z.data());
    const double beta = -step * algebra.dot(z.data(), product.data()) / rz;
    rz = algebra.dot(r.data(), z.data());
    algebra.each([&](Index k) { d[k] = z[k] + beta * d[k]; });
  }
  return false;
}
}

//------------------------------------------------------------------------------
std::vector<double> harmonicPoints(OptimizationProblem& problem, const std::vector<double>& start)
{
  const MatrixRows& rows = problem.rows();
  const Ranks& ranks = problem.ranks();
  const int threads = problem.options().threads;
  Laplacian a;
  std::vector<double> all, found, x(size * rows.numberOfOwned()), right;
  ranks.inMemory(
    [&]
    {
      requireMemoryFor(problem); // also covers the following code, where no rank may fail alone
      a = assemble(problem, rows.rowOfPoint(), rows.rows(), start);
      all.resize(static_cast<std::size_t>(size * rows.rows()));
      found.resize(ranks.several() ? all.size() : 0);
      right.resize(x.size());
    },
    "The harmonic map does not fit into memory.");
  for (Index row = 0; row < rows.rows(); ++row)
  {
    std::copy_n(&start[3 * static_cast<std::size_t>(rows.points()[row])], 3, &all[size * row]);
  }
  const auto ofOwn = [&](std::vector<double>& ofAll, std::vector<double>& own)
  { ranks.several() ? rows.pick(ofAll, own.data(), size) : own.swap(ofAll); };
  ofOwn(all, x);
  ofOwn(a.right, right);
  const BlockMatrixView matrix = viewOf(a, rows.rows());
  const std::unique_ptr<GridHierarchy> grids = makeGrids(rows, threads);
  grids->build(matrix);
  const auto times = [&](const double* d, double* product)
  {
    multiply(matrix, threads, rows.spread(d, all, size), rows.target(product, found, size));
    rows.pick(found, product, size);
  };
  if (!solve(
        VectorAlgebra(x.size(), threads, LaneOrder::Sequential, ranks.group()), right, times,
        [&](const double* r, double* z) { grids->apply(r, z); }, x))
  {
    return {};
  }
  std::vector<double> points = start;
  const double* moved = rows.spread(x.data(), all, size);
  for (Index row = 0; row < rows.rows(); ++row)
  {
    std::copy_n(moved + size * row, 3, &points[3 * static_cast<std::size_t>(rows.points()[row])]);
  }
  return points;
}

//------------------------------------------------------------------------------
void shiftFreePoints(const OptimizationProblem& problem, double part, std::vector<double>& points)
{
  const Mesh& mesh = problem.moving();
  const SimplexMesh& simplices = problem.simplices();
  const Ranks& ranks = problem.ranks();
  constexpr std::uint64_t seed = 1, stream = 0;
  const MeshView& view = mesh.view();
  const auto at = [&](Index p) {
    return Vec3{ points[3 * p], points[3 * p + 1], points[3 * p + 2] };
  };
  std::vector<double> shortest(view.numberOfPoints, std::numeric_limits<double>::infinity());
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; i < block.count; ++i)
    {
      const Index* nodes = view.connectivity + view.offsets[block.cell(i)];
      for (int e = 0; e < t.edges; ++e)
      {
        const Index a = nodes[t.edgeNodes[e][0]], b = nodes[t.edgeNodes[e][1]];
        const double length = norm(at(b) - at(a));
        shortest[a] = std::min(shortest[a], length);
        shortest[b] = std::min(shortest[b], length);
      }
    }
  }
  for (std::int32_t v = 0; v < simplices.freeVertices(); ++v)
  {
    const Index p = simplices.point(v);
    if (std::isfinite(shortest[p]))
    {
      SplitMix random(seed, stream, ranks.several() ? ranks.mesh().numbers()[p] : p);
      const Vec3 direction = mesh.dimension() == Dimension::Planar
        ? random.direction(mesh.frame()[0], mesh.frame()[1])
        : random.direction();
      const Vec3 shifted = at(p) + part * random.uniform() * shortest[p] * direction;
      std::copy(shifted.begin(), shifted.end(), points.begin() + 3 * p);
    }
  }
  ranks.exchange(points.data(), 3); // a copy of a point may lack edges
}
}
