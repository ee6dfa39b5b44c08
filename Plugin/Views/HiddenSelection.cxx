// SPDX-License-Identifier: BSD-3-Clause
#include "HiddenSelection.h"

#include "FetchOutput.h"

#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqServer.h"
#include "pqTimeKeeper.h"
#include "pqUndoStack.h"

#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkPVDataInformation.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSelectionNode.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace tautline
{
namespace
{

constexpr const char* OriginalIds = "vtkOriginalCellIds";

/// The index of an array in a list; the array is added if it is missing.
std::size_t placeOf(const std::string& array, std::vector<std::string>& arrays)
{
  const auto found = std::find(arrays.begin(), arrays.end(), array);
  if (found == arrays.end())
  {
    arrays.push_back(array);
    return arrays.size() - 1;
  }
  return static_cast<std::size_t>(found - arrays.begin());
}

} // anonymous namespace

//------------------------------------------------------------------------------
HiddenSelection::HiddenSelection(pqOutputPort* port, const CellInterval& interval)
  : Port(port)
{
  const pqScopedUndoExclude notUndone;
  auto* manager = port->getSourceProxy()->GetSessionProxyManager();
  this->Selection.TakeReference(
    vtkSMSourceProxy::SafeDownCast(manager->NewProxy("sources", "ThresholdSelectionSource")));
  const double ends[2] = { interval.low, interval.high };
  vtkSMPropertyHelper(this->Selection, "FieldType").Set(vtkSelectionNode::CELL);
  vtkSMPropertyHelper(this->Selection, "Thresholds").Set(ends, 2);
  vtkSMPropertyHelper(this->Selection, "ArrayName").Set(interval.array.c_str());
  this->extract();
}

//------------------------------------------------------------------------------
HiddenSelection::HiddenSelection(pqOutputPort* port, vtkSMSourceProxy* selection)
  : Port(port)
  , Selection(selection)
{
  const pqScopedUndoExclude notUndone;
  this->extract();
}

//------------------------------------------------------------------------------
void HiddenSelection::extract()
{
  this->Extract.TakeReference(
    vtkSMSourceProxy::SafeDownCast(this->Port->getSourceProxy()->GetSessionProxyManager()->NewProxy(
      "filters", "ExtractSelection")));
  this->Selection->UpdateVTKObjects();
  vtkSMPropertyHelper(this->Extract, "Input")
    .Set(this->Port->getSourceProxy(), static_cast<unsigned int>(this->Port->getPortNumber()));
  vtkSMPropertyHelper(this->Extract, "Selection").Set(this->Selection.GetPointer());
  this->Extract->UpdateVTKObjects();
  this->Extract->UpdatePipeline(this->time());
}

//------------------------------------------------------------------------------
double HiddenSelection::time() const
{
  return this->Port->getServer()->getTimeKeeper()->getTime();
}

//------------------------------------------------------------------------------
vtkTypeInt64 HiddenSelection::count() const
{
  return this->Extract->GetDataInformation(0)->GetNumberOfCells();
}

//------------------------------------------------------------------------------
ElementValues HiddenSelection::cells() const
{
  ElementValues values;
  const int processes = this->Port->getServer()->getNumberOfPartitions();
  for (int process = 0; process < processes; ++process)
  {
    const auto data = fetchPart(this->Extract, 0, process, this->time());
    const int named = processes > 1 ? process : -1;
    if (auto* composite = vtkCompositeDataSet::SafeDownCast(data); composite && processes == 1)
    {
      this->addBlocks(composite, values);
    }
    else if (auto* cells = vtkDataSet::SafeDownCast(data))
    {
      this->add(cells, { 0, -1, named, 0 }, values);
    }
  }
  constexpr double missing = std::numeric_limits<double>::quiet_NaN();
  for (ElementValues::Row& row : values.rows)
  {
    row.values.resize(values.arrays.size(), missing);
  }
  return values;
}

//------------------------------------------------------------------------------
void HiddenSelection::add(vtkDataSet* cells, ElementName name, ElementValues& values) const
{
  vtkCellData* data = cells->GetCellData();
  vtkDataArray* ids = data->GetArray(OriginalIds);
  vtkDataArray* global = data->GetGlobalIds();
  if (!ids)
  {
    return;
  }
  std::vector<std::pair<std::size_t, vtkDataArray*>> columns;
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = data->GetArray(i);
    if (array && array != ids && array->GetNumberOfComponents() == 1 && array->GetName())
    {
      columns.emplace_back(placeOf(array->GetName(), values.arrays), array);
    }
  }
  constexpr double missing = std::numeric_limits<double>::quiet_NaN();
  for (vtkIdType i = 0; i < cells->GetNumberOfCells(); ++i)
  {
    name.cell = static_cast<vtkIdType>(ids->GetComponent(i, 0));
    // A name without block and process is a global id if the cells have global ids.
    ElementValues::Row row{
      global ? ElementName{ static_cast<vtkIdType>(global->GetComponent(i, 0)), -1, -1, 0 } : name,
      std::vector<double>(values.arrays.size(), missing)
    };
    for (const auto& [place, array] : columns)
    {
      row.values[place] = array->GetComponent(i, 0);
    }
    values.rows.push_back(row);
  }
}

