// SPDX-License-Identifier: BSD-3-Clause
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

/// The squared distance from a point to a box; 0 inside.
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

//------------------------------------------------------------------------------
/// The boundary of a volume or planar mesh.
std::vector<SurfaceFacet> boundaryFacets(const Mesh& mesh)
{
  const MeshView& view = mesh.view();
  const std::vector<char> boundary = boundaryPoints(mesh);
  const int dimension = mesh.dimension() == Dimension::Volume ? 3 : 2;

  // Few facets have boundary points only; the boundary consists of the facets that occur once.
  struct Found
  {
    std::array<Index, MaxFaceNodes> sorted;
    SurfaceFacet facet;
  };
  std::vector<Found> found;
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; t.dimension == dimension && i < block.count; ++i)
    {
      const Index* node = view.connectivity + view.offsets[block.cell(i)];
      for (int f = 0; f < (dimension == 3 ? t.faces : t.edges); ++f)
      {
        SurfaceFacet facet;
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
          // As in Features: quadrilaterals are divided at the same diagonal.
          const auto begin = facet.nodes.begin(), end = begin + facet.size;
          std::rotate(begin, std::min_element(begin, end), end);
          found.push_back({ facet.nodes, facet });
          std::sort(found.back().sorted.begin(), found.back().sorted.end());
        }
      }
    }
  }
  std::sort(
    found.begin(), found.end(), [](const Found& a, const Found& b) { return a.sorted < b.sorted; });
  std::vector<SurfaceFacet> facets;
  for (std::size_t i = 0; i < found.size();)
  {
    std::size_t same = i + 1;
    while (same < found.size() && found[same].sorted == found[i].sorted)
    {
      ++same;
    }
    if (same == i + 1)
    {
      facets.push_back(found[i].facet);
    }
    i = same;
  }
  return facets;
}
}

//------------------------------------------------------------------------------
std::vector<SurfaceFacet> surfaceFacets(const Mesh& mesh)
{
  if (mesh.dimension() != Dimension::Surface)
  {
    return boundaryFacets(mesh);
  }
  const MeshView& view = mesh.view();
  std::vector<SurfaceFacet> facets;
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    for (Index i = 0; t.dimension == 2 && i < block.count; ++i)
    {
      SurfaceFacet facet;
      facet.size = t.nodes;
      facet.nodes.fill(-1);
      std::copy_n(view.connectivity + view.offsets[block.cell(i)], facet.size, facet.nodes.begin());
      facets.push_back(facet);
    }
  }
  return facets;
}

//------------------------------------------------------------------------------
SurfaceProjection::SurfaceProjection(const Mesh& mesh, const SimplexMesh& simplices)
  : SurfaceProjection(mesh, surfaceFacets(mesh), simplices)
{
}

//------------------------------------------------------------------------------
SurfaceProjection::SurfaceProjection(
  const Mesh& mesh, const std::vector<SurfaceFacet>& facets, const SimplexMesh& simplices)
  : Curve(mesh.dimension() == Dimension::Planar)
{
  for (const SurfaceFacet& facet : facets)
  {
    Vec3 p[MaxFaceNodes];
    bool finite = true;
    for (int k = 0; k < facet.size; ++k)
    {
      p[k] = simplices.transform(pointOf(mesh.view(), facet.nodes[k]));
      finite = finite && std::isfinite(dot(p[k], p[k]));
    }
    // An edge is a triangle with two equal corners.
    if (finite && facet.size == 2)
    {
      this->Pieces.push_back({ { p[0], p[1], p[1] }, -1 });
    }
    for (int k = 2; finite && k < facet.size; ++k)
    {
      this->Pieces.push_back({ { p[0], p[k - 1], p[k] }, -1 });
    }
  }
  this->build();
}

//------------------------------------------------------------------------------
SurfaceProjection::SurfaceProjection(const SurfacePart& part, const SimplexMesh* simplices)
  : Curve(part.curve)
{
  this->add(part, simplices);
  this->build();
}

//------------------------------------------------------------------------------
SurfaceProjection SurfaceProjection::ofFacets(
  const SurfaceModel& model, const SimplexMesh* simplices)
{
  const int parts = static_cast<int>(model.parts.size());
  return ofParts(model, 0, model.patches > 0 ? model.patches : parts, simplices);
}

SurfaceProjection SurfaceProjection::ofParts(
  const SurfaceModel& model, int begin, int end, const SimplexMesh* simplices)
{
  SurfaceProjection result;
  result.Curve = begin < end && model.parts[begin].curve;
  for (int i = begin; i < end; ++i)
  {
    result.add(model.parts[i], simplices, i);
  }
  for (Piece& piece : result.Pieces)
  {
    piece.controls = -1;
  }
  result.Controls.clear();
  result.build();
  return result;
}

