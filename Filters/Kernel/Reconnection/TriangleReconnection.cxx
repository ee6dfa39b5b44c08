// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleReconnection.h"

#include "Constants.h"
#include "ReconnectionProgress.h"
#include "TriangleAdaptation.h"
#include "TriangleInput.h"
#include "TriangleOperations.h"

#include <limits>
#include <memory>

namespace tautline
{
namespace
{
/// Qualities of the first passes: the worst triangles first, also of the whole mesh.
constexpr double FirstTriangleTargets[] = { 0.3, 0.5 };
/// The last pass is repeated, at most this many times, as long as the worst quality gains this
/// much.
constexpr int TrianglePasses = 4;
constexpr double TrianglePassGain = 1e-3;
/// The minimum gain of a motion at first, and in the last pass.
constexpr double FirstGain = 1e-3, FineGain = 1e-4;
/// The number of steps of a point, each time.
constexpr int StepsOfPoint = 3;
/// The number of attempts in a pass after adaptation, per triangle below its target: of flips and
/// motions, and of all operations, which take a hundred times as long.
constexpr Index MetricMotions = 8, MetricAttempts = 2;
/// The maximum number of adaptation rounds, which end when the share of edges of the right length
/// grows by less.
constexpr int AdaptationRounds = 12;
constexpr double LeastShareGain = 5e-4;
/// The share of adaptation in the progress.
constexpr double AdaptationProgress = 0.8;
/// The number of attempts between two checks of the clock.
constexpr Index AttemptsBetweenChecks = 32;

/// One pass: the triangles to improve, and the operations.
struct TrianglePass
{
  double target = 1;
  bool swap = false, smooth = false, contract = false, insert = false;
  double leastGain = FirstGain;
};

ReconnectionRecord measure(const TriangleMesh& mesh, double target)
{
  ReconnectionRecord record;
  double quality = 1.0, smallest = 180.0, largest = 0.0, meanRatio = 1.0;
  for (TriId t = 0; t < mesh.slots(); ++t)
  {
    if (!mesh.alive(t))
    {
      continue;
    }
    const Corners& v = mesh.triangle(t).vertices;
    const Vec3 &a = mesh.point(v[0]), &b = mesh.point(v[1]), &c = mesh.point(v[2]);
    const std::array<double, 2> angles = triangleAngles(a, b, c);
    smallest = std::min(smallest, angles[0]);
    largest = std::max(largest, angles[1]);
    quality = std::min(quality, mesh.quality(t));
    meanRatio = std::min(meanRatio, std::abs(measureTriangle(a, b, c, mesh.planar()).meanRatio));
    record.belowTarget += mesh.quality(t) < target;
  }
  record.tetrahedra = mesh.size();
  record.worstQuality = quality;
  record.smallestAngle = smallest;
  record.largestAngle = largest;
  record.worstInverseMeanRatio = 1.0 / meanRatio;
  return record;
}

/// First flips everywhere, then flips and motions for increasing targets, then all other
/// operations.
std::vector<TrianglePass> planPasses(const TriangleOptions& options)
{
  const double target = targetQuality(options);
  const bool keepsCount =
    !options.adapt && options.smallestCount == 1.0 && options.largestCount == 1.0;
  std::vector<TrianglePass> passes;
  TrianglePass pass;
  pass.swap = options.swap;
  if (options.swap && options.swapEverywhere && !options.adapt)
  {
    passes.push_back(pass);
  }
  pass.smooth = options.smooth;
  for (double first : FirstTriangleTargets)
  {
    if (first < target)
    {
      pass.target = first;
      passes.push_back(pass);
    }
  }
  pass.target = target;
  passes.push_back(pass);
  pass.insert = options.insert && !keepsCount;
  pass.contract = options.contract && !keepsCount;
  if (pass.insert || pass.contract)
  {
    passes.push_back(pass);
  }
  if (options.compound)
  {
    pass.leastGain = FineGain;
    passes.push_back(pass);
  }
  return passes;
}

//------------------------------------------------------------------------------
/// The run of the passes with its queue, clock, observer and records.
class TriangleRun
{
public:
  /// @param field the metric field; null without adaptation
  TriangleRun(TriangleMesh& mesh, const TriangleInput& input, const TriangleMetrics* field,
    const TriangleOptions& options, ReconnectionResult& result)
    : Mesh(mesh)
    , Input(input)
    , Field(field)
    , Options(options)
    , Result(result)
    , Operations(mesh, input)
    , Progress(options, result)
  {
  }

