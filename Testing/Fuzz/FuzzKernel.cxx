// SPDX-License-Identifier: BSD-3-Clause
// Elements and meshes of arbitrary numbers: finite metrics, statistics, points; no element becomes
// inverted that was valid.

#include "FuzzTargets.h"
#include "Meshes.h"

#include "tautline/Optimization/Optimize.h"
#include "tautline/Quality/MetricField.h"
#include "tautline/Quality/Statistics.h"
#include "tautline/Untangling/Untangle.h"

#include <cmath>

namespace tautline
{
namespace
{
constexpr int MaxCells = 12;
const CellType Types[] = { CellType::Triangle, CellType::Quadrilateral, CellType::Tetrahedron,
  CellType::Hexahedron, CellType::Wedge, CellType::Pyramid };

bool allFinite(const std::vector<double>& values)
{
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

/// A coordinate: any number, or one of few that make repeated points likely.
double coordinate(ByteReader& input, bool any)
{
  return any ? input.next<double>() : input.next<signed char>() / 16.0;
}
}

//------------------------------------------------------------------------------
void fuzzQuality(std::string_view bytes)
{
  ByteReader input(bytes);
  const CellType type = Types[input.choice(6)];
  const std::vector<MetricInfo> registry = elementMetrics();
  const MetricInfo& info = registry[input.next<unsigned char>() % registry.size()];
  EvaluationOptions options;
  const bool combines = info.family == MetricFamily::Target && topology(type).samples > 1;
  options.combination = static_cast<Combination>(combines ? input.choice(3) : 0);
  options.power = 1 + input.choice(8);
  const bool any = input.choice(2) == 0;
  const bool flat = topology(type).dimension == 2 && input.choice(2) == 0;
  MeshData data;
  for (int i = 0; i < MaxCells && (i == 0 || !input.atEnd()); ++i)
  {
    std::vector<Vec3> corners(static_cast<std::size_t>(topology(type).nodes));
    for (Vec3& p : corners)
    {
      p = { coordinate(input, any), coordinate(input, any), flat ? 0 : coordinate(input, any) };
    }
    data.addCell(type, corners);
  }
  const Mesh mesh(data.view());
  const std::vector<signed char> validity = validityOf(mesh);
  if (!info.definedOn(type) || (!info.rotationInvariant && mesh.dimension() == Dimension::Surface))
  {
    return;
  }
  const Gradients g = gradientsOf(mesh, info.metric, options);
  expectThat(allFinite(g.values) && allFinite(g.gradients), "values and gradients are finite");
  const std::vector<double> values = valuesOf(mesh, info.metric, options);
  expectThat(allFinite(values), "values are finite");
  const CellValues cells = { mesh.view().numberOfCells, values.data(), validity.data(),
    mesh.view().cellTypes, nullptr };
  const std::vector<double> measured = measuredValues(info, cells);
  const MetricStatistics s = summarize(info, 3, measured);
  expectThat(
    s.minimum <= s.maximum && !std::isnan(s.mean) && !std::isnan(s.rms), "statistics are numbers");
  expectThat(allFinite(histogram(measured, 1 + input.choice(20)).edges), "bins are finite");
}

//------------------------------------------------------------------------------
void fuzzMesh(std::string_view bytes)
{
  // Any connectivity: Mesh rejects it, or everything it derives is in range.
  ByteReader input(bytes);
  MeshData data;
  const int points = input.choice(40);
  for (int i = 0; i < points; ++i)
  {
    data.addPoint({ coordinate(input, false), coordinate(input, false), coordinate(input, false) });
  }
  for (int i = 0; i < MaxCells && !input.atEnd(); ++i)
  {
    const auto type = input.next<unsigned char>();
    std::vector<Index> nodes(static_cast<std::size_t>(input.choice(28)));
    for (Index& node : nodes)
    {
      node = input.next<signed char>();
    }
    data.addCell(type, nodes);
  }
  if (input.choice(4) == 0 && data.offsets.size() > 1)
  {
    data.offsets[input.next<unsigned char>() % (data.offsets.size() - 1)] =
      input.next<signed char>();
  }
  try
  {
    const Mesh mesh(data.view());
    const std::vector<signed char> validity = validityOf(mesh);
    const Orientation orientation = mesh.orientation(validity.data());
    expectThat(orientation.reversedParts <= orientation.parts, "parts are counted");
    expectThat(mesh.boundary().isBoundaryPoint.size() == static_cast<std::size_t>(points),
      "a flag per point");
    gradientsOf(mesh, Metric::ScaledJacobian);
  }
  catch (const Error&)
  {
    // a view that is no mesh
  }
}

//------------------------------------------------------------------------------
void fuzzMove(std::string_view bytes)
{
  // A block of quadrilaterals, triangles or tetrahedra whose points are displaced arbitrarily.
  ByteReader input(bytes);
  const int side = 3 + input.choice(2);
  const bool solid = input.choice(2) == 0, any = input.choice(8) == 0;
  MeshData data;
  const auto id = [side](int i, int j, int k) -> Index { return i + side * (j + side * k); };
  const int layers = solid ? side : 1;
  for (int k = 0; k < layers; ++k)
  {
    for (int j = 0; j < side; ++j)
    {
      for (int i = 0; i < side; ++i)
      {
        const double z = solid ? k + coordinate(input, any) : 0;
        data.addPoint({ i + coordinate(input, any), j + coordinate(input, any), z });
      }
    }
  }
  for (int k = 0; k + 1 < std::max(layers, 2); ++k)
  {
    for (int j = 0; j + 1 < side; ++j)
    {
      for (int i = 0; i + 1 < side; ++i)
      {
        if (solid)
        {
          const Index a = id(i, j, k), g = id(i + 1, j + 1, k + 1);
          const Index ring[] = { id(i + 1, j, k), id(i + 1, j + 1, k), id(i, j + 1, k),
            id(i, j + 1, k + 1), id(i, j, k + 1), id(i + 1, j, k + 1) };
          for (int n = 0; n < 6; ++n)
          {
            data.addCell(
              static_cast<int>(CellType::Tetrahedron), { a, ring[n], ring[(n + 1) % 6], g });
          }
        }
        else
        {
          data.addCell(static_cast<int>(CellType::Triangle),
            { id(i, j, 0), id(i + 1, j, 0), id(i + 1, j + 1, 0) });
          data.addCell(static_cast<int>(CellType::Triangle),
            { id(i, j, 0), id(i + 1, j + 1, 0), id(i, j + 1, 0) });
        }
      }
    }
  }
  try
  {
    const Mesh mesh(data.view());
    UntangleOptions untangling;
    untangling.effort = Effort::Local;
    untangling.threads = 1;
    const UntangleResult valid = untangle(mesh, untangling);
    expectThat(valid.invertedAfter <= valid.invertedBefore, "untangling adds no inverted element");
    OptimizeOptions options;
    options.threads = 1;
    options.stopping.maximumIterations = 5;
    const OptimizeResult better = optimize(mesh, options);
    expectThat(better.invertedAfter <= better.invertedBefore, "no element becomes inverted");
    if (allFinite(data.points))
    {
      expectThat(allFinite(valid.points) && allFinite(better.points), "points stay finite");
    }
  }
  catch (const Error&)
  {
    // rejected by name
  }
}
}
