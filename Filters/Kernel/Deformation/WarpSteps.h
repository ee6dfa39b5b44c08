/**
 * @file WarpSteps.h
 * @brief A motion in steps, each from the mesh of the one before. Internal: not installed.
 */
#ifndef tautline_WarpSteps_h
#define tautline_WarpSteps_h

#include "WarpControl.h"
#include "WarpParts.h"

#include <functional>

namespace tautline
{
/// Where the prescribed points are after a part of the motion: (amount, displacements from the
/// mesh).
using WarpMotion = std::function<void(double, double*)>;

/**
 * @brief The motion in steps, each from the mesh the one before came to.
 * @param steps so many of equal length; 0: as few as it takes for no element to invert. There a
 * step that inverts elements is halved, and the next grows again; if steps become too small or too
 * many, the result is the mesh of the last good one.
 * @param following see WarpStep::setFollowing(); the first of such steps is short
 */
void warpInSteps(const Mesh& mesh, const WarpParts& parts, const WarpMotion& motion, int steps,
  bool following, WarpControl& control);
}
#endif
