// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file UntangleCurved.h
 * @brief Untangles meshes with curved elements by moving all their nodes.
 *
 * An element is valid if its Jacobian determinant is certified to be positive everywhere in it, see
 * JacobianCertifier. A regularized shape of the elements around the invalid ones (Garanzha et al.,
 * "Foldover-free maps in 50 lines of code", ACM TOG 40, 2021) is minimized by Newton's method; its
 * samples are quadrature points, the nodes, and the locations of the smallest determinants of
 * elements that are still invalid.
 */
#ifndef tautline_UntangleCurved_h
#define tautline_UntangleCurved_h

#include "CurvedOptions.h"

namespace tautline
{
struct CurvedUntangleResult
{
  std::vector<double> points; ///< 3 x numberOfPoints; the points with the fewest invalid elements
  std::vector<IterationRecord> history;
  StopReason reason = StopReason::AllValid;
  Index invalidBefore = 0, invalidAfter = 0;
  Index newlyInvalid = 0; ///< of invalidAfter: valid in the input
  Index freePoints = 0;
  Index straightened = 0;       ///< elements changed by the last resort
  std::vector<Index> remaining; ///< the cells that are still invalid
};

/**
 * @brief Untangles. First, the region around the invalid elements is moved, then wider rings, then
 * all elements. The result has no more invalid elements than the input, and a valid mesh is
 * returned unchanged.
 * @param mesh with all cells; a volume mesh or a planar mesh
 * @throws Error with the remedy, see CurvedProblem
 */
TAUTLINE_KERNEL_EXPORT CurvedUntangleResult untangleCurved(
  const Mesh& mesh, const CurvedOptions& options);

class CurvedProblem;
/// The same for a problem, whose points are moved.
CurvedUntangleResult untangleCurved(CurvedProblem& problem, const CurvedOptions& options);
}
#endif
