// SPDX-License-Identifier: BSD-3-Clause
#include "Statistics.h"

#include "tautline/Core/Parallel.h"

#include <cstring>
#include <numeric>

namespace tautline
{
namespace
{
/// The tolerance at the ends of a range, relative to their size or to 1, within which a value is
/// still inside.
constexpr double roundingTolerance = 1e-12;

/// The range widened by the rounding tolerance.
Range widened(const Range& range)
{
  return { range.low - roundingTolerance * std::max(1.0, std::abs(range.low)),
    range.high + roundingTolerance * std::max(1.0, std::abs(range.high)) };
}

/// For each of the 256 cell types: whether the metric is defined on it.
std::array<bool, 256> definedTypes(const MetricInfo& info)
{
  std::array<bool, 256> table;
  for (int type = 0; type < 256; ++type)
  {
    const CellType corners = cornerType(type);
    const bool general = type == PolygonType || type == PolyhedronType;
    table[type] = corners != CellType::Unsupported ? info.definedOn(corners)
                                                   : general && info.family == MetricFamily::Faces;
  }
  return table;
}
}

namespace
{
/**
 * Finds the values at given positions of the sorted order without sorting: counts values by the
 * leading bits of their representation, then sorts only the few buckets that contain a requested
 * position.
 */
class OrderStatistics
{
public:
  OrderStatistics(const std::vector<double>& values, const std::vector<double>& positions)
    : Starts(Buckets + 1, 0)
    , SlotOf(Buckets, NoSlot)
  {
    for (double v : values)
    {
      ++this->Starts[bucketOf(v) + 1];
    }
    std::partial_sum(this->Starts.begin(), this->Starts.end(), this->Starts.begin());
    const Index last = static_cast<Index>(values.size()) - 1;
    for (double p : positions)
    {
      // Interpolation also needs the value at the next position.
      for (Index place : { static_cast<Index>(p), std::min(static_cast<Index>(p) + 1, last) })
      {
        signed char& slot = this->SlotOf[this->bucketAt(place)];
        if (slot == NoSlot)
        {
          slot = static_cast<signed char>(this->Sorted.size());
          this->Sorted.emplace_back();
        }
      }
    }
    for (double v : values)
    {
      const signed char slot = this->SlotOf[bucketOf(v)];
      if (slot != NoSlot)
      {
        this->Sorted[slot].push_back(v);
      }
    }
    for (auto& bucket : this->Sorted)
    {
      std::sort(bucket.begin(), bucket.end());
    }
  }

  double at(Index place) const
  {
    const std::size_t bucket = this->bucketAt(place);
    return this->Sorted[this->SlotOf[bucket]][place - this->Starts[bucket]];
  }

private:
  static constexpr int Bits = 19; ///< sign, exponent and seven bits of the mantissa
  static constexpr signed char NoSlot = -1;
  static constexpr std::size_t Buckets = std::size_t(1) << Bits;

  /// The leading bits of a key with the same order as the values.
  static std::size_t bucketOf(double v)
  {
    constexpr std::uint64_t signBit = std::uint64_t(1) << 63;
    std::uint64_t key;
    v += 0.0; // no negative zero
    std::memcpy(&key, &v, sizeof(key));
    // With all bits of negative numbers and the sign bit of the others inverted, integers have the
    // order of the values.
    key = key & signBit ? ~key : key | signBit;
    return key >> (64 - Bits);
  }

  std::size_t bucketAt(Index place) const
  {
    return std::upper_bound(this->Starts.begin(), this->Starts.end(), place) -
      this->Starts.begin() - 1;
  }

