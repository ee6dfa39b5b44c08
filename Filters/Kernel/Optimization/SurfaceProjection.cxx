#include "SurfaceProjection.h"

#include "tautline/Mesh/BoundaryPoints.h"

#include "tautline/Core/Parallel.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
/// Triangles in a leaf of the tree of boxes, at most.
constexpr std::int32_t leafSize = 4;

/// From a point to a box; 0 inside.
double squareDistance(const Vec3& low, const Vec3& high, const Vec3& x)
{
  double d2 = 0;
  for (int c = 0; c < 3; ++c)
  {
    const double d = std::max({ low[c] - x[c], x[c] - high[c], 0.0 });
    d2 += d * d;
  }
  return d2;
}

Vec3 closestOnSegment(const Vec3& a, const Vec3& b, const Vec3& x)
{
  const Vec3 ab = b - a;
  const double length2 = dot(ab, ab);
  const double t = length2 > 0 ? std::clamp(dot(x - a, ab) / length2, 0.0, 1.0) : 0.0;
  return a + t * ab;
}
}

//------------------------------------------------------------------------------
SurfaceProjection::SurfaceProjection(const Mesh& mesh, const SimplexMesh& simplices)
{
  const MeshView& view = mesh.view();
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; t.dimension == 2 && i < block.count; ++i)
    {
      const Index* node = view.connectivity + view.offsets[block.cell(i)];
      Vec3 p[4];
      bool finite = true;
      for (int k = 0; k < t.nodes; ++k)
      {
        p[k] = simplices.transform(pointOf(view, node[k]));
        finite = finite && std::isfinite(dot(p[k], p[k]));
      }
      for (int k = 2; finite && k < t.nodes; ++k)
      {
        this->Triangles.push_back({ p[0], p[k - 1], p[k] });
      }
    }
  }
  this->build();
}

//------------------------------------------------------------------------------
SurfaceProjection SurfaceProjection::ofBoundary(const Mesh& mesh, const SimplexMesh& simplices)
{
  const MeshView& view = mesh.view();
  const std::vector<char> boundary = boundaryPoints(mesh);
  const int dimension = mesh.dimension() == Dimension::Volume ? 3 : 2;

  // Facets of boundary points only are few; those that occur once are the boundary.
  struct Facet
  {
    std::array<Index, MaxFaceNodes> sorted, nodes;
    int size;
  };
  std::vector<Facet> facets;
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; t.dimension == dimension && i < block.count; ++i)
    {
      const Index* node = view.connectivity + view.offsets[block.cell(i)];
      for (int f = 0; f < (dimension == 3 ? t.faces : t.edges); ++f)
      {
        Facet facet;
        facet.size = dimension == 3 ? t.faceSizes[f] : 2;
        facet.nodes.fill(-1);
        bool all = true;
        for (int k = 0; k < facet.size; ++k)
        {
          facet.nodes[k] = node[dimension == 3 ? t.faceNodes[f][k] : t.edgeNodes[f][k]];
          all = all && boundary[facet.nodes[k]];
        }
        if (all)
        {
          facet.sorted = facet.nodes;
          std::sort(facet.sorted.begin(), facet.sorted.end());
          facets.push_back(facet);
        }
      }
    }
  }
  std::sort(facets.begin(), facets.end(),
    [](const Facet& a, const Facet& b) { return a.sorted < b.sorted; });
  SurfaceProjection result;
  for (std::size_t i = 0; i < facets.size();)
  {
    std::size_t same = i + 1;
    while (same < facets.size() && facets[same].sorted == facets[i].sorted)
    {
      ++same;
    }
    const Facet& facet = facets[i];
    Vec3 p[MaxFaceNodes];
    bool finite = same == i + 1;
    for (int k = 0; finite && k < facet.size; ++k)
    {
      p[k] = simplices.transform(pointOf(view, facet.nodes[k]));
      finite = std::isfinite(dot(p[k], p[k]));
    }
    // An edge is a triangle with two equal corners.
    if (finite && facet.size == 2)
    {
      result.Triangles.push_back({ p[0], p[1], p[1] });
    }
    for (int k = 2; finite && k < facet.size; ++k)
    {
      result.Triangles.push_back({ p[0], p[k - 1], p[k] });
    }
    i = same;
  }
  result.build();
  return result;
}

//------------------------------------------------------------------------------
void SurfaceProjection::build()
{
  if (!this->Triangles.empty())
  {
    this->Nodes.reserve(this->Triangles.size());
    this->Nodes.emplace_back();
    this->build(0, 0, static_cast<std::int32_t>(this->Triangles.size()));
  }
}

//------------------------------------------------------------------------------
void SurfaceProjection::build(std::int32_t node, std::int32_t first, std::int32_t count)
{
  Node box;
  box.low.fill(std::numeric_limits<double>::infinity());
  box.high.fill(-std::numeric_limits<double>::infinity());
  for (std::int32_t i = first; i < first + count; ++i)
  {
    for (const Vec3& p : this->Triangles[i])
    {
      for (int c = 0; c < 3; ++c)
      {
        box.low[c] = std::min(box.low[c], p[c]);
        box.high[c] = std::max(box.high[c], p[c]);
      }
    }
  }
  box.first = first;
  box.count = count;
  if (count > leafSize)
  {
    // Halves by the order of the centres along the longest side.
    int axis = 0;
    for (int c = 1; c < 3; ++c)
    {
      axis = box.high[c] - box.low[c] > box.high[axis] - box.low[axis] ? c : axis;
    }
    const std::int32_t half = count / 2;
    std::nth_element(this->Triangles.begin() + first, this->Triangles.begin() + first + half,
      this->Triangles.begin() + first + count,
      [=](const auto& a, const auto& b)
      { return a[0][axis] + a[1][axis] + a[2][axis] < b[0][axis] + b[1][axis] + b[2][axis]; });
    box.first = static_cast<std::int32_t>(this->Nodes.size());
    box.count = 0;
    this->Nodes.resize(this->Nodes.size() + 2);
    this->build(box.first, first, half);
    this->build(box.first + 1, first + half, count - half);
  }
  this->Nodes[node] = box;
}

