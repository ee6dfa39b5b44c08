// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file MetricField.h
 * @brief A metric of a triangle or tetrahedron as a function of its last vertex.
 *
 * Example: the inverse mean ratio of dissertation Figures 2.1 and 3.1.
 *
 *     tautline::FieldGrid grid;                  // x -1 to 2, y 0 to 2
 *     grid.origin = { -1, 0, 0 };   grid.spacing = { 0.01, 0.01, 1 };
 *     grid.size = { 301, 201, 1 };
 *     tautline::MetricField field(tautline::CellType::Triangle, { { { 0, 0, 0 }, { 1, 0, 0 } } });
 *     std::vector<double> values(301 * 201);
 *     field.evaluate(grid, tautline::Metric::InverseMeanRatio, {}, values.data());
 */
#ifndef tautline_MetricField_h
#define tautline_MetricField_h

#include "Metrics.h"

#include <vector>

namespace tautline
{
/// The positions of the free vertex: points of a grid, x running fastest.
struct FieldGrid
{
  Vec3 origin = { 0, 0, 0 };
  Vec3 spacing = { 1, 1, 1 };
  std::array<Index, 3> first = { 0, 0, 0 }; ///< the part of the grid from here
  std::array<Index, 3> size = { 1, 1, 1 };  ///< and of this size
  Index count() const { return this->size[0] * this->size[1] * this->size[2]; }
};

/**
 * @brief The cell with all vertices except the last one fixed.
 *
 * A triangle lies in the plane z = 0; it is positive if the free vertex is left of the line from
 * the first to the second vertex, and third coordinates are ignored. A tetrahedron is positive if
 * the free vertex is on the side from which its first three vertices run counterclockwise.
 */
class TAUTLINE_KERNEL_EXPORT MetricField
{
public:
  /// Throws Error for other types, and if the fixed vertices (3; a triangle uses 2) are degenerate.
  MetricField(CellType type, const std::array<Vec3, 3>& fixed);

  /// Writes grid.count() values. Throws Error if the metric is undefined on the cell, or if a value
  /// is beyond the range of double precision.
  void evaluate(
    const FieldGrid& grid, Metric metric, const EvaluationOptions& options, double* values) const;
  /// Writes grid.count() entries of Validity.
  void classify(const FieldGrid& grid, signed char* validity, int threads = 0) const;

private:
  template <class Visit>
  void forEachSlice(const FieldGrid& grid, int threads, const Visit& visit) const;

  CellType Type;
  /// the first vertex: cells are computed relative to it, so that the distance from 0 does not
  /// matter
  Vec3 Origin;
  std::array<Vec3, 3> Fixed; ///< relative to the origin
};
}
#endif
