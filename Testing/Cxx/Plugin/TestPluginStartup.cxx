// SPDX-License-Identifier: BSD-3-Clause
// The plugin's actions when it is loaded, as far as they need no ParaView.
#include "ColorMaps.h"
#include "Registry.h"
#include "VersionCheck.h"

#include <limits>

using namespace tautline;

namespace
{

TAUTLINE_PART(testVersionCheck)
{
  const ParaViewVersion built = { 5, 11, 0, "9.2.20230111" };
  TAUTLINE_CHECK(versionMismatch(built, built).empty());
  const ParaViewVersion others[] = { { 5, 11, 1, "9.2.20230111" }, { 5, 12, 0, "9.2.20230111" },
    { 6, 11, 0, "9.2.20230111" }, { 5, 11, 0, "9.3.0" } };
  for (const auto& running : others)
  {
    const std::string message = versionMismatch(built, running);
    TAUTLINE_CHECK(contains(message, wording("built-for-paraview-5-11-0")));
    TAUTLINE_CHECK(contains(message, wording("build-it-again")));
  }
}

TAUTLINE_PART(testColorMapSettings)
{
  const double infinity = std::numeric_limits<double>::infinity();
  const std::string json = colorMapSettings(
    { { "mean ratio", 1.0, 0.2, 0.0, false }, { "imr", 1.0, 4.0, infinity, true } });
  const auto has = [&json](const char* text) { return contains(json, text); };
  TAUTLINE_CHECK(has("\"meanratio\""));
  TAUTLINE_CHECK(has("[0, 0.30, 0.00, 0.05, "));  // worse than acceptable
  TAUTLINE_CHECK(has("0.2, 0.72, 0.06, 0.11, ")); // red at the low end
  TAUTLINE_CHECK(has("\"imr\""));
  TAUTLINE_CHECK(has("[1, 0.84, 0.90, 0.93, 1.9, ")); // pale at the low end
  TAUTLINE_CHECK(has("\"UseBelowRangeColor\": 1, \"BelowRangeColor\": [0.05, 0.35, 1]"));
  TAUTLINE_CHECK(has("\"Validity\""));
  // imr is a metric: an increase by half the range, 1.5, is as orange as it gets, a decrease green.
  TAUTLINE_CHECK(has("\"imr_difference\""));
  TAUTLINE_CHECK(has("[-1.5, 0.10, 0.52, 0.30, 0, 0.90, 0.90, 0.90, 1.5, 0.78, 0.40, 0.05]"));
  TAUTLINE_CHECK(has("\"TMPshape\"") && has("\"TMP shape\": { \"Title\": "));
  TAUTLINE_CHECK(!has("inf") && !has("nan"));
}

TAUTLINE_PART(testMetricColorMaps)
{
  const auto specs = metricColorMaps();
  TAUTLINE_CHECK(!specs.empty());
  // Before and after have the range of the metric.
  const auto find = [&specs](const std::string& array)
  {
    for (const auto& spec : specs)
    {
      if (spec.array == array)
      {
        return spec;
      }
    }
    return ColorMapSpec();
  };
  const auto metric = find("imr"), before = find("imr_before"), after = find("imr_after");
  TAUTLINE_CHECK(metric.good == 1 && metric.bad == 3);
  TAUTLINE_CHECK(before.good == metric.good && before.bad == metric.bad);
  TAUTLINE_CHECK(after.good == metric.good && after.bad == metric.bad);
  TAUTLINE_CHECK(metric.title == "Inverse mean ratio" && before.title != metric.title);
  TAUTLINE_EACH_OF(const auto& spec, specs,
    TAUTLINE_CHECK(std::isfinite(spec.good) && std::isfinite(spec.bad) && spec.good != spec.bad));
}

} // anonymous namespace
