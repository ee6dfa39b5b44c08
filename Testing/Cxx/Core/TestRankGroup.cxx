// SPDX-License-Identifier: BSD-3-Clause
// A failure on any rank ends the work on all of them, and they work together afterwards.
#include "Registry.h"
#include "ThreadRanks.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Core/Memory.h"

using namespace tautline;

namespace
{
constexpr int ranks = 3, failing = 1;

/// How work ends on each rank: the message of the error, "memory", "interrupted", or "".
std::vector<std::string> endsOf(const std::function<void(RankGroup&)>& work)
{
  std::vector<std::string> ends(ranks);
  onRanks(ranks,
    [&](RankGroup& group)
    {
      std::string& end = ends[group.rank()];
      try
      {
        group.together([&] { work(group); });
      }
      catch (const MemoryError&)
      {
        end = "memory";
      }
      catch (const Error& error)
      {
        end = error.what();
      }
      catch (const Interrupted&)
      {
        end = "interrupted";
      }
      // They are in step.
      TAUTLINE_CHECK_EQUAL(group.sum(Index(group.rank())), Index(3));
      TAUTLINE_CHECK_EQUAL(group.fromFirst(std::to_string(group.rank())), "0");
    });
  return ends;
}

std::vector<std::string> onAll(const std::string& end)
{
  return std::vector<std::string>(ranks, end);
}

/// The collectives that the others are in when one fails.
TAUTLINE_PART(testWaiting)
{
  const std::vector<std::function<void(RankGroup&)>> collectives = {
    [](RankGroup& group) { group.sum(Index(1)); }, [](RankGroup& group) { group.sum(1.0); },
    [](RankGroup& group) { group.maximum(1.0); }, [](RankGroup& group) { group.any(true); },
    [](RankGroup& group) { group.orderlessSum({ 1.0 }); },
    [](RankGroup& group) { group.gatherItems(std::vector<int>(group.rank())); },
    [](RankGroup& group)
    { group.exchangeItems(std::vector<std::vector<int>>(ranks, { group.rank() })); },
    [](RankGroup& group) { group.transpose(std::vector<Index>(ranks, 1)); },
    [](RankGroup& group) { group.fromFirst("text"); }, [](RankGroup& group) { group.agree(); },
    [](RankGroup& group) { group.together([&group] { group.sum(Index(1)); }); },
    [](RankGroup&) {}, // nothing more
  };
  for (std::size_t before = 0; before < 3; ++before)
  {
    for (std::size_t i = 0; i < collectives.size(); ++i)
    {
      const Context context(
        "collective " + std::to_string(i) + " after " + std::to_string(before) + " others");
      const auto ends = endsOf(
        [&](RankGroup& group)
        {
          for (std::size_t k = 0; k < before; ++k)
          {
            collectives[k](group);
          }
          if (group.rank() == failing)
          {
            throw Error("The disk is full.");
          }
          collectives[i](group);
        });
      TAUTLINE_CHECK(ends == onAll("In process 1: The disk is full."));
    }
  }
}

/// Calls within calls, at other depths on the rank that fails.
TAUTLINE_PART(testNested)
{
  const auto deep = [](RankGroup& group, int depth, const std::function<void()>& last)
  {
    std::function<void(int)> go = [&](int left)
    { left > 0 ? group.together([&, left] { go(left - 1); }) : last(); };
    go(depth);
  };
  for (const int depth : { 0, 1, 3 })
  {
    const Context context("depth " + std::to_string(depth));
    const auto ends = endsOf(
      [&](RankGroup& group)
      {
        group.rank() == failing ? deep(group, depth, [] { throw Error("Too deep."); })
                                : deep(group, 1, [&group] { group.sum(Index(1)); });
      });
    TAUTLINE_CHECK(ends == onAll("In process 1: Too deep."));
    // The same text from several depths is still one failure.
    const auto all = endsOf([&](RankGroup& group)
      { deep(group, group.rank() * depth, [] { throw MemoryError("Not enough."); }); });
    TAUTLINE_CHECK(all == onAll(depth == 0 ? "memory" : "Not enough."));
  }
}

/// An error that all throw alike is the error of all; an interruption is one on its own rank.
TAUTLINE_PART(testKinds)
{
  TAUTLINE_CHECK(endsOf([](RankGroup&) { throw MemoryError("Not enough."); }) == onAll("memory"));
  TAUTLINE_CHECK(endsOf([](RankGroup&) { throw Error("Wrong."); }) == onAll("Wrong."));
  const auto ends = endsOf(
    [](RankGroup& group)
    {
      group.together(
        [&group]
        {
          if (group.rank() == failing)
          {
            throw Interrupted();
          }
          group.sum(Index(1));
        });
    });
  TAUTLINE_CHECK_EQUAL(ends[failing], "interrupted");
  TAUTLINE_CHECK_EQUAL(ends[0], "In process 1: the computation was interrupted");
  TAUTLINE_CHECK_EQUAL(ends[2], ends[0]);
  // With two failures, the one of the lower rank counts.
  const auto two = endsOf(
    [](RankGroup& group)
    {
      if (group.rank() > 0)
      {
        throw Error("From rank " + std::to_string(group.rank()));
      }
      group.sum(Index(1));
    });
  TAUTLINE_CHECK(two == onAll("In process 1: From rank 1"));
  TAUTLINE_CHECK(endsOf([](RankGroup& group) { group.sum(Index(1)); }) == onAll(""));
}

/// The lists of all ranks, joined in the order of the ranks, on all of them or on the first.
TAUTLINE_PART(testLists)
{
  onRanks(ranks,
    [](RankGroup& group)
    {
      const std::vector<int> own(group.rank(), group.rank()), all = { 1, 2, 2 };
      TAUTLINE_CHECK(group.gatherJoined(own) == all);
      TAUTLINE_CHECK(group.gatherOnFirst(own) == (group.rank() == 0 ? all : std::vector<int>()));
      const std::vector<std::vector<int>> sent(ranks, own);
      TAUTLINE_CHECK(group.exchangeJoined(sent) == all);
    });
}
}
