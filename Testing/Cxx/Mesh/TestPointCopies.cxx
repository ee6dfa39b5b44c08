// SPDX-License-Identifier: BSD-3-Clause
// Copies of a point whose places differ by rounding get one place by their global ids, on any
// number of ranks; ids that do not belong to one mesh join nothing.
#include "Registry.h"
#include "ThreadRanks.h"
#include "tautline/Mesh/DistributedMesh.h"
#include "tautline/Mesh/PointCopies.h"

using namespace tautline;

namespace
{
constexpr Index cubes = 4; // along each edge
constexpr double rounding = 1e-12, far = 0.05;

/// Shifts the points of a part by up to `amplitude` in each direction, as no other rank does.
void shift(RankPart& part, int rank, double amplitude)
{
  Random random(11 + rank);
  part.data.transform([&](const Vec3& p) { return p + random.vector(-amplitude, amplitude); });
}

/// The results of a rank in its part, and the mesh of all parts with the places it has then.
void checkPart(RankGroup& group, const MeshData& whole, const RankPart& part, bool joins)
{
  const JoinedCopies copies = joinCopies(group, part.data.view(), part.pointOf.data());
  MeshView view = part.data.view();
  const bool shared = group.size() > 1;
  TAUTLINE_CHECK_EQUAL(copies.joined > 0, joins && shared);
  TAUTLINE_CHECK_EQUAL(copies.farthest > 0, joins && shared);
  TAUTLINE_CHECK(copies.farthest <= 2 * std::sqrt(3.0) * rounding);
  TAUTLINE_CHECK(joins || copies.points.empty());
  const DistributedMesh apart(group, { view, nullptr, part.ghosts.data() });
  TAUTLINE_CHECK_EQUAL(apart.globalPoints() > whole.numberOfPoints(), shared);
  if (!copies.points.empty())
  {
    view.points = copies.points.data();
  }
  const DistributedMesh mesh(group, { view, nullptr, part.ghosts.data() });
  TAUTLINE_CHECK_EQUAL(mesh.globalPoints(), joins ? whole.numberOfPoints() : apart.globalPoints());
  for (Index p = 0; p < view.numberOfPoints && joins; ++p)
  {
    const Vec3 way = pointOf(view, p) - whole.point(part.pointOf[p]);
    TAUTLINE_CHECK(norm(way) <= std::sqrt(3.0) * rounding);
  }
}

void testParts(CellType type)
{
  const MeshData whole = jittered(type, cubes, 0.2);
  for (const Cut cut : { Cut::Slabs, Cut::Random })
  {
    for (const int ranks : { 1, 2, 3, 5 })
    {
      for (const double amplitude : { rounding, far })
      {
        const Context context("cut " + std::to_string(static_cast<int>(cut)) + ", " +
          std::to_string(ranks) + " ranks, shifted by " + std::to_string(amplitude));
        const auto rankOf = cutBy(whole, cut, ranks);
        onRanks(ranks,
          [&](RankGroup& group)
          {
            RankPart part = partOf(whole, group.rank(), rankOf, cut == Cut::Slabs);
            shift(part, group.rank(), amplitude);
            checkPart(group, whole, part, amplitude == rounding);
          });
      }
    }
  }
}

/// Pieces that number their points each from 0 are joined by equal coordinates alone; and points
/// that have no ids on one rank.
TAUTLINE_PART(testOtherIds)
{
  const MeshData whole = jittered(CellType::Tetrahedron, cubes, 0.2);
  const auto rankOf = cutBy(whole, Cut::Random, 3);
  onRanks(3,
    [&](RankGroup& group)
    {
      RankPart part = partOf(whole, group.rank(), rankOf);
      std::vector<Index> own(part.pointOf.size());
      std::iota(own.begin(), own.end(), 0);
      const JoinedCopies none = joinCopies(group, part.data.view(), own.data());
      TAUTLINE_CHECK_EQUAL(none.joined, 0);
      TAUTLINE_CHECK_EQUAL(none.apart, 0);
      TAUTLINE_CHECK(none.points.empty());
      shift(part, group.rank(), rounding);
      const Index* ids = group.rank() == 1 ? nullptr : part.pointOf.data();
      TAUTLINE_CHECK_EQUAL(joinCopies(group, part.data.view(), ids).joined, 0);
    });
}

/// Copies that are farther apart, of a few points: they stay, and are counted.
TAUTLINE_PART(testApart)
{
  const MeshData whole = jittered(CellType::Tetrahedron, cubes, 0.2);
  for (const int ranks : { 2, 3, 5 })
  {
    const Context context(std::to_string(ranks) + " ranks");
    const auto rankOf = cutBy(whole, Cut::Slabs, ranks);
    onRanks(ranks,
      [&](RankGroup& group)
      {
        RankPart part = partOf(whole, group.rank(), rankOf);
        const RankPart first = partOf(whole, 0, rankOf);
        Index moved = 0;
        for (std::size_t p = 0; p < part.pointOf.size() && group.rank() == 1; ++p)
        {
          const bool shared =
            std::count(first.pointOf.begin(), first.pointOf.end(), part.pointOf[p]) > 0;
          if (shared && moved < 3)
          {
            part.data.points[3 * p + 1] += far;
            ++moved;
          }
        }
        const JoinedCopies found = joinCopies(group, part.data.view(), part.pointOf.data());
        TAUTLINE_CHECK_EQUAL(found.joined, 0);
        TAUTLINE_CHECK_EQUAL(found.apart, group.sum(moved));
        TAUTLINE_CHECK_EQUAL(found.apart, 3);
      });
  }
}

/// Pieces that are one data set: the copies are on one rank.
TAUTLINE_PART(testOneRank)
{
  const MeshData whole = jittered(CellType::Tetrahedron, cubes, 0.2);
  const auto rankOf = cutBy(whole, Cut::Slabs, 2);
  MeshData both;
  std::vector<Index> ids;
  for (int piece = 0; piece < 2; ++piece)
  {
    RankPart part = partOf(whole, piece, rankOf);
    shift(part, piece, rounding);
    const Index first = both.numberOfPoints();
    for (Index p = 0; p < part.data.numberOfPoints(); ++p)
    {
      both.addPoint(part.data.point(p));
      ids.push_back(part.pointOf[p]);
    }
    for (Index cell = 0; cell < part.data.numberOfCells(); ++cell)
    {
      std::vector<Index> nodes;
      for (Index n = part.data.offsets[cell]; n < part.data.offsets[cell + 1]; ++n)
      {
        nodes.push_back(first + part.data.connectivity[n]);
      }
      both.addCell(CellType::Tetrahedron, nodes);
    }
  }
  SingleRank alone;
  const JoinedCopies copies = joinCopies(alone, both.view(), ids.data());
  const Index seam = both.numberOfPoints() - whole.numberOfPoints();
  TAUTLINE_CHECK(seam > cubes * cubes);
  TAUTLINE_CHECK_EQUAL(copies.joined, seam);
  if (!TAUTLINE_CHECK(!copies.points.empty()))
  {
    return;
  }
  MeshView view = TAUTLINE_CHANGED(both.view(), points = copies.points.data());
  const DistributedMesh mesh(alone, { view, nullptr, nullptr });
  TAUTLINE_CHECK_EQUAL(mesh.globalPoints(), whole.numberOfPoints());
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestPointCopies)
{
  TAUTLINE_RUN(testParts(CellType::Tetrahedron));
  TAUTLINE_RUN(testParts(CellType::Hexahedron));
  TAUTLINE_RUN(testParts(CellType::Triangle));
}
