// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ElementChecks.h
 * @brief How solvers and preprocessors check curved elements: their own definitions.
 *
 * Each check is a number per cell, from the Jacobian determinant at certain places or from the
 * middle nodes of the edges. They are offered to compare with these programs; only jacobian_ratio
 * and the metric min_jacobian hold for the whole element.
 *
 * Only facts that the named source states are taken from it. Where it leaves the places open, or
 * could not be verified, the entry `note` of the check states what is computed here.
 */
#ifndef tautline_ElementChecks_h
#define tautline_ElementChecks_h

#include "Metrics.h"
#include "tautline/Mesh/CurvedCells.h"

namespace tautline
{
/// A check. The names are stable: they are those of cell arrays.
struct ElementCheckInfo
{
  const char* name;
  const char* label;
  const char* formula;
  const char* source; ///< where the definition is from
  const char* note;   ///< what the source leaves open, or ""
  double ideal;       ///< of a straight element with all middle nodes in the middle
  Direction direction;
};

/// All checks:
/// jacobian_ratio, jacobian_integration, jacobian_corners, jacobian_nodes, jacobian_high_order,
/// ansys_jacobian_ratio, calculix_jacobian, distortion, midnode_tangent_offset,
/// midnode_normal_offset, midnode_angle, midnode_ratio, midnode_chord.
TAUTLINE_KERNEL_EXPORT const std::vector<ElementCheckInfo>& elementChecks();

/**
 * @brief The numbers of some checks.
 * @param list names, separated by commas, blanks around them are ignored; "all"; "": none
 * @throws Error, which lists the names, for one that is not known
 */
TAUTLINE_KERNEL_EXPORT std::vector<int> parseElementChecks(const std::string& list);

/**
 * @brief One value per cell, also of linear cells, whose map has the same form. Values are finite:
 * 0 for cells that have none (not supported, not finite; a distortion without a volume).
 * @param check a position in elementChecks()
 */
TAUTLINE_KERNEL_EXPORT void evaluateElementCheck(
  const Mesh& mesh, const CurvedCellFacts& facts, int check, double* values, int threads = 0);
}
#endif
