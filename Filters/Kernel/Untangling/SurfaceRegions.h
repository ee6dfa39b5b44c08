// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceRegions.h
 * @brief Untangles the elements of a surface in space that are not valid.
 * Internal: not installed.
 *
 * An element of a surface has no sign of its own: that of a corner is the one against the normal of
 * the neighborhood. The rings of elements around the invalid ones are projected to the tangent
 * plane there, untangled in it with the points around held, and put back on the surface.
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
 * @brief Untangles as described above; what cannot be repaired so stays as it is.
 * @param mesh a surface in space
 * @param validity of its cells; of the result afterwards
 * @param result with the points of the mesh; gets points, obstacles and numbers
 */
void untangleSurface(const Mesh& mesh, const UntangleOptions& options, UntangleProgress& progress,
  const PlanarUntangling& inPlane, std::vector<signed char>& validity, UntangleResult& result);
}
#endif
