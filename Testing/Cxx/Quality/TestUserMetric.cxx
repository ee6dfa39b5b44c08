// SPDX-License-Identifier: BSD-3-Clause
// Metrics that are registered at run time: copies of built-in ones have their values and, by
// automatic differentiation, their gradients; they take part in every objective and are optimized
// to the same mesh. Errors of registration; numbers, names and lists.
#include "Blocks.h"
#include "Registry.h"
#include "tautline/Objectives/ObjectiveSum.h"
#include "tautline/Optimization/Optimize.h"
#include "tautline/Quality/UserMetric.h"

using namespace tautline;

namespace
{
/// IMR.
struct Ratio
{
  template <class Number, int N>
  Number value(const CornerJacobian<Number, N>& T) const
  {
    const Number det = T.det();
    const Number q = T.norm2() / (N * pow(abs(det), 2.0 / N));
    return select(det > 0.0, q, -q);
  }
};

/// The same with derivatives by hand: dq/dT = q (2 T / |T|^2 - (2/N) T^-t).
struct RatioBySlope : Ratio
{
  double fault = 0;
  template <class Number, int N>
  void slope(const CornerJacobian<Number, N>& T, Number (&d)[N][N]) const
  {
    const Number q = this->value(T), norm2 = T.norm2(), det = T.det();
    for (int r = 0; r < N; ++r)
    {
      for (int c = 0; c < N; ++c)
      {
        Number cofactor;
        if constexpr (N == 2)
        {
          cofactor = (r == c ? 1.0 : -1.0) * T(1 - r, 1 - c);
        }
        else
        {
          const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
          cofactor = T(r1, c1) * T(r2, c2) - T(r1, c2) * T(r2, c1);
        }
        d[r][c] = q * (2.0 * T(r, c) / norm2 - (2.0 / N) * cofactor / det) + this->fault;
      }
    }
  }
};

struct Condition
{
  template <class Number, int N>
  Number value(const CornerJacobian<Number, N>& T) const
  {
    return N == 2 ? T.norm2() / (2.0 * T.det()) : sqrt(T.norm2() * T.adjugate2()) / (3.0 * T.det());
  }
};

/// |T - I|^2: by entries, and by invariants.
struct Distance
{
  template <class Number, int N>
  Number value(const CornerJacobian<Number, N>& T) const
  {
    Number sum = 0.0;
    for (int r = 0; r < N; ++r)
    {
      for (int c = 0; c < N; ++c)
      {
        const Number x = T(r, c) - (r == c ? 1.0 : 0.0);
        sum += x * x;
      }
    }
    return sum;
  }
};
struct DistanceByTrace
{
  template <class Number, int N>
  Number value(const CornerJacobian<Number, N>& T) const
  {
    return T.norm2() - 2 * T.trace() + N;
  }
};

/// |T|^3 - 3 sqrt 3 ln |det T| - 3 sqrt 3.
struct Logarithm
{
  template <class Number, int N>
  Number value(const CornerJacobian<Number, N>& T) const
  {
    const double scale = 3 * std::sqrt(3.0);
    return pow(T.norm2(), 1.5) - scale * log(abs(T.det())) - scale;
  }
};

/// Longest by shortest edge, from the corners.
struct Edges
{
  template <class Number, int Nodes>
  Number value(const ElementCorners<Number, Nodes>& p) const
  {
    const CellTopology& t = topology(p.type());
    Number longest = 0.0, shortest = 1e300;
    for (int e = 0; e < t.edges; ++e)
    {
      const Number length = norm(p.edge(t.edgeNodes[e][0], t.edgeNodes[e][1]));
      longest = max(longest, length);
      shortest = min(shortest, length);
    }
    return longest / shortest;
  }
};

/// Area or volume of simplices.
struct SimplexSize
{
  template <class Number, int Nodes>
  Number value(const ElementCorners<Number, Nodes>& p) const
  {
    const auto a = p.edge(0, 1), b = p.edge(0, 2);
    if constexpr (Nodes == 4)
    {
      return dot(cross(a, b), p.edge(0, 3)) / 6.0;
    }
    return cross(a, b)[2] / 2.0; // of planar meshes
  }
};

struct NotFinite
{
  template <class Number, int N>
  Number value(const CornerJacobian<Number, N>& T) const
  {
    return sqrt(-1.0 - T.norm2());
  }
};

/// Decreases as the inverse mean ratio rises to a limit, above which it has no value.
struct Limited
{
  static constexpr double limit = 4;
  template <class Number, int N>
  Number value(const CornerJacobian<Number, N>& T) const
  {
    return sqrt(limit - Ratio().value(T));
  }
};

/// The facts of a built-in metric, under another name.
MetricDescription copyOf(Metric metric, const std::string& suffix = "")
{
  const MetricInfo& info = metricInfo(metric);
  return TAUTLINE_CHANGED(MetricDescription(), name = std::string("user_") + info.name + suffix,
    label = std::string("User's ") + info.label + suffix, unit = info.unit, in2D = info.in2D,
    in3D = info.in3D, cellTypes = info.cellTypes, full = info.in2D ? info.full2D : info.full3D,
    direction = info.direction, inverted = info.inverted, barrier = info.barrier,
    differentiable = info.differentiable, scaleInvariant = info.scaleInvariant,
    rotationInvariant = info.rotationInvariant);
}

struct Twin
{
  Metric builtIn, user;
};

std::vector<Twin> registerCopies()
{
  MetricDescription size = copyOf(Metric::Size);
  size.cellTypes = 1u | 4u; // triangles, tetrahedra
  return {
    { Metric::InverseMeanRatio, registerJacobianMetric(copyOf(Metric::InverseMeanRatio), Ratio()) },
    { Metric::InverseMeanRatio,
      registerJacobianMetric(copyOf(Metric::InverseMeanRatio, "_slope"), RatioBySlope()) },
    { Metric::ConditionNumber,
      registerJacobianMetric(copyOf(Metric::ConditionNumber), Condition()) },
    { Metric::ShapeSizeOrientation,
      registerJacobianMetric(copyOf(Metric::ShapeSizeOrientation), Distance()) },
    { Metric::ShapeSizeOrientation,
      registerJacobianMetric(copyOf(Metric::ShapeSizeOrientation, "_trace"), DistanceByTrace()) },
    { Metric::ShapeSizeLogarithm,
      registerJacobianMetric(copyOf(Metric::ShapeSizeLogarithm), Logarithm()) },
    { Metric::EdgeRatio, registerCornerMetric(copyOf(Metric::EdgeRatio), Edges()) },
    { Metric::Size, registerCornerMetric(size, SimplexSize()) },
  };
}

double largest(const std::vector<double>& values)
{
  return largestOf<double>(0, values, [&](const double v) { return std::abs(v); });
}

/// Values and gradients of a pair on a mesh; false if neither is defined there.
bool compare(const Twin& pair, const Mesh& mesh, const EvaluationOptions& options)
{
  const MetricInfo& user = metricInfo(pair.user);
  const CellType type = mesh.blocks().front().type;
  if (!user.definedOn(type) ||
    (!user.rotationInvariant && mesh.dimension() == Dimension::Surface) ||
    (pair.builtIn == Metric::Size && mesh.dimension() == Dimension::Surface))
  {
    return false;
  }
  const Gradients expected = gradientsOf(mesh, pair.builtIn, options);
  const Gradients found = gradientsOf(mesh, pair.user, options);
  const std::vector<double> values = valuesOf(mesh, pair.user, options);
  const int nodes = topology(type).nodes;
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    const double q = expected.values[i];
    TAUTLINE_CHECK_NEAR(found.values[i], q, 1e-12 * std::abs(q));
    TAUTLINE_CHECK_NEAR(values[i], q, 1e-12 * std::abs(q));
    const std::vector<double> g(
      expected.gradients.begin() + 3 * nodes * i, expected.gradients.begin() + 3 * nodes * (i + 1));
    const double size = largest(g);
    TAUTLINE_EACH(std::size_t, k, g.size(),
      TAUTLINE_CHECK_NEAR(found.gradients[3 * nodes * i + k], g[k], 1e-9 * size));
  }
  return true;
}

