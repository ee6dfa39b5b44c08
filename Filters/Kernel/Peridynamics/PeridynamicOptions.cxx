// SPDX-License-Identifier: BSD-3-Clause
#include "PeridynamicOptions.h"

namespace tautline
{
double singularLimit(PeridynamicBasis basis, PeridynamicModel model)
{
  return (basis == PeridynamicBasis::Linear ? 4.0 : 3.0) +
    (model == PeridynamicModel::Elastic ? 2.0 : 0.0);
}

//------------------------------------------------------------------------------
Index numberOfFunctions(const HorizonMesh& mesh, PeridynamicBasis basis)
{
  return basis == PeridynamicBasis::Linear ? mesh.numberOfPoints()
    : basis == PeridynamicBasis::Constant  ? mesh.numberOfTriangles()
                                           : 3 * mesh.numberOfTriangles();
}
}
