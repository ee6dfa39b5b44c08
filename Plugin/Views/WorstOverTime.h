// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WorstOverTime.h
 * @brief The worst value of a metric at each time step, as a chart.
 */

#ifndef tautline_WorstOverTime_h
#define tautline_WorstOverTime_h

#include <string>

class pqOutputPort;

namespace tautline
{

/**
 * @brief Adds ParaView's Plot Data Over Time of a mesh, and shows the extreme of an array in a
 * chart.
 * @param array a cell array of the mesh
 * @param largest whether the largest value is the worst, otherwise the smallest
 * @return "" or what is wrong, with the remedy; then nothing changes.
 */
std::string plotWorstOverTime(pqOutputPort* mesh, const std::string& array, bool largest);

/// Whether the server has time steps to plot over.
bool hasTimeSteps(pqOutputPort* mesh);

} // namespace tautline

#endif
