// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::TableRows
 * @brief A table that is built row by row; the first row defines the columns.
 *
 *     rows.begin("block 3");
 *     rows.add("Condition", 12.5);
 *     rows.addText("Method", "Lanczos");
 *     rows.fill(table);
 */
#ifndef tautline_TableRows_h
#define tautline_TableRows_h

#include "TautlineCoreModule.h" // for export macro

#include "tautline/Core/Interruption.h"

#include <string>
#include <string_view>
#include <vector>

class vtkTable;

namespace tautline
{
class TAUTLINECORE_EXPORT TableRows
{
public:
  /// Begins a row. @param block the value of the text column `Block`; "" for no such column
  void begin(const std::string& block = "");
  /// Adds a value to the row. All rows have the same columns in the same order.
  void add(std::string_view column, double value);
  void addText(std::string_view column, std::string_view value);
  /// Adds a column for many rows, with value(i) in row i. Call begin() first; all columns are then
  /// added in this way, with the same number of rows.
  template <class Value>
  void addMany(std::string_view column, std::size_t rows, const Value& value)
  {
    std::vector<double>& values = this->next(column).values;
    values.reserve(values.size() + rows);
    for (std::size_t i = 0; i < rows; ++i)
    {
      pollInterruption(static_cast<Index>(i));
      values.push_back(value(i));
    }
  }
  template <class Text>
  void addManyTexts(std::string_view column, std::size_t rows, const Text& text)
  {
    std::vector<std::string>& texts = this->next(column).texts;
    texts.reserve(texts.size() + rows);
    for (std::size_t i = 0; i < rows; ++i)
    {
      pollInterruption(static_cast<Index>(i));
      texts.emplace_back(text(i));
    }
  }
  /// Replaces the contents of a table.
  void fill(vtkTable* table) const;

private:
  struct Column
  {
    std::string name;
    std::vector<double> values;
    std::vector<std::string> texts;
  };
  Column& next(std::string_view name);
  std::vector<Column> Columns;
  std::size_t Next = 0;
};
}
#endif
