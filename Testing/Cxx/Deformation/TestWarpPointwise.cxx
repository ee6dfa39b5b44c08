// SPDX-License-Identifier: BSD-3-Clause
// Inverse distances, radial basis functions, weighted Laplacian: exact motions, known values,
// invariances, limits.
#include "Blocks.h"
#include "Registry.h"
#include "tautline/Deformation/WarpPointwise.h"

using namespace tautline;

namespace
{
using Method = std::vector<double> (*)(
  const Mesh&, const std::vector<unsigned char>&, const double*, WarpControl&);

/// A method that takes each point by itself, with the walls of the mesh.
template <std::vector<double> (*Warp)(const PrescribedMotion&, WarpControl&)>
std::vector<double> pointwise(const Mesh& mesh, const std::vector<unsigned char>& prescribed,
  const double* displacement, WarpControl& control)
{
  return Warp(PrescribedMotion(mesh, prescribed, displacement, control.options().threads,
                wallPoints(mesh, prescribed, displacement)),
    control);
}

constexpr Method byInverseDistance = pointwise<warpByInverseDistance>;
constexpr Method byRadialBasis = pointwise<warpByRadialBasis>;

const struct
{
  const char* name;
  Method warp;
} methods[] = { { "inverse distance", byInverseDistance }, { "radial basis", byRadialBasis },
  { "weighted Laplacian", warpByWeightedLaplacian } };

/// A mesh, its prescribed points and what is prescribed; other displacements are NaN.
struct Problem
{
  MeshData data;
  std::vector<unsigned char> prescribed;
  std::vector<double> displacement;

  template <class Motion>
  void prescribe(const Motion& motion)
  {
    this->displacement.assign(this->data.points.size(), std::nan(""));
    for (Index i = 0; i < this->data.numberOfPoints(); ++i)
    {
      if (this->prescribed[i])
      {
        const Vec3 d = motion(this->data.point(i));
        std::copy(d.begin(), d.end(), &this->displacement[3 * i]);
      }
    }
  }
  std::vector<double> run(Method warp, const WarpOptions& options = {}) const
  {
    const Mesh mesh(this->data.view());
    WarpResult result;
    WarpControl control(options, result);
    return warp(mesh, this->prescribed, this->displacement.data(), control);
  }
  Index inverted(const std::vector<double>& moves) const
  {
    MeshData moved = this->data;
    for (std::size_t i = 0; i < moves.size(); ++i)
    {
      moved.points[i] += moves[i];
    }
    const std::vector<signed char> validity = validityOf(moved);
    return std::count_if(
      validity.begin(), validity.end(), [](signed char v) { return v != Valid; });
  }
};

Problem boundaryProblem(const MeshData& data)
{
  TAUTLINE_LET(Problem, problem, data = data);
  const std::vector<char> flags = Mesh(data.view()).boundary().isBoundaryPoint;
  problem.prescribed.assign(flags.begin(), flags.end());
  return problem;
}

Vec3 at(const std::vector<double>& field, Index i)
{
  return { field[3 * i], field[3 * i + 1], field[3 * i + 2] };
}

/// A block of n^d squares or cubes without the m^d in its middle, which turns.
Problem holeProblem(CellType type, Index n, Index m, double angle)
{
  const bool flat = topology(type).dimension == 2;
  const MeshData block = blockMesh(type, n, n, flat ? 0 : n);
  TAUTLINE_LET(MeshData, data, points = block.points);
  const double low = 0.5 * double(n - m), high = 0.5 * double(n + m), middle = 0.5 * double(n);
  for (Index c = 0; c < block.numberOfCells(); ++c)
  {
    const std::vector<Index> nodes = block.nodes(c);
    Vec3 center = sumOf<Vec3>({ 0, 0, 0 }, nodes,
      [&](const Index node) { return (1.0 / double(nodes.size())) * block.point(node); });
    bool inside = true;
    for (std::size_t k = 0; k < (flat ? 2 : 3); ++k)
    {
      inside = inside && center[k] > low && center[k] < high;
    }
    if (!inside)
    {
      data.addCell(static_cast<int>(block.types[c]), nodes);
    }
  }
  Problem problem = boundaryProblem(data);
  const Columns turn = rotation({ 0, 0, 1 }, angle);
  problem.prescribe(
    [&](const Vec3& p)
    {
      const Vec3 r = p - Vec3{ middle, middle, middle };
      const bool outer = std::abs(std::max(std::abs(r[0]), std::abs(r[1])) - middle) < 1e-9 ||
        (!flat && std::abs(std::abs(r[2]) - middle) < 1e-9);
      return outer ? Vec3{ 0, 0, 0 } : turn * r - r;
    });
  return problem;
}

/// A bump on one side and a shear that is not linear.
Vec3 wave(const Vec3& p, double size)
{
  const Vec3 q = (1 / size) * p;
  return size * Vec3{ 0.15 * std::sin(3 * q[1]) * q[0], 0.1 * q[0] * q[0], 0.1 * q[1] * q[2] };
}

/// The moves by the places of the points.
std::map<Vec3, Vec3> byPlace(const MeshData& data, const std::vector<double>& moves)
{
  std::map<Vec3, Vec3> result;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    result[data.point(i)] = at(moves, i);
  }
  return result;
}

