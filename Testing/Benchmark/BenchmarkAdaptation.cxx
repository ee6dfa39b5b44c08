// SPDX-License-Identifier: BSD-3-Clause
// Adaptation of triangles to analytic metrics, one thread: the metric is evaluated at the points,
// the mesh adapted, the metric evaluated again, and so on. Prints the share of edges of length
// 1 / sqrt(2) to sqrt(2), the smallest and mean mean ratio, all in the analytic metric, and CPU
// time.
// Files have the format of FreeFem++ (.msh), so that other programs can do the same.
//
// usage: BenchmarkAdaptation cases                                the names of the cases
//        BenchmarkAdaptation start CASE TRIANGLES FILE            writes the uniform mesh
//        BenchmarkAdaptation adapt CASE TRIANGLES ROUNDS [FILE]   adapts it, and writes the result
//        BenchmarkAdaptation evaluate CASE TRIANGLES FILE         the figures of a mesh
// TRIANGLES is about their number in a mesh of unit triangles.

#include "Clocks.h"
#include "Meshes.h"

#include "tautline/Adaptation/MetricTensor.h"
#include "tautline/Reconnection/TriangleReconnection.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>

using namespace tautline;

namespace
{
/// Sizes along x (or away from the origin) and across.
struct Sizes
{
  double along, across;
};

struct Case
{
  std::string name;
  std::function<Sizes(double, double)> sizes;
  bool polar = false; ///< whether the sizes are along and across the direction from the origin
  bool hole = false;  ///< a plate with a hole instead of the unit square
};

/// For the plate.
constexpr double HoleRadius = 0.1;

/// The metrics of the Unstructured Grid Adaptation Working Group (UGAWG/adapt-benchmarks, cube and
/// cube-cylinder) without their z, and isotropic ones.
std::vector<Case> makeCases()
{
  constexpr double large = 0.1, small = 1e-3;
  const auto layer = [](double r) { return small + 2.0 * (large - small) * std::abs(r - 0.5); };
  const auto radius = [](double x, double y) { return std::hypot(x, y); };
  std::vector<Case> cases;
  cases.push_back({ "linear", [=](double, double y) { return Sizes{ large, layer(y) }; } });
  cases.push_back({ "polar-1",
    [=](double x, double y) {
      return Sizes{ layer(radius(x, y)), large };
    },
    true });
  cases.push_back({ "polar-2",
    [=](double x, double y)
    {
      const double r = radius(x, y), d = std::min(10.0 * std::abs(r - 0.5), 1.0);
      return Sizes{ layer(r), large * d + 0.025 * (1.0 - d) };
    },
    true });
  cases.push_back({ "isotropic",
    [=](double x, double y)
    {
      const double h = 0.005 + 0.2 * std::abs(radius(x, y) - 0.5);
      return Sizes{ h, h };
    } });
  cases.push_back({ "plate",
    [=](double x, double y)
    {
      const double h = 0.01 + 0.2 * (radius(x - 0.5, y - 0.5) - HoleRadius);
      return Sizes{ h, h };
    },
    false, true });
  return cases;
}

MetricTensor metricAt(const Case& c, const Vec3& x, double scale)
{
  constexpr double offCentre = 1e-3; // the direction from the origin is defined everywhere
  const Vec3 at = c.polar ? Vec3{ x[0] + offCentre, x[1] + offCentre, 0.0 } : x;
  const Sizes sizes = c.sizes(at[0], at[1]);
  const double a = scale / (sizes.along * sizes.along), b = scale / (sizes.across * sizes.across);
  const double angle = c.polar ? std::atan2(at[1], at[0]) : 0.0;
  const double cosine = std::cos(angle), sine = std::sin(angle);
  return { a * cosine * cosine + b * sine * sine, a * sine * sine + b * cosine * cosine, 1.0,
    (a - b) * cosine * sine, 0.0, 0.0 };
}

bool inside(const Case& c, double x, double y)
{
  return !c.hole || std::hypot(x - 0.5, y - 0.5) > HoleRadius;
}

/// The factor of the metric with which this many unit triangles have the area in the metric.
double scaleFor(const Case& c, double triangles)
{
  constexpr int n = 2000;
  constexpr double unitArea = 0.4330127018922193; // sqrt(3) / 4
  double area = 0.0;
  for (int i = 0; i < n; ++i)
  {
    for (int j = 0; j < n; ++j)
    {
      const double x = (i + 0.5) / n, y = (j + 0.5) / n;
      const MetricTensor m = metricAt(c, { x, y, 0.0 }, 1.0);
      area += inside(c, x, y) ? std::sqrt(m[0] * m[1] - m[3] * m[3]) / (n * n) : 0.0;
    }
  }
  return triangles * unitArea / area;
}

/// Squares of two triangles, of a plate with a hole around it.
MeshData startMesh(const Case& c, double triangles)
{
  // A fifth of the points along each side: coarse where the metric is fine.
  const auto n = static_cast<Index>(std::max(4.0, 0.2 * std::sqrt(0.5 * triangles)));
  MeshData data;
  const Index around = 4 * n, columns = c.hole ? around : n + 1, rows = n + 1;
  for (Index j = 0; j < rows; ++j)
  {
    for (Index i = 0; i < columns; ++i)
    {
      Vec3 x = { static_cast<double>(i) / n, static_cast<double>(j) / n, 0.0 };
      if (c.hole)
      {
        const double angle = 2.0 * Pi * i / around, part = static_cast<double>(j) / n;
        const Vec3 d = { std::cos(angle), std::sin(angle), 0.0 };
        const double edge = 0.5 / std::max(std::abs(d[0]), std::abs(d[1]));
        const double r = HoleRadius + part * (edge - HoleRadius);
        x = Vec3{ 0.5, 0.5, 0.0 } + r * d;
      }
      data.addPoint(x);
    }
  }
  for (Index j = 0; j < n; ++j)
  {
    for (Index i = 0; i < (c.hole ? around : n); ++i)
    {
      const Index next = (i + 1) % columns;
      const Index a = j * columns + i, b = j * columns + next, d = a + columns, e = b + columns;
      if (c.hole)
      {
        data.addCell(CellType::Triangle, { a, d, e });
        data.addCell(CellType::Triangle, { a, e, b });
      }
      else
      {
        data.addCell(CellType::Triangle, { a, b, e });
        data.addCell(CellType::Triangle, { a, e, d });
      }
    }
  }
  return data;
}

using Edge = std::pair<Index, Index>;

/// Edges with the number of triangles at them.
std::map<Edge, int> edgesOf(const MeshData& data)
{
  std::map<Edge, int> edges;
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Index a = data.connectivity[3 * c + k], b = data.connectivity[3 * c + (k + 1) % 3];
      ++edges[{ std::min(a, b), std::max(a, b) }];
    }
  }
  return edges;
}

