// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedCells.h
 * @brief The validity and the smallest Jacobian determinant of cells of quadratic and higher order,
 * certified for the whole cell and not only for its corners.
 */
#ifndef tautline_CurvedCells_h
#define tautline_CurvedCells_h

#include "Mesh.h"
#include "tautline/Elements/ElementType.h"

namespace tautline
{
/// Facts about curved cells that are not contained in a mesh.
struct CurvedCellFacts
{
  /// Null, or three numbers per cell: the orders of Lagrange and Bezier cells (VTK's cell array
  /// HigherOrderDegrees).
  const double* degrees = nullptr;
  /// Null, or a flag per cell: nonzero if its corners, but not its other nodes, were reversed by
  /// reverseCell().
  const unsigned char* reversed = nullptr;
  /// Whether the corners 1 and 2, and 4 and 5, of Lagrange and Bezier wedges are exchanged in the
  /// mesh, to match the orientation of linear wedges.
  bool wedgesTurned = false;
  /// Whether Bezier cells have individual weights: such cells are not certified.
  bool rational = false;
};

/// The curved cells of one type and order, in file order for the certifiers.
struct CurvedBlock
{
  const ElementType* type = nullptr;
  std::vector<Index> cells;
  std::vector<const Index*> nodes; ///< by position in `cells`; of the view, or of `restored`
  std::vector<Index> restored;     ///< nodes of cells whose corners the mesh has in another order
  Vec3 normal = { 0, 0, 0 };       ///< of a planar mesh
  /// By position, whether the cell is treated as its mirror image.
  std::vector<unsigned char> mirrored;
  /// Whether these are wedges in the less common order: quadratic wedges usually list their
  /// triangles like VTK's linear wedges, Lagrange and Bezier wedges in the opposite order.
  bool turned = false;

  CurvedBlock() = default;
  CurvedBlock(CurvedBlock&&) = default;
  CurvedBlock(const CurvedBlock&) = delete; // `nodes` points into `restored`

  Index count() const { return static_cast<Index>(this->cells.size()); }
  /// The positions from `begin` to `end` of mirrored cells, or of the others.
  std::vector<Index> positions(Index begin, Index end, bool isMirrored) const;
};

/**
 * @brief The cells of quadratic and higher order that ElementType supports.
 *
 * Wedges of one type and order are treated as their mirror images if most of them are reversed:
 * files use two orders.
 * @param linear whether to include linear cells, whose map has the same form
 */
TAUTLINE_KERNEL_EXPORT std::vector<CurvedBlock> curvedBlocks(
  const Mesh& mesh, const CurvedCellFacts& facts, bool linear = false);

/// The minimum of the determinant of a cell.
struct CurvedMinimum
{
  double value = 0;      ///< 0 if a coordinate is not finite
  double lower = 0;      ///< a certified lower bound; 0 if a coordinate is not finite
  Vec3 at = { 0, 0, 0 }; ///< reference coordinates, see ElementType.h
};

/**
 * @brief The validity of the cells of some blocks, and their smallest determinants.
 * @param validity of each cell of the mesh; other cells are left unchanged
 * @param minima of each cell of the mesh, or null
 */
TAUTLINE_KERNEL_EXPORT void certifyBlocks(const std::vector<CurvedBlock>& blocks,
  const double* points, signed char* validity, CurvedMinimum* minima, int threads = 0);

/**
 * @brief Replaces the validity, and the smallest determinant, of the cells of quadratic and higher
 * order.
 *
 * The determinant refers to the same reference cells as the metric min_jacobian. In a plane, its
 * sign is relative to Mesh::normal(); a cell of a surface is valid if its normal vanishes nowhere.
 * Cells that ElementType does not support are left unchanged.
 *
 * @param validity of each cell
 * @param minimum of each cell; may be null. 0 if a coordinate is not finite.
 * @return the number of cells that were certified
 */
TAUTLINE_KERNEL_EXPORT Index certifyCurvedCells(const Mesh& mesh, const CurvedCellFacts& facts,
  signed char* validity, double* minimum, int threads = 0);

/**
 * @brief Certified lower bounds of the smallest determinant of all cells that ElementType supports,
 * including linear ones.
 *
 * The determinant is as in certifyCurvedCells(); for a cell of a surface in space, the component of
 * its normal along the mean normal is bounded. A bound is at most 1e-8 times the largest
 * coefficient of the determinant below the minimum, even if the minimum is not positive.
 *
 * @param lower of each cell; 0 for other cells, and where a coordinate is not finite
 */
TAUTLINE_KERNEL_EXPORT void boundJacobians(
  const Mesh& mesh, const CurvedCellFacts& facts, double* lower, int threads = 0);
}
#endif
