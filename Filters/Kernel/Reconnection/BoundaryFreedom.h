// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file BoundaryFreedom.h
 * @brief The freedom of the points of the boundary and of interfaces.
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
 * walls lie in two planes move along their common line. Points where the boundary is not manifold
 * are fixed.
 * @param tolerance sine of the largest angle between normals of coplanar walls
 */
TAUTLINE_RECONNECTIONKERNEL_EXPORT std::vector<PointFreedom> findFreedoms(
  TetrahedronMesh& mesh, bool slide, double tolerance);

/**
 * @brief Keeps the edges at which labeled walls of different classes meet, or where a single wall
 * ends: points of their straight parts move along them, others are fixed.
 * @param classes by label
 * @param tolerance sine of the largest angle between equal directions
 */
TAUTLINE_RECONNECTIONKERNEL_EXPORT void keepBorders(const TetrahedronMesh& mesh,
  const std::vector<std::int32_t>& classes, double tolerance, std::vector<PointFreedom>& freedoms);

/// Per point: whether its tetrahedra are not all connected through faces at this point.
TAUTLINE_RECONNECTIONKERNEL_EXPORT std::vector<char> nonManifoldPoints(TetrahedronMesh& mesh);

/// Fixes points whose tetrahedra do not form one fan, because an operation on one would not reach
/// all.
void fixNonManifold(TetrahedronMesh& mesh, std::vector<PointFreedom>& freedoms);
}
#endif
