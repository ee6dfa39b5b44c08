// The optimizer: minima, invariances, constraints, every option, faulty input.
#include "Blocks.h"
#include "Check.h"

#include "tautline/Optimize.h"
#include "tautline/SimplexMesh.h"
#include "tautline/SurfaceProjection.h"
#include "tautline/Targets.h"

#include <cstring>

using namespace tautline;

namespace
{
constexpr Optimizer optimizers[] = { Optimizer::Automatic, Optimizer::LocalNewton,
  Optimizer::LocalConjugateGradient, Optimizer::ConjugateGradientFletcherReeves,
  Optimizer::ConjugateGradientPolakRibiere, Optimizer::LimitedMemoryBFGS,
  Optimizer::NewtonConjugateGradient };

/// Inner points moved at random; the boundary is a regular block's. All cells are valid.
MeshData perturbedBlock(CellType type, Index n, double amplitude, unsigned seed = 7)
{
  const bool flat = topology(type).dimension == 2;
  MeshData data = blockMesh(type, n, n, flat ? 0 : n);
  const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
  Random random(seed);
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 d = random.vector(-amplitude, amplitude);
    if (!boundary[i])
    {
      data.setPoint(i, data.point(i) + Vec3{ d[0], d[1], flat ? 0.0 : d[2] });
    }
  }
  return data;
}

Index invalid(const MeshData& like, const std::vector<double>& points)
{
  MeshData moved = like;
  moved.points = points;
  const std::vector<signed char> v = validityOf(moved);
  return std::count_if(v.begin(), v.end(), [](signed char s) { return s != Valid; });
}

double sumOfSquares(const MeshData& like, const std::vector<double>& points, Metric metric)
{
  MeshData moved = like;
  moved.points = points;
  double sum = 0;
  for (double q : valuesOf(moved, metric))
  {
    sum += q * q;
  }
  return sum;
}

/// Of the cells with a vertex that is not on the boundary.
double worstMovable(const MeshData& like, const std::vector<double>& points)
{
  MeshData moved = like;
  moved.points = points;
  const std::vector<char> boundary = Mesh(like.view()).boundary().isBoundaryPoint;
  const std::vector<double> q = valuesOf(moved, Metric::InverseMeanRatio);
  double worst = 0;
  for (Index c = 0; c < moved.numberOfCells(); ++c)
  {
    for (Index n = moved.offsets[c]; n < moved.offsets[c + 1]; ++n)
    {
      worst = boundary[moved.connectivity[n]] ? worst : std::max(worst, q[c]);
    }
  }
  return worst;
}

Optimization run(const MeshData& data, const OptimizeOptions& options)
{
  return optimize(Mesh(data.view()), options);
}

/// A history whose objective never rises and is what the metric says of the points.
void checkHistory(const MeshData& data, const Optimization& result)
{
  for (std::size_t i = 1; i < result.history.size(); ++i)
  {
    TAUTLINE_CHECK(result.history[i].objective <= result.history[i - 1].objective * (1 + 1e-12));
    TAUTLINE_CHECK_EQUAL(result.history[i].iteration, static_cast<int>(i));
  }
  TAUTLINE_CHECK_EQUAL(result.iterations, static_cast<int>(result.history.size()) - 1);
  TAUTLINE_CHECK_RELATIVE(sumOfSquares(data, result.points, Metric::InverseMeanRatio),
    result.history.back().objective, 1e-10);
  TAUTLINE_CHECK_EQUAL(result.invertedAfter, invalid(data, result.points));
}

/// All algorithms find the same minimum, and keep the boundary.
void testMinima()
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
      OptimizeOptions options;
      options.optimizer = optimizer;
      options.stopping.maximumIterations = 400;
      options.stopping.relativeChange = 1e-13;
      options.stopping.gradientNorm = 1e-9;
      const Optimization result = run(data, options);
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

