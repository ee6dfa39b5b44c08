// SPDX-License-Identifier: BSD-3-Clause
// Adaptation of tetrahedra to metrics: lengths and shapes in the metric, what is kept, and random
// operations in a random metric with all invariants checked after each.

#include "Reconnecting.h"
#include "Registry.h"

#include "tautline/Adaptation/MetricTensor.h"
#include "tautline/Reconnection/BoundaryFreedom.h"
#include "tautline/Reconnection/CavityOperations.h"

using namespace tautline;

namespace
{
constexpr double Sqrt2 = 1.4142135623730951;

using MetricAt = std::function<MetricTensor(const Vec3&)>;

MetricTensor metricOf(const std::array<Vec3, 3>& axes, const std::array<double, 3>& sizes)
{
  MetricAxes result;
  for (int k = 0; k < 3; ++k)
  {
    result.axes[k] = axes[k];
    result.values[k] = 1.0 / (sizes[k] * sizes[k]);
  }
  return tensorOf(result);
}

/// Fine at the plane z = 0.5: the metric "linear" of the benchmarks of the Unstructured Grid
/// Adaptation Working Group, with another smallest size.
MetricTensor linearMetric(const Vec3& x)
{
  constexpr double h = 0.25, h0 = 0.02;
  return metricOf({ Vec3{ 1, 0, 0 }, Vec3{ 0, 1, 0 }, Vec3{ 0, 0, 1 } },
    { h, h, h0 + 2.0 * (h - h0) * std::abs(x[2] - 0.5) });
}

/// Fine at the cylinder of radius 0.5: "polar-1", with another smallest size.
MetricTensor polarMetric(const Vec3& x)
{
  constexpr double h = 0.25, h0 = 0.03;
  const double r = std::hypot(x[0], x[1]), t = std::atan2(x[1], x[0]);
  return metricOf(
    { Vec3{ std::cos(t), std::sin(t), 0 }, Vec3{ -std::sin(t), std::cos(t), 0 }, Vec3{ 0, 0, 1 } },
    { h0 + 2.0 * (h - h0) * std::abs(r - 0.5), h, h });
}

/// The unit cube in n x n x n cubes of five tetrahedra.
MeshData unitCube(Index n)
{
  MeshData data = blockMesh(CellType::Tetrahedron, n, n, n);
  for (double& x : data.points)
  {
    x /= static_cast<double>(n);
  }
  return data;
}

std::vector<double> tensorsOf(const MeshData& data, const MetricAt& metric)
{
  std::vector<double> tensors;
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    const MetricTensor m = metric(data.point(p));
    tensors.insert(tensors.end(), m.begin(), m.end());
  }
  return tensors;
}

ReconnectionOptions adaptOptions(const std::vector<double>& tensors)
{
  ReconnectionOptions options = optionsOf(ReconnectionPreset::Adapt);
  options.boundary = BoundaryMotion::FlatParts;
  options.size = ReconnectionSize::Metrics;
  options.sizes = tensors.data();
  return options;
}

ReconnectionResult adapt(const MeshData& data, const MetricAt& metric,
  BoundaryMotion boundary = BoundaryMotion::FlatParts, const Index* regions = nullptr)
{
  const std::vector<double> tensors = tensorsOf(data, metric);
  ReconnectionOptions options = adaptOptions(tensors);
  options.boundary = boundary;
  options.regions = regions;
  return reconnect(data, options);
}

/// The properties of a mesh in a metric.
struct InMetric
{
  double share = 0; ///< of edges in range
  double smallest = 1, mean = 0;
};

InMetric measureIn(const MeshData& data, const MetricAt& metric)
{
  InMetric result;
  std::set<std::pair<Index, Index>> edges;
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    const Index* v = &data.connectivity[4 * c];
    MetricTensor sum = {};
    std::array<Vec3, 4> x;
    for (int i = 0; i < 4; ++i)
    {
      x[i] = data.point(v[i]);
      sum = sum + metric(x[i]);
      for (int j = 0; j < i; ++j)
      {
        edges.insert({ std::min(v[i], v[j]), std::max(v[i], v[j]) });
      }
    }
    const double ratio = std::pow(metricShape(x[0], x[1], x[2], x[3], sum), 2.0 / 3.0);
    result.smallest = std::min(result.smallest, ratio);
    result.mean += ratio / static_cast<double>(data.numberOfCells());
  }
  for (const auto& [a, b] : edges)
  {
    const Vec3 p = data.point(a), q = data.point(b);
    const double length = edgeLength(q - p, metric(p), metric(q));
    result.share += length >= 1.0 / Sqrt2 && length <= Sqrt2;
  }
  result.share /= static_cast<double>(edges.size());
  return result;
}

