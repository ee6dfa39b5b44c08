// SPDX-License-Identifier: BSD-3-Clause
#include "TetrahedronPasses.h"

#include "Constants.h"
#include "FacetBound.h"
#include "tautline/Core/Interruption.h"

namespace tautline
{
namespace
{
/// The number of attempts between two calls of `proceed`.
constexpr Index ProceedInterval = 64;
}

double TetrahedronPasses::bound(TetId t) const
{
  const QualityWeights& weights = this->Mesh.weights();
  double result = 1.0;
  Vec3 normals[4];
  int walls = 0;
  for (int i = 0; i < 4; ++i)
  {
    if (!this->Mesh.isWall(t, i))
    {
      continue;
    }
    const TriangleVertices f = this->Mesh.face(t, i);
    const Vec3 &a = this->Mesh.point(f[0]), &b = this->Mesh.point(f[1]),
               &c = this->Mesh.point(f[2]);
    result = std::min(result, weights.meanRatio * facetMeanRatio(a, b, c));
    const Vec3 n = cross(b - a, c - a);
    normals[walls++] = (1.0 / norm(n)) * n;
  }
  // Two walls at one edge: the angle between them is preserved or divided.
  for (int i = 0; i < walls; ++i)
  {
    for (int j = i + 1; j < walls; ++j)
    {
      if (dot(normals[i], normals[j]) < 0.0)
      {
        result = std::min(result, weights.sine * norm(cross(normals[i], normals[j])));
      }
    }
  }
  return result;
}

bool TetrahedronPasses::isAtBound(TetId t) const
{
  return this->bound(t) <= this->Mesh.quality(t) * (1.0 + AtBound);
}

void TetrahedronPasses::push(TetId t, double target)
{
  const double q = this->Mesh.quality(t);
  if (q < target)
  {
    this->Waiting.push({ q, t });
  }
}

bool TetrahedronPasses::isFlagged(TetId t, const std::vector<char>& flags) const
{
  const TetVertices& v = this->Mesh.tet(t).vertices;
  return std::any_of(v.begin(), v.end(),
    [&](PointId p) { return p < static_cast<PointId>(flags.size()) && flags[p]; });
}

/// Whether a pass starts with a tetrahedron; not for tetrahedra outside a block.
bool TetrahedronPasses::startsWith(TetId t) const
{
  return this->Mesh.alive(t) && this->Mesh.region(t) >= 0 &&
    (this->starts.empty() || this->isFlagged(t, this->starts));
}

bool TetrahedronPasses::swap(TetId t)
{
  for (int i = 0; i < 4; ++i)
  {
    for (int j = i + 1; j < 4; ++j)
    {
      if (this->Operations.removeEdge(t, i, j))
      {
        return true;
      }
    }
  }
  for (int i = 0; i < 4; ++i)
  {
    if (this->Operations.removeFaces(t, i))
    {
      return true;
    }
  }
  return false;
}

bool TetrahedronPasses::contract(TetId t)
{
  for (int i = 0; i < 4; ++i)
  {
    for (int j = 0; j < 4; ++j)
    {
      if (i != j && this->Operations.contract(t, i, j))
      {
        return true;
      }
    }
  }
  return false;
}

bool TetrahedronPasses::improve(TetId t, const PassOptions& options)
{
  const auto pushChanged = [&]()
  {
    for (TetId s : this->Operations.changed())
    {
      this->push(s, options.target);
    }
  };
  if (options.swap && this->swap(t))
  {
    pushChanged();
    return true;
  }
  bool moved = false;
  if (options.smooth)
  {
    const TetVertices v = this->Mesh.tet(t).vertices;
    for (int i = 0; i < 4; ++i)
    {
      if (this->Operations.smooth(v[i], options.smoothingSteps))
      {
        moved = true;
        pushChanged();
      }
    }
  }
  if (moved)
  {
    return true;
  }
  if (this->isFlagged(t, this->postponed))
  {
    return false;
  }
  using Compound = CavityOperations::Compound;
  const auto tryCompound = [&](Compound kind)
  { return options.compound && this->Operations.tryCompound(t, kind); };
  if ((options.contract && this->contract(t)) || (options.insert && this->Operations.insert(t)) ||
    (options.swap && tryCompound(Compound::Swap)) ||
    (options.insert && tryCompound(Compound::Insertion)) ||
    (options.contract && tryCompound(Compound::Contraction)))
  {
    pushChanged();
    return true;
  }
  return false;
}

/// Improves the boundary facets whose mean ratio bounds qualities below a target, the worst first.
Index TetrahedronPasses::runFacets(double target)
{
  const double weight = this->Mesh.weights().meanRatio;
  const auto ratioOf = [&](TetId t, int i)
  {
    const TriangleVertices f = this->Mesh.face(t, i);
    return weight *
      facetMeanRatio(this->Mesh.point(f[0]), this->Mesh.point(f[1]), this->Mesh.point(f[2]));
  };
  QualityQueue<std::int32_t> waiting; // 4 x tetrahedron + face
  const auto push = [&](TetId t)
  {
    for (int i = 0; i < 4; ++i)
    {
      if (this->Mesh.tet(t).neighbors[i] == NoId && ratioOf(t, i) < target)
      {
        waiting.push({ ratioOf(t, i), 4 * t + i });
      }
    }
  };
  this->Operations.prepareStamps();
  std::vector<std::uint32_t> tried;
  for (TetId t = 0; t < this->Mesh.slots(); ++t)
  {
    pollInterruption(t);
    if (this->startsWith(t))
    {
      push(t);
    }
  }
  Index accepted = 0, tries = 0;
  for (Index looked = 0; !waiting.empty(); ++looked)
  {
    pollInterruption(looked);
    const auto [ratio, code] = waiting.pop();
    const TetId t = code >> 2;
    if (!this->Mesh.alive(t) || this->Mesh.tet(t).neighbors[code & 3] != NoId ||
      ratioOf(t, code & 3) != ratio || this->isFlagged(t, this->postponed))
    {
      continue; // changed since
    }
    tried.resize(4 * this->Mesh.slots(), 0);
    std::uint32_t newest = 0;
    for (PointId v : this->Mesh.face(t, code & 3))
    {
      newest = std::max(newest, this->Operations.stamp(v));
    }
    if (tried[code] > newest)
    {
      continue;
    }
    if (++tries % ProceedInterval == 0 && this->proceed && !this->proceed())
    {
      return -1;
    }
    if (this->Operations.improveFacet(t, code & 3))
    {
      ++accepted;
      for (TetId s : this->Operations.changed())
      {
        push(s);
      }
    }
    else
    {
      tried[code] = this->Operations.clock() + 1;
    }
  }
  return accepted;
}

Index TetrahedronPasses::run(const PassOptions& options)
{
  Index accepted = 0;
  if (options.facets)
  {
    accepted = this->runFacets(options.target);
    if (accepted < 0)
    {
      return -1;
    }
  }
  ++this->PassNumber;
  // Tetrahedra on which the most thorough passes failed are skipped until their surroundings
  // change.
  const std::int16_t effort = !options.compound ? 0 : options.repairs > 0 ? 2 : 1;
  this->Operations.prepareStamps();
  this->Operations.setLeastGain(options.leastGain);
  this->Operations.repairs = options.repairs;
  this->Waiting.fill(this->Mesh,
    [&](TetId t) { return this->startsWith(t) && this->Mesh.quality(t) < options.target; });
  Index tries = 0, failures = 0;
  for (Index looked = 0;
       !this->Waiting.empty() && (options.maxFailures == 0 || failures < options.maxFailures);
       ++looked)
  {
    pollInterruption(looked);
    const auto [quality, t] = this->Waiting.pop();
    if (!this->Mesh.alive(t) || this->Mesh.quality(t) != quality)
    {
      continue; // changed since
    }
    this->Tried.resize(this->Mesh.slots());
    std::uint32_t newest = 0;
    for (PointId v : this->Mesh.tet(t).vertices)
    {
      newest = std::max(newest, this->Operations.stamp(v));
    }
    const Attempt& last = this->Tried[t];
    const bool repeats = last.clock > newest &&
      (last.pass == this->PassNumber || (last.effort > 0 && last.effort >= effort));
    if (repeats || (options.skipsBound && this->isAtBound(t)))
    {
      continue;
    }
    if (++tries % ProceedInterval == 0 && this->proceed && !this->proceed())
    {
      return -1;
    }
    this->Operations.countLimited = false;
    if (this->improve(t, options))
    {
      ++accepted;
    }
    else
    {
      ++failures;
      // With another number of tetrahedra, formerly prevented operations may be allowed.
      this->Tried[t] = { this->Operations.clock() + 1, this->PassNumber,
        this->Operations.countLimited ? std::int16_t(0) : effort };
    }
  }
  this->Exhausted = options.maxFailures > 0 && failures >= options.maxFailures;
  return accepted;
}
}
