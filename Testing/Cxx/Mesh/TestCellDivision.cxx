// SPDX-License-Identifier: BSD-3-Clause
// Cells that ranks send each other: each goes to one rank, with its points, and so do ghosts;
// values go to the parts and back to the pieces.
#include "MovingRanks.h"
#include "Registry.h"

#include "tautline/Mesh/CellDivision.h"

#include <limits>
#include <numeric>
#include <set>

using namespace tautline;

namespace
{
/// Values of all ranks, one after the other.
std::vector<Index> together(RankGroup& group, const std::vector<Index>& own)
{
  std::vector<Index> all;
  for (const std::vector<Index>& list : group.gatherItems(own))
  {
    all.insert(all.end(), list.begin(), list.end());
  }
  return all;
}

/// The parts have the cells of the pieces, at the same places.
void checkCells(const MeshData& whole, const RankPart& part, const CellDivision& division)
{
  const MeshView& view = division.view();
  const std::vector<Index> cells = division.cellsToParts(part.cellOf, 1);
  const std::vector<unsigned char> ghosts = division.cellsToParts(part.ghosts, 1);
  TAUTLINE_CHECK_EQUAL(static_cast<Index>(cells.size()), view.numberOfCells);
  std::vector<Index> own;
  std::set<Index> here;
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    const Index* node = whole.connectivity.data() + whole.offsets[cells[cell]];
    TAUTLINE_CHECK_EQUAL(view.offsets[cell + 1] - view.offsets[cell],
      whole.offsets[cells[cell] + 1] - whole.offsets[cells[cell]]);
    for (Index n = view.offsets[cell]; n < view.offsets[cell + 1]; ++n)
    {
      TAUTLINE_CHECK_EQUAL(division.ids()[view.connectivity[n]], *node);
      TAUTLINE_CHECK(pointOf(view, view.connectivity[n]) == whole.point(*node++));
    }
    if (!ghosts[cell])
    {
      own.push_back(cells[cell]);
      here.insert(cells[cell]);
    }
  }
  for (std::size_t i = 0; i < cells.size(); ++i)
  {
    TAUTLINE_CHECK(here.count(cells[i]) > 0); // a ghost is with the cell that it is a copy of
  }
  std::vector<Index> all = together(division.group(), own), expected(whole.numberOfCells());
  std::sort(all.begin(), all.end());
  std::iota(expected.begin(), expected.end(), Index(0));
  TAUTLINE_CHECK(all == expected);
}

/// The lowest rank that has a point owns it, as a rule; all have about as many.
void checkBalance(const MeshData& whole, const CellDivision& division)
{
  RankGroup& group = division.group();
  std::vector<Index> pairs;
  for (const Index id : division.ids())
  {
    pairs.insert(pairs.end(), { id, group.rank() });
  }
  std::vector<Index> lowest(whole.numberOfPoints(), group.size()), counts(group.size(), 0);
  pairs = together(group, pairs);
  for (std::size_t i = 0; i < pairs.size(); i += 2)
  {
    lowest[pairs[i]] = std::min(lowest[pairs[i]], pairs[i + 1]);
  }
  for (const Index rank : lowest)
  {
    ++counts[rank];
  }
  constexpr double uneven = 1.25; // of few points: cells at a border go to the higher rank
  const double mean = static_cast<double>(whole.numberOfPoints()) / group.size();
  TAUTLINE_CHECK(
    static_cast<double>(*std::max_element(counts.begin(), counts.end())) < uneven * mean + 1);
}

void testDivision(CellType type, Cut cut, int ranks)
{
  const MeshData whole = jittered(type, 6, 0.2);
  const auto rankOf = cutBy(whole, cut, ranks);
  onRanks(ranks,
    [&](RankGroup& group)
    {
      RankPart part = partOf(whole, group.rank(), rankOf, cut == Cut::Slabs);
      // A point without a cell stays where it is, wherever that is.
      constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
      part.data.addPoint({ nowhere, 0, 0 });
      part.pointOf.push_back(whole.numberOfPoints() + group.rank());
      const MeshView view = part.data.view();
      const std::vector<int> owners = ownersByTree(group, view, part.ghosts.data());
      TAUTLINE_CHECK_EQUAL(owners.back(), -1);
      const CellDivision division(group, view, part.pointOf.data(), owners);
      TAUTLINE_CHECK_EQUAL(std::count_if(division.ids().begin(), division.ids().end(),
                             [&](Index id) { return id >= whole.numberOfPoints(); }),
        1);
      // The returned data equal the sent data; of several copies, the lowest rank's counts.
      TAUTLINE_CHECK(
        division.pointsToPieces(division.pointsToParts(part.pointOf, 1), 1) == part.pointOf);
      TAUTLINE_CHECK(division.pointsToParts(part.pointOf, 1) == division.ids());
      TAUTLINE_CHECK(
        division.cellsToPieces(division.cellsToParts(part.cellOf, 1), 1) == part.cellOf);
      const std::vector<double> ranksOf =
        division.pointsToParts(std::vector<double>(part.pointOf.size(), group.rank()), 1);
      std::vector<double> twice;
      for (std::size_t p = 0; p < part.pointOf.size(); ++p)
      {
        twice.insert(twice.end(), { 1.0 * part.pointOf[p], -2.0 * part.pointOf[p] });
      }
      TAUTLINE_CHECK(division.pointsToPieces(division.pointsToParts(twice, 2), 2) == twice);
      const std::vector<double> least = division.pointsToPieces(ranksOf, 1);
      for (const double rank : least)
      {
        TAUTLINE_CHECK(rank <= group.rank());
      }
      checkCells(whole, part, division);
    });
  onRanks(ranks,
    [&](RankGroup& group)
    {
      const RankPart part = partOf(whole, group.rank(), rankOf);
      const CellDivision division(group, part.data.view(), part.pointOf.data(),
        ownersByTree(group, part.data.view(), nullptr));
      checkBalance(whole, division);
    });
}

/// Points without an owner leave their cells where they are; otherwise the highest owner counts.
void testOwners()
{
  const MeshData whole = blockMesh(CellType::Triangle, 1, 1, 0);
  onRanks(3,
    [&](RankGroup& group)
    {
      const RankPart part = partOf(whole, group.rank(), [](Index) { return 1; });
      std::vector<int> owners(part.pointOf.size(), -1);
      {
        const CellDivision stays(group, part.data.view(), part.pointOf.data(), owners);
        TAUTLINE_CHECK_EQUAL(stays.view().numberOfCells, group.rank() == 1 ? 2 : 0);
      }
      for (std::size_t p = 0; p < owners.size(); ++p)
      {
        owners[p] = part.pointOf[p] == 1 ? 2 : 0; // a point of the first triangle only
      }
      const CellDivision division(group, part.data.view(), part.pointOf.data(), owners);
      TAUTLINE_CHECK_EQUAL(division.view().numberOfCells, group.rank() == 1 ? 0 : 1);
      TAUTLINE_CHECK_EQUAL(division.view().numberOfPoints, group.rank() == 1 ? 0 : 3);
      TAUTLINE_CHECK_EQUAL(
        division.cellsToPieces(std::vector<double>(division.view().numberOfCells, group.rank()), 1)
          .size(),
        part.cellOf.size());
    });
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestCellDivision)
{
  for (const CellType type : { CellType::Triangle, CellType::Tetrahedron, CellType::Hexahedron })
  {
    const Context context(topology(type).plural);
    forEachCut({ 1, 2, 3, 4 }, [type](Cut cut, int ranks) { testDivision(type, cut, ranks); });
  }
  TAUTLINE_RUN(testOwners());
}
