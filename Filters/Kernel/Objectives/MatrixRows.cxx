// SPDX-License-Identifier: BSD-3-Clause
#include "MatrixRows.h"

#include <algorithm>
#include <limits>

namespace tautline
{
//------------------------------------------------------------------------------
MatrixRows::MatrixRows(const DistributedMesh& mesh, std::vector<unsigned char> free)
  : TheMesh(mesh)
  , RowOfPoint(mesh.localPoints(), -1)
{
  mesh.exchange(free.data());
  for (Index p = 0; p < mesh.localPoints(); ++p)
  {
    if (!free[p])
    {
      continue;
    }
    const auto row = static_cast<std::int32_t>(this->Points.size());
    this->RowOfPoint[p] = row;
    this->Points.push_back(static_cast<std::int32_t>(p));
    if (mesh.owned(p))
    {
      this->Owned.push_back(row);
    }
  }
  this->Rows = static_cast<Index>(this->Points.size());
  this->Halo = mesh.subset(free);
  for (auto& neighbour : this->Halo.neighbours)
  {
    for (std::vector<std::int32_t>* list : { &neighbour.sent, &neighbour.received })
    {
      for (std::int32_t& p : *list)
      {
        p = this->RowOfPoint[p];
      }
    }
  }
}

//------------------------------------------------------------------------------
void MatrixRows::place(const double* own, double* all, int components) const
{
  for (std::size_t i = 0; i < this->Owned.size(); ++i)
  {
    std::copy_n(own + components * i, components,
      all + static_cast<std::size_t>(components) * this->Owned[i]);
  }
}

void MatrixRows::pick(const double* all, double* own, int components) const
{
  for (std::size_t i = 0; i < this->Owned.size(); ++i)
  {
    std::copy_n(all + static_cast<std::size_t>(components) * this->Owned[i], components,
      own + components * i);
  }
}

void MatrixRows::spread(const double* own, double* all, int components) const
{
  this->place(own, all, components);
  this->TheMesh.exchange(this->Halo, all, components);
}

//------------------------------------------------------------------------------
std::vector<std::int32_t> MatrixRows::numbers() const
{
  std::vector<Index> own;
  for (const std::int32_t row : this->Owned)
  {
    own.push_back(this->TheMesh.numbers()[this->Points[row]]);
  }
  std::vector<Index> all;
  for (const auto& ofRank : this->group().gatherItems(own))
  {
    all.insert(all.end(), ofRank.begin(), ofRank.end());
  }
  if (static_cast<Index>(all.size()) > std::numeric_limits<std::int32_t>::max())
  {
    throw Error("The mesh has too many points for Newton's method: choose Local Newton or L-BFGS.");
  }
  std::sort(all.begin(), all.end());
  std::vector<std::int32_t> numbers(this->Rows);
  for (Index row = 0; row < this->Rows; ++row)
  {
    const Index number = this->TheMesh.numbers()[this->Points[row]];
    numbers[row] =
      static_cast<std::int32_t>(std::lower_bound(all.begin(), all.end(), number) - all.begin());
  }
  return numbers;
}
}
