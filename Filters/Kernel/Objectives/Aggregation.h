// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Aggregation.h
 * @brief Graphs of rows and the aggregates of multigrid.
 * Internal: not installed.
 */
#ifndef tautline_Aggregation_h
#define tautline_Aggregation_h

#include "tautline/Core/Types.h"

#include <cstdint>
#include <vector>

namespace tautline
{
/// The couplings of rows: the columns of each row, with one strength each.
struct Graph
{
  std::vector<std::int32_t> starts, columns;
  std::vector<float> strengths;
};

/**
 * @brief Joins rows in pairs: each row in turn with the row not yet joined that it couples to most
 * strongly. A row stays single if these couplings are weak compared with its strongest one.
 * @param aggregate of each row
 * @return the number of aggregates
 */
std::int32_t pairUp(const Graph& graph, std::vector<std::int32_t>& aggregate);

/**
 * @brief The graph of the aggregates.
 * @param count of the aggregates
 * @param the position in it for each position of the fine graph
 */
Graph joined(const Graph& fine, const std::vector<std::int32_t>& aggregate, std::int32_t count,
  std::vector<std::int32_t>& places);

/// Rows joined in pairs several times.
struct Aggregates
{
  Graph graph;                     ///< of the aggregates
  std::vector<std::int32_t> ofRow; ///< the aggregate of each row
  /// the position in the graph, for each position of the fine graph
  std::vector<std::int32_t> places;
  std::vector<std::int32_t> diagonals; ///< the position of the diagonal column of each aggregate
};
Aggregates aggregate(Graph fine, int pairings);
}
#endif
