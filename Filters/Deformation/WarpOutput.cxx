// SPDX-License-Identifier: BSD-3-Clause
#include "WarpOutput.h"

#include "Measurement.h"
#include "tautline/Quality/Statistics.h"
#include "tautline/Quality/Targets.h"

#include "vtkCellData.h"
#include "vtkDataSet.h"
#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkSignedCharArray.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace tautline
{
namespace
{
constexpr const char* ShapeArray = "TMP shape";
constexpr double Rounding = 1e-13; // smaller values mean the same shape

template <class Array, class Values>
void addCellArray(vtkDataSet* output, const char* name, const Values& values)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfValues(static_cast<vtkIdType>(values.size()));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  output->GetCellData()->AddArray(array);
}

void addHistory(const WarpResult& result, const std::string& block, TableRows& rows)
{
  for (const WarpRecord& record : result.history)
  {
    rows.begin(block);
    rows.add("Amount", record.amount);
    rows.add("Inverted", static_cast<double>(record.inverted));
    rows.add("Worst shape", record.worstShape);
    rows.add("Mean shape", record.meanShape);
    rows.addText("Stage", record.stage);
    rows.add("N iterations", record.iterations);
    rows.add("Time (s)", record.seconds);
  }
}

void addStatistics(const WarpResult& result, const WarpFacts& facts, const WarpQualities& q,
  const std::string& block, TableRows& rows)
{
  rows.begin(block);
  rows.add("Elements", static_cast<double>(q.elements));
  rows.add("Boundary points", static_cast<double>(facts.boundaryPoints));
  rows.add("Moved points", static_cast<double>(facts.movedPoints));
  rows.add("Largest displacement", facts.largestDisplacement);
  rows.add("Amount", facts.amount * result.amount);
  rows.add("Inverted after warp", static_cast<double>(result.invertedWarp));
  rows.add("Inverted", static_cast<double>(q.inverted));
  rows.add("Impossible", static_cast<double>(result.impossible));
  rows.add("Crossings", static_cast<double>(result.crossings));
  rows.add("Worst shape", q.shape.worst);
  rows.add("Mean shape", q.shape.mean);
  rows.add("Worst IMR before", q.before.worst);
  rows.add("Mean IMR before", q.before.mean);
  rows.add("Worst IMR", q.after.worst);
  rows.add("Mean IMR", q.after.mean);
  constexpr std::array<const char*, 6> names = { "Cxx", "Cyy", "Czz", "Cxy", "Cyz", "Cxz" };
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    rows.add(names[i], result.tensor[i]);
  }
  rows.add("Decoupled", static_cast<double>(result.decoupled));
  rows.add("Regularization", result.regularization);
  rows.add("Reused", facts.reused);
  rows.add("Assemble (s)", result.assembleSeconds);
  rows.add("Set-up (s)", result.setupSeconds);
  rows.add("Solve (s)", result.solveSeconds);
  rows.add("Improve (s)", result.improveSeconds);
  rows.add("Total (s)", facts.seconds);
}

std::string describe(const WarpResult& result, const WarpFacts& facts, const WarpQualities& q)
{
  std::ostringstream text;
  text << facts.method << ": ";
  if (q.inverted == 0)
  {
    text << "all " << q.elements << " elements are valid";
  }
  else
  {
    text << q.inverted << " of " << q.elements << " elements are inverted or degenerate";
  }
  if (facts.following > 0)
  {
    text << " in the whole cell; " << facts.following << " nodes of curved cells followed their "
         << "corners" << (q.inverted > 0 ? " (Untangle Mesh also moves these)" : "");
  }
  if (result.invertedWarp > 0 && result.invertedWarp != q.inverted)
  {
    text << "; after the warp itself " << result.invertedWarp << " were not";
  }
  text << ".";
  if (result.impossible > 0)
  {
    text << "\n"
         << result.impossible
         << " of them cannot be valid for any position of the interior: the moved boundary itself "
            "is not valid. This is the best mesh found.";
  }
  text << "\nShape against the mesh at rest: mean " << q.shape.mean << ", worst " << q.shape.worst
       << " (0 is the same).\n"
       << facts.movedPoints << " of " << facts.boundaryPoints << " given points moved, by at most "
       << facts.largestDisplacement << ".";
  if (!facts.motion.empty())
  {
    text << "\nThe target corresponds " << facts.motion << ".";
  }
  if (facts.coefficients)
  {
    text << "\nCoefficients xx yy zz xy yz xz:";
    for (double c : result.tensor)
    {
      text << " " << c;
    }
    text << ".";
  }
  if (result.amount < 1)
  {
    text << "\nIt completed " << 100 * result.amount << " % of the motion.";
  }
  text << std::setprecision(2) << "\nSeconds: assemble " << result.assembleSeconds << ", set-up "
       << result.setupSeconds << ", solve " << result.solveSeconds << ", improve "
       << result.improveSeconds << ", in all " << facts.seconds
       << (facts.reused ? "; the matrices of the previous run were reused." : ".");
  return text.str();
}
/**
 * The shape metric (4.22) of each cell relative to the initial cell as its target. Volumes are
 * measured range by range, because the targets of a cell need nine times the memory of its value.
 * @param values one per cell, filled
 */
