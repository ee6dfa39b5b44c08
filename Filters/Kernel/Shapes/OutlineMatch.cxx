// SPDX-License-Identifier: BSD-3-Clause
#include "OutlineMatch.h"

#include "ShapeEnergy.h"
#include "tautline/Core/Interruption.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace tautline
{
namespace
{
/// The first guess of the energy is this much above the bound; then the gap is doubled.
constexpr float FirstGap = 0.3f;
/// Sums in a different order may differ by this fraction.
constexpr float Rounding = 1e-5f;
/// Energies above this mean "none".
constexpr float NoEnergy = 0.1f * Unreachable;

/**
 * @brief Costs as a function of the start p of a chain of edges and its advance a in locations.
 *
 * One row per advance; rows hold the start positions twice around, so that p + b needs no wrap.
 */
struct ChainTable
{
  Index low = 1, high = 0; ///< advances
  Index count = 0;         ///< locations
  Index stride = 0;
  std::pmr::vector<float> values;
  std::vector<float> minima; ///< of the rows; empty if not computed
  float least = 0.0f;        ///< of all rows; a lower bound if not computed

  explicit ChainTable(std::pmr::memory_resource* memory)
    : values(memory)
  {
  }
  ChainTable(Index low, Index high, Index count, std::pmr::memory_resource* memory)
    : low(low)
    , high(std::max(low, high))
    , count(count)
    , stride(2 * count + FloatWidth)
    , values(static_cast<std::size_t>((this->high - low + 1) * this->stride), Unreachable, memory)
  {
  }
  float* row(Index a) { return this->values.data() + (a - this->low) * this->stride; }
  const float* row(Index a) const { return this->values.data() + (a - this->low) * this->stride; }
  void computeMinima()
  {
    this->minima.clear();
    for (Index a = this->low; a <= this->high; ++a)
    {
      this->minima.push_back(*std::min_element(this->row(a), this->row(a) + this->count));
    }
    this->least = *std::min_element(this->minima.begin(), this->minima.end());
  }
  /// The first and last advance for which the rest may cost up to `rest`.
  std::pair<Index, Index> affordable(float rest) const
  {
    Index first = this->low, last = this->high;
    while (first <= last && this->minima[first - this->low] > rest)
    {
      ++first;
    }
    while (last >= first && this->minima[last - this->low] > rest)
    {
      --last;
    }
    return { first, last };
  }
  /// Copies the first round of a row to the rest of the row.
  void wrap(Index a)
  {
    float* r = this->row(a);
    for (Index p = this->count; p < this->stride; ++p)
    {
      r[p] = r[p - this->count];
    }
  }
};

/// Least sums of `Packets` packets: a pair of rows per term, a stride apart.
template <int Packets>
void leastPackets(
  const float* a, Index strideA, const float* b, Index strideB, Index terms, float* out)
{
  FloatPacket best[Packets];
  for (FloatPacket& packet : best)
  {
    packet = broadcast(Unreachable);
  }
  for (Index t = 0; t < terms; ++t, a += strideA, b += strideB)
  {
    for (int k = 0; k < Packets; ++k)
    {
      best[k] = min(best[k], loadFloats(a + k * FloatWidth) + loadFloats(b + k * FloatWidth));
    }
  }
  for (int k = 0; k < Packets; ++k)
  {
    storeFloats(out + k * FloatWidth, best[k]);
  }
}

/// out[p] = min over t of a[p + t strideA] + b[p + t strideB], for p < count, and up to a packet
/// more.
void leastSums(const float* a, Index strideA, const float* b, Index strideB, Index terms,
  Index count, float* out)
{
  constexpr int together = 4; // a round of 64 locations in the widest packets
  Index p = 0;
  for (; p + (together - 1) * FloatWidth < count; p += together * FloatWidth)
  {
    leastPackets<together>(a + p, strideA, b + p, strideB, terms, out + p);
  }
  for (; p < count; p += FloatWidth)
  {
    leastPackets<1>(a + p, strideA, b + p, strideB, terms, out + p);
  }
}

/// Minimizes over the placements of one polygon on one outline.
class OutlineSearch
{
public:
  OutlineSearch(const OutlineModel::Polygon& polygon, const OutlineModel& target,
    const OutlineOptions& options, std::pmr::memory_resource* memory, OutlineMatch& statistics)
    : Source(polygon)
    , Target(target)
    , Options(options)
    , Memory(memory)
    , Statistics(statistics)
    , Vertices(static_cast<Index>(polygon.mesh.points.size()))
    , Count(options.locations)
  {
    for (Index v = 0; v < this->Vertices; ++v)
    {
      this->Edges.push_back(this->edgeCosts(v));
    }
    // A chain is the part of the polygon that a diagonal cuts off, or an edge: its number is the
    // step that completes it, or -1 - edge.
    std::map<std::pair<Index, Index>, Index> chains;
    for (Index v = 0; v < this->Vertices; ++v)
    {
      chains[{ v, (v + 1) % this->Vertices }] = -1 - v;
    }
    for (const EliminationStep& e : polygon.mesh.elimination)
    {
      const Index k = e.vertex, i = e.parents[0], j = e.parents[1];
      this->Steps.push_back({ k, i, j, chains.at({ j, k }), chains.at({ k, i }), ChainTable(memory),
        ChainTable(memory) });
      chains[{ j, i }] = static_cast<Index>(this->Steps.size()) - 1;
    }
    const Step& last = this->Steps.back();
    this->Rest = chains.at({ last.i, last.j });
    this->Bound = this->boundInside();
  }

  /// A lower bound of the energy.
  float bound() const { return this->Bound; }

  /// The minimum, or the limit if it is not below that.
  float run(float limit)
  {
    if (!this->Options.bounds)
    {
      // Bounds that exclude no placement make the search exhaustive, for comparison.
      for (Step& step : this->Steps)
      {
        std::fill(step.inside.values.begin(), step.inside.values.end(), -Unreachable);
        step.outside = step.inside;
        std::fill(step.outside.values.begin(), step.outside.values.end(), 0.0f);
      }
      return std::min(limit, this->minimum(0.5f * Unreachable));
    }
    const float bound = this->Bound;
    if (bound >= std::min(limit, NoEnergy))
    {
      return limit;
    }
    // All placements up to a guess are considered: if any is found, the best one is.
    for (float gap = FirstGap * bound + Rounding;; gap *= 2.0f)
    {
      const float guess = std::min(bound + gap, limit);
      const float most = guess * (1.0f + Rounding);
      this->boundOutside(most);
      const float found = this->minimum(most);
      if (found <= guess || guess >= std::min(limit, NoEnergy))
      {
        return std::min(found, limit);
      }
    }
  }

private:
  struct Step
  {
    Index k, i, j;      ///< the triangle; its chain runs from j over k to i
    Index left, right;  ///< the chains from j to k and from k to i
    ChainTable inside;  ///< least cost of the chain without triangles' terms
    ChainTable outside; ///< the same for the rest of the polygon
  };

  const ChainTable& inside(Index chain) const
  {
    return chain < 0 ? this->Edges[-1 - chain] : this->Steps[chain].inside;
  }

  /// The ordering and descriptor costs of one edge.
  ChainTable edgeCosts(Index v) const
  {
    const double expected = this->Source.advance[v];
    // The advance of an edge may differ from its share of the outline by the factor `stretch`
    // either way.
    const Index low =
      std::max<Index>(1, static_cast<Index>(std::ceil(expected / this->Options.stretch - 0.5)));
    // Each of the other edges advances by at least one location.
    const Index most = this->Count - (this->Vertices - 1);
    const Index high =
      std::min(most, static_cast<Index>(std::floor(expected * this->Options.stretch + 0.5)));
    ChainTable table(std::min(low, most), high, this->Count, this->Memory);
    // The target has several descriptors per location, so that samples inside an edge find a close
    // one.
    const Index fine = static_cast<Index>(this->Target.descriptors.size()) / OutlineChannels;
    const Index perLocation = fine / this->Count;
    // The differences between the descriptors of each edge sample and each location.
    std::vector<float> differences(static_cast<std::size_t>(DescriptorSamples * 2 * fine), 0.0f);
    for (Index g = 0; g < DescriptorSamples; ++g)
    {
      const float* a =
        this->Source.descriptors.data() + (v * DescriptorSamples + g) * OutlineChannels;
      float* sums = differences.data() + g * 2 * fine;
      for (Index k = 0; k < OutlineChannels; ++k)
      {
        const float* b = this->Target.descriptors.data() + k * fine;
        for (Index x = 0; x < fine; ++x)
        {
          sums[x] += std::abs(a[k] - b[x]);
        }
      }
      std::copy_n(sums, fine, sums + fine); // twice around
    }
    // Edges count by their length; the factor Vertices cancels when the energy is divided by the
    // number of vertices.
    const float weight = static_cast<float>(this->Options.descriptor * expected /
      static_cast<double>(this->Count) * static_cast<double>(this->Vertices) / DescriptorSamples);
    for (Index a = table.low; a <= table.high; ++a)
    {
      const float order = static_cast<float>(
        this->Options.ordering * std::abs(std::log(static_cast<double>(a) / expected)));
      float* row = table.row(a);
      std::fill(row, row + this->Count, order);
      for (Index g = 0; g < DescriptorSamples; ++g)
      {
        const Index offset = static_cast<Index>(std::lround(static_cast<double>(perLocation * a) *
          (static_cast<double>(g) + 0.5) / DescriptorSamples));
        const float* sums = differences.data() + g * 2 * fine + offset;
        for (Index p = 0; p < this->Count; ++p)
        {
          row[p] += weight * sums[perLocation * p];
        }
      }
      table.wrap(a);
    }
    table.computeMinima();
    return table;
  }

  /// out(a, p) = min over b of left(b, p) + right(a - b, p + b).
  void join(const ChainTable& left, const ChainTable& right, ChainTable& out)
  {
    for (Index a = out.low; a <= out.high; ++a)
    {
      const Index first = std::max(left.low, a - right.high);
      const Index last = std::min(left.high, a - right.low);
      const Index count = last - first + 1;
      // As b grows, the right part advances less and begins later.
      leastSums(left.row(first), left.stride, right.row(a - first) + first, 1 - right.stride, count,
        this->Count, out.row(a));
      this->Statistics.additions += count * this->Count / FloatWidth;
      out.wrap(a);
    }
  }

  /// The least costs, without the triangle terms, of all chains and of the whole polygon.
  float boundInside()
  {
    for (Step& step : this->Steps)
    {
      const ChainTable &left = this->inside(step.left), &right = this->inside(step.right);
      // A chain leaves at least one location for the rest of the outline.
      step.inside = ChainTable(left.low + right.low,
        std::min(left.high + right.high, this->Count - 1), this->Count, this->Memory);
      this->join(left, right, step.inside);
      step.inside.computeMinima();
    }
    Step& last = this->Steps.back();
    last.outside = this->complement(this->inside(this->Rest), last.inside);
    float bound = Unreachable;
    for (Index a = last.inside.low; a <= last.inside.high; ++a)
    {
      for (Index p = 0; p < this->Count; ++p)
      {
        bound = std::min(bound, last.inside.row(a)[p] + last.outside.row(a)[p]);
      }
    }
    return bound;
  }

  /// The cost of the rest of the outline, for the start positions and advances of `like`.
  ChainTable complement(const ChainTable& rest, const ChainTable& like) const
  {
    ChainTable result(like.low, like.high, this->Count, this->Memory);
    for (Index a = like.low; a <= like.high; ++a)
    {
      // The rest begins where the chain ends, at p + a, and covers the other locations.
      const Index other = this->Count - a;
      if (other >= rest.low && other <= rest.high)
      {
        std::copy_n(rest.row(other) + a, this->Count, result.row(a));
      }
      result.wrap(a);
    }
    return result;
  }

  /// For each chain, the least cost of its complement if the total may cost up to a limit.
  void boundOutside(float limit)
  {
    Step& last = this->Steps.back();
    // A lower bound suffices here, as it only limits the advances that are considered.
    last.outside.least = this->inside(this->Rest).least;
    if (this->Rest >= 0)
    {
      Step& rest = this->Steps[this->Rest];
      rest.outside = this->complement(last.inside, rest.inside);
      rest.outside.least = last.inside.least;
    }
    // Backward: the complement of a chain follows from the complement of the chain that contains
    // it.
    for (std::size_t s = this->Steps.size(); s-- > 0;)
    {
      const Step& step = this->Steps[s];
      // The complement of the left part consists of the right part and the complement of both, and
      // vice versa.
      if (step.left >= 0)
      {
        this->outsidePart(step.left, step.right, step.outside, limit, true);
      }
      if (step.right >= 0)
      {
        this->outsidePart(step.right, step.left, step.outside, limit, false);
      }
    }
  }

  /// out(a, p) = min over b of other(b, p + a) + whole(a + b, p) if the part comes first, otherwise
  /// of other(b, p - b) + whole(a + b, p - b).
  void outsidePart(
    Index partChain, Index otherChain, const ChainTable& whole, float limit, bool partFirst)
  {
    const ChainTable &part = this->inside(partChain), &other = this->inside(otherChain);
    ChainTable& out = this->Steps[partChain].outside;
    out = ChainTable(part.low, part.high, this->Count, this->Memory);
    out.least = other.least + whole.least;
    // Advances that are too expensive even with the cheapest complement are skipped.
    const auto [lowPart, highPart] = part.affordable(limit - out.least);
    const auto [lowOther, highOther] = other.affordable(limit - part.least - whole.least);
    for (Index a = lowPart; a <= highPart; ++a)
    {
      const Index first = std::max(lowOther, whole.low - a);
      const Index last = std::min(highOther, whole.high - a);
      if (last < first)
      {
        continue;
      }
      const Index count = last - first + 1;
      // If the part comes second, the other chain starts b locations before p; adding Count avoids
      // negative positions.
      const Index shift = partFirst ? a : this->Count - first, each = partFirst ? 0 : -1;
      leastSums(other.row(first) + shift, other.stride + each,
        whole.row(a + first) + (partFirst ? 0 : shift), whole.stride + each, count, this->Count,
        out.row(a));
      this->Statistics.additions += count * this->Count / FloatWidth;
      out.wrap(a);
    }
  }

  /// The minimum of all placements that may cost less than the limit; Unreachable if there is none.
  float minimum(float limit)
  {
    std::vector<ChainTable> costs;
    costs.reserve(this->Steps.size()); // so that tables are not moved
    const auto table = [&](Index chain) -> const ChainTable&
    { return chain < 0 ? this->Edges[-1 - chain] : costs[chain]; };
    for (const Step& step : this->Steps)
    {
      throwIfInterrupted();
      costs.emplace_back(step.inside.low, step.inside.high, this->Count, this->Memory);
      if (!this->addTriangle(step, table(step.left), table(step.right), limit, costs.back()))
      {
        return Unreachable;
      }
    }
    const Step& last = this->Steps.back();
    const ChainTable rest = this->complement(table(this->Rest), costs.back());
    float best = Unreachable;
    for (Index a = last.inside.low; a <= last.inside.high; ++a)
    {
      for (Index p = 0; p < this->Count; ++p)
      {
        best = std::min(best, costs.back().row(a)[p] + rest.row(a)[p]);
      }
    }
    return best;
  }

  /// The costs of a chain with its triangle; false if no placement is left.
  bool addTriangle(
    const Step& step, const ChainTable& left, const ChainTable& right, float limit, ChainTable& out)
  {
    ShapeEnergy energy;
    energy.deformation = this->Options.deformation;
    energy.distortion = this->Options.distortion;
    energy.signedDistortion = true;
    const std::vector<Vec2>& points = this->Source.mesh.points;
    const TriangleTerms terms(points[step.i], points[step.j], points[step.k], energy, 1.0);
    const float *x = this->Target.x.data(), *y = this->Target.y.data();
    bool any = false;
    for (Index a = out.low; a <= out.high; ++a)
    {
      const Index first = std::max(left.low, a - right.high);
      const Index last = std::min(left.high, a - right.low);
      for (Index p = 0; p < this->Count; p += FloatWidth)
      {
        // The rest of the polygon costs at least `outside`; the chain and its triangle have to fit
        // into the remaining budget.
        const FloatPacket most = limit - loadFloats(step.outside.row(a) + p);
        if (!anyOf(loadFloats(step.inside.row(a) + p) < most))
        {
          continue;
        }
        // Vertex i is placed at p + a, j at p, k at p + b.
        const FloatPacket ix = loadFloats(x + p + a), iy = loadFloats(y + p + a);
        const FloatPacket dx = loadFloats(x + p) - ix, dy = loadFloats(y + p) - iy;
        const FloatPacket ij = loadFloats(this->distances(a) + p);
        FloatPacket best = most;
        for (Index b = first; b <= last; ++b)
        {
          const FloatPacket parts =
            loadFloats(left.row(b) + p) + loadFloats(right.row(a - b) + p + b);
          // The costs without the triangle are a lower bound, so the triangle is only evaluated if
          // the sum may improve the best.
          if (!anyOf(parts < best))
          {
            continue;
          }
          const FloatPacket rx = loadFloats(x + p + b) - ix, ry = loadFloats(y + p + b) - iy;
          const FloatPacket ik = loadFloats(this->distances(a - b) + p + b);
          const FloatPacket jk = loadFloats(this->distances(b) + p);
          best = min(best, parts + triangle(terms, dx * ry - dy * rx, ij, ik, jk));
          ++this->Statistics.triangles;
        }
        const FloatMask found = best < most;
        any = any || anyOf(found);
        storeFloats(out.row(a) + p, select(found, best, broadcast(Unreachable)));
      }
      out.wrap(a);
    }
    return any;
  }

  /// The distances from each location to the one this far ahead.
  const float* distances(Index advance) const
  {
    return this->Target.distances.data() + advance * static_cast<Index>(this->Target.x.size());
  }

  /// Deformation and distortion of a packet of triangles i, j, k from twice their areas and the
  /// lengths of their edges.
  static FloatPacket triangle(
    const TriangleTerms& t, FloatPacket size, FloatPacket ij, FloatPacket ik, FloatPacket jk)
  {
    const FloatPacket sum = max(ij + ik + jk, broadcast(MinLength));
    const FloatMask flat = size <= FlatArea * (sum * sum);
    // |A|^2 / (2 det A) of the map A from the source triangle, where |A|^2 is a weighted sum of
    // squared edge lengths (cotangent formula).
    const FloatPacket norm =
      t.weights[0] * (ij * ij) + t.weights[1] * (ik * ik) + t.weights[2] * (jk * jk);
    FloatPacket k =
      select(flat, broadcast(FlatAnisotropy), norm / select(flat, broadcast(1.0f), size));
    k = min(max(k, broadcast(1.0f)), broadcast(FlatAnisotropy));
    // acosh(k) is the logarithm of the ratio of the singular values of A.
    const FloatPacket anisotropy = log(k + sqrt(k * k - 1.0f));
    return t.deformation * (anisotropy * anisotropy) + t.distortion * abs(log(sum) - t.logLength);
  }

  const OutlineModel::Polygon& Source;
  const OutlineModel& Target;
  const OutlineOptions& Options;
  std::pmr::memory_resource* Memory; ///< of the tables
  OutlineMatch& Statistics;
  Index Vertices, Count;
  std::vector<ChainTable> Edges;
  std::vector<Step> Steps;
  float Bound = 0.0f;
  Index Rest = 0; ///< the chain that closes the polygon after the last step
};
}

//------------------------------------------------------------------------------
std::unique_ptr<std::pmr::memory_resource> outlineMemory()
{
  std::pmr::pool_options options;
  options.largest_required_pool_block = 1 << 20; // tables of 200 locations; larger ones are freed
  return std::make_unique<std::pmr::unsynchronized_pool_resource>(options);
}

//------------------------------------------------------------------------------
OutlineMatch matchOutlines(const OutlineModel& source, const OutlineModel& target,
  const OutlineOptions& options, std::pmr::memory_resource* given)
{
  const std::unique_ptr<std::pmr::memory_resource> own = given ? nullptr : outlineMemory();
  std::pmr::memory_resource* const memory = given ? given : own.get();
  const std::size_t expected = static_cast<std::size_t>(2 * options.locations + FloatWidth);
  if (source.x.size() != expected || target.x.size() != expected ||
    (options.mirrored && source.mirror.advance.empty()))
  {
    throw Error("Outlines are matched with the options they were prepared with.");
  }
  OutlineMatch match;
  OutlineSearch upright(source.polygon, target, options, memory, match);
  constexpr float all = 0.5f * Unreachable;
  float energy = all;
  if (options.mirrored)
  {
    // Start with the lower bound: its energy often rules out the other.
    OutlineSearch mirror(source.mirror, target, options, memory, match);
    const bool first = mirror.bound() < upright.bound();
    energy = (first ? mirror : upright).run(all);
    const float other = (first ? upright : mirror).run(energy);
    // The mirror image wins if it came first and stayed the best, or if it came second and was
    // better.
    match.mirrored = first != (other < energy);
    energy = std::min(energy, other);
  }
  else
  {
    energy = upright.run(all);
  }
  match.energy = energy < NoEnergy
    ? static_cast<double>(energy) / static_cast<double>(source.polygon.advance.size())
    : std::numeric_limits<double>::infinity();
  return match;
}
}
