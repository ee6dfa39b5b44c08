// SPDX-License-Identifier: BSD-3-Clause
// Adaptation of tetrahedra to the analytic metrics of the Unstructured Grid Adaptation Working
// Group (UGAWG/adapt-benchmarks), one thread: the metric is evaluated at the points, the mesh
// adapted, the metric evaluated again, and so on. Prints the share of edges of length 1 / sqrt(2)
// to sqrt(2), the smallest and mean mean ratio, all in the analytic metric, and CPU time.
// Files have the formats of Medit (.mesh, .sol), so that other programs can do the same.
//
// usage: BenchmarkVolumeAdaptation cases                           the names of the cases
//        BenchmarkVolumeAdaptation start CASE TETRAHEDRA FILE      writes the uniform mesh
//        BenchmarkVolumeAdaptation metric CASE TETRAHEDRA FILE SOL writes the metric at its points
//        BenchmarkVolumeAdaptation adapt CASE TETRAHEDRA ROUNDS    adapts it
//        BenchmarkVolumeAdaptation evaluate CASE TETRAHEDRA FILE   the figures of a mesh
// TETRAHEDRA is about their number in a mesh of unit tetrahedra.

#include "Blocks.h"
#include "Clocks.h"

#include "tautline/Adaptation/MetricTensor.h"
#include "tautline/Reconnection/Reconnection.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <set>

using namespace tautline;

namespace
{
constexpr double Large = 0.1, Small = 1e-3;
/// For the cylinder that is cut from the edge x = y = 0 of the cube.
constexpr double Radius = 0.5;

double layer(double distance)
{
  return Small + 2.0 * (Large - Small) * std::abs(distance);
}

MetricTensor linear(const Vec3& x)
{
  const double h = 1.0 / (Large * Large), z = layer(x[2] - 0.5);
  return { h, h, 1.0 / (z * z), 0.0, 0.0, 0.0 };
}

/// With sizes along and across the direction from the z axis.
MetricTensor polar(const Vec3& x, double along, double across)
{
  constexpr double offAxis = 1e-9; // the direction is defined everywhere
  const double angle = std::atan2(x[1] + offAxis, x[0] + offAxis);
  const double c = std::cos(angle), s = std::sin(angle);
  const double a = 1.0 / (along * along), b = 1.0 / (across * across);
  return { a * c * c + b * s * s, a * s * s + b * c * c, 1.0 / (Large * Large), (a - b) * c * s,
    0.0, 0.0 };
}

double radiusOf(const Vec3& x)
{
  return std::hypot(x[0], x[1]);
}

MetricTensor polar1(const Vec3& x)
{
  return polar(x, layer(radiusOf(x) - Radius), Large);
}

MetricTensor polar2(const Vec3& x)
{
  const double d = std::clamp(10.0 * (0.6 - radiusOf(x)), 0.0, 1.0);
  return polar(x, layer(radiusOf(x) - Radius), 0.025 * d + Large * (1.0 - d));
}

struct Case
{
  const char* name;
  MetricTensor (*metric)(const Vec3&);
  bool cylinder; ///< whether the cylinder is cut out
};

constexpr std::array<Case, 5> Cases = { { { "linear", linear, false }, { "polar-1", polar1, false },
  { "polar-2", polar2, false }, { "cylinder-linear", linear, true },
  { "cylinder-polar-2", polar2, true } } };

/// The unit cube, of the cylinder cases without the cylinder, from parameters in the unit cube.
Vec3 placeOf(const Case& c, const Vec3& u)
{
  if (!c.cylinder)
  {
    return u;
  }
  const double angle = 0.5 * Pi * u[0];
  const Vec3 d = { std::cos(angle), std::sin(angle), 0.0 };
  const double outer = 1.0 / std::max(d[0], d[1]);
  Vec3 x = (Radius + u[1] * (outer - Radius)) * d;
  x[2] = u[2];
  return x;
}

/// The factor of the metric with which the domain has this many unit tetrahedra.
double scaleFor(const Case& c, double tetrahedra)
{
  constexpr int across = 40, fine = 2000;
  constexpr double unitVolume = 0.11785113019775792; // sqrt(2) / 12
  // The metrics vary along z, or along the radius, alone.
  const bool alongZ = c.metric == linear;
  double volume = 0.0;
  for (int i = 0; i < across; ++i)
  {
    for (int k = 0; k < fine; ++k)
    {
      const double a = (i + 0.5) / across, b = (k + 0.5) / fine;
      for (int j = 0; j < across; ++j)
      {
        const double e = (j + 0.5) / across;
        const Vec3 x = alongZ ? Vec3{ a, e, b } : Vec3{ b, a, e };
        const MetricTensor m = c.metric(x);
        const bool counts = !c.cylinder || radiusOf(x) > Radius;
        volume += counts ? std::sqrt((m[0] * m[1] - m[3] * m[3]) * m[2]) : 0.0;
      }
    }
  }
  volume /= static_cast<double>(across) * across * fine;
  return std::pow(tetrahedra * unitVolume / volume, 2.0 / 3.0);
}

MeshData startMesh(const Case& c)
{
  constexpr Index n = 8;
  MeshData data = blockMesh(CellType::Tetrahedron, n, n, n);
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    data.setPoint(p, placeOf(c, (1.0 / n) * data.point(p)));
  }
  if (c.cylinder) // the parameters are in the other order
  {
    for (Index t = 0; t < data.numberOfCells(); ++t)
    {
      std::swap(data.connectivity[4 * t + 2], data.connectivity[4 * t + 3]);
    }
  }
  return data;
}