/// The shape in a metric equals the shape of the tetrahedron in coordinates in which the metric is
/// the identity, and does not depend on a factor of the metric.
TAUTLINE_PART(testShape)
{
  Random random(4);
  for (int trial = 0; trial < 200; ++trial)
  {
    std::array<Vec3, 4> x, y;
    const Vec3 sizes = { random.uniform(0.1, 2.0), random.uniform(0.1, 2.0),
      random.uniform(0.1, 2.0) };
    for (int i = 0; i < 4; ++i)
    {
      y[i] = random.vector(-1, 1);
      x[i] = { y[i][0] * sizes[0], y[i][1] * sizes[1], y[i][2] * sizes[2] };
    }
    const MetricTensor m = metricOf(
      { Vec3{ 1, 0, 0 }, Vec3{ 0, 1, 0 }, Vec3{ 0, 0, 1 } }, { sizes[0], sizes[1], sizes[2] });
    const double expected = measure(y[0], y[1], y[2], y[3]).meanRatio;
    TAUTLINE_CHECK_NEAR(metricShape(x[0], x[1], x[2], x[3], m), expected, 1e-13);
    TAUTLINE_CHECK_NEAR(metricShape(x[0], x[1], x[2], x[3], m + m), expected, 1e-13);
  }
}

/// After a few steps, each with the metric at the points of the last mesh. The bounds are somewhat
/// below what was measured: shares 0.968 and 0.969, ratios 0.76 and 0.71, means 0.89 and 0.88.
TAUTLINE_PART(testMetrics)
{
  for (const auto& [metric, share] :
    { std::pair<MetricAt, double>{ linearMetric, 0.95 }, { polarMetric, 0.95 } })
  {
    MeshData data = unitCube(4);
    for (int step = 0; step < 3; ++step)
    {
      const ReconnectionResult result = adapt(data, metric);
      data = outputOf(result);
      checkArrays(data, result);
      TAUTLINE_CHECK_RELATIVE(volumeOf(data), 1.0, 1e-13);
    }
    const InMetric after = measureIn(data, metric);
    TAUTLINE_CHECK(after.share > share);
    TAUTLINE_CHECK(after.smallest > 0.6);
    TAUTLINE_CHECK(after.mean > 0.87);
  }
}

/// Uniform sizes: 3 and 9 times finer, and 4 times coarser. A unit of volume has about 6 sqrt(2)
/// elements with edges of length 1.
TAUTLINE_PART(testUniform)
{
  for (const auto& [cubes, size] : { std::pair<Index, double>{ 4, 1.0 / 12.0 },
         std::pair<Index, double>{ 1, 1.0 / 9.0 }, std::pair<Index, double>{ 12, 1.0 / 3.0 } })
  {
    const MeshData data = unitCube(cubes);
    ReconnectionOptions options = optionsOf(ReconnectionPreset::Adapt);
    options.boundary = BoundaryMotion::FlatParts;
    options.size = ReconnectionSize::Length;
    options.edgeLength = size;
    const ReconnectionResult result = reconnect(data, options);
    const MeshData output = outputOf(result);
    checkArrays(output, result);
    TAUTLINE_CHECK_RELATIVE(volumeOf(output), 1.0, 1e-13);
    const double expected = 6.0 * std::sqrt(2.0) / (size * size * size);
    const auto cells = static_cast<double>(output.numberOfCells());
    TAUTLINE_CHECK(cells > 0.4 * expected);
    TAUTLINE_CHECK(cells < 1.6 * expected);
    TAUTLINE_CHECK(result.history.back().edgesInRange > 0.9);
    TAUTLINE_CHECK_NEAR(
      measureIn(output, [size = size](const Vec3&) { return isotropicMetric(size); }).share,
      result.history.back().edgesInRange, 1e-12);
  }
}

