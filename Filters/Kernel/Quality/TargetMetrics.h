// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TargetMetrics.h
 * @brief Metrics that are functions of T = A W^-1 at the corners of a cell.
 * Internal: not installed.
 *
 * A is the corner Jacobian, and W is the corner Jacobian of the ideal (or another target) cell: T =
 * I if the corner matches the target. Every metric here depends on T through four invariants,
 *
 *     norm2 = |T|^2     adj2 = |adj T|^2     det = tau = det T     trace = tr T
 *
 * so a metric is a formula in them and its partial derivatives; the chain rule down to the vertices
 * is written once, in EvaluateTarget.cxx. n is the dimension, |.| the Frobenius norm.
 *
 * To add one: write a struct with its formula as the comment, list it in EvaluateTarget.cxx, and
 * enter its facts in MetricRegistry.cxx. The tests then include it automatically.
 *
 * Sources: Knupp, "Algebraic mesh quality metrics" (2001); Knupp, "Introducing the target-matrix
 * paradigm" (2012) and the MFEM TMOP numbering mu_k; dissertation sections 2.3, 3.2.1, 4.9.2.
 */
#ifndef tautline_TargetMetrics_h
#define tautline_TargetMetrics_h

#include "Metrics.h"
#include "tautline/Core/Packet.h"

namespace tautline
{
template <int N>
struct TargetInvariants
{
  Packet norm2 = {};
  Packet adj2 = {}; ///< 3D only; in 2D it equals norm2
  Packet det = {};
  Packet trace = {};
};

/// The data that the evaluation must provide for a metric, and whether it is singular at det T = 0.
struct TargetMetric
{
  static constexpr bool usesAdjugate = false;
  static constexpr bool usesTrace = false;
  /// Whether the formula (or its gradient) is singular at det = 0; the value there is 0.
  static constexpr bool singular = true;
  /// Whether T is the Jacobian scaled to det T = area or volume, independent of the target.
  static constexpr bool usesSize = false;
  static constexpr bool in2D = true;
  static constexpr bool in3D = true;
  /// Whether the formula belongs to a user metric.
  static constexpr bool user = false;
};

constexpr double sqrt3 = 1.7320508075688772;
template <int N>
constexpr double sqrtN = N == 2 ? 1.4142135623730951 : sqrt3;

/// q = |T|^2 / (n |tau|^(2/n)), with the sign of tau.
struct InverseMeanRatio : TargetMetric
{
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters&)
  {
    Packet q;
    if constexpr (N == 2)
    {
      d.norm2 = 0.5 / t.det;
      q = t.norm2 * d.norm2;
      d.det = -q / t.det;
    }
    else
    {
      const Packet root = inverseCbrt(abs(t.det)), square = signOf(t.det) * root * root;
      d.norm2 = square * (1.0 / 3.0);
      q = t.norm2 * d.norm2;
      d.det = (-2.0 / 3.0) * q * (square * root); // 1 / det T
    }
    return q;
  }
};

/// q = n |tau|^(2/n) / |T|^2, with the sign of tau: the reciprocal of the above.
struct MeanRatio : TargetMetric
{
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters&)
  {
    Packet q;
    if constexpr (N == 2)
    {
      d.det = 2.0 / t.norm2;
      q = t.det * d.det;
    }
    else
    {
      q = 3.0 * t.det * inverseCbrt(abs(t.det)) / t.norm2;
      d.det = (2.0 / 3.0) * q / t.det;
    }
    d.norm2 = -q / t.norm2;
    return q;
  }
};

/// q = |T| |T^-1| / n, with the sign of tau.
struct ConditionNumber : TargetMetric
{
  static constexpr bool usesAdjugate = true;
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters& p)
  {
    if constexpr (N == 2)
    {
      return InverseMeanRatio::evaluate<2>(t, d, p);
    }
    else
    {
      const Packet q = sqrt(t.norm2 * t.adj2) / (3.0 * t.det);
      d.norm2 = 0.5 * q / t.norm2;
      d.adj2 = 0.5 * q / t.adj2;
      d.det = -q / t.det;
      return q;
    }
  }
};

/// mu_2 = |T|^2 / (2 tau) - 1, mu_303 = |T|^2 / (3 tau^(2/3)) - 1 (with the sign of tau).
struct ShapeBarrier : TargetMetric
{
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters& p)
  {
    return InverseMeanRatio::evaluate<N>(t, d, p) - 1.0;
  }
};

/// mu_301 = |T| |T^-1| / 3 - 1.
struct ShapeCondition : TargetMetric
{
  static constexpr bool usesAdjugate = true;
  static constexpr bool in2D = false;
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters& p)
  {
    return ConditionNumber::evaluate<N>(t, d, p) - 1.0;
  }
};

