// SPDX-License-Identifier: BSD-3-Clause
#include "ElementSelection.h"

#include "pqActiveObjects.h"
#include "pqOutputPort.h"
#include "pqPVApplicationCore.h"
#include "pqRenderView.h"
#include "pqSelectionManager.h"
#include "pqServer.h"
#include "pqTimeKeeper.h"
#include "pqUndoStack.h"

#include "vtkDataSetAttributes.h"
#include "vtkPVDataInformation.h"
#include "vtkPVDataSetAttributesInformation.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSelectionNode.h"
#include "vtkSmartPointer.h"

#include <algorithm>

namespace tautline
{
namespace
{

using Proxy = vtkSmartPointer<vtkSMSourceProxy>;

Proxy newProxy(pqOutputPort* port, const char* group, const char* name)
{
  Proxy proxy;
  proxy.TakeReference(vtkSMSourceProxy::SafeDownCast(
    port->getSourceProxy()->GetSessionProxyManager()->NewProxy(group, name)));
  return proxy;
}

/// A selection source for cells; its properties have yet to be set.
Proxy newSource(pqOutputPort* port, const char* name)
{
  Proxy source = newProxy(port, "sources", name);
  vtkSMPropertyHelper(source, "FieldType").Set(vtkSelectionNode::CELL);
  return source;
}

/// Selects on the output by an expression of the sources, which are named s0, s1, ...
void select(pqOutputPort* port, const std::vector<Proxy>& sources, const std::string& expression)
{
  Proxy combined = newProxy(port, "filters", "AppendSelections");
  for (std::size_t i = 0; i < sources.size(); ++i)
  {
    sources[i]->UpdateVTKObjects();
    vtkSMPropertyHelper(combined, "Input").Add(sources[i]);
    vtkSMPropertyHelper(combined, "SelectionNames")
      .Set(static_cast<unsigned int>(i), ("s" + std::to_string(i)).c_str());
  }
  vtkSMPropertyHelper(combined, "Expression").Set(expression.c_str());
  combined->UpdateVTKObjects();
  port->setSelectionInput(combined, 0);
  pqPVApplicationCore::instance()->selectionManager()->select(port);
  port->renderAllViews();
}

bool hasGlobalIds(vtkPVDataInformation* info)
{
  return info->GetCellDataInformation()->GetAttributeInformation(vtkDataSetAttributes::GLOBALIDS) !=
    nullptr;
}

bool isPartitioned(int type)
{
  return type == VTK_PARTITIONED_DATA_SET || type == VTK_MULTIPIECE_DATA_SET;
}

/// Appends the three numbers that identify a cell of composite data in ParaView.
bool appendComposite(
  const std::vector<ElementLeaf>& leaves, const ElementName& name, std::vector<vtkIdType>& ids)
{
  vtkTypeInt64 cell = name.cell;
  for (const ElementLeaf& leaf : leaves)
  {
    const bool here = name.block < 0 ||
      (name.block == leaf.block && (name.partition == 0 || name.partition == leaf.partition));
    if (here && cell < leaf.cells)
    {
      ids.insert(
        ids.end(), { static_cast<vtkIdType>(leaf.flatIndex), -1, static_cast<vtkIdType>(cell) });
      return true;
    }
    cell -= name.block < 0 ? leaf.cells : 0;
  }
  return false;
}

/// Appends the two numbers that identify a cell of a data set in ParaView.
bool append(pqOutputPort* port, const ElementName& name, std::vector<vtkIdType>& ids)
{
  const int processes = port->getServer()->getNumberOfPartitions();
  if (processes == 1 || name.process >= 0)
  {
    ids.insert(ids.end(), { processes == 1 ? -1 : name.process, name.cell });
    return processes > 1 || name.cell < port->getDataInformation()->GetNumberOfCells();
  }
  vtkTypeInt64 cell = name.cell;
  for (int process = 0; process < processes; ++process)
  {
    const vtkTypeInt64 cells = port->getRankDataInformation(process)->GetNumberOfCells();
    if (cell < cells)
    {
      ids.insert(ids.end(), { process, static_cast<vtkIdType>(cell) });
      return true;
    }
    cell -= cells;
  }
  return false;
}

} // anonymous namespace

//------------------------------------------------------------------------------
vtkSmartPointer<vtkSMSourceProxy> selectionOf(
  pqOutputPort* port, const std::vector<ElementName>& names, std::string& problem)
{
  vtkPVDataInformation* info = port->getDataInformation();
  const bool composite = info->IsCompositeDataSet();
  const bool global = hasGlobalIds(info) &&
    std::all_of(names.begin(), names.end(),
      [](const ElementName& name) { return name.block < 0 && name.process < 0; });
  if (composite && !global && port->getServer()->getNumberOfPartitions() > 1)
  {
    problem = "Cells of blocks on several processes have no unique numbers: apply Generate Global "
              "Ids first.";
    return nullptr;
  }
  const std::vector<ElementLeaf> leaves =
    composite && !global ? elementLeaves(port) : std::vector<ElementLeaf>();
  const pqScopedUndoExclude notUndone;
  std::vector<vtkIdType> ids;
  for (const ElementName& name : names)
  {
    if (global)
    {
      ids.push_back(name.cell);
    }
    else if (composite ? !appendComposite(leaves, name, ids) : !append(port, name, ids))
    {
      problem = "The output has no cell " + std::to_string(name.cell) +
        ": the result shown belongs to another mesh. Apply the filter again.";
      return nullptr;
    }
  }
  Proxy source = newSource(port,
    global        ? "GlobalIDSelectionSource"
      : composite ? "CompositeDataIDSelectionSource"
                  : "IDSelectionSource");
  vtkSMPropertyHelper(source, "IDs").Set(ids.data(), static_cast<unsigned int>(ids.size()));
  return source;
}

//------------------------------------------------------------------------------
std::string selectElements(pqOutputPort* port, const std::vector<ElementName>& names)
{
  std::string problem;
  if (const Proxy source = selectionOf(port, names, problem))
  {
    select(port, { source }, "s0");
  }
  return problem;
}

//------------------------------------------------------------------------------
vtkTypeInt64 selectWhere(pqOutputPort* port, const std::vector<CellCondition>& conditions, bool all)
{
  if (conditions.empty())
  {
    pqPVApplicationCore::instance()->selectionManager()->clearSelection();
    return 0;
  }
  const pqScopedUndoExclude notUndone;
  std::vector<Proxy> sources;
  std::string expression;
  for (const CellCondition& condition : conditions)
  {
    std::string alternatives;
    for (const std::vector<CellInterval>& intervals : condition)
    {
      std::string term;
      for (const CellInterval& interval : intervals)
      {
        Proxy source = newSource(port, "ThresholdSelectionSource");
        const double ends[2] = { interval.low, interval.high };
        vtkSMPropertyHelper(source, "Thresholds").Set(ends, 2);
        vtkSMPropertyHelper(source, "ArrayName").Set(interval.array.c_str());
        term += (term.empty() ? "s" : "&s") + std::to_string(sources.size());
        sources.push_back(source);
      }
      alternatives += (alternatives.empty() ? "(" : "|(") + term + ")";
    }
    expression += (expression.empty() ? "(" : all ? "&(" : "|(") + alternatives + ")";
  }
  select(port, sources, expression);
  return countSelected(port);
}

//------------------------------------------------------------------------------
std::vector<ElementLeaf> elementLeaves(pqOutputPort* port)
{
  constexpr unsigned int mostNodes = 100000;
  std::vector<ElementLeaf> leaves;
  const unsigned int number = static_cast<unsigned int>(port->getPortNumber());
  vtkPVDataInformation* all = port->getDataInformation();
  const vtkTypeInt64 cells = all->GetNumberOfCells();
  vtkTypeInt64 found = 0;
  // The cell at which the partitioned data set of the next data sets ends.
  vtkTypeInt64 end = isPartitioned(all->GetCompositeDataSetType()) ? cells : 0;
  ElementLeaf at;
  for (at.flatIndex = 1; found < cells && at.flatIndex < mostNodes; ++at.flatIndex)
  {
    vtkPVDataInformation* info =
      port->getSourceProxy()->GetSubsetDataInformation(number, at.flatIndex);
    const bool partition = found < end;
    at.block += partition ? 0 : 1;
    at.partition = partition ? at.partition + 1 : 0;
    if (info && info->IsCompositeDataSet())
    {
      end = isPartitioned(info->GetCompositeDataSetType()) ? found + info->GetNumberOfCells() : 0;
    }
    else if (info && !info->IsNull())
    {
      at.cells = info->GetNumberOfCells();
      found += at.cells;
      leaves.push_back(at);
    }
  }
  return leaves;
}

//------------------------------------------------------------------------------
vtkTypeInt64 countSelected(pqOutputPort* port)
{
  vtkSMSourceProxy* extract = port->getSourceProxy()->GetSelectionOutput(port->getPortNumber());
  if (!port->getSelectionInput() || !extract)
  {
    return 0;
  }
  const pqScopedUndoExclude notUndone;
  extract->UpdatePipeline(port->getServer()->getTimeKeeper()->getTime());
  return extract->GetDataInformation(0)->GetNumberOfCells();
}

//------------------------------------------------------------------------------
void zoomTo(pqRenderView* view, const double bounds[6], double margin)
{
  double size = 0, around[6];
  for (int axis = 0; axis < 3; ++axis)
  {
    size = std::max(size, bounds[2 * axis + 1] - bounds[2 * axis]);
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    around[2 * axis] = bounds[2 * axis] - margin * size;
    around[2 * axis + 1] = bounds[2 * axis + 1] + margin * size;
  }
  view->getRenderViewProxy()->ResetCamera(around);
  view->render();
}

//------------------------------------------------------------------------------
void zoomToSelected(pqOutputPort* port)
{
  auto* view = qobject_cast<pqRenderView*>(pqActiveObjects::instance().activeView());
  if (!view || countSelected(port) == 0)
  {
    return;
  }
  double bounds[6];
  port->getSelectedDataInformation()->GetBounds(bounds);
  // The surrounding elements show its position.
  constexpr double margin = 1.0;
  zoomTo(view, bounds, margin);
}

} // namespace tautline
