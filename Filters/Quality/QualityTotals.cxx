// SPDX-License-Identifier: BSD-3-Clause
#include "QualityTotals.h"

#include "tautline/Quality/ElementChecks.h"

#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"
#include "vtkTable.h"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <iterator>
#include <limits>
#include <sstream>

namespace tautline
{
namespace
{
/// The number of worst elements of each metric in the summary.
constexpr std::size_t ListedInSummary = 3;
}

//------------------------------------------------------------------------------
QualityTotals::QualityTotals(const std::vector<Metric>& metrics)
  : Metrics(metrics)
  , Results(metrics.size())
{
}

//------------------------------------------------------------------------------
void QualityTotals::addBlock(const Mesh& mesh, const signed char* validity,
  const unsigned char* skip, const BlockPlace& place, int threads)
{
  this->Place = place;
  this->Places = nullptr;
  this->CellsBefore += this->CellsOfLast;
  this->CellsOfLast = mesh.view().numberOfCells;
  const ValidityCounts counts = countValidity(validity, skip, mesh.view().numberOfCells);
  this->Counts.valid += counts.valid;
  this->Counts.inverted += counts.inverted;
  this->Counts.degenerate += counts.degenerate;
  this->Counts.notMeasured += counts.notMeasured;
  this->Counts.nonFinite += counts.nonFinite;
  this->Dimension = mesh.dimension() == Dimension::Volume ? 3 : this->Dimension;
  const auto angles = angleDistribution(mesh, validity, skip, threads);
  std::transform(
    angles.begin(), angles.end(), this->Angles.begin(), this->Angles.begin(), std::plus<Index>());
}

//------------------------------------------------------------------------------
void QualityTotals::addCurved(const MissedCells& missed, const double* places)
{
  this->Missed.curved += missed.curved;
  this->Missed.invalid += missed.invalid;
  this->Missed.atCorners += missed.atCorners;
  this->Missed.atIntegrationPoints += missed.atIntegrationPoints;
  this->Places = places;
}

//------------------------------------------------------------------------------
void QualityTotals::setChecks(const std::vector<int>& checks)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (int check : checks)
  {
    this->Checks[check] = { infinity, -infinity };
  }
}

//------------------------------------------------------------------------------
std::vector<int> QualityTotals::checks() const
{
  std::vector<int> checks;
  for (const auto& [check, range] : this->Checks)
  {
    checks.push_back(check);
  }
  return checks;
}

//------------------------------------------------------------------------------
void QualityTotals::addCheck(int check, const signed char* validity, const unsigned char* skip,
  const double* values, Index cells)
{
  CheckRange& range = this->Checks.at(check);
  for (Index cell = 0; cell < cells; ++cell)
  {
    const bool counts =
      !(skip && skip[cell]) && validity[cell] != NotMeasured && validity[cell] != NonFinite;
    range.least = counts ? std::min(range.least, values[cell]) : range.least;
    range.most = counts ? std::max(range.most, values[cell]) : range.most;
  }
}

//------------------------------------------------------------------------------
void QualityTotals::addValues(
  std::size_t m, const Mesh& mesh, const CellValues& data, vtkDataArray* globalIds)
{
  const MetricInfo& info = metricInfo(this->Metrics[m]);
  std::vector<double> measured = measuredValues(info, data);
  auto& all = this->Results[m].measured;
  if (all.empty())
  {
    all = std::move(measured);
  }
  else
  {
    // Not insert(): GCC 14 warns of an overflow that cannot occur.
    const std::size_t first = all.size();
    all.resize(first + measured.size());
    std::copy(measured.begin(), measured.end(), all.data() + first);
  }
  this->HasGlobalIds = globalIds != nullptr;
  std::vector<Worst> worst;
  for (const WorstElement& element : worstElements(info, data))
  {
    const CellType type = cornerType(data.cellTypes[element.cell]);
    const double* place = this->Places ? this->Places + 3 * element.cell : nullptr;
    Worst entry = { element,
      place ? Vec3{ place[0], place[1], place[2] } : mesh.center(element.cell, type),
      globalIds != nullptr, element.cell, this->Place, 0 };
    entry.element.cell = globalIds ? static_cast<Index>(globalIds->GetComponent(element.cell, 0))
                                   : this->CellsBefore + element.cell;
    worst.push_back(entry);
  }
  this->mergeWorst(m, std::move(worst));
}

