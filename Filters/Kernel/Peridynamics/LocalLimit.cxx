// SPDX-License-Identifier: BSD-3-Clause
#include "LocalLimit.h"

#include "PeridynamicsGeometry.h"
#include "PeridynamicsKernel.h"

#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tautline
{
namespace
{
constexpr Index Unused = -1;
using Block = std::array<double, 4>; // rows and columns of two components; scalar: the first

/// The neighbors of a vertex, including itself, with their entries.
using Row = std::vector<std::pair<std::int32_t, Block>>;

/// The number of each vertex among the free ones, or Unused if it is given or in no triangle.
std::vector<Index> freeVertices(
  const HorizonMesh& mesh, PeridynamicBasis basis, const PeridynamicSystem& system, Index& count)
{
  std::vector<Index> numbers(mesh.numberOfPoints(), Unused);
  count = 0;
  if (basis == PeridynamicBasis::Linear)
  {
    for (std::size_t i = 0; i < numbers.size(); ++i)
    {
      numbers[i] = std::max(system.unknownOf[i], Unused);
    }
    count = static_cast<Index>(system.functionOf.size());
    return numbers;
  }
  // With a basis per triangle, a vertex is free if no triangle at it is given.
  std::vector<char> used(numbers.size(), 0), given(numbers.size(), 0);
  const Index perTriangle = basis == PeridynamicBasis::Constant ? 1 : 3;
  for (Index t = 0; t < mesh.numberOfTriangles(); ++t)
  {
    const bool fixed = system.unknownOf[perTriangle * t] < 0;
    for (int k = 0; k < 3; ++k)
    {
      (fixed ? given : used)[mesh.triangles[3 * t + k]] = 1;
    }
  }
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    if (used[i] && !given[i])
    {
      numbers[i] = count++;
    }
  }
  return numbers;
}

Block& entry(Row& row, Index column)
{
  const auto c = static_cast<std::int32_t>(column);
  for (auto& [neighbour, block] : row)
  {
    if (neighbour == c)
    {
      return block;
    }
  }
  row.emplace_back(c, Block{});
  return row.back().second;
}

/// Adds the products of the gradients of the functions of a triangle.
void addTriangle(const PlanarTriangles& triangles, Index t, const std::vector<Index>& numbers,
  bool elastic, double modulus, double ratio, std::vector<Row>& rows)
{
  Vec2 gradients[3];
  const double area = triangles.areas[t];
  for (int k = 0; k < 3; ++k)
  {
    const Vec2 a = triangles.corner(t, (k + 1) % 3), b = triangles.corner(t, (k + 2) % 3);
    gradients[k] = { (a[1] - b[1]) / (2.0 * area), (b[0] - a[0]) / (2.0 * area) };
  }
  for (int k = 0; k < 3; ++k)
  {
    const Index row = numbers[triangles.triangles[t][k]];
    for (int l = 0; l < 3 && row >= 0; ++l)
    {
      const Index column = numbers[triangles.triangles[t][l]];
      if (column < 0)
      {
        continue;
      }
      const Vec2 &g = gradients[k], &h = gradients[l];
      const double product = g[0] * h[0] + g[1] * h[1];
      Block& block = entry(rows[row], column);
      if (!elastic)
      {
        block[0] += modulus * area * product;
        continue;
      }
      // lambda / mu g_i h_j + h_i g_j, and g.h on the diagonal.
      for (int i = 0; i < 2; ++i)
      {
        for (int j = 0; j < 2; ++j)
        {
          block[2 * i + j] +=
            modulus * area * (ratio * g[i] * h[j] + h[i] * g[j] + (i == j ? product : 0.0));
        }
      }
    }
  }
}

SparseMatrix compressed(std::vector<Row>& rows, Index components)
{
  SparseMatrix matrix;
  matrix.size = static_cast<Index>(rows.size()) * components;
  for (Row& row : rows)
  {
    std::sort(row.begin(), row.end(),
      [](const auto& one, const auto& other) { return one.first < other.first; });
    for (Index i = 0; i < components; ++i)
    {
      for (const auto& [column, block] : row)
      {
        for (Index j = 0; j < components; ++j)
        {
          matrix.columns.push_back(static_cast<std::int32_t>(components * column + j));
          matrix.values.push_back(block[2 * i + j]);
        }
      }
      matrix.offsets.push_back(matrix.nonzeros());
    }
  }
  return matrix;
}

/// The values of the functions in terms of the values at the free vertices.
Prolongation fromVertices(const HorizonMesh& mesh, PeridynamicBasis basis,
  const PeridynamicSystem& system, const std::vector<Index>& numbers, Index count)
{
  Prolongation map;
  map.coarse = count;
  const auto add = [&](Index vertex, double weight)
  {
    if (numbers[vertex] >= 0)
    {
      map.columns.push_back(static_cast<std::int32_t>(numbers[vertex]));
      map.weights.push_back(weight);
    }
  };
  for (const Index f : system.functionOf)
  {
    if (basis == PeridynamicBasis::Linear)
    {
      add(f, 1.0);
    }
    else if (basis == PeridynamicBasis::DiscontinuousLinear)
    {
      add(mesh.triangles[f], 1.0);
    }
    for (int k = 0; k < 3 && basis == PeridynamicBasis::Constant; ++k)
    {
      add(mesh.triangles[3 * f + k], 1.0 / 3.0);
    }
    map.offsets.push_back(static_cast<Index>(map.columns.size()));
  }
  return map;
}
}

//------------------------------------------------------------------------------
double localModulus(const PeridynamicOptions& options)
{
  const RadialKernel kernel(options.kernel, options.horizon);
  constexpr bool fromOrigin = true;
  const bool elastic = isElastic(options.model);
  // F_m is the integral of r^(m+1) k.
  return kernelScale(options) *
    (elastic ? M_PI / 8.0 * kernel.atHorizon(4, fromOrigin)
             : M_PI / 2.0 * kernel.atHorizon(2, fromOrigin));
}

//------------------------------------------------------------------------------
LocalLimit localLimit(
  const HorizonMesh& mesh, const PeridynamicOptions& options, const PeridynamicSystem& system)
{
  const PlanarTriangles triangles(mesh);
  const bool elastic = isElastic(options.model);
  const double modulus = localModulus(options), ratio = lameRatio(options);
  Index count = 0;
  const std::vector<Index> numbers = freeVertices(mesh, options.basis, system, count);
  std::vector<Row> rows(count);
  for (Index t = 0; t < triangles.size(); ++t)
  {
    pollInterruption(t);
    addTriangle(triangles, t, numbers, elastic, modulus, ratio, rows);
  }
  LocalLimit limit;
  limit.matrix = compressed(rows, system.components);
  limit.prolongation = fromVertices(mesh, options.basis, system, numbers, count);
  return limit;
}
}
