#include "QualityGuard.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
/// Values of the same element differ by so much, relatively, with the order of its operations.
constexpr double rounding = 1e-9;

bool isElement(const Mesh& mesh, CellType type)
{
  return topology(type).dimension == (mesh.dimension() == Dimension::Volume ? 3 : 2);
}

/// Calls visit(cell, validity, value) for each element of the mesh's dimension; value is null where
/// the metric is not defined.
template <class Visit>
void forEachElement(const Mesh& mesh, const Objective& judged, const Visit& visit)
{
  const Index cells = mesh.view().numberOfCells;
  std::vector<signed char> validity(cells);
  std::vector<double> values(cells);
  mesh.classifyCells(validity.data(), judged.evaluation.threads);
  evaluateMetric(mesh, judged.metric, judged.evaluation, values.data());
  for (const CellBlock& block : mesh.blocks())
  {
    const bool measured = metricInfo(judged.metric).definedOn(block.type);
    for (Index i = 0; isElement(mesh, block.type) && i < block.count; ++i)
    {
      const Index cell = block.cell(i);
      visit(cell, validity[cell], measured ? &values[cell] : nullptr);
    }
  }
}
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
QualityGuard::QualityGuard(const Mesh& input, const OptimizeOptions& options)
  : Input(input)
  , Judged(options.objectives[0])
{
  const Metric metric = worstMetric(input, options);
  if (metric != this->Judged.metric)
  {
    this->Judged = Objective();
    this->Judged.metric = metric;
  }
  this->Judged.evaluation.threads = options.threads;
  const MetricInfo& info = metricInfo(metric);
  this->Larger = info.direction == Direction::LargerIsBetter;
  this->HoldWorst = options.holdWorst;
  if (options.allowInversion)
  {
    return;
  }
  const double infinity = std::numeric_limits<double>::infinity();
  this->Worst = this->Larger ? infinity : -infinity;
  bool valid = true;
  forEachElement(input, this->Judged,
    [&](Index, signed char validity, const double* value)
    {
      valid = valid && validity == Valid;
      if (value)
      {
        this->Worst = this->Larger ? std::min(this->Worst, *value) : std::max(this->Worst, *value);
      }
    });
  this->ValidInput = this->Active = valid;
  // Elements that the metric does not judge stay valid nevertheless.
  this->HoldWorst =
    this->HoldWorst && info.direction != Direction::Neutral && std::isfinite(this->Worst);
}

//------------------------------------------------------------------------------
bool QualityGuard::worse(double value) const
{
  if (!this->HoldWorst)
  {
    return false;
  }
  const double margin = rounding * std::abs(this->Worst);
  return this->Larger ? value < this->Worst - margin : !(value <= this->Worst + margin);
}

//------------------------------------------------------------------------------
std::vector<char> QualityGuard::offenders(const Mesh& mesh) const
{
  std::vector<char> flags;
  forEachElement(mesh, this->Judged,
    [&](Index cell, signed char validity, const double* value)
    {
      if (validity != Valid || (value && this->worse(*value)))
      {
        flags.resize(mesh.view().numberOfCells, 0);
        flags[cell] = 1;
      }
    });
  return flags;
}

//------------------------------------------------------------------------------
bool QualityGuard::violated(OptimizationProblem& problem) const
{
  problem.store();
  return this->Active && !this->offenders(problem.moving()).empty();
}

//------------------------------------------------------------------------------
Index QualityGuard::restore(OptimizationProblem& problem) const
{
  const MeshView& view = this->Input.view();
  std::vector<char> restoredPoint(view.numberOfPoints, 0);
  Index restored = 0;
  problem.store();
  std::vector<double> points = problem.points();
  constexpr int maxRounds = 20; // then all points go back
  int round = 0;
  for (bool more = this->Active; more; ++round)
  {
    more = false;
    const std::vector<char> flags = this->offenders(problem.moving());
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
          std::copy_n(view.points + 3 * p, 3, points.data() + 3 * p);
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
