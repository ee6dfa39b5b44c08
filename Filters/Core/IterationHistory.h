// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file IterationHistory.h
 * @brief Reports the iterations of filters that move points as rows of a table and as sentences.
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

/// Sentences with the reason for stopping, iterations, seconds, free points and inverted elements.
/// @param diagonal of the bounding box of the mesh, see surfaceErrorSentence()
TAUTLINECORE_EXPORT std::string summarize(
  const OptimizeResult& result, const MovableMesh& mesh, const std::string& block, double diagonal);

/// "0.01, 0.2 % of the diagonal of the bounding box", or the distance alone if the diagonal is 0.
TAUTLINECORE_EXPORT std::string distanceText(double distance, double diagonal);

/**
 * @brief "\nLargest distance of the elements from the surface: 0.01, 0.2 % of the diagonal of the
 * bounding box."; "" if the error is 0.
 * @param diagonal of the mesh in the same unit, or 0: not known
 */
TAUTLINECORE_EXPORT std::string surfaceErrorSentence(double surfaceError, double diagonal);

/// The prefix of a sentence that warns of a problem in the result; panels show it in red.
constexpr const char* WarningPrefix = "Warning: ";

/// "18 elements are inverted or degenerate (51 before)."; "" if none are inverted after.
TAUTLINECORE_EXPORT std::string invalidSentence(Index before, Index after);
}
#endif
