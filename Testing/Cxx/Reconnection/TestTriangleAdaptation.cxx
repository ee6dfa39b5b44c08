// SPDX-License-Identifier: BSD-3-Clause
// Adaptation of triangles to metrics: lengths and qualities, what is kept, limits, and random
// operations with the invariants of the mesh checked after each.

#include "Registry.h"
#include "Triangulating.h"

#include "tautline/Reconnection/TriangleAdaptation.h"

using namespace tautline;

namespace
{
using MetricField = std::function<MetricTensor(const Vec3&)>;

/// A metric of the xy plane with sizes along a direction and across.
MetricTensor planeMetric(double angle, double along, double across)
{
  const double c = std::cos(angle), s = std::sin(angle);
  const double a = 1.0 / (along * along), b = 1.0 / (across * across);
  return { a * c * c + b * s * s, a * s * s + b * c * c, 1.0, (a - b) * c * s, 0.0, 0.0 };
}

/// The unit square of n x n squares of two triangles.
MeshData unitSquare(Index n)
{
  MeshData data = blockMesh(CellType::Triangle, n, n, 0);
  for (double& x : data.points)
  {
    x /= static_cast<double>(n);
  }
  return data;
}

std::vector<double> metricsAt(const MeshData& data, const MetricField& field)
{
  std::vector<double> metrics;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const MetricTensor m = field(data.point(i));
    metrics.insert(metrics.end(), m.begin(), m.end());
  }
  return metrics;
}

TriangleOptions adaptOptions(const std::vector<double>& metrics)
{
  TriangleOptions options;
  TAUTLINE_SET(options, adapt = true, compound = false, threads = 1,
    boundary = BoundaryMotion::FlatParts, size = ReconnectionSize::Metrics, sizes = metrics.data());
  return options;
}

/// Adapts, evaluates the metric again, and adapts once more.
MeshData adaptedTo(MeshData data, const MetricField& field, int rounds)
{
  for (int round = 0; round < rounds; ++round)
  {
    const std::vector<double> metrics = metricsAt(data, field);
    data = trianglesOf(reconnect(data, adaptOptions(metrics)));
  }
  return data;
}

/// Figures in a metric.
struct Fit
{
  double share = 0, shortest = 1e300, longest = 0; ///< of edges; share: about 1 long
  double worst = 1, mean = 0;                      ///< mean ratios
};

Fit fitOf(const MeshData& data, const MetricField& field)
{
  Fit fit;
  const std::map<EdgeKey, std::vector<Index>> edges = edgesOf(data);
  Index unit = 0;
  for (const auto& [edge, cells] : edges)
  {
    const Vec3 a = data.point(edge[0]), b = data.point(edge[1]);
    const double length = edgeLength(b - a, field(a), field(b));
    unit += length >= std::sqrt(0.5) && length <= std::sqrt(2.0);
    fit.shortest = std::min(fit.shortest, length);
    fit.longest = std::max(fit.longest, length);
  }
  fit.share = static_cast<double>(unit) / static_cast<double>(edges.size());
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    const Index* v = &data.connectivity[3 * c];
    MetricTensor m = {};
    for (int k = 0; k < 3; ++k)
    {
      const MetricTensor at = field(data.point(v[k]));
      std::transform(m.begin(), m.end(), at.begin(), m.begin(),
        [](double sum, double entry) { return sum + entry / 3.0; });
    }
    const Vec3 u = data.point(v[1]) - data.point(v[0]), w = data.point(v[2]) - data.point(v[0]);
    const double uu = squaredLength(u, m), ww = squaredLength(w, m), vv = squaredLength(w - u, m);
    const double uw = 0.5 * (uu + ww - vv);
    const double q =
      2.0 * std::sqrt(3.0) * std::sqrt(std::max(uu * ww - uw * uw, 0.0)) / (uu + vv + ww);
    fit.worst = std::min(fit.worst, q);
    fit.mean += q / static_cast<double>(data.numberOfCells());
  }
  return fit;
}

void checkFit(const Fit& fit, double share, double worst, double mean)
{
  TAUTLINE_CHECK(fit.share >= share);
  TAUTLINE_CHECK(fit.worst >= worst);
  TAUTLINE_CHECK(fit.mean >= mean);
}

