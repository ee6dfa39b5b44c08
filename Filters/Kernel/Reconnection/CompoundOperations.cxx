// SPDX-License-Identifier: BSD-3-Clause
// Operations that pay only after the vertices around have moved.
#include "CavityOperations.h"

namespace tautline
{
namespace
{
/// A tentative change may reduce the smallest quality to this fraction.
constexpr double Tolerated = 0.5;
/// The number of best insertions that are tried.
constexpr std::size_t MaxInsertions = 4;
/// The number of smoothing rounds before a tentative change is evaluated, and of steps per vertex
/// in a round.
constexpr int Rounds = 4, RoundSteps = 2;
/// After these, the worst tetrahedron is repaired if its quality is at least this fraction of the
/// quality before the change.
constexpr double Repairable = 0.5;
}

/// Moves the vertices of the affected tetrahedra; returns true as soon as all of these exceed a
/// quality.
bool CavityOperations::smoothAround(double above)
{
  this->cleanAffected();
  std::vector<PointId> vertices;
  for (TetId t : this->Affected)
  {
    const TetVertices& v = this->Mesh.tet(t).vertices;
    vertices.insert(vertices.end(), v.begin(), v.end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  // Smoothing adds to the affected tetrahedra, but the change is judged by these.
  const std::vector<TetId> core = this->Affected;
  for (int round = 0; round < Rounds; ++round)
  {
    bool moved = false;
    for (PointId v : vertices)
    {
      moved = this->smooth(v, RoundSteps) || moved;
    }
    const bool done =
      std::all_of(core.begin(), core.end(), [&](TetId t) { return this->Mesh.quality(t) > above; });
    if (done || !moved)
    {
      return done;
    }
  }
  return false;
}

/// Removes deleted tetrahedra and repetitions from the affected ones.
void CavityOperations::cleanAffected()
{
  std::vector<TetId>& tets = this->Affected;
  std::sort(tets.begin(), tets.end());
  tets.erase(std::unique(tets.begin(), tets.end()), tets.end());
  tets.erase(
    std::remove_if(tets.begin(), tets.end(), [this](TetId t) { return !this->Mesh.alive(t); }),
    tets.end());
}

/// Improves the worst of the affected tetrahedra by a swap or an insertion.
bool CavityOperations::repair(TetId t)
{
  const double q = this->Mesh.quality(t) * (1.0 + 2.0 * CertainQuality);
  for (int i = 0; i < 4; ++i)
  {
    for (int j = i + 1; j < 4; ++j)
    {
      if (this->prepareEdgeRemoval(t, i, j, q) && this->commit())
      {
        ++(this->Ring.closed ? this->Counts.edgeRemovals : this->Counts.boundarySwaps);
        return true;
      }
    }
    if (this->prepareFaceRemoval(t, i, q) && this->commit())
    {
      ++this->Counts.faceRemovals;
      return true;
    }
  }
  Insertion best;
  best.quality = q;
  return this->inserts && this->findInsertion(t, best) && this->applyInsertion(best);
}

/// After a change that smoothing did not turn into an improvement: repeatedly repairs the worst of
/// the affected tetrahedra.
bool CavityOperations::repairAround(double above)
{
  for (int k = 0; k < this->repairs; ++k)
  {
    this->cleanAffected();
    const auto worst = std::min_element(this->Affected.begin(), this->Affected.end(),
      [this](TetId a, TetId b) { return this->Mesh.quality(a) < this->Mesh.quality(b); });
    if (worst == this->Affected.end() || this->Mesh.quality(*worst) < Repairable * above ||
      !this->repair(*worst))
    {
      return false;
    }
    if (this->smoothAround(above))
    {
      return true;
    }
  }
  return false;
}

/// Keeps the tentative steps if every affected tetrahedron is above a quality and the floor.
bool CavityOperations::finishCompound(double above)
{
  this->cleanAffected();
  // Tentative changes skip the exact checks, which are made up for here.
  for (TetId t : this->Affected)
  {
    const TetVertices& v = this->Mesh.tet(t).vertices;
    const auto x = [&](int k) { return this->Mesh.point(v[k]); };
    const double q = this->Mesh.quality(t);
    if (!(q > above) || this->Mesh.computeExactQuality(v) <= 0.0 ||
      !this->aboveFloor(x(0), x(1), x(2), x(3), q))
    {
      return false;
    }
  }
  return true;
}

/// Restores the former position and freedom of an unused point.
void CavityOperations::restorePoint(const Step& step)
{
  this->Mesh.movePoint(step.point, step.position, {}, nullptr);
  this->freedoms[step.point] = step.freedom;
  if (this->Mesh.hasMetrics())
  {
    this->Mesh.setMetric(step.point, step.metric);
  }
}

void CavityOperations::undo()
{
  // In reverse order, so that each step finds the tetrahedra that it has created.
  for (auto step = this->Steps.rbegin(); step != this->Steps.rend(); ++step)
  {
    this->Change.clear();
    // A step without tetrahedra only records a point that was reused.
    if (step->created.empty())
    {
      if (step->isReused)
      {
        this->restorePoint(*step);
      }
      continue;
    }
    // A step without former tetrahedra is the motion of a point.
    if (step->before.empty())
    {
      this->Mesh.movePoint(step->point, step->position, step->created, step->qualities.data());
      continue;
    }
    this->Change.before = step->created;
    this->Change.opensBoundary = step->opensBoundary;
    for (std::size_t i = 0; i < step->before.size(); ++i)
    {
      const TetVertices& v = step->before[i];
      for (PointId u : v)
      {
        // The step has removed this point, which is needed again.
        if (!this->Mesh.used(u))
        {
          this->Mesh.reclaimPoint(u);
        }
      }
      this->Change.add(v, step->qualities[i]);
    }
    this->Mesh.replace(this->Change, this->Created);
  }
}

/// Makes a tentative change, moves the surrounding vertices, and keeps both or neither.
template <class Operation>
bool CavityOperations::attempt(double above, const Operation& operation)
{
  const OperationCounts counts = this->Counts;
  this->Steps.clear();
  this->Affected.clear();
  this->Tentative = true;
  const bool changed = operation();
  const bool kept = changed && (this->smoothAround(above) || this->repairAround(above)) &&
    this->finishCompound(above);
  if (changed && !kept)
  {
    this->undo();
  }
  this->Tentative = false;
  if (!kept)
  {
    this->Counts = counts;
    return false;
  }
  this->Created = this->Affected;
  this->touch(this->Created);
  return true;
}

bool CavityOperations::tryInsertions(TetId t, double above)
{
  Insertion least;
  least.quality = Tolerated * this->Mesh.quality(t);
  std::vector<Insertion> all;
  this->findInsertion(t, least, &all);
  std::stable_sort(all.begin(), all.end(),
    [](const Insertion& a, const Insertion& b) { return a.quality > b.quality; });
  for (std::size_t i = 0; i < std::min(all.size(), MaxInsertions); ++i)
  {
    if (this->attempt(above, [&]() { return this->applyInsertion(all[i]); }))
    {
      return true;
    }
  }
  return false;
}

bool CavityOperations::tryCompound(TetId t, Compound kind)
{
  const double q = this->Mesh.quality(t), tolerated = Tolerated * q;
  const double above = q * (1.0 + 2.0 * CertainQuality);
  if (kind == Compound::Insertion)
  {
    return this->tryInsertions(t, above);
  }
  const auto contract = [&](int i, int j)
  {
    const bool done = this->prepareContraction(t, i, j, tolerated) && this->commit();
    this->Counts.contractions += done;
    return done;
  };
  const auto removeEdge = [&](int i, int j)
  {
    const bool done = this->prepareEdgeRemoval(t, i, j, tolerated) && this->commit();
    this->Counts.edgeRemovals += done && this->Ring.closed;
    this->Counts.boundarySwaps += done && !this->Ring.closed;
    return done;
  };
  const auto removeFace = [&](int i)
  {
    const bool done = this->prepareFaceRemoval(t, i, tolerated) && this->commit();
    this->Counts.faceRemovals += done;
    return done;
  };
  for (int i = 0; i < 4; ++i)
  {
    for (int j = 0; j < 4; ++j)
    {
      // A contraction has a direction, the removal of an edge does not.
      const bool done = kind == Compound::Contraction
        ? i != j && this->attempt(above, [&]() { return contract(i, j); })
        : i < j &&
          this->attempt(
            above, [&]() { return removeEdge(i, j); });
      if (done)
      {
        return true;
      }
    }
    if (kind == Compound::Swap && this->attempt(above, [&]() { return removeFace(i); }))
    {
      return true;
    }
  }
  return false;
}
}
