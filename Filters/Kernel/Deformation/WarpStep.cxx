// SPDX-License-Identifier: BSD-3-Clause
#include "WarpStep.h"

#include "WarpCoefficients.h"
#include "WarpElastic.h"
#include "WarpPointwise.h"
#include "tautline/Optimization/Optimize.h"
#include "tautline/Quality/Targets.h"
#include "tautline/Untangling/Untangle.h"

namespace tautline
{
namespace
{
/// Inverse mean ratios relative to the initial mesh. A triangle stretched to 3.7 times its length
/// at constant area has the first value; to 20 times, the second.
constexpr double GoodRatio = 2, PoorRatio = 10;

/// Temporarily replaces the points of a distributed mesh; restores them on destruction.
class PlacedMesh
{
public:
  PlacedMesh(DistributedMesh& mesh, const std::vector<double>& points)
    : Placed(mesh)
    , Before(mesh.points())
  {
    // Copy in place, because views of the mesh refer to this memory.
    std::copy(points.begin(), points.end(), mesh.points().begin());
  }
  ~PlacedMesh()
  {
    std::copy(this->Before.begin(), this->Before.end(), this->Placed.points().begin());
  }
  PlacedMesh(const PlacedMesh&) = delete;
  PlacedMesh& operator=(const PlacedMesh&) = delete;

private:
  DistributedMesh& Placed;
  const std::vector<double> Before;
};
}

//------------------------------------------------------------------------------
WarpStep::WarpStep(const Mesh& from, const Mesh& initial, const WarpParts& parts)
  : From(from)
  , Initial(initial)
  , Parts(parts)
{
}

WarpStep::~WarpStep() = default;

//------------------------------------------------------------------------------
/// Builds the scalar operator with the coefficients of this motion unless it exists already.
void WarpStep::updateFemwarp(const double* displacement, WarpControl& control)
{
  const WarpOptions& options = control.options();
  const std::vector<unsigned char>& prescribed = this->Parts.prescribed();
  SymmetricTensor tensor = IdentityTensor;
  const double* tensors = nullptr;
  if (!this->Following && isAnisotropic(options.method))
  {
    switch (options.coefficients)
    {
      case WarpCoefficients::DisplacementSums:
        tensor = displacementSums(prescribed, displacement, this->Parts.ranks());
        break;
      case WarpCoefficients::PrincipalDirections:
        tensor = principalDirections(prescribed, displacement, this->Parts.ranks());
        break;
      case WarpCoefficients::Manual:
        tensor = options.tensor;
        break;
      case WarpCoefficients::PerCell:
        tensors = options.tensors;
        break;
      case WarpCoefficients::LocalGradients:
      {
        // The motion of the interior, by FEMWARP, gives the coefficients of the second solve.
        Femwarp first(
          this->From, this->Parts, Femwarp::Operator::Harmonic, IdentityTensor, nullptr, control);
        this->Tensors = localGradients(
          this->From.view(), first.warp(displacement, control).data(), this->Parts.ranks());
        this->Tensors.reserve(1); // avoid a null pointer on a rank without cells
        tensors = this->Tensors.data();
        this->Scalar.reset();
        break;
      }
    }
  }
  // Reuse the matrix if the coefficients differ only by rounding.
  constexpr double rounding = 1e-12;
  bool same = this->Scalar != nullptr;
  for (std::size_t k = 0; k < tensor.size(); ++k)
  {
    same = same && std::abs(tensor[k] - this->Tensor[k]) <= rounding;
  }
  if (!same)
  {
    const auto kind = options.method == WarpMethod::Biharmonic ? Femwarp::Operator::Biharmonic
                                                               : Femwarp::Operator::Harmonic;
    this->Scalar =
      std::make_unique<Femwarp>(this->From, this->Parts, kind, tensor, tensors, control);
    this->Tensor = tensor;
  }
  control.result().tensor = this->Tensor;
}

//------------------------------------------------------------------------------
/// The displacements of all points by the equations of the method.
void WarpStep::warp(
  WarpMethod method, const double* displacement, WarpControl& control, std::vector<double>& moved)
{
  const std::vector<unsigned char>& prescribed = this->Parts.prescribed();
  switch (method)
  {
    case WarpMethod::InverseDistance:
      moved = this->warpPointwise(warpByInverseDistance, displacement, control);
      break;
    case WarpMethod::InverseDistanceRotations:
      moved = this->warpPointwise(warpByRigidMeans, displacement, control);
      break;
    case WarpMethod::RadialBasis:
      moved = this->warpPointwise(warpByRadialBasis, displacement, control);
      break;
    case WarpMethod::WeightedLaplacian:
      moved = this->Parts.ranks().several()
        ? warpByWeightedLaplacian(this->From, this->Parts, displacement, control)
        : warpByWeightedLaplacian(this->From, prescribed, displacement, control);
      break;
    case WarpMethod::IterativeStiffening:
    case WarpMethod::JacobianStiffening:
      if (!this->Elastic)
      {
        this->Elastic = std::make_unique<ElasticWarp>(this->From, this->Parts, control);
      }
      moved = this->Elastic->warp(displacement, control);
      break;
    default:
      this->updateFemwarp(displacement, control);
      moved = this->Scalar->warp(displacement, control);
  }
  if (this->Parts.ranks().any(moved.empty() && !prescribed.empty()))
  {
    // Stopped before a result was available: only the prescribed points have moved.
    control.proceed(1.0);
    moved.assign(3 * prescribed.size(), 0.0);
  }
  // Parts that do not move keep their coordinates exactly, with every method.
  const std::vector<char> moving = this->Parts.moving(displacement);
  for (std::size_t i = 0; i < prescribed.size(); ++i)
  {
    const Index part = this->Parts.part(static_cast<Index>(i));
    if (prescribed[i])
    {
      std::copy_n(displacement + 3 * i, 3, &moved[3 * i]);
    }
    else if (part < 0 || !moving[part])
    {
      std::fill_n(&moved[3 * i], 3, 0.0);
    }
  }
}

//------------------------------------------------------------------------------
/// Warps with a pointwise method: on several ranks, with the prescribed points of all ranks in the
/// order of their ids and the owned free points, without cells.
std::vector<double> WarpStep::warpPointwise(
  PointwiseMethod method, const double* displacement, WarpControl& control) const
{
  const std::vector<unsigned char>& prescribed = this->Parts.prescribed();
  const Ranks& ranks = this->Parts.ranks();
  const int threads = control.options().threads;
  std::vector<WallPoint> walls;
  ranks.together([&] { walls = wallPoints(this->From, prescribed, displacement); });
  if (!ranks.several())
  {
    return method(
      PrescribedMotion(this->From, prescribed, displacement, threads, std::move(walls)), control);
  }
  const MeshView& local = this->From.view();
  const std::vector<PrescribedPoint> given =
    this->Parts.prescribedOfAll(local, displacement, walls);
  std::vector<double> moved;
  ranks.together(
    [&]
    {
      std::vector<double> points, displacements;
      std::vector<WallPoint> known;
      for (const PrescribedPoint& one : given)
      {
        points.insert(points.end(), one.place.begin(), one.place.end());
        displacements.insert(displacements.end(), one.displacement.begin(), one.displacement.end());
        known.push_back(one.wall);
      }
      std::vector<Index> free;
      for (Index i = 0; i < local.numberOfPoints; ++i)
      {
        if (!prescribed[i] && ranks.owns(i))
        {
          free.push_back(i);
          points.insert(points.end(), local.points + 3 * i, local.points + 3 * i + 3);
        }
      }
      displacements.resize(points.size(), 0.0);
      known.resize(points.size() / 3);
      std::vector<unsigned char> flags(points.size() / 3, 0);
      std::fill_n(flags.begin(), given.size(), 1);
      const Index start = 0;
      MeshView cloud;
      cloud.numberOfPoints = static_cast<Index>(flags.size());
      cloud.points = points.data();
      cloud.offsets = &start;
      const Mesh mesh(cloud);
      const std::vector<double> result = method(
        PrescribedMotion(mesh, flags, displacements.data(), threads, std::move(known)), control);
      if (result.empty())
      {
        return;
      }
      moved.assign(3 * prescribed.size(), 0.0);
      for (std::size_t k = 0; k < free.size(); ++k)
      {
        std::copy_n(&result[3 * (given.size() + k)], 3, &moved[3 * free[k]]);
      }
    });
  if (!control.proceed(1.0) || ranks.any(moved.empty() && !prescribed.empty()))
  {
    return {};
  }
  ranks.exchange(moved.data(), 3);
  return moved;
}

//------------------------------------------------------------------------------
WarpQuality WarpStep::record(const char* stage, double amount, int iterations, const double* points,
  WarpControl& control) const
{
  const WarpQuality quality =
    qualityOf(this->Initial, points, control.options().threads, this->Parts.ranks());
  WarpRecord record;
  record.amount = amount;
  record.inverted = quality.inverted;
  record.worstShape = quality.worst;
  record.meanShape = quality.mean;
  record.worstRatio = quality.worstRatio;
  record.seconds = control.elapsed();
  record.iterations = iterations;
  record.stage = stage;
  control.result().history.push_back(record);
  return quality;
}

//------------------------------------------------------------------------------
/// Computes the points by the equations of a method and records them.
WarpQuality WarpStep::warpBy(WarpMethod method, const char* stage, const double* displacement,
  double amount, WarpControl& control, std::vector<double>& points)
{
  const int before = control.iterations();
  this->warp(method, displacement, control, points);
  const double* from = this->From.view().points;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    points[i] += from[i];
  }
  return this->record(stage, amount, control.iterations() - before, points.data(), control);
}

