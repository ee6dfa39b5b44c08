// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedSlides.h
 * @brief What the points of curved elements may do: stay, move, or slide.
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
  /// @param piece where the point is; the boundary must outlive this
  void slide(Index p, const SlidingBoundary& boundary, Index piece);
  /// @param surface must outlive this
  void slide(Index p, const SurfaceProjection& surface);
  bool slides(Index p) const { return this->Points[p].kind >= Kind::OnPiece; }

  /// Lets a point that slides stay until release().
  void hold(Index p)
  {
    this->Points[p].held = true;
    ++this->Held;
  }
  bool isHeld(Index p) const { return this->Points[p].held; }
  Index held() const { return this->Held; }
  void release();

  /// Takes points that slide to the closest places.
  void place(std::vector<double>& x, int threads);
  /// Makes the last places those by which project() knows the directions.
  void accept();
  /// What the points may follow of a vector, 3 numbers each.
  void project(std::vector<double>& v) const;
  /// The part of a block of the Hessian that acts on it, and 1 on what is left out.
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
  /// Of a normal or tangent what is left of v.
  static Vec3 along(const Point& point, const Vec3& v);

  std::vector<Point> Points;
  Index Held = 0;
};
}
#endif
