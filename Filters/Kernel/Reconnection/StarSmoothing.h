// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file StarSmoothing.h
 * @brief The position of one point that maximizes the smallest quality of the surrounding
 * tetrahedra.
 * Internal: not installed.
 */
#ifndef tautline_StarSmoothing_h
#define tautline_StarSmoothing_h

#include "TetrahedronMesh.h"
#include "tautline/ReconnectionKernelExport.h"

#include <functional>

namespace tautline
{
/// The freedom of a point: anywhere, in a plane, along a line, or fixed.
struct PointFreedom
{
  enum Kind : std::uint8_t
  {
    Free = 0,
    InPlane = 1, ///< `direction` is the unit normal
    OnLine = 2,  ///< `direction` is the unit tangent
    Fixed = 3
  };
  Kind kind = Free;
  Vec3 direction = { 0, 0, 0 };
  /// For BoundarySurface: the patch (InPlane) or curve (OnLine) of a point whose direction varies,
  /// and the set of patches that the point touches; -1: none.
  std::int32_t part = -1, patches = -1;
  /// Corners with the same number are closer to each other than the boundary distance and may be
  /// merged; -1: kept.
  std::int32_t group = -1;
  void fix()
  {
    this->kind = Fixed;
    this->direction = { 0, 0, 0 };
    this->part = this->group = -1;
  }
  bool isCurved() const { return this->part >= 0; }
  Vec3 project(const Vec3& d) const
  {
    const double along = dot(d, this->direction);
    return this->kind == Free
      ? d
      : (this->kind == InPlane ? d - along * this->direction : along * this->direction);
  }
};

/**
 * @brief Maximizes the smallest quality of the tetrahedra that join a point to given triangles, by
 * proximal bundle steps: the sines and mean ratios near the smallest value are linearized, and the
 * step maximizes the smallest of the linear functions minus a multiple of its square.
 */
class TAUTLINE_RECONNECTIONKERNEL_EXPORT StarSmoothing
{
public:
  /// Vertices of larger stars are not moved.
  static constexpr int MaxFaces = 128;

  /// A step is tried if it is predicted to gain this.
  double leastGain = 5e-4;
  QualityWeights weights;

  void clear() { this->Size = 0; }
  int size() const { return this->Size; }
  /// @param a, b, c in the order that makes (point, a, b, c) positive. @return false if there is no
  ///   room
  bool addFace(const Vec3& a, const Vec3& b, const Vec3& c);

  /// The qualities with the point at p, in the order of the faces; returns the smallest.
  double evaluate(const Vec3& p);
  const double* qualities() const { return this->Values; }

  /**
   * @brief Improves the position.
   * @param p start, and result; unchanged if no step improves the smallest quality
   * @param steps the largest number of accepted steps
   * @param project projects a trial position onto the allowed set; may be null
   * @return the smallest quality; qualities() are evaluated at p
   */
  double maximize(Vec3& p, int steps, const PointFreedom& freedom = {},
    const std::function<Vec3(const Vec3&)>& project = nullptr);

private:
  static constexpr int MaxFunctions = 48;

  void linearize(const Vec3& p, double below);
  double solve(double weight, double wanted, Vec3& step);

  int Size = 0;
  // Per face: corners, normal, its square, squares of the edges.
  double Corners[9][MaxFaces];
  double Normal[4][MaxFaces];
  double Edges[4][MaxFaces]; ///< ab, bc, ca, and their sum
  double Values[MaxFaces];
  std::array<std::array<Vec3, 3>, MaxFaces> Faces; ///< for a metric of the registry
  double Length2 = 0;                              ///< the smallest squared edge of the faces
  // Linearized functions, and the weights of their convex combination.
  int Functions = 0;
  double F[MaxFunctions];
  Vec3 G[MaxFunctions];
  double Lambda[MaxFunctions];
};
}
#endif