//------------------------------------------------------------------------------
void QualityTotals::mergeWorst(std::size_t m, std::vector<Worst> more)
{
  const MetricInfo& info = metricInfo(this->Metrics[m]);
  auto& worst = this->Results[m].worst;
  worst.insert(worst.end(), more.begin(), more.end());
  std::sort(worst.begin(), worst.end(),
    [&](const Worst& a, const Worst& b) { return isWorse(info, a.element, b.element); });
  if (worst.size() > static_cast<std::size_t>(WorstCount))
  {
    worst.resize(WorstCount);
  }
}

//------------------------------------------------------------------------------
void QualityTotals::gather(vtkMultiProcessController* controller)
{
  if (!controller || controller->GetNumberOfProcesses() < 2)
  {
    return;
  }
  const bool root = controller->GetLocalProcessId() == 0;

  // Sums of counts; the dimension is the largest.
  std::vector<vtkIdType> mine = { this->Counts.valid, this->Counts.inverted,
    this->Counts.degenerate, this->Counts.notMeasured, this->Counts.nonFinite, this->Missed.curved,
    this->Missed.invalid, this->Missed.atCorners, this->Missed.atIntegrationPoints };
  mine.insert(mine.end(), this->Angles.begin(), this->Angles.end());
  std::vector<vtkIdType> sums(mine.size());
  controller->AllReduce(
    mine.data(), sums.data(), static_cast<vtkIdType>(mine.size()), vtkCommunicator::SUM_OP);
  this->Counts = { sums[0], sums[1], sums[2], sums[3], sums[4] };
  this->Missed = { sums[5], sums[6], sums[7], sums[8] };
  std::copy(sums.begin() + 9, sums.end(), this->Angles.begin());
  for (auto& [check, range] : this->Checks)
  {
    const CheckRange own = range;
    controller->AllReduce(&own.least, &range.least, 1, vtkCommunicator::MIN_OP);
    controller->AllReduce(&own.most, &range.most, 1, vtkCommunicator::MAX_OP);
  }
  int dimension = this->Dimension;
  controller->AllReduce(&dimension, &this->Dimension, 1, vtkCommunicator::MAX_OP);

  // Without global ids, numbering continues from rank to rank.
  const vtkIdType cells = this->CellsBefore + this->CellsOfLast;
  std::vector<vtkIdType> perRank(controller->GetNumberOfProcesses());
  controller->AllGather(&cells, perRank.data(), 1);
  vtkIdType before = 0;
  for (int rank = 0; !this->HasGlobalIds && rank < controller->GetLocalProcessId(); ++rank)
  {
    before += perRank[rank];
  }

  // If one process has all cells, numbers need no process.
  this->Processes = static_cast<int>(
    std::count_if(perRank.begin(), perRank.end(), [](vtkIdType n) { return n > 0; }));
  const int process = controller->GetLocalProcessId();
  constexpr int fields = 11; // id, validity, value, center, and location
  for (std::size_t m = 0; m < this->Metrics.size(); ++m)
  {
    vtkNew<vtkDoubleArray> values, allValues, worst, allWorst;
    auto& result = this->Results[m];
    values->SetArray(result.measured.data(), static_cast<vtkIdType>(result.measured.size()), 1);
    for (const Worst& w : result.worst)
    {
      for (double x :
        { static_cast<double>(w.element.cell + before), static_cast<double>(w.element.validity),
          w.element.value, w.center[0], w.center[1], w.center[2], w.isGlobal ? 1.0 : 0.0,
          static_cast<double>(w.cell), static_cast<double>(w.place.block),
          static_cast<double>(w.place.partition), static_cast<double>(process) })
      {
        worst->InsertNextValue(x);
      }
    }
    controller->GatherV(values, allValues, 0);
    controller->GatherV(worst, allWorst, 0);
    result.worst.clear();
    if (!root)
    {
      result.measured.clear();
      continue;
    }
    result.measured.assign(
      allValues->GetPointer(0), allValues->GetPointer(0) + allValues->GetNumberOfValues());
    std::vector<Worst> merged;
    for (vtkIdType i = 0; i + fields <= allWorst->GetNumberOfValues(); i += fields)
    {
      const double* x = allWorst->GetPointer(i);
      merged.push_back({ { static_cast<Index>(x[0]), x[2], static_cast<signed char>(x[1]) },
        { x[3], x[4], x[5] }, x[6] != 0, static_cast<Index>(x[7]),
        { static_cast<unsigned int>(x[8]), static_cast<unsigned int>(x[9]) },
        static_cast<int>(x[10]) });
    }
    this->mergeWorst(m, std::move(merged));
  }
}