//------------------------------------------------------------------------------
void HiddenSelection::addBlocks(vtkCompositeDataSet* extract, ElementValues& values) const
{
  // The blocks are numbered as in the output; some may be empty in the extract.
  const std::vector<ElementLeaf> leaves = elementLeaves(this->Port);
  vtkSmartPointer<vtkCompositeDataIterator> iterator;
  iterator.TakeReference(extract->NewIterator());
  for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
  {
    auto* cells = vtkDataSet::SafeDownCast(iterator->GetCurrentDataObject());
    const auto leaf = std::find_if(leaves.begin(), leaves.end(),
      [&](const ElementLeaf& one) { return one.flatIndex == iterator->GetCurrentFlatIndex(); });
    if (cells && leaf != leaves.end())
    {
      this->add(cells, { 0, leaf->block, -1, leaf->partition }, values);
    }
  }
}

//------------------------------------------------------------------------------
ElementNumbers::ElementNumbers(pqOutputPort* port)
{
  vtkPVDataInformation* info = port->getDataInformation();
  if (info->IsCompositeDataSet())
  {
    this->Leaves = elementLeaves(port);
    for (const ElementLeaf& leaf : this->Leaves)
    {
      this->BlockNames.push_back(info->GetBlockName(leaf.flatIndex));
    }
  }
  const int processes = port->getServer()->getNumberOfPartitions();
  for (int process = 0; processes > 1 && process < processes; ++process)
  {
    this->Cells.push_back(port->getRankDataInformation(process)->GetNumberOfCells());
  }
}

//------------------------------------------------------------------------------
vtkTypeInt64 ElementNumbers::of(const ElementName& name) const
{
  vtkTypeInt64 number = name.cell;
  for (std::size_t i = 0; name.block >= 0 && i < this->Leaves.size(); ++i)
  {
    const ElementLeaf& leaf = this->Leaves[i];
    if (leaf.block == name.block && (name.partition == 0 || leaf.partition == name.partition))
    {
      break;
    }
    number += leaf.cells;
  }
  for (int process = 0; process < name.process; ++process)
  {
    number += this->Cells[static_cast<std::size_t>(process)];
  }
  return number;
}

//------------------------------------------------------------------------------
std::string ElementNumbers::blockOf(const ElementName& name) const
{
  vtkTypeInt64 cell = name.cell;
  for (std::size_t i = 0; i < this->Leaves.size(); ++i)
  {
    const ElementLeaf& leaf = this->Leaves[i];
    const bool here = name.block >= 0
      ? leaf.block == name.block && (name.partition == 0 || leaf.partition == name.partition)
      : cell < leaf.cells;
    if (here)
    {
      return this->BlockNames[i].empty() ? "block " + std::to_string(leaf.block)
                                         : this->BlockNames[i];
    }
    cell -= leaf.cells;
  }
  return {};
}

} // namespace tautline
