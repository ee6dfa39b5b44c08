// SPDX-License-Identifier: BSD-3-Clause
#include "OptimizeOnRanks.h"

#include "OptimizationOnRanks.h"
#include "OptionChecks.h"
#include "RankSweep.h"
#include "tautline/Mesh/BoundaryPoints.h"
#include "tautline/Mesh/CoordinateFrame.h"
#include "tautline/Mesh/JacobianBounds.h"
#include "tautline/Mesh/MeshElements.h"
#include "tautline/Objectives/ObjectiveSumState.h"
#include "tautline/Untangling/Untangle.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>

namespace tautline
{
namespace
{
/// The bounds of points and the scale of edges of the whole mesh.
SimplexFrame frameOf(const DistributedMesh& mesh, const std::vector<double>& points)
{
  RankGroup& group = mesh.group();
  SimplexFrame frame;
  for (int c = 0; c < 3; ++c)
  {
    double low = infinity, high = -infinity;
    for (Index p = 0; p < mesh.localPoints(); ++p)
    {
      low = std::min(low, points[3 * p + c]);
      high = std::max(high, points[3 * p + c]);
    }
    frame.low[c] = -group.maximum(-low);
    frame.high[c] = group.maximum(high);
  }
  std::vector<double> lengths;
  const MeshView& view = mesh.view();
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const Index* node = view.connectivity + view.offsets[cell];
    if (mesh.ownedCells()[cell])
    {
      const double* a = &points[3 * node[0]];
      const double* b = &points[3 * node[1]];
      lengths.push_back(norm({ b[0] - a[0], b[1] - a[1], b[2] - a[2] }));
    }
  }
  frame.scale = powerOfTwo(
    group.orderlessSum(lengths) / static_cast<double>(std::max<Index>(1, mesh.globalCells())));
  return frame;
}

}

//------------------------------------------------------------------------------
OptimizationOnRanks::OptimizationOnRanks(
  DistributedMesh& mesh, bool mirrored, const OptimizeOptions& options)
  : TheMesh(mesh)
  , Group(mesh.group())
  , Mirrored(mirrored)
  , Options(options)
  , Points(mesh.points())
  , Watch(options, [this] { return this->outOfTime(); })
{
  // To the checks, what is at the edge of this part only is not on the boundary.
  const std::vector<unsigned char> boundary = rankBoundary(mesh);
  requireLocalOptions(options);
  requireOrdinaryScale(mesh.view(), "Optimization");
  if (mesh.view().numberOfCells > 0)
  {
    this->Start = std::make_unique<Mesh>(mesh.view(), options.threads);
    this->Start->setMirrored(mirrored);
    std::vector<unsigned char> held(boundary.size());
    std::transform(boundary.begin(), boundary.end(), options.fixed, held.begin(),
      [](unsigned char on, unsigned char fixed) { return !on || fixed; });
    OptimizeOptions checked = options;
    checked.fixed = held.data();
    checkOptions(*this->Start, checked);
  }
  this->agree();
}

//------------------------------------------------------------------------------
/// Throws Error if the parts are not of one dimension and, if planar, in one plane.
void OptimizationOnRanks::agree()
{
  const auto own = static_cast<Index>(this->Start ? this->Start->dimension() : Dimension::None);
  const Index highest = this->Group.maximum(own);
  const bool differ = this->Group.any(this->Start && own != highest);
  this->Coordinates = highest == static_cast<Index>(Dimension::Planar) ? 2 : 3;
  const auto& box = this->TheMesh.bounds();
  const bool planar = highest == static_cast<Index>(Dimension::Planar) && !differ &&
    (box[0] == box[3] || box[1] == box[4] || box[2] == box[5]);
  if (highest == static_cast<Index>(Dimension::None) ||
    (highest == static_cast<Index>(Dimension::Volume) && !differ) || planar)
  {
    return;
  }
  throw Error("A mesh on several processes, or in the reproducible order, is a volume mesh or lies "
              "in a plane at right angles to an axis, and this one does not: gather it on one "
              "process, in ParaView by Aggregate Dataset, with Reproducible Order off.");
}

