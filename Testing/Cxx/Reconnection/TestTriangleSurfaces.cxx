// SPDX-License-Identifier: BSD-3-Clause
// improveTriangles() of surfaces in space, and input that is hard to take.

#include "Registry.h"
#include "Triangulating.h"

using namespace tautline;

namespace
{
using Preset = ReconnectionPreset;

/// The distance of a point from the triangles of a mesh.
double distanceFrom(const MeshData& data, const Vec3& x)
{
  double least = std::numeric_limits<double>::max();
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    Vec3 p[3];
    for (int k = 0; k < 3; ++k)
    {
      p[k] = data.point(data.connectivity[3 * c + k]);
    }
    const Vec3 n = cross(p[1] - p[0], p[2] - p[0]);
    bool inside = true;
    for (int k = 0; k < 3; ++k)
    {
      const Vec3 e = p[(k + 1) % 3] - p[k];
      inside = inside && dot(cross(e, x - p[k]), n) >= 0.0;
      const double s = std::clamp(dot(x - p[k], e) / dot(e, e), 0.0, 1.0);
      least = std::min(least, norm(x - (p[k] + s * e)));
    }
    if (inside)
    {
      least = std::min(least, std::abs(dot(x - p[0], n)) / norm(n));
    }
  }
  return least;
}

/// Whether every edge has two cells, with opposite senses.
bool isClosed(const MeshData& data)
{
  std::map<EdgeKey, int> senses;
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Index a = data.connectivity[3 * c + k], b = data.connectivity[3 * c + (k + 1) % 3];
      senses[{ std::min(a, b), std::max(a, b) }] += a < b ? 1 : 1000;
    }
  }
  return std::all_of(senses.begin(), senses.end(), [](const auto& s) { return s.second == 1001; });
}

/// The surface with points moved along its facets by up to some fraction of their stars.
MeshData slid(const MeshData& data, unsigned seed, double amount, bool onSphere)
{
  MeshData result = data;
  Random random(seed);
  const VertexCells cells = Mesh(data.view()).vertexCells();
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Index first = cells.offsets[i], count = cells.offsets[i + 1] - first;
    const Vec3 n = areaVector(result, cells.cells[first]);
    bool flat = true;
    for (Index k = 0; k < count; ++k)
    {
      const Vec3 m = areaVector(data, cells.cells[first + k]);
      flat = flat && norm(cross(m, n)) < 1e-9 * dot(m, m);
    }
    if (!flat && !onSphere)
    {
      continue;
    }
    // Towards a point of the star, so that it stays in a facet of a flat star.
    const Index c = cells.cells[first + random.integer(count)];
    const Index other = data.connectivity[3 * c + random.integer(3)];
    const double size = amount * random.uniform(0.3, 1.0);
    Vec3 x = data.point(i) + size * (data.point(other) - data.point(i));
    x = onSphere ? (1.0 / norm(x)) * x : x;
    const Vec3 before = result.point(i);
    result.setPoint(i, x);
    for (Index k = 0; k < count; ++k)
    {
      const Vec3 m = areaVector(result, cells.cells[first + k]);
      const Vec3 old = areaVector(data, cells.cells[first + k]);
      if (!(dot(m, old) > 0.02 * dot(old, old)))
      {
        result.setPoint(i, before);
        break;
      }
    }
  }
  return result;
}

double enclosedVolume(const MeshData& data)
{
  return volumeWithin(data, data.points);
}

