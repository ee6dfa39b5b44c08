// SPDX-License-Identifier: BSD-3-Clause
#include "tautline/Core/Version.h"
#include "tautline/Quality/Metrics.h"

#include <cmath>
#include <cstdlib>
#include <iostream>

// The inverse mean ratio of a regular tetrahedron is 1.
int main()
{
  const double points[] = { 1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1 };
  const unsigned char type = 10; // a tetrahedron
  const tautline::Index offsets[] = { 0, 4 }, nodes[] = { 0, 2, 1, 3 };
  tautline::MeshView view;
  view.numberOfPoints = 4;
  view.points = points;
  view.numberOfCells = 1;
  view.cellTypes = &type;
  view.offsets = offsets;
  view.connectivity = nodes;
  double value = 0;
  tautline::evaluateMetric(tautline::Mesh(view), tautline::Metric::InverseMeanRatio,
    tautline::EvaluationOptions(), &value);
  std::cout << "Tautline kernel " << tautline::version() << ", inverse mean ratio " << value
            << "\n";
  return std::abs(value - 1) < 1e-12 ? EXIT_SUCCESS : EXIT_FAILURE;
}
