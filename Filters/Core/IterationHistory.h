// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file IterationHistory.h
 * @brief The iterations of filters that move points, as rows of a table and as sentences.
 */
#ifndef tautline_IterationHistory_h
#define tautline_IterationHistory_h

#include "TautlineCoreModule.h" // for export macro

#include "MovableMesh.h"
#include "TableRows.h"
#include "tautline/Optimization/Optimize.h"

#include <string>
#include <vector>

namespace tautline
{
/**
 * @brief Adds a row per iteration: `Block` (composite input), `Objective`, for each name `<name>
 * objective` (if there are several), `<name> mean`, `<name> worst`; `Inverted`, `N gradient`, `N
 * moving`, `Time (s)`. Row i is iteration i of the block; row 0 is the input. ParaView's charts
 * leave out the last two.
 */
TAUTLINECORE_EXPORT void addHistory(TableRows& rows, const std::vector<IterationRecord>& history,
  const std::vector<std::string>& names, const std::string& block);

/// Reason, iterations, seconds, free points and inverted elements, in sentences.
TAUTLINECORE_EXPORT std::string summarize(
  const OptimizeResult& result, const MovableMesh& mesh, const std::string& block);

/// "\nLargest distance of the elements from the surface: 0.01."; "" if the error is 0.
TAUTLINECORE_EXPORT std::string surfaceErrorSentence(double surfaceError);
}
#endif
