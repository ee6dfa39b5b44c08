// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ObjectiveSumState.h
 * @brief The state of an ObjectiveSum.
 * Internal: not installed.
 */
#ifndef tautline_ObjectiveSumState_h
#define tautline_ObjectiveSumState_h

#include "ElementFunction.h"
#include "Objective.h"
#include "OrderlessSums.h"
#include "tautline/Mesh/Ranks.h"
#include "tautline/Quality/ElementSum.h"

namespace tautline
{
/// An objective, its elements, and its function of one element.
struct ObjectiveSumState
{
  Objective objective;
  ElementSum elements;
  ElementFunction function;

  Ranks ranks;

  ObjectiveSumState(const Mesh& mesh, const Objective& objective, int threads, const Ranks& ranks);
  template <bool WithGradient>
  double run(double scale, double* gradient) const;
  /// The same for a mesh on several ranks.
  double runOnRanks(double scale, double* gradient) const;

private:
  void findTerms(double scale, OrderlessSums* gradient, double* terms) const;
};
}
#endif
