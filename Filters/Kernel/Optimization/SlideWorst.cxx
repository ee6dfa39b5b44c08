// SPDX-License-Identifier: BSD-3-Clause
#include "SlideWorst.h"

#include "tautline/Sliding/ImproveSliding.h"

#include <cmath>
#include <memory>

namespace tautline
{
//------------------------------------------------------------------------------
bool canSlideWorst(const OptimizationProblem& problem, const Objective& judged)
{
  const OptimizeOptions& options = problem.options();
  const Dimension dimension = problem.moving().dimension();
  const bool measured = judged.metric == Metric::ScaledJacobian ||
    (judged.metric == Metric::InverseMeanRatio && !judged.evaluation.targets);
  return measured && (dimension == Dimension::Planar || dimension == Dimension::Volume) &&
    !problem.ranks().several() && !options.limits;
}

namespace
{
/// The surface of a mesh without features, for points that slide on it directly.
struct WholeSurface
{
  WholeSurface(const Mesh& mesh, const unsigned char* slides)
  {
    FeatureOptions options;
    options.angle = 180;
    const Features features = findFeatures(mesh, options);
    this->model = makeSurfaceModel(mesh, features, false);
    this->parts = partsOfPoints(features);
    for (std::size_t p = 0; p < this->parts.size(); ++p)
    {
      this->parts[p] = slides[p] ? this->parts[p] : -1;
    }
  }
  SurfaceModel model;
  std::vector<std::int32_t> parts;
};
}

//------------------------------------------------------------------------------
bool slideWorst(const Mesh& mesh, OptimizationProblem& problem, const QualityGuard& guard,
  const WorstLimits& limits, const std::function<bool(const IterationRecord&)>& report)
{
  problem.store();
  const OptimizeOptions& options = problem.options();
  const Objective& judged = guard.judged();
  const std::vector<double> start = problem.points();
  std::vector<unsigned char> fixed;
  if (!options.fixed)
  {
    const std::vector<char> boundary = mesh.boundary().isBoundaryPoint;
    fixed.assign(boundary.begin(), boundary.end());
  }
  BoundaryConstraints constraints = options;
  constraints.fixed = options.fixed ? options.fixed : fixed.data();
  std::unique_ptr<WholeSurface> whole;
  if (options.slideSurface && !options.model)
  {
    whole = std::make_unique<WholeSurface>(mesh, options.slideSurface);
    constraints.model = &whole->model;
    constraints.parts = whole->parts.data();
  }

  const IterationRecord first = problem.record(0);
  const double sign =
    metricInfo(options.objectives[0].metric).direction == Direction::LargerIsBetter ? -1 : 1;
  const double mean = limits.mean.value_or(first.mean[0]);
  const double bound = mean + sign * limits.allowance * std::abs(mean);
  bool stopped = false, enough = false;
  SlidingImprovement improvement;
  improvement.measure = judged.metric == Metric::ScaledJacobian ? CornerMeasure::ScaledJacobian
                                                                : CornerMeasure::MeanRatio;
  improvement.threads = options.threads;
  improvement.accept = [&](const std::vector<double>& points)
  {
    problem.restart(points);
    const IterationRecord now = problem.record(0);
    const double worst = problem.worstMovable(judged, problem.measure(judged));
    const bool affordable = sign * (now.mean[0] - bound) <= 0 || guard.worse(worst);
    const bool accepted = affordable && now.inverted <= first.inverted;
    if (accepted)
    {
      stopped = !report(now);
      enough = limits.onlyAsInput && !guard.worse(worst);
    }
    return accepted;
  };
  improvement.proceed = [&] { return !stopped && !enough && !problem.outOfTime(); };
  problem.restart(improveSliding(mesh, constraints, start, improvement));
  return problem.outOfTime() && !stopped;
}
}