//------------------------------------------------------------------------------
void SurfaceProjection::add(
  const SurfacePart& part, const SimplexMesh* simplices, std::int32_t number)
{
  const auto placed = [simplices](const Vec3& x)
  { return simplices ? simplices->transform(x) : x; };
  const auto first = static_cast<std::int32_t>(this->Controls.size());
  for (std::size_t i = 0; i < part.pieces.size(); ++i)
  {
    const auto& [a, b, c] = part.pieces[i];
    const std::int32_t controls = part.controlsOf.empty() ? -1 : part.controlsOf[i];
    this->Pieces.push_back(
      { { placed(a), placed(b), placed(c) }, controls < 0 ? -1 : first + controls, number });
  }
  for (CubicControls controls : part.controls)
  {
    std::transform(controls.begin(), controls.end(), controls.begin(), placed);
    this->Controls.push_back(controls);
  }
}

//------------------------------------------------------------------------------
void SurfaceProjection::build()
{
  for (std::size_t i = 0; i < this->Pieces.size(); ++i)
  {
    this->Pieces[i].source = static_cast<std::int32_t>(i);
  }
  if (!this->Pieces.empty())
  {
    this->Nodes.reserve(this->Pieces.size());
    this->Nodes.emplace_back();
    this->build(0, 0, static_cast<std::int32_t>(this->Pieces.size()));
  }
  for (const Piece& piece : this->Pieces)
  {
    const auto& [a, b, c] = piece.corner;
    const Vec3 center = (1.0 / 3.0) * (a + b + c);
    constexpr double slack = 1 + 1e-6; // far more than rounding
    this->Balls.push_back(
      { center, slack * std::max({ norm(a - center), norm(b - center), norm(c - center) }) });
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
    for (const Vec3& p : this->Pieces[i].corner)
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
    // Split in half by the order of the centers along the longest side.
    int axis = 0;
    for (int c = 1; c < 3; ++c)
    {
      axis = box.high[c] - box.low[c] > box.high[axis] - box.low[axis] ? c : axis;
    }
    const std::int32_t half = count / 2;
    std::nth_element(this->Pieces.begin() + first, this->Pieces.begin() + first + half,
      this->Pieces.begin() + first + count,
      [=](const Piece& a, const Piece& b)
      {
        const auto &p = a.corner, &q = b.corner;
        return p[0][axis] + p[1][axis] + p[2][axis] < q[0][axis] + q[1][axis] + q[2][axis];
      });
    box.first = static_cast<std::int32_t>(this->Nodes.size());
    box.count = 0;
    this->Nodes.resize(this->Nodes.size() + 2);
    this->build(box.first, first, half);
    this->build(box.first + 1, first + half, count - half);
  }
  this->Nodes[node] = box;
}

//------------------------------------------------------------------------------
Vec3 closestOnTriangle(const std::array<Vec3, 3>& corner, const Vec3& x)
{
  const auto& [a, b, c] = corner;
  // Inside: the foot of the perpendicular; outside: the closest point of an edge. For edges and
  // needles, the foot is only rounding noise.
  constexpr double needle2 = 1e-20; // sine of an angle, squared
  const Vec3 n = cross(b - a, c - a);
  const double n2 = dot(n, n);
  bool beyond[3] = { true, true, true };
  if (b != c && n2 > needle2 * dot(b - a, b - a) * dot(c - a, c - a))
  {
    const Vec3 foot = x - (dot(x - a, n) / n2) * n;
    for (int k = 0; k < 3; ++k)
    {
      const Vec3& start = corner[k];
      beyond[k] = dot(cross(corner[(k + 1) % 3] - start, foot - start), n) < 0;
    }
    if (!beyond[0] && !beyond[1] && !beyond[2])
    {
      return foot;
    }
  }
  // The closest edge is one with the foot on its outer side.
  Vec3 best = a;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k)
  {
    if (beyond[k])
    {
      const Vec3 p = closestOnSegment(corner[k], corner[(k + 1) % 3], x);
      const double d2 = dot(p - x, p - x);
      best = d2 < least ? p : best;
      least = std::min(least, d2);
    }
  }
  return best;
}

