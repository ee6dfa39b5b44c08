// SPDX-License-Identifier: BSD-3-Clause
// Certified minima of quality metrics of curved elements: known values, dense samples, invariances,
// meshes with known means.
#include "CurvedElements.h"
#include "Registry.h"

#include "tautline/Elements/MetricCertifier.h"
#include "tautline/Mesh/CellTopology.h"

#include "vtkCellType.h"

#include <limits>

using namespace tautline;

namespace
{
const Vec3 zAxis = { 0, 0, 1 };
constexpr double tolerance = 1e-3;

constexpr ElementMetric allMetrics[] = { ElementMetric::MeanRatio, ElementMetric::InverseCondition,
  ElementMetric::ScaledJacobian };

MetricBound boundOf(const ElementType& type, ElementMetric metric, const std::vector<Vec3>& nodes,
  const Vec3& normal = zAxis, double gap = tolerance)
{
  MetricCertifier certifier(type, metric, normal);
  const ElementSet set = setOf({ nodes });
  const MetricBound bound = certifier.minimum(set.coordinates(), set.elements[0], gap);
  TAUTLINE_CHECK(bound.lower <= bound.upper);
  TAUTLINE_CHECK(bound.upper < 0 || bound.upper - bound.lower <= gap);
  return bound;
}

/// The corner of a cell in its ideal shape that has the reference axes as edges.
CellType cornerTypeOf(ElementShape shape)
{
  constexpr CellType types[] = { CellType::Triangle, CellType::Quadrilateral, CellType::Tetrahedron,
    CellType::Hexahedron, CellType::Wedge, CellType::Pyramid };
  return types[static_cast<int>(shape)];
}

/// A metric at a place, from the derivatives of the map and the formula.
double metricAt(
  const ElementType& type, ElementMetric metric, const std::vector<Vec3>& nodes, const Vec3& at)
{
  std::array<Vec3, 3> a = derivativesAt(type, nodes, at);
  const int n = type.dimension();
  const ElementShape shape = type.shape();
  if (shape == ElementShape::Pyramid)
  {
    a[0] = (1 / (1 - at[2])) * a[0];
    a[1] = (1 / (1 - at[2])) * a[1];
    a[2] += at[0] * a[0] + at[1] * a[1];
  }
  const auto determinant = [n](const std::array<Vec3, 3>& m)
  { return n == 2 ? cross(m[0], m[1])[2] : dot(m[0], cross(m[1], m[2])); };
  if (metric == ElementMetric::ScaledJacobian)
  {
    const bool simplex = shape == ElementShape::Triangle || shape == ElementShape::Tetrahedron;
    const int flat = shape == ElementShape::Wedge ? 2 : n;
    const double factor = topology(cornerTypeOf(shape)).scaledJacobianFactor;
    const double det = determinant(a);
    double least = std::numeric_limits<double>::infinity();
    // The edges at each corner of the simplex: from the corner to the others.
    const int corners = simplex || shape == ElementShape::Wedge ? flat + 1 : 1;
    for (int corner = 0; corner < corners; ++corner)
    {
      double product = flat < n ? norm(a[2]) : 1;
      for (int k = 0; k <= flat; ++k)
      {
        const Vec3 from = corner > 0 ? a[corner - 1] : Vec3{ 0, 0, 0 };
        const Vec3 to = k > 0 ? a[k - 1] : Vec3{ 0, 0, 0 };
        product *= k == corner ? 1 : norm(to - from);
      }
      least = std::min(least, factor * det / product);
    }
    return least;
  }
  // T = A W^-1 with W of the edges of the ideal cell.
  const double root3 = std::sqrt(3.0);
  std::array<Vec3, 3> w = { Vec3{ 1, 0, 0 }, Vec3{ 0, 1, 0 }, Vec3{ 0, 0, 1 } };
  if (shape != ElementShape::Quadrilateral && shape != ElementShape::Hexahedron &&
    shape != ElementShape::Pyramid)
  {
    w[1] = { 0.5, root3 / 2, 0 };
  }
  if (shape == ElementShape::Tetrahedron)
  {
    w[2] = { 0.5, root3 / 6, std::sqrt(2.0 / 3) };
  }
  if (shape == ElementShape::Pyramid)
  {
    w[2] = { 0.5, 0.5, std::sqrt(0.5) };
  }
  // The dual basis of W.
  const double volume = dot(w[0], cross(w[1], w[2]));
  std::array<Vec3, 3> t = { Vec3{ 0, 0, 0 }, Vec3{ 0, 0, 0 }, Vec3{ 0, 0, 0 } };
  for (int k = 0; k < n; ++k)
  {
    const Vec3 dual = (1 / volume) * cross(w[(k + 1) % 3], w[(k + 2) % 3]);
    for (int c = 0; c < n; ++c)
    {
      t[c] += dual[c] * a[k];
    }
  }
  const double tau = determinant(t);
  double squares = 0, adjugate = 0;
  for (int c = 0; c < 3; ++c)
  {
    squares += dot(t[c], t[c]);
    const Vec3 k = cross(t[c], t[(c + 1) % 3]);
    adjugate += dot(k, k);
  }
  if (n == 2)
  {
    return 2 * tau / squares;
  }
  return metric == ElementMetric::MeanRatio
    ? 3 * std::copysign(std::pow(std::abs(tau), 2.0 / 3), tau) / squares
    : 3 * tau / std::sqrt(squares * adjugate);
}

/// Random elements against dense samples.
void testRandom(const ElementType& type, double amplitude, const std::string& name)
{
  const Context context(name);
  SplitMix random(7, 3, type.nodes());
  const std::vector<Vec3> places = placesOf(type, type.dimension() == 2 ? 12 : 5);
  int valid = 0;
  for (int n = 0; n < 12; ++n)
  {
    const std::vector<Vec3> element = randomElement(type, amplitude, random);
    const ElementSet set = setOf({ element });
    JacobianCertifier certifier(type, zAxis);
    const bool isValid = classify(certifier, set)[0] == ElementValidity::Valid;
    valid += isValid;
    for (ElementMetric metric : allMetrics)
    {
      if (metric == ElementMetric::ScaledJacobian && type.shape() == ElementShape::Pyramid)
      {
        continue;
      }
      MetricCertifier metrics(type, metric, zAxis);
      const MetricBound bound = metrics.minimum(set.coordinates(), set.elements[0]);
      const bool apex = type.shape() == ElementShape::Pyramid && bound.at[2] > 0.99;
      if (!apex)
      {
        TAUTLINE_CHECK_NEAR(metricAt(type, metric, element, bound.at), bound.upper, 1e-8);
      }
      TAUTLINE_CHECK_NEAR(
        metrics.valueAt(set.coordinates(), set.elements[0], bound.at), bound.upper, 1e-9);
      TAUTLINE_CHECK_NEAR(metrics.valueAt(set.coordinates(), set.elements[0], places[1]),
        metricAt(type, metric, element, places[1]), 1e-8);
      if (!isValid)
      {
        continue;
      }
      TAUTLINE_CHECK(bound.upper > 0 && bound.upper <= 1 + 1e-12);
      TAUTLINE_CHECK(bound.upper - bound.lower <= tolerance && bound.lower >= 0);
      double sampled = std::numeric_limits<double>::infinity();
      for (const Vec3& place : places)
      {
        sampled = std::min(sampled, metricAt(type, metric, element, place));
      }
      TAUTLINE_CHECK(bound.lower <= sampled + 1e-10);
    }
  }
  TAUTLINE_CHECK(valid > 3);
}

void testRandom(int vtkType, int nodes, double amplitude)
{
  testRandom(ElementType::ofVtk(vtkType, nodes), amplitude,
    "VTK type " + std::to_string(vtkType) + ", " + std::to_string(nodes) + " nodes");
}

ElementSet cubeHoles()
{
  return setOf(elementsOf(
    readMfem(externalData("curved") + "/cube-holes-inv.mesh", false), FileTetrahedron10));
}
}

