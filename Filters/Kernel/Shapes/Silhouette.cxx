// SPDX-License-Identifier: BSD-3-Clause
#include "Silhouette.h"

#include "PlaneDistance.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Core/LoopProgress.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tautline
{
namespace
{
/// The smallest distance of a crossing from a pixel center, so that crossings never coincide.
constexpr double CrossingMargin = 1e-3;
/// The number of candidate points for vertices, per spacing.
constexpr int PointsPerSpacing = 20;
/// The spacing is reduced by this factor until the polygon is simple, at most this many times.
constexpr double SpacingReduction = 0.8;
constexpr int SpacingAttempts = 40;

/// Pixels surrounded by a frame of background, so that every outline closes.
class Framed
{
public:
  Framed(const ImageView& image, double threshold, bool dark)
    : Width(image.width + 2)
    , Height(image.height + 2)
    , Values(static_cast<std::size_t>(this->Width * this->Height), -1.0)
    , Labels(this->Values.size(), 0)
  {
    for (Index j = 0; j < image.height; ++j)
    {
      throwIfInterrupted();
      LoopProgress::at(static_cast<double>(j) / static_cast<double>(image.height));
      for (Index i = 0; i < image.width; ++i)
      {
        const double above = image(i, j) - threshold;
        this->Values[this->at(i + 1, j + 1)] = dark ? -above : above;
      }
    }
  }

  std::size_t at(Index i, Index j) const { return static_cast<std::size_t>(j * this->Width + i); }

  /// Above the threshold; at it for a dark foreground, whose values are negated.
  bool inside(std::size_t pixel, bool dark) const
  {
    return dark ? this->Values[pixel] >= 0.0 : this->Values[pixel] > 0.0;
  }

  /// Labels the components 1, 2, ...; returns the number of pixels of each.
  std::vector<Index> label(bool dark)
  {
    std::vector<Index> sizes, stack;
    for (std::size_t seed = 0; seed < this->Values.size(); ++seed)
    {
      if (this->Labels[seed] || !this->inside(seed, dark))
      {
        continue;
      }
      sizes.push_back(0);
      this->Labels[seed] = static_cast<Index>(sizes.size());
      stack.assign(1, static_cast<Index>(seed));
      while (!stack.empty())
      {
        const Index pixel = stack.back();
        stack.pop_back();
        ++sizes.back();
        for (Index j = -1; j <= 1; ++j)
        {
          for (Index i = -1; i <= 1; ++i)
          {
            // The frame is background: a neighbor is never outside the array.
            const std::size_t next = static_cast<std::size_t>(pixel + j * this->Width + i);
            if (!this->Labels[next] && this->inside(next, dark))
            {
              this->Labels[next] = this->Labels[seed];
              stack.push_back(static_cast<Index>(next));
            }
          }
        }
      }
    }
    return sizes;
  }

  /// The closed lines between a component and the rest, with the component on their left.
  std::vector<std::vector<Vec2>> trace(Index label) const
  {
    // An edge between pixels has the number 2 pixel (to the right) or 2 pixel + 1 (upwards).
    const auto in = [&](Index i, Index j) { return this->Labels[this->at(i, j)] == label; };
    std::vector<Index> next(2 * this->Values.size(), -1);
    for (Index j = 0; j + 1 < this->Height; ++j)
    {
      throwIfInterrupted();
      LoopProgress::at(static_cast<double>(j) / static_cast<double>(this->Height));
      for (Index i = 0; i + 1 < this->Width; ++i)
      {
        const bool corner[4] = { in(i, j), in(i + 1, j), in(i + 1, j + 1), in(i, j + 1) };
        const int count = corner[0] + corner[1] + corner[2] + corner[3];
        if (count == 0 || count == 4)
        {
          continue;
        }
        const Index pixel = static_cast<Index>(this->at(i, j));
        // The edges of the square, counterclockwise from the lower one.
        const Index edge[4] = { 2 * pixel, 2 * (pixel + 1) + 1, 2 * (pixel + this->Width),
          2 * pixel + 1 };
        // Counterclockwise around the square, the line leaves at an edge from inside to outside,
        // and enters at an edge from outside to inside. For diagonal corners, the inside ones are
        // connected: the line stays close to each outside corner.
        for (int out = 0; out < 4; ++out)
        {
          if (!corner[out] || corner[(out + 1) % 4])
          {
            continue;
          }
          int from = (out + 1) % 4;
          while (corner[from] || !corner[(from + 1) % 4])
          {
            from = (from + 1) % 4;
          }
          next[edge[out]] = edge[from];
        }
      }
    }
    std::vector<std::vector<Vec2>> lines;
    for (std::size_t start = 0; start < next.size(); ++start)
    {
      if (next[start] < 0)
      {
        continue;
      }
      lines.emplace_back();
      for (Index edge = static_cast<Index>(start); next[edge] >= 0;)
      {
        lines.back().push_back(this->crossing(edge, label));
        const Index following = next[edge];
        next[edge] = -1;
        edge = following;
      }
      // With the component on the left, holes run clockwise.
    }
    return lines;
  }

  const std::vector<Index>& labels() const { return this->Labels; }

private:
  Vec2 crossing(Index edge, Index label) const
  {
    const std::size_t a = static_cast<std::size_t>(edge / 2);
    const bool up = edge % 2 == 1;
    const std::size_t b = a + (up ? static_cast<std::size_t>(this->Width) : 1);
    const bool first = this->Labels[a] == label;
    const std::size_t inner = first ? a : b, outer = first ? b : a;
    // Beyond the image, the background is as far below the threshold as the shape is above it.
    const Index i = static_cast<Index>(a) % this->Width, j = static_cast<Index>(a) / this->Width;
    const bool frame =
      i == 0 || j == 0 || (up ? j + 2 : i + 2) == (up ? this->Height : this->Width);
    const double above = this->Values[inner];
    const double below = frame ? above : -this->Values[outer];
    double t = above + below > 0.0 ? above / (above + below) : 0.5;
    t = std::clamp(t, CrossingMargin, 1.0 - CrossingMargin);
    t = first ? t : 1.0 - t;
    return { static_cast<double>(i - 1) + (up ? 0.0 : t),
      static_cast<double>(j - 1) + (up ? t : 0.0) };
  }

  Index Width;
  Index Height;
  std::vector<double> Values;
  std::vector<Index> Labels;
};

double lengthOf(const std::vector<Vec2>& closed)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < closed.size(); ++i)
  {
    sum += distance(closed[i], closed[(i + 1) % closed.size()]);
  }
  return sum;
}

