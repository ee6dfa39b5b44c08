// SPDX-License-Identifier: BSD-3-Clause
#include "RankGroup.h"

#include "Memory.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
/// Sums of integers of this width do not overflow, see orderlessSum().
__extension__ typedef __int128 Wide;

/// Bits of a value in units of the largest: before and after the binary point.
constexpr int highBits = 60, lowBits = 32;

/// The prefix of errors that another rank explains.
constexpr const char* vague = "Another rank";
constexpr const char* interrupted = "the computation was interrupted";
constexpr const char* elsewhere = "Another rank has rejected its part of the data.";

/// An error that has been thrown on all ranks.
class SharedError : public Error
{
public:
  SharedError(const std::string& message, bool alike)
    : Error(message)
    , alike(alike)
  {
  }

  bool alike; ///< whether all ranks have thrown the same error from the same call of together()
};
}

//------------------------------------------------------------------------------
RankGroup::~RankGroup() = default;

//------------------------------------------------------------------------------
void RankGroup::send(const std::vector<RankMessage>& sent, std::vector<RankMessage>& received)
{
  this->agree();
  this->sendAll(sent, received);
}

//------------------------------------------------------------------------------
std::vector<Bytes> RankGroup::allGather(const Bytes& own)
{
  this->agree();
  return this->gatherAll(own);
}

//------------------------------------------------------------------------------
bool RankGroup::anyOfAll(bool flag)
{
  const std::vector<Bytes> all = this->gatherAll(Bytes(1, flag ? 1 : 0));
  return std::any_of(all.begin(), all.end(), [](const Bytes& one) { return one[0] != 0; });
}

//------------------------------------------------------------------------------
std::vector<Bytes> RankGroup::exchange(const std::vector<Bytes>& sent)
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
  this->send(out, in);
  for (RankMessage& message : in)
  {
    received[message.rank] = std::move(message.bytes);
  }
  return received;
}

//------------------------------------------------------------------------------
std::vector<Index> RankGroup::transpose(std::vector<Index> numbers)
{
  // Item i must move i ranks ahead of its owner. In the round of each bit, the items with this bit
  // set in i move ahead by the value of the bit.
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
    this->send(out, in);
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
std::string RankGroup::fromFirst(const std::string& text)
{
  const bool first = this->rank() == 0;
  const Bytes found = this->allGather(first ? Bytes(text.begin(), text.end()) : Bytes())[0];
  return std::string(found.begin(), found.end());
}

//------------------------------------------------------------------------------
Index RankGroup::sum(Index value)
{
  const std::vector<Index> all = this->gatherJoined(std::vector<Index>{ value });
  return std::accumulate(all.begin(), all.end(), Index(0));
}

double RankGroup::sum(double value)
{
  const std::vector<double> all = this->gatherJoined(std::vector<double>{ value });
  return std::accumulate(all.begin(), all.end(), 0.0);
}

Index RankGroup::maximum(Index value)
{
  const std::vector<Index> all = this->gatherJoined(std::vector<Index>{ value });
  return *std::max_element(all.begin(), all.end());
}

double RankGroup::maximum(double value)
{
  for (const double one : this->gatherJoined(std::vector<double>{ value }))
  {
    value = std::max(value, one);
  }
  return value;
}

bool RankGroup::any(bool value)
{
  this->agree();
  return this->anyOfAll(value);
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
  // Integers are added without rounding. A product with a power of two is exact; two factors are
  // used where one would overflow.
  const int exponent = highBits - 1 - std::ilogb(largest), half = exponent / 2;
  const double first = std::ldexp(1.0, half), second = std::ldexp(1.0, exponent - half);
  constexpr double lowUnit = std::int64_t(1) << lowBits;
  Wide high = 0;
  std::int64_t low = 0; // can hold 2^31 terms, since each is below 2^32
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
  std::string failure;
  std::exception_ptr own;
  bool interruption = false;
  ++this->Depth;
  try
  {
    work();
  }
  catch (const SharedError&)
  {
    --this->Depth;
    throw;
  }
  catch (const std::exception& error)
  {
    own = std::current_exception();
    failure = errorText(error, "use more processes or a coarser mesh");
    failure = failure.empty() ? elsewhere : failure;
  }
  catch (...) // an interruption, which is not an error
  {
    if (this->Left)
    {
      --this->Depth;
      throw;
    }
    own = std::current_exception();
    interruption = true;
    failure = interrupted;
  }
  const int depth = this->Depth--;
  try
  {
    this->agreeOn(failure, depth);
  }
  catch (const SharedError& error)
  {
    this->Left = interruption;
    if (interruption || error.alike)
    {
      std::rethrow_exception(own);
    }
    throw;
  }
}

//------------------------------------------------------------------------------
void RankGroup::agree()
{
  this->agreeOn("", 0);
}

//------------------------------------------------------------------------------
/// @param failure the message of this rank, or "" @param depth of the call of together() that it
///   left
void RankGroup::agreeOn(const std::string& failure, int depth)
{
  this->Left = false;
  if (this->size() == 1 || !this->anyOfAll(!failure.empty()))
  {
    return;
  }
  const std::vector<Bytes> all = this->gatherAll(Bytes(failure.begin(), failure.end()));
  const std::vector<Bytes> depths = this->gatherAll(bytesOf(std::vector<int>{ depth }));
  // Prefer the message of a rank that explains the failure over a relayed one.
  const auto explains = [](const Bytes& text)
  { return !text.empty() && std::string(text.begin(), text.end()).rfind(vague, 0) != 0; };
  auto first = std::find_if(all.begin(), all.end(), explains);
  const bool explained = first != all.end();
  first = explained
    ? first
    : std::find_if(all.begin(), all.end(), [](const Bytes& text) { return !text.empty(); });
  const bool everywhere =
    std::all_of(all.begin(), all.end(), [&](const Bytes& text) { return text == *first; });
  const bool alike = everywhere &&
    std::all_of(depths.begin(), depths.end(), [&](const Bytes& one) { return one == depths[0]; });
  const std::string where =
    everywhere || !explained ? "" : "In process " + std::to_string(first - all.begin()) + ": ";
  throw SharedError(where + std::string(first->begin(), first->end()), alike);
}

//------------------------------------------------------------------------------
void SingleRank::sendAll(const std::vector<RankMessage>& sent, std::vector<RankMessage>& received)
{
  if (!sent.empty() || !received.empty())
  {
    throw Error("A single rank has no other to send to.");
  }
}
}