//------------------------------------------------------------------------------
/// Automatic: tries the explicit methods in turn until one gives good elements; otherwise takes the
/// best result.
WarpQuality WarpStep::warpByBest(
  const double* displacement, double amount, WarpControl& control, std::vector<double>& points)
{
  const struct
  {
    WarpMethod method;
    const char* stage;
  } methods[] = { { WarpMethod::RadialBasis, "radial basis" },
    { WarpMethod::InverseDistanceRotations, "inverse distance" } };
  WarpResult& result = control.result();
  result.attempts.clear();
  WarpQuality best;
  for (const auto& [method, stage] : methods)
  {
    std::vector<double> moved;
    const WarpQuality quality = this->warpBy(method, stage, displacement, amount, control, moved);
    result.attempts.push_back({ method, quality.inverted, quality.worstRatio });
    const bool better = result.attempts.size() == 1 || quality.inverted < best.inverted ||
      (quality.inverted == best.inverted && quality.worstRatio < best.worstRatio);
    if (better)
    {
      points = std::move(moved);
      best = quality;
      result.chosen = method;
    }
    if (control.stopped() || (quality.inverted == 0 && quality.worstRatio <= GoodRatio))
    {
      break;
    }
  }
  return best;
}

//------------------------------------------------------------------------------
Index WarpStep::run(
  const double* displacement, double amount, WarpControl& control, std::vector<double>& points)
{
  const WarpMethod method = control.options().method;
  const bool chooses = method == WarpMethod::Automatic && !this->Following;
  WarpResult& result = control.result();
  if (!this->Following)
  {
    result.chosen = method;
  }
  const WarpQuality quality = chooses
    ? this->warpByBest(displacement, amount, control, points)
    : this->warpBy(method, "warp", displacement, amount, control, points);
  result.invertedAfter = result.invertedWarp = quality.inverted;
  const bool enough = chooses && quality.inverted == 0 && quality.worstRatio <= PoorRatio;
  if (untangles(method) && !enough && !control.stopped())
  {
    this->improve(displacement, amount, control, points);
  }
  return result.invertedAfter;
}

