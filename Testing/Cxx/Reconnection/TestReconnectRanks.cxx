// SPDX-License-Identifier: BSD-3-Clause
// Reconnection of tetrahedra that are spread over ranks.
#include "Reconnecting.h"
#include "Registry.h"
#include "ThreadRanks.h"
#include "tautline/Reconnection/ReconnectionRounds.h"

#include <atomic>

using namespace tautline;

namespace
{
/// The results of all ranks as one mesh; its points are in the order of their numbers.
struct Joined
{
  MeshData data;
  std::vector<Index> numbers;  ///< of its points
  std::vector<Index> original; ///< per cell: of the input
  RankReconnection first;      ///< what rank 0 has got
};

struct Given
{
  const MeshData& data;
  std::vector<Index> regions;
  std::vector<unsigned char> fixed;
  std::vector<std::array<Index, 3>> marked;
};

/// Runs on ranks, checks what they agree on, and that inserted points match their shares.
Joined reconnectOnRanks(
  const Given& given, int ranks, Cut cut, const ReconnectionOptions& options, int rounds = 12)
{
  const auto rankOf = cutBy(given.data, cut, ranks);
  std::vector<RankReconnection> results(ranks);
  std::vector<RankPart> parts(ranks);
  onRanks(ranks,
    [&](RankGroup& group)
    {
      const int rank = group.rank();
      RankPart& part = parts[rank];
      part = partOf(given.data, rank, rankOf);
      RankTetrahedra mesh;
      mesh.numbers = part.pointOf;
      mesh.points = part.data.points;
      mesh.tetrahedra = part.data.connectivity;
      for (const Index p : part.pointOf)
      {
        mesh.fixed.push_back(given.fixed.empty() ? 0 : given.fixed[p]);
      }
      for (const Index cell : part.cellOf)
      {
        if (!given.regions.empty())
        {
          mesh.regions.push_back(given.regions[cell]);
        }
      }
      for (std::size_t i = rank; i < given.marked.size(); i += ranks)
      {
        mesh.markedFacets.push_back(given.marked[i]);
      }
      results[rank] = improveConnectivity(group, mesh, options, rounds);
    });
  Joined joined;
  std::map<Index, Vec3> places;
  for (const RankReconnection& result : results)
  {
    for (std::size_t p = 0; p < result.numbers.size(); ++p)
    {
      const Vec3 x = { result.points[3 * p], result.points[3 * p + 1], result.points[3 * p + 2] };
      const auto known = places.emplace(result.numbers[p], x).first;
      TAUTLINE_CHECK(known->second == x); // the same on all ranks
      Vec3 sum = { 0, 0, 0 };
      double weights = 0.0;
      const Index begin = result.shareOffsets[p], end = result.shareOffsets[p + 1];
      for (Index k = begin; k < end; ++k)
      {
        TAUTLINE_CHECK(result.shares[k].number < given.data.numberOfPoints());
        sum += result.shares[k].weight * given.data.point(result.shares[k].number);
        weights += result.shares[k].weight;
      }
      TAUTLINE_CHECK((begin == end) == (result.numbers[p] < result.firstInserted));
      TAUTLINE_CHECK(begin == end || std::abs(weights - 1.0) < 1e-9);
    }
    TAUTLINE_CHECK_EQUAL(result.history.size(), results[0].history.size());
    TAUTLINE_CHECK_EQUAL(
      result.history.back().smallestAngle, results[0].history.back().smallestAngle);
    TAUTLINE_CHECK_EQUAL(static_cast<int>(result.reason), static_cast<int>(results[0].reason));
  }
  std::map<Index, Index> ids;
  for (const auto& [number, x] : places)
  {
    joined.numbers.push_back(number);
    ids[number] = joined.data.addPoint(x);
  }
  for (int r = 0; r < ranks; ++r)
  {
    const RankReconnection& result = results[r];
    for (std::size_t c = 0; c < result.originalCells.size(); ++c)
    {
      std::vector<Index> nodes;
      for (int k = 0; k < 4; ++k)
      {
        nodes.push_back(ids[result.numbers[result.tetrahedra[4 * c + k]]]);
      }
      joined.data.addCell(CellType::Tetrahedron, nodes);
      joined.original.push_back(parts[r].cellOf[result.originalCells[c]]);
    }
  }
  joined.first = results[0];
  return joined;
}

/// As a result of one rank, for checkResult().
ReconnectionResult asResult(const Joined& joined)
{
  ReconnectionResult result;
  result.points = joined.data.points;
  result.tetrahedra = joined.data.connectivity;
  result.originalPoints = joined.numbers;
  result.originalCells = joined.original;
  result.obstacles.assign(joined.original.size(), 0);
  result.history = joined.first.history;
  return result;
}

double worstOf(const Joined& joined)
{
  return joined.first.history.back().worstInverseMeanRatio;
}

/// The cells, by the coordinates of their corners.
std::set<std::array<Vec3, 4>> cellsOf(const MeshData& data)
{
  std::set<std::array<Vec3, 4>> cells;
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    std::array<Vec3, 4> key;
    for (int k = 0; k < 4; ++k)
    {
      key[k] = data.point(data.connectivity[4 * c + k]);
    }
    std::sort(key.begin(), key.end());
    cells.insert(key);
  }
  return cells;
}

