// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FieldTransfer.h
 * @brief Transfers fields from one mesh to another: conservative and bounded, or interpolated.
 *
 * Cell values (P0) are means over the overlapped source cells, weighted by the common area or
 * volume. Point values (P1) are the L2 projection onto the functions that are linear on each
 * simplex, computed on the intersections of the simplices, and limited by flux-corrected transport
 * so that each value stays within the range of the source simplices that its own simplices overlap:
 *
 *     M u = b,  M_ij = int phi_i phi_j,  b_i = int u_source phi_i,  m_i = sum_j M_ij
 *     v_i = b_i / m_i + 1 / m_i sum_j a_ij M_ij (u_i - u_j),  0 <= a_ij = a_ji <= 1
 *
 * The v_i have the total sum_i b_i for any a_ij. (P. E. Farrell and J. R. Maddison, "Conservative
 * interpolation between volume meshes by local Galerkin projection", Comput. Methods Appl. Mech.
 * Engrg. 200, 2011; S. T. Zalesak, "Fully multidimensional flux-corrected transport algorithms for
 * fluids", J. Comput. Phys. 31, 1979; T. J. Barth and D. C. Jespersen, "The design and application
 * of upwind schemes on unstructured meshes", AIAA 89-0366, 1989.)
 */
#ifndef tautline_FieldTransfer_h
#define tautline_FieldTransfer_h

#include "TransferMesh.h"

#include "tautline/Mesh/CoordinateFrame.h"

#include <vector>

namespace tautline
{
/// The numbers are stable: ParaView state files hold them.
enum class TransferMethod : int
{
  Conservative = 0,
  /// points: the value at the nearest location; cells: the value of the cell at the center
  Interpolate = 1
};

/// How a cell field varies within a source cell. The numbers are stable.
enum class CellReconstruction : int
{
  Constant = 0, ///< first order; bounded by the overlapped cells
  /// Linear, by least squares from the cells that share a point, with the limiter of Barth and
  /// Jespersen: second order except at extrema and along the boundary, where the limiter acts;
  /// bounded by these cells.
  Linear = 1
};

struct TransferOptions
{
  TransferMethod method = TransferMethod::Conservative;
  CellReconstruction cells = CellReconstruction::Constant;
  /**
   * @brief Whether totals are preserved where only one of the meshes covers a region. The lost or
   * added amount is then compensated by the values next to this region, within their bounds if
   * possible. Only for TransferMethod::Conservative, and only if each mesh covers at least half of
   * the other: otherwise values could become arbitrarily large.
   */
  bool keepTotal = true;
  bool cellLabels = false;  ///< whether TransferResult::cells is needed
  bool pointLabels = false; ///< whether TransferResult::points is needed
  CoordinateFrame frame;    ///< of both meshes, for messages
  int threads = 0;          ///< as in Parallel.h; the result does not depend on it
};

/// A field of the source.
struct TransferField
{
  bool ofCells = false;
  int components = 1;
  std::vector<double> values; ///< finite; components per point or cell of the source
};

/// The totals of one field component; a total is the integral over the elements.
struct TransferTotal
{
  double before = 0, after = 0;
  double magnitude = 0; ///< the integral of the absolute value before
  double minimumBefore = 0, maximumBefore = 0, minimumAfter = 0, maximumAfter = 0;
  double excess = 0; ///< the largest excess of a value over the range of its source values
};

struct TransferredField
{
  std::vector<double> values;        ///< components per point or cell of the target
  std::vector<TransferTotal> totals; ///< per component
};

struct TransferResult
{
  std::vector<TransferredField> fields; ///< in the order given
  /// Per cell of the target: the cell of the source that it overlaps most; if none, the one nearest
  /// to its center.
  std::vector<Index> cells;
  std::vector<Index> points; ///< per point of the target: the nearest point of the source
  double sourceSize = 0, targetSize = 0; ///< areas or volumes
  /// the part that the other mesh covers; conservative only
  double sourceCovered = 0, targetCovered = 0;
  bool surface = false;
  bool totalsKept = false; ///< whether TransferOptions::keepTotal had an effect
  /// Target elements and points that the source does not cover: they take the nearest value.
  Index nearestCells = 0, nearestPoints = 0;
};

/**
 * @brief Transfers fields from the source to the target.
 *
 * Coplanar meshes are processed in their plane; triangles in space are projected along the normal
 * of each target triangle.
 *
 * Throws Error if the meshes differ in their dimension, one of them has no element with an area or
 * volume, or the source covers less than 1e-6 of the target.
 */
TAUTLINE_KERNEL_EXPORT TransferResult transferFields(TransferMesh target, TransferMesh source,
  const std::vector<TransferField>& fields, const TransferOptions& options);
}
#endif
