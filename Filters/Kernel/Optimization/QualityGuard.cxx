// SPDX-License-Identifier: BSD-3-Clause
#include "QualityGuard.h"

#include "tautline/Core/Parallel.h"
#include "tautline/Mesh/MeshElements.h"
#include "tautline/Quality/JudgedValues.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
/**
 * @brief Calls visit(found, cell, validity, value) for each element of the mesh's dimension, with
 * one object for the elements of a chunk; value is null where the metric is not defined.
 * @param values set to those of the metric
 * @return the objects, in the order of the chunks
 */
template <class Found, class Visit>
std::vector<Found> visitElements(const Mesh& mesh, const std::vector<signed char>& validity,
  const Objective& judged, std::vector<double>& values, const Visit& visit)
{
  const int threads = judged.evaluation.threads;
  values.resize(validity.size());
  evaluateJudged(mesh, judged.metric, judged.evaluation, values.data());
  std::vector<Found> all;
  for (const CellBlock& block : mesh.blocks())
  {
    const bool measured = metricInfo(judged.metric).definedOn(block.type);
    const Index count = isElement(mesh, block.type) ? block.count : 0;
    std::vector<Found> ofChunk(numberOfChunks(count));
    forEachChunk(count, threads,
      [&](Index chunk, Index begin, Index end)
      {
        for (Index i = begin; i < end; ++i)
        {
          const Index cell = block.cell(i);
          visit(ofChunk[chunk], cell, validity[cell], measured ? &values[cell] : nullptr);
        }
      });
    all.insert(all.end(), ofChunk.begin(), ofChunk.end());
  }
  return all;
}

/// What a chunk of elements has.
struct Extremes
{
  bool valid = true;
  Index undefined = std::numeric_limits<Index>::max(); ///< the first valid cell without a value
  double smallest = std::numeric_limits<double>::infinity(), largest = -smallest;
};
}

std::vector<signed char> cellValidity(const Mesh& mesh, int threads)
{
  std::vector<signed char> validity(mesh.view().numberOfCells);
  mesh.classifyCells(validity.data(), threads);
  return validity;
}

//------------------------------------------------------------------------------
Metric worstMetric(const Mesh& mesh, const OptimizeOptions& options)
{
  if (options.worstMetric)
  {
    return *options.worstMetric;
  }
  bool simplices = true, defined = true;
  for (const CellBlock& block : mesh.blocks())
  {
    const bool element = isElement(mesh, block.type) && block.count > 0;
    simplices = simplices && (!element || topology(block.type).samples == 1);
    defined = defined && (!element || metricInfo(Metric::ScaledJacobian).definedOn(block.type));
  }
  return options.improveWorst > 0 && !simplices && defined ? Metric::ScaledJacobian
                                                           : options.objectives[0].metric;
}

//------------------------------------------------------------------------------
Objective judgedBy(Metric metric, const OptimizeOptions& options)
{
  Objective judged = options.objectives[0];
  if (metric != judged.metric)
  {
    judged = Objective();
    judged.metric = metric;
  }
  judged.evaluation.threads = options.threads;
  return judged;
}

//------------------------------------------------------------------------------
double sumOfSquares(const std::vector<double>& values, int threads)
{
  std::vector<double> ofChunk(numberOfChunks(static_cast<Index>(values.size())));
  forEachChunk(static_cast<Index>(values.size()), threads,
    [&](Index chunk, Index begin, Index end)
    {
      for (Index i = begin; i < end; ++i)
      {
        ofChunk[chunk] += values[i] * values[i];
      }
    });
  return std::accumulate(ofChunk.begin(), ofChunk.end(), 0.0);
}

