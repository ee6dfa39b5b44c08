// SPDX-License-Identifier: BSD-3-Clause
#include "CoordinateFrame.h"

#include "CellTopology.h"
#include "Mesh.h"

#include <limits>
#include <sstream>

namespace tautline
{
namespace
{
constexpr Index SampledCells = 1000;
/// The mesh is shifted along an axis if it is farther away than this many cells and this many times
/// its extent.
constexpr double FarInCells = 0x1p20, FarInExtents = 0x1p10;
}

//------------------------------------------------------------------------------
double CoordinateRange::farthest() const
{
  double most = 0;
  for (int c = 0; c < 3; ++c)
  {
    most = std::max({ most, std::abs(this->low[c]), std::abs(this->high[c]) });
  }
  return most;
}

//------------------------------------------------------------------------------
double CoordinateRange::spacing(bool singlePrecision) const
{
  const int digits =
    singlePrecision ? std::numeric_limits<float>::digits : std::numeric_limits<double>::digits;
  const double most = this->farthest();
  // The distance of adjacent numbers with the exponent of the largest coordinate.
  return most > 0 ? std::ldexp(1.0, std::ilogb(most) + 1 - digits) : 0.0;
}

//------------------------------------------------------------------------------
CoordinateRange coordinateRange(const MeshView& view)
{
  CoordinateRange range;
  range.low.fill(std::numeric_limits<double>::max());
  range.high.fill(-std::numeric_limits<double>::max());
  std::vector<double> extents;
  const Index step = std::max<Index>(1, view.numberOfCells / SampledCells);
  for (Index cell = 0; cell < view.numberOfCells; cell += step)
  {
    const CellType type = cornerType(view.cellTypes[cell]);
    if (type == CellType::Unsupported)
    {
      continue;
    }
    const Index* node = view.connectivity + view.offsets[cell];
    Vec3 low = pointOf(view, node[0]), high = low;
    bool finite = true;
    for (int k = 0; k < topology(type).nodes; ++k)
    {
      for (int c = 0; c < 3; ++c)
      {
        const double x = view.points[3 * node[k] + c];
        finite = finite && std::isfinite(x);
        low[c] = std::min(low[c], x);
        high[c] = std::max(high[c], x);
      }
    }
    const double extent = std::max({ high[0] - low[0], high[1] - low[1], high[2] - low[2] });
    if (finite && extent > 0 && std::isfinite(extent))
    {
      extents.push_back(extent);
      for (int c = 0; c < 3; ++c)
      {
        range.low[c] = std::min(range.low[c], low[c]);
        range.high[c] = std::max(range.high[c], high[c]);
      }
    }
  }
  if (extents.empty())
  {
    return {};
  }
  // A few extreme cells do not affect the median.
  const auto middle = extents.begin() + static_cast<std::ptrdiff_t>(extents.size() / 2);
  std::nth_element(extents.begin(), middle, extents.end());
  range.extent = *middle;
  return range;
}

//------------------------------------------------------------------------------
CoordinateFrame::CoordinateFrame(const CoordinateRange& range, bool shifted)
  : Unit(unitOfExtent(range.extent))
{
  for (int c = 0; shifted && c < 3; ++c)
  {
    // The values are halved first, because their sum may overflow.
    const double middle = 0.5 * range.low[c] + 0.5 * range.high[c];
    const double extent = std::max(range.high[c] - range.low[c], range.extent);
    const bool far =
      std::abs(middle) > FarInCells * range.extent && std::abs(middle) > FarInExtents * extent;
    this->Origin[c] = far && std::isfinite(middle) ? middle : 0.0;
  }
}

//------------------------------------------------------------------------------
void CoordinateFrame::enter(std::vector<double>& points) const
{
  const double perUnit = 1 / this->Unit;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    points[i] = (points[i] - this->Origin[i % 3]) * perUnit;
  }
}

//------------------------------------------------------------------------------
void CoordinateFrame::leave(std::vector<double>& points) const
{
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    points[i] = points[i] * this->Unit + this->Origin[i % 3];
  }
}

//------------------------------------------------------------------------------
void requireOrdinaryScale(const MeshView& view, const std::string& work)
{
  const double extent = coordinateRange(view).extent;
  if (unitOfExtent(extent) != 1)
  {
    std::ostringstream text;
    text.precision(2);
    text << work << " needs cells between " << SmallestExtent << " and " << LargestExtent
         << " long; the typical one is " << extent
         << " long: scale the mesh first (filter Transform).";
    throw Error(text.str());
  }
}
}
