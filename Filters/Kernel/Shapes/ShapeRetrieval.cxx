// SPDX-License-Identifier: BSD-3-Clause
#include "ShapeRetrieval.h"

#include "tautline/Core/Interruption.h"
#include "tautline/Core/Memory.h"
#include "tautline/Core/Parallel.h"
#include "tautline/Core/Stopwatch.h"

#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <iterator>
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
    // Sort by distance; shapes without a distance (negative) come last.
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
/// The number of diffusion steps, and the weight of the identity, which keeps each shape its own
/// nearest.
constexpr int DiffusionSteps = 10;
constexpr double DiffusionIdentity = 1e-3;

/// Seconds after which ranks check whether one of them must stop.
constexpr double RoundSeconds = 0.5;

/// Compares all pairs of shapes on several threads and ranks.
class Comparison
{
public:
  Comparison(
    RankGroup& group, const std::vector<Silhouette>& shapes, const RetrievalOptions& options)
    : Group(group)
    , Shapes(shapes)
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
    // The limit also ends a running comparison.
    this->Match.progress = nullptr;
    if (options.match.timeLimit > 0.0)
    {
      this->Match.progress = [this](double)
      { return !this->Time.reached(this->Options.match.timeLimit); };
    }
  }

  /// Energies of all pairs, row by source; negative if the comparison was stopped before.
  std::vector<double> run()
  {
    std::vector<double> energies(static_cast<std::size_t>(this->Count * this->Count), -1.0);
    runChunks(
      this->Count, this->Options.match.threads,
      [&](Index s) { this->named(s, [&] { this->prepareInTime(s); }); },
      [this](double fraction) { return this->proceed(0, this->Count, fraction); });
    this->shareStop();
    if (this->Stop == MatchStop::Complete)
    {
      for (Index s = 0; s < this->Count; ++s)
      {
        energies[s * this->Count + s] = 0.0;
      }
      const std::vector<char> chosen = this->shortlisted();
      this->Matches = std::count(chosen.begin(), chosen.end(), 1);
      this->matchPairs(this->ownPairs(chosen), energies);
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

  /// A stop on one rank stops all ranks.
  void shareStop()
  {
    this->Stop =
      static_cast<MatchStop>(this->Group.maximum(static_cast<Index>(static_cast<int>(this->Stop))));
  }

  /// The pairs of this rank: every n-th matched pair on n ranks.
  std::vector<Index> ownPairs(const std::vector<char>& chosen) const
  {
    std::vector<Index> own;
    Index number = 0;
    for (std::size_t pair = 0; pair < chosen.size(); ++pair)
    {
      if (!chosen[pair])
      {
        continue;
      }
      if (number++ % this->Group.size() == this->Group.rank())
      {
        own.push_back(static_cast<Index>(pair));
      }
    }
    return own;
  }

  /// Matches pairs in rounds, and exchanges their energies.
  void matchPairs(std::vector<Index> left, std::vector<double>& energies)
  {
    const auto all = static_cast<Index>(left.size());
    struct Found
    {
      Index pair;
      double energy;
    };
    std::vector<Found> found;
    bool going = true;
    while (going)
    {
      const auto before = static_cast<Index>(left.size());
      this->matchRound(left, all, energies);
      const auto rest = std::stable_partition(
        left.begin(), left.end(), [&](Index pair) { return energies[pair] < 0.0; });
      for (auto pair = rest; pair != left.end(); ++pair)
      {
        found.push_back({ *pair, energies[*pair] });
      }
      left.erase(rest, left.end());
      this->shareStop();
      const bool advances = this->Group.any(static_cast<Index>(left.size()) < before);
      going = this->Group.any(!left.empty()) && advances && this->Stop == MatchStop::Complete;
    }
    // Pairs that the limit stopped may have been the last ones.
    if (this->Group.any(!left.empty()) && this->Stop == MatchStop::Complete)
    {
      this->Stop = MatchStop::TimeLimit;
    }
    std::vector<std::vector<Found>> sent(this->Group.size());
    sent[0].swap(found);
    for (const std::vector<Found>& list : this->Group.exchangeItems(sent))
    {
      for (const Found& each : list)
      {
        energies[each.pair] = each.energy;
      }
    }
  }

  /// Matches pairs for some time on several ranks, otherwise all remaining pairs.
  void matchRound(const std::vector<Index>& left, Index all, std::vector<double>& energies)
  {
    const Stopwatch time;
    const auto count = static_cast<Index>(left.size());
    runChunks(
      count, this->Options.match.threads,
      [&](Index i)
      {
        const Index s = left[i] / this->Count, t = left[i] % this->Count;
        this->named(s, [&] { energies[left[i]] = this->energy(s, t); });
      },
      [&](double fraction)
      {
        const double done = all > 0
          ? 1.0 - (1.0 - fraction) * static_cast<double>(count) / static_cast<double>(all)
          : 1.0;
        return this->proceed(this->Count, this->Count * this->Count, done) &&
          (this->Group.size() == 1 || !time.reached(RoundSeconds));
      });
  }

  /// Leaves a shape unprepared after the time limit: with the settings of the dissertation,
  /// preparation takes a third of a second.
  void prepareInTime(Index s)
  {
    struct OutOfTime
    {
    };
    const PollScope scope(
      [this]
      {
        if (this->Time.reached(this->Options.match.timeLimit))
        {
          throw OutOfTime();
        }
      });
    try
    {
      this->prepare(s);
    }
    catch (const OutOfTime&)
    {
      // proceed() ends the run
    }
  }

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

  /// For each pair: whether it is matched.
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
        // Match in both directions, so that the distance is symmetric.
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

  RankGroup& Group;
  const std::vector<Silhouette>& Shapes;
  const RetrievalOptions& Options;
  MatchOptions Match; ///< for a single pair: on one thread, without limits
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
/// Combines the energies of outlines, which are per vertex: both directions, in units of the
/// complexity.
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

//------------------------------------------------------------------------------
std::string problemOf(const Silhouette& shape, const RetrievalOptions& options)
{
  try
  {
    if (options.method == RetrievalMethod::Outline)
    {
      prepareOutline(shape, options.outline);
    }
    else
    {
      triangulatePolygon(approximateOutline(shape.outline, options.spacing));
    }
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return "";
}

//------------------------------------------------------------------------------
std::vector<double> rerank(const std::vector<double>& distances, Index count, Index neighbours)
{
  if (count < 2 || neighbours < 1 || static_cast<Index>(distances.size()) != count * count)
  {
    throw Error("Diffusion needs the distances of 2 shapes or more, and at least 1 neighbor.");
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
  // Transitions to the shape itself and its nearest neighbors only.
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

namespace
{
void checkInput(const std::vector<Silhouette>& shapes, const std::vector<Index>& labels,
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
    throw Error("The complexity must be above 0, shortlist and neighbors at least 0.");
  }
  // Distances in both directions, their sums, and the ranking.
  constexpr double bytesPerPair = 3 * sizeof(double) + sizeof(Index);
  requireMemory(bytesPerPair * static_cast<double>(count) * static_cast<double>(count),
    "The table of all pairs of " + std::to_string(count) + " shapes", "use fewer shapes.");
}

/// A silhouette without its data per point or pixel, as sent.
struct SentShape
{
  Index points, pixels, components, holes, width, height;
  Vec2 centre;
  double maxDistance, area, perimeter, threshold;
  char touchesBorder, dark;
};
}

//------------------------------------------------------------------------------
std::vector<Silhouette> shapesOfFirst(RankGroup& group, const std::vector<Silhouette>& own)
{
  std::vector<SentShape> sent;
  std::vector<Vec2> outlines;
  std::vector<char> pixels; // of masks, with values 0 and 1
  const bool isFirst = group.rank() == 0;
  for (std::size_t i = 0; isFirst && i < own.size(); ++i)
  {
    const Silhouette& s = own[i];
    sent.push_back({ static_cast<Index>(s.outline.size()), static_cast<Index>(s.mask.size()),
      s.components, s.holes, s.width, s.height, s.centre, s.maxDistance, s.area, s.perimeter,
      s.threshold, static_cast<char>(s.touchesBorder), static_cast<char>(s.dark) });
    outlines.insert(outlines.end(), s.outline.begin(), s.outline.end());
    std::transform(s.mask.begin(), s.mask.end(), std::back_inserter(pixels),
      [](float inside) { return static_cast<char>(inside != 0.0f); });
  }
  sent = group.gatherItems(sent)[0];
  outlines = group.gatherItems(outlines)[0];
  pixels = group.gatherItems(pixels)[0];
  std::vector<Silhouette> shapes;
  auto point = outlines.begin();
  auto pixel = pixels.begin();
  for (const SentShape& from : sent)
  {
    Silhouette s;
    s.outline.assign(point, point + from.points);
    s.mask.assign(pixel, pixel + from.pixels);
    point += from.points;
    pixel += from.pixels;
    s.components = from.components;
    s.holes = from.holes;
    s.width = from.width;
    s.height = from.height;
    s.centre = from.centre;
    s.maxDistance = from.maxDistance;
    s.area = from.area;
    s.perimeter = from.perimeter;
    s.threshold = from.threshold;
    s.touchesBorder = from.touchesBorder != 0;
    s.dark = from.dark != 0;
    shapes.push_back(std::move(s));
  }
  return shapes;
}

//------------------------------------------------------------------------------
Retrieval retrieveShapes(const std::vector<Silhouette>& shapes, const std::vector<Index>& labels,
  const RetrievalOptions& options)
{
  SingleRank alone;
  return retrieveShapes(alone, shapes, labels, options);
}

//------------------------------------------------------------------------------
Retrieval retrieveShapes(RankGroup& group, const std::vector<Silhouette>& shapes,
  const std::vector<Index>& labels, const RetrievalOptions& options)
{
  checkInput(shapes, labels, options);
  const Index count = static_cast<Index>(shapes.size());
  Retrieval result;
  result.count = count;
  Comparison comparison(group, shapes, options);
  group.together([&] { result.distances = comparison.run(); });
  result.stop = comparison.stop();
  result.vertices = comparison.vertices();
  result.matches = comparison.matches();
  if (group.rank() > 0)
  {
    result.distances.clear();
    return result;
  }
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
