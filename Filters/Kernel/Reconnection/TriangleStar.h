// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TriangleStar.h
 * @brief The position of one point that maximizes the smallest quality of the surrounding
 * triangles.
 * Internal: not installed.
 */
#ifndef tautline_TriangleStar_h
#define tautline_TriangleStar_h

#include "TriangleQuality.h"
#include "tautline/ReconnectionKernelExport.h"

#include <functional>
#include <vector>

namespace tautline
{
/**
 * @brief Maximizes the smallest sine of an angle of the triangles that join a point to given edges,
 * or their smallest mean ratio in given metrics, by proximal bundle steps: the values near the
 * smallest one are linearized, and the step maximizes the smallest of the linear functions minus a
 * multiple of its square.
 */
class TAUTLINE_RECONNECTIONKERNEL_EXPORT TriangleStar
{
public:
  /// Steps are taken in the plane of two orthonormal directions, or along the first one only.
  struct Directions
  {
    Vec3 first = { 1, 0, 0 }, second = { 0, 1, 0 };
    int count = 2;
    Vec3 normal() const { return cross(this->first, this->second); }
  };

  /// The minimum gain of a step.
  double leastGain = 1e-4;

  void clear()
  {
    this->Edges.clear();
    this->Metrics.clear();
  }
  /// An edge, so that (point, a, b) is a triangle in its order.
  void addEdge(const Vec3& a, const Vec3& b) { this->Edges.push_back({ a, b }); }
  /// The same in the xy plane, with the mean ratio in a metric as quality. Either all edges of a
  /// star have metrics, or none.
  void addEdge(const Vec3& a, const Vec3& b, const PlaneTensor& metric)
  {
    this->Edges.push_back({ a, b });
    this->Metrics.push_back(metric);
  }

  /// The smallest quality with the point at p; negative for triangles that oppose the normal.
  double evaluate(const Vec3& p, const Vec3& normal) const;

  /**
   * @brief Improves the position.
   * @param p start, and result; unchanged if no step improves the smallest quality
   * @param steps the largest number of accepted steps
   * @param project projects a trial point onto the allowed set; may be null
   * @return the smallest quality
   */
  double maximize(Vec3& p, int steps, const Directions& directions,
    const std::function<Vec3(const Vec3&)>& project = nullptr);

private:
  /// A linearized sine: value, gradient along the directions, weight in the convex combination.
  struct Function
  {
    double value;
    Vec2 gradient;
    double weight;
  };
  void linearize(const Vec3& p, const Directions& directions);
  void linearizeSines(const Vec3& p, const Directions& directions);
  void linearizeMeanRatios(const Vec3& p, const Directions& directions);
  void addFunction(double value, const Vec3& gradient, const Directions& directions);
  Vec2 solve(double weight);

  std::vector<std::array<Vec3, 2>> Edges;
  std::vector<PlaneTensor> Metrics; ///< per edge, or empty
  std::vector<Function> Functions;
};
}
#endif