//------------------------------------------------------------------------------
/// The local part of the problem from Points on, in the frame of the whole mesh.
void OptimizationOnRanks::makeProblem()
{
  const SimplexFrame frame = frameOf(this->TheMesh, this->Points);
  std::vector<unsigned char> closed;
  this->Problem.reset();
  if (this->Start)
  {
    this->Problem = std::make_unique<OptimizationProblem>(
      *this->Start, this->Options, this->Points, this->Clock, &frame);
  }
  this->rescaleUntangling();
  if (this->Problem)
  {
    closed = this->Problem->closedForms();
    const bool weighted = std::any_of(this->Problem->resolved().begin(),
      this->Problem->resolved().end(), [](const Objective& o) { return o.elementWeights; });
    closed.push_back(!weighted);
  }
  // An objective is in closed form on all ranks or on none.
  std::vector<unsigned char> agreed(this->Options.objectives.size() + 1, 1);
  for (const auto& list : this->Group.gatherItems(closed))
  {
    for (std::size_t i = 0; i < list.size(); ++i)
    {
      agreed[i] = agreed[i] && list[i];
    }
  }
  const bool allFast = std::all_of(agreed.begin(), agreed.end() - 1, [](char f) { return f; });
  if (!allFast && !agreed.back())
  {
    agreed.assign(agreed.size(), 0); // weights of cells differ by objective
  }
  std::vector<unsigned char>& free = this->Free;
  free.assign(this->TheMesh.localPoints(), 0);
  this->Rows.reset();
  if (this->Problem)
  {
    this->Problem->keepClosedForms(agreed);
    this->Resolved = this->Problem->resolved();
    for (std::int32_t v = 0; v < this->Problem->simplices().freeVertices(); ++v)
    {
      free[this->Problem->simplices().point(v)] = 1;
    }
  }
  this->checkWeights(agreed);
  this->Sets = this->TheMesh.independentSets(free);
  Index count = 0;
  for (Index p = 0; p < this->TheMesh.localPoints(); ++p)
  {
    count += free[p] && this->TheMesh.owned(p);
  }
  this->Result.freeVertices = this->Group.sum(count);
}

//------------------------------------------------------------------------------
/// By the largest element values of all ranks.
void OptimizationOnRanks::rescaleUntangling()
{
  std::vector<double> largest;
  largest = this->Problem ? this->Problem->largestValues() : std::vector<double>();
  const Index count = this->Group.maximum(static_cast<Index>(largest.size()));
  largest.resize(static_cast<std::size_t>(count), 0.0);
  for (double& value : largest)
  {
    value = this->Group.maximum(value);
  }
  if (this->Problem)
  {
    this->Problem->rescaleUntangling(largest);
  }
}

//------------------------------------------------------------------------------
/// Throws Error if all weights of an objective that is not in closed form are 0, on all ranks.
void OptimizationOnRanks::checkWeights(const std::vector<unsigned char>& closed)
{
  const MeshView& view = this->TheMesh.view();
  for (std::size_t i = 0; i < this->Options.objectives.size(); ++i)
  {
    if (closed[i])
    {
      continue;
    }
    const MetricInfo& info = metricInfo(this->Options.objectives[i].metric);
    const double* weights = this->Problem ? this->Resolved[i].elementWeights : nullptr;
    bool defined = false, counts = false;
    for (Index cell = 0; this->Problem && cell < view.numberOfCells && !counts; ++cell)
    {
      const CellType type = cornerType(view.cellTypes[cell]);
      const bool has = type != CellType::Unsupported && isElement(this->Problem->moving(), type) &&
        info.definedOn(type);
      defined = defined || has;
      counts = has && (!weights || weights[cell] > 0);
    }
    defined = this->Group.any(defined);
    if (!this->Group.any(counts))
    {
      throwNoElements(info, defined);
    }
  }
}

