// SPDX-License-Identifier: BSD-3-Clause
#include "CombineCorners.h"

namespace tautline
{
Packet combine(
  const BatchContext& context, int samples, const Packet* q, const Mask* negative, Packet* weights)
{
  Mask anyNegative = {};
  for (int s = 0; s < samples; ++s)
  {
    anyNegative |= negative[s];
  }
  // In a cell with inverted corners, only these are used.
  Packet active[MaxNodes], count = {};
  for (int s = 0; s < samples; ++s)
  {
    active[s] = select(~anyNegative | negative[s], broadcast(1.0), Packet{});
    count += active[s];
  }
  Packet result = {};
  switch (context.options->combination)
  {
    case Combination::Mean:
      for (int s = 0; s < samples; ++s)
      {
        weights[s] = active[s] / count;
        result += weights[s] * q[s];
      }
      break;
    case Combination::Worst:
    {
      const double sign = context.largerIsBetter ? -1.0 : 1.0;
      Packet worst = broadcast(-HUGE_VAL);
      for (int s = 0; s < samples; ++s)
      {
        // The first of equal values is the active one.
        const Mask better = (sign * q[s] > worst) & (active[s] > 0.0);
        worst = select(better, sign * q[s], worst);
        for (int e = 0; e < s; ++e)
        {
          weights[e] = select(better, Packet{}, weights[e]);
        }
        weights[s] = select(better, broadcast(1.0), Packet{});
      }
      result = sign * worst;
      break;
    }
    case Combination::PowerMean:
    {
      // A negative power emphasizes the smallest corner, which is the worst if larger values are
      // better.
      const double p = context.largerIsBetter ? -context.options->power : context.options->power;
      // In units of the worst value, so that high powers do not overflow.
      Packet unit = broadcast(context.largerIsBetter ? HUGE_VAL : 0.0), sum = {}, sign = {};
      for (int s = 0; s < samples; ++s)
      {
        const Packet size = context.largerIsBetter ? min(unit, abs(q[s])) : max(unit, abs(q[s]));
        unit = select(active[s] > 0.0, size, unit);
      }
      for (int s = 0; s < samples; ++s)
      {
        const Packet ratio = select(unit > 0.0, abs(q[s]) / unit, Packet{});
        sum += select(active[s] > 0.0, pow(ratio, p), Packet{});
        sign += active[s] * q[s];
      }
      const Packet mean = unit * pow(sum / count, 1.0 / p);
      result = finiteOrZero(signOf(sign) * mean);
      // The derivative of the power mean is (|q_s| / mean)^(p - 1) / count, with the signs of both.
      for (int s = 0; s < samples; ++s)
      {
        weights[s] = finiteOrZero(
          active[s] / count * pow(abs(q[s]) / mean, p - 1.0) * signOf(sign) * signOf(q[s]));
      }
      break;
    }
  }
  // A user formula may be undefined at a corner: then it is undefined for the cell.
  for (int s = 0; s < samples && context.user; ++s)
  {
    result += select(active[s] > 0.0, 0.0 * q[s], Packet{});
  }
  return result;
}
}
