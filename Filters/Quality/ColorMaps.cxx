// SPDX-License-Identifier: BSD-3-Clause
#include "ColorMaps.h"

#include "tautline/Quality/Criteria.h"
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
  double badness; // 0 for ideal, 1 at the end of the acceptable range
  const char* rgb;
};

// Lightness falls steadily, so that the map is also readable without color vision.
constexpr Stop Ramp[] = { { 0.0, "0.84, 0.90, 0.93" }, { 0.3, "0.99, 0.90, 0.55" },
  { 0.65, "0.96, 0.55, 0.20" }, { 1.0, "0.72, 0.06, 0.11" } };
constexpr const char* WorseColor = "0.30, 0.00, 0.05";
constexpr const char* NanColor = "0.2, 0.2, 0.2";
constexpr const char* EqualColor = "0.90, 0.90, 0.90";
// Changes: neither the dark red of bad elements nor the blue of inverted ones.
constexpr const char* BetterColor = "0.10, 0.52, 0.30";
constexpr const char* DeclinedColor = "0.78, 0.40, 0.05";
constexpr const char* WarningColor = "0.96, 0.55, 0.20";
// For the triangles of Horizon Neighbors: the more corners inside, the darker.
constexpr const char* CaseColors[] = { "0.40, 0.16, 0.40", "0.66, 0.45, 0.66", "0.87, 0.77, 0.87" };

/// The components of a color.
std::array<double, 3> parsed(const char* rgb)
{
  std::istringstream text(rgb);
  std::array<double, 3> color{};
  char comma = ',';
  text >> color[0] >> comma >> color[1] >> comma >> color[2];
  return color;
}

std::string invertedColor()
{
  std::ostringstream text;
  text << InvertedColor[0] << ", " << InvertedColor[1] << ", " << InvertedColor[2];
  return text.str();
}

// ParaView drops every other character of an array name before it looks for a default.
std::string settingsKey(std::string name)
{
  name.erase(std::remove_if(name.begin(), name.end(),
               [](unsigned char c) { return !std::isalnum(c) && c != '_'; }),
    name.end());
  return name;
}

// "value, r, g, b, ..." in order of increasing value.
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
      // Points just beyond and at the end of the acceptable range give a sharp change of color.
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

/// An entry of the settings; a title is looked up by the unchanged name of the array.
std::string entry(const std::string& array, const std::string& title, const std::string& table)
{
  const std::string key = settingsKey(array);
  const std::string legend = title.empty() ? "" : "\"Title\": \"" + title + "\"";
  const bool same = key == array;
  return "\"" + key + "\": { " + (same && !legend.empty() ? legend + ",\n  " : "") +
    "\"PVLookupTable\": {\n" + table + " } }" +
    (same || legend.empty() ? "" : ",\n\"" + array + "\": { " + legend + " }");
}

std::string metricTable(const ColorMapSpec& spec)
{
  const bool largerIsBetter = spec.bad < spec.good;
  std::ostringstream json;
  json << "  \"RGBPoints\": [" << rgbPoints(spec) << "],\n"
       << "  \"ColorSpace\": \"Lab\",\n"
       << "  \"AutomaticRescaleRangeMode\": \"Never\", \"ScalarRangeInitialized\": 1,\n"
       << "  \"UseBelowRangeColor\": " << (spec.negativeInverts || largerIsBetter)
       << ", \"BelowRangeColor\": [" << (spec.negativeInverts ? invertedColor() : WorseColor)
       << "],\n"
       << "  \"UseAboveRangeColor\": " << !largerIsBetter << ", \"AboveRangeColor\": ["
       << WorseColor << "],\n"
       << "  \"NanColor\": [" << NanColor << "]";
  return entry(spec.array, spec.title, json.str());
}

/// Green where the metric became better by half its acceptable range or more, orange where worse.
std::string differenceTable(const ColorMapSpec& spec)
{
  const double end = 0.5 * std::abs(spec.bad - spec.good);
  const bool largerIsBetter = spec.bad < spec.good;
  std::ostringstream json;
  json << "  \"RGBPoints\": [" << -end << ", " << (largerIsBetter ? DeclinedColor : BetterColor)
       << ", 0, " << EqualColor << ", " << end << ", "
       << (largerIsBetter ? BetterColor : DeclinedColor) << "],\n"
       << "  \"ColorSpace\": \"Lab\",\n"
       << "  \"AutomaticRescaleRangeMode\": \"Never\", \"ScalarRangeInitialized\": 1,\n"
       << "  \"NanColor\": [" << NanColor << "]";
  const std::string title = spec.title.empty() ? spec.array : spec.title;
  return entry(spec.array + "_difference", title + ", after - before", json.str());
}

/// The colors of a metric, from the smallest to the largest value of the array.
std::string sequenceTable(const char* array, const char* title)
{
  const ColorMapSpec unit = { array, 0.0, 1.0, 1.0, false };
  return entry(array, title,
    "  \"RGBPoints\": [" + rgbPoints(unit) + "],\n  \"ColorSpace\": \"Lab\",\n" +
      "  \"NanColor\": [" + NanColor + "]");
}

struct Category
{
  int value;
  const char* text;
  std::string rgb;
};

std::string categoryTable(
  const char* array, const char* title, const std::vector<Category>& categories)
{
  std::string annotations, colors;
  for (const Category& category : categories)
  {
    const char* separator = annotations.empty() ? "" : ", ";
    annotations +=
      separator + ("\"" + std::to_string(category.value) + "\", \"") + category.text + "\"";
    colors += separator + category.rgb;
  }
  return entry(array, title,
    "  \"IndexedLookup\": 1, \"AutomaticRescaleRangeMode\": \"Never\",\n  \"Annotations\": [" +
      annotations + "],\n  \"IndexedColors\": [" + colors + "]");
}

