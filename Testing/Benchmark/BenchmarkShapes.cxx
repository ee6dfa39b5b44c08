// SPDX-License-Identifier: BSD-3-Clause
// Shape matching: nanoseconds of one match, for the ratios of run.py: of outlines (the retrieval's
// default) and of polygons with images. Single-thread times are CPU time.
//
// usage: BenchmarkShapes shapes SIZE REPEATS    the grid has min(SIZE, 30) columns and rows

#include "tautline/Shapes/ShapeRetrieval.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

using namespace tautline;

namespace
{
/// Lobed shapes, 128 pixels wide: the lobes make the kind, the phase the member.
Silhouette makeShape(int kind, double phase)
{
  constexpr Index size = 128;
  std::vector<float> pixels(size * size);
  for (Index j = 0; j < size; ++j)
  {
    for (Index i = 0; i < size; ++i)
    {
      const double x = static_cast<double>(i) - 63.0, y = static_cast<double>(j) - 64.0;
      const double t = std::atan2(y, x) + phase;
      const double edge =
        40.0 * (1.0 + 0.25 * std::cos(kind * t) + 0.15 * std::cos(2.0 * t + phase));
      pixels[j * size + i] = std::hypot(x, y) < edge ? 1.0f : 0.0f;
    }
  }
  return traceSilhouette({ pixels.data(), size, size });
}

double cpuSeconds()
{
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double wallSeconds()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The fastest of some runs, in nanoseconds.
template <class Clock, class Work>
double fastest(int repeats, const Clock& clock, const Work& work)
{
  double best = 1e300;
  for (int run = 0; run < repeats; ++run)
  {
    const double start = clock();
    work();
    best = std::min(best, clock() - start);
  }
  return 1e9 * best;
}

/// The retrieval's default, outlines with outlines: preparation of one, and the mean of all pairs
/// of different shapes, one direction each.
void measureOutlines(const std::vector<Silhouette>& shapes, int repeats)
{
  const OutlineOptions options = RetrievalOptions::highest().outline;
  std::vector<OutlineModel> models;
  const double prepared = fastest(repeats, cpuSeconds,
    [&]
    {
      models.clear();
      for (const Silhouette& shape : shapes)
      {
        models.push_back(prepareOutline(shape, options));
      }
    });
  const auto count = static_cast<double>(shapes.size());
  std::printf("shapes outline prepared\t%.0f\n", prepared / count);
  const auto memory = outlineMemory();
  const double all = fastest(repeats, cpuSeconds,
    [&]
    {
      for (const OutlineModel& source : models)
      {
        for (const OutlineModel& target : models)
        {
          if (&source != &target)
          {
            matchOutlines(source, target, options, memory.get());
          }
        }
      }
    });
  std::printf("shapes outline mean\t%.0f\n", all / (count * (count - 1.0)));
}
}

int main(int argc, char* argv[])
{
  const Index grid = std::min(30, std::max(4, argc > 2 ? std::atoi(argv[2]) : 30));
  const int repeats = std::max(1, argc > 3 ? std::atoi(argv[3]) : 5);
  const int gridRepeats = std::min(repeats, 3);
  std::vector<ShapeSource> sources;
  std::vector<ShapeTarget> contours;
  std::vector<Silhouette> shapes;
  LocationOptions contour;
  contour.kind = Locations::Contour;
  for (int kind = 2; kind <= 5; ++kind)
  {
    for (double phase : { 0.1, 0.4 })
    {
      const Silhouette& shape = shapes.emplace_back(makeShape(kind, phase));
      sources.push_back(makeShapeSource(shape, 25.0));
      contours.emplace_back(shape, contour);
    }
  }
  measureOutlines(shapes, repeats);
  MatchOptions options;
  options.threads = 1;
  std::printf("shapes contour like\t%.0f\n",
    fastest(repeats, cpuSeconds, [&] { matchShape(sources[0], contours[1], options); }));
  const double all = fastest(gridRepeats, cpuSeconds,
    [&]
    {
      for (const ShapeSource& source : sources)
      {
        for (const ShapeTarget& target : contours)
        {
          matchShape(source, target, options);
        }
      }
    });
  std::printf(
    "shapes contour mean\t%.0f\n", all / static_cast<double>(sources.size() * contours.size()));
  LocationOptions lattice;
  lattice.columns = lattice.rows = grid;
  const ShapeTarget target(makeShape(3, 0.3), lattice);
  const auto match = [&] { matchShape(sources[2], target, options); };
  std::printf("shapes vertices\t%zu\n", sources[2].mesh.points.size());
  std::printf("shapes grid\t%.0f\n", fastest(gridRepeats, cpuSeconds, match));
  std::printf("shapes grid wall 1\t%.0f\n", fastest(gridRepeats, wallSeconds, match));
  options.threads = 2;
  std::printf("shapes grid wall 2\t%.0f\n", fastest(gridRepeats, wallSeconds, match));
  options.threads = 1;
  options.bounds = false;
  std::printf("shapes grid plain\t%.0f\n", fastest(1, cpuSeconds, match));
  return EXIT_SUCCESS;
}
