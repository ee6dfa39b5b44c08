// SPDX-License-Identifier: BSD-3-Clause
#include "PeridynamicOptions.h"

namespace tautline
{
double singularLimit(PeridynamicBasis basis, PeridynamicModel model)
{
  return (basis == PeridynamicBasis::Linear ? 4.0 : 3.0) + (isElastic(model) ? 2.0 : 0.0);
}

//------------------------------------------------------------------------------
double interactionReach(const PeridynamicOptions& options)
{
  // A force depends on the dilatation within the horizon, which depends on motions within another.
  return (options.model == PeridynamicModel::StateBased ? 2.0 : 1.0) * options.horizon;
}

//------------------------------------------------------------------------------
double lameRatio(const PeridynamicOptions& options)
{
  if (options.model != PeridynamicModel::StateBased)
  {
    return 1.0;
  }
  const double nu = options.poissonRatio;
  return options.planeState == PlaneState::Strain ? 2.0 * nu / (1.0 - 2.0 * nu)
                                                  : 2.0 * nu / (1.0 - nu);
}

//------------------------------------------------------------------------------
Index numberOfFunctions(const HorizonMesh& mesh, PeridynamicBasis basis)
{
  return basis == PeridynamicBasis::Linear ? mesh.numberOfPoints()
    : basis == PeridynamicBasis::Constant  ? mesh.numberOfTriangles()
                                           : 3 * mesh.numberOfTriangles();
}
}