//------------------------------------------------------------------------------
/// Step 2 of the hybrid algorithm, section 4.9.2, or untangling alone.
void WarpStep::improve(
  const double* displacement, double amount, WarpControl& control, std::vector<double>& points)
{
  const WarpOptions& options = control.options();
  WarpResult& result = control.result();
  const double start = control.elapsed();
  const std::vector<char> moving = this->Parts.moving(displacement);
  // Parts that do not move are not optimized.
  std::vector<unsigned char> fixed = this->Parts.held();
  for (std::size_t i = 0; i < fixed.size(); ++i)
  {
    const Index part = this->Parts.part(static_cast<Index>(i));
    fixed[i] = fixed[i] || part < 0 || !moving[part];
  }
  const Ranks& ranks = this->Parts.ranks();
  if (!ranks.any(std::find(fixed.begin(), fixed.end(), 0) != fixed.end()))
  {
    return;
  }
  const auto stage = [&](const char* name, int iterations) {
    result.invertedAfter = this->record(name, amount, iterations, points.data(), control).inverted;
  };
  // Surfaces have no model for sliding points here.
  const bool surface = this->Parts.dimension() == Dimension::Surface;
  const bool literal = options.method == WarpMethod::Hybrid && !options.untangleFirst && !surface;
  if (literal && !this->Following)
  {
    stage("optimize", this->optimize(Aim::Shape, fixed, control, points));
  }
  const bool tangled = result.invertedAfter > 0;
  const bool poor = tangled || result.history.back().worstRatio > PoorRatio;
  const Index cells =
    ranks.several() ? ranks.mesh().globalCells() : this->Initial.view().numberOfCells;
  const bool restoresAll =
    options.method == WarpMethod::Hybrid || options.method == WarpMethod::Automatic;
  if (tangled && !control.stopped())
  {
    const std::vector<double> before = points;
    stage("untangle", this->untangle(fixed, control, points));
    for (std::size_t i = 0; i < fixed.size() && !restoresAll && !this->Following; ++i)
    {
      const std::ptrdiff_t at = 3 * static_cast<std::ptrdiff_t>(i);
      fixed[i] = fixed[i] || std::equal(&points[at], &points[at] + 3, &before[at]); // not untangled
    }
  }
  // Within a sequence of steps, the next step needs a good mesh; otherwise the target is the shape
  // of the initial mesh. Untangling only uses ideal elements as targets, which do not suit thin
  // layers.
  const bool optimizes = this->Following || !restoresAll
    ? result.invertedAfter == 0 && (this->Following || tangled)
    : !literal && result.invertedAfter < cells;
  if (optimizes && !surface && !control.stopped())
  {
    // The shape (4.22) grows with the fourth power of T. Its descent stalls at barely valid
    // elements: for a box rotating by 120 degrees in a box, at a worst value of 870 instead of 41.
    // The barrier improves these elements first.
    int iterations = 0;
    if (result.invertedAfter == 0 && (this->Following || poor))
    {
      const std::vector<double> before = points;
      iterations = this->optimize(Aim::Barrier, fixed, control, points);
      // The mean may grow relative to the start of the optimization, so a new optimization is
      // started. On several ranks, the worst elements are not improved individually.
      const bool worst = !this->Following && !ranks.several() && !control.stopped() &&
        qualityOf(this->Initial, points.data(), options.threads).worstRatio > PoorRatio;
      if (worst)
      {
        points = before;
        iterations += this->optimize(Aim::Worst, fixed, control, points);
      }
    }
    if (restoresAll && !this->Following && !control.stopped())
    {
      const std::vector<double> before = points;
      const auto worstOf = [&](const std::vector<double>& x)
      { return qualityOf(this->Initial, x.data(), options.threads, ranks).worstRatio; };
      iterations += this->optimize(Aim::Shape, fixed, control, points);
      if (!control.stopped() && worstOf(points) > std::max(PoorRatio, worstOf(before)))
      {
        points = before;
        iterations += this->optimize(Aim::HeldShape, fixed, control, points);
      }
    }
    stage("optimize", iterations);
  }
  result.improveSeconds += control.elapsed() - start;
}

