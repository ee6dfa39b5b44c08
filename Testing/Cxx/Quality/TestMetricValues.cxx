// SPDX-License-Identifier: BSD-3-Clause
// A second evaluation of the metrics of whole cells, in plain double precision and as the
// literature states them: circumcentres, signed sizes by quadrature, angles by arc cosine.
// TestTargetValues has the metrics of T = A W^-1.
#include "Matrix.h"
#include "Meshes.h"
#include "Registry.h"

using namespace tautline;

namespace
{
constexpr int cellsPerType = 300;
constexpr double tolerance = 1e-10; // relative, or of 1 for values near 0
constexpr double degrees = 180 / M_PI;
using Corners = std::vector<Vec3>;

double squared(double x)
{
  return x * x;
}

double triangleArea(const Vec3& a, const Vec3& b, const Vec3& c)
{
  return norm(cross(b - a, c - a)) / 2;
}

/// Signed size by the divergence theorem; two Gauss points a direction are exact on bilinear faces.
double sizeOf(CellType type, const Corners& p)
{
  const CellTopology& t = topology(type);
  double size = 0;
  if (t.dimension == 2)
  {
    for (int i = 0; i < t.nodes; ++i)
    {
      size += cross(p[i], p[(i + 1) % t.nodes])[2] / 2; // the shoelace formula
    }
    return size;
  }
  for (int f = 0; f < t.faces; ++f)
  {
    const auto& n = t.faceNodes[f];
    if (t.faceSizes[f] == 3)
    {
      size += dot(p[n[0]], cross(p[n[1]], p[n[2]])) / 6;
      continue;
    }
    for (double u : { 0.5 - std::sqrt(1.0 / 12), 0.5 + std::sqrt(1.0 / 12) })
    {
      for (double v : { 0.5 - std::sqrt(1.0 / 12), 0.5 + std::sqrt(1.0 / 12) })
      {
        const Vec3 low = (1 - u) * p[n[0]] + u * p[n[1]], high = (1 - u) * p[n[3]] + u * p[n[2]];
        const Vec3 du = (1 - v) * (p[n[1]] - p[n[0]]) + v * (p[n[2]] - p[n[3]]);
        size += dot((1 - v) * low + v * high, cross(du, high - low)) / 12;
      }
    }
  }
  return size;
}

double longestEdge(CellType type, const Corners& p)
{
  const CellTopology& t = topology(type);
  return largestOf<double>(
    0, t.edges, [&](int e) { return norm(p[t.edgeNodes[e][1]] - p[t.edgeNodes[e][0]]); });
}

/// The distance of the circumcentre c: 2 (p_i - p_0) . c = |p_i - p_0|^2.
double circumradius(int n, const Corners& p)
{
  const Matrix inverseEdges =
    inverse(makeMatrix(n, [&](int r, int c) { return 2 * (p[r + 1] - p[0])[c]; }));
  double sum = 0;
  for (int r = 0; r < n; ++r)
  {
    double c = sumOf<double>(
      0, n, [&](int k) { return inverseEdges(r, k) * dot(p[k + 1] - p[0], p[k + 1] - p[0]); });
    sum += c * c;
  }
  return std::sqrt(sum);
}

struct Simplex
{
  int n;
  double size, surface, circumradius, inradius;
  std::vector<double> faces; ///< lengths or areas opposite each vertex
  Simplex(CellType type, const Corners& p)
    : n(topology(type).dimension)
    , size(sizeOf(type, p))
    , surface(0)
    , circumradius(::circumradius(n, p))
  {
    for (int i = 0; i <= this->n; ++i)
    {
      const Vec3 &a = p[(i + 1) % (n + 1)], &b = p[(i + 2) % (n + 1)];
      this->faces.push_back(n == 2 ? norm(b - a) : triangleArea(a, b, p[(i + 3) % 4]));
      this->surface += this->faces.back();
    }
    this->inradius = this->n * std::abs(this->size) / this->surface;
  }
};

double simplexValue(Metric metric, CellType type, const Corners& p)
{
  const Simplex s(type, p);
  const double sign = s.size < 0 ? -1 : 1;
  double squares = 0, product = 1, pairs = 0;
  for (int i = 0; i <= s.n; ++i)
  {
    squares += squared(s.faces[i]);
    product *= s.faces[i];
    for (int j = 0; j < i; ++j)
    {
      pairs += s.faces[i] * s.faces[j] * dot(p[i] - p[j], p[i] - p[j]);
    }
  }
  const double rms = std::sqrt(squares / 4);
  switch (metric)
  {
    case Metric::RadiusRatio:
      return sign * std::sqrt(s.circumradius / s.inradius);
    case Metric::NormalizedRadiusRatio:
      return sign * s.circumradius / (s.n * s.inradius);
    case Metric::ConditioningScaleInvariant:
      return s.n == 2 ? s.size / squares : s.size / std::pow(rms, 1.5);
    case Metric::ConditioningSizeShape:
      return s.size / squared(rms);
    case Metric::InterpolationSizeShape:
      return s.n == 2 ? s.size / product : s.size * s.surface / pairs;
    default: // InterpolationScaleInvariant
      return s.n == 2 ? s.size / std::pow(product, 2.0 / 3)
                      : s.size * std::pow(s.surface / pairs, 0.75);
  }
}

//------------------------------------------------------------------------------
double angleBetween(const Vec3& a, const Vec3& b)
{
  return degrees * std::acos(dot(a, b) / (norm(a) * norm(b)));
}

/// Corner angles counted against the sense the cell is listed in; dihedral angles.
std::vector<double> anglesOf(CellType type, const Corners& p)
{
  const CellTopology& t = topology(type);
  std::vector<double> angles;
  if (t.dimension == 2)
  {
    const bool reversed = sizeOf(type, p) < 0;
    for (int c = 0; c < t.nodes; ++c)
    {
      const Vec3 next = p[(c + 1) % t.nodes] - p[c], last = p[(c + t.nodes - 1) % t.nodes] - p[c];
      double turn = degrees * (std::atan2(last[1], last[0]) - std::atan2(next[1], next[0]));
      turn = std::fmod(reversed ? 720 - turn : 720 + turn, 360);
      angles.push_back(turn);
    }
    return angles;
  }
  for (int e = 0; e < t.edges; ++e)
  {
    Vec3 normal[2];
    for (int side = 0; side < 2; ++side)
    {
      const int f = t.edgeFaces[e][side];
      normal[side] = { 0, 0, 0 }; // the vector area
      for (int k = 0; k < t.faceSizes[f]; ++k)
      {
        normal[side] += cross(p[t.faceNodes[f][k]], p[t.faceNodes[f][(k + 1) % t.faceSizes[f]]]);
      }
    }
    angles.push_back(180 - angleBetween(normal[0], normal[1]));
  }
  return angles;
}

double skewOf(CellType type, const Corners& p)
{
  const CellTopology& t = topology(type);
  double skew = 0;
  for (int f = 0; f < std::max(1, t.faces); ++f)
  {
    const int size = t.dimension == 2 ? t.nodes : t.faceSizes[f];
    const double equal = size == 3 ? 60 : 90;
    auto at = [&](int k) { return p[t.dimension == 2 ? k % size : t.faceNodes[f][k % size]]; };
    for (int k = 0; k < size; ++k)
    {
      const double angle = angleBetween(at(k + 1) - at(k), at(k + size - 1) - at(k));
      skew = std::max({ skew, (angle - equal) / (180 - equal), (equal - angle) / equal });
    }
  }
  return skew;
}

/// Sides of the box round a triangle with a side along an edge; the least elongated of three.
double widthRatioOf(const Corners& p)
{
  double best = HUGE_VAL;
  for (int e = 0; e < 3; ++e)
  {
    const Vec3 along = p[(e + 1) % 3] - p[e], across = { -along[1], along[0], 0 };
    auto extent = [&](const Vec3& d)
    {
      const auto ends = std::minmax({ dot(d, p[0]), dot(d, p[1]), dot(d, p[2]) });
      return ends.second - ends.first;
    };
    const double q = extent(along) / extent(across);
    best = std::min(best, std::max(q, 1 / q));
  }
  return best;
}

/// Vectors between the middles of opposite edges (2D) or faces (3D).
double axisRatioOf(CellType type, const Corners& p)
{
  const std::vector<std::array<std::vector<int>, 2>> sides = type == CellType::Quadrilateral
    ? std::vector<std::array<std::vector<int>, 2>>{ { { { 1, 2 }, { 0, 3 } } },
        { { { 2, 3 }, { 0, 1 } } } }
    : std::vector<std::array<std::vector<int>, 2>>{ { { { 1, 2, 5, 6 }, { 0, 3, 4, 7 } } },
        { { { 2, 3, 6, 7 }, { 0, 1, 4, 5 } } }, { { { 4, 5, 6, 7 }, { 0, 1, 2, 3 } } } };
  std::vector<double> lengths;
  for (const auto& pair : sides)
  {
    Vec3 axis = sumOf<Vec3>(
      { 0, 0, 0 }, pair[0].size(), [&](std::size_t k) { return p[pair[0][k]] - p[pair[1][k]]; });
    lengths.push_back(norm(axis));
  }
  const auto ends = std::minmax_element(lengths.begin(), lengths.end());
  return *ends.second / *ends.first;
}

/// The smallest determinant of the edges at a corner; of 2D cells in the xy plane.
double smallestCorner(CellType type, const Corners& p)
{
  const CellTopology& t = topology(type);
  double least = HUGE_VAL;
  for (int c = 0; c < t.corners; ++c)
  {
    const auto& n = t.cornerNodes[c];
    const Vec3 third = t.dimension == 2 ? Vec3{ 0, 0, 1 } : p[n[3]] - p[n[0]];
    least = std::min(least, dot(cross(p[n[1]] - p[n[0]], p[n[2]] - p[n[0]]), third));
  }
  return least;
}

double cellValue(Metric metric, CellType type, const Corners& p)
{
  const CellTopology& t = topology(type);
  const std::vector<double> angles = anglesOf(type, p), sines = cornerSines(type, p);
  auto lengths = collect<double>(
    t.edges, [&](int e) { return norm(p[t.edgeNodes[e][1]] - p[t.edgeNodes[e][0]]); });
  const double idealSine = cornerSines(type, idealCell(type))[0];
  // The inradius of the simplex with unit edges, in units of its edge.
  const double regular = t.dimension == 2 ? std::sqrt(3.0) / 6 : std::sqrt(6.0) / 12;
  switch (metric)
  {
    case Metric::Size:
      return sizeOf(type, p);
    case Metric::EdgeRatio:
      return longestEdge(type, p) / *std::min_element(lengths.begin(), lengths.end());
    case Metric::AspectRatio:
      return t.samples == 1 ? longestEdge(type, p) / Simplex(type, p).inradius * regular
                            : axisRatioOf(type, p);
    case Metric::WidthRatio:
      return widthRatioOf(p);
    case Metric::MinimumAngle:
      return *std::min_element(angles.begin(), angles.end());
    case Metric::MaximumAngle:
      return *std::max_element(angles.begin(), angles.end());
    case Metric::EquiangleSkew:
      return skewOf(type, p);
    case Metric::MinimumJacobian:
      return smallestCorner(type, p);
    default: // ScaledJacobian
      return *std::min_element(sines.begin(), sines.end()) / idealSine;
  }
}

//------------------------------------------------------------------------------
void testType(CellType type, bool surface)
{
  Random random(5);
  std::vector<Corners> cells;
  const MeshData data = scatteredCells(type, surface, cellsPerType, random, cells);
  const Mesh mesh(data.view());
  for (const MetricInfo& info : elementMetrics())
  {
    const bool inside = type == CellType::Hexahedron || type == CellType::Wedge;
    if (!info.definedOn(type) || info.family == MetricFamily::Target ||
      (info.metric == Metric::MinimumJacobian && inside)) // see TestExactValidity
    {
      continue;
    }
    const Context context(info.name);
    const std::vector<double> values = valuesOf(mesh, info.metric);
    for (int i = 0; i < cellsPerType; ++i)
    {
      const double expected = info.family == MetricFamily::Simplex
        ? simplexValue(info.metric, type, cells[i])
        : cellValue(info.metric, type, cells[i]);
      TAUTLINE_CHECK_NEAR(values[i], expected, tolerance * std::max(1.0, std::abs(expected)));
    }
  }
}
}

TAUTLINE_TEST(TestMetricValues)
{
  for (CellType type : allTypes)
  {
    const Context context(topology(type).name);
    TAUTLINE_RUN(testType(type, false));
    if (topology(type).dimension == 2)
    {
      const Context surface("surface");
      TAUTLINE_RUN(testType(type, true));
    }
  }
}