/// A straight element has the same value everywhere as at its corners.
TAUTLINE_PART(testStraight)
{
  const double tau = 2 / std::sqrt(3.0), squares = 1 + 1 / 3.0 + 4 / 3.0;
  const ElementType& triangle = ElementType::ofVtk(VTK_QUADRATIC_TRIANGLE, 6);
  const MetricBound right = boundOf(triangle, ElementMetric::MeanRatio, straightElement(triangle));
  TAUTLINE_CHECK_NEAR(right.upper, 2 * tau / squares, 1e-14);
  TAUTLINE_CHECK_NEAR(right.lower, right.upper, 1e-12);
  for (const auto& [vtkType, nodes] : { std::pair<int, int>(VTK_TRIQUADRATIC_HEXAHEDRON, 27),
         { VTK_QUADRATIC_HEXAHEDRON, 20 }, { VTK_BIQUADRATIC_QUAD, 9 } })
  {
    const ElementType& type = ElementType::ofVtk(vtkType, nodes);
    for (ElementMetric metric : allMetrics)
    {
      TAUTLINE_CHECK_NEAR(boundOf(type, metric, straightElement(type)).lower, 1.0, 1e-12);
    }
  }
}

/// The ideal elements have the value 1: they are the maps W of the reference elements.
TAUTLINE_PART(testIdeal)
{
  const double root3 = std::sqrt(3.0);
  for (const auto& [vtkType, nodes] :
    { std::pair<int, int>(VTK_QUADRATIC_TRIANGLE, 6), { VTK_QUADRATIC_TETRA, 10 },
      { VTK_BIQUADRATIC_QUADRATIC_WEDGE, 18 }, { VTK_QUADRATIC_PYRAMID, 13 } })
  {
    const ElementType& type = ElementType::ofVtk(vtkType, nodes);
    std::vector<Vec3> points = straightElement(type);
    for (Vec3& p : points)
    {
      switch (type.shape())
      {
        case ElementShape::Tetrahedron:
          p = { p[0] + p[1] / 2 + p[2] / 2, root3 / 2 * p[1] + root3 / 6 * p[2],
            std::sqrt(2.0 / 3) * p[2] };
          break;
        case ElementShape::Pyramid:
          p = { p[0] + p[2] / 2, p[1] + p[2] / 2, std::sqrt(0.5) * p[2] };
          break;
        default:
          p = { p[0] + p[1] / 2, root3 / 2 * p[1], p[2] };
      }
    }
    for (ElementMetric metric : allMetrics)
    {
      if (type.shape() != ElementShape::Pyramid || metric != ElementMetric::ScaledJacobian)
      {
        TAUTLINE_CHECK_NEAR(boundOf(type, metric, points).lower, 1.0, 1e-12);
      }
    }
  }
  TAUTLINE_CHECK_THROWS(
    MetricCertifier(ElementType::ofVtk(VTK_QUADRATIC_PYRAMID, 13), ElementMetric::ScaledJacobian),
    wording("a-pyramid-has-no-scaled-jacobian"));
}

