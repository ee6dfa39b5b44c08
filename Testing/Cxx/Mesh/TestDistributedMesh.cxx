// SPDX-License-Identifier: BSD-3-Clause
// A mesh on ranks: numbers, owners, halos and sets follow from the mesh, however it is cut.
#include "Registry.h"
#include "Sanitized.h"
#include "ThreadRanks.h"
#include "tautline/Mesh/DistributedMesh.h"
#include "tautline/Mesh/PointDivision.h"

using namespace tautline;

namespace
{
MeshData jittered(CellType type, Index n)
{
  MeshData data = blockMesh(type, n, n, n - 1);
  Random random(3);
  data.transform([&](const Vec3& p) { return p + random.vector(-0.1, 0.1); });
  return data;
}

/// For each point of the whole mesh: its number and its set.
struct Layout
{
  std::vector<Index> numbers;
  std::vector<int> sets;

  bool operator==(const Layout& other) const
  {
    return this->numbers == other.numbers && this->sets == other.sets;
  }
};

/// Checks what one rank has, and notes the layout.
void checkRank(RankGroup& group, const MeshData& whole, const RankPart& part, bool ids,
  const std::vector<unsigned char>& free, std::mutex& mutex, Layout& layout, Index& owned)
{
  MeshPiece piece = { part.data.view(), ids ? part.pointOf.data() : nullptr, part.ghosts.data() };
  DistributedMesh mesh(group, piece);
  const std::vector<Index>& numbers = mesh.numbers();
  TAUTLINE_CHECK_EQUAL(mesh.globalPoints(), whole.numberOfPoints());
  TAUTLINE_CHECK_EQUAL(mesh.globalCells(), whole.numberOfCells());
  // Values that follow from the number: only the owner sets them.
  std::vector<double> values(2 * mesh.localPoints(), -1);
  std::vector<unsigned char> one(mesh.localPoints(), 0), wanted(mesh.localPoints(), 0);
  for (Index p = 0; p < mesh.localPoints(); ++p)
  {
    if (mesh.owned(p))
    {
      values[2 * p] = static_cast<double>(numbers[p]);
      values[2 * p + 1] = static_cast<double>(group.rank());
    }
  }
  mesh.exchange(values.data(), 2);
  bool arrived = true;
  for (Index p = 0; p < mesh.localPoints(); ++p)
  {
    arrived = arrived && values[2 * p] == static_cast<double>(numbers[p]) &&
      values[2 * p + 1] == mesh.owners()[p];
  }
  TAUTLINE_CHECK(arrived);
  // A flag set anywhere is seen everywhere.
  for (std::size_t p = 0; p < part.pointOf.size(); ++p)
  {
    const Index local = mesh.localOfPiece()[p];
    one[local] = part.pointOf[p] % 5 == 0;
    wanted[local] = free[part.pointOf[p]];
  }
  mesh.either(one.data());
  mesh.either(wanted.data());
  const std::vector<int> sets = mesh.independentSets(wanted);
  const std::lock_guard<std::mutex> lock(mutex);
  for (std::size_t p = 0; p < part.pointOf.size(); ++p)
  {
    const Index local = mesh.localOfPiece()[p], point = part.pointOf[p];
    TAUTLINE_CHECK_EQUAL(one[local] != 0, point % 5 == 0);
    TAUTLINE_CHECK(layout.numbers[point] < 0 || layout.numbers[point] == numbers[local]);
    layout.numbers[point] = numbers[local];
    if (mesh.owned(local))
    {
      layout.sets[point] = sets[local];
    }
  }
  for (Index p = 0; p < mesh.localPoints(); ++p)
  {
    owned += mesh.owned(p);
  }
  // All cells about own points are here.
  std::map<Index, Index> cellsAt;
  for (const Index node : mesh.view().numberOfCells > 0
      ? std::vector<Index>(mesh.view().connectivity,
          mesh.view().connectivity + mesh.view().offsets[mesh.view().numberOfCells])
      : std::vector<Index>())
  {
    ++cellsAt[node];
  }
  for (std::size_t p = 0; p < part.pointOf.size(); ++p)
  {
    const Index local = mesh.localOfPiece()[p];
    if (mesh.owned(local))
    {
      const auto count =
        std::count(whole.connectivity.begin(), whole.connectivity.end(), part.pointOf[p]);
      TAUTLINE_CHECK_EQUAL(cellsAt[local], static_cast<Index>(count));
    }
  }
}

Layout layoutOf(const MeshData& whole, Cut cut, int ranks, bool ids, bool ghosts)
{
  const auto rankOf = cutBy(whole, cut, ranks);
  Layout layout;
  layout.numbers.assign(whole.numberOfPoints(), -1);
  layout.sets.assign(whole.numberOfPoints(), -2);
  auto free = collect<unsigned char>(whole.numberOfPoints(), [&](Index p) { return p % 7 != 0; });
  std::mutex mutex;
  Index owned = 0;
  onRanks(ranks,
    [&](RankGroup& group)
    {
      const RankPart part = partOf(whole, group.rank(), rankOf, ghosts);
      checkRank(group, whole, part, ids, free, mutex, layout, owned);
    });
  TAUTLINE_CHECK_EQUAL(owned, whole.numberOfPoints());
  // No two points of a set share a cell.
  for (Index cell = 0; cell < whole.numberOfCells(); ++cell)
  {
    std::set<int> seen;
    for (Index n = whole.offsets[cell]; n < whole.offsets[cell + 1]; ++n)
    {
      const Index p = whole.connectivity[n];
      TAUTLINE_CHECK_EQUAL(layout.sets[p] >= 0, free[p] != 0);
      TAUTLINE_CHECK(!free[p] || seen.insert(layout.sets[p]).second);
    }
  }
  return layout;
}

void testLayout(CellType type)
{
  const MeshData whole = jittered(type, 4);
  const Layout serial = layoutOf(whole, Cut::FirstOnly, 1, false, false);
  std::vector<Index> all = serial.numbers;
  std::sort(all.begin(), all.end());
  std::vector<Index> expected(all.size());
  std::iota(expected.begin(), expected.end(), Index(0));
  TAUTLINE_CHECK(all == expected);
  for (const Cut cut : { Cut::Slabs, Cut::Random, Cut::FirstOnly })
  {
    for (const int ranks : { 2, 3, 5 })
    {
      for (const bool ids : { false, true })
      {
        for (const bool ghosts : { false, true })
        {
          const Context context("cut " + std::to_string(static_cast<int>(cut)) + ", " +
            std::to_string(ranks) + " ranks, ids " + std::to_string(ids) + ", ghosts " +
            std::to_string(ghosts));
          TAUTLINE_CHECK(layoutOf(whole, cut, ranks, ids, ghosts) == serial);
        }
      }
    }
  }
}

/// Calls construct(rank's piece) on ranks; the message of the error on each.
template <class Change>
std::vector<std::string> messagesOf(int ranks, const Change& change)
{
  const MeshData whole = jittered(CellType::Tetrahedron, 3);
  const auto rankOf = cutBy(whole, Cut::Random, ranks);
  std::vector<std::string> messages(ranks);
  onRanks(ranks,
    [&](RankGroup& group)
    {
      RankPart part = partOf(whole, group.rank(), rankOf, true);
      MeshPiece piece = { part.data.view(), part.pointOf.data(), part.ghosts.data() };
      change(group.rank(), part, piece);
      try
      {
        const DistributedMesh mesh(group, piece);
      }
      catch (const Error& error)
      {
        messages[group.rank()] = error.what();
      }
    });
  return messages;
}

/// Redistributed: the numbers are the same, every point has one owner, all ranks own about as many,
/// whoever has the cells; a random cut gets halos like surfaces.
TAUTLINE_PART(testDivision)
{
  const MeshData whole = jittered(CellType::Tetrahedron, 9);
  const auto points = static_cast<double>(whole.numberOfPoints());
  for (const Cut cut : { Cut::FirstOnly, Cut::Random, Cut::Slabs })
  {
    for (const int ranks : { 2, 3, 4 })
    {
      const Context context(
        "cut " + std::to_string(static_cast<int>(cut)) + ", " + std::to_string(ranks) + " ranks");
      const auto rankOf = cutBy(whole, cut, ranks);
      std::vector<int> owners(whole.numberOfPoints(), -1);
      std::vector<Index> own(ranks), cells(ranks);
      std::mutex mutex;
      onRanks(ranks,
        [&](RankGroup& group)
        {
          const RankPart part = partOf(whole, group.rank(), rankOf, cut == Cut::Slabs);
          const MeshPiece piece = { part.data.view(), nullptr, part.ghosts.data(), true };
          const DistributedMesh mesh(group, piece);
          const DistributedMesh undivided(group, { piece.view, nullptr, piece.ghosts });
          TAUTLINE_CHECK_EQUAL(mesh.globalPoints(), whole.numberOfPoints());
          TAUTLINE_CHECK_EQUAL(mesh.globalCells(), whole.numberOfCells());
          // The owner's values arrive at all ranks that have the point, also without own cells.
          auto values = collect<double>(mesh.localPoints(),
            [&](Index p) { return mesh.owned(p) ? static_cast<double>(mesh.numbers()[p]) : -1.0; });
          mesh.exchange(values.data(), 1);
          const std::lock_guard<std::mutex> lock(mutex);
          for (Index p = 0; p < mesh.localPoints(); ++p)
          {
            TAUTLINE_CHECK_EQUAL(values[p], static_cast<double>(mesh.numbers()[p]));
            own[group.rank()] += mesh.owned(p);
          }
          cells[group.rank()] = mesh.view().numberOfCells;
          for (std::size_t p = 0; p < part.pointOf.size(); ++p)
          {
            const Index local = mesh.localOfPiece()[p], before = undivided.localOfPiece()[p];
            TAUTLINE_CHECK_EQUAL(mesh.numbers()[local], undivided.numbers()[before]);
            int& noted = owners[part.pointOf[p]];
            TAUTLINE_CHECK(noted < 0 || noted == mesh.owners()[local]);
            noted = mesh.owners()[local];
          }
        });
      TAUTLINE_CHECK_EQUAL(
        std::accumulate(own.begin(), own.end(), Index(0)), whole.numberOfPoints());
      for (int rank = 0; rank < ranks; ++rank)
      {
        TAUTLINE_CHECK_NEAR(static_cast<double>(own[rank]), points / ranks, 1.0);
        TAUTLINE_CHECK(cells[rank] > 0);
        // Parts between planes: far fewer cells than all, which a random cut has on each rank.
        TAUTLINE_CHECK(cells[rank] < whole.numberOfCells() * 8 / 10);
      }
    }
  }
}

/// Points in a plane, on a line, at one place, fewer than ranks.
TAUTLINE_PART(testDivisionOfFew)
{
  for (const int ranks : { 1, 2, 5 })
  {
    for (const Index count : { 0, 1, 3, 40 })
    {
      const Context context(std::to_string(count) + " points, " + std::to_string(ranks));
      onRanks(ranks,
        [&](RankGroup& group)
        {
          std::vector<Vec3> line, place(count, Vec3{ 1, 2, 3 });
          for (Index i = 0; i < count; ++i)
          {
            line.push_back({ 0.5, static_cast<double>(i), 0 });
          }
          const PointDivision ofLine(group, line), ofPlace(group, place);
          std::vector<Index> own(ranks, 0);
          for (const Vec3& x : line)
          {
            const int rank = ofLine.find(x);
            TAUTLINE_CHECK(rank >= 0 && rank < ranks);
            ++own[std::clamp(rank, 0, ranks - 1)];
          }
          const Index most = *std::max_element(own.begin(), own.end());
          TAUTLINE_CHECK(count < 40 || most <= count / ranks + 1);
          const int rank = ofPlace.find({ 1, 2, 3 });
          TAUTLINE_CHECK(rank >= 0 && rank < ranks);
        });
    }
  }
}

/// An error on one rank is one on all.
TAUTLINE_PART(testErrors)
{
  const auto all = [](const std::vector<std::string>& messages, const char* text)
  {
    for (const std::string& message : messages)
    {
      TAUTLINE_CHECK(contains(message, text));
    }
  };
  all(messagesOf(3,
        [](int rank, RankPart& part, MeshPiece&)
        {
          if (rank == 1)
          {
            part.data.points[3] = HUGE_VAL;
          }
        }),
    "In process 1: Point 1 has a coordinate that is not finite");
  all(messagesOf(3,
        [](int rank, RankPart& part, MeshPiece&)
        {
          if (rank == 2)
          {
            part.pointOf[0] = part.pointOf[1];
          }
        }),
    "is at two locations");
  all(messagesOf(3,
        [](int rank, RankPart&, MeshPiece& piece)
        { piece.globalIds = rank == 0 ? nullptr : piece.globalIds; }),
    "Some processes have global point ids");
  all(messagesOf(2, [](int, RankPart&, MeshPiece& piece) { piece.ghosts = nullptr; }),
    "neither marks it as a ghost");
}

/// Every number arrives where it is sent, in few messages.
TAUTLINE_PART(testTranspose)
{
  for (const int ranks : { 1, 2, 3, 4, 5, 6, 7, 8, 13, 16, 21 })
  {
    const Context context(std::to_string(ranks) + " ranks");
    Index rounds = 0;
    while ((1 << rounds) < ranks)
    {
      ++rounds;
    }
    std::mutex mutex;
    onRanks(ranks,
      [&](ThreadRank& group)
      {
        auto numbers = collect<Index>(ranks, [&](int r) { return 1000 * group.rank() + r; });
        const std::vector<Index> received = group.transpose(numbers);
        const std::lock_guard<std::mutex> lock(mutex);
        TAUTLINE_CHECK_EQUAL(group.messages, rounds);
        TAUTLINE_CHECK_EQUAL(static_cast<int>(received.size()), ranks);
        TAUTLINE_EACH(int, r, ranks, TAUTLINE_CHECK_EQUAL(received[r], 1000 * r + group.rank()));
      });
  }
}

/// A rank that announces more bytes than there is memory for.
class AbsurdRank : public ThreadRank
{
public:
  using ThreadRank::ThreadRank;

protected:
  void sendAll(const std::vector<RankMessage>& sent, std::vector<RankMessage>& received) override
  {
    std::vector<RankMessage> messages = sent;
    for (RankMessage& message : messages)
    {
      // The lengths are the first that is sent.
      if (this->messages == 0 && this->rank() == 1)
      {
        constexpr Index length = std::numeric_limits<Index>::max();
        message.bytes = bytesOf(std::vector<Index>(message.bytes.size() / sizeof(Index), length));
      }
    }
    ThreadRank::sendAll(messages, received);
  }
};

/// A rank without memory for what it is sent ends in an error on all ranks.
TAUTLINE_PART(testMemoryOfMessages)
{
#if !TAUTLINE_ADDRESS_SANITIZER // which ends the program
  for (const int ranks : { 2, 3, 4 })
  {
    const Context context(std::to_string(ranks) + " ranks");
    int errors = 0, items = 0;
    std::mutex mutex;
    const auto count = [&](RankGroup& group, int& number, const auto& work)
    {
      try
      {
        group.together(work);
      }
      catch (const Error& error)
      {
        const std::lock_guard<std::mutex> lock(mutex);
        number += contains(error.what(), wording("not-enough-memory"));
      }
    };
    onRanks<AbsurdRank>(ranks,
      [&](RankGroup& group)
      { count(group, errors, [&] { group.exchange(std::vector<Bytes>(ranks, Bytes(1))); }); });
    onRanks<AbsurdRank>(ranks,
      [&](RankGroup& group)
      {
        count(group, items,
          [&] { group.exchangeItems(std::vector<std::vector<double>>(ranks, { 1.0 })); });
        // They still work together.
        TAUTLINE_CHECK_EQUAL(group.sum(Index(1)), Index(ranks));
      });
    TAUTLINE_CHECK_EQUAL(errors, ranks);
    TAUTLINE_CHECK_EQUAL(items, ranks);
  }
#endif
}

/// The exact sum, in any order and on any ranks.
TAUTLINE_PART(testSum)
{
  Random random(11);
  auto values = collect<double>(
    1000, [&](int) { return random.uniform(-1, 1) * std::pow(10.0, random.uniform(-8, 8)); });
  SingleRank single;
  const double expected = single.orderlessSum(values);
  long double sum = 0;
  for (const double value : values)
  {
    sum += value;
  }
  TAUTLINE_CHECK(std::abs(expected - static_cast<double>(sum)) <= 1e-15 * 1e8);
  for (const int ranks : { 2, 4 })
  {
    onRanks(ranks,
      [&](RankGroup& group)
      {
        std::vector<double> own;
        for (std::size_t i = group.rank(); i < values.size(); i += ranks)
        {
          own.insert(own.begin(), values[i]);
        }
        TAUTLINE_CHECK_EQUAL(group.orderlessSum(own), expected);
      });
  }
  TAUTLINE_CHECK(std::isnan(single.orderlessSum({ 1.0, HUGE_VAL })));
  TAUTLINE_CHECK_EQUAL(single.orderlessSum({}), 0.0);
  TAUTLINE_CHECK_EQUAL(single.orderlessSum({ 0x1p-1000, 0x1p-1000 }), 0x1p-999);
}

/// Numbers that are dense, far apart, in two clusters, below zero, and none: as std::lower_bound.
TAUTLINE_PART(testIntervals)
{
  Random random(8);
  constexpr Index many = 1000, far = Index(1) << 40;
  for (const Index range : { Index(0), Index(1), many, 7 * many, far })
  {
    std::set<Index> different;
    for (Index i = 0; i < std::min(many, range); ++i)
    {
      different.insert(random.integer(range) - range / 3);
      different.insert(far + i); // the second cluster
    }
    const std::vector<Index> numbers(different.begin(), different.end());
    const auto numberOf = [&numbers](Index place) { return numbers[place]; };
    const NumberIntervals intervals(static_cast<Index>(numbers.size()), numberOf);
    std::vector<Index> sought = { -far, 0, 2 * far };
    for (const Index number : numbers)
    {
      sought.insert(sought.end(), { number - 1, number, number + 1 });
    }
    TAUTLINE_EACH_OF(const Index number, sought,
      TAUTLINE_CHECK_EQUAL(intervals.find(number, numberOf),
        Index(std::lower_bound(numbers.begin(), numbers.end(), number) - numbers.begin())));
  }
}
}

//------------------------------------------------------------------------------
TAUTLINE_TEST(TestDistributedMesh)
{
  TAUTLINE_RUN(testLayout(CellType::Tetrahedron));
  TAUTLINE_RUN(testLayout(CellType::Hexahedron));
}
