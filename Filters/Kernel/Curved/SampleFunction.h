// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SampleFunction.h
 * @brief The functions of the invariants of T that are summed over the samples of curved elements.
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

/// The value and the derivatives of a function of the invariants.
struct SampleTerm
{
  Packet value = {};
  Packet slopes[NumberOfInvariants] = {};
  Packet curvatures[NumberOfSecondDerivatives] = {};
  /// The derivative with respect to det T, which multiplies the second derivative of det T in the
  /// Hessian: slopes[2], or 0 for only the convex part.
  Packet bend = {};
};

/// The interface for both dimensions: 2D invariants have adj2 = norm2.
template <int Dim>
class SampleFunction
{
public:
  virtual ~SampleFunction() = default;

  /// The value; infinite where it is undefined. Lanes without weight may have any invariants.
  virtual Packet value(const TargetInvariants<Dim>& t) const = 0;
  /// The value and all derivatives.
  virtual void curvatures(const TargetInvariants<Dim>& t, SampleTerm& term) const = 0;
  /// Whether it depends on |adj T|^2, and on tr T.
  virtual bool usesAdjugate() const { return false; }
  virtual bool usesTrace() const { return false; }
};

/**
 * @brief The power of a metric defined by the template of an objective: q^2 of SumOfSquares, 1/q^2,
 * 1/q, +-q, and |q|^p or |q|^-p of PowerMean.
 *
 * Second derivatives are central differences of the first derivatives. Barrier metrics and
 * reciprocals are infinite for det T <= 0.
 * @throws Error with the remedy for metrics and templates that are undefined at samples
 */
template <int Dim>
std::unique_ptr<const SampleFunction<Dim>> sampleFunction(const Objective& objective);

/**
 * @brief The regularized shape |T|^2 / (n chi^(2/n)) with chi = (det T + sqrt(eps^2 + det T^2)) / 2
 * in place of det T, plus SizeShare (det T^2 + 1) / (2 chi). Without the second term, elements
 * would shrink to zero size.
 *
 * V. Garanzha et al., "Foldover-free maps in 50 lines of code", ACM TOG 40, 2021. The second
 * derivatives contain only a convex part: det T and chi are treated as linear.
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
