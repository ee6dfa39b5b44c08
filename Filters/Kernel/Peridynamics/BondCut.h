// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BondCut.h
 * @brief Determines which triangles interact if the mesh has holes, cracks or a nonconvex boundary.
 * Internal: not installed.
 *
 * A bond, the segment between two interacting points, is cut if it leaves the mesh: material on
 * both sides of a hole does not interact across it. This is decided for whole pairs of triangles by
 * the segment between their centroids, so that the form stays symmetric; if that segment is longer
 * than the horizon, closer points of the triangles are used. Partial visibility between triangles
 * causes an error of the order of the element size. Triangles that share a vertex always interact.
 * With an interaction layer as wide as the reach, nothing is cut, because every bond of the domain
 * is inside the mesh.
 *
 * Source: S. A. Silling, E. Askari, Computers & Structures 83 (2005) 1526-1535 (broken bonds);
 * T. Belytschko, Y. Krongauz, D. Organ, M. Fleming, P. Krysl, Comput. Methods Appl. Mech. Eng. 139
 * (1996) 3-47 (criterion of visibility).
 */
#ifndef tautline_BondCut_h
#define tautline_BondCut_h

#include "PeridynamicsGeometry.h"

#include <memory>

namespace tautline
{
/// The boundary of a mesh, and the mutual visibility of triangles.
class BondCut
{
public:
  /// @param cut false: all triangles are mutually visible
  BondCut(const PlanarTriangles& triangles, double horizon, bool cut);
  /// Removes from `near` the triangles that triangle t does not interact with.
  void keepVisible(Index t, std::vector<std::int32_t>& near) const;

private:
  bool isCut(Index t, Index other, const std::vector<std::int32_t>& edges) const;

  const PlanarTriangles& Triangles;
  double Horizon;
  std::vector<std::array<Vec2, 2>> Edges; ///< of the boundary
  std::vector<Vec2> Low, High;
  std::unique_ptr<BoxGrid> Grid; ///< null: nothing is cut
};
}
#endif
