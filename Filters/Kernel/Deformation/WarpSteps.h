// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpSteps.h
 * @brief A motion in steps, each starting from the mesh of the previous step.
 * Internal: not installed.
 */
#ifndef tautline_WarpSteps_h
#define tautline_WarpSteps_h

#include "WarpControl.h"
#include "WarpParts.h"

#include <functional>

namespace tautline
{
/// The path of the prescribed points: (amount from 0 to 1, displacements from the mesh, 3 per
/// point).
using WarpMotion = std::function<void(double, double*)>;

/**
 * @brief Performs the motion in steps, each starting from the mesh of the previous step.
 * @param steps number of steps of equal length; 0: as few as possible without inverting an element.
 * A step that inverts or collapses elements is then halved, and the next one is doubled; if steps
 * become too small or too many, the result is the mesh of the last good step.
 * @param following see WarpStep::setFollowing(); the first such step is short, as it is for a
 * motion that returns to its start
 */
void warpInSteps(const Mesh& mesh, const WarpParts& parts, const WarpMotion& motion, int steps,
  bool following, WarpControl& control);
}
#endif