/// One free vertex goes to the centre of a regular hexagon.
void testSingleVertex()
{
  MeshData data;
  data.addPoint({ 0.3, -0.2, 0 });
  for (int k = 0; k < 6; ++k)
  {
    const double angle = k * std::acos(-1.0) / 3;
    data.addPoint({ std::cos(angle), std::sin(angle), 0 });
  }
  for (Index k = 0; k < 6; ++k)
  {
    data.addCell(CellType::Triangle, std::vector<Index>{ 0, 1 + k, 1 + (k + 1) % 6 });
  }
  OptimizeOptions options;
  options.stopping.relativeChange = 0;
  options.stopping.gradientNorm = 1e-12;
  options.relaxation = 1.0;
  const Optimization result = run(data, options);
  TAUTLINE_CHECK_NEAR(result.points[0], 0.0, 1e-9);
  TAUTLINE_CHECK_NEAR(result.points[1], 0.0, 1e-9);
  TAUTLINE_CHECK_NEAR(result.history.back().worst[0], 1.0, 1e-12);
  TAUTLINE_CHECK_EQUAL(result.freeVertices, Index(1));
  TAUTLINE_CHECK(result.reason == StopReason::GradientNorm);
}

/// Rotated, shifted, scaled and relabelled meshes come to the same.
void testInvariance()
{
  for (CellType type : { CellType::Triangle, CellType::Tetrahedron, CellType::Hexahedron })
  {
    const Context context(topology(type).name);
    const MeshData data = perturbedBlock(type, 4, 0.1);
    OptimizeOptions options;
    options.stopping.maximumIterations = 60;
    options.stopping.relativeChange = 1e-12;
    const double F = run(data, options).history.back().objective;
    Random random(11);
    const Columns turn = randomRotation(random);
    for (double scale : { 1e-8, 1.0, 1e8 })
    {
      const Context which("scale " + std::to_string(scale));
      MeshData moved = shuffled(data, 5);
      moved.transform([&](const Vec3& p) { return scale * (turn * p); });
      const Optimization result = run(moved, options);
      TAUTLINE_CHECK_RELATIVE(result.history.back().objective, F, 1e-7);
      TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
    }
    MeshData far = data;
    far.transform([](const Vec3& p) { return p + Vec3{ 1e6, -1e6, 0 }; });
    const Optimization result = run(far, options);
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
      const Optimization mirrored = optimize(mesh, options);
      TAUTLINE_CHECK_RELATIVE(mirrored.history.back().objective, F, 1e-7);
      TAUTLINE_CHECK_EQUAL(mirrored.invertedAfter, Index(0));
    }
  }
}

/// Bitwise the same on 1, 2 and 4 threads, in closed form and through a metric, one or several objectives.
void testThreads()
{
  const MeshData data = perturbedBlock(CellType::Tetrahedron, 14, 0.12);
  for (int which = 0; which < 4; ++which)
  {
    const Context context("case " + std::to_string(which));
    OptimizeOptions options;
    options.stopping.maximumIterations = 3;
    Objective second;
    second.metric = which == 1 ? Metric::Size : Metric::RadiusRatio;
    if (which == 1 || which == 2)
    {
      options.objectives.push_back(second);
    }
    options.optimizer = which == 3 ? Optimizer::LimitedMemoryBFGS : Optimizer::Automatic;
    std::vector<double> first;
    for (int threads : { 1, 2, 4 })
    {
      options.threads = threads;
      const Optimization result = run(data, options);
      first = threads == 1 ? result.points : first;
      TAUTLINE_CHECK_EQUAL(
        std::memcmp(first.data(), result.points.data(), first.size() * sizeof(double)), 0);
    }
  }
}

