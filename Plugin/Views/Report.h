// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Report.h
 * @brief The result of a filter as one HTML file that needs no other file.
 */

#ifndef tautline_Report_h
#define tautline_Report_h

#include <QString>

class pqPipelineSource;
class pqView;

namespace tautline
{

/**
 * @brief The report: name, date, mesh, settings, summary, histograms, the filter's tables and a
 * picture.
 *
 * The settings are those of the filter's panel. The tables are the outputs that are tables: of
 * Element Quality the statistics, of Optimize Mesh the quality before and after. Of long tables the
 * first rows are in the report, and their number.
 * @param source a filter that was executed
 * @param view what it shows is the picture; if it draws no meshes, another one that does. May be
 * null
 */
QString reportOf(pqPipelineSource* source, pqView* view);

/**
 * @brief Replaces a file by a text as a whole: after a failure the older file is still there.
 * @return "" or what is wrong
 */
QString saveText(const QString& fileName, const QString& html);

} // namespace tautline

#endif
