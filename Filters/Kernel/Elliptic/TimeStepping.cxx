// SPDX-License-Identifier: BSD-3-Clause
#include "TimeStepping.h"

#include "ElementShapes.h"
#include "FiniteElements.h"
#include "tautline/Core/Memory.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Core/Stopwatch.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tautline
{
namespace
{
using Vector = std::vector<double>;

constexpr double RoundingError = std::numeric_limits<double>::epsilon();
constexpr double NewmarkBeta = 0.25, NewmarkGamma = 0.5;

/// alpha A + beta M; both have the pattern of A.
SparseMatrix combined(double alpha, const SparseMatrix& a, double beta, const SparseMatrix& m)
{
  SparseMatrix sum = a;
  for (std::size_t i = 0; i < sum.values.size(); ++i)
  {
    sum.values[i] = alpha * a.values[i] + beta * m.values[i];
  }
  return sum;
}

/// The position of a column in a row.
std::size_t placeOf(const SparseMatrix& matrix, Index row, std::int32_t column)
{
  const auto first = matrix.columns.begin() + matrix.offsets[row];
  const auto last = matrix.columns.begin() + matrix.offsets[row + 1];
  return static_cast<std::size_t>(std::lower_bound(first, last, column) - matrix.columns.begin());
}

/// A step matrix with its solver. An abandoned setup may still read both parts.
struct StepMatrix
{
  struct Kept
  {
    SparseMatrix matrix;
    std::shared_ptr<const void> system; // owns the coordinates
  };

  StepMatrix(
    const EllipticSystem& system, SparseMatrix values, bool modes, const SolverOptions& options)
  {
    LinearSystem linear = system.linearSystem();
    const auto kept = std::make_shared<Kept>(Kept{ std::move(values), linear.owner });
    linear.matrix = &kept->matrix;
    linear.owner = kept;
    linear.coordinates = modes ? linear.coordinates : nullptr;
    this->Solver = std::make_unique<LinearSolver>(linear, options);
  }

  std::unique_ptr<LinearSolver> Solver;
};

/// The integration of one system.
class Integrator
{
public:
  Integrator(const EllipticSystem& system, const TimeOptions& time, const SolverOptions& options);

  TimeSeries run(const Vector& start, const Vector& velocity);

private:
  bool heatStep(int number);
  bool firstAcceleration();
  bool waveStep(int number);
  /// Solves for x, which holds the initial guess. @return false to stop
  bool solve(StepMatrix& matrix, const Vector& b, Vector& x, bool counts);
  StepMatrix& matrix(double alpha, double beta);
  Vector product(const SparseMatrix& matrix, const Vector& x) const;
  Vector extrapolated() const;

  const EllipticSystem& System;
  TimeOptions Time;
  SolverOptions Options;
  std::function<bool(int, double)> Observer; // of steps
  Stopwatch Watch;
  SparseMatrix Mass;
  std::unique_ptr<StepMatrix> Current;
  double Alpha = 0.0, Beta = 0.0; // of Current
  Vector Velocity, Acceleration;
  // the largest residual so far; a residual below its rounding error is treated as 0
  double Scale = 0.0;
  TimeSeries Series;
};

//------------------------------------------------------------------------------
Integrator::Integrator(
  const EllipticSystem& system, const TimeOptions& time, const SolverOptions& options)
  : System(system)
  , Time(time)
  , Options(options)
  , Observer(options.observer)
  , Mass(massMatrix(system, time.mass))
{
  for (double& value : this->Mass.values)
  {
    value *= time.density;
  }
  this->Options.observer = nullptr; // the observer of the caller counts steps, not iterations
  this->Options.initialGuess = true;
}

//------------------------------------------------------------------------------
Vector Integrator::product(const SparseMatrix& matrix, const Vector& x) const
{
  Vector y(x.size(), 0.0);
  matrix.multiply(x.data(), y.data(), this->System.threads());
  return y;
}

//------------------------------------------------------------------------------
StepMatrix& Integrator::matrix(double alpha, double beta)
{
  if (!this->Current || this->Alpha != alpha || this->Beta != beta)
  {
    this->Current.reset(); // free its memory first
    this->Current = std::make_unique<StepMatrix>(this->System,
      combined(alpha, this->System.matrix(), beta, this->Mass), this->Time.rigidBodyModes,
      this->Options);
    this->Alpha = alpha;
    this->Beta = beta;
  }
  return *this->Current;
}

//------------------------------------------------------------------------------
bool Integrator::solve(StepMatrix& matrix, const Vector& b, Vector& x, bool counts)
{
  const double limit = this->Options.maximumSeconds;
  if (limit > 0)
  {
    // A small positive limit, so that the solver itself reports it.
    matrix.Solver->options().maximumSeconds = std::max(limit - this->Watch.seconds(), 1e-3 * limit);
  }
  matrix.Solver->options().absoluteTolerance =
    std::max(this->Options.absoluteTolerance, RoundingError * this->Scale);
  LinearSolution solved = matrix.Solver->solve(b.data(), x.data());
  for (const double residual : solved.residuals)
  {
    this->Scale = std::isfinite(residual) ? std::max(this->Scale, residual) : this->Scale;
  }
  this->Series.setupSeconds += solved.setupSeconds;
  this->Series.solveSeconds += solved.solveSeconds;
  this->Series.iterations += solved.iterations;
  this->Series.reason = solved.reason;
  if (counts)
  {
    this->Series.residuals.push_back(solved.residuals.empty() ? 0.0 : solved.residuals.back());
    solved.residuals.clear();
    this->Series.solves.push_back(std::move(solved));
  }
  return converged(this->Series.reason);
}

//------------------------------------------------------------------------------
Vector Integrator::extrapolated() const
{
  const auto& values = this->Series.values;
  Vector guess = values.back();
  if (values.size() > 1)
  {
    const Vector& before = values[values.size() - 2];
    for (std::size_t i = 0; i < guess.size(); ++i)
    {
      guess[i] = 2 * guess[i] - before[i];
    }
  }
  return guess;
}

//------------------------------------------------------------------------------
bool Integrator::heatStep(int number)
{
  const double dt = this->Time.step;
  const Vector& load = this->System.rightHandSide();
  const Vector& now = this->Series.values.back();
  const bool two = this->Time.scheme == TimeScheme::Bdf2 && number > 1;
  const bool middle = this->Time.scheme == TimeScheme::CrankNicolson;

  // The difference quotient for u is (c0 u_new + c1 u + c2 u_old) / dt.
  const double c0 = two ? 1.5 : 1.0, c1 = two ? -2.0 : -1.0, c2 = two ? 0.5 : 0.0;
  Vector known(now.size());
  for (std::size_t i = 0; i < known.size(); ++i)
  {
    const double old = two ? this->Series.values[this->Series.values.size() - 2][i] : 0.0;
    known[i] = -(c1 * now[i] + c2 * old) / dt;
  }
  Vector b = this->product(this->Mass, known);
  const double share = middle ? 0.5 : 1.0; // the fraction of A that acts on the new values
  const Vector flux = middle ? this->product(this->System.matrix(), now) : Vector();
  for (std::size_t i = 0; i < b.size(); ++i)
  {
    b[i] += load[i] - (middle ? (1.0 - share) * flux[i] : 0.0);
  }
  Vector x = this->extrapolated();
  if (!this->solve(this->matrix(share, c0 / dt), b, x, true))
  {
    return false;
  }
  this->Series.values.push_back(std::move(x));
  return true;
}

//------------------------------------------------------------------------------
/// M a = f - A u at the start.
bool Integrator::firstAcceleration()
{
  Vector b = this->product(this->System.matrix(), this->Series.values.front());
  const Vector& load = this->System.rightHandSide();
  for (std::size_t i = 0; i < b.size(); ++i)
  {
    b[i] = load[i] - b[i];
  }
  this->Acceleration.assign(b.size(), 0.0);
  return this->solve(this->matrix(0.0, 1.0), b, this->Acceleration, false);
}

//------------------------------------------------------------------------------
bool Integrator::waveStep(int)
{
  const double dt = this->Time.step;
  const Vector& now = this->Series.values.back();
  const Vector& load = this->System.rightHandSide();
  const double inertia = 1.0 / (NewmarkBeta * dt * dt);
  Vector predicted(now.size());
  for (std::size_t i = 0; i < now.size(); ++i)
  {
    predicted[i] =
      now[i] + dt * this->Velocity[i] + dt * dt * (0.5 - NewmarkBeta) * this->Acceleration[i];
  }
  // (A + M / (beta dt^2)) u_new = f + M predicted / (beta dt^2)
  Vector b = this->product(this->Mass, predicted);
  for (std::size_t i = 0; i < b.size(); ++i)
  {
    b[i] = inertia * b[i] + load[i];
  }
  Vector x = this->extrapolated();
  if (!this->solve(this->matrix(1.0, inertia), b, x, true))
  {
    return false;
  }
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    const double before = this->Acceleration[i];
    this->Acceleration[i] = inertia * (x[i] - predicted[i]);
    this->Velocity[i] +=
      dt * ((1.0 - NewmarkGamma) * before + NewmarkGamma * this->Acceleration[i]);
  }
  this->Series.values.push_back(std::move(x));
  return true;
}

//------------------------------------------------------------------------------
TimeSeries Integrator::run(const Vector& start, const Vector& velocity)
{
  const bool wave = this->Time.scheme == TimeScheme::Newmark;
  this->Series.times = { 0.0 };
  this->Series.values = { start };
  this->Velocity = velocity;
  bool proceed = !wave || this->firstAcceleration();
  for (int number = 1; proceed && number <= this->Time.steps; ++number)
  {
    proceed = wave ? this->waveStep(number) : this->heatStep(number);
    if (proceed)
    {
      this->Series.times.push_back(number * this->Time.step);
      if (this->Observer && !this->Observer(number, this->Series.residuals.back()))
      {
        this->Series.reason = SolveReason::Aborted;
        proceed = false;
      }
    }
  }
  return std::move(this->Series);
}

/// Throws Error if the problem cannot be integrated.
void requireOptions(const EllipticSystem& system, const TimeOptions& time, const Vector& start,
  const Vector& velocity)
{
  if (!(std::isfinite(time.step) && time.step > 0))
  {
    throw Error("The time step is " + std::to_string(time.step) + "; it must be above 0.");
  }
  if (time.steps < 1)
  {
    throw Error("The number of time steps is " + std::to_string(time.steps) +
      "; at least 1 is "
      "needed.");
  }
  if (!(std::isfinite(time.density) && time.density > 0))
  {
    throw Error("The density is " + std::to_string(time.density) + "; it must be above 0.");
  }
  if (time.scheme == TimeScheme::Stationary)
  {
    throw Error("A stationary problem has no time steps; choose a time scheme.");
  }
  const auto size = static_cast<std::size_t>(system.matrix().size);
  const bool wave = time.scheme == TimeScheme::Newmark;
  for (const Vector* given : { &start, wave ? &velocity : &start })
  {
    const char* what = given == &start ? "values" : "velocities";
    if (given->size() != size)
    {
      throw Error("There are " + std::to_string(given->size()) + " initial " + what + " for " +
        std::to_string(size) + " unknowns.");
    }
    if (!std::all_of(given->begin(), given->end(), [](double v) { return std::isfinite(v); }))
    {
      throw Error(std::string("The initial ") + what + " are not finite at some points.");
    }
  }
}
}

