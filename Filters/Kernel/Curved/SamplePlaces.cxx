// SPDX-License-Identifier: BSD-3-Clause
#include "SamplePlaces.h"

#include "tautline/Elements/ElementSamples.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <utility>

namespace tautline
{
namespace
{
/// Points between 0 and 1, and weights that add up to 1.
using LineRule = std::vector<std::pair<double, double>>;

double fromUnit(double x)
{
  return 0.5 * (x + 1);
}

LineRule normalized(LineRule rule)
{
  double sum = 0;
  for (const auto& place : rule)
  {
    sum += place.second;
  }
  for (auto& place : rule)
  {
    place.second /= sum;
  }
  return rule;
}

/// The rule for the weight (1 - x)^alpha (1 + x)^beta on [-1, 1], by the eigenvalues of the matrix
/// of its recurrence (G. H. Golub, J. H. Welsch, "Calculation of Gauss quadrature rules", 1969).
LineRule gaussJacobi(int n, int alpha, int beta)
{
  Eigen::VectorXd diagonal(n), next(std::max(n - 1, 0));
  for (int k = 0; k < n; ++k)
  {
    // The quotient would be 0 / 0 for Legendre polynomials at k = 0.
    const double sum = 2 * k + alpha + beta;
    diagonal[k] = alpha == beta ? 0 : (beta * beta - alpha * alpha) / (sum * (sum + 2));
  }
  for (int k = 1; k < n; ++k)
  {
    const double sum = 2 * k + alpha + beta;
    // This factor is 1 for k = 1, where the quotient may be 0 / 0.
    const double last = k == 1 ? 1 : (k + alpha + beta) / (sum - 1);
    next[k - 1] = std::sqrt(4.0 * k * (k + alpha) * (k + beta) * last / (sum * sum * (sum + 1)));
  }
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
  solver.computeFromTridiagonal(diagonal, next);
  LineRule rule;
  for (int k = 0; k < n; ++k)
  {
    // The weights are proportional to the squared first components of the eigenvectors.
    const double first = solver.eigenvectors()(0, k);
    rule.emplace_back(fromUnit(solver.eigenvalues()[k]), first * first);
  }
  return normalized(rule);
}

/// Includes both ends; the inner points are the zeros of the derivative of the Legendre polynomial.
LineRule gaussLobatto(int n)
{
  LineRule rule = { { 0.0, 0 }, { 1.0, 0 } };
  for (const auto& inner : gaussJacobi(n - 2, 1, 1))
  {
    rule.emplace_back(inner.first, 0);
  }
  for (auto& [place, weight] : rule)
  {
    const double x = 2 * place - 1;
    double before = 1, value = x; // the Legendre polynomials of degrees k - 1 and k
    for (int k = 1; k < n - 1; ++k)
    {
      before = std::exchange(value, ((2 * k + 1) * x * value - k * before) / (k + 1));
    }
    // Up to a factor, Lobatto weights are reciprocal squares of the Legendre polynomial of degree n
    // - 1.
    weight = 1 / (value * value);
  }
  return normalized(rule);
}

std::vector<SamplePlace> triangleRule(int n)
{
  std::vector<SamplePlace> places;
  // In the collapsed square, the Jacobian 1 - u is the weight of the rule along u.
  for (const auto& [u, first] : gaussJacobi(n, 1, 0))
  {
    for (const auto& [v, second] : gaussJacobi(n, 0, 0))
    {
      places.push_back({ { u, (1 - u) * v, 0 }, first * second });
    }
  }
  return places;
}

std::vector<SamplePlace> tetrahedronRule(int n)
{
  std::vector<SamplePlace> places;
  for (const auto& [u, first] : gaussJacobi(n, 2, 0))
  {
    for (const auto& place : triangleRule(n))
    {
      const Vec3& at = place.at;
      places.push_back({ { u, (1 - u) * at[0], (1 - u) * at[1] }, first * place.weight });
    }
  }
  return places;
}

/// The tensor product of a rule with the line rule for w.
std::vector<SamplePlace> times(const std::vector<SamplePlace>& base, const LineRule& line)
{
  std::vector<SamplePlace> places;
  for (const auto& [w, second] : line)
  {
    for (const SamplePlace& place : base)
    {
      places.push_back({ { place.at[0], place.at[1], w }, place.weight * second });
    }
  }
  return places;
}

std::vector<SamplePlace> squareRule(int n, int m)
{
  std::vector<SamplePlace> places;
  for (const auto& [v, second] : gaussLobatto(m))
  {
    for (const auto& [u, first] : gaussLobatto(n))
    {
      places.push_back({ { u, v, 0 }, first * second });
    }
  }
  return places;
}

/// For quadrilaterals: exact to degree 9, which is affordable in 2D.
constexpr int LeastSquarePlaces = 6;
}

//------------------------------------------------------------------------------
std::vector<SamplePlace> quadrature(const ElementType& type)
{
  const ElementShape shape = type.shape();
  const ElementOrders& orders = type.orders();
  const auto line = [](int order) { return order + 2; };
  std::vector<SamplePlace> places;
  switch (shape)
  {
    case ElementShape::Triangle:
      places = triangleRule(line(orders[0]));
      break;
    case ElementShape::Quadrilateral:
      places = squareRule(
        std::max(LeastSquarePlaces, line(orders[0])), std::max(LeastSquarePlaces, line(orders[1])));
      break;
    case ElementShape::Tetrahedron:
      if (orders[0] <= 2)
      {
        const ElementRule rule = quadratureOf(type); // of degree 5
        for (std::size_t i = 0; i < rule.places.size(); ++i)
        {
          places.push_back({ rule.places[i], rule.weights[i] });
        }
        break;
      }
      places = tetrahedronRule(orders[0] + 1);
      break;
    case ElementShape::Hexahedron:
      places = times(squareRule(line(orders[0]), line(orders[1])), gaussLobatto(line(orders[2])));
      break;
    case ElementShape::Wedge:
      places = times(triangleRule(line(orders[0])), gaussLobatto(line(orders[2])));
      break;
    default:
      // The Jacobian of the collapsed cube is (1 - w)^2, which is the weight of the rule along w.
      places =
        times(squareRule(line(orders[0]), line(orders[1])), gaussJacobi(line(orders[2]), 2, 0));
  }
  double sum = 0;
  for (const SamplePlace& place : places)
  {
    sum += place.weight;
  }
  for (SamplePlace& place : places)
  {
    place.weight /= sum;
  }
  return places;
}

//------------------------------------------------------------------------------
std::vector<SamplePlace> lattice(ElementShape shape, const ElementOrders& orders)
{
  const bool simplex = shape == ElementShape::Triangle || shape == ElementShape::Tetrahedron;
  const int dimension = dimensionOf(shape);
  std::array<int, 3> cuts;
  for (int axis = 0; axis < 3; ++axis)
  {
    const int order = orders[axis];
    cuts[axis] = axis >= dimension ? 0 : simplex ? dimension * order : dimension * order - 1;
  }
  std::vector<SamplePlace> places;
  for (int i = 0; i <= cuts[0]; ++i)
  {
    for (int j = 0; j <= cuts[1]; ++j)
    {
      for (int k = 0; k <= cuts[2]; ++k)
      {
        const auto part = [](int n, int of) { return of > 0 ? static_cast<double>(n) / of : 0.0; };
        const Vec3 at = { part(i, cuts[0]), part(j, cuts[1]), part(k, cuts[2]) };
        const bool triangle = simplex || shape == ElementShape::Wedge;
        const double sum = at[0] + at[1] + (simplex ? at[2] : 0);
        // The tolerance of half a step includes the points on the slanted face.
        if (!triangle || sum < 1 + 0.5 / cuts[0])
        {
          places.push_back({ at, 1 });
        }
      }
    }
  }
  for (SamplePlace& place : places)
  {
    place.weight = 1 / static_cast<double>(places.size());
  }
  return places;
}
}
