// SPDX-License-Identifier: BSD-3-Clause
// Elements no metric is made for: flat, collapsed, not finite, enormous and tiny. Each is flagged,
// its values and gradients are finite, and where a metric is singular its value is 0.
#include "Meshes.h"
#include "Registry.h"

using namespace tautline;

namespace
{
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double notANumber = std::numeric_limits<double>::quiet_NaN();
constexpr Combination combinations[] = { Combination::Mean, Combination::Worst,
  Combination::PowerMean };
using Corners = std::vector<Vec3>;

bool allFinite(const std::vector<double>& values)
{
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

/// Metrics with a formula that breaks down where a corner Jacobian vanishes. The others are
/// polynomials of T, or lengths and angles.
bool isSingular(const MetricInfo& info)
{
  return (info.family == MetricFamily::Target && info.inverted != InvertedValue::Larger) ||
    info.family == MetricFamily::Simplex;
}

/// Everything finite; singular metrics 0 if `degenerate`.
void checkFinite(const MeshData& data, bool degenerate)
{
  const Mesh mesh(data.view());
  for (const MetricInfo& info : elementMetrics())
  {
    if (!info.rotationInvariant && mesh.dimension() == Dimension::Surface)
    {
      continue;
    }
    const Context context(info.name);
    for (Combination combination : combinations)
    {
      TAUTLINE_LET(EvaluationOptions, options, combination = combination);
      const Gradients g = gradientsOf(mesh, info.metric, options);
      TAUTLINE_CHECK(allFinite(g.values));
      TAUTLINE_CHECK(allFinite(g.gradients));
      TAUTLINE_CHECK(allFinite(valuesOf(mesh, info.metric, options)));
      if (degenerate && isSingular(info))
      {
        TAUTLINE_CHECK(
          std::all_of(g.values.begin(), g.values.end(), [](double v) { return v == 0; }));
        TAUTLINE_CHECK(
          std::all_of(g.gradients.begin(), g.gradients.end(), [](double v) { return v == 0; }));
      }
    }
  }
}

void checkOne(const std::string& name, CellType type, const Corners& corners, Validity expected)
{
  const Context context(topology(type).name + (", " + name));
  const MeshData data = singleCell(type, corners);
  TAUTLINE_CHECK_EQUAL(int(validityOf(data)[0]), int(expected));
  checkFinite(data, expected == Degenerate);
}

//------------------------------------------------------------------------------
void testCollapsed(CellType type)
{
  const Corners ideal = idealCell(type);
  const CellTopology& t = topology(type);
  checkOne("a point", type, Corners(ideal.size(), Vec3{ 1, 2, 3 }), Degenerate);
  checkOne("the origin", type, Corners(ideal.size(), Vec3{ 0, 0, 0 }), Degenerate);
  Corners line = ideal, plane = ideal;
  for (std::size_t k = 0; k < ideal.size(); ++k)
  {
    line[k] = { ideal[k][0] + 2 * ideal[k][1] + 3 * ideal[k][2], 0, 0 };
    plane[k][2] = 0;
  }
  checkOne("on a line", type, line, Degenerate);
  if (t.dimension == 3)
  {
    checkOne("in a plane", type, plane, Degenerate);
  }
  for (int e = 0; e < t.edges; ++e)
  {
    Corners collapsed = ideal;
    collapsed[t.edgeNodes[e][1]] = collapsed[t.edgeNodes[e][0]];
    checkOne("edge " + std::to_string(e) + " collapsed", type, collapsed, Degenerate);
  }
}

void testNonFinite(CellType type)
{
  for (double bad : { notANumber, infinity, -infinity })
  {
    for (std::size_t k = 0; k < idealCell(type).size(); ++k)
    {
      for (int c = 0; c < 3; ++c)
      {
        Corners corners = idealCell(type);
        corners[k][c] = bad;
        MeshData data = singleCell(type, corners);
        const Context context(topology(type).name + std::string(", not finite"));
        TAUTLINE_CHECK_EQUAL(int(validityOf(data)[0]), int(NonFinite));
        TAUTLINE_CHECK_EQUAL(Mesh(data.view()).nonFinitePoints(), 1);
        checkFinite(data, false);
        // A good cell beside it, in the same batch, does not notice.
        data.addCell(type, idealCell(type));
        TAUTLINE_CHECK_EQUAL(int(validityOf(data)[1]), int(Valid));
        for (Metric metric : { Metric::InverseMeanRatio, Metric::Size, Metric::MinimumAngle })
        {
          TAUTLINE_CHECK_NEAR(
            valuesOf(data, metric)[1], valueOf(type, idealCell(type), metric), 1e-13);
        }
      }
    }
  }
}

//------------------------------------------------------------------------------
/// Well-shaped cells of any size are measured as such.
void testMagnitudes(CellType type)
{
  for (double scale : { 1e-300, 1e-150, 1e-100, 1e-60, 1e-30, 1e30, 1e60, 1e100, 1e150, 1e300 })
  {
    const Context context(topology(type).name + (", size " + std::to_string(std::log10(scale))));
    Random random(16);
    Corners corners = validCell(type, 0.2, 0.5, random), scaled = corners;
    for (Vec3& p : scaled)
    {
      p = scale * p;
    }
    const MeshData data = singleCell(type, scaled);
    checkFinite(data, false);
    TAUTLINE_CHECK_EQUAL(int(validityOf(data)[0]), int(Valid));
    for (const MetricInfo& info : elementMetrics())
    {
      if (info.scaleInvariant && info.definedOn(type))
      {
        const Context name(info.name);
        const double expected = valueOf(type, corners, info.metric);
        TAUTLINE_CHECK_NEAR(
          valuesOf(data, info.metric)[0], expected, 1e-12 * std::max(1.0, std::abs(expected)));
      }
    }
  }
}

/// Flatter and flatter: valid and ever worse until the tolerance, then degenerate.
void testSlivers(CellType type)
{
  const Context context(topology(type).name + std::string(", sliver"));
  double last = 0;
  for (int exponent = 0; exponent <= 20; ++exponent)
  {
    const double height = std::pow(10, -exponent);
    const MeshData data = singleCell(type, flattenedCell(type, height));
    const bool degenerate = height < 0.05 * Mesh::degenerateTolerance();
    const bool valid = height > 20 * Mesh::degenerateTolerance();
    checkFinite(data, degenerate);
    const signed char validity = validityOf(data)[0];
    const double imr = valuesOf(data, Metric::InverseMeanRatio)[0];
    if (valid)
    {
      TAUTLINE_CHECK_EQUAL(int(validity), int(Valid));
      TAUTLINE_CHECK(imr > last);
      last = imr;
    }
    else if (degenerate)
    {
      TAUTLINE_CHECK_EQUAL(int(validity), int(Degenerate));
    }
    // Needles: stretched instead of flattened.
    checkFinite(singleCell(type, flattenedCell(type, 1 / height)), false);
  }
}

/// A quadrilateral with a straight corner (at 1) and an inverted one (at 2): the inverted one
/// determines the value.
TAUTLINE_PART(testStraightAndInverted)
{
  const Corners corners = { { 0, 0, 0 }, { 3, 0, 0 }, { 2, 0, 0 }, { 1, 1, 0 } };
  const MeshData data = singleCell(CellType::Quadrilateral, corners);
  TAUTLINE_CHECK_EQUAL(int(validityOf(data)[0]), int(Inverted));
  for (Combination combination : combinations)
  {
    TAUTLINE_LET(EvaluationOptions, options, combination = combination);
    for (const MetricInfo& info : elementMetrics())
    {
      if (info.family == MetricFamily::Target && info.definedOn(CellType::Quadrilateral) &&
        info.inverted == InvertedValue::Negative)
      {
        const Context context(info.name);
        TAUTLINE_CHECK(valuesOf(data, info.metric, options)[0] < 0);
      }
    }
    // Its corner is a corner of the triangle 1 2 3, of edges 1 and sqrt 2 and twice the area 1.
    TAUTLINE_CHECK_NEAR(valuesOf(data, Metric::MeanRatio, options)[0], -2.0 / 3, 1e-14);
  }
}

/// Validity follows the signs of the corners, and the metrics with a sign follow validity.
void testSigns(CellType type)
{
  const Context context(topology(type).name + std::string(", signs"));
  Random random(17);
  MeshData data;
  std::vector<Validity> expected;
  constexpr int cells = 2000;
  for (int i = 0; i < cells; ++i)
  {
    Corners corners;
    double low = 0;
    do // away from the border between the two, and not folded between valid corners
    {
      corners = perturbedCell(type, 1, random);
      const std::vector<double> sines = cornerSines(type, corners);
      low = *std::min_element(sines.begin(), sines.end());
    } while (
      std::abs(low) < 1e-6 || (low > 0 && valueOf(type, corners, Metric::MinimumJacobian) < 1e-9));
    data.addCell(type, corners);
    expected.push_back(low > 0 ? Valid : Inverted);
  }
  const Mesh mesh(data.view());
  const std::vector<signed char> validity = validityOf(mesh);
  TAUTLINE_CHECK(std::equal(validity.begin(), validity.end(), expected.begin(),
    [](signed char a, Validity b) { return a == b; }));
  for (const MetricInfo& info : elementMetrics())
  {
    const bool size = info.metric == Metric::Size;
    if (!info.definedOn(type) || info.inverted != InvertedValue::Negative || size)
    {
      continue; // the size of an inverted quadrilateral may be positive
    }
    const Context name(info.name);
    const std::vector<double> values = valuesOf(mesh, info.metric);
    TAUTLINE_EACH(
      int, i, cells, TAUTLINE_CHECK(expected[i] == Valid ? values[i] > 0 : values[i] < 0));
  }
}
}

TAUTLINE_TEST(TestDegenerate)
{
  for (CellType type : allTypes)
  {
    TAUTLINE_RUN(testCollapsed(type));
    TAUTLINE_RUN(testNonFinite(type));
    TAUTLINE_RUN(testMagnitudes(type));
    TAUTLINE_RUN(testSlivers(type));
    TAUTLINE_RUN(testSigns(type));
  }
}
