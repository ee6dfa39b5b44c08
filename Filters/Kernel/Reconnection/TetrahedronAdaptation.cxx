// SPDX-License-Identifier: BSD-3-Clause
#include "TetrahedronAdaptation.h"

#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <tuple>

namespace tautline
{
namespace
{
/// Edges are split above this length in the metric, and contracted below its inverse.
constexpr double LongestEdge = 1.4142135623730951;
/// The maximum number of rounds. A factor of 2 in size needs about one.
constexpr int MostRounds = 24;
/// Rounds end when less than this fraction of the edges changes, or when, within this number of
/// rounds, neither the fraction of edges in range has grown by this much nor the deviation of the
/// lengths has decreased by this fraction.
constexpr double LeastChange = 2e-3, LeastGain = 3e-3, LeastFall = 0.03;
constexpr int VainRounds = 2;
/// In each round, tetrahedra below this quality are swapped, and points move this many times.
constexpr double SwapTarget = 0.75;
constexpr int SweepsOfRound = 2;
/// At the end: the number of rounds of swaps and motions, and the quality up to which the worst are
/// improved.
constexpr int LastRounds = 3, LastSweeps = 4;
constexpr double LastTarget = 0.85;
constexpr double LastGain = 1e-3;
/// The number of operations between two calls of `proceed`.
constexpr Index PollInterval = 256;
}

EdgeShare shareOfEdges(const TetrahedronMesh& mesh)
{
  std::vector<std::uint64_t> keys;
  for (TetId t = 0; t < mesh.slots(); ++t)
  {
    if (!mesh.alive(t) || mesh.region(t) == OutsideRegion)
    {
      continue;
    }
    const TetVertices& v = mesh.tet(t).vertices;
    for (int i = 0; i < 4; ++i)
    {
      for (int j = i + 1; j < 4; ++j)
      {
        const auto a = static_cast<std::uint64_t>(std::min(v[i], v[j]));
        keys.push_back(a << 32 | static_cast<std::uint64_t>(std::max(v[i], v[j])));
      }
    }
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  EdgeShare result;
  for (std::uint64_t key : keys)
  {
    const auto a = static_cast<PointId>(key >> 32), b = static_cast<PointId>(key & 0xffffffffu);
    const double length = edgeLength(mesh.point(b) - mesh.point(a), mesh.metric(a), mesh.metric(b));
    ++result.edges;
    result.inRange += length >= 1.0 / LongestEdge && length <= LongestEdge;
    // With the logarithm, edges twice too long and twice too short count equally.
    result.deviation += std::abs(std::log(length));
  }
  result.deviation /= static_cast<double>(std::max<Index>(result.edges, 1));
  return result;
}

//------------------------------------------------------------------------------
bool TetrahedronAdaptation::isPoll()
{
  return ++this->Polls % PollInterval == 0;
}

//------------------------------------------------------------------------------
/// The edges that are too long, the longest first, or too short, the shortest first.
std::vector<TetrahedronAdaptation::SizedEdge> TetrahedronAdaptation::edges(bool tooLong) const
{
  std::vector<SizedEdge> found;
  for (TetId t = 0; t < this->Mesh.slots(); ++t)
  {
    pollInterruption(t);
    if (!this->Mesh.alive(t) || this->Mesh.region(t) == OutsideRegion)
    {
      continue;
    }
    const TetVertices& v = this->Mesh.tet(t).vertices;
    for (int i = 0; i < 4; ++i)
    {
      for (int j = i + 1; j < 4; ++j)
      {
        const PointId a = std::min(v[i], v[j]), b = std::max(v[i], v[j]);
        const double length = edgeLength(
          this->Mesh.point(b) - this->Mesh.point(a), this->Mesh.metric(a), this->Mesh.metric(b));
        if (tooLong ? length > LongestEdge : length < 1.0 / LongestEdge)
        {
          // Edges are sorted by this value: the negative length puts the longest first.
          found.push_back({ tooLong ? -length : length, a, b });
        }
      }
    }
  }
  std::sort(found.begin(), found.end(),
    [](const SizedEdge& x, const SizedEdge& y)
    { return std::tie(x.length, x.a, x.b) < std::tie(y.length, y.a, y.b); });
  found.erase(std::unique(found.begin(), found.end(),
                [](const SizedEdge& x, const SizedEdge& y) { return x.a == y.a && x.b == y.b; }),
    found.end());
  return found;
}

//------------------------------------------------------------------------------
/// Splits the long edges, or contracts the short ones. @return false if stopped
bool TetrahedronAdaptation::changeEdges(bool tooLong, Index& changed)
{
  std::vector<TetId> star;
  for (const SizedEdge& edge : this->edges(tooLong))
  {
    if (this->isPoll() && this->proceed && !this->proceed())
    {
      return false;
    }
    if (!this->Mesh.used(edge.a) || !this->Mesh.used(edge.b))
    {
      continue;
    }
    // Points may have moved in the meantime, or the edge may have changed.
    const double length = edgeLength(this->Mesh.point(edge.b) - this->Mesh.point(edge.a),
      this->Mesh.metric(edge.a), this->Mesh.metric(edge.b));
    if (tooLong ? length <= LongestEdge : length >= 1.0 / LongestEdge)
    {
      continue;
    }
    this->Mesh.star(edge.a, star);
    const auto at = std::find_if(
      star.begin(), star.end(), [&](TetId t) { return this->Mesh.tet(t).indexOf(edge.b) != NoId; });
    if (at == star.end())
    {
      continue;
    }
    const int i = this->Mesh.tet(*at).indexOf(edge.a), j = this->Mesh.tet(*at).indexOf(edge.b);
    changed +=
      tooLong ? this->Operations.splitEdge(*at, i, j) : this->Operations.contractEdge(*at, i, j);
  }
  return true;
}

//------------------------------------------------------------------------------
bool TetrahedronAdaptation::swap(double target)
{
  if (!this->swaps)
  {
    return true;
  }
  PassOptions pass;
  pass.target = target;
  pass.smooth = false;
  pass.skipsBound = false;
  return this->Passes.run(pass) >= 0;
}

//------------------------------------------------------------------------------
bool TetrahedronAdaptation::relax(int sweeps)
{
  for (int sweep = 0; sweep < sweeps && this->moves; ++sweep)
  {
    Index moved = 0;
    for (PointId v = 0; v < this->Mesh.pointSlots(); ++v)
    {
      if (this->isPoll() && this->proceed && !this->proceed())
      {
        return false;
      }
      moved += this->Mesh.used(v) && this->Operations.relax(v);
    }
    if (moved == 0)
    {
      break;
    }
  }
  return true;
}

//------------------------------------------------------------------------------
/// @param busy set to whether many edges changed
bool TetrahedronAdaptation::round(bool& busy)
{
  Index changed = 0;
  if ((this->contracts && !this->changeEdges(false, changed)) ||
    (this->splits && !this->changeEdges(true, changed)) || !this->swap(SwapTarget) ||
    !this->relax(SweepsOfRound))
  {
    return false;
  }
  busy = static_cast<double>(changed) > LeastChange * static_cast<double>(this->Mesh.size());
  return true;
}

//------------------------------------------------------------------------------
/// Improves the worst first, starting with all points at the best positions for lengths.
bool TetrahedronAdaptation::finish()
{
  for (int k = 0; k < LastRounds; ++k)
  {
    Index changed = 0;
    if ((this->contracts && !this->changeEdges(false, changed)) || !this->swap(LastTarget) ||
      !this->relax(LastSweeps))
    {
      return false;
    }
  }
  PassOptions pass;
  pass.target = LastTarget;
  pass.swap = this->swaps;
  pass.smooth = this->moves;
  pass.skipsBound = false;
  pass.leastGain = LastGain;
  return this->Passes.run(pass) >= 0;
}

//------------------------------------------------------------------------------
bool TetrahedronAdaptation::run()
{
  this->Operations.prepareStamps();
  bool busy = true;
  EdgeShare best = shareOfEdges(this->Mesh);
  for (int k = 0, vain = 0; k < MostRounds && busy && vain < VainRounds; ++k)
  {
    const bool complete = this->round(busy);
    const EdgeShare now = shareOfEdges(this->Mesh);
    // The final sweeps count as two rounds of the progress.
    if (!this->record(static_cast<double>(k + 1) / (MostRounds + 2), now.share()) || !complete)
    {
      return false;
    }
    const bool better =
      now.share() > best.share() + LeastGain || now.deviation < (1.0 - LeastFall) * best.deviation;
    vain = better ? 0 : vain + 1;
    best = better ? now : best;
  }
  const bool complete = this->finish();
  return this->record(1.0, shareOfEdges(this->Mesh).share()) && complete;
}
}