//------------------------------------------------------------------------------
/// The initial mesh with other points, which must outlive it.
Mesh WarpStep::moved(const std::vector<double>& points, int threads) const
{
  MeshView view = this->Initial.view();
  view.points = points.data();
  Mesh mesh(view, threads);
  mesh.setMirrored(this->Initial.mirrored());
  mesh.setSpace(this->Initial.space()); // a surface may become planar
  return mesh;
}

//------------------------------------------------------------------------------
int WarpStep::untangle(
  const std::vector<unsigned char>& fixed, WarpControl& control, std::vector<double>& points) const
{
  const Ranks& ranks = this->Parts.ranks();
  UntangleOptions options;
  options.effort = this->Following ? Effort::Local : Effort::Normal;
  options.fixed = fixed.data();
  options.threads = control.options().threads;
  options.maximumSeconds = control.secondsLeft();
  options.observer = [&control](const IterationState& state)
  { return control.watch(0.3 + 0.4 * state.progress); };
  UntangleResult done =
    tautline::untangle(this->moved(points, control.options().threads), options, ranks);
  if (done.exceededMemory)
  {
    control.addMessage("The whole mesh did not fit into the memory of the first process, so "
                       "the remaining elements were not untangled there.");
  }
  if (done.reason == StopReason::TimeLimit)
  {
    control.result().timeLimit = true;
  }
  control.agree();
  points = std::move(done.points);
  control.result().impossible = done.impossible;
  return done.history.empty() ? 0 : done.history.back().iteration;
}

