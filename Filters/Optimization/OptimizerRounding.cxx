// SPDX-License-Identifier: BSD-3-Clause
// The points of a result as they are written.
#include "OptimizerSetup.h"

#include "tautline/Optimization/RoundedResult.h"

namespace tautline
{
namespace
{
/// The consequence of rounding, as the end of a sentence.
std::string describeLoss(const RoundedResult& rounded)
{
  return rounded.lost > 0 ? std::to_string(rounded.lost) + " valid elements would not be valid"
    : rounded.worseWorst  ? "the worst element would be worse than in the input"
                          : "the objective would be larger than in the input";
}

/// The reason why the points are not written in single precision.
std::string describeDouble(const RoundedResult& rounded)
{
  return "The points are given in double precision: in single precision " + describeLoss(rounded) +
    ".";
}

std::vector<signed char> validityOf(const Mesh& mesh, int threads)
{
  std::vector<signed char> validity(mesh.view().numberOfCells);
  mesh.classifyCells(validity.data(), threads);
  return validity;
}

/// Takes over rounded points with the measurements there.
void take(OptimizeResult& result, std::vector<double> points, RoundedResult& rounded)
{
  result.points = std::move(points);
  result.elements = std::move(rounded.elements);
  result.invertedAfter = rounded.inverted;
  if (!result.history.empty() && !rounded.record.objectives.empty())
  {
    IterationRecord& last = result.history.back();
    last.objective = rounded.record.objective;
    last.objectives = std::move(rounded.record.objectives);
    last.mean = std::move(rounded.record.mean);
    last.worst = std::move(rounded.record.worst);
    last.inverted = rounded.inverted;
  }
}
}

//------------------------------------------------------------------------------
RoundedResult OptimizerSetup::measureAt(const std::vector<double>& points,
  const std::vector<signed char>& validity, OptimizeResult& result) const
{
  if (this->TheMesh.inPieces())
  {
    const Mesh local = this->TheMesh.local();
    Mesh there = local.at(points.data());
    there.setSpace(local.space());
    RoundedResult rounded = measureRounded(local, validityOf(local, this->Options.threads),
      this->Options, result, there, this->TheMesh.division());
    rounded.elements = {}; // not for the cells of the input
    return rounded;
  }
  Mesh there = this->Boundary.start().at(points.data());
  there.setSpace(this->Boundary.start().space());
  return measureRounded(this->Boundary.start(), validity, this->Options, result, there);
}

//------------------------------------------------------------------------------
void OptimizerSetup::round(OptimizerRun& run) const
{
  OptimizeResult& result = run.result;
  const MovableMesh& mesh = this->TheMesh;
  const Mesh& start = this->Boundary.start();
  const MeshView& view = start.view();
  std::vector<signed char> validity;
  if (!mesh.inPieces())
  {
    validity = &start == &mesh.mesh() ? mesh.validity() : validityOf(start, this->Options.threads);
  }
  RoundedResult rounded;
  run.note.clear();
  run.warning.clear();
  for (run.single = mesh.isSingle();; run.single = false)
  {
    if (mesh.inPieces() && !run.single)
    {
      return; // in double precision they are as verified
    }
    std::vector<double> points = mesh.rounded(result.points, run.single);
    const bool changed = points != result.points;
    if (!(mesh.inPieces() ? mesh.group().any(changed) : changed))
    {
      return;
    }
    rounded = this->measureAt(points, validity, result);
    // If the input has invalid elements, rounding to double precision may undo some repairs.
    const bool kept = rounded.keepsGuarantees() ||
      (!run.single && result.invertedBefore > 0 && rounded.inverted <= result.invertedBefore);
    if (kept)
    {
      take(result, std::move(points), rounded);
      return;
    }
    if (!run.single)
    {
      break;
    }
    run.note = describeDouble(rounded);
  }
  run.note.clear();
  run.warning = "The points do not move: this far from the origin, coordinates have too few "
                "digits, and after rounding " +
    describeLoss(rounded) + ". Create the mesh near the origin.";
  const double* input = mesh.mesh().view().points;
  result.keepStart(
    std::vector<double>(input, input + 3 * view.numberOfPoints), result.invertedBefore);
  result.untangled = false;
  result.newlyInvalid = 0;
  run.single = mesh.isSingle();
}
}
