// SPDX-License-Identifier: BSD-3-Clause
#include "ExtremeEigenvalues.h"

#include "Tridiagonal.h"

#include <array>

namespace tautline
{
namespace
{
/// An eigenvalue below this times the largest is zero up to rounding.
constexpr double ZeroTolerance = 1e-13;
/// The tolerance for the asymmetry of a preconditioner.
constexpr double SymmetryTolerance = 1e-7;
constexpr Index FirstCheck = 8;
constexpr Index ManySteps = 100; // number of steps reported as half of the work

/// The recurrence; v = P u holds throughout.
class Recurrence
{
public:
  Recurrence(Mat matrix, PC preconditioner)
    : Matrix(matrix)
    , Preconditioner(preconditioner)
  {
    for (PetscVector* vector : { &this->V, &this->Previous, &this->U, &this->W })
    {
      petsc(MatCreateVecs(matrix, vector->out(), nullptr));
    }
    this->restart();
  }

  void restart()
  {
    fillStartVector(this->V);
    petsc(VecSet(this->Previous, 0.0));
    this->Beta = 0.0;
    this->Previous0 = true;
    this->normalize();
  }

  Vec v() const { return this->V; }
  double alpha() const { return this->Alpha; }
  double beta() const { return this->Beta; }
  /// P is not positive definite, or a number is not finite.
  bool failed() const { return this->Failed; }

  /// One step: alpha and beta are then the next entries of the tridiagonal matrix.
  void step()
  {
    petsc(MatMult(this->Matrix, this->U, this->W));
    petsc(VecDot(this->U, this->W, &this->Alpha));
    // The three-term recurrence: W becomes W - alpha V - beta Previous.
    petsc(VecAXPBYPCZ(this->W, -this->Alpha, -this->Beta, 1.0, this->V, this->Previous));
    std::swap(this->Previous, this->V);
    std::swap(this->V, this->W);
    this->normalize();
  }

private:
  /// Normalizes V to norm 1 in P^-1; beta becomes its former norm.
  void normalize()
  {
    PetscReal square = 0.0;
    petsc(PCApply(this->Preconditioner, this->V, this->U));
    petsc(VecDot(this->V, this->U, &square));
    // Rounding may make the square slightly negative, relative to the last entries of the
    // tridiagonal matrix.
    const double scale = std::max(std::abs(this->Alpha), this->Beta);
    this->Failed = !std::isfinite(square) || !std::isfinite(this->Alpha) ||
      square < -ZeroTolerance * scale * scale;
    this->Beta = std::sqrt(std::max(square, 0.0));
    if (this->Beta > 0.0 && !this->Failed)
    {
      petsc(VecScale(this->V, 1.0 / this->Beta));
      petsc(VecScale(this->U, 1.0 / this->Beta));
    }
    // The norm of the start vector is not an entry of the matrix.
    if (this->Previous0)
    {
      this->Previous0 = false;
      this->Failed = this->Failed || this->Beta == 0.0;
      this->Beta = 0.0;
    }
  }

