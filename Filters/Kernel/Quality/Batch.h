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
};

/// Cells and their vertices, with the values and gradients that an evaluator finds.
struct Batch : CellVertices
{
  Packet value;
  Packet gradient[MaxNodes][3];
};

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
}
#endif
