// SPDX-License-Identifier: BSD-3-Clause
// improveTriangles(): target lengths of edges, and overlaps for conservative transfer.

#include "Registry.h"
#include "Triangulating.h"

using namespace tautline;

namespace
{
using Preset = ReconnectionPreset;

/// Lengths of the edges at points that were inserted, all of them new.
std::vector<double> insertedLengths(const ReconnectionResult& result)
{
  const MeshData output = trianglesOf(result);
  std::vector<double> lengths;
  for (const auto& [edge, cells] : edgesOf(output))
  {
    if (result.originalPoints[edge[0]] < 0 || result.originalPoints[edge[1]] < 0)
    {
      lengths.push_back(norm(output.point(edge[1]) - output.point(edge[0])));
    }
  }
  return lengths;
}

/// The square turned into another plane: metrics are in space.
MeshData tilted(const MeshData& data, Vec3& first, Vec3& second)
{
  const double angle = 0.7;
  first = { std::cos(angle), 0.0, std::sin(angle) };
  second = { 0.0, 1.0, 0.0 };
  MeshData result = data;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    const Vec3 x = data.point(i);
    result.setPoint(i, x[0] * first + x[1] * second);
  }
  return result;
}

TAUTLINE_PART_SLOW(testSizes)
{
  const Context context("sizes");
  const MeshData data = delaunaySquare(60, 4);
  TriangleOptions options = triangleOptions(Preset::Aggressive);
  TAUTLINE_SET(options, smallestCount = 0.0, largestCount = 10.0, contract = false);
  const ReconnectionResult any = reconnect(data, options);
  const std::vector<double> lengths = insertedLengths(any);
  TAUTLINE_CHECK(lengths.size() > 20);
  const double shortest = *std::min_element(lengths.begin(), lengths.end());
  // Insertions leave no edge shorter than the target over the factor; then points move further.
  TAUTLINE_SET(options, size = ReconnectionSize::Length, edgeFactor = 1.25);
  options.edgeLength = 5.0 * shortest; // the counts of smaller ones depend on the rounding
  const ReconnectionResult fewer = reconnect(data, options);
  checkTriangles(data, fewer);
  TAUTLINE_CHECK(fewer.history.back().insertions > 0);
  TAUTLINE_CHECK(fewer.history.back().insertions < any.history.back().insertions);
  options.edgeLength = 10.0;
  TAUTLINE_CHECK_EQUAL(reconnect(data, options).history.back().insertions, Index(0));
  // Without motion the bound holds in the output.
  options.edgeLength = 2.0 * shortest;
  options.smooth = options.swap = options.swapEverywhere = false;
  TAUTLINE_EACH_OF(double length, insertedLengths(reconnect(data, options)),
    TAUTLINE_CHECK(length >= options.edgeLength / options.edgeFactor));

  options = triangleOptions(Preset::Aggressive);
  TAUTLINE_SET(options, smallestCount = 0.0, insert = false);
  const Index contracted = reconnect(data, options).history.back().contractions;
  TAUTLINE_SET(options, size = ReconnectionSize::Length, edgeLength = 0.01);
  TAUTLINE_CHECK(contracted > 0);
  TAUTLINE_CHECK_EQUAL(reconnect(data, options).history.back().contractions, Index(0));
  options.size = ReconnectionSize::Input;
  const ReconnectionResult own = reconnect(data, options);
  checkTriangles(data, own);
  TAUTLINE_CHECK(own.points != reconnect(data, triangleOptions(Preset::Aggressive)).points);
}

/// A length per point is the tensor with that length; tensors are in space, not in the plane.
TAUTLINE_PART(testMetrics)
{
  const Context context("metrics");
  Vec3 first, second;
  const MeshData data = tilted(delaunaySquare(60, 4), first, second);
  TriangleOptions options = triangleOptions(Preset::Aggressive);
  options.largestCount = 10.0;
  const double length = 0.1, entry = 1.0 / (length * length);
  std::vector<double> lengths(data.numberOfPoints(), length), tensors, stretched;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    tensors.insert(tensors.end(), { entry, entry, entry, 0.0, 0.0, 0.0 });
    // Along the normal of the plane a hundred times shorter: of no effect.
    const Vec3 n = cross(first, second);
    const double more = 1e4 * entry;
    stretched.insert(stretched.end(),
      { entry + more * n[0] * n[0], entry + more * n[1] * n[1], entry + more * n[2] * n[2],
        more * n[0] * n[1], more * n[1] * n[2], more * n[0] * n[2] });
  }
  TAUTLINE_SET(options, size = ReconnectionSize::Length, edgeLength = length);
  const ReconnectionResult expected = reconnect(data, options);
  TAUTLINE_CHECK(expected.history.back().insertions > 0);
  TAUTLINE_SET(options, size = ReconnectionSize::Lengths, sizes = lengths.data());
  TAUTLINE_CHECK(reconnect(data, options).points == expected.points);
  TAUTLINE_SET(options, size = ReconnectionSize::Metrics, sizes = tensors.data());
  TAUTLINE_CHECK(reconnect(data, options).triangles == expected.triangles);
  options.sizes = stretched.data();
  TAUTLINE_CHECK(reconnect(data, options).triangles == expected.triangles);
  for (std::size_t i = 0; i < tensors.size(); i += 6)
  {
    tensors[i + 1] = 1e-4 * entry; // a hundred times longer along y
  }
  options.sizes = tensors.data();
  TAUTLINE_CHECK(reconnect(data, options).triangles != expected.triangles);
  lengths[4] = 0.0;
  TAUTLINE_SET(options, size = ReconnectionSize::Lengths, sizes = lengths.data());
  TAUTLINE_CHECK_THROWS(reconnect(data, options), wording("1-target-lengths-of-edges-are-not"));
}

