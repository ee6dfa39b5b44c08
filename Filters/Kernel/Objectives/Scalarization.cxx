// SPDX-License-Identifier: BSD-3-Clause
#include "Scalarization.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
constexpr double infinity = std::numeric_limits<double>::infinity();
/// The largest value over the automatic c: the worst objective dominates, but the others still
/// contribute.
constexpr double sharpness = 10.0;
/// The height of the lexicographic barrier halfway to the bound, relative to the objective being
/// minimized.
constexpr double barrierHeight = 0.01;

void requirePositive(double value, const std::string& what)
{
  if (!(value > 0) || !std::isfinite(value))
  {
    throw Error(what + " must be above 0 and finite; it is " + std::to_string(value) + ".");
  }
}

/// c ln(sum exp(x_i / c)) and its derivatives; terms of -infinity contribute 0.
double logSumExp(const std::vector<double>& x, double c, std::vector<double>& slopes)
{
  const double largest = *std::max_element(x.begin(), x.end());
  slopes.assign(x.size(), 0.0);
  if (!std::isfinite(largest))
  {
    return largest;
  }
  // Exponents relative to the largest are at most 0, so that exp() cannot overflow.
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    slopes[i] = std::exp((x[i] - largest) / c);
    sum += slopes[i];
  }
  for (double& slope : slopes)
  {
    slope /= sum;
  }
  return largest + c * std::log(sum);
}

/// ln(exp(x) - 1) for x > 0.
double logExpMinusOne(double x)
{
  // For large x, exp(x) would overflow; for small x, the difference would cancel.
  return x > 1 ? x + std::log1p(-std::exp(-x)) : std::log(std::expm1(x));
}

/// The product of non-negative factors and, as slopes, the products of all others.
double product(const std::vector<double>& x, std::vector<double>& slopes)
{
  // The wide exponents of long double: a partial product only overflows if the whole product does.
  std::vector<long double> after(x.size() + 1, 1.0L);
  // Products from both ends give the product of all other factors without a division, which a
  // factor of 0 would make impossible.
  for (std::size_t i = x.size(); i-- > 0;)
  {
    after[i] = after[i + 1] * x[i];
  }
  long double before = 1;
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    slopes[i] = static_cast<double>(before * after[i + 1]);
    before *= x[i];
  }
  return static_cast<double>(before);
}
}

//------------------------------------------------------------------------------
Scalarizer::Scalarizer(const ScalarizationOptions& options, const std::vector<double>& weights,
  const std::vector<double>& initial)
  : Options(options)
  , Weights(weights)
  , Utopia(options.utopia)
{
  const std::size_t n = initial.size();
  if (n == 0)
  {
    throw Error("There is no objective to minimize: add one.");
  }
  if (weights.size() != n || (!options.utopia.empty() && options.utopia.size() != n))
  {
    throw Error("Each of the " + std::to_string(n) +
      " objectives needs one weight, and one utopia value if any are given.");
  }
  const int method = static_cast<int>(options.method);
  if (method < 0 || method > static_cast<int>(Scalarization::Rao))
  {
    throw Error("Unknown scalarization number " + std::to_string(method) + ".");
  }
  if (!(options.c >= 0) || !std::isfinite(options.c))
  {
    throw Error("c of the exponential sum must be above 0, or 0 for an automatic choice.");
  }
  if (options.onPatches && n > 1 && method > static_cast<int>(Scalarization::WeightedSum))
  {
    throw Error("This scalarization only combines objectives of the whole mesh: choose exponential "
                "sum, objective product, equal sum or weighted sum for patches.");
  }
  requirePositive(options.exponent, "The exponent of the exponential weighted method");
  if (!(options.tolerance >= 0) || !std::isfinite(options.tolerance))
  {
    throw Error("The tolerance of the lexicographic method must be at least 0 and finite.");
  }
  this->Utopia.resize(n, 0.0);
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i)
  {
    const std::string name = "objective " + std::to_string(i + 1);
    requirePositive(weights[i], "The weight of " + name);
    if (!std::isfinite(this->Utopia[i]))
    {
      throw Error("The utopia value of " + name + " must be finite.");
    }
    if (!std::isfinite(initial[i]))
    {
      throw Error("The value of " + name +
        " is not finite at the start: some elements are inverted or degenerate. Untangle the mesh "
        "first.");
    }
    // Objectives are normalized by their initial distance to the utopia value.
    const double scale = std::abs(initial[i] - this->Utopia[i]);
    this->Scales.push_back(scale > 0 && std::isfinite(scale) ? scale : 1.0);
    largest = std::max(largest, std::abs(initial[i]));
  }
  if (options.method == Scalarization::ExponentialSum)
  {
    const double chosen = largest / sharpness;
    this->C = options.c > 0 ? options.c : (chosen > 0 ? chosen : 1.0);
  }
  else if (options.method == Scalarization::WeightedMinMax)
  {
    // Normalized objectives have a size of about 1, so the weights determine the scale.
    this->C = *std::max_element(weights.begin(), weights.end()) / sharpness;
  }
  this->BarrierScale = barrierHeight * (initial[0] != 0 ? std::abs(initial[0]) : 1.0);
}