/// Points of the sphere stay near its facets; triangles are near it and turned like it, and the
/// volume hardly changes.
TAUTLINE_PART(testSphere)
{
  const MeshData data = slid(sphereSurface(CellType::Triangle, 7), 3, 0.45, true);
  const auto turnOf = [](const MeshData& mesh)
  {
    double largest = 0.0;
    for (Index c = 0; c < mesh.numberOfCells(); ++c)
    {
      const Index* v = &mesh.connectivity[3 * c];
      const Vec3 x = mesh.point(v[0]) + mesh.point(v[1]) + mesh.point(v[2]);
      const Vec3 n = areaVector(mesh, c);
      largest = std::max(largest, std::atan2(norm(cross(n, x)), dot(n, x)) * 180.0 / Pi);
    }
    return largest;
  };
  for (Preset preset :
    { Preset::RemoveSlivers, Preset::SwapOnly, Preset::SwapAndSmooth, Preset::Aggressive })
  {
    const Context context("sphere, preset " + std::to_string(static_cast<int>(preset)));
    TriangleOptions options = triangleOptions(preset);
    options.featureAngle = 180.0; // slivers are turned anywhere
    const ReconnectionResult result = reconnect(data, options);
    const MeshData output = trianglesOf(result);
    checkTriangles(data, result);
    TAUTLINE_CHECK(isClosed(output));
    double farthest = 0.0, deviation = 0.0;
    for (Index i = 0; i < output.numberOfPoints(); ++i)
    {
      farthest = std::max(farthest, distanceFrom(data, output.point(i)));
    }
    for (Index c = 0; c < output.numberOfCells(); ++c)
    {
      const Index* v = &output.connectivity[3 * c];
      const Vec3 x = (1.0 / 3.0) * (output.point(v[0]) + output.point(v[1]) + output.point(v[2]));
      deviation = std::max(deviation, distanceFrom(data, x));
    }
    TAUTLINE_CHECK(turnOf(output) <= turnOf(data) + 20.0);
    constexpr double distance = 5e-3 * 2.0 * 1.7320508;
    TAUTLINE_CHECK(farthest <= 0.5 * distance * (1 + 1e-9));
    TAUTLINE_CHECK(deviation <= distance);
    TAUTLINE_CHECK(std::abs(enclosedVolume(output) / enclosedVolume(data) - 1.0) < 1e-2);
    TAUTLINE_CHECK(preset != Preset::SwapOnly || output.points == data.points);
    TAUTLINE_CHECK(smallestAngle(data) < 6.0);
    TAUTLINE_CHECK(
      result.history.back().smallestAngle > (preset == Preset::SwapOnly           ? 12.0
                                                : preset == Preset::SwapAndSmooth ? 29.0
                                                : preset == Preset::Aggressive    ? 40.0
                                                                                  : 15.0));
  }
}

/// Then best shape on the sphere: points stay near the facets, the mean improves, and the worst is
/// held.
TAUTLINE_PART(testMean)
{
  const MeshData data = slid(sphereSurface(CellType::Triangle, 7), 3, 0.45, true);
  TriangleOptions options = triangleOptions(Preset::Aggressive);
  options.featureAngle = 180.0;
  const ReconnectionResult plain = reconnect(data, options);
  options.improveMean = true;
  const ReconnectionResult result = reconnect(data, options);
  const MeshData output = trianglesOf(result);
  checkTriangles(data, result);
  TAUTLINE_CHECK(isClosed(output));
  double farthest = largestOf<double>(
    0.0, output.numberOfPoints(), [&](Index i) { return distanceFrom(data, output.point(i)); });
  TAUTLINE_CHECK(farthest <= 0.5 * 5e-3 * 2.0 * std::sqrt(3.0) * (1 + 1e-9));
  const auto excess = [](const ReconnectionResult& r)
  {
    return sumOf<double>(0.0, valuesOf(trianglesOf(r), Metric::InverseMeanRatio),
      [&](double imr) { return imr - 1.0; });
  };
  TAUTLINE_CHECK(excess(result) < 0.9 * excess(plain));
  const ReconnectionRecord &last = result.history.back(), &before = plain.history.back();
  TAUTLINE_CHECK(last.smallestAngle >= before.smallestAngle * (1.0 - 1e-12));
  TAUTLINE_CHECK(last.worstInverseMeanRatio <= before.worstInverseMeanRatio * (1.0 + 1e-12));
}

/// The volume of a closed surface is kept where that is asked for; flat faces stay flat.
TAUTLINE_PART(testKeepVolume)
{
  const MeshData ball = slid(sphereSurface(CellType::Triangle, 7), 3, 0.45, true);
  TriangleOptions options = triangleOptions(Preset::Aggressive);
  options.featureAngle = 180.0;
  const ReconnectionResult plain = reconnect(ball, options);
  TAUTLINE_CHECK(std::abs(enclosedVolume(trianglesOf(plain)) / enclosedVolume(ball) - 1.0) > 1e-3);
  TAUTLINE_CHECK_EQUAL(plain.volumeBefore, 0.0);
  options.keepVolume = true;
  for (const double sense : { 1.0, -1.0 })
  {
    MeshData data = ball;
    for (Index c = 0; sense < 0 && c < data.numberOfCells(); ++c)
    {
      std::swap(data.connectivity[3 * c], data.connectivity[3 * c + 1]);
    }
    const ReconnectionResult result = reconnect(data, options);
    const MeshData output = trianglesOf(result);
    checkTriangles(data, result);
    TAUTLINE_CHECK_RELATIVE(enclosedVolume(output), enclosedVolume(data), 1e-5);
    TAUTLINE_CHECK_RELATIVE(result.volumeBefore, enclosedVolume(data), 1e-12);
    TAUTLINE_CHECK_RELATIVE(result.volumeAfter, enclosedVolume(output), 1e-12);
    TAUTLINE_CHECK(result.history.back().smallestAngle > 0.95 * plain.history.back().smallestAngle);
  }
  MeshData open = ball;
  open.offsets.pop_back();
  open.types.pop_back();
  open.connectivity.resize(open.connectivity.size() - 3);
  TAUTLINE_CHECK_THROWS(reconnect(open, options), wording("closed-surface-only"));
  const MeshData cube = slid(cubeSurface(CellType::Triangle, 6), 5, 0.9, false);
  const MeshData output =
    trianglesOf(reconnect(cube, options = TAUTLINE_CHANGED(options, featureAngle = 40.0)));
  TAUTLINE_CHECK_RELATIVE(areaOf(output), 6.0, 1e-12);
}

