// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundaryShape.h
 * @brief Detects where the boundary of a mesh is flat or straight, so that its points can slide
 * along it.
 */
#ifndef tautline_BoundaryShape_h
#define tautline_BoundaryShape_h

#include "Ranks.h"

namespace tautline
{
/// The allowed motion of each boundary point; computed by boundaryShape().
struct BoundaryShape
{
  /// one flag per point: nonzero on the boundary if it cannot slide
  std::vector<unsigned char> fixed;
  /// The unit normal of the plane in which a point may slide, 3 per point; zero elsewhere.
  std::vector<double> planes;
  /// The unit direction of the line along which a point may slide, 3 per point; zero elsewhere.
  std::vector<double> lines;
  /// One flag per point: nonzero if it may slide on the existing surface, which is smooth there.
  std::vector<unsigned char> surface;
  Index inPlanes = 0, onLines = 0, onSurface = 0; ///< the number of points of each kind
};

/**
 * @brief Classifies each boundary point by the boundary facets around it.
 *
 * In a volume mesh, a point whose faces all lie in one plane may slide in it; a point whose faces
 * lie in two planes may slide along their common line. In a mesh of 2D cells, a point whose two
 * boundary edges are straight may slide along them. With a feature angle, nonplanar points may
 * slide on the surface where it is smooth; sharper points are on an edge and may slide along it if
 * it is straight. All other points, and points where three or more cells meet at one facet, are
 * fixed.
 * @param flatAngle facets whose normals (edges whose directions) differ by at most this many
 * degrees form one plane (line); 0 to 90
 * @param featureAngle the boundary (of volume and planar meshes) is smooth at a point if no facet
 * there differs from their mean by more than half of this many degrees; up to 180; 0, the default:
 * not determined
 *
 * Connected points that slide in planes (lines) that differ by more than flatAngle in total are on
 * a curved part, such as a fine circle: the points where it bends do not slide.
 *
 * On several ranks: collective, and without a feature angle; for local points owned by other ranks,
 * `fixed` is set by the owner, while planes and lines may be missing.
 */
TAUTLINE_KERNEL_EXPORT BoundaryShape boundaryShape(
  const Mesh& mesh, double flatAngle, double featureAngle = 0, const Ranks& ranks = {});
}
#endif