namespace
{
/// Adds a column to a table and returns its array.
template <class Array>
Array* addColumn(vtkTable* table, const std::string& name, vtkIdType rows, int components = 1)
{
  vtkNew<Array> column;
  column->SetName(name.c_str());
  column->SetNumberOfComponents(components);
  column->SetNumberOfTuples(rows);
  table->AddColumn(column);
  return column;
}
}

//------------------------------------------------------------------------------
void QualityTotals::tabulate(vtkTable* statistics, int bins, vtkTable* distribution,
  vtkTable* angles, vtkPolyData* worst, vtkTable* histogram)
{
  const auto rows = static_cast<vtkIdType>(this->Metrics.size());
  auto* names = addColumn<vtkStringArray>(statistics, "Metric", rows);
  auto* labels = addColumn<vtkStringArray>(statistics, "Label", rows);
  for (vtkIdType m = 0; m < rows; ++m)
  {
    const MetricInfo& info = metricInfo(this->Metrics[m]);
    names->SetValue(m, info.name);
    labels->SetValue(m, info.label);
    this->Results[m].statistics = summarize(info, this->Dimension, this->Results[m].measured);
  }
  this->fillDistribution(bins, distribution);
  this->fillHistogram(bins, histogram);
  this->fillStatistics(statistics);
  this->fillWorstColumns(statistics);
  this->fillWorstPoints(worst);
  this->fillAngles(angles);
}

//------------------------------------------------------------------------------
void QualityTotals::fillDistribution(int bins, vtkTable* table)
{
  for (std::size_t m = 0; m < this->Metrics.size(); ++m)
  {
    const std::string name = metricInfo(this->Metrics[m]).name;
    const Histogram h = histogram(this->Results[m].measured, bins);
    auto* middle = addColumn<vtkDoubleArray>(table, name + " value", bins);
    auto* count = addColumn<vtkIdTypeArray>(table, name + " count", bins);
    for (int b = 0; b < bins; ++b)
    {
      middle->SetValue(b, 0.5 * h.edges[b] + 0.5 * h.edges[b + 1]);
      count->SetValue(b, h.counts[b]);
    }
  }
}

//------------------------------------------------------------------------------
void QualityTotals::fillHistogram(int bins, vtkTable* table) const
{
  for (std::size_t m = 0; m < this->Metrics.size(); ++m)
  {
    const MetricInfo& info = metricInfo(this->Metrics[m]);
    const std::string name = info.name;
    const auto& result = this->Results[m];
    const AcceptableHistogram h = acceptableHistogram(info, this->Dimension, result.measured, bins);
    const vtkIdType last = bins + 1;
    auto* from = addColumn<vtkDoubleArray>(table, name + " from", last + 1);
    auto* to = addColumn<vtkDoubleArray>(table, name + " to", last + 1);
    auto* count = addColumn<vtkIdTypeArray>(table, name + " count", last + 1);
    const auto row = [&](vtkIdType r, double low, double high, Index n)
    {
      from->SetValue(r, low);
      to->SetValue(r, high);
      count->SetValue(r, n);
    };
    const double low = h.edges.front(), high = h.edges.back();
    // The smallest value may belong to an inverted element, which is then in no row.
    const double smallest = info.inverted == InvertedValue::Negative
      ? std::max(0.0, result.statistics.minimum)
      : result.statistics.minimum;
    row(0, std::min(low, h.below ? smallest : low), low, h.below);
    for (int b = 0; b < bins; ++b)
    {
      row(b + 1, h.edges[b], h.edges[b + 1], h.counts[b]);
    }
    row(last, high, std::max(high, h.above ? result.statistics.maximum : high), h.above);
  }
}

