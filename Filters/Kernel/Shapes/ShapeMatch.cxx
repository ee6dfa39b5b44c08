// SPDX-License-Identifier: BSD-3-Clause
#include "ShapeMatch.h"

#include "PlaneDistance.h"
#include "ShapeDynamicProgram.h"
#include "ShapeEnergy.h"
#include "tautline/Core/Interruption.h"
#include "tautline/Core/Memory.h"
#include "tautline/Core/Stopwatch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace tautline
{
namespace
{
constexpr double MemoryLimit = 4.0 * 1024 * 1024 * 1024;
/// Targets with fewer locations need no first solution on a subset.
constexpr std::size_t SmallTarget = 30;
/// A first solution on more locations than this can also be stopped.
constexpr std::size_t LargeCoarse = 200;
/// Coarse to fine: the number of locations around a vertex along each axis, and of halvings of
/// their distance.
constexpr int RefineRadius = 3;
constexpr int RefineLevels = 3;
/// A first solution on a contour is improved by moves of up to this many locations either way, in
/// this many sweeps.
constexpr Index LocalReach = 3;
constexpr int LocalPasses = 2;

void check(const MatchOptions& options)
{
  const ShapeEnergy& e = options.energy;
  const std::pair<double, const char*> numbers[] = { { e.lambda, "edge constant lambda" },
    { e.deformation, "deformation weight a" }, { e.distortion, "distortion weight b" },
    { e.rotation, "rotation weight" }, { e.descriptor, "descriptor weight" },
    { e.ordering, "ordering weight" }, { options.centreTolerance, "center tolerance" },
    { options.timeLimit, "time limit" } };
  for (const auto& [value, name] : numbers)
  {
    if (!(value >= 0.0) || !std::isfinite(value))
    {
      throw Error(std::string("The ") + name + " must be at least 0 and finite.");
    }
  }
  if (options.maxSolutions < 1 || options.rotations < 1 || options.scales < 1 ||
    options.rotations > 360 || options.scales > 31 || options.scales % 2 == 0)
  {
    throw Error("At least 1 solution, 1 to 360 rotations and an odd number of scales from 1 to 31 "
                "are needed.");
  }
}

double orderingCost(double from, double to, double expected)
{
  // Positions along the contour are fractions of its length, so that advances wrap around at 1.
  double advance = to - from;
  advance -= std::floor(advance);
  // A step of length 0 is treated as a hundredth of the expected one.
  return std::abs(std::log(std::max(advance, 0.01 * expected) / expected));
}

/// Costs of one boundary edge with the ordering term, over locations on the contour.
/// @param arc of the locations
/// @param expected advance along the contour
PairTable orderedEdges(
  const PairTable& edges, const std::vector<double>& arc, double expected, double weight)
{
  PairTable table = edges;
  for (std::size_t i = 0; i < arc.size(); ++i)
  {
    throwIfInterrupted();
    for (std::size_t j = 0; j < arc.size(); ++j)
    {
      table.row(static_cast<Index>(i))[j] +=
        static_cast<float>(weight * orderingCost(arc[i], arc[j], expected));
    }
  }
  return table;
}

double squaredDifference(const Descriptor& a, const Descriptor& b)
{
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k)
  {
    sum += (a[k] - b[k]) * (a[k] - b[k]);
  }
  return sum;
}

double expectedAdvance(const ShapeSource& source, std::size_t vertex)
{
  const double from = source.arc[vertex], to = source.arc[(vertex + 1) % source.arc.size()];
  return std::max(1e-3, to - from - std::floor(to - from));
}

/// A match of one source against one target, with one orientation and size.
class Matcher
{
public:
  Matcher(const ShapeSource& source, const ShapeTarget& target, const MatchOptions& options,
    double delta, const std::function<bool(double)>& progress)
    : Source(source)
    , Target(target.data())
    , Options(options)
    , Delta(delta)
    , Progress(progress)
  {
  }

  ShapeMatch run()
  {
    // A first solution over fewer locations bounds the energy, and is the result if the search is
    // stopped.
    const bool hasCoarse =
      this->Target.locations.points.size() >= SmallTarget && this->Target.coarse.points.size() >= 3;
    ShapeMatch first;
    bool haveFirst = false;
    if (hasCoarse && (this->Options.bounds || this->Options.coarseToFine || this->Progress))
    {
      PlacementProblem problem = this->coarseProblem();
      if (this->Progress && this->Target.coarse.points.size() > LargeCoarse)
      {
        problem.progress = [this](double) { return this->Progress(0.0); };
      }
      PlacementSolver solver(problem);
      if (!solver.run())
      {
        return this->stopped(first, false);
      }
      first = this->choose(problem, solver, this->Options.coarseToFine);
      haveFirst = true;
    }
    if (this->Options.coarseToFine && haveFirst)
    {
      return this->refine(first);
    }
    PlacementProblem problem = this->fullProblem();
    const double needed = PlacementSolver::memory(problem);
    if (needed > MemoryLimit)
    {
      throw Error("The tables of an exact search over " +
        std::to_string(this->Target.locations.points.size()) +
        " locations would take more than 4 GiB: use fewer locations, or coarse to fine.");
    }
    requireMemory(needed, "An exact search", "use fewer locations, or coarse to fine.");
    if (haveFirst && this->Options.bounds)
    {
      // The coarse locations are some of the full ones: the best is no worse.
      const double energy =
        this->Target.arc.empty() ? first.energy : this->improved(problem, first.points);
      // The margin covers the rounding of tables in single precision.
      problem.limit = static_cast<float>(energy * (1.0 + 1e-4) + 1e-4);
    }
    problem.progress = this->Progress;
    ShapeMatch match;
    {
      PlacementSolver solver(problem);
      if (!solver.run())
      {
        return this->stopped(first, haveFirst);
      }
      match = this->choose(problem, solver, problem.limit >= Unreachable);
    }
    if (this->Options.centreTolerance > 0.0 && !match.centreAccepted && problem.limit < Unreachable)
    {
      // The next best solutions are needed, which the limit may have excluded.
      problem.limit = Unreachable;
      PlacementSolver solver(problem);
      if (!solver.run())
      {
        return this->stopped(match, true);
      }
      match = this->choose(problem, solver, true);
    }
    return match;
  }

private:
  PlacementProblem emptyProblem() const
  {
    PlacementProblem problem;
    problem.mesh = &this->Source.mesh;
    problem.energy = this->Options.energy;
    problem.delta = this->Delta;
    problem.bounds = this->Options.bounds;
    problem.threads = this->Options.threads;
    problem.vertices.resize(this->Source.mesh.points.size());
    return problem;
  }

  bool ordered() const
  {
    return this->Options.energy.ordering > 0.0 && !this->Target.arc.empty() &&
      !this->Source.arc.empty();
  }

  bool described() const
  {
    return this->Options.energy.descriptor > 0.0 && !this->Target.descriptors.empty() &&
      !this->Source.descriptors.empty();
  }

  /// The cost of a vertex at each location, over the slots of a subset of the locations.
  std::vector<float> vertexCosts(
    std::size_t vertex, const LocationSet& set, const std::vector<Index>& of) const
  {
    std::vector<float> costs(static_cast<std::size_t>(set.size()), 0.0f);
    for (std::size_t l = 0; l < set.points.size(); ++l)
    {
      const std::size_t location = of.empty() ? l : static_cast<std::size_t>(of[l]);
      costs[set.slots[l]] = static_cast<float>(this->Options.energy.descriptor *
        squaredDifference(this->Source.descriptors[vertex], this->Target.descriptors[location]));
    }
    return costs;
  }

  PlacementProblem fullProblem()
  {
    return this->problemOver(this->Target.locations, this->Target.edges, {}, this->EdgeTables);
  }

  PlacementProblem coarseProblem()
  {
    return this->problemOver(
      this->Target.coarse, this->Target.coarseEdges, this->Target.coarseOf, this->CoarseTables);
  }

  /// The problem over a set of locations.
  /// @param of the location of each member of the set; empty: the set has all locations
  /// @param tables keep the edge costs with the ordering term
  PlacementProblem problemOver(const LocationSet& set, const PairTable& edges,
    const std::vector<Index>& of, std::vector<PairTable>& tables) const
  {
    PlacementProblem problem = this->emptyProblem();
    const std::size_t n = this->Source.mesh.points.size();
    problem.sets.assign(n, &set);
    problem.edges.assign(n, &edges);
    problem.symmetricEdges = !this->Target.energy.directedEdges && !this->ordered();
    if (this->ordered())
    {
      std::vector<double> arc = this->Target.arc;
      for (std::size_t i = 0; i < of.size(); ++i)
      {
        arc[i] = this->Target.arc[of[i]];
      }
      arc.resize(of.empty() ? arc.size() : of.size());
      tables.reserve(n);
      for (std::size_t v = 0; v < n; ++v)
      {
        tables.push_back(orderedEdges(
          edges, arc, expectedAdvance(this->Source, v), this->Options.energy.ordering));
        problem.edges[v] = &tables.back();
      }
    }
    for (std::size_t v = 0; v < n && this->described(); ++v)
    {
      problem.vertices[v] = this->vertexCosts(v, set, of);
    }
    return problem;
  }

  /// The energy of a placement on the contour after moves of each vertex by a few locations.
  double improved(const PlacementProblem& full, const std::vector<Vec2>& points) const
  {
    const Index count = static_cast<Index>(this->Target.locations.points.size());
    const std::size_t n = points.size();
    // Location numbers of the points.
    std::vector<Index> at;
    for (const Vec2& p : points)
    {
      const auto& all = this->Target.locations.points;
      at.push_back(std::find(all.begin(), all.end(), p) - all.begin());
    }
    double energy = 0.0;
    // Each pass solves the problem exactly on the few locations around each vertex, which include
    // the current one: the energy cannot increase.
    for (int pass = 0; pass < LocalPasses; ++pass)
    {
      PlacementProblem problem = this->emptyProblem();
      problem.symmetricEdges = false;
      std::vector<LocationSet> sets;
      std::vector<std::vector<Index>> of(n);
      std::vector<PairTable> tables;
      for (std::size_t v = 0; v < n; ++v)
      {
        std::vector<Vec2> around;
        for (Index k = -LocalReach; k <= LocalReach; ++k)
        {
          of[v].push_back((at[v] + k + count) % count);
          around.push_back(this->Target.locations.points[of[v].back()]);
        }
        sets.push_back(LocationSet::list(around));
      }
      for (std::size_t v = 0; v < n; ++v)
      {
        const std::size_t next = (v + 1) % n;
        // Use the costs of the full problem.
        PairTable table(sets[v].size(), sets[next].size(), Unreachable);
        for (std::size_t i = 0; i < of[v].size(); ++i)
        {
          for (std::size_t j = 0; j < of[next].size(); ++j)
          {
            table.row(static_cast<Index>(i))[j] = full.edges[v]->row(of[v][i])[of[next][j]];
          }
          if (!full.vertices[v].empty())
          {
            problem.vertices[v].resize(static_cast<std::size_t>(sets[v].size()), 0.0f);
            problem.vertices[v][i] = full.vertices[v][of[v][i]];
          }
        }
        tables.push_back(std::move(table));
      }
      for (std::size_t v = 0; v < n; ++v)
      {
        problem.sets.push_back(&sets[v]);
        problem.edges.push_back(&tables[v]);
      }
      PlacementSolver solver(problem);
      solver.run();
      const auto [value, p, q] = best(problem, solver);
      energy = value;
      const std::vector<Index> slots = solver.trace(p, q);
      for (std::size_t v = 0; v < n; ++v)
      {
        at[v] = of[v][slots[v]];
      }
    }
    return energy;
  }

  struct Solution
  {
    float value;
    Index p, q;
    bool operator<(const Solution& other) const
    {
      return std::tie(this->value, this->p, this->q) < std::tie(other.value, other.p, other.q);
    }
  };

  Solution best(const PlacementProblem& problem, const PlacementSolver& solver) const
  {
    const EliminationStep& last = this->Source.mesh.elimination.back();
    Solution least = { 4.0f * Unreachable, 0, 0 };
    for (Index p : problem.sets[last.parents[0]]->used)
    {
      for (Index q : problem.sets[last.parents[1]]->used)
      {
        least = std::min(least, Solution{ solver.values().row(p)[q], p, q });
      }
    }
    return least;
  }

  Vec2 meanOf(const std::vector<Vec2>& points) const
  {
    Vec2 mean = {};
    for (const Vec2& p : points)
    {
      mean[0] += p[0] / static_cast<double>(points.size());
      mean[1] += p[1] / static_cast<double>(points.size());
    }
    return mean;
  }

  std::vector<Vec2> pointsOf(const PlacementProblem& problem, const std::vector<Index>& slots) const
  {
    std::vector<Vec2> points;
    for (std::size_t v = 0; v < slots.size(); ++v)
    {
      const LocationSet& set = *problem.sets[v];
      points.push_back(set.points[set.locationOf(slots[v])]);
    }
    return points;
  }

  /// The first solution, in order of energy, whose center is near the center of mass of the target.
  ShapeMatch choose(
    const PlacementProblem& problem, const PlacementSolver& solver, bool nextBest) const
  {
    const PairTable& values = solver.values();
    const EliminationStep& last = this->Source.mesh.elimination.back();
    const LocationSet &si = *problem.sets[last.parents[0]], &sj = *problem.sets[last.parents[1]];
    const Solution best = this->best(problem, solver);
    const double tolerance = this->Options.centreTolerance * this->Target.maxDistance;
    const auto take = [&](const Solution& s)
    { return this->pointsOf(problem, solver.trace(s.p, s.q)); };
    std::vector<Vec2> points = take(best);
    Index rank = 1;
    double d = distance(this->meanOf(points), this->Target.centre);
    bool accepted = this->Options.centreTolerance == 0.0 || d <= tolerance;
    if (!accepted && nextBest)
    {
      // The solutions over all locations of the last two vertices, in order of their energies.
      std::vector<Solution> solutions;
      for (Index p : si.used)
      {
        for (Index q : sj.used)
        {
          if (values.row(p)[q] < Unreachable)
          {
            solutions.push_back({ values.row(p)[q], p, q });
          }
        }
      }
      const std::size_t count =
        std::min(solutions.size(), static_cast<std::size_t>(this->Options.maxSolutions));
      std::partial_sort(
        solutions.begin(), solutions.begin() + static_cast<std::ptrdiff_t>(count), solutions.end());
      for (std::size_t s = 1; s < count && !accepted; ++s)
      {
        throwIfInterrupted();
        std::vector<Vec2> next = take(solutions[s]);
        const double nextD = distance(this->meanOf(next), this->Target.centre);
        accepted = nextD <= tolerance;
        if (nextD < d)
        {
          d = nextD;
          rank = static_cast<Index>(s) + 1;
          points.swap(next);
        }
      }
    }
    // The tables are in single precision, so the energy of the selected placement is recomputed in
    // double precision.
    ShapeMatch match = this->evaluate(points);
    match.rank = rank;
    match.centreAccepted = accepted;
    return match;
  }

  ShapeMatch evaluate(const std::vector<Vec2>& points) const
  {
    const ShapeEnergy& energy = this->Options.energy;
    const PolygonMesh& mesh = this->Source.mesh;
    ShapeMatch match;
    match.points = points;
    const std::size_t n = points.size();
    for (const auto& t : mesh.triangles)
    {
      TriangleEnergy terms =
        triangleEnergy({ mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]] },
          { points[t[0]], points[t[1]], points[t[2]] }, this->Delta, energy);
      for (int c = 0; c < 3; ++c)
      {
        const std::size_t a = static_cast<std::size_t>(t[c]),
                          b = static_cast<std::size_t>(t[(c + 1) % 3]);
        // Boundary edges join consecutive vertices, and counterclockwise triangles have each of
        // them in this direction only.
        if ((a + 1) % n == b)
        {
          terms.edge += this->Target.edgeCost(points[a], points[b]);
        }
      }
      match.edge += terms.edge;
      match.deformation += terms.deformation;
      match.distortion += terms.distortion;
      match.rotation += terms.rotation;
      match.triangles.push_back(terms);
    }
    if (this->ordered() || this->described())
    {
      this->addLocationTerms(match);
    }
    match.energy = match.edge + energy.deformation * match.deformation +
      energy.distortion * match.distortion + energy.rotation * match.rotation +
      energy.descriptor * match.descriptor + energy.ordering * match.ordering;
    match.centreDistance = distance(this->meanOf(points), this->Target.centre);
    return match;
  }

  void addLocationTerms(ShapeMatch& match) const
  {
    std::vector<std::size_t> at;
    for (const Vec2& p : match.points)
    {
      const std::vector<Vec2>& all = this->Target.locations.points;
      at.push_back(static_cast<std::size_t>(
        std::min_element(all.begin(), all.end(),
          [&](const Vec2& a, const Vec2& b) { return distance(a, p) < distance(b, p); }) -
        all.begin()));
    }
    for (std::size_t v = 0; v < at.size(); ++v)
    {
      if (this->described())
      {
        match.descriptor +=
          squaredDifference(this->Source.descriptors[v], this->Target.descriptors[at[v]]);
      }
      if (this->ordered())
      {
        match.ordering += orderingCost(this->Target.arc[at[v]],
          this->Target.arc[at[(v + 1) % at.size()]], expectedAdvance(this->Source, v));
      }
    }
  }

  /// Refines a solution with increasingly fine locations around each vertex.
  ShapeMatch refine(ShapeMatch match)
  {
    Vec2 step = this->Target.gridStep;
    for (int level = 0; level < RefineLevels; ++level)
    {
      PlacementProblem problem = this->emptyProblem();
      const std::size_t n = match.points.size();
      std::vector<LocationSet> sets;
      std::vector<PairTable> tables;
      sets.reserve(n);
      tables.reserve(n);
      for (const Vec2& centre : match.points)
      {
        std::vector<Vec2> around(1, centre); // first, so that it wins ties
        for (int j = -RefineRadius; j <= RefineRadius; ++j)
        {
          for (int i = -RefineRadius; i <= RefineRadius; ++i)
          {
            if (i || j)
            {
              around.push_back({ centre[0] + i * step[0], centre[1] + j * step[1] });
            }
          }
        }
        sets.push_back(LocationSet::list(around));
      }
      for (std::size_t v = 0; v < n; ++v)
      {
        problem.sets.push_back(&sets[v]);
        tables.push_back(this->Target.edgeTable(sets[v], sets[(v + 1) % n]));
        problem.edges.push_back(&tables[v]);
      }
      // The current placement is among the candidates, so its energy is a valid limit.
      problem.limit = static_cast<float>(match.energy * (1.0 + 1e-4) + 1e-4);
      // Refined locations have no descriptors and no position on the contour.
      problem.energy.ordering = problem.energy.descriptor = 0.0;
      if (this->Progress)
      {
        problem.progress = [this, level](double done)
        { return this->Progress((level + done) / RefineLevels); };
      }
      PlacementSolver solver(problem);
      if (!solver.run())
      {
        return this->stopped(match, true);
      }
      const Index rank = match.rank;
      ShapeMatch next = this->choose(problem, solver, false);
      // A lower energy does not justify losing an accepted center.
      if (next.energy < match.energy && (next.centreAccepted || !match.centreAccepted))
      {
        match = next;
        match.rank = rank;
      }
      step = { 0.5 * step[0], 0.5 * step[1] };
    }
    match.exact = false;
    return match;
  }

  ShapeMatch stopped(ShapeMatch match, bool haveMatch) const
  {
    if (!haveMatch)
    {
      // Nothing was found yet: use the source itself, moved and scaled to the center and size of
      // the target.
      std::vector<Vec2> points;
      for (const Vec2& p : this->Source.mesh.points)
      {
        points.push_back({ this->Target.centre[0] + (p[0] - this->Source.centre[0]) / this->Delta,
          this->Target.centre[1] + (p[1] - this->Source.centre[1]) / this->Delta });
      }
      match = this->evaluate(points);
    }
    match.exact = false;
    match.stop = MatchStop::Stopped;
    return match;
  }

  const ShapeSource& Source;
  const ShapeTarget::Data& Target;
  const MatchOptions& Options;
  double Delta;
  const std::function<bool(double)>& Progress;
  std::vector<PairTable> EdgeTables, CoarseTables;

  friend ShapeMatch tautline::evaluatePlacement(
    const ShapeSource&, const ShapeTarget&, const ShapeEnergy&, const std::vector<Vec2>&);
};

