// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpQuality.h
 * @brief Measures how a deformation has changed the shapes of the elements.
 */
#ifndef tautline_WarpQuality_h
#define tautline_WarpQuality_h

#include "tautline/Mesh/Mesh.h"
#include "tautline/SolversExport.h"

namespace tautline
{
/**
 * @brief The TMP shape metric (4.22) of each element at new points relative to the mesh, averaged
 * over its corners; NaN if it is inverted, degenerate, or of an unsupported type. On a surface in
 * space, T is measured in the planes of the cell before and after, and a cell that is folded over
 * its neighbors is inverted.
 * @param mesh valid
 * @param points 3 per point of the mesh
 * @param threads 0: all cores. The result does not depend on it.
 * @return one value per cell, at least 0
 */
TAUTLINE_SOLVERS_EXPORT std::vector<double> shapeSimilarity(
  const Mesh& mesh, const double* points, int threads = 0);

/// Shapes of all elements of a moved mesh together.
struct WarpQuality
{
  Index inverted = 0; ///< elements without a value: inverted, degenerate or not measured
  double worst = 0;   ///< largest value, 0 without any
  double mean = 0;    ///< over the elements that have one
  /// The largest inverse mean ratio of T relative to the mesh, averaged over the corners of an
  /// element; at least 1 if an element is valid, 0 without valid elements.
  double worstRatio = 0;
};

/**
 * @brief The same, aggregated over the elements; bitwise the same for any number of threads.
 * @param points 3 per point of the mesh
 * @param threads 0: all cores
 */
TAUTLINE_SOLVERS_EXPORT WarpQuality qualityOf(
  const Mesh& mesh, const double* points, int threads = 0);

class Ranks;
/// The same for the whole mesh, of which each rank has a part. Internal.
WarpQuality qualityOf(const Mesh& local, const double* points, int threads, const Ranks& ranks);
}
#endif
