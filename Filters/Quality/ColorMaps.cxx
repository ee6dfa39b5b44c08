#include "ColorMaps.h"

#include "tautline/Quality/Metrics.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <sstream>
#include <utility>

namespace tautline
{
namespace
{

struct Stop
{
  double badness; // 0 ideal, 1 the end of the acceptable range
  const char* rgb;
};

// Lightness falls steadily, so that the map reads without colour vision too.
constexpr Stop Ramp[] = { { 0.0, "0.84, 0.90, 0.93" }, { 0.3, "0.99, 0.90, 0.55" },
  { 0.65, "0.96, 0.55, 0.20" }, { 1.0, "0.72, 0.06, 0.11" } };
constexpr const char* WorseColor = "0.30, 0.00, 0.05";
constexpr const char* InvertedColor = "1.0, 0.0, 1.0";
constexpr const char* NanColor = "0.2, 0.2, 0.2";

// ParaView drops every other character of an array name before it looks for a default.
std::string settingsKey(std::string name)
{
  name.erase(std::remove_if(name.begin(), name.end(),
               [](unsigned char c) { return !std::isalnum(c) && c != '_'; }),
    name.end());
  return name;
}

// "value, r, g, b, ..." by rising value.
std::string rgbPoints(const ColorMapSpec& spec)
{
  std::vector<std::string> points;
  const auto add = [&points](double value, const char* rgb)
  {
    std::ostringstream point;
    point << value << ", " << rgb;
    points.push_back(point.str());
  };
  for (const Stop& stop : Ramp)
  {
    add(spec.good + stop.badness * (spec.bad - spec.good), stop.rgb);
  }
  if (spec.bad < spec.good)
  {
    if (std::isfinite(spec.worst) && spec.worst < spec.bad)
    {
      // Just beyond the acceptable range, then to its very end: a sharp change of colour.
      add(spec.bad - 1e-6 * (spec.good - spec.bad), WorseColor);
      add(spec.worst, WorseColor);
    }
    std::reverse(points.begin(), points.end());
  }
  std::ostringstream text;
  std::copy(points.begin(), points.end() - 1, std::ostream_iterator<std::string>(text, ", "));
  text << points.back();
  return text.str();
}

std::string metricTable(const ColorMapSpec& spec)
{
  const bool largerIsBetter = spec.bad < spec.good;
  std::ostringstream json;
  json << "\"" << settingsKey(spec.array) << "\": { \"PVLookupTable\": {\n"
       << "  \"RGBPoints\": [" << rgbPoints(spec) << "],\n"
       << "  \"ColorSpace\": \"Lab\",\n"
       << "  \"AutomaticRescaleRangeMode\": \"Never\", \"ScalarRangeInitialized\": 1,\n"
       << "  \"UseBelowRangeColor\": " << (spec.negativeInverts || largerIsBetter)
       << ", \"BelowRangeColor\": [" << (spec.negativeInverts ? InvertedColor : WorseColor)
       << "],\n"
       << "  \"UseAboveRangeColor\": " << !largerIsBetter << ", \"AboveRangeColor\": ["
       << WorseColor << "],\n"
       << "  \"NanColor\": [" << NanColor << "] } }";
  return json.str();
}

std::string validityTable()
{
  const std::pair<Validity, std::pair<const char*, const char*>> categories[] = {
    { Valid, { "valid", Ramp[0].rgb } }, { Degenerate, { "degenerate", WorseColor } },
    { Inverted, { "inverted", InvertedColor } }, { NotMeasured, { "not measured", NanColor } },
    { NonFinite, { "not finite", "1.0, 1.0, 0.0" } }
  };
  std::string annotations;
  std::string colors;
  for (const auto& category : categories)
  {
    const char* separator = annotations.empty() ? "" : ", ";
    annotations +=
      separator + ("\"" + std::to_string(category.first) + "\", \"") + category.second.first + "\"";
    colors += separator + std::string(category.second.second);
  }
  return "\"Validity\": { \"PVLookupTable\": {\n"
         "  \"IndexedLookup\": 1, \"AutomaticRescaleRangeMode\": \"Never\",\n"
         "  \"Annotations\": [" +
    annotations + "],\n  \"IndexedColors\": [" + colors + "] } }";
}

} // anonymous namespace

//------------------------------------------------------------------------------
std::vector<ColorMapSpec> metricColorMaps()
{
  std::vector<ColorMapSpec> specs;
  for (const MetricInfo& info : metricRegistry())
  {
    if (info.direction == Direction::Neutral)
    {
      continue;
    }
    // One array name serves both dimensions: the wider range.
    Range acceptable = info.acceptable(info.in3D ? 3 : 2);
    if (info.in2D)
    {
      acceptable.low = std::min(acceptable.low, info.acceptable2D.low);
      acceptable.high = std::max(acceptable.high, info.acceptable2D.high);
    }
    const Range& full = info.full(info.in3D ? 3 : 2);
    const bool smaller = info.direction == Direction::SmallerIsBetter;
    const ColorMapSpec spec = { info.name, smaller ? acceptable.low : acceptable.high,
      smaller ? acceptable.high : acceptable.low, smaller ? full.high : full.low,
      info.inverted == InvertedValue::Negative };
    if (std::isfinite(spec.good) && std::isfinite(spec.bad) && spec.good != spec.bad)
    {
      specs.push_back(spec);
    }
  }
  return specs;
}

//------------------------------------------------------------------------------
std::string colorMapSettings(const std::vector<ColorMapSpec>& specs)
{
  std::string json = "{ \"array_lookup_tables\": {\n";
  for (const ColorMapSpec& spec : specs)
  {
    json += metricTable(spec) + ",\n";
  }
  return json + validityTable() + "\n} }\n";
}

} // namespace tautline
