// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file HtmlReportText.h
 * @brief Texts, numbers and tables of vtkHtmlReport as HTML.
 */

#ifndef tautline_HtmlReportText_h
#define tautline_HtmlReportText_h

#include "vtkType.h"

#include <array>
#include <string>
#include <vector>

class vtkTable;
class vtkVariant;

namespace tautline
{

/// The style sheet of a report.
extern const char* const HtmlReportStyle;

/// With the characters of HTML escaped.
std::string escapeHtml(const std::string& text);
/// The same; null is "".
std::string escapeHtml(const char* text);

/// Six digits.
std::string htmlNumber(double value);

/// Numbers with few digits, but whole numbers in full.
std::string htmlValue(const vtkVariant& value);

/// "#8c1414". @param color red, green and blue, 0 to 1
std::string htmlColor(const std::array<double, 3>& color);

/// A row of a table; a line break in a cell stays one. @param tag "td" or "th"
std::string htmlRow(const std::vector<std::string>& cells, const char* tag);

/// "OutsideAcceptable" as "Outside acceptable", "Quantile05" as "5 % quantile".
std::string readableName(const std::string& column);

/**
 * @brief The rows of a table, at most 60. Columns of more than 3 components are left out. Long
 * tables are folded. Null and tables without a row are "".
 */
std::string htmlTable(vtkTable* table);

/**
 * @brief The columns of tables as rows, beside each other: the name of a column, then its values in
 * all rows of all tables.
 * @param tables each with the same columns and number of rows; the values of the column `key` are
 * the names
 * @param sides of the tables: added to the names; "" adds nothing
 */
std::string htmlColumns(const std::vector<vtkTable*>& tables, const std::string& key,
  const std::vector<std::string>& sides);

} // namespace tautline

#endif
