// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PointNumbering.h
 * @brief Global numbers of the points of a mesh distributed over MPI ranks, and sums over ranks.
 */
#ifndef tautline_PointNumbering_h
#define tautline_PointNumbering_h

#include "tautline/Core/Communicator.h"
#include "tautline/Mesh/Mesh.h"
#include "tautline/SolversExport.h"

#include <memory>

namespace tautline
{
/**
 * @class tautline::PointNumbering
 * @brief Each global point is owned by one rank, the lowest that has it; rows of a rank are
 * contiguous.
 *
 * All methods are collective unless they are const accessors.
 */
class TAUTLINE_SOLVERS_EXPORT PointNumbering
{
public:
  /**
   * @param globalIds one id per local point, the same on all ranks for the same point; any
   * nonnegative numbers in any order; null only on one rank
   * @param used one flag per local point, nonzero = has a row (a point that is in a cell and is not
   * eliminated); null: all. The ranks must agree on shared points.
   *
   * Throws Error, on all ranks, for ids that are missing, negative or twice on one rank.
   */
  PointNumbering(Communicator communicator, Index points, const Index* globalIds,
    const unsigned char* used = nullptr);
  ~PointNumbering();
  PointNumbering(const PointNumbering&) = delete;
  PointNumbering& operator=(const PointNumbering&) = delete;

  Communicator communicator() const;
  int ranks() const;
  Index globalSize() const; ///< rows on all ranks
  Index firstRow() const;   ///< first row of this rank
  Index ownedRows() const;
  const std::vector<Index>& rows() const; ///< the row of each local point; -1 if it has none
  bool owned(Index point) const;

  /// Replaces `components` values per local point with a row by their sums over all ranks; others
  /// are unchanged.
  void sum(double* values, int components) const;
  /// Nonzero flags of points with a row become nonzero on every rank that has the point.
  void either(unsigned char* flags) const;

  double sum(double value) const;
  double maximum(double value) const;
  Index sum(Index value) const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> Impl;
};

/**
 * @brief The points of edges (2D) or faces (3D) that belong to exactly one cell (or more than two)
 * on all ranks; for quadratic triangles and tetrahedra, including the middle nodes of edges. Cells
 * with skip flags (ghosts) are ignored. For linear cells on one rank, the result of
 * Mesh::boundary(). Collective.
 * @param globalIds as above; null on one rank
 */
TAUTLINE_SOLVERS_EXPORT std::vector<unsigned char> globalBoundaryPoints(
  const Mesh& mesh, Communicator communicator, const Index* globalIds, const unsigned char* skip);
}
#endif
