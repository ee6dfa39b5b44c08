// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceModel.h
 * @brief The patches and curves that the points of a mesh slide on.
 *
 * Either the original facets and edges, or smooth ones through the same points: triangles become
 * cubic Bezier triangles with the normals of the points (PN triangles; Vlachos et al., "Curved PN
 * triangles", I3D 2001), edges of curves cubic arcs with the tangents of the points. Circular arcs
 * are exact to the sixth order of the angle of an edge. Normals follow N. Max, "Weights for
 * computing vertex normals from facet normals", J. Graphics Tools 4(2), 1999, which are exact on
 * spheres; where it agrees clearly better with the neighbors, and on the border of a patch, they
 * are the normals of a cubic (with few neighbors, a quadric) fitted to two rings of neighbors.
 *
 * Facets that are longer than the radius of curvature stay flat, unless the mesh is coarse: such
 * facets, which CAD programs create along cylinders and fillets, do not show how the surface bends
 * between them.
 */
#ifndef tautline_SurfaceModel_h
#define tautline_SurfaceModel_h

#include "tautline/Mesh/Features.h"

#include <limits>

namespace tautline
{
/// The inner control points of a cubic triangle abc: near a on ab, near b on ab, ... on bc, on ca,
/// and the middle one; for an arc ab, the first two.
using CubicControls = std::array<Vec3, 7>;

/// A patch or a curve.
struct SurfacePart
{
  bool curve = false;
  /// For a patch, triangles (two per quadrilateral); for a curve, edges with the last corner
  /// repeated.
  std::vector<std::array<Vec3, 3>> pieces;
  /// Per piece: its index in controls, or -1 if it is flat (straight); empty if all are.
  std::vector<std::int32_t> controlsOf;
  std::vector<CubicControls> controls;
};

/// A facet of a mesh, given by its points: a cell of a surface, a face of a volume, or an edge of a
/// planar mesh.
struct SurfaceFacet
{
  std::array<Index, MaxFaceNodes> nodes;
  int size;
};

/// First the patches, then the curves, in the order of the features.
struct SurfaceModel
{
  std::vector<SurfacePart> parts;
  int patches = 0;
  std::vector<SurfaceFacet> interfaces; ///< the facets of the mesh between two of its cells
};

/**
 * @brief The model of the features of a mesh, in its coordinates.
 * @param smooth whether it is smooth within patches and along curves, or made of facets
 * @param coarse whether facets may bend by large angles: fitted normals are used less, and flat
 * faces of several facets stay flat where they join curved faces
 * @param farthest the largest distance of smooth pieces from their facets and edges, in the
 * coordinates of the mesh; above 0. If finite, facets that are long compared with the radius of
 * curvature, as CAD programs create along fillets, stay flat
 */
TAUTLINE_KERNEL_EXPORT SurfaceModel makeSurfaceModel(const Mesh& mesh, const Features& features,
  bool smooth, bool coarse = false, double farthest = std::numeric_limits<double>::infinity());

/// Per point: the part it lies on, in the model made from the same features; -1 for corners and
/// interior points.
TAUTLINE_KERNEL_EXPORT std::vector<std::int32_t> partsOfPoints(const Features& features);
}
#endif
