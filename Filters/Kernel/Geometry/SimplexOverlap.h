// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SimplexOverlap.h
 * @brief The intersection of two planar triangles, or of two tetrahedra, in pieces.
 *
 * A simplex is cut along the facets of another one into simplices. Their corners are given by
 * barycentric coordinates in both, from which integrals of products of linear functions follow.
 *
 *     const SimplexOverlap<4> overlap(x, y);          // two tetrahedra
 *     double volume = 0;
 *     overlap.forEachPiece([&](const auto&, const auto&, double size) { volume += size; });
 * Internal: not installed.
 */
#ifndef tautline_SimplexOverlap_h
#define tautline_SimplexOverlap_h

#include "tautline/Core/Types.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace tautline
{
/// The corners of a planar triangle (N = 3) or of a tetrahedron (N = 4).
template <int N>
using SimplexCorners = std::array<std::conditional_t<N == 3, Vec2, Vec3>, N>;

/// The area of a triangle, positive if it is counterclockwise.
inline double simplexSize(const SimplexCorners<3>& x)
{
  return 0.5 * cross(x[1] - x[0], x[2] - x[0]);
}
/// The volume of a tetrahedron, positive if 0 1 2 are counterclockwise as seen from 3.
inline double simplexSize(const SimplexCorners<4>& x)
{
  return dot(cross(x[1] - x[0], x[2] - x[0]), x[3] - x[0]) / 6.0;
}

/// Barycentric coordinates in a simplex of any orientation, as linear functions.
template <int N>
class BarycentricFunctions
{
public:
  using Point = typename SimplexCorners<N>::value_type;

  /// @param size simplexSize() of the simplex, not 0
  BarycentricFunctions(const SimplexCorners<N>& x, double size)
    : Corners(x)
  {
    if constexpr (N == 3)
    {
      for (int k = 0; k < N; ++k)
      {
        const Point e = x[(k + 2) % N] - x[(k + 1) % N];
        this->Gradients[k] = (0.5 / size) * Point{ -e[1], e[0] };
      }
    }
    else
    {
      constexpr int facet[4][3] = { { 1, 3, 2 }, { 0, 2, 3 }, { 0, 3, 1 }, { 0, 1, 2 } };
      for (int k = 0; k < N; ++k)
      {
        const int* f = facet[k];
        this->Gradients[k] = (1.0 / (6.0 * size)) * cross(x[f[1]] - x[f[0]], x[f[2]] - x[f[0]]);
      }
    }
  }

  const std::array<Point, N>& gradients() const { return this->Gradients; }

  std::array<double, N> at(const Point& p) const
  {
    std::array<double, N> values;
    for (int k = 0; k < N; ++k)
    {
      // Relative to a corner of the facet where the function is 0.
      values[k] = dot(this->Gradients[k], p - this->Corners[k == 0 ? 1 : 0]);
    }
    return values;
  }

private:
  SimplexCorners<N> Corners;
  std::array<Point, N> Gradients;
};

/// A point by its barycentric coordinates in two simplices.
template <int N>
struct SharedPoint
{
  std::array<double, N> first, second;
};

/**
 * @class tautline::SimplexOverlap
 * @brief The intersection of two simplices. The smaller one is cut, so that the coordinates of its
 * corners in the larger one, and thus the rounding errors, are small.
 */
template <int N>
class SimplexOverlap
{
public:
  using Corners = SimplexCorners<N>;
  using Point = SharedPoint<N>;
  using Piece = std::array<const Point*, N>;

  /// Simplices of any orientation and nonzero size.
  SimplexOverlap(const Corners& x, const Corners& y)
  {
    const double sizeOfX = simplexSize(x), sizeOfY = simplexSize(y);
    const BarycentricFunctions<N> inX(x, sizeOfX), inY(y, sizeOfY);
    std::array<std::array<double, N>, N> cornersOfX, cornersOfY;
    for (int i = 0; i < N; ++i)
    {
      cornersOfX[i] = inY.at(x[i]);
      cornersOfY[i] = inX.at(y[i]);
    }
    this->Disjoint = isOutside(cornersOfX) || isOutside(cornersOfY);
    this->Swapped = std::abs(sizeOfY) < std::abs(sizeOfX);
    this->Size = std::min(std::abs(sizeOfX), std::abs(sizeOfY));
    for (int i = 0; i < N; ++i)
    {
      this->Start[i].first.fill(0.0);
      this->Start[i].first[i] = 1.0;
      this->Start[i].second = this->Swapped ? cornersOfY[i] : cornersOfX[i];
    }
  }

  /// Whether the simplices were found to be disjoint without cutting.
  bool disjoint() const { return this->Disjoint; }

  /**
   * @brief Calls visit(first, second, size) for each piece, a simplex: first(i, k) and
   * second(i, k) are the coordinates k of its corner i in the first and the second simplex.
   */
  template <class Visit>
  void forEachPiece(const Visit& visit) const
  {
    if (this->Disjoint)
    {
      return;
    }
    Piece whole;
    for (int i = 0; i < N; ++i)
    {
      whole[i] = &this->Start[i];
    }
    this->cut(whole, 0, visit);
  }

private:
  /// Whether all corners of a simplex are beyond one facet of the other.
  static bool isOutside(const std::array<std::array<double, N>, N>& corners)
  {
    for (int k = 0; k < N; ++k)
    {
      if (std::all_of(corners.begin(), corners.end(),
            [k](const std::array<double, N>& c) { return c[k] <= 0.0; }))
      {
        return true;
      }
    }
    return false;
  }

  static Point between(const Point& inside, const Point& outside, int facet)
  {
    const double height = inside.second[facet];
    const double s = height / (height - outside.second[facet]);
    Point p;
    for (int k = 0; k < N; ++k)
    {
      p.first[k] = inside.first[k] + s * (outside.first[k] - inside.first[k]);
      p.second[k] = inside.second[k] + s * (outside.second[k] - inside.second[k]);
    }
    p.second[facet] = 0.0;
    return p;
  }

  /// The size of a piece relative to the simplex that is cut.
  static double fractionOf(const Piece& x)
  {
    std::array<std::array<double, N - 1>, N - 1> d;
    for (int i = 0; i + 1 < N; ++i)
    {
      for (int k = 0; k + 1 < N; ++k)
      {
        d[i][k] = x[i + 1]->first[k] - x[0]->first[k];
      }
    }
    if constexpr (N == 3)
    {
      return std::abs(cross(d[0], d[1]));
    }
    else
    {
      return std::abs(dot(cross(d[0], d[1]), d[2]));
    }
  }

  template <class Visit>
  void cut(Piece x, int facet, const Visit& visit) const
  {
    // Corners inside are first.
    int inside = N;
    for (; facet < N; ++facet)
    {
      inside = static_cast<int>(std::partition(x.begin(), x.end(),
                                  [facet](const Point* p) { return p->second[facet] >= 0.0; }) -
        x.begin());
      if (inside < N)
      {
        break;
      }
    }
    if (inside == 0)
    {
      return;
    }
    if (inside == N)
    {
      const double fraction = fractionOf(x);
      if (fraction > 0.0)
      {
        const auto coordinates = [&x](bool second) {
          return [&x, second](int i, int k) { return second ? x[i]->second[k] : x[i]->first[k]; };
        };
        visit(coordinates(this->Swapped), coordinates(!this->Swapped), fraction * this->Size);
      }
      return;
    }
    const auto rest = [&](const Piece& piece) { this->cut(piece, facet + 1, visit); };
    const auto mid = [&](int i, int j) { return between(*x[i], *x[j], facet); };
    if constexpr (N == 3)
    {
      if (inside == 1)
      {
        const Point a = mid(0, 1), b = mid(0, 2);
        rest({ x[0], &a, &b });
      }
      else
      {
        const Point a = mid(0, 2), b = mid(1, 2);
        rest({ x[0], x[1], &b });
        rest({ x[0], &b, &a });
      }
    }
    else
    {
      if (inside == 1)
      {
        const Point a = mid(0, 1), b = mid(0, 2), c = mid(0, 3);
        rest({ x[0], &a, &b, &c });
      }
      else if (inside == 2)
      {
        // A wedge with the triangles (x0, a, b) and (x1, c, d).
        const Point a = mid(0, 2), b = mid(0, 3), c = mid(1, 2), d = mid(1, 3);
        rest({ x[0], &a, &b, x[1] });
        rest({ &a, &b, x[1], &c });
        rest({ &b, x[1], &c, &d });
      }
      else
      {
        const Point a = mid(0, 3), b = mid(1, 3), c = mid(2, 3);
        rest({ x[0], x[1], x[2], &a });
        rest({ x[1], x[2], &a, &b });
        rest({ x[2], &a, &b, &c });
      }
    }
  }

  std::array<Point, N> Start; ///< `first` in the simplex that is cut, `second` in the other one
  double Size = 0.0;          ///< of the simplex that is cut
  bool Swapped = false;       ///< whether the second one is cut
  bool Disjoint = false;
};
}
#endif
