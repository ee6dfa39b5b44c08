// SPDX-License-Identifier: BSD-3-Clause
#include "OutlineModel.h"

#include "PlaneDistance.h"
#include "ShapeDescriptors.h"
#include "ShapeModel.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Core/PacketFloat.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tautline
{
namespace
{
/// The number of points of the smoothed outline, and the oversampling for smoothing.
constexpr Index CurvePoints = 400, Oversampling = 4;
/// Half of the chord that approximates the tangent, as a fraction of the outline.
constexpr double TangentReach = 0.01;
/// Points that are averaged for one height.
constexpr int HeightSamples = 5;
/// With this factor, differences of disks are on average as large as differences of heights.
constexpr double RegionScale = 0.6;
/// Locations have descriptors in steps of one half.
constexpr Index DescriptorsPerLocation = 2;
constexpr int SignatureQuantiles = 8;
/// If the smoothed outline intersects itself, it is smoothed less and has up to this many points.
constexpr Index MostCurvePoints = 6400;
constexpr double SmoothingReduction = 0.25;
/// A polygon has at most 2 vertices per 3 locations, so that there is a choice of placements.
constexpr std::array<Index, 2> VerticesPerLocations = { 2, 3 };

double fraction(double s)
{
  return s - std::floor(s);
}

/// Points at equal distances along a closed curve of length 1.
struct Curve
{
  std::vector<Vec2> points;
  Vec2 centre = {};    ///< in pixels
  double length = 1.0; ///< in pixels

  /// The point at an arc length of any size.
  Vec2 at(double s) const
  {
    const double u = fraction(s) * static_cast<double>(this->points.size());
    const std::size_t i = static_cast<std::size_t>(u) % this->points.size();
    const Vec2 &a = this->points[i], &b = this->points[(i + 1) % this->points.size()];
    const double f = u - std::floor(u);
    return { a[0] + f * (b[0] - a[0]), a[1] + f * (b[1] - a[1]) };
  }
};

/// Convolution of a closed curve with a Gaussian; sigma in points.
std::vector<Vec2> smoothed(const std::vector<Vec2>& points, double sigma)
{
  const Index n = static_cast<Index>(points.size());
  constexpr double reach = 4.0;
  const Index radius = std::max<Index>(1, static_cast<Index>(std::ceil(reach * sigma)));
  std::vector<double> weights;
  double sum = 0.0;
  for (Index i = -radius; i <= radius; ++i)
  {
    weights.push_back(std::exp(-0.5 * static_cast<double>(i * i) / (sigma * sigma)));
    sum += weights.back();
  }
  std::vector<Vec2> result(points.size(), Vec2{});
  for (Index i = 0; i < n; ++i)
  {
    for (Index k = 0; k <= 2 * radius; ++k)
    {
      // The radius may exceed the number of points, so a single modulo is not enough.
      const Vec2& p = points[((i + k - radius) % n + n) % n];
      result[i][0] += weights[k] / sum * p[0];
      result[i][1] += weights[k] / sum * p[1];
    }
  }
  return result;
}

Curve makeCurve(const Silhouette& shape, double smoothing, Index count)
{
  const Index n = Oversampling * count;
  std::vector<Vec2> points =
    smoothed(resampleOutline(shape.outline, n), smoothing * static_cast<double>(n));
  Curve curve;
  curve.centre = centreOfMass(points);
  // The start point does not depend on the position of the shape in the image.
  std::size_t first = 0;
  curve.length = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i)
  {
    curve.length += distance(points[i], points[(i + 1) % points.size()]);
    const bool farther = distance(points[i], curve.centre) > distance(points[first], curve.centre);
    first = farther ? i : first;
  }
  std::rotate(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(first), points.end());
  for (Vec2& p : points)
  {
    p = { (p[0] - curve.centre[0]) / curve.length, (p[1] - curve.centre[1]) / curve.length };
  }
  curve.points = resampleOutline(points, count);
  return curve;
}

using Heights = std::array<double, OutlineHeights>;

/// The heights of the curve above its tangent at s.
Heights heightsAt(const Curve& curve, double s)
{
  constexpr Index bins = OutlineHeights + 1;
  const Vec2 origin = curve.at(s), a = curve.at(s - TangentReach), b = curve.at(s + TangentReach);
  const double length = std::max(distance(a, b), 1e-12);
  const double tx = (b[0] - a[0]) / length, ty = (b[1] - a[1]) / length;
  Heights heights = {};
  // The heights at equal distances along the curve, without the point itself, whose height is 0.
  for (Index k = 1; k < bins; ++k)
  {
    for (int q = -(HeightSamples / 2); q <= HeightSamples / 2; ++q)
    {
      const Vec2 p = curve.at(s +
        (static_cast<double>(HeightSamples * k) + q) / static_cast<double>(HeightSamples * bins));
      // The scalar product with the left normal of the tangent (tx, ty).
      heights[k - 1] += (tx * (p[1] - origin[1]) - ty * (p[0] - origin[0])) / HeightSamples;
    }
  }
  return heights;
}

/// Computes the descriptors of one shape.
class Describer
{
public:
  Describer(const Silhouette& shape, const Curve& curve, const OutlineOptions& options)
    : Shape(shape)
    , OfCurve(curve)
    , Region(options.region)
  {
    const Index count = DescriptorsPerLocation * options.locations;
    Heights mean = {}, square = {};
    for (Index i = 0; i < count; ++i)
    {
      throwIfInterrupted();
      const Heights heights = heightsAt(curve, static_cast<double>(i) / static_cast<double>(count));
      for (Index k = 0; k < OutlineHeights; ++k)
      {
        this->Largest[k] = std::max(this->Largest[k], std::abs(heights[k]));
        mean[k] += heights[k] / static_cast<double>(count);
        square[k] += heights[k] * heights[k] / static_cast<double>(count);
      }
    }
    // The complexity is the mean deviation of the heights relative to the largest height.
    for (Index k = 0; k < OutlineHeights; ++k)
    {
      const double deviation = std::sqrt(std::max(0.0, square[k] - mean[k] * mean[k]));
      this->Complexity += deviation / std::max(this->Largest[k], 1e-12) / OutlineHeights;
    }
    // The same for a mirror image, which reverses the heights.
    for (Index k = 0; k < OutlineHeights; ++k)
    {
      const Index other = OutlineHeights - 1 - k;
      this->Scale[k] = std::max({ this->Largest[k], this->Largest[other], 1e-12 });
      // Heights far along the outline change most when parts move, so their weight is smaller.
      this->Weight[k] = 1.0 / static_cast<double>(std::min(k, other) + 1);
      this->WeightSum += this->Weight[k];
    }
  }

  /// Appends the descriptor of the curve at s.
  void append(double s, std::vector<float>& to) const
  {
    const Heights heights = heightsAt(this->OfCurve, s);
    for (Index k = 0; k < OutlineHeights; ++k)
    {
      to.push_back(static_cast<float>(
        (1.0 - this->Region) * this->Weight[k] / this->WeightSum * heights[k] / this->Scale[k]));
    }
    const Vec2 p = this->OfCurve.at(s);
    // Regions are measured in the mask, hence in pixels.
    const Vec2 pixel = { p[0] * this->OfCurve.length + this->OfCurve.centre[0],
      p[1] * this->OfCurve.length + this->OfCurve.centre[1] };
    const Descriptor regions = describe(this->Shape, { pixel })[0];
    for (float x : regions)
    {
      to.push_back(static_cast<float>(this->Region * RegionScale) * x);
    }
  }

  double complexity() const { return this->Complexity; }

private:
  const Silhouette& Shape;
  const Curve& OfCurve;
  double Region;
  Heights Largest = {}, Scale = {}, Weight = {};
  double WeightSum = 0.0, Complexity = 0.0;
};

/// The position of a point along its curve, 0 to 1.
double arcOf(const Curve& curve, const Vec2& p)
{
  double nearest = 1e300, arc = 0.0;
  const std::size_t n = curve.points.size();
  for (std::size_t i = 0; i < n; ++i)
  {
    const Vec2 &a = curve.points[i], &b = curve.points[(i + 1) % n];
    const double dx = b[0] - a[0], dy = b[1] - a[1];
    const double t = std::clamp(
      ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / std::max(dx * dx + dy * dy, 1e-300), 0.0, 1.0);
    const double d = std::hypot(p[0] - a[0] - t * dx, p[1] - a[1] - t * dy);
    if (d < nearest)
    {
      nearest = d;
      // The points of the curve are equidistant, so that the index is proportional to the arc
      // length.
      arc = (static_cast<double>(i) + t) / static_cast<double>(n);
    }
  }
  return arc;
}

/// The mirror image: reverses vertices and edges, and the heights of each descriptor.
OutlineModel::Polygon mirrorImage(const OutlineModel::Polygon& polygon)
{
  ShapeSource source;
  source.mesh = polygon.mesh;
  OutlineModel::Polygon result;
  result.mesh = transformSource(source, 0.0, true).mesh;
  const Index n = static_cast<Index>(polygon.advance.size());
  for (Index v = 0; v < n; ++v)
  {
    // The edge from vertex n - 1 - v back to n - 2 - v.
    const Index edge = (2 * n - 2 - v) % n;
    result.advance.push_back(polygon.advance[edge]);
    for (Index g = DescriptorSamples - 1; g >= 0; --g)
    {
      const float* d =
        polygon.descriptors.data() + (edge * DescriptorSamples + g) * OutlineChannels;
      result.descriptors.insert(result.descriptors.end(),
        std::make_reverse_iterator(d + OutlineHeights), std::make_reverse_iterator(d));
      result.descriptors.insert(result.descriptors.end(), d + OutlineHeights, d + OutlineChannels);
    }
  }
  return result;
}

/// Quantiles of each number of the descriptors over the locations; the same for a mirror image.
std::vector<float> makeSignature(const std::vector<float>& descriptors)
{
  std::vector<float> signature;
  const std::size_t count = descriptors.size() / OutlineChannels;
  for (Index k = 0; k < OutlineChannels; ++k)
  {
    const Index other = k < OutlineHeights ? OutlineHeights - 1 - k : k;
    if (other < k)
    {
      continue;
    }
    std::vector<float> values;
    for (std::size_t i = 0; i < count; ++i)
    {
      values.push_back(descriptors[static_cast<std::size_t>(k) * count + i]);
      values.push_back(descriptors[static_cast<std::size_t>(other) * count + i]);
    }
    std::sort(values.begin(), values.end());
    for (int q = 0; q < SignatureQuantiles; ++q)
    {
      const double at = (q + 0.5) / SignatureQuantiles * static_cast<double>(values.size());
      signature.push_back(values[static_cast<std::size_t>(at)]);
    }
  }
  return signature;
}

/// The outline, smoothed, and a polygon that follows it and can be placed on the locations.
struct OutlinePolygon
{
  Curve curve;
  std::vector<Vec2> points;
};

OutlinePolygon makePolygon(const Silhouette& shape, const OutlineOptions& options)
{
  OutlinePolygon result;
  double smoothing = options.smoothing;
  Index count = CurvePoints;
  for (bool found = false; !found;)
  {
    result.curve = makeCurve(shape, smoothing, count);
    try
    {
      result.points = approximateOutline(result.curve.points, options.spacing);
      found = true;
    }
    catch (const Error&)
    {
      // With this smoothing or sampling, the sides of a thin part meet.
      if (count >= MostCurvePoints)
      {
        throw;
      }
      count *= 2;
      smoothing *= SmoothingReduction;
    }
  }
  // Thin parts and many corners need many vertices: with fewer, the approximation is worse.
  const Index most = options.locations * VerticesPerLocations[0] / VerticesPerLocations[1];
  if (static_cast<Index>(result.points.size()) > most)
  {
    if (1.0 / options.spacing > static_cast<double>(most)) // for any outline
    {
      const std::size_t n = result.points.size();
      throw Error("The polygon has " + std::to_string(n) + " vertices: " + std::to_string(2 * n) +
        " locations or more are needed, or a larger spacing.");
    }
    result.points = reducePolygon(std::move(result.points), most);
  }
  return result;
}

void check(const OutlineOptions& o)
{
  const bool sampling = o.spacing >= 0.01 && o.spacing <= 0.25 && o.locations >= 16 &&
    o.locations <= 512 && o.smoothing > 0.0 && o.smoothing <= 0.1;
  if (!sampling)
  {
    throw Error("Outlines need a spacing from 0.01 to 0.25 and a smoothing above 0 up to 0.1, as "
                "fractions of the length, and 16 to 512 locations.");
  }
  const double finite = o.deformation + o.distortion + o.ordering + o.descriptor + o.stretch;
  const bool weights = o.deformation >= 0.0 && o.distortion >= 0.0 && o.ordering >= 0.0 &&
    o.descriptor >= 0.0 && o.region >= 0.0 && o.region <= 1.0 && o.stretch > 1.0;
  if (!weights || !std::isfinite(finite))
  {
    throw Error("Weights of outlines must be at least 0 and finite, the share of regions at most "
                "1, and the stretch above 1.");
  }
}
}

