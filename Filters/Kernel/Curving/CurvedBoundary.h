// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedBoundary.h
 * @brief The edges and faces of a boundary as pieces of smooth curves and surfaces.
 * Internal: not installed.
 */
#ifndef tautline_CurvedBoundary_h
#define tautline_CurvedBoundary_h

#include "tautline/Boundary/SurfaceModel.h"
#include "tautline/Mesh/Features.h"

#include <vector>

namespace tautline
{
/// A cubic curve by its Bezier points.
using CubicCurve = std::array<Vec3, 4>;

/// A boundary edge as part of its curve.
struct CurvedEdge
{
  Index first, second;
  int part; ///< as in partsOfPoints(): a patch, or the number of patches + a curve
  CubicCurve curve;
};

/// A facet of the boundary: a cubic triangle, or a quadrilateral between its curves.
struct CurvedFace
{
  std::array<Index, MaxFaceNodes> nodes;
  int size, patch;
  std::array<CubicCurve, MaxFaceNodes> edges; ///< from each node to the next
  Vec3 center;                                ///< the middle Bezier point of a triangle
};

struct CurvedBoundary
{
  /// edges of curves first, then edges of facets; each at least once
  std::vector<CurvedEdge> edges;
  std::vector<CurvedFace> faces;
};

/**
 * @brief The edges and facets of the features of a mesh without NaN coordinates, with the smooth
 * curves and surfaces of makeSurfaceModel().
 */
CurvedBoundary curvedBoundary(const Mesh& mesh, const Features& features);

/// The point of a curve at t, 0 to 1.
Vec3 pointOn(const CubicCurve& curve, double t);

/**
 * @brief The point of a face with these weights of its corners; for a quadrilateral, on the Coons
 * patch of its edges (S. A. Coons, "Surfaces for computer-aided design of space forms", 1967).
 */
Vec3 pointOn(const CurvedFace& face, const std::array<double, MaxFaceNodes>& shares);
}
#endif