/// Positive triangles that cover the unit square.
void checkSquare(const MeshData& data)
{
  TAUTLINE_EACH(Index, c, data.numberOfCells(), TAUTLINE_CHECK(areaVector(data, c)[2] > 0.0));
  TAUTLINE_CHECK_NEAR(areaOf(data), 1.0, 1e-12);
}

//------------------------------------------------------------------------------
/// Measured: shares of 0.984 (polar) to 0.999, smallest qualities above 0.7, means above 0.94.
TAUTLINE_PART(testAnalyticMetrics)
{
  const Context context("analytic metrics");
  const auto layer = [](double r) { return 0.002 + 0.2 * std::abs(r - 0.5); };
  const MetricField linear = [=](const Vec3& x) { return planeMetric(0.0, 0.1, layer(x[1])); };
  const MetricField polar = [=](const Vec3& x)
  {
    const Vec3 at = x + Vec3{ 1e-3, 1e-3, 0.0 };
    return planeMetric(std::atan2(at[1], at[0]), layer(norm(at)), 0.1);
  };
  const MetricField isotropic = [](const Vec3& x)
  {
    const double h = 0.01 + 0.2 * std::abs(norm(x) - 0.5);
    return planeMetric(0.0, h, h);
  };
  const MeshData start = unitSquare(10);
  for (const MetricField& field : { linear, polar, isotropic })
  {
    const MeshData data = adaptedTo(start, field, 4);
    checkSquare(data);
    checkFit(fitOf(data, field), 0.98, 0.65, 0.93);
  }
}

/// Sizes 1000 to 1. (Across the sides, corners would be sharp angles in the metric.)
TAUTLINE_PART(testAnisotropy)
{
  const Context context("anisotropy");
  const MetricField field = [](const Vec3&) { return planeMetric(0.0, 0.5, 5e-4); };
  const MeshData data = adaptedTo(unitSquare(6), field, 2);
  checkSquare(data);
  TAUTLINE_CHECK(data.numberOfCells() > 5000);
  checkFit(fitOf(data, field), 0.95, 0.6, 0.92);
}

/// Four times as fine, and back: of the sizes and numbers that are asked for.
TAUTLINE_PART(testRefineAndCoarsen)
{
  const Context context("refine and coarsen");
  MeshData data = unitSquare(10);
  for (double h : { 0.025, 0.1, 0.4 })
  {
    const MetricField field = [=](const Vec3&) { return planeMetric(0.0, h, h); };
    data = adaptedTo(data, field, 1);
    checkSquare(data);
    checkFit(fitOf(data, field), 0.97, 0.5, 0.9);
    const double unit = 4.0 / (std::sqrt(3.0) * h * h);
    TAUTLINE_CHECK(static_cast<double>(data.numberOfCells()) < 1.4 * unit);
    TAUTLINE_CHECK(static_cast<double>(data.numberOfCells()) > 0.6 * unit);
  }
}

//------------------------------------------------------------------------------
/// A square in two regions divided by a slanted line, with marked edges along y = 1/2 of the left
/// one.
struct DividedSquare
{
  MeshData data;
  std::vector<Index> regions;
  std::vector<std::array<Index, 2>> marked;

  explicit DividedSquare(Index n)
    : data(unitSquare(n))
  {
    for (Index i = 0; i < this->data.numberOfPoints(); ++i)
    {
      Vec3 x = this->data.point(i);
      x[0] += 0.4 * x[0] * (1.0 - x[0]) * (x[1] - 0.5);
      this->data.setPoint(i, x);
    }
    for (Index c = 0; c < this->data.numberOfCells(); ++c)
    {
      this->regions.push_back(c / 2 % n < n / 2 ? 3 : 8);
    }
    for (Index i = 0; i < n / 2; ++i)
    {
      this->marked.push_back({ n / 2 * (n + 1) + i, n / 2 * (n + 1) + i + 1 });
    }
  }
};

