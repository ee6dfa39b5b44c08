// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Blocks.h
 * @brief The data sets of a data object with their counterparts in other inputs, their selected
 * parts, and the arrays that a filter uses.
 */
#ifndef tautline_Blocks_h
#define tautline_Blocks_h

#include "TautlineCoreModule.h" // for export macro

#include "tautline/Mesh/Mesh.h"

#include "vtkSmartPointer.h"

#include <functional>
#include <map>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkDataArray;
class vtkDataObject;
class vtkDataSet;
class vtkSelection;

namespace tautline
{
/// The position of a data set in composite data, for messages.
struct TAUTLINECORE_EXPORT BlockPlace
{
  /// The flat index, counting each partitioned or multipiece data set as one data set, so that it
  /// does not depend on the number of partitions on a process. 0 if the data are one mesh.
  unsigned int block = 0;
  unsigned int partition = 0; ///< from 1 if the mesh has several partitions; otherwise 0

  /// "block 3", "partition 2 of block 3", "partition 2", or "".
  std::string name() const;
};

/// The positions of the data sets by flat index; a single data set has index 0.
TAUTLINECORE_EXPORT std::map<unsigned int, BlockPlace> blockPlaces(vtkDataObject* data);

/// A data set of the input and its counterparts.
struct InputBlock
{
  vtkDataSet* input;
  vtkDataSet* reference; ///< or null
  vtkDataSet* selected;  ///< the input with the array of markSelected(), or null
  vtkDataSet* output;
  int number;             ///< index among the data sets, from 0
  std::string name;       ///< BlockPlace::name(); "" if the input is one mesh
  unsigned int flatIndex; ///< in composite data; 0 if the input is a single data set
  BlockPlace place;
};

/**
 * @brief Gives a composite output the structure of the input and calls visit for each data set, or
 * once for a single data set. Throws Error if the structures of reference and input differ; the
 * name of the block is added to an Error that visit throws.
 */
TAUTLINECORE_EXPORT void forEachBlock(vtkDataObject* input, vtkDataObject* reference,
  vtkDataObject* selected, vtkDataObject* output,
  const std::function<void(const InputBlock&)>& visit);

/// The number of data sets, at least 1.
TAUTLINECORE_EXPORT int countBlocks(vtkDataObject* input);

/// Calls visit(flat index, data set) for the data sets of composite data, or with index 0 for a
/// single data set.
TAUTLINECORE_EXPORT void forEachLeaf(
  vtkDataObject* data, const std::function<void(unsigned int, vtkDataSet*)>& visit);

/// The data set in `data` that corresponds to a block of the input by its position, or `data`
/// itself; null if there is none.
TAUTLINECORE_EXPORT vtkDataSet* counterpartOf(const InputBlock& block, vtkDataObject* data);

/// The array of marks, on points or cells, in the result of markSelected().
constexpr const char* SelectedArray = "vtkInsidedness"; // the name used by vtkExtractSelection

/// A copy of the input in which the selected points or cells are marked; null without a selection.
TAUTLINECORE_EXPORT vtkSmartPointer<vtkDataObject> markSelected(
  vtkDataObject* input, vtkSelection* selection);

/// The items that an array read by a filter must have values for.
enum class ArrayOf
{
  Either, ///< points or cells, as the user chose
  Points,
  Cells
};

/**
 * @brief The point or cell array chosen with SetInputArrayToProcess(); null if none is chosen
 * ("None" or "") or if the input is empty, as a piece of a mesh may be.
 * @param index the index given to SetInputArrayToProcess()
 * @param purpose for the message, "of fixed points"
 * @param of the association that the filter needs. With Points or Cells only the name counts,
 * because a script that sets a ParaView property to a name leaves the association unchanged.
 *
 * Throws Error if the input has no such array of this name.
 */
TAUTLINECORE_EXPORT vtkDataArray* chosenArray(vtkAlgorithm* algorithm, int index, vtkDataSet* input,
  const char* purpose, ArrayOf of = ArrayOf::Either);

/// Flags the points with a nonzero value in a point array, or the points of cells with a nonzero
/// value in a cell array. @param array null for none
TAUTLINECORE_EXPORT void markPoints(
  const MeshView& view, vtkDataArray* array, bool ofCells, std::vector<unsigned char>& flags);
/// Flags the points that markSelected() marked, and the points of the cells it marked; null for
/// none.
TAUTLINECORE_EXPORT void markPoints(
  const MeshView& view, vtkDataSet* selected, std::vector<unsigned char>& flags);

/// Whether the chosen array is a cell array.
TAUTLINECORE_EXPORT bool chosenOfCells(vtkAlgorithm* algorithm, int index);
}
#endif
