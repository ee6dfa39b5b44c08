// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundaryConstraints.h
 * @brief What the points of the boundary of a mesh may do while others are optimized or untangled.
 */
#ifndef tautline_BoundaryConstraints_h
#define tautline_BoundaryConstraints_h

#include "SurfaceModel.h"

#include <string>

namespace tautline
{
/// Why settings need the whole mesh in one place.
struct NeedOfWholeMesh
{
  std::string what;   ///< in the plural, "steps that improve the worst element"; "": none
  std::string remedy; ///< "set ... to 0"

  /// Throws Error with both, unless there is no need.
  TAUTLINE_KERNEL_EXPORT void refuse() const;
};

/// What the points of the boundary do. The numbers are stable: ParaView state files hold them.
enum class BoundaryMotion : int
{
  Fixed = 0,
  FlatParts = 1, ///< slide within flat parts and along straight edges
  Free = 2,      ///< move as all other points
  OnSurface = 3  ///< slide on the boundary as it was, or on a geometry, and along its curves
};

struct BoundaryConstraints
{
  /// One flag per point, nonzero = fixed; null: the points of the boundary.
  const unsigned char* fixed = nullptr;
  /**
   * @brief Unit normals n of planes that points may slide in: 3 per point; zero for a point that is
   * free or fixed. Null: none. Only for points that are not fixed.
   */
  const double* slidePlanes = nullptr;
  /// Unit directions of lines that points may slide along; 3 per point, zero elsewhere; or null.
  const double* slideLines = nullptr;
  /**
   * @brief One flag per point: nonzero for boundary points of a volume or planar mesh that slide on
   * the boundary as it was (only those that are not fixed); or null. Points on sharp edges are the
   * caller's to fix.
   */
  const unsigned char* slideSurface = nullptr;
  /**
   * @brief Patches and curves that points slide on, in the coordinates of the mesh, which replace
   * the surface of the input; or null. See makeSurfaceModel().
   */
  const SurfaceModel* model = nullptr;
  /// With a model, per point: the part it slides on, or -1; see partsOfPoints(). Corners are the
  /// caller's to fix, and all points to be on their parts at the start.
  const std::int32_t* parts = nullptr;
  /**
   * @brief The largest distance that steps may leave between a surface whose points slide (of a
   * volume or planar mesh, the boundary) and the surface as it was, at points of either; 0: any.
   * With onGeometry, from the surface to the model. What is farther at the start does not go
   * farther. The same between the interfaces of the model and where they were, not with onGeometry.
   */
  double surfaceTolerance = 0.0;
  /**
   * @brief One flag per point, or null: nonzero for points of a surface, or of the boundary of a
   * volume or planar mesh, fixed ones too, that may leave what they slide on, within
   * surfaceTolerance, near the worst elements, where these do not improve otherwise; see
   * OptimizeOptions::improveWorst. Not with limits or onGeometry.
   */
  const unsigned char* leaving = nullptr;
  /// Whether the model was made of another surface than the mesh.
  bool onGeometry = false;
};
}
#endif
