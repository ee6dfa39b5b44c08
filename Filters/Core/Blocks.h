// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Blocks.h
 * @brief The data sets of a data object with their counterparts in other inputs, what is selected
 * of them, and the arrays chosen by a filter.
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
/// Where a data set is in composite data, for messages.
struct TAUTLINECORE_EXPORT BlockPlace
{
  /// The flat index, if each partitioned or multipiece data set were one data set: its number does
  /// not depend on how many partitions a process has. 0: the data are one mesh.
  unsigned int block = 0;
  unsigned int partition = 0; ///< from 1, of several partitions of the mesh; else 0

  /// "block 3", "partition 2 of block 3", "partition 2", or "".
  std::string name() const;
};

/// The places of the data sets, by flat index; of a single data set that of 0.
TAUTLINECORE_EXPORT std::map<unsigned int, BlockPlace> blockPlaces(vtkDataObject* data);

/// A data set of the input, with its counterparts.
struct InputBlock
{
  vtkDataSet* input;
  vtkDataSet* reference; ///< or null
  vtkDataSet* selected;  ///< the input with the array of markSelected(), or null
  vtkDataSet* output;
  int number;             ///< counts through the data sets, from 0
  std::string name;       ///< BlockPlace::name(); "" if the input is one mesh
  unsigned int flatIndex; ///< of composite data; 0 if the input is a single data set
  BlockPlace place;
};

/**
 * @brief Gives a composite output the structure of the input and calls visit for each data set, or
 * once. Throws Error if reference and input do not have the same structure; what visit throws as
 * Error gets the name of the block.
 */
TAUTLINECORE_EXPORT void forEachBlock(vtkDataObject* input, vtkDataObject* reference,
  vtkDataObject* selected, vtkDataObject* output,
  const std::function<void(const InputBlock&)>& visit);

/// The number of data sets, at least 1.
TAUTLINECORE_EXPORT int countBlocks(vtkDataObject* input);

/// Calls visit(flat index, data set) for the data sets of composite data, or with 0 for a single
/// one.
TAUTLINECORE_EXPORT void forEachLeaf(
  vtkDataObject* data, const std::function<void(unsigned int, vtkDataSet*)>& visit);

/// The data set of `data` that belongs to a block of the input: at its place, or `data` itself;
/// null: none.
TAUTLINECORE_EXPORT vtkDataSet* counterpartOf(const InputBlock& block, vtkDataObject* data);

/// The array of marks, of points or cells, in what markSelected() returns.
constexpr const char* SelectedArray = "vtkInsidedness"; // the name vtkExtractSelection gives it

/// A copy of the input with marks on what is selected; null without a selection.
TAUTLINECORE_EXPORT vtkSmartPointer<vtkDataObject> markSelected(
  vtkDataObject* input, vtkSelection* selection);

/// What an array that a filter reads has to have a value for.
enum class ArrayOf
{
  Either, ///< points or cells, as the user chose
  Points,
  Cells
};

/**
 * @brief The point or cell array that the user chose by SetInputArrayToProcess(); null if none is
 * chosen ("None" or ""), or the input is empty, as a piece of a mesh may be.
 * @param index that of SetInputArrayToProcess()
 * @param purpose for the message, "of fixed points"
 * @param of what the filter needs. With Points or Cells the name alone counts, since a script that
 * sets a property of ParaView to a name leaves the association as it is.
 *
 * Throws Error if the input has no such array of that name.
 */
TAUTLINECORE_EXPORT vtkDataArray* chosenArray(vtkAlgorithm* algorithm, int index, vtkDataSet* input,
  const char* purpose, ArrayOf of = ArrayOf::Either);

/// Flags the points with a value other than 0 in a point array, or those of cells with one in a
/// cell array. @param array null: none
TAUTLINECORE_EXPORT void markPoints(
  const MeshView& view, vtkDataArray* array, bool ofCells, std::vector<unsigned char>& flags);
/// Flags the points that markSelected() found, and the points of the cells it found; null: none.
TAUTLINECORE_EXPORT void markPoints(
  const MeshView& view, vtkDataSet* selected, std::vector<unsigned char>& flags);

/// Whether the array chosen is one of cells.
TAUTLINECORE_EXPORT bool chosenOfCells(vtkAlgorithm* algorithm, int index);
}
#endif
