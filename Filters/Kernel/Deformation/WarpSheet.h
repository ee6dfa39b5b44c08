// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpSheet.h
 * @brief The elastic sheet: linear elasticity of a surface in space.
 * Internal: not installed.
 */
#ifndef tautline_WarpSheet_h
#define tautline_WarpSheet_h

#include "tautline/Elliptic/FiniteElements.h"

namespace tautline
{
/**
 * @brief The stiffness matrix of a surface in space with three displacements per point: plane
 * strain in the plane of each cell, and the shear modulus times the Laplacian normal to it, which
 * is elasticity for displacements that are constant along the normal. Unknown 3 p + k is component
 * k of point p. Quadrilaterals are projected onto their mean planes.
 */
TAUTLINE_SOLVERS_EXPORT SparseMatrix sheetMatrix(
  const Mesh& surface, const ElasticOperator& pde, const AssemblyOptions& options);
}
#endif
