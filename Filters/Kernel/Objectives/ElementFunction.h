// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ElementFunction.h
 * @brief The term of an objective for the metric of one element, with its derivative.
 * Internal: not installed.
 */
#ifndef tautline_ElementFunction_h
#define tautline_ElementFunction_h

#include "Objective.h"
#include "tautline/Quality/ElementSum.h"

#include <limits>

namespace tautline
{
/// The condition under which an objective is infinite on an element.
enum class Fault
{
  None,
  Zero,        ///< q = 0
  NotPositive, ///< q <= 0
  Jacobian     ///< a corner Jacobian is not positive, which q does not reveal
};

/// The lanes with a corner Jacobian that is not positive, as in Mesh::classifyCells().
inline Mask jacobianFaults(const BatchContext& context, const Batch& batch)
{
  const CellTopology& topology = *context.topology;
  const Mesh& mesh = *context.mesh;
  Packet normal[3] = {};
  if (topology.dimension == 2 && mesh.dimension() == Dimension::Planar)
  {
    for (int c = 0; c < 3; ++c)
    {
      normal[c] = broadcast((mesh.mirrored() ? -1.0 : 1.0) * mesh.normal()[c]);
    }
  }
  else if (topology.dimension == 2)
  {
    Packet u[3], v[3];
    const bool triangle = topology.nodes == 3;
    subtract(batch.points[triangle ? 1 : 2], batch.points[0], u);
    subtract(batch.points[triangle ? 2 : 3], batch.points[triangle ? 0 : 1], v);
    cross(u, v, normal);
  }
  Mask good = broadcast(1.0) > 0.0;
  for (int s = 0; s < topology.corners; ++s)
  {
    const auto& nodes = topology.cornerNodes[s];
    Packet edge[3][3], own[3], det, lengths2 = broadcast(1.0);
    for (int k = 0; k < topology.dimension; ++k)
    {
      subtract(batch.points[nodes[k + 1]], batch.points[nodes[0]], edge[k]);
      lengths2 *= dot(edge[k], edge[k]);
    }
    cross(edge[0], edge[1], own);
    det =
      topology.dimension == 3 ? dot(own, edge[2]) : signOf(dot(own, normal)) * sqrt(dot(own, own));
    good &= det > Mesh::degenerateTolerance() * sqrt(lengths2);
  }
  return ~good;
}

/// x^p for x >= 0; whole powers by multiplication.
inline Packet raised(Packet x, double power)
{
  constexpr double largestWhole = 64;
  if (power > largestWhole || power < 0 || power != std::floor(power))
  {
    return pow(x, power);
  }
  Packet result = broadcast(1.0);
  for (int n = static_cast<int>(power); n > 0; n >>= 1)
  {
    result = n & 1 ? Packet(result * x) : result;
    x *= x;
  }
  return result;
}

/// The largest exponents so far and the sum relative to them, lane by lane.
struct ScaledSums
{
  Packet unit = broadcast(-HUGE_VAL);
  Packet sum = {};
};

/// The terms of an objective on the elements of a mesh.
struct ElementFunction
{
  ObjectiveTemplate objectiveTemplate;
  double power;
  double sign; ///< -1 if larger is better
  Fault fault;
  const double* weights; ///< per cell, or null
  double totalWeight;    ///< of the cells on which the metric is defined

  Packet weightsOf(const Batch& batch) const
  {
    Packet w = broadcast(1.0);
    for (int l = 0; this->weights && l < PacketWidth; ++l)
    {
      w[l] = this->weights[batch.cells[l]];
    }
    return w;
  }

  /// The elements at fault, including elements without a value of a user metric, see
  /// replaceNonFinite().
  Mask faults(const BatchContext& context, const Batch& batch) const
  {
    const Mask none = batch.value != batch.value;
    switch (this->fault)
    {
      case Fault::Zero:
        return none | (batch.value == 0.0);
      case Fault::NotPositive:
        return ~(batch.value > 0.0);
      case Fault::Jacobian:
        return none | jacobianFaults(context, batch);
      default:
        return none;
    }
  }

  /// The term of a sum and its derivative with respect to q.
  template <ObjectiveTemplate Template>
  void term(const BatchContext& context, const Batch& batch, Packet& value, Packet& slope) const
  {
    const Packet q = batch.value;
    if constexpr (Template == ObjectiveTemplate::SumOfSquares)
    {
      value = q * q;
      slope = 2.0 * q;
    }
    else if constexpr (Template == ObjectiveTemplate::Sum)
    {
      value = this->sign * q;
      slope = broadcast(this->sign);
    }
    else
    {
      const Packet inverse = 1.0 / q;
      const bool squared = Template == ObjectiveTemplate::SumOfSquaredReciprocals;
      value = squared ? Packet(inverse * inverse) : inverse;
      slope = squared ? Packet(-2.0 * value * inverse) : Packet(-inverse * inverse);
    }
    if (this->fault != Fault::None || context.user)
    {
      const Mask faulty = this->faults(context, batch);
      value = select(faulty, broadcast(HUGE_VAL), value);
      slope = select(faulty, Packet{}, slope);
    }
    if (this->weights)
    {
      const Packet w = this->weightsOf(batch);
      value = select(w > 0.0, w * value, Packet{});
      slope = w * slope;
    }
    slope = finiteOrZero(slope);
  }

