// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file CriteriaTicks.h
 * @brief The limits of the quality criteria as labels of a legend.
 */

#ifndef tautline_CriteriaTicks_h
#define tautline_CriteriaTicks_h

#include <string>
#include <vector>

class pqDataRepresentation;
class vtkSMProxy;

namespace tautline
{

/**
 * @brief The values of a metric that the criteria warn or fail at, of all types of cells, in
 * increasing order.
 * @param criteria the name of a preset, or JSON; none for other text, such as a file on the server
 */
std::vector<double> criteriaLimits(const std::string& criteria, const std::string& metric);

/**
 * @brief Labels the legend of a mesh by the limits of the criteria that lie in the range of its
 * colors, and by the ends of the range. Without criteria for the metric, restores ParaView's labels
 * if the legend had labels of criteria.
 * @param shown the mesh, an output of `quality`
 * @param quality the filter with the property Criteria
 */
void labelLegend(pqDataRepresentation* shown, vtkSMProxy* quality);

} // namespace tautline

#endif