/// With a fixed boundary its facets stay, and the inside is adapted.
TAUTLINE_PART(testFixed)
{
  const MeshData data = unitCube(5);
  const MetricAt fine = [](const Vec3&) { return isotropicMetric(0.1); };
  const ReconnectionResult result = adapt(data, fine, BoundaryMotion::Fixed);
  const MeshData output = outputOf(result);
  checkArrays(output, result);
  TAUTLINE_CHECK(outerFacets(output) == outerFacets(data));
  TAUTLINE_CHECK(output.numberOfPoints() > 2 * data.numberOfPoints());
  TAUTLINE_CHECK_RELATIVE(volumeOf(output), 1.0, 1e-13);
}

/// On a ball the boundary stays near the input's.
TAUTLINE_PART(testOnSurface)
{
  const MeshData data = roundMesh(3);
  const MetricAt fine = [](const Vec3&) { return isotropicMetric(0.14); };
  const ReconnectionResult result = adapt(data, fine, BoundaryMotion::OnSurface);
  const MeshData output = outputOf(result);
  checkArrays(output, result);
  constexpr double distance = 1.25 * 5e-3 * 2.0 * 1.7320508;
  TAUTLINE_CHECK(result.boundaryDistance <= distance);
  TAUTLINE_CHECK(result.history.back().edgesInRange > 0.85);
  TAUTLINE_CHECK(output.numberOfCells() > 2 * data.numberOfCells());
  // Measured: 0.6 % less.
  TAUTLINE_CHECK_RELATIVE(volumeOf(output), volumeOf(data), 0.01);
}

//------------------------------------------------------------------------------
/// A cube with two regions, facets with classes on all sides and on a part of a plane inside.
struct Tagged
{
  MeshData data;
  std::vector<Index> regions;
  std::vector<std::array<Index, 3>> facets;
  std::vector<std::int32_t> classes;
};

/// 1 to 6: the sides, 7: the part of the side z = 1 with x < 0.5, 8: the plane x = 0.75 for y below
/// 0.5, 0: none.
std::int32_t classAt(const std::array<Vec3, 3>& x)
{
  const auto all = [&x](int axis, double value)
  {
    return std::all_of(
      x.begin(), x.end(), [=](const Vec3& p) { return std::abs(p[axis] - value) < 1e-14; });
  };
  const Vec3 center = (1.0 / 3.0) * (x[0] + x[1] + x[2]);
  for (int axis = 0; axis < 3; ++axis)
  {
    for (int side = 0; side < 2; ++side)
    {
      if (all(axis, side))
      {
        return axis == 2 && side == 1 && center[0] < 0.5 ? 7 : 2 * axis + side + 1;
      }
    }
  }
  return all(0, 0.75) && center[1] < 0.5 ? 8 : 0;
}

Tagged taggedCube(Index n)
{
  Tagged tagged;
  tagged.data = unitCube(n);
  std::set<std::array<Index, 3>> known;
  for (Index c = 0; c < tagged.data.numberOfCells(); ++c)
  {
    const Index* v = &tagged.data.connectivity[4 * c];
    Vec3 center = { 0, 0, 0 };
    for (int i = 0; i < 4; ++i)
    {
      center += 0.25 * tagged.data.point(v[i]);
    }
    tagged.regions.push_back(center[2] < 0.5 ? 3 : 8);
    for (const auto& f : OppositeFace)
    {
      std::array<Index, 3> facet = { v[f[0]], v[f[1]], v[f[2]] };
      std::sort(facet.begin(), facet.end());
      const std::int32_t kind = classAt(
        { tagged.data.point(facet[0]), tagged.data.point(facet[1]), tagged.data.point(facet[2]) });
      if (kind > 0 && known.insert(facet).second)
      {
        tagged.facets.push_back(facet);
        tagged.classes.push_back(kind);
      }
    }
  }
  return tagged;
}

double areaOf(const Vec3& a, const Vec3& b, const Vec3& c)
{
  return 0.5 * norm(cross(b - a, c - a));
}

/// The area of each class, and whether each facet is where its class is.
std::map<std::int32_t, double> areasOf(const MeshData& data, const std::vector<Index>& facets,
  const std::function<std::int32_t(std::size_t)>& classOf)
{
  std::map<std::int32_t, double> areas;
  for (std::size_t f = 0; f < facets.size() / 3; ++f)
  {
    const Vec3 a = data.point(facets[3 * f]), b = data.point(facets[3 * f + 1]),
               c = data.point(facets[3 * f + 2]);
    areas[classOf(f)] += areaOf(a, b, c);
  }
  return areas;
}

