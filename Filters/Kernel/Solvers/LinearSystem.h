// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file LinearSystem.h
 * @brief A sparse linear system as the solvers take it, on one MPI rank or several.
 */
#ifndef tautline_LinearSystem_h
#define tautline_LinearSystem_h

#include "SparseMatrix.h"

#include <memory>

namespace tautline
{
class PointNumbering;

/// A sparse matrix with the properties that choose a method.
struct LinearSystem
{
  /**
   * @brief On one rank the matrix. On several: the sum of the contributions of this rank's cells,
   * rows and columns by this rank's own unknowns: blockSize for each point that `numbering` gives a
   * row, in order of point. Those of points shared with other ranks are added up.
   */
  const SparseMatrix* matrix = nullptr;
  /// On several ranks: whether one rank has all entries of a row, and the others none, so that
  /// nothing is to be added up. Needs less memory.
  bool wholeRows = false;
  int blockSize = 1; ///< unknowns per point
  bool symmetric = true;
  bool positiveDefinite = true;
  /// Coordinates of the points of the unknowns, 3 per point, in the axes of the unknowns (with
  /// blockSize 2 the first two count): gives multigrid the rigid body modes; or null.
  const double* coordinates = nullptr;
  /// How this rank's points are numbered among all; null: one rank.
  const PointNumbering* numbering = nullptr;
  /// Owns the matrix and the coordinates. A set-up that is given up at its time limit goes on in
  /// the background and reads them; null: a solver with limits copies them.
  std::shared_ptr<const void> owner;
};
}
#endif
