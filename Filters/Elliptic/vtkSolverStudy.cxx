// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSolverStudy.h"

#include "EllipticInput.h"
#include "EllipticOutput.h"
#include "TableRows.h"

#include "tautline/Elliptic/SolverStudy.h"

#include "vtkObjectFactory.h"
#include "vtkTable.h"

#include <algorithm>
#include <numeric>
#include <sstream>

vtkStandardNewMacro(vtkSolverStudy);

namespace
{
constexpr int StudyPort = 1;
constexpr int WithModes = 24,
              WithoutModes = 25;        // numbers of combinations, by the input of multigrid
constexpr const char* FailedMark = "*"; // as in Tables 2.8 to 2.12
constexpr const char* NotRunMark = "-";

/// All combinations; number 1 comes first.
const std::vector<tautline::SolverCombination>& allCombinations()
{
  using tautline::KrylovMethod;
  using tautline::Preconditioner;
  static const std::vector<tautline::SolverCombination> all = []()
  {
    std::vector<tautline::SolverCombination> list = tautline::dissertationCombinations();
    list.push_back({ KrylovMethod::Direct, Preconditioner::None, true });
    list.push_back({ KrylovMethod::ConjugateGradient, Preconditioner::ICC, true });
    list.push_back({ KrylovMethod::ConjugateGradient, Preconditioner::GAMG, true });
    list.push_back({ KrylovMethod::GMRES, Preconditioner::GAMG, true });
    list.push_back({ KrylovMethod::MINRES, Preconditioner::GAMG, true });
    list.push_back({ KrylovMethod::BiCGStab, Preconditioner::GAMG, true });
    list.push_back({ KrylovMethod::ConjugateGradient, Preconditioner::None, true });
    list.push_back({ KrylovMethod::ConjugateGradient, Preconditioner::BoomerAMG, true });
    list.push_back({ KrylovMethod::ConjugateGradient, Preconditioner::GAMG, false });
    return list;
  }();
  return all;
}

/// The rank of each row, from 1, by time; rows that did not converge come last.
std::vector<int> ranksOf(const std::vector<tautline::SolverStudyRow>& rows)
{
  const auto fails = [&](int i) { return !rows[i].run || !converged(rows[i].linear.reason); };
  std::vector<int> order(rows.size()), ranks(rows.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
    [&](int a, int b)
    { return fails(a) != fails(b) ? fails(b) : !fails(a) && rows[a].seconds < rows[b].seconds; });
  for (std::size_t place = 0; place < order.size(); ++place)
  {
    ranks[order[place]] = static_cast<int>(place) + 1;
  }
  return ranks;
}

std::string secondsText(double seconds)
{
  std::ostringstream text;
  text.precision(3);
  text << seconds << " s";
  return text.str();
}
}

//------------------------------------------------------------------------------
vtkSolverStudy::vtkSolverStudy() = default;

//------------------------------------------------------------------------------
vtkSolverStudy::~vtkSolverStudy() = default;

//------------------------------------------------------------------------------
vtkTable* vtkSolverStudy::GetStudy()
{
  return this->GetOutputTable(StudyPort);
}

//------------------------------------------------------------------------------
const char* vtkSolverStudy::GetCombinationName(int number)
{
  static const std::vector<std::string> names = []()
  {
    std::vector<std::string> list;
    for (const tautline::SolverCombination& combination : allCombinations())
    {
      list.push_back(tautline::nameOf(combination));
    }
    list[WithModes - 1] += ", rigid body modes";
    list[WithoutModes - 1] += ", no rigid body modes";
    return list;
  }();
  return number >= 1 && number <= static_cast<int>(names.size()) ? names[number - 1].c_str() : "";
}