std::map<Index, double> volumesOf(const MeshData& data, const std::function<Index(Index)>& regionOf)
{
  std::map<Index, double> volumes;
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    volumes[regionOf(c)] += volumeOf(data, c);
  }
  return volumes;
}

/// Regions keep their volumes, classes of facets their areas, however fine or coarse the mesh is.
TAUTLINE_PART(testTags)
{
  for (const auto& [cubes, size] :
    { std::pair<Index, double>{ 4, 0.1 }, std::pair<Index, double>{ 12, 0.25 } })
  {
    const Tagged tagged = taggedCube(cubes);
    ReconnectionOptions options = optionsOf(ReconnectionPreset::Adapt);
    TAUTLINE_SET(options, boundary = BoundaryMotion::FlatParts, size = ReconnectionSize::Length,
      edgeLength = size, regions = tagged.regions.data(), markedFacets = tagged.facets,
      markedClasses = tagged.classes);
    const ReconnectionResult result = reconnect(tagged.data, options);
    const MeshData output = outputOf(result);
    checkArrays(output, result);
    TAUTLINE_CHECK(result.history.back().edgesInRange > 0.8);
    const auto volumes =
      volumesOf(output, [&](Index c) { return tagged.regions[result.originalCells[c]]; });
    TAUTLINE_CHECK_EQUAL(volumes.size(), std::size_t(2));
    TAUTLINE_CHECK_NEAR(volumes.at(3), 0.5, 1e-13);
    TAUTLINE_CHECK_NEAR(volumes.at(8), 0.5, 1e-13);
    const auto areas = areasOf(output, result.facets,
      [&](std::size_t f) { return tagged.classes[result.originalFacets[f]]; });
    TAUTLINE_CHECK_EQUAL(areas.size(), std::size_t(8));
    for (std::int32_t kind : { 1, 2, 3, 4, 5 })
    {
      TAUTLINE_CHECK_NEAR(areas.at(kind), 1.0, 1e-12);
    }
    for (std::int32_t kind : { 6, 7, 8 })
    {
      TAUTLINE_CHECK_NEAR(areas.at(kind), 0.5, 1e-12);
    }
    // Each facet is a face of a tetrahedron, and in the place of its class.
    std::set<std::array<Index, 3>> faces;
    for (Index c = 0; c < output.numberOfCells(); ++c)
    {
      for (const auto& f : OppositeFace)
      {
        const Index* v = &output.connectivity[4 * c];
        std::array<Index, 3> key = { v[f[0]], v[f[1]], v[f[2]] };
        std::sort(key.begin(), key.end());
        faces.insert(key);
      }
    }
    for (std::size_t f = 0; f < result.originalFacets.size(); ++f)
    {
      std::array<Index, 3> key = { result.facets[3 * f], result.facets[3 * f + 1],
        result.facets[3 * f + 2] };
      TAUTLINE_CHECK_EQUAL(
        classAt({ output.point(key[0]), output.point(key[1]), output.point(key[2]) }),
        tagged.classes[result.originalFacets[f]]);
      std::sort(key.begin(), key.end());
      TAUTLINE_CHECK(faces.count(key) == 1);
    }
  }
}

/// Two tetrahedra that have only an edge in common: it stays whole, as a point on it would be a
/// point of one of them only.
TAUTLINE_PART(testPinchedEdge)
{
  MeshData data;
  data.addPoints({ { 0, 0, 0 }, { 0, 0, 1 }, { 1, -0.5, 0.5 }, { 1, 0.5, 0.5 }, { -1, 0.5, 0.5 },
    { -1, -0.5, 0.5 } });
  data.addCell(CellType::Tetrahedron, { 0, 1, 3, 2 });
  data.addCell(CellType::Tetrahedron, { 0, 1, 5, 4 });
  for (Index c = 0; c < 2; ++c)
  {
    if (volumeOf(data, c) < 0.0)
    {
      std::swap(data.connectivity[4 * c + 2], data.connectivity[4 * c + 3]);
    }
  }
  const ReconnectionResult result = adapt(data, [](const Vec3&) { return isotropicMetric(0.3); });
  const MeshData output = outputOf(result);
  checkArrays(output, result);
  TAUTLINE_CHECK(output.numberOfCells() > 10);
  for (Index p = 0; p < output.numberOfPoints(); ++p)
  {
    const Vec3 x = output.point(p);
    TAUTLINE_CHECK(x[0] != 0.0 || x[1] != 0.0 || x[2] == 0.0 || x[2] == 1.0);
  }
}