//------------------------------------------------------------------------------
IterationRecord OptimizationOnRanks::record(int iteration)
{
  IterationRecord record;
  record.iteration = iteration;
  std::vector<signed char> validity;
  Index invalid = 0;
  validity.resize(this->TheMesh.view().numberOfCells);
  if (this->Problem)
  {
    this->Problem->moving().classifyCells(validity.data(), this->Options.threads);
  }
  for (std::size_t cell = 0; cell < validity.size(); ++cell)
  {
    invalid += this->TheMesh.ownedCells()[cell] && isInvalid(validity[cell]);
  }
  record.inverted = this->Group.sum(invalid);
  for (std::size_t i = 0; i < this->Options.objectives.size(); ++i)
  {
    addObjectiveOnRanks(this->TheMesh,
      this->Problem ? this->Resolved[i] : this->Options.objectives[i],
      this->Problem ? &this->Problem->moving() : nullptr, validity, record);
  }
  record.objective = this->TheScalarizer && record.objectives.size() > 1
    ? this->TheScalarizer->value(record.objectives)
    : record.objectives[0];
  record.seconds = this->Clock.seconds();
  return record;
}

//------------------------------------------------------------------------------
/// Adds a record to the history and calls the observers; false if one stops the run.
bool OptimizationOnRanks::report(const IterationRecord& record)
{
  this->Result.history.push_back(presentable(*this->TheScalarizer, record));
  bool proceed = true;
  const auto points = [&](double* to) { std::copy(this->Points.begin(), this->Points.end(), to); };
  proceed = !this->Options.observer ||
    this->Options.observer({ this->Result.history.back(), this->Watch.progress(record), points });
  return !this->Group.any(!proceed);
}

//------------------------------------------------------------------------------
void OptimizationOnRanks::store()
{
  if (this->Problem)
  {
    this->Problem->store();
  }
  this->TheMesh.exchange(this->Points.data(), 3);
}

void OptimizationOnRanks::restart(const std::vector<double>& points)
{
  const std::vector<double> to = points;
  this->Points = to;
  if (this->Problem)
  {
    this->Problem->restart(to);
  }
}

//------------------------------------------------------------------------------
/// Sweeps to convergence; see optimizeLocally() in Optimize.cxx.
StopReason OptimizationOnRanks::sweep(Slowness* slow, bool& failed, bool& repaired)
{
  RankSweeper sweeper(this->TheMesh, this->Problem.get(), this->Sets, this->Options.threads);
  std::vector<double> best = this->Points;
  StopReason reason = StopReason::NoProgress;
  double firstGradient = 0;
  bool all = true;
  const bool costly = this->Group.any(this->Problem && !this->Problem->isSimple());
  SweepGains gains(costly);
  for (int iteration = this->Result.history.back().iteration + 1;; ++iteration)
  {
    if (this->Watch.ends(this->Result.history, reason))
    {
      return reason;
    }
    const IterationRecord before = this->Result.history.back();
    const SweepResult swept = sweeper.sweep(*this->TheScalarizer, before.objectives);
    this->store();
    IterationRecord now = this->record(iteration);
    now.gradientNorm = swept.gradientNorm;
    now.moving = swept.moved;
    const double lowered = scalarized(*this->TheScalarizer, before) - now.objective;
    const double size = std::abs(now.objective);
    if (!(std::isfinite(size) && lowered >= -roundingOfSums * size))
    {
      this->restart(best);
      failed = true;
      return StopReason::NoProgress;
    }
    best = this->Points;
    firstGradient = firstGradient > 0 ? firstGradient : swept.gradientNorm;
    if (!this->report(now))
    {
      return StopReason::Aborted;
    }
    const bool some = this->Group.any(this->Problem && this->Problem->someRepaired());
    if (some && !this->Watch.ends(this->Result.history, reason))
    {
      repaired = true;
      return StopReason::NoProgress;
    }
    gains.add(lowered);
    const StoppingCriteria& stop = this->Options.stopping;
    if (slow && (gains.stiff(size) || gains.slow(size, stop.relativeChange)))
    {
      *slow = gains.stiff(size) ? Slowness::Far : Slowness::Near;
      return StopReason::NoProgress;
    }
    if (!converged(stop, swept, all, firstGradient, lowered, gains.remaining(), gains.remaining(),
          size, reason))
    {
      all = swept.moved == 0;
    }
    else if (!all)
    {
      all = true;
    }
    else if (this->TheScalarizer->next(this->Result.history.back().objectives))
    {
      gains.clear();
      firstGradient = 0;
    }
    else
    {
      return reason;
    }
    if (all)
    {
      sweeper.wakeAll();
    }
  }
}

