// SPDX-License-Identifier: BSD-3-Clause
// Optimization keeps the features of surfaces and the smooth shape between them.
#include "Optimizing.h"
#include "Registry.h"
#include "Surfaces.h"
#include "tautline/Boundary/GeometryMatch.h"
#include "tautline/Mesh/Features.h"

#include <cstring>

using namespace tautline;

namespace
{
/// Optimizes on the model of the mesh's own features.
OptimizeResult runOnFeatures(
  const MeshData& data, bool smooth = true, const FeatureOptions& features = {})
{
  const Mesh mesh(data.view());
  const Features found = findFeatures(mesh, features);
  const SurfaceModel model = makeSurfaceModel(mesh, found, smooth);
  const std::vector<std::int32_t> parts = partsOfPoints(found);
  auto fixed =
    collect<unsigned char>(found.kind, [&](signed char kind) { return kind == CornerPoint; });
  OptimizeOptions options;
  options.holdWorst = false; // elements that are all alike cannot improve otherwise
  TAUTLINE_SET(options, fixed = fixed.data(), model = &model, parts = parts.data());
  return optimize(mesh, options);
}

Vec3 at(const std::vector<double>& points, Index p)
{
  return { points[3 * p], points[3 * p + 1], points[3 * p + 2] };
}

/// How far points are from the edges, faces and corners of the cube, relative to its size.
double offCube(const MeshData& data, const std::vector<double>& points, double size)
{
  double most = 0;
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    for (int c = 0; c < 3; ++c)
    {
      const double before = data.point(p)[c];
      most = std::max(
        most, before == 0 || before == size ? std::abs(at(points, p)[c] - before) / size : 0);
    }
  }
  return most;
}

TAUTLINE_PART(testCube)
{
  for (double size : { 1.0, std::ldexp(1.0, -26), std::ldexp(1.0, 27) })
  {
    MeshData cube = cubeSurface(CellType::Triangle, 10);
    cube.transform([size](Vec3 p) { return size * p; });
    for (bool smooth : { false, true })
    {
      const OptimizeResult result = runOnFeatures(cube, smooth);
      TAUTLINE_CHECK(offCube(cube, result.points, size) < 1e-12);
      TAUTLINE_CHECK_RELATIVE(volumeWithin(cube, result.points), size * size * size, 1e-12);
      TAUTLINE_CHECK(result.history.back().objective < 0.9 * result.history.front().objective);
      // Some points of edges slide: the edges are not just fixed.
      double slid = 0;
      for (Index p = 0; p < cube.numberOfPoints(); ++p)
      {
        int ends = sumOf<int>(0, cube.point(p), [&](double x) { return x == 0 || x == size; });
        const double way = norm(at(result.points, p) - cube.point(p)) / size;
        TAUTLINE_CHECK(ends < 3 || way == 0);
        slid = ends == 2 ? std::max(slid, way) : slid;
      }
      TAUTLINE_CHECK(slid > 0.01);
    }
  }
  // Turned: no rounding takes points off their edges.
  const std::array<Vec3, 3> axes = { Vec3{ 0.36, 0.48, -0.8 }, Vec3{ -0.8, 0.6, 0 },
    Vec3{ 0.48, 0.64, 0.6 } };
  MeshData turned = cubeSurface(CellType::Triangle, 10);
  turned.transform([&](Vec3 p) { return p[0] * axes[0] + p[1] * axes[1] + p[2] * axes[2]; });
  std::vector<double> points = runOnFeatures(turned).points;
  for (Index p = 0; p < turned.numberOfPoints(); ++p)
  {
    const Vec3 x = at(points, p);
    for (int c = 0; c < 3; ++c)
    {
      points[3 * p + c] = dot(x, axes[c]);
    }
  }
  TAUTLINE_CHECK(offCube(cubeSurface(CellType::Triangle, 10), points, 1) < 1e-12);
  // As it was without features: the edges are cut.
  const MeshData cube = cubeSurface(CellType::Triangle, 10);
  TAUTLINE_LET(OptimizeOptions, free, holdWorst = false);
  const OptimizeResult cut = run(cube, free);
  TAUTLINE_CHECK(volumeWithin(cube, cut.points) < 0.997);
}

TAUTLINE_PART(testCylinder)
{
  const MeshData data = cylinderSurface(32, 8);
  const double volume = volumeWithin(data, data.points);
  TAUTLINE_CHECK(volumeWithin(data, run(data, OptimizeOptions()).points) < 0.991 * volume);
  for (bool smooth : { false, true })
  {
    const Context context(smooth ? "smooth" : "facets");
    const OptimizeResult result = runOnFeatures(data, smooth);
    const double half = std::acos(-1.0) / 32;
    double off = 0, side = 0;
    for (Index p = 0; p < data.numberOfPoints(); ++p)
    {
      const Vec3 then = data.point(p), now = at(result.points, p);
      const double radius = std::hypot(now[0], now[1]);
      if (std::abs(std::hypot(then[0], then[1]) - 1) < 1e-9)
      {
        side = std::max(side, std::abs(radius - 1));
        const bool rim = then[2] == 0 || then[2] == 2;
        // The polygon's radius at the point's angle.
        const double angle = std::atan2(now[1], now[0]) / (2 * half);
        const double polygon =
          std::cos(half) / std::cos(2 * half * (angle - std::floor(angle)) - half);
        off = std::max(
          off, rim ? std::abs(radius - (smooth ? 1 : polygon)) + std::abs(now[2] - then[2]) : 0);
      }
    }
    TAUTLINE_CHECK(off < (smooth ? 1e-7 : 1e-12));
    TAUTLINE_CHECK(side < (smooth ? 1e-6 : 1.01 * (1 - std::cos(half))));
    TAUTLINE_CHECK(volumeWithin(data, result.points) > (smooth ? 0.999 : 0.99) * volume);
  }
}

