// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Obstacles.h
 * @brief The reasons why tetrahedra are still below the target, and the bounds forced by the walls.
 * Internal: not installed.
 */
#ifndef tautline_Obstacles_h
#define tautline_Obstacles_h

#include "ReconnectionResult.h"
#include "TetrahedronPasses.h"

namespace tautline
{
/**
 * @brief Sets the obstacles, qualities and bounds of the result, including the bounds forced by the
 * walls.
 * @param fixedPoints one flag per point of the input
 */
void findObstacles(const TetrahedronMesh& mesh, const TetrahedronPasses& passes,
  const ReconnectionOptions& options, const std::vector<char>& fixedPoints,
  ReconnectionResult& result);
}
#endif
