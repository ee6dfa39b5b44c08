// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleInput.h"

#include "TriangleLocator.h"

namespace tautline
{
namespace
{
/// Numbers the points of the output and writes them; returns the new number per slot, or -1.
std::vector<Index> writePoints(const Mesh& mesh, const TriangleInput& input,
  const TriangleMesh& before, const TriangleMesh& changed, ReconnectionResult& result)
{
  const MeshView& view = mesh.view();
  std::vector<Index> numbers(changed.pointSlots(), -1);
  Index count = 0;
  for (VertexId v = 0; v < changed.pointSlots(); ++v)
  {
    const bool original = v < view.numberOfPoints;
    if (!changed.used(v) && !(original && !before.used(v)))
    {
      continue;
    }
    numbers[v] = count++;
    Vec3 x = { 0, 0, 0 };
    const bool moved = original && changed.point(v) != input.points[v];
    if (original && !moved)
    {
      x = pointOf(view, v);
    }
    else
    {
      x = input.leave(mesh, changed.point(v));
    }
    result.points.insert(result.points.end(), x.begin(), x.end());
    result.originalPoints.push_back(original && !(moved && result.adapted) ? v : -1);
  }
  return numbers;
}

/// The edges that are given walls of the options, each once.
void writeLines(const TriangleInput& input, const TriangleMesh& changed,
  const std::vector<Index>& numbers, ReconnectionResult& result)
{
  // its ends, in increasing order, and the edge of which it is a part
  using Line = std::array<Index, 3>;
  std::vector<Line> lines;
  for (TriId t = 0; t < changed.slots(); ++t)
  {
    const Triangle& triangle = changed.triangle(t);
    for (int i = 0; changed.alive(t) && i < 3; ++i)
    {
      const std::int32_t line = triangle.lines[i];
      if (line != NoNumber && line < input.markedEdges)
      {
        const Index a = numbers[triangle.vertices[Next[i]]];
        const Index b = numbers[triangle.vertices[Previous[i]]];
        lines.push_back({ std::min(a, b), std::max(a, b), line });
      }
    }
  }
  std::sort(lines.begin(), lines.end());
  lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
  for (const Line& line : lines)
  {
    result.lines.insert(result.lines.end(), { line[0], line[1] });
    result.originalLines.push_back(line[2]);
  }
}
}

bool isUnchanged(const TriangleInput& input, const TriangleMesh& changed, TriId t)
{
  if (t >= static_cast<TriId>(input.cells.size()))
  {
    return false;
  }
  const Corners& v = input.cells[t];
  return changed.triangle(t).vertices == v &&
    std::all_of(
      v.begin(), v.end(), [&](VertexId p) { return changed.point(p) == input.points[p]; });
}

void convertOutput(const Mesh& mesh, const TriangleInput& input, const TriangleMesh& before,
  const TriangleMesh& changed, ReconnectionResult& result)
{
  const std::vector<Index> numbers = writePoints(mesh, input, before, changed, result);
  const TriangleLocator locator(before, input);
  TrianglePlace place;
  // If qualities are measured in metrics, origins are up to date.
  const int patience =
    changed.measuresInMetrics() ? TriangleLocator::Patience : TriangleLocator::MaxVisited;
  for (TriId t = 0; t < changed.slots(); ++t)
  {
    if (!changed.alive(t))
    {
      continue;
    }
    Corners v = changed.triangle(t).vertices;
    TriId original = t;
    if (!isUnchanged(input, changed, t))
    {
      const Vec3 centroid =
        (1.0 / 3.0) * (changed.point(v[0]) + changed.point(v[1]) + changed.point(v[2]));
      original = locator.nearest(centroid, changed.triangle(t).origin, place, patience);
    }
    result.originalCells.push_back(original);
    if (mesh.mirrored() && input.planar)
    {
      std::swap(v[1], v[2]);
    }
    for (VertexId p : v)
    {
      result.triangles.push_back(numbers[p]);
    }
  }
  writeLines(input, changed, numbers, result);
  for (VertexId p = 0; p < changed.pointSlots(); ++p)
  {
    if (numbers[p] < 0 || result.originalPoints[numbers[p]] >= 0)
    {
      continue;
    }
    PointInterpolation added;
    added.point = numbers[p];
    const TriId start = changed.measuresInMetrics()
      ? changed.metric(p).place
      : changed.triangle(changed.triangleOf(p)).origin;
    added.cell = locator.nearest(changed.point(p), start, place, patience);
    std::copy(place.weights.begin(), place.weights.end(), added.weights.begin());
    if (mesh.mirrored() && input.planar)
    {
      std::swap(added.weights[1], added.weights[2]);
    }
    result.interpolations.push_back(added);
  }
}
}
