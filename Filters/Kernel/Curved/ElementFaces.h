// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ElementFaces.h
 * @brief The faces (in two dimensions, the edges) of reference elements, with local coordinates s
 * and t.
 * Internal: not installed.
 */
#ifndef tautline_ElementFaces_h
#define tautline_ElementFaces_h

#include "tautline/Elements/ElementType.h"

namespace tautline
{
struct ElementFace
{
  /// over s, t >= 0, s + t <= 1; otherwise over the unit square or, for edges, the unit interval
  bool triangle;
  /// Maps s and t to the coordinates of the element.
  Vec3 (*place)(double s, double t);
  /// The distance of coordinates of the element from the face; not negative within the element.
  double (*distance)(const Vec3& at);
  /// Maps a position on the face to s and t.
  Vec2 (*coordinates)(const Vec3& at);
  /// The indices in BernsteinSpace::factors() of the degrees along s and t.
  int factors[2];
};

const std::vector<ElementFace>& facesOf(ElementShape shape);

/// The largest distance of a node on a face from the face.
constexpr double OnFaceTolerance = 1e-9;
}
#endif
