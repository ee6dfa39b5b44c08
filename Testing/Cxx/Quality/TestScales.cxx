// SPDX-License-Identifier: BSD-3-Clause
// Cells of extreme size: metrics without a unit do not depend on it, to the last bit for powers of
// two; those with a unit or relative to a target follow it, or are counted as beyond the range.
#include "Blocks.h"
#include "Registry.h"
#include "tautline/Mesh/CoordinateFrame.h"
#include "tautline/Quality/Statistics.h"

using namespace tautline;

namespace
{
/// 1e-301, 1e-150, 1e-100, 1e-30, 1e-12 and so on, as exponents of two.
constexpr int exponents[] = { -1000, -498, -332, -100, -40, 40, 100, 332, 498, 1000 };

MeshData scaled(MeshData data, int exponent)
{
  data.transform([=](const Vec3& p) { return std::ldexp(1.0, exponent) * p; });
  return data;
}

/// Valid and inverted cells; on a surface each in a plane of its own.
MeshData someCells(CellType type, bool surface)
{
  Random random(41);
  std::vector<std::vector<Vec3>> cells;
  return scatteredCells(type, surface, 24, random, cells);
}

/// Whether x times this power of two has all its digits.
bool isHeld(double x, int exponent)
{
  return x == 0 || std::isnormal(std::ldexp(x, exponent));
}

bool hasCubeRoot(const MetricInfo& info, bool solid)
{
  const Metric m = info.metric;
  return m == Metric::InterpolationScaleInvariant ||
    (solid &&
      (m == Metric::InverseMeanRatio || m == Metric::MeanRatio || m == Metric::ShapeBarrier));
}

/// Values and gradients against the mesh of ordinary size.
void compare(const MetricInfo& info, const MeshData& data, int exponent)
{
  const Context context(std::string(info.name) + ", 2^" + std::to_string(exponent));
  const MeshData far = scaled(data, exponent);
  const Mesh mesh(data.view()), farMesh(far.view());
  const int unit = exponent * info.lengthPower(mesh.dimension() == Dimension::Volume ? 3 : 2);
  const Gradients expected = gradientsOf(mesh, info.metric),
                  found = gradientsOf(farMesh, info.metric);
  const std::vector<double> values = valuesOf(farMesh, info.metric),
                            ordinary = valuesOf(mesh, info.metric);
  // Cube roots are right to rounding, the rest is exact.
  const double tolerance = hasCubeRoot(info, mesh.dimension() == Dimension::Volume) ? 1e-14 : 0.0;
  const auto check = [tolerance](double actual, double x, int shift, double size)
  {
    if (isHeld(x, shift))
    {
      TAUTLINE_CHECK_NEAR(actual, std::ldexp(x, shift), tolerance * std::ldexp(size, shift));
    }
  };
  Index beyond = 0;
  double steepest =
    largestOf<double>(0, expected.gradients, [&](double slope) { return std::abs(slope); });
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    check(values[i], ordinary[i], unit, 1 + std::abs(ordinary[i]));
    check(found.values[i], expected.values[i], unit, 1 + std::abs(ordinary[i]));
    beyond += !isHeld(ordinary[i], unit);
  }
  for (std::size_t i = 0; i < expected.gradients.size(); ++i)
  {
    check(found.gradients[i], expected.gradients[i], unit - exponent, steepest);
  }
  std::vector<double> again(values.size());
  TAUTLINE_CHECK_EQUAL(evaluateMetric(farMesh, info.metric, {}, again.data()), beyond);
}

void testInvariance(CellType type, bool surface)
{
  const Context context(topology(type).name + std::string(surface ? ", surface" : ""));
  const MeshData data = someCells(type, surface);
  const Mesh mesh(data.view());
  const std::vector<signed char> validity = validityOf(mesh);
  const auto angles = angleDistribution(mesh, validity.data(), nullptr);
  for (int exponent : exponents)
  {
    const Context size("2^" + std::to_string(exponent));
    const MeshData far = scaled(data, exponent);
    const Mesh farMesh(far.view());
    TAUTLINE_CHECK(farMesh.dimension() == mesh.dimension());
    TAUTLINE_CHECK(validityOf(farMesh) == validity);
    TAUTLINE_CHECK(angleDistribution(farMesh, validity.data(), nullptr) == angles);
  }
  for (const MetricInfo& info : elementMetrics())
  {
    // UntangleBeta is a size of T, and not a power of two times what it is in the cell.
    const bool unit =
      info.scaleInvariant || (info.lengthPower(1) != 0 && info.metric != Metric::UntangleBeta);
    for (int exponent : exponents)
    {
      if (unit && info.definedOn(type))
      {
        compare(info, data, exponent);
      }
    }
  }
}