//------------------------------------------------------------------------------
/// The point of the curved piece over a point of the flat one.
SurfaceProjection::Place SurfaceProjection::lift(std::int32_t piece, const Vec3& foot) const
{
  const auto& [a, b, c] = this->Pieces[piece].corner;
  const std::int32_t controls = this->Pieces[piece].controls;
  const bool edge = b == c;
  const Vec3 n = edge ? b - a : cross(b - a, c - a);
  if (controls < 0)
  {
    return { foot, n };
  }
  const CubicControls& q = this->Controls[controls];
  const double n2 = dot(n, n);
  if (edge)
  {
    const double t = n2 > 0 ? std::clamp(dot(foot - a, n) / n2, 0.0, 1.0) : 0.0, s = 1 - t;
    const Vec3 point = s * s * s * a + 3 * s * s * t * q[0] + 3 * s * t * t * q[1] + t * t * t * b;
    return { point, s * s * (q[0] - a) + 2 * s * t * (q[1] - q[0]) + t * t * (b - q[1]) };
  }
  double u = 1, v = 0, w = 0;
  if (n2 > 0)
  {
    v = std::clamp(dot(cross(foot - a, c - a), n) / n2, 0.0, 1.0);
    w = std::clamp(dot(cross(b - a, foot - a), n) / n2, 0.0, 1.0 - v);
    u = 1 - v - w;
  }
  // The three quadratic parts of de Casteljau's last step: the point, and the plane tangent there.
  const auto quadratic = [&](const Vec3& uu, const Vec3& uv, const Vec3& vv, const Vec3& vw,
                           const Vec3& ww, const Vec3& wu)
  { return u * u * uu + v * v * vv + w * w * ww + 2 * (u * v * uv + v * w * vw + w * u * wu); };
  const Vec3 atA = quadratic(a, q[0], q[1], q[6], q[4], q[5]),
             atB = quadratic(q[0], q[1], b, q[2], q[3], q[6]),
             atC = quadratic(q[5], q[6], q[2], q[3], c, q[4]);
  return { u * atA + v * atB + w * atC, cross(atB - atA, atC - atA) };
}

//------------------------------------------------------------------------------
/// Whether the closest point of a flat piece is below x, and not on its border; it is the foot.
bool SurfaceProjection::isOver(std::int32_t piece, const Vec3& x, Vec3& foot) const
{
  constexpr double tolerance2 = 1e-24; // of the piece's size, squared
  const auto& [a, b, c] = this->Pieces[piece].corner;
  foot = this->closestOf(piece, x);
  const Vec3 off = x - foot;
  if (b == c)
  {
    const double along = dot(off, b - a), length2 = dot(b - a, b - a);
    return along * along <= tolerance2 * length2 * length2;
  }
  const Vec3 n = cross(b - a, c - a), inPlane = cross(n, off);
  const double n2 = dot(n, n);
  return dot(inPlane, inPlane) <= tolerance2 * n2 * std::sqrt(n2);
}

//------------------------------------------------------------------------------
SurfaceProjection::Place SurfaceProjection::find(const Vec3& x, std::int32_t& piece) const
{
  Vec3 foot = x;
  piece = this->nearest(x, foot, piece);
  if (piece < 0)
  {
    return { x, { 0, 0, 0 } };
  }
  Place place = this->lift(piece, foot);
  constexpr int maxSteps = 8;
  constexpr double tolerance = 1e-9; // of the piece's edge
  const auto& corner = this->Pieces[piece].corner;
  const double size = norm(corner[1] - corner[0]);
  Vec3 y = x;
  for (int step = 0; !this->Controls.empty() && step < maxSteps; ++step)
  {
    const double length2 = dot(place.direction, place.direction);
    if (!(length2 > 0))
    {
      break;
    }
    const Vec3 off = x - place.point;
    const Vec3 along = (dot(off, place.direction) / length2) * place.direction;
    const Vec3 inSurface = this->Curve ? along : off - along;
    y = foot + inSurface;
    const std::int32_t before = piece;
    const Vec3 last = foot;
    piece = this->isOver(piece, y, foot) ? piece : this->nearest(y, foot, piece);
    place = this->lift(piece, foot);
    if (piece == before && norm(foot - last) <= tolerance * size)
    {
      break;
    }
  }
  return place;
}

//------------------------------------------------------------------------------
Vec3 SurfaceProjection::closest(const Vec3& x) const
{
  if (this->Controls.empty())
  {
    Vec3 point = x;
    this->nearest(x, point);
    return point;
  }
  std::int32_t piece = -1;
  return this->find(x, piece).point;
}

//------------------------------------------------------------------------------
Vec3 SurfaceProjection::closest(const Vec3& x, Vec3& direction) const
{
  std::int32_t piece = -1;
  return this->closest(x, direction, piece);
}

Vec3 SurfaceProjection::closest(const Vec3& x, Vec3& direction, std::int32_t& piece) const
{
  const Place place = this->find(x, piece);
  const double length = norm(place.direction);
  direction = length > 0 ? (1.0 / length) * place.direction : Vec3{ 0, 0, 0 };
  return place.point;
}

std::int32_t SurfaceProjection::nearestPart(const Vec3& x) const
{
  Vec3 point = x;
  const std::int32_t piece = this->nearest(x, point);
  return piece < 0 ? -1 : this->Pieces[piece].part;
}