/// Planar, surface and volume; valid and inverted elements; reversed; targets; combinations.
void testValues(const std::vector<Twin>& pairs)
{
  int compared = 0;
  Random random(5);
  for (const Twin& pair : pairs)
  {
    for (const CellType type : allTypes)
    {
      for (const bool surface : { false, true })
      {
        if (surface && topology(type).dimension == 3)
        {
          continue;
        }
        const Context context(metricInfo(pair.user).name + std::string(" ") + topology(type).name);
        std::vector<std::vector<Vec3>> cells;
        MeshData data = scatteredCells(type, surface, 37, random, cells);
        TAUTLINE_LET(EvaluationOptions, options, threads = 2);
        compared += compare(pair, Mesh(data.view()), options);
        options.combination = Combination::Worst;
        compared += compare(pair, Mesh(data.view()), options);
        const MeshData like = movedBlock(type, 2, 0.1);
        const MeshData moved = movedBlock(type, 2, 0.12, 3);
        const Mesh mesh(moved.view());
        const Targets targets = referenceTargets(mesh, Mesh(like.view()));
        TAUTLINE_SET(options, targets = &targets, combination = Combination::PowerMean);
        compared += compare(pair, mesh, options);
      }
    }
  }
  TAUTLINE_CHECK(compared > 150);
}