void checkPrepared(
  const ShapeSource& source, const ShapeTarget& target, const MatchOptions& options)
{
  if (source.mesh.triangles.empty() || !(source.maxDistance > 0.0))
  {
    throw Error("The source has no triangles: make it with makeShapeSource().");
  }
  const ShapeEnergy &e = options.energy, &made = target.data().energy;
  if (e.lambda != made.lambda || e.smoothing != made.smoothing ||
    e.directedEdges != made.directedEdges || (e.descriptor > 0.0 && made.descriptor == 0.0))
  {
    throw Error("The target was prepared with a different lambda, smoothing or kind of edges, "
                "or without descriptors.");
  }
}
}

//------------------------------------------------------------------------------
ShapeMatch matchShape(
  const ShapeSource& source, const ShapeTarget& target, const MatchOptions& options)
{
  check(options);
  checkPrepared(source, target, options);
  const Stopwatch time;
  // delta makes the distortion cost invariant to uniform scaling (dissertation, Section 5.2.3).
  const double delta = source.maxDistance / target.maxDistance();
  const Index mirrors = options.energy.reflection == Reflection::Whole ? 2 : 1;
  const double runs = static_cast<double>(mirrors * options.rotations * options.scales);
  MatchStop stop = MatchStop::Complete;
  double done = 0.0;
  std::function<bool(double)> progress;
  if (options.progress || options.timeLimit > 0.0)
  {
    progress = [&](double fraction)
    {
      if (stop == MatchStop::Complete && options.progress &&
        !options.progress((done + fraction) / runs))
      {
        stop = MatchStop::Stopped;
      }
      if (stop == MatchStop::Complete && time.reached(options.timeLimit))
      {
        stop = MatchStop::TimeLimit;
      }
      return stop == MatchStop::Complete;
    };
  }
  ShapeMatch best;
  bool found = false;
  const auto over = [&] { return found && stop != MatchStop::Complete; };
  for (Index mirror = 0; mirror < mirrors && !over(); ++mirror)
  {
    for (Index rotation = 0; rotation < options.rotations && !over(); ++rotation)
    {
      const double angle =
        2.0 * Pi * static_cast<double>(rotation) / static_cast<double>(options.rotations);
      const ShapeSource* shape = &source;
      ShapeSource other;
      if (mirror || rotation)
      {
        other = transformSource(source, angle, mirror == 1);
        shape = &other;
      }
      for (Index scale = 0; scale < options.scales && !over(); ++scale)
      {
        // Sizes differ by factors of sqrt(2); the middle one is 1.
        const double factor = std::pow(2.0, 0.5 * static_cast<double>(scale - options.scales / 2));
        ShapeMatch match = Matcher(*shape, target, options, delta / factor, progress).run();
        match.mirrored = mirror == 1;
        match.angle = angle * 180.0 / Pi;
        match.scale = factor;
        if (mirror)
        {
          // Restore the order of the source vertices and triangles.
          std::reverse(match.points.begin(), match.points.end());
        }
        // An accepted center takes precedence over a lower energy.
        const bool better = !found ||
          (match.centreAccepted != best.centreAccepted ? match.centreAccepted
                                                       : match.energy < best.energy);
        if (better)
        {
          best = std::move(match);
        }
        found = true;
        done += 1.0;
      }
    }
  }
  best.stop = stop;
  best.exact = best.exact && stop == MatchStop::Complete;
  return best;
}

ShapeMatch evaluatePlacement(const ShapeSource& source, const ShapeTarget& target,
  const ShapeEnergy& energy, const std::vector<Vec2>& points)
{
  if (points.size() != source.mesh.points.size())
  {
    throw Error("A placement needs a point per vertex of the source.");
  }
  MatchOptions options;
  options.energy = energy;
  check(options);
  const std::function<bool(double)> none;
  return Matcher(source, target, options, source.maxDistance / target.maxDistance(), none)
    .evaluate(points);
}
}
