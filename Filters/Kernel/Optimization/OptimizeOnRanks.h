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
/// Why options need the whole mesh in one place.
struct NeedOfWholeMesh
{
  std::string what;   ///< in the plural, "steps that improve the worst element"; "": none
  std::string remedy; ///< "set ... to 0"
};
TAUTLINE_KERNEL_EXPORT NeedOfWholeMesh needOfWholeMesh(const OptimizeOptions& options);

/**
 * @brief Throws Error for options that need the whole mesh in one place, by name and with the
 * remedy: the templates p-mean and maximum, points that slide on curved surfaces, improvement
 * of the worst element.
 */
TAUTLINE_KERNEL_EXPORT void requireLocalOptions(const OptimizeOptions& options);

/**
 * @brief Optimizes by any optimizer, with the rules of optimize(). Collective; every rank gives the
 * same options but for those per point.
 *
 * Local optimizers move sets of vertices without a common cell one after the other. Global ones
 * take dot products and sums over all ranks, which are rounded once; each rank has the gradient and
 * the rows of the Hessian of its own points. Their preconditioners do not depend on the ranks:
 * diagonal blocks; and for NewtonConjugateGradient on sums of the inverse mean ratio (or of its
 * square) algebraic multigrid, smoothed by block Jacobi on the finest level instead of the
 * Gauss-Seidel of optimize(), so that it takes somewhat more inner iterations. Each rank has the
 * graph of the whole mesh while the aggregates are found, and all coarse levels (see
 * BlockJacobiMultigrid.h). For other objectives NewtonConjugateGradient has diagonal blocks alone, in
 * volumes instead of the Gauss-Seidel of optimize().
 *
 * Automatic goes over from sweeps to NewtonConjugateGradient, to its harmonic start and to
 * LimitedMemoryBFGS where it does in optimize(), judged by the whole mesh; where a matrix does not
 * fit into the memory of one rank, the sweeps go on. Points are the same on any number of ranks to
 * rounding (1e-10 in the tests). Converged objectives are those of optimize() to 1e-6, in another
 * order of the vertices.
 *
 * Elements that are invalid and that no objective repairs are untangled first (untangle());
 * those that stay invalid are left out. Unless allowInversion, the result of the whole mesh is
 * never worse than the input, as that of optimize(); where the worst element would be, it is
 * improved by the rules of optimize(), and where that does not do, points about it go back to the
 * input.
 * @param mesh planar meshes at right angles to an axis, and volume meshes; all cells of one
 * dimension. Its points are where the optimization starts; not changed.
 * @param mirrored the mesh is reversed throughout, see Mesh::setMirrored(); the same on all ranks
 * @param options arrays per point are of local points of `mesh`, and count where a rank owns the
 * point; fixed must not be null (see rankBoundary()). Targets and weights are of local cells, the
 * same on all ranks that have a cell; on some ranks all weights of an objective may be 0. The
 * observer is called on every rank.
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
