#include "ColorMaps.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>

namespace tautline
{
namespace
{

struct Stop
{
  double badness; // 0 ideal, 1 the bad end of the range
  std::array<double, 3> rgb;
};

// Lightness falls steadily, so that the map reads without colour vision too.
const std::array<Stop, 4> Ramp = { { { 0.0, { 0.84, 0.90, 0.93 } }, { 0.3, { 0.99, 0.90, 0.55 } },
  { 0.65, { 0.96, 0.55, 0.20 } }, { 1.0, { 0.72, 0.06, 0.11 } } } };
constexpr const char* WorseThanRangeColor = "[0.30, 0.00, 0.05]";
constexpr const char* InvertedColor = "[1.0, 0.0, 1.0]";
constexpr const char* NanColor = "[0.2, 0.2, 0.2]";

// ParaView drops every other character of an array name before it looks for a default.
std::string settingsKey(std::string name)
{
  name.erase(std::remove_if(name.begin(), name.end(),
               [](unsigned char c) { return !std::isalnum(c) && c != '_'; }),
    name.end());
  return name;
}

std::string rgbPoints(const ColorMapSpec& spec)
{
  auto ramp = Ramp;
  if (!spec.smallerIsBetter)
  {
    std::reverse(ramp.begin(), ramp.end());
  }
  std::ostringstream points;
  for (std::size_t i = 0; i < ramp.size(); ++i)
  {
    const double t = spec.smallerIsBetter ? ramp[i].badness : 1.0 - ramp[i].badness;
    points << (i == 0 ? "" : ", ") << spec.low + t * (spec.high - spec.low);
    for (double channel : ramp[i].rgb)
    {
      points << ", " << channel;
    }
  }
  return points.str();
}

} // anonymous namespace

//------------------------------------------------------------------------------
std::vector<ColorMapSpec> defaultColorMaps()
{
  return { { "imr", true, 1.0, 4.0 } };
}

//------------------------------------------------------------------------------
std::string colorMapSettings(const std::vector<ColorMapSpec>& specs)
{
  std::ostringstream json;
  json << "{ \"array_lookup_tables\": {";
  for (std::size_t i = 0; i < specs.size(); ++i)
  {
    json << (i == 0 ? "\n" : ",\n") << "\"" << settingsKey(specs[i].array)
         << "\": { \"PVLookupTable\": {\n"
         << "  \"RGBPoints\": [" << rgbPoints(specs[i]) << "],\n"
         << "  \"ColorSpace\": \"Lab\",\n"
         << "  \"AutomaticRescaleRangeMode\": \"Never\",\n"
         << "  \"ScalarRangeInitialized\": 1,\n"
         << "  \"UseBelowRangeColor\": 1, \"BelowRangeColor\": " << InvertedColor << ",\n"
         << "  \"UseAboveRangeColor\": " << specs[i].smallerIsBetter
         << ", \"AboveRangeColor\": " << WorseThanRangeColor << ",\n"
         << "  \"NanColor\": " << NanColor << " } }";
  }
  json << "\n} }\n";
  return json.str();
}

} // namespace tautline
