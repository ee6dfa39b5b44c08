// SPDX-License-Identifier: BSD-3-Clause
#include "ElementBasis.h"

#include <algorithm>

namespace tautline
{
namespace
{
long double power(long double x, int n)
{
  long double product = 1;
  for (int k = 0; k < n; ++k)
  {
    product *= x;
  }
  return product;
}

/// The degree of a monomial without the coordinates in which it is linear.
int superlinearDegree(int i, int j, int k)
{
  return (i > 1 ? i : 0) + (j > 1 ? j : 0) + (k > 1 ? k : 0);
}

void add(ElementBasis& basis, int i, int j, int k, int m = 0)
{
  basis.functions.push_back({ { 1, i, j, k, m } });
}

/// The products of u^i v^j, i + j <= degree, with w^k.
void addTriangle(ElementBasis& basis, int degree, int k)
{
  for (int j = 0; j <= degree; ++j)
  {
    for (int i = 0; i <= degree - j; ++i)
    {
      add(basis, i, j, k);
    }
  }
}

/// u v (1 - u - v) w^k
ElementFunction triangleBubble(int k)
{
  return { { 1, 1, 1, k, 0 }, { -1, 2, 1, k, 0 }, { -1, 1, 2, k, 0 } };
}

void checkOrders(ElementShape shape, const ElementOrders& orders)
{
  const int dimension = dimensionOf(shape);
  for (int a = 0; a < dimension; ++a)
  {
    if (orders[a] < 1 || orders[a] > MaxElementOrder)
    {
      throw Error("Elements of order " + std::to_string(orders[a]) +
        " are not supported; use orders of 1 to " + std::to_string(MaxElementOrder) + ".");
    }
  }
  const bool tensor = shape == ElementShape::Quadrilateral || shape == ElementShape::Hexahedron;
  const bool flat = shape == ElementShape::Wedge || dimension == 2;
  if (!tensor && (orders[0] != orders[1] || (!flat && orders[0] != orders[2])))
  {
    throw Error(
      "The orders of a triangle, a tetrahedron, a pyramid and of the triangles of a wedge "
      "cannot differ by axis; use equal orders.");
  }
}

/// M. Bergot, G. Cohen, M. Durufle, "Higher-order finite elements for hybrid meshes using new nodal
/// pyramidal elements", J. Sci. Comput. 42 (2010)
void addPyramid(ElementBasis& basis, int p)
{
  for (int j = 0; j <= p; ++j)
  {
    for (int i = 0; i <= p; ++i)
    {
      for (int k = 0; k + std::max(i, j) <= p; ++k)
      {
        add(basis, i, j, k, std::max(i, j));
      }
    }
  }
}
}

//------------------------------------------------------------------------------
long double ElementBasis::value(std::size_t function, const std::array<long double, 3>& at) const
{
  const long double u = this->centered ? 2 * at[0] - 1 : at[0];
  const long double v = this->centered ? 2 * at[1] - 1 : at[1];
  long double sum = 0;
  for (const ElementTerm& t : this->functions[function])
  {
    sum += t.factor * power(u, t.i) * power(v, t.j) * power(at[2], t.k) * power(1 - at[2], t.m);
  }
  return sum;
}

//------------------------------------------------------------------------------
ElementBasis completeBasis(ElementShape shape, const ElementOrders& orders)
{
  checkOrders(shape, orders);
  ElementBasis basis;
  switch (shape)
  {
    case ElementShape::Triangle:
      basis.factors = { { 2, orders[0] } };
      break;
    case ElementShape::Quadrilateral:
      basis.factors = { { 1, orders[0] }, { 1, orders[1] } };
      break;
    case ElementShape::Tetrahedron:
      basis.factors = { { 3, orders[0] } };
      break;
    case ElementShape::Wedge:
      basis.factors = { { 2, orders[0] }, { 1, orders[2] } };
      break;
    case ElementShape::Hexahedron:
      basis.factors = { { 1, orders[0] }, { 1, orders[1] }, { 1, orders[2] } };
      break;
    default:
      basis.factors = { { 1, orders[0] }, { 1, orders[0] }, { 1, orders[0] } };
      addPyramid(basis, orders[0]);
  }
  return basis;
}

//------------------------------------------------------------------------------
ElementBasis serendipityQuadrilateral()
{
  ElementBasis basis;
  basis.factors = { { 1, 2 }, { 1, 2 } };
  for (int n = 0; n < 9; ++n)
  {
    // Serendipity functions have a superlinear degree of at most 2 (D. Arnold, G. Awanou, "The
    // serendipity family of finite elements", Found. Comput. Math. 11, 2011).
    if (superlinearDegree(n % 3, n / 3, 0) <= 2)
    {
      add(basis, n % 3, n / 3, 0);
    }
  }
  return basis;
}

//------------------------------------------------------------------------------
ElementBasis serendipityHexahedron(bool biquadratic)
{
  ElementBasis basis;
  basis.factors = { { 1, 2 }, { 1, 2 }, { 1, 2 } };
  for (int n = 0; n < 27; ++n)
  {
    if (superlinearDegree(n % 3, n / 3 % 3, n / 9) <= 2)
    {
      add(basis, n % 3, n / 3 % 3, n / 9);
    }
  }
  for (int n = 0; n < 2 && biquadratic; ++n)
  {
    // Bubbles of the faces along w.
    add(basis, n, 2, 2);
    add(basis, 2, n, 2);
  }
  return basis;
}

//------------------------------------------------------------------------------
ElementBasis bubbleTriangle()
{
  ElementBasis basis;
  basis.factors = { { 2, 3 } };
  addTriangle(basis, 2, 0);
  basis.functions.push_back(triangleBubble(0));
  return basis;
}

//------------------------------------------------------------------------------
ElementBasis bubbleTetrahedron()
{
  ElementBasis basis;
  basis.factors = { { 3, 4 } };
  for (int k = 0; k <= 2; ++k)
  {
    addTriangle(basis, 2 - k, k);
  }
  // Two coordinates times 1 - u - v - w: the faces w = 0, v = 0 and u = 0.
  for (int zero = 0; zero < 3; ++zero)
  {
    const int i = zero != 0, j = zero != 1, k = zero != 2;
    basis.functions.push_back({ { 1, i, j, k, 0 }, { -1, i + 1, j, k, 0 }, { -1, i, j + 1, k, 0 },
      { -1, i, j, k + 1, 0 } });
  }
  // The face opposite the origin, and the interior.
  add(basis, 1, 1, 1);
  basis.functions.push_back(
    { { 1, 1, 1, 1, 0 }, { -1, 2, 1, 1, 0 }, { -1, 1, 2, 1, 0 }, { -1, 1, 1, 2, 0 } });
  return basis;
}

//------------------------------------------------------------------------------
ElementBasis serendipityWedge()
{
  ElementBasis basis;
  basis.factors = { { 2, 2 }, { 1, 2 } };
  addTriangle(basis, 2, 0);
  addTriangle(basis, 2, 1);
  addTriangle(basis, 1, 2);
  return basis;
}

//------------------------------------------------------------------------------
ElementBasis bubbleWedge()
{
  ElementBasis basis;
  basis.factors = { { 2, 3 }, { 1, 2 } };
  for (int k = 0; k <= 2; ++k)
  {
    addTriangle(basis, 2, k);
    basis.functions.push_back(triangleBubble(k));
  }
  return basis;
}

//------------------------------------------------------------------------------
ElementBasis quadraticPyramid()
{
  ElementBasis basis;
  basis.factors = { { 1, 2 }, { 1, 2 }, { 1, 2 } };
  basis.functions.push_back({ { 2, 0, 0, 2, 0 }, { -1, 0, 0, 1, 0 } }); // w (2 w - 1), of the apex
  for (int n = 0; n < 4; ++n)
  {
    add(basis, n & 1, n >> 1, 1, 1);
    add(basis, n & 1, n >> 1, 0, 2);
  }
  // (1 - w)^2 f - c u (1 - u) v (1 - v) w (1 - w) for the nonlinear monomials f of the base: c is 8
  // times the sum of f over its corners minus the sum over the middles of its edges.
  const auto addCorrected = [&](int i, int j, double c)
  {
    basis.functions.push_back({ { 1, i, j, 0, 2 }, { -c, 1, 1, 1, 1 }, { c, 2, 1, 1, 1 },
      { c, 1, 2, 1, 1 }, { -c, 2, 2, 1, 1 } });
  };
  addCorrected(2, 0, 4);
  addCorrected(0, 2, 4);
  addCorrected(2, 1, 2);
  addCorrected(1, 2, 2);
  return basis;
}

//------------------------------------------------------------------------------
ElementBasis triquadraticPyramid()
{
  // With x = 2u - 1, y = 2v - 1, h = 1 - w: the span of VTK's shape functions.
  ElementBasis basis;
  basis.factors = { { 1, 2 }, { 1, 2 }, { 1, 3 } };
  basis.centered = true;
  for (int k = 0; k < 3; ++k)
  {
    add(basis, 0, 0, k);
  }
  for (int axis = 0; axis < 2; ++axis)
  {
    const int i = axis == 0, j = axis == 1;
    add(basis, i, j, 0, 1);         // x h
    add(basis, i, j, 1, 1);         // x w h
    add(basis, 1, 1, axis, 1);      // x y h, x y w h
    add(basis, 1 + j, 1 + i, 0, 2); // x y^2 h^2
    add(basis, 2 * i, 2 * j, 0, 2); // x^2 h^2
    basis.functions.push_back({ { 1, i, j, 2, 1 }, { 1, 1 + j, 1 + i, 1, 2 } });
    basis.functions.push_back({ { 1, 2 * i, 2 * j, 1, 2 }, { -1, 2, 2, 1, 2 } });
  }
  add(basis, 2, 2, 0, 2); // x^2 y^2 h^2
  // (x^2 + y^2) w^2 h + x^2 y^2 w (1 - 2 w) h
  basis.functions.push_back(
    { { 1, 2, 0, 2, 1 }, { 1, 0, 2, 2, 1 }, { 1, 2, 2, 1, 1 }, { -2, 2, 2, 2, 1 } });
  return basis;
}
}
