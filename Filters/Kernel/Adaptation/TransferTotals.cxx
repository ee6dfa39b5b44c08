// SPDX-License-Identifier: BSD-3-Clause
#include "TransferTotals.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
/// Differences of the total below this fraction of the magnitude are rounding errors.
constexpr double RoundingTotal = 1e-13;

/// Neumaier's sum.
class CompensatedSum
{
public:
  void add(double term)
  {
    const double next = this->Sum + term;
    // The part that rounding removes is computed exactly if the larger summand comes first.
    this->Lost +=
      std::abs(this->Sum) >= std::abs(term) ? (this->Sum - next) + term : (term - next) + this->Sum;
    this->Sum = next;
  }
  double value() const { return this->Sum + this->Lost; }

private:
  double Sum = 0.0, Lost = 0.0;
};
}

//------------------------------------------------------------------------------
WeightedTotal totalOf(const std::vector<double>& weights, const std::vector<double>& values)
{
  CompensatedSum total, magnitude;
  for (std::size_t i = 0; i < weights.size(); ++i)
  {
    const double term = weights[i] * values[i];
    total.add(term);
    // The rounding error of the product is added as well.
    total.add(std::fma(weights[i], values[i], -term));
    magnitude.add(std::abs(term));
  }
  return { total.value(), magnitude.value() };
}

//------------------------------------------------------------------------------
double BoundedValues::excess(const std::vector<double>& weights) const
{
  double most = 0.0;
  for (std::size_t i = 0; i < this->values.size(); ++i)
  {
    if (weights[i] > 0.0)
    {
      most = std::max({ most, this->values[i] - this->high[i], this->low[i] - this->values[i] });
    }
  }
  return most;
}

//------------------------------------------------------------------------------
void takeTotal(const std::vector<double>& weights, const std::vector<unsigned char>& beside,
  double wanted, double magnitude, BoundedValues& field)
{
  const bool some = std::any_of(beside.begin(), beside.end(), [](unsigned char b) { return b; });
  const auto forEach = [&](const auto& change)
  {
    for (std::size_t i = 0; i < weights.size(); ++i)
    {
      if (weights[i] > 0.0 && (!some || beside[i]))
      {
        change(i);
      }
    }
  };
  constexpr int rounds = 3; // the later rounds correct rounding in the first
  for (int round = 0; round < rounds; ++round)
  {
    const double missing = wanted - totalOf(weights, field.values).total;
    const std::vector<double>& limit = missing > 0.0 ? field.high : field.low;
    const auto inside = [&](std::size_t i)
    { return missing > 0.0 ? field.values[i] < limit[i] : field.values[i] > limit[i]; };
    CompensatedSum room, size;
    forEach(
      [&](std::size_t i)
      {
        room.add(inside(i) ? weights[i] * (limit[i] - field.values[i]) : 0.0);
        size.add(weights[i]);
      });
    if (missing == 0.0 || !(size.value() > 0.0))
    {
      return;
    }
    // All values move by the same fraction of the distance to their limits.
    const double part = room.value() != 0.0 ? std::min(1.0, missing / room.value()) : 0.0;
    const double rest = missing - part * room.value();
    const bool leaves = std::abs(rest) > RoundingTotal * magnitude;
    forEach(
      [&](std::size_t i)
      {
        double& value = field.values[i];
        value += inside(i) ? part * (limit[i] - value) : 0.0;
        // A rest beyond all limits is distributed evenly, at the expense of the bounds.
        value += leaves ? rest / size.value() : 0.0;
      });
  }
}
}
