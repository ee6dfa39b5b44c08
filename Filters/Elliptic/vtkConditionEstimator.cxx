// SPDX-License-Identifier: BSD-3-Clause
#include "vtkConditionEstimator.h"

#include "EllipticInput.h"
#include "EllipticOutput.h"
#include "TableRows.h"

#include "tautline/Elliptic/ElementContributions.h"
#include "tautline/Solvers/ConditionEstimate.h"

#include "vtkCellData.h"
#include "vtkDataSet.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkTable.h"

#include <algorithm>
#include <limits>
#include <sstream>

vtkStandardNewMacro(vtkConditionEstimator);

namespace
{
constexpr int SpectrumPort = 1;
constexpr int ListedElements = 5;
constexpr double NamedFraction = 0.9; ///< fraction of the eigenvalue in the report
constexpr int Digits = 4;             ///< of numbers in sentences
constexpr double Unknown = -1.0;      ///< an error bound

double knownOr(double bound)
{
  return std::isfinite(bound) ? bound : Unknown;
}

/// An element that contributes.
struct Contribution
{
  double share, process, cell, eigenvalue;
  tautline::Vec3 center;

  void append(std::vector<double>& numbers) const
  {
    numbers.insert(numbers.end(),
      { this->share, this->process, this->cell, this->eigenvalue, this->center[0], this->center[1],
        this->center[2] });
  }
  static Contribution from(const double* numbers)
  {
    return { numbers[0], numbers[1], numbers[2], numbers[3],
      { numbers[4], numbers[5], numbers[6] } };
  }
  static constexpr std::size_t Size = 7;
};

/// The elements with the largest shares on all processes; without shares, with the largest
/// eigenvalues.
std::vector<Contribution> largest(const tautline::ElementContributions& elements,
  const tautline::Mesh& mesh, tautline::RankGroup& processes)
{
  const std::vector<double>& by =
    elements.share.empty() ? elements.largestEigenvalue : elements.share;
  std::vector<std::pair<tautline::Index, tautline::CellType>> cells;
  for (const tautline::CellBlock& block : mesh.blocks())
  {
    for (tautline::Index i = 0; i < block.count; ++i)
    {
      if (std::isfinite(by[block.cell(i)]))
      {
        cells.emplace_back(block.cell(i), block.type);
      }
    }
  }
  const auto count = std::min<std::size_t>(cells.size(), ListedElements);
  std::partial_sort(cells.begin(), cells.begin() + static_cast<std::ptrdiff_t>(count), cells.end(),
    [&](const auto& a, const auto& b)
    { return by[a.first] > by[b.first] || (by[a.first] == by[b.first] && a.first < b.first); });
  std::vector<double> numbers;
  for (std::size_t i = 0; i < count; ++i)
  {
    const auto [cell, type] = cells[i];
    Contribution{ by[cell], static_cast<double>(processes.rank()), static_cast<double>(cell),
      elements.largestEigenvalue[cell], mesh.center(cell, type) }
      .append(numbers);
  }
  numbers = processes.gatherJoined(numbers);
  std::vector<Contribution> all;
  for (std::size_t i = 0; i + Contribution::Size <= numbers.size(); i += Contribution::Size)
  {
    all.push_back(Contribution::from(numbers.data() + i));
  }
  std::stable_sort(all.begin(), all.end(),
    [](const Contribution& a, const Contribution& b) { return a.share > b.share; });
  // Not resize(), for which GCC 16 gives a false warning.
  all.erase(all.begin() + std::min<std::ptrdiff_t>(all.size(), ListedElements), all.end());
  return all;
}

/// The values of cells that count; NaN for ghosts.
std::vector<double> ofOwn(std::vector<double> values, const unsigned char* skip)
{
  for (std::size_t cell = 0; skip && cell < values.size(); ++cell)
  {
    values[cell] = skip[cell] ? std::numeric_limits<double>::quiet_NaN() : values[cell];
  }
  return values;
}

/// log10 of each positive value over the geometric mean of all counted values on all processes; NaN
/// for other values.
std::vector<double> excess(
  const std::vector<double>& values, const std::vector<double>& own, tautline::RankGroup& processes)
{
  double sum = 0.0, count = 0.0;
  for (double value : own)
  {
    const bool counts = value > 0;
    sum += counts ? std::log10(value) : 0.0;
    count += counts;
  }
  const double mean = processes.sum(sum) / std::max(processes.sum(count), 1.0);
  std::vector<double> result;
  for (double value : values)
  {
    result.push_back(
      value > 0 ? std::log10(value) - mean : std::numeric_limits<double>::quiet_NaN());
  }
  return result;
}

/// The number of elements on all processes, and the smallest number that have 90 % of the
/// eigenvalue together.
std::array<tautline::Index, 2> concentration(
  const std::vector<double>& shares, tautline::RankGroup& processes)
{
  const auto above = [&](double threshold, double& sum)
  {
    tautline::Index count = 0;
    sum = 0.0;
    for (double share : shares)
    {
      const bool counts = std::isfinite(share) && share >= threshold;
      count += counts;
      sum += counts ? share : 0.0;
    }
    sum = processes.sum(sum);
    return processes.sum(count);
  };
  // The highest threshold above which the shares add up to this fraction, by bisection.
  constexpr int steps = 50;
  double low = 0.0, high = 1.0, sum = 0.0;
  const tautline::Index all = above(low, sum);
  for (int step = 0; step < steps; ++step)
  {
    const double middle = 0.5 * (low + high);
    above(middle, sum);
    (sum >= NamedFraction ? low : high) = middle;
  }
  return { all, above(low, sum) };
}
}

