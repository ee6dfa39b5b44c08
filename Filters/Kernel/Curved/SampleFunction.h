// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SampleFunction.h
 * @brief What is summed over the samples of curved elements: functions of the invariants of T.
 * Internal: not installed.
 */
#ifndef tautline_SampleFunction_h
#define tautline_SampleFunction_h

#include "tautline/Objectives/Objective.h"
#include "tautline/Quality/TargetMetrics.h"

#include <memory>

namespace tautline
{
/// |T|^2, |adj T|^2, det T, tr T.
constexpr int NumberOfInvariants = 4;
constexpr int NumberOfSecondDerivatives = NumberOfInvariants * (NumberOfInvariants + 1) / 2;

/// The position of a second derivative; j <= i.
constexpr int secondDerivative(int i, int j)
{
  return i * (i + 1) / 2 + j;
}

/// A function of the invariants, with its derivatives by them.
struct SampleTerm
{
  Packet value = {};
  Packet slopes[NumberOfInvariants] = {};
  Packet curvatures[NumberOfSecondDerivatives] = {};
  /// The derivative by det T that multiplies its second derivative in the Hessian: slopes[2], or 0
  /// where only a convex part of the Hessian is wanted.
  Packet bend = {};
};

/// The same for each of the two dimensions: 2D invariants have adj2 = norm2.
template <int Dim>
class SampleFunction
{
public:
  virtual ~SampleFunction() = default;

  /// The value; infinite where there is none. Lanes without weight may have any invariants.
  virtual Packet value(const TargetInvariants<Dim>& t) const = 0;
  /// The value and all derivatives.
  virtual void curvatures(const TargetInvariants<Dim>& t, SampleTerm& term) const = 0;
  /// Whether it depends on |adj T|^2, and on tr T.
  virtual bool usesAdjugate() const { return false; }
  virtual bool usesTrace() const { return false; }
};

/**
 * @brief A power of a metric, as the template of an objective has it: q^2 of SumOfSquares, 1/q^2,
 * 1/q, +-q, and |q|^p or |q|^-p of PowerMean.
 *
 * Second derivatives are central differences of the first ones. Where the metric is a barrier, or
 * its value has a reciprocal, it is infinite where det T <= 0.
 * @throws Error with the remedy for metrics and templates that have no values at samples
 */
template <int Dim>
std::unique_ptr<const SampleFunction<Dim>> sampleFunction(const Objective& objective);

/**
 * @brief The regularized shape |T|^2 / (n chi^(2/n)) with chi = (det T + sqrt(eps^2 + det T^2)) / 2
 * in place of det T, plus SizeShare (det T^2 + 1) / (2 chi). Without the latter elements shrink to
 * nothing.
 *
 * V. Garanzha et al., "Foldover-free maps in 50 lines of code", ACM TOG 40, 2021. The second
 * derivatives are those of a convex part: det T is taken for linear, and so is chi.
 */
template <int Dim>
class UntanglingFunction : public SampleFunction<Dim>
{
public:
  static constexpr double SizeShare = 0.05;

  void setEpsilon(double epsilon) { this->Epsilon2 = epsilon * epsilon; }
  Packet value(const TargetInvariants<Dim>& t) const override;
  void curvatures(const TargetInvariants<Dim>& t, SampleTerm& term) const override;

private:
  double Epsilon2 = 0;
};
}
#endif