//------------------------------------------------------------------------------
void QualityTotals::fillStatistics(vtkTable* statistics) const
{
  const auto rows = static_cast<vtkIdType>(this->Metrics.size());
  const auto fill = [&](auto* column, auto value)
  {
    for (vtkIdType m = 0; m < rows; ++m)
    {
      column->SetValue(m, value(this->Results[m].statistics, metricInfo(this->Metrics[m])));
    }
  };
  const auto counts = [&](const char* name, auto value)
  { fill(addColumn<vtkIdTypeArray>(statistics, name, rows), value); };
  const auto reals = [&](const char* name, auto value)
  { fill(addColumn<vtkDoubleArray>(statistics, name, rows), value); };
  using S = const MetricStatistics&;
  using I = const MetricInfo&;
  counts("Measured", [](S s, I) { return s.measured; });
  reals("Minimum", [](S s, I) { return s.minimum; });
  reals("Maximum", [](S s, I) { return s.maximum; });
  reals("Mean", [](S s, I) { return s.mean; });
  reals("RMS", [](S s, I) { return s.rms; });
  reals("StandardDeviation", [](S s, I) { return s.standardDeviation; });
  for (std::size_t q = 0; q < quantileFractions.size(); ++q)
  {
    char name[16];
    std::snprintf(name, sizeof(name), "Quantile%02d",
      static_cast<int>(std::lround(100 * quantileFractions[q])));
    reals(name, [q](S s, I) { return s.quantiles[q]; });
  }
  auto* worst = addColumn<vtkDoubleArray>(statistics, "Worst", rows);
  for (vtkIdType m = 0; m < rows; ++m)
  {
    const PerMetric& result = this->Results[m];
    std::vector<WorstElement> elements;
    std::transform(result.worst.begin(), result.worst.end(), std::back_inserter(elements),
      [](const Worst& w) { return w.element; });
    worst->SetValue(m, worstValue(metricInfo(this->Metrics[m]), result.statistics, elements));
  }
  const int dimension = this->Dimension;
  counts("OutsideAcceptable", [](S s, I) { return s.outsideAcceptable; });
  reals("AcceptableLow", [=](S, I i) { return i.acceptable(dimension).low; });
  reals("AcceptableHigh", [=](S, I i) { return i.acceptable(dimension).high; });
  counts("Inverted", [this](S, I) { return this->Counts.inverted; });
  counts("Degenerate", [this](S, I) { return this->Counts.degenerate; });
  counts("NotMeasured", [this](S, I) { return this->Counts.notMeasured; });
  counts("NonFinite", [this](S, I) { return this->Counts.nonFinite; });
  counts("Curved", [this](S, I) { return this->Missed.curved; });
  counts("MissedAtCorners", [this](S, I) { return this->Missed.atCorners; });
  counts("MissedAtIntegrationPoints", [this](S, I) { return this->Missed.atIntegrationPoints; });
}

//------------------------------------------------------------------------------
void QualityTotals::fillWorstColumns(vtkTable* statistics) const
{
  const auto rows = static_cast<vtkIdType>(this->Metrics.size());
  auto* cells = addColumn<vtkIdTypeArray>(statistics, "WorstCells", rows, WorstCount);
  auto* positions = addColumn<vtkDoubleArray>(statistics, "WorstPositions", rows, 3 * WorstCount);
  cells->Fill(-1);
  positions->Fill(0);
  for (vtkIdType m = 0; m < rows; ++m)
  {
    const auto& list = this->Results[m].worst;
    for (std::size_t i = 0; i < list.size(); ++i)
    {
      cells->SetTypedComponent(m, static_cast<int>(i), list[i].element.cell);
      for (int c = 0; c < 3; ++c)
      {
        positions->SetTypedComponent(m, static_cast<int>(3 * i) + c, list[i].center[c]);
      }
    }
  }
}

//------------------------------------------------------------------------------
void QualityTotals::fillWorstPoints(vtkPolyData* output) const
{
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> vertices;
  vtkNew<vtkIntArray> metric, rank, validity, process, block, partition;
  vtkNew<vtkIdTypeArray> id, cell;
  vtkNew<vtkDoubleArray> value;
  for (std::size_t m = 0; m < this->Metrics.size(); ++m)
  {
    const auto& list = this->Results[m].worst;
    for (std::size_t i = 0; i < list.size(); ++i)
    {
      const Worst& w = list[i];
      const vtkIdType point = points->InsertNextPoint(w.center.data());
      vertices->InsertNextCell(1, &point);
      metric->InsertNextValue(static_cast<int>(this->Metrics[m]));
      rank->InsertNextValue(static_cast<int>(i) + 1);
      id->InsertNextValue(w.element.cell);
      value->InsertNextValue(w.element.value);
      validity->InsertNextValue(w.element.validity);
      process->InsertNextValue(w.process);
      block->InsertNextValue(static_cast<int>(w.place.block));
      partition->InsertNextValue(static_cast<int>(w.place.partition));
      cell->InsertNextValue(w.cell);
    }
  }
  output->SetPoints(points);
  output->SetVerts(vertices);
  const auto addArray = [output](vtkDataArray* array, const char* name)
  {
    array->SetName(name);
    output->GetPointData()->AddArray(array);
  };
  addArray(metric, "Metric");
  addArray(rank, "Rank");
  addArray(id, "CellId");
  addArray(value, "Value");
  addArray(validity, "Validity");
  addArray(process, "Process");
  addArray(block, "Block");
  addArray(partition, "Partition");
  addArray(cell, "Cell");
}

