/**
 * @file Energies.h
 * @brief Energies f(N, D) of a simplex, N = |T|^2 and D = det T (see SimplexMesh.h): what the fast
 * optimizers minimise. Internal: not installed.
 */
#ifndef tautline_Energies_h
#define tautline_Energies_h

#include "Patch.h"

namespace tautline
{
/**
 * @brief The inverse mean ratio N / (n D^(2/n)) to the power 1 or 2; metrics that are its powers or
 * reciprocals (mean ratio, mu_2, mu_303) have the same.
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
}
#endif
