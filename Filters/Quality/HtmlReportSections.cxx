// SPDX-License-Identifier: BSD-3-Clause
/// The sections of vtkHtmlReport.
#include "Blocks.h"
#include "HtmlReportHistogram.h"
#include "HtmlReportText.h"
#include "MeshAdapter.h"
#include "tautline/Quality/Compare.h"
#include "tautline/Quality/Metrics.h"
#include "vtkElementQuality.h"
#include "vtkHtmlReport.h"
#include "vtkMeshComparison.h"

#include "vtkBoundingBox.h"
#include "vtkCellData.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkSignedCharArray.h"
#include "vtkStringArray.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include <algorithm>
#include <iterator>
#include <set>

namespace
{
using namespace tautline;

/// The outputs of vtkElementQuality that a report has, with their ports.
struct QualityOutput
{
  int port;
  const char* name;
};
constexpr QualityOutput QualityOutputs[] = { { 0, "Mesh" }, { 1, "Statistics" },
  { 2, "Distribution" }, { 3, "Angles" }, { 5, "Histogram" }, { 6, "Criteria" },
  { 9, "MeshChecks" } };
/// The tables after the statistics, with their headings.
constexpr const char* QualityTables[][2] = { { "Distribution", "Distribution" },
  { "Angles", "Angles" }, { "Criteria", "Criteria" }, { "MeshChecks", "Mesh checks" } };
constexpr const char* SideNames[] = { "before", "after" };
constexpr const char* MetricColumn = "Metric";

/// Type, size and extent of a mesh, as texts.
std::vector<std::string> factsOf(vtkDataObject* mesh)
{
  vtkIdType points = 0, cells = 0;
  vtkBoundingBox box;
  forEachLeaf(mesh,
    [&](unsigned int, vtkDataSet* data)
    {
      points += data->GetNumberOfPoints();
      cells += data->GetNumberOfCells();
      if (data->GetNumberOfPoints() > 0)
      {
        box.AddBounds(data->GetBounds());
      }
    });
  std::vector<std::string> facts = { readableName(std::string(mesh->GetClassName()).substr(3)),
    std::to_string(points), std::to_string(cells) };
  for (int axis = 0; axis < 3; ++axis)
  {
    facts.push_back(box.IsValid()
        ? htmlNumber(box.GetMinPoint()[axis]) + " to " + htmlNumber(box.GetMaxPoint()[axis])
        : "empty");
  }
  return facts;
}

std::vector<int> cellTypesOf(vtkDataObject* mesh)
{
  std::set<int> types;
  forEachLeaf(mesh,
    [&](unsigned int, vtkDataSet* data)
    {
      for (vtkIdType cell = 0; cell < data->GetNumberOfCells(); ++cell)
      {
        types.insert(data->GetCellType(cell));
      }
    });
  return { types.begin(), types.end() };
}

vtkIdType fullest(const MetricHistogram& histogram)
{
  vtkIdType most = 0;
  for (const HistogramBar& bar : histogram.bars)
  {
    most = std::max(most, bar.count);
  }
  return most;
}

/// The changes of metrics from the cell arrays of two measured meshes, added up over the blocks.
struct MeasuredChanges
{
  std::vector<const MetricInfo*> metrics;
  std::vector<MetricChange> changes;
  double largestDisplacement = 0;
};

std::vector<vtkDataSet*> leavesOf(vtkDataObject* mesh)
{
  std::vector<vtkDataSet*> leaves;
  forEachLeaf(mesh, [&leaves](unsigned int, vtkDataSet* data) { leaves.push_back(data); });
  return leaves;
}

/// Adds the changes of a block; false if the cells differ.
bool addChanges(vtkDataSet* before, vtkDataSet* after, MeasuredChanges& total)
{
  const MeshAdapter was(before), is(after);
  if (!connectivityDifference(was.mesh(), is.mesh()).empty())
  {
    return false;
  }
  for (vtkIdType point = 0; point < before->GetNumberOfPoints(); ++point)
  {
    const double length =
      norm(pointOf(is.mesh().view(), point) - pointOf(was.mesh().view(), point));
    total.largestDisplacement = std::max(total.largestDisplacement, length);
  }
  const Index cells = after->GetNumberOfCells();
  const auto valuesOf = [&](vtkDataSet* mesh, const char* metric) -> CellValues
  {
    auto* values = vtkDoubleArray::SafeDownCast(mesh->GetCellData()->GetArray(metric));
    auto* validity = vtkSignedCharArray::SafeDownCast(mesh->GetCellData()->GetArray("Validity"));
    if (!values || !validity)
    {
      throw Error(std::string("a mesh has no measured values of ") + metric);
    }
    return { cells, values->GetPointer(0), validity->GetPointer(0), is.mesh().view().cellTypes,
      is.ghostCells() };
  };
  const vtkNew<vtkMeshComparison> comparison; // for its tolerance
  const int dimension = is.mesh().dimension() == Dimension::Volume ? 3 : 2;
  std::vector<signed char> change(cells);
  for (std::size_t m = 0; m < total.metrics.size(); ++m)
  {
    const MetricInfo& info = *total.metrics[m];
    compareMetric(info, dimension, valuesOf(before, info.name), valuesOf(after, info.name),
      comparison->GetTolerance(), change.data(), total.changes[m]);
  }
  return true;
}

/// A row for each metric.
vtkSmartPointer<vtkTable> tableOf(const MeasuredChanges& total)
{
  auto table = vtkSmartPointer<vtkTable>::New();
  vtkNew<vtkStringArray> names;
  names->SetName(MetricColumn);
  table->AddColumn(names);
  const auto column = [&table](const char* name, auto array)
  {
    array->SetName(name);
    table->AddColumn(array);
    return array;
  };
  const auto better = column("Better", vtkSmartPointer<vtkIdTypeArray>::New());
  const auto worse = column("Worse", vtkSmartPointer<vtkIdTypeArray>::New());
  const auto equal = column("Equal", vtkSmartPointer<vtkIdTypeArray>::New());
  const auto displacement = column("LargestDisplacement", vtkSmartPointer<vtkDoubleArray>::New());
  for (std::size_t m = 0; m < total.metrics.size(); ++m)
  {
    names->InsertNextValue(total.metrics[m]->name);
    better->InsertNextValue(total.changes[m].better);
    worse->InsertNextValue(total.changes[m].worse);
    equal->InsertNextValue(total.changes[m].equal);
    displacement->InsertNextValue(total.largestDisplacement);
  }
  return table;
}
}

