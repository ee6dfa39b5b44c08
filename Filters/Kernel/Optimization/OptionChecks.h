// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OptionChecks.h
 * @brief What is wrong with the options of optimize(). Internal: not installed.
 */
#ifndef tautline_OptionChecks_h
#define tautline_OptionChecks_h

#include "OptimizeOptions.h"
#include "tautline/Mesh/Mesh.h"

namespace tautline
{
/// Throws Error, with the remedy, for options that are out of range or do not fit the mesh.
void checkOptions(const Mesh& mesh, const OptimizeOptions& options);
}
#endif
