// SPDX-License-Identifier: BSD-3-Clause
// Certified validity of curved elements: known minima, dense samples, surfaces, bad numbers.
#include "CurvedElements.h"
#include "Registry.h"

#include "tautline/Mesh/JacobianBounds.h"

#include "vtkCellType.h"

#include <limits>

using namespace tautline;

namespace
{
const Vec3 zAxis = { 0, 0, 1 };

/// The bounds of one element, which must have the same validity from classify().
JacobianBound boundOf(const ElementType& type, const std::vector<Vec3>& nodes,
  const MinimumTolerance& tolerance = {}, const Vec3& normal = zAxis, bool mirrored = false)
{
  JacobianCertifier certifier(type, normal, mirrored);
  const ElementSet set = setOf({ nodes });
  const JacobianBound bound = certifier.minimum(set.coordinates(), set.elements[0], tolerance);
  TAUTLINE_CHECK(classify(certifier, set)[0] == bound.validity);
  TAUTLINE_CHECK_EQUAL(certifier.counts().undecided, 0);
  return bound;
}

ElementValidity validityOf(const ElementType& type, const std::vector<Vec3>& nodes)
{
  return boundOf(type, nodes).validity;
}

/// One random element: its verdict and bounds against samples of the determinant.
void checkElement(const ElementType& type, const std::vector<Vec3>& element,
  const std::vector<Vec3>& places, const JacobianBound& bound)
{
  TAUTLINE_CHECK(bound.lower <= bound.upper);
  TAUTLINE_CHECK(bound.upper - bound.lower <= 1e-4);
  // At the place of the minimum the determinant has the upper bound as its value. The apex of a
  // pyramid is approached.
  Vec3 at = bound.at;
  const bool apex = type.shape() == ElementShape::Pyramid && at[2] > 0.999;
  at[2] = apex ? 0.999 : at[2];
  TAUTLINE_CHECK_NEAR(determinantAt(type, element, at), bound.upper, apex ? 0.1 : 1e-9);
  double sampled = std::numeric_limits<double>::infinity();
  for (const Vec3& place : places)
  {
    sampled = std::min(sampled, determinantAt(type, element, place));
  }
  TAUTLINE_CHECK(bound.lower <= sampled + 1e-10);
  TAUTLINE_CHECK(bound.validity != ElementValidity::Valid || (sampled > 0 && bound.upper > 0));
  TAUTLINE_CHECK(bound.validity != ElementValidity::Invalid || bound.upper < 0);
  TAUTLINE_CHECK(bound.validity != ElementValidity::Degenerate);
}

/// Random elements of a type: some are valid and some are not, and no sample contradicts.
void testRandom(const ElementType& type, double amplitude, int count, const std::string& name)
{
  const Context context(name);
  SplitMix random(7, 1, type.nodes());
  std::vector<std::vector<Vec3>> elements;
  for (int n = 0; n < count; ++n)
  {
    elements.push_back(randomElement(type, amplitude, random));
  }
  const ElementSet set = setOf(elements);
  JacobianCertifier certifier(type, zAxis);
  const std::vector<ElementValidity> validity = classify(certifier, set);
  int invalid = 0;
  const std::vector<Vec3> places = placesOf(type, type.dimension() == 2 ? 10 : 4);
  MinimumTolerance tolerance;
  tolerance.relative = 1e-6;
  for (int n = 0; n < count; ++n)
  {
    const JacobianBound bound = certifier.minimum(set.coordinates(), set.elements[n], tolerance);
    TAUTLINE_CHECK(bound.validity == validity[n]);
    checkElement(type, elements[n], places, bound);
    invalid += validity[n] == ElementValidity::Invalid;
  }
  TAUTLINE_CHECK_EQUAL(certifier.counts().undecided, 0);
  TAUTLINE_CHECK(invalid > 0 && invalid < count);
}

void testRandom(int vtkType, int nodes, double amplitude, int count)
{
  testRandom(ElementType::ofVtk(vtkType, nodes), amplitude, count,
    "VTK type " + std::to_string(vtkType) + ", " + std::to_string(nodes) + " nodes");
}

std::vector<Vec3> scaled(std::vector<Vec3> points, double scale)
{
  for (Vec3& p : points)
  {
    p = scale * p;
  }
  return points;
}
}

