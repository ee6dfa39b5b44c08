// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file EmptyChart.h
 * @brief Closes charts that have nothing to draw or that the run dock already draws.
 *
 * ParaView opens the chart of an output when the filter is first applied, even if the filter
 * rejected its input (the table is empty) or had nothing to do (the table has one row). The chart
 * takes half of the space of the mesh.
 */

#ifndef tautline_EmptyChart_h
#define tautline_EmptyChart_h

class pqDataRepresentation;
class pqPipelineSource;

namespace tautline
{

/**
 * Closes a chart that has no rows, is a line with one row, or belongs to a run that the dock draws.
 * Its view is also closed if it shows nothing more. `chart` is then deleted. Other displays are
 * unchanged. Call it outside of Apply.
 */
void closeNeedlessChart(pqDataRepresentation* chart);

/// Reopens a chart that was closed as empty, once there is something to draw.
void openClosedChart(pqPipelineSource* source);

} // namespace tautline

#endif
