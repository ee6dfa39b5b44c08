// SPDX-License-Identifier: BSD-3-Clause
// Mesh deformation: what is rejected and how, what is reported, and how it is stopped.

#include "Registry.h"
#include "Warping.h"

using namespace tautline;

namespace
{
const Field nowhere = [](const Vec3&) { return Vec3{ 0, 0, 0 }; };

/// The classes of all methods, written out: a class must not depend on the order of the numbers.
TAUTLINE_PART(testMethodClasses)
{
  struct Expected
  {
    WarpMethod method;
    bool anisotropic, untangles;
  };
  const Expected expected[] = { { WarpMethod::Hybrid, true, true },
    { WarpMethod::Femwarp, false, false }, { WarpMethod::AnisotropicFemwarp, true, false },
    { WarpMethod::SmallStepFemwarp, false, false }, { WarpMethod::FemwarpUntangling, false, true },
    { WarpMethod::IterativeStiffening, false, false },
    { WarpMethod::JacobianStiffening, false, false }, { WarpMethod::Biharmonic, false, false },
    { WarpMethod::InverseDistance, false, false }, { WarpMethod::RadialBasis, false, false },
    { WarpMethod::WeightedLaplacian, false, false },
    { WarpMethod::InverseDistanceRotations, false, false },
    { WarpMethod::Automatic, false, true } };
  const int count = int(std::size(expected));
  for (int number = 0; number < count; ++number)
  {
    const Expected& e = expected[number];
    TAUTLINE_CHECK_EQUAL(int(e.method), number);
    TAUTLINE_CHECK(isKnown(e.method));
    TAUTLINE_CHECK_EQUAL(isAnisotropic(e.method), e.anisotropic);
    TAUTLINE_CHECK_EQUAL(untangles(e.method), e.untangles);
  }
  // The choice 4 of the coefficients exists in the filter, not in the kernel.
  const std::set<int> coefficients = { 0, 1, 2, 3, 5 };
  for (int number = -2; number < 2 * count; ++number)
  {
    TAUTLINE_CHECK_EQUAL(isKnown(WarpMethod(number)), number >= 0 && number < count);
    TAUTLINE_CHECK_EQUAL(isKnown(WarpCoefficients(number)), coefficients.count(number) == 1);
  }
}

TAUTLINE_PART(testRejected)
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const MeshData data = boxInBox(CellType::Triangle, 8, 2);
  const WarpOptions options = withMethod(WarpMethod::Hybrid);
  TAUTLINE_CHECK_THROWS(warped(data, TAUTLINE_PLACE(p[0] == 0 ? nan : 0.0, 0, 0), options),
    wording("displacements-of-9-prescribed-points-are-nan"));
  // They are not read for points that are not prescribed.
  const std::vector<char> boundary = Mesh(data.view()).boundary().isBoundaryPoint;
  auto d = collect<double>(data.points.size(),
    [&](std::size_t i) { return boundary[i / 3] ? (i % 3 == 0 ? 0.25 : 0.0) : nan; });
  const Mesh mesh(data.view());
  for (int method = 0; method <= int(WarpMethod::Automatic); ++method)
  {
    const WarpResult result = Warper(mesh, withMethod(WarpMethod(method))).warp(d.data());
    MeshData expected = data;
    expected.transform([](const Vec3& p) { return p + Vec3{ 0.25, 0, 0 }; });
    TAUTLINE_CHECK_NEAR(distance(result.points, expected.points), 0, 1e-12);
  }
  TAUTLINE_CHECK_THROWS(warped(
                          data,
                          [](const Vec3&) {
                            return Vec3{ 0, 0, 0.1 };
                          },
                          options),
    wording("out-of-its-plane"));

  std::vector<unsigned char> none(data.numberOfPoints(), 0);
  TAUTLINE_LET(WarpOptions, unprescribed, prescribed = none.data());
  TAUTLINE_CHECK_THROWS(warped(data, nowhere, unprescribed), wording("no-point-of-the-mesh-has-a"));