/// Fixed points, limits, planes and lines.
void testConstraints()
{
  const MeshData data = perturbedBlock(CellType::Tetrahedron, 5, 0.1);
  const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
  const Index n = data.numberOfPoints();
  std::vector<unsigned char> fixed(n, 0);
  for (Index i = 0; i < n; ++i)
  {
    fixed[i] = boundary[i] || i % 3 == 0;
  }
  OptimizeOptions options;
  options.fixed = fixed.data();
  Optimization result = run(data, options);
  for (Index i = 0; i < n; ++i)
  {
    if (fixed[i])
    {
      TAUTLINE_CHECK_EQUAL(std::memcmp(&result.points[3 * i], &data.points[3 * i], 24), 0);
    }
  }
  TAUTLINE_CHECK_EQUAL(result.freeVertices, Index(std::count(fixed.begin(), fixed.end(), 0)));

  constexpr double limit = 0.03;
  const std::vector<double> limits(n, limit);
  options = OptimizeOptions();
  options.limits = limits.data();
  result = run(data, options);
  double most = 0;
  for (Index i = 0; i < n; ++i)
  {
    const Vec3 now = { result.points[3 * i], result.points[3 * i + 1], result.points[3 * i + 2] };
    most = std::max(most, norm(now - data.point(i)));
  }
  TAUTLINE_CHECK(most <= limit * (1 + 1e-12));
  TAUTLINE_CHECK(most > 0.99 * limit); // it was in the way
  checkHistory(data, result);
  options.optimizer = Optimizer::LimitedMemoryBFGS;
  TAUTLINE_CHECK_THROWS(run(data, options), "need a local optimizer");

  // Points of the face z = 0 slide in it, those of its edges along them; the corners stay.
  for (Optimizer optimizer :
    { Optimizer::LocalNewton, Optimizer::LocalConjugateGradient, Optimizer::LimitedMemoryBFGS })
  {
    const Context context("slide " + std::to_string(static_cast<int>(optimizer)));
    MeshData slid = data;
    std::vector<double> planes(3 * n, 0.0), lines(3 * n, 0.0);
    std::fill(fixed.begin(), fixed.end(), 0);
    Random random(3);
    for (Index i = 0; i < n; ++i)
    {
      Vec3 p = data.point(i);
      const auto end = [](double x) { return x == 0 || x == 5; };
      const int ends = end(p[0]) + end(p[1]) + end(p[2]);
      fixed[i] = ends > 0 && (p[2] != 0 || ends == 3);
      if (!fixed[i] && ends == 2)
      {
        lines[3 * i + (end(p[0]) ? 1 : 0)] = 1;
        p[end(p[0]) ? 1 : 0] += random.uniform(-0.2, 0.2);
      }
      else if (!fixed[i] && ends == 1)
      {
        planes[3 * i + 2] = 1;
        p[0] += random.uniform(-0.15, 0.15);
      }
      slid.setPoint(i, p);
    }
    TAUTLINE_CHECK_EQUAL(invalid(slid, slid.points), Index(0));
    options = OptimizeOptions();
    options.optimizer = optimizer;
    options.fixed = fixed.data();
    const double held = [&]()
    {
      std::vector<unsigned char> all = fixed;
      for (Index i = 0; i < n; ++i)
      {
        all[i] = boundary[i];
      }
      OptimizeOptions without = options;
      without.fixed = all.data();
      return run(slid, without).history.back().objective;
    }();
    options.slidePlanes = planes.data();
    options.slideLines = lines.data();
    result = run(slid, options);
    TAUTLINE_CHECK(result.history.back().objective < held);
    for (Index i = 0; i < n; ++i)
    {
      const Vec3 now = { result.points[3 * i], result.points[3 * i + 1], result.points[3 * i + 2] };
      const Vec3 then = slid.point(i);
      if (then[2] == 0)
      {
        TAUTLINE_CHECK_NEAR(now[2], 0.0, 1e-13);
      }
      for (int c = 0; c < 3; ++c)
      {
        const bool line = lines[3 * i] != 0 || lines[3 * i + 1] != 0;
        if (line && lines[3 * i + c] == 0)
        {
          TAUTLINE_CHECK_NEAR(now[c], then[c], 1e-13);
        }
      }
    }
  }
}

