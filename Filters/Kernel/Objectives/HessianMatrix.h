// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HessianMatrix.h
 * @brief The Hessian of objectives over the free points of a mesh, as a sparse matrix of small
 * blocks with preconditioners.
 * Internal: not installed.
 *
 * A free point is a row of blocks of hessianAxes() coordinates: 2 x 2 numbers in a planar mesh, 3 x
 * 3 in a volume. Vectors have the same number of entries per free point. On a surface in space,
 * blocks are also 3 x 3 and contain the derivatives in the planes of the elements: restrict() each
 * point to its tangent plane.
 */
#ifndef tautline_HessianMatrix_h
#define tautline_HessianMatrix_h

#include "Multigrid.h"
#include "ObjectiveSum.h"

namespace tautline
{
/// The axes of the coordinates: right-handed for the elements, so that a mirrored mesh has mirrored
/// axes. The first two are in the plane of a planar mesh.
TAUTLINE_KERNEL_EXPORT std::array<Vec3, 3> coordinateAxes(const Mesh& mesh);

enum class HessianForm;

class TAUTLINE_KERNEL_EXPORT HessianMatrix
{
public:
  enum class Pattern
  {
    Full,    ///< blocks between all points that share an element
    Diagonal ///< the block of each point only
  };

  /**
   * @brief Allocates its memory; all blocks are 0.
   * @param mesh must outlive the matrix
   * @param rowOfPoint row of each point of the mesh, -1 for points that are not free
   * @param rows number of free points
   * @param threads 0: all cores. The result does not depend on it, bitwise. Throws Error if there
   * are more blocks than 32-bit integers can count.
   */
  HessianMatrix(const Mesh& mesh, std::vector<std::int32_t> rowOfPoint, Index rows, Pattern pattern,
    int threads);

  int blockSize() const { return this->Size; }
  /// The number of entries of a vector.
  std::size_t size() const { return static_cast<std::size_t>(this->Rows * this->Size); }
  /// The number of bytes of the blocks and their positions.
  std::size_t memory() const;

  void clear();
  /// Whether sums of blocks do not depend on the order of the cells, see OrderlessSums. Needs their
  /// memory twice during assembly.
  void setOrderless(bool orderless) { this->Orderless = orderless; }
  /**
   * @brief Adds scale times the Hessian of an objective, which may be indefinite, at the points of
   * the mesh view. Elements at fault and elements with edges of length 0 add 0. For PowerMean and
   * Maximum, the rank-one term that couples all elements is omitted: the derivative of the slopes
   * is taken with the mean or the maximum itself held fixed.
   */
  void add(const ObjectiveSum& objective, double scale);
  /**
   * @brief Adds scale times the positive semidefinite part of the Hessian of an objective with
   * hasConvexPart(); see ElementHessianBatches.h.
   */
  void addConvexPart(const ObjectiveSum& objective, double scale);
  /// Whether the positive semidefinite part is known: for sums of the inverse mean ratio or of its
  /// square.
  static bool hasConvexPart(const Objective& objective);
  static bool hasConvexPart(const ObjectiveSum& objective);
  /**
   * @brief Replaces the matrix by P A P for points that may only move in some directions, with the
   * mean of its diagonal in the other directions.
   * @param row of the point
   * @param projector the block of P for the point, row by row
   */
  void restrict(Index row, const double* projector);
  /// Adds a number to the diagonal of the diagonal block of a row.
  void addToDiagonal(Index row, double value);
  /// Prepares precondition(): call it when the matrix is complete.
  void factorize();
  /**
   * @brief As factorize(), for a positive semidefinite matrix of the full pattern: precondition()
   * is then a cycle of Multigrid.
   */
  void factorizeByMultigrid();
  /// The blocks, for another preconditioner.
  BlockMatrixView view() const;

  /// product = A d. Not for the diagonal pattern.
  void times(const double* d, double* product) const;
  /**
   * @brief z = M^-1 r, with M symmetric and positive definite: the diagonal blocks with the
   * absolute values of their eigenvalues; in volumes, with symmetric Gauss-Seidel inside fixed
   * ranges of rows, which does not pay off in planar meshes. After factorizeByMultigrid() it is
   * only nearly linear.
   */
  void precondition(const double* r, double* z);
  /// After factorize(): the diagonal blocks alone, which do not depend on the order of the rows.
  void preconditionByDiagonal(const double* r, double* z) const;

private:
  template <int Dim, int Size>
  void addBlocks(const ObjectiveSum& objective, double scale, HessianForm form);
  void addForm(const ObjectiveSum& objective, double scale, HessianForm form);
  template <int Dim>
  void invertDiagonal();
  template <int Dim>
  void multiply(const double* d, double* product) const;
  template <int Dim>
  void applyDiagonal(const double* r, double* z) const;
  template <int Dim>
  void sweep(const double* r, double* z) const;
  std::pair<std::vector<Index>, std::vector<Index>> cellsOfRows() const;
  void findPattern();
  void require(Index blocks) const;
  std::int32_t place(std::int32_t row, std::int32_t column) const;

  const Mesh& TheMesh;
  std::vector<std::int32_t> RowOfPoint;
  Index Rows;
  Pattern ThePattern;
  int Threads;
  int Size; ///< of a block
  bool Orderless = false;
  std::vector<std::int32_t> Starts, Columns; ///< of each row, ascending
  std::vector<std::int32_t> Diagonal;        ///< place of the diagonal block of each row
  std::vector<std::int32_t> Places;          ///< of the blocks of each cell; -1: none
  std::vector<Index> PlaceStarts;            ///< of each cell
  std::vector<double> Blocks;                ///< Size x Size numbers for each place
  std::vector<double> Inverse;               ///< of the diagonal blocks
  std::unique_ptr<Multigrid> Grids;          ///< null unless multigrid is the preconditioner
};
}
#endif
