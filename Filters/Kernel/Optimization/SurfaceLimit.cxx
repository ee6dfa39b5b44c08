// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceLimit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tautline
{
namespace
{
/// Fraction of the distance: smaller distances are treated as this one, which is faster.
constexpr double near = 0.1;
/// The maximum number of samples in a leaf of their tree.
constexpr std::size_t facetsPerLeaf = 8;
/// Fraction of the distance: a step that leaves the planes of facets by less slides in them. Even
/// thousands of such steps are negligible.
constexpr double inPlane = 1e-9;

/// Triangles in balls around their centers: a point far from a ball is far from its triangle.
class BalledTriangles
{
public:
  explicit BalledTriangles(const std::vector<std::array<Vec3, 3>>& triangles)
    : Triangles(triangles)
  {
    for (const auto& [a, b, c] : triangles)
    {
      const Vec3 center = (1.0 / 3.0) * (a + b + c);
      const double radius = std::max({ norm(a - center), norm(b - center), norm(c - center) });
      this->Balls.push_back({ center, slack * radius });
    }
  }

  /// The squared distance of x from the triangles, or any number up to `enough` if it is at most
  /// `enough`, or any number above `most` if it exceeds `most`.
  double squareDistanceTo(const Vec3& x, double enough, double most) const
  {
    double least = std::numeric_limits<double>::infinity(), reach = slack * std::sqrt(most);
    for (std::size_t i = 0; i < this->Balls.size() && least > enough; ++i)
    {
      const Vec3 toCenter = this->Balls[i].center - x;
      const double far = this->Balls[i].radius + reach;
      if (dot(toCenter, toCenter) > far * far)
      {
        continue;
      }
      const Vec3 d = closestOnTriangle(this->Triangles[i], x) - x;
      if (dot(d, d) < least)
      {
        least = dot(d, d);
        reach = std::min(reach, slack * std::sqrt(least));
      }
    }
    return least;
  }

private:
  static constexpr double slack = 1 + 1e-6; ///< far above rounding errors
  struct Ball
  {
    Vec3 center;
    double radius;
  };

  const std::vector<std::array<Vec3, 3>>& Triangles;
  std::vector<Ball> Balls;
};

/// The corners around a vertex whose triangles surround it exactly once, seen along their mean
/// normal.
class Fan
{
public:
  /// @param triangles triangles without the vertex are ignored
  Fan(const std::vector<std::array<Vec3, 3>>& triangles, const Vec3& vertex)
    : Origin(vertex)
  {
    std::vector<std::array<Vec3, 2>> edges;
    Vec3 normal = { 0, 0, 0 };
    for (const std::array<Vec3, 3>& t : triangles)
    {
      const std::size_t k = std::find(t.begin(), t.end(), vertex) - t.begin();
      if (k < t.size())
      {
        edges.push_back({ t[(k + 1) % 3], t[(k + 2) % 3] });
        normal += cross(edges.back()[0] - vertex, edges.back()[1] - vertex);
      }
    }
    const double length = norm(normal);
    if (!(length > 0) || !isOneRound(edges))
    {
      return;
    }
    // Axes perpendicular to the normal and to each other.
    this->Axes[2] = (1 / length) * normal;
    const Vec3 side = cross(this->Axes[2], edges[0][0] - vertex);
    if (!(norm(side) > 0))
    {
      return;
    }
    this->Axes[1] = (1 / norm(side)) * side;
    this->Axes[0] = cross(this->Axes[1], this->Axes[2]);
    for (const auto& [corner, next] : edges)
    {
      this->Corners.push_back(this->seen(corner));
    }
  }

  /**
   * @brief The largest height difference of the triangles if the vertex moves to x; its
   * displacement if they are not the graph of a function, before or after.
   *
   * Between two such functions it is largest at one of the two vertex positions, or where an edge
   * of one crosses an edge of the other.
   */
  double changeTo(const Vec3& x) const
  {
    const double way = norm(x - this->Origin);
    if (this->Corners.empty())
    {
      return way;
    }
    const Vec3 from = { 0, 0, 0 }, to = this->seen(x);
    if (!this->isGraph(from) || !this->isGraph(to))
    {
      return way;
    }
    double largest =
      std::max(std::abs(this->heightAt(from, to)), std::abs(this->heightAt(to, from) - to[2]));
    for (const Vec3& p : this->Corners)
    {
      for (const Vec3& q : this->Corners)
      {
        const Vec3 d = q - to;
        const double both = cross2(p, d);
        const double s = cross2(to, d) / both, t = cross2(to, p) / both;
        if (s >= 0 && s <= 1 && t >= 0 && t <= 1)
        {
          largest = std::max(largest, std::abs(s * p[2] - to[2] - t * d[2]));
        }
      }
    }
    return std::min(largest, way);
  }

private:
  static double cross2(const Vec3& a, const Vec3& b) { return a[0] * b[1] - a[1] * b[0]; }

  /// Chains the edges, each starting at the end of the previous one; returns whether they form a
  /// ring.
  static bool isOneRound(std::vector<std::array<Vec3, 2>>& edges)
  {
    for (std::size_t i = 0; i + 1 < edges.size(); ++i)
    {
      const auto next = std::find_if(edges.begin() + i + 1, edges.end(),
        [&](const std::array<Vec3, 2>& e) { return e[0] == edges[i][1]; });
      if (next == edges.end())
      {
        return false;
      }
      std::swap(*next, edges[i + 1]);
    }
    return edges.size() > 2 && edges.back()[1] == edges.front()[0];
  }

  Vec3 seen(const Vec3& x) const
  {
    const Vec3 d = x - this->Origin;
    return { dot(d, this->Axes[0]), dot(d, this->Axes[1]), dot(d, this->Axes[2]) };
  }

  /// Whether the triangles with the vertex at a position face the viewer and surround it exactly
  /// once.
  bool isGraph(const Vec3& place) const
  {
    int rounds = 0;
    for (std::size_t i = 0; i < this->Corners.size(); ++i)
    {
      const Vec3 a = this->Corners[i] - place,
                 b = this->Corners[(i + 1) % this->Corners.size()] - place;
      if (!(cross2(a, b) > 0))
      {
        return false;
      }
      rounds += a[1] <= 0 && b[1] > 0;
    }
    return rounds == 1;
  }

  /// The height at x of the triangles with the vertex at `place`.
  double heightAt(const Vec3& x, const Vec3& place) const
  {
    for (std::size_t i = 0; i < this->Corners.size(); ++i)
    {
      const Vec3 a = this->Corners[i] - place,
                 b = this->Corners[(i + 1) % this->Corners.size()] - place, d = x - place;
      if (cross2(a, d) >= 0 && cross2(d, b) >= 0)
      {
        return place[2] + (cross2(d, b) * a[2] + cross2(a, d) * b[2]) / cross2(a, b);
      }
    }
    return std::numeric_limits<double>::infinity();
  }

  Vec3 Origin;
  std::array<Vec3, 3> Axes = {};
  std::vector<Vec3> Corners; ///< in order; empty if they do not surround the vertex exactly once
};
}

//------------------------------------------------------------------------------
SurfaceLimit::SurfaceLimit(const Mesh& mesh, const std::vector<SurfaceFacet>& facets,
  const SimplexMesh& simplices, const SurfaceProjection& surface, double distance, bool bothWays)
  : Simplices(simplices)
  , Surface(surface)
  , Whole(distance)
  , Distance(this->Whole)
{
  this->findFacets(mesh, facets);
  if (bothWays && !this->Facets.empty())
  {
    this->Places = surface.samples(divisions);
    this->Tree = std::make_unique<PointTree>(this->Places, facetsPerLeaf);
    if (this->isAsIn(mesh))
    {
      for (Facet& facet : this->Facets)
      {
        facet.far = { 0.0, 0.0 };
      }
    }
  }
}

//------------------------------------------------------------------------------
/// Whether all vertices are at their mesh positions and the surface is the mesh surface.
bool SurfaceLimit::isAsIn(const Mesh& mesh) const
{
  std::int32_t v = 0;
  while (v < this->Simplices.vertices() &&
    this->at(v) == this->Simplices.transform(pointOf(mesh.view(), this->Simplices.point(v))))
  {
    ++v;
  }
  return v == this->Simplices.vertices();
}

//------------------------------------------------------------------------------
/// Finds the facets that can move, and the facets of each free vertex.
void SurfaceLimit::findFacets(const Mesh& mesh, const std::vector<SurfaceFacet>& facets)
{
  std::vector<std::int32_t> vertexOf(mesh.view().numberOfPoints, -1);
  for (std::int32_t v = 0; v < this->Simplices.vertices(); ++v)
  {
    vertexOf[this->Simplices.point(v)] = v;
  }
  const std::int32_t free = this->Simplices.freeVertices();
  const auto isFree = [free](std::int32_t v) { return v >= 0 && v < free; };
  this->Refused.assign(free, 0);
  this->Starts.assign(static_cast<std::size_t>(free) + 1, 0);
  for (const SurfaceFacet& found : facets)
  {
    Facet facet;
    facet.vertices.fill(-1);
    for (int k = 0; k < found.size; ++k)
    {
      facet.vertices[k] = vertexOf[found.nodes[k]];
    }
    const auto* vertices = facet.vertices.data();
    if (std::any_of(vertices, vertices + found.size, isFree) &&
      std::all_of(vertices, vertices + found.size, [](std::int32_t v) { return v >= 0; }))
    {
      this->Facets.push_back(facet);
      for (int k = 0; k < found.size; ++k)
      {
        if (isFree(vertices[k]))
        {
          ++this->Starts[vertices[k] + 1];
        }
      }
    }
  }
  for (std::int32_t v = 0; v < free; ++v)
  {
    this->Starts[v + 1] += this->Starts[v];
  }
  this->FacetsAt.resize(this->Starts.back());
  std::vector<std::int32_t> next(this->Starts.begin(), this->Starts.end() - 1);
  for (std::size_t f = 0; f < this->Facets.size(); ++f)
  {
    for (std::int32_t v : this->Facets[f].vertices)
    {
      if (isFree(v))
      {
        this->FacetsAt[next[v]++] = static_cast<std::int32_t>(f);
      }
    }
  }
}

//------------------------------------------------------------------------------
/// The upper bound of the distance of the facets of v.
double SurfaceLimit::farOf(std::int32_t v, Way way) const
{
  double far = 0;
  for (std::int32_t i = this->Starts[v]; i < this->Starts[v + 1]; ++i)
  {
    far = std::max(far, this->Facets[this->FacetsAt[i]].far[way]);
  }
  return far;
}

void SurfaceLimit::setFar(std::int32_t v, Way way, double far)
{
  for (std::int32_t i = this->Starts[v]; i < this->Starts[v + 1]; ++i)
  {
    this->Facets[this->FacetsAt[i]].far[way] = far;
  }
}

//------------------------------------------------------------------------------
/// The facets of v, with v at a position, as triangles (an edge repeats its last corner).
std::vector<SurfaceLimit::Triangle> SurfaceLimit::trianglesAt(
  std::int32_t v, const Vec3& place) const
{
  const auto corner = [&](std::int32_t i) { return i == v ? place : this->at(i); };
  std::vector<Triangle> triangles;
  for (std::int32_t i = this->Starts[v]; i < this->Starts[v + 1]; ++i)
  {
    const auto& nodes = this->Facets[this->FacetsAt[i]].vertices;
    if (nodes[2] < 0)
    {
      triangles.push_back({ corner(nodes[0]), corner(nodes[1]), corner(nodes[1]) });
    }
    for (int k = 2; k < MaxFaceNodes && nodes[k] >= 0; ++k)
    {
      triangles.push_back({ corner(nodes[0]), corner(nodes[k - 1]), corner(nodes[k]) });
    }
  }
  return triangles;
}

//------------------------------------------------------------------------------
/// The largest distance of triangles from the surface; or any number above `most` if it exceeds
/// `most`.
double SurfaceLimit::farthest(const std::vector<Triangle>& triangles, double most) const
{
  std::vector<Vec3> places;
  double largest = near * this->Distance;
  std::int32_t piece = 0;
  for (std::size_t i = 0; i < triangles.size() && largest <= most; ++i)
  {
    places.clear();
    addSamples(triangles[i], divisions, places);
    for (const Vec3& x : places)
    {
      largest = std::max(largest, this->Surface.distanceOf(x, largest, most, piece));
    }
  }
  return largest;
}

//------------------------------------------------------------------------------
/// The largest distance from the new facets of the surface samples near the old facets; or any
/// number above the limit if it exceeds the limit.
double SurfaceLimit::farthestPlace(
  const Vec3& center, const std::vector<Triangle>& before, const std::vector<Triangle>& after) const
{
  double radius2 = 0;
  for (const Triangle& triangle : before)
  {
    for (const Vec3& x : triangle)
    {
      radius2 = std::max(radius2, dot(x - center, x - center));
    }
  }
  const double reach = std::sqrt(radius2) + this->Distance, most2 = this->Distance * this->Distance;
  double largest2 = near * near * most2;
  const BalledTriangles old(before), now(after);
  const auto& nodes = this->Tree->nodes();
  for (std::size_t i = 0; i < nodes.size() && largest2 <= most2;)
  {
    const PointTree::Node& node = nodes[i];
    if (norm(node.center - center) > reach + node.radius)
    {
      i = node.next;
      continue;
    }
    for (std::size_t k = node.begin; node.leaf && k < node.end; ++k)
    {
      const Vec3& x = this->Places[this->Tree->order()[k]];
      if (norm(x - center) <= reach && old.squareDistanceTo(x, most2, most2) <= most2)
      {
        largest2 = std::max(largest2, now.squareDistanceTo(x, largest2, most2));
      }
    }
    ++i;
  }
  return std::sqrt(largest2);
}

//------------------------------------------------------------------------------
bool SurfaceLimit::allows(std::int32_t v, const Vec3& before)
{
  const bool near = this->staysNear(v, before);
  this->Refused[v] = !near;
  return near;
}

//------------------------------------------------------------------------------
void SurfaceLimit::setShare(double share)
{
  this->Distance = share * this->Whole;
}

//------------------------------------------------------------------------------
void SurfaceLimit::forget()
{
  for (Facet& facet : this->Facets)
  {
    facet.far = { unknown, unknown };
  }
}

void SurfaceLimit::forget(std::int32_t v)
{
  this->setFar(v, There, unknown);
  this->setFar(v, Back, unknown);
}

//------------------------------------------------------------------------------
/**
 * @brief Whether the facets of v cover the same region as with v at `before`: v has moved in the
 * planes of all its triangles, and no triangle is flipped. Where two planes meet, v has then moved
 * along their edge; a border, where the triangles of v end, must also be such an edge, as must the
 * front of a crack, where they fold back.
 * @param triangles of v, with v at `before`
 */
bool SurfaceLimit::coversSame(
  std::int32_t v, const Vec3& before, const std::vector<Triangle>& triangles) const
{
  const Vec3 x = this->at(v), step = x - before;
  const double tolerance = inPlane * this->Distance;
  const auto isAlong = [&](const Vec3& end)
  {
    const Vec3 edge = end - before, off = cross(edge, step);
    return dot(off, off) <= tolerance * tolerance * dot(edge, edge);
  };
  // The ends of the edges at v that belong to one triangle so far, with its normal.
  struct OpenEdge
  {
    Vec3 end, normal;
  };
  constexpr std::size_t most = 32;
  std::array<OpenEdge, most> open;
  std::size_t count = 0;
  std::array<Vec3, 2> edges; // of a curve
  std::size_t edgeCount = 0;
  for (const Triangle& triangle : triangles)
  {
    const std::size_t k = std::find(triangle.begin(), triangle.end(), before) - triangle.begin();
    if (k == triangle.size())
    {
      continue; // the other half of a quadrilateral
    }
    const bool edge = triangle[1] == triangle[2];
    const Vec3 &b = triangle[edge && k > 0 ? 0 : (k + 1) % 3],
               &c = edge ? b : triangle[(k + 2) % 3];
    if (edge)
    {
      if (!isAlong(b) || dot(b - x, b - before) <= 0 || edgeCount == edges.size())
      {
        return false;
      }
      edges[edgeCount++] = b - before;
      continue;
    }
    const Vec3 normal = cross(b - before, c - before);
    const double height = dot(normal, step);
    if (height * height > tolerance * tolerance * dot(normal, normal) ||
      dot(cross(b - x, c - x), normal) <= 0)
    {
      return false;
    }
    for (const Vec3& end : { b, c })
    {
      const auto last = open.begin() + count;
      const auto found =
        std::find_if(open.begin(), last, [&](const OpenEdge& e) { return e.end == end; });
      if (found != last)
      {
        if (dot(found->normal, normal) <= 0 && !isAlong(end))
        {
          return false;
        }
        *found = open[--count];
      }
      else if (count < most)
      {
        open[count++] = { end, normal };
      }
      else
      {
        return false;
      }
    }
  }
  if (edgeCount > 0 && (edgeCount < edges.size() || dot(edges[0], edges[1]) >= 0))
  {
    return false; // the end of a curve, or the tip of a slit
  }
  return std::all_of(
    open.begin(), open.begin() + count, [&](const OpenEdge& e) { return isAlong(e.end); });
}

//------------------------------------------------------------------------------
bool SurfaceLimit::staysNear(std::int32_t v, const Vec3& before)
{
  const std::vector<Triangle> old = this->trianglesAt(v, before);
  const bool same = this->coversSame(v, before, old);
  const double change = same ? 0.0 : Fan(old, before).changeTo(this->at(v));
  double there = this->farOf(v, There) + change, back = this->farOf(v, Back) + change;
  if (!same && (there > this->Distance || (this->Tree && back > this->Distance)))
  {
    const std::vector<Triangle> now = this->trianglesAt(v, this->at(v));
    there = there > this->Distance ? this->farthest(now, this->Distance) : there;
    if (there > this->Distance)
    {
      // The input lies on its own surface, but may be far from another one.
      const double most = this->Tree ? 0 : this->farthest(old, std::numeric_limits<double>::max());
      if (!(most > this->Distance && this->farthest(now, most) <= most))
      {
        return false;
      }
      there = unknown;
    }
    else if (this->Tree && back > this->Distance)
    {
      back = this->farthestPlace(before, old, now);
      if (back > this->Distance)
      {
        return false;
      }
    }
  }
  this->setFar(v, There, there);
  this->setFar(v, Back, back);
  return true;
}
}
