// SPDX-License-Identifier: BSD-3-Clause
// The facts of the registry, checked against the values of the metrics: names, ranges, direction,
// barrier, differentiability, and the options that are rejected.
#include "Meshes.h"
#include "Registry.h"

#include <sstream>

using namespace tautline;

namespace
{
constexpr int elementsPerType = 100000;

double valueOnIdeal(const MetricInfo& info, CellType type)
{
  return valueOf(type, idealCell(type), info.metric);
}

TAUTLINE_PART(testNames)
{
  std::set<std::string> names;
  const auto& registry = metricRegistry();
  TAUTLINE_CHECK_EQUAL(registry.size(), 59u);
  for (std::size_t i = 0; i < registry.size(); ++i)
  {
    const MetricInfo& info = registry[i];
    const Context context(info.name);
    TAUTLINE_CHECK_EQUAL(static_cast<std::size_t>(info.metric), i);
    TAUTLINE_CHECK(&metricInfo(info.metric) == &info);
    TAUTLINE_CHECK(*info.label && *info.symbol && *info.formula && *info.source);
    std::istringstream aliases(info.aliases);
    std::vector<std::string> all = { info.name, info.label, info.symbol };
    for (std::string alias; std::getline(aliases, alias, ',');)
    {
      all.push_back(alias);
    }
    for (std::string name : all)
    {
      TAUTLINE_CHECK(findMetric(name) == &info);
      std::transform(name.begin(), name.end(), name.begin(), ::toupper);
      TAUTLINE_CHECK(findMetric(name) == &info);
    }
    TAUTLINE_CHECK(names.insert(info.name).second);
  }
  for (const char* none : { "", ",", "mu_2,mu_303", "mu", "no such metric", "imr " })
  {
    TAUTLINE_CHECK(findMetric(none) == nullptr);
  }
  TAUTLINE_CHECK_THROWS(metricInfo(static_cast<Metric>(59)), wording("no-metric-number-59"));
  TAUTLINE_CHECK_THROWS(metricInfo(static_cast<Metric>(-1)), wording("no-metric-number-1"));
  // The numbers of the literature, in both dimensions.
  const char* literature[][2] = { { "mu_2", "mu_303" }, { "mu_4", "mu_360" }, { "mu_7", "mu_321" },
    { "mu_55", "mu_315" }, { "mu_56", "mu_316" }, { "mu_77", "mu_318" }, { "mu_211", "mu_311" } };
  TAUTLINE_EACH_OF(const auto& pair, literature,
    TAUTLINE_CHECK(findMetric(pair[0]) && findMetric(pair[0]) == findMetric(pair[1])));
}

TAUTLINE_PART(testConsistency)
{
  for (const MetricInfo& info : metricRegistry())
  {
    const Context context(info.name);
    bool flat = false, solid = false;
    for (CellType type : allTypes)
    {
      (topology(type).dimension == 2 ? flat : solid) |= info.definedOn(type);
    }
    TAUTLINE_CHECK_EQUAL(flat, info.in2D);
    TAUTLINE_CHECK_EQUAL(solid, info.in3D);
    for (int n : { 2, 3 })
    {
      const Range full = info.full(n), acceptable = info.acceptable(n);
      TAUTLINE_CHECK(full.low <= acceptable.low && acceptable.high <= full.high);
      TAUTLINE_CHECK(full.low < full.high && acceptable.low <= acceptable.high);
      if (!std::isnan(info.ideal(n)))
      {
        TAUTLINE_CHECK(acceptable.low <= info.ideal(n) && info.ideal(n) <= acceptable.high);
      }
    }
    TAUTLINE_CHECK(!info.barrier || info.direction == Direction::SmallerIsBetter);
    TAUTLINE_CHECK(!info.barrier || info.inverted != InvertedValue::Larger);
  }
}

//------------------------------------------------------------------------------
/// Valid elements of all kinds: ideal cells pushed about, stretched up to a hundredfold, turned.
MeshData manyElements(CellType type, bool surface)
{
  Random random(11);
  MeshData data;
  const bool flat = topology(type).dimension == 2;
  for (int i = 0; i < elementsPerType; ++i)
  {
    std::vector<Vec3> corners = perturbedCell(type, random.uniform(0, 0.6), random);
    const Vec3 lengths = { std::pow(10, random.uniform(-1, 1)), std::pow(10, random.uniform(-1, 1)),
      std::pow(10, random.uniform(-1, 1)) };
    const Columns turn =
      flat && !surface ? rotation({ 0, 0, 1 }, random.uniform(0, 6)) : randomRotation(random);
    for (Vec3& p : corners)
    {
      p[2] += surface ? random.uniform(-0.2, 0.2) : 0;
      p = { lengths[0] * p[0], lengths[1] * p[1], lengths[2] * p[2] };
      p = turn * p;
    }
    data.addCell(type, corners);
  }
  return data;
}

void testRange(CellType type, bool surface)
{
  const MeshData data = manyElements(type, surface);
  const Mesh mesh(data.view());
  const std::vector<signed char> validity = validityOf(mesh);
  TAUTLINE_CHECK(std::count(validity.begin(), validity.end(), Valid) > elementsPerType / 4);
  for (const MetricInfo& info : elementMetrics())
  {
    if (!info.definedOn(type) || (surface && !info.rotationInvariant))
    {
      continue;
    }
    const Context context(info.name);
    const std::vector<double> values = valuesOf(mesh, info.metric);
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int i = 0; i < elementsPerType; ++i)
    {
      if (validity[i] == Valid)
      {
        low = std::min(low, values[i]);
        high = std::max(high, values[i]);
      }
    }
    const Range full = info.full(topology(type).dimension);
    const double slack = 1e-12 * std::max(1.0, std::isinf(full.high) ? full.low : full.high);
    TAUTLINE_CHECK_NEAR(std::min(low, full.low), full.low, slack);
    TAUTLINE_CHECK_NEAR(std::max(high, full.high), full.high, slack);
    // The poor ones are worse than the ideal one.
    const double ideal = valueOnIdeal(info, type);
    if (info.direction == Direction::SmallerIsBetter && info.metric != Metric::UntangleBeta)
    {
      TAUTLINE_CHECK(high > ideal + 0.1);
    }
    else if (info.direction == Direction::LargerIsBetter)
    {
      TAUTLINE_CHECK(low < ideal / 2);
    }
  }
}

