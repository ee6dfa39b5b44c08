// SPDX-License-Identifier: BSD-3-Clause
#include "CriteriaGrader.h"

#include "TableRows.h"

#include "vtkCellData.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkSignedCharArray.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace tautline
{
namespace
{
/// A suggestion if the criteria have no limits for any of the elements: "" or ", which are for
/// shells; for solids there are fem, ...".
std::string otherPresets(const QualityCriteria& criteria)
{
  const std::string graded = gradedCells(criteria);
  const std::string other = graded == "shells" ? "solids" : "shells";
  std::string names;
  for (const std::string& name : criteriaPresets())
  {
    const std::string of = gradedCells(parseCriteria(presetCriteria(name)));
    if (of.find(other) != std::string::npos)
    {
      names += (names.empty() ? "" : ", ") + name;
    }
  }
  return graded.find(other) != std::string::npos
    ? ""
    : ", which are for " + graded + "; for " + other + " there are " + names;
}
}

//------------------------------------------------------------------------------
std::string criteriaText(const std::string& text)
{
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first != std::string::npos && text[first] == '{')
  {
    return text;
  }
  const auto& presets = criteriaPresets();
  if (std::find(presets.begin(), presets.end(), text) != presets.end())
  {
    return presetCriteria(text);
  }
  // Not a directory or a device, which could be read forever.
  std::error_code ignored;
  std::ifstream file;
  if (std::filesystem::is_regular_file(text, ignored))
  {
    file.open(text);
  }
  if (!file.is_open())
  {
    std::string names;
    for (const std::string& name : presets)
    {
      names += (names.empty() ? "" : ", ") + name;
    }
    throw Error("The quality criteria \"" + text +
      "\" are neither a file that can be read nor a preset (" + names + ").");
  }
  std::ostringstream content;
  content << file.rdbuf();
  return content.str();
}

//------------------------------------------------------------------------------
CriteriaGrader::CriteriaGrader(const std::string& text)
{
  if (!text.empty())
  {
    this->Criteria = parseCriteria(criteriaText(text));
    this->Totals.criteria.resize(this->Criteria.criteria.size());
  }
}

//------------------------------------------------------------------------------
std::vector<Metric> CriteriaGrader::withMetrics(std::vector<Metric> metrics) const
{
  for (const QualityCriterion& criterion : this->Criteria.criteria)
  {
    const bool listed =
      std::find(metrics.begin(), metrics.end(), criterion.metric) != metrics.end();
    if (criterion.check < 0 && !listed)
    {
      metrics.push_back(criterion.metric);
    }
  }
  return metrics;
}

//------------------------------------------------------------------------------
std::vector<int> CriteriaGrader::withChecks(std::vector<int> checks) const
{
  for (const QualityCriterion& criterion : this->Criteria.criteria)
  {
    const bool listed = std::find(checks.begin(), checks.end(), criterion.check) != checks.end();
    if (criterion.check >= 0 && !listed)
    {
      checks.push_back(criterion.check);
    }
  }
  return checks;
}

//------------------------------------------------------------------------------
void CriteriaGrader::grade(const Mesh& mesh, const signed char* validity,
  const unsigned char* uncounted, const unsigned char* skip, vtkDataSet* output)
{
  if (!this->active())
  {
    return;
  }
  std::vector<const double*> values;
  for (const QualityCriterion& criterion : this->Criteria.criteria)
  {
    auto* array = vtkDoubleArray::SafeDownCast(output->GetCellData()->GetArray(criterion.name()));
    if (!array)
    {
      return; // aborted before it was measured
    }
    values.push_back(array->GetPointer(0));
  }
  const Index cells = mesh.view().numberOfCells;
  vtkNew<vtkSignedCharArray> grades;
  grades->SetName("Grade");
  grades->SetNumberOfValues(cells);
  vtkNew<vtkDoubleArray> indices;
  indices->SetName("QualityIndex");
  indices->SetNumberOfValues(cells);
  gradeCells(this->Criteria, mesh, validity, uncounted, skip, values, grades->GetPointer(0),
    indices->GetPointer(0), this->Totals);
  output->GetCellData()->AddArray(grades);
  output->GetCellData()->AddArray(indices);
}

