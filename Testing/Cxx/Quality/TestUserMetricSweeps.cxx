// SPDX-License-Identifier: BSD-3-Clause
// How a user's metric is evaluated where one vertex moves: with derivatives by its displacement
// only, and by |T|^2 and det T where the formula reads no more of T. Both lead sweeps to where the
// built-in metrics lead.
#include "Blocks.h"
#include "Registry.h"
#include "tautline/Optimization/Optimize.h"
#include "tautline/Quality/UserMetric.h"

using namespace tautline;

namespace
{
/// The formulas that were evaluated with derivatives, by the kind of number.
std::atomic<int> byAll{ 0 }, byDisplacement{ 0 }, byInvariants{ 0 };

template <class Number>
void count(int all, int displacement)
{
  byAll += Number::variables == all;
  byDisplacement += Number::variables == displacement;
  byInvariants += Number::variables == ByInvariants;
}

struct Ratio
{
  template <class Number, int N>
  Number value(const CornerJacobian<Number, N>& T) const
  {
    count<Number>(N * N, N);
    return T.norm2() / (N * pow(T.det(), 2.0 / N));
  }
};

struct EntryRatio
{
  template <class Number, int N>
  Number value(const CornerJacobian<Number, N>& T) const
  {
    count<Number>(N * N, N);
    Number norm2 = 0.0;
    for (int r = 0; r < N; ++r)
    {
      for (int c = 0; c < N; ++c)
      {
        norm2 += T(r, c) * T(r, c);
      }
    }
    return norm2 / (N * pow(T.det(), 2.0 / N));
  }
};

/// All invariants.
struct Mixed
{
  template <class Number, int N>
  Number value(const CornerJacobian<Number, N>& T) const
  {
    return T.norm2() * T.adjugate2() / T.det() - sqrt(abs(T.trace())) + T(0, N - 1) * T(1, 0);
  }
};

/// The mean ratio: larger is better.
struct Mean
{
  template <class Number, int N>
  Number value(const CornerJacobian<Number, N>& T) const
  {
    return N * pow(T.det(), 2.0 / N) / T.norm2();
  }
};

/// |T|^n / det T + (det T - 1)^2: depends on the size.
struct Sized
{
  template <class Number, int N>
  Number value(const CornerJacobian<Number, N>& T) const
  {
    const Number excess = T.det() - 1.0;
    return pow(T.norm2(), 0.5 * N) / T.det() + excess * excess;
  }
};

/// The same, but not seen to be a function of |T|^2 and det T.
template <class Formula>
struct ByEntries
{
  template <class Number, int N>
  Number value(const CornerJacobian<Number, N>& T) const
  {
    return Formula().value(T) + 0.0 * T(0, 0);
  }
};

struct Corners
{
  template <class Number, int Nodes>
  Number value(const ElementCorners<Number, Nodes>& p) const
  {
    count<Number>(3 * Nodes, 3);
    const auto a = p.edge(0, 1), b = p.point(2) - p.point(0);
    Number sum = dot(a, b) + norm(a) * norm(b);
    for (int k = 3; k < Nodes; ++k)
    {
      sum += dot(cross(a, b), p.edge(0, k));
    }
    return sum;
  }
};

/// The inverse mean ratio of tetrahedra.
struct CornerRatio
{
  template <class Number, int Nodes>
  Number value(const ElementCorners<Number, Nodes>& p) const
  {
    count<Number>(3 * Nodes, 3);
    constexpr int apex = Nodes - 1;
    const auto a = p.edge(0, 1), b = p.edge(0, 2), c = p.edge(0, apex);
    const auto ab = p.edge(1, 2), bc = p.edge(2, apex), ca = p.edge(apex, 1);
    const Number edges2 =
      dot(a, a) + dot(b, b) + dot(c, c) + dot(ab, ab) + dot(bc, bc) + dot(ca, ca);
    return edges2 / (6.0 * pow(std::sqrt(2.0) * dot(cross(a, b), c), 2.0 / 3.0));
  }
};

MetricDescription describe(const std::string& name, bool barrier, bool scale, bool rotation)
{
  return TAUTLINE_CHANGED(MetricDescription(), name = name, barrier = barrier,
    scaleInvariant = scale, rotationInvariant = rotation);
}

/// Every function of numbers; one after another.
template <class Number>
std::vector<Number> functionsOf(const Number& x, const Number& y)
{
  return { x + y, x - y, x * y, x / y, 2.0 * x, x * 3.0, x / 4.0, 5.0 / x, 1.0 - x, x - 1.0, -x,
    x + 1.0, abs(x), abs(-x), min(x * x, y), max(x * x, y), sqrt(x * y), cbrt(x / y), exp(x - y),
    log(x * x * y), sin(x * y), cos(x - y * y), acos(0.3 * x / y), atan2(x * y, x + y), pow(x, 2.0),
    pow(x * y, 2.0 / 3.0), pow(x / y, -4.0 / 3.0), pow(x * y, 0.3), pow(x, -2.0), pow(y, 1.0),
    select(x < y, x * y, x), select(x > y, x * y, x), select((x <= y) | (x >= y), y, x) };
}

/// First and second derivatives by two numbers, against differences.
TAUTLINE_PART(testNumbers)
{
  using Number = DualNumber<ByInvariants>;
  constexpr double x = 0.7, y = 1.3, step = 1e-5;
  const auto at = [](double dx, double dy)
  {
    return functionsOf(
      Number::variable(broadcast(x + dx), 0), Number::variable(broadcast(y + dy), 1));
  };
  const auto here = at(0, 0), right = at(step, 0), left = at(-step, 0), up = at(0, step),
             down = at(0, -step);
  const auto plain = functionsOf(DualNumber<0>(x), DualNumber<0>(y));
  TAUTLINE_CHECK_EQUAL(here.size(), plain.size());
  for (std::size_t i = 0; i < here.size(); ++i)
  {
    const Context context("function " + std::to_string(i));
    const auto isDerivative = [&](const Packet& slope, const Packet& more, const Packet& less)
    {
      const double expected = (more[0] - less[0]) / (2 * step);
      TAUTLINE_CHECK_NEAR(slope[0], expected, 1e-8 * (1 + std::abs(expected)));
    };
    TAUTLINE_CHECK_NEAR(here[i].value[0], plain[i].value[0], 1e-14);
    isDerivative(here[i].slope[0], right[i].value, left[i].value);
    isDerivative(here[i].slope[1], up[i].value, down[i].value);
    isDerivative(here[i].curvature[0], right[i].slope[0], left[i].slope[0]);
    isDerivative(here[i].curvature[1], up[i].slope[0], down[i].slope[0]);
    isDerivative(here[i].curvature[1], right[i].slope[1], left[i].slope[1]);
    isDerivative(here[i].curvature[2], up[i].slope[1], down[i].slope[1]);
  }
}

/// Derivatives by a displacement are the sums of those by the arguments.
TAUTLINE_PART(testAlong)
{
  const std::vector<Metric> metrics = {
    registerJacobianMetric(describe("s_mixed", false, false, false), Mixed()),
    registerJacobianMetric(describe("s_sized", false, false, true), Sized()),
    registerCornerMetric(describe("s_corners", false, false, false), Corners()),
  };
  Random random(3);
  for (const Metric metric : metrics)
  {
    const UserMetric& user = *metricInfo(metric).user;
    for (const CellType type : allTypes)
    {
      const Context context(std::string(metricInfo(metric).name) + " " + topology(type).name);
      const CellTopology& t = topology(type);
      const bool ofCorners = user.argument() == MetricArgument::Corners;
      const int columns = ofCorners ? t.nodes : t.dimension, rows = ofCorners ? 3 : t.dimension;
      constexpr int elements = 11, stride = 13;
      std::vector<double> arguments(rows * columns * stride), along(columns * stride);
      for (double& a : arguments)
      {
        a = random.uniform(0.2, 1.5);
      }
      for (double& a : along)
      {
        a = random.uniform(-1, 1);
      }
      std::vector<double> q(stride), expected(stride), slopes(rows * stride), sums(rows * stride);
      user.evaluateAlong(
        type, elements, stride, arguments.data(), along.data(), q.data(), slopes.data());
      user.UserMetric::evaluateAlong(
        type, elements, stride, arguments.data(), along.data(), expected.data(), sums.data());
      for (int i = 0; i < elements; ++i)
      {
        TAUTLINE_CHECK_RELATIVE(q[i], expected[i], 1e-12);
        for (int r = 0; r < rows; ++r)
        {
          const double s = sums[r * stride + i];
          TAUTLINE_CHECK_NEAR(slopes[r * stride + i], s, 1e-10 * (1 + std::abs(s)));
        }
      }
      // A function of |T|^2 and det T alone?
      const double invariants[2] = { 3.2, 1.1 };
      double value = 0, derivatives[5];
      TAUTLINE_CHECK_EQUAL(
        user.evaluateInvariants(type, 1, 1, invariants, &value, derivatives), metric == metrics[1]);
    }
  }
}

MeshData start(CellType type, double scale)
{
  MeshData data = movedBlock(type, 4, 0.15);
  data.transform([=](const Vec3& p) { return scale * p; });
  return data;
}

std::vector<double> sweep(
  const MeshData& data, Metric metric, ObjectiveTemplate form = ObjectiveTemplate::SumOfSquares)
{
  TAUTLINE_LET(OptimizeOptions, options, optimizer = Optimizer::LocalNewton,
    stopping.maximumIterations = 6, objectives[0].metric = metric,
    objectives[0].objectiveTemplate = form);
  const OptimizeResult result = optimize(Mesh(data.view()), options);
  TAUTLINE_CHECK(result.history.back().objective < result.history.front().objective);
  return result.points;
}

double distance(const std::vector<double>& a, const std::vector<double>& b)
{
  return largestOf<double>(0, a.size(), [&](std::size_t i) { return std::abs(a[i] - b[i]); });
}

/// Sweeps by a copy go where the original's sweeps go; the cheapest derivatives suffice.
TAUTLINE_PART(testSweeps)
{
  const Metric ratio = registerJacobianMetric(describe("s_ratio", true, true, true), Ratio());
  const Metric entries =
    registerJacobianMetric(describe("s_entries", true, true, true), EntryRatio());
  MetricDescription tetrahedra = describe("s_tetrahedra", true, true, true);
  TAUTLINE_SET(tetrahedra, in2D = false, cellTypes = 1u << topologyIndex(CellType::Tetrahedron));
  const Metric corners = registerCornerMetric(tetrahedra, CornerRatio());
  for (const CellType type :
    { CellType::Triangle, CellType::Quadrilateral, CellType::Tetrahedron, CellType::Hexahedron })
  {
    const Context context(topology(type).name);
    const MeshData data = start(type, 1.0);
    const bool simplex = topology(type).samples == 1;
    const std::vector<double> expected = sweep(data, Metric::InverseMeanRatio);
    byAll = byDisplacement = byInvariants = 0;
    TAUTLINE_CHECK_NEAR(distance(sweep(data, ratio), expected), 0.0, 1e-5);
    TAUTLINE_CHECK_EQUAL(byInvariants > 0, simplex);
    TAUTLINE_CHECK_EQUAL(byDisplacement > 0, !simplex);
    TAUTLINE_CHECK_EQUAL(byAll.load(), 0);
    byAll = byDisplacement = 0;
    TAUTLINE_CHECK_NEAR(distance(sweep(data, entries), expected), 0.0, 1e-5);
    TAUTLINE_CHECK(byDisplacement > 0);
    TAUTLINE_CHECK_EQUAL(byAll.load(), 0);
    if (type == CellType::Tetrahedron)
    {
      byAll = byDisplacement = 0;
      TAUTLINE_CHECK_NEAR(distance(sweep(data, corners), expected), 0.0, 1e-5);
      TAUTLINE_CHECK(byDisplacement > 0);
      TAUTLINE_CHECK_EQUAL(byAll.load(), 0);
    }
  }
}

/// Every template of single elements, and a metric that depends on the size.
TAUTLINE_PART(testTemplates)
{
  MetricDescription d = describe("s_size", true, false, true);
  const Metric size = registerJacobianMetric(d, Sized());
  d.name = "s_size_entries";
  const Metric sizeByEntries = registerJacobianMetric(d, ByEntries<Sized>());
  d = describe("s_mean", false, true, true);
  d.direction = Direction::LargerIsBetter;
  const Metric mean = registerJacobianMetric(d, Mean());
  d.name = "s_mean_entries";
  const Metric meanByEntries = registerJacobianMetric(d, ByEntries<Mean>());
  using T = ObjectiveTemplate;
  for (const CellType type : { CellType::Triangle, CellType::Tetrahedron })
  {
    for (const double scale : { 0.3, 5.0 })
    {
      const MeshData data = start(type, scale);
      const auto compare = [&](Metric fast, Metric slow, T form)
      {
        const Context context(
          topology(type).name + std::string(" ") + std::to_string(static_cast<int>(form)));
        const double apart = distance(sweep(data, fast, form), sweep(data, slow, form));
        TAUTLINE_CHECK_NEAR(apart, 0.0, 1e-5 * scale);
      };
      for (const T form : { T::SumOfSquares, T::Sum })
      {
        compare(size, sizeByEntries, form);
      }
      for (const T form : { T::SumOfReciprocals, T::SumOfSquaredReciprocals, T::Sum })
      {
        compare(mean, meanByEntries, form);
      }
    }
  }
}
}
