// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RoundedResult.h
 * @brief Whether the points of a result, rounded to fewer digits, keep what optimize() guarantees.
 */
#ifndef tautline_RoundedResult_h
#define tautline_RoundedResult_h

#include "Optimize.h"

namespace tautline
{
/// The mesh of a result with rounded points.
struct RoundedResult
{
  Index lost = 0; ///< elements that are valid at the points of the result, and not at these
  bool worseWorst = false; ///< the worst element is worse than that of the input
  bool largerObjective = false;
  VerifiedElements elements; ///< at the rounded points
  Index inverted = 0;        ///< invalid elements there
  /// That of the rounded points; without objectives where the input has invalid elements.
  IterationRecord record;

  bool keepsGuarantees() const
  {
    return this->lost == 0 && !this->worseWorst && !this->largerObjective;
  }
};

/**
 * @brief Measures rounded points by what optimize() guarantees: valid elements stay valid, and,
 * where the input has no invalid one, neither the worst element nor the scalarized objective gets
 * worse.
 * @param mesh as it was given to optimize(), with these options and ranks
 * @param validity of its cells
 * @param result of optimize(); its elements may be used up
 * @param rounded the mesh with the rounded points
 * @param ranks that have parts of the mesh: the numbers are of the whole mesh, the same on all.
 * Collective.
 */
TAUTLINE_KERNEL_EXPORT RoundedResult measureRounded(const Mesh& mesh,
  const std::vector<signed char>& validity, const OptimizeOptions& options, OptimizeResult& result,
  const Mesh& rounded, const Ranks& ranks = {});
}
#endif
