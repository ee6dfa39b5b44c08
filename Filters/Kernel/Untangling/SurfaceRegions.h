// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceRegions.h
 * @brief Untangles the invalid elements of a surface in space.
 *
 * An element of a surface has no intrinsic sign: the sign of a corner is determined relative to the
 * normal of the neighborhood. The rings of elements around the invalid ones are projected onto the
 * local tangent plane, untangled in it with the surrounding points held, and moved back onto the
 * surface.
 * Internal: not installed.
 */
#ifndef tautline_SurfaceRegions_h
#define tautline_SurfaceRegions_h

#include "UntangleProgress.h"

#include <functional>

namespace tautline
{
/// Untangles a planar mesh, as untangle() does.
using PlanarUntangling = std::function<UntangleResult(const Mesh&, const UntangleOptions&)>;

/**
 * @brief Untangles as described above; elements that cannot be repaired in this way are unchanged.
 * @param mesh a surface in space
 * @param validity of its cells; updated for the result
 * @param result contains the points of the mesh; receives points, obstacles, and counts
 */
void untangleSurface(const Mesh& mesh, const UntangleOptions& options, UntangleProgress& progress,
  const PlanarUntangling& inPlane, std::vector<signed char>& validity, UntangleResult& result);
}
#endif