/// A target of the size of the cells: metrics of size and shape are what they are at size 1. A
/// target of another size: metrics of shape are.
void testTargets(CellType type)
{
  const Context context(topology(type).name);
  MeshData data, model;
  Random random(5);
  for (int i = 0; i < 9; ++i)
  {
    data.addCell(type, validCell(type, 0.2, 0.5, random));
    model.addCell(type, validCell(type, 0.2, 0.5, random));
  }
  const Mesh mesh(data.view()), reference(model.view());
  const Targets targets = referenceTargets(mesh, reference);
  TAUTLINE_CHECK(!targets.extreme);
  for (int exponent : { -498, -332, 332, 498 })
  {
    const MeshData far = scaled(data, exponent), farModel = scaled(model, exponent);
    const Mesh farMesh(far.view()), farReference(farModel.view());
    const Targets farTargets = referenceTargets(farMesh, farReference);
    TAUTLINE_CHECK(farTargets.extreme);
    Targets scaledBack = farTargets;
    scaleTargets(scaledBack, std::ldexp(1.0, exponent));
    TAUTLINE_CHECK(!scaledBack.extreme && scaledBack.inverse[0] == targets.inverse[0]);
    for (const MetricInfo& info : elementMetrics())
    {
      if (info.family != MetricFamily::Target || !info.definedOn(type) || info.lengthPower(1) != 0)
      {
        continue;
      }
      const Context name(std::string(info.name) + ", 2^" + std::to_string(exponent));
      EvaluationOptions options, farOptions;
      options.targets = &targets;
      farOptions.targets = &farTargets;
      const std::vector<double> expected = valuesOf(mesh, info.metric, options);
      TAUTLINE_CHECK(valuesOf(farMesh, info.metric, farOptions) == expected);
      if (info.scaleInvariant)
      {
        TAUTLINE_CHECK(valuesOf(mesh, info.metric, farOptions) == expected);
        TAUTLINE_CHECK(valuesOf(farMesh, info.metric, options) == expected);
      }
    }
  }
}

/// Against a tensor in which the edges have length 1.
TAUTLINE_PART(testTensors)
{
  MeshData data;
  Random random(6);
  for (int i = 0; i < 9; ++i)
  {
    data.addCell(CellType::Tetrahedron, validCell(CellType::Tetrahedron, 0.2, 0.5, random));
  }
  const std::vector<double> unit = { 2, 0.5, 0, 0.5, 1, 0, 0, 0, 3 };
  const auto valuesAt = [&](int exponent, Metric metric)
  {
    std::vector<double> tensors;
    for (Index i = 0; i < data.numberOfCells(); ++i)
    {
      for (double x : unit)
      {
        tensors.push_back(std::ldexp(x, -2 * exponent));
      }
    }
    const MeshData far = scaled(data, exponent);
    const Mesh mesh(far.view());
    const Targets targets = tensorTargets(mesh, tensors.data());
    TAUTLINE_LET(EvaluationOptions, options, targets = &targets);
    return valuesOf(mesh, metric, options);
  };
  for (int exponent : { -498, -332, 332, 498 })
  {
    for (Metric metric :
      { Metric::InverseMeanRatio, Metric::ShapeSizeBarrier, Metric::SizeBarrier })
    {
      const Context context(metricInfo(metric).name + (", 2^" + std::to_string(exponent)));
      const std::vector<double> expected = valuesAt(0, metric), found = valuesAt(exponent, metric);
      TAUTLINE_EACH(
        std::size_t, i, found.size(), TAUTLINE_CHECK_RELATIVE(found[i], expected[i], 1e-12));
    }
  }
}