MetricTensor metricAt(const Case& c, const Vec3& x, double scale)
{
  MetricTensor m = c.metric(x);
  for (double& entry : m)
  {
    entry *= scale;
  }
  return m;
}

void writeMesh(const MeshData& data, const char* name)
{
  std::ofstream file(name);
  file.precision(17);
  file << "MeshVersionFormatted 2\nDimension 3\nVertices\n" << data.numberOfPoints() << '\n';
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    const Vec3 x = data.point(p);
    file << x[0] << ' ' << x[1] << ' ' << x[2] << " 0\n";
  }
  file << "Tetrahedra\n" << data.numberOfCells() << '\n';
  for (Index t = 0; t < data.numberOfCells(); ++t)
  {
    for (int k = 0; k < 4; ++k)
    {
      file << data.connectivity[4 * t + k] + 1 << ' ';
    }
    file << "0\n";
  }
  file << "End\n";
}

/// The points and tetrahedra of a file.
MeshData readMesh(const char* name)
{
  std::ifstream file(name);
  MeshData data;
  std::string word;
  Index count = 0, label = 0;
  while (file >> word)
  {
    if (word == "Vertices" && file >> count)
    {
      Vec3 x;
      for (Index i = 0; i < count && file >> x[0] >> x[1] >> x[2] >> label; ++i)
      {
        data.addPoint(x);
      }
    }
    else if (word == "Tetrahedra" && file >> count)
    {
      std::array<Index, 4> v;
      for (Index i = 0; i < count && file >> v[0] >> v[1] >> v[2] >> v[3] >> label; ++i)
      {
        data.addCell(CellType::Tetrahedron, { v[0] - 1, v[1] - 1, v[2] - 1, v[3] - 1 });
      }
    }
  }
  return data;
}

/// In Medit's order: xx, xy, yy, xz, yz, zz.
void writeMetric(const Case& c, const MeshData& data, double scale, const char* name)
{
  std::ofstream file(name);
  file.precision(17);
  constexpr std::array<int, 6> order = { 0, 3, 1, 5, 4, 2 };
  file << "MeshVersionFormatted 2\nDimension 3\nSolAtVertices\n"
       << data.numberOfPoints() << "\n1 3\n";
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    const MetricTensor m = metricAt(c, data.point(p), scale);
    for (int k : order)
    {
      file << m[k] << ' ';
    }
    file << '\n';
  }
  file << "End\n";
}

double meanRatio(const std::array<Vec3, 4>& x, const std::array<MetricTensor, 4>& metrics)
{
  MetricTensor m = {};
  for (const MetricTensor& one : metrics)
  {
    for (std::size_t k = 0; k < m.size(); ++k)
    {
      m[k] += one[k] / 4.0;
    }
  }
  double sum = 0.0;
  for (int i = 0; i < 4; ++i)
  {
    for (int j = 0; j < i; ++j)
    {
      sum += squaredLength(x[i] - x[j], m);
    }
  }
  const double determinant = m[0] * (m[1] * m[2] - m[4] * m[4]) -
    m[3] * (m[3] * m[2] - m[4] * m[5]) + m[5] * (m[3] * m[4] - m[1] * m[5]);
  const double volume = dot(x[1] - x[0], cross(x[2] - x[0], x[3] - x[0])) / 6.0;
  // 12 (3 V)^(2/3) / sum of squared edges, V in the metric.
  return 12.0 * std::cbrt(9.0 * volume * std::abs(volume) * determinant) / sum;
}

