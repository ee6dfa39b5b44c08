#include "ElementSum.h"

#include <cmath>

namespace tautline
{
//------------------------------------------------------------------------------
MetricCode metricCode(Metric metric)
{
  switch (metricInfo(metric).family)
  {
    case MetricFamily::Target:
      return targetMetricCode(metric);
    case MetricFamily::Simplex:
      return simplexMetricCode(metric);
    default:
      return cellMetricCode(metric);
  }
}

//------------------------------------------------------------------------------
void checkEvaluation(const Mesh& mesh, const MetricInfo& info, const EvaluationOptions& options)
{
  if (!info.rotationInvariant && mesh.dimension() == Dimension::Surface)
  {
    throw Error(std::string(info.label) +
      " depends on the orientation of elements in space, which a curved surface does not define. "
      "Choose a metric without orientation.");
  }
  if (options.combination == Combination::PowerMean && !(options.power >= 1))
  {
    throw Error("The power of the power mean must be at least 1.");
  }
  if (!std::isfinite(options.parameters.beta) || !(options.parameters.epsilon > 0))
  {
    throw Error("Beta must be finite and epsilon positive.");
  }
}

//------------------------------------------------------------------------------
BatchEvaluator evaluatorFor(const Mesh& mesh, Metric metric, const MetricCode& code,
  const CellBlock& block, bool withGradient)
{
  const MetricInfo& info = metricInfo(metric);
  const bool flat = topology(block.type).dimension == 2;
  // 2D cells beside volume cells have no orientation in space.
  const bool oriented = info.rotationInvariant || !flat || mesh.dimension() == Dimension::Planar;
  if (!info.definedOn(block.type) || !oriented)
  {
    return nullptr;
  }
  return flat ? (withGradient ? code.gradient2D : code.value2D)
              : (withGradient ? code.gradient3D : code.value3D);
}

//------------------------------------------------------------------------------
BatchContext contextFor(
  const Mesh& mesh, const CellBlock& block, Metric metric, const EvaluationOptions& options)
{
  return { &mesh, &block, &topology(block.type), &options,
    metricInfo(metric).direction == Direction::LargerIsBetter };
}

namespace
{
void evaluateAll(const Mesh& mesh, Metric metric, const EvaluationOptions& options, double* values,
  double* gradients)
{
  checkEvaluation(mesh, metricInfo(metric), options);
  const MeshView& view = mesh.view();
  const MetricCode code = metricCode(metric);
  // Cells without a value get 0; nothing is filled if every cell has one.
  Index covered = 0;
  for (const CellBlock& block : mesh.blocks())
  {
    covered += evaluatorFor(mesh, metric, code, block, false) ? block.count : 0;
  }
  if (covered < view.numberOfCells)
  {
    std::fill(values, values + view.numberOfCells, 0.0);
  }
  if (gradients && view.numberOfCells > 0)
  {
    std::fill(gradients, gradients + 3 * view.offsets[view.numberOfCells], 0.0);
  }
  for (const CellBlock& block : mesh.blocks())
  {
    const BatchEvaluator evaluate = evaluatorFor(mesh, metric, code, block, gradients != nullptr);
    if (!evaluate)
    {
      continue;
    }
    const BatchContext context = contextFor(mesh, block, metric, options);
    withNodes(*context.topology,
      [&](auto nodesOfCell)
      {
        constexpr int Nodes = decltype(nodesOfCell)::value;
        forEachChunk(block.count, options.threads,
          [&](Index, Index begin, Index end)
          {
            Batch batch;
            BatchNodes nodes;
            for (Index i = begin; i < end; i += PacketWidth)
            {
              const int count = static_cast<int>(std::min<Index>(PacketWidth, end - i));
              gather<Nodes>(context, nullptr, i, count, batch, nodes);
              evaluate(context, batch);
              batch.value = finiteOrZero(batch.value);
              for (int l = 0; l < count; ++l)
              {
                values[batch.cells[l]] = batch.value[l];
              }
              if (gradients)
              {
                scatter<Nodes>(context, batch, broadcast(1.0),
                  [&](const VectorLanes& lanes, int l, int k)
                  { lanes.storeTo(gradients + 3 * (nodes[l] - view.connectivity + k), l); });
              }
            }
          });
      });
  }
}
}

//------------------------------------------------------------------------------
void evaluateMetric(
  const Mesh& mesh, Metric metric, const EvaluationOptions& options, double* values)
{
  evaluateAll(mesh, metric, options, values, nullptr);
}

//------------------------------------------------------------------------------
void evaluateMetricGradient(const Mesh& mesh, Metric metric, const EvaluationOptions& options,
  double* values, double* gradients)
{
  evaluateAll(mesh, metric, options, values, gradients);
}
}
