// Operations that pay only after the vertices around have moved.
#include "CavityOperations.h"

namespace tautline
{
namespace
{
/// A tentative change may lower the smallest quality to this fraction.
constexpr double Tolerated = 0.5;
/// Of the insertions found, so many of the best are tried.
constexpr std::size_t MaxInsertions = 4;
/// Rounds of smoothing before a tentative change is judged, and steps of each vertex in a round.
constexpr int Rounds = 4, RoundSteps = 2;
}

/// Moves the vertices of the affected tetrahedra; true as soon as all of these are above a quality.
bool CavityOperations::smoothAround(double above)
{
  std::vector<PointId> vertices;
  for (TetId t : this->Affected)
  {
    const TetVertices& v = this->Mesh.tet(t).vertices;
    vertices.insert(vertices.end(), v.begin(), v.end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
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

/// Keeps the tentative steps if every affected tetrahedron is above a quality and the floor.
bool CavityOperations::finishCompound(double above)
{
  std::sort(this->Affected.begin(), this->Affected.end());
  this->Affected.erase(
    std::unique(this->Affected.begin(), this->Affected.end()), this->Affected.end());
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

void CavityOperations::undo()
{
  for (auto step = this->Steps.rbegin(); step != this->Steps.rend(); ++step)
  {
    this->Change.clear();
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

/// Makes a tentative change, moves the vertices around, and keeps both or neither.
template <class Operation>
bool CavityOperations::attempt(double above, const Operation& operation)
{
  const OperationCounts counts = this->Counts;
  this->Steps.clear();
  this->Affected.clear();
  this->Tentative = true;
  const bool changed = operation();
  const bool kept = changed && this->smoothAround(above) && this->finishCompound(above);
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
