// SPDX-License-Identifier: BSD-3-Clause
// The methods beyond one harmonic solve: the hybrid algorithm, untangling, elasticity, the
// biharmonic equation, steps.

#include "Registry.h"
#include "Warping.h"
#include "tautline/Elliptic/FiniteElements.h"

using namespace tautline;

namespace
{
/// No inverted element, the boundary where it is prescribed, and a history that agrees.
void checkValid(const MeshData& data, const Field& motion, const WarpResult& result)
{
  TAUTLINE_CHECK_EQUAL(result.invertedAfter, 0);
  TAUTLINE_CHECK_EQUAL(invalid(data, result.points), 0);
  TAUTLINE_CHECK_EQUAL(result.impossible, 0);
  TAUTLINE_CHECK_EQUAL(result.amount, 1.0);
  TAUTLINE_CHECK(result.message.empty());
  const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 p = data.point(i), q = p + motion(p);
    TAUTLINE_CHECK(!boundary[i] || std::equal(q.begin(), q.end(), &result.points[3 * i]));
  }
  TAUTLINE_CHECK(!result.history.empty());
  TAUTLINE_CHECK_EQUAL(result.history.back().inverted, 0);
  TAUTLINE_CHECK_EQUAL(result.history.back().amount, 1.0);
  double worst = 0, mean = 0;
  for (double q : shapeSimilarity(Mesh(data.view()), result.points.data()))
  {
    worst = std::max(worst, q);
    mean += q / double(data.numberOfCells());
  }
  TAUTLINE_CHECK_EQUAL(result.history.back().worstShape, worst);
  TAUTLINE_CHECK_RELATIVE(result.history.back().meanShape, mean, 1e-12);
}

//------------------------------------------------------------------------------
/// The inner box turned by up to half a turn, in the plane and in space, for every element type.
TAUTLINE_PART_SLOW(testTurnedBox)
{
  for (const CellType type :
    { CellType::Tetrahedron, CellType::Triangle, CellType::Hexahedron, CellType::Quadrilateral })
  {
    const bool flat = topology(type).dimension == 2, simplex = topology(type).samples == 1;
    const MeshData data = boxInBox(type, flat ? 20 : 11, flat ? 8 : 3, simplex ? 0.2 : 0.1);
    for (const double degrees : { 30.0, 90.0, 120.0, 180.0 })
    {
      // A hexahedron or quadrilateral that winds round a corner of the box is not valid for long.
      if (!simplex && degrees > 30)
      {
        continue;
      }
      const Context context(
        std::string(topology(type).name) + " turned by " + std::to_string(degrees));
      const Field motion = turnedBox(degrees, flat);
      for (const WarpMethod method : { WarpMethod::Hybrid, WarpMethod::FemwarpUntangling })
      {
        const WarpResult result = warped(data, motion, withMethod(method));
        checkValid(data, motion, result);
        if (degrees > 30)
        {
          TAUTLINE_CHECK(result.history[0].inverted > 0);
          TAUTLINE_CHECK_EQUAL(result.history[0].stage, std::string("warp"));
        }
      }
    }
  }
}

//------------------------------------------------------------------------------
/// Shape (4.22) agrees with the metric of the registry, and is 0 for similar elements.
TAUTLINE_PART(testSimilarity)
{
  Random random(2);
  for (const CellType type : allTypes)
  {
    const bool flat = topology(type).dimension == 2;
    const MeshData data = movedBlock(type, 3, 0.1);
    MeshData moved = data;
    moved.transform(
      [&](const Vec3& p)
      {
        const Vec3 d = random.vector(-0.1, 0.1);
        return Vec3{ 1.5 * p[0] + d[0], 0.7 * p[1] + 0.3 * p[0] + d[1], flat ? 0.0 : p[2] + d[2] };
      });
    const Mesh mesh(data.view()), now(moved.view());
    const Targets targets = referenceTargets(now, mesh);
    TAUTLINE_LET(EvaluationOptions, options, targets = &targets);
    const std::vector<double> expected = valuesOf(now, Metric::ShapeSimilarity, options);
    const std::vector<double> values = shapeSimilarity(mesh, moved.points.data());
    const std::vector<signed char> validity = validityOf(now);
    for (Index c = 0; c < data.numberOfCells(); ++c)
    {
      if (validity[c] == Valid)
      {
        TAUTLINE_CHECK_RELATIVE(values[c], expected[c], 1e-10);
      }
      TAUTLINE_CHECK_EQUAL(std::isnan(values[c]), validity[c] != Valid);
    }
    // Similar elements; reflected ones are inverted.
    const Columns turn = flat ? rotation({ 0, 0, 1 }, 0.7) : rotation({ 1, 2, 3 }, 0.7);
    moved.points = data.points;
    moved.transform([&](const Vec3& p) { return turn * (2.5 * p); });
    TAUTLINE_EACH_OF(
      double q, shapeSimilarity(mesh, moved.points.data()), TAUTLINE_CHECK_NEAR(q, 0, 1e-24));
    moved.transform(TAUTLINE_PLACE(-p[0], p[1], p[2]));
    TAUTLINE_EACH_OF(
      double q, shapeSimilarity(mesh, moved.points.data()), TAUTLINE_CHECK(std::isnan(q)));
  }
}