//------------------------------------------------------------------------------
/// A barrier grows without bound as the element is flattened (a logarithm by the same amount in
/// each decade); other metrics settle.
void testBarrier(const MetricInfo& info, CellType type)
{
  if (info.metric == Metric::AspectRatio && topology(type).samples == 1)
  {
    return; // no barrier for the other types, and so for none
  }
  auto at = [&](double height) { return valueOf(type, flattenedCell(type, height), info.metric); };
  const double v3 = at(1e-3), v6 = at(1e-6), v9 = at(1e-9), v12 = at(1e-12);
  if (info.barrier)
  {
    TAUTLINE_CHECK(v3 > valueOnIdeal(info, type));
    TAUTLINE_CHECK(v6 - v3 > 1);
    TAUTLINE_CHECK(v9 - v6 > 0.99 * (v6 - v3));
    TAUTLINE_CHECK(v12 - v9 > 0.99 * (v9 - v6));
  }
  else
  {
    TAUTLINE_CHECK(std::abs(v12 - v9) < 0.1 * std::abs(v6 - v3) + 1e-9);
  }
}

/// At the ideal cell the metrics called kinked have one: the slopes to either side differ. Right
/// angles have the largest sine, so the scaled Jacobian is tried at a sheared one.
void testKink(const MetricInfo& info, CellType type)
{
  Random random(12);
  const bool sheared = info.metric == Metric::ScaledJacobian && topology(type).samples > 1;
  std::vector<Vec3> start = idealCell(type);
  std::vector<Vec3> direction;
  for (std::size_t k = 0; k < start.size(); ++k)
  {
    start[k][0] += sheared ? 0.3 * start[k][1] : 0;
    direction.push_back(random.vector(-1, 1));
    direction.back()[2] *= topology(type).dimension == 2 ? 0 : 1;
  }
  auto slope = [&](double step)
  {
    std::vector<Vec3> moved = start;
    for (std::size_t k = 0; k < start.size(); ++k)
    {
      moved[k] += step * direction[k];
    }
    return (valueOf(type, moved, info.metric) - valueOf(type, start, info.metric)) / step;
  };
  const double step = 1e-6, jump = std::abs(slope(step) - slope(-step));
  if (info.differentiable)
  {
    TAUTLINE_CHECK_NEAR(jump, 0, 1e-3);
  }
  else if (info.metric != Metric::UntangleBeta && // its kink is where the size is beta
    !(info.metric == Metric::MinimumJacobian && topology(type).samples == 1))
  {
    TAUTLINE_CHECK(jump > 0.05);
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testRejectedOptions)
{
  const MeshData data = singleCell(CellType::Triangle, idealCell(CellType::Triangle));
  const Mesh mesh(data.view());
  TAUTLINE_LET(EvaluationOptions, options, combination = Combination::PowerMean);
  for (double bad : { 0.5, -1.0, std::nan("") })
  {
    options.power = bad;
    TAUTLINE_CHECK_THROWS(valuesOf(mesh, Metric::MeanRatio, options), wording("at-least-1"));
  }
  options.combination = Combination::Mean; // then the power does not matter
  TAUTLINE_CHECK_NEAR(valuesOf(mesh, Metric::MeanRatio, options)[0], 1, 1e-14);
  for (double bad : { 0.0, -1.0, std::nan("") })
  {
    options.parameters.epsilon = bad;
    TAUTLINE_CHECK_THROWS(
      valuesOf(mesh, Metric::SizeUntangle, options), wording("epsilon-positive"));
  }
  TAUTLINE_SET(options, parameters = {}, parameters.beta = HUGE_VAL);
  TAUTLINE_CHECK_THROWS(
    valuesOf(mesh, Metric::UntangleBeta, options), wording("beta-must-be-finite"));
  TAUTLINE_CHECK_THROWS(
    MetricSum(mesh, Metric::MeanRatio, {}, HUGE_VAL), wording("must-be-finite"));
  TAUTLINE_CHECK_THROWS(
    MetricSum(mesh, Metric::UntangleBeta, options, 1), wording("beta-must-be-finite"));
}
}

TAUTLINE_TEST(TestMetricRegistry)
{
  for (CellType type : allTypes)
  {
    const Context context(topology(type).name);
    TAUTLINE_RUN(testRange(type, false));
    if (topology(type).dimension == 2)
    {
      const Context surface("surface");
      TAUTLINE_RUN(testRange(type, true));
    }
    for (const MetricInfo& info : elementMetrics())
    {
      if (info.definedOn(type))
      {
        const Context name(info.name);
        TAUTLINE_RUN(testBarrier(info, type));
        TAUTLINE_RUN(testKink(info, type));
      }
    }
  }
}
