// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WorstElements.h
 * @brief The elements of a filter's output that a user should look at, the worst first.
 */

#ifndef tautline_WorstElements_h
#define tautline_WorstElements_h

#include "ElementSelection.h"

#include <string>
#include <vector>

class pqPipelineSource;

namespace tautline
{

/// An element, and what is wrong with it.
struct WorstElementEntry
{
  ElementName name;
  double value = 0;
  std::string text; ///< "imr -2.1, inverted"
};

/// Elements by one measure, the worst first.
struct WorstElementList
{
  std::string label; ///< of the measure, for a menu: "Inverse mean ratio"
  std::string array; ///< the cell array with its values
  std::vector<WorstElementEntry> elements;
};

/**
 * @brief The lists of a filter that was executed.
 *
 * Of Element Quality one per metric, of its output Worst. Of Untangle Mesh the elements that are
 * not valid, of the array Obstacle. Of Condition Estimator those of the largest Excess and Share.
 * Of other filters, or before the first execution, none.
 */
std::vector<WorstElementList> worstElementsOf(pqPipelineSource* source);

} // namespace tautline

#endif
