// SPDX-License-Identifier: BSD-3-Clause
#include "InteractionLayer.h"

#include "PeridynamicsGeometry.h"
#include "tautline/Core/Memory.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Core/Random.h"
#include "tautline/Geometry/PlanarDelaunay.h"
#include "tautline/Geometry/SegmentDistance.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>

namespace tautline
{
namespace
{
constexpr double MinGap = 0.55; // of lattice points from the boundary, in element sizes
constexpr double Margin = 2.5;  // of lattice points beyond the width, in element sizes
// of lattice points, in element sizes, so that no four are cocircular
constexpr double Jitter = 0.02;
constexpr double MaxPoints = 5e6;
constexpr double BytesPerPoint = 300; // of the lattice, with its triangulation

using Edge = BoundaryEdge;

std::vector<Edge> boundaryEdges(const PlanarTriangles& mesh)
{
  // Edges of one triangle only.
  std::map<std::pair<Index, Index>, int> uses;
  for (const auto& t : mesh.triangles)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Index a = t[k], b = t[(k + 1) % 3];
      ++uses[{ std::min(a, b), std::max(a, b) }];
    }
  }
  std::vector<Edge> edges;
  for (const auto& t : mesh.triangles)
  {
    for (int k = 0; k < 3; ++k)
    {
      const Index a = t[k], b = t[(k + 1) % 3];
      if (uses[{ std::min(a, b), std::max(a, b) }] == 1)
      {
        edges.push_back({ mesh.points[a], mesh.points[b], a, b });
      }
    }
  }
  return edges;
}

/// The position of a point relative to the mesh.
struct Place
{
  double distance = 0.0; ///< to the boundary
  bool inside = false;
  /// inside the diametral circle of an edge, which would then not be a Delaunay edge
  bool crowds = false;
};

Place placeOf(Vec2 p, const std::vector<Edge>& edges)
{
  Place place;
  double nearest = 1e300;
  int winding = 0;
  for (const Edge& edge : edges)
  {
    const Vec2 e = edge.b - edge.a, toA = p - edge.a, toB = p - edge.b;
    const double t = std::clamp(dot(toA, e) / dot(e, e), 0.0, 1.0);
    const Vec2 d = toA - t * e;
    nearest = std::min(nearest, dot(d, d));
    // The margin above 0 also excludes points just outside the circle, whose triangles would be
    // flat.
    place.crowds = place.crowds || dot(toA, toB) <= 0.1 * dot(e, e);
    const double side = cross(e, toA);
    // Winding number: crossings of the ray to the right.
    winding += edge.a[1] <= p[1] && edge.b[1] > p[1] && side > 0.0;
    winding -= edge.a[1] > p[1] && edge.b[1] <= p[1] && side < 0.0;
  }
  place.distance = std::sqrt(nearest);
  place.inside = winding != 0;
  return place;
}

/// The distance of a triangle from the boundary.
double distanceOf(const Vec2* corner, const std::vector<Edge>& edges)
{
  double nearest = 1e300;
  for (const Edge& edge : edges)
  {
    for (int k = 0; k < 3; ++k)
    {
      nearest =
        std::min(nearest, squaredSegmentDistance(corner[k], corner[(k + 1) % 3], edge.a, edge.b));
    }
  }
  return std::sqrt(nearest);
}

/// A pseudo-random number from -1 to 1.
double noise(Index i, Index j, int what)
{
  const auto item = static_cast<std::uint64_t>(i * 2654435761 + j * 40503 + what * 97);
  return 2.0 * SplitMix::unit(SplitMix::hash(item * SplitMix::Increment)) - 1.0;
}

void proceed(const InteractionLayerOptions& options, double fraction)
{
  if (options.progress && !options.progress(fraction))
  {
    throw Error("stopped by the user");
  }
}

