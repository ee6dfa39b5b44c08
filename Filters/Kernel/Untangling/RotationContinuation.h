// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RotationContinuation.h
 * @brief An initial mesh for untangling around rotated holes: there, minimizing the energy leads to
 * a fold, whereas the elements should wind around the hole.
 * Internal: not installed.
 */
#ifndef tautline_RotationContinuation_h
#define tautline_RotationContinuation_h

#include "TangledMesh.h"

namespace tautline
{
/// A rotation about a line through `center` parallel to a coordinate axis.
struct AxisRotation
{
  Vec3 center = { 0, 0, 0 };
  int axis = 2;
  double angle = 0; ///< radians

  /// Rotates the point p by a fraction of the angle.
  void apply(double fraction, double* p) const
  {
    const int a = (this->axis + 1) % 3, b = (this->axis + 2) % 3;
    const double cosine = std::cos(fraction * this->angle), sine = std::sin(fraction * this->angle);
    const double u = p[a] - this->center[a], v = p[b] - this->center[b];
    p[a] = this->center[a] + cosine * u - sine * v;
    p[b] = this->center[b] + sine * u + cosine * v;
  }
};

/// A mesh with its holes rotated back, and the path from there to their current positions. Dim is 2
/// or 3.
template <int Dim>
class RotationContinuation
{
public:
  /**
   * @brief For each hole, finds how far its boundary is rotated relative to the rest: the inverse
   * rotation for which the harmonic map has the fewest invalid simplices. At most eight holes.
   * @param x of the input, VertexStride coordinates per vertex; not changed
   * @param tolerance of the harmonic maps
   */
  RotationContinuation(const TangledMesh<Dim>& tangled, const double* x, double tolerance);

  /// Whether no rotation improves the mesh.
  bool empty() const { return this->Holes.empty(); }
  /// All vertices, with the holes rotated back and the free vertices at the harmonic map.
  const std::vector<double>& start() const { return this->Start; }
  /// In radians.
  double largestAngle() const;
  /// Rotates the holes by a fraction of the path; the rotation of the surrounding vertices
  /// decreases with distance.
  void advance(double fraction, double* x) const;

private:
  struct HoleRotation
  {
    AxisRotation rotation;
    /// Per vertex: 1 on the hole, 0 on other fixed vertices, harmonic in between.
    std::vector<double> weights;
  };

  std::vector<double> Start;
  std::vector<HoleRotation> Holes;
};
}
#endif
