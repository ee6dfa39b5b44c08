// SPDX-License-Identifier: BSD-3-Clause
#include "WarpOptions.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
/// The classes of methods that the code distinguishes.
struct MethodTraits
{
  bool known = false, anisotropic = false, untangles = false;
};

/// A switch without a default, so that the compiler reports a missing method.
MethodTraits traitsOf(WarpMethod method)
{
  MethodTraits traits;
  switch (method)
  {
    case WarpMethod::Hybrid:
      traits.anisotropic = traits.untangles = true;
      traits.known = true;
      break;
    case WarpMethod::AnisotropicFemwarp:
      traits.anisotropic = true;
      traits.known = true;
      break;
    case WarpMethod::Femwarp:
    case WarpMethod::SmallStepFemwarp:
    case WarpMethod::IterativeStiffening:
    case WarpMethod::JacobianStiffening:
    case WarpMethod::Biharmonic:
    case WarpMethod::InverseDistance:
    case WarpMethod::RadialBasis:
    case WarpMethod::WeightedLaplacian:
    case WarpMethod::InverseDistanceRotations:
      traits.known = true;
      break;
    case WarpMethod::FemwarpUntangling:
    case WarpMethod::Automatic:
      traits.untangles = true;
      traits.known = true;
      break;
  }
  return traits;
}
}

//------------------------------------------------------------------------------
bool isKnown(WarpMethod method)
{
  return traitsOf(method).known;
}

bool isAnisotropic(WarpMethod method)
{
  return traitsOf(method).anisotropic;
}

bool untangles(WarpMethod method)
{
  return traitsOf(method).untangles;
}

bool isPositiveSemidefinite(const double* t)
{
  // The minors of a product of directions may be slightly below 0 by rounding.
  constexpr double rounding = 1e-12;
  const double size = std::max({ t[0], t[1], t[2] });
  const double det = t[0] * (t[1] * t[2] - t[4] * t[4]) - t[3] * (t[3] * t[2] - t[4] * t[5]) +
    t[5] * (t[3] * t[4] - t[1] * t[5]);
  return std::all_of(t, t + 6, [](double x) { return std::isfinite(x); }) && size >= 0 &&
    std::min({ t[0], t[1], t[2] }) >= 0 && t[0] * t[1] - t[3] * t[3] >= -rounding * size * size &&
    t[1] * t[2] - t[4] * t[4] >= -rounding * size * size &&
    t[0] * t[2] - t[5] * t[5] >= -rounding * size * size && det >= -rounding * size * size * size;
}

bool isKnown(WarpCoefficients coefficients)
{
  switch (coefficients)
  {
    case WarpCoefficients::DisplacementSums:
    case WarpCoefficients::PrincipalDirections:
    case WarpCoefficients::Manual:
    case WarpCoefficients::PerCell:
    case WarpCoefficients::LocalGradients:
      return true;
  }
  return false;
}

//------------------------------------------------------------------------------
OptimizeOptions hybridOptimization()
{
  OptimizeOptions options;
  options.stopping.maximumIterations = 50;
  options.stopping.relativeChange = 1e-3;
  return options;
}
}