/// Points of a curved side slide on the facets (in 2D edges) it has.
void testSlidingSurface()
{
  for (CellType type : { CellType::Tetrahedron, CellType::Hexahedron, CellType::Triangle })
  {
    const Context context(topology(type).name);
    const int up = topology(type).dimension - 1;
    MeshData data = perturbedBlock(type, 5, 0.1);
    const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
    const Index n = data.numberOfPoints();
    std::vector<unsigned char> fixed(n, 0), slides(n, 0);
    Random random(23);
    for (Index i = 0; i < n; ++i)
    {
      Vec3 p = data.point(i);
      bool inner = true;
      for (int c = 0; c < up; ++c)
      {
        inner = inner && p[c] > 0 && p[c] < 5;
      }
      slides[i] = inner && p[up] == 5;
      fixed[i] = boundary[i] && !slides[i];
      for (int c = 0; c < up && slides[i]; ++c)
      {
        p[c] += random.uniform(-0.3, 0.3);
      }
      p[up] *= 1 + 0.05 * std::sin(0.2 * std::acos(-1.0) * p[0]);
      data.setPoint(i, p);
    }
    TAUTLINE_CHECK_EQUAL(invalid(data, data.points), Index(0));
    OptimizeOptions options;
    std::vector<unsigned char> held = fixed;
    for (Index i = 0; i < n; ++i)
    {
      held[i] = boundary[i];
    }
    options.fixed = held.data();
    const double F = run(data, options).history.back().objective;
    options.fixed = fixed.data();
    options.slideSurface = slides.data();
    const Optimization result = run(data, options);
    TAUTLINE_CHECK(result.history.back().objective < 0.99 * F);
    TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
    TAUTLINE_CHECK(result.surfaceError > 0 && result.surfaceError < 0.05);
    const Mesh mesh(data.view());
    const SimplexMesh simplices(mesh, fixed.data(), nullptr, 1);
    const SurfaceProjection surface = SurfaceProjection::ofBoundary(mesh, simplices);
    for (Index i = 0; i < n; ++i)
    {
      const Vec3 x = simplices.transform(
        { result.points[3 * i], result.points[3 * i + 1], result.points[3 * i + 2] });
      if (slides[i])
      {
        TAUTLINE_CHECK_NEAR(norm(surface.closest(x) - x), 0.0, 1e-12);
      }
    }
    options.optimizer = Optimizer::LimitedMemoryBFGS;
    TAUTLINE_CHECK_THROWS(run(data, options), "local optimizer");
  }
}

/// Several objectives under each scalarization: the scalarized value falls, and no objective is forgotten.
void testScalarizations()
{
  const MeshData data = perturbedBlock(CellType::Triangle, 8, 0.25);
  for (int method = 0; method <= 7; ++method)
  {
    for (Optimizer optimizer :
      { Optimizer::LocalNewton, Optimizer::LocalConjugateGradient, Optimizer::LimitedMemoryBFGS })
    {
      const Context context("scalarization " + std::to_string(method) + " optimizer " +
        std::to_string(static_cast<int>(optimizer)));
      OptimizeOptions options;
      options.optimizer = optimizer;
      Objective second;
      second.metric = Metric::Size;
      options.objectives.push_back(second);
      options.scalarization.method = static_cast<Scalarization>(method);
      const Optimization result = run(data, options);
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

/// Other metrics and templates, in patches and globally: each lowers its own objective and inverts nothing.
void testMetrics()
{
  for (CellType type : { CellType::Triangle, CellType::Tetrahedron })
  {
    const MeshData data = perturbedBlock(type, 4, 0.1);
    for (const MetricInfo& info : metricRegistry())
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
        OptimizeOptions options;
        options.optimizer = optimizer;
        options.objectives[0].metric = info.metric;
        options.stopping.maximumIterations = 5;
        const Optimization result = run(data, options);
        TAUTLINE_CHECK(result.history.back().objective < result.history.front().objective);
        TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
      }
    }
    for (ObjectiveTemplate form :
      { ObjectiveTemplate::Sum, ObjectiveTemplate::PowerMean, ObjectiveTemplate::Maximum })
    {
      const Context context("template " + std::to_string(static_cast<int>(form)));
      OptimizeOptions options;
      options.objectives[0].form = form;
      const Optimization result = run(data, options);
      TAUTLINE_CHECK(result.history.back().objective < result.history.front().objective);
      if (form == ObjectiveTemplate::Maximum)
      {
        TAUTLINE_CHECK(result.history.back().worst[0] < result.history.front().worst[0]);
      }
    }
  }
}

/// A reference mesh is found again from its perturbed copy; weights of 0 free an element.
void testTargetsAndWeights()
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
    options.objectives[0].evaluation.targets = &targets;
    options.stopping.maximumIterations = 200;
    options.stopping.relativeChange = 1e-14;
    const Optimization result = optimize(mesh, options);
    double most = 0;
    for (std::size_t i = 0; i < moved.points.size(); ++i)
    {
      most = std::max(most, std::abs(result.points[i] - reference.points[i]));
    }
    TAUTLINE_CHECK_NEAR(most, 0.0, 1e-4);
    TAUTLINE_CHECK_NEAR(result.history.back().worst[0], 1.0, 1e-6);
  }
  const MeshData data = perturbedBlock(CellType::Triangle, 5, 0.2);
  std::vector<double> weights(data.numberOfCells(), 1.0);
  weights[24] = 100;
  OptimizeOptions options;
  const Optimization plain = run(data, options);
  options.objectives[0].elementWeights = weights.data();
  const Optimization weighted = run(data, options);
  MeshData a = data, b = data;
  a.points = plain.points;
  b.points = weighted.points;
  TAUTLINE_CHECK(
    valuesOf(b, Metric::InverseMeanRatio)[24] < valuesOf(a, Metric::InverseMeanRatio)[24]);
}

