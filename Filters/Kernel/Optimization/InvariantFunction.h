// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InvariantFunction.h
 * @brief A sum over simplices of a user metric that only depends on |T|^2 and det T, as a function
 * of one free vertex.
 * Internal: not installed.
 */
#ifndef tautline_InvariantFunction_h
#define tautline_InvariantFunction_h

#include "PatchFunction.h"
#include "tautline/Quality/UserMetric.h"

namespace tautline
{
/**
 * @class tautline::InvariantFunction
 * @brief Both invariants are known functions of the displacement (see Patch.h), so that the formula
 * is evaluated for two numbers instead of whole cells.
 */
template <int Dim>
class InvariantFunction : public PatchFunction<Dim>
{
public:
  /**
   * @param sum must outlive the function; with a template that sums terms of single elements
   * @param scale T of the metric is T of the simplices times this
   */
  InvariantFunction(const ObjectiveSumState& sum, double scale)
    : Function(sum.function)
    , User(*metricInfo(sum.objective.metric).user)
    , NormFactor(scale * scale)
    , DetFactor(Dim == 3 ? scale * scale * scale : scale * scale)
  {
  }

  double value(const VertexPatch<Dim>& patch, const double* d) const override
  {
    return withTemplate(this->Function.objectiveTemplate,
      [&](auto form)
      {
        return valueOver(
          patch.simplices, d, Values<decltype(form)::value>(*this, patch.simplices, d));
      });
  }

  PatchSum<Dim> sum(const VertexPatch<Dim>& patch, const double* d, bool) const override
  {
    return withTemplate(this->Function.objectiveTemplate,
      [&](auto form)
      {
        return sumOver(
          patch.simplices, d, Derivatives<decltype(form)::value>(*this, patch.simplices, d));
      });
  }

private:
  static constexpr int chunk = 32 / PacketWidth; ///< number of packets evaluated at once

  /// The term of an element and its derivatives with respect to the metric.
  struct Term
  {
    Packet f, slope, curvature;
  };

  template <ObjectiveTemplate Template>
  Term term(Packet q, Packet D) const
  {
    Term t;
    if constexpr (Template == ObjectiveTemplate::SumOfSquares)
    {
      t = { q * q, 2.0 * q, broadcast(2.0) };
    }
    else if constexpr (Template == ObjectiveTemplate::Sum)
    {
      t = { this->Function.sign * q, broadcast(this->Function.sign), Packet{} };
    }
    else
    {
      const Packet over = 1.0 / q, over2 = over * over;
      const bool squared = Template == ObjectiveTemplate::SumOfSquaredReciprocals;
      t = squared ? Term{ over2, -2.0 * over * over2, 6.0 * over2 * over2 }
                  : Term{ over, -over2, 2.0 * over * over2 };
    }
    const Fault fault = this->Function.fault;
    const Mask good = fault == Fault::Jacobian ? D > 0.0
      : fault == Fault::NotPositive            ? q > 0.0
      : fault == Fault::Zero                   ? q != 0.0
                                               : q == q;
    t.f = select(good & (t.f == t.f), t.f, broadcast(std::numeric_limits<double>::infinity()));
    return t;
  }

  /// The energy for valueOver() and sumOver(): the packets of a patch one after another, evaluated
  /// in chunks because each call of the metric costs time.
  class Energy
  {
  public:
    Energy(const InvariantFunction& function, const Patch<Dim>& patch, const double* d)
      : Function(function)
      , Simplices(patch)
      , D(d)
    {
    }

  protected:
    const PatchPacket<Dim>& packet() const { return this->Simplices.packets[this->Next]; }
    /// Sets the invariants of the next packets; returns how many there are.
    int load(Packet* norm2, Packet* det) const
    {
      const int n = std::min(chunk, this->Simplices.count - this->Next);
      for (int i = 0; i < n; ++i)
      {
        invariants(this->Simplices.packets[this->Next + i], this->D, norm2[i], det[i]);
        norm2[i] *= this->Function.NormFactor;
        det[i] *= this->Function.DetFactor;
      }
      return n;
    }
    /// Evaluates the metric at the next packets. @param derivatives null: not requested
    void evaluate(Packet* derivatives) const
    {
      const int n = this->load(this->Invariants[0], this->Invariants[1]);
      this->Function.User.evaluateInvariants(Dim == 3 ? CellType::Tetrahedron : CellType::Triangle,
        PacketWidth * n, PacketWidth * chunk, reinterpret_cast<const double*>(this->Invariants),
        reinterpret_cast<double*>(this->Q), reinterpret_cast<double*>(derivatives));
    }
    /// The term of the next packet, without padding lanes.
    template <ObjectiveTemplate Template>
    Term term(Packet q, Packet det) const
    {
      Term t = this->Function.template term<Template>(q, det);
      t.f = select(this->packet().weight > 0.0, t.f, Packet{});
      return t;
    }

    const InvariantFunction& Function;
    const Patch<Dim>& Simplices;
    const double* D;
    mutable int Next = 0;
    mutable Packet Invariants[2][chunk], Q[chunk];
  };

  template <ObjectiveTemplate Template>
  class Values : public Energy
  {
  public:
    using Energy::Energy;
    Packet value(Packet, Packet) const
    {
      const int i = this->Next % chunk;
      if (i == 0)
      {
        this->evaluate(nullptr);
      }
      const Packet f = this->template term<Template>(this->Q[i], this->Invariants[1][i]).f;
      ++this->Next;
      return f;
    }
  };

  template <ObjectiveTemplate Template>
  class Derivatives : public Energy
  {
  public:
    using Energy::Energy;
    void terms(Packet, Packet, EnergyTerms& e) const
    {
      const int i = this->Next % chunk;
      if (i == 0)
      {
        this->evaluate(this->OfQ[0]);
      }
      const double ofN = this->Function.NormFactor, ofD = this->Function.DetFactor;
      const Packet qN = ofN * this->OfQ[0][i], qD = ofD * this->OfQ[1][i];
      const Packet qNN = (ofN * ofN) * this->OfQ[2][i], qND = (ofN * ofD) * this->OfQ[3][i],
                   qDD = (ofD * ofD) * this->OfQ[4][i];
      const Term t = this->template term<Template>(this->Q[i], this->Invariants[1][i]);
      e.f = t.f;
      e.fN = t.slope * qN;
      e.fD = t.slope * qD;
      e.fNN = t.curvature * qN * qN + t.slope * qNN;
      e.fND = t.curvature * qN * qD + t.slope * qND;
      e.fDD = t.curvature * qD * qD + t.slope * qDD;
      ++this->Next;
    }

  private:
    mutable Packet OfQ[5][chunk];
  };

  const ElementFunction& Function;
  const UserMetric& User;
  const double NormFactor, DetFactor;
};
}
#endif
