// SPDX-License-Identifier: BSD-3-Clause
#include "SampleFunction.h"

#include "tautline/Quality/TargetMetricList.h"

#include <limits>

namespace tautline
{
namespace
{
constexpr int ByNorm = 0, ByAdjugate = 1, ByDeterminant = 2, ByTrace = 3;

template <int Dim>
std::array<Packet, NumberOfInvariants> asArray(const TargetInvariants<Dim>& t)
{
  return { t.norm2, t.adj2, t.det, t.trace };
}

template <int Dim>
TargetInvariants<Dim> fromArray(const std::array<Packet, NumberOfInvariants>& values)
{
  TargetInvariants<Dim> t;
  t.norm2 = values[ByNorm];
  t.adj2 = values[ByAdjugate];
  t.det = values[ByDeterminant];
  t.trace = values[ByTrace];
  return t;
}

/// The term of an objective as a function of its metric value, with its first two derivatives.
struct Outer
{
  Packet value, first, second;
};

/// @tparam Formula of TargetMetrics.h
template <int Dim, class Formula>
class MetricFunction : public SampleFunction<Dim>
{
public:
  MetricFunction(const Objective& objective, bool barrier, double sign)
    : Template(objective.objectiveTemplate)
    , Arguments(objective.evaluation.parameters)
    , Barrier(barrier)
    , Sign(sign)
    , Power(sign * objective.power)
  {
  }

  bool usesAdjugate() const override { return Formula::usesAdjugate && Dim == 3; }
  bool usesTrace() const override { return Formula::usesTrace; }

  Packet value(const TargetInvariants<Dim>& t) const override
  {
    TargetInvariants<Dim> d = {};
    const Packet q = Formula::template evaluate<Dim>(t, d, this->Arguments);
    return this->checked(t, q, this->outer(q).value);
  }

  void curvatures(const TargetInvariants<Dim>& t, SampleTerm& term) const override
  {
    TargetInvariants<Dim> d = {};
    const Packet q = Formula::template evaluate<Dim>(t, d, this->Arguments);
    const Outer f = this->outer(q);
    term.value = this->checked(t, q, f.value);
    const auto own = asArray<Dim>(d);
    const auto at = asArray<Dim>(t);
    for (Packet& c : term.curvatures)
    {
      c = Packet{};
    }
    // Second derivatives with respect to the invariants are central differences of the analytic
    // first ones.
    for (int i = 0; i < NumberOfInvariants; ++i)
    {
      term.slopes[i] = this->used(i) ? f.first * own[i] : Packet{};
      if (!this->used(i))
      {
        continue;
      }
      // The trace may vanish: its step is relative to |T|.
      constexpr double relative = 1e-5;
      const Packet step = relative * (i == ByTrace ? sqrt(t.norm2) : abs(at[i]));
      const Packet per = select(step > 0.0, 0.5 / step, Packet{});
      std::array<Packet, NumberOfInvariants> slopes[2];
      for (int side : { 0, 1 })
      {
        auto moved = at;
        moved[i] += side == 0 ? -step : step;
        TargetInvariants<Dim> there = {};
        Formula::template evaluate<Dim>(fromArray<Dim>(moved), there, this->Arguments);
        slopes[side] = asArray<Dim>(there);
      }
      for (int j = 0; j <= i; ++j)
      {
        if (this->used(j))
        {
          // Chain rule for a term f(q): f'' q_i q_j + f' q_ij.
          term.curvatures[secondDerivative(i, j)] =
            f.second * own[i] * own[j] + f.first * per * (slopes[1][j] - slopes[0][j]);
        }
      }
    }
    term.bend = term.slopes[ByDeterminant];
  }

private:
  bool used(int invariant) const
  {
    return invariant == ByAdjugate ? this->usesAdjugate()
      : invariant == ByTrace       ? this->usesTrace()
                                   : true;
  }

  Packet checked(const TargetInvariants<Dim>& t, Packet q, Packet f) const
  {
    const Packet infinite = broadcast(std::numeric_limits<double>::infinity());
    f = select(f == f, f, infinite);
    if (this->Barrier)
    {
      f = select(t.det > 0.0, f, infinite);
    }
    if (this->Template == ObjectiveTemplate::SumOfSquaredReciprocals ||
      (this->Template == ObjectiveTemplate::PowerMean && this->Sign < 0))
    {
      f = select(q > 0.0, f, infinite);
    }
    return f;
  }

