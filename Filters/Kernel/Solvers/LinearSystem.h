// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LinearSystem.h
 * @brief The sparse linear system passed to the solvers, on one MPI rank or several.
 */
#ifndef tautline_LinearSystem_h
#define tautline_LinearSystem_h

#include "SparseMatrix.h"

#include <memory>

namespace tautline
{
class PointNumbering;

/// A sparse matrix with the properties that determine the method.
struct LinearSystem
{
  /**
   * @brief On one rank: the matrix. On several: the sum of the contributions of this rank's cells,
   * with rows and columns by this rank's unknowns: blockSize for each point to which `numbering`
   * assigns a row, in order of points. Rows of points shared with other ranks are summed.
   */
  const SparseMatrix* matrix = nullptr;
  /// On several ranks: whether one rank has all entries of a row and the others none, so that
  /// nothing needs to be summed. Requires less memory.
  bool wholeRows = false;
  int blockSize = 1; ///< unknowns per point
  bool symmetric = true;
  bool positiveDefinite = true;
  /// Coordinates of the points of the unknowns, 3 per point, in the axes of the unknowns (with
  /// blockSize 2, the first two are used): provides the rigid body modes for multigrid; or null.
  const double* coordinates = nullptr;
  /// The global numbering of this rank's points; null: one rank.
  const PointNumbering* numbering = nullptr;
  /// Owns the matrix and the coordinates, because a setup abandoned at its time limit continues in
  /// the background and reads them; null: a solver with limits copies them.
  std::shared_ptr<const void> owner;
};
}
#endif
