// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WarpSteps.h
 * @brief A motion in steps, each from the mesh of the one before.
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
 * @brief The motion in steps, each from the mesh the one before came to.
 * @param steps number of steps of equal length; 0: as few as no element needs to invert. Then a
 * step that inverts or collapses elements is halved, and the next one is doubled; if steps become
 * too small or too many, the result is the mesh of the last good one.
 * @param following see WarpStep::setFollowing(); the first of such steps is short, and so it is
 * where the motion ends where it begins
 */
void warpInSteps(const Mesh& mesh, const WarpParts& parts, const WarpMotion& motion, int steps,
  bool following, WarpControl& control);
}
#endif