/// mu_302 = |T|^2 |T^-1|^2 / 9 - 1.
struct ShapeConditionSquared : TargetMetric
{
  static constexpr bool usesAdjugate = true;
  static constexpr bool in2D = false;
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters&)
  {
    const Packet scale = 1.0 / (9.0 * t.det * t.det);
    d.norm2 = t.adj2 * scale;
    d.adj2 = t.norm2 * scale;
    const Packet q = t.norm2 * d.norm2;
    d.det = -2.0 * q / t.det;
    return q - 1.0;
  }
};

/// mu_50 = |T^t T|^2 / (2 tau^2) - 1.
struct ShapeSquared : TargetMetric
{
  static constexpr bool in3D = false;
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters&)
  {
    const Packet r = t.norm2 / t.det;
    d.norm2 = r / t.det;
    d.det = -r * d.norm2;
    return 0.5 * r * r - 2.0;
  }
};

/// mu_58 = |T^t T|^2 / tau^2 - 2 |T|^2 / tau + 2.
struct ShapeProduct : TargetMetric
{
  static constexpr bool in3D = false;
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters&)
  {
    const Packet r = t.norm2 / t.det;
    d.norm2 = 2.0 * (r - 1.0) / t.det;
    d.det = -r * d.norm2;
    return r * (r - 2.0);
  }
};

/// mu_304 = |T|^3 / (3 sqrt(3) tau) - 1.
struct ShapeCubic : TargetMetric
{
  static constexpr bool in2D = false;
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters&)
  {
    const Packet q = t.norm2 * sqrt(t.norm2) / (3.0 * sqrt3 * t.det);
    d.norm2 = 1.5 * q / t.norm2;
    d.det = -q / t.det;
    return q - 1.0;
  }
};

/// mu_322 = |T - adj(T)^t|^2 / (6 tau).
struct ShapeSizeAdjugate : TargetMetric
{
  static constexpr bool usesAdjugate = true;
  static constexpr bool in2D = false;
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters&)
  {
    const Packet scale = 1.0 / (6.0 * t.det);
    const Packet q = (t.norm2 + t.adj2) * scale;
    d.norm2 = scale;
    d.adj2 = scale;
    d.det = -q / t.det;
    return q - 1.0;
  }
};

/// mu_4 = |T|^2 - 2 tau, mu_360 = |T|^3 / (3 sqrt(3)) - tau.
struct ShapeNonBarrier : TargetMetric
{
  static constexpr bool singular = false;
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters&)
  {
    if constexpr (N == 2)
    {
      d.norm2 = broadcast(1.0);
      d.det = broadcast(-2.0);
      return t.norm2 - 2.0 * t.det;
    }
    else
    {
      const Packet length = sqrt(t.norm2);
      d.norm2 = length * (0.5 / sqrt3);
      d.det = broadcast(-1.0);
      return t.norm2 * length * (1.0 / (3.0 * sqrt3)) - t.det;
    }
  }
};

/// |T - adj(T)^t|^2 in 2D, | (|T| / sqrt(3)) T - adj(T)^t |^2 in 3D: dissertation (4.22).
struct ShapeSimilarity : TargetMetric
{
  static constexpr bool usesAdjugate = true;
  static constexpr bool singular = false;
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters&)
  {
    if constexpr (N == 2)
    {
      d.norm2 = broadcast(2.0);
      d.det = broadcast(-4.0);
      return 2.0 * t.norm2 - 4.0 * t.det;
    }
    else
    {
      // |T|^4 / 3 + |adj T|^2 - 2 sqrt(3) |T| tau; a vanishing T has a vanishing gradient.
      const Packet length = sqrt(t.norm2);
      const Packet slope = select(length > 0.0, sqrt3 * t.det / length, Packet{});
      d.norm2 = (2.0 / 3.0) * t.norm2 - slope;
      d.adj2 = broadcast(1.0);
      d.det = -2.0 * sqrt3 * length;
      return t.norm2 * t.norm2 * (1.0 / 3.0) + t.adj2 + d.det * t.det;
    }
  }
};

/// mu_7 (2D), mu_321 (3D) = |T - T^-t|^2.
struct ShapeSizeBarrier : TargetMetric
{
  static constexpr bool usesAdjugate = true;
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters&)
  {
    const Packet inverse = 1.0 / (t.det * t.det);
    if constexpr (N == 2)
    {
      const Packet q = t.norm2 * inverse;
      d.norm2 = 1.0 + inverse;
      d.det = -2.0 * q / t.det;
      return t.norm2 + q - 4.0;
    }
    else
    {
      const Packet q = t.adj2 * inverse;
      d.norm2 = broadcast(1.0);
      d.adj2 = inverse;
      d.det = -2.0 * q / t.det;
      return t.norm2 + q - 6.0;
    }
  }
};

