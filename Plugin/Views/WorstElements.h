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

/// How the elements of a list are found in the mesh.
enum class Ranking
{
  Complete, ///< they were found
  Invalid,  ///< inverted or degenerate, by the array Validity
  Largest,  ///< with the largest values of the array
  Smallest
};

/// Elements by one measure, the worst first.
struct WorstElementList
{
  std::string label; ///< of the measure, for a menu: "Inverse mean ratio"
  std::string array; ///< the cell array with its values
  std::vector<WorstElementEntry> elements;
  Ranking ranking = Ranking::Complete; ///< otherwise completeList() adds the elements

  /// Whether the largest values of the array are the worst, not the smallest.
  bool largestIsWorst() const;
};

/**
 * @brief The lists of a filter that was executed.
 *
 * Element Quality: one per metric, of its output Worst. Untangle Mesh: the elements that are not
 * valid, of the array Obstacle. Improve Mesh: those of its output Remaining, and by both measures.
 * Optimize Mesh, Warp Mesh: the invalid ones, if any. Optimize Mesh, Compare Meshes: by each metric
 * that was measured before and after. Condition Estimator: the largest Share and Excess.
 * None for other filters, and before the first execution.
 */
std::vector<WorstElementList> worstElementsOf(pqPipelineSource* source);

/// Finds the elements of a list that is not complete, which takes a while in a large mesh.
void completeList(pqPipelineSource* source, WorstElementList& list);

} // namespace tautline

#endif
