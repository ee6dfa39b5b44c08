// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SlidingCells.h
 * @brief The cells of a mesh with movable points, and the cells around each point.
 * Internal: not installed.
 */
#ifndef tautline_SlidingCells_h
#define tautline_SlidingCells_h

#include "ConstrainedPoints.h"

namespace tautline
{
/// The cells of the mesh dimension with a movable point, by their numbers in this list.
class TAUTLINE_KERNEL_EXPORT SlidingCells
{
public:
  SlidingCells(const Mesh& mesh, const ConstrainedPoints& constrained);

  struct Cell
  {
    const CellTopology* t;
    const Index* nodes;
    Index cell; ///< of the mesh
  };

  const std::vector<Cell>& cells() const { return this->Cells; }
  /// The cells of a point: cellsOf()[starts()[p]] to [starts()[p + 1] - 1].
  const std::vector<std::int32_t>& starts() const { return this->Starts; }
  const std::vector<std::int32_t>& cellsOf() const { return this->CellsOf; }
  const Vec3& normal() const { return this->Normal; }
  double sign() const { return this->Sign; }

  /// The vertices of a cell.
  void load(const Cell& cell, const std::vector<Vec3>& x, Vec3* vertices) const
  {
    for (int k = 0; k < cell.t->nodes; ++k)
    {
      vertices[k] = x[cell.nodes[k]];
    }
  }
  /// Per point: the shortest edge, at least a tenth of the mean edge of the mesh; the latter for
  /// points without a cell.
  std::vector<double> shortestEdges(const std::vector<Vec3>& x) const;
  /// Flags the cells with a flagged point.
  void flagCells(const std::vector<char>& points, std::vector<char>& cells) const;
  /// Flags the points of flagged cells.
  void flagPoints(const std::vector<char>& cells, std::vector<char>& points) const;

private:
  std::vector<Cell> Cells;
  std::vector<std::int32_t> Starts, CellsOf;
  Vec3 Normal;
  double Sign;
};

/// Converts the points of a mesh to vectors, and back: only changed points are written.
TAUTLINE_KERNEL_EXPORT std::vector<Vec3> pointsOf(const double* points, Index count);
void storeMovedPoints(const std::vector<Vec3>& start, const std::vector<Vec3>& x, double* points);
}
#endif
