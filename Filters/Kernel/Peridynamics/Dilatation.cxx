// SPDX-License-Identifier: BSD-3-Clause
#include "Dilatation.h"

#include "LocalLimit.h"
#include "PeridynamicsPair.h"

#include "tautline/Core/Parallel.h"

#include <algorithm>

namespace tautline
{
namespace
{
// Radon's rule of degree 5 on a triangle: the centroid and two orbits of three points.
constexpr int RulePoints = 7;
constexpr double Orbits[2] = { 0.10128650732345634, 0.47014206410511509 };
constexpr double Weights[3] = { 0.225, 0.12593918054482715, 0.13239415278850619 };

/// The number of triangles whose rows are kept at a time.
constexpr Index BatchSize = 256;

using Barycentric = std::array<double, 3>;

Barycentric rulePoint(int q, double& weight)
{
  if (q == 0)
  {
    weight = Weights[0];
    return { 1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0 };
  }
  const int orbit = (q - 1) / 3;
  weight = Weights[1 + orbit];
  Barycentric at = { Orbits[orbit], Orbits[orbit], Orbits[orbit] };
  at[(q - 1) % 3] = 1.0 - 2.0 * Orbits[orbit];
  return at;
}

Vec2 pointAt(const PlanarTriangles& triangles, Index t, const Barycentric& at)
{
  return at[0] * triangles.corner(t, 0) + at[1] * triangles.corner(t, 1) +
    at[2] * triangles.corner(t, 2);
}

/// The linear functions of a triangle: gradients, and the values at any x.
struct LinearFunctions
{
  Vec2 corners[3], gradients[3];

  LinearFunctions(const PlanarTriangles& triangles, Index t)
  {
    for (int k = 0; k < 3; ++k)
    {
      this->corners[k] = triangles.corner(t, k);
    }
    for (int k = 0; k < 3; ++k)
    {
      const Vec2 e = this->corners[(k + 2) % 3] - this->corners[(k + 1) % 3];
      this->gradients[k] = (0.5 / triangles.areas[t]) * Vec2{ -e[1], e[0] };
    }
  }
  /// Relative to an opposite corner, so that it is exact where the function vanishes.
  double value(int k, Vec2 x) const
  {
    return dot(this->gradients[k], x - this->corners[(k + 1) % 3]);
  }
};

/// int k |xi|^2 xi and int k |xi|^2 xi xi^T (xx, xy, yy) from the moments of degrees 3 and 4.
struct DilatationMoments
{
  Vec2 third;
  double fourth[3];

  explicit DilatationMoments(const double* m)
    : third{ m[6] + m[8], m[7] + m[9] }
    , fourth{ m[10] + m[12], m[11] + m[13], m[12] + m[14] }
  {
  }
  Vec2 times(Vec2 gradient) const
  {
    return { this->fourth[0] * gradient[0] + this->fourth[1] * gradient[1],
      this->fourth[1] * gradient[0] + this->fourth[2] * gradient[1] };
  }
};

/// 2 / m for the whole disk.
double dilatationFactor(const PeridynamicOptions& options)
{
  const RadialKernel kernel(options.kernel, options.horizon);
  constexpr bool fromOrigin = true;
  // The weighted volume m of the disk is 2 pi times the integral of r^5 k(r).
  return 2.0 / (2.0 * Pi * kernel.atHorizon(4, fromOrigin));
}

/// theta at a point, as a sum over functions.
struct DilatationRow
{
  std::vector<std::int32_t> functions;
  std::vector<Vec2> values; ///< factors of both components
  double weight = 0.0;      ///< of the point in the integral
};

/// Computes the rows of the points of one triangle.
class DilatationRows
{
public:
  explicit DilatationRows(const PeridynamicWork& work)
    : Work(work)
    , Integrator(work.options, 3) // provides the moments of all degrees
    , Factor(dilatationFactor(work.options))
    , Sums(work.space.functions, Vec2{})
    , Marked(work.space.functions, 0)
  {
  }

