// SPDX-License-Identifier: BSD-3-Clause
// Heat and wave equations: the amplification of a discrete eigenmode by each scheme in closed form,
// orders of convergence in time and in space, mass matrices, conservation of energy, elastic waves,
// what is rejected and what stops.
#include "Blocks.h"
#include "Registry.h"
#include "tautline/Elliptic/TimeStepping.h"

#include <array>
#include <complex>

using namespace tautline;

namespace
{
constexpr double Tolerance = 1e-12; // of the linear systems
constexpr double Exact = 1e-8;      // of values in closed form

double square(double x)
{
  return x * x;
}

/// The unit square of n x n cells; of right triangles or squares.
MeshData unitSquare(CellType type, Index n)
{
  MeshData data = blockMesh(type, n, n, 0);
  data.transform([&](Vec3 p) { return (1.0 / static_cast<double>(n)) * p; });
  return data;
}

/// sin(pi x) sin(pi y), an eigenvector of the five-point formula and of bilinear elements.
std::vector<double> mode(const EllipticSystem& system)
{
  std::vector<double> values;
  for (Index i = 0; i < system.mesh().view().numberOfPoints; ++i)
  {
    const Vec3 p = pointOf(system.mesh().view(), i);
    values.push_back(std::sin(M_PI * p[0]) * std::sin(M_PI * p[1]));
  }
  return unknownsOf(system, values);
}

/// Its eigenvalue lambda, A u = lambda M u: triangles with lumped or squares with consistent mass.
double eigenvalue(bool lumped, Index n)
{
  const double h = 1.0 / static_cast<double>(n);
  const double c = std::cos(M_PI * h);
  return lumped ? 8 / square(h) * square(std::sin(M_PI * h / 2))
                : 2 * ((2 - 2 * c) / h) / (h * (4 + 2 * c) / 6);
}

EllipticProblem withoutSource()
{
  EllipticProblem problem;
  problem.source = { 0, 0, 0 };
  return problem;
}

SolverOptions exactly()
{
  return TAUTLINE_CHANGED(
    SolverOptions(), relativeTolerance = Tolerance, preconditioner = Preconditioner::ICC);
}

/// The factor of an eigenmode after this many steps of dt, in closed form.
double factor(TimeScheme scheme, double lambda, double dt, int steps)
{
  const double z = lambda * dt;
  if (scheme == TimeScheme::BackwardEuler)
  {
    return std::pow(1 + z, -steps);
  }
  if (scheme == TimeScheme::CrankNicolson)
  {
    return std::pow((1 - z / 2) / (1 + z / 2), steps);
  }
  if (scheme == TimeScheme::Newmark)
  {
    return std::cos(steps * 2 * std::atan(std::sqrt(lambda) * dt / 2));
  }
  if (steps == 0)
  {
    return 1.0;
  }
  double before = 1.0, now = 1 / (1 + z);
  for (int i = 1; i < steps; ++i)
  {
    const double next = (2 * now - 0.5 * before) / (1.5 + z);
    before = now;
    now = next;
  }
  return now;
}

constexpr std::array<TimeScheme, 4> Schemes = { TimeScheme::BackwardEuler, TimeScheme::Bdf2,
  TimeScheme::CrankNicolson, TimeScheme::Newmark };

/// The largest difference to a multiple of a vector.
double difference(const std::vector<double>& x, const std::vector<double>& y, double multiple)
{
  return largestOf<double>(
    0.0, x.size(), [&](std::size_t i) { return std::abs(x[i] - multiple * y[i]); });
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testEigenmodes)
{
  const Index n = 10;
  for (const bool lumped : { true, false })
  {
    const MeshData data = unitSquare(lumped ? CellType::Triangle : CellType::Quadrilateral, n);
    const Mesh mesh(data.view());
    const EllipticSystem system(mesh, withoutSource());
    const std::vector<double> start = mode(system), rest(start.size(), 0.0);
    for (const TimeScheme scheme : Schemes)
    {
      Context context("scheme " + std::to_string(static_cast<int>(scheme)));
      TAUTLINE_LET(TimeOptions, time, scheme = scheme, step = 0.02, steps = 7,
        mass = lumped ? MassMatrix::Lumped : MassMatrix::Consistent);
      const TimeSeries series = integrate(system, time, start, rest, exactly());
      TAUTLINE_CHECK(
        converged(series.reason) && series.values.size() == 8 && series.times.size() == 8);
      TAUTLINE_CHECK_NEAR(series.times.back(), 0.14, 1e-15);
      for (int i = 0; i < static_cast<int>(series.values.size()); ++i)
      {
        const double expected = factor(scheme, eigenvalue(lumped, n), time.step, i);
        TAUTLINE_CHECK(difference(series.values[i], start, expected) < Exact);
      }
      // Twice the density is half the time of the heat equation.
      TAUTLINE_SET(time, density = 2, step = 0.04);
      const TimeSeries slower = integrate(system, time, start, rest, exactly());
      const bool wave = scheme == TimeScheme::Newmark;
      const double expected = wave ? factor(scheme, eigenvalue(lumped, n) / 2, time.step, 7)
                                   : factor(scheme, eigenvalue(lumped, n), 0.02, 7);
      TAUTLINE_CHECK(difference(slower.values.back(), start, expected) < Exact);
    }
  }
}

/// Orders in time, against the exact exponential or cosine of the same eigenvalue.
TAUTLINE_PART(testOrders)
{
  const Index n = 8;
  const MeshData data = unitSquare(CellType::Triangle, n);
  const Mesh mesh(data.view());
  const EllipticSystem system(mesh, withoutSource());
  const std::vector<double> start = mode(system), rest(start.size(), 0.0);
  const double lambda = eigenvalue(true, n), end = 0.1;
  for (const TimeScheme scheme : Schemes)
  {
    const bool wave = scheme == TimeScheme::Newmark;
    const double exact = wave ? std::cos(std::sqrt(lambda) * end) : std::exp(-lambda * end);
    std::array<double, 2> errors{};
    for (int k = 0; k < 2; ++k)
    {
      TAUTLINE_LET(TimeOptions, time, scheme = scheme, steps = 40 << k, step = end / time.steps,
        mass = MassMatrix::Lumped);
      const TimeSeries series = integrate(system, time, start, rest, exactly());
      errors[k] = difference(series.values.back(), start, exact);
    }
    const double order = std::log2(errors[0] / errors[1]);
    Context context("scheme " + std::to_string(static_cast<int>(scheme)));
    TAUTLINE_CHECK_NEAR(order, scheme == TimeScheme::BackwardEuler ? 1.0 : 2.0, 0.1);
  }
}

/// Order 2 in space with both mass matrices, with steps that are short enough.
TAUTLINE_PART(testSpace)
{
  const double end = 0.05;
  for (const MassMatrix mass : { MassMatrix::Consistent, MassMatrix::Lumped })
  {
    std::array<double, 2> errors{};
    for (int k = 0; k < 2; ++k)
    {
      const MeshData data = unitSquare(CellType::Triangle, 8 << k);
      const Mesh mesh(data.view());
      const EllipticSystem system(mesh, withoutSource());
      const std::vector<double> start = mode(system);
      TAUTLINE_LET(TimeOptions, time, scheme = TimeScheme::CrankNicolson, steps = 200,
        step = end / time.steps, mass = mass);
      const TimeSeries series = integrate(system, time, start, start, exactly());
      errors[k] = difference(series.values.back(), start, std::exp(-2 * square(M_PI) * end));
    }
    TAUTLINE_CHECK_NEAR(std::log2(errors[0] / errors[1]), 2.0, 0.15);
  }
}

/// The entries of mass matrices add up to the area of the free points; the stationary solution is
/// kept, and reached.
TAUTLINE_PART(testStationary)
{
  const MeshData data = unitSquare(CellType::Triangle, 6);
  const Mesh mesh(data.view());
  std::vector<unsigned char> none(mesh.view().numberOfPoints, 0);
  none[0] = 1;
  TAUTLINE_LET(EllipticProblem, free, fixed = none.data());
  const EllipticSystem whole(mesh, free);
  const double missing = 1.0 / 36 / 3; // of a corner with two triangles
  for (const MassMatrix kind : { MassMatrix::Consistent, MassMatrix::Lumped })
  {
    const SparseMatrix mass = massMatrix(whole, kind);
    double sum = 0.0, largestOff = 0.0;
    for (Index i = 0; i < mass.size; ++i)
    {
      for (Index k = mass.offsets[i]; k < mass.offsets[i + 1]; ++k)
      {
        sum += mass.values[k];
        largestOff = std::max(largestOff, mass.columns[k] == i ? 0.0 : std::abs(mass.values[k]));
      }
    }
    TAUTLINE_CHECK(kind == MassMatrix::Lumped ? largestOff == 0 : largestOff > 0);
    // The consistent one also lacks the row of the fixed corner and its column.
    const double corner = missing, entry = missing / 2;
    TAUTLINE_CHECK_NEAR(
      sum, 1 - corner - (kind == MassMatrix::Consistent ? corner - entry : 0.0), 1e-12);
  }

  EllipticProblem problem;
  std::vector<double> given(mesh.view().numberOfPoints, 0.3);
  problem.fixedValues = given.data();
  const EllipticSystem system(mesh, problem);
  std::vector<double> still(system.matrix().size, 0.0);
  const std::vector<double> rest = still;
  LinearSolver solver(system.linearSystem(), exactly());
  solver.solve(system.rightHandSide().data(), still.data());
  for (const TimeScheme scheme : Schemes)
  {
    TAUTLINE_LET(TimeOptions, time, scheme = scheme, steps = 5);
    const TimeSeries kept = integrate(system, time, still, rest, exactly());
    TAUTLINE_CHECK(difference(kept.values.back(), still, 1.0) < Exact);
    if (scheme != TimeScheme::Newmark && scheme != TimeScheme::CrankNicolson)
    {
      TAUTLINE_SET(time, step = 1.0, steps = 20);
      const TimeSeries reached = integrate(system, time, rest, rest, exactly());
      TAUTLINE_CHECK(difference(reached.values.back(), still, 1.0) < 1e-6);
    }
  }
}

/// Elastic waves: the energy of a released body stays the same.
TAUTLINE_PART(testElasticWaves)
{
  for (const CellType type : { CellType::Triangle, CellType::Tetrahedron })
  {
    const bool flat = type == CellType::Triangle;
    MeshData data = blockMesh(type, 4, 3, flat ? 0 : 3);
    const Mesh mesh(data.view());
    std::vector<unsigned char> fixed;
    std::vector<double> pull;
    for (Index i = 0; i < mesh.view().numberOfPoints; ++i)
    {
      const Vec3 p = pointOf(mesh.view(), i);
      fixed.push_back(p[0] == 0);
      pull.insert(pull.end(), { 0.1 * p[0], 0.02 * p[0] * p[1], 0.0 });
    }
    TAUTLINE_LET(EllipticProblem, problem, pde = Pde::Elasticity);
    problem.source = { 0, 0, 0 };
    problem.fixed = fixed.data();
    const EllipticSystem system(mesh, problem);
    TAUTLINE_CHECK(system.blockSize() == (flat ? 2 : 3));
    const std::vector<double> start = unknownsOf(system, pull), rest(start.size(), 0.0);
    TAUTLINE_LET(TimeOptions, time, scheme = TimeScheme::Newmark, step = 0.5, steps = 60);
    const TimeSeries series = integrate(system, time, start, rest, exactly());
    TAUTLINE_CHECK(series.values.size() == 61);
    // Velocities follow from v_new = 2 (u_new - u) / dt - v, exact for this scheme.
    const SparseMatrix mass = massMatrix(system, time.mass);
    std::vector<double> velocity = rest, product(rest.size());
    const auto energy = [&](const std::vector<double>& u, const std::vector<double>& v)
    {
      double sum = 0.0;
      const std::array terms = { std::make_pair(&system.matrix(), &u), std::make_pair(&mass, &v) };
      for (const auto& [matrix, x] : terms)
      {
        matrix->multiply(x->data(), product.data());
        for (std::size_t i = 0; i < product.size(); ++i)
        {
          sum += 0.5 * product[i] * (*x)[i];
        }
      }
      return sum;
    };
    const double first = energy(start, velocity);
    for (std::size_t n = 1; n < series.values.size(); ++n)
    {
      for (std::size_t i = 0; i < velocity.size(); ++i)
      {
        velocity[i] = 2 * (series.values[n][i] - series.values[n - 1][i]) / time.step - velocity[i];
      }
    }
    TAUTLINE_CHECK(first > 0);
    TAUTLINE_CHECK_NEAR(energy(series.values.back(), velocity) / first, 1.0, 1e-6);
  }
}

/// A solution that decays below the smallest number goes on being solved, by all methods.
TAUTLINE_PART(testDecay)
{
  const MeshData data = unitSquare(CellType::Triangle, 6);
  const Mesh mesh(data.view());
  const EllipticSystem system(mesh, withoutSource());
  const std::vector<double> start = mode(system);
  TAUTLINE_LET(TimeOptions, time, scheme = TimeScheme::Bdf2, step = 2.0, steps = 400);
  for (const KrylovMethod method : { KrylovMethod::ConjugateGradient, KrylovMethod::MINRES,
         KrylovMethod::GMRES, KrylovMethod::BiCGStab, KrylovMethod::Direct })
  {
    Context context(nameOf(method));
    TAUTLINE_LET(SolverOptions, options, method = method, preconditioner = Preconditioner::Jacobi);
    const TimeSeries series = integrate(system, time, start, start, options);
    TAUTLINE_CHECK(converged(series.reason) && series.values.size() == 401);
    TAUTLINE_CHECK(difference(series.values.back(), start, 0.0) < 1e-12);
  }
}

TAUTLINE_PART(testRejected)
{
  const MeshData data = unitSquare(CellType::Triangle, 4);
  const Mesh mesh(data.view());
  const EllipticSystem system(mesh, withoutSource());
  const std::vector<double> start = mode(system), rest(start.size(), 0.0);
  TAUTLINE_LET(TimeOptions, time, step = 0.0);
  TAUTLINE_CHECK_THROWS(integrate(system, time, start, rest, {}), "above 0");
  time.step = std::nan("");
  TAUTLINE_CHECK_THROWS(integrate(system, time, start, rest, {}), "above 0");
  TAUTLINE_SET(time, step = 0.1, steps = 0);
  TAUTLINE_CHECK_THROWS(integrate(system, time, start, rest, {}), wording("at-least-1"));
  TAUTLINE_SET(time, steps = 3, density = -1);
  TAUTLINE_CHECK_THROWS(integrate(system, time, start, rest, {}), "density");
  TAUTLINE_SET(time, density = 1, scheme = TimeScheme::Stationary);
  TAUTLINE_CHECK_THROWS(integrate(system, time, start, rest, {}), "stationary");
  time.scheme = TimeScheme::Newmark;
  TAUTLINE_CHECK_THROWS(
    integrate(system, time, start, { 1.0 }, {}), wording("1-initial-velocities"));
  std::vector<double> wrong = start;
  wrong[0] = std::nan("");
  TAUTLINE_CHECK_THROWS(integrate(system, time, wrong, rest, {}), wording("not-finite"));

  // 160,000 unknowns and 100,000,000 steps: 116 TiB.
  const MeshData fine = unitSquare(CellType::Triangle, 400);
  const Mesh fineMesh(fine.view());
  const EllipticSystem large(fineMesh, withoutSource());
  const std::vector<double> zero(large.matrix().size, 0.0);
  TAUTLINE_SET(time, scheme = TimeScheme::BackwardEuler, steps = 100000000);
  TAUTLINE_CHECK_THROWS(integrate(large, time, zero, zero, {}), wording("fewer-time-steps"));
  time.steps = 3;

  // A solver that fails ends the integration; so does the observer.
  SolverOptions few = exactly();
  TAUTLINE_SET(few, maximumIterations = 1, preconditioner = Preconditioner::None);
  time.scheme = TimeScheme::BackwardEuler;
  std::vector<double> rough = start;
  rough[0] += 1;
  const TimeSeries failed = integrate(system, time, rough, rest, few);
  TAUTLINE_CHECK(failed.reason == SolveReason::IterationLimit && failed.values.size() == 1);
  SolverOptions stopped = exactly();
  std::vector<int> seen;
  stopped.observer = [&](int step, double)
  {
    seen.push_back(step);
    return step < 2;
  };
  const TimeSeries ended = integrate(system, time, start, rest, stopped);
  TAUTLINE_CHECK(ended.reason == SolveReason::Aborted && ended.values.size() == 3);
  TAUTLINE_CHECK(seen == (std::vector<int>{ 1, 2 }));
}
}
