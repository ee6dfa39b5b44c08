#include "Statistics.h"

#include "Parallel.h"

#include <numeric>

namespace tautline
{
namespace
{
bool isMeasured(const MetricInfo& info, signed char validity, unsigned char type)
{
  const bool counts =
    validity == Valid || (validity == Inverted && info.inverted == InvertedValue::Larger);
  return counts && info.definedOn(cornerType(type));
}

/// Tables of the 256 types, so that the loops below look up instead of searching.
std::array<bool, 256> definedTypes(const MetricInfo& info)
{
  std::array<bool, 256> table;
  for (int type = 0; type < 256; ++type)
  {
    table[type] = cornerType(type) != CellType::Unsupported &&
      isMeasured(info, Valid, static_cast<unsigned char>(type));
  }
  return table;
}

std::vector<double> measuredValues(const MetricInfo& info, const double* values,
  const signed char* validity, const unsigned char* cellTypes, const unsigned char* skip,
  Index cells)
{
  const auto defined = definedTypes(info);
  const bool withInverted = info.inverted == InvertedValue::Larger;
  std::vector<double> kept;
  kept.reserve(cells);
  for (Index i = 0; i < cells; ++i)
  {
    const bool counts = validity[i] == Valid || (withInverted && validity[i] == Inverted);
    if (counts && defined[cellTypes[i]] && !(skip && skip[i]))
    {
      kept.push_back(values[i]);
    }
  }
  return kept;
}
}

//------------------------------------------------------------------------------
ValidityCounts countValidity(const signed char* validity, Index cells)
{
  ValidityCounts counts;
  for (Index i = 0; i < cells; ++i)
  {
    counts.valid += validity[i] == Valid;
    counts.inverted += validity[i] == Inverted;
    counts.degenerate += validity[i] == Degenerate;
    counts.notMeasured += validity[i] == NotMeasured;
    counts.nonFinite += validity[i] == NonFinite;
  }
  return counts;
}

//------------------------------------------------------------------------------
MetricStatistics summarize(const MetricInfo& info, int dimension, const double* values,
  const signed char* validity, const unsigned char* cellTypes, const unsigned char* skip,
  Index cells)
{
  MetricStatistics result;
  result.worst.fill(-1);
  std::vector<double> kept = measuredValues(info, values, validity, cellTypes, skip, cells);
  result.measured = static_cast<Index>(kept.size());

  // The worst of all: unusable elements before the valid ones, equals by id.
  const auto defined = definedTypes(info);
  const double sign = info.direction == Direction::SmallerIsBetter ? -1.0 : 1.0;
  auto worse = [&](Index a, Index b)
  {
    auto rank = [&](Index i) {
      return validity[i] == Inverted ? 0 : validity[i] == Degenerate ? 1 : 2;
    };
    if (rank(a) != rank(b))
    {
      return rank(a) < rank(b);
    }
    return values[a] != values[b] ? sign * values[a] < sign * values[b] : a < b;
  };
  std::vector<Index> heap; // its front is the least bad of those kept
  for (Index i = 0; i < cells; ++i)
  {
    if (!defined[cellTypes[i]] || validity[i] < Inverted || (skip && skip[i]))
    {
      continue;
    }
    if (heap.size() < WorstCount)
    {
      heap.push_back(i);
      std::push_heap(heap.begin(), heap.end(), worse);
    }
    else if (worse(i, heap.front()))
    {
      std::pop_heap(heap.begin(), heap.end(), worse);
      heap.back() = i;
      std::push_heap(heap.begin(), heap.end(), worse);
    }
  }
  std::sort_heap(heap.begin(), heap.end(), worse);
  std::copy(heap.begin(), heap.end(), result.worst.begin());
  if (kept.empty())
  {
    return result;
  }

  // Two passes, so that the deviation of nearly equal values is right.
  const double n = static_cast<double>(kept.size());
  const Range acceptable = info.acceptable(dimension);
  double largest = 0;
  result.minimum = result.maximum = kept.front();
  for (double q : kept)
  {
    result.minimum = std::min(result.minimum, q);
    result.maximum = std::max(result.maximum, q);
    largest = std::max(largest, std::abs(q));
    result.outsideAcceptable += q < acceptable.low || q > acceptable.high;
  }
  // Scaled by the largest, so that squares neither overflow nor vanish.
  const double unit = largest > 0 ? largest : 1.0;
  double sum = 0, squares = 0;
  for (double q : kept)
  {
    sum += q / unit;
    squares += (q / unit) * (q / unit);
  }
  result.mean = sum / n * unit;
  result.rms = std::sqrt(squares / n) * unit;
  double deviations = 0;
  for (double q : kept)
  {
    const double d = (q - result.mean) / unit;
    deviations += d * d;
  }
  result.standardDeviation = std::sqrt(deviations / n) * unit;

  // Quantiles in increasing order; each search goes on where the last one ended.
  auto from = kept.begin();
  for (std::size_t i = 0; i < quantileFractions.size(); ++i)
  {
    const double position = quantileFractions[i] * (n - 1);
    const auto at = kept.begin() + static_cast<Index>(position);
    std::nth_element(from, at, kept.end());
    const double low = *at;
    const double high = at + 1 < kept.end() ? *std::min_element(at + 1, kept.end()) : low;
    const double part = position - std::floor(position);
    result.quantiles[i] = part > 0 ? low + part * (high - low) : low;
    from = at;
  }
  return result;
}

//------------------------------------------------------------------------------
Histogram histogram(const MetricInfo& info, const double* values, const signed char* validity,
  const unsigned char* cellTypes, const unsigned char* skip, Index cells, int bins)
{
  if (bins < 1)
  {
    throw Error("A histogram needs at least one bin.");
  }
  const std::vector<double> kept = measuredValues(info, values, validity, cellTypes, skip, cells);
  double low = 0, high = 1;
  if (!kept.empty())
  {
    const auto ends = std::minmax_element(kept.begin(), kept.end());
    low = *ends.first;
    high = *ends.second;
  }
  Histogram result;
  result.counts.assign(bins, 0);
  result.edges.resize(bins + 1);
  for (int i = 0; i <= bins; ++i)
  {
    result.edges[i] = low + (high - low) * (static_cast<double>(i) / bins);
  }
  const double perUnit = high > low ? bins / (high - low) : 0.0;
  for (double q : kept)
  {
    const Index bin = static_cast<Index>((q - low) * perUnit);
    ++result.counts[std::max<Index>(0, std::min<Index>(bins - 1, bin))];
  }
  return result;
}

//------------------------------------------------------------------------------
std::array<Index, angleBins.size() - 1> angleDistribution(
  const Mesh& mesh, const signed char* validity, const unsigned char* skip, int threads)
{
  using Counts = std::array<Index, angleBins.size() - 1>;
  // Cosines of the inner bin ends: an angle above 20 degrees has a cosine below cos 20, and so on.
  std::array<double, angleBins.size() - 2> cosines;
  for (std::size_t i = 0; i < cosines.size(); ++i)
  {
    cosines[i] = std::cos(angleBins[i + 1] * M_PI / 180);
  }
  const MeshView& view = mesh.view();
  const int dimension = mesh.dimension() == Dimension::Volume ? 3 : 2;
  Counts total{};
  for (const CellBlock& block : mesh.blocks())
  {
    const CellTopology& t = topology(block.type);
    if (t.dimension != dimension)
    {
      continue;
    }
    std::vector<Counts> perChunk(numberOfChunks(block.count), Counts{});
    forEachChunk(block.count, threads,
      [&](Index chunk, Index begin, Index end)
      {
        Counts& counts = perChunk[chunk];
        auto add = [&](double cosineTimesLengths, double lengths2)
        {
          // The bin is the number of inner ends the angle has passed.
          const double cosine = cosineTimesLengths / std::sqrt(lengths2);
          int bin = 0;
          for (double c : cosines)
          {
            bin += cosine <= c;
          }
          ++counts[bin];
        };
        for (Index i = begin; i < end; ++i)
        {
          const Index cell = block.cell(i);
          if ((validity[cell] != Valid && validity[cell] != Inverted) || (skip && skip[cell]))
          {
            continue;
          }
          const Index* node = view.connectivity + view.offsets[cell];
          Vec3 p[MaxNodes];
          for (int k = 0; k < t.nodes; ++k)
          {
            p[k] = pointOf(view, node[k]);
          }
          if (dimension == 2)
          {
            for (int c = 0; c < t.corners; ++c)
            {
              const auto& n = t.cornerNodes[c];
              const Vec3 a = p[n[1]] - p[n[0]], b = p[n[2]] - p[n[0]];
              add(dot(a, b), dot(a, a) * dot(b, b));
            }
            continue;
          }
          Vec3 normals[MaxFaces];
          for (int f = 0; f < t.faces; ++f)
          {
            const auto& n = t.faceNodes[f];
            normals[f] = t.faceSizes[f] == 3 ? cross(p[n[1]] - p[n[0]], p[n[2]] - p[n[0]])
                                             : cross(p[n[2]] - p[n[0]], p[n[3]] - p[n[1]]);
          }
          for (int e = 0; e < t.edges; ++e)
          {
            const Vec3 &a = normals[t.edgeFaces[e][0]], &b = normals[t.edgeFaces[e][1]];
            add(-dot(a, b), dot(a, a) * dot(b, b));
          }
        }
      });
    for (const Counts& counts : perChunk)
    {
      for (std::size_t i = 0; i < total.size(); ++i)
      {
        total[i] += counts[i];
      }
    }
  }
  return total;
}
}