/// Each criterion ends the run, and says so.
void testStopping()
{
  const MeshData data = perturbedBlock(CellType::Tetrahedron, 8, 0.12);
  OptimizeOptions options;
  options.stopping.relativeChange = 0;
  options.stopping.gradientNorm = 0;
  options.stopping.maximumIterations = 7;
  Optimization result = run(data, options);
  TAUTLINE_CHECK(result.reason == StopReason::IterationLimit);
  TAUTLINE_CHECK_EQUAL(result.iterations, 7);
  const double least = [&]()
  {
    OptimizeOptions all;
    all.stopping.relativeChange = 1e-12;
    return run(data, all).history.back().objective;
  }();
  for (double known : { least, std::numeric_limits<double>::quiet_NaN() })
  {
    options = OptimizeOptions();
    options.stopping.reduction = 0.95;
    options.stopping.bestKnown = known;
    result = run(data, options);
    TAUTLINE_CHECK(result.reason == StopReason::Reduction);
    const double first = result.history.front().objective;
    const double part = (first - result.history.back().objective) / (first - least);
    TAUTLINE_CHECK(part >= (std::isnan(known) ? 0.93 : 0.95) && part < 0.999);
  }
  options = OptimizeOptions();
  options.stopping.twoDigits = true;
  result = run(data, options);
  TAUTLINE_CHECK(result.reason == StopReason::TwoDigits);
  const std::size_t n = result.history.size();
  TAUTLINE_CHECK_EQUAL(std::round(100 * result.history[n - 1].mean[0]),
    std::round(100 * result.history[n - 2].mean[0]));
  options = OptimizeOptions();
  options.stopping.allValid = true;
  result = run(data, options);
  TAUTLINE_CHECK(result.reason == StopReason::AllValid);
  TAUTLINE_CHECK_EQUAL(result.iterations, 0);
  for (Optimizer optimizer : { Optimizer::Automatic, Optimizer::LimitedMemoryBFGS })
  {
    options = OptimizeOptions();
    options.optimizer = optimizer;
    options.stopping.maximumSeconds = 1e-9;
    result = run(data, options);
    TAUTLINE_CHECK(result.reason == StopReason::TimeLimit);
    TAUTLINE_CHECK(result.iterations <= 2);
    options = OptimizeOptions();
    options.optimizer = optimizer;
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

/// Points of a sphere's mesh stay on it.
void testSurface()
{
  MeshData data = blockMesh(CellType::Triangle, 12, 12, 0);
  Random random(2);
  const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    Vec3 p = data.point(i);
    if (!boundary[i])
    {
      p += Vec3{ random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 0 };
    }
    p = Vec3{ p[0] / 6 - 1, p[1] / 6 - 1, 0 };
    data.setPoint(i, { p[0], p[1], std::sqrt(4 - p[0] * p[0] - p[1] * p[1]) });
  }
  OptimizeOptions options;
  const Optimization result = run(data, options);
  TAUTLINE_CHECK(result.history.back().objective < 0.95 * result.history.front().objective);
  TAUTLINE_CHECK_RELATIVE(sumOfSquares(data, result.points, Metric::InverseMeanRatio),
    result.history.back().objective, 1e-10);
  const double edge = 1.0 / 6;
  TAUTLINE_CHECK(result.surfaceError > 0 && result.surfaceError < edge * edge);
  double most = 0;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const double* p = &result.points[3 * i];
    most = std::max(most, std::abs(2 - std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2])));
  }
  TAUTLINE_CHECK(most < edge * edge); // on the facets of the input, which cut the sphere's chords
  options.optimizer = Optimizer::LimitedMemoryBFGS;
  TAUTLINE_CHECK_THROWS(run(data, options), "local optimizer");
}

