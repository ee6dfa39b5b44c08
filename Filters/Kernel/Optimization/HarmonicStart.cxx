// SPDX-License-Identifier: BSD-3-Clause
#include "HarmonicStart.h"

#include "tautline/Core/VectorAlgebra.h"
#include "tautline/Objectives/Multigrid.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tautline
{
namespace
{
constexpr int size = 3;            // of a block: coordinates are alike
constexpr int maxIterations = 100; // of conjugate gradients
constexpr double residual = 1e-7;  // relative to the first

/// The Laplacian of the edges over the free points.
struct Laplacian
{
  std::vector<std::int32_t> starts, columns, diagonals;
  std::vector<double> blocks;
  std::vector<double> right; ///< what the fixed neighbours contribute
};

Laplacian assemble(const OptimizationProblem& problem, const std::vector<std::int32_t>& rows,
  Index count, const std::vector<double>& points)
{
  const MeshView& view = problem.moving().view();
  Laplacian a;
  a.right.assign(static_cast<std::size_t>(size * count), 0.0);
  std::vector<double> degree(count, 0.0);
  // Each edge once for each element that has it.
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

/// Flexible conjugate gradients; false if they do not converge.
bool solve(const Laplacian& a, Index count, int threads, std::vector<double>& x)
{
  const BlockMatrixView matrix = { size, count, a.starts.data(), a.columns.data(),
    a.diagonals.data(), a.blocks.data() };
  Multigrid grids(threads);
  grids.build(matrix);
  const VectorAlgebra algebra(x.size(), threads);
  std::vector<double> r(x.size()), z(x.size()), d(x.size()), product(x.size());
  multiply(matrix, threads, x.data(), product.data());
  algebra.each([&](Index i) { r[i] = a.right[i] - product[i]; });
  const double wanted = residual * residual * algebra.dot(r.data(), r.data());
  if (wanted == 0)
  {
    return true;
  }
  grids.apply(r.data(), z.data());
  d = z;
  double rz = algebra.dot(r.data(), z.data());
  for (int i = 0; i < maxIterations && rz > 0; ++i)
  {
    multiply(matrix, threads, d.data(), product.data());
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
    grids.apply(r.data(), z.data());
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
  const SimplexMesh& s = problem.simplices();
  const Index count = s.freeVertices();
  std::vector<std::int32_t> rows(start.size() / 3, -1);
  std::vector<double> x(static_cast<std::size_t>(size * count));
  for (std::int32_t v = 0; v < s.freeVertices(); ++v)
  {
    rows[s.point(v)] = v;
    std::copy_n(start.begin() + 3 * static_cast<std::size_t>(s.point(v)), 3,
      x.begin() + static_cast<std::size_t>(size) * v);
  }
  std::vector<double> points = start;
  if (!solve(assemble(problem, rows, count, start), count, problem.options().threads, x))
  {
    points.clear();
    return points;
  }
  for (std::int32_t v = 0; v < s.freeVertices(); ++v)
  {
    std::copy_n(x.begin() + static_cast<std::size_t>(size) * v, 3,
      points.begin() + 3 * static_cast<std::size_t>(s.point(v)));
  }
  return points;
}
}
