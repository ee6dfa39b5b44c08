// SPDX-License-Identifier: BSD-3-Clause
#include "ShapeRetrieval.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Core/Memory.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Core/Stopwatch.h"

#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
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
  options.method = RetrievalMethod::Outline;
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
/// The energy of outlines that cannot be placed on each other.
constexpr double FarApart = 1e6;
/// Steps of diffusion, and the share of the identity that keeps each shape its own nearest.
constexpr int DiffusionSteps = 10;
constexpr double DiffusionIdentity = 1e-3;

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
    , Outlines(shapes.size())
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
    std::vector<char> done(energies.size(), 0);
    const int threads = this->Options.match.threads;
    runChunks(
      this->Count, threads, [&](Index s) { this->named(s, [&] { this->prepare(s); }); },
      [this](double fraction) { return this->proceed(0, this->Count, fraction); });
    if (this->Stop == MatchStop::Complete)
    {
      const std::vector<char> chosen = this->shortlisted();
      this->Matches = std::count(chosen.begin(), chosen.end(), 1);
      runChunks(
        this->Count * this->Count, threads,
        [&](Index pair)
        {
          const Index s = pair / this->Count, t = pair % this->Count;
          const bool matched = chosen[pair] != 0;
          this->named(
            s, [&] { energies[pair] = s == t ? 0.0
                       : matched             ? this->energy(s, t)
                                             : -1.0; });
          done[pair] = s == t || !matched || energies[pair] >= 0.0;
        },
        [this](double fraction)
        { return this->proceed(this->Count, this->Count * this->Count, fraction); });
      // Pairs that the limit stopped may have been the last ones.
      const bool whole = std::all_of(done.begin(), done.end(), [](char each) { return each != 0; });
      this->Stop = whole || this->Stop != MatchStop::Complete ? this->Stop : MatchStop::TimeLimit;
    }
    return energies;
  }

  MatchStop stop() const { return this->Stop; }

  std::vector<Index> vertices() const
  {
    std::vector<Index> numbers;
    for (std::size_t s = 0; s < this->Sources.size(); ++s)
    {
      const PolygonMesh& mesh =
        this->outlines() ? this->Outlines[s].polygon.mesh : this->Sources[s].mesh;
      numbers.push_back(static_cast<Index>(mesh.points.size()));
    }
    return numbers;
  }

  Index matches() const { return this->Matches; }
  const std::vector<OutlineModel>& models() const { return this->Outlines; }

