// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RoundedResult.h
 * @brief Checks whether a result with points rounded to fewer digits satisfies the guarantees of
 * optimize().
 */
#ifndef tautline_RoundedResult_h
#define tautline_RoundedResult_h

#include "Optimize.h"

namespace tautline
{
/// The mesh of a result with rounded points.
struct RoundedResult
{
  /// elements that are valid at the points of the result, but not at the rounded points
  Index lost = 0;
  bool worseWorst = false; ///< whether the worst element is worse than in the input
  bool largerObjective = false;
  VerifiedElements elements; ///< at the rounded points
  Index inverted = 0;        ///< invalid elements there
  /// The record of the rounded points; without objectives if the input has invalid elements.
  IterationRecord record;

  bool keepsGuarantees() const
  {
    return this->lost == 0 && !this->worseWorst && !this->largerObjective;
  }
};

/**
 * @brief Checks rounded points against the guarantees of optimize(): valid elements stay valid and,
 * if the input has no invalid element, neither the worst element nor the scalarized objective gets
 * worse.
 * @param mesh as passed to optimize(), with these options and ranks
 * @param validity of its cells
 * @param result of optimize(); its elements may be consumed
 * @param rounded the mesh with the rounded points
 * @param ranks ranks that have parts of the mesh: the numbers refer to the whole mesh, the same on
 * all. Collective.
 */
TAUTLINE_KERNEL_EXPORT RoundedResult measureRounded(const Mesh& mesh,
  const std::vector<signed char>& validity, const OptimizeOptions& options, OptimizeResult& result,
  const Mesh& rounded, const Ranks& ranks = {});
}
#endif
