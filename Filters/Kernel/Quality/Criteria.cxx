// SPDX-License-Identifier: BSD-3-Clause
#include "Criteria.h"

#include "CriteriaPresets.h"
#include "ElementChecks.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace tautline
{
namespace
{
using Json = nlohmann::ordered_json;

/// The limits in their order, with the penalty at each.
constexpr std::array<const char*, 5> limitNames = { "ideal", "good", "warn", "fail", "worst" };
constexpr std::array<double, 5> penalties = { 0, 0.25, 0.5, 0.75, 1 };
constexpr const char* AllTypes = "all";

std::array<double, 5> ordered(const QualityLimits& limits)
{
  return { limits.ideal, limits.good, limits.warn, limits.fail, limits.worst };
}

/// 1 if larger values are worse, otherwise -1.
double signOf(const QualityLimits& limits)
{
  return limits.worst > limits.ideal ? 1 : -1;
}

[[noreturn]] void refuse(const std::string& place, const std::string& problem)
{
  throw Error("Quality criteria, " + place + ": " + problem + ".");
}

/// Rejects values of another kind and unknown keys, so that misspelled keys are not ignored.
void checkObject(
  const Json& json, const std::string& place, std::initializer_list<const char*> known)
{
  if (!json.is_object())
  {
    refuse(place, "an object { ... } is expected");
  }
  for (const auto& item : json.items())
  {
    if (std::find(known.begin(), known.end(), item.key()) == known.end())
    {
      std::string names;
      for (const char* name : known)
      {
        names += (names.empty() ? "" : ", ") + std::string(name);
      }
      refuse(place, "unknown key \"" + item.key() + "\"; available: " + names);
    }
  }
}

double number(const Json& json, const std::string& place)
{
  if (!json.is_number() || !std::isfinite(json.get<double>()))
  {
    refuse(place, "a finite number is expected");
  }
  return json.get<double>();
}

std::string text(const Json& json, const std::string& place)
{
  if (!json.is_string())
  {
    refuse(place, "a string is expected");
  }
  return json.get<std::string>();
}

/// A text, or a list of texts: its lines.
std::string lines(const Json& json, const std::string& place)
{
  if (!json.is_array())
  {
    return text(json, place);
  }
  std::string joined;
  for (const Json& line : json)
  {
    joined += (joined.empty() ? "" : " ") + text(line, place);
  }
  return joined;
}

QualityLimits parseLimits(const Json& json, const MetricInfo& info, const std::string& place)
{
  checkObject(json, place, { "ideal", "good", "warn", "fail", "worst" });
  std::array<double, 5> values{};
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    if (!json.contains(limitNames[i]))
    {
      refuse(place, std::string("\"") + limitNames[i] + "\" is missing");
    }
    values[i] = number(json[limitNames[i]], place + ", " + limitNames[i]);
  }
  const bool rises = std::is_sorted(values.begin(), values.end());
  const bool falls = std::is_sorted(values.rbegin(), values.rend());
  if (rises == falls) // neither rising nor falling, or both
  {
    refuse(place, "ideal, good, warn, fail and worst must rise, or fall, throughout");
  }
  const Direction against = rises ? Direction::LargerIsBetter : Direction::SmallerIsBetter;
  if (info.direction == against)
  {
    refuse(place,
      std::string("of ") + info.name + (rises ? " larger" : " smaller") +
        " values are better: its limits must " + (rises ? "fall" : "rise") +
        " from ideal to worst");
  }
  return { values[0], values[1], values[2], values[3], values[4] };
}

/// The names of the graded types, by gradedTypeIndex().
std::array<std::string, NumberOfGradedTypes> gradedTypes()
{
  std::array<std::string, NumberOfGradedTypes> names;
  for (const CellTopology& topology : topologies())
  {
    names[topologyIndex(topology.type)] = topology.name;
  }
  names[NumberOfCellTypes] = "polygon";
  names[NumberOfCellTypes + 1] = "polyhedron";
  return names;
}

bool isDefinedOn(const MetricInfo& info, int type)
{
  return type < NumberOfCellTypes ? info.definedOn(topologies()[type].type)
                                  : info.family == MetricFamily::Faces;
}

void parseTypes(
  const Json& json, const MetricInfo& info, const std::string& place, QualityCriterion& criterion)
{
  if (!json.is_object() || json.empty())
  {
    refuse(place, "limits by cell type, or for \"all\", are expected");
  }
  const auto types = gradedTypes();
  std::optional<QualityLimits> all;
  for (const auto& item : json.items())
  {
    const std::string at = place + ", " + item.key();
    const QualityLimits limits = parseLimits(item.value(), info, at);
    if (item.key() == AllTypes)
    {
      all = limits;
      continue;
    }
    const auto found = std::find(types.begin(), types.end(), item.key());
    if (found == types.end())
    {
      refuse(at,
        "unknown cell type; available: all, triangle, quadrilateral, tetrahedron, "
        "hexahedron, wedge, pyramid, polygon and polyhedron");
    }
    const int type = static_cast<int>(found - types.begin());
    if (!isDefinedOn(info, type))
    {
      refuse(at,
        std::string(info.name) + " is not defined on " +
          (type < NumberOfCellTypes ? topologies()[type].plural : item.key().c_str()));
    }
    criterion.limits[type] = limits;
  }
  // Limits for "all" apply to the types without their own.
  for (int type = 0; type < NumberOfGradedTypes; ++type)
  {
    auto& limits = criterion.limits[type];
    if (!limits && isDefinedOn(info, type))
    {
      limits = all;
    }
  }
}

/// A check by its name, with what the limits of a metric depend on.
bool findCheck(const std::string& name, int& number, MetricInfo& info)
{
  const std::vector<ElementCheckInfo>& checks = elementChecks();
  const auto found = std::find_if(
    checks.begin(), checks.end(), [&](const ElementCheckInfo& c) { return c.name == name; });
  if (found == checks.end())
  {
    return false;
  }
  number = static_cast<int>(found - checks.begin());
  // The fields that the parsers of limits and types use.
  info.name = found->name;
  info.direction = found->direction;
  info.family = MetricFamily::Cell;
  info.cellTypes = ~0u;
  return true;
}

QualityCriterion parseCriterion(const Json& json, const std::string& place)
{
  checkObject(json, place, { "metric", "weight", "limits" });
  if (!json.contains("metric") || !json.contains("limits"))
  {
    refuse(place, "\"metric\" and \"limits\" are needed");
  }
  const std::string name = text(json["metric"], place + ", metric");
  QualityCriterion criterion;
  MetricInfo check = {};
  const MetricInfo* info = findMetric(name);
  if (info)
  {
    criterion.metric = info->metric;
  }
  else if (findCheck(name, criterion.check, check))
  {
    info = &check;
  }
  else
  {
    refuse(place, "unknown metric \"" + name + "\"; see the list of metrics");
  }
  if (json.contains("weight"))
  {
    criterion.weight = number(json["weight"], place + ", weight");
    if (criterion.weight < 0)
    {
      refuse(place, "the weight must not be negative");
    }
  }
  parseTypes(json["limits"], *info, place + " (" + info->name + ")", criterion);
  return criterion;
}

QualityCriteria parse(const Json& json)
{
  checkObject(json, "at the top", { "name", "source", "convention", "criteria" });
  QualityCriteria result;
  result.name = json.contains("name") ? text(json["name"], "name") : "criteria";
  result.source = json.contains("source") ? lines(json["source"], "source") : "";
  if (json.contains("convention"))
  {
    result.convention = text(json["convention"], "convention");
    if (result.convention != "esi" && result.convention != "foundation")
    {
      refuse("convention", "\"esi\" or \"foundation\" is expected");
    }
  }
  if (!json.contains("criteria") || !json["criteria"].is_array() || json["criteria"].empty())
  {
    refuse("at the top", "\"criteria\" must be a list of at least one criterion");
  }
  double weights = 0;
  for (const Json& item : json["criteria"])
  {
    const std::string place = "criterion " + std::to_string(result.criteria.size() + 1);
    result.criteria.push_back(parseCriterion(item, place));
    const std::string name = result.criteria.back().name();
    if (std::count_if(result.criteria.begin(), result.criteria.end(),
          [&name](const QualityCriterion& c) { return c.name() == name; }) > 1)
    {
      refuse(place, name + " already has a criterion");
    }
    weights += result.criteria.back().weight;
  }
  if (!(weights > 0) || !std::isfinite(weights))
  {
    refuse("at the top", "at least one weight must be above 0, and their sum finite");
  }
  return result;
}
}