/// Valid, conforming, the same boundary and volume, never worse; nearly as good as on one rank, as
/// the seams do not stay; and the same however the mesh was cut.
void testRounds()
{
  const MeshData data = sliverBlock(8, 5, 1.0);
  const ReconnectionOptions options;
  const ReconnectionRecord serial = reconnect(data, options).history.back();
  for (int ranks : { 1, 2, 3, 4 })
  {
    const Context context(std::to_string(ranks) + " ranks");
    std::set<std::array<Vec3, 4>> expected;
    for (Cut cut : { Cut::Slabs, Cut::Random, Cut::FirstOnly })
    {
      const Joined joined = reconnectOnRanks({ data, {}, {}, {} }, ranks, cut, options);
      checkResult(data, asResult(joined));
      TAUTLINE_CHECK(outerFacets(joined.data) == outerFacets(data));
      const ReconnectionRecord& last = joined.first.history.back();
      std::cout << ranks << " ranks, " << joined.first.history.size() - 1
                << " rounds: " << last.smallestAngle << " / " << last.worstInverseMeanRatio
                << ", one process: " << serial.smallestAngle << " / "
                << serial.worstInverseMeanRatio << "\n";
      TAUTLINE_CHECK(last.smallestAngle > serial.smallestAngle - 3.0);
      TAUTLINE_CHECK(last.worstInverseMeanRatio < 1.1 * serial.worstInverseMeanRatio);
      TAUTLINE_CHECK(static_cast<double>(last.tetrahedra) <=
        options.largestCount * static_cast<double>(data.numberOfCells()));
      const auto cells = cellsOf(joined.data);
      TAUTLINE_CHECK(expected.empty() || cells == expected);
      expected = cells;
    }
  }
}

/// With one round the seams are walls, which later rounds do away with.
void testSeams()
{
  const MeshData data = sliverBlock(8, 6, 1.0);
  const ReconnectionOptions options;
  const Given given = { data, {}, {}, {} };
  const double once = worstOf(reconnectOnRanks(given, 4, Cut::Slabs, options, 1));
  const double repeated = worstOf(reconnectOnRanks(given, 4, Cut::Slabs, options, 12));
  std::cout << "worst after one round " << once << ", after several " << repeated << "\n";
  TAUTLINE_CHECK(repeated < 0.9 * once);
}