//------------------------------------------------------------------------------
/// The mean element size of the whole initial mesh.
double WarpStep::meanSize() const
{
  const Ranks& ranks = this->Parts.ranks();
  const Index cells = this->Initial.view().numberOfCells;
  std::vector<double> sizes(cells), own;
  double sum = 0;
  Index count = 0;
  ranks.together(
    [&]
    {
      if (cells > 0)
      {
        evaluateMetric(this->Initial, Metric::Size, EvaluationOptions(), sizes.data());
      }
      for (Index cell = 0; cell < cells; ++cell)
      {
        if (ranks.ownsCell(cell))
        {
          own.push_back(std::abs(sizes[cell]));
          sum += own.back();
        }
      }
      count = static_cast<Index>(own.size());
    });
  if (ranks.several())
  {
    sum = ranks.mesh().group().orderlessSum(own);
    count = ranks.sum(count);
  }
  return sum / std::max<double>(1.0, static_cast<double>(count));
}

//------------------------------------------------------------------------------
int WarpStep::optimize(Aim aim, const std::vector<unsigned char>& fixed, WarpControl& control,
  std::vector<double>& points) const
{
  const Ranks& ranks = this->Parts.ranks();
  std::unique_ptr<Mesh> mesh;
  Targets targets;
  ranks.together(
    [&]
    {
      mesh.reset(new Mesh(this->moved(points, control.options().threads)));
      if (mesh->view().numberOfCells > 0)
      {
        targets = referenceTargets(*mesh, this->Initial);
      }
    });
  const WarpOptions& options = control.options();
  OptimizeOptions optimization = options.optimization;
  optimization.fixed = fixed.data();
  optimization.slidePlanes = optimization.slideLines = optimization.limits = nullptr;
  optimization.slideSurface = nullptr;
  optimization.model = nullptr;
  optimization.untangleFirst = false;
  optimization.threads = options.threads;
  optimization.scalarization.method = Scalarization::ExponentialSum;
  optimization.objectives.assign(2, Objective());
  // (4.24): the exponential sum of the shape and of a second metric. No element may get worse in
  // the first metric.
  const bool holds = aim == Aim::HeldShape;
  Objective &shape = optimization.objectives[holds ? 1 : 0],
            &other = optimization.objectives[holds ? 0 : 1];
  shape.metric = Metric::ShapeSimilarity;
  shape.objectiveTemplate = ObjectiveTemplate::SumOfSquares;
  shape.evaluation.targets = &targets;
  other.objectiveTemplate = ObjectiveTemplate::SumOfSquares;
  if (aim != Aim::Shape && aim != Aim::HeldShape)
  {
    constexpr int few = 10;             // sweeps between two steps
    constexpr double costOfWorst = 0.1; // of the mean
    shape.metric = Metric::InverseMeanRatio;
    optimization.objectives.resize(1);
    optimization.stopping = StoppingCriteria();
    if (this->Following)
    {
      optimization.stopping.maximumIterations = few;
    }
    else if (aim == Aim::Worst)
    {
      optimization.improveWorst = costOfWorst;
      optimization.worstMetric = Metric::InverseMeanRatio;
    }
    optimization.optimizer = Optimizer::Automatic;
  }
  else if (options.untangleFirst)
  {
    other.metric = Metric::InverseMeanRatio;
    other.evaluation.targets = &targets;
  }
  else
  {
    other.metric = Metric::UntangleBeta;
    other.evaluation.parameters.beta = options.untanglingBeta * this->meanSize();
  }
  StoppingCriteria& stop = optimization.stopping;
  if (options.maximumSeconds > 0)
  {
    const double left = control.secondsLeft();
    stop.maximumSeconds = stop.maximumSeconds > 0 ? std::min(left, stop.maximumSeconds) : left;
  }
  optimization.observer = [&control](const IterationState& state)
  { return control.watch(0.7 + 0.3 * state.progress); };
  OptimizeResult done = tautline::optimize(*mesh, optimization, {}, ranks);
  control.agree();
  points = std::move(done.points);
  return done.iterations;
}
}
