// SPDX-License-Identifier: BSD-3-Clause
#include "BernsteinQuotient.h"

#include <algorithm>
#include <limits>

namespace tautline
{
namespace
{
/// The number of bisections of a box after which its measures are recomputed.
constexpr int RefreshAge = 4;
/// A denominator that is not positive is replaced by this.
constexpr double tiny = 1e-300;

double meanOf(const double* c, std::size_t size)
{
  double sum = 0;
#pragma omp simd reduction(+ : sum)
  for (std::size_t k = 0; k < size; ++k)
  {
    sum += c[k];
  }
  return std::max(sum / static_cast<double>(size), tiny);
}

/// The power of a number, with its sign.
double raise(double x, double power)
{
  return power == 1 ? x : std::copysign(std::pow(std::abs(x), power), x);
}

/// (x / 3)^(3/2)
double threeHalves(double x)
{
  const double y = std::max(x, 0.0) / 3;
  return y * std::sqrt(y);
}
}

//------------------------------------------------------------------------------
int polynomialsOf(QuotientDenominator denominator)
{
  return denominator == QuotientDenominator::RootOfThree ? 3
    : denominator == QuotientDenominator::RootOfTwo      ? 2
                                                         : 1;
}

//------------------------------------------------------------------------------
BernsteinQuotient::BernsteinQuotient(QuotientDenominator denominator, const BernsteinSpace& space,
  const std::vector<BernsteinBisection>& bisections, const std::vector<BernsteinCorner>& corners)
  : Denominator(denominator)
  , Halving(space, bisections)
  , Corners(corners)
  , Count(1 + polynomialsOf(denominator))
  , Size(space.size())
  , Pool(this->Count * this->Size)
  , Sum(this->Size)
  , Below(this->Size)
{
}

//------------------------------------------------------------------------------
int BernsteinQuotient::newSlot()
{
  if (!this->Free.empty())
  {
    const int slot = this->Free.back();
    this->Free.pop_back();
    return slot;
  }
  const std::size_t needed = (this->Slots + 1) * this->Count * this->Size;
  if (this->Pool.size() < needed)
  {
    this->Pool.resize(2 * needed);
  }
  return this->Slots++;
}

//------------------------------------------------------------------------------
void BernsteinQuotient::push(const Box& box)
{
  this->Heap.push_back(box);
  std::push_heap(this->Heap.begin(), this->Heap.end(),
    [](const Box& a, const Box& b) { return a.least > b.least; });
}

//------------------------------------------------------------------------------
void BernsteinQuotient::addSecant(const double* sum)
{
  // The secant a x + c of (x / 3)^(3/2) between the ends of the range.
  double low = sum[0], high = sum[0];
#pragma omp simd reduction(min : low) reduction(max : high)
  for (std::size_t k = 0; k < this->Size; ++k)
  {
    low = std::min(low, sum[k]);
    high = std::max(high, sum[k]);
  }
  low = std::max(low, 0.0);
  high = std::max(high, low);
  const double start = threeHalves(low), width = high - low;
  // For a narrow range, use the tangent at the upper end, which is steeper.
  const double a =
    width > 1e-9 * high ? (threeHalves(high) - start) / width : 0.5 * std::sqrt(high / 3);
  const double c = std::max(start - a * low, threeHalves(high) - a * high);
#pragma omp simd
  for (std::size_t k = 0; k < this->Size; ++k)
  {
    this->Below[k] = a * sum[k] + c;
  }
}

//------------------------------------------------------------------------------
void BernsteinQuotient::bound(Box& box)
{
  const double *d = this->at(box), *f = this->at(box, 1);
  double* below = this->Below.data();
  switch (this->Denominator)
  {
    case QuotientDenominator::Itself:
      std::copy_n(f, this->Size, below);
      break;
    case QuotientDenominator::ThreeHalves:
      this->addSecant(f);
      break;
    case QuotientDenominator::RootOfTwo:
    {
      const double* g = this->at(box, 2);
      // sqrt(f g) is at most (t f + g / t) / 2 for any t > 0, with equality where t f = g / t: t
      // fits the means.
      const double t = std::sqrt(meanOf(g, this->Size) / meanOf(f, this->Size));
      const double first = 0.5 * t, second = 0.5 / t;
#pragma omp simd
      for (std::size_t k = 0; k < this->Size; ++k)
      {
        below[k] = first * f[k] + second * g[k];
      }
      break;
    }
    case QuotientDenominator::RootOfThree:
    {
      const double *g = this->at(box, 2), *h = this->at(box, 3);
      const double p = meanOf(f, this->Size), q = meanOf(g, this->Size), r = meanOf(h, this->Size);
      // sqrt(f g h) is at most ((a f + b g + c h) / 3)^(3/2) for factors with a b c = 1, which are
      // fitted to the means.
      const double middle = std::cbrt(p) * std::cbrt(q) * std::cbrt(r);
      const double first = middle / p, second = middle / q, third = middle / r;
      double* sum = this->Sum.data();
#pragma omp simd
      for (std::size_t k = 0; k < this->Size; ++k)
      {
        sum[k] = first * f[k] + second * g[k] + third * h[k];
      }
      this->addSecant(sum);
      break;
    }
  }
  // With positive denominators, the smallest quotient of coefficients bounds the function from
  // below.
  double least = std::numeric_limits<double>::infinity();
#pragma omp simd reduction(min : least)
  for (std::size_t k = 0; k < this->Size; ++k)
  {
    least = std::min(least, d[k] / std::max(below[k], tiny));
  }
  box.least = std::max(least, 0.0);
}

//------------------------------------------------------------------------------
void BernsteinQuotient::measure(Box& box)
{
  // By direction, the gap of the bound: the distance of a coefficient of D - q E from the value
  // there, and the increase of the denominators, on which the bound of the root depends.
  this->bound(box);
  double* remainder = this->Sum.data();
  const double* d = this->at(box);
#pragma omp simd
  for (std::size_t k = 0; k < this->Size; ++k)
  {
    remainder[k] = d[k] - box.least * this->Below[k];
  }
  const double level = box.least * meanOf(this->Below.data(), this->Size);
  for (int direction = 0; direction < this->Halving.directions(); ++direction)
  {
    const double n = this->Halving.degree(direction);
    double rise = 0;
    for (std::size_t i = 1; i < this->Count && this->Denominator != QuotientDenominator::Itself;
         ++i)
    {
      const double* f = this->at(box, static_cast<int>(i));
      rise += n * this->Halving.slope(direction, f) / meanOf(f, this->Size);
    }
    // The factor 1/8 comes from the second derivative at the middle of a line; 1/10 from (x /
    // 3)^(3/2).
    box.measures[direction] =
      0.125 * (n - 1) * this->Halving.bend(direction, remainder) + 0.1 * level * rise * rise;
  }
  box.age = 0;
}

//------------------------------------------------------------------------------
BernsteinQuotient::Box BernsteinQuotient::split(Box& box)
{
  ++this->Splits;
  // The estimates drift away from the true measures with each bisection.
  if (box.age == RefreshAge)
  {
    this->measure(box);
  }
  Box other = box;
  other.slot = this->newSlot(); // may move the pool
  const auto measures = box.measures.begin();
  const int direction =
    static_cast<int>(std::max_element(measures, measures + this->Halving.directions()) - measures);
  for (std::size_t i = 0; i < this->Count; ++i)
  {
    this->Halving.halve(
      direction, this->at(box, static_cast<int>(i)), this->at(other, static_cast<int>(i)));
  }
  this->Halving.halve(direction, box.vertices, other.vertices);
  this->Halving.estimate(direction, box.measures, other.measures);
  other.age = ++box.age;
  this->bound(box);
  this->bound(other);
  return other;
}

//------------------------------------------------------------------------------
void BernsteinQuotient::lookAtCorners(const Box& box, QuotientMinimum& result)
{
  // Coefficients at corners are values of the polynomials, so the quotients there are upper bounds.
  const double* d = this->at(box);
  for (const BernsteinCorner& corner : this->Corners)
  {
    const int k = corner.coefficient;
    double denominator = this->at(box, 1)[k];
    switch (this->Denominator)
    {
      case QuotientDenominator::Itself:
        break;
      case QuotientDenominator::ThreeHalves:
        denominator = threeHalves(denominator);
        break;
      default:
        for (std::size_t i = 2; i < this->Count; ++i)
        {
          denominator *= this->at(box, static_cast<int>(i))[k];
        }
        denominator = std::sqrt(std::max(denominator, 0.0));
    }
    const double value = d[k] / std::max(denominator, tiny);
    if (value < result.upper)
    {
      result.upper = value;
      result.at = this->Halving.place(box.vertices, corner);
    }
  }
}

//------------------------------------------------------------------------------
BernsteinQuotient::Box BernsteinQuotient::whole() const
{
  Box box = {};
  box.vertices = this->Halving.domain();
  box.age = RefreshAge;
  return box;
}

//------------------------------------------------------------------------------
QuotientMinimum BernsteinQuotient::atCorners(double power)
{
  QuotientMinimum result;
  result.upper = std::numeric_limits<double>::infinity();
  this->lookAtCorners(this->whole(), result);
  result.lower = result.upper = raise(result.upper, power);
  return result;
}

//------------------------------------------------------------------------------
QuotientMinimum BernsteinQuotient::minimum(double power, double tolerance, double above)
{
  QuotientMinimum result;
  result.upper = std::numeric_limits<double>::infinity();
  this->Heap.clear();
  this->Free.clear();
  this->Slots = 1;
  this->Splits = 0;
  Box root = this->whole();
  this->bound(root);
  this->lookAtCorners(root, result);
  const auto raised = [&](double x) { return raise(x, power); };
  const double level = above > 0 ? std::pow(above, 1 / power) : above;
  // The lower bound at which the search ends, for the best value so far.
  double best = 0, enough = 0;
  const auto update = [&]
  {
    best = result.upper;
    const double wanted = raised(best) - tolerance;
    enough = std::min(level, wanted > 0 ? std::pow(wanted, 1 / power) : 0.0);
  };
  update();
  this->push(root);
  while (!this->Heap.empty() && this->Heap.front().least < enough && !(result.upper < 0) &&
    this->Splits < MaxSplits)
  {
    std::pop_heap(this->Heap.begin(), this->Heap.end(),
      [](const Box& a, const Box& b) { return a.least > b.least; });
    Box box = this->Heap.back();
    this->Heap.pop_back();
    Box other = this->split(box);
    for (const Box* half : { &box, &other })
    {
      this->lookAtCorners(*half, result);
    }
    if (result.upper < best)
    {
      update();
    }
    for (const Box* half : { &box, &other })
    {
      if (half->least < result.upper)
      {
        this->push(*half);
      }
      else
      {
        this->Free.push_back(half->slot);
      }
    }
  }
  result.lower =
    this->Heap.empty() ? result.upper : std::min(result.upper, this->Heap.front().least);
  // The bounds of the denominators hold for positive numerators only: there is no lower bound.
  if (result.upper < 0)
  {
    result.lower = -std::numeric_limits<double>::infinity();
  }
  result.lower = std::isfinite(result.lower) ? raised(result.lower) : result.lower;
  result.upper = raised(result.upper);
  return result;
}
}
