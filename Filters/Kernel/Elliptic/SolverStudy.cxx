// SPDX-License-Identifier: BSD-3-Clause
#include "SolverStudy.h"

#include "tautline/Core/Stopwatch.h"
#include "tautline/Quality/Metrics.h"

#include <algorithm>
#include <cstdio>
#include <ctime>

namespace tautline
{
namespace
{
// Differences of times that are not reproducible.
constexpr double noiseFraction = 0.1, noiseSeconds = 1e-3;
constexpr int tableMethods = 4, tablePreconditioners = 4; // of Table 2.5

bool isMultigrid(Preconditioner preconditioner)
{
  return preconditioner == Preconditioner::BoomerAMG || preconditioner == Preconditioner::GAMG;
}

/// CPU seconds of this process.
double processSeconds()
{
  timespec time = {};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  constexpr double nanosecond = 1e-9;
  return static_cast<double>(time.tv_sec) + nanosecond * static_cast<double>(time.tv_nsec);
}

/// A number with three significant digits.
std::string digits(double value)
{
  char text[32];
  std::snprintf(text, sizeof(text), value >= 100 && value < 1e6 ? "%.0f" : "%.3g", value);
  return text;
}

//------------------------------------------------------------------------------
class Study
{
public:
  Study(const EllipticSystem& system, const SolverStudyOptions& options)
    : System(system)
    , Options(options)
  {
  }

  SolverStudy run();

private:
  LinearSystem systemFor(const SolverCombination& combination);
  void checkOptions();
  SolverStudyRow solve(const SolverCombination& combination, std::size_t index);
  LinearSolution solveOnce(const SolverCombination& combination, std::size_t index, bool ritz);
  bool overTime() const;
  bool reportHere(double fraction);
  bool report(double fraction);
  void findConditions();
  void recommend();
  std::string nameIn(const SolverCombination& combination) const;
  std::string outlook(const SolverStudyRow& best) const;
  std::string warnings() const;

