// SPDX-License-Identifier: BSD-3-Clause
#include "Reconnection.h"

#include "BoundaryFreedom.h"
#include "Constants.h"
#include "MeshBlocks.h"
#include "Obstacles.h"
#include "PassPlan.h"
#include "ReconnectionOutput.h"
#include "ReconnectionProgress.h"
#include "TetrahedronAdaptation.h"
#include "TetrahedronPasses.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Core/LoopInterruption.h"
#include "tautline/Core/Parallel.h"

#include <atomic>
#include <limits>
#include <numeric>
#include <thread>

namespace tautline
{
namespace
{
/// The same on the whole mesh after its blocks.
constexpr Index WholeFailures = 50;
/// The last pass is repeated, at most this many times, as long as the worst quality gains this
/// much.
constexpr int Repetitions = 3;
constexpr double RepetitionGain = 2e-3;
/// The largest number of times that blocks are halved, and of partitions in different directions.
constexpr int MaxLevels = 8, Partitions = 3;
/// The number of rings of tetrahedra beyond the faces between blocks at which the next partition
/// starts.
constexpr int StartRings = 1;
/// Blocks pay off if at least this fraction of the tetrahedra is processed.
constexpr double BlockFraction = 0.1;
/// Progress when all blocks are done.
constexpr double BlockProgress = 0.9;

/// With ReconnectionOptions::adapt, the largest length of edges after a contraction: somewhat
/// longer than edges that are split again, or many short edges could not be contracted.
constexpr double AdaptedFactor = 1.6;
/// The weight that disables one of the sine and the mean ratio if the other is the objective.
constexpr double IgnoredWeight = 1e3;

QualityWeights weightsOf(const ReconnectionOptions& options, const MetricQuality* metric)
{
  const ReconnectionObjective objective = options.objective;
  if (options.adapt)
  {
    return { IgnoredWeight, 1.0, nullptr, true };
  }
  if (metric)
  {
    return { IgnoredWeight, IgnoredWeight, metric };
  }
  return { objective == ReconnectionObjective::Shape ? IgnoredWeight : 1.0,
    objective == ReconnectionObjective::Angles ? IgnoredWeight : 1.0 };
}

/// The metric objective; null for other objectives.
std::unique_ptr<MetricQuality> metricOf(
  const Mesh& mesh, const ReconnectionInput& input, const ReconnectionOptions& options)
{
  if (options.objective != ReconnectionObjective::Metric || options.adapt ||
    mesh.view().numberOfCells == 0)
  {
    return nullptr;
  }
  std::vector<double> values(mesh.view().numberOfCells);
  EvaluationOptions evaluation;
  evaluation.threads = options.threads;
  requireInRange(
    metricInfo(options.metric), evaluateMetric(mesh, options.metric, evaluation, values.data()));
  double sum = 0.0;
  for (double value : values)
  {
    // Divided before the summation, which could overflow.
    sum += value / static_cast<double>(values.size());
  }
  return std::make_unique<MetricQuality>(options.metric, input.exponent, sum);
}

/// The class of each label; the class of no label is 0.
std::vector<std::int32_t> classesOf(const ReconnectionOptions& options)
{
  std::vector<std::int32_t> classes(options.markedFacets.size() + 1, 1);
  classes[NoLabel] = 0;
  for (std::size_t i = 0; i < options.markedClasses.size() && i < options.markedFacets.size(); ++i)
  {
    classes[i + 1] = options.markedClasses[i];
  }
  return classes;
}

/// Adds the worst values of some tetrahedra to the record; only tetrahedra that may be worse than
/// the previous ones are measured.
void addWorst(
  const TetrahedronMesh& mesh, TetId begin, TetId end, double target, ReconnectionRecord& record)
{
  double meanRatio = 1.0, sufficient = 2.0;
  for (TetId t = begin; t < end; ++t)
  {
    if (!mesh.alive(t) || mesh.region(t) == OutsideRegion)
    {
      continue;
    }
    const double q = mesh.quality(t);
    ++record.tetrahedra;
    record.worstQuality = std::min(record.worstQuality, q);
    record.belowTarget += q < target;
    if (q >= sufficient)
    {
      continue;
    }
    const TetVertices& v = mesh.tet(t).vertices;
    const auto x = [&](int k) { return mesh.point(v[k]); };
    const DihedralRange angles = dihedralRange(x(0), x(1), x(2), x(3));
    record.smallestAngle = std::min(record.smallestAngle, angles.smallest);
    record.largestAngle = std::max(record.largestAngle, angles.largest);
    meanRatio = std::min(meanRatio, measure(x(0), x(1), x(2), x(3)).meanRatio);
    // With weights 1, all angles are between asin(q) and 180 degrees minus it, and the power of the
    // mean ratio is above q. (A registry metric gives no such bounds: the weights are large.)
    const QualityWeights& w = mesh.weights();
    if (w.inMetric)
    {
      continue;
    }
    sufficient = std::max(
      { w.meanRatio * meanRatio, w.sine * std::sin(radians(std::min(record.smallestAngle, 90.0))),
        w.sine * std::sin(radians(std::max(record.largestAngle, 90.0))) });
  }
  record.worstInverseMeanRatio = std::pow(meanRatio, -2.0 / 3.0);
}

/// Sets the worst values of the record.
void measureWorst(
  const TetrahedronMesh& mesh, double target, int threads, ReconnectionRecord& record)
{
  record.worstQuality = record.worstInverseMeanRatio = 1.0;
  record.smallestAngle = 180.0;
  record.largestAngle = 0.0;
  record.belowTarget = record.tetrahedra = 0;
  std::vector<ReconnectionRecord> ofChunk(numberOfChunks(mesh.slots()), record);
  forEachChunk(mesh.slots(), threads,
    [&](Index chunk, Index begin, Index end) {
      addWorst(mesh, static_cast<TetId>(begin), static_cast<TetId>(end), target, ofChunk[chunk]);
    });
  for (const ReconnectionRecord& part : ofChunk)
  {
    record.worstQuality = std::min(record.worstQuality, part.worstQuality);
    record.smallestAngle = std::min(record.smallestAngle, part.smallestAngle);
    record.largestAngle = std::max(record.largestAngle, part.largestAngle);
    record.worstInverseMeanRatio =
      std::max(record.worstInverseMeanRatio, part.worstInverseMeanRatio);
    record.belowTarget += part.belowTarget;
    record.tetrahedra += part.tetrahedra;
  }
}

/// The sum of a function of the corners of all tetrahedra; it does not depend on the threads.
template <class Function>
double sumOf(const TetrahedronMesh& mesh, int threads, const Function& function)
{
  std::vector<double> ofChunk(numberOfChunks(mesh.slots()), 0.0);
  forEachChunk(mesh.slots(), threads,
    [&](Index chunk, Index begin, Index end)
    {
      for (TetId t = static_cast<TetId>(begin); t < static_cast<TetId>(end); ++t)
      {
        if (mesh.alive(t))
        {
          const TetVertices& v = mesh.tet(t).vertices;
          ofChunk[chunk] +=
            function(mesh.point(v[0]), mesh.point(v[1]), mesh.point(v[2]), mesh.point(v[3]));
        }
      }
    });
  return std::accumulate(ofChunk.begin(), ofChunk.end(), 0.0);
}

/// The volume in units of the input, which are 2^exponent.
double volumeOf(const TetrahedronMesh& mesh, int exponent, int threads)
{
  const double sum = sumOf(mesh, threads,
    [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
    { return dot(b - a, cross(c - a, d - a)); });
  return std::ldexp(sum / 6.0, 3 * exponent);
}

/// The mean of the inverse mean ratio.
double meanRatioOf(const TetrahedronMesh& mesh, int threads)
{
  const double sum = sumOf(mesh, threads,
    [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
    {
      const double root = std::cbrt(measure(a, b, c, d).meanRatio);
      return 1.0 / (root * root);
    });
  return sum / static_cast<double>(mesh.size());
}

void copyCounts(const OperationCounts& counts, ReconnectionRecord& record)
{
  record.edgeRemovals = counts.edgeRemovals;
  record.faceRemovals = counts.faceRemovals;
  record.boundarySwaps = counts.boundarySwaps;
  record.contractions = counts.contractions;
  record.insertions = counts.insertions;
  record.moves = counts.moves;
}

/// The number of times a mesh is halved before the next half would be smaller than a block.
int levelsOf(Index size, Index blockSize)
{
  int levels = 0;
  while (levels < MaxLevels && size / 2 >= blockSize)
  {
    size /= 2;
    ++levels;
  }
  return levels;
}

//------------------------------------------------------------------------------
/// The run of the passes with its clock, observer and records.
class Run
{
public:
  Run(TetrahedronMesh& mesh, const ReconnectionOptions& options, ReconnectionResult& result)
    : Mesh(mesh)
    , Options(options)
    , Result(result)
    , Operations(mesh)
    , Passes(mesh, this->Operations)
    , Progress(options, result)
  {
  }

  void run(const std::vector<PointFreedom>& freedoms,
    std::shared_ptr<const BoundarySurface> surface, std::shared_ptr<const InputMetric> field);
  const TetrahedronPasses& passes() const { return this->Passes; }

private:
  bool record(int pass, double fraction, double share = 0.0);
  void setFloor(const ReconnectionRecord& record);
  bool improveMean();
  void setBounds();
  bool adapt();
  bool runStages();
  bool runStage(const std::vector<PassOptions>& stage, double end);
  bool runPasses(std::vector<PassOptions> passes, double end);
  bool runInBlocks(
    const std::vector<PassOptions>& passes, int levels, std::vector<char> starts, double end);
  std::vector<char> flagsOf(const unsigned char* flags) const;
  bool paysInBlocks(const std::vector<char>& starts, double target) const;
  bool runBlocks(
    MeshBlockList& blocks, const std::vector<PassOptions>& passes, const std::vector<char>& starts);
  std::vector<char> addRings(std::vector<char> flags) const;

  TetrahedronMesh& Mesh;
  const ReconnectionOptions& Options;
  ReconnectionResult& Result;
  CavityOperations Operations;
  TetrahedronPasses Passes;
  ReconnectionProgress Progress;
};

/// Adds a line to the history; false if the observer stops the run.
bool Run::record(int pass, double fraction, double share)
{
  ReconnectionRecord record;
  measureWorst(this->Mesh, targetQuality(this->Options), this->Options.threads, record);
  copyCounts(this->Operations.counts(), record);
  record.edgesInRange = share;
  return this->Progress.record(record, pass, fraction);
}

/// Nothing becomes worse than the worst of the mesh of a record.
void Run::setFloor(const ReconnectionRecord& record)
{
  QualityFloor& floor = this->Operations.floor;
  floor.smallestAngle = record.smallestAngle;
  floor.quality = record.worstQuality;
  // The inverse mean ratio of the record is the power -2/3 of this ratio.
  floor.meanRatio = std::pow(record.worstInverseMeanRatio, -1.5);
  const double sine = record.smallestAngle < 90.0 ? std::sin(radians(record.smallestAngle)) : 1.0;
  const QualityWeights& weights = this->Mesh.weights();
  // From this quality on, neither the angle nor the mean ratio can be below the floor.
  floor.sufficient = std::max(weights.sine * sine, weights.meanRatio * floor.meanRatio);
}

void Run::setBounds()
{
  const double size = static_cast<double>(this->Mesh.size());
  const bool keepsCount = this->Options.smallestCount == 1.0 && this->Options.largestCount == 1.0;
  if (this->Options.adapt)
  {
    // Faces are coded as 4 t + i in 31 bits.
    this->Operations.largestSize = std::numeric_limits<std::int32_t>::max() / 8;
    return;
  }
  this->Operations.inserts = this->Options.insert && !keepsCount;
  this->Operations.contracts = this->Options.contract && !keepsCount;
  this->Operations.moves = this->Options.smooth;
  this->Operations.smallestSize =
    keepsCount ? 0 : static_cast<Index>(std::ceil(this->Options.smallestCount * size));
  this->Operations.largestSize = keepsCount
    ? std::numeric_limits<std::int32_t>::max() / 4
    : static_cast<Index>(std::min(this->Options.largestCount * size,
        static_cast<double>(std::numeric_limits<std::int32_t>::max() / 4)));
}

void Run::run(const std::vector<PointFreedom>& freedoms,
  std::shared_ptr<const BoundarySurface> surface, std::shared_ptr<const InputMetric> field)
{
  this->Operations.surface = std::move(surface);
  this->Operations.freedoms = freedoms;
  this->Operations.field = std::move(field);
  this->Operations.classes = classesOf(this->Options);
  this->Operations.edgeFactor = this->Options.adapt ? AdaptedFactor : this->Options.edgeFactor;
  this->Operations.sums = this->Options.objective == ReconnectionObjective::Sum;
  this->Operations.swapsBoundary =
    this->Options.swap && this->Options.boundary != BoundaryMotion::Fixed;
  this->Operations.flatTolerance = std::max(
    std::sin(radians(this->Options.flatAngle)), 4.0 * std::numeric_limits<double>::epsilon());
  this->setBounds();
  this->Result.reason = StopReason::NoProgress;
  const double share = this->Options.adapt ? shareOfEdges(this->Mesh).share() : 0.0;
  const bool started = this->record(0, 0.0, share);
  if (this->Options.adapt)
  {
    this->Operations.nonManifold = nonManifoldPoints(this->Mesh);
  }
  if (!this->Options.adapt)
  {
    this->setFloor(this->Result.history.front());
  }
  this->Passes.proceed = [this]() { return this->Progress.proceed(); };
  this->Passes.postponed = this->flagsOf(this->Options.postponed);
  const bool stopped = !started || !(this->Options.adapt ? this->adapt() : this->runStages()) ||
    (this->Options.improveMean && !this->Options.adapt && !this->improveMean());
  if (!stopped && this->Result.history.back().belowTarget == 0)
  {
    this->Result.reason = StopReason::Reduction;
  }
}

/// Adapts the edges to their target lengths, and improves the worst elements in the metric; false
/// if stopped.
bool Run::adapt()
{
  TetrahedronAdaptation adaptation(this->Mesh, this->Operations, this->Passes);
  adaptation.swaps = this->Options.swap;
  adaptation.moves = this->Options.smooth;
  adaptation.contracts = this->Options.contract;
  adaptation.splits = this->Options.insert;
  adaptation.proceed = [this]() { return this->Progress.proceed(); };
  adaptation.record = [this](double fraction, double share)
  { return this->record(this->Result.history.back().pass + 1, fraction, share); };
  return adaptation.run();
}

/// Runs the stages until the target is reached; false if stopped. Except for their number, they do
/// not depend on the target: a run for a higher target begins like a run for a lower one.
bool Run::runStages()
{
  const std::vector<std::vector<PassOptions>> stages = planStages(this->Options, this->Mesh.size());
  for (std::size_t i = 0; i < stages.size(); ++i)
  {
    const ReconnectionRecord& last = this->Result.history.back();
    const bool sums = this->Operations.sums;
    if (last.belowTarget == 0 && !sums)
    {
      break;
    }
    const double end = static_cast<double>(i + 1) / static_cast<double>(stages.size());
    if ((sums || last.worstQuality < stages[i].back().target) && !this->runStage(stages[i], end))
    {
      return false;
    }
  }
  return true;
}

/// Runs the passes of a stage, in blocks first; false if stopped.
bool Run::runStage(const std::vector<PassOptions>& stage, double end)
{
  const std::vector<char> starts = this->flagsOf(this->Options.starts);
  this->Passes.starts = starts;
  const int levels = levelsOf(this->Mesh.size(), this->Options.blockSize);
  // After the blocks, only the last passes run on the whole mesh, where the blocks could not change
  // it.
  return (levels == 0 || this->runInBlocks(stage, levels, starts, end)) &&
    this->runPasses(this->Passes.starts.empty() ? stage : lastPasses(stage), end);
}

/// One flag per point of the input, or empty.
std::vector<char> Run::flagsOf(const unsigned char* flags) const
{
  return flags ? std::vector<char>(flags, flags + this->Mesh.inputPoints()) : std::vector<char>();
}

/// Runs the passes, the last one repeatedly; false if stopped. @param end progress when done
bool Run::runPasses(std::vector<PassOptions> passes, double end)
{
  const std::size_t planned = passes.size();
  const double start = this->Progress.fraction();
  bool stopped = false;
  for (std::size_t i = 0; i < passes.size() && !stopped; ++i)
  {
    const ReconnectionRecord before = this->Result.history.back();
    if (before.belowTarget == 0 && !this->Operations.sums)
    {
      break;
    }
    if (!this->Operations.sums)
    {
      // The state of the mesh is the new floor: a later end of the run is not worse in any of the
      // worst values.
      this->setFloor(before);
    }
    if (passes[i].repairs > 0 && !this->Passes.starts.empty())
    {
      // Process the worst of the whole mesh again, after the blocks had their share of failures.
      this->Passes.starts.clear();
      passes[i].maxFailures = WholeFailures;
    }
    const bool complete = this->Passes.run(passes[i]) >= 0;
    const double done = static_cast<double>(i + 1) / static_cast<double>(planned + Repetitions);
    stopped = !this->record(before.pass + 1, start + (end - start) * done) || !complete;
    const double gain = this->Result.history.back().worstQuality - before.worstQuality;
    // A pass that has used up its failures is followed by one without the expensive operations.
    if (this->Passes.exhausted() && !stopped)
    {
      passes.push_back(withoutCompound(passes[i]));
    }
    else if (i + 1 == passes.size() && passes[i].compound && gain > RepetitionGain &&
      passes.size() < planned + Repetitions)
    {
      passes.push_back(passes[i]);
    }
  }
  return !stopped;
}

/// Moves all points in turn to improve the mean without worsening the worst; false if stopped.
bool Run::improveMean()
{
  const ReconnectionRecord before = this->Result.history.back();
  this->setFloor(before);
  const bool complete = this->Progress.sweepForMean(this->Mesh.pointSlots(), this->Mesh.size(),
    [this](PointId v) { return this->Operations.improveMean(v); });
  return this->record(before.pass + 1, 1.0) && complete;
}

/// Also flags the points of the surrounding tetrahedra.
std::vector<char> Run::addRings(std::vector<char> flags) const
{
  flags.resize(this->Mesh.pointSlots(), 0);
  for (int ring = 0; ring < StartRings; ++ring)
  {
    const std::vector<char> inner = flags;
    for (TetId t = 0; t < this->Mesh.slots(); ++t)
    {
      pollInterruption(t);
      const TetVertices& v = this->Mesh.tet(t).vertices;
      if (this->Mesh.alive(t) &&
        std::any_of(v.begin(), v.end(), [&](PointId p) { return inner[p] != 0; }))
      {
        std::for_each(v.begin(), v.end(), [&](PointId p) { flags[p] = 1; });
      }
    }
  }
  return flags;
}

/// Runs all passes in each block, several blocks at a time; false if stopped.
bool Run::runBlocks(
  MeshBlockList& blocks, const std::vector<PassOptions>& passes, const std::vector<char>& starts)
{
  std::atomic<bool> stop{ false };
  const std::thread::id caller = std::this_thread::get_id();
  const auto proceed = [&]()
  {
    // Only the calling thread may call the observer; the others test interruption and the clock.
    const bool goesOn = !stop &&
      (std::this_thread::get_id() == caller ? this->Progress.proceed()
                                            : !callerIsInterrupted() && !this->Progress.late());
    if (!goesOn)
    {
      stop = true;
    }
    return goesOn;
  };
  const std::vector<char>& later = this->Passes.postponed;
  const auto postponed = [&later](PointId v)
  { return v < static_cast<PointId>(later.size()) && later[v]; };
  const auto runBlock = [&](Index b)
  {
    MeshBlock& block = *blocks[b];
    TetrahedronPasses& own = block.passes();
    own.proceed = proceed;
    // Tetrahedra at the faces between blocks come last, because their shared points cannot move.
    own.postponed = block.shared();
    for (std::size_t i = 0; i < block.points().size(); ++i)
    {
      const PointId v = block.points()[i];
      own.postponed[i] |= postponed(v);
      if (!starts.empty())
      {
        own.starts.push_back(starts[v]);
      }
    }
    try
    {
      [[maybe_unused]] const bool complete = std::all_of(passes.begin(), passes.end(),
        [&](PassOptions pass)
        {
          // The block has a share of the failures allowed in a pass.
          const Index share = (pass.maxFailures * block.mesh().size()) / this->Mesh.size();
          pass.maxFailures = pass.maxFailures > 0 ? std::max<Index>(share, 1) : 0;
          bool goesOn = !stop && own.run(pass) >= 0;
          if (goesOn && own.exhausted())
          {
            goesOn = own.run(withoutCompound(pass)) >= 0;
          }
          return goesOn;
        });
    }
    catch (...)
    {
      stop = true; // the other blocks need not be finished
      throw;
    }
  };
  parallelFor(static_cast<Index>(blocks.size()), 1, this->Options.threads, runBlock);
  // If nothing else has set the reason, the time is over.
  if (stop && this->Result.reason == StopReason::NoProgress)
  {
    this->Result.reason = StopReason::TimeLimit;
  }
  return !stop;
}

/// Whether enough of the start tetrahedra of the passes are below the target.
bool Run::paysInBlocks(const std::vector<char>& starts, double target) const
{
  if (this->Operations.sums)
  {
    return true;
  }
  Index count = 0;
  for (TetId t = 0; t < this->Mesh.slots(); ++t)
  {
    pollInterruption(t);
    const TetVertices& v = this->Mesh.tet(t).vertices;
    count += this->Mesh.alive(t) && this->Mesh.quality(t) < target &&
      (starts.empty() ||
        std::any_of(v.begin(), v.end(), [&](PointId p) { return starts[p] != 0; }));
  }
  return static_cast<double>(count) >= BlockFraction * static_cast<double>(this->Mesh.size());
}

/// Runs the passes in blocks of several partitions; false if stopped. The next partition continues
/// where the previous one has its faces between blocks; the remaining tetrahedra are left to the
/// passes on the whole mesh.
/// @param starts one flag per point, or empty: all
bool Run::runInBlocks(
  const std::vector<PassOptions>& passes, int levels, std::vector<char> starts, double end)
{
  const double begin = this->Progress.fraction();
  for (int k = 0; k < Partitions && this->paysInBlocks(starts, passes.back().target); ++k)
  {
    MeshBlockList blocks =
      cutIntoBlocks(this->Mesh, this->Operations, k, levels, this->Options.threads);
    const bool goesOn = this->runBlocks(blocks, passes, starts);
    std::vector<char> next(this->Mesh.pointSlots(), 0);
    for (const auto& block : blocks)
    {
      const std::vector<PointId>& points = block->points();
      for (std::size_t v = 0; v < points.size(); ++v)
      {
        next[points[v]] |= block->shared()[v] && (starts.empty() || starts[points[v]]);
      }
    }
    joinBlocks(this->Mesh, this->Operations, blocks, this->Options.threads);
    starts = goesOn ? this->addRings(std::move(next)) : std::vector<char>();
    const double done = BlockProgress * (k + 1) / Partitions;
    const int pass = this->Result.history.back().pass + 1;
    if (!this->record(pass, begin + (end - begin) * done) || !goesOn)
    {
      return false;
    }
  }
  this->Passes.starts = starts;
  return true;
}

/// Labels the facets that are marked. @return how many are kept inside the mesh
Index labelMarked(const ReconnectionOptions& options, TetrahedronMesh& changing)
{
  const std::vector<std::array<Index, 3>>& marked = options.markedFacets;
  std::vector<TriangleVertices> faces;
  for (const std::array<Index, 3>& f : marked)
  {
    if (std::any_of(f.begin(), f.end(),
          [&](Index v) { return v < 0 || v >= static_cast<Index>(changing.pointSlots()); }))
    {
      throw Error("a marked facet has a point that is not in the mesh");
    }
    faces.push_back(
      { static_cast<PointId>(f[0]), static_cast<PointId>(f[1]), static_cast<PointId>(f[2]) });
  }
  return changing.labelFaces(faces, options.adapt);
}

/// Throws Error for target lengths that require more tetrahedra than fit into memory.
void requireFeasible(const TetrahedronMesh& mesh)
{
  constexpr double idealVolume = 0.11785113019775792; // of edges of length 1: sqrt(2) / 12
  constexpr double bytesPerTetrahedron = 500.0;       // of mesh, workspace and result
  double expected = 0.0;
  for (TetId t = 0; t < mesh.slots(); ++t)
  {
    const TetVertices& v = mesh.tet(t).vertices;
    const auto x = [&](int k) { return mesh.point(v[k]); };
    const MetricTensor sum =
      (mesh.metric(v[0]) + mesh.metric(v[1])) + (mesh.metric(v[2]) + mesh.metric(v[3]));
    constexpr double corners = 4.0;
    const double volume = std::abs(dot(x(1) - x(0), cross(x(2) - x(0), x(3) - x(0)))) / 6.0;
    // The determinant of the mean of four 3 x 3 tensors is the determinant of their sum over 4^3.
    expected += volume * std::sqrt(determinantOf(sum) / (corners * corners * corners));
  }
  requireRoom(expected / idealVolume, "tetrahedra", bytesPerTetrahedron);
}

/// The number of marked facets that do not label a face.
Index countIgnored(const ReconnectionOptions& options, const TetrahedronMesh& mesh)
{
  std::vector<char> used(options.markedFacets.size() + 1, 0);
  used[NoLabel] = 1;
  for (TetId t = 0; t < mesh.slots() && mesh.hasLabels(); ++t)
  {
    for (std::int32_t label : mesh.labels(t))
    {
      used[label] = 1;
    }
  }
  return std::count(used.begin(), used.end(), 0);
}

/// Per point: whether it is on a labeled facet inside the mesh.
std::vector<char> pointsOfMarked(const TetrahedronMesh& mesh)
{
  std::vector<char> points(mesh.pointSlots(), 0);
  for (TetId t = 0; t < mesh.slots() && mesh.hasLabels(); ++t)
  {
    for (int i = 0; i < 4; ++i)
    {
      if (mesh.label(t, i) != NoLabel && mesh.tet(t).neighbors[i] != NoId)
      {
        const TriangleVertices f = mesh.face(t, i);
        std::for_each(f.begin(), f.end(), [&](PointId v) { points[v] = 1; });
      }
    }
  }
  return points;
}

/// Fixes the points of marked facets, points around a part, and the fixed points of the options.
/// @return one flag per point for the latter
std::vector<char> fixPoints(const TetrahedronMesh& mesh, const ReconnectionOptions& options,
  const std::vector<char>& marked, std::vector<PointFreedom>& freedoms)
{
  std::vector<char> fixed(freedoms.size(), 0);
  for (std::size_t v = 0; v < freedoms.size(); ++v)
  {
    fixed[v] = options.fixed && options.fixed[v];
    if (fixed[v] || marked[v])
    {
      freedoms[v].fix();
    }
  }
  for (TetId t = 0; options.outside && t < mesh.slots(); ++t)
  {
    for (PointId v : mesh.tet(t).vertices)
    {
      if (mesh.region(t) == OutsideRegion)
      {
        freedoms[v].fix();
      }
    }
  }
  return fixed;
}
}

//------------------------------------------------------------------------------
ReconnectionResult improveConnectivity(const Mesh& mesh, const ReconnectionOptions& options)
{
  checkReconnectionOptions(options);
  ReconnectionInput input = convertInput(mesh, options);
  ReconnectionResult result;
  result.adapted = options.adapt;
  const std::unique_ptr<MetricQuality> metric = metricOf(mesh, input, options);
  TetrahedronMesh changing(input.points, input.cells, input.regions,
    weightsOf(options, metric.get()), options.threads, edgeMetrics(input, options));
  changing.orientFlat();
  checkFaces(changing, options.threads);
  const InputLocator locator(changing, input); // before the cut: it walks across marked facets
  result.markedFacets = labelMarked(options, changing);
  result.ignoredMarks = options.adapt ? countIgnored(options, changing) : 0;
  std::vector<char> marked = pointsOfMarked(changing);
  std::shared_ptr<const InputMetric> field;
  if (options.adapt)
  {
    requireFeasible(changing);
    std::vector<MetricTensor> metrics;
    for (PointId v = 0; v < changing.pointSlots(); ++v)
    {
      metrics.push_back(changing.metric(v));
    }
    field = std::make_shared<InputMetric>(metrics, input, locator, options.threads);
  }
  std::shared_ptr<const BoundarySurface> surface;
  std::vector<PointFreedom> freedoms;
  if (options.boundary == BoundaryMotion::OnSurface && changing.size() > 0)
  {
    // The surface uses the scaled coordinates of the changing mesh.
    MeshView scaled = mesh.view();
    scaled.points = input.points.data()->data();
    surface = std::make_shared<BoundarySurface>(Mesh(scaled), changing, options);
    freedoms = surface->freedoms();
    fixNonManifold(changing, freedoms);
    result.volumeBefore = volumeOf(changing, input.exponent, options.threads);
  }
  else
  {
    freedoms = findFreedoms(changing, options.boundary == BoundaryMotion::FlatParts,
      std::max(std::sin(radians(options.flatAngle)), 4.0 * std::numeric_limits<double>::epsilon()));
  }
  if (options.adapt)
  {
    keepBorders(changing, classesOf(options),
      std::max(std::sin(radians(options.flatAngle)), 4.0 * std::numeric_limits<double>::epsilon()),
      freedoms);
    if (options.boundary == BoundaryMotion::FlatParts)
    {
      marked.assign(marked.size(), 0); // their points move like boundary points
    }
  }
  const std::vector<char> fixedPoints = fixPoints(changing, options, marked, freedoms);
  for (const PointFreedom& freedom : freedoms)
  {
    result.pointsInPlanes += freedom.kind == PointFreedom::InPlane;
    result.pointsOnLines += freedom.kind == PointFreedom::OnLine;
  }
  Run run(changing, options, result);
  if (changing.size() > 0)
  {
    result.meanBefore = meanRatioOf(changing, options.threads);
    run.run(freedoms, surface, field);
    result.meanAfter = meanRatioOf(changing, options.threads);
    findObstacles(changing, run.passes(), options, fixedPoints, result);
  }
  if (metric)
  {
    result.worstMetricBefore = metric->valueOf(result.history.front().worstQuality);
    result.worstMetricAfter = metric->valueOf(result.history.back().worstQuality);
  }
  if (surface)
  {
    result.volumeAfter = volumeOf(changing, input.exponent, options.threads);
    result.boundaryDistance = std::ldexp(surface->distance(changing), input.exponent);
  }
  convertOutput(mesh, input, changing, locator, options.threads, result);
  if (options.adapt)
  {
    convertFacets(input, options, mesh.mirrored(), changing, result);
  }
  if (options.overlaps)
  {
    computeOverlaps(input, changing, locator, options.threads, result);
  }
  return result;
}
}
