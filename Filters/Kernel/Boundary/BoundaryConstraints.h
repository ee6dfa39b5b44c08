// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundaryConstraints.h
 * @brief Constraints on the boundary points of a mesh that is optimized or untangled.
 */
#ifndef tautline_BoundaryConstraints_h
#define tautline_BoundaryConstraints_h

#include "SurfaceModel.h"

#include <string>

namespace tautline
{
/// Why settings need the whole mesh on one process.
struct NeedOfWholeMesh
{
  std::string what;   ///< in the plural, "steps that improve the worst element"; "": none
  std::string remedy; ///< "set ... to 0"

  /// Throws Error with both texts if the whole mesh is needed.
  TAUTLINE_KERNEL_EXPORT void refuse() const;
};

/// How boundary points move. The numbers are stable: ParaView state files hold them.
enum class BoundaryMotion : int
{
  Fixed = 0,
  FlatParts = 1, ///< slide within flat parts and along straight edges
  Free = 2,      ///< move like all other points
  OnSurface = 3  ///< slide on the original boundary, or on a geometry, and along its curves
};

struct BoundaryConstraints
{
  /// One flag per point, nonzero = fixed; null: the boundary points are fixed.
  const unsigned char* fixed = nullptr;
  /**
   * @brief Unit normals of the planes in which points may slide: 3 per point; zero for a point that
   * is free or fixed. Null: none. Only for points that are not fixed.
   */
  const double* slidePlanes = nullptr;
  /// Unit directions of lines that points may slide along; 3 per point, zero elsewhere; or null.
  const double* slideLines = nullptr;
  /**
   * @brief One flag per point: nonzero for boundary points of a volume or planar mesh that slide on
   * the original boundary (only if they are not fixed); or null. The caller must fix points on
   * sharp edges.
   */
  const unsigned char* slideSurface = nullptr;
  /**
   * @brief Patches and curves that points slide on, in the coordinates of the mesh, which replace
   * the surface of the input; or null. See makeSurfaceModel().
   */
  const SurfaceModel* model = nullptr;
  /// With a model, per point: the part it slides on, or -1; see partsOfPoints(). The caller must
  /// fix corners and place all points on their parts at the start.
  const std::int32_t* parts = nullptr;
  /**
   * @brief The largest allowed distance between a surface whose points slide (for a volume or
   * planar mesh: the boundary) and the original surface, at points of either; 0: any. With
   * onGeometry: from the surface to the model. Points that are farther at the start do not move
   * farther away. The same limit applies to the interfaces of the model and their original
   * positions, except with onGeometry.
   */
  double surfaceTolerance = 0.0;
  /**
   * @brief One flag per point, or null: nonzero for points of a surface, or of the boundary of a
   * volume or planar mesh (including fixed points), that may leave the surface within
   * surfaceTolerance near the worst elements if these do not improve otherwise; see
   * OptimizeOptions::improveWorst. Not with limits or onGeometry.
   */
  const unsigned char* leaving = nullptr;
  /// Whether the model was made of another surface than the mesh.
  bool onGeometry = false;
};
}
#endif
