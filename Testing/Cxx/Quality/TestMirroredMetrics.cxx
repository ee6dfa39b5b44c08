// SPDX-License-Identifier: BSD-3-Clause
// The metrics of a server in its client: their facts are those that the server has sent, they are
// found by name, but not evaluated; one that is registered here takes the place of a server's.
// The filters reject a user's metric that this process does not have.
#include "Registry.h"
#include "VtkMeshes.h"
#include "tautline/Quality/Criteria.h"
#include "tautline/Quality/UserMetric.h"
#include "vtkElementQuality.h"
#include "vtkMeshOptimizer.h"

using namespace tautline;

namespace
{
struct Distortion
{
  template <class Number, int N>
  Number value(const CornerJacobian<Number, N>& T) const
  {
    return T.norm2() / pow(T.det(), 2.0 / N) - N;
  }
};

MetricDescription description(const std::string& name)
{
  TAUTLINE_LET(MetricDescription, d, name = name, label = "A label of " + name,
    symbol = "S_" + name, aliases = name + "_1," + name + "_2", formula = "|T|^2 / det T^(2/n) - n",
    unit = "unit", cellTypes = 1u << topologyIndex(CellType::Tetrahedron));
  d.full = { 0, MetricDescription::infinity };
  d.acceptable = { 0.1, 2.0 / 3 };
  TAUTLINE_SET(d, ideal = 1e-17 / 3, barrier = true, scaleInvariant = true);
  return d;
}

/// The message of a server that has a metric of the name.
std::string sentBy(MetricDescription d, const std::string& name)
{
  // Its texts differ here, because the metric's own may be in use.
  const std::string elsewhere = "Server";
  const auto rename = [](std::string& text, const std::string& from, const std::string& to)
  {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from))
    {
      text.replace(at, from.size(), to);
    }
  };
  d.name = "server_metric";
  for (std::string* text : { &d.label, &d.symbol, &d.aliases })
  {
    rename(*text, name, elsewhere);
  }
  registerJacobianMetric(d, Distortion());
  std::string list = listUserMetrics();
  unregisterMetric(d.name);
  list = list.substr(list.find(d.label) - 1);
  list = list.substr(0, list.find('\n') + 1);
  rename(list, d.name, name);
  rename(list, elsewhere, name);
  return "1234567" + list;
}

