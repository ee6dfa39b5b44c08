// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Multigrid.h
 * @brief A preconditioner for sparse symmetric positive definite matrices of small blocks:
 * algebraic multigrid by aggregation. Internal: not installed.
 *
 * Rows are joined three times in pairs, along their strongest couplings, so that aggregates of up
 * to eight rows follow the directions in which stretched elements couple. The coarse matrix adds
 * the blocks of the rows of each aggregate (piecewise constant interpolation: what the Hessian of
 * an objective leaves unpunished is translation). The smoother is block Gauss-Seidel inside fixed
 * ranges of rows. Each coarse system is solved by at most two steps of flexible conjugate gradients
 * with the next coarser one as preconditioner (K-cycle). Sources: Y. Notay, "An aggregation-based
 * algebraic multigrid method", ETNA 37 (2010); Y. Notay and P. Vassilevski, "Recursive
 * Krylov-based multigrid cycles", Numer. Linear Algebra Appl. 15 (2008).
 */
#ifndef tautline_Multigrid_h
#define tautline_Multigrid_h

#include "tautline/Core/Types.h"

#include "tautline/KernelExport.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace tautline
{
/// What the hierarchies of one process and of several ranks have in common.
namespace multigrid
{
constexpr int pairings = 3;            ///< of rows, from a level to the next
constexpr double slowCoarsening = 0.8; ///< ratio of rows beyond which no coarser level is made
constexpr double floatingSum = 1e-10;  ///< of a row, relative to the diagonals near it: rounding
constexpr int rebuildAfter = 4;        ///< matrices of one pattern, after which rows are aggregated
}

/// A sparse matrix of Size x Size blocks with a symmetric pattern, on arrays of the caller.
struct BlockMatrixView
{
  int size = 0;                            ///< of a block: 2 or 3
  Index rows = 0;                          ///< of blocks
  const std::int32_t* starts = nullptr;    ///< rows + 1 places
  const std::int32_t* columns = nullptr;   ///< of each place, ascending within a row
  const std::int32_t* diagonals = nullptr; ///< place of the diagonal block of each row
  const double* blocks = nullptr;          ///< size x size numbers a place, row by row
};

/// y = A x.
TAUTLINE_KERNEL_EXPORT void multiply(
  const BlockMatrixView& a, int threads, const double* x, double* y);

/// A hierarchy of grids: Multigrid below, or the one of several ranks.
class GridHierarchy
{
public:
  virtual ~GridHierarchy() = default;
  /**
   * @brief Prepares apply() for a matrix, whose arrays must stay as they are while apply() is used.
   * Matrices of the same pattern that follow each other share their aggregates, a few at a time.
   */
  virtual void build(const BlockMatrixView& matrix) = 0;
  /**
   * @brief z = M^-1 r, nearly linear and nearly symmetric: for flexible conjugate gradients.
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
  bool Floating = false;                      ///< the matrix maps translations to 0
  std::vector<std::unique_ptr<Level>> Levels; ///< the finest first
};
}
#endif
