// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ReconnectionOptions.h
 * @brief The options of improveConnectivity(): presets, what is kept, targets and limits.
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
  Custom = 0, ///< the options as they are
  /// Only neighbourhoods of tetrahedra with a dihedral angle below 15 or above 165 degrees, or an
  /// inverse mean ratio above 2.46; every operation, and compound operations where these fail.
  RemoveSlivers = 1,
  SwapOnly = 2,      ///< edges and faces are removed, no point moves
  SwapAndSmooth = 3, ///< the same, and points move; none are inserted or removed
  Aggressive = 4,    ///< every operation, also those that pay only after the points around moved
  Adapt = 5          ///< ReconnectionOptions::adapt, with every operation but compound ones
};

/// What the worst tetrahedra are improved for. The numbers are stable.
enum class ReconnectionObjective : int
{
  AnglesAndShape = 0, ///< the smaller of the sines of the dihedral angles and (mean ratio)^(3/2)
  Angles = 1,         ///< the sines alone: larger smallest angles, longer tetrahedra
  Shape = 2,          ///< (mean ratio)^(3/2) alone
  /**
   * @brief ReconnectionOptions::metric, the worst values first. Qualities are x / I or I / x of a
   * value x and the ideal value I; 1 / (1 + x) where I is 0; without an ideal value x / (x + u) or
   * u / (x + u) with the mean u of the input. Tetrahedra are worked on while theirs is below the
   * sine of the target angle. Tetrahedra only.
   */
  Metric = 3,
  /**
   * @brief The sum over all tetrahedra of what their inverse mean ratios exceed 1: changes that
   * decrease it, while the smallest angle and the largest inverse mean ratio of the input are held.
   * All tetrahedra are worked on, whatever the target; insertion and compound operations are not
   * used.
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
  Index belowTarget = 0;            ///< tetrahedra whose quality is below that of the target
  /// With ReconnectionOptions::adapt: part of the edges with lengths from 1 / sqrt(2) to sqrt(2).
  double edgesInRange = 0;
  /// Accepted operations since the start.
  Index edgeRemovals = 0, faceRemovals = 0, boundarySwaps = 0, contractions = 0, insertions = 0;
  Index moves = 0; ///< of points
};

/// Where the target lengths of edges come from. The numbers are stable.
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
   * @brief First the edges get their target lengths (`size`, which is then required): edges longer
   * than sqrt(2) times the target are split, edges shorter than 1 / sqrt(2) times it contracted,
   * and points moved, in turn, until lengths are in between. Then the worst elements are improved
   * in the metric. All qualities are those in the metric: (mean ratio)^(3/2) of tetrahedra and the
   * mean ratio of triangles, in coordinates in which the mean of the metrics of the corners is the
   * identity. The metric of a new or moved point is interpolated at its place in the input
   * (log-Euclidean). `objective`, `targetAngle`, `edgeFactor`, `smallestCount`, `largestCount`,
   * `compound` and `improveMean` have no effect. One thread.
   */
  bool adapt = false;
  bool swap = true;     ///< removal of edges and of faces
  bool smooth = true;   ///< motion of points
  bool contract = true; ///< contraction of edges
  bool insert = true;   ///< insertion of points
  /**
   * @brief Where nothing else helps: changes that make the qualities worse at first, and are kept
   * if smoothing the points around makes them an improvement. Thorough, and the slowest part.
   */
  bool compound = true;
  /**
   * @brief Whether points move at the end so that the mean of the inverse mean ratios becomes as
   * small as the worst tetrahedra allow: the smallest dihedral angle and the largest inverse mean
   * ratio stay as good as they are.
   */
  bool improveMean = false;
  /**
   * @brief Degrees, above 0 and at most 60. Tetrahedra are worked on while their quality is below
   * the sine of this angle; when none is, all dihedral angles are between it and 180 degrees minus
   * it, and the run ends. The run goes through stages of 15, 25, 33.4, 40, 45, 50, 55 and 60
   * degrees, up to the first that is not below this angle, each with every operation: so a higher
   * target is never worse in any of the worst values, on one rank and without a time limit. The
   * default is about what fixed boundaries of good facets allow; with FlatParts, 38 to 39 is in
   * reach, at some ten times the cost.
   */
  double targetAngle = 33.4;
  ReconnectionObjective objective = ReconnectionObjective::AnglesAndShape;
  /// With ReconnectionObjective::Metric: any with derivatives that is defined on tetrahedra, better
  /// larger or smaller, and does not depend on the orientation in space.
  Metric metric = Metric::InverseMeanRatio;
  /**
   * @brief What may happen to the boundary and to the interfaces between regions.
   *
   * Fixed: same points, same facets; coordinates and facets are bitwise the same. FlatParts: points
   * of the boundary move within flat parts and along straight edges, and are contracted there;
   * edges between coplanar facets of the boundary are removed. The shape, the volume and the volume
   * of each region stay, within the flat angle. Facets between regions are not swapped or
   * contracted. OnSurface (tetrahedra): also on curved parts; points of the boundary move on it, or
   * along its sharp edges, and are contracted, inserted and swapped there; facets stay within
   * surfaceTolerance and surfaceAngle of the boundary of the input. Corners, sharp edges
   * (featureAngle) and facets between regions stay. The shape and the volume change within these
   * bounds. Boundaries closer to each other than the tolerance may come to overlap. Free: an error.
   */
  BoundaryMotion boundary = BoundaryMotion::Fixed;
  /// With FlatParts: facets whose normals differ by at most so much, 0 to 1 degree, are coplanar.
  /// The default allows for coordinates in single precision, or with six decimals in a file.
  double flatAngle = 0.01;
  ///@{ With OnSurface, and of triangles of surfaces in space.
  /// Degrees, 0 to 180: edges between facets that differ by more are kept.
  double featureAngle = 40.0;
  /// Degrees, 0 to 90: the normals of changed facets are as close to that of the input below.
  double surfaceAngle = 20.0;
  /// Changed facets are as close to the input, as a multiple of the diagonal of its box; 0 to 1.
  double surfaceTolerance = 5e-3;
  ///@}
  /// One flag per point, nonzero = it stays where it is and is not removed; null: none besides
  /// those of the boundary.
  const unsigned char* fixed = nullptr;
  /// One region per cell; facets between regions are kept as the boundary is. Null: one region.
  const Index* regions = nullptr;
  /**
   * @brief Triples of points: facets that are kept as those between regions are, and their points
   * stay. Of tetrahedra; those that are not between two of these have no effect. With `adapt`, they
   * are divided and contracted as the boundary is, also those on the boundary, and the output has
   * their parts (ReconnectionResult::facets).
   */
  std::vector<std::array<Index, 3>> markedFacets;
  /// With `adapt`: the class of each marked facet, at least 1; empty: all are of one. Where classes
  /// meet, and where they end, edges stay edges.
  std::vector<std::int32_t> markedClasses;
  /**
   * @brief Of a part of a mesh: one flag per cell, nonzero for those around it. They stay as they
   * are, so do their points and the facets between them and the part. The figures of the history
   * are without them. Null: none.
   */
  const unsigned char* outside = nullptr;
  /// One flag per point: passes start with the tetrahedra that have one that is nonzero, and reach
  /// others from there. Null: with all.
  const unsigned char* starts = nullptr;
  /// One flag per point: tetrahedra with one that is nonzero are swapped, and their points move,
  /// but contractions, insertions and compound operations are not tried on them. Null: on all.
  const unsigned char* postponed = nullptr;
  /**
   * @brief The number of tetrahedra stays within these multiples of the input's, at most 1 and at
   * least 1. Both 1: no point is inserted or removed, and the number is what the removal of edges
   * and faces makes it.
   */
  double smallestCount = 0.9, largestCount = 1.1;
  /**
   * @brief Target lengths of edges, which bound contraction and insertion: an edge that a
   * contraction makes is at most edgeFactor times the target, one that an insertion makes is at
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
   * @brief Whether the overlaps of the cells of the output with those of the input are computed,
   * for a conservative transfer of quantities. Then the original cells are those that overlap most.
   * Costs some 20 microseconds per cell that changed. On a surface in space they are those seen
   * along the normal of the output's triangle.
   */
  bool overlaps = false;
  /// The largest number of threads, see Parallel.h; 0: all cores. The result does not depend on it.
  int threads = 0;
  /**
   * @brief Meshes of twice as many tetrahedra, at least 1, are cut into blocks of one to two times
   * as many, on which threads work at the same time; what is at the planes between blocks follows
   * in blocks cut in other directions. The result depends on it.
   */
  Index blockSize = 65536;
  /// Seconds of wall time; 0: no limit. Honoured within a fraction of a second.
  double maximumSeconds = 0.0;
  /// Called after each pass with a new record, and a few times a second with the last one; return
  /// false to stop. @param progress 0 to 1
  std::function<bool(const ReconnectionRecord& record, double progress)> observer;
};

/// Sets the operations and the target of a preset; the rest stays.
TAUTLINE_RECONNECTIONKERNEL_EXPORT void applyPreset(
  ReconnectionPreset preset, ReconnectionOptions& options);
}
#endif
