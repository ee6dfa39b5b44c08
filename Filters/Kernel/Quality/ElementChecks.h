// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ElementChecks.h
 * @brief The checks of curved elements in solvers and preprocessors, by their own definitions.
 *
 * Each check is a number per cell, from the Jacobian determinant at certain points or from the
 * middle nodes of the edges. They are provided for comparison with these programs; only
 * jacobian_ratio and the metric min_jacobian apply to the whole element.
 *
 * Only stated facts are taken from the named source. If it does not specify the points, or could
 * not be verified, the `note` of the check states what is computed here.
 */
#ifndef tautline_ElementChecks_h
#define tautline_ElementChecks_h

#include "Metrics.h"
#include "tautline/Mesh/CurvedCells.h"

namespace tautline
{
/// A check. The names are stable: they are used for cell arrays.
struct ElementCheckInfo
{
  const char* name;
  const char* label;
  const char* formula;
  const char* source; ///< the source of the definition
  const char* note;   ///< details that the source leaves open, or ""
  double ideal;       ///< for a straight element with all middle nodes in the middle
  Direction direction;
};

/// All checks:
/// jacobian_ratio, jacobian_integration, jacobian_corners, jacobian_nodes, jacobian_high_order,
/// ansys_jacobian_ratio, calculix_jacobian, distortion, midnode_tangent_offset,
/// midnode_normal_offset, midnode_angle, midnode_ratio, midnode_chord.
TAUTLINE_KERNEL_EXPORT const std::vector<ElementCheckInfo>& elementChecks();

/**
 * @brief The numbers of some checks.
 * @param list comma-separated names; surrounding blanks are ignored; "all"; "": none
 * @throws Error, listing the names, for an unknown one
 */
TAUTLINE_KERNEL_EXPORT std::vector<int> parseElementChecks(const std::string& list);

/**
 * @brief One value per cell, including linear cells, whose map has the same form. Values are
 * finite: 0 for cells that have none (not supported, not finite; a distortion without a volume).
 * @param check a position in elementChecks()
 */
TAUTLINE_KERNEL_EXPORT void evaluateElementCheck(
  const Mesh& mesh, const CurvedCellFacts& facts, int check, double* values, int threads = 0);
}
#endif
