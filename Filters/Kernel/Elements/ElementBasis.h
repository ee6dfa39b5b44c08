// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ElementBasis.h
 * @brief The polynomials of element maps.
 * Internal: not installed.
 */
#ifndef tautline_ElementBasis_h
#define tautline_ElementBasis_h

#include "BernsteinSpace.h"
#include "ElementShape.h"

namespace tautline
{
/// factor u^i v^j w^k (1 - w)^m
struct ElementTerm
{
  double factor;
  int i, j, k, m;
};
using ElementFunction = std::vector<ElementTerm>;

struct ElementBasis
{
  std::vector<BernsteinFactor> factors;   ///< of the space that contains the functions
  std::vector<ElementFunction> functions; ///< empty: the whole space
  bool centered = false; ///< whether the terms use 2u - 1 and 2v - 1 instead of u and v

  long double value(std::size_t function, const std::array<long double, 3>& at) const;
};

/// All polynomials of the orders over a shape; throws Error for orders that it cannot have.
ElementBasis completeBasis(ElementShape shape, const ElementOrders& orders);

/// The quadratic polynomials of a quadrilateral with 8 nodes: of superlinear degree 2.
ElementBasis serendipityQuadrilateral();
/// For a hexahedron with 20 nodes, or with 24 (VTK's bi-quadratic quadratic hexahedron).
ElementBasis serendipityHexahedron(bool biquadratic);
/// For a triangle with 7 nodes: quadratic with the bubble.
ElementBasis bubbleTriangle();
/// For a tetrahedron with 15 nodes: quadratic with the bubbles of the faces and the interior.
ElementBasis bubbleTetrahedron();
/// For a wedge with 15 nodes: quadratic over the triangle times linear along w, and linear times
/// w^2.
ElementBasis serendipityWedge();
/// For a wedge with 21 nodes: quadratic with the bubble over the triangle times quadratic along w.
ElementBasis bubbleWedge();
/// For VTK's quadratic pyramid with 13 nodes: a collapsed hexahedron with 20 nodes, with the
/// correction that makes it quadratic on its triangular faces.
ElementBasis quadraticPyramid();
/// For VTK's tri-quadratic pyramid with 19 nodes.
ElementBasis triquadraticPyramid();
}
#endif