void printFigures(const Case& c, const MeshData& data, double scale)
{
  std::vector<MetricTensor> metrics;
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    metrics.push_back(metricAt(c, data.point(p), scale));
  }
  std::set<std::pair<Index, Index>> edges;
  double smallest = 1.0, sum = 0.0;
  for (Index t = 0; t < data.numberOfCells(); ++t)
  {
    const Index* v = &data.connectivity[4 * t];
    std::array<Vec3, 4> x;
    std::array<MetricTensor, 4> m;
    for (int i = 0; i < 4; ++i)
    {
      x[i] = data.point(v[i]);
      m[i] = metrics[v[i]];
      for (int j = 0; j < i; ++j)
      {
        edges.insert({ std::min(v[i], v[j]), std::max(v[i], v[j]) });
      }
    }
    const double q = meanRatio(x, m);
    smallest = std::min(smallest, q);
    sum += q;
  }
  Index unit = 0;
  double shortest = 1e300, longest = 0.0;
  for (const auto& [a, b] : edges)
  {
    const double length = edgeLength(data.point(b) - data.point(a), metrics[a], metrics[b]);
    unit += length >= std::sqrt(0.5) && length <= std::sqrt(2.0);
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
  }
  std::printf("tetrahedra\t%d\nunit edges\t%.6f\nshortest edge\t%.6f\nlongest edge\t%.6f\n"
              "smallest mean ratio\t%.6f\nmean of mean ratios\t%.6f\n",
    static_cast<int>(data.numberOfCells()),
    static_cast<double>(unit) / static_cast<double>(edges.size()), shortest, longest, smallest,
    sum / static_cast<double>(data.numberOfCells()));
}

MeshData adapted(const Case& c, MeshData data, double scale, int rounds)
{
  double seconds = 0.0;
  for (int round = 0; round < rounds; ++round)
  {
    std::vector<double> metrics;
    for (Index p = 0; p < data.numberOfPoints(); ++p)
    {
      const MetricTensor m = metricAt(c, data.point(p), scale);
      metrics.insert(metrics.end(), m.begin(), m.end());
    }
    ReconnectionOptions options;
    applyPreset(ReconnectionPreset::Adapt, options);
    options.threads = 1;
    options.boundary = c.cylinder ? BoundaryMotion::OnSurface : BoundaryMotion::FlatParts;
    options.size = ReconnectionSize::Metrics;
    options.sizes = metrics.data();
    const double start = threadTime();
    const ReconnectionResult result = improveConnectivity(Mesh(data.view()), options);
    seconds += threadTime() - start;
    MeshData next;
    next.points = result.points;
    for (std::size_t i = 0; i < result.tetrahedra.size(); i += 4)
    {
      const Index* v = &result.tetrahedra[i];
      next.addCell(CellType::Tetrahedron, { v[0], v[1], v[2], v[3] });
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
  if (command == "cases")
  {
    for (const Case& c : Cases)
    {
      std::puts(c.name);
    }
    return EXIT_SUCCESS;
  }
  const auto found = std::find_if(Cases.begin(), Cases.end(),
    [&](const Case& c) { return argc > 4 && c.name == std::string(argv[2]); });
  if (found == Cases.end())
  {
    std::cerr << "usage: BenchmarkVolumeAdaptation cases | start|metric|adapt|evaluate CASE "
                 "TETRAHEDRA ...\n";
    return EXIT_FAILURE;
  }
  const double scale = scaleFor(*found, std::atof(argv[3]));
  if (command == "start")
  {
    writeMesh(startMesh(*found), argv[4]);
  }
  else if (command == "metric" && argc > 5)
  {
    writeMetric(*found, readMesh(argv[4]), scale, argv[5]);
  }
  else if (command == "evaluate")
  {
    printFigures(*found, readMesh(argv[4]), scale);
  }
  else if (command == "adapt")
  {
    printFigures(*found, adapted(*found, startMesh(*found), scale, std::atoi(argv[4])), scale);
  }
  return EXIT_SUCCESS;
}
