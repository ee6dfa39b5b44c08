// SPDX-License-Identifier: BSD-3-Clause
// Outlines: the same energy whatever the size, direction and mirroring; exact by comparison with a
// program without bounds; a shape is nearest to itself; errors.

#include "Meshes.h"
#include "Registry.h"
#include "Shapes.h"
#include "tautline/Shapes/OutlineMatch.h"

#include <cstdio>

using namespace tautline;

namespace
{
/// A figure with limbs of different lengths and directions, about `extent` pixels wide.
Silhouette figure(double extent, double angle, bool mirrored, int kind)
{
  const double unit = extent / 1.7, c = std::cos(angle), s = std::sin(angle);
  const Index size = static_cast<Index>(2.0 * extent) + 8;
  const double middle = 0.5 * static_cast<double>(size - 1);
  const auto limb = [](double x, double y, double tx, double ty, double r0, double r1)
  {
    const double t = std::clamp((x * tx + y * ty) / (tx * tx + ty * ty), 0.0, 1.0);
    return r0 + t * (r1 - r0) - std::hypot(x - t * tx, y - t * ty);
  };
  return traceSilhouette(paint(size, size,
    [=](double px, double py)
    {
      const double dx = (mirrored ? middle - px : px - middle) / unit, dy = (py - middle) / unit;
      const double x = c * dx + s * dy, y = c * dy - s * dx;
      if (kind == 1)
      {
        return std::max({ 0.35 - std::hypot(x, 1.5 * y), limb(x, y, 0.9, 0.1, 0.2, 0.1),
          limb(x, y, -0.4, 0.5, 0.15, 0.15) });
      }
      return std::max({ 0.3 - std::hypot(x, y), limb(x, y, 0.9, 0.2, 0.14, 0.08),
        limb(x, y, -0.6, 0.6, 0.18, 0.1), limb(x, y, -0.7, -0.4, 0.12, 0.1),
        limb(x, y, 0.35, -0.75, 0.14, 0.12) });
    }).view());
}

/// Energies of copies of one shape with another, relative to the first copy's.
TAUTLINE_PART_SLOW(testInvariance)
{
  const OutlineOptions options;
  const OutlineModel other = prepareOutline(figure(180.0, 0.0, false, 1), options);
  const OutlineModel first = prepareOutline(figure(200.0, 0.0, false, 0), options);
  const double there = matchOutlines(first, other, options).energy;
  const double back = matchOutlines(other, first, options).energy;
  double worst = 0.0;
  for (double extent : { 46.0, 130.0, 1124.0 })
  {
    for (double angle : { 0.0, 0.4, 2.1 })
    {
      for (bool mirrored : { false, true })
      {
        const OutlineModel copy = prepareOutline(figure(extent, angle, mirrored, 0), options);
        const OutlineMatch forward = matchOutlines(copy, other, options);
        const double backward = matchOutlines(other, copy, options).energy;
        const double difference = std::abs(forward.energy + backward - there - back);
        std::printf("extent %.0f angle %.1f mirrored %d: %.4f %.4f\n", extent, angle, mirrored,
          forward.energy, backward);
        worst = std::max(worst, difference / (there + back));
      }
    }
  }
  std::printf("worst difference %.4f\n", worst);
  constexpr double tolerance = 0.02;
  TAUTLINE_CHECK(worst < tolerance);
}

/// The bounds leave out nothing; a shape fits itself best.
TAUTLINE_PART(testExact)
{
  OutlineOptions options;
  OutlineOptions plain = TAUTLINE_CHANGED(options, bounds = false);
  const std::vector<Picture> pictures = { blob(120, 60, 60, 30), blob(120, 60, 60, 34, 0.8, true),
    disc(120, 60, 60, 40),
    paint(120, 120,
      [](double x, double y)
      { return std::abs(x - 60) < 45 && std::abs(y - 60) < 14 ? 1.0 : -1.0; }) };
  auto models = collect<OutlineModel>(pictures,
    [&](const Picture& picture)
    { return prepareOutline(traceSilhouette(picture.view()), options); });
  const auto memory = outlineMemory(); // with what earlier matches left in it
  Index withBounds = 0, without = 0;
  for (std::size_t s = 0; s < models.size(); ++s)
  {
    std::vector<double> row;
    for (const OutlineModel& target : models)
    {
      const OutlineMatch match = matchOutlines(models[s], target, options, memory.get());
      TAUTLINE_CHECK_EQUAL(match.energy, matchOutlines(models[s], target, options).energy);
      const OutlineMatch reference = matchOutlines(models[s], target, plain);
      TAUTLINE_CHECK_NEAR(match.energy, reference.energy, 1e-5 * reference.energy);
      TAUTLINE_CHECK(match.mirrored == reference.mirrored || s >= 2); // 2 and 3 are symmetric
      withBounds += match.triangles;
      without += reference.triangles;
      row.push_back(match.energy);
    }
    TAUTLINE_CHECK(
      std::min_element(row.begin(), row.end()) - row.begin() == static_cast<std::ptrdiff_t>(s) ||
      s < 2);
    // Far below the energy with the least similar one.
    TAUTLINE_CHECK(4 * row[s] < *std::max_element(row.begin(), row.end()));
  }
  // The first two are one shape; the mirror image is recognized.
  const OutlineMatch twins = matchOutlines(models[0], models[1], options);
  TAUTLINE_CHECK(twins.mirrored);
  TAUTLINE_CHECK(twins.energy < 0.5 * matchOutlines(models[0], models[3], options).energy);
  TAUTLINE_CHECK(3 * withBounds < 2 * without);
}

/// The energy with all weights but one at 0, of a shape and itself on all its locations.
TAUTLINE_PART(testTerms)
{
  TAUTLINE_LET(OutlineOptions, options, deformation = options.distortion = options.descriptor = 0.0,
    mirrored = false);
  const OutlineModel model = prepareOutline(traceSilhouette(blob(120, 60, 60, 30).view()), options);
  // Only the ordering is left: advances are rounded, each to one of its neighbors.
  const OutlineMatch match = matchOutlines(model, model, options);
  double least = 0.0;
  for (double advance : model.polygon.advance)
  {
    const double down = std::max(1.0, std::floor(advance)), up = std::ceil(advance);
    least += std::min(std::log(advance / down), std::log(up / advance));
  }
  least /= static_cast<double>(model.polygon.advance.size());
  TAUTLINE_CHECK(match.energy >= least - 1e-6);
  TAUTLINE_CHECK(match.energy < 0.4);
}

/// Thin parts, many corners, lines one pixel wide, several components and holes: each picture has
/// an outline that can be matched with the default options.
TAUTLINE_PART(testThinOutlines)
{
  constexpr Index size = 120;
  constexpr double middle = 60.0;
  const auto star = [](double spikes, double depth)
  {
    return [=](double x, double y)
    {
      const double t = std::atan2(y - middle, x - middle);
      return 30.0 * (1.0 + depth * std::cos(spikes * t)) - std::hypot(x - middle, y - middle);
    };
  };
  const auto comb = [](double pitch, double tooth)
  {
    return [=](double x, double y)
    {
      const bool inTooth = std::fmod(x, pitch) < tooth && y > 10 && y < 110;
      const bool inSpine = y > 100 && y < 110;
      return x > 5 && x < 115 && (inTooth || inSpine) ? 1.0 : -1.0;
    };
  };
  const auto spiral = [](double width)
  {
    return [=](double x, double y)
    {
      const double r = std::hypot(x - middle, y - middle),
                   t = std::atan2(y - middle, x - middle) / (2 * std::acos(-1.0));
      return r < 50 && std::abs(std::remainder(r / 10.0 - t, 1.0)) * 10.0 < width ? 1.0 : -1.0;
    };
  };
  const auto line = [](double slope)
  {
    return [=](double x, double y)
    { return x > 4 && x < 116 && std::lround(slope * x) == std::lround(y) - 3 ? 1.0 : -1.0; };
  };
  const auto zigzag = [](double x, double y)
  {
    const double phase = std::abs(std::remainder(x, 12.0));
    return x > 4 && x < 116 && std::abs(y - 40.0 - 5.0 * phase) < 1.6 ? 1.0 : -1.0;
  };
  const auto rings = [](double x, double y)
  {
    const double r = std::hypot(x - 40.0, y - middle), other = std::hypot(x - 100.0, y - middle);
    return (r < 35 && r > 33.9) || other < 8 ? 1.0 : -1.0;
  };
  const auto dots = [](double x, double y)
  { return std::lround(x + y) % 2 == 0 && std::hypot(x - middle, y - middle) < 30 ? 1.0 : -1.0; };
  const std::vector<std::function<double(double, double)>> pictures = { star(40, 0.6),
    star(25, 0.95), star(7, 0.98), comb(4, 2), comb(3, 1), comb(12, 1), spiral(1.5), spiral(0.8),
    line(0), line(0.9), line(0.37), zigzag, rings, dots,
    [](double x, double y) { return x == 5 && y == 7 ? 1.0 : -1.0; } };
  const OutlineOptions options;
  const OutlineModel plain = prepareOutline(figure(100.0, 0.0, false, 1), options);
  for (std::size_t i = 0; i < pictures.size(); ++i)
  {
    const Context context("picture " + std::to_string(i));
    const OutlineModel model =
      prepareOutline(traceSilhouette(paint(size, size, pictures[i]).view()), options);
    const std::vector<Vec2>& points = model.polygon.mesh.points;
    TAUTLINE_CHECK(points.size() >= 3 && points.size() <= 42 && isSimple(points));
    const double itself = matchOutlines(model, model, options).energy;
    const double there = matchOutlines(model, plain, options).energy;
    const double back = matchOutlines(plain, model, options).energy;
    TAUTLINE_CHECK(itself >= 0 && std::isfinite(itself) && itself < there && itself < back);
  }
}

/// A polygon with fewer vertices stays simple, and what is small goes first.
TAUTLINE_PART(testReducePolygon)
{
  std::vector<Vec2> square; // 40 points on the sides, every other one a little outside
  for (int side = 0; side < 4; ++side)
  {
    for (int k = 0; k < 10; ++k)
    {
      const double t = 0.1 * k, out = k % 2 == 1 ? -0.001 : 0.0;
      const Vec2 p = side == 0 ? Vec2{ t, out }
        : side == 1            ? Vec2{ 1 - out, t }
        : side == 2            ? Vec2{ 1 - t, 1 - out }
                               : Vec2{ out, 1 - t };
      square.push_back(p);
    }
  }
  const std::vector<Vec2> corners = reducePolygon(square, 4);
  TAUTLINE_CHECK_EQUAL(corners.size(), std::size_t(4));
  TAUTLINE_CHECK_NEAR(signedArea(corners), signedArea(square), 0.02 * signedArea(square));
  Random random(5);
  std::vector<Vec2> wild;
  for (int k = 0; k < 300; ++k)
  {
    const double angle = k * std::acos(-1.0) / 150.0, r = random.uniform(0.02, 1.0);
    wild.push_back({ r * std::cos(angle), r * std::sin(angle) });
  }
  for (const Index most : { 299, 150, 42, 10, 3 })
  {
    const std::vector<Vec2> fewer = reducePolygon(wild, most);
    TAUTLINE_CHECK(static_cast<Index>(fewer.size()) <= most && isSimple(fewer));
    TAUTLINE_CHECK(signedArea(fewer) > 0);
  }
}

TAUTLINE_PART(testErrors)
{
  const Silhouette shape = traceSilhouette(blob(120, 60, 60, 30).view());
  OutlineOptions options;
  const OutlineModel model = prepareOutline(shape, options);
  OutlineOptions wrong = TAUTLINE_CHANGED(options, spacing = std::nan(""));
  TAUTLINE_CHECK_THROWS(prepareOutline(shape, wrong), wording("spacing-from-0-01"));
  wrong = TAUTLINE_CHANGED(options, stretch = 1.0);
  TAUTLINE_CHECK_THROWS(prepareOutline(shape, wrong), wording("stretch-above-1"));
  wrong = TAUTLINE_CHANGED(options, locations = 20);
  TAUTLINE_CHECK_THROWS(prepareOutline(shape, wrong), wording("locations-or-more"));
  wrong.locations = 80;
  TAUTLINE_CHECK_THROWS(matchOutlines(model, model, wrong), wording("prepared-with"));
  TAUTLINE_CHECK_THROWS(prepareOutline(Silhouette(), options), wording("no-area"));
}
}