//------------------------------------------------------------------------------
double Scalarizer::value(const std::vector<double>& objectives) const
{
  std::vector<double> slopes;
  return this->value(objectives, slopes);
}

//------------------------------------------------------------------------------
double Scalarizer::value(const std::vector<double>& objectives, std::vector<double>& slopes) const
{
  const std::size_t n = this->Weights.size();
  if (objectives.size() != n)
  {
    throw Error("There are " + std::to_string(n) + " objectives, but " +
      std::to_string(objectives.size()) + " values.");
  }
  slopes.assign(n, 0.0);
  if (std::any_of(objectives.begin(), objectives.end(), [](double f) { return !(f < infinity); }))
  {
    return infinity;
  }
  std::vector<double> x = objectives;
  auto normalized = [&](std::size_t i)
  { return (objectives[i] - this->Utopia[i]) / this->Scales[i]; };

  double result = 0;
  switch (this->Options.method)
  {
    case Scalarization::ExponentialSum:
      result = logSumExp(x, this->C, slopes);
      break;
    case Scalarization::ObjectiveProduct:
      result = *std::min_element(x.begin(), x.end()) < 0 ? infinity : product(x, slopes);
      break;
    case Scalarization::EqualSum:
    case Scalarization::WeightedSum:
      for (std::size_t i = 0; i < n; ++i)
      {
        slopes[i] = this->Options.method == Scalarization::EqualSum ? 1.0 : this->Weights[i];
        result += slopes[i] * x[i];
      }
      break;
    case Scalarization::WeightedMinMax:
      // The maximum of w_i f_i is not differentiable: log-sum-exp approximates it from above.
      for (std::size_t i = 0; i < n; ++i)
      {
        x[i] = this->Weights[i] * normalized(i);
      }
      result = logSumExp(x, this->C, slopes);
      for (std::size_t i = 0; i < n; ++i)
      {
        slopes[i] *= this->Weights[i] / this->Scales[i];
      }
      break;
    case Scalarization::ExponentialWeighted:
    {
      const double p = this->Options.exponent;
      for (std::size_t i = 0; i < n; ++i)
      {
        // The value is ln(sum_i (exp(p w_i) - 1) exp(p f_i)) / p: the logarithm does not change the
        // minimizer and prevents overflow.
        x[i] = logExpMinusOne(p * this->Weights[i]) / p + normalized(i);
      }
      result = logSumExp(x, 1 / p, slopes);
      for (std::size_t i = 0; i < n; ++i)
      {
        slopes[i] /= this->Scales[i];
      }
      break;
    }
    case Scalarization::Lexicographic:
      result = x[this->Stage];
      slopes[this->Stage] = 1;
      for (int i = 0; i < this->Stage; ++i)
      {
        // u is 0 at the value reached and 1 at the bound; the barrier is u^2 / (1 - u).
        const double rise = x[i] - this->Reached[i];
        const double room = this->Options.tolerance * std::abs(this->Reached[i]);
        if (rise > 0 && rise >= room)
        {
          result = infinity;
        }
        else if (rise > 0)
        {
          const double u = rise / room;
          result += this->BarrierScale * u * u / (1 - u);
          slopes[i] = this->BarrierScale * u * (2 - u) / ((1 - u) * (1 - u) * room);
        }
      }
      break;
    case Scalarization::Rao:
      // Minus the logarithm of the product of 1 - f_i / 2, where f_i is 0 at the utopia value and 1
      // at the start.
      for (std::size_t i = 0; i < n; ++i)
      {
        const double factor = 1 - normalized(i) / 2;
        result = factor > 0 ? result - std::log(factor) : infinity;
        slopes[i] = 0.5 / (factor * this->Scales[i]);
      }
      break;
  }
  if (!std::isfinite(result))
  {
    slopes.assign(n, 0.0);
  }
  for (double& slope : slopes)
  {
    slope = std::min(slope, std::numeric_limits<double>::max());
  }
  return std::isnan(result) ? infinity : result;
}

//------------------------------------------------------------------------------
bool Scalarizer::next(const std::vector<double>& objectives)
{
  if (this->Options.method != Scalarization::Lexicographic ||
    this->Stage + 1 >= static_cast<int>(this->Weights.size()))
  {
    return false;
  }
  if (objectives.size() != this->Weights.size() || !std::isfinite(objectives[this->Stage]))
  {
    throw Error("The next stage needs a finite value of each objective.");
  }
  this->Reached.push_back(objectives[this->Stage]);
  ++this->Stage;
  const double size = std::abs(objectives[this->Stage]);
  this->BarrierScale = barrierHeight * (size > 0 && std::isfinite(size) ? size : 1.0);
  return true;
}
}
