// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Untangle.h
 * @brief Makes the elements of a mesh valid by moving its free vertices.
 *
 * First, vertices move one by one around the inverted elements with a regularized determinant (J.
 * M. Escobar et al., "Simultaneous untangling and smoothing of tetrahedral meshes", CMAME 192,
 * 2003), then, for the remaining elements, all vertices move at once: starting from the harmonic
 * map of the mesh, by a foldover-free map energy (V. Garanzha et al., "Foldover-free maps in 50
 * lines of code", ACM TOG 40, 2021) whose regularization is driven to zero; around holes that were
 * rotated by more than a quarter turn, through intermediate meshes with the holes rotated back.
 * These phases consider the corners of the elements; hexahedra and wedges that are still folded
 * between valid corners are then repaired one by one, as far as their neighbors allow. A cell is
 * valid if its Jacobian determinant is positive everywhere (Mesh::classifyCells()). The
 * connectivity never changes. Surfaces in space are untangled in the tangent planes of their
 * elements, see invertedBefore.
 *
 * If points slide (UntangleOptions::model, slidePlanes, and slideLines), all points around the
 * inverted elements move together by the foldover-free map energy; boundary points stay within a
 * band around the geometry they slide on and are projected back onto it at the end. Elements that
 * remain invalid are processed by the phases above, with the boundary held.
 *
 * UntangleMethod::Simultaneous is the method of Escobar et al. as published, for comparison: each
 * free vertex of the mesh, one after the other, is moved to minimize the regularized energy of its
 * elements, whether or not they are inverted, and a step may invert other elements.
 */
#ifndef tautline_Untangle_h
#define tautline_Untangle_h

#include "UntangleOptions.h"
#include "tautline/Mesh/Ranks.h"

namespace tautline
{
/**
 * @brief Untangles a mesh. The result never has more inverted or degenerate elements than the
 * input; fixed points and, with the automatic method, points that need not move are bitwise
 * unchanged. A valid mesh is returned unchanged.
 *
 * On several ranks, the call is collective: the cells within some rings around the invalid elements
 * are gathered, and their connected parts are untangled, each on one rank, with the surrounding
 * points held. If elements remain invalid, wider rings follow, and, except with Effort::Local, the
 * whole mesh on the first rank if it fits into its memory; otherwise, the function throws Error if
 * nothing was repaired before, or sets exceededMemory. UntangleMethod::Simultaneous, which moves
 * all points, uses the whole mesh. The result does not depend on the partition of the mesh or the
 * number of ranks.
 * @param mesh oriented consistently (see Mesh::orientation(), setMirrored()); not changed. On
 * several ranks, the local mesh, see Ranks. For a surface in space, elements that are folded over
 * their neighbors also count as inverted. Regions around the inverted elements are untangled in
 * their tangent planes and moved back onto the surface; sharp edges are kept. Throws Error for such
 * a surface on several ranks.
 */
TAUTLINE_KERNEL_EXPORT UntangleResult untangle(
  const Mesh& mesh, const UntangleOptions& options, const Ranks& ranks = {});
}
#endif
