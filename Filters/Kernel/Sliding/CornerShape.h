// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CornerShape.h
 * @brief Shape at the corners of cells, and determinants in between, with their gradients.
 * Internal: not installed.
 */
#ifndef tautline_CornerShape_h
#define tautline_CornerShape_h

#include "tautline/Mesh/Mesh.h"

namespace tautline
{
/// The measure at a corner; larger is better, 1 is ideal.
enum class CornerMeasure
{
  ScaledJacobian, ///< the determinant over the lengths of the edges
  /// For T = A W^-1: d det T^(2/d) / |T|^2, in d dimensions; for simplices, the reciprocal of the
  /// inverse mean ratio. -1 if det T is not positive.
  MeanRatio
};

/// The edges of a corner as the columns of its Jacobian; in a planar mesh, the third is the normal.
struct CornerEdges
{
  std::array<Vec3, 3> edges;
  int dimension;
  double sign; ///< -1 in a mirrored mesh
};

/// A measure and its derivative with respect to each edge.
struct CornerValue
{
  double value;
  std::array<Vec3, 3> gradient;
};

/// The measure at a corner of a cell.
/// @param gradient whether the derivatives are set
CornerValue measureCorner(const CellTopology& t, int corner, const CornerEdges& edges,
  CornerMeasure measure, bool gradient);

/// A position in a cell at which the determinant is measured: the derivatives of the map of the
/// reference cell are sums over the nodes with these weights.
struct DeterminantPlace
{
  std::array<std::array<double, MaxNodes>, 3> weights; ///< for u, v and w; two for a planar cell
};

/**
 * @brief The corners; for hexahedra, also the other points of a 3 x 3 x 3 lattice; for wedges, also
 * the middles of the edges between the triangles.
 */
const std::vector<DeterminantPlace>& determinantPlaces(CellType type);

/// The determinant at a position.
/// @param gradient receives the derivative with respect to each node; or null
double determinantAt(const CellTopology& t, const DeterminantPlace& place, const Vec3* vertices,
  const Vec3& normal, Vec3* gradient);
}
#endif
