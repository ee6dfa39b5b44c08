// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OptimizeOnRanks.h
 * @brief optimize() for a mesh on several ranks, with a result that does not depend on how the mesh
 * is cut, nor on how many ranks there are; one rank may do the same.
 */
#ifndef tautline_OptimizeOnRanks_h
#define tautline_OptimizeOnRanks_h

#include "Optimize.h"
#include "tautline/Mesh/DistributedMesh.h"

namespace tautline
{
/**
 * @brief Throws Error for options that need the whole mesh in one place, by name and with the
 * remedy: global optimizers, the templates p-mean and maximum, targets, element weights, points
 * that slide on curved surfaces, rescaling of untangling objectives, improvement of the worst
 * element.
 */
TAUTLINE_KERNEL_EXPORT void requireLocalOptions(const OptimizeOptions& options);

/**
 * @brief Optimizes by local sweeps: sets of vertices without a common cell move one after the
 * other. Collective; every rank gives the same options but for those per point.
 *
 * The optimizer Automatic stays with the sweeps. Elements that are invalid and that no objective
 * repairs are untangled first (untangleOnRanks()); those that stay invalid are left out. Unless
 * allowInversion, the result of the whole mesh is never worse than the input, as that of
 * optimize().
 * @param mesh planar meshes at right angles to an axis, and volume meshes; all cells of one
 * dimension. Its points are where the optimization starts; not changed.
 * @param mirrored the mesh is reversed throughout, see Mesh::setMirrored(); the same on all ranks
 * @param options arrays per point are of local points of `mesh`, and count where a rank owns the
 * point; fixed must not be null (see rankBoundary()). The observer is called on every rank.
 * @return the points are those of the local points; all else is of the whole mesh
 */
TAUTLINE_KERNEL_EXPORT OptimizeResult optimizeOnRanks(
  DistributedMesh& mesh, bool mirrored, const OptimizeOptions& options);

/// One flag per local point: on the boundary of the whole mesh. Collective.
TAUTLINE_KERNEL_EXPORT std::vector<unsigned char> rankBoundary(const DistributedMesh& mesh);

/// Inverted and degenerate cells of the whole mesh with the given local points. Collective.
TAUTLINE_KERNEL_EXPORT Index countInvalidOnRanks(
  const DistributedMesh& mesh, bool mirrored, const std::vector<double>& points, int threads);
}
#endif