/// The middle node of the slanted edge at (c, c): the least determinant is 4 c - 1.
TAUTLINE_PART(testSlantedEdge)
{
  const ElementType& triangle = ElementType::ofVtk(VTK_QUADRATIC_TRIANGLE, 6);
  const ElementType& tetrahedron = ElementType::ofVtk(VTK_QUADRATIC_TETRA, 10);
  for (const ElementType* type : { &triangle, &tetrahedron })
  {
    for (double c : { 0.125, 0.1875, 0.25, 0.3125, 0.375, 0.5 })
    {
      std::vector<Vec3> points = straightElement(*type);
      points[type == &triangle ? 4 : 5] = { c, c, 0 };
      const JacobianBound bound = boundOf(*type, points);
      TAUTLINE_CHECK_NEAR(bound.upper, 4 * c - 1, 1e-14);
      TAUTLINE_CHECK_NEAR(bound.lower, 4 * c - 1, 1e-4);
      const ElementValidity expected = c > 0.25 ? ElementValidity::Valid
        : c < 0.25                              ? ElementValidity::Invalid
                                                : ElementValidity::Degenerate;
      TAUTLINE_CHECK(bound.validity == expected);
      if (c < 0.5)
      {
        TAUTLINE_CHECK_NEAR(bound.at[0] + bound.at[1], 1.0, 1e-12); // all along the edge
      }
    }
  }
}

/// An edge whose middle node is at a quarter of it has a singular end.
TAUTLINE_PART(testQuarterPoint)
{
  struct Edge
  {
    int vtkType, nodes, from, to, middle;
  };
  for (const Edge& e : { Edge{ VTK_QUADRATIC_TRIANGLE, 6, 0, 1, 3 },
         Edge{ VTK_QUADRATIC_QUAD, 8, 0, 1, 4 }, Edge{ VTK_BIQUADRATIC_QUAD, 9, 1, 2, 5 },
         Edge{ VTK_QUADRATIC_TETRA, 10, 0, 3, 7 }, Edge{ VTK_QUADRATIC_HEXAHEDRON, 20, 1, 5, 17 },
         Edge{ VTK_TRIQUADRATIC_HEXAHEDRON, 27, 2, 3, 10 },
         Edge{ VTK_QUADRATIC_WEDGE, 15, 1, 4, 13 }, Edge{ VTK_QUADRATIC_PYRAMID, 13, 0, 1, 5 } })
  {
    const Context context("VTK type " + std::to_string(e.vtkType));
    const ElementType& type = ElementType::ofVtk(e.vtkType, e.nodes);
    const auto verdict = [&](double s)
    {
      std::vector<Vec3> points = straightElement(type);
      points[e.middle] = (1 - s) * points[e.from] + s * points[e.to];
      return validityOf(type, points);
    };
    for (double side : { -1.0, 1.0 })
    {
      TAUTLINE_CHECK(verdict(0.5 + side * 0.25) == ElementValidity::Degenerate);
      TAUTLINE_CHECK(verdict(0.5 + side * 0.2499) == ElementValidity::Valid);
      TAUTLINE_CHECK(verdict(0.5 + side * 0.2501) == ElementValidity::Invalid);
    }
  }
}

