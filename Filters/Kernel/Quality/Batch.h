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

/// Everything a batch evaluator needs that is the same for all batches of a block.
struct BatchContext : CellSource
{
  const EvaluationOptions* options = nullptr;
  bool largerIsBetter = false;
  bool scaleInvariant = false;         ///< the metric does not depend on the size of T
  int lengthPower = 0;                 ///< of metrics that are not functions of T: their unit
  const UserMetric* user = nullptr;    ///< evaluates a metric that is not built in
  const ElementTable* table = nullptr; ///< of a metric that is evaluated for many elements at once
};

/// Cells and their vertices, with the values and gradients that an evaluator finds.
struct Batch : CellVertices
{
  Packet value;
  Packet gradient[MaxNodes][3];
  /// 1 where a node is the vertex that moves, else 0. If set, an evaluator of a user's metric adds
  /// up the gradients of these nodes and puts the sum in place of that of the first node.
  const Packet* moving = nullptr;
};

/// Replaces values that are not finite: by 0, or by NaN where a user's metric has none, which an
/// objective must not take for a good one.
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
/// Those of cellMetricCode() that work on packets.
MetricCode extremalMetricCode(Metric metric);
/// For metrics that were registered: of T, and of the corners.
MetricCode userTargetMetricCode(bool singular);
MetricCode userCornerMetricCode();
}
#endif
