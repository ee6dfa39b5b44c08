/**
 * @file ColorMaps.h
 * @brief Default colour maps for the cell arrays that Tautline's filters write.
 *
 * ParaView keeps colour maps per array name and looks for a default in its settings. The function
 * below writes such settings: an ideal element is pale, a bad one dark red, one outside the range
 * darker still, and an inverted one (its value lies below the range) magenta. The range is fixed, so
 * that one colour means one quality in every picture.
 */

#ifndef tautline_ColorMaps_h
#define tautline_ColorMaps_h

#include <string>
#include <vector>

namespace tautline
{

struct ColorMapSpec
{
  std::string array;    ///< name of the cell array
  bool smallerIsBetter; ///< where on the range the ideal element is
  double low;           ///< lower end of the range; what lies below it is inverted
  double high;          ///< upper end of the range
};

/** The colour maps of all arrays Tautline writes. */
std::vector<ColorMapSpec> defaultColorMaps();

/** ParaView settings, as JSON text, that make these colour maps the default of their arrays. */
std::string colorMapSettings(const std::vector<ColorMapSpec>& specs);

} // namespace tautline

#endif
