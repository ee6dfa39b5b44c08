// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedSlides.h
 * @brief Constraints on the points of curved elements: fixed, free, or sliding.
 * Internal: not installed.
 */
#ifndef tautline_CurvedSlides_h
#define tautline_CurvedSlides_h

#include "SlidingBoundary.h"
#include "tautline/Boundary/SurfaceProjection.h"

namespace tautline
{
class CurvedSlides
{
public:
  explicit CurvedSlides(Index points)
    : Points(points)
  {
  }

  /// All points are free at first.
  void fix(Index p) { this->Points[p].kind = Kind::Fixed; }
  bool isFixed(Index p) const { return this->Points[p].kind == Kind::Fixed; }
  /// @param piece the piece that contains the point; the boundary must outlive this object
  void slide(Index p, const SlidingBoundary& boundary, Index piece);
  /// @param surface must outlive this object
  void slide(Index p, const SurfaceProjection& surface);
  bool slides(Index p) const { return this->Points[p].kind >= Kind::OnPiece; }

  /// Fixes a sliding point until release().
  void hold(Index p)
  {
    this->Points[p].held = true;
    ++this->Held;
  }
  bool isHeld(Index p) const { return this->Points[p].held; }
  Index held() const { return this->Held; }
  void release();

  /// Moves sliding points to the closest positions.
  void place(std::vector<double>& x, int threads);
  /// Makes the last positions the basis for the directions of project().
  void accept();
  /// Projects a vector, 3 numbers per point, onto the allowed directions.
  void project(std::vector<double>& v) const;
  /// Restricts a Hessian block to the allowed directions, with 1 for the others.
  void project(Index p, PointBlock& block) const;

private:
  enum class Kind : signed char
  {
    Fixed,
    Free,
    OnPiece,
    OnSurface
  };
  struct Point
  {
    Kind kind = Kind::Free;
    bool curve = false;
    bool held = false;
    const SlidingBoundary* boundary = nullptr;
    const SurfaceProjection* surface = nullptr;
    CurvedPlace place, tried;
  };
  /// The component of v that a normal or tangent allows.
  static Vec3 along(const Point& point, const Vec3& v);

  std::vector<Point> Points;
  Index Held = 0;
};
}
#endif