/// Points of the lattice around the mesh that become part of the interaction layer.
std::vector<Vec2> latticePoints(
  const LayerBoundary& boundary, double size, const InteractionLayerOptions& options)
{
  const std::vector<Edge>& edges = boundary.edges;
  const Vec2 &low = boundary.low, &high = boundary.high;
  // Rows of equilateral triangles, of which every second one is shifted by half an element.
  const double reach = options.width + Margin * size, rise = 0.5 * std::sqrt(3.0) * size;
  const Vec2 from = { low[0] - reach, low[1] - reach };
  const double columns = std::ceil((high[0] + reach - from[0]) / size) + 1.0;
  const double rows = std::ceil((high[1] + reach - from[1]) / rise) + 1.0;
  if (!(columns * rows <= MaxPoints))
  {
    throw Error("an interaction layer of this width with elements of size " + std::to_string(size) +
      " has too many of them: use a larger element size");
  }
  requireMemory(
    columns * rows * BytesPerPoint, "the interaction layer", "give a larger element size");
  const auto m = static_cast<Index>(columns), n = static_cast<Index>(rows);
  std::vector<Vec2> points(m * n);
  std::vector<char> kept(m * n, 0);
  runChunks(n, options.threads,
    [&](Index j)
    {
      for (Index i = 0; i < m; ++i)
      {
        const double shift = j % 2 == 0 ? 0.0 : 0.5;
        const Vec2 p = { from[0] +
            (static_cast<double>(i) + shift + Jitter * noise(i, j, 0)) * size,
          from[1] + (static_cast<double>(j)) * rise + Jitter * noise(i, j, 1) * size };
        const Place place = placeOf(p, edges);
        points[j * m + i] = p;
        kept[j * m + i] = !place.inside && !place.crowds && place.distance > MinGap * size &&
          place.distance < reach;
      }
    });
  std::vector<Vec2> chosen;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    if (kept[i])
    {
      chosen.push_back(points[i]);
    }
  }
  return chosen;
}

void checkOptions(const InteractionLayerOptions& options)
{
  if (!(options.width > 0.0) || !std::isfinite(options.width))
  {
    throw Error("the width of the interaction layer is " + std::to_string(options.width) +
      "; it must be above 0");
  }
  if (!(options.elementSize >= 0.0) || !std::isfinite(options.elementSize))
  {
    throw Error("the element size of the interaction layer is " +
      std::to_string(options.elementSize) + "; it must be 0 or more");
  }
}

double meanLength(const std::vector<Edge>& edges)
{
  double length = 0.0;
  for (const Edge& edge : edges)
  {
    const Vec2 e = edge.b - edge.a;
    length += std::sqrt(dot(e, e)) / static_cast<double>(edges.size());
  }
  return length;
}

/// The points to triangulate: boundary points, then lattice points.
struct LayerPoints
{
  std::vector<double> points;  ///< x y each
  std::vector<Index> globalOf; ///< global numbers of the points in the mesh with the layer
  std::vector<std::pair<Index, Index>> segments;
  Index boundaryPoints = 0;

  explicit LayerPoints(const std::vector<Edge>& edges)
  {
    std::map<Index, Index> localOf;
    const auto local = [&](Index p, Vec2 at)
    {
      const auto [place, fresh] = localOf.emplace(p, static_cast<Index>(this->globalOf.size()));
      if (fresh)
      {
        this->add(p, at);
      }
      return place->second;
    };
    for (const Edge& edge : edges)
    {
      const Index a = local(edge.first, edge.a), b = local(edge.second, edge.b);
      this->segments.emplace_back(a, b);
    }
    this->boundaryPoints = static_cast<Index>(localOf.size());
  }

  void add(Index global, Vec2 at)
  {
    this->globalOf.push_back(global);
    this->points.push_back(at[0]);
    this->points.push_back(at[1]);
  }
  Vec2 at(Index local) const { return { this->points[2 * local], this->points[2 * local + 1] }; }