/// Lines are edges of the output along the marked ones, and cover these.
void checkLines(const DividedSquare& square, const ReconnectionResult& result)
{
  const MeshData output = trianglesOf(result);
  const std::map<EdgeKey, std::vector<Index>> edges = edgesOf(output);
  double length = 0.0;
  TAUTLINE_CHECK_EQUAL(result.lines.size(), 2 * result.originalLines.size());
  for (std::size_t k = 0; k < result.originalLines.size(); ++k)
  {
    const Index a = result.lines[2 * k], b = result.lines[2 * k + 1];
    TAUTLINE_CHECK_EQUAL(edges.count({ std::min(a, b), std::max(a, b) }), std::size_t(1));
    length += norm(output.point(b) - output.point(a));
    const Index line = result.originalLines[k];
    TAUTLINE_CHECK(line >= 0 && line < static_cast<Index>(square.marked.size()));
    for (Index p : { a, b })
    {
      TAUTLINE_CHECK_NEAR(output.point(p)[1], 0.5, 1e-15);
    }
  }
  TAUTLINE_CHECK_NEAR(length, 0.5, 1e-12);
}

void checkRegions(const DividedSquare& square, const ReconnectionResult& result)
{
  const MeshData output = trianglesOf(result);
  std::vector<Index> regions;
  for (Index original : result.originalCells)
  {
    regions.push_back(square.regions[original]);
  }
  for (Index region : { 3, 8 })
  {
    TAUTLINE_CHECK_NEAR(
      areaOf(output, regions, region), areaOf(square.data, square.regions, region), 1e-12);
  }
}

TAUTLINE_PART(testRegionsAndLines)
{
  const Context context("regions and lines");
  const DividedSquare square(12);
  for (double h : { 0.02, 0.3 })
  {
    const std::vector<double> lengths(square.data.numberOfPoints(), h);
    TriangleOptions options = adaptOptions(lengths);
    TAUTLINE_SET(options, size = ReconnectionSize::Lengths, regions = square.regions.data(),
      markedEdges = square.marked);
    const ReconnectionResult result = reconnect(square.data, options);
    checkArrays(trianglesOf(result), result);
    checkRegions(square, result);
    checkLines(square, result);
    // The sides are straight: only corners and ends of lines remain where sizes are large.
    TAUTLINE_CHECK((result.lines.size() > 2 * square.marked.size()) == (h < 0.1));
    const MeshData output = trianglesOf(result);
    Index corners = 0;
    for (Index i = 0; i < output.numberOfPoints(); ++i)
    {
      const Vec3 x = output.point(i);
      corners += (x[0] == 0.0 || x[0] == 1.0) && (x[1] == 0.0 || x[1] == 1.0);
    }
    TAUTLINE_CHECK_EQUAL(corners, Index(4));
  }
}

/// With a boundary that stays, walls have the same points, bitwise.
TAUTLINE_PART(testFixedBoundary)
{
  const Context context("fixed boundary");
  const DividedSquare square(8);
  const std::vector<double> metrics =
    metricsAt(square.data, [](const Vec3&) { return planeMetric(0.5, 0.05, 0.02); });
  TriangleOptions options = adaptOptions(metrics);
  TAUTLINE_SET(options, boundary = BoundaryMotion::Fixed, regions = square.regions.data(),
    markedEdges = square.marked);
  const ReconnectionResult result = reconnect(square.data, options);
  TAUTLINE_CHECK(borderOf(trianglesOf(result)) == borderOf(square.data));
  TAUTLINE_CHECK(result.history.back().insertions > 0);
  checkRegions(square, result);
  checkLines(square, result);
  TAUTLINE_CHECK_EQUAL(result.originalLines.size(), square.marked.size());
  // Walls are too long for the metric, and stay: the triangles at them are worse.
  TAUTLINE_EACH_OF(double q, result.qualities, TAUTLINE_CHECK(q > 0.2));
  TAUTLINE_CHECK(result.triangles.size() / 3 < 4000);
}

/// Points that are fixed stay, also where edges should be longer.
TAUTLINE_PART(testFixedPoints)
{
  const Context context("fixed points");
  const MeshData data = unitSquare(12);
  std::vector<unsigned char> fixed(data.numberOfPoints(), 0);
  fixed[5] = fixed[70] = fixed[71] = fixed[90] = 1;
  const std::vector<double> lengths(data.numberOfPoints(), 0.5);
  TriangleOptions options = adaptOptions(lengths);
  TAUTLINE_SET(options, size = ReconnectionSize::Lengths, fixed = fixed.data());
  const ReconnectionResult result = reconnect(data, options);
  checkSquare(trianglesOf(result));
  Index kept = 0;
  for (std::size_t i = 0; i < result.originalPoints.size(); ++i)
  {
    const Index original = result.originalPoints[i];
    if (original >= 0 && fixed[original])
    {
      ++kept;
      const Vec3 x = { result.points[3 * i], result.points[3 * i + 1], result.points[3 * i + 2] };
      TAUTLINE_CHECK(x == data.point(original));
    }
  }
  TAUTLINE_CHECK_EQUAL(kept, Index(4));
  TAUTLINE_CHECK(result.triangles.size() < data.connectivity.size() / 3);
}

