// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LocalLimit.h
 * @brief The local operator to which a nonlocal operator converges as the horizon tends to 0, in
 * linear finite elements on the same triangles.
 *
 * For a smooth u, u(x) - u(y) is the gradient times x - y up to higher orders, so that a(u, u) of
 * Peridynamics.h becomes the integral of
 *
 *     s pi / 2 int_0^delta r^3 k(r) dr |grad u|^2                              (scalar)
 *     mu (2 eps:eps + (tr eps)^2),  mu = s pi / 8 int_0^delta r^5 k(r) dr      (elastic)
 *
 * with eps the strain: Lame's constants are equal, as in every bond-based model (a Poisson ratio of
 * 1/3 in plane stress). The state-based model has the same mu, and lambda (tr eps)^2 with lambda /
 * mu of lameRatio(). With k = r^-p the scalar factor is pi / (2 (4-p)).
 *
 * Source: S. A. Silling, R. B. Lehoucq, J. Elasticity 93 (2008) 13-37; dissertation, sections 4.2
 * and 4.5.3.
 */
#ifndef tautline_LocalLimit_h
#define tautline_LocalLimit_h

#include "PeridynamicOptions.h"
#include "tautline/SolversExport.h"

namespace tautline
{
/// The factor of |grad u|^2, or mu.
TAUTLINE_SOLVERS_EXPORT double localModulus(const PeridynamicOptions& options);

/// A linear map from the functions of a coarse space to the unknown functions of a fine one.
struct Prolongation
{
  Index coarse = 0; ///< functions
  /// Fine function u is the sum of weights[k] times columns[k], k from offsets[u] to
  /// offsets[u + 1] - 1.
  std::vector<Index> offsets = { 0 };
  std::vector<std::int32_t> columns;
  std::vector<double> weights;

  Index fine() const { return static_cast<Index>(this->offsets.size()) - 1; }
};

/// The local limit, and the map from its functions to the functions of the nonlocal system.
struct LocalLimit
{
  /// Stiffness matrix of the linear elements at the free vertices, system.components rows each;
  /// symmetric; positive definite if values are given.
  SparseMatrix matrix;
  /// The identity for the linear basis; a constant function is the mean over the corners of its
  /// triangle, a function of the discontinuous basis is the value at its corner.
  Prolongation prolongation;
};

/**
 * @brief Assembles the local limit of a system. Vertices of triangles of the interaction layer (or
 * givenPoints, linear basis) have the value 0.
 * @param options the options with which the system was assembled
 */
TAUTLINE_SOLVERS_EXPORT LocalLimit localLimit(
  const HorizonMesh& mesh, const PeridynamicOptions& options, const PeridynamicSystem& system);
}
#endif
