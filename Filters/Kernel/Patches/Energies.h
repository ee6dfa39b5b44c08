// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Energies.h
 * @brief Energies f(N, D) of a simplex, N = |T|^2 and D = det T (see SimplexMesh.h): minimized by
 * the fast optimizers.
 * Internal: not installed.
 */
#ifndef tautline_Energies_h
#define tautline_Energies_h

#include "Patch.h"

namespace tautline
{
/**
 * @brief The inverse mean ratio N / (n D^(2/n)) to the power 1 or 2; metrics that are its powers or
 * reciprocals (mean ratio, mu_2, mu_303) use the same energy.
 */
template <int Dim, int Power>
struct InverseMeanRatioEnergy
{
  static constexpr bool Barrier = true; ///< D must stay positive

  static Packet value(Packet N, Packet D)
  {
    const Packet q = Dim == 2 ? 0.5 * N / D : (1.0 / 3.0) * N * square(inverseCbrt(D));
    return select(
      D > 0.0, Power == 2 ? q * q : q, broadcast(std::numeric_limits<double>::infinity()));
  }

  static void terms(Packet N, Packet D, EnergyTerms& e)
  {
    // f = N^p D^r up to a factor.
    constexpr double p = Power, r = -2.0 * Power / Dim;
    const Packet overN = 1.0 / N, overD = 1.0 / D;
    const Packet q = Dim == 2 ? 0.5 * N * overD : (1.0 / 3.0) * N * square(inverseCbrt(D));
    e.f = Power == 2 ? q * q : q;
    const Packet fN = e.f * overN, fD = e.f * overD;
    e.fN = p * fN;
    e.fD = r * fD;
    e.fNN = p * (p - 1) * fN * overN;
    e.fND = p * r * fN * overD;
    e.fDD = r * (r - 1) * fD * overD;
  }

private:
  static Packet square(Packet x) { return x * x; }
};

/**
 * @brief q^2 + K q_w^2 (q / q_w)^p of the inverse mean ratio q: the square dominates until q
 * approaches q_w, where the second term takes over.
 */
template <int Dim>
struct WorstRatioEnergy
{
  static constexpr double K = 100.0;
  static constexpr int p = 32;
  double inverseWorst; ///< 1 / q_w

  Packet value(Packet N, Packet D) const
  {
    Packet f, slope, curvature;
    this->ofRatio(ratio(N, D), f, slope, curvature);
    return select(D > 0.0, f, broadcast(std::numeric_limits<double>::infinity()));
  }

  void terms(Packet N, Packet D, EnergyTerms& e) const
  {
    constexpr double r = -2.0 / Dim; // q = N D^r up to a factor
    const Packet q = ratio(N, D), overN = 1.0 / N, overD = 1.0 / D;
    Packet slope, curvature;
    this->ofRatio(q, e.f, slope, curvature);
    const Packet qN = q * overN, qD = r * q * overD;
    e.fN = slope * qN;
    e.fD = slope * qD;
    e.fNN = curvature * qN * qN;
    e.fND = curvature * qN * qD + slope * (r * qN * overD);
    e.fDD = curvature * qD * qD + slope * ((r - 1.0) * qD * overD);
  }

private:
  static Packet ratio(Packet N, Packet D)
  {
    const Packet s = inverseCbrt(D);
    return Dim == 2 ? 0.5 * N / D : (1.0 / 3.0) * N * s * s;
  }

  void ofRatio(Packet q, Packet& f, Packet& slope, Packet& curvature) const
  {
    const Packet u = q * this->inverseWorst;
    const Packet u2 = u * u, u4 = u2 * u2, u8 = u4 * u4, u16 = u8 * u8;
    const Packet lower = u16 * u8 * u4 * u2; // u^(p - 2)
    f = q * q * (1.0 + K * lower);
    slope = q * (2.0 + K * p * lower);
    curvature = 2.0 + K * p * (p - 1.0) * lower;
  }
};

/**
 * @brief N / chi^(2/n) with the regularized determinant chi = (D + sqrt(D^2 + eps^2)) / 2, which is
 * positive and smooth, even on inverted simplices, and tends to D as eps goes to zero. With eps =
 * 0, a barrier.
 *
 * J. M. Escobar et al., CMAME 192 (2003); V. Garanzha et al., ACM TOG 40 (2021).
 */
template <int Dim>
struct RegularizedShapeEnergy
{
  double eps = 0.0;

  Packet value(Packet N, Packet D) const
  {
    const Packet chi = this->chi(D, this->root(D));
    // Below any relevant chi, and large enough that its powers do not overflow.
    constexpr double tiny = 1e-90;
    return select(
      chi > tiny, N * inversePower(chi), broadcast(std::numeric_limits<double>::infinity()));
  }

  void terms(Packet N, Packet D, EnergyTerms& e) const
  {
    constexpr double r = -2.0 / Dim;
    const Packet s = this->root(D), overS = 1.0 / s;
    e.fN = inversePower(this->chi(D, s));
    e.f = N * e.fN;
    // d chi / dD = chi / s.
    const Packet byD = r * overS;
    e.fD = e.f * byD;
    e.fNN = Packet{};
    e.fND = e.fN * byD;
    e.fDD = e.f * byD * (byD - D * overS * overS);
  }

private:
  Packet root(Packet D) const { return sqrt(D * D + this->eps * this->eps); }
  Packet chi(Packet D, Packet s) const
  {
    // The second form does not cancel.
    return select(D > 0.0, 0.5 * (D + s), 0.5 * (this->eps * this->eps) / (s + abs(D)));
  }
  static Packet inversePower(Packet chi)
  {
    if constexpr (Dim == 2)
    {
      return 1.0 / chi;
    }
    const Packet y = inverseCbrt(chi);
    return y * y;
  }
};

/// The size squared, V = factor D.
template <int Dim>
struct SizeSquaredEnergy
{
  double factor2; ///< factor^2
  Packet value(Packet, Packet D) const { return this->factor2 * D * D; }
  void terms(Packet, Packet D, EnergyTerms& e) const
  {
    e.f = this->factor2 * D * D;
    e.fD = 2.0 * this->factor2 * D;
    e.fDD = broadcast(2.0 * this->factor2);
    e.fN = e.fNN = e.fND = Packet{};
  }
};
}
#endif