  /// The quantity averaged by PowerMean (|q|^s) or used as the exponent by Maximum (k s q), and its
  /// derivative with respect to q.
  template <ObjectiveTemplate Template>
  void exponent(const BatchContext& context, const Batch& batch, Packet& y, Packet& dy) const
  {
    const Packet q = batch.value;
    if constexpr (Template == ObjectiveTemplate::Maximum)
    {
      y = this->power * this->sign * q;
      dy = broadcast(this->power * this->sign);
    }
    else if (this->sign > 0)
    {
      y = abs(q);
      dy = signOf(q);
    }
    else
    {
      y = 1.0 / abs(q);
      dy = -y * y * signOf(q);
    }
    const Mask faulty = this->faults(context, batch);
    y = select(faulty, broadcast(HUGE_VAL), y);
    dy = select(faulty, Packet{}, finiteOrZero(dy));
  }

  /// The factor for a term if the unit of the sum changes.
  template <ObjectiveTemplate Template>
  Packet scaled(Packet y, Packet unit) const
  {
    if constexpr (Template == ObjectiveTemplate::Maximum)
    {
      return select(y > -HUGE_VAL, each(y - unit, [](double x) { return std::exp(x); }), Packet{});
    }
    else
    {
      return select(y > 0.0, raised(y / unit, this->power), Packet{});
    }
  }

  /// Adds the terms of PowerMean and Maximum, in units of the largest so far.
  template <ObjectiveTemplate Template>
  void addScaled(const BatchContext& context, const Batch& batch, ScaledSums& total) const
  {
    Packet y, dy;
    this->exponent<Template>(context, batch, y, dy);
    const Packet w = onlyCells(batch, this->weightsOf(batch));
    y = select(w > 0.0, y, broadcast(-HUGE_VAL));
    if (any(y > total.unit))
    {
      const Packet unit = max(total.unit, y);
      total.sum *=
        select(unit > total.unit, this->scaled<Template>(total.unit, unit), broadcast(1.0));
      total.unit = unit;
    }
    total.sum += select(w > 0.0, w * this->scaled<Template>(y, total.unit), Packet{});
  }

  /// The objective, from the scaled sums of its chunks in their order.
  template <ObjectiveTemplate Template>
  double combine(const std::vector<ScaledSums>& totals) const
  {
    double unit = -HUGE_VAL;
    for (const ScaledSums& t : totals)
    {
      for (int l = 0; l < PacketWidth; ++l)
      {
        unit = t.unit[l] > unit ? t.unit[l] : unit;
      }
    }
    if (unit == HUGE_VAL)
    {
      return unit;
    }
    LaneSums sum;
    for (const ScaledSums& t : totals)
    {
      sum.lanes += t.sum * this->scaled<Template>(t.unit, broadcast(unit));
    }
    if constexpr (Template == ObjectiveTemplate::Maximum)
    {
      return (unit + std::log(sum.sum())) / this->power;
    }
    return unit > 0 ? unit * std::pow(sum.sum() / this->totalWeight, 1 / this->power) : 0.0;
  }

  /// dF/dq of PowerMean or Maximum whose value is F.
  template <ObjectiveTemplate Template>
  Packet slopeOf(const BatchContext& context, const Batch& batch, double F) const
  {
    Packet y, dy;
    this->exponent<Template>(context, batch, y, dy);
    const Packet w = this->weightsOf(batch);
    Packet factor; // dF/dy
    if constexpr (Template == ObjectiveTemplate::Maximum)
    {
      factor = 1.0 / this->power * this->scaled<Template>(y, broadcast(this->power * F));
    }
    else
    {
      factor = select(y > 0.0, raised(y * (1.0 / F), this->power - 1), Packet{}) *
        (1.0 / this->totalWeight);
    }
    return select(w > 0.0, finiteOrZero(w * factor * dy), Packet{});
  }

  /**
   * @brief The share of each element in a PowerMean or Maximum of value F, and its derivative with
   * respect to q: the shares add up to 1 if the mean is F.
   */
  template <ObjectiveTemplate Template>
  void share(
    const BatchContext& context, const Batch& batch, double F, Packet& value, Packet& slope) const
  {
    Packet y, dy;
    this->exponent<Template>(context, batch, y, dy);
    const Packet w = this->weightsOf(batch);
    if constexpr (Template == ObjectiveTemplate::Maximum)
    {
      value = this->scaled<Template>(y, broadcast(this->power * F));
      slope = value * dy;
    }
    else
    {
      const Packet ratio = y * (1.0 / F),
                   lower = raised(ratio, this->power - 1) * (1.0 / this->totalWeight);
      value = lower * ratio;
      slope = this->power * lower * dy * (1.0 / F);
    }
    value = select(w > 0.0, w * value, Packet{});
    slope = select(w > 0.0, finiteOrZero(w * slope), Packet{});
  }

  /// dF/dq of any template; F is only used by PowerMean and Maximum.
  template <ObjectiveTemplate Template>
  Packet slope(const BatchContext& context, const Batch& batch, double F) const
  {
    if constexpr (Template == ObjectiveTemplate::PowerMean ||
      Template == ObjectiveTemplate::Maximum)
    {
      return this->slopeOf<Template>(context, batch, F);
    }
    else
    {
      Packet value, slope;
      this->term<Template>(context, batch, value, slope);
      return slope;
    }
  }
};

/// Calls work with the template as a compile-time constant.
template <class Work>
auto withTemplate(ObjectiveTemplate objectiveTemplate, const Work& work)
{
  using T = ObjectiveTemplate;
  switch (objectiveTemplate)
  {
    case T::SumOfSquares:
      return work(std::integral_constant<T, T::SumOfSquares>());
    case T::SumOfSquaredReciprocals:
      return work(std::integral_constant<T, T::SumOfSquaredReciprocals>());
    case T::SumOfReciprocals:
      return work(std::integral_constant<T, T::SumOfReciprocals>());
    case T::Sum:
      return work(std::integral_constant<T, T::Sum>());
    case T::PowerMean:
      return work(std::integral_constant<T, T::PowerMean>());
    default:
      return work(std::integral_constant<T, T::Maximum>());
  }
}
}
#endif
