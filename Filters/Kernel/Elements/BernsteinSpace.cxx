// SPDX-License-Identifier: BSD-3-Clause
#include "BernsteinSpace.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace tautline
{
namespace
{
/// The multi-indices of a simplex, at most `degree` in sum, the first one fastest.
std::vector<BernsteinExponents> simplexExponents(const BernsteinFactor& factor)
{
  const int n = factor.degree;
  std::vector<BernsteinExponents> all;
  for (int c = 0; c <= (factor.dimension > 2 ? n : 0); ++c)
  {
    for (int b = 0; b <= (factor.dimension > 1 ? n - c : 0); ++b)
    {
      for (int a = 0; a <= n - c - b; ++a)
      {
        all.push_back({ a, b, c });
      }
    }
  }
  return all;
}

/// The number of multi-indices of a simplex.
int simplexSize(int dimension, int degree)
{
  int size = 1;
  for (int k = 1; k <= dimension; ++k)
  {
    size = size * (degree + k) / k;
  }
  return size;
}

double factorial(int n)
{
  double product = 1;
  for (int k = 2; k <= n; ++k)
  {
    product *= k;
  }
  return product;
}
}

//------------------------------------------------------------------------------
BernsteinSpace::BernsteinSpace(std::vector<BernsteinFactor> factors)
  : Factors(std::move(factors))
{
  this->Exponents = { { 0, 0, 0 } };
  this->Multinomials = { 1 };
  for (const BernsteinFactor& factor : this->Factors)
  {
    const int first = this->Dimension;
    this->First.push_back(first);
    this->Strides.push_back(this->size());
    this->Dimension += factor.dimension;
    if (this->Dimension > 3)
    {
      throw Error("A Bernstein space has at most three coordinates; use fewer factors.");
    }
    std::vector<BernsteinExponents> exponents;
    std::vector<double> multinomials;
    for (const BernsteinExponents& own : simplexExponents(factor))
    {
      double multinomial =
        factorial(factor.degree) / factorial(factor.degree - own[0] - own[1] - own[2]);
      for (int e : own)
      {
        multinomial /= factorial(e);
      }
      for (int k = 0; k < this->size(); ++k)
      {
        BernsteinExponents all = this->Exponents[k];
        std::copy_n(own.begin(), factor.dimension, all.begin() + first);
        exponents.push_back(all);
        // Multinomials are integers: rounding removes the errors of the divisions.
        multinomials.push_back(std::round(this->Multinomials[k] * multinomial));
      }
    }
    this->Exponents = std::move(exponents);
    this->Multinomials = std::move(multinomials);
  }
}

//------------------------------------------------------------------------------
int BernsteinSpace::indexOf(const BernsteinExponents& exponents) const
{
  int index = 0;
  for (std::size_t f = 0; f < this->Factors.size(); ++f)
  {
    // Add the layers below the last exponent, the rows below the previous one, and the position in
    // the row, while the remaining degree decreases.
    int remaining = this->Factors[f].degree, own = 0;
    for (int k = this->Factors[f].dimension - 1; k >= 0; --k)
    {
      const int e = exponents[this->First[f] + k];
      own += simplexSize(k + 1, remaining) - simplexSize(k + 1, remaining - e);
      remaining -= e;
    }
    index += this->Strides[f] * own;
  }
  return index;
}

//------------------------------------------------------------------------------
int BernsteinSpace::vertexExponent(
  int factor, int vertex, const BernsteinExponents& exponents) const
{
  const auto begin = exponents.begin() + this->First[factor];
  const BernsteinFactor& f = this->Factors[factor];
  return vertex > 0 ? begin[vertex - 1] : f.degree - std::accumulate(begin, begin + f.dimension, 0);
}

//------------------------------------------------------------------------------
std::vector<long double> BernsteinSpace::valuesAt(const std::array<long double, 3>& at) const
{
  std::vector<long double> values(this->Exponents.size());
  for (int k = 0; k < this->size(); ++k)
  {
    long double value = this->Multinomials[k];
    for (std::size_t f = 0; f < this->Factors.size(); ++f)
    {
      long double origin = 1;
      for (int vertex = this->Factors[f].dimension; vertex >= 0; --vertex)
      {
        // The barycentric coordinate of the vertex; the origin comes last, when the others have
        // been subtracted.
        const long double coordinate = vertex > 0 ? at[this->First[f] + vertex - 1] : origin;
        origin -= vertex > 0 ? coordinate : 0;
        const int exponent = this->vertexExponent(static_cast<int>(f), vertex, this->Exponents[k]);
        for (int e = 0; e < exponent; ++e)
        {
          value *= coordinate;
        }
      }
    }
    values[k] = value;
  }
  return values;
}

//------------------------------------------------------------------------------
BernsteinSpace BernsteinSpace::times(const BernsteinSpace& other) const
{
  std::vector<BernsteinFactor> factors = this->Factors;
  for (std::size_t f = 0; f < factors.size(); ++f)
  {
    factors[f].degree += other.Factors[f].degree;
  }
  return BernsteinSpace(factors);
}

//------------------------------------------------------------------------------
BernsteinProduct::BernsteinProduct(
  const BernsteinSpace& first, const BernsteinSpace& second, const BernsteinSpace& product)
  : Second(second.size())
{
  if (product.size() > std::numeric_limits<std::uint16_t>::max())
  {
    throw Error("The polynomials have too many coefficients; use a lower order.");
  }
  std::vector<int> terms(product.size());
  for (int i = 0; i < first.size(); ++i)
  {
    for (int j = 0; j < second.size(); ++j)
    {
      BernsteinExponents sum = first.exponents(i);
      for (std::size_t c = 0; c < sum.size(); ++c)
      {
        sum[c] += second.exponents(j)[c];
      }
      const int target = product.indexOf(sum);
      this->Targets.push_back(static_cast<std::uint16_t>(target));
      this->Terms = std::max(this->Terms, ++terms[target]);
    }
  }
}

namespace
{
/// The lines of one edge of a factor.
BernsteinBisection bisection(const BernsteinSpace& space, int factor, int from, int to)
{
  BernsteinBisection result;
  result.factor = factor;
  result.from = from;
  result.to = to;
  result.width = space.stride(factor);
  const int first = space.firstCoordinate(factor);
  std::vector<std::vector<int>> lines;
  // The other lines of the same width follow from the first one.
  for (int k = 0; k < space.size(); k += result.width)
  {
    BernsteinExponents e = space.exponents(k);
    if (space.vertexExponent(factor, to, e) == 0)
    {
      std::vector<int>& line = lines.emplace_back();
      for (int left = space.vertexExponent(factor, from, e); left >= 0; --left)
      {
        line.push_back(space.indexOf(e));
        e[first + std::max(from, 1) - 1] -= from > 0;
        e[first + to - 1] += 1;
      }
    }
  }
  std::stable_sort(lines.begin(), lines.end(),
    [](const std::vector<int>& a, const std::vector<int>& b) { return a.size() > b.size(); });
  result.begins.push_back(0);
  for (const std::vector<int>& line : lines)
  {
    result.entries.insert(result.entries.end(), line.begin(), line.end());
    result.begins.push_back(static_cast<int>(result.entries.size()));
  }
  result.longest = result.begins[1];
  return result;
}
}

//------------------------------------------------------------------------------
std::vector<BernsteinBisection> bisections(const BernsteinSpace& space)
{
  std::vector<BernsteinBisection> all;
  for (std::size_t f = 0; f < space.factors().size(); ++f)
  {
    const BernsteinFactor& factor = space.factors()[f];
    for (int to = 1; to <= factor.dimension && factor.degree > 0; ++to)
    {
      for (int from = 0; from < to; ++from)
      {
        all.push_back(bisection(space, static_cast<int>(f), from, to));
      }
    }
  }
  return all;
}

//------------------------------------------------------------------------------
std::vector<BernsteinCorner> corners(const BernsteinSpace& space)
{
  std::vector<BernsteinCorner> all = { BernsteinCorner() };
  std::vector<BernsteinExponents> exponents = { { 0, 0, 0 } };
  for (std::size_t f = 0; f < space.factors().size(); ++f)
  {
    const BernsteinFactor& factor = space.factors()[f];
    std::vector<BernsteinCorner> extended;
    std::vector<BernsteinExponents> extendedExponents;
    for (int vertex = 0; vertex <= factor.dimension; ++vertex)
    {
      for (std::size_t c = 0; c < all.size(); ++c)
      {
        BernsteinExponents e = exponents[c];
        if (vertex > 0)
        {
          e[space.firstCoordinate(static_cast<int>(f)) + vertex - 1] = factor.degree;
        }
        extendedExponents.push_back(e);
        extended.push_back(all[c]);
        extended.back().vertex[f] = vertex;
      }
    }
    all = std::move(extended);
    exponents = std::move(extendedExponents);
  }
  for (std::size_t c = 0; c < all.size(); ++c)
  {
    all[c].coefficient = space.indexOf(exponents[c]);
  }
  return all;
}
}
