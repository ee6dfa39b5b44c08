// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file OptimizingRanks.h
 * @brief Meshes that threads as ranks optimize, for tests.
 */
#ifndef tautline_OptimizingRanks_h
#define tautline_OptimizingRanks_h

#include "MovingRanks.h"
#include "Optimizing.h"
#include "tautline/Mesh/BoundaryShape.h"
#include "tautline/Optimization/Optimize.h"
#include "tautline/Quality/Targets.h"
#include "tautline/Untangling/Untangle.h"

#include <functional>

namespace tautline
{
/** The result of a rank: the result of optimize() or of untangle(). */
struct Found : OptimizeResult
{
  std::size_t remaining = 0;
};
using Run = Moved<Found>;

/** Weights and targets of the cells of a mesh or of a part. */
struct ElementData
{
  std::vector<double> weights;
  Targets targets;
};
/** Sets the weights of the options' objectives, in the same way for any part of the mesh. */
using SetElements = std::function<void(const Mesh&, ElementData&, OptimizeOptions&)>;

enum class Constraint
{
  FixedBoundary,
  Sliding,
  Limits,
  Untangle /**< untangle() */
};

inline void untangleInto(
  DistributedMesh& mesh, const std::vector<unsigned char>& fixed, Found& result)
{
  UntangleOptions options;
  options.fixed = fixed.data();
  const UntangleResult untangled = untangle(Mesh(mesh.view()), options, Ranks(mesh));
  result.points = untangled.points;
  result.history = untangled.history;
  result.reason = untangled.reason;
  result.invertedBefore = untangled.invertedBefore;
  result.invertedAfter = untangled.invertedAfter;
  result.remaining = untangled.remaining.size();
  Index obstacles = 0; // of the cells of this rank
  for (Index cell = 0; cell < mesh.view().numberOfCells; ++cell)
  {
    obstacles += mesh.ownedCells()[cell] && untangled.obstacles[cell] != 0;
  }
  TAUTLINE_CHECK_EQUAL(mesh.group().sum(obstacles), static_cast<Index>(result.remaining));
}

inline Run runOn(const MeshData& whole, Cut cut, int ranks, const OptimizeOptions& given,
  Constraint constraint = Constraint::FixedBoundary, double limit = 0,
  const SetElements& set = nullptr)
{
  Run run = moveOnRanks<Found>(whole, cut, ranks,
    [&](DistributedMesh& mesh, Found& result)
    {
      OptimizeOptions options = given;
      std::vector<unsigned char> fixed = rankBoundary(mesh);
      BoundaryShape shape;
      ElementData elements;
      std::vector<double> limits(mesh.localPoints(), limit);
      if (constraint == Constraint::Sliding && mesh.view().numberOfCells > 0)
      {
        shape = boundaryShape(Mesh(mesh.view()), 1.0);
        fixed = shape.fixed;
        options.slidePlanes = shape.planes.data();
        options.slideLines = shape.lines.data();
      }
      if (set && mesh.view().numberOfCells > 0)
      {
        set(Mesh(mesh.view()), elements, options);
      }
      options.limits = constraint == Constraint::Limits ? limits.data() : nullptr;
      options.fixed = fixed.data();
      options.threads = 1 + mesh.group().rank() % 2;
      if (constraint == Constraint::Untangle)
      {
        untangleInto(mesh, fixed, result);
        return;
      }
      static_cast<OptimizeResult&>(result) = optimize(localMesh(mesh), options, {}, Ranks(mesh));
    });
  for (const Found& other : run.results)
  {
    const Found& first = run.result;
    TAUTLINE_CHECK(other.reason == first.reason);
    TAUTLINE_CHECK_EQUAL(other.history.size(), first.history.size());
    TAUTLINE_CHECK_EQUAL(other.history.back().objective, first.history.back().objective);
    TAUTLINE_CHECK_EQUAL(other.freeVertices, first.freeVertices);
    TAUTLINE_CHECK_EQUAL(other.invertedAfter, first.invertedAfter);
  }
  return run;
}

inline double farthest(const std::vector<double>& a, const std::vector<double>& b)
{
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    const double far = std::abs(a[i] - b[i]);
    largest = std::isnan(far) ? HUGE_VAL : std::max(largest, far);
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