bool isDark(const ImageView& image, double threshold, Foreground foreground)
{
  if (foreground != Foreground::Automatic)
  {
    return foreground == Foreground::Dark;
  }
  Index bright = 0, border = 0;
  for (Index j = 0; j < image.height; ++j)
  {
    const bool whole = j == 0 || j + 1 == image.height;
    for (Index i = 0; i < image.width; i += whole ? 1 : std::max<Index>(1, image.width - 1))
    {
      bright += image(i, j) > threshold;
      ++border;
    }
  }
  return 2 * bright > border;
}

/// Fills the holes of a component: pixels not reached from outside are inside.
std::vector<float> fill(const std::vector<Index>& labels, Index label, Index width, Index height)
{
  const Index framed = width + 2;
  std::vector<char> outside(labels.size(), 0);
  std::vector<Index> stack(1, 0);
  outside[0] = 1;
  while (!stack.empty())
  {
    const Index pixel = stack.back();
    stack.pop_back();
    const Index i = pixel % framed, j = pixel / framed;
    const Index to[4] = { i > 0 ? pixel - 1 : -1, i + 1 < framed ? pixel + 1 : -1,
      j > 0 ? pixel - framed : -1, j + 1 < height + 2 ? pixel + framed : -1 };
    for (Index next : to)
    {
      if (next >= 0 && !outside[next] && labels[next] != label)
      {
        outside[next] = 1;
        stack.push_back(next);
      }
    }
  }
  std::vector<float> mask(static_cast<std::size_t>(width * height));
  for (Index j = 0; j < height; ++j)
  {
    throwIfInterrupted();
    LoopProgress::at(static_cast<double>(j) / static_cast<double>(height));
    for (Index i = 0; i < width; ++i)
    {
      mask[j * width + i] = outside[(j + 1) * framed + i + 1] ? 0.0f : 1.0f;
    }
  }
  return mask;
}

