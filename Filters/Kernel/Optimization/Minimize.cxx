// SPDX-License-Identifier: BSD-3-Clause
#include "Minimize.h"

#include "tautline/Core/LimitedMemory.h"
#include "tautline/Core/LineSearch.h"

#include <cmath>
#include <utility>

namespace tautline
{
namespace
{
using Vector = std::vector<double>;

// Line search.
constexpr double curvatureQuasiNewton = 0.9; // fraction of the slope that may remain
constexpr double curvatureConjugate = 0.2;
constexpr double curvatureNewton = 0.3; // above it, a longer step is tried: cheap compared with
                                        // the direction
constexpr double shortening = 0.5, lengthening = 4; // of Newton's first trial step
constexpr int maxTrials = 40;
constexpr double longestExtension = 100; // of the first trial step
constexpr double extendAtLeast = 1.5, extendAtMost = 5.0;
constexpr double bracketMargin = 0.1; // fraction of a bracket at its ends that interpolation avoids
constexpr double bracketEnd = 1e-12;
// relative decrease of the value targeted by the very first step
constexpr double firstDecrease = 0.1;

// The number of consecutive iterations that only change the value by rounding before stopping
// without progress.
constexpr int maxStalled = 3;
constexpr double roundingOfLineSearch = 1e-15;
constexpr int gainWindow = 20; // iterations, see MinimizeOptions::leastGain

// Directions.
constexpr double minDescent = 1e-8;    // cosine between -g and a direction
constexpr double restartOverlap = 0.2; // of successive gradients (Powell)
// Early steps change the Hessian most: linearize() at iterations 0, 1, 3, 9, ...
constexpr int refreshGrowth = 2;
constexpr int maxInnerIterations = 5000;
// The test of Nash and Sofer: the fraction of the model decrease that one more inner iteration
// would add.
constexpr double innerShare = 0.3;
// If the Hessian has nonpositive curvature, it is shifted by this times the shift that would make
// it flat, and less in the next iteration.
constexpr double shiftGrowth = 4, shiftDecay = 0.3;
constexpr double smallestShift = 0.01;
constexpr int maxShifts = 8;            // in an iteration
constexpr double innerResidual = 1e-12; // relative, for the squared preconditioned residual
constexpr double differenceStep = 1e-7;

/// The common part of conjugate gradients, L-BFGS and Newton: the point, its gradient, and the line
/// search.
class Minimizer
{
public:
  Minimizer(SmoothFunction& function, double* x, const MinimizeOptions& options)
    : Function(function)
    , Options(options)
    , Size(function.size())
    , Algebra(this->Size, options.threads, LaneOrder::Sequential, options.group)
    , TotalSize(Algebra.totalSize())
    , Memory(this->Algebra)
    , X(x)
    , G(this->Size)
    , D(this->Size)
  {
  }

  MinimizeResult run();

private:
  struct Trial
  {
    double t = 0, f = HUGE_VAL, slope = 0;
  };

  double dot(const Vector& a, const Vector& b) const
  {
    return this->Algebra.dot(a.data(), b.data());
  }
  void evaluate(Trial& trial);
  void accept(const Trial& trial);
  bool search(double first, double curvature, bool strong);
  bool searchNewton();
  double firstStep() const;
  /// z = P r, or r.
  bool precondition(const Vector& r, Vector& z);
  bool steepest();
  void quasiNewton();
  void conjugate();
  void newton();
  double solveNewton(double shift);
  void hessianTimes(const Vector& d, Vector& product);
  bool iterate();
  bool isNear();
  bool crawls();

