// SPDX-License-Identifier: BSD-3-Clause
#include "vtkHtmlReport.h"

#include "Blocks.h"
#include "ColorMaps.h"
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

constexpr vtkIdType MostRows = 60; // of a table
constexpr int MostComponents = 3;  // of a column; the ids and positions of the worst have more
constexpr int HistogramWidth = 640, HistogramHeight = 160; // pixels
constexpr double BarWidth = 0.9;                           // of the place of a bar
constexpr int WidthOfOne = 800, WidthOfTwo = 440;          // of pictures
constexpr double PictureHeight = 0.75;                     // of the width
constexpr int LegendSteps = 24;                            // colours
constexpr int Digits = 6;                                  // of numbers
constexpr const char* BinColor = "#8a8a8a";
constexpr const char* BadColor = "#8c1414";

constexpr const char* Style = R"(
body { font: 15px sans-serif; max-width: 900px; margin: 2em auto; padding: 0 1em; color: #222; }
table { border-collapse: collapse; margin: 0.5em 0 1.5em; font-size: 13px; }
th, td { border: 1px solid #ccc; padding: 2px 8px; text-align: right; }
th, td:first-child { text-align: left; background: #f4f4f4; }
div.wide { overflow-x: auto; }
figure { display: inline-block; margin: 0 0 1em; vertical-align: top; max-width: 100%; }
figcaption { text-align: center; font-size: 13px; }
div.legend { display: flex; max-width: 400px; height: 14px; margin: 0 auto; }
div.legend span { flex: 1; }
div.ends { display: flex; justify-content: space-between; max-width: 400px; margin: 0 auto 1em;
  font-size: 13px; }
img, svg { max-width: 100%; }
)";

std::string escaped(const std::string& text)
{
  std::string html;
  for (const char c : text)
  {
    switch (c)
    {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

std::string textOf(const char* text)
{
  return escaped(text ? text : "");
}

std::string number(double value)
{
  std::ostringstream text;
  text.precision(Digits);
  text << value;
  return text.str();
}

std::string row(const std::vector<std::string>& cells, const char* tag)
{
  std::string html = "<tr>";
  for (const std::string& cell : cells)
  {
    html += std::string("<") + tag + ">" + escaped(cell) + "</" + tag + ">";
  }
  return html + "</tr>\n";
}

/// Numbers with few digits, but whole numbers in full.
std::string valueOf(const vtkVariant& value)
{
  return value.IsFloat() || value.IsDouble() ? number(value.ToDouble()) : value.ToString();
}

std::string hexOf(const Color& color)
{
  std::string text = "#";
  for (const double channel : color)
  {
    constexpr const char* digits = "0123456789abcdef";
    const auto byte = static_cast<int>(std::lround(255 * channel));
    text += { digits[byte / 16], digits[byte % 16] };
  }
  return text;
}

std::string barsOf(const MetricHistogram& histogram)
{
  double most = 1;
  for (const HistogramBar& bar : histogram.bars)
  {
    most = std::max(most, static_cast<double>(bar.count));
  }
  const double width = static_cast<double>(HistogramWidth) / histogram.bars.size();
  std::ostringstream svg;
  svg << "<h3>" << escaped(histogram.label) << "</h3>\n<svg width=\"" << HistogramWidth
      << "\" height=\"" << HistogramHeight << "\" viewBox=\"0 0 " << HistogramWidth << " "
      << HistogramHeight << "\">\n";
  for (std::size_t i = 0; i < histogram.bars.size(); ++i)
  {
    const HistogramBar& bar = histogram.bars[i];
    const double height = HistogramHeight * std::sqrt(static_cast<double>(bar.count) / most);
    const bool inside = bar.kind == HistogramBar::Bin || bar.kind == HistogramBar::LastBin;
    const std::string color = inside ? BinColor
      : bar.kind == HistogramBar::Inverted
      ? hexOf({ InvertedColor[0], InvertedColor[1], InvertedColor[2] })
      : BadColor;
    const int index = static_cast<int>(i);
    svg << "<rect x=\"" << static_cast<double>(i) * width << "\" y=\"" << HistogramHeight - height
        << "\" width=\"" << BarWidth * width << "\" height=\"" << height << "\" fill=\"" << color
        << "\"><title>" << escaped(describeBars(histogram, index, index)) << ": " << bar.count
        << " elements</title></rect>\n";
  }
  const auto isBin = [](const HistogramBar& bar)
  { return bar.kind == HistogramBar::Bin || bar.kind == HistogramBar::LastBin; };
  const auto first = std::find_if(histogram.bars.begin(), histogram.bars.end(), isBin);
  const auto last = std::find_if(histogram.bars.rbegin(), histogram.bars.rend(), isBin);
  svg << "</svg>\n";
  if (first != histogram.bars.end())
  {
    svg << "<p>Grey: acceptable, " << number(first->low) << " to " << number(last->high)
        << "; dark red: beyond; blue: inverted. The height of a bar is the square root of its "
           "count.</p>\n";
  }
  return svg.str();
}

/// The colours of a metric; without a map of its own, from its smallest to its largest value.
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
      hexOf(colorOf(spec, spec.good + badness * (spec.bad - spec.good))) + "\"></span>";
  }
  return html + "</div>\n<div class=\"ends\"><span>" + number(spec.good) + "</span><span>" +
    escaped(spec.title) + (spec.negativeInverts ? "; blue: inverted" : "") + "</span><span>" +
    number(spec.bad) + "</span></div>\n";
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
  this->Title = textOf(title);
  this->Html.clear();
  this->InRows = false;
  this->Add("<h1>" + this->Title + "</h1>\n<p>" + textOf(line) + "</p>\n");
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
  this->Add("<h2>" + textOf(text) + "</h2>\n");
}

//------------------------------------------------------------------------------
void vtkHtmlReport::AddText(const char* text)
{
  std::string html;
  for (const char c : textOf(text))
  {
    html += c == '\n' ? "<br>\n" : std::string(1, c);
  }
  this->Add("<p>" + html + "</p>\n");
}

//------------------------------------------------------------------------------
void vtkHtmlReport::AddRow(const char* name, const char* value)
{
  this->Html += this->InRows ? "" : "<table>\n";
  this->Html += row({ name ? name : "", value ? value : "" }, "td");
  this->InRows = true;
}

//------------------------------------------------------------------------------
void vtkHtmlReport::AddTable(vtkTable* table)
{
  if (!table || table->GetNumberOfRows() == 0)
  {
    return;
  }
  std::vector<std::string> names;
  std::vector<vtkIdType> columns;
  for (vtkIdType c = 0; c < table->GetNumberOfColumns(); ++c)
  {
    auto* values = vtkDataArray::SafeDownCast(table->GetColumn(c));
    if (!values || values->GetNumberOfComponents() <= MostComponents)
    {
      columns.push_back(c);
      names.emplace_back(table->GetColumnName(c) ? table->GetColumnName(c) : "");
    }
  }
  std::string html = "<div class=\"wide\"><table>\n" + row(names, "th");
  const vtkIdType all = table->GetNumberOfRows(), rows = std::min(MostRows, all);
  for (vtkIdType r = 0; r < rows; ++r)
  {
    std::vector<std::string> cells;
    for (const vtkIdType c : columns)
    {
      cells.push_back(valueOf(table->GetValue(r, c)));
    }
    html += row(cells, "td");
  }
  html += "</table></div>\n";
  if (rows < all)
  {
    html += "<p>The first " + std::to_string(rows) + " of " + std::to_string(all) + " rows.</p>\n";
  }
  this->Add(html);
}

//------------------------------------------------------------------------------
int vtkHtmlReport::AddHistograms(vtkTable* statistics, vtkTable* histogram)
{
  const std::vector<MetricHistogram> histograms = histogramsOf(statistics, histogram);
  for (const MetricHistogram& one : histograms)
  {
    this->Add(barsOf(one));
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
    this->AddPng(image, textOf(description), "");
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
      this->AddPng(imageOf(drawMeshes(parts, width, height)), escaped(map.title) + " on the mesh",
        escaped(meshes[i].second));
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
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" +
    this->Title + "</title>\n<style>" + Style + "</style>\n</head>\n<body>\n" + this->Html +
    (this->InRows ? "</table>\n" : "") + "</body>\n</html>\n";
}

//------------------------------------------------------------------------------
void vtkHtmlReport::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Title: " << this->Title << "\n";
  os << indent << "Html: " << this->Html.size() << " characters\n";
}