/// Chooses the vertices of the best closed polygon on points, by dynamic programming from each
/// start.
class VertexChoice
{
public:
  VertexChoice(const std::vector<Vec2>& points, int perSpacing, double spacing)
    : Points(points)
    , Least(std::max(1, perSpacing / 2))
    , Most(perSpacing + perSpacing / 2)
  {
    const std::size_t n = points.size();
    this->Costs.assign(n * (static_cast<std::size_t>(this->Most) + 1), 0.0);
    for (std::size_t i = 0; i < n; ++i)
    {
      throwIfInterrupted();
      for (int step = this->Least; step <= this->Most; ++step)
      {
        const Vec2 &a = points[i], &b = points[(i + step) % n];
        const double length = std::max(distance(a, b), 1e-300);
        double deviation = 0.0;
        for (int s = 1; s < step; ++s)
        {
          const Vec2& p = points[(i + s) % n];
          const double across = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
          deviation = std::max(deviation, std::abs(across) / length);
        }
        const double stretch = static_cast<double>(step) / perSpacing - 1.0;
        this->cost(i, step) = stretch * stretch + deviation * deviation / (spacing * spacing);
      }
    }
  }

  std::vector<Vec2> best() const
  {
    const std::size_t n = this->Points.size();
    double least = std::numeric_limits<double>::infinity();
    std::vector<std::size_t> chosen;
    // Among this many neighboring points, one is a vertex of the best polygon.
    for (std::size_t start = 0; start < std::min<std::size_t>(this->Most, n); ++start)
    {
      std::vector<double> sum(n + 1, std::numeric_limits<double>::infinity());
      std::vector<int> last(n + 1, 0);
      sum[0] = 0.0;
      throwIfInterrupted();
      LoopProgress::at(static_cast<double>(start) / static_cast<double>(this->Most));
      for (std::size_t end = this->Least; end <= n; ++end)
      {
        for (int step = this->Least; step <= std::min<int>(this->Most, static_cast<int>(end));
             ++step)
        {
          const double value = sum[end - step] + this->cost((start + end - step) % n, step);
          if (value < sum[end])
          {
            sum[end] = value;
            last[end] = step;
          }
        }
      }
      if (sum[n] < least)
      {
        least = sum[n];
        chosen.clear();
        for (std::size_t end = n; end > 0; end -= last[end])
        {
          chosen.push_back((start + end) % n);
        }
      }
    }
    std::sort(chosen.begin(), chosen.end());
    std::vector<Vec2> polygon;
    for (std::size_t i : chosen)
    {
      polygon.push_back(this->Points[i]);
    }
    return polygon;
  }

private:
  double& cost(std::size_t i, int step) { return this->Costs[i * (this->Most + 1) + step]; }
  double cost(std::size_t i, int step) const { return this->Costs[i * (this->Most + 1) + step]; }

  const std::vector<Vec2>& Points;
  int Least;
  int Most;
  std::vector<double> Costs;
};

/// The maximum number of vertices of a polygon to reduce: the time is quadratic in it.
constexpr Index MostReducible = 20000;
/// Each round removes one in this many of the vertices to remove.
constexpr Index VerticesPerRound = 4;

