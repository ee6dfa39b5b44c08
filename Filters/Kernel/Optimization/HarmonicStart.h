// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HarmonicStart.h
 * @brief A start for Newton's method on stretched meshes. Internal: not installed.
 */
#ifndef tautline_HarmonicStart_h
#define tautline_HarmonicStart_h

#include "OptimizationProblem.h"

namespace tautline
{
/**
 * @brief The points, 3 numbers each, where the sum of the squared lengths of all edges is smallest
 * and points that are not free stay. Elements may be inverted there. Empty where the solver does
 * not converge. The result does not depend on the number of threads.
 */
std::vector<double> harmonicPoints(OptimizationProblem& problem, const std::vector<double>& start);
}
#endif
