// SPDX-License-Identifier: BSD-3-Clause
/// Reports: text is escaped, elements are closed, tables and histograms have the numbers.
#include "Registry.h"
#include "VtkMeshes.h"
#include "vtkElementQuality.h"
#include "vtkHtmlReport.h"

using namespace tautline;

namespace
{
int count(const std::string& text, const std::string& part)
{
  int found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
  {
    ++found;
  }
  return found;
}

TAUTLINE_PART(testText)
{
  TAUTLINE_NEW(vtkHtmlReport, report, Begin("<a> & \"b\"", "line"), AddHeading("1 < 2"),
    AddRow("name", "<value>"), AddRow("next", nullptr), AddText("one\ntwo"), AddRow("last", "row"));
  const std::string html = report->GetHtml();
  TAUTLINE_CHECK_EQUAL(count(html, "&lt;a&gt; &amp; &quot;b&quot;"), 2); // title and heading
  TAUTLINE_CHECK(contains(html, "<h2>1 &lt; 2</h2>"));
  TAUTLINE_CHECK(contains(html, "<tr><td>name</td><td>&lt;value&gt;</td></tr>"));
  TAUTLINE_CHECK(contains(html, "<p>one<br>\ntwo</p>"));
  TAUTLINE_CHECK_EQUAL(count(html, "<table class=\"texts\">"), 2);
  TAUTLINE_CHECK_EQUAL(count(html, "</table>"), 2);
  report->Begin("new", "");
  TAUTLINE_CHECK(!contains(report->GetHtml(), "<td>name</td>"));
}

TAUTLINE_PART(testTable)
{
  TAUTLINE_NEW(vtkHtmlReport, report, Begin("t", ""), AddTable(nullptr));
  vtkNew<vtkTable> table;
  report->AddTable(table);
  TAUTLINE_CHECK_EQUAL(count(report->GetHtml(), "<table>"), 0);
  TAUTLINE_NEW(vtkIdTypeArray, ids, SetName("Id"));
  TAUTLINE_NEW(vtkDoubleArray, values, SetName("Value"));
  TAUTLINE_NEW(vtkDoubleArray, places, SetName("Places"), SetNumberOfComponents(4));
  for (int row = 0; row < 61; ++row)
  {
    ids->InsertNextValue(1234567 + row);
    values->InsertNextValue(1.23456789);
    places->InsertNextTuple4(0, 0, 0, 0);
  }
  TAUTLINE_SET(table, AddColumn(ids), AddColumn(values), AddColumn(places));
  report->AddTable(table);
  const std::string html = report->GetHtml();
  TAUTLINE_CHECK(contains(html, "<tr><th>Id</th><th>Value</th></tr>")); // 4 components are left out
  TAUTLINE_CHECK(contains(html, "<tr><td>1234567</td><td>1.23457</td></tr>"));
  TAUTLINE_CHECK(contains(html, "1234626") && !contains(html, "1234627"));
  TAUTLINE_CHECK(contains(html, wording("the-first-60-of-61-rows")));
  TAUTLINE_CHECK_EQUAL(count(html, "<details>"), 1);
  TAUTLINE_CHECK_EQUAL(count(html, "</details>"), 1);
}

/// Triangles over a base of 1; the last is inverted.
vtkSmartPointer<vtkUnstructuredGrid> strip(const std::vector<double>& heights)
{
  MeshData data;
  for (std::size_t i = 0; i < heights.size(); ++i)
  {
    const double x = 2.0 * i;
    data.addCell(CellType::Triangle,
      std::vector<Vec3>{ { x, 0, 0 }, { x + 1, 0, 0 }, { x + 0.5, heights[i], 0 } });
  }
  return toGrid(data);
}

TAUTLINE_PART(testQuality)
{
  vtkNew<vtkElementQuality> filter;
  const double height = std::sqrt(0.75);
  TAUTLINE_SET(filter, SetInputData(strip({ height, height, 0.02, -0.4 })), Update());
  TAUTLINE_NEW(vtkHtmlReport, report, Begin("t", ""));
  TAUTLINE_CHECK_EQUAL(report->AddHistograms(filter->GetStatistics(), filter->GetHistogram()), 1);
  // Two in the first bin, one above the range, one inverted: the tooltips have the counts.
  TAUTLINE_CHECK_EQUAL(count(report->GetHtml(), ": 2 elements</title>"), 1);
  TAUTLINE_CHECK(contains(report->GetHtml(), wording("above-3-1-elements-title")));
  TAUTLINE_CHECK(contains(report->GetHtml(), wording("inverted-1-elements-title")));
  TAUTLINE_CHECK(contains(report->GetHtml(), wording("acceptable-1-to-3")));
  TAUTLINE_CHECK_EQUAL(report->AddHistograms(filter->GetAngles(), nullptr), 0);

  TAUTLINE_CHECK(report->AddMeshPicture(filter->GetOutputDataObject(0), "imr"));
  TAUTLINE_CHECK_EQUAL(count(report->GetHtml(), "src=\"data:image/png;base64,iVBORw0KGgo"), 1);
  TAUTLINE_CHECK(contains(report->GetHtml(), wording("inverse-mean-ratio-blue-inverted")));
  TAUTLINE_CHECK(
    report->AddMeshPictures(filter->GetOutputDataObject(0), filter->GetOutputDataObject(0), "imr"));
  TAUTLINE_CHECK_EQUAL(count(report->GetHtml(), "<img "), 3);
  TAUTLINE_CHECK_EQUAL(count(report->GetHtml(), "class=\"legend\""), 2);
  // Areas have no colors of their own: from the smallest to the largest.
  TAUTLINE_SET(filter, AddMetricByName("size"), Update());
  TAUTLINE_CHECK(report->AddMeshPicture(filter->GetOutputDataObject(0), "size"));
  TAUTLINE_CHECK(contains(report->GetHtml(), "<span>-0.2</span>"));
  // The message of the error event.
  std::string message;
  TAUTLINE_NEW(vtkCallbackCommand, command, SetClientData(&message));
  command->SetCallback([](vtkObject*, unsigned long, void* data, void* text)
    { *static_cast<std::string*>(data) = static_cast<const char*>(text); });
  report->AddObserver(vtkCommand::ErrorEvent, command);
  TAUTLINE_CHECK(!report->AddMeshPicture(filter->GetOutputDataObject(0), "si"));
  TAUTLINE_CHECK(contains(message, wording("no-cell-array-si-measure-it-first")));
}

/// The texts of the headings of level 2, separated by commas.
std::string headings(const std::string& html)
{
  const std::string begin = "<h2>", end = "</h2>";
  std::string found;
  for (std::size_t at = html.find(begin); at != std::string::npos; at = html.find(begin, at))
  {
    at += begin.size();
    found += (found.empty() ? "" : ",") + html.substr(at, html.find(end, at) - at);
  }
  return found;
}

TAUTLINE_PART(testSections)
{
  const double height = std::sqrt(0.75);
  vtkNew<vtkElementQuality> before, after;
  TAUTLINE_SET(before, SetInputData(strip({ height, height, -0.4 })), SetCriteria("fem"), Update());
  TAUTLINE_SET(after, SetInputData(strip({ height, height, 0.5 })), SetCriteria("fem"), Update());
  vtkNew<vtkTable> history;
  TAUTLINE_NEW(vtkDoubleArray, objective, SetName("Objective"), InsertNextValue(2.5));
  history->AddColumn(objective);
  TAUTLINE_NEW(vtkHtmlReport, report, Begin("t", ""), AddStep("Smooth", "Passes: 3\nLimit: 2"),
    AddStep("Element Quality", ""), SetFile(vtkHtmlReport::BEFORE, "a<b.vtu"),
    SetResult("All is well."), AddResultTable("History", history),
    SetQuality(vtkHtmlReport::AFTER, after));
  TAUTLINE_CHECK(report->AddSections());
  TAUTLINE_CHECK_EQUAL(headings(report->GetHtml()),
    std::string("Source,Pipeline,Mesh,Result,Picture,Histogram,Statistics,Distribution,Angles,"
                "Criteria,History"));
  TAUTLINE_CHECK(contains(report->GetHtml(), "<td>File before</td><td>a&lt;b.vtu</td>"));
  TAUTLINE_CHECK(contains(report->GetHtml(), "<td>Smooth</td><td>Passes: 3\nLimit: 2</td>"));
  TAUTLINE_CHECK(contains(report->GetHtml(), "<td>Cells</td><td>3</td>"));
  TAUTLINE_CHECK(contains(report->GetHtml(), "<td>Outside acceptable</td><td>0</td>"));
  TAUTLINE_CHECK(contains(report->GetHtml(), "<p>All is well.</p>"));
  // What was set is forgotten.
  TAUTLINE_SET(report, Begin("t", ""), SetQuality(vtkHtmlReport::AFTER, after),
    SetQuality(vtkHtmlReport::BEFORE, before));
  TAUTLINE_CHECK(report->AddSections());
  const std::string html = report->GetHtml();
  TAUTLINE_CHECK_EQUAL(headings(html),
    std::string("Mesh,Result,Before and after,Histograms before and after,Statistics,"
                "Distribution before,Distribution after,Angles before,Angles after,"
                "Criteria before,Criteria after"));
  TAUTLINE_CHECK(contains(html, "<td>Inverted</td>"));
  TAUTLINE_CHECK(contains(html, wording("inverted-1-elements-title")));
  TAUTLINE_CHECK_EQUAL(count(html, "<img "), 2);
  // One element better, two equal.
  TAUTLINE_CHECK(contains(html, "<td>imr</td><td>1</td><td>0</td><td>2</td>"));
  TAUTLINE_CHECK(contains(html, ">fail 10</text>"));
  // The values are compared as they were measured: with other values, other counts.
  vtkNew<vtkUnstructuredGrid> measured;
  measured->DeepCopy(after->GetOutputDataObject(0));
  measured->GetCellData()->GetArray("imr")->SetTuple1(0, 7);
  TAUTLINE_SET(report, Begin("t", ""), SetQuality(vtkHtmlReport::AFTER, after),
    SetQuality(vtkHtmlReport::BEFORE, before));
  report->SetQualityOutput(vtkHtmlReport::AFTER, "Mesh", measured);
  TAUTLINE_CHECK(report->AddSections());
  TAUTLINE_CHECK(contains(report->GetHtml(), "<td>imr</td><td>1</td><td>1</td><td>1</td>"));
  // Other cells: no comparison one by one. Nothing measured: no section of a mesh.
  TAUTLINE_SET(before, SetInputData(strip({ height })), Update());
  TAUTLINE_SET(report, Begin("t", ""), SetQuality(vtkHtmlReport::AFTER, after),
    SetQuality(vtkHtmlReport::BEFORE, before));
  TAUTLINE_CHECK(report->AddSections());
  TAUTLINE_CHECK(contains(report->GetHtml(), wording("the-meshes-have-different-cells")));
  TAUTLINE_SET(report, Begin("t", ""), SetResult("No mesh."));
  TAUTLINE_CHECK(report->AddSections());
  TAUTLINE_CHECK_EQUAL(headings(report->GetHtml()), std::string("Result"));
}

TAUTLINE_PART(testComposite)
{
  TAUTLINE_NEW(
    vtkMultiBlockDataSet, blocks, SetBlock(0, strip({ 0.8, 0.5 })), SetBlock(2, strip({ 0.3 })));
  TAUTLINE_NEW(vtkElementQuality, filter, SetInputDataObject(blocks), Update());
  TAUTLINE_NEW(vtkHtmlReport, report, Begin("t", ""));
  TAUTLINE_CHECK(report->AddMeshPicture(filter->GetOutputDataObject(0), "imr"));
  vtkNew<vtkImageData> empty;
  TAUTLINE_SET(report, AddImage(empty, "nothing"), AddImage(nullptr, "nothing"));
  TAUTLINE_CHECK_EQUAL(count(report->GetHtml(), "<img "), 1);
}
}
