#include "ShapeRetrieval.h"

#include "tautline/Core/Parallel.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
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
      result.confusion[position[label] * classes + position[other]] +=
        1.0 / static_cast<double>(size * taken);
    }
  }
  result.rate = result.possible > 0
    ? static_cast<double>(result.hits) / static_cast<double>(result.possible)
    : 0.0;
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
  const auto start = std::chrono::steady_clock::now();
  Retrieval result;
  result.count = count;
  result.distances.assign(static_cast<std::size_t>(count * count), -1.0);
  std::vector<ShapeSource> sources(shapes.size());
  std::vector<std::unique_ptr<ShapeTarget>> targets(shapes.size());
  MatchOptions match = options.match;
  match.threads = 1;
  match.timeLimit = 0;
  match.progress = nullptr;
  std::atomic<int> stop{ static_cast<int>(MatchStop::Complete) };
  std::exception_ptr error;
  std::atomic<Index> done{ 0 };
  const Index work = count + count * count;
  const auto report = [&]
  {
    // Only the first thread calls back; the others look at the flag.
    if (omp_get_thread_num() != 0)
    {
      return;
    }
    const std::chrono::duration<double> used = std::chrono::steady_clock::now() - start;
    if (options.match.timeLimit > 0.0 && used.count() > options.match.timeLimit)
    {
      stop = static_cast<int>(MatchStop::TimeLimit);
    }
    else if (options.match.progress &&
      !options.match.progress(static_cast<double>(done) / static_cast<double>(work)))
    {
      stop = static_cast<int>(MatchStop::Stopped);
    }
  };
  // Errors must not leave the threads: the one of the first shape is kept.
  Index errorAt = work;
  const auto guarded = [&](Index at, const auto& action)
  {
    try
    {
      action();
    }
    catch (const Error& caught)
    {
#pragma omp critical(TautlineRetrieval)
      if (at < errorAt)
      {
        errorAt = at;
        error = std::make_exception_ptr(
          Error("Shape " + std::to_string(at % count) + ": " + caught.what()));
      }
      stop = static_cast<int>(MatchStop::Stopped);
    }
    catch (...)
    {
#pragma omp critical(TautlineRetrieval)
      if (at < errorAt)
      {
        errorAt = at;
        error = std::current_exception();
      }
      stop = static_cast<int>(MatchStop::Stopped);
    }
    ++done;
  };
#pragma omp parallel num_threads(resolveThreads(options.match.threads))
  {
#pragma omp for schedule(dynamic, 1)
    for (Index s = 0; s < count; ++s)
    {
      guarded(s,
        [&]
        {
          sources[s] = makeShapeSource(shapes[s], options.spacing);
          targets[s] = std::make_unique<ShapeTarget>(shapes[s], options.locations, match.energy);
        });
    }
#pragma omp for schedule(dynamic, 4)
    for (Index pair = 0; pair < count * count; ++pair)
    {
      if (stop != static_cast<int>(MatchStop::Complete))
      {
        continue;
      }
      const Index s = pair / count, t = pair % count;
      guarded(count + s,
        [&] {
          result.distances[pair] = s == t ? 0.0 : matchShape(sources[s], *targets[t], match).energy;
        });
      report();
    }
  }
  if (error)
  {
    std::rethrow_exception(error);
  }
  result.stop = static_cast<MatchStop>(stop.load());
  for (const ShapeSource& source : sources)
  {
    result.vertices.push_back(static_cast<Index>(source.mesh.points.size()));
  }
  if (options.symmetric)
  {
    std::vector<double> both(result.distances.size(), -1.0);
    for (Index s = 0; s < count; ++s)
    {
      for (Index t = 0; t < count; ++t)
      {
        const double there = result.distances[s * count + t],
                     back = result.distances[t * count + s];
        if (there >= 0.0 && back >= 0.0)
        {
          both[s * count + t] = there / static_cast<double>(result.vertices[s] - 2) +
            back / static_cast<double>(result.vertices[t] - 2);
        }
      }
    }
    result.distances.swap(both);
  }
  result.ranking = rankShapes(result.distances, count);
  result.recognition = recognize(result.ranking, labels, options.best);
  return result;
}
}
