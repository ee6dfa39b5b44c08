// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RankStatistics.h
 * @brief Statistics of a metric over a mesh in pieces on several processes.
 */
#ifndef tautline_RankStatistics_h
#define tautline_RankStatistics_h

#include "TautlineCoreModule.h" // for export macro

#include "tautline/Core/RankGroup.h"
#include "tautline/Quality/Metrics.h"
#include "tautline/Quality/Statistics.h"

namespace tautline
{
/// A metric on one state of a mesh.
struct Measurement
{
  MetricStatistics statistics; ///< without quantiles
  ValidityCounts counts;
  double worst = 0; ///< worstValue()
};

/**
 * @brief Measures the pieces, each on its process; the statistics are those of the whole mesh,
 * bitwise the same however it is cut. No process gets the values of another. Collective.
 * @param dimension of the whole mesh, 2 or 3: which acceptable range counts
 * @param skip one flag per cell: those that another process counts (ghosts)
 * @param values one per cell, filled
 */
TAUTLINECORE_EXPORT Measurement measureOnRanks(RankGroup& group, const Mesh& piece, int dimension,
  Metric metric, const EvaluationOptions& options, const signed char* validity,
  const unsigned char* skip, double* values);

/// The same of values that are known, one per cell of the piece.
TAUTLINECORE_EXPORT Measurement summarizeOnRanks(RankGroup& group, const MeshView& piece,
  int dimension, Metric metric, const signed char* validity, const unsigned char* skip,
  const double* values);
}
#endif
