// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SimplexMetrics.h
 * @brief Metrics of triangles and tetrahedra that are functions of their edge lengths, face areas
 * and signed size.
 * Internal: not installed.
 *
 * The invariants are the squared edge lengths (in the order of CellTopology::edgeNodes), in 3D the
 * squared areas of the faces (face i opposite vertex i), and the signed area or volume; a metric is
 * a formula in them and its partial derivatives. The chain rule to the vertices and the list of
 * metrics are in EvaluateSimplex.cxx; their facts are in MetricRegistry.cxx.
 *
 * Sources: Shewchuk, "What is a good linear element? Interpolation, conditioning, and quality
 * measures" (2002); dissertation Table 2.2 and section 3.2.1.
 */
#ifndef tautline_SimplexMetrics_h
#define tautline_SimplexMetrics_h

#include "Metrics.h"
#include "tautline/Core/Packet.h"

namespace tautline
{
template <int N>
struct SimplexInvariants
{
  static constexpr int edges = N == 2 ? 3 : 6;
  static constexpr int faces = N == 2 ? 0 : 4;
  Packet edge2[edges] = {};
  Packet face2[4] = {}; ///< 3D only
  Packet size = {};
};

struct SimplexMetric
{
  static constexpr bool in2D = true;
  static constexpr bool in3D = true;
};

/// R / r of the circumscribed and inscribed circles or spheres, with the sign of the size.
struct CircumradiusOverInradius
{
  template <int N>
  static Packet evaluate(const SimplexInvariants<N>& s, SimplexInvariants<N>& d)
  {
    if constexpr (N == 2)
    {
      // R/r = a b c (a + b + c) / (8 A^2)
      Packet length[3], product = broadcast(1.0), sum = {};
      for (int e = 0; e < 3; ++e)
      {
        length[e] = sqrt(s.edge2[e]);
        product *= length[e];
        sum += length[e];
      }
      const Packet q = product * sum / (8.0 * s.size * s.size) * signOf(s.size);
      for (int e = 0; e < 3; ++e)
      {
        d.edge2[e] = 0.5 * q * (1.0 / s.edge2[e] + 1.0 / (sum * length[e]));
      }
      d.size = -2.0 * q / s.size;
      return q;
    }
    else
    {
      // R = D / (6 V) and r = 3 V / S, where D is the area of the triangle whose sides are the
      // products of opposite edges, and S is the sum of the face areas: R/r = D S / (18 V^2).
      const Packet p0 = s.edge2[0] * s.edge2[5];
      const Packet p1 = s.edge2[1] * s.edge2[3];
      const Packet p2 = s.edge2[2] * s.edge2[4];
      const Packet area2 =
        (2.0 * (p0 * p1 + p1 * p2 + p2 * p0) - (p0 * p0 + p1 * p1 + p2 * p2)) * (1.0 / 16.0);
      const Packet area = sqrt(max(area2, Packet{}));
      Packet face[4], sum = {};
      for (int f = 0; f < 4; ++f)
      {
        face[f] = sqrt(s.face2[f]);
        sum += face[f];
      }
      const Packet q = area * sum / (18.0 * s.size * s.size) * signOf(s.size);
      const Packet perArea2 = 0.5 * q / area2 * (1.0 / 8.0);
      const Packet g0 = perArea2 * (p1 + p2 - p0);
      const Packet g1 = perArea2 * (p0 + p2 - p1);
      const Packet g2 = perArea2 * (p0 + p1 - p2);
      d.edge2[0] = g0 * s.edge2[5];
      d.edge2[5] = g0 * s.edge2[0];
      d.edge2[1] = g1 * s.edge2[3];
      d.edge2[3] = g1 * s.edge2[1];
      d.edge2[2] = g2 * s.edge2[4];
      d.edge2[4] = g2 * s.edge2[2];
      for (int f = 0; f < 4; ++f)
      {
        d.face2[f] = 0.5 * q / (sum * face[f]);
      }
      d.size = -2.0 * q / s.size;
      return q;
    }
  }
};

/// Multiplies all partial derivatives by a factor.
template <int N>
void scale(SimplexInvariants<N>& d, Packet factor)
{
  for (int e = 0; e < SimplexInvariants<N>::edges; ++e)
  {
    d.edge2[e] *= factor;
  }
  for (int f = 0; f < SimplexInvariants<N>::faces; ++f)
  {
    d.face2[f] *= factor;
  }
  d.size *= factor;
}

/// q = sqrt(R / r), with the sign of the size: the form of the dissertation.
struct RadiusRatio : SimplexMetric
{
  template <int N>
  static Packet evaluate(const SimplexInvariants<N>& s, SimplexInvariants<N>& d)
  {
    const Packet ratio = CircumradiusOverInradius::evaluate<N>(s, d);
    const Packet root = sqrt(abs(ratio));
    scale<N>(d, 0.5 / root);
    return signOf(ratio) * root;
  }
};

/// q = R / (n r), with the sign of the size.
struct NormalizedRadiusRatio : SimplexMetric
{
  template <int N>
  static Packet evaluate(const SimplexInvariants<N>& s, SimplexInvariants<N>& d)
  {
    const Packet ratio = CircumradiusOverInradius::evaluate<N>(s, d);
    scale<N>(d, broadcast(1.0 / N));
    return ratio * (1.0 / N);
  }
};

/// q = A / (s1^2 + s2^2 + s3^2) in 2D, V / A_rms^(3/2) in 3D.
struct ConditioningScaleInvariant : SimplexMetric
{
  template <int N>
  static Packet evaluate(const SimplexInvariants<N>& s, SimplexInvariants<N>& d)
  {
    Packet q;
    if constexpr (N == 2)
    {
      d.size = 1.0 / (s.edge2[0] + s.edge2[1] + s.edge2[2]);
      q = s.size * d.size;
      for (Packet& edge : d.edge2)
      {
        edge = -q * d.size;
      }
    }
    else
    {
      const Packet mean = 0.25 * (s.face2[0] + s.face2[1] + s.face2[2] + s.face2[3]);
      const Packet root = sqrt(mean);
      d.size = 1.0 / (root * sqrt(root));
      q = s.size * d.size;
      for (Packet& face : d.face2)
      {
        face = (-3.0 / 16.0) * q / mean;
      }
    }
    return q;
  }
};

/// q = V / A_rms^2, 3D only (in 2D conditioning does not depend on size).
struct ConditioningSizeShape : SimplexMetric
{
  static constexpr bool in2D = false;
  template <int N>
  static Packet evaluate(const SimplexInvariants<N>& s, SimplexInvariants<N>& d)
  {
    d.size = 4.0 / (s.face2[0] + s.face2[1] + s.face2[2] + s.face2[3]);
    const Packet q = s.size * d.size;
    for (Packet& face : d.face2)
    {
      face = -0.25 * q * d.size;
    }
    return q;
  }
};

/// Sum of the face areas over the sum of A_m A_n l_mn^2, with its partial derivatives; 3D.
inline Packet interpolationRatio(const SimplexInvariants<3>& s, SimplexInvariants<3>& d)
{
  Packet face[4], sum = {}, weighted = {};
  for (int f = 0; f < 4; ++f)
  {
    face[f] = sqrt(s.face2[f]);
    sum += face[f];
  }
  constexpr int ends[6][2] = { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 0, 3 }, { 1, 3 }, { 2, 3 } };
  Packet perFace[4] = {};
  for (int e = 0; e < 6; ++e)
  {
    const int m = ends[e][0], n = ends[e][1];
    weighted += face[m] * face[n] * s.edge2[e];
    perFace[m] += face[n] * s.edge2[e];
    perFace[n] += face[m] * s.edge2[e];
  }
  const Packet ratio = sum / weighted;
  for (int e = 0; e < 6; ++e)
  {
    d.edge2[e] = -ratio / weighted * face[ends[e][0]] * face[ends[e][1]];
  }
  for (int f = 0; f < 4; ++f)
  {
    d.face2[f] = (1.0 - ratio * perFace[f]) / weighted * 0.5 / face[f];
  }
  return ratio;
}