//------------------------------------------------------------------------------
/// The upper half of a sphere: points stay on it, and triangles near it.
TAUTLINE_PART(testSphere)
{
  const Context context("sphere");
  constexpr Index n = 16;
  MeshData data = blockMesh(CellType::Triangle, n, n, 0);
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    Vec3 x = (2.0 / n) * data.point(i) - Vec3{ 1.0, 1.0, 0.0 };
    x[2] = 1.5;
    data.setPoint(i, (1.0 / norm(x)) * x);
  }
  for (double h : { 0.04, 0.25 })
  {
    const MetricField field = [=](const Vec3&) { return isotropicMetric(h); };
    const std::vector<double> metrics = metricsAt(data, field);
    const ReconnectionResult result = reconnect(data, adaptOptions(metrics));
    const MeshData output = trianglesOf(result);
    checkArrays(output, result);
    const std::map<EdgeKey, std::vector<Index>> edges = edgesOf(output);
    std::set<Index> border;
    for (const auto& [edge, cells] : edges)
    {
      TAUTLINE_CHECK(cells.size() <= 2);
      if (cells.size() == 1)
      {
        border.insert(edge.begin(), edge.end());
      }
    }
    for (Index i = 0; i < output.numberOfPoints(); ++i)
    {
      // The border is the input's polygon.
      const double tolerance = border.count(i) > 0 ? 5e-3 : 1e-4;
      TAUTLINE_CHECK_NEAR(norm(output.point(i)), 1.0, tolerance);
    }
    TAUTLINE_EACH(Index, c, output.numberOfCells(),
      TAUTLINE_CHECK(dot(areaVector(output, c), output.point(output.connectivity[3 * c])) > 0.0));
    // Edges of the border, about 0.1 long, stay: they are not straight.
    const Fit fit = fitOf(output, field);
    checkFit(fit, h < 0.1 ? 0.97 : 0.4, h < 0.1 ? 0.7 : 0.35, h < 0.1 ? 0.9 : 0.7);
    TAUTLINE_CHECK(fit.longest < 1.5);
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testErrors)
{
  const Context context("errors");
  MeshData data = unitSquare(3);
  TriangleOptions options;
  options.adapt = true;
  TAUTLINE_CHECK_THROWS(reconnect(data, options), wording("adaptation-needs-lengths"));
  const std::vector<double> lengths(data.numberOfPoints(), 0.1);
  options = adaptOptions(lengths);
  options.size = ReconnectionSize::Lengths;
  data.setPoint(5, { 0.0, 0.5, 0.0 }); // flat, and one turned over
  TAUTLINE_CHECK_THROWS(reconnect(data, options), wording("inverted-or-degenerate"));
}

/// A needle of the input, just not flat, does no harm.
TAUTLINE_PART(testNeedle)
{
  const Context context("needle");
  MeshData data = unitSquare(8);
  Vec3 x = data.point(40);
  x[1] = data.point(31)[1] + 1e-9;
  data.setPoint(40, x);
  const MetricField field = [](const Vec3&) { return planeMetric(0.0, 0.05, 0.05); };
  const MeshData output = adaptedTo(data, field, 1);
  checkSquare(output);
  checkFit(fitOf(output, field), 0.97, 0.5, 0.9);
}

TAUTLINE_PART(testDeterminism)
{
  const Context context("determinism");
  const MeshData data = delaunaySquare(200, 3);
  const std::vector<double> metrics =
    metricsAt(data, [](const Vec3& x) { return planeMetric(x[0], 0.02 + 0.1 * x[1], 0.03); });
  TriangleOptions options = adaptOptions(metrics);
  const ReconnectionResult first = reconnect(data, options), second = reconnect(data, options);
  options.threads = 4;
  const ReconnectionResult third = reconnect(data, options);
  for (const ReconnectionResult* other : { &second, &third })
  {
    TAUTLINE_CHECK(other->points == first.points);
    TAUTLINE_CHECK(other->triangles == first.triangles);
    TAUTLINE_CHECK(other->originalCells == first.originalCells);
  }
}

