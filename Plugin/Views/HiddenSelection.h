// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class tautline::HiddenSelection
 * @brief The cells of a selection that is not shown, with the values of their cell arrays.
 *
 * The selection is evaluated on the server; cells() brings the selected cells to the client.
 */

#ifndef tautline_HiddenSelection_h
#define tautline_HiddenSelection_h

#include "ElementSelection.h"

#include "vtkSmartPointer.h"

#include <string>
#include <vector>

class pqOutputPort;
class vtkCompositeDataSet;
class vtkDataSet;
class vtkSMSourceProxy;

namespace tautline
{

/// Cells with the values of their one-component cell arrays.
struct ElementValues
{
  struct Row
  {
    ElementName name;
    std::vector<double> values; ///< by array; NaN where a block lacks the array
  };
  std::vector<std::string> arrays;
  std::vector<Row> rows;
};

class HiddenSelection
{
public:
  /// The cells whose values of an array are in a closed interval.
  HiddenSelection(pqOutputPort* port, const CellInterval& interval);
  /// The cells of a selection source.
  HiddenSelection(pqOutputPort* port, vtkSMSourceProxy* selection);

  vtkTypeInt64 count() const;

  /// Names and values of the cells; none for composite data on several processes.
  ElementValues cells() const;

private:
  double time() const;
  void extract();
  void add(vtkDataSet* cells, ElementName name, ElementValues& values) const;
  void addBlocks(vtkCompositeDataSet* extract, ElementValues& values) const;

  pqOutputPort* Port;
  vtkSmartPointer<vtkSMSourceProxy> Selection, Extract;
};

/// Numbers elements across all blocks and processes, or by global id, as element names may also do.
class ElementNumbers
{
public:
  explicit ElementNumbers(pqOutputPort* port);
  vtkTypeInt64 of(const ElementName& name) const;
  /// The name of the block of an element, "" without blocks.
  std::string blockOf(const ElementName& name) const;

private:
  std::vector<ElementLeaf> Leaves;
  std::vector<std::string> BlockNames; ///< by leaf
  std::vector<vtkTypeInt64> Cells;     ///< by process
};

} // namespace tautline

#endif