/// mu_9 = tau |T - T^-t|^2.
struct ShapeSizeWeighted : TargetMetric
{
  static constexpr bool in3D = false;
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters&)
  {
    const Packet inverse = 1.0 / t.det;
    d.norm2 = t.det + inverse;
    d.det = t.norm2 * (1.0 - inverse * inverse) - 4.0;
    return t.norm2 * d.norm2 - 4.0 * t.det;
  }
};

/// mu_323 = |T|^3 - 3 sqrt(3) ln |tau| - 3 sqrt(3).
struct ShapeSizeLogarithm : TargetMetric
{
  static constexpr bool in2D = false;
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters&)
  {
    const Packet length = sqrt(t.norm2);
    d.norm2 = 1.5 * length;
    d.det = -3.0 * sqrt3 / t.det;
    return t.norm2 * length - 3.0 * sqrt3 * (log(abs(t.det)) + 1.0);
  }
};

/// mu_55 (2D), mu_315 (3D) = (tau - 1)^2.
struct SizeNonBarrier : TargetMetric
{
  static constexpr bool singular = false;
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters&)
  {
    const Packet r = t.det - 1.0;
    d.det = 2.0 * r;
    return r * r;
  }
};

/// mu_56 (2D), mu_316 (3D) = (tau + 1/tau) / 2 - 1.
struct SizeBarrier : TargetMetric
{
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters&)
  {
    const Packet inverse = 1.0 / t.det;
    d.det = 0.5 - 0.5 * inverse * inverse;
    return 0.5 * (t.det + inverse) - 1.0;
  }
};

/// mu_77 (2D), mu_318 (3D) = (tau - 1/tau)^2 / 2.
struct SizeBarrierSquared : TargetMetric
{
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters&)
  {
    const Packet inverse = 1.0 / t.det;
    const Packet r = t.det - inverse;
    d.det = r * (1.0 + inverse * inverse);
    return 0.5 * r * r;
  }
};

/// mu_14 = |T - I|^2.
struct ShapeSizeOrientation : TargetMetric
{
  static constexpr bool usesTrace = true;
  static constexpr bool singular = false;
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters&)
  {
    d.norm2 = broadcast(1.0);
    d.trace = broadcast(-2.0);
    return t.norm2 - 2.0 * t.trace + static_cast<double>(N);
  }
};

/// mu_98 = |T - I|^2 / tau.
struct ShapeSizeOrientationBarrier : TargetMetric
{
  static constexpr bool usesTrace = true;
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters& p)
  {
    const Packet inverse = 1.0 / t.det;
    const Packet q = ShapeSizeOrientation::evaluate<N>(t, d, p) * inverse;
    d.norm2 *= inverse;
    d.trace *= inverse;
    d.det = -q * inverse;
    return q;
  }
};

/// mu_85 = | T - |T| I / sqrt(n) |^2.
struct ShapeOrientation : TargetMetric
{
  static constexpr bool usesTrace = true;
  static constexpr bool singular = false;
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters&)
  {
    constexpr double s = 1.0 / sqrtN<N>;
    const Packet length = sqrt(t.norm2);
    d.norm2 = 2.0 - select(length > 0.0, s * t.trace / length, Packet{});
    d.trace = -2.0 * s * length;
    return 2.0 * t.norm2 + d.trace * t.trace;
  }
};

/// (|T| - tr T / sqrt(n)) / (2 tau): Mesquite's TShapeOrientB1.
struct ShapeOrientationBarrier : TargetMetric
{
  static constexpr bool usesTrace = true;
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters&)
  {
    constexpr double s = 1.0 / sqrtN<N>;
    const Packet scale = 0.5 / t.det;
    const Packet length = sqrt(t.norm2);
    const Packet q = (length - s * t.trace) * scale;
    d.norm2 = 0.5 * scale / length;
    d.trace = -s * scale;
    d.det = -q / t.det;
    return q;
  }
};

/// mu_211 (2D), mu_311 (3D) = (tau - 1)^2 - tau + sqrt(tau^2 + epsilon).
struct SizeUntangle : TargetMetric
{
  static constexpr bool singular = false;
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters& p)
  {
    const Packet r = t.det - 1.0;
    const Packet root = sqrt(t.det * t.det + p.epsilon);
    d.det = 2.0 * r - 1.0 + t.det / root;
    return r * r - t.det + root;
  }
};

/// q = (|V - beta| - (V - beta)) / 2 with V the signed area or volume: Knupp; dissertation (3.3).
struct UntangleBeta : TargetMetric
{
  static constexpr bool singular = false;
  static constexpr bool usesSize = true;
  template <int N>
  static Packet evaluate(const TargetInvariants<N>& t, TargetInvariants<N>& d, const Parameters& p)
  {
    const Packet missing = p.beta - t.det;
    d.det = select(missing > 0.0, broadcast(-1.0), Packet{});
    return select(missing > 0.0, missing, Packet{});
  }
};
}
#endif