/// A run that is stopped returns a valid mesh.
TAUTLINE_PART(testStops)
{
  const Context context("stops");
  const MeshData data = unitSquare(10);
  const std::vector<double> metrics =
    metricsAt(data, [](const Vec3&) { return planeMetric(0.2, 0.01, 0.004); });
  TriangleOptions options = adaptOptions(metrics);
  int calls = 0;
  options.observer = [&calls](const ReconnectionRecord&, double) { return ++calls < 2; };
  const ReconnectionResult aborted = reconnect(data, options);
  TAUTLINE_CHECK(aborted.reason == StopReason::Aborted);
  checkSquare(trianglesOf(aborted));
  TAUTLINE_SET(options, observer = nullptr, maximumSeconds = 1e-3);
  const ReconnectionResult late = reconnect(data, options);
  TAUTLINE_CHECK(late.reason == StopReason::TimeLimit);
  checkSquare(trianglesOf(late));
  TAUTLINE_CHECK(late.triangles.size() > data.connectivity.size());
}

//------------------------------------------------------------------------------
/// A mesh with metrics, and random operations on it.
class RandomOperations
{
public:
  RandomOperations(const DividedSquare& square, const TriangleOptions& options, unsigned seed)
    : Input(convertTriangles(Mesh(square.data.view()), options))
    , Before(Input.points, Input.cells, Input.regions, Input.walls, true)
    , Changing(Before)
    , Field(Before, Input)
    , Operations(Changing, Input)
    , Adaptation(Changing, Input, Operations)
    , Dice(seed)
  {
    std::vector<PointMetric> metrics;
    for (const MetricTensor& metric : this->Input.metrics)
    {
      metrics.push_back({ metric, this->Before.triangleOf(static_cast<VertexId>(metrics.size())) });
    }
    this->Changing.setMetrics(std::move(metrics), true);
    this->Operations.field = &this->Field;
    this->Operations.freedoms = findFreedoms(this->Changing, this->Input, options);
    this->Operations.dividesWalls = true;
    this->Operations.smallestSize = 0;
    this->Operations.largestSize = 1000000;
  }

  const TriangleMesh& mesh() const { return this->Changing; }

  /// One operation at random, as adaptation makes it, or whether it is good or not.
  void step()
  {
    const TriId t = this->anyTriangle();
    const int i = static_cast<int>(this->Dice.integer(3));
    const VertexId v = this->Changing.triangle(t).vertices[i];
    constexpr Index kinds = 8;
    switch (this->Dice.integer(kinds))
    {
      case 0:
        this->Adaptation.split(t, i);
        break;
      case 1:
      case 2:
        this->Adaptation.contract(t, i);
        break;
      case 3:
        this->Operations.flip(t, i);
        break;
      case 4:
        this->Adaptation.move(v);
        break;
      case 5:
        this->anyFlip(t, i);
        break;
      case 6:
        this->anyContraction(t, i);
        break;
      default:
        this->undone(t, i);
    }
  }

private:
  TriId anyTriangle()
  {
    TriId t = NoNumber;
    do
    {
      t = static_cast<TriId>(this->Dice.integer(this->Changing.slots()));
    } while (!this->Changing.alive(t));
    return t;
  }

  bool allPositive() const
  {
    for (TriId t = 0; t < this->Changing.slots(); ++t)
    {
      if (this->Changing.alive(t) && !(this->Changing.quality(t) > 0.0))
      {
        return false;
      }
    }
    return true;
  }

  /// Keeps a change if all triangles are positive.
  template <class Change>
  void keepIfPositive(const Change& change)
  {
    this->Changing.begin();
    if (change() && this->allPositive())
    {
      this->Changing.commit();
    }
    else
    {
      this->Changing.undo();
    }
  }

  void anyFlip(TriId t, int i)
  {
    this->keepIfPositive([&] { return this->Changing.flip(t, i); });
  }

