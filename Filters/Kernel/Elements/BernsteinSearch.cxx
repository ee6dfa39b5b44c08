// SPDX-License-Identifier: BSD-3-Clause
#include "BernsteinSearch.h"

#include "BernsteinHalving.h"

#include <algorithm>
#include <numeric>

namespace tautline
{
namespace
{
/// The number of bisections of a box after which its bends are recomputed.
constexpr int MaxAge = 4;
constexpr double smallestTolerance = 1e-12;
}

//------------------------------------------------------------------------------
BernsteinSearch::BernsteinSearch(const BernsteinSpace& space,
  const std::vector<BernsteinBisection>& bisections, const std::vector<BernsteinCorner>& corners)
  : Halving(new BernsteinHalving(space, bisections))
  , Corners(corners)
  , Size(space.size())
{
}

//------------------------------------------------------------------------------
BernsteinSearch::~BernsteinSearch() = default;
BernsteinSearch::BernsteinSearch(BernsteinSearch&&) noexcept = default;

//------------------------------------------------------------------------------
BernsteinSearch::Box BernsteinSearch::begin(const double* coefficients)
{
  this->Heap.clear();
  this->Free.clear();
  this->Slots = 0;
  this->Splits = 0;
  this->Decided = true;
  Box root;
  root.slot = this->newSlot();
  root.vertices = this->Halving->domain();
  root.age = MaxAge;
  std::copy_n(coefficients, this->Size, this->at(root));
  root.least = this->smallest(this->at(root));
  return root;
}

//------------------------------------------------------------------------------
int BernsteinSearch::newSlot()
{
  if (!this->Free.empty())
  {
    const int slot = this->Free.back();
    this->Free.pop_back();
    return slot;
  }
  const std::size_t needed = (this->Slots + 1) * this->Size;
  if (this->Pool.size() < needed)
  {
    this->Pool.resize(2 * needed);
  }
  return this->Slots++;
}

//------------------------------------------------------------------------------
void BernsteinSearch::push(const Box& box)
{
  this->Heap.push_back(box);
  std::push_heap(this->Heap.begin(), this->Heap.end(),
    [](const Box& a, const Box& b) { return a.least > b.least; });
}

//------------------------------------------------------------------------------
BernsteinSearch::Box BernsteinSearch::pop()
{
  std::pop_heap(this->Heap.begin(), this->Heap.end(),
    [](const Box& a, const Box& b) { return a.least > b.least; });
  const Box box = this->Heap.back();
  this->Heap.pop_back();
  return box;
}

//------------------------------------------------------------------------------
double BernsteinSearch::smallest(const double* c) const
{
  double least = c[0];
#pragma omp simd reduction(min : least)
  for (std::size_t k = 0; k < this->Size; ++k)
  {
    least = std::min(least, c[k]);
  }
  return least;
}

//------------------------------------------------------------------------------
void BernsteinSearch::measureBends(Box& box)
{
  const double* c = this->at(box);
  for (int direction = 0; direction < this->Halving->directions(); ++direction)
  {
    box.bends[direction] = this->Halving->bend(direction, c);
  }
  box.age = 0;
}

//------------------------------------------------------------------------------
BernsteinSearch::Box BernsteinSearch::split(Box& box)
{
  ++this->Splits;
  if (box.age == MaxAge)
  {
    this->measureBends(box);
  }
  Box other = box;
  other.slot = this->newSlot(); // may move the pool
  double *c = this->at(box), *d = this->at(other);
  // Bisect in the direction in which the polynomial deviates most from linear.
  const auto bends = box.bends.begin();
  const int direction =
    static_cast<int>(std::max_element(bends, bends + this->Halving->directions()) - bends);
  this->Halving->halve(direction, c, d);
  this->Halving->halve(direction, box.vertices, other.vertices);
  this->Halving->estimate(direction, box.bends, other.bends);
  other.age = ++box.age;
  box.least = this->smallest(c);
  other.least = this->smallest(d);
  return other;
}

//------------------------------------------------------------------------------
BernsteinSign BernsteinSearch::sign(const double* coefficients, double noise)
{
  BernsteinSign verdict = BernsteinSign::Positive;
  const auto negativeAtCorner = [&](const Box& box)
  {
    const double* c = this->at(box);
    for (const BernsteinCorner& corner : this->Corners)
    {
      const double value = c[corner.coefficient];
      if (value < -noise)
      {
        return true;
      }
      verdict = value <= noise ? BernsteinSign::Zero : verdict;
    }
    return false;
  };
  // A box is open while its smallest coefficient, a lower bound, allows a worse verdict.
  const auto open = [&](const Box& box)
  { return verdict == BernsteinSign::Positive ? box.least <= noise : box.least < -noise; };
  const Box root = this->begin(coefficients);
  if (negativeAtCorner(root))
  {
    return BernsteinSign::Negative;
  }
  this->push(root);
  while (!this->Heap.empty() && open(this->Heap.front())) // otherwise no other box is open
  {
    if (this->Splits == MaxSplits)
    {
      this->Decided = false;
      return BernsteinSign::Zero;
    }
    Box box = this->pop();
    Box other = this->split(box);
    for (const Box* half : { &box, &other })
    {
      if (half->least > noise)
      {
        this->release(*half);
        continue;
      }
      if (negativeAtCorner(*half))
      {
        return BernsteinSign::Negative;
      }
      this->push(*half);
    }
  }
  return verdict;
}

//------------------------------------------------------------------------------
BernsteinMinimum BernsteinSearch::minimum(
  const double* coefficients, const MinimumTolerance& tolerance)
{
  BernsteinMinimum result;
  result.upper = std::numeric_limits<double>::infinity();
  const auto lookAtCorners = [&](const Box& box)
  {
    const double* c = this->at(box);
    for (const BernsteinCorner& corner : this->Corners)
    {
      if (c[corner.coefficient] < result.upper)
      {
        result.upper = c[corner.coefficient];
        result.at = this->Halving->place(box.vertices, corner);
      }
    }
  };
  const Box root = this->begin(coefficients);
  const double largest = std::accumulate(coefficients, coefficients + this->Size, 0.0,
    [](double most, double x) { return std::max(most, std::abs(x)); });
  const double gap = std::max(tolerance.relative, smallestTolerance) * largest;
  lookAtCorners(root);
  this->push(root);
  while (!this->Heap.empty() && this->Heap.front().least < result.upper - gap &&
    !(this->Heap.front().least > tolerance.level))
  {
    if (this->Splits == MaxSplits)
    {
      this->Decided = false;
      break;
    }
    Box box = this->pop();
    Box other = this->split(box);
    for (const Box* half : { &box, &other })
    {
      lookAtCorners(*half);
      if (half->least < result.upper)
      {
        this->push(*half);
      }
      else
      {
        this->release(*half);
      }
    }
  }
  result.lower = result.upper;
  if (!this->Heap.empty())
  {
    result.lower = std::min(result.upper, this->Heap.front().least);
  }
  return result;
}
}
