// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OptionChecks.h
 * @brief Checks of the options of optimize().
 * Internal: not installed.
 */
#ifndef tautline_OptionChecks_h
#define tautline_OptionChecks_h

#include "OptimizeOptions.h"
#include "tautline/Core/Stopwatch.h"
#include "tautline/Mesh/Ranks.h"
#include "tautline/Untangling/UntangleOptions.h"

#include <vector>

namespace tautline
{
/// Whether an objective is a metric without analytic derivatives, see needsDifferences().
bool needDifferences(const OptimizeOptions& options);

/// Throws Error, with the remedy, for options that are out of range or do not match the mesh, which
/// may be distributed over ranks.
void checkOptions(const Mesh& mesh, const OptimizeOptions& options, const Ranks& ranks);

/// Whether points that slide on planes, lines and a model also slide while a mesh is untangled
/// before optimization: in planar and volume meshes of one process, without limits.
bool slidesInUntangling(const Mesh& mesh, const OptimizeOptions& options, const Ranks& ranks);
/**
 * The points that are held while a mesh is untangled before optimization, one flag each: fixed
 * points, and points that slide on surfaces that untangling does not support. Empty: the boundary
 * points.
 * @param slides see slidesInUntangling()
 */
std::vector<unsigned char> heldInUntangling(
  const OptimizeOptions& options, Index points, bool slides);
/// The options of untangling before an optimization, with the remaining time and its observer.
/// @param held see heldInUntangling() @param slides see slidesInUntangling()
/// @param proceed set to false if the observer stops it
UntangleOptions untanglingFirst(const OptimizeOptions& options,
  const std::vector<unsigned char>& held, bool slides, const Stopwatch& clock, bool& proceed);
/**
 * @brief Throws Error if untangling has moved points, 3 coordinates each, farther from their start
 * than their limits.
 */
void requireWithinLimits(const OptimizeOptions& options, const double* start,
  const std::vector<double>& points, const Ranks& ranks);

/// Throws Error if a user metric has no finite value on an element, because any step would then be
/// accepted.
/// @param values of the objectives at the start
void requireValues(const std::vector<Objective>& objectives, const std::vector<double>& values);
}
#endif