/// A quarter of an annulus, x = r(u) p(v) with a parabola p and the radius r: the determinant
/// r r' (p x p') is smallest at the inner side.
TAUTLINE_PART(testQuarterAnnulus)
{
  const double half = std::sqrt(0.5), inner = 0.1, outer = 1;
  const Vec3 arc[3] = { { 1, 0, 0 }, { half, half, 0 }, { 0, 1, 0 } };
  // p x p' is 4 half - 1 at both ends and 2 half in the middle.
  const double least = inner * (outer - inner) * 2 * half;
  for (const ElementType* type : { &ElementType::ofVtk(VTK_BIQUADRATIC_QUAD, 9),
         &ElementType::ofVtk(VTK_TRIQUADRATIC_HEXAHEDRON, 27) })
  {
    std::vector<Vec3> points = type->coordinates();
    for (Vec3& p : points)
    {
      const double r = inner + p[0] * (outer - inner);
      const Vec3& a = arc[static_cast<int>(2 * p[1])];
      p = { r * a[0], r * a[1], p[2] };
    }
    MinimumTolerance tolerance;
    tolerance.relative = 1e-8;
    const JacobianBound bound = boundOf(*type, points, tolerance);
    TAUTLINE_CHECK(bound.validity == ElementValidity::Valid);
    TAUTLINE_CHECK_NEAR(bound.lower, least, 1e-7);
    TAUTLINE_CHECK_NEAR(bound.upper, least, 1e-7);
    TAUTLINE_CHECK_NEAR(bound.at[0], 0.0, 1e-12);
  }
}

TAUTLINE_PART(testRandomPlane)
{
  testRandom(VTK_TRIANGLE, 3, 0.6, 60);
  testRandom(VTK_QUADRATIC_TRIANGLE, 6, 0.15, 60);
  testRandom(VTK_BIQUADRATIC_TRIANGLE, 7, 0.12, 60);
  testRandom(VTK_LAGRANGE_TRIANGLE, 15, 0.05, 60);
  testRandom(VTK_QUAD, 4, 0.5, 60);
  testRandom(VTK_QUADRATIC_QUAD, 8, 0.2, 60);
  testRandom(VTK_BIQUADRATIC_QUAD, 9, 0.15, 60);
  testRandom(VTK_LAGRANGE_QUADRILATERAL, 16, 0.08, 60);
  testRandom(VTK_BEZIER_QUADRILATERAL, 16, 0.2, 60);
  testRandom(
    ElementType::ofVtk(VTK_LAGRANGE_QUADRILATERAL, 15, { 4, 2, 0 }), 0.07, 60, "orders 4, 2");
}

TAUTLINE_PART(testRandomSolid)
{
  testRandom(VTK_QUADRATIC_TETRA, 10, 0.12, 40);
  testRandom(VTK_LAGRANGE_TETRAHEDRON, 15, 0.07, 30);
  testRandom(VTK_LAGRANGE_TETRAHEDRON, 20, 0.05, 30);
  testRandom(VTK_LAGRANGE_TETRAHEDRON, 35, 0.025, 15);
  testRandom(VTK_HEXAHEDRON, 8, 0.5, 40);
  testRandom(VTK_QUADRATIC_HEXAHEDRON, 20, 0.18, 30);
  testRandom(VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON, 24, 0.17, 30);
  testRandom(VTK_TRIQUADRATIC_HEXAHEDRON, 27, 0.12, 30);
  testRandom(VTK_QUADRATIC_WEDGE, 15, 0.18, 30);
  testRandom(VTK_BIQUADRATIC_QUADRATIC_WEDGE, 18, 0.1, 30);
  testRandom(VTK_LAGRANGE_WEDGE, 21, 0.08, 30);
  testRandom(VTK_PYRAMID, 5, 0.45, 40);
  testRandom(VTK_QUADRATIC_PYRAMID, 13, 0.08, 30);
  testRandom(VTK_TRIQUADRATIC_PYRAMID, 19, 0.06, 30);
  testRandom(
    ElementType::ofVtk(VTK_LAGRANGE_HEXAHEDRON, 24, { 3, 2, 1 }), 0.08, 30, "orders 3, 2, 1");
  testRandom(ElementType::ofVtk(VTK_LAGRANGE_WEDGE, 30, { 3, 3, 2 }), 0.06, 30, "orders 3, 3, 2");
  std::vector<Vec3> nodes = ElementType::ofVtk(VTK_QUADRATIC_PYRAMID, 13).coordinates();
  nodes.push_back({ 0.5, 0.5, 0 });
  testRandom(ElementType(ElementShape::Pyramid, { 2, 2, 2 }, nodes), 0.1, 30, "pyramid 14");
}