  MeshData tangled = data;
  const Index inner = std::find(boundary.begin(), boundary.end(), 0) - boundary.begin();
  tangled.setPoint(inner, { 5, 5, 0 });
  TAUTLINE_CHECK_THROWS(
    warped(tangled, nowhere, options), wording("inverted-or-degenerate-before-anything-moves"));
  TAUTLINE_LET(MeshData, points, addPoint({ 0, 0, 0 }), addCell(1, { 0 }));
  TAUTLINE_CHECK_THROWS(warped(points, nowhere, options), wording("no-cells-that-can-be-warped"));

  for (const CellType type : { CellType::Wedge, CellType::Pyramid })
  {
    const MeshData block = blockMesh(type, 3, 3, 3);
    for (int method = 0; method <= int(WarpMethod::Automatic); ++method)
    {
      const WarpResult result = warped(
        block, [](const Vec3& p) { return 0.1 * p; }, withMethod(WarpMethod(method)));
      TAUTLINE_CHECK_EQUAL(result.invertedAfter, 0);
    }
  }

  const auto rejected = [&](const auto& change, const std::string& text)
  {
    WarpOptions wrong;
    change(wrong);
    TAUTLINE_CHECK_THROWS(warped(data, nowhere, wrong), text);
  };
  rejected([](WarpOptions& o) { o.method = WarpMethod(13); }, "Unknown method");
  rejected([](WarpOptions& o) { o.coefficients = WarpCoefficients(4); }, "Unknown choice");
  rejected([](WarpOptions& o) { o.steps = -1; }, "number of steps");
  rejected([](WarpOptions& o) { o.maximumSteps = 0; }, "number of steps");
  rejected([](WarpOptions& o) { o.tolerance = 0; }, "tolerance");
  rejected([](WarpOptions& o) { o.poissonRatio = 0.5; }, "Poisson");
  rejected([](WarpOptions& o) { o.stiffeningFactor = 1; }, "stiffening");
  rejected([](WarpOptions& o) { o.untanglingBeta = -1; }, "Beta");
  rejected([](WarpOptions& o) { o.maximumSeconds = -1; }, "time limit");
  rejected(
    [](WarpOptions& o) { o.coefficients = WarpCoefficients::PerCell; }, "Coefficients per cell");
  for (const SymmetricTensor& t :
    { SymmetricTensor{ -1, 1, 1, 0, 0, 0 }, SymmetricTensor{ 1, 1, 1, 2, 0, 0 },
      SymmetricTensor{ 0, 0, 0, 0, 0, 0 }, SymmetricTensor{ nan, 1, 1, 0, 0, 0 } })
  {
    rejected([&](WarpOptions& o)
      { TAUTLINE_SET(o, coefficients = WarpCoefficients::Manual, tensor = t); },
      "positive semidefinite");
  }
  std::vector<double> tensors(6 * data.numberOfCells(), 1.0);
  tensors[6 * 7 + 3] = 3;
  rejected([&](WarpOptions& o)
    { TAUTLINE_SET(o, coefficients = WarpCoefficients::PerCell, tensors = tensors.data()); },
    "The coefficients of cell 7");
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testParts)
{
  // No interior: two triangles; the boundary moves as prescribed.
  const MeshData square = blockMesh(CellType::Triangle, 1, 1, 0);
  const auto stretch = TAUTLINE_PLACE(p[0], 0, 0);
  for (int method = 0; method <= int(WarpMethod::Automatic); ++method)
  {
    const WarpResult result = warped(square, stretch, withMethod(WarpMethod(method)));
    TAUTLINE_CHECK_EQUAL(result.points[3], 2.0);
    TAUTLINE_CHECK_EQUAL(result.invertedAfter, 0);
    TAUTLINE_CHECK(contains(result.message, wording("no-points-between-the-prescribed-ones")));
  }

  // Three parts and a point of no cell: one moves, one is held, one has no prescribed point.
  const MeshData one = perturbedBlock(CellType::Triangle, 5, 0.2);
  MeshData three;
  for (int part = 0; part < 3; ++part)
  {
    const Index first = three.numberOfPoints();
    for (Index i = 0; i < one.numberOfPoints(); ++i)
    {
      three.addPoint(one.point(i) + Vec3{ 10.0 * part, 0, 0 });
    }
    for (Index c = 0; c < one.numberOfCells(); ++c)
    {
      three.addCell(CellType::Triangle,
        std::vector<Index>{ first + one.connectivity[3 * c], first + one.connectivity[3 * c + 1],
          first + one.connectivity[3 * c + 2] });
    }
  }
  three.addPoint({ 100, 0, 0 });
  const std::vector<char> boundary = Mesh(three.view()).boundary().isBoundaryPoint;
  std::vector<unsigned char> prescribed(boundary.begin(), boundary.end());
  for (Index i = 2 * one.numberOfPoints(); i < three.numberOfPoints(); ++i)
  {
    prescribed[i] = 0;
  }
  // The others take the prescribed points of all parts.
  const std::set<WarpMethod> bySystem = { WarpMethod::Hybrid, WarpMethod::Femwarp,
    WarpMethod::AnisotropicFemwarp, WarpMethod::SmallStepFemwarp, WarpMethod::FemwarpUntangling,
    WarpMethod::IterativeStiffening, WarpMethod::JacobianStiffening, WarpMethod::Biharmonic };
  for (int method = 0; method <= int(WarpMethod::Automatic); ++method)
  {
    const Context context("method " + std::to_string(method));
    WarpOptions options = withMethod(WarpMethod(method));
    options.prescribed = prescribed.data();
    const auto motion = [](const Vec3& p) {
      return p[0] < 8 ? Vec3{ 0.05 * p[1] * p[1], 0.3 * std::sin(p[0]), 0 } : Vec3{ 0, 0, 0 };
    };
    const WarpResult result = warped(three, motion, options);
    const std::size_t own = 3 * std::size_t(one.numberOfPoints());
    TAUTLINE_CHECK(std::equal(
      result.points.begin() + Index(own), result.points.end(), three.points.begin() + Index(own)));
    TAUTLINE_CHECK(distance(result.points, three.points) > 0.2);
    TAUTLINE_CHECK(contains(result.message, wording("without-a-prescribed-point-1-part-of")));
    // The part that moves does not depend on the others.
    const WarpResult alone = warped(one, motion, withMethod(WarpMethod(method)));
    double worst = 0;
    for (std::size_t i = 0; i < own && bySystem.count(WarpMethod(method)); ++i)
    {
      worst = std::max(worst, std::abs(alone.points[i] - result.points[i]));
    }
    // The hybrid algorithm weighs its objectives by the whole mesh.
    TAUTLINE_CHECK_NEAR(worst, 0, method == int(WarpMethod::Hybrid) ? 1e-3 : 1e-12);
  }
}