  void anyContraction(TriId t, int i)
  {
    const PointFreedom& freedom =
      this->Operations.freedoms[this->Changing.triangle(t).vertices[Next[i]]];
    if (freedom.kind == PointFreedom::Free ||
      (freedom.kind == PointFreedom::OnLine && this->Changing.isWall(t, i)))
    {
      this->keepIfPositive([&] { return this->Changing.contract(t, Next[i], Previous[i]); });
    }
  }

  /// A few changes that are undone.
  void undone(TriId t, int i)
  {
    const Triangle before = this->Changing.triangle(t);
    const Index size = this->Changing.size();
    this->Changing.begin();
    const PointMetric metric = this->Changing.metric(before.vertices[i]);
    const Vec3 x = 0.5 *
      (this->Changing.point(before.vertices[Next[i]]) +
        this->Changing.point(before.vertices[Previous[i]]));
    this->Changing.splitEdge(t, i, x, &metric);
    this->Changing.flip(t, Next[i]);
    this->Changing.contract(t, i, Next[i]);
    this->Changing.undo();
    TAUTLINE_CHECK(this->Changing.triangle(t).vertices == before.vertices);
    TAUTLINE_CHECK_EQUAL(this->Changing.size(), size);
  }

  TriangleInput Input;
  TriangleMesh Before, Changing;
  TriangleMetrics Field;
  TriangleOperations Operations;
  TriangleAdaptation Adaptation;
  Random Dice;
};

std::map<std::int32_t, double> areasOf(const TriangleMesh& mesh)
{
  std::map<std::int32_t, double> areas;
  for (TriId t = 0; t < mesh.slots(); ++t)
  {
    if (mesh.alive(t))
    {
      const Corners& v = mesh.triangle(t).vertices;
      areas[mesh.triangle(t).region] +=
        0.5 * cross(mesh.point(v[1]) - mesh.point(v[0]), mesh.point(v[2]) - mesh.point(v[0]))[2];
    }
  }
  return areas;
}

/// The length of the given walls, each counted from one side.
double lengthOfLines(const TriangleMesh& mesh)
{
  double sum = 0.0;
  for (TriId t = 0; t < mesh.slots(); ++t)
  {
    for (int i = 0; mesh.alive(t) && i < 3; ++i)
    {
      const Triangle& triangle = mesh.triangle(t);
      if (triangle.lines[i] != NoNumber && triangle.neighbors[i] >> 2 > t)
      {
        sum +=
          norm(mesh.point(triangle.vertices[Next[i]]) - mesh.point(triangle.vertices[Previous[i]]));
      }
    }
  }
  return sum;
}

/// A random smooth metric, with sizes of about a tenth times the factor.
MetricField randomField(Random& random, double factor)
{
  const Vec3 a = random.vector(-2.0, 2.0), b = random.vector(-2.0, 2.0);
  const Vec3 c = random.vector(-2.0, 2.0), sizes = factor * random.vector(0.05, 0.2);
  return [=](const Vec3& x)
  {
    return planeMetric(dot(a, x), sizes[0] * std::exp(std::sin(dot(b, x))),
      sizes[1] * std::exp(std::sin(dot(c, x))));
  };
}

TAUTLINE_PART(testRandomOperations)
{
  const Context context("random operations");
  const int runs = slowParts() ? 20 : 2, steps = slowParts() ? 5000 : 1000;
  const DividedSquare square(8);
  for (int run = 0; run < runs; ++run)
  {
    Random random(run + 1);
    const std::vector<double> metrics = metricsAt(square.data, randomField(random, run % 2 + 1.0));
    TriangleOptions options = adaptOptions(metrics);
    TAUTLINE_SET(options, regions = square.regions.data(), markedEdges = square.marked);
    RandomOperations operations(square, options, run + 7);
    const std::map<std::int32_t, double> areas = areasOf(operations.mesh());
    const double length = lengthOfLines(operations.mesh());
    TAUTLINE_CHECK(length > 0.0);
    for (int step = 0; step < steps; ++step)
    {
      operations.step();
      TAUTLINE_CHECK_EQUAL(operations.mesh().findViolation(), std::string());
      for (const auto& [region, area] : areasOf(operations.mesh()))
      {
        TAUTLINE_CHECK_NEAR(area, areas.at(region), 1e-12);
      }
      TAUTLINE_CHECK_NEAR(lengthOfLines(operations.mesh()), length, 1e-12);
    }
  }
}
}
