// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GeometryMatch.h
 * @brief Labels the boundary of a mesh by the features of the geometry it approximates.
 *
 * The mesh may or may not represent the curves (sharp edges, borders) and corners of a geometry,
 * and the angles between the facets of a coarse mesh are a poor indicator. Therefore, the mesh
 * edges that follow a curve of the geometry are found by their position, and both surfaces are
 * divided into patches by the common curves only. A point slides on the patches (curves) of the
 * geometry nearest to the surrounding facets (edges).
 */
#ifndef tautline_GeometryMatch_h
#define tautline_GeometryMatch_h

#include "SurfaceModel.h"

namespace tautline
{
struct GeometryMatch
{
  /// Made from the facets and edges of the geometry: first one part per patch, then one per curve
  /// of `features`. For a border that the geometry lacks, the part is a patch.
  SurfaceModel model;
  Features features;               ///< of the mesh
  std::vector<std::int32_t> parts; ///< per point of the mesh: the part it slides on, or -1
  /// of the mesh; points that belong to the geometry are moved onto it
  std::vector<double> points;
  int curvesOfGeometry = 0; ///< without short ones with a free end, which are noise
  int curves = 0;           ///< of these, matched by the mesh
  Index cornersOfGeometry = 0;
  Index corners = 0; ///< of these, matched by the mesh
};

/**
 * @brief Finds the patches, curves and corners of the geometry on which the mesh points lie.
 *
 * An edge of the boundary is on a curve of the geometry if its ends and its middle are next to it
 * and it goes along it; the allowed distance is larger for sharp edges of the mesh. Curves that the
 * mesh covers by less than half are left out. Sharp edges and corners of the mesh that the geometry
 * does not have are smooth. For a planar mesh, the boundary is matched with the curves of the
 * geometry between common corners.
 * @param options for the features of the mesh. Points given as PatchPoint are not on a curve inside
 * a surface; points given as CornerPoint are corners. The angle is also used for the geometry.
 * @param held one flag per point of the mesh: nonzero for points that must not move; or null
 * @param geometry triangles and quadrilaterals; for a planar mesh, cells in its plane, whose
 * boundary is used, or an outline of lines; in the coordinates of the mesh. Throws Error if the
 * geometry has no facets (no lines), or is at a different location: half of the points are farther
 * from it than half of the diagonal of the mesh.
 */
TAUTLINE_KERNEL_EXPORT GeometryMatch matchGeometry(
  const Mesh& mesh, const FeatureOptions& options, const unsigned char* held, const Mesh& geometry);
}
#endif
