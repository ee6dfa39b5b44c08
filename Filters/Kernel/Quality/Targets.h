// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Targets.h
 * @brief Target elements: the matrix W of T = A W^-1, for every cell.
 *
 * The default (no targets) is the ideal cell of each type with unit edges. All functions throw
 * Error for data of the wrong length, and state the first cell whose datum cannot be a target.
 */
#ifndef tautline_Targets_h
#define tautline_Targets_h

#include "Metrics.h"

namespace tautline
{
/// The kind of target element.
enum class TargetType : int
{
  Ideal = 0,     ///< the ideal cell with unit edges
  Reference = 1, ///< the same cell of a reference mesh
  Size = 2,      ///< the ideal shape with a given area or volume
  Tensor = 3     ///< the ideal shape in a given metric tensor
};

/**
 * @brief The cells of `reference`, which must have the connectivity of `mesh` (same cells, other
 * coordinates). Its inverted and degenerate cells cannot be targets.
 */
TAUTLINE_KERNEL_EXPORT Targets referenceTargets(const Mesh& mesh, const Mesh& reference);

/// The ideal shape scaled to the given area or volume (> 0) per cell of the view.
TAUTLINE_KERNEL_EXPORT Targets sizeTargets(const Mesh& mesh, const double* sizes);

/// Multiplies the matrices W^-1: for a mesh whose coordinates were divided by `unit`, a power of
/// two.
TAUTLINE_KERNEL_EXPORT void scaleTargets(Targets& targets, double unit);

/**
 * @brief The ideal shape in a metric tensor M per cell: T = M^(1/2) A W_ideal^-1, so that target
 * edges have length 1 in M.
 * @param tensors symmetric positive definite 3 x 3 matrices, row by row, 9 per cell of the view.
 * For planar meshes M acts in the plane; for surfaces it must be isotropic in the tangent plane.
 */
TAUTLINE_KERNEL_EXPORT Targets tensorTargets(const Mesh& mesh, const double* tensors);
}
#endif
