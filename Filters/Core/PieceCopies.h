// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::PieceCopies
 * @brief Distinguishes copies of a point, whose positions differ by rounding, from points that have
 * the same global id by mistake.
 */
#ifndef tautline_PieceCopies_h
#define tautline_PieceCopies_h

#include "WholeMesh.h"

#include <vector>

class vtkDataSet;

namespace tautline
{
class PieceCopies
{
public:
  /// @param pieces must outlive this object
  explicit PieceCopies(const std::vector<vtkDataSet*>& pieces);

  /// Throws Error if two points with the same global id are not copies, see areCopies(), unless one
  /// of them is not finite.
  void require(const PieceItem& a, const PieceItem& b);

private:
  double shortestAt(const PieceItem& point);

  const std::vector<vtkDataSet*>& Pieces;
  std::vector<std::vector<double>> Shortest; ///< shortest edges per point, on first use
};
}
#endif
