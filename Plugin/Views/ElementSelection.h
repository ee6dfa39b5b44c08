// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file ElementSelection.h
 * @brief Selects cells of an output as a selection of ParaView, and moves the camera to them.
 *
 * The selections are evaluated where the data are, on the server: only the request and the
 * number of selected cells are sent. Extract Selection and Find Data work on them.
 */

#ifndef tautline_ElementSelection_h
#define tautline_ElementSelection_h

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <string>
#include <vector>

class pqOutputPort;
class pqRenderView;
class vtkSMSourceProxy;

namespace tautline
{

/// A cell, as named in the summaries and tables of the filters.
struct ElementName
{
  vtkIdType cell = 0;
  int block = -1;    ///< number of a block in summaries: `cell` counts within it; -1: through all
  int process = -1;  ///< `cell` counts within its part; -1: through all parts
  int partition = 0; ///< from 1: `cell` counts within this partition of the block; 0: it has one
};

/// A data set of composite data.
struct ElementLeaf
{
  unsigned int flatIndex = 0;
  vtkTypeInt64 cells = 0;
  int block = 0;     ///< the number in summaries: the flat index if partitions were one data set
  int partition = 0; ///< from 1, of a partitioned or multipiece data set; otherwise 0
};

/// A closed interval of the values of a cell array.
struct CellInterval
{
  std::string array;
  double low = 0;
  double high = 0;
};

/// Alternatives, each a list of intervals: a cell satisfies the condition if it is in all intervals
/// of at least one alternative.
using CellCondition = std::vector<std::vector<CellInterval>>;

/**
 * @brief A selection source for some cells, which are not selected yet.
 * @param problem the error, with a fix, if the result is null
 */
vtkSmartPointer<vtkSMSourceProxy> selectionOf(
  pqOutputPort* port, const std::vector<ElementName>& names, std::string& problem);

/**
 * @brief Selects only the given cells.
 *
 * If the cells have global ids and a name gives neither block nor process, it is a global id.
 * @return "", or the error with a fix; then nothing changes.
 */
std::string selectElements(pqOutputPort* port, const std::vector<ElementName>& names);

/**
 * @brief Selects the cells that satisfy all conditions, or at least one. Without
 * conditions, clears the selection.
 * @return the number of selected cells
 */
vtkTypeInt64 selectWhere(
  pqOutputPort* port, const std::vector<CellCondition>& conditions, bool all);

/// The data sets of composite data that have cells.
std::vector<ElementLeaf> elementLeaves(pqOutputPort* port);

/// The number of selected cells of an output.
vtkTypeInt64 countSelected(pqOutputPort* port);

/// Moves the camera of a view to bounds; the margin around them is a multiple of their size.
void zoomTo(pqRenderView* view, const double bounds[6], double margin);

/// Moves the camera of the active render view to the selection and some of its surroundings.
void zoomToSelected(pqOutputPort* port);

} // namespace tautline

#endif