TAUTLINE_PART(testFacts)
{
  const MetricDescription d = description("mirrored");
  const std::string list = sentBy(d, "mirrored");
  mirrorUserMetrics(list);
  const MetricInfo* info = findMetric(d.label);
  TAUTLINE_CHECK(info && std::string(info->name) == "mirrored" && info == findMetric("mirrored_2"));
  TAUTLINE_CHECK_EQUAL(std::string(info->symbol), d.symbol);
  TAUTLINE_CHECK_EQUAL(std::string(info->formula), d.formula);
  TAUTLINE_CHECK_EQUAL(std::string(info->unit), d.unit);
  TAUTLINE_CHECK(!info->in2D && info->in3D && info->definedOn(CellType::Tetrahedron));
  TAUTLINE_CHECK(info->full3D.low == 0 && std::isinf(info->full3D.high));
  TAUTLINE_CHECK(info->acceptable3D.low == 0.1 && info->acceptable3D.high == 2.0 / 3);
  TAUTLINE_CHECK(info->ideal3D == d.ideal);
  TAUTLINE_CHECK(info->barrier && info->scaleInvariant && info->rotationInvariant);
  TAUTLINE_CHECK(info->family == MetricFamily::Target);
  TAUTLINE_CHECK(objectiveProblem(info->metric).empty());
  // The client has criteria with it, but does not offer it to filters of its own.
  const std::string criteria = R"({"name": "c", "criteria": [{"metric": "mirrored", "limits":
    {"all": {"ideal": 0, "good": 1, "warn": 2, "fail": 3, "worst": 4}}}]})";
  TAUTLINE_CHECK(parseCriteria(criteria).criteria[0].metric == info->metric);
  TAUTLINE_CHECK(!contains(listUserMetrics(), "mirrored"));
  TAUTLINE_CHECK_THROWS(unregisterMetric("mirrored"), wording("no-metric-mirrored"));
  const std::string missing = missingMetric(static_cast<int>(info->metric));
  TAUTLINE_CHECK(
    contains(missing, "'" + d.label + "' is a user metric that is not registered in this process"));
  const MeshData data = movedBlock(CellType::Tetrahedron, 2, 0.1);
  std::vector<double> values(data.numberOfCells());
  TAUTLINE_CHECK_THROWS(
    evaluateMetric(Mesh(data.view()), info->metric, {}, values.data()), wording("on-a-server"));

  // The same again changes nothing; other facts do.
  const std::vector<MetricInfo>& before = metricRegistry();
  mirrorUserMetrics(list);
  TAUTLINE_CHECK(&metricRegistry() == &before);
  MetricDescription other = TAUTLINE_CHANGED(d, acceptable.high = 5);
  mirrorUserMetrics(sentBy(other, "mirrored"));
  TAUTLINE_CHECK(findMetric("mirrored")->acceptable3D.high == 5);
  TAUTLINE_CHECK_EQUAL(metricRegistry().size(), before.size());

  // One of this process takes its place, and stays.
  registerJacobianMetric(d, Distortion());
  mirrorUserMetrics(sentBy(other, "mirrored"));
  TAUTLINE_CHECK_EQUAL(metricRegistry().size(), before.size());
  info = findMetric("mirrored");
  TAUTLINE_CHECK(info->acceptable3D.high == 2.0 / 3);
  TAUTLINE_CHECK(missingMetric(static_cast<int>(info->metric)).empty());
  evaluateMetric(Mesh(data.view()), info->metric, {}, values.data());
  TAUTLINE_CHECK(*std::max_element(values.begin(), values.end()) > 0);
  unregisterMetric("mirrored");

  // Anything that is not a list of this version is left out.
  for (const char* wrong : { "", "\n\n", "5\tLabel\n", "x\ty\tz", "1000001\t\t\t\t\t\t\t" })
  {
    mirrorUserMetrics(wrong);
  }
  std::string letters = list;
  letters.replace(letters.find("0.1"), 1, "x");
  mirrorUserMetrics(letters.replace(letters.find("mirrored"), 8, "spoiled_"));
  TAUTLINE_CHECK(!findMetric("spoiled_"));
}

TAUTLINE_PART(testFilters)
{
  constexpr int elsewhere = 1234567890;
  const auto grid = toGrid(movedBlock(CellType::Tetrahedron, 2, 0.1));
  vtkNew<vtkElementQuality> quality;
  Messages messages(quality);
  TAUTLINE_SET(quality, SetInputData(grid), AddMetricByName("imr"), AddMetric(elsewhere), Update());
  TAUTLINE_CHECK(messages.has(wording("the-metric-1234567890-of-a-user-is-2")));
  TAUTLINE_CHECK(messages.has("TAUTLINE_METRICS"));
  TAUTLINE_CHECK_EQUAL(outputOf(quality)->GetNumberOfCells(), 0);
  vtkNew<vtkMeshOptimizer> optimizer;
  Messages others(optimizer);
  optimizer->SetInputData(grid);
  const auto rejects = [&]
  {
    others.clear();
    optimizer->Update();
    TAUTLINE_CHECK(others.has(wording("the-metric-1234567890-of-a-user-is")));
    TAUTLINE_CHECK_EQUAL(outputOf(optimizer)->GetNumberOfCells(), 0);
  };
  optimizer->SetWorstMetric(elsewhere);
  rejects();
  TAUTLINE_SET(optimizer, SetWorstMetric(-1), SetPreset(vtkMeshOptimizer::CUSTOM),
    SetNumberOfObjectives(1), SetMetric1(elsewhere));
  rejects();
  optimizer->SetMetric1(0);
  others.clear();
  optimizer->Update();
  TAUTLINE_CHECK(!others.has(wording("of-a-user")));
  TAUTLINE_CHECK_EQUAL(outputOf(optimizer)->GetNumberOfCells(), grid->GetNumberOfCells());
}
}
