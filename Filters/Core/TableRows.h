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

#include <string>
#include <vector>

class vtkTable;

namespace tautline
{
class TAUTLINECORE_EXPORT TableRows
{
public:
  /// Begins a row. @param block a name for the text column `Block`; "": there is no such column
  void begin(const std::string& block = "");
  /// Adds a value to the row. Rows have the same columns in the same order.
  void add(const std::string& column, double value);
  void addText(const std::string& column, const std::string& value);
  /// Replaces the contents of a table.
  void fill(vtkTable* table) const;

private:
  struct Column
  {
    std::string name;
    std::vector<double> values;
    std::vector<std::string> texts;
  };
  Column& next(const std::string& name);
  std::vector<Column> Columns;
  std::size_t Next = 0;
};
}
#endif