/// Affine motions, prescribed points, planes, units, threads, the order of the points.
void testInvariances(CellType type)
{
  const Index n = topology(type).dimension == 2 ? 24 : 8;
  const bool flat = topology(type).dimension == 2;
  Problem problem = boundaryProblem(movedBlock(type, n, 0.12));
  if (flat)
  {
    problem.data.transform(
      [turn = rotation({ 2, 1, 0.5 }, 0.6)](const Vec3& p) { return turn * p; });
  }
  const Vec3 normal = rotation({ 2, 1, 0.5 }, 0.6) * Vec3{ 0, 0, 1 };
  const auto size = double(n);
  const Columns affine = { Vec3{ 0.3, -0.8, 0.2 }, Vec3{ 0.7, 0.1, 0.3 }, Vec3{ -0.2, 0.4, -0.5 } };
  for (const auto& method : methods)
  {
    const Context context(method.name);
    const auto affineMotion = [&](const Vec3& p) { return affine * p + Vec3{ 5, -7, 1 }; };
    problem.prescribe(affineMotion);
    std::vector<double> moves = problem.run(method.warp);
    double worst = largestOf<double>(0, problem.data.numberOfPoints(),
      [&](Index i) { return norm(at(moves, i) - affineMotion(problem.data.point(i))); });
    TAUTLINE_CHECK(worst < 1e-10);

    WarpOptions loose; // no error of a solver leads out of the plane
    loose.tolerance = 1e-3;
    const auto inPlane = [&](const Vec3& p)
    {
      const Vec3 d = wave(p, size);
      return flat ? d - dot(d, normal) * normal : d;
    };
    problem.prescribe(inPlane);
    moves = problem.run(method.warp);
    const std::vector<double> rough = problem.run(method.warp, loose);
    double outside = 0;
    for (Index i = 0; i < problem.data.numberOfPoints(); ++i)
    {
      outside = std::max(outside, std::abs(dot(at(rough, i), normal)));
      TAUTLINE_CHECK(!problem.prescribed[i] || at(moves, i) == at(problem.displacement, i));
      outside = std::max(outside, std::abs(dot(at(moves, i), normal)));
    }
    TAUTLINE_CHECK(!flat || outside < 1e-12 * size);
    TAUTLINE_CHECK_EQUAL(problem.inverted(moves), 0);

    WarpOptions options;
    for (const int threads : { 1, 2, 3 })
    {
      options.threads = threads;
      TAUTLINE_CHECK(problem.run(method.warp, options) == moves);
    }
    Problem relabelled = boundaryProblem(shuffled(problem.data, 12));
    relabelled.prescribe(inPlane);
    const auto here = byPlace(problem.data, moves),
               there = byPlace(relabelled.data, relabelled.run(method.warp));
    double apart = 0;
    for (const auto& [place, move] : here)
    {
      apart = std::max(apart, norm(there.at(place) - move));
    }
    // A system of equations is solved to a tolerance.
    const bool solves = method.warp == static_cast<Method>(warpByWeightedLaplacian);
    TAUTLINE_CHECK(apart <= (solves ? 1e-9 * size : 0.0));
    for (const double unit : { 1e-8, 1e8 })
    {
      Problem other = problem;
      other.data.transform([&](const Vec3& p) { return unit * p; });
      other.prescribe([&](const Vec3& p) { return unit * inPlane((1 / unit) * p); });
      const std::vector<double> scaled = other.run(method.warp);
      double difference = largestOf<double>(
        0, moves.size(), [&](std::size_t i) { return std::abs(scaled[i] / unit - moves[i]); });
      TAUTLINE_CHECK(difference < 1e-8 * size);
    }
  }
}

