// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Statistics.h
 * @brief Summaries of a metric over a mesh: moments, quantiles, worst elements, histogram, angles.
 *
 * All statistics of a metric - minimum, maximum, mean, RMS, deviation, quantiles, worst value,
 * histogram - are over the same elements, the measured ones: valid and inverted elements on which
 * the metric is defined. An inverted element is included with its value, which is negative for most
 * metrics (InvertedValue). Degenerate elements, on which many metrics are infinite, elements that
 * are not measured or not finite, and ghosts are excluded; ValidityCounts counts them.
 */
#ifndef tautline_Statistics_h
#define tautline_Statistics_h

#include "Metrics.h"

namespace tautline
{
/// The quantiles reported, as fractions.
constexpr std::array<double, 7> quantileFractions = { 0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99 };

/// The number of worst elements that are listed.
constexpr int WorstCount = 10;

/**
 * @brief The summary of one metric over the elements of measuredValues(); zeros if there are none.
 */
struct MetricStatistics
{
  Index measured = 0; ///< elements in the sums
  double minimum = 0, maximum = 0, mean = 0, rms = 0;
  double standardDeviation = 0; ///< of the whole population (divided by n)
  std::array<double, quantileFractions.size()> quantiles{}; ///< linearly interpolated
  Index outsideAcceptable = 0; ///< measured elements outside the acceptable range
};

/// One of the worst elements of a metric.
struct WorstElement
{
  Index cell;
  double value;
  signed char validity;
};

/// The number of cells of each Validity.
struct ValidityCounts
{
  Index valid = 0, inverted = 0, degenerate = 0, notMeasured = 0, nonFinite = 0;
};

/// One value per cell, and facts about the cells.
struct CellValues
{
  Index cells = 0;
  const double* values = nullptr;
  const signed char* validity = nullptr;    ///< see Validity
  const unsigned char* cellTypes = nullptr; ///< VTK codes
  const unsigned char* skip = nullptr;      ///< nonzero: exclude (ghosts); may be null
};

/// Counts the values of a validity array; `skip` may be null.
TAUTLINE_KERNEL_EXPORT ValidityCounts countValidity(
  const signed char* validity, const unsigned char* skip, Index cells);

/// The values used for statistics: of the measured elements, in the order of the cells.
TAUTLINE_KERNEL_EXPORT std::vector<double> measuredValues(
  const MetricInfo& info, const CellValues& data);

/**
 * @brief Summarizes measured values.
 * @param dimension 2 or 3: selects the acceptable range
 * @param withQuantiles off: the quantiles, which cost more than everything else, stay 0
 */
TAUTLINE_KERNEL_EXPORT MetricStatistics summarize(const MetricInfo& info, int dimension,
  const std::vector<double>& measured, bool withQuantiles = true);

/**
 * @brief Up to WorstCount elements to repair, worst first. Inverted elements come first, then
 * degenerate ones (which the statistics leave out), then the worst of the valid ones in the
 * direction of the metric (for neutral metrics, the smallest); ties are sorted by cell.
 */
TAUTLINE_KERNEL_EXPORT std::vector<WorstElement> worstElements(
  const MetricInfo& info, const CellValues& data);

/**
 * @brief The value of the worst measured element: of an inverted one if there are any, otherwise
 * the maximum or, for neutral metrics and if larger is better, the minimum. 0 if there are none.
 * @param worst of the same cells
 */
TAUTLINE_KERNEL_EXPORT double worstValue(const MetricInfo& info, const MetricStatistics& statistics,
  const std::vector<WorstElement>& worst);

/// The order of worstElements(): whether a is worse than b.
TAUTLINE_KERNEL_EXPORT bool isWorse(
  const MetricInfo& info, const WorstElement& a, const WorstElement& b);

/**
 * @brief Histogram between the smallest and largest value. Bin i covers [edges[i], edges[i + 1]);
 * the last one includes its upper end. Without values the bins span [0, 1].
 */
struct Histogram
{
  std::vector<double> edges;
  std::vector<Index> counts;
};
TAUTLINE_KERNEL_EXPORT Histogram histogram(const std::vector<double>& measured, int bins);

/**
 * @brief Histogram over the acceptable range of a metric, so that a few extreme values do not hide
 * the distribution of the others. Bins as in Histogram.
 *
 * If the range is unbounded or has no width, the smallest or largest value replaces its end. A
 * value that exceeds an end only by rounding is in the bin at that end, as in
 * MetricStatistics::outsideAcceptable. The negative values of inverted elements
 * (InvertedValue::Negative) are excluded: their number is reported separately.
 */
struct AcceptableHistogram : Histogram
{
  Index below = 0; ///< values below the first edge
  Index above = 0; ///< values above the last edge
};
TAUTLINE_KERNEL_EXPORT AcceptableHistogram acceptableHistogram(
  const MetricInfo& info, int dimension, const std::vector<double>& measured, int bins);

/// Ends of the angle bins of dissertation Table 2.7, degrees.
constexpr std::array<double, 6> angleBins = { 0, 20, 40, 80, 100, 180 };

/**
 * @brief Counts the angles of all measurable cells in the bins of Table 2.7: corner angles of 2D
 * cells or, in a volume mesh, dihedral angles of the 3D cells. Inverted cells are included with
 * their angles, degenerate ones are not.
 */
TAUTLINE_KERNEL_EXPORT std::array<Index, angleBins.size() - 1> angleDistribution(
  const Mesh& mesh, const signed char* validity, const unsigned char* skip, int threads = 0);
}
#endif
