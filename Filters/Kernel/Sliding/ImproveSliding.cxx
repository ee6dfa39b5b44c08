// SPDX-License-Identifier: BSD-3-Clause
#include "ImproveSliding.h"

#include "MovingBarrier.h"
#include "PlacePoints.h"

#include <algorithm>

namespace tautline
{
//------------------------------------------------------------------------------
std::vector<double> improveSliding(const Mesh& mesh, const BoundaryConstraints& constraints,
  const std::vector<double>& from, const SlidingImprovement& options)
{
  const Index points = mesh.view().numberOfPoints;
  const ConstrainedPoints constrained(mesh, constraints);
  const std::vector<Vec3> start = pointsOf(from.data(), points);
  std::vector<Vec3> x = start;
  const SlidingCells cells(mesh, constrained);
  BoundaryTerms boundary(mesh, constrained, pointsOf(mesh.view().points, points));
  boundary.moveTo(x);
  const auto stored = [&](const std::vector<Vec3>& places)
  {
    std::vector<double> result = from;
    storeMovedPoints(start, places, result.data());
    return result;
  };
  std::vector<signed char> validity(mesh.view().numberOfCells);
  const auto isValid = [&](const std::vector<double>& places)
  {
    mesh.at(places.data()).classifyCells(validity.data(), options.threads);
    return std::all_of(cells.cells().begin(), cells.cells().end(),
      [&](const SlidingCells::Cell& cell) { return validity[cell.cell] == Valid; });
  };
  BarrierOptions barrierOptions;
  barrierOptions.measure = options.measure;
  barrierOptions.enough = options.enough;
  barrierOptions.threads = options.threads;
  barrierOptions.proceed = [&](double) { return !options.proceed || options.proceed(); };
  MovingBarrier barrier(cells, constrained, boundary, x, barrierOptions);
  barrier.run(
    [&](const std::vector<Vec3>& places)
    {
      const std::vector<double> now = stored(places);
      return isValid(now) && (!options.accept || options.accept(now));
    });
  const std::vector<double> best = stored(x);
  const double worst = barrier.worstCorner();
  placeOnParts(cells, constrained, boundary, start, x,
    [&](std::int32_t c, const Vec3* vertices)
    {
      return mesh.classifyCell(*cells.cells()[c].t, vertices) == Valid &&
        barrier.worstCornerOf(c, vertices) >= worst;
    });
  const std::vector<double> placed = stored(x);
  return isValid(placed) && (!options.accept || options.accept(placed)) ? placed : best;
}
}
