// SPDX-License-Identifier: BSD-3-Clause
#include "MatrixRows.h"

#include <algorithm>
#include <limits>

namespace tautline
{
//------------------------------------------------------------------------------
MatrixRows::MatrixRows(
  const std::vector<std::int32_t>& points, Index numberOfPoints, const Ranks& ranks)
  : TheRanks(ranks)
  , RowOfPoint(numberOfPoints, -1)
  , Points(points)
{
  std::vector<unsigned char> free(ranks.several() ? numberOfPoints : 0, 0);
  if (ranks.several())
  {
    for (const std::int32_t p : points)
    {
      free[p] = 1;
    }
    // Copies of a point follow its owner, so that all ranks agree which points are free.
    ranks.exchange(free.data());
    this->Points.clear();
    for (Index p = 0; p < numberOfPoints; ++p)
    {
      if (free[p] && ranks.owns(p))
      {
        this->Owned.push_back(static_cast<std::int32_t>(this->Points.size()));
      }
      if (free[p])
      {
        this->Points.push_back(static_cast<std::int32_t>(p));
      }
    }
  }
  for (std::size_t row = 0; row < this->Points.size(); ++row)
  {
    this->RowOfPoint[this->Points[row]] = static_cast<std::int32_t>(row);
  }
  if (ranks.several())
  {
    this->Halo = ranks.mesh().subset(free);
  }
  // The lists contain points until here; with rows, vectors of the matrix can be exchanged
  // directly.
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
const double* MatrixRows::place(const double* own, std::vector<double>& all, int components) const
{
  if (!this->TheRanks.several())
  {
    return own;
  }
  all.resize(static_cast<std::size_t>(components * this->rows()));
  for (std::size_t i = 0; i < this->Owned.size(); ++i)
  {
    std::copy_n(own + components * i, components,
      all.begin() + static_cast<std::ptrdiff_t>(components) * this->Owned[i]);
  }
  return all.data();
}

double* MatrixRows::target(double* own, std::vector<double>& all, int components) const
{
  if (!this->TheRanks.several())
  {
    return own;
  }
  all.resize(static_cast<std::size_t>(components * this->rows()));
  return all.data();
}

void MatrixRows::pick(const std::vector<double>& all, double* own, int components) const
{
  for (std::size_t i = 0; i < this->Owned.size(); ++i)
  {
    std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(components) * this->Owned[i], components,
      own + components * i);
  }
}

const double* MatrixRows::spread(const double* own, std::vector<double>& all, int components) const
{
  const double* values = this->place(own, all, components);
  if (this->TheRanks.several())
  {
    this->TheRanks.mesh().exchange(this->Halo, all.data(), components);
  }
  return values;
}

//------------------------------------------------------------------------------
std::vector<std::int32_t> MatrixRows::numbers() const
{
  std::vector<Index> own;
  for (const std::int32_t row : this->Owned)
  {
    own.push_back(this->TheRanks.mesh().numbers()[this->Points[row]]);
  }
  std::vector<Index> all = this->group().gatherJoined(own);
  if (static_cast<Index>(all.size()) > std::numeric_limits<std::int32_t>::max())
  {
    throw Error("The mesh has too many points for Newton's method: choose Local Newton or L-BFGS.");
  }
  // Sorted global numbers of points define the numbers of the rows, independent of the
  // distribution.
  std::sort(all.begin(), all.end());
  std::vector<std::int32_t> numbers(this->rows());
  for (Index row = 0; row < this->rows(); ++row)
  {
    const Index number = this->TheRanks.mesh().numbers()[this->Points[row]];
    numbers[row] =
      static_cast<std::int32_t>(std::lower_bound(all.begin(), all.end(), number) - all.begin());
  }
  return numbers;
}
}
