// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file SideBySide.h
 * @brief The quality of a mesh before and after a filter, in two views beside each other.
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
 * @brief Opens a layout with two views: on the left the mesh before the filter, on the right the
 * one after it.
 *
 * Both are measured by Element Quality, with its default metric. Inverted elements inside are
 * visible.
 * Of Match Shape: on the left the source mesh, on the right what was found, each over its image.
 * The colours mean the same in both views, and the legend is in the right one; the cameras are
 * linked. A text in each view has the worst value and the number of inverted elements. The filter
 * stays the active source.
 * @return "" or what is wrong, with the remedy
 */
QString showSideBySide(pqPipelineSource* filter);

} // namespace tautline

#endif