//------------------------------------------------------------------------------
OutlineModel prepareOutline(const Silhouette& shape, const OutlineOptions& options)
{
  check(options);
  if (shape.outline.size() < 3 || !(shape.area > 0.0))
  {
    throw Error("The outline has no area.");
  }
  const auto [curve, polygon] = makePolygon(shape, options);
  const Describer describer(shape, curve, options);
  OutlineModel model;
  model.complexity = describer.complexity();
  model.polygon.mesh = triangulatePolygon(polygon);
  const Index n = static_cast<Index>(model.polygon.mesh.points.size());
  std::vector<double> arcs;
  for (const Vec2& p : model.polygon.mesh.points)
  {
    arcs.push_back(arcOf(curve, p));
  }
  constexpr double least = 1e-3; // an edge of no length has no expected advance
  for (Index v = 0; v < n; ++v)
  {
    const double part = std::max(least, fraction(arcs[(v + 1) % n] - arcs[v]));
    model.polygon.advance.push_back(part * static_cast<double>(options.locations));
    for (Index g = 0; g < DescriptorSamples; ++g)
    {
      describer.append(arcs[v] + part * (static_cast<double>(g) + 0.5) / DescriptorSamples,
        model.polygon.descriptors);
    }
  }
  const Index fine = DescriptorsPerLocation * options.locations;
  std::vector<float> rows;
  for (Index i = 0; i < fine; ++i)
  {
    describer.append(static_cast<double>(i) / static_cast<double>(fine), rows);
  }
  // Store one number after the other, so that loops over the locations are vectorized.
  for (Index k = 0; k < OutlineChannels; ++k)
  {
    for (Index i = 0; i < fine; ++i)
    {
      model.descriptors.push_back(rows[i * OutlineChannels + k]);
    }
  }
  // Store the locations twice around plus one packet, so that loops need not wrap.
  for (Index i = 0; i < 2 * options.locations + FloatWidth; ++i)
  {
    const Vec2 p =
      curve.at(static_cast<double>(i % options.locations) / static_cast<double>(options.locations));
    model.x.push_back(static_cast<float>(p[0]));
    model.y.push_back(static_cast<float>(p[1]));
  }
  const std::size_t stride = model.x.size();
  model.distances.reserve(static_cast<std::size_t>(options.locations) * stride);
  for (Index a = 0; a < options.locations; ++a)
  {
    for (std::size_t p = 0; p < stride; ++p)
    {
      const std::size_t from = p % static_cast<std::size_t>(options.locations);
      const std::size_t to = from + static_cast<std::size_t>(a);
      model.distances.push_back(
        std::hypot(model.x[to] - model.x[from], model.y[to] - model.y[from]));
    }
  }
  model.signature = makeSignature(model.descriptors);
  if (options.mirrored)
  {
    model.mirror = mirrorImage(model.polygon);
  }
  return model;
}

double signatureDistance(const OutlineModel& a, const OutlineModel& b)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < std::min(a.signature.size(), b.signature.size()); ++i)
  {
    sum += std::abs(static_cast<double>(a.signature[i]) - static_cast<double>(b.signature[i]));
  }
  return sum;
}
}
