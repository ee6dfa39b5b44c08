// SPDX-License-Identifier: BSD-3-Clause
#include "DecompositionCounts.h"

#include "DistributedMesh.h"
#include "TakenCells.h"
#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

namespace tautline
{
namespace
{
/// A copy of a point that a rank holds from another rank.
struct PartCopy
{
  int receiver;
  Index point;

  auto key() const { return std::tie(this->receiver, this->point); }
  bool operator<(const PartCopy& other) const { return this->key() < other.key(); }
  bool operator==(const PartCopy& other) const { return this->key() == other.key(); }
};

void check(const MeshView& view, const std::vector<int>& partOfCell, int parts,
  const std::vector<unsigned char>& free)
{
  if (parts < 1)
  {
    throw Error("A mesh has " + std::to_string(parts) + " parts; at least 1 is needed.");
  }
  if (static_cast<Index>(partOfCell.size()) != view.numberOfCells ||
    static_cast<Index>(free.size()) != view.numberOfPoints)
  {
    throw Error("There are " + std::to_string(partOfCell.size()) + " numbers of parts for " +
      std::to_string(view.numberOfCells) + " cells and " + std::to_string(free.size()) +
      " flags for " + std::to_string(view.numberOfPoints) + " points; one each is needed.");
  }
  const auto wrong = std::find_if(
    partOfCell.begin(), partOfCell.end(), [&](int part) { return part < 0 || part >= parts; });
  if (wrong != partOfCell.end())
  {
    throw Error("Cell " + std::to_string(wrong - partOfCell.begin()) + " is in part " +
      std::to_string(*wrong) + "; it must be from 0 to " + std::to_string(parts - 1) + ".");
  }
}

/// Per point, the rank that owns it, or -1 if it has no cell.
std::vector<int> findOwners(
  const MeshView& view, const std::vector<int>& partOfCell, const std::vector<Index>& numbers)
{
  std::vector<int> owners(view.numberOfPoints, -1);
  std::vector<std::uint64_t> least(view.numberOfPoints, std::numeric_limits<std::uint64_t>::max());
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    pollInterruption(cell);
    for (Index n = view.offsets[cell]; takesPart(view, cell) && n < view.offsets[cell + 1]; ++n)
    {
      const Index p = view.connectivity[n];
      const int part = partOfCell[cell];
      const std::uint64_t hash = DistributedMesh::ownerHash(numbers[p], part);
      if (owners[p] != part && (hash < least[p] || (hash == least[p] && part < owners[p])))
      {
        least[p] = hash;
        owners[p] = part;
      }
    }
  }
  return owners;
}

/// The copies that ranks need: of the points of their part and of the cells around their owned
/// points.
std::vector<PartCopy> findCopies(
  const MeshView& view, const std::vector<int>& partOfCell, const std::vector<int>& owners)
{
  std::vector<PartCopy> copies;
  std::vector<int> receivers;
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    pollInterruption(cell);
    if (!takesPart(view, cell))
    {
      continue;
    }
    const Index begin = view.offsets[cell], end = view.offsets[cell + 1];
    receivers.assign(1, partOfCell[cell]);
    for (Index n = begin; n < end; ++n)
    {
      receivers.push_back(owners[view.connectivity[n]]);
    }
    std::sort(receivers.begin(), receivers.end());
    receivers.erase(std::unique(receivers.begin(), receivers.end()), receivers.end());
    for (const int receiver : receivers)
    {
      for (Index n = begin; n < end; ++n)
      {
        if (owners[view.connectivity[n]] != receiver)
        {
          copies.push_back({ receiver, view.connectivity[n] });
        }
      }
    }
  }
  std::sort(copies.begin(), copies.end());
  copies.erase(std::unique(copies.begin(), copies.end()), copies.end());
  return copies;
}

/// Derives messages and neighbors from the copies.
void countMessages(const std::vector<PartCopy>& copies, const std::vector<int>& owners,
  const std::vector<int>& sets, std::vector<PartCounts>& parts)
{
  std::vector<std::tuple<int, int, int>> messages; // from, to, set
  std::vector<std::pair<int, int>> neighbours;
  for (const PartCopy& copy : copies)
  {
    const int owner = owners[copy.point];
    ++parts[copy.receiver].haloPoints;
    neighbours.emplace_back(owner, copy.receiver);
    neighbours.emplace_back(copy.receiver, owner);
    if (sets[copy.point] >= 0)
    {
      ++parts[owner].sentPoints;
      messages.emplace_back(owner, copy.receiver, sets[copy.point]);
    }
  }
  const auto distinct = [](auto& list)
  {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  };
  distinct(neighbours);
  distinct(messages);
  for (const auto& [from, to] : neighbours)
  {
    ++parts[from].neighbours;
  }
  for (const auto& message : messages)
  {
    ++parts[std::get<0>(message)].messages;
  }
}
}

//------------------------------------------------------------------------------
DecompositionCounts countDecomposition(const MeshView& view, const std::vector<int>& partOfCell,
  int parts, const std::vector<unsigned char>& free)
{
  check(view, partOfCell, parts, free);
  // Numbers and sets do not depend on the ranks, so that this process computes them alone. Global
  // ids keep coincident points separate.
  SingleRank alone;
  std::vector<Index> ids(view.numberOfPoints);
  std::iota(ids.begin(), ids.end(), Index(0));
  const DistributedMesh mesh(alone, { view, ids.data(), nullptr });
  std::vector<Index> numbers(view.numberOfPoints, -1);
  std::vector<unsigned char> wanted(mesh.localPoints(), 0);
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    const Index local = mesh.localOfPiece()[p];
    if (local >= 0)
    {
      numbers[p] = mesh.numbers()[local];
      wanted[local] = free[p];
    }
  }
  const std::vector<int> localSets = mesh.independentSets(wanted);
  const std::vector<int> owners = findOwners(view, partOfCell, numbers);

  DecompositionCounts counts;
  counts.parts.resize(parts);
  counts.points = mesh.globalPoints();
  std::vector<int> sets(view.numberOfPoints, -1);
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    if (owners[p] >= 0)
    {
      sets[p] = localSets[mesh.localOfPiece()[p]];
      counts.sets = std::max(counts.sets, static_cast<Index>(sets[p]) + 1);
      counts.freePoints += sets[p] >= 0;
      ++counts.parts[owners[p]].points;
      counts.parts[owners[p]].freePoints += sets[p] >= 0;
    }
  }
  std::vector<Index> inSet(static_cast<std::size_t>(counts.sets) * parts, 0);
  for (Index p = 0; p < view.numberOfPoints; ++p)
  {
    if (sets[p] >= 0)
    {
      ++inSet[static_cast<std::size_t>(sets[p]) * parts + owners[p]];
    }
  }
  for (auto set = inSet.begin(); set != inSet.end(); set += parts)
  {
    counts.slowestPoints += *std::max_element(set, set + parts);
  }
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    counts.parts[partOfCell[cell]].cells += takesPart(view, cell);
  }
  countMessages(findCopies(view, partOfCell, owners), owners, sets, counts.parts);
  return counts;
}
}
