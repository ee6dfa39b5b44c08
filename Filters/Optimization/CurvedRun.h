// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CurvedRun.h
 * @brief Optimize Mesh on cells of quadratic and higher order.
 */
#ifndef tautline_CurvedRun_h
#define tautline_CurvedRun_h

#include "CurvedMotion.h"
#include "OptimizerSetup.h"

namespace tautline
{
/// The settings with which an OptimizerSetup is made of the corners: what the boundary does, and
/// what it slides on, is that of all nodes.
OptimizerSettings settingsOfCorners(const OptimizerSettings& settings);

/**
 * @brief Optimizes all nodes.
 * @param setup of the corners; its objectives count
 * Throws Error with the remedy for settings that curved cells do not have.
 */
OptimizeResult runCurved(const OptimizerSettings& settings, OptimizerSetup& setup,
  CurvedMotion& motion, const InputBlock& block);
}
#endif
