// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Measurement.h
 * @brief Statistics of a metric over a mesh, which may be in pieces on several processes.
 */
#ifndef tautline_Measurement_h
#define tautline_Measurement_h

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
 * @brief Measures a metric on the cells of this process.
 * @param group for a mesh in pieces, one per process: the statistics then cover the whole mesh, are
 * bitwise independent of the division, and no process gets the values of another; collective. Null
 * if this process has the whole mesh.
 * @param dimension of the whole mesh, 2 or 3; selects the acceptable range
 * @param validity one per cell @param skip one flag per cell, set for cells that do not count or
 * that another process counts (ghosts); or null
 * @param values one per cell, filled
 */
TAUTLINECORE_EXPORT Measurement measure(RankGroup* group, const Mesh& mesh, int dimension,
  Metric metric, const EvaluationOptions& options, const signed char* validity,
  const unsigned char* skip, double* values);

/// The same for known values, one per cell.
TAUTLINECORE_EXPORT Measurement measureValues(RankGroup* group, const MeshView& view, int dimension,
  Metric metric, const signed char* validity, const unsigned char* skip, const double* values);
}
#endif
