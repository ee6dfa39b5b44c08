// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleReconnection.h"

#include "Constants.h"
#include "ReconnectionProgress.h"
#include "TriangleInput.h"
#include "TriangleOperations.h"

#include <limits>

namespace tautline
{
namespace
{
/// Qualities of the first passes: the worst triangles first, also of the whole mesh.
constexpr double FirstTriangleTargets[] = { 0.3, 0.5 };
/// The last pass is repeated, at most so often, as long as the worst quality gains so much by it.
constexpr int TrianglePasses = 4;
constexpr double TrianglePassGain = 1e-3;
/// What a motion has to gain at first, and in the last pass.
constexpr double FirstGain = 1e-3, FineGain = 1e-4;
/// Steps of a point, each time.
constexpr int StepsOfPoint = 3;
/// Attempts between two checks of the clock.
constexpr Index AttemptsBetweenChecks = 32;

double sineOf(double degrees)
{
  return std::sin(degrees * (Pi / 180.0));
}

/// One pass: which triangles are improved, and how.
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

/// First flips everywhere, then flips and motions for ever better triangles, then all the rest.
std::vector<TrianglePass> planPasses(const TriangleOptions& options)
{
  const double target = sineOf(options.targetAngle);
  const bool keepsCount = options.smallestCount == 1.0 && options.largestCount == 1.0;
  std::vector<TrianglePass> passes;
  TrianglePass pass;
  pass.swap = options.swap;
  if (options.swap && options.swapEverywhere)
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
  TriangleRun(TriangleMesh& mesh, const TriangleInput& input, const TriangleOptions& options,
    ReconnectionResult& result)
    : Mesh(mesh)
    , Input(input)
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
  bool improve(TriId t, const TrianglePass& pass);
  void pushChanged(double target);
  bool isWaiting(const Queue::Entry& entry);

  TriangleMesh& Mesh;
  const TriangleInput& Input;
  const TriangleOptions& Options;
  ReconnectionResult& Result;
  TriangleOperations Operations;
  Queue Waiting;
  std::vector<std::uint32_t> Tried; ///< clock at the last attempt in vain, per slot
  ReconnectionProgress Progress;
  Index Attempts = 0;
  double Volume = 0; ///< of the input, if it is to be kept
};

bool TriangleRun::record(int pass, double fraction)
{
  ReconnectionRecord record = measure(this->Mesh, sineOf(this->Options.targetAngle));
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

/// Whether the triangle is still as it was when it was put into the queue, and worth a try.
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
  this->Waiting.fill(this->Mesh,
    [&](TriId t) { return this->Mesh.alive(t) && this->Mesh.quality(t) < pass.target; });
  while (!this->Waiting.empty())
  {
    const Queue::Entry entry = this->Waiting.pop();
    if (!this->isWaiting(entry))
    {
      continue;
    }
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

/// Moves all points in turn for the mean, the worst being held; false if stopped.
bool TriangleRun::improveMean()
{
  const ReconnectionRecord before = this->Result.history.back();
  this->Operations.leastMeanRatio = 1.0 / before.worstInverseMeanRatio;
  const bool complete = this->Progress.sweepForMean(this->Mesh.pointSlots(), this->Mesh.size(),
    [&](VertexId v) { return this->Operations.improveMean(v, before.worstQuality); });
  return this->record(before.pass + 1, 1.0) && complete;
}

/// Also of a run that was stopped: what it has changed so far has cost volume.
void TriangleRun::keepVolume()
{
  const ReconnectionRecord& first = this->Result.history.front();
  this->Operations.leastMeanRatio = 1.0 / first.worstInverseMeanRatio;
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
  operations.metrics = this->Input.metrics;
  operations.edgeFactor = this->Options.edgeFactor;
  operations.target = sineOf(this->Options.targetAngle);
  operations.leastMeanRatio = 1.0 / this->Result.history.front().worstInverseMeanRatio;
  const double size = static_cast<double>(this->Mesh.size());
  operations.smallestSize = static_cast<Index>(std::ceil(this->Options.smallestCount * size));
  operations.largestSize = static_cast<Index>(std::min(this->Options.largestCount * size,
    static_cast<double>(std::numeric_limits<std::int32_t>::max() / 8)));
}

void TriangleRun::run(const std::vector<PointFreedom>& freedoms)
{
  const bool started = this->record(0, 0.0);
  this->prepare(freedoms);
  this->Volume = this->Options.keepVolume ? this->Operations.enclosedVolume() : 0.0;
  std::vector<TrianglePass> passes = planPasses(this->Options);
  const std::size_t planned = passes.size();
  bool stopped = !started;
  for (std::size_t i = 0; i < passes.size() && !stopped; ++i)
  {
    const ReconnectionRecord before = this->Result.history.back();
    if (before.belowTarget == 0 && passes[i].target < 1.0)
    {
      break;
    }
    const bool complete = this->runPass(passes[i]);
    const double progress =
      static_cast<double>(i + 1) / static_cast<double>(planned + TrianglePasses);
    stopped = !this->record(static_cast<int>(i) + 1, progress) || !complete;
    const double gain = this->Result.history.back().worstQuality - before.worstQuality;
    if (i + 1 == passes.size() && gain > TrianglePassGain &&
      passes.size() < planned + TrianglePasses)
    {
      passes.push_back(passes[i]);
    }
  }
  stopped = stopped || (this->Options.improveMean && !this->improveMean());
  if (this->Options.keepVolume)
  {
    this->keepVolume();
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
    throw Error("The volume can be kept of a closed surface only, and " +
      (mesh.planar() ? std::string("this mesh is planar")
                     : std::to_string(open) +
            " edges of this one do not have one triangle on each side, in the same order") +
      ": switch Keep Volume off, or close the surface first.");
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
    TriangleRun(changing, input, options, result).run(freedoms);
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
