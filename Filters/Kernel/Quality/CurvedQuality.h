// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedQuality.h
 * @brief Quality metrics of cells of quadratic and higher order.
 *
 * evaluateMetric() measures these cells at their corners. Here, the whole curved cell is measured:
 * - min_jacobian: certified;
 * - scaled_jacobian: the certified minimum over the cell; for a simplex, also over its corners;
 * - imr, mean_ratio and condition_number with Combination::Worst: the certified worst value, from
 *   the minimum of the mean ratio and of the inverse condition number. The value is attained; the
 *   true worst value is worse by at most 0.1 %;
 * - all other functions of T = A W^-1 with the ideal target (including registered ones), and these
 *   three with the other combinations: by quadrature, see ElementSamples.h: the mean over the
 *   reference element, its power mean, or the worst sample. If the determinant is negative at some
 *   points, only these are used, except for metrics that untangle; in an inverted cell, the point
 *   with the smallest determinant is included;
 * - size: the area or volume of the curved cell.
 *
 * Still measured at the corners: untangle_beta, targets other than the ideal element, lengths and
 * angles.
 */
#ifndef tautline_CurvedQuality_h
#define tautline_CurvedQuality_h

#include "Metrics.h"
#include "tautline/Mesh/CurvedCells.h"

namespace tautline
{
/// The numbers of invalid cells that a check at a few points would miss.
struct MissedCells
{
  Index curved = 0;              ///< certified cells
  Index invalid = 0;             ///< inverted or degenerate ones
  Index atCorners = 0;           ///< invalid cells with a positive determinant at all corners
  Index atIntegrationPoints = 0; ///< the same at all integrationPoints()
};

/**
 * @class CurvedQuality
 * @brief The curved cells of one mesh. The mesh and the facts must outlive it.
 */
class TAUTLINE_KERNEL_EXPORT CurvedQuality
{
public:
  CurvedQuality(const Mesh& mesh, const CurvedCellFacts& facts, int threads = 0);

  /// Wedges in the less common order, see CurvedBlock::turned.
  Index turnedWedges() const;
  /// The cells that are measured as curved ones.
  Index cells() const { return this->Count; }

  /// Replaces the validity of the curved cells, and locates the minimum of their determinant.
  void certify(signed char* validity);

  /**
   * @brief Replaces the values of the curved cells; call certify() before.
   * @param options as passed to evaluateMetric()
   * @return false if the metric is measured at the corners; the values are then unchanged
   */
  bool measure(Metric metric, const EvaluationOptions& options, const signed char* validity,
    double* values) const;
  /// Whether measure() supports a metric.
  bool measures(Metric metric, const EvaluationOptions& options) const;

  /// The reference coordinates of the smallest determinant, and the point there: three each per
  /// cell of the mesh. For other cells: 0 and their centers.
  void places(double* reference, double* points) const;

  /// @param skip nonzero: the cell is ignored; may be null
  MissedCells missed(const signed char* validity, const unsigned char* skip) const;

private:
  void sample(const CurvedBlock& block, const MetricInfo& info, const EvaluationOptions& options,
    const signed char* validity, double* values) const;
  void bound(
    const CurvedBlock& block, Metric metric, const signed char* validity, double* values) const;
  void measureSizes(const CurvedBlock& block, double* values) const;

  const Mesh& TheMesh;
  int Threads;
  std::vector<CurvedBlock> Blocks;
  std::vector<CurvedMinimum> Minima; ///< by cell of the mesh
  Index Count = 0;
};
}
#endif
