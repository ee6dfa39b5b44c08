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
#include "tautline/Mesh/Ranks.h"

namespace tautline
{
/// What is measured to verify a result, of the local cells. Empty where it was not needed.
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
  Index leftSurface = 0; ///< points of OptimizeOptions::leaving that left it
  /// Elements of a surface in space without a normal, as those with no area: their points stay,
  /// since nothing determines to which side of the surface such an element would open.
  Index withoutNormal = 0;
  bool untangled = false; ///< untangle() was run first
  /// Points that went back to their place in the input, because an element there would otherwise be
  /// worse than the worst one of the input.
  Index restored = 0;
  /// The points are those of the input, or those that untangling left, because what was found from
  /// there was worse in one of the three numbers.
  bool unchanged = false;
  /// All points moved together for the worst element, see OptimizeOptions::improveWorst: the
  /// objective may be larger than in the input.
  bool worstFirst = false;
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
 * the worst element (see OptimizeOptions::worstMetric and holdWorst) and the scalarized objective
 * (not with OptimizeResult::worstFirst).
 * Throws Error on options that cannot be met and names the remedy.
 *
 * On several ranks each has a part of the mesh, and the call is collective. The result then does
 * not depend on how the mesh is cut, nor on how many ranks there are, to rounding (1e-10 in the
 * tests); one rank may do the same. The rules are those of one process, in another order: local
 * optimizers move sets of vertices without a common cell one after the other. Global ones take dot
 * products and sums over all ranks, which are rounded once, and preconditioners that do not depend
 * on the ranks: diagonal blocks; and for NewtonConjugateGradient on sums of the inverse mean ratio
 * (or of its square) multigrid smoothed by block Jacobi, which takes somewhat more inner
 * iterations than the Gauss-Seidel of one process. Each rank has the graph of the whole mesh while
 * the aggregates are found, and all coarse levels (see BlockJacobiMultigrid.h). Converged
 * objectives are those of one process to 1e-6.
 *
 * @param mesh oriented consistently (see Mesh::orientation(), setMirrored()); not changed. On
 * several ranks with the view of their mesh: a volume mesh or a planar one at right angles to an
 * axis, all cells of one dimension, else Error
 * @param options on several ranks the same on all, without what requireLocalOptions() rejects;
 * arrays per point are of the local points and count where a rank owns the point, and fixed must
 * not be null (see rankBoundary()); targets and weights are of the local cells, the same on all
 * ranks that have a cell, and all weights of a rank may be 0. The observer is called on every rank.
 * @param validity of its cells, as Mesh::classifyCells() gives it; empty: it is computed
 * @param ranks by default this process alone
 * @return the points and elements are those of `mesh`; all else is of the whole mesh
 */
TAUTLINE_KERNEL_EXPORT OptimizeResult optimize(const Mesh& mesh, const OptimizeOptions& options,
  const std::vector<signed char>& validity = {}, const Ranks& ranks = {});
}
#endif
