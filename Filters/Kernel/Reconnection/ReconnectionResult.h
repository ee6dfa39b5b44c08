// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReconnectionResult.h
 * @brief The result of improveConnectivity(): the mesh, its relation to the input, a history, and
 * the elements that remain below the target with the reasons.
 */
#ifndef tautline_ReconnectionResult_h
#define tautline_ReconnectionResult_h

#include "ReconnectionOptions.h"

#include <vector>

namespace tautline
{
/// The reason why a tetrahedron is still below the target.
enum class ReconnectionObstacle : signed char
{
  None = 0,        ///< it is not below the target
  Limit = 1,       ///< a limit or an abort ended the run, or no operation improves it
  Facets = 2,      ///< one of its facets on the boundary or an interface prevents a better one
  FixedPoints = 3, ///< it has a fixed point (and none of the above applies)
  Interface = 4,   ///< it has a point on an interface between regions
  Surface = 5      ///< it has a point on the boundary
};

/// The relation of an inserted point to the input: its position in a tetrahedron.
struct PointInterpolation
{
  Index point = -1; ///< of the output
  Index cell = -1;  ///< of the input
  /// One per point of the cell, in its order; their sum is 1. Negative only by rounding, or where
  /// the input overlaps itself.
  std::array<double, 4> weights = { 0, 0, 0, 0 };
};

/// The input cells that each output cell overlaps, in compressed rows.
struct CellOverlaps
{
  std::vector<Index> offsets; ///< cells + 1
  std::vector<Index> cells;   ///< of the input
  /// The fraction of the volume (area) of the output cell inside the input cell; the sum of a row
  /// is
  /// 1. Parts outside the input do not count.
  std::vector<double> fractions;

  /**
   * @brief The average of a field of the input over a cell of the output. Exact for constants; the
   * integral over the mesh is preserved up to rounding (and up to the change of volume if the
   * boundary moves).
   * @param values of the cells of the input
   */
  template <class Values>
  double average(Index cell, const Values& values) const
  {
    const Index begin = this->offsets[cell], end = this->offsets[cell + 1];
    const double first = values(this->cells[begin]);
    double sum = 0.0;
    for (Index k = begin; k < end; ++k)
    {
      sum += this->fractions[k] * (values(this->cells[k]) - first);
    }
    return first + sum;
  }
};

struct ReconnectionResult
{
  bool adapted = false;          ///< ReconnectionOptions::adapt
  std::vector<double> points;    ///< x y z per point
  std::vector<Index> tetrahedra; ///< four points per cell, in the order of VTK
  std::vector<Index> triangles;  ///< for improveTriangles(): three points per cell
  /// Per point of the output: the corresponding input point, or -1 for an inserted point. Input
  /// points keep their order; unused points are kept. With ReconnectionOptions::adapt, also -1 for
  /// a moved point: its data are interpolated at its position.
  std::vector<Index> originalPoints;
  /// For the points with -1, in order.
  std::vector<PointInterpolation> interpolations;
  /**
   * @brief Per cell of the output: the input cell that contains its centroid, or itself if it is
   * unchanged. Always of the same region, so that regions follow from it. Unchanged input cells
   * keep their order.
   */
  std::vector<Index> originalCells;
  /// @{ For improveTriangles(): the output edges that are marked edges or parts of them, as pairs
  /// of points, and for each the number of the marked edge.
  std::vector<Index> lines;
  std::vector<Index> originalLines;
  /// @} With ReconnectionOptions::overlaps, otherwise empty.
  CellOverlaps overlaps;
  /// With ReconnectionOptions::adapt: the parts of the marked facets, three points of the output
  /// each, and, per part, the marked input facet that it is, or is next to.
  std::vector<Index> facets, originalFacets;
  Index ignoredMarks = 0; ///< with `adapt`: marked facets or edges that do not exist or occur twice
  std::vector<signed char> obstacles; ///< a ReconnectionObstacle per cell of the output
  /// Per cell of the output: its quality (for triangles, the sine of the smallest angle), and an
  /// upper bound: the best quality of a tetrahedron on any of its boundary or interface facets, or
  /// the bound given by the angles between preserved edges. 1 if it is not below the target.
  std::vector<double> qualities, bounds;
  std::vector<ReconnectionRecord> history;
  StopReason reason = StopReason::NoProgress;  ///< or Reduction (target), TimeLimit, Aborted
  Index markedFacets = 0;                      ///< for tetrahedra: the marked facets that were kept
  Index pointsInPlanes = 0, pointsOnLines = 0; ///< points of the boundary that may slide
  /// With BoundaryMotion::OnSurface: the largest distance, in either direction, between the
  /// boundaries of output and input, at corners, edge middles and centers of facets; and the
  /// volumes. With TriangleOptions::keepVolume: the volumes.
  double boundaryDistance = 0, volumeBefore = 0, volumeAfter = 0;
  double meanBefore = 0, meanAfter = 0; ///< of the inverse mean ratios of tetrahedra
  /// With ReconnectionObjective::Metric: the worst metric value.
  double worstMetricBefore = 0, worstMetricAfter = 0;
  /**
   * @brief The largest inverse mean ratio and the smallest quality forced by the facets of the
   * boundary and of interfaces: every mesh with these facets has a tetrahedron at least this bad.
   * For the output.
   */
  double forcedInverseMeanRatio = 1, forcedQuality = 1;
};
}
#endif
