// SPDX-License-Identifier: BSD-3-Clause
// The counts for parts of a mesh match the data that ranks with these parts have and send.
#include "Registry.h"
#include "ThreadRanks.h"
#include "tautline/Mesh/DecompositionCounts.h"
#include "tautline/Mesh/DistributedMesh.h"

using namespace tautline;

namespace
{
std::vector<unsigned char> inside(const MeshData& whole)
{
  const Mesh mesh(whole.view());
  auto free = collect<unsigned char>(
    mesh.boundary().isBoundaryPoint, [&](const char onBoundary) { return !onBoundary; });
  return free;
}

std::vector<int> partsOf(const MeshData& whole, Cut cut, int ranks)
{
  const auto rankOf = cutBy(whole, cut, ranks);
  return collect<int>(whole.numberOfCells(), [&](Index cell) { return rankOf(cell); });
}

/// The counts of the ranks themselves: as in LocalSweeper, an exchange of each set.
DecompositionCounts measured(
  const MeshData& whole, const std::vector<int>& parts, int ranks, std::vector<unsigned char> free)
{
  DecompositionCounts found;
  found.parts.resize(ranks);
  std::mutex mutex;
  std::vector<Index> slowest;
  onRanks(ranks,
    [&](ThreadRank& group)
    {
      const RankPart part = partOf(whole, group.rank(), [&](Index cell) { return parts[cell]; });
      const DistributedMesh mesh(group, { part.data.view(), part.pointOf.data(), nullptr });
      std::vector<unsigned char> wanted(mesh.localPoints(), 0);
      for (std::size_t p = 0; p < part.pointOf.size(); ++p)
      {
        wanted[mesh.localOfPiece()[p]] = free[part.pointOf[p]];
      }
      mesh.either(wanted.data());
      const std::vector<int> sets = mesh.independentSets(wanted);
      Index highest = largestOf<Index>(-1, sets, [&](const int set) { return set; });
      highest = group.maximum(highest);
      TAUTLINE_LET(PartCounts, own, cells = part.data.numberOfCells(),
        haloPoints = mesh.haloPoints(), neighbours = mesh.neighbours());
      std::vector<double> values(mesh.localPoints(), 0.0);
      for (Index set = 0; set <= highest; ++set)
      {
        std::vector<unsigned char> flags(mesh.localPoints());
        Index mine = 0;
        for (Index p = 0; p < mesh.localPoints(); ++p)
        {
          flags[p] = sets[p] == set;
          mine += flags[p] && mesh.owned(p);
        }
        const DistributedMesh::Subset subset = mesh.subset(flags);
        const Index before = group.messages;
        mesh.exchange(subset, values.data(), 1);
        own.messages += group.messages - before;
        for (const auto& neighbour : subset.neighbours)
        {
          own.sentPoints += static_cast<Index>(neighbour.sent.size());
        }
        own.freePoints += mine;
        const Index most = group.maximum(mine);
        const std::lock_guard<std::mutex> lock(mutex);
        slowest.resize(highest + 1, 0);
        slowest[set] = most;
      }
      for (Index p = 0; p < mesh.localPoints(); ++p)
      {
        own.points += mesh.owned(p);
      }
      const std::lock_guard<std::mutex> lock(mutex);
      TAUTLINE_SET(found, parts[group.rank()] = own, sets = highest + 1);
    });
  for (const Index points : slowest)
  {
    found.slowestPoints += points;
  }
  return found;
}

void testCounts(CellType type, Cut cut, int ranks)
{
  const Context context("cut " + std::to_string(static_cast<int>(cut)) + ", " +
    std::to_string(ranks) + " parts of " + topology(type).plural);
  const MeshData whole = movedBlock(type, 6, 0.1);
  const std::vector<unsigned char> free = inside(whole);
  const std::vector<int> parts = partsOf(whole, cut, ranks);
  const DecompositionCounts expected = measured(whole, parts, ranks, free);
  const DecompositionCounts found = countDecomposition(whole.view(), parts, ranks, free);
  TAUTLINE_CHECK_EQUAL(found.sets, expected.sets);
  TAUTLINE_CHECK_EQUAL(found.slowestPoints, expected.slowestPoints);
  TAUTLINE_CHECK_EQUAL(found.points, whole.numberOfPoints());
  Index freePoints = 0, cells = 0, points = 0;
  for (int rank = 0; rank < ranks; ++rank)
  {
    const PartCounts &a = found.parts[rank], &b = expected.parts[rank];
    TAUTLINE_CHECK_EQUAL(a.cells, b.cells);
    TAUTLINE_CHECK_EQUAL(a.points, b.points);
    TAUTLINE_CHECK_EQUAL(a.freePoints, b.freePoints);
    TAUTLINE_CHECK_EQUAL(a.haloPoints, b.haloPoints);
    TAUTLINE_CHECK_EQUAL(a.neighbours, b.neighbours);
    TAUTLINE_CHECK_EQUAL(a.messages, b.messages);
    TAUTLINE_CHECK_EQUAL(a.sentPoints, b.sentPoints);
    cells += a.cells;
    points += a.points;
    freePoints += a.freePoints;
    TAUTLINE_CHECK(cut == Cut::FirstOnly || (a.messages > 0 && a.sentPoints >= a.messages));
  }
  TAUTLINE_CHECK_EQUAL(cells, whole.numberOfCells());
  TAUTLINE_CHECK_EQUAL(points, whole.numberOfPoints());
  TAUTLINE_CHECK_EQUAL(freePoints, found.freePoints);
  TAUTLINE_CHECK_EQUAL(freePoints, static_cast<Index>(std::count(free.begin(), free.end(), 1)));
  TAUTLINE_CHECK(found.slowestPoints * ranks >= freePoints && found.slowestPoints <= freePoints);
}

TAUTLINE_PART(testErrors)
{
  const MeshData whole = blockMesh(CellType::Triangle, 2, 2, 0);
  const std::vector<unsigned char> free(whole.numberOfPoints(), 1);
  const auto rejected = [&](std::vector<int> partOfCell, int parts, const char* text)
  {
    try
    {
      countDecomposition(whole.view(), partOfCell, parts, free);
      TAUTLINE_CHECK(!"rejected");
    }
    catch (const Error& error)
    {
      TAUTLINE_CHECK(contains(error.what(), text));
    }
  };
  std::vector<int> parts(whole.numberOfCells(), 0);
  rejected(parts, 0, wording("at-least-1"));
  rejected({ 0 }, 1, wording("1-numbers-of-parts-for"));
  parts[3] = 2;
  rejected(parts, 2, wording("cell-3-is-in-part-2"));
  parts[3] = -1;
  rejected(parts, 2, wording("cell-3-is-in-part-1"));
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestDecompositionCounts)
{
  for (const CellType type : { CellType::Triangle, CellType::Tetrahedron, CellType::Hexahedron })
  {
    TAUTLINE_RUN(testCounts(type, Cut::Slabs, 2));
    TAUTLINE_RUN(testCounts(type, Cut::Random, 3));
    TAUTLINE_RUN(testCounts(type, Cut::FirstOnly, 2));
  }
  TAUTLINE_RUN(testCounts(CellType::Tetrahedron, Cut::Random, 7));
}