void writeMesh(const MeshData& data, const char* name)
{
  std::ofstream file(name);
  file.precision(17);
  Index border = 0;
  const std::map<Edge, int> edges = edgesOf(data);
  for (const auto& [edge, uses] : edges)
  {
    border += uses == 1;
  }
  file << data.numberOfPoints() << ' ' << data.numberOfCells() << ' ' << border << '\n';
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    file << data.point(i)[0] << ' ' << data.point(i)[1] << " 0\n";
  }
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    const Index* v = &data.connectivity[3 * c];
    file << v[0] + 1 << ' ' << v[1] + 1 << ' ' << v[2] + 1 << " 0\n";
  }
  for (const auto& [edge, uses] : edges)
  {
    if (uses == 1)
    {
      file << edge.first + 1 << ' ' << edge.second + 1 << " 1\n";
    }
  }
}

MeshData readMesh(const char* name)
{
  std::ifstream file(name);
  Index points = 0, cells = 0, border = 0;
  file >> points >> cells >> border;
  MeshData data;
  double x = 0.0, y = 0.0;
  Index label = 0, a = 0, b = 0, c = 0;
  for (Index i = 0; i < points && file >> x >> y >> label; ++i)
  {
    data.addPoint({ x, y, 0.0 });
  }
  for (Index i = 0; i < cells && file >> a >> b >> c >> label; ++i)
  {
    data.addCell(CellType::Triangle, { a - 1, b - 1, c - 1 });
  }
  return data;
}

std::vector<MetricTensor> metricsOf(const Case& c, const MeshData& data, double scale)
{
  std::vector<MetricTensor> metrics;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    metrics.push_back(metricAt(c, data.point(i), scale));
  }
  return metrics;
}

