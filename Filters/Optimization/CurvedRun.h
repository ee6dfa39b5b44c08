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
/// The settings for an OptimizerSetup of the corners; the boundary and its geometry apply to all
/// nodes.
OptimizerSettings settingsOfCorners(const OptimizerSettings& settings);

/**
 * @brief Optimizes all nodes.
 * @param setup of the corners; its objectives are used Throws Error, with the remedy, for settings
 * that curved cells do not support.
 */
OptimizeResult runCurved(const OptimizerSettings& settings, OptimizerSetup& setup,
  CurvedMotion& motion, const InputBlock& block);
}
#endif
