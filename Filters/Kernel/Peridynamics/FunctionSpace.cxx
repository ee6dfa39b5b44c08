// SPDX-License-Identifier: BSD-3-Clause
#include "FunctionSpace.h"

namespace tautline
{
FunctionSpace::FunctionSpace(
  const HorizonMesh& mesh, const PlanarTriangles& triangles, const PeridynamicOptions& options)
  : basis(options.basis)
  , functions(numberOfFunctions(mesh, options.basis))
{
  constexpr Index unused = -2, given = -1, unknown = 0;
  this->unknownOf.assign(this->functions, unused);
  this->low.assign(this->functions, { 1e300, 1e300 });
  this->high.assign(this->functions, { -1e300, -1e300 });
  for (Index t = 0; t < triangles.size(); ++t)
  {
    for (int k = 0; k < this->perTriangle(); ++k)
    {
      const Index f = this->function(triangles, t, k);
      // A vertex of any interaction layer triangle is given, including the boundary of the domain.
      const bool byPoint = this->basis == PeridynamicBasis::Linear && !mesh.givenPoints.empty();
      const bool fixed = options.constrained &&
        (byPoint ? mesh.givenPoints[f] != 0 : mesh.layer[triangles.source(t)] != 0);
      this->unknownOf[f] = fixed || this->unknownOf[f] == given ? given : unknown;
      this->low[f] = { std::min(this->low[f][0], triangles.low[t][0]),
        std::min(this->low[f][1], triangles.low[t][1]) };
      this->high[f] = { std::max(this->high[f][0], triangles.high[t][0]),
        std::max(this->high[f][1], triangles.high[t][1]) };
    }
  }
  for (Index f = 0; f < this->functions; ++f)
  {
    if (this->unknownOf[f] == unused)
    {
      this->low[f] = this->high[f] = triangles.low[0]; // anywhere
    }
    if (this->unknownOf[f] == unknown)
    {
      this->unknownOf[f] = this->unknowns++;
      this->functionOf.push_back(f);
    }
  }
  if (this->unknowns == 0)
  {
    throw Error("there is no unknown: every function belongs to the interaction layer. Use a "
                "larger domain or smaller elements");
  }
}

//------------------------------------------------------------------------------
std::vector<char> FunctionSpace::trianglesWithUnknowns(const PlanarTriangles& triangles) const
{
  std::vector<char> result(triangles.size(), 0);
  for (Index t = 0; t < triangles.size(); ++t)
  {
    for (int k = 0; k < this->perTriangle(); ++k)
    {
      result[t] |= this->unknownOf[this->function(triangles, t, k)] >= 0;
    }
  }
  return result;
}
}
