// SPDX-License-Identifier: BSD-3-Clause
#include "OptionChecks.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string>

namespace tautline
{
//------------------------------------------------------------------------------
bool needDifferences(const OptimizeOptions& options)
{
  return std::any_of(options.objectives.begin(), options.objectives.end(),
    [](const Objective& objective) { return needsDifferences(objective.metric); });
}

namespace
{
void requireFinite(const double* values, Index count, const char* what)
{
  for (Index i = 0; values && i < count; ++i)
  {
    if (std::isnan(values[i]))
    {
      throw Error(std::string(what) + " of point " + std::to_string(i / 3) + " is NaN.");
    }
  }
}

/// Whether a point has a direction: of a plane or line in which it slides.
bool slides(const double* directions, Index p)
{
  return directions &&
    norm({ directions[3 * p], directions[3 * p + 1], directions[3 * p + 2] }) > 0;
}

/// Whether any boundary point may leave the boundary.
bool boundaryMoves(const Mesh& mesh, const OptimizeOptions& options, const Ranks& ranks)
{
  if (!options.fixed || options.slideSurface)
  {
    return false;
  }
  const std::vector<unsigned char> boundary = ranks.boundary(mesh);
  bool moves = false;
  for (Index p = 0; p < static_cast<Index>(boundary.size()); ++p)
  {
    const bool onModel = options.model && options.parts && options.parts[p] >= 0;
    moves = moves ||
      (boundary[p] && !options.fixed[p] && !onModel && !slides(options.slidePlanes, p) &&
        !slides(options.slideLines, p));
  }
  return ranks.any(moves);
}

/// With a free boundary, a mesh shrinks to a point if smaller elements are better.
void checkSizes(const Mesh& mesh, const OptimizeOptions& options, const Ranks& ranks)
{
  const int dimension = mesh.dimension() == Dimension::Volume ? 3 : 2;
  for (const Objective& objective : options.objectives)
  {
    const MetricInfo& info = metricInfo(objective.metric);
    const bool ofSize = info.lengthPower(dimension) != 0 ||
      (info.family == MetricFamily::Simplex && !info.scaleInvariant);
    if (ofSize && !canUntangle(objective) && boundaryMoves(mesh, options, ranks))
    {
      throw Error(std::string(info.label) +
        " depends on the size of the elements, and the boundary may move: the mesh would shrink "
        "to a point, or grow without bound. Fix the boundary or let it slide, or choose a metric "
        "relative to a target size (" +
        metricInfo(Metric::SizeBarrier).label + ").");
    }
  }
}

/// Throws Error for options that can only combine sums over the whole mesh.
void checkPatches(const OptimizeOptions& options)
{
  const std::string what = "Objectives that are combined on patches need ";
  if (isGlobal(options.optimizer) || needDifferences(options))
  {
    throw Error(what +
      "a local optimizer, and metrics with analytic derivatives: choose "
      "Automatic, Local Newton or Local Conjugate Gradient.");
  }
  const auto hasNoPatches = [](const Objective& objective)
  {
    return objective.objectiveTemplate == ObjectiveTemplate::PowerMean ||
      objective.objectiveTemplate == ObjectiveTemplate::Maximum;
  };
  if (std::any_of(options.objectives.begin(), options.objectives.end(), hasNoPatches))
  {
    throw Error(what +
      "sums over the elements: choose another template than power mean and "
      "maximum.");
  }
}

/// Throws Error if a metric without analytic derivatives is an objective of a method that needs
/// them.
void checkDifferences(const Mesh& mesh, const OptimizeOptions& options)
{
  if (!needDifferences(options))
  {
    return;
  }
  const std::string what = "A metric without analytic derivatives, such as a Python metric, ";
  if (isLocal(options.optimizer) || options.optimizer == Optimizer::NewtonConjugateGradient)
  {
    throw Error(what +
      "is optimized with finite differences for all points at once: choose Automatic, L-BFGS "
      "or a conjugate gradient, or register it in C++.");
  }
  if (options.improveWorst > 0)
  {
    throw Error(
      what + "cannot improve the worst element: set Improve Worst to 0, or register it in C++.");
  }
  if (mesh.dimension() == Dimension::Surface || options.slideSurface || options.model ||
    options.limits)
  {
    throw Error(what +
      "only moves points in a plane or in space with a fixed boundary, or along flat parts: "
      "register it in C++ to let them slide on surfaces or to limit their displacement.");
  }
}

/// The metric of the worst element must have a value for each element, and a direction of
/// improvement.
void checkWorstMetric(const Mesh& mesh, Metric metric)
{
  const MetricInfo& info = metricInfo(metric);
  if (info.direction == Direction::Neutral)
  {
    throw Error(std::string(info.label) +
      " has no direction of improvement: choose another metric for the worst element.");
  }
  const int dimension = mesh.dimension() == Dimension::Volume ? 3 : 2;
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    if (t.dimension == dimension && block.count > 0 && !info.definedOn(block.type))
    {
      throw Error(std::string(info.label) + " is not defined on every element (there is a " +
        t.name + "): choose another metric for the worst element.");
    }
  }
}
}

