// SPDX-License-Identifier: BSD-3-Clause
#include "ElementSum.h"

#include "UserMetric.h"
#include "tautline/Mesh/CoordinateFrame.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tautline
{
namespace
{
/// The maximum number of colors; if more are needed, the cells are reordered first.
constexpr int MaxColours = 64;
/// Coordinates and gradient of this many points fit into the cache of a core.
constexpr Index FewPoints = 1 << 15;

/// Interleaves the low 21 bits of three integers: the position on a Morton curve.
std::uint64_t mortonCode(const Vec3& p, const Vec3& low, double scale)
{
  std::uint64_t code = 0;
  for (int c = 0; c < 3; ++c)
  {
    std::uint64_t x = static_cast<std::uint64_t>(std::max(0.0, (p[c] - low[c]) * scale)) & 0x1fffff;
    // Spreads the bits so that two zeros follow each, by shifts that double the number of groups.
    x = (x | x << 32) & 0x1f00000000ffff;
    x = (x | x << 16) & 0x1f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    x = (x | x << 2) & 0x1249249249249249;
    code |= x << c;
  }
  return code;
}

/// The positions of the cells of a block along a Morton curve through their centers.
std::vector<Index> spatialOrder(const Mesh& mesh, const CellBlock& block)
{
  std::vector<Vec3> centers(block.count);
  Vec3 low = { HUGE_VAL, HUGE_VAL, HUGE_VAL }, high = { -HUGE_VAL, -HUGE_VAL, -HUGE_VAL };
  for (Index i = 0; i < block.count; ++i)
  {
    centers[i] = mesh.center(block.cell(i), block.type);
    for (int c = 0; c < 3; ++c)
    {
      if (std::isfinite(centers[i][c]))
      {
        low[c] = std::min(low[c], centers[i][c]);
        high[c] = std::max(high[c], centers[i][c]);
      }
      else
      {
        // A cell without a finite center may be anywhere on the curve.
        centers[i][c] = 0;
      }
    }
  }
  const Vec3 extent = high - low;
  const double longest = std::max({ extent[0], extent[1], extent[2] });
  // The longest extent uses all 21 bits.
  const double most = longest > 0 ? 0x1fffff / longest : 0.0;
  const double scale = std::isfinite(most) ? most : 0.0;
  std::vector<std::pair<std::uint64_t, Index>> keys(block.count);
  for (Index i = 0; i < block.count; ++i)
  {
    keys[i] = { mortonCode(centers[i], low, scale), i };
  }
  std::sort(keys.begin(), keys.end());
  std::vector<Index> order(block.count);
  std::transform(
    keys.begin(), keys.end(), order.begin(), [](const auto& key) { return key.second; });
  return order;
}

/// A color, and a chunk of this color.
using ColouredChunk = std::pair<int, ElementSum::Chunk>;

/**
 * @brief Colors the chunks greedily, one after the other: a color is free if no vertex of the chunk
 * has it yet.
 * @param reordered whether to order the cells of each block along a space-filling curve
 * @param orders of each block, set if reordered
 * @return false if no color is free for a chunk
 */
bool colourChunks(const Mesh& mesh, Metric metric, bool reordered,
  std::vector<std::vector<Index>>& orders, std::vector<ColouredChunk>& coloured)
{
  const MeshView& view = mesh.view();
  const MetricCode code = metricCode(metric);
  const auto& blocks = mesh.blocks();
  std::vector<std::uint64_t> used(view.numberOfPoints, 0); // colors of each vertex, as bits
  for (std::size_t b = 0; b < blocks.size(); ++b)
  {
    const CellBlock& block = blocks[b];
    if (!elementEvaluatorFor(mesh, metric, code, block, false))
    {
      continue;
    }
    if (reordered)
    {
      orders[b] = spatialOrder(mesh, block);
    }
    const Index* order = reordered ? orders[b].data() : nullptr;
    const int nodes = topology(block.type).nodes;
    for (Index begin = 0; begin < block.count; begin += ChunkSize)
    {
      const Index end = std::min(block.count, begin + ChunkSize);
      const auto forEachVertex = [&](const auto& visit)
      {
        for (Index i = begin; i < end; ++i)
        {
          const Index* node = view.connectivity + view.offsets[block.cell(order ? order[i] : i)];
          for (int k = 0; k < nodes; ++k)
          {
            visit(used[node[k]]);
          }
        }
      };
      std::uint64_t taken = 0;
      forEachVertex([&](std::uint64_t& mask) { taken |= mask; });
      if (taken == ~std::uint64_t(0))
      {
        return false;
      }
      int colour = 0;
      while (taken >> colour & 1)
      {
        ++colour;
      }
      forEachVertex([&](std::uint64_t& mask) { mask |= std::uint64_t(1) << colour; });
      coloured.push_back({ colour, { static_cast<int>(b), begin, end } });
    }
  }
  return true;
}
}

//------------------------------------------------------------------------------
ElementSum::ElementSum(const Mesh& mesh, Metric metric, const EvaluationOptions& options)
  : TheMesh(mesh)
  , TheMetric(metric)
  , Options(options)
{
  checkEvaluation(mesh, metricInfo(metric), options);
  requireOrdinaryScale(mesh.view(), "A sum over the elements");
  this->Order.resize(mesh.blocks().size());

  for (bool reordered : { false, true })
  {
    std::vector<ColouredChunk> coloured;
    const bool failed = !colourChunks(mesh, metric, reordered, this->Order, coloured);
    // Many colors indicate a numbering without locality: use a space-filling curve instead, which
    // keeps the chunks compact. Its few extra colors are then accepted.
    int colours = 0;
    for (const auto& c : coloured)
    {
      colours = std::max(colours, c.first + 1);
    }
    const bool scattered = failed || colours * 4 > MaxColours;
    if (scattered && !reordered)
    {
      continue;
    }
    if (failed)
    {
      throw Error("A vertex is shared by cells of more than " + std::to_string(MaxColours) +
        " chunks: the mesh has a vertex with an extreme number of cells.");
    }
    // Within a color, chunks keep their order, so that sums are reproducible.
    std::stable_sort(coloured.begin(), coloured.end(),
      [](const auto& a, const auto& b) { return a.first < b.first; });
    this->ColourStarts.assign(1, 0);
    for (std::size_t i = 0; i < coloured.size(); ++i)
    {
      if (i > 0 && coloured[i].first != coloured[i - 1].first)
      {
        this->ColourStarts.push_back(static_cast<Index>(i));
      }
      this->Chunks.push_back(coloured[i].second);
    }
    this->ColourStarts.push_back(static_cast<Index>(coloured.size()));
    break;
  }
  this->pack();
}

//------------------------------------------------------------------------------
void ElementSum::pack()
{
  const MeshView& view = this->TheMesh.view();
  if (view.numberOfPoints > std::numeric_limits<std::int32_t>::max())
  {
    throw Error("The mesh has more than 2,147,483,647 points: split it.");
  }
  const bool reordered = std::any_of(this->Order.begin(), this->Order.end(),
    [](const std::vector<Index>& order) { return !order.empty(); });
  // Points numbered in the order of the cells make the memory accesses of reordered cells local.
  const bool renumber = reordered && view.numberOfPoints > FewPoints;
  std::vector<std::int32_t> place(renumber ? view.numberOfPoints : 0, -1);
  const auto& blocks = this->TheMesh.blocks();
  this->PackedConnectivity.resize(blocks.size());
  for (std::size_t b = 0; b < blocks.size(); ++b)
  {
    if (!elementEvaluatorFor(
          this->TheMesh, this->TheMetric, metricCode(this->TheMetric), blocks[b], false))
    {
      continue;
    }
    const int nodes = topology(blocks[b].type).nodes;
    std::vector<std::int32_t>& packed = this->PackedConnectivity[b];
    packed.reserve(nodes * blocks[b].count);
    const std::vector<Index>& order = this->Order[b];
    for (Index i = 0; i < blocks[b].count; ++i)
    {
      const Index cell = blocks[b].cell(order.empty() ? i : order[i]);
      const Index* node = view.connectivity + view.offsets[cell];
      for (int k = 0; k < nodes; ++k)
      {
        // Points are numbered in the order of their first use.
        if (renumber && place[node[k]] < 0)
        {
          place[node[k]] = static_cast<std::int32_t>(this->PackedPoints.size());
          this->PackedPoints.push_back(node[k]);
        }
        packed.push_back(renumber ? place[node[k]] : static_cast<std::int32_t>(node[k]));
      }
    }
  }
}

//------------------------------------------------------------------------------
const double* ElementSum::packedCoordinates(std::vector<double>& coordinates) const
{
  coordinates.resize(3 * this->PackedPoints.size());
  tautline::forEachChunk(static_cast<Index>(this->PackedPoints.size()), this->Options.threads,
    [&](Index, Index begin, Index end)
    {
      for (Index i = begin; i < end; ++i)
      {
        std::copy_n(
          this->TheMesh.view().points + 3 * this->PackedPoints[i], 3, coordinates.data() + 3 * i);
      }
    });
  return coordinates.data();
}

//------------------------------------------------------------------------------
void ElementSum::addUnpacked(const std::vector<double>& packedGradient, double* gradient) const
{
  tautline::forEachChunk(static_cast<Index>(this->PackedPoints.size()), this->Options.threads,
    [&](Index, Index begin, Index end)
    {
      for (Index i = begin; i < end; ++i)
      {
        for (int c = 0; c < 3; ++c)
        {
          gradient[3 * this->PackedPoints[i] + c] += packedGradient[3 * i + c];
        }
      }
    });
}

namespace
{
/// |q|^p sign(q) and its derivative.
void raise(Packet q, double power, Packet& value, Packet& slope)
{
  if (power == 1.0)
  {
    value = q;
    slope = broadcast(1.0);
  }
  else if (power == 2.0)
  {
    const Packet size = abs(q);
    value = q * size;
    slope = 2.0 * size;
  }
  else
  {
    const Packet size = abs(q);
    // The slope p |q|^(p - 1) also gives the value, which saves a second power.
    slope = select(size > 0.0, power * pow(size, power - 1.0), Packet{});
    value = q * slope * (1.0 / power);
  }
}
}

//------------------------------------------------------------------------------
std::unique_ptr<ElementTable> ElementSum::tabulated(bool withSlopes) const
{
  const MetricInfo& info = metricInfo(this->TheMetric);
  return info.user && !info.user->hasDerivatives()
    ? std::make_unique<ElementTable>(tabulate(this->TheMesh, info, withSlopes))
    : nullptr;
}

//------------------------------------------------------------------------------
MetricSum::MetricSum(
  const Mesh& mesh, Metric metric, const EvaluationOptions& options, double power)
  : Elements(std::make_shared<ElementSum>(mesh, metric, options))
  , Power(power)
{
  if (!std::isfinite(power))
  {
    throw Error("The power of a metric sum must be finite.");
  }
}

template <bool WithGradient>
double MetricSum::run(double* gradient) const
{
  const double power = this->Power;
  const auto totals = this->Elements->run<WithGradient, LaneSums>(
    [=](const BatchContext&, const Batch& batch, LaneSums& total, Packet& slope)
    {
      Packet value;
      raise(batch.value, power, value, slope);
      total.lanes += onlyCells(batch, value);
    },
    gradient, false);
  double sum = 0;
  for (const LaneSums& total : totals)
  {
    sum += total.sum();
  }
  return sum;
}

double MetricSum::value() const
{
  return this->run<false>(nullptr);
}

double MetricSum::valueAndGradient(double* gradient) const
{
  std::fill(gradient, gradient + 3 * this->Elements->mesh().view().numberOfPoints, 0.0);
  return this->run<true>(gradient);
}
}
