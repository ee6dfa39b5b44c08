// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file WorstElements.h
 * @brief The elements of a filter's output that need attention, worst first.
 */

#ifndef tautline_WorstElements_h
#define tautline_WorstElements_h

#include "ElementSelection.h"

#include <string>
#include <vector>

class pqPipelineSource;

namespace tautline
{

/// An element and its defect.
struct WorstElementEntry
{
  ElementName name;
  double value = 0;
  std::string text; ///< "imr -2.1, inverted"
};

/// Criterion that finds the elements of a list in the mesh.
enum class Ranking
{
  Complete, ///< already found
  Invalid,  ///< inverted or degenerate, by the array Validity
  Largest,  ///< with the largest values of the array
  Smallest
};

/// Elements by one measure, worst first.
struct WorstElementList
{
  std::string label; ///< of the measure, for a menu: "Inverse mean ratio"
  std::string array; ///< the cell array with its values
  std::vector<WorstElementEntry> elements;
  Ranking ranking = Ranking::Complete; ///< otherwise completeList() adds the elements

  /// Whether the largest values of the array are the worst; otherwise the smallest.
  bool largestIsWorst() const;
};

/**
 * @brief The lists of an executed filter.
 *
 * Element Quality: one list per metric, from its output Worst. Untangle Mesh: the elements that are
 * not valid, from the array Obstacle. Improve Mesh: the elements in its output Remaining, and a
 * list for each of its two measures. Optimize Mesh, Warp Mesh: the invalid elements, if any.
 * Optimize Mesh, Compare Meshes: one list per metric measured before and after. Condition
 * Estimator: the largest Share and Excess. Other filters, and filters before their first execution,
 * have no lists.
 */
std::vector<WorstElementList> worstElementsOf(pqPipelineSource* source);

/// Finds the elements of an incomplete list, which is slow for a large mesh.
void completeList(pqPipelineSource* source, WorstElementList& list);

} // namespace tautline

#endif
