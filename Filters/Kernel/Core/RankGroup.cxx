// SPDX-License-Identifier: BSD-3-Clause
#include "RankGroup.h"

#include "Memory.h"

#include <algorithm>
#include <exception>
#include <cmath>
#include <limits>

namespace tautline
{
namespace
{
/// Sums of integers of this width do not overflow, see orderlessSum().
__extension__ typedef __int128 Wide;

/// Bits of a value in units of the largest: before the point and behind it.
constexpr int highBits = 60, lowBits = 32;

/// How errors begin that another rank explains.
constexpr const char* vague = "Another rank";
constexpr const char* interrupted = "the computation was interrupted";
constexpr const char* elsewhere = "Another rank has rejected its part of the data.";
}

//------------------------------------------------------------------------------
RankGroup::~RankGroup() = default;

//------------------------------------------------------------------------------
std::vector<Bytes> RankGroup::exchange(
  const std::vector<Bytes>& sent, const std::function<void(const std::vector<Index>&)>& prepare)
{
  std::vector<Index> lengths;
  for (const Bytes& bytes : sent)
  {
    lengths.push_back(static_cast<Index>(bytes.size()));
  }
  const std::vector<Index> expected = this->transpose(std::move(lengths));
  const int own = this->rank();
  std::vector<RankMessage> out, in;
  std::vector<Bytes> received(sent.size());
  // All that grows with what is sent.
  this->together(
    [&]
    {
      if (prepare)
      {
        prepare(expected);
      }
      received[own] = sent[own];
      for (int r = 0; r < this->size(); ++r)
      {
        if (r != own && !sent[r].empty())
        {
          out.push_back({ r, sent[r] });
        }
        if (r != own && expected[r] > 0)
        {
          in.push_back({ r, Bytes(static_cast<std::size_t>(expected[r])) });
        }
      }
    });
  this->start(out, in);
  this->finish();
  for (RankMessage& message : in)
  {
    received[message.rank] = std::move(message.bytes);
  }
  return received;
}

//------------------------------------------------------------------------------
std::vector<Index> RankGroup::transpose(std::vector<Index> numbers)
{
  // Number i is under way to the rank i after the one that has it. In each round those with one of
  // the bits of i go as far as this bit is worth.
  const int own = this->rank(), size = this->size();
  std::rotate(numbers.begin(), numbers.begin() + own, numbers.end());
  for (int step = 1; step < size; step *= 2)
  {
    std::vector<Index> moving;
    for (int i = 0; i < size; ++i)
    {
      if (i & step)
      {
        moving.push_back(numbers[i]);
      }
    }
    const std::vector<RankMessage> out = { { (own + step) % size, bytesOf(moving) } };
    std::vector<RankMessage> in = { { (own - step + size) % size, Bytes(out[0].bytes.size()) } };
    this->start(out, in);
    this->finish();
    const std::vector<Index> arrived = itemsOf<Index>(in[0].bytes);
    auto next = arrived.begin();
    for (int i = 0; i < size; ++i)
    {
      numbers[i] = i & step ? *next++ : numbers[i];
    }
  }
  std::vector<Index> received(numbers.size());
  for (int i = 0; i < size; ++i)
  {
    received[(own - i + size) % size] = numbers[i];
  }
  return received;
}

//------------------------------------------------------------------------------
Index RankGroup::sum(Index value)
{
  Index total = 0;
  for (const auto& one : this->gatherItems(std::vector<Index>{ value }))
  {
    total += one[0];
  }
  return total;
}

Index RankGroup::maximum(Index value)
{
  for (const auto& one : this->gatherItems(std::vector<Index>{ value }))
  {
    value = std::max(value, one[0]);
  }
  return value;
}

double RankGroup::maximum(double value)
{
  for (const auto& one : this->gatherItems(std::vector<double>{ value }))
  {
    value = std::max(value, one[0]);
  }
  return value;
}

//------------------------------------------------------------------------------
double RankGroup::orderlessSum(const std::vector<double>& values)
{
  bool finite = true;
  double largest = 0;
  for (const double value : values)
  {
    finite = finite && std::isfinite(value);
    largest = std::max(largest, std::abs(value));
  }
  const double infinity = std::numeric_limits<double>::infinity();
  largest = this->maximum(finite ? largest : infinity);
  if (!std::isfinite(largest))
  {
    return std::numeric_limits<double>::quiet_NaN();
  }
  if (largest == 0)
  {
    return 0.0;
  }
  // Integers are added without rounding. A product by a power of two is exact; it takes two factors
  // where one would overflow.
  const int exponent = highBits - 1 - std::ilogb(largest), half = exponent / 2;
  const double first = std::ldexp(1.0, half), second = std::ldexp(1.0, exponent - half);
  constexpr double lowUnit = std::int64_t(1) << lowBits;
  Wide high = 0;
  std::int64_t low = 0; // takes 2^31 parts, as each is below 2^32
  for (const double value : values)
  {
    const double scaled = value * first * second;
    const auto whole = static_cast<std::int64_t>(scaled);
    high += whole;
    low += static_cast<std::int64_t>((scaled - static_cast<double>(whole)) * lowUnit);
  }
  // A product, as the shift of a negative number is undefined in C++17.
  const Wide total = high * (Wide(1) << lowBits) + low;
  Wide sum = 0;
  for (const auto& one : this->gatherItems(std::vector<Wide>{ total }))
  {
    sum += one[0];
  }
  return static_cast<double>(std::ldexp(static_cast<long double>(sum), -lowBits - exponent));
}

//------------------------------------------------------------------------------
void RankGroup::together(const std::function<void()>& work)
{
  if (this->size() == 1)
  {
    work();
    return;
  }
  std::string message;
  std::exception_ptr interruption;
  try
  {
    work();
  }
  catch (const std::exception& error)
  {
    message = errorText(error, "take more processes or a coarser mesh");
    message = message.empty() ? elsewhere : message;
  }
  catch (...) // an interruption, which is no error
  {
    interruption = std::current_exception();
    message = interrupted;
  }
  const std::vector<Bytes> all = this->allGather(Bytes(message.begin(), message.end()));
  if (interruption)
  {
    std::rethrow_exception(interruption);
  }
  // Of a rank that explains it, rather than of one that was told so.
  const auto explains = [](const Bytes& text)
  { return !text.empty() && std::string(text.begin(), text.end()).rfind(vague, 0) != 0; };
  auto first = std::find_if(all.begin(), all.end(), explains);
  const bool explained = first != all.end();
  first = explained
    ? first
    : std::find_if(all.begin(), all.end(), [](const Bytes& text) { return !text.empty(); });
  if (first != all.end())
  {
    const bool everywhere =
      std::all_of(all.begin(), all.end(), [&](const Bytes& text) { return text == *first; });
    const std::string where =
      everywhere || !explained ? "" : "In process " + std::to_string(first - all.begin()) + ": ";
    throw Error(where + std::string(first->begin(), first->end()));
  }
}

//------------------------------------------------------------------------------
void SingleRank::start(const std::vector<RankMessage>& sent, std::vector<RankMessage>& received)
{
  if (!sent.empty() || !received.empty())
  {
    throw Error("A single rank has no other to send to.");
  }
}
}
