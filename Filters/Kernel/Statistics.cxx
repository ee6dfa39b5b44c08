#include "Statistics.h"

#include "Parallel.h"

#include <numeric>

namespace tautline
{
namespace
{
/// Beyond the ends of a range by this, relative to their size or to 1, a value still counts as inside.
constexpr double roundingTolerance = 1e-12;

/// For each of the 256 cell types whether the metric is defined on it.
std::array<bool, 256> definedTypes(const MetricInfo& info)
{
  std::array<bool, 256> table;
  for (int type = 0; type < 256; ++type)
  {
    const CellType corners = cornerType(type);
    table[type] = corners != CellType::Unsupported && info.definedOn(corners);
  }
  return table;
}
}

//------------------------------------------------------------------------------
ValidityCounts countValidity(const signed char* validity, const unsigned char* skip, Index cells)
{
  ValidityCounts counts;
  for (Index i = 0; i < cells; ++i)
  {
    if (!(skip && skip[i]))
    {
      counts.valid += validity[i] == Valid;
      counts.inverted += validity[i] == Inverted;
      counts.degenerate += validity[i] == Degenerate;
      counts.notMeasured += validity[i] == NotMeasured;
      counts.nonFinite += validity[i] == NonFinite;
    }
  }
  return counts;
}

//------------------------------------------------------------------------------
std::vector<double> measuredValues(const MetricInfo& info, const CellValues& data)
{
  const auto defined = definedTypes(info);
  const bool withInverted = info.inverted == InvertedValue::Larger;
  std::vector<double> kept;
  kept.reserve(data.cells);
  for (Index i = 0; i < data.cells; ++i)
  {
    const signed char v = data.validity[i];
    if ((v == Valid || (withInverted && v == Inverted)) && defined[data.cellTypes[i]] &&
      !(data.skip && data.skip[i]))
    {
      kept.push_back(data.values[i]);
    }
  }
  return kept;
}

//------------------------------------------------------------------------------
bool isWorse(const MetricInfo& info, const WorstElement& a, const WorstElement& b)
{
  // Inverted is -1, degenerate 0, valid 1.
  if (a.validity != b.validity)
  {
    return a.validity < b.validity;
  }
  if (a.value != b.value)
  {
    return (info.direction == Direction::SmallerIsBetter) == (a.value > b.value);
  }
  return a.cell < b.cell;
}

//------------------------------------------------------------------------------
std::vector<WorstElement> worstElements(const MetricInfo& info, const CellValues& data)
{
  const auto defined = definedTypes(info);
  auto worse = [&](const WorstElement& a, const WorstElement& b) { return isWorse(info, a, b); };
  std::vector<WorstElement> heap; // its front is the least bad of those kept
  for (Index i = 0; i < data.cells; ++i)
  {
    const signed char v = data.validity[i];
    if (v < Inverted || !defined[data.cellTypes[i]] || (data.skip && data.skip[i]))
    {
      continue;
    }
    const WorstElement candidate = { i, data.values[i], v };
    if (heap.size() < WorstCount)
    {
      heap.push_back(candidate);
      std::push_heap(heap.begin(), heap.end(), worse);
    }
    else if (worse(candidate, heap.front()))
    {
      std::pop_heap(heap.begin(), heap.end(), worse);
      heap.back() = candidate;
      std::push_heap(heap.begin(), heap.end(), worse);
    }
  }
  std::sort_heap(heap.begin(), heap.end(), worse);
  return heap;
}

//------------------------------------------------------------------------------
MetricStatistics summarize(const MetricInfo& info, int dimension, std::vector<double>& measured)
{
  MetricStatistics result;
  result.measured = static_cast<Index>(measured.size());
  if (measured.empty())
  {
    return result;
  }
  const double n = static_cast<double>(measured.size());
  const Range acceptable = info.acceptable(dimension);
  const double lowest =
    acceptable.low - roundingTolerance * std::max(1.0, std::abs(acceptable.low));
  const double highest =
    acceptable.high + roundingTolerance * std::max(1.0, std::abs(acceptable.high));
  result.minimum = result.maximum = measured.front();
  for (double q : measured)
  {
    result.minimum = std::min(result.minimum, q);
    result.maximum = std::max(result.maximum, q);
    result.outsideAcceptable += q < lowest || q > highest;
  }
  // In units of the largest, so that squares neither overflow nor vanish; the deviation in a second
  // pass, so that it is right for nearly equal values.
  const double largest = std::max(std::abs(result.minimum), std::abs(result.maximum));
  const double unit = largest > 0 ? largest : 1.0;
  double sum = 0, squares = 0, deviations = 0;
  for (double q : measured)
  {
    sum += q / unit;
    squares += (q / unit) * (q / unit);
  }
  const double mean = sum / n;
  for (double q : measured)
  {
    deviations += (q / unit - mean) * (q / unit - mean);
  }
  result.mean = mean * unit;
  result.rms = std::sqrt(squares / n) * unit;
  result.standardDeviation = std::sqrt(deviations / n) * unit;

  // Quantiles in increasing order; each search goes on where the last one ended.
  auto from = measured.begin();
  for (std::size_t i = 0; i < quantileFractions.size(); ++i)
  {
    const double position = quantileFractions[i] * (n - 1);
    const auto at = measured.begin() + static_cast<Index>(position);
    std::nth_element(from, at, measured.end());
    const double part = position - std::floor(position);
    const double low = *at;
    const double high =
      part > 0 && at + 1 < measured.end() ? *std::min_element(at + 1, measured.end()) : low;
    result.quantiles[i] = low < high ? (1 - part) * low + part * high : low;
    from = at;
  }
  return result;
}

//------------------------------------------------------------------------------
Histogram histogram(const std::vector<double>& measured, int bins)
{
  if (bins < 1)
  {
    throw Error("A histogram needs at least one bin.");
  }
  double low = 0, high = 1;
  if (!measured.empty())
  {
    const auto ends = std::minmax_element(measured.begin(), measured.end());
    low = *ends.first;
    high = *ends.second;
  }
  Histogram result;
  result.counts.assign(bins, 0);
  result.edges.resize(bins + 1);
  for (int i = 0; i <= bins; ++i)
  {
    const double part = static_cast<double>(i) / bins;
    result.edges[i] = (1 - part) * low + part * high;
  }
  const double width = high / bins - low / bins;
  for (double q : measured)
  {
    const double position = width > 0 ? (q - low) / width : 0.0;
    ++result.counts[static_cast<Index>(std::min<double>(bins - 1, position))];
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
            const Vec3 area = vectorArea(t, p);
            for (int c = 0; c < t.corners; ++c)
            {
              const auto& n = t.cornerNodes[c];
              const Vec3 a = p[n[1]] - p[n[0]], b = p[n[2]] - p[n[0]];
              if (dot(cross(a, b), area) < 0)
              {
                ++counts.back(); // a reflex corner
              }
              else
              {
                add(dot(a, b), dot(a, a) * dot(b, b));
              }
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
