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
struct OptimizeResult
{
  std::vector<double> points; ///< 3 x numberOfPoints; the best found
  std::vector<IterationRecord> history;
  StopReason reason = StopReason::IterationLimit;
  int iterations = 0;
  Index freeVertices = 0;
  Index invertedBefore = 0, invertedAfter = 0;
  /// Largest distance of the output's surface (of a surface mesh, or of points that slide) from the
  /// input's; else 0.
  double surfaceError = 0;
  bool untangled = false; ///< untangle() was run first
};

/**
 * @brief Optimizes. Elements that are not valid at the start are left out of the objectives that
 * cannot repair them, and join as soon as they are valid; the objective in the history rises by
 * their share then. It also rises where Automatic starts again from the input, by Newton's method.
 * The result is never worse than the input in the scalarized objective, and unless allowInversion
 * no valid element becomes inverted. Throws Error on options that cannot be met and names the
 * remedy.
 * @param mesh oriented consistently (see Mesh::orientation(), setMirrored()); not changed.
 */
TAUTLINE_KERNEL_EXPORT OptimizeResult optimize(const Mesh& mesh, const OptimizeOptions& options);
}
#endif
