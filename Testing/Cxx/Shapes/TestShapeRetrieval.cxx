// SPDX-License-Identifier: BSD-3-Clause
// Rankings and rates counted by hand; families of shapes are distinguished; threads, stops, errors.

#include "Registry.h"
#include "Shapes.h"
#include "ThreadRanks.h"
#include "tautline/Shapes/ShapeRetrieval.h"

using namespace tautline;

namespace
{
TAUTLINE_PART(testCounting)
{
  // Two classes of two: shape 0 finds its own class first, 1 does not, 2 and 3 do.
  const std::vector<double> distances = { 0, 1, 2, 3, /**/ 4, 0, 1, 2, /**/ 5, 6, 0, 1, /**/ 3, 3,
    2, 0 };
  const std::vector<Index> ranking = rankShapes(distances, 4);
  const std::vector<Index> expected = { 1, 2, 3, 2, 3, 0, 3, 0, 1, 2, 0, 1 };
  TAUTLINE_CHECK(ranking == expected);
  const Recognition found = recognize(ranking, { 7, 7, 9, 9 }, 1);
  TAUTLINE_CHECK_EQUAL(found.hits, 3);
  TAUTLINE_CHECK_EQUAL(found.possible, 4);
  TAUTLINE_CHECK_NEAR(found.rate, 0.75, 1e-15);
  TAUTLINE_CHECK(found.classes == (std::vector<Index>{ 7, 9 }));
  TAUTLINE_CHECK_NEAR(found.confusion[0], 0.5, 1e-15);
  TAUTLINE_CHECK_NEAR(found.confusion[1], 0.5, 1e-15);
  TAUTLINE_CHECK_NEAR(found.confusion[3], 1.0, 1e-15);
  // A class of two has only one other to find: more matches than that are not possible.
  TAUTLINE_CHECK_EQUAL(recognize(ranking, { 7, 7, 9, 9 }, 10).possible, 4);
  // Not computed is last.
  TAUTLINE_CHECK(
    (rankShapes({ 0, -1, 2, 1, 0, -1, -1, -1, 0 }, 3) == std::vector<Index>{ 2, 1, 0, 2, 0, 1 }));
}

TAUTLINE_PART(testFamilies)
{
  std::vector<Silhouette> shapes;
  std::vector<Index> labels;
  for (int k = 0; k < 3; ++k)
  {
    shapes.push_back(traceSilhouette(blob(100, 48 + k, 50, 22.0 + 2 * k, 0.5 * k).view()));
    labels.push_back(0);
    shapes.push_back(traceSilhouette(disc(100, 50, 47 + k, 20.0 + 3 * k).view()));
    labels.push_back(1);
    const double a = 10.0 + k;
    shapes.push_back(traceSilhouette(paint(100, 100,
      [=](double x, double y) {
        return std::abs(x - 50) < 40 && std::abs(y - 50) < a ? 1.0 : -1.0;
      }).view()));
    labels.push_back(2);
  }
  RetrievalOptions options = RetrievalOptions::highest();
  TAUTLINE_SET(options, best = 2, match.threads = 1);
  const Retrieval one = retrieveShapes(shapes, labels, options);
  TAUTLINE_CHECK_NEAR(one.recognition.rate, 1.0, 1e-15);
  TAUTLINE_CHECK(one.stop == MatchStop::Complete);
  for (Index s = 0; s < one.count; ++s)
  {
    for (Index t = 0; t < one.count; ++t)
    {
      TAUTLINE_CHECK(
        one.distances[s * one.count + t] == one.distances[t * one.count + s]); // symmetric
    }
  }
  options.match.threads = 3;
  TAUTLINE_CHECK(retrieveShapes(shapes, labels, options).distances == one.distances);

  int calls = 0;
  options.symmetric = false;
  options.match.progress = [&](double part) { return part >= 0.0 && part <= 1.0 && ++calls < 4; };
  const Retrieval stopped = retrieveShapes(shapes, labels, options);
  TAUTLINE_CHECK(stopped.stop == MatchStop::Stopped);
  TAUTLINE_CHECK(std::count(stopped.distances.begin(), stopped.distances.end(), -1.0) > 0);
  TAUTLINE_CHECK_EQUAL(stopped.ranking.size(), 72u);
  TAUTLINE_SET(options, match.progress = nullptr, match.timeLimit = 1e-9);
  TAUTLINE_CHECK(retrieveShapes(shapes, labels, options).stop == MatchStop::TimeLimit);
  options.match.timeLimit = 0;

  options.outline.spacing = -1.0;
  TAUTLINE_CHECK_THROWS(retrieveShapes(shapes, labels, options), wording("shape-0-outlines-need"));
  options = RetrievalOptions();
  TAUTLINE_SET(options, locations.kind = Locations::Contour, spacing = -1.0);
  TAUTLINE_CHECK_THROWS(retrieveShapes(shapes, labels, options), wording("shape-0-the-spacing"));
  TAUTLINE_SET(options, spacing = 15.0, match.energy.distortion = std::nan(""));
  TAUTLINE_CHECK_THROWS(retrieveShapes(shapes, labels, options), wording("distortion-weight"));
  options = TAUTLINE_CHANGED(RetrievalOptions::highest(), complexity = 0.0);
  TAUTLINE_CHECK_THROWS(
    retrieveShapes(shapes, labels, options), wording("complexity-must-be-above-0"));
  TAUTLINE_SET(options, complexity = 0.3, shortlist = -1);
  TAUTLINE_CHECK_THROWS(retrieveShapes(shapes, labels, options), wording("at-least-0"));
  TAUTLINE_CHECK_THROWS(rerank({ 0, 1, 1, 0 }, 2, 0), wording("at-least-1-neighbour"));
  TAUTLINE_CHECK_THROWS(retrieveShapes({ shapes[0] }, { 0 }, {}), wording("at-least-2"));
  TAUTLINE_CHECK_THROWS(retrieveShapes(shapes, { 0 }, {}), wording("label-per-shape"));
}

/// Directions and lengths of the limbs of five animals.
struct Limb
{
  double angle, length, width;
};
const std::vector<std::vector<Limb>> Kinds = {
  { { 0.0, 1.0, 0.18 }, { 1.6, 0.7, 0.14 }, { 3.1, 0.9, 0.16 }, { 4.7, 0.7, 0.14 } },
  { { 0.0, 1.2, 0.22 }, { 2.6, 0.8, 0.12 }, { 3.7, 0.8, 0.12 } },
  { { 0.0, 0.6, 0.3 }, { 3.1, 1.3, 0.1 } },
  { { 0.0, 0.8, 0.1 }, { 1.25, 0.8, 0.1 }, { 2.5, 0.8, 0.1 }, { 3.75, 0.8, 0.1 },
    { 5.0, 0.8, 0.1 } },
  { { 1.2, 1.1, 0.25 }, { 4.3, 0.9, 0.3 }, { 0.0, 0.5, 0.12 } },
};
constexpr int Members = 6;

/// A number between -1 and 1 that looks random.
double noise(int seed)
{
  const double x = std::sin(12.9898 * seed + 78.233) * 43758.5453;
  return 2.0 * (x - std::floor(x)) - 1.0;
}

/// Member 0 is the kind itself; 1 and 2 are turned, scaled, their limbs are bent; 3 also lacks the
/// end of a limb behind a straight occluder; 4 has a rough outline; 5 is mirrored.
Silhouette animal(int kind, int member)
{
  const int seed = 100 * kind + 10 * member;
  const double unit = member == 0 ? 45.0 : 45.0 * (1.0 + 0.4 * noise(seed + 1));
  const double turn = member == 0 ? 0.0 : Pi * noise(seed + 2);
  std::vector<Limb> limbs = Kinds[static_cast<std::size_t>(kind)];
  constexpr double bend = 0.3;
  for (std::size_t l = 0; l < limbs.size() && member > 0; ++l)
  {
    limbs[l].angle += bend * noise(seed + 3 + static_cast<int>(l));
  }
  if (member == 3)
  {
    limbs[1].length *= 0.6;
  }
  const Index size = static_cast<Index>(3.6 * unit);
  const double middle = 0.5 * static_cast<double>(size - 1);
  return traceSilhouette(paint(size, size,
    [=](double px, double py)
    {
      const double dx = (member == 5 ? middle - px : px - middle) / unit;
      const double dy = (py - middle) / unit;
      const double x = std::cos(turn) * dx + std::sin(turn) * dy;
      const double y = std::cos(turn) * dy - std::sin(turn) * dx;
      double inside = 0.4 - std::hypot(x, y);
      for (const Limb& limb : limbs)
      {
        const double ux = std::cos(limb.angle), uy = std::sin(limb.angle);
        const double t = std::clamp(x * ux + y * uy, 0.0, limb.length);
        inside = std::max(inside, limb.width - std::hypot(x - t * ux, y - t * uy));
      }
      const double rough =
        member == 4 ? 0.04 * noise(static_cast<int>(px) * 57 + static_cast<int>(py)) : 0.0;
      return inside + rough;
    }).view());
}

TAUTLINE_PART(testArticulation)
{
  std::vector<Silhouette> shapes;
  std::vector<Index> labels;
  for (int kind = 0; kind < static_cast<int>(Kinds.size()); ++kind)
  {
    for (int member = 0; member < Members; ++member)
    {
      shapes.push_back(animal(kind, member));
      labels.push_back(kind);
    }
  }
  RetrievalOptions options = TAUTLINE_CHANGED(RetrievalOptions::highest(), best = Members - 1);
  const Retrieval all = retrieveShapes(shapes, labels, options);
  std::cout << "articulation, occlusion, noise: " << 100.0 * all.recognition.rate << " %\n";
  TAUTLINE_CHECK(all.recognition.rate > 0.95);
  TAUTLINE_CHECK_EQUAL(all.matches, all.count * (all.count - 1));

  // The nearest of all are also on the shortlist; distances are the same, or not computed.
  options.shortlist = 12;
  const Retrieval some = retrieveShapes(shapes, labels, options);
  std::cout << some.matches << " of " << all.matches << " pairs, " << 100.0 * some.recognition.rate
            << " %\n";
  TAUTLINE_CHECK(some.matches < all.matches * 7 / 10);
  TAUTLINE_CHECK(some.recognition.rate > 0.9);
  TAUTLINE_CHECK(some.stop == MatchStop::Complete);
  Index computed = 0;
  for (std::size_t pair = 0; pair < all.distances.size(); ++pair)
  {
    const double d = some.distances[pair];
    TAUTLINE_CHECK(d == -1.0 || d == all.distances[pair]);
    computed += d > 0.0;
  }
  TAUTLINE_CHECK_EQUAL(computed, some.matches);

  // Diffusion ranks no worse; wrong labels also give a low rate with it.
  TAUTLINE_SET(options, shortlist = 0, neighbours = 5);
  const Retrieval passed = retrieveShapes(shapes, labels, options);
  std::cout << "after diffusion: " << 100.0 * passed.recognition.rate << " %\n";
  TAUTLINE_CHECK(passed.recognition.rate >= all.recognition.rate);
  std::vector<Index> wrong = labels;
  for (std::size_t s = 0; s < wrong.size(); ++s)
  {
    wrong[s] = static_cast<Index>(s % Kinds.size());
  }
  TAUTLINE_CHECK(recognize(passed.ranking, wrong, options.best).rate < 0.4);
}

/// On ranks that are threads: the distances of one rank, bitwise; what ends one ends all.
TAUTLINE_PART(testRanks)
{
  std::vector<Silhouette> shapes;
  std::vector<Index> labels;
  constexpr int kinds = 3;
  for (int kind = 0; kind < kinds; ++kind)
  {
    shapes.push_back(animal(kind, 0));
    shapes.push_back(animal(kind, 1));
    labels.insert(labels.end(), 2, kind);
  }
  TAUTLINE_LET(RetrievalOptions, image, spacing = 20.0, locations.kind = Locations::Contour,
    locations.contour = 24);
  RetrievalOptions shortlist = RetrievalOptions::highest();
  shortlist.shortlist = 2;
  for (RetrievalOptions options : { RetrievalOptions::highest(), shortlist, image })
  {
    options.match.threads = 1;
    const Retrieval one = retrieveShapes(shapes, labels, options);
    for (const int size : { 2, 5 })
    {
      const Context context(std::to_string(size) + " ranks");
      std::vector<Retrieval> all(size);
      onRanks(size,
        [&](RankGroup& group)
        {
          const bool first = group.rank() == 0;
          const std::vector<Silhouette> here =
            shapesOfFirst(group, first ? shapes : std::vector<Silhouette>());
          all[group.rank()] = retrieveShapes(group, here, labels, options);
        });
      TAUTLINE_CHECK(all[0].distances == one.distances);
      TAUTLINE_CHECK(all[0].ranking == one.ranking);
      for (const Retrieval& result : all)
      {
        TAUTLINE_CHECK_EQUAL(result.matches, one.matches);
        TAUTLINE_CHECK(result.stop == MatchStop::Complete);
      }
    }
  }
  // One rank is stopped, one has no time, one has a shape without area.
  std::vector<MatchStop> stops(3);
  const auto runOn = [&](int rank, const auto& change)
  {
    onRanks(3,
      [&](RankGroup& group)
      {
        RetrievalOptions options = TAUTLINE_CHANGED(RetrievalOptions::highest(), match.threads = 1);
        std::vector<Silhouette> here = shapes;
        if (group.rank() == rank)
        {
          change(options, here);
        }
        stops[group.rank()] = retrieveShapes(group, here, labels, options).stop;
      });
  };
  using Shapes = std::vector<Silhouette>;
  runOn(2,
    [](RetrievalOptions& options, Shapes&)
    { options.match.progress = [](double part) { return part < 0.2; }; });
  TAUTLINE_CHECK(stops == std::vector<MatchStop>(3, MatchStop::Stopped));
  runOn(1, [](RetrievalOptions& options, Shapes&) { options.match.timeLimit = 1e-9; });
  TAUTLINE_CHECK(stops == std::vector<MatchStop>(3, MatchStop::TimeLimit));
  TAUTLINE_CHECK_THROWS(runOn(1, [](RetrievalOptions&, Shapes& here) { here[3].outline.clear(); }),
    wording("in-process-1-shape-3"));
}
}
