// SPDX-License-Identifier: BSD-3-Clause
// The linear ordinary state-based model: patch tests with the moduli of Hooke's law, energy and
// forces against a sum over points, the bond-based model at its Poisson's ratio, the local limit,
// definiteness, scales, threads; bonds that are cut at holes and cracks.
#include "HorizonMeshes.h"
#include "Registry.h"
#include "tautline/Peridynamics/Dilatation.h"
#include "tautline/Peridynamics/InteractionLayer.h"
#include "tautline/Peridynamics/LocalLimit.h"
#include "tautline/Peridynamics/PeridynamicSolve.h"

#include <cstdio>

using namespace tautline;

namespace
{
/// The error of the rule of degree 5 for the square of the dilatation, relative to the diagonal.
constexpr double RuleError = 5e-4;

PeridynamicOptions stateBased(double nu, PlaneState state = PlaneState::Strain)
{
  return TAUTLINE_CHANGED(PeridynamicOptions(), horizon = 0.25,
    model = PeridynamicModel::StateBased, poissonRatio = nu, planeState = state);
}

double product(const std::vector<double>& x, const std::vector<double>& y)
{
  return sumOf<double>(0.0, x.size(), [&](std::size_t i) { return x[i] * y[i]; });
}

/// u = G x at the points.
std::vector<double> linearMotion(const HorizonMesh& mesh, const double (&g)[4])
{
  std::vector<double> u;
  for (Index i = 0; i < mesh.numberOfPoints(); ++i)
  {
    const double x = mesh.points[2 * i], y = mesh.points[2 * i + 1];
    u.push_back(g[0] * x + g[1] * y);
    u.push_back(g[2] * x + g[3] * y);
  }
  return u;
}

std::vector<double> unknownValues(const PeridynamicSystem& system, const std::vector<double>& u)
{
  std::vector<double> found;
  for (const Index f : system.functionOf)
  {
    found.push_back(u[2 * f]);
    found.push_back(u[2 * f + 1]);
  }
  return found;
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testLameRatio)
{
  TAUTLINE_CHECK_NEAR(lameRatio(stateBased(0.25)), 1.0, 1e-15);
  TAUTLINE_CHECK_NEAR(lameRatio(stateBased(1.0 / 3.0, PlaneState::Stress)), 1.0, 1e-15);
  TAUTLINE_CHECK_NEAR(lameRatio(stateBased(0.0)), 0.0, 0.0);
  // lambda / mu = 2 nu / (1 - 2 nu), and in plane stress 2 nu / (1 - nu).
  TAUTLINE_CHECK_NEAR(lameRatio(stateBased(0.4)), 4.0, 1e-14);
  TAUTLINE_CHECK_NEAR(lameRatio(stateBased(0.4, PlaneState::Stress)), 4.0 / 3.0, 1e-15);
}

/// Every homogeneous motion is in equilibrium and has the energy density of Hooke's law; rigid ones
/// have none.
TAUTLINE_PART_SLOW(testPatch)
{
  const HorizonMesh mesh = shakenSquare(8, 4, 0.2);
  constexpr double motions[][4] = { { 0, -1, 1, 0 }, { 1, 0, 0, 1 }, { 0, 0.5, 0.5, 0 },
    { 1, 0, 0, -1 }, { 0.7, -0.2, 0.9, 0.1 } };
  for (const double p : { 0.0, 1.0, 3.5 })
  {
    for (const double nu : { -0.5, 0.0, 0.25, 0.3, 0.45 })
    {
      for (const PlaneState state : { PlaneState::Strain, PlaneState::Stress })
      {
        const Context context("nu = " + std::to_string(nu) + ", p = " + std::to_string(p));
        PeridynamicOptions options = stateBased(nu, state);
        TAUTLINE_SET(options, kernel.exponent = p, tolerance = 1e-4);
        const double mu = localModulus(options);
        TAUTLINE_CHECK_RELATIVE(mu, M_PI / (8.0 * (6.0 - p)), 1e-12);
        const double lambda =
          mu * (state == PlaneState::Strain ? 2 * nu / (1 - 2 * nu) : 2 * nu / (1 - nu));
        for (const auto& g : motions)
        {
          const std::vector<double> u = linearMotion(mesh, g);
          const PeridynamicStrain strain = peridynamicStrain(mesh, options, u);
          const double trace = g[0] + g[3], shear = 0.5 * (g[1] + g[2]);
          const double energy =
            0.5 * lambda * trace * trace + mu * (g[0] * g[0] + g[3] * g[3] + 2.0 * shear * shear);
          for (Index t = 0; t < mesh.numberOfTriangles(); ++t)
          {
            TAUTLINE_CHECK_NEAR(strain.dilatation[t], mesh.layer[t] ? 0.0 : trace, 1e-5);
            TAUTLINE_CHECK_NEAR(strain.energyDensity[t], mesh.layer[t] ? 0.0 : energy, 1e-5);
          }
        }
      }
    }
  }
  for (const double nu : { 0.0, 0.4 })
  {
    const PeridynamicOptions options = stateBased(nu);
    for (const auto& g : motions)
    {
      const std::vector<double> u = linearMotion(mesh, g);
      const PeridynamicSystem system = assemblePeridynamics(mesh, options, &u);
      const std::vector<double> force = times(system.matrix, unknownValues(system, u));
      double scale = largestOf<double>(
        0.0, system.matrix.size, [&](Index row) { return system.matrix.at(row, row); });
      TAUTLINE_EACH(std::size_t, i, force.size(),
        TAUTLINE_CHECK_NEAR(force[i] + system.constraintLoad[i], 0.0, RuleError * scale));
    }
  }
}

//------------------------------------------------------------------------------
/// At the Poisson's ratio of the bond-based model the matrices are the same; elsewhere they differ
/// by the square of the dilatation.
TAUTLINE_PART(testReduction)
{
  const HorizonMesh mesh = shakenSquare(6, 3, 0.2);
  for (const PeridynamicBasis basis : bases)
  {
    PeridynamicOptions options = stateBased(0.25);
    TAUTLINE_SET(options, horizon = 0.25, basis = basis, tolerance = 1e-4);
    const PeridynamicSystem strain = assemblePeridynamics(mesh, options);
    TAUTLINE_SET(options, poissonRatio = 1.0 / 3.0, planeState = PlaneState::Stress);
    const PeridynamicSystem stress = assemblePeridynamics(mesh, options);
    options.poissonRatio = 0.4;
    const PeridynamicSystem other = assemblePeridynamics(mesh, options);
    options.poissonRatio = 0.0;
    const PeridynamicSystem zero = assemblePeridynamics(mesh, options);
    options.model = PeridynamicModel::Elastic;
    const PeridynamicSystem bonds = assemblePeridynamics(mesh, options);
    double largest = 0.0, difference = 0.0;
    for (Index row = 0; row < bonds.matrix.size; ++row)
    {
      for (Index column = 0; column < bonds.matrix.size; ++column)
      {
        const double value = bonds.matrix.at(row, column);
        TAUTLINE_CHECK_NEAR(strain.matrix.at(row, column), value, 1e-14);
        TAUTLINE_CHECK_NEAR(stress.matrix.at(row, column), value, 1e-14);
        // lambda / mu - 1 is -1 and 1/3.
        const double square = value - zero.matrix.at(row, column);
        TAUTLINE_CHECK_NEAR(other.matrix.at(row, column), value + square / 3.0, 1e-13);
        largest = std::max(largest, std::abs(value));
        difference = std::max(difference, std::abs(square));
      }
    }
    TAUTLINE_CHECK(difference > 1e-3 * largest);
    // Forces reach twice as far.
    TAUTLINE_CHECK(4 * zero.matrix.nonzeros() > 5 * bonds.matrix.nonzeros());
  }
}

//------------------------------------------------------------------------------
/// Points of equal triangles that the triangles of a mesh are cut into.
struct PointCloud
{
  std::vector<Vec2> at, motion;
  std::vector<double> weights;
};

/// The energy of a piecewise linear motion: sums over pairs of points.
double energyOfPoints(const HorizonMesh& mesh, const PeridynamicOptions& options,
  const std::vector<double>& u, int parts)
{
  PointCloud cloud;
  for (Index t = 0; t < mesh.numberOfTriangles(); ++t)
  {
    const Index* ids = &mesh.triangles[3 * t];
    const auto vertex = [&](int k) {
      return Vec2{ mesh.points[2 * ids[k]], mesh.points[2 * ids[k] + 1] };
    };
    const double area = 0.5 * cross(vertex(1) - vertex(0), vertex(2) - vertex(0));
    for (int i = 0; i < parts; ++i)
    {
      for (int j = 0; j < 2 * (parts - i) - 1; ++j)
      {
        const double shift = j % 2 == 0 ? 1.0 / 3.0 : 2.0 / 3.0;
        const double b = (i + shift) / parts, c = (j / 2 + shift) / parts, a = 1.0 - b - c;
        cloud.at.push_back(a * vertex(0) + b * vertex(1) + c * vertex(2));
        cloud.motion.push_back({ a * u[2 * ids[0]] + b * u[2 * ids[1]] + c * u[2 * ids[2]],
          a * u[2 * ids[0] + 1] + b * u[2 * ids[1] + 1] + c * u[2 * ids[2] + 1] });
        cloud.weights.push_back(area / (parts * parts));
      }
    }
  }
  // The formulas of Silling et al. (2007) in the plane, with k = 1 / r: omega = r^2 k = r.
  const double delta = options.horizon, m = 2.0 * M_PI * std::pow(delta, 5.0) / 5.0;
  const double mu = localModulus(options), alpha = 8.0 * mu / m;
  const double bulk = (lameRatio(options) + 1.0) * mu;
  double energy = 0.0;
  for (std::size_t i = 0; i < cloud.at.size(); ++i)
  {
    double first = 0.0, second = 0.0, mass = 0.0;
    for (std::size_t j = 0; j < cloud.at.size(); ++j)
    {
      const Vec2 xi = cloud.at[j] - cloud.at[i];
      const double r = std::sqrt(dot(xi, xi));
      if (r < delta && i != j)
      {
        const double e = dot(xi, cloud.motion[j] - cloud.motion[i]) / r;
        first += cloud.weights[j] * r * r * e;
        second += cloud.weights[j] * r * e * e;
        mass += cloud.weights[j] * r * r * r;
      }
    }
    const double theta = 2.0 / m * first;
    // int omega (e - theta r / 2)^2, with the m of the part of the disc that is there.
    const double deviatoric = second - theta * first + 0.25 * theta * theta * mass;
    // The formula of the model has the m of the whole disc in the last two terms.
    const double whole = deviatoric + 0.25 * theta * theta * (m - mass);
    energy += cloud.weights[i] * (0.5 * bulk * theta * theta + 0.5 * alpha * whole);
  }
  return energy;
}

/// Energy and forces match the formulas, for a free body, whose matrix has all functions.
TAUTLINE_PART(testEnergy)
{
  HorizonMesh mesh = shakenSquare(4, 0, 0.0);
  PeridynamicOptions options = stateBased(0.4);
  TAUTLINE_SET(options, horizon = 0.4, constrained = false);
  Random random(3);
  std::vector<double> u;
  for (Index i = 0; i < 2 * mesh.numberOfPoints(); ++i)
  {
    u.push_back(random.uniform(-1.0, 1.0));
  }
  for (const double nu : { -0.5, 0.1, 0.45 })
  {
    const Context context("nu = " + std::to_string(nu));
    options.poissonRatio = nu;
    const PeridynamicSystem system = assemblePeridynamics(mesh, options);
    const std::vector<double> force = times(system.matrix, u);
    const double energy = 0.5 * product(u, force);
    constexpr int parts = 8;
    const double sum = energyOfPoints(mesh, options, u, parts);
    std::printf("nu %.2f: energy %.6f, of points %.6f\n", nu, energy, sum);
    TAUTLINE_CHECK_RELATIVE(energy, sum, 0.015); // of the sum over points
    double largest = largestOf<double>(0.0, force, [&](const double f) { return std::abs(f); });
    for (const std::size_t i :
      { std::size_t(0), std::size_t(13), std::size_t(24), force.size() - 1 })
    {
      // Differences of a quadratic function are exact for any step.
      std::vector<double> up = u, down = u;
      up[i] += 1.0;
      down[i] -= 1.0;
      const double slope = 0.5 *
        (energyOfPoints(mesh, options, up, parts) - energyOfPoints(mesh, options, down, parts));
      TAUTLINE_CHECK_NEAR(force[i], slope, 0.02 * largest);
    }
  }
}

//------------------------------------------------------------------------------
/// Twice the energy of the motion of energyRatio() in Hooke's law, by the midpoint rule.
double energyOfHooke(double mu, double lambda)
{
  constexpr int n = 400;
  double sum = 0.0;
  for (int i = 0; i < n * n; ++i)
  {
    const double x = (i % n + 0.5) / n, y = (i / n + 0.5) / n;
    const double sx = std::sin(M_PI * x), sy = std::sin(M_PI * y);
    const double bump = sx * sx * sy * sy;
    const double gx = M_PI * std::sin(2.0 * M_PI * x) * sy * sy;
    const double gy = M_PI * std::sin(2.0 * M_PI * y) * sx * sx;
    const double xx = gx, yy = x * gy, xy = 0.5 * (gy + bump + x * gx);
    sum += lambda * (xx + yy) * (xx + yy) + 2.0 * mu * (xx * xx + yy * yy + 2.0 * xy * xy);
  }
  return sum / (n * n);
}

/// The energy of a smooth bump over the energy by Hooke's law, at a number of elements in the
/// horizon.
double energyRatio(int n, int layers, double nu)
{
  const HorizonMesh mesh = shakenSquare(n, 2 * layers, 0.0);
  PeridynamicOptions options = stateBased(nu);
  options.horizon = static_cast<double>(layers) / n;
  const PeridynamicSystem system = assemblePeridynamics(mesh, options);
  std::vector<double> u;
  for (const Index f : system.functionOf)
  {
    const double x = mesh.points[2 * f], y = mesh.points[2 * f + 1];
    const double sx = std::sin(M_PI * x), sy = std::sin(M_PI * y);
    u.push_back(sx * sx * sy * sy);
    u.push_back(x * sx * sx * sy * sy);
  }
  const double mu = localModulus(options);
  return product(u, times(system.matrix, u)) / energyOfHooke(mu, lameRatio(options) * mu);
}

/// Tends to Hooke's law with the square of the horizon.
TAUTLINE_PART_SLOW(testLocalLimit)
{
  for (const double nu : { 0.0, 0.45 })
  {
    const double coarse = 1.0 - energyRatio(16, 4, nu), fine = 1.0 - energyRatio(32, 4, nu);
    std::printf("nu %.2f: energy below Hooke's law by %.5f and %.5f\n", nu, coarse, fine);
    TAUTLINE_CHECK(coarse > 0.0 && coarse < 0.4);
    TAUTLINE_CHECK(fine > 0.0 && 3.0 * fine < coarse);
  }
}

//------------------------------------------------------------------------------
/// Positive definite for all Poisson's ratios and bases, rigid motions free of forces, the same for
/// any threads and scale.
TAUTLINE_PART(testMatrix)
{
  const HorizonMesh mesh = shakenSquare(6, 3, 0.2);
  for (const PeridynamicBasis basis : bases)
  {
    for (const double nu : { -0.99, -0.5, 0.0, 0.49 })
    {
      const Context context(
        "basis " + std::to_string(static_cast<int>(basis)) + ", nu = " + std::to_string(nu));
      PeridynamicOptions options = stateBased(nu);
      TAUTLINE_SET(options, basis = basis, tolerance = 1e-4);
      const PeridynamicSystem system = assemblePeridynamics(mesh, options);
      const Spectrum spectrum = extremeEigenvalues(system.matrix);
      TAUTLINE_CHECK(spectrum.definite && spectrum.smallest > 1e-4 * spectrum.largest);
      options.threads = 3;
      TAUTLINE_CHECK(assemblePeridynamics(mesh, options).matrix.values == system.matrix.values);
      HorizonMesh large = mesh;
      constexpr double scale = 1048576.0;
      for (double& x : large.points)
      {
        x *= scale;
      }
      options.horizon *= scale;
      const PeridynamicSystem scaled = assemblePeridynamics(large, options);
      TAUTLINE_CHECK(scaled.matrix.columns == system.matrix.columns);
      for (std::size_t k = 0; k < scaled.matrix.values.size(); ++k)
      {
        // Moduli do not change; forces are per depth: no factor for continuous functions.
        TAUTLINE_CHECK_NEAR(scaled.matrix.values[k], system.matrix.values[k], 1e-12);
      }
    }
  }
  // A free body: forces of rigid motions vanish.
  PeridynamicOptions options = TAUTLINE_CHANGED(stateBased(0.4), constrained = false);
  const PeridynamicSystem system = assemblePeridynamics(mesh, options);
  const double rotation[4] = { 0, -1, 1, 0 };
  for (std::vector<double> u : { linearMotion(mesh, rotation), std::vector<double>() })
  {
    u.resize(static_cast<std::size_t>(system.matrix.size), 1.0);
    TAUTLINE_EACH_OF(
      const double force, times(system.matrix, u), TAUTLINE_CHECK_NEAR(force, 0.0, 1e-6));
  }
}

//------------------------------------------------------------------------------
/// The same solution with each preconditioner; those other than Jacobi take fewer iterations.
TAUTLINE_PART(testSolutions)
{
  const HorizonMesh mesh = shakenSquare(16, 4, 0.1);
  PeridynamicOptions options = TAUTLINE_CHANGED(stateBased(0.3), horizon = 0.125, tolerance = 1e-4);
  const PeridynamicSystem system = assemblePeridynamics(mesh, options);
  const std::vector<double> ones(2 * mesh.numberOfTriangles(), 1.0);
  const std::vector<double> load = sourceLoad(mesh, system, options.basis, ones, false);
  std::vector<double> expected, found;
  const SolveReport jacobi =
    solvePeridynamics(mesh, options, system, NonlocalPreconditioner::Jacobi, load, expected, 1e-12);
  TAUTLINE_CHECK(jacobi.converged);
  for (const auto kind :
    { NonlocalPreconditioner::LocalMultigrid, NonlocalPreconditioner::TwoLevel })
  {
    const SolveReport report = solvePeridynamics(mesh, options, system, kind, load, found, 1e-12);
    std::printf("%s: %d iterations, Jacobi %d\n", nameOf(kind), static_cast<int>(report.iterations),
      static_cast<int>(jacobi.iterations));
    TAUTLINE_CHECK(report.converged && report.iterations < jacobi.iterations);
    TAUTLINE_EACH(std::size_t, i, found.size(),
      TAUTLINE_CHECK_NEAR(found[i], expected[i], 1e-9 * (1.0 + std::abs(expected[i]))));
  }
}

/// A ring of `around` by `across` quadrilaterals in two triangles each, between two radii.
HorizonMesh ring(int around, int across, double inner, double outer)
{
  HorizonMesh mesh;
  for (int j = 0; j <= across; ++j)
  {
    for (int i = 0; i < around; ++i)
    {
      const double r = inner + (outer - inner) * j / across, angle = 2.0 * M_PI * i / around;
      mesh.points.push_back(r * std::cos(angle));
      mesh.points.push_back(r * std::sin(angle));
    }
  }
  for (int j = 0; j < across; ++j)
  {
    for (int i = 0; i < around; ++i)
    {
      const Index a = j * around + i, b = j * around + (i + 1) % around;
      for (const Index id : { b, a, a + around, b, a + around, b + around })
      {
        mesh.triangles.push_back(id);
      }
      mesh.layer.insert(mesh.layer.end(), 2, 0);
    }
  }
  return mesh;
}

/// A square of n by n cells in two triangles, slit from the middle of the left side to its center.
HorizonMesh slitSquare(int n, bool open)
{
  HorizonMesh mesh = shakenSquare(n, 0, 0.0);
  const Index row = n / 2 * (n + 1);
  for (Index i = 0; open && i < n / 2; ++i)
  {
    mesh.points.push_back(mesh.points[2 * (row + i)]);
    mesh.points.push_back(mesh.points[2 * (row + i) + 1]);
    for (Index t = n * n; t < 2 * n * n; ++t)
    {
      for (int k = 0; k < 3; ++k)
      {
        Index& id = mesh.triangles[3 * t + k];
        id = id == row + i ? mesh.numberOfPoints() - 1 : id;
      }
    }
  }
  return mesh;
}

/// Sums of the entries between functions of the lower and the upper half, left of `right`.
double acrossSlit(const HorizonMesh& mesh, const PeridynamicSystem& system, double right)
{
  double sum = 0.0;
  for (Index i = 0; i < system.matrix.size; ++i)
  {
    const Index f = system.functionOf[i];
    for (Index k = system.matrix.offsets[i]; k < system.matrix.offsets[i + 1]; ++k)
    {
      const Index g = system.functionOf[system.matrix.columns[k]];
      const bool left = mesh.points[2 * f] < right && mesh.points[2 * g] < right;
      sum += left && mesh.points[2 * f + 1] < 0.49 && mesh.points[2 * g + 1] > 0.51
        ? std::abs(system.matrix.values[k])
        : 0.0;
    }
  }
  return sum;
}

/// Bonds do not cross a crack or a hole; nothing is cut inside a layer that is wide enough.
TAUTLINE_PART(testCuts)
{
  TAUTLINE_LET(PeridynamicOptions, options, horizon = 0.2, tolerance = 1e-4, constrained = false);
  const HorizonMesh slit = slitSquare(16, true), whole = slitSquare(16, false);
  PeridynamicSystem system = assemblePeridynamics(slit, options);
  TAUTLINE_CHECK_EQUAL(acrossSlit(slit, system, 0.3), 0.0);
  TAUTLINE_CHECK(acrossSlit(whole, assemblePeridynamics(whole, options), 0.3) > 0.01);
  options.cutBonds = false;
  TAUTLINE_CHECK(acrossSlit(slit, assemblePeridynamics(slit, options), 0.3) > 0.01);
  // Other than that it is the same matrix: rows of points that see everything are equal.
  options.cutBonds = true;
  system = assemblePeridynamics(whole, options);
  options.cutBonds = false;
  TAUTLINE_CHECK(assemblePeridynamics(whole, options).matrix.values == system.matrix.values);

  // A ring whose hole is narrower than the horizon: the two sides do not interact.
  TAUTLINE_SET(options, cutBonds = true, horizon = 0.5);
  const HorizonMesh narrow = ring(32, 4, 0.15, 0.35);
  const PeridynamicSystem cut = assemblePeridynamics(narrow, options);
  const std::vector<double> ones(cut.matrix.size, 1.0);
  TAUTLINE_EACH_OF(
    const double force, times(cut.matrix, ones), TAUTLINE_CHECK_NEAR(force, 0.0, 1e-12));
  options.cutBonds = false;
  const PeridynamicSystem full = assemblePeridynamics(narrow, options);
  // Opposite points at the hole.
  TAUTLINE_CHECK(std::abs(full.matrix.at(0, 16)) > 1e-6);
  TAUTLINE_CHECK_EQUAL(cut.matrix.at(0, 16), 0.0);

  // With a layer in the hole and around, of both models, nothing is cut.
  HorizonMesh plate = ring(40, 5, 0.5, 1.0);
  for (const bool state : { false, true })
  {
    options = state ? stateBased(0.4) : PeridynamicOptions();
    TAUTLINE_SET(options, horizon = 0.15, tolerance = 1e-3);
    TAUTLINE_LET(InteractionLayerOptions, layer, width = interactionReach(options));
    const HorizonMesh surrounded = addInteractionLayer(plate, layer);
    const PeridynamicSystem with = assemblePeridynamics(surrounded, options);
    options.cutBonds = false;
    const PeridynamicSystem without = assemblePeridynamics(surrounded, options);
    TAUTLINE_CHECK(with.matrix.values == without.matrix.values);
    TAUTLINE_CHECK(extremeEigenvalues(with.matrix).definite);
  }
}

/// Two triangles beside a notch: where they share the vertex at its end they interact, though the
/// segment between them leaves the mesh; a little apart they do not.
TAUTLINE_PART(testSharedVertex)
{
  TAUTLINE_LET(PeridynamicOptions, options, horizon = 1.2, basis = PeridynamicBasis::Constant,
    constrained = false);
  HorizonMesh notch;
  notch.points = { 0, 0, 1, 0.2, 0.6, 0.8, 0.6, -0.8, 1, -0.2 };
  notch.triangles = { 0, 1, 2, 0, 3, 4 };
  notch.layer = { 0, 0 };
  TAUTLINE_CHECK(std::abs(assemblePeridynamics(notch, options).matrix.at(0, 1)) > 1e-3);
  HorizonMesh apart = notch;
  const double below[] = { 0, -0.01 };
  apart.points.insert(apart.points.end(), below, below + 2);
  apart.triangles[3] = 5;
  TAUTLINE_CHECK_THROWS(
    assemblePeridynamics(apart, options), wording("row-0-of-the-matrix-is-empty"));
  options.cutBonds = false;
  TAUTLINE_CHECK(std::abs(assemblePeridynamics(apart, options).matrix.at(0, 1)) > 1e-3);
}

/// The energy of a free ring tends to the energy of a body whose bonds are cut at a circle: sums
/// over pairs of points that see each other.
double energyOfVisiblePoints(double inner, double outer, double delta, int n, double* whole)
{
  // Equal areas: rings of cells of about the same size.
  std::vector<Vec2> at;
  std::vector<double> weights, u;
  for (int j = 0; j < n; ++j)
  {
    const double r = inner + (outer - inner) * (j + 0.5) / n, dr = (outer - inner) / n;
    const int around = static_cast<int>(std::ceil(2.0 * M_PI * r / dr));
    for (int i = 0; i < around; ++i)
    {
      const double angle = 2.0 * M_PI * (i + 0.5) / around;
      at.push_back({ r * std::cos(angle), r * std::sin(angle) });
      weights.push_back(2.0 * M_PI * r * dr / around);
      u.push_back(at.back()[0] * at.back()[0]);
    }
  }
  double seen = 0.0, all = 0.0;
  for (std::size_t i = 0; i < at.size(); ++i)
  {
    for (std::size_t j = 0; j < at.size(); ++j)
    {
      const Vec2 xi = at[j] - at[i];
      const double square = dot(xi, xi);
      if (i == j || square >= delta * delta)
      {
        continue;
      }
      const double energy =
        weights[i] * weights[j] * (u[i] - u[j]) * (u[i] - u[j]) / std::sqrt(square);
      const double t = std::clamp(-dot(at[i], xi) / square, 0.0, 1.0);
      const Vec2 nearest = at[i] + t * xi;
      all += energy;
      seen += dot(nearest, nearest) >= inner * inner ? energy : 0.0;
    }
  }
  const double scale = 0.5 / std::pow(delta, 3.0);
  *whole = scale * all;
  return scale * seen;
}

TAUTLINE_PART(testCutEnergy)
{
  constexpr double inner = 0.3, outer = 0.6;
  TAUTLINE_LET(PeridynamicOptions, options, horizon = 0.5, tolerance = 1e-3, constrained = false);
  double whole = 0.0;
  const double expected = energyOfVisiblePoints(inner, outer, options.horizon, 24, &whole);
  double before = 1.0;
  for (const int across : { 3, 6 })
  {
    const HorizonMesh mesh = ring(16 * across / 3 * 2, across, inner, outer);
    std::vector<double> u;
    for (Index i = 0; i < mesh.numberOfPoints(); ++i)
    {
      u.push_back(mesh.points[2 * i] * mesh.points[2 * i]);
    }
    const double energy = product(u, times(assemblePeridynamics(mesh, options).matrix, u));
    const double error = std::abs(energy / expected - 1.0);
    std::printf("ring of %d: energy %.5f, visible %.5f, with bonds across the hole %.5f\n", across,
      energy, expected, whole);
    TAUTLINE_CHECK(error < before);
    before = error;
  }
  TAUTLINE_CHECK(before < 0.25 * (whole / expected - 1.0));
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testRejections)
{
  const HorizonMesh mesh = shakenSquare(8, 2, 0.0);
  TAUTLINE_CHECK_THROWS(assemblePeridynamics(mesh, stateBased(0.3)), wording("twice-the-horizon"));
  TAUTLINE_CHECK_THROWS(assemblePeridynamics(mesh, stateBased(0.5)), "below 0.5");
  TAUTLINE_CHECK_THROWS(assemblePeridynamics(mesh, stateBased(-1.0)), "above -1");
  TAUTLINE_CHECK_THROWS(assemblePeridynamics(mesh, stateBased(NAN)), wording("poisson-s-ratio-is"));
  PeridynamicOptions options = stateBased(0.3);
  options.discretization = Discretization::Dissertation;
  TAUTLINE_CHECK_THROWS(
    assemblePeridynamics(mesh, options), wording("take-the-exact-discretization"));
  options = {};
  TAUTLINE_CHECK_THROWS(peridynamicStrain(mesh, options, {}), wording("choose-one-of-them"));
  TAUTLINE_CHECK_THROWS(peridynamicStrain(mesh, stateBased(0.3), { 1.0 }), "1 values");
}
}