//------------------------------------------------------------------------------
QualityGuard::QualityGuard(
  const Mesh& input, const std::vector<signed char>& validity, const OptimizeOptions& options)
  : Input(input)
  , Judged(judgedBy(worstMetric(input, options), options))
{
  const MetricInfo& info = metricInfo(this->Judged.metric);
  this->Larger = info.direction == Direction::LargerIsBetter;
  this->HoldWorst = options.holdWorst;
  if (options.allowInversion)
  {
    return;
  }
  Extremes all;
  for (const Extremes& of : visitElements<Extremes>(input, validity, this->Judged, this->Values,
         [](Extremes&found, Index cell, signed char state, const double*value)
         {
           found.valid = found.valid && state == Valid;
           const bool undefined = value && state == Valid && !std::isfinite(*value);
           found.undefined = undefined ? std::min(found.undefined, cell) : found.undefined;
           found.smallest = value ? std::min(found.smallest, *value) : found.smallest;
           found.largest = value ? std::max(found.largest, *value) : found.largest;
         }))
  {
    all.valid = all.valid && of.valid;
    all.undefined = std::min(all.undefined, of.undefined);
    all.smallest = std::min(all.smallest, of.smallest);
    all.largest = std::max(all.largest, of.largest);
  }
  if (all.undefined < input.view().numberOfCells && (options.holdWorst || options.improveWorst > 0))
  {
    throw Error(noValueToJudge(info, "cell " + std::to_string(all.undefined)));
  }
  this->Worst = this->Larger ? all.smallest : all.largest;
  this->ValidInput = this->Active = all.valid;
  // Elements that the metric does not judge stay valid nevertheless.
  this->HoldWorst =
    this->HoldWorst && info.direction != Direction::Neutral && std::isfinite(this->Worst);
}

QualityGuard::QualityGuard(const Mesh& input, const OptimizeOptions& options)
  : QualityGuard(input, cellValidity(input, options.threads), options)
{
}

//------------------------------------------------------------------------------
bool QualityGuard::worse(double value) const
{
  if (!this->HoldWorst)
  {
    return false;
  }
  const double margin = guardRounding * std::abs(this->Worst);
  return this->Larger ? value < this->Worst - margin : !(value <= this->Worst + margin);
}

//------------------------------------------------------------------------------
std::vector<char> QualityGuard::offenders(
  const Mesh& mesh, const std::vector<signed char>& validity, std::vector<double>& values) const
{
  const std::vector<std::vector<Index>> found =
    visitElements<std::vector<Index>>(mesh, validity, this->Judged, values,
      [this](std::vector<Index>& cells, Index cell, signed char state, const double* value)
      {
        if (state != Valid || (value && this->worse(*value)))
        {
          cells.push_back(cell);
        }
      });
  std::vector<char> flags;
  for (const std::vector<Index>& cells : found)
  {
    flags.resize(cells.empty() ? flags.size() : mesh.view().numberOfCells, 0);
    for (const Index cell : cells)
    {
      flags[cell] = 1;
    }
  }
  return flags;
}

//------------------------------------------------------------------------------
QualityGuard::State QualityGuard::check(OptimizationProblem& problem) const
{
  problem.store();
  State state;
  state.validity = cellValidity(problem.moving(), this->Judged.evaluation.threads);
  state.violated = this->violatedAt(problem.moving(), state.validity, state.values);
  return state;
}

//------------------------------------------------------------------------------
Index QualityGuard::restore(OptimizationProblem& problem, const double* to) const
{
  const MeshView& view = this->Input.view();
  const double* places = to ? to : view.points;
  std::vector<char> restoredPoint(view.numberOfPoints, 0);
  Index restored = 0;
  problem.store();
  std::vector<double> points = problem.points();
  constexpr int maxRounds = 20; // then all points go back
  int round = 0;
  for (bool more = this->Active; more; ++round)
  {
    more = false;
    const Mesh& mesh = problem.moving();
    std::vector<double> values;
    const std::vector<char> flags =
      this->offenders(mesh, cellValidity(mesh, this->Judged.evaluation.threads), values);
    for (Index cell = 0; cell < static_cast<Index>(flags.size()); ++cell)
    {
      const bool back = flags[cell] || round >= maxRounds;
      for (Index n = view.offsets[cell]; back && n < view.offsets[cell + 1]; ++n)
      {
        const Index p = view.connectivity[n];
        if (!restoredPoint[p])
        {
          restoredPoint[p] = 1;
          more = true;
          ++restored;
          std::copy_n(places + 3 * p, 3, points.data() + 3 * p);
        }
      }
    }
    if (more)
    {
      problem.restart(points);
    }
  }
  return restored;
}
}