//------------------------------------------------------------------------------
SparseMatrix massMatrix(const EllipticSystem& system, MassMatrix kind)
{
  const Mesh& mesh = system.mesh();
  SparseMatrix made = system.matrix();
  std::fill(made.values.begin(), made.values.end(), 0.0);
  if (mesh.view().numberOfCells == 0)
  {
    return made; // a rank may have no cells
  }
  const bool lumped = kind == MassMatrix::Lumped;
  for (Index cell = 0; lumped && cell < mesh.view().numberOfCells; ++cell)
  {
    const bool counts = !(system.part().skip && system.part().skip[cell]);
    if (counts && isQuadratic(elementKind(mesh.view(), cell)))
    {
      throw Error("The row sums of the mass matrix are not positive at the corners of "
                  "quadratic elements: choose the consistent mass matrix.");
    }
  }
  DiffusionOperator identity;
  identity.tensor = { 0, 0, 0, 0, 0, 0 };
  identity.reaction = 1.0;
  AssemblyOptions options;
  options.skip = system.part().skip;
  options.threads = system.threads();
  const SparseMatrix whole = AssemblyPattern(mesh, options).assemble(identity);

  const int d = system.blockSize();
  std::vector<Index> freeIndex(mesh.view().numberOfPoints, -1);
  const std::vector<Index>& free = system.freePoints();
  for (std::size_t i = 0; i < free.size(); ++i)
  {
    freeIndex[free[i]] = static_cast<Index>(i);
  }
  // Each component has the scalar matrix; a lumped row also includes the columns of fixed points.
  const auto fill = [&](Index i)
  {
    const Index row = free[i];
    for (Index k = whole.offsets[row]; k < whole.offsets[row + 1]; ++k)
    {
      const Index column = lumped ? i : freeIndex[whole.columns[k]];
      for (int c = 0; column >= 0 && c < d; ++c)
      {
        made.values[placeOf(made, d * i + c, static_cast<std::int32_t>(d * column + c))] +=
          whole.values[k];
      }
    }
  };
  forEachChunk(static_cast<Index>(free.size()), system.threads(),
    [&](Index, Index begin, Index end)
    {
      for (Index i = begin; i < end; ++i)
      {
        fill(i);
      }
    });
  return made;
}

