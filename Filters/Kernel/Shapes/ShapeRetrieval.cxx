#include "ShapeRetrieval.h"

#include "tautline/Core/Memory.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Core/Stopwatch.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace tautline
{
RetrievalOptions RetrievalOptions::felzenszwalb()
{
  RetrievalOptions options;
  options.match.energy = ShapeEnergy::felzenszwalb();
  options.match.centreTolerance = 0.0;
  return options;
}

RetrievalOptions RetrievalOptions::highest()
{
  RetrievalOptions options;
  options.spacing = 15.0;
  options.locations.kind = Locations::Contour;
  options.locations.contour = 80;
  options.match.energy.directedEdges = true;
  options.match.energy.ordering = 1.0;
  options.match.energy.descriptor = 100.0;
  options.match.energy.rotation = 1.0;
  options.match.centreTolerance = 0.0;
  options.symmetric = true;
  return options;
}

std::vector<Index> rankShapes(const std::vector<double>& distances, Index count)
{
  std::vector<Index> ranking;
  for (Index query = 0; query < count; ++query)
  {
    const double* row = distances.data() + query * count;
    std::vector<Index> others;
    for (Index target = 0; target < count; ++target)
    {
      if (target != query)
      {
        others.push_back(target);
      }
    }
    // By distance; shapes without one, negative, come last.
    std::stable_sort(others.begin(), others.end(),
      [row](Index a, Index b)
      { return row[b] < 0.0 ? row[a] >= 0.0 : row[a] >= 0.0 && row[a] < row[b]; });
    ranking.insert(ranking.end(), others.begin(), others.end());
  }
  return ranking;
}

Recognition recognize(
  const std::vector<Index>& ranking, const std::vector<Index>& labels, Index best)
{
  Recognition result;
  const Index count = static_cast<Index>(labels.size());
  std::map<Index, Index> sizes;
  for (Index label : labels)
  {
    ++sizes[label];
  }
  std::map<Index, std::size_t> position;
  for (const auto& [label, size] : sizes)
  {
    position[label] = result.classes.size();
    result.classes.push_back(label);
  }
  const std::size_t classes = result.classes.size();
  const Index taken = std::min(best, count - 1);
  result.confusion.assign(classes * classes, 0.0);
  result.hitsAt.assign(static_cast<std::size_t>(taken), 0);
  for (Index query = 0; query < count; ++query)
  {
    const Index label = labels[query], size = sizes[label];
    result.possible += std::min(best, size - 1);
    for (Index k = 0; k < taken; ++k)
    {
      const Index other = labels[ranking[query * (count - 1) + k]];
      result.hits += other == label;
      result.hitsAt[k] += other == label;
      // The rows of the confusion matrix sum to 1.
      result.confusion[position[label] * classes + position[other]] +=
        1.0 / static_cast<double>(size * taken);
    }
  }
  result.rate = result.possible > 0
    ? static_cast<double>(result.hits) / static_cast<double>(result.possible)
    : 0.0;
  return result;
}

//------------------------------------------------------------------------------
namespace
{
/// Compares each shape with each other one, on several threads.
class Comparison
{
public:
  Comparison(const std::vector<Silhouette>& shapes, const RetrievalOptions& options)
    : Shapes(shapes)
    , Options(options)
    , Match(options.match)
    , Count(static_cast<Index>(shapes.size()))
    , Work(Count + Count * Count)
    , Sources(shapes.size())
    , Targets(shapes.size())
  {
    this->Match.threads = 1;
    this->Match.timeLimit = 0;
    // The limit also ends a comparison that is under way.
    this->Match.progress = nullptr;
    if (options.match.timeLimit > 0.0)
    {
      this->Match.progress = [this](double)
      { return !this->Time.reached(this->Options.match.timeLimit); };
    }
  }

  /// Energies of all pairs, row by source; negative where the comparison was stopped before.
  std::vector<double> run()
  {
    std::vector<double> energies(static_cast<std::size_t>(this->Count * this->Count), -1.0);
    const int threads = this->Options.match.threads;
    runChunks(
      this->Count, threads, [&](Index s) { this->named(s, [&] { this->prepare(s); }); },
      [this](double fraction) { return this->proceed(0, this->Count, fraction); });
    if (this->Stop == MatchStop::Complete)
    {
      runChunks(
        this->Count * this->Count, threads,
        [&](Index pair)
        {
          const Index s = pair / this->Count, t = pair % this->Count;
          this->named(s, [&] { energies[pair] = s == t ? 0.0 : this->energy(s, t); });
        },
        [this](double fraction)
        { return this->proceed(this->Count, this->Count * this->Count, fraction); });
      // Pairs that the limit stopped may have been the last ones.
      const bool whole =
        std::none_of(energies.begin(), energies.end(), [](double energy) { return energy < 0.0; });
      this->Stop = whole || this->Stop != MatchStop::Complete ? this->Stop : MatchStop::TimeLimit;
    }
    return energies;
  }

  MatchStop stop() const { return this->Stop; }

  std::vector<Index> vertices() const
  {
    std::vector<Index> numbers;
    for (const ShapeSource& source : this->Sources)
    {
      numbers.push_back(static_cast<Index>(source.mesh.points.size()));
    }
    return numbers;
  }

private:
  void prepare(Index s)
  {
    this->Sources[s] = makeShapeSource(this->Shapes[s], this->Options.spacing);
    this->Targets[s] =
      std::make_unique<ShapeTarget>(this->Shapes[s], this->Options.locations, this->Match.energy);
  }

  /// Negative if the comparison was stopped.
  double energy(Index s, Index t) const
  {
    const ShapeMatch match = matchShape(this->Sources[s], *this->Targets[t], this->Match);
    return match.stop == MatchStop::Complete ? match.energy : -1.0;
  }

  /// Checks the limits and reports, when `before` and a fraction of `now` items are done.
  bool proceed(Index before, Index now, double fraction)
  {
    const MatchOptions& match = this->Options.match;
    const double done = static_cast<double>(before) + fraction * static_cast<double>(now);
    if (this->Time.reached(match.timeLimit))
    {
      this->Stop = MatchStop::TimeLimit;
    }
    else if (match.progress && !match.progress(done / static_cast<double>(this->Work)))
    {
      this->Stop = MatchStop::Stopped;
    }
    return this->Stop == MatchStop::Complete;
  }

  /// Adds the number of the shape to the message of an error.
  template <class Action>
  static void named(Index shape, const Action& action)
  {
    try
    {
      action();
    }
    catch (const tautline::Error& caught)
    {
      throw tautline::Error("Shape " + std::to_string(shape) + ": " + caught.what());
    }
  }

  const std::vector<Silhouette>& Shapes;
  const RetrievalOptions& Options;
  MatchOptions Match; ///< of a single pair: on one thread, without limits
  Index Count;
  Index Work; ///< items: the shapes and the pairs
  std::vector<ShapeSource> Sources;
  std::vector<std::unique_ptr<ShapeTarget>> Targets;
  Stopwatch Time;
  MatchStop Stop = MatchStop::Complete;
};

/// The symmetric distance: the sum of both energies, each divided by the number of triangles.
std::vector<double> symmetrized(
  const std::vector<double>& energies, const std::vector<Index>& vertices)
{
  const Index count = static_cast<Index>(vertices.size());
  std::vector<double> both(energies.size(), -1.0);
  for (Index s = 0; s < count; ++s)
  {
    for (Index t = 0; t < count; ++t)
    {
      const double there = energies[s * count + t], back = energies[t * count + s];
      if (there >= 0.0 && back >= 0.0)
      {
        both[s * count + t] = there / static_cast<double>(vertices[s] - 2) +
          back / static_cast<double>(vertices[t] - 2);
      }
    }
  }
  return both;
}
}

Retrieval retrieveShapes(const std::vector<Silhouette>& shapes, const std::vector<Index>& labels,
  const RetrievalOptions& options)
{
  const Index count = static_cast<Index>(shapes.size());
  if (count < 2)
  {
    throw Error("At least 2 shapes are needed to compare.");
  }
  if (static_cast<Index>(labels.size()) != count || options.best < 1)
  {
    throw Error("A label per shape and at least 1 best match are needed.");
  }
  // Distances in both directions, their sums, and the ranking.
  constexpr double bytesPerPair = 3 * sizeof(double) + sizeof(Index);
  requireMemory(bytesPerPair * static_cast<double>(count) * static_cast<double>(count),
    "The table of all pairs of " + std::to_string(count) + " shapes", "use fewer shapes.");
  Retrieval result;
  result.count = count;
  Comparison comparison(shapes, options);
  result.distances = comparison.run();
  result.stop = comparison.stop();
  result.vertices = comparison.vertices();
  if (options.symmetric)
  {
    result.distances = symmetrized(result.distances, result.vertices);
  }
  result.ranking = rankShapes(result.distances, count);
  result.recognition = recognize(result.ranking, labels, options.best);
  return result;
}
}