//------------------------------------------------------------------------------
Vec3 SurfaceProjection::direction(const Vec3& x) const
{
  Vec3 direction;
  this->closest(x, direction);
  return direction;
}

//------------------------------------------------------------------------------
/// The flat piece closest to x, or -1 if there is none, and its closest point.
/// @param first a piece that may be near, or -1
std::int32_t SurfaceProjection::nearest(const Vec3& x, Vec3& best, std::int32_t first) const
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
  if (first >= 0)
  {
    best = this->closestOf(first, x);
    best2 = dot(best - x, best - x);
    found = first;
  }
  while (top > 0)
  {
    const Node& node = this->Nodes[stack[--top]];
    if (squareDistance(node.low, node.high, x) >= best2)
    {
      continue;
    }
    for (std::int32_t i = node.first; i < node.first + node.count; ++i)
    {
      // A point far from the ball around a piece is far from the piece.
      const Ball& ball = this->Balls[i];
      const Vec3 toCenter = ball.center - x;
      const double square = dot(toCenter, toCenter), radius2 = ball.radius * ball.radius;
      if (square > best2 + radius2 &&
        (square - best2 - radius2) * (square - best2 - radius2) >= 4 * best2 * radius2)
      {
        continue;
      }
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
double SurfaceProjection::distanceOf(
  const Vec3& x, double enough, double most, std::int32_t& piece) const
{
  constexpr int deepest = 64;
  std::int32_t stack[deepest];
  int top = 0;
  double least = std::numeric_limits<double>::infinity(), reach = most;
  // A point far from the ball around a piece is far from the piece.
  const auto look = [&](std::int32_t i)
  {
    const Vec3 toCenter = this->Balls[i].center - x;
    const double far = this->Balls[i].radius + reach;
    if (dot(toCenter, toCenter) > far * far)
    {
      return;
    }
    const double distance = norm(this->closestOf(i, x) - x);
    if (distance < least)
    {
      least = distance;
      reach = std::min(reach, least);
      piece = i;
    }
  };
  if (!this->Nodes.empty())
  {
    stack[top++] = 0;
    look(piece);
  }
  while (top > 0 && least > enough)
  {
    const Node& node = this->Nodes[stack[--top]];
    for (std::int32_t i = node.first; i < node.first + node.count; ++i)
    {
      look(i);
    }
    if (node.count == 0)
    {
      // The nearer child is searched first; distant children are skipped.
      const Node &left = this->Nodes[node.first], &right = this->Nodes[node.first + 1];
      const double toLeft = squareDistance(left.low, left.high, x),
                   toRight = squareDistance(right.low, right.high, x);
      const bool leftFirst = toLeft <= toRight;
      const double reach2 = reach * reach;
      if (std::max(toLeft, toRight) <= reach2)
      {
        stack[top++] = node.first + (leftFirst ? 1 : 0);
      }
      if (std::min(toLeft, toRight) <= reach2)
      {
        stack[top++] = node.first + (leftFirst ? 0 : 1);
      }
    }
  }
  return least;
}

//------------------------------------------------------------------------------
void addSamples(const std::array<Vec3, 3>& corner, int divisions, std::vector<Vec3>& places)
{
  const auto& [a, b, c] = corner;
  const double part = 1.0 / divisions;
  for (int i = 0; i <= divisions; ++i)
  {
    for (int j = 0; i + j <= divisions && (j == 0 || b != c); ++j)
    {
      places.push_back(
        part * ((divisions - i - j) * a + static_cast<double>(i) * b + static_cast<double>(j) * c));
    }
  }
  if (b != c)
  {
    places.push_back((1.0 / 3.0) * (a + b + c));
  }
}

//------------------------------------------------------------------------------
std::vector<Vec3> SurfaceProjection::samples(int divisions) const
{
  std::vector<Vec3> places;
  for (const Piece& piece : this->Pieces)
  {
    addSamples(piece.corner, divisions, places);
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  return places;
}

//------------------------------------------------------------------------------
double SurfaceProjection::distanceTo(
  const SurfaceProjection& other, int threads, int divisions) const
{
  const std::vector<Vec3> places = this->samples(divisions);
  const auto count = static_cast<Index>(places.size());
  std::vector<double> ofChunk(numberOfChunks(count), 0.0);
  forEachChunk(count, threads,
    [&](Index chunk, Index begin, Index end)
    {
      for (Index i = begin; i < end; ++i)
      {
        const Vec3 d = other.closest(places[i]) - places[i];
        ofChunk[chunk] = std::max(ofChunk[chunk], dot(d, d));
      }
    });
  return ofChunk.empty() ? 0.0 : std::sqrt(*std::max_element(ofChunk.begin(), ofChunk.end()));
}
}
