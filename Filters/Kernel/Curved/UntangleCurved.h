// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file UntangleCurved.h
 * @brief Makes meshes with curved elements valid by moving all their nodes.
 *
 * An element is valid if its Jacobian determinant is certified to be positive in all of it, see
 * JacobianCertifier. A regularized shape of the elements around the invalid ones (Garanzha et al.,
 * "Foldover-free maps in 50 lines of code", ACM TOG 40, 2021) is minimized by Newton's method; its
 * samples are those of a quadrature, the nodes, and the places of the smallest determinants of
 * elements that are not yet valid.
 */
#ifndef tautline_UntangleCurved_h
#define tautline_UntangleCurved_h

#include "CurvedOptions.h"

namespace tautline
{
struct CurvedUntangleResult
{
  std::vector<double> points; ///< 3 x numberOfPoints; the ones with the fewest invalid elements
  std::vector<IterationRecord> history;
  StopReason reason = StopReason::AllValid;
  Index invalidBefore = 0, invalidAfter = 0;
  Index newlyInvalid = 0; ///< of invalidAfter: valid in the input
  Index freePoints = 0;
  Index straightened = 0;       ///< elements that the last resort has changed
  std::vector<Index> remaining; ///< the cells that are still not valid
};

/**
 * @brief Untangles. Elements are moved around the invalid ones, then in wider rings, then all; the
 * result has no more invalid elements than the input, and a valid mesh is returned as it is.
 * @param mesh with all cells; of volumes, or in a plane
 * @throws Error with the remedy, see CurvedProblem
 */
TAUTLINE_KERNEL_EXPORT CurvedUntangleResult untangleCurved(
  const Mesh& mesh, const CurvedOptions& options);

class CurvedProblem;
/// The same on a problem, whose points are moved.
CurvedUntangleResult untangleCurved(CurvedProblem& problem, const CurvedOptions& options);
}
#endif