/// The arrays that do not hold values of a metric.
std::vector<std::string> otherTables()
{
  const char* good = Ramp[0].rgb;
  const char* bad = Ramp[std::size(Ramp) - 1].rgb;
  const std::vector<Category> validity = { { Valid, "valid", good },
    { Degenerate, "degenerate", WorseColor }, { Inverted, "inverted", invertedColor() },
    { NotMeasured, "not measured", NanColor }, { NonFinite, "not finite", "1.0, 1.0, 0.0" } };
  // Log10 of a ratio: 0 is the mean, 2 a hundred times the mean.
  const ColorMapSpec excess = { "Excess", 0.0, 2.0, 2.0, false,
    "Largest eigenvalue, log10 over mean" };
  // 0 for a triangle that keeps its shape, 2 for a triangle stretched to twice its length.
  ColorMapSpec shape = { "TMP shape", 0.0, 2.0, 2.0, false, "Shape similarity (TMP)" };
  const std::string warped = metricTable(shape);
  shape.array = "tmp_shape";
  return { categoryTable("Validity", "Validity", validity),
    categoryTable("Validity_before", "Validity before", validity),
    categoryTable("Validity_after", "Validity after", validity),
    categoryTable("Change", "Change",
      { { -1, "worse", DeclinedColor }, { 0, "equal", EqualColor }, { 1, "better", BetterColor } }),
    categoryTable("Grade", "Grade",
      { { static_cast<int>(Grade::None), "none", NanColor },
        { static_cast<int>(Grade::Passed), "passed", good },
        { static_cast<int>(Grade::Warning), "warning", WarningColor },
        { static_cast<int>(Grade::Failed), "failed", bad } }),
    categoryTable("Case", "Case: corners inside",
      { { 1, "1: all three", CaseColors[0] }, { 2, "2: two", CaseColors[1] },
        { 3, "3: one", CaseColors[2] }, { 0, "0: none", EqualColor } }),
    warped, metricTable(shape), metricTable(excess), sequenceTable("QualityIndex", "Quality index"),
    sequenceTable("Energy", "Energy of the match"), sequenceTable("EdgeCost", "Edge cost"),
    sequenceTable("Deformation", "Deformation"), sequenceTable("Distortion", "Distortion"),
    sequenceTable("Share", "Share of the eigenvalue"),
    sequenceTable("LargestEigenvalue", "Largest eigenvalue") };
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
    // One array name serves both dimensions: uses the wider range.
    Range acceptable = info.acceptable(info.in3D ? 3 : 2);
    if (info.in2D)
    {
      acceptable.low = std::min(acceptable.low, info.acceptable2D.low);
      acceptable.high = std::max(acceptable.high, info.acceptable2D.high);
    }
    const Range& full = info.full(info.in3D ? 3 : 2);
    const bool smaller = info.direction == Direction::SmallerIsBetter;
    ColorMapSpec spec = { info.name, smaller ? acceptable.low : acceptable.high,
      smaller ? acceptable.high : acceptable.low, smaller ? full.high : full.low,
      info.inverted == InvertedValue::Negative, info.label };
    if (std::isfinite(spec.good) && std::isfinite(spec.bad) && spec.good != spec.bad)
    {
      for (const char* ending : { "", "_before", "_after" })
      {
        spec.array = std::string(info.name) + ending;
        spec.title = info.label + std::string(*ending ? ", " : "") + (*ending ? ending + 1 : "");
        specs.push_back(spec);
      }
    }
  }
  return specs;
}

//------------------------------------------------------------------------------
std::array<double, 3> colorOf(const ColorMapSpec& spec, double value)
{
  const double badness = (value - spec.good) / (spec.bad - spec.good);
  if (!std::isfinite(badness))
  {
    return parsed(NanColor);
  }
  if (spec.negativeInverts && value < 0)
  {
    return { InvertedColor[0], InvertedColor[1], InvertedColor[2] };
  }
  if (badness <= 0 || badness > 1)
  {
    return parsed(badness > 1 ? WorseColor : Ramp[0].rgb);
  }
  std::size_t i = 1;
  while (Ramp[i].badness < badness)
  {
    ++i;
  }
  const double fraction = (badness - Ramp[i - 1].badness) / (Ramp[i].badness - Ramp[i - 1].badness);
  const std::array<double, 3> low = parsed(Ramp[i - 1].rgb), high = parsed(Ramp[i].rgb);
  std::array<double, 3> color{};
  for (std::size_t channel = 0; channel < color.size(); ++channel)
  {
    color[channel] = low[channel] + fraction * (high[channel] - low[channel]);
  }
  return color;
}

//------------------------------------------------------------------------------
std::string colorMapSettings(const std::vector<ColorMapSpec>& specs)
{
  std::string json = "{ \"array_lookup_tables\": {\n";
  for (const ColorMapSpec& spec : specs)
  {
    json += metricTable(spec) + ",\n";
  }
  // One color map for each metric, not for the values before and after.
  for (const ColorMapSpec& spec : specs)
  {
    const auto isMetric = [&spec](const MetricInfo& info) { return spec.array == info.name; };
    const std::vector<MetricInfo>& known = metricRegistry();
    if (std::any_of(known.begin(), known.end(), isMetric))
    {
      json += differenceTable(spec) + ",\n";
    }
  }
  const std::vector<std::string> others = otherTables();
  for (const std::string& other : others)
  {
    json += other + (&other == &others.back() ? "\n" : ",\n");
  }
  return json + "} }\n";
}

} // namespace tautline