/// Meshes that are mirrored, extremely small or large.
void testScales(const std::vector<Twin>& pairs)
{
  for (const Twin& pair : pairs)
  {
    for (const double scale : { 1e-70, 1.0, 1e60 })
    {
      for (const CellType type : { CellType::Triangle, CellType::Tetrahedron })
      {
        const Context context(metricInfo(pair.user).name + std::to_string(std::log10(scale)));
        MeshData data = movedBlock(type, 2, 0.1);
        data.transform(TAUTLINE_PLACE(-scale * p[0], scale * p[1], scale * p[2]));
        Mesh mesh(data.view());
        mesh.setMirrored(true);
        TAUTLINE_CHECK_EQUAL(validityOf(mesh)[0], Valid);
        if (metricInfo(pair.user).scaleInvariant || scale == 1)
        {
          compare(pair, mesh, {});
        }
      }
    }
  }
}

void testDegenerate(const std::vector<Twin>& pairs)
{
  for (const Twin& pair : pairs)
  {
    for (const CellType type : allTypes)
    {
      const MetricInfo& info = metricInfo(pair.user);
      if (!info.definedOn(type))
      {
        continue;
      }
      MeshData data = singleCell(type, idealCell(type));
      data.addCell(type, flattenedCell(type, 0));
      data.addCell(type, std::vector<Vec3>(topology(type).nodes, Vec3{ 1, 2, 0 }));
      const Gradients found = gradientsOf(Mesh(data.view()), pair.user);
      TAUTLINE_EACH_OF(const double x, found.values, TAUTLINE_CHECK(std::isfinite(x)));
      TAUTLINE_EACH_OF(const double x, found.gradients, TAUTLINE_CHECK(std::isfinite(x)));
      if (info.barrier && info.family == MetricFamily::Target)
      {
        TAUTLINE_CHECK_EQUAL(found.values[1], 0.0);
      }
    }
  }
}

/// Every template, with weights, on valid and tangled meshes.
void testObjectives(const std::vector<Twin>& pairs)
{
  using T = ObjectiveTemplate;
  int compared = 0, infinite = 0;
  for (const Twin& pair : pairs)
  {
    const bool larger = metricInfo(pair.user).direction == Direction::LargerIsBetter;
    const bool neutral = metricInfo(pair.user).direction == Direction::Neutral;
    for (const CellType type :
      { CellType::Triangle, CellType::Quadrilateral, CellType::Tetrahedron, CellType::Hexahedron })
    {
      if (!metricInfo(pair.user).definedOn(type))
      {
        continue;
      }
      for (const double amplitude : { 0.1, 0.6 })
      {
        const MeshData data = movedBlock(type, 3, amplitude);
        const Mesh mesh(data.view());
        for (const T form : { T::Default, T::SumOfSquares, T::SumOfSquaredReciprocals,
               T::SumOfReciprocals, T::Sum, T::PowerMean, T::Maximum })
        {
          const bool reciprocal = form == T::SumOfReciprocals || form == T::SumOfSquaredReciprocals;
          if ((reciprocal && !larger && !neutral) || (form == T::SumOfSquares && larger))
          {
            continue;
          }
          const Context context(std::string(metricInfo(pair.user).name) + " " +
            topology(type).name + " " + std::to_string(static_cast<int>(form)));
          TAUTLINE_LET(Objective, objective, metric = pair.builtIn, objectiveTemplate = form);
          std::vector<double> expected(data.points.size(), 0.0), found(expected);
          const double F = ObjectiveSum(mesh, objective).addGradient(1, expected.data());
          objective.metric = pair.user;
          const double G = ObjectiveSum(mesh, objective).addGradient(1, found.data());
          if (std::isinf(F))
          {
            ++infinite;
            TAUTLINE_CHECK_EQUAL(G, F);
            continue;
          }
          TAUTLINE_CHECK_RELATIVE(G, F, 1e-11);
          const double size = largest(expected);
          TAUTLINE_EACH(
            std::size_t, i, found.size(), TAUTLINE_CHECK_NEAR(found[i], expected[i], 1e-9 * size));
          ++compared;
        }
      }
    }
  }
  TAUTLINE_CHECK(compared > 100 && infinite > 20);
}