/// Centers that are equally bad, by a symmetry: rounding does not choose among them.
TAUTLINE_PART(testTies)
{
  constexpr Index n = 16;
  Problem problem = boundaryProblem(blockMesh(CellType::Tetrahedron, n, n, n));
  const auto symmetric = [&](const Vec3& p)
  {
    Vec3 d = { 0, 0, 0 };
    for (std::size_t k = 0; k < 3; ++k)
    {
      d[k] = 0.05 * n * std::sin(2 * M_PI * p[k] / n) * std::cos(M_PI * p[(k + 1) % 3] / n);
    }
    return d;
  };
  problem.prescribe(symmetric);
  const std::vector<double> moves = problem.run(byRadialBasis);
  Random random(21);
  for (double& d : problem.displacement)
  {
    d *= 1 + random.uniform(-1e-15, 1e-15);
  }
  const std::vector<double> rounded = problem.run(byRadialBasis);
  double difference = largestOf<double>(
    0, moves.size(), [&](std::size_t i) { return std::abs(rounded[i] - moves[i]); });
  TAUTLINE_CHECK(difference < 1e-9 * n);
}

/// The groups of the tree against the sum over all points, for all kinds of powers.
TAUTLINE_PART(testInverseDistance)
{
  Problem problem = boundaryProblem(blockMesh(CellType::Tetrahedron, 14, 14, 14));
  problem.prescribe([](const Vec3& p) { return wave(p, 14); });
  const Mesh mesh(problem.data.view());
  const PrescribedMotion motion(mesh, problem.prescribed, problem.displacement.data(), 0);
  for (const double power : { 0.5, 1.0, 2.0, 2.5, 3.0, 4.0, 6.0, 20.0 })
  {
    const Context context("power " + std::to_string(power));
    std::vector<Vec3> rest;
    for (const Index free : motion.free())
    {
      double sum = 0;
      Vec3 mean = { 0, 0, 0 };
      for (std::size_t j = 0; j < motion.prescribed().size(); ++j)
      {
        const double distance = norm(motion.local(free) - motion.local(motion.prescribed()[j]));
        const double weight = std::pow(distance, -power);
        sum += weight;
        mean += weight * motion.rest(j);
      }
      rest.push_back((1 / sum) * mean);
    }
    TAUTLINE_LET(WarpOptions, options, distancePower = power);
    const std::vector<double> exact = motion.displacements(rest),
                              moves = problem.run(byInverseDistance, options);
    double worst = largestOf<double>(
      0, moves.size(), [&](std::size_t i) { return std::abs(moves[i] - exact[i]); });
    TAUTLINE_CHECK(worst < 1e-4 * motion.largest());
  }
}

