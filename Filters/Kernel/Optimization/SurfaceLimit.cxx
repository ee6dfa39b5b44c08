// SPDX-License-Identifier: BSD-3-Clause
#include "SurfaceLimit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tautline
{
namespace
{
/// Of the distance: what is nearer counts as so far, which is found faster.
constexpr double near = 0.1;
/// Places in a leaf of their tree, at most.
constexpr std::size_t facetsPerLeaf = 8;
/// Of the distance: a step that leaves the planes of facets by less slides in them. Thousands of
/// such steps do not add up to what counts.
constexpr double inPlane = 1e-9;

/// Triangles in the balls round their centres: what is far from a ball is far from its triangle.
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

  /// Of x from the triangles, squared. Anything up to `enough` if it is that, and anything beyond
  /// `most` if it is that.
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
  static constexpr double slack = 1 + 1e-6; ///< far more than rounding
  struct Ball
  {
    Vec3 center;
    double radius;
  };

  const std::vector<std::array<Vec3, 3>>& Triangles;
  std::vector<Ball> Balls;
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
  }
}

//------------------------------------------------------------------------------
/// The facets that can move, and those of each free vertex.
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
/// Whether the corners are where the facet cannot be too far. No point of it moves farther than
/// the corner that moves farthest.
bool SurfaceLimit::isLeft(const Facet& facet) const
{
  for (int k = 0; k < MaxFaceNodes && facet.vertices[k] >= 0; ++k)
  {
    const Vec3 d = this->at(facet.vertices[k]) - facet.measuredAt[k];
    if (facet.left < 0 || dot(d, d) > facet.left * facet.left)
    {
      return false;
    }
  }
  return true;
}

//------------------------------------------------------------------------------
/// The facets of v, with v at a place, as triangles (an edge has its last corner twice).
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
/// The largest distance of triangles from the surface; if it is above `most`, anything above that.
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
/// The largest distance from the facets after, of the places of the surface that are near to the
/// facets before; if it is above the limit, anything above that.
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
    facet.left = -1;
  }
}

//------------------------------------------------------------------------------
/**
 * @brief Whether the facets of v cover the same places with v here as with v at `before`: v has
 * moved in the planes of all its triangles, and no triangle is turned over. Where two planes meet,
 * v has then moved along their edge; a border, where the triangles of v end, must be such an edge,
 * too, and so must the front of a crack, where they fold back.
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
  // The ends of the edges at v that one triangle has so far, with its normal.
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
  bool left = true;
  for (std::int32_t i = this->Starts[v]; i < this->Starts[v + 1] && left; ++i)
  {
    left = this->isLeft(this->Facets[this->FacetsAt[i]]);
  }
  if (left)
  {
    return true;
  }
  const std::vector<Triangle> old = this->trianglesAt(v, before);
  if (this->coversSame(v, before, old))
  {
    // As near as before, but by other facets: what is left of the distance is not known for these.
    for (std::int32_t i = this->Starts[v]; i < this->Starts[v + 1]; ++i)
    {
      this->Facets[this->FacetsAt[i]].left = -1;
    }
    return true;
  }
  const std::vector<Triangle> now = this->trianglesAt(v, this->at(v));
  double distance = this->farthest(now, this->Distance);
  if (distance > this->Distance)
  {
    // The input is on its own surface, but may be far from another one.
    const double most = this->Tree ? 0 : this->farthest(old, std::numeric_limits<double>::max());
    return most > this->Distance && this->farthest(now, most) <= most;
  }
  distance = this->Tree ? std::max(distance, this->farthestPlace(before, old, now)) : distance;
  if (distance > this->Distance)
  {
    return false;
  }
  for (std::int32_t i = this->Starts[v]; i < this->Starts[v + 1]; ++i)
  {
    Facet& facet = this->Facets[this->FacetsAt[i]];
    facet.left = this->Distance - distance;
    for (int k = 0; k < MaxFaceNodes && facet.vertices[k] >= 0; ++k)
    {
      facet.measuredAt[k] = this->at(facet.vertices[k]);
    }
  }
  return true;
}
}
