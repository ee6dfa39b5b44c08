// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file TriangleOptions.h
 * @brief The options of improveTriangles().
 */
#ifndef tautline_TriangleOptions_h
#define tautline_TriangleOptions_h

#include "ReconnectionOptions.h"
#include "tautline/ReconnectionKernelExport.h"

#include <vector>

namespace tautline
{
/**
 * @brief The options; those of tetrahedra hold for triangles, with these remarks. `boundary` is
 * that of borders, edges between regions and sharp edges: with FlatParts, their points move along
 * straight parts and are contracted there, and their edges are divided. `targetAngle` is of the
 * angles of triangles, 40 degrees by default; counts are of triangles.
 */
struct TriangleOptions : ReconnectionOptions
{
  static constexpr double DefaultTargetAngle = 40.0;
  TriangleOptions() { this->targetAngle = DefaultTargetAngle; }

  /// Pairs of points: edges that are kept as the border is. Others than edges have no effect.
  std::vector<std::array<Index, 2>> markedEdges;
  /**
   * @brief Of a closed surface in space: in the end, points of its curved parts move along their
   * normals until it encloses the volume that it had, to 1e-6 of it; less well where triangles
   * would become too bad or leave surfaceTolerance. See ReconnectionResult::volumeAfter.
   */
  bool keepVolume = false;
  /// First all edges are flipped that should be, also far from triangles below the target.
  bool swapEverywhere = true;
};

/// Sets the operations and the target of a preset for triangles; the rest stays.
TAUTLINE_RECONNECTIONKERNEL_EXPORT void applyPreset(
  ReconnectionPreset preset, TriangleOptions& options);
}
#endif