/// Twice the area of a triangle, positive if it is counterclockwise.
double doubledArea(const Vec2& a, const Vec2& b, const Vec2& c)
{
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Whether a point is in a triangle or on its boundary.
bool isInside(const std::array<Vec2, 3>& triangle, const Vec2& p)
{
  bool left = true, right = true;
  for (std::size_t k = 0; k < triangle.size(); ++k)
  {
    const double side = doubledArea(triangle[k], triangle[(k + 1) % triangle.size()], p);
    left = left && side >= 0.0;
    right = right && side <= 0.0;
  }
  // For a triangle without area: within its box on its line.
  const auto within = [&](int c)
  {
    const auto [low, high] = std::minmax({ triangle[0][c], triangle[1][c], triangle[2][c] });
    return p[c] >= low && p[c] <= high;
  };
  return (left || right) && within(0) && within(1);
}
}

Silhouette traceSilhouette(const ImageView& image, const SilhouetteOptions& options)
{
  if (image.width < 1 || image.height < 1 || !image.values)
  {
    throw Error("The image is empty.");
  }
  const std::size_t n = static_cast<std::size_t>(image.width * image.height);
  for (std::size_t i = 0; i < n; ++i)
  {
    if (!std::isfinite(image.values[i]))
    {
      throw Error("The image has a value that is not finite.");
    }
  }
  const auto [low, high] = std::minmax_element(image.values, image.values + n);
  Silhouette shape;
  shape.threshold =
    std::isnan(options.threshold) ? 0.5 * (double{ *low } + double{ *high }) : options.threshold;
  if (!std::isfinite(shape.threshold))
  {
    throw Error("The threshold is not finite.");
  }
  if (*low == *high)
  {
    throw Error("The image has only one value, " + std::to_string(*low) +
      ": there is no shape to separate from its surroundings.");
  }
  shape.dark = isDark(image, shape.threshold, options.foreground);
  Framed framed(image, shape.threshold, shape.dark);
  const std::vector<Index> sizes = framed.label(shape.dark);
  if (sizes.empty() || (sizes.size() == 1 && sizes[0] == static_cast<Index>(n)))
  {
    throw Error(std::string(sizes.empty() ? "No pixel is " : "Every pixel is ") +
      (shape.dark ? "at or below" : "above") + " the threshold " + std::to_string(shape.threshold) +
      ": choose one between " + std::to_string(*low) + " and " + std::to_string(*high) +
      ", or the other foreground.");
  }
  shape.width = image.width;
  shape.height = image.height;
  shape.components = static_cast<Index>(sizes.size());
  // The largest component is the shape. Its line with the largest area is the outline; lines with
  // negative area surround holes.
  const Index label = std::max_element(sizes.begin(), sizes.end()) - sizes.begin() + 1;
  std::vector<std::vector<Vec2>> lines = framed.trace(label);
  for (std::vector<Vec2>& line : lines)
  {
    const double area = signedArea(line);
    shape.holes += area < 0.0;
    if (area > shape.area)
    {
      shape.area = area;
      shape.outline.swap(line);
    }
  }
  shape.perimeter = lengthOf(shape.outline);
  shape.centre = centreOfMass(shape.outline);
  for (const Vec2& p : shape.outline)
  {
    shape.maxDistance = std::max(shape.maxDistance, distance(p, shape.centre));
    shape.touchesBorder |= p[0] < 0.0 || p[1] < 0.0 ||
      p[0] > static_cast<double>(image.width - 1) || p[1] > static_cast<double>(image.height - 1);
  }
  shape.mask = fill(framed.labels(), label, image.width, image.height);
  return shape;
}

std::vector<Vec2> resampleOutline(const std::vector<Vec2>& outline, Index count)
{
  std::vector<Vec2> points;
  const double step = lengthOf(outline) / static_cast<double>(count);
  double walked = 0.0;
  for (std::size_t i = 0; i < outline.size() && static_cast<Index>(points.size()) < count; ++i)
  {
    const Vec2 &a = outline[i], &b = outline[(i + 1) % outline.size()];
    const double length = distance(a, b);
    double target = step * static_cast<double>(points.size());
    while (target < walked + length && static_cast<Index>(points.size()) < count)
    {
      const double t = std::clamp((target - walked) / length, 0.0, 1.0);
      points.push_back({ a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]) });
      target = step * static_cast<double>(points.size());
    }
    walked += length;
  }
  while (!outline.empty() && static_cast<Index>(points.size()) < count)
  {
    points.push_back(outline.back()); // rounding
  }
  return points;
}

