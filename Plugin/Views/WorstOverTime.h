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
 * @brief Applies ParaView's Plot Data Over Time to a mesh, and shows the worst value of an array in
 * a chart.
 * @param array a cell array of the mesh
 * @param largest whether the largest value is the worst, otherwise the smallest
 * @return "", or the error with a fix; then nothing changes.
 */
std::string plotWorstOverTime(pqOutputPort* mesh, const std::string& array, bool largest);

/// Whether the server has several time steps to plot.
bool hasTimeSteps(pqOutputPort* mesh);

} // namespace tautline

#endif
