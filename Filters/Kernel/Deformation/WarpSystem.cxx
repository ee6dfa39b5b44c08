// SPDX-License-Identifier: BSD-3-Clause
#include "WarpSystem.h"

#include "WarpParts.h"
#include "tautline/Core/Parallel.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
/// The number of previous solutions kept; each costs two vectors.
constexpr std::size_t maxFormer = 12;
/// The number of unknowns up to which a factorization is faster (measured): its first solve takes
/// at most a few tenths of a second longer than multigrid, and each further one a tenth of the
/// time.
constexpr Index directPlanar = 600000, directVolume = 20000;
/// If CG fails, a factorization up to this many times larger is tried.
constexpr Index largestFactor = 10;

/// Bitwise the same for any number of threads.
double product(const std::vector<double>& a, const std::vector<double>& b, int threads)
{
  const Index n = static_cast<Index>(a.size());
  std::vector<double> parts(numberOfChunks(n), 0.0);
  forEachChunk(n, threads,
    [&](Index chunk, Index begin, Index end)
    {
      for (Index i = begin; i < end; ++i)
      {
        parts[chunk] += a[i] * b[i];
      }
    });
  double sum = 0;
  for (double part : parts)
  {
    sum += part;
  }
  return sum;
}

/// y += s x
void add(double s, const std::vector<double>& x, std::vector<double>& y, int threads)
{
  forEachChunk(static_cast<Index>(x.size()), threads,
    [&](Index, Index begin, Index end)
    {
      for (Index i = begin; i < end; ++i)
      {
        y[i] += s * x[i];
      }
    });
}
}

//------------------------------------------------------------------------------
WarpSystem::WarpSystem(const WarpMatrix& given, int block, const std::vector<unsigned char>& held,
  const double* points, int dimension, const WarpOptions& options, const Ranks& ranks)
  : Options(options)
  , TheRanks(ranks)
  , Block(block)
  , Symmetric(given.symmetric)
  , Shared(given.shared && ranks.several())
{
  const SparseMatrix& all = given.matrix;
  const Index n = static_cast<Index>(held.size());
  std::vector<std::int32_t> unknown(n * block, -1);
  for (Index p = 0; p < n; ++p)
  {
    if (!held[p])
    {
      for (int k = 0; k < block; ++k)
      {
        unknown[p * block + k] =
          static_cast<std::int32_t>(static_cast<Index>(this->Free.size()) * block + k);
      }
      this->Free.push_back(p);
      if (block > 1) // for the rigid body modes
      {
        this->Inner->coordinates.insert(
          this->Inner->coordinates.end(), points + 3 * p, points + 3 * p + 3);
      }
    }
  }
  this->Inner->matrix.size = static_cast<Index>(this->Free.size()) * block;
  this->Inner->matrix.offsets.reserve(this->Inner->matrix.size + 1);
  this->Starts.assign(1, 0);
  for (const Index p : this->Free)
  {
    for (Index row = p * block; row < (p + 1) * block; ++row)
    {
      // The row of a point is on the rank that owns it.
      const Index end = this->Shared || ranks.owns(p) ? all.offsets[row + 1] : all.offsets[row];
      for (Index e = all.offsets[row]; e < end; ++e)
      {
        const std::int32_t column = unknown[all.columns[e]];
        if (column >= 0)
        {
          this->Inner->matrix.columns.push_back(column);
          this->Inner->matrix.values.push_back(all.values[e]);
        }
        else if (all.values[e] != 0)
        {
          this->Columns.push_back(all.columns[e]);
          this->Values.push_back(all.values[e]);
        }
      }
      this->Inner->matrix.offsets.push_back(this->Inner->matrix.nonzeros());
      this->Starts.push_back(static_cast<Index>(this->Columns.size()));
    }
  }
  this->Unknowns = this->Inner->matrix.size;
  if (ranks.several())
  {
    std::vector<Index> ids;
    for (const Index p : this->Free)
    {
      ids.push_back(ranks.mesh().numbers()[p]);
    }
    ids.reserve(1); // avoid a null pointer, which means one rank
    this->Numbering = std::make_unique<PointNumbering>(
      ranks.communicator(), static_cast<Index>(this->Free.size()), ids.data());
    this->Unknowns = this->Numbering->globalSize() * block;
  }
  this->DirectLimit = dimension == 2 ? directPlanar : directVolume;
  this->Method = !this->automatic()       ? options.solver.method
    : this->Unknowns <= this->DirectLimit ? KrylovMethod::Direct
    : this->Symmetric                     ? KrylovMethod::ConjugateGradient
                                          : KrylovMethod::BiCGStab;
}

