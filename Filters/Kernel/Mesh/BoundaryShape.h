// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundaryShape.h
 * @brief Where the boundary of a mesh is flat or straight, so that its points can slide along it.
 */
#ifndef tautline_BoundaryShape_h
#define tautline_BoundaryShape_h

#include "Ranks.h"

namespace tautline
{
/// What each point of the boundary may do; made by boundaryShape().
struct BoundaryShape
{
  std::vector<unsigned char> fixed; ///< one flag per point: on the boundary, and cannot slide
  /// Unit normal of the plane a point may slide in, 3 per point; zero elsewhere.
  std::vector<double> planes;
  /// Unit direction of the line a point may slide along, 3 per point; zero elsewhere.
  std::vector<double> lines;
  /// One flag per point: it may slide on the surface as it is, which is smooth there.
  std::vector<unsigned char> surface;
  Index inPlanes = 0, onLines = 0, onSurface = 0; ///< how many points of each kind
};

/**
 * @brief Classifies each boundary point by the boundary facets around it.
 *
 * In a volume mesh a point whose faces all lie in one plane may slide in it; one whose faces lie in
 * two planes, along the line these share. In a mesh of 2D cells a point whose two boundary edges
 * are straight may slide along them. With a feature angle, points that are not in one plane but
 * where the surface is smooth may slide on it; what is sharper is an edge, to slide along if it is
 * straight. All others, and those where three or more cells meet at one facet, are fixed.
 * @param flatAngle facets whose normals (edges whose directions) differ by at most so many degrees
 * count as one plane (line); 0 to 90
 * @param featureAngle the boundary (of volume and planar meshes) is smooth at a point if no facet
 * there differs from their mean by more than half of so many degrees; 0, the default: it is not
 * determined; up to 180
 *
 * Connected points that slide in planes (lines) which differ by more than flatAngle in all are on a
 * curved part, such as a fine circle: those of them where it bends do not slide so.
 *
 * On several ranks, which is collective, without a feature angle; of local points that others own,
 * `fixed` is the owner's, planes and lines may lack.
 */
TAUTLINE_KERNEL_EXPORT BoundaryShape boundaryShape(
  const Mesh& mesh, double flatAngle, double featureAngle = 0, const Ranks& ranks = {});
}
#endif