/// The map (u, v) -> (u + a u^2, v): the mean ratio with x_u = 1 + 2 a u is smallest at u = 1.
TAUTLINE_PART(testStretched)
{
  const ElementType& type = ElementType::ofVtk(VTK_BIQUADRATIC_QUAD, 9);
  std::vector<Vec3> points = type.coordinates();
  for (Vec3& p : points)
  {
    p[0] += p[0] * p[0];
  }
  const MetricBound bound = boundOf(type, ElementMetric::MeanRatio, points, zAxis, 1e-8);
  TAUTLINE_CHECK_NEAR(bound.upper, 0.6, 1e-12); // 2 * 3 / (9 + 1)
  TAUTLINE_CHECK_NEAR(bound.lower, 0.6, 1e-8);
  TAUTLINE_CHECK_NEAR(bound.at[0], 1.0, 1e-12);
  TAUTLINE_CHECK_NEAR(
    boundOf(type, ElementMetric::ScaledJacobian, points, zAxis, 1e-5).lower, 1.0, 1e-5);
}

/// A hexahedron sheared by a parabola, most at one end of v.
TAUTLINE_PART(testSheared)
{
  const ElementType& type = ElementType::ofVtk(VTK_TRIQUADRATIC_HEXAHEDRON, 27);
  std::vector<Vec3> points = type.coordinates();
  for (Vec3& p : points)
  {
    p[0] += 2 * (p[1] - 0.25) * (p[1] - 0.25) * (p[1] - 0.25) - 2 * p[1] * p[1] * p[1];
  }
  // x_v = s with the slope s = 0.375 - 3 v: T = [1 s 0; 0 1 0; 0 0 1].
  const double s = 2.625, squares = 3 + s * s, adjugate = 3 + s * s;
  TAUTLINE_CHECK_NEAR(
    boundOf(type, ElementMetric::MeanRatio, points, zAxis, 1e-6).upper, 3 / squares, 1e-6);
  TAUTLINE_CHECK_NEAR(boundOf(type, ElementMetric::InverseCondition, points, zAxis, 1e-6).upper,
    3 / std::sqrt(squares * adjugate), 1e-6);
  TAUTLINE_CHECK_NEAR(boundOf(type, ElementMetric::ScaledJacobian, points, zAxis, 1e-6).upper,
    1 / std::sqrt(1 + s * s), 1e-6);
}

TAUTLINE_PART(testRandomPlane)
{
  testRandom(VTK_QUADRATIC_TRIANGLE, 6, 0.1);
  testRandom(VTK_LAGRANGE_TRIANGLE, 10, 0.05);
  testRandom(VTK_QUAD, 4, 0.3);
  testRandom(VTK_QUADRATIC_QUAD, 8, 0.12);
  testRandom(VTK_BIQUADRATIC_QUAD, 9, 0.1);
  testRandom(VTK_LAGRANGE_QUADRILATERAL, 16, 0.05);
}