/// Regions keep their volumes and facets, fixed points their places, marked facets stay.
void testKept()
{
  const MeshData data = sliverBlock(4, 6, 1.0), plain = blockMesh(CellType::Tetrahedron, 4, 4, 4);
  Given given = { data, {}, {}, {} };
  for (Index c = 0; c < data.numberOfCells(); ++c)
  {
    const Vec3 m = Mesh(plain.view()).center(c, CellType::Tetrahedron);
    given.regions.push_back(((m[0] < 2) + (m[1] < 2) + (m[2] < 2)) % 2);
  }
  for (Index p = 0; p < data.numberOfPoints(); ++p)
  {
    given.fixed.push_back(p % 7 == 0);
  }
  constexpr int faces[4][3] = { { 1, 2, 3 }, { 0, 2, 3 }, { 0, 1, 3 }, { 0, 1, 2 } };
  std::set<std::array<Index, 3>> marked;
  for (Index n = 0; n < 4 * data.numberOfCells(); ++n)
  {
    std::array<Index, 3> f;
    for (int k = 0; k < 3; ++k)
    {
      f[k] = data.connectivity[4 * (n / 4) + faces[n % 4][k]];
    }
    std::sort(f.begin(), f.end());
    if (std::all_of(f.begin(), f.end(), [&](Index p) { return plain.point(p)[0] == 3.0; }))
    {
      marked.insert(f);
    }
  }
  given.marked.assign(marked.begin(), marked.end());
  for (auto boundary : { BoundaryMotion::Fixed, BoundaryMotion::FlatParts })
  {
    ReconnectionOptions options;
    options.boundary = boundary;
    const Joined joined = reconnectOnRanks(given, 3, Cut::Random, options);
    checkResult(data, asResult(joined));
    TAUTLINE_CHECK_EQUAL(joined.first.markedFacets, static_cast<Index>(marked.size()));
    TAUTLINE_CHECK(joined.first.history.back().edgeRemovals > 0);
    std::vector<Index> after;
    for (const Index original : joined.original)
    {
      after.push_back(given.regions[original]);
    }
    double volumes[2][2] = { { 0, 0 }, { 0, 0 } };
    for (Index c = 0; c < data.numberOfCells(); ++c)
    {
      volumes[0][given.regions[c]] += volumeOf(data, c);
    }
    for (Index c = 0; c < joined.data.numberOfCells(); ++c)
    {
      volumes[1][after[c]] += volumeOf(joined.data, c);
    }
    TAUTLINE_CHECK_RELATIVE(volumes[1][0], volumes[0][0], 1e-13);
    TAUTLINE_CHECK_RELATIVE(volumes[1][1], volumes[0][1], 1e-13);
    if (boundary == BoundaryMotion::Fixed)
    {
      TAUTLINE_CHECK(outerFacets(joined.data, after, 1) == outerFacets(data, given.regions, 1));
    }
    std::set<std::array<Index, 3>> facets;
    for (Index n = 0; n < 4 * joined.data.numberOfCells(); ++n)
    {
      std::array<Index, 3> f;
      for (int k = 0; k < 3; ++k)
      {
        f[k] = joined.numbers[joined.data.connectivity[4 * (n / 4) + faces[n % 4][k]]];
      }
      std::sort(f.begin(), f.end());
      facets.insert(f);
    }
    TAUTLINE_CHECK(std::includes(facets.begin(), facets.end(), marked.begin(), marked.end()));
    for (std::size_t p = 0; p < joined.numbers.size(); ++p)
    {
      const Index number = joined.numbers[p];
      if (number < data.numberOfPoints() && given.fixed[number])
      {
        TAUTLINE_CHECK(joined.data.point(static_cast<Index>(p)) == data.point(number));
      }
    }
  }
}

