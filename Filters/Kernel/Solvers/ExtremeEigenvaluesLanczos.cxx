#include "ExtremeEigenvalues.h"

#include "Tridiagonal.h"

namespace tautline
{
namespace
{
/// An eigenvalue below this times the largest is zero but for rounding.
constexpr double ZeroTolerance = 1e-13;
/// How unsymmetric the action of a preconditioner may be.
constexpr double SymmetryTolerance = 1e-7;
constexpr Index FirstCheck = 8;
constexpr Index ManySteps = 100; // half done, as far as progress tells

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
    petsc(VecAXPBYPCZ(this->W, -this->Alpha, -this->Beta, 1.0, this->V, this->Previous));
    std::swap(this->Previous, this->V);
    std::swap(this->V, this->W);
    this->normalize();
  }

private:
  /// V becomes the next vector, of norm 1 in P^-1; beta what it was.
  void normalize()
  {
    PetscReal square = 0.0;
    petsc(PCApply(this->Preconditioner, this->V, this->U));
    petsc(VecDot(this->V, this->U, &square));
    const double scale = std::max(std::abs(this->Alpha), this->Beta);
    this->Failed = !std::isfinite(square) || !std::isfinite(this->Alpha) ||
      square < -ZeroTolerance * scale * scale;
    this->Beta = std::sqrt(std::max(square, 0.0));
    if (this->Beta > 0.0 && !this->Failed)
    {
      petsc(VecScale(this->V, 1.0 / this->Beta));
      petsc(VecScale(this->U, 1.0 / this->Beta));
    }
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
 * What the first pass finds of an end. An eigenvalue lies within the residual r of the value. Where
 * eigenvalues crowd, r is far larger than the error; r^2 over the distance to the next Ritz value
 * (Kato-Temple) is far smaller as long as close eigenvalues have not come apart. So that is
 * believed only together with how far the value moved since half of the steps: convergence is at
 * least quadratic in their number (Kaniel-Paige), so that no more than a third of it is left.
 */
struct Candidate
{
  RitzPair pair;
  double residual = 0.0, estimate = 0.0; ///< of the error, as described
  bool converged = false;
  std::vector<std::pair<Index, double>> history; ///< steps and values
};

void update(
  Candidate& end, const Tridiagonal& t, bool smallest, double beta, double tolerance, double scale)
{
  if (end.converged)
  {
    return;
  }
  const auto steps = static_cast<Index>(t.diagonal.size());
  end.pair = ritzPair(t, smallest, beta);
  end.residual = beta * std::abs(end.pair.vector.back());
  end.estimate = end.residual;
  for (const auto& [before, value] : end.history)
  {
    if (2 * before <= steps)
    {
      end.estimate = std::max(end.pair.bound, std::abs(end.pair.value - value));
    }
  }
  end.history.emplace_back(steps, end.pair.value);
  end.converged = std::min(end.residual, end.estimate) <=
    std::max(tolerance * std::abs(end.pair.value), ZeroTolerance * scale);
}

/// The value and its bound from the gathered y = P x.
void measure(Mat matrix, PC preconditioner, const PetscVector& y, const Candidate& candidate,
  ExtremeEigenvalue& end)
{
  PetscVector x, r, z;
  petsc(VecDuplicate(y, x.out()));
  petsc(VecDuplicate(y, r.out()));
  petsc(VecDuplicate(y, z.out()));
  PetscReal energy = 0.0, mass = 0.0, square = 0.0;
  petsc(PCApply(preconditioner, y, x));
  petsc(MatMult(matrix, x, r));
  petsc(VecDot(x, r, &energy));
  petsc(VecDot(x, y, &mass));
  end.value = energy / mass;
  petsc(VecAXPY(r, -end.value, y));
  petsc(PCApply(preconditioner, r, z));
  petsc(VecDot(r, z, &square));
  const double residual = std::sqrt(std::max(square, 0.0) / mass);
  end.bound = std::min(residual, candidate.estimate + std::abs(end.value - candidate.pair.value));
  end.found = std::isfinite(end.value) && std::isfinite(end.bound);
  petsc(VecScale(x, 1.0 / std::sqrt(std::max(mass, std::numeric_limits<double>::min()))));
  end.vector = std::move(x);
}

/// Whether P^-1 is symmetric, as far as two vectors tell.
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
}

//------------------------------------------------------------------------------
void fillStartVector(Vec vector, std::uint64_t seed)
{
  PetscInt begin = 0, end = 0;
  double* values = nullptr;
  petsc(VecGetOwnershipRange(vector, &begin, &end));
  petsc(VecGetArrayWrite(vector, &values));
  for (PetscInt row = begin; row < end; ++row)
  {
    // splitmix64
    std::uint64_t z = (static_cast<std::uint64_t>(row) + 1 + (seed << 40)) * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
    values[row - begin] = static_cast<double>(z >> 11) * 0x1p-53 + 0.25;
  }
  petsc(VecRestoreArrayWrite(vector, &values));
}

ExtremeEigenvalues lanczosExtremeEigenvalues(
  Mat matrix, PC preconditioner, const ConditionOptions& options, SpectrumWatch& watch)
{
  ExtremeEigenvalues ends;
  ends.smallest.method = ends.largest.method = "Lanczos in the inner product of P";
  const auto give = [&](const std::string& message) -> ExtremeEigenvalues
  {
    ends.smallest.message = ends.largest.message = message;
    return std::move(ends);
  };
  if (!isSymmetric(matrix, preconditioner))
  {
    return give("The preconditioner is not symmetric: the eigenvalues of P^-1 A need not be real.");
  }
  Recurrence recurrence(matrix, preconditioner);
  Tridiagonal t;
  Candidate low, high;
  double scale = 0.0;
  Index steps = 0, nextCheck = FirstCheck;
  watch.stage(0.0, 0.5);
  while (steps < options.maximumIterations)
  {
    recurrence.step();
    if (recurrence.failed())
    {
      return give("The preconditioner is not positive definite, or not finite.");
    }
    ++steps;
    t.diagonal.push_back(recurrence.alpha());
    scale = std::max({ scale, std::abs(recurrence.alpha()), recurrence.beta() });
    const bool invariant = recurrence.beta() <= ZeroTolerance * scale;
    const bool stop =
      watch.stop(static_cast<double>(steps) / static_cast<double>(steps + ManySteps));
    const bool last = invariant || stop || steps == options.maximumIterations;
    if (steps >= nextCheck || last)
    {
      const double beta = invariant ? 0.0 : recurrence.beta();
      update(high, t, false, beta, options.tolerance, scale);
      update(low, t, true, beta, options.tolerance, scale);
      nextCheck = steps + std::max<Index>(4, steps / 10);
      if (last || (low.converged && high.converged))
      {
        break;
      }
    }
    t.beside.push_back(recurrence.beta());
  }

  // Second pass; without it, when time is up, there are the values but no vectors.
  bool gathered = !watch.stopped();
  PetscVector yLow, yHigh;
  if (gathered)
  {
    petsc(MatCreateVecs(matrix, yLow.out(), yHigh.out()));
    petsc(VecSet(yLow, 0.0));
    petsc(VecSet(yHigh, 0.0));
    watch.stage(0.5, 1.0);
    recurrence.restart();
  }
  const std::size_t longest = std::max(low.pair.vector.size(), high.pair.vector.size());
  for (std::size_t k = 0; k < longest && gathered; ++k)
  {
    if (k < low.pair.vector.size())
    {
      petsc(VecAXPY(yLow, low.pair.vector[k], recurrence.v()));
    }
    if (k < high.pair.vector.size())
    {
      petsc(VecAXPY(yHigh, high.pair.vector[k], recurrence.v()));
    }
    gathered = !watch.stop(static_cast<double>(k) / static_cast<double>(longest));
    if (k + 1 < longest && gathered)
    {
      recurrence.step();
    }
  }
  if (gathered)
  {
    measure(matrix, preconditioner, yLow, low, ends.smallest);
    measure(matrix, preconditioner, yHigh, high, ends.largest);
  }
  for (const auto& [end, candidate] :
    { std::make_pair(&ends.smallest, &low), std::make_pair(&ends.largest, &high) })
  {
    end->iterations = static_cast<int>(candidate->pair.vector.size());
    if (!gathered)
    {
      end->value = candidate->pair.value;
      end->bound = std::min(candidate->residual, candidate->estimate);
      end->found = std::isfinite(end->value) && std::isfinite(end->bound);
    }
    if (!candidate->converged && !watch.stopped())
    {
      end->message = "Not converged after " + std::to_string(steps) + " steps of Lanczos.";
    }
  }
  return ends;
}
}
