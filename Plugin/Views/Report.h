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
 * @brief The report of a filter, see vtkHtmlReport: that of `tautline report` for the same meshes,
 * with the filters and their settings from the reader on.
 *
 * Its mesh is measured by Element Quality with the default metric, unless the filter is Element
 * Quality itself, whose result is taken. The mesh before is the input of the filter, if its mesh
 * differs; for Element Quality, the input of the last filter before it that has changed the mesh.
 * Settings are the properties of the panels that differ from their default. A history and other
 * tables of the filter follow.
 *
 * The meshes are brought to the client, which draws them.
 * @param source a filter that was executed
 * @param view what it shows is added for filters other than Element Quality that leave the mesh as
 * it is, such as Solve PDE; if it draws no meshes, another one that does. May be null
 */
QString reportOf(pqPipelineSource* source, pqView* view);

/**
 * @brief Replaces a file by a text as a whole: after a failure the older file is still there.
 * @return "" or what is wrong
 */
QString saveText(const QString& fileName, const QString& html);

} // namespace tautline

#endif
