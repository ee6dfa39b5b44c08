// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedOptions.h
 * @brief The options of untangleCurved() and optimizeCurved().
 */
#ifndef tautline_CurvedOptions_h
#define tautline_CurvedOptions_h

#include "tautline/Boundary/BoundaryConstraints.h"
#include "tautline/Core/Iteration.h"
#include "tautline/Mesh/CurvedCells.h"

namespace tautline
{
struct CurvedOptions
{
  CurvedCellFacts facts;
  /// One flag per point, nonzero = fixed, or null. The boundary need not be marked.
  const unsigned char* fixed = nullptr;
  BoundaryMotion boundary = BoundaryMotion::OnSurface;
  /// Degrees: boundary facets whose normals differ by more in the middle of their common edge meet
  /// at a feature.
  double featureAngle = 40.0;
  /// Degrees: the largest difference of the normals, or tangents, of a flat part.
  double flatAngle = 1.0;
  /// With OnSurface: the surface on which the points slide instead of the original boundary, in the
  /// coordinates of the mesh; or null. Patches and curves are matched by their distance.
  const SurfaceModel* geometry = nullptr;
  /// Whether corners are fixed, so that only the other nodes of the cells move.
  bool midNodesOnly = false;
  /// untangleCurved(): whether, as a last resort, nodes of elements that remain invalid move to
  /// their positions in a straight element, which may be off the surface.
  bool straighten = false;
  double maximumSeconds = 0; ///< wall time; 0: no limit
  int threads = 0;           ///< 0: all cores. The result does not depend on it.
  /// Called after each iteration; return false to stop. Called from the calling thread.
  std::function<bool(const IterationState&)> observer;
};
}
#endif
