// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PerturbOnRanks.h
 * @brief perturb() for a mesh on several ranks: the same points, bitwise, however it is cut.
 */
#ifndef tautline_PerturbOnRanks_h
#define tautline_PerturbOnRanks_h

#include "Perturb.h"
#include "tautline/Mesh/DistributedMesh.h"

namespace tautline
{
/**
 * @brief Moves vertices as perturb() does, in the same order: a vertex moves once all of lower ids
 * about it have. What is ready on a rank moves there; then the ranks exchange the new points, as
 * often as it takes. Collective; every rank gives the same options but for ids and progress, which
 * each rank calls.
 *
 * @param mesh volume meshes and planar ones at right angles to an axis; all cells of one dimension.
 * Not changed.
 * @param mirrored the mesh is reversed throughout, see Mesh::setMirrored(); the same on all ranks
 * @param fixed one flag per local point; the owner's counts. The boundary of the whole mesh is
 * always fixed.
 * @param options ids: per local point, the same on all ranks for the same point; not null.
 * tangledFraction must be 0.
 * @return the points are those of the local points; all else is of the whole mesh
 *
 * Throws Error, on all ranks, as perturb() does, and for tangledFraction above 0, whose order of
 * vertices depends on what the others have done.
 */
TAUTLINE_KERNEL_EXPORT Perturbation perturbOnRanks(
  DistributedMesh& mesh, bool mirrored, const unsigned char* fixed, const PerturbOptions& options);
}
#endif
