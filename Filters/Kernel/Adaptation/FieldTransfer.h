// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FieldTransfer.h
 * @brief Fields of a mesh on another one: conservative and bounded, or interpolated.
 *
 * Values of cells (P0) are means over what a cell of the target overlaps, weighted by the area or
 * volume in common. Values of points (P1) are the L2 projection onto the functions that are linear
 * on each simplex, computed on the intersections of the simplices, and limited by flux-corrected
 * transport so that each is within the values of the simplices of the source which its own
 * simplices overlap:
 *
 *     M u = b,  M_ij = int phi_i phi_j,  b_i = int u_source phi_i,  m_i = sum_j M_ij
 *     v_i = b_i / m_i + 1 / m_i sum_j a_ij M_ij (u_i - u_j),  0 <= a_ij = a_ji <= 1
 *
 * The v_i have the total sum_i b_i, whatever the a_ij. (P. E. Farrell and J. R. Maddison,
 * "Conservative interpolation between volume meshes by local Galerkin projection", Comput. Methods
 * Appl. Mech. Engrg. 200, 2011; S. T. Zalesak, "Fully multidimensional flux-corrected transport
 * algorithms for fluids", J. Comput. Phys. 31, 1979; T. J. Barth and D. C. Jespersen, "The design
 * and application of upwind schemes on unstructured meshes", AIAA 89-0366, 1989.)
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
  Interpolate = 1 ///< points: the value at the nearest place; cells: of the cell at the center
};

/// What a field of cells is within a cell of the source. The numbers are stable.
enum class CellReconstruction : int
{
  Constant = 0, ///< first order; bounded by the cells that are overlapped
  /// Linear, by least squares from the cells that share a point, with the limiter of Barth and
  /// Jespersen: second order where that does not act, which it does at extrema and along the
  /// boundary; bounded by these cells.
  Linear = 1
};

struct TransferOptions
{
  TransferMethod method = TransferMethod::Conservative;
  CellReconstruction cells = CellReconstruction::Constant;
  /**
   * @brief Whether totals are kept where only one of the meshes has a place. What is lost or added
   * is then made up by the values next to these places; within their bounds if these suffice. Only
   * for TransferMethod::Conservative, and only if each mesh covers half of the other at least:
   * otherwise values could be of any size.
   */
  bool keepTotal = true;
  bool cellLabels = false;  ///< whether TransferResult::cells is needed
  bool pointLabels = false; ///< whether TransferResult::points is needed
  CoordinateFrame frame;    ///< that both meshes are in, for messages
  int threads = 0;          ///< as in Parallel.h; the result does not depend on it
};

/// A field of the source.
struct TransferField
{
  bool ofCells = false;
  int components = 1;
  std::vector<double> values; ///< finite; components per point or cell of the source
};

/// What became of a component of a field; the total is the integral over the elements.
struct TransferTotal
{
  double before = 0, after = 0;
  double magnitude = 0; ///< the integral of the absolute value before
  double minimumBefore = 0, maximumBefore = 0, minimumAfter = 0, maximumAfter = 0;
  double excess = 0; ///< how far a value is outside of the values that it comes from
};

struct TransferredField
{
  std::vector<double> values;        ///< components per point or cell of the target
  std::vector<TransferTotal> totals; ///< per component
};

struct TransferResult
{
  std::vector<TransferredField> fields; ///< in the order given
  /// Per cell of the target: the cell of the source that it overlaps most, or else the one nearest
  /// to its center.
  std::vector<Index> cells;
  std::vector<Index> points; ///< per point of the target: the nearest point of the source
  double sourceSize = 0, targetSize = 0;       ///< areas or volumes
  double sourceCovered = 0, targetCovered = 0; ///< of these, what the other mesh has; conservative
  bool surface = false;
  bool totalsKept = false; ///< whether TransferOptions::keepTotal had an effect
  /// Elements and points of the target without anything of the source: they have the nearest value.
  Index nearestCells = 0, nearestPoints = 0;
};

/**
 * @brief Transfers fields from the source to the target.
 *
 * Two planar meshes in one plane are computed with in the plane; triangles in space are seen along
 * the normal of each triangle of the target.
 *
 * Throws Error if the meshes differ in their dimension, one of them has no element with an area or
 * volume, or the source covers less than 1e-6 of the target.
 */
TAUTLINE_KERNEL_EXPORT TransferResult transferFields(TransferMesh target, TransferMesh source,
  const std::vector<TransferField>& fields, const TransferOptions& options);
}
#endif
