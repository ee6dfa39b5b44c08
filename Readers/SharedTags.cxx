// SPDX-License-Identifier: BSD-3-Clause
#include "SharedTags.h"

#include "PartExchange.h"

#include <algorithm>
#include <limits>

namespace tautline
{
//------------------------------------------------------------------------------
SharedTags::SharedTags(const FileRanges& ranges, const std::vector<Index>& tags)
  : Ranges(ranges)
  , Begins(rankBegins(ranges.group(), static_cast<Index>(tags.size())))
{
  RankGroup& group = ranges.group();
  const Index begin = this->Begins[at(group.rank())];
  Index low = std::numeric_limits<Index>::max(), high = 0;
  for (const Index tag : tags)
  {
    low = std::min(low, tag);
    high = std::max(high, tag);
  }
  this->High = group.maximum(high);
  this->Low = ~group.maximum(~low); // the complement of the least is the largest
  ranges.require(this->Low >= 0);   // as their differences must be numbers
  bool consecutive = true;
  for (std::size_t i = 0; i < tags.size(); ++i)
  {
    consecutive = consecutive && tags[i] - this->Low == begin + static_cast<Index>(i);
  }
  this->Consecutive = !group.any(!consecutive);
  if (this->Consecutive)
  {
    return;
  }
  std::vector<std::vector<TagPlace>> sent(at(group.size()));
  ranges.together(
    [&]
    {
      for (std::size_t i = 0; i < tags.size(); ++i)
      {
        sent[this->rankOfTag(tags[i])].push_back({ tags[i], begin + static_cast<Index>(i) });
      }
    });
  sent = sendLists(ranges, sent);
  bool twice = false;
  ranges.together(
    [&]
    {
      for (const std::vector<TagPlace>& some : sent)
      {
        this->Own.insert(this->Own.end(), some.begin(), some.end());
      }
      std::sort(this->Own.begin(), this->Own.end());
      twice =
        std::adjacent_find(this->Own.begin(), this->Own.end(),
          [](const TagPlace& a, const TagPlace& b) { return a.tag == b.tag; }) != this->Own.end();
    });
  ranges.require(!twice);
}

//------------------------------------------------------------------------------
void SharedTags::find(std::vector<Index>& tags) const
{
  bool known = true;
  if (this->Consecutive)
  {
    for (Index& tag : tags)
    {
      known = known && tag >= this->Low && tag <= this->High;
      tag -= known ? this->Low : 0;
    }
    this->Ranges.require(known);
    return;
  }
  std::vector<Index> asked;
  std::vector<std::vector<Index>> questions(this->Begins.size() - 1);
  this->Ranges.together(
    [&]
    {
      asked = tags;
      std::sort(asked.begin(), asked.end());
      asked.erase(std::unique(asked.begin(), asked.end()), asked.end());
      for (const Index tag : asked)
      {
        questions[this->rankOfTag(tag)].push_back(tag);
      }
    });
  questions = sendLists(this->Ranges, questions);
  for (std::vector<Index>& some : questions)
  {
    for (Index& tag : some)
    {
      const auto found = std::lower_bound(this->Own.begin(), this->Own.end(), TagPlace{ tag, 0 });
      const bool here = found != this->Own.end() && found->tag == tag;
      known = known && here;
      tag = here ? found->place : 0;
    }
  }
  this->Ranges.require(known);
  questions = sendLists(this->Ranges, questions);
  this->Ranges.together(
    [&]
    {
      std::vector<Index> places; // of those that were asked for, as each rank has them in order
      std::vector<std::size_t> next(questions.size(), 0);
      places.reserve(asked.size());
      for (const Index tag : asked)
      {
        const std::size_t rank = this->rankOfTag(tag);
        places.push_back(questions[rank][next[rank]++]);
      }
      for (Index& tag : tags)
      {
        tag = places[at(std::lower_bound(asked.begin(), asked.end(), tag) - asked.begin())];
      }
    });
}

//------------------------------------------------------------------------------
std::size_t SharedTags::rankOfTag(Index tag) const
{
  // multiplicative hashing by the golden ratio: numbers of any stride spread over all ranks
  constexpr std::uint64_t ratio = 0x9e3779b97f4a7c15u;
  constexpr int upper = 32;
  return static_cast<std::size_t>(
    ((static_cast<std::uint64_t>(tag) * ratio) >> upper) % (this->Begins.size() - 1));
}
}