/// An element of order 3, with one node moved along an axis until the element folds.
TAUTLINE_PART(testHexahedronOfOrder3)
{
  const ElementType& type = ElementType::ofVtk(VTK_LAGRANGE_HEXAHEDRON, 64);
  const std::vector<Vec3> places = placesOf(type, 4);
  int invalid = 0;
  for (double by : { 0.01, 0.05, 0.1, 0.2 })
  {
    std::vector<Vec3> points = straightElement(type);
    points[63][1] += by;
    points[8][2] += by;
    MinimumTolerance tolerance;
    tolerance.relative = 1e-6;
    const JacobianBound bound = boundOf(type, points, tolerance);
    checkElement(type, points, places, bound);
    invalid += bound.validity == ElementValidity::Invalid;
  }
  TAUTLINE_CHECK(invalid > 0 && invalid < 4);
}

/// The same verdicts and minima as of the linear cells.
TAUTLINE_PART(testAgainstLinear)
{
  const ElementType& type = ElementType::ofVtk(VTK_HEXAHEDRON, 8);
  const CellTopology& t = topology(CellType::Hexahedron);
  SplitMix random(3, 1, 8);
  JacobianCertifier certifier(type);
  MinimumTolerance tolerance;
  tolerance.relative = 1e-9;
  for (int n = 0; n < 500; ++n)
  {
    const std::vector<Vec3> points = randomElement(type, 0.45, random);
    const ElementSet set = setOf({ points });
    const JacobianMinimum expected = minimumJacobian(t, points.data());
    const JacobianBound bound = certifier.minimum(set.coordinates(), set.elements[0], tolerance);
    TAUTLINE_CHECK_NEAR(bound.upper, expected.value, 1e-8);
    TAUTLINE_CHECK(bound.lower <= expected.value + 1e-14);
    TAUTLINE_CHECK((bound.validity == ElementValidity::Valid) == (expected.value > 0));
  }
}

/// The verdict does not depend on the place and the unit of the element.
TAUTLINE_PART(testPlaceAndUnit)
{
  const ElementType& type = ElementType::ofVtk(VTK_TRIQUADRATIC_HEXAHEDRON, 27);
  SplitMix random(5, 1, 27);
  JacobianCertifier certifier(type);
  for (int n = 0; n < 40; ++n)
  {
    const std::vector<Vec3> points = randomElement(type, 0.12, random);
    std::vector<Vec3> moved = points;
    for (Vec3& p : moved)
    {
      p += Vec3{ 1e3, -2e3, 5e2 };
    }
    const ElementSet set = setOf({ points, moved, scaled(points, 0x1p-900), scaled(points, 0x1p900),
      scaled(points, 1e-30), scaled(points, 1e30) });
    const std::vector<ElementValidity> validity = classify(certifier, set);
    TAUTLINE_EACH_OF(ElementValidity v, validity, TAUTLINE_CHECK(v == validity[0]));
    const JacobianBound bound = certifier.minimum(set.coordinates(), set.elements[0]);
    const JacobianBound small = certifier.minimum(set.coordinates(), set.elements[4]);
    TAUTLINE_CHECK_NEAR(1e90 * small.upper, bound.upper, 1e-12);
  }
}

