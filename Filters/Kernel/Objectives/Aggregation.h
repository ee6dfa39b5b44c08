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
/// Which rows couple how strongly: the columns of each row, and one number each.
struct Graph
{
  std::vector<std::int32_t> starts, columns;
  std::vector<float> strengths;
};

/**
 * @brief Joins rows in pairs: each row in turn with the row not yet joined that it couples to most
 * strongly. A row stays alone where these couplings are weak beside its strongest.
 * @param aggregate of each row
 * @return the number of aggregates
 */
std::int32_t pairUp(const Graph& graph, std::vector<std::int32_t>& aggregate);

/**
 * @brief The graph of the aggregates.
 * @param count of the aggregates
 * @param places in it of each place of the fine one
 */
Graph joined(const Graph& fine, const std::vector<std::int32_t>& aggregate, std::int32_t count,
  std::vector<std::int32_t>& places);

/// Rows joined in pairs, several times.
struct Aggregates
{
  Graph graph;                         ///< of the aggregates
  std::vector<std::int32_t> ofRow;     ///< the aggregate of each row
  std::vector<std::int32_t> places;    ///< in the graph, of each place of the fine one
  std::vector<std::int32_t> diagonals; ///< the place of each aggregate's own column
};
Aggregates aggregate(Graph fine, int pairings);
}
#endif
