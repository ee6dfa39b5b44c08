// SPDX-License-Identifier: BSD-3-Clause
#include "WarpElastic.h"

#include "WarpSheet.h"
#include "tautline/Quality/Metrics.h"

#include <limits>

namespace tautline
{
ElasticWarp::ElasticWarp(const Mesh& mesh, const WarpParts& parts, WarpControl& control)
  : Input(mesh)
  , Parts(parts)
  , Components(parts.dimension() == Dimension::Planar ? 2 : 3)
{
  const Index cells = mesh.view().numberOfCells;
  this->Stiffening.assign(cells, 1.0);
  if (control.options().method != WarpMethod::JacobianStiffening)
  {
    return;
  }
  std::vector<double> sizes(cells);
  EvaluationOptions evaluation;
  evaluation.threads = control.options().threads;
  evaluateMetric(mesh, Metric::Size, evaluation, sizes.data());
  double sum = 0;
  Index count = 0;
  for (Index i = 0; i < cells; ++i)
  {
    sum += parts.ranks().ownsCell(i) ? std::abs(sizes[i]) : 0.0;
    count += parts.ranks().ownsCell(i) && sizes[i] != 0;
  }
  sum = parts.ranks().sum(sum);
  count = parts.ranks().sum(count);
  // The factor (J_0 / J)^chi of each element, J_0 the mean.
  const double mean = sum / std::max<double>(1.0, static_cast<double>(count));
  for (Index i = 0; i < cells; ++i)
  {
    if (sizes[i] != 0)
    {
      this->Stiffening[i] = std::pow(mean / std::abs(sizes[i]), control.options().stiffeningPower);
    }
  }
}

//------------------------------------------------------------------------------
void ElasticWarp::assemble(WarpControl& control)
{
  const double before = control.elapsed();
  ElasticOperator pde;
  pde.poissonRatio = control.options().poissonRatio;
  pde.stiffening = this->Stiffening.data();
  AssemblyOptions options;
  options.threads = control.options().threads;
  const Ranks& ranks = this->Parts.ranks();
  SparseMatrix matrix;
  ranks.together(
    [&]
    {
      if (this->Input.view().numberOfCells > 0)
      {
        matrix = this->Parts.dimension() == Dimension::Surface
          ? sheetMatrix(this->Input, pde, options)
          : stiffnessMatrix(this->Input, pde, options);
        return;
      }
      matrix.size = this->Components * this->Input.view().numberOfPoints;
      matrix.offsets.assign(matrix.size + 1, 0);
    });
  this->System = std::make_unique<WarpSystem>(matrix, this->Components, this->Parts.held(),
    this->Input.view().points, this->Components, control.options(), ranks);
  const auto range = std::minmax_element(this->Stiffening.begin(), this->Stiffening.end());
  const bool none = this->Stiffening.empty(); // factors are at least 0
  const double most = ranks.maximum(none ? 0.0 : *range.second);
  this->Uniform = !ranks.any(!none && *range.first != most);
  control.result().assembleSeconds += control.elapsed() - before;
}

//------------------------------------------------------------------------------
/// A homogeneous body follows affine motions exactly: they are subtracted, and only the rest is
/// solved for.
bool ElasticWarp::solve(
  const double* displacement, WarpControl& control, std::vector<double>& moved)
{
  const MeshView& view = this->Input.view();
  const Index n = view.numberOfPoints;
  const int d = this->Components;
  const std::array<Vec3, 3> space = { Vec3{ 1, 0, 0 }, Vec3{ 0, 1, 0 }, Vec3{ 0, 0, 1 } };
  const auto axis = [&](int k) { return d == 2 ? this->Input.frame()[k] : space[k]; };
  std::vector<AffineMotion> affine(this->Parts.parts());
  if (this->Uniform)
  {
    affine = this->Parts.affine(view.points, displacement);
  }
  std::vector<double> values(d * n, 0.0);
  moved.assign(3 * n, 0.0);
  for (Index i = 0; i < n; ++i)
  {
    const Index part = this->Parts.part(i);
    const Vec3 common = part >= 0 ? affine[part].at(pointOf(view, i)) : Vec3{ 0, 0, 0 };
    std::copy(common.begin(), common.end(), &moved[3 * i]);
    if (this->Parts.prescribed()[i])
    {
      const Vec3 given = { displacement[3 * i], displacement[3 * i + 1], displacement[3 * i + 2] };
      std::copy(given.begin(), given.end(), &moved[3 * i]);
      for (int k = 0; k < d; ++k)
      {
        values[d * i + k] = dot(axis(k), given - common);
      }
    }
  }
  const bool good = this->System->solve(values, control);
  for (Index i = 0; i < n; ++i)
  {
    for (int k = 0; k < d && !this->Parts.held()[i]; ++k)
    {
      const Vec3 part = values[d * i + k] * axis(k);
      for (int c = 0; c < 3; ++c)
      {
        moved[3 * i + c] += part[c];
      }
    }
  }
  return good;
}

//------------------------------------------------------------------------------
std::vector<double> ElasticWarp::warp(const double* displacement, WarpControl& control)
{
  const WarpOptions& options = control.options();
  const MeshView& view = this->Input.view();
  const bool iterative = options.method == WarpMethod::IterativeStiffening;
  if (iterative && !this->Uniform)
  {
    // Each boundary position starts with a homogeneous body.
    this->Stiffening.assign(view.numberOfCells, 1.0);
    this->System.reset();
  }
  std::vector<double> best, moved, points(3 * view.numberOfPoints);
  std::vector<signed char> validity(view.numberOfCells);
  Index fewest = std::numeric_limits<Index>::max();
  constexpr double stiffest = 1e12; // nearly rigid, while the matrix can still be factored
  for (int round = 0;; ++round)
  {
    if (!this->System)
    {
      this->assemble(control);
    }
    if (!this->solve(displacement, control, moved))
    {
      if (!control.stopped())
      {
        control.addMessage("The linear solver did not converge: " + this->System->failure());
      }
      return best.empty() ? moved : best;
    }
    if (!iterative)
    {
      return moved;
    }
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      points[i] = view.points[i] + moved[i];
    }
    // Stiffens the inverted elements and keeps the best result.
    MeshView now = view;
    now.points = points.data();
    Mesh mesh(now, options.threads);
    mesh.setMirrored(this->Input.mirrored());
    mesh.setSpace(this->Input.space());
    mesh.classifyCells(validity.data(), options.threads);
    Index inverted = 0;
    for (Index i = 0; i < view.numberOfCells; ++i)
    {
      if (validity[i] != Valid && validity[i] != NotMeasured)
      {
        inverted += this->Parts.ranks().ownsCell(i);
        this->Stiffening[i] = std::min(stiffest, options.stiffeningFactor * this->Stiffening[i]);
      }
    }
    inverted = this->Parts.ranks().sum(inverted);
    if (inverted < fewest)
    {
      fewest = inverted;
      best = moved;
    }
    if (inverted == 0)
    {
      return best;
    }
    if (round == options.maximumStiffenings)
    {
      control.addMessage("Stiffening stopped after " + std::to_string(round) + " rounds with " +
        std::to_string(fewest) + " inverted elements.");
      return best;
    }
    if (!control.proceed(static_cast<double>(round + 1) / (options.maximumStiffenings + 1)))
    {
      return best;
    }
    this->System.reset();
  }
}
}
