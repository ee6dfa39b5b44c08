// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MovingRanks.h
 * @brief What moves the points of a mesh on ranks that are threads, for tests.
 */
#ifndef tautline_MovingRanks_h
#define tautline_MovingRanks_h

#include "Check.h"
#include "ThreadRanks.h"
#include "tautline/Mesh/DistributedMesh.h"

namespace tautline
{
/** Points of the whole mesh, and what a rank has found besides. */
template <class Result>
struct Moved
{
  std::vector<double> points;
  Result result;               ///< of the first rank
  std::vector<Result> results; ///< of all ranks
};

/** Calls work(mesh, result) on each rank with its part of a mesh, with ghost cells if cut in slabs,
    and puts the points of the results, of local points, back to the whole mesh. */
template <class Result, class Work>
Moved<Result> moveOnRanks(const MeshData& whole, Cut cut, int ranks, const Work& work)
{
  const auto rankOf = cutBy(whole, cut, ranks);
  Moved<Result> moved;
  moved.points = whole.points;
  moved.results.resize(ranks);
  std::mutex mutex;
  onRanks(ranks,
    [&](RankGroup& group)
    {
      const RankPart part = partOf(whole, group.rank(), rankOf, cut == Cut::Slabs);
      DistributedMesh mesh(group, { part.data.view(), nullptr, part.ghosts.data() });
      Result result;
      work(mesh, result);
      const std::lock_guard<std::mutex> lock(mutex);
      for (std::size_t p = 0; p < part.pointOf.size(); ++p)
      {
        std::copy_n(
          &result.points[3 * mesh.localOfPiece()[p]], 3, &moved.points[3 * part.pointOf[p]]);
      }
      moved.results[group.rank()] = result;
    });
  moved.result = moved.results.front();
  return moved;
}

/** Calls test(cut, ranks) with all cuts. */
template <class Test>
void forEachCut(const std::vector<int>& numbers, const Test& test)
{
  for (const Cut cut : { Cut::Slabs, Cut::Random, Cut::FirstOnly })
  {
    for (const int ranks : numbers)
    {
      const Context context(
        "cut " + std::to_string(static_cast<int>(cut)) + ", " + std::to_string(ranks) + " ranks");
      test(cut, ranks);
    }
  }
}
}
#endif
