// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ColorMaps.h
 * @brief Default colour maps for the cell arrays that Tautline's filters write.
 *
 * ParaView keeps one colour map per array name and looks for its default in the settings. The
 * functions below write such settings, from the registry of metrics: an ideal element is pale, one
 * at the end of the acceptable range dark red, a worse one darker still, and an inverted one, where
 * the sign of the metric shows it, blue (ParaView 5.11 draws selections in magenta). The range is
 * fixed, so that a colour means the same quality in every picture, before and after. Differences of
 * a metric are green where the element became better, red where it became worse. A size, of which
 * neither small nor large is good, keeps ParaView's own map. The legends have the metric's label.
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
  double bad;           ///< the end of the acceptable range; below `good` where larger is better
  double worst;         ///< of a valid element; may be infinite
  bool negativeInverts; ///< inverted elements have values below the range
  std::string title{};  ///< of the legend; "": the name of the array
};

/**
 * @brief The colour maps of all metrics that have a direction and a finite acceptable range, and of
 * the arrays *metric* _before and _after with the same range.
 */
TAUTLINEQUALITY_EXPORT std::vector<ColorMapSpec> metricColorMaps();

/**
 * @brief The colour of a value, as ParaView draws it with these maps: red, green and blue, 0 to 1.
 *
 * Between the colours of the map it is interpolated in RGB, not in Lab, which is hardly different.
 */
TAUTLINEQUALITY_EXPORT std::array<double, 3> colorOf(const ColorMapSpec& spec, double value);

/**
 * @brief ParaView settings, as JSON text, that make these colour maps the default of their arrays.
 *
 * The arrays *metric* _difference, and those that are no values of a metric, have theirs as well:
 * `Validity`, `Change` and `Grade` by category, `Excess`, `Energy` and the like as sequences.
 */
TAUTLINEQUALITY_EXPORT std::string colorMapSettings(const std::vector<ColorMapSpec>& specs);

} // namespace tautline

#endif
