// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InteractionLayer.h
 * @brief Adds an interaction layer of triangles around a planar mesh, for the volume constraint of
 * nonlocal models.
 */
#ifndef tautline_InteractionLayer_h
#define tautline_InteractionLayer_h

#include "Horizon.h"
#include "tautline/SolversExport.h"

#include <array>
#include <functional>

namespace tautline
{
/// The size of the layer and of its triangles.
struct InteractionLayerOptions
{
  double width = 0.2; ///< minimum width, in mesh units; above 0
  /// Edge of the triangles of the interaction layer; 0: the mean edge of the boundary.
  double elementSize = 0.0;
  int threads = 0; ///< 0: all cores; the result does not depend on it
  /// Called with the fraction done, 0 to 1; the function throws Error if it returns false.
  std::function<bool(double)> progress;
};

/**
 * @brief The mesh with triangles added all around it, and in its holes, up to `width` from it.
 *
 * Points and triangles of the mesh stay unchanged and come first; the interaction layer is
 * conforming: it has the edges of the boundary. Its points lie on a lattice of equilateral
 * triangles, slightly perturbed, and are joined to the boundary points by a constrained Delaunay
 * triangulation. Triangles that already belong to an interaction layer stay in it and are treated
 * as part of the mesh that the new layer surrounds.
 *
 * Throws Error for a width that is not above 0, a mesh that assemblePeridynamics() rejects, a
 * boundary that crosses or touches itself, and an interaction layer of more than ten million
 * triangles.
 */
TAUTLINE_SOLVERS_EXPORT HorizonMesh addInteractionLayer(
  const HorizonMesh& mesh, const InteractionLayerOptions& options);

/// An edge of the boundary of a mesh.
struct BoundaryEdge
{
  Vec2 a = {}, b = {}; ///< the mesh is on the left
  Index first, second; ///< point numbers
};

/// The data of the surrounded mesh on which a layer depends.
struct LayerBoundary
{
  std::vector<BoundaryEdge> edges;
  Vec2 low = { 1e300, 1e300 }, high = { -1e300, -1e300 }; ///< the box around the triangles
};

/// A layer without the mesh.
struct LayerTriangles
{
  std::vector<double> points;                  ///< x y each: boundary points, then new points
  std::vector<Index> boundary;                 ///< the numbers of the boundary points
  std::vector<std::array<Index, 3>> triangles; ///< counterclockwise
};

/**
 * @brief The triangles that addInteractionLayer() adds to a mesh with this boundary: for a mesh on
 * several ranks, none of which has the whole mesh.
 * @param boundary the edges in the order of their triangles: other orders change the last digits
 */
TAUTLINE_SOLVERS_EXPORT LayerTriangles surroundByLayer(
  const LayerBoundary& boundary, const InteractionLayerOptions& options);
}
#endif
