// SPDX-License-Identifier: BSD-3-Clause
#include "BeforeAfter.h"

#include "Measurement.h"
#include "tautline/Core/Parallel.h"

#include "vtkCellData.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkSignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace tautline
{
namespace
{
/// @param known the values of the metric, or empty @param values filled
Measurement measureMetric(const MovableMesh& movable, const Mesh& mesh, const MeasuredMetric& what,
  const std::vector<double>& known, const signed char* validity, double* values)
{
  const MetricInfo& info = metricInfo(what.metric);
  const Index cells = mesh.view().numberOfCells;
  if (!known.empty())
  {
    std::copy(known.begin(), known.end(), values);
  }
  else if (cells > 0)
  {
    evaluateMetric(mesh, what.metric, what.options, values);
  }
  const double unit = movable.frame().unit();
  const int power = info.lengthPower(movable.dimension());
  for (Index i = 0; i < cells && unit != 1 && power != 0; ++i)
  {
    values[i] *= std::pow(unit, power);
  }
  return measureValues(movable.ranks(), mesh.view(), movable.dimension(), what.metric, validity,
    movable.skipped(), values);
}

vtkSmartPointer<vtkDoubleArray> addCellArray(vtkDataSet* output, const std::string& name)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(name.c_str());
  array->SetNumberOfValues(output->GetNumberOfCells());
  output->GetCellData()->AddArray(array);
  return array;
}

void addStatistics(TableRows& rows, const std::string& ending, const Measurement& m)
{
  const MetricStatistics& s = m.statistics;
  rows.add("Minimum" + ending, s.minimum);
  rows.add("Mean" + ending, s.mean);
  rows.add("Maximum" + ending, s.maximum);
  rows.add("RMS" + ending, s.rms);
  rows.add("StandardDeviation" + ending, s.standardDeviation);
  rows.add("Worst" + ending, m.worst);
  rows.add("OutsideAcceptable" + ending, static_cast<double>(s.outsideAcceptable));
  rows.add("Inverted" + ending, static_cast<double>(m.counts.inverted));
  rows.add("Degenerate" + ending, static_cast<double>(m.counts.degenerate));
}
}

namespace
{
/// Mean and worst value before and after, over the compared elements.
void describe(
  const std::string& of, const Measurement& before, const Measurement& after, std::ostream& text)
{
  text << "\n"
       << of << ": mean " << before.statistics.mean << " to " << after.statistics.mean << ", worst "
       << before.worst << " to " << after.worst << ".";
}

/// The same measurement without the elements that are not valid.
Measurement measureValid(
  const MovableMesh& movable, Metric metric, const signed char* validity, const double* values)
{
  const MeshView& view = movable.mesh().view();
  std::vector<unsigned char> skip(view.numberOfCells);
  for (std::size_t i = 0; i < skip.size(); ++i)
  {
    skip[i] = validity[i] != Valid || (movable.skipped() && movable.skipped()[i]);
  }
  return measureValues(
    movable.ranks(), view, movable.dimension(), metric, validity, skip.data(), values);
}

void addRow(const MeasuredMetric& what, const std::string& block, const Measurement& before,
  const Measurement& after, TableRows& rows)
{
  rows.begin(block);
  rows.addText("Metric", what.name);
  rows.addText("Label", metricInfo(what.metric).label);
  addStatistics(rows, "Before", before);
  addStatistics(rows, "After", after);
}
}

//------------------------------------------------------------------------------
std::vector<MeasuredMetric> measuredMetrics(const OptimizeOptions& options, Metric worst)
{
  std::vector<MeasuredMetric> result;
  for (const Objective& objective : options.objectives)
  {
    const auto same = [&objective](const MeasuredMetric& m)
    { return m.metric == objective.metric && m.options.targets == objective.evaluation.targets; };
    if (std::any_of(result.begin(), result.end(), same))
    {
      continue;
    }
    const auto before = std::count_if(result.begin(), result.end(),
      [&objective](const MeasuredMetric& m) { return m.metric == objective.metric; });
    std::string name = metricInfo(objective.metric).name;
    name += before > 0 ? " " + std::to_string(before + 1) : "";
    result.push_back({ name, objective.metric, objective.evaluation });
  }
  if (std::none_of(result.begin(), result.end(),
        [worst](const MeasuredMetric& m) { return m.metric == worst; }))
  {
    result.push_back({ metricInfo(worst).name, worst, {} });
  }
  return result;
}

//------------------------------------------------------------------------------
std::vector<std::string> objectiveNames(const std::vector<Objective>& objectives)
{
  std::vector<std::string> names;
  for (std::size_t i = 0; i < objectives.size(); ++i)
  {
    const auto before = std::count_if(objectives.begin(), objectives.begin() + i,
      [&](const Objective& other) { return other.metric == objectives[i].metric; });
    names.emplace_back(metricInfo(objectives[i].metric).name);
    names.back() += before > 0 ? " " + std::to_string(before + 1) : "";
  }
  return names;
}

//------------------------------------------------------------------------------
std::string addBeforeAfter(const MovableMesh& mesh, const std::vector<double>& points,
  const std::vector<MeasuredMetric>& metrics, const VerifiedElements& known, int threads,
  const std::string& block, vtkDataSet* output, TableRows& rows)
{
  const MeshView& view = mesh.mesh().view();
  std::vector<double> storage;
  const Mesh moved = mesh.placed(points, storage);
  vtkNew<vtkSignedCharArray> validity;
  validity->SetName("Validity");
  validity->SetNumberOfValues(view.numberOfCells);
  if (known.validity.empty())
  {
    moved.classifyCells(validity->GetPointer(0), threads);
  }
  else
  {
    std::copy(known.validity.begin(), known.validity.end(), validity->GetPointer(0));
  }

  const signed char* const validityBefore = mesh.validity().data();
  std::ostringstream text;
  const std::vector<double> unknown;
  for (const MeasuredMetric& what : metrics)
  {
    const bool first = &what == &metrics.front();
    double* const valuesBefore = addCellArray(output, what.name + "_before")->GetPointer(0);
    double* const valuesAfter = addCellArray(output, what.name)->GetPointer(0);
    Measurement before, after;
    const auto measure = [&](Index which)
    {
      which == 0 ? before = measureMetric(mesh, mesh.mesh(), what, first ? known.before : unknown,
                     validityBefore, valuesBefore)
                 : after = measureMetric(mesh, moved, what, first ? known.after : unknown,
                     validity->GetPointer(0), valuesAfter);
    };
    if (mesh.inPieces())
    {
      measure(0);
      measure(1);
    }
    else // concurrently, because much of the work is not divided into chunks
    {
      parallelFor(2, 1, threads, measure);
    }
    addRow(what, block, before, after, rows);
    const std::string label = metricInfo(what.metric).label;
    if (before.counts.inverted + after.counts.inverted == 0)
    {
      describe(label, before, after, text);
      continue;
    }
    // The value of an inverted element is not compared with the value of a valid one.
    before = measureValid(mesh, what.metric, validityBefore, valuesBefore);
    after = measureValid(mesh, what.metric, validity->GetPointer(0), valuesAfter);
    if (before.statistics.measured > 0 && after.statistics.measured > 0)
    {
      describe(label + " of the valid elements", before, after, text);
    }
  }
  output->GetCellData()->AddArray(validity);
  // Without active point scalars, views color by the metric.
  output->GetPointData()->SetActiveScalars(nullptr);
  output->GetCellData()->SetActiveScalars(metrics.front().name.c_str());
  return text.str();
}
}