/// A cube keeps its edges and corners; its faces are flat, so that area and volume stay.
TAUTLINE_PART(testCube)
{
  const MeshData data = slid(cubeSurface(CellType::Triangle, 8), 5, 0.95, false);
  for (auto boundary : { BoundaryMotion::Fixed, BoundaryMotion::FlatParts })
  {
    TriangleOptions options = triangleOptions(Preset::Aggressive);
    options.boundary = boundary;
    const ReconnectionResult result = reconnect(data, options);
    const MeshData output = trianglesOf(result);
    checkTriangles(data, result);
    TAUTLINE_CHECK(isClosed(output));
    TAUTLINE_CHECK_RELATIVE(areaOf(output), 6.0, 1e-12);
    TAUTLINE_CHECK_RELATIVE(enclosedVolume(output), 1.0, 1e-12);
    TAUTLINE_CHECK(result.history.front().smallestAngle < 6.0);
    TAUTLINE_CHECK(result.history.back().smallestAngle > 34.0);
  }
}

/// Rims of a cylinder stay when they are features, and its radius is kept within the distance.
TAUTLINE_PART(testCylinder)
{
  const MeshData data = slid(cylinderSurface(48, 14), 7, 0.9, false);
  TriangleOptions options = triangleOptions(Preset::Aggressive);
  const ReconnectionResult result = reconnect(data, options);
  const MeshData output = trianglesOf(result);
  checkTriangles(data, result);
  TAUTLINE_CHECK(isClosed(output));
  std::set<Vec3> points;
  for (Index i = 0; i < output.numberOfPoints(); ++i)
  {
    points.insert(output.point(i));
  }
  int rim = 0;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 p = data.point(i);
    if (std::abs(std::hypot(p[0], p[1]) - 1.0) < 1e-9 && (p[2] == 0.0 || p[2] == 2.0))
    {
      ++rim;
      TAUTLINE_CHECK(points.count(p) == 1);
    }
  }
  TAUTLINE_CHECK_EQUAL(rim, 96);
}

/// Two triangles whose common edge a flip would improve, folded along it.
MeshData roof(double degrees)
{
  const double turn = degrees * Pi / 180.0;
  return TAUTLINE_CHANGED(MeshData(), addPoint({ -1, 0, 0 }), addPoint({ 1, 0, 0 }),
    addPoint({ 0, 0.2, 0 }), addPoint({ 0, -0.2 * std::cos(turn), -0.2 * std::sin(turn) }),
    addCell(CellType::Triangle, { 0, 1, 2 }), addCell(CellType::Triangle, { 1, 0, 3 }));
}

/// A fold is flipped only where it is flat within the angle and the distance, and not at a feature.
TAUTLINE_PART(testFold)
{
  const auto flips = [](double fold, double angle, double distance, double feature)
  {
    TriangleOptions options = triangleOptions(Preset::SwapOnly);
    TAUTLINE_SET(
      options, surfaceAngle = angle, surfaceTolerance = distance, featureAngle = feature);
    return reconnect(roof(fold), options).history.back().edgeRemovals;
  };
  TAUTLINE_CHECK_EQUAL(flips(30, 60, 1, 40), 1);
  TAUTLINE_CHECK_EQUAL(flips(30, 5, 1, 40), 0);
  TAUTLINE_CHECK_EQUAL(flips(30, 60, 1e-3, 40), 0);
  TAUTLINE_CHECK_EQUAL(flips(30, 60, 1, 20), 0);
  TAUTLINE_CHECK_EQUAL(flips(0.1, 5, 1e-3, 40), 1);
}