//------------------------------------------------------------------------------
bool vtkHtmlReport::IsSide(int side)
{
  if (side == BEFORE || side == AFTER)
  {
    return true;
  }
  vtkErrorMacro(<< "There is no side " << side << ": choose BEFORE or AFTER.");
  return false;
}

//------------------------------------------------------------------------------
void vtkHtmlReport::SetFile(int side, const char* name)
{
  if (this->IsSide(side))
  {
    this->BothSides.at(side).File = name ? name : "";
  }
}

//------------------------------------------------------------------------------
void vtkHtmlReport::AddStep(const char* name, const char* settings)
{
  this->Steps.emplace_back(name ? name : "", settings ? settings : "");
}

//------------------------------------------------------------------------------
void vtkHtmlReport::SetResult(const char* text)
{
  this->Result = text ? text : "";
}

//------------------------------------------------------------------------------
void vtkHtmlReport::SetQuality(int side, vtkElementQuality* measured)
{
  for (const QualityOutput& output : QualityOutputs)
  {
    this->SetQualityOutput(side, output.name, measured->GetOutputDataObject(output.port));
  }
  this->SetQualitySummary(side, measured->GetSummary());
  this->SetCriteria(measured->GetCriteria());
}

//------------------------------------------------------------------------------
void vtkHtmlReport::SetQualityOutput(int side, const char* output, vtkDataObject* data)
{
  if (!this->IsSide(side))
  {
    return;
  }
  // A copy: the filter may be run again for the other side.
  vtkSmartPointer<vtkDataObject> copy;
  if (data)
  {
    copy.TakeReference(data->NewInstance());
    copy->ShallowCopy(data);
  }
  this->BothSides.at(side).Outputs[output ? output : ""] = copy;
}

//------------------------------------------------------------------------------
void vtkHtmlReport::SetQualitySummary(int side, const char* text)
{
  if (this->IsSide(side))
  {
    this->BothSides.at(side).Summary = text ? text : "";
  }
}