  Outer outer(Packet q) const
  {
    const Packet inverse = 1.0 / q;
    switch (this->Template)
    {
      case ObjectiveTemplate::SumOfSquares:
        return { q * q, 2.0 * q, broadcast(2.0) };
      case ObjectiveTemplate::SumOfSquaredReciprocals:
      {
        const Packet square = inverse * inverse;
        return { square, -2.0 * square * inverse, 6.0 * square * square };
      }
      case ObjectiveTemplate::SumOfReciprocals:
        return { inverse, -inverse * inverse, 2.0 * inverse * inverse * inverse };
      case ObjectiveTemplate::PowerMean:
      {
        const Packet size = abs(q), raised = pow(size, this->Power);
        const Packet first = this->Power * raised * inverse;
        return { raised, first, (this->Power - 1) * first * inverse };
      }
      default:
        return { this->Sign * q, broadcast(this->Sign), Packet{} };
    }
  }

  ObjectiveTemplate Template;
  Parameters Arguments;
  bool Barrier;
  double Sign, Power;
};
}

//------------------------------------------------------------------------------
template <int Dim>
std::unique_ptr<const SampleFunction<Dim>> sampleFunction(const Objective& objective)
{
  const MetricInfo& info = metricInfo(objective.metric);
  const std::string name = std::string("The metric ") + info.name;
  if (!(Dim == 2 ? info.in2D : info.in3D))
  {
    throw Error(name + " is not defined on elements of dimension " + std::to_string(Dim) + ".");
  }
  Objective resolved = objective;
  if (resolved.objectiveTemplate == ObjectiveTemplate::Default)
  {
    resolved.objectiveTemplate = defaultTemplate(objective.metric);
  }
  if (resolved.objectiveTemplate == ObjectiveTemplate::Maximum)
  {
    throw Error(
      "The template maximum has no sum over the samples of curved elements: choose p-mean.");
  }
  const bool larger = info.direction == Direction::LargerIsBetter;
  auto function = withTargetMetric(objective.metric,
    [&](auto formula) -> std::unique_ptr<const SampleFunction<Dim>>
    {
      using Formula = decltype(formula);
      if constexpr ((Dim == 2 ? Formula::in2D : Formula::in3D) && !Formula::usesSize)
      {
        return std::make_unique<MetricFunction<Dim, Formula>>(
          resolved, info.barrier, larger ? -1.0 : 1.0);
      }
      else
      {
        return nullptr;
      }
    });
  if (!function)
  {
    throw Error(name +
      " cannot be an objective of curved elements: choose a function of the Jacobian matrix, "
      "such as imr, or reduce the cells to their corners (Curve Mesh, order 1).");
  }
  return function;
}

template std::unique_ptr<const SampleFunction<2>> sampleFunction(const Objective&);
template std::unique_ptr<const SampleFunction<3>> sampleFunction(const Objective&);

//------------------------------------------------------------------------------
template <int Dim>
Packet UntanglingFunction<Dim>::value(const TargetInvariants<Dim>& t) const
{
  SampleTerm term;
  this->curvatures(t, term);
  return term.value;
}

//------------------------------------------------------------------------------
template <int Dim>
void UntanglingFunction<Dim>::curvatures(const TargetInvariants<Dim>& t, SampleTerm& term) const
{
  // For det T < 0 the sum would cancel.
  const Packet root = sqrt(t.det * t.det + this->Epsilon2);
  const Packet chi =
    select(t.det < 0.0, 0.5 * this->Epsilon2 / (root - t.det), 0.5 * (t.det + root));
  // chi = (det + sqrt(det^2 + eps^2)) / 2 has the derivative chi / root.
  const Packet slope = select(root > 0.0, chi / root, broadcast(1.0)); // d chi / d det
  const Packet inverse = 1.0 / chi;
  const Packet power = Dim == 2 ? inverse : inverseCbrt(chi) * inverseCbrt(chi);
  constexpr double exponent = 2.0 / Dim;
  // |T|^2 / (n chi^(2/n)) for the shape, and SizeShare times (det^2 + 1) / (2 chi) for the size.
  const Packet shape = t.norm2 * power * (1.0 / Dim);
  const Packet size = SizeShare * 0.5 * (t.det * t.det + 1.0) * inverse;
  term.value = shape + size;
  const Packet byChi = -(exponent * shape + size) * inverse;
  const Packet byDet = SizeShare * t.det * inverse;
  term.slopes[ByNorm] = power * (1.0 / Dim);
  term.slopes[ByDeterminant] = byDet + byChi * slope;
  for (Packet& c : term.curvatures)
  {
    c = Packet{};
  }
  term.curvatures[secondDerivative(ByDeterminant, ByNorm)] =
    -exponent * term.slopes[ByNorm] * inverse * slope;
  term.curvatures[secondDerivative(ByDeterminant, ByDeterminant)] = SizeShare * inverse -
    2.0 * byDet * inverse * slope +
    (exponent * (exponent + 1) * shape + 2.0 * size) * inverse * inverse * slope * slope;
  term.bend = Packet{};
}

template class UntanglingFunction<2>;
template class UntanglingFunction<3>;
}
