// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PeridynamicSolve.h
 * @brief Solves nonlocal (peridynamic) systems by conjugate gradients with specialized
 * preconditioners: an answer to the open question of dissertation section 4.6.
 *
 * On waves of length 2 pi / q, the form of an integrable kernel acts like min(c q^2, C), where c
 * comes from the local limit and C is of order delta^-2: like the local operator on waves longer
 * than the horizon, and like a mass matrix on shorter ones. Its condition number is C over the
 * smallest c q^2. The inverse is therefore close to the sum of the inverses of both,
 *
 *     B = Q + P S P^T                                                  (LocalMultigrid)
 *     B = P S P^T + (I - P S P^T A) Q (I - A P S P^T)                  (TwoLevel)
 *
 * where Q is the inverse of a mass matrix or a diagonal (MassSmoother.h), S is an approximate
 * inverse on a space of long waves, and P is the interpolation from it. The local operator alone
 * would be a poor preconditioner for an integrable kernel: on the shortest waves, it is larger by
 * (delta / h)^2.
 * - LocalMultigrid: S is one cycle of algebraic multigrid (BoomerAMG) for the local limit in linear
 *   elements on the same triangles (LocalLimit.h).
 * - TwoLevel: S is the inverse of P^T A P, with P bilinear interpolation from a square grid with
 *   cells of half the horizon, but at least one and a half elements, and fewer elements for more
 *   singular kernels: above p = 2 (elastic: 4), the diagonal must handle all waves shorter than the
 *   grid, on which A grows like q^(p-2).
 *
 * A nearly incompressible material (StateBased, Poisson's ratio near 1/2) resists changes of volume
 * that are averaged over a horizon: lambda / mu times as much as shear on waves longer than about
 * the horizon, and not at all on shorter ones. Q is too large on the former. The sum keeps this
 * error; the product of TwoLevel removes it, because the grid resolves these waves, so that its
 * iterations hardly increase up to a Poisson's ratio of 0.49; closer to 1/2 they do. The iterations
 * of LocalMultigrid increase earlier, even with an exact S: linear elements of the local limit
 * lock, while the average over the horizon does not.
 *
 * B is symmetric positive definite. An iteration needs one product with A, as with the diagonal
 * alone; TwoLevel needs two additional products with P^T A, which has fewer entries than A.
 *
 * Source: J. Xu, SIAM Review 34 (1992) 581-613 (additive methods); J. Xu, Computing 56 (1996)
 * 215-235 (auxiliary spaces); J. Mandel, Comm. Numer. Methods Eng. 9 (1993) 233-241 (the product);
 * R. Nabben, C. Vuik, SIAM J. Numer. Anal. 42 (2004) 1631-1647 (a product instead of the sum).
 */
#ifndef tautline_PeridynamicSolve_h
#define tautline_PeridynamicSolve_h

#include "PeridynamicOptions.h"
#include "tautline/Solvers/Lanczos.h"
#include "tautline/SolversExport.h"

#include <memory>

namespace tautline
{
/// The preconditioners. The numbers are stable: ParaView state files hold them.
enum class NonlocalPreconditioner : int
{
  Jacobi = 0,         ///< the diagonal
  LocalMultigrid = 1, ///< Q and algebraic multigrid for the local limit
  TwoLevel = 2        ///< a coarse grid, solved exactly, and Q for the remainder
};

/// "Jacobi", "AMG of the local limit", "two-level".
TAUTLINE_SOLVERS_EXPORT const char* nameOf(NonlocalPreconditioner preconditioner);

/**
 * @class tautline::PeridynamicPreconditioner
 * @brief z = B r for a system.
 */
class TAUTLINE_SOLVERS_EXPORT PeridynamicPreconditioner
{
public:
  /**
   * @brief Sets up the preconditioner.
   * @param options the options with which the system was assembled
   * @param system must outlive the preconditioner
   *
   * Throws Error, with the remedy, if the matrix is not positive definite or, except for Jacobi, if
   * no function is given, so that the local operator is singular.
   */
  PeridynamicPreconditioner(const HorizonMesh& mesh, const PeridynamicOptions& options,
    const PeridynamicSystem& system, NonlocalPreconditioner preconditioner);
  ~PeridynamicPreconditioner();
  PeridynamicPreconditioner(const PeridynamicPreconditioner&) = delete;
  PeridynamicPreconditioner& operator=(const PeridynamicPreconditioner&) = delete;

  void apply(const double* r, double* z);
  /// The number of rows of the local or coarse matrix; 0: there is none, as for Jacobi or a domain
  /// without free vertices.
  Index coarseRows() const;

private:
  struct State;
  std::unique_ptr<State> Impl;
};

/**
 * @brief Solves A x = b from x = 0, to a relative residual of `tolerance`.
 * @param load b, for example sourceLoad() minus the constraintLoad of the system
 *
 * Throws Error in the same cases as the constructor of PeridynamicPreconditioner and
 * solveConjugateGradients().
 */
TAUTLINE_SOLVERS_EXPORT SolveReport solvePeridynamics(const HorizonMesh& mesh,
  const PeridynamicOptions& options, const PeridynamicSystem& system,
  NonlocalPreconditioner preconditioner, const std::vector<double>& load, std::vector<double>& x,
  double tolerance = 1e-10, const LanczosOptions& limits = {});
}
#endif
