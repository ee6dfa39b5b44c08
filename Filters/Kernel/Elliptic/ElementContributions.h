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
   * @brief x_e^T A_e x_e of the eigenvector of the largest eigenvalue, over the whole: the cell's
   * share of it; sums to 1 over the cells of all ranks. Empty if the eigenvector was not requested,
   * or not found within the limits.
   */
  std::vector<double> share;
  double bound = 0.0; ///< the largest eigenvalue is at most this: max over points of the cells' sum
  double lowerBound = 0; ///< and at least this: the largest of one element matrix's free part
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