/// Interpolation of all prescribed points against a dense elimination, and what a tolerance means.
TAUTLINE_PART(testRadialBasis)
{
  Problem problem = boundaryProblem(blockMesh(CellType::Triangle, 20, 20, 0));
  problem.prescribe([](const Vec3& p) { return wave(p, 20); });
  const Mesh mesh(problem.data.view());
  const PrescribedMotion motion(mesh, problem.prescribed, problem.displacement.data(), 0);
  WarpOptions options;
  options.supportRadius = 12; // of a square of side 20
  options.fitTolerance = 0;
  const auto function = [&](const Vec3& a, const Vec3& b)
  {
    const double r = norm(a - b) * motion.scale() / options.supportRadius;
    return r < 1 ? std::pow(1 - r, 4) * (4 * r + 1) : 0.0;
  };
  const std::size_t n = motion.prescribed().size();
  std::vector<std::vector<double>> rows(n);
  for (std::size_t i = 0; i < n; ++i)
  {
    const Vec3 p = motion.local(motion.prescribed()[i]);
    for (std::size_t j = 0; j < n; ++j)
    {
      rows[i].push_back(function(p, motion.local(motion.prescribed()[j])));
    }
    rows[i].insert(rows[i].end(), motion.rest(i).begin(), motion.rest(i).end());
  }
  for (std::size_t k = 0; k < n; ++k)
  {
    for (std::size_t i = 0; i < n; ++i)
    {
      const double factor = i == k ? 0 : rows[i][k] / rows[k][k];
      for (std::size_t j = k; j < n + 3; ++j)
      {
        rows[i][j] -= factor * rows[k][j];
      }
    }
  }
  std::vector<Vec3> rest(motion.free().size(), Vec3{ 0, 0, 0 });
  for (std::size_t i = 0; i < rest.size(); ++i)
  {
    for (std::size_t j = 0; j < n; ++j)
    {
      const double value =
        function(motion.local(motion.free()[i]), motion.local(motion.prescribed()[j]));
      rest[i] += (value / rows[j][j]) * Vec3{ rows[j][n], rows[j][n + 1], rows[j][n + 2] };
    }
  }
  const std::vector<double> exact = motion.displacements(rest);
  const auto difference = [&](double tolerance)
  {
    options.fitTolerance = tolerance;
    const std::vector<double> moves = problem.run(byRadialBasis, options);
    double worst = largestOf<double>(
      0, moves.size(), [&](std::size_t i) { return std::abs(moves[i] - exact[i]); });
    return worst;
  };
  TAUTLINE_CHECK(difference(0) < 1e-11 * motion.largest());
  for (const double tolerance : { 1e-1, 1e-2, 1e-3 })
  {
    std::cout << "tolerance " << tolerance << ": " << difference(tolerance) << " away\n";
  }
  // Relative to the height of right triangles of side 1, above their longest edges in the plane:
  // over their longest side at a corner.
  TAUTLINE_CHECK(difference(1e-2) < 2e-2 && difference(1e-2) > 1e-4);
  TAUTLINE_CHECK(difference(1e-1) < 2e-1 && difference(1e-1) > 1e-2);
}

/// More prescribed points than the first candidates: the others are met as well.
TAUTLINE_PART(testManyCenters)
{
  Problem problem = boundaryProblem(blockMesh(CellType::Hexahedron, 30, 30, 30));
  TAUTLINE_CHECK(std::count(problem.prescribed.begin(), problem.prescribed.end(), 1) > 5000);
  // A bump that few of the first candidates lie on.
  problem.prescribe(
    [](const Vec3& p)
    {
      const Vec3 r = p - Vec3{ 13, 17, 30 };
      return Vec3{ 0, 0, 2 * std::exp(-0.25 * dot(r, r)) };
    });
  // Prescribed points that are left out show how well they are approximated.
  Problem some = problem;
  const Mesh mesh(problem.data.view());
  Index dropped = 0;
  TAUTLINE_LET(WarpOptions, options, fitTolerance = 1e-4);
  for (Index i = 0; i < problem.data.numberOfPoints(); i += 7)
  {
    dropped += some.prescribed[i];
    some.prescribed[i] = 0;
  }
  TAUTLINE_CHECK(dropped > 500);
  const std::vector<double> moves = some.run(byRadialBasis, options);
  double worst = 0;
  for (Index i = 0; i < problem.data.numberOfPoints(); i += 7)
  {
    if (problem.prescribed[i])
    {
      worst = std::max(worst, norm(at(moves, i) - at(problem.displacement, i)));
    }
  }
  std::cout << "points left out are met within " << worst << " of a bump of 2\n";
  TAUTLINE_CHECK(worst < 0.05);
}

/// The weights of a point between four on the axes, a, b, c, d away: b / (2 (a + b)) and so on.
void testFourNeighbors(double a, double b, double c, double d)
{
  MeshData data;
  data.addPoints({ { 0, 0, 0 }, { a, 0, 0 }, { 0, c, 0 }, { -b, 0, 0 }, { 0, -d, 0 } });
  for (Index i = 0; i < 4; ++i)
  {
    data.addCell(CellType::Triangle, { 0, 1 + i, 1 + (i + 1) % 4 });
  }
  const double weights[] = { b / (2 * (a + b)), d / (2 * (c + d)), a / (2 * (a + b)),
    c / (2 * (c + d)) };
  Problem problem = boundaryProblem(data);
  for (Index i = 0; i < 4; ++i)
  {
    problem.prescribe(
      [&](const Vec3& p) {
        return p == data.point(1 + i) ? Vec3{ 1, -2, 0.5 } : Vec3{ 0, 0, 0 };
      });
    const Vec3 move = at(problem.run(warpByWeightedLaplacian), 0);
    TAUTLINE_CHECK(norm(move - weights[i] * Vec3{ 1, -2, 0.5 }) < 1e-11);
  }
}

