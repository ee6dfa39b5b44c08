// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RankExchange.h
 * @brief Lists sent from every MPI rank to every other, and agreement on errors.
 * Internal: not installed.
 */
#ifndef tautline_RankExchange_h
#define tautline_RankExchange_h

#include "tautline/Core/Communicator.h"
#include "tautline/Core/Types.h"

#include <mpi.h>

#include <numeric>
#include <string>
#include <type_traits>
#include <vector>

namespace tautline
{
/// The MPI communicator; this process alone for null.
inline MPI_Comm mpiOf(Communicator communicator)
{
  return communicator ? *static_cast<const MPI_Comm*>(communicator) : MPI_COMM_SELF;
}

/// Whether a condition holds on any rank.
inline bool onAnyRank(MPI_Comm communicator, bool condition)
{
  int mine = condition, all = 0;
  MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_MAX, communicator);
  return all != 0;
}

/// Throws Error on all ranks if one of them reports an error: an exception on only one rank would
/// leave the others waiting.
inline void throwTogether(MPI_Comm communicator, const std::string& complaint)
{
  if (onAnyRank(communicator, !complaint.empty()))
  {
    throw Error(
      complaint.empty() ? "Another MPI rank has rejected its part of the data." : complaint);
  }
}

/// Items sorted by their destination or source rank, and the number for each rank.
template <class Item>
struct RankLists
{
  std::vector<Item> items;
  std::vector<int> counts;
};

/// The order that groups items 0 to n - 1 by rank, and the number for each rank.
struct ItemsByRank
{
  std::vector<Index> order;
  std::vector<int> counts;

  ItemsByRank(const std::vector<int>& rankOfItem, int ranks)
    : order(rankOfItem.size())
    , counts(ranks, 0)
  {
    std::vector<Index> next(ranks + 1, 0);
    for (const int rank : rankOfItem)
    {
      ++this->counts[rank];
      ++next[rank + 1];
    }
    std::partial_sum(next.begin(), next.end(), next.begin());
    for (std::size_t i = 0; i < rankOfItem.size(); ++i)
    {
      this->order[next[rankOfItem[i]]++] = static_cast<Index>(i);
    }
  }
};

/// Sends each rank its items; received items are in the order of the senders. Collective.
template <class Item>
RankLists<Item> exchange(MPI_Comm communicator, const RankLists<Item>& sent)
{
  static_assert(std::is_trivially_copyable<Item>::value, "Items are sent as bytes.");
  const std::size_t ranks = sent.counts.size();
  RankLists<Item> received;
  received.counts.resize(ranks);
  MPI_Alltoall(sent.counts.data(), 1, MPI_INT, received.counts.data(), 1, MPI_INT, communicator);
  std::vector<int> from(ranks + 1, 0), to(ranks + 1, 0);
  std::partial_sum(sent.counts.begin(), sent.counts.end(), from.begin() + 1);
  std::partial_sum(received.counts.begin(), received.counts.end(), to.begin() + 1);
  received.items.resize(static_cast<std::size_t>(to[ranks]));
  MPI_Datatype type = MPI_DATATYPE_NULL;
  MPI_Type_contiguous(sizeof(Item), MPI_BYTE, &type);
  MPI_Type_commit(&type);
  MPI_Alltoallv(sent.items.data(), sent.counts.data(), from.data(), type, received.items.data(),
    received.counts.data(), to.data(), type, communicator);
  MPI_Type_free(&type);
  return received;
}

/// The rank that keeps the directory entry of a number: neighboring numbers are spread over all
/// ranks.
inline int directoryRank(Index number, int ranks)
{
  const std::uint64_t mixed = static_cast<std::uint64_t>(number) * 0x9E3779B97F4A7C15u;
  return static_cast<int>((mixed >> 32) % static_cast<std::uint64_t>(ranks));
}
}
#endif
