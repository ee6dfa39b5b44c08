// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InfeasibleSimplices.h
 * @brief The simplices that no position of their single free vertex makes valid.
 * Internal: not installed.
 */
#ifndef tautline_InfeasibleSimplices_h
#define tautline_InfeasibleSimplices_h

#include "TangledMesh.h"

namespace tautline
{
/**
 * @brief Finds simplices that cannot all be valid at the current positions of the fixed vertices:
 * among the simplices with a single free vertex, the most violated are selected until the vertex
 * has a position that is valid for the rest. For Dim 2 and 3.
 * @param x VertexStride coordinates per vertex
 * @param active one flag per free vertex: nonzero to check its simplices
 * @return simplices that are not yet marked as infeasible
 */
template <int Dim>
std::vector<std::int32_t> findInfeasible(
  const TangledMesh<Dim>& tangled, const double* x, const std::vector<unsigned char>& active);
}
#endif
