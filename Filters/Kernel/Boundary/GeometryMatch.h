// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GeometryMatch.h
 * @brief Matches the features of a mesh with those of the geometry it approximates.
 */
#ifndef tautline_GeometryMatch_h
#define tautline_GeometryMatch_h

#include "SurfaceModel.h"

namespace tautline
{
struct GeometryMatch
{
  SurfaceModel model;              ///< of the geometry, made of its facets
  std::vector<std::int32_t> parts; ///< per point of the mesh: the part it slides on, or -1
  std::vector<double> points;      ///< of the mesh, those on the geometry placed on it
  std::vector<int> partOfPatch, partOfCurve; ///< of the mesh: the part that each slides on
  int curves = 0;                            ///< of the mesh that have a counterpart
  Index corners = 0;                         ///< of the mesh that have a counterpart
};

/**
 * @brief Finds the patch, curve or corner of the geometry for each of the mesh, by distance.
 *
 * The points of a curve that is farther from all curves of the geometry than half of its edges
 * slide on the nearest patch; such a corner is placed on the nearest patch and stays there. Without
 * patches, as for a planar mesh and an outline, the nearest curve takes the place of the patch.
 * @param features of the mesh
 * @param slides one flag per point of the mesh: it is to be on the geometry
 * @param geometry triangles and quadrilaterals, or an outline, in the coordinates of the mesh
 * @param geometryFeatures found with FeatureOptions::asSurface; of an outline its curves
 * Throws Error if the geometry has no facets.
 */
TAUTLINE_KERNEL_EXPORT GeometryMatch matchGeometry(const Mesh& mesh, const Features& features,
  const std::vector<unsigned char>& slides, const Mesh& geometry, const Features& geometryFeatures);
}
#endif
