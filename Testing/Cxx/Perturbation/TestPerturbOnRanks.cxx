// SPDX-License-Identifier: BSD-3-Clause
// Perturbation on ranks: bitwise the points of one process, however the mesh is cut.
#include "Registry.h"
#include "MovingOnRanks.h"
#include "tautline/Mesh/CoordinateOrder.h"
#include "tautline/Perturbation/PerturbOnRanks.h"

#include <numeric>

using namespace tautline;

namespace
{
using Run = Moved<Perturbation>;

MeshData distorted(CellType type, Index n)
{
  const bool flat = topology(type).dimension == 2;
  MeshData data = blockMesh(type, n, n, flat ? 0 : n);
  const auto side = static_cast<double>(n);
  data.transform(
    [side](const Vec3& p)
    {
      const double wave = 0.2 * std::sin(Pi * p[0] / side) * std::sin(Pi * p[1] / side);
      return p + Vec3{ wave, 0.5 * wave, 0 };
    });
  return data;
}

Run runOn(const MeshData& whole, Cut cut, int ranks, const PerturbOptions& given,
  const std::vector<Index>& idOf)
{
  return moveOnRanks<Perturbation>(whole, cut, ranks,
    [&](DistributedMesh& mesh, Perturbation& result)
    {
      // Ids by way of the owners, which may have a point from another piece.
      std::vector<Index> ids = coordinateOrder(mesh);
      if (!idOf.empty())
      {
        for (Index& id : ids)
        {
          id = idOf[id];
        }
      }
      std::vector<unsigned char> fixed(mesh.localPoints(), 0);
      for (Index p = 0; p < mesh.localPoints(); ++p)
      {
        fixed[p] = ids[p] % 7 == 0;
      }
      PerturbOptions options = given;
      options.ids = ids.data();
      options.threads = 1 + mesh.group().rank() % 2;
      result = perturbOnRanks(mesh, false, fixed.data(), options);
    });
}

/// The points of a mesh by x, then y, then z.
std::vector<Index> placesOf(const MeshData& data)
{
  std::vector<Index> order(data.numberOfPoints()), places(order.size());
  std::iota(order.begin(), order.end(), Index(0));
  std::sort(order.begin(), order.end(),
    [&data](Index a, Index b) { return data.point(a) < data.point(b); });
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    places[order[i]] = static_cast<Index>(i);
  }
  return places;
}

void testCuts(const char* name, const MeshData& whole, const PerturbOptions& given, bool shuffled,
  const std::vector<int>& numbers = { 1, 2, 3, 4 })
{
  const Context context(name);
  const std::vector<Index> places = placesOf(whole);
  // Other ids than the places: a permutation.
  std::vector<Index> idOf, ids = places;
  if (shuffled)
  {
    constexpr Index factor = 7919; // a prime that divides no number of points here
    for (Index i = 0; i < whole.numberOfPoints(); ++i)
    {
      idOf.push_back(i * factor % whole.numberOfPoints());
    }
    std::transform(
      places.begin(), places.end(), ids.begin(), [&idOf](Index place) { return idOf[place]; });
  }
  std::vector<unsigned char> fixed(ids.size());
  std::transform(ids.begin(), ids.end(), fixed.begin(), [](Index id) { return id % 7 == 0; });
  PerturbOptions options = given;
  options.ids = ids.data();
  const Perturbation one = perturb(Mesh(whole.view()), fixed.data(), options);
  TAUTLINE_CHECK(one.moved > 0 && one.moved < one.movable + 1);
  TAUTLINE_CHECK(one.points != whole.points);
  forEachCut(numbers,
    [&](Cut cut, int ranks)
    {
      const auto moved = runOn(whole, cut, ranks, given, idOf);
      TAUTLINE_CHECK(moved.points == one.points); // bitwise
      for (const Perturbation& report : moved.results)
      {
        TAUTLINE_CHECK_EQUAL(report.movable, one.movable);
        TAUTLINE_CHECK_EQUAL(report.moved, one.moved);
        TAUTLINE_CHECK_EQUAL(report.elements, one.elements);
        TAUTLINE_CHECK_EQUAL(report.invertedBefore, one.invertedBefore);
        TAUTLINE_CHECK_EQUAL(report.invertedAfter, one.invertedAfter);
        TAUTLINE_CHECK_EQUAL(report.largestDisplacement, one.largestDisplacement);
      }
    });
}

void testOrder()
{
  const Context context("order of coordinates");
  const MeshData whole = distorted(CellType::Tetrahedron, 5);
  const std::vector<Index> places = placesOf(whole);
  for (const Cut cut : { Cut::Slabs, Cut::Random, Cut::FirstOnly })
  {
    const auto rankOf = cutBy(whole, cut, 3);
    onRanks(3,
      [&](RankGroup& group)
      {
        const RankPart part = partOf(whole, group.rank(), rankOf);
        const DistributedMesh mesh(group, { part.data.view(), nullptr, nullptr });
        const std::vector<Index> order = coordinateOrder(mesh);
        for (std::size_t p = 0; p < part.pointOf.size(); ++p)
        {
          TAUTLINE_CHECK_EQUAL(order[mesh.localOfPiece()[p]], places[part.pointOf[p]]);
        }
      });
  }
}

void testRefusals()
{
  const Context context("refusals");
  const MeshData whole = distorted(CellType::Triangle, 4);
  const auto message = [&](const PerturbOptions& given) -> std::string
  {
    try
    {
      runOn(whole, Cut::Slabs, 2, given, {});
    }
    catch (const Error& error)
    {
      return error.what();
    }
    return "";
  };
  PerturbOptions tangled, wrong, stopped;
  tangled.tangledFraction = 0.1;
  TAUTLINE_CHECK(message(tangled).find(wording("tangled-fraction")) != std::string::npos);
  wrong.percentage = 101;
  TAUTLINE_CHECK(message(wrong).find(wording("between-0-and-100")) != std::string::npos);
  // An interruption on one rank is one on all.
  stopped.progress = [](double) { return false; };
  const Run run = runOn(whole, Cut::Slabs, 2, stopped, {});
  TAUTLINE_CHECK(run.result.stopped);
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestPerturbOnRanks)
{
  PerturbOptions half, most, single;
  most.percentage = 100;
  most.fraction = 0.9;
  most.seed = 5;
  single.percentage = 70;
  single.singlePrecision = true;
  TAUTLINE_RUN(testOrder());
  TAUTLINE_RUN(testCuts("tetrahedra", distorted(CellType::Tetrahedron, 6), half, false));
  TAUTLINE_RUN(testCuts("all tetrahedra", distorted(CellType::Tetrahedron, 5), most, true));
  TAUTLINE_RUN(testCuts("hexahedra", distorted(CellType::Hexahedron, 5), single, true));
  TAUTLINE_RUN(testCuts("triangles", distorted(CellType::Triangle, 12), most, false));
  // Ranks with a cell, all of whose points others own.
  TAUTLINE_RUN(testCuts("few triangles", distorted(CellType::Triangle, 2), most, false, { 4, 8 }));
  TAUTLINE_RUN(testRefusals());
}