/// A flat tetrahedron on the boundary is accepted, and removed.
TAUTLINE_PART(testFlat)
{
  MeshData data = unitCube(3);
  // On a square of the side z = 1: its corners.
  const auto idAt = [&](const Vec3& x)
  {
    Index p = 0;
    while (norm(data.point(p) - x) > 1e-9)
    {
      ++p;
    }
    return p;
  };
  const double a = 1.0 / 3.0, b = 2.0 / 3.0;
  const std::array<Index, 4> corners = { idAt({ a, a, 1 }), idAt({ b, a, 1 }), idAt({ b, b, 1 }),
    idAt({ a, b, 1 }) };
  data.addCell(CellType::Tetrahedron, { corners[1], corners[0], corners[2], corners[3] });
  const ReconnectionResult result = adapt(data, [](const Vec3&) { return isotropicMetric(0.2); });
  const MeshData output = outputOf(result);
  checkArrays(output, result);
  TAUTLINE_CHECK_RELATIVE(volumeOf(output), 1.0, 1e-13);
  TAUTLINE_CHECK(result.history.back().edgesInRange > 0.85);
}

/// Cells outside a part stay as they are, with their points.
TAUTLINE_PART(testPart)
{
  const MeshData data = unitCube(6);
  std::vector<unsigned char> outside;
  std::set<std::array<Vec3, 4>> kept;
  const auto cornersOf = [](const MeshData& mesh, Index c)
  {
    std::array<Vec3, 4> x;
    for (int i = 0; i < 4; ++i)
    {
      x[i] = mesh.point(mesh.connectivity[4 * c + i]);
    }
    std::sort(x.begin(), x.end());
    return x;
  };
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    const std::array<Vec3, 4> x = cornersOf(data, c);
    outside.push_back(x[0][0] + x[1][0] + x[2][0] + x[3][0] > 2.0);
    if (outside.back())
    {
      kept.insert(x);
    }
  }
  const std::vector<double> tensors =
    tensorsOf(data, [](const Vec3&) { return isotropicMetric(0.1); });
  ReconnectionOptions options = adaptOptions(tensors);
  options.outside = outside.data();
  const ReconnectionResult result = reconnect(data, options);
  const MeshData output = outputOf(result);
  checkArrays(output, result);
  TAUTLINE_CHECK_RELATIVE(volumeOf(output), 1.0, 1e-13);
  TAUTLINE_CHECK(output.numberOfCells() > 2 * data.numberOfCells());
  std::size_t found = 0;
  for (Index c = 0; c < output.numberOfCells(); ++c)
  {
    if (outside[result.originalCells[c]])
    {
      found += kept.count(cornersOf(output, c));
    }
  }
  TAUTLINE_CHECK_EQUAL(found, kept.size());
}

/// Points of the output store their positions in the input.
TAUTLINE_PART(testInterpolation)
{
  const MeshData data = unitCube(4);
  const ReconnectionResult result = adapt(data, polarMetric);
  const MeshData output = outputOf(result);
  auto place = result.interpolations.begin();
  for (Index p = 0; p < output.numberOfPoints(); ++p)
  {
    const Index original = result.originalPoints[p];
    if (original >= 0)
    {
      TAUTLINE_CHECK(output.point(p) == data.point(original));
      continue;
    }
    TAUTLINE_CHECK_EQUAL(place->point, p);
    Vec3 x = { 0, 0, 0 };
    for (int i = 0; i < 4; ++i)
    {
      x += place->weights[i] * data.point(data.connectivity[4 * place->cell + i]);
      TAUTLINE_CHECK(place->weights[i] > -1e-9);
    }
    TAUTLINE_CHECK_NEAR(norm(x - output.point(p)), 0.0, 1e-13);
    ++place;
  }
  TAUTLINE_CHECK(place == result.interpolations.end());
}