/// q = A / (s1 s2 s3) in 2D, V sum A_k / sum A_m A_n l_mn^2 in 3D.
struct InterpolationSizeShape : SimplexMetric
{
  template <int N>
  static Packet evaluate(const SimplexInvariants<N>& s, SimplexInvariants<N>& d)
  {
    if constexpr (N == 2)
    {
      d.size = 1.0 / sqrt(s.edge2[0] * s.edge2[1] * s.edge2[2]);
      const Packet q = s.size * d.size;
      for (int e = 0; e < 3; ++e)
      {
        d.edge2[e] = -0.5 * q / s.edge2[e];
      }
      return q;
    }
    else
    {
      const Packet ratio = interpolationRatio(s, d);
      scale<N>(d, s.size);
      d.size = ratio;
      return s.size * ratio;
    }
  }
};

/// q = A / (s1 s2 s3)^(2/3) in 2D, V (sum A_k / sum A_m A_n l_mn^2)^(3/4) in 3D.
struct InterpolationScaleInvariant : SimplexMetric
{
  template <int N>
  static Packet evaluate(const SimplexInvariants<N>& s, SimplexInvariants<N>& d)
  {
    if constexpr (N == 2)
    {
      // Take one reciprocal cube root per edge: their product only overflows if they do.
      d.size = inverseCbrt(s.edge2[0]) * inverseCbrt(s.edge2[1]) * inverseCbrt(s.edge2[2]);
      const Packet q = s.size * d.size;
      for (int e = 0; e < 3; ++e)
      {
        d.edge2[e] = (-1.0 / 3.0) * q / s.edge2[e];
      }
      return q;
    }
    else
    {
      const Packet ratio = interpolationRatio(s, d);
      const Packet root = sqrt(ratio);
      const Packet power = root * sqrt(root);
      const Packet q = s.size * power;
      scale<N>(d, 0.75 * q / ratio);
      d.size = power;
      return q;
    }
  }
};
}
#endif