//------------------------------------------------------------------------------
void QualityTotals::fillAngles(vtkTable* angles) const
{
  const vtkIdType angleRows = static_cast<vtkIdType>(this->Angles.size());
  auto* from = addColumn<vtkDoubleArray>(angles, "From", angleRows);
  auto* to = addColumn<vtkDoubleArray>(angles, "To", angleRows);
  auto* count = addColumn<vtkIdTypeArray>(angles, "Count", angleRows);
  auto* percent = addColumn<vtkDoubleArray>(angles, "Percent", angleRows);
  Index total = 0;
  for (Index n : this->Angles)
  {
    total += n;
  }
  for (vtkIdType b = 0; b < angleRows; ++b)
  {
    from->SetValue(b, angleBins[b]);
    to->SetValue(b, angleBins[b + 1]);
    count->SetValue(b, this->Angles[b]);
    percent->SetValue(b, total > 0 ? 100.0 * this->Angles[b] / total : 0.0);
  }
}

//------------------------------------------------------------------------------
/// "element 17 of block 2 of process 1", "element with global id 5".
std::string QualityTotals::nameOf(const Worst& worst) const
{
  if (worst.isGlobal)
  {
    return "element with global id " + std::to_string(worst.element.cell);
  }
  const std::string place = worst.place.name();
  return "element " + std::to_string(worst.cell) + (place.empty() ? "" : " of ") + place +
    (this->Processes > 1 ? " of process " + std::to_string(worst.process) : "");
}

//------------------------------------------------------------------------------
std::string QualityTotals::summary() const
{
  std::ostringstream text;
  const ValidityCounts& n = this->Counts;
  text << n.valid << " valid elements, " << n.inverted << " inverted, " << n.degenerate
       << " degenerate.";
  if (n.notMeasured + n.nonFinite > 0)
  {
    text << " " << n.notMeasured << " not measured, " << n.nonFinite << " not finite.";
  }
  if (this->Missed.invalid > 0)
  {
    text << " " << this->Missed.invalid
         << " curved cells are not valid; the determinant is positive at all corners of "
         << this->Missed.atCorners << " of them and at all integration points of "
         << this->Missed.atIntegrationPoints << ".";
  }
  for (std::size_t m = 0; m < this->Metrics.size(); ++m)
  {
    const MetricInfo& info = metricInfo(this->Metrics[m]);
    const MetricStatistics& s = this->Results[m].statistics;
    if (s.measured > 0)
    {
      text << "\n"
           << info.label << ": " << s.minimum << " to " << s.maximum << ", mean " << s.mean << "; "
           << s.outsideAcceptable << " of " << s.measured << " outside the acceptable range.";
    }
    const auto& worst = this->Results[m].worst;
    const std::size_t listed = std::min(worst.size(), ListedInSummary);
    for (std::size_t i = 0; i < listed; ++i)
    {
      text << (i == 0 ? "\nWorst: " : ", ") << this->nameOf(worst[i]) << " ("
           << worst[i].element.value << ")" << (i + 1 == listed ? "." : "");
    }
  }
  for (const auto& [check, range] : this->Checks)
  {
    const ElementCheckInfo& info = elementChecks()[check];
    if (range.least <= range.most)
    {
      text << "\n" << info.label << ": " << range.least << " to " << range.most << ".";
    }
  }
  return text.str();
}

//------------------------------------------------------------------------------
std::size_t QualityTotals::bytes() const
{
  std::size_t sum = 0;
  for (const PerMetric& result : this->Results)
  {
    sum += result.measured.capacity() * sizeof(double);
  }
  return sum;
}
}
