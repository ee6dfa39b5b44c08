// SPDX-License-Identifier: BSD-3-Clause
// Random cells with random, repeated, enormous, tiny and non-finite coordinates, and random views:
// never a crash, never a NaN, and what a cell gets does not depend on the cells beside it.
#include "Blocks.h"
#include "Registry.h"
#include "Sanitized.h"
#include "tautline/Quality/Statistics.h"

using namespace tautline;

namespace
{
constexpr int cellsPerMesh = 500;
/// For each cell type: 6 x 6 x 20 x 500 = 360,000 cells, under the sanitizers 36,000.
constexpr int meshesPerKind = TAUTLINE_ADDRESS_SANITIZER ? 2 : 20;
constexpr int malformedViews = 3000;
constexpr int fraction = 5; // of these in the fast run

enum Kind
{
  Anywhere,
  SmallIntegers, ///< many repeated points and flat cells
  Magnitudes,    ///< 1e-300 to 1e300
  NearlyFlat,
  Specials, ///< zeros, extremes, denormals, NaN, infinities
  Mixture,
  NumberOfKinds
};

double randomCoordinate(Kind kind, Random& random)
{
  static const double specials[] = { 0.0, -0.0, 1.0, -1.0, 1e150, -1e150, 1e-150, 1e300, 5e-324,
    std::numeric_limits<double>::max(), std::numeric_limits<double>::min(),
    std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
    std::numeric_limits<double>::quiet_NaN() };
  switch (kind)
  {
    case Anywhere:
      return random.uniform(-1, 1);
    case SmallIntegers:
      return static_cast<double>(random.integer(3));
    case Magnitudes:
      return std::pow(10, random.uniform(-300, 300)) * (random.integer(2) ? 1 : -1);
    case NearlyFlat:
      return 1 + random.uniform(-1, 1) * std::pow(10, random.uniform(-17, 0));
    case Specials:
      return specials[random.integer(std::size(specials))];
    default:
      return randomCoordinate(static_cast<Kind>(random.integer(Mixture)), random);
  }
}

MeshData randomCells(CellType type, Kind kind, bool flat, Random& random)
{
  MeshData data;
  for (int i = 0; i < cellsPerMesh; ++i)
  {
    std::vector<Vec3> corners(topology(type).nodes);
    for (Vec3& p : corners)
    {
      for (double& x : p)
      {
        x = randomCoordinate(kind, random);
      }
      p[2] = flat ? 0 : p[2];
    }
    data.addCell(type, corners);
  }
  return data;
}

bool allFinite(const std::vector<double>& values)
{
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

/// One of the codes of Validity, and NonFinite if a coordinate is.
void checkValidity(const MeshData& data, const std::vector<signed char>& validity)
{
  const int nodes = static_cast<int>(data.offsets[1]);
  for (Index i = 0; i < data.numberOfCells(); ++i)
  {
    TAUTLINE_CHECK(validity[i] == Valid || validity[i] == Degenerate || validity[i] == Inverted ||
      validity[i] == NonFinite);
    const bool finite = std::all_of(&data.points[3 * nodes * i],
      &data.points[3 * nodes * i] + 3 * nodes, [](double x) { return std::isfinite(x); });
    TAUTLINE_CHECK(finite || validity[i] == NonFinite);
  }
}

/// The first cells alone, in another place of the batch, have the same values.
void checkIndependence(CellType type, const MeshData& data, Dimension dimension, Metric metric,
  const EvaluationOptions& options, const std::vector<double>& values)
{
  constexpr Index some = 7;
  MeshData few;
  const int nodes = topology(type).nodes;
  for (Index i = 0; i < some; ++i)
  {
    auto corners =
      collect<Vec3>(nodes, [&](int k) { return data.point((some - 1 - i) * nodes + k); });
    few.addCell(type, corners);
  }
  const Mesh mesh(few.view());
  if (mesh.dimension() != dimension)
  {
    return; // a few cells may lie in a plane where many do not
  }
  const std::vector<double> again = valuesOf(mesh, metric, options);
  TAUTLINE_EACH(Index, i, some, TAUTLINE_CHECK_EQUAL(again[i], values[some - 1 - i]));
}

void checkStatistics(const Mesh& mesh, const MetricInfo& info, const std::vector<double>& values,
  const std::vector<signed char>& validity)
{
  const CellValues cells = { mesh.view().numberOfCells, values.data(), validity.data(),
    mesh.view().cellTypes, nullptr };
  std::vector<double> measured = measuredValues(info, cells);
  const Histogram h = histogram(measured, 10);
  TAUTLINE_CHECK(allFinite(h.edges));
  const MetricStatistics s = summarize(info, 3, measured);
  TAUTLINE_CHECK(s.minimum <= s.maximum);
  TAUTLINE_CHECK(!std::isnan(s.mean) && !std::isnan(s.rms) && !std::isnan(s.standardDeviation));
  TAUTLINE_CHECK(worstElements(info, cells).size() <= static_cast<std::size_t>(WorstCount));
}

void fuzzMetrics(CellType type, Kind kind, int round, Random& random)
{
  const bool flat = topology(type).dimension == 2 && round % 2 == 0;
  const MeshData data = randomCells(type, kind, flat, random);
  const Mesh mesh(data.view());
  const std::vector<signed char> validity = validityOf(mesh);
  checkValidity(data, validity);
  for (const MetricInfo& info : elementMetrics())
  {
    if (!info.definedOn(type) ||
      (!info.rotationInvariant && mesh.dimension() == Dimension::Surface))
    {
      continue;
    }
    const Context context(info.name);
    EvaluationOptions options;
    const bool combines = info.family == MetricFamily::Target && topology(type).samples > 1;
    options.combination = static_cast<Combination>(combines ? round % 3 : 0);
    options.power = 1 + round % 4;
    const Gradients g = gradientsOf(mesh, info.metric, options);
    TAUTLINE_CHECK(allFinite(g.values));
    TAUTLINE_CHECK(allFinite(g.gradients));
    const std::vector<double> values = valuesOf(mesh, info.metric, options);
    TAUTLINE_CHECK(allFinite(values));
    checkIndependence(type, data, mesh.dimension(), info.metric, options, values);
    checkStatistics(mesh, info, values, validity);
  }
  const auto angles = angleDistribution(mesh, validity.data(), nullptr);
  TAUTLINE_CHECK(std::all_of(angles.begin(), angles.end(), [](Index n) { return n >= 0; }));
}

/// Cells that share points at random, of all types at once.
void fuzzConnectivity(Random& random)
{
  MeshData data;
  const Index points = 1 + random.integer(30);
  for (Index i = 0; i < points; ++i)
  {
    data.addPoint(random.vector(-1, 1));
  }
  for (Index i = random.integer(40); i > 0; --i)
  {
    const int vtkType = random.integer(3) ? static_cast<int>(allTypes[random.integer(6)])
                                          : static_cast<int>(random.integer(256));
    std::vector<Index> nodes(random.integer(3) ? 8 : 27);
    std::for_each(nodes.begin(), nodes.end(), [&](Index& n) { n = random.integer(points); });
    data.addCell(vtkType, nodes);
  }
  const Mesh mesh(data.view());
  const std::vector<signed char> validity = validityOf(mesh);
  const Orientation o = mesh.orientation(validity.data());
  TAUTLINE_CHECK(o.reversedParts <= o.parts);
  const Boundary boundary = mesh.boundary();
  TAUTLINE_CHECK_EQUAL(boundary.isBoundaryPoint.size(), static_cast<std::size_t>(points));
  TAUTLINE_CHECK_EQUAL(
    mesh.vertexCells().cells.size(), static_cast<std::size_t>(mesh.vertexCells().offsets.back()));
  std::vector<double> gradient(3 * points);
  for (Metric metric : { Metric::InverseMeanRatio, Metric::ShapeNonBarrier, Metric::MinimumAngle })
  {
    const MetricSum sum(mesh, metric, {}, 2);
    TAUTLINE_CHECK(std::isfinite(sum.valueAndGradient(gradient.data())));
    TAUTLINE_CHECK(allFinite(gradient));
  }
}

/// Views with wrong ids and offsets either make a mesh or throw Error; nothing is read outside.
void fuzzViews(Random& random)
{
  MeshData data = blockMesh(allTypes[random.integer(6)], 2, 1, 1);
  for (Index damage = 1 + random.integer(3); damage > 0; --damage)
  {
    const Index size = static_cast<Index>(data.connectivity.size());
    switch (random.integer(3))
    {
      case 0:
        data.connectivity[random.integer(size)] = random.integer(40) - 10;
        break;
      case 1:
        data.offsets[random.integer(data.numberOfCells())] = random.integer(size + 1);
        break;
      default:
        data.types[random.integer(data.numberOfCells())] =
          static_cast<unsigned char>(random.integer(256));
    }
  }
  try
  {
    const Mesh mesh(data.view());
    validityOf(mesh);
    mesh.boundary();
    gradientsOf(mesh, Metric::ScaledJacobian);
  }
  catch (const Error& error)
  {
    TAUTLINE_CHECK(std::string(error.what()).find("Cell ") == 0);
  }
}
}

TAUTLINE_TEST(TestFuzz)
{
  Random random(18);
  for (CellType type : allTypes)
  {
    const Context context(topology(type).name);
    for (int kind = 0; kind < NumberOfKinds; ++kind)
    {
      for (int round = 0; round < meshesPerKind / (slowParts() ? 1 : fraction); ++round)
      {
        const Context name("kind " + std::to_string(kind) + ", round " + std::to_string(round));
        fuzzMetrics(type, static_cast<Kind>(kind), round, random);
      }
    }
  }
  for (int i = 0; i < malformedViews / (slowParts() ? 1 : fraction); ++i)
  {
    fuzzConnectivity(random);
    fuzzViews(random);
  }
}
