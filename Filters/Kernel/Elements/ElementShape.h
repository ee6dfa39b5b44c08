// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ElementShape.h
 * @brief The shapes of reference elements and the orders of polynomials over them.
 */
#ifndef tautline_ElementShape_h
#define tautline_ElementShape_h

#include <array>

namespace tautline
{
enum class ElementShape : unsigned char
{
  Triangle,
  Quadrilateral,
  Tetrahedron,
  Hexahedron,
  Wedge,
  Pyramid
};

/// The largest order along an axis.
constexpr int MaxElementOrder = 6;

/// The orders along u, v and w; in two dimensions, the third one is 0. The orders of a simplex or a
/// pyramid are equal; a wedge has equal orders in u and v.
using ElementOrders = std::array<int, 3>;

inline int dimensionOf(ElementShape shape)
{
  return shape == ElementShape::Triangle || shape == ElementShape::Quadrilateral ? 2 : 3;
}
}
#endif