private:
  bool outlines() const { return this->Options.method == RetrievalMethod::Outline; }

  void prepare(Index s)
  {
    if (this->outlines())
    {
      this->Outlines[s] = prepareOutline(this->Shapes[s], this->Options.outline);
      return;
    }
    this->Sources[s] = makeShapeSource(this->Shapes[s], this->Options.spacing);
    this->Targets[s] =
      std::make_unique<ShapeTarget>(this->Shapes[s], this->Options.locations, this->Match.energy);
  }

  /// For each pair whether it is matched.
  std::vector<char> shortlisted() const
  {
    const Index n = this->Count;
    const bool all =
      !this->outlines() || this->Options.shortlist == 0 || this->Options.shortlist >= n - 1;
    std::vector<char> chosen(static_cast<std::size_t>(n * n), all ? 1 : 0);
    for (Index s = 0; s < n; ++s)
    {
      throwIfInterrupted();
      chosen[s * n + s] = 0;
      std::vector<std::pair<double, Index>> others;
      for (Index t = 0; t < n && !all; ++t)
      {
        if (t != s)
        {
          others.emplace_back(signatureDistance(this->Outlines[s], this->Outlines[t]), t);
        }
      }
      std::sort(others.begin(), others.end());
      for (Index k = 0; k < this->Options.shortlist && !all; ++k)
      {
        // In both directions, so that the distance is symmetric.
        chosen[s * n + others[k].second] = chosen[others[k].second * n + s] = 1;
      }
    }
    return chosen;
  }

  /// Negative if the comparison was stopped.
  double energy(Index s, Index t) const
  {
    if (this->outlines())
    {
      if (this->Time.reached(this->Options.match.timeLimit))
      {
        return -1.0;
      }
      OutlineMatch match;
      this->Memories.with(
        [&](const std::unique_ptr<std::pmr::memory_resource>& memory)
        {
          match = matchOutlines(
            this->Outlines[s], this->Outlines[t], this->Options.outline, memory.get());
        });
      return std::min(match.energy, FarApart);
    }
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
  std::vector<OutlineModel> Outlines;
  mutable ScratchPool<std::unique_ptr<std::pmr::memory_resource>> Memories{ outlineMemory };
  Index Matches = 0;
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

namespace
{
/// Energies of outlines, which are per vertex: both directions, in units of the complexity.
void combine(const std::vector<OutlineModel>& models, const RetrievalOptions& options,
  std::vector<double>& energies)
{
  const std::vector<double> one = energies;
  const std::size_t n = models.size();
  for (std::size_t s = 0; s < n; ++s)
  {
    for (std::size_t t = 0; t < n; ++t)
    {
      const double there = one[s * n + t], back = one[t * n + s];
      const bool known = there >= 0.0 && (back >= 0.0 || !options.symmetric);
      energies[s * n + t] = !known ? -1.0
                                   : (there + (options.symmetric ? back : 0.0)) /
          (options.complexity + (models[s].complexity + models[t].complexity));
    }
  }
}
}

std::vector<double> rerank(const std::vector<double>& distances, Index count, Index neighbours)
{
  if (count < 2 || neighbours < 1 || static_cast<Index>(distances.size()) != count * count)
  {
    throw Error("Diffusion needs the distances of 2 shapes or more, and at least 1 neighbour.");
  }
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Index k = std::min(neighbours, count - 1);
  const std::vector<Index> ranking = rankShapes(distances, count);
  const auto known = [&](Index s, Index t) { return distances[s * count + t] >= 0.0; };
  std::vector<double> scale(static_cast<std::size_t>(count), 0.0);
  for (Index s = 0; s < count; ++s)
  {
    for (Index i = 0; i < k; ++i)
    {
      const Index t = ranking[s * (count - 1) + i];
      scale[s] += known(s, t) ? distances[s * count + t] / static_cast<double>(k) : 0.0;
    }
  }
  Matrix affinity = Matrix::Identity(count, count);
  for (Index s = 0; s < count; ++s)
  {
    for (Index t = 0; t < count; ++t)
    {
      if (s != t && known(s, t))
      {
        const double unit = std::max(0.5 * (scale[s] + scale[t]), 1e-300);
        const double ratio = distances[s * count + t] / unit;
        affinity(s, t) = std::exp(-2.0 * ratio * ratio);
      }
    }
    affinity.row(s) /= affinity.row(s).sum();
  }
  // Transitions to the shape itself and its nearest neighbours only.
  std::vector<Eigen::Triplet<double>> entries;
  for (Index s = 0; s < count; ++s)
  {
    entries.emplace_back(s, s, affinity(s, s));
    for (Index i = 0; i + 1 < k; ++i)
    {
      const Index t = ranking[s * (count - 1) + i];
      entries.emplace_back(s, t, affinity(s, t));
    }
  }
  Eigen::SparseMatrix<double, Eigen::RowMajor> local(count, count);
  local.setFromTriplets(entries.begin(), entries.end());
  for (int step = 0; step < DiffusionSteps; ++step)
  {
    throwIfInterrupted();
    const Matrix half = local * affinity;
    affinity = (local * half.transpose()).transpose();
    affinity.diagonal().array() += DiffusionIdentity;
  }
  const double largest = affinity.maxCoeff();
  std::vector<double> result(distances.size(), 0.0);
  for (Index s = 0; s < count; ++s)
  {
    for (Index t = 0; t < count; ++t)
    {
      result[s * count + t] = s == t ? 0.0 : 1.0 - affinity(s, t) / largest;
    }
  }
  return result;
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
  if (!(options.complexity > 0.0) || !std::isfinite(options.complexity) || options.shortlist < 0 ||
    options.neighbours < 0)
  {
    throw Error("The complexity must be above 0, shortlist and neighbours at least 0.");
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
  result.matches = comparison.matches();
  if (options.method == RetrievalMethod::Outline)
  {
    combine(comparison.models(), options, result.distances);
  }
  else if (options.symmetric)
  {
    result.distances = symmetrized(result.distances, result.vertices);
  }
  if (options.neighbours > 0 && result.stop == MatchStop::Complete)
  {
    result.distances = rerank(result.distances, count, options.neighbours);
  }
  result.ranking = rankShapes(result.distances, count);
  result.recognition = recognize(result.ranking, labels, options.best);
  return result;
}
}
