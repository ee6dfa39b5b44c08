// SPDX-License-Identifier: BSD-3-Clause
// Condition numbers of Tables 4.1 to 4.3 (h = 0.1 and 0.05) in both discretizations, against the
// printed values and against the columns and references of an independent prototype; what the
// text's own rules give; that unstructured meshes converge to the same limits.
#include "HorizonMeshes.h"
#include "Registry.h"

using namespace tautline;

namespace
{
TAUTLINE_PART(testDissertation)
{
  int right = 0;
  for (const TableCell& cell : tableCells())
  {
    const Context context("Table 4." + std::to_string(cell.table) + " AR " +
      std::to_string(cell.aspectRatio) + " n " + std::to_string(cell.n) + " delta " +
      std::to_string(cell.delta));
    const HorizonMesh mesh = horizonSquare(1.0 / cell.n, cell.aspectRatio, cell.delta);
    const PeridynamicOptions options = optionsOf(cell, Discretization::Dissertation);
    const PeridynamicSystem system = assemblePeridynamics(mesh, options);
    const Spectrum spectrum = extremeEigenvalues(system.matrix);
    TAUTLINE_CHECK(spectrum.converged && spectrum.definite);
    TAUTLINE_CHECK_RELATIVE(spectrum.condition, cell.column, 1e-3);
    if (cell.printedIsRight)
    {
      TAUTLINE_CHECK_RELATIVE(spectrum.condition, cell.printed, cell.table == 1 ? 0.02 : 0.005);
      ++right;
    }
    // On these meshes the rules are symmetric for linear functions, nearly so for constants.
    TAUTLINE_CHECK(system.asymmetry < (cell.table == 1 ? 2e-3 : 1e-13));
  }
  TAUTLINE_CHECK_EQUAL(right, 31);
}

TAUTLINE_PART_SLOW(testExact)
{
  for (const TableCell& cell : tableCells())
  {
    const Context context("exact 4." + std::to_string(cell.table) + " AR " +
      std::to_string(cell.aspectRatio) + " n " + std::to_string(cell.n) + " delta " +
      std::to_string(cell.delta));
    // The one grid whose lines miss the square's sides needs one more layer to be wide enough.
    const bool off = cell.aspectRatio == 4 && cell.n == 10 && cell.delta == 0.3;
    const HorizonMesh mesh = horizonSquare(1.0 / cell.n, cell.aspectRatio, cell.delta, off ? 1 : 0);
    PeridynamicOptions options = optionsOf(cell, Discretization::Exact);
    options.allowThinLayer = false;
    TAUTLINE_CHECK_RELATIVE(
      conditionOf(mesh, options), cell.reference, cell.table == 3 ? 2e-3 : 1e-3);
  }
}

/// One outer and three inner points, as in the text: column A; indefinite for p = 2.5.
TAUTLINE_PART(testLiteral)
{
  struct Case
  {
    int aspectRatio, n;
    double delta, p, condition; ///< 0: indefinite
  };
  const Case cases[] = { { 1, 10, 0.2, 1.0, 25.60 }, { 1, 10, 0.3, 1.0, 32.21 },
    { 4, 10, 0.2, 1.0, 16.29 }, { 1, 10, 0.2, 2.5, 553.18 }, { 4, 10, 0.2, 2.5, 0.0 },
    { 1, 20, 0.2, 2.5, 0.0 }, { 1, 20, 0.3, 2.5, 0.0 }, { 1, 20, 0.4, 2.5, 0.0 } };
  for (const Case& c : cases)
  {
    TAUTLINE_LET(PeridynamicOptions, options, horizon = c.delta, kernel.exponent = c.p,
      discretization = Discretization::Dissertation, rules = RuleSet::Literal);
    const Spectrum spectrum = extremeEigenvalues(
      assemblePeridynamics(horizonSquare(1.0 / c.n, c.aspectRatio, c.delta), options).matrix);
    TAUTLINE_CHECK_EQUAL(spectrum.definite, c.condition > 0.0);
    TAUTLINE_CHECK_RELATIVE(spectrum.condition, c.condition, 1e-3);
    TAUTLINE_CHECK_EQUAL(spectrum.smallest < 0.0, c.condition == 0.0);
  }
}

/// The errors of the matrix that PeridynamicOptions::tolerance states.
TAUTLINE_PART_SLOW(testTolerance)
{
  constexpr int n = 6;
  constexpr double tolerances[] = { 1e-3, 1e-5, 1e-7 }, reference = 1e-8;
  struct Case
  {
    double horizon; ///< in elements
    double errors[3];
  };
  for (const Case& each : { Case{ 1.5, { 3e-3, 5e-4, 1e-4 } }, Case{ 0.3, { 7e-3, 8e-4, 3e-4 } } })
  {
    TAUTLINE_LET(PeridynamicOptions, options, horizon = each.horizon / n, tolerance = reference);
    const HorizonMesh mesh = shakenSquare(n, static_cast<int>(std::ceil(each.horizon)), 0.2);
    const SparseMatrix exact = assemblePeridynamics(mesh, options).matrix;
    const double largest = *std::max_element(exact.values.begin(), exact.values.end());
    for (int k = 0; k < 3; ++k)
    {
      const Context context("horizon " + std::to_string(each.horizon) + " elements, tolerance " +
        std::to_string(tolerances[k]));
      options.tolerance = tolerances[k];
      const SparseMatrix matrix = assemblePeridynamics(mesh, options).matrix;
      double worst = 0.0;
      for (Index row = 0; row < exact.size; ++row)
      {
        for (Index at = exact.offsets[row]; at < exact.offsets[row + 1]; ++at)
        {
          const double difference = matrix.at(row, exact.columns[at]) - exact.values[at];
          worst = std::max(worst, std::abs(difference));
        }
      }
      TAUTLINE_CHECK(worst <= each.errors[k] * largest);
    }
  }
}

/// The tolerance converges; so do irregular meshes, to what the regular ones tend to.
TAUTLINE_PART(testConvergence)
{
  TAUTLINE_LET(PeridynamicOptions, options, kernel.exponent = 2.5);
  const HorizonMesh shaken = shakenSquare(5, 1, 0.25);
  options.horizon = 0.2;
  double last = 0.0, change = 1.0;
  for (const double tolerance : { 1e-3, 1e-5, 1e-7 })
  {
    options.tolerance = tolerance;
    const double condition = conditionOf(shaken, options);
    if (last > 0.0)
    {
      change = std::abs(condition / last - 1.0);
    }
    last = condition;
  }
  TAUTLINE_CHECK(change < 1e-4);

  options = {};
  TAUTLINE_SET(options, horizon = 0.25, tolerance = 1e-4);
  double smallest[2][2];
  for (const int level : { 0, 1 })
  {
    const int n = level == 0 ? 8 : 16;
    for (const bool regular : { true, false })
    {
      const HorizonMesh mesh = shakenSquare(n, n / 4, regular ? 0.0 : 0.2);
      const PeridynamicSystem system = assemblePeridynamics(mesh, options);
      // Over the mass of a vertex of the regular mesh: the operator's lowest eigenvalue + O(h^2).
      smallest[level][regular] = extremeEigenvalues(system.matrix).smallest * n * n;
    }
  }
  const double coarse = std::abs(smallest[0][0] / smallest[0][1] - 1.0);
  const double fine = std::abs(smallest[1][0] / smallest[1][1] - 1.0);
  TAUTLINE_CHECK(coarse < 0.02 && fine < 0.01);
}
}
