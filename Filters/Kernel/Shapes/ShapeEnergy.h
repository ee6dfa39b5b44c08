// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ShapeEnergy.h
 * @brief The energy of one triangle of a shape match, for a packet of locations of its last vertex.
 * triangleEnergy() in ShapeModel.h computes the same in double precision and in a different way.
 * Internal: not installed.
 */
#ifndef tautline_ShapeEnergy_h
#define tautline_ShapeEnergy_h

#include "ShapeModel.h"
#include "tautline/Core/PacketFloat.h"

namespace tautline
{
/// A large energy whose sums stay finite; no match has it.
constexpr float Unreachable = 1e30f;
/// The source data for the energy of a triangle: vertices i, j, k are placed at p, q, r.
struct TriangleTerms
{
  float weights[3]; ///< of |q-p|^2, |r-p|^2, |r-q|^2 in the anisotropy times |det|
  float deformation;
  float distortion;
  float logLength; ///< log of the sum of edge lengths of the source, including the scale if signed
  float logScale;  ///< |log delta|; 0 if the distortion is signed
  float longest;   ///< sum of edges beyond which the distortion grows, with a margin for rounding
  float rotation;
  float cosine[4]; ///< trace of the map from (q-p, r-p): x y of each
  float sine[4];   ///< its antisymmetric part

  TriangleTerms(
    const Vec2& a, const Vec2& b, const Vec2& c, const ShapeEnergy& energy, double delta)
  {
    const double e1[2] = { b[0] - a[0], b[1] - a[1] }, e2[2] = { c[0] - a[0], c[1] - a[1] };
    const double det = e1[0] * e2[1] - e1[1] * e2[0];
    const double inner = e1[0] * e2[0] + e1[1] * e2[1];
    const double s1 = e1[0] * e1[0] + e1[1] * e1[1], s2 = e2[0] * e2[0] + e2[1] * e2[1];
    this->weights[0] = static_cast<float>((s2 - inner) / (2.0 * det));
    this->weights[1] = static_cast<float>((s1 - inner) / (2.0 * det));
    this->weights[2] = static_cast<float>(inner / (2.0 * det));
    this->deformation = static_cast<float>(energy.deformation);
    this->distortion = static_cast<float>(energy.distortion);
    const double length = std::sqrt(s1) + std::sqrt(s2) + std::hypot(c[0] - b[0], c[1] - b[1]);
    const bool isSigned = energy.signedDistortion;
    this->logLength = static_cast<float>(std::log(length) - (isSigned ? std::log(delta) : 0.0));
    this->logScale = static_cast<float>(isSigned ? 0.0 : std::abs(std::log(delta)));
    this->longest = 1.001f * std::exp(this->logLength + this->logScale);
    this->rotation = static_cast<float>(energy.rotation);
    const double trace[4] = { e2[1], -e2[0], -e1[1], e1[0] },
                 skew[4] = { e2[0], e2[1], -e1[0], -e1[1] };
    for (int x = 0; x < 4; ++x)
    {
      this->cosine[x] = static_cast<float>(trace[x] / det);
      this->sine[x] = static_cast<float>(skew[x] / det);
    }
  }

  /// Coefficients of a polynomial that is at least cosh(sqrt(y)) for 0 <= y <= MaxLog2.
  static constexpr float CoshSeries[5] = { 1.0f + 1e-5f, 0.5f, 1.0f / 24.0f, 1.0f / 720.0f,
    4.6e-5f };
  static constexpr float MaxLog2 = 49.0f;

  /// A lower bound of the energy of any triangle with an edge of this length: the sum of its
  /// edges is at least twice that, and log x >= 1 - 1 / x.
  float bound(float edge) const
  {
    const float ratio = this->longest / (2.0f * edge + MinLength);
    return ratio < 1.0f ? this->distortion * (1.0f - ratio) : 0.0f;
  }
};

/// The part of the energy that depends on p and q only.
struct BaseEdge
{
  float dx, dy; ///< q - p
  float length;
  float weighted; ///< weights[0] |q-p|^2

  BaseEdge(const TriangleTerms& terms, float qx, float qy, float px, float py, float length)
    : dx(qx - px)
    , dy(qy - py)
    , length(length)
    , weighted(terms.weights[0] * length * length)
  {
  }
};

/**
 * @brief Whether, for some r of a packet, the deformation may leave the sum below a value.
 *
 * Uses no division, root or logarithm: a log(alpha / beta)^2 < value - parts is norm < size
 * cosh(sqrt(y)) with y = (value - parts) / a, at most MaxLog2. A negative answer is always correct.
 * @param norm the anisotropy times the size
 * @param parts the other costs
 * @param value divided by a
 * @param inverse 1 / a
 */
template <bool Mirrored>
inline bool mayStayBelow(const BaseEdge& base, FloatPacket rx, FloatPacket ry, FloatPacket norm,
  FloatPacket parts, float value, float inverse)
{
  constexpr const float* c = TriangleTerms::CoshSeries;
  const FloatPacket y = max(value - parts * inverse, FloatPacket{});
  const FloatPacket det = base.dx * ry - base.dy * rx;
  const FloatPacket size = Mirrored ? abs(det) : det;
  const FloatPacket y2 = y * y;
  const FloatPacket bound = (c[0] + c[1] * y) + y2 * ((c[2] + c[3] * y) + c[4] * y2);
  return anyOf(norm < size * bound);
}

/**
 * @brief Deformation, distortion and rotation of the triangles p, q, r for a packet of r.
 * @param rx,ry r - p
 * @param pr,qr the distances |r-p| and |r-q|
 */
template <bool WithDistortion, bool WithRotation, bool Mirrored>
inline FloatPacket triangleCost(const TriangleTerms& t, const BaseEdge& base, FloatPacket rx,
  FloatPacket ry, FloatPacket pr, FloatPacket qr)
{
  const FloatPacket det = base.dx * ry - base.dy * rx;
  const FloatPacket size = Mirrored ? abs(det) : det;
  const FloatPacket length = max(base.length + pr + qr, broadcast(MinLength));
  const FloatPacket norm = base.weighted + t.weights[1] * (pr * pr) + t.weights[2] * (qr * qr);
  const FloatMask flat = size <= FlatArea * (length * length);
  FloatPacket k =
    select(flat, broadcast(FlatAnisotropy), norm / select(flat, broadcast(1.0f), size));
  k = min(max(k, broadcast(1.0f)), broadcast(FlatAnisotropy));
  // log(alpha / beta) = acosh(k)
  const FloatPacket anisotropy = log(k + sqrt(k * k - 1.0f));
  FloatPacket sum = t.deformation * (anisotropy * anisotropy);
  if (WithDistortion)
  {
    sum += t.distortion * abs(abs(log(length) - t.logLength) - t.logScale);
  }
  if (WithRotation)
  {
    const FloatPacket u =
      t.cosine[0] * base.dx + t.cosine[1] * base.dy + t.cosine[2] * rx + t.cosine[3] * ry;
    const FloatPacket v =
      t.sine[1] * base.dy + t.sine[0] * base.dx + t.sine[2] * rx + t.sine[3] * ry;
    const FloatPacket r2 = max(u * u + v * v, broadcast(1e-20f));
    sum += t.rotation * (1.0f - u / sqrt(r2));
  }
  return sum;
}
}
#endif