//------------------------------------------------------------------------------
/// Boundaries that no mesh can follow.
TAUTLINE_PART(testImpossible)
{
  for (const CellType type : { CellType::Triangle, CellType::Tetrahedron })
  {
    const bool flat = type == CellType::Triangle;
    const MeshData data = boxInBox(type, flat ? 10 : 8, flat ? 4 : 4);
    // The inner box goes through the outer one.
    const auto through = [&](const Vec3& p) {
      return onInnerBox(p, flat) ? Vec3{ 0.43, 0.01, flat ? 0.0 : 0.02 } : Vec3{ 0, 0, 0 };
    };
    for (const WarpMethod method :
      { WarpMethod::Hybrid, WarpMethod::Femwarp, WarpMethod::FemwarpUntangling })
    {
      const WarpResult result = warped(data, through, withMethod(method));
      TAUTLINE_CHECK(result.crossings > 0);
      TAUTLINE_CHECK(contains(result.message, wording("the-moved-boundary-intersects-itself")));
      TAUTLINE_CHECK(result.invertedAfter > 0);
      TAUTLINE_CHECK_EQUAL(result.invertedAfter, invalid(data, result.points));
      TAUTLINE_CHECK_EQUAL(result.amount, 1.0);
      TAUTLINE_CHECK(result.invertedAfter <= result.history[0].inverted);
    }
    // In steps it goes as far as there is a mesh.
    TAUTLINE_LET(WarpOptions, options, steps = 0);
    const WarpResult part = warped(data, through, options);
    TAUTLINE_CHECK_EQUAL(part.invertedAfter, 0);
    TAUTLINE_CHECK_EQUAL(invalid(data, part.points), 0);
    TAUTLINE_CHECK(part.amount > 0.4 && part.amount < 0.3 / 0.43);
    TAUTLINE_CHECK_EQUAL(part.crossings, 0);
    TAUTLINE_CHECK(warped(data, nowhere, WarpOptions()).crossings == 0);
  }

  // An element of prescribed points alone, turned over.
  const MeshData square = blockMesh(CellType::Triangle, 1, 1, 0);
  const WarpResult flipped = warped(
    square,
    [](const Vec3& p) {
      return p[0] + p[1] == 2 ? Vec3{ -1.5, -1.5, 0 } : Vec3{ 0, 0, 0 };
    },
    WarpOptions());
  TAUTLINE_CHECK_EQUAL(flipped.impossible, flipped.invertedAfter);
  TAUTLINE_CHECK(flipped.impossible > 0);
  TAUTLINE_CHECK(contains(flipped.message, wording("all-of-whose-points-are-prescribed-the")));
  TAUTLINE_CHECK_EQUAL(flipped.points.size(), square.points.size());

  // Valid elements, but two arms that overlap: a ring, cut open and bent into itself.
  MeshData ring = blockMesh(CellType::Quadrilateral, 40, 3, 0);
  const auto bent = [](const Vec3& p, double turn)
  {
    const double angle = turn * p[0] / 40, radius = 10 + p[1];
    return Vec3{ radius * std::sin(angle), radius * std::cos(angle), 0 };
  };
  ring.transform([&](const Vec3& p) { return bent(p, 5.5); });
  const auto closing = [&](const Vec3& p)
  {
    const double angle = std::atan2(p[0], p[1]);
    const double along = 40 * (angle < -0.1 ? angle + 2 * std::acos(-1.0) : angle) / 5.5;
    return bent({ along, std::hypot(p[0], p[1]) - 10, 0 }, 6.6) - p;
  };
  const WarpResult overlapping = warped(ring, closing, withMethod(WarpMethod::Femwarp));
  TAUTLINE_CHECK_EQUAL(overlapping.invertedAfter, 0);
  TAUTLINE_CHECK(overlapping.crossings > 0);
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testStopping)
{
  const MeshData data = boxInBox(CellType::Tetrahedron, 9, 3);
  for (int method = 0; method <= int(WarpMethod::Automatic); ++method)
  {
    const Context context("method " + std::to_string(method));
    for (const int after : { 0, 1, 3 })
    {
      WarpOptions options = withMethod(WarpMethod(method));
      int calls = 0;
      double last = 0;
      options.progress = [&](double fraction)
      {
        TAUTLINE_CHECK(fraction >= 0 && fraction <= 1);
        last = fraction;
        return calls++ < after;
      };
      const WarpResult result = warped(data, turnedBox(90, false), options);
      TAUTLINE_CHECK_EQUAL(result.points.size(), data.points.size());
      TAUTLINE_CHECK(std::all_of(
        result.points.begin(), result.points.end(), [](double x) { return std::isfinite(x); }));
      TAUTLINE_CHECK_EQUAL(result.aborted, calls > after);
      TAUTLINE_CHECK_EQUAL(
        result.aborted, contains(result.message, wording("stopped-on-request-2")));
    }
    WarpOptions options = TAUTLINE_CHANGED(withMethod(WarpMethod(method)), maximumSeconds = 1e-9);
    const WarpResult result = warped(data, turnedBox(90, false), options);
    TAUTLINE_CHECK(result.timeLimit);
    TAUTLINE_CHECK_EQUAL(result.points.size(), data.points.size());
    TAUTLINE_CHECK(std::all_of(
      result.points.begin(), result.points.end(), [](double x) { return std::isfinite(x); }));
  }
}
}
