// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RankGroup.h
 * @brief The ranks that work on one mesh, as the kernel sees them: MPI processes, threads of a
 * test, or this process alone.
 */
#ifndef tautline_RankGroup_h
#define tautline_RankGroup_h

#include "Types.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <functional>
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
 * @brief Communication between ranks. All methods but rank() and size() are collective: every rank
 * calls them in the same order. Implementations write start(), finish() and allGather().
 */
class TAUTLINE_KERNEL_EXPORT RankGroup
{
public:
  virtual ~RankGroup();

  virtual int rank() const = 0;
  virtual int size() const = 0;

  /**
   * @brief Starts to send and to receive, and returns at once. No second start() before finish().
   * @param sent kept unchanged by the caller until finish(); at most one message per rank
   * @param received of the size that each message has, at most one per rank; filled by finish()
   */
  virtual void start(const std::vector<RankMessage>& sent, std::vector<RankMessage>& received) = 0;
  /// Waits for what was started.
  virtual void finish() = 0;
  /// The bytes of every rank, on every rank.
  virtual std::vector<Bytes> allGather(const Bytes& own) = 0;

  /**
   * @brief Sends one number to each rank (numbers[r], also to itself) and returns that of each.
   *
   * In as many rounds as the size has binary digits, each with one message of about half of the
   * numbers, so that no rank has a table of all ranks by all ranks. Source: J. Bruck et al.,
   * Efficient algorithms for all-to-all communications in multiport message-passing systems, IEEE
   * Trans. Parallel Distrib. Syst. 8 (1997), the index operation.
   */
  std::vector<Index> transpose(std::vector<Index> numbers);
  /**
   * @brief Sends bytes to each rank (sent[r], also to itself) and returns those of each rank. A
   * rank without memory for what it receives is an error on all, as in together().
   * @param prepare called before they are sent, with how many come from each rank; what it throws
   * on any rank is thrown on all
   */
  std::vector<Bytes> exchange(const std::vector<Bytes>& sent,
    const std::function<void(const std::vector<Index>&)>& prepare = nullptr);
  /// The same with lists of items; also a rank without memory for copies of these is one on all.
  template <class Item>
  std::vector<std::vector<Item>> exchangeItems(const std::vector<std::vector<Item>>& sent);
  /// The items of every rank, on every rank.
  template <class Item>
  std::vector<std::vector<Item>> gatherItems(const std::vector<Item>& own);

  Index sum(Index value);
  Index maximum(Index value);
  double maximum(double value);
  bool any(bool value) { return this->maximum(static_cast<Index>(value)) > 0; }
  /// The sum of the values of all ranks and of all lists, rounded once: it depends neither on the
  /// order of the values nor on the ranks they are on. Values that are not finite give NaN.
  double orderlessSum(const std::vector<double>& values);

  /**
   * @brief Does work that does not communicate. What it throws on any rank is thrown on all, as
   * Error, with the message of the lowest rank that explains it, so that none waits for another. An
   * interruption is one on its own rank, and an error on the others. One rank throws as usual.
   */
  void together(const std::function<void()>& work);
};

/// This process alone.
class TAUTLINE_KERNEL_EXPORT SingleRank : public RankGroup
{
public:
  int rank() const override { return 0; }
  int size() const override { return 1; }
  void start(const std::vector<RankMessage>& sent, std::vector<RankMessage>& received) override;
  void finish() override {}
  std::vector<Bytes> allGather(const Bytes& own) override { return { own }; }
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
  // What fails here is reported where all ranks are.
  std::vector<Bytes> bytes(sent.size());
  std::exception_ptr failure;
  try
  {
    std::transform(sent.begin(), sent.end(), bytes.begin(), bytesOf<Item>);
  }
  catch (const std::exception&)
  {
    failure = std::current_exception();
    std::fill(bytes.begin(), bytes.end(), Bytes());
  }
  std::vector<std::vector<Item>> received(sent.size());
  const std::vector<Bytes> arrived = this->exchange(bytes,
    [&](const std::vector<Index>& lengths)
    {
      if (failure)
      {
        std::rethrow_exception(failure);
      }
      for (std::size_t r = 0; r < lengths.size(); ++r)
      {
        received[r].resize(static_cast<std::size_t>(lengths[r]) / sizeof(Item));
      }
    });
  for (std::size_t r = 0; r < arrived.size(); ++r)
  {
    if (!arrived[r].empty())
    {
      std::memcpy(received[r].data(), arrived[r].data(), received[r].size() * sizeof(Item));
    }
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
}
#endif
