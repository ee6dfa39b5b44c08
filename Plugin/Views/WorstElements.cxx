// SPDX-License-Identifier: BSD-3-Clause
#include "WorstElements.h"

#include "FetchOutput.h"
#include "HiddenSelection.h"

#include "tautline/Quality/Metrics.h"

#include "pqOutputPort.h"
#include "pqPipelineSource.h"

#include "vtkAbstractArray.h"
#include "vtkDataArray.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSMProxy.h"
#include "vtkTable.h"
#include "vtkVariant.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <sstream>

namespace tautline
{
namespace
{

/// Number of elements listed for an array that has a value for each element.
constexpr std::size_t Listed = 10;
/// Longer lists are not useful.
constexpr vtkIdType MostFetched = 10000;
constexpr double Largest = std::numeric_limits<double>::max();
constexpr const char* ObstacleArray = "Obstacle";

/// The reason why an element is not valid, by the value of the array Obstacle; without the fixes,
/// the texts equal the reasons of vtkMeshUntangler.
constexpr std::array<const char*, 5> obstacles = { "valid",
  "the iterations ended before it became valid", "all its points are fixed",
  "the surrounding fixed points leave no valid position for its free ones",
  "one of its fixed points is NaN or infinite" };

std::string textOf(const std::string& array, double value)
{
  std::ostringstream text;
  text.precision(4);
  text << array << " " << value;
  return text.str();
}

/// The lists from the output Worst of Element Quality.
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
      lists.push_back(info == known.end() // from a server of another version
          ? WorstElementList{ "Metric " + std::to_string(number), "", {}, Ranking::Complete }
          : WorstElementList{ info->label, info->name, {}, Ranking::Complete });
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

vtkPVArrayInformation* cellArray(pqOutputPort* port, const char* name)
{
  return port->getDataInformation()->GetArrayInformation(name, vtkDataObject::CELL);
}

/// The index of an array among the arrays of some cells, which must have it.
std::size_t placeOf(const ElementValues& cells, const std::string& array)
{
  return static_cast<std::size_t>(
    std::find(cells.arrays.begin(), cells.arrays.end(), array) - cells.arrays.begin());
}

/// The elements whose values of an array are in an interval.
std::vector<WorstElementEntry> entriesIn(pqOutputPort* port, const CellInterval& interval)
{
  std::vector<WorstElementEntry> entries;
  const ElementValues cells = HiddenSelection(port, interval).cells();
  const std::size_t place = placeOf(cells, interval.array);
  for (const ElementValues::Row& row : cells.rows)
  {
    const double value = row.values[place];
    entries.push_back({ row.name, value, textOf(interval.array, value) });
  }
  return entries;
}

/// The elements with an obstacle.
WorstElementList obstaclesOf(pqOutputPort* port)
{
  WorstElementList list = { "Obstacle to untangling", ObstacleArray,
    entriesIn(port, { ObstacleArray, 1, Largest }), Ranking::Complete };
  for (WorstElementEntry& entry : list.elements)
  {
    const auto reason =
      static_cast<std::size_t>(std::clamp<double>(entry.value, 0, obstacles.size() - 1));
    entry.text = obstacles[reason];
  }
  return list;
}

/// The inverted and degenerate elements.
void addInvalid(pqOutputPort* port, WorstElementList& list)
{
  const CellInterval invalid = { list.array, Inverted, Degenerate };
  if (HiddenSelection(port, invalid).count() > MostFetched)
  {
    list.label += " (too many for a list: color by Validity)";
    return;
  }
  list.elements = entriesIn(port, invalid);
  for (WorstElementEntry& entry : list.elements)
  {
    entry.text = entry.value == Inverted ? "inverted" : "degenerate";
  }
}

/// The elements with the largest or smallest values of an array.
void addExtreme(pqOutputPort* port, WorstElementList& list)
{
  const bool largest = list.ranking == Ranking::Largest;
  const double* range = cellArray(port, list.array.c_str())->GetComponentRange(0);
  const auto beyond = [&](double value)
  {
    return largest ? CellInterval{ list.array, value, Largest }
                   : CellInterval{ list.array, -Largest, value };
  };
  // Bisection for a threshold that enough elements exceed, but not many.
  constexpr int steps = 30;
  constexpr vtkTypeInt64 enoughFetched = 200;
  double enough = range[largest ? 0 : 1], tooFew = range[largest ? 1 : 0];
  for (int step = 0; step < steps; ++step)
  {
    const double middle = 0.5 * enough + 0.5 * tooFew;
    const vtkTypeInt64 count = HiddenSelection(port, beyond(middle)).count();
    (count >= static_cast<vtkTypeInt64>(Listed) ? enough : tooFew) = middle;
    if (count >= static_cast<vtkTypeInt64>(Listed) && count <= enoughFetched)
    {
      break;
    }
  }
  list.elements = entriesIn(port, beyond(enough));
  std::stable_sort(list.elements.begin(), list.elements.end(),
    [largest](const WorstElementEntry& a, const WorstElementEntry& b)
    { return largest ? a.value > b.value : a.value < b.value; });
  list.elements.resize(std::min(Listed, list.elements.size()));
}

/// Parses "partition 2 of block 3" from a table into the parts of a name.
ElementName inBlock(vtkIdType cell, const std::string& text)
{
  ElementName name = { cell, -1, -1, 0 };
  int partition = 0, block = 0;
  if (std::sscanf(text.c_str(), "partition %d of block %d", &partition, &block) >= 1)
  {
    name.partition = partition;
    name.block = block;
  }
  else if (std::sscanf(text.c_str(), "block %d", &block) == 1)
  {
    name.block = block;
  }
  return name;
}

/// The elements that Improve Mesh left below its target.
WorstElementList remainingOf(vtkTable* table)
{
  WorstElementList list = { "Below the target", "min_angle", {}, Ranking::Complete };
  vtkAbstractArray *cell = table->GetColumnByName("Cell"), *block = table->GetColumnByName("Block"),
                   *angle = table->GetColumnByName("Smallest angle"),
                   *reason = table->GetColumnByName("Reason");
  const vtkIdType rows = std::min(table->GetNumberOfRows(), MostFetched);
  for (vtkIdType i = 0; cell && angle && reason && i < rows; ++i)
  {
    const double value = angle->GetVariantValue(i).ToDouble();
    list.elements.push_back({ inBlock(static_cast<vtkIdType>(cell->GetVariantValue(i).ToLongLong()),
                                block ? block->GetVariantValue(i).ToString() : std::string()),
      value, textOf(list.array, value) + ", " + reason->GetVariantValue(i).ToString() });
  }
  return list;
}

/// The lists by metrics that a filter measured before and after its work.
void addMetrics(pqOutputPort* mesh, std::vector<WorstElementList>& lists)
{
  for (const MetricInfo& info : metricRegistry())
  {
    const std::string name = info.name;
    if (!cellArray(mesh, (name + "_before").c_str()))
    {
      continue;
    }
    for (const std::string& array : { name, name + "_after" })
    {
      if (cellArray(mesh, array.c_str()))
      {
        lists.push_back({ info.label, array, {},
          info.direction == Direction::LargerIsBetter ? Ranking::Smallest : Ranking::Largest });
        break;
      }
    }
  }
}

} // anonymous namespace

//------------------------------------------------------------------------------
bool WorstElementList::largestIsWorst() const
{
  constexpr const char* after = "_after"; // of Compare Meshes
  const std::string metric = this->array.substr(0, this->array.rfind(after));
  const MetricInfo* info = findMetric(metric);
  return info ? info->direction != Direction::LargerIsBetter : this->array != "Validity";
}

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
  const auto remaining = fetchOutput(source, "Remaining");
  if (auto* table = vtkTable::SafeDownCast(remaining))
  {
    lists.push_back(remainingOf(table));
  }
  if (cellArray(mesh, ObstacleArray))
  {
    lists.push_back(obstaclesOf(mesh));
  }
  // Other filters pass through the array of their input, which is out of date.
  const std::string filter = source->getProxy()->GetXMLName();
  vtkPVArrayInformation* validity = cellArray(mesh, "Validity");
  if ((filter == "MeshOptimizer" || filter == "MeshWarp") && validity &&
    validity->GetComponentRange(0)[0] < Valid)
  {
    lists.push_back({ "Invalid elements", "Validity", {}, Ranking::Invalid });
  }
  addMetrics(mesh, lists);
  const auto add = [&](const char* array, const char* label, Ranking ranking)
  {
    if (cellArray(mesh, array))
    {
      lists.push_back({ label, array, {}, ranking });
    }
  };
  if (filter == "MeshImprover")
  {
    add("min_angle", "Smallest angle", Ranking::Smallest);
    add("imr", "Inverse mean ratio", Ranking::Largest);
  }
  else if (filter == "MeshWarp")
  {
    add("TMP shape", "Change of shape", Ranking::Largest);
  }
  add("Share", "Share of the largest eigenvalue", Ranking::Largest);
  add("Excess", "Excess", Ranking::Largest);
  return lists;
}

//------------------------------------------------------------------------------
void completeList(pqPipelineSource* source, WorstElementList& list)
{
  pqOutputPort* mesh = source->getOutputPort(0);
  if (list.ranking == Ranking::Complete || !cellArray(mesh, list.array.c_str()))
  {
    return;
  }
  list.ranking == Ranking::Invalid ? addInvalid(mesh, list) : addExtreme(mesh, list);
  list.ranking = Ranking::Complete;
}

} // namespace tautline