TAUTLINE_PART(testBadNumbers)
{
  const double infinity = std::numeric_limits<double>::infinity();
  for (const auto& [vtkType, nodes] : { std::pair<int, int>{ VTK_QUADRATIC_TETRA, 10 },
         { VTK_BIQUADRATIC_QUAD, 9 }, { VTK_LAGRANGE_WEDGE, 40 } })
  {
    const ElementType& type = ElementType::ofVtk(vtkType, nodes);
    const Vec3 none = { 0, 0, 0 };
    for (double bad : { infinity, -infinity, std::nan("") })
    {
      for (int node = 0; node < nodes; ++node)
      {
        for (const Vec3& normal : { zAxis, none })
        {
          std::vector<Vec3> points = straightElement(type);
          points[node][node % 2] = bad;
          const JacobianBound bound = boundOf(type, points, {}, normal);
          TAUTLINE_CHECK(bound.validity == ElementValidity::NonFinite);
          TAUTLINE_CHECK(std::isnan(bound.lower) && std::isnan(bound.upper));
        }
      }
    }
    // All nodes in one place, and on a line.
    std::vector<Vec3> points(nodes, Vec3{ 1, 2, 3 });
    TAUTLINE_CHECK(boundOf(type, points).validity == ElementValidity::Degenerate);
    TAUTLINE_CHECK(boundOf(type, points, {}, none).validity == ElementValidity::Degenerate);
    for (int k = 0; k < nodes; ++k)
    {
      points[k] = { static_cast<double>(k * k % 7), 0, 0 };
    }
    TAUTLINE_CHECK(boundOf(type, points).validity == ElementValidity::Degenerate);
  }
}

/// A flat element of a large aspect ratio is valid, though rounding errors scale with its length.
TAUTLINE_PART(testStretched)
{
  const ElementType& type = ElementType::ofVtk(VTK_QUADRATIC_TETRA, 10);
  for (double height : { 1e-3, 1e-6, 1e-9 })
  {
    std::vector<Vec3> points = straightElement(type);
    for (Vec3& p : points)
    {
      p[2] *= height;
    }
    TAUTLINE_CHECK(validityOf(type, points) == ElementValidity::Valid);
    points[4][2] -= 0.2 * height;
    TAUTLINE_CHECK(validityOf(type, points) == ElementValidity::Valid);
    points[7][2] += 0.3 * height;
    TAUTLINE_CHECK(validityOf(type, points) == ElementValidity::Invalid);
  }
}

TAUTLINE_PART(testMirrored)
{
  for (const auto& [vtkType, nodes] :
    { std::pair<int, int>{ VTK_BIQUADRATIC_QUADRATIC_WEDGE, 18 }, { VTK_QUADRATIC_TRIANGLE, 6 } })
  {
    const ElementType& type = ElementType::ofVtk(vtkType, nodes);
    const std::vector<Vec3> points = straightElement(type);
    std::vector<Vec3> mirrored = points;
    for (Vec3& p : mirrored)
    {
      p[1] = -p[1];
    }
    TAUTLINE_CHECK(validityOf(type, points) == ElementValidity::Valid);
    TAUTLINE_CHECK(validityOf(type, mirrored) == ElementValidity::Invalid);
    TAUTLINE_CHECK(boundOf(type, mirrored, {}, zAxis, true).validity == ElementValidity::Valid);
    TAUTLINE_CHECK(boundOf(type, points, {}, zAxis, true).validity == ElementValidity::Invalid);
    // The majority decides.
    const ElementSet set = setOf({ points, mirrored, mirrored });
    const ElementOrientation orientation =
      orientationOf(type, set.coordinates(), set.elements.data(), set.count(), zAxis);
    TAUTLINE_CHECK_EQUAL(orientation.positive, 1);
    TAUTLINE_CHECK_EQUAL(orientation.negative, 2);
    TAUTLINE_CHECK(orientation.mirrored());
    TAUTLINE_CHECK(
      !orientationOf(type, set.coordinates(), set.elements.data(), 2, zAxis).mirrored());
  }
}

