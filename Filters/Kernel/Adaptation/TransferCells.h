// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TransferCells.h
 * @brief Transfers cell values to another mesh as means over the overlapped cells.
 * Internal: not installed.
 */
#ifndef tautline_TransferCells_h
#define tautline_TransferCells_h

#include "TransferOverlaps.h"
#include "TransferTotals.h"

#include <vector>

namespace tautline
{
/// The shares of source cells in each target cell.
struct CellShares
{
  std::vector<Index> starts; ///< of the shares of each cell of the target, and the end
  std::vector<Index> cells;  ///< of the source, in increasing order
  std::vector<double> parts; ///< the sum over a cell of the target is 1
  std::vector<Vec3> centers; ///< of the intersections; empty unless requested
};

/// @param centers whether centers are needed
CellShares cellShares(const TransferMesh& target, const TransferMesh& source,
  const TransferOverlaps& overlaps, bool centers, int threads);

/// The cell of the source with the largest share in each cell of the target; -1 without any.
std::vector<Index> largestShares(const CellShares& shares);

/**
 * @class tautline::CellTransfer
 * @brief Values of a component on the cells of the target.
 */
class CellTransfer
{
public:
  /// @param shares with centers if fields are linear
  /// @param others per cell of the target: the source cell that provides the value if it has no
  /// share
  CellTransfer(const TransferMesh& target, const TransferMesh& source, const CellShares& shares,
    const std::vector<Index>& others, int threads);

  /// @param field one value per cell of the source
  BoundedValues apply(const std::vector<double>& field) const;

private:
  void reconstruct(
    Index cell, const std::vector<double>& field, Vec3& gradient, double& low, double& high) const;

  const TransferMesh &Target, &Source;
  const CellShares& Shares;
  const std::vector<Index>& Others;
  int Threads;
  std::vector<Index> AroundStarts, Around; ///< the cells at each point of the source
};
}
#endif
