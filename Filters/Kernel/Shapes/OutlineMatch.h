// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OutlineMatch.h
 * @brief How well a polygon fits on the outline of another shape, independent of size and
 * direction.
 *
 *     const tautline::OutlineModel a = tautline::prepareOutline(traceSilhouette(first), {});
 *     const tautline::OutlineModel b = tautline::prepareOutline(traceSilhouette(second), {});
 *     const tautline::OutlineMatch match = tautline::matchOutlines(a, b, {});
 *     // match.energy: 0 if they are the same
 */
#ifndef tautline_OutlineMatch_h
#define tautline_OutlineMatch_h

#include "OutlineModel.h"
#include "tautline/ShapesKernelExport.h"

#include <memory>
#include <memory_resource>

namespace tautline
{
/// The minimum energy, and the cost of the search.
struct OutlineMatch
{
  double energy = 0;     ///< per vertex of the source
  bool mirrored = false; ///< whether the mirror image of the source fits better
  Index additions = 0;   ///< of packets, for the bounds
  Index triangles = 0;   ///< packets of triangles whose energy was computed
};

/**
 * @brief The minimum over all placements of the source vertices on the target locations, in order,
 * of
 *
 *     sum over triangles   deformation log(alpha / beta)^2 + distortion |log(l_t / l_s)|
 *   + sum over edges       ordering |log(advance / expected)| + descriptor * difference
 *
 * divided by the number of vertices. alpha and beta are the singular values of the map of the
 * triangle, l the sum of its edge lengths in units of the outline lengths; the difference is the
 * sum over the numbers of a descriptor, averaged along the edge and weighted by its length.
 *
 * Exact, by dynamic programming over the triangles of the polygon (dissertation section 5.2.2). The
 * bounds come from the same program without the triangle terms, which gives, for each pair of
 * locations of an edge, the least energy of all placements through them.
 *
 * Both outlines must be prepared with these options. Infinity if no placement keeps the stretch.
 * Throws Error if the outlines have different numbers of locations.
 * @param memory of outlineMemory(), for many consecutive matches; null, the default: allocated for
 * each match, which takes about twice the time
 */
TAUTLINE_SHAPESKERNEL_EXPORT OutlineMatch matchOutlines(const OutlineModel& source,
  const OutlineModel& target, const OutlineOptions& options,
  std::pmr::memory_resource* memory = nullptr);

/// A few megabytes that the next match reuses. For one thread at a time.
TAUTLINE_SHAPESKERNEL_EXPORT std::unique_ptr<std::pmr::memory_resource> outlineMemory();
}
#endif
