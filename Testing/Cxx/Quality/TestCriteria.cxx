// SPDX-License-Identifier: BSD-3-Clause
// Quality criteria: grades and penalties against their definition, the index and the verdict by
// hand, and what the reader rejects.
#include "Registry.h"
#include "VtkMeshes.h"
#include "tautline/Quality/Criteria.h"
#include "vtkDataSet.h"
#include "vtkElementQuality.h"

#include <fstream>

using namespace tautline;

namespace
{
/// Criteria of one metric, with these limits.
std::string json(const std::string& metric, const std::string& limits)
{
  return R"({ "criteria": [ { "metric": ")" + metric + R"(", "limits": )" + limits + " } ] }";
}

const std::string rising = R"({ "ideal": 1, "good": 1.5, "warn": 3, "fail": 10, "worst": 100 })";
const std::string falling = R"({ "ideal": 1, "good": 0.6, "warn": 0.3, "fail": 0.1, "worst": 0 })";

TAUTLINE_PART(testGrades)
{
  const QualityLimits up = { 1, 1.5, 3, 10, 100 };
  TAUTLINE_CHECK(gradeOf(up, 3) == Grade::Passed); // a limit belongs to the better side
  TAUTLINE_CHECK(gradeOf(up, 3.0001) == Grade::Warning);
  TAUTLINE_CHECK(gradeOf(up, 10) == Grade::Warning);
  TAUTLINE_CHECK(gradeOf(up, 11) == Grade::Failed);
  const double values[] = { 0.5, 1, 1.25, 1.5, 3, 6.5, 10, 55, 100, 1e9 };
  const double penalty[] = { 0, 0, 0.125, 0.25, 0.5, 0.625, 0.75, 0.875, 1, 1 };
  TAUTLINE_EACH(int, i, 10, TAUTLINE_CHECK_NEAR(penaltyOf(up, values[i]), penalty[i], 1e-15));
  const QualityLimits down = { 1, 0.6, 0.3, 0.1, 0 };
  TAUTLINE_CHECK(gradeOf(down, 0.3) == Grade::Passed);
  TAUTLINE_CHECK(gradeOf(down, 0.2) == Grade::Warning);
  TAUTLINE_CHECK(gradeOf(down, -1) == Grade::Failed);
  TAUTLINE_CHECK_NEAR(penaltyOf(down, 0.45), 0.375, 1e-15);
  // Equal neighbors: the better penalty up to the limit, the worse one beyond it.
  const QualityLimits step = { 0, 1, 1, 1, 2 };
  TAUTLINE_CHECK_NEAR(penaltyOf(step, 1), 0.75, 1e-15);
  TAUTLINE_CHECK_NEAR(penaltyOf(step, 0.5), 0.125, 1e-15);
}

TAUTLINE_PART(testParse)
{
  const QualityCriteria criteria = parseCriteria(
    R"({ "name": "mine", "source": [ "a", "b" ], "criteria": [ { "metric": "IMR", "weight": 2,
      "limits": { "all": )" +
    rising +
    R"(, "triangle": { "ideal": 1, "good": 1, "warn": 2, "fail": 2, "worst": 4 } } } ] })");
  TAUTLINE_CHECK(criteria.name == "mine" && criteria.source == "a b");
  TAUTLINE_CHECK_EQUAL(criteria.criteria.front().weight, 2);
  const auto& limits = criteria.criteria.front().limits;
  TAUTLINE_CHECK_EQUAL(limits[topologyIndex(CellType::Triangle)]->warn, 2);
  TAUTLINE_CHECK_EQUAL(limits[topologyIndex(CellType::Pyramid)]->warn, 3);
  // "all" are the types that the metric is defined on.
  const auto jacobian = parseCriteria(json("scaled_jacobian", R"({ "all": )" + falling + " }"));
  TAUTLINE_CHECK(!jacobian.criteria.front().limits[topologyIndex(CellType::Pyramid)]);

  for (const std::string& name : criteriaPresets())
  {
    TAUTLINE_CHECK(!parseCriteria(presetCriteria(name)).source.empty());
  }
  TAUTLINE_CHECK_THROWS(presetCriteria("nastrin"), wording("there-are-fem-skewness-optistruct"));
}

TAUTLINE_PART(testRejected)
{
  const auto all = [](const std::string& limits) { return R"({ "all": )" + limits + " }"; };
  const std::string one = R"({ "metric": "imr", "weight": WEIGHT, "limits": )" + all(rising) + " }";
  const auto weighted = [&one](const std::string& weight)
  { return std::string(one).replace(one.find("WEIGHT"), 6, weight); };
  const std::pair<std::string, const char*> cases[] = {
    { "", wording("not-valid-json") },
    { "{ \"criteria\": [", wording("not-valid-json") },
    { "[]", wording("an-object") },
    { "{}", wording("at-least-one-criterion") },
    { R"({ "criteria": [], "limit": 1 })", wording("no-key-limit") },
    { json("imq", all(rising)), wording("no-metric-imq") },
    { json("imr", R"({ "tetra": )" + rising + " }"), wording("no-such-cell-type") },
    { json("mu_301", R"({ "triangle": )" + rising + " }"), wording("not-defined-on-triangles") },
    { json("imr", all(falling)), wording("must-rise") },
    { json("mean_ratio", all(rising)), wording("must-fall") },
    { json("imr", all(R"({ "ideal": 1, "good": 2, "warn": 1.5, "fail": 3, "worst": 4 })")),
      wording("rise-or-fall-throughout") },
    { json("imr", all(R"({ "ideal": 1, "good": 1, "warn": 1, "fail": 1, "worst": 1 })")),
      wording("rise-or-fall-throughout") },
    { json("imr", all(R"({ "ideal": 1, "good": 2, "warn": 3, "fail": 4 })")),
      wording("worst-is-missing") },
    { json("imr", all(R"({ "ideal": 1, "good": 2, "warn": 3, "fail": 4, "worst": 1e999 })")), "" },
    { R"({ "criteria": [ )" + weighted("-1") + " ] }", wording("must-not-be-negative") },
    { R"({ "criteria": [ )" + weighted("0") + " ] }", "above 0" },
    { R"({ "criteria": [ )" + weighted("1") + ", " + weighted("1") + " ] }",
      wording("has-a-criterion-already") },
  };
  for (const auto& rejected : cases)
  {
    const Context context(rejected.first);
    TAUTLINE_CHECK_THROWS(parseCriteria(rejected.first), rejected.second);
  }
}

/// Limits warn and fail of the presets, as their sources have them.
TAUTLINE_PART(testPresets)
{
  using Limits = std::array<double, 2>;
  const auto limits = [](const char* preset, const char* metric, CellType type)
  {
    const QualityCriteria criteria = parseCriteria(presetCriteria(preset));
    for (const QualityCriterion& criterion : criteria.criteria)
    {
      const auto& found = criterion.limits[topologyIndex(type)];
      if (criterion.name() == std::string(metric) && found)
      {
        return Limits{ found->warn, found->fail };
      }
    }
    return Limits{ 0, 0 };
  };
  const auto triangle = CellType::Triangle, quad = CellType::Quadrilateral;
  TAUTLINE_CHECK((limits("hypermesh", "edge_ratio", quad) == Limits{ 4.4, 5 }));
  TAUTLINE_CHECK((limits("hypermesh", "min_angle", triangle) == Limits{ 34, 30 }));
  TAUTLINE_CHECK((limits("hypermesh", "min_angle", quad) == Limits{ 46, 40 }));
  TAUTLINE_CHECK((limits("hypermesh", "max_angle", triangle) == Limits{ 112, 120 }));
  TAUTLINE_CHECK((limits("hypermesh", "max_angle", quad) == Limits{ 134, 140 }));
  TAUTLINE_CHECK((limits("nastran", "min_angle", triangle) == Limits{ 10, 0 }));
  TAUTLINE_CHECK((limits("nastran", "max_angle", triangle) == Limits{ 170, 180 }));
  TAUTLINE_CHECK((limits("nastran", "min_angle", quad) == Limits{ 25, 0 }));
  TAUTLINE_CHECK((limits("nastran", "max_angle", quad) == Limits{ 165, 180 }));
  TAUTLINE_CHECK((limits("ansys", "max_angle", triangle) == Limits{ 165, 179.9 }));
  // In solids these metrics are dihedral angles: the limits of faces do not apply.
  for (const char* preset : { "hypermesh", "nastran", "ansys" })
  {
    TAUTLINE_CHECK((limits(preset, "max_angle", CellType::Tetrahedron) == Limits{ 0, 0 }));
  }
  const auto tet = CellType::Tetrahedron;
  TAUTLINE_CHECK((limits("optistruct_solids", "min_angle", tet) == Limits{ 15, 3 }));
  TAUTLINE_CHECK((limits("optistruct_solids", "max_angle", tet) == Limits{ 165, 177 }));
  TAUTLINE_CHECK((limits("hypermesh_solids", "equiangle_skew", tet) == Limits{ 0.7, 0.7 }));
  TAUTLINE_CHECK(
    (limits("hypermesh_solids", "equiangle_skew", CellType::Wedge) == Limits{ 0.7, 0.7 }));
  TAUTLINE_CHECK((limits("nastran_solids", "equiangle_skew", tet) == Limits{ 55.0 / 60, 1 }));
  TAUTLINE_CHECK_NEAR(55.0 / 60, (170.0 - 60) / (180 - 60), 1e-15);
  // Checks of solvers, which no metric has the definition of.
  TAUTLINE_CHECK((limits("hypermesh_solids", "jacobian_integration", tet) == Limits{ 0.7, 0 }));
  TAUTLINE_CHECK((limits("nastran_solids", "midnode_angle", tet) == Limits{ 30, 180 }));
  TAUTLINE_CHECK((limits("nastran", "midnode_angle", quad) == Limits{ 30, 180 }));
  const double quality = std::pow(0.05, 2.0 / 3);
  TAUTLINE_CHECK_NEAR(limits("ansys_solids", "mean_ratio", tet)[1], quality, 1e-15);
  TAUTLINE_CHECK_EQUAL(criteriaPresets().size(), std::size_t{ 14 });
}

/// Each solver has a preset for shells and one for solids, and the labels distinguish them.
TAUTLINE_PART(testShellsAndSolids)
{
  for (const std::string& preset : criteriaPresets())
  {
    const Context context(preset);
    const QualityCriteria criteria = parseCriteria(presetCriteria(preset));
    const QualityCriterion& first = criteria.criteria.front();
    const bool finiteVolumes =
      first.check < 0 && metricInfo(first.metric).family == MetricFamily::Faces;
    const bool both = preset == "fem" || preset == "skewness";
    const bool solids = preset.find("_solids") != std::string::npos;
    const std::string graded = finiteVolumes ? "finite volumes"
      : both                                 ? "shells and solids"
      : solids                               ? "solids"
                                             : "shells";
    TAUTLINE_CHECK_EQUAL(gradedCells(criteria), graded);
    TAUTLINE_CHECK(finiteVolumes || criteria.name.find(graded) != std::string::npos);
  }
  // The element quality of ANSYS in a corner of a cube, V = 1/6: 1 in the regular tetrahedron.
  MeshData data;
  data.addCell(
    CellType::Tetrahedron, std::vector<Vec3>{ { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } });
  const double edges = 3 * 1 + 3 * 2;
  const double ansys = 72 * std::sqrt(3.0) / 6 / std::sqrt(edges * edges * edges);
  TAUTLINE_CHECK_NEAR(std::pow(valuesOf(data, Metric::MeanRatio)[0], 1.5), ansys, 1e-12);
}

/// Separate triangles over a base of length 1, of these heights.
MeshData triangles(const std::vector<double>& heights)
{
  MeshData data;
  for (double h : heights)
  {
    data.addCell(CellType::Triangle, std::vector<Vec3>{ { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, h, 0 } });
  }
  return data;
}

double cellValue(vtkElementQuality* filter, const char* array, vtkIdType cell)
{
  auto* cells = outputOf(filter)->GetCellData();
  return cells->GetArray(array)->GetComponent(cell, 0);
}

/// On triangles over a base of 1, of inverse mean ratio (1 + 2 (1/4 + h^2)) / (2 sqrt(3) h).
void testFilter(const std::string& folder)
{
  const double height = std::sqrt(0.75);
  const auto imrOf = [](double h) { return (1 + 2 * (0.25 + h * h)) / (2 * std::sqrt(3.0) * h); };
  TAUTLINE_NEW(vtkElementQuality, filter,
    SetInputData(toGrid(triangles({ height, 0.1, 0.02, -0.3 }))), AddMetricByName("si"));
  const std::string file = folder + "/criteria.json";
  std::ofstream(file) << json("imr", R"({ "all": )" + rising + " }");
  TAUTLINE_SET(filter, SetCriteria(file.c_str()), Update());
  const double grades[] = { 0, 1, 2, 2 };
  const double indices[] = { 0, 0.5 + 0.25 * (imrOf(0.1) - 3) / 7,
    0.75 + 0.25 * (imrOf(0.02) - 10) / 90, 1 };
  double sum = 0;
  for (vtkIdType cell = 0; cell < 4; ++cell)
  {
    TAUTLINE_CHECK_EQUAL(cellValue(filter, "Grade", cell), grades[cell]);
    TAUTLINE_CHECK_NEAR(cellValue(filter, "QualityIndex", cell), indices[cell], 1e-14);
    sum += indices[cell];
  }
  TAUTLINE_CHECK_NEAR(cellValue(filter, "imr", 1), imrOf(0.1), 1e-14); // also measured
  TAUTLINE_CHECK_EQUAL(std::string(filter->GetVerdict()), "failed");
  TAUTLINE_CHECK_NEAR(filter->GetQualityIndex(), sum / 4, 1e-14);
  TAUTLINE_CHECK(
    std::string(filter->GetSummary())
      .find("Failed by the criteria \"criteria\": of 4 elements 2 fail and 1 have") == 0);
  TAUTLINE_CHECK(std::string(filter->GetSummary()).find(wording("valid-elements-that-fail")) !=
    std::string::npos);
  vtkTable* table = filter->GetCriteriaTable();
  TAUTLINE_CHECK_EQUAL(table->GetNumberOfRows(), 1);
  TAUTLINE_CHECK_EQUAL(table->GetValueByName(0, "Graded").ToInt(), 3); // the valid ones
  TAUTLINE_CHECK_EQUAL(table->GetValueByName(0, "Passed").ToInt(), 1);
  TAUTLINE_CHECK_EQUAL(table->GetValueByName(0, "Failed").ToInt(), 1);

  const auto verdict = [&](const std::vector<double>& heights)
  {
    TAUTLINE_SET(filter, SetInputData(toGrid(triangles(heights))), Update());
    return std::string(filter->GetVerdict());
  };
  TAUTLINE_CHECK_EQUAL(verdict({ height, height }), "passed");
  TAUTLINE_CHECK_EQUAL(verdict({ height, 0.1 }), "warning");
  // Limits for tetrahedra only: no triangle is graded, and that is not passed.
  filter->SetCriteria(json("imr", R"({ "tetrahedron": )" + rising + " }").c_str());
  TAUTLINE_CHECK_EQUAL(verdict({ height }), "none");
  TAUTLINE_CHECK_EQUAL(cellValue(filter, "Grade", 0), -1);
  TAUTLINE_CHECK(std::string(filter->GetSummary())
                   .find("\"criteria\", which are for solids; for shells there are fem, skewness, "
                         "optistruct, hypermesh, nastran, ansys.") != std::string::npos);
  filter->SetCriteria("");
  TAUTLINE_CHECK_EQUAL(verdict({ height }), "");
  TAUTLINE_CHECK_EQUAL(filter->GetCriteriaTable()->GetNumberOfRows(), 0);
  // A directory is no file to read from.
  Messages messages(filter);
  TAUTLINE_SET(filter, SetCriteria(folder.c_str()), Update());
  TAUTLINE_CHECK(messages.has(wording("neither-a-file-that-can-be-read")));
}
}

TAUTLINE_TEST(TestCriteria)
{
  TAUTLINE_RUN(testFilter(argv[2]));
}
