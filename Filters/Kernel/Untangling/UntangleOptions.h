// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file UntangleOptions.h
 * @brief The options of untangle(), and its result.
 */
#ifndef tautline_UntangleOptions_h
#define tautline_UntangleOptions_h

#include "tautline/Boundary/BoundaryConstraints.h"
#include "tautline/Core/Iteration.h"

#include <map>

namespace tautline
{
/// The maximum effort in iterations. The numbers are stable: ParaView state files store them.
enum class Effort : int
{
  Local = 0,   ///< only the neighborhood of inverted elements moves; at most 60 sweeps
  Normal = 1,  ///< then all vertices, at most 1500 iterations
  Thorough = 2 ///< at most 5000 iterations, restarts with slower schedules
};

/// The untangling method. The numbers are stable: ParaView state files store them.
enum class UntangleMethod : int
{
  Automatic = 0, ///< around the inverted elements, then all vertices at once, see Untangle.h
  /// Simultaneous untangling and smoothing as published by Escobar et al. 2003: sweeps over all
  /// free vertices, until all elements are valid and the energy has converged, at most 100.
  Simultaneous = 1
};

/**
 * @brief Points of planar and volume meshes slide with the automatic method, but not on several
 * ranks, where `fixed` must not be null and the owner's flag is used. Points assigned to a part of
 * the model need not lie on it; in the result, they do unless this makes elements invalid. A
 * surfaceTolerance of 0 means a thousandth of the diagonal of the mesh. slideSurface and leaving
 * are not used.
 */
struct UntangleOptions : BoundaryConstraints
{
  UntangleMethod method = UntangleMethod::Automatic;
  Effort effort = Effort::Normal; ///< of the automatic method
  /// Seconds of wall time; 0: no limit. Honored within one iteration.
  double maximumSeconds = 0.0;
  SurfaceConstraint surface;
  int threads = 0; ///< 0: all cores. The result does not depend on it.
  /// Called from the calling thread after each iteration; on several ranks, after each ring width
  /// on all ranks. Return false to stop.
  std::function<bool(const IterationState&)> observer;
};

/// The reason why an element is still inverted.
enum class Obstacle : signed char
{
  None = 0,            ///< the element is valid
  Unknown = 1,         ///< the iterations ended before it became valid
  FixedElement = 2,    ///< all its vertices are fixed
  FixedNeighbours = 3, ///< the surrounding fixed vertices leave no valid position for its free ones
  NonFinite = 4        ///< a coordinate of a fixed vertex is NaN or infinite
};

/// An element of a mesh on several ranks that is still invalid.
struct TangledElement
{
  Obstacle obstacle = Obstacle::Unknown;
  Vec3 center = { 0, 0, 0 };
};

/// On several ranks, points and obstacles refer to the local mesh, everything else to the whole
/// mesh.
struct UntangleResult
{
  std::vector<double> points; ///< 3 x numberOfPoints, of the mesh with the fewest inverted elements
  std::vector<signed char> obstacles; ///< an Obstacle per cell
  /// On several ranks: the invalid elements, by the global numbers of their points in increasing
  /// order; the same on all ranks.
  std::map<std::vector<Index>, TangledElement> remaining;
  /// On several ranks: whether the whole mesh, the next step, does not fit into the memory of the
  /// first rank.
  bool exceededMemory = false;
  /**
   * @brief objective: the sum of -D over inverted simplices (corners of cells), D = det T with
   * targets scaled to the mean edge length, comparable between all phases; inverted: remaining
   * elements. At most one record if there was nothing to do.
   */
  std::vector<IterationRecord> history;
  Index invertedBefore = 0, invertedAfter = 0;
  Index newlyInvalid = 0; ///< elements of invertedAfter that were valid in the input
  Index impossible = 0;   ///< elements with FixedElement or FixedNeighbours
  StopReason reason = StopReason::AllValid;
  double surfaceError = 0;
  Index offSurface = 0;          ///< points off the part of the model they slide on
  double offSurfaceDistance = 0; ///< distance of the farthest of them
};
}
#endif
