// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file AutomaticMethod.h
 * @brief The methods that move the points of a stage, and the switching rules of Automatic.
 * Internal: not installed.
 */
#ifndef tautline_AutomaticMethod_h
#define tautline_AutomaticMethod_h

#include "OptimizationSteps.h"

namespace tautline
{
/**
 * @brief Moves the points of a stage to convergence with the selected optimizer.
 *
 * Automatic uses sweeps; for a single sum, it starts with Newton's method if most elements have
 * several corners, and switches to it if sweeps converge too slowly: from the start or, near the
 * minimum, from the current points. If its matrix does not fit into memory, the sweeps continue; if
 * its result is worse, the points of the sweeps are kept. If sweeps fail, which can happen with
 * several objectives, LimitedMemoryBFGS continues; it is also the method for metrics without
 * analytic derivatives. With points that slide on a surface, sweeps alternate with Newton's method,
 * which holds points on curved parts.
 *
 * @param onlyLocal whether there are constraints that only sweeps satisfy
 * @param first the record of the start
 * @param history of the run; its last record may change
 * @param reason set to the reason why the last method ended
 * @return whether an excluded element has become valid
 */
bool movePoints(OptimizationSteps& steps, const OptimizeOptions& options, bool onlyLocal,
  const IterationRecord& first, std::vector<IterationRecord>& history, StopReason& reason);
}
#endif