  std::vector<Index> Starts;       ///< number of values in the buckets before each
  std::vector<signed char> SlotOf; ///< position in Sorted of each bucket with a requested position
  std::vector<std::vector<double>> Sorted;
};
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
  std::vector<double> kept;
  kept.reserve(data.cells);
  for (Index i = 0; i < data.cells; ++i)
  {
    const signed char v = data.validity[i];
    if ((v == Valid || v == Inverted) && defined[data.cellTypes[i]] && !(data.skip && data.skip[i]))
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
  std::vector<WorstElement> heap; // its front is the best of the kept elements
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
  // In the order of `worse`, the worst element is the first.
  std::sort_heap(heap.begin(), heap.end(), worse);
  return heap;
}

//------------------------------------------------------------------------------
double worstValue(const MetricInfo& info, const MetricStatistics& statistics,
  const std::vector<WorstElement>& worst)
{
  // Depending on the metric, the value of an inverted element is not an extreme one.
  if (statistics.measured > 0 && !worst.empty() && worst.front().validity == Inverted)
  {
    return worst.front().value;
  }
  return info.direction == Direction::SmallerIsBetter ? statistics.maximum : statistics.minimum;
}

//------------------------------------------------------------------------------
MetricStatistics summarize(
  const MetricInfo& info, int dimension, const std::vector<double>& measured, bool withQuantiles)
{
  MetricStatistics result;
  result.measured = static_cast<Index>(measured.size());
  if (measured.empty())
  {
    return result;
  }
  const double n = static_cast<double>(measured.size());
  const Range acceptable = info.acceptable(dimension);
  const Range tolerated = widened(acceptable);
  // Named variables, because clang does not support structured bindings in OpenMP regions.
  const double lowest = tolerated.low, highest = tolerated.high;
  // Reductions in lanes: their order is fixed by the vector width, not by the threads.
  double minimum = measured.front(), maximum = measured.front();
  Index outside = 0;
  const double* values = measured.data();
  const Index count = result.measured;
#pragma omp simd reduction(min : minimum) reduction(max : maximum) reduction(+ : outside)
  for (Index i = 0; i < count; ++i)
  {
    minimum = std::min(minimum, values[i]);
    maximum = std::max(maximum, values[i]);
    outside += values[i] < lowest || values[i] > highest;
  }
  result.minimum = minimum;
  result.maximum = maximum;
  result.outsideAcceptable = outside;
  // Scale by a power of two that brings the largest near 1, so that squares neither overflow nor
  // underflow; compute the deviation in a second pass, so that it is accurate for nearly equal
  // values.
  const double largest = std::max(std::abs(result.minimum), std::abs(result.maximum));
  constexpr int farthestExponent = 1000;
  const int exponent =
    largest > 0 ? std::max(-farthestExponent, std::min(farthestExponent, std::ilogb(largest))) : 0;
  const double scale = std::ldexp(1.0, -exponent), unit = std::ldexp(1.0, exponent);
  const double first = measured.front() * scale;
  double sum = 0, squares = 0, deviations = 0;
#pragma omp simd reduction(+ : sum, squares)
  for (Index i = 0; i < count; ++i)
  {
    // Relative to the first value, the sum stays accurate for nearly equal values.
    const double scaled = values[i] * scale;
    sum += scaled - first;
    squares += scaled * scaled;
  }
  const double mean = first + sum / n;
#pragma omp simd reduction(+ : deviations)
  for (Index i = 0; i < count; ++i)
  {
    const double deviation = values[i] * scale - mean;
    deviations += deviation * deviation;
  }
  result.mean = mean * unit;
  result.rms = std::sqrt(squares / n) * unit;
  result.standardDeviation = std::sqrt(deviations / n) * unit;

  if (!withQuantiles)
  {
    return result;
  }
  std::vector<double> position(quantileFractions.size());
  for (std::size_t i = 0; i < position.size(); ++i)
  {
    position[i] = quantileFractions[i] * (n - 1);
  }
  const OrderStatistics sorted(measured, position);
  for (std::size_t i = 0; i < position.size(); ++i)
  {
    // Linear interpolation between order statistics (type 7 of Hyndman and Fan).
    const double fraction = position[i] - std::floor(position[i]);
    const double below = sorted.at(static_cast<Index>(position[i]));
    const double above = fraction > 0 ? sorted.at(static_cast<Index>(position[i]) + 1) : below;
    result.quantiles[i] = (1 - fraction) * below + fraction * above;
  }
  return result;
}

namespace
{
/// The range of the values; 0 to 1 if there are none.
Range extent(const std::vector<double>& measured)
{
  if (measured.empty())
  {
    return { 0, 1 };
  }
  const auto ends = std::minmax_element(measured.begin(), measured.end());
  return { *ends.first, *ends.second };
}

/// Empty bins of equal width over a range.
Histogram emptyBins(const Range& range, int bins)
{
  if (bins < 1)
  {
    throw Error("A histogram needs at least one bin.");
  }
  Histogram result;
  result.counts.assign(bins, 0);
  result.edges.resize(bins + 1);
  for (int i = 0; i <= bins; ++i)
  {
    const double fraction = static_cast<double>(i) / bins;
    // This form does not overflow if the range covers most numbers.
    result.edges[i] = (1 - fraction) * range.low + fraction * range.high;
  }
  return result;
}

/// Counts a value in its bin; values beyond an end are counted in the bin at that end.
void count(Histogram& result, double value)
{
  const auto bins = static_cast<double>(result.counts.size());
  const double low = result.edges.front(), high = result.edges.back();
  // The ends are divided first, because their difference may overflow.
  const double width = high / bins - low / bins;
  const double position = width > 0 ? (value - low) / width : 0.0;
  ++result.counts[static_cast<Index>(std::clamp(position, 0.0, bins - 1))];
}
}

//------------------------------------------------------------------------------
Histogram histogram(const std::vector<double>& measured, int bins)
{
  Histogram result = emptyBins(extent(measured), bins);
  for (double q : measured)
  {
    count(result, q);
  }
  return result;
}

//------------------------------------------------------------------------------
AcceptableHistogram acceptableHistogram(
  const MetricInfo& info, int dimension, const std::vector<double>& measured, int bins)
{
  Range range = info.acceptable(dimension);
  const Range values = extent(measured);
  if (!(range.low < range.high))
  {
    range = values;
  }
  // A range that is open on one side ends at the data.
  range.low = std::isfinite(range.low) ? range.low : std::min(values.low, range.high);
  range.high = std::isfinite(range.high) ? range.high : std::max(values.high, range.low);
  AcceptableHistogram result;
  static_cast<Histogram&>(result) = emptyBins(range, bins);
  const auto [lowest, highest] = widened(range);
  for (double q : measured)
  {
    if (info.inverted == InvertedValue::Negative && q < 0)
    {
      continue; // an inverted element
    }
    if (q < lowest)
    {
      ++result.below;
    }
    else if (q > highest)
    {
      ++result.above;
    }
    else
    {
      count(result, q);
    }
  }
  return result;
}
}