/// Values outside double precision are counted, and the error names metric and remedy.
TAUTLINE_PART(testBeyond)
{
  const auto beyond = [](CellType type, int exponent, Metric metric, bool inverted = false)
  {
    MeshData data = singleCell(type, idealCell(type));
    // A neighbor of ordinary shape keeps a planar mesh upright.
    data.transform(TAUTLINE_PLACE(inverted ? -p[0] : p[0], p[1], p[2]));
    const MeshData far = scaled(data, exponent);
    double value = 0;
    const Index count = evaluateMetric(Mesh(far.view()), metric, {}, &value);
    TAUTLINE_CHECK(std::isfinite(value) && (count == 0 || value == 0));
    return count;
  };
  const CellType tetrahedron = CellType::Tetrahedron, triangle = CellType::Triangle;
  TAUTLINE_CHECK_EQUAL(beyond(triangle, -498, Metric::Size), 0);
  TAUTLINE_CHECK_EQUAL(beyond(tetrahedron, -498, Metric::Size), 1);
  TAUTLINE_CHECK_EQUAL(beyond(tetrahedron, 498, Metric::Size), 1);
  TAUTLINE_CHECK_EQUAL(beyond(tetrahedron, -498, Metric::ConditioningSizeShape), 0);
  TAUTLINE_CHECK_EQUAL(beyond(tetrahedron, -40, Metric::SizeBarrierSquared), 0);
  TAUTLINE_CHECK_EQUAL(beyond(tetrahedron, -498, Metric::SizeBarrierSquared), 1);
  TAUTLINE_CHECK_EQUAL(beyond(tetrahedron, -498, Metric::SizeNonBarrier), 0);
  TAUTLINE_CHECK_EQUAL(beyond(tetrahedron, 498, Metric::SizeNonBarrier), 1);
  TAUTLINE_CHECK_EQUAL(beyond(tetrahedron, -498, Metric::UntangleBeta), 0);
  TAUTLINE_CHECK_EQUAL(beyond(tetrahedron, -498, Metric::UntangleBeta, true), 1);
  TAUTLINE_CHECK_EQUAL(beyond(tetrahedron, -100, Metric::UntangleBeta, true), 0);
  TAUTLINE_CHECK_EQUAL(beyond(tetrahedron, -498, Metric::InverseMeanRatio), 0);
  requireInRange(metricInfo(Metric::Size), 0);
  TAUTLINE_CHECK_THROWS(
    requireInRange(metricInfo(Metric::Size), 3), wording("size-area-or-volume-of-3-elements"));
  TAUTLINE_CHECK_THROWS(
    requireInRange(metricInfo(Metric::SizeBarrier), 3), wording("a-target-of-the-size"));
}

/// Cells of very different size in one mesh are each measured for themselves.
TAUTLINE_PART(testTogether)
{
  MeshData data;
  const CellType type = CellType::Hexahedron;
  Random random(9);
  const std::vector<Vec3> corners = validCell(type, 0.2, 0.5, random);
  for (int exponent : { 0, -498, 332, -100, 0, 498 })
  {
    std::vector<Vec3> far = corners;
    for (Vec3& p : far)
    {
      p = std::ldexp(1.0, exponent) * p;
    }
    data.addCell(type, far);
  }
  for (Metric metric : { Metric::InverseMeanRatio, Metric::ScaledJacobian, Metric::MinimumAngle })
  {
    const std::vector<double> values = valuesOf(data, metric);
    TAUTLINE_CHECK(values == std::vector<double>(values.size(), valueOf(type, corners, metric)));
  }
}

