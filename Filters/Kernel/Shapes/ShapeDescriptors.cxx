// SPDX-License-Identifier: BSD-3-Clause
#include "ShapeDescriptors.h"

#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
/// Radii of the disks of a descriptor, in units of d_max.
constexpr double DescriptorRadii[4] = { 0.12, 0.25, 0.45, 0.8 };
}

//------------------------------------------------------------------------------
std::vector<Descriptor> describe(const Silhouette& shape, const std::vector<Vec2>& points)
{
  const Index width = shape.width, height = shape.height;
  // With sums along rows, a disk costs one subtraction per row.
  std::vector<float> sums(static_cast<std::size_t>((width + 1) * height), 0.0f);
  for (Index j = 0; j < height; ++j)
  {
    for (Index i = 0; i < width; ++i)
    {
      sums[j * (width + 1) + i + 1] = sums[j * (width + 1) + i] + shape.mask[j * width + i];
    }
  }
  std::vector<Descriptor> result;
  for (const Vec2& p : points)
  {
    throwIfInterrupted();
    Descriptor d = {};
    for (int k = 0; k < 4; ++k)
    {
      // A disk of at least one pixel, as smaller ones may contain no pixel center.
      const double radius = std::max(1.0, DescriptorRadii[k] * shape.maxDistance);
      double area = 0.0;
      const Index first = static_cast<Index>(std::ceil(std::max(0.0, p[1] - radius)));
      const Index last =
        static_cast<Index>(std::floor(std::min(static_cast<double>(height - 1), p[1] + radius)));
      for (Index j = first; j <= last; ++j)
      {
        const double dy = static_cast<double>(j) - p[1];
        const double half = std::sqrt(std::max(0.0, radius * radius - dy * dy));
        const Index from =
          static_cast<Index>(std::ceil(std::clamp(p[0] - half, 0.0, static_cast<double>(width))));
        const Index to = static_cast<Index>(
          std::floor(std::clamp(p[0] + half, -1.0, static_cast<double>(width - 1))));
        if (to >= from)
        {
          area += sums[j * (width + 1) + to + 1] - sums[j * (width + 1) + from];
        }
      }
      d[static_cast<std::size_t>(k)] = static_cast<float>(area / (Pi * radius * radius));
    }
    d[4] = static_cast<float>(
      std::hypot(p[0] - shape.centre[0], p[1] - shape.centre[1]) / shape.maxDistance);
    result.push_back(d);
  }
  return result;
}
}
