// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file AutomaticMethod.h
 * @brief Which methods move the points of a stage, and when Automatic goes over from one to
 * another.
 * Internal: not installed.
 */
#ifndef tautline_AutomaticMethod_h
#define tautline_AutomaticMethod_h

#include "OptimizationSteps.h"

namespace tautline
{
/**
 * @brief Moves the points of a stage to convergence, by the optimizer wanted.
 *
 * Automatic sweeps; for one sum it begins with Newton's method where most elements have several
 * corners, and goes over to it where sweeps converge too slowly: from the start, or near the
 * minimum from where they are. If its matrix does not fit into memory the sweeps go on; if it does
 * not get as far as they did, their points are kept. Where sweeps fail, as those of several
 * objectives can, LimitedMemoryBFGS goes on; it is the method for metrics without derivatives of
 * their own, too. With points that slide on a surface, sweeps and
 * Newton's method, which holds points on curved parts, take turns.
 *
 * @param onlyLocal constraints that only sweeps keep
 * @param first the record of the start
 * @param history of the run, whose last record may change
 * @param reason set to why the last method ended
 * @return whether an element that was left out has become valid
 */
bool movePoints(OptimizationSteps& steps, const OptimizeOptions& options, bool onlyLocal,
  const IterationRecord& first, std::vector<IterationRecord>& history, StopReason& reason);
}
#endif
