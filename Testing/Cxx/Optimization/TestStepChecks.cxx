// SPDX-License-Identifier: BSD-3-Clause
// Steps of one vertex that are shortened or rejected: before an element inverts, and where the way
// back to a surface would invert, fold, turn over or worsen the elements.
#include "Optimizing.h"
#include "Registry.h"
#include "tautline/Optimization/LocalSweep.h"
#include "tautline/Patches/SimplexMesh.h"

using namespace tautline;

namespace
{
constexpr Index Free = 0; // the point that moves

LocalTerm squaredSize()
{
  return TAUTLINE_CHANGED(LocalTerm(), sizeSquared = 1);
}

LocalTerm squaredRatio()
{
  return TAUTLINE_CHANGED(LocalTerm(), shapePower = 2);
}

/// One sweep with Newton's whole step; where the first point is then.
/// @param part what it slides on, or null
/// @param weightless a cell that does not count, or -1
Vec3 afterSweep(const MeshData& data, const LocalTerm& term, LocalOptions options,
  const SurfacePart* part = nullptr, Index weightless = -1)
{
  std::vector<unsigned char> fixed(data.numberOfPoints(), 1);
  fixed[Free] = 0;
  const Mesh mesh(data.view());
  SimplexMesh simplices(mesh, fixed.data(), nullptr, 1);
  TAUTLINE_CHECK_EQUAL(simplices.freeVertices(), 1);
  for (std::int32_t i = 0; weightless >= 0 && i < simplices.simplices(); ++i)
  {
    options.weights.push_back(simplices.cell(i) == weightless ? 0.0 : 1.0);
  }
  if (weightless >= 0)
  {
    simplices.indexPatches();
  }
  const SurfaceProjection surface(part ? *part : SurfacePart(), &simplices);
  if (part)
  {
    options.surfaces = { &surface };
  }
  std::vector<double> points = data.points;
  LocalSweeper sweeper(simplices, mesh, points.data(), { term }, options);
  constexpr double any = 1; // of one objective only changes count
  std::vector<double> values = { any };
  sweeper.sweep(Scalarizer(ScalarizationOptions(), { 1.0 }, values), values);
  simplices.store(points.data(), 1);
  return { points[0], points[1], points[2] };
}

bool isAt(const Vec3& p, const Vec3& q)
{
  return norm(p - q) < 1e-12;
}

SurfacePart curveOf(const Vec3& a, const Vec3& b)
{
  TAUTLINE_LET(SurfacePart, part, curve = true);
  part.pieces.push_back({ a, b, b });
  return part;
}

/// Two triangles over a base that is bent, or three tetrahedra over a corner: all of them vanish
/// where the base is bent, and that is where Newton's step for the sum of the squared sizes goes.
/// @param x of the free point
MeshData fan(bool flat, double x)
{
  TAUTLINE_LET(MeshData, data, addPoint({ x, flat ? 1.0 : 0.0, flat ? 0.0 : 1.0 }));
  const Index bend = data.addPoint({ 0, 0, 0 });
  if (flat)
  {
    const Index left = data.addPoint({ -1, 0.5, 0 }), right = data.addPoint({ 1, 0.5, 0 });
    data.addCell(CellType::Triangle, std::vector<Index>{ left, bend, Free });
    data.addCell(CellType::Triangle, std::vector<Index>{ bend, right, Free });
    return data;
  }
  constexpr Index around = 3;
  for (Index k = 0; k < around; ++k)
  {
    const double angle = 2 * std::acos(-1.0) * static_cast<double>(k) / around;
    data.addPoint({ std::cos(angle), std::sin(angle), 0.5 });
  }
  for (Index k = 0; k < around; ++k)
  {
    data.addCell(CellType::Tetrahedron,
      std::vector<Index>{ bend, bend + 1 + k, bend + 1 + (k + 1) % around, Free });
  }
  return data;
}

/// A step goes nine tenths of the way to where the first element vanishes, not to it.
TAUTLINE_PART(testSafety)
{
  constexpr double left = 0.1;
  for (const bool flat : { true, false })
  {
    const Context context(flat ? "triangles" : "tetrahedra");
    const MeshData data = fan(flat, 0);
    TAUTLINE_CHECK_EQUAL(invalid(data, data.points), Index(0));
    const Vec3 p = afterSweep(data, squaredSize(), LocalOptions());
    TAUTLINE_CHECK(norm(p - left * data.point(Free)) < 1e-9);
  }
}

//------------------------------------------------------------------------------
/// A curve on which triangles are inverted, and smaller: only a step that may invert goes there.
TAUTLINE_PART(testInvertedOnCurve)
{
  const MeshData data = fan(true, 0.2);
  const Vec3 start = data.point(Free);
  const SurfacePart below = curveOf({ -1, -0.2, 0 }, { 1, -0.2, 0 }),
                    above = curveOf({ -1, 0.7, 0 }, { 1, 0.7, 0 });
  LocalOptions options;
  TAUTLINE_CHECK(isAt(afterSweep(data, squaredSize(), options, &below), start));
  const Vec3 placed = afterSweep(data, squaredSize(), options, &above);
  TAUTLINE_CHECK(std::abs(placed[0]) < 0.1 && std::abs(placed[1] - 0.7) < 1e-12);
  options.allowInversion = true;
  TAUTLINE_CHECK_NEAR(afterSweep(data, squaredSize(), options, &below)[1], -0.2, 1e-12);
}

/// A curve through worse places, and one through better ones.
TAUTLINE_PART(testWorseOnCurve)
{
  TAUTLINE_LET(MeshData, data, addPoint({ 0.4, 0, 0 }));
  constexpr Index around = 6;
  for (Index k = 0; k < around; ++k)
  {
    const double angle = 2 * std::acos(-1.0) * static_cast<double>(k) / around;
    data.addPoint({ std::cos(angle), std::sin(angle), 0 });
  }
  for (Index k = 0; k < around; ++k)
  {
    data.addCell(CellType::Triangle, std::vector<Index>{ Free, 1 + k, 1 + (k + 1) % around });
  }
  const auto at = [&](double height)
  {
    const SurfacePart curve = curveOf({ -0.2, height, 0 }, { 0.2, height, 0 });
    return afterSweep(data, squaredRatio(), LocalOptions(), &curve);
  };
  TAUTLINE_CHECK(isAt(at(0.6), data.point(Free)));
  const Vec3 better = at(0.05);
  TAUTLINE_CHECK(better[0] < 0.3);
  TAUTLINE_CHECK_NEAR(better[1], 0.05, 1e-12);
}

/// Triangles that are unfolded along a curve are always positive: that they turn over is noticed in
/// space. Flat triangles, which do not count, cannot turn over.
TAUTLINE_PART(testTurnedOnCurve)
{
  TAUTLINE_LET(MeshData, data, addPoint({ -3, 0, 0 }));
  const Index low = data.addPoint({ 1, -1, 0 }), high = data.addPoint({ 1, 1, 0 });
  data.addCell(CellType::Triangle, std::vector<Index>{ Free, low, high });
  // Another plane makes it a surface in space.
  data.addCell(CellType::Triangle, std::vector<Vec3>{ { 9, 0, 0 }, { 9, 1, 0 }, { 9, 0, 1 } });
  TAUTLINE_CHECK(Mesh(data.view()).dimension() == Dimension::Surface);
  // Beyond the base the triangle would be better shaped than before.
  const SurfacePart beyond = curveOf({ 2.5, 0, 0 }, { 3.5, 0, 0 }),
                    through = curveOf({ -4, 0, 0 }, { 1, 0, 0 });
  TAUTLINE_CHECK(isAt(afterSweep(data, squaredRatio(), LocalOptions(), &beyond), data.point(Free)));
  const Vec3 moved = afterSweep(data, squaredRatio(), LocalOptions(), &through);
  TAUTLINE_CHECK(moved[0] > -2.9 && moved[0] < 1);
  const Index near = data.addPoint({ -1, 0, 0 }), far = data.addPoint({ 0, 0, 0 });
  data.addCell(CellType::Triangle, std::vector<Index>{ Free, near, far });
  const Vec3 beside =
    afterSweep(data, squaredRatio(), LocalOptions(), &through, data.numberOfCells() - 1);
  TAUTLINE_CHECK(beside[0] > -2.9 && beside[0] < 1);
}

//------------------------------------------------------------------------------
/// A small triangle around a point, in a plane with a direction.
SurfaceModel patchAt(const Vec3& p, const Vec3& along)
{
  constexpr double size = 1e-3;
  const Vec3 u = (size / norm(along)) * along;
  Vec3 w = cross(u, std::abs(u[0]) < 0.5 * size ? Vec3{ 1, 0, 0 } : Vec3{ 0, 1, 0 });
  w = (size / norm(w)) * w;
  TAUTLINE_LET(SurfaceModel, model, patches = 1);
  model.parts.resize(1);
  model.parts[0].pieces.push_back({ p - u - w, p + u - w, p + w });
  return model;
}

/// A hexahedron whose target is folded between its corners, as it would be with its corner `k` on a
/// surface: where the corner is after each iteration.
struct Corner
{
  MeshData data;
  Targets targets;
  Index k;

