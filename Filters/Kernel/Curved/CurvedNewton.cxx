// SPDX-License-Identifier: BSD-3-Clause
#include "CurvedNewton.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
double product(const std::vector<double>& a, const std::vector<double>& b)
{
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

void addTo(std::vector<double>& y, double factor, const std::vector<double>& x)
{
  for (std::size_t i = 0; i < y.size(); ++i)
  {
    y[i] += factor * x[i];
  }
}
}

//------------------------------------------------------------------------------
template <int Dim>
void CurvedNewton<Dim>::precondition(const std::vector<double>& r, std::vector<double>& z) const
{
  z.assign(r.size(), 0.0);
  forEachChunk(static_cast<Index>(this->Inverse.size()), this->Threads,
    [&](Index, Index begin, Index end)
    {
      for (Index p = begin; p < end; ++p)
      {
        for (int i = 0; i < Dim; ++i)
        {
          for (int j = 0; j < Dim; ++j)
          {
            z[3 * p + i] += this->Inverse[p][i][j] * r[3 * p + j];
          }
        }
      }
    });
  // The result stays in the permitted directions only up to rounding.
  this->Slides.project(z);
}

//------------------------------------------------------------------------------
template <int Dim>
void CurvedNewton<Dim>::linearize(const std::vector<double>& x, const NewtonLimits& limits)
{
  this->Value = this->Energy.linearize(x, this->Gradient, this->Inverse);
  // holdRidges() also needs the components that the projection removes.
  this->Full = this->Gradient;
  this->Slides.project(this->Gradient);
  this->GradientNorm = std::sqrt(product(this->Gradient, this->Gradient));
  for (std::size_t p = 0; p < this->Inverse.size(); ++p)
  {
    PointBlock& block = this->Inverse[p];
    this->Slides.project(static_cast<Index>(p), block);
    Eigen::Matrix<double, Dim, Dim> matrix;
    for (int i = 0; i < Dim; ++i)
    {
      for (int j = 0; j < Dim; ++j)
      {
        matrix(i, j) = block[i][j];
      }
    }
    // An indefinite block is replaced by its norm.
    const Eigen::LLT<Eigen::Matrix<double, Dim, Dim>> factors(matrix);
    const double size = std::max(matrix.norm(), std::numeric_limits<double>::min());
    Eigen::Matrix<double, Dim, Dim> inverse = Eigen::Matrix<double, Dim, Dim>::Identity() / size;
    if (factors.info() == Eigen::Success)
    {
      inverse = factors.solve(Eigen::Matrix<double, Dim, Dim>::Identity());
    }
    for (int i = 0; i < Dim; ++i)
    {
      for (int j = 0; j < Dim; ++j)
      {
        block[i][j] = inverse(i, j);
      }
    }
  }
  // Preconditioned conjugate gradients on the permitted displacements; negative curvature ends
  // them, with the preconditioned gradient as the direction if it occurs at the start.
  std::vector<double> r(this->Gradient.size()), z, d, hd;
  std::transform(this->Gradient.begin(), this->Gradient.end(), r.begin(), std::negate<double>());
  this->Direction.assign(r.size(), 0.0);
  this->precondition(r, z);
  d = z;
  double rz = product(r, z);
  // Squared norms in the inner product of the preconditioner.
  const double enough = limits.relativeResidual * limits.relativeResidual * rz;
  for (int i = 0; i < limits.iterations && rz > enough && rz > 0; ++i)
  {
    this->Energy.apply(d, hd);
    this->Slides.project(hd);
    const double curvature = product(d, hd);
    if (!(curvature > 0))
    {
      if (i == 0)
      {
        this->Direction = d;
      }
      break;
    }
    const double length = rz / curvature;
    addTo(this->Direction, length, d);
    addTo(r, -length, hd);
    this->precondition(r, z);
    const double next = product(r, z);
    const double ratio = next / rz;
    rz = next;
    for (std::size_t k = 0; k < d.size(); ++k)
    {
      d[k] = z[k] + ratio * d[k];
    }
  }
  this->Slope = product(this->Gradient, this->Direction);
}

//------------------------------------------------------------------------------
template <int Dim>
double CurvedNewton<Dim>::search(
  const std::vector<double>& from, double& step, std::vector<double>& x)
{
  constexpr int halvings = 40, halvingsBeforeHolding = 10;
  constexpr double armijo = 1e-4;
  for (int i = 0; i < halvings; ++i, step *= 0.5)
  {
    if (i == halvingsBeforeHolding && this->holdRidges(from, x))
    {
      break;
    }
    x = from;
    addTo(x, step, this->Direction);
    // Sliding points return to their surfaces before the energy is evaluated.
    this->Slides.place(x, this->Threads);
    const double value = this->Energy.value(x);
    if (value <= this->Value + armijo * step * this->Slope)
    {
      return value;
    }
  }
  return std::numeric_limits<double>::infinity();
}

//------------------------------------------------------------------------------
/// A point on a ridge between facets moves down on either side. This function holds the points
/// whose last steps increase the energy although their tangents predicted a decrease.
/// @return whether there are such points
template <int Dim>
bool CurvedNewton<Dim>::holdRidges(const std::vector<double>& from, const std::vector<double>& x)
{
  bool any = false;
  for (std::size_t p = 0; p < this->Inverse.size(); ++p)
  {
    const auto point = static_cast<Index>(p);
    if (!this->Slides.slides(point) || this->Slides.isHeld(point))
    {
      continue;
    }
    double actual = 0;
    for (std::size_t c = 3 * p; c < 3 * p + 3; ++c)
    {
      actual += this->Full[c] * (x[c] - from[c]);
    }
    if (actual > 0)
    {
      this->Slides.hold(point);
      any = true;
    }
  }
  return any;
}

template class CurvedNewton<2>;
template class CurvedNewton<3>;
}
