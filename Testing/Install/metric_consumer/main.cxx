// SPDX-License-Identifier: BSD-3-Clause
// Loads a library of metrics and optimizes by one: metric_consumer LIBRARY.
#include "tautline/Optimization/Optimize.h"
#include "tautline/Quality/UserMetric.h"

#include <cmath>
#include <cstdlib>
#include <iostream>

// Four triangles round a point that is not in the middle: it moves there.
int main(int argc, char* argv[])
{
  if (argc != 2)
  {
    std::cerr << "usage: metric_consumer LIBRARY\n";
    return EXIT_FAILURE;
  }
  try
  {
    tautline::loadMetrics(argv[1]);
    const tautline::MetricInfo* info = tautline::findMetric("My distortion");
    if (!info)
    {
      throw tautline::Error("the library does not register the metric");
    }
    const double points[] = { 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.7, 0.4, 0 };
    const unsigned char types[] = { 5, 5, 5, 5 };
    const tautline::Index offsets[] = { 0, 3, 6, 9, 12 };
    const tautline::Index nodes[] = { 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4 };
    tautline::MeshView view;
    view.numberOfPoints = 5;
    view.points = points;
    view.numberOfCells = 4;
    view.cellTypes = types;
    view.offsets = offsets;
    view.connectivity = nodes;
    tautline::OptimizeOptions options;
    options.objectives[0].metric = info->metric;
    const tautline::OptimizeResult result = tautline::optimize(tautline::Mesh(view), options);
    std::cout << info->label << ": sum of squares " << result.history.front().objective << " to "
              << result.history.back().objective << ", point at " << result.points[12] << " "
              << result.points[13] << "\n";
    const bool found =
      std::abs(result.points[12] - 0.5) < 1e-3 && std::abs(result.points[13] - 0.5) < 1e-3;
    return found ? EXIT_SUCCESS : EXIT_FAILURE;
  }
  catch (const std::exception& error)
  {
    std::cerr << error.what() << "\n";
    return EXIT_FAILURE;
  }
}
