// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Batch.h
 * @brief Evaluation of one metric on batches of cells of one type.
 * Internal: not installed.
 */
#ifndef tautline_Batch_h
#define tautline_Batch_h

#include "Metrics.h"
#include "tautline/Mesh/CellBatch.h"

#include <limits>

namespace tautline
{
struct ElementTable;

/// The data for a batch evaluator that are the same for all batches of a block.
struct BatchContext : CellSource
{
  const EvaluationOptions* options = nullptr;
  bool largerIsBetter = false;
  bool scaleInvariant = false;         ///< whether the metric is independent of the size of T
  int lengthPower = 0;                 ///< for metrics that are not functions of T: their unit
  const UserMetric* user = nullptr;    ///< evaluates a metric that is not built in
  const ElementTable* table = nullptr; ///< for a metric that is evaluated for many elements at once
};

/// Cells and their vertices, with the values and gradients that an evaluator finds.
struct Batch : CellVertices
{
  Packet value;
  Packet gradient[MaxNodes][3];
  /// 1 if a node is the moving vertex, otherwise 0. If set, an evaluator of a user metric sums the
  /// gradients of these nodes and stores the sum as the gradient of the first node.
  const Packet* moving = nullptr;
};

/// Replaces nonfinite values by 0, or by NaN if a user metric is undefined, because an objective
/// must not treat 0 as a good value.
inline void replaceNonFinite(const BatchContext& context, Batch& batch)
{
  const Packet finite = finiteOrZero(batch.value);
  batch.value = context.user
    ? select(finite == batch.value, finite, broadcast(std::numeric_limits<double>::quiet_NaN()))
    : finite;
}

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

/// The evaluators of a metric; null if it is undefined.
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
/// The evaluators of cellMetricCode() that work on packets.
MetricCode extremalMetricCode(Metric metric);
/// For metrics that were registered: of T, and of the corners.
MetricCode userTargetMetricCode(bool singular);
MetricCode userCornerMetricCode();
}
#endif
