// SPDX-License-Identifier: BSD-3-Clause
// The registered metrics as text, which a server sends to its client.
#include "RegisteredMetrics.h"
#include "UserMetric.h"

#include <limits>
#include <sstream>

namespace tautline
{
namespace
{
/// The facts of a line after number and label.
enum Field
{
  Name,
  Symbol,
  Aliases,
  Formula,
  Source,
  Unit,
  CellTypes,
  FullLow,
  FullHigh,
  AcceptableLow,
  AcceptableHigh,
  Ideal,
  MetricDirection,
  Inverted,
  Barrier,
  Differentiable,
  ScaleInvariant,
  RotationInvariant,
  Argument,
  NumberOfFields
};

std::string factsOf(const MetricInfo& info)
{
  std::ostringstream text;
  // All digits, so that the client gets the same numbers.
  text.precision(std::numeric_limits<double>::max_digits10);
  const bool volume = info.in3D;
  const Range full = volume ? info.full3D : info.full2D;
  const Range acceptable = volume ? info.acceptable3D : info.acceptable2D;
  text << info.name;
  for (const char* part : { info.symbol, info.aliases, info.formula, info.source, info.unit })
  {
    text << "\t" << part;
  }
  text << "\t" << info.cellTypes << "\t" << full.low << "\t" << full.high << "\t" << acceptable.low
       << "\t" << acceptable.high << "\t" << (volume ? info.ideal3D : info.ideal2D) << "\t"
       << static_cast<int>(info.direction) << "\t" << static_cast<int>(info.inverted) << "\t"
       << info.barrier << "\t" << info.differentiable << "\t" << info.scaleInvariant << "\t"
       << info.rotationInvariant << "\t" << static_cast<int>(info.user->argument());
  return text.str();
}

void mirrorLine(const std::string& line)
{
  std::vector<std::string> parts;
  std::istringstream text(line);
  for (std::string part; std::getline(text, part, '\t');)
  {
    parts.push_back(part);
  }
  constexpr std::size_t before = 2; // number and label
  if (parts.size() != before + NumberOfFields)
  {
    return; // from a server of another version: its menus have the label
  }
  const std::string* field = parts.data() + before;
  const auto number = [field](Field which) { return std::stod(field[which]); };
  const auto whole = [field](Field which) { return std::stoi(field[which]); };
  MetricDescription d;
  d.name = field[Name];
  d.label = parts[1];
  d.symbol = field[Symbol];
  d.aliases = field[Aliases];
  d.formula = field[Formula];
  d.source = field[Source];
  d.unit = field[Unit];
  d.cellTypes = static_cast<unsigned>(whole(CellTypes)) & MetricDescription::allTypes;
  d.full = { number(FullLow), number(FullHigh) };
  d.acceptable = { number(AcceptableLow), number(AcceptableHigh) };
  d.ideal = number(Ideal);
  d.direction = static_cast<Direction>(whole(MetricDirection));
  d.inverted = static_cast<InvertedValue>(whole(Inverted));
  d.barrier = whole(Barrier) != 0;
  d.differentiable = whole(Differentiable) != 0;
  d.scaleInvariant = whole(ScaleInvariant) != 0;
  d.rotationInvariant = whole(RotationInvariant) != 0;
  mirrorMetric(d, static_cast<MetricArgument>(whole(Argument)), line);
}
}

//------------------------------------------------------------------------------
std::string listUserMetrics()
{
  std::string lines;
  for (const MetricInfo& info : metricRegistry())
  {
    // This process cannot evaluate a mirrored metric: it must not offer one.
    if (info.user && isRegisteredHere(info.metric))
    {
      lines += std::to_string(static_cast<int>(info.metric)) + "\t" + info.label + "\t" +
        factsOf(info) + "\n";
    }
  }
  return lines;
}

//------------------------------------------------------------------------------
void mirrorUserMetrics(const std::string& list)
{
  std::istringstream lines(list);
  for (std::string line; std::getline(lines, line);)
  {
    try
    {
      mirrorLine(line);
    }
    catch (const std::exception&)
    {
      // Not a number where one is expected: probably another version.
    }
  }
}

//------------------------------------------------------------------------------
std::string missingMetric(int number)
{
  if (!isNumberOfUserMetric(number))
  {
    return {};
  }
  loadMetricsOfEnvironment();
  const MetricInfo* info = registeredMetric(static_cast<Metric>(number));
  if (info && isRegisteredHere(info->metric))
  {
    return {};
  }
  const std::string errors = metricLoadErrors();
  return "The metric " + (info ? "'" + std::string(info->label) + "'" : std::to_string(number)) +
    " is a user metric that is not registered in this process. Register it in all processes of "
    "the server before loading a state file that uses it: list its library in TAUTLINE_METRICS "
    "when they start, or use tautline.load_metrics()." +
    (errors.empty() ? "" : " " + errors);
}
}
