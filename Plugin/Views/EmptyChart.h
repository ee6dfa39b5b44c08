// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file EmptyChart.h
 * @brief No chart where there is nothing to draw, or where the dock of the run draws it.
 *
 * ParaView opens the chart of an output when the filter is applied first, also if the filter has
 * refused its input and the table is empty, or has nothing to do and the table is one row. It takes
 * half of the space of the mesh.
 */

#ifndef tautline_EmptyChart_h
#define tautline_EmptyChart_h

class pqDataRepresentation;
class pqPipelineSource;

namespace tautline
{

/**
 * Closes the chart of an output without rows, of a line of one row, or of a run that the dock
 * draws, with its view, if there is nothing else in it. `chart` is deleted then. Not for other
 * displays. Call it outside of Apply.
 */
void closeNeedlessChart(pqDataRepresentation* chart);

/// Opens the chart that was closed as empty, once there is something to draw.
void openClosedChart(pqPipelineSource* source);

} // namespace tautline

#endif