//------------------------------------------------------------------------------
/// (4.24) as it stands, and what replaces it: both end valid, in better shape than untangled only.
TAUTLINE_PART(testSecondStep)
{
  const MeshData data = boxInBox(CellType::Triangle, 20, 8);
  const Field motion = turnedBox(60, true);
  const double untangled =
    warped(data, motion, withMethod(WarpMethod::FemwarpUntangling)).history[1].worstShape;
  std::vector<double> smallest;
  for (const double beta : { -1.0, 0.0, 0.1, 0.6 })
  {
    WarpOptions options = withMethod(WarpMethod::Hybrid);
    TAUTLINE_SET(options, untangleFirst = beta < 0, untanglingBeta = std::max(0.0, beta));
    const WarpResult result = warped(data, motion, options);
    checkValid(data, motion, result);
    TAUTLINE_CHECK(result.history.back().worstShape < untangled);
    TAUTLINE_CHECK_EQUAL(result.history[1].stage, std::string(beta < 0 ? "untangle" : "optimize"));
    MeshData moved = TAUTLINE_CHANGED(data, points = result.points);
    const std::vector<double> sizes = valuesOf(moved, Metric::Size);
    smallest.push_back(*std::min_element(sizes.begin(), sizes.end()));
  }
  // Beta is the area, relative to the mean, that elements are to have.
  std::cout << "smallest areas: " << smallest[1] << ", " << smallest[2] << ", " << smallest[3]
            << "\n";
  TAUTLINE_CHECK(smallest[3] > 1.005 * smallest[1]);
  // The unit of length does not matter.
  const WarpResult unit = warped(data, motion, withMethod(WarpMethod::Hybrid));
  for (const double scale : { 0x1p-27, 0x1p27, 1e-8, 1e8 })
  {
    // Powers of two round alike; others lead the optimizer elsewhere.
    const double close = scale == 0x1p-27 || scale == 0x1p27 ? 1e-12 : 0.02;
    MeshData scaled = data;
    scaled.transform([scale](const Vec3& p) { return scale * p; });
    WarpResult result = warped(
      scaled, [&](const Vec3& p) { return scale * motion((1 / scale) * p); },
      withMethod(WarpMethod::Hybrid));
    TAUTLINE_CHECK_EQUAL(result.invertedAfter, 0);
    for (double& x : result.points)
    {
      x /= scale;
    }
    TAUTLINE_CHECK_NEAR(distance(result.points, unit.points), 0, close);
    TAUTLINE_CHECK_RELATIVE(result.history.back().meanShape, unit.history.back().meanShape, close);
  }

  // Triangles beside quadrilaterals.
  MeshData mixed;
  const MeshData quads = boxInBox(CellType::Quadrilateral, 20, 8);
  mixed.points = quads.points;
  for (Index c = 0; c < quads.numberOfCells(); ++c)
  {
    const Index* q = &quads.connectivity[4 * c];
    if (quads.point(q[0])[0] < 0.5)
    {
      mixed.addCell(CellType::Quadrilateral, std::vector<Index>{ q[0], q[1], q[2], q[3] });
      continue;
    }
    mixed.addCell(CellType::Triangle, std::vector<Index>{ q[0], q[1], q[2] });
    mixed.addCell(CellType::Triangle, std::vector<Index>{ q[0], q[2], q[3] });
  }
  checkValid(
    mixed, turnedBox(40, true), warped(mixed, turnedBox(40, true), withMethod(WarpMethod::Hybrid)));

  // Nothing moves: nothing changes.
  const WarpResult still = warped(
    data,
    [](const Vec3&) {
      return Vec3{ 0, 0, 0 };
    },
    withMethod(WarpMethod::Hybrid));
  TAUTLINE_CHECK(still.points == data.points);
}

