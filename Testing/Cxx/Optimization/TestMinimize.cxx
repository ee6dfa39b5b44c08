// SPDX-License-Identifier: BSD-3-Clause
// The global minimizers on functions whose minima are known.
#include "Registry.h"
#include "tautline/Optimization/Minimize.h"

#include <limits>
#include <numeric>

using namespace tautline;

namespace
{
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Optimizer methods[] = { Optimizer::ConjugateGradientFletcherReeves,
  Optimizer::ConjugateGradientPolakRibiere, Optimizer::LimitedMemoryBFGS,
  Optimizer::NewtonConjugateGradient };
using Vector = std::vector<double>;

const char* nameOf(Optimizer method)
{
  return method == Optimizer::ConjugateGradientFletcherReeves ? "Fletcher-Reeves"
    : method == Optimizer::ConjugateGradientPolakRibiere      ? "Polak-Ribiere+"
    : method == Optimizer::LimitedMemoryBFGS                  ? "L-BFGS"
                                                              : "Newton";
}

/// Rosenbrock's valley in each pair of variables; 0 at (1, 1, ...).
struct Rosenbrock : SmoothFunction
{
  std::size_t n;
  explicit Rosenbrock(std::size_t size)
    : n(size)
  {
  }
  std::size_t size() const override { return this->n; }
  double valueAndGradient(const double* x, double* g) override
  {
    double f = 0;
    for (std::size_t i = 0; i < this->n; i += 2)
    {
      const double a = x[i + 1] - x[i] * x[i], b = 1 - x[i];
      f += 100 * a * a + b * b;
      g[i] = -400 * a * x[i] - 2 * b;
      g[i + 1] = 200 * a;
    }
    return f;
  }
  Vector start() const
  {
    Vector x(this->n);
    for (std::size_t i = 0; i < this->n; ++i)
    {
      // Not the same in each pair, or all are one.
      x[i] = (i % 2 ? 1.0 : -1.2) + 0.1 * std::sin(static_cast<double>(i));
    }
    return x;
  }
};

/// (x - a)^t H (x - a) / 2 with H = Q D Q, Q a reflection, D from 1 to `condition`.
struct Quadratic : SmoothFunction
{
  Vector d, a, u;
  bool knowsHessian = false, preconditioned = false;
  int linearized = 0;
  Quadratic(std::size_t n, double condition)
    : d(n)
    , a(n)
    , u(n)
  {
    double length = 0;
    for (std::size_t i = 0; i < n; ++i)
    {
      const double t = static_cast<double>(i) / (static_cast<double>(n) - 1);
      this->d[i] = std::pow(condition, t);
      this->a[i] = std::cos(7.0 * t) + 2;
      this->u[i] = std::sin(0.3 * static_cast<double>(i) + 1);
      length += this->u[i] * this->u[i];
    }
    for (double& x : this->u)
    {
      x /= std::sqrt(length);
    }
  }
  std::size_t size() const override { return this->d.size(); }
  /// Q diag(e) Q v
  Vector times(const Vector& e, Vector v) const
  {
    auto reflect = [&]
    {
      const double c = 2 * std::inner_product(v.begin(), v.end(), this->u.begin(), 0.0);
      for (std::size_t i = 0; i < v.size(); ++i)
      {
        v[i] -= c * this->u[i];
      }
    };
    reflect();
    std::transform(v.begin(), v.end(), e.begin(), v.begin(), std::multiplies<>());
    reflect();
    return v;
  }
  double valueAndGradient(const double* x, double* g) override
  {
    Vector r(x, x + this->size());
    std::transform(r.begin(), r.end(), this->a.begin(), r.begin(), std::minus<>());
    const Vector hr = this->times(this->d, r);
    std::copy(hr.begin(), hr.end(), g);
    return 0.5 * std::inner_product(r.begin(), r.end(), hr.begin(), 0.0);
  }
  void linearize(const double*) override { ++this->linearized; }
  bool hessianTimes(const double* v, double* product) override
  {
    const Vector h = this->times(this->d, Vector(v, v + this->size()));
    std::copy(h.begin(), h.end(), product);
    return this->knowsHessian;
  }
  bool precondition(const double* r, double* z) override
  {
    Vector inverse(this->size());
    // Right up to a factor between 0.5 and 2.
    for (std::size_t i = 0; i < inverse.size(); ++i)
    {
      inverse[i] = std::exp2(std::sin(static_cast<double>(i))) / this->d[i];
    }
    const Vector h = this->times(inverse, Vector(r, r + this->size()));
    std::copy(h.begin(), h.end(), z);
    return this->preconditioned;
  }
};

/// sum c_i x_i - ln(1 - x_i^2): infinite outside |x_i| < 1; counts its evaluations.
struct Barrier : SmoothFunction
{
  Vector c;
  bool knowsSteps;
  int outside = 0;
  Barrier(std::size_t n, bool steps)
    : c(n)
    , knowsSteps(steps)
  {
    for (std::size_t i = 0; i < n; ++i)
    {
      this->c[i] = 30 * std::sin(static_cast<double>(i + 1));
    }
  }
  std::size_t size() const override { return this->c.size(); }
  double valueAndGradient(const double* x, double* g) override
  {
    double f = 0;
    for (std::size_t i = 0; i < this->size(); ++i)
    {
      if (!(std::abs(x[i]) < 1))
      {
        ++this->outside;
        std::fill(g, g + this->size(), std::nan("")); // must not be used
        return infinity;
      }
      f += this->c[i] * x[i] - std::log1p(-x[i] * x[i]);
      g[i] = this->c[i] + 2 * x[i] / (1 - x[i] * x[i]);
    }
    return f;
  }
  double largestStep(const double* x, const double* d, double wanted) override
  {
    for (std::size_t i = 0; this->knowsSteps && i < this->size(); ++i)
    {
      if (d[i] != 0)
      {
        wanted = std::min(wanted, 0.99 * (1 - x[i] * (d[i] > 0 ? 1 : -1)) / std::abs(d[i]));
      }
    }
    return wanted;
  }
  /// c + 2 x / (1 - x^2) = 0
  double solution(std::size_t i) const
  {
    return -this->c[i] / (1 + std::sqrt(1 + this->c[i] * this->c[i]));
  }
};

/// Many local minima, NaN beyond 10, flat far out.
struct Rough : SmoothFunction
{
  std::size_t size() const override { return 50; }
  double valueAndGradient(const double* x, double* g) override
  {
    double f = 0;
    for (int i = 0; i < 50; ++i)
    {
      f += std::abs(x[i]) > 10 ? std::nan("") : std::sin(5 * x[i]) - std::exp(-x[i] * x[i]);
      g[i] = 5 * std::cos(5 * x[i]) + 2 * x[i] * std::exp(-x[i] * x[i]);
    }
    return f;
  }
};

MinimizeOptions optionsFor(Optimizer method, int iterations, double gradientNorm)
{
  return TAUTLINE_CHANGED(MinimizeOptions(), method = method, maximumIterations = iterations,
    gradientNorm = gradientNorm, threads = 1);
}

void report(const char* what, Optimizer method, const MinimizeResult& m)
{
  std::cout << std::setprecision(4) << what << ", " << nameOf(method) << ": " << m.iterations
            << " iterations, " << m.evaluations << " evaluations, value " << m.value << "\n";
}

double distance(const Vector& a, const Vector& b)
{
  return largestOf<double>(0, a.size(), [&](std::size_t i) { return std::abs(a[i] - b[i]); });
}

/// Sum of exp(a_i x_i) - x_i with a_i from 1 to 3: convex, and no quadratic.
struct Convex : SmoothFunction
{
  std::size_t size() const override { return 12; }
  double valueAndGradient(const double* x, double* g) override
  {
    double f = 0;
    for (std::size_t i = 0; i < this->size(); ++i)
    {
      const double a = 1 + 2.0 * static_cast<double>(i) / 11, e = std::exp(a * x[i]);
      f += e - x[i];
      g[i] = a * e - 1;
    }
    return f;
  }
};

/// Each direction is -g + beta d with the formula of the method, not of the other one.
TAUTLINE_PART(testConjugateDirections)
{
  const auto dot = [](const Vector& a, const Vector& b)
  { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); };
  const auto combined = [](double p, const Vector& a, double q, const Vector& b)
  {
    Vector sum(a.size());
    std::transform(a.begin(), a.end(), b.begin(), sum.begin(),
      [=](double x, double y) { return p * x + q * y; });
    return sum;
  };
  for (Optimizer method :
    { Optimizer::ConjugateGradientFletcherReeves, Optimizer::ConjugateGradientPolakRibiere })
  {
    const Context name(nameOf(method));
    Convex f;
    Vector x(f.size());
    for (std::size_t i = 0; i < x.size(); ++i)
    {
      x[i] = std::cos(static_cast<double>(i));
    }
    std::vector<Vector> points(1, x);
    MinimizeOptions options = optionsFor(method, 6, 0);
    options.observer = [&](int, double, double, const double* now)
    {
      points.emplace_back(now, now + f.size());
      return true;
    };
    minimize(f, x.data(), options);
    Vector before(f.size()), now(f.size()), direction;
    int telling = 0; // steps whose direction would be another by the other formula
    for (std::size_t k = 0; k + 1 < points.size(); ++k)
    {
      f.valueAndGradient(points[k].data(), now.data());
      const Vector step = combined(1, points[k + 1], -1, points[k]);
      const auto sine = [&](const Vector& d)
      {
        const Vector off = combined(1, step, -dot(step, d) / dot(d, d), d);
        return std::sqrt(dot(off, off) / dot(step, step));
      };
      const double overlap = dot(before, now), square = dot(now, now), last = dot(before, before);
      // Powell's restart where successive gradients are far from orthogonal.
      const bool restart = k == 0 || std::abs(overlap) > 0.2 * square;
      const double fletcherReeves = restart ? 0 : square / last;
      const double polakRibiere = restart ? 0 : std::max(0.0, (square - overlap) / last);
      direction = direction.empty() ? Vector(f.size()) : direction;
      const Vector byFletcher = combined(-1, now, fletcherReeves, direction);
      const Vector byPolak = combined(-1, now, polakRibiere, direction);
      const bool fletcher = method == Optimizer::ConjugateGradientFletcherReeves;
      direction = fletcher ? byFletcher : byPolak;
      TAUTLINE_CHECK(sine(direction) < 1e-6);
      telling += sine(fletcher ? byPolak : byFletcher) > 1e-3;
      before = now;
    }
    TAUTLINE_CHECK(telling > 0);
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testRosenbrock)
{
  for (std::size_t n : { 2, 100, 10000 })
  {
    for (Optimizer method : methods)
    {
      const Context name(std::string(nameOf(method)) + ", " + std::to_string(n) + " variables");
      Rosenbrock f(n);
      Vector x = f.start(), first;
      double last = infinity;
      MinimizeOptions options = optionsFor(method, 2000, 1e-9);
      options.observer = [&](int, double value, double norm, const double*)
      {
        TAUTLINE_CHECK(value <= last && norm >= 0);
        last = value;
        return true;
      };
      const MinimizeResult m = minimize(f, x.data(), options);
      report(("Rosenbrock " + std::to_string(n)).c_str(), method, m);
      TAUTLINE_CHECK(m.reason == StopReason::GradientNorm);
      TAUTLINE_CHECK(distance(x, Vector(n, 1.0)) < 1e-5);
      TAUTLINE_CHECK_EQUAL(m.value, last);
      // L-BFGS on 100 variables: 142 to 284 from 200 starts that differ in the last digits.
      const bool limitedMemory = method == Optimizer::LimitedMemoryBFGS;
      TAUTLINE_CHECK(m.iterations <= (limitedMemory && n == 100 ? 400 : 250));
      if (limitedMemory)
      {
        TAUTLINE_CHECK(m.evaluations <= 1.35 * m.iterations + 5);
      }
      // The same bits for any number of threads.
      for (int threads : { 2, 4 })
      {
        Vector again = f.start();
        options.threads = threads;
        last = infinity;
        TAUTLINE_CHECK_EQUAL(minimize(f, again.data(), options).evaluations, m.evaluations);
        TAUTLINE_CHECK(again == x);
      }
    }
  }
}

TAUTLINE_PART(testQuadratic)
{
  for (Optimizer method : methods)
  {
    for (bool preconditioned : { false, true })
    {
      const Context name(std::string(nameOf(method)) + (preconditioned ? ", preconditioned" : ""));
      Quadratic f(300, 1e6);
      f.knowsHessian = f.preconditioned = preconditioned;
      Vector x(f.size(), 0.0);
      const MinimizeResult m = minimize(f, x.data(), optionsFor(method, 20000, 1e-10));
      report(preconditioned ? "quadratic, preconditioned" : "quadratic", method, m);
      TAUTLINE_CHECK(m.reason == StopReason::GradientNorm);
      TAUTLINE_CHECK(distance(x, f.a) < 1e-3);
      TAUTLINE_CHECK(m.value < 1e-6);
      if (preconditioned)
      {
        TAUTLINE_CHECK(m.iterations <= 40);
        // At iterations 0, 1, 3, 9 and then every twentieth.
        const bool newton = method == Optimizer::NewtonConjugateGradient;
        const int expected =
          newton ? m.iterations : (m.iterations > 9 ? 4 + (m.iterations - 10) / 20 : 3);
        TAUTLINE_CHECK_EQUAL(f.linearized, expected);
      }
    }
  }
}

/// Whose Hessian curves downwards without bound when it is first asked for.
struct LateHessian : Quadratic
{
  int products = 0;
  LateHessian()
    : Quadratic(40, 1e4)
  {
    this->knowsHessian = true;
  }
  bool hessianTimes(const double* v, double* product) override
  {
    const bool known = Quadratic::hessianTimes(v, product);
    if (this->products++ == 0)
    {
      std::transform(
        v, v + this->size(), product, [](double x) { return std::copysign(infinity, -x); });
    }
    return known;
  }
};

/// Newton's method takes one other step then, then its own: steepest descent takes thousands.
TAUTLINE_PART(testLateHessian)
{
  LateHessian f;
  Vector x(f.size(), 0.0);
  const MinimizeResult m =
    minimize(f, x.data(), optionsFor(Optimizer::NewtonConjugateGradient, 60, 1e-8));
  report("no finite Hessian at first", Optimizer::NewtonConjugateGradient, m);
  TAUTLINE_CHECK(f.products > 1);
  TAUTLINE_CHECK(m.reason == StopReason::GradientNorm);
  TAUTLINE_CHECK(distance(x, f.a) < 1e-4);
}

TAUTLINE_PART(testBarrier)
{
  for (Optimizer method : methods)
  {
    for (bool steps : { false, true })
    {
      const Context name(std::string(nameOf(method)) + (steps ? ", known steps" : ""));
      Barrier f(60, steps);
      Vector x(f.size(), 0.0), expected(f.size());
      for (std::size_t i = 0; i < f.size(); ++i)
      {
        expected[i] = f.solution(i);
      }
      MinimizeOptions options = optionsFor(method, 1000, 1e-6);
      options.observer = [&](int, double value, double norm, const double* at)
      {
        TAUTLINE_CHECK(std::isfinite(value) && std::isfinite(norm));
        return TAUTLINE_CHECK(
          std::all_of(at, at + f.size(), [](double v) { return std::abs(v) < 1; }));
      };
      const MinimizeResult m = minimize(f, x.data(), options);
      report(steps ? "barrier, known steps" : "barrier", method, m);
      TAUTLINE_CHECK(m.reason == StopReason::GradientNorm);
      TAUTLINE_CHECK(distance(x, expected) < 1e-4);
      TAUTLINE_CHECK(steps ? f.outside == 0 : f.outside > 0);
    }
  }
}

TAUTLINE_PART(testRough)
{
  for (Optimizer method : methods)
  {
    const Context name(nameOf(method));
    for (double spread : { 1.0, 9.9 })
    {
      Rough f;
      Vector x(f.size()), g(f.size());
      for (std::size_t i = 0; i < x.size(); ++i)
      {
        x[i] = spread * std::sin(static_cast<double>(3 * i + 1));
      }
      const double before = f.valueAndGradient(x.data(), g.data());
      const MinimizeResult m = minimize(f, x.data(), optionsFor(method, 100, 1e-6));
      TAUTLINE_CHECK(m.value < before);
      TAUTLINE_CHECK_EQUAL(f.valueAndGradient(x.data(), g.data()), m.value);
      // From 9.9 some variables run into the wall at 10.
      TAUTLINE_CHECK(spread > 1 || m.reason == StopReason::GradientNorm);
      TAUTLINE_CHECK(std::all_of(x.begin(), x.end(), [](double v) { return std::isfinite(v); }));
    }
    // A start that is not allowed stays.
    Rough f;
    Vector x(f.size(), 11.0);
    const MinimizeResult m = minimize(f, x.data(), optionsFor(method, 10, 0));
    TAUTLINE_CHECK(m.reason == StopReason::NoProgress && m.value == infinity);
    TAUTLINE_CHECK(x == Vector(f.size(), 11.0));
  }
}

TAUTLINE_PART(testStopping)
{
  for (Optimizer method : methods)
  {
    const Context name(nameOf(method));
    Rosenbrock f(100);
    Vector x = f.start(), seen;
    MinimizeOptions options = optionsFor(method, 1000, 0);
    options.observer = [&](int iteration, double, double, const double* at)
    {
      seen.assign(at, at + f.size());
      return iteration < 3;
    };
    MinimizeResult m = minimize(f, x.data(), options);
    TAUTLINE_CHECK(m.reason == StopReason::Aborted && m.iterations == 3);
    TAUTLINE_CHECK(x == seen);

    TAUTLINE_SET(options, observer = nullptr, maximumIterations = 5);
    m = minimize(f, x.data(), options);
    TAUTLINE_CHECK(m.reason == StopReason::IterationLimit && m.iterations == 5);
    options.maximumIterations = 0;
    const Vector before = x;
    const double value = m.value;
    m = minimize(f, x.data(), options);
    TAUTLINE_CHECK(m.reason == StopReason::IterationLimit && m.evaluations == 1 && x == before);
    TAUTLINE_CHECK_EQUAL(m.value, value);

    // Until no step reduces the value: it ends, at the minimum, without a tolerance.
    options.maximumIterations = 5000;
    m = minimize(f, x.data(), options);
    TAUTLINE_CHECK(m.reason == StopReason::NoProgress || m.reason == StopReason::GradientNorm);
    TAUTLINE_CHECK(m.value < 1e-20);

    x = f.start();
    options.relativeChange = 0.5;
    m = minimize(f, x.data(), options);
    TAUTLINE_CHECK(m.reason == StopReason::RelativeChange && m.iterations < 20);

    Vector minimum(f.size(), 1.0);
    m = minimize(f, minimum.data(), options);
    TAUTLINE_CHECK(m.reason == StopReason::GradientNorm && m.iterations == 0);
    TAUTLINE_CHECK(minimum == Vector(f.size(), 1.0));

    Rosenbrock none(0);
    TAUTLINE_CHECK(minimize(none, nullptr, options).reason == StopReason::NoFreeVertices);
  }
  Rosenbrock f(2);
  Vector x = f.start();
  TAUTLINE_CHECK_THROWS(
    minimize(f, x.data(), optionsFor(Optimizer::LocalNewton, 1, 0)), wording("a-global-one"));
  TAUTLINE_CHECK_THROWS(
    minimize(f, x.data(), optionsFor(Optimizer::LimitedMemoryBFGS, -1, 0)), wording("at-least-0"));
}

//------------------------------------------------------------------------------
/// A value that falls by steps of the way gone, with a slope too small to be seen in it.
struct Stairs : SmoothFunction
{
  static constexpr double slope = 1e-20, height = 0.1;
  int stepsPerStair; ///< 0: it never falls
  explicit Stairs(int steps)
    : stepsPerStair(steps)
  {
  }
  std::size_t size() const override { return 4; }
  double valueAndGradient(const double* x, double* g) override
  {
    std::fill(g, g + this->size(), -slope);
    const double gone = std::floor(x[0] + 0.5);
    return 2 - (this->stepsPerStair > 0 ? height * std::floor(gone / this->stepsPerStair) : 0.0);
  }
  /// No step is longer than 1 in each variable.
  double largestStep(const double*, const double* d, double wanted) override
  {
    return std::min(wanted, 1 / std::abs(d[0]));
  }
  /// Newton's step has length 1.
  bool hessianTimes(const double* d, double* product) override
  {
    std::transform(d, d + this->size(), product, [](double x) { return slope * x; });
    return true;
  }
};

/// Three iterations in a row without a visible change end the run; two, and then a change, do not.
TAUTLINE_PART(testStalled)
{
  constexpr int stalled = 3, iterations = 30;
  for (Optimizer method : methods)
  {
    const Context name(nameOf(method));
    Stairs flat(0);
    Vector x(flat.size(), 0.0);
    MinimizeResult m = minimize(flat, x.data(), optionsFor(method, iterations, 0));
    TAUTLINE_CHECK(m.reason == StopReason::NoProgress);
    TAUTLINE_CHECK_EQUAL(m.iterations, stalled);
    Stairs falling(stalled);
    x.assign(falling.size(), 0.0);
    m = minimize(falling, x.data(), optionsFor(method, iterations, 0));
    TAUTLINE_CHECK(m.reason == StopReason::IterationLimit);
    TAUTLINE_CHECK_NEAR(x[0], static_cast<double>(iterations), 1e-6);
    TAUTLINE_CHECK_NEAR(m.value, 2 - Stairs::height * iterations / stalled, 1e-12);
  }
}

/// A function of one variable: the first trial step of each method goes to `trial`, where the value
/// has fallen by a given part of what the slope promises, and the slope is 0.
struct FirstTrial : SmoothFunction
{
  static constexpr double trial = 0.1;
  double part;
  explicit FirstTrial(double given)
    : part(given)
  {
  }
  std::size_t size() const override { return 1; }
  double valueAndGradient(const double* x, double* g) override
  {
    // Hermite's cubic from value 1 and slope -1, and a parabola beyond.
    const double t = x[0] / trial, end = 1 - this->part * trial;
    if (t > 1)
    {
      g[0] = x[0] - trial;
      return end + 0.5 * g[0] * g[0];
    }
    const double up = t * t * (3 - 2 * t);
    g[0] = -(1 - 4 * t + 3 * t * t) + 6 * t * (1 - t) * (end - 1) / trial;
    return 1 - trial * t * (1 - t) * (1 - t) + up * (end - 1);
  }
  /// A parabola with its minimum at the trial step.
  bool hessianTimes(const double* d, double* product) override
  {
    product[0] = d[0] / trial;
    return true;
  }
};

/// A step has to reach 1e-4 of the decrease that the slope promises: half of that is rejected,
/// twice as much is accepted.
TAUTLINE_PART(testArmijo)
{
  constexpr double constant = 1e-4;
  for (Optimizer method : methods)
  {
    const Context name(nameOf(method));
    for (const double times : { 0.5, 2.0 })
    {
      const Context inner("times " + std::to_string(times));
      FirstTrial f(times * constant);
      Vector x(1, 0.0);
      const MinimizeResult m = minimize(f, x.data(), optionsFor(method, 1, 0));
      TAUTLINE_CHECK_EQUAL(m.iterations, 1);
      TAUTLINE_CHECK(m.value <= 1 - constant * x[0]);
      const bool taken = std::abs(x[0] - FirstTrial::trial) < 1e-12;
      TAUTLINE_CHECK_EQUAL(taken, times > 1);
      TAUTLINE_CHECK_EQUAL(m.evaluations == 2, times > 1);
    }
  }
}
}
