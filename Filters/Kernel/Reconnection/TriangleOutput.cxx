// SPDX-License-Identifier: BSD-3-Clause
#include "TriangleInput.h"

#include <limits>
#include <queue>
#include <set>

namespace tautline
{
namespace
{
/// Cells visited in the search for a point.
constexpr int MaxVisited = 300;

/// A place in a triangle: the weights of its corners, and the squared distance from the point.
struct Place
{
  std::array<double, 3> weights = { 1, 0, 0 };
  double distance2 = 0;
};

/// The point of a triangle closest to x (C. Ericson, "Real-time collision detection", 5.1.5).
Place closestIn(const std::array<Vec3, 3>& p, const Vec3& x)
{
  const Vec3 u = p[1] - p[0], v = p[2] - p[0], w = x - p[0];
  const Vec3 n = cross(u, v);
  const double n2 = dot(n, n);
  Place place;
  place.weights[1] = dot(cross(w, v), n) / n2;
  place.weights[2] = dot(cross(u, w), n) / n2;
  place.weights[0] = 1.0 - place.weights[1] - place.weights[2];
  if (std::min({ place.weights[0], place.weights[1], place.weights[2] }) < 0.0)
  {
    place.distance2 = std::numeric_limits<double>::max();
    for (int i = 0; i < 3; ++i)
    {
      const Vec3 edge = p[Next[i]] - p[i];
      const double s = std::clamp(dot(x - p[i], edge) / dot(edge, edge), 0.0, 1.0);
      const Vec3 d = x - (p[i] + s * edge);
      if (dot(d, d) < place.distance2)
      {
        place.distance2 = dot(d, d);
        place.weights = { 0, 0, 0 };
        place.weights[i] = 1.0 - s;
        place.weights[Next[i]] = s;
      }
    }
    return place;
  }
  const Vec3 d = dot(w, n) / n2 * n;
  place.distance2 = dot(d, d);
  return place;
}

/// Finds the triangle of the input that contains a point, or is closest to it.
class TriangleLocator
{
public:
  TriangleLocator(const TriangleMesh& mesh, const TriangleInput& input)
    : Mesh(mesh)
    , Input(input)
  {
  }

  /// Looks at cells around `start`, of its region and patch, the closest ones first.
  TriId locate(const Vec3& x, TriId start, Place& best) const
  {
    using Candidate = std::pair<double, TriId>;
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue;
    std::set<TriId> known = { start };
    best = this->placeIn(start, x);
    TriId nearest = start;
    queue.push({ best.distance2, start });
    for (int visited = 0; !queue.empty() && visited < MaxVisited; ++visited)
    {
      const TriId t = queue.top().second;
      queue.pop();
      const Place place = this->placeIn(t, x);
      if (place.distance2 < best.distance2 || (place.distance2 == best.distance2 && t < nearest))
      {
        best = place;
        nearest = t;
      }
      if (this->Input.planar && best.distance2 == 0.0)
      {
        break;
      }
      for (int i = 0; i < 3; ++i)
      {
        const std::int32_t n = this->Mesh.triangle(t).neighbors[i];
        if (!this->Mesh.isWall(t, i) && known.insert(n >> 2).second)
        {
          queue.push({ this->placeIn(n >> 2, x).distance2, n >> 2 });
        }
      }
    }
    return nearest;
  }

private:
  Place placeIn(TriId t, const Vec3& x) const
  {
    const Corners& v = this->Input.cells[t];
    const std::vector<Vec3>& p = this->Input.points;
    return closestIn({ p[v[0]], p[v[1]], p[v[2]] }, x);
  }

  const TriangleMesh& Mesh;
  const TriangleInput& Input;
};

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
    if (original && changed.point(v) == input.points[v])
    {
      x = pointOf(view, v);
    }
    else
    {
      x = input.leave(mesh, changed.point(v));
    }
    result.points.insert(result.points.end(), x.begin(), x.end());
    result.originalPoints.push_back(original ? v : -1);
  }
  return numbers;
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
  Place place;
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
      original = locator.locate(centroid, changed.triangle(t).origin, place);
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
  for (auto p = static_cast<VertexId>(mesh.view().numberOfPoints); p < changed.pointSlots(); ++p)
  {
    if (numbers[p] < 0)
    {
      continue;
    }
    PointInterpolation added;
    added.point = numbers[p];
    added.cell =
      locator.locate(changed.point(p), changed.triangle(changed.triangleOf(p)).origin, place);
    std::copy(place.weights.begin(), place.weights.end(), added.weights.begin());
    if (mesh.mirrored() && input.planar)
    {
      std::swap(added.weights[1], added.weights[2]);
    }
    result.interpolations.push_back(added);
  }
}
}