TAUTLINE_PART(testRandomSolid)
{
  testRandom(VTK_QUADRATIC_TETRA, 10, 0.06);
  testRandom(VTK_LAGRANGE_TETRAHEDRON, 20, 0.03);
  testRandom(VTK_HEXAHEDRON, 8, 0.2);
  testRandom(VTK_QUADRATIC_HEXAHEDRON, 20, 0.08);
  testRandom(VTK_TRIQUADRATIC_HEXAHEDRON, 27, 0.06);
  testRandom(VTK_QUADRATIC_WEDGE, 15, 0.06);
  testRandom(VTK_BIQUADRATIC_QUADRATIC_WEDGE, 18, 0.06);
  testRandom(VTK_WEDGE, 6, 0.15);
  testRandom(VTK_QUADRATIC_PYRAMID, 13, 0.04);
  testRandom(VTK_PYRAMID, 5, 0.1);
}

/// A plane patch in space has the metrics of the plane, whatever its orientation; they do not
/// depend on size, place and the order of the nodes.
TAUTLINE_PART(testInvariance)
{
  SplitMix random(7, 4, 6);
  const ElementType& triangle = ElementType::ofVtk(VTK_QUADRATIC_TRIANGLE, 6);
  const ElementType& tetrahedron = ElementType::ofVtk(VTK_QUADRATIC_TETRA, 10);
  const ElementType& quadrilateral = ElementType::ofVtk(VTK_BIQUADRATIC_QUAD, 9);
  for (int n = 0; n < 8; ++n)
  {
    for (ElementMetric metric : allMetrics)
    {
      for (const ElementType* flat : { &triangle, &quadrilateral })
      {
        const std::vector<Vec3> points = randomElement(*flat, 0.08, random);
        std::vector<Vec3> tilted, huge;
        for (const Vec3& p : points)
        {
          tilted.push_back({ 3 + p[0], 0.6 * p[1], -0.8 * p[1] });
          huge.push_back(0x1p+80 * p);
        }
        const double plane = boundOf(*flat, metric, points, zAxis, 1e-5).upper;
        TAUTLINE_CHECK_NEAR(boundOf(*flat, metric, tilted, { 0, 0, 0 }, 1e-5).upper, plane, 2e-5);
        TAUTLINE_CHECK_NEAR(boundOf(*flat, metric, huge, zAxis, 1e-5).upper, plane, 2e-5);
      }
      const std::vector<Vec3> points = randomElement(tetrahedron, 0.05, random);
      // Corners 1 2 0 3: edges 12 20 01 13 23 03.
      std::vector<Vec3> turned;
      for (int k : { 1, 2, 0, 3, 5, 6, 4, 8, 9, 7 })
      {
        turned.push_back(points[k]);
      }
      const double straight = boundOf(tetrahedron, metric, points, zAxis, 1e-5).upper;
      TAUTLINE_CHECK_NEAR(boundOf(tetrahedron, metric, turned, zAxis, 1e-5).upper, straight, 2e-5);
    }
  }
}

/// The means of the minima over the mesh of MFEM, invalid elements taken for 0. The mean ratio
/// agrees with Gmsh; the others with dense samples.
TAUTLINE_PART(testCubeHoles)
{
  const ElementType& type = ElementType::ofVtk(VTK_QUADRATIC_TETRA, 10);
  const ElementSet set = cubeHoles();
  JacobianCertifier jacobian(type);
  const std::vector<ElementValidity> validity = classify(jacobian, set);
  constexpr double means[] = { 0.65723, 0.63933, 0.43193 };
  for (ElementMetric metric : allMetrics)
  {
    MetricCertifier certifier(type, metric);
    double sum = 0;
    for (Index e = 0; e < set.count(); ++e)
    {
      const MetricBound bound = certifier.minimum(set.coordinates(), set.elements[e]);
      TAUTLINE_CHECK(bound.upper < 0 || bound.upper - bound.lower <= tolerance);
      TAUTLINE_CHECK(bound.upper > 0 || validity[e] != ElementValidity::Valid);
      sum += std::max(bound.upper, 0.0);
    }
    TAUTLINE_CHECK_NEAR(
      sum / static_cast<double>(set.count()), means[static_cast<int>(metric)], 1e-5);
  }
}

/// Coordinates that are not finite have no bounds.
TAUTLINE_PART(testNotFinite)
{
  const ElementType& type = ElementType::ofVtk(VTK_QUADRATIC_TETRA, 10);
  std::vector<Vec3> points = straightElement(type);
  points[6][1] = std::numeric_limits<double>::quiet_NaN();
  const ElementSet set = setOf({ points });
  for (ElementMetric metric : allMetrics)
  {
    MetricCertifier certifier(type, metric);
    TAUTLINE_CHECK(std::isnan(certifier.minimum(set.coordinates(), set.elements[0]).upper));
  }
}
