// SPDX-License-Identifier: BSD-3-Clause
#include "PlacePoints.h"

#include "tautline/Core/Interruption.h"

#include <algorithm>

namespace tautline
{
//------------------------------------------------------------------------------
void placeOnParts(const SlidingCells& cells, const ConstrainedPoints& constrained,
  BoundaryTerms& boundary, const std::vector<Vec3>& start, std::vector<Vec3>& x,
  const std::function<bool(std::int32_t cell, const Vec3* vertices)>& allows)
{
  constexpr int halvings = 3;
  const auto isAllowed = [&](Index p)
  {
    const std::int32_t *cell = &cells.cellsOf()[0] + cells.starts()[p],
                       *end = &cells.cellsOf()[0] + cells.starts()[p + 1];
    return std::all_of(cell, end,
      [&](std::int32_t c)
      {
        Vec3 vertices[MaxNodes];
        cells.load(cells.cells()[c], x, vertices);
        return allows(c, vertices);
      });
  };
  boundary.moveTo(x);
  boundary.indexSamples();
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    const auto p = static_cast<Index>(i);
    pollInterruption(p);
    if (constrained.band(p) < 0 || x[i] == start[i] || cells.starts()[i] == cells.starts()[i + 1])
    {
      continue;
    }
    const Vec3 from = x[i], to = constrained.onPart(p, from);
    double t = 1;
    for (int half = 0; half <= halvings; ++half, t *= 0.5)
    {
      x[i] = half == 0 ? to : from + t * (to - from);
      if (isAllowed(p) && boundary.allows(p, x))
      {
        break;
      }
      x[i] = from;
    }
    boundary.moveOne(p, x);
  }
}

//------------------------------------------------------------------------------
OffSurface offSurface(const ConstrainedPoints& constrained, const std::vector<Vec3>& x)
{
  constexpr double on = 1e-6;
  OffSurface off;
  for (std::size_t i = 0; i < x.size(); ++i)
  {
    const auto p = static_cast<Index>(i);
    if (constrained.band(p) >= 0)
    {
      const double distance = norm(x[i] - constrained.onPart(p, x[i]));
      off.points += distance > on * constrained.tolerance();
      off.distance = std::max(off.distance, distance);
    }
  }
  return off;
}
}
