// SPDX-License-Identifier: BSD-3-Clause
#include "BernsteinSearch.h"

#include <algorithm>
#include <numeric>

namespace tautline
{
namespace
{
/// Rows of at least this many coefficients are halved as they lie in memory.
constexpr int WideRow = 4;
/// Coefficients of a line: of the square of the normal of a quadrilateral of the largest order.
constexpr int MaxLine = 24;
/// Bisections of a box after which its bends are measured again.
constexpr int MaxAge = 4;
constexpr double smallestTolerance = 1e-12;
}

//------------------------------------------------------------------------------
BernsteinSearch::BernsteinSearch(const BernsteinSpace& space,
  const std::vector<BernsteinBisection>& bisections, const std::vector<BernsteinCorner>& corners)
  : Space(space)
  , Corners(corners)
  , Size(space.size())
{
  int first = 0;
  for (const BernsteinFactor& factor : space.factors())
  {
    this->FirstVertex.push_back(first);
    for (int vertex = 1; vertex <= factor.dimension; ++vertex)
    {
      this->Vertices[first + vertex * factor.dimension + vertex - 1] = 1;
    }
    first += (factor.dimension + 1) * factor.dimension;
  }
  for (const BernsteinBisection& lines : bisections)
  {
    if (lines.longest > MaxLine)
    {
      throw Error("The degree of a polynomial is too high; use elements of lower order.");
    }
    Direction& direction = this->Directions.emplace_back();
    direction.lines = &lines;
    direction.position = static_cast<int>(this->Directions.size()) - 1;
    direction.vertices = this->FirstVertex[lines.factor];
    direction.dimension = space.factors()[lines.factor].dimension;
    if (lines.width < WideRow)
    {
      this->addGroups(direction);
    }
  }
}

//------------------------------------------------------------------------------
void BernsteinSearch::addGroups(Direction& direction)
{
  const BernsteinBisection& lines = *direction.lines;
  const int count = (static_cast<int>(lines.begins.size()) - 1) * lines.width;
  const auto length = [&](int n)
  { return lines.begins[n / lines.width + 1] - lines.begins[n / lines.width]; };
  for (int begin = 0; begin < count; begin += Lanes)
  {
    Group group;
    group.length = length(begin);
    const int lanes = std::min(Lanes, count - begin);
    const auto line = [&](int lane) { return begin + std::min(lane, lanes - 1); };
    // Beyond the end of a line its last coefficient is repeated; what is made of it is not stored.
    const auto entry = [&](int lane, int row)
    {
      const int n = line(lane);
      return lines.entries[lines.begins[n / lines.width] + std::clamp(row, 0, length(n) - 1)] +
        n % lines.width;
    };
    for (bool mirrored : { false, true })
    {
      (mirrored ? group.mirrored : group.entries) = this->Entries.size();
      for (int row = 0; row < group.length; ++row)
      {
        for (int lane = 0; lane < Lanes; ++lane)
        {
          this->Entries.push_back(entry(lane, mirrored ? length(line(lane)) - 1 - row : row));
        }
      }
    }
    group.counts = this->Entries.size();
    for (int row = 0; row < group.length; ++row)
    {
      int reached = 0;
      while (reached < lanes && length(line(reached)) > row)
      {
        ++reached;
      }
      this->Entries.push_back(reached);
    }
    for (int lane = 0; lane < Lanes; ++lane)
    {
      group.last[lane] = length(line(lane)) - 1;
    }
    direction.groups.push_back(group);
  }
}

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
  root.vertices = this->Vertices;
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
Vec3 BernsteinSearch::place(const Box& box, const BernsteinCorner& corner) const
{
  Vec3 at = { 0, 0, 0 };
  for (std::size_t f = 0; f < this->Space.factors().size(); ++f)
  {
    const int dimension = this->Space.factors()[f].dimension;
    const double* vertex =
      box.vertices.data() + this->FirstVertex[f] + corner.vertex[f] * dimension;
    std::copy_n(vertex, dimension, at.data() + this->Space.firstCoordinate(static_cast<int>(f)));
  }
  return at;
}

//------------------------------------------------------------------------------
double BernsteinSearch::bend(const Direction& direction, const double* c) const
{
  double most = 0;
  if (direction.groups.empty())
  {
    const BernsteinBisection& lines = *direction.lines;
    const int width = lines.width;
    for (std::size_t l = 0; l + 1 < lines.begins.size(); ++l)
    {
      for (int e = lines.begins[l] + 2; e < lines.begins[l + 1]; ++e)
      {
        const double *low = c + lines.entries[e - 2], *middle = c + lines.entries[e - 1];
        const double* high = c + lines.entries[e];
#pragma omp simd reduction(max : most)
        for (int k = 0; k < width; ++k)
        {
          most = std::max(most, std::abs(low[k] - 2 * middle[k] + high[k]));
        }
      }
    }
    return most;
  }
  for (const Group& group : direction.groups)
  {
    const int* entries = this->Entries.data() + group.entries;
    const int* counts = this->Entries.data() + group.counts;
    for (int row = 2; row < group.length; ++row)
    {
      const int *low = entries + (row - 2) * Lanes, *middle = low + Lanes, *high = middle + Lanes;
      for (int lane = 0; lane < counts[row]; ++lane)
      {
        most = std::max(most, std::abs(c[low[lane]] - 2 * c[middle[lane]] + c[high[lane]]));
      }
    }
  }
  return most;
}

//------------------------------------------------------------------------------
void BernsteinSearch::measureBends(Box& box)
{
  const double* c = this->at(box);
  for (const Direction& direction : this->Directions)
  {
    box.bends[direction.position] = this->bend(direction, c);
  }
  box.age = 0;
}

//------------------------------------------------------------------------------
void BernsteinSearch::estimateBends(Box& box, const Direction& halved, int kept, int moved) const
{
  // The vertex `moved` has gone to the middle M of its edge with `kept`: second differences along
  // the edge become a quarter. Along M C, C another vertex, they are about the mean of those from
  // both ends.
  const auto edge = [&](int a, int b) -> double&
  {
    const Direction* found = &halved;
    for (const Direction& d : this->Directions)
    {
      const BernsteinBisection& lines = *d.lines;
      const bool same = lines.factor == halved.lines->factor;
      found = same && lines.from == std::min(a, b) && lines.to == std::max(a, b) ? &d : found;
    }
    return box.bends[found->position];
  };
  for (int other = 0; other <= halved.dimension && halved.dimension > 1; ++other)
  {
    if (other != kept && other != moved)
    {
      double& bend = edge(moved, other);
      bend = 0.5 * (bend + edge(kept, other));
    }
  }
  box.bends[halved.position] *= 0.25;
  ++box.age;
}

//------------------------------------------------------------------------------
void BernsteinSearch::halveRows(const BernsteinBisection& lines, double* c, double* other)
{
  const int width = lines.width;
  for (std::size_t l = 0; l + 1 < lines.begins.size(); ++l)
  {
    const int* entries = lines.entries.data() + lines.begins[l];
    const int last = lines.begins[l + 1] - lines.begins[l] - 1;
    std::copy_n(c + entries[last], width, other + entries[last]);
    for (int level = 1; level <= last; ++level)
    {
      for (int i = last; i >= level; --i)
      {
        double* row = c + entries[i];
        const double* before = c + entries[i - 1];
#pragma omp simd
        for (int k = 0; k < width; ++k)
        {
          row[k] = 0.5 * (row[k] + before[k]);
        }
      }
      std::copy_n(c + entries[last], width, other + entries[last - level]);
    }
  }
}

//------------------------------------------------------------------------------
void BernsteinSearch::halveGroup(const Group& group, double* c, double* other) const
{
  double rows[MaxLine][Lanes];
  const int* entries = this->Entries.data() + group.entries;
  const int* mirrored = this->Entries.data() + group.mirrored;
  const int* counts = this->Entries.data() + group.counts;
  for (int row = 0; row < group.length; ++row)
  {
#pragma omp simd
    for (int lane = 0; lane < Lanes; ++lane)
    {
      rows[row][lane] = c[entries[row * Lanes + lane]];
    }
  }
  for (int level = 0; level < group.length; ++level)
  {
    for (int row = group.length - 1; row >= level && level > 0; --row)
    {
#pragma omp simd
      for (int lane = 0; lane < Lanes; ++lane)
      {
        rows[row][lane] = 0.5 * (rows[row][lane] + rows[row - 1][lane]);
      }
    }
    for (int lane = 0; lane < counts[level]; ++lane)
    {
      c[entries[level * Lanes + lane]] = rows[level][lane];
      other[mirrored[level * Lanes + lane]] = rows[group.last[lane]][lane];
    }
  }
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
  const auto bends = box.bends.begin();
  const Direction& direction =
    this->Directions[std::max_element(bends, bends + this->Directions.size()) - bends];
  if (direction.groups.empty())
  {
    halveRows(*direction.lines, c, d);
  }
  for (const Group& group : direction.groups)
  {
    this->halveGroup(group, c, d);
  }
  const int from = direction.lines->from, to = direction.lines->to;
  for (int k = 0; k < direction.dimension; ++k)
  {
    double& a = other.vertices[direction.vertices + from * direction.dimension + k];
    double& b = box.vertices[direction.vertices + to * direction.dimension + k];
    a = b = 0.5 * (a + b);
  }
  this->estimateBends(box, direction, from, to);
  this->estimateBends(other, direction, to, from);
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
  const auto open = [&](const Box& box)
  { return verdict == BernsteinSign::Positive ? box.least <= noise : box.least < -noise; };
  const Box root = this->begin(coefficients);
  if (negativeAtCorner(root))
  {
    return BernsteinSign::Negative;
  }
  this->push(root);
  while (!this->Heap.empty() && open(this->Heap.front())) // else no other one is open
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
        result.at = this->place(box, corner);
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
