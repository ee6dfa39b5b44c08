// SPDX-License-Identifier: BSD-3-Clause
#include "WarpOptions.h"

namespace tautline
{
namespace
{
/// The classes of methods that the code distinguishes.
struct MethodTraits
{
  bool known = false, finiteElements = false, anisotropic = false, untangles = false;
};

/// A switch without a default: the compiler reports a method that is missing here.
MethodTraits traitsOf(WarpMethod method)
{
  MethodTraits traits;
  switch (method)
  {
    case WarpMethod::Hybrid:
      traits.anisotropic = traits.untangles = true;
      traits.known = traits.finiteElements = true;
      break;
    case WarpMethod::AnisotropicFemwarp:
      traits.anisotropic = true;
      traits.known = traits.finiteElements = true;
      break;
    case WarpMethod::FemwarpUntangling:
      traits.untangles = true;
      traits.known = traits.finiteElements = true;
      break;
    case WarpMethod::Femwarp:
    case WarpMethod::SmallStepFemwarp:
    case WarpMethod::IterativeStiffening:
    case WarpMethod::JacobianStiffening:
    case WarpMethod::Biharmonic:
      traits.known = traits.finiteElements = true;
      break;
    case WarpMethod::InverseDistance:
    case WarpMethod::RadialBasis:
    case WarpMethod::WeightedLaplacian:
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

bool usesFiniteElements(WarpMethod method)
{
  return traitsOf(method).finiteElements;
}

bool isAnisotropic(WarpMethod method)
{
  return traitsOf(method).anisotropic;
}

bool untangles(WarpMethod method)
{
  return traitsOf(method).untangles;
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
