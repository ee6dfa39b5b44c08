// SPDX-License-Identifier: BSD-3-Clause
#include "HtmlReportText.h"

#include "vtkDataArray.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>

namespace tautline
{
namespace
{

constexpr vtkIdType MostRows = 60; // of a table
constexpr vtkIdType OpenRows = 12; // of a table that is not folded
constexpr int MostComponents = 3;  // of a column; the ids and positions of the worst have more
constexpr int Digits = 6;          // of numbers

bool isShown(vtkTable* table, vtkIdType column)
{
  auto* values = vtkDataArray::SafeDownCast(table->GetColumn(column));
  return !values || values->GetNumberOfComponents() <= MostComponents;
}

std::string nameOf(vtkTable* table, vtkIdType column)
{
  const char* name = table->GetColumnName(column);
  return name ? name : "";
}

} // anonymous namespace

const char* const HtmlReportStyle = R"(
body { font: 15px sans-serif; max-width: 900px; margin: 2em auto; padding: 0 1em; color: #222; }
h1 { overflow-wrap: anywhere; }
table { border-collapse: collapse; margin: 0.5em 0 1.5em; font-size: 13px; }
th, td { border: 1px solid #ccc; padding: 2px 8px; text-align: right; white-space: pre-line; }
th, td:first-child { text-align: left; background: #f4f4f4; }
table.texts td { text-align: left; overflow-wrap: anywhere; }
div.wide { overflow-x: auto; }
summary { cursor: pointer; }
figure { display: inline-block; margin: 0 0 1em; vertical-align: top; max-width: 100%; }
figcaption { text-align: center; font-size: 13px; }
p.note { font-size: 13px; }
div.legend { display: flex; max-width: 400px; height: 14px; margin: 0 auto; }
div.legend span { flex: 1; }
div.ends { display: flex; justify-content: space-between; max-width: 400px; margin: 0 auto 1em;
  font-size: 13px; }
img, svg { max-width: 100%; height: auto; }
svg text { font: 11px sans-serif; fill: #222; }
)";

//------------------------------------------------------------------------------
std::string escapeHtml(const std::string& text)
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

//------------------------------------------------------------------------------
std::string escapeHtml(const char* text)
{
  return escapeHtml(std::string(text ? text : ""));
}

//------------------------------------------------------------------------------
std::string htmlNumber(double value)
{
  std::ostringstream text;
  text.precision(Digits);
  text << value;
  return text.str();
}

//------------------------------------------------------------------------------
std::string htmlValue(const vtkVariant& value)
{
  return value.IsFloat() || value.IsDouble() ? htmlNumber(value.ToDouble())
                                             : std::string(value.ToString());
}

//------------------------------------------------------------------------------
std::string htmlColor(const std::array<double, 3>& color)
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

//------------------------------------------------------------------------------
std::string htmlRow(const std::vector<std::string>& cells, const char* tag)
{
  std::string html = "<tr>";
  for (const std::string& cell : cells)
  {
    html += std::string("<") + tag + ">" + escapeHtml(cell) + "</" + tag + ">";
  }
  return html + "</tr>\n";
}

//------------------------------------------------------------------------------
std::string readableName(const std::string& column)
{
  const std::string quantile = "Quantile";
  if (column.rfind(quantile, 0) == 0 && column.size() == quantile.size() + 2 &&
    column.find_first_not_of("0123456789", quantile.size()) == std::string::npos)
  {
    return std::to_string(std::stoi(column.substr(quantile.size()))) + " % quantile";
  }
  const auto isUpper = [](char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; };
  std::string text;
  for (std::size_t i = 0; i < column.size(); ++i)
  {
    // Abbreviations (RMS) stay as they are.
    const bool word =
      i > 0 && isUpper(column[i]) && !isUpper(column[i - 1]) && column[i - 1] != ' ';
    text += word ? " " : "";
    text +=
      word ? static_cast<char>(std::tolower(static_cast<unsigned char>(column[i]))) : column[i];
  }
  return text;
}

//------------------------------------------------------------------------------
std::string htmlTable(vtkTable* table)
{
  if (!table || table->GetNumberOfRows() == 0)
  {
    return "";
  }
  std::vector<std::string> names;
  std::vector<vtkIdType> columns;
  for (vtkIdType c = 0; c < table->GetNumberOfColumns(); ++c)
  {
    if (isShown(table, c))
    {
      columns.push_back(c);
      names.push_back(readableName(nameOf(table, c)));
    }
  }
  const vtkIdType all = table->GetNumberOfRows(), rows = std::min(MostRows, all);
  std::string html =
    rows > OpenRows ? "<details><summary>" + std::to_string(all) + " rows</summary>\n" : "";
  html += "<div class=\"wide\"><table>\n" + htmlRow(names, "th");
  for (vtkIdType r = 0; r < rows; ++r)
  {
    std::vector<std::string> cells;
    for (const vtkIdType c : columns)
    {
      cells.push_back(htmlValue(table->GetValue(r, c)));
    }
    html += htmlRow(cells, "td");
  }
  html += "</table></div>\n";
  if (rows < all)
  {
    html += "<p>The first " + std::to_string(rows) + " of " + std::to_string(all) + " rows.</p>\n";
  }
  return html + (rows > OpenRows ? "</details>\n" : "");
}

//------------------------------------------------------------------------------
std::string htmlColumns(const std::vector<vtkTable*>& tables, const std::string& key,
  const std::vector<std::string>& sides)
{
  /// The values of a column, row by row in all tables.
  const auto valuesOf = [&](const std::string& column, auto text)
  {
    std::vector<std::string> values;
    for (vtkIdType row = 0; row < tables[0]->GetNumberOfRows(); ++row)
    {
      for (std::size_t t = 0; t < tables.size(); ++t)
      {
        values.push_back(text(tables[t]->GetValueByName(row, column.c_str()), t));
      }
    }
    return values;
  };
  std::vector<std::string> names = valuesOf(key,
    [&sides](const vtkVariant& value, std::size_t t)
    { return value.ToString() + (sides[t].empty() ? "" : ", " + sides[t]); });
  names.insert(names.begin(), "");
  std::string html = "<div class=\"wide\"><table>\n" + htmlRow(names, "th");
  for (vtkIdType c = 0; c < tables[0]->GetNumberOfColumns(); ++c)
  {
    const std::string column = nameOf(tables[0], c);
    if (column != key && isShown(tables[0], c))
    {
      std::vector<std::string> cells =
        valuesOf(column, [](const vtkVariant& value, std::size_t) { return htmlValue(value); });
      cells.insert(cells.begin(), readableName(column));
      html += htmlRow(cells, "td");
    }
  }
  return html + "</table></div>\n";
}

} // namespace tautline
