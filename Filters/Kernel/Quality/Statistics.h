// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Statistics.h
 * @brief Summaries of a metric over a mesh: moments, quantiles, worst elements, histogram, angles.
 *
 * All statistics of a metric - minimum, maximum, mean, RMS, deviation, quantiles, worst value,
 * histogram - are over the same elements, the measured ones: valid and inverted elements on which
 * the metric is defined. An inverted element counts with the value it has, which most metrics make
 * negative (InvertedValue). Left out, and counted by ValidityCounts, are degenerate elements, on
 * which many metrics are infinite, elements that are not measured or not finite, and ghosts.
 */
#ifndef tautline_Statistics_h
#define tautline_Statistics_h

#include "Metrics.h"

namespace tautline
{
/// The quantiles reported, as fractions.
constexpr std::array<double, 7> quantileFractions = { 0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99 };

/// How many of the worst elements are listed.
constexpr int WorstCount = 10;

/**
 * @brief Summary of one metric over the elements measuredValues() keeps; without any, zeros.
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

/// How many cells have each Validity.
struct ValidityCounts
{
  Index valid = 0, inverted = 0, degenerate = 0, notMeasured = 0, nonFinite = 0;
};

/// One value of each cell, and what is known of the cells.
struct CellValues
{
  Index cells = 0;
  const double* values = nullptr;
  const signed char* validity = nullptr;    ///< see Validity
  const unsigned char* cellTypes = nullptr; ///< VTK codes
  const unsigned char* skip = nullptr;      ///< nonzero: leave out (ghosts); may be null
};

/// Counts the values of a validity array; `skip` may be null.
TAUTLINE_KERNEL_EXPORT ValidityCounts countValidity(
  const signed char* validity, const unsigned char* skip, Index cells);

/// The values that statistics are made of: of the measured elements, in the order of the cells.
TAUTLINE_KERNEL_EXPORT std::vector<double> measuredValues(
  const MetricInfo& info, const CellValues& data);

/**
 * @brief Summarizes measured values.
 * @param dimension 2 or 3: which acceptable range counts
 * @param withQuantiles off: the quantiles, which cost more than all the rest, stay 0
 */
TAUTLINE_KERNEL_EXPORT MetricStatistics summarize(const MetricInfo& info, int dimension,
  const std::vector<double>& measured, bool withQuantiles = true);

/**
 * @brief Up to WorstCount elements to repair, worst first. Inverted elements come first, then
 * degenerate ones (which the statistics leave out), then the worst of the valid ones in the
 * metric's direction (for neutral metrics the smallest); equals by cell.
 */
TAUTLINE_KERNEL_EXPORT std::vector<WorstElement> worstElements(
  const MetricInfo& info, const CellValues& data);

/**
 * @brief The value of the worst measured element: of an inverted one if there are any, else the
 * maximum or, for neutral metrics and where larger is better, the minimum. 0 without any.
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
 * how the others are distributed. Bins as those of Histogram.
 *
 * Where the range is unbounded or has no width, the smallest or largest value takes the place of
 * its end. A value that exceeds an end by rounding only is in the bin at that end, as in
 * MetricStatistics::outsideAcceptable. The negative values of inverted elements do not count where
 * a metric has such (InvertedValue::Negative): their number is known.
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
 * @brief Counts the angles of all measurable cells by the bins of Table 2.7: corner angles of 2D
 * cells; in a volume mesh the dihedral angles of the 3D cells. Inverted cells count with their
 * angles, degenerate ones do not.
 */
TAUTLINE_KERNEL_EXPORT std::array<Index, angleBins.size() - 1> angleDistribution(
  const Mesh& mesh, const signed char* validity, const unsigned char* skip, int threads = 0);
}
#endif