/// A sphere keeps its volume, and further runs stay on it.
TAUTLINE_PART(testSphere)
{
  for (CellType type : { CellType::Quadrilateral, CellType::Triangle })
  {
    for (int n : { 4, 8 })
    {
      MeshData data = sphereSurface(type, n);
      const double volume = volumeWithin(data, data.points);
      double first = 0;
      for (int repeat = 0; repeat < 5; ++repeat)
      {
        const OptimizeResult result = runOnFeatures(data);
        data.points = result.points;
        double off = largestOf<double>(
          0, data.numberOfPoints(), [&](Index p) { return std::abs(norm(data.point(p)) - 1); });
        first = repeat == 0 ? off : first;
        TAUTLINE_CHECK(off < (n == 4 ? 6e-4 : 1e-4));
        TAUTLINE_CHECK(off < 1.05 * first);
        TAUTLINE_CHECK(volumeWithin(data, data.points) > 0.9995 * volume);
      }
    }
  }
}

/// How far a point is from the ellipsoid with these half axes, to first order.
double offEllipsoid(const Vec3& p, const Vec3& axes)
{
  double f = -1;
  Vec3 gradient;
  for (int c = 0; c < 3; ++c)
  {
    f += p[c] * p[c] / (axes[c] * axes[c]);
    gradient[c] = 2 * p[c] / (axes[c] * axes[c]);
  }
  return std::abs(f) / norm(gradient);
}

/// An ellipsoid: runs in a row, each with a model of the last points. Twice the resolution divides
/// the distance by about eight.
TAUTLINE_PART_SLOW(testEllipsoid)
{
  const Vec3 axes = { 1, 0.7, 0.5 };
  for (CellType type : { CellType::Quadrilateral, CellType::Triangle })
  {
    double last = 1;
    const std::pair<int, double> sizes[] = { { 8, 3e-4 }, { 16, 3e-5 }, { 32, 1e-5 } };
    for (const auto& [n, allowed] : sizes)
    {
      const Context context(std::string(topology(type).name) + " " + std::to_string(n));
      MeshData data = sphereSurface(type, n);
      data.transform(TAUTLINE_PLACE(axes[0] * p[0], axes[1] * p[1], axes[2] * p[2]));
      double mean = 0, second = 0;
      const int repeats = n == 32 ? 2 : 5;
      for (int repeat = 0; repeat < repeats; ++repeat)
      {
        data.points = runOnFeatures(data).points;
        double off = 0;
        mean = 0;
        for (Index p = 0; p < data.numberOfPoints(); ++p)
        {
          const double distance = offEllipsoid(data.point(p), axes);
          off = std::max(off, distance);
          mean += distance / static_cast<double>(data.numberOfPoints());
        }
        TAUTLINE_CHECK(off < allowed);
        second = repeat == 1 ? mean : second;
      }
      TAUTLINE_CHECK(mean < 1.1 * second);
      TAUTLINE_CHECK(mean < last / (n == 32 ? 4 : 8));
      last = mean;
    }
  }
}

/// A torus whose points crowd on one side of the tube.
TAUTLINE_PART(testTorus)
{
  const double turn = 2 * std::acos(-1.0), tube = 0.4;
  for (CellType type : { CellType::Quadrilateral, CellType::Triangle })
  {
    MeshData data;
    const Index around = 48, across = 16;
    for (Index i = 0; i < around; ++i)
    {
      for (Index j = 0; j < across; ++j)
      {
        const double a = turn * static_cast<double>(i) / around;
        const double even = turn * static_cast<double>(j) / across;
        const double b = even + 0.35 * std::sin(even), r = 1 + tube * std::cos(b);
        data.addPoint({ r * std::cos(a), r * std::sin(a), tube * std::sin(b) });
      }
    }
    for (Index i = 0; i < around; ++i)
    {
      for (Index j = 0; j < across; ++j)
      {
        const Index next = (i + 1) % around * across, here = i * across, up = (j + 1) % across;
        const Index a = here + j, b = next + j, c = next + up, d = here + up;
        if (type == CellType::Quadrilateral)
        {
          data.addCell(type, std::vector<Index>{ a, b, c, d });
        }
        else
        {
          data.addCell(type, std::vector<Index>{ a, b, c });
          data.addCell(type, std::vector<Index>{ a, c, d });
        }
      }
    }
    const std::vector<double> before = data.points;
    for (int repeat = 0; repeat < 3; ++repeat)
    {
      data.points = runOnFeatures(data).points;
      double off = 0, moved = 0;
      for (Index p = 0; p < data.numberOfPoints(); ++p)
      {
        const Vec3 x = data.point(p);
        off = std::max(off, std::abs(std::hypot(std::hypot(x[0], x[1]) - 1, x[2]) - tube));
        moved = std::max(moved, norm(x - at(before, p)));
      }
      TAUTLINE_CHECK(off < 8e-6);
      TAUTLINE_CHECK(moved > 0.01);
    }
  }
}

