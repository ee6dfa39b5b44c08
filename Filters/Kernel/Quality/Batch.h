// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Batch.h
 * @brief Evaluation of one metric on batches of cells of one type. Internal: not installed.
 */
#ifndef tautline_Batch_h
#define tautline_Batch_h

#include "Metrics.h"
#include "tautline/Mesh/CellBatch.h"

namespace tautline
{
/// Everything a batch evaluator needs that is the same for all batches of a block.
struct BatchContext : CellSource
{
  const EvaluationOptions* options = nullptr;
  bool largerIsBetter = false;
  bool scaleInvariant = false;      ///< the metric does not depend on the size of T
  int lengthPower = 0;              ///< of metrics that are not functions of T: their unit
  const UserMetric* user = nullptr; ///< evaluates a metric that is not built in
};

/// Cells and their vertices, with the values and gradients that an evaluator finds.
struct Batch : CellVertices
{
  Packet value;
  Packet gradient[MaxNodes][3];
};

/// x times the unit of the cells to a power, for cells that normalizeExtents() has scaled.
inline Packet timesUnit(const CellVertices& batch, Packet x, int power)
{
  for (int i = 0; batch.scaled && i < std::abs(power); ++i)
  {
    x = power > 0 ? Packet(x * batch.unit) : Packet(x / batch.unit);
  }
  return x;
}

using BatchEvaluator = void (*)(const BatchContext&, Batch&);

/// The evaluators of a metric; null where it is not defined.
struct MetricCode
{
  BatchEvaluator value2D = nullptr;
  BatchEvaluator gradient2D = nullptr;
  BatchEvaluator value3D = nullptr;
  BatchEvaluator gradient3D = nullptr;
};

MetricCode targetMetricCode(Metric metric);
MetricCode simplexMetricCode(Metric metric);
MetricCode cellMetricCode(Metric metric);
/// For metrics that were registered: of T, and of the corners.
MetricCode userTargetMetricCode(bool singular);
MetricCode userCornerMetricCode();
}
#endif