//------------------------------------------------------------------------------
void vtkHtmlReport::SetCriteria(const char* criteria)
{
  this->Criteria = criteria ? criteria : "";
}

//------------------------------------------------------------------------------
void vtkHtmlReport::AddResultTable(const char* name, vtkTable* table)
{
  this->ResultTables.emplace_back(name ? name : "", table);
}

//------------------------------------------------------------------------------
vtkDataObject* vtkHtmlReport::Output(int side, const char* name) const
{
  const auto& outputs = this->BothSides.at(side).Outputs; // a side of this class's own choice
  const auto found = outputs.find(name);
  return found == outputs.end() ? nullptr : found->second.Get();
}

//------------------------------------------------------------------------------
vtkTable* vtkHtmlReport::Table(int side, const char* name) const
{
  vtkTable* table = vtkTable::SafeDownCast(this->Output(side, name));
  return table && table->GetNumberOfRows() > 0 ? table : nullptr;
}

//------------------------------------------------------------------------------
bool vtkHtmlReport::IsComparison() const
{
  vtkTable* before = this->Table(BEFORE, "Statistics");
  vtkTable* after = this->Table(AFTER, "Statistics");
  return this->Output(BEFORE, "Mesh") && before && after &&
    before->GetNumberOfRows() == after->GetNumberOfRows();
}

//------------------------------------------------------------------------------
bool vtkHtmlReport::AddSections()
{
  this->AddSource();
  this->AddPipeline();
  const bool measured = this->Output(AFTER, "Mesh") && this->Table(AFTER, "Statistics");
  if (measured)
  {
    this->AddMeshFacts();
  }
  if (measured || !this->Result.empty())
  {
    this->AddHeading("Result");
  }
  for (const std::string& text : { this->Result, this->BothSides[AFTER].Summary })
  {
    if (!text.empty())
    {
      this->AddText(text.c_str());
    }
  }
  bool drawn = true;
  if (measured)
  {
    drawn = this->AddQualityPictures();
    this->AddQualityHistograms();
    this->AddTables("Statistics", "Statistics");
    for (const auto& table : QualityTables)
    {
      this->AddTables(table[0], table[1]);
    }
  }
  for (const auto& [name, table] : this->ResultTables)
  {
    if (table && table->GetNumberOfRows() > 0)
    {
      this->AddHeading(name.c_str());
      this->AddTable(table);
    }
  }
  return drawn;
}

//------------------------------------------------------------------------------
void vtkHtmlReport::AddSource()
{
  if (this->BothSides[BEFORE].File.empty() && this->BothSides[AFTER].File.empty())
  {
    return;
  }
  this->AddHeading("Source");
  for (const int side : { AFTER, BEFORE })
  {
    if (!this->BothSides.at(side).File.empty())
    {
      this->AddRow(side == AFTER ? "File" : "File before", this->BothSides.at(side).File.c_str());
    }
  }
}

//------------------------------------------------------------------------------
void vtkHtmlReport::AddPipeline()
{
  if (!this->Steps.empty())
  {
    this->AddHeading("Pipeline");
  }
  for (const auto& [name, settings] : this->Steps)
  {
    this->AddRow(name.c_str(), settings.empty() ? "default settings" : settings.c_str());
  }
}

//------------------------------------------------------------------------------
void vtkHtmlReport::AddMeshFacts()
{
  constexpr const char* names[] = { "Type", "Points", "Cells", "x", "y", "z" };
  const bool two = this->IsComparison();
  std::vector<std::vector<std::string>> facts;
  for (const int side : { BEFORE, AFTER })
  {
    if (side == AFTER || two)
    {
      facts.push_back(factsOf(this->Output(side, "Mesh")));
    }
  }
  this->AddHeading("Mesh");
  std::string html = "<div class=\"wide\"><table>\n";
  html += two ? htmlRow({ "", "Before", "After" }, "th") : "";
  for (std::size_t i = 0; i < std::size(names); ++i)
  {
    std::vector<std::string> cells = { names[i] };
    for (const auto& one : facts)
    {
      cells.push_back(one[i]);
    }
    html += htmlRow(cells, "td");
  }
  this->Add(html + "</table></div>\n");
}

