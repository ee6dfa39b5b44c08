// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FunctionSpace.h
 * @brief The basis functions of a nonlocal discretization.
 * Internal: not installed.
 */
#ifndef tautline_FunctionSpace_h
#define tautline_FunctionSpace_h

#include "PeridynamicOptions.h"
#include "PeridynamicsGeometry.h"

namespace tautline
{
/// The functions of a basis: the unknown ones, and the boxes around their supports.
struct FunctionSpace
{
  PeridynamicBasis basis;
  Index functions = 0, unknowns = 0;
  std::vector<Index> unknownOf, functionOf;
  std::vector<Vec2> low, high; ///< boxes around the supports of the functions

  FunctionSpace(
    const HorizonMesh& mesh, const PlanarTriangles& triangles, const PeridynamicOptions& options);
  /// Per triangle, whether one of its functions is unknown.
  std::vector<char> trianglesWithUnknowns(const PlanarTriangles& triangles) const;
  int perTriangle() const { return this->basis == PeridynamicBasis::Constant ? 1 : 3; }
  Index function(const PlanarTriangles& triangles, Index t, int k) const
  {
    return this->basis == PeridynamicBasis::Constant ? triangles.source(t)
      : this->basis == PeridynamicBasis::Linear      ? triangles.triangles[t][k]
                                                     : triangles.sources[t][k];
  }
};
}
#endif
