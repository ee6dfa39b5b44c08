// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HtmlReportHistogram.h
 * @brief A histogram of vtkHtmlReport as SVG in HTML.
 */

#ifndef tautline_HtmlReportHistogram_h
#define tautline_HtmlReportHistogram_h

#include "HistogramLayout.h"

#include <string>
#include <vector>

namespace tautline
{

/**
 * @brief A figure with the bars, both axes and the limits.
 * @param caption below it; "" is none
 * @param most the count that the axis reaches at least
 */
std::string htmlHistogram(const MetricHistogram& histogram,
  const std::vector<HistogramLimit>& limits, const std::string& caption, vtkIdType most);

} // namespace tautline

#endif