//------------------------------------------------------------------------------
bool vtkHtmlReport::AddQualityPictures()
{
  const bool two = this->IsComparison();
  this->AddHeading(two ? "Before and after" : "Picture");
  const std::string metric =
    this->Table(AFTER, "Statistics")->GetValueByName(0, MetricColumn).ToString();
  vtkDataObject* after = this->Output(AFTER, "Mesh");
  if (!two)
  {
    return this->AddMeshPicture(after, metric.c_str());
  }
  const bool drawn = this->AddMeshPictures(this->Output(BEFORE, "Mesh"), after, metric.c_str());
  this->AddChanges();
  return drawn;
}

//------------------------------------------------------------------------------
void vtkHtmlReport::AddChanges()
{
  // The arrays have the targets and settings with which the meshes were measured.
  MeasuredChanges total;
  vtkTable* statistics = this->Table(AFTER, "Statistics");
  for (vtkIdType row = 0; row < statistics->GetNumberOfRows(); ++row)
  {
    if (const MetricInfo* info =
          findMetric(statistics->GetValueByName(row, MetricColumn).ToString()))
    {
      total.metrics.push_back(info);
    }
  }
  total.changes.resize(total.metrics.size());
  const std::vector<vtkDataSet*> before = leavesOf(this->Output(BEFORE, "Mesh"));
  const std::vector<vtkDataSet*> after = leavesOf(this->Output(AFTER, "Mesh"));
  try
  {
    bool same = before.size() == after.size();
    for (std::size_t i = 0; i < before.size() && same; ++i)
    {
      same = addChanges(before[i], after[i], total);
    }
    if (same)
    {
      this->AddTable(tableOf(total));
      return;
    }
    this->AddText("The meshes have different cells: there is no comparison element by element.");
  }
  catch (const Error& error)
  {
    const std::string text =
      std::string("There is no comparison element by element: ") + error.what();
    this->AddText(text.c_str());
  }
}

//------------------------------------------------------------------------------
void vtkHtmlReport::AddQualityHistograms()
{
  std::array<std::vector<MetricHistogram>, 2> histograms;
  for (const int side : { BEFORE, AFTER })
  {
    histograms.at(side) =
      histogramsOf(this->Table(side, "Statistics"), this->Table(side, "Histogram"));
  }
  if (histograms[AFTER].empty())
  {
    return;
  }
  const std::vector<int> types =
    this->Criteria.empty() ? std::vector<int>() : cellTypesOf(this->Output(AFTER, "Mesh"));
  this->AddHeading(this->IsComparison() ? "Histograms before and after" : "Histogram");
  for (const MetricHistogram& after : histograms[AFTER])
  {
    const auto before = std::find_if(histograms[BEFORE].begin(), histograms[BEFORE].end(),
      [&after](const MetricHistogram& one) { return one.metric == after.metric; });
    const bool two = this->IsComparison() && before != histograms[BEFORE].end();
    const auto limits = histogramLimits(this->Criteria, after.metric, types);
    const vtkIdType most = std::max(fullest(after), two ? fullest(*before) : 0);
    this->Add("<h3>" + escapeHtml(after.label) + "</h3>\n" +
      (two ? htmlHistogram(*before, limits, SideNames[BEFORE], most) : "") +
      htmlHistogram(after, limits, two ? SideNames[AFTER] : "", most) + "<p class=\"note\">" +
      escapeHtml(describeColors(after, two ? &*before : nullptr)) + "</p>\n");
  }
}

//------------------------------------------------------------------------------
void vtkHtmlReport::AddTables(const char* output, const char* heading)
{
  vtkTable* after = this->Table(AFTER, output);
  vtkTable* before = this->IsComparison() ? this->Table(BEFORE, output) : nullptr;
  if (!after)
  {
    return;
  }
  if (std::string(output) == "Statistics")
  {
    this->AddHeading(heading);
    this->Add(before ? htmlColumns({ before, after }, MetricColumn, { "before", "after" })
                     : htmlColumns({ after }, MetricColumn, { "" }));
    return;
  }
  for (const int side : { BEFORE, AFTER })
  {
    vtkTable* table = side == AFTER ? after : before;
    if (table)
    {
      this->AddHeading(before ? (heading + std::string(" ") + SideNames[side]).c_str() : heading);
      this->AddTable(table);
    }
  }
}
