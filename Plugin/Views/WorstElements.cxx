// SPDX-License-Identifier: BSD-3-Clause
#include "WorstElements.h"

#include "FetchOutput.h"

#include "tautline/Quality/Metrics.h"

#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqServer.h"
#include "pqTimeKeeper.h"

#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMSourceProxy.h"
#include "vtkSelectionNode.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <array>
#include <limits>
#include <sstream>

namespace tautline
{
namespace
{

/// How many elements are listed of an array whose values all elements have.
constexpr std::size_t Listed = 10;
constexpr double Largest = std::numeric_limits<double>::max();
constexpr const char* ObstacleArray = "Obstacle";
constexpr const char* ValidityArray = "Validity";

/// Why an element is not valid, by the values of the array Obstacle of vtkMeshUntangler.
constexpr std::array<const char*, 5> obstacles = { "valid",
  "the iterations ended before it became valid", "all its points are fixed",
  "the fixed points around leave no place for it", "a fixed point of it is not finite" };

std::string textOf(const std::string& array, double value)
{
  std::ostringstream text;
  text.precision(4);
  text << array << " " << value;
  return text.str();
}

/// The lists of the output Worst of Element Quality.
std::vector<WorstElementList> listsOf(vtkPolyData* points)
{
  std::vector<WorstElementList> lists;
  const auto array = [points](const char* name) { return points->GetPointData()->GetArray(name); };
  vtkDataArray* metric = array("Metric");
  vtkDataArray* id = array("CellId");
  vtkDataArray* value = array("Value");
  vtkDataArray* validity = array("Validity");
  if (!metric || !id || !value || !validity)
  {
    return lists;
  }
  const std::vector<MetricInfo>& known = metricRegistry();
  int last = -1;
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    const int number = static_cast<int>(metric->GetComponent(i, 0));
    if (lists.empty() || number != last)
    {
      const auto info = std::find_if(known.begin(), known.end(),
        [number](const MetricInfo& one) { return static_cast<int>(one.metric) == number; });
      lists.push_back(info == known.end() // of a server of another version
          ? WorstElementList{ "Metric " + std::to_string(number), "", {} }
          : WorstElementList{ info->label, info->name, {} });
      last = number;
    }
    const double v = value->GetComponent(i, 0), state = validity->GetComponent(i, 0);
    const char* invalid = state == Inverted ? ", inverted"
      : state == Degenerate                 ? ", degenerate"
                                            : "";
    lists.back().elements.push_back({ { static_cast<vtkIdType>(id->GetComponent(i, 0)), -1, -1, 0 },
      v, textOf(lists.back().array, v) + invalid });
  }
  return lists;
}

/// The cells of a selection of an interval of an array; nothing is shown.
class HiddenSelection
{
public:
  HiddenSelection(pqOutputPort* port, const CellInterval& interval)
    : Port(port)
    , Array(interval.array)
  {
    auto* manager = port->getSourceProxy()->GetSessionProxyManager();
    this->Selection.TakeReference(
      vtkSMSourceProxy::SafeDownCast(manager->NewProxy("sources", "ThresholdSelectionSource")));
    const double ends[2] = { interval.low, interval.high };
    vtkSMPropertyHelper(this->Selection, "FieldType").Set(vtkSelectionNode::CELL);
    vtkSMPropertyHelper(this->Selection, "Thresholds").Set(ends, 2);
    vtkSMPropertyHelper(this->Selection, "ArrayName").Set(interval.array.c_str());
    this->Selection->UpdateVTKObjects();
    this->Extract.TakeReference(
      vtkSMSourceProxy::SafeDownCast(manager->NewProxy("filters", "ExtractSelection")));
    vtkSMPropertyHelper(this->Extract, "Input")
      .Set(port->getSourceProxy(), static_cast<unsigned int>(port->getPortNumber()));
    vtkSMPropertyHelper(this->Extract, "Selection").Set(this->Selection.GetPointer());
    this->Extract->UpdateVTKObjects();
    this->Extract->UpdatePipeline(this->time());
  }

  vtkTypeInt64 count() const { return this->Extract->GetDataInformation(0)->GetNumberOfCells(); }

  /// Names and values of the cells; of composite data on several processes nothing.
  std::vector<WorstElementEntry> cells() const
  {
    std::vector<WorstElementEntry> entries;
    const int processes = this->Port->getServer()->getNumberOfPartitions();
    for (int process = 0; process < processes; ++process)
    {
      const auto data = fetchPart(this->Extract, 0, process, this->time());
      const int named = processes > 1 ? process : -1;
      if (auto* composite = vtkCompositeDataSet::SafeDownCast(data); composite && processes == 1)
      {
        this->addBlocks(composite, entries);
      }
      else if (auto* cells = vtkDataSet::SafeDownCast(data))
      {
        this->add(cells, { 0, -1, named, 0 }, entries);
      }
    }
    return entries;
  }

private:
  double time() const { return this->Port->getServer()->getTimeKeeper()->getTime(); }

