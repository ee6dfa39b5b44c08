// SPDX-License-Identifier: BSD-3-Clause
#include "CurvedSum.h"

#include <numeric>

namespace tautline
{
//------------------------------------------------------------------------------
template <int Dim>
CurvedSum<Dim>::CurvedSum(std::vector<CurvedTerm<Dim>> terms, CurvedScalarization scalarize)
  : Terms(std::move(terms))
  , Scalarize(std::move(scalarize))
  , Slopes(this->Terms.size(), 1.0)
{
}

//------------------------------------------------------------------------------
template <int Dim>
double CurvedSum<Dim>::combined(const std::vector<double>& values) const
{
  return this->Scalarize ? this->Scalarize(values, nullptr)
                         : std::accumulate(values.begin(), values.end(), 0.0);
}

//------------------------------------------------------------------------------
template <int Dim>
double CurvedSum<Dim>::value(const std::vector<double>& x)
{
  std::vector<double> values;
  for (CurvedTerm<Dim>& term : this->Terms)
  {
    values.push_back(term.outer(term.energy->value(*term.function, x)));
  }
  return this->combined(values);
}

//------------------------------------------------------------------------------
template <int Dim>
double CurvedSum<Dim>::linearize(
  const std::vector<double>& x, std::vector<double>& gradient, std::vector<PointBlock>& diagonal)
{
  std::vector<double> values, inner;
  std::vector<std::vector<double>> gradients(this->Terms.size());
  std::vector<std::vector<PointBlock>> diagonals(this->Terms.size());
  for (std::size_t k = 0; k < this->Terms.size(); ++k)
  {
    CurvedTerm<Dim>& term = this->Terms[k];
    inner.push_back(term.energy->linearize(*term.function, x, gradients[k], diagonals[k]));
    values.push_back(term.outer(inner.back()));
  }
  this->Slopes.assign(this->Terms.size(), 1.0);
  const double result =
    this->Scalarize ? this->Scalarize(values, &this->Slopes) : this->combined(values);
  // Chain rule: the slopes of the scalarization times the slopes of the outer functions, which
  // apply() uses as well.
  for (std::size_t k = 0; k < this->Terms.size(); ++k)
  {
    this->Slopes[k] *= this->Terms[k].slope(inner[k]);
  }
  // Gradients are exact, but the second derivatives omit the curvature of the scalarization and the
  // outer functions.
  gradient.assign(gradients.front().size(), 0.0);
  diagonal.assign(diagonals.front().size(), PointBlock{});
  for (std::size_t k = 0; k < this->Terms.size(); ++k)
  {
    for (std::size_t i = 0; i < gradient.size(); ++i)
    {
      gradient[i] += this->Slopes[k] * gradients[k][i];
    }
    for (std::size_t p = 0; p < diagonal.size(); ++p)
    {
      for (int r = 0; r < Dim; ++r)
      {
        for (int c = 0; c < Dim; ++c)
        {
          diagonal[p][r][c] += this->Slopes[k] * diagonals[k][p][r][c];
        }
      }
    }
  }
  return result;
}

//------------------------------------------------------------------------------
template <int Dim>
void CurvedSum<Dim>::apply(const std::vector<double>& d, std::vector<double>& product)
{
  std::vector<double> own;
  for (std::size_t k = 0; k < this->Terms.size(); ++k)
  {
    std::vector<double>& to = k == 0 ? product : own;
    this->Terms[k].energy->apply(d, to);
    // With slope 1, the first product is already in place.
    if (k == 0 && this->Slopes[0] == 1)
    {
      continue;
    }
    for (std::size_t i = 0; i < product.size(); ++i)
    {
      product[i] = (k == 0 ? 0 : product[i]) + this->Slopes[k] * to[i];
    }
  }
}

//------------------------------------------------------------------------------
template <int Dim>
std::vector<double> CurvedSum<Dim>::values(std::size_t items) const
{
  std::vector<double> values;
  for (const CurvedTerm<Dim>& term : this->Terms)
  {
    values.push_back(term.outer(term.energy->partialValue(items)));
  }
  return values;
}

template class CurvedSum<2>;
template class CurvedSum<3>;
}
