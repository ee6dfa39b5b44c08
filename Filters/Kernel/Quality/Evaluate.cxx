// SPDX-License-Identifier: BSD-3-Clause
#include "ElementSum.h"
#include "ElementTable.h"
#include "JudgedValues.h"
#include "UserMetric.h"

#include "tautline/Mesh/CoordinateFrame.h"
#include "tautline/Mesh/MeshElements.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace tautline
{
//------------------------------------------------------------------------------
MetricCode metricCode(Metric metric)
{
  const MetricInfo& info = metricInfo(metric);
  if (info.user)
  {
    return !info.user->hasDerivatives() ? tableMetricCode()
      : info.family == MetricFamily::Target
      ? userTargetMetricCode(info.inverted != InvertedValue::Larger)
      : userCornerMetricCode();
  }
  switch (info.family)
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
  if (info.family == MetricFamily::Faces)
  {
    throw Error(std::string(info.label) +
      " compares the cells on both sides of the faces: measure it with Element Quality.");
  }
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
  // 2D cells next to volume cells have no orientation in space.
  const bool oriented = info.rotationInvariant || !flat || mesh.dimension() == Dimension::Planar;
  if (!info.definedOn(block.type) || !oriented)
  {
    return nullptr;
  }
  return flat ? (withGradient ? code.gradient2D : code.value2D)
              : (withGradient ? code.gradient3D : code.value3D);
}

BatchEvaluator elementEvaluatorFor(const Mesh& mesh, Metric metric, const MetricCode& code,
  const CellBlock& block, bool withGradient)
{
  return isElement(mesh, block.type) ? evaluatorFor(mesh, metric, code, block, withGradient)
                                     : nullptr;
}

//------------------------------------------------------------------------------
BatchContext contextFor(
  const Mesh& mesh, const CellBlock& block, Metric metric, const EvaluationOptions& options)
{
  const MetricInfo& info = metricInfo(metric);
  const CellTopology& t = topology(block.type);
  return { { &mesh, &block, &t }, &options, info.direction == Direction::LargerIsBetter,
    info.scaleInvariant,
    info.family == MetricFamily::Target || info.user ? 0 : info.lengthPower(t.dimension),
    info.user };
}

//------------------------------------------------------------------------------
std::string objectiveProblem(Metric metric)
{
  const MetricInfo& info = metricInfo(metric);
  if (info.family == MetricFamily::Faces)
  {
    return std::string(info.label) +
      " compares the cells on both sides of faces and is not a function of one element. Choose "
      "another metric.";
  }
  return "";
}

//------------------------------------------------------------------------------
bool needsDifferences(Metric metric)
{
  const UserMetric* user = metricInfo(metric).user;
  return user && !user->hasDerivatives();
}

//------------------------------------------------------------------------------
void requireDerivatives(const MetricInfo& info)
{
  if (info.user && !info.user->hasDerivatives())
  {
    throw Error(std::string(info.label) +
      " has no analytic derivatives, which are needed here. Register it in C++ "
      "(tautline/Quality/UserMetric.h), or choose another metric.");
  }
}

namespace
{
/// The smallest number with all digits.
constexpr double smallestNormal = std::numeric_limits<double>::min();

/**
 * @brief The number of cells of a batch with a value that double precision cannot hold. Other
 * elements without a finite value are degenerate or not finite.
 * @param measured the values before they were converted from the units of the cells
 * @param ordinary whether the typical cell of the mesh is of ordinary size
 */
Index countBeyond(const BatchContext& context, const MetricInfo& info, const Batch& batch,
  Packet measured, const BatchNodes& nodes, bool ordinary)
{
  const Packet value = batch.value;
  const Mask vanished = (abs(value) < smallestNormal) & (measured != 0.0);
  // If areas and volumes vanish, functions of them also vanish.
  const bool ofSize = info.inverted == InvertedValue::Larger && info.lengthPower(1) > 0;
  const Mask suspect = ~(abs(value) <= std::numeric_limits<double>::max()) | vanished |
    ((value == 0.0) & (ofSize ? -1 : 0));
  Index count = 0;
  for (int l = 0; l < batch.count && any(suspect); ++l)
  {
    if (!suspect[l])
    {
      continue;
    }
    Vec3 p[MaxNodes];
    for (int k = 0; k < context.topology->nodes; ++k)
    {
      p[k] = pointOf(context.mesh->view(), nodes[l][k]);
    }
    // Cells with stray vertices are not measured; see NonFinite.
    constexpr double stray = 1e100;
    const bool near = std::all_of(
      p + 1, p + context.topology->nodes, [&](const Vec3& q) { return norm(q - p[0]) < stray; });
    if (!near && ordinary)
    {
      continue;
    }
    const Validity validity = context.mesh->classifyCell(*context.topology, p);
    // For these metrics, 0 is the correct value of a valid element but not of an inverted one.
    const bool zero = value[l] == 0 && measured[l] == 0;
    count += zero ? validity == Inverted : validity == Valid || validity == Inverted;
  }
  return count;
}

/// @param undefined the value to use if the metric value is not finite
Index evaluateAll(const Mesh& mesh, Metric metric, const EvaluationOptions& options, double* values,
  double* gradients, double undefined = 0.0)
{
  checkEvaluation(mesh, metricInfo(metric), options);
  // A metric without derivatives is evaluated on all elements at once.
  if (const UserMetric* user = metricInfo(metric).user; user && !user->hasDerivatives())
  {
    if (gradients)
    {
      requireDerivatives(metricInfo(metric));
    }
    const std::vector<double> found = tabulate(mesh, metricInfo(metric), false).values;
    std::transform(found.begin(), found.end(), values,
      [undefined](double value) { return std::isfinite(value) ? value : undefined; });
    return 0;
  }
  const MeshView& view = mesh.view();
  const MetricCode code = metricCode(metric);
  // Cells without a value get 0; skip filling if every cell has one.
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
  const MetricInfo& info = metricInfo(metric);
  const bool ordinary = info.scaleInvariant || unitOfExtent(coordinateRange(view).extent) == 1;
  std::atomic<Index> beyond{ 0 };
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
              normalizeExtents<Nodes>(batch);
              evaluate(context, batch);
              const Packet measured = batch.value;
              batch.value = timesUnit(batch, measured, context.lengthPower);
              // Values of scale-invariant metrics do not depend on the unit, so they stay in range.
              if (!info.scaleInvariant)
              {
                beyond += countBeyond(context, info, batch, measured, nodes, ordinary);
              }
              const Packet finite = finiteOrZero(batch.value);
              batch.value = select(finite == batch.value, finite, broadcast(undefined));
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
  return beyond;
}
}

//------------------------------------------------------------------------------
Index evaluateMetric(
  const Mesh& mesh, Metric metric, const EvaluationOptions& options, double* values)
{
  return evaluateAll(mesh, metric, options, values, nullptr);
}

//------------------------------------------------------------------------------
void evaluateJudged(
  const Mesh& mesh, Metric metric, const EvaluationOptions& options, double* values)
{
  const MetricInfo& info = metricInfo(metric);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  // Without a value, an element must not pass as a good one.
  const double worst = info.direction == Direction::LargerIsBetter ? -infinity : infinity;
  evaluateAll(mesh, metric, options, values, nullptr, info.user ? worst : 0.0);
}

//------------------------------------------------------------------------------
void requireInRange(const MetricInfo& info, Index beyond)
{
  if (beyond > 0)
  {
    throw Error(std::string(info.label) + " of " + std::to_string(beyond) +
      " elements is beyond the range of double precision: it depends on the size of the elements, "
      "which is extreme. Choose a metric without a unit, " +
      (info.family == MetricFamily::Target ? "a target of the size of the elements, " : "") +
      "or scale the mesh first (filter Transform).");
  }
}

//------------------------------------------------------------------------------
Index evaluateMetricGradient(const Mesh& mesh, Metric metric, const EvaluationOptions& options,
  double* values, double* gradients)
{
  return evaluateAll(mesh, metric, options, values, gradients);
}
}