/// The boundary of a volume mesh, and the interface of its regions.
TAUTLINE_PART(testVolume)
{
  for (CellType type : { CellType::Tetrahedron, CellType::Hexahedron })
  {
    const Context context(topology(type).name);
    MeshData data = blockMesh(type, 6, 6, 6);
    Random random(5);
    std::vector<double> regions;
    for (Index c = 0; c < data.numberOfCells(); ++c)
    {
      double x = 0;
      for (Index n = data.offsets[c]; n < data.offsets[c + 1]; ++n)
      {
        x = std::max(x, data.point(data.connectivity[n])[0]);
      }
      regions.push_back(x <= 3);
    }
    const std::vector<double> regular = data.points;
    data.transform(
      [&](Vec3 p)
      {
        for (double& x : p)
        {
          const bool moves = x > 0 && x < 6 && !(&x == &p[0] && x == 3);
          x += moves ? random.uniform(-0.2, 0.2) : 0;
        }
        return p;
      });
    TAUTLINE_CHECK_EQUAL(invalid(data, data.points), Index(0));
    TAUTLINE_LET(FeatureOptions, options, regions = regions.data());
    const OptimizeResult result = runOnFeatures(data, true, options);
    TAUTLINE_CHECK_EQUAL(result.invertedAfter, Index(0));
    double off = 0, slid = 0;
    for (Index p = 0; p < data.numberOfPoints(); ++p)
    {
      for (int c = 0; c < 3; ++c)
      {
        const double kept = regular[3 * p + c];
        const bool flush = kept == 0 || kept == 6 || (c == 0 && kept == 3);
        off = std::max(off, flush ? std::abs(result.points[3 * p + c] - kept) : 0.0);
      }
      slid =
        regular[3 * p] == 3 ? std::max(slid, norm(at(result.points, p) - data.point(p))) : slid;
    }
    TAUTLINE_CHECK(off < 1e-11);
    TAUTLINE_CHECK(slid > 0.05);
    TAUTLINE_CHECK(result.history.back().objective < 0.97 * result.history.front().objective);
  }
}

/// The points of a coarse sphere and of a coarse cube go to fine ones.
TAUTLINE_PART(testGeometry)
{
  const auto match = [](const MeshData& data, const MeshData& geometry)
  {
    const Mesh mesh(data.view()), target(geometry.view());
    return matchGeometry(mesh, {}, nullptr, target);
  };
  // A cube that is 3 % too small and not quite at the place.
  MeshData cube = cubeSurface(CellType::Triangle, 6);
  cube.transform([](Vec3 p) { return 0.97 * p + Vec3{ 0.01, 0.015, 0.02 }; });
  const MeshData fine = cubeSurface(CellType::Triangle, 16);
  const GeometryMatch found = match(cube, fine);
  TAUTLINE_CHECK_EQUAL(found.corners, Index(8));
  TAUTLINE_CHECK_EQUAL(found.curves, 12);
  TAUTLINE_CHECK_NEAR(volumeWithin(cube, found.points), 1, 1e-12);
  const MeshData sphere = sphereSurface(CellType::Quadrilateral, 6),
                 finer = sphereSurface(CellType::Triangle, 40);
  const GeometryMatch onSphere = match(sphere, finer);
  MeshData placed = TAUTLINE_CHANGED(sphere, points = onSphere.points);
  TAUTLINE_LET(OptimizeOptions, options, model = &onSphere.model, parts = onSphere.parts.data(),
    onGeometry = true);
  const OptimizeResult result = run(placed, options);
  double off = largestOf<double>(
    0, sphere.numberOfPoints(), [&](Index p) { return std::abs(norm(at(result.points, p)) - 1); });
  TAUTLINE_CHECK(off < 7e-4); // the sagitta of the finer sphere
  TAUTLINE_CHECK(result.surfaceError > 0 && result.surfaceError < 0.05);
  TAUTLINE_CHECK(
    volumeWithin(sphere, result.points) > 0.9995 * volumeWithin(sphere, sphere.points));
  TAUTLINE_LET(MeshData, lines, addPoint({ 0, 0, 0 }));
  TAUTLINE_CHECK_THROWS(match(sphere, lines), wording("no-triangles-or-quadrilaterals"));
  options.parts = nullptr;
  TAUTLINE_CHECK_THROWS(run(placed, options), wording("part-of-it"));
}
}
