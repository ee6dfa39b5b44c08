// SPDX-License-Identifier: BSD-3-Clause
#include "DistributedMesh.h"

#include "tautline/Core/Random.h"

#include <algorithm>
#include <cstring>
#include <iterator>

namespace tautline
{
//------------------------------------------------------------------------------
std::uint64_t DistributedMesh::ownerHash(Index number, int rank)
{
  return SplitMix::mixed(
    SplitMix::mixed(static_cast<std::uint64_t>(number)) + static_cast<std::uint64_t>(rank));
}

//------------------------------------------------------------------------------
Index DistributedMesh::haloPoints() const
{
  Index count = 0;
  for (const Subset::Neighbour& neighbour : this->Halo)
  {
    count += static_cast<Index>(neighbour.received.size());
  }
  return count;
}

namespace
{
template <class Value>
void exchangeValues(RankGroup& group,
  const std::vector<DistributedMesh::Subset::Neighbour>& neighbours, Value* values, int components,
  bool toOwners)
{
  std::vector<RankMessage> sent, received;
  const auto size = static_cast<std::size_t>(components) * sizeof(Value);
  // Toward the owners, the roles of the two lists are swapped.
  const auto listOf = [&](const DistributedMesh::Subset::Neighbour& n, bool sends) -> const auto&
  {
    return sends != toOwners ? n.sent : n.received;
  };
  for (const auto& neighbour : neighbours)
  {
    const auto& out = listOf(neighbour, true);
    const auto& in = listOf(neighbour, false);
    if (!out.empty())
    {
      sent.push_back({ neighbour.rank, Bytes(size * out.size()) });
      for (std::size_t i = 0; i < out.size(); ++i)
      {
        std::memcpy(sent.back().bytes.data() + i * size,
          values + static_cast<std::size_t>(components) * out[i], size);
      }
    }
    if (!in.empty())
    {
      received.push_back({ neighbour.rank, Bytes(size * in.size()) });
    }
  }
  group.send(sent, received);
  auto message = received.begin();
  std::vector<Value> got(components);
  for (const auto& neighbour : neighbours)
  {
    const auto& in = listOf(neighbour, false);
    for (std::size_t i = 0; i < in.size(); ++i)
    {
      Value* to = values + static_cast<std::size_t>(components) * in[i];
      std::memcpy(got.data(), message->bytes.data() + i * size, size);
      for (int c = 0; c < components; ++c)
      {
        // Toward the owners, only nonzero values are taken.
        to[c] = toOwners && !(got[c] != Value()) ? to[c] : got[c];
      }
    }
    message += !in.empty();
  }
}
}

//------------------------------------------------------------------------------
void DistributedMesh::exchange(double* values, int components) const
{
  exchangeValues(*this->Group, this->Halo, values, components, false);
}

void DistributedMesh::exchange(unsigned char* flags) const
{
  exchangeValues(*this->Group, this->Halo, flags, 1, false);
}

void DistributedMesh::exchange(const Subset& subset, double* values, int components) const
{
  exchangeValues(*this->Group, subset.neighbours, values, components, false);
}

void DistributedMesh::either(unsigned char* flags) const
{
  // First combine the flags at the owners, then return them to all copies.
  exchangeValues(*this->Group, this->Halo, flags, 1, true);
  this->exchange(flags);
}

//------------------------------------------------------------------------------
DistributedMesh::Subset DistributedMesh::subset(const std::vector<unsigned char>& flags) const
{
  std::vector<unsigned char> agreed = flags;
  this->exchange(agreed.data());
  Subset subset;
  for (const Subset::Neighbour& neighbour : this->Halo)
  {
    Subset::Neighbour part = { neighbour.rank, {}, {} };
    const auto flagged = [&](std::int32_t p) { return agreed[p] != 0; };
    std::copy_if(
      neighbour.sent.begin(), neighbour.sent.end(), std::back_inserter(part.sent), flagged);
    std::copy_if(neighbour.received.begin(), neighbour.received.end(),
      std::back_inserter(part.received), flagged);
    if (!part.sent.empty() || !part.received.empty())
    {
      subset.neighbours.push_back(std::move(part));
    }
  }
  return subset;
}

//------------------------------------------------------------------------------
std::vector<int> DistributedMesh::independentSets(const std::vector<unsigned char>& wanted) const
{
  std::vector<unsigned char> agreed = wanted;
  this->exchange(agreed.data());
  const Index n = this->localPoints();
  // Neighbors of the owned points with a larger hash: they choose first.
  const auto hashOf = [&](Index p)
  { return SplitMix::mixed(static_cast<std::uint64_t>(this->Numbers[p])); };
  std::vector<std::vector<std::int32_t>> before(n);
  for (Index cell = 0; cell < this->View.numberOfCells; ++cell)
  {
    for (Index i = this->Offsets[cell]; i < this->Offsets[cell + 1]; ++i)
    {
      const Index p = this->Connectivity[i];
      for (Index k = this->Offsets[cell]; k < this->Offsets[cell + 1]; ++k)
      {
        const Index q = this->Connectivity[k];
        if (p != q && agreed[p] && agreed[q] && this->owned(p) && hashOf(q) > hashOf(p))
        {
          before[p].push_back(static_cast<std::int32_t>(q));
        }
      }
    }
  }
  std::vector<Index> left;
  for (Index p = 0; p < n; ++p)
  {
    if (agreed[p] && this->owned(p))
    {
      left.push_back(p);
      std::sort(before[p].begin(), before[p].end());
      before[p].erase(std::unique(before[p].begin(), before[p].end()), before[p].end());
    }
  }
  std::sort(left.begin(), left.end(), [&](Index a, Index b) { return hashOf(a) > hashOf(b); });
  // Greedy coloring (Jones-Plassmann): each round, a point whose neighbors with larger hashes all
  // have a set takes the smallest set free among them.
  constexpr double none = -1;
  std::vector<double> set(n, none);
  std::vector<char> taken;
  while (this->Group->any(!left.empty()))
  {
    std::vector<Index> later;
    for (const Index p : left)
    {
      taken.assign(before[p].size() + 1, 0);
      bool ready = true;
      for (const std::int32_t q : before[p])
      {
        ready = ready && set[q] >= 0;
        if (set[q] >= 0 && set[q] < static_cast<double>(taken.size()))
        {
          taken[static_cast<std::size_t>(set[q])] = 1;
        }
      }
      if (ready)
      {
        set[p] = static_cast<double>(std::find(taken.begin(), taken.end(), 0) - taken.begin());
      }
      else
      {
        later.push_back(p);
      }
    }
    left.swap(later);
    this->exchange(set.data(), 1);
  }
  return { set.begin(), set.end() };
}
}
