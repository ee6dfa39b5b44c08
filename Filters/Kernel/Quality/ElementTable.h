// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ElementTable.h
 * @brief A metric of many elements at once (MetricArgument::Elements), evaluated for all elements
 * of a mesh before the sums over them.
 * Internal: not installed.
 */
#ifndef tautline_ElementTable_h
#define tautline_ElementTable_h

#include "Batch.h"

#include <vector>

namespace tautline
{
/// Values and derivatives of all elements of a mesh.
struct ElementTable
{
  std::vector<double> values; ///< one per cell of the view; NaN where the metric is undefined
  /// 3 per entry of the connectivity of the view: derivatives with respect to the coordinates of
  /// that point.
  std::vector<double> slopes;
};

/**
 * @brief Evaluates a metric of many elements at the points of the mesh, block by block, in the
 * calling thread.
 * @param withSlopes by central differences: 6 evaluations for each corner of an element
 */
ElementTable tabulate(const Mesh& mesh, const MetricInfo& info, bool withSlopes);

/// Evaluators that look up BatchContext::table; they read Batch::cells.
MetricCode tableMetricCode();
}
#endif
