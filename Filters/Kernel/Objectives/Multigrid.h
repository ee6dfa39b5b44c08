// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Multigrid.h
 * @brief A preconditioner for sparse symmetric positive definite matrices of small blocks:
 * algebraic multigrid by aggregation.
 * Internal: not installed.
 *
 * Rows are joined three times in pairs, along their strongest couplings, so that aggregates of up
 * to eight rows follow the directions in which stretched elements couple. The coarse matrix adds
 * the blocks of the rows of each aggregate (piecewise constant interpolation, because translations
 * are the near-kernel of the Hessian of an objective). The smoother is block Gauss-Seidel inside
 * fixed ranges of rows. Each coarse system is solved by at most two steps of flexible conjugate
 * gradients with the next coarser one as preconditioner (K-cycle). Sources: Y. Notay, "An
 * aggregation-based algebraic multigrid method", ETNA 37 (2010); Y. Notay and P. Vassilevski,
 * "Recursive Krylov-based multigrid cycles", Numer. Linear Algebra Appl. 15 (2008).
 */
#ifndef tautline_Multigrid_h
#define tautline_Multigrid_h

#include "GridRows.h"

#include "tautline/KernelExport.h"

#include <memory>
#include <vector>

namespace tautline
{
/// y = A x.
TAUTLINE_KERNEL_EXPORT void multiply(
  const BlockMatrixView& a, int threads, const double* x, double* y);

/// A hierarchy of grids: Multigrid below, or the hierarchy for several ranks.
class GridHierarchy
{
public:
  virtual ~GridHierarchy() = default;
  /**
   * @brief Prepares apply() for a matrix, whose arrays must stay unchanged while apply() is used. A
   * few consecutive matrices of the same pattern share their aggregates.
   */
  virtual void build(const BlockMatrixView& matrix) = 0;
  /**
   * @brief z = M^-1 r, nearly linear and nearly symmetric, for use with flexible conjugate
   * gradients.
   * @param r, z size numbers for each row that this process owns
   */
  virtual void apply(const double* r, double* z) = 0;
};

class TAUTLINE_KERNEL_EXPORT Multigrid : public GridHierarchy
{
public:
  /// @param threads 0: all cores. The result does not depend on it, bitwise.
  explicit Multigrid(int threads);
  ~Multigrid() override;
  Multigrid(const Multigrid&) = delete;
  Multigrid& operator=(const Multigrid&) = delete;

  void build(const BlockMatrixView& matrix) override;
  void apply(const double* r, double* z) override;
  /// The same with at most two steps of flexible conjugate gradients, as on a coarse level.
  void solve(const double* r, double* z);

  struct Level;

private:
  template <int Dim>
  void buildLevels();
  template <int Dim>
  void refill();
  template <int Dim>
  void cycle(std::size_t level, const double* r, double* z);
  template <int Dim>
  void solveCoarse(std::size_t level);
  template <int Dim>
  void settle(const Level& level, double* z) const;

  int Threads, Size = 0, Reused = 0;
  bool Floating = false;                      ///< whether the matrix maps translations to 0
  std::vector<std::unique_ptr<Level>> Levels; ///< the finest first
};
}
#endif
