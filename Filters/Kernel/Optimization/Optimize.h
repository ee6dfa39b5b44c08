// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Optimize.h
 * @brief Moves the free vertices of a mesh to minimize one or several objectives.
 *
 * Example: the best shape of every element, boundary fixed.
 *
 *     tautline::Mesh mesh(view);
 *     tautline::OptimizeOptions options; // sum of squared inverse mean ratios
 *     tautline::OptimizeResult result = tautline::optimize(mesh, options);
 *     // result.points has the new coordinates; result.reason is the stop reason.
 */
#ifndef tautline_Optimize_h
#define tautline_Optimize_h

#include "OptimizeOptions.h"
#include "tautline/Mesh/Ranks.h"

namespace tautline
{
/// The measurements used to verify a result, for local cells. Empty if not needed.
struct VerifiedElements
{
  std::vector<signed char> validity; ///< of the result, from Mesh::classifyCells()
  /// The metric of the first objective, from evaluateMetric(): for the input mesh and for the
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
  /// Elements that were valid in the input and became invalid in the preceding untangling.
  Index newlyInvalid = 0;
  /// The largest distance, in either direction, between the surfaces (of a surface mesh or of
  /// sliding points) or interfaces of the output and the input, or from the surface to the
  /// geometry; otherwise 0.
  double surfaceError = 0;
  /// Points whose last steps were rejected because of surfaceTolerance: on the surface, and others
  /// on interfaces.
  Index heldOnSurface = 0, heldOnInterfaces = 0;
  Index leftSurface = 0; ///< points of OptimizeOptions::leaving that left it
  /// Elements of a surface in space without a normal, for example with no area: their points are
  /// fixed, because the orientation of such an element is undetermined.
  Index withoutNormal = 0;
  bool untangled = false; ///< whether untangle() was run first
  /// Points that were moved back to their input position because an element there would otherwise
  /// be worse than the worst one of the input.
  Index restored = 0;
  /// Whether the points are the input points, or the points of the untangled mesh, because the
  /// result from there was worse in one of the three numbers.
  bool unchanged = false;
  /// Whether all points moved together for the worst element, see OptimizeOptions::improveWorst:
  /// the objective may be larger than in the input.
  bool worstFirst = false;
  VerifiedElements elements; ///< at `points`

  /// Restores the points of the start because the result is worse, and sets all other members
  /// accordingly.
  TAUTLINE_KERNEL_EXPORT void keepStart(std::vector<double> start, Index inverted);
};

/**
 * @brief Optimizes a mesh. Elements that are invalid at the start are excluded from the objectives
 * that cannot repair them, and join as soon as they are valid; the objective in the history then
 * increases by their share. It also increases if Automatic starts again from the input with
 * Newton's method, and if the worst element is restored to its initial quality.
 *
 * Unless allowInversion, the result is never worse than the input in three numbers, which are
 * computed again from its points: the number of invalid elements and, if the input has none, the
 * value of the worst element (see OptimizeOptions::worstMetric and holdWorst) and the scalarized
 * objective (not with OptimizeResult::worstFirst). Throws Error, with a remedy, for options that
 * cannot be satisfied.
 *
 * On several ranks, each has a part of the mesh, and the call is collective. The result then
 * depends neither on the decomposition of the mesh nor on the number of ranks, up to rounding
 * (1e-10 in the tests); one rank can use the same order. The rules are the same as on one process,
 * in another order: local optimizers move sets of vertices without a common cell one after the
 * other. Global optimizers use dot products and sums over all ranks, which are rounded once, and
 * preconditioners that do not depend on the ranks: diagonal blocks or, for NewtonConjugateGradient
 * on sums of the inverse mean ratio (or of its square), multigrid smoothed by block Jacobi, which
 * needs somewhat more inner iterations than the Gauss-Seidel of one process. Each rank has the
 * graph of the whole mesh while the aggregates are found, and all coarse levels (see
 * BlockJacobiMultigrid.h). Converged objectives match the serial ones to 1e-6.
 *
 * @param mesh oriented consistently (see Mesh::orientation(), setMirrored()); not changed. On
 * several ranks, with the view of their mesh: a volume mesh, or a planar mesh perpendicular to an
 * axis, all cells of one dimension; otherwise throws Error
 * @param options on several ranks the same on all, without what requireLocalOptions() rejects;
 * arrays per point refer to the local points and are used at owned points, and fixed must not be
 * null (see rankBoundary()); targets and weights refer to the local cells, the same on all ranks
 * that have a cell, and all weights of a rank may be 0. The observer is called on every rank.
 * @param validity of its cells, from Mesh::classifyCells(); empty: it is computed
 * @param ranks by default this process alone
 * @return the points and elements refer to `mesh`; everything else refers to the whole mesh
 */
TAUTLINE_KERNEL_EXPORT OptimizeResult optimize(const Mesh& mesh, const OptimizeOptions& options,
  const std::vector<signed char>& validity = {}, const Ranks& ranks = {});
}
#endif