//------------------------------------------------------------------------------
void WarpSystem::makeSolver(KrylovMethod method, WarpControl& control)
{
  SolverOptions options = this->Options.solver;
  options.method = method;
  options.initialGuess = false;
  options.threads = this->Options.threads;
  options.observer = nullptr;
  options.maximumSeconds = control.secondsLeft();
  options.cancelled = nullptr;
  if (this->automatic() && method != KrylovMethod::Direct)
  {
    // Coarser and sparser levels than BoomerAMG's own choice: a third of the time for 10^6
    // tetrahedra.
    options.preconditioner = Preconditioner::BoomerAMG;
    options.defaultPetscOptions =
      "-pc_hypre_boomeramg_strong_threshold 0.5 -pc_hypre_boomeramg_coarsen_type HMIS "
      "-pc_hypre_boomeramg_interp_type ext+i -pc_hypre_boomeramg_P_max 4 "
      "-pc_hypre_boomeramg_agg_nl 1";
  }
  LinearSystem system;
  system.matrix = &this->Inner->matrix;
  system.blockSize = this->Block;
  system.wholeRows = !this->Shared;
  system.symmetric = system.positiveDefinite = this->Symmetric;
  system.coordinates = this->Block > 1 ? this->Inner->coordinates.data() : nullptr;
  system.owner = this->Inner;
  system.numbering = this->Numbering.get();
  this->Solver = std::make_unique<LinearSolver>(system, options);
  this->Method = method;
}

//------------------------------------------------------------------------------
/// Over the unknowns of all ranks; one of the vectors is 0 at unknowns of other ranks.
double WarpSystem::product(const std::vector<double>& a, const std::vector<double>& b) const
{
  return this->TheRanks.sum(tautline::product(a, b, this->Options.threads));
}

//------------------------------------------------------------------------------
/// For a product with a shared matrix: sums the contributions of all ranks, and sets unknowns of
/// other ranks to 0.
void WarpSystem::addShares(std::vector<double>& vector) const
{
  if (!this->Shared)
  {
    return;
  }
  this->Numbering->sum(vector.data(), this->Block);
  for (std::size_t i = 0; i < this->Free.size(); ++i)
  {
    if (!this->Numbering->owned(static_cast<Index>(i)))
    {
      std::fill_n(vector.begin() + static_cast<std::ptrdiff_t>(i) * this->Block, this->Block, 0.0);
    }
  }
}

//------------------------------------------------------------------------------
/// -A_B times the given values.
std::vector<double> WarpSystem::rightHandSide(const std::vector<double>& values) const
{
  std::vector<double> right(this->Inner->matrix.size);
  forEachChunk(this->Inner->matrix.size, this->Options.threads,
    [&](Index, Index begin, Index end)
    {
      for (Index i = begin; i < end; ++i)
      {
        double sum = 0;
        for (Index e = this->Starts[i]; e < this->Starts[i + 1]; ++e)
        {
          sum -= this->Values[e] * values[this->Columns[e]];
        }
        right[i] = sum;
      }
    });
  this->addShares(right);
  return right;
}

/// Moves the part of the right-hand side in the span of previous ones to the solution; returns the
/// norm of the remainder.
double WarpSystem::project(std::vector<double>& right, std::vector<double>& solution) const
{
  const int threads = this->Options.threads;
  constexpr int rounds = 2; // the second corrects the rounding of the first
  for (int round = 0; round < rounds; ++round)
  {
    for (const Former& former : this->Basis)
    {
      const double part = this->product(former.right, right);
      add(-part, former.right, right, threads);
      add(part, former.solution, solution, threads);
    }
  }
  return std::sqrt(this->product(right, right));
}

/// Adds a solution and the right-hand side it is exact for to the orthonormal basis.
void WarpSystem::remember(const std::vector<double>& solution)
{
  const int threads = this->Options.threads;
  Former former;
  former.right.resize(this->Inner->matrix.size);
  this->Inner->matrix.multiply(solution.data(), former.right.data(), threads);
  this->addShares(former.right);
  const double before = std::sqrt(this->product(former.right, former.right));
  std::vector<double> spanned(this->Inner->matrix.size, 0.0);
  const double length = this->project(former.right, spanned);
  constexpr double nothingNew = 1e-6;
  if (!(length > nothingNew * before) || !std::isfinite(length))
  {
    return;
  }
  former.solution = solution;
  add(-1.0, spanned, former.solution, threads);
  for (std::vector<double>* vector : { &former.right, &former.solution })
  {
    for (double& value : *vector)
    {
      value /= length;
    }
  }
  this->Basis.push_back(std::move(former));
  if (this->Basis.size() > maxFormer)
  {
    this->Basis.pop_front(); // the others stay orthonormal
  }
}

