// SPDX-License-Identifier: BSD-3-Clause
#include "QualityGuard.h"

#include "tautline/Core/Parallel.h"
#include "tautline/Mesh/MeshElements.h"
#include "tautline/Quality/JudgedValues.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>

namespace tautline
{
namespace
{
/**
 * @brief Calls visit(found, cell, validity, value) for each element of the mesh dimension, with one
 * object for the elements of a chunk; value is null if the metric is undefined.
 * @param values set to the values of the metric
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

/// The extremes of a chunk of elements.
struct Extremes
{
  bool valid = true;
  Index undefined = std::numeric_limits<Index>::max(); ///< the first valid cell without a value
  double smallest = std::numeric_limits<double>::infinity(), largest = -smallest;
};

/// Describes a cell. On several ranks, cell numbers are local, but the position is independent of
/// the ranks.
std::string placeOf(const Mesh& mesh, Index cell, const Ranks& ranks)
{
  if (!ranks.several())
  {
    return "cell " + std::to_string(cell);
  }
  const Vec3 p = pointOf(mesh.view(), mesh.view().connectivity[mesh.view().offsets[cell]]);
  std::ostringstream place;
  place << "a cell at the point (" << p[0] << ", " << p[1] << ", " << p[2] << ")";
  return place.str();
}
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
QualityGuard::QualityGuard(const Mesh& input, const std::vector<signed char>& validity,
  const OptimizeOptions& options, const Ranks& ranks)
  : Input(input)
  , TheRanks(ranks)
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
    throw Error(noValueToJudge(info, placeOf(input, all.undefined, ranks)));
  }
  this->Worst = this->Larger ? -ranks.maximum(-all.smallest) : ranks.maximum(all.largest);
  this->ValidInput = this->Active = !ranks.any(!all.valid);
  this->OnPatches = options.objectives.size() > 1 && options.scalarization.onPatches;
  // Elements without a metric value must still stay valid.
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
  std::vector<unsigned char> restored(view.numberOfPoints, 0), back = restored;
  problem.store();
  std::vector<double> points = problem.points();
  constexpr int maxRounds = 20; // after which all points are moved back
  for (int round = 0; this->Active; ++round)
  {
    const Mesh& mesh = problem.moving();
    std::vector<double> values;
    std::vector<char> flags =
      this->offenders(mesh, cellValidity(mesh, this->Judged.evaluation.threads), values);
    if (round >= maxRounds && this->TheRanks.any(!flags.empty()))
    {
      flags.assign(view.numberOfCells, 1);
    }
    for (Index cell = 0; cell < static_cast<Index>(flags.size()); ++cell)
    {
      for (Index n = view.offsets[cell]; flags[cell] && n < view.offsets[cell + 1]; ++n)
      {
        back[view.connectivity[n]] = 1;
      }
    }
    this->TheRanks.exchange(back.data());
    if (!this->TheRanks.any(back != restored))
    {
      break;
    }
    restored = back;
    for (Index p = 0; p < view.numberOfPoints; ++p)
    {
      std::copy_n(places + 3 * p, restored[p] ? 3 : 0, points.data() + 3 * p);
    }
    problem.restart(points);
  }
  Index count = 0;
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    count += restored[p] && this->TheRanks.owns(p);
  }
  return this->TheRanks.sum(count);
}
}
