// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HarmonicStart.h
 * @brief A start for Newton's method on stretched meshes.
 * Internal: not installed.
 */
#ifndef tautline_HarmonicStart_h
#define tautline_HarmonicStart_h

#include "OptimizationProblem.h"

namespace tautline
{
/// Mean of the inverse mean ratio (1 for ideal elements) below which a start is near the minimum of
/// its sum, so that a harmonic map does not pay off.
constexpr double enoughForHarmonicStart = 1.1;

/**
 * @brief The points, 3 numbers each, that minimize the sum of the squared lengths of all edges with
 * all other points fixed. Elements may be inverted there. Empty if the solver does not converge.
 * The result does not depend on the number of threads nor, up to rounding, on the ranks of the
 * problem, on which it is collective.
 */
std::vector<double> harmonicPoints(OptimizationProblem& problem, const std::vector<double>& start);

/**
 * @brief Shifts free points by up to a part of the shortest edge at each, which depends only on
 * their numbers. The harmonic map of a symmetric mesh may be a saddle of the objective, with a
 * gradient of 0.
 */
void shiftFreePoints(const OptimizationProblem& problem, double part, std::vector<double>& points);
}
#endif
