#include "Batch.h"
#include "Parallel.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <type_traits>

namespace tautline
{
namespace
{
MetricCode codeOf(Metric metric)
{
  switch (metricInfo(metric).family)
  {
    case MetricFamily::Target:
      return targetMetricCode(metric);
    case MetricFamily::Simplex:
      return simplexMetricCode(metric);
    default:
      return cellMetricCode(metric);
  }
}

void checkOptions(const Mesh& mesh, const MetricInfo& info, const EvaluationOptions& options)
{
  if (!info.rotationInvariant && mesh.dimension() == Dimension::Surface)
  {
    throw Error(std::string(info.label) +
      " depends on the orientation of elements in space, which a curved surface does not define. "
      "Choose a metric without orientation.");
  }
  if (options.combination == Combination::PowerMean && !(options.power >= 1))
  {
    throw Error("The power of the power mean must be at least 1.");
  }
  if (!std::isfinite(options.parameters.beta) || !(options.parameters.epsilon > 0))
  {
    throw Error("Beta must be finite and epsilon positive.");
  }
}

/// The evaluator of a metric on a block, or null where the metric is not defined.
BatchEvaluator evaluatorFor(const Mesh& mesh, Metric metric, const MetricCode& code,
  const CellBlock& block, bool withGradient)
{
  const MetricInfo& info = metricInfo(metric);
  const bool flat = topology(block.type).dimension == 2;
  // 2D cells beside volume cells have no orientation in space.
  const bool oriented = info.rotationInvariant || !flat || mesh.dimension() == Dimension::Planar;
  if (!info.definedOn(block.type) || !oriented)
  {
    return nullptr;
  }
  return flat ? (withGradient ? code.gradient2D : code.value2D)
              : (withGradient ? code.gradient3D : code.value3D);
}

BatchContext contextFor(
  const Mesh& mesh, const CellBlock& block, Metric metric, const EvaluationOptions& options)
{
  return { &mesh, &block, &topology(block.type), &options,
    metricInfo(metric).direction == Direction::LargerIsBetter };
}

/// Undoes the mirroring of gather(), removes what is not finite, multiplies by a factor and hands
/// the gradient at node k of cell l of the batch to put(lanes, l, k), cell by cell.
template <int Nodes, class Put>
void scatter(const BatchContext& context, const Batch& batch, Packet factor, const Put& put)
{
  const bool mirrored = context.mesh->mirrored() && context.mesh->dimension() == Dimension::Volume;
  VectorLanes lanes[Nodes];
  for (int k = 0; k < Nodes; ++k)
  {
    Packet g[3];
    for (int c = 0; c < 3; ++c)
    {
      g[c] = factor * finiteOrZero(batch.gradient[k][c]);
    }
    g[0] = mirrored ? -g[0] : g[0];
    lanes[k].set(g);
  }
  for (int l = 0; l < batch.count; ++l)
  {
    for (int k = 0; k < Nodes; ++k)
    {
      put(lanes[k], l, k);
    }
  }
}

void evaluateAll(const Mesh& mesh, Metric metric, const EvaluationOptions& options, double* values,
  double* gradients)
{
  checkOptions(mesh, metricInfo(metric), options);
  const MeshView& view = mesh.view();
  const MetricCode code = codeOf(metric);
  Index covered = 0;
  for (const CellBlock& block : mesh.blocks())
  {
    covered += evaluatorFor(mesh, metric, code, block, false) ? block.count : 0;
  }
  if (covered < view.numberOfCells)
  {
    std::fill(values, values + view.numberOfCells, 0.0);
  }
  if (gradients && view.numberOfCells > 0)
  {
    std::fill(gradients, gradients + 3 * view.offsets[view.numberOfCells], 0.0);
  }
  for (const CellBlock& block : mesh.blocks())
  {
    const BatchEvaluator evaluate = evaluatorFor(mesh, metric, code, block, gradients != nullptr);
    if (!evaluate)
    {
      continue;
    }
    const BatchContext context = contextFor(mesh, block, metric, options);
    withNodes(*context.topology,
      [&](auto nodesOfCell)
      {
        constexpr int Nodes = decltype(nodesOfCell)::value;
        forEachChunk(block.count, options.threads,
          [&](Index, Index begin, Index end)
          {
            Batch batch;
            BatchNodes nodes;
            for (Index i = begin; i < end; i += PacketWidth)
            {
              const int count = static_cast<int>(std::min<Index>(PacketWidth, end - i));
              gather<Nodes>(context, nullptr, i, count, batch, nodes);
              evaluate(context, batch);
              batch.value = finiteOrZero(batch.value);
              for (int l = 0; l < count; ++l)
              {
                values[batch.cells[l]] = batch.value[l];
              }
              if (gradients)
              {
                scatter<Nodes>(context, batch, broadcast(1.0),
                  [&](const VectorLanes& lanes, int l, int k)
                  { lanes.storeTo(gradients + 3 * (nodes[l] - view.connectivity + k), l); });
              }
            }
          });
      });
  }
}
}

//------------------------------------------------------------------------------
void evaluateMetric(
  const Mesh& mesh, Metric metric, const EvaluationOptions& options, double* values)
{
  evaluateAll(mesh, metric, options, values, nullptr);
}

//------------------------------------------------------------------------------
void evaluateMetricGradient(const Mesh& mesh, Metric metric, const EvaluationOptions& options,
  double* values, double* gradients)
{
  evaluateAll(mesh, metric, options, values, gradients);
}

namespace
{
/// Colours a chunk may have; more means the cells must be reordered first.
constexpr int MaxColours = 64;

/// Interleaves the low 21 bits of three integers: the position on a Morton curve.
std::uint64_t mortonCode(const Vec3& p, const Vec3& low, double scale)
{
  std::uint64_t code = 0;
  for (int c = 0; c < 3; ++c)
  {
    std::uint64_t x = static_cast<std::uint64_t>(std::max(0.0, (p[c] - low[c]) * scale)) & 0x1fffff;
    x = (x | x << 32) & 0x1f00000000ffff;
    x = (x | x << 16) & 0x1f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    x = (x | x << 2) & 0x1249249249249249;
    code |= x << c;
  }
  return code;
}

/// Positions of a block's cells along a Morton curve through their centres.
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
        centers[i][c] = 0;
      }
    }
  }
  const Vec3 extent = high - low;
  const double longest = std::max({ extent[0], extent[1], extent[2] });
  const double scale = longest > 0 ? 0x1fffff / longest : 0.0;
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
}