double meanRatio(const Case& c, const std::array<Vec3, 3>& x, double scale)
{
  MetricTensor m = {};
  for (const Vec3& p : x)
  {
    const MetricTensor at = metricAt(c, p, scale);
    for (int k = 0; k < 6; ++k)
    {
      m[k] += at[k] / 3.0;
    }
  }
  const Vec3 u = x[1] - x[0], v = x[2] - x[0];
  const double sum = squaredLength(u, m) + squaredLength(v, m) + squaredLength(v - u, m);
  return 2.0 * std::sqrt(3.0) * cross(u, v)[2] * std::sqrt(m[0] * m[1] - m[3] * m[3]) / sum;
}

void printFigures(const Case& c, const MeshData& data, double scale)
{
  const std::vector<MetricTensor> metrics = metricsOf(c, data, scale);
  Index below = 0, above = 0, all = 0;
  double shortest = 1e300, longest = 0.0;
  for (const auto& [edge, uses] : edgesOf(data))
  {
    const double length = edgeLength(
      data.point(edge.second) - data.point(edge.first), metrics[edge.first], metrics[edge.second]);
    ++all;
    below += length < std::sqrt(0.5);
    above += length > std::sqrt(2.0);
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  }
  double smallest = 1.0, sum = 0.0;
  for (Index t = 0; t < data.numberOfCells(); ++t)
  {
    const Index* v = &data.connectivity[3 * t];
    const double q = meanRatio(c, { data.point(v[0]), data.point(v[1]), data.point(v[2]) }, scale);
    smallest = std::min(smallest, q);
    sum += q;
  }
  const auto share = [all](Index part) { return static_cast<double>(part) / all; };
  std::printf("triangles\t%d\nunit edges\t%.6f\nshort edges\t%.6f\nlong edges\t%.6f\nshortest "
              "edge\t%.6f\nlongest edge\t%.6f\n"
              "smallest mean ratio\t%.6f\nmean of mean ratios\t%.6f\n",
    static_cast<int>(data.numberOfCells()), share(all - below - above), share(below), share(above),
    shortest, longest, smallest, sum / data.numberOfCells());
}

MeshData adapted(const Case& c, MeshData data, double scale, int rounds)
{
  double seconds = 0.0;
  for (int round = 0; round < rounds; ++round)
  {
    const std::vector<MetricTensor> metrics = metricsOf(c, data, scale);
    TriangleOptions options;
    options.adapt = true;
    options.compound = false;
    options.threads = 1;
    options.boundary = BoundaryMotion::FlatParts;
    options.size = ReconnectionSize::Metrics;
    options.sizes = metrics.front().data();
    const double start = threadTime();
    const ReconnectionResult result = improveTriangles(Mesh(data.view()), options);
    seconds += threadTime() - start;
    MeshData next;
    next.points = result.points;
    for (std::size_t i = 0; i < result.triangles.size(); i += 3)
    {
      const Index* v = &result.triangles[i];
      next.addCell(CellType::Triangle, { v[0], v[1], v[2] });
    }
    data = next;
  }
  std::printf("seconds\t%.6f\n", seconds);
  return data;
}
}

int main(int argc, char* argv[])
{
  const std::string command = argc > 1 ? argv[1] : "";
  const std::vector<Case> cases = makeCases();
  if (command == "cases")
  {
    for (const Case& c : cases)
    {
      std::puts(c.name.c_str());
    }
    return EXIT_SUCCESS;
  }
  const auto found = std::find_if(
    cases.begin(), cases.end(), [&](const Case& c) { return argc > 3 && c.name == argv[2]; });
  if (found == cases.end())
  {
    std::cerr << "usage: BenchmarkAdaptation cases | start|adapt|evaluate CASE TRIANGLES ...\n";
    return EXIT_FAILURE;
  }
  const double triangles = std::atof(argv[3]), scale = scaleFor(*found, triangles);
  std::printf("scale\t%.17g\n", scale);
  if (command == "start" && argc > 4)
  {
    writeMesh(startMesh(*found, triangles), argv[4]);
  }
  else if (command == "evaluate" && argc > 4)
  {
    printFigures(*found, readMesh(argv[4]), scale);
  }
  else if (command == "adapt" && argc > 4)
  {
    const MeshData data = adapted(*found, startMesh(*found, triangles), scale, std::atoi(argv[4]));
    printFigures(*found, data, scale);
    if (argc > 5)
    {
      writeMesh(data, argv[5]);
    }
  }
  return EXIT_SUCCESS;
}