//------------------------------------------------------------------------------
bool WarpSystem::runSolver(const std::vector<double>& right, double tolerance,
  std::vector<double>& solution, WarpControl& control)
{
  if (!this->Solver)
  {
    this->makeSolver(this->Method, control);
  }
  this->Solver->options().relativeTolerance = tolerance;
  this->Solver->options().maximumSeconds = control.secondsLeft();
  constexpr double interval = 0.05; // of progress reports, in seconds
  constexpr double share = 0.5;     // of the progress of a step
  double first = 0.0;
  this->Solver->options().observer = [&control, &first, tolerance](int iteration, double residual)
  {
    first = iteration == 0 ? residual : first;
    const bool known = first > residual && residual > 0.0;
    const double reduced = known ? std::log(first / residual) / -std::log(tolerance) : 0.0;
    return control.watch(share * std::clamp(reduced, 0.0, 1.0));
  };
  this->Solver->options().observerSeconds = interval;
  this->Solver->options().cancelled = [&control]() { return !control.watch(0.0); };
  control.result().setupSeconds += this->Solver->setUp();
  solution.assign(this->Inner->matrix.size, 0.0);
  const LinearSolution done = this->Solver->solve(right.data(), solution.data());
  this->Solver->options().observer = nullptr;
  this->Solver->options().cancelled = nullptr;
  control.proceed(share);
  control.result().setupSeconds += done.setupSeconds;
  control.result().solveSeconds += done.solveSeconds;
  control.addIterations(done.iterations);
  this->Failure = converged(done.reason) ? "" : describe(done.reason);
  this->Failure += done.message.empty() ? "" : ": " + done.message;
  if (done.reason == SolveReason::TimeLimit)
  {
    control.result().timeLimit = true;
  }
  return converged(done.reason);
}

//------------------------------------------------------------------------------
bool WarpSystem::solve(std::vector<double>& values, WarpControl& control)
{
  const int threads = this->Options.threads;
  this->Failure.clear();
  std::vector<double> right = this->rightHandSide(values);
  const double whole = std::sqrt(this->product(right, right));
  std::vector<double> x(this->Inner->matrix.size, 0.0);
  bool good = true;
  if (whole > 0)
  {
    const double rest = this->project(right, x);
    const double tolerance = this->Options.tolerance;
    if (rest > tolerance * whole)
    {
      // If the remainder is small, its relative accuracy can be lower.
      constexpr double loosest = 1e-2;
      std::vector<double> y;
      good = this->runSolver(right, std::min(loosest, tolerance * whole / rest), y, control);
      if (!good && !control.stopped() && this->automatic() &&
        this->Method != KrylovMethod::Direct && this->Unknowns <= largestFactor * this->DirectLimit)
      {
        this->makeSolver(KrylovMethod::Direct, control);
        good = this->runSolver(right, tolerance, y, control);
      }
      const bool finite = !this->TheRanks.any(
        !std::all_of(y.begin(), y.end(), [](double value) { return std::isfinite(value); }));
      if (finite)
      {
        add(1.0, y, x, threads);
        this->remember(y);
      }
      good = good && finite;
    }
  }
  for (std::size_t i = 0; i < this->Free.size(); ++i)
  {
    for (int k = 0; k < this->Block; ++k)
    {
      values[this->Free[i] * this->Block + k] = x[i * this->Block + k];
    }
  }
  return good;
}

//------------------------------------------------------------------------------
ComponentSolution solveComponents(const std::vector<WarpSystem*>& systems, const WarpParts& parts,
  const std::vector<double>& rest, double nothing, WarpControl& control, std::vector<double>& moved)
{
  // The maximum principle bounds the motion by the prescribed one; discrete operators may exceed
  // the bound slightly.
  constexpr double excess = 2.0;
  const std::size_t n = rest.size() / 3;
  ComponentSolution outcome;
  std::vector<double> values(n);
  for (int c = 0; c < 3 && !control.stopped(); ++c)
  {
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i)
    {
      values[i] = rest[3 * i + c];
      largest = std::max(largest, std::abs(values[i]));
    }
    largest = parts.ranks().maximum(largest);
    if (!(largest > nothing))
    {
      continue;
    }
    for (WarpSystem* system : systems)
    {
      if (system && !control.stopped())
      {
        outcome.converged = system->solve(values, control) && outcome.converged;
        outcome.failure = outcome.failure.empty() ? system->failure() : outcome.failure;
      }
    }
    for (std::size_t i = 0; i < n; ++i)
    {
      if (!parts.held()[i])
      {
        outcome.bounded = outcome.bounded && std::abs(values[i]) <= excess * largest;
        moved[3 * i + c] += values[i];
      }
    }
  }
  outcome.bounded = !parts.ranks().any(!outcome.bounded);
  return outcome;
}
}
