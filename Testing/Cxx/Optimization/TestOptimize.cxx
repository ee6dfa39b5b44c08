// SPDX-License-Identifier: BSD-3-Clause
// The optimizer: minima, invariances, objectives, stopping, faulty input.
#include "Optimizing.h"
#include "Registry.h"
#include "tautline/Optimization/SweepControl.h"

#include <cstring>
#include <iterator>
#include <thread>

using namespace tautline;

namespace
{
constexpr Optimizer optimizers[] = { Optimizer::Automatic, Optimizer::LocalNewton,
  Optimizer::LocalConjugateGradient, Optimizer::ConjugateGradientFletcherReeves,
  Optimizer::ConjugateGradientPolakRibiere, Optimizer::LimitedMemoryBFGS,
  Optimizer::NewtonConjugateGradient };

/// All algorithms find the same minimum, and keep the boundary.
TAUTLINE_PART(testMinima)
{
  for (CellType type : allTypes)
  {
    const Context context(topology(type).name);
    const double amplitude =
      type == CellType::Pyramid || type == CellType::Tetrahedron ? 0.1 : 0.25;
    const MeshData data = perturbedBlock(type, 4, amplitude / 1.0);
    TAUTLINE_CHECK_EQUAL(invalid(data, data.points), Index(0));
    double least = 0;
    for (Optimizer optimizer : optimizers)
    {
      const Context which("optimizer " + std::to_string(static_cast<int>(optimizer)));
      TAUTLINE_LET(OptimizeOptions, options, optimizer = optimizer,
        stopping.maximumIterations = 400, stopping.relativeChange = 1e-13,
        stopping.gradientNorm = 1e-9);
      const OptimizeResult result = run(data, options);
      checkHistory(data, result);
      TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
      const double F = result.history.back().objective;
      TAUTLINE_CHECK(F < result.history.front().objective);
      least = optimizer == Optimizer::Automatic ? F : least;
      TAUTLINE_CHECK_RELATIVE(F, least, 1e-6);
      const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
      for (Index i = 0; i < data.numberOfPoints(); ++i)
      {
        if (boundary[i])
        {
          TAUTLINE_CHECK_EQUAL(
            std::memcmp(&result.points[3 * i], &data.points[3 * i], 3 * sizeof(double)), 0);
        }
      }
    }
    if (type == CellType::Quadrilateral || type == CellType::Hexahedron)
    {
      TAUTLINE_CHECK_RELATIVE(
        least, static_cast<double>(data.numberOfCells()), 1e-6); // cubes again
    }
  }
}

/// One free vertex goes to the center of a regular hexagon.
TAUTLINE_PART(testSingleVertex)
{
  TAUTLINE_LET(MeshData, data, addPoint({ 0.3, -0.2, 0 }));
  for (int k = 0; k < 6; ++k)
  {
    const double angle = k * std::acos(-1.0) / 3;
    data.addPoint({ std::cos(angle), std::sin(angle), 0 });
  }
  for (Index k = 0; k < 6; ++k)
  {
    data.addCell(CellType::Triangle, std::vector<Index>{ 0, 1 + k, 1 + (k + 1) % 6 });
  }
  TAUTLINE_LET(OptimizeOptions, options, stopping.relativeChange = 0, stopping.gradientNorm = 1e-12,
    relaxation = 1.0);
  const OptimizeResult result = run(data, options);
  TAUTLINE_CHECK_NEAR(result.points[0], 0.0, 1e-9);
  TAUTLINE_CHECK_NEAR(result.points[1], 0.0, 1e-9);
  TAUTLINE_CHECK_NEAR(result.history.back().worst[0], 1.0, 1e-12);
  TAUTLINE_CHECK_EQUAL(result.freeVertices, Index(1));
  TAUTLINE_CHECK(result.reason == StopReason::GradientNorm);
}

/// Rotated, shifted, scaled and relabelled meshes come to the same.
TAUTLINE_PART(testInvariance)
{
  for (CellType type : { CellType::Triangle, CellType::Tetrahedron, CellType::Hexahedron })
  {
    const Context context(topology(type).name);
    const MeshData data = perturbedBlock(type, 4, 0.1);
    TAUTLINE_LET(
      OptimizeOptions, options, stopping.maximumIterations = 60, stopping.relativeChange = 1e-12);
    const double F = run(data, options).history.back().objective;
    Random random(11);
    const Columns turn = randomRotation(random);
    for (double scale : { 1e-8, 1.0, 1e8 })
    {
      const Context which("scale " + std::to_string(scale));
      MeshData moved = shuffled(data, 5);
      moved.transform([&](const Vec3& p) { return scale * (turn * p); });
      const OptimizeResult result = run(moved, options);
      TAUTLINE_CHECK_RELATIVE(result.history.back().objective, F, 1e-7);
      TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
    }
    MeshData far = data;
    far.transform([](const Vec3& p) { return p + Vec3{ 1e6, -1e6, 0 }; });
    const OptimizeResult result = run(far, options);
    TAUTLINE_CHECK_RELATIVE(result.history.back().objective, F, 1e-6);

    // A mesh listed the other way round is its mirror image.
    MeshData reversed = data;
    for (Index c = 0; c < data.numberOfCells(); ++c)
    {
      if (type != CellType::Hexahedron)
      {
        std::swap(reversed.connectivity[reversed.offsets[c]],
          reversed.connectivity[reversed.offsets[c] + 1]);
      }
    }
    if (type != CellType::Hexahedron)
    {
      Mesh mesh(reversed.view());
      mesh.setMirrored(true);
      const OptimizeResult mirrored = optimize(mesh, options);
      TAUTLINE_CHECK_RELATIVE(mirrored.history.back().objective, F, 1e-7);
      TAUTLINE_CHECK_EQUAL(mirrored.invertedAfter, Index(0));
    }
  }
}

/// Bitwise the same on 1, 2 and 4 threads, in closed form and through a metric, one or several
/// objectives.
TAUTLINE_PART(testThreads)
{
  const MeshData data = perturbedBlock(CellType::Tetrahedron, 14, 0.12);
  for (int which = 0; which < 4; ++which)
  {
    const Context context("case " + std::to_string(which));
    TAUTLINE_LET(OptimizeOptions, options, stopping.maximumIterations = 3);
    TAUTLINE_LET(Objective, second, metric = which == 1 ? Metric::Size : Metric::RadiusRatio);
    if (which == 1 || which == 2)
    {
      options.objectives.push_back(second);
    }
    options.optimizer = which == 3 ? Optimizer::LimitedMemoryBFGS : Optimizer::Automatic;
    std::vector<double> first;
    for (int threads : { 1, 2, 4 })
    {
      options.threads = threads;
      const OptimizeResult result = run(data, options);
      first = threads == 1 ? result.points : first;
      TAUTLINE_CHECK_EQUAL(
        std::memcmp(first.data(), result.points.data(), first.size() * sizeof(double)), 0);
    }
  }
}

/// Several objectives under each scalarization: the value falls, and no objective is forgotten.
TAUTLINE_PART(testScalarizations)
{
  const MeshData data = perturbedBlock(CellType::Triangle, 8, 0.25);
  for (int method = 0; method <= 7; ++method)
  {
    for (Optimizer optimizer :
      { Optimizer::LocalNewton, Optimizer::LocalConjugateGradient, Optimizer::LimitedMemoryBFGS })
    {
      const Context context("scalarization " + std::to_string(method) + " optimizer " +
        std::to_string(static_cast<int>(optimizer)));
      TAUTLINE_LET(OptimizeOptions, options, optimizer = optimizer);
      TAUTLINE_LET(Objective, second, metric = Metric::Size);
      options.objectives.push_back(second);
      options.scalarization.method = static_cast<Scalarization>(method);
      const OptimizeResult result = run(data, options);
      TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
      const IterationRecord &first = result.history.front(), &last = result.history.back();
      if (options.scalarization.method != Scalarization::Lexicographic)
      {
        TAUTLINE_CHECK(last.objective < first.objective);
      }
      TAUTLINE_CHECK(last.objectives[0] < first.objectives[0]);
      TAUTLINE_CHECK_RELATIVE(
        sumOfSquares(data, result.points, Metric::InverseMeanRatio), last.objectives[0], 1e-10);
      TAUTLINE_CHECK_RELATIVE(
        sumOfSquares(data, result.points, Metric::Size), last.objectives[1], 1e-10);
    }
  }
}

/// The last objective of the lexicographic method is not the first one, which may be smaller.
TAUTLINE_PART(testLexicographic)
{
  const MeshData data = perturbedBlock(CellType::Tetrahedron, 6, 0.25);
  OptimizeOptions options;
  TAUTLINE_LET(Objective, second, metric = Metric::EdgeRatio);
  options.objectives.push_back(second);
  options.scalarization.method = Scalarization::Lexicographic;
  for (const Optimizer optimizer : { Optimizer::LocalNewton, Optimizer::LimitedMemoryBFGS })
  {
    const Context context("optimizer " + std::to_string(static_cast<int>(optimizer)));
    options.optimizer = optimizer;
    const OptimizeResult result = run(data, options);
    const IterationRecord &first = result.history.front(), &last = result.history.back();
    TAUTLINE_CHECK(last.objective > first.objective); // of the second, and of the first
    TAUTLINE_CHECK(!result.unchanged);
    TAUTLINE_CHECK(last.objectives[0] < 0.99 * first.objectives[0]);
    TAUTLINE_CHECK(last.objectives[1] < 0.99 * first.objectives[1]);
  }
}

/// Points that are put back raise the first objective beyond the bound that the lexicographic
/// method keeps: the history has the second one instead of an infinite number.
TAUTLINE_PART(testLexicographicBeyondBound)
{
  TAUTLINE_LET(ScalarizationOptions, options, method = Scalarization::Lexicographic);
  Scalarizer scalarizer(options, { 1.0, 1.0 }, { 8.0, 5.0 });
  IterationRecord record;
  record.objectives = { 6.0, 4.0 };
  TAUTLINE_CHECK(scalarizer.next(record.objectives));
  record.objectives = { 7.0, 3.0 };
  record.objective = scalarizer.value(record.objectives);
  TAUTLINE_CHECK(std::isinf(record.objective));
  TAUTLINE_CHECK_EQUAL(presentable(scalarizer, record).objective, 3.0);
  record.objective = 2.5;
  TAUTLINE_CHECK_EQUAL(presentable(scalarizer, record).objective, 2.5);
}

/// Blocks of one color, each of which reduces a product by itself, together leave its domain: the
/// sweep is taken back.
TAUTLINE_PART(testSweepTakenBack)
{
  const MeshData data = perturbedBlock(CellType::Quadrilateral, 40, 0.25);
  const auto objective = [](Metric metric)
  {
    return TAUTLINE_CHANGED(
      Objective(), metric = metric, objectiveTemplate = ObjectiveTemplate::Maximum);
  };
  TAUTLINE_LET(OptimizeOptions, options, optimizer = Optimizer::LocalNewton);
  options.objectives = { objective(Metric::InverseMeanRatio), objective(Metric::ScaledJacobian) };
  options.scalarization.method = Scalarization::ObjectiveProduct;
  const OptimizeResult result = run(data, options);
  TAUTLINE_CHECK(result.reason == StopReason::NoProgress);
  for (std::size_t i = 0; i < result.history.size(); ++i)
  {
    const double now = result.history[i].objective;
    TAUTLINE_CHECK(std::isfinite(now));
    TAUTLINE_CHECK(i == 0 || now <= result.history[i - 1].objective);
  }
  // The points belong to the last record.
  MeshData moved = TAUTLINE_CHANGED(data, points = result.points);
  options.stopping.maximumIterations = 0;
  const std::vector<double> last = result.history.back().objectives;
  const std::vector<double> found = run(moved, options).history.front().objectives;
  TAUTLINE_CHECK_RELATIVE(found[0], last[0], 1e-12);
  TAUTLINE_CHECK_RELATIVE(found[1], last[1], 1e-12);
}

/// Shape and untangling of a tangled mesh as one product.
OptimizeOptions shapeAndUntangling(double beta)
{
  TAUTLINE_LET(OptimizeOptions, options, optimizer = Optimizer::LocalConjugateGradient,
    allowInversion = true, untangleFirst = false, culling = 0);
  options.objectives = { Objective(), Objective() };
  options.objectives[0].metric = Metric::ConditioningScaleInvariant;
  options.objectives[1].metric = Metric::UntangleBeta;
  options.objectives[1].evaluation.parameters.beta = beta;
  options.scalarization.method = Scalarization::ObjectiveProduct;
  return options;
}

/// Where several steps a patch raise the product, the sweep is repeated with one: the first sweep
/// is then the same as if one had been asked for.
TAUTLINE_PART(testFallsBackToOneStep)
{
  const MeshData data = perturbedBlock(CellType::Triangle, 40, 0.6);
  OptimizeOptions options = shapeAndUntangling(0.01);
  const OptimizeResult one = run(data, options);
  options.patchIterations = 5;
  const OptimizeResult several = run(data, options);
  TAUTLINE_CHECK(one.history.front().inverted > 0);
  TAUTLINE_CHECK_EQUAL(several.history.back().inverted, 0);
  TAUTLINE_CHECK_EQUAL(several.history[1].inverted, one.history[1].inverted);
  TAUTLINE_CHECK_RELATIVE(several.history[1].objective, one.history[1].objective, 1e-9);
}

/// Combined on patches, the product untangles by other steps than on the whole mesh; a sum has the
/// same slopes on both.
TAUTLINE_PART(testScalarizationOnPatches)
{
  MeshData small = blockMesh(CellType::Triangle, 2, 2, 0);
  const std::vector<char> boundary = Mesh(small.view()).boundary().isBoundaryPoint;
  for (Index i = 0; i < small.numberOfPoints(); ++i)
  {
    small.setPoint(i, small.point(i) + (boundary[i] ? Vec3{ 0, 0, 0 } : Vec3{ 1.2, 0.3, 0 }));
  }
  const MeshData large = perturbedBlock(CellType::Triangle, 40, 0.6);
  OptimizeOptions options = shapeAndUntangling(0.01);
  options.scalarization.onPatches = true;
  const OptimizeResult result = run(large, options);
  TAUTLINE_CHECK(result.history.front().inverted > 0);
  TAUTLINE_CHECK_EQUAL(result.history.back().inverted, 0);
  OptimizeOptions whole = options;
  whole.scalarization.onPatches = false;
  TAUTLINE_CHECK(run(large, whole).history[1].objective != result.history[1].objective);

  for (Scalarization method : { Scalarization::EqualSum, Scalarization::WeightedSum })
  {
    // The slopes of a sum are the same everywhere.
    options.scalarization.method = whole.scalarization.method = method;
    const OptimizeResult a = run(small, options), b = run(small, whole);
    for (std::size_t i = 0; i < a.points.size(); ++i)
    {
      TAUTLINE_CHECK_NEAR(a.points[i], b.points[i], 1e-9);
    }
  }
  options.scalarization.method = Scalarization::Lexicographic;
  OptimizeOptions alone = options;
  alone.objectives.resize(1);
  alone.untangleFirst = true;
  TAUTLINE_CHECK_EQUAL(run(small, alone).history.back().inverted, 0); // one is not combined
  TAUTLINE_CHECK_THROWS(run(small, options), wording("choose-exponential-sum-objective-product"));
  options.scalarization.method = Scalarization::ObjectiveProduct;
  OptimizeOptions mean = options;
  mean.objectives[0].objectiveTemplate = ObjectiveTemplate::PowerMean;
  TAUTLINE_CHECK_THROWS(run(small, mean), wording("sums-over-the-elements"));
  options.optimizer = Optimizer::LimitedMemoryBFGS;
  options.allowInversion = false;
  TAUTLINE_CHECK_THROWS(
    run(perturbedBlock(CellType::Triangle, 5, 0.1), options), wording("need-a-local-optimizer"));
}

/// Other metrics and templates, in patches and globally: each reduces its own objective and inverts
/// nothing.
TAUTLINE_PART(testMetrics)
{
  for (CellType type : { CellType::Triangle, CellType::Tetrahedron })
  {
    const MeshData data = perturbedBlock(type, 4, 0.1);
    for (const MetricInfo& info : elementMetrics())
    {
      const bool defined =
        info.definedOn(type) && (type == CellType::Triangle ? info.in2D : info.in3D);
      if (!defined || !info.differentiable || info.metric == Metric::UntangleBeta ||
        info.metric == Metric::SizeUntangle)
      {
        continue;
      }
      const Context context(std::string(info.name) + " " + topology(type).name);
      for (Optimizer optimizer : { Optimizer::LocalNewton, Optimizer::LimitedMemoryBFGS })
      {
        TAUTLINE_LET(OptimizeOptions, options, optimizer = optimizer,
          objectives[0].metric = info.metric, stopping.maximumIterations = 5);
        const OptimizeResult result = run(data, options);
        TAUTLINE_CHECK(result.history.back().objective < result.history.front().objective);
        TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
      }
    }
    for (ObjectiveTemplate objectiveTemplate :
      { ObjectiveTemplate::Sum, ObjectiveTemplate::PowerMean, ObjectiveTemplate::Maximum })
    {
      const Context context("template " + std::to_string(static_cast<int>(objectiveTemplate)));
      TAUTLINE_LET(OptimizeOptions, options, objectives[0].objectiveTemplate = objectiveTemplate);
      const OptimizeResult result = run(data, options);
      TAUTLINE_CHECK(result.history.back().objective < result.history.front().objective);
      if (objectiveTemplate == ObjectiveTemplate::Maximum)
      {
        TAUTLINE_CHECK(result.history.back().worst[0] < result.history.front().worst[0]);
      }
    }
  }
}

/// A reference mesh is found again from its perturbed copy; weights of 0 free an element.
TAUTLINE_PART(testTargetsAndWeights)
{
  for (CellType type : { CellType::Tetrahedron, CellType::Hexahedron, CellType::Triangle })
  {
    const Context context(topology(type).name);
    const MeshData reference = perturbedBlock(type, 4, 0.08, 3);
    MeshData moved = perturbedBlock(type, 4, 0.08, 9);
    const Mesh mesh(moved.view()), wanted(reference.view());
    const Targets targets = referenceTargets(mesh, wanted);
    OptimizeOptions options;
    applyPreset(Preset::PreserveShape, options);
    TAUTLINE_SET(options, objectives[0].evaluation.targets = &targets,
      stopping.maximumIterations = 200, stopping.relativeChange = 1e-14);
    const OptimizeResult result = optimize(mesh, options);
    double most = largestOf<double>(0, moved.points.size(),
      [&](std::size_t i) { return std::abs(result.points[i] - reference.points[i]); });
    TAUTLINE_CHECK_NEAR(most, 0.0, 1e-4);
    TAUTLINE_CHECK_NEAR(result.history.back().worst[0], 1.0, 1e-6);
  }
  const MeshData data = perturbedBlock(CellType::Triangle, 5, 0.2);
  std::vector<double> weights(data.numberOfCells(), 1.0);
  weights[24] = 100;
  OptimizeOptions options;
  const OptimizeResult plain = run(data, options);
  options.objectives[0].elementWeights = weights.data();
  const OptimizeResult weighted = run(data, options);
  MeshData a = data, b = data;
  a.points = plain.points;
  b.points = weighted.points;
  TAUTLINE_CHECK(
    valuesOf(b, Metric::InverseMeanRatio)[24] < valuesOf(a, Metric::InverseMeanRatio)[24]);
}

/// Each criterion ends the run, and is the reason given.
TAUTLINE_PART(testStopping)
{
  const MeshData data = perturbedBlock(CellType::Tetrahedron, 8, 0.12);
  TAUTLINE_LET(OptimizeOptions, options, stopping.relativeChange = 0, stopping.gradientNorm = 0,
    stopping.maximumIterations = 7);
  OptimizeResult result = run(data, options);
  TAUTLINE_CHECK(result.reason == StopReason::IterationLimit);
  TAUTLINE_CHECK_EQUAL(result.iterations, 7);
  const double least = [&]()
  {
    TAUTLINE_LET(OptimizeOptions, all, stopping.relativeChange = 1e-12);
    return run(data, all).history.back().objective;
  }();
  for (double known : { least, std::numeric_limits<double>::quiet_NaN() })
  {
    options = OptimizeOptions();
    TAUTLINE_SET(options, stopping.reduction = 0.95, stopping.bestKnown = known);
    result = run(data, options);
    TAUTLINE_CHECK(result.reason == StopReason::Reduction);
    const double first = result.history.front().objective;
    const double part = (first - result.history.back().objective) / (first - least);
    TAUTLINE_CHECK(part >= (std::isnan(known) ? 0.93 : 0.95) && part < 0.999);
  }
  result = run(data, TAUTLINE_CHANGED(OptimizeOptions(), stopping.twoDigits = true));
  TAUTLINE_CHECK(result.reason == StopReason::TwoDigits);
  const std::size_t n = result.history.size();
  TAUTLINE_CHECK_EQUAL(std::round(100 * result.history[n - 1].mean[0]),
    std::round(100 * result.history[n - 2].mean[0]));
  result = run(data, TAUTLINE_CHANGED(OptimizeOptions(), stopping.allValid = true));
  TAUTLINE_CHECK(result.reason == StopReason::AllValid);
  TAUTLINE_CHECK_EQUAL(result.iterations, 0);
  for (Optimizer optimizer : { Optimizer::Automatic, Optimizer::LimitedMemoryBFGS })
  {
    options = OptimizeOptions();
    TAUTLINE_SET(options, optimizer = optimizer, stopping.maximumSeconds = 1e-9);
    result = run(data, options);
    TAUTLINE_CHECK(result.reason == StopReason::TimeLimit);
    TAUTLINE_CHECK(result.iterations <= 2);
    options = TAUTLINE_CHANGED(OptimizeOptions(), optimizer = optimizer);
    int calls = 0;
    std::vector<double> seen(data.points.size());
    options.observer = [&](const IterationState& state)
    {
      state.points(seen.data());
      return ++calls < 3;
    };
    result = run(data, options);
    TAUTLINE_CHECK(result.reason == StopReason::Aborted);
    TAUTLINE_CHECK_EQUAL(calls, 3);
    TAUTLINE_CHECK(seen == result.points);
    TAUTLINE_CHECK(result.history.back().objective < result.history.front().objective);
  }
}

/// One time limit holds for untangling and optimization together: where untangling has used it up,
/// no iteration follows.
TAUTLINE_PART(testTimeLimitOfWholeRun)
{
  MeshData data = perturbedBlock(CellType::Tetrahedron, 6, 0.1);
  const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
  for (Index i = 0; i < data.numberOfPoints(); i += 2)
  {
    if (!boundary[i])
    {
      data.setPoint(i, data.point(i) + Vec3{ 1.5, 0, 0 });
    }
  }
  TAUTLINE_CHECK(invalid(data, data.points) > 0);
  for (Optimizer optimizer : { Optimizer::Automatic, Optimizer::LimitedMemoryBFGS })
  {
    constexpr double limit = 0.1;
    TAUTLINE_LET(OptimizeOptions, options, optimizer = optimizer, stopping.maximumSeconds = limit);
    int calls = 0;
    options.observer = [&](const IterationState&)
    {
      // The first call comes from untangle().
      std::this_thread::sleep_for(std::chrono::duration<double>(calls++ == 0 ? limit : 0.0));
      return true;
    };
    const OptimizeResult result = run(data, options);
    TAUTLINE_CHECK(result.untangled);
    TAUTLINE_CHECK(result.reason == StopReason::TimeLimit);
    TAUTLINE_CHECK_EQUAL(result.iterations, 0);
    TAUTLINE_CHECK_EQUAL(result.history.size(), std::size_t(1));
    TAUTLINE_CHECK(result.history[0].seconds >= limit);
  }
}

/// The classes of the optimizers do not depend on the order of their numbers.
TAUTLINE_PART(testReachOfOptimizers)
{
  for (Optimizer optimizer : optimizers)
  {
    const bool global = optimizer == Optimizer::ConjugateGradientFletcherReeves ||
      optimizer == Optimizer::ConjugateGradientPolakRibiere ||
      optimizer == Optimizer::LimitedMemoryBFGS || optimizer == Optimizer::NewtonConjugateGradient;
    TAUTLINE_CHECK_EQUAL(isGlobal(optimizer), global);
    TAUTLINE_CHECK_EQUAL(isLocal(optimizer), !global && optimizer != Optimizer::Automatic);
  }
  // `optimizers` has all numbers: those beside its own are rejected.
  TAUTLINE_CHECK_THROWS(isGlobal(static_cast<Optimizer>(-1)), wording("no-optimizer-1"));
  TAUTLINE_CHECK_THROWS(
    isLocal(static_cast<Optimizer>(std::size(optimizers))), wording("no-optimizer-7"));
  const MeshData data = perturbedBlock(CellType::Triangle, 4, 0.1);
  TAUTLINE_LET(OptimizeOptions, options, optimizer = static_cast<Optimizer>(std::size(optimizers)));
  TAUTLINE_CHECK_THROWS(run(data, options), wording("no-optimizer-7"));
}

/// 0 is an ordinary best known value, for an untangling objective.
TAUTLINE_PART(testBestKnownOfZero)
{
  const MeshData data = perturbedBlock(CellType::Triangle, 12, 0.8);
  TAUTLINE_CHECK(invalid(data, data.points) > 0);
  constexpr double reduction = 0.5;
  TAUTLINE_LET(OptimizeOptions, options, objectives[0].metric = Metric::UntangleBeta,
    stopping.relativeChange = 0, stopping.reduction = reduction, stopping.bestKnown = 0);
  const OptimizeResult result = run(data, options);
  TAUTLINE_CHECK(result.reason == StopReason::Reduction);
  const std::size_t n = result.history.size();
  TAUTLINE_CHECK(n > 1);
  const double goal = (1 - reduction) * result.history[0].objective;
  TAUTLINE_CHECK(result.history[n - 1].objective <= goal);
  for (std::size_t i = 0; i + 1 < n; ++i)
  {
    TAUTLINE_CHECK(result.history[i].objective > goal);
  }
}

/// The worst element gets better, and the mean hardly worse.
TAUTLINE_PART(testWorst)
{
  for (CellType type : { CellType::Triangle, CellType::Tetrahedron, CellType::Quadrilateral })
  {
    const Context context(topology(type).name);
    MeshData data = perturbedBlock(type, 8, 0.12);
    // A wavy side keeps the elements from being equal.
    data.transform(
      TAUTLINE_PLACE(p[0] * (1 + 0.1 * std::sin(1.3 * p[1])), p[1], p[2] * (1 + p[0] / 8)));
    TAUTLINE_LET(OptimizeOptions, options, worstMetric = Metric::InverseMeanRatio);
    applyPreset(Preset::BestShape, options);
    const OptimizeResult best = run(data, options);
    applyPreset(Preset::WorstElement, options);
    const OptimizeResult result = run(data, options);
    TAUTLINE_CHECK(worstMovable(data, result.points) < 0.99 * worstMovable(data, best.points));
    TAUTLINE_CHECK(result.history.back().mean[0] <= 1.01 * best.history.back().mean[0]);
    TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
  }
}

/// The dissertation's method: an untangling metric beside a signed one repairs inverted elements.
TAUTLINE_PART(testUntanglingObjectives)
{
  MeshData data = blockMesh(CellType::Triangle, 6, 6, 0);
  const Index middle = 3 * 7 + 3;
  data.setPoint(middle, data.point(middle) + Vec3{ 1.6, 0.3, 0 });
  TAUTLINE_CHECK(invalid(data, data.points) > 0);
  TAUTLINE_LET(OptimizeOptions, options, objectives[0].metric = Metric::UntangleBeta,
    objectives[0].evaluation.parameters.beta = 0.1);
  OptimizeResult result = run(data, options);
  TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
  TAUTLINE_CHECK(!result.untangled);

  // Beside it a shape metric: what was inverted ends as well-shaped as the rest.
  options.objectives.resize(2);
  TAUTLINE_SET(options, objectives[1].metric = Metric::ConditioningScaleInvariant,
    objectives[1].objectiveTemplate = ObjectiveTemplate::SumOfSquaredReciprocals,
    scalarization.method = Scalarization::EqualSum, stopping.relativeChange = 1e-10);
  result = run(data, options);
  TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
  TAUTLINE_LET(
    OptimizeOptions, alone, objectives[0] = options.objectives[1], stopping.relativeChange = 1e-10);
  const OptimizeResult shape = run(blockMesh(CellType::Triangle, 6, 6, 0), alone);
  TAUTLINE_CHECK_RELATIVE(result.history.back().worst[1], shape.history.back().worst[0], 1e-2);

  // Without such an objective the mesh is untangled first, or rejected.
  options = OptimizeOptions();
  result = run(data, options);
  TAUTLINE_CHECK(result.untangled);
  TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
  options.untangleFirst = false;
  TAUTLINE_CHECK_THROWS(run(data, options), "inverted");
}

/// Inputs with nothing to do or something wrong.
TAUTLINE_PART(testFaulty)
{
  OptimizeOptions options;
  TAUTLINE_LET(MeshData, empty, offsets = { 0 });
  TAUTLINE_CHECK(run(empty, options).reason == StopReason::NoFreeVertices);
  const MeshData single = singleCell(CellType::Tetrahedron, idealCell(CellType::Tetrahedron));
  TAUTLINE_CHECK(run(single, options).reason == StopReason::NoFreeVertices);

  MeshData nan = perturbedBlock(CellType::Triangle, 6, 0.2);
  nan.points[3 * 24] = std::nan("");
  const OptimizeResult result = run(nan, options);
  TAUTLINE_CHECK(std::isfinite(result.history.back().objective));
  TAUTLINE_CHECK(result.history.back().objective < result.history.front().objective);
  TAUTLINE_CHECK(std::isnan(result.points[3 * 24]));
  TAUTLINE_EACH(std::size_t, i, nan.points.size(),
    TAUTLINE_CHECK(i == 3 * 24 || std::isfinite(result.points[i])));

  // Two parts, one of them far away.
  MeshData parts = perturbedBlock(CellType::Quadrilateral, 4, 0.2);
  const MeshData other = perturbedBlock(CellType::Quadrilateral, 4, 0.2, 19);
  const Index n = parts.numberOfPoints();
  for (Index i = 0; i < n; ++i)
  {
    parts.addPoint(other.point(i) + Vec3{ 1000, 0, 0 });
  }
  for (Index c = 0; c < other.numberOfCells(); ++c)
  {
    const Index* node = other.connectivity.data() + other.offsets[c];
    parts.addCell(CellType::Quadrilateral,
      std::vector<Index>{ node[0] + n, node[1] + n, node[2] + n, node[3] + n });
  }
  TAUTLINE_CHECK_RELATIVE(run(parts, options).history.back().objective, 32.0, 1e-5);

  const MeshData data = perturbedBlock(CellType::Triangle, 4, 0.1);
  options.objectives.clear();
  TAUTLINE_CHECK_THROWS(run(data, options), wording("no-objective"));
  options = TAUTLINE_CHANGED(OptimizeOptions(), relaxation = 2.5);
  TAUTLINE_CHECK_THROWS(run(data, options), "relaxation");
  options = TAUTLINE_CHANGED(OptimizeOptions(), stopping.reduction = 0);
  TAUTLINE_CHECK_THROWS(run(data, options), "reduction");
}
}