/// A cube of n x n x n cubes of six tetrahedra each.
MeshData sixPerCube(Index n)
{
  MeshData data = blockMesh(CellType::Hexahedron, n, n, n);
  const MeshData cubes = data;
  data.types.clear();
  data.offsets = { 0 };
  data.connectivity.clear();
  for (Index cube = 0; cube < cubes.numberOfCells(); ++cube)
  {
    const Index first = cubes.connectivity[cubes.offsets[cube]];
    const std::array<Index, 3> steps = { 1, n + 1, (n + 1) * (n + 1) };
    std::array<int, 3> order = { 0, 1, 2 };
    do
    {
      std::vector<Index> nodes = { first };
      for (const int axis : order)
      {
        nodes.push_back(nodes.back() + steps[axis]);
      }
      if ((order[1] - order[0] + 3) % 3 == 2) // an odd permutation
      {
        std::swap(nodes[1], nodes[2]);
      }
      data.addCell(CellType::Tetrahedron, nodes);
    } while (std::next_permutation(order.begin(), order.end()));
  }
  return data;
}

/// Slivers with fixed points, and with a plane that is marked and between regions.
struct HeldMesh
{
  static constexpr Index Size = 5, Wall = 3;
  MeshData data;
  Given given{ data, {}, {}, {} };

  explicit HeldMesh(unsigned seed)
    : data(sixPerCube(Size))
  {
    const MeshData plain = this->data;
    moveInside(
      this->data, seed, 0.45, [this](Index cell) { return volumeOf(this->data, cell) > 2e-3; },
      [](const Vec3& x) { return x[0] == Wall; });
    constexpr int faces[4][3] = { { 1, 2, 3 }, { 0, 2, 3 }, { 0, 1, 3 }, { 0, 1, 2 } };
    std::set<std::array<Index, 3>> marked;
    for (Index c = 0; c < plain.numberOfCells(); ++c)
    {
      const Index* v = &plain.connectivity[4 * c];
      this->given.regions.push_back(
        std::all_of(v, v + 4, [&](Index p) { return plain.point(p)[0] <= Wall; }));
      for (const auto& face : faces)
      {
        std::array<Index, 3> f = { v[face[0]], v[face[1]], v[face[2]] };
        std::sort(f.begin(), f.end());
        if (std::all_of(f.begin(), f.end(), [&](Index p) { return plain.point(p)[0] == Wall; }))
        {
          marked.insert(f);
        }
      }
    }
    this->given.marked.assign(marked.begin(), marked.end());
    for (Index p = 0; p < plain.numberOfPoints(); ++p)
    {
      this->given.fixed.push_back(p % 11 == 0);
    }
  }
  HeldMesh(const HeldMesh&) = delete;
};

/**
 * @brief Where fixed points and a wall leave few ways, ranks also find one: insertions at
 * seams do not use up the number of tetrahedra.
 *
 * The target is 33.4 degrees, and with GCC 12 all twelve cases reach it, with parts of 190 to 380
 * tetrahedra. When insertions at seams used up their number, six ended below 33, the worst at 25.9.
 */
void testHeldQuality()
{
  int reached = 0;
  for (const unsigned seed : { 3, 4, 5, 6 })
  {
    const HeldMesh held(seed);
    ReconnectionRecord serial;
    for (const int ranks : { 1, 2, 3, 4 })
    {
      const Context context("seed " + std::to_string(seed) + ", " + std::to_string(ranks));
      const Joined joined = reconnectOnRanks(held.given, ranks, Cut::Random, {});
      checkResult(held.data, asResult(joined));
      const ReconnectionRecord& last = joined.first.history.back();
      serial = ranks == 1 ? last : serial;
      std::cout << "held, seed " << seed << ", " << ranks << " ranks, "
                << joined.first.history.size() - 1 << " rounds: " << last.smallestAngle << " / "
                << last.worstInverseMeanRatio << ", " << last.tetrahedra << " tetrahedra\n";
      // Rounding takes other ways with other compilers: GCC 14 had one of 12 with 19.5 degrees.
      TAUTLINE_CHECK(last.smallestAngle > 0.5 * serial.smallestAngle);
      reached += ranks > 1 && last.smallestAngle > serial.smallestAngle - 0.15;
    }
  }
  constexpr int least = 10; // of 12
  TAUTLINE_CHECK(reached >= least);
}