//------------------------------------------------------------------------------
void vtkSolverStudy::AddCombination(int number)
{
  if (number < 1 || number > GetNumberOfCombinations())
  {
    vtkErrorMacro("There is no combination " << number << "; there are 1 to "
                                             << GetNumberOfCombinations() << ".");
    return;
  }
  auto& list = this->Combinations;
  if (std::find(list.begin(), list.end(), number) == list.end())
  {
    list.push_back(number);
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkSolverStudy::ClearCombinations()
{
  if (!this->Combinations.empty())
  {
    this->Combinations.clear();
    this->Modified();
  }
}

//------------------------------------------------------------------------------
void vtkSolverStudy::Reset()
{
  this->Recommended.clear();
  this->Why.clear();
}

//------------------------------------------------------------------------------
void vtkSolverStudy::Compute(const tautline::EllipticInput& input, tautline::LocalMesh& mesh,
  tautline::RankGroup&, tautline::TableRows& table)
{
  std::vector<int> numbers = this->Combinations;
  if (numbers.empty())
  {
    numbers.resize(tautline::dissertationCombinations().size());
    std::iota(numbers.begin(), numbers.end(), 1);
  }
  tautline::SolverStudyOptions options;
  options.combinations.clear();
  for (int number : numbers)
  {
    options.combinations.push_back(allCombinations()[number - 1]);
  }
  this->SetCommonOptions(options.solver);
  options.solver.maximumSeconds = this->CombinationTimeLimit;
  options.conditions = this->EstimateConditions;
  options.repetitions = this->Repetitions;
  options.maximumSeconds = this->GetRemainingSeconds();
  options.solver.cancelled = this->Cancelled();
  options.progress = [&](double fraction) { return this->Report(mesh, fraction); };
  const tautline::SolverStudy study = tautline::studySolvers(input.system(), options);

  const std::vector<int> ranks = ranksOf(study.rows);
  tautline::Index failed = 0, skipped = 0;
  for (std::size_t i = 0; i < study.rows.size(); ++i)
  {
    const tautline::SolverStudyRow& row = study.rows[i];
    const bool converged = row.run && tautline::converged(row.linear.reason);
    failed += row.run && !converged;
    skipped += !row.run;
    table.begin(mesh.name);
    table.addText("Combination", GetCombinationName(numbers[i]));
    table.add("N combination", numbers[i]);
    table.add("N rank", ranks[i]);
    table.add("Total time (s)", converged ? row.seconds : 0.0);
    table.addText("Result",
      converged   ? secondsText(row.seconds)
        : row.run ? FailedMark
                  : NotRunMark);
    table.add("Time set-up (s)", row.linear.setupSeconds);
    table.add("Time solve (s)", row.linear.solveSeconds);
    table.add("Time CPU (s)", row.cpuSeconds);
    table.add("N iterations", row.linear.iterations);
    table.add("N condition", row.condition);
    table.add("N true residual", std::isfinite(row.trueResidual) ? row.trueResidual : 0.0);
    table.add("N converged", converged);
    table.addText("Reason",
      row.run ? tautline::sentence(tautline::describe(row.linear.reason)) +
          (row.linear.message.empty() ? "" : " ") + tautline::sentence(row.linear.message)
              : "There was no time left for it.");
  }
  this->Recommended = study.recommended >= 0 && study.ties == 0
    ? GetCombinationName(numbers[static_cast<std::size_t>(study.recommended)])
    : "";
  this->Why = study.why;
  std::ostringstream text;
  text << (this->Recommended.empty() ? "" : "Recommended: ") << study.why << "\n"
       << input.system().unknowns() << " unknowns; " << study.rows.size() << " combinations";
  if (failed > 0)
  {
    text << ", " << failed << " failed (" << FailedMark << ")";
  }
  if (skipped > 0)
  {
    text << ", " << skipped << " not run (" << NotRunMark << "): there was no time left";
  }
  text << ".";
  this->Describe(mesh, text.str());
  if (study.recommended < 0)
  {
    this->Warn();
  }
}

//------------------------------------------------------------------------------
void vtkSolverStudy::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Combinations:";
  for (int number : this->Combinations)
  {
    os << " " << number;
  }
  os << "\n";
  os << indent << "EstimateConditions: " << this->EstimateConditions << "\n";
  os << indent << "Repetitions: " << this->Repetitions << "\n";
  os << indent << "CombinationTimeLimit: " << this->CombinationTimeLimit << "\n";
  os << indent << "Recommended: " << this->Recommended << "\n";
}
