// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file RotationContinuation.h
 * @brief A start for untangling a mesh around holes that were rotated: there, energies lead into a
 * fold where the elements should wind around the hole.
 * Internal: not installed.
 */
#ifndef tautline_RotationContinuation_h
#define tautline_RotationContinuation_h

#include "TangledMesh.h"

namespace tautline
{
/// A rotation about a line through `center`, parallel to an axis of coordinates.
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

/// A mesh with its holes rotated back, and the way from there to where they are. Dim is 2 or 3.
template <int Dim>
class RotationContinuation
{
public:
  /**
   * @brief Finds for each hole how far its boundary is rotated against the rest: the rotation back
   * with which the harmonic map has the fewest invalid simplices. At most eight holes.
   * @param x of the input, VertexStride coordinates per vertex; not changed
   * @param tolerance of the harmonic maps
   */
  RotationContinuation(const TangledMesh<Dim>& tangled, const double* x, double tolerance);

  /// No rotation is better than none.
  bool empty() const { return this->Holes.empty(); }
  /// All vertices, those of the holes rotated back and the free ones at the harmonic map.
  const std::vector<double>& start() const { return this->Start; }
  /// In radians.
  double largestAngle() const;
  /// Rotates the holes, and the vertices around them less the farther away they are, by a fraction
  /// of the way.
  void advance(double fraction, double* x) const;

private:
  struct HoleRotation
  {
    AxisRotation rotation;
    /// Per vertex: 1 on the hole, 0 on other fixed ones, harmonic between.
    std::vector<double> weights;
  };

  std::vector<double> Start;
  std::vector<HoleRotation> Holes;
};
}
#endif
