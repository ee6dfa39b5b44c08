// SPDX-License-Identifier: BSD-3-Clause
// A boundary whose points slide stays within a distance of where it was, and the other way round.
#include "Optimizing.h"
#include "VtkMeshes.h"

#include "tautline/Mesh/Features.h"
#include "vtkMeshOptimizer.h"

#include <algorithm>
#include <map>
#include <set>

using namespace tautline;

namespace
{
using Triangle = std::array<Vec3, 3>;

/// Of a point from a triangle, by the three edges and the plane; no code of the library.
double distanceTo(const Triangle& t, const Vec3& x)
{
  double least = 1e300;
  for (int k = 0; k < 3; ++k)
  {
    const Vec3 a = t[k], ab = t[(k + 1) % 3] - a;
    const double s = std::clamp(dot(x - a, ab) / dot(ab, ab), 0.0, 1.0);
    least = std::min(least, norm(a + s * ab - x));
  }
  const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
  const Vec3 foot = x - (dot(x - t[0], n) / dot(n, n)) * n;
  bool inside = true;
  for (int k = 0; k < 3; ++k)
  {
    inside = inside && dot(cross(t[(k + 1) % 3] - t[k], foot - t[k]), n) >= 0;
  }
  return inside ? norm(foot - x) : least;
}

/// The boundary quadrilaterals of hexahedra, halved.
std::vector<Triangle> boundaryOf(const MeshData& data, const std::vector<double>& points)
{
  const CellTopology& t = topology(CellType::Hexahedron);
  std::map<std::set<Index>, std::vector<Index>> faces;
  for (Index cell = 0; cell < data.numberOfCells(); ++cell)
  {
    for (int f = 0; f < t.faces; ++f)
    {
      std::vector<Index> nodes;
      for (int k = 0; k < t.faceSizes[f]; ++k)
      {
        nodes.push_back(data.connectivity[data.offsets[cell] + t.faceNodes[f][k]]);
      }
      const std::set<Index> key(nodes.begin(), nodes.end());
      faces.count(key) ? faces[key].clear() : void(faces[key] = nodes);
    }
  }
  std::vector<Triangle> triangles;
  for (const auto& [key, nodes] : faces)
  {
    const auto at = [&](std::size_t k)
    {
      const double* p = &points[3 * nodes[k]];
      return Vec3{ p[0], p[1], p[2] };
    };
    for (std::size_t k = 2; k < nodes.size(); ++k)
    {
      triangles.push_back({ at(0), at(k - 1), at(k) });
    }
  }
  return triangles;
}

double distance(const std::vector<Triangle>& from, const std::vector<Triangle>& to)
{
  constexpr int parts = 5;
  double largest = 0;
  for (const Triangle& t : from)
  {
    for (int i = 0; i <= parts; ++i)
    {
      for (int j = 0; i + j <= parts; ++j)
      {
        const Vec3 x =
          (1.0 / parts) * ((parts - i - j) * t[0] + double(i) * t[1] + double(j) * t[2]);
        double least = 1e300;
        for (const Triangle& other : to)
        {
          least = std::min(least, distanceTo(other, x));
        }
        largest = std::max(largest, least);
      }
    }
  }
  return largest;
}

/// A block with a ridge on top, below the angle of features, and points crowded beside it.
MeshData ridge()
{
  constexpr Index n = 6;
  MeshData data = blockMesh(CellType::Hexahedron, n, n, 2);
  Random random(3);
  data.transform(
    [&](Vec3 p)
    {
      const double x = p[0] / n, y = p[1] / n;
      const bool inner = p[0] > 0 && p[0] < n && p[1] > 0 && p[1] < n;
      Vec3 q = { x + (inner ? random.uniform(-0.05, 0.05) : 0), y, 0.2 * p[2] };
      q[0] += inner ? 0.25 * x * (1 - x) : 0;
      q[2] += p[2] > 1 ? 0.25 * (0.5 - std::abs(q[0] - 0.5)) : 0;
      return q;
    });
  return data;
}

struct Outcome
{
  OptimizeResult result;
  double there, back;
};

Outcome runOn(const MeshData& data, double tolerance, int threads = 1)
{
  const Mesh mesh(data.view());
  const Features found = findFeatures(mesh, {});
  const SurfaceModel model = makeSurfaceModel(mesh, found, true);
  const std::vector<std::int32_t> parts = partsOfPoints(found);
  std::vector<unsigned char> fixed;
  for (signed char kind : found.kind)
  {
    fixed.push_back(kind == CornerPoint);
  }
  OptimizeOptions options;
  options.holdWorst = false;
  options.fixed = fixed.data();
  options.model = &model;
  options.parts = parts.data();
  options.surfaceTolerance = tolerance;
  options.threads = threads;
  Outcome outcome = { optimize(mesh, options), 0, 0 };
  const std::vector<Triangle> before = boundaryOf(data, data.points),
                              after = boundaryOf(data, outcome.result.points);
  outcome.there = distance(after, before);
  outcome.back = distance(before, after);
  return outcome;
}

void testLimit()
{
  const MeshData data = ridge();
  TAUTLINE_CHECK_EQUAL(invalid(data, data.points), Index(0));
  const Outcome free = runOn(data, 0);
  const double off = std::max(free.there, free.back);
  TAUTLINE_CHECK(off > 0.01);
  // What the result says is what is measured here, but for the places in between.
  TAUTLINE_CHECK(free.result.surfaceError > 0.8 * off && free.result.surfaceError < 1.05 * off);
  const double start = free.result.history.front().objective,
               unlimited = start - free.result.history.back().objective;
  TAUTLINE_CHECK_EQUAL(free.result.heldOnSurface, Index(0));
  double last = 0;
  for (double tolerance : { 1e-4, 1e-3, 5e-3 })
  {
    const Context context("tolerance " + std::to_string(tolerance));
    const Outcome limited = runOn(data, tolerance);
    TAUTLINE_CHECK(limited.there <= tolerance);
    TAUTLINE_CHECK(limited.back <= tolerance);
    TAUTLINE_CHECK(limited.result.surfaceError <= tolerance);
    const Index held = limited.result.heldOnSurface;
    TAUTLINE_CHECK(held > 0 && held < limited.result.freeVertices);
    // The mesh improves all the same, the more the wider the limit.
    const double lowered = start - limited.result.history.back().objective;
    TAUTLINE_CHECK(lowered > last && lowered > 0.3 * unlimited);
    last = lowered;
    TAUTLINE_CHECK(runOn(data, tolerance, 2).result.points == limited.result.points);
  }
}

/// The filter's limit is relative to the diagonal, whatever the unit.
void testFilter()
{
  for (double unit : { 1.0, 1e-3 })
  {
    MeshData data = ridge();
    data.transform([unit](Vec3 p) { return unit * p; });
    const double diagonal = unit * norm({ 1.0, 1.0, 0.525 });
    const auto grid = toGrid(data);
    double errors[2];
    for (int limited = 0; limited < 2; ++limited)
    {
      vtkNew<vtkMeshOptimizer> filter;
      filter->SetInputData(grid);
      filter->SetBoundary(vtkMeshOptimizer::ON_SURFACE);
      filter->SetHoldWorst(false);
      TAUTLINE_CHECK(filter->GetSurfaceTolerance() == 0.001);
      filter->SetSurfaceTolerance(limited ? 0.001 : 0.0);
      filter->Update();
      errors[limited] = filter->GetSurfaceError() / diagonal;
      const std::string summary = filter->GetSummary();
      const bool says = summary.find("Surface Tolerance holds") != std::string::npos;
      TAUTLINE_CHECK_EQUAL(says, limited == 1);
    }
    TAUTLINE_CHECK(errors[0] > 0.005);
    TAUTLINE_CHECK(errors[1] <= 0.001 && errors[1] > 0.0003);
  }
}
}

int TestSurfaceLimit(int, char*[])
{
  testLimit();
  testFilter();
  return exitCode();
}