//------------------------------------------------------------------------------
vtkConditionEstimator::vtkConditionEstimator() = default;

//------------------------------------------------------------------------------
vtkConditionEstimator::~vtkConditionEstimator() = default;

//------------------------------------------------------------------------------
vtkTable* vtkConditionEstimator::GetSpectrum()
{
  return this->GetOutputTable(SpectrumPort);
}

//------------------------------------------------------------------------------
void vtkConditionEstimator::Reset()
{
  this->Condition = this->PreconditionedCondition = 0.0;
}

//------------------------------------------------------------------------------
double vtkConditionEstimator::Estimate(const tautline::EllipticInput& input, int preconditioner,
  const tautline::LocalMesh& mesh, tautline::TableRows& table, std::string& text)
{
  constexpr auto none = static_cast<int>(tautline::Preconditioner::None);
  const bool plain = preconditioner == none;
  tautline::ConditionOptions options;
  options.method = static_cast<tautline::SpectrumMethod>(this->Method);
  options.preconditioner = static_cast<tautline::Preconditioner>(preconditioner);
  options.omega = this->Omega;
  options.tolerance = this->Tolerance;
  options.maximumIterations = this->MaximumIterations;
  options.maximumSeconds = this->GetRemainingSeconds();
  options.petscOptions = this->PETScOptions;
  const double share = this->Preconditioner == none ? 1.0 : 0.5;
  options.progress = [&](double fraction)
  { return this->Report(mesh, share * fraction + (plain ? 0.0 : share)); };
  options.cancelled = this->Cancelled();
  const tautline::ConditionEstimate found =
    tautline::estimateCondition(input.system().linearSystem(), options);

  const std::string name =
    plain ? "A" : std::string("P^-1 A (") + tautline::nameOf(options.preconditioner) + ")";
  table.begin(mesh.name);
  table.addText("Matrix", name);
  table.add("Smallest", found.smallest);
  table.add("Largest", found.largest);
  table.add("Condition", found.condition);
  table.add("SmallestError", knownOr(found.smallestError));
  table.add("LargestError", knownOr(found.largestError));
  table.add("Converged", found.converged);
  table.add("Iterations", found.iterations);
  table.add("Seconds", found.seconds);
  table.addText("Method", found.method);
  table.addText("Message", found.message);

  std::ostringstream sentence;
  sentence.precision(Digits);
  if (found.condition > 0)
  {
    sentence << "Condition number of " << name << ": " << found.condition << ", eigenvalues from "
             << found.smallest << " to " << found.largest << " (" << found.method << ").";
  }
  else
  {
    sentence << "The condition number of " << name << " was not found.";
  }
  sentence << (found.message.empty() ? "" : " ") << found.message;
  text += (text.empty() ? "" : "\n") + sentence.str();
  if (!found.converged && (this->Method != RITZ_VALUES || found.condition <= 0))
  {
    this->Warn();
  }
  return found.condition;
}