/// Optimizing the copy reaches the optimum of the original, by sweeps and by Newton's method.
void testOptimize(const std::vector<Twin>& pairs)
{
  for (const CellType type : { CellType::Triangle, CellType::Tetrahedron, CellType::Hexahedron })
  {
    MeshData data = blockMesh(type, 4, 4, topology(type).dimension == 2 ? 0 : 4);
    const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
    Random random(7);
    for (Index i = 0; i < data.numberOfPoints(); ++i)
    {
      Vec3 d = random.vector(-0.12, 0.12);
      d[2] *= topology(type).dimension == 2 ? 0 : 1;
      data.setPoint(i, boundary[i] ? data.point(i) : data.point(i) + d);
    }
    for (const Optimizer optimizer : { Optimizer::LocalNewton, Optimizer::NewtonConjugateGradient })
    {
      double optimum[2] = {};
      for (const bool user : { false, true })
      {
        TAUTLINE_LET(OptimizeOptions, options, optimizer = optimizer,
          objectives[0].metric = user ? pairs[0].user : pairs[0].builtIn,
          stopping.maximumIterations = 200, stopping.relativeChange = 1e-12);
        const OptimizeResult result = optimize(Mesh(data.view()), options);
        TAUTLINE_CHECK(result.history.back().objective < result.history.front().objective);
        TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
        optimum[user] = result.history.back().objective;
      }
      const Context context(topology(type).name);
      TAUTLINE_CHECK_RELATIVE(optimum[1], optimum[0], 1e-6);
    }
  }
}

/// Where a formula has no value the objective is infinite, whatever the template and combination;
/// no optimizer goes there, and an input that is there is rejected.
void testWithoutValue()
{
  MetricDescription d = copyOf(Metric::InverseMeanRatio);
  TAUTLINE_SET(d, name = "limited", label = "Limited", barrier = false, full.low = 0);
  const Metric limited = registerJacobianMetric(d, Limited());
  for (const CellType type : { CellType::Triangle, CellType::Tetrahedron, CellType::Hexahedron })
  {
    const Context context(topology(type).name);
    MeshData data = movedBlock(type, 3, 0.1);
    TAUTLINE_LET(OptimizeOptions, options, objectives[0].metric = limited);
    // The objective has its minimum where single elements are at the limit.
    TAUTLINE_SET(options, holdWorst = false, stopping.maximumIterations = 20);
    for (const Optimizer optimizer : { Optimizer::LocalNewton, Optimizer::LocalConjugateGradient,
           Optimizer::NewtonConjugateGradient, Optimizer::LimitedMemoryBFGS })
    {
      options.optimizer = optimizer;
      const OptimizeResult result = optimize(Mesh(data.view()), options);
      const bool stuck = optimizer == Optimizer::LimitedMemoryBFGS; // where its steps end
      TAUTLINE_CHECK(result.history.back().objective < result.history.front().objective || stuck);
      MeshData moved = TAUTLINE_CHANGED(data, points = result.points);
      const std::vector<double> ratios = valuesOf(moved, Metric::InverseMeanRatio);
      TAUTLINE_CHECK(*std::max_element(ratios.begin(), ratios.end()) <= Limited::limit);
    }
    data.transform(TAUTLINE_PLACE(40 * p[0], p[1], p[2]));
    TAUTLINE_CHECK_EQUAL(valuesOf(data, limited)[0], 0.0);
    const Mesh stretched(data.view());
    TAUTLINE_CHECK_THROWS(optimize(stretched, options), wording("limited-has-no-finite-value"));
    using T = ObjectiveTemplate;
    for (const T form : { T::SumOfSquares, T::Sum, T::PowerMean, T::Maximum })
    {
      for (const Combination combination :
        { Combination::Mean, Combination::Worst, Combination::PowerMean })
      {
        TAUTLINE_LET(Objective, objective, metric = limited, objectiveTemplate = form,
          evaluation.combination = combination);
        std::vector<double> gradient(data.points.size(), 0.0);
        const double F = ObjectiveSum(stretched, objective).addGradient(1, gradient.data());
        TAUTLINE_CHECK_EQUAL(F, HUGE_VAL);
        TAUTLINE_CHECK(std::isfinite(largest(gradient)));
      }
    }
  }
  unregisterMetric("limited");
}

