// SPDX-License-Identifier: BSD-3-Clause Volumes of the intersections of output and input
// tetrahedra.
#include "ReconnectionOutput.h"

#include "Constants.h"

#include "tautline/Core/Parallel.h"

#include <unordered_set>

namespace tautline
{
namespace
{
using Corners = std::array<Vec3, 4>;

constexpr Index TetrahedraPerChunk = 1024;

double volumeOf(const Corners& x)
{
  return dot(cross(x[1] - x[0], x[2] - x[0]), x[3] - x[0]);
}

/// The intersection of the plane with the edge from an inside corner to an outside one.
Vec3 cut(const Vec3& inside, double height, const Vec3& outside, double depth)
{
  return inside + (height / (height - depth)) * (outside - inside);
}

/// Six times the volume of a tetrahedron within half-spaces n . x >= d; cuts it into tetrahedra.
double clippedVolume(const Corners& x, const Vec3* normals, const double* positions, int planes)
{
  if (planes == 0)
  {
    return std::abs(volumeOf(x));
  }
  const auto rest = [&](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return clippedVolume({ a, b, c, d }, normals + 1, positions + 1, planes - 1);
  };
  // Sort the corners, inside ones first.
  std::array<Vec3, 4> v;
  std::array<double, 4> h;
  int inside = 0, outside = 4;
  for (const Vec3& corner : x)
  {
    const double height = dot(normals[0], corner) - positions[0];
    const int at = height >= 0.0 ? inside++ : --outside;
    v[at] = corner;
    h[at] = height;
  }
  const auto between = [&](int i, int j) { return cut(v[i], h[i], v[j], h[j]); };
  switch (inside)
  {
    case 0:
      return 0.0;
    case 1:
      return rest(v[0], between(0, 1), between(0, 2), between(0, 3));
    case 2:
    {
      // A wedge with the triangles (v0, a, b) and (v1, c, d).
      const Vec3 a = between(0, 2), b = between(0, 3), c = between(1, 2), d = between(1, 3);
      return rest(v[0], a, b, v[1]) + rest(a, b, v[1], c) + rest(b, v[1], c, d);
    }
    case 3:
    {
      // Without the cut corner, a wedge of three tetrahedra remains.
      const Vec3 a = between(0, 3), b = between(1, 3), c = between(2, 3);
      return rest(v[0], v[1], v[2], a) + rest(v[1], v[2], a, b) + rest(v[2], a, b, c);
    }
    default:
      return rest(v[0], v[1], v[2], v[3]);
  }
}

/// Six times the common volume of two tetrahedra.
double sharedVolume(const Corners& x, const Corners& y)
{
  Vec3 normals[4];
  double positions[4];
  for (int i = 0; i < 4; ++i)
  {
    const int* f = OppositeFace[i];
    const Vec3 n = cross(y[f[1]] - y[f[0]], y[f[2]] - y[f[0]]);
    normals[i] = dot(n, y[i] - y[f[0]]) < 0.0 ? -1.0 * n : n;
    positions[i] = dot(normals[i], y[f[0]]);
    // The plane of a face that separates both tetrahedra ends the test early.
    if (std::all_of(
          x.begin(), x.end(), [&](const Vec3& p) { return dot(normals[i], p) <= positions[i]; }))
    {
      return 0.0;
    }
  }
  return clippedVolume(x, normals, positions, 4);
}
}

OverlapRow InputLocator::overlaps(const Corners& corners, TetId start) const
{
  const double least = RoundingFraction * std::abs(volumeOf(corners));
  OverlapRow result;
  std::vector<TetId> queue = { start };
  std::unordered_set<TetId> known = { start };
  // The overlapped cells are connected, so the search only continues from cells with a common
  // volume.
  for (std::size_t i = 0; i < queue.size(); ++i)
  {
    const TetId t = queue[i];
    const TetVertices& v = this->Input.cells[t];
    const double volume = sharedVolume(corners,
      { this->Input.points[v[0]], this->Input.points[v[1]], this->Input.points[v[2]],
        this->Input.points[v[3]] });
    if (volume > least)
    {
      result.push_back({ t, volume });
    }
    if (volume <= least && i > 0)
    {
      continue;
    }
    for (std::int32_t n : this->Neighbors[t])
    {
      if (!this->isWall(n, t) && known.insert(n >> 2).second)
      {
        queue.push_back(n >> 2);
      }
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

void takeOverlaps(std::vector<OverlapRow>& rows, ReconnectionResult& result)
{
  for (std::size_t c = 0; c < rows.size(); ++c)
  {
    // An unchanged tetrahedron has no row yet: it consists of its original cell.
    if (rows[c].empty())
    {
      rows[c].push_back({ static_cast<std::int32_t>(result.originalCells[c]), 1.0 });
    }
  }
  CellOverlaps& overlaps = result.overlaps;
  overlaps.offsets.push_back(0);
  for (std::size_t c = 0; c < rows.size(); ++c)
  {
    double sum = 0.0, largest = 0.0;
    for (const auto& [cell, volume] : rows[c])
    {
      sum += volume;
      if (volume > largest)
      {
        largest = volume;
        result.originalCells[c] = cell;
      }
    }
    for (const auto& [cell, volume] : rows[c])
    {
      overlaps.cells.push_back(cell);
      overlaps.fractions.push_back(volume / sum);
    }
    overlaps.offsets.push_back(static_cast<Index>(overlaps.cells.size()));
  }
}

void computeOverlaps(const ReconnectionInput& input, const TetrahedronMesh& changed,
  const InputLocator& locator, int threads, ReconnectionResult& result)
{
  std::vector<TetId> tets;
  for (TetId t = 0; t < changed.slots(); ++t)
  {
    if (changed.alive(t))
    {
      tets.push_back(t);
    }
  }
  std::vector<OverlapRow> rows(tets.size());
  parallelFor(static_cast<Index>(tets.size()), TetrahedraPerChunk, threads,
    [&](Index c)
    {
      const TetVertices& v = changed.tet(tets[c]).vertices;
      const TetId original = static_cast<TetId>(result.originalCells[c]);
      if (!isUnchanged(input, changed, tets[c]))
      {
        rows[c] = locator.overlaps(
          { changed.point(v[0]), changed.point(v[1]), changed.point(v[2]), changed.point(v[3]) },
          original);
      }
    });
  takeOverlaps(rows, result);
}
}
