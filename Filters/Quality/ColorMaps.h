// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ColorMaps.h
 * @brief Default color maps for the cell arrays written by Tautline's filters.
 *
 * ParaView keeps one color map per array name and looks for its default in the settings. The
 * functions below write such settings from the registry of metrics: an ideal element is pale, an
 * element at the end of the acceptable range dark red, and a worse one even darker; an inverted
 * element is blue if the sign of the metric shows inversion. Nothing else is blue, and nothing is
 * magenta, the color of ParaView's selections. The range is fixed, so that a color means the same
 * quality in every picture, before and after. Differences of a metric are green if the element
 * became better, orange if it became worse. A size, for which neither small nor large is good,
 * keeps ParaView's own map. The legends have the metric's label.
 */

#ifndef tautline_ColorMaps_h
#define tautline_ColorMaps_h

#include "TautlineQualityModule.h" // for export macro

#include <array>
#include <string>
#include <vector>

namespace tautline
{

/** Red, green and blue of inverted elements, 0 to 1. */
constexpr double InvertedColor[3] = { 0.05, 0.35, 1.0 };

struct ColorMapSpec
{
  std::string array;    ///< name of the cell array
  double good;          ///< value of the ideal element
  double bad;           ///< the end of the acceptable range; below `good` if larger is better
  double worst;         ///< of a valid element; may be infinite
  bool negativeInverts; ///< inverted elements have values below the range
  std::string title{};  ///< of the legend; "" for the name of the array
};

/**
 * @brief The color maps of all metrics that have a direction and a finite acceptable range, and of
 * the arrays *metric* _before and _after with the same range.
 */
TAUTLINEQUALITY_EXPORT std::vector<ColorMapSpec> metricColorMaps();

/**
 * @brief The color of a value, as drawn by ParaView with these maps: red, green and blue, 0 to 1.
 *
 * Between the colors of the map it is interpolated in RGB instead of Lab, with hardly any
 * difference.
 */
TAUTLINEQUALITY_EXPORT std::array<double, 3> colorOf(const ColorMapSpec& spec, double value);

/**
 * @brief ParaView settings, as JSON text, that make these color maps the default of their arrays.
 *
 * They also have color maps for the arrays *metric* _difference and for arrays that are not
 * metrics: by category for `Validity`, `Change` and `Grade`, and sequential for `Excess`, `Energy`
 * and others.
 */
TAUTLINEQUALITY_EXPORT std::string colorMapSettings(const std::vector<ColorMapSpec>& specs);

} // namespace tautline

#endif
