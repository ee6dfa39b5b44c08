// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file InfeasibleSimplices.h
 * @brief The simplices that no place of their one free vertex makes valid.
 * Internal: not installed.
 */
#ifndef tautline_InfeasibleSimplices_h
#define tautline_InfeasibleSimplices_h

#include "TangledMesh.h"

namespace tautline
{
/**
 * @brief Finds simplices that cannot all be valid while the fixed vertices are where they are: of
 * those with a single free vertex, the most violated are taken until a place of the vertex is left
 * for the rest. For Dim 2 and 3.
 * @param x VertexStride coordinates per vertex
 * @param active one flag per free vertex: nonzero to check its simplices
 * @return simplices that are not infeasible yet
 */
template <int Dim>
std::vector<std::int32_t> findInfeasible(
  const TangledMesh<Dim>& tangled, const double* x, const std::vector<unsigned char>& active);
}
#endif
