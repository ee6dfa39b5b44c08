// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OptimizingOnRanks.h
 * @brief Meshes that threads as ranks optimize, for tests.
 */
#ifndef tautline_OptimizingOnRanks_h
#define tautline_OptimizingOnRanks_h

#include "Optimizing.h"
#include "ThreadRanks.h"
#include "tautline/Mesh/BoundaryShape.h"
#include "tautline/Optimization/OptimizeOnRanks.h"
#include "tautline/Untangling/UntangleOnRanks.h"

namespace tautline
{
/** Points of the whole mesh, and what is the same on all ranks. */
struct Run
{
  std::vector<double> points;
  OptimizeResult result;
  std::size_t remaining = 0;
};

enum class Constraint
{
  FixedBoundary,
  Sliding,
  Limits,
  Untangle /**< untangleOnRanks() */
};

inline Run runOn(const MeshData& whole, Cut cut, int ranks, const OptimizeOptions& given,
  Constraint constraint, double limit)
{
  const auto rankOf = cutBy(whole, cut, ranks);
  Run run;
  run.points = whole.points;
  std::mutex mutex;
  onRanks(ranks,
    [&](RankGroup& group)
    {
      const RankPart part = partOf(whole, group.rank(), rankOf, cut == Cut::Slabs);
      DistributedMesh mesh(group, { part.data.view(), nullptr, part.ghosts.data() });
      OptimizeOptions options = given;
      std::vector<unsigned char> fixed = rankBoundary(mesh);
      BoundaryShape shape;
      std::vector<double> limits(mesh.localPoints(), limit);
      if (constraint == Constraint::Sliding && mesh.view().numberOfCells > 0)
      {
        shape = boundaryShape(Mesh(mesh.view()), 1.0);
        fixed = shape.fixed;
        options.slidePlanes = shape.planes.data();
        options.slideLines = shape.lines.data();
      }
      options.limits = constraint == Constraint::Limits ? limits.data() : nullptr;
      options.fixed = fixed.data();
      options.threads = 1 + group.rank() % 2;
      OptimizeResult result;
      std::size_t remaining = 0;
      if (constraint == Constraint::Untangle)
      {
        UntangleOptions untangling;
        untangling.fixed = fixed.data();
        const RankUntangleResult untangled = untangleOnRanks(mesh, false, untangling);
        result.points = untangled.result.points;
        result.history = untangled.result.history;
        result.reason = untangled.result.reason;
        result.invertedBefore = untangled.result.invertedBefore;
        result.invertedAfter = untangled.result.invertedAfter;
        remaining = untangled.remaining.size();
      }
      else
      {
        result = optimizeOnRanks(mesh, false, options);
      }
      const std::lock_guard<std::mutex> lock(mutex);
      for (std::size_t p = 0; p < part.pointOf.size(); ++p)
      {
        std::copy_n(
          &result.points[3 * mesh.localOfPiece()[p]], 3, &run.points[3 * part.pointOf[p]]);
      }
      run.remaining = remaining;
      run.result = result;
    });
  return run;
}

inline double farthest(const std::vector<double>& a, const std::vector<double>& b)
{
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    largest = std::max(largest, std::abs(a[i] - b[i]));
  }
  return largest;
}

inline OptimizeOptions with(std::vector<Metric> metrics)
{
  OptimizeOptions options;
  options.objectives.clear();
  for (const Metric metric : metrics)
  {
    options.objectives.emplace_back();
    options.objectives.back().metric = metric;
  }
  return options;
}
}
#endif
