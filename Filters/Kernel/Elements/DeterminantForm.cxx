// SPDX-License-Identifier: BSD-3-Clause
#include "DeterminantForm.h"

namespace tautline
{
namespace
{
/// The number of roundings of a triple product and of the factors, without the sums.
constexpr int fixedRoundings = 20;

/// The derivative with respect to a coordinate of a factor; the factors 1 - w of a pyramid are left
/// out.
DerivativeForm derivative(const BernsteinSpace& map, int factor, int coordinate, bool pyramid)
{
  constexpr int height = 2; // the factor w of a pyramid
  std::vector<BernsteinFactor> factors = map.factors();
  const int degree = factors[factor].degree;
  --factors[factor].degree;
  // The coefficients have the multinomials of the polynomial with the factor 1 - w.
  const BernsteinSpace full(factors);
  if (pyramid && factor != height)
  {
    --factors[height].degree;
  }
  DerivativeForm form;
  form.space = BernsteinSpace(factors);
  for (int k = 0; k < form.space.size(); ++k)
  {
    const BernsteinExponents low = form.space.exponents(k);
    BernsteinExponents high = low;
    ++high[coordinate];
    const double scale = full.multinomial(full.indexOf(low));
    form.differences.push_back(
      { map.indexOf(high), map.indexOf(low), scale, degree * scale / form.space.multinomial(k) });
  }
  return form;
}
}

//------------------------------------------------------------------------------
DeterminantForm::DeterminantForm(const BernsteinSpace& map, bool pyramid)
{
  double degrees = 1;
  for (int f = 0; f < static_cast<int>(map.factors().size()); ++f)
  {
    for (int k = 0; k < map.factors()[f].dimension; ++k)
    {
      this->derivatives.push_back(derivative(map, f, map.firstCoordinate(f) + k, pyramid));
      degrees *= map.factors()[f].degree;
    }
  }
  const auto& d = this->derivatives;
  if (map.dimension() == 3)
  {
    this->cofactors = d[1].space.times(d[2].space);
    this->cross = BernsteinProduct(d[1].space, d[2].space, this->cofactors);
    this->space = d[0].space.times(this->cofactors);
    this->dot = BernsteinProduct(d[0].space, this->cofactors, this->space);
  }
  else
  {
    this->space = d[0].space.times(d[1].space);
    this->cross = BernsteinProduct(d[0].space, d[1].space, this->space);
    // On a surface in space, the squared length of the normal is the polynomial to bound.
    this->squareSpace = this->space.times(this->space);
    this->square = BernsteinProduct(this->space, this->space, this->squareSpace);
    this->squareBisections = tautline::bisections(this->squareSpace);
    this->squareCorners = tautline::corners(this->squareSpace);
  }
  // Products have the multinomials of their factors: this factor converts them to the space of the
  // product, and applies the degrees of the derivatives.
  for (int k = 0; k < this->space.size(); ++k)
  {
    this->factors.push_back(degrees / this->space.multinomial(k));
  }
  this->bisections = tautline::bisections(this->space);
  this->corners = tautline::corners(this->space);
  this->roundings = fixedRoundings + this->cross.terms() + this->dot.terms();
}
}
