// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OptionChecks.h
 * @brief What is wrong with the options of optimize().
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
/// Whether an objective is a metric without derivatives of its own, see needsDifferences().
bool needDifferences(const OptimizeOptions& options);

/// Throws Error, with the remedy, for options that are out of range or do not fit the mesh, which
/// ranks may have parts of.
void checkOptions(const Mesh& mesh, const OptimizeOptions& options, const Ranks& ranks);

/// Whether points that slide on planes, lines and a model do so while a mesh is untangled before it
/// is optimized: in planar and volume meshes of one process, without limits.
bool slidesInUntangling(const Mesh& mesh, const OptimizeOptions& options, const Ranks& ranks);
/**
 * The points that stay while a mesh is untangled before it is optimized, one flag each: those that
 * are fixed, and those that slide on what untangling does not have. Empty: those of the boundary.
 * @param slides see slidesInUntangling()
 */
std::vector<unsigned char> heldInUntangling(
  const OptimizeOptions& options, Index points, bool slides);
/// The options of untangling before an optimization, in the time that is left, with its observer.
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

/// Throws Error if a user's metric has no finite value on an element, so that any step would do.
/// @param values of the objectives at the start
void requireValues(const std::vector<Objective>& objectives, const std::vector<double>& values);
}
#endif
