// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file GlobalFunctionOnRanks.h
 * @brief The scalarized objective of a mesh on several ranks as a function of all free points at
 * once. Internal: not installed.
 */
#ifndef tautline_GlobalFunctionOnRanks_h
#define tautline_GlobalFunctionOnRanks_h

#include "GlobalFunction.h"
#include "tautline/Objectives/BlockJacobiMultigrid.h"

namespace tautline
{
/**
 * @class tautline::GlobalFunctionOnRanks
 * @brief A rank's variables are those of the free points that it owns. All cells at these are here,
 * so that gradients and rows of the Hessian need no sums over ranks: the displacements of the
 * points about them are received before. Values are sums over the owned cells of all ranks, rounded
 * once. All methods but size() are collective.
 *
 * Preconditioners do not depend on the ranks, to rounding: diagonal blocks, and BlockJacobiMultigrid
 * for Newton's method with the positive semidefinite part of the Hessian.
 */
class GlobalFunctionOnRanks : public SmoothFunction
{
public:
  /**
   * @param problem of the local part; null on a rank without cells
   * @param scalarizer the same on all ranks, of as many objectives
   * @param coordinates of a point: 2 in a plane, else 3
   */
  GlobalFunctionOnRanks(const DistributedMesh& mesh, const MatrixRows& rows,
    OptimizationProblem* problem, const Scalarizer& scalarizer, std::size_t objectives,
    Optimizer optimizer, int coordinates, int threads);

  std::size_t size() const override;
  double valueAndGradient(const double* x, double* gradient) override;
  /// Throws MemoryError on all ranks where the matrix does not fit into the memory of one.
  void linearize(const double* x) override;
  bool precondition(const double* r, double* z) override;
  bool hessianTimes(const double* d, double* product) override;

  /// Moves the points of the problem, and its simplices, to x.
  void put(const double* x);

private:
  double sum(const std::vector<double>& terms);
  void makeMatrix();

  const DistributedMesh& TheMesh;
  const MatrixRows& Rows;
  const Scalarizer& TheScalarizer;
  int Size;
  bool Newton, Convex = false, Allowed = true;
  std::unique_ptr<GlobalFunction> Local;
  std::vector<double> All, Product; ///< of the rows of all points here
  std::vector<double> Terms;        ///< of the cells
  std::vector<double> Slopes;
  BlockJacobiMultigrid Grids;
};
}
#endif
