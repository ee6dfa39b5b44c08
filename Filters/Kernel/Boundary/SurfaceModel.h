// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SurfaceModel.h
 * @brief The patches and curves that the points of a mesh slide on.
 *
 * Either the facets and edges as they are, or smooth ones through the same points: triangles become
 * cubic Bezier triangles with the normals of the points (PN triangles; Vlachos et al., "Curved PN
 * triangles", I3D 2001), edges of curves cubic arcs with the tangents of the points. Arcs of
 * circles are exact to the sixth order of the angle of an edge. Normals are those of N. Max,
 * "Weights for computing vertex normals from facet normals", J. Graphics Tools 4(2), 1999, which
 * are exact on spheres; where it agrees clearly better with the neighbours, and on the border of a
 * patch, those of a cubic (of few neighbours, a quadric) fitted to two rings of neighbours.
 *
 * Facets that are longer than the radius of curvature stay flat, unless the mesh is coarse: those
 * of CAD programs along cylinders and fillets do not tell how the surface bends between them.
 */
#ifndef tautline_SurfaceModel_h
#define tautline_SurfaceModel_h

#include "tautline/Mesh/Features.h"

#include <limits>

namespace tautline
{
/// The inner control points of a cubic triangle abc: near a on ab, near b on ab, ... on bc, on ca,
/// and the middle one; of an arc ab the first two.
using CubicControls = std::array<Vec3, 7>;

/// A patch or a curve.
struct SurfacePart
{
  bool curve = false;
  /// Of a patch, triangles (quadrilaterals are two); of a curve, edges with the last corner twice.
  std::vector<std::array<Vec3, 3>> pieces;
  /// Per piece: its index in controls, or -1 if it is flat (straight); empty if all are.
  std::vector<std::int32_t> controlsOf;
  std::vector<CubicControls> controls;
};

/// A facet of the surface of a mesh: a cell of a surface, a face of a volume, an edge of a planar
/// mesh; by its points.
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
 * faces of several facets stay flat where they pass into curved ones
 * @param farthest the largest distance of smooth pieces from their facets and edges, in the
 * coordinates of the mesh; above 0. If finite, facets that are long against the radius of
 * curvature, as CAD programs make along fillets, are flat
 */
TAUTLINE_KERNEL_EXPORT SurfaceModel makeSurfaceModel(const Mesh& mesh, const Features& features,
  bool smooth, bool coarse = false, double farthest = std::numeric_limits<double>::infinity());

/// Per point: the part of the model made of the same features that it is on; -1 for corners and
/// points within the mesh.
TAUTLINE_KERNEL_EXPORT std::vector<std::int32_t> partsOfPoints(const Features& features);
}
#endif