  SmoothFunction& Function;
  const MinimizeOptions& Options;
  std::size_t Size;
  VectorAlgebra Algebra;
  Index TotalSize;      ///< on all ranks
  LimitedMemory Memory; ///< of L-BFGS
  double* X;
  Vector G, D;                    ///< gradient and direction
  Vector OldG, TrialX, TrialG, Z; ///< gradient before the last step; work space
  double F = HUGE_VAL, Norm = 0, FirstNorm = 0, Slope = 0;
  double Step = 0, StepSlope = 0; ///< of the last step
  double First = 1;               ///< first trial step along D
  double FirstNewton = 1;         ///< first trial step along Newton's direction
  double Shift = 0;               ///< of Newton's system, in units of the preconditioner
  /// decrease of the step predicted by a quadratic model; 0: unknown
  double Promised = HUGE_VAL;
  double FirstF = 0;
  Vector Values; ///< values after each Newton iteration
  bool Preconditioned = false;
  bool Fresh = true; ///< D does not use the history
  MinimizeResult Result;
};

//------------------------------------------------------------------------------
void Minimizer::evaluate(Trial& trial)
{
  const double t = trial.t;
  this->Algebra.each([&](Index i) { this->TrialX[i] = this->X[i] + t * this->D[i]; });
  trial.f = this->Function.valueAndGradient(this->TrialX.data(), this->TrialG.data());
  trial.slope = std::isfinite(trial.f) ? this->dot(this->TrialG, this->D) : 0.0;
  ++this->Result.evaluations;
  if (!std::isfinite(trial.f) || !std::isfinite(trial.slope))
  {
    trial.f = HUGE_VAL;
  }
}

void Minimizer::accept(const Trial& trial)
{
  this->Algebra.each([&](Index i) { this->X[i] = this->TrialX[i]; });
  std::swap(this->OldG, this->G);
  std::swap(this->G, this->TrialG);
  this->F = trial.f;
  this->Step = trial.t;
  this->StepSlope = this->Slope;
}

/// The minimum of the cubic through two values and slopes, well inside the bracket.
double interpolate(double lo, double flo, double slo, double hi, double fhi, double shi)
{
  const double width = hi - lo;
  double t = lo + 0.5 * width;
  if (std::isfinite(fhi))
  {
    const double d1 = slo + shi - 3 * (fhi - flo) / width;
    const double d2 = std::sqrt(d1 * d1 - slo * shi);
    const double cubic = hi - width * (shi + d2 - d1) / (shi - slo + 2 * d2);
    t = std::isfinite(cubic) ? cubic : t;
  }
  return std::min(std::max(t, lo + bracketMargin * width), hi - bracketMargin * width);
}

//------------------------------------------------------------------------------
/**
 * @brief Searches along D for a point that satisfies the Wolfe conditions. The bracket [lo, hi]
 * always contains one: at lo, the value is low enough but decreases too steeply; at hi, it is too
 * high or increases too steeply.
 */
bool Minimizer::search(double first, double curvature, bool strong)
{
  const double limit =
    this->Function.largestStep(this->X, this->D.data(), longestExtension * first);
  if (!(limit > 0) || !(first > 0))
  {
    return false;
  }
  Trial lo, hi, best, now;
  lo.f = this->F;
  lo.slope = this->Slope;
  hi.t = HUGE_VAL;
  now.t = std::min(first, limit);
  bool found = false;
  for (int trial = 0; trial < maxTrials && !found; ++trial)
  {
    this->evaluate(now);
    const bool low = now.f <= this->F + ArmijoConstant * now.t * this->Slope && now.f <= this->F;
    if (low && now.f < best.f)
    {
      best = now;
    }
    if (!low || (strong && now.slope > -curvature * this->Slope))
    {
      hi = now;
    }
    else if (now.slope < curvature * this->Slope)
    {
      if (now.t >= limit)
      {
        break;
      }
      const double secant = now.slope > lo.slope
        ? now.t + (now.t - lo.t) * now.slope / (lo.slope - now.slope)
        : HUGE_VAL;
      const double extended =
        std::min(std::max(secant, extendAtLeast * now.t), extendAtMost * now.t);
      lo = now;
      now.t = std::min(extended, limit);
    }
    else
    {
      found = true;
      break;
    }
    if (hi.t < HUGE_VAL)
    {
      if (hi.t - lo.t <= bracketEnd * hi.t)
      {
        break;
      }
      now.t = interpolate(lo.t, lo.f, lo.slope, hi.t, hi.f, hi.slope);
    }
  }
  if (!found && best.t > 0 && best.t != now.t)
  {
    this->evaluate(best);
  }
  if (!found && best.t == 0)
  {
    return false;
  }
  this->accept(found ? now : best);
  return true;
}

/**
 * @brief Searches along Newton's direction: first with the full step, or a shorter one if the last
 * had to be short; then shorter until the value is low enough, or longer while much of the slope
 * remains and the value decreases. For meshes of flat elements, the full step only multiplies their
 * height by a constant.
 */
bool Minimizer::searchNewton()
{
  const double limit =
    this->Function.largestStep(this->X, this->D.data(), longestExtension * this->FirstNewton);
  if (!(limit > 0))
  {
    return false;
  }
  Trial now;
  now.t = std::min(this->FirstNewton, limit);
  const auto low = [&]
  {
    this->evaluate(now);
    return now.f <= this->F + ArmijoConstant * now.t * this->Slope && now.f <= this->F;
  };
  int trials = 1;
  for (; !low(); ++trials)
  {
    if (trials == maxTrials)
    {
      return false;
    }
    now.t *= shortening;
  }
  const double whole = this->Slope;
  double t = now.t;
  this->accept(now);
  const bool shortened = trials > 1;
  while (!shortened && now.slope < curvatureNewton * whole && trials < maxTrials && t < limit)
  {
    // Secant step to where the slope would vanish if it changed linearly.
    const double secant = now.slope / (whole - now.slope) * t;
    Trial next;
    next.t =
      std::min({ std::max(secant, (extendAtLeast - 1) * t), (extendAtMost - 1) * t, limit - t });
    this->Slope = now.slope;
    now = next;
    ++trials;
    if (!low() || now.slope > -curvatureNewton * whole)
    {
      break;
    }
    t += now.t;
    this->accept(now);
  }
  this->FirstNewton = std::min(1.0, lengthening * t);
  return true;
}

/// The very first step: aims at a somewhat smaller value, or has length 1 if the value has no
/// scale.
double Minimizer::firstStep() const
{
  return this->F != 0 ? firstDecrease * std::abs(this->F) / std::abs(this->Slope)
                      : 1 / std::sqrt(std::abs(this->Slope));
}

//------------------------------------------------------------------------------
bool Minimizer::precondition(const Vector& r, Vector& z)
{
  z.resize(this->Size);
  this->Preconditioned = this->Function.precondition(r.data(), z.data());
  if (!this->Preconditioned)
  {
    z = r;
  }
  return this->Preconditioned;
}

/// Along the preconditioned gradient.
bool Minimizer::steepest()
{
  const bool scaled = this->precondition(this->G, this->Z);
  this->Algebra.each([&](Index i) { this->D[i] = -this->Z[i]; });
  this->Slope = this->dot(this->G, this->D);
  this->First = scaled ? 1.0 : this->firstStep();
  this->Promised = scaled ? -0.5 * this->Slope : 0.0;
  this->Fresh = true;
  return this->Slope < 0 && std::isfinite(this->Slope);
}

/// The direction of L-BFGS.
void Minimizer::quasiNewton()
{
  this->Slope = this->Memory.direction(this->G, this->D,
    [this](Vector& q)
    {
      // Use the preconditioner, or the identity, scaled to match the newest pair.
      const LimitedMemory::Pair& newest = this->Memory.newest();
      double gamma = newest.sy / newest.yy;
      if (this->precondition(newest.y, this->Z))
      {
        gamma = newest.sy / this->dot(newest.y, this->Z);
        this->precondition(q, this->Z);
        std::swap(q, this->Z);
      }
      return gamma;
    });
  this->First = 1;
  this->Promised = -0.5 * this->Slope;
  this->Fresh = false;
}

//------------------------------------------------------------------------------
void Minimizer::conjugate()
{
  // With z = P g: beta is z.g / z'.g' (Fletcher-Reeves) or z.(g - g') / z'.g', at least 0
  // (Polak-Ribiere+).
  this->precondition(this->OldG, this->Z);
  const double before = this->dot(this->OldG, this->Z);
  this->precondition(this->G, this->Z);
  const double now = this->dot(this->G, this->Z), overlap = this->dot(this->OldG, this->Z);
  const bool fletcher = this->Options.method == Optimizer::ConjugateGradientFletcherReeves;
  double beta = std::max(0.0, (fletcher ? now : now - overlap) / before);
  if (std::abs(overlap) > restartOverlap * now)
  {
    beta = 0;
  }
  this->Slope = this->Algebra.sum(
    [&](Index i)
    {
      this->D[i] = beta * this->D[i] - this->Z[i];
      return this->D[i] * this->G[i];
    });
  // Scale the first trial step by the ratio of slopes.
  this->First = this->Step * this->StepSlope / this->Slope;
  this->Promised = this->Preconditioned ? 0.5 * now : 0.0;
  this->Fresh = beta == 0;
}

//------------------------------------------------------------------------------
void Minimizer::hessianTimes(const Vector& d, Vector& product)
{
  if (this->Function.hessianTimes(d.data(), product.data()))
  {
    return;
  }
  // Use differences of gradients on the allowed side.
  const double xx = this->Algebra.dot(this->X, this->X);
  const double step = differenceStep * std::max(1.0, std::sqrt(xx)) / std::sqrt(this->dot(d, d));
  const double t = 0.5 * this->Function.largestStep(this->X, d.data(), 2 * step);
  this->Algebra.each([&](Index i) { this->TrialX[i] = this->X[i] + t * d[i]; });
  const double f = this->Function.valueAndGradient(this->TrialX.data(), product.data());
  ++this->Result.evaluations;
  const bool good = std::isfinite(f) && t > 0;
  this->Algebra.each([&](Index i) { product[i] = good ? (product[i] - this->G[i]) / t : 0.0; });
}

/**
 * @brief Conjugate gradients on (H + shift M) p = -g with the preconditioner M, until the model
 * hardly decreases anymore. D is the step.
 * @return 0, or the shift required by the first direction of nonpositive curvature; D is then
 * unchanged
 */
double Minimizer::solveNewton(double shift)
{
  Vector p(this->Size, 0.0), r(this->G), d(this->Size), md(this->Size), product(this->Size);
  this->precondition(r, this->Z);
  double rz = this->dot(r, this->Z), model = 0;
  const double first = rz;
  // M d follows from the residuals: M need not be applied.
  this->Algebra.each(
    [&](Index i)
    {
      d[i] = -this->Z[i];
      md[i] = -r[i];
    });
  this->Promised = HUGE_VAL;
  bool complete = false;
  const int maxInner = static_cast<int>(std::min<Index>(2 * this->TotalSize, maxInnerIterations));
  for (int i = 1; i <= maxInner && !complete; ++i)
  {
    this->hessianTimes(d, product);
    const double dmd = this->dot(d, md), unshifted = this->dot(d, product);
    const double curvature = unshifted + shift * dmd;
    if (!(curvature > 0) || !std::isfinite(rz / curvature))
    {
      const double flat = std::max(shift, -unshifted / dmd);
      return std::isfinite(flat) && dmd > 0 ? std::max(smallestShift, shiftGrowth * flat)
                                            : HUGE_VAL;
    }
    const double a = rz / curvature, decrease = 0.5 * a * rz;
    this->Algebra.each(
      [&](Index k)
      {
        p[k] += a * d[k];
        r[k] += a * (product[k] + shift * md[k]);
      });
    model += decrease;
    complete = i * decrease <= innerShare * model;
    if (complete)
    {
      break;
    }
    this->precondition(r, this->Z);
    // The preconditioner may change a little with the residual: flexible conjugate gradients.
    const double next = this->dot(r, this->Z);
    const double change =
      this->Algebra.sum([&](Index k) { return this->Z[k] * (product[k] + shift * md[k]); });
    const double beta = a * change / rz;
    complete = next >= 0 && next <= innerResidual * first;
    if (!(next > 0))
    {
      break; // only rounding remains, or the preconditioner is unsuitable
    }
    if (this->Options.outOfTime && this->Options.outOfTime())
    {
      break;
    }
    rz = next;
    this->Algebra.each(
      [&](Index k)
      {
        d[k] = beta * d[k] - this->Z[k];
        md[k] = beta * md[k] - r[k];
      });
  }
  this->Promised = complete && shift == 0 ? model : HUGE_VAL;
  std::swap(this->D, p);
  this->Slope = this->dot(this->G, this->D);
  this->First = 1;
  this->Fresh = false;
  return 0;
}

/// The direction of Newton's method, with a shift if the Hessian has nonpositive curvature.
void Minimizer::newton()
{
  for (int attempt = 0; attempt < maxShifts; ++attempt)
  {
    const double wanted = this->solveNewton(this->Shift);
    if (wanted == 0)
    {
      this->Shift = this->Shift * shiftDecay > smallestShift ? this->Shift * shiftDecay : 0.0;
      return;
    }
    if (!std::isfinite(wanted))
    {
      break;
    }
    this->Shift = wanted;
  }
  this->steepest();
}

//------------------------------------------------------------------------------
/// One direction and one step along it; a direction that fails is replaced by the steepest once.
bool Minimizer::iterate()
{
  const Optimizer method = this->Options.method;
  const bool conjugateGradient = method == Optimizer::ConjugateGradientFletcherReeves ||
    method == Optimizer::ConjugateGradientPolakRibiere;
  const double curvature = conjugateGradient ? curvatureConjugate : curvatureQuasiNewton;
  if (method == Optimizer::NewtonConjugateGradient)
  {
    this->newton();
  }
  else if (conjugateGradient && this->Result.iterations > 0)
  {
    this->conjugate();
  }
  else if (!conjugateGradient && !this->Memory.empty())
  {
    this->quasiNewton();
  }
  else if (!this->steepest())
  {
    return false;
  }
  const double length = std::sqrt(this->dot(this->D, this->D));
  // Newton's direction is perpendicular to the gradient, up to rounding, if some elements are far
  // flatter than others.
  const bool descent =
    method == Optimizer::NewtonConjugateGradient || this->Slope < -minDescent * length * this->Norm;
  bool moved = (descent || this->Fresh) && this->Slope < 0 && std::isfinite(length) &&
    (method == Optimizer::NewtonConjugateGradient && !this->Fresh
        ? this->searchNewton()
        : this->search(this->First, curvature, conjugateGradient));
  if (!moved && !this->Fresh)
  {
    this->Memory.clear();
    moved = this->steepest() && this->search(this->First, curvature, conjugateGradient);
  }
  if (method == Optimizer::NewtonConjugateGradient && this->Fresh)
  {
    this->Promised = HUGE_VAL; // not predicted by Newton's model
  }
  if (moved && method == Optimizer::LimitedMemoryBFGS)
  {
    this->Memory.add(this->Step, this->D.data(), this->OldG.data(), this->G.data());
  }
  return moved;
}

//------------------------------------------------------------------------------
/// Whether the predicted gain is small, according to the last direction and a preconditioner
/// computed here; see MinimizeOptions::decrement. If not, the directions are restarted.
bool Minimizer::isNear()
{
  const double little = std::max(
    this->Options.decrement * std::abs(this->F), roundingOfLineSearch * std::abs(this->FirstF));
  if (this->Options.decrement == 0 || this->Options.method == Optimizer::NewtonConjugateGradient)
  {
    return true;
  }
  if (this->Promised <= little)
  {
    this->Function.linearize(this->X);
    this->Memory.clear();
    if (!this->precondition(this->G, this->Z) || 0.5 * this->dot(this->G, this->Z) <= little)
    {
      return true;
    }
  }
  return false;
}

//------------------------------------------------------------------------------
/// See MinimizeOptions::leastGain.
bool Minimizer::crawls()
{
  const double least = this->Options.leastGain * std::abs(this->F);
  this->Values.push_back(this->F);
  if (this->Values.size() <= gainWindow)
  {
    return false;
  }
  const double gain = this->Values[this->Values.size() - 1 - gainWindow] - this->F;
  return (gain < least) && (this->Promised > least);
}

//------------------------------------------------------------------------------
MinimizeResult Minimizer::run()
{
  this->F = this->Function.valueAndGradient(this->X, this->G.data());
  ++this->Result.evaluations;
  this->Result.value = std::isnan(this->F) ? HUGE_VAL : this->F;
  if (this->TotalSize == 0 || !std::isfinite(this->F))
  {
    this->Result.reason =
      this->TotalSize == 0 ? StopReason::NoFreeVertices : StopReason::NoProgress;
    return this->Result;
  }
  for (Vector* work : { &this->OldG, &this->TrialX, &this->TrialG, &this->Z })
  {
    work->resize(this->Size);
  }
  this->FirstF = this->F;
  this->Norm = this->FirstNorm = std::sqrt(this->dot(this->G, this->G));
  this->Result.gradientNorm = this->Norm;
  if (this->FirstNorm == 0 || !std::isfinite(this->FirstNorm))
  {
    this->Result.reason = this->FirstNorm == 0 ? StopReason::GradientNorm : StopReason::NoProgress;
    return this->Result;
  }
  const bool everyTime = this->Options.method == Optimizer::NewtonConjugateGradient;
  int stalled = 0, next = 0;
  while (this->Result.iterations < this->Options.maximumIterations)
  {
    if (everyTime || this->Result.iterations == next)
    {
      this->Function.linearize(this->X);
      if (this->Preconditioned)
      {
        this->Memory.clear(); // its pairs belong to the old preconditioner
      }
      next = this->Result.iterations +
        std::min(std::max(1, refreshGrowth * this->Result.iterations), this->Options.refresh);
    }
    const double before = this->F;
    this->Promised = HUGE_VAL;
    const bool moved = this->iterate();
    this->Norm = std::sqrt(this->dot(this->G, this->G));
    this->Result.gradientNorm = this->Norm;
    this->Result.value = this->F;
    if (!moved)
    {
      this->Result.reason = StopReason::NoProgress;
      return this->Result;
    }
    ++this->Result.iterations;
    stalled = before - this->F <= roundingOfLineSearch * std::abs(this->F) ? stalled + 1 : 0;
    if (this->Options.observer &&
      !this->Options.observer(this->Result.iterations, this->F, this->Norm, this->X))
    {
      this->Result.reason = StopReason::Aborted;
      return this->Result;
    }
    const bool flat = this->Norm <= this->Options.gradientNorm * this->FirstNorm;
    const bool slow = this->Options.relativeChange > 0 &&
      before - this->F <= this->Options.relativeChange * std::abs(this->F);
    const bool near = (flat || slow) && this->isNear();
    if (this->Norm == 0 || (flat && near))
    {
      this->Result.reason = StopReason::GradientNorm;
      return this->Result;
    }
    const bool crawls = everyTime && this->crawls();
    if (stalled == maxStalled || crawls)
    {
      this->Result.reason = StopReason::NoProgress;
      return this->Result;
    }
    if ((everyTime && this->Promised <= this->Options.decrement * std::abs(this->F)) ||
      (slow && near))
    {
      this->Result.reason = StopReason::RelativeChange;
      return this->Result;
    }
  }
  this->Result.reason = StopReason::IterationLimit;
  return this->Result;
}
}

//------------------------------------------------------------------------------
MinimizeResult minimize(SmoothFunction& function, double* x, const MinimizeOptions& options)
{
  if (!isGlobal(options.method))
  {
    throw Error("This optimizer works on one vertex at a time; choose a global one.");
  }
  if (options.maximumIterations < 0 || options.refresh < 1 || !(options.gradientNorm >= 0) ||
    !(options.relativeChange >= 0) || !(options.decrement >= 0))
  {
    throw Error("Iterations and tolerances must be at least 0.");
  }
  return Minimizer(function, x, options).run();
}
}
