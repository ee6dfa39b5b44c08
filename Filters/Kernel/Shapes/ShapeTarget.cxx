// SPDX-License-Identifier: BSD-3-Clause
#include "ShapeTarget.h"

#include "ShapeEnergy.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Core/Memory.h"
#include "tautline/Core/PacketFloat.h"
#include "tautline/Core/Parallel.h"

#include <algorithm>
#include <cmath>

namespace tautline
{
namespace
{
/// A coarse set has every third location.
constexpr Index CoarseStep = 3;
/// The maximum number of bytes of the table of edge costs.
constexpr double TableLimit = 4.0 * 1024 * 1024 * 1024;

void requireNonNegative(double value, const char* name)
{
  if (!(value >= 0.0) || !std::isfinite(value))
  {
    throw Error(std::string("The ") + name + " must be at least 0 and finite.");
  }
}

/// Convolution with a Gaussian and its derivative along x (stride 1) or y (stride width).
std::vector<float> convolve(const std::vector<float>& image, Index width, Index height, bool alongY,
  const std::vector<double>& weights)
{
  const Index radius = static_cast<Index>(weights.size()) / 2;
  const Index length = alongY ? height : width, stride = alongY ? width : 1;
  std::vector<float> result(image.size());
  for (Index j = 0; j < height; ++j)
  {
    throwIfInterrupted();
    for (Index i = 0; i < width; ++i)
    {
      const Index at = alongY ? j : i, base = j * width + i - at * stride;
      double sum = 0.0;
      for (Index k = -radius; k <= radius; ++k)
      {
        // The image is extended with its border values.
        const Index from = std::clamp<Index>(at + k, 0, length - 1);
        sum += weights[static_cast<std::size_t>(k + radius)] * image[base + from * stride];
      }
      result[j * width + i] = static_cast<float>(sum);
    }
  }
  return result;
}

float bilinear(const std::vector<float>& image, Index width, Index height, double x, double y)
{
  const double cx = std::clamp(x, 0.0, static_cast<double>(width - 1));
  const double cy = std::clamp(y, 0.0, static_cast<double>(height - 1));
  const Index i = std::min(static_cast<Index>(cx), std::max<Index>(width - 2, 0));
  const Index j = std::min(static_cast<Index>(cy), std::max<Index>(height - 2, 0));
  const float u = static_cast<float>(cx - static_cast<double>(i));
  const float v = static_cast<float>(cy - static_cast<double>(j));
  const float* p = image.data() + j * width + i;
  const Index right = width > 1 ? 1 : 0, up = height > 1 ? width : 0;
  return (1 - v) * ((1 - u) * p[0] + u * p[right]) + v * ((1 - u) * p[up] + u * p[up + right]);
}

double distanceToOutline(const std::vector<Vec2>& outline, const Vec2& p)
{
  double best = std::numeric_limits<double>::infinity();
  for (const Vec2& q : outline)
  {
    best = std::min(best, std::hypot(p[0] - q[0], p[1] - q[1]));
  }
  return best;
}

/// The image whose gradient attracts edges: the mask of the silhouette, or the gray values scaled
/// to 0 outside and 1 inside.
std::vector<float> imageOf(const Silhouette& shape, const ImageView* grey)
{
  if (!grey)
  {
    return shape.mask;
  }
  if (grey->width != shape.width || grey->height != shape.height)
  {
    throw Error("The gray image and the silhouette differ in size.");
  }
  std::vector<float> image(grey->values, grey->values + shape.width * shape.height);
  const auto [low, high] = std::minmax_element(image.begin(), image.end());
  const float from = *low, range = *high - *low;
  for (float& value : image)
  {
    value = (shape.dark ? from + range - value : value - from) / range;
  }
  return image;
}

/// A Gaussian of width sigma and its derivative, sampled at whole pixels.
struct GaussianKernel
{
  std::vector<double> gauss, slope;