  void make(Index t, std::vector<DilatationRow>& rows)
  {
    this->Work.neighboursOf(t, this->Near);
    rows.resize(RulePoints);
    for (int q = 0; q < RulePoints; ++q)
    {
      double weight;
      const Barycentric at = rulePoint(q, weight);
      this->row(t, at, rows[q]);
      rows[q].weight = weight * this->Work.triangles.areas[t];
    }
  }

private:
  void add(Index function, Vec2 value)
  {
    if (!this->Marked[function])
    {
      this->Marked[function] = 1;
      this->Touched.push_back(static_cast<std::int32_t>(function));
    }
    this->Sums[function] = this->Sums[function] + value;
  }

  void row(Index t, const Barycentric& at, DilatationRow& row)
  {
    const PlanarTriangles& triangles = this->Work.triangles;
    const FunctionSpace& space = this->Work.space;
    const Vec2 x = pointAt(triangles, t, at);
    const bool constant = space.perTriangle() == 1;
    this->Touched.clear();
    for (const std::int32_t other : this->Near)
    {
      if (constant && other == t)
      {
        continue; // a constant does not change in its own triangle
      }
      const LinearFunctions linear(triangles, other);
      double m[PairIntegrator::Moments];
      if (!this->Integrator.momentsAround(linear.corners, x, other == t, m))
      {
        continue;
      }
      const DilatationMoments moments(m);
      if (constant)
      {
        this->add(space.function(triangles, other, 0), moments.third);
        this->add(space.function(triangles, t, 0), -1.0 * moments.third);
        continue;
      }
      for (int k = 0; k < 3; ++k)
      {
        // phi(y) - phi(x), with phi extended from the triangle of y; within the triangle of the
        // point, only the gradient contributes.
        const Vec2 change = moments.times(linear.gradients[k]);
        const Index f = space.function(triangles, other, k);
        if (other == t)
        {
          this->add(f, change);
          continue;
        }
        this->add(f, change + linear.value(k, x) * moments.third);
        this->add(space.function(triangles, t, k), -at[k] * moments.third);
      }
    }
    // Increasing order makes the sums below independent of the order in which neighbors are found.
    std::sort(this->Touched.begin(), this->Touched.end());
    row.functions = this->Touched;
    row.values.clear();
    for (const std::int32_t f : this->Touched)
    {
      row.values.push_back(this->Factor * this->Sums[f]);
      this->Sums[f] = {};
      this->Marked[f] = 0;
    }
  }

  const PeridynamicWork& Work;
  PairIntegrator Integrator;
  double Factor;
  std::vector<Vec2> Sums;
  std::vector<char> Marked;
  std::vector<std::int32_t> Touched, Near;
};

/// The triangles whose dilatation depends on an unknown function.
std::vector<std::int32_t> trianglesWithDilatation(const PeridynamicWork& work)
{
  const std::vector<char> unknown = work.space.trianglesWithUnknowns(work.triangles);
  std::vector<char> marked(unknown.size(), 0);
  std::vector<std::int32_t> near, found;
  for (std::size_t t = 0; t < unknown.size(); ++t)
  {
    if (unknown[t])
    {
      work.neighboursOf(static_cast<Index>(t), near);
      for (const std::int32_t other : near)
      {
        marked[other] = 1;
      }
    }
  }
  for (std::size_t t = 0; t < marked.size(); ++t)
  {
    if (marked[t])
    {
      found.push_back(static_cast<std::int32_t>(t));
    }
  }
  return found;
}

/// The location of a function in the rows of a batch: its row, and its position there.
struct Occurrence
{
  std::int32_t row, place;
};

/// The products of the rows of a batch, by unknown function.
class BatchProduct
{
public:
  BatchProduct(const PeridynamicWork& work, const std::vector<std::vector<DilatationRow>>& batch)
    : Work(work)
    , Occurrences(work.space.unknowns)
  {
    for (const auto& rows : batch)
    {
      for (const DilatationRow& row : rows)
      {
        this->Rows.push_back(&row);
      }
    }
    for (std::size_t r = 0; r < this->Rows.size(); ++r)
    {
      const DilatationRow& row = *this->Rows[r];
      for (std::size_t k = 0; k < row.functions.size(); ++k)
      {
        const Index u = work.space.unknownOf[row.functions[k]];
        if (u >= 0)
        {
          this->Occurrences[u].push_back(
            { static_cast<std::int32_t>(r), static_cast<std::int32_t>(k) });
        }
      }
    }
  }