/// The worst element gets better, and the mean hardly worse.
void testWorst()
{
  for (CellType type : { CellType::Triangle, CellType::Tetrahedron, CellType::Quadrilateral })
  {
    const Context context(topology(type).name);
    MeshData data = perturbedBlock(type, 8, 0.12);
    // A wavy side keeps the elements from being equal.
    data.transform(
      [](const Vec3& p) {
        return Vec3{ p[0] * (1 + 0.1 * std::sin(1.3 * p[1])), p[1], p[2] * (1 + p[0] / 8) };
      });
    OptimizeOptions options;
    applyPreset(Preset::BestShape, options);
    const Optimization best = run(data, options);
    applyPreset(Preset::WorstElement, options);
    const Optimization result = run(data, options);
    TAUTLINE_CHECK(worstMovable(data, result.points) < 0.99 * worstMovable(data, best.points));
    TAUTLINE_CHECK(result.history.back().mean[0] <= 1.01 * best.history.back().mean[0]);
    TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
  }
}

/// The dissertation's method: an untangling metric beside a signed one repairs inverted elements.
void testUntanglingObjectives()
{
  MeshData data = blockMesh(CellType::Triangle, 6, 6, 0);
  const Index middle = 3 * 7 + 3;
  data.setPoint(middle, data.point(middle) + Vec3{ 1.6, 0.3, 0 });
  TAUTLINE_CHECK(invalid(data, data.points) > 0);
  OptimizeOptions options;
  options.objectives[0].metric = Metric::UntangleBeta;
  options.objectives[0].evaluation.parameters.beta = 0.1;
  Optimization result = run(data, options);
  TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
  TAUTLINE_CHECK(!result.untangled);

  // Without such an objective the mesh is untangled first, or refused.
  options = OptimizeOptions();
  result = run(data, options);
  TAUTLINE_CHECK(result.untangled);
  TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
  options.untangleFirst = false;
  TAUTLINE_CHECK_THROWS(run(data, options), "inverted");
}

/// Inputs with nothing to do or something wrong.
void testFaulty()
{
  OptimizeOptions options;
  MeshData empty;
  empty.offsets = { 0 };
  TAUTLINE_CHECK(run(empty, options).reason == StopReason::NoFreeVertices);
  const MeshData single = singleCell(CellType::Tetrahedron, idealCell(CellType::Tetrahedron));
  TAUTLINE_CHECK(run(single, options).reason == StopReason::NoFreeVertices);

  MeshData nan = perturbedBlock(CellType::Triangle, 6, 0.2);
  nan.points[3 * 24] = std::nan("");
  const Optimization result = run(nan, options);
  TAUTLINE_CHECK(std::isfinite(result.history.back().objective));
  TAUTLINE_CHECK(result.history.back().objective < result.history.front().objective);
  TAUTLINE_CHECK(std::isnan(result.points[3 * 24]));
  for (std::size_t i = 0; i < nan.points.size(); ++i)
  {
    TAUTLINE_CHECK(i == 3 * 24 || std::isfinite(result.points[i]));
  }

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
  TAUTLINE_CHECK_THROWS(run(data, options), "no objective");
  options = OptimizeOptions();
  options.relaxation = 2.5;
  TAUTLINE_CHECK_THROWS(run(data, options), "relaxation");
  options = OptimizeOptions();
  options.stopping.reduction = 0;
  TAUTLINE_CHECK_THROWS(run(data, options), "reduction");
}
}

int TestOptimize(int, char*[])
{
  testMinima();
  testSingleVertex();
  testInvariance();
  testThreads();
  testConstraints();
  testSlidingSurface();
  testScalarizations();
  testMetrics();
  testTargetsAndWeights();
  testStopping();
  testSurface();
  testWorst();
  testUntanglingObjectives();
  testFaulty();
  return exitCode();
}
