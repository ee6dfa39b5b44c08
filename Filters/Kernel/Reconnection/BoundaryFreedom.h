// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundaryFreedom.h
 * @brief What the points of the boundary and of interfaces may do.
 * Internal: not installed.
 */
#ifndef tautline_BoundaryFreedom_h
#define tautline_BoundaryFreedom_h

#include "StarSmoothing.h"
#include "tautline/ReconnectionKernelExport.h"

namespace tautline
{
/**
 * @brief The freedom of each point: free inside; fixed on walls (faces on the boundary or between
 * regions). With `slide`, points whose walls all lie in one plane move in it, and points whose
 * walls lie in two planes along the line these share. Points where the boundary is not manifold are
 * fixed.
 * @param tolerance sine of the largest angle between normals of coplanar walls
 */
TAUTLINE_RECONNECTIONKERNEL_EXPORT std::vector<PointFreedom> findFreedoms(
  TetrahedronMesh& mesh, bool slide, double tolerance);

/// Fixes points whose tetrahedra are not one fan, so that moving one would not take all along.
void fixNonManifold(TetrahedronMesh& mesh, std::vector<PointFreedom>& freedoms);
}
#endif