//------------------------------------------------------------------------------
/// Objectives without a barrier, one of which is smaller with some elements inverted, do not get
/// that by small steps.
TAUTLINE_PART(testNoBarrier)
{
  const MeshData data = boxInBox(CellType::Tetrahedron, 10, 3);
  MeshData moved = TAUTLINE_CHANGED(data,
    points = warped(data, turnedBox(90, false), withMethod(WarpMethod::FemwarpUntangling)).points);
  const Mesh mesh(data.view()), now(moved.view());
  const Targets targets = referenceTargets(now, mesh);
  TAUTLINE_LET(OptimizeOptions, options, threads = 1);
  options.objectives.resize(2);
  TAUTLINE_SET(options, objectives[0].metric = Metric::ShapeSimilarity,
    objectives[0].evaluation.targets = &targets, objectives[1].metric = Metric::UntangleBeta,
    stopping.maximumIterations = 40, stopping.relativeChange = 0);
  const OptimizeResult result = optimize(now, options);
  TAUTLINE_CHECK_EQUAL(result.invertedBefore, 0);
  TAUTLINE_CHECK_EQUAL(result.invertedAfter, 0);
  TAUTLINE_CHECK(result.history.back().objective < 0.5 * result.history[0].objective);
}

//------------------------------------------------------------------------------
/// K M^-1 K x = 0 inside, with motions whose affine part vanishes by symmetry.
TAUTLINE_PART(testBiharmonic)
{
  MeshData data = blockMesh(CellType::Triangle, 12, 12, 0);
  data.transform([](const Vec3& p) { return (1.0 / 12) * p - Vec3{ 0.5, 0.5, 0 }; });
  const Mesh mesh(data.view());
  const std::vector<char> boundary = mesh.boundary().isBoundaryPoint;
  const auto motion = TAUTLINE_PLACE(0.1 * p[0] * p[1], 0, 0);
  WarpOptions options = withMethod(WarpMethod::Biharmonic);
  const WarpResult result = warped(data, motion, options);
  const SparseMatrix K = stiffnessMatrix(mesh, DiffusionOperator());
  const std::vector<double> one(K.size, 1.0);
  const std::vector<double> mass = loadVector(mesh, one.data(), 1);
  std::vector<double> u(K.size), w(K.size), r(K.size);
  double most = 0;
  for (Index i = 0; i < K.size; ++i)
  {
    u[i] = result.points[3 * i] - data.points[3 * i];
    most = std::max(most, std::abs(u[i]));
  }
  K.multiply(u.data(), w.data());
  for (Index i = 0; i < K.size; ++i)
  {
    w[i] /= mass[i];
  }
  K.multiply(w.data(), r.data());
  TAUTLINE_EACH(Index, i, K.size, TAUTLINE_CHECK(boundary[i] || std::abs(r[i]) < 1e-9));
  // Clamped, it comes into the mesh farther than the harmonic motion does.
  TAUTLINE_CHECK_NEAR(most, 0.025, 1e-12);
  TAUTLINE_CHECK(
    distance(result.points, warped(data, motion, withMethod(WarpMethod::Femwarp)).points) > 1e-4);
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testElasticity)
{
  const MeshData data = boxInBox(CellType::Triangle, 20, 8);
  const Field turn = turnedBox(90, true);
  WarpOptions options = withMethod(WarpMethod::IterativeStiffening);
  options.maximumStiffenings = 0;
  const WarpResult uniform = warped(data, turn, options);
  TAUTLINE_CHECK(uniform.invertedAfter > 0);
  TAUTLINE_CHECK(contains(uniform.message, wording("after-0-rounds")));
  options.maximumStiffenings = 100;
  const WarpResult stiffened = warped(data, turn, options);
  checkValid(data, turn, stiffened);

  // No power: one material. Its rows applied to the displacements vanish inside.
  options = TAUTLINE_CHANGED(withMethod(WarpMethod::JacobianStiffening), stiffeningPower = 0);
  const WarpResult same = warped(data, turn, options);
  TAUTLINE_CHECK_NEAR(distance(same.points, uniform.points), 0, 1e-12);
  for (const double nu : { 0.0, 0.4 })
  {
    options.poissonRatio = nu;
    const WarpResult result = warped(data, turn, options);
    TAUTLINE_LET(ElasticOperator, pde, poissonRatio = nu);
    const Mesh mesh(data.view());
    const std::vector<char> boundary = mesh.boundary().isBoundaryPoint;
    const SparseMatrix K = stiffnessMatrix(mesh, pde);
    std::vector<double> u(K.size), r(K.size);
    for (Index i = 0; i < K.size; ++i)
    {
      u[i] = result.points[3 * (i / 2) + i % 2] - data.points[3 * (i / 2) + i % 2];
    }
    K.multiply(u.data(), r.data());
    TAUTLINE_EACH(Index, i, K.size, TAUTLINE_CHECK(boundary[i / 2] || std::abs(r[i]) < 1e-9));
  }

  // With it, small elements keep their shape better than large ones.
  MeshData graded = boxInBox(CellType::Quadrilateral, 20, 8, 0.0);
  graded.transform(
    [](const Vec3& p)
    {
      // towards the inner box
      const Vec3 q = p - Vec3{ 0.5, 0.5, 0 };
      const double extent = std::max(std::abs(q[0]), std::abs(q[1]));
      const double s = std::max(0.0, (extent - 0.2) / 0.3);
      return Vec3{ 0.5, 0.5, 0 } + ((0.2 + 0.3 * s * (0.6 + 0.4 * s)) / extent) * q;
    });
  const Mesh mesh(graded.view());
  EvaluationOptions evaluation;
  const std::vector<double> size = valuesOf(mesh, Metric::Size, evaluation);
  const double median = [&]
  {
    std::vector<double> sorted = size;
    std::nth_element(sorted.begin(), sorted.begin() + Index(sorted.size() / 2), sorted.end());
    return sorted[sorted.size() / 2];
  }();
  const auto distortion = [&](double power)
  {
    options.stiffeningPower = power;
    const std::vector<double> q = shapeSimilarity(mesh,
      warped(
        graded,
        [](const Vec3& p) {
          return onInnerBox(p, true) ? Vec3{ 0, 0.04, 0 } : Vec3{ 0, 0, 0 };
        },
        options)
        .points.data());
    return sumOf<double>(
      0, q.size(), [&](std::size_t i) { return size[i] < 0.8 * median ? q[i] : 0.0; });
  };
  const double without = distortion(0), with = distortion(1), more = distortion(2);
  TAUTLINE_CHECK(with < 0.8 * without);
  TAUTLINE_CHECK(more < with);
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testSteps)
{
  // Small steps follow farther than one; steps of automatic length stop in time.
  const MeshData data = boxInBox(CellType::Triangle, 20, 8);
  const Field motion = turnedBox(70, true);
  TAUTLINE_CHECK(warped(data, motion, withMethod(WarpMethod::Femwarp)).invertedAfter > 0);
  const WarpResult small = warped(data, motion, withMethod(WarpMethod::SmallStepFemwarp));
  TAUTLINE_CHECK_EQUAL(small.invertedAfter, 0);
  TAUTLINE_CHECK_EQUAL(invalid(data, small.points), 0);
  TAUTLINE_CHECK(small.amount > 0.4 && small.amount <= 1);
  TAUTLINE_CHECK_EQUAL(
    small.amount < 1, contains(small.message, wording("could-follow-only-a-part-of-the")));
  WarpOptions few = TAUTLINE_CHANGED(withMethod(WarpMethod::SmallStepFemwarp), maximumSteps = 2);
  const WarpResult stopped = warped(data, motion, few);
  TAUTLINE_CHECK(stopped.amount <= small.amount);
  TAUTLINE_CHECK_EQUAL(stopped.invertedAfter, 0);

  // The path follows the rotation, not the chord: the box keeps its size on it.
  TAUTLINE_SET(few, steps = 0, method = WarpMethod::Femwarp, maximumSteps = 100);
  const WarpResult part = warped(data, turnedBox(150, true), few);
  TAUTLINE_CHECK(part.amount > 0.1 && part.amount < 1);
  const Mesh mesh(data.view());
  const std::vector<char> boundary = mesh.boundary().isBoundaryPoint;
  const Field expected = turnedBox(150 * part.amount, true);
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 p = data.point(i), q = p + expected(p);
    TAUTLINE_CHECK(!boundary[i] ||
      std::abs(part.points[3 * i] - q[0]) + std::abs(part.points[3 * i + 1] - q[1]) < 1e-12);
  }
  // A motion that is given as a function of the amount is taken as it is, be it the turn or its
  // chord. (A turn that is followed to its end: where steps fail, rounding decides about the last.)
  constexpr double followed = 35;
  const WarpResult turn = warped(data, turnedBox(followed, true), few);
  const WarpResult given = Warper(mesh, few).warp(
    [&](double amount, double* to)
    {
      const std::vector<double> d = displacements(data, turnedBox(followed * amount, true));
      std::copy(d.begin(), d.end(), to);
    });
  TAUTLINE_CHECK(turn.amount == 1 && given.amount == 1);
  TAUTLINE_CHECK_NEAR(distance(given.points, turn.points), 0, 1e-9);
  few.steps = 3;
  const WarpResult inSteps = warped(data, turnedBox(followed, true), few);
  const std::vector<double> end = displacements(data, turnedBox(followed, true));
  const WarpResult chord = Warper(mesh, few).warp([&](double amount, double* to)
    { std::transform(end.begin(), end.end(), to, [=](double d) { return amount * d; }); });
  TAUTLINE_CHECK(chord.amount == 1 && distance(chord.points, inSteps.points) > 1e-3);
  few.steps = 0;

  // Affine motions are also exact in steps, and so is the end of the path.
  for (const int steps : { 0, 3 })
  {
    few.steps = steps;
    const auto affine = TAUTLINE_PLACE(0.3 * p[0] + 0.2 * p[1] + 1, -0.4 * p[0] + 0.1 * p[1], 0);
    const WarpResult result = warped(data, affine, few);
    TAUTLINE_CHECK_EQUAL(result.history.size(), std::size_t(std::max(1, steps)));
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      const Vec3 p = data.point(i), q = p + affine(p);
      TAUTLINE_CHECK_NEAR(
        std::hypot(result.points[3 * i] - q[0], result.points[3 * i + 1] - q[1]), 0, 1e-12);
    }
  }
  // The hybrid algorithm goes all the way.
  TAUTLINE_SET(few, method = WarpMethod::Hybrid, steps = 0);
  checkValid(data, turnedBox(150, true), warped(data, turnedBox(150, true), few));
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testThreads)
{
  const MeshData data = boxInBox(CellType::Tetrahedron, 10, 3);
  for (int method = 0; method <= int(WarpMethod::Automatic); ++method)
  {
    const Context context("method " + std::to_string(method));
    WarpOptions options = withMethod(WarpMethod(method));
    TAUTLINE_SET(options, maximumStiffenings = 3, threads = 1);
    const Field motion = turnedBox(50, false);
    const WarpResult one = warped(data, motion, options);
    options.threads = 3;
    const WarpResult three = warped(data, motion, options);
    TAUTLINE_CHECK(one.points == three.points);
    TAUTLINE_CHECK_EQUAL(one.history.size(), three.history.size());
  }
  WarpOptions options = withMethod(WarpMethod::AnisotropicFemwarp);
  options.automaticSolver = false; // CG with BoomerAMG
  const WarpResult one = warped(data, turnedBox(50, false), options);
  options.threads = 3;
  TAUTLINE_CHECK(one.points == warped(data, turnedBox(50, false), options).points);
}