  Mat Matrix;
  PC Preconditioner;
  PetscVector V, Previous, U, W;
  double Alpha = 0.0, Beta = 0.0;
  bool Failed = false, Previous0 = true;
};

/**
 * A Ritz value of the first pass and its error. An eigenvalue lies within the residual r of the
 * value. For clustered eigenvalues, r is far larger than the error; r^2 over the distance to the
 * next Ritz value (Kato-Temple) is far smaller as long as close eigenvalues are not separated yet.
 * The estimate is therefore the larger of that bound and of the change of the value during the last
 * half of the steps: convergence is at least quadratic in their number (Kaniel-Paige), so that the
 * remaining error is at most a third of that change.
 */
struct Candidate
{
  RitzPair pair;
  double residual = 0.0, estimate = 0.0; ///< of the error, as described
  bool converged = false;
  std::vector<std::pair<Index, double>> history; ///< steps and values
};

void update(Candidate& extreme, const Tridiagonal& t, bool smallest, double beta, double tolerance,
  double scale)
{
  if (extreme.converged)
  {
    return;
  }
  const auto steps = static_cast<Index>(t.diagonal.size());
  extreme.pair = ritzPair(t, smallest, beta);
  extreme.residual = beta * std::abs(extreme.pair.vector.back());
  extreme.estimate = extreme.residual;
  for (const auto& [before, value] : extreme.history)
  {
    if (2 * before <= steps)
    {
      extreme.estimate = std::max(extreme.pair.bound, std::abs(extreme.pair.value - value));
    }
  }
  extreme.history.emplace_back(steps, extreme.pair.value);
  extreme.converged = std::min(extreme.residual, extreme.estimate) <=
    std::max(tolerance * std::abs(extreme.pair.value), ZeroTolerance * scale);
}

/// The value and its bound from the accumulated y = P x.
void measure(Mat matrix, PC preconditioner, const PetscVector& y, const Candidate& candidate,
  ExtremeEigenvalue& extreme)
{
  PetscVector x, r, z;
  petsc(VecDuplicate(y, x.out()));
  petsc(VecDuplicate(y, r.out()));
  petsc(VecDuplicate(y, z.out()));
  // x = P^-1 y is the eigenvector; the norm of its residual A x - lambda y in P^-1 bounds the
  // error.
  PetscReal energy = 0.0, mass = 0.0, square = 0.0;
  petsc(PCApply(preconditioner, y, x));
  petsc(MatMult(matrix, x, r));
  petsc(VecDot(x, r, &energy));
  petsc(VecDot(x, y, &mass));
  extreme.value = energy / mass;
  petsc(VecAXPY(r, -extreme.value, y));
  petsc(PCApply(preconditioner, r, z));
  petsc(VecDot(r, z, &square));
  const double residual = std::sqrt(std::max(square, 0.0) / mass);
  extreme.bound =
    std::min(residual, candidate.estimate + std::abs(extreme.value - candidate.pair.value));
  extreme.found = std::isfinite(extreme.value) && std::isfinite(extreme.bound);
  petsc(VecScale(x, 1.0 / std::sqrt(std::max(mass, std::numeric_limits<double>::min()))));
  extreme.vector = std::move(x);
}

/// Whether P^-1 is symmetric, tested with two vectors.
bool isSymmetric(Mat matrix, PC preconditioner)
{
  PetscVector a, b, pa, pb;
  for (PetscVector* vector : { &a, &b, &pa, &pb })
  {
    petsc(MatCreateVecs(matrix, vector->out(), nullptr));
  }
  fillStartVector(a, 1);
  fillStartVector(b, 2);
  petsc(PCApply(preconditioner, a, pa));
  petsc(PCApply(preconditioner, b, pb));
  PetscReal ab = 0.0, ba = 0.0, aa = 0.0, bb = 0.0;
  petsc(VecDot(a, pb, &ab));
  petsc(VecDot(b, pa, &ba));
  petsc(VecDot(a, pa, &aa));
  petsc(VecDot(b, pb, &bb));
  return std::abs(ab - ba) <= SymmetryTolerance * std::sqrt(std::abs(aa * bb));
}

/// The result of the first pass: candidates for both eigenvalues.
struct FirstPass
{
  Candidate low, high;
  Index steps = 0;
  bool failed = false; ///< the preconditioner is not positive definite, or not finite
};

/// Steps until both candidates have converged or a limit is reached; checks them at increasing
/// intervals.
FirstPass findCandidates(
  Recurrence& recurrence, const ConditionOptions& options, EigensolverStoppingTest& test)
{
  FirstPass pass;
  Tridiagonal t;
  double scale = 0.0;
  Index nextCheck = FirstCheck;
  while (pass.steps < options.maximumIterations)
  {
    recurrence.step();
    if (recurrence.failed())
    {
      pass.failed = true;
      return pass;
    }
    ++pass.steps;
    t.diagonal.push_back(recurrence.alpha());
    scale = std::max({ scale, std::abs(recurrence.alpha()), recurrence.beta() });
    // If beta vanishes, the subspace is invariant, and its Ritz values are exact eigenvalues.
    const bool invariant = recurrence.beta() <= ZeroTolerance * scale;
    const bool stop =
      test.stop(static_cast<double>(pass.steps) / static_cast<double>(pass.steps + ManySteps));
    const bool last = invariant || stop || pass.steps == options.maximumIterations;
    if (pass.steps >= nextCheck || last)
    {
      const double beta = invariant ? 0.0 : recurrence.beta();
      update(pass.high, t, false, beta, options.tolerance, scale);
      update(pass.low, t, true, beta, options.tolerance, scale);
      // A check costs more with each step, so the intervals grow.
      nextCheck = pass.steps + std::max<Index>(4, pass.steps / 10);
      if (last || (pass.low.converged && pass.high.converged))
      {
        break;
      }
    }
    t.beside.push_back(recurrence.beta());
  }
  return pass;
}

/// Repeats the recurrence and accumulates the eigenvectors; false if it had to stop early.
bool gatherVectors(
  Recurrence& recurrence, const FirstPass& pass, EigensolverStoppingTest& test, Vec yLow, Vec yHigh)
{
  const std::vector<double>&low = pass.low.pair.vector, &high = pass.high.pair.vector;
  const std::size_t steps = std::max(low.size(), high.size());
  petsc(VecSet(yLow, 0.0));
  petsc(VecSet(yHigh, 0.0));
  // The start vector is the same, so the recurrence repeats exactly and its vectors need not be
  // stored.
  recurrence.restart();
  for (std::size_t k = 0; k < steps; ++k)
  {
    if (k < low.size())
    {
      petsc(VecAXPY(yLow, low[k], recurrence.v()));
    }
    if (k < high.size())
    {
      petsc(VecAXPY(yHigh, high[k], recurrence.v()));
    }
    if (test.stop(static_cast<double>(k) / static_cast<double>(steps)))
    {
      return false;
    }
    if (k + 1 < steps)
    {
      recurrence.step();
    }
  }
  return true;
}
}

//------------------------------------------------------------------------------
ExtremeEigenvalues lanczosExtremeEigenvalues(
  Mat matrix, PC preconditioner, const ConditionOptions& options, EigensolverStoppingTest& test)
{
  ExtremeEigenvalues extremes;
  extremes.smallest.method = extremes.largest.method = "Lanczos in the inner product of P";
  const auto failed = [&](const std::string& message) -> ExtremeEigenvalues
  {
    extremes.smallest.message = extremes.largest.message = message;
    return std::move(extremes);
  };
  if (!isSymmetric(matrix, preconditioner))
  {
    return failed(
      "The preconditioner is not symmetric: the eigenvalues of P^-1 A need not be real.");
  }
  Recurrence recurrence(matrix, preconditioner);
  // The second pass repeats the steps of the first, so each is half of the work.
  test.stage(0.0, 0.5);
  const FirstPass pass = findCandidates(recurrence, options, test);
  if (pass.failed)
  {
    return failed("The preconditioner is not positive definite, or not finite.");
  }
  // If the time limit is reached after the first pass, there are values but no vectors.
  bool gathered = false;
  if (!test.stopped())
  {
    PetscVector yLow, yHigh;
    petsc(MatCreateVecs(matrix, yLow.out(), yHigh.out()));
    test.stage(0.5, 1.0);
    gathered = gatherVectors(recurrence, pass, test, yLow, yHigh);
    if (gathered)
    {
      measure(matrix, preconditioner, yLow, pass.low, extremes.smallest);
      measure(matrix, preconditioner, yHigh, pass.high, extremes.largest);
    }
  }
  const std::array pairs = { std::make_pair(&extremes.smallest, &pass.low),
    std::make_pair(&extremes.largest, &pass.high) };
  for (const auto& [extreme, candidate] : pairs)
  {
    extreme->iterations = static_cast<int>(candidate->pair.vector.size());
    if (!gathered)
    {
      extreme->value = candidate->pair.value;
      extreme->bound = std::min(candidate->residual, candidate->estimate);
      extreme->found = std::isfinite(extreme->value) && std::isfinite(extreme->bound);
    }
    if (!candidate->converged && !test.stopped())
    {
      extreme->message = "Not converged after " + std::to_string(pass.steps) + " steps of Lanczos.";
    }
  }
  return extremes;
}
}
