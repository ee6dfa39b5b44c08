// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHtmlReport.h"

#include "Blocks.h"
#include "ColorMaps.h"
#include "HtmlReportHistogram.h"
#include "HtmlReportText.h"
#include "MeshAdapter.h"
#include "MeshPicture.h"
#include "MetricHistogram.h"
#include "tautline/Quality/Criteria.h"

#include "vtkBase64Utilities.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPNGWriter.h"
#include "vtkTable.h"
#include "vtkUnsignedCharArray.h"
#include "vtkVariant.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <sstream>

vtkStandardNewMacro(vtkHtmlReport);

namespace
{
using namespace tautline;

constexpr int WidthOfOne = 800, WidthOfTwo = 440; // of pictures
constexpr double PictureHeight = 0.75;            // of the width
constexpr int LegendSteps = 24;                   // colors

/// The colors of a metric; without a map of its own, from its smallest to its largest value.
ColorMapSpec mapOf(const std::string& metric, const std::vector<vtkDataArray*>& arrays)
{
  for (const ColorMapSpec& spec : metricColorMaps())
  {
    if (spec.array == metric)
    {
      return spec;
    }
  }
  double low = std::numeric_limits<double>::max(), high = -low;
  for (vtkDataArray* array : arrays)
  {
    const double* range = array->GetFiniteRange(0);
    low = std::min(low, range[0]);
    high = std::max(high, range[1]);
  }
  const MetricInfo* info = findMetric(metric);
  return { metric, low, high > low ? high : low + 1, high, false, info ? info->label : metric };
}

std::string legendOf(const ColorMapSpec& spec)
{
  std::string html = "<div class=\"legend\">";
  for (int i = 0; i < LegendSteps; ++i)
  {
    const double badness = (i + 0.5) / LegendSteps;
    html += "<span style=\"background:" +
      htmlColor(colorOf(spec, spec.good + badness * (spec.bad - spec.good))) + "\"></span>";
  }
  return html + "</div>\n<div class=\"ends\"><span>" + htmlNumber(spec.good) + "</span><span>" +
    escapeHtml(spec.title) + (spec.negativeInverts ? "; blue: inverted" : "") + "</span><span>" +
    htmlNumber(spec.bad) + "</span></div>\n";
}

/// A data set with its values.
struct Drawn
{
  vtkDataSet* data;
  vtkDataArray* values;
};

/// The data sets with cells; throws Error where one was not measured.
std::vector<Drawn> drawnOf(vtkDataObject* mesh, const std::string& metric)
{
  std::vector<Drawn> all;
  forEachLeaf(mesh,
    [&](unsigned int, vtkDataSet* data)
    {
      vtkDataArray* values = data->GetCellData()->GetArray(metric.c_str());
      if (!values && data->GetNumberOfCells() > 0)
      {
        throw Error("The mesh to draw has no cell array \"" + metric + "\": measure it first.");
      }
      if (values)
      {
        all.push_back({ data, values });
      }
    });
  return all;
}

/// Inverted, degenerate and failed elements are seen through the others.
PicturePart partOf(const Mesh& mesh, const Drawn& drawn, const ColorMapSpec& map)
{
  PicturePart part;
  part.mesh = &mesh;
  vtkDataArray* validity = drawn.data->GetCellData()->GetArray("Validity");
  vtkDataArray* grades = drawn.data->GetCellData()->GetArray("Grade");
  const vtkIdType cells = drawn.data->GetNumberOfCells();
  part.colors.resize(cells);
  part.highlighted.assign(cells, 0);
  for (vtkIdType cell = 0; cell < cells; ++cell)
  {
    const double state = validity ? validity->GetComponent(cell, 0) : static_cast<double>(Valid);
    const bool failed =
      grades && grades->GetComponent(cell, 0) == static_cast<double>(Grade::Failed);
    part.colors[cell] = state == Inverted
      ? Color{ InvertedColor[0], InvertedColor[1], InvertedColor[2] }
      : colorOf(map, drawn.values->GetComponent(cell, 0));
    part.highlighted[cell] = isInvalid(state) || failed;
  }
  return part;
}

vtkSmartPointer<vtkImageData> imageOf(const Picture& picture)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(picture.width, picture.height, 1);
  image->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  const std::size_t size = 3u * static_cast<std::size_t>(picture.width);
  for (int y = 0; y < picture.height; ++y)
  {
    // VTK's images begin at the bottom.
    const auto begin = picture.rgb.begin() + static_cast<std::ptrdiff_t>(size) * y;
    std::copy(begin, begin + static_cast<std::ptrdiff_t>(size),
      static_cast<unsigned char*>(image->GetScalarPointer(0, picture.height - 1 - y, 0)));
  }
  return image;
}
}

//------------------------------------------------------------------------------
vtkHtmlReport::vtkHtmlReport() = default;

//------------------------------------------------------------------------------
vtkHtmlReport::~vtkHtmlReport() = default;

//------------------------------------------------------------------------------
void vtkHtmlReport::Begin(const char* title, const char* line)
{
  this->Title = escapeHtml(title);
  this->Html.clear();
  this->BothSides = {};
  this->Steps.clear();
  this->ResultTables.clear();
  this->Result.clear();
  this->Criteria.clear();
  this->InRows = false;
  this->Add("<h1>" + this->Title + "</h1>\n<p>" + escapeHtml(line) + "</p>\n");
}