//------------------------------------------------------------------------------
void CriteriaGrader::gather(vtkMultiProcessController* controller)
{
  if (!this->active() || !controller || controller->GetNumberOfProcesses() < 2)
  {
    return;
  }
  std::vector<vtkIdType> counts = { this->Totals.graded, this->Totals.warned, this->Totals.failed };
  std::vector<double> penalties = { this->Totals.index };
  for (const CriteriaTotals::PerCriterion& total : this->Totals.criteria)
  {
    counts.insert(counts.end(), { total.graded, total.warned, total.failed });
    penalties.push_back(total.penalty);
  }
  const std::vector<vtkIdType> mine = counts;
  const std::vector<double> myPenalties = penalties;
  controller->AllReduce(
    mine.data(), counts.data(), static_cast<vtkIdType>(mine.size()), vtkCommunicator::SUM_OP);
  controller->AllReduce(myPenalties.data(), penalties.data(),
    static_cast<vtkIdType>(penalties.size()), vtkCommunicator::SUM_OP);
  this->Totals.graded = counts[0];
  this->Totals.warned = counts[1];
  this->Totals.failed = counts[2];
  this->Totals.index = penalties[0];
  for (std::size_t c = 0; c < this->Totals.criteria.size(); ++c)
  {
    const vtkIdType* of = counts.data() + 3 * (c + 1);
    this->Totals.criteria[c] = { of[0], of[1], of[2], penalties[c + 1] };
  }
}

//------------------------------------------------------------------------------
void CriteriaGrader::tabulate(vtkTable* table) const
{
  TableRows rows;
  for (std::size_t c = 0; c < this->Criteria.criteria.size(); ++c)
  {
    const QualityCriterion& criterion = this->Criteria.criteria[c];
    const CriteriaTotals::PerCriterion& total = this->Totals.criteria[c];
    rows.begin();
    rows.addText("Metric", criterion.name());
    rows.addText("Label", criterion.label());
    const auto add = [&rows](const char* name, Index n) { rows.add(name, static_cast<double>(n)); };
    rows.add("Weight", this->Criteria.criteria[c].weight);
    add("Graded", total.graded);
    add("Passed", total.graded - total.warned - total.failed);
    add("Warning", total.warned);
    add("Failed", total.failed);
    rows.add(
      "MeanPenalty", total.graded > 0 ? total.penalty / static_cast<double>(total.graded) : 0.0);
  }
  rows.fill(table);
}

//------------------------------------------------------------------------------
std::string CriteriaGrader::summary() const
{
  if (!this->active())
  {
    return {};
  }
  std::ostringstream text;
  const CriteriaTotals& t = this->Totals;
  switch (t.verdict())
  {
    case Grade::None:
      text << "No element could be graded by the criteria";
      break;
    case Grade::Passed:
      text << "Passed by the criteria";
      break;
    case Grade::Warning:
      text << "Warning by the criteria";
      break;
    case Grade::Failed:
      text << "Failed by the criteria";
      break;
  }
  text << " \"" << this->Criteria.name << "\"";
  if (t.graded > 0)
  {
    text << ": of " << t.graded << " elements " << t.failed << " fail and " << t.warned
         << " have warnings; quality index " << t.meanIndex() << " (0 ideal, 1 worst)";
    const char* before = ". Valid elements that fail: ";
    for (std::size_t c = 0; c < t.criteria.size(); ++c)
    {
      if (t.criteria[c].failed > 0)
      {
        text << before << this->Criteria.criteria[c].name() << " " << t.criteria[c].failed;
        before = ", ";
      }
    }
  }
  else
  {
    text << otherPresets(this->Criteria);
  }
  return text.str() + ".";
}
}