//------------------------------------------------------------------------------
void checkOptions(const Mesh& mesh, const OptimizeOptions& options, const Ranks& ranks)
{
  const StoppingCriteria& stop = options.stopping;
  if (options.objectives.empty())
  {
    throw Error("There is no objective: add one, for example the inverse mean ratio.");
  }
  if (stop.maximumIterations < 0 || !(stop.maximumSeconds >= 0) || !(stop.gradientNorm >= 0) ||
    !(stop.relativeChange >= 0) || !(stop.reduction > 0 && stop.reduction <= 1))
  {
    throw Error(
      "Stopping criteria must not be negative, and the fraction of the possible reduction must "
      "lie between 0 (exclusive) and 1.");
  }
  if (!(options.relaxation > 0 && options.relaxation < 2))
  {
    throw Error("The relaxation must lie between 0 and 2 (both exclusive); 1 is Newton's step.");
  }
  if (options.patchIterations < 1 || !(options.culling >= 0) || !(options.improveWorst >= 0))
  {
    throw Error("Patch iterations must be at least 1; culling and the allowance of the mean "
                "for the worst element must not be negative.");
  }
  if (options.leaving && !options.fixed)
  {
    throw Error("Points that may leave the surface need the flags of the fixed points.");
  }
  if (options.leaving && (options.limits || options.onGeometry))
  {
    throw Error("Points that may leave the surface cannot have other limits or a surface other "
                "than the mesh: remove these options.");
  }
  const bool global = isGlobal(options.optimizer);
  checkDifferences(mesh, options);
  if (options.objectives.size() > 1 && options.scalarization.onPatches)
  {
    checkPatches(options);
  }
  if (options.model && !options.parts)
  {
    throw Error("A model needs the part on which each point slides.");
  }
  const bool surface = mesh.dimension() == Dimension::Surface;
  if (global && (surface || options.slideSurface || options.model || options.limits))
  {
    throw Error(std::string(surface  ? "A surface in space needs"
                    : options.limits ? "Limits on the displacement of points need"
                                     : "Sliding on a boundary or on interfaces needs") +
      " a local optimizer: choose Automatic or Local Newton.");
  }
  checkSizes(mesh, options, ranks);
  if (options.worstMetric)
  {
    checkWorstMetric(mesh, *options.worstMetric);
  }
  requireFinite(options.limits, mesh.view().numberOfPoints, "The limit");
  requireFinite(options.slidePlanes, 3 * mesh.view().numberOfPoints, "The slide plane");
  requireFinite(options.slideLines, 3 * mesh.view().numberOfPoints, "The slide line");
}

//------------------------------------------------------------------------------
bool slidesInUntangling(const Mesh& mesh, const OptimizeOptions& options, const Ranks& ranks)
{
  const Dimension dimension = mesh.dimension();
  return (options.model || options.slidePlanes || options.slideLines) && !options.limits &&
    !ranks.several() && (dimension == Dimension::Planar || dimension == Dimension::Volume);
}

