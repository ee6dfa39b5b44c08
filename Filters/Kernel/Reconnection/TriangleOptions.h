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
 * @brief The options; the options for tetrahedra apply to triangles, with these remarks. `boundary`
 * applies to borders, edges between regions and sharp edges: with FlatParts, their points move
 * along straight parts and are contracted there, and their edges are divided. `targetAngle` refers
 * to the angles of triangles, 40 degrees by default; counts refer to triangles.
 */
struct TriangleOptions : ReconnectionOptions
{
  static constexpr double DefaultTargetAngle = 40.0;
  TriangleOptions() { this->targetAngle = DefaultTargetAngle; }

  /// Pairs of points: edges that are kept like the border. Pairs that are not edges have no effect.
  std::vector<std::array<Index, 2>> markedEdges;
  /**
   * @brief For a closed surface in space: at the end, points of its curved parts move along their
   * normals until it encloses the original volume to a relative accuracy of 1e-6, or less if
   * triangles would become too bad or exceed surfaceTolerance. See ReconnectionResult::volumeAfter.
   */
  bool keepVolume = false;
  /// Whether edges are first flipped everywhere, even far from triangles below the target.
  bool swapEverywhere = true;
};

/// Sets the operations and the target of a preset for triangles; other options are unchanged.
TAUTLINE_RECONNECTIONKERNEL_EXPORT void applyPreset(
  ReconnectionPreset preset, TriangleOptions& options);
}
#endif
