// SPDX-License-Identifier: BSD-3-Clause
#include "TargetForm.h"

#include <algorithm>

namespace tautline
{
namespace
{
/// A matrix from control points, or nodes, to the coefficients of a space, row by row.
using Rows = std::vector<double>;

BernsteinSpace differenceOf(const BernsteinSpace& larger, const BernsteinSpace& smaller)
{
  std::vector<BernsteinFactor> factors = larger.factors();
  for (std::size_t f = 0; f < factors.size(); ++f)
  {
    factors[f].degree -= smaller.factors()[f].degree;
  }
  return BernsteinSpace(factors);
}

/// The rows of polynomials times a fixed polynomial, given by its coefficients.
Rows multiply(const BernsteinSpace& space, const Rows& rows, int width,
  const BernsteinSpace& factorSpace, const std::vector<double>& factor,
  const BernsteinSpace& product)
{
  const BernsteinProduct targets(space, factorSpace, product);
  Rows result(static_cast<std::size_t>(product.size()) * width);
  for (int i = 0; i < space.size(); ++i)
  {
    for (int j = 0; j < factorSpace.size(); ++j)
    {
      const int k = targets.targets(i)[j];
      const double scale =
        space.multinomial(i) * factorSpace.multinomial(j) * factor[j] / product.multinomial(k);
      for (int c = 0; c < width; ++c)
      {
        result[k * width + c] += scale * rows[i * width + c];
      }
    }
  }
  return result;
}

Rows elevate(const BernsteinSpace& space, const Rows& rows, int width, const BernsteinSpace& to)
{
  const BernsteinSpace rest = differenceOf(to, space);
  return multiply(space, rows, width, rest, std::vector<double>(rest.size(), 1.0), to);
}
}

//------------------------------------------------------------------------------
ElementMatrix idealInverseOf(ElementShape shape)
{
  const double root3 = std::sqrt(3.0), root2 = std::sqrt(2.0);
  switch (shape)
  {
    case ElementShape::Triangle:
    case ElementShape::Wedge:
      return { Vec3{ 1, -1 / root3, 0 }, Vec3{ 0, 2 / root3, 0 }, Vec3{ 0, 0, 1 } };
    case ElementShape::Tetrahedron:
      return { Vec3{ 1, -1 / root3, -1 / (root2 * root3) },
        Vec3{ 0, 2 / root3, -1 / (root2 * root3) }, Vec3{ 0, 0, root3 / root2 } };
    case ElementShape::Pyramid:
      return { Vec3{ 1, 0, -1 / root2 }, Vec3{ 0, 1, -1 / root2 }, Vec3{ 0, 0, root2 } };
    default:
      return { Vec3{ 1, 0, 0 }, Vec3{ 0, 1, 0 }, Vec3{ 0, 0, 1 } };
  }
}

//------------------------------------------------------------------------------
double idealDeterminantOf(ElementShape shape)
{
  const ElementMatrix inverse = idealInverseOf(shape); // triangular
  return inverse[0][0] * inverse[1][1] * (dimensionOf(shape) == 3 ? inverse[2][2] : 1);
}

//------------------------------------------------------------------------------
BernsteinSpace unionOf(const BernsteinSpace& a, const BernsteinSpace& b)
{
  std::vector<BernsteinFactor> factors = a.factors();
  for (std::size_t f = 0; f < factors.size(); ++f)
  {
    factors[f].degree = std::max(factors[f].degree, b.factors()[f].degree);
  }
  return BernsteinSpace(factors);
}

//------------------------------------------------------------------------------
BernsteinElevation::BernsteinElevation(const BernsteinSpace& from, const BernsteinSpace& to)
  : Size(from.size())
{
  const BernsteinSpace rest = differenceOf(to, from);
  this->Same = rest.size() == 1;
  this->Product = BernsteinProduct(from, rest, to);
  for (int j = 0; j < rest.size(); ++j)
  {
    this->One.push_back(rest.multinomial(j));
  }
  for (int k = 0; k < to.size(); ++k)
  {
    this->Factors.push_back(1 / to.multinomial(k));
  }
}

//------------------------------------------------------------------------------
void BernsteinElevation::run(const double* scaled, double* coefficients) const
{
  const std::size_t size = this->Factors.size();
  if (this->Same)
  {
    std::copy_n(scaled, size, coefficients);
  }
  else
  {
    std::fill_n(coefficients, size, 0.0);
    for (int i = 0; i < this->Size; ++i)
    {
      const std::uint16_t* target = this->Product.targets(i);
      for (std::size_t j = 0; j < this->One.size(); ++j)
      {
        coefficients[target[j]] += scaled[i] * this->One[j];
      }
    }
  }
  for (std::size_t k = 0; k < size; ++k)
  {
    coefficients[k] *= this->Factors[k];
  }
}

//------------------------------------------------------------------------------
ColumnForm::ColumnForm(const ElementType& type)
{
  const std::vector<DerivativeForm>& derivatives = type.determinant().derivatives;
  const bool pyramid = type.shape() == ElementShape::Pyramid;
  this->space = derivatives[0].space;
  for (const DerivativeForm& d : derivatives)
  {
    this->space = unionOf(this->space, d.space);
  }
  const int nodes = type.nodes();
  const ControlMatrix& controls = type.controls();
  std::vector<Rows> own; // in the spaces of the derivatives
  for (const DerivativeForm& d : derivatives)
  {
    Rows rows(static_cast<std::size_t>(d.space.size()) * nodes);
    for (int k = 0; k < d.space.size(); ++k)
    {
      const DerivativeForm::Difference& difference = d.differences[k];
      for (const auto& [control, sign] :
        { std::pair<int, double>(difference.high, 1), { difference.low, -1 } })
      {
        for (int e = controls.offsets[control]; e < controls.offsets[control + 1]; ++e)
        {
          rows[k * nodes + controls.columns[e]] += sign * difference.magnitude * controls.values[e];
        }
      }
    }
    own.push_back(std::move(rows));
  }
  for (std::size_t c = 0; c < derivatives.size(); ++c)
  {
    this->columns.push_back(elevate(derivatives[c].space, own[c], nodes, this->space));
  }
  // With r = u (1 - w) and s = v (1 - w), the derivative with respect to the height is x_w + u x_r
  // + v x_s.
  for (int c = 0; pyramid && c < 2; ++c)
  {
    const BernsteinSpace linear({ { 1, c == 0 ? 1 : 0 }, { 1, c == 1 ? 1 : 0 }, { 1, 0 } });
    const BernsteinSpace product = derivatives[c].space.times(linear);
    const Rows rows = elevate(product,
      multiply(derivatives[c].space, own[c], nodes, linear, { 0, 1 }, product), nodes, this->space);
    std::transform(rows.begin(), rows.end(), this->columns[2].begin(), this->columns[2].begin(),
      [](double a, double b) { return a + b; });
  }
}

//------------------------------------------------------------------------------
ControlMatrix ColumnForm::combine(const Vec3& weights, int nodes) const
{
  constexpr double nothing = 1e-13; // smaller values are rounding errors
  ControlMatrix matrix;
  for (int k = 0; k < this->space.size(); ++k)
  {
    for (int node = 0; node < nodes; ++node)
    {
      double sum = 0;
      for (std::size_t c = 0; c < this->columns.size(); ++c)
      {
        sum += weights[c] * this->columns[c][k * nodes + node];
      }
      if (std::abs(sum) > nothing)
      {
        matrix.columns.push_back(node);
        matrix.values.push_back(this->space.multinomial(k) * sum);
      }
    }
    matrix.offsets.push_back(static_cast<int>(matrix.columns.size()));
  }
  return matrix;
}
}