  /// Whether a triangle is outside the mesh and closer than the width; far from the mesh, triangles
  /// may be long.
  bool isLayer(const std::array<Index, 3>& t, const std::vector<Edge>& edges, double width) const
  {
    Vec2 corner[3] = {}, centre = {};
    bool ofBoundary = true;
    for (int k = 0; k < 3; ++k)
    {
      corner[k] = this->at(t[k]);
      centre = centre + (1.0 / 3.0) * corner[k];
      ofBoundary = ofBoundary && t[k] < this->boundaryPoints;
    }
    const Place place = placeOf(centre, edges);
    double radius = 0.0;
    for (const Vec2 c : corner)
    {
      radius = std::max(radius, std::sqrt(dot(c - centre, c - centre)));
    }
    const bool reaches = place.distance <= width ||
      (place.distance - radius <= width && distanceOf(corner, edges) <= width);
    return !(ofBoundary && place.inside) && reaches;
  }
};

/// Removes unused points, starting from `first`.
void removeUnused(LayerTriangles& layer, Index first)
{
  constexpr Index unused = -1, used = -2;
  std::vector<Index> newId(layer.points.size() / 2, unused);
  std::iota(newId.begin(), newId.begin() + first, Index(0));
  for (const auto& triangle : layer.triangles)
  {
    for (const Index id : triangle)
    {
      newId[id] = newId[id] < 0 ? used : newId[id];
    }
  }
  Index next = first;
  for (std::size_t i = first; i < newId.size(); ++i)
  {
    if (newId[i] == used)
    {
      layer.points[2 * next] = layer.points[2 * i];
      layer.points[2 * next + 1] = layer.points[2 * i + 1];
      newId[i] = next++;
    }
  }
  layer.points.resize(2 * next);
  for (auto& triangle : layer.triangles)
  {
    for (Index& id : triangle)
    {
      id = newId[id];
    }
  }
}
}

//------------------------------------------------------------------------------
LayerTriangles surroundByLayer(
  const LayerBoundary& boundary, const InteractionLayerOptions& options)
{
  checkOptions(options);
  const std::vector<Edge>& edges = boundary.edges;
  const double size = options.elementSize > 0.0 ? options.elementSize : meanLength(edges);
  LayerPoints local(edges);
  LayerTriangles layer;
  layer.boundary = local.globalOf;
  proceed(options, 0.05);
  for (const Vec2 p : latticePoints(boundary, size, options))
  {
    local.add(-1, p);
  }
  proceed(options, 0.5);
  const std::vector<std::array<Index, 3>> all = constrainedDelaunay(local.points, local.segments);
  proceed(options, 0.8);
  std::copy_if(all.begin(), all.end(), std::back_inserter(layer.triangles),
    [&](const auto& t) { return local.isLayer(t, edges, options.width); });
  layer.points = std::move(local.points);
  removeUnused(layer, local.boundaryPoints);
  return layer;
}

//------------------------------------------------------------------------------
HorizonMesh addInteractionLayer(const HorizonMesh& mesh, const InteractionLayerOptions& options)
{
  checkOptions(options);
  const PlanarTriangles triangles(mesh);
  LayerBoundary boundary;
  boundary.edges = boundaryEdges(triangles);
  for (Index t = 0; t < triangles.size(); ++t)
  {
    Vec2 &low = boundary.low, &high = boundary.high;
    low = { std::min(low[0], triangles.low[t][0]), std::min(low[1], triangles.low[t][1]) };
    high = { std::max(high[0], triangles.high[t][0]), std::max(high[1], triangles.high[t][1]) };
  }
  const LayerTriangles layer = surroundByLayer(boundary, options);
  HorizonMesh result = mesh;
  const auto shared = static_cast<Index>(layer.boundary.size());
  const Index first = result.numberOfPoints() - shared; // of the new points
  result.points.insert(result.points.end(), layer.points.begin() + 2 * shared, layer.points.end());
  for (const auto& t : layer.triangles)
  {
    for (int k = 0; k < 3; ++k)
    {
      // The new triangles get the orientation of the input mesh.
      const Index id = t[triangles.flipped ? (3 - k) % 3 : k];
      result.triangles.push_back(id < shared ? layer.boundary[id] : first + id);
    }
    result.layer.push_back(1);
  }
  if (!result.givenPoints.empty())
  {
    result.givenPoints.resize(result.numberOfPoints(), 1);
  }
  return result;
}
}