/// Edges of three triangles, points where sheets touch, bands without orientation: kept.
TAUTLINE_PART(testNonManifold)
{
  // Three sheets of 6 x 6 squares that share the edges on the line y = z = 0.
  MeshData sheets;
  const MeshData sheet = sliverSheet(6, 11);
  for (int k = 0; k < 3; ++k)
  {
    const double turn = k * 2.0 * Pi / 3.0;
    std::vector<Index> ids;
    for (Index i = 0; i < sheet.numberOfPoints(); ++i)
    {
      const Vec3 p = sheet.point(i);
      ids.push_back(k > 0 && i < 7
          ? i
          : sheets.addPoint({ p[0], p[1] * std::cos(turn), p[1] * std::sin(turn) }));
    }
    for (Index c = 0; c < sheet.numberOfCells(); ++c)
    {
      const Index* v = &sheet.connectivity[3 * c];
      sheets.addCell(CellType::Triangle, { ids[v[0]], ids[v[1]], ids[v[2]] });
    }
  }
  for (auto boundary : { BoundaryMotion::Fixed, BoundaryMotion::FlatParts })
  {
    TriangleOptions options = triangleOptions(Preset::Aggressive);
    options.boundary = boundary;
    const ReconnectionResult result = reconnect(sheets, options);
    const MeshData output = trianglesOf(result);
    checkTriangles(sheets, result);
    TAUTLINE_CHECK_RELATIVE(areaOf(output), areaOf(sheets), 1e-12);
    int triple =
      sumOf<int>(0, edgesOf(output), [&](const auto& use) { return use.second.size() == 3; });
    TAUTLINE_CHECK_EQUAL(triple, 6);
  }

  // Two fans that touch at a point.
  TAUTLINE_LET(MeshData, bow, addPoint({ 0, 0, 0 }));
  for (int side : { 1, -1 })
  {
    const Index first = bow.numberOfPoints();
    TAUTLINE_SET(bow, addPoint({ side * 1.0, -0.1 * side, 0.3 }),
      addPoint({ side * 1.1, 0.0, 0.0 }), addPoint({ side * 1.0, 0.1 * side, 0.2 }),
      addCell(CellType::Triangle, { 0, first, first + 1 }),
      addCell(CellType::Triangle, { 0, first + 1, first + 2 }));
  }
  const ReconnectionResult touched = reconnect(bow, triangleOptions(Preset::Aggressive));
  checkTriangles(bow, touched);
  TAUTLINE_CHECK(trianglesOf(touched).point(0) == bow.point(0));

  // A Moebius band: one edge has both triangles in the same sense, wherever one starts.
  MeshData band;
  constexpr Index pieces = 24;
  for (Index i = 0; i < pieces; ++i)
  {
    const double t = 2.0 * Pi * i / pieces;
    for (double w : { -0.3, 0.3 })
    {
      const double r = 1.0 + w * std::cos(0.5 * t);
      band.addPoint({ r * std::cos(t), r * std::sin(t), w * std::sin(0.5 * t) });
    }
  }
  for (Index i = 0; i < pieces; ++i)
  {
    const bool last = i + 1 == pieces;
    const Index a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
    band.addCell(CellType::Triangle, { a, c, b });
    band.addCell(CellType::Triangle, { b, c, d });
  }
  const ReconnectionResult turned = reconnect(band, triangleOptions(Preset::Aggressive));
  checkTriangles(band, turned);
}

TAUTLINE_PART(testSmall)
{
  TAUTLINE_LET(MeshData, one, addPoint({ 0, 0, 0 }), addPoint({ 4, 0, 0 }), addPoint({ 1, 1, 0.5 }),
    addPoint({ 7, 7, 7 }), addCell(CellType::Triangle, { 0, 1, 2 }));
  const ReconnectionResult single = reconnect(one, triangleOptions(Preset::Aggressive));
  checkTriangles(one, single);
  TAUTLINE_CHECK(single.triangles == one.connectivity && single.points == one.points);
  // No edge of a tetrahedron's surface can be flipped or contracted.
  MeshData tetrahedron;
  tetrahedron.addPoints({ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 0.1 } });
  for (const std::vector<Index>& v :
    { std::vector<Index>{ 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 0, 3, 2 } })
  {
    tetrahedron.addCell(CellType::Triangle, v);
  }
  TriangleOptions free = triangleOptions(Preset::Aggressive);
  TAUTLINE_SET(free, featureAngle = 180.0, surfaceAngle = 90.0, surfaceTolerance = 1.0,
    smallestCount = 0.0, largestCount = 10.0);
  const ReconnectionResult closed = reconnect(tetrahedron, free);
  checkTriangles(tetrahedron, closed);
  TAUTLINE_CHECK(isClosed(trianglesOf(closed)));
  const ReconnectionResult none = reconnect(MeshData(), triangleOptions(Preset::Aggressive));
  TAUTLINE_CHECK(none.triangles.empty() && none.history.empty());
}