  /// Adds to the two matrix rows of an unknown function; `places` has one number per function.
  void addTo(Index u, double factor, const std::vector<double>* given, std::vector<Index>& places,
    PeridynamicSystem& system) const
  {
    if (this->Occurrences[u].empty())
    {
      return;
    }
    SparseMatrix& matrix = system.matrix;
    const Index begin = matrix.offsets[2 * u], end = matrix.offsets[2 * u + 1];
    // The columns of a function are consecutive, and both rows of an unknown have the same pattern.
    for (Index k = begin; k < end; k += 2)
    {
      places[this->Work.space.functionOf[matrix.columns[k] / 2]] = k - begin;
    }
    for (const Occurrence& at : this->Occurrences[u])
    {
      const DilatationRow& row = *this->Rows[at.row];
      const Vec2 own = factor * row.weight * row.values[at.place];
      for (std::size_t k = 0; k < row.functions.size(); ++k)
      {
        const Index f = row.functions[k];
        const Vec2 value = row.values[k];
        if (this->Work.space.unknownOf[f] >= 0)
        {
          for (Index i = 0; i < 2; ++i)
          {
            double* to = &matrix.values[matrix.offsets[2 * u + i] + places[f]];
            to[0] += own[i] * value[0];
            to[1] += own[i] * value[1];
          }
        }
        else if (given)
        {
          const double theta = value[0] * (*given)[2 * f] + value[1] * (*given)[2 * f + 1];
          system.constraintLoad[2 * u] += own[0] * theta;
          system.constraintLoad[2 * u + 1] += own[1] * theta;
        }
      }
    }
  }

private:
  const PeridynamicWork& Work;
  std::vector<const DilatationRow*> Rows;
  std::vector<std::vector<Occurrence>> Occurrences;
};
}

//------------------------------------------------------------------------------
void addDilatation(const PeridynamicWork& work, const std::vector<double>* given,
  PeridynamicSystem& system, const std::function<bool(double)>& proceed)
{
  // Bonds alone give lambda = mu, so that the dilatation term adds the difference (lambda / mu - 1)
  // mu.
  const double factor = (lameRatio(work.options) - 1.0) * localModulus(work.options);
  const std::vector<std::int32_t> needed = trianglesWithDilatation(work);
  const auto count = static_cast<Index>(needed.size());
  ScratchPool<DilatationRows> makers([&] { return DilatationRows(work); });
  ScratchPool<std::vector<Index>> places(
    [&] { return std::vector<Index>(work.space.functions, 0); });
  std::vector<std::vector<DilatationRow>> batch;
  // Within a batch, each matrix row has one writer, and the rows of the points have a fixed order.
  for (Index begin = 0; begin < count; begin += BatchSize)
  {
    batch.resize(std::min(BatchSize, count - begin));
    constexpr Index grain = 4;
    parallelFor(static_cast<Index>(batch.size()), grain, work.options.threads, makers,
      [&](DilatationRows& maker, Index i) { maker.make(needed[begin + i], batch[i]); });
    const BatchProduct product(work, batch);
    parallelFor(work.space.unknowns, grain, work.options.threads, places,
      [&](std::vector<Index>& place, Index u) { product.addTo(u, factor, given, place, system); });
    if (!proceed(static_cast<double>(begin + static_cast<Index>(batch.size())) /
          static_cast<double>(count)))
    {
      return;
    }
  }
}

//------------------------------------------------------------------------------
namespace
{
/// The strain of a motion at the centroids of triangles.
class StrainSampler
{
public:
  StrainSampler(const PeridynamicWork& work, const std::vector<double>& values)
    : Work(work)
    , Values(values)
    , Integrator(work.options, 3)
    , Theta(dilatationFactor(work.options))
    , Bonds(0.25 * kernelScale(work.options))
    , Excess((lameRatio(work.options) - 1.0) * localModulus(work.options))
  {
  }