//------------------------------------------------------------------------------
void vtkConditionEstimator::Compute(const tautline::EllipticInput& input, tautline::LocalMesh& mesh,
  tautline::RankGroup& processes, tautline::TableRows& table)
{
  constexpr auto none = static_cast<int>(tautline::Preconditioner::None);
  const tautline::EllipticSystem& system = input.system();
  std::string found;
  this->Condition = std::max(this->Condition, this->Estimate(input, none, mesh, table, found));
  if (this->Preconditioner != none)
  {
    this->PreconditionedCondition = std::max(this->PreconditionedCondition,
      this->Estimate(input, this->Preconditioner, mesh, table, found));
  }

  tautline::ConditionOptions limits;
  limits.maximumSeconds = this->GetRemainingSeconds();
  limits.cancelled = this->Cancelled();
  tautline::ElementContributions elements =
    tautline::elementContributions(system, this->ComputeShares, this->Threads, limits);
  // A process without elements has none; all processes take the same branch.
  const bool shares = processes.maximum(static_cast<tautline::Index>(elements.share.size())) > 0;
  elements.largestEigenvalue = input.cellsOfPiece(elements.largestEigenvalue);
  if (shares)
  {
    elements.share = input.cellsOfPiece(elements.share);
  }
  tautline::ElementContributions own = elements;
  own.largestEigenvalue = ofOwn(elements.largestEigenvalue, input.skipped());
  own.share = ofOwn(elements.share, input.skipped());
  mesh.output->GetPointData()->SetActiveScalars(nullptr);
  tautline::addArray(mesh.output, true, "LargestEigenvalue", elements.largestEigenvalue, 1);
  std::ostringstream text;
  text.precision(Digits);
  text << found << "\n"
       << system.unknowns() << " unknowns. The largest eigenvalue of A is between "
       << elements.lowerBound << " and " << elements.bound
       << " by the eigenvalues of the elements.";
  if (shares)
  {
    tautline::addArray(mesh.output, true, "Share", elements.share, 1);
    const auto [all, few] = concentration(own.share, processes);
    text << "\n"
         << few << " of " << all << " elements have " << 100 * NamedFraction
         << " % of the largest eigenvalue.";
  }
  else if (this->ComputeShares)
  {
    text << "\nThe shares of the elements are missing because the time limit was reached.";
    this->Warn();
  }
  tautline::addArray(mesh.output, true, "Excess",
    excess(elements.largestEigenvalue, own.largestEigenvalue, processes), 1);
  for (const Contribution& element : largest(own, input.piece(), processes))
  {
    text << "\nElement " << element.cell;
    if (processes.size() > 1)
    {
      text << " of process " << element.process;
    }
    text << " at (" << element.center[0] << ", " << element.center[1] << ", " << element.center[2]
         << "): ";
    if (shares)
    {
      text << "share " << 100 * element.share << " %, ";
    }
    text << "largest eigenvalue " << element.eigenvalue << ".";
  }
  this->Describe(mesh, text.str());
}

//------------------------------------------------------------------------------
void vtkConditionEstimator::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Method: " << this->Method << "\n";
  os << indent << "Preconditioner: " << this->Preconditioner << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "MaximumIterations: " << this->MaximumIterations << "\n";
  os << indent << "ComputeShares: " << this->ComputeShares << "\n";
}
