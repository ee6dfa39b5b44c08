// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file Shapes.h
 * @brief Images of simple shapes for the tests of silhouettes and matching.
 */
#ifndef tautline_test_Shapes_h
#define tautline_test_Shapes_h

#include "tautline/Shapes/ShapeMatch.h"

#include <functional>

namespace tautline
{
struct Picture
{
  Index width = 0, height = 0;
  std::vector<float> values;

  ImageView view() const { return { this->values.data(), this->width, this->height }; }
  float& at(Index i, Index j)
  {
    return this->values[static_cast<std::size_t>(j * this->width + i)];
  }
};

/// 255 where a function of the pixel's center is positive, otherwise 0.
inline Picture paint(Index width, Index height, const std::function<double(double, double)>& inside)
{
  Picture picture{ width, height, std::vector<float>(static_cast<std::size_t>(width * height)) };
  for (Index j = 0; j < height; ++j)
  {
    for (Index i = 0; i < width; ++i)
    {
      picture.at(i, j) =
        inside(static_cast<double>(i), static_cast<double>(j)) > 0.0 ? 255.0f : 0.0f;
    }
  }
  return picture;
}

inline Picture disc(Index size, double x, double y, double radius)
{
  return paint(
    size, size, [=](double px, double py) { return radius - std::hypot(px - x, py - y); });
}

/// A lobed blob without symmetry about (x, y), of mean radius r, turned by an angle.
inline Picture blob(
  Index size, double x, double y, double r, double angle = 0.0, bool mirrored = false)
{
  return paint(size, size,
    [=](double px, double py)
    {
      const double dx = mirrored ? x - px : px - x, t = std::atan2(py - y, dx) - angle;
      const double edge =
        r * (1.0 + 0.25 * std::cos(t) + 0.2 * std::cos(2.0 * t + 0.7) + 0.15 * std::sin(3.0 * t));
      return edge - std::hypot(px - x, py - y);
    });
}
}
#endif