/// On a sliding boundary the shape stays; the number of cells stays within its bounds.
void testBounds()
{
  const MeshData data = sliverBlock(6, 7, 1.0);
  for (double bound : { 0.0, 0.02 })
  {
    ReconnectionOptions options;
    options.boundary = BoundaryMotion::FlatParts;
    options.targetAngle = 38.8;
    options.largestCount = 1.0 + bound;
    options.smallestCount = 1.0 - bound;
    const Joined joined = reconnectOnRanks({ data, {}, {}, {} }, 3, Cut::Slabs, options);
    checkResult(data, asResult(joined));
    const auto count = static_cast<double>(joined.data.numberOfCells());
    const auto before = static_cast<double>(data.numberOfCells());
    if (bound > 0.0)
    {
      TAUTLINE_CHECK(count <= options.largestCount * before);
      TAUTLINE_CHECK(count >= options.smallestCount * before);
    }
    else
    {
      TAUTLINE_CHECK_EQUAL(joined.data.numberOfPoints(), data.numberOfPoints());
    }
    for (Index p = 0; p < joined.data.numberOfPoints(); ++p)
    {
      const Vec3 x = joined.data.point(p);
      constexpr double Rounding = 1e-13; // points slide in planes to rounding
      TAUTLINE_CHECK(*std::min_element(x.begin(), x.end()) >= -Rounding);
      TAUTLINE_CHECK(*std::max_element(x.begin(), x.end()) <= 6.0 + Rounding);
    }
  }
}

/// Errors of one rank are errors on all; limits end all.
void testStops()
{
  const MeshData data = sliverBlock(5, 5, 1.0);
  const Given given = { data, {}, {}, {} };
  ReconnectionOptions options;
  options.maximumSeconds = 1e-9;
  const Joined timed = reconnectOnRanks(given, 3, Cut::Slabs, options);
  checkResult(data, asResult(timed));
  TAUTLINE_CHECK_EQUAL(
    static_cast<int>(timed.first.reason), static_cast<int>(StopReason::TimeLimit));
  options.maximumSeconds = 0.0;
  std::atomic<int> calls{ 0 };
  options.observer = [&](const ReconnectionRecord&, double) { return ++calls < 5; };
  const Joined aborted = reconnectOnRanks(given, 3, Cut::Slabs, options);
  checkResult(data, asResult(aborted));
  TAUTLINE_CHECK_EQUAL(
    static_cast<int>(aborted.first.reason), static_cast<int>(StopReason::Aborted));

  const auto rejected = [&](const MeshData& mesh, const auto& set, const char* text)
  {
    ReconnectionOptions wrong;
    set(wrong);
    TAUTLINE_CHECK_THROWS(reconnectOnRanks({ mesh, {}, {}, {} }, 3, Cut::Slabs, wrong), text);
  };
  const auto nothing = [](ReconnectionOptions&) {};
  rejected(
    data, [](auto& o) { o.boundary = BoundaryMotion::OnSurface; }, "on one rank");
  rejected(
    data, [](auto& o) { o.objective = ReconnectionObjective::Metric; }, "on one rank");
  rejected(
    data, [](auto& o) { o.overlaps = true; }, "conservative");
  rejected(
    data, [](auto& o) { o.targetAngle = 90; }, "target angle");
  MeshData inverted = data; // in one place, on one rank
  std::swap(inverted.connectivity[0], inverted.connectivity[1]);
  rejected(inverted, nothing, "inverted");
  MeshData twice = data;
  const auto last = twice.connectivity.end() - 4;
  twice.addCell(CellType::Tetrahedron, std::vector<Index>(last, last + 4));
  rejected(twice, nothing, wording("three-or-more"));
}
}

TAUTLINE_TEST(TestReconnectRanks)
{
  TAUTLINE_RUN(testRounds());
  TAUTLINE_RUN(testSeams());
  TAUTLINE_RUN(testKept());
  TAUTLINE_RUN(testHeldQuality());
  TAUTLINE_RUN(testBounds());
  TAUTLINE_RUN(testStops());
}
