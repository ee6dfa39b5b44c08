// SPDX-License-Identifier: BSD-3-Clause
// The energy's terms, the exact search against brute force and the plain loop, invariances.

#include "Registry.h"
#include "Shapes.h"

#include <limits>

using namespace tautline;

namespace
{
ShapeEnergy plain()
{
  return ShapeEnergy::dissertation();
}

/// Known values of each term of the energy.
TAUTLINE_PART(testTerms)
{
  const std::array<Vec2, 3> s = { Vec2{ 0, 0 }, Vec2{ 1, 0 }, Vec2{ 0, 1 } };
  // A similarity costs nothing but what its size differs by.
  TriangleEnergy e = triangleEnergy(s, { Vec2{ 5, 5 }, Vec2{ 5, 7 }, Vec2{ 3, 5 } }, 0.5, plain());
  TAUTLINE_CHECK_NEAR(e.deformation, 0.0, 1e-12);
  TAUTLINE_CHECK_NEAR(e.distortion, 0.0, 1e-12);
  TAUTLINE_CHECK_NEAR(e.rotation, 1.0, 1e-12); // by 90 degrees
  e = triangleEnergy(s, { Vec2{ 0, 0 }, Vec2{ 2, 0 }, Vec2{ 0, 2 } }, 1.0, plain());
  TAUTLINE_CHECK_NEAR(e.distortion, std::log(2.0), 1e-12); // gamma = 2, delta = 1
  TAUTLINE_CHECK_NEAR(e.rotation, 0.0, 1e-12);
  // Singular values 3 and 1.
  e = triangleEnergy(s, { Vec2{ 0, 0 }, Vec2{ 3, 0 }, Vec2{ 0, 1 } }, 1.0, plain());
  TAUTLINE_CHECK_NEAR(e.deformation, std::log(3.0) * std::log(3.0), 1e-12);
  const double grown = (4.0 + std::sqrt(10.0)) / (2.0 + std::sqrt(2.0));
  TAUTLINE_CHECK_NEAR(e.distortion, std::log(grown), 1e-12);
  // gamma and delta are ratios of the larger to the smaller: shrinking elsewhere is free.
  const std::array<Vec2, 3> half = { Vec2{ 0, 0 }, Vec2{ 0.5, 0 }, Vec2{ 0, 0.5 } };
  TAUTLINE_CHECK_NEAR(triangleEnergy(s, half, 0.5, plain()).distortion, 0.0, 1e-12);
  ShapeEnergy strict = TAUTLINE_CHANGED(plain(), signedDistortion = true);
  TAUTLINE_CHECK_NEAR(triangleEnergy(s, half, 0.5, strict).distortion, 2.0 * std::log(2.0), 1e-12);
  // A triangle turned over counts as flat, or is free.
  const std::array<Vec2, 3> mirror = { Vec2{ 0, 0 }, Vec2{ -1, 0 }, Vec2{ 0, 1 } };
  TAUTLINE_CHECK(triangleEnergy(s, mirror, 1.0, plain()).deformation > 100.0);
  ShapeEnergy freely = TAUTLINE_CHANGED(plain(), reflection = Reflection::Free);
  TAUTLINE_CHECK_NEAR(triangleEnergy(s, mirror, 1.0, freely).deformation, 0.0, 1e-12);
  // Flat and collapsed triangles are finite.
  for (const auto& t : { std::array<Vec2, 3>{ Vec2{ 0, 0 }, Vec2{ 1, 0 }, Vec2{ 2, 0 } },
         std::array<Vec2, 3>{ Vec2{ 1, 1 }, Vec2{ 1, 1 }, Vec2{ 1, 1 } } })
  {
    e = triangleEnergy(s, t, 1.0, plain());
    TAUTLINE_CHECK(
      std::isfinite(e.deformation) && e.deformation > 100.0 && std::isfinite(e.distortion));
  }
}

/// The edge cost on the edge of a half plane, and far away from it.
TAUTLINE_PART(testEdgeCost)
{
  const Picture picture = paint(120, 120,
    [](double x, double y) { return x > 59.5 && x < 110 && y > 5 && y < 115 ? 1.0 : -1.0; });
  const ShapeTarget target(traceSilhouette(picture.view()), {}, plain());
  TAUTLINE_CHECK_NEAR(target.edgeCost({ 59.5, 30 }, { 59.5, 90 }), 1.0 / 1.1, 0.05);
  TAUTLINE_CHECK_NEAR(target.edgeCost({ 85, 40 }, { 85, 80 }), 10.0, 1e-3);
  const double whole = target.edgeCost({ 40, 60 }, { 80, 60 });
  TAUTLINE_CHECK(whole > 7.0 && whole < 10.0); // across: most of it has no gradient
  ShapeEnergy directed = TAUTLINE_CHANGED(plain(), directedEdges = true);
  const ShapeTarget sided(traceSilhouette(picture.view()), {}, directed);
  // The shape is to the right of x = 59.5: downwards it is on the left of the edge.
  TAUTLINE_CHECK_NEAR(sided.edgeCost({ 59.5, 90 }, { 59.5, 30 }), 1.0 / 1.1, 0.05);
  TAUTLINE_CHECK_NEAR(sided.edgeCost({ 59.5, 30 }, { 59.5, 90 }), 10.0, 1e-3);
}

/// Every placement there is.
double bruteForce(const ShapeSource& source, const ShapeTarget& target, const ShapeEnergy& energy)
{
  const std::vector<Vec2>& places = target.locations();
  const std::size_t n = source.mesh.points.size();
  std::vector<std::size_t> at(n, 0);
  double best = std::numeric_limits<double>::infinity();
  for (;;)
  {
    auto points = collect<Vec2>(at, [&](std::size_t i) { return places[i]; });
    best = std::min(best, evaluatePlacement(source, target, energy, points).energy);
    std::size_t v = 0;
    while (v < n && ++at[v] == places.size())
    {
      at[v++] = 0;
    }
    if (v == n)
    {
      return best;
    }
  }
}

TAUTLINE_PART(testBruteForce)
{
  const Silhouette shape = traceSilhouette(blob(64, 30, 33, 16).view());
  const ShapeSource triangle = makeShapeSource({ { 14, 20 }, { 47, 25 }, { 30, 50 } });
  const ShapeSource quadrilateral =
    makeShapeSource({ { 14, 20 }, { 40, 16 }, { 47, 35 }, { 24, 50 } });
  for (int variant = 0; variant < 6; ++variant)
  {
    Context context("variant " + std::to_string(variant));
    TAUTLINE_LET(MatchOptions, options, centreTolerance = 0.0,
      energy.signedDistortion = variant == 1, energy.directedEdges = variant == 2,
      energy.reflection = variant == 3 ? Reflection::Free : Reflection::Forbidden,
      energy.rotation = variant == 4 ? 2.0 : 0.0, energy.distortion = variant == 5 ? 0.0 : 3.0);
    TAUTLINE_LET(LocationOptions, grid, columns = 4, rows = 5);
    const ShapeTarget coarse(shape, grid, options.energy);
    TAUTLINE_CHECK_RELATIVE(matchShape(triangle, coarse, options).energy,
      bruteForce(triangle, coarse, options.energy), 2e-6);
    grid.columns = grid.rows = 3;
    const ShapeTarget tiny(shape, grid, options.energy);
    TAUTLINE_CHECK_RELATIVE(matchShape(quadrilateral, tiny, options).energy,
      bruteForce(quadrilateral, tiny, options.energy), 2e-6);
    TAUTLINE_SET(grid, kind = Locations::Contour, contour = 8);
    options.energy.ordering = variant == 2 ? 1.0 : 0.0;
    const ShapeTarget contour(shape, grid, options.energy);
    TAUTLINE_CHECK_RELATIVE(matchShape(quadrilateral, contour, options).energy,
      bruteForce(quadrilateral, contour, options.energy), 2e-6);
  }
}

/// Descriptors count as much in the search as in the energy.
TAUTLINE_PART(testDescriptorWeight)
{
  const Silhouette from = traceSilhouette(blob(64, 30, 33, 16).view());
  const Silhouette to = traceSilhouette(blob(70, 33, 30, 18, 0.7).view());
  const ShapeSource source = makeShapeSource(from, 40.0);
  TAUTLINE_CHECK(source.mesh.points.size() <= 5); // few enough for all placements
  for (const double weight : { 0.3, 1.0, 3.0, 10.0, 30.0 })
  {
    const Context context("weight " + std::to_string(weight));
    TAUTLINE_LET(MatchOptions, options, centreTolerance = 0.0, energy.descriptor = weight);
    TAUTLINE_LET(LocationOptions, contour, kind = Locations::Contour, contour = 8);
    const ShapeTarget target(to, contour, options.energy);
    const ShapeMatch match = matchShape(source, target, options);
    TAUTLINE_CHECK(match.descriptor > 0.0);
    TAUTLINE_CHECK_RELATIVE(match.energy, bruteForce(source, target, options.energy), 2e-6);
  }
}

/// Bounds skip work and change nothing: on grids and contours, for all terms.
TAUTLINE_PART(testPlainLoop)
{
  const Silhouette from = traceSilhouette(blob(100, 50, 50, 25).view());
  const Silhouette to = traceSilhouette(blob(110, 55, 50, 28, 0.6).view());
  for (int variant = 0; variant < 6; ++variant)
  {
    Context context("variant " + std::to_string(variant));
    TAUTLINE_LET(MatchOptions, options, energy.directedEdges = variant >= 2,
      energy.ordering = variant >= 3 ? 1.0 : 0.0, energy.descriptor = variant >= 4 ? 30.0 : 0.0,
      energy.rotation = variant == 5 ? 0.5 : 0.0, centreTolerance = variant == 1 ? 0.02 : 0.0);
    TAUTLINE_LET(LocationOptions, locations, columns = locations.rows = 14,
      kind = variant < 2 ? Locations::Grid : Locations::Contour);
    const ShapeSource source = makeShapeSource(from, 15.0);
    const ShapeTarget target(to, locations, options.energy);
    const ShapeMatch fast = matchShape(source, target, options);
    options.bounds = false;
    const ShapeMatch slow = matchShape(source, target, options);
    TAUTLINE_CHECK_RELATIVE(fast.energy, slow.energy, 1e-6);
    TAUTLINE_CHECK_EQUAL(fast.rank, slow.rank);
    TAUTLINE_CHECK(fast.exact);
    // The reported energy equals the cost of the placement, and the sum over the triangles.
    const ShapeMatch again = evaluatePlacement(source, target, options.energy, fast.points);
    TAUTLINE_CHECK_RELATIVE(again.energy, fast.energy, 1e-12);
    double edge = 0.0;
    for (const TriangleEnergy& t : fast.triangles)
    {
      edge += t.edge;
    }
    TAUTLINE_CHECK_RELATIVE(edge, fast.edge, 1e-12);
    // No placement made by hand is better: the source scaled onto the target, moved about.
    for (double dx : { -3.0, 0.0, 3.0 })
    {
      std::vector<Vec2> points;
      for (const Vec2& p : source.mesh.points)
      {
        const Vec2 wanted = { to.centre[0] + (p[0] - from.centre[0]) * 1.12 + dx,
          to.centre[1] + (p[1] - from.centre[1]) * 1.12 };
        points.push_back(*std::min_element(target.locations().begin(), target.locations().end(),
          [&](const Vec2& a, const Vec2& b)
          {
            return std::hypot(a[0] - wanted[0], a[1] - wanted[1]) <
              std::hypot(b[0] - wanted[0], b[1] - wanted[1]);
          }));
      }
      TAUTLINE_CHECK(evaluatePlacement(source, target, options.energy, points).energy >=
          slow.energy * (1 - 1e-6) ||
        options.centreTolerance > 0.0);
    }
  }
}

/// Moved by grid steps, scaled, mirrored and turned shapes are found with their energy.
TAUTLINE_PART(testInvariance)
{
  MatchOptions options;
  TAUTLINE_LET(LocationOptions, grid, columns = grid.rows = 16);
  const ShapeSource source = makeShapeSource(traceSilhouette(blob(96, 40, 44, 22).view()), 14.0);
  const auto energyOf = [&](const Picture& picture)
  {
    return matchShape(
      source, ShapeTarget(traceSilhouette(picture.view()), grid, options.energy), options);
  };
  const ShapeMatch base = energyOf(blob(96, 40, 44, 22));
  const ShapeMatch moved = energyOf(blob(96, 52, 50, 22)); // by two steps of 6 pixels and one
  TAUTLINE_CHECK_RELATIVE(moved.energy, base.energy, 1e-5);
  for (std::size_t v = 0; v < base.points.size(); ++v)
  {
    TAUTLINE_CHECK_NEAR(moved.points[v][0] - base.points[v][0], 12.0, 1e-6);
    TAUTLINE_CHECK_NEAR(moved.points[v][1] - base.points[v][1], 6.0, 1e-6);
  }
  // Uniform scaling costs no distortion: a source of half the size has the same optimum.
  std::vector<Vec2> half = source.mesh.points;
  for (Vec2& p : half)
  {
    p = { 0.5 * p[0] + 7.0, 0.5 * p[1] };
  }
  ShapeSource small = makeShapeSource(half);
  small.centre = { 0.5 * source.centre[0] + 7.0, 0.5 * source.centre[1] };
  small.maxDistance = 0.5 * source.maxDistance;
  const ShapeTarget target(traceSilhouette(blob(96, 40, 44, 22).view()), grid, options.energy);
  const ShapeMatch scaled = matchShape(small, target, options);
  // With delta = 1/2 the dissertation's distortion is still |log gamma - log delta|: 0 for the same
  // placement.
  TAUTLINE_CHECK(scaled.energy <= base.energy + 1e-4);
  options.energy.signedDistortion = true;
  TAUTLINE_CHECK_RELATIVE(
    matchShape(small, target, options).energy, matchShape(source, target, options).energy, 1e-5);
  options.energy.signedDistortion = false;
  // The mirror image costs more, unless the whole shape may be reflected.
  grid.kind = Locations::Contour;
  const Picture mirrored = blob(96, 40, 44, 22, 0.0, true);
  const double upright = energyOf(blob(96, 40, 44, 22)).energy,
               forbidden = energyOf(mirrored).energy;
  TAUTLINE_CHECK(forbidden > 1.3 * upright);
  options.energy.reflection = Reflection::Whole;
  const ShapeMatch whole = energyOf(mirrored);
  TAUTLINE_CHECK(whole.mirrored && whole.energy < 1.1 * upright);
  TAUTLINE_CHECK_EQUAL(whole.points.size(), source.mesh.points.size());
  options.energy.reflection = Reflection::Forbidden;
  // Turned by 90 degrees: free without the rotation weight, found by trying orientations with it.
  const Picture turned = blob(96, 48, 48, 22, 1.5707963);
  TAUTLINE_CHECK(energyOf(turned).energy < 1.1 * upright);
  options.energy.rotation = 3.0;
  const double penalised = energyOf(turned).energy;
  options.rotations = 4;
  const ShapeMatch found = energyOf(turned);
  TAUTLINE_CHECK(penalised > 1.3 * upright && found.energy < 1.15 * upright);
  TAUTLINE_CHECK_NEAR(found.angle, 90.0, 1e-9);
}

/// The center-of-mass rule passes solutions over, in the order of their energy.
TAUTLINE_PART(testCentreRule)
{
  MatchOptions options;
  TAUTLINE_LET(LocationOptions, grid, columns = grid.rows = 12);
  // A small triangle fits anywhere on the outline of a disc; the rule places it in the middle.
  const ShapeSource source = makeShapeSource({ { 0, 0 }, { 30, 0 }, { 15, 9 } });
  const ShapeTarget target(traceSilhouette(disc(96, 48, 48, 36).view()), grid, options.energy);
  options.centreTolerance = 0.0;
  const ShapeMatch first = matchShape(source, target, options);
  TAUTLINE_CHECK_EQUAL(first.rank, 1);
  options.centreTolerance = 0.9 * first.centreDistance / target.maxDistance();
  options.maxSolutions = 20000;
  const ShapeMatch next = matchShape(source, target, options);
  TAUTLINE_CHECK(next.rank > 1 && next.energy >= first.energy);
  TAUTLINE_CHECK(next.centreAccepted &&
    next.centreDistance <= options.centreTolerance * target.maxDistance() + 1e-9);
  TAUTLINE_SET(options, centreTolerance = 1e-9, maxSolutions = 3);
  const ShapeMatch none = matchShape(source, target, options);
  TAUTLINE_CHECK(!none.centreAccepted && std::isfinite(none.energy));
}

TAUTLINE_PART(testThreadsAndStops)
{
  const Silhouette shape = traceSilhouette(blob(120, 60, 60, 32).view());
  const ShapeSource source =
    makeShapeSource(traceSilhouette(blob(100, 50, 50, 25, 0.3).view()), 12.0);
  for (const Locations kind : { Locations::Grid, Locations::NearGrid, Locations::Contour })
  {
    MatchOptions options;
    TAUTLINE_LET(LocationOptions, locations, kind = kind, columns = locations.rows = 15);
    const ShapeTarget target(shape, locations, options.energy);
    options.threads = 1;
    const ShapeMatch one = matchShape(source, target, options);
    for (int threads : { 2, 3, 7 })
    {
      options.threads = threads;
      const ShapeMatch several = matchShape(source, target, options);
      TAUTLINE_CHECK(
        several.points == one.points && several.energy == one.energy && several.rank == one.rank);
    }
    // Coarse to fine is not below the exact optimum of its own locations by accident: it is finite
    // and near.
    options.coarseToFine = true;
    const ShapeMatch rough = matchShape(source, target, options);
    TAUTLINE_CHECK(!rough.exact && std::isfinite(rough.energy) && rough.energy < 2.0 * one.energy);
    options.coarseToFine = false;
    // Stopped at once, and after a while: the best so far, marked as such.
    int calls = 0;
    double last = 0.0;
    options.progress = [&](double part)
    {
      TAUTLINE_CHECK(part >= last - 1e-12 && part <= 1.0 + 1e-12);
      last = part;
      return ++calls < 5;
    };
    const ShapeMatch stopped = matchShape(source, target, options);
    TAUTLINE_CHECK(stopped.stop == MatchStop::Stopped && !stopped.exact && calls == 5);
    TAUTLINE_CHECK(stopped.points.size() == one.points.size() && std::isfinite(stopped.energy));
    TAUTLINE_CHECK(stopped.energy >= one.energy * (1 - 1e-6));
    TAUTLINE_SET(options, progress = nullptr, timeLimit = 1e-9);
    const ShapeMatch late = matchShape(source, target, options);
    TAUTLINE_CHECK(late.stop == MatchStop::TimeLimit && std::isfinite(late.energy));
  }
}

TAUTLINE_PART(testRejected)
{
  const Silhouette shape = traceSilhouette(disc(60, 30, 30, 20).view());
  TAUTLINE_LET(LocationOptions, one, columns = one.rows = 1);
  TAUTLINE_CHECK_THROWS(ShapeTarget(shape, one), wording("too-small"));
  TAUTLINE_SET(one, kind = Locations::Contour, contour = 2);
  TAUTLINE_CHECK_THROWS(ShapeTarget(shape, one), wording("at-least-3-2"));
  const ShapeSource source = makeShapeSource(shape, 20.0);
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  const ShapeTarget target(shape, {}, {});
#define REJECTED(change, text) \
  TAUTLINE_CHECK_THROWS(matchShape(source, target, TAUTLINE_CHANGED(MatchOptions(), change)), text)
#define REJECTED_ENERGY(change, text) \
  TAUTLINE_CHECK_THROWS(ShapeTarget(shape, {}, TAUTLINE_CHANGED(ShapeEnergy(), change)), text)
  for (double bad : { nan, inf, -1.0 })
  {
    REJECTED(energy.deformation = bad, wording("deformation-weight-a"));
    REJECTED(energy.distortion = bad, wording("distortion-weight-b"));
    REJECTED(centreTolerance = bad, wording("centre-tolerance"));
    REJECTED_ENERGY(lambda = bad, "lambda");
    REJECTED_ENERGY(smoothing = bad, "smoothing");
  }
  REJECTED(energy.lambda = 0.2, wording("prepared-for-another"));
  REJECTED(scales = 2, wording("odd-number"));
  TAUTLINE_CHECK_THROWS(matchShape(ShapeSource(), target, {}), wording("no-triangles"));
  TAUTLINE_LET(LocationOptions, huge, columns = huge.rows = 300);
  TAUTLINE_CHECK_THROWS(ShapeTarget(shape, huge), "4 GiB");
}

/// A target without the shape, a 3-vertex source, a source larger than the target: a finite answer.
TAUTLINE_PART(testOddTargets)
{
  const ShapeSource source = makeShapeSource(traceSilhouette(blob(200, 100, 100, 60).view()), 25.0);
  const Picture bar = paint(
    64, 64, [](double x, double y) { return y > 30 && y < 34 && x > 3 && x < 60 ? 1.0 : -1.0; });
  for (const Locations kind : { Locations::Grid, Locations::Contour })
  {
    TAUTLINE_LET(LocationOptions, locations, kind = kind, columns = locations.rows = 10);
    const ShapeTarget target(traceSilhouette(bar.view()), locations);
    const ShapeMatch match = matchShape(source, target, {});
    TAUTLINE_CHECK(std::isfinite(match.energy) && match.energy > 0.0);
    const ShapeMatch triangle =
      matchShape(makeShapeSource({ { 0, 0 }, { 3, 0 }, { 0, 3 } }), target, {});
    TAUTLINE_CHECK_EQUAL(triangle.points.size(), 3u);
    TAUTLINE_CHECK(std::isfinite(triangle.energy));
    TAUTLINE_LET(MatchOptions, search, scales = 5);
    const ShapeMatch sized = matchShape(source, target, search);
    search.scales = 1;
    TAUTLINE_CHECK(
      sized.energy <= match.energy * (1 + 1e-6) || sized.centreAccepted > match.centreAccepted);
  }
}
}
