// SPDX-License-Identifier: BSD-3-Clause
// Operations that improve the facets of the boundary.
#include "CavityOperations.h"

#include "Constants.h"
#include "FacetBound.h"

namespace tautline
{
namespace
{
/// A change of a facet may reduce the smallest quality of the surrounding tetrahedra to this
/// fraction: they can be improved later, whereas a bad facet prevents this.
constexpr double LeastShare = 0.3;
/// The minimum relative gain of the mean ratio of a facet: less does not justify a change.
constexpr double LeastFacetGain = 1e-2;
}

double CavityOperations::facetRatio(const TriangleVertices& f) const
{
  return facetMeanRatio(this->Mesh.point(f[0]), this->Mesh.point(f[1]), this->Mesh.point(f[2]));
}

/// The bound that the tetrahedra of a change must exceed.
double CavityOperations::tolerated(const std::vector<TetId>& tets) const
{
  double least = 1.0;
  for (TetId t : tets)
  {
    least = std::min(least, this->Mesh.quality(t));
  }
  return std::max(LeastShare * least, this->floor.quality * (1.0 - SameQuality));
}

/// Replaces the edge of vertices i and j, at which two facets meet, by the other diagonal.
bool CavityOperations::swapFacet(TetId t, int i, int j)
{
  this->Mesh.ring(t, i, j, this->Ring);
  const EdgeRing& ring = this->Ring;
  if (ring.closed || !ring.whole || ring.vertices < 3)
  {
    return false;
  }
  const PointId a = ring.a, b = ring.b, first = ring.ring[0], last = ring.ring[ring.vertices - 1];
  const double before =
    std::min(this->facetRatio({ a, b, first }), this->facetRatio({ a, b, last }));
  const double after =
    std::min(this->facetRatio({ a, first, last }), this->facetRatio({ b, first, last }));
  const std::vector<TetId> around(ring.tets.begin(), ring.tets.begin() + ring.size);
  if (!(after > before * (1.0 + LeastFacetGain)) ||
    !this->prepareEdgeRemoval(t, i, j, this->tolerated(around)) || !this->commit())
  {
    return false;
  }
  ++this->Counts.boundarySwaps;
  return true;
}

/// Contracts vertex i into vertex j, both on the boundary.
/// @param ratio the bound that all changed facets must exceed
bool CavityOperations::contractFacet(TetId t, int i, int j, double ratio)
{
  const PointId v = this->Mesh.tet(t).vertices[i], w = this->Mesh.tet(t).vertices[j];
  this->Mesh.star(v, this->Star);
  const double above = this->tolerated(this->Star);
  for (TetId s : this->Star)
  {
    const int at = this->Mesh.tet(s).indexOf(v);
    for (int k = 0; k < 4; ++k)
    {
      TriangleVertices f = this->Mesh.face(s, k);
      // The face opposite to v does not change, and facets with both points vanish.
      if (k == at || !this->Mesh.isWall(s, k) || std::find(f.begin(), f.end(), w) != f.end())
      {
        continue;
      }
      std::replace(f.begin(), f.end(), v, w);
      if (!(this->facetRatio(f) > ratio * (1.0 + LeastFacetGain)))
      {
        return false;
      }
    }
  }
  if (!this->prepareContraction(t, i, j, above) || !this->commit())
  {
    return false;
  }
  ++this->Counts.contractions;
  return true;
}

/// The smallest mean ratio of the walls of a point, whose star is `Star`, with the point at p.
double CavityOperations::smallestFacetRatio(PointId v, const Vec3& p) const
{
  double smallest = 1.0;
  for (TetId t : this->Star)
  {
    const int at = this->Mesh.tet(t).indexOf(v);
    for (int i = 0; i < 4; ++i)
    {
      if (i == at || !this->Mesh.isWall(t, i))
      {
        continue;
      }
      const TriangleVertices f = this->Mesh.face(t, i);
      const auto x = [&](int k) { return f[k] == v ? p : this->Mesh.point(f[k]); };
      smallest = std::min(smallest, facetMeanRatio(x(0), x(1), x(2)));
    }
  }
  return smallest;
}

/// Moves a boundary point toward the center of its boundary neighbors, on its patch or curve.
bool CavityOperations::moveFacet(PointId v, double ratio)
{
  PointFreedom freedom = this->freedoms[v];
  if (freedom.kind == PointFreedom::Fixed || freedom.kind == PointFreedom::Free ||
    !this->loadStar(v, this->Smoothing))
  {
    return false;
  }
  freedom = this->freedomAt(v);
  const double above = this->tolerated(this->Star);
  const Vec3 start = this->Mesh.point(v);
  Vec3 sum = { 0, 0, 0 };
  int count = 0;
  for (TetId t : this->Star)
  {
    const int at = this->Mesh.tet(t).indexOf(v);
    for (int i = 0; i < 4; ++i)
    {
      for (PointId u : this->Mesh.face(t, i))
      {
        const bool wall = i != at && this->Mesh.isWall(t, i) && u != v;
        sum += wall ? this->Mesh.point(u) : Vec3{ 0, 0, 0 };
        count += wall;
      }
    }
  }
  const Vec3 step = freedom.project((1.0 / std::max(count, 1)) * sum - start);
  const auto project = this->projectionOf(freedom);
  double length = 1.0;
  for (int k = 0; k < Halvings; ++k, length *= 0.5)
  {
    const Vec3 p = project ? project(start + length * step) : start + length * step;
    if (!(this->smallestFacetRatio(v, p) > ratio * (1.0 + LeastFacetGain)) ||
      !(this->Smoothing.evaluate(p) > above) || (freedom.isCurved() && !this->keepsSurface(v, p)))
    {
      continue;
    }
    const double* q = this->Smoothing.qualities();
    for (std::size_t n = 0; n < this->Star.size(); ++n)
    {
      const TriangleVertices f =
        this->Mesh.face(this->Star[n], this->Mesh.tet(this->Star[n]).indexOf(v));
      const Vec3 &a = this->Mesh.point(f[0]), &b = this->Mesh.point(f[1]),
                 &c = this->Mesh.point(f[2]);
      if ((q[n] <= CertainQuality && orientation(p, a, b, c) <= 0) ||
        !this->aboveFloor(p, a, b, c, q[n]))
      {
        return false;
      }
    }
    this->Mesh.movePoint(v, p, this->Star, q);
    this->Created = this->Star;
    this->touch(this->Created);
    ++this->Counts.moves;
    return true;
  }
  return false;
}

bool CavityOperations::improveFacet(TetId t, int i)
{
  const double ratio = this->facetRatio(this->Mesh.face(t, i));
  this->OfFacets = true;
  bool done = false;
  for (int k = 0; k < 3 && !done && this->swapsBoundary; ++k)
  {
    done = this->swapFacet(t, OppositeFace[i][k], OppositeFace[i][(k + 1) % 3]);
  }
  // All six ordered pairs of the corners of the facet.
  for (int k = 0; k < 6 && !done && this->contracts; ++k)
  {
    done =
      this->contractFacet(t, OppositeFace[i][k % 3], OppositeFace[i][(k + 1 + k / 3) % 3], ratio);
  }
  const TriangleVertices f = this->Mesh.face(t, i);
  for (int k = 0; k < 3 && !done && this->moves; ++k)
  {
    done = this->moveFacet(f[k], ratio);
  }
  this->OfFacets = false;
  return done;
}
}