  void sample(Index t, double& dilatation, double& energyDensity)
  {
    const PlanarTriangles& triangles = this->Work.triangles;
    this->Work.neighboursOf(t, this->Near);
    constexpr double third = 1.0 / 3.0;
    const Vec2 x = pointAt(triangles, t, { third, third, third });
    Vec2 g[2];
    const Vec2 own = this->motion(t, x, g);
    double theta = 0.0, energy = 0.0;
    for (const std::int32_t other : this->Near)
    {
      const LinearFunctions linear(triangles, other);
      double m[PairIntegrator::Moments];
      if (!this->Integrator.momentsAround(linear.corners, x, other == t, m))
      {
        continue;
      }
      if (other == t)
      {
        std::fill(m, m + FourthDegree, 0.0); // may not exist, and the jump is 0
      }
      const Vec2 jump = this->motion(other, x, g) - own;
      const DilatationMoments moments(m);
      // theta sums k |xi|^2 xi . (u(y) - u(x)), with u linear in each triangle.
      theta += dot(jump, moments.third) + moments.times(g[0])[0] + moments.times(g[1])[1];
      // (xi . (u(y) - u(x)))^2, in which xi . G xi = a x^2 + b x y + c y^2.
      const double a = g[0][0], b = g[0][1] + g[1][0], c = g[1][1];
      energy += jump[0] * jump[0] * m[3] + 2.0 * jump[0] * jump[1] * m[4] +
        jump[1] * jump[1] * m[5] + 2.0 * jump[0] * (a * m[6] + b * m[7] + c * m[8]) +
        2.0 * jump[1] * (a * m[7] + b * m[8] + c * m[9]) + a * a * m[10] + 2.0 * a * b * m[11] +
        (b * b + 2.0 * a * c) * m[12] + 2.0 * b * c * m[13] + c * c * m[14];
    }
    dilatation = this->Theta * theta;
    energyDensity = this->Bonds * energy + 0.5 * this->Excess * dilatation * dilatation;
  }

private:
  static constexpr int FourthDegree = 10; ///< index of the first moment of degree 4

  /// The motion of a triangle extended to x, and the gradients of its components.
  Vec2 motion(Index t, Vec2 x, Vec2* gradients) const
  {
    const FunctionSpace& space = this->Work.space;
    const LinearFunctions linear(this->Work.triangles, t);
    const bool constant = space.perTriangle() == 1;
    Vec2 value = {};
    gradients[0] = gradients[1] = {};
    for (int k = 0; k < space.perTriangle(); ++k)
    {
      const double* u = &this->Values[2 * space.function(this->Work.triangles, t, k)];
      value = value + (constant ? 1.0 : linear.value(k, x)) * Vec2{ u[0], u[1] };
      for (int i = 0; i < 2 && !constant; ++i)
      {
        gradients[i] = gradients[i] + u[i] * linear.gradients[k];
      }
    }
    return value;
  }

  const PeridynamicWork& Work;
  const std::vector<double>& Values;
  PairIntegrator Integrator;
  double Theta, Bonds, Excess;
  std::vector<std::int32_t> Near;
};
}

//------------------------------------------------------------------------------
PeridynamicStrain peridynamicStrain(
  const HorizonMesh& mesh, const PeridynamicOptions& options, const std::vector<double>& values)
{
  if (!isElastic(options.model))
  {
    throw Error("strains are only defined for elastic models: choose one of them");
  }
  PlanarTriangles triangles(mesh);
  triangles.sortByPlace();
  const FunctionSpace space(mesh, triangles, options);
  if (static_cast<Index>(values.size()) != 2 * space.functions)
  {
    throw Error("the motion has " + std::to_string(values.size()) + " values; " +
      std::to_string(2 * space.functions) + " are expected");
  }
  const BoxGrid grid(triangles.low, triangles.high);
  const BondCut cut(triangles, options.horizon, options.cutBonds);
  const std::vector<char> needed = space.trianglesWithUnknowns(triangles);
  const PeridynamicWork work = { triangles, grid, space, options, cut, needed };
  PeridynamicStrain strain;
  strain.dilatation.assign(triangles.size(), 0.0);
  strain.energyDensity.assign(triangles.size(), 0.0);
  ScratchPool<StrainSampler> samplers([&] { return StrainSampler(work, values); });
  constexpr Index grain = 16;
  parallelFor(triangles.size(), grain, options.threads, samplers,
    [&](StrainSampler& sampler, Index t)
    {
      const Index cell = triangles.source(t);
      if (!options.constrained || !mesh.layer[cell])
      {
        sampler.sample(t, strain.dilatation[cell], strain.energyDensity[cell]);
      }
    });
  return strain;
}
}
