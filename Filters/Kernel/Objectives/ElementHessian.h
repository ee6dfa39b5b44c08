/**
 * @file ElementHessian.h
 * @brief The second derivatives of an objective, element by element, made positive semidefinite.
 * Internal: not installed.
 *
 * An element does not change under translation, so that its Hessian acts on the vectors from its
 * first node to the others: 9 x 9 numbers for a tetrahedron, of which one half is stored. They are
 * central differences of the analytic gradients; eigenvalues below 0 are replaced by 0.
 */
#ifndef tautline_ElementHessian_h
#define tautline_ElementHessian_h

#include "ObjectiveSum.h"

namespace tautline
{
class TAUTLINE_KERNEL_EXPORT ElementHessian
{
public:
  /**
   * @brief Takes the memory it will need; the Hessians are 0 until assemble().
   * @param objective must outlive this
   * @param project off: leaves negative eigenvalues as they are (for tests)
   */
  explicit ElementHessian(const ObjectiveSum& objective, bool project = true);
  ~ElementHessian();

  /**
   * @brief Makes the Hessians at the points of the mesh's view. Elements at fault, and elements
   * with edges of length 0, get 0. For PowerMean and Maximum the rank-one term that couples all
   * elements is left out: the derivative of the slopes with the mean or the maximum itself held
   * fixed.
   */
  void assemble();

  /// Adds scale times the product with d, both 3 x numberOfPoints. Bitwise the same for any number
  /// of threads.
  void addTimes(double scale, const double* d, double* product) const;

  /// Adds scale times the 3 x 3 diagonal block of each point: xx xy xz yy yz zz.
  void addDiagonal(double scale, double* blocks) const;

  /// Bytes this takes for an objective.
  static std::size_t memory(const ObjectiveSum& objective);

private:
  struct Storage;
  const ObjectiveSum& TheObjective;
  bool Project;
  std::unique_ptr<Storage> Values;
};

/**
 * @brief Adds scale times the diagonal blocks at the points of the mesh's view without keeping
 * Hessians: as ElementHessian without projection, and several times as fast as with it.
 */
TAUTLINE_KERNEL_EXPORT void addDiagonalBlocks(
  const ObjectiveSum& objective, double scale, double* blocks);

/**
 * @brief Replaces symmetric 3 x 3 blocks (6 numbers each, as above) by positive definite inverses,
 * in place: of |eigenvalue|, and of a thousandth of the largest where one is smaller. Blocks of
 * zeros become the identity.
 */
TAUTLINE_KERNEL_EXPORT void invertBlocks(double* blocks, Index count, int threads);

/// z = blocks times r, 3 entries per block; z may be r.
TAUTLINE_KERNEL_EXPORT void applyBlocks(
  const double* blocks, Index count, int threads, const double* r, double* z);
}
#endif