/// An element of the plane has the same verdict in any plane, and without a normal where most of it
/// is on one side.
TAUTLINE_PART(testPlanes)
{
  const ElementType& type = ElementType::ofVtk(VTK_BIQUADRATIC_QUAD, 9);
  const Vec3 e1 = { 0.36, 0.48, -0.8 }, e2 = { 0.8, -0.6, 0 };
  SplitMix random(11, 1, 9);
  int invalid = 0;
  for (int n = 0; n < 100; ++n)
  {
    const std::vector<Vec3> points = randomElement(type, 0.15, random);
    std::vector<Vec3> turned = points;
    for (Vec3& p : turned)
    {
      p = p[0] * e1 + p[1] * e2;
    }
    const JacobianBound bound = boundOf(type, points);
    const JacobianBound inPlane = boundOf(type, turned, {}, cross(e1, e2));
    const JacobianBound inSpace = boundOf(type, turned, {}, { 0, 0, 0 });
    TAUTLINE_CHECK(inPlane.validity == bound.validity);
    TAUTLINE_CHECK(inSpace.validity == bound.validity);
    TAUTLINE_CHECK_NEAR(inPlane.upper, bound.upper, 1e-13);
    TAUTLINE_CHECK_NEAR(inSpace.upper, bound.upper, 1e-13);
    invalid += bound.validity == ElementValidity::Invalid;
  }
  TAUTLINE_CHECK(invalid > 2 && invalid < 90);
}

/// A strip over a parabola that turns by more than a right angle from its mean is valid: its normal
/// does not vanish. Where the parabola runs back on itself, it does.
TAUTLINE_PART(testSurfaces)
{
  const ElementType& type = ElementType::ofVtk(VTK_BIQUADRATIC_QUAD, 9);
  const auto strip = [&](const Vec3& begin, const Vec3& end)
  {
    std::vector<Vec3> points = type.coordinates();
    for (Vec3& p : points)
    {
      const double s = p[0];
      p = Vec3{ 0, p[1], 0 } + s * begin + (0.5 * s * s) * (end - begin);
    }
    return points;
  };
  const Vec3 none = { 0, 0, 0 };
  const JacobianBound gentle = boundOf(type, strip({ 1, 0, 0.5 }, { 1, 0, -0.5 }), {}, none);
  TAUTLINE_CHECK(gentle.validity == ElementValidity::Valid);
  TAUTLINE_CHECK_NEAR(gentle.upper, 1.0, 1e-12);
  const JacobianBound turning = boundOf(type, strip({ 0.1, 0, 1 }, { 1, 0, -3 }), {}, none);
  TAUTLINE_CHECK(turning.validity == ElementValidity::Valid);
  TAUTLINE_CHECK(turning.upper < 0);
  const JacobianBound folded = boundOf(type, strip({ 1, 0, 0 }, { -0.5, 0, 0 }), {}, none);
  TAUTLINE_CHECK(folded.validity == ElementValidity::Invalid);
}

/// A search ends early where the minimum is known to be above a level.
TAUTLINE_PART(testLevel)
{
  const ElementType& type = ElementType::ofVtk(VTK_TRIQUADRATIC_HEXAHEDRON, 27);
  SplitMix random(13, 1, 27);
  const ElementSet set = setOf({ randomElement(type, 0.08, random) });
  MinimumTolerance exact, coarse;
  exact.relative = coarse.relative = 1e-9;
  JacobianCertifier first(type), second(type);
  const JacobianBound fine = first.minimum(set.coordinates(), set.elements[0], exact);
  coarse.level = 0.5 * fine.lower;
  const JacobianBound rough = second.minimum(set.coordinates(), set.elements[0], coarse);
  TAUTLINE_CHECK(fine.lower > 0 && rough.lower > coarse.level && rough.lower <= fine.lower);
  TAUTLINE_CHECK(rough.upper >= fine.upper);
  TAUTLINE_CHECK(second.counts().splits < first.counts().splits);
}
