// SPDX-License-Identifier: BSD-3-Clause
#include "Perturb.h"

#include "Perturber.h"
#include "tautline/Mesh/CoordinateFrame.h"

namespace tautline
{
//------------------------------------------------------------------------------
Perturbation perturb(const Mesh& mesh, const unsigned char* fixed, const PerturbOptions& options)
{
  checkPerturbation(mesh, options);
  requireOrdinaryScale(mesh.view(), "Perturbation");
  Perturber perturber(mesh, fixed, options);
  perturber.move();
  perturber.tangle();
  return perturber.finish();
}
}
