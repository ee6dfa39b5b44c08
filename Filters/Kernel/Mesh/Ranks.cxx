// SPDX-License-Identifier: BSD-3-Clause
#include "WarpRanks.h"

#include <algorithm>

namespace tautline
{
//------------------------------------------------------------------------------
void WarpRanks::sum(double* values, Index count) const
{
  if (!this->Spread)
  {
    return;
  }
  const auto all = this->Spread->group().gatherItems(std::vector<double>(values, values + count));
  std::fill_n(values, count, 0.0);
  for (const std::vector<double>& one : all)
  {
    std::transform(one.begin(), one.end(), values, values, std::plus<>());
  }
}

//------------------------------------------------------------------------------
Dimension WarpRanks::dimension(const Mesh& local) const
{
  return this->Spread
    ? static_cast<Dimension>(this->Spread->group().maximum(static_cast<Index>(local.dimension())))
    : local.dimension();
}

//------------------------------------------------------------------------------
void WarpRanks::together(const std::function<void()>& work) const
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
void WarpRanks::exchange(double* values, int components) const
{
  if (this->Spread)
  {
    this->Spread->exchange(values, components);
  }
}

//------------------------------------------------------------------------------
void WarpRanks::either(unsigned char* flags) const
{
  if (this->Spread)
  {
    this->Spread->either(flags);
  }
}

//------------------------------------------------------------------------------
std::vector<Index> WarpRanks::numberSets(
  UnionFind& sets, const std::vector<unsigned char>& member, Index& count) const
{
  const auto n = static_cast<Index>(member.size());
  std::vector<Index> numbers(member.size(), -1);
  count = 0;
  if (!this->Spread)
  {
    for (Index i = 0; i < n; ++i)
    {
      const Index root = member[i] ? sets.find(i) : -1;
      numbers[i] = root == i ? count++ : root < 0 ? -1 : numbers[root];
    }
    return numbers;
  }
  return numberSetsOnRanks(*this->Spread, sets, member, count);
}

//------------------------------------------------------------------------------
std::vector<PrescribedPoint> WarpRanks::prescribedOfAll(const MeshView& local,
  const std::vector<unsigned char>& prescribed, const double* displacement) const
{
  std::vector<PrescribedPoint> own, all;
  for (Index i = 0; i < local.numberOfPoints; ++i)
  {
    if (prescribed[i] && this->owns(i))
    {
      own.push_back({ this->id(i), pointOf(local, i), {} });
      std::copy_n(displacement + 3 * i, 3, own.back().displacement.begin());
    }
  }
  for (const std::vector<PrescribedPoint>& list : this->Spread->group().gatherItems(own))
  {
    all.insert(all.end(), list.begin(), list.end());
  }
  std::sort(all.begin(), all.end(),
    [](const PrescribedPoint& a, const PrescribedPoint& b) { return a.id < b.id; });
  return all;
}
}
