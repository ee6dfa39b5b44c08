// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RankGroup.h
 * @brief The ranks that work on one mesh: MPI processes, threads of a test, or this process alone.
 */
#ifndef tautline_RankGroup_h
#define tautline_RankGroup_h

#include "Communicator.h"
#include "Types.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

namespace tautline
{
using Bytes = std::vector<char>;

/// A message to or from a rank.
struct RankMessage
{
  int rank = 0;
  Bytes bytes;
};

/**
 * @class tautline::RankGroup
 * @brief Communication between ranks. All methods except rank() and size() are collective: every
 * rank calls them in the same order.
 *
 * A failure on one rank must not leave the others waiting. Code that calls these methods runs in
 * together(): each method first checks whether a rank has left with an exception and, if so, throws
 * on all ranks. Algorithms can therefore throw where they find an error, as in a serial run.
 *
 * Implementations write sendAll() and gatherAll().
 */
class TAUTLINE_KERNEL_EXPORT RankGroup
{
public:
  virtual ~RankGroup();

  virtual int rank() const = 0;
  virtual int size() const = 0;
  /// The MPI communicator, for libraries that use it; null: this rank alone, or ranks without MPI.
  virtual Communicator communicator() const { return nullptr; }

  /**
   * @brief Does work that may communicate through this group. An exception on any rank is thrown on
   * all: unchanged if all ranks throw the same, otherwise as an Error with the message of the
   * lowest rank that explains it. An interruption remains an interruption on its own rank and
   * becomes an error on the others. Calls nest.
   *
   * Code that communicates in other ways, such as PETSc, needs all ranks: call agree() before it.
   */
  void together(const std::function<void()>& work);
  /// Throws, on all ranks, if one has left together(). Every other method begins with it.
  void agree();

  /**
   * @brief Sends and receives messages of known sizes.
   * @param sent at most one message per rank
   * @param received with the size of each message, at most one per rank
   */
  void send(const std::vector<RankMessage>& sent, std::vector<RankMessage>& received);
  /// The bytes of every rank, on every rank.
  std::vector<Bytes> allGather(const Bytes& own);

  /**
   * @brief Sends one number to each rank (numbers[r], also to itself) and returns the number
   * received from each rank.
   *
   * In as many rounds as the size has binary digits, each with one message of about half of the
   * numbers, so that no rank has a table of all ranks by all ranks. Source: J. Bruck et al.,
   * Efficient algorithms for all-to-all communications in multiport message-passing systems, IEEE
   * Trans. Parallel Distrib. Syst. 8 (1997), the index operation.
   */
  std::vector<Index> transpose(std::vector<Index> numbers);
  /**
   * @brief Sends bytes to each rank (sent[r], also to itself) and returns the bytes received from
   * each rank.
   */
  std::vector<Bytes> exchange(const std::vector<Bytes>& sent);
  /// The same with lists of items.
  template <class Item>
  std::vector<std::vector<Item>> exchangeItems(const std::vector<std::vector<Item>>& sent);
  /// The items of every rank, on every rank.
  template <class Item>
  std::vector<std::vector<Item>> gatherItems(const std::vector<Item>& own);

  /// The same, concatenated in the order of the ranks.
  template <class Item>
  std::vector<Item> exchangeJoined(const std::vector<std::vector<Item>>& sent);
  template <class Item>
  std::vector<Item> gatherJoined(const std::vector<Item>& own);
  /// The same on the first rank only; the others receive an empty list.
  template <class Item>
  std::vector<Item> gatherOnFirst(const std::vector<Item>& own);

  /// The text of the first rank, on every rank.
  std::string fromFirst(const std::string& text);
  Index sum(Index value);
  double sum(double value); ///< in the order of the ranks
  Index maximum(Index value);
  double maximum(double value);
  bool any(bool value);
  bool everywhere(bool value) { return !this->any(!value); }
  /// The sum of the values of all ranks and of all lists, rounded once: it depends neither on the
  /// order of the values nor on their distribution over the ranks. Values that are not finite give
  /// NaN.
  double orderlessSum(const std::vector<double>& values);

protected:
  /// Implements send(), on all ranks at once.
  virtual void sendAll(
    const std::vector<RankMessage>& sent, std::vector<RankMessage>& received) = 0;
  /// Implements allGather(), on all ranks at once.
  virtual std::vector<Bytes> gatherAll(const Bytes& own) = 0;
  /// Whether a flag is set on any rank, on all ranks at once.
  virtual bool anyOfAll(bool flag);

private:
  void agreeOn(const std::string& failure, int depth);

  int Depth = 0;     ///< of calls of together()
  bool Left = false; ///< after an interruption that all ranks have been notified of
};

/// This process alone.
class TAUTLINE_KERNEL_EXPORT SingleRank : public RankGroup
{
public:
  int rank() const override { return 0; }
  int size() const override { return 1; }

protected:
  void sendAll(const std::vector<RankMessage>& sent, std::vector<RankMessage>& received) override;
  std::vector<Bytes> gatherAll(const Bytes& own) override { return { own }; }
};

template <class Item>
Bytes bytesOf(const std::vector<Item>& items)
{
  static_assert(std::is_trivially_copyable<Item>::value, "Items are sent as bytes.");
  Bytes bytes(items.size() * sizeof(Item));
  if (!items.empty())
  {
    std::memcpy(bytes.data(), items.data(), bytes.size());
  }
  return bytes;
}

template <class Item>
std::vector<Item> itemsOf(const Bytes& bytes)
{
  std::vector<Item> items(bytes.size() / sizeof(Item));
  if (!items.empty())
  {
    std::memcpy(items.data(), bytes.data(), items.size() * sizeof(Item));
  }
  return items;
}

template <class Item>
std::vector<std::vector<Item>> RankGroup::exchangeItems(const std::vector<std::vector<Item>>& sent)
{
  std::vector<Bytes> bytes(sent.size());
  std::transform(sent.begin(), sent.end(), bytes.begin(), bytesOf<Item>);
  std::vector<std::vector<Item>> received;
  for (const Bytes& arrived : this->exchange(bytes))
  {
    received.push_back(itemsOf<Item>(arrived));
  }
  return received;
}

template <class Item>
std::vector<std::vector<Item>> RankGroup::gatherItems(const std::vector<Item>& own)
{
  std::vector<std::vector<Item>> all;
  for (const Bytes& one : this->allGather(bytesOf(own)))
  {
    all.push_back(itemsOf<Item>(one));
  }
  return all;
}

/// The concatenated items of lists.
template <class Item>
std::vector<Item> joinLists(const std::vector<std::vector<Item>>& lists)
{
  std::vector<Item> joined;
  for (const std::vector<Item>& list : lists)
  {
    joined.insert(joined.end(), list.begin(), list.end());
  }
  return joined;
}

template <class Item>
std::vector<Item> RankGroup::exchangeJoined(const std::vector<std::vector<Item>>& sent)
{
  return joinLists(this->exchangeItems(sent));
}

template <class Item>
std::vector<Item> RankGroup::gatherJoined(const std::vector<Item>& own)
{
  return joinLists(this->gatherItems(own));
}

template <class Item>
std::vector<Item> RankGroup::gatherOnFirst(const std::vector<Item>& own)
{
  std::vector<std::vector<Item>> sent(static_cast<std::size_t>(this->size()));
  sent.front() = own;
  return this->exchangeJoined(sent);
}
}
#endif
