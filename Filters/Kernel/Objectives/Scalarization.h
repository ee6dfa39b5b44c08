// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Scalarization.h
 * @brief Combines n objective values F_i into one F, with dF/dF_i.
 *
 * Section 3.3.1 of Kim's dissertation, and R. T. Marler and J. S. Arora, "Survey of multi-objective
 * optimization methods for engineering", Struct. Multidisc. Optim. 26, 2004. One gradient pass
 * suffices for any number of objectives: grad F = sum dF/dF_i grad F_i.
 */
#ifndef tautline_Scalarization_h
#define tautline_Scalarization_h

#include "tautline/Core/Types.h"

#include <vector>

namespace tautline
{
/**
 * @brief The methods. z_i = (F_i - U_i) / S_i with the utopia values U_i and the scales S_i of
 * Scalarizer.
 *
 * Three of them are minimized in a form that has the same minima as the textbook form, but cannot
 * overflow and has nonvanishing slopes: the logarithm of ExponentialWeighted, the negative
 * logarithm of Rao's product, a smooth maximum in WeightedMinMax. The numbers are stable: ParaView
 * state files hold them.
 */
enum class Scalarization : int
{
  ExponentialSum = 0,   ///< c ln(sum exp(F_i / c))                               (3.8)
  ObjectiveProduct = 1, ///< prod F_i                                             (3.9)
  EqualSum = 2,         ///< sum F_i                                              (3.10)
  WeightedSum = 3,      ///< sum w_i F_i                                          (3.6)
  /// c ln(sum exp(w_i z_i / c)): exceeds max w_i z_i by c ln(n) at most; c = max w_i / 10.
  WeightedMinMax = 4,
  ExponentialWeighted = 5, ///< (1/p) ln(sum (exp(p w_i) - 1) exp(p z_i))
  /**
   * F_1 first; then F_2 while F_1 stays below (1 + tolerance) times the value reached, and so on. A
   * smooth barrier, zero up to the value reached and infinite at the bound, keeps it there.
   */
  Lexicographic = 6,
  /**
   * -sum ln(1 - z_i / 2): maximizes the product of the distances from twice the initial values
   * (Nash, Rao). (With the initial values themselves as the worst allowed values, every factor and
   * slope would start at 0.)
   */
  Rao = 7
};

struct ScalarizationOptions
{
  Scalarization method = Scalarization::ExponentialSum;
  /// c of ExponentialSum, in the unit of the objectives; 0 chooses it, see Scalarizer.
  double c = 0.0;
  /// p of ExponentialWeighted; above 0. Larger values emphasize the worst objective.
  double exponent = 1.0;
  /**
   * @brief The relative amount by which an objective of higher rank may increase while later ones
   * are reduced (Lexicographic); at least 0. With 0, it may not increase at all.
   */
  double tolerance = 0.01;
  /// Utopia values U_i, one per objective, or empty for 0.
  std::vector<double> utopia;
  /**
   * @brief Local optimizers combine the sums F_i over the elements around the moving vertex, as in
   * Mesquite by default, instead of the sums over the whole mesh, which a step may then increase.
   * Supported by the methods (3.8) to (3.10) and the weighted sum.
   */
  bool onPatches = false;
};

/**
 * @brief A scalarization prepared for given objectives and their initial values.
 *
 * Scales S_i = |F_i(initial) - U_i|, or 1 if that vanishes. With c = 0, the exponential sum uses c
 * = max |F_i(initial)| / 10 (1 if all vanish): the terms then differ by factors of at most exp(20),
 * and the largest still dominates. All functions are stable for F_i / c in the thousands and never
 * NaN.
 */
class TAUTLINE_KERNEL_EXPORT Scalarizer
{
public:
  /**
   * @brief Throws Error if options or weights are out of range, the numbers do not match, or an
   * initial value is not finite.
   * @param weights w_i > 0, one per objective
   */
  Scalarizer(const ScalarizationOptions& options, const std::vector<double>& weights,
    const std::vector<double>& initial);

  /**
   * @brief F; +infinity if an objective is infinite or NaN, or if F is undefined (a product with a
   * negative factor, Rao beyond the worst allowed value, Lexicographic beyond a bound) or not
   * representable.
   */
  double value(const std::vector<double>& objectives) const;
  /// F and dF/dF_i >= 0 in `slopes`, which are all 0 if F is not finite.
  double value(const std::vector<double>& objectives, std::vector<double>& slopes) const;

  /// Lexicographic: the objective that is being reduced; 0 before the first call of next().
  int stage() const { return this->Stage; }
  /**
   * @brief Lexicographic: call when the current objective has been minimized, at `objectives`, to
   * continue with the next.
   * @return false if there is no next objective, and always for the other methods.
   */
  bool next(const std::vector<double>& objectives);

  /// c of ExponentialSum and WeightedMinMax, given or chosen; 1 for the others.
  double c() const { return this->C; }
  /// Whether it combines sums over patches, see ScalarizationOptions::onPatches.
  bool onPatches() const { return this->Options.onPatches; }

private:
  ScalarizationOptions Options;
  std::vector<double> Weights, Scales, Utopia;
  std::vector<double> Reached; ///< Lexicographic: F_i at the end of stage i
  double BarrierScale = 1.0;   ///< Lexicographic: in units of the current objective
  double C = 1.0;
  int Stage = 0;
};
}
#endif