/// Rows sum to 1; original cells are those that overlap most.
void checkRows(const ReconnectionResult& result)
{
  const CellOverlaps& overlaps = result.overlaps;
  const auto cells = static_cast<Index>(result.originalCells.size());
  TAUTLINE_CHECK_EQUAL(static_cast<Index>(overlaps.offsets.size()), cells + 1);
  for (Index c = 0; c < cells; ++c)
  {
    double sum = 0.0, most = 0.0, own = 0.0;
    for (Index k = overlaps.offsets[c]; k < overlaps.offsets[c + 1]; ++k)
    {
      sum += overlaps.fractions[k];
      most = std::max(most, overlaps.fractions[k]);
      own = overlaps.cells[k] == result.originalCells[c] ? overlaps.fractions[k] : own;
    }
    TAUTLINE_CHECK_NEAR(sum, 1.0, 1e-12);
    TAUTLINE_CHECK_EQUAL(own, most);
    TAUTLINE_CHECK_EQUAL(overlaps.average(c, [](Index) { return 0.1; }), 0.1);
  }
}

double totalOf(const MeshData& data, const std::vector<double>& values)
{
  return sumOf<double>(
    0.0, data.numberOfCells(), [&](Index c) { return norm(areaVector(data, c)) * values[c]; });
}

std::vector<double> averages(const ReconnectionResult& result, const std::vector<double>& field)
{
  std::vector<double> values;
  for (std::size_t c = 0; c < result.originalCells.size(); ++c)
  {
    values.push_back(
      result.overlaps.average(static_cast<Index>(c), [&](Index i) { return field[i]; }));
  }
  return values;
}

/// In a plane, with two regions: every cell of the input is covered, totals of each region stay.
TAUTLINE_PART(testPlanarOverlaps)
{
  const Context context("planar overlaps");
  for (BoundaryMotion boundary : { BoundaryMotion::Fixed, BoundaryMotion::FlatParts })
  {
    const MeshData data = sliverSheet(8);
    std::vector<Index> regions;
    std::vector<double> field, first;
    Random random(11);
    for (Index c = 0; c < data.numberOfCells(); ++c)
    {
      regions.push_back(c >= data.numberOfCells() / 2);
      field.push_back(random.vector(1.0, 5.0)[0]);
      first.push_back(regions.back() == 0 ? field.back() : 0.0);
    }
    TriangleOptions options = triangleOptions(Preset::Aggressive);
    TAUTLINE_SET(options, boundary = boundary, regions = regions.data());
    TAUTLINE_CHECK(reconnect(data, options).overlaps.offsets.empty());
    TAUTLINE_SET(options, overlaps = true, threads = 1);
    const ReconnectionResult result = reconnect(data, options);
    checkTriangles(data, result);
    checkRows(result);
    const MeshData output = trianglesOf(result);
    std::vector<double> covered(data.numberOfCells(), 0.0);
    for (Index c = 0; c < output.numberOfCells(); ++c)
    {
      for (Index k = result.overlaps.offsets[c]; k < result.overlaps.offsets[c + 1]; ++k)
      {
        covered[result.overlaps.cells[k]] +=
          result.overlaps.fractions[k] * norm(areaVector(output, c));
        TAUTLINE_CHECK_EQUAL(regions[result.overlaps.cells[k]], regions[result.originalCells[c]]);
      }
    }
    TAUTLINE_EACH(Index, c, data.numberOfCells(),
      TAUTLINE_CHECK_NEAR(covered[c], norm(areaVector(data, c)), 1e-10));
    TAUTLINE_CHECK(result.history.back().moves > 0);
    TAUTLINE_CHECK_RELATIVE(totalOf(output, averages(result, field)), totalOf(data, field), 1e-12);
    TAUTLINE_CHECK_RELATIVE(totalOf(output, averages(result, first)), totalOf(data, first), 1e-12);
    // A copy of the cells' values does not keep the total.
    auto copied =
      collect<double>(result.originalCells, [&](Index original) { return field[original]; });
    TAUTLINE_CHECK(std::abs(totalOf(output, copied) / totalOf(data, field) - 1.0) > 1e-6);
    options.threads = 2;
    TAUTLINE_CHECK(reconnect(data, options).overlaps.fractions == result.overlaps.fractions);
  }
}

/// On a sphere: exact for constants, and totals to the change of the area.
TAUTLINE_PART(testSurfaceOverlaps)
{
  const Context context("surface overlaps");
  MeshData data = blockMesh(CellType::Triangle, 12, 12, 0);
  Random random(3);
  std::vector<double> field;
  for (Index i = 0; i < data.numberOfPoints(); ++i)
  {
    Vec3 x = (1.0 / 12.0) * (data.point(i) + random.vector(-0.2, 0.2));
    x[2] = std::sqrt(9.0 - x[0] * x[0] - x[1] * x[1]);
    data.setPoint(i, x);
  }
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    field.push_back(2.0 + std::sin(static_cast<double>(c)));
  }
  TriangleOptions options = TAUTLINE_CHANGED(triangleOptions(Preset::Aggressive), overlaps = true);
  const ReconnectionResult result = reconnect(data, options);
  checkTriangles(data, result);
  checkRows(result);
  TAUTLINE_CHECK(result.history.back().moves > 0);
  const MeshData output = trianglesOf(result);
  TAUTLINE_CHECK_RELATIVE(totalOf(output, averages(result, field)), totalOf(data, field), 5e-3);
}
}
