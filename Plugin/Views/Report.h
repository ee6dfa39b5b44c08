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
 * @brief The report of a filter, see vtkHtmlReport: equal to `tautline report` for the same
 * meshes, with all filters from the reader on and their settings.
 *
 * Element Quality measures the mesh with the default metric; if the filter is Element Quality
 * itself, its result is used. The mesh before is the input of the filter, if its mesh differs; for
 * Element Quality, it is the input of the last upstream filter that changed the mesh. Settings are
 * the panel properties that differ from their defaults. A history and other tables of the filter
 * follow.
 *
 * The meshes are transferred to the client, which draws them.
 * @param source an executed filter
 * @param view added as a picture for filters that leave the mesh unchanged, such as Solve PDE, but
 * not for Element Quality; if it draws no meshes, another view that does is used. May be null
 */
QString reportOf(pqPipelineSource* source, pqView* view);

/**
 * @brief Replaces the whole content of a file with a text; after a failure, the old file remains.
 * @return "", or the error
 */
QString saveText(const QString& fileName, const QString& html);

} // namespace tautline

#endif
