// SPDX-License-Identifier: BSD-3-Clause
#include "BernsteinHalving.h"

#include <algorithm>

namespace tautline
{
namespace
{
/// Rows of at least this many coefficients are halved without gathering them.
constexpr int WideRow = 4;
/// Coefficients of a line: for the squared adjugate of a solid of the largest order.
constexpr int MaxLine = 4 * MaxElementOrder + 1;
}

//------------------------------------------------------------------------------
BernsteinHalving::BernsteinHalving(
  const BernsteinSpace& space, const std::vector<BernsteinBisection>& bisections)
  : Space(space)
{
  int first = 0;
  for (const BernsteinFactor& factor : space.factors())
  {
    this->FirstVertex.push_back(first);
    // Vertex 0 of a factor is the origin; vertex k is the unit point of axis k.
    for (int vertex = 1; vertex <= factor.dimension; ++vertex)
    {
      this->Domain[first + vertex * factor.dimension + vertex - 1] = 1;
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
    direction.vertices = this->FirstVertex[lines.factor];
    direction.dimension = space.factors()[lines.factor].dimension;
    if (lines.width < WideRow)
    {
      this->addGroups(direction);
    }
  }
}

//------------------------------------------------------------------------------
int BernsteinHalving::degree(int direction) const
{
  return this->Directions[direction].lines->longest - 1;
}

//------------------------------------------------------------------------------
void BernsteinHalving::addGroups(Direction& direction)
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
    // Unused lanes repeat the last line.
    const auto line = [&](int lane) { return begin + std::min(lane, lanes - 1); };
    // Beyond the end of a line, its last coefficient is repeated; the results there are not stored.
    const auto entry = [&](int lane, int row)
    {
      const int n = line(lane);
      return lines.entries[lines.begins[n / lines.width] + std::clamp(row, 0, length(n) - 1)] +
        n % lines.width;
    };
    // The coefficients of the other half are found from its end, so that they are stored in
    // reverse.
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
    // Per row, the number of lanes whose lines reach it: lines are sorted by decreasing length.
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
Vec3 BernsteinHalving::place(const Vertices& vertices, const BernsteinCorner& corner) const
{
  Vec3 at = { 0, 0, 0 };
  for (std::size_t f = 0; f < this->Space.factors().size(); ++f)
  {
    const int dimension = this->Space.factors()[f].dimension;
    const double* vertex = vertices.data() + this->FirstVertex[f] + corner.vertex[f] * dimension;
    std::copy_n(vertex, dimension, at.data() + this->Space.firstCoordinate(static_cast<int>(f)));
  }
  return at;
}

//------------------------------------------------------------------------------
/// @param difference a function of the coefficients at up to three consecutive positions of a line;
///   it spans Reach of them
template <int Reach, class Difference>
double BernsteinHalving::largest(
  const Direction& direction, const double* c, const Difference& difference) const
{
  double most = 0;
  if (direction.groups.empty())
  {
    const BernsteinBisection& lines = *direction.lines;
    const int width = lines.width;
    for (std::size_t l = 0; l + 1 < lines.begins.size(); ++l)
    {
      for (int e = lines.begins[l] + Reach; e < lines.begins[l + 1]; ++e)
      {
        const double *low = c + lines.entries[e - Reach], *middle = c + lines.entries[e - 1];
        const double* high = c + lines.entries[e];
#pragma omp simd reduction(max : most)
        for (int k = 0; k < width; ++k)
        {
          most = std::max(most, std::abs(difference(low[k], middle[k], high[k])));
        }
      }
    }
    return most;
  }
  for (const Group& group : direction.groups)
  {
    const int* entries = this->Entries.data() + group.entries;
    const int* counts = this->Entries.data() + group.counts;
    for (int row = Reach; row < group.length; ++row)
    {
      const int *high = entries + row * Lanes, *middle = high - Lanes, *low = high - Reach * Lanes;
      for (int lane = 0; lane < counts[row]; ++lane)
      {
        const double d = difference(c[low[lane]], c[middle[lane]], c[high[lane]]);
        most = std::max(most, std::abs(d));
      }
    }
  }
  return most;
}

//------------------------------------------------------------------------------
double BernsteinHalving::bend(int direction, const double* c) const
{
  return this->largest<2>(this->Directions[direction], c,
    [](double low, double middle, double high) { return low - 2 * middle + high; });
}

//------------------------------------------------------------------------------
double BernsteinHalving::slope(int direction, const double* c) const
{
  return this->largest<1>(
    this->Directions[direction], c, [](double low, double, double high) { return high - low; });
}

//------------------------------------------------------------------------------
void BernsteinHalving::estimate(int direction, Measures& kept, Measures& other) const
{
  const Direction& halved = this->Directions[direction];
  other = kept;
  this->estimateOne(halved, kept, halved.lines->from, halved.lines->to);
  this->estimateOne(halved, other, halved.lines->to, halved.lines->from);
}

//------------------------------------------------------------------------------
void BernsteinHalving::estimateOne(
  const Direction& halved, Measures& measures, int kept, int moved) const
{
  // The vertex `moved` is now at the middle M of its edge with `kept`: second differences along the
  // edge become a quarter. Along M C, with another vertex C, they are about the mean of the values
  // from both ends.
  const auto edge = [&](int a, int b) -> double&
  {
    const Direction* found = &halved;
    for (const Direction& d : this->Directions)
    {
      const BernsteinBisection& lines = *d.lines;
      const bool same = lines.factor == halved.lines->factor;
      found = same && lines.from == std::min(a, b) && lines.to == std::max(a, b) ? &d : found;
    }
    return measures[found - this->Directions.data()];
  };
  for (int other = 0; other <= halved.dimension && halved.dimension > 1; ++other)
  {
    if (other != kept && other != moved)
    {
      double& measure = edge(moved, other);
      measure = 0.5 * (measure + edge(kept, other));
    }
  }
  measures[&halved - this->Directions.data()] *= 0.25;
}

//------------------------------------------------------------------------------
void BernsteinHalving::halveRows(const BernsteinBisection& lines, double* c, double* other)
{
  const int width = lines.width;
  for (std::size_t l = 0; l + 1 < lines.begins.size(); ++l)
  {
    const int* entries = lines.entries.data() + lines.begins[l];
    const int last = lines.begins[l + 1] - lines.begins[l] - 1;
    // De Casteljau's algorithm at 1/2: the last entry of each level is a coefficient of the other
    // half.
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
void BernsteinHalving::halveGroup(const Group& group, double* c, double* other) const
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
void BernsteinHalving::halve(int direction, double* c, double* other) const
{
  const Direction& halved = this->Directions[direction];
  if (halved.groups.empty())
  {
    halveRows(*halved.lines, c, other);
  }
  for (const Group& group : halved.groups)
  {
    this->halveGroup(group, c, other);
  }
}

//------------------------------------------------------------------------------
void BernsteinHalving::halve(int direction, Vertices& kept, Vertices& other) const
{
  const Direction& halved = this->Directions[direction];
  other = kept;
  for (int k = 0; k < halved.dimension; ++k)
  {
    // Both halves get the middle of the edge as a vertex.
    double& a = other[halved.vertices + halved.lines->from * halved.dimension + k];
    double& b = kept[halved.vertices + halved.lines->to * halved.dimension + k];
    a = b = 0.5 * (a + b);
  }
}
}