//------------------------------------------------------------------------------
/// Optimizes from Points on; whether there is more to do, with elements that have become valid.
bool OptimizationOnRanks::stage()
{
  this->makeProblem();
  const bool again = !this->Result.history.empty();
  this->TheScalarizer.reset();
  IterationRecord first = this->record(again ? this->Result.history.back().iteration : 0);
  if (!again)
  {
    requireValues(this->Options.objectives, first.objectives);
  }
  std::vector<double> weights;
  for (const Objective& objective : this->Options.objectives)
  {
    weights.push_back(objective.weight);
  }
  this->TheScalarizer =
    std::make_unique<Scalarizer>(this->Options.scalarization, weights, first.objectives);
  first.objective = first.objectives.size() > 1 ? this->TheScalarizer->value(first.objectives)
                                                : first.objectives[0];
  if (again)
  {
    this->Result.history.back().objective = first.objective;
    this->Result.history.back().objectives = first.objectives;
  }
  else if (!this->report(first))
  {
    this->Result.reason = StopReason::Aborted;
    return false;
  }
  if (this->Result.freeVertices == 0)
  {
    this->Result.reason = StopReason::NoFreeVertices;
    return false;
  }
  const bool repaired =
    movePoints(*this, this->Options, false, first, this->Result.history, this->Result.reason);
  if (!repaired)
  {
    this->settleWorst();
    this->keepInput(first);
  }
  return repaired;
}

//------------------------------------------------------------------------------
/// False if the observer stopped it on any rank.
bool OptimizationOnRanks::untangle()
{
  const auto& objectives = this->Options.objectives;
  if (this->Result.invertedBefore == 0 ||
    std::any_of(objectives.begin(), objectives.end(), canUntangle))
  {
    return true;
  }
  if (!this->Options.untangleFirst)
  {
    throw Error(std::to_string(this->Result.invertedBefore) +
      " elements are inverted or degenerate, and no objective repairs them: untangle first, or add "
      "the untangling metric.");
  }
  const std::vector<unsigned char> held =
    heldInUntangling(this->Options, static_cast<Index>(this->Points.size() / 3));
  bool proceed = true;
  const UntangleOptions options = untanglingFirst(this->Options, held, this->Clock, proceed);
  Mesh local(this->TheMesh.view(), options.threads);
  local.setMirrored(this->Mirrored);
  UntangleResult found = tautline::untangle(local, options, Ranks(this->TheMesh));
  this->Points = std::move(found.points);
  this->Result.newlyInvalid = found.newlyInvalid;
  this->Result.untangled = true;
  if (this->Group.any(!proceed))
  {
    return false;
  }
  requireWithinLimits(this->Group.sum(beyondLimits(this->Options, this->TheMesh.points().data(),
    this->Points, [this](Index p) { return this->TheMesh.owned(p); })));
  return true;
}

