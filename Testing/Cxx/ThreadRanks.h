// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ThreadRanks.h
 * @brief Ranks that are threads of this process, and meshes cut for them, for tests of the kernel.
 */
#ifndef tautline_ThreadRanks_h
#define tautline_ThreadRanks_h

#include "Blocks.h"
#include "tautline/Core/RankGroup.h"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

namespace tautline
{
/** A block of n cubes (squares) along each edge, whose points are moved at random by up to an
    amplitude in each direction; those on its sides stay on them. */
inline MeshData jittered(CellType type, Index n, double amplitude)
{
  const bool flat = topology(type).dimension == 2;
  MeshData data = blockMesh(type, n, n, flat ? 0 : n);
  Random random(5);
  const auto side = static_cast<double>(n);
  data.transform(
    [&](const Vec3& p)
    {
      Vec3 d = random.vector(-amplitude, amplitude);
      for (int c = 0; c < 3; ++c)
      {
        d[c] = p[c] == 0 || p[c] == side ? 0.0 : d[c];
      }
      return p + d;
    });
  return data;
}

/** The shared data of the ranks of a group. */
struct ThreadExchange
{
  explicit ThreadExchange(int size)
    : size(size)
    , boxes(size)
  {
  }

  /** Waits for all ranks; throws if one has left, for which the others would wait forever. */
  void wait()
  {
    std::unique_lock<std::mutex> lock(this->mutex);
    const long round = this->round;
    if (++this->waiting == this->size)
    {
      this->waiting = 0;
      ++this->round;
      this->all.notify_all();
      return;
    }
    this->all.wait(lock, [&] { return this->round != round || this->left; });
    if (this->round == round)
    {
      throw std::runtime_error("A rank has left that the others wait for.");
    }
  }

  /** A rank leaves with an error. */
  void leave()
  {
    const std::lock_guard<std::mutex> lock(this->mutex);
    this->left = true;
    this->all.notify_all();
  }