  void add(vtkDataSet* cells, ElementName name, std::vector<WorstElementEntry>& entries) const
  {
    vtkDataArray* ids = cells->GetCellData()->GetArray("vtkOriginalCellIds");
    vtkDataArray* values = cells->GetCellData()->GetArray(this->Array.c_str());
    for (vtkIdType i = 0; ids && values && i < cells->GetNumberOfCells(); ++i)
    {
      const double value = values->GetComponent(i, 0);
      name.cell = static_cast<vtkIdType>(ids->GetComponent(i, 0));
      entries.push_back({ name, value, textOf(this->Array, value) });
    }
  }

  /// The blocks are numbered as those of the output, of which the extract may leave some empty.
  void addBlocks(vtkCompositeDataSet* extract, std::vector<WorstElementEntry>& entries) const
  {
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
        this->add(cells, { 0, leaf->block, -1, leaf->partition }, entries);
      }
    }
  }

  pqOutputPort* Port;
  std::string Array;
  vtkSmartPointer<vtkSMSourceProxy> Selection, Extract;
};

vtkPVArrayInformation* cellArray(pqOutputPort* port, const char* name)
{
  return port->getDataInformation()->GetArrayInformation(name, vtkDataObject::CELL);
}

/// Whether the array of an output may have inverted or degenerate elements.
bool hasInvalid(pqOutputPort* port)
{
  vtkPVArrayInformation* validity = cellArray(port, ValidityArray);
  return validity && validity->GetComponentRange(0)[0] <= Degenerate;
}

/// The elements with an obstacle.
WorstElementList obstaclesOf(pqOutputPort* port)
{
  WorstElementList list = { "Obstacle to untangling", ObstacleArray,
    HiddenSelection(port, { ObstacleArray, 1, Largest }).cells() };
  for (WorstElementEntry& entry : list.elements)
  {
    const auto reason =
      static_cast<std::size_t>(std::clamp<double>(entry.value, 0, obstacles.size() - 1));
    entry.text = obstacles[reason];
  }
  return list;
}

/// The elements that are inverted or degenerate, of a mesh whose points have moved.
WorstElementList invalidOf(pqOutputPort* port)
{
  WorstElementList list = { "Invalid elements", ValidityArray,
    HiddenSelection(port, { ValidityArray, Inverted, Degenerate }).cells() };
  for (WorstElementEntry& entry : list.elements)
  {
    entry.text = entry.value == Inverted ? "inverted" : "degenerate";
  }
  return list;
}

/// The elements with the largest values of an array.
WorstElementList largestOf(pqOutputPort* port, const char* label, const char* array)
{
  const double* range = cellArray(port, array)->GetComponentRange(0);
  // Bisection for a threshold that few, but enough, elements exceed.
  constexpr int steps = 30, mostFetched = 200;
  double enough = range[0], tooFew = range[1];
  for (int step = 0; step < steps; ++step)
  {
    const double middle = 0.5 * enough + 0.5 * tooFew;
    const vtkTypeInt64 count = HiddenSelection(port, { array, middle, Largest }).count();
    (count >= static_cast<vtkTypeInt64>(Listed) ? enough : tooFew) = middle;
    if (count >= static_cast<vtkTypeInt64>(Listed) && count <= mostFetched)
    {
      break;
    }
  }
  WorstElementList list = { label, array,
    HiddenSelection(port, { array, enough, Largest }).cells() };
  std::stable_sort(list.elements.begin(), list.elements.end(),
    [](const WorstElementEntry& a, const WorstElementEntry& b) { return a.value > b.value; });
  list.elements.resize(std::min(Listed, list.elements.size()));
  return list;
}

} // anonymous namespace

//------------------------------------------------------------------------------
std::vector<WorstElementList> worstElementsOf(pqPipelineSource* source)
{
  if (source->modifiedState() != pqProxy::UNMODIFIED)
  {
    return {};
  }
  const auto worst = fetchOutput(source, "Worst");
  if (auto* points = vtkPolyData::SafeDownCast(worst))
  {
    return listsOf(points);
  }
  std::vector<WorstElementList> lists;
  pqOutputPort* mesh = source->getOutputPort(0);
  if (cellArray(mesh, ObstacleArray))
  {
    lists.push_back(obstaclesOf(mesh));
  }
  else if (hasInvalid(mesh))
  {
    lists.push_back(invalidOf(mesh));
  }
  for (const auto& [array, label] :
    { std::pair("Share", "Share of the largest eigenvalue"), std::pair("Excess", "Excess") })
  {
    if (cellArray(mesh, array))
    {
      lists.push_back(largestOf(mesh, label, array));
    }
  }
  return lists;
}

} // namespace tautline