TAUTLINE_PART(testRejections)
{
  const TriangleOptions defaults = triangleOptions(Preset::Aggressive);
  MeshData quads = blockMesh(CellType::Quadrilateral, 2, 2, 0);
  TAUTLINE_CHECK_THROWS(reconnect(quads, defaults), wording("4-cells-are-not-triangles"));
  TAUTLINE_CHECK_THROWS(reconnect(quads, defaults), "Triangulate");
  MeshData inverted = blockMesh(CellType::Triangle, 2, 2, 0);
  inverted.setPoint(4, { 5, 1, 0 });
  TAUTLINE_CHECK_THROWS(reconnect(inverted, defaults), wording("untangle-mesh"));
  MeshData broken = blockMesh(CellType::Triangle, 2, 2, 0);
  broken.points[0] = std::numeric_limits<double>::quiet_NaN();
  TAUTLINE_CHECK_THROWS(reconnect(broken, defaults), wording("nan-or-infinite"));
  // Points that coincide within a cell, and the same triangle twice.
  MeshData twice = blockMesh(CellType::Triangle, 2, 2, 0);
  twice.setPoint(4, twice.point(1));
  TAUTLINE_CHECK_THROWS(reconnect(twice, defaults), "degenerate");
  MeshData doubled = blockMesh(CellType::Triangle, 2, 2, 0);
  doubled.addCell(CellType::Triangle, { 0, 1, 4 });
  TAUTLINE_CHECK_THROWS(reconnect(doubled, defaults), "overlapping");
  MeshData folded = cubeSurface(CellType::Triangle, 2);
  folded.setPoint(folded.connectivity[0], folded.point(folded.connectivity[1]));
  TAUTLINE_CHECK_THROWS(reconnect(folded, defaults), wording("degenerate-triangles-that-cannot"));
#define REJECTED(change, text) \
  TAUTLINE_CHECK_THROWS(reconnect(data, TAUTLINE_CHANGED(TriangleOptions(), change)), text)
  const MeshData data = blockMesh(CellType::Triangle, 2, 2, 0);
  REJECTED(featureAngle = -1, "feature angle");
  REJECTED(surfaceAngle = 91, "surface angle");
  REJECTED(surfaceTolerance = std::nan(""), "surface tolerance");
  REJECTED(targetAngle = 61, "target angle");
  // Points that coincide where cells only touch are borders.
  MeshData apart = blockMesh(CellType::Triangle, 3, 3, 0);
  const MeshData other = blockMesh(CellType::Triangle, 3, 3, 0);
  for (Index i = 0; i < other.numberOfPoints(); ++i)
  {
    apart.addPoint(other.point(i) + Vec3{ 3, 0, 0 });
  }
  for (Index c = 0; c < other.numberOfCells(); ++c)
  {
    const Index* v = &other.connectivity[3 * c];
    apart.addCell(CellType::Triangle, { 16 + v[0], 16 + v[1], 16 + v[2] });
  }
  checkTriangles(apart, reconnect(apart, defaults));
}

/// The same results for other units.
TAUTLINE_PART_SLOW(testScales)
{
  const MeshData data = slid(sphereSurface(CellType::Triangle, 8), 3, 0.8, true);
  const ReconnectionResult expected = reconnect(data, triangleOptions(Preset::Aggressive));
  for (double scale : { 0x1p-30, 0x1p30, 1e-8, 1e8 })
  {
    MeshData scaled = data;
    scaled.transform([&](Vec3 p) { return scale * p; });
    const ReconnectionResult result = reconnect(scaled, triangleOptions(Preset::Aggressive));
    checkTriangles(scaled, result);
    if (std::exp2(std::round(std::log2(scale))) == scale)
    {
      TAUTLINE_CHECK(result.triangles == expected.triangles);
    }
    TAUTLINE_CHECK(
      result.history.back().smallestAngle > 0.9 * expected.history.back().smallestAngle);
  }
}
}
