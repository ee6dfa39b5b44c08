// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Untangle.h
 * @brief Makes the elements of a mesh valid by moving its free vertices.
 *
 * First vertex by vertex around the inverted elements with a regularized determinant (J. M. Escobar
 * et al., "Simultaneous untangling and smoothing of tetrahedral meshes", CMAME 192, 2003), then,
 * for what is left, all vertices at once: from the harmonic map of the mesh, by a foldover-free map
 * energy (V. Garanzha et al., "Foldover-free maps in 50 lines of code", ACM TOG 40, 2021) whose
 * regularization is driven to zero; around holes that were turned by more than a quarter, by way of
 * meshes with the holes turned back. These phases see the corners of the elements; hexahedra and
 * wedges that are then folded between valid corners are repaired one by one, as far as their
 * neighbours allow. A cell counts as valid when its Jacobian determinant is positive everywhere
 * (Mesh::classifyCells()). The connectivity never changes. Surfaces in
 * space are untangled in the tangent planes of their elements, see invertedBefore.
 *
 * Where points slide (UntangleOptions::model, slidePlanes and slideLines), all points about the
 * inverted elements move together by the foldover-free map energy, those of the boundary within a
 * band about what they slide on, which they are put back on at the end. What stays invalid is left
 * to the phases above, with the boundary held.
 *
 * UntangleMethod::Simultaneous is the method of Escobar et al. as published, for comparison: each
 * free vertex of the mesh, one after the other, minimizes the regularized energy of its elements,
 * whether they are inverted or not, and a step may invert others.
 */
#ifndef tautline_Untangle_h
#define tautline_Untangle_h

#include "UntangleOptions.h"
#include "tautline/Mesh/Ranks.h"

namespace tautline
{
/**
 * @brief Untangles. The result never has more inverted or degenerate elements than the input; fixed
 * points and, by the automatic method, points that need not move keep their bits. A valid mesh is
 * returned as it is.
 *
 * On several ranks, which is collective, the cells within some rings of the invalid elements are
 * gathered and their connected parts are untangled, each on one rank, with the points around held.
 * Where elements stay invalid, wider rings follow, and, except with Effort::Local, the whole mesh
 * on the first rank, if it fits into the memory there: Error if it does not and nothing was
 * repaired before, else exceededMemory. UntangleMethod::Simultaneous, which moves all points, takes
 * the whole mesh. The result depends neither on how the mesh is cut nor on how many ranks there
 * are.
 * @param mesh oriented consistently (see Mesh::orientation(), setMirrored()); not changed. On
 * several ranks the local mesh, see Ranks.
 * Of a surface in space, also elements that are folded over their neighbors count as inverted.
 * Regions around the inverted elements are untangled in their tangent planes and put back on the
 * surface; sharp edges are kept. Throws Error for such a surface on several ranks.
 */
TAUTLINE_KERNEL_EXPORT UntangleResult untangle(
  const Mesh& mesh, const UntangleOptions& options, const Ranks& ranks = {});
}
#endif
