// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SideBySide.h
 * @brief The quality of a mesh before and after a filter, in two views side by side.
 */

#ifndef tautline_SideBySide_h
#define tautline_SideBySide_h

#include <QString>

class pqPipelineSource;

namespace tautline
{

/// Whether a filter's input and output are meshes that can be measured.
bool changesMesh(pqPipelineSource* filter);

/**
 * @brief Opens a layout with two views: the mesh before the filter on the left, and after it on
 * the right.
 *
 * Element Quality measures both with its default metric. Inverted elements inside are visible.
 * For Match Shape, the source mesh is on the left and the match on the right, each over its image.
 * Both views have the same color scale; the legend is in the right view, and the cameras are
 * linked. A text in each view shows the worst value and the number of inverted elements. The filter
 * remains the active source.
 * @return "", or the error with a fix
 */
QString showSideBySide(pqPipelineSource* filter);

} // namespace tautline

#endif