//------------------------------------------------------------------------------
const char* QualityCriterion::name() const
{
  return this->check >= 0 ? elementChecks()[this->check].name : metricInfo(this->metric).name;
}

//------------------------------------------------------------------------------
const char* QualityCriterion::label() const
{
  return this->check >= 0 ? elementChecks()[this->check].label : metricInfo(this->metric).label;
}

namespace
{
/// Whether all criteria are metrics of finite volumes.
bool isOfFaces(const QualityCriteria& criteria)
{
  return std::all_of(criteria.criteria.begin(), criteria.criteria.end(),
    [](const QualityCriterion& c)
    { return c.check < 0 && metricInfo(c.metric).family == MetricFamily::Faces; });
}
}

//------------------------------------------------------------------------------
int gradedTypeIndex(int vtkCellType)
{
  const int index = topologyIndex(cornerType(vtkCellType));
  return index >= 0                 ? index
    : vtkCellType == PolygonType    ? NumberOfCellTypes
    : vtkCellType == PolyhedronType ? NumberOfCellTypes + 1
                                    : -1;
}

//------------------------------------------------------------------------------
const char* gradeName(Grade grade)
{
  switch (grade)
  {
    case Grade::Passed:
      return "passed";
    case Grade::Warning:
      return "warning";
    case Grade::Failed:
      return "failed";
    default:
      return "none";
  }
}

//------------------------------------------------------------------------------
QualityCriteria parseCriteria(const std::string& json)
{
  try
  {
    return parse(Json::parse(json));
  }
  catch (const Json::exception& problem)
  {
    throw Error(std::string("The quality criteria are not valid JSON: ") + problem.what());
  }
}