//------------------------------------------------------------------------------
/// A mesh whose cells are all listed the other way round gives the mirror image.
TAUTLINE_PART(testMirrored)
{
  for (const CellType type : { CellType::Triangle, CellType::Tetrahedron })
  {
    const bool flat = type == CellType::Triangle;
    const MeshData data = boxInBox(type, flat ? 16 : 9, flat ? 6 : 3);
    MeshData image = data;
    image.transform(TAUTLINE_PLACE(-p[0], p[1], p[2]));
    std::vector<double> d = displacements(data, turnedBox(70, flat)), mirrored = d;
    for (std::size_t i = 0; i < d.size(); i += 3)
    {
      mirrored[i] = -d[i];
    }
    const Mesh mesh(data.view());
    Mesh imageMesh(image.view());
    imageMesh.setMirrored(true);
    for (int method = 0; method <= int(WarpMethod::Automatic); ++method)
    {
      const Context context("method " + std::to_string(method));
      const WarpResult straight = Warper(mesh, withMethod(WarpMethod(method))).warp(d.data());
      const WarpResult result =
        Warper(imageMesh, withMethod(WarpMethod(method))).warp(mirrored.data());
      TAUTLINE_CHECK_EQUAL(result.history[0].inverted, straight.history[0].inverted);
      TAUTLINE_CHECK_EQUAL(result.invertedAfter == 0, straight.invertedAfter == 0);
      double worst = largestOf<double>(0, d.size(),
        [&](std::size_t i)
        { return std::abs(result.points[i] - (i % 3 == 0 ? -1.0 : 1.0) * straight.points[i]); });
      // Untangling takes vertices in an order of its own, and mirrored points have other groups.
      const bool groups = method == int(WarpMethod::InverseDistanceRotations);
      TAUTLINE_CHECK(untangles(WarpMethod(method)) || worst < (groups ? 1e-3 : 1e-9));
    }
  }
}
}
