// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ObjectiveSumState.h
 * @brief What an ObjectiveSum holds. Internal: not installed.
 */
#ifndef tautline_ObjectiveSumState_h
#define tautline_ObjectiveSumState_h

#include "ElementFunction.h"
#include "Objective.h"
#include "OrderlessSums.h"
#include "tautline/Quality/ElementSum.h"

namespace tautline
{
/// Throws the Error of an objective without an element of weight. @param defined whether its metric
/// is defined on any element
[[noreturn]] void throwNoElements(const MetricInfo& info, bool defined);

/// An objective, the elements it is summed over, and its function of one element.
struct ObjectiveSumState
{
  Objective objective;
  ElementSum elements;
  ElementFunction function;

  ObjectiveSumState(const Mesh& mesh, const Objective& objective, int threads, bool part);
  template <bool WithGradient>
  double run(double scale, double* gradient) const;
  /**
   * @brief The terms of a sum, one per cell of the view (0 where the metric is not defined,
   * +infinity where an element is at fault), for those who add them up themselves.
   * @param gradient null, or as in ObjectiveSum::addGradient()
   */
  void findTerms(double scale, OrderlessSums* gradient, double* terms) const;
};
}
#endif