TAUTLINE_PART(testWeights)
{
  testFourNeighbors(1, 3, 2, 0.5);
  testFourNeighbors(1e-5, 3e-5, 2, 0.5); // the weights do not account for stretching
  testFourNeighbors(1, 1e4, 2, 0.5);
  // On a grid all weights are the same: the mean of the neighbors, by iteration.
  Problem problem = boundaryProblem(blockMesh(CellType::Triangle, 8, 8, 0));
  problem.prescribe([](const Vec3& p) { return wave(p, 8); });
  std::vector<double> u = problem.displacement;
  const Mesh mesh(problem.data.view());
  for (int sweep = 0; sweep < 600; ++sweep)
  {
    for (Index j = 1; j < 8; ++j)
    {
      for (Index i = 1; i < 8; ++i)
      {
        for (Index k = 0; k < 3; ++k)
        {
          const auto value = [&](Index x, Index y)
          {
            const double known = u[3 * (x + 9 * y) + k];
            return std::isnan(known) ? 0.0 : known;
          };
          u[3 * (i + 9 * j) + k] = (value(i - 1, j) + value(i + 1, j) + value(i, j - 1) +
                                     value(i, j + 1) + value(i + 1, j + 1) + value(i - 1, j - 1)) /
            6;
        }
      }
    }
  }
  const std::vector<double> moves = problem.run(warpByWeightedLaplacian);
  TAUTLINE_EACH(std::size_t, i, u.size(), TAUTLINE_CHECK_NEAR(moves[i], u[i], 1e-8));
}

/// Square and cube that turn in a larger one: how many elements each method inverts.
TAUTLINE_PART(testTurning)
{
  // weighted Laplacian and inverse distances fail early, as the dissertation states
  const Problem disk = holeProblem(CellType::Triangle, 24, 8, 0.4);
  const Problem box = holeProblem(CellType::Tetrahedron, 12, 4, 0.25);
  for (const auto& method : methods)
  {
    const Context context(method.name);
    TAUTLINE_CHECK_EQUAL(disk.inverted(disk.run(method.warp)), 0);
    TAUTLINE_CHECK_EQUAL(box.inverted(box.run(method.warp)), 0);
  }
  const Problem far = holeProblem(CellType::Triangle, 24, 8, 1.2);
  TAUTLINE_CHECK(
    far.inverted(far.run(byRadialBasis)) < far.inverted(far.run(warpByWeightedLaplacian)));
}