  explicit GaussianKernel(double sigma)
  {
    const Index radius = std::max<Index>(1, static_cast<Index>(std::ceil(4.0 * sigma)));
    double sum = 0.0, moment = 0.0;
    for (Index k = -radius; k <= radius; ++k)
    {
      const double x = static_cast<double>(k) / sigma;
      this->gauss.push_back(std::exp(-0.5 * x * x));
      this->slope.push_back(x * this->gauss.back());
      sum += this->gauss.back();
      moment += this->slope.back() * static_cast<double>(k);
    }
    // Scaled so that a straight edge (a unit step) has the gradient 1; unscaled, it is 1 / (sigma
    // sqrt(2 pi)) at the step. The step of a pixel image is offset by half a pixel.
    const double step = sigma * std::sqrt(2.0 * Pi);
    for (std::size_t k = 0; k < this->gauss.size(); ++k)
    {
      this->gauss[k] /= sum;
      this->slope[k] *= step / moment;
    }
  }
};

/// The locations of a grid over the image; for NearGrid, only those within a cell of the outline.
LocationSet gridLocations(const Silhouette& shape, const LocationOptions& options, const Vec2& cell)
{
  const LocationSet all = LocationSet::lattice(
    { 0.5 * cell[0] - 0.5, 0.5 * cell[1] - 0.5 }, cell, options.columns, options.rows);
  if (options.kind != Locations::NearGrid)
  {
    return all;
  }
  std::vector<Vec2> near;
  for (const Vec2& p : all.points)
  {
    throwIfInterrupted();
    if (distanceToOutline(shape.outline, p) <= std::max(cell[0], cell[1]))
    {
      near.push_back(p);
    }
  }
  if (near.size() < 3)
  {
    throw Error("Fewer than 3 grid locations are near the outline: use a finer grid.");
  }
  return LocationSet::list(near);
}
}

Index LocationSet::locationOf(Index slot) const
{
  return std::lower_bound(this->used.begin(), this->used.end(), slot) - this->used.begin();
}

LocationSet LocationSet::list(const std::vector<Vec2>& points)
{
  LocationSet set;
  set.rowLength = FloatWidth;
  set.rows = (static_cast<Index>(points.size()) + FloatWidth - 1) / FloatWidth;
  set.points = points;
  // Slots without a location repeat the last one, so that arithmetic on them is valid.
  set.x.assign(static_cast<std::size_t>(set.size()), static_cast<float>(points.back()[0]));
  set.y.assign(static_cast<std::size_t>(set.size()), static_cast<float>(points.back()[1]));
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    set.x[i] = static_cast<float>(points[i][0]);
    set.y[i] = static_cast<float>(points[i][1]);
    set.used.push_back(static_cast<Index>(i));
  }
  set.slots = set.used;
  return set;
}

LocationSet LocationSet::lattice(const Vec2& first, const Vec2& step, Index columns, Index rows)
{
  LocationSet set;
  set.grid = true;
  set.step = step;
  set.columns = columns;
  set.rows = rows;
  set.rowLength = (columns + FloatWidth - 1) / FloatWidth * FloatWidth;
  for (Index j = 0; j < rows; ++j)
  {
    for (Index i = 0; i < set.rowLength; ++i)
    {
      const Vec2 p = { first[0] + step[0] * static_cast<double>(std::min(i, columns - 1)),
        first[1] + step[1] * static_cast<double>(j) };
      set.x.push_back(static_cast<float>(p[0]));
      set.y.push_back(static_cast<float>(p[1]));
      if (i < columns)
      {
        set.used.push_back(j * set.rowLength + i);
        set.points.push_back(p);
      }
    }
  }
  set.slots = set.used;
  return set;
}

double ShapeTarget::Data::edgeCost(const Vec2& p, const Vec2& q) const
{
  const double dx = q[0] - p[0], dy = q[1] - p[1], length = std::hypot(dx, dy);
  // One sample per pixel of length, in the middle of its interval.
  const int samples = std::max(1, static_cast<int>(std::ceil(std::min(length, 1e6))));
  double sum = 0.0;
  for (int s = 0; s < samples; ++s)
  {
    const double t = (s + 0.5) / samples;
    const double x = p[0] + t * dx, y = p[1] + t * dy;
    if (!this->energy.directedEdges)
    {
      sum += bilinear(this->cost, this->width, this->height, x, y);
      continue;
    }
    // The polygon runs counterclockwise: its interior is on the left.
    const double along = length > 0.0
      ? (-dy * bilinear(this->gradientX, this->width, this->height, x, y) +
          dx * bilinear(this->gradientY, this->width, this->height, x, y)) /
        length
      : 0.0;
    sum += 1.0 / (this->energy.lambda + std::max(0.0, along));
  }
  return sum / samples;
}

PairTable ShapeTarget::Data::edgeTable(const LocationSet& a, const LocationSet& b) const
{
  PairTable table(a.size(), b.size(), Unreachable);
  const bool symmetric = &a == &b && !this->energy.directedEdges;
  const Index n = static_cast<Index>(a.points.size());
  constexpr Index grain = 8, few = 200;
  parallelFor(n, grain, n > few ? this->threads : 1,
    [&](Index i)
    {
      throwIfInterrupted(); // a row may take long
      for (Index j = symmetric ? i : 0; j < static_cast<Index>(b.points.size()); ++j)
      {
        const float value = static_cast<float>(this->edgeCost(a.points[i], b.points[j]));
        table.row(a.slots[i])[b.slots[j]] = value;
        if (symmetric)
        {
          table.row(b.slots[j])[a.slots[i]] = value;
        }
      }
    });
  return table;
}

//------------------------------------------------------------------------------
/// Computes the gradient of the smoothed image and the resulting cost of an edge point.
void ShapeTarget::Data::computeCosts(const std::vector<float>& image)
{
  const GaussianKernel kernel(this->energy.smoothing);
  const Index w = this->width, h = this->height;
  this->gradientX = convolve(convolve(image, w, h, true, kernel.gauss), w, h, false, kernel.slope);
  this->gradientY = convolve(convolve(image, w, h, false, kernel.gauss), w, h, true, kernel.slope);
  this->cost.resize(image.size());
  for (std::size_t i = 0; i < image.size(); ++i)
  {
    this->cost[i] = 1.0f /
      (static_cast<float>(this->energy.lambda) +
        std::hypot(this->gradientX[i], this->gradientY[i]));
  }
}

