// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GeometryMatch.h
 * @brief Labels the boundary of a mesh by the features of the geometry it approximates.
 *
 * A geometry has curves (sharp edges, borders) and corners that the mesh may have or not, and the
 * angles between the facets of a coarse mesh tell little of them. So the edges of the mesh that
 * follow a curve of the geometry are found by their place, and both surfaces are divided into
 * patches by the curves that both of them have, and by no others. A point slides on the patches, or
 * on the curves, of the geometry that the facets, or edges, around it are next to.
 */
#ifndef tautline_GeometryMatch_h
#define tautline_GeometryMatch_h

#include "SurfaceModel.h"

namespace tautline
{
struct GeometryMatch
{
  /// Of the facets and edges of the geometry: first a part per patch, then one per curve of
  /// `features`. The part of a border that the geometry does not have is a patch.
  SurfaceModel model;
  Features features;               ///< of the mesh
  std::vector<std::int32_t> parts; ///< per point of the mesh: the part it slides on, or -1
  std::vector<double> points;      ///< of the mesh, those on the geometry placed on it
  int curvesOfGeometry = 0;        ///< without short ones with a free end, which are noise
  int curves = 0;                  ///< of these, that the mesh has
  Index cornersOfGeometry = 0;
  Index corners = 0; ///< of these, that the mesh has
};

/**
 * @brief Finds the patches, curves and corners of the geometry that the points of a mesh are on.
 *
 * An edge of the boundary is on a curve of the geometry if its ends and its middle are next to it
 * and it goes along it; a sharp edge of the mesh may be farther away than another. Curves that the
 * mesh has less than half of are left out. Sharp edges and corners of the mesh that the geometry
 * does not have are smooth. Of a planar mesh the boundary is matched with the curves of the
 * geometry, between corners that both have.
 * @param options of the features of the mesh. Points given as PatchPoint are on no curve inside a
 * surface, those given as CornerPoint are corners. The angle is used for the geometry, too.
 * @param held one flag per point of the mesh: nonzero for points that stay where they are; or null
 * @param geometry triangles and quadrilaterals; for a planar mesh cells in its plane, whose
 * boundary counts, or an outline of lines; in the coordinates of the mesh
 * Throws Error if the geometry has no facets (no lines), or is elsewhere: half of the points are
 * farther from it than half of the diagonal of the mesh.
 */
TAUTLINE_KERNEL_EXPORT GeometryMatch matchGeometry(
  const Mesh& mesh, const FeatureOptions& options, const unsigned char* held, const Mesh& geometry);
}
#endif
