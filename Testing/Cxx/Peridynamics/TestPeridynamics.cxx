// SPDX-License-Identifier: BSD-3-Clause
// The nonlocal matrices: formulas, symmetry, definiteness, null spaces, the local limit, kernels,
// threads, rejections; their interaction layer, disc, eigenvalues and solver.
#include "HorizonMeshes.h"
#include "Registry.h"
#include "tautline/Peridynamics/InteractionLayer.h"

using namespace tautline;

namespace
{
/// A function of the plane on the functions of a basis.
template <class Function>
std::vector<double> sampled(const HorizonMesh& mesh, PeridynamicBasis basis, const Function& f)
{
  std::vector<double> values;
  const auto at = [&](Index i) { return f(mesh.points[2 * i], mesh.points[2 * i + 1]); };
  if (basis == PeridynamicBasis::Linear)
  {
    for (Index i = 0; i < mesh.numberOfPoints(); ++i)
    {
      values.push_back(at(i));
    }
    return values;
  }
  for (Index t = 0; t < mesh.numberOfTriangles(); ++t)
  {
    double mean = 0.0;
    for (int k = 0; k < 3; ++k)
    {
      mean += at(mesh.triangles[3 * t + k]) / 3.0;
      if (basis == PeridynamicBasis::DiscontinuousLinear)
      {
        values.push_back(at(mesh.triangles[3 * t + k]));
      }
    }
    if (basis == PeridynamicBasis::Constant)
    {
      values.push_back(mean);
    }
  }
  return values;
}

double largestSize(const std::vector<double>& values)
{
  return largestOf<double>(0.0, values, [&](const double v) { return std::abs(v); });
}

//------------------------------------------------------------------------------
/// Exactly symmetric; constants, and rigid motions, are in the null space before constraints;
/// definite after.
TAUTLINE_PART(testStructure)
{
  const HorizonMesh mesh = shakenSquare(4, 1, 0.2);
  for (const PeridynamicBasis basis : bases)
  {
    for (const bool elastic : { false, true })
    {
      for (const bool exact : { false, true })
      {
        const Context context("basis " + std::to_string(static_cast<int>(basis)) +
          (elastic ? " elastic" : "") + (exact ? " exact" : ""));
        TAUTLINE_LET(PeridynamicOptions, options, horizon = 0.25, tolerance = 1e-4, basis = basis,
          model = elastic ? PeridynamicModel::Elastic : PeridynamicModel::Scalar,
          discretization = exact ? Discretization::Exact : Discretization::Dissertation,
          kernel.exponent = elastic ? 3.0 : 1.0);
        const PeridynamicSystem held = assemblePeridynamics(mesh, options);
        TAUTLINE_CHECK(extremeEigenvalues(held.matrix).definite);
        const SparseMatrix& a = held.matrix;
        bool symmetric = true;
        for (Index row = 0; row < a.size; ++row)
        {
          for (Index k = a.offsets[row]; k < a.offsets[row + 1]; ++k)
          {
            symmetric = symmetric && a.values[k] == a.at(a.columns[k], row);
          }
        }
        TAUTLINE_CHECK(symmetric);
        // On an irregular mesh the discretizations differ: the dissertation's is not symmetric.
        TAUTLINE_CHECK_EQUAL(held.asymmetry > 1e-6, !exact);

        options.constrained = false;
        const PeridynamicSystem free = assemblePeridynamics(mesh, options);
        TAUTLINE_CHECK_EQUAL(free.matrix.size, (elastic ? 2 : 1) * numberOfFunctions(mesh, basis));
        if (!exact)
        {
          continue; // its symmetric part has no null space
        }
        std::vector<double> ones(free.matrix.size, 1.0);
        const double size = free.matrix.at(0, 0);
        TAUTLINE_CHECK(largestSize(times(free.matrix, ones)) < 1e-12 * size);
        if (elastic && basis != PeridynamicBasis::Constant)
        {
          const auto x = sampled(mesh, basis, [](double px, double) { return px; });
          const auto y = sampled(mesh, basis, [](double, double py) { return py; });
          std::vector<double> turn;
          for (std::size_t i = 0; i < x.size(); ++i)
          {
            turn.insert(turn.end(), { -y[i], x[i] });
          }
          TAUTLINE_CHECK(largestSize(times(free.matrix, turn)) < 1e-4 * size);
          TAUTLINE_CHECK(
            largestSize(times(free.matrix, x.size() == turn.size() ? x : ones)) < size);
        }
        TAUTLINE_CHECK(!extremeEigenvalues(free.matrix).definite);
      }
    }
  }
}

//------------------------------------------------------------------------------
/// Values known in closed form.
TAUTLINE_PART(testFormulas)
{
  // Constant kernel, constant basis: the diagonal is delta^-4 (|T| pi delta^2 - |T|^2).
  const HorizonMesh mesh = horizonSquare(0.125, 1, 0.25);
  TAUTLINE_LET(PeridynamicOptions, options, horizon = 0.25, basis = PeridynamicBasis::Constant,
    kernel.shape = KernelShape::Constant, tolerance = 1e-8);
  const double area = 0.5 * 0.125 * 0.125, delta = 0.25;
  PeridynamicSystem system = assemblePeridynamics(mesh, options);
  const double expected = (area * M_PI * delta * delta - area * area) / std::pow(delta, 4);
  for (const Index row : { 0, 17, 63, 127 })
  {
    TAUTLINE_CHECK_RELATIVE(system.matrix.at(row, row), expected, 5e-6);
  }
  options.kernel.shape = KernelShape::Power;
  // A linear function is in the kernel of the operator: rows of inner vertices vanish on it.
  TAUTLINE_SET(options, basis = PeridynamicBasis::Linear, constrained = false);
  for (const double p : { 1.0, 2.0, 3.5 })
  {
    options.kernel.exponent = p;
    const HorizonMesh shaken = shakenSquare(4, 1, 0.2);
    TAUTLINE_SET(options, horizon = 0.25, tolerance = 1e-7);
    system = assemblePeridynamics(shaken, options);
    const auto u = sampled(shaken, options.basis, [](double x, double y) { return x - 2.0 * y; });
    const std::vector<double> r = times(system.matrix, u);
    double worst = 0.0;
    for (Index i = 0; i < shaken.numberOfPoints(); ++i)
    {
      const double x = shaken.points[2 * i], y = shaken.points[2 * i + 1];
      if (x > 0.3 && x < 0.7 && y > 0.3 && y < 0.7)
      {
        worst = std::max(worst, std::abs(r[i]) / system.matrix.at(i, i));
      }
    }
    TAUTLINE_CHECK(worst < 1e-3);
  }
}

//------------------------------------------------------------------------------
/// Solves with the source of a known local problem; the largest error at the unknown vertices.
double solutionError(int n, double delta, double p, bool quadratic)
{
  const HorizonMesh mesh = horizonSquare(1.0 / n, 1, delta);
  TAUTLINE_LET(PeridynamicOptions, options, horizon = delta, kernel.exponent = p, tolerance = 1e-5);
  const double factor = M_PI / (2.0 * (4.0 - p)); // of the local limit
  const auto exact = [=](double x, double y)
  { return quadratic ? x * x + y * y : std::sin(M_PI * x) * std::sin(M_PI * y); };
  const auto source = [=](double x, double y)
  { return factor * (quadratic ? -4.0 : 2.0 * M_PI * M_PI * exact(x, y)); };
  const std::vector<double> given = sampled(mesh, options.basis, exact);
  const PeridynamicSystem system = assemblePeridynamics(mesh, options, &given);
  std::vector<double> load =
    sourceLoad(mesh, system, options.basis, sampled(mesh, options.basis, source), true);
  for (std::size_t i = 0; i < load.size(); ++i)
  {
    load[i] -= system.constraintLoad[i];
  }
  std::vector<double> solution;
  TAUTLINE_CHECK(solveConjugateGradients(system.matrix, load, solution).converged);
  return largestOf<double>(0.0, solution.size(),
    [&](std::size_t i) { return std::abs(solution[i] - given[system.functionOf[i]]); });
}

/// The operator tends to pi / (2 (4-p)) times the Laplacian: with delta^2 for smooth functions; on
/// a fixed mesh with delta, as functions have kinks.
TAUTLINE_PART(testLocalLimit)
{
  for (const double p : { 1.0, 2.5 })
  {
    // A quadratic has no higher derivatives: right for every horizon, up to the elements.
    TAUTLINE_CHECK(solutionError(10, 0.3, p, true) < 2e-3);
    const double coarse = solutionError(20, 0.4, p, false), fine = solutionError(20, 0.2, p, false);
    const double rate = std::log2(coarse / fine);
    TAUTLINE_CHECK_NEAR(rate, 2.0, 0.25);

    const HorizonMesh mesh = shakenSquare(4, 1, 0.15);
    TAUTLINE_LET(PeridynamicOptions, options, kernel.exponent = p);
    double errors[3];
    for (int level = 0; level < 3; ++level)
    {
      options.horizon = 0.04 / (1 << level);
      const PeridynamicSystem system = assemblePeridynamics(mesh, options);
      // The energy of x^2 on the unknown vertices, against the energy of the local form.
      const auto u =
        sampled(mesh, options.basis, [](double x, double y) { return x * (1 - x) * y * (1 - y); });
      std::vector<double> inside(system.matrix.size), all(u.size(), 0.0);
      for (Index i = 0; i < system.matrix.size; ++i)
      {
        inside[i] = u[system.functionOf[i]];
        all[system.functionOf[i]] = inside[i];
      }
      const std::vector<double> au = times(system.matrix, inside);
      double nonlocal = 0.0, local = 0.0;
      for (Index i = 0; i < system.matrix.size; ++i)
      {
        nonlocal += inside[i] * au[i];
      }
      for (Index t = 0; t < mesh.numberOfTriangles(); ++t)
      {
        const Index* id = &mesh.triangles[3 * t];
        const auto point = [&](int k, int c) { return mesh.points[2 * id[k % 3] + c]; };
        double gx = 0.0, gy = 0.0;
        const double twice = (point(1, 0) - point(0, 0)) * (point(2, 1) - point(0, 1)) -
          (point(1, 1) - point(0, 1)) * (point(2, 0) - point(0, 0));
        for (int k = 0; k < 3; ++k)
        {
          gx -= all[id[k]] * (point(k + 2, 1) - point(k + 1, 1)) / twice;
          gy += all[id[k]] * (point(k + 2, 0) - point(k + 1, 0)) / twice;
        }
        local += 0.5 * twice * (gx * gx + gy * gy);
      }
      errors[level] = std::abs(nonlocal / (M_PI / (2.0 * (4.0 - p)) * local) - 1.0);
    }
    TAUTLINE_CHECK(errors[0] < 0.1);
    TAUTLINE_EACH(
      int, level, 2, TAUTLINE_CHECK_NEAR(std::log2(errors[level] / errors[level + 1]), 1.0, 0.15));
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testKernels)
{
  const HorizonMesh mesh = horizonSquare(0.125, 1, 0.25);
  TAUTLINE_LET(PeridynamicOptions, options, horizon = 0.25);
  const auto with = [&](KernelShape shape, std::vector<double> table, double width)
  {
    TAUTLINE_SET(
      options, kernel.shape = shape, kernel.table = std::move(table), kernel.width = width);
    const Spectrum s = extremeEigenvalues(assemblePeridynamics(mesh, options).matrix);
    TAUTLINE_CHECK(s.definite && s.converged);
    return s;
  };
  options.kernel.exponent = 0.0;
  for (const Discretization discretization :
    { Discretization::Dissertation, Discretization::Exact })
  {
    options.discretization = discretization;
    const Spectrum power = with(KernelShape::Power, {}, 0.5);
    const Spectrum constant = with(KernelShape::Constant, {}, 0.5);
    TAUTLINE_CHECK(power.smallest == constant.smallest && power.largest == constant.largest);
    const Spectrum table = with(KernelShape::Table, { 1.0, 1.0, 1.0 }, 0.5);
    TAUTLINE_CHECK_RELATIVE(table.condition, constant.condition, 1e-6);
    TAUTLINE_CHECK_RELATIVE(with(KernelShape::Gaussian, {}, 1e3).smallest, constant.smallest, 1e-5);
    const Spectrum cone = with(KernelShape::Conical, {}, 0.5);
    TAUTLINE_CHECK_RELATIVE(
      with(KernelShape::Table, { 1.0, 0.0 }, 0.5).smallest, cone.smallest, 1e-6);
    TAUTLINE_CHECK(cone.smallest < constant.smallest);
    // Weights nearer to the point make a more local operator: a larger condition number.
    TAUTLINE_CHECK(with(KernelShape::Gaussian, {}, 0.3).condition > constant.condition);
  }
  // Exponents on both sides of every special case are close to it.
  for (const double p : { 2.0, 3.0 })
  {
    options = {};
    TAUTLINE_SET(options, horizon = 0.25, kernel.exponent = p);
    const double at = conditionOf(mesh, options);
    for (const double side : { -1e-5, 1e-5 })
    {
      options.kernel.exponent = p + side;
      TAUTLINE_CHECK_RELATIVE(conditionOf(mesh, options), at, 1e-4);
    }
  }
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testThreads)
{
  const HorizonMesh regular = horizonSquare(0.1, 1, 0.2), shaken = shakenSquare(5, 1, 0.2);
  for (const HorizonMesh* mesh : { &regular, &shaken })
  {
    for (const PeridynamicBasis basis : bases)
    {
      for (const Discretization discretization :
        { Discretization::Dissertation, Discretization::Exact })
      {
        TAUTLINE_LET(PeridynamicOptions, options, tolerance = 1e-3, basis = basis,
          discretization = discretization, threads = 1);
        const PeridynamicSystem one = assemblePeridynamics(*mesh, options);
        TAUTLINE_LET(LanczosOptions, lanczos, threads = 1);
        const Spectrum first = extremeEigenvalues(one.matrix, lanczos);
        for (const int threads : { 2, 3 })
        {
          options.threads = lanczos.threads = threads;
          const PeridynamicSystem other = assemblePeridynamics(*mesh, options);
          TAUTLINE_CHECK(other.matrix.values == one.matrix.values);
          TAUTLINE_CHECK(other.matrix.columns == one.matrix.columns);
          TAUTLINE_CHECK(extremeEigenvalues(one.matrix, lanczos).condition == first.condition);
        }
      }
    }
  }
  // Pairs that are congruent give the same whether they are integrated once or each by itself.
  TAUTLINE_LET(PeridynamicOptions, options, kernel.exponent = 2.5);
  const PeridynamicSystem once = assemblePeridynamics(regular, options);
  options.reuseCongruent = false;
  const PeridynamicSystem each = assemblePeridynamics(regular, options);
  TAUTLINE_CHECK(once.integratedPairs < each.integratedPairs);
  TAUTLINE_CHECK_EQUAL(once.matrix.nonzeros(), each.matrix.nonzeros());
  TAUTLINE_EACH(std::size_t, k, once.matrix.values.size(),
    TAUTLINE_CHECK_NEAR(
      once.matrix.values[k], each.matrix.values[k], 1e-4 * once.matrix.values[0]));
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testInteractionLayer)
{
  // The matrix of the exact discretization does not depend on how the interaction layer is cut, as
  // the functions are 0 there.
  const HorizonMesh regular = horizonSquare(0.1, 1, 0.2);
  HorizonMesh bare;
  std::vector<Index> newId(regular.numberOfPoints(), -1);
  for (Index t = 0; t < regular.numberOfTriangles(); ++t)
  {
    for (int k = 0; !regular.layer[t] && k < 3; ++k)
    {
      Index& id = newId[regular.triangles[3 * t + k]];
      if (id < 0)
      {
        id = bare.numberOfPoints();
        const double* p = &regular.points[2 * regular.triangles[3 * t + k]];
        bare.points.insert(bare.points.end(), { p[0], p[1] });
      }
      bare.triangles.push_back(id);
    }
  }
  bare.layer.assign(bare.numberOfTriangles(), 0);
  InteractionLayerOptions layer;
  HorizonMesh reversed = bare;
  for (std::size_t t = 0; t < reversed.triangles.size(); t += 3)
  {
    std::swap(reversed.triangles[t], reversed.triangles[t + 1]);
  }
  TAUTLINE_LET(PeridynamicOptions, options, tolerance = 1e-7);
  const double condition = conditionOf(regular, options);
  for (const HorizonMesh* inner : { &bare, &reversed })
  {
    const HorizonMesh made = addInteractionLayer(*inner, layer);
    TAUTLINE_CHECK_EQUAL(layerDeficit(made, layer.width), 0.0);
    TAUTLINE_CHECK(std::equal(inner->points.begin(), inner->points.end(), made.points.begin()));
    TAUTLINE_CHECK(
      std::equal(inner->triangles.begin(), inner->triangles.end(), made.triangles.begin()));
    TAUTLINE_CHECK_RELATIVE(conditionOf(made, options), condition, 1e-5);
    layer.threads = 1;
    TAUTLINE_CHECK(addInteractionLayer(*inner, layer).points == made.points);
    layer.threads = 0;
  }
  // Around a hole as well; the area equals the covered area.
  HorizonMesh ring = shakenSquare(12, 0, 0.0);
  HorizonMesh cut = ring;
  cut.triangles.clear();
  cut.layer.clear();
  for (Index t = 0; t < ring.numberOfTriangles(); ++t)
  {
    const Index cell = t / 2, i = cell % 12, j = cell / 12;
    if (i < 4 || i >= 8 || j < 4 || j >= 8)
    {
      cut.triangles.insert(cut.triangles.end(), &ring.triangles[3 * t], &ring.triangles[3 * t] + 3);
      cut.layer.push_back(0);
    }
  }
  layer.width = 0.1;
  const HorizonMesh made = addInteractionLayer(cut, layer);
  TAUTLINE_CHECK_EQUAL(layerDeficit(made, 0.1), 0.0);
  double area = 0.0;
  for (Index t = cut.numberOfTriangles(); t < made.numberOfTriangles(); ++t)
  {
    const Index* id = &made.triangles[3 * t];
    const auto x = [&](int k) { return made.points[2 * id[k]]; };
    const auto y = [&](int k) { return made.points[2 * id[k] + 1]; };
    const double twice = (x(1) - x(0)) * (y(2) - y(0)) - (y(1) - y(0)) * (x(2) - x(0));
    TAUTLINE_CHECK(twice > 0.0);
    area += 0.5 * twice;
  }
  const double least = 4 * 0.1 + M_PI * 0.01 + 1.0 / 9.0 - std::pow(1.0 / 3.0 - 0.2, 2);
  TAUTLINE_CHECK(area > least && area < 2.0 * least);
  // In the bay of a concave domain nothing is bridged: no triangle of the layer is long.
  HorizonMesh bay = ring;
  bay.triangles.clear();
  for (Index t = 0; t < ring.numberOfTriangles(); ++t)
  {
    const Index cell = t / 2, i = cell % 12, j = cell / 12;
    if (i < 2 || i >= 10 || j < 2)
    {
      bay.triangles.insert(bay.triangles.end(), &ring.triangles[3 * t], &ring.triangles[3 * t] + 3);
    }
  }
  bay.layer.assign(bay.numberOfTriangles(), 0);
  const HorizonMesh held = addInteractionLayer(bay, layer);
  TAUTLINE_CHECK_EQUAL(layerDeficit(held, 0.1), 0.0);
  for (Index t = bay.numberOfTriangles(); t < held.numberOfTriangles(); ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      const double* a = &held.points[2 * held.triangles[3 * t + k]];
      const double* b = &held.points[2 * held.triangles[3 * t + (k + 1) % 3]];
      TAUTLINE_CHECK(std::hypot(a[0] - b[0], a[1] - b[1]) < 2.5 / 12);
    }
  }
  layer.width = 0.0;
  TAUTLINE_CHECK_THROWS(
    addInteractionLayer(bare, layer), wording("width-of-the-interaction-layer-is-0"));
  TAUTLINE_SET(layer, width = 0.2, elementSize = 1e-7);
  TAUTLINE_CHECK_THROWS(addInteractionLayer(bare, layer), wording("larger-element-size"));
  layer.elementSize = 0.0;
  layer.progress = [](double) { return false; };
  TAUTLINE_CHECK_THROWS(addInteractionLayer(bare, layer), "stopped");
  TAUTLINE_LET(PeridynamicOptions, far, horizon = 1e7);
  TAUTLINE_CHECK_THROWS(assemblePeridynamics(bare, far), wording("the-mesh-extends-over-1-only"));
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testDisc)
{
  const double triangle[] = { 0, 0, 4, 0, 0, 4 };
  DiscIntersection d = intersectDisc(triangle, 1, 1, 0.5);
  TAUTLINE_CHECK_EQUAL(d.corners, 0);
  TAUTLINE_CHECK_RELATIVE(d.exactArea, M_PI * 0.25, 1e-14);
  TAUTLINE_CHECK_EQUAL(d.chordArea, 0.0);
  d = intersectDisc(triangle, 0, 0, 1);
  TAUTLINE_CHECK_EQUAL(d.corners, 1);
  TAUTLINE_CHECK_RELATIVE(d.exactArea, M_PI / 4, 1e-14);
  TAUTLINE_CHECK_RELATIVE(d.chordArea, 0.5, 1e-14);
  d = intersectDisc(triangle, 2, 2, 2.9);
  TAUTLINE_CHECK_EQUAL(d.corners, 3);
  TAUTLINE_CHECK_RELATIVE(d.exactArea, 8.0, 1e-14);
  TAUTLINE_CHECK_EQUAL(d.chords.size(), 6u);
  d = intersectDisc(triangle, 0, 2, 2.0);
  TAUTLINE_CHECK_EQUAL(d.corners, 2);
  TAUTLINE_CHECK_RELATIVE(d.exactArea, M_PI + 2.0, 1e-14); // a quarter disc and a right triangle
  TAUTLINE_CHECK_RELATIVE(d.chordArea, 4.0, 1e-14);
  TAUTLINE_CHECK_EQUAL(intersectDisc(triangle, -3, 0, 2.0).exactArea, 0.0);
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testEigenvalues)
{
  // The second difference: 2 - 2 cos(k pi / (n + 1)).
  const Index n = 200;
  TAUTLINE_LET(SparseMatrix, a, size = n);
  for (Index i = 0; i < n; ++i)
  {
    for (Index j = std::max<Index>(0, i - 1); j <= std::min(n - 1, i + 1); ++j)
    {
      a.columns.push_back(static_cast<std::int32_t>(j));
      a.values.push_back(i == j ? 2.0 : -1.0);
    }
    a.offsets.push_back(a.nonzeros());
  }
  const auto exact = [&](Index k) { return 2.0 - 2.0 * std::cos(k * M_PI / (n + 1)); };
  const Spectrum s = extremeEigenvalues(a);
  TAUTLINE_CHECK(s.converged && s.definite);
  TAUTLINE_CHECK_RELATIVE(s.smallest, exact(1), 1e-9);
  TAUTLINE_CHECK_RELATIVE(s.largest, exact(n), 1e-9);
  const std::vector<double> image = times(a, s.smallestVector);
  TAUTLINE_EACH(Index, i, n, TAUTLINE_CHECK_NEAR(image[i], s.smallest * s.smallestVector[i], 1e-6));
  TAUTLINE_LET(LanczosOptions, few, maxIterations = 10);
  const Spectrum rough = extremeEigenvalues(a, few);
  TAUTLINE_CHECK(!rough.converged && rough.iterations == 10);
  TAUTLINE_CHECK(rough.largest < exact(n) && rough.smallest > exact(1));
  few.maxIterations = 2000;
  few.progress = [](double) { return false; };
  TAUTLINE_CHECK(!extremeEigenvalues(a, few).converged);
  std::vector<double> x;
  TAUTLINE_CHECK(solveConjugateGradients(a, times(a, std::vector<double>(n, 3.0)), x).converged);
  TAUTLINE_CHECK_NEAR(x[n / 2], 3.0, 1e-7);
  a.values[0] = -1.0;
  TAUTLINE_CHECK(!extremeEigenvalues(a).definite);
  TAUTLINE_CHECK_THROWS(solveConjugateGradients(a, x, x), wording("not-positive-definite"));
  TAUTLINE_CHECK_THROWS(extremeEigenvalues(SparseMatrix()), "empty");
  a.values[0] = std::numeric_limits<double>::quiet_NaN();
  TAUTLINE_CHECK_THROWS(extremeEigenvalues(a), wording("not-finite"));
}

//------------------------------------------------------------------------------
TAUTLINE_PART(testRejections)
{
  const HorizonMesh mesh = horizonSquare(0.25, 1, 0.25);
  TAUTLINE_LET(PeridynamicOptions, good, horizon = 0.25);
#define REJECTED(text, ...) \
  TAUTLINE_CHECK_THROWS(assemblePeridynamics(mesh, TAUTLINE_CHANGED(good, __VA_ARGS__)), text)
#define REJECTED_MESH(text, ...) \
  TAUTLINE_CHECK_THROWS(assemblePeridynamics(TAUTLINE_CHANGED(mesh, __VA_ARGS__), good), text)
  const std::vector<Index>& t = mesh.triangles;
  using Flags = decltype(mesh.layer);
  REJECTED(wording("horizon-is-0"), horizon = 0.0);
  REJECTED(wording("horizon-is-nan"), horizon = std::nan(""));
  REJECTED(wording("to-below-4"), kernel.exponent = 4.0);
  REJECTED(wording("to-below-3"), kernel.exponent = 3.0, basis = PeridynamicBasis::Constant);
  REJECTED("from 0", kernel.exponent = -0.5);
  REJECTED(wording("to-below-6"), kernel.exponent = 6.0, model = PeridynamicModel::Elastic);
  REJECTED(wording("an-interaction-layer-of-width-0-3"), horizon = 0.3);
  REJECTED_MESH(wording("has-no-interaction-layer"), layer = Flags(mesh.layer.size(), 0));
  REJECTED_MESH(wording("no-unknown"), givenPoints.clear(), layer = Flags(mesh.layer.size(), 1));
  REJECTED_MESH(
    wording("1-of-72-triangles-are-inverted-the"), triangles[15] = t[16], triangles[16] = t[15]);
  REJECTED_MESH(wording("triangle-5-is-degenerate"), triangles[15] = t[16]);
  REJECTED_MESH(wording("not-finite"), points[20] = std::nan(""));
  REJECTED_MESH(wording("has-point-4000"), triangles[7] = 4000);
  REJECTED(wording("mib-are-allowed"), memoryLimit = 1000.0);
  REJECTED(wording("time-limit"), timeLimit = 1e-9);
  REJECTED(
    wording("stopped-by-the-user"), progress = [](double) { return false; });
  REJECTED(wording("tabulated-kernel-needs"), kernel.shape = KernelShape::Table);
  REJECTED(
    wording("width-of-the-gaussian"), kernel.shape = KernelShape::Gaussian, kernel.width = 0.0);
  REJECTED("tolerance", tolerance = 0.0);
  REJECTED(
    wording("find-no-neighbour"), discretization = Discretization::Dissertation, horizon = 0.01);
  TAUTLINE_CHECK_THROWS(horizonSquare(0.1, 3, 0.2), wording("whole-number"));
  TAUTLINE_CHECK_EQUAL(layerDeficit(mesh, 0.25), 0.0);
  TAUTLINE_CHECK_NEAR(layerDeficit(mesh, 0.4), 0.15, 1e-12);

  // A mesh reversed throughout is as good as any.
  HorizonMesh reversed = mesh;
  for (std::size_t t = 0; t < reversed.triangles.size(); t += 3)
  {
    std::swap(reversed.triangles[t], reversed.triangles[t + 1]);
  }
  for (const PeridynamicBasis basis : bases)
  {
    good.basis = basis;
    TAUTLINE_CHECK_RELATIVE(conditionOf(reversed, good), conditionOf(mesh, good), 1e-4);
  }
  // A horizon smaller than the elements, and one larger than the domain.
  good = {};
  good.horizon = 0.02;
  const double small = conditionOf(mesh, good);
  TAUTLINE_CHECK(small > 1.0 && small < 20.0);
  good.horizon = 3.0;
  TAUTLINE_CHECK(conditionOf(horizonSquare(0.25, 1, 3.0), good) > 1.0);
  // Triangles of an aspect ratio of 64 and longer than the horizon.
  good.horizon = 0.2;
  TAUTLINE_CHECK_RELATIVE(conditionOf(horizonSquare(1.0 / 20, 16, 0.2), good), 16.23, 0.05);
}
}
