// SPDX-License-Identifier: BSD-3-Clause
#include "Ranks.h"

#include "BoundaryPoints.h"
#include "MeshElements.h"
#include "tautline/Core/Memory.h"

#include <algorithm>
#include <new>
#include <numeric>

namespace tautline
{
//------------------------------------------------------------------------------
void Ranks::sum(double* values, Index count) const
{
  if (!this->Spread)
  {
    return;
  }
  const auto all = this->Spread->group().gatherItems(std::vector<double>(values, values + count));
  std::fill_n(values, count, 0.0);
  // Sum in the order of the ranks, so that the result is the same on all.
  for (const std::vector<double>& one : all)
  {
    std::transform(one.begin(), one.end(), values, values, std::plus<>());
  }
}

//------------------------------------------------------------------------------
double Ranks::total(const std::vector<double>& values, double start) const
{
  return this->Spread ? start + this->Spread->group().orderlessSum(values)
                      : std::accumulate(values.begin(), values.end(), start);
}

//------------------------------------------------------------------------------
std::vector<unsigned char> Ranks::boundary(const Mesh& local) const
{
  if (this->Spread)
  {
    return rankBoundary(*this->Spread);
  }
  const std::vector<char> boundary = boundaryPoints(local);
  return { boundary.begin(), boundary.end() };
}

std::vector<unsigned char> rankBoundary(const DistributedMesh& mesh)
{
  std::vector<unsigned char> flags(mesh.localPoints(), 0);
  if (mesh.view().numberOfCells > 0)
  {
    const std::vector<char> boundary = boundaryPoints(Mesh(mesh.view()));
    std::copy(boundary.begin(), boundary.end(), flags.begin());
  }
  mesh.exchange(flags.data());
  return flags;
}

//------------------------------------------------------------------------------
Index Ranks::countInvalid(const Mesh& local, const std::vector<signed char>& validity) const
{
  Index count = 0;
  for (const CellBlock& block : local.blocks())
  {
    for (Index i = 0; isElement(local, block.type) && i < block.count; ++i)
    {
      const Index cell = block.cell(i);
      count += this->ownsCell(cell) && isInvalid(validity[cell]);
    }
  }
  return this->sum(count);
}

//------------------------------------------------------------------------------
MeshSpace Ranks::space(const Mesh& local) const
{
  MeshSpace space = local.space();
  if (this->Spread)
  {
    for (const MeshSpace& other :
      this->Spread->group().gatherJoined(std::vector<MeshSpace>{ local.space() }))
    {
      space = space.dimension == Dimension::None ? other : space;
    }
  }
  return space;
}

//------------------------------------------------------------------------------
Dimension Ranks::dimension(const Mesh& local) const
{
  return this->Spread
    ? static_cast<Dimension>(this->Spread->group().maximum(static_cast<Index>(local.dimension())))
    : local.dimension();
}

//------------------------------------------------------------------------------
void Ranks::together(const std::function<void()>& work) const
{
  if (this->Spread)
  {
    this->Spread->group().together(work);
  }
  else
  {
    work();
  }
}

//------------------------------------------------------------------------------
void Ranks::inMemory(const std::function<void()>& work, const char* message) const
{
  if (!this->Spread)
  {
    work();
    return;
  }
  // Catch a failed allocation here, so that all ranks throw together.
  bool fits = true;
  try
  {
    work();
  }
  catch (const std::bad_alloc&)
  {
    fits = false;
  }
  catch (const MemoryError&)
  {
    fits = false;
  }
  if (this->any(!fits))
  {
    throw MemoryError(message);
  }
}

//------------------------------------------------------------------------------
void Ranks::exchange(double* values, int components) const
{
  if (this->Spread)
  {
    this->Spread->exchange(values, components);
  }
}

void Ranks::exchange(unsigned char* flags) const
{
  if (this->Spread)
  {
    this->Spread->exchange(flags);
  }
}

//------------------------------------------------------------------------------
void Ranks::either(unsigned char* flags) const
{
  if (this->Spread)
  {
    this->Spread->either(flags);
  }
}

//------------------------------------------------------------------------------
std::vector<Index> Ranks::numberSets(
  UnionFind& sets, const std::vector<unsigned char>& member, Index& count) const
{
  const auto n = static_cast<Index>(member.size());
  std::vector<Index> numbers(member.size(), -1);
  if (!this->Spread)
  {
    count = 0;
    for (Index i = 0; i < n; ++i)
    {
      const Index root = member[i] ? sets.find(i) : -1;
      numbers[i] = root == i ? count++ : root < 0 ? -1 : numbers[root];
    }
    return numbers;
  }
  const DistributedMesh& mesh = *this->Spread;
  // Propagate the smallest point number over the parts of each set, from rank to rank.
  std::vector<double> least(member.size(), 0.0), values(member.size());
  for (Index i = 0; i < n; ++i)
  {
    least[i] = static_cast<double>(mesh.numbers()[i]);
  }
  for (bool changed = true; changed;)
  {
    changed = false;
    for (Index i = 0; i < n; ++i)
    {
      values[i] = least[sets.find(i)];
    }
    mesh.exchange(values.data(), 1);
    for (Index i = 0; i < n; ++i)
    {
      double& root = least[sets.find(i)];
      changed = changed || values[i] < root;
      root = std::min(root, values[i]);
    }
    changed = mesh.group().any(changed);
  }
  // The distinct smallest numbers, in increasing order, are the numbers of the sets on all ranks.
  std::vector<double> own;
  for (Index i = 0; i < n; ++i)
  {
    if (member[i] && mesh.owned(i))
    {
      own.push_back(least[sets.find(i)]);
    }
  }
  const auto simplify = [](std::vector<double>& list)
  {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  };
  simplify(own);
  std::vector<double> all = mesh.group().gatherJoined(own);
  simplify(all);
  count = static_cast<Index>(all.size());
  for (Index i = 0; i < n; ++i)
  {
    const auto at = std::lower_bound(all.begin(), all.end(), least[sets.find(i)]);
    numbers[i] = member[i] ? static_cast<Index>(at - all.begin()) : -1;
  }
  return numbers;
}
}
