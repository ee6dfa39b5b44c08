// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Optimize.h
 * @brief Moves the free vertices of a mesh so that one or several objectives become smaller.
 *
 * Example: the best shape of every element, boundary fixed.
 *
 *     tautline::Mesh mesh(view);
 *     tautline::OptimizeOptions options; // sum of squared inverse mean ratios
 *     tautline::OptimizeResult result = tautline::optimize(mesh, options);
 *     // result.points has the new coordinates; result.reason is why it stopped.
 */
#ifndef tautline_Optimize_h
#define tautline_Optimize_h

#include "OptimizeOptions.h"

namespace tautline
{
/// What is measured to verify a result. Empty where it was not needed.
struct VerifiedElements
{
  std::vector<signed char> validity; ///< of the result, as Mesh::classifyCells() gives it
  /// The metric of the first objective, as evaluateMetric() gives it: of the mesh given, and of the
  /// result.
  std::vector<double> before, after;
};

struct OptimizeResult
{
  std::vector<double> points; ///< 3 x numberOfPoints; the best found
  std::vector<IterationRecord> history;
  StopReason reason = StopReason::IterationLimit;
  int iterations = 0;
  Index freeVertices = 0;
  Index invertedBefore = 0, invertedAfter = 0;
  /// Elements that were valid in the input and that untangling, which came first, has made invalid.
  Index newlyInvalid = 0;
  /// Largest distance between the output's surface (of a surface mesh, or of points that slide) or
  /// interfaces and the input's, from either to the other, or from the surface to the geometry;
  /// else 0.
  double surfaceError = 0;
  /// Points whose last steps surfaceTolerance refused: on the surface, and others on interfaces.
  Index heldOnSurface = 0, heldOnInterfaces = 0;
  Index leftSurface = 0;  ///< points of OptimizeOptions::leaving that left it
  bool untangled = false; ///< untangle() was run first
  /// Points that went back to their place in the input, because an element there would otherwise be
  /// worse than the worst one of the input.
  Index restored = 0;
  /// The points are those of the input, or those that untangling left, because what was found from
  /// there was worse in one of the three numbers.
  bool unchanged = false;
  VerifiedElements elements; ///< at `points`

  /// Goes back to the points of the start, as what was found is worse: sets all else to what it is
  /// there.
  TAUTLINE_KERNEL_EXPORT void keepStart(std::vector<double> start, Index inverted);
};

/**
 * @brief Optimizes. Elements that are not valid at the start are left out of the objectives that
 * cannot repair them, and join as soon as they are valid; the objective in the history rises by
 * their share then. It also rises where Automatic starts again from the input, by Newton's method,
 * and where the worst element is brought back to the quality it had.
 *
 * Unless allowInversion, the result is never worse than the input in three numbers, which are
 * computed anew from its points: the invalid elements, and, where the input has none, the value of
 * the worst element (see OptimizeOptions::worstMetric and holdWorst) and the scalarized objective.
 * Throws Error on options that cannot be met and names the remedy.
 * @param mesh oriented consistently (see Mesh::orientation(), setMirrored()); not changed.
 * @param validity of its cells, as Mesh::classifyCells() gives it; empty: it is computed
 */
TAUTLINE_KERNEL_EXPORT OptimizeResult optimize(
  const Mesh& mesh, const OptimizeOptions& options, const std::vector<signed char>& validity = {});
}
#endif
