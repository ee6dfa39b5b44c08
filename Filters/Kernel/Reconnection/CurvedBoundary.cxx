// SPDX-License-Identifier: BSD-3-Clause The permitted operations on a boundary that is kept within
// a distance.
#include "CavityOperations.h"

namespace tautline
{
namespace
{
/// Facets that share this many points with the ends of an edge are its walls.
constexpr std::size_t WallsOfEdge = 2;

TriangleVertices sorted(TriangleVertices f)
{
  std::sort(f.begin(), f.end());
  return f;
}

/// Sorts numbers and removes repetitions.
template <class Number>
void makeSet(std::vector<Number>& numbers)
{
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

template <class Number>
std::size_t countCommon(const std::vector<Number>& a, const std::vector<Number>& b)
{
  std::vector<Number> common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  return common.size();
}

/// The link of a point: its neighbors, its neighbors on the boundary, and the edges that face it.
struct PointLink
{
  std::vector<PointId> points, boundary;
  std::vector<std::array<PointId, 2>> edges;

  PointLink(const TetrahedronMesh& mesh, PointId v, const std::vector<TetId>& star)
  {
    for (TetId t : star)
    {
      const int at = mesh.tet(t).indexOf(v);
      const TriangleVertices f = sorted(mesh.face(t, at));
      this->points.insert(this->points.end(), f.begin(), f.end());
      this->edges.insert(this->edges.end(), { { f[0], f[1] }, { f[0], f[2] }, { f[1], f[2] } });
      for (int i = 0; i < 4; ++i)
      {
        if (i != at && mesh.tet(t).neighbors[i] == NoId)
        {
          for (PointId u : mesh.face(t, i))
          {
            if (u != v)
            {
              this->boundary.push_back(u);
            }
          }
        }
      }
    }
    makeSet(this->points);
    makeSet(this->boundary);
    makeSet(this->edges);
  }
};
}

//------------------------------------------------------------------------------
PointFreedom CavityOperations::freedomAt(PointId v) const
{
  const PointFreedom& freedom = this->freedoms[v];
  return freedom.isCurved() ? this->surface->at(this->Mesh.point(v), freedom) : freedom;
}

std::function<Vec3(const Vec3&)> CavityOperations::projectionOf(const PointFreedom& freedom) const
{
  if (!freedom.isCurved())
  {
    return nullptr;
  }
  return [this, freedom](const Vec3& x) { return this->surface->closest(x, freedom); };
}

int CavityOperations::patchOf(const TriangleVertices& f) const
{
  return this->surface->patchOf(
    this->facetOf(f), { this->freedoms[f[0]], this->freedoms[f[1]], this->freedoms[f[2]] });
}

std::array<Vec3, 3> CavityOperations::facetOf(const TriangleVertices& f) const
{
  return { this->Mesh.point(f[0]), this->Mesh.point(f[1]), this->Mesh.point(f[2]) };
}

bool CavityOperations::keepsSurface(const TriangleVertices& f) const
{
  const int patch = this->patchOf(f);
  return patch != NoId && this->surface->accepts(this->facetOf(f), patch);
}

/// Whether the facets of a point, whose star is `Star`, stay close to the boundary with the point
/// at p.
bool CavityOperations::keepsSurface(PointId v, const Vec3& p) const
{
  std::vector<BoundarySurface::Facet> former, facets;
  for (TetId t : this->Star)
  {
    for (int i = 0; i < 4; ++i)
    {
      const TriangleVertices f = this->Mesh.face(t, i);
      if (this->Mesh.tet(t).neighbors[i] != NoId || std::find(f.begin(), f.end(), v) == f.end())
      {
        continue;
      }
      std::array<Vec3, 3> x;
      for (int k = 0; k < 3; ++k)
      {
        x[k] = f[k] == v ? p : this->Mesh.point(f[k]);
      }
      const int patch = this->surface->patchOf(
        x, { this->freedoms[f[0]], this->freedoms[f[1]], this->freedoms[f[2]] });
      if (patch == NoId || !this->surface->accepts(x, patch))
      {
        return false;
      }
      facets.push_back(x);
      former.push_back(this->facetOf(f));
    }
  }
  return this->surface->keepsPoints(former, facets);
}

/// Whether the facets that the replacement adds to the boundary stay close to it.
bool CavityOperations::keepsSurface()
{
  std::vector<TriangleVertices> before;
  std::vector<BoundarySurface::Facet> former, facets;
  for (TetId t : this->Change.before)
  {
    for (int i = 0; i < 4; ++i)
    {
      const TriangleVertices f = this->Mesh.face(t, i);
      before.push_back(sorted(f));
      if (this->Mesh.tet(t).neighbors[i] == NoId)
      {
        former.push_back(this->facetOf(f));
      }
    }
  }
  makeSet(before);
  std::vector<std::pair<TriangleVertices, TriangleVertices>> faces;
  for (const TetVertices& v : this->Change.after)
  {
    for (const auto& f : OppositeFace)
    {
      const TriangleVertices face = { v[f[0]], v[f[1]], v[f[2]] };
      faces.push_back({ sorted(face), face });
    }
  }
  std::sort(faces.begin(), faces.end());
  for (std::size_t i = 0; i < faces.size(); ++i)
  {
    // A face that occurs twice is inside the replacement.
    const bool shared = (i > 0 && faces[i - 1].first == faces[i].first) ||
      (i + 1 < faces.size() && faces[i + 1].first == faces[i].first);
    if (shared)
    {
      continue;
    }
    const bool isNew = !std::binary_search(before.begin(), before.end(), faces[i].first);
    if (isNew && !this->keepsSurface(faces[i].second))
    {
      return false;
    }
    // (Faces toward the rest of the mesh are included: they can only be nearer.)
    if (isNew)
    {
      facets.push_back(this->facetOf(faces[i].second));
    }
  }
  return this->surface->keepsPoints(former, facets);
}

//------------------------------------------------------------------------------
/// Whether the edge of an open outer ring may be replaced by the other diagonal of its walls.
bool CavityOperations::canSwapCurved(const EdgeRing& ring)
{
  const auto kind = [this](PointId v) { return this->freedoms[v].kind; };
  const PointId first = ring.ring[0], last = ring.ring[ring.vertices - 1];
  // An edge between two curve points may belong to a curve, unless its walls are coplanar.
  if (kind(ring.a) != PointFreedom::InPlane && kind(ring.b) != PointFreedom::InPlane &&
    (!this->isFlat(ring) ||
      this->patchOf({ ring.a, ring.b, first }) != this->patchOf({ ring.a, ring.b, last })))
  {
    return false;
  }
  // The other diagonal must be new.
  this->Mesh.star(first, this->Star);
  return std::none_of(this->Star.begin(), this->Star.end(),
    [&](TetId t) { return this->Mesh.tet(t).indexOf(last) != NoId; });
}

/// Whether v may be contracted into w, the other end of the edge of an open ring: within its patch
/// or along its curve, and such that the boundary remains the same surface (the links of v and w
/// meet only in the link of the edge; T. K. Dey et al., "Topology preserving edge contraction",
/// 1999).
bool CavityOperations::canContractCurved(PointId v, PointId w, const EdgeRing& ring)
{
  if (!this->isOuter(ring))
  {
    return false;
  }
  const PointFreedom& freedom = this->freedoms[v];
  const PointId first = ring.ring[0], last = ring.ring[ring.vertices - 1];
  const bool joins = freedom.kind != PointFreedom::InPlane &&
    this->surface->joins(this->Mesh.point(v), freedom, this->Mesh.point(w), this->freedoms[w]);
  if (!joins &&
    (freedom.kind == PointFreedom::Fixed ||
      (freedom.kind == PointFreedom::InPlane
          ? !this->surface->touches(this->freedoms[w], freedom.part)
          : this->patchOf({ v, w, first }) == this->patchOf({ v, w, last }))))
  {
    return false;
  }
  this->Mesh.star(v, this->Star);
  this->Mesh.star(w, this->OtherStar);
  const PointLink own(this->Mesh, v, this->Star), other(this->Mesh, w, this->OtherStar);
  // The link condition, for the points, the edges and the boundary.
  if (countCommon(own.points, other.points) != static_cast<std::size_t>(ring.vertices) ||
    countCommon(own.edges, other.edges) != static_cast<std::size_t>(ring.size) ||
    countCommon(own.boundary, other.boundary) != WallsOfEdge)
  {
    return false;
  }
  // A facet of v must not coincide with a facet of w.
  const TriangleVertices opposite = sorted({ v, first, last });
  for (TetId t : this->Star)
  {
    for (int i = 0; i < 4; ++i)
    {
      if (this->Mesh.tet(t).neighbors[i] == NoId && sorted(this->Mesh.face(t, i)) == opposite)
      {
        return false;
      }
    }
  }
  return true;
}

//------------------------------------------------------------------------------
/// Prepares the insertion of a point into a facet of the boundary.
bool CavityOperations::prepareInsertion(const TriangleVertices& f, Insertion& insertion) const
{
  const int patch = this->patchOf(f);
  if (patch == NoId)
  {
    return false;
  }
  const PointFreedom freedom = this->surface->inPatch(patch);
  insertion.point = this->surface->closest(
    (1.0 / 3.0) * (this->Mesh.point(f[0]) + this->Mesh.point(f[1]) + this->Mesh.point(f[2])),
    freedom);
  insertion.freedom = this->surface->at(insertion.point, freedom);
  insertion.opened[0] = f;
  insertion.openedCount = 1;
  return true;
}

/// The same into the edge of an open outer ring: in its patch, or on its curve.
bool CavityOperations::prepareInsertion(const EdgeRing& ring, Insertion& insertion) const
{
  const PointFreedom &a = this->freedoms[ring.a], &b = this->freedoms[ring.b];
  const int patch = this->patchOf({ ring.a, ring.b, ring.ring[0] });
  const int other = this->patchOf({ ring.a, ring.b, ring.ring[ring.vertices - 1] });
  const bool inside = a.kind == PointFreedom::InPlane || b.kind == PointFreedom::InPlane;
  PointFreedom freedom;
  if (patch == NoId || other == NoId || (patch == other && !inside && !this->isFlat(ring)))
  {
    return false;
  }
  if (patch == other)
  {
    freedom = this->surface->inPatch(patch);
  }
  else
  {
    // On a curve, unless both ends are corners: only its points identify the curve.
    freedom = a.kind == PointFreedom::OnLine ? a : b;
    if (freedom.kind != PointFreedom::OnLine || !freedom.isCurved() ||
      (b.kind == PointFreedom::OnLine && b.part != freedom.part))
    {
      return false;
    }
  }
  insertion.point =
    this->surface->closest(0.5 * (this->Mesh.point(ring.a) + this->Mesh.point(ring.b)), freedom);
  insertion.freedom = this->surface->at(insertion.point, freedom);
  // The walls, in the order of the mesh.
  const std::array<std::array<PointId, 2>, 2> beyond = { { { ring.tets[0], ring.ring[1] },
    { ring.tets[ring.size - 1], ring.ring[ring.vertices - 2] } } };
  for (const auto& [t, v] : beyond)
  {
    insertion.opened[insertion.openedCount++] = this->Mesh.face(t, this->Mesh.tet(t).indexOf(v));
  }
  return true;
}
}