/// The names are found, listed and described; the numbers match the names.
void testRegistry(const std::vector<Twin>& pairs)
{
  TAUTLINE_CHECK_EQUAL(
    metricRegistry().size(), std::size_t(numberOfBuiltInMetrics()) + pairs.size());
  const MetricInfo* info = findMetric("USER_imr");
  TAUTLINE_CHECK(info && info->metric == pairs[0].user && info->user);
  TAUTLINE_CHECK(findMetric("user's inverse mean ratio") == info);
  TAUTLINE_CHECK(&metricInfo(pairs[0].user) == info);
  TAUTLINE_CHECK(contains(describeMetric(*info), wording("user-imr-user-s-inverse-mean-ratio")));
  // FNV-1a of the name: state files store it.
  TAUTLINE_CHECK_EQUAL(static_cast<int>(pairs[0].user), 648310309);

  const std::vector<MetricInfo>& before = metricRegistry();
  const std::size_t count = before.size();
  unregisterMetric("user_imr_slope");
  TAUTLINE_CHECK(!findMetric("user_imr_slope"));
  TAUTLINE_CHECK_EQUAL(before.size(), count); // whoever held the list still has it
  TAUTLINE_CHECK_EQUAL(metricRegistry().size(), count - 1);
  TAUTLINE_CHECK_THROWS(unregisterMetric("user_imr_slope"), wording("no-metric-user-imr-slope"));
  TAUTLINE_CHECK_THROWS(unregisterMetric("imr"), wording("no-metric-imr"));
  const Metric again =
    registerJacobianMetric(copyOf(Metric::InverseMeanRatio, "_slope"), RatioBySlope());
  TAUTLINE_CHECK(again == pairs[1].user);
}

void testRejected()
{
  const auto attempt = [](MetricDescription d) { registerJacobianMetric(d, Ratio()); };
  const MetricDescription good = copyOf(Metric::InverseMeanRatio, "_x");
#define REJECTED(change, text) TAUTLINE_CHECK_THROWS(attempt(TAUTLINE_CHANGED(good, change)), text)
  REJECTED(name = "imr", wording("there-is-a-metric-imr"));
  REJECTED(name = "mu_2", wording("there-is-a-metric-mu-2-shape"));
  REJECTED(label = "Inverse mean ratio", wording("there-is-a-metric-inverse-mean-ratio"));
  for (const char* bad : { "", "My", "1x", "a b", "a\tb" })
  {
    REJECTED(name = bad, wording("cannot-be-the-name"));
  }
  REJECTED(formula = "a\tb", wording("control-characters"));
  REJECTED(cellTypes = 0, wording("no-type-of-cell"));
  REJECTED(full = (Range{ 2, 1 }), wording("a-range-ends-before-it-begins"));
  REJECTED(direction = Direction::LargerIsBetter, wording("tends-to-infinity"));
  TAUTLINE_CHECK_THROWS(
    registerJacobianMetric(good, NotFinite()), wording("not-finite-on-a-valid"));
  TAUTLINE_CHECK_THROWS(
    registerJacobianMetric(good, DistanceByTrace()), wording("depends-on-the-scale"));
  TAUTLINE_CHECK_THROWS(
    registerJacobianMetric(TAUTLINE_CHANGED(good, scaleInvariant = false), DistanceByTrace()),
    wording("depends-on-the-rotation"));
  TAUTLINE_LET(RatioBySlope, wrong, fault = 1e-3);
  TAUTLINE_CHECK_THROWS(
    registerJacobianMetric(good, wrong), wording("differ-from-finite-differences"));
  TAUTLINE_CHECK_THROWS(registerMetric(good, nullptr), wording("has-no-function"));
  TAUTLINE_CHECK_THROWS(loadMetrics("/nonexistent/metrics.so"), wording("cannot-be"));
  MetricDescription taken = TAUTLINE_CHANGED(good, name = "imr");
  const MetricRegistration registration([&]() { registerJacobianMetric(taken, Ratio()); });
  TAUTLINE_CHECK(contains(metricLoadErrors(), wording("there-is-a-metric-imr")));
  TAUTLINE_CHECK(!findMetric(good.name));
}