//------------------------------------------------------------------------------
void ShapeTarget::Data::chooseLocations(const Silhouette& shape, const LocationOptions& options)
{
  if (options.kind == Locations::Contour)
  {
    if (options.contour < 3)
    {
      throw Error("At least 3 locations on the contour are needed.");
    }
    this->locations = LocationSet::list(resampleOutline(shape.outline, options.contour));
    const double between = shape.perimeter / static_cast<double>(options.contour);
    this->gridStep = { between, between };
    for (Index i = 0; i < options.contour; ++i)
    {
      this->arc.push_back(static_cast<double>(i) / static_cast<double>(options.contour));
    }
    return;
  }
  if (options.columns < 1 || options.rows < 1 || options.columns * options.rows < 3 ||
    std::min(options.columns, options.rows) < 2)
  {
    throw Error("A grid of " + std::to_string(options.columns) + " x " +
      std::to_string(options.rows) + " locations is too small: the minimum is 2 x 2.");
  }
  this->gridStep = { static_cast<double>(this->width) / static_cast<double>(options.columns),
    static_cast<double>(this->height) / static_cast<double>(options.rows) };
  this->locations = gridLocations(shape, options, this->gridStep);
}

//------------------------------------------------------------------------------
/// A coarse set for a first solution: every third location, in both directions of a grid.
void ShapeTarget::Data::chooseCoarse()
{
  std::vector<Vec2> points;
  const Index columns = this->locations.grid ? this->locations.columns : 1;
  for (std::size_t i = 0; i < this->locations.points.size(); ++i)
  {
    const Index row = static_cast<Index>(i) / columns, column = static_cast<Index>(i) % columns;
    if (row % CoarseStep == 1 && (columns == 1 || column % CoarseStep == 1))
    {
      points.push_back(this->locations.points[i]);
      this->coarseOf.push_back(static_cast<Index>(i));
    }
  }
  if (points.size() < 3)
  {
    return;
  }
  this->coarse = LocationSet::list(points);
  this->coarseEdges = PairTable(this->coarse.size(), this->coarse.size(), Unreachable);
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    throwIfInterrupted();
    const float* from = this->edges.row(this->locations.slots[this->coarseOf[i]]);
    for (std::size_t j = 0; j < points.size(); ++j)
    {
      this->coarseEdges.row(static_cast<Index>(i))[j] =
        from[this->locations.slots[this->coarseOf[j]]];
    }
  }
}

//------------------------------------------------------------------------------
ShapeTarget::ShapeTarget(const Silhouette& shape, const LocationOptions& options,
  const ShapeEnergy& energy, const ImageView* grey)
  : Private(std::make_unique<Data>())
{
  requireNonNegative(energy.lambda, "edge constant lambda");
  requireNonNegative(energy.smoothing, "smoothing");
  if (energy.lambda == 0.0 || energy.smoothing == 0.0)
  {
    throw Error("The edge constant lambda and the smoothing must be above 0.");
  }
  Data& d = *this->Private;
  d.energy = energy;
  d.threads = options.threads;
  d.width = shape.width;
  d.height = shape.height;
  d.centre = shape.centre;
  d.maxDistance = shape.maxDistance;
  d.perimeter = shape.perimeter;
  d.computeCosts(imageOf(shape, grey));
  d.chooseLocations(shape, options);
  const double tableSize =
    static_cast<double>(d.locations.size()) * static_cast<double>(d.locations.size());
  if (tableSize * sizeof(float) > TableLimit)
  {
    throw Error("A table over all pairs of " + std::to_string(d.locations.points.size()) +
      " locations would take more than 4 GiB: use fewer locations.");
  }
  requireMemory(tableSize * sizeof(float),
    "A table over all pairs of " + std::to_string(d.locations.points.size()) + " locations",
    "use fewer locations.");
  d.edges = d.edgeTable(d.locations, d.locations);
  d.chooseCoarse();
  if (energy.descriptor > 0.0)
  {
    d.descriptors = describe(shape, d.locations.points);
  }
}

ShapeTarget::~ShapeTarget() = default;
ShapeTarget::ShapeTarget(ShapeTarget&&) noexcept = default;
ShapeTarget& ShapeTarget::operator=(ShapeTarget&&) noexcept = default;

const std::vector<Vec2>& ShapeTarget::locations() const
{
  return this->Private->locations.points;
}

Vec2 ShapeTarget::centre() const
{
  return this->Private->centre;
}

double ShapeTarget::maxDistance() const
{
  return this->Private->maxDistance;
}

double ShapeTarget::edgeCost(const Vec2& p, const Vec2& q) const
{
  return this->Private->edgeCost(p, q);
}
}