//------------------------------------------------------------------------------
std::vector<unsigned char> heldInUntangling(
  const OptimizeOptions& options, Index points, bool slidesThen)
{
  std::vector<unsigned char> held;
  if (!options.fixed && !options.model && !options.limits)
  {
    return held;
  }
  for (Index p = 0; p < points; ++p)
  {
    held.push_back((options.fixed && options.fixed[p]) ||
      (options.limits && !(options.limits[p] > 0)) ||
      (options.slideSurface && options.slideSurface[p]) ||
      (!slidesThen &&
        ((options.model && options.parts[p] >= 0) || slides(options.slidePlanes, p) ||
          slides(options.slideLines, p))));
  }
  return held;
}

//------------------------------------------------------------------------------
UntangleOptions untanglingFirst(const OptimizeOptions& options,
  const std::vector<unsigned char>& held, bool slidesThen, const Stopwatch& clock, bool& proceed)
{
  UntangleOptions untangling;
  untangling.fixed = held.empty() ? nullptr : held.data();
  if (slidesThen)
  {
    untangling.slidePlanes = options.slidePlanes;
    untangling.slideLines = options.slideLines;
    untangling.model = options.model;
    untangling.parts = options.parts;
    untangling.surfaceTolerance = options.surfaceTolerance;
  }
  untangling.threads = options.threads;
  if (options.stopping.maximumSeconds > 0)
  {
    // 0 would be no limit.
    untangling.maximumSeconds = std::max(
      std::numeric_limits<double>::min(), options.stopping.maximumSeconds - clock.seconds());
  }
  untangling.observer = [&](const IterationState& state)
  {
    IterationRecord record = state.record;
    record.objectives.assign(options.objectives.size(), 0.0);
    record.mean = record.worst = record.objectives;
    return proceed = !options.observer || options.observer({ record, 0.0, state.points });
  };
  return untangling;
}

//------------------------------------------------------------------------------
void requireWithinLimits(const OptimizeOptions& options, const double* start,
  const std::vector<double>& points, const Ranks& ranks)
{
  constexpr double rounding = 1e-9; // relative
  Index beyond = 0;
  for (std::size_t p = 0; options.limits && p < points.size() / 3; ++p)
  {
    const double *x = &points[3 * p], *from = start + 3 * p;
    const double way = std::hypot(x[0] - from[0], x[1] - from[1], x[2] - from[2]);
    beyond +=
      way > (1 + rounding) * std::max(0.0, options.limits[p]) && ranks.owns(static_cast<Index>(p));
  }
  beyond = ranks.sum(beyond);
  if (beyond > 0)
  {
    throw Error("The elements are untangled first, and that moves " + std::to_string(beyond) +
      " points farther than their limits: raise the limits of the displacement, or run "
      "Untangle Mesh first, so that the limits are relative to its result.");
  }
}

//------------------------------------------------------------------------------
void requireValues(const std::vector<Objective>& objectives, const std::vector<double>& values)
{
  for (std::size_t i = 0; i < objectives.size(); ++i)
  {
    const MetricInfo& info = metricInfo(objectives[i].metric);
    if (info.user && !std::isfinite(values[i]))
    {
      throw Error("The metric \"" + std::string(info.label) +
        "\" has no finite value on some element, or the sum of its values is too large. Its "
        "formula must have a value on every valid element: Element Quality shows 0 where it is "
        "undefined.");
    }
  }
}

//------------------------------------------------------------------------------
NeedOfWholeMesh needOfWholeMesh(const OptimizeOptions& options)
{
  if (options.model || options.slideSurface)
  {
    return { "points that slide on curved surfaces, features and geometries",
      "choose the Boundary Fixed, Slide on flat parts (sliding) or Free" };
  }
  if (options.improveWorst > 0)
  {
    return { "steps that improve the worst element",
      "set Improve Worst to 0, or choose the preset Best Shape" };
  }
  for (const Objective& objective : options.objectives)
  {
    if (objective.objectiveTemplate == ObjectiveTemplate::PowerMean ||
      objective.objectiveTemplate == ObjectiveTemplate::Maximum)
    {
      return { "the templates p-Mean and Maximum", "choose a sum" };
    }
  }
  return {};
}

void requireLocalOptions(const OptimizeOptions& options)
{
  needOfWholeMesh(options).refuse();
}
}