/// A vertex astray in a mesh of ordinary size is no reason to reject it: its cells are not finite.
TAUTLINE_PART(testStray)
{
  MeshData data = blockMesh(CellType::Tetrahedron, 3, 3, 3);
  data.setPoint(0, { 1e200, 0, 0 });
  const Mesh mesh(data.view());
  const std::vector<signed char> validity = validityOf(mesh);
  const auto cells = mesh.vertexCells();
  TAUTLINE_CHECK_EQUAL(
    std::count(validity.begin(), validity.end(), NonFinite), cells.offsets[1] - cells.offsets[0]);
  std::vector<double> values(validity.size());
  TAUTLINE_CHECK_EQUAL(evaluateMetric(mesh, Metric::Size, {}, values.data()), 0);
  TAUTLINE_CHECK_EQUAL(evaluateMetric(mesh, Metric::SizeBarrierSquared, {}, values.data()), 0);
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testRange)
{
  MeshData data = blockMesh(CellType::Triangle, 40, 40, 0);
  data.transform(TAUTLINE_PLACE(1e6 + 0.25 * p[0], 0.25 * p[1], -2));
  const CoordinateRange range = coordinateRange(data.view());
  TAUTLINE_CHECK_EQUAL(range.extent, 0.25);
  TAUTLINE_CHECK_EQUAL(range.low[0], 1e6);
  TAUTLINE_CHECK_EQUAL(range.high[1], 10);
  TAUTLINE_CHECK_EQUAL(range.farthest(), 1e6 + 10);
  TAUTLINE_CHECK_EQUAL(range.spacing(true), 0.0625);
  TAUTLINE_CHECK_EQUAL(range.spacing(false), std::ldexp(0.0625, -29));
  // Neither NaN nor flat cells count, nor does an empty mesh.
  MeshData odd =
    TAUTLINE_CHANGED(singleCell(CellType::Triangle, { { 1, 1, 1 }, { 1, 1, 1 }, { 1, 1, 1 } }),
      addCell(CellType::Triangle,
        std::vector<Vec3>{
          { 0, std::numeric_limits<double>::quiet_NaN(), 0 }, { 9, 0, 0 }, { 0, 9, 0 } }));
  TAUTLINE_CHECK_EQUAL(coordinateRange(odd.view()).extent, 0);
  TAUTLINE_CHECK(CoordinateFrame(coordinateRange(odd.view())).isIdentity());
  TAUTLINE_CHECK_EQUAL(coordinateRange(MeshData().view()).spacing(false), 0);
}

/// A frame is the identity unless needed; entering it is exact, and so is leaving by scaling.
TAUTLINE_PART(testFrame)
{
  const MeshData data = movedBlock(CellType::Tetrahedron, 3, 0.2);
  const auto frameOf = [](const MeshData& mesh, bool shifted = true)
  { return CoordinateFrame(coordinateRange(mesh.view()), shifted); };
  TAUTLINE_CHECK(frameOf(data).isIdentity());
  TAUTLINE_CHECK(frameOf(scaled(data, -60)).isIdentity());
  for (int exponent : { -498, -100, 100, 498 })
  {
    const MeshData far = scaled(data, exponent);
    const CoordinateFrame frame = frameOf(far);
    TAUTLINE_CHECK((frame.origin() == Vec3{ 0, 0, 0 }));
    std::vector<double> points = far.points;
    frame.enter(points);
    const double largest = *std::max_element(points.begin(), points.end());
    TAUTLINE_CHECK(largest > 1 && largest < 8);
    frame.leave(points);
    TAUTLINE_CHECK(points == far.points);
  }
  MeshData distant = data;
  distant.transform([](const Vec3& p) { return p + Vec3{ 1e12, 3, 1e5 }; });
  const CoordinateFrame frame = frameOf(distant);
  TAUTLINE_CHECK(std::abs(frame.origin()[0] - 1e12) < 2 && frame.unit() == 1);
  TAUTLINE_CHECK(frame.origin()[1] == 0 && frame.origin()[2] == 0);
  TAUTLINE_CHECK(frameOf(distant, false).isIdentity());
  std::vector<double> points = distant.points;
  frame.enter(points);
  for (std::size_t i = 0; i < points.size(); i += 3)
  {
    TAUTLINE_CHECK_EQUAL(points[i], distant.points[i] - frame.origin()[0]);
    TAUTLINE_CHECK_EQUAL(points[i + 1], distant.points[i + 1]);
  }
  frame.leave(points);
  TAUTLINE_CHECK(points == distant.points);
}

/// Filters that sum over elements reject cells of extreme size by name.
TAUTLINE_PART(testRejection)
{
  const MeshData data = scaled(blockMesh(CellType::Triangle, 2, 2, 0), -498);
  requireOrdinaryScale(scaled(data, 450).view(), "Anything");
  TAUTLINE_CHECK_THROWS(
    requireOrdinaryScale(data.view(), "Warping"), wording("warping-needs-cells-between-5-4e-20-2"));
  const Mesh mesh(data.view());
  TAUTLINE_CHECK_THROWS(
    MetricSum(mesh, Metric::InverseMeanRatio, {}, 2), wording("scale-the-mesh-first"));
}
}

TAUTLINE_TEST(TestScales)
{
  for (CellType type : allTypes)
  {
    TAUTLINE_RUN(testInvariance(type, false));
    if (topology(type).dimension == 2)
    {
      TAUTLINE_RUN(testInvariance(type, true));
    }
    TAUTLINE_RUN(testTargets(type));
  }
}
