// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ElementBasis.h
 * @brief The polynomials of the maps of elements.
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
  std::vector<ElementFunction> functions; ///< empty: all of the space
  bool centered = false; ///< whether 2u - 1 and 2v - 1 stand in the terms instead of u and v

  long double value(std::size_t function, const std::array<long double, 3>& at) const;
};

/// All polynomials of the orders over a shape; throws Error for orders that it cannot have.
ElementBasis completeBasis(ElementShape shape, const ElementOrders& orders);

/// The quadratic polynomials of a quadrilateral with 8 nodes: of superlinear degree 2.
ElementBasis serendipityQuadrilateral();
/// Of a hexahedron with 20 nodes, and with 24 (VTK's bi-quadratic quadratic hexahedron).
ElementBasis serendipityHexahedron(bool biquadratic);
/// Quadratic with the bubble, of a triangle with 7 nodes.
ElementBasis bubbleTriangle();
/// Quadratic with the bubbles of the faces and of the interior, of a tetrahedron with 15 nodes.
ElementBasis bubbleTetrahedron();
/// Of a wedge with 15 nodes: quadratic over the triangle times linear along w, and linear times
/// w^2.
ElementBasis serendipityWedge();
/// Of a wedge with 21 nodes: quadratic with the bubble over the triangle times quadratic along w.
ElementBasis bubbleWedge();
/// Of VTK's quadratic pyramid with 13 nodes: a collapsed hexahedron with 20 nodes, with the
/// correction that makes it quadratic on its triangular faces.
ElementBasis quadraticPyramid();
/// Of VTK's tri-quadratic pyramid with 19 nodes.
ElementBasis triquadraticPyramid();
}
#endif
