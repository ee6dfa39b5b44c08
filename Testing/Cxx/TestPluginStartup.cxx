// What the plugin does when it is loaded, as far as it needs no ParaView.
#include "Check.h"

#include "ColorMaps.h"
#include "VersionCheck.h"

namespace
{

void testVersionCheck()
{
  const tautline::ParaViewVersion built = { 5, 11, 0, "9.2.20230111" };
  TAUTLINE_CHECK(tautline::versionMismatch(built, built).empty());
  const tautline::ParaViewVersion others[] = { { 5, 11, 1, "9.2.20230111" },
    { 5, 12, 0, "9.2.20230111" }, { 6, 11, 0, "9.2.20230111" }, { 5, 11, 0, "9.3.0" } };
  for (const auto& running : others)
  {
    const std::string message = tautline::versionMismatch(built, running);
    TAUTLINE_CHECK(message.find("built for ParaView 5.11.0") != std::string::npos);
    TAUTLINE_CHECK(message.find("build it again") != std::string::npos);
  }
}

void testColorMaps()
{
  const std::string json =
    tautline::colorMapSettings({ { "mean ratio", false, 0.0, 1.0 }, { "imr", true, 1.0, 4.0 } });
  const auto has = [&json](const char* text) { return json.find(text) != std::string::npos; };
  TAUTLINE_CHECK(has("\"meanratio\""));
  TAUTLINE_CHECK(has("\"imr\""));
  TAUTLINE_CHECK(has("[0, 0.72, 0.06, 0.11, 0.35,")); // larger is better: red at the low end
  TAUTLINE_CHECK(has("[1, 0.84, 0.9, 0.93, 1.9,"));   // smaller is better: pale at the low end
}

} // anonymous namespace

int TestPluginStartup(int, char*[])
{
  testVersionCheck();
  testColorMaps();
  return tautline::exitCode();
}