//------------------------------------------------------------------------------
std::vector<double> unknownsOf(const EllipticSystem& system, const std::vector<double>& pointValues)
{
  const int d = system.blockSize();
  const auto& frame = system.mesh().frame();
  std::vector<double> unknowns;
  unknowns.reserve(d * system.freePoints().size());
  for (const Index point : system.freePoints())
  {
    if (d == 1)
    {
      unknowns.push_back(pointValues[point]);
      continue;
    }
    const Vec3 v = { pointValues[3 * point], pointValues[3 * point + 1],
      pointValues[3 * point + 2] };
    for (int k = 0; k < d; ++k)
    {
      unknowns.push_back(d == 2 ? dot(v, frame[k]) : v[k]);
    }
  }
  return unknowns;
}

//------------------------------------------------------------------------------
void requireSeriesMemory(const EllipticSystem& system, const TimeOptions& time)
{
  requireMemory(sizeof(double) * static_cast<double>(system.matrix().size) * (time.steps + 1.0),
    "the solution at all time steps", "use fewer time steps or a coarser mesh");
}

//------------------------------------------------------------------------------
TimeSeries integrate(const EllipticSystem& system, const TimeOptions& time,
  const std::vector<double>& start, const std::vector<double>& velocity,
  const SolverOptions& options)
{
  requireOptions(system, time, start, velocity);
  if (!system.part().communicator)
  {
    requireSeriesMemory(system, time);
  }
  return Integrator(system, time, options).run(start, velocity);
}
}
