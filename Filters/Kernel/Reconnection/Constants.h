// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Constants.h
 * @brief Constants shared by the reconnection of tetrahedra and of triangles.
 * Internal: not installed.
 */
#ifndef tautline_ReconnectionConstants_h
#define tautline_ReconnectionConstants_h

#include "tautline/Core/Types.h"

namespace tautline
{
inline double radians(double degrees)
{
  return degrees * (Pi / 180.0);
}

/// A cell this close to the bound of its quality is at it.
constexpr double AtBound = 1e-3;
/// Two qualities that differ by less are equal: rounding must not decide.
constexpr double SameQuality = 1e-9;
/// With ReconnectionOptions::adapt, tetrahedra below this quality are below the target: a mean
/// ratio in the metric of 0.5.
constexpr double AdaptedQuality = 0.35;
/// A smaller fraction of the volume of a tetrahedron, or of the area of a triangle, is rounding
/// error.
constexpr double RoundingFraction = 1e-12;
/// Rounding in the distance from a flat patch, relative to the diagonal.
constexpr double LeastDistance = 1e-12;
/// Angle of the preset RemoveSlivers; the other presets use the default of the options.
constexpr double SliverAngle = 15.0;
/// The wall time between two calls of the observer during a pass.
constexpr double ObserverSeconds = 0.1;

/// Sweeps for the mean end when one decreases the sum by less than this fraction, or after this
/// number.
constexpr double LeastMeanDecrease = 2e-5;
constexpr int MaxMeanSweeps = 60;
/// The number of points between two calls of the observer in these sweeps.
constexpr int MeanInterval = 256;
/// The number of halvings of a step that is too long.
constexpr int Halvings = 6;
/// The smallest decrease that is kept, relative to the sum.
constexpr double LeastDecrease = 1e-7;
}
#endif
