/**
 * @file Statistics.h
 * @brief Summaries of a metric over a mesh: moments, quantiles, worst elements, histogram, angles.
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
 * @brief Summary of one metric. Moments, quantiles and the histogram are over the valid elements on
 * which the metric is defined (for metrics that order inverted elements, InvertedValue::Larger, over
 * the inverted ones too); without any, they are 0.
 */
struct MetricStatistics
{
  Index measured = 0; ///< elements summed up
  double minimum = 0, maximum = 0, mean = 0, rms = 0, standardDeviation = 0;
  std::array<double, quantileFractions.size()> quantiles{}; ///< linearly interpolated
  Index outsideAcceptable = 0; ///< measured elements outside the acceptable range
  /**
   * @brief Cells with the worst values, worst first; ids are -1 beyond their number. Inverted and
   * degenerate elements come first, then the worst of the valid ones in the metric's direction
   * (for neutral metrics the smallest).
   */
  std::array<Index, WorstCount> worst;
};

/**
 * @brief Counts that are the same for every metric of a mesh.
 */
struct ValidityCounts
{
  Index valid = 0, inverted = 0, degenerate = 0, notMeasured = 0, nonFinite = 0;
};

/// Counts the values of a validity array.
TAUTLINE_KERNEL_EXPORT ValidityCounts countValidity(const signed char* validity, Index cells);

/**
 * @brief Summarizes values of a metric.
 * @param values, validity, cellTypes (VTK codes) one entry per cell
 * @param skip cells to leave out (ghosts) are nonzero here; may be null
 * @param dimension 2 or 3: which acceptable range counts
 */
TAUTLINE_KERNEL_EXPORT MetricStatistics summarize(const MetricInfo& info, int dimension,
  const double* values, const signed char* validity, const unsigned char* cellTypes,
  const unsigned char* skip, Index cells);

/**
 * @brief Histogram of the elements summarize() measures, between the smallest and largest of them.
 * The last bin includes its upper end. Bin i covers [edges[i], edges[i + 1]].
 */
struct Histogram
{
  std::vector<double> edges;
  std::vector<Index> counts;
};
TAUTLINE_KERNEL_EXPORT Histogram histogram(const MetricInfo& info, const double* values,
  const signed char* validity, const unsigned char* cellTypes, const unsigned char* skip,
  Index cells, int bins);

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
