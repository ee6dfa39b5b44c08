// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ElementContributions.h
 * @brief The contribution of each element to the largest eigenvalue and the condition number.
 */
#ifndef tautline_ElementContributions_h
#define tautline_ElementContributions_h

#include "EllipticSystem.h"
#include "tautline/Solvers/ConditionOptions.h"
#include "tautline/SolversExport.h"

namespace tautline
{
/// The contribution of each element to the largest eigenvalue and to the condition number.
struct ElementContributions
{
  std::vector<double> largestEigenvalue; ///< of each cell's stiffness matrix; NaN for cells skipped
  /**
   * @brief The share of each cell in the largest eigenvalue: x_e^T A_e x_e for its eigenvector,
   * relative to the total; sums to 1 over the cells of all ranks. Empty if the eigenvector was not
   * requested, or not found within the limits.
   */
  std::vector<double> share;
  /// upper bound of the largest eigenvalue: the maximum over the points of the sum over their cells
  double bound = 0.0;
  /// lower bound: the largest eigenvalue of the free part of one element matrix
  double lowerBound = 0;
};

/**
 * @brief Computes the contributions of all cells. Collective over the ranks.
 * @param shares whether the eigenvector of the largest eigenvalue is computed for `share`
 * @param threads 0: all cores. The result does not depend on it.
 * @param limits its maximumSeconds and `cancelled` end the search for the eigenvector
 */
TAUTLINE_SOLVERS_EXPORT ElementContributions elementContributions(
  const EllipticSystem& system, bool shares, int threads = 0, const ConditionOptions& limits = {});
}
#endif
