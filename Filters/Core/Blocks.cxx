// SPDX-License-Identifier: BSD-3-Clause
#include "Blocks.h"

#include "LackingArrays.h"

#include "vtkAlgorithm.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDataObjectTree.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkExtractSelection.h"
#include "vtkInformation.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkNew.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPartitionedDataSetCollection.h"
#include "vtkPointData.h"
#include "vtkSelection.h"

#include <algorithm>

namespace tautline
{
namespace
{
/// Counts the nodes of a tree of data sets, with and without the partitions of meshes.
struct PlaceCounter
{
  std::map<unsigned int, BlockPlace>& places;
  unsigned int flat = 0, block = 0;

  /// The item at the position of both counts.
  void visit(vtkDataObject* data)
  {
    if (auto* blocks = vtkMultiBlockDataSet::SafeDownCast(data))
    {
      for (unsigned int i = 0; i < blocks->GetNumberOfBlocks(); ++i)
      {
        this->descend(blocks->GetBlock(i));
      }
    }
    else if (auto* sets = vtkPartitionedDataSetCollection::SafeDownCast(data))
    {
      for (unsigned int i = 0; i < sets->GetNumberOfPartitionedDataSets(); ++i)
      {
        this->descend(sets->GetPartitionedDataSet(i));
      }
    }
    else if (auto* parts = vtkPartitionedDataSet::SafeDownCast(data))
    {
      const unsigned int count = parts->GetNumberOfPartitions();
      for (unsigned int i = 0; i < count; ++i)
      {
        this->places[++this->flat] = { this->block, count > 1 ? i + 1 : 0 };
      }
    }
    else
    {
      this->places[this->flat] = { this->block, 0 };
    }
  }

private:
  void descend(vtkDataObject* child)
  {
    ++this->flat;
    ++this->block;
    this->visit(child);
  }
};
}

//------------------------------------------------------------------------------
std::string BlockPlace::name() const
{
  const std::string whole = this->block > 0 ? "block " + std::to_string(this->block) : "";
  return this->partition == 0
    ? whole
    : "partition " + std::to_string(this->partition) + (whole.empty() ? "" : " of ") + whole;
}

//------------------------------------------------------------------------------
std::map<unsigned int, BlockPlace> blockPlaces(vtkDataObject* data)
{
  std::map<unsigned int, BlockPlace> places;
  if (vtkDataObjectTree::SafeDownCast(data) || !vtkCompositeDataSet::SafeDownCast(data))
  {
    PlaceCounter{ places }.visit(data);
  }
  else
  {
    forEachLeaf(data, [&places](unsigned int index, vtkDataSet*) { places[index] = { index, 0 }; });
  }
  return places;
}

//------------------------------------------------------------------------------
void forEachBlock(vtkDataObject* input, vtkDataObject* reference, vtkDataObject* selected,
  vtkDataObject* output, const std::function<void(const InputBlock&)>& visit)
{
  const bool composite = vtkCompositeDataSet::SafeDownCast(input);
  if (reference && composite != (vtkCompositeDataSet::SafeDownCast(reference) != nullptr))
  {
    throw Error(composite
        ? "The mesh has blocks but the reference has none: give a reference of the same "
          "structure, or merge the blocks first (Merge Blocks)."
        : "The mesh is a single data set but the reference has blocks: extract the block that is "
          "the reference (Extract Block).");
  }
  if (!composite)
  {
    visit({ vtkDataSet::SafeDownCast(input), vtkDataSet::SafeDownCast(reference),
      vtkDataSet::SafeDownCast(selected), vtkDataSet::SafeDownCast(output), 0, "", 0, {} });
    return;
  }
  auto* blocks = vtkCompositeDataSet::SafeDownCast(input);
  auto* references = vtkCompositeDataSet::SafeDownCast(reference);
  auto* selections = vtkCompositeDataSet::SafeDownCast(selected);
  auto* results = vtkCompositeDataSet::SafeDownCast(output);
  results->CopyStructure(blocks);
  std::map<unsigned int, BlockPlace> places = blockPlaces(blocks);
  auto walk = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
  int number = 0;
  for (walk->InitTraversal(); !walk->IsDoneWithTraversal(); walk->GoToNextItem())
  {
    auto* block = vtkDataSet::SafeDownCast(walk->GetCurrentDataObject());
    if (!block)
    {
      continue;
    }
    const unsigned int index = walk->GetCurrentFlatIndex();
    const BlockPlace place = places[index];
    const std::string name = place.name();
    const auto at = [&walk](vtkCompositeDataSet* set)
    { return set ? vtkDataSet::SafeDownCast(set->GetDataSet(walk)) : nullptr; };
    auto result = vtkSmartPointer<vtkDataSet>::Take(block->NewInstance());
    try
    {
      visit({ block, at(references), at(selections), result, number++, name, index, place });
    }
    catch (const Error& error)
    {
      throw Error((name.empty() ? "" : "In " + name + ": ") + error.what());
    }
    // Not earlier: an adaptive grid accepts no empty data sets.
    results->SetDataSet(walk, result);
  }
}

//------------------------------------------------------------------------------
void forEachLeaf(vtkDataObject* data, const std::function<void(unsigned int, vtkDataSet*)>& visit)
{
  auto* blocks = vtkCompositeDataSet::SafeDownCast(data);
  if (auto* single = vtkDataSet::SafeDownCast(data))
  {
    visit(0, single);
  }
  if (!blocks)
  {
    return;
  }
  auto walk = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
  for (walk->InitTraversal(); !walk->IsDoneWithTraversal(); walk->GoToNextItem())
  {
    if (auto* leaf = vtkDataSet::SafeDownCast(walk->GetCurrentDataObject()))
    {
      visit(walk->GetCurrentFlatIndex(), leaf);
    }
  }
}

//------------------------------------------------------------------------------
vtkDataSet* counterpartOf(const InputBlock& block, vtkDataObject* data)
{
  const bool composite = vtkCompositeDataSet::SafeDownCast(data);
  vtkDataSet* found = nullptr;
  forEachLeaf(data,
    [&](unsigned int index, vtkDataSet* leaf)
    { found = !composite || index == block.flatIndex ? leaf : found; });
  return found;
}

//------------------------------------------------------------------------------
int countBlocks(vtkDataObject* input)
{
  int count = 0;
  forEachLeaf(input, [&count](unsigned int, vtkDataSet*) { ++count; });
  return std::max(count, 1);
}

//------------------------------------------------------------------------------
vtkSmartPointer<vtkDataObject> markSelected(vtkDataObject* input, vtkSelection* selection)
{
  if (!selection || selection->GetNumberOfNodes() == 0)
  {
    return nullptr;
  }
  vtkNew<vtkExtractSelection> extract;
  extract->PreserveTopologyOn();
  extract->SetInputDataObject(0, input);
  extract->SetInputDataObject(1, selection);
  extract->Update();
  return extract->GetOutputDataObject(0);
}

//------------------------------------------------------------------------------
void markPoints(
  const MeshView& view, vtkDataArray* array, bool ofCells, std::vector<unsigned char>& flags)
{
  for (Index cell = 0; array && ofCells && cell < view.numberOfCells; ++cell)
  {
    for (Index n = view.offsets[cell]; n < view.offsets[cell + 1]; ++n)
    {
      flags[view.connectivity[n]] |= array->GetComponent(cell, 0) != 0;
    }
  }
  for (Index i = 0; array && !ofCells && i < view.numberOfPoints; ++i)
  {
    flags[i] |= array->GetComponent(i, 0) != 0;
  }
}

//------------------------------------------------------------------------------
void markPoints(const MeshView& view, vtkDataSet* selected, std::vector<unsigned char>& flags)
{
  if (selected)
  {
    markPoints(view, selected->GetCellData()->GetArray(SelectedArray), true, flags);
    markPoints(view, selected->GetPointData()->GetArray(SelectedArray), false, flags);
  }
}

//------------------------------------------------------------------------------
vtkDataArray* chosenArray(
  vtkAlgorithm* algorithm, int index, vtkDataSet* input, const char* purpose, ArrayOf of)
{
  vtkInformation* choice = algorithm->GetInputArrayInformation(index);
  const char* name = choice->Get(vtkDataObject::FIELD_NAME());
  if (!name || !*name || std::string(name) == "None")
  {
    return nullptr;
  }
  const bool ofCells =
    of == ArrayOf::Either ? chosenOfCells(algorithm, index) : of == ArrayOf::Cells;
  if (input->GetNumberOfPoints() == 0 || input->GetNumberOfCells() == 0)
  {
    return nullptr; // an empty piece need not have arrays
  }
  vtkDataSetAttributes* data =
    input->GetAttributes(ofCells ? vtkDataObject::CELL : vtkDataObject::POINT);
  vtkDataSetAttributes* others =
    input->GetAttributes(ofCells ? vtkDataObject::POINT : vtkDataObject::CELL);
  vtkDataArray* array = data->GetArray(name);
  if (!array && data->GetAbstractArray(name))
  {
    throw Error(std::string("The ") + (ofCells ? "cell" : "point") + " array '" + name + "' " +
      purpose + " holds text, not numbers: choose another one, or None.");
  }
  if (!array && of != ArrayOf::Either && others->GetArray(name))
  {
    throw Error(std::string("The array '") + name + "' " + purpose +
      (ofCells ? " is a point array; a cell array is needed: run Point Data to Cell Data."
               : " is a cell array; a point array is needed: run Cell Data to Point Data."));
  }
  if (!array)
  {
    throw Error(std::string("There is no ") + (ofCells ? "cell" : "point") + " array '" + name +
      "' " + purpose + lackingPiece(input, name, ofCells) + ": choose another one, or None.");
  }
  return array;
}

//------------------------------------------------------------------------------
bool chosenOfCells(vtkAlgorithm* algorithm, int index)
{
  return algorithm->GetInputArrayInformation(index)->Get(vtkDataObject::FIELD_ASSOCIATION()) ==
    vtkDataObject::FIELD_ASSOCIATION_CELLS;
}
}
