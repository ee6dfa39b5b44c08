// SPDX-License-Identifier: BSD-3-Clause
#include "BoundarySurface.h"

#include "Constants.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Core/UnionFind.h"
#include "tautline/Mesh/Features.h"

#include <map>
#include <numeric>
#include <tuple>

namespace tautline
{
namespace
{

double diagonalOf(const std::vector<std::array<Vec3, 3>>& pieces)
{
  Vec3 low = pieces.front()[0], high = low;
  for (const auto& piece : pieces)
  {
    for (const Vec3& x : piece)
    {
      for (int k = 0; k < 3; ++k)
      {
        low[k] = std::min(low[k], x[k]);
        high[k] = std::max(high[k], x[k]);
      }
    }
  }
  return norm(high - low);
}

/// The outer facets, in the order of TetrahedronMesh::face().
SurfacePart boundaryOf(const TetrahedronMesh& mesh)
{
  SurfacePart part;
  for (TetId t = 0; t < mesh.slots(); ++t)
  {
    pollInterruption(static_cast<Index>(t));
    for (int i = 0; i < 4 && mesh.alive(t); ++i)
    {
      if (mesh.tet(t).neighbors[i] == NoId)
      {
        const TriangleVertices f = mesh.face(t, i);
        part.pieces.push_back({ mesh.point(f[0]), mesh.point(f[1]), mesh.point(f[2]) });
      }
    }
  }
  return part;
}

/// Marks the points of facets between regions.
std::vector<char> interfacePoints(const TetrahedronMesh& mesh)
{
  std::vector<char> flags(mesh.pointSlots(), 0);
  for (TetId t = 0; t < mesh.slots(); ++t)
  {
    for (int i = 0; i < 4; ++i)
    {
      if (mesh.isWall(t, i) && mesh.tet(t).neighbors[i] != NoId)
      {
        for (PointId v : mesh.face(t, i))
        {
          flags[v] = 1;
        }
      }
    }
  }
  return flags;
}

bool isEvenPermutation(const TriangleVertices& f, const std::array<Index, MaxFaceNodes>& nodes)
{
  const int at = f[0] == nodes[0] ? 0 : (f[1] == nodes[0] ? 1 : 2);
  return f[(at + 1) % 3] == nodes[1];
}

/// 1 if the facets are in the order of TetrahedronMesh::face(), otherwise -1.
double senseOf(const TetrahedronMesh& mesh, const Features& features)
{
  const auto& nodes = features.facets.front().nodes;
  std::array<Index, 3> wanted = { nodes[0], nodes[1], nodes[2] };
  std::sort(wanted.begin(), wanted.end());
  for (TetId t = 0; t < mesh.slots(); ++t)
  {
    for (int i = 0; i < 4; ++i)
    {
      const TriangleVertices f = mesh.face(t, i);
      std::array<Index, 3> key = { f[0], f[1], f[2] };
      std::sort(key.begin(), key.end());
      if (mesh.tet(t).neighbors[i] == NoId && key == wanted)
      {
        return isEvenPermutation(f, nodes) ? 1.0 : -1.0;
      }
    }
  }
  return 1.0;
}

/// The largest distance of the input samples from the boundary, as a multiple of the distance
/// limit: where a curved part is cut off, they are slightly farther from the chord than the middle
/// of the chord is from the input.
constexpr double BackFactor = 1.25;
/// The number of divisions of each edge, for the samples of facets.
constexpr int SampleDivisions = 2;
/// The maximum number of grid cells along the longest side of the box.
constexpr double MostCells = 100.0;
/// A box around points.
struct Box
{
  Vec3 low, high;
  void add(const Vec3& x) { this->join({ x, x }); }
  double joinedDiagonal(const Box& other) const
  {
    Vec3 d;
    for (int k = 0; k < 3; ++k)
    {
      d[k] = std::max(this->high[k], other.high[k]) - std::min(this->low[k], other.low[k]);
    }
    return norm(d);
  }
  void join(const Box& other)
  {
    for (int k = 0; k < 3; ++k)
    {
      this->low[k] = std::min(this->low[k], other.low[k]);
      this->high[k] = std::max(this->high[k], other.high[k]);
    }
  }
};
}

//------------------------------------------------------------------------------
void BoundarySurface::PointGrid::build(std::vector<Vec3> points)
{
  if (points.empty())
  {
    return;
  }
  Box box = { points.front(), points.front() };
  std::for_each(points.begin(), points.end(), [&](const Vec3& x) { box.add(x); });
  this->Low = box.low;
  // On a surface, the number of nonempty cells is about the number of points.
  const Vec3 d = box.high - box.low;
  const double longest = std::max({ d[0], d[1], d[2] });
  const double cells = std::ceil(std::sqrt(static_cast<double>(points.size())));
  this->Size = longest > 0.0 ? longest / std::min(cells, MostCells) : 1.0;
  for (int k = 0; k < 3; ++k)
  {
    this->Counts[k] = static_cast<Index>(d[k] / this->Size) + 1;
  }
  const auto number = [&](const Vec3& x)
  {
    const std::array<Index, 3> c = this->cellOf(x);
    return (c[2] * this->Counts[1] + c[1]) * this->Counts[0] + c[0];
  };
  // Counting sort of the points by grid cell.
  this->Starts.assign(this->Counts[0] * this->Counts[1] * this->Counts[2] + 1, 0);
  for (const Vec3& x : points)
  {
    ++this->Starts[number(x) + 1];
  }
  std::partial_sum(this->Starts.begin(), this->Starts.end(), this->Starts.begin());
  std::vector<Index> next(this->Starts.begin(), this->Starts.end() - 1);
  this->Points.resize(points.size());
  for (const Vec3& x : points)
  {
    this->Points[next[number(x)]++] = x;
  }
}

std::array<Index, 3> BoundarySurface::PointGrid::cellOf(const Vec3& x) const
{
  std::array<Index, 3> cell;
  for (int k = 0; k < 3; ++k)
  {
    const double at = (x[k] - this->Low[k]) / this->Size;
    cell[k] = static_cast<Index>(
      std::clamp(at, 0.0, static_cast<double>(std::max<Index>(this->Counts[k] - 1, 0))));
  }
  return cell;
}

template <class Visit>
bool BoundarySurface::PointGrid::all(const Vec3& low, const Vec3& high, const Visit& visit) const
{
  if (this->Points.empty())
  {
    return true;
  }
  // Cells of a row along x are contiguous.
  const std::array<Index, 3> a = this->cellOf(low), b = this->cellOf(high);
  for (Index k = a[2]; k <= b[2]; ++k)
  {
    for (Index j = a[1]; j <= b[1]; ++j)
    {
      const Index row = (k * this->Counts[1] + j) * this->Counts[0];
      for (Index n = this->Starts[row + a[0]]; n < this->Starts[row + b[0] + 1]; ++n)
      {
        const Vec3& x = this->Points[n];
        bool inside = true;
        for (int c = 0; c < 3; ++c)
        {
          inside = inside && x[c] >= low[c] && x[c] <= high[c];
        }
        if (inside && !visit(x))
        {
          return false;
        }
      }
    }
  }
  return true;
}

bool BoundarySurface::keepsPoints(
  const std::vector<Facet>& former, const std::vector<Facet>& facets) const
{
  const double reach = BackFactor * this->Distance;
  const auto isNear = [reach](const std::vector<Facet>& some, const Vec3& x)
  {
    return std::any_of(some.begin(), some.end(),
      [&](const Facet& f) { return norm(closestOnTriangle(f, x) - x) <= reach; });
  };
  if (former.empty())
  {
    return true;
  }
  // Every kept point near a former facet must be near a new one.
  Box box = { former[0][0], former[0][0] };
  for (const Facet& f : former)
  {
    std::for_each(f.begin(), f.end(), [&](const Vec3& x) { box.add(x); });
  }
  const Vec3 margin = { reach, reach, reach };
  return this->Kept.all(box.low - margin, box.high + margin,
    // Points that are not near a former facet are not affected by the change.
    [&](const Vec3& x) { return isNear(facets, x) || !isNear(former, x); });
}

//------------------------------------------------------------------------------
/// Joins corners at the ends of short edges into groups that are smaller than the distance limit;
/// all corners of a group touch all its patches.
void BoundarySurface::groupCorners(const Features& features, const TetrahedronMesh& changing,
  std::vector<std::vector<std::int32_t>>& touched)
{
  struct Edge
  {
    double length;
    PointId a, b;
    bool operator<(const Edge& other) const
    {
      return std::tie(this->length, this->a, this->b) < std::tie(other.length, other.a, other.b);
    }
  };
  const auto isCorner = [&](Index v)
  { return features.kind[v] == CornerPoint && this->Freedoms[v].kind == PointFreedom::Fixed; };
  std::vector<Edge> edges;
  for (const Features::Facet& facet : features.facets)
  {
    for (int k = 0; k < facet.size; ++k)
    {
      const Index a = facet.nodes[k], b = facet.nodes[(k + 1) % facet.size];
      const Vec3 d =
        changing.point(static_cast<PointId>(a)) - changing.point(static_cast<PointId>(b));
      if (a < b && isCorner(a) && isCorner(b) && norm(d) <= this->Distance)
      {
        edges.push_back({ norm(d), static_cast<PointId>(a), static_cast<PointId>(b) });
      }
    }
  }
  // Join from the shortest edge on, as long as the bounding box of the group fits the limit.
  std::sort(edges.begin(), edges.end());
  UnionFind groups(changing.pointSlots());
  std::map<Index, Box> boxes;
  const auto boxOf = [&](Index root) -> Box&
  {
    const Vec3& x = changing.point(static_cast<PointId>(root));
    return boxes.insert({ root, Box{ x, x } }).first->second;
  };
  for (const Edge& edge : edges)
  {
    const Index a = groups.find(edge.a), b = groups.find(edge.b);
    if (a == b || boxOf(a).joinedDiagonal(boxOf(b)) > this->Distance)
    {
      continue;
    }
    Box box = boxOf(a);
    box.join(boxOf(b));
    groups.join(a, b);
    boxes[groups.find(a)] = box;
  }
  // All corners of a group get the union of its patches.
  std::map<Index, std::vector<Index>> members;
  for (const Edge& edge : edges)
  {
    for (PointId v : { edge.a, edge.b })
    {
      members[groups.find(v)].push_back(v);
    }
  }
  for (auto& [root, points] : members)
  {
    std::vector<std::int32_t> all;
    for (Index v : points)
    {
      all.insert(all.end(), touched[v].begin(), touched[v].end());
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    for (Index v : points)
    {
      touched[v] = all;
      this->Freedoms[v].group = static_cast<std::int32_t>(root);
    }
  }
}

bool BoundarySurface::joins(
  const Vec3& x, const PointFreedom& from, const Vec3& y, const PointFreedom& to) const
{
  if (to.kind != PointFreedom::Fixed || to.patches == NoId || norm(y - x) > this->Distance)
  {
    return false;
  }
  // A corner can only join another corner of its group.
  if (from.kind == PointFreedom::Fixed)
  {
    return from.group != NoId && from.group == to.group;
  }
  // Other points may join a corner that touches all of their patches, so that no patch is cut off.
  const std::vector<std::int32_t>&own = this->Sets[from.patches], &all = this->Sets[to.patches];
  return std::includes(all.begin(), all.end(), own.begin(), own.end());
}

BoundarySurface::BoundarySurface(
  const Mesh& mesh, const TetrahedronMesh& changing, const ReconnectionOptions& options)
  : Cosine(std::cos(options.surfaceAngle * (Pi / 180.0)))
{
  FeatureOptions wanted;
  wanted.angle = options.featureAngle;
  const Features features = findFeatures(mesh, wanted);
  const SurfacePart boundary = boundaryOf(changing);
  this->Distance = std::max(options.surfaceTolerance, LeastDistance) * diagonalOf(boundary.pieces);
  const SurfaceModel model = makeSurfaceModel(mesh, features, false);
  this->Patches = model.patches;
  for (const SurfacePart& part : model.parts)
  {
    this->Parts.emplace_back(part, this->Distance);
  }
  this->Whole.emplace_back(boundary, nullptr);
  this->Sense = senseOf(changing, features);

  // The patches that each point touches.
  std::vector<std::vector<std::int32_t>> touched(changing.pointSlots());
  for (const Features::Facet& facet : features.facets)
  {
    for (int k = 0; k < facet.size; ++k)
    {
      std::vector<std::int32_t>& set = touched[facet.nodes[k]];
      const auto at = std::lower_bound(set.begin(), set.end(), facet.patch);
      if (at == set.end() || *at != facet.patch)
      {
        set.insert(at, facet.patch);
      }
    }
  }
  std::map<std::vector<std::int32_t>, std::int32_t> known;
  const auto numberOf = [&](const std::vector<std::int32_t>& set)
  {
    const auto [entry, isNew] = known.insert({ set, static_cast<std::int32_t>(this->Sets.size()) });
    if (isNew)
    {
      this->Sets.push_back(set);
    }
    return entry->second;
  };
  // Sets of single patches come first, so that they have the numbers of the patches.
  for (std::int32_t patch = 0; patch < this->Patches; ++patch)
  {
    numberOf({ patch });
  }
  const std::vector<char> interface = interfacePoints(changing);
  const std::vector<std::int32_t> parts = partsOfPoints(features);
  this->Freedoms.resize(changing.pointSlots());
  for (PointId v = 0; v < changing.pointSlots(); ++v)
  {
    PointFreedom& freedom = this->Freedoms[v];
    if (!touched[v].empty())
    {
      freedom.part = interface[v] ? NoId : parts[v];
      freedom.kind = freedom.part == NoId ? PointFreedom::Fixed
        : freedom.part < this->Patches    ? PointFreedom::InPlane
                                          : PointFreedom::OnLine;
    }
    else if (interface[v])
    {
      freedom.kind = PointFreedom::Fixed;
    }
  }
  this->Kept.build(this->Whole.front().samples(SampleDivisions));
  this->groupCorners(features, changing, touched);
  // The groups have changed the sets of their corners, so the sets are numbered only now.
  for (PointId v = 0; v < changing.pointSlots(); ++v)
  {
    this->Freedoms[v].patches = touched[v].empty() ? NoId : numberOf(touched[v]);
  }
}

PointFreedom BoundarySurface::at(const Vec3& x, PointFreedom freedom) const
{
  freedom.direction = this->Parts[freedom.part].direction(x);
  return freedom;
}

PointFreedom BoundarySurface::inPatch(int patch) const
{
  return { PointFreedom::InPlane, { 0, 0, 0 }, patch, patch };
}

bool BoundarySurface::touches(const PointFreedom& freedom, int patch) const
{
  return freedom.patches != NoId &&
    std::binary_search(
      this->Sets[freedom.patches].begin(), this->Sets[freedom.patches].end(), patch);
}

int BoundarySurface::patchOf(
  const std::array<Vec3, 3>& x, const std::array<PointFreedom, 3>& freedoms) const
{
  if (freedoms[0].patches == NoId)
  {
    return NoId;
  }
  int best = NoId;
  double smallest = 0.0;
  const Vec3 centre = (1.0 / 3.0) * (x[0] + x[1] + x[2]);
  const std::vector<std::int32_t>& candidates = this->Sets[freedoms[0].patches];
  for (std::int32_t patch : candidates)
  {
    if (!this->touches(freedoms[1], patch) || !this->touches(freedoms[2], patch))
    {
      continue;
    }
    // The distance is only used if there is a choice.
    const double d = candidates.size() > 1 ? this->Parts[patch].distanceOf(centre) : 0.0;
    if (best == NoId || d < smallest)
    {
      best = patch;
      smallest = d;
    }
  }
  return best;
}

bool BoundarySurface::accepts(const std::array<Vec3, 3>& x, int patch) const
{
  const auto& [a, b, c] = x;
  // The facets may be listed from inside: `Sense` makes their normals point outward.
  return this->Parts[patch].accepts(x, this->Sense * cross(b - a, c - a), this->Cosine);
}

double BoundarySurface::distance(const TetrahedronMesh& changed) const
{
  // The larger of both one-sided distances.
  const SurfaceProjection now(boundaryOf(changed), nullptr);
  return std::max(now.distanceTo(this->Whole.front(), 1, SampleDivisions),
    this->Whole.front().distanceTo(now, 1, SampleDivisions));
}
}
