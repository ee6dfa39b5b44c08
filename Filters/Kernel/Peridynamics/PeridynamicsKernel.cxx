// SPDX-License-Identifier: BSD-3-Clause
#include "PeridynamicsKernel.h"

#include <algorithm>

namespace tautline
{
namespace
{
constexpr int Intervals =
  4096; // of the tables of F_m, so that their cubic interpolation is exact up to rounding
// Nodes and weights of the Gauss rule of order 8 on (-1, 1).
constexpr double gaussNodes[4] = { 0.18343464249564980, 0.52553240991632899, 0.79666647741362674,
  0.96028985649753623 };
constexpr double gaussWeights[4] = { 0.36268378337836198, 0.31370664587788729, 0.22238103445337447,
  0.10122853629037626 };
}

//------------------------------------------------------------------------------
RadialKernel::RadialKernel(const KernelFunction& function, double horizon)
  : Function(function)
  , Horizon(horizon)
{
  if (function.shape == KernelShape::Constant)
  {
    this->Function.shape = KernelShape::Power;
    this->Function.exponent = 0.0;
  }
  if (this->Function.shape == KernelShape::Power)
  {
    const double p = this->Function.exponent;
    this->Quarters = std::round(2.0 * p) == 2.0 * p ? static_cast<int>(2.0 * p) : -1;
    for (int m = 0; m < Orders; ++m)
    {
      const double q = m + 2.0 - p;
      this->Full[m] = q == 0.0 ? 0.0 : std::pow(horizon, q) / q;
    }
    return;
  }
  // Other shapes: cumulative integrals by the Gauss rule in each interval.
  const double step = horizon / Intervals;
  for (int m = 0; m < Orders; ++m)
  {
    std::vector<double>& integral = this->Integrals[m];
    integral.assign(Intervals + 1, 0.0);
    for (int i = 0; i < Intervals; ++i)
    {
      double sum = 0.0;
      for (int g = 0; g < 4; ++g)
      {
        for (const double side : { -1.0, 1.0 })
        {
          const double r = (i + 0.5 + 0.5 * side * gaussNodes[g]) * step;
          sum += gaussWeights[g] * std::pow(r, m + 1) * this->value(r);
        }
      }
      integral[i + 1] = integral[i] + 0.5 * step * sum;
    }
    this->Full[m] = integral[Intervals];
  }
}

//------------------------------------------------------------------------------
double RadialKernel::value(double r) const
{
  const double ratio = std::min(r / this->Horizon, 1.0);
  switch (this->Function.shape)
  {
    case KernelShape::Gaussian:
      return std::exp(-ratio * ratio / (this->Function.width * this->Function.width));
    case KernelShape::Conical:
      return 1.0 - ratio;
    case KernelShape::Table:
    {
      const std::vector<double>& table = this->Function.table;
      const double at = ratio * static_cast<double>(table.size() - 1);
      const std::size_t i = std::min(static_cast<std::size_t>(at), table.size() - 2);
      const double t = at - static_cast<double>(i);
      return (1.0 - t) * table[i] + t * table[i + 1];
    }
    default:
      return std::pow(r, -this->Function.exponent);
  }
}

//------------------------------------------------------------------------------
void RadialKernel::power(const double* squares, double* values, Index count) const
{
  if (this->Quarters < 0)
  {
    const double exponent = -0.5 * this->Function.exponent;
    for (Index i = 0; i < count; ++i)
    {
      values[i] = std::pow(squares[i], exponent);
    }
    return;
  }
  // Square roots and products are several times as fast as std::pow.
  const int whole = this->Quarters / 4;
  switch (this->Quarters % 4)
  {
    case 0:
      std::fill(values, values + count, 1.0);
      break;
    case 1:
      for (Index i = 0; i < count; ++i)
      {
        values[i] = std::sqrt(std::sqrt(squares[i]));
      }
      break;
    case 2:
      for (Index i = 0; i < count; ++i)
      {
        values[i] = std::sqrt(squares[i]);
      }
      break;
    default:
      for (Index i = 0; i < count; ++i)
      {
        const double root = std::sqrt(squares[i]);
        values[i] = root * std::sqrt(root);
      }
  }
  for (int turn = 0; turn < whole; ++turn)
  {
    for (Index i = 0; i < count; ++i)
    {
      values[i] *= squares[i];
    }
  }
  for (Index i = 0; i < count; ++i)
  {
    values[i] = 1.0 / values[i];
  }
}

//------------------------------------------------------------------------------
void RadialKernel::evaluate(const double* squares, double* values, Index count) const
{
  if (this->Function.shape == KernelShape::Power)
  {
    this->power(squares, values, count);
  }
  else
  {
    for (Index i = 0; i < count; ++i)
    {
      values[i] = this->value(std::sqrt(squares[i]));
    }
  }
  // The point itself does not interact.
  const double smallest = 1e-20 * this->Horizon * this->Horizon;
  for (Index i = 0; i < count; ++i)
  {
    values[i] = squares[i] > smallest ? values[i] : 0.0;
  }
}

//------------------------------------------------------------------------------
void RadialKernel::ratios(
  const Nodes& squares, int first, int last, Nodes* ratios, bool fromOrigin) const
{
  if (this->Function.shape == KernelShape::Power)
  {
    Nodes k;
    this->power(squares.data(), k.data(), NodeCount);
    for (int m = first; m <= last; ++m)
    {
      const double q = m + 2.0 - this->Function.exponent;
      if (!this->isShifted(m) || fromOrigin)
      {
        for (int l = 0; l < NodeCount; ++l)
        {
          ratios[m][l] = k[l] * (1.0 / q);
        }
        continue;
      }
      // (R^q - horizon^q) / q, stable for q near 0.
      for (int l = 0; l < NodeCount; ++l)
      {
        const double fall = 0.5 * std::log(this->Horizon * this->Horizon / squares[l]);
        ratios[m][l] = -k[l] * (q == 0.0 ? fall : std::expm1(q * fall) / q);
      }
    }
    return;
  }
  // Cubic interpolation of tabulated values and slopes; below the first, k hardly changes.
  const double step = this->Horizon / Intervals;
  for (int l = 0; l < NodeCount; ++l)
  {
    const double r = std::min(std::sqrt(squares[l]), this->Horizon);
    const int i = std::min(static_cast<int>(r / step), Intervals - 1);
    for (int m = first; m <= last; ++m)
    {
      if (i == 0)
      {
        ratios[m][l] = this->value(r * (m + 2.0) / (m + 3.0)) / (m + 2.0);
        continue;
      }
      const double t = r / step - i, low = i * step, high = low + step;
      const double a = this->Integrals[m][i], b = this->Integrals[m][i + 1];
      const double da = step * std::pow(low, m + 1) * this->value(low);
      const double db = step * std::pow(high, m + 1) * this->value(high);
      const double u = 1.0 - t;
      const double f =
        a * u * u * (1.0 + 2.0 * t) + b * t * t * (1.0 + 2.0 * u) + u * t * (u * da - t * db);
      ratios[m][l] = f / std::pow(r, m + 2);
    }
  }
}

//------------------------------------------------------------------------------
double kernelScale(const PeridynamicOptions& options)
{
  const double p = options.kernel.shape == KernelShape::Power ? options.kernel.exponent : 0.0;
  const double more = isElastic(options.model) ? 2.0 : 0.0;
  return std::pow(options.horizon, p - 4.0 - more);
}
}