//------------------------------------------------------------------------------
OptimizeResult OptimizationOnRanks::run()
{
  this->Result.points = this->Points;
  if (this->TheMesh.globalCells() == 0)
  {
    this->Result.reason = StopReason::NoFreeVertices;
    return this->Result;
  }
  const int threads = this->Options.threads;
  this->Result.invertedBefore =
    countInvalidOnRanks(this->TheMesh, this->Mirrored, this->Points, threads);
  this->Guard = std::make_unique<RankGuard>(
    this->TheMesh, this->Mirrored, this->Options, this->Result.invertedBefore == 0);
  if (!this->untangle())
  {
    this->Result.reason = StopReason::Aborted;
    this->Result.points = this->Points;
    this->Result.invertedAfter =
      countInvalidOnRanks(this->TheMesh, this->Mirrored, this->Points, threads);
    return this->Result;
  }
  const Index invalid = countInvalidOnRanks(this->TheMesh, this->Mirrored, this->Points, threads);
  const std::vector<double> start = this->Points;
  while (this->stage())
  {
  }
  this->TheMesh.exchange(this->Points.data(), 3);
  this->Result.points = this->Points;
  this->Result.iterations = this->Result.history.back().iteration;
  this->Result.invertedAfter =
    countInvalidOnRanks(this->TheMesh, this->Mirrored, this->Points, threads);
  if (this->Result.invertedAfter > invalid && !this->Options.allowInversion)
  {
    // Coordinates of too different magnitudes.
    this->Points = start;
    this->Result.keepStart(start, invalid);
  }
  return this->Result;
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
  NeedOfWholeMesh need = needOfWholeMesh(options);
  if (!need.what.empty())
  {
    need.what[0] = static_cast<char>(std::toupper(need.what[0]));
    throw Error(need.what +
      " need the whole mesh on one process: gather it, in ParaView by Aggregate Dataset, with "
      "Reproducible Order off; or " +
      need.remedy + ".");
  }
}

//------------------------------------------------------------------------------
OptimizeResult optimizeOnRanks(DistributedMesh& mesh, bool mirrored, const OptimizeOptions& options)
{
  OptimizeResult result;
  mesh.group().together(
    [&]
    {
      if (!options.fixed && mesh.localPoints() > 0)
      {
        throw Error(
          "The fixed points of a mesh on several ranks must be given, see rankBoundary().");
      }
      // What the owner says of a point counts.
      std::vector<unsigned char> fixed;
      OptimizeOptions agreed = options;
      if (options.fixed)
      {
        fixed.assign(options.fixed, options.fixed + mesh.localPoints());
      }
      fixed.reserve(1); // not null, which would be the boundary
      agreed.fixed = fixed.data();
      mesh.exchange(fixed.data());
      std::vector<double> planes, lines;
      const auto agreeOn = [&](const double*& given, std::vector<double>& directions)
      {
        if (mesh.group().any(given != nullptr))
        {
          directions.assign(3 * mesh.localPoints(), 0.0);
          std::copy_n(given, given ? directions.size() : 0, directions.begin());
          mesh.exchange(directions.data(), 3);
          directions.reserve(1);
          given = directions.data();
        }
      };
      agreeOn(agreed.slidePlanes, planes);
      agreeOn(agreed.slideLines, lines);
      result = OptimizationOnRanks(mesh, mirrored, agreed).run();
    });
  return result;
}

//------------------------------------------------------------------------------
std::vector<unsigned char> rankBoundary(const DistributedMesh& mesh)
{
  std::vector<unsigned char> flags(mesh.localPoints(), 0);
  if (mesh.view().numberOfCells > 0)
  {
    const std::vector<char> boundary = boundaryPoints(Mesh(mesh.view()));
    std::copy(boundary.begin(), boundary.end(), flags.begin());
  }
  mesh.exchange(flags.data());
  return flags;
}

//------------------------------------------------------------------------------
Index countInvalidOnRanks(
  const DistributedMesh& mesh, bool mirrored, const std::vector<double>& points, int threads)
{
  Index count = 0;
  std::vector<signed char> validity(mesh.view().numberOfCells);
  if (!validity.empty())
  {
    movedMesh(mesh, mirrored, points, threads).classifyCells(validity.data(), threads);
  }
  for (std::size_t cell = 0; cell < validity.size(); ++cell)
  {
    count += mesh.ownedCells()[cell] && isInvalid(validity[cell]);
  }
  return mesh.group().sum(count);
}
}
