// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ErrorNorms.h
 * @brief The distance of a finite element solution from a known function.
 */
#ifndef tautline_ErrorNorms_h
#define tautline_ErrorNorms_h

#include "EllipticSystem.h"
#include "tautline/SolversExport.h"

#include <array>
#include <functional>

namespace tautline
{
/**
 * @brief Norms of the difference between a solution and a known function, with four Gauss points in
 * each direction, or six for quadratic elements. Collective.
 * @param exact writes `components` values and their gradients (3 per component; on a surface, their
 * normal parts are ignored) at a point. It is called on this thread only.
 * @return { L2 norm of the error, L2 norm of the error of the gradient }
 */
TAUTLINE_SOLVERS_EXPORT std::array<double, 2> errorNorms(const EllipticSystem& system,
  const EllipticSolution& solution,
  const std::function<void(const Vec3&, double* value, double* gradient)>& exact);
}
#endif
