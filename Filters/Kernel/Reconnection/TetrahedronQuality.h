// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TetrahedronQuality.h
 * @brief The quality of one tetrahedron that reconnection maximizes.
 *
 * q = min(smallest sine of the six dihedral angles, (mean ratio)^(3/2)), 1 for the regular
 * tetrahedron, at most 0 for one that is degenerate or inverted. With d = 6 V, an edge of length l
 * between faces with normals m and n (with twice their areas as length), and the sum S of the six
 * squared edges: sine = d l / (|m| |n|), (mean ratio)^(3/2) = 12 sqrt(3) d / S^(3/2). The sine
 * alone accepts flat shapes, the mean ratio alone small angles. Weights shift the balance.
 * Alternatively, q is derived from a metric of the registry (MetricQuality) or is the shape in a
 * metric tensor.
 * Internal: not installed.
 */
#ifndef tautline_TetrahedronQuality_h
#define tautline_TetrahedronQuality_h

#include "MetricQuality.h"
#include "tautline/Adaptation/MetricTensor.h"
#include "tautline/Core/Packet.h"
#include "tautline/Core/Types.h"
#include "tautline/Geometry/Predicates.h"

#include <algorithm>

namespace tautline
{
/// 12 sqrt(3): normalizes (mean ratio)^(3/2) to 1 for the regular tetrahedron.
constexpr double MeanRatioFactor = 20.784609690826528;

/// Below this quality, the sign of the volume is determined by the exact predicate: rounding of
/// differences and products changes q by about 1e-15.
constexpr double CertainQuality = 1e-9;

/// The weights in q = min(sine * the smallest sine, meanRatio * (mean ratio)^(3/2)). A large weight
/// disables its term.
struct QualityWeights
{
  double sine = 1, meanRatio = 1;
  /// Used instead of both; the weights are then large, so that bounds based on them hold.
  const MetricQuality* metric = nullptr;
  /// Used instead of all these: metricShape() in the mean of the metric tensors of the corners.
  bool inMetric = false;
};

/// The terms of the quality, and the sign of the volume.
struct TetrahedronMeasures
{
  double determinant = 0; ///< 6 V, as rounded
  double sine = 0;        ///< smallest sine of a dihedral angle; negative if inverted
  double meanRatio = 0;   ///< (mean ratio)^(3/2)
  double quality(const QualityWeights& w = {}) const
  {
    return std::min(w.sine * this->sine, w.meanRatio * this->meanRatio);
  }
};

inline TetrahedronMeasures measure(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c)
{
  const Vec3 u = a - p, v = b - p, w = c - p;
  const Vec3 ab = b - a, bc = c - b, ca = a - c;
  const Vec3 na = cross(v, w), nb = cross(w, u), nc = cross(u, v), n0 = cross(ab, c - a);
  const double a2 = dot(na, na), b2 = dot(nb, nb), c2 = dot(nc, nc), o2 = dot(n0, n0);
  const double u2 = dot(u, u), v2 = dot(v, v), w2 = dot(w, w);
  const double ab2 = dot(ab, ab), bc2 = dot(bc, bc), ca2 = dot(ca, ca);
  TetrahedronMeasures m;
  m.determinant = dot(u, na);
  const double sum = u2 + v2 + w2 + ab2 + bc2 + ca2;
  // Squares of sine / d, as fractions with the common denominator a2 b2 c2 o2.
  const double smallest =
    std::min(std::min(std::min(u2 * a2 * o2, v2 * b2 * o2), std::min(w2 * c2 * o2, ab2 * a2 * b2)),
      std::min(bc2 * b2 * c2, ca2 * c2 * a2));
  const double denominator = a2 * b2 * c2 * o2;
  if (!(denominator > 0.0))
  {
    return m;
  }
  m.sine = m.determinant * std::sqrt(smallest / denominator);
  m.meanRatio = MeanRatioFactor * m.determinant / (sum * std::sqrt(sum));
  return m;
}

/// The quality, as computed in doubles.
inline double roundedQuality(
  const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, const QualityWeights& weights = {})
{
  return weights.metric ? weights.metric->quality(p, a, b, c)
                        : measure(p, a, b, c).quality(weights);
}

/// The sum of tensors.
inline MetricTensor operator+(const MetricTensor& a, const MetricTensor& b)
{
  return { a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3], a[4] + b[4], a[5] + b[5] };
}

inline double determinantOf(const MetricTensor& m)
{
  return m[0] * (m[1] * m[2] - m[4] * m[4]) - m[3] * (m[3] * m[2] - m[4] * m[5]) +
    m[5] * (m[3] * m[4] - m[1] * m[5]);
}

/**
 * @brief (mean ratio)^(3/2) in coordinates in which a metric tensor, or any multiple of it, is the
 * identity: 12 sqrt(3) d sqrt(det M) / S^(3/2), with d = 6 V and the sum S of e . M e.
 */
inline double metricShape(
  const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, const MetricTensor& m)
{
  const Vec3 u = a - p, v = b - p, w = c - p;
  const double sum = squaredLength(u, m) + squaredLength(v, m) + squaredLength(w, m) +
    squaredLength(b - a, m) + squaredLength(c - b, m) + squaredLength(a - c, m);
  const double volume = dot(u, cross(v, w)) * std::sqrt(std::max(determinantOf(m), 0.0));
  return sum > 0.0 ? MeanRatioFactor * volume / (sum * std::sqrt(sum)) : 0.0;
}

/// A computed quality with the sign of the volume from the exact predicate.
inline double exactSign(double q, const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c)
{
  if (q > CertainQuality)
  {
    return q;
  }
  constexpr double tiny = 1e-300;
  return orientation(p, a, b, c) > 0 ? std::max(q, tiny) : std::min(q, 0.0);
}

/// The quality; positive if and only if the volume is, by the exact predicate.
inline double exactQuality(
  const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c, const QualityWeights& weights = {})
{
  return exactSign(roundedQuality(p, a, b, c, weights), p, a, b, c);
}

/// The smallest and the largest dihedral angle of a tetrahedron, degrees.
struct DihedralRange
{
  double smallest, largest;
};

/// The range of the six dihedral angles; for an inverted tetrahedron, of its mirror image.
inline DihedralRange dihedralRange(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c)
{
  const Vec3 u = a - p, v = b - p, w = c - p;
  // Outward normals of the faces opposite p, a, b, c.
  const Vec3 n[4] = { cross(b - a, c - a), cross(w, v), cross(u, w), cross(v, u) };
  // The angle between two normals is 180 degrees minus the dihedral angle; ranks compare angles
  // without atan2(). A face without area has no normal: no turn.
  struct Turn
  {
    double sine, cosine, rank;
  };
  Turn least = { 0.0, -1.0, -1.0 }, most = { 0.0, 1.0, 1.0 };
  for (int i = 0; i < 4; ++i)
  {
    for (int j = i + 1; j < 4; ++j)
    {
      const double sine = norm(cross(n[i], n[j])), cosine = dot(n[i], n[j]);
      const Turn turn = { sine, cosine, rankOfAngle(sine, cosine) };
      least = turn.rank > least.rank ? turn : least;
      most = turn.rank < most.rank ? turn : most;
    }
  }
  const auto dihedral = [](const Turn& turn)
  { return 180.0 - std::atan2(turn.sine, turn.cosine) * (180.0 / Pi); };
  return { dihedral(most), dihedral(least) };
}
}
#endif
