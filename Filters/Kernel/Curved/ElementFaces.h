// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ElementFaces.h
 * @brief The faces of reference elements, and in two dimensions the edges, with coordinates s and t
 * of their own.
 * Internal: not installed.
 */
#ifndef tautline_ElementFaces_h
#define tautline_ElementFaces_h

#include "tautline/Elements/ElementType.h"

namespace tautline
{
struct ElementFace
{
  bool triangle; ///< over s, t >= 0, s + t <= 1; else over the unit square or, of edges, interval
  /// From s and t to the coordinates of the element.
  Vec3 (*place)(double s, double t);
  /// The distance of coordinates of the element from the face; not negative within the element.
  double (*distance)(const Vec3& at);
  /// From a place on the face to s and t.
  Vec2 (*coordinates)(const Vec3& at);
  /// The position in BernsteinSpace::factors() that the degree along s, and t, is that of.
  int factors[2];
};

const std::vector<ElementFace>& facesOf(ElementShape shape);

/// How near to a face a node is that lies on it.
constexpr double OnFaceTolerance = 1e-9;
}
#endif