//------------------------------------------------------------------------------
std::string gradedCells(const QualityCriteria& criteria)
{
  if (isOfFaces(criteria))
  {
    return "finite volumes";
  }
  bool shells = false, solids = false;
  for (const QualityCriterion& criterion : criteria.criteria)
  {
    for (int type = 0; type < NumberOfCellTypes; ++type)
    {
      (topologies()[type].dimension == 2 ? shells : solids) |= criterion.limits[type].has_value();
    }
  }
  return shells && solids ? "shells and solids" : shells ? "shells" : "solids";
}

//------------------------------------------------------------------------------
const std::vector<std::string>& criteriaPresets()
{
  static const std::vector<std::string> names = []
  {
    std::vector<std::string> list;
    for (const CriteriaPreset& preset : CriteriaPresetTexts)
    {
      list.push_back(preset.name);
    }
    return list;
  }();
  return names;
}

//------------------------------------------------------------------------------
std::string presetCriteria(const std::string& name)
{
  std::string names;
  for (const CriteriaPreset& preset : CriteriaPresetTexts)
  {
    if (name == preset.name)
    {
      return preset.json;
    }
    names += (names.empty() ? "" : ", ") + std::string(preset.name);
  }
  throw Error("Unknown preset quality criteria \"" + name + "\"; available: " + names + ".");
}

//------------------------------------------------------------------------------
Grade gradeOf(const QualityLimits& limits, double value)
{
  const double sign = signOf(limits);
  return sign * value > sign * limits.fail ? Grade::Failed
    : sign * value > sign * limits.warn    ? Grade::Warning
                                           : Grade::Passed;
}

//------------------------------------------------------------------------------
double penaltyOf(const QualityLimits& limits, double value)
{
  const double sign = signOf(limits);
  const std::array<double, 5> at = ordered(limits);
  if (sign * value >= sign * at.back())
  {
    return penalties.back();
  }
  // The penalty is piecewise linear between the limits, searched from the worst.
  for (std::size_t i = at.size() - 1; i-- > 0;)
  {
    if (sign * value >= sign * at[i])
    {
      // The next limit is beyond the value, so that the width is not 0.
      const double fraction = (value - at[i]) / (at[i + 1] - at[i]);
      return penalties[i] + fraction * (penalties[i + 1] - penalties[i]);
    }
  }
  return penalties.front();
}

//------------------------------------------------------------------------------
Grade CriteriaTotals::verdict() const
{
  return this->graded == 0 ? Grade::None
    : this->failed > 0     ? Grade::Failed
    : this->warned > 0     ? Grade::Warning
                           : Grade::Passed;
}

//------------------------------------------------------------------------------
void gradeCells(const QualityCriteria& criteria, const Mesh& mesh, const signed char* validity,
  const unsigned char* uncounted, const unsigned char* skip,
  const std::vector<const double*>& values, signed char* grades, double* indices,
  CriteriaTotals& totals)
{
  const std::size_t count = criteria.criteria.size();
  totals.criteria.resize(count);
  const bool ofFaces = isOfFaces(criteria);
  const MeshView& view = mesh.view();
  for (Index cell = 0; cell < view.numberOfCells; ++cell)
  {
    grades[cell] = static_cast<signed char>(Grade::None);
    indices[cell] = 0;
    const int typeIndex = gradedTypeIndex(view.cellTypes[cell]);
    if ((skip && skip[cell]) || typeIndex < 0 || validity[cell] == NotMeasured)
    {
      continue;
    }
    const bool valid = validity[cell] == Valid;
    // Cells that do not count are still graded, but the totals omit them.
    const bool counts = !uncounted || !uncounted[cell];
    Grade grade = Grade::None;
    double penalty = 0, weights = 0;
    for (std::size_t c = 0; c < count; ++c)
    {
      const auto& limits = criteria.criteria[c].limits[typeIndex];
      if (!limits)
      {
        continue;
      }
      // An invalid element fails at any value; finite volumes have no invalid elements.
      if (!valid && !ofFaces)
      {
        grade = Grade::Failed;
        break;
      }
      const double value = values[c][cell];
      const Grade mine = gradeOf(*limits, value);
      const double penaltyHere = penaltyOf(*limits, value);
      grade = std::max(grade, mine);
      penalty += criteria.criteria[c].weight * penaltyHere;
      weights += criteria.criteria[c].weight;
      if (!counts)
      {
        continue;
      }
      CriteriaTotals::PerCriterion& total = totals.criteria[c];
      ++total.graded;
      total.warned += mine == Grade::Warning;
      total.failed += mine == Grade::Failed;
      total.penalty += penaltyHere;
    }
    if (grade == Grade::None)
    {
      continue;
    }
    grades[cell] = static_cast<signed char>(grade);
    // An invalid element has the largest penalty.
    indices[cell] = !valid && !ofFaces ? 1.0 : weights > 0 ? penalty / weights : 0.0;
    if (!counts)
    {
      continue;
    }
    ++totals.graded;
    totals.warned += grade == Grade::Warning;
    totals.failed += grade == Grade::Failed;
    totals.index += indices[cell];
  }
}
}