  const EllipticSystem& System;
  const SolverStudyOptions& Options;
  Stopwatch Time;
  std::unique_ptr<PointNumbering> Scalars; // numbering of single unknowns, on several ranks
  std::vector<bool> TakesOptions;          // per combination: whether it uses the PETSc options
  double Reported = 0;                     // progress
  SolverStudy Result;
};

//------------------------------------------------------------------------------
LinearSystem Study::systemFor(const SolverCombination& combination)
{
  LinearSystem linear = this->System.linearSystem();
  const int block = linear.blockSize;
  if (block == 1 || !isMultigrid(combination.preconditioner) || combination.nearNullSpace)
  {
    return linear;
  }
  // Give multigrid only the matrix.
  linear.blockSize = 1;
  linear.coordinates = nullptr;
  if (linear.numbering)
  {
    if (!this->Scalars)
    {
      std::vector<Index> ids;
      for (Index point : this->System.freePoints())
      {
        for (int k = 0; k < block; ++k)
        {
          ids.push_back(block * this->System.part().globalIds[point] + k);
        }
      }
      this->Scalars = std::make_unique<PointNumbering>(
        this->System.part().communicator, static_cast<Index>(ids.size()), ids.data());
    }
    linear.numbering = this->Scalars.get();
  }
  return linear;
}

//------------------------------------------------------------------------------
/// Determines in advance the combinations in which PETSc options have an effect, and checks all
/// options.
void Study::checkOptions()
{
  const auto& combinations = this->Options.combinations;
  this->TakesOptions.assign(combinations.size(), this->Options.solver.petscOptions.empty());
  std::string message;
  for (std::size_t i = 0; i < combinations.size() && (i == 0 || !this->TakesOptions[i]); ++i)
  {
    SolverOptions options = this->Options.solver;
    options.method = combinations[i].method;
    options.preconditioner = combinations[i].preconditioner;
    try
    {
      const LinearSolver tried(this->systemFor(combinations[i]), options);
      this->TakesOptions[i] = true;
    }
    catch (const Error& error)
    {
      message = message.empty() ? error.what() : message;
      options.petscOptions.clear();
      LinearSolver(this->systemFor(combinations[i]), options); // rethrows other errors
    }
  }
  if (std::count(this->TakesOptions.begin(), this->TakesOptions.end(), true) == 0)
  {
    throw Error(message);
  }
}

//------------------------------------------------------------------------------
bool Study::overTime() const
{
  return this->Options.maximumSeconds > 0 &&
    this->System.numbering().maximum(this->Time.seconds()) >= this->Options.maximumSeconds;
}

/// Reports the progress of this rank, which never decreases although residuals may increase.
bool Study::reportHere(double fraction)
{
  this->Reported = std::max(this->Reported, std::min(1.0, fraction));
  return this->Options.progress(this->Reported);
}

/// Reports progress; false if the study must stop, on all ranks.
bool Study::report(double fraction)
{
  if (!this->Options.progress)
  {
    return true;
  }
  const bool stop = !this->reportHere(fraction);
  this->Result.aborted = this->System.numbering().maximum(stop ? 1.0 : 0.0) > 0;
  return !this->Result.aborted;
}

//------------------------------------------------------------------------------
LinearSolution Study::solveOnce(const SolverCombination& combination, std::size_t index, bool ritz)
{
  SolverOptions options = this->Options.solver;
  options.method = combination.method;
  options.preconditioner = combination.preconditioner;
  options.initialGuess = false;
  options.ritzValues = ritz;
  if (!this->TakesOptions[index])
  {
    options.petscOptions.clear();
  }
  // Before it starts, a combination may wait for the abandoned setup of another one.
  SolverOptions beginning = options;
  beginning.maximumSeconds = 0.0;
  if (this->Options.maximumSeconds > 0)
  {
    constexpr double smallest = 1e-3; // 0 would mean no limit
    const double left = std::max(smallest, this->Options.maximumSeconds - this->Time.seconds());
    beginning.maximumSeconds = left;
    options.maximumSeconds =
      options.maximumSeconds > 0 ? std::min(options.maximumSeconds, left) : left;
  }
  const double count = static_cast<double>(this->Options.combinations.size());
  const double tolerance = options.relativeTolerance;
  double first = 0;
  if (this->Options.progress)
  {
    constexpr double interval = 0.05; // of progress reports, in seconds
    options.observerSeconds = options.observer ? options.observerSeconds : interval;
    options.observer = [&](int iteration, double norm)
    {
      // The residual decreases roughly uniformly on a logarithmic scale.
      first = iteration == 0 ? norm : first;
      const double done =
        first > 0 && norm > 0 && tolerance > 0 ? std::log(norm / first) / std::log(tolerance) : 0;
      return this->reportHere(
               (static_cast<double>(index) + std::max(0.0, std::min(1.0, done))) / count) &&
        (!this->Options.solver.observer || this->Options.solver.observer(iteration, norm));
    };
  }
  LinearSolver solver(this->systemFor(combination), beginning);
  solver.options() = options;
  std::vector<double> unknowns(this->System.matrix().size, 0.0);
  return solver.solve(this->System.rightHandSide().data(), unknowns.data());
}

//------------------------------------------------------------------------------
SolverStudyRow Study::solve(const SolverCombination& combination, std::size_t index)
{
  SolverStudyRow row;
  row.combination = combination;
  row.run = true;
  for (int turn = 0; turn < std::max(1, this->Options.repetitions); ++turn)
  {
    if (turn > 0 && this->overTime())
    {
      break;
    }
    const double before = processSeconds();
    LinearSolution linear;
    try
    {
      linear = this->solveOnce(combination, index,
        this->Options.conditions && combination.method == KrylovMethod::ConjugateGradient);
    }
    catch (const Error& error)
    {
      linear.reason = SolveReason::OtherFailure; // options without effect, detected late
      linear.message = error.what();
    }
    const double cpu = processSeconds() - before;
    const double seconds =
      this->System.numbering().maximum(linear.setupSeconds + linear.solveSeconds);
    const bool aborted = linear.reason == SolveReason::Aborted;
    const bool stopped = aborted || linear.reason == SolveReason::TimeLimit;
    if (turn == 0 || (seconds < row.seconds && !stopped))
    {
      row.linear = std::move(linear);
      row.seconds = seconds;
      row.cpuSeconds = cpu;
      row.trueResidual = row.linear.trueResidual;
    }
    if (stopped || !converged(row.linear.reason))
    {
      this->Result.aborted |= aborted;
      break;
    }
  }
  this->Result.aborted |= row.linear.reason == SolveReason::Aborted;
  return row;
}

//------------------------------------------------------------------------------
/// The spectrum of P^-1 A is the same for every method; CG estimates it best.
void Study::findConditions()
{
  auto& rows = this->Result.rows;
  const auto conditionOf = [](const LinearSolution& linear)
  { return linear.ritzSmallest > 0 ? linear.ritzLargest / linear.ritzSmallest : 0.0; };
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    SolverStudyRow& row = rows[i];
    if (!row.run || row.combination.method == KrylovMethod::Direct || row.condition > 0)
    {
      continue;
    }
    const auto alike = [&](const SolverStudyRow& other)
    {
      return other.run && other.combination.method != KrylovMethod::Direct &&
        other.combination.preconditioner == row.combination.preconditioner &&
        other.combination.nearNullSpace == row.combination.nearNullSpace;
    };
    const auto cg = std::find_if(rows.begin(), rows.end(),
      [&](const SolverStudyRow& other)
      { return alike(other) && other.combination.method == KrylovMethod::ConjugateGradient; });
    LinearSolution linear;
    if (cg != rows.end())
    {
      linear = cg->linear;
    }
    else if (!this->Result.aborted && !this->overTime())
    {
      SolverCombination other = row.combination;
      other.method = KrylovMethod::ConjugateGradient;
      linear = this->solveOnce(other, i, true);
    }
    for (SolverStudyRow& other : rows)
    {
      if (alike(other) && converged(linear.reason))
      {
        other.condition = conditionOf(linear);
      }
    }
  }
}

//------------------------------------------------------------------------------
std::string Study::nameIn(const SolverCombination& combination) const
{
  const bool hasModes = this->System.blockSize() > 1 && isMultigrid(combination.preconditioner) &&
    combination.nearNullSpace && combination.method != KrylovMethod::Direct;
  return nameOf(combination) + (hasModes ? " with the rigid body modes" : "");
}

/// Describes how the time of a combination grows with the mesh.
std::string Study::outlook(const SolverStudyRow& best) const
{
  const bool flat = this->System.mesh().dimension() != Dimension::Volume;
  const SolverCombination& c = best.combination;
  if (c.method == KrylovMethod::Direct)
  {
    return std::string(" Its time grows about as N^") + (flat ? "1.5" : "2") +
      " and its memory as " + (flat ? "N log N" : "N^1.33") +
      ", so that on finer meshes CG + BoomerAMG will overtake it.";
  }
  if (isMultigrid(c.preconditioner) && this->System.blockSize() > 1 && !c.nearNullSpace)
  {
    return " Multigrid lacks the rigid body modes here: its iterations grow with the mesh.";
  }
  if (isMultigrid(c.preconditioner))
  {
    return " Its iterations hardly depend on the number N of unknowns, so that its time grows "
           "about "
           "as N.";
  }
  std::string text = std::string(" Its iterations grow about as N^") + (flat ? "0.5" : "0.33") +
    ", so that its time grows about as N^" + (flat ? "1.5" : "1.33") + ".";
  const SolverStudyRow* multigrid = nullptr;
  for (const SolverStudyRow& row : this->Result.rows)
  {
    if (row.run && converged(row.linear.reason) && isMultigrid(row.combination.preconditioner) &&
      (!multigrid || row.seconds < multigrid->seconds))
    {
      multigrid = &row;
    }
  }
  if (multigrid && best.seconds > 0)
  {
    text += " " + this->nameIn(multigrid->combination) + ", " +
      digits(multigrid->seconds / best.seconds) +
      " times as long here, may overtake it on finer meshes.";
  }
  return text;
}

/// Warnings about the mesh or the matrix rather than about a solver.
std::string Study::warnings() const
{
  std::string text;
  constexpr double nearlySingular = 1e12, badShape = 10;
  double condition = 0;
  for (const SolverStudyRow& row : this->Result.rows)
  {
    condition = std::max(condition, row.condition);
  }
  if (condition > nearlySingular)
  {
    text += " The matrix is nearly singular (condition about " + digits(condition) +
      " even with a preconditioner): check the fixed points and the coefficients.";
  }
  // The inverse mean ratio is the trace of an element matrix over the trace for the ideal element
  // (in the plane).
  const Mesh& mesh = this->System.mesh();
  const Index cells = mesh.view().numberOfCells;
  std::vector<double> shape(cells);
  EvaluationOptions options;
  options.threads = this->System.threads();
  evaluateMetric(mesh, Metric::InverseMeanRatio, options, shape.data());
  Index worst = -1, bad = 0;
  for (Index cell = 0; cell < cells; ++cell)
  {
    const bool skipped = this->System.part().skip && this->System.part().skip[cell];
    const bool counts = !skipped && std::isfinite(shape[cell]);
    bad += counts && std::abs(shape[cell]) > badShape;
    worst = counts && (worst < 0 || std::abs(shape[cell]) > std::abs(shape[worst])) ? cell : worst;
  }
  const PointNumbering& numbering = this->System.numbering();
  const double worstShape = numbering.maximum(worst < 0 ? 0.0 : std::abs(shape[worst]));
  bad = numbering.sum(bad);
  if (bad > 0)
  {
    const std::string where =
      numbering.ranks() == 1 ? ", cell " + std::to_string(worst) + "," : std::string();
    text += " The mesh has " + std::to_string(bad) + (bad == 1 ? " element" : " elements") +
      " of poor shape (inverse mean ratio above " + digits(badShape) + "; the worst" + where +
      " has " + digits(worstShape) +
      "): they dominate the largest eigenvalue. Optimize Mesh first would help every solver.";
  }
  return text;
}

//------------------------------------------------------------------------------
void Study::recommend()
{
  const auto& rows = this->Result.rows;
  std::vector<const SolverStudyRow*> order, failed;
  Index notRun = 0;
  for (const SolverStudyRow& row : rows)
  {
    notRun += !row.run;
    if (row.run)
    {
      (converged(row.linear.reason) ? order : failed).push_back(&row);
    }
  }
  std::stable_sort(order.begin(), order.end(),
    [](const SolverStudyRow* a, const SolverStudyRow* b) { return a->seconds < b->seconds; });
  std::string& why = this->Result.why;
  if (!order.empty())
  {
    const SolverStudyRow& best = *order.front();
    this->Result.recommended = order.front() - rows.data();
    const double noise = std::max(noiseFraction * best.seconds, noiseSeconds);
    this->Result.ties = std::count_if(order.begin() + 1, order.end(),
      [&](const SolverStudyRow* row) { return row->seconds <= best.seconds + noise; });
    if (this->Result.ties > 0)
    {
      why = "No clear recommendation: the times of " + std::to_string(this->Result.ties + 1) +
        " combinations differ by less than " + digits(noise) +
        " s, the noise: raise Repetitions, or use a finer mesh. The fastest was ";
    }
    why += this->nameIn(best.combination) + ": " + digits(best.seconds) + " s";
    if (best.combination.method != KrylovMethod::Direct)
    {
      why += ", " + std::to_string(best.linear.iterations) +
        (best.linear.iterations == 1 ? " iteration" : " iterations");
    }
    why += ".";
    if (order.size() > 1 && best.seconds > 0)
    {
      why += " The next, " + this->nameIn(order[1]->combination) + ", takes " +
        digits(order[1]->seconds / best.seconds) + " times as long";
      if (order.size() > 2)
      {
        why += ", the slowest, " + this->nameIn(order.back()->combination) + ", " +
          digits(order.back()->seconds / best.seconds) + " times";
      }
      why += ".";
    }
    why += this->outlook(best);
    // The tolerance applies to the preconditioned residual, which may be much smaller.
    constexpr double factor = 10;
    if (best.trueResidual > factor * this->Options.solver.relativeTolerance)
    {
      why += " The true residual is " + digits(best.trueResidual) +
        " of the right-hand side: the tolerance applies to the preconditioned residual. Reduce "
        "it for a more accurate solution.";
    }
  }
  else
  {
    why = notRun == static_cast<Index>(rows.size()) ? "Nothing was run." : "None converged.";
  }
  if (!failed.empty())
  {
    why += " " + std::to_string(failed.size()) +
      " did not converge: " + this->nameIn(failed.front()->combination) + " " +
      describe(failed.front()->linear.reason) + (failed.size() > 1 ? ", and others." : ".");
  }
  if (notRun > 0)
  {
    why += " " + std::to_string(notRun) + (notRun == 1 ? " was" : " were") + " not run: " +
      (this->Result.aborted ? "the study was stopped."
                            : "the time limit was "
                              "reached.");
  }
  why += this->warnings();
}

//------------------------------------------------------------------------------
SolverStudy Study::run()
{
  const auto& combinations = this->Options.combinations;
  if (combinations.empty())
  {
    throw Error(
      "There is no combination of solver and preconditioner to run: choose at least one.");
  }
  this->checkOptions();
  for (std::size_t i = 0; i < combinations.size(); ++i)
  {
    const bool go = this->report(static_cast<double>(i) / static_cast<double>(combinations.size()));
    this->Result.timeLimit = go && !this->Result.aborted && this->overTime();
    if (!go || this->Result.timeLimit)
    {
      break;
    }
    this->Result.rows.push_back(this->solve(combinations[i], i));
    if (this->Result.aborted)
    {
      break;
    }
  }
  this->Result.timeLimit = this->Result.timeLimit || (!this->Result.aborted && this->overTime());
  for (std::size_t i = this->Result.rows.size(); i < combinations.size(); ++i)
  {
    this->Result.rows.emplace_back();
    this->Result.rows.back().combination = combinations[i];
  }
  if (this->Options.conditions)
  {
    this->findConditions();
  }
  this->recommend();
  return std::move(this->Result);
}
}

//------------------------------------------------------------------------------
std::string nameOf(const SolverCombination& combination)
{
  return combination.method == KrylovMethod::Direct
    ? "direct solver"
    : std::string(nameOf(combination.method)) + " + " + nameOf(combination.preconditioner);
}

//------------------------------------------------------------------------------
std::vector<SolverCombination> dissertationCombinations()
{
  std::vector<SolverCombination> combinations;
  for (int preconditioner = 0; preconditioner < tablePreconditioners; ++preconditioner)
  {
    for (int method = 0; method < tableMethods; ++method)
    {
      combinations.push_back(
        { static_cast<KrylovMethod>(method), static_cast<Preconditioner>(preconditioner), false });
    }
  }
  return combinations;
}

//------------------------------------------------------------------------------
SolverStudy studySolvers(const EllipticSystem& system, const SolverStudyOptions& options)
{
  return Study(system, options).run();
}
}
