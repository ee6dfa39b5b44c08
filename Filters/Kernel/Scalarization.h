/**
 * @file Scalarization.h
 * @brief Combines n objective values F_i into one F, with dF/dF_i.
 *
 * Section 3.3.1 of Kim's dissertation, and R. T. Marler and J. S. Arora, "Survey of multi-objective
 * optimization methods for engineering", Struct. Multidisc. Optim. 26, 2004. One gradient pass suffices
 * for any number of objectives: grad F = sum dF/dF_i grad F_i.
 */
#ifndef tautline_Scalarization_h
#define tautline_Scalarization_h

#include "Types.h"

#include <vector>

namespace tautline
{
/// The numbers are stable: ParaView state files hold them.
enum class Scalarization : int
{
  ExponentialSum = 0,      ///< c ln(sum exp(F_i / c))                               (3.8)
  ObjectiveProduct = 1,    ///< prod F_i                                             (3.9)
  EqualSum = 2,            ///< sum F_i                                              (3.10)
  WeightedSum = 3,         ///< sum w_i F_i                                          (3.6)
  WeightedMinMax = 4,      ///< smooth max of w_i (F_i - U_i) / S_i
  ExponentialWeighted = 5, ///< sum (exp(p w_i) - 1) exp(p (F_i - U_i) / S_i)
  Lexicographic = 6,       ///< F_1 first; F_2 among what is as good, and so on
  Rao = 7                  ///< prod (1 - (F_i - U_i) / S_i), maximised (normalised Nash product)
};

struct ScalarizationOptions
{
  Scalarization method = Scalarization::ExponentialSum;
  /// c of ExponentialSum; 0 chooses it from the initial values, see Scalarizer.
  double c = 0.0;
  /// p of ExponentialWeighted; above 0.
  double exponent = 1.0;
  /**
   * @brief By how much an objective of higher rank may rise, relative to its value, while those after it are
   * lowered (Lexicographic); at least 0.
   */
  double tolerance = 0.01;
  /// Utopia values U_i, one per objective, or empty for 0.
  std::vector<double> utopia;
};

/**
 * @brief A scalarization made ready for given objectives and their initial values.
 *
 * Scales S_i = |F_i(initial) - U_i|, or 1 where that vanishes. With c = 0 the exponential sum takes
 * c = max |F_i(initial)| / 10: the terms then differ by factors exp(10) at most, and the largest
 * still leads. All functions are stable for F_i / c in the thousands.
 */
class TAUTLINE_KERNEL_EXPORT Scalarizer
{
public:
  /// Throws Error if options or weights are out of range, or the numbers do not match.
  Scalarizer(const ScalarizationOptions& options, const std::vector<double>& weights,
    const std::vector<double>& initial);

  /// F; +infinity where it is not defined (a product with a negative factor).
  double value(const std::vector<double>& objectives) const;
  /// F and dF/dF_i in `slopes`.
  double value(const std::vector<double>& objectives, std::vector<double>& slopes) const;

  /// Lexicographic: the objective that is being lowered; 0 before the first call of next().
  int stage() const { return this->Stage; }
  /**
   * @brief Lexicographic: the current objective is as low as it gets, at `objectives`; go on to the next.
   * @return false if there is none, and always for the other methods.
   */
  bool next(const std::vector<double>& objectives);

  double c() const { return this->C; }

private:
  ScalarizationOptions Options;
  std::vector<double> Weights, Scales, Bounds;
  double C = 1.0;
  int Stage = 0;
};
}
#endif