/// A function of many elements at once: sums take its derivatives by differences, and optimizers
/// that move one point after the other reject it.
void testElements()
{
  TAUTLINE_LET(MetricDescription, d, name = "centre_height", rotationInvariant = false);
  Index calls = 0;
  const Metric metric = registerElementsMetric(d,
    [&](CellType type, Index count, const double* points, double* values)
    {
      ++calls;
      const int nodes = topology(type).nodes;
      for (Index i = 0; i < count; ++i)
      {
        values[i] = 0;
        for (int k = 0; k < nodes; ++k)
        {
          values[i] += points[3 * (nodes * i + k) + 1] / nodes;
        }
      }
    });
  TAUTLINE_CHECK_EQUAL(calls, Index(2 * 2 + 4 * 1 - 2)); // tried on each type
  MeshData data = movedBlock(CellType::Hexahedron, 3, 0.1);
  calls = 0;
  const std::vector<double> values = valuesOf(data, metric);
  TAUTLINE_CHECK_EQUAL(calls, Index(1));
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    double expected = 0;
    for (Index n = data.offsets[c]; n < data.offsets[c + 1]; ++n)
    {
      expected += data.point(data.connectivity[n])[1] / 8;
    }
    TAUTLINE_CHECK_RELATIVE(values[c], expected, 1e-14);
  }
  TAUTLINE_LET(Objective, objective, metric = metric);
  const Mesh mesh(data.view());
  // Sum of squares of the heights of the centers: 2 height / 8 for each corner.
  std::vector<double> gradient(3 * data.numberOfPoints()), exact(gradient.size());
  const double sum = ObjectiveSum(mesh, objective).addGradient(1.0, gradient.data());
  double expectedSum = 0;
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    expectedSum += values[c] * values[c];
    for (Index n = data.offsets[c]; n < data.offsets[c + 1]; ++n)
    {
      exact[3 * data.connectivity[n] + 1] += 2 * values[c] / 8;
    }
  }
  TAUTLINE_CHECK_RELATIVE(sum, expectedSum, 1e-12);
  for (std::size_t i = 0; i < gradient.size(); ++i)
  {
    TAUTLINE_CHECK_NEAR(gradient[i], exact[i], 1e-8);
  }
  std::vector<double> q(data.numberOfCells()), g(3 * data.connectivity.size());
  TAUTLINE_CHECK_THROWS(
    evaluateMetricGradient(mesh, metric, {}, q.data(), g.data()), wording("has-no-derivatives"));
  TAUTLINE_LET(
    OptimizeOptions, options, objectives[0].metric = metric, optimizer = Optimizer::LocalNewton);
  TAUTLINE_CHECK_THROWS(optimize(mesh, options), wording("without-derivatives-of-its-own"));
  unregisterMetric("centre_height");
}
}

TAUTLINE_TEST(TestUserMetric)
{
  const std::vector<Twin> pairs = registerCopies();
  TAUTLINE_RUN(testValues(pairs));
  TAUTLINE_RUN(testScales(pairs));
  TAUTLINE_RUN(testDegenerate(pairs));
  TAUTLINE_RUN(testObjectives(pairs));
  TAUTLINE_RUN(testOptimize(pairs));
  TAUTLINE_RUN(testWithoutValue());
  TAUTLINE_RUN(testRegistry(pairs));
  TAUTLINE_RUN(testRejected());
  TAUTLINE_RUN(testElements());
}