//------------------------------------------------------------------------------
void vtkHtmlReport::Add(const std::string& html)
{
  this->Html += (this->InRows ? "</table>\n" : "") + html;
  this->InRows = false;
}

//------------------------------------------------------------------------------
void vtkHtmlReport::AddHeading(const char* text)
{
  this->Add("<h2>" + escapeHtml(text) + "</h2>\n");
}

//------------------------------------------------------------------------------
void vtkHtmlReport::AddText(const char* text)
{
  std::string html;
  for (const char c : escapeHtml(text))
  {
    html += c == '\n' ? "<br>\n" : std::string(1, c);
  }
  this->Add("<p>" + html + "</p>\n");
}

//------------------------------------------------------------------------------
void vtkHtmlReport::AddRow(const char* name, const char* value)
{
  this->Html += this->InRows ? "" : "<table class=\"texts\">\n";
  this->Html += htmlRow({ name ? name : "", value ? value : "" }, "td");
  this->InRows = true;
}

//------------------------------------------------------------------------------
void vtkHtmlReport::AddTable(vtkTable* table)
{
  const std::string html = htmlTable(table);
  if (!html.empty())
  {
    this->Add(html);
  }
}

//------------------------------------------------------------------------------
int vtkHtmlReport::AddHistograms(vtkTable* statistics, vtkTable* histogram)
{
  const std::vector<MetricHistogram> histograms = histogramsOf(statistics, histogram);
  for (const MetricHistogram& one : histograms)
  {
    this->Add("<h3>" + escapeHtml(one.label) + "</h3>\n" +
      htmlHistogram(one, histogramLimits(this->Criteria, one.metric, {}), "", 0) +
      "<p class=\"note\">" + escapeHtml(describeColors(one)) + "</p>\n");
  }
  return static_cast<int>(histograms.size());
}

//------------------------------------------------------------------------------
void vtkHtmlReport::AddPng(
  vtkImageData* image, const std::string& description, const std::string& caption)
{
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(image);
  writer->WriteToMemoryOn();
  writer->Write();
  vtkUnsignedCharArray* png = writer->GetResult();
  const auto size = static_cast<unsigned long>(png->GetNumberOfValues());
  std::string text(4 * (size / 3 + 2), '\0');
  text.resize(vtkBase64Utilities::Encode(
    png->GetPointer(0), size, reinterpret_cast<unsigned char*>(&text[0]), 0));
  this->Add("<figure><img alt=\"" + description + "\" src=\"data:image/png;base64," + text + "\">" +
    (caption.empty() ? "" : "<figcaption>" + caption + "</figcaption>") + "</figure>\n");
}

//------------------------------------------------------------------------------
void vtkHtmlReport::AddImage(vtkImageData* image, const char* description)
{
  if (image && image->GetNumberOfPoints() > 0 && image->GetScalarType() == VTK_UNSIGNED_CHAR)
  {
    this->AddPng(image, escapeHtml(description), "");
  }
}

//------------------------------------------------------------------------------
bool vtkHtmlReport::AddMeshPicture(vtkDataObject* mesh, const char* metric)
{
  return this->AddPictures({ { mesh, "" } }, metric ? metric : "", WidthOfOne);
}

//------------------------------------------------------------------------------
bool vtkHtmlReport::AddMeshPictures(vtkDataObject* before, vtkDataObject* after, const char* metric)
{
  return this->AddPictures(
    { { before, "before" }, { after, "after" } }, metric ? metric : "", WidthOfTwo);
}

//------------------------------------------------------------------------------
bool vtkHtmlReport::AddPictures(const std::vector<std::pair<vtkDataObject*, std::string>>& meshes,
  const std::string& metric, int width)
{
  try
  {
    std::vector<std::vector<Drawn>> all;
    std::vector<vtkDataArray*> arrays;
    for (const auto& mesh : meshes)
    {
      all.push_back(drawnOf(mesh.first, metric));
      for (const Drawn& drawn : all.back())
      {
        arrays.push_back(drawn.values);
      }
    }
    const ColorMapSpec map = mapOf(metric, arrays);
    const auto height = static_cast<int>(std::lround(PictureHeight * width));
    for (std::size_t i = 0; i < meshes.size(); ++i)
    {
      std::deque<MeshAdapter> adapters;
      std::vector<PicturePart> parts;
      for (const Drawn& drawn : all[i])
      {
        adapters.emplace_back(drawn.data);
        parts.push_back(partOf(adapters.back().mesh(), drawn, map));
      }
      this->AddPng(imageOf(drawMeshes(parts, width, height)),
        escapeHtml(map.title) + " on the mesh", escapeHtml(meshes[i].second));
    }
    this->Add(legendOf(map));
    return true;
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
    return false;
  }
}

//------------------------------------------------------------------------------
std::string vtkHtmlReport::GetHtml() const
{
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width\">\n<title>" +
    this->Title + "</title>\n<style>" + HtmlReportStyle + "</style>\n</head>\n<body>\n" +
    this->Html + (this->InRows ? "</table>\n" : "") + "</body>\n</html>\n";
}

//------------------------------------------------------------------------------
void vtkHtmlReport::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Title: " << this->Title << "\n";
  os << indent << "Html: " << this->Html.size() << " characters\n";
}
