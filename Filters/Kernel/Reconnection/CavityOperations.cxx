// SPDX-License-Identifier: BSD-3-Clause
#include "CavityOperations.h"

#include "Constants.h"

namespace tautline
{
namespace
{
/// The number of halvings of a step that leaves the boundary.
constexpr int SurfaceHalvings = 2;
}

void CavityOperations::addCounts(const OperationCounts& counts)
{
  this->Counts.edgeRemovals += counts.edgeRemovals;
  this->Counts.faceRemovals += counts.faceRemovals;
  this->Counts.boundarySwaps += counts.boundarySwaps;
  this->Counts.contractions += counts.contractions;
  this->Counts.insertions += counts.insertions;
  this->Counts.moves += counts.moves;
}

bool CavityOperations::aboveFloor(
  const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, double q) const
{
  // From this quality on, the other two bounds hold and need not be computed.
  if (q >= this->floor.sufficient)
  {
    return true;
  }
  return dihedralRange(p, a, b, c).smallest >= this->floor.smallestAngle &&
    measure(p, a, b, c).meanRatio >= this->floor.meanRatio;
}

/// Compares the qualities of the replacement in increasing order.
bool CavityOperations::improves()
{
  if (this->sums)
  {
    return this->decreasesSum();
  }
  this->Before.clear();
  for (TetId t : this->Change.before)
  {
    this->Before.push_back(this->Mesh.quality(t));
  }
  this->After = this->Change.qualities;
  std::sort(this->Before.begin(), this->Before.end());
  std::sort(this->After.begin(), this->After.end());
  // Lexicographic order: the worst pair of different qualities decides.
  for (std::size_t i = 0; i < std::min(this->Before.size(), this->After.size()); ++i)
  {
    if (std::abs(this->After[i] - this->Before[i]) > SameQuality * this->Before[i])
    {
      return this->After[i] > this->Before[i];
    }
  }
  // If all of them agree, fewer tetrahedra are better.
  return this->After.size() < this->Before.size();
}

/// Whether the replacement keeps the bounds of the count, and its tetrahedra are positive and,
/// unless checked later, above the floor.
bool CavityOperations::isValidChange()
{
  const Index size = this->Mesh.size() + static_cast<Index>(this->Change.after.size()) -
    static_cast<Index>(this->Change.before.size());
  const bool grows = size > this->Mesh.size(), shrinks = size < this->Mesh.size();
  if ((grows && size > this->largestSize) || (shrinks && size < this->smallestSize))
  {
    this->countLimited = true;
    return false;
  }
  for (std::size_t i = 0; i < this->Change.after.size(); ++i)
  {
    const TetVertices& v = this->Change.after[i];
    const double q = this->Change.qualities[i];
    // Near 0, the sign of the rounded quality is uncertain.
    if (q <= CertainQuality && this->Mesh.computeExactQuality(v) <= 0.0)
    {
      return false;
    }
    const auto x = [&](int k) { return this->Mesh.point(v[k]); };
    if (!this->Tentative && !this->aboveFloor(x(0), x(1), x(2), x(3), q))
    {
      return false;
    }
  }
  return !this->surface || !this->Change.opensBoundary || this->keepsSurface();
}

bool CavityOperations::applyChange()
{
  if (!this->Tentative)
  {
    return this->Mesh.replace(this->Change, this->Created);
  }
  // A record for undo().
  Step step;
  for (TetId t : this->Change.before)
  {
    step.before.push_back(this->Mesh.tet(t).vertices);
    step.qualities.push_back(this->Mesh.quality(t));
  }
  if (!this->Mesh.replace(this->Change, this->Created))
  {
    return false;
  }
  step.created = this->Created;
  step.opensBoundary = this->Change.opensBoundary;
  this->Steps.push_back(std::move(step));
  return true;
}

/// Carries out the replacement if it is an improvement, within the bounds and valid.
bool CavityOperations::commit()
{
  if (!this->Tentative && !this->OfFacets && !this->improves())
  {
    return false;
  }
  if (!this->isValidChange() || !this->applyChange())
  {
    return false;
  }
  this->touch(this->Created);
  return true;
}

void CavityOperations::touch(const std::vector<TetId>& tets)
{
  if (this->Tentative)
  {
    this->Affected.insert(this->Affected.end(), tets.begin(), tets.end());
    return;
  }
  // The stars of these vertices have changed, so that smoothing them may succeed again.
  ++this->Clock;
  for (TetId t : tets)
  {
    for (PointId v : this->Mesh.tet(t).vertices)
    {
      this->Stamps[v] = this->Clock;
    }
  }
}

//------------------------------------------------------------------------------
bool CavityOperations::loadStar(PointId v, StarSmoothing& star)
{
  this->Mesh.star(v, this->Star);
  star.clear();
  star.weights = this->Mesh.weights();
  // The arrays of StarSmoothing have a fixed size.
  if (this->Star.size() > StarSmoothing::MaxFaces)
  {
    return false;
  }
  for (TetId t : this->Star)
  {
    const TriangleVertices f = this->Mesh.face(t, this->Mesh.tet(t).indexOf(v));
    star.addFace(this->Mesh.point(f[0]), this->Mesh.point(f[1]), this->Mesh.point(f[2]));
  }
  return true;
}

bool CavityOperations::smooth(PointId v, int steps)
{
  // Already tried without success since the last change of the star; tentative changes leave no
  // stamps.
  const bool known = !this->Tentative && this->SmoothedAt[v] > this->Stamps[v];
  if (this->freedoms[v].kind == PointFreedom::Fixed || known)
  {
    return false;
  }
  if (this->sums)
  {
    return this->improveSum(v);
  }
  if (this->field)
  {
    return this->smoothInMetric(v, steps);
  }
  if (!this->loadStar(v, this->Smoothing))
  {
    return false;
  }
  double before = 1.0;
  for (TetId t : this->Star)
  {
    before = std::min(before, this->Mesh.quality(t));
  }
  Vec3 p = this->Mesh.point(v);
  const PointFreedom freedom = this->freedomAt(v);
  const auto project = this->projectionOf(freedom);
  double after = this->Smoothing.maximize(p, steps, freedom, project);
  // A shorter step may stay on the boundary.
  for (int k = 0;
       freedom.isCurved() && k < SurfaceHalvings && after > before && !this->keepsSurface(v, p);
       ++k)
  {
    p = project(0.5 * (p + this->Mesh.point(v)));
    after = this->Smoothing.evaluate(p);
  }
  if (!(after > before * (1.0 + SameQuality)) || p == this->Mesh.point(v) ||
    (freedom.isCurved() && !this->keepsSurface(v, p)))
  {
    // The failure is remembered until the star changes.
    this->SmoothedAt[v] = this->Tentative ? this->SmoothedAt[v] : this->Clock + 1;
    return false;
  }
  const double* q = this->Smoothing.qualities();
  const bool check = after < this->floor.sufficient && !this->Tentative;
  for (std::size_t i = 0; i < this->Star.size() && check; ++i)
  {
    const TriangleVertices f =
      this->Mesh.face(this->Star[i], this->Mesh.tet(this->Star[i]).indexOf(v));
    const Vec3 &a = this->Mesh.point(f[0]), &b = this->Mesh.point(f[1]),
               &c = this->Mesh.point(f[2]);
    if ((q[i] <= CertainQuality && orientation(p, a, b, c) <= 0) ||
      !this->aboveFloor(p, a, b, c, q[i]))
    {
      return false;
    }
  }
  if (this->Tentative)
  {
    Step step;
    step.point = v;
    step.position = this->Mesh.point(v);
    step.created = this->Star;
    for (TetId t : this->Star)
    {
      step.qualities.push_back(this->Mesh.quality(t));
    }
    this->Steps.push_back(std::move(step));
  }
  this->Mesh.movePoint(v, p, this->Star, q);
  this->Created = this->Star;
  this->touch(this->Created);
  ++this->Counts.moves;
  return true;
}

//------------------------------------------------------------------------------
/// Whether the new edges of a point are not too short (insertion) or too long (contraction).
bool CavityOperations::keepsLengths(
  PointId v, const std::vector<PointId>& others, bool isInsertion) const
{
  const double factor = this->edgeFactor * this->edgeFactor;
  return !this->Mesh.hasMetrics() ||
    std::all_of(others.begin(), others.end(),
      [&](PointId u)
      {
        const double length = u == v ? 1.0
                                     : squaredLength(this->Mesh.point(u) - this->Mesh.point(v),
                                         this->Mesh.metric(u), this->Mesh.metric(v));
        return isInsertion ? length * factor >= 1.0 : length <= factor;
      });
}

/// The mean of the metrics of points.
EdgeMetric CavityOperations::meanMetric(const std::vector<PointId>& points) const
{
  EdgeMetric mean = {};
  for (PointId u : points)
  {
    for (std::size_t k = 0; k < mean.size(); ++k)
    {
      mean[k] += this->Mesh.metric(u)[k] / static_cast<double>(points.size());
    }
  }
  return mean;
}

/// Whether contracting v into its neighbor w preserves walls and fixed points.
bool CavityOperations::canContract(PointId v, PointId w, const EdgeRing& ring)
{
  const PointFreedom& freedom = this->freedoms[v];
  if (freedom.kind == PointFreedom::Free)
  {
    return true;
  }
  const bool fixed = freedom.kind == PointFreedom::Fixed;
  if ((fixed && freedom.group == NoId) || ring.closed || !ring.whole)
  {
    return false;
  }
  if (fixed || freedom.isCurved())
  {
    return this->canContractCurved(v, w, ring);
  }
  // A point in a flat wall may only move within it.
  const Vec3 d = this->Mesh.point(w) - this->Mesh.point(v);
  return norm(d - freedom.project(d)) <= this->flatTolerance * norm(d);
}

/// Prepares the replacement that contracts vertex i into vertex j. Returns false if it is not
/// allowed, or if a new tetrahedron is not better than `above`.
bool CavityOperations::prepareContraction(TetId t, int i, int j, double above)
{
  const PointId v = this->Mesh.tet(t).vertices[i], w = this->Mesh.tet(t).vertices[j];
  const bool free = this->freedoms[v].kind == PointFreedom::Free;
  if (!free)
  {
    this->Mesh.ring(t, i, j, this->Ring);
  }
  if (!this->canContract(v, w, this->Ring))
  {
    return false;
  }
  this->Mesh.star(v, this->Star);
  this->Change.clear();
  this->Change.before = this->Star;
  this->Change.opensBoundary = !free;
  for (TetId s : this->Star)
  {
    if (this->Mesh.region(s) != this->Mesh.region(t))
    {
      return false; // a point between regions
    }
    // Tetrahedra that have both points vanish.
    if (this->Mesh.tet(s).indexOf(w) != NoId)
    {
      continue;
    }
    TetVertices vertices = this->Mesh.tet(s).vertices;
    vertices[this->Mesh.tet(s).indexOf(v)] = w;
    const double q = this->Mesh.computeQuality(vertices);
    if (!(q > above))
    {
      return false;
    }
    this->Change.add(vertices, q);
    if (!this->keepsLengths(w, { vertices.begin(), vertices.end() }, false))
    {
      return false;
    }
  }
  return true;
}

bool CavityOperations::contract(TetId t, int i, int j)
{
  if (!this->prepareContraction(t, i, j, this->leastOf(t)) || !this->commit())
  {
    return false;
  }
  ++this->Counts.contractions;
  return true;
}
}
