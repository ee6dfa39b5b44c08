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
  /// Degrees: facets of the boundary whose normals differ by more in the middle of their edge meet
  /// at a feature.
  double featureAngle = 40.0;
  /// Degrees by which the normals, or tangents, of a flat part differ at most.
  double flatAngle = 1.0;
  /// With OnSurface: what the points slide on instead of the boundary as it was, in the coordinates
  /// of the mesh; or null. Patches and curves are matched by their distance.
  const SurfaceModel* geometry = nullptr;
  /// Whether corners stay: only the other nodes of the cells move.
  bool midNodesOnly = false;
  /// untangleCurved(): whether, as a last resort, nodes of elements that remain invalid go to where
  /// they are in a straight element, which may leave the surface.
  bool straighten = false;
  double maximumSeconds = 0; ///< wall time; 0: no limit
  int threads = 0;           ///< 0: all cores. The result does not depend on it.
  /// Called after each iteration; return false to stop. Called from the calling thread.
  std::function<bool(const IterationState&)> observer;
};
}
#endif
