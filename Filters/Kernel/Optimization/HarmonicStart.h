// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HarmonicStart.h
 * @brief A start for Newton's method on stretched meshes. Internal: not installed.
 */
#ifndef tautline_HarmonicStart_h
#define tautline_HarmonicStart_h

#include "OptimizationProblem.h"
#include "tautline/Objectives/MatrixRows.h"

namespace tautline
{
/// Of the mean ratio, 1 for ideal elements: below, a start is near the minimum of its sum, and not
/// worth a harmonic map.
constexpr double enoughForHarmonicStart = 1.1;

/**
 * @brief The points, 3 numbers each, where the sum of the squared lengths of all edges is smallest
 * and points that are not free stay. Elements may be inverted there. Empty where the solver does
 * not converge. The result does not depend on the number of threads.
 */
std::vector<double> harmonicPoints(OptimizationProblem& problem, const std::vector<double>& start);

/**
 * @brief Shifts free points by up to a part of the shortest edge at each, which depends on their
 * numbers only. The harmonic map of a symmetric mesh may be a saddle of the objective, with a
 * gradient of 0.
 * @param free one flag per point
 * @param numbers one per point, or null: 0, 1, ...
 */
void shiftFreePoints(const Mesh& mesh, const std::vector<unsigned char>& free, const Index* numbers,
  double part, std::vector<double>& points);

/**
 * @brief The same as harmonicPoints() for a mesh on several ranks. Does not depend on the ranks, to
 * rounding. Collective.
 * @param problem of the local part; null on a rank without cells
 * @param points the local points at the start, which are moved; not if the solver does not converge
 * @return whether it does
 */
bool harmonicPointsOnRanks(const DistributedMesh& mesh, const MatrixRows& rows,
  OptimizationProblem* problem, int threads, std::vector<double>& points);
}
#endif
