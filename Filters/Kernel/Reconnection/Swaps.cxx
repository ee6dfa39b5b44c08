// SPDX-License-Identifier: BSD-3-Clause
// Removal of edges and of faces.
#include "CavityOperations.h"

namespace tautline
{
namespace
{
/// The maximum depth of sheets of faces around the removed one.
constexpr int MaxSheetDepth = 4;
}

/// The best smallest quality of a triangulation of the ring, each triangle joined to both ends of
/// the edge; `Middle` has the triangles. Triangulations at most as good as `above` are not found.
double CavityOperations::triangulate(const EdgeRing& ring, double above)
{
  const int n = ring.vertices;
  const auto& r = ring.ring;
  // Dynamic programming over the subpolygons from i to j (Klincsek's algorithm), the shortest
  // first.
  for (int i = 0; i + 1 < n; ++i)
  {
    this->Best[i][i + 1] = 1.0;
  }
  for (int length = 2; length < n; ++length)
  {
    for (int i = 0; i + length < n; ++i)
    {
      const int j = i + length;
      double best = above;
      int middle = NoId;
      for (int k = i + 1; k < j; ++k)
      {
        double q = std::min(this->Best[i][k], this->Best[k][j]);
        if (q <= best)
        {
          continue;
        }
        q = std::min(q, this->Mesh.computeQuality({ r[i], r[k], r[j], ring.b }));
        q = q > best ? std::min(q, this->Mesh.computeQuality({ r[k], r[i], r[j], ring.a })) : q;
        if (q > best)
        {
          best = q;
          middle = k;
        }
      }
      this->Best[i][j] = middle == NoId ? -1.0 : best;
      this->Middle[i][j] = middle;
    }
  }
  return this->Best[0][n - 1];
}

void CavityOperations::addTriangles(const EdgeRing& ring, int i, int j)
{
  if (j - i < 2)
  {
    return;
  }
  const int k = this->Middle[i][j];
  const PointId x = ring.ring[i], y = ring.ring[k], z = ring.ring[j];
  for (const TetVertices& v : { TetVertices{ x, y, z, ring.b }, TetVertices{ y, x, z, ring.a } })
  {
    this->Change.add(v, this->Mesh.computeQuality(v));
  }
  this->addTriangles(ring, i, k);
  this->addTriangles(ring, k, j);
}

/// Whether the two walls at an open ring lie in one plane.
bool CavityOperations::isFlat(const EdgeRing& ring) const
{
  const Vec3& a = this->Mesh.point(ring.a);
  const Vec3 e = this->Mesh.point(ring.b) - a, u = this->Mesh.point(ring.ring[0]) - a,
             v = this->Mesh.point(ring.ring[ring.vertices - 1]) - a;
  const Vec3 m = cross(e, u), n = cross(v, e);
  // The relative length of the cross product is the sine of the angle between the walls.
  return dot(m, n) > 0.0 && norm(cross(m, n)) <= this->flatTolerance * norm(m) * norm(n);
}

/// Whether both walls of an open ring are on the outside, not between regions.
bool CavityOperations::isOuter(const EdgeRing& ring) const
{
  const TetId ends[2] = { ring.tets[0], ring.tets[ring.size - 1] };
  const PointId beyond[2] = { ring.ring[1], ring.ring[ring.vertices - 2] };
  return std::equal(ends, ends + 2, beyond,
    [&](TetId t, PointId v)
    { return this->Mesh.tet(t).neighbors[this->Mesh.tet(t).indexOf(v)] == NoId; });
}

/// Whether the edge of an open ring may be swapped: it is between two outer facets that are
/// coplanar or belong to a curved patch.
bool CavityOperations::canSwapBoundary(const EdgeRing& ring)
{
  return this->swapsBoundary && ring.size > 1 && this->isOuter(ring) &&
    (this->surface ? this->canSwapCurved(ring) : this->isFlat(ring));
}

/// Prepares the replacement that removes an edge. Returns false if it is not allowed, or if the
/// smallest quality would not exceed `above`.
bool CavityOperations::prepareEdgeRemoval(TetId t, int i, int j, double above)
{
  this->Mesh.ring(t, i, j, this->Ring);
  const EdgeRing& ring = this->Ring;
  if (!ring.whole || ring.vertices < 3 || (!ring.closed && !this->canSwapBoundary(ring)) ||
    !(this->sums ? this->canTriangulateForSum(ring) : this->triangulate(ring, above) > above))
  {
    return false;
  }
  this->Change.clear();
  this->Change.before.assign(ring.tets.begin(), ring.tets.begin() + ring.size);
  this->Change.opensBoundary = !ring.closed;
  if (!ring.closed && this->Mesh.hasLabels() && !this->labelBoundarySwap(ring))
  {
    return false;
  }
  this->addTriangles(ring, 0, ring.vertices - 1);
  return true;
}

bool CavityOperations::removeEdge(TetId t, int i, int j)
{
  if (!this->prepareEdgeRemoval(t, i, j, this->leastOf(t)) || !this->commit())
  {
    return false;
  }
  ++(this->Ring.closed ? this->Counts.edgeRemovals : this->Counts.boundarySwaps);
  return true;
}

//------------------------------------------------------------------------------
/**
 * @brief At the edge u w of a sheet of faces between a and b: closes the sheet with the tetrahedron
 * (a, b, u, w), or extends it by the face across, whichever is better; adds the result to the
 * replacement.
 * @param above the tetrahedron of the sheet with a, from which the face across is found
 * @return the smallest quality of the added tetrahedra
 */
double CavityOperations::extendFaces(
  PointId a, PointId b, TetId above, PointId u, PointId w, int depth)
{
  const TetVertices closing = { a, b, u, w };
  const double q = this->Mesh.computeQuality(closing);
  const std::size_t before = this->Change.before.size(), after = this->Change.after.size();
  // The tetrahedron with a beyond the edge, its face opposite a, and b below that face.
  const Tetrahedron& own = this->Mesh.tet(above);
  const PointId third =
    own.vertices[0] ^ own.vertices[1] ^ own.vertices[2] ^ own.vertices[3] ^ a ^ u ^ w;
  const int side = own.indexOf(third);
  if (depth < MaxSheetDepth && !this->Mesh.isWall(above, side))
  {
    const TetId next = own.neighbors[side] >> 2;
    const Tetrahedron& t = this->Mesh.tet(next);
    const int top = t.indexOf(a);
    if (!this->Mesh.isWall(next, top))
    {
      const TetId below = t.neighbors[top] >> 2;
      const PointId opposite = this->Mesh.tet(below).vertices[t.neighbors[top] & 3];
      if (opposite == b)
      {
        // The exclusive or of all vertices and three of them leaves the fourth.
        const PointId x = t.vertices[0] ^ t.vertices[1] ^ t.vertices[2] ^ t.vertices[3] ^ a ^ u ^ w;
        const double keep =
          std::min(q, std::min(this->Mesh.quality(next), this->Mesh.quality(below)));
        this->Change.before.push_back(next);
        this->Change.before.push_back(below);
        double extended = this->extendFaces(a, b, next, u, x, depth + 1);
        // The second edge is only extended if the first has not already made the extension worse.
        extended = extended > keep
          ? std::min(extended, this->extendFaces(a, b, next, x, w, depth + 1))
          : -1.0;
        if (extended > keep)
        {
          return extended;
        }
        // A failed extension must leave no trace before the closing tetrahedron is added.
        this->Change.before.resize(before);
        this->Change.after.resize(after);
        this->Change.qualities.resize(after);
      }
    }
  }
  this->Change.add(closing, q);
  return q;
}

/// Prepares the replacement that removes a face; like prepareEdgeRemoval().
bool CavityOperations::prepareFaceRemoval(TetId t, int i, double above)
{
  if (this->Mesh.isWall(t, i))
  {
    return false;
  }
  const std::int32_t across = this->Mesh.tet(t).neighbors[i];
  const PointId a = this->Mesh.tet(t).vertices[i];
  const PointId b = this->Mesh.tet(across >> 2).vertices[across & 3];
  const TriangleVertices f = this->Mesh.face(t, i);
  this->Change.clear();
  this->Change.before = { t, across >> 2 };
  double q = 1.0;
  for (int k = 0; k < 3 && q > above; ++k)
  {
    q = std::min(q, this->extendFaces(a, b, t, f[k], f[(k + 1) % 3], 0));
  }
  return q > above;
}

bool CavityOperations::removeFaces(TetId t, int i)
{
  if (!this->prepareFaceRemoval(t, i, this->leastOf(t)) || !this->commit())
  {
    return false;
  }
  ++this->Counts.faceRemovals;
  return true;
}
}
