// SPDX-License-Identifier: BSD-3-Clause
// Insertion of points into cavities.
#include "CavityOperations.h"

namespace tautline
{
namespace
{
/// Not computed; less than any quality.
constexpr double Unknown = -2.0;
/// Used instead of the quality of a face that contains the point; more than any quality.
constexpr double Opened = 2.0;
/// Heights of a point over a plane below this, relative to the facet, are rounding errors.
constexpr double RoundingHeight = 1e-12;
/// Cavities grow to at most this many tetrahedra.
constexpr std::size_t MaxCavity = 48;
/// The number of steps of the new point after each growth of the cavity, and of growth rounds.
constexpr int PointSteps = 3, Rounds = 2;
}

/// Adds a tetrahedron to the cavity; its faces with the cavity vanish, the others become faces of
/// the cavity, with their qualities to be computed.
void CavityOperations::addToCavity(TetId t)
{
  this->Cavity.push_back(t);
  for (int i = 0; i < 4; ++i)
  {
    const std::int32_t n = this->Mesh.tet(t).neighbors[i];
    const auto shared = std::find_if(this->CavityFaces.begin(), this->CavityFaces.end(),
      [&](const CavityFace& f) { return n != NoId && f.tet == n >> 2 && f.face == (n & 3); });
    if (shared != this->CavityFaces.end())
    {
      *shared = this->CavityFaces.back();
      this->CavityFaces.pop_back();
    }
    else
    {
      this->CavityFaces.push_back({ t, i, Unknown });
    }
  }
}

/// Whether a face is on the boundary and in the plane of a point of the boundary: the point then
/// divides it, with the others of this plane in the cavity, into triangles.
bool CavityOperations::isOpened(const CavityFace& face, const Insertion& insertion) const
{
  if (insertion.freedom.kind == PointFreedom::Free ||
    this->Mesh.tet(face.tet).neighbors[face.face] != NoId)
  {
    return false;
  }
  const TriangleVertices f = this->Mesh.face(face.tet, face.face);
  if (insertion.freedom.isCurved())
  {
    const auto opened = insertion.opened.begin();
    return std::find(opened, opened + insertion.openedCount, f) != opened + insertion.openedCount;
  }
  const Vec3& a = this->Mesh.point(f[0]);
  const Vec3 n = cross(this->Mesh.point(f[1]) - a, this->Mesh.point(f[2]) - a);
  const double area = norm(n);
  // n has the length `area`, so this compares the height of the point with the size sqrt(area) of
  // the facet.
  return std::abs(dot(n, insertion.point - a)) <=
    std::max(this->flatTolerance, RoundingHeight) * area * std::sqrt(area);
}

/// Starting from the tetrahedra of the insertion: repeatedly adds the one behind the worst face,
/// and keeps the cavity with the best worst face. Then optimizes the point.
void CavityOperations::grow(Insertion& insertion)
{
  const Vec3& p = insertion.point;
  this->Cavity.clear();
  this->CavityFaces.clear();
  for (TetId t : insertion.tets)
  {
    this->addToCavity(t);
  }
  const std::size_t start = this->Cavity.size();
  double best = Unknown;
  std::size_t bestSize = start;
  while (true)
  {
    const CavityFace* worst = nullptr;
    for (CavityFace& f : this->CavityFaces)
    {
      if (f.quality == Unknown)
      {
        const TriangleVertices v = this->Mesh.face(f.tet, f.face);
        f.quality = this->isOpened(f, insertion)
          ? Opened
          : roundedQuality(p, this->Mesh.point(v[0]), this->Mesh.point(v[1]),
              this->Mesh.point(v[2]), this->Mesh.weights());
      }
      worst = !worst || f.quality < worst->quality ? &f : worst;
    }
    if (!worst)
    {
      break;
    }
    // Cavities only grow, so the best one is given by its number of tetrahedra.
    if (worst->quality > best)
    {
      best = worst->quality;
      bestSize = this->Cavity.size();
    }
    if (this->Mesh.isWall(worst->tet, worst->face) || this->Cavity.size() >= MaxCavity)
    {
      break;
    }
    this->addToCavity(this->Mesh.tet(worst->tet).neighbors[worst->face] >> 2);
  }
  insertion.tets.assign(this->Cavity.begin(), this->Cavity.begin() + bestSize);
  insertion.quality = best;
}

/// Grows a cavity from a start, and moves the point in it; keeps the best.
bool CavityOperations::startInsertion(
  const std::vector<TetId>& start, Insertion trial, Insertion& best)
{
  const auto project = this->projectionOf(trial.freedom);
  bool better = false;
  for (int round = 0; round < Rounds; ++round)
  {
    // Each round grows a cavity again, for the improved position of the point.
    trial.tets = start;
    this->grow(trial);
    if (!(trial.quality > 0.0))
    {
      break;
    }
    // Compute the faces of the kept cavity for the best point.
    this->Cavity.clear();
    this->CavityFaces.clear();
    for (TetId t : trial.tets)
    {
      this->addToCavity(t);
    }
    this->Smoothing.clear();
    this->Smoothing.weights = this->Mesh.weights();
    bool whole = true;
    for (const CavityFace& f : this->CavityFaces)
    {
      const TriangleVertices v = this->Mesh.face(f.tet, f.face);
      whole = whole &&
        (this->isOpened(f, trial) ||
          this->Smoothing.addFace(
            this->Mesh.point(v[0]), this->Mesh.point(v[1]), this->Mesh.point(v[2])));
    }
    if (!whole)
    {
      break;
    }
    trial.quality = this->Smoothing.maximize(trial.point, PointSteps, trial.freedom, project);
    if (trial.quality > best.quality)
    {
      best = trial;
      better = true;
    }
  }
  return better;
}

/// The freedom of a point on the edge of an open ring: in the plane of both walls, or along the
/// edge.
PointFreedom CavityOperations::freedomOnEdge(const EdgeRing& ring) const
{
  const Vec3& a = this->Mesh.point(ring.a);
  const Vec3 e = this->Mesh.point(ring.b) - a, n = cross(e, this->Mesh.point(ring.ring[0]) - a);
  return this->isFlat(ring) ? PointFreedom{ PointFreedom::InPlane, (1.0 / norm(n)) * n }
                            : PointFreedom{ PointFreedom::OnLine, (1.0 / norm(e)) * e };
}

/// The best point and cavity of all starts: the tetrahedron, the two at a face, rings of edges.
/// @param all the best of each start, if not null
bool CavityOperations::findInsertion(TetId t, Insertion& best, std::vector<Insertion>* all)
{
  if (this->Mesh.size() + 1 > this->largestSize)
  {
    this->countLimited = true;
    return false;
  }
  const double least = best.quality;
  const TetVertices v = this->Mesh.tet(t).vertices;
  const auto x = [&](int k) { return this->Mesh.point(v[k]); };
  const Vec3 sum = x(0) + x(1) + x(2) + x(3);
  const auto begin = [&](const std::vector<TetId>& tets, const Insertion& trial)
  {
    if (!all)
    {
      this->startInsertion(tets, trial, best);
      return;
    }
    Insertion own;
    own.quality = least;
    if (this->startInsertion(tets, trial, own))
    {
      all->push_back(own);
    }
  };
  const auto start =
    [&](const std::vector<TetId>& tets, const Vec3& point, const PointFreedom& freedom = {})
  {
    Insertion trial;
    trial.point = point;
    trial.freedom = freedom;
    begin(tets, trial);
  };
  start({ t }, 0.25 * sum);
  for (int i = 0; i < 4; ++i)
  {
    const Vec3 center = (1.0 / 3.0) * (sum - x(i));
    if (!this->Mesh.isWall(t, i))
    {
      start({ t, this->Mesh.tet(t).neighbors[i] >> 2 }, center);
    }
    else if (this->swapsBoundary && this->Mesh.tet(t).neighbors[i] == NoId && this->surface)
    {
      Insertion trial;
      if (this->prepareInsertion(this->Mesh.face(t, i), trial))
      {
        begin({ t }, trial);
      }
    }
    else if (this->swapsBoundary && this->Mesh.tet(t).neighbors[i] == NoId)
    {
      const int* f = OppositeFace[i];
      const Vec3 n = cross(x(f[1]) - x(f[0]), x(f[2]) - x(f[0]));
      start({ t }, center, { PointFreedom::InPlane, (1.0 / norm(n)) * n });
    }
    for (int j = i + 1; j < 4; ++j)
    {
      this->Mesh.ring(t, i, j, this->Ring);
      const EdgeRing& ring = this->Ring;
      Insertion trial;
      if (ring.whole && !ring.closed && this->surface)
      {
        if (this->isOuter(ring) && this->prepareInsertion(ring, trial))
        {
          begin({ ring.tets.begin(), ring.tets.begin() + ring.size }, trial);
        }
      }
      else if (ring.whole && (ring.closed || (this->swapsBoundary && this->isOuter(ring))))
      {
        start({ ring.tets.begin(), ring.tets.begin() + ring.size }, 0.5 * (x(i) + x(j)),
          ring.closed ? PointFreedom() : this->freedomOnEdge(ring));
      }
    }
  }
  return all ? !all->empty() : !best.tets.empty();
}

bool CavityOperations::applyInsertion(const Insertion& best)
{
  this->Cavity.clear();
  this->CavityFaces.clear();
  for (TetId s : best.tets)
  {
    this->addToCavity(s);
  }
  // A point freed by an earlier step of this change is reused: undoing must restore it.
  const PointId p = this->Mesh.nextPoint();
  Step former;
  former.point = p;
  former.isReused = p < this->Mesh.pointSlots();
  if (former.isReused)
  {
    former.position = this->Mesh.point(p);
    former.freedom = this->freedoms[p];
    former.metric = this->Mesh.hasMetrics() ? this->Mesh.metric(p) : EdgeMetric{};
  }
  this->Mesh.addPoint(best.point);
  this->freedoms.resize(this->Mesh.pointSlots());
  this->freedoms[p] = best.freedom;
  this->prepareStamps();
  this->Change.clear();
  this->Change.before = best.tets;
  this->Change.opensBoundary = best.freedom.kind != PointFreedom::Free;
  std::vector<PointId> kept = { p };
  for (const CavityFace& f : this->CavityFaces)
  {
    if (this->isOpened(f, best))
    {
      continue;
    }
    const TriangleVertices u = this->Mesh.face(f.tet, f.face);
    const TetVertices vertices = { p, u[0], u[1], u[2] };
    this->Change.add(vertices, this->Mesh.computeQuality(vertices));
    kept.insert(kept.end(), u.begin(), u.end());
  }
  // Points inside the cavity vanish: only free points may.
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  std::vector<PointId> around = kept;
  around.erase(std::find(around.begin(), around.end(), p));
  if (this->Mesh.hasMetrics())
  {
    this->Mesh.setMetric(p, this->meanMetric(around));
  }
  bool valid = this->keepsLengths(p, around, true);
  for (TetId s : best.tets)
  {
    for (PointId u : this->Mesh.tet(s).vertices)
    {
      valid = valid &&
        (this->freedoms[u].kind == PointFreedom::Free ||
          std::binary_search(kept.begin(), kept.end(), u));
    }
  }
  // This step precedes the step of commit(), so that it is undone last.
  if (this->Tentative)
  {
    this->Steps.push_back(former);
  }
  if (!valid || !this->commit())
  {
    this->Mesh.releasePoint(p);
    if (former.isReused)
    {
      this->restorePoint(former);
    }
    if (this->Tentative)
    {
      this->Steps.pop_back();
    }
    return false;
  }
  ++this->Counts.insertions;
  return true;
}

bool CavityOperations::insert(TetId t)
{
  Insertion best;
  best.quality = this->leastOf(t);
  return this->findInsertion(t, best) && this->applyInsertion(best);
}
}
