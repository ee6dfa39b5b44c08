// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReconnectionResult.h
 * @brief What improveConnectivity() returns: the mesh, how it follows from the input, a history,
 * and what remains below the target and why.
 */
#ifndef tautline_ReconnectionResult_h
#define tautline_ReconnectionResult_h

#include "ReconnectionOptions.h"

#include <vector>

namespace tautline
{
/// Why a tetrahedron is still below the target.
enum class ReconnectionObstacle : signed char
{
  None = 0,        ///< it is not below the target
  Limit = 1,       ///< a limit or an abort ended the run, or no operation improves it
  Facets = 2,      ///< a facet it has on the boundary or an interface allows no better one
  FixedPoints = 3, ///< it has a fixed point (and is not one of the former)
  Interface = 4,   ///< it has a point on an interface between regions
  Surface = 5      ///< it has a point on the boundary
};

/// How a point that was inserted follows from the input: its place in a tetrahedron.
struct PointInterpolation
{
  Index point = -1; ///< of the output
  Index cell = -1;  ///< of the input
  /// One per point of the cell, in its order; their sum is 1. Negative by rounding only, or where
  /// the input overlaps itself.
  std::array<double, 4> weights = { 0, 0, 0, 0 };
};

/// Which cells of the input the cells of the output overlap, in compressed rows.
struct CellOverlaps
{
  std::vector<Index> offsets; ///< cells + 1
  std::vector<Index> cells;   ///< of the input
  /// The part of the volume (area) of the output's cell that is in the input's; the sum of a row is
  /// 1. Parts outside the input do not count.
  std::vector<double> fractions;

  /**
   * @brief The average of a field of the input over a cell of the output. Exact for constants; the
   * integral over the mesh stays, to rounding (to the change of the volume, where the boundary
   * moves).
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
  std::vector<Index> triangles;  ///< of improveTriangles(): three points per cell
  /// Per point of the output: the point of the input it is, or -1 for a point that was inserted.
  /// Points of the input keep their order; those that no cell uses are kept. With
  /// ReconnectionOptions::adapt also -1 for a point that moved: its data are those of its place.
  std::vector<Index> originalPoints;
  /// Of the points with -1, in order.
  std::vector<PointInterpolation> interpolations;
  /**
   * @brief Per cell of the output the cell of the input that contains its centroid: itself if it is
   * unchanged. Always of the same region, so that regions follow from it. Cells of the input that
   * are not changed keep their order.
   */
  std::vector<Index> originalCells;
  ///@{ Of improveTriangles(): the edges of the output that are marked edges or parts of these, as
  /// pairs of points, and for each the number of the marked edge.
  std::vector<Index> lines;
  std::vector<Index> originalLines;
  ///@}
  /// With ReconnectionOptions::overlaps, else empty.
  CellOverlaps overlaps;
  /// With ReconnectionOptions::adapt: the parts of the marked facets, three points of the output
  /// each, and per part the marked facet of the input that it is, or is next to.
  std::vector<Index> facets, originalFacets;
  Index ignoredMarks = 0; ///< with `adapt`: marked facets or edges that are none, or there twice
  std::vector<signed char> obstacles; ///< a ReconnectionObstacle per cell of the output
  /// Per cell of the output its quality (of triangles the sine of the smallest angle), and an upper
  /// bound for it: the best of a tetrahedron on any one of its facets on the boundary and on
  /// interfaces, or what the angles between edges that are kept allow. 1 where it is not below the
  /// target.
  std::vector<double> qualities, bounds;
  std::vector<ReconnectionRecord> history;
  StopReason reason = StopReason::NoProgress;  ///< or Reduction (target), TimeLimit, Aborted
  Index markedFacets = 0;                      ///< of tetrahedra: those that were kept
  Index pointsInPlanes = 0, pointsOnLines = 0; ///< points of the boundary that may slide
  /// With BoundaryMotion::OnSurface: the largest distance of the boundary from that of the
  /// input, or back, at corners, middles of edges and centres of facets; and the volumes.
  /// With TriangleOptions::keepVolume: the volumes.
  double boundaryDistance = 0, volumeBefore = 0, volumeAfter = 0;
  double meanBefore = 0, meanAfter = 0; ///< of the inverse mean ratios of tetrahedra
  /// With ReconnectionObjective::Metric: the metric's worst value.
  double worstMetricBefore = 0, worstMetricAfter = 0;
  /**
   * @brief The largest inverse mean ratio and the smallest quality that the facets of the boundary
   * and of interfaces force: every mesh with these facets has a tetrahedron as bad. Of the output.
   */
  double forcedInverseMeanRatio = 1, forcedQuality = 1;
};
}
#endif