void measureSimilarity(
  const Mesh& after, const Mesh& before, int threads, std::vector<double>& values)
{
  const Index cells = after.view().numberOfCells;
  Index solid = 0;
  for (const CellBlock& block : after.blocks())
  {
    solid += topology(block.type).dimension == 3 ? block.count : 0;
  }
  constexpr Index range = Index(1) << 18;
  const Index step = solid == cells ? range : cells; // the plane is common to all cells
  for (Index first = 0; first < cells; first += step)
  {
    const auto partOf = [&](const Mesh& mesh)
    {
      MeshView view = mesh.view();
      view.numberOfCells = std::min(step, cells - first);
      view.cellTypes += first;
      view.offsets += first;
      Mesh part(view, threads);
      part.setMirrored(mesh.mirrored());
      return part;
    };
    const Mesh now = partOf(after);
    const Targets targets = referenceTargets(now, partOf(before));
    EvaluationOptions options;
    options.threads = threads;
    options.targets = &targets;
    evaluateMetric(now, Metric::ShapeSimilarity, options, values.data() + first);
  }
}

/// @param shape values are rounded to 0 in place
void addWarpArrays(
  vtkDataSet* output, std::vector<double>& shape, const std::vector<signed char>& validity)
{
  std::replace_if(
    shape.begin(), shape.end(), [](double value) { return value < Rounding; }, 0.0);
  addCellArray<vtkDoubleArray>(output, ShapeArray, shape);
  addCellArray<vtkSignedCharArray>(output, "Validity", validity);
  // Without active point scalars, views color by the shape.
  output->GetPointData()->SetActiveScalars(nullptr);
  output->GetCellData()->SetActiveScalars(ShapeArray);
}

/// @param notes further sentences; empty ones are left out
void addWarpReport(const WarpResult& result, const WarpFacts& facts, const WarpQualities& q,
  const std::string& block, const std::vector<std::string>& notes, TableRows& history,
  TableRows& statistics, WarpTotals& totals)
{
  addHistory(result, block, history);
  addStatistics(result, facts, q, block, statistics);
  std::ostringstream text;
  text << (totals.summary.empty() ? "" : "\n") << (block.empty() ? "" : "In " + block + ": ")
       << describe(result, facts, q);
  std::vector<std::string> sentences = notes;
  sentences.insert(sentences.begin(), result.message);
  for (const std::string& sentence : sentences)
  {
    text << (sentence.empty() ? "" : "\n") << sentence;
  }
  totals.summary += text.str();
  totals.invertedAfterWarp += result.invertedWarp;
  totals.inverted += q.inverted;
  totals.impossible += result.impossible;
  totals.incomplete |= result.amount < 1;
  totals.worstShape = std::max(totals.worstShape, q.shape.worst);
  totals.reused += facts.reused;
}
}

//------------------------------------------------------------------------------
void addWarpOutput(MovableMesh& rest, WarpResult& result, const WarpFacts& facts,
  const InputBlock& block, TableRows& history, TableRows& statistics, WarpTotals& totals)
{
  const std::string note = rest.move(vtkPointSet::SafeDownCast(block.output), result.points);
  const std::vector<signed char> validity = rest.validityAt(result.points);
  std::vector<double> ofPiece;
  if (rest.inPieces())
  {
    ofPiece = rest.ofPiece(result.points);
    result.points = {};
    rest.releaseDistributed();
  }
  const Mesh& mesh = rest.mesh();
  MeshView view = mesh.view();
  view.points = rest.inPieces() ? ofPiece.data() : result.points.data();
  Mesh moved(view, facts.threads);
  moved.setMirrored(mesh.mirrored());

  WarpQualities q;
  std::vector<double> values(view.numberOfCells);
  EvaluationOptions ideal;
  ideal.threads = facts.threads;
  const auto measureAt = [&](
                           const Mesh& at, const std::vector<signed char>& valid) -> WarpMeasurement
  {
    const Measurement m = measure(rest.ranks(), at, rest.dimension(), Metric::InverseMeanRatio,
      ideal, valid.data(), rest.skipped(), values.data());
    return { m.worst, m.statistics.mean };
  };
  q.before = measureAt(mesh, rest.validity());
  q.after = measureAt(moved, validity);
  measureSimilarity(moved, mesh, facts.threads, values);
  const Measurement shape = measureValues(rest.ranks(), view, rest.dimension(),
    Metric::ShapeSimilarity, validity.data(), rest.skipped(), values.data());
  q.shape = { shape.worst, shape.statistics.mean };
  q.inverted = shape.counts.inverted + shape.counts.degenerate;
  q.elements = q.inverted + shape.counts.valid;
  addWarpArrays(block.output, values, validity);
  addWarpReport(result, facts, q, block.name, { note, rest.notice() }, history, statistics, totals);
}
}