//------------------------------------------------------------------------------
Vec3 SurfaceProjection::closestOf(std::int32_t triangle, const Vec3& x) const
{
  const auto& [a, b, c] = this->Triangles[triangle];
  // Inside, the foot of the perpendicular; else the closest point of an edge.
  const Vec3 n = cross(b - a, c - a);
  const double n2 = dot(n, n);
  if (n2 > 0)
  {
    const Vec3 foot = x - (dot(x - a, n) / n2) * n;
    if (dot(cross(b - a, foot - a), n) >= 0 && dot(cross(c - b, foot - b), n) >= 0 &&
      dot(cross(a - c, foot - c), n) >= 0)
    {
      return foot;
    }
  }
  Vec3 best = closestOnSegment(a, b, x);
  for (const Vec3& p : { closestOnSegment(b, c, x), closestOnSegment(c, a, x) })
  {
    best = dot(p - x, p - x) < dot(best - x, best - x) ? p : best;
  }
  return best;
}

//------------------------------------------------------------------------------
Vec3 SurfaceProjection::closest(const Vec3& x) const
{
  Vec3 point = x;
  this->nearest(x, point);
  return point;
}

//------------------------------------------------------------------------------
Vec3 SurfaceProjection::normal(const Vec3& x) const
{
  Vec3 point;
  const std::int32_t triangle = this->nearest(x, point);
  if (triangle < 0)
  {
    return { 0, 0, 0 };
  }
  const auto& [a, b, c] = this->Triangles[triangle];
  const Vec3 edge = b - a;
  const Vec3 n = b == c ? Vec3{ edge[1], -edge[0], 0 } : cross(edge, c - a);
  const double length = norm(n);
  return length > 0 ? (1.0 / length) * n : Vec3{ 0, 0, 0 };
}

//------------------------------------------------------------------------------
/// The triangle closest to x, or -1 if there is none, and its closest point.
std::int32_t SurfaceProjection::nearest(const Vec3& x, Vec3& best) const
{
  std::int32_t found = -1;
  if (this->Nodes.empty())
  {
    return found;
  }
  constexpr int deepest = 64;
  std::int32_t stack[deepest];
  int top = 0;
  stack[top++] = 0;
  double best2 = std::numeric_limits<double>::infinity();
  while (top > 0)
  {
    const Node& node = this->Nodes[stack[--top]];
    if (squareDistance(node.low, node.high, x) >= best2)
    {
      continue;
    }
    for (std::int32_t i = node.first; i < node.first + node.count; ++i)
    {
      const Vec3 p = this->closestOf(i, x);
      const double d2 = dot(p - x, p - x);
      if (d2 < best2)
      {
        best2 = d2;
        best = p;
        found = i;
      }
    }
    if (node.count == 0)
    {
      // The nearer child is searched first.
      const Node &left = this->Nodes[node.first], &right = this->Nodes[node.first + 1];
      const bool leftFirst =
        squareDistance(left.low, left.high, x) <= squareDistance(right.low, right.high, x);
      stack[top++] = node.first + (leftFirst ? 1 : 0);
      stack[top++] = node.first + (leftFirst ? 0 : 1);
    }
  }
  return found;
}

//------------------------------------------------------------------------------
double SurfaceProjection::distanceTo(const SurfaceProjection& other) const
{
  // At the corners, the middles of the edges and the centre of each triangle.
  double largest2 = 0;
  for (const auto& [a, b, c] : this->Triangles)
  {
    for (const Vec3& p :
      { a, b, c, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a), (1.0 / 3.0) * (a + b + c) })
    {
      const Vec3 d = other.closest(p) - p;
      largest2 = std::max(largest2, dot(d, d));
    }
  }
  return std::sqrt(largest2);
}

//------------------------------------------------------------------------------
double SurfaceProjection::distance(
  const Mesh& mesh, const SimplexMesh& simplices, const double* points, int threads) const
{
  const MeshView& view = mesh.view();
  double largest2 = 0;
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    if (t.dimension != 2)
    {
      continue;
    }
    std::vector<double> ofChunk(numberOfChunks(block.count), 0.0);
    forEachChunk(block.count, threads,
      [&](Index chunk, Index begin, Index end)
      {
        for (Index i = begin; i < end; ++i)
        {
          const Index* node = view.connectivity + view.offsets[block.cell(i)];
          Vec3 center = { 0, 0, 0 };
          const auto at = [&](int k)
          {
            const double* p = points + 3 * node[k % t.nodes];
            return simplices.transform({ p[0], p[1], p[2] });
          };
          for (int k = 0; k < t.nodes; ++k)
          {
            center += (1.0 / t.nodes) * at(k);
            for (const Vec3& p : { at(k), 0.5 * (at(k) + at(k + 1)) })
            {
              const Vec3 d = this->closest(p) - p;
              ofChunk[chunk] = std::max(ofChunk[chunk], dot(d, d));
            }
          }
          const Vec3 d = this->closest(center) - center;
          ofChunk[chunk] = std::max(ofChunk[chunk], dot(d, d));
        }
      });
    for (double d2 : ofChunk)
    {
      largest2 = std::max(largest2, d2);
    }
  }
  return simplices.scale() * std::sqrt(largest2);
}
}