TAUTLINE_PART(testSameEachTime)
{
  const MeshData data = unitCube(4);
  const std::vector<double> tensors = tensorsOf(data, polarMetric);
  ReconnectionOptions options = adaptOptions(tensors);
  options.threads = 1;
  const ReconnectionResult one = reconnect(data, options);
  options.threads = 4;
  const ReconnectionResult other = reconnect(data, options);
  TAUTLINE_CHECK(one.points == other.points);
  TAUTLINE_CHECK(one.tetrahedra == other.tetrahedra);
}

/// A run that is ended returns a valid mesh.
TAUTLINE_PART(testStops)
{
  const MeshData data = unitCube(6);
  const std::vector<double> tensors = tensorsOf(data, linearMetric);
  ReconnectionOptions options = adaptOptions(tensors);
  int calls = 0;
  options.observer = [&calls](const ReconnectionRecord&, double) { return ++calls < 3; };
  const ReconnectionResult aborted = reconnect(data, options);
  TAUTLINE_CHECK(aborted.reason == StopReason::Aborted);
  checkArrays(outputOf(aborted), aborted);
  TAUTLINE_CHECK_RELATIVE(volumeOf(outputOf(aborted)), 1.0, 1e-13);
  options.observer = nullptr;
  options.maximumSeconds = 1e-3;
  const ReconnectionResult late = reconnect(data, options);
  TAUTLINE_CHECK(late.reason == StopReason::TimeLimit);
  checkArrays(outputOf(late), late);
}

TAUTLINE_PART(testErrors)
{
  const MeshData data = unitCube(2);
  ReconnectionOptions options = optionsOf(ReconnectionPreset::Adapt);
  TAUTLINE_CHECK_THROWS(reconnect(data, options), wording("adaptation-needs-lengths"));
  options.size = ReconnectionSize::Metrics;
  TAUTLINE_CHECK_THROWS(reconnect(data, options), wording("target-lengths-are-missing"));
  std::vector<double> tensors = tensorsOf(data, [](const Vec3&) { return isotropicMetric(0.5); });
  // More tetrahedra than there is memory for.
  const std::vector<double> tiny =
    tensorsOf(data, [](const Vec3&) { return isotropicMetric(1e-5); });
  options.sizes = tiny.data();
  TAUTLINE_CHECK_THROWS(reconnect(data, options), wording("an-adaptation-to-about"));
  tensors[2] = -1.0;
  options.sizes = tensors.data();
  TAUTLINE_CHECK_THROWS(
    reconnect(data, options), wording("metric-tensors-are-not-positive-definite"));
}

//------------------------------------------------------------------------------
/// A smooth metric with random axes and sizes.
class RandomMetric
{
public:
  explicit RandomMetric(unsigned seed)
  {
    Random random(seed);
    for (int k = 0; k < 6; ++k)
    {
      this->Mean[k] = random.uniform(-1.0, 1.0) + (k < 3 ? 4.0 : 0.0);
      this->Slope[k] = random.vector(-2.0, 2.0);
    }
  }
  /// exp of a linear function.
  MetricTensor operator()(const Vec3& x) const
  {
    MetricTensor m;
    for (int k = 0; k < 6; ++k)
    {
      m[k] = this->Mean[k] + dot(this->Slope[k], x);
    }
    return functionOf(m, [](double value) { return std::exp(value); });
  }

private:
  MetricTensor Mean;
  std::array<Vec3, 6> Slope;
};

/// Invariants of random operations: volumes of regions, areas of classes, the mesh itself.
void checkInvariants(const TetrahedronMesh& mesh, const std::vector<std::int32_t>& classes)
{
  TAUTLINE_CHECK_EQUAL(mesh.findViolation(), "");
  std::map<std::int32_t, double> volumes, areas;
  for (TetId t = 0; t < mesh.slots(); ++t)
  {
    if (!mesh.alive(t))
    {
      continue;
    }
    const TetVertices& v = mesh.tet(t).vertices;
    volumes[mesh.region(t)] +=
      measure(mesh.point(v[0]), mesh.point(v[1]), mesh.point(v[2]), mesh.point(v[3])).determinant /
      6.0;
    for (int i = 0; i < 4; ++i)
    {
      const std::int32_t n = mesh.tet(t).neighbors[i];
      if (mesh.label(t, i) != NoLabel && (n == NoId || n >> 2 > t))
      {
        const TriangleVertices f = mesh.face(t, i);
        areas[classes[mesh.label(t, i)]] +=
          areaOf(mesh.point(f[0]), mesh.point(f[1]), mesh.point(f[2]));
      }
    }
  }
  TAUTLINE_CHECK_NEAR(volumes[0], 0.5, 1e-12);
  TAUTLINE_CHECK_NEAR(volumes[1], 0.5, 1e-12);
  for (std::int32_t kind = 1; kind <= 8; ++kind)
  {
    TAUTLINE_CHECK_NEAR(areas[kind], kind > 5 ? 0.5 : 1.0, 1e-11);
  }
}