std::vector<Vec2> reducePolygon(std::vector<Vec2> polygon, Index most)
{
  most = std::max<Index>(most, 3);
  for (bool removed = true; removed && static_cast<Index>(polygon.size()) > most;)
  {
    throwIfInterrupted();
    removed = false;
    const std::size_t n = polygon.size();
    const auto triangleAt = [&](std::size_t i) {
      return std::array<Vec2, 3>{ polygon[(i + n - 1) % n], polygon[i], polygon[(i + 1) % n] };
    };
    std::vector<std::pair<double, std::size_t>> order; // sorted by area, smallest triangles first
    for (std::size_t i = 0; i < n; ++i)
    {
      const std::array<Vec2, 3> triangle = triangleAt(i);
      order.emplace_back(std::abs(doubledArea(triangle[0], triangle[1], triangle[2])), i);
    }
    std::sort(order.begin(), order.end());
    // Only a part of them per round, because the triangles next to a removed vertex grow.
    Index left = std::min<Index>(
      static_cast<Index>(n) - most, 1 + (static_cast<Index>(n) - most) / VerticesPerRound);
    std::vector<char> gone(n, 0), touched(n, 0);
    for (auto at = order.begin(); at != order.end() && left > 0; ++at)
    {
      const std::size_t i = at->second, before = (i + n - 1) % n, after = (i + 1) % n;
      if (touched[i])
      {
        continue;
      }
      const std::array<Vec2, 3> triangle = triangleAt(i);
      bool empty = true;
      for (std::size_t j = 0; j < n && empty; ++j)
      {
        empty = gone[j] || j == i || j == before || j == after || !isInside(triangle, polygon[j]);
      }
      if (empty)
      {
        gone[i] = touched[before] = touched[i] = touched[after] = 1;
        removed = true;
        --left;
      }
    }
    std::size_t kept = 0;
    for (std::size_t i = 0; i < n; ++i)
    {
      if (!gone[i])
      {
        polygon[kept++] = polygon[i];
      }
    }
    polygon.resize(kept);
  }
  return polygon;
}

std::vector<Vec2> approximateOutline(const std::vector<Vec2>& outline, double spacing)
{
  if (!(spacing > 0.0) || !std::isfinite(spacing))
  {
    throw Error("The spacing of the polygon must be above 0 and finite.");
  }
  const double area = signedArea(outline);
  if (outline.size() < 3 || area == 0.0 || !std::isfinite(area))
  {
    throw Error("The outline has no area: it cannot be approximated by a polygon.");
  }
  std::vector<Vec2> line = outline;
  if (area < 0.0)
  {
    std::reverse(line.begin(), line.end());
  }
  const double perimeter = lengthOf(line);
  spacing = std::min(spacing, perimeter / 3.0);
  const double given = spacing;
  for (int attempt = 0; attempt < SpacingAttempts; ++attempt)
  {
    // A smaller spacing follows the outline more closely, until the polygon does not intersect
    // itself.
    const Index count = std::max<Index>(
      3 * PointsPerSpacing / 2, std::llround(PointsPerSpacing * perimeter / spacing));
    const std::vector<Vec2> points = resampleOutline(line, count);
    std::vector<Vec2> polygon = VertexChoice(points, PointsPerSpacing, spacing).best();
    if (polygon.size() >= 3 && signedArea(polygon) > 0.0 && isSimple(polygon))
    {
      return polygon;
    }
    spacing *= SpacingReduction;
  }
  if (static_cast<Index>(line.size()) <= MostReducible && isSimple(line))
  {
    return reducePolygon(std::move(line), std::max<Index>(3, std::llround(perimeter / given)));
  }
  throw Error("No simple polygon was found on the outline: it intersects itself.");
}
}