  /// @param place of the surface
  OptimizeResult slideTo(const Vec3& place, Index& folded) const
  {
    const SurfaceModel model = patchAt(place, place - this->data.point(this->k));
    std::vector<std::int32_t> parts(this->data.numberOfPoints(), -1);
    std::vector<unsigned char> fixed(this->data.numberOfPoints(), 1);
    parts[this->k] = 0;
    fixed[this->k] = 0;
    TAUTLINE_LET(OptimizeOptions, options, fixed = fixed.data(), model = &model,
      parts = parts.data(), holdWorst = false, objectives[0].evaluation.targets = &this->targets,
      stopping.maximumIterations = 5);
    options.observer = [&](const IterationState& state)
    {
      std::vector<double> points(this->data.points.size());
      state.points(points.data());
      folded += invalid(this->data, points);
      return true;
    };
    return run(this->data, options);
  }
};

/// An element that is valid at its corners, but folded between them, is not placed on the surface.
TAUTLINE_PART(testFoldedOnSurface)
{
  constexpr CellType type = CellType::Hexahedron;
  Random random(41);
  int cases = 0, moved = 0;
  for (int trial = 0; trial < 20000 && cases < 10; ++trial)
  {
    const std::vector<Vec3> wanted = perturbedCell(type, 0.6, random);
    const std::vector<double> sines = cornerSines(type, wanted);
    const auto k = static_cast<Index>(random.integer(topology(type).nodes));
    std::vector<Vec3> start = wanted;
    start[k] += 0.5 * (idealCell(type)[k] - start[k]);
    const MeshData data = singleCell(type, start);
    if (*std::min_element(sines.begin(), sines.end()) <= 0 ||
      validityOf(singleCell(type, wanted))[0] == Valid || validityOf(data)[0] != Valid)
    {
      continue;
    }
    ++cases;
    const MeshData goal = singleCell(type, wanted);
    const Corner corner = { data, referenceTargets(Mesh(data.view()), Mesh(goal.view())), k };
    Index folded = 0;
    corner.slideTo(wanted[k], folded);
    TAUTLINE_CHECK_EQUAL(folded, Index(0));
    // A little on the way it is valid, and taken.
    const Vec3 near = start[k] + 0.1 * (wanted[k] - start[k]);
    const OptimizeResult result = corner.slideTo(near, folded);
    TAUTLINE_CHECK_EQUAL(folded, Index(0));
    moved += norm(Vec3{ result.points[3 * k], result.points[3 * k + 1], result.points[3 * k + 2] } -
               near) < 2e-3;
  }
  std::cout << cases << " corners that would fold a hexahedron, " << moved << " move less far\n";
  TAUTLINE_CHECK_EQUAL(cases, 10);
  TAUTLINE_CHECK(moved > cases / 2);
}
}