/// No prescribed points, only such, a part without any, points at one place, a surface in space.
TAUTLINE_PART(testLimits)
{
  Problem problem = boundaryProblem(blockMesh(CellType::Quadrilateral, 4, 4, 0));
  problem.prescribe([](const Vec3& p) { return wave(p, 4); });
  for (const auto& method : methods)
  {
    const Context context(method.name);
    Problem none = problem;
    none.prescribed.assign(none.prescribed.size(), 0);
    const std::vector<double> still = none.run(method.warp);
    TAUTLINE_CHECK(still == std::vector<double>(none.data.points.size(), 0.0));

    Problem all = problem;
    all.prescribed.assign(all.prescribed.size(), 1);
    all.prescribe([](const Vec3& p) { return wave(p, 4); });
    TAUTLINE_CHECK(all.run(method.warp) == all.displacement);

    // one point carries its part along
    Problem one = TAUTLINE_CHANGED(none, prescribed[7] = 1);
    one.prescribe([](const Vec3&) { return Vec3{ 1, 2, 3 }; });
    TAUTLINE_CHECK(norm(at(one.run(method.warp), 12) - Vec3{ 1, 2, 3 }) < 1e-14);

    // two prescribed points at one place that go different ways: no NaN
    Problem twice = problem;
    const Index copy = twice.data.addPoint(twice.data.point(0));
    twice.prescribed.push_back(1);
    twice.prescribe([](const Vec3& p) { return wave(p, 4); });
    twice.displacement[3 * copy] += 1;
    TAUTLINE_EACH_OF(
      const double value, twice.run(method.warp), TAUTLINE_CHECK(std::isfinite(value)));

    // a surface: half a cylinder
    Problem bent = boundaryProblem(blockMesh(CellType::Triangle, 12, 12, 0));
    bent.data.transform(TAUTLINE_PLACE(4 * std::cos(0.25 * p[0]), p[1], 4 * std::sin(0.25 * p[0])));
    bent.prescribe([](const Vec3& p) { return wave(p, 12); });
    double farthest = 0, given = 0;
    const std::vector<double> moves = bent.run(method.warp);
    for (Index i = 0; i < bent.data.numberOfPoints(); ++i)
    {
      (bent.prescribed[i] ? given : farthest) =
        std::max(bent.prescribed[i] ? given : farthest, norm(at(moves, i)));
    }
    TAUTLINE_CHECK(farthest > 0.1 * given && farthest < 1.5 * given);
  }

  // Weighted Laplacian: what no prescribed point is joined to stays.
  Problem parts = problem;
  for (const Vec3& p : { Vec3{ 9, 0, 0 }, Vec3{ 10, 0, 0 }, Vec3{ 9, 1, 0 }, Vec3{ 11, 1, 0 } })
  {
    parts.data.addPoint(p); // the last is of no cell
    parts.prescribed.push_back(0);
  }
  const Index first = problem.data.numberOfPoints();
  parts.data.addCell(CellType::Triangle, { first, first + 1, first + 2 });
  parts.prescribe([](const Vec3& p) { return wave(p, 4) + Vec3{ 3, 0, 0 }; });
  const std::vector<double> moves = parts.run(warpByWeightedLaplacian);
  TAUTLINE_CHECK(
    std::all_of(moves.begin() + 3 * first, moves.end(), [](double d) { return d == 0; }));
}

/// Options out of range; an observer that stops; fractions that grow.
TAUTLINE_PART(testControl)
{
  Problem problem = boundaryProblem(blockMesh(CellType::Tetrahedron, 6, 6, 6));
  problem.prescribe([](const Vec3& p) { return wave(p, 6); });
  WarpOptions wrong;
  for (const double power : { 0.0, -1.0, 20.5, std::nan("") })
  {
    wrong.distancePower = power;
    TAUTLINE_CHECK_THROWS(problem.run(byInverseDistance, wrong), wording("above-0-and-at-most-20"));
  }
  for (const double radius : { -1.0, std::nan(""), HUGE_VAL })
  {
    wrong.supportRadius = radius;
    TAUTLINE_CHECK_THROWS(problem.run(byRadialBasis, wrong), wording("support-radius"));
  }
  TAUTLINE_SET(wrong, supportRadius = 0, fitTolerance = 1);
  TAUTLINE_CHECK_THROWS(problem.run(byRadialBasis, wrong), "below 1");
  for (const auto& method : methods)
  {
    const Context context(method.name);
    WarpOptions options;
    std::vector<double> told;
    options.progress = [&](double fraction)
    {
      told.push_back(fraction);
      return true;
    };
    problem.run(method.warp, options);
    TAUTLINE_CHECK(!told.empty() && std::is_sorted(told.begin(), told.end()) && told[0] >= 0 &&
      told.back() <= 1);
    const std::size_t calls = told.size();
    for (std::size_t last = 0; last < calls; ++last)
    {
      std::size_t count = 0;
      options.progress = [&](double) { return count++ < last; };
      TAUTLINE_CHECK(problem.run(method.warp, options).empty());
    }
    TAUTLINE_SET(options, progress = nullptr, maximumSeconds = 1e-9);
    TAUTLINE_CHECK(problem.run(method.warp, options).empty());
  }
}
}

TAUTLINE_TEST(TestWarpPointwise)
{
  TAUTLINE_RUN(testInvariances(CellType::Triangle));
  TAUTLINE_RUN(testInvariances(CellType::Tetrahedron));
  TAUTLINE_RUN(testInvariances(CellType::Hexahedron));
}
