// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OutlineMatch.h
 * @brief How well a polygon fits on another shape's outline, whatever the sizes and directions.
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
/// The minimum energy, and what the search for it took.
struct OutlineMatch
{
  double energy = 0;     ///< per vertex of the source
  bool mirrored = false; ///< the source's mirror image fits better
  Index additions = 0;   ///< of packets, for the bounds
  Index triangles = 0;   ///< packets of triangles whose energy was computed
};

/**
 * @brief The minimum over all placements of the source's vertices on the target's locations, in
 * order, of
 *
 *     sum over triangles   deformation log(alpha / beta)^2 + distortion |log(l_t / l_s)|
 *   + sum over edges       ordering |log(advance / expected)| + descriptor * difference
 *
 * divided by the number of vertices. alpha and beta are the singular values of the map of the
 * triangle, l the sum of its edge lengths in units of the outlines' lengths; the difference is the
 * sum over the numbers of a descriptor, the mean along the edge, in proportion to its length.
 *
 * Exact, by dynamic programming over the triangles of the polygon (dissertation section 5.2.2). The
 * bounds are the same program without the triangles' terms, which gives for each pair of places of
 * an edge the least energy of all placements through them.
 *
 * Both outlines must be prepared with these options. Infinity if no placement keeps the stretch.
 * Throws Error if the outlines have different numbers of locations.
 * @param memory of outlineMemory(), for many matches one after the other; null, the default: of its
 * own, which takes about twice the time of a match
 */
TAUTLINE_SHAPESKERNEL_EXPORT OutlineMatch matchOutlines(const OutlineModel& source,
  const OutlineModel& target, const OutlineOptions& options,
  std::pmr::memory_resource* memory = nullptr);

/// Some megabytes that are used again by the next match. For one thread at a time.
TAUTLINE_SHAPESKERNEL_EXPORT std::unique_ptr<std::pmr::memory_resource> outlineMemory();
}
#endif
