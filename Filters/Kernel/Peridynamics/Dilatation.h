// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Dilatation.h
 * @brief The dilatation and the strain energy of elastic nonlocal models.
 *
 * The linear ordinary state-based model (linear peridynamic solid) in the plane has the strain
 * energy density
 *
 *     W(x) = (lambda + mu) / 2 theta^2 + alpha / 2 int omega (e - theta |xi| / 2)^2 dy,
 *     theta(x) = 2 / m int omega |xi| e dy,  m = int omega |xi|^2 dy,  alpha = 8 mu / m,
 *
 * with xi = y - x in the disk of radius delta, e = xi . (u(y) - u(x)) / |xi| the extension of a
 * bond and omega = |xi|^2 k(|xi|) the influence function of the tensor kernel of Peridynamics.h.
 * For a homogeneous strain eps, theta is its trace, and W is the energy density of Hooke's law.
 * Expanded,
 *
 *     W = (lambda - mu) / 2 theta^2 + 4 mu / m int k (xi . (u(y) - u(x)))^2 dy:
 *
 * the bond-based model, with mu = localModulus() and lambda = mu, plus the square of the
 * dilatation. m is taken over the whole disk even near the end of a mesh: a free surface is softer
 * than the interior, as in the bond-based model. W is at least 0 for every motion.
 *
 * Source: S. A. Silling, M. Epton, O. Weckner, J. Xu, E. Askari, J. Elasticity 88 (2007) 151-184;
 * S. A. Silling, J. Elasticity 99 (2010) 85-111 (linearized); Q. V. Le, W. K. Chan, J. Schwartz,
 * Int. J. Numer. Methods Eng. 98 (2014) 547-561 (in the plane).
 */
#ifndef tautline_Dilatation_h
#define tautline_Dilatation_h

#include "PeridynamicOptions.h"
#include "tautline/SolversExport.h"

namespace tautline
{
/// Per triangle, at the centroid; 0 in the interaction layer.
struct PeridynamicStrain
{
  std::vector<double> dilatation;    ///< theta
  std::vector<double> energyDensity; ///< W, per area
};

/**
 * @brief The strain of a motion in an elastic model.
 * @param values two per function of the basis, including given functions
 *
 * Throws Error for the scalar model, for a wrong number of values, and for meshes that
 * assemblePeridynamics() rejects.
 */
TAUTLINE_SOLVERS_EXPORT PeridynamicStrain peridynamicStrain(
  const HorizonMesh& mesh, const PeridynamicOptions& options, const std::vector<double>& values);
}
#endif