//------------------------------------------------------------------------------
MetricSum::MetricSum(
  const Mesh& mesh, Metric metric, const EvaluationOptions& options, double power)
  : TheMesh(mesh)
  , TheMetric(metric)
  , Options(options)
  , Power(power)
{
  checkOptions(mesh, metricInfo(metric), options);
  if (!std::isfinite(power))
  {
    throw Error("The power of a metric sum must be finite.");
  }
  const MeshView& view = mesh.view();
  const MetricCode code = codeOf(metric);
  const auto& blocks = mesh.blocks();
  this->Order.resize(blocks.size());

  // Greedy colouring of chunks in order: a colour is free if no vertex of the chunk has it yet.
  for (bool reordered : { false, true })
  {
    std::vector<std::uint64_t> used(view.numberOfPoints, 0);
    std::vector<std::pair<int, Chunk>> coloured;
    bool failed = false;
    for (std::size_t b = 0; b < blocks.size() && !failed; ++b)
    {
      const CellBlock& block = blocks[b];
      if (!evaluatorFor(mesh, metric, code, block, false))
      {
        continue;
      }
      if (reordered)
      {
        this->Order[b] = spatialOrder(mesh, block);
      }
      const Index* order = reordered ? this->Order[b].data() : nullptr;
      const int nodes = topology(block.type).nodes;
      for (Index begin = 0; begin < block.count && !failed; begin += ChunkSize)
      {
        const Index end = std::min(block.count, begin + ChunkSize);
        auto forEachVertex = [&](auto visit)
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
        failed = taken == ~std::uint64_t(0);
        if (!failed)
        {
          int colour = 0;
          while (taken >> colour & 1)
          {
            ++colour;
          }
          forEachVertex([&](std::uint64_t& mask) { mask |= std::uint64_t(1) << colour; });
          coloured.push_back({ colour, { static_cast<int>(b), begin, end } });
        }
      }
    }
    // Many colours mean a numbering without locality: go along a space-filling curve instead, which
    // keeps the chunks compact. Its own few extra colours are then accepted.
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
    slope = select(size > 0.0, power * pow(size, power - 1.0), Packet{});
    value = q * slope * (1.0 / power);
  }
}
}

//------------------------------------------------------------------------------
template <bool WithGradient>
double MetricSum::run(double* gradient) const
{
  const MeshView& view = this->TheMesh.view();
  const MetricCode code = codeOf(this->TheMetric);
  std::vector<double> sums(this->Chunks.size(), 0.0);
  if (WithGradient)
  {
    std::fill(gradient, gradient + 3 * view.numberOfPoints, 0.0);
  }
  const auto& blocks = this->TheMesh.blocks();
  const int threads = resolveThreads(this->Options.threads);
  for (std::size_t colour = 0; colour + 1 < this->ColourStarts.size(); ++colour)
  {
    const Index first = this->ColourStarts[colour], last = this->ColourStarts[colour + 1];
#pragma omp parallel for schedule(dynamic) num_threads(threads) if (last - first > 1)
    for (Index i = first; i < last; ++i)
    {
      const Chunk& chunk = this->Chunks[i];
      const CellBlock& block = blocks[chunk.block];
      const BatchEvaluator evaluate =
        evaluatorFor(this->TheMesh, this->TheMetric, code, block, WithGradient);
      const BatchContext context = contextFor(this->TheMesh, block, this->TheMetric, this->Options);
      const Index* order =
        this->Order[chunk.block].empty() ? nullptr : this->Order[chunk.block].data();
      Packet total = {};
      withNodes(*context.topology,
        [&](auto nodesOfCell)
        {
          constexpr int Nodes = decltype(nodesOfCell)::value;
          Batch batch;
          BatchNodes nodes;
          for (Index begin = chunk.begin; begin < chunk.end; begin += PacketWidth)
          {
            const int count = static_cast<int>(std::min<Index>(PacketWidth, chunk.end - begin));
            gather<Nodes>(context, order, begin, count, batch, nodes);
            evaluate(context, batch);
            Packet value, slope;
            raise(finiteOrZero(batch.value), this->Power, value, slope);
            for (int l = count; l < PacketWidth; ++l)
            {
              value[l] = 0;
            }
            total += value;
            if constexpr (WithGradient)
            {
              scatter<Nodes>(context, batch, slope,
                [&](const VectorLanes& lanes, int l, int k)
                { lanes.addTo(gradient + 3 * nodes[l][k], l); });
            }
          }
        });
      double sum = 0;
      for (int l = 0; l < PacketWidth; ++l)
      {
        sum += total[l];
      }
      sums[i] = sum;
    }
  }
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

double MetricSum::value() const
{
  return this->run<false>(nullptr);
}

double MetricSum::valueAndGradient(double* gradient) const
{
  return this->run<true>(gradient);
}
}