  int size;
  std::mutex mutex;
  std::condition_variable all;
  int waiting = 0;
  long round = 0;
  bool left = false;
  std::vector<std::map<int, Bytes>> boxes; ///< per receiver, by sender
};

class ThreadRank : public RankGroup
{
public:
  ThreadRank(ThreadExchange& exchange, int rank)
    : Exchange(exchange)
    , Rank(rank)
  {
  }
  int rank() const override { return this->Rank; }
  int size() const override { return this->Exchange.size; }
  Index messages = 0; ///< sent so far

protected:
  void sendAll(const std::vector<RankMessage>& sent, std::vector<RankMessage>& received) override
  {
    {
      const std::lock_guard<std::mutex> lock(this->Exchange.mutex);
      for (const RankMessage& message : sent)
      {
        this->Exchange.boxes[message.rank][this->Rank] = message.bytes;
        ++this->messages;
      }
    }
    this->Exchange.wait();
    std::map<int, Bytes>& box = this->Exchange.boxes[this->Rank];
    for (RankMessage& message : received)
    {
      const auto found = box.find(message.rank);
      if (found == box.end() || found->second.size() != message.bytes.size())
      {
        throw std::runtime_error("A message is missing, or not of the size that was agreed on.");
      }
      message.bytes = found->second;
      box.erase(found);
    }
    if (!box.empty())
    {
      throw std::runtime_error("A message that nobody waits for.");
    }
    this->Exchange.wait();
  }
  std::vector<Bytes> gatherAll(const Bytes& own) override
  {
    {
      const std::lock_guard<std::mutex> lock(this->Exchange.mutex);
      this->Exchange.boxes[this->Rank][-1] = own;
    }
    this->Exchange.wait();
    std::vector<Bytes> all;
    for (const auto& box : this->Exchange.boxes)
    {
      all.push_back(box.at(-1));
    }
    this->Exchange.wait();
    const std::lock_guard<std::mutex> lock(this->Exchange.mutex);
    this->Exchange.boxes[this->Rank].erase(-1);
    return all;
  }

private:
  ThreadExchange& Exchange;
  int Rank;
};

/** Calls work(group) together on as many ranks; throws what the first of them does. */
template <class Rank = ThreadRank, class Work>
void onRanks(int size, const Work& work)
{
  ThreadExchange exchange(size);
  std::vector<std::thread> threads;
  std::vector<std::exception_ptr> errors(size);
  for (int rank = 0; rank < size; ++rank)
  {
    threads.emplace_back(
      [&, rank]
      {
        Rank group(exchange, rank);
        try
        {
          group.together([&] { work(group); });
        }
        catch (...)
        {
          errors[rank] = std::current_exception();
          exchange.leave();
        }
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  for (const std::exception_ptr& error : errors)
  {
    if (error)
    {
      std::rethrow_exception(error);
    }
  }
}

/** The part of a mesh that a rank has, with points of its own. */
struct RankPart
{
  MeshData data;
  std::vector<Index> pointOf; ///< per point: its number in the whole mesh
  std::vector<Index> cellOf;
  std::vector<unsigned char> ghosts;
};

/** @param rankOf the rank of a cell @param ghosts also the cells next to the rank's cells */
template <class RankOf>
RankPart partOf(const MeshData& whole, int rank, const RankOf& rankOf, bool ghosts = false)
{
  RankPart part;
  std::vector<char> mine(whole.numberOfPoints(), 0);
  std::map<Index, Index> known;
  for (Index cell = 0; cell < whole.numberOfCells(); ++cell)
  {
    for (Index n = whole.offsets[cell]; rankOf(cell) == rank && n < whole.offsets[cell + 1]; ++n)
    {
      mine[whole.connectivity[n]] = 1;
    }
  }
  for (Index cell = 0; cell < whole.numberOfCells(); ++cell)
  {
    const auto begin = whole.connectivity.begin() + whole.offsets[cell];
    const auto end = whole.connectivity.begin() + whole.offsets[cell + 1];
    const bool own = rankOf(cell) == rank;
    if (!own && !(ghosts && std::any_of(begin, end, [&](Index p) { return mine[p] != 0; })))
    {
      continue;
    }
    std::vector<Index> nodes;
    for (auto p = begin; p != end; ++p)
    {
      const auto [at, fresh] = known.emplace(*p, part.data.numberOfPoints());
      if (fresh)
      {
        part.data.addPoint(whole.point(*p));
        part.pointOf.push_back(*p);
      }
      nodes.push_back(at->second);
    }
    part.data.addCell(static_cast<int>(whole.types[cell]), nodes);
    part.cellOf.push_back(cell);
    part.ghosts.push_back(!own);
  }
  return part;
}

/** Ways to cut a mesh. */
enum class Cut
{
  Slabs,
  Random,
  FirstOnly ///< all cells on rank 0
};

inline std::function<int(Index)> cutBy(const MeshData& whole, Cut cut, int ranks)
{
  if (cut == Cut::FirstOnly)
  {
    return [](Index) { return 0; };
  }
  std::vector<int> ranksOf;
  Random random(7);
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (Index p = 0; p < whole.numberOfPoints(); ++p)
  {
    low = std::min(low, whole.point(p)[0]);
    high = std::max(high, whole.point(p)[0]);
  }
  for (Index cell = 0; cell < whole.numberOfCells(); ++cell)
  {
    const double x = whole.point(whole.connectivity[whole.offsets[cell]])[0];
    const int slab = std::min(ranks - 1, static_cast<int>(ranks * (x - low) / (high - low)));
    const auto any = static_cast<int>(random.integer(ranks));
    ranksOf.push_back(cut == Cut::Slabs ? slab : any);
  }
  return [ranksOf](Index cell) { return ranksOf[cell]; };
}
}
#endif