  void run(const std::vector<PointFreedom>& freedoms);

private:
  using Queue = QualityQueue<TriId>;
  void prepare(const std::vector<PointFreedom>& freedoms);
  bool record(int pass, double fraction);
  bool runPass(const TrianglePass& pass);
  bool improveMean();
  void keepVolume();
  bool adapt();
  void findOrigins();
  bool improve(TriId t, const TrianglePass& pass);
  void pushChanged(double target);
  bool isWaiting(const Queue::Entry& entry);

  TriangleMesh& Mesh;
  const TriangleInput& Input;
  const TriangleMetrics* Field;
  const TriangleOptions& Options;
  ReconnectionResult& Result;
  TriangleOperations Operations;
  Queue Waiting;
  std::vector<std::uint32_t> Tried; ///< clock at the last unsuccessful attempt, per slot
  ReconnectionProgress Progress;
  Index Attempts = 0;
  double Volume = 0; ///< of the input, if it must be preserved
};

bool TriangleRun::record(int pass, double fraction)
{
  ReconnectionRecord record = measure(this->Mesh, targetQuality(this->Options));
  record.edgesInRange = this->Field
    ? TriangleAdaptation(this->Mesh, this->Input, this->Operations).shareOfUnitEdges()
    : 0.0;
  const TriangleOperations::Counts& counts = this->Operations.counts();
  record.edgeRemovals = counts.flips;
  record.contractions = counts.contractions;
  record.insertions = counts.insertions;
  record.moves = counts.moves;
  return this->Progress.record(record, pass, fraction);
}

void TriangleRun::pushChanged(double target)
{
  for (TriId t : this->Operations.changed())
  {
    if (this->Mesh.alive(t) && this->Mesh.quality(t) < target)
    {
      this->Waiting.push({ this->Mesh.quality(t), t });
    }
  }
}

bool TriangleRun::improve(TriId t, const TrianglePass& pass)
{
  for (int i = 0; pass.swap && i < 3; ++i)
  {
    if (this->Operations.flip(t, i))
    {
      this->pushChanged(pass.target);
      return true;
    }
  }
  bool moved = false;
  const Corners v = this->Mesh.triangle(t).vertices;
  for (int i = 0; pass.smooth && i < 3; ++i)
  {
    if (this->Operations.smooth(v[i], StepsOfPoint))
    {
      moved = true;
      this->pushChanged(pass.target);
    }
  }
  bool changed = moved;
  for (int i = 0; pass.contract && !changed && i < 3; ++i)
  {
    for (int j = 0; j < 3 && !changed; ++j)
    {
      changed = i != j && this->Operations.contract(t, i, j);
    }
  }
  changed = changed || (pass.insert && this->Operations.insert(t));
  if (changed && !moved)
  {
    this->pushChanged(pass.target);
  }
  return changed;
}

/// Whether the triangle is unchanged since it was put into the queue, and worth an attempt.
bool TriangleRun::isWaiting(const Queue::Entry& entry)
{
  const TriId t = entry.cell;
  if (t >= this->Mesh.slots() || !this->Mesh.alive(t) || this->Mesh.quality(t) != entry.quality)
  {
    return false;
  }
  this->Tried.resize(this->Mesh.slots(), 0);
  std::uint32_t newest = 0;
  for (VertexId v : this->Mesh.triangle(t).vertices)
  {
    newest = std::max(newest, this->Operations.stamp(v));
  }
  return this->Tried[t] <= newest;
}

/// @return false if stopped
bool TriangleRun::runPass(const TrianglePass& pass)
{
  this->Tried.assign(this->Mesh.slots(), 0);
  this->Operations.leastGain = pass.leastGain;
  Index below = 0;
  this->Waiting.fill(this->Mesh,
    [&](TriId t)
    {
      const bool waits = this->Mesh.alive(t) && this->Mesh.quality(t) < pass.target;
      below += waits;
      return waits;
    });
  // If walls are much closer to each other than the target lengths, many triangles are below any
  // target.
  const Index attempts = pass.insert || pass.contract ? MetricAttempts : MetricMotions;
  Index budget = this->Field ? attempts * below : -1;
  while (!this->Waiting.empty() && budget != 0)
  {
    const Queue::Entry entry = this->Waiting.pop();
    if (!this->isWaiting(entry))
    {
      continue;
    }
    --budget;
    if (++this->Attempts % AttemptsBetweenChecks == 0 && !this->Progress.proceed())
    {
      return false;
    }
    if (!this->improve(entry.cell, pass))
    {
      this->Tried[entry.cell] = this->Operations.clock() + 1;
    }
    else if (this->Mesh.alive(entry.cell) && this->Mesh.quality(entry.cell) == entry.quality)
    {
      this->Waiting.push(entry);
    }
  }
  return true;
}

/// Moves all points in turn to improve the mean without worsening the worst; false if stopped.
bool TriangleRun::improveMean()
{
  const ReconnectionRecord before = this->Result.history.back();
  this->Operations.leastMeanRatio = 1.0 / before.worstInverseMeanRatio;
  const bool complete = this->Progress.sweepForMean(this->Mesh.pointSlots(), this->Mesh.size(),
    [&](VertexId v) { return this->Operations.improveMean(v, before.worstQuality); });
  return this->record(before.pass + 1, 1.0) && complete;
}

/// Also applies to a stopped run, whose changes have already affected the volume.
void TriangleRun::keepVolume()
{
  const ReconnectionRecord& first = this->Result.history.front();
  this->Operations.leastMeanRatio = this->Field ? 0.0 : 1.0 / first.worstInverseMeanRatio;
  this->Operations.keepVolume(this->Volume, first.worstQuality);
  const double unit = std::ldexp(1.0, 3 * this->Input.exponent);
  this->Result.volumeBefore = unit * this->Volume;
  this->Result.volumeAfter = unit * this->Operations.enclosedVolume();
  this->record(this->Result.history.back().pass + 1, 1.0);
}

void TriangleRun::prepare(const std::vector<PointFreedom>& freedoms)
{
  TriangleOperations& operations = this->Operations;
  operations.freedoms = freedoms;
  operations.flips = this->Options.swap;
  operations.moves = this->Options.smooth;
  operations.dividesWalls = this->Options.boundary == BoundaryMotion::FlatParts;
  operations.field = this->Field;
  operations.edgeFactor = this->Options.edgeFactor;
  operations.target = targetQuality(this->Options);
  operations.leastMeanRatio = 1.0 / this->Result.history.front().worstInverseMeanRatio;
  const double size = static_cast<double>(this->Mesh.size());
  operations.smallestSize = static_cast<Index>(std::ceil(this->Options.smallestCount * size));
  operations.largestSize = static_cast<Index>(std::min(this->Options.largestCount * size,
    static_cast<double>(std::numeric_limits<std::int32_t>::max() / 8)));
  if (this->Field)
  {
    operations.edgeFactor = TriangleAdaptation::LongestEdge;
    operations.leastMeanRatio = 0.0;
    operations.smallestSize = 0;
    operations.largestSize = std::numeric_limits<std::int32_t>::max() / 8;
  }
}

/// Runs rounds of adaptation until the share of edges of the right length stops growing; false if
/// stopped.
bool TriangleRun::adapt()
{
  TriangleAdaptation adaptation(this->Mesh, this->Input, this->Operations);
  adaptation.splits = this->Options.insert;
  adaptation.contracts = this->Options.contract;
  adaptation.flips = this->Options.swap;
  adaptation.moves = this->Options.smooth;
  adaptation.proceed = [this] { return this->Progress.proceed(); };
  double share = adaptation.shareOfUnitEdges();
  for (int round = 0; round < AdaptationRounds; ++round)
  {
    const bool complete = adaptation.runRound();
    const double fraction = AdaptationProgress * (round + 1) / AdaptationRounds;
    if (!this->record(this->Result.history.back().pass + 1, fraction) || !complete)
    {
      return false;
    }
    const double now = adaptation.shareOfUnitEdges();
    if (now < share + LeastShareGain)
    {
      break;
    }
    share = now;
  }
  return true;
}

/// Sets the origins of triangles to the input triangles that contain their centroids.
void TriangleRun::findOrigins()
{
  for (TriId t = 0; t < this->Mesh.slots(); ++t)
  {
    if (!this->Mesh.alive(t) || isUnchanged(this->Input, this->Mesh, t))
    {
      continue;
    }
    const Triangle& triangle = this->Mesh.triangle(t);
    const Corners& v = triangle.vertices;
    const Vec3 centroid =
      (1.0 / 3.0) * (this->Mesh.point(v[0]) + this->Mesh.point(v[1]) + this->Mesh.point(v[2]));
    const TriId found = this->Field->locate(
      centroid, this->Input.planar ? this->Mesh.metric(v[0]).place : triangle.origin);
    const bool sameRegion =
      this->Input.regions.empty() || this->Input.regions[found] == triangle.region;
    if (sameRegion &&
      (this->Input.planar || this->Input.patches[found] == this->Input.patches[triangle.origin]))
    {
      this->Mesh.setOrigin(t, found);
    }
  }
}

void TriangleRun::run(const std::vector<PointFreedom>& freedoms)
{
  const bool started = this->record(0, 0.0);
  this->prepare(freedoms);
  this->Volume = this->Options.keepVolume ? this->Operations.enclosedVolume() : 0.0;
  std::vector<TrianglePass> passes = planPasses(this->Options);
  const std::size_t planned = passes.size();
  bool stopped = !started || (this->Field && !this->adapt());
  const int firstPass = this->Result.history.back().pass;
  for (std::size_t i = 0; i < passes.size() && !stopped; ++i)
  {
    const ReconnectionRecord before = this->Result.history.back();
    if (before.belowTarget == 0 && passes[i].target < 1.0)
    {
      break;
    }
    const bool complete = this->runPass(passes[i]);
    const double start = this->Field ? AdaptationProgress : 0.0;
    const double progress = start +
      (1.0 - start) * static_cast<double>(i + 1) / static_cast<double>(planned + TrianglePasses);
    stopped = !this->record(firstPass + static_cast<int>(i) + 1, progress) || !complete;
    const double gain = this->Result.history.back().worstQuality - before.worstQuality;
    if (i + 1 == passes.size() && gain > TrianglePassGain &&
      passes.size() < planned + TrianglePasses)
    {
      passes.push_back(passes[i]);
    }
  }
  stopped = stopped || (this->Options.improveMean && !this->Field && !this->improveMean());
  if (this->Options.keepVolume)
  {
    this->keepVolume();
  }
  if (this->Field)
  {
    this->findOrigins();
  }
  if (!stopped && this->Result.history.back().belowTarget == 0)
  {
    this->Result.reason = StopReason::Reduction;
  }
}

void checkEdges(const TriangleMesh& mesh)
{
  if (mesh.planar() && mesh.nonManifoldEdges() > 0)
  {
    throw Error(std::to_string(mesh.nonManifoldEdges()) +
      " edges of a planar mesh have three or more triangles, or two on the same side: remove "
      "duplicate or overlapping triangles first");
  }
}

/// Throws Error for target lengths that require more triangles than fit into memory.
void requireFeasible(const TriangleInput& input)
{
  constexpr double idealArea = 0.4330127018922193; // of edges of length 1: sqrt(3) / 4
  constexpr double bytesPerTriangle = 400.0;       // of mesh, workspace and result
  double expected = 0.0;
  for (const Corners& v : input.cells)
  {
    const auto sum = [&](const Vec3& e, const Vec3& f)
    {
      double product = 0.0;
      for (VertexId p : v)
      {
        const MetricTensor& m = input.metrics[p];
        product += (squaredLength(e + f, m) - squaredLength(e - f, m)) / (4.0 * 3.0);
      }
      return product;
    };
    const Vec3 e = input.points[v[1]] - input.points[v[0]],
               f = input.points[v[2]] - input.points[v[0]];
    const double squared = sum(e, e) * sum(f, f) - sum(e, f) * sum(e, f);
    expected += 0.5 * std::sqrt(std::max(squared, 0.0));
  }
  requireRoom(expected / idealArea, "triangles", bytesPerTriangle);
}

/// Only a closed surface encloses a volume.
void requireClosed(const TriangleMesh& mesh)
{
  Index open = 0;
  for (TriId t = 0; t < mesh.slots(); ++t)
  {
    for (int i = 0; i < 3; ++i)
    {
      open += mesh.isBorder(t, i);
    }
  }
  if (mesh.planar() || open > 0)
  {
    throw Error("The volume can only be preserved for a closed surface, and " +
      (mesh.planar() ? std::string("this mesh is planar")
                     : std::to_string(open) +
            " edges of this one do not have one triangle on each side, in the same order") +
      ": turn Keep Volume off, or close the surface first.");
  }
}
}

//------------------------------------------------------------------------------
void applyPreset(ReconnectionPreset preset, TriangleOptions& options)
{
  if (preset == ReconnectionPreset::Custom)
  {
    return;
  }
  applyPreset(preset, static_cast<ReconnectionOptions&>(options));
  const bool slivers = preset == ReconnectionPreset::RemoveSlivers;
  options.swapEverywhere = !slivers;
  options.targetAngle = slivers ? SliverAngle : TriangleOptions::DefaultTargetAngle;
}

ReconnectionResult improveTriangles(const Mesh& mesh, const TriangleOptions& options)
{
  checkTriangleOptions(options);
  const TriangleInput input = convertTriangles(mesh, options);
  TriangleMesh changing(input.points, input.cells, input.regions, input.walls, input.planar);
  checkEdges(changing);
  if (options.keepVolume)
  {
    requireClosed(changing);
  }
  const TriangleMesh before = changing;
  ReconnectionResult result;
  result.adapted = options.adapt;
  const std::vector<PointFreedom> freedoms = findFreedoms(changing, input, options);
  std::vector<char> fixedPoints(freedoms.size(), 0);
  for (std::size_t v = 0; v < freedoms.size(); ++v)
  {
    fixedPoints[v] = options.fixed && options.fixed[v];
    result.pointsOnLines += freedoms[v].kind == PointFreedom::OnLine;
    result.pointsInPlanes += !input.planar && freedoms[v].kind == PointFreedom::Free;
  }
  if (changing.size() > 0)
  {
    std::unique_ptr<TriangleMetrics> field;
    if (options.adapt)
    {
      requireFeasible(input);
      field = std::make_unique<TriangleMetrics>(before, input);
    }
    std::vector<PointMetric> metrics;
    for (const EdgeMetric& metric : input.metrics)
    {
      metrics.push_back({ metric, before.triangleOf(static_cast<VertexId>(metrics.size())) });
    }
    changing.setMetrics(std::move(metrics), options.adapt);
    TriangleRun(changing, input, field.get(), options, result).run(freedoms);
    findObstacles(changing, fixedPoints, options, result);
  }
  convertOutput(mesh, input, before, changing, result);
  if (options.overlaps)
  {
    computeOverlaps(input, before, changing, options.threads, result);
  }
  return result;
}
}
