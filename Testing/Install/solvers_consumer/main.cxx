// SPDX-License-Identifier: BSD-3-Clause
#include "tautline/Solvers/LinearSolver.h"

#include <cmath>
#include <cstdlib>
#include <iostream>

// 2 x - y = 1, 2 y - x = 1: x = y = 1.
int main()
{
  tautline::SparseMatrix matrix;
  matrix.size = 2;
  matrix.offsets = { 0, 2, 4 };
  matrix.columns = { 0, 1, 0, 1 };
  matrix.values = { 2, -1, -1, 2 };
  tautline::LinearSystem system;
  system.matrix = &matrix;
  tautline::SolverOptions options;
  options.preconditioner = tautline::Preconditioner::Jacobi;
  const double b[] = { 1, 1 };
  double x[] = { 0, 0 };
  tautline::LinearSolver solver(system, options);
  const tautline::LinearSolution solution = solver.solve(b, x);
  std::cout << tautline::describe(solution.reason) << " x = " << x[0] << ", " << x[1] << "\n";
  return std::abs(x[0] - 1) + std::abs(x[1] - 1) < 1e-4 ? EXIT_SUCCESS : EXIT_FAILURE;
}