/// Splits, contractions, swaps and motions at random places of a tagged cube.
void checkRandomOperations(unsigned seed, int count, int interval)
{
  const Tagged tagged = taggedCube(4);
  const RandomMetric metric(seed);
  ReconnectionInput input;
  std::vector<MetricTensor> metrics;
  for (Index p = 0; p < tagged.data.numberOfPoints(); ++p)
  {
    input.points.push_back(tagged.data.point(p));
    metrics.push_back(metric(tagged.data.point(p)));
  }
  std::vector<TriangleVertices> facets;
  for (Index c = 0; c < tagged.data.numberOfCells(); ++c)
  {
    const Index* v = &tagged.data.connectivity[4 * c];
    input.cells.push_back({ static_cast<PointId>(v[0]), static_cast<PointId>(v[1]),
      static_cast<PointId>(v[2]), static_cast<PointId>(v[3]) });
    input.regions.push_back(tagged.regions[c] == 3 ? 0 : 1);
  }
  std::vector<std::int32_t> classes = { 0 };
  for (std::size_t f = 0; f < tagged.facets.size(); ++f)
  {
    const std::array<Index, 3>& v = tagged.facets[f];
    facets.push_back(
      { static_cast<PointId>(v[0]), static_cast<PointId>(v[1]), static_cast<PointId>(v[2]) });
    classes.push_back(tagged.classes[f]);
  }
  QualityWeights weights;
  weights.inMetric = true;
  TetrahedronMesh mesh(input.points, input.cells, input.regions, weights, 1, metrics);
  const InputLocator locator(mesh, input);
  mesh.labelFaces(facets, true);
  CavityOperations operations(mesh);
  constexpr double flat = 1e-9;
  operations.freedoms = findFreedoms(mesh, true, flat);
  keepBorders(mesh, classes, flat, operations.freedoms);
  TAUTLINE_SET(operations, classes = classes, flatTolerance = flat, swapsBoundary = true,
    edgeFactor = 1.6, smallestSize = 0, largestSize = 1000000,
    field = std::make_shared<InputMetric>(metrics, input, locator, 1));
  operations.prepareStamps();
  Random random(seed + 1);
  std::array<int, 5> done = {};
  for (int n = 0; n < count; ++n)
  {
    const auto t = static_cast<TetId>(random.integer(mesh.slots()));
    if (!mesh.alive(t))
    {
      continue;
    }
    const int i = static_cast<int>(random.integer(4)),
              j = (i + 1 + static_cast<int>(random.integer(3))) % 4;
    // Splits and contractions about as often as each other.
    const int kind = static_cast<int>(random.integer(6));
    const bool large = mesh.size() > 2500;
    switch (kind)
    {
      case 0:
        done[0] += !large && operations.splitEdge(t, i, j);
        break;
      case 1:
        done[1] += operations.contractEdge(t, i, j);
        break;
      case 2:
        done[2] += operations.removeEdge(t, i, j);
        break;
      case 3:
        done[3] += operations.removeFaces(t, i);
        break;
      case 4:
        done[4] += operations.relax(mesh.tet(t).vertices[i]);
        break;
      default:
        done[4] += operations.smooth(mesh.tet(t).vertices[i], 2);
        break;
    }
    if (n % interval == 0)
    {
      checkInvariants(mesh, classes);
    }
  }
  checkInvariants(mesh, classes);
  for (int number : done)
  {
    TAUTLINE_CHECK(number > 0);
  }
}

TAUTLINE_PART(testRandomOperations)
{
  for (unsigned seed : { 1u, 2u, 3u })
  {
    checkRandomOperations(seed, 4000, 20);
  }
}

TAUTLINE_PART_SLOW(testManyRandomOperations)
{
  for (unsigned seed = 11; seed < 21; ++seed)
  {
    checkRandomOperations(seed, 10000, 1);
  }
}
}
