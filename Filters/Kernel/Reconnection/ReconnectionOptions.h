// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReconnectionOptions.h
 * @brief The options of improveConnectivity(): presets, constraints, targets and limits.
 */
#ifndef tautline_ReconnectionOptions_h
#define tautline_ReconnectionOptions_h

#include "tautline/Boundary/BoundaryConstraints.h"
#include "tautline/Core/Iteration.h"
#include "tautline/Quality/Metrics.h"
#include "tautline/ReconnectionKernelExport.h"

#include <vector>

namespace tautline
{
/// Ready-made options. The numbers are stable: ParaView state files hold them.
enum class ReconnectionPreset : int
{
  Custom = 0, ///< the options unchanged
  /// Only neighborhoods of tetrahedra with a dihedral angle below 15 or above 165 degrees, or an
  /// inverse mean ratio above 2.46; all operations, and compound operations where these fail.
  RemoveSlivers = 1,
  SwapOnly = 2,      ///< edges and faces are removed; points do not move
  SwapAndSmooth = 3, ///< the same, and points move; points are neither inserted nor removed
  /// all operations, including those that only pay off after moving the surrounding points
  Aggressive = 4,
  Adapt = 5 ///< ReconnectionOptions::adapt, with all operations except compound ones
};

/// The objective for the worst tetrahedra. The numbers are stable.
enum class ReconnectionObjective : int
{
  AnglesAndShape = 0, ///< the smaller of the sines of the dihedral angles and (mean ratio)^(3/2)
  Angles = 1,         ///< only the sines: larger smallest angles, longer tetrahedra
  Shape = 2,          ///< only (mean ratio)^(3/2)
  /**
   * @brief ReconnectionOptions::metric, the worst values first. Qualities are x / I or I / x for a
   * value x and the ideal value I; 1 / (1 + x) if I is 0; without an ideal value, x / (x + u) or u
   * / (x + u) with the mean u of the input. Tetrahedra are processed while their quality is below
   * the sine of the target angle. Tetrahedra only.
   */
  Metric = 3,
  /**
   * @brief The sum over all tetrahedra of the excess of their inverse mean ratios over 1: accepts
   * changes that decrease it without worsening the smallest angle and the largest inverse mean
   * ratio of the input. All tetrahedra are processed, regardless of the target; insertion and
   * compound operations are not used.
   */
  Sum = 4
};

/// One line of the history; pass 0 is the input.
struct ReconnectionRecord
{
  int pass = 0;
  double seconds = 0;               ///< wall time since the start
  Index tetrahedra = 0;             ///< their number
  double smallestAngle = 0;         ///< smallest dihedral angle in degrees
  double largestAngle = 0;          ///< largest dihedral angle in degrees
  double worstInverseMeanRatio = 0; ///< the largest inverse mean ratio
  double worstQuality = 0;          ///< the smallest quality, see ReconnectionObjective
  Index belowTarget = 0;            ///< tetrahedra with a quality below the target
  /// With ReconnectionOptions::adapt: fraction of the edges with lengths from 1 / sqrt(2) to
  /// sqrt(2).
  double edgesInRange = 0;
  /// Accepted operations since the start.
  Index edgeRemovals = 0, faceRemovals = 0, boundarySwaps = 0, contractions = 0, insertions = 0;
  Index moves = 0; ///< of points
};

/// The source of the target lengths of edges. The numbers are stable.
enum class ReconnectionSize : int
{
  None = 0,    ///< any length
  Length = 1,  ///< ReconnectionOptions::edgeLength everywhere
  Lengths = 2, ///< a length per point
  Metrics = 3, ///< a metric tensor per point: e . M e is 1 for an edge e of the target length
  Input = 4    ///< the mean length of the edges of the input at each point
};

struct ReconnectionOptions
{
  /**
   * @brief First, the edges are adapted to their target lengths (`size`, which is then required):
   * edges longer than sqrt(2) times the target are split, edges shorter than 1 / sqrt(2) times the
   * target are contracted, and points are moved, in turn, until lengths are in between. Then the
   * worst elements are improved in the metric. All qualities are measured in the metric: (mean
   * ratio)^(3/2) of tetrahedra and the mean ratio of triangles, in coordinates in which the mean of
   * the metrics of the corners is the identity. The metric of a new or moved point is interpolated
   * at its position in the input (log-Euclidean). `objective`, `targetAngle`, `edgeFactor`,
   * `smallestCount`, `largestCount`, `compound` and `improveMean` have no effect. One thread.
   */
  bool adapt = false;
  bool swap = true;     ///< removal of edges and of faces
  bool smooth = true;   ///< motion of points
  bool contract = true; ///< contraction of edges
  bool insert = true;   ///< insertion of points
  /**
   * @brief If nothing else helps: changes that initially worsen the qualities, and are kept if
   * smoothing the surrounding points turns them into an improvement. Thorough, but the slowest
   * part.
   */
  bool compound = true;
  /**
   * @brief Whether points move at the end to minimize the mean of the inverse mean ratios without
   * worsening the smallest dihedral angle and the largest inverse mean ratio.
   */
  bool improveMean = false;
  /**
   * @brief Degrees, above 0 and at most 60. Tetrahedra are processed while their quality is below
   * the sine of this angle; when none is, all dihedral angles are between it and 180 degrees minus
   * it, and the run ends. The run passes through stages of 15, 25, 33.4, 40, 45, 50, 55 and 60
   * degrees, up to the first that is not below this angle, each with all operations: a higher
   * target is therefore never worse in any of the worst values, on one rank and without a time
   * limit. The default is about the limit for fixed boundaries with good facets; with FlatParts, 38
   * to 39 degrees can be reached, at about ten times the cost.
   */
  double targetAngle = 33.4;
  ReconnectionObjective objective = ReconnectionObjective::AnglesAndShape;
  /// With ReconnectionObjective::Metric: any metric that has derivatives and a direction of
  /// improvement, is defined on tetrahedra, and does not depend on the orientation in space.
  Metric metric = Metric::InverseMeanRatio;
  /**
   * @brief The allowed changes of the boundary and of the interfaces between regions.
   *
   * Fixed: same points, same facets; coordinates and facets are bitwise the same. FlatParts: points
   * of the boundary move within flat parts and along straight edges, and are contracted there;
   * edges between coplanar facets of the boundary are removed. The shape, the volume and the volume
   * of each region are preserved, within the flat angle. Facets between regions are not swapped or
   * contracted. OnSurface (tetrahedra): also on curved parts; boundary points move on the boundary
   * or along its sharp edges, and are contracted, inserted and swapped there; facets stay within
   * surfaceTolerance and surfaceAngle of the boundary of the input. Corners, sharp edges
   * (featureAngle) and facets between regions are preserved. The shape and the volume change within
   * these bounds. Boundaries closer to each other than the tolerance may overlap. Free: an error.
   */
  BoundaryMotion boundary = BoundaryMotion::Fixed;
  /// With FlatParts: facets whose normals differ by at most this angle, 0 to 1 degree, are
  /// coplanar. The default allows for coordinates in single precision, or with six decimals in a
  /// file.
  double flatAngle = 0.01;
  /// @{ With OnSurface, and for triangles of surfaces in space. Degrees, 0 to 180: edges between
  /// facets that differ by more are kept.
  double featureAngle = 40.0;
  /// Degrees, 0 to 90: the largest angle between the normals of changed facets and the input below.
  double surfaceAngle = 20.0;
  /// The largest distance of changed facets from the input, relative to the diagonal of its box; 0
  /// to 1.
  double surfaceTolerance = 5e-3;
  /// @} One flag per point, nonzero = it is neither moved nor removed; null: none besides boundary
  /// points.
  const unsigned char* fixed = nullptr;
  /// One region per cell; facets between regions are kept like the boundary. Null: one region.
  const Index* regions = nullptr;
  /**
   * @brief Triples of points: facets that are kept like facets between regions, with fixed points.
   * For tetrahedra; facets that are not between two tetrahedra have no effect. With `adapt`, they
   * are divided and contracted like the boundary, even if they are on it, and the output has their
   * parts (ReconnectionResult::facets).
   */
  std::vector<std::array<Index, 3>> markedFacets;
  /// With `adapt`: the class of each marked facet, at least 1; empty: one class. Edges where
  /// classes meet or end are preserved.
  std::vector<std::int32_t> markedClasses;
  /**
   * @brief For a part of a mesh: one flag per cell, nonzero for surrounding cells. They are
   * unchanged, as are their points and the facets between them and the part. The history excludes
   * them. Null: none.
   */
  const unsigned char* outside = nullptr;
  /// One flag per point: passes start with the tetrahedra that have a flagged point, and reach
  /// others from there. Null: start with all.
  const unsigned char* starts = nullptr;
  /// One flag per point: tetrahedra with a flagged point are swapped, and their points move, but
  /// contractions, insertions and compound operations are not tried on them. Null: tried on all.
  const unsigned char* postponed = nullptr;
  /**
   * @brief The bounds of the number of tetrahedra as multiples of the input, at most 1 and at least
   * 1. Both 1: points are neither inserted nor removed, and the number only changes by the removal
   * of edges and faces.
   */
  double smallestCount = 0.9, largestCount = 1.1;
  /**
   * @brief Target lengths of edges, which bound contraction and insertion: an edge created by a
   * contraction is at most edgeFactor times the target, and an edge created by an insertion is at
   * least the target divided by edgeFactor. The lengths are measured with the mean of the metrics
   * of the ends.
   */
  ReconnectionSize size = ReconnectionSize::None;
  double edgeLength = 0; ///< with Length: above 0
  /// With Lengths one positive number per point, with Metrics a positive definite tensor as xx yy
  /// zz xy yz xz.
  const double* sizes = nullptr;
  double edgeFactor = 2.0; ///< above 1
  /**
   * @brief Whether to compute the overlaps of the output cells with the input cells, for a
   * conservative transfer of quantities. The original cells are then the cells with the largest
   * overlap. Costs about 20 microseconds per changed cell. On a surface in space, overlaps are
   * measured along the normal of the output triangle.
   */
  bool overlaps = false;
  /// The largest number of threads, see Parallel.h; 0: all cores. The result does not depend on it.
  int threads = 0;
  /**
   * @brief Meshes with at least twice this number of tetrahedra are cut into blocks of one to two
   * times this number, which threads process concurrently; tetrahedra at the planes between blocks
   * follow in blocks cut in other directions. At least 1. The result depends on it.
   */
  Index blockSize = 65536;
  /// Seconds of wall time; 0: no limit. Honored within a fraction of a second.
  double maximumSeconds = 0.0;
  /// Called after each pass with a new record, and a few times a second with the last one; return
  /// false to stop. @param progress 0 to 1
  std::function<bool(const ReconnectionRecord& record, double progress)> observer;
};

/// Sets the operations and the target of a preset; other options are unchanged.
TAUTLINE_RECONNECTIONKERNEL_EXPORT void applyPreset(
  ReconnectionPreset preset, ReconnectionOptions& options);
}
#endif
