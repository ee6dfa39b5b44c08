// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpCoefficients.h
 * @brief The coefficients of anisotropic FEMWARP, section 4.9.1, from a motion.
 * Internal: not installed.
 *
 * The first two functions take one flag per point and 3 displacements per point; only flagged
 * points are read, and only owned points are counted.
 */
#ifndef tautline_WarpCoefficients_h
#define tautline_WarpCoefficients_h

#include "tautline/Mesh/Ranks.h"

#include "tautline/Elliptic/Materials.h"
#include "tautline/Mesh/Mesh.h"

#include <vector>

namespace tautline
{
/**
 * @brief The coefficients (4.19), (4.21): sums of the absolute displacements along the axes, the
 * largest scaled to 1. The identity where nothing moves.
 */
SymmetricTensor displacementSums(
  const std::vector<unsigned char>& prescribed, const double* displacement, const Ranks& ranks);

/**
 * @brief The same along the principal directions of the motion: the eigenvectors of the sum of d
 * d^T. If eigenvalues coincide (within 1e-6 of the largest), the sums are averages over all
 * directions of their space, so that the tensor turns with the motion. The identity where nothing
 * moves.
 */
SymmetricTensor principalDirections(
  const std::vector<unsigned char>& prescribed, const double* displacement, const Ranks& ranks);

/**
 * @brief A tensor per cell, 6 numbers each, from the displacements u of all points, 3 each; on
 * several ranks, per local cell with the mean over the whole mesh:
 *
 *     (1 + |grad u|^2 / mean |grad u|^2) (I / 20 + d d^T / |d|^2)
 *
 * d is the mean displacement of the cell's points; grad u is the linear map that fits their
 * displacements best, which is exact for simplices. Strongly deformed cells become stiff along the
 * motion, which then spreads to the cells around them. The identity where nothing moves.
 */
std::vector<double> localGradients(
  const MeshView& mesh, const double* displacement, const Ranks& ranks);
}
#endif
